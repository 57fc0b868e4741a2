//! What a run of the laboratory leaves: per case rows and a drawing, and all rows in one file.

use std::path::Path;

use anyhow::Context;
use serde_json::json;

use lamina2d::settings::Solver;

use super::case::Case;
use super::run::Row;
use crate::present::chart::{Series, Slope, log_log};
use crate::present::{Earlier, Machine, Table};

/// What is smaller is drawn here: a share of nothing has no logarithm.
const LEAST_SHARE: f64 = 1e-4;

/// Writes `NAME.csv`, `NAME.json` and, where a run came to its end, `NAME.svg`.
///
/// # Errors
/// A folder that cannot be written into.
pub fn case(case: &Case, rows: &[Row], folder: &Path) -> anyhow::Result<()> {
    let file = |ending: &str| folder.join(format!("{}.{ending}", case.name));
    let document = json!({"machine": Machine::read(), "case": case.name, "about": case.about, "rows": rows});
    std::fs::write(file("json"), serde_json::to_string_pretty(&document)?)?;
    Table::of(rows)?.write_csv(std::fs::File::create(file("csv"))?)?;
    if let Some(svg) = drawing(case, rows)? {
        std::fs::write(file("svg"), svg)?;
    }
    Ok(())
}

/// Writes all rows to `stress.json`.
///
/// # Errors
/// A folder that cannot be written into.
pub fn all(rows: &[Row], folder: &Path) -> anyhow::Result<()> {
    let document = json!({"machine": Machine::read(), "rows": rows});
    Ok(std::fs::write(folder.join("stress.json"), serde_json::to_string_pretty(&document)?)?)
}

/// Reads what [`all`] wrote, and where it was measured.
///
/// # Errors
/// A file that is not there, or not one of these.
pub fn read(path: &Path) -> anyhow::Result<(Vec<Row>, Option<Earlier>)> {
    let text = std::fs::read_to_string(path).with_context(|| format!("cannot read {}", path.display()))?;
    let mut document: serde_json::Value =
        serde_json::from_str(&text).with_context(|| path.display().to_string())?;
    let rows = serde_json::from_value(document["rows"].take())
        .with_context(|| format!("{}: not rows of lamina stress", path.display()))?;
    Ok((rows, Earlier::of(&document)))
}

/// The worst share of what is allowed against substeps, a line per solver; `None` where nothing came to its end.
///
/// # Errors
/// A drawing that fails.
pub fn drawing(case: &Case, rows: &[Row]) -> anyhow::Result<Option<String>> {
    let line = |solver: &Solver| {
        let of = rows.iter().filter(|row| row.solver == *solver);
        let point = |row: &Row| (f64::from(row.substeps), row.worst_share().max(LEAST_SHARE));
        let points: Vec<_> = of.map(point).filter(|(_, share)| share.is_finite()).collect();
        Series { name: solver.to_string(), points }
    };
    let mut series: Vec<_> = Solver::ALL.iter().map(line).filter(|line| !line.points.is_empty()).collect();
    if series.is_empty() {
        return Ok(None);
    }
    let substeps = || rows.iter().map(|row| f64::from(row.substeps));
    let ends = [substeps().fold(f64::MAX, f64::min), substeps().fold(0.0, f64::max)];
    series.push(Series { name: "allowed".to_owned(), points: ends.map(|x| (x, 1.0)).to_vec() });
    let title = format!("{}: {}", case.item, case.about);
    log_log(&title, ["substeps", "found over allowed"], &series, Slope::Down).map(Some)
}
