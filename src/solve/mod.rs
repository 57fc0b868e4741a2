//! Solvers: one per file, all on the same manifolds, colours and stream of constraints.
//!
//! A solver changes velocities and displacements in the rows of [`crate::integrate::Motion`] and the impulses
//! in its constraints, nothing else. Contacts of one colour share no dynamic body, so the lanes of a batch never
//! meet; static and kinematic bodies may occur in many lanes, but no mass moves them and their rows keep their values.

mod block;
pub mod color;
pub mod constraint;
mod impulse;
mod pgs;
pub mod soft;
pub mod stream;

use crate::body::Bodies;
use crate::contact::Manifolds;
use crate::integrate::{Motion, Plan};
use crate::lanes::{Lanes, Real};
use crate::narrow::Narrow;
use crate::settings::{Skip, Skips, Solver};

use color::Coloring;
use soft::Softness;
use stream::{Stream, WarmStart};

/// What a solver needs to know of the scene.
#[derive(Clone, Copy, Debug, Default)]
pub struct Traits {
    /// Some body has friction.
    pub friction: bool,
    /// Some body bounces.
    pub restitution: bool,
    /// Median bounding radius of movable bodies, metres: what lengths without a scale of their own are shares of.
    pub length: f64,
    /// |gravity|, m/s².
    pub gravity: f64,
}

/// Gaps up to this share of the scene's median radius are contacts.
const MARGIN: f64 = 0.025;
/// Approaches slower than gravity makes in so many steps do not bounce.
const BOUNCE_STEPS: f64 = 3.0;
/// Gaps up to this share of the median radius have touched when a bounce is due.
const TOUCH: f64 = 1e-3;

impl Traits {
    /// The terms a solver must have, given what may be left out.
    #[must_use]
    pub fn needed(self, skips: Skips) -> Self {
        Self {
            friction: self.friction || !skips.has(Skip::Friction),
            restitution: self.restitution || !skips.has(Skip::Restitution),
            ..self
        }
    }

    /// The gap within which a solver wants to hear of contacts, metres.
    pub fn margin<R: Real>(self, solver: Solver) -> R {
        match solver {
            Solver::Impulse => R::ZERO,
            Solver::Pgs | Solver::Soft => R::from_f64(MARGIN * self.length),
        }
    }
}

/// Does a solver begin with the impulses of the last step?
pub fn carries_impulses(solver: Solver) -> bool {
    !matches!(solver, Solver::Impulse)
}

/// Does a solver push on the moving velocity and relax after bodies moved?
pub fn pushes(solver: Solver) -> bool {
    matches!(solver, Solver::Soft)
}

/// A step as its solver sees it.
#[derive(Clone, Copy, Debug)]
pub struct Task<'a, R> {
    /// Which.
    pub solver: Solver,
    /// The terms to solve.
    pub traits: Traits,
    /// Seconds per step.
    pub dt_secs: f64,
    /// How bodies move.
    pub plan: &'a Plan<'a, R>,
}

/// Colours, constraints and what solvers keep; memory is kept from step to step.
#[derive(Clone, Debug)]
pub struct Solving<L: Lanes> {
    coloring: Coloring,
    stream: Stream<L>,
    bounces: soft::Bounces<L>,
    /// The substep the impulses of the last step belong to, seconds.
    last_h_secs: f64,
}

impl<L: Lanes> Default for Solving<L> {
    fn default() -> Self {
        Self {
            coloring: Coloring::default(),
            stream: Stream::default(),
            bounces: soft::Bounces::default(),
            last_h_secs: 0.0,
        }
    }
}

impl<L: Lanes> Solving<L> {
    /// Makes constraints of the manifolds found: all of them where the graph of contacts has changed, else those of
    /// the pairs looked at.
    pub fn prepare(
        &mut self,
        bodies: &Bodies<L::Elem>,
        narrow: &mut Narrow<L::Elem>,
        changed: bool,
        motion: &Motion<L::Elem>,
    ) {
        if changed {
            self.coloring.run(bodies, &mut narrow.manifolds);
            self.stream.cut(&self.coloring, &narrow.manifolds);
        } else {
            for place in narrow.looked_at() {
                self.stream.touch(place);
            }
        }
        self.stream.begin(&narrow.manifolds, motion.matter.fours());
    }

    /// Before the first substep: what bounces is noted, and the rows get what the warm start adds.
    pub fn begin(
        &mut self,
        task: &Task<'_, L::Elem>,
        bodies: &Bodies<L::Elem>,
        motion: &mut Motion<L::Elem>,
    ) {
        if task.traits.restitution && pushes(task.solver) {
            motion.load::<L>(task.plan, bodies);
            self.bounces.resize(self.stream.batches());
            self.stream.visit(&mut soft::NoteApproach {
                rows: motion.velocity.fours(),
                accelerations: motion.acceleration.fours(),
                threshold: L::lit(BOUNCE_STEPS * task.traits.gravity * task.dt_secs),
                bounces: &mut self.bounces,
            });
        }
        motion.clear_rows();
        if carries_impulses(task.solver) {
            let (h, last) = (task.plan.h_secs, self.last_h_secs);
            let share = if last > 0.0 { h / last } else { 1.0 };
            let rows = motion.velocity.fours_mut();
            self.stream.visit(&mut WarmStart { rows, share: L::Elem::from_f64(share) });
        }
        self.last_h_secs = task.plan.h_secs;
    }

    /// Contacts of one substep, before bodies move.
    pub fn solve(&mut self, task: &Task<'_, L::Elem>, motion: &mut Motion<L::Elem>, first: bool) {
        let Traits { friction, restitution, length, gravity } = task.traits;
        let h_secs = task.plan.h_secs;
        let rows = motion.velocity.fours_mut();
        let moved = (!first).then_some(motion.moved.fours());
        let stream = &mut self.stream;
        match task.solver {
            Solver::Soft => {
                let share = task.plan.impulse_share();
                let cap = soft::PUSH_CAP * length / task.dt_secs;
                stream.visit(&mut soft::Push {
                    rows,
                    moved,
                    soft: Softness::new(h_secs, soft::HERTZ_TIMES_SUBSTEP / h_secs, soft::DAMPING, cap),
                    share: L::lit(share),
                    per_share: L::lit(1.0 / share),
                });
            }
            Solver::Pgs => {
                let (per_sec, slop) = (L::lit(1.0 / h_secs), L::lit(pgs::SLOP * length));
                let bias_rate = L::lit(pgs::BAUMGARTE / h_secs);
                for iteration in 0..pgs::ITERATIONS {
                    let moved = moved.filter(|_| iteration == 0);
                    if friction {
                        stream.visit(&mut pgs::Pass::<L, true> { rows, moved, per_sec, bias_rate, slop });
                    } else {
                        stream.visit(&mut pgs::Pass::<L, false> { rows, moved, per_sec, bias_rate, slop });
                    }
                }
            }
            Solver::Impulse => {
                let threshold = L::lit(BOUNCE_STEPS * gravity * task.dt_secs);
                match (friction, restitution) {
                    (true, true) => {
                        stream.visit(&mut impulse::Resolve::<L, true, true> { rows, moved, threshold });
                    }
                    (true, false) => {
                        stream.visit(&mut impulse::Resolve::<L, true, false> { rows, moved, threshold });
                    }
                    (false, true) => {
                        stream.visit(&mut impulse::Resolve::<L, false, true> { rows, moved, threshold });
                    }
                    (false, false) => {
                        stream.visit(&mut impulse::Resolve::<L, false, false> { rows, moved, threshold });
                    }
                }
            }
        }
    }

    /// Contacts of one substep, after bodies moved.
    pub fn settle(&mut self, task: &Task<'_, L::Elem>, motion: &mut Motion<L::Elem>) {
        match task.solver {
            Solver::Soft => {
                let (rows, per_sec) = (motion.velocity.fours_mut(), L::lit(1.0 / task.plan.h_secs));
                if task.traits.friction {
                    self.stream.visit(&mut soft::Relax::<L, true> { rows, per_sec });
                } else {
                    self.stream.visit(&mut soft::Relax::<L, false> { rows, per_sec });
                }
            }
            Solver::Pgs => {}
            Solver::Impulse => self.stream.visit(&mut impulse::Correct {
                moved: motion.moved.fours_mut(),
                rows: motion.velocity.fours(),
                slop: L::lit(impulse::SLOP * task.traits.length),
            }),
        }
    }

    /// After the last substep: bounces, and pairs get their gaps and impulses back.
    pub fn end(
        &mut self,
        task: &Task<'_, L::Elem>,
        manifolds: &mut Manifolds<L::Elem>,
        motion: &mut Motion<L::Elem>,
    ) {
        if task.traits.restitution && pushes(task.solver) {
            self.stream.visit(&mut soft::Bounce {
                rows: motion.velocity.fours_mut(),
                touch: L::lit(TOUCH * task.traits.length),
                moved: motion.moved.fours(),
                bounces: &mut self.bounces,
            });
        }
        self.stream.end(manifolds, motion.moved.fours());
    }

    /// The colours.
    pub fn coloring(&self) -> &Coloring {
        &self.coloring
    }
    /// The constraints.
    pub fn stream(&self) -> &Stream<L> {
        &self.stream
    }
}
