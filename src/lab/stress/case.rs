//! What a case is.

use lamina2d::scene::Scene;
use lamina2d::settings::{Precision, Settings};
use lamina2d::simulation::Simulation;

use super::seen::Seen;

/// Which way a number goes until it breaks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Worse {
    /// The larger, the worse.
    Larger,
    /// The smaller, the worse.
    Smaller,
}

/// The number a case is a function of.
#[derive(Clone, Copy, Debug)]
pub struct Parameter {
    /// Its name.
    pub name: &'static str,
    /// Its unit; empty where it has none.
    pub unit: &'static str,
    /// Where the table looks.
    pub value: f64,
    /// Least and most that is tried when a limit is sought.
    pub range: [f64; 2],
    /// Which way it gets worse.
    pub worse: Worse,
    /// It counts something.
    pub whole: bool,
}

/// One thing that must hold.
#[derive(Clone, Copy, Debug)]
pub struct Check {
    /// What, with its unit.
    pub what: &'static str,
    /// The most it may be.
    pub most: f64,
    /// Of a run; NaN fails.
    pub of: fn(&Seen) -> f64,
}

/// What is done between steps: to a world that has taken so many.
pub type Deed = fn(&mut dyn Simulation, u64) -> anyhow::Result<()>;

/// The seconds of a step, by its number: what a case is run with that varies them.
pub type Pace = fn(u64) -> f64;

/// A run of a case, as one that compares runs sees it.
#[derive(Clone, Copy, Debug)]
pub struct Trial<'a> {
    /// The case.
    pub case: &'a Case,
    /// The number it is a function of.
    pub value: f64,
    /// Solver, substeps, precision.
    pub settings: Settings,
    /// Seconds.
    pub secs: f64,
}

/// How a case is judged that compares runs: one number, at most `most`.
#[derive(Clone, Copy, Debug)]
pub struct Own {
    /// What it is, with its unit.
    pub what: &'static str,
    /// The most it may be.
    pub most: f64,
    /// Of a trial, beside the run that is seen.
    pub of: fn(&Trial<'_>, &Seen) -> anyhow::Result<f64>,
}

/// A row of table T.
#[derive(Clone, Copy, Debug)]
pub struct Case {
    /// Its name, as on the command line, and that of its scene.
    pub name: &'static str,
    /// Its item in the list of cases: `T5`.
    pub item: &'static str,
    /// What is asked.
    pub about: &'static str,
    /// The number that is raised until it breaks.
    pub parameter: Parameter,
    /// Simulated seconds, and those of a quick run.
    pub secs: [f64; 2],
    /// The scene at a number.
    pub build: fn(f64) -> Scene,
    /// What is done to it on the way.
    pub deed: Option<Deed>,
    /// Seconds per step, where they are not 1/60.
    pub pace: Option<Pace>,
    /// What must hold of the run.
    pub checks: &'static [Check],
    /// What must hold beside other runs.
    pub own: Option<Own>,
    /// What centroids are kept in, where that is asked.
    pub positions: Option<Precision>,
    /// Why it does not hold with the default solver at 8 substeps, where it does not.
    pub missed: &'static str,
}
