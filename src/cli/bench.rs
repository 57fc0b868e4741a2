//! `lamina bench`: the thesis's performance matrix at every width, beside its engine.

use lamina2d::report::experiments::{broad_phase, matrix};
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
    let rows = matrix::run(&plan, &mut || bar.inc(1))?;
    bar.finish_and_clear();
    let broad = broad_phase::run(if args.quick { 4 } else { 16 })?;
    if args.json {
        return output::print_json(&json!({"rows": rows, "broad_phase": broad}));
    }
    let table = rows.iter().map(|row| {
        vec![
            row.mix.clone(),
            row.integrator.clone(),
            row.bodies.to_string(),
            row.engine.clone(),
            row.lanes.to_string(),
            format!("{:.4}", row.ms_per_step.min),
            format!("{:.4}", row.ms_per_step.median),
            row.contacts.to_string(),
            format!("{:.4}", row.max_penetration),
            row.hash.clone(),
        ]
    });
    let header = [
        "mix",
        "integrator",
        "bodies",
        "engine",
        "lanes",
        "min ms",
        "median ms",
        "contacts",
        "max pen m",
        "hash",
    ];
    output::print_text(&output::table(&header, table))?;
    let header = ["engine", "bodies", "on ms", "off ms", "off/on"];
    let table = broad.iter().map(|row| {
        vec![
            row.engine.clone(),
            row.bodies.to_string(),
            format!("{:.4}", row.on_ms),
            format!("{:.4}", row.off_ms),
            format!("{:.2}", row.off_ms / row.on_ms),
        ]
    });
    output::print_text("\nBroad phase on and off, polygons:")?;
    output::print_text(&output::table(&header, table))
}
