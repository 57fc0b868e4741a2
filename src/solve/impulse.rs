//! `impulse`: the thesis's resolution, cleaned. One pass per substep; the cheap end of the diagram.
//!
//! Kept from it: e = min, μ = min, no memory of the last step, positional correction by a share of the depth
//! beyond a slop. Mended: separating points are left alone, friction stays in Coulomb's cone, slow approaches
//! do not bounce, both points of a face are corrected, rotation takes part in the correction, and the result
//! does not depend on memory order.
//!
//! For a point with levers l = r×n, k = 1/mA + 1/mB + lA²/IA + lB²/IB and jₙ = max(0, −(1 + e)·vₙ/k);
//! jₜ = clamp(−vₜ/kₜ, ±μ·Σjₙ) along t = n turned a quarter counter-clockwise.
//!
//! The two points of a face are solved together, directly and by cases ([`non_negative`]): one after the
//! other left a resting box turning at 0.02 rad/s and creeping sideways at 5 cm/s; together, neither.

use super::batches::{Ends, Visit};
use super::block::{cross, non_negative, part};
use super::constraint::{Constraint, Normals, Side};
use super::joint::Stiffness;
use super::scheme::{ContactSolver, Pairs, Substep};
use super::stream::Stream;
use super::{SceneNeeds, SolverContext};
use crate::each::Each as _;
use crate::lanes::Lanes;

/// Share of the depth beyond the slop that one pass takes away (the thesis's percent).
const CORRECTION_SHARE: f64 = 0.7;
/// Depth left alone, over the pair's length (the thesis's 0.01 px over half its bodies' 25 px).
const SLOP: f64 = 1e-3;

/// Velocities of all contacts. `moved`: displacements not yet known to the constraints.
fn resolve<L: Lanes>(
    stream: &mut Stream<L>,
    context: &SolverContext<'_, L::Elem>,
    rows: &mut [[L::Elem; 4]],
    moved: Option<&[[L::Elem; 4]]>,
) {
    let threshold = L::lit(context.speculative_speed());
    let SceneNeeds { friction, restitution, .. } = context.needs;
    stream.share(context.plan.workers, rows, &|rows, first, contacts| {
        let moved = moved.map(|moved| &moved[first..]);
        contacts.visit(&mut Resolve::<L> { rows, moved, threshold, friction, restitution });
    });
}

/// Velocities: one pass.
#[derive(Debug)]
struct Resolve<'a, L: Lanes> {
    /// Velocities per slot: vx, vy, ω, 1/m.
    rows: &'a mut [[L::Elem; 4]],
    /// Displacement of the last substep per slot; `None` where gaps are up to date.
    moved: Option<&'a [[L::Elem; 4]]>,
    /// Slower approaches do not bounce, m/s.
    threshold: L,
    /// Has any body friction?
    friction: bool,
    /// Does anything bounce?
    restitution: bool,
}

impl<L: Lanes> Visit<L> for Resolve<'_, L> {
    #[inline(always)]
    fn visit<const POINTS: usize>(&mut self, c: &mut Constraint<L, POINTS>, ends: Ends<'_>, _: usize) {
        let (mut a, mut b) = (Side::gather(self.rows, ends.a), Side::gather(self.rows, ends.b));
        if let Some(moved) = self.moved {
            c.follow(moved, &ends);
        }
        let mut normals = Normals::begin(c, &a, &b);
        let approaches: [L; POINTS] = crate::each::indexed(|k| {
            let approach = normals.velocity(&c.points[k]);
            if self.restitution {
                let bounces = approach.lt(-self.threshold);
                approach * (L::one() + L::select(bounces, c.restitution, L::zero()))
            } else {
                approach
            }
        });
        let masses = c.points.each(|point| point.mass);
        let stopped = non_negative(cross(c, &normals), masses, approaches);
        for k in 0..POINTS {
            normals.push(c, k, masses[k] * stopped[k]);
            // Not carried to the next step, but what friction is bounded by and what reports show.
            c.points[k].velocity_impulse = stopped[k];
        }
        normals.end(c, &mut a, &mut b);
        if self.friction {
            c.tangent_impulse = L::zero();
            c.solve_friction(&mut a, &mut b);
        }
        a.scatter(self.rows, ends.a);
        b.scatter(self.rows, ends.b);
    }
}

/// Positions: what overlaps is moved apart, with no effect on velocities.
#[derive(Debug)]
struct Correct<'a, L: Lanes> {
    /// Displacement of this substep per slot: x, y, angle, –.
    moved: &'a mut [[L::Elem; 4]],
    /// Velocity rows, for their inverse masses.
    rows: &'a [[L::Elem; 4]],
    /// Depth left alone, over the pair's length.
    slop: L,
}

impl<L: Lanes> Visit<L> for Correct<'_, L> {
    #[inline(always)]
    fn visit<const POINTS: usize>(&mut self, c: &mut Constraint<L, POINTS>, ends: Ends<'_>, _: usize) {
        let side = |slots: &[u32]| {
            Side::displacement(self.moved, slots, Side::<L>::gather(self.rows, slots).inv_mass)
        };
        let (mut a, mut b) = (side(ends.a), side(ends.b));
        let normals = Normals::begin(c, &a, &b);
        let sinking: [L; POINTS] = crate::each::indexed(|k| {
            let point = &c.points[k];
            let excess = -(point.separation + normals.velocity(point)) - self.slop * c.length;
            -(L::zero().max(excess) * L::lit(CORRECTION_SHARE))
        });
        part(c, normals, sinking, [&mut a, &mut b]);
        a.scatter(self.moved, ends.a);
        b.scatter(self.moved, ends.b);
    }
}

/// The solver.
#[derive(Debug)]
pub(super) struct Impulse;

impl<L: Lanes> ContactSolver<L> for Impulse {
    fn solve(&self, substep: &mut Substep<'_, L>) {
        let rows = substep.motion.velocity.fours_mut();
        let moved = substep.behind.then_some(substep.motion.moved.fours());
        if let Some(joints) = &mut substep.joints {
            // One visit leaks less than it takes back: carried from step to step, impulses of chains would grow.
            joints.warm_start(rows, if substep.first { 0.0 } else { 1.0 }, 1.0);
            let how = Stiffness::baumgarte(substep.context.plan.h_secs);
            joints.push(rows, moved.filter(|_| !substep.first), &how);
        }
        resolve(substep.stream, substep.context, rows, moved);
    }

    fn relax(&self, substep: &mut Substep<'_, L>, _: Pairs<'_, L>) {
        let slop = L::lit(SLOP);
        let (moved, rows) = (substep.motion.moved.fours_mut(), substep.motion.velocity.fours());
        substep.stream.share(substep.context.plan.workers, moved, &|moved, first, contacts| {
            contacts.visit(&mut Correct { moved, rows: &rows[first..], slop });
        });
    }
}
