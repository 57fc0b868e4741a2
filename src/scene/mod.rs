//! Scenes: what is simulated, in `f64` and without an engine.
//!
//! One description serves every engine (ours, the thesis baseline, later the peers), the benches, the
//! tests, the program and the viewer. [`mixes`] and [`named`] build them by name and seed,
//! [`file`](mod@file) reads them from TOML. Scenes with a reference beside them, the cases of accuracy and stability, are
//! the laboratory's (package `lamina`, room `cases`); it finds its own by the same [`by_name_in`].

pub mod basics;
pub mod driven;
pub mod file;
pub mod jointed;
pub mod mixes;
pub mod named;
pub mod similar;
pub mod stacks;
mod takes;

use std::path::Path;

use serde::{Deserialize, Serialize};

pub use crate::body::{BodyKind, BodySpec, ShapeSpec};
use crate::event::{SceneEvent, When};
use crate::force::Forces;
use crate::joint::JointSpec;
pub use named::{SCENES, SceneInfo, by_name, by_name_in};
pub use takes::Takes;

use crate::settings::Settings;

/// What is simulated: bodies in order, the joints between them, and the fields they move in.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Scene {
    /// Its name, with its parameter: `circles`, `stack/10`.
    pub name: String,
    /// What it shows, in a sentence.
    pub about: String,
    /// The bodies, in the order of their ids.
    pub bodies: Vec<BodySpec>,
    /// The joints, in the order of their ids.
    pub joints: Vec<JointSpec>,
    /// The fields.
    pub forces: Forces,
    /// What it does to itself on its way.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub events: Vec<SceneEvent>,
    /// The step it is meant to run with, seconds.
    pub dt_secs: f64,
    /// The steps that show what it is about.
    pub steps: u64,
    /// What its random numbers came from; 0 where it has none.
    pub seed: u64,
}

impl Scene {
    /// The same scene with its events at times, so that steps of another length do them as late.
    #[must_use]
    pub fn timed(&self) -> Self {
        let timed =
            |event: &SceneEvent| SceneEvent { at: When::Time(event.secs(self.dt_secs)), ..event.clone() };
        Self { events: self.events.iter().map(timed).collect(), ..self.clone() }
    }

    /// Bodies that are not static.
    pub fn movable(&self) -> usize {
        self.bodies.iter().filter(|b| b.kind != BodyKind::Static).count()
    }
}

/// The scene that `given` names, with the settings it asks for: a path that ends in `.toml`, or a name, see
/// [`by_name`].
///
/// # Errors
/// Those of [`by_name`] and [`file::read`]; a number of bodies for a file, which has the bodies it lists.
pub fn load(given: &str, bodies: Option<usize>, seed: u64) -> Result<(Scene, Settings), SceneError> {
    load_in(SCENES, given, bodies, seed)
}

/// As [`load`], with the scenes of another table.
///
/// # Errors
/// Those of [`load`].
pub fn load_in(
    scenes: &[SceneInfo],
    given: &str,
    bodies: Option<usize>,
    seed: u64,
) -> Result<(Scene, Settings), SceneError> {
    let is_file = Path::new(given).extension().is_some_and(|e| e.eq_ignore_ascii_case("toml"));
    match bodies {
        None if is_file => file::read(given),
        Some(_) if is_file => Err(SceneError::BodiesOfFile(given.to_owned())),
        _ => {
            let scene = by_name_in(scenes, given, bodies, seed)?;
            let settings = Settings { dt_secs: scene.dt_secs, ..Settings::default() };
            Ok((scene, settings))
        }
    }
}

/// Why a scene was refused: the item, the field, the value.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SceneError {
    /// No such name.
    #[error("unknown scene '{name}': one of {choices}, or the path of a .toml file")]
    UnknownScene {
        /// What was asked for.
        name: String,
        /// The names.
        choices: String,
    },
    /// The part after the slash is not what the scene takes.
    #[error("scene '{scene}' takes {takes} after the slash, got '{given}'")]
    Parameter {
        /// The scene.
        scene: String,
        /// What it takes.
        takes: &'static str,
        /// What was given.
        given: String,
    },
    /// The number of bodies cannot be set, or not to this.
    #[error("scene '{scene}': bodies {problem}, got {given}")]
    Bodies {
        /// The scene.
        scene: String,
        /// What is wrong.
        problem: &'static str,
        /// What was given.
        given: usize,
    },
    /// The number of bodies of a file cannot be set.
    #[error("--bodies: a scene file has the bodies it lists: {0}")]
    BodiesOfFile(String),
    /// A file could not be read.
    #[error("cannot read scene file {path}: {why}")]
    Unreadable {
        /// Its path.
        path: String,
        /// The system's reason.
        why: String,
    },
    /// A file is not a scene.
    #[error("scene file {path}: {why}")]
    Syntax {
        /// Its path.
        path: String,
        /// Where and why.
        why: String,
    },
    /// A field's coefficients are bad.
    #[error(transparent)]
    Force(#[from] crate::force::ForceError),
    /// A body is bad.
    #[error(transparent)]
    Body(#[from] crate::body::BodyError),
    /// A joint is bad.
    #[error(transparent)]
    Joint(#[from] crate::joint::JointError),
    /// What the scene does to itself cannot be done.
    #[error("event {event}: {why}")]
    Event {
        /// Its number, from 0.
        event: usize,
        /// What is wrong.
        why: String,
    },
    /// A setting in a file is bad.
    #[error("scene file {path}: {why}")]
    Setting {
        /// Its path.
        path: String,
        /// Field and value.
        why: String,
    },
}
