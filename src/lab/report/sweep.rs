//! What `lamina report --full` leaves of its accuracy sweep for reports that have no time for one.

use std::path::Path;

use anyhow::Context;
use serde::{Deserialize, Serialize};

use super::experiments::accuracy::{Accuracy, Drawing};
use crate::accuracy::answers::MixLine;
use crate::accuracy::contact::Verdict;
use crate::accuracy::{Fastest, Line};
use crate::present::{Earlier, Machine, Table};

/// An accuracy sweep, as tables and drawings.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Sweep<M = Earlier> {
    /// Where and when.
    pub machine: M,
    /// Its tables.
    pub tables: Vec<Table>,
    /// What its rows answer.
    pub answers: Vec<String>,
    /// Its drawings; their SVG is in files beside this one.
    pub drawings: Vec<Drawing>,
}

/// The tables of a sweep.
///
/// # Errors
/// A row that has no JSON.
pub fn tables(accuracy: &Accuracy) -> anyhow::Result<Vec<Table>> {
    Ok(vec![
        Table::of::<Line>(&accuracy.lines)?,
        Table::of::<Verdict>(&accuracy.contact)?,
        Table::of::<Fastest>(&accuracy.fastest)?,
        Table::of::<MixLine>(&accuracy.mixes)?,
    ])
}

/// Writes `accuracy.json`, which [`read`] reads.
///
/// # Errors
/// A folder that cannot be written into.
pub fn write(accuracy: &Accuracy, machine: &Machine, folder: &Path) -> anyhow::Result<()> {
    let sweep = Sweep {
        machine,
        // What the page shows of them; all of it is in their CSV.
        tables: tables(accuracy)?.into_iter().map(Table::without_raw).collect(),
        answers: accuracy.answers.clone(),
        drawings: accuracy.drawings.clone(),
    };
    Ok(std::fs::write(folder.join("accuracy.json"), serde_json::to_string_pretty(&sweep)?)?)
}

/// Reads what [`write()`] wrote, with the drawings beside it.
///
/// # Errors
/// A file that cannot be read, or is not one of these.
pub fn read(path: &Path) -> anyhow::Result<Sweep> {
    let shown = || format!("accuracy {}", path.display());
    let text = std::fs::read_to_string(path).with_context(|| format!("cannot read {}", shown()))?;
    let mut sweep: Sweep = serde_json::from_str(&text).with_context(shown)?;
    let folder = path.parent().unwrap_or(Path::new(""));
    for drawing in &mut sweep.drawings {
        let file = folder.join(&drawing.file);
        drawing.svg =
            std::fs::read_to_string(&file).with_context(|| format!("cannot read {}", file.display()))?;
    }
    for table in &mut sweep.tables {
        table.earlier = Some(sweep.machine.clone());
    }
    Ok(sweep)
}
