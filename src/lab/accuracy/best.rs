//! What the rows say: which runs nothing beats, which is fastest at an error, and how methods do over all cases.

use serde::Serialize;

use super::sweep::{Results, Row};

/// The errors asked for.
pub const LEVELS: [f64; 3] = [1e-2, 1e-4, 1e-6];

/// What a run costs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cost {
    /// ns.
    Time,
    /// Counted.
    Instructions,
}

impl Cost {
    /// Of a row, to its end.
    pub fn of(self, row: &Row) -> Option<f64> {
        match self {
            Self::Time => row.ns_total,
            Self::Instructions => row.instructions_total,
        }
    }

    /// In words.
    pub const fn title(self) -> &'static str {
        match self {
            Self::Time => "time to the end, ns",
            Self::Instructions => "instructions to the end",
        }
    }
}

/// Rows that no other row of the case beats in both error and cost, from the least cost to the least error.
pub fn pareto(results: &Results, cost: Cost) -> Vec<&Row> {
    let mut sorted: Vec<(&Row, f64, f64)> =
        results.told().filter_map(|row| Some((row, cost.of(row)?, row.error?))).collect();
    sorted.sort_by(|a, b| a.1.total_cmp(&b.1).then(a.2.total_cmp(&b.2)));
    let mut best = f64::INFINITY;
    sorted.retain(|(_, _, error)| {
        let better = *error < best;
        best = best.min(*error);
        better
    });
    sorted.into_iter().map(|(row, ..)| row).collect()
}

/// The fastest runs of a case at each of [`LEVELS`].
#[derive(Clone, Debug, Serialize)]
pub struct Fastest {
    /// The case.
    pub case: &'static str,
    /// The error's unit.
    pub error_unit: &'static str,
    /// Per level, the fastest run whose error is no larger; null where there is none.
    pub at: [Option<Run>; LEVELS.len()],
}

/// A run, in short.
#[derive(Clone, Debug, Serialize)]
pub struct Run {
    /// The largest error asked for.
    pub level: f64,
    /// The method, in words.
    pub method: String,
    /// Seconds per step.
    pub h: f64,
    /// The scalar.
    pub precision: &'static str,
    /// Numbers per vector.
    pub lanes: usize,
    /// What its error is.
    pub error: f64,
    /// What it takes, ns.
    pub ns_total: f64,
}

impl Fastest {
    /// Of a case's rows.
    pub fn of(results: &Results) -> Self {
        let at = LEVELS.map(|level| fastest(&results.rows, level));
        Self { case: results.case.name, error_unit: results.case.unit, at }
    }

    /// One cell per level for a table.
    pub fn cells(&self) -> Vec<String> {
        let run = |run: &Run| {
            let Run { method, precision, lanes, h, ns_total, .. } = run;
            format!("{method} {precision}×{lanes}, h {h:.2e}: {}", duration(*ns_total))
        };
        let levels = self.at.iter().map(|at| at.as_ref().map_or_else(|| "–".to_owned(), run));
        std::iter::once(self.case.to_owned()).chain(levels).collect()
    }
}

pub(super) fn fastest(rows: &[Row], level: f64) -> Option<Run> {
    let good = rows.iter().filter_map(|row| {
        let (error, ns_total) = (row.error.filter(|error| *error <= level)?, row.ns_total?);
        Some((row, error, ns_total))
    });
    let (row, error, ns_total) = good.min_by(|a, b| a.2.total_cmp(&b.2))?;
    let Row { method, h, precision, lanes, .. } = row.clone();
    Some(Run { level, method, h, precision, lanes, error, ns_total })
}

/// ns in a unit that leaves one to three digits before the point.
pub(super) fn duration(ns: f64) -> String {
    let (unit, scale) = [("s", 1e9), ("ms", 1e6), ("µs", 1e3)]
        .into_iter()
        .find(|(_, scale)| ns >= *scale)
        .unwrap_or(("ns", 1.0));
    format!("{:.3} {unit}", ns / scale)
}

/// How one method does over all cases at one error: Dolan and Moré's profile (Math. Program. 91 (2002) 201).
#[derive(Clone, Debug, Serialize)]
pub struct Profile {
    /// The largest error asked for.
    pub level: f64,
    /// The method and precision, in words.
    pub method: String,
    /// Per case that some method solves: the method's best time over the best time of all, infinite where it does not
    /// reach the error; ascending.
    pub ratios: Vec<f64>,
}

impl Profile {
    /// The share of cases solved within `factor` times the best time.
    pub fn share(&self, factor: f64) -> f64 {
        let within = self.ratios.iter().filter(|ratio| **ratio <= factor).count();
        within as f64 / self.ratios.len().max(1) as f64
    }
}

/// The profiles of all methods without joints at an error, over the cases whose errors are relative ones.
pub fn profiles(results: &[Results], level: f64) -> Vec<Profile> {
    let label = |row: &Row| format!("{} {}", row.method, row.precision);
    let alike = |results: &&Results| {
        results.case.unit == "relative" && results.rows.iter().all(|row| row.solver.is_none())
    };
    let cases: Vec<&Results> = results.iter().filter(alike).collect();
    let solved: Vec<(&Results, f64)> = cases
        .iter()
        .filter_map(|results| Some((*results, fastest(&results.rows, level)?.ns_total)))
        .collect();
    let mut methods: Vec<String> = Vec::new();
    for row in cases.iter().flat_map(|results| &results.rows) {
        if !methods.contains(&label(row)) {
            methods.push(label(row));
        }
    }
    let profile = |method: String| {
        let ratio = |(results, best): &(&Results, f64)| {
            let own: Vec<Row> = results.rows.iter().filter(|row| label(row) == method).cloned().collect();
            fastest(&own, level).map_or(f64::INFINITY, |run| run.ns_total / best)
        };
        let mut ratios: Vec<f64> = solved.iter().map(ratio).collect();
        ratios.sort_by(f64::total_cmp);
        Profile { level, method, ratios }
    };
    methods.into_iter().map(profile).collect()
}
