//! Solvers: one per file, all on the same manifolds, joints, colours and streams of constraints.
//!
//! A solver changes velocities and displacements in the rows of [`crate::motion::Motion`] and the impulses
//! in its constraints, nothing else. Contacts of one colour share no dynamic body, so the lanes of a batch never
//! meet; static and kinematic bodies may occur in many lanes, but no mass moves them and their rows keep their values.
//! `avbd` alone colours bodies instead, and works on the pairs.
//! Joints are coloured likewise among themselves, and each pass visits them before the contacts: what was solved last
//! holds best, and a stretched joint is seen less than bodies in each other.
//!
//! | part of a step | joints | contacts |
//! |---|---|---|
//! | prepare | [`Solving::make_joints`], [`Solving::prepare_joints`]: joints and poses → constraints | [`Solving::follow`], [`Solving::prepare`]: manifolds → constraints |
//! | [`Solving::begin`] | impulses → rows | impulses → rows; approaches |
//! | [`Solving::solve`] | rows → rows, impulses | rows → rows, impulses |
//! | [`Solving::settle`] (not `pgs`, `impulse`) | rows, displacements → rows, impulses, arms | rows → rows, impulses |
//! | end | [`Solving::end_joints`]: impulses, angles → joints | [`Solving::end`]: bounces, deep overlaps |
//!
//! # After ten seconds
//! Largest overlap (mm) · root mean square of the speed (m/s) after 600 steps of 1/60 s; f32, 8 lanes, all skips, velocity
//! Verlet; substeps behind the name. `heavy/r` is a box on a box of 1/r of its mass.
//!
//! | | stack/10 | stack/40 | heavy/10 | heavy/100 | heavy/1000 | heavy/10000 | polygons/150 |
//! |---|---|---|---|---|---|---|---|
//! | pgs 4 | 0.30 · 2e-2 | falls over | 0.00 · 2e-2 | thrown off | thrown off | thrown off | 1.4 · 2e-2 |
//! | pgs 8 | 0.08 · 1e-2 | 0.39 · 1e-2 | 0.00 · 1e-2 | thrown off | thrown off | thrown off | 1.0 · 1e-2 |
//! | soft 4 | 1.5 · 5e-8 | 0.72 · 1e-7 (12) | 0.92 · 5e-8 | 0.08 · 0 (direct) | 0.08 · 0 (direct) | 0.01 · 0 (direct, 12) | 6.5 · 4e-8 |
//! | soft 8 | 0.37 · 3e-8 | 0.72 · 3e-7 (12) | 0.23 · 4e-9 | 0.02 · 0 (direct) | 0.02 · 0 (direct) | 0.01 · 0 (direct, 12) | 0.91 · 2e-8 |
//! | xpbd 4 | 1.4 · 2e-8 | 6.4 · 2e-2 | 0.85 · 5e-8 | 8.5 · 1e-7 | falls through | falls through | 4.7 · 6e-2 |
//! | xpbd 8 | 0.34 · 2e-8 | 1.6 · 6e-6 | 0.21 · 2e-8 | 2.1 · 1e-7 | falls through | falls through | 1.3 · 2e-1 |
//! | avbd 1 | 0.26 · 2e-3 | 4.1 · 6e-3 | 0.00 · 1e-4 | 1.2 · 4e-3 | 9.4 · 1e-2 | 49 · 2e-2 | 0.69 · 7e-3 |
//!
//! (12): the substeps these stacks were given, see [`slender_stack`]; (direct): contacts of masses so far apart are solved at
//! once, see `direct.rs`.
//! One run each. `avbd` goes ten times over bodies and contacts in its one substep, `pgs` eight times over contacts
//! in each, `soft` twice, `xpbd` twice. While polygons/150 falls, all overlap by 150 to 260 mm for a moment.

mod avbd;
mod batches;
mod block;
pub(crate) mod bounce;
mod color;
pub(crate) mod constraint;
mod deep;
mod direct;
mod impulse;
pub(crate) mod joint;
mod lengths;
mod pgs;
mod scheme;
pub(crate) mod slender_stack;
pub(crate) mod soft;
mod solving;
pub(crate) mod stream;
pub(crate) mod substep_group;
mod xpbd;

use crate::lanes::Real;
use crate::motion::Plan;
use crate::settings::{Skip, Skips, Solver};

pub use solving::Solving;

/// What a solver needs to know of the scene.
#[derive(Clone, Copy, Debug, Default)]
pub struct SceneNeeds {
    /// Some body has friction.
    pub friction: bool,
    /// Some body bounces.
    pub restitution: bool,
    /// |gravity|, m/s².
    pub gravity: f64,
}

/// Gaps up to this share of a pair's length ([`Bodies::length`](crate::body::Bodies::length)) are contacts.
const MARGIN: f64 = 0.025;
/// Bodies as fast as gravity makes them in so many steps are looked ahead for; slower ones stay within the margin.
const SWIFT_STEPS: f64 = 3.0;
/// Approaches slower than gravity makes in so many steps do not bounce. A ball comes to rest by itself before
/// ([`bounce`]); this is for those that gravity does not bring back. At 3, a disc of e = 0.8 rested 6 % early.
const BOUNCE_STEPS: f64 = 0.01;

impl SceneNeeds {
    /// The terms a solver must have, given what may be left out.
    #[must_use]
    pub fn needed(self, skips: Skips) -> Self {
        Self {
            friction: self.friction || !skips.has(Skip::Friction),
            restitution: self.restitution || !skips.has(Skip::Restitution),
            ..self
        }
    }

    /// The gap within which a solver wants to hear of contacts, as a share of a pair's length.
    pub fn margin<R: Real>(self, solver: Solver) -> R {
        match solver {
            Solver::Impulse => R::ZERO,
            Solver::Pgs | Solver::Soft | Solver::Xpbd | Solver::Avbd => R::from_f64(MARGIN),
        }
    }
}

/// Does a solver begin with the impulses of the last step?
pub fn carries_impulses(solver: Solver) -> bool {
    matches!(solver, Solver::Pgs | Solver::Soft)
}

/// Does a solver reckon with what contacts change displacements by, and settle velocities after bodies moved?
/// Such solvers bounce once, as a step ends.
pub fn pushes(solver: Solver) -> bool {
    matches!(solver, Solver::Soft | Solver::Xpbd | Solver::Avbd)
}

/// A step as its solver sees it.
#[derive(Clone, Copy, Debug)]
pub struct SolverContext<'a, R> {
    /// Which.
    pub solver: Solver,
    /// The terms to solve.
    pub needs: SceneNeeds,
    /// Seconds per step.
    pub dt_secs: f64,
    /// Of soft contacts, hz·h.
    pub stiffness: f64,
    /// How bodies move.
    pub plan: &'a Plan<'a, R>,
}

impl<R> SolverContext<'_, R> {
    /// Slower bodies stay within the margin, m/s; slower approaches do not bounce where a step knows nothing of gaps.
    pub fn speculative_speed(&self) -> f64 {
        SWIFT_STEPS * self.needs.gravity * self.dt_secs
    }

    /// Slower approaches do not bounce, m/s.
    pub fn bounce_threshold(&self) -> f64 {
        BOUNCE_STEPS * self.needs.gravity * self.dt_secs
    }

    /// [`SolverContext::speculative_speed`] and [`SolverContext::bounce_threshold`].
    pub fn speeds(&self) -> [f64; 2] {
        [self.speculative_speed(), self.bounce_threshold()]
    }
}
