//! What counts as error when a scene is tuned.

use anyhow::{bail, ensure};
use serde::Serialize;

use lamina2d::scene::Scene;
use lamina2d::settings::{Integrator, Precision, Settings, Solver};
use lamina2d::simulation::{Simulation, simulate};

use super::accord::Accord;
use crate::cases::error_of;

/// What counts as error.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, clap::ValueEnum)]
#[serde(rename_all = "snake_case")]
#[value(rename_all = "snake_case")]
pub enum Metric {
    /// Against the scene's closed form, relative: see [`crate::cases::case_error`].
    Case,
    /// The mean overlap over the last quarter, metres.
    Overlap,
    /// The largest overlap at any of 20 times, metres.
    MaxOverlap,
    /// The largest gain of energy over that at the start, at any of 20 times, J.
    EnergyGain,
    /// How far a body is from where a converged run in f64 has it, metres.
    Trajectory,
}

impl Metric {
    /// The name users write.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Case => "case",
            Self::Overlap => "overlap",
            Self::MaxOverlap => "max_overlap",
            Self::EnergyGain => "energy_gain",
            Self::Trajectory => "trajectory",
        }
    }

    /// Of the error.
    pub const fn unit(self) -> &'static str {
        match self {
            Self::Case => "relative",
            Self::Overlap | Self::MaxOverlap | Self::Trajectory => "m",
            Self::EnergyGain => "J",
        }
    }

    /// The one that says most of a scene: its closed form, overlaps where bodies touch, a converged run else.
    ///
    /// # Errors
    /// A scene that cannot be run.
    pub fn of(scene: &Scene, horizon_secs: f64) -> anyhow::Result<Self> {
        let world = simulate(scene, Settings::default())?;
        Ok(if error_of(world.as_ref(), scene, horizon_secs).is_some() {
            Self::Case
        } else if touches(scene, horizon_secs)? {
            Self::Overlap
        } else {
            Self::Trajectory
        })
    }
}

impl std::fmt::Display for Metric {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.pad(self.name())
    }
}

/// Does anything touch within the horizon, at default settings?
fn touches(scene: &Scene, horizon_secs: f64) -> anyhow::Result<bool> {
    let settings = Settings { dt_secs: scene.dt_secs, ..Settings::default() };
    let mut world = simulate(scene, settings)?;
    for _ in 0..(horizon_secs / scene.dt_secs).round() as u64 {
        world.step(settings.dt_secs)?;
        if world.counts().contacts > 0 {
            return Ok(true);
        }
    }
    Ok(false)
}

/// Times at which a run is looked at, spread evenly, the last at the horizon.
const LOOKS: u32 = 20;
/// Steps per second of the converged run; another takes half of that.
const CONVERGED_RATE: f64 = 7680.0;

type Places = Vec<[f64; 2]>;

/// Knows the right answer, as far as the metric needs one.
#[derive(Debug)]
pub(super) struct Judge {
    metric: Metric,
    scene: Scene,
    horizon_secs: f64,
    /// Per look, where bodies must be.
    course: Vec<Places>,
    /// How far two converged runs are apart, metres.
    unsure: Option<f64>,
    held: bool,
    /// What a run must agree with beside; none where the metric itself holds it to the right course.
    accord: Option<Accord>,
}

impl Judge {
    pub(super) fn new(scene: &Scene, metric: Metric, horizon_secs: f64) -> anyhow::Result<Self> {
        let held = !scene.joints.is_empty() || touches(scene, horizon_secs)?;
        let start = simulate(scene, Settings::default())?;
        if metric == Metric::Case && error_of(start.as_ref(), scene, horizon_secs).is_none() {
            bail!(
                "--metric case: scene {} has no closed form; one of overlap, max_overlap, energy_gain, trajectory",
                scene.name
            );
        }
        if matches!(metric, Metric::Overlap | Metric::MaxOverlap) {
            ensure!(held, "--metric {metric}: nothing touches in {} within {horizon_secs} s", scene.name);
        }
        let (course, unsure) = if metric == Metric::Trajectory {
            let [fine, coarse] = [1.0, 0.5].map(|share| converged(scene, horizon_secs, held, share));
            let (fine, coarse) = (fine?, coarse?);
            let apart = fine.iter().zip(&coarse).map(|(a, b)| apart(a, b)).fold(0.0, f64::max);
            (fine, Some(apart))
        } else {
            (Vec::new(), None)
        };
        let is_course = metric == Metric::Trajectory || (metric == Metric::Case && !held);
        let accord = if is_course { None } else { Some(Accord::new(scene, horizon_secs, LOOKS, held)?) };
        Ok(Self { metric, scene: scene.clone(), horizon_secs, course, unsure, held, accord })
    }

    pub(super) fn unsure(&self) -> Option<f64> {
        self.unsure
    }
    /// Is there anything for a solver to do?
    pub(super) fn is_held(&self) -> bool {
        self.held
    }

    pub(super) fn begin(&self, world: &dyn Simulation) -> Hearing<'_> {
        let sums = world.invariants();
        Hearing {
            judge: self,
            energy: sums.kinetic_energy + sums.potential_energy,
            worst: 0.0,
            sum: 0.0,
            looks: 0,
            next: 1,
            differs: None,
        }
    }
}

/// A run under judgement.
#[derive(Debug)]
pub(super) struct Hearing<'a> {
    judge: &'a Judge,
    /// At the start, J.
    energy: f64,
    worst: f64,
    sum: f64,
    looks: u32,
    /// The next look, from 1.
    next: u32,
    differs: Option<String>,
}

impl Hearing<'_> {
    /// Looks at a world after a share of the horizon, if it is time.
    pub(super) fn look(&mut self, world: &dyn Simulation, share: f64) {
        let judge = self.judge;
        if share < f64::from(self.next) / f64::from(LOOKS) - 1e-9 {
            return;
        }
        // A step longer than the time from look to look passes some over.
        let at = ((share * f64::from(LOOKS) + 1e-9) as u32).clamp(self.next, LOOKS);
        self.next = at + 1;
        let on_time = (share * f64::from(LOOKS) - f64::from(at)).abs() < 1e-6;
        if on_time && self.differs.is_none() {
            let accord = judge.accord.as_ref();
            self.differs = accord.and_then(|accord| accord.differs(world, at as usize - 1));
        }
        let error = match judge.metric {
            Metric::Case => error_of(world, &judge.scene, share * judge.horizon_secs),
            Metric::Overlap if at * 4 >= LOOKS * 3 => Some(world.penetration().mean),
            Metric::Overlap => None,
            Metric::MaxOverlap => Some(world.penetration().max),
            Metric::EnergyGain => {
                let sums = world.invariants();
                Some(sums.kinetic_energy + sums.potential_energy - self.energy)
            }
            // Between two looks the reference is not known.
            Metric::Trajectory if !on_time => None,
            Metric::Trajectory => Some(apart(&places(world), &judge.course[at as usize - 1])),
        };
        if let Some(error) = error {
            self.worst = if error.is_nan() { f64::INFINITY } else { self.worst.max(error) };
            self.sum += error;
            self.looks += 1;
        }
    }

    /// What the run had first otherwise than a converged one; `None` where it agreed.
    pub(super) fn differs(&self) -> Option<String> {
        self.differs.clone()
    }

    pub(super) fn error(&self) -> f64 {
        match self.judge.metric {
            Metric::Overlap => self.sum / f64::from(self.looks.max(1)),
            _ => self.worst,
        }
    }
}

fn places(world: &dyn Simulation) -> Places {
    world.states().iter().map(|state| state.position).collect()
}

/// The largest distance of a body in one state from itself in another, metres.
fn apart(a: &Places, b: &Places) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a[0] - b[0]).hypot(a[1] - b[1])).fold(0.0, f64::max)
}

/// Where bodies are at each look, by short steps in f64; `share` of [`CONVERGED_RATE`].
fn converged(scene: &Scene, horizon_secs: f64, held: bool, share: f64) -> anyhow::Result<Vec<Places>> {
    let per_look = ((horizon_secs * CONVERGED_RATE * share) / f64::from(LOOKS)).ceil().max(1.0) as u32;
    let dt_secs = horizon_secs / f64::from(per_look * LOOKS);
    let integrator = if held { Integrator::VelocityVerlet } else { Integrator::Rk4 };
    let exact = Settings { dt_secs, integrator, solver: Solver::Soft, substeps: 1, ..Settings::default() };
    let mut world = simulate(scene, exact.with_precision(Precision::F64))?;
    let mut course = Vec::new();
    for _ in 0..LOOKS {
        for _ in 0..per_look {
            world.step(dt_secs)?;
        }
        course.push(places(world.as_ref()));
    }
    Ok(course)
}
