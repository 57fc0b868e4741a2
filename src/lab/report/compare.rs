//! Two reports side by side: what became faster or slower, beyond what the machine's drift explains.
//!
//! Rows of both reports are matched by what was run. The engines whose code does not change (the thesis baselines) and
//! plain copies ran in both: the median of their ratios says how much faster or slower the machine was, and the spread
//! of those ratios how far single rows stray. Every other ratio is divided by the first and judged against the second.

use serde::Serialize;
use serde_json::Value;

use super::{Data, Record};
use crate::present::timing::{median, quantile};

/// How rows of one table are matched, and which of their numbers are times or rates.
struct Matched {
    table: &'static str,
    /// Fields that say what was run.
    key: &'static [&'static str],
    /// Paths of times: smaller is faster.
    times: &'static [&'static str],
}

const MATCHED: &[Matched] = &[
    Matched {
        table: "matrix",
        key: &["mix", "bodies", "integrator", "engine", "lanes", "substeps"],
        times: &["ms_per_step/median"],
    },
    Matched { table: "broad_phase", key: &["engine", "bodies"], times: &["on_ms", "off_ms"] },
    Matched { table: "lanes", key: &["kernel", "scene", "lanes"], times: &["ns_per_element"] },
    Matched { table: "contacts", key: &["scene", "lanes"], times: &["ms_per_step"] },
    Matched { table: "stability", key: &["scene", "solver", "substeps"], times: &["ms_per_step"] },
    Matched { table: "sleep", key: &["scene", "substeps"], times: &["awake_ms", "asleep_ms"] },
    Matched { table: "recording", key: &["scene", "state"], times: &["step_ms", "recorded_ms"] },
    Matched { table: "skips", key: &["scene", "integrator", "skip"], times: &["on_ms", "off_ms"] },
    Matched { table: "flight", key: &["bodies", "integrator"], times: &["ns_per_body"] },
];
/// Engines whose code stays as it is.
const CONTROLS: [&str; 2] = ["thesis", "tidy"];
/// Rows closer than this are alike even where the controls agree better, since code that did not change may move.
const LEAST_NOISE: f64 = 0.05;

/// One time in both reports.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// The table it is in.
    pub table: &'static str,
    /// What was run.
    pub what: String,
    /// The other report's time, in the table's unit.
    pub before: f64,
    /// This report's.
    pub after: f64,
    /// After over before, the machine's drift taken out: below 1 is faster.
    pub ratio: f64,
    /// Ratios from 1/(1 + noise) to 1 + noise say nothing.
    pub noise: f64,
    /// `faster`, `slower` or `alike`.
    pub verdict: &'static str,
    /// Mean overlap before and after, metres, where the table has it.
    pub mean_penetration: [Option<f64>; 2],
}

impl Record for Row {
    const NAME: &'static str = "against";
    const TITLE: &'static str = "Against another report";
    const COMMAND: &'static str = "lamina report --against DIR";
    const NOTE: &'static str = "Ratio: after over before, divided by how much slower the machine was, which the engines \
         whose code did not change say. Noise: how far the ratios of those engines stray, nine of ten.";
    const HEADER: &'static [&'static str] =
        &["table", "what", "before", "after", "ratio", "noise", "verdict", "overlap before mm", "after mm"];

    fn cells(&self) -> Vec<String> {
        let mm = |m: Option<f64>| m.map_or_else(String::new, |m| format!("{:.2}", m * 1e3));
        vec![
            self.table.to_owned(),
            self.what.clone(),
            format!("{:.4}", self.before),
            format!("{:.4}", self.after),
            format!("{:.3}", self.ratio),
            format!("±{:.0} %", self.noise * 100.0),
            self.verdict.to_owned(),
            mm(self.mean_penetration[0]),
            mm(self.mean_penetration[1]),
        ]
    }
}

/// Two reports compared.
#[derive(Clone, Debug, Serialize)]
pub struct Comparison {
    /// The other report's commit.
    pub before: String,
    /// This report's.
    pub after: String,
    /// How many times slower the machine was this time.
    pub drift: f64,
    /// Rows the drift was read from.
    pub controls: usize,
    /// All times that are in both, the most changed first.
    pub rows: Vec<Row>,
}

/// Why two reports cannot be compared.
#[derive(Debug, thiserror::Error)]
pub enum CompareError {
    /// The other report is not there or not JSON.
    #[error("cannot read the report {path}: {why}")]
    Unreadable {
        /// Its data file.
        path: String,
        /// The reason.
        why: String,
    },
    /// Nothing was run in both, or no control.
    #[error("the report {path} has no {missing} in common with this one")]
    Nothing {
        /// Its data file.
        path: String,
        /// `time`, or `engine that stayed as it is`.
        missing: &'static str,
    },
}

/// A time of one report.
struct Timed {
    table: &'static str,
    what: String,
    time: f64,
    control: bool,
    mean_penetration: Option<f64>,
}

/// Reads the data of the report in `folder`.
///
/// # Errors
/// A file that is not there or not JSON.
pub fn read(folder: &std::path::Path) -> Result<Value, CompareError> {
    let path = folder.join("data.json");
    let failed = |why: String| CompareError::Unreadable { path: path.display().to_string(), why };
    let text = std::fs::read_to_string(&path).map_err(|e| failed(e.to_string()))?;
    serde_json::from_str(&text).map_err(|e| failed(e.to_string()))
}

/// Compares this report with the data of another.
///
/// # Errors
/// Reports that have no time, or no control, in common.
pub fn compare(before: &Value, after: &Data, path: &str) -> Result<Comparison, CompareError> {
    let unreadable =
        |why: serde_json::Error| CompareError::Unreadable { path: path.to_owned(), why: why.to_string() };
    compare_data(before, &serde_json::to_value(after).map_err(unreadable)?, path)
}

/// [`compare`], by the data of both.
fn compare_data(before: &Value, after: &Value, path: &str) -> Result<Comparison, CompareError> {
    let nothing = |missing| CompareError::Nothing { path: path.to_owned(), missing };
    let old = times(before);
    let find = |new: &Timed| {
        old.iter().find(|o| o.table == new.table && o.what == new.what).map(|o| (o.time, o.mean_penetration))
    };
    let pairs: Vec<_> = times(after).into_iter().filter_map(|new| find(&new).map(|old| (old, new))).collect();
    if pairs.is_empty() {
        return Err(nothing("time"));
    }
    let controls: Vec<f64> =
        pairs.iter().filter(|(_, new)| new.control).map(|((old, _), new)| new.time / old).collect();
    if controls.is_empty() {
        return Err(nothing("engine that stayed as it is"));
    }
    let drift = median(&controls);
    let strays: Vec<f64> = controls.iter().map(|ratio| (ratio / drift).ln().abs()).collect();
    let noise = (quantile(&strays, 0.9).exp() - 1.0).max(LEAST_NOISE);
    let row = |((before, overlap), new): ((f64, Option<f64>), Timed)| {
        let ratio = new.time / before / drift;
        let verdict = match ratio {
            r if r > 1.0 + noise => "slower",
            r if r < 1.0 / (1.0 + noise) => "faster",
            _ => "alike",
        };
        let mean_penetration = [overlap, new.mean_penetration];
        Row {
            table: new.table,
            what: new.what,
            before,
            after: new.time,
            ratio,
            noise,
            verdict,
            mean_penetration,
        }
    };
    let mut rows: Vec<Row> = pairs.into_iter().filter(|(_, new)| !new.control).map(row).collect();
    rows.sort_by(|a, b| b.ratio.ln().abs().total_cmp(&a.ratio.ln().abs()));
    let commit = |data: &Value| data["machine"]["commit"].as_str().unwrap_or("unknown").to_owned();
    Ok(Comparison { before: commit(before), after: commit(after), drift, controls: controls.len(), rows })
}

/// All positive times of a report.
fn times(data: &Value) -> Vec<Timed> {
    let mut all = Vec::new();
    for matched in MATCHED {
        let rows = data[matched.table].as_array().into_iter().flatten();
        for row in rows {
            let part = |key: &&str| match &row[key] {
                Value::String(text) => text.clone(),
                other => other.to_string(),
            };
            let key = matched.key.iter().map(part).collect::<Vec<_>>().join(" ");
            let control = row["engine"].as_str().is_some_and(|engine| CONTROLS.contains(&engine));
            let mean_penetration = row["mean_penetration"].as_f64();
            for path in matched.times {
                let time = row.pointer(&format!("/{path}")).and_then(Value::as_f64);
                let what = if matched.times.len() > 1 { format!("{key} {path}") } else { key.clone() };
                all.extend(time.filter(|t| *t > 0.0).map(|time| Timed {
                    table: matched.table,
                    what,
                    time,
                    control,
                    mean_penetration,
                }));
            }
        }
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn report(ours: f64, machine: f64) -> Value {
        let row = |engine: &str, bodies: u32, ms: f64| {
            json!({"mix": "all", "bodies": bodies, "integrator": "rk4", "engine": engine, "lanes": 8, "substeps": 4,
                   "ms_per_step": {"median": ms * machine}, "mean_penetration": 1e-3})
        };
        json!({"machine": {"commit": "abc"}, "matrix": [
            row("lamina2d", 150, ours), row("lamina2d", 1000, 7.0),
            row("thesis", 150, 10.0), row("tidy", 150, 5.0), row("tidy", 1000, 50.0),
        ]})
    }

    /// The same engine on a machine half as fast is alike; one that takes a fifth longer on top is slower.
    #[test]
    fn drift_of_the_machine_is_taken_out() {
        for (ours, machine, verdict) in [(1.0, 2.0, "alike"), (1.2, 2.0, "slower"), (0.5, 0.7, "faster")] {
            let compared = compare_data(&report(1.0, 1.0), &report(ours, machine), "x").unwrap();
            assert_eq!(compared.controls, 3);
            assert!((compared.drift - machine).abs() < 1e-12, "{}", compared.drift);
            // Our row of 1000 bodies changed by the machine alone.
            let row = |bodies: &str| {
                let mut ours = compared.rows.iter().filter(|row| row.what.contains("lamina2d"));
                ours.find(|row| row.what.contains(bodies)).expect("a row of ours")
            };
            assert!((row(" 150 ").ratio - ours).abs() < 1e-12, "{}", row(" 150 ").ratio);
            assert_eq!((row(" 150 ").verdict, row(" 1000 ").verdict), (verdict, "alike"));
        }
    }

    #[test]
    fn a_report_compared_with_itself_is_alike_and_with_nothing_is_refused() {
        let mut data = Data::empty(true);
        data.broad_phase = ["lamina2d", "thesis"]
            .map(|engine| super::super::experiments::broad_phase::Row {
                engine: engine.to_owned(),
                bodies: 60,
                on_ms: 1.0,
                off_ms: 2.0,
            })
            .to_vec();
        let same = serde_json::to_value(&data).unwrap();
        let comparison = compare(&same, &data, "x").unwrap();
        assert_eq!((comparison.controls, comparison.rows.len(), comparison.drift), (2, 2, 1.0));
        assert!(comparison.rows.iter().all(|row| row.verdict == "alike" && row.ratio == 1.0));
        let mut slow = same.clone();
        slow["broad_phase"][0]["on_ms"] = json!(0.5);
        let comparison = compare(&slow, &data, "x").unwrap();
        assert_eq!(comparison.rows[0].verdict, "slower");
        assert!(compare(&json!({}), &data, "x").unwrap_err().to_string().contains("no time in common"));
        same["machine"]["commit"].as_str().unwrap();
    }
}
