//! Driven bodies: kinematic bodies that go round a pivot.
//!
//! A kinematic body moves straight on within a step. One with a pivot is given, before each step, the
//! velocity of the chord from where it stands to where the circle has it at the step's end: it is on the
//! circle whenever a step ends, however many there were.
//!
//! ```text
//! α ← α + ω·dt                       since the body came into the world, f64, less whole turns
//! v = (p + R(α)·arm − x) / dt        p the pivot, arm = x₀ − p
//! w = ω + sin(R(α)·R₀, R(ω·dt)·R) / dt   the second term takes away what rounding left: no arc tangent needed
//! ```
//!
//! The target comes from the arm the body came with, never from where the last step left it, so that
//! neither radius nor phase drift. All of it is `f64` with the engine's own sine and cosine: the same
//! bits on every target. A velocity written to a driven body by hand does not live to see its next step;
//! from another pose the body comes back in one.

use std::f64::consts::TAU;

use glam::DVec2;

use super::Bodies;
use crate::lanes::Real;
use crate::vec2::{Rot, Vec2};

/// One body's circle. 72 B: nothing here is read but by its own step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Drive {
    slot: usize,
    pivot: Vec2<f64>,
    /// From the pivot to the centroid when the body came, metres.
    arm: Vec2<f64>,
    /// Attitude when the body came.
    rotation: Rot<f64>,
    /// rad/s.
    angular_velocity: f64,
    /// Turned since then, rad, less whole turns.
    turned_rad: f64,
}

impl Drive {
    /// The circle of the body in `slot` round `pivot` (metres), from its pose as it comes.
    pub(crate) fn new(
        slot: usize,
        pivot: DVec2,
        centroid: DVec2,
        attitude: DVec2,
        angular_velocity: f64,
    ) -> Self {
        let arm = centroid - pivot;
        Self {
            slot,
            pivot: Vec2::new(pivot.x, pivot.y),
            arm: Vec2::new(arm.x, arm.y),
            rotation: Rot { c: attitude.x, s: attitude.y },
            angular_velocity,
            turned_rad: 0.0,
        }
    }

    /// Along the tangent, m/s: what the body has before its first step.
    pub(crate) fn velocity(&self) -> [f64; 2] {
        let v = self.arm.turned_by(self.angular_velocity);
        [v.x, v.y]
    }

    fn apply<R: Real>(&mut self, bodies: &mut Bodies<R>, dt_secs: f64) {
        let (at, ahead_rad) = (self.slot, self.angular_velocity * dt_secs);
        self.turned_rad = (self.turned_rad + ahead_rad) % TAU;
        let turn = Rot::from_angle(self.turned_rad);
        let target = self.pivot + turn.apply(self.arm);
        // Rounded like the position: a body that is where it should be gets no velocity at all.
        let [x, y] = bodies.place(at);
        let chord = |target: f64, now: f64| R::from_f64((bodies.rounded(target) - now) / dt_secs);
        [bodies.vx[at], bodies.vy[at]] = [chord(target.x, x), chord(target.y, y)];
        let now = Rot { c: bodies.c[at].to_f64(), s: bodies.s[at].to_f64() };
        let missing = now.then(Rot::from_angle(ahead_rad % TAU)).relative(self.rotation.then(turn));
        bodies.w[at] = R::from_f64(self.angular_velocity + missing.s / dt_secs);
    }
}

/// The circles of all driven bodies of a world.
#[derive(Clone, Debug, Default)]
pub(crate) struct Drives {
    drives: Vec<Drive>,
}

impl Drives {
    /// Does nothing go round a pivot?
    pub(crate) fn is_empty(&self) -> bool {
        self.drives.is_empty()
    }

    /// Takes a body's circle in.
    pub(crate) fn insert(&mut self, drive: Drive) {
        self.drives.push(drive);
    }

    /// Does the body in `slot` go round a pivot?
    pub(crate) fn has(&self, slot: usize) -> bool {
        self.drives.iter().any(|drive| drive.slot == slot)
    }

    /// Forgets the circle of the body in `slot`, if it has one.
    pub(crate) fn remove(&mut self, slot: usize) {
        self.drives.retain(|drive| drive.slot != slot);
    }

    /// Bytes held.
    pub(crate) fn bytes(&self) -> usize {
        self.drives.len() * size_of::<Drive>()
    }

    /// Sets velocities so that a step of `dt_secs` ends on the circles.
    pub(crate) fn apply<R: Real>(&mut self, bodies: &mut Bodies<R>, dt_secs: f64) {
        for drive in &mut self.drives {
            drive.apply(bodies, dt_secs);
        }
    }
}
