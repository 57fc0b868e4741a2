//! A world between steps: bodies and joints come and go, and everything it holds can be looked at.

use super::{Log, World, WorldError};
use crate::body::{Bodies, BodyError, BodyId};
use crate::contact::{Contact, Manifolds};
use crate::force::{Forces, MOST_ATTRACTED};
use crate::joint::{JointError, JointId, JointKind, Joints, Motor};
use crate::lanes::{Lanes, Real};
use crate::measure::{Counts, StageTimes, state_hash};
use crate::scene::{BodyKind, BodySpec, SceneError};
use crate::settings::{Broad, Precision, Settings};
use crate::solve::Solving;

impl<L: Lanes> World<L> {
    /// Takes a body in. One that is not dynamic wakes all: it may have come where something sleeps.
    ///
    /// # Errors
    /// Those of [`Bodies::insert`]; more bodies than may attract each other where they do.
    pub fn insert(&mut self, spec: &BodySpec) -> Result<BodyId, BodyError> {
        let body = self.bodies.live();
        if self.laws.forces.attraction.is_some() && body >= MOST_ATTRACTED {
            return Err(BodyError::Attracted { body, most: MOST_ATTRACTED });
        }
        let id = self.bodies.insert(spec)?;
        if spec.kind != BodyKind::Dynamic {
            self.islands.wake_all();
        }
        Ok(id)
    }

    /// Takes a body out, and the joints it has. Its island wakes, and those that rest on it.
    ///
    /// # Errors
    /// An id whose body is gone.
    pub fn remove(&mut self, id: BodyId) -> Result<(), BodyError> {
        self.bodies.remove(id)?;
        if self.settings.sleep {
            self.wake_what_rested_on(id.slot());
        }
        self.joints.prune(&self.bodies);
        Ok(())
    }

    /// Makes a body static, kinematic or dynamic and wakes all; see [`Bodies::set_kind`]. Joints between bodies of which
    /// none is dynamic hold nothing until one is.
    ///
    /// # Errors
    /// Those of [`Bodies::set_kind`].
    pub fn set_kind(&mut self, id: BodyId, kind: BodyKind, mass: Option<f64>) -> Result<(), BodyError> {
        self.bodies.set_kind(id, kind, mass)?;
        self.islands.wake_all();
        Ok(())
    }

    /// Goes on with other settings. Impulses that contacts and joints carried are forgotten, steps and times are not; with another
    /// number of threads nothing is.
    ///
    /// # Errors
    /// Settings that cannot be run with, or of another precision or lane width.
    pub fn set_settings(&mut self, settings: Settings) -> Result<(), WorldError> {
        settings.check()?;
        let have = <L::Elem as Real>::NAME;
        if settings.precision != Precision::of::<L::Elem>() {
            return Err(WorldError::Precision { have, asked: settings.precision });
        }
        if settings.lanes != L::WIDTH {
            return Err(WorldError::Lanes { have: L::WIDTH, asked: settings.lanes });
        }
        self.laws.forces.check_coupling(self.bodies.len(), &settings).map_err(SceneError::from)?;
        let with_threads = Settings { threads: settings.threads, ..self.settings };
        if settings == with_threads && settings != self.settings {
            // Threads change no bit, nor does it who does the work from now on.
            self.settings = settings;
            return Ok(());
        }
        let bodies = std::mem::take(&mut self.bodies);
        let joints = std::mem::take(&mut self.joints).without_impulses();
        let (revision, Log { steps, time_secs, stopwatch, .. }) = (self.laws.revision, self.log.clone());
        let acts = std::mem::take(&mut self.laws.acts);
        *self = Self::from_parts(bodies, joints, self.laws.forces, settings)?;
        (self.laws.revision, self.laws.acts) = (revision, acts);
        self.log = Log { steps, time_secs, stopwatch, ..Log::default() };
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

    /// Adds an impulse and wakes the body's island; see [`Bodies::apply_impulse`].
    ///
    /// # Errors
    /// Those of [`Bodies::apply_impulse`].
    pub fn apply_impulse(&mut self, id: BodyId, linear: [f64; 2], angular: f64) -> Result<(), BodyError> {
        self.motion.assume_fast_bodies();
        self.log.watchdog.forget();
        self.bodies.apply_impulse(id, linear, angular)?;
        self.islands.wake(id.slot());
        Ok(())
    }

    /// Puts a body elsewhere and wakes all; see [`Bodies::set_pose`].
    ///
    /// # Errors
    /// Those of [`Bodies::set_pose`].
    pub fn set_pose(
        &mut self,
        id: BodyId,
        position: Option<[f64; 2]>,
        angle: Option<f64>,
    ) -> Result<(), BodyError> {
        self.bodies.set_pose(id, position, angle)?;
        self.islands.wake_all();
        Ok(())
    }

    /// Gives a body another velocity and wakes its island, or all where it is kinematic; see [`Bodies::set_velocity`].
    ///
    /// # Errors
    /// Those of [`Bodies::set_velocity`].
    pub fn set_velocity(
        &mut self,
        id: BodyId,
        velocity: Option<[f64; 2]>,
        angular_velocity: Option<f64>,
    ) -> Result<(), BodyError> {
        self.bodies.set_velocity(id, velocity, angular_velocity)?;
        self.motion.assume_fast_bodies();
        self.log.watchdog.forget();
        if self.bodies.kind(id.slot()) == BodyKind::Dynamic {
            self.islands.wake(id.slot());
        } else {
            self.look_again();
            self.islands.wake_all();
        }
        Ok(())
    }

    /// Lets the motor of the hinge in a place run otherwise and wakes its bodies; see [`Joints::set_motor`].
    ///
    /// # Errors
    /// Those of [`Joints::set_motor`].
    pub fn set_motor(&mut self, joint: u32, motor: Motor) -> Result<(), JointError> {
        self.joints.set_motor(joint, motor)?;
        for id in self.joints.at(joint).map(|joint| joint.bodies).into_iter().flatten() {
            self.islands.wake(id.slot());
        }
        Ok(())
    }

    /// The columns.
    pub fn bodies(&self) -> &Bodies<L::Elem> {
        &self.bodies
    }
    /// The columns, to change: any of them directly, forces by [`Bodies::set_force`]. Wakes all; the next step looks over
    /// all bodies, so that masses, surfaces and what the scene needs are those that were written.
    pub fn bodies_mut(&mut self) -> &mut Bodies<L::Elem> {
        self.look_again();
        self.islands.wake_all();
        &mut self.bodies
    }
    /// The joints.
    pub fn joints(&self) -> &Joints<L::Elem> {
        &self.joints
    }
    /// The fields.
    pub fn forces(&self) -> &Forces {
        &self.laws.forces
    }
    /// Seconds since the world began.
    pub fn time_secs(&self) -> f64 {
        self.log.time_secs
    }
    /// The settings.
    pub fn settings(&self) -> &Settings {
        &self.settings
    }
    /// The contacts the last step found at its beginning; gaps and impulses are those of the last time manifolds
    /// were found anew, see [`World::contacts`].
    pub fn manifolds(&self) -> &Manifolds<L::Elem> {
        &self.narrow.manifolds
    }
    /// Those contacts, spelled out, with the gaps and impulses of the step's end; those of sleeping bodies too.
    pub fn contacts(&self) -> Vec<Contact> {
        self.solving.brought_up_to_date(self.manifolds(), &self.motion).contacts()
    }
    /// Colours and constraints of the last step.
    pub fn solving(&self) -> &Solving<L> {
        &self.solving
    }
    /// Steps taken.
    pub fn steps(&self) -> u64 {
        self.log.steps
    }
    /// What the last step counted.
    pub fn counts(&self) -> &Counts {
        &self.log.counts
    }
    /// Time per stage since the last [`World::reset_times`]: of every step, or of every sixteenth of a world of fewer than
    /// 64 bodies, which would wait for the clock longer than for some of its stages.
    pub fn times(&self) -> &StageTimes {
        self.log.stopwatch.times()
    }
    /// Sets the stage times to zero; the next step is timed.
    pub fn reset_times(&mut self) {
        self.log.stopwatch.reset();
    }
    /// From now on every step is timed, whatever the number of bodies: for recordings.
    pub fn time_every_step(&mut self) {
        self.log.stopwatch.time_every_step();
    }
    /// xxh3 over pose and velocity of all living bodies; see [`state_hash`].
    pub fn hash(&self) -> u64 {
        state_hash(&self.bodies)
    }
    /// The candidate pairs of the last step, of which one body at least is awake: slots a < b, in order.
    pub fn pairs(&self) -> &[[u32; 2]] {
        self.broad.pairs()
    }
    /// The method that found the last list of candidate pairs; before there is one, what `auto` stands for with so many bodies.
    pub fn broad_in_use(&self) -> Broad {
        self.broad.in_use(self.settings.broad, self.bodies.live())
    }
}
