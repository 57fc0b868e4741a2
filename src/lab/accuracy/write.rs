//! What is measured, into a folder.

use std::path::Path;

use serde::Serialize;
use serde_json::json;

use super::best::{Cost, Fastest, LEVELS, profiles};
use super::plot;
use super::sweep::{Results, Row};
use crate::present::Machine;

/// A row with what the JSON leaves out.
#[derive(Serialize)]
struct CsvRow<'a> {
    case: &'a str,
    method: &'a str,
    integrator: &'a str,
    solver: Option<&'a str>,
    h: f64,
    substeps: u32,
    stiffness: Option<f64>,
    precision: &'a str,
    lanes: usize,
    error: Option<f64>,
    error_unit: &'a str,
    ns_per_step: Option<f64>,
    median_ns_per_step: Option<f64>,
    ns_total: Option<f64>,
    order: Option<f64>,
    target: &'a str,
    met: Option<bool>,
    instructions_per_step: Option<f64>,
    instructions_total: Option<f64>,
}

impl<'a> From<&'a Row> for CsvRow<'a> {
    fn from(row: &'a Row) -> Self {
        Self {
            case: row.case,
            method: &row.method,
            integrator: row.integrator,
            solver: row.solver,
            h: row.h,
            substeps: row.substeps,
            stiffness: row.stiffness,
            precision: row.precision,
            lanes: row.lanes,
            error: row.error,
            error_unit: row.error_unit,
            ns_per_step: row.ns_per_step,
            median_ns_per_step: row.median_ns_per_step,
            ns_total: row.ns_total,
            order: row.order,
            target: &row.target,
            met: row.met,
            instructions_per_step: row.instructions_per_step,
            instructions_total: row.instructions_total,
        }
    }
}

/// Writes one CSV, JSON and SVG for a case, and another SVG where instructions were counted.
///
/// # Errors
/// A file that cannot be written.
pub fn case(results: &Results, folder: &Path) -> anyhow::Result<()> {
    let path = |ending: &str| folder.join(format!("{}.{ending}", results.case.name));
    let mut csv = csv::Writer::from_path(path("csv"))?;
    for row in &results.rows {
        csv.serialize(CsvRow::from(row))?;
    }
    csv.flush()?;
    let document = json!({
        "machine": Machine::read(),
        "case": results.case.name,
        "item": results.case.item,
        "about": results.case.about,
        "reference_floor": results.floor,
        "plotted_from": results.gate,
        "rows": results.rows,
    });
    std::fs::write(path("json"), serde_json::to_string_pretty(&document)?)?;
    for (cost, ending) in [(Cost::Time, "svg"), (Cost::Instructions, "instructions.svg")] {
        if let Some(svg) = plot::case(results, cost)? {
            std::fs::write(path(ending), svg)?;
        }
    }
    Ok(())
}

/// Run time against error of a case, as SVG; `None` where no run came to its end.
///
/// # Errors
/// A drawing that cannot be made.
pub fn drawing(results: &Results) -> anyhow::Result<Option<String>> {
    plot::case(results, Cost::Time)
}

/// Writes what is said of all cases together: the fastest at each error, and a profile at each.
///
/// # Errors
/// A file that cannot be written.
pub fn summary(all: &[Results], folder: &Path) -> anyhow::Result<()> {
    let fastest: Vec<_> = all.iter().map(Fastest::of).collect();
    let profiles: Vec<_> = LEVELS.map(|level| (level, profiles(all, level))).into();
    let document = json!({
        "machine": Machine::read(),
        "fastest": fastest,
        "failing": super::FAILING,
    });
    std::fs::write(folder.join("summary.json"), serde_json::to_string_pretty(&document)?)?;
    for (level, profiles) in profiles {
        // One case is no profile.
        if profiles.first().is_some_and(|profile| profile.ratios.len() > 1) {
            let file = folder.join(format!("profile_{level:e}.svg"));
            std::fs::write(file, plot::profiles(level, &profiles)?)?;
        }
    }
    Ok(())
}
