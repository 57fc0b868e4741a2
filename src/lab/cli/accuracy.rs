//! `lamina accuracy`: what error does a microsecond buy, case by case.

use std::path::PathBuf;

use anyhow::Context;
use lamina::accuracy::answers::{answers, mix_lines};
use lamina::accuracy::{
    CASES, Effort, FAILING, Fastest, Line, Results, Row, chosen, contact, instructions, lines, measure, write,
};
use lamina::report::Record;
use serde_json::{Value, json};

use super::{output, refuse};

/// Arguments of `lamina accuracy`.
#[derive(Debug, clap::Args)]
#[expect(clippy::struct_excessive_bools, reason = "flags of a command line")]
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
    /// Count instructions too, under valgrind (Debian: apt-get install valgrind), at the usual lane widths.
    #[arg(long)]
    instructions: bool,
    /// Run the windows that valgrind counts, and nothing else.
    #[arg(long, hide = true)]
    counted_windows: bool,
    /// List the cases, and those that cannot run.
    #[arg(long, conflicts_with_all = ["quick", "out", "instructions"])]
    list: bool,
}

pub(crate) fn main(args: &Args) -> anyhow::Result<()> {
    if args.list {
        return list(args.json);
    }
    let cases = chosen(&args.cases, args.quick).map_err(refuse)?;
    let effort = if args.quick { Effort::QUICK } else { Effort::FULL };
    if args.counted_windows {
        return cases.into_iter().try_for_each(|case| instructions::windows(case, effort));
    }
    if args.instructions {
        instructions::check().map_err(refuse)?;
    }
    std::fs::create_dir_all(&args.out)
        .with_context(|| format!("--out: cannot write into {}", args.out.display()))
        .map_err(refuse)?;
    let bar = output::progress(cases.len() as u64, "accuracy");
    let mut all = Vec::new();
    for &case in &cases {
        bar.set_message(case.name);
        let mut results = measure(case, effort)?;
        if args.instructions {
            instructions::count(&mut results, effort)?;
        }
        write::case(&results, &args.out)?;
        all.push(results);
        bar.inc(1);
    }
    bar.finish_and_clear();
    write::summary(&all, &args.out)?;
    let fastest: Vec<_> = all.iter().map(Fastest::of).collect();
    let verdicts = contact::verdicts(&cases)?;
    let mixes = mix_lines(&all)?;
    let answers = answers(&mixes, &fastest);
    if args.json {
        let rows: Vec<&Row> = all.iter().flat_map(|results| &results.rows).collect();
        return output::print_json(&json!({
            "rows": rows,
            "fastest": fastest,
            "contact": verdicts,
            "mixes": mixes,
            "answers": answers,
            "failing": FAILING,
        }));
    }
    print(&all)?;
    print_verdicts(&verdicts)?;
    output::print_text("")?;
    answers.iter().try_for_each(|answer| output::print_text(answer))?;
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
    let rows = all.iter().flat_map(lines).map(|line| line.cells());
    output::print_text(&output::table(Line::HEADER, rows))?;
    output::print_text("\nFastest at an error:")?;
    let fastest = all.iter().map(|results| Fastest::of(results).cells());
    output::print_text(&output::table(Fastest::HEADER, fastest))?;
    print_failing()
}

/// Table B at the settings each of its cases names.
fn print_verdicts(verdicts: &[contact::Verdict]) -> anyhow::Result<()> {
    if verdicts.is_empty() {
        return Ok(());
    }
    let met = verdicts.iter().filter(|verdict| verdict.met).count();
    output::print_text(&format!("\nTargets of contact met: {met} of {}", verdicts.len()))?;
    output::print_text(&output::table(contact::Verdict::HEADER, verdicts.iter().map(Record::cells)))
}

fn print_failing() -> anyhow::Result<()> {
    output::print_text("\nCannot run:")?;
    FAILING
        .iter()
        .try_for_each(|failing| output::print_text(&format!("{}: {}", failing.name, failing.reason)))
}
