//! The cheapest settings that keep a scene's error under a bound, and under which it comes out as it does in a converged run
//! (`accord`).
//!
//! Candidates are tried from the least work to the most: rounds per second times what the integrator and the solver take,
//! roughly. What work costs is learnt from the runs themselves, so that candidates which must be slower than one that
//! was good enough are not run at all. The best are then timed again, in turns, and told by their medians.

mod accord;
mod metric;

use std::time::{Duration, Instant};

use anyhow::ensure;
use serde::Serialize;

use lamina2d::scene::Scene;
use lamina2d::settings::{Integrator, Precision, Settings, Solver};
use lamina2d::simulation::{Simulation, simulate};

use crate::present::median;

use metric::Judge;
pub use metric::Metric;

/// Steps per second that are tried.
const RATES: [u32; 6] = [30, 60, 120, 240, 480, 960];
/// Rounds per step that are tried where bodies touch or are joined.
const SUBSTEPS: [u32; 6] = [1, 2, 4, 8, 16, 32];
/// Stiffnesses of soft contacts that are tried beside the default, hz·h.
const STIFFNESSES: [Option<f64>; 3] = [None, Some(0.09), Some(0.25)];
/// A candidate is left out if it must take so many times as long as the best.
const TOO_SLOW: f64 = 2.5;
/// Candidates that are timed again.
const FINALISTS: usize = 6;
/// Windows of each.
const WINDOWS: usize = 5;

/// What is asked.
#[derive(Clone, Debug)]
pub struct Question {
    /// The scene as the command line names it, and its seed: what the commands in the answer begin with.
    pub given: String,
    /// What counts as error.
    pub metric: Metric,
    /// It must not be larger, in the metric's unit.
    pub max_error: f64,
    /// Simulated seconds.
    pub horizon_secs: f64,
    /// Real seconds after which no further candidate is begun.
    pub budget_secs: f64,
}

/// Settings that were tried, and how they did.
#[derive(Clone, Debug, Serialize)]
pub struct Tried {
    /// Smooth motion.
    pub integrator: Integrator,
    /// Contacts and joints; null where nothing touches and nothing is joined.
    pub solver: Option<Solver>,
    /// Seconds per step.
    pub h: f64,
    /// Rounds per step.
    pub substeps: u32,
    /// Of soft contacts, hz·h; null for the default or where there are none.
    pub stiffness: Option<f64>,
    /// The scalar.
    pub precision: Precision,
    /// In the metric's unit; null where the run ended in a state that is not finite.
    pub error: Option<f64>,
    /// Does the scene come out as in a converged run?
    pub agrees: bool,
    /// What is first otherwise, and when.
    pub differs: Option<String>,
    /// Run time per simulated second, ns: once, or the median of several.
    pub ns_per_simulated_second: f64,
    /// The command line that runs it.
    pub command: String,
}

/// What came of it.
#[derive(Clone, Debug, Serialize)]
pub struct Answer {
    /// The scene.
    pub scene: String,
    /// What counted as error.
    pub metric: &'static str,
    /// Its unit.
    pub unit: &'static str,
    /// The bound.
    pub max_error: f64,
    /// Simulated seconds.
    pub seconds: f64,
    /// Is there one that meets it?
    pub met: bool,
    /// Those that meet it, the cheapest first; where none does, those that come nearest.
    pub best: Vec<Tried>,
    /// The default settings on this scene, timed beside the best.
    pub default: Tried,
    /// Settings that were run.
    pub tried: usize,
    /// Of those, how many kept the error but came out otherwise than a converged run.
    pub disagreed: usize,
    /// Settings that were left out since they had to be slower than the best.
    pub too_slow: usize,
    /// Settings that were left out for want of time.
    pub not_tried: usize,
}

#[derive(Clone, Copy, Debug)]
struct Candidate {
    integrator: Integrator,
    solver: Option<Solver>,
    rate: u32,
    substeps: u32,
    stiffness: Option<f64>,
    precision: Precision,
}

impl Tried {
    /// Is the error under a bound?
    fn keeps(&self, max_error: f64) -> bool {
        self.error.is_some_and(|error| error <= max_error)
    }
    /// Is it, and does the scene come out right?
    fn is_good(&self, max_error: f64) -> bool {
        self.agrees && self.keeps(max_error)
    }
}

impl Candidate {
    /// The default settings, by the scene's own step.
    fn default_of(scene: &Scene, held: bool) -> Self {
        let Settings { integrator, solver, substeps, precision, .. } = Settings::default();
        Self {
            integrator,
            solver: held.then_some(solver),
            rate: (1.0 / scene.dt_secs).round().max(1.0) as u32,
            substeps,
            stiffness: None,
            precision,
        }
    }

    fn settings(&self, steps: u32, horizon_secs: f64) -> Settings {
        let default = Settings::default();
        Settings {
            dt_secs: horizon_secs / f64::from(steps),
            integrator: self.integrator,
            solver: self.solver.unwrap_or(default.solver),
            substeps: self.substeps,
            stiffness: self.stiffness,
            ..default.with_precision(self.precision)
        }
    }

    /// Steps to the horizon.
    fn steps(&self, horizon_secs: f64) -> u32 {
        ((horizon_secs * f64::from(self.rate)).round() as u32).max(1)
    }

    /// Roughly, in rounds of a simple scheme per simulated second; finding contacts once a step counts as two.
    fn work(&self) -> f64 {
        let stages = match self.integrator {
            Integrator::Rk4 => 1.6,
            Integrator::Yoshida4 => 1.4,
            _ => 1.0,
        };
        let wide = if self.precision == Precision::F64 { 1.6 } else { 1.0 };
        let found = if self.solver.is_some() { 2.0 } else { 0.3 };
        f64::from(self.rate) * (found + f64::from(self.substeps) * stages) * wide
    }
}

fn candidates(held: bool) -> Vec<Candidate> {
    let (solvers, substeps): (Vec<_>, &[u32]) = if held {
        let stiffnesses = |solver: Solver| if solver == Solver::Soft { &STIFFNESSES[..] } else { &[None] };
        let of =
            |&solver: &Solver| stiffnesses(solver).iter().map(move |&stiffness| (Some(solver), stiffness));
        (Solver::ALL.iter().flat_map(of).collect(), &SUBSTEPS)
    } else {
        // Rounds of free motion are shorter steps.
        (vec![(None, None)], &SUBSTEPS[..1])
    };
    let mut all = Vec::new();
    for &integrator in Integrator::ALL {
        for &(solver, stiffness) in &solvers {
            for rate in RATES {
                for &substeps in substeps {
                    for precision in [Precision::F32, Precision::F64] {
                        all.push(Candidate { integrator, solver, rate, substeps, stiffness, precision });
                    }
                }
            }
        }
    }
    all.sort_by(|a, b| a.work().total_cmp(&b.work()));
    all
}

/// Finds the cheapest settings for a scene; `tell` hears how many candidates have been dealt with, and of how many.
///
/// # Errors
/// A scene that cannot be run, or that the metric says nothing of.
pub fn tune(
    scene: &Scene,
    question: &Question,
    mut tell: impl FnMut(usize, usize),
) -> anyhow::Result<Answer> {
    let horizon_secs = question.horizon_secs;
    // Steps of another length do what is due at the same times.
    let scene = &scene.timed();
    ensure!(
        horizon_secs > 0.0 && horizon_secs.is_finite(),
        "--seconds must be positive and finite, got {horizon_secs}"
    );
    let judge = Judge::new(scene, question.metric, horizon_secs)?;
    if let Some(unsure) = judge.unsure().filter(|unsure| 3.0 * unsure > question.max_error) {
        anyhow::bail!(
            "the reference of {} is itself unsure by {unsure:.1e} {}: ask for fewer --seconds, a larger --max-error or another --metric",
            question.metric,
            question.metric.unit()
        );
    }
    let default = Candidate::default_of(scene, judge.is_held());
    let all = candidates(judge.is_held());
    let (begin, budget) = (Instant::now(), Duration::from_secs_f64(question.budget_secs));
    let (mut tried, mut best_ns) = (Vec::new(), f64::INFINITY);
    let (mut too_slow, mut not_tried, mut ns_per_work) = (0, 0, f64::INFINITY);
    for (at, candidate) in all.iter().enumerate() {
        tell(at, all.len());
        if candidate.work() * ns_per_work > TOO_SLOW * best_ns {
            too_slow += 1;
        } else if begin.elapsed() > budget {
            not_tried += 1;
        } else {
            let run = run(scene, question, candidate, &judge)?;
            if run.is_good(question.max_error) {
                best_ns = best_ns.min(run.ns_per_simulated_second);
            }
            // The least that a unit of work was seen to take: what is left out would have had to do better yet.
            ns_per_work = ns_per_work.min(run.ns_per_simulated_second / candidate.work());
            tried.push((*candidate, run));
        }
    }
    let mut best = select(tried.clone(), question.max_error);
    let met = best.first().is_some_and(|(_, run)| run.is_good(question.max_error));
    let mut beside = [(default, run(scene, question, &default, &judge)?)];
    if met {
        time_again(scene, &mut best, &mut beside, horizon_secs)?;
    }
    let [(_, default)] = beside;
    let disagreed = tried.iter().filter(|(_, run)| run.keeps(question.max_error) && !run.agrees).count();
    Ok(Answer {
        scene: scene.name.clone(),
        metric: question.metric.name(),
        unit: question.metric.unit(),
        max_error: question.max_error,
        seconds: horizon_secs,
        met,
        best: best.into_iter().map(|(_, run)| run).collect(),
        default,
        tried: tried.len(),
        disagreed,
        too_slow,
        not_tried,
    })
}

/// The fastest that meet the bound, or those that come nearest.
fn select(mut tried: Vec<(Candidate, Tried)>, max_error: f64) -> Vec<(Candidate, Tried)> {
    let error = |run: &Tried| run.error.unwrap_or(f64::INFINITY);
    let good: Vec<_> = tried.iter().filter(|(_, run)| run.is_good(max_error)).cloned().collect();
    if good.is_empty() {
        // Of those that come out right, if there are any.
        tried.sort_by(|(_, a), (_, b)| b.agrees.cmp(&a.agrees).then(error(a).total_cmp(&error(b))));
    } else {
        tried = good;
        tried.sort_by(|a, b| a.1.ns_per_simulated_second.total_cmp(&b.1.ns_per_simulated_second));
    }
    tried.truncate(FINALISTS);
    tried
}

/// The error of a candidate, and what its steps took.
fn run(scene: &Scene, question: &Question, candidate: &Candidate, judge: &Judge) -> anyhow::Result<Tried> {
    let horizon_secs = question.horizon_secs;
    let steps = candidate.steps(horizon_secs);
    let settings = candidate.settings(steps, horizon_secs);
    let mut world = simulate(scene, settings)?;
    let mut case = judge.begin(world.as_ref());
    let (mut taken, mut broken) = (Duration::ZERO, false);
    for step in 1..=steps {
        let begin = Instant::now();
        broken = world.step(settings.dt_secs).is_err();
        taken += begin.elapsed();
        if broken {
            break;
        }
        case.look(world.as_ref(), f64::from(step) / f64::from(steps));
    }
    let error = Some(case.error()).filter(|error| !broken && error.is_finite());
    let differs = if broken { Some("the run broke off".to_owned()) } else { case.differs() };
    Ok(Tried {
        integrator: candidate.integrator,
        solver: candidate.solver,
        h: settings.dt_secs,
        substeps: candidate.substeps,
        stiffness: candidate.stiffness,
        precision: candidate.precision,
        error,
        agrees: differs.is_none(),
        differs,
        ns_per_simulated_second: taken.as_nanos() as f64 / horizon_secs,
        command: command(question, candidate, &settings, steps),
    })
}

fn command(question: &Question, candidate: &Candidate, settings: &Settings, steps: u32) -> String {
    let solver = candidate.solver.map_or_else(String::new, |solver| format!(" --solver {solver}"));
    let stiffness = candidate.stiffness.map_or_else(String::new, |share| format!(" --stiffness {share}"));
    format!(
        "lamina run {} --steps {steps} --dt {} --integrator {}{solver} --substeps {}{stiffness} --precision {}",
        question.given, settings.dt_secs, settings.integrator, settings.substeps, settings.precision
    )
}

/// Times the finalists, and what stands beside them, in turns and sorts them by their medians.
fn time_again(
    scene: &Scene,
    best: &mut [(Candidate, Tried)],
    beside: &mut [(Candidate, Tried)],
    horizon_secs: f64,
) -> anyhow::Result<()> {
    let mut samples = vec![Vec::new(); best.len() + beside.len()];
    // What broke off once is not timed.
    let whole = |run: &Tried| run.error.is_some();
    for _ in 0..WINDOWS {
        let all = best.iter().chain(&*beside).zip(&mut samples);
        for ((candidate, _), samples) in all.filter(|((_, run), _)| whole(run)) {
            let steps = candidate.steps(horizon_secs);
            let settings = candidate.settings(steps, horizon_secs);
            let mut world: Box<dyn Simulation> = simulate(scene, settings)?;
            let begin = Instant::now();
            for _ in 0..steps {
                world.step(settings.dt_secs)?;
            }
            samples.push(begin.elapsed().as_nanos() as f64 / horizon_secs);
        }
    }
    let all = best.iter_mut().chain(beside).zip(&samples);
    for ((_, run), samples) in all.filter(|(_, samples)| !samples.is_empty()) {
        run.ns_per_simulated_second = median(samples);
    }
    best.sort_by(|a, b| a.1.ns_per_simulated_second.total_cmp(&b.1.ns_per_simulated_second));
    Ok(())
}
