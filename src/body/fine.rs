//! Positions finer than the scalar: a column's number and what it leaves out, together twice the digits.
//!
//! A step adds what bodies have moved by to the sum of both and splits it anew, exactly (Knuth, The Art of Computer
//! Programming 2, §4.2.2, theorem B); pairs, joints and walls see the difference of both bodies' columns, which is exact
//! where they are near each other, plus that of their remainders. Fields and the broad phase read columns alone: the
//! first are as coarse as these are far from the origin, the second reaches further by [`Bodies::grain`].

use super::Bodies;
use crate::column::{Column, PAD};
use crate::each::Each as _;
use crate::lanes::{Lanes, Real};
use crate::vec2::Vec2;

impl<R: Real> Bodies<R> {
    /// From now on positions are finer than their columns, or no longer are.
    pub fn set_fine(&mut self, fine: bool) {
        if !fine {
            self.fine = None;
        } else if self.fine.is_none() {
            self.fine = Some(Column::new(R::ZERO));
            self.resize_fine(self.len());
        }
    }

    pub(super) fn resize_fine(&mut self, len: usize) {
        if let Some(rows) = &mut self.fine {
            rows.resize(len.next_multiple_of(PAD) * 4);
        }
    }

    /// The centroid of the body in a slot, metres.
    #[inline]
    pub fn place(&self, slot: usize) -> [f64; 2] {
        let [x, y] = [self.x[slot].to_f64(), self.y[slot].to_f64()];
        match &self.fine {
            None => [x, y],
            Some(rows) => {
                let [dx, dy, ..] = rows.fours()[slot];
                [x + dx.to_f64(), y + dy.to_f64()]
            }
        }
    }

    /// Puts a body's centroid there, metres.
    pub fn set_place(&mut self, slot: usize, place: [f64; 2]) {
        let [x, y] = place.each(R::from_f64);
        (self.x[slot], self.y[slot]) = (x, y);
        if let Some(rows) = &mut self.fine {
            let rest = |place: f64, column: R| R::from_f64(place - column.to_f64());
            rows.fours_mut()[slot] = [rest(place[0], x), rest(place[1], y), R::ZERO, R::ZERO];
        }
    }

    /// A coordinate as a body can have it.
    pub fn rounded(&self, coordinate: f64) -> f64 {
        if self.fine.is_some() { coordinate } else { R::from_f64(coordinate).to_f64() }
    }

    /// What a coordinate is rounded by at most, over itself.
    pub fn place_epsilon(&self) -> f64 {
        let epsilon = R::EPSILON.to_f64();
        if self.fine.is_some() { epsilon * epsilon } else { epsilon }
    }

    /// The most that the distance of two bodies can differ from that of their columns, metres.
    pub fn grain(&self) -> R {
        if self.fine.is_none() {
            return R::ZERO;
        }
        let far =
            |most: f64, slot: usize| most.max(self.x[slot].to_f64().abs()).max(self.y[slot].to_f64().abs());
        R::from_f64(2.0 * R::EPSILON.to_f64() * self.slots().fold(0.0, far))
    }

    /// Moves the bodies of one lane value, where positions are finer than their columns.
    #[inline(always)]
    pub(crate) fn move_lanes<L: Lanes<Elem = R>>(&mut self, at: usize, moved: [L; 2]) {
        let Some(rows) = &mut self.fine else { return };
        move_finely([self.x.lanes_mut(), self.y.lanes_mut()], rows.fours_mut(), at, moved);
    }
}

/// Moves the bodies of one lane value, whose columns x and y and what they are beyond these are here.
#[inline(always)]
pub(crate) fn move_finely<L: Lanes>(
    columns: [&mut [L]; 2],
    rows: &mut [[L::Elem; 4]],
    at: usize,
    moved: [L; 2],
) {
    let rows = &mut rows[at * L::WIDTH..(at + 1) * L::WIDTH];
    let mut rest = L::gather_fours(rows, &crate::lanes::IN_ORDER);
    for (k, column) in columns.into_iter().enumerate() {
        let (old, add) = (column[at], rest[k] + moved[k]);
        let sum = old + add;
        let taken = sum - old;
        rest[k] = (old - (sum - taken)) + (add - taken);
        column[at] = sum;
    }
    L::scatter_fours(rest, rows, &crate::lanes::IN_ORDER);
}

/// From body A to body B, in lanes, where columns and remainders are these.
#[inline(always)]
pub(crate) fn fine_difference<L: Lanes>([a, b]: [Vec2<L>; 2], [rest_a, rest_b]: [[L; 4]; 2]) -> Vec2<L> {
    (b - a) + Vec2::new(rest_b[0] - rest_a[0], rest_b[1] - rest_a[1])
}
