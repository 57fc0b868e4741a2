//! What `lamina-peers` measured, read from its file: other engines on the same scenes in the same run as ours.

use std::path::Path;

use serde::{Deserialize, Serialize};

use crate::present::Earlier;
use crate::present::table::{Record, or_dash, times};

/// The engine all others are compared with.
const OURS: &str = "lamina2d";
/// The others, in the order of the columns.
const OTHERS: [&str; 2] = ["box2d", "rapier2d"];
/// Substeps or iterations the peers come with, and ours.
const DEFAULT_SUBSTEPS: u32 = 4;

/// A document of `lamina-peers --json`.
#[derive(Clone, Debug, Deserialize)]
pub struct Peers {
    /// Where and with which build.
    pub machine: Earlier,
    /// The engines.
    pub engines: Vec<Engine>,
    /// One per engine, scene and setting.
    pub rows: Vec<Row>,
}

/// An engine and its build.
#[derive(Clone, Debug, Deserialize)]
pub struct Engine {
    /// Its name.
    pub name: String,
    /// Its version.
    pub version: String,
    /// Compiler, flags, SIMD.
    pub build: serde_json::Value,
}

/// Time per step, ms.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub struct Spread {
    /// The fastest.
    pub min: f64,
    /// Half are faster.
    pub median: f64,
    /// 99 of 100 are faster.
    pub p99: f64,
}

/// One engine on one scene.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Row {
    /// The scene.
    pub scene: String,
    /// Its bodies, static ones included.
    pub bodies: usize,
    /// The engine.
    pub engine: String,
    /// Its version.
    pub version: String,
    /// Threads it was given.
    pub threads: usize,
    /// What it was run with, in words.
    pub settings: String,
    /// Substeps, or solver iterations.
    pub substeps: u32,
    /// Could bodies fall asleep?
    pub sleep: bool,
    /// Of the timed steps.
    pub ms_per_step: Spread,
    /// Touching pairs at the end, as the engine counts them.
    pub contacts: usize,
    /// Deepest overlap at the end, metres; none where a state is not finite.
    pub max_penetration: Option<f64>,
    /// Mean overlap at the end, metres.
    pub mean_penetration: Option<f64>,
    /// Error against the closed form, where the scene has one.
    pub error: Option<f64>,
    /// How far the body that began highest has sunk, metres, where the scene is to stand.
    #[serde(default)]
    pub sunk: Option<f64>,
    /// Why the run ended early.
    #[serde(default)]
    pub stopped: Option<String>,
    /// State hash at the end.
    pub hash: String,
}

impl Record for Row {
    const NAME: &'static str = "peer_rows";
    const TITLE: &'static str = "Peers, row by row";
    const COMMAND: &'static str = "cargo run --release -p lamina-peers";
    const NOTE: &'static str = "Every engine, setting and thread count; `substeps` are substeps, or rapier's solver \
         iterations. Sunk: the body that began highest, where a scene is to stand.";
    const HEADER: &'static [&'static str] = &[
        "scene",
        "engine",
        "threads",
        "sleep",
        "substeps",
        "min ms",
        "median ms",
        "p99 ms",
        "contacts",
        "max overlap mm",
        "mean overlap mm",
        "sunk m",
        "case error",
        "stopped",
    ];

    fn cells(&self) -> Vec<String> {
        vec![
            self.scene.clone(),
            self.engine.clone(),
            self.threads.to_string(),
            crate::present::table::yes_no(self.sleep),
            self.substeps.to_string(),
            format!("{:.4}", self.ms_per_step.min),
            format!("{:.4}", self.ms_per_step.median),
            format!("{:.4}", self.ms_per_step.p99),
            self.contacts.to_string(),
            millimetres(self.max_penetration),
            millimetres(self.mean_penetration),
            or_dash(self.sunk.map(|m| format!("{m:.4}"))),
            or_dash(self.error.map(|e| format!("{e:.1e}"))),
            or_dash(self.stopped.as_ref()),
        ]
    }
}

fn millimetres(metres: Option<f64>) -> String {
    or_dash(metres.map(|m| format!("{:.2}", m * 1e3)))
}

/// One scene, all engines with their default substeps beside each other.
#[derive(Clone, Debug, Serialize)]
pub struct Scene {
    /// The scene.
    pub scene: String,
    /// Threads the peers were given; ours has one.
    pub threads: usize,
    /// Could bodies fall asleep?
    pub sleep: bool,
    /// Our median, ms per step.
    pub ours_ms: f64,
    /// Medians of Box2D and rapier.
    pub peers_ms: [Option<f64>; 2],
    /// Mean overlap of all three, ours first, metres.
    pub mean_penetration: [Option<f64>; 3],
    /// Largest overlap of all three, metres.
    pub max_penetration: [Option<f64>; 3],
    /// Error of all three against the closed form.
    pub error: [Option<f64>; 3],
}

impl Scene {
    /// How many times faster than Box2D and rapier ours is.
    pub fn times_faster(&self) -> [Option<f64>; 2] {
        self.peers_ms.map(|ms| ms.map(|ms| ms / self.ours_ms))
    }
}

impl Record for Scene {
    const NAME: &'static str = "peers";
    const TITLE: &'static str = "Beside Box2D v3 and rapier";
    const COMMAND: &'static str = "cargo run --release -p lamina-peers";
    const NOTE: &'static str = "All with 4 substeps or iterations, their defaults and ours (which gives slender stacks, as \
         columns, more); medians of alternating windows in one process. `threads` are the peers', ours has one. \
         Overlaps and case errors: lamina2d / Box2D / rapier.";
    const HEADER: &'static [&'static str] = &[
        "scene",
        "threads",
        "sleep",
        "lamina2d ms",
        "Box2D ms",
        "rapier ms",
        "vs Box2D",
        "vs rapier",
        "mean overlap mm",
        "max overlap mm",
        "case error",
    ];

    fn cells(&self) -> Vec<String> {
        let all = |values: [Option<f64>; 3], show: fn(Option<f64>) -> String| {
            if values.iter().all(Option::is_none) { String::new() } else { values.map(show).join(" / ") }
        };
        let [box2d, rapier] = self.times_faster();
        vec![
            self.scene.clone(),
            self.threads.to_string(),
            crate::present::table::yes_no(self.sleep),
            format!("{:.4}", self.ours_ms),
            or_dash(self.peers_ms[0].map(|ms| format!("{ms:.4}"))),
            or_dash(self.peers_ms[1].map(|ms| format!("{ms:.4}"))),
            times(box2d),
            times(rapier),
            all(self.mean_penetration, millimetres),
            all(self.max_penetration, millimetres),
            all(self.error, |e| or_dash(e.map(|e| format!("{e:.1e}")))),
        ]
    }
}

/// Why a file of peers cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum PeersError {
    /// It cannot be read.
    #[error("cannot read peers {path}: {why}")]
    Unreadable {
        /// Its path.
        path: String,
        /// The system's reason.
        why: std::io::Error,
    },
    /// It is not a document of `lamina-peers`.
    #[error("peers {path}: {why}")]
    Syntax {
        /// Its path.
        path: String,
        /// Where and why.
        why: serde_json::Error,
    },
}

/// Reads a document of `lamina-peers`.
///
/// # Errors
/// A file that cannot be read, or is not such a document.
pub fn read(path: &Path) -> Result<Peers, PeersError> {
    let shown = || path.display().to_string();
    let text = std::fs::read_to_string(path).map_err(|why| PeersError::Unreadable { path: shown(), why })?;
    serde_json::from_str(&text).map_err(|why| PeersError::Syntax { path: shown(), why })
}

impl Peers {
    /// Scene by scene, with default substeps: ours and whoever else ran it likewise.
    pub fn scenes(&self) -> Vec<Scene> {
        let defaults =
            || self.rows.iter().filter(|row| row.substeps == DEFAULT_SUBSTEPS && row.stopped.is_none());
        let mut scenes: Vec<Scene> = Vec::new();
        for row in defaults().filter(|row| row.engine != OURS) {
            let same = |s: &Scene| s.scene == row.scene && s.threads == row.threads && s.sleep == row.sleep;
            if scenes.iter().any(same) {
                continue;
            }
            let ours = |r: &&Row| r.engine == OURS && r.scene == row.scene && r.sleep == row.sleep;
            let Some(ours) = defaults().find(ours) else { continue };
            let peers = OTHERS.map(|engine| {
                defaults().find(|r| {
                    r.engine == engine
                        && r.scene == row.scene
                        && r.threads == row.threads
                        && r.sleep == row.sleep
                })
            });
            let of = |number: fn(&Row) -> Option<f64>| {
                [number(ours), peers[0].and_then(number), peers[1].and_then(number)]
            };
            scenes.push(Scene {
                scene: row.scene.clone(),
                threads: row.threads,
                sleep: row.sleep,
                ours_ms: ours.ms_per_step.median,
                peers_ms: peers.map(|peer| peer.map(|r| r.ms_per_step.median)),
                mean_penetration: of(|r| r.mean_penetration),
                max_penetration: of(|r| r.max_penetration),
                error: of(|r| r.error),
            });
        }
        scenes
    }

    /// The rows of an engine's sweep over substeps on a scene: one thread, no sleep, fewest substeps first.
    pub fn sweep(&self, scene: &str, engine: &str) -> Vec<&Row> {
        let wanted = |r: &&Row| {
            r.scene == scene && r.engine == engine && r.threads == 1 && !r.sleep && r.stopped.is_none()
        };
        let mut rows: Vec<&Row> = self.rows.iter().filter(wanted).collect();
        rows.sort_by_key(|row| row.substeps);
        rows
    }

    /// Names of the engines, ours first.
    pub const ENGINES: [&'static str; 3] = [OURS, OTHERS[0], OTHERS[1]];
}
