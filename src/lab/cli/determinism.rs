//! `lamina determinism`: does the same scene give the same bits twice?

use lamina::report::experiments::determinism;

use super::output;

/// Arguments of `lamina determinism`.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// Print JSON.
    #[arg(long)]
    json: bool,
}

pub(crate) fn main(args: &Args) -> anyhow::Result<()> {
    let rows = determinism::run()?;
    if args.json {
        return output::print_json(&rows);
    }
    let header = [
        "engine",
        "integrator",
        "stepping",
        "seconds",
        "first hash",
        "second hash",
        "same bits",
        "max apart m",
    ];
    let table = rows.iter().map(|row| {
        vec![
            row.engine.clone(),
            row.integrator.clone(),
            row.stepping.to_string(),
            row.seconds.to_string(),
            row.hashes[0].clone(),
            row.hashes[1].clone(),
            if row.identical { "yes" } else { "no" }.to_owned(),
            format!("{:.3e}", row.max_apart_m),
        ]
    });
    output::print_text(&output::table(&header, table))
}
