//! A world: bodies, joints, fields, and the step that advances them.

use std::time::Instant;

use crate::body::{Bodies, BodyError, BodyId};
use crate::broad::BroadPhase;
use crate::contact::{Contact, Manifolds};
use crate::force::{Field, Forces};
use crate::integrate::{self, Motion, Plan};
use crate::joint::{JointError, JointId, JointKind, Joints};
use crate::lanes::{Lanes, Real};
use crate::measure::{Counts, Stage, StageTimes, first_non_finite, non_finite_in, state_hash};
use crate::narrow::{Narrow, Stirred};
use crate::scene::{BodySpec, Scene, SceneError};
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

/// Bodies, joints, fields, and the memory a step works in.
#[derive(Clone, Debug)]
pub struct World<L: Lanes> {
    bodies: Bodies<L::Elem>,
    joints: Joints<L::Elem>,
    forces: Forces,
    settings: Settings,
    fields: Vec<Field<L::Elem>>,
    traits: Traits,
    /// Revision and removals of the bodies last looked over.
    inspected: Option<(u64, u64)>,
    /// Revision of the joints last looked over.
    inspected_joints: u64,
    broad: BroadPhase<L::Elem>,
    narrow: Narrow<L::Elem>,
    solving: Solving<L>,
    motion: Motion<L::Elem>,
    /// Poses may have changed by other hands than a step's: no manifold may be reused.
    disturbed: bool,
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
        Self::from_parts(bodies, Joints::default(), forces, settings)
    }

    /// A world around existing bodies and the joints between them; those of which a body is gone go with the first
    /// step.
    ///
    /// # Errors
    /// Settings or fields that cannot be run with.
    pub fn from_parts(
        bodies: Bodies<L::Elem>,
        joints: Joints<L::Elem>,
        forces: Forces,
        settings: Settings,
    ) -> Result<Self, WorldError> {
        settings.check()?;
        forces.check_in::<L::Elem>().map_err(SceneError::from)?;
        Ok(Self {
            bodies,
            joints,
            forces,
            settings,
            fields: Vec::new(),
            traits: Traits::default(),
            inspected: None,
            inspected_joints: 0,
            broad: BroadPhase::default(),
            narrow: Narrow::default(),
            solving: Solving::default(),
            motion: Motion::default(),
            disturbed: true,
            steps: 0,
            counts: Counts::default(),
            times: StageTimes::default(),
        })
    }

    /// A world with the bodies and joints of a scene, in their order: the k-th body is in slot k + 1.
    ///
    /// # Errors
    /// Settings, fields, bodies or joints that cannot be run with.
    pub fn from_scene(scene: &Scene, settings: Settings) -> Result<Self, WorldError> {
        let mut world = Self::new(scene.forces, settings)?;
        let insert = |spec| world.insert(spec).map_err(SceneError::from);
        let ids: Vec<_> = scene.bodies.iter().map(insert).collect::<Result<_, _>>()?;
        for (joint, spec) in scene.joints.iter().enumerate() {
            let id = |body: usize| {
                let missing = JointError::MissingBody { joint, body, bodies: ids.len() };
                ids.get(body).copied().ok_or(SceneError::from(missing))
            };
            let ends = [id(spec.bodies[0])?, id(spec.bodies[1])?];
            world.insert_joint(ends, spec.kind.clone(), spec.collide).map_err(SceneError::from)?;
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
        }
        let reuse = skips.has(Skip::ManifoldReuse) && !std::mem::take(&mut self.disturbed);
        let stirred = if reuse { Stirred::These(&self.motion.stirred) } else { Stirred::All };
        let looked_at = self.narrow.choose(stirred);
        if looked_at > 0 {
            self.bodies.refresh_polygons();
            self.narrow.collide::<L>(&self.bodies, margin);
        }
        let changed = self.narrow.manifolds.refresh();
        lap(&mut self.times, Stage::Narrow);

        let (fields, moving) = (&self.fields[..], solve::pushes(solver));
        let h_secs = dt_secs / f64::from(substeps);
        let plan = Plan { integrator: self.settings.integrator, fields, h_secs, substeps, skips, moving };
        let loose = self.narrow.manifolds.is_empty() && self.joints.is_empty();
        let free_flight = loose && skips.has(Skip::FreeFlight);
        let (mut skipped, mut finite) = (integrate::Skipped::default(), true);
        if free_flight {
            self.disturbed = true;
            skipped = integrate::fly::<L>(&plan, &mut self.bodies);
            lap(&mut self.times, Stage::Integrate);
        } else {
            let task = Task { solver, traits, dt_secs, plan: &plan };
            let (bodies, motion, solving) = (&self.bodies, &mut self.motion, &mut self.solving);
            solving.prepare(bodies, &mut self.narrow, changed, motion);
            solving.prepare_joints(&task, bodies, &self.joints);
            solving.begin(&task, bodies, motion);
            lap(&mut self.times, Stage::Prepare);
            for substep in 0..substeps {
                let first = substep == 0;
                skipped = integrate::predict::<L>(&plan, bodies, motion, first);
                lap(&mut self.times, Stage::Integrate);
                solving.solve(&task, motion, first);
                lap(&mut self.times, Stage::Solve);
                finite = integrate::advance::<L>(&plan, bodies, motion);
                lap(&mut self.times, Stage::Integrate);
                if !finite {
                    // The next round's prediction would hide whether the solver began it.
                    break;
                }
                solving.settle(&task, motion);
                lap(&mut self.times, Stage::Solve);
            }
            solving.end(&task, &mut self.narrow.manifolds, motion);
            solving.end_joints(&mut self.joints);
            lap(&mut self.times, Stage::Solve);
            integrate::finish::<L>(&mut self.bodies, motion);
            lap(&mut self.times, Stage::Integrate);
        }

        let reused = self.narrow.manifolds.pairs() - looked_at;
        self.counts = Counts::of(
            found,
            reused,
            &self.narrow.manifolds,
            free_flight,
            skipped,
            &self.bodies,
            self.traits,
            skips,
        );
        self.times.steps += 1;
        self.check_finite(finite)?;
        lap(&mut self.times, Stage::Measure);
        Ok(())
    }

    /// Looks over the scene when it has changed: which fields, which contact terms it needs.
    fn inspect(&mut self) {
        let seen = (self.bodies.revision(), self.bodies.removals());
        let removed = self.inspected.is_none_or(|(_, removals)| removals != seen.1);
        if removed && !self.joints.is_empty() {
            self.joints.prune(&self.bodies);
        }
        if self.inspected_joints != self.joints.revision() {
            self.inspected_joints = self.joints.revision();
            self.broad.keep_apart(self.joints.apart());
        }
        if self.inspected == Some(seen) {
            return;
        }
        if removed {
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
        self.disturbed = true;
    }

    /// `rounds_finite`: no round of integrating and solving broke off.
    fn check_finite(&self, rounds_finite: bool) -> Result<(), StepError> {
        let Some((slot, column, value)) = first_non_finite::<L>(&self.bodies) else { return Ok(()) };
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

    /// Takes a body in.
    ///
    /// # Errors
    /// Those of [`Bodies::insert`].
    pub fn insert(&mut self, spec: &BodySpec) -> Result<BodyId, BodyError> {
        self.bodies.insert(spec)
    }

    /// Takes a body out, and the joints it has.
    ///
    /// # Errors
    /// An id whose body is gone.
    pub fn remove(&mut self, id: BodyId) -> Result<(), BodyError> {
        self.bodies.remove(id)?;
        self.joints.prune(&self.bodies);
        Ok(())
    }

    /// Joins bodies A and B as they stand; unless they `collide`, they pass through each other from now on.
    ///
    /// # Errors
    /// Those of [`Joints::insert`].
    pub fn insert_joint(
        &mut self,
        bodies: [BodyId; 2],
        kind: JointKind,
        collide: bool,
    ) -> Result<JointId, JointError> {
        self.joints.insert(&self.bodies, bodies, kind, collide)
    }

    /// Takes a joint out.
    ///
    /// # Errors
    /// An id whose joint is gone.
    pub fn remove_joint(&mut self, id: JointId) -> Result<(), JointError> {
        self.joints.remove(id)
    }

    /// Adds an impulse; see [`Bodies::apply_impulse`].
    ///
    /// # Errors
    /// Those of [`Bodies::apply_impulse`].
    pub fn apply_impulse(&mut self, id: BodyId, linear: [f64; 2], angular: f64) -> Result<(), BodyError> {
        self.bodies.apply_impulse(id, linear, angular)
    }

    /// The columns.
    pub fn bodies(&self) -> &Bodies<L::Elem> {
        &self.bodies
    }
    /// The columns, to change: poses and velocities directly, forces by [`Bodies::set_force`].
    pub fn bodies_mut(&mut self) -> &mut Bodies<L::Elem> {
        self.disturbed = true;
        &mut self.bodies
    }
    /// The joints.
    pub fn joints(&self) -> &Joints<L::Elem> {
        &self.joints
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
    /// Those contacts, spelled out.
    pub fn contacts(&self) -> Vec<Contact> {
        (0..self.manifolds().len()).map(|k| self.manifolds().contact(k)).collect()
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
