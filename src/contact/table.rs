//! The list of candidate pairs, and what each keeps from step to step.

use super::{Code, Contact, ContactPoint, Home, gap, geometry, impulse};
use crate::column::Column;
use crate::lanes::{ROW, Real};

/// One list of pairs with what each keeps. The last two places are no pairs: [`Manifolds::padding`] is all zeros
/// and is what padding lanes of a solver read; [`Manifolds::spill`] is where padding lanes of the narrow phase write.
#[derive(Clone, Debug)]
pub(super) struct PairTable<R: Real> {
    /// Slots of the bodies A and B.
    pub(super) a: Vec<u32>,
    pub(super) b: Vec<u32>,
    /// Ends of the six buckets.
    pub(super) ends: [usize; 6],
    pub(super) code: Column<R>,
    pub(super) geometry: Column<R>,
    pub(super) gap: Column<R>,
    pub(super) impulse: Column<R>,
    pub(super) home: Vec<Home>,
}

impl<R: Real> Default for PairTable<R> {
    fn default() -> Self {
        let zeros = || Column::new(R::ZERO);
        let mut table = Self {
            a: Vec::new(),
            b: Vec::new(),
            ends: [0; 6],
            code: zeros(),
            geometry: zeros(),
            gap: zeros(),
            impulse: zeros(),
            home: Vec::new(),
        };
        table.resize(0);
        table
    }
}

impl<R: Real> PairTable<R> {
    pub(super) fn resize(&mut self, pairs: usize) {
        let places = pairs + 2;
        self.a.resize(places, 0);
        self.b.resize(places, 0);
        self.home.resize(places, Home::NONE);
        self.grow_columns(places);
    }

    pub(super) fn grow_columns(&mut self, places: usize) {
        if self.code.len() < places {
            // Grown with room to spare, so that a list that wavers does not allocate.
            let room = places.next_power_of_two();
            self.code.resize(room);
            self.geometry.resize(room * ROW);
            self.gap.resize(room * 4);
            self.impulse.resize(room * 4);
        }
    }

    /// Room for as many pairs as the other table has, so that the next list does not allocate.
    pub(super) fn make_room(&mut self, pairs: usize) {
        let more = (pairs + 2).saturating_sub(self.a.len());
        self.a.reserve(more);
        self.b.reserve(more);
        self.home.reserve(more);
        self.grow_columns(pairs + 2);
    }

    /// The places of a bucket.
    pub(super) fn bucket(&self, number: usize) -> std::ops::Range<usize> {
        let start = if number == 0 { 0 } else { self.ends[number - 1] };
        start..self.ends[number]
    }

    /// Lower slot, then higher: ascends along a bucket.
    #[inline(always)]
    pub(super) fn order(&self, at: usize) -> u64 {
        let (a, b) = (self.a[at], self.b[at]);
        u64::from(a.min(b)) << 32 | u64::from(a.max(b))
    }

    #[inline]
    pub(super) fn clear_place(&mut self, at: usize, code: R) {
        self.code[at] = code;
        self.geometry.rows_mut()[at] = [R::ZERO; ROW];
        self.gap.fours_mut()[at] = [R::ZERO; 4];
        self.impulse.fours_mut()[at] = [R::ZERO; 4];
        self.home[at] = Home::NONE;
    }

    /// Takes over what a pair keeps: nobody asks for the rows of one that does not touch.
    #[inline]
    pub(super) fn take_place(&mut self, at: usize, old: &Self, old_at: usize) {
        (self.code[at], self.home[at]) = (old.code[old_at], old.home[old_at]);
        if Code::of(self.code[at]).points() > 0 {
            self.geometry.rows_mut()[at] = old.geometry.rows()[old_at];
            self.gap.fours_mut()[at] = old.gap.fours()[old_at];
            self.impulse.fours_mut()[at] = old.impulse.fours()[old_at];
        }
    }

    /// The list ends here: makes room for no more than it has, and clears the places that are no pairs.
    pub(super) fn close(&mut self) {
        let pairs = self.ends[5];
        self.resize(pairs);
        for at in [pairs, pairs + 1] {
            (self.a[at], self.b[at]) = (0, 0);
            self.clear_place(at, R::ZERO);
        }
    }

    /// The contact at a place, spelled out.
    pub(super) fn contact(&self, at: usize) -> Contact {
        let (a, b, code) = (self.a[at], self.b[at], Code::of(self.code[at]));
        let (row, gap, push) = (self.geometry.rows()[at], self.gap.fours()[at], self.impulse.fours()[at]);
        let value = |k: usize| row[k].to_f64();
        let point = |k: usize| ContactPoint {
            arm_a: [value(geometry::ARM_A + 2 * k), value(geometry::ARM_A + 2 * k + 1)],
            separation: gap[gap::SEPARATION + k].to_f64(),
            feature: code.feature(k),
            impulse: push[impulse::NORMAL + k].to_f64(),
        };
        let points = (0..code.points()).map(point).collect();
        let tangent_impulse = push[impulse::TANGENT].to_f64();
        Contact { a, b, normal: [value(0), value(1)], points, tangent_impulse }
    }

    pub(super) fn bytes(&self) -> usize {
        let columns = self.code.bytes() + self.geometry.bytes() + self.gap.bytes() + self.impulse.bytes();
        columns + (self.a.capacity() + self.home.capacity()) * 8
    }
}
