//! Contacts read out of constraints, which stay as they are: for recordings.

use super::Solving;
use super::constraint::{Constraint, Point};
use super::stream::{Ends, Visit};
use crate::contact::{ContactRow, Manifolds};
use crate::each::Each as _;
use crate::lanes::Lanes;
use crate::motion::Motion;

/// Reads batches out.
struct Read<'a, L: Lanes, F> {
    manifolds: &'a Manifolds<L::Elem>,
    /// Displacements that gaps have yet to hear of.
    moved: Option<&'a [[L::Elem; 4]]>,
    tell: F,
}

impl<L: Lanes, F: FnMut(&ContactRow<L::Elem>)> Visit<L> for Read<'_, L, F> {
    #[inline(always)]
    fn visit<const POINTS: usize>(&mut self, c: &mut Constraint<L, POINTS>, ends: Ends<'_>, _: usize) {
        if let Some(moved) = self.moved {
            c.follow(moved, &ends);
        }
        let of = |value: fn(&Point<L>) -> L| {
            [&c.points[0], &c.points[POINTS - 1]].each(|point| value(point).to_array())
        };
        let ([s0, s1], [n0, n1]) = (of(|p| p.separation), of(Point::impulse));
        let tangent = c.tangent_impulse.to_array();
        for (lane, &place) in ends.place.iter().enumerate() {
            if place != self.manifolds.padding() {
                let known = ([s0[lane], s1[lane]], [n0[lane], n1[lane]], tangent[lane]);
                (self.tell)(&self.manifolds.row(place as usize, known));
            }
        }
    }
}

impl<L: Lanes> Solving<L> {
    /// Tells of each touching pair with its gaps and impulses of the step's end, those of sleeping bodies last, in an
    /// order that depends on lanes.
    pub fn each_contact(
        &self,
        manifolds: &Manifolds<L::Elem>,
        motion: &Motion<L::Elem>,
        mut tell: impl FnMut(&ContactRow<L::Elem>),
    ) {
        if self.pairs_are_up_to_date() {
            manifolds.rows().for_each(|row| tell(&row));
        } else {
            let moved = self.yet_to_follow(motion);
            self.stream().look(&mut Read { manifolds, moved, tell: &mut tell });
        }
        manifolds.resting_rows().for_each(|row| tell(&row));
    }
}
