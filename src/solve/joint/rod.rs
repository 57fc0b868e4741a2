//! The distance of two points, as one row along the line between them: rods, ropes and springs.
//!
//! In a substep the points part by δ = h·(velocity of B's point seen from A's) and the bend of the arms. What their
//! distance grows by beyond its linear part n·δ is known without cancellation,
//!
//! ```text
//! |d + δ| − |d| − n·δ = q²/(p + √(p² + q²))       p = |d| + n·δ, q = n×δ
//! ```
//!
//! and goes into the row's velocity: a pendulum's rod is as long after a substep as before, not by (h·u)²/2|d| longer.

use super::row::{Numbers, Row};
use super::{Linkage, Pose, Stiffness, Swing, anchors, turn};
use crate::each::Each as _;
use crate::joint::{Held, Joint};
use crate::lanes::{Lanes, Real};
use crate::solve::constraint::{Side, inverse};
use crate::vec2::Vec2;

/// `WIDTH` distance joints: 29 values.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rod<L> {
    /// Anchors in the frames of A and B, metres.
    anchors: [Vec2<L>; 2],
    inv_inertia: [L; 2],
    /// Anchors from the centroids, world axes, metres.
    arms: [Vec2<L>; 2],
    /// From A's anchor to B's, metres.
    apart: Vec2<L>,
    /// Its direction, and its length: the row's coordinate.
    axis: Vec2<L>,
    length: L,
    row: Row<L>,
    late: Swing<L>,
}

impl<L: Lanes> Rod<L> {
    #[inline(always)]
    fn levers(&self) -> [L; 2] {
        [self.arms[0].cross(self.axis), self.arms[1].cross(self.axis)]
    }

    #[inline(always)]
    fn apply(&mut self, a: &mut Side<L>, b: &mut Side<L>, levers: [L; 2], impulse: L) {
        a.velocity = a.velocity - self.axis * (impulse * a.inv_mass);
        b.velocity = b.velocity + self.axis * (impulse * b.inv_mass);
        a.spin = a.spin - self.inv_inertia[0] * (impulse * levers[0]);
        b.spin = b.spin + self.inv_inertia[1] * (impulse * levers[1]);
    }

    /// Inverse effective mass along the axis.
    #[inline(always)]
    fn response(&self, a: &Side<L>, b: &Side<L>, [la, lb]: [L; 2]) -> L {
        let [ia, ib] = self.inv_inertia;
        (a.inv_mass + b.inv_mass) + (ia * (la * la) + ib * (lb * lb))
    }

    #[inline(always)]
    fn speed(&self, a: &Side<L>, b: &Side<L>, [la, lb]: [L; 2]) -> L {
        (b.velocity - a.velocity).dot(self.axis) + (b.spin * lb - a.spin * la)
    }

    /// What the row's velocity is to be rid of, were it held at `rest`: with bias where a push says how.
    #[inline(always)]
    pub(super) fn wanted(&self, a: &Side<L>, b: &Side<L>, rest: L, how: Option<&Stiffness<L>>) -> L {
        let speed = self.speed(a, b, self.levers());
        how.map_or(speed, |how| (speed + self.bend(a, b, how)) + (self.length - rest) * how.bias_rate)
    }

    /// What a substep adds to the row's velocity by turning.
    #[inline(always)]
    fn bend(&self, a: &Side<L>, b: &Side<L>, how: &Stiffness<L>) -> L {
        let arms = how.bend(self.arms[1], b.spin) - how.bend(self.arms[0], a.spin);
        let spin = self.arms[1].turned_by(b.spin) - self.arms[0].turned_by(a.spin);
        let step = ((b.velocity - a.velocity) + spin + arms) * how.h;
        let (p, q) = (self.length + self.axis.dot(step), self.axis.cross(step));
        let beyond = (q * q) * inverse(p + (p * p + q * q).sqrt());
        arms.dot(self.axis) + beyond * how.per_sec
    }

    /// One lane's, in `f64`; without its row.
    pub(super) fn lane(&self, lane: usize) -> Rod<f64> {
        let number = |value: L| value.to_array()[lane].to_f64();
        let vector = |v: Vec2<L>| Vec2::new(number(v.x), number(v.y));
        Rod {
            anchors: self.anchors.each(vector),
            inv_inertia: self.inv_inertia.each(number),
            arms: self.arms.each(vector),
            apart: vector(self.apart),
            axis: vector(self.axis),
            length: number(self.length),
            row: Row::new(&[], &[]),
            late: Swing::none(),
        }
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

    /// Unit, from A's anchor to B's.
    pub(super) fn axis(&self) -> Vec2<L> {
        self.axis
    }

    /// The row of its length.
    pub(super) fn row(&self) -> &Row<L> {
        &self.row
    }

    /// The row of its length.
    pub(super) fn row_mut(&mut self) -> &mut Row<L> {
        &mut self.row
    }

    /// 1/(kg·m²) of A and B, in one lane.
    pub(super) fn set_inv_inertia(&mut self, lane: usize, values: [f64; 2]) {
        super::set_lane(&mut self.inv_inertia, lane, values);
    }

    #[inline(always)]
    fn set_apart(&mut self, apart: Vec2<L>) {
        self.apart = apart;
        (self.axis, self.length) = apart.normalized();
    }
}

impl<L: Lanes> Linkage<L> for Rod<L> {
    fn new(
        joints: &[Option<&Joint>],
        numbers: &[Numbers],
        held: &[Held<L::Elem>],
        inv_inertia: [L; 2],
    ) -> Self {
        Self {
            anchors: anchors(joints),
            inv_inertia,
            arms: [Vec2::zero(); 2],
            apart: Vec2::zero(),
            axis: Vec2::zero(),
            length: L::zero(),
            row: Row::new(numbers, held),
            late: Swing::none(),
        }
    }

    fn retune(&mut self, numbers: &[Numbers]) {
        self.row.retune(numbers);
    }

    fn let_go(&mut self) {
        self.row.let_go();
    }

    #[inline(always)]
    fn place(&mut self, [a, b]: [Pose<L>; 2]) {
        self.arms = [a.rot.apply(self.anchors[0]), b.rot.apply(self.anchors[1])];
        self.set_apart((b.at - a.at) + (self.arms[1] - self.arms[0]));
        self.late = Swing::none();
    }

    #[inline(always)]
    fn follow(&mut self, a: &[L; 4], b: &[L; 4]) -> Swing<L> {
        let (axis, levers) = (self.axis, self.levers());
        let turned = [turn(self.arms[0], a[2]), turn(self.arms[1], b[2])];
        self.arms = [self.arms[0] + turned[0], self.arms[1] + turned[1]];
        self.set_apart(self.apart + (Vec2::new(b[0] - a[0], b[1] - a[1]) + (turned[1] - turned[0])));
        let (now, impulse) = (self.levers(), self.row.impulse());
        let torque = [-((now[0] - levers[0]) * impulse), (now[1] - levers[1]) * impulse];
        Swing { force: (self.axis - axis) * impulse, torque }
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
        self.row.scale(scale);
        let (levers, impulse) = (self.levers(), self.row.impulse() * share);
        self.apply(a, b, levers, impulse);
    }

    #[inline(always)]
    fn push(&mut self, how: &Stiffness<L>, a: &mut Side<L>, b: &mut Side<L>) {
        let levers = self.levers();
        let bend = self.bend(a, b, how);
        let k = self.response(a, b, levers);
        let impulse = self.row.push(how, self.length, self.speed(a, b, levers), bend, [k; 2]);
        self.apply(a, b, levers, impulse);
    }

    #[inline(always)]
    fn relax(&mut self, how: &Stiffness<L>, a: &mut Side<L>, b: &mut Side<L>) {
        let levers = self.levers();
        let k = self.response(a, b, levers);
        let impulse = self.row.relax(how, self.length, self.speed(a, b, levers), k);
        self.apply(a, b, levers, impulse);
    }

    fn held(&self) -> [L; 5] {
        let zero = L::zero();
        [zero, zero, self.row.drive, self.row.limit, zero]
    }
}
