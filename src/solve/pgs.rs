//! `pgs`: sequential impulses (projected Gauss–Seidel) with warm start, friction cone and Baumgarte bias.
//!
//! [`ITERATIONS`] visits to each contact per substep: λ ≥ 0 with v + bias ≥ 0 at each point, both points of a face
//! together, then
//! λ_t ← clamp(λ_t − m_t·v_t, ±μ·λ_n). Overlap beyond the slop is pushed out as velocity, β·s/h, which stays in
//! the bodies: this is what `soft` relaxes away. Source: Catto, Iterative Dynamics with Temporal Coherence, GDC 2005.

use super::SolverContext;
use super::batches::{Ends, Visit};
use super::block::{answer, cross, non_negative};
use super::constraint::{Constraint, Normals, Side};
use super::joint::Stiffness;
use super::scheme::{ContactSolver, Pairs, Substep};
use super::stream::Stream;
use crate::each::Each as _;
use crate::lanes::Lanes;

/// Visits to each contact per substep.
const ITERATIONS: usize = 8;
/// Share of the overlap beyond the slop that one substep takes away.
const BAUMGARTE: f64 = 0.2;
/// Overlap left alone, over the pair's length.
const SLOP: f64 = 1e-3;

/// One iteration: all contacts once. `moved`: displacements not yet known to the constraints.
fn iterate<L: Lanes>(
    stream: &mut Stream<L>,
    context: &SolverContext<'_, L::Elem>,
    rows: &mut [[L::Elem; 4]],
    moved: Option<&[[L::Elem; 4]]>,
) {
    let h_secs = context.plan.h_secs;
    let (per_sec, slop) = (L::lit(1.0 / h_secs), L::lit(SLOP));
    let bias_rate = L::lit(BAUMGARTE / h_secs);
    stream.share(context.plan.workers, rows, &|rows, first, contacts| {
        let moved = moved.map(|moved| &moved[first..]);
        if context.needs.friction {
            contacts.visit(&mut Pass::<L, true> { rows, moved, per_sec, bias_rate, slop });
        } else {
            contacts.visit(&mut Pass::<L, false> { rows, moved, per_sec, bias_rate, slop });
        }
    });
}

/// One visit to all contacts.
#[derive(Debug)]
struct Pass<'a, L: Lanes, const FRICTION: bool> {
    /// Velocities per slot: vx, vy, ω, 1/m.
    rows: &'a mut [[L::Elem; 4]],
    /// Displacement of the last substep per slot; `None` where gaps are up to date.
    moved: Option<&'a [[L::Elem; 4]]>,
    /// 1/h.
    per_sec: L,
    /// β/h.
    bias_rate: L,
    /// Overlap left alone, over the pair's length.
    slop: L,
}

impl<L: Lanes, const FRICTION: bool> Visit<L> for Pass<'_, L, FRICTION> {
    #[inline(always)]
    fn visit<const POINTS: usize>(&mut self, c: &mut Constraint<L, POINTS>, ends: Ends<'_>, _: usize) {
        let (mut a, mut b) = (Side::gather(self.rows, ends.a), Side::gather(self.rows, ends.b));
        if let Some(moved) = self.moved {
            c.follow(moved, &ends);
        }
        let zero = L::zero();
        let mut normals = Normals::begin(c, &a, &b);
        let cross = cross(c, &normals);
        let masses = c.points.each(|point| point.mass);
        let velocity_impulse = c.points.each(|point| point.velocity_impulse);
        let answer = answer(cross, masses, velocity_impulse);
        let wanted: [L; POINTS] = crate::each::indexed(|k| {
            let point = &c.points[k];
            let gap = zero.max(point.separation) * self.per_sec;
            let overlap = zero.max(-(point.separation + self.slop * c.length)) * self.bias_rate;
            normals.velocity(point) + gap - overlap - answer[k]
        });
        let next = non_negative(cross, masses, wanted);
        for k in 0..POINTS {
            normals.push(c, k, masses[k] * (next[k] - velocity_impulse[k]));
            c.points[k].velocity_impulse = next[k];
        }
        normals.end(c, &mut a, &mut b);
        if FRICTION {
            c.solve_friction(&mut a, &mut b);
        }
        a.scatter(self.rows, ends.a);
        b.scatter(self.rows, ends.b);
    }
}

/// The solver.
#[derive(Debug)]
pub(super) struct Pgs;

impl<L: Lanes> ContactSolver<L> for Pgs {
    fn solve(&self, substep: &mut Substep<'_, L>) {
        let how = Stiffness::baumgarte(substep.h_secs());
        let rows = substep.motion.velocity.fours_mut();
        let moved = substep.behind.then_some(substep.motion.moved.fours());
        for iteration in 0..ITERATIONS {
            // Joints are placed as a step begins; all hear of displacements once.
            let moved = moved.filter(|_| iteration == 0);
            if let Some(joints) = &mut substep.joints {
                joints.push(rows, moved.filter(|_| !substep.first), &how);
            }
            iterate(substep.stream, substep.context, rows, moved);
        }
    }

    fn relax(&self, _: &mut Substep<'_, L>, _: Pairs<'_, L>) {}
}
