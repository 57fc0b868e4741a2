//! What a method did on a case, in a line: the order it showed, whether that was expected, the best of its runs.

use serde::Serialize;

use super::best::{Fastest, LEVELS};
use super::contact::Verdict;
use super::sweep::{Results, Row};
use crate::present::Record;

/// A method on a case.
#[derive(Clone, Debug, Serialize)]
pub struct Line {
    /// The case.
    pub case: &'static str,
    /// What it shows.
    pub about: &'static str,
    /// The method, in words.
    pub method: String,
    /// The order observed in `f64`; null where none shows.
    pub order: Option<f64>,
    /// What is expected.
    pub expected: String,
    /// Was it met at every step? null where a sweep is too short to say.
    pub met: Option<bool>,
    /// The least error in `f64` and `f32`, in `error_unit`.
    pub least_error: [Option<f64>; 2],
    /// Its unit.
    pub error_unit: &'static str,
    /// The least time per step in `f64` and `f32`, ns.
    pub ns_per_step: [Option<f64>; 2],
}

/// The lines of a case, its methods in order.
pub fn lines(results: &Results) -> Vec<Line> {
    let mut methods: Vec<&str> = results.rows.iter().map(|row| row.method.as_str()).collect();
    methods.dedup();
    methods.into_iter().filter_map(|method| line(results, method)).collect()
}

fn line(results: &Results, method: &str) -> Option<Line> {
    let own = || results.rows.iter().filter(|row| row.method == method);
    let least = |of: fn(&Row) -> Option<f64>| {
        ["f64", "f32"].map(|precision| {
            let values = own().filter(|row| row.precision == precision).filter_map(of);
            values.min_by(f64::total_cmp)
        })
    };
    let said: Vec<bool> = own().filter_map(|row| row.met).collect();
    let first = own().next()?;
    Some(Line {
        case: results.case.name,
        about: results.case.about,
        method: method.to_owned(),
        order: first.order,
        expected: first.target.clone(),
        met: (!said.is_empty()).then(|| said.iter().all(|met| *met)),
        least_error: least(|row| row.error),
        error_unit: results.case.unit,
        ns_per_step: least(|row| row.ns_per_step),
    })
}

fn or_dash(text: Option<String>) -> String {
    text.unwrap_or_else(|| "–".to_owned())
}

impl Record for Line {
    const NAME: &'static str = "accuracy";
    const TITLE: &'static str = "Accuracy: what each method shows on each case";
    const COMMAND: &'static str = "lamina accuracy --quick";
    const NOTE: &'static str = "Errors against closed forms or converged references; the order is fitted in f64. A dash under met: \
                                a quick sweep is too short to say; `lamina accuracy` says it of all.";
    const HEADER: &'static [&'static str] = &[
        "case",
        "method",
        "order",
        "expected",
        "met",
        "least error f64",
        "f32",
        "unit",
        "ns per step f64",
        "f32",
    ];

    fn cells(&self) -> Vec<String> {
        let [error64, error32] =
            self.least_error.map(|error| or_dash(error.map(|error| format!("{error:.1e}"))));
        let [ns64, ns32] = self.ns_per_step.map(|ns| or_dash(ns.map(|ns| format!("{ns:.1}"))));
        vec![
            self.case.to_owned(),
            self.method.clone(),
            or_dash(self.order.map(|order| format!("{order:.3}"))),
            self.expected.clone(),
            or_dash(self.met.map(|met| if met { "yes" } else { "no" }.to_owned())),
            error64,
            error32,
            self.error_unit.to_owned(),
            ns64,
            ns32,
        ]
    }
}

impl Record for Fastest {
    const NAME: &'static str = "fastest";
    const TITLE: &'static str = "Fastest at an error";
    const COMMAND: &'static str = "lamina accuracy --quick";
    const NOTE: &'static str = "Of all runs of a case the one that takes least time to its end with no more error than this; a dash \
                                where none does.";
    const HEADER: &'static [&'static str] = &["case", "at 1e-2", "at 1e-4", "at 1e-6"];

    fn cells(&self) -> Vec<String> {
        // The header says the levels.
        const { assert!(LEVELS.len() == 3) };
        Fastest::cells(self)
    }
}

impl Record for Verdict {
    const NAME: &'static str = "contact_targets";
    const TITLE: &'static str = "Contact: what is asked of each case, and what it shows";
    const COMMAND: &'static str = "lamina accuracy --quick";
    const NOTE: &'static str = "At default settings or those the case names. Which of the misses comes from what, and where it would \
                                be mended: docs of `accuracy::contact`.";
    const HEADER: &'static [&'static str] = &["case", "settings", "error", "target", "unit", "met"];

    fn cells(&self) -> Vec<String> {
        let number = |value: Option<f64>| or_dash(value.map(|value| format!("{value:.1e}")));
        vec![
            self.case.to_owned(),
            format!("{} {} h {:.2e}", self.method, self.precision, self.h),
            number(self.error),
            number(self.target),
            self.error_unit.to_owned(),
            if self.met { "yes" } else { "no" }.to_owned(),
        ]
    }
}
