//! Scene files: TOML in, a [`Scene`] and settings out; unknown keys are refused.
//!
//! Metres, kilograms, seconds, radians, y up. Keys of `[settings]`: those of [`Settings`], as it is written down, and `steps`:
//! ```
//! let text = r#"
//! about = "a box and a triangle on a slope, with some wind"
//!
//! [settings]
//! steps = 300
//! integrator = "velocity_verlet"
//!
//! [forces]
//! gravity = [0.0, -9.81]
//! wind = [2.0, 0.0]
//! linear_drag = 0.1
//!
//! [[body]]
//! kind = "static"
//! shape = { box = [10.0, 0.5] }
//! position = [0.0, -0.5]
//! angle = 0.2
//!
//! [[body]]
//! shape = { box = [0.5, 0.5] }
//! position = [0.0, 1.5]
//! density = 2.0
//! friction = 0.6
//!
//! [[body]]
//! shape = { polygon = [[-0.5, -0.4], [0.5, -0.4], [0.0, 0.6]] }
//! position = [2.0, 3.0]
//! mass = 1.0
//! restitution = 0.3
//! velocity = [-1.0, 0.0]
//!
//! [[joint]]                                # bodies by their number, from 0; anchors in the world
//! bodies = [1, 2]
//! kind = { distance = { spring = { hertz = 2.0, damping = 0.3 }, max = 4.0 } }
//! ## kind = { revolute = { anchor = [0, 1], motor = { speed = 2, max_torque = 5 }, limits = { lower = -1, upper = 1 } } }
//! ## kind = { weld = { anchor = [0, 1] } }
//! ## collide = true                         # else the two pass through each other
//!
//! [[event]]                                # at a step, or at a time in seconds; one action each
//! time = 2.0
//! insert = { shape = { circle = 0.3 }, position = [0, 5] }   # the next number: 3
//!
//! [[event]]
//! step = 240
//! velocity = { body = 3, velocity = [0, -8] }
//! "#;
//! let (scene, settings) = lamina2d::scene::file::parse("slope.toml", text)?;
//! assert_eq!((scene.bodies.len(), scene.joints.len(), scene.events.len()), (3, 1, 2));
//! # Ok::<(), lamina2d::scene::SceneError>(())
//! ```
//!
//! # Events
//! What is done before the first step that begins after `step` steps of the file's own length, or at `time` or later; those due
//! at once are done by their times, then in the order of the file. Bodies go by their numbers, from 0; those that come count on. All are tried before the first step.
//!
//! | action | fields |
//! |---|---|
//! | `insert` | those of `[[body]]` |
//! | `remove` | `body` |
//! | `teleport` | `body`, `position` of its centroid, `angle`; what is left out stays |
//! | `velocity` (`set_velocity`) | `body`, `velocity`, `angular_velocity`; what is left out stays |
//! | `impulse` | `body`, `linear`, `angular` |
//! | `force` (`set_force`) | `body`, `force`, `torque`: constant from then on |
//! | `motor` (`set_motor`) | `joint` by its number, `speed`, `max_torque`; 0 takes the motor off |
//! | `kind` (`change`) | `body`, `kind`, `mass` |
//! | `field` (`fields`) | those of `[forces]`, in place of all there were |
//! | `pull`, `let_go = true` | `body`, `point_body`, `target` |
//! | `choose` | `integrator`, `solver`, `substeps` |

mod events;

use serde::Deserialize;

use super::{BodySpec, Scene, SceneError};
use crate::force::Forces;
use crate::joint::JointSpec;
use crate::settings::{Broad, Integrator, Precision, Settings, Skips, Solver, StiffFields, Threads};

/// The keys of a scene file.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    #[serde(default)]
    about: String,
    #[serde(default)]
    settings: FileSettings,
    #[serde(default)]
    forces: Forces,
    #[serde(default)]
    body: Vec<BodySpec>,
    #[serde(default)]
    joint: Vec<JointSpec>,
    #[serde(default)]
    event: Vec<toml::Table>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
struct FileSettings {
    dt: Option<f64>,
    steps: Option<u64>,
    integrator: Option<Integrator>,
    solver: Option<Solver>,
    substeps: Option<u32>,
    broad: Option<Broad>,
    lanes: Option<usize>,
    precision: Option<Precision>,
    threads: Option<Threads>,
    skip: Option<String>,
    continuous: Option<bool>,
    sleep: Option<bool>,
    max_sag: Option<f64>,
    fixed_substeps: Option<bool>,
    stiff_fields: Option<StiffFields>,
    stiffness: Option<f64>,
    positions: Option<Precision>,
    max_speed: Option<f64>,
    max_gain: Option<f64>,
}

/// Reads a scene file and the settings it asks for (defaults elsewhere).
///
/// # Errors
/// A file that cannot be read, is not TOML, has unknown keys or values of the wrong type, a bad field or
/// setting, an event that cannot be read; bodies, joints and what events do are checked when a world takes them in.
pub fn read(path: &str) -> Result<(Scene, Settings), SceneError> {
    let text = std::fs::read_to_string(path)
        .map_err(|e| SceneError::Unreadable { path: path.to_owned(), why: e.to_string() })?;
    parse(path, &text)
}

/// Like [`read`], from text; `path` names it in errors.
///
/// # Errors
/// Those of [`read`].
pub fn parse(path: &str, text: &str) -> Result<(Scene, Settings), SceneError> {
    let syntax = |why: String| SceneError::Syntax { path: path.to_owned(), why };
    let file: File = toml::from_str(text).map_err(|e| syntax(e.to_string().trim_end().to_owned()))?;
    file.forces.check()?;
    let setting = |why: String| SceneError::Setting { path: path.to_owned(), why };
    let (asked, default) = (file.settings, Settings::default());
    let precision = asked.precision.unwrap_or(default.precision);
    let skips = asked.skip.map_or(Ok(default.skips), |s| s.parse::<Skips>());
    let settings = Settings {
        dt_secs: asked.dt.unwrap_or(default.dt_secs),
        integrator: asked.integrator.unwrap_or(default.integrator),
        solver: asked.solver.unwrap_or(default.solver),
        substeps: asked.substeps.unwrap_or(default.substeps),
        broad: asked.broad.unwrap_or(default.broad),
        precision,
        threads: asked.threads.unwrap_or(default.threads),
        lanes: asked.lanes.unwrap_or(default.with_precision(precision).lanes),
        skips: skips.map_err(|e| setting(e.to_string()))?,
        continuous: asked.continuous.unwrap_or(default.continuous),
        sleep: asked.sleep.unwrap_or(default.sleep),
        max_sag: asked.max_sag,
        fixed_substeps: asked.fixed_substeps.unwrap_or(default.fixed_substeps),
        stiff_fields: asked.stiff_fields,
        stiffness: asked.stiffness,
        positions: asked.positions,
        max_speed: asked.max_speed,
        max_gain: asked.max_gain,
    };
    settings.check().map_err(|e| setting(e.to_string()))?;
    let steps = asked.steps.unwrap_or(600);
    if steps == 0 {
        return Err(setting("steps must be at least 1, got 0".to_owned()));
    }
    let read = |(event, table)| events::read(table).map_err(|why| SceneError::Event { event, why });
    let events = file.event.into_iter().enumerate().map(read).collect::<Result<_, _>>()?;
    let scene = Scene {
        name: path.to_owned(),
        about: file.about,
        bodies: file.body,
        joints: file.joint,
        forces: file.forces,
        events,
        dt_secs: settings.dt_secs,
        steps,
        seed: 0,
    };
    Ok((scene, settings))
}
