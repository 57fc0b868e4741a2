//! What can be done to a world between two steps: by whoever holds it, or by events of its scene.
//!
//! An action holds concrete numbers only. What one does depends on nothing but them and the world's state, which is the
//! same at every lane width. Settings, sessions and scene files speak of the same ones.

use serde::{Deserialize, Serialize};

use crate::body::{BodyKind, BodySpec};
use crate::force::Forces;
use crate::pair;
use crate::settings::{Integrator, Solver};

/// Something done to a world between two steps. Bodies are named by their slots, joints by their places.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Action {
    /// A body comes.
    Insert(Box<BodySpec>),
    /// A body goes, and its joints with it.
    Remove {
        /// The body.
        slot: u32,
    },
    /// A body becomes static, kinematic or dynamic.
    #[serde(alias = "kind")]
    Change {
        /// The body.
        slot: u32,
        /// What it becomes.
        kind: BodyKind,
        /// Kilograms; its area times 1 kg/m² where left out.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        mass: Option<f64>,
    },
    /// A body is elsewhere all at once; what it touched is found anew.
    Teleport {
        /// The body.
        slot: u32,
        /// Where its centroid is, metres; where it was if left out.
        #[serde(default, skip_serializing_if = "Option::is_none", deserialize_with = "pair::optional")]
        position: Option<[f64; 2]>,
        /// Its attitude, rad; as it was if left out.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        angle: Option<f64>,
    },
    /// A kinematic or dynamic body gets another velocity.
    #[serde(alias = "set_velocity")]
    Velocity {
        /// The body.
        slot: u32,
        /// m/s; as it was if left out.
        #[serde(default, skip_serializing_if = "Option::is_none", deserialize_with = "pair::optional")]
        velocity: Option<[f64; 2]>,
        /// rad/s; as it was if left out.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        angular_velocity: Option<f64>,
    },
    /// A dynamic body takes an impulse at its centroid.
    Impulse {
        /// The body.
        slot: u32,
        /// N·s.
        #[serde(default, deserialize_with = "pair::required")]
        linear: [f64; 2],
        /// N·m·s.
        #[serde(default)]
        angular: f64,
    },
    /// A body has another constant force and torque from here on.
    #[serde(alias = "set_force")]
    Force {
        /// The body.
        slot: u32,
        /// At the centroid, N.
        #[serde(default, deserialize_with = "pair::required")]
        force: [f64; 2],
        /// N·m.
        #[serde(default)]
        torque: f64,
    },
    /// A hinge's motor runs otherwise from here on; without torque it has none.
    #[serde(alias = "set_motor")]
    Motor {
        /// The joint.
        joint: u32,
        /// Of B against A, rad/s, counter-clockwise.
        speed: f64,
        /// N·m.
        max_torque: f64,
    },
    /// A dynamic body is pulled until [`Action::LetGo`], or until another is.
    Pull {
        /// The body.
        slot: u32,
        /// Where it is held, metres from its centroid in its own axes.
        #[serde(deserialize_with = "pair::required")]
        point_body: [f64; 2],
        /// Where that point is to be, metres.
        #[serde(deserialize_with = "pair::required")]
        target: [f64; 2],
    },
    /// What is pulled is let go.
    LetGo,
    /// Other methods from here on; a bound on the sag goes with the solver that knows one.
    Choose {
        /// Smooth motion.
        integrator: Integrator,
        /// Contacts.
        solver: Solver,
        /// Rounds per step.
        substeps: u32,
    },
    /// Other fields from here on: all of them.
    #[serde(alias = "field")]
    Fields(Box<Forces>),
}

impl Action {
    /// Its name in files.
    pub const fn name(&self) -> &'static str {
        match self {
            Self::Insert(_) => "insert",
            Self::Remove { .. } => "remove",
            Self::Change { .. } => "change",
            Self::Teleport { .. } => "teleport",
            Self::Velocity { .. } => "velocity",
            Self::Impulse { .. } => "impulse",
            Self::Force { .. } => "force",
            Self::Motor { .. } => "motor",
            Self::Pull { .. } => "pull",
            Self::LetGo => "let_go",
            Self::Choose { .. } => "choose",
            Self::Fields(_) => "fields",
        }
    }

    /// The slot of the body it is done to.
    pub fn slot_mut(&mut self) -> Option<&mut u32> {
        match self {
            Self::Remove { slot }
            | Self::Change { slot, .. }
            | Self::Teleport { slot, .. }
            | Self::Velocity { slot, .. }
            | Self::Impulse { slot, .. }
            | Self::Force { slot, .. }
            | Self::Pull { slot, .. } => Some(slot),
            Self::Insert(_) | Self::Motor { .. } | Self::LetGo | Self::Choose { .. } | Self::Fields(_) => {
                None
            }
        }
    }
}

/// An action and when it was done.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Event {
    /// After this step, before the next one.
    pub step: u64,
    /// What was done.
    pub action: Action,
}

/// When something is done.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum When {
    /// After so many steps, before the next one.
    Step(u64),
    /// Before the first step that begins then or later, seconds.
    Time(f64),
}

/// What a scene does to itself. Bodies are named as if no slot were filled twice: the k-th of the scene is in slot k + 1,
/// and those that events insert follow in the order of their coming.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SceneEvent {
    /// When.
    pub at: When,
    /// What.
    pub action: Action,
}

impl SceneEvent {
    /// Is it done before the step of `dt_secs` that begins after `steps` steps, at `time_secs`?
    pub fn is_due(&self, steps: u64, time_secs: f64, dt_secs: f64) -> bool {
        match self.at {
            When::Step(step) => step <= steps,
            // Times are sums of steps: a thousandth of one is far more than they are off by.
            When::Time(secs) => secs <= time_secs + 1e-3 * dt_secs,
        }
    }

    /// Sorts by when they are done, by steps of `dt_secs`; those of one moment stay in order.
    pub(crate) fn sort(numbered: &mut [(usize, Self)], dt_secs: f64) {
        numbered.sort_by(|(_, a), (_, b)| a.secs(dt_secs).total_cmp(&b.secs(dt_secs)));
    }

    /// Seconds, by steps of `dt_secs`.
    pub fn secs(&self, dt_secs: f64) -> f64 {
        match self.at {
            When::Step(step) => step as f64 * dt_secs,
            When::Time(secs) => secs,
        }
    }
}
