//! `soft`: substepped soft contacts (TGS soft), the default.
//!
//! A contact is a damped spring of angular frequency ω = 2π·hz and damping ratio ζ, integrated implicitly:
//! a₁ = 2ζ + hω, a₂ = hω·a₁, a₃ = 1/(1 + a₂); bias rate ω/a₁, mass scale a₂·a₃. The mass scale softens the diagonal
//! of K, so that the points of a face are solved together (see `block.rs`) and no impulse scale is needed.
//! Recipe of a substep: predict velocities, warm start per body → push out ([`Push`]) → move → relax ([`Relax`]); after each pass
//! what masses make hard is solved at once (`joint/direct.rs`, `direct.rs`).
//! Source: Catto, Solver2D (2024); the warm start per body and the moving velocity are ours.
//!
//! * **Moving velocity.** A substep moves a body by h·u. The push works on u, the relaxation on the velocity v at
//!   the substep's end. For schemes of order ≥ 2 an impulse changes u by half of what it changes v by, for Euler
//!   by all of it ([`crate::motion::Plan::impulse_share`]); so resting bodies neither float nor sink, and a block
//!   that slides stops where it should.
//! * **Friction in the relaxation only**: friction that answers the push's velocities pumps tall stacks.
//! * **Gaps.** A point apart by s > 0 may close by s in a substep, no more. The relaxation leaves points alone that
//!   carried nothing in the push.

use super::batches::{Ends, Visit};
use super::block::{answer, cross, non_negative, relaxed};
use super::constraint::{Constraint, Normals, Side};
use super::deep::DEEP;
use super::direct::{Bias, Pass};
use super::joint::Stiffness;
use super::scheme::{ContactSolver, Pairs, Substep};
use crate::each::Each as _;
use crate::lanes::{Lanes, Real};

pub use crate::settings::HERTZ_TIMES_SUBSTEP;

/// Where steps become shorter, contacts become stiffer by no more than this a step: made stiff at once, what has sagged
/// by h² under long steps leaps up (a column of ten at 1/240 s after 1/10 s fell over).
pub(crate) const STIFFENING: f64 = 0.97;
/// Damping ratio ζ: from 5 to 20 a pyramid of base 100 drifts by 5 to 8 cm in 60 s; 1 and 3 shake more.
pub(crate) const DAMPING: f64 = 10.0;
/// Fastest push out of an overlap: this share of the pair's length per step.
pub const PUSH_CAP: f64 = 0.1;

/// The coefficients of a soft contact for one substep length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Softness<L> {
    /// 1/h.
    pub per_sec: L,
    /// Bias velocity per metre of overlap, 1/s.
    pub bias_rate: L,
    /// Factor on the effective mass.
    pub mass_scale: L,
    /// Fastest push over the pair's length, 1/s, negated.
    pub push_cap: L,
}

/// Bias rate, 1/s, and mass scale of a damped spring integrated implicitly over `h_secs`.
pub(super) fn coefficients(h_secs: f64, hertz: f64, damping: f64) -> (f64, f64) {
    let omega = 2.0 * std::f64::consts::PI * hertz;
    let a1 = 2.0 * damping + h_secs * omega;
    let a2 = h_secs * omega * a1;
    let a3 = 1.0 / (1.0 + a2);
    (omega / a1, a2 * a3)
}

impl<L: Lanes> Softness<L> {
    /// For substeps of `h_secs`, a frequency of `hertz` and overlaps pushed out at `push_cap` lengths a second at most.
    pub(crate) fn new(h_secs: f64, hertz: f64, damping: f64, push_cap: f64) -> Self {
        let (bias_rate, mass_scale) = coefficients(h_secs, hertz, damping);
        Self {
            per_sec: L::lit(1.0 / h_secs),
            bias_rate: L::lit(bias_rate),
            mass_scale: L::lit(mass_scale),
            push_cap: L::lit(-push_cap),
        }
    }
}

/// The pass before bodies move: normal impulses with bias; `DEEP`: something is, see `deep.rs`.
#[derive(Debug)]
pub(crate) struct Push<'a, L: Lanes, const DEEP: bool> {
    /// Moving velocities u per slot: ux, uy, uω, 1/m.
    pub rows: &'a mut [[L::Elem; 4]],
    /// Displacement of the last substep per slot; `None` in a step's first, whose gaps are up to date.
    pub moved: Option<&'a [[L::Elem; 4]]>,
    /// Coefficients.
    pub soft: Softness<L>,
    /// Points with a smaller separation, metres, only stop closing; where something is deep.
    pub deep: L,
    /// What an impulse changes u by, over what it changes v by.
    pub share: L,
    /// 1/`share`.
    pub per_share: L,
}

impl<L: Lanes, const DEEP: bool> Visit<L> for Push<'_, L, DEEP> {
    #[inline(always)]
    fn visit<const POINTS: usize>(&mut self, c: &mut Constraint<L, POINTS>, ends: Ends<'_>, _: usize) {
        let (mut a, mut b) = (Side::gather(self.rows, ends.a), Side::gather(self.rows, ends.b));
        if let Some(moved) = self.moved {
            c.follow(moved, &ends);
        }
        let (soft, zero) = (&self.soft, L::zero());
        let mut normals = Normals::begin(c, &a, &b);
        let cross = cross(c, &normals);
        let apart: [L::Mask; POINTS] = crate::each::indexed(|k| zero.lt(c.points[k].separation));
        let deep = self.deep * c.length;
        let is_deep: [L::Mask; POINTS] = crate::each::indexed(|k| c.points[k].separation.lt(deep));
        let push_cap = soft.push_cap * c.length;
        let soften: [L; POINTS] = crate::each::indexed(|k| {
            let rigid = if DEEP { apart[k] | is_deep[k] } else { apart[k] };
            L::select(rigid, L::one(), soft.mass_scale)
        });
        let masses = c.points.each(|point| point.mass);
        // Impulses in units of u: `share` of those of v.
        let velocity_impulse = c.points.each(|point| point.velocity_impulse * self.share);
        let answer = answer(cross, masses, velocity_impulse);
        let wanted: [L; POINTS] = crate::each::indexed(|k| {
            let point = &c.points[k];
            let closing = point.separation * soft.per_sec;
            let pushing = push_cap.max(point.separation * soft.bias_rate);
            let pushing = if DEEP { L::select(is_deep[k], zero, pushing) } else { pushing };
            normals.velocity(point) + L::select(apart[k], closing, pushing) - answer[k]
        });
        let soft_masses: [L; POINTS] = crate::each::indexed(|k| masses[k] * soften[k]);
        let next = non_negative(cross, soft_masses, wanted);
        for k in 0..POINTS {
            normals.push(c, k, soft_masses[k] * next[k] - masses[k] * velocity_impulse[k]);
            c.points[k].velocity_impulse = (soften[k] * next[k]) * self.per_share;
        }
        normals.end(c, &mut a, &mut b);
        a.scatter(self.rows, ends.a);
        b.scatter(self.rows, ends.b);
    }
}

/// The pass after bodies moved: normal impulses without bias, then friction.
#[derive(Debug)]
pub(crate) struct Relax<'a, L: Lanes, const FRICTION: bool> {
    /// Velocities per slot: vx, vy, ω, 1/m.
    pub rows: &'a mut [[L::Elem; 4]],
    /// 1/h.
    pub per_sec: L,
}

impl<L: Lanes, const FRICTION: bool> Visit<L> for Relax<'_, L, FRICTION> {
    #[inline(always)]
    fn visit<const POINTS: usize>(&mut self, c: &mut Constraint<L, POINTS>, ends: Ends<'_>, _: usize) {
        let (mut a, mut b) = (Side::gather(self.rows, ends.a), Side::gather(self.rows, ends.b));
        let mut normals = Normals::begin(c, &a, &b);
        let next = relaxed(c, &normals, self.per_sec);
        for (k, next) in next.into_iter().enumerate() {
            normals.push(c, k, c.points[k].mass * (next - c.points[k].velocity_impulse));
            c.points[k].velocity_impulse = next;
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
pub(super) struct Soft;

impl<L: Lanes> ContactSolver<L> for Soft {
    fn solve(&self, substep: &mut Substep<'_, L>) {
        let (context, h_secs, share) = (substep.context, substep.h_secs(), substep.share());
        let rows = substep.motion.velocity.fours_mut();
        if let Some(joints) = &mut substep.joints {
            joints.push(rows, None, &Stiffness::soft(h_secs, share));
            joints.solve_directly(rows, Some(&Stiffness::soft(h_secs, share)));
        }
        let moved = substep.behind.then_some(substep.motion.moved.fours());
        let cap = PUSH_CAP / context.dt_secs;
        let soft = Softness::new(h_secs, substep.softened * (context.stiffness / h_secs), DAMPING, cap);
        let deep = L::lit(-DEEP);
        let [share, per_share] = [share, 1.0 / share].each(L::lit);
        let any_deep = substep.deep;
        substep.stream.share(context.plan.workers, rows, &|rows, first, contacts| {
            let moved = moved.map(|moved| &moved[first..]);
            if any_deep {
                contacts.visit(&mut Push::<L, true> { rows, moved, soft, deep, share, per_share });
            } else {
                contacts.visit(&mut Push::<L, false> { rows, moved, soft, deep, share, per_share });
            }
        });
        let number = |value: L| value.to_array()[0].to_f64();
        let [rate, per_sec, push_cap] = [soft.bias_rate, soft.per_sec, soft.push_cap].each(number);
        let deep = if substep.deep { number(deep) } else { f64::NEG_INFINITY };
        let bias = Bias { per_sec, rate, push_cap, deep, share: number(share) };
        substep.direct.solve(substep.stream, rows, Pass::Push(&bias));
    }

    fn relax(&self, substep: &mut Substep<'_, L>, _: Pairs<'_, L>) {
        let how = Stiffness::soft(substep.h_secs(), substep.share());
        let (workers, friction) = (substep.context.plan.workers, substep.context.needs.friction);
        let (rows, per_sec) =
            (substep.motion.velocity.fours_mut(), L::lit(1.0 / substep.context.plan.h_secs));
        if let Some(joints) = &mut substep.joints {
            joints.relax(rows, substep.motion.moved.fours(), &how);
            joints.solve_directly(rows, None);
        }
        for round in 0..=substep.rounds {
            if let Some(joints) = &mut substep.joints
                && round > 0
            {
                joints.relax_velocities(rows, &how);
            }
            substep.stream.share(workers, rows, &|rows, _, contacts| {
                if friction {
                    contacts.visit(&mut Relax::<L, true> { rows, per_sec });
                } else {
                    contacts.visit(&mut Relax::<L, false> { rows, per_sec });
                }
            });
            let per_sec = 1.0 / substep.context.plan.h_secs;
            substep.direct.solve(substep.stream, rows, Pass::Relax(per_sec));
        }
    }
}
