//! What a step looks over when bodies, joints or fields are others than before.

use super::World;
use crate::force::Field;
use crate::lanes::{Lanes, Real};
use crate::solve::SceneNeeds;

impl<L: Lanes> World<L> {
    /// The next step looks over the scene: bodies or fields may be others, though none came or went.
    pub(super) fn look_again(&mut self) {
        self.made.bodies = self.made.bodies.map(|(_, removals)| (u64::MAX, removals));
    }

    /// Looks over the scene when it has changed: which fields, which contact terms it needs.
    pub(super) fn inspect(&mut self) {
        let seen = (self.bodies.revision(), self.bodies.removals());
        let removed = self.made.bodies.is_none_or(|(_, removals)| removals != seen.1);
        if removed && !self.joints.is_empty() {
            self.joints.prune(&self.bodies);
        }
        if self.made.joints != self.joints.revision() {
            self.made.joints = self.joints.revision();
            self.broad.keep_apart(self.joints.apart());
            self.look_over_islands();
            self.made.forget_poses();
            self.motion.assume_fast_bodies();
        }
        if self.made.pushes != self.bodies.pushes() {
            self.made.pushes = self.bodies.pushes();
            self.log.watchdog.forget();
            self.motion.assume_fast_bodies();
            self.solving.look_at_loads();
        }
        if self.made.bodies == Some(seen) {
            return;
        }
        if removed {
            self.narrow.manifolds.forget();
            self.solving.forget();
            self.motion.forget_drift();
        }
        self.made.bodies = Some(seen);
        self.broad.forget();
        self.log.watchdog.forget();
        self.solving.freshen(!removed);
        self.laws.fields = self.laws.forces.fields();
        if self.bodies.force.is_some() {
            self.laws.fields.insert(0, Field::PerBody);
        }
        self.laws.stiff.look_over(&self.bodies, &self.laws.forces, &self.laws.fields);
        let some = |column: &[L::Elem]| column.iter().any(|v| *v > L::Elem::ZERO);
        self.broad.look_over(&self.bodies);
        let [gx, gy] = self.laws.forces.gravity.unwrap_or_default();
        self.laws.needs = SceneNeeds {
            friction: some(self.bodies.friction.as_slice()),
            restitution: some(self.bodies.restitution.as_slice()),
            gravity: gx.hypot(gy),
        };
        self.motion.resize(&self.bodies);
        self.motion.assume_fast_bodies();
        self.narrow.look_over(&self.bodies);
        self.continuous.look_over(&self.bodies);
        self.look_over_islands();
        self.made.forget_poses();
    }
}
