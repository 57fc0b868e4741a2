//! Contacts as rows of numbers: what a recording holds of each.

use super::{Code, Manifolds, PairTable, gap, geometry, impulse};
use crate::lanes::Real;

/// What [`ContactRow::values`] holds, in order: unit normal from A to B; the points from A's centroid when the manifold
/// was found, world axes, metres; separations, metres; impulses, N·s per substep. A second point that is none is 0.
pub const CONTACT_COLUMNS: [&str; 11] = [
    "normal_x",
    "normal_y",
    "arm0_x",
    "arm0_y",
    "arm1_x",
    "arm1_y",
    "separation0",
    "separation1",
    "impulse0",
    "impulse1",
    "tangent_impulse",
];

/// A touching pair.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactRow<R> {
    /// Of bodies A and B.
    pub slots: [u32; 2],
    /// Points and features: f₀ + 2⁸·f₁ + 2¹⁶·points, as [`Code`] has them.
    pub code: u32,
    /// [`CONTACT_COLUMNS`].
    pub values: [R; CONTACT_COLUMNS.len()],
}

/// Gaps and impulses of a pair, wherever they are kept: separations, normal impulses, friction.
pub type GapsAndImpulses<R> = ([R; 2], [R; 2], R);

impl<R: Real> PairTable<R> {
    #[inline(always)]
    fn row_with(&self, at: usize, (gaps, pushes, tangent): GapsAndImpulses<R>) -> ContactRow<R> {
        const { assert!(geometry::NORMAL == 0 && geometry::ARM_A == 2) };
        let [nx, ny, x0, y0, x1, y1, ..] = self.geometry.rows()[at];
        let code = Code::of(self.code[at]);
        let second = [x1, y1, gaps[1], pushes[1]];
        let [x1, y1, gap1, push1] = if code.points() == 2 { second } else { [R::ZERO; 4] };
        let values = [nx, ny, x0, y0, x1, y1, gaps[0], gap1, pushes[0], push1, tangent];
        ContactRow { slots: [self.a[at], self.b[at]], code: code.0, values }
    }

    pub(super) fn own_row(&self, at: usize) -> ContactRow<R> {
        let (gaps, push) = (self.gap.fours()[at], self.impulse.fours()[at]);
        let separations = [gaps[gap::SEPARATION], gaps[gap::SEPARATION + 1]];
        let impulses = [push[impulse::NORMAL], push[impulse::NORMAL + 1]];
        self.row_with(at, (separations, impulses, push[impulse::TANGENT]))
    }
}

impl<R: Real> Manifolds<R> {
    /// The pair at a place with the gaps and impulses it is given.
    #[inline(always)]
    pub fn row(&self, place: usize, gaps_and_impulses: GapsAndImpulses<R>) -> ContactRow<R> {
        self.now.row_with(place, gaps_and_impulses)
    }

    /// The pair at a place with the gaps and impulses its rows hold.
    pub fn own_row(&self, place: usize) -> ContactRow<R> {
        self.now.own_row(place)
    }

    /// The touching pairs of what sleeps.
    pub fn resting_rows(&self) -> impl Iterator<Item = ContactRow<R>> + '_ {
        self.rest.touching().map(|at| self.rest.table().own_row(at))
    }
}
