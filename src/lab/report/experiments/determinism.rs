//! The thesis's determinism experiment: two runs of six bodies, fixed and variable step, 5, 10 and 15 s.
//!
//! A frame lasts 1/60 s plus the time this machine took to compute it, read from its clock: two runs
//! never see the same frames. The fixed step turns them into whole steps of 1/60 s and compares the two
//! runs after the same number of steps; the variable step integrates each frame as long as it was.

use std::time::Instant;

use serde::Serialize;

use lamina2d::clock::Accumulator;
use lamina2d::scene::{Scene, mixes};
use lamina2d::settings::{Integrator, Settings, Stepping};
use lamina2d::simulation::simulate;

use crate::present::table::{or_dash, yes_no};
use crate::report::Record;
use crate::thesis::{ThesisIntegrator, ThesisWorld, Version};

/// The thesis's durations, seconds.
pub const SECONDS: [u32; 3] = [5, 10, 15];
const DT_SECS: f64 = 1.0 / 60.0;

/// Two runs of one engine.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// `lamina2d` or `thesis`.
    pub engine: String,
    /// The integrator, by our name.
    pub integrator: String,
    /// Fixed or variable step.
    pub stepping: Stepping,
    /// Simulated seconds.
    pub seconds: u32,
    /// State hash of each run.
    pub hashes: [String; 2],
    /// Are the two states the same to the bit?
    pub identical: bool,
    /// The largest distance between the two runs' positions of a body, metres.
    pub max_apart_m: f64,
    /// The largest distance to the semi-implicit Euler run of the same engine, metres (fixed step only).
    pub from_semi_implicit_m: Option<f64>,
}

impl Record for Row {
    const NAME: &'static str = "determinism";
    const TITLE: &'static str = "Determinism: two runs";
    const COMMAND: &'static str = "lamina determinism";
    const NOTE: &'static str = "Six bodies. A frame lasts 1/60 s plus what this machine took for it, so variable steps never repeat.";
    const HEADER: &'static [&'static str] =
        &["engine", "integrator", "step", "seconds", "same bits", "max apart m", "from semi-implicit m"];

    fn cells(&self) -> Vec<String> {
        vec![
            self.engine.clone(),
            self.integrator.clone(),
            self.stepping.to_string(),
            self.seconds.to_string(),
            yes_no(self.identical),
            format!("{:.2e}", self.max_apart_m),
            or_dash(self.from_semi_implicit_m.map(|d| format!("{d:.2e}"))),
        ]
    }
}

/// An engine that can be run twice.
trait Engine {
    fn step(&mut self, dt_secs: f64) -> anyhow::Result<()>;
    fn hash(&self) -> u64;
    fn positions(&self) -> Vec<[f64; 2]>;
}

struct Ours(Box<dyn lamina2d::simulation::Simulation>);

impl Engine for Ours {
    fn step(&mut self, dt_secs: f64) -> anyhow::Result<()> {
        Ok(self.0.step(dt_secs)?)
    }
    fn hash(&self) -> u64 {
        self.0.hash()
    }
    fn positions(&self) -> Vec<[f64; 2]> {
        self.0.states().iter().map(|s| s.position).collect()
    }
}

impl Engine for ThesisWorld {
    fn step(&mut self, dt_secs: f64) -> anyhow::Result<()> {
        Self::step(self, dt_secs as f32);
        Ok(())
    }
    fn hash(&self) -> u64 {
        Self::hash(self)
    }
    fn positions(&self) -> Vec<[f64; 2]> {
        self.positions_m()
    }
}

/// Runs the experiment: both engines, both steppings, all durations, and every integrator of ours.
///
/// # Errors
/// A run that failed.
pub fn run() -> anyhow::Result<Vec<Row>> {
    let scene = mixes::determinism();
    let ours = |integrator: Integrator| {
        let scene = scene.clone();
        move || -> anyhow::Result<Box<dyn Engine>> {
            Ok(Box::new(Ours(simulate(&scene, Settings { integrator, ..Settings::default() })?)))
        }
    };
    let mut rows = Vec::new();
    for stepping in [Stepping::Fixed, Stepping::Variable] {
        for seconds in SECONDS {
            let reference = final_positions(&ours(Integrator::SemiImplicitEuler), seconds)?;
            for &integrator in Integrator::ALL {
                let from = (stepping == Stepping::Fixed).then_some(&reference[..]);
                rows.push(pair("lamina2d", integrator, stepping, seconds, &ours(integrator), from)?);
            }
            let thesis = || thesis(&scene);
            rows.push(pair("thesis", Integrator::SemiImplicitEuler, stepping, seconds, &thesis, None)?);
        }
    }
    Ok(rows)
}

fn thesis(scene: &Scene) -> anyhow::Result<Box<dyn Engine>> {
    Ok(Box::new(ThesisWorld::new(scene, ThesisIntegrator::Euler, Version::Faithful, true)?))
}

type Build<'a> = &'a dyn Fn() -> anyhow::Result<Box<dyn Engine>>;

fn pair(
    engine: &str,
    integrator: Integrator,
    stepping: Stepping,
    seconds: u32,
    build: Build<'_>,
    reference: Option<&[[f64; 2]]>,
) -> anyhow::Result<Row> {
    let [a, b] = [play(build()?, stepping, seconds)?, play(build()?, stepping, seconds)?];
    let hashes = [a.hash(), b.hash()];
    let (a, b) = (a.positions(), b.positions());
    Ok(Row {
        engine: engine.to_owned(),
        integrator: integrator.name().to_owned(),
        stepping,
        seconds,
        hashes: hashes.map(|h| format!("{h:016x}")),
        identical: hashes[0] == hashes[1],
        max_apart_m: apart(&a, &b),
        from_semi_implicit_m: reference.map(|r| apart(&a, r)),
    })
}

fn final_positions(build: Build<'_>, seconds: u32) -> anyhow::Result<Vec<[f64; 2]>> {
    Ok(play(build()?, Stepping::Fixed, seconds)?.positions())
}

fn play(mut engine: Box<dyn Engine>, stepping: Stepping, seconds: u32) -> anyhow::Result<Box<dyn Engine>> {
    let total_steps = 60 * seconds;
    let mut clock = Accumulator::new(DT_SECS, Accumulator::CLAMP_SECS);
    let (mut frame_secs, mut elapsed_secs, mut steps) = (DT_SECS, 0.0, 0);
    loop {
        let start = Instant::now();
        match stepping {
            Stepping::Fixed => {
                for _ in 0..clock.steps_due(frame_secs).min(total_steps - steps) {
                    engine.step(DT_SECS)?;
                    steps += 1;
                }
                if steps == total_steps {
                    return Ok(engine);
                }
            }
            Stepping::Variable => {
                engine.step(frame_secs)?;
                elapsed_secs += frame_secs;
                if elapsed_secs >= f64::from(seconds) {
                    return Ok(engine);
                }
            }
        }
        frame_secs = DT_SECS + start.elapsed().as_secs_f64();
    }
}

fn apart(a: &[[f64; 2]], b: &[[f64; 2]]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a[0] - b[0]).hypot(a[1] - b[1])).fold(0.0, f64::max)
}
