//! What a case is: a scene, how it is run, and the numbers it must come out with.

use lamina2d::force::Forces;
use lamina2d::joint::JointSpec;
use lamina2d::scene::named::scene;
use lamina2d::scene::{BodySpec, Scene, ShapeSpec};
use lamina2d::settings::Solver;
use serde::Serialize;

/// Standard gravity, m/s².
pub(super) const G: f64 = 9.81;
/// Steps per second of every case, unless it says otherwise.
pub(super) const RATE: f64 = 60.0;

/// A number of a body.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Column {
    /// Metres.
    X,
    /// Metres.
    Y,
    /// Attitude, rad, −π to π.
    Angle,
    /// m/s.
    Vx,
    /// m/s.
    Vy,
    /// rad/s.
    W,
}

/// What is looked at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum What {
    /// A number of a body after a step.
    Body {
        /// Its number in the scene.
        body: usize,
        /// Which number.
        column: Column,
        /// After how many steps.
        step: u64,
    },
    /// Kinetic energy at every step: the farthest from what is right, J.
    KineticAlways,
    /// Kinetic energy at the end, J.
    Kinetic,
    /// Momentum at the end, N·s: along x or y.
    Momentum(usize),
    /// Angular momentum about the origin at the end, N·m·s.
    AngularMomentum,
    /// Bodies that sleep at the end.
    Asleep,
    /// Is the scene refused before its first step? 1 if so.
    Refused,
}

/// How a number must be to what is expected.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Sense {
    /// Within the tolerance of it.
    #[default]
    Near,
    /// Not above it by more than the tolerance.
    AtMost,
    /// Not below it by more than the tolerance.
    AtLeast,
}

/// A number and what it must be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Expect {
    /// Which number.
    pub what: What,
    /// What it must be.
    pub expected: f64,
    /// How far it may be off.
    pub tolerance: f64,
    /// In which direction.
    pub sense: Sense,
}

impl Expect {
    /// A number that must be near another.
    pub(super) const fn near(what: What, expected: f64, tolerance: f64) -> Self {
        Self { what, expected, tolerance, sense: Sense::Near }
    }
    /// A number that must not be above another.
    pub(super) const fn at_most(what: What, expected: f64) -> Self {
        Self { what, expected, tolerance: 0.0, sense: Sense::AtMost }
    }
    /// A number that must not be below another.
    pub(super) const fn at_least(what: What, expected: f64) -> Self {
        Self { what, expected, tolerance: 0.0, sense: Sense::AtLeast }
    }
    /// Does what was found do?
    pub fn is_met(&self, found: f64) -> bool {
        let off = found - self.expected;
        match self.sense {
            Sense::Near => off.abs() <= self.tolerance,
            Sense::AtMost => off <= self.tolerance,
            Sense::AtLeast => -off <= self.tolerance,
        }
    }
}

/// A scene that must come out right.
#[derive(Clone, Debug)]
pub struct Case {
    /// What it is called.
    pub name: String,
    /// The kind of report.
    pub kind: &'static str,
    /// What is run, for as many steps as it says.
    pub scene: Scene,
    /// May bodies fall asleep?
    pub sleep: bool,
    /// With this solver of ours; the default where it does not matter.
    pub solver: Option<Solver>,
    /// The numbers.
    pub expects: Vec<Expect>,
}

impl Case {
    /// Bodies under gravity for so many seconds.
    pub(super) fn new(name: String, bodies: Vec<BodySpec>, secs: f64) -> Self {
        let steps = (secs * RATE).round().max(1.0) as u64;
        let scene = Scene { name: name.clone(), ..scene("", bodies, Forces::gravity(), steps) };
        Self { name, kind: "", scene, sleep: false, solver: None, expects: Vec::new() }
    }

    /// The same under other fields.
    pub(super) fn under(mut self, forces: Forces) -> Self {
        self.scene.forces = forces;
        self
    }
    /// The same without gravity.
    pub(super) fn weightless(self) -> Self {
        self.under(Forces::default())
    }
    /// The same with joints.
    pub(super) fn joined(mut self, joints: Vec<JointSpec>) -> Self {
        self.scene.joints = joints;
        self
    }
    /// The same, where bodies may fall asleep.
    pub(super) fn sleepy(mut self) -> Self {
        self.sleep = true;
        self
    }
    /// The same with a number that must be near another.
    pub(super) fn expect(mut self, what: What, expected: f64, tolerance: f64) -> Self {
        self.expects.push(Expect::near(what, expected, tolerance));
        self
    }
    /// The same with a number of a body at the end.
    pub(super) fn end(self, body: usize, column: Column, expected: f64, tolerance: f64) -> Self {
        let step = self.scene.steps;
        self.expect(What::Body { body, column, step }, expected, tolerance)
    }
    /// The same with a condition.
    pub(super) fn holds(mut self, expect: Expect) -> Self {
        self.expects.push(expect);
        self
    }
    /// What a number of a body at the end is.
    pub(super) fn last(&self, body: usize, column: Column) -> What {
        What::Body { body, column, step: self.scene.steps }
    }
}

/// A disc of a radius, metres.
pub(super) fn disc(radius: f64, position: [f64; 2]) -> BodySpec {
    BodySpec::new(ShapeSpec::Circle(radius), position)
}

/// A box of half-extents, metres.
pub(super) fn rectangle(half: [f64; 2], position: [f64; 2]) -> BodySpec {
    BodySpec::new(ShapeSpec::Box(half), position)
}

/// A static floor whose top is at y = 0, so far to both sides.
pub(super) fn floor(half_width: f64) -> BodySpec {
    rectangle([half_width, 0.5], [0.0, -0.5]).fixed()
}
