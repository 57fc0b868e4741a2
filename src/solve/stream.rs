//! The stream: all contacts that are solved, as constraints in lists of batches, one list per colour of each substep group.
//!
//! A contact lives in one lane of one list ([`Home`]), with its gaps and impulses, until its bodies part.
//!
//! | part of a step | what happens |
//! |---|---|
//! | [`Stream::rename`] when pairs are listed anew | contacts whose pair has left the list go, the others learn its new place |
//! | [`Stream::follow`] when manifolds are found | contacts that touch no more go; impulses stay with the features of points |
//! | [`Stream::arrange`] when contacts have come or gone | new ones get a colour and a lane |
//! | [`Stream::prepare`] | lanes whose manifolds were found anew are made of them |
//! | [`Stream::visit`] per pass | constraints, rows |
//!
//! Within a colour the order says nothing, as contacts share no body that moves: one that goes leaves its lane to the
//! list's last. Only the overflow, of which each contact is a batch, keeps the order of pairs: it is put down to the
//! pairs' rows and taken up again.

mod moves;
mod read;
mod share;

use std::ops::Range;

use super::batches::{Batches, Ends, Visit};
use super::color::{COLORS, Colors};
use super::constraint::{Constraint, LaneValues, Side, at};
use super::substep_group::SubstepGroups;
use crate::body::Bodies;
use crate::contact::{Changed, Home, Manifolds};
use crate::each::Each as _;
use crate::lanes::{Lanes, Real};
use crate::workers::{Parts, Workers};

/// Lists of one substep group: one per colour, and the overflow.
const LISTS: usize = COLORS + 1;

/// Lanes a list's last batch is counted with when one-point contacts may join its others: the same at every
/// width, so that width never decides which kernel solves a contact.
const JOIN: usize = 8;

/// The contacts of one colour and substep group.
#[derive(Clone, Debug)]
struct List<L: Lanes> {
    two: Batches<L, 2>,
    one: Batches<L, 1>,
    /// One-point contacts are solved as two-point ones (of which one does nothing), as that saves a batch.
    joined: bool,
    /// Batches of the lists before it.
    base: [usize; 2],
}

impl<L: Lanes> Default for List<L> {
    fn default() -> Self {
        Self { two: Batches::default(), one: Batches::default(), joined: false, base: [0; 2] }
    }
}

impl<L: Lanes> List<L> {
    #[inline]
    fn lane(&self, home: Home) -> LaneValues<L::Elem> {
        if home.two { self.two.lane(home.lane) } else { self.one.lane(home.lane) }
    }
    #[inline]
    fn impulses(&self, home: Home) -> [L::Elem; 4] {
        if home.two { self.two.impulses(home.lane) } else { self.one.impulses(home.lane) }
    }
    #[inline]
    fn slots(&self, home: Home) -> [u32; 2] {
        if home.two { self.two.slots(home.lane) } else { self.one.slots(home.lane) }
    }
    fn is_stale(&self, home: Home) -> bool {
        if home.two { self.two.is_stale(home.lane) } else { self.one.is_stale(home.lane) }
    }
    #[inline]
    fn is_fresh(&self, home: Home) -> bool {
        if home.two { self.two.is_fresh(home.lane) } else { self.one.is_fresh(home.lane) }
    }
    /// Changes what a lane holds.
    fn hold(&mut self, home: Home, values: &LaneValues<L::Elem>) {
        if home.two {
            self.two.set_lane(home.lane, values);
        } else {
            self.one.set_lane(home.lane, values);
        }
    }
    /// Gives a lane these impulses, N·s; it is to be prepared.
    #[inline]
    fn set_impulses(&mut self, home: Home, row: [L::Elem; 4]) {
        if home.two {
            self.two.set_impulses(home.lane, row);
        } else {
            self.one.set_impulses(home.lane, row);
        }
    }
    #[inline(always)]
    fn touch(&mut self, home: Home) {
        if home.two {
            self.two.touch(home.lane);
        } else {
            self.one.touch(home.lane);
        }
    }
    fn rename(&mut self, home: Home, place: u32) {
        if home.two {
            self.two.rename(home.lane, place);
        } else {
            self.one.rename(home.lane, place);
        }
    }
    /// Takes a lane out; returns the pair that has moved there.
    fn remove(&mut self, home: Home, padding: u32) -> Option<u32> {
        if home.two { self.two.remove(home.lane, padding) } else { self.one.remove(home.lane, padding) }
    }
    fn clear(&mut self) {
        self.two.clear();
        self.one.clear();
        self.joined = false;
    }
}

/// All contacts in lanes; memory is kept from step to step.
#[derive(Clone, Debug)]
pub struct Stream<L: Lanes> {
    /// Colour by colour within a substep group, substep group by substep group within a part; behind those of parts, in the
    /// same order, lists of contacts between parts.
    lists: Vec<List<L>>,
    colors: Colors,
    parts: Parts,
    balance: share::Balance,
    /// The colours that hold something, substep group by substep group.
    order: Vec<u16>,
    /// Where each substep group's colours end in `order`.
    group_ends: Vec<usize>,
    /// What passes go over, of `order`.
    active: Range<usize>,
    /// Contacts have come or gone since they were last arranged.
    outdated: bool,
    /// Places and homes in hand.
    picked: Vec<u32>,
    gone: Vec<Home>,
    recoded: Vec<Changed>,
}

impl<L: Lanes> Default for Stream<L> {
    fn default() -> Self {
        Self {
            lists: Vec::new(),
            colors: Colors::default(),
            parts: Parts::default(),
            balance: share::Balance::default(),
            order: Vec::new(),
            group_ends: vec![0],
            active: 0..0,
            outdated: false,
            picked: Vec::new(),
            gone: Vec::new(),
            recoded: Vec::new(),
        }
    }
}

impl<L: Lanes> Stream<L> {
    /// Forgets all contacts.
    pub fn clear(&mut self) {
        for list in &mut self.lists {
            list.clear();
        }
        self.colors.clear();
        self.outdated = true;
    }

    /// Gives contacts that have come a colour and a lane.
    pub fn arrange(
        &mut self,
        bodies: &Bodies<L::Elem>,
        manifolds: &mut Manifolds<L::Elem>,
        groups: &SubstepGroups<L::Elem>,
    ) {
        self.outdated = false;
        if self.lists.is_empty() && !manifolds.is_empty() {
            self.lists.resize_with(groups.count() * LISTS * self.parts.lists(), List::default);
        }
        let mut comers = std::mem::take(&mut self.picked);
        comers.clear();
        let homes = manifolds.homes();
        for &place in manifolds.touching() {
            if !homes[place as usize].is_some() {
                comers.push(place);
            }
        }
        for &place in &comers {
            let slots = manifolds.slots(place as usize);
            let color = self.colors.take(slots, bodies);
            let list = self.list_of(groups.of_pair(slots), color, slots);
            self.put(list, place, manifolds);
        }
        self.picked = comers;
        self.note_colors();
        for at in 0..self.order.len() {
            self.join(self.order[at] as usize, manifolds);
        }
        let mut base = [0; 2];
        for list in &mut self.lists {
            list.base = base;
            base = [base[0] + list.two.len(), base[1] + list.one.len()];
        }
        self.active = 0..self.order.len();
    }

    /// Notes which colours hold something.
    fn note_colors(&mut self) {
        self.order.clear();
        self.group_ends.clear();
        let colors = self.colors_of_part();
        for color in 0..colors {
            let holds = |list: &List<L>| list.two.used() + list.one.used() > 0;
            if self.lists[color..].iter().step_by(colors).any(holds) {
                self.order.push(color as u16);
            }
            if color % LISTS == COLORS {
                self.group_ends.push(self.order.len());
            }
        }
    }

    /// Who shares passes out.
    pub(in crate::solve) fn parts(&self) -> &Parts {
        &self.parts
    }

    /// The list of a contact.
    fn list_of(&self, group: usize, color: usize, slots: [u32; 2]) -> usize {
        let part = if color == COLORS { self.parts.lists() - 1 } else { self.parts.list_of(slots) };
        part * self.colors_of_part() + group * LISTS + color
    }

    /// Lists of one part.
    fn colors_of_part(&self) -> usize {
        self.lists.len() / self.parts.lists()
    }

    /// Is there a contact without a colour?
    pub fn overflows(&self) -> bool {
        let mut overflows = self.lists.iter().skip(COLORS).step_by(LISTS);
        overflows.any(|list| list.two.len() > 0)
    }

    /// Have contacts come or gone since [`Stream::arrange`]?
    pub fn is_outdated(&self) -> bool {
        self.outdated
    }

    /// Passes go over the contacts of one substep group from now on, or over all.
    pub fn choose(&mut self, substep_group: Option<usize>) {
        let end = |group: usize| self.group_ends.get(group).copied().unwrap_or(self.order.len());
        self.active = match substep_group {
            None => 0..self.order.len(),
            Some(0) => 0..end(0),
            Some(group) => end(group - 1)..end(group),
        };
    }

    /// Notes that the manifold of a contact was found anew.
    #[inline(always)]
    pub fn touch(&mut self, home: Home) {
        if home.is_some() {
            self.lists[home.list as usize].touch(home);
        }
    }

    /// Makes lanes of the manifolds found anew; `inverse_masses` has rows 1/m, 1/I, –, – per slot, `moved` the
    /// displacements that gaps have yet to hear of: of those in the same batches they do now. `all`: all were found anew.
    pub fn prepare(
        &mut self,
        (workers, all): (&Workers, bool),
        manifolds: &Manifolds<L::Elem>,
        inverse_masses: &[[L::Elem; 4]],
        moved: Option<&[[L::Elem; 4]]>,
    ) {
        self.each_list(workers, |first, list| {
            let (inverse_masses, moved) = (&inverse_masses[first..], moved.map(|moved| &moved[first..]));
            if all {
                list.two.touch_all();
                list.one.touch_all();
            }
            list.two.prepare(manifolds, inverse_masses, moved);
            list.one.prepare(manifolds, inverse_masses, moved);
        });
    }

    /// Gaps hear of displacements per slot.
    pub fn follow_displacements(&mut self, moved: &[[L::Elem; 4]]) {
        self.each(|first, contacts| contacts.visit(&mut Follow { moved: &moved[first..] }));
    }

    /// Marks every constraint's separation as out of date.
    pub fn age(&mut self) {
        let colors = self.colors_of_part().max(1);
        for lists in self.lists.chunks_mut(colors) {
            for &color in &self.order {
                let list = &mut lists[color as usize];
                list.two.age();
                list.one.age();
            }
        }
    }

    /// Places of the pairs of each list, with whether it is the overflow.
    pub fn places(&self) -> impl Iterator<Item = (bool, impl Iterator<Item = u32>)> {
        self.order.iter().map(|&color| {
            let lists = self.lists[color as usize..].iter().step_by(self.colors_of_part());
            let places = lists.flat_map(|list| list.two.places().iter().chain(list.one.places()).copied());
            (color as usize % LISTS == COLORS, places)
        })
    }

    /// Batches of two-point and of one-point contacts.
    pub fn batches(&self) -> [usize; 2] {
        let of = |count: fn(&List<L>) -> usize| self.lists.iter().map(count).sum();
        [of(|list| list.two.len()), of(|list| list.one.len())]
    }

    /// Bytes of constraint and slots a pass streams per two-point and one-point contact.
    pub fn bytes_per_contact() -> [usize; 2] {
        [size_of::<Constraint<L, 2>>(), size_of::<Constraint<L, 1>>()].each(|bytes| bytes / L::WIDTH + 8)
    }

    /// Bytes of constraints and slots a pass streams.
    pub fn bytes(&self) -> usize {
        let ([two, one], batches) = (Self::bytes_per_contact(), self.batches());
        (batches[0] * two + batches[1] * one) * L::WIDTH
    }
}

/// Gaps hear of displacements.
struct Follow<'a, R> {
    moved: &'a [[R; 4]],
}

impl<L: Lanes> Visit<L> for Follow<'_, L::Elem> {
    #[inline(always)]
    fn visit<const POINTS: usize>(&mut self, c: &mut Constraint<L, POINTS>, ends: Ends<'_>, _: usize) {
        c.follow(self.moved, &ends);
    }
}

/// Sums the impulses of the last step per body: what a substep's warm start adds to its velocity.
#[derive(Debug)]
pub(crate) struct WarmStart<'a, R: Real> {
    /// Rows vx, vy, w, 1/m per slot.
    pub rows: &'a mut [[R; 4]],
    /// Factor on the impulses: this step's substep over the last one's.
    pub share: R,
}

impl<L: Lanes> Visit<L> for WarmStart<'_, L::Elem> {
    #[inline(always)]
    fn visit<const POINTS: usize>(&mut self, c: &mut Constraint<L, POINTS>, ends: Ends<'_>, _: usize) {
        let share = L::splat(self.share);
        for point in &mut c.points {
            point.velocity_impulse = point.velocity_impulse * share;
        }
        c.tangent_impulse = c.tangent_impulse * share;
        let (mut a, mut b) = (Side::gather(self.rows, ends.a), Side::gather(self.rows, ends.b));
        c.apply_accumulated(&mut a, &mut b);
        a.scatter(self.rows, ends.a);
        b.scatter(self.rows, ends.b);
    }
}
