//! Who sleeps in a world: what a step leaves out for it, and what wakes.
//!
//! | where in a step | what happens |
//! |---|---|
//! | [`World::rests`], as it begins | ends it if all that can move sleeps; else brings the runs up to date with who is awake |
//! | [`World::regroup`], before pairs are chosen | sorts them into those that are looked at and those that rest |
//! | [`World::wake_touched`], when contacts are found | no contact that is solved has a sleeping end |
//! | [`World::update_sleep`], as it ends | who has been quiet for long enough falls asleep |
//!
//! Contacts of what falls asleep are put down to their pairs' rows before the runs change, and taken up from there when it
//! wakes. Such a step is never a still one, so that new constraints and the warm start are made.

use super::{World, WorldError};
use crate::body::{Bodies, BodyError, BodyId};
use crate::each::Each as _;
use crate::force::Forces;
use crate::island::{Demand, Islands, Pull};
use crate::joint::{Joint, JointKind, Joints};
use crate::lanes::{Lanes, Real};
use crate::scene::SceneError;

/// Steps from one look to the next at islands whose links want them to be quiet for longer.
const LOOK_STEPS: u64 = 16;

impl<L: Lanes> World<L> {
    /// Takes in which bodies there are, and which of them hang together without touching.
    pub(super) fn look_over_islands(&mut self) {
        if self.settings.sleep {
            self.islands.look_over(&self.bodies, self.joints.ends());
        }
    }

    /// Is there nothing to do, because all that can move sleeps? Else brings the runs up to date.
    pub(super) fn rests(&mut self) -> bool {
        if self.islands.is_still(&self.bodies) {
            return true;
        }
        self.follow_islands();
        false
    }

    /// Brings the runs up to date with who is awake.
    fn follow_islands(&mut self) {
        if !self.made.take_awake(self.islands.changes()) {
            return;
        }
        self.solving.catch_up(&self.motion);
        let awake = self.islands.awake_beside_sleepers();
        match awake {
            None => self.motion.go_over_all(&self.bodies),
            Some(awake) => {
                let sleeps = |slots: [u32; 2]| !slots.iter().any(|&slot| awake[slot as usize]);
                self.solving.put_down(&mut self.narrow.manifolds, &self.motion, sleeps);
                self.motion.go_over_awake(&self.bodies, awake, self.islands.asleep());
            }
        }
        self.broad.freeze(&self.bodies, awake);
    }

    /// Sorts the pairs into those that are looked at and those that rest, where that has changed.
    pub(super) fn regroup(&mut self) {
        if !self.made.take_sorted() {
            return;
        }
        let awake = self.islands.awake_beside_sleepers();
        self.narrow.manifolds.regroup(awake);
        self.solving.rename(&mut self.narrow.manifolds, &self.motion);
    }

    /// Wakes what is touched by what is awake, so that no contact of a step has a sleeping end.
    pub(super) fn wake_touched(&mut self) {
        let mut woke = false;
        while !self.islands.is_empty() && self.islands.wake_touched(&self.narrow.manifolds) {
            self.follow_islands();
            self.regroup();
            self.narrow.manifolds.refresh();
            woke = true;
        }
        // What woke has no pairs but those it touches: the next step looks for more, whether anything moves or not.
        if woke {
            self.made.sort_again();
        }
    }

    /// After a step: who has been quiet for long enough falls asleep. `changed`: contacts came or went.
    pub(super) fn update_sleep(&mut self, dt_secs: f64, changed: bool) {
        let Self { laws, bodies, joints, islands, .. } = self;
        let (runs, manifolds) = (&self.motion.runs, &self.narrow.manifolds);
        let gravity = laws.needs.gravity;
        let pull = Pull { gravity, spring: laws.forces.spring.map_or(0.0, |spring| spring.stiffness) };
        let quiet_time = islands.accumulate_quiet_time::<L>(bodies, runs, pull, dt_secs);
        // What a drive holds still now it may move in a moment.
        let again = changed || (islands.waits() && self.log.steps.is_multiple_of(LOOK_STEPS));
        if laws.forces.drive.is_none() && (quiet_time.newly || (quiet_time.some && again)) {
            let substep_secs = dt_secs / f64::from(self.settings.substeps);
            islands.take_demands(demands_of(joints, bodies, substep_secs));
            islands.fall_asleep(bodies, manifolds, runs, !laws.fields.is_empty(), gravity);
        }
        self.log.counts.sleeping = self.islands.sleeping();
        self.log.counts.islands = self.islands.len();
    }

    /// Before the body in a slot is forgotten.
    pub(super) fn wake_what_rested_on(&mut self, slot: usize) {
        self.islands.wake_around(slot, &self.narrow.manifolds);
        // Only its own pairs: what others that sleep rest on has to be known until they wake.
        let is_its = |slots: [u32; 2]| slots.contains(&(slot as u32));
        self.solving.put_down(&mut self.narrow.manifolds, &self.motion, is_its);
        self.narrow.manifolds.forget_slot(slot);
        if let Some((_, removals)) = &mut self.made.bodies {
            *removals += 1;
        }
    }

    /// Sets the constant force and torque on a body, and wakes its island if they are others than before; see
    /// [`Bodies::set_force`](crate::body::Bodies::set_force).
    ///
    /// # Errors
    /// Those of [`Bodies::set_force`](crate::body::Bodies::set_force).
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
        forces.check_coupling(self.bodies.len(), &self.settings)?;
        let in_step = self.laws.forces.attraction.is_some() != forces.attraction.is_some();
        self.laws.forces = forces;
        self.laws.revision += 1;
        if in_step {
            // Bodies that attract each other have one number of substeps, others may have many: nothing of that is kept.
            if let Err(WorldError::Scene(why)) = self.set_settings(self.settings) {
                return Err(why);
            }
        }
        self.look_again();
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
}

/// What joints demand before their bodies may sleep: motors that turn, for ever; springs, a period of theirs.
fn demands_of<R: Real>(
    joints: &Joints<R>,
    bodies: &Bodies<R>,
    substep_secs: f64,
) -> impl Iterator<Item = Demand> {
    joints.living().map(move |(place, joint)| {
        let spring = match &joint.kind {
            JointKind::Distance(distance) => distance.spring,
            JointKind::Weld(weld) => weld.spring,
            JointKind::Revolute(_) => None,
        };
        let period = spring.map_or(0.0, |spring| 1.0 / spring.hertz);
        let drives = drives(joint, joints.held_at(place).drive.to_f64(), substep_secs);
        let ends = joint.bodies.each(BodyId::slot);
        let [a, b] = ends.each(|slot| bodies.place(slot));
        Demand {
            ends: ends.each(|slot| slot as u32),
            quiet_secs: if drives { f64::INFINITY } else { period },
            reach: (b[0] - a[0]).hypot(b[1] - a[1]),
        }
    })
}

/// Is there a motor that turns, or holds against what it could push away? One that gives all its torque is stalled.
fn drives(joint: &Joint, drive: f64, substep_secs: f64) -> bool {
    let JointKind::Revolute(revolute) = &joint.kind else { return false };
    let stalls = |max_torque: f64| drive.abs() >= 0.999 * max_torque * substep_secs;
    revolute.motor.is_some_and(|motor| motor.speed != 0.0 && !stalls(motor.max_torque))
}
