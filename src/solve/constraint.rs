//! One batch of contacts in lanes, as solvers stream them: what a pass needs and nothing else.
//!
//! A contact acts along its normal at each point and along its tangent at the middle of its points. With
//! t = n turned a quarter counter-clockwise, an arm r enters only through its levers r×n and r×t.
//! Both points of a face lie on one line along t, so one friction impulse bounded by μ(λ₀ + λ₁) does what two
//! would: a third less work, tried against two and no pile or slope told them apart.
//!
//! Bytes per contact in f32: two points 84 (20 values and the restitution), one point 64 (16 values), and 8 for the slots.
//! Kept out: masses (they come with the bodies' rows), arms (levers serve), whatever only some solver wants.

mod lane;

use super::batches::Ends;
use crate::each::Each as _;
use crate::lanes::Lanes;
use crate::vec2::Vec2;

pub(super) use lane::{LANE_VALUES, LaneValues, at};

/// Velocity of the bodies of one side of a batch, m/s and rad/s, and their inverse mass.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Side<L> {
    /// Of the centroid.
    pub velocity: Vec2<L>,
    /// Angular.
    pub spin: L,
    /// 1/kg.
    pub inv_mass: L,
}

impl<L: Lanes> Side<L> {
    /// From rows of four: vx, vy, w, 1/m.
    #[inline(always)]
    pub(crate) fn gather(rows: &[[L::Elem; 4]], index: &[u32]) -> Self {
        let [x, y, spin, inv_mass] = L::gather_fours(rows, index);
        Self { velocity: Vec2::new(x, y), spin, inv_mass }
    }

    /// From rows of displacements: x, y (metres), angle, –. To its push a displacement is what a velocity is to its
    /// impulse, so the same kernels serve.
    #[inline(always)]
    pub(super) fn displacement(rows: &[[L::Elem; 4]], index: &[u32], inv_mass: L) -> Self {
        Self { inv_mass, ..Self::gather(rows, index) }
    }

    /// Back into the rows.
    #[inline(always)]
    pub(crate) fn scatter(&self, rows: &mut [[L::Elem; 4]], index: &[u32]) {
        L::scatter_fours([self.velocity.x, self.velocity.y, self.spin, self.inv_mass], rows, index);
    }
}

/// What acts at one point along the normal.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Point<L> {
    /// r×n of the arms from A and B, metres.
    pub levers: [L; 2],
    /// Effective mass along the normal, kg; 0 where the point does not exist.
    pub mass: L,
    /// Present separation, metres.
    pub separation: L,
    /// Accumulated normal impulse over the effective mass, m/s: what it stops.
    pub velocity_impulse: L,
}

impl<L: Lanes> Point<L> {
    /// Accumulated normal impulse, N·s per substep.
    #[inline(always)]
    pub(crate) fn impulse(&self) -> L {
        self.velocity_impulse * self.mass
    }
}

/// `WIDTH` contacts of `POINTS` points each.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Constraint<L, const POINTS: usize> {
    /// Unit normal from A to B.
    pub normal: Vec2<L>,
    /// 1/(kg·m²) of A and B.
    pub inv_inertia: [L; 2],
    /// Along the normal.
    pub points: [Point<L>; POINTS],
    /// r×t of the arms from A and B to the middle of the points, metres.
    pub tangent_levers: [L; 2],
    /// Effective mass along the tangent, kg.
    pub tangent_mass: L,
    /// Accumulated friction impulse, N·s per substep.
    pub tangent_impulse: L,
    /// Coulomb coefficient.
    pub friction: L,
    /// Coefficient of restitution.
    pub restitution: L,
    /// What lengths without a scale of their own are shares of: the lesser bounding radius of what moves, metres.
    pub length: L,
}

/// The rows of `WIDTH` manifolds and bodies, gathered: what a constraint is prepared from.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Parts<L: Lanes> {
    /// See [`crate::contact::geometry`].
    pub geometry: [L; 8],
    /// See [`crate::contact::gap`].
    pub gap: [L; 4],
    /// Of both points and along the tangent, N·s per substep.
    pub impulses: [L; 3],
    /// 1/m, 1/I and length of A and B.
    pub matter: [[L; 3]; 2],
    /// Lanes whose manifold has two points.
    pub two_points: L::Mask,
}

/// 1/k, or 0 where nothing yields (padding).
#[inline(always)]
pub(super) fn inverse<L: Lanes>(k: L) -> L {
    let some = L::zero().lt(k);
    L::select(some, L::one() / L::select(some, k, L::one()), L::zero())
}

impl<L: Lanes, const POINTS: usize> Constraint<L, POINTS> {
    /// From manifolds and masses.
    #[inline(always)]
    pub(crate) fn prepare(parts: &Parts<L>) -> Self {
        let [nx, ny, ax0, ay0, ax1, ay1, dx, dy] = parts.geometry;
        let normal = Vec2::new(nx, ny);
        let tangent = -normal.right();
        let to_b = Vec2::new(dx, dy);
        let arms = [Vec2::new(ax0, ay0), Vec2::new(ax1, ay1)];
        let zero = L::zero();
        let [[ma, ia, length_a], [mb, ib, length_b]] = parts.matter;
        let levers = |arm: Vec2<L>, axis: Vec2<L>| [arm.cross(axis), (arm - to_b).cross(axis)];
        // Nothing yields in padding lanes, whose manifold is all zeros.
        let exists = zero.lt(nx.abs() + ny.abs());
        let response =
            |[la, lb]: [L; 2]| L::select(exists, (ma + mb) + (ia * (la * la) + ib * (lb * lb)), zero);
        let points = crate::each::indexed(|k| {
            let levers = levers(arms[k], normal);
            let response = response(levers);
            let exists = |value: L| if k == 0 { value } else { L::select(parts.two_points, value, zero) };
            Point {
                levers: levers.each(exists),
                mass: exists(inverse(response)),
                separation: exists(parts.gap[k]),
                velocity_impulse: parts.impulses[k] * response,
            }
        });
        let middle = if POINTS == 1 {
            arms[0]
        } else {
            let half = L::select(parts.two_points, L::lit(0.5), zero);
            arms[0] + (arms[1] - arms[0]) * half
        };
        // A gap's point lies midway: once closed, each body is rubbed at its own surface. Where one of two points has
        // closed there is no gap: levers of the mean took 1e-3 of a pile's momentum.
        let [first, second] = [parts.gap[0], parts.gap[1]];
        let gap = if POINTS == 1 { first } else { L::select(parts.two_points, first.min(second), first) };
        let half_gap = zero.max(gap) * L::lit(0.5);
        let [to_a, to_b] = levers(middle, tangent);
        let tangent_levers = [to_a - half_gap, to_b + half_gap];
        Self {
            normal,
            inv_inertia: [ia, ib],
            points,
            tangent_levers,
            tangent_mass: inverse(response(tangent_levers)),
            tangent_impulse: parts.impulses[2],
            friction: parts.gap[2],
            restitution: parts.gap[3],
            length: length_a.min(length_b),
        }
    }

    /// Of nothing: what padding lanes hold.
    pub(super) fn nothing() -> Self {
        let zero = L::zero();
        let point = Point { levers: [zero; 2], mass: zero, separation: zero, velocity_impulse: zero };
        Self {
            normal: Vec2::zero(),
            inv_inertia: [zero; 2],
            points: [point; POINTS],
            tangent_levers: [zero; 2],
            tangent_mass: zero,
            tangent_impulse: zero,
            friction: zero,
            restitution: zero,
            length: zero,
        }
    }

    /// The tangent: the normal turned a quarter counter-clockwise.
    #[inline(always)]
    pub(crate) fn tangent(&self) -> Vec2<L> {
        -self.normal.right()
    }

    /// What the separations of the points change by when A and B move and turn so little.
    #[inline(always)]
    pub(crate) fn gap_change(&self, a: &[L; 4], b: &[L; 4]) -> [L; POINTS] {
        let along = Vec2::new(b[0] - a[0], b[1] - a[1]).dot(self.normal);
        crate::each::indexed(|k| {
            let [la, lb] = self.points[k].levers;
            along + (b[2] * lb - a[2] * la)
        })
    }

    /// What the separations change by with the displacements of both sides, rows per slot.
    #[inline(always)]
    pub(super) fn change_by(&self, moved: &[[L::Elem; 4]], ends: &Ends<'_>) -> [L; POINTS] {
        self.gap_change(&L::gather_fours(moved, ends.a), &L::gather_fours(moved, ends.b))
    }

    /// Brings the separations up to date with the displacement of both sides, unless they are.
    #[inline(always)]
    pub(crate) fn follow(&mut self, moved: &[[L::Elem; 4]], ends: &Ends<'_>) {
        if ends.fresh {
            return;
        }
        let change = self.gap_change(&L::gather_fours(moved, ends.a), &L::gather_fours(moved, ends.b));
        for k in 0..POINTS {
            self.points[k].separation = self.points[k].separation + change[k];
        }
    }

    /// Gives all accumulated impulses to both sides.
    #[inline(always)]
    pub(crate) fn apply_accumulated(&self, a: &mut Side<L>, b: &mut Side<L>) {
        let mut normals = Normals::begin(self, a, b);
        for k in 0..POINTS {
            normals.push(self, k, self.points[k].impulse());
        }
        normals.end(self, a, b);
        self.apply_friction(a, b, self.tangent_impulse);
    }

    /// Friction: what stops sliding, within the cone of the normal impulses.
    #[inline(always)]
    pub(crate) fn solve_friction(&mut self, a: &mut Side<L>, b: &mut Side<L>) {
        let mut load = self.points[0].impulse();
        for point in &self.points[1..] {
            load = load + point.impulse();
        }
        self.tangent_impulse = self.apply_friction_within(a, b, self.tangent_impulse, load);
    }

    /// Changes a friction impulse to the one that stops sliding, within the cone of a normal one; returns the new one.
    #[inline(always)]
    pub(super) fn apply_friction_within(
        &self,
        a: &mut Side<L>,
        b: &mut Side<L>,
        velocity_impulse: L,
        load: L,
    ) -> L {
        let tangent = self.tangent();
        let [la, lb] = self.tangent_levers;
        let sliding = (b.velocity - a.velocity).dot(tangent) + (b.spin * lb - a.spin * la);
        let bound = self.friction * load;
        let next = (-bound).max(bound.min(velocity_impulse - sliding * self.tangent_mass));
        self.apply_friction(a, b, next - velocity_impulse);
        next
    }

    /// A tangential impulse at the middle of the points.
    #[inline(always)]
    pub(super) fn apply_friction(&self, a: &mut Side<L>, b: &mut Side<L>, impulse: L) {
        let tangent = self.tangent();
        let [la, lb] = self.tangent_levers;
        a.velocity = a.velocity - tangent * (impulse * a.inv_mass);
        b.velocity = b.velocity + tangent * (impulse * b.inv_mass);
        a.spin = a.spin - self.inv_inertia[0] * (impulse * la);
        b.spin = b.spin + self.inv_inertia[1] * (impulse * lb);
    }
}

/// Normal impulses in progress: linear velocities are touched once for all points.
#[derive(Clone, Copy, Debug)]
pub(super) struct Normals<L> {
    /// (vB − vA)·n.
    approach: L,
    /// Sum of impulses given.
    given: L,
    inv_mass: L,
    spins: [L; 2],
}

impl<L: Lanes> Normals<L> {
    #[inline(always)]
    pub(super) fn begin<const POINTS: usize>(c: &Constraint<L, POINTS>, a: &Side<L>, b: &Side<L>) -> Self {
        Self {
            approach: (b.velocity - a.velocity).dot(c.normal),
            given: L::zero(),
            inv_mass: a.inv_mass + b.inv_mass,
            spins: [a.spin, b.spin],
        }
    }

    /// Relative normal velocity at a point, m/s, negative while it closes.
    #[inline(always)]
    pub(super) fn velocity(&self, point: &Point<L>) -> L {
        self.approach
            + self.inv_mass * self.given
            + (self.spins[1] * point.levers[1] - self.spins[0] * point.levers[0])
    }

    /// 1/mA + 1/mB.
    #[inline(always)]
    pub(super) fn inv_mass(&self) -> L {
        self.inv_mass
    }

    /// An impulse along the normal at point `k`.
    #[inline(always)]
    pub(super) fn push<const POINTS: usize>(&mut self, c: &Constraint<L, POINTS>, k: usize, impulse: L) {
        let [la, lb] = c.points[k].levers;
        self.given = self.given + impulse;
        self.spins[0] = self.spins[0] - c.inv_inertia[0] * (impulse * la);
        self.spins[1] = self.spins[1] + c.inv_inertia[1] * (impulse * lb);
    }

    #[inline(always)]
    pub(super) fn end<const POINTS: usize>(
        &self,
        c: &Constraint<L, POINTS>,
        a: &mut Side<L>,
        b: &mut Side<L>,
    ) {
        a.velocity = a.velocity - c.normal * (self.given * a.inv_mass);
        b.velocity = b.velocity + c.normal * (self.given * b.inv_mass);
        (a.spin, b.spin) = (self.spins[0], self.spins[1]);
    }
}
