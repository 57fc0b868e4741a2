//! Passes over the contacts of several parts beside each other.
//!
//! Contacts of one colour share no body that moves, and contacts of different parts no row at all: a worker is handed the
//! rows of a part and the colour's list of its contacts. Those between parts follow. As the order within a colour says nothing,
//! the bits are those of one thread.

use super::{List, Stream, Visit};
use crate::body::Bodies;
use crate::column::PAD;
use crate::contact::Manifolds;
use crate::lanes::Lanes;
use crate::settings::MOST_THREADS;
use crate::workers::{Parts, PerPart, Workers, take};

/// Batches of a colour from which on it is shared out: some 3 µs.
const WORTH: usize = 24;

/// Steps after which parts are weighed again.
const EVEN_STEPS: u32 = 32;
/// What preparing and solving a contact takes, over what moving a body does.
const CONTACT_WEIGHT: u64 = 2;
/// What a contact between parts takes, over what others do: its rows come from another core, and one worker does all of them.
const BETWEEN: u64 = 4;

/// When parts were weighed, and what with.
#[derive(Clone, Debug, Default)]
pub(super) struct Balance {
    /// Of each block of slots.
    weights: Vec<u64>,
    until: u32,
}

/// The contacts of one part, or those between parts, of some colours.
pub(in crate::solve) struct Contacts<'a, L: Lanes> {
    lists: &'a mut [List<L>],
    /// Numbers of lists.
    colors: &'a [u16],
}

impl<L: Lanes> Contacts<'_, L> {
    /// One pass: colour by colour, two-point contacts first, the overflow last.
    #[inline(always)]
    pub(in crate::solve) fn visit(&mut self, visitor: &mut impl Visit<L>) {
        for &color in self.colors {
            let List { two, one, base, .. } = &mut self.lists[color as usize];
            two.visit(visitor, base[0]);
            one.visit(visitor, base[1]);
        }
    }
}

/// A pass over some contacts, on the rows of their bodies, of which the first belongs to a slot.
pub(in crate::solve) type Pass<'a, L> =
    &'a (dyn Fn(&mut [[<L as Lanes>::Elem; 4]], usize, &mut Contacts<'_, L>) + Sync);

impl<L: Lanes> Stream<L> {
    /// One pass over the contacts chosen, by one worker: `pass(first, contacts)` visits contacts whose slots count from the
    /// first on.
    #[inline(always)]
    pub(in crate::solve) fn each(&mut self, mut pass: impl FnMut(usize, &mut Contacts<'_, L>)) {
        let Self { lists, order, active, parts, .. } = self;
        let per_part = lists.len() / parts.lists();
        let mut at = active.start;
        while at < active.end {
            // Without parts all colours are one call.
            let end = if parts.count() == 1 { active.end } else { at + 1 };
            for (part, lists) in lists.chunks_mut(per_part).enumerate() {
                pass(parts.first(part), &mut Contacts { lists, colors: &order[at..end] });
            }
            at = end;
        }
    }

    /// One pass over the contacts chosen, on `rows` per slot; several parts beside each other.
    pub(in crate::solve) fn share(
        &mut self,
        workers: &Workers,
        rows: &mut [[L::Elem; 4]],
        pass: Pass<'_, L>,
    ) {
        let parts = self.parts.count();
        if parts == 1 {
            let colors = &self.order[self.active.clone()];
            return pass(rows, 0, &mut Contacts { lists: &mut self.lists, colors });
        }
        let per_part = self.colors_of_part();
        for at in self.active.clone() {
            let colors = &self.order[at..=at];
            let color = colors[0] as usize;
            let (own, between) = self.lists.split_at_mut(parts * per_part);
            let batches = own[color..].iter().step_by(per_part).map(|list| list.two.len() + list.one.len());
            if batches.sum::<usize>() < WORTH {
                for (part, lists) in own.chunks_mut(per_part).enumerate() {
                    let first = self.parts.first(part);
                    pass(&mut rows[first..], first, &mut Contacts { lists, colors });
                }
            } else {
                let mut jobs: PerPart<_> = std::array::from_fn(|_| None);
                let (mut left, mut first) = (&mut *rows, 0);
                let lists = own.chunks_mut(per_part);
                for ((job, lists), end) in jobs.iter_mut().zip(lists).zip(self.parts.ends()) {
                    let rows = take(&mut left, end.map(|end| end - first));
                    *job = Some((rows, first, Contacts { lists, colors }));
                    first = end.unwrap_or(first);
                }
                workers.each(&mut jobs[..parts], |_, job| {
                    if let Some((rows, first, contacts)) = job {
                        pass(rows, *first, contacts);
                    }
                });
            }
            pass(rows, 0, &mut Contacts { lists: between, colors });
        }
    }

    /// Cuts the world into so many parts, where it is time to; `None` where they stay as they are.
    pub(in crate::solve) fn divide(
        &mut self,
        count: usize,
        bodies: &Bodies<L::Elem>,
        manifolds: &Manifolds<L::Elem>,
    ) -> Option<Parts> {
        if count == 1 {
            return (self.parts.count() > 1).then(Parts::default);
        }
        let per_part = self.colors_of_part();
        let Self { balance: Balance { weights, until }, parts, lists, .. } = self;
        if *until > 0 && parts.count() > 1 {
            *until -= 1;
            return None;
        }
        *until = EVEN_STEPS;
        weights.clear();
        weights.resize(bodies.len().div_ceil(PAD), PAD as u64);
        for &place in manifolds.touching() {
            // Of what moves and what does not, the latter mostly comes first.
            let [a, b] = manifolds.slots(place as usize);
            weights[a.max(b) as usize / PAD] += CONTACT_WEIGHT;
        }
        let between = lists.get(parts.count() * per_part..).unwrap_or_default();
        let between = between.iter().map(|list| list.two.used() + list.one.used()).sum::<usize>() as u64;
        Parts::cut((weights, CONTACT_WEIGHT * BETWEEN * between), count, PAD, parts)
    }

    /// Does something with every list, those of a part by its worker; it is told the slot that a list's slots count from.
    pub(super) fn each_list(&mut self, workers: &Workers, work: impl Fn(usize, &mut List<L>) + Sync) {
        let per_part = self.colors_of_part().max(1);
        let mut jobs: [_; MOST_THREADS + 1] = std::array::from_fn(|_| None);
        let Self { lists, parts, order, .. } = self;
        for (job, lists) in jobs.iter_mut().zip(lists.chunks_mut(per_part)) {
            *job = Some(lists);
        }
        workers.each(&mut jobs[..parts.lists()], |part, job| {
            if let Some(lists) = job {
                let first = parts.first(part);
                for &color in &*order {
                    work(first, &mut lists[color as usize]);
                }
            }
        });
    }
}
