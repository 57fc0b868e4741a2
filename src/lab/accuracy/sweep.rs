//! Runs for errors, and others for times.

use std::time::Instant;

use anyhow::ensure;
use serde::Serialize;

use lamina2d::scene::{BodySpec, Scene, ShapeSpec};
use lamina2d::settings::{Precision, Settings};
use lamina2d::simulation::{Simulation, simulate};
use lamina2d::world::StepError;

use super::case::{Case, Expect, Method, Norm, Reference, Sweep};
use super::contact::Trial;
use super::norm::{Start, movable};
use super::order::{Order, TOLERANCE};
use crate::present::median;

/// Copies of a single body that are timed together: a whole number of blocks at every width.
pub const CROWD: usize = 64;
/// From copy to copy, metres, and the radius of each.
const PITCH_M: f64 = 4e-5;
const RADIUS_M: f64 = 1e-5;

/// Steps of A6.
pub(super) const LIMIT_STEPS: u32 = 1000;
/// Shares of the longest stable step.
const SHARES: [f64; 4] = [0.5, 0.9, 0.99, 1.01];

/// How much is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Effort {
    /// Fewer steps and the usual lane widths alone.
    pub quick: bool,
    /// A full sweep's steps for the mixes, of which a quick one has a single one: two make a line.
    pub mixes: bool,
    /// Windows timed per row.
    pub repeats: u32,
    /// Steps per window, at most.
    pub window: u32,
}

impl Effort {
    /// Under half an hour.
    pub const FULL: Self = Self { quick: false, mixes: true, repeats: 7, window: 200 };
    /// Under three minutes.
    pub const QUICK: Self = Self { quick: true, mixes: false, repeats: 4, window: 60 };
    /// A quick one with lines for the mixes that are drawn.
    pub const REPORT: Self = Self { mixes: true, ..Self::QUICK };

    /// Lane widths that are run.
    fn widths(self, precision: Precision) -> Vec<usize> {
        let usual = Settings::default().with_precision(precision).lanes;
        if self.quick { vec![usual] } else { Settings::widths(precision).to_vec() }
    }
}

/// One run: the rows of the JSON and CSV files.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Row {
    /// Its name.
    pub case: &'static str,
    /// In words.
    pub method: String,
    /// Smooth motion.
    pub integrator: &'static str,
    /// Joints and contacts; null where there are none.
    pub solver: Option<&'static str>,
    /// Seconds per step.
    pub h: f64,
    /// Rounds per step.
    pub substeps: u32,
    /// Of soft contacts, hz·h; null for the default or where there are none.
    pub stiffness: Option<f64>,
    /// The scalar.
    pub precision: &'static str,
    /// Numbers per vector.
    pub lanes: usize,
    /// In `error_unit`; null where the run ended in a state that is not finite.
    pub error: Option<f64>,
    /// Its unit.
    pub error_unit: &'static str,
    /// The fastest window, per step and copy.
    pub ns_per_step: Option<f64>,
    /// That times the steps to the horizon.
    pub ns_total: Option<f64>,
    /// The order observed in `f64`, the same for all rows of a method; null where none shows.
    pub order: Option<f64>,
    /// What is expected.
    pub target: String,
    /// Was it met? null where it says nothing of this row's precision, or a quick sweep stops before it could tell.
    pub met: Option<bool>,
    /// Counted by callgrind, per step and copy; null where nothing was counted.
    pub instructions_per_step: Option<f64>,
    /// That times the steps to the horizon.
    pub instructions_total: Option<f64>,
    /// Of all windows.
    #[serde(skip)]
    pub median_ns_per_step: Option<f64>,
}

/// A case and its rows.
#[derive(Clone, Debug)]
pub struct Results {
    /// The case.
    pub case: &'static Case,
    /// Its rows: methods in order, precisions, widths, from the longest step to the shortest.
    pub rows: Vec<Row>,
    /// How sure its reference is, in the error's unit.
    pub floor: f64,
    /// Errors below are not plotted; see [`Reference::gate`].
    pub gate: f64,
}

impl Results {
    /// Rows that came to their end with an error the reference can tell.
    pub fn told(&self) -> impl Iterator<Item = &Row> {
        self.rows.iter().filter(|row| row.error.is_some_and(|error| error >= self.gate))
    }
}

/// Runs a case with every method, step, precision and width.
///
/// # Errors
/// A scene that cannot be run, widths that differ in a bit.
pub fn measure(case: &'static Case, effort: Effort) -> anyhow::Result<Results> {
    let bench = Bench::of(case, effort)?;
    let mut rows = Vec::new();
    for &(method, expect) in case.methods {
        bench.method(method, expect, &mut rows)?;
    }
    let Reference { floor, gate, .. } = bench.reference;
    Ok(Results { case, rows, floor, gate })
}

/// The error of one run of a contact case at these settings, over so many seconds or the case's own; `None` where it did
/// not stay finite.
///
/// # Errors
/// A scene that cannot be run, a case that is not one of contact.
pub fn once(case: &Case, settings: Settings, secs: Option<f64>) -> anyhow::Result<Option<f64>> {
    let Norm::Own(experiment) = case.norm else { anyhow::bail!("{} is no case of contact", case.name) };
    let scene = case.scene()?;
    match experiment(&Trial { scene: &scene, settings, secs: secs.unwrap_or(case.horizon_secs) }) {
        Ok(error) => Ok(Some(error).filter(|error| error.is_finite())),
        Err(broken) if broken.is::<StepError>() => Ok(None),
        Err(other) => Err(other),
    }
}

/// What a method showed in `f64`.
#[derive(Clone, Debug)]
pub struct Observed {
    /// The method.
    pub method: Method,
    /// What is expected of it.
    pub expect: Expect,
    /// Seconds per step and error, from the longest step on; no error where the run did not stay finite.
    pub errors: Vec<(f64, Option<f64>)>,
    /// The order they show.
    pub order: Option<Order>,
    /// Was what is expected met at every step?
    pub met: bool,
}

/// The errors of a full sweep in `f64` at the usual width, and nothing timed.
///
/// # Errors
/// A scene that cannot be run.
pub fn observe(case: &'static Case) -> anyhow::Result<Vec<Observed>> {
    let scene = case.scene()?;
    let reference = case.reference(&scene);
    let bench = Bench { case, effort: Effort::FULL, timed: (scene.clone(), 1), scene, reference };
    let of = |&(method, expect): &(Method, Expect)| {
        let settings = Settings { continuous: false, ..Settings::default().with_precision(Precision::F64) };
        let (settings, paces) = (method.settings(settings), bench.paces(method));
        let errors: Vec<_> =
            paces.iter().map(|&pace| bench.error(settings, pace)).collect::<Result<_, _>>()?;
        let order = bench.order(&paces, &errors);
        let line = Line { bench: &bench, method, expect, settings, order };
        let finest = errors.last().copied().flatten();
        let met = |(&pace, &error): (&Pace, &Option<f64>)| line.met(pace, error, finest) == Some(true);
        let met = paces.iter().zip(&errors).all(met);
        let errors = paces.iter().map(|pace| pace.h_secs).zip(errors).collect();
        Ok(Observed { method, expect, errors, order, met })
    };
    case.methods.iter().map(of).collect()
}

/// A case under measurement.
pub(super) struct Bench {
    pub(super) case: &'static Case,
    effort: Effort,
    scene: Scene,
    /// The scene that is timed, and how many copies of the case it holds.
    pub(super) timed: (Scene, usize),
    reference: Reference,
}

/// A step, and how many of it.
#[derive(Clone, Copy)]
pub(super) struct Pace {
    pub(super) h_secs: f64,
    pub(super) steps: u32,
    /// Of the longest stable step, where the sweep is one of limits.
    share: f64,
}

impl Bench {
    pub(super) fn of(case: &'static Case, effort: Effort) -> anyhow::Result<Self> {
        let scene = case.scene()?;
        let reference = case.reference(&scene);
        Ok(Self { case, effort, timed: crowd(&scene), scene, reference })
    }

    /// The settings of a method; lanes and precision are those of `settings`.
    pub(super) fn settings(&self, method: Method, settings: Settings) -> Settings {
        method.settings(Settings { continuous: self.case.is_contact(), ..settings })
    }

    fn method(&self, method: Method, expect: Expect, rows: &mut Vec<Row>) -> anyhow::Result<()> {
        let paces = self.paces(method);
        let mut order = None;
        // f64 first: the order is observed there.
        for precision in [Precision::F64, Precision::F32] {
            let mut errors = Vec::new();
            for (k, lanes) in self.effort.widths(precision).into_iter().enumerate() {
                let settings = self.settings(method, Settings { lanes, precision, ..Settings::default() });
                if k == 0 {
                    errors =
                        paces.iter().map(|&pace| self.error(settings, pace)).collect::<Result<_, _>>()?;
                } else {
                    // Widths agree to the bit, or all else here is wrong: seen once each, on the longest steps.
                    let found = self.error(settings, paces[0])?;
                    ensure!(
                        Some(&found) == errors.first(),
                        "{}: {method} at {lanes} lanes has other bits",
                        self.case.name
                    );
                }
                if k == 0 && precision == Precision::F64 {
                    order = self.order(&paces, &errors);
                }
                let line = Line { bench: self, method, expect, settings, order };
                for (&pace, &error) in paces.iter().zip(&errors) {
                    rows.push(line.row(pace, error, errors.last().copied().flatten())?);
                }
            }
        }
        Ok(())
    }

    /// Does the sweep go down to the shortest steps, which expectations speak of?
    fn is_whole(&self) -> bool {
        match self.case.sweep {
            Sweep::Halvings { quick, full, .. } => self.halvings(quick, full) == full,
            Sweep::Limits { .. } => true,
        }
    }

    fn halvings(&self, quick: u32, full: u32) -> u32 {
        let short = self.effort.quick && !(self.effort.mixes && self.case.is_mix());
        if short { quick } else { full }
    }

    pub(super) fn paces(&self, method: Method) -> Vec<Pace> {
        match self.case.sweep {
            Sweep::Halvings { coarsest, quick, full } => {
                let halvings = self.halvings(quick, full);
                let of = |k| {
                    let steps = coarsest << k;
                    Pace { h_secs: self.case.horizon_secs / f64::from(steps), steps, share: 0.0 }
                };
                (0..=halvings).map(of).collect()
            }
            Sweep::Limits { rate, limits } => {
                let limit = limits[method.integrator as usize];
                let of = |share| Pace { h_secs: share * limit / rate, steps: LIMIT_STEPS, share };
                SHARES.into_iter().map(of).collect()
            }
        }
    }

    fn order(&self, paces: &[Pace], errors: &[Option<f64>]) -> Option<Order> {
        if matches!(self.case.sweep, Sweep::Limits { .. }) {
            return None;
        }
        // Lines may begin with gaps, where steps are too long to stay finite.
        let points = paces.iter().zip(errors).skip_while(|(_, error)| error.is_none());
        let points: Vec<_> = points.map_while(|(pace, error)| Some((pace.h_secs, (*error)?))).collect();
        Order::of(&points, self.case.horizon_secs, self.reference.floor)
    }

    /// The error of a run; `None` where it ended in a state that is not finite.
    fn error(&self, settings: Settings, pace: Pace) -> anyhow::Result<Option<f64>> {
        if self.case.is_contact() {
            return once(self.case, Settings { dt_secs: pace.h_secs, ..settings }, None);
        }
        let mut world = simulate(&self.scene, Settings { dt_secs: pace.h_secs, ..settings })?;
        let (start, norm) = (Start::of(world.as_ref()), self.case.norm);
        let per_sample = pace.steps / self.case.samples;
        let mut worst = 0.0f64;
        for step in 1..=pace.steps {
            if world.step(pace.h_secs).is_err() {
                return Ok(None);
            }
            if norm.at_every_step() {
                worst = worst.max(norm.error(world.as_ref(), &start, &[]));
            } else if step % per_sample == 0 {
                let exact = &self.reference.course[(step / per_sample) as usize - 1];
                worst = worst.max(norm.error(world.as_ref(), &start, exact));
            }
        }
        Ok(Some(worst).filter(|error| error.is_finite()))
    }

    /// Steps of a window: all where what is to be done changes on the way, as bodies fall and come to rest.
    fn window(&self, pace: Pace) -> u32 {
        if self.case.is_mix() { pace.steps } else { pace.steps.min(self.effort.window) }
    }

    /// The fastest and the median window, ns per step and copy; `None` where a window did not stay finite.
    fn time(&self, settings: Settings, pace: Pace) -> anyhow::Result<Option<[f64; 2]>> {
        let (scene, copies) = &self.timed;
        let fresh = simulate(scene, Settings { dt_secs: pace.h_secs, ..settings })?;
        let steps = self.window(pace);
        let mut samples = Vec::new();
        // Whole runs are long enough by twos.
        let repeats = if self.case.is_mix() { self.effort.repeats / 2 } else { self.effort.repeats };
        // The first window warms up.
        for window in 0..=repeats {
            let mut world = fresh.duplicate();
            let Some(ns) = window_ns(world.as_mut(), pace.h_secs, steps) else { return Ok(None) };
            if window > 0 {
                samples.push(ns / f64::from(steps) / *copies as f64);
            }
        }
        let fastest = samples.iter().copied().fold(f64::INFINITY, f64::min);
        Ok(Some([fastest, median(&samples)]))
    }
}

/// Time of so many steps, ns; `None` where one failed.
fn window_ns(world: &mut dyn Simulation, h_secs: f64, steps: u32) -> Option<f64> {
    let start = Instant::now();
    for _ in 0..steps {
        world.step(h_secs).ok()?;
    }
    Some(start.elapsed().as_nanos() as f64)
}

/// A method at one precision and width.
struct Line<'a> {
    bench: &'a Bench,
    method: Method,
    expect: Expect,
    settings: Settings,
    order: Option<Order>,
}

impl Line<'_> {
    fn row(&self, pace: Pace, error: Option<f64>, finest: Option<f64>) -> anyhow::Result<Row> {
        let Self { bench, method, settings, .. } = self;
        let time = if error.is_some() { bench.time(*settings, pace)? } else { None };
        Ok(Row {
            case: bench.case.name,
            method: method.to_string(),
            integrator: method.integrator.name(),
            solver: method.solver.map(lamina2d::settings::Solver::name),
            h: pace.h_secs,
            substeps: method.substeps,
            stiffness: method.stiffness,
            precision: settings.precision.name(),
            lanes: settings.lanes,
            error,
            error_unit: bench.case.unit,
            ns_per_step: time.map(|ns| ns[0]),
            ns_total: time.map(|ns| ns[0] * f64::from(pace.steps)),
            order: self.order.map(|order| order.order),
            target: self.target(pace),
            met: self.met(pace, error, finest),
            instructions_per_step: None,
            instructions_total: None,
            median_ns_per_step: time.map(|ns| ns[1]),
        })
    }

    fn target(&self, pace: Pace) -> String {
        match self.expect {
            Expect::Limit if self.grows(pace) => "grows".to_owned(),
            Expect::Limit => "bounded".to_owned(),
            expect => expect.to_string(),
        }
    }

    /// Beyond the limit, and explicit Euler at any step.
    fn grows(&self, pace: Pace) -> bool {
        pace.share > 1.0 || self.method.integrator == lamina2d::settings::Integrator::ExplicitEuler
    }

    fn met(&self, pace: Pace, error: Option<f64>, finest: Option<f64>) -> Option<bool> {
        let epsilon = match self.settings.precision {
            Precision::F32 => f64::from(f32::EPSILON),
            Precision::F64 => f64::EPSILON,
        };
        let in_f64 = self.settings.precision == Precision::F64;
        match self.expect {
            Expect::Order(_) | Expect::AtMost(_) | Expect::AtLeast(_)
                if !in_f64 || !self.bench.is_whole() =>
            {
                None
            }
            Expect::Order(wanted) => {
                Some(self.order.is_some_and(|got| (got.order - wanted).abs() <= TOLERANCE))
            }
            Expect::Exact(times) => {
                Some(error.is_some_and(|error| error <= times * f64::from(pace.steps) * epsilon))
            }
            Expect::Target(most) => Some(error.is_some_and(|error| error <= most)),
            Expect::AtMost(most) => Some(finest.is_some_and(|error| error <= most)),
            // What has left the numbers is as far off as can be.
            Expect::AtLeast(least) => Some(finest.is_none_or(|error| error >= least)),
            // A run that left the numbers has grown.
            Expect::Limit if self.grows(pace) => Some(error.is_none_or(|growth| growth > 1.04)),
            Expect::Limit => Some(error.is_some_and(|growth| growth < 30.0)),
        }
    }
}

/// Copies of a scene of one body without joints, in a square of points that never meet; other scenes as they are.
fn crowd(scene: &Scene) -> (Scene, usize) {
    let one = movable(scene).count() == 1 && scene.bodies.len() == 1 && scene.joints.is_empty();
    let Some(body) = scene.bodies.first().filter(|_| one) else { return (scene.clone(), 1) };
    let copy = |k: usize| {
        let at = |k: usize, along: usize| body.position[along] + k as f64 * PITCH_M;
        let position = [at(k % 8, 0), at(k / 8, 1)];
        BodySpec { shape: ShapeSpec::Circle(RADIUS_M), position, collides_with: 0, ..body.clone() }
    };
    (Scene { bodies: (0..CROWD).map(copy).collect(), ..scene.clone() }, CROWD)
}
