//! A point of A on a point of B, and a row for the angle between them: hinges and welds.
//!
//! The point is two equations, the angle a third, bounded one. All three are solved together: with K the point's 2×2
//! response, c what a unit of angular impulse changes the point's velocity by, and k₀ = 1/I_A + 1/I_B, the point is
//! eliminated first,
//!
//! ```text
//! K = m·1 + i_A·JrₐJrₐᵀ + i_B·Jr_BJr_Bᵀ        m = 1/m_A + 1/m_B, i = 1/I, J a quarter turn
//! det K = m² + m·(i_A·rₐ² + i_B·r_B²) + i_A·i_B·(rₐ×r_B)²
//! k = k₀ − cᵀK⁻¹c = m·(m·(i_A + i_B) + i_A·i_B·|rₐ − r_B|²) / det K
//! ```
//!
//! and what is left is one row of inverse mass k for the angle, on which bounds may be put: exact in one visit, as a
//! 3×3 solution is, also where only part of it is held. In the push the point is soft: K becomes K/s, s < 1 its share
//! (`mass_scale`), and what is eliminated with it k₀ − s·cᵀK⁻¹c; with the rigid point's k in its place two welds side by
//! side grew by 60 a substep, as a point that leaked its force asked the row for a thousand times what it had leaked.
//!
//! Both formulas on the right are sums of positive numbers: nothing cancels however long the arms. (det by its entries
//! lost all digits of f32 at arms of 1000 radii.)

use super::row::{Numbers, Row};
use super::{Linkage, Pose, Stiffness, Swing, anchors, lanes, number, turn};
use crate::each::Each as _;
use crate::joint::{Held, Joint};
use crate::lanes::{Lanes, Real};
use crate::solve::constraint::{Side, inverse};
use crate::vec2::{Rot, Vec2};

/// `WIDTH` hinges or welds: 33 values.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pin<L> {
    /// Anchors in the frames of A and B, metres.
    anchors: [Vec2<L>; 2],
    inv_inertia: [L; 2],
    /// B's attitude seen from A where the angle is 0.
    reference: Rot<L>,
    /// From the centroids to the middle between the anchors, world axes, metres: on one line of action the
    /// impulses on A and B keep angular momentum, however far a load stretches the joint.
    arms: [Vec2<L>; 2],
    /// From A's anchor to B's, metres: what is to vanish.
    gap: Vec2<L>,
    /// rad, whole turns counted.
    angle: L,
    row: Row<L>,
    /// Impulse on B at the anchor, N·s per substep, in units of v.
    impulse: Vec2<L>,
    late: Swing<L>,
}

/// A pin's response: K⁻¹, c and k of the module's head.
struct Response<L> {
    inverse: [L; 3],
    coupling: Vec2<L>,
    angular: L,
}

impl<L: Lanes> Response<L> {
    #[inline(always)]
    fn new(pin: &Pin<L>, inv_mass: L) -> Self {
        let ([ia, ib], [ra, rb], m) = (pin.inv_inertia, pin.arms, inv_mass);
        let [k11, minus_k12, k22] = Self::matrix(pin, inv_mass);
        let k12 = -minus_k12;
        let (both, cross) = (ia * ib, ra.cross(rb));
        let squares = ia * ra.length_squared() + ib * rb.length_squared();
        let determinant = m * m + (m * squares + both * (cross * cross));
        let per = inverse(determinant);
        let coupling = Vec2::new(-(ia * ra.y + ib * rb.y), ia * ra.x + ib * rb.x);
        let angular = (m * per) * (m * (ia + ib) + both * (ra - rb).length_squared());
        Self { inverse: [k22 * per, k12 * per, k11 * per], coupling, angular }
    }

    /// K: its diagonal's first, the one beside it, its diagonal's second, 1/kg.
    #[inline(always)]
    fn matrix(pin: &Pin<L>, inv_mass: L) -> [L; 3] {
        let ([ia, ib], [ra, rb], m) = (pin.inv_inertia, pin.arms, inv_mass);
        let k11 = m + (ia * (ra.y * ra.y) + ib * (rb.y * rb.y));
        let k22 = m + (ia * (ra.x * ra.x) + ib * (rb.x * rb.x));
        let k12 = ia * (ra.x * ra.y) + ib * (rb.x * rb.y);
        [k11, -k12, k22]
    }

    /// K⁻¹·v.
    #[inline(always)]
    fn solve(&self, v: Vec2<L>) -> Vec2<L> {
        let [a, b, c] = self.inverse;
        Vec2::new(a * v.x + b * v.y, b * v.x + c * v.y)
    }
}

impl<L: Lanes> Pin<L> {
    #[inline(always)]
    fn apply(&self, a: &mut Side<L>, b: &mut Side<L>, impulse: Vec2<L>, angular: L) {
        a.velocity = a.velocity - impulse * a.inv_mass;
        b.velocity = b.velocity + impulse * b.inv_mass;
        a.spin = a.spin - self.inv_inertia[0] * (self.arms[0].cross(impulse) + angular);
        b.spin = b.spin + self.inv_inertia[1] * (self.arms[1].cross(impulse) + angular);
    }

    /// Velocity of B's anchor seen from A's.
    #[inline(always)]
    fn slip(&self, a: &Side<L>, b: &Side<L>) -> Vec2<L> {
        (b.velocity - a.velocity) + (self.arms[1].turned_by(b.spin) - self.arms[0].turned_by(a.spin))
    }
}

impl<L: Lanes> Pin<L> {
    /// One lane's, in `f64`; without the row of its angle.
    pub(super) fn lane(&self, lane: usize) -> Pin<f64> {
        let number = |value: L| value.to_array()[lane].to_f64();
        let vector = |v: Vec2<L>| Vec2::new(number(v.x), number(v.y));
        Pin {
            anchors: self.anchors.each(vector),
            inv_inertia: self.inv_inertia.each(number),
            reference: Rot { c: number(self.reference.c), s: number(self.reference.s) },
            arms: self.arms.each(vector),
            gap: vector(self.gap),
            angle: number(self.angle),
            row: Row::new(&[], &[]),
            impulse: vector(self.impulse),
            late: Swing::none(),
        }
    }

    /// 1/(kg·m²) of A and B, in one lane.
    pub(super) fn set_inv_inertia(&mut self, lane: usize, values: [f64; 2]) {
        super::set_lane(&mut self.inv_inertia, lane, values);
    }

    /// Adds to one lane's impulse, N·s, in units of v.
    pub(super) fn add_impulse(&mut self, lane: usize, impulse: Vec2<f64>) {
        for (lanes, change) in [(&mut self.impulse.x, impulse.x), (&mut self.impulse.y, impulse.y)] {
            let mut values = lanes.to_array();
            values[lane] = L::Elem::from_f64(values[lane].to_f64() + change);
            *lanes = L::load(&values);
        }
    }

    /// What the point's velocity is to be rid of: with bias where a push says how.
    #[inline(always)]
    pub(super) fn wanted(&self, a: &Side<L>, b: &Side<L>, how: Option<&Stiffness<L>>) -> Vec2<L> {
        let slip = self.slip(a, b);
        how.map_or(slip, |how| {
            slip + (how.bend(self.arms[1], b.spin) - how.bend(self.arms[0], a.spin))
                + self.gap * how.bias_rate
        })
    }

    /// On B, N·s per substep, in units of v.
    pub(super) fn impulse(&self) -> Vec2<L> {
        self.impulse
    }

    /// The row of its angle.
    pub(super) fn row(&self) -> &Row<L> {
        &self.row
    }

    /// The row of its angle.
    pub(super) fn row_mut(&mut self) -> &mut Row<L> {
        &mut self.row
    }

    /// B's attitude seen from A, rad.
    pub(super) fn angle(&self) -> L {
        self.angle
    }

    /// How far from the centroid of A (0) or B (1) a lane holds, metres.
    pub(super) fn reach(&self, end: usize, lane: usize) -> f64 {
        let [x, y] = [self.anchors[end].x, self.anchors[end].y].each(|along| along.to_array()[lane].to_f64());
        x.hypot(y)
    }

    /// From the centroid of A (0) or B (1), metres.
    pub(super) fn arm(&self, end: usize) -> Vec2<L> {
        self.arms[end]
    }
}

impl<L: Lanes> Linkage<L> for Pin<L> {
    fn new(
        joints: &[Option<&Joint>],
        numbers: &[Numbers],
        held: &[Held<L::Elem>],
        inv_inertia: [L; 2],
    ) -> Self {
        Self {
            anchors: anchors(joints),
            inv_inertia,
            reference: Rot { c: number(joints, |j| j.reference[0]), s: number(joints, |j| j.reference[1]) },
            arms: [Vec2::zero(); 2],
            gap: Vec2::zero(),
            angle: lanes(held, |h| h.angle),
            row: Row::new(numbers, held),
            impulse: Vec2::new(lanes(held, |h| h.point[0]), lanes(held, |h| h.point[1])),
            late: Swing::none(),
        }
    }

    fn retune(&mut self, numbers: &[Numbers]) {
        self.row.retune(numbers);
    }

    fn let_go(&mut self) {
        self.row.let_go();
    }

    /// Arms, gap and angle from the poses. The angle is what it was, corrected by the sine of what it is off by: no
    /// arc tangent needed, and whole turns stay counted. (Written over by hand it comes back, over several steps
    /// where it was off by more than a radian.)
    #[inline(always)]
    fn place(&mut self, [a, b]: [Pose<L>; 2]) {
        let ends = [a.rot.apply(self.anchors[0]), b.rot.apply(self.anchors[1])];
        self.gap = (b.at - a.at) + (ends[1] - ends[0]);
        let half = self.gap * L::lit(0.5);
        self.arms = [ends[0] + half, ends[1] - half];
        let seen = self.reference.relative(a.rot.relative(b.rot));
        let off = Rot::from_angle(self.angle).relative(seen).s;
        self.angle = self.angle + (off + off * (off * off) * L::lit(1.0 / 6.0));
        self.late = Swing::none();
    }

    #[inline(always)]
    fn follow(&mut self, a: &[L; 4], b: &[L; 4]) -> Swing<L> {
        let half = self.gap * L::lit(0.5);
        let turned = [turn(self.arms[0] - half, a[2]), turn(self.arms[1] + half, b[2])];
        let opened = Vec2::new(b[0] - a[0], b[1] - a[1]) + (turned[1] - turned[0]);
        let half_opened = opened * L::lit(0.5);
        let turned = [turned[0] + half_opened, turned[1] - half_opened];
        self.gap = self.gap + opened;
        self.arms = [self.arms[0] + turned[0], self.arms[1] + turned[1]];
        self.angle = self.angle + (b[2] - a[2]);
        let torque = [-turned[0].cross(self.impulse), turned[1].cross(self.impulse)];
        Swing { force: Vec2::zero(), torque }
    }

    #[inline(always)]
    fn late(&mut self) -> &mut Swing<L> {
        &mut self.late
    }
    #[inline(always)]
    fn inv_inertia(&self) -> [L; 2] {
        self.inv_inertia
    }

    #[inline(always)]
    fn warm_start(&mut self, scale: L, share: L, a: &mut Side<L>, b: &mut Side<L>) {
        self.impulse = self.impulse * scale;
        self.row.scale(scale);
        let (impulse, angular) = (self.impulse * share, self.row.impulse() * share);
        self.apply(a, b, impulse, angular);
    }

    #[inline(always)]
    fn push(&mut self, how: &Stiffness<L>, a: &mut Side<L>, b: &mut Side<L>) {
        let response = Response::new(self, a.inv_mass + b.inv_mass);
        let stop = response.solve(self.wanted(a, b, Some(how)));
        let held = self.impulse * how.share;
        // What the point alone would go to; the angle's row sees what that leaves, so that a soft point at rest
        // does not bend a weld.
        let alone = (held - stop) * how.mass_scale;
        let turning = (b.spin - a.spin) + response.coupling.dot(alone - held);
        // Against what the row does, the soft point holds by its share: see the module's head.
        let free = self.inv_inertia[0] + self.inv_inertia[1];
        let angular_k = free + how.mass_scale * (response.angular - free);
        let angular = self.row.push(how, self.angle, turning, L::zero(), [angular_k, response.angular]);
        let next = alone - response.solve(response.coupling) * (how.mass_scale * angular);
        self.impulse = next * how.per_share;
        self.apply(a, b, next - held, angular);
    }

    #[inline(always)]
    fn relax(&mut self, how: &Stiffness<L>, a: &mut Side<L>, b: &mut Side<L>) {
        let response = Response::new(self, a.inv_mass + b.inv_mass);
        let stop = response.solve(self.slip(a, b));
        let turning = (b.spin - a.spin) - response.coupling.dot(stop);
        let angular = self.row.relax(how, self.angle, turning, response.angular);
        let change = -stop - response.solve(response.coupling) * angular;
        self.impulse = self.impulse + change;
        self.apply(a, b, change, angular);
    }

    fn held(&self) -> [L; 5] {
        [self.impulse.x, self.impulse.y, self.row.drive, self.row.limit, self.angle]
    }
}
