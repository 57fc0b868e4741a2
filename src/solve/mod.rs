//! Solvers: one per file, all on the same manifolds, colours and stream of constraints.
//!
//! A solver changes velocities and displacements in the rows of [`crate::integrate::Motion`] and the impulses
//! in its constraints, nothing else. Contacts of one colour share no dynamic body, so the lanes of a batch never
//! meet; static and kinematic bodies may occur in many lanes, but no mass moves them and their rows keep their values.
//! `avbd` alone colours bodies instead, and works on the pairs.
//!
//! # After ten seconds
//! Largest overlap (mm) · root mean square of the speed (m/s) after 600 steps of 1/60 s; f32, 8 lanes, all skips, velocity
//! Verlet; substeps behind the name. `heavy/r` is a box on a box of 1/r of its mass.
//!
//! | | stack/10 | stack/40 | heavy/10 | heavy/100 | heavy/1000 | heavy/10000 | polygons/150 |
//! |---|---|---|---|---|---|---|---|
//! | pgs 4 | 0.30 · 2e-2 | falls over | 0.00 · 2e-2 | thrown off | thrown off | thrown off | 1.5 · 2e-2 |
//! | pgs 8 | 0.08 · 1e-2 | 0.40 · 1e-2 | 0.00 · 1e-2 | thrown off | thrown off | thrown off | 1.1 · 1e-2 |
//! | soft 4 | 0.78 · 5e-8 | 3.4 · 2e-7 | 0.48 · 2e-8 | 4.4 · 4e-7 | 43 · 1e-6 | falls through | 2.1 · 1e-7 |
//! | soft 8 | 0.19 · 1e-8 | 0.84 · 6e-8 | 0.12 · 1e-8 | 1.1 · 1e-7 | 11 · 1e-6 | 109 · 3e-2 | 0.57 · 2e-8 |
//! | xpbd 4 | 1.4 · 2e-8 | 6.4 · 2e-2 | 0.85 · 5e-8 | 8.5 · 1e-7 | falls through | falls through | 2.8 · 4e-1 |
//! | xpbd 8 | 0.34 · 2e-8 | 1.6 · 6e-6 | 0.21 · 2e-8 | 2.1 · 1e-7 | falls through | falls through | 1.2 · 3e-2 |
//! | avbd 1 | 0.27 · 2e-3 | 4.1 · 6e-3 | 0.00 · 1e-4 | 1.2 · 4e-3 | 9.4 · 1e-2 | 49 · 2e-2 | 0.42 · 4e-3 |
//!
//! One run each. `avbd` goes ten times over bodies and contacts in its one substep, `pgs` eight times over contacts
//! in each, `soft` twice, `xpbd` twice. While polygons/150 falls, all overlap by 150 to 260 mm for a moment.

mod avbd;
mod block;
pub mod color;
pub mod constraint;
mod impulse;
mod pgs;
pub mod soft;
pub mod stream;
mod xpbd;

use crate::body::Bodies;
use crate::contact::Manifolds;
use crate::integrate::{Motion, Plan, Warm};
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
/// Gaps up to this share of the median radius have touched: when a bounce is due, when a fast body is stopped.
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

    /// Gaps up to this have touched, metres.
    pub fn touch(self) -> f64 {
        TOUCH * self.length
    }

    /// The gap within which a solver wants to hear of contacts, metres.
    pub fn margin<R: Real>(self, solver: Solver) -> R {
        match solver {
            Solver::Impulse => R::ZERO,
            Solver::Pgs | Solver::Soft | Solver::Xpbd | Solver::Avbd => R::from_f64(MARGIN * self.length),
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

impl<R> Task<'_, R> {
    /// Slower approaches do not bounce, m/s.
    pub fn bounce_threshold(&self) -> f64 {
        BOUNCE_STEPS * self.traits.gravity * self.dt_secs
    }
}

/// Where today's gaps and impulses are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Latest {
    /// In the pairs' rows.
    #[default]
    InPairs,
    /// In the constraints.
    InConstraints,
    /// In the constraints, whose gaps have yet to hear of the last displacements.
    BeforeDisplacements,
}

/// Colours, constraints and what solvers keep; memory is kept from step to step.
#[derive(Clone, Debug)]
pub struct Solving<L: Lanes> {
    coloring: Coloring,
    stream: Stream<L>,
    bounces: soft::Bounces<L>,
    avbd: avbd::Avbd<L>,
    /// The graph of contacts is not the one `avbd` was cut for.
    recut: bool,
    /// The substep the impulses of the last step belong to, seconds.
    last_h_secs: f64,
    latest: Latest,
    /// Something may bounce in this step.
    bouncing: bool,
    /// Steps until impulses are summed anew though nothing has changed: what the sums of the warm start per body
    /// round off must not add up.
    until_summed: u32,
}

/// Steps for which a warm start is carried from one to the next.
const CARRIED_STEPS: u32 = 16;

impl<L: Lanes> Default for Solving<L> {
    fn default() -> Self {
        Self {
            coloring: Coloring::default(),
            stream: Stream::default(),
            bounces: soft::Bounces::default(),
            avbd: avbd::Avbd::default(),
            recut: true,
            last_h_secs: 0.0,
            latest: Latest::default(),
            bouncing: false,
            until_summed: 0,
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
        self.recut |= changed;
        if changed {
            self.coloring.run(bodies, &mut narrow.manifolds);
            self.stream.cut(&self.coloring, &narrow.manifolds);
        } else {
            for place in narrow.looked_at() {
                self.stream.touch(place);
            }
        }
        self.stream.begin(&narrow.manifolds, motion.matter.fours());
        self.until_summed = 0;
    }

    /// Forgets what constraints hold: the pairs they belong to are gone.
    pub fn forget(&mut self) {
        (self.latest, self.until_summed) = (Latest::InPairs, 0);
    }

    /// Hands gaps and impulses back to the pairs, before manifolds are found anew.
    pub fn hand_back(&mut self, manifolds: &mut Manifolds<L::Elem>, motion: &Motion<L::Elem>) {
        if self.latest != Latest::InPairs {
            self.stream.end(manifolds, self.yet_to_follow(motion));
            self.latest = Latest::InPairs;
        }
    }

    /// Before the first substep: what bounces is noted, and where the warm start is said.
    pub fn begin(
        &mut self,
        task: &Task<'_, L::Elem>,
        bodies: &Bodies<L::Elem>,
        manifolds: &mut Manifolds<L::Elem>,
        motion: &mut Motion<L::Elem>,
    ) -> Warm {
        let (h, last) = (task.plan.h_secs, std::mem::replace(&mut self.last_h_secs, task.plan.h_secs));
        let bounced = self.bouncing;
        self.bouncing = task.traits.restitution && pushes(task.solver) && motion.swift;
        if self.bouncing {
            self.hand_back(manifolds, motion);
            self.follow_pairs(task, manifolds, motion);
            motion.load::<L>(task.plan, bodies);
            self.bounces.resize(self.stream.batches());
            self.stream.visit(&mut soft::NoteApproach {
                rows: motion.velocity.fours(),
                accelerations: motion.acceleration.fours(),
                threshold: L::lit(task.bounce_threshold()),
                bounces: &mut self.bounces,
            });
        }
        let carries = carries_impulses(task.solver);
        if carries && !bounced && !self.bouncing && self.until_summed > 0 && h == last {
            self.until_summed -= 1;
            return Warm::Carried;
        }
        self.until_summed = CARRIED_STEPS;
        motion.clear_rows();
        if carries {
            let share = if last > 0.0 { h / last } else { 1.0 };
            let rows = motion.velocity.fours_mut();
            self.stream.visit(&mut WarmStart { rows, share: L::Elem::from_f64(share) });
        }
        Warm::Summed
    }

    /// Contacts of one substep, before bodies move.
    pub fn solve(&mut self, task: &Task<'_, L::Elem>, motion: &mut Motion<L::Elem>, first: bool) {
        let Traits { friction, restitution, length, .. } = task.traits;
        let h_secs = task.plan.h_secs;
        let rows = motion.velocity.fours_mut();
        // Constraints that were not prepared anew have yet to hear of the last step's last displacement.
        let moved = (!first || self.latest == Latest::BeforeDisplacements).then_some(motion.moved.fours());
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
            // Bodies move first.
            Solver::Xpbd | Solver::Avbd => {}
            Solver::Impulse => {
                let threshold = L::lit(task.bounce_threshold());
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
    pub fn settle(
        &mut self,
        task: &Task<'_, L::Elem>,
        bodies: &Bodies<L::Elem>,
        manifolds: &mut Manifolds<L::Elem>,
        motion: &mut Motion<L::Elem>,
    ) {
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
            Solver::Avbd => {
                if std::mem::take(&mut self.recut) {
                    self.avbd.cut(bodies, manifolds);
                }
                let pace = avbd::Pace::new(task.plan.h_secs, task.plan.impulse_share(), task.traits.length);
                self.avbd.settle(manifolds, motion, &pace);
            }
            Solver::Xpbd => {
                let h_secs = task.plan.h_secs;
                let cap = xpbd::PUSH_CAP * task.traits.length / f64::from(task.plan.substeps);
                let per_sec = L::lit(1.0 / (h_secs * task.plan.impulse_share()));
                let softness = L::lit(xpbd::COMPLIANCE / (h_secs * h_secs));
                let push_cap = L::lit(-cap);
                let (moved, rows) = (motion.moved.fours_mut(), motion.velocity.fours_mut());
                let settle_per_sec = L::lit(1.0 / h_secs);
                if task.traits.friction {
                    self.stream.visit(&mut xpbd::Project::<L, true> {
                        moved,
                        rows,
                        softness,
                        per_sec,
                        push_cap,
                    });
                    self.stream.visit(&mut xpbd::Settle::<L, true> { moved, rows, per_sec: settle_per_sec });
                } else {
                    self.stream.visit(&mut xpbd::Project::<L, false> {
                        moved,
                        rows,
                        softness,
                        per_sec,
                        push_cap,
                    });
                    self.stream.visit(&mut xpbd::Settle::<L, false> { moved, rows, per_sec: settle_per_sec });
                }
            }
            Solver::Impulse => self.stream.visit(&mut impulse::Correct {
                moved: motion.moved.fours_mut(),
                rows: motion.velocity.fours(),
                slop: L::lit(impulse::SLOP * task.traits.length),
            }),
        }
    }

    /// After the last substep: bounces.
    pub fn end(
        &mut self,
        task: &Task<'_, L::Elem>,
        manifolds: &Manifolds<L::Elem>,
        motion: &mut Motion<L::Elem>,
    ) {
        let settled = matches!(task.solver, Solver::Xpbd | Solver::Avbd);
        if self.bouncing {
            self.follow_pairs(task, manifolds, motion);
            let moved = (!settled).then_some(motion.moved.fours());
            self.stream.visit(&mut soft::Bounce {
                rows: motion.velocity.fours_mut(),
                touch: L::lit(task.traits.touch()),
                moved,
                bounces: &mut self.bounces,
            });
        }
        self.latest = match task.solver {
            Solver::Avbd => Latest::InPairs,
            Solver::Xpbd => Latest::InConstraints,
            Solver::Soft | Solver::Pgs | Solver::Impulse => Latest::BeforeDisplacements,
        };
    }

    /// `avbd` works on the pairs: bounces are noted and given by constraints, which follow.
    fn follow_pairs(
        &mut self,
        task: &Task<'_, L::Elem>,
        manifolds: &Manifolds<L::Elem>,
        motion: &Motion<L::Elem>,
    ) {
        if task.solver == Solver::Avbd {
            for &place in manifolds.touching() {
                self.stream.touch(place);
            }
            self.stream.begin(manifolds, motion.matter.fours());
        }
    }

    /// The manifolds with today's gaps and impulses.
    pub fn brought_up_to_date(
        &self,
        manifolds: &Manifolds<L::Elem>,
        motion: &Motion<L::Elem>,
    ) -> Manifolds<L::Elem> {
        let mut manifolds = manifolds.clone();
        if self.latest != Latest::InPairs {
            self.stream.clone().end(&mut manifolds, self.yet_to_follow(motion));
        }
        manifolds
    }

    /// The displacements that gaps have yet to hear of; none where a settling pass has told them.
    fn yet_to_follow<'a>(&self, motion: &'a Motion<L::Elem>) -> Option<&'a [[L::Elem; 4]]> {
        (self.latest == Latest::BeforeDisplacements).then_some(motion.moved.fours())
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
