//! The baseline: the engine of the thesis this project starts from, rebuilt to be measured against.
//!
//! Circles, boxes and convex polygons; every pair tested in every step; one contact point, resolved where
//! it is found. Written from what the thesis's text, result sheets and published sources state as facts;
//! no line of its code is here. Its defects are kept because they are part of what is measured, and each
//! is a test (`src/tests/thesis.rs`).
//!
//! [`Version::Faithful`] keeps the original's memory layout and repeated work. [`Version::Tidy`] is the same
//! algorithm with the obvious waste removed, so that no speed-up is won from a straw man.
//!
//! | stage | reads | writes |
//! |---|---|---|
//! | advance | state, force | state, corners (tidy: and normals) |
//! | bounding test | positions, radii | – |
//! | narrow test | positions, corners (tidy: and normals) | a contact on the stack |
//! | resolve | both states, the contact | both states, corners |
//!
//! Deliberately absent: caching, sleeping, islands, any memory of a contact, any second pass.
//!
//! Inside, units are pixels with y down and 25 px to the metre; every reader below gives metres with y up,
//! about the scene's own origin.

mod build;
mod faithful;
mod narrow;
mod resolve;
mod rigid;
mod sweep;
mod tidy;

use glam::{DVec2, Vec2};
use xxhash_rust::xxh3::Xxh3;

pub use build::ThesisError;
pub use rigid::ThesisIntegrator;

use build::{Blueprint, blueprints, gravity_px, m_from_px};
use faithful::FaithfulBodies;
use lamina2d::scene::Scene;
use rigid::Rigid;
use sweep::{Layout, Rules, Tally, step};
use tidy::TidyBodies;

/// The step of the thesis's experiments, seconds.
pub const THESIS_DT_SECS: f32 = 0.0167;

/// Which layout the same algorithm runs on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Version {
    /// The original's: boxes of boxes, virtual calls, repeated work.
    Faithful,
    /// Flat vectors, an enum of shapes, nothing computed twice.
    Tidy,
}

impl Version {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Faithful, Self::Tidy];
}

#[derive(Debug)]
enum Bodies {
    Faithful(FaithfulBodies),
    Tidy(TidyBodies),
}

/// The outline of a body in its own frame; readers only.
#[derive(Debug)]
struct Outline {
    radius_px: f32,
    corners_px: Vec<Vec2>,
}

/// A scene in the thesis's engine.
#[derive(Debug)]
pub struct ThesisWorld {
    bodies: Bodies,
    outlines: Vec<Outline>,
    rules: Rules,
    tally: Tally,
}

impl ThesisWorld {
    /// Takes a scene; `broad` switches the bounding test on.
    ///
    /// Outlines stay about the body's position as they are given, without recentring, and a scene's velocity
    /// is the velocity of that point: for this engine it is the centre of mass. Mass is density × area where
    /// none is given.
    ///
    /// # Errors
    /// Kinematic bodies, joints, fields other than gravity, constant loads, collision categories; shapes and numbers
    /// that no engine can take.
    pub fn new(
        scene: &Scene,
        integrator: ThesisIntegrator,
        version: Version,
        broad: bool,
    ) -> Result<Self, ThesisError> {
        let rules = Rules { integrator, gravity_px: gravity_px(&scene.forces)?, broad };
        let blueprints = blueprints(scene)?;
        let bodies = match version {
            Version::Faithful => Bodies::Faithful(FaithfulBodies::new(&blueprints)),
            Version::Tidy => Bodies::Tidy(TidyBodies::new(&blueprints)),
        };
        let outline =
            |Blueprint { radius_px, local_px, .. }: Blueprint| Outline { radius_px, corners_px: local_px };
        let outlines = blueprints.into_iter().map(outline).collect();
        Ok(Self { bodies, outlines, rules, tally: Tally::default() })
    }

    /// One step of `dt_secs` seconds; the thesis's is [`THESIS_DT_SECS`].
    pub fn step(&mut self, dt_secs: f32) {
        self.tally = match &mut self.bodies {
            Bodies::Faithful(bodies) => step(bodies, self.rules, dt_secs),
            Bodies::Tidy(bodies) => step(bodies, self.rules, dt_secs),
        };
    }

    /// Bodies, static ones included.
    pub fn len(&self) -> usize {
        self.outlines.len()
    }

    /// Is there nothing in it?
    pub fn is_empty(&self) -> bool {
        self.outlines.is_empty()
    }

    /// Where the bodies' origins are, metres, y up, in the scene's order.
    pub fn positions_m(&self) -> Vec<[f64; 2]> {
        self.rigids().map(|body| m_from_px(body.position_px)).collect()
    }

    /// Attitudes, rad, counter-clockwise, in (−2π, 2π) for what has moved.
    pub fn angles_rad(&self) -> Vec<f64> {
        self.rigids().map(|body| -f64::from(body.rotation)).collect()
    }

    /// Velocities of the bodies' origins, m/s, y up.
    pub fn velocities_m_per_s(&self) -> Vec<[f64; 2]> {
        self.rigids().map(|body| m_from_px(body.velocity_px)).collect()
    }

    /// Angular velocities, rad/s, counter-clockwise.
    pub fn angular_velocities_rad_per_s(&self) -> Vec<f64> {
        self.rigids().map(|body| -f64::from(body.spin)).collect()
    }

    /// Contacts resolved in the last step; those of two static bodies are not.
    pub fn contacts(&self) -> usize {
        self.tally.contacts
    }

    /// Pairs of the last step whose bounding circles touched; with the bounding test off, also every other
    /// pair with a box or polygon in it.
    pub fn candidates(&self) -> usize {
        self.tally.candidates
    }

    /// Does the engine take the body for static? True also of every mass from 2000 kg.
    ///
    /// # Panics
    /// Where there is no such body.
    pub fn is_static(&self, body: usize) -> bool {
        self.rigid(body).is_static()
    }

    /// The outline of a box or polygon as it lies in the world, metres, counter-clockwise; empty for a circle.
    ///
    /// Turned in `f64`, so that a penetration measured on it is the engine's and not the reader's.
    ///
    /// # Panics
    /// Where there is no such body.
    pub fn outline_m(&self, body: usize) -> Vec<[f64; 2]> {
        let (rigid, corners) = (self.rigid(body), &self.outlines[body].corners_px);
        let [x, y] = m_from_px(rigid.position_px);
        let turn = DVec2::from_angle(-f64::from(rigid.rotation));
        let mut outline: Vec<[f64; 2]> =
            corners.iter().map(|&c| (DVec2::new(x, y) + turn.rotate(m_from_px(c).into())).into()).collect();
        // An outline whose angle grows in window pixels runs clockwise once y points up.
        if build::signed_area(corners) > 0.0 {
            outline.reverse();
        }
        outline
    }

    /// The radius of a circle, or of the bounding circle about the body's origin, metres.
    ///
    /// # Panics
    /// Where there is no such body.
    pub fn radius_m(&self, body: usize) -> f64 {
        f64::from(self.outlines[body].radius_px) / lamina2d::scene::mixes::PX_PER_M
    }

    /// XXH3 over the bits of position, rotation, velocity and angular velocity, in the scene's order.
    pub fn hash(&self) -> u64 {
        let mut hash = Xxh3::new();
        for Rigid { position_px: p, rotation, velocity_px: v, spin, .. } in self.rigids() {
            for value in [p.x, p.y, *rotation, v.x, v.y, *spin] {
                hash.update(&value.to_bits().to_le_bytes());
            }
        }
        hash.digest()
    }

    fn rigid(&self, body: usize) -> &Rigid {
        match &self.bodies {
            Bodies::Faithful(bodies) => bodies.rigid(body),
            Bodies::Tidy(bodies) => bodies.rigid(body),
        }
    }

    fn rigids(&self) -> impl Iterator<Item = &Rigid> {
        (0..self.len()).map(|body| self.rigid(body))
    }
}
