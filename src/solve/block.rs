//! The direct solution of a contact's normal impulses together.
//!
//! One point after the other left a resting box turning at 0.02 rad/s, and let columns lean: 40 boxes fell at 4
//! substeps. Together a symmetric column stays symmetric to the bit and 80 boxes stand at 8, for a tenth more time.

use super::constraint::{Constraint, Normals, Side};
use crate::each::Each as _;
use crate::lanes::Lanes;

/// K₀₁: what a unit impulse at one point changes the normal velocity of the other by; 0 for one point.
#[inline(always)]
pub(super) fn cross<L: Lanes, const POINTS: usize>(c: &Constraint<L, POINTS>, normals: &Normals<L>) -> L {
    if POINTS == 1 {
        return L::zero();
    }
    let ([la, lb], [ma, mb]) = (c.points[0].levers, c.points[POINTS - 1].levers);
    let [ia, ib] = c.inv_inertia;
    normals.inv_mass() + (ia * (la * ma) + ib * (lb * mb))
}

/// What the accumulated impulses change the normal velocities by: K·λ, from `velocity_impulse` = λ/m, m/s.
#[inline(always)]
pub(super) fn answer<L: Lanes, const POINTS: usize>(
    cross: L,
    masses: [L; POINTS],
    velocity_impulse: [L; POINTS],
) -> [L; POINTS] {
    if POINTS == 1 {
        return velocity_impulse;
    }
    crate::each::indexed(|k| {
        velocity_impulse[k] + cross * (masses[POINTS - 1 - k] * velocity_impulse[POINTS - 1 - k])
    })
}

/// Impulses over their masses with which points that carry something neither close nor part; `per_sec` is 1/h.
#[inline(always)]
pub(super) fn relaxed<L: Lanes, const POINTS: usize>(
    c: &Constraint<L, POINTS>,
    normals: &Normals<L>,
    per_sec: L,
) -> [L; POINTS] {
    let (zero, cross) = (L::zero(), cross(c, normals));
    let masses = c.points.each(|point| point.mass);
    let velocity_impulse = c.points.each(|point| point.velocity_impulse);
    let answer = answer(cross, masses, velocity_impulse);
    let wanted: [L; POINTS] = crate::each::indexed(|k| {
        let point = &c.points[k];
        // A point that carried nothing may go on closing its gap.
        let closing = zero.max(point.separation) * per_sec;
        normals.velocity(point) + L::select(velocity_impulse[k].le(zero), closing, zero) - answer[k]
    });
    non_negative(cross, masses, wanted)
}

/// Pushes displaced bodies apart, as far as points lie `entered` < 0 too deep: `ways` are their displacements in progress.
#[inline(always)]
pub(super) fn part<L: Lanes, const POINTS: usize>(
    c: &Constraint<L, POINTS>,
    mut ways: Normals<L>,
    entered: [L; POINTS],
    [a, b]: [&mut Side<L>; 2],
) {
    let masses = c.points.each(|point| point.mass);
    let parted = non_negative(cross(c, &ways), masses, entered);
    for k in 0..POINTS {
        ways.push(c, k, masses[k] * parted[k]);
    }
    ways.end(c, a, b);
}

/// y ≥ 0 with K·x + b ≥ 0 and y·(K·x + b) = 0, where x = m·y are impulses, K has 1/m on its diagonal and
/// `cross` beside it: impulses, over their masses, that stop the points from approaching at −b.
///
/// One point: max(0, −b). Two: both push, else the first alone, else the second alone, else neither; the cases
/// exclude each other for a regular K. Points whose rows cancel to less than a thousandth count as one; a second
/// point without mass does not exist.
#[inline(always)]
pub(super) fn non_negative<L: Lanes, const POINTS: usize>(
    cross: L,
    masses: [L; POINTS],
    b: [L; POINTS],
) -> [L; POINTS] {
    let zero = L::zero();
    let alone = b.each(|b| zero.max(-b));
    if POINTS == 1 {
        return alone;
    }
    let last = POINTS - 1;
    let (by_last, by_first) = (cross * masses[last], cross * masses[0]);
    let determinant = L::one() - by_last * by_first;
    let least = L::lit(1e-3);
    let inverse = L::one() / least.max(determinant);
    let both = [(by_last * b[last] - b[0]) * inverse, (by_first * b[0] - b[last]) * inverse];
    let exists = zero.lt(masses[last]);
    let use_both = exists & least.lt(determinant) & zero.le(both[0]) & zero.le(both[1]);
    let use_first = !exists | zero.le(by_first * alone[0] + b[last]);
    let single = [L::select(use_first, alone[0], zero), L::select(use_first, zero, alone[last])];
    crate::each::indexed(|k| L::select(use_both, both[k], single[k]))
}
