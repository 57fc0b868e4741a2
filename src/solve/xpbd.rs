//! `xpbd`: small steps of position-based dynamics, one visit to each contact per substep.
//!
//! Recipe of a substep: predict and move → [`Project`]: displacements until nothing overlaps, static friction, and
//! the velocities that follow → [`Settle`]: velocities alone, what overlaps left is taken out, dynamic friction.
//! After the last substep bounces, as in [`super::soft`].
//!
//! At a point with separation C after the predicted displacement, Δλ = (−C − α̃·λ)/(w + α̃), α̃ = α/h², λ from 0 in every
//! substep (kg·m); w = 1/m of the point. Both points of a face are solved together ([`super::block`]). Along the tangent
//! the displacement of the substep is taken back as far as μ·Σλ reaches. Sources: Macklin et al., XPBD (2016) and Small
//! Steps (2019); Müller et al., Detailed Rigid Body Simulation (2020), whose static friction is all or nothing.
//!
//! * **Velocities.** v = Δx/h is kept up along with the corrections: a correction Δx changes v by Δx/(h·share),
//!   where share is what an impulse changes the displacement by over h times what it changes the velocity by
//!   ([`crate::motion::Plan::impulse_share`]): ½ for schemes of order ≥ 2. A resting box ends at exactly 0 so, and
//!   a body that touches nothing keeps the scheme's bits.
//! * **Compliance** adds α·N of overlap under a load N: 0, the hardest, needs no warm start and is no dearer.
//! * **What it cannot do.** One visit moves a load one contact down: under k equal boxes a contact sinks by about k·g·h²,
//!   and at mass ratios from 1000 on the lower box is pushed through the floor. Figures: [`super`].
//! * **Impulses.** λ/(h·share) is what friction in [`Settle`] is bounded by, and what a report shows.

use super::SolverContext;
use super::batches::{Ends, Visit};
use super::block::{cross, non_negative, relaxed};
use super::constraint::{Constraint, Normals, Side};
use super::joint::Stiffness;
use super::scheme::{ContactSolver, Pairs, Substep};
use super::stream::Stream;
use crate::each::Each as _;
use crate::lanes::{LaneMask, Lanes};

/// Compliance α of contacts, m/N.
const COMPLIANCE: f64 = 0.0;
/// Overlap from before the substep that one substep takes away at most: this share of the pair's length
/// per step, spread over the substeps.
const PUSH_CAP: f64 = 0.1;

/// [`Project`] for all contacts.
fn project<L: Lanes>(
    stream: &mut Stream<L>,
    context: &SolverContext<'_, L::Elem>,
    moved: &mut [[L::Elem; 4]],
    rows: &mut [[L::Elem; 4]],
) {
    let h_secs = context.plan.h_secs;
    let cap = PUSH_CAP / f64::from(context.plan.substeps);
    let per_sec = L::lit(1.0 / (h_secs * context.plan.impulse_share()));
    let (softness, push_cap) = (L::lit(COMPLIANCE / (h_secs * h_secs)), L::lit(-cap));
    stream.each(|first, contacts| {
        let (moved, rows) = (&mut moved[first..], &mut rows[first..]);
        if context.needs.friction {
            contacts.visit(&mut Project::<L, true> { moved, rows, softness, per_sec, push_cap });
        } else {
            contacts.visit(&mut Project::<L, false> { moved, rows, softness, per_sec, push_cap });
        }
    });
}

/// [`Settle`] for all contacts.
fn settle<L: Lanes>(
    stream: &mut Stream<L>,
    context: &SolverContext<'_, L::Elem>,
    moved: &[[L::Elem; 4]],
    rows: &mut [[L::Elem; 4]],
) {
    let per_sec = L::lit(1.0 / context.plan.h_secs);
    stream.share(context.plan.workers, rows, &|rows, first, contacts| {
        let moved = &moved[first..];
        if context.needs.friction {
            contacts.visit(&mut Settle::<L, true> { moved, rows, per_sec });
        } else {
            contacts.visit(&mut Settle::<L, false> { moved, rows, per_sec });
        }
    });
}

/// Displacements, and the velocities that follow from them.
#[derive(Debug)]
struct Project<'a, L: Lanes, const FRICTION: bool> {
    /// Displacement of this substep per slot: x, y, angle, –.
    moved: &'a mut [[L::Elem; 4]],
    /// Velocities per slot: vx, vy, ω, 1/m.
    rows: &'a mut [[L::Elem; 4]],
    /// α̃ = α/h², 1/kg.
    softness: L,
    /// Velocity per displacement: 1/(h·share), 1/s.
    per_sec: L,
    /// −[`PUSH_CAP`] in lengths per substep.
    push_cap: L,
}

impl<L: Lanes, const FRICTION: bool> Visit<L> for Project<'_, L, FRICTION> {
    #[inline(always)]
    fn visit<const POINTS: usize>(&mut self, c: &mut Constraint<L, POINTS>, ends: Ends<'_>, _: usize) {
        let (mut va, mut vb) = (Side::gather(self.rows, ends.a), Side::gather(self.rows, ends.b));
        // A displacement is to λ as a velocity is to its impulse: the same kernels serve.
        let side = |moved: &[[L::Elem; 4]], slots: &[u32], inv_mass: L| Side {
            inv_mass,
            ..Side::gather(moved, slots)
        };
        let mut a = side(self.moved, ends.a, va.inv_mass);
        let mut b = side(self.moved, ends.b, vb.inv_mass);
        let zero = L::zero();
        let mut normals = Normals::begin(c, &a, &b);
        let masses = c.points.each(|point| point.mass);
        let soften = masses.each(|mass| L::one() / (L::one() + mass * self.softness));
        let soft: [L; POINTS] = crate::each::indexed(|k| masses[k] * soften[k]);
        let gaps: [L; POINTS] = crate::each::indexed(|k| {
            let point = &c.points[k];
            (self.push_cap * c.length).max(point.separation) + normals.velocity(point)
        });
        let pushed = non_negative(cross(c, &normals), soft, gaps);
        c.tangent_impulse = zero;
        let touches = pushed.iter().any(|push| zero.lt(*push).any());
        for k in 0..POINTS {
            c.points[k].velocity_impulse = pushed[k] * soften[k];
        }
        if !touches {
            return;
        }
        for k in 0..POINTS {
            normals.push(c, k, soft[k] * pushed[k]);
        }
        normals.end(c, &mut a, &mut b);
        if FRICTION {
            c.solve_friction(&mut a, &mut b);
        }
        // The same λ, as impulses.
        for point in &mut c.points {
            point.velocity_impulse = point.velocity_impulse * self.per_sec;
        }
        c.tangent_impulse = c.tangent_impulse * self.per_sec;
        c.apply_accumulated(&mut va, &mut vb);
        a.scatter(self.moved, ends.a);
        b.scatter(self.moved, ends.b);
        va.scatter(self.rows, ends.a);
        vb.scatter(self.rows, ends.b);
    }
}

/// Velocities: points that carry something neither close nor part; dynamic friction. Gaps are brought up to date.
#[derive(Debug)]
struct Settle<'a, L: Lanes, const FRICTION: bool> {
    /// Displacement of this substep per slot: x, y, angle, –.
    moved: &'a [[L::Elem; 4]],
    /// Velocities per slot: vx, vy, ω, 1/m.
    rows: &'a mut [[L::Elem; 4]],
    /// 1/h.
    per_sec: L,
}

impl<L: Lanes, const FRICTION: bool> Visit<L> for Settle<'_, L, FRICTION> {
    #[inline(always)]
    fn visit<const POINTS: usize>(&mut self, c: &mut Constraint<L, POINTS>, ends: Ends<'_>, _: usize) {
        c.follow(self.moved, &ends);
        let zero = L::zero();
        let velocity_impulse = c.points.each(|point| point.velocity_impulse);
        if !velocity_impulse.iter().any(|velocity_impulse| zero.lt(*velocity_impulse).any()) {
            return;
        }
        let (mut a, mut b) = (Side::gather(self.rows, ends.a), Side::gather(self.rows, ends.b));
        let mut normals = Normals::begin(c, &a, &b);
        let next = relaxed(c, &normals, self.per_sec);
        // Lanes that carry nothing are as if visited alone.
        let carries = velocity_impulse.iter().fold(zero, |sum, velocity_impulse| sum + *velocity_impulse);
        let carries = zero.lt(carries);
        let next: [L; POINTS] = crate::each::indexed(|k| L::select(carries, next[k], velocity_impulse[k]));
        for k in 0..POINTS {
            normals.push(c, k, c.points[k].mass * (next[k] - velocity_impulse[k]));
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
pub(super) struct Xpbd;

impl<L: Lanes> ContactSolver<L> for Xpbd {
    fn solve(&self, substep: &mut Substep<'_, L>) {
        // Bodies move before contacts are seen.
        substep.push_joints();
    }

    fn relax(&self, substep: &mut Substep<'_, L>, _: Pairs<'_, L>) {
        let how = Stiffness::soft(substep.h_secs(), substep.share());
        let (moved, rows) = (substep.motion.moved.fours_mut(), substep.motion.velocity.fours_mut());
        project(substep.stream, substep.context, moved, rows);
        if let Some(joints) = &mut substep.joints {
            joints.relax(rows, moved, &how);
        }
        settle(substep.stream, substep.context, moved, rows);
    }
}
