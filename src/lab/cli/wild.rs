//! `lamina wild`: scenes from problem reports, each held to its right numbers.

use lamina::report::Record as _;
use lamina::wild::{Case, Course, KINDS, Row, World, chosen, rows, tally};
use lamina2d::settings::Precision;
use serde_json::json;

use super::{output, refuse};

/// Arguments of `lamina wild`.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// Only these: a kind, or how a case's name begins.
    #[arg(value_name = "CASE")]
    cases: Vec<String>,
    /// f32 or f64.
    #[arg(long, default_value = "f32")]
    precision: Precision,
    /// Show every number, not only those that are not met.
    #[arg(long)]
    all: bool,
    /// Print the rows as JSON.
    #[arg(long)]
    json: bool,
}

pub(crate) fn main(args: &Args) -> anyhow::Result<()> {
    let cases = chosen(&args.cases).map_err(refuse)?;
    let bar = output::progress(cases.len() as u64, "wild");
    let mut found: Vec<Row> = Vec::new();
    let build = |case: &Case| Ok(Box::new(World::new(case, args.precision)?) as Box<dyn Course>);
    for case in &cases {
        bar.set_message(case.name.clone());
        found.extend(rows(case, build));
        bar.inc(1);
    }
    bar.finish_and_clear();
    let all = tally(&found);
    if args.json {
        return output::print_json(&json!({"cases": all.cases, "right": all.right, "rows": found}));
    }
    let shown = found.iter().filter(|row| args.all || !row.met);
    if args.all || all.right < all.cases {
        output::print_text(&output::table(Row::HEADER, shown.map(Row::cells)))?;
        output::print_text("")?;
    }
    for kind in KINDS {
        let of = tally(found.iter().filter(|row| row.kind == kind));
        if of.cases > 0 {
            output::print_text(&format!("{kind}: {} of {} right", of.right, of.cases))?;
        }
    }
    output::print_text(&format!("all: {} of {} right", all.right, all.cases))
}
