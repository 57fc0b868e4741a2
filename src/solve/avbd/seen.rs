//! Contacts as `avbd` sees them: gathered anew from pairs, poses and rows.

use super::SubstepCoefficients;
use crate::contact::Manifolds;
use crate::lanes::{Lanes, Real};
use crate::vec2::Vec2;

/// `WIDTH` contacts as both their bodies see them.
pub(super) struct Seen<L> {
    pub(super) normal: Vec2<L>,
    /// r×n of A and B, point by point, then r×t in the middle.
    pub(super) levers: [[L; 2]; 3],
    pub(super) gaps: [L; 2],
    pub(super) friction: L,
    /// λ and λ_t, N, and k, N/m.
    pub(super) dual: [L; 4],
    /// 0 for the second point where there is none.
    pub(super) exists: L,
}

impl<L: Lanes> Seen<L> {
    #[inline(always)]
    pub(super) fn gather(
        manifolds: &Manifolds<L::Elem>,
        places: &[u32],
        coefficients: &SubstepCoefficients<L>,
    ) -> Self {
        let [nx, ny, ax0, ay0, ax1, ay1, dx, dy] = L::gather_rows(manifolds.geometry(), places);
        let [s0, s1, friction, _] = L::gather_fours(manifolds.gaps(), places);
        let [j0, j1, jt, k] = L::gather_fours(manifolds.impulses(), places);
        let mut exists = [L::Elem::ZERO; 16];
        for (lane, &place) in places[..L::WIDTH].iter().enumerate() {
            exists[lane] =
                if manifolds.code(place as usize).points() == 2 { L::Elem::ONE } else { L::Elem::ZERO };
        }
        let exists = L::load(&exists);
        let normal = Vec2::new(nx, ny);
        let tangent = -normal.right();
        let to_b = Vec2::new(dx, dy);
        let arms = [Vec2::new(ax0, ay0), Vec2::new(ax1, ay1)];
        let middle = arms[0] + (arms[1] - arms[0]) * (L::lit(0.5) * exists);
        let levers = |arm: Vec2<L>, axis: Vec2<L>| [arm.cross(axis), (arm - to_b).cross(axis)];
        Self {
            normal,
            levers: [levers(arms[0], normal), levers(arms[1], normal), levers(middle, tangent)],
            gaps: [s0, s1],
            friction,
            dual: [j0 * coefficients.force, j1 * coefficients.force, jt * coefficients.force, k],
            exists,
        }
    }

    /// What the separations and the slip change by.
    #[inline(always)]
    pub(super) fn change(&self, a: &[L; 4], b: &[L; 4]) -> [L; 3] {
        let d = Vec2::new(b[0] - a[0], b[1] - a[1]);
        let (along, across) = (d.dot(self.normal), d.dot(-self.normal.right()));
        let turn = |[la, lb]: [L; 2]| b[2] * lb - a[2] * la;
        [along + turn(self.levers[0]), along + turn(self.levers[1]), across + turn(self.levers[2])]
    }

    /// C of both points and of the tangent; `keep` is α.
    #[inline(always)]
    pub(super) fn violation(&self, a: &[L; 4], b: &[L; 4], keep: L) -> [L; 3] {
        let change = self.change(a, b);
        let zero = L::zero();
        let gap = |s: L| zero.max(s) + (L::one() - keep) * zero.min(s);
        [gap(self.gaps[0]) + change[0], gap(self.gaps[1]) + change[1], change[2]]
    }

    /// Forces along both normals and the tangent, and whether k counts there (1 or 0).
    #[inline(always)]
    pub(super) fn forces(&self, c: &[L; 3]) -> ([L; 3], [L; 3]) {
        let (zero, one) = (L::zero(), L::one());
        let [l0, l1, lt, k] = self.dual;
        let f0 = zero.max(l0 - k * c[0]);
        let f1 = zero.max(l1 - k * c[1]) * self.exists;
        let bound = self.friction * (f0 + f1);
        let wanted = lt - k * c[2];
        let ft = (-bound).max(bound.min(wanted));
        let on = |f: L| L::select(zero.lt(f), one, zero);
        ([f0, f1, ft], [on(f0), on(f1), L::select(wanted.abs().lt(bound), one, zero)])
    }
}

impl<L: Lanes> Seen<L> {
    /// Does a point push at the least C between where a body is and where inertia wants it (1 or 0)? Left out there, k
    /// would let the body fall in and be thrown out in turn.
    #[inline(always)]
    pub(super) fn presses(&self, point: usize, least_c: L) -> L {
        let push = self.dual[point] - self.dual[3] * least_c;
        let exists = if point == 0 { L::one() } else { self.exists };
        L::select(L::zero().lt(push), exists, L::zero())
    }

    /// The share of k that friction has: all while it holds, else its force over the slip, which bounds it from
    /// above and cannot turn a slip round.
    #[inline(always)]
    pub(super) fn drags(&self, load: L, slip: L, holds: L) -> L {
        let tiny = L::splat(L::Elem::EPSILON) * L::splat(L::Elem::EPSILON);
        let slides = (self.friction * load) / tiny.max(self.dual[3] * slip.abs());
        L::select(L::zero().lt(holds), L::one(), L::one().min(slides))
    }
}
