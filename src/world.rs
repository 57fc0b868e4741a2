//! A world: bodies, fields, and the step that advances them.

use std::time::Instant;

use crate::body::{Bodies, BodyError, BodyId};
use crate::broad::BroadPhase;
use crate::contact::{Contact, Manifolds};
use crate::force::{Field, Forces};
use crate::integrate::{self, Motion, Plan};
use crate::island::Islands;
use crate::lanes::{Lanes, Real};
use crate::measure::{Counts, Stage, StageTimes, first_non_finite, non_finite_in, state_hash};
use crate::narrow::{Narrow, Stirred};
use crate::scene::{BodyKind, BodySpec, Scene, SceneError};
use crate::settings::{Precision, Settings, SettingsError, Skip};
use crate::solve::{self, Solving, Task, Traits};

/// A step that could not be taken to its end.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum StepError {
    /// A body's state became NaN or infinite; the world holds that state.
    #[error("step {step}: body in slot {slot} is no longer finite: {column} = {value} after {stage}")]
    NonFinite {
        /// The step's number, from 1.
        step: u64,
        /// The body.
        slot: usize,
        /// The column.
        column: &'static str,
        /// What it holds.
        value: f64,
        /// Where it first was so: the integrator or the solver.
        stage: Stage,
    },
    /// Steps have a positive, finite length.
    #[error("dt must be positive and finite, got {0:?}")]
    Dt(f64),
}

/// Why a world could not be built.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum WorldError {
    /// A body or field.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// A setting.
    #[error(transparent)]
    Settings(#[from] SettingsError),
    /// A running world keeps its precision.
    #[error("a world of {have} cannot become one of {asked}")]
    Precision {
        /// What it is built on.
        have: &'static str,
        /// What was asked for.
        asked: Precision,
    },
}

/// Bodies, fields, and the memory a step works in.
#[derive(Clone, Debug)]
pub struct World<L: Lanes> {
    bodies: Bodies<L::Elem>,
    forces: Forces,
    settings: Settings,
    fields: Vec<Field<L::Elem>>,
    traits: Traits,
    /// Revision and removals of the bodies last looked over.
    inspected: Option<(u64, u64)>,
    broad: BroadPhase<L::Elem>,
    narrow: Narrow<L::Elem>,
    solving: Solving<L>,
    motion: Motion<L::Elem>,
    /// Poses may have changed by other hands than a step's: no manifold may be reused.
    disturbed: bool,
    /// Who sleeps; left alone without [`Settings::sleep`].
    islands: Islands<L::Elem>,
    /// Who is awake has changed since pairs were last sorted by it.
    regrouped: bool,
    /// Bodies outside the runs may have other poses than when contacts were last found.
    unposed: bool,
    steps: u64,
    counts: Counts,
    times: StageTimes,
}

impl<L: Lanes> World<L> {
    /// An empty world.
    ///
    /// # Errors
    /// Settings or fields that cannot be run with.
    pub fn new(forces: Forces, settings: Settings) -> Result<Self, WorldError> {
        Self::from_bodies(Bodies::new(), forces, settings)
    }

    /// A world around existing bodies.
    ///
    /// # Errors
    /// Settings or fields that cannot be run with.
    pub fn from_bodies(
        bodies: Bodies<L::Elem>,
        forces: Forces,
        settings: Settings,
    ) -> Result<Self, WorldError> {
        settings.check()?;
        forces.check_in::<L::Elem>().map_err(SceneError::from)?;
        Ok(Self {
            bodies,
            forces,
            settings,
            fields: Vec::new(),
            traits: Traits::default(),
            inspected: None,
            broad: BroadPhase::default(),
            narrow: Narrow::default(),
            solving: Solving::default(),
            motion: Motion::default(),
            disturbed: true,
            islands: Islands::default(),
            regrouped: false,
            unposed: true,
            steps: 0,
            counts: Counts::default(),
            times: StageTimes::default(),
        })
    }

    /// A world with the bodies of a scene, in their order: the k-th is in slot k + 1.
    ///
    /// # Errors
    /// Settings, fields or bodies that cannot be run with.
    pub fn from_scene(scene: &Scene, settings: Settings) -> Result<Self, WorldError> {
        let mut world = Self::new(scene.forces, settings)?;
        for spec in &scene.bodies {
            world.insert(spec).map_err(SceneError::from)?;
        }
        Ok(world)
    }

    /// Advances by `dt_secs`: the whole frame, top to bottom.
    ///
    /// # Errors
    /// A step that is not positive and finite (nothing changes); a state that turned NaN or infinite
    /// (the world keeps it, for inspection).
    pub fn step(&mut self, dt_secs: f64) -> Result<(), StepError> {
        let rounded = L::Elem::from_f64(dt_secs);
        if !(rounded > L::Elem::ZERO && rounded.is_finite()) {
            return Err(StepError::Dt(dt_secs));
        }
        self.inspect();
        self.bodies.drive(dt_secs);
        self.steps += 1;
        if self.settings.sleep && self.rests() {
            return Ok(());
        }
        let mut clock = Instant::now();
        let mut lap = |times: &mut StageTimes, stage| times.lap(stage, &mut clock);
        let Settings { solver, substeps, skips, .. } = self.settings;
        let traits = self.traits.needed(skips);
        let margin = traits.margin(solver);

        let keep = skips.has(Skip::PairList);
        let found = self.broad.find::<L>(&self.bodies, self.settings.broad, margin, keep);
        lap(&mut self.times, Stage::Broad);

        if !found.kept {
            self.narrow.deal(&self.bodies, self.broad.pairs());
            self.regrouped |= !self.islands.is_empty();
        }
        self.regroup();
        let reuse = skips.has(Skip::ManifoldReuse) && !std::mem::take(&mut self.disturbed);
        let stirred = if reuse { Stirred::These(&self.motion.stirred) } else { Stirred::All };
        let looked_at = self.narrow.choose(stirred);
        if looked_at > 0 {
            self.collide(margin);
        }
        let changed = self.narrow.manifolds.refresh();
        if changed {
            self.wake_touched();
        }
        lap(&mut self.times, Stage::Narrow);

        let (fields, moving) = (&self.fields[..], solve::pushes(solver));
        let h_secs = dt_secs / f64::from(substeps);
        let plan = Plan { integrator: self.settings.integrator, fields, h_secs, substeps, skips, moving };
        let none_touch = self.narrow.manifolds.is_empty() && self.islands.is_empty();
        let free_flight = none_touch && skips.has(Skip::FreeFlight);
        let (mut skipped, mut finite) = (integrate::Skipped::default(), true);
        if free_flight {
            self.disturbed = true;
            skipped = integrate::fly::<L>(&plan, &mut self.bodies);
            lap(&mut self.times, Stage::Integrate);
        } else {
            let task = Task { solver, traits, dt_secs, plan: &plan };
            let (bodies, motion, solving) = (&self.bodies, &mut self.motion, &mut self.solving);
            solving.prepare(bodies, &mut self.narrow, changed, motion);
            solving.begin(&task, bodies, motion);
            lap(&mut self.times, Stage::Prepare);
            for substep in 0..substeps {
                let first = substep == 0;
                skipped = integrate::predict::<L>(&plan, bodies, motion, first);
                lap(&mut self.times, Stage::Integrate);
                solving.solve(&task, motion, first);
                lap(&mut self.times, Stage::Solve);
                finite = integrate::advance::<L>(&plan, motion);
                lap(&mut self.times, Stage::Integrate);
                if !finite {
                    // The next round's prediction would hide whether the solver began it.
                    break;
                }
                solving.settle(&task, motion);
                lap(&mut self.times, Stage::Solve);
            }
            solving.end(&task, &mut self.narrow.manifolds, motion);
            lap(&mut self.times, Stage::Solve);
            integrate::finish::<L>(&mut self.bodies, motion);
            lap(&mut self.times, Stage::Integrate);
        }

        let reused = self.narrow.manifolds.pairs() - looked_at;
        self.counts =
            Counts::of(found, reused, &self.narrow.manifolds, free_flight, skipped, &self.bodies, traits);
        self.times.steps += 1;
        self.check_finite(finite)?;
        if self.settings.sleep {
            self.doze(dt_secs, changed);
        }
        lap(&mut self.times, Stage::Measure);
        Ok(())
    }

    /// Polygons' world rows and manifolds, of all bodies or, while some sleep, of those that are awake.
    fn collide(&mut self, margin: L::Elem) {
        let everywhere = 0..self.bodies.len();
        let unposed = std::mem::take(&mut self.unposed);
        if unposed || self.islands.is_empty() {
            self.bodies.refresh_polygons();
            self.narrow.collide::<L>(&self.bodies, margin, std::slice::from_ref(&everywhere));
        } else {
            for run in &self.motion.runs {
                self.bodies.refresh_polygons_in(run.clone());
            }
            self.narrow.collide::<L>(&self.bodies, margin, &self.motion.runs);
        }
    }

    /// Is there nothing to do, because all that can move sleeps? Else brings the runs up to date.
    fn rests(&mut self) -> bool {
        if self.islands.is_still(&self.bodies) {
            self.times.steps += 1;
            return true;
        }
        self.follow_islands();
        false
    }

    /// Brings the runs up to date with who is awake.
    fn follow_islands(&mut self) {
        if !self.islands.take_changed() {
            return;
        }
        if self.islands.is_empty() {
            self.motion.go_over_all(&self.bodies);
        } else {
            self.motion.go_over_awake(&self.bodies, self.islands.awake(), self.islands.asleep());
        }
        (self.regrouped, self.unposed) = (true, true);
    }

    /// Sorts the pairs into those that are looked at and those that rest, where that has changed.
    fn regroup(&mut self) {
        if !std::mem::take(&mut self.regrouped) {
            return;
        }
        if self.islands.is_empty() {
            self.narrow.manifolds.watch_all();
        } else {
            self.narrow.manifolds.watch(self.islands.awake());
        }
    }

    /// Wakes what is touched by what is awake, so that no contact of a step has a sleeping end.
    fn wake_touched(&mut self) {
        while !self.islands.is_empty() && self.islands.wake_touched(&self.narrow.manifolds) {
            self.follow_islands();
            self.regroup();
            self.narrow.manifolds.refresh();
        }
    }

    /// After a step: who has been quiet for long enough falls asleep. `changed`: contacts came or went.
    fn doze(&mut self, dt_secs: f64, changed: bool) {
        let (runs, manifolds) = (&self.motion.runs, &self.narrow.manifolds);
        let tired = self.islands.tire::<L>(&self.bodies, runs, dt_secs, self.traits.gravity);
        if tired.newly || (tired.some && changed) {
            self.islands.settle(&mut self.bodies, manifolds, runs, !self.fields.is_empty());
        }
        self.counts.sleeping = self.islands.sleeping();
        self.counts.islands = self.islands.len();
    }

    /// Looks over the scene when it has changed: which fields, which contact terms it needs.
    fn inspect(&mut self) {
        let seen = (self.bodies.revision(), self.bodies.removals());
        if self.inspected == Some(seen) {
            return;
        }
        if self.inspected.is_none_or(|(_, removals)| removals != seen.1) {
            self.narrow.manifolds.forget();
            self.motion.forget_drift();
        }
        self.inspected = Some(seen);
        self.fields = self.forces.fields();
        if self.bodies.force.is_some() {
            self.fields.insert(0, Field::PerBody);
        }
        let some = |column: &[L::Elem]| column.iter().any(|v| *v > L::Elem::ZERO);
        let [gx, gy] = self.forces.gravity.unwrap_or_default();
        self.traits = Traits {
            friction: some(self.bodies.friction.as_slice()),
            restitution: some(self.bodies.restitution.as_slice()),
            length: self.broad.look_over(&self.bodies),
            gravity: gx.hypot(gy),
        };
        self.motion.resize(&self.bodies);
        if self.settings.sleep {
            self.islands.look_over(&self.bodies);
        }
        self.disturbed = true;
    }

    /// `rounds_finite`: no round of integrating and solving broke off.
    fn check_finite(&self, rounds_finite: bool) -> Result<(), StepError> {
        let found = first_non_finite::<L>(&self.bodies, &self.motion.runs);
        let Some((slot, column, value)) = found else { return Ok(()) };
        let stopped = |slot, column, value, stage| {
            Err(StepError::NonFinite { step: self.steps, slot, column, value, stage })
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

    /// Takes a body in. One that is not dynamic wakes all: it may have come where something sleeps.
    ///
    /// # Errors
    /// Those of [`Bodies::insert`].
    pub fn insert(&mut self, spec: &BodySpec) -> Result<BodyId, BodyError> {
        let id = self.bodies.insert(spec)?;
        if spec.kind != BodyKind::Dynamic {
            self.islands.wake_all();
        }
        Ok(id)
    }

    /// Takes a body out. Its island wakes, and those that rest on it.
    ///
    /// # Errors
    /// An id whose body is gone.
    pub fn remove(&mut self, id: BodyId) -> Result<(), BodyError> {
        self.bodies.remove(id)?;
        if self.settings.sleep {
            self.islands.wake_around(id.slot(), &self.narrow.manifolds);
            // Only its own pairs: what others that sleep rest on has to be known until they wake.
            self.narrow.manifolds.forget_slot(id.slot());
            if let Some((_, removals)) = &mut self.inspected {
                *removals += 1;
            }
        }
        Ok(())
    }

    /// Adds an impulse and wakes the body's island; see [`Bodies::apply_impulse`].
    ///
    /// # Errors
    /// Those of [`Bodies::apply_impulse`].
    pub fn apply_impulse(&mut self, id: BodyId, linear: [f64; 2], angular: f64) -> Result<(), BodyError> {
        self.bodies.apply_impulse(id, linear, angular)?;
        self.islands.wake(id.slot());
        Ok(())
    }

    /// Sets the constant force and torque on a body, and wakes its island if they are others than before; see
    /// [`Bodies::set_force`].
    ///
    /// # Errors
    /// Those of [`Bodies::set_force`].
    pub fn set_force(&mut self, id: BodyId, force: [f64; 2], torque: f64) -> Result<(), BodyError> {
        let before = self.bodies.check_alive(id).map(|slot| self.bodies.force_on(slot))?;
        self.bodies.set_force(id, force, torque)?;
        if self.bodies.force_on(id.slot()) != before {
            self.islands.wake(id.slot());
        }
        Ok(())
    }

    /// Sets the fields and wakes all.
    ///
    /// # Errors
    /// Fields that cannot be run with; nothing has changed then.
    pub fn set_forces(&mut self, forces: Forces) -> Result<(), SceneError> {
        forces.check_in::<L::Elem>()?;
        self.forces = forces;
        self.inspected = self.inspected.map(|(_, removals)| (u64::MAX, removals));
        self.islands.wake_all();
        Ok(())
    }

    /// Wakes the island of a body; see [`crate::island`].
    ///
    /// # Errors
    /// An id whose body is gone.
    pub fn wake(&mut self, id: BodyId) -> Result<(), BodyError> {
        let slot = self.bodies.check_alive(id)?;
        self.islands.wake(slot);
        Ok(())
    }
    /// Does a body sleep? One that is gone does not.
    pub fn is_asleep(&self, id: BodyId) -> bool {
        self.bodies.check_alive(id).is_ok_and(|slot| self.islands.is_asleep(slot))
    }
    /// Bodies that sleep.
    pub fn sleeping(&self) -> usize {
        self.islands.sleeping()
    }
    /// Who sleeps.
    pub fn islands(&self) -> &Islands<L::Elem> {
        &self.islands
    }

    /// The columns.
    pub fn bodies(&self) -> &Bodies<L::Elem> {
        &self.bodies
    }
    /// The columns, to change: poses and velocities directly, forces by [`Bodies::set_force`]. Wakes all.
    pub fn bodies_mut(&mut self) -> &mut Bodies<L::Elem> {
        self.disturbed = true;
        self.islands.wake_all();
        &mut self.bodies
    }
    /// The fields.
    pub fn forces(&self) -> &Forces {
        &self.forces
    }
    /// The settings.
    pub fn settings(&self) -> &Settings {
        &self.settings
    }
    /// The contacts the last step found at its beginning.
    pub fn manifolds(&self) -> &Manifolds<L::Elem> {
        &self.narrow.manifolds
    }
    /// Those contacts, spelled out, with those of sleeping bodies.
    pub fn contacts(&self) -> Vec<Contact> {
        self.manifolds().contacts()
    }
    /// Colours and constraints of the last step.
    pub fn solving(&self) -> &Solving<L> {
        &self.solving
    }
    /// Steps taken.
    pub fn steps(&self) -> u64 {
        self.steps
    }
    /// What the last step counted.
    pub fn counts(&self) -> &Counts {
        &self.counts
    }
    /// Time per stage since the last [`World::reset_times`].
    pub fn times(&self) -> &StageTimes {
        &self.times
    }
    /// Sets the stage times to zero.
    pub fn reset_times(&mut self) {
        self.times = StageTimes::default();
    }
    /// xxh3 over pose and velocity of all living bodies; see [`state_hash`].
    pub fn hash(&self) -> u64 {
        state_hash(&self.bodies)
    }
    /// The candidate pairs of the last step: slots a < b, in order.
    pub fn pairs(&self) -> &[[u32; 2]] {
        self.broad.pairs()
    }
}
