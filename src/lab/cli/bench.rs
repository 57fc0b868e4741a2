//! `lamina bench`: the thesis's performance matrix at every width, beside its engine.

use lamina::report::experiments::{broad_phase, matrix};
use lamina::report::{Record, Table};
use serde_json::json;

use super::output;

/// Arguments of `lamina bench`.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// Fewer bodies, integrators and lanes: under half a minute.
    #[arg(long)]
    quick: bool,
    /// Print JSON.
    #[arg(long)]
    json: bool,
}

pub(crate) fn main(args: &Args) -> anyhow::Result<()> {
    let plan = if args.quick { matrix::Plan::quick() } else { matrix::Plan::full() };
    let bar = output::progress(plan.rounds(), "shape mix × integrator × lanes");
    let rows = matrix::run(&plan, &mut || {
        bar.inc(1);
        Ok(())
    })?;
    bar.finish_and_clear();
    let broad = broad_phase::run(args.quick, if args.quick { 4 } else { 16 })?;
    if args.json {
        return output::print_json(&json!({"rows": rows, "broad_phase": broad}));
    }
    let hashed = rows.iter().map(|row| [row.cells(), vec![row.hash.clone()]].concat());
    let header: Vec<_> = matrix::Row::HEADER.iter().copied().chain(["hash"]).collect();
    output::print_text(&output::table(&header, hashed))?;
    let broad = Table::of(&broad)?;
    output::print_text(&format!("\n{}, polygons:", broad.title))?;
    output::print_text(&output::table(&broad.header, broad.lines))
}
