//! Run time against error of resting piles: scenes that are hard to hold, every solver, several substeps.

use std::time::Instant;

use serde::Serialize;

use lamina2d::settings::{Settings, Solver};
use lamina2d::simulation::{BodyState, simulate};

use super::DT_SECS;
use crate::cases::by_name;
use crate::present::table::or_dash;
use crate::report::{Record, median};

/// One solver with one number of substeps on one scene.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// The scene.
    pub scene: &'static str,
    /// The solver.
    pub solver: Solver,
    /// Substeps per step, or the bound on the sag they follow from.
    pub substeps: Substeps,
    /// Simulated time, s.
    pub seconds: f64,
    /// Median time per step, ms.
    pub ms_per_step: f64,
    /// Largest overlap at the end, metres.
    pub max_penetration: f64,
    /// Mean overlap at the end, metres.
    pub mean_penetration: f64,
    /// Root mean square of the bodies' speeds at the end, m/s.
    pub rms_speed: f64,
    /// The farthest any body is from where it began, metres: what it has sunk, or fallen.
    pub moved: f64,
    /// The farthest any body is from where it was after half the time, metres.
    pub drift: f64,
    /// Why it broke off, if it did.
    pub failed: Option<String>,
}

impl Record for Row {
    const NAME: &'static str = "stability";
    const TITLE: &'static str = "Stability: run time against error";
    const COMMAND: &'static str = "lamina report --only stability";
    const NOTE: &'static str = "Piles left to stand. Moved: the farthest any body is from where it began, which is what it has sunk; \
               a body's size or more says that it fell. Drift: since half the time. `avbd` visits contacts ten times per \
               substep, `pgs` eight times, `soft` and `xpbd` twice. One number: all islands have it (`--fixed-substeps`); `4+`: \
               slender stacks get more, as by default; `sag`: each island gets its own (`--max-sag`).";
    const HEADER: &'static [&'static str] = &[
        "scene",
        "solver",
        "substeps",
        "seconds",
        "ms per step",
        "max overlap mm",
        "mean overlap mm",
        "rms speed m/s",
        "moved m",
        "drift m",
        "broke off",
    ];

    fn cells(&self) -> Vec<String> {
        vec![
            self.scene.to_owned(),
            self.solver.to_string(),
            self.substeps.to_string(),
            self.seconds.to_string(),
            format!("{:.4}", self.ms_per_step),
            format!("{:.2}", self.max_penetration * 1e3),
            format!("{:.2}", self.mean_penetration * 1e3),
            format!("{:.1e}", self.rms_speed),
            format!("{:.3}", self.moved),
            format!("{:.4}", self.drift),
            or_dash(self.failed.as_ref()),
        ]
    }
}

const SCENES: [&str; 10] = [
    "stack/10",
    "stack/40",
    "stack/80",
    "columns/40",
    "pyramid/100",
    "heavy/100",
    "heavy/1000",
    "arch",
    "cards/3",
    "cards/4",
];
const CHOICES: [(Solver, Substeps); 9] = [
    (Solver::Soft, Substeps::Fixed(2)),
    (Solver::Soft, Substeps::Fixed(4)),
    (Solver::Soft, Substeps::Fixed(8)),
    (Solver::Soft, Substeps::Fixed(16)),
    (Solver::Soft, Substeps::AtLeast(4)),
    (Solver::Soft, Substeps::ForSag(1e-3)),
    (Solver::Pgs, Substeps::Fixed(4)),
    (Solver::Xpbd, Substeps::Fixed(8)),
    (Solver::Avbd, Substeps::Fixed(1)),
];

/// How substeps are chosen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Substeps {
    /// The same number for all.
    Fixed(u32),
    /// More for islands with a slender stack; see `solve::slender_stack` of the engine.
    AtLeast(u32),
    /// Per island, for contacts that sag by so much at most, metres; see `solve::substep_group` of the engine.
    ForSag(f64),
}

impl Serialize for Substeps {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

impl std::fmt::Display for Substeps {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Fixed(substeps) => write!(f, "{substeps}"),
            Self::AtLeast(substeps) => write!(f, "{substeps}+"),
            Self::ForSag(metres) => write!(f, "sag {} mm", metres * 1e3),
        }
    }
}

/// Lets each scene stand for `seconds` with each solver.
///
/// # Errors
/// A scene that cannot be built.
pub fn run(quick: bool, seconds: f64) -> anyhow::Result<Vec<Row>> {
    let mut rows = Vec::new();
    for scene in SCENES {
        if quick && matches!(scene, "pyramid/100" | "stack/80" | "columns/40") {
            continue;
        }
        for (solver, substeps) in CHOICES {
            rows.push(stand(scene, solver, substeps, seconds)?);
        }
    }
    Ok(rows)
}

fn stand(name: &'static str, solver: Solver, substeps: Substeps, seconds: f64) -> anyhow::Result<Row> {
    let scene = by_name(name, None, 1)?;
    let settings = match substeps {
        Substeps::Fixed(substeps) => {
            Settings { solver, substeps, fixed_substeps: true, ..Settings::default() }
        }
        Substeps::AtLeast(substeps) => Settings { solver, substeps, ..Settings::default() },
        Substeps::ForSag(max_sag) => Settings { solver, max_sag: Some(max_sag), ..Settings::default() },
    };
    let mut world = simulate(&scene, settings)?;
    let begun = world.states();
    let mut halfway = begun.clone();
    let mut samples_ms = Vec::new();
    let mut failed = None;
    let steps = (seconds / DT_SECS).round() as usize;
    for step in 0..steps {
        if step == steps / 2 {
            halfway = world.states();
        }
        let start = Instant::now();
        if let Err(error) = world.step(DT_SECS) {
            failed = Some(error.to_string());
            break;
        }
        samples_ms.push(start.elapsed().as_secs_f64() * 1e3);
    }
    let states = world.states();
    let penetration = world.penetration();
    let square = |state: &BodyState| state.velocity.iter().map(|v| v * v).sum::<f64>();
    let apart = |(a, b): (&BodyState, &BodyState)| {
        (a.position[0] - b.position[0]).hypot(a.position[1] - b.position[1])
    };
    let farthest_from = |then: &[BodyState]| then.iter().zip(&states).map(apart).fold(0.0, f64::max);
    Ok(Row {
        scene: name,
        solver,
        substeps,
        seconds,
        ms_per_step: median(&samples_ms),
        max_penetration: penetration.max,
        mean_penetration: penetration.mean,
        rms_speed: (states.iter().map(square).sum::<f64>() / states.len() as f64).sqrt(),
        moved: farthest_from(&begun),
        drift: farthest_from(&halfway),
        failed,
    })
}
