//! Where a step of a settled pile goes: shares of the stages, time per contact and pass, bytes per contact.

use serde::Serialize;

use lamina2d::measure::{Stage, StageTimes};
use lamina2d::settings::Settings;
use lamina2d::simulation::{Simulation, simulate};

use super::DT_SECS;
use crate::cases::by_name;
use crate::report::{Record, median};

/// One scene at one width.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// The scene.
    pub scene: &'static str,
    /// Numbers per vector.
    pub lanes: usize,
    /// Movable bodies.
    pub bodies: usize,
    /// Touching pairs.
    pub contacts: usize,
    /// Median time per step, ms.
    pub ms_per_step: f64,
    /// Time in the solver's passes over contacts, per contact and pass, ns: two passes per substep.
    pub ns_per_contact_and_pass: f64,
    /// Solver time of lanes 1 over this width's.
    pub solve_speed_up: f64,
    /// What a pass streams of a two-point and a one-point contact, bytes.
    pub bytes_per_contact: [usize; 2],
    /// Shares of the step: broad, narrow, prepare, integrate, solve, measure.
    pub shares: [f64; 6],
}

impl Record for Row {
    const NAME: &'static str = "contacts";
    const TITLE: &'static str = "Contacts: where a step goes";
    const COMMAND: &'static str = "lamina report --only contacts";
    const NOTE: &'static str = "Settled piles with `soft`, 4 substeps of two passes. Bytes: what a pass streams of a two-point and a \
               one-point contact, its bodies' rows not counted.";
    const HEADER: &'static [&'static str] = &[
        "scene",
        "lanes",
        "bodies",
        "contacts",
        "ms per step",
        "ns per contact and pass",
        "solve over 1 lane",
        "bytes",
        "broad",
        "narrow",
        "prepare",
        "integrate",
        "solve",
        "measure",
    ];

    fn cells(&self) -> Vec<String> {
        let mut cells = vec![
            self.scene.to_owned(),
            self.lanes.to_string(),
            self.bodies.to_string(),
            self.contacts.to_string(),
            format!("{:.4}", self.ms_per_step),
            format!("{:.2}", self.ns_per_contact_and_pass),
            format!("{:.2}×", self.solve_speed_up),
            self.bytes_per_contact.map(|bytes| bytes.to_string()).join(" / "),
        ];
        cells.extend(self.shares.map(|share| format!("{:.0} %", share * 100.0)));
        cells
    }
}

/// Scenes with the steps that let them settle.
const SCENES: [(&str, usize); 7] = [
    ("pyramid/100", 120),
    ("circles/1000", 1200),
    ("circles_polygons/1000", 1200),
    ("all/1000", 1200),
    ("polygons/150", 900),
    ("polygons/1000", 1200),
    ("polygons/10000", 900),
];
/// Passes of `soft` over all contacts per substep.
const PASSES: f64 = 2.0;
/// Steps between two readings.
const WINDOW: usize = 10;

/// Times settled scenes at 1 and 8 lanes, taking turns `windows` times; `quick` takes two of them.
///
/// # Errors
/// A scene that cannot be run.
pub fn run(quick: bool, windows: usize) -> anyhow::Result<Vec<Row>> {
    let mut rows = Vec::new();
    for (name, settle) in SCENES
        .into_iter()
        .filter(|(name, _)| !quick || name.starts_with("polygons/1") && !name.ends_with("0000"))
    {
        let scene = by_name(name, None, 1)?;
        let mut wide = simulate(&scene, Settings::default())?;
        for _ in 0..settle {
            wide.step(DT_SECS)?;
        }
        // The same bits at one lane: settled once, taken over, and given time to learn its impulses anew.
        let mut narrow = wide.with_settings(Settings { lanes: 1, ..Settings::default() })?;
        for _ in 0..SETTLE_AGAIN {
            narrow.step(DT_SECS)?;
            wide.step(DT_SECS)?;
        }
        let mut samples = [Samples::default(), Samples::default()];
        for _ in 0..windows {
            samples[0].window(narrow.as_mut())?;
            samples[1].window(wide.as_mut())?;
        }
        let bodies = scene.movable();
        let one = samples[0].row(name, bodies, narrow.as_ref(), None);
        let eight = samples[1].row(name, bodies, wide.as_ref(), Some(&one));
        rows.extend([one, eight]);
    }
    Ok(rows)
}

/// Steps after taking over a pile.
const SETTLE_AGAIN: usize = 120;

/// Stage times of windows, ns per step.
#[derive(Default)]
struct Samples {
    stages: [Vec<f64>; Stage::ALL.len()],
    total: Vec<f64>,
}

impl Samples {
    fn window(&mut self, world: &mut dyn Simulation) -> anyhow::Result<()> {
        world.reset_times();
        for _ in 0..WINDOW {
            world.step(DT_SECS)?;
        }
        let times: StageTimes = world.times();
        let each = Stage::ALL.map(|stage| times.mean_ns(stage));
        self.total.push(each.iter().sum());
        for (samples, ns) in self.stages.iter_mut().zip(each) {
            samples.push(ns);
        }
        Ok(())
    }

    fn row(&self, scene: &'static str, bodies: usize, world: &dyn Simulation, one: Option<&Row>) -> Row {
        let contacts = world.counts().contacts;
        let stages = self.stages.each_ref().map(|s| median(s));
        let visits = contacts as f64 * f64::from(world.settings().substeps) * PASSES;
        let ns = stages[Stage::Solve as usize] / visits.max(1.0);
        let whole: f64 = stages.iter().sum();
        Row {
            scene,
            lanes: world.settings().lanes,
            bodies,
            contacts,
            ms_per_step: median(&self.total) * 1e-6,
            ns_per_contact_and_pass: ns,
            solve_speed_up: one.map_or(1.0, |one| one.ns_per_contact_and_pass / ns),
            bytes_per_contact: world.bytes_per_contact(),
            shares: stages.map(|ns| ns / whole),
        }
    }
}
