//! What recording costs a step, how large a frame is, and how fast any of them is read.

use std::path::{Path, PathBuf};
use std::time::Instant;

use rand::{Rng, SeedableRng};
use rand_pcg::Pcg64;
use serde::Serialize;

use lamina2d::record::{Recorder, Recording};
use lamina2d::scene::Scene;
use lamina2d::settings::Settings;
use lamina2d::simulation::{Simulation, simulate};

use super::DT_SECS;
use crate::cases::by_name;
use crate::report::{Record, median};

/// One scene.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// The scene.
    pub scene: &'static str,
    /// Falling or settled.
    pub state: &'static str,
    /// Movable bodies.
    pub bodies: usize,
    /// Touching pairs at the end.
    pub contacts: usize,
    /// Median step, ms.
    pub step_ms: f64,
    /// Median of step and record call, ms.
    pub recorded_ms: f64,
    /// What the call adds, as a share of the step.
    pub cost: f64,
    /// Bytes of the file per body and frame.
    pub bytes: f64,
    /// The same before packing.
    pub unpacked_bytes: f64,
    /// To open it, ms.
    pub open_ms: f64,
    /// Median of reading a frame drawn at random, with its contacts, ms.
    pub seek_ms: f64,
    /// The longest of them, ms.
    pub slowest_seek_ms: f64,
}

impl Record for Row {
    const NAME: &'static str = "recording";
    const TITLE: &'static str = "Recording";
    const COMMAND: &'static str = "lamina report --only recording";
    const NOTE: &'static str = "Every step recorded whole, beside the same steps without, in alternating windows. The step's own \
               thread copies columns and contacts; another one packs and writes.";
    const HEADER: &'static [&'static str] = &[
        "scene",
        "state",
        "bodies",
        "contacts",
        "step ms",
        "recorded ms",
        "cost",
        "bytes per body and frame",
        "unpacked",
        "open ms",
        "seek ms",
        "slowest seek ms",
    ];

    fn cells(&self) -> Vec<String> {
        vec![
            self.scene.to_owned(),
            self.state.to_owned(),
            self.bodies.to_string(),
            self.contacts.to_string(),
            format!("{:.4}", self.step_ms),
            format!("{:.4}", self.recorded_ms),
            format!("{:+.1} %", self.cost * 100.0),
            format!("{:.1}", self.bytes),
            format!("{:.1}", self.unpacked_bytes),
            format!("{:.2}", self.open_ms),
            format!("{:.3}", self.seek_ms),
            format!("{:.3}", self.slowest_seek_ms),
        ]
    }
}

/// Scenes, and the steps before their windows.
const SCENES: [(&str, &str, u64); 5] = [
    ("all/1000", "falling", 30),
    ("all/1000", "settled", 600),
    ("polygons/1000", "settled", 600),
    ("free_flight/1000", "in flight", 0),
    ("all/10000", "settled", 400),
];
/// Windows, and steps of each.
const WINDOWS: usize = 10;
const WINDOW_STEPS: usize = 30;
/// Frames read.
const SEEKS: usize = 100;

/// Records scenes; `quick` leaves the large one out.
///
/// # Errors
/// A scene that cannot be run; a temporary folder that cannot be written to.
pub fn run(quick: bool) -> anyhow::Result<Vec<Row>> {
    let scenes = SCENES.into_iter().filter(|(name, ..)| !(quick && *name == "all/10000"));
    scenes.map(|(name, state, before)| record(name, state, before)).collect()
}

/// A file that goes away.
struct Temporary(PathBuf);

impl Drop for Temporary {
    fn drop(&mut self) {
        // Nothing to be done where it is gone already.
        let _ = std::fs::remove_file(&self.0);
    }
}

fn record(name: &'static str, state: &'static str, before: u64) -> anyhow::Result<Row> {
    let scene = by_name(name, None, 1)?;
    let mut world = simulate(&scene, Settings::default())?;
    for _ in 0..before {
        world.step(DT_SECS)?;
    }
    let file = format!("lamina2d-{}-{}.mcap", std::process::id(), name.replace('/', "-"));
    let path = Temporary(std::env::temp_dir().join(file));
    let (step_ms, recorded_ms, recorded) = steps(&scene, world.as_mut(), &path.0)?;
    let contacts = world.counts().contacts;
    let begin = Instant::now();
    let mut recording = Recording::open(&path.0)?;
    let open_ms = begin.elapsed().as_secs_f64() * 1e3;
    let mut random = Pcg64::seed_from_u64(1);
    let mut seeks_ms = Vec::new();
    for _ in 0..SEEKS {
        let frame = random.next_u64() as usize % recording.frames();
        let begin = Instant::now();
        recording.frame(frame)?;
        seeks_ms.push(begin.elapsed().as_secs_f64() * 1e3);
    }
    let per = |bytes: u64| bytes as f64 / recorded.frames as f64 / scene.movable() as f64;
    Ok(Row {
        scene: name,
        state,
        bodies: scene.movable(),
        contacts,
        step_ms,
        recorded_ms,
        cost: recorded_ms / step_ms - 1.0,
        bytes: per(recorded.bytes),
        unpacked_bytes: per(recorded.unpacked_bytes),
        open_ms,
        seek_ms: median(&seeks_ms),
        slowest_seek_ms: seeks_ms.iter().copied().fold(0.0, f64::max),
    })
}

/// Medians of windows without and with a recorder, and what it wrote.
fn steps(
    scene: &Scene,
    world: &mut dyn Simulation,
    path: &Path,
) -> anyhow::Result<(f64, f64, lamina2d::record::Recorded)> {
    world.time_every_step();
    let mut recorder = Recorder::create(path, scene, world, 1)?;
    let mut bare = world.duplicate();
    let (mut bare_ms, mut recorded_ms) = (Vec::new(), Vec::new());
    for _ in 0..WINDOWS {
        for _ in 0..WINDOW_STEPS {
            let begin = Instant::now();
            bare.step(DT_SECS)?;
            bare_ms.push(begin.elapsed().as_secs_f64() * 1e3);
        }
        for _ in 0..WINDOW_STEPS {
            let begin = Instant::now();
            world.step(DT_SECS)?;
            recorder.record(world, true)?;
            recorded_ms.push(begin.elapsed().as_secs_f64() * 1e3);
        }
    }
    let recorded = recorder.finish()?;
    anyhow::ensure!(world.hash() == bare.hash(), "{}: recording has moved a bit", scene.name);
    Ok((median(&bare_ms), median(&recorded_ms), recorded))
}
