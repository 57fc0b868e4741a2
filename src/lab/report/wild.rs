//! What `lamina-peers wild` found, read from its file: how many scenes from problem reports each engine gets right.

use std::path::Path;

use anyhow::Context;
use serde::{Deserialize, Serialize};

use crate::present::Earlier;
use crate::present::table::Record;
use crate::wild::KINDS;

/// A document of `lamina-peers wild --json`.
#[derive(Debug, Deserialize)]
struct Document {
    machine: Earlier,
    rows: Vec<Row>,
}

/// A number of a case, as far as it is counted here.
#[derive(Debug, Deserialize)]
struct Row {
    engine: String,
    case: String,
    kind: String,
    met: bool,
}

/// Cases of a kind: of those an engine can express, how many it gets right.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Line {
    /// The kind; `all` for the last line.
    pub kind: String,
    /// Right, and run.
    pub lamina2d: [usize; 2],
    /// Likewise.
    pub box2d: [usize; 2],
    /// Likewise.
    pub rapier2d: [usize; 2],
}

impl Record for Line {
    const NAME: &'static str = "wild";
    const TITLE: &'static str = "Scenes from problem reports";
    const COMMAND: &'static str = "cargo run --release -p lamina-peers -- wild --out reports/wild.json";
    const NOTE: &'static str = "What people report of 2D engines, made into scenes with the numbers that must come out, each \
                                worked out from a closed form. Right: every number of the case, of those the engine can \
                                express; all as they come, of discs, boxes and polygons (Box2D keeps chain shapes for \
                                seams). Number by number: `lamina wild --all`.";
    const HEADER: &'static [&'static str] = &["kind", "lamina2d", "Box2D", "rapier"];
    fn cells(&self) -> Vec<String> {
        let of = |[right, cases]: [usize; 2]| format!("{right} of {cases}");
        vec![self.kind.clone(), of(self.lamina2d), of(self.box2d), of(self.rapier2d)]
    }
}

/// Reads the document: a line per kind, and one for all of them.
///
/// # Errors
/// A file that cannot be read or is no such document.
pub fn read(path: &Path) -> anyhow::Result<(Vec<Line>, Option<Earlier>)> {
    let text = std::fs::read_to_string(path).with_context(|| path.display().to_string())?;
    let document: Document = serde_json::from_str(&text).with_context(|| path.display().to_string())?;
    Ok((lines(&document.rows), Some(document.machine)))
}

fn lines(rows: &[Row]) -> Vec<Line> {
    let of = |kind: &str| {
        let count = |engine: &str| {
            let own = rows.iter().filter(|row| row.engine == engine && (kind == "all" || row.kind == kind));
            let mut cases = std::collections::BTreeMap::new();
            own.for_each(|row| *cases.entry(row.case.as_str()).or_insert(true) &= row.met);
            [cases.values().filter(|met| **met).count(), cases.len()]
        };
        let [lamina2d, box2d, rapier2d] = ["lamina2d", "box2d", "rapier2d"].map(count);
        Line { kind: kind.to_owned(), lamina2d, box2d, rapier2d }
    };
    KINDS.into_iter().chain(["all"]).map(of).filter(|line| line.lamina2d[1] > 0).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_case_is_right_where_all_its_numbers_are() {
        let row = |engine: &str, case: &str, kind: &str, met| Row {
            engine: engine.to_owned(),
            case: case.to_owned(),
            kind: kind.to_owned(),
            met,
        };
        let found = lines(&[
            row("lamina2d", "a", "seams", true),
            row("lamina2d", "a", "seams", true),
            row("lamina2d", "b", "seams", true),
            row("box2d", "a", "seams", true),
            row("box2d", "a", "seams", false),
            row("lamina2d", "c", "edges", false),
        ]);
        let line =
            |kind: &str, lamina2d, box2d| Line { kind: kind.to_owned(), lamina2d, box2d, rapier2d: [0; 2] };
        assert_eq!(
            found,
            [line("seams", [2, 2], [0, 1]), line("edges", [0, 1], [0; 2]), line("all", [2, 3], [0, 1])]
        );
    }
}
