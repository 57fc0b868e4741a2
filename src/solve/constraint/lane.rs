//! One lane of a constraint: contacts come, go and move one by one.

use bytemuck::{cast_slice, cast_slice_mut};

use super::{Constraint, Point};
use crate::each::Each as _;
use crate::lanes::{Lanes, Real};

/// How many values a lane holds.
pub(in crate::solve) const LANE_VALUES: usize = 21;
/// What one lane holds: normal (2), inverse inertias (2), the tangent's levers (2), mass and impulse, friction, restitution, length;
/// of each point levers (2), mass, separation and impulse over mass. A second point that is none is 0.
pub(in crate::solve) type LaneValues<R> = [R; LANE_VALUES];

/// Indices into [`LaneValues`].
pub(in crate::solve) mod at {
    /// Of a point, metres: of A, and B's follows.
    pub(in crate::solve) const LEVERS: [usize; 2] = [11, 16];
    /// Along the tangent, N·s.
    pub(in crate::solve) const TANGENT_IMPULSE: usize = 7;
    /// Of a point, kg.
    pub(in crate::solve) const MASS: [usize; 2] = [13, 18];
    /// Of a point, metres.
    pub(in crate::solve) const SEPARATION: [usize; 2] = [14, 19];
    /// Of a point, m/s.
    pub(in crate::solve) const VELOCITY_IMPULSE: [usize; 2] = [15, 20];
}

impl<L: Lanes, const POINTS: usize> Constraint<L, POINTS> {
    /// Takes the lanes with a bit in `which` from another.
    pub(in crate::solve) fn take_lanes(&mut self, other: &Self, which: u32) {
        let bits: [L::Elem; 16] =
            crate::each::indexed(|k| if which >> k & 1 == 1 { L::Elem::ONE } else { L::Elem::ZERO });
        let taken = L::zero().lt(L::load(&bits));
        let others = other.values();
        self.change(|k, value| *value = L::select(taken, *others[k], *value));
    }

    /// What one lane holds; see [`LaneValues`].
    #[inline]
    pub(in crate::solve) fn lane(&self, k: usize) -> LaneValues<L::Elem> {
        let mut lane = self.values().each(|value| cast_slice::<L, L::Elem>(std::slice::from_ref(value))[k]);
        if POINTS == 1 {
            lane[LANE_VALUES - 5..].fill(L::Elem::ZERO);
        }
        lane
    }

    /// Impulses of one lane: of both points, along the tangent, –; N·s.
    pub(in crate::solve) fn impulses(&self, k: usize) -> [L::Elem; 4] {
        let at = |value: &L| cast_slice::<L, L::Elem>(std::slice::from_ref(value))[k];
        let of = |point: &Point<L>| at(&point.velocity_impulse) * at(&point.mass);
        let second = if POINTS == 1 { L::Elem::ZERO } else { of(&self.points[POINTS - 1]) };
        [of(&self.points[0]), second, at(&self.tangent_impulse), L::Elem::ZERO]
    }

    /// Changes the impulses of one lane that is to be prepared: N·s, as if masses were 1.
    pub(in crate::solve) fn set_impulses(&mut self, k: usize, row: [L::Elem; 4]) {
        let put =
            |value: &mut L, to: L::Elem| cast_slice_mut::<L, L::Elem>(std::slice::from_mut(value))[k] = to;
        for (at, point) in self.points.iter_mut().enumerate() {
            put(&mut point.mass, L::Elem::ONE);
            put(&mut point.velocity_impulse, row[at]);
        }
        put(&mut self.tangent_impulse, row[2]);
    }

    /// Changes what one lane holds.
    pub(in crate::solve) fn set_lane(&mut self, k: usize, lane: &LaneValues<L::Elem>) {
        self.change(|at, value| cast_slice_mut::<L, L::Elem>(std::slice::from_mut(value))[k] = lane[at]);
    }

    /// Every value, in the order of [`LaneValues`]; of one point alone it comes twice.
    #[inline(always)]
    fn values(&self) -> [&L; LANE_VALUES] {
        let Self { normal, inv_inertia: [ia, ib], tangent_levers: [ta, tb], .. } = self;
        let Self { tangent_mass, tangent_impulse, friction, restitution, length, .. } = self;
        let [p, q] = [&self.points[0], &self.points[POINTS - 1]];
        let [[pa, pb], [qa, qb]] = [&p.levers, &q.levers];
        [
            &normal.x,
            &normal.y,
            ia,
            ib,
            ta,
            tb,
            tangent_mass,
            tangent_impulse,
            friction,
            restitution,
            length,
            pa,
            pb,
            &p.mass,
            &p.separation,
            &p.velocity_impulse,
            qa,
            qb,
            &q.mass,
            &q.separation,
            &q.velocity_impulse,
        ]
    }

    /// Changes every value, with its number.
    #[inline(always)]
    fn change(&mut self, mut how: impl FnMut(usize, &mut L)) {
        let Self { normal, inv_inertia: [ia, ib], tangent_levers: [ta, tb], .. } = self;
        for (k, value) in [&mut normal.x, &mut normal.y, ia, ib, ta, tb].into_iter().enumerate() {
            how(k, value);
        }
        let Self { tangent_mass, tangent_impulse, friction, restitution, length, .. } = self;
        let rest = [tangent_mass, tangent_impulse, friction, restitution, length];
        for (k, value) in rest.into_iter().enumerate() {
            how(6 + k, value);
        }
        for (number, point) in self.points.iter_mut().enumerate() {
            let Point { levers: [la, lb], mass, separation, velocity_impulse } = point;
            for (k, value) in [la, lb, mass, separation, velocity_impulse].into_iter().enumerate() {
                how(11 + 5 * number + k, value);
            }
        }
    }
}
