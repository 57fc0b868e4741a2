//! `lamina report`: all experiments into a folder.

use std::path::PathBuf;

use anyhow::Context;
use lamina2d::report;

use super::{output, refuse};

/// Arguments of `lamina report`.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// Fewer bodies and repeats: under a minute.
    #[arg(long)]
    quick: bool,
    /// Where the page, tables and plots go.
    #[arg(long, value_name = "DIR", default_value = "reports/latest")]
    out: PathBuf,
    /// Also refresh the committed copy in reports/.
    #[arg(long)]
    publish: bool,
    /// Print a JSON summary.
    #[arg(long)]
    json: bool,
}

pub(crate) fn main(args: &Args) -> anyhow::Result<()> {
    if args.out.exists() && !args.out.is_dir() {
        return Err(refuse(anyhow::anyhow!("--out: {} is not a folder", args.out.display())));
    }
    // Tried before the first measurement, so that nothing measured is lost.
    std::fs::create_dir_all(&args.out)
        .with_context(|| format!("cannot create {}", args.out.display()))
        .map_err(refuse)?;
    let bar = output::progress(report::Data::rounds(args.quick), "report");
    let data = report::Data::measure(args.quick, &mut |what| {
        bar.set_message(what);
        bar.inc(1);
    })?;
    bar.finish_and_clear();
    let mut folders = vec![args.out.clone()];
    if args.publish {
        folders.push(PathBuf::from("reports"));
    }
    for folder in &folders {
        report::write(&data, folder)
            .with_context(|| format!("cannot write the report into {}", folder.display()))?;
    }
    if args.json {
        return output::print_json(&data.summary());
    }
    output::print_text(&report::terminal_summary(&data, output::table))?;
    output::print_text(&format!("\nPage: {}", args.out.join("index.html").display()))
}
