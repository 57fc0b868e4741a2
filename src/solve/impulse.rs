//! `impulse`: the thesis's resolution, cleaned. One pass per substep; the cheap end of the diagram.
//!
//! Kept from it: e = min, μ = min, one impulse per point at once, positional correction by a share of
//! the depth beyond a slop. Mended: separating points are left alone, friction stays in Coulomb's cone,
//! slow approaches do not bounce, both points of a face are corrected, rotation takes part in the
//! correction, and the result does not depend on memory order.
//!
//! For a point with arms rA, rB and normal n, k = 1/mA + 1/mB + (rA×n)²/IA + (rB×n)²/IB and
//! jₙ = max(0, −(1 + e)·vₙ/k); jₜ = clamp(−vₜ/kₜ, ±μ·jₙ) along t = n turned a quarter counter-clockwise.
//! A point's present separation is s + n·(Δx_B + Δθ_B×rB − Δx_A − Δθ_A×rA): changes since the step began.
//!
//! The two points of a face are solved together, directly and by cases ([`non_negative`]): one after the
//! other left a resting box turning at 0.02 rad/s and creeping sideways at 5 cm/s; together, neither.

use crate::column::Column;
use crate::contact::{Manifolds, geometry, surface};
use crate::lanes::{Lanes, ROW, Real};
use crate::vec2::Vec2;

use super::Traits;
use super::color::Coloring;

/// Share of the depth beyond the slop that one pass takes away (the thesis's percent).
const CORRECTION_SHARE: f64 = 0.7;
/// Depth left alone, metres (the thesis's 0.01 px).
const SLOP_M: f64 = 4e-4;
/// Approaches slower than this do not bounce, m/s: gravity alone makes 0.16 m/s in a step of 1/60 s.
const BOUNCE_THRESHOLD_M_PER_S: f64 = 0.5;

/// One pass over all contacts, colour by colour.
pub(super) fn solve<L: Lanes>(
    traits: Traits,
    manifolds: &Manifolds<L::Elem>,
    coloring: &Coloring,
    rows: &mut Column<L::Elem>,
) {
    let rows = rows.rows_mut();
    match (traits.friction, traits.restitution) {
        (true, true) => solve_with::<L, true, true>(manifolds, coloring, rows),
        (true, false) => solve_with::<L, true, false>(manifolds, coloring, rows),
        (false, true) => solve_with::<L, false, true>(manifolds, coloring, rows),
        (false, false) => solve_with::<L, false, false>(manifolds, coloring, rows),
    }
}

fn solve_with<L: Lanes, const FRICTION: bool, const BOUNCE: bool>(
    manifolds: &Manifolds<L::Elem>,
    coloring: &Coloring,
    rows: &mut [[L::Elem; ROW]],
) {
    coloring.for_each_group(|contacts, points, may_batch| {
        let size = if may_batch { L::WIDTH } else { 1 };
        for batch in contacts.chunks(size) {
            if points == 1 {
                solve_batch::<L, FRICTION, BOUNCE, 1>(manifolds, batch, rows);
            } else {
                solve_batch::<L, FRICTION, BOUNCE, 2>(manifolds, batch, rows);
            }
        }
    });
}

/// Velocity and displacement of the bodies of one side of a batch.
#[derive(Clone, Copy)]
struct Side<L> {
    velocity: Vec2<L>,
    spin: L,
    inv_mass: L,
    inv_inertia: L,
    moved: Vec2<L>,
    turned: L,
}

impl<L: Lanes> Side<L> {
    #[inline(always)]
    fn gather(rows: &[[L::Elem; ROW]], index: &[u32]) -> Self {
        let [vx, vy, spin, inv_mass, inv_inertia, mx, my, turned] = L::gather_rows(rows, index);
        Self { velocity: Vec2::new(vx, vy), spin, inv_mass, inv_inertia, moved: Vec2::new(mx, my), turned }
    }

    #[inline(always)]
    fn scatter(&self, rows: &mut [[L::Elem; ROW]], index: &[u32]) {
        let mut out = [[L::Elem::ZERO; ROW]; 16];
        let values = [
            self.velocity.x,
            self.velocity.y,
            self.spin,
            self.inv_mass,
            self.inv_inertia,
            self.moved.x,
            self.moved.y,
            self.turned,
        ];
        L::store_rows(values, &mut out);
        for (row, &slot) in out.iter().zip(index) {
            rows[slot as usize] = *row;
        }
    }

    /// Takes `impulse` (N·s) at `arm`, times `sign`.
    #[inline(always)]
    fn push(&mut self, impulse: Vec2<L>, arm: Vec2<L>) {
        self.velocity = self.velocity + impulse * self.inv_mass;
        self.spin = self.spin + arm.cross(impulse) * self.inv_inertia;
    }

    /// Like [`Side::push`], for displacement.
    #[inline(always)]
    fn shift(&mut self, push: Vec2<L>, arm: Vec2<L>) {
        self.moved = self.moved + push * self.inv_mass;
        self.turned = self.turned + arm.cross(push) * self.inv_inertia;
    }

    /// Effective inverse mass along `n` at `arm`.
    #[inline(always)]
    fn yield_along(&self, n: Vec2<L>, arm: Vec2<L>) -> L {
        let lever = arm.cross(n);
        self.inv_mass + self.inv_inertia * (lever * lever)
    }
}

/// The contacts of a batch: rows of their manifolds, bodies gathered once, points one after the other.
#[inline(always)]
fn solve_batch<L: Lanes, const FRICTION: bool, const BOUNCE: bool, const POINTS: usize>(
    manifolds: &Manifolds<L::Elem>,
    batch: &[u32],
    rows: &mut [[L::Elem; ROW]],
) {
    // Padding lanes repeat contact 0's geometry between the world and itself: no mass, never scattered.
    let (mut at, mut ia, mut ib) = ([0; 16], [0; 16], [0; 16]);
    for (lane, &contact) in batch.iter().enumerate() {
        let key = &manifolds.keys[contact as usize];
        (at[lane], ia[lane], ib[lane]) = (contact, key.a, key.b);
    }
    let first = L::gather_rows(manifolds.geometry.rows(), &at);
    let second = L::gather_rows(manifolds.surface.rows(), &at);
    let normal = Vec2::new(first[geometry::NORMAL], first[geometry::NORMAL + 1]);
    let tangent = -normal.right();
    let (mut a, mut b) = (Side::gather(rows, &ia), Side::gather(rows, &ib));

    let vec = |row: &[L; ROW], at: usize, k: usize| Vec2::new(row[at + 2 * k], row[at + 2 * k + 1]);
    let arms_a: [Vec2<L>; POINTS] = std::array::from_fn(|k| vec(&first, geometry::ARM_A, k));
    let arms_b: [Vec2<L>; POINTS] = std::array::from_fn(|k| vec(&second, surface::ARM_B, k));
    let response =
        Response::new(&a, &b, arms_a.map(|arm| arm.cross(normal)), arms_b.map(|arm| arm.cross(normal)));

    let approaches: [L; POINTS] = std::array::from_fn(|k| {
        let approach = relative_velocity(&a, &b, arms_a[k], arms_b[k]).dot(normal);
        if BOUNCE {
            let bounces = approach.lt(L::lit(-BOUNCE_THRESHOLD_M_PER_S));
            approach * (L::one() + L::select(bounces, second[surface::RESTITUTION], L::zero()))
        } else {
            approach
        }
    });
    let impulses = non_negative(&response, approaches);
    for k in 0..POINTS {
        a.push(-(normal * impulses[k]), arms_a[k]);
        b.push(normal * impulses[k], arms_b[k]);
    }

    if FRICTION {
        for k in 0..POINTS {
            let bound = second[surface::FRICTION] * impulses[k];
            let yielding = a.yield_along(tangent, arms_a[k]) + b.yield_along(tangent, arms_b[k]);
            let sliding = relative_velocity(&a, &b, arms_a[k], arms_b[k]).dot(tangent);
            let held = (-bound).max(bound.min(-(sliding * inverse(yielding))));
            a.push(-(tangent * held), arms_a[k]);
            b.push(tangent * held, arms_b[k]);
        }
    }

    // What each point still has to rise, as a velocity of approach would ask of an impulse.
    let sinking: [L; POINTS] = std::array::from_fn(|k| {
        let moved = (b.moved + arms_b[k].turned_by(b.turned)) - (a.moved + arms_a[k].turned_by(a.turned));
        let excess = -(first[geometry::SEPARATION + k] + moved.dot(normal)) - L::lit(SLOP_M);
        -(L::zero().max(excess) * L::lit(CORRECTION_SHARE))
    });
    let pushes = non_negative(&response, sinking);
    for k in 0..POINTS {
        a.shift(-(normal * pushes[k]), arms_a[k]);
        b.shift(normal * pushes[k], arms_b[k]);
    }
    a.scatter(rows, &ia[..batch.len()]);
    b.scatter(rows, &ib[..batch.len()]);
}

#[inline(always)]
fn relative_velocity<L: Lanes>(a: &Side<L>, b: &Side<L>, arm_a: Vec2<L>, arm_b: Vec2<L>) -> Vec2<L> {
    (b.velocity + arm_b.turned_by(b.spin)) - (a.velocity + arm_a.turned_by(a.spin))
}

/// 1/k, or 0 where nothing yields (padding).
#[inline(always)]
fn inverse<L: Lanes>(k: L) -> L {
    let none = k.le(L::zero());
    L::select(none, L::zero(), L::one() / L::select(none, L::one(), k))
}

/// How the normal velocities of a contact's points answer to its normal impulses: the matrix
/// K = J·M⁻¹·Jᵀ, its diagonal's inverse, and for two points whether K can be inverted.
struct Response<L: Lanes, const POINTS: usize> {
    diagonal: [L; POINTS],
    inverse: [L; POINTS],
    cross: L,
    inverse_determinant: L,
    regular: L::Mask,
}

impl<L: Lanes, const POINTS: usize> Response<L, POINTS> {
    /// From the levers r×n of the points on both sides.
    #[inline(always)]
    fn new(a: &Side<L>, b: &Side<L>, lever_a: [L; POINTS], lever_b: [L; POINTS]) -> Self {
        let mass = a.inv_mass + b.inv_mass;
        let entry = |i: usize, j: usize| {
            mass + (a.inv_inertia * (lever_a[i] * lever_a[j]) + b.inv_inertia * (lever_b[i] * lever_b[j]))
        };
        let diagonal: [L; POINTS] = std::array::from_fn(|k| entry(k, k));
        let last = POINTS - 1;
        let cross = entry(0, last);
        let determinant = diagonal[0] * diagonal[last] - cross * cross;
        // Points so close together that rounding would decide how they share their load go one by one.
        let regular = (diagonal[0] * diagonal[last]).lt(determinant * L::lit(1e3));
        let inverse_determinant = inverse(L::select(regular, determinant, L::zero()));
        Self { diagonal, inverse: diagonal.map(inverse), cross, inverse_determinant, regular }
    }
}

/// x ≥ 0 with K·x + b ≥ 0 and x·(K·x + b) = 0: impulses that stop the points from approaching at −b.
///
/// One point: max(0, −b/k). Two: both push, else the first alone, else the second alone, else neither;
/// the cases exclude each other for a regular K.
#[inline(always)]
fn non_negative<L: Lanes, const POINTS: usize>(k: &Response<L, POINTS>, b: [L; POINTS]) -> [L; POINTS] {
    let zero = L::zero();
    let alone: [L; POINTS] = std::array::from_fn(|i| zero.max(-(b[i] * k.inverse[i])));
    if POINTS == 1 {
        return alone;
    }
    let last = POINTS - 1;
    let both = [
        (k.cross * b[last] - k.diagonal[last] * b[0]) * k.inverse_determinant,
        (k.cross * b[0] - k.diagonal[0] * b[last]) * k.inverse_determinant,
    ];
    let use_both = k.regular & zero.le(both[0]) & zero.le(both[1]);
    let use_first = zero.le(k.cross * alone[0] + b[last]);
    std::array::from_fn(|i| {
        let single = if i == 0 {
            L::select(use_first, alone[0], zero)
        } else {
            L::select(use_first, zero, alone[last])
        };
        L::select(use_both, both[i], single)
    })
}
