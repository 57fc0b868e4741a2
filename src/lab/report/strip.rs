//! Frame strips: a few moments of a scene side by side in one small SVG, drawn from the world itself.
//!
//! | file | what |
//! |---|---|
//! | `path` | bodies as path data: whole numbers, each relative to the last |
//! | `sheet` | frames, times, scale bar and legend around them |

mod path;
mod sheet;

use anyhow::Context;

use lamina2d::scene;
use lamina2d::settings::Settings;
use lamina2d::simulation::simulate;

/// Where a scene's random numbers come from: the program's default, so that its commands show the same run.
const SEED: u64 = 1;

/// A scene and the moments that show what it does.
#[derive(Clone, Copy, Debug)]
pub struct Shot {
    /// Its file in the report's folder.
    pub file: &'static str,
    /// The scene's name.
    pub scene: &'static str,
    /// The scene's parameter.
    pub bodies: usize,
    /// Steps after which it is drawn, ascending.
    pub steps: &'static [u64],
}

/// The strips of a report. Where a frame has thousands of bodies there are fewer frames: a strip stays below 72 KiB.
pub const SHOTS: &[Shot] = &[
    Shot { file: "strip_circles.svg", scene: "circles", bodies: 1000, steps: &[0, 30, 60, 600] },
    Shot {
        file: "strip_circles_polygons.svg",
        scene: "circles_polygons",
        bodies: 1000,
        steps: &[0, 120, 600],
    },
    Shot { file: "strip_polygons.svg", scene: "polygons", bodies: 1000, steps: &[120, 600] },
    Shot { file: "strip_all.svg", scene: "all", bodies: 1000, steps: &[0, 120, 600] },
    Shot { file: "strip_pyramid.svg", scene: "pyramid", bodies: 100, steps: &[0, 600] },
    Shot { file: "strip_tumbler.svg", scene: "tumbler", bodies: 2000, steps: &[0, 120, 600] },
    Shot { file: "strip_spinner.svg", scene: "spinner", bodies: 2000, steps: &[90, 600] },
    Shot { file: "strip_rain.svg", scene: "rain", bodies: 1000, steps: &[0, 120, 600] },
    Shot { file: "strip_joint_grid.svg", scene: "joint_grid", bodies: 60, steps: &[0, 600] },
];

/// A strip of a scene, and how to see the rest of its run.
#[derive(Clone, Debug)]
pub struct Strip {
    /// Its file in the report's folder.
    pub file: &'static str,
    /// Scene, moments and settings, in words.
    pub about: String,
    /// The commands that record the same run, and open the recording at one of these frames.
    pub replay: [String; 2],
    /// The drawing.
    pub svg: String,
}

/// All strips of a report, of runs with default settings that nobody times.
///
/// # Errors
/// A scene that cannot be run.
pub fn strips() -> anyhow::Result<Vec<Strip>> {
    SHOTS.iter().map(|shot| shot.take(Settings::default())).collect()
}

impl Shot {
    /// Runs the scene to the last of its moments with its own step's length, and draws them.
    ///
    /// # Errors
    /// A scene that is not there, settings it cannot be run with, a state that turns non-finite.
    pub fn take(&self, settings: Settings) -> anyhow::Result<Strip> {
        let scene = scene::by_name(self.scene, Some(self.bodies), SEED)?;
        let settings = Settings { dt_secs: scene.dt_secs, ..settings };
        let mut world = simulate(&scene, settings)?;
        let bodies = world.body_table().bodies;
        let mut moments = Vec::new();
        for &step in self.steps {
            while world.steps() < step {
                world.step(settings.dt_secs).with_context(|| format!("scene {}", scene.name))?;
            }
            let time_secs = step as f64 * settings.dt_secs;
            moments.push(sheet::Moment { time_secs, states: world.states() });
        }
        let times: Vec<_> = moments.iter().map(sheet::Moment::time).collect();
        Ok(Strip {
            file: self.file,
            about: format!(
                "{}, {} bodies, at {}: {}, {} with {} substeps, {}, {} lanes, seed {SEED}",
                scene.name,
                bodies.len(),
                times.join(", "),
                settings.integrator,
                settings.solver,
                settings.substeps,
                settings.precision,
                settings.lanes,
            ),
            replay: self.replay(),
            svg: sheet::draw(&scene.name, &bodies, &moments),
        })
    }

    /// A frame is recorded after every step, and one before the first: their numbers are those of the steps.
    fn replay(&self) -> [String; 2] {
        let (scene, bodies) = (self.scene, self.bodies);
        let frame = |at: usize| self.steps.get(at).copied().unwrap_or(0);
        let (middle, last) = (frame(self.steps.len() / 2), frame(self.steps.len().saturating_sub(1)));
        [
            format!(
                "cargo run --release -- run {scene} --bodies {bodies} --steps {last} --record {scene}.mcap"
            ),
            format!("cargo run --release -p lamina-viewer -- {scene}.mcap --frame {middle}"),
        ]
    }
}
