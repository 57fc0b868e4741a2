//! Joints of one shape in batches of lanes.

use std::ops::Range;

use super::stream::Sources;
use super::{Linkage, lanes};
use crate::each::Each as _;
use crate::joint::Held;
use crate::lanes::Lanes;

/// In no place: padding lanes.
pub(super) const NOWHERE: u32 = u32::MAX;

/// The widest lanes: what arrays of a batch's joints are sized for.
pub(super) const MOST: usize = 16;

/// Whom a batch's lanes join: `WIDTH` entries each count; see [`Ends`](crate::solve::batches::Ends).
#[derive(Clone, Copy)]
pub(super) struct Joined<'a> {
    pub(super) place: &'a [u32],
    pub(super) a: &'a [u32; 16],
    pub(super) b: &'a [u32; 16],
}

/// Batches of one shape.
#[derive(Clone, Debug)]
pub(super) struct Batches<C> {
    pub(super) links: Vec<C>,
    /// Places of joints, `WIDTH` entries per batch, as are `a` and `b`.
    pub(super) place: Vec<u32>,
    pub(super) a: Vec<u32>,
    pub(super) b: Vec<u32>,
}

impl<C> Default for Batches<C> {
    fn default() -> Self {
        Self { links: Vec::new(), place: Vec::new(), a: Vec::new(), b: Vec::new() }
    }
}

impl<C> Batches<C> {
    /// Batch and lane of every joint, and the slots of its bodies A and B.
    pub(super) fn ends(&self, width: usize) -> Vec<([usize; 2], [usize; 2])> {
        let all = self.place.iter().zip(self.a.iter().zip(&self.b)).enumerate();
        let real = all.filter(|(_, (place, _))| **place != NOWHERE);
        real.map(|(k, (_, (a, b)))| ([k / width, k % width], [*a as usize, *b as usize])).collect()
    }

    pub(super) fn link(&self, batch: usize) -> &C {
        &self.links[batch]
    }

    pub(super) fn link_mut(&mut self, batch: usize) -> &mut C {
        &mut self.links[batch]
    }

    pub(super) fn clear(&mut self) {
        self.links.clear();
        self.place.clear();
        self.a.clear();
        self.b.clear();
    }

    #[inline(always)]
    pub(super) fn each<L: Lanes>(&mut self, batches: Range<usize>, mut pass: impl FnMut(&mut C, Joined<'_>)) {
        // Slices once: in the loop they would be looked up again after every store.
        let links = self.links.as_mut_slice();
        let lists = [&self.place, &self.a, &self.b].each(Vec::as_slice);
        for at in batches {
            let [place, of_a, of_b] = lists.each(|of| &of[at * L::WIDTH..][..L::WIDTH]);
            let (mut a, mut b) = ([0; MOST], [0; MOST]);
            for lane in 0..L::WIDTH {
                (a[lane], b[lane]) = (of_a[lane], of_b[lane]);
            }
            pass(&mut links[at], Joined { place, a: &a, b: &b });
        }
    }

    /// Appends joints, at most `width` per batch.
    pub(super) fn push<L: Lanes>(&mut self, places: &[u32], width: usize, sources: &Sources<'_, L::Elem>)
    where
        C: Linkage<L>,
    {
        for places in places.chunks(width) {
            let joints = sources.joints_in(places);
            let mut held = [Held::default(); MOST];
            for ((held, &place), joint) in held.iter_mut().zip(places).zip(&joints) {
                *held = sources.joints.held_at(place);
                let [a, b] = joint.map_or([0; 2], |joint| joint.bodies.each(|id| id.slot() as u32));
                self.place.push(place);
                self.a.push(a);
                self.b.push(b);
            }
            let padded = (self.links.len() + 1) * L::WIDTH;
            self.place.resize(padded, NOWHERE);
            self.a.resize(padded, 0);
            self.b.resize(padded, 0);
            let first = padded - L::WIDTH;
            let inv_inertia = [&self.a, &self.b]
                .each(|slots| lanes(&slots[first..], |&slot| sources.bodies.inv_inertia[slot as usize]));
            self.links.push(C::new(&joints, &sources.numbers(&joints), &held, inv_inertia));
        }
    }

    /// Another length of substeps: rows are made anew, impulses stay.
    pub(super) fn retune<L: Lanes>(&mut self, sources: &Sources<'_, L::Elem>)
    where
        C: Linkage<L>,
    {
        for (link, places) in self.links.iter_mut().zip(self.place.chunks(L::WIDTH)) {
            link.retune(&sources.numbers(&sources.joints_in(places)));
        }
    }
}
