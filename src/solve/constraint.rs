//! What solvers share: a batch of contacts in lanes, and the small linear algebra of one contact.

use crate::contact::{Manifolds, geometry, surface};
use crate::lanes::{Lanes, ROW, Real};
use crate::vec2::Vec2;

use super::color::Batch;

/// Share of the depth beyond the slop that one pass takes away (the thesis's percent).
pub(super) const CORRECTION_SHARE: f64 = 0.7;
/// Depth left alone, metres (the thesis's 0.01 px).
pub(super) const SLOP_M: f64 = 4e-4;
/// Approaches slower than this do not bounce, m/s: gravity alone makes 0.16 m/s in a step of 1/60 s.
pub(super) const BOUNCE_THRESHOLD_M_PER_S: f64 = 0.5;

/// Velocity and displacement of the bodies of one side of a batch.
#[derive(Clone, Copy)]
pub(super) struct Side<L> {
    pub(super) velocity: Vec2<L>,
    pub(super) spin: L,
    pub(super) inv_mass: L,
    pub(super) inv_inertia: L,
    pub(super) moved: Vec2<L>,
    pub(super) turned: L,
}

impl<L: Lanes> Side<L> {
    #[inline(always)]
    pub(super) fn gather(rows: &[[L::Elem; ROW]], index: &[u32]) -> Self {
        let [vx, vy, spin, inv_mass, inv_inertia, mx, my, turned] = L::gather_rows(rows, index);
        Self { velocity: Vec2::new(vx, vy), spin, inv_mass, inv_inertia, moved: Vec2::new(mx, my), turned }
    }

    #[inline(always)]
    pub(super) fn scatter(&self, rows: &mut [[L::Elem; ROW]], index: &[u32]) {
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
    pub(super) fn push(&mut self, impulse: Vec2<L>, arm: Vec2<L>) {
        self.velocity = self.velocity + impulse * self.inv_mass;
        self.spin = self.spin + arm.cross(impulse) * self.inv_inertia;
    }

    /// Like [`Side::push`], for displacement.
    #[inline(always)]
    pub(super) fn shift(&mut self, push: Vec2<L>, arm: Vec2<L>) {
        self.moved = self.moved + push * self.inv_mass;
        self.turned = self.turned + arm.cross(push) * self.inv_inertia;
    }

    /// Effective inverse mass along `n` at `arm`.
    #[inline(always)]
    pub(super) fn yield_along(&self, n: Vec2<L>, arm: Vec2<L>) -> L {
        let lever = arm.cross(n);
        self.inv_mass + self.inv_inertia * (lever * lever)
    }
}

/// `WIDTH` contacts of `POINTS` points each, as the narrow phase wrote them.
pub(super) struct Contacts<L, const POINTS: usize> {
    pub(super) normal: Vec2<L>,
    pub(super) tangent: Vec2<L>,
    pub(super) arms_a: [Vec2<L>; POINTS],
    pub(super) arms_b: [Vec2<L>; POINTS],
    pub(super) separations: [L; POINTS],
    pub(super) friction: L,
    pub(super) restitution: L,
}

impl<L: Lanes, const POINTS: usize> Contacts<L, POINTS> {
    #[inline(always)]
    pub(super) fn gather(manifolds: &Manifolds<L::Elem>, batch: &Batch) -> Self {
        let first = L::gather_rows(manifolds.geometry.rows(), &batch.contact);
        let second = L::gather_rows(manifolds.surface.rows(), &batch.contact);
        let vec = |row: &[L; ROW], at: usize, k: usize| Vec2::new(row[at + 2 * k], row[at + 2 * k + 1]);
        let normal = Vec2::new(first[geometry::NORMAL], first[geometry::NORMAL + 1]);
        Self {
            normal,
            tangent: -normal.right(),
            arms_a: std::array::from_fn(|k| vec(&first, geometry::ARM_A, k)),
            arms_b: std::array::from_fn(|k| vec(&second, surface::ARM_B, k)),
            separations: std::array::from_fn(|k| first[geometry::SEPARATION + k]),
            friction: second[surface::FRICTION],
            restitution: second[surface::RESTITUTION],
        }
    }

    /// How normal velocities answer to normal impulses.
    #[inline(always)]
    pub(super) fn response(&self, a: &Side<L>, b: &Side<L>) -> Response<L, POINTS> {
        let levers = |arms: [Vec2<L>; POINTS]| arms.map(|arm| arm.cross(self.normal));
        Response::new(a, b, levers(self.arms_a), levers(self.arms_b))
    }

    /// Velocity of B relative to A at point `k`.
    #[inline(always)]
    pub(super) fn velocity(&self, a: &Side<L>, b: &Side<L>, k: usize) -> Vec2<L> {
        (b.velocity + self.arms_b[k].turned_by(b.spin)) - (a.velocity + self.arms_a[k].turned_by(a.spin))
    }

    /// Gives `impulse` to B at point `k` and takes it from A.
    #[inline(always)]
    pub(super) fn push(&self, a: &mut Side<L>, b: &mut Side<L>, k: usize, impulse: Vec2<L>) {
        a.push(-impulse, self.arms_a[k]);
        b.push(impulse, self.arms_b[k]);
    }

    /// The inverse of the effective mass along the tangent at point `k`.
    #[inline(always)]
    pub(super) fn tangent_mass(&self, a: &Side<L>, b: &Side<L>, k: usize) -> L {
        inverse(a.yield_along(self.tangent, self.arms_a[k]) + b.yield_along(self.tangent, self.arms_b[k]))
    }

    /// Present separation of point `k`: as found, plus what the bodies moved since the step began.
    #[inline(always)]
    pub(super) fn separation(&self, a: &Side<L>, b: &Side<L>, k: usize) -> L {
        let moved =
            (b.moved + self.arms_b[k].turned_by(b.turned)) - (a.moved + self.arms_a[k].turned_by(a.turned));
        self.separations[k] + moved.dot(self.normal)
    }

    /// Moves the bodies apart by a share of what they overlap beyond the slop.
    #[inline(always)]
    pub(super) fn correct(&self, response: &Response<L, POINTS>, a: &mut Side<L>, b: &mut Side<L>) {
        // What each point still has to rise, as a velocity of approach would ask of an impulse.
        let sinking: [L; POINTS] = std::array::from_fn(|k| {
            let excess = -self.separation(a, b, k) - L::lit(SLOP_M);
            -(L::zero().max(excess) * L::lit(CORRECTION_SHARE))
        });
        let pushes = non_negative(response, sinking);
        for k in 0..POINTS {
            a.shift(-(self.normal * pushes[k]), self.arms_a[k]);
            b.shift(self.normal * pushes[k], self.arms_b[k]);
        }
    }
}

/// 1/k, or 0 where nothing yields (padding).
#[inline(always)]
pub(super) fn inverse<L: Lanes>(k: L) -> L {
    let none = k.le(L::zero());
    L::select(none, L::zero(), L::one() / L::select(none, L::one(), k))
}

/// How the normal velocities of a contact's points answer to its normal impulses: the matrix
/// K = J·M⁻¹·Jᵀ, its diagonal's inverse, and for two points whether K can be inverted.
pub(super) struct Response<L: Lanes, const POINTS: usize> {
    diagonal: [L; POINTS],
    inverse: [L; POINTS],
    cross: L,
    inverse_determinant: L,
    regular: L::Mask,
}

impl<L: Lanes, const POINTS: usize> Response<L, POINTS> {
    /// From the levers r×n of the points on both sides.
    #[inline(always)]
    pub(super) fn new(a: &Side<L>, b: &Side<L>, lever_a: [L; POINTS], lever_b: [L; POINTS]) -> Self {
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

    /// K·x.
    #[inline(always)]
    pub(super) fn times(&self, x: [L; POINTS]) -> [L; POINTS] {
        if POINTS == 1 {
            return std::array::from_fn(|k| self.diagonal[k] * x[k]);
        }
        std::array::from_fn(|k| self.diagonal[k] * x[k] + self.cross * x[POINTS - 1 - k])
    }
}

/// x ≥ 0 with K·x + b ≥ 0 and x·(K·x + b) = 0: impulses that stop the points from approaching at −b.
///
/// One point: max(0, −b/k). Two: both push, else the first alone, else the second alone, else neither;
/// the cases exclude each other for a regular K.
#[inline(always)]
pub(super) fn non_negative<L: Lanes, const POINTS: usize>(
    k: &Response<L, POINTS>,
    b: [L; POINTS],
) -> [L; POINTS] {
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
