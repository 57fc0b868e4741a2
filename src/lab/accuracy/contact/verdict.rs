//! How many targets of table B are met, each at the settings its case names.

use serde::Serialize;

use lamina2d::settings::Settings;

use super::{named, target};
use crate::accuracy::case::{Case, Method};
use crate::accuracy::sweep::once;

/// A case of table B at the settings it names.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Verdict {
    /// The case.
    pub case: &'static str,
    /// Its item in the list of cases.
    pub item: &'static str,
    /// The solver, in words.
    pub method: String,
    /// Seconds per step.
    pub h: f64,
    /// The scalar.
    pub precision: &'static str,
    /// In `error_unit`; null where the run did not stay finite.
    pub error: Option<f64>,
    /// Its unit.
    pub error_unit: &'static str,
    /// The largest error that meets the target.
    pub target: Option<f64>,
    /// Was it met?
    pub met: bool,
}

/// Runs the cases of contact among some, in their order.
///
/// # Errors
/// A scene that cannot be run.
pub fn verdicts(cases: &[&'static Case]) -> anyhow::Result<Vec<Verdict>> {
    let of = |case: &&'static Case| {
        let settings = named(case);
        let (error, target) = (once(case, settings, None)?, target(case, settings, case.horizon_secs));
        let Settings { integrator, solver, substeps, stiffness, .. } = settings;
        let method = Method { integrator, solver: Some(solver), substeps, stiffness };
        Ok(Verdict {
            case: case.name,
            item: case.item,
            method: method.to_string(),
            h: settings.dt_secs,
            precision: settings.precision.name(),
            error,
            error_unit: case.unit,
            target,
            met: error.zip(target).is_some_and(|(error, target)| error <= target),
        })
    };
    cases.iter().filter(|case| case.is_contact() && !case.is_mix()).map(of).collect()
}
