//! The thesis's performance experiment: shape mix × integrator × bodies, at every width, beside its engine.

use serde::Serialize;

use lamina2d::scene::mixes::{Mix, mix};
use lamina2d::settings::{Integrator, Settings};
use lamina2d::simulation::simulate;

use super::{Contestant, SETTLE_STEPS, integrator_of, posed};
use crate::report::{Record, Timing};
use crate::thesis::{ThesisIntegrator, Version};

/// One engine on one scene.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// The shape mix.
    pub mix: String,
    /// The integrator, by our name.
    pub integrator: String,
    /// Dynamic bodies.
    pub bodies: usize,
    /// `lamina2d`, `thesis` or `tidy`.
    pub engine: String,
    /// Numbers per vector; 1 for the baselines.
    pub lanes: usize,
    /// Integrate-and-solve rounds per step; 1 for the baselines.
    pub substeps: u32,
    /// Steps timed one by one.
    pub ms_per_step: Timing,
    /// Contacts in the last step.
    pub contacts: usize,
    /// Deepest overlap after the last step, metres.
    pub max_penetration: f64,
    /// Mean overlap after the last step, metres.
    pub mean_penetration: f64,
    /// State hash after the last step.
    pub hash: String,
    /// How the state that was timed came about.
    pub start: &'static str,
}

impl Record for Row {
    const NAME: &'static str = "matrix";
    const TITLE: &'static str = "Performance: shape mix × integrator";
    const COMMAND: &'static str = "lamina report --only matrix";
    const NOTE: &'static str = "The thesis's performance and complexity experiments: settled bodies, every step timed. \
               Lane widths of one integrator must end in the same bits, or the bench fails.";
    const HEADER: &'static [&'static str] = &[
        "mix",
        "integrator",
        "bodies",
        "engine",
        "lanes",
        "substeps",
        "min ms",
        "median ms",
        "p99 ms",
        "contacts",
        "max overlap m",
    ];

    fn cells(&self) -> Vec<String> {
        vec![
            self.mix.clone(),
            self.integrator.clone(),
            self.bodies.to_string(),
            self.engine.clone(),
            self.lanes.to_string(),
            self.substeps.to_string(),
            format!("{:.4}", self.ms_per_step.min),
            format!("{:.4}", self.ms_per_step.median),
            format!("{:.4}", self.ms_per_step.p99),
            self.contacts.to_string(),
            format!("{:.3}", self.max_penetration),
        ]
    }
}

/// The integrator of the headline table: the default.
pub const HEADLINE_INTEGRATOR: Integrator = Integrator::VelocityVerlet;
/// Beside the default's, at 8 lanes: half the work, a few times the overlap, far less than the thesis's.
const FEW_SUBSTEPS: u32 = 2;

/// Steps between taking over a settled pile and timing it.
const REST_STEPS: usize = 120;

/// Windows of steps, in which all engines take turns.
#[derive(Clone, Copy, Debug)]
struct Windows {
    bodies: usize,
    count: usize,
    steps: usize,
    /// From where baselines begin.
    baselines: Begin,
}

/// From where the baselines are timed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Begin {
    /// They let the scene fall and settle themselves.
    Own,
    /// Our settled poses, and so many steps of theirs.
    Ours { steps: usize },
}

impl Begin {
    /// In words; `ours` says how our poses came about.
    fn name(self, ours: &'static str) -> &'static str {
        match self {
            Self::Own => "600 steps of its own",
            Self::Ours { steps: 0 } => ours,
            Self::Ours { .. } => "600 steps of lamina2d, then some of its own",
        }
    }
}

/// What to run.
#[derive(Clone, Debug)]
pub struct Plan {
    integrators: Vec<Integrator>,
    lanes: Vec<usize>,
    windows: Vec<Windows>,
}

impl Plan {
    /// Everything: a few minutes.
    pub fn full() -> Self {
        Self {
            integrators: Integrator::ALL.to_vec(),
            lanes: vec![1, 4, 8, 16],
            windows: vec![
                Windows { bodies: 150, count: 24, steps: 60, baselines: Begin::Own },
                Windows { bodies: 1000, count: 6, steps: 20, baselines: Begin::Own },
                Windows { bodies: 10_000, count: 4, steps: 15, baselines: Begin::Ours { steps: 0 } },
            ],
        }
    }

    /// The thesis's integrators, one lane and eight, up to 1000 bodies.
    pub fn quick() -> Self {
        Self {
            integrators: vec![Integrator::SemiImplicitEuler, Integrator::VelocityVerlet, Integrator::Rk4],
            lanes: vec![1, 8],
            windows: vec![
                Windows { bodies: 150, count: 10, steps: 20, baselines: Begin::Own },
                // To settle by themselves takes them half of a quick report.
                Windows { bodies: 1000, count: 2, steps: 10, baselines: Begin::Ours { steps: REST_STEPS } },
            ],
        }
    }

    /// How often [`run`] calls its `tick`.
    pub fn rounds(&self) -> u64 {
        (Mix::ALL.len() * self.windows.len()) as u64
    }
}

/// A contestant and its samples.
struct Entry {
    integrator: Integrator,
    engine: &'static str,
    lanes: usize,
    substeps: u32,
    start: &'static str,
    contestant: Contestant,
    samples_ms: Vec<f64>,
}

/// Times every engine on every mix.
///
/// # Errors
/// A scene that cannot be run; lane widths that disagree on the state; what `tick` says.
pub fn run(plan: &Plan, tick: &mut dyn FnMut() -> anyhow::Result<()>) -> anyhow::Result<Vec<Row>> {
    let mut rows = Vec::new();
    for windows in &plan.windows {
        for shapes in Mix::ALL {
            let mut entries = line_up(plan, shapes, windows)?;
            for _ in 0..windows.count {
                for entry in &mut entries {
                    // The baselines' pair loop takes most of a second per step at ten thousand bodies.
                    let slow = entry.engine != "lamina2d" && windows.bodies > 1000;
                    let steps = if slow { 1 } else { windows.steps };
                    entry.contestant.window(steps, &mut entry.samples_ms)?;
                }
            }
            check_widths(shapes, &entries)?;
            rows.extend(entries.iter().map(|entry| row(shapes, windows, entry)));
            tick()?;
        }
    }
    Ok(rows)
}

fn line_up(plan: &Plan, shapes: Mix, windows: &Windows) -> anyhow::Result<Vec<Entry>> {
    let scene = mix(shapes, windows.bodies, 1);
    let mut settled = simulate(&scene, Settings::default())?;
    // Ten thousand bodies fall for seven seconds before they can begin to settle.
    let large = windows.bodies > 1000;
    let (steps, by_us) = if large {
        (3 * SETTLE_STEPS, "1800 steps of lamina2d")
    } else {
        (SETTLE_STEPS, "600 steps of lamina2d")
    };
    for _ in 0..steps {
        settled.step(super::DT_SECS)?;
    }
    let mut entries = Vec::new();
    for &integrator in &plan.integrators {
        let all_widths = plan.lanes.iter().map(|&lanes| (lanes, Settings::default().substeps));
        let few = (integrator == HEADLINE_INTEGRATOR).then_some((8, FEW_SUBSTEPS));
        for (lanes, substeps) in all_widths.chain(few) {
            let settings = Settings { integrator, substeps, lanes, ..Settings::default() };
            let mut world = settled.with_settings(settings)?;
            // A new world knows no impulses, and other substeps sag otherwise.
            for _ in 0..REST_STEPS {
                world.step(super::DT_SECS)?;
            }
            entries.push(Entry {
                integrator,
                engine: "lamina2d",
                lanes,
                substeps,
                start: by_us,
                contestant: Contestant::Ours(world),
                samples_ms: Vec::new(),
            });
        }
    }
    let all = [ThesisIntegrator::Euler, ThesisIntegrator::Verlet, ThesisIntegrator::Rk4];
    // At 1000 bodies settling all of them would take longer than all else together.
    let baselines = if windows.bodies <= 150 { &all[..] } else { &all[..1] };
    let (from, own_steps) = match windows.baselines {
        Begin::Own => (scene, SETTLE_STEPS),
        Begin::Ours { steps } => (posed(&scene, settled.as_ref()), steps),
    };
    for &integrator in baselines {
        for (engine, version) in [("thesis", Version::Faithful), ("tidy", Version::Tidy)] {
            let mut contestant = Contestant::baseline(&from, integrator, version, true)?;
            contestant.steps(own_steps)?;
            let start = windows.baselines.name(by_us);
            let integrator = integrator_of(integrator);
            entries.push(Entry {
                integrator,
                engine,
                lanes: 1,
                substeps: 1,
                start,
                contestant,
                samples_ms: Vec::new(),
            });
        }
    }
    Ok(entries)
}

/// The check of this benchmark: all widths of one integrator end in the same bits.
fn check_widths(shapes: Mix, entries: &[Entry]) -> anyhow::Result<()> {
    for pair in entries.windows(2) {
        let same_run =
            pair.iter().all(|e| e.engine == "lamina2d" && e.substeps == Settings::default().substeps)
                && pair[0].integrator == pair[1].integrator;
        if same_run && pair[0].contestant.hash() != pair[1].contestant.hash() {
            let [a, b] = [pair[0].lanes, pair[1].lanes];
            anyhow::bail!(
                "{}, {}: lanes {a} and {b} ended in different states",
                shapes.name(),
                pair[0].integrator
            );
        }
    }
    Ok(())
}

fn row(shapes: Mix, windows: &Windows, entry: &Entry) -> Row {
    let overlap = entry.contestant.penetration();
    Row {
        mix: shapes.name().to_owned(),
        integrator: entry.integrator.name().to_owned(),
        bodies: windows.bodies,
        engine: entry.engine.to_owned(),
        lanes: entry.lanes,
        substeps: entry.substeps,
        ms_per_step: Timing::of(&entry.samples_ms),
        contacts: entry.contestant.contacts(),
        max_penetration: overlap.max,
        mean_penetration: overlap.mean,
        hash: format!("{:016x}", entry.contestant.hash()),
        start: entry.start,
    }
}
