//! A world: bodies, joints, fields, and the step that advances them.

mod access;
mod act;
mod error;
mod inspect;
mod made_from;
mod make;
mod sleep;
mod snapshot;
mod watchdog;

use crate::body::Bodies;
use crate::broad::{BroadCounts, BroadPhase};
use crate::continuous::{Around, Continuous};
use crate::each::Each as _;
use crate::force::{Field, Forces};
use crate::integrate::{self, Stiff};
use crate::island::Islands;
use crate::joint::Joints;
use crate::lanes::{Lanes, Real};
use crate::measure::{Counts, Stage, Stopwatch, first_non_finite, non_finite_in};
use crate::motion::{Motion, Near, Plan, Skipped, Warm};
use crate::narrow::{MovedBodies, Narrow, Stride};
use crate::settings::{Settings, Skip, StiffFields};
use crate::solve::substep_group::Goal;
use crate::solve::{self, SceneNeeds, SolverContext, Solving};
use crate::workers::Workers;

use made_from::MadeFrom;
use watchdog::Watchdog;

pub use act::{ActionError, Acts, Pull};
pub use error::{StepError, WorldError};
pub use snapshot::{BodyEntry, BodyTable, COLUMNS, Snapshot};
pub use watchdog::EVERY as WATCHED_EVERY;

/// What a step found before bodies move.
struct Seen {
    found: BroadCounts,
    /// Nothing has moved since manifolds were found.
    still: bool,
    /// Pairs.
    looked_at: usize,
    /// The graph of contacts is another than before.
    changed: bool,
}

/// What acts on bodies.
#[derive(Clone, Debug)]
struct Laws<R: Real> {
    forces: Forces,
    /// The same, as integrators take them.
    fields: Vec<Field<R>>,
    /// Bodies for which those are too much in a substep.
    stiff: Stiff<R>,
    needs: SceneNeeds,
    /// How often other fields were set.
    revision: u64,
    acts: Acts,
}

/// What a world has gone through.
#[derive(Clone, Debug, Default)]
struct Log {
    steps: u64,
    /// Since the world began, seconds.
    time_secs: f64,
    counts: Counts,
    stopwatch: Stopwatch,
    watchdog: Watchdog,
}

/// Bodies, joints, fields, and the memory a step works in.
#[derive(Clone, Debug)]
pub struct World<L: Lanes> {
    bodies: Bodies<L::Elem>,
    joints: Joints<L::Elem>,
    settings: Settings,
    laws: Laws<L::Elem>,
    broad: BroadPhase<L::Elem>,
    narrow: Narrow<L::Elem>,
    solving: Solving<L>,
    motion: Motion<L::Elem>,
    continuous: Continuous<L::Elem>,
    /// Who sleeps; left alone without [`Settings::sleep`].
    islands: Islands<L::Elem>,
    made: MadeFrom,
    log: Log,
}

impl<L: Lanes> World<L> {
    /// Advances by `dt_secs`, which is the step of its settings from then on: the whole frame, top to bottom.
    ///
    /// # Errors
    /// A step that is not positive and finite (nothing changes); an event of the scene that cannot be done; a state that turned NaN or infinite
    /// (the world keeps it, for inspection).
    pub fn step(&mut self, dt_secs: f64) -> Result<(), StepError> {
        let rounded = self.take_dt(dt_secs)?;
        self.act_before(dt_secs)?;
        self.inspect();
        self.begin_watch();
        self.bodies.drive(dt_secs);
        self.log.steps += 1;
        let begun_secs = self.log.time_secs;
        self.log.time_secs += dt_secs;
        if self.settings.sleep && self.rests() {
            self.log.stopwatch.count(self.bodies.live());
            return Ok(());
        }
        self.log.stopwatch.begin(self.bodies.live());
        let workers = self.motion.workers.of(self.settings.threads, self.bodies.live());
        let Settings { integrator, solver, substeps, skips, .. } = self.settings;
        let needs = self.laws.needs.needed(skips);

        let mut fields = std::mem::take(&mut self.laws.fields);
        for field in &mut fields {
            field.begin(begun_secs);
        }
        let plan = Plan {
            integrator,
            fields: &fields,
            h_secs: dt_secs / f64::from(substeps),
            since_secs: 0.0,
            substeps,
            skips,
            moving: solve::pushes(solver),
            carries: solve::carries_impulses(solver),
            workers: &workers,
        };
        let stiffness = self.settings.contact_stiffness();
        let context = SolverContext { solver, needs, dt_secs, stiffness, plan: &plan };
        let goal = Goal::of(&context, &self.settings, &self.laws.forces);
        let goal = goal.map(|goal| (goal, self.solving.look(&goal, (&self.bodies, &fields), &self.joints)));
        let seen = self.find_contacts(&workers, needs, rounded);
        let none_touch = self.narrow.manifolds.is_empty() && self.islands.is_empty();
        let may_fly = none_touch && self.joints.is_empty() && skips.has(Skip::FreeFlight);
        let exact = self.settings.stiff_fields != Some(StiffFields::Scheme);
        let lengths = [plan.h_secs, dt_secs];
        let stiff = exact && self.laws.stiff.begin(integrator, &self.bodies, begun_secs, lengths);
        let free_flight = may_fly && !stiff && !self.solving.is_paced(substeps);
        let (skipped, finite) = if free_flight {
            self.solving.fly(goal.is_some_and(|(_, looked)| looked));
            self.made.forget_poses();
            self.motion.assume_fast_bodies();
            let fast = self.continuous.begin(self.settings.continuous, self.broad.pairs().len());
            (integrate::fly::<L>(&plan, &mut self.bodies, fast), true)
        } else {
            let moved = self.move_in_contact(&context, goal, &seen);
            let fast = self.continuous.begin(self.settings.continuous, self.broad.pairs().len());
            integrate::finish::<L>(&workers, &mut self.bodies, &mut self.motion, fast, context.speeds());
            moved
        };
        self.laws.fields = fields;
        self.stop_fast(needs.margin(solver), dt_secs);
        self.log.stopwatch.lap(Stage::Integrate);

        self.count(&seen, skipped, needs, free_flight);
        self.check_finite(finite)?;
        self.watch(free_flight)?;
        if self.settings.sleep {
            self.update_sleep(dt_secs, seen.changed);
        }
        self.log.stopwatch.lap(Stage::Measure);
        Ok(())
    }

    /// Takes a step's length for that of the settings; as the scalar has it.
    fn take_dt(&mut self, dt_secs: f64) -> Result<L::Elem, StepError> {
        let rounded = L::Elem::from_f64(dt_secs);
        if !(rounded > L::Elem::ZERO && rounded.is_finite()) {
            return Err(StepError::Dt(dt_secs));
        }
        let least = self.settings.precision.shortest_step_secs();
        if dt_secs < least {
            return Err(StepError::ShortDt { given: dt_secs, least });
        }
        self.settings.dt_secs = dt_secs;
        Ok(rounded)
    }

    /// Counts what the step did.
    fn count(&mut self, seen: &Seen, mut skipped: Skipped, needs: SceneNeeds, free_flight: bool) {
        let manifolds = &self.narrow.manifolds;
        skipped.manifolds = (manifolds.pairs() - seen.looked_at) as u64;
        let mut counts = Counts::of(seen.found, manifolds, free_flight, skipped, &self.bodies, needs);
        let substep_groups = self.solving.substep_groups().span().filter(|_| !free_flight);
        counts.direct_joints = self.solving.direct_joints();
        counts.direct_contacts = if free_flight { 0 } else { self.solving.direct_contacts() };
        counts.substeps = substep_groups.unwrap_or([self.settings.substeps; 2]);
        counts.stiff = skipped.stiff as usize;
        self.log.counts = counts;
    }

    /// Fast bodies meet what is in their way.
    fn stop_fast(&mut self, margin: L::Elem, dt_secs: f64) {
        let around = Around {
            margin,
            dt_secs,
            gravity: self.laws.forces.gravity.unwrap_or_default(),
            // Without a margin they reach no further than bodies do now.
            pairs: if margin > L::Elem::ZERO { self.broad.pairs() } else { &[] },
            apart: self.broad.kept_apart(),
            seams: self.narrow.seams(),
        };
        let joined = self.joints.ends();
        self.continuous.stop(&mut self.bodies, &around, joined, &mut self.motion.has_moved);
        for slot in self.continuous.met() {
            self.motion.outlook.any_has_moved = true;
            self.islands.wake(slot);
        }
    }

    /// Brings pairs and their manifolds up to date, as far as something has moved.
    fn find_contacts(&mut self, workers: &Workers, needs: SceneNeeds, dt_secs: L::Elem) -> Seen {
        let Settings { solver, skips, broad, .. } = self.settings;
        let margin = needs.margin(solver);
        let near = Near { metres: L::Elem::ZERO, share: margin };
        let reach = Near { metres: self.bodies.grain(), share: margin };
        let keep = skips.has(Skip::PairList);
        let ahead_secs = if self.motion.outlook.needs_speculative_margin && margin > L::Elem::ZERO {
            dt_secs
        } else {
            L::Elem::ZERO
        };
        let found = self.broad.find::<L>(workers, &self.bodies, broad, reach, ahead_secs, keep);
        self.log.stopwatch.lap(Stage::Broad);

        let reuse = self.made.poses_are_its_own() && skips.has(Skip::ManifoldReuse);
        let still = reuse && !self.motion.outlook.any_has_moved && self.made.is_sorted();
        let mut seen = Seen { found, still, looked_at: 0, changed: false };
        if !still {
            self.regroup();
            // A new list can wait until something moves: what was too far apart for a contact still is.
            if self.made.take_list(self.broad.lists()) {
                self.narrow.rebuild(&self.bodies, self.broad.pairs());
                self.solving.rename(&mut self.narrow.manifolds, &self.motion);
            }
            let has_moved = if reuse { MovedBodies::These(&self.motion.has_moved) } else { MovedBodies::All };
            seen.looked_at = self.narrow.choose(self.bodies.len(), has_moved);
            match self.narrow.wanted() {
                Some(slots) => self.bodies.refresh_polygons_in(slots),
                None => self.bodies.share_polygons((workers, &self.motion.parts)),
            }
            let [gx, gy] = self.laws.forces.gravity.unwrap_or_default().each(L::Elem::from_f64);
            let fallen = [gx, gy].each(|pull| pull * dt_secs * dt_secs);
            let stride = Stride { secs: dt_secs, fallen };
            self.narrow.collide::<L>((workers, &self.motion.parts), &self.bodies, near, ahead_secs, stride);
            self.solving.follow(&mut self.narrow.manifolds, &self.motion);
            seen.changed = self.narrow.manifolds.refresh();
            if seen.changed {
                self.wake_touched();
            }
        }
        self.log.stopwatch.lap(Stage::Narrow);
        seen
    }

    /// The substeps of a step with contacts; false if one broke off at a state that is not finite.
    fn move_in_contact(
        &mut self,
        context: &SolverContext<'_, L::Elem>,
        goal: Option<(Goal, bool)>,
        seen: &Seen,
    ) -> (Skipped, bool) {
        let (bodies, motion, solving) = (&self.bodies, &mut self.motion, &mut self.solving);
        let awake = (self.islands.awake_beside_sleepers(), self.made.awake());
        // How many substeps joints take depends on who hangs on them.
        solving.make_joints(context, bodies, &self.joints, awake);
        let repaced = goal.is_some_and(|goal| {
            solving.decide_substep_groups(goal, bodies, &mut self.narrow.manifolds, &self.joints, motion)
        });
        let parts_changed = (repaced || !seen.still)
            && solving.divide(context.plan.workers.count(), bodies, &mut self.narrow.manifolds, motion);
        if repaced || !seen.still {
            // Where nothing has moved no pair was looked at: the lists are those of an earlier step.
            let (manifolds, looked_at) = self.narrow.found();
            let looked_at = looked_at.filter(|_| !seen.still);
            solving.prepare(
                bodies,
                (manifolds, looked_at),
                seen.changed || repaced || parts_changed,
                (context.plan.workers, motion),
            );
            solving.note_depth(|| self.narrow.deepest(bodies));
        }
        solving.prepare_joints(context, bodies, &self.joints, awake);
        let warm = solving.begin(context, bodies, &self.narrow.manifolds, motion);
        self.log.stopwatch.lap(Stage::Prepare);
        let (mut skipped, mut finite) = (Skipped::default(), true);
        for substep_group in 0..self.solving.substep_groups().count() {
            if finite {
                self.solving.enter_group(substep_group, &mut self.motion);
                (skipped, finite) = self.substeps(context, substep_group, warm);
                self.solving.leave_group(substep_group, &mut self.motion);
            }
        }
        let (motion, solving) = (&mut self.motion, &mut self.solving);
        solving.end(context, &mut self.narrow.manifolds, motion);
        solving.end_joints(&mut self.joints);
        self.log.stopwatch.lap(Stage::Solve);
        (skipped, finite)
    }

    /// The substeps of one substep group; false if they broke off at a state that is not finite.
    fn substeps(
        &mut self,
        context: &SolverContext<'_, L::Elem>,
        substep_group: usize,
        mut warm: Warm,
    ) -> (Skipped, bool) {
        let (bodies, motion, solving) = (&self.bodies, &mut self.motion, &mut self.solving);
        let substeps = solving.substep_groups().substeps(substep_group).unwrap_or(context.plan.substeps);
        let plan = Plan { substeps, h_secs: context.dt_secs / f64::from(substeps), ..*context.plan };
        let context = &SolverContext { plan: &plan, ..*context };
        let mut skipped = Skipped::default();
        for substep in 0..substeps {
            let plan = Plan { since_secs: plan.h_secs * f64::from(substep), ..plan };
            let skipped_before = skipped;
            let stiff = self.laws.stiff.note(&plan, bodies, motion, warm) as u64;
            skipped = integrate::predict::<L>(&plan, bodies, motion, warm);
            self.laws.stiff.correct(&plan, bodies, motion);
            skipped.stiff = stiff.max(skipped_before.stiff);
            warm = Warm::Onward;
            self.log.stopwatch.lap(Stage::Integrate);
            solving.solve(context, motion, substep == 0);
            self.log.stopwatch.lap(Stage::Solve);
            let finite = integrate::advance::<L>(&plan, motion);
            self.log.stopwatch.lap(Stage::Integrate);
            if !finite {
                // The next round's prediction would hide whether the solver began it.
                return (skipped, false);
            }
            solving.relax(context, bodies, &mut self.narrow.manifolds, motion);
            self.log.stopwatch.lap(Stage::Solve);
        }
        (skipped, true)
    }

    /// `rounds_finite`: no round of integrating and solving broke off.
    fn check_finite(&self, rounds_finite: bool) -> Result<(), StepError> {
        let found = first_non_finite::<L>(&self.bodies, &self.motion.runs);
        let Some((slot, column, value)) = found else { return Ok(()) };
        let stopped = |slot, column, value, stage| {
            Err(StepError::NonFinite { step: self.log.steps, slot, column, value, stage })
        };
        if rounds_finite {
            // Poses overflow where they are added up, or by what a solver moved bodies apart by.
            let solved = self.motion.moved.padded().iter().any(|moved| !moved.is_finite());
            return stopped(slot, column, value, if solved { Stage::Solve } else { Stage::Integrate });
        }
        // A contact spreads what is not finite: it began where already the prediction was not.
        let origin = self.bodies.slots().find(|&slot| !self.motion.predicted_finite(slot));
        match origin.and_then(|slot| Some((slot, non_finite_in(&self.bodies, slot)?))) {
            Some((slot, (column, value))) => stopped(slot, column, value, Stage::Integrate),
            None => stopped(slot, column, value, Stage::Solve),
        }
    }
}
