//! What sleeping bodies cost: a pile awake, asleep, and asleep beside one body that flies.

use std::time::Instant;

use serde::Serialize;

use lamina2d::scene::{BodyKind, BodySpec, Scene, ShapeSpec};
use lamina2d::settings::Settings;
use lamina2d::simulation::{Simulation, simulate};

use super::DT_SECS;
use crate::cases::by_name;
use crate::present::table::or_dash;
use crate::report::{Record, median};

/// One pile.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// The scene.
    pub scene: &'static str,
    /// Substeps per step.
    pub substeps: u32,
    /// Movable bodies.
    pub bodies: usize,
    /// Steps after which all slept; none if they did not within the time given.
    pub slept_after: Option<u64>,
    /// Median of the last steps before, awake, ms per step.
    pub awake_ms: f64,
    /// Median asleep, ms per step.
    pub asleep_ms: f64,
    /// Asleep over awake.
    pub share: f64,
    /// Median asleep, while one body flies by at 50 m/s, µs per step.
    pub beside_us: f64,
    /// Median of that body without the pile, µs per step.
    pub alone_us: f64,
    /// What a sleeper adds to the step of the one that flies, ns.
    pub ns_per_sleeper: f64,
}

impl Record for Row {
    const NAME: &'static str = "sleep";
    const TITLE: &'static str = "Sleep";
    const COMMAND: &'static str = "lamina report --only sleep";
    const NOTE: &'static str = "Piles with sleep on: a step awake, a step when all sleep, and a step in which one other body flies by \
               at 50 m/s, which finds its pairs anew in every step: beside the pile and without it.";
    const HEADER: &'static [&'static str] = &[
        "scene",
        "substeps",
        "bodies",
        "asleep after steps",
        "awake ms",
        "asleep ms",
        "asleep / awake",
        "beside a flier µs",
        "flier alone µs",
        "ns per sleeper",
    ];

    fn cells(&self) -> Vec<String> {
        vec![
            self.scene.to_owned(),
            self.substeps.to_string(),
            self.bodies.to_string(),
            or_dash(self.slept_after),
            format!("{:.4}", self.awake_ms),
            format!("{:.5}", self.asleep_ms),
            format!("{:.3} %", self.share * 100.0),
            format!("{:.2}", self.beside_us),
            format!("{:.2}", self.alone_us),
            format!("{:.2}", self.ns_per_sleeper),
        ]
    }
}

/// With the substeps that bring them to rest: at 4, a pyramid of 100 keeps wavering and nothing in it sleeps.
const PILES: [(&str, u32); 3] = [("pyramid/40", 8), ("pyramid/100", 8), ("polygons/1000", 4)];
/// Steps given to fall asleep.
const PATIENCE: u64 = 3000;
/// Steps timed.
const TIMED: usize = 60;

/// Puts piles to sleep; `quick` leaves the largest awake and out.
///
/// # Errors
/// A scene that cannot be run.
pub fn run(quick: bool) -> anyhow::Result<Vec<Row>> {
    let piles = PILES.into_iter().filter(|(name, _)| !(quick && *name == "pyramid/100"));
    piles.map(|(name, substeps)| put_to_sleep(name, substeps)).collect()
}

fn put_to_sleep(name: &'static str, substeps: u32) -> anyhow::Result<Row> {
    let scene = by_name(name, None, 1)?;
    let settings = Settings { substeps, sleep: true, ..Settings::default() };
    let mut world = simulate(&scene, settings)?;
    let bodies = scene.movable();
    let mut awake = Vec::new();
    while world.sleeping() < bodies && world.steps() < PATIENCE {
        awake.push(timed(world.as_mut())?);
    }
    let slept_after = (world.sleeping() == bodies).then(|| world.steps());
    // Some may sleep before the last does: awake is the first half of the way.
    let awake = &awake[awake.len() / 4..awake.len() / 2];
    let mut asleep = Vec::new();
    for _ in 0..TIMED {
        asleep.push(timed(world.as_mut())?);
    }
    let sleepers = world.sleeping();
    let fixed = scene.bodies.iter().filter(|body| body.kind != BodyKind::Dynamic).cloned();
    let mut empty = simulate(&Scene { bodies: fixed.collect(), ..scene }, settings)?;
    let flier = BodySpec::new(ShapeSpec::Circle(0.2), [-500.0, 500.0]).moving([50.0, 0.0], 0.0);
    world.insert(&flier)?;
    empty.insert(&flier)?;
    let (mut beside, mut alone) = (Vec::new(), Vec::new());
    for _ in 0..TIMED {
        beside.push(timed(world.as_mut())? * 1e3);
        alone.push(timed(empty.as_mut())? * 1e3);
    }
    let (beside_us, alone_us) = (median(&beside), median(&alone));
    let (awake_ms, asleep_ms) = (median(awake), median(&asleep));
    Ok(Row {
        scene: name,
        substeps,
        bodies,
        slept_after,
        awake_ms,
        asleep_ms,
        share: asleep_ms / awake_ms,
        beside_us,
        alone_us,
        ns_per_sleeper: (beside_us - alone_us) * 1e3 / sleepers.max(1) as f64,
    })
}

/// The time of a step, ms.
fn timed(world: &mut dyn Simulation) -> anyhow::Result<f64> {
    let start = Instant::now();
    world.step(DT_SECS)?;
    Ok(start.elapsed().as_secs_f64() * 1e3)
}
