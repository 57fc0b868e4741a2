//! `lamina report`: all experiments into a folder, some of them into the terminal, or two reports side by side.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use anyhow::Context;
use lamina::gate;
use lamina::report::peers::{self, Peers};
use lamina::report::sweep::{self, Sweep};
use lamina::report::wild;
use lamina::report::{
    self, Data, EXPERIMENTS, Earlier, Experiment, Record, Stopped, Table, compare, instructions, readme,
    strip,
};
use lamina::stress;

use super::{output, refuse};

/// Arguments of `lamina report`.
#[derive(Debug, clap::Args)]
#[expect(clippy::struct_excessive_bools, reason = "flags of a command line")]
pub(crate) struct Args {
    /// Fewer bodies and repeats, no sweeps of accuracy and stability: under a minute. The default.
    #[arg(long, conflicts_with = "full")]
    quick: bool,
    /// Every experiment: minutes.
    #[arg(long)]
    full: bool,
    /// Run only these experiments, separated by commas, and print their tables; nothing is written.
    #[arg(long, value_name = "NAME,…", conflicts_with_all = ["out", "publish", "against"])]
    only: Option<String>,
    /// Where the page, tables and plots go.
    #[arg(long, value_name = "DIR", default_value = "reports/latest")]
    out: PathBuf,
    /// Also refresh the committed copy in reports/, and what README.md repeats of it; runs every experiment.
    #[arg(long, conflicts_with = "quick")]
    publish: bool,
    /// Compare with the report in this folder: ratios with the machine's drift taken out.
    #[arg(long, value_name = "DIR")]
    against: Option<PathBuf>,
    /// What lamina-peers measured, to be shown; left out where there is no such file.
    #[arg(long, value_name = "FILE", default_value = "reports/peers.json")]
    peers: PathBuf,
    /// What lamina gate holds, to be shown; left out where there is no such file.
    #[arg(long, value_name = "FILE", default_value = "reports/instructions.toml")]
    instructions: PathBuf,
    /// What lamina stress found, to be shown; left out where there is no such file.
    #[arg(long, value_name = "FILE", default_value = "reports/stress/stress.json")]
    stress: PathBuf,
    /// What lamina-peers wild found, to be shown; left out where there is no such file.
    #[arg(long, value_name = "FILE", default_value = "reports/wild.json")]
    wild: PathBuf,
    /// The accuracy sweep of an earlier full report, to be shown where this one has none; left out where there is no such
    /// file.
    #[arg(long, value_name = "FILE", default_value = "reports/accuracy.json")]
    accuracy: PathBuf,
    /// Print a JSON summary.
    #[arg(long)]
    json: bool,
}

pub(crate) fn main(args: &Args) -> anyhow::Result<()> {
    if let Some(names) = &args.only {
        return only(args, &chosen(names).map_err(refuse)?);
    }
    if args.out.exists() && !args.out.is_dir() {
        return Err(refuse(anyhow::anyhow!("--out: {} is not a folder", args.out.display())));
    }
    // Read before the first measurement, and before anything is written over it.
    let before = args.against.as_ref().map(|folder| compare::read(folder)).transpose();
    let before = before.context("--against").map_err(refuse)?;
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
    let Beside { peers, instructions, stress, wild, accuracy } = beside(args).map_err(refuse)?;
    let quick = !(args.full || args.publish);
    let mut data = measure(quick, &Experiment::of_report(quick))?;
    if data.not_run.is_empty() {
        data.strips = strip::strips()?;
    }
    let earlier_accuracy = accuracy.filter(|_| data.accuracy.lines.is_empty());
    let data = Data { peers, instructions, stress, wild, earlier_accuracy, ..data };
    let folders = if data.not_run.is_empty() { &folders[..] } else { &folders[..1] };
    for folder in folders {
        report::write(&data, folder)
            .with_context(|| format!("cannot write the report into {}", folder.display()))?;
    }
    if args.publish && data.not_run.is_empty() {
        let readme = std::fs::read_to_string("README.md").context("README.md")?;
        std::fs::write("README.md", readme::refreshed(&readme, &data)?).context("README.md")?;
    }
    say(args, &data, before.as_ref())?;
    if data.not_run.is_empty() {
        return Ok(());
    }
    Err(anyhow::anyhow!(
        "interrupted: {} hold what was measured; not run: {}",
        args.out.display(),
        data.not_run.join(", ")
    ))
}

/// Says what the report found: a comparison, a document, or the result table, five lines and where the page is.
fn say(args: &Args, data: &Data, before: Option<&serde_json::Value>) -> anyhow::Result<()> {
    if let (Some(before), Some(folder)) = (before, &args.against) {
        let comparison = compare::compare(before, data, &folder.display().to_string())?;
        return print_comparison(&comparison, args.json);
    }
    if args.json {
        return output::print_json(&data.summary()?);
    }
    let results = Table::of(&data.headlines())?;
    output::print_text(&output::table(&results.header, results.lines))?;
    output::print_text("")?;
    for line in data.five_lines() {
        output::print_text(&line)?;
    }
    output::print_text(&format!("Page: {}", args.out.join("index.html").display()))
}

/// What other programs and commands have measured.
struct Beside {
    peers: Option<Peers>,
    instructions: (Vec<instructions::Row>, Option<Earlier>),
    stress: (Vec<stress::Row>, Option<Earlier>),
    wild: (Vec<wild::Line>, Option<Earlier>),
    accuracy: Option<Sweep>,
}

/// Reads it where its files are.
fn beside(args: &Args) -> anyhow::Result<Beside> {
    let peers = args.peers.exists().then(|| peers::read(&args.peers)).transpose()?;
    let counts = args.instructions.exists().then(|| gate::baseline(&args.instructions)).transpose()?;
    let last = counts.as_ref().and_then(|counts| counts.baseline.last());
    let stress = if args.stress.exists() { stress::write::read(&args.stress)? } else { Default::default() };
    let wild = if args.wild.exists() { wild::read(&args.wild)? } else { Default::default() };
    let instructions =
        (last.map(instructions::rows).unwrap_or_default(), last.and_then(instructions::earlier));
    let accuracy = args.accuracy.exists().then(|| sweep::read(&args.accuracy)).transpose()?;
    Ok(Beside { peers, instructions, stress, wild, accuracy })
}

/// The experiments of a list of names.
fn chosen(names: &str) -> anyhow::Result<Vec<Experiment>> {
    let find = |name: &str| {
        EXPERIMENTS.iter().find(|e| e.name == name).copied().with_context(|| {
            let choices = EXPERIMENTS.iter().map(|e| e.name).collect::<Vec<_>>().join(", ");
            format!("--only: unknown experiment '{name}': one of {choices}")
        })
    };
    names.split(',').map(|name| find(name.trim())).collect()
}

/// Measures, until it is done or Ctrl-C asks for an end: then with what there is. A second Ctrl-C ends at once.
fn measure(quick: bool, experiments: &[Experiment]) -> anyhow::Result<Data> {
    let asked = Arc::new(AtomicBool::new(false));
    let handler = {
        let asked = Arc::clone(&asked);
        move || {
            if asked.swap(true, Ordering::SeqCst) {
                std::process::exit(130);
            }
            output::warn(
                "interrupted: ending after this round, with what was measured; once more ends at once",
            );
        }
    };
    // Where there is no handler to be had, Ctrl-C ends the program as it always did.
    let _ = ctrlc::set_handler(handler);
    let bar = output::progress(Data::rounds(quick, experiments), "report");
    let data = Data::measure(quick, experiments, &mut |what| {
        bar.set_message(what);
        bar.inc(1);
        if asked.load(Ordering::SeqCst) { Err(Stopped) } else { Ok(()) }
    })?;
    bar.finish_and_clear();
    Ok(data)
}

fn only(args: &Args, experiments: &[Experiment]) -> anyhow::Result<()> {
    let data = measure(!args.full, experiments)?;
    if args.json {
        return output::print_json(&data.summary()?);
    }
    for table in data.tables()? {
        output::print_text(&format!("{}. {}\n", table.title, table.note))?;
        output::print_text(&output::table(&table.header, table.lines))?;
        output::print_text("")?;
    }
    Ok(())
}

fn print_comparison(comparison: &compare::Comparison, json: bool) -> anyhow::Result<()> {
    if json {
        return output::print_json(comparison);
    }
    let (slower, faster) = ["slower", "faster"]
        .map(|verdict| comparison.rows.iter().filter(|row| row.verdict == verdict).count())
        .into();
    output::print_text(&format!(
        "{} after {}: the machine took {:.2} times as long for {} rows of engines that stayed as they are. Of {} others \
         {slower} are slower, {faster} faster than that explains.\n",
        comparison.after,
        comparison.before,
        comparison.drift,
        comparison.controls,
        comparison.rows.len(),
    ))?;
    let cells = comparison.rows.iter().map(Record::cells);
    output::print_text(&output::table(compare::Row::HEADER, cells))
}

/// Creates the folder, and a file in it that is taken away again.
fn try_writing(folder: &Path) -> std::io::Result<()> {
    std::fs::create_dir_all(folder)?;
    let trial = folder.join("trial.part");
    std::fs::write(&trial, "")?;
    std::fs::remove_file(trial)
}
