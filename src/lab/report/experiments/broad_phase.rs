//! The thesis's broad-phase experiment: polygons, bounding test on and off, 60 to 200 bodies.

use serde::Serialize;

use lamina2d::scene::Scene;
use lamina2d::scene::mixes::{Mix, mix};
use lamina2d::settings::{Broad, Settings, Skips};
use lamina2d::simulation::simulate;

use super::{Contestant, SETTLE_STEPS};
use crate::report::{Record, fitted_exponent, median};
use crate::thesis::{ThesisIntegrator, Version};

/// The thesis's numbers of bodies.
pub const BODIES: [usize; 4] = [60, 80, 100, 200];
/// Steps per window.
const WINDOW_STEPS: usize = 20;

/// One engine with one number of bodies.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// `lamina2d`, `thesis` or `tidy`.
    pub engine: String,
    /// Dynamic bodies.
    pub bodies: usize,
    /// Median with the broad phase, ms per step.
    pub on_ms: f64,
    /// Median with all pairs in the narrow phase, ms per step.
    pub off_ms: f64,
}

impl Record for Row {
    const NAME: &'static str = "broad_phase";
    const TITLE: &'static str = "Broad phase on and off";
    const COMMAND: &'static str = "lamina report --only broad_phase";
    const NOTE: &'static str = "Polygons. On and off must end in the same state, or the bench fails.";
    const HEADER: &'static [&'static str] = &["engine", "bodies", "on ms", "off ms", "off/on"];

    fn cells(&self) -> Vec<String> {
        vec![
            self.engine.clone(),
            self.bodies.to_string(),
            format!("{:.4}", self.on_ms),
            format!("{:.4}", self.off_ms),
            format!("{:.2}", self.off_ms / self.on_ms),
        ]
    }

    /// After each engine's rows, the exponents fitted to them.
    fn lines(rows: &[Self]) -> Vec<Vec<String>> {
        let mut lines = Vec::new();
        for engine in ["lamina2d", "tidy", "thesis"] {
            let own: Vec<_> = rows.iter().filter(|r| r.engine == engine).collect();
            lines.extend(own.iter().map(|row| row.cells()));
            let exponent = |time: fn(&Row) -> f64| {
                let points: Vec<_> = own.iter().map(|r| (r.bodies as f64, time(r))).collect();
                fitted_exponent(&points).map_or_else(String::new, |p| format!("N^{p:.2}"))
            };
            let (on, off) = (exponent(|r| r.on_ms), exponent(|r| r.off_ms));
            lines.push(vec![engine.to_owned(), "fitted".to_owned(), on, off, String::new()]);
        }
        lines
    }
}

/// Times each engine with and without its broad phase, in `windows` alternating windows; `quick` leaves the largest scene
/// out, in which all pairs take longer than all else together.
///
/// # Errors
/// A scene that cannot be run; on and off ending in different states.
pub fn run(quick: bool, windows: usize) -> anyhow::Result<Vec<Row>> {
    let mut rows = Vec::new();
    for bodies in BODIES.into_iter().filter(|&bodies| !quick || bodies <= 100) {
        let scene = mix(Mix::Polygons, bodies, 1);
        for engine in ["lamina2d", "thesis", "tidy"] {
            let mut pair = [build(&scene, engine, true)?, build(&scene, engine, false)?];
            let mut samples = [Vec::new(), Vec::new()];
            for contestant in &mut pair {
                contestant.steps(SETTLE_STEPS)?;
            }
            for _ in 0..windows {
                for (contestant, samples) in pair.iter_mut().zip(&mut samples) {
                    contestant.window(WINDOW_STEPS, samples)?;
                }
            }
            let [on, off] = pair.map(|c| c.hash());
            anyhow::ensure!(on == off, "{engine}, {bodies} polygons: the broad phase changed the result");
            let [on_ms, off_ms] = samples.map(|s| median(&s));
            rows.push(Row { engine: engine.to_owned(), bodies, on_ms, off_ms });
        }
    }
    Ok(rows)
}

fn build(scene: &Scene, engine: &str, on: bool) -> anyhow::Result<Contestant> {
    let version = match engine {
        "lamina2d" => {
            let broad = if on { Broad::Auto } else { Broad::Off };
            // Reused manifolds would hide what the narrow phase does with all pairs.
            let settings = Settings { broad, skips: Skips::EXACT, ..Settings::default() };
            return Ok(Contestant::Ours(simulate(scene, settings)?));
        }
        "thesis" => Version::Faithful,
        _ => Version::Tidy,
    };
    Contestant::baseline(scene, ThesisIntegrator::Euler, version, on)
}
