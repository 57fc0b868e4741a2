//! Blessed instruction counts as a table, read from the gate's file.

use serde::Serialize;

use crate::gate::{Baseline, STEPS_PER_COUNT};
use crate::present::Earlier;
use crate::present::table::Record;

/// One bench.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// The bench, by the name criterion has for it.
    pub name: String,
    /// `kernel`: of one call; `step`: of one step of a scene.
    pub kind: &'static str,
    /// Instructions of a call or step.
    pub instructions: f64,
    /// The toolchain that took them.
    pub toolchain: String,
}

impl Record for Row {
    const NAME: &'static str = "instructions";
    const TITLE: &'static str = "Instruction counts";
    const COMMAND: &'static str = "lamina gate";
    const NOTE: &'static str = "By callgrind, as blessed in `reports/instructions.toml`: of a kernel one call, of a \
         scene one step, the mean of 20. Names are those of the criterion benches. Changes: `reports/history.md`.";
    const HEADER: &'static [&'static str] = &["bench", "kind", "instructions", "toolchain"];

    fn cells(&self) -> Vec<String> {
        vec![
            self.name.clone(),
            self.kind.to_owned(),
            format!("{:.0}", self.instructions),
            self.toolchain.clone(),
        ]
    }
}

/// All counts of one toolchain.
pub fn rows(baseline: &Baseline) -> Vec<Row> {
    let row = |kind, per: u64| {
        move |(name, count): (&String, &u64)| Row {
            name: name.clone(),
            kind,
            instructions: *count as f64 / per as f64,
            toolchain: baseline.toolchain.to_string(),
        }
    };
    let steps = baseline.steps.iter().map(row("step", STEPS_PER_COUNT));
    steps.chain(baseline.kernels.iter().map(row("kernel", 1))).collect()
}

/// Which build they were blessed at.
pub fn earlier(baseline: &Baseline) -> Option<Earlier> {
    let (commit, _) = baseline.reasons.last()?.split_once(':')?;
    let cpu = format!("callgrind, {}", baseline.toolchain);
    Some(Earlier { commit: commit.to_owned(), cpu, when: None })
}
