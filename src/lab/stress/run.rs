//! One run of a case.

use serde::{Deserialize, Serialize};

use lamina2d::scene::Scene;
use lamina2d::settings::{Precision, Settings, Solver};
use lamina2d::simulation::simulate;

use super::case::{Case, Trial};
use super::seen::{Metrics, Seen, Watch};
use crate::present::Record;

/// A case with one solver: the rows of the JSON and CSV files.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// The case.
    pub case: String,
    /// Its item in the list of cases.
    pub item: String,
    /// Contacts and joints.
    pub solver: Solver,
    /// Rounds per step.
    pub substeps: u32,
    /// The scalar.
    pub precision: Precision,
    /// The number the case is a function of.
    pub parameter: String,
    /// What it was, in `unit`.
    pub value: f64,
    /// Its unit.
    pub unit: String,
    /// Does all hold that must?
    pub pass: bool,
    /// What was measured.
    pub metrics: Metrics,
    /// What must hold.
    pub threshold: String,
    /// What was found of it, in the same order; null where it is no number.
    pub found: Vec<Option<f64>>,
    /// The most of each.
    pub most: Vec<f64>,
    /// The number up to which it holds; null where that was not sought, or not even the mildest holds.
    pub limit: Option<f64>,
    /// How far it was sought: `harshest` where the harshest that is tried holds, `none` where not even the mildest does.
    pub limit_note: Option<String>,
    /// Joints that were solved directly: where masses differ too much for visits.
    pub direct_joints: usize,
    /// The most substeps an island had as the run ended: more than `substeps` where a slender stack asked for them.
    pub most_substeps: u32,
    /// Why the run broke off.
    pub failed: Option<String>,
}

impl Row {
    /// The largest share of what is allowed, 0 where all is below nothing; infinite where a run broke off.
    pub fn worst_share(&self) -> f64 {
        let share = |(found, most): (&Option<f64>, &f64)| match found {
            None => f64::INFINITY,
            Some(found) if *most > 0.0 => found / most,
            // Nothing is allowed: each metre or body is one too many.
            Some(found) => 1.0 + found,
        };
        let worst = self.found.iter().zip(&self.most).map(share).fold(0.0, f64::max);
        if self.failed.is_some() { f64::INFINITY } else { worst }
    }
}

/// Runs a case at a number.
///
/// # Errors
/// A scene that cannot be run.
pub fn run(case: &Case, value: f64, settings: Settings, secs: f64) -> anyhow::Result<Row> {
    let trial = Trial { case, value, settings, secs };
    let scene = (case.build)(value);
    let seen = trial.watch(&scene)?;
    let mut found: Vec<f64> = case.checks.iter().map(|check| (check.of)(&seen)).collect();
    let mut most: Vec<f64> = case.checks.iter().map(|check| check.most).collect();
    let mut threshold: Vec<String> =
        case.checks.iter().map(|check| format!("{} <= {}", check.what, check.most)).collect();
    if let Some(own) = case.own {
        let broken = seen.failed.is_some();
        found.push(if broken { f64::NAN } else { (own.of)(&trial, &seen)? });
        most.push(own.most);
        threshold.push(format!("{} <= {}", own.what, own.most));
    }
    let holds = found.iter().zip(&most).all(|(found, most)| found <= most);
    Ok(Row {
        case: case.name.to_owned(),
        item: case.item.to_owned(),
        solver: settings.solver,
        substeps: settings.substeps,
        precision: settings.precision,
        parameter: case.parameter.name.to_owned(),
        value,
        unit: case.parameter.unit.to_owned(),
        pass: seen.failed.is_none() && holds,
        metrics: seen.metrics,
        threshold: threshold.join(", "),
        found: found.into_iter().map(|found| Some(found).filter(|found| found.is_finite())).collect(),
        most,
        limit: None,
        limit_note: None,
        direct_joints: seen.direct_joints,
        most_substeps: seen.most_substeps,
        failed: seen.failed,
    })
}

impl Trial<'_> {
    /// Runs a scene as the case has it.
    pub(super) fn watch(&self, scene: &Scene) -> anyhow::Result<Seen> {
        let positions = self.case.positions.or(self.settings.positions);
        let settings = Settings { dt_secs: scene.dt_secs, positions, ..self.settings };
        let mut world = simulate(scene, settings)?;
        let mut watch = Watch::begin(scene, world.as_ref(), self.secs);
        let (mut secs, mut step) = (0.0, 0);
        while secs < self.secs - 1e-9 {
            if let Some(deed) = self.case.deed {
                deed(world.as_mut(), step)?;
            }
            let h_secs = self.case.pace.map_or(scene.dt_secs, |pace| pace(step));
            if let Err(error) = world.step(h_secs) {
                return Ok(watch.finish(world.as_ref(), Some(error.to_string())));
            }
            (secs, step) = (secs + h_secs, step + 1);
            watch.look(world.as_ref(), secs);
        }
        Ok(watch.finish(world.as_ref(), None))
    }
}

impl Record for Row {
    const NAME: &'static str = "stress";
    const TITLE: &'static str = "Stress: what holds, and up to where";
    const COMMAND: &'static str = "lamina stress --quick";
    const NOTE: &'static str = "Each row of the table of stability with each solver: what must hold, what was found of it, and the number up \
                                to which it holds where that was sought.";
    const HEADER: &'static [&'static str] = &[
        "case",
        "solver",
        "substeps",
        "number",
        "pass",
        "must hold",
        "found",
        "limit",
        "pen mm",
        "jit m/s",
        "drift m",
        "broke off",
    ];

    fn cells(&self) -> Vec<String> {
        let number = |value: f64| format!("{value:.1e}");
        vec![
            self.case.clone(),
            self.solver.to_string(),
            self.substeps.to_string(),
            format!("{} {} {}", self.parameter, self.value, self.unit),
            if self.pass { "yes" } else { "no" }.to_owned(),
            self.threshold.clone(),
            super::tables::found_cell(&self.found),
            super::tables::limit_cell(self),
            format!("{:.2}", self.metrics.pen * 1e3),
            number(self.metrics.jit),
            number(self.metrics.drift),
            self.failed.clone().unwrap_or_else(|| "–".to_owned()),
        ]
    }
}
