//! `lamina report`: all experiments into a folder.

use std::path::{Path, PathBuf};

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
    let mut folders = vec![args.out.clone()];
    if args.publish {
        folders.push(PathBuf::from("reports"));
    }
    // Tried before the first measurement, so that nothing measured is lost.
    for folder in &folders {
        try_writing(folder)
            .with_context(|| format!("--out: cannot write into {}", folder.display()))
            .map_err(refuse)?;
    }
    let bar = output::progress(report::Data::rounds(args.quick), "report");
    let data = report::Data::measure(args.quick, &mut |what| {
        bar.set_message(what);
        bar.inc(1);
    })?;
    bar.finish_and_clear();
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

/// Creates the folder, and a file in it that is taken away again.
fn try_writing(folder: &Path) -> std::io::Result<()> {
    std::fs::create_dir_all(folder)?;
    let trial = folder.join("trial.part");
    std::fs::write(&trial, "")?;
    std::fs::remove_file(trial)
}
