//! The stream: all contacts of a step as constraints in batches of lanes, colour by colour.
//!
//! | part of a step | reads | writes |
//! |---|---|---|
//! | [`Stream::cut`] when contacts come or go | colours | batches |
//! | [`Stream::begin`] | manifolds looked at, masses | constraints, warm start per body |
//! | [`Stream::visit`] per pass | constraints, rows | constraints, rows |
//! | [`Stream::end_where`] before manifolds are found anew | constraints, last displacements | gaps and impulses of pairs |
//!
//! Padding lanes hold [`Manifolds::padding`]: all zeros, between the world and itself, so nothing they do
//! changes a row and every loop over lanes is of fixed length.

use super::color::Coloring;
use super::constraint::{Constraint, Parts, Point, Side};
use super::substep_group::SubstepGroups;
use crate::contact::Manifolds;
use crate::each::Each as _;
use crate::lanes::{Lanes, Real};

/// What a pass does to one batch; `POINTS` is 1 or 2.
pub trait Visit<L: Lanes> {
    /// The places of the pairs, and slots of bodies A and B, `WIDTH` each.
    fn visit<const POINTS: usize>(
        &mut self,
        constraint: &mut Constraint<L, POINTS>,
        ends: Ends<'_>,
        at: usize,
    );
}

/// Whom a batch's lanes join: `WIDTH` entries each count. Slots are held by value: a scatter then needs no
/// second check of what the gather has checked.
#[derive(Clone, Copy, Debug)]
pub struct Ends<'a> {
    /// Places of pairs.
    pub place: &'a [u32],
    /// Slots of bodies A.
    pub a: &'a [u32; 16],
    /// Slots of bodies B.
    pub b: &'a [u32; 16],
    /// The gaps already know the displacements that others have yet to follow.
    pub fresh: bool,
}

/// Batches of contacts solved with the same number of points.
#[derive(Clone, Debug)]
struct Batches<L, const POINTS: usize> {
    constraints: Vec<Constraint<L, POINTS>>,
    /// `WIDTH` entries per batch, as are `a` and `b`.
    place: Vec<u32>,
    a: Vec<u32>,
    b: Vec<u32>,
    /// Which lanes' manifolds were found anew.
    stale: Vec<u32>,
    /// Batches prepared in this step.
    fresh: Vec<bool>,
}

impl<L, const POINTS: usize> Default for Batches<L, POINTS> {
    fn default() -> Self {
        Self {
            constraints: Vec::new(),
            place: Vec::new(),
            a: Vec::new(),
            b: Vec::new(),
            stale: Vec::new(),
            fresh: Vec::new(),
        }
    }
}

impl<L: Lanes, const POINTS: usize> Batches<L, POINTS> {
    fn clear(&mut self) {
        self.place.clear();
        self.a.clear();
        self.b.clear();
    }

    fn len(&self) -> usize {
        self.place.len() / L::WIDTH
    }

    /// Appends contacts, at most `width` per batch, and notes where each went.
    fn push(&mut self, places: &[u32], width: usize, manifolds: &Manifolds<L::Elem>, batch_of: &mut [Home]) {
        for places in places.chunks(width) {
            let batch = self.len() as u32;
            for (lane, &place) in places.iter().enumerate() {
                let [a, b] = manifolds.slots(place as usize);
                self.place.push(place);
                self.a.push(a);
                self.b.push(b);
                batch_of[place as usize] = Home { batch, lane: lane as u8, points: POINTS as u8 };
            }
            let padded = (batch as usize + 1) * L::WIDTH;
            self.place.resize(padded, manifolds.padding());
            self.a.resize(padded, 0);
            self.b.resize(padded, 0);
        }
    }

    fn finish(&mut self, empty: Constraint<L, POINTS>) {
        let batches = self.len();
        self.constraints.resize(batches, empty);
        self.stale.clear();
        self.stale.resize(batches, ALL_LANES);
        self.fresh.clear();
        self.fresh.resize(batches, false);
    }

    /// Visits the batches of which lanes are stale, or those of which none is.
    fn visit_where(&mut self, stale: bool, visitor: &mut impl Visit<L>) {
        for at in 0..self.len() {
            if (self.stale[at] != 0) == stale {
                self.visit(at..at + 1, visitor);
            }
        }
    }

    #[inline(always)]
    fn visit(&mut self, batches: std::ops::Range<usize>, visitor: &mut impl Visit<L>) {
        for at in batches {
            // Here and in `look` in full: handed out by a function, arrays cost the impulse solver 6 %.
            let lanes = at * L::WIDTH..(at + 1) * L::WIDTH;
            let (mut a, mut b) = ([0; 16], [0; 16]);
            a[..L::WIDTH].copy_from_slice(&self.a[lanes.clone()]);
            b[..L::WIDTH].copy_from_slice(&self.b[lanes.clone()]);
            let ends = Ends { place: &self.place[lanes], a: &a, b: &b, fresh: self.fresh[at] };
            visitor.visit(&mut self.constraints[at], ends, at);
        }
    }

    /// Visits all, on copies.
    #[inline(always)]
    fn look(&self, visitor: &mut impl Visit<L>) {
        for at in 0..self.len() {
            let lanes = at * L::WIDTH..(at + 1) * L::WIDTH;
            let (mut a, mut b) = ([0; 16], [0; 16]);
            a[..L::WIDTH].copy_from_slice(&self.a[lanes.clone()]);
            b[..L::WIDTH].copy_from_slice(&self.b[lanes.clone()]);
            let ends = Ends { place: &self.place[lanes], a: &a, b: &b, fresh: self.fresh[at] };
            visitor.visit(&mut self.constraints[at].clone(), ends, at);
        }
    }

    fn prepare_stale(&mut self, manifolds: &Manifolds<L::Elem>, inverse_masses: &[[L::Elem; 4]]) {
        for at in 0..self.len() {
            let stale = std::mem::take(&mut self.stale[at]);
            if stale != 0 {
                self.fresh[at] = true;
                let old = self.constraints[at];
                let lanes = at * L::WIDTH..(at + 1) * L::WIDTH;
                let slots = [&self.a[lanes.clone()], &self.b[lanes.clone()]];
                self.constraints[at] = prepared(manifolds, inverse_masses, &self.place[lanes], slots);
                if stale != ALL_LANES {
                    self.constraints[at].keep_velocity_impulses(&old, stale);
                }
            }
        }
    }
}

#[inline(always)]
fn prepared<L: Lanes, const POINTS: usize>(
    manifolds: &Manifolds<L::Elem>,
    inverse_masses: &[[L::Elem; 4]],
    places: &[u32],
    slots: [&[u32]; 2],
) -> Constraint<L, POINTS> {
    let mut two_points = [L::Elem::ZERO; 16];
    if POINTS == 2 {
        for (two, &place) in two_points[..L::WIDTH].iter_mut().zip(places) {
            *two = if manifolds.code(place as usize).points() == 2 { L::Elem::ONE } else { L::Elem::ZERO };
        }
    }
    let masses = |slots: &[u32]| {
        let [inv_mass, inv_inertia, ..] = L::gather_fours(inverse_masses, slots);
        [inv_mass, inv_inertia]
    };
    Constraint::prepare(&Parts {
        geometry: L::gather_rows(manifolds.geometry(), places),
        gap: L::gather_fours(manifolds.gaps(), places),
        impulse: L::gather_fours(manifolds.impulses(), places),
        inverse_masses: slots.each(masses),
        two_points: L::zero().lt(L::load(&two_points)),
    })
}

/// One colour's batches, as ranges.
#[derive(Clone, Debug)]
struct Span {
    two: std::ops::Range<usize>,
    one: std::ops::Range<usize>,
}

/// All contacts in batches; memory is kept from step to step.
#[derive(Clone, Debug)]
pub struct Stream<L: Lanes> {
    two: Batches<L, 2>,
    one: Batches<L, 1>,
    /// Colour by colour within a substep group, substep group by substep group.
    spans: Vec<Span>,
    /// Where each substep group's spans end.
    substep_group_ends: Vec<usize>,
    /// The spans passes go over.
    active: std::ops::Range<usize>,
    /// Places of one colour and substep group, while batches are cut.
    picked: Vec<u32>,
    /// Per place of a pair.
    batch_of: Vec<Home>,
}

impl<L: Lanes> Default for Stream<L> {
    fn default() -> Self {
        Self {
            two: Batches::default(),
            one: Batches::default(),
            spans: Vec::new(),
            substep_group_ends: Vec::new(),
            active: 0..0,
            picked: Vec::new(),
            batch_of: Vec::new(),
        }
    }
}

/// Which lane of which batch holds a pair's contact.
#[derive(Clone, Copy, Debug)]
struct Home {
    batch: u32,
    lane: u8,
    /// 2 or 1: whose batches; 0 for a pair that does not touch.
    points: u8,
}

/// In no batch.
const NOWHERE: Home = Home { batch: 0, lane: 0, points: 0 };
/// All lanes of a batch are stale.
const ALL_LANES: u32 = u32::MAX;

impl<L: Lanes> Stream<L> {
    /// Cuts the colours into batches of at most `WIDTH` contacts, those of each substep group apart.
    pub fn cut(
        &mut self,
        coloring: &Coloring,
        manifolds: &Manifolds<L::Elem>,
        substep_groups: &SubstepGroups<L::Elem>,
    ) {
        self.two.clear();
        self.one.clear();
        self.spans.clear();
        self.substep_group_ends.clear();
        self.batch_of.clear();
        self.batch_of.resize(manifolds.pairs() + 2, NOWHERE);
        for substep_group in 0..substep_groups.count() {
            self.cut_substep_group(coloring, manifolds, |place| {
                substep_groups.of_pair(manifolds.slots(place as usize)) == substep_group
            });
            self.substep_group_ends.push(self.spans.len());
        }
        self.active = 0..self.spans.len();
        let nothing = Parts {
            geometry: [L::zero(); 8],
            gap: [L::zero(); 4],
            impulse: [L::zero(); 4],
            inverse_masses: [[L::zero(); 2]; 2],
            two_points: L::zero().lt(L::zero()),
        };
        self.two.finish(Constraint::prepare(&nothing));
        self.one.finish(Constraint::prepare(&nothing));
    }

    fn cut_substep_group(
        &mut self,
        coloring: &Coloring,
        manifolds: &Manifolds<L::Elem>,
        belongs: impl Fn(u32) -> bool,
    ) {
        let order = coloring.order();
        let mut picked = std::mem::take(&mut self.picked);
        for color in coloring.colors() {
            let (two, one) = (self.two.len(), self.one.len());
            let pick = |places: &[u32], picked: &mut Vec<u32>| {
                picked.clear();
                picked.extend(places.iter().copied().filter(|&place| belongs(place)));
            };
            pick(&order[color.two.clone()], &mut picked);
            self.two.push(&picked, L::WIDTH, manifolds, &mut self.batch_of);
            pick(&order[color.one.clone()], &mut picked);
            self.one.push(&picked, L::WIDTH, manifolds, &mut self.batch_of);
            self.spans.push(Span { two: two..self.two.len(), one: one..self.one.len() });
        }
        for &place in order[coloring.overflow()].iter().filter(|&&place| belongs(place)) {
            let (two, one) = (self.two.len(), self.one.len());
            if manifolds.code(place as usize).points() == 2 {
                self.two.push(&[place], 1, manifolds, &mut self.batch_of);
            } else {
                self.one.push(&[place], 1, manifolds, &mut self.batch_of);
            }
            self.spans.push(Span { two: two..self.two.len(), one: one..self.one.len() });
        }
        self.picked = picked;
    }

    /// Passes go over the contacts of one substep group from now on, or over all.
    pub fn choose(&mut self, substep_group: Option<usize>) {
        self.active = match substep_group {
            None => 0..self.spans.len(),
            Some(0) => 0..self.substep_group_ends.first().copied().unwrap_or(0),
            Some(substep_group) => {
                self.substep_group_ends[substep_group - 1]..self.substep_group_ends[substep_group]
            }
        };
    }

    /// Notes that the manifold at a place was found anew.
    #[inline(always)]
    pub fn touch(&mut self, place: u32) {
        let home = self.batch_of[place as usize];
        let stale = match home.points {
            0 => return,
            1 => &mut self.one.stale,
            _ => &mut self.two.stale,
        };
        stale[home.batch as usize] |= 1 << home.lane;
    }

    /// Prepares the batches whose manifolds are new; `inverse_masses` has rows 1/m, 1/I, –, – per slot.
    pub fn begin(&mut self, manifolds: &Manifolds<L::Elem>, inverse_masses: &[[L::Elem; 4]]) {
        self.two.prepare_stale(manifolds, inverse_masses);
        self.one.prepare_stale(manifolds, inverse_masses);
    }

    /// One pass over the contacts chosen: colour by colour, two-point contacts first, the overflow last.
    #[inline(always)]
    pub fn visit(&mut self, visitor: &mut impl Visit<L>) {
        for span in &self.spans[self.active.clone()] {
            self.two.visit(span.two.clone(), visitor);
            self.one.visit(span.one.clone(), visitor);
        }
    }

    /// Hands gaps and impulses of the batches with a touched place, or of all others, back to the pairs; `moved` has
    /// the rows x, y, angle of the last substep's displacement per slot, by which the gaps still have to change;
    /// `None` where they are up to date.
    pub fn end_where(
        &mut self,
        touched: bool,
        manifolds: &mut Manifolds<L::Elem>,
        moved: Option<&[[L::Elem; 4]]>,
    ) {
        let store = &mut Store { manifolds, moved };
        self.two.visit_where(touched, store);
        self.one.visit_where(touched, store);
    }

    /// Reads all batches: `visitor` gets copies.
    pub fn look(&self, visitor: &mut impl Visit<L>) {
        self.two.look(visitor);
        self.one.look(visitor);
    }

    /// From now on displacements are news to all constraints.
    pub fn age(&mut self) {
        self.two.fresh.fill(false);
        self.one.fresh.fill(false);
    }

    /// Batches of two-point and of one-point contacts.
    pub fn batches(&self) -> [usize; 2] {
        [self.two.len(), self.one.len()]
    }

    /// Bytes of constraint and slots a pass streams per two-point and one-point contact.
    pub fn bytes_per_contact() -> [usize; 2] {
        [size_of::<Constraint<L, 2>>(), size_of::<Constraint<L, 1>>()].each(|bytes| bytes / L::WIDTH + 8)
    }

    /// Bytes of constraints and slots a pass streams.
    pub fn bytes(&self) -> usize {
        let [two, one] = Self::bytes_per_contact();
        (self.two.len() * two + self.one.len() * one) * L::WIDTH
    }
}

struct Store<'a, R: Real> {
    manifolds: &'a mut Manifolds<R>,
    moved: Option<&'a [[R; 4]]>,
}

impl<L: Lanes> Visit<L> for Store<'_, L::Elem> {
    #[inline(always)]
    fn visit<const POINTS: usize>(&mut self, c: &mut Constraint<L, POINTS>, ends: Ends<'_>, _: usize) {
        if let Some(moved) = self.moved {
            c.follow(moved, &ends);
        }
        let of = |value: fn(&Point<L>) -> L| {
            [value(&c.points[0]), if POINTS == 2 { value(&c.points[POINTS - 1]) } else { L::zero() }]
        };
        let ([s0, s1], [n0, n1]) = (of(|p| p.separation), of(Point::impulse));
        L::scatter_fours([s0, s1, c.friction, c.restitution], self.manifolds.gaps_mut(), ends.place);
        L::scatter_fours([n0, n1, c.tangent_impulse, L::zero()], self.manifolds.impulses_mut(), ends.place);
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
