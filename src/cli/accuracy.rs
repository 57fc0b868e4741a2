//! `lamina accuracy`: what error does a microsecond buy, case by case.

use std::path::PathBuf;

use anyhow::Context;
use lamina2d::accuracy::{CASES, Effort, FAILING, Fastest, Results, Row, chosen, contact, measure, write};
use serde_json::{Value, json};

use super::{output, refuse};

/// Arguments of `lamina accuracy`.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// Only these cases; all where none is named.
    #[arg(value_name = "CASE")]
    cases: Vec<String>,
    /// Fewer steps, repeats and lane widths: under three minutes.
    #[arg(long)]
    quick: bool,
    /// Print the rows as JSON.
    #[arg(long)]
    json: bool,
    /// Where each case's CSV, JSON and SVG go.
    #[arg(long, value_name = "DIR", default_value = "reports/latest/accuracy")]
    out: PathBuf,
    /// List the cases, and those that cannot run.
    #[arg(long, conflicts_with_all = ["quick", "out"])]
    list: bool,
}

pub(crate) fn main(args: &Args) -> anyhow::Result<()> {
    if args.list {
        return list(args.json);
    }
    let cases = chosen(&args.cases).map_err(refuse)?;
    std::fs::create_dir_all(&args.out)
        .with_context(|| format!("--out: cannot write into {}", args.out.display()))
        .map_err(refuse)?;
    let effort = if args.quick { Effort::QUICK } else { Effort::FULL };
    let bar = output::progress(cases.len() as u64, "accuracy");
    let mut all = Vec::new();
    for &case in &cases {
        bar.set_message(case.name);
        let results = measure(case, effort)?;
        write::case(&results, &args.out)?;
        all.push(results);
        bar.inc(1);
    }
    bar.finish_and_clear();
    write::summary(&all, &args.out)?;
    if args.json {
        let rows: Vec<&Row> = all.iter().flat_map(|results| &results.rows).collect();
        let fastest: Vec<_> = all.iter().map(Fastest::of).collect();
        let verdicts = contact::verdicts(&cases)?;
        return output::print_json(
            &json!({"rows": rows, "fastest": fastest, "contact": verdicts, "failing": FAILING}),
        );
    }
    print(&all)?;
    print_verdicts(&contact::verdicts(&cases)?)?;
    output::print_text(&format!("\nCurves: {}", args.out.display()))
}

fn list(json: bool) -> anyhow::Result<()> {
    if json {
        let rows: Vec<Value> = CASES
            .iter()
            .map(|c| json!({"case": c.name, "item": c.item, "scene": c.scene, "about": c.about, "error_unit": c.unit}))
            .collect();
        return output::print_json(&json!({"rows": rows, "failing": FAILING}));
    }
    let rows = CASES.iter().map(|c| [c.name, c.item, c.scene, c.about].map(str::to_owned).to_vec());
    output::print_text(&output::table(&["case", "item", "scene", "about"], rows))?;
    print_failing()
}

fn print(all: &[Results]) -> anyhow::Result<()> {
    let rows = all.iter().flat_map(orders);
    output::print_text(&output::table(
        &["case", "method", "order", "expected", "met", "least error f64", "f32", "ns per step f64", "f32"],
        rows,
    ))?;
    output::print_text("\nFastest at an error:")?;
    let header = ["case", "1e-2", "1e-4", "1e-6"];
    output::print_text(&output::table(&header, all.iter().map(|results| Fastest::of(results).cells())))?;
    print_failing()
}

/// Table B at the settings each of its cases names.
fn print_verdicts(verdicts: &[contact::Verdict]) -> anyhow::Result<()> {
    if verdicts.is_empty() {
        return Ok(());
    }
    let met = verdicts.iter().filter(|verdict| verdict.met).count();
    output::print_text(&format!("\nTargets of contact met: {met} of {}", verdicts.len()))?;
    let number = |value: Option<f64>| or_dash(value.map(|value| format!("{value:.1e}")));
    let row = |v: &contact::Verdict| {
        let settings = format!("{} {} h {:.2e}", v.method, v.precision, v.h);
        let met = if v.met { "yes" } else { "no" }.to_owned();
        vec![v.case.to_owned(), settings, number(v.error), number(v.target), v.error_unit.to_owned(), met]
    };
    let header = ["case", "settings", "error", "target", "unit", "met"];
    output::print_text(&output::table(&header, verdicts.iter().map(row)))
}

fn print_failing() -> anyhow::Result<()> {
    output::print_text("\nCannot run:")?;
    FAILING
        .iter()
        .try_for_each(|failing| output::print_text(&format!("{}: {}", failing.name, failing.reason)))
}

/// A line per method: what was observed, expected, and the best of its runs.
fn orders(results: &Results) -> Vec<Vec<String>> {
    let mut methods: Vec<&str> = results.rows.iter().map(|row| row.method.as_str()).collect();
    methods.dedup();
    let line = |method: &str| {
        let own = || results.rows.iter().filter(move |row| row.method == method);
        let least = |of: fn(&Row) -> Option<f64>, precision: &str| {
            let values = own().filter(|row| row.precision == precision).filter_map(of);
            let least = values.fold(f64::INFINITY, f64::min);
            if least.is_finite() { Some(least) } else { None }
        };
        let said: Vec<bool> = own().filter_map(|row| row.met).collect();
        let first = own().next();
        vec![
            results.case.name.to_owned(),
            method.to_owned(),
            or_dash(first.and_then(|row| row.order).map(|order| format!("{order:.3}"))),
            first.map_or_else(String::new, |row| row.target.clone()),
            if said.is_empty() {
                "–"
            } else if said.iter().all(|met| *met) {
                "yes"
            } else {
                "no"
            }
            .to_owned(),
            or_dash(least(|row| row.error, "f64").map(|error| format!("{error:.1e}"))),
            or_dash(least(|row| row.error, "f32").map(|error| format!("{error:.1e}"))),
            or_dash(least(|row| row.ns_per_step, "f64").map(|ns| format!("{ns:.1}"))),
            or_dash(least(|row| row.ns_per_step, "f32").map(|ns| format!("{ns:.1}"))),
        ]
    };
    methods.into_iter().map(line).collect()
}

fn or_dash(text: Option<String>) -> String {
    text.unwrap_or_else(|| "–".to_owned())
}
