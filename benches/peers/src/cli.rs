//! The program: arguments in, a table or one JSON document out.
//!
//! Exit codes: 0 done; 1 a run that failed (a file that cannot be written); 2 input that was refused.

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::Context;
use clap::Parser;
use comfy_table::{CellAlignment, ContentArrangement, Table, presets};
use indicatif::{ProgressBar, ProgressStyle};
use lamina::cases::{self, SCENES};
use lamina::report::Machine;
use lamina_peers::about;
use lamina_peers::blueprint::Blueprint;
use lamina_peers::plan::{self, Group};
use lamina_peers::row::Row;
use lamina_peers::run::{Results, ticks};
use lamina2d::scene::{self, Scene};
use serde_json::json;

/// Where random scenes come from.
const SEED: u64 = 1;

/// lamina2d, Box2D and rapier on the same scenes, in turns, in one process.
#[derive(Debug, Parser)]
#[command(
    name = "lamina-peers",
    version,
    about,
    max_term_width = 100,
    args_conflicts_with_subcommands = true
)]
struct Args {
    #[command(subcommand)]
    command: Option<Command>,
    /// Scenes by name, name/parameter, or .toml files [default: the whole plan, about a quarter of an hour].
    scenes: Vec<String>,
    /// Print one JSON document.
    #[arg(long)]
    json: bool,
    /// A small plan, about a minute.
    #[arg(long)]
    quick: bool,
    /// Write the JSON document to this file.
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// List the plan and run nothing.
    #[arg(long)]
    list: bool,
}

#[derive(Debug, clap::Subcommand)]
enum Command {
    /// Run scenes made from public problem reports with every engine and hold each to its right numbers.
    Wild {
        /// Only these: a kind, or how a case's name begins.
        #[arg(value_name = "CASE")]
        cases: Vec<String>,
        /// Print one JSON document.
        #[arg(long)]
        json: bool,
        /// Write the JSON document to this file.
        #[arg(long, value_name = "FILE")]
        out: Option<PathBuf>,
    },
}

/// Input that was refused: exit code 2.
#[derive(Debug, thiserror::Error)]
#[error(transparent)]
struct Refused(#[from] anyhow::Error);

fn refuse(error: impl Into<anyhow::Error>) -> anyhow::Error {
    anyhow::Error::new(Refused(error.into()))
}

/// Parses the arguments and runs.
pub(crate) fn main() -> ExitCode {
    let args = Args::parse();
    let mut err = std::io::stderr();
    match run(&args) {
        Ok(()) => ExitCode::SUCCESS,
        // A reader that went away is not an error.
        Err(error) if is_broken_pipe(&error) => ExitCode::SUCCESS,
        Err(error) => {
            let _ = writeln!(err, "lamina-peers: {error:#}");
            ExitCode::from(if error.is::<Refused>() { 2 } else { 1 })
        }
    }
}

fn is_broken_pipe(error: &anyhow::Error) -> bool {
    let kind =
        |e: &(dyn std::error::Error + 'static)| e.downcast_ref::<std::io::Error>().map(std::io::Error::kind);
    error.chain().any(|cause| kind(cause) == Some(std::io::ErrorKind::BrokenPipe))
}

fn bar(length: u64) -> anyhow::Result<ProgressBar> {
    let bar = ProgressBar::new(length);
    bar.set_style(ProgressStyle::with_template("{msg:20} {wide_bar} {pos}/{len} {eta}")?);
    Ok(bar)
}

fn wild(cases: &[String], json: bool, out: Option<&Path>) -> anyhow::Result<()> {
    let cases = lamina::wild::chosen(cases).map_err(refuse)?;
    let bar = bar(cases.len() as u64)?;
    let wild = lamina_peers::wild::run(&cases, |name| {
        bar.set_message(name.to_owned());
        bar.inc(1);
    });
    bar.finish_and_clear();
    let document = json!({"machine": Machine::read(), "engines": about::engines(), "counts": wild.counts, "rows": wild.rows, "gaps": wild.gaps});
    let text = serde_json::to_string_pretty(&document)?;
    if let Some(path) = out {
        write_whole(path, &text)?;
    }
    if json {
        return print(&text);
    }
    wild.counts.iter().try_for_each(|count| {
        print(&format!("{}: {} of {} right", count.engine, count.tally.right, count.tally.cases))
    })
}

fn run(args: &Args) -> anyhow::Result<()> {
    if let Some(Command::Wild { cases, json, out }) = &args.command {
        return wild(cases, *json, out.as_deref());
    }
    let groups = groups(args)?;
    if args.list {
        return list(&groups);
    }
    let bar = bar(groups.iter().map(|(_, group)| ticks(group)).sum())?;
    let mut results = Results::default();
    for (scene, group) in &groups {
        bar.set_message(scene.name.clone());
        results.add(scene, group, &mut || bar.inc(1)).map_err(refuse)?;
    }
    bar.finish_and_clear();
    let document = json!({"machine": Machine::read(), "engines": about::engines(), "rows": results.rows, "gaps": results.gaps});
    let text = serde_json::to_string_pretty(&document)?;
    if let Some(path) = &args.out {
        write_whole(path, &text)?;
    }
    if args.json {
        return print(&text);
    }
    print(&table(&results.rows))?;
    results.gaps.iter().try_for_each(|gap| print(&gap.why))
}

/// The scenes asked for, each with how it is run.
fn groups(args: &Args) -> anyhow::Result<Vec<(Scene, Group)>> {
    let planned = if args.quick { plan::quick() } else { plan::full() };
    if args.scenes.is_empty() {
        return planned.into_iter().map(|group| Ok((load(&group.scene)?, group))).collect();
    }
    let asked = |name: &String| {
        let scene = load(name)?;
        let group = planned.iter().find(|group| group.scene == scene.name).cloned();
        let group = group.unwrap_or_else(|| Group::of(&scene));
        Ok((scene, group))
    };
    let groups: Vec<(Scene, Group)> = args.scenes.iter().map(asked).collect::<anyhow::Result<_>>()?;
    // Refused before anything runs.
    for (scene, _) in &groups {
        Blueprint::of(scene).with_context(|| format!("scene {}", scene.name)).map_err(refuse)?;
    }
    Ok(groups)
}

fn load(name: &str) -> anyhow::Result<Scene> {
    let is_file = Path::new(name).extension().is_some_and(|e| e.eq_ignore_ascii_case("toml"));
    let scene = if is_file {
        scene::file::read(name).map(|(scene, _)| scene)
    } else {
        cases::by_name(name, None, SEED)
    };
    scene.map_err(refuse)
}

/// Writes beside the file and renames: it is there whole or not at all.
fn write_whole(path: &Path, text: &str) -> anyhow::Result<()> {
    let mut part = path.as_os_str().to_owned();
    part.push(".part");
    let write = || {
        fs::write(&part, text)?;
        fs::rename(&part, path)
    };
    write().with_context(|| format!("cannot write {}", path.display()))
}

fn print(text: &str) -> anyhow::Result<()> {
    let mut out = std::io::stdout().lock();
    writeln!(out, "{text}")?;
    Ok(out.flush()?)
}

fn list(groups: &[(Scene, Group)]) -> anyhow::Result<()> {
    for (scene, group) in groups {
        let setups: Vec<_> =
            (group.setups.iter()).map(|s| format!("{} {} on {}", s.engine, s.words(), s.threads)).collect();
        print(&format!(
            "{}, {} steps, {} timed: {}",
            scene.name,
            group.total(),
            group.windows * group.steps,
            setups.join("; ")
        ))?;
    }
    let names: Vec<_> = SCENES.iter().map(|s| s.name).collect();
    print(&format!("Any scene of the library can be named: {}", names.join(", ")))
}

/// Millimetres, or nothing.
fn mm(metres: Option<f64>) -> String {
    metres.map_or_else(String::new, |m| format!("{:.2}", m * 1e3))
}

fn table(rows: &[Row]) -> String {
    let header = [
        "scene",
        "engine",
        "threads",
        "settings",
        "min ms",
        "median ms",
        "p99 ms",
        "contacts",
        "max pen mm",
        "mean pen mm",
        "sunk mm",
        "joint gap mm",
        "error",
        "momentum",
        "asleep",
        "escaped",
    ];
    let mut table = Table::new();
    table.load_style(presets::ASCII_MARKDOWN).set_content_arrangement(ContentArrangement::Disabled);
    table.set_header(header.to_vec());
    let short = |value: Option<f64>| value.map_or_else(String::new, |v| format!("{v:.1e}"));
    for row in rows {
        table.add_row(vec![
            row.scene.clone(),
            row.engine.to_owned(),
            row.threads.to_string(),
            row.stopped
                .as_ref()
                .map_or_else(|| row.settings.clone(), |why| format!("{}, {why}", row.settings)),
            format!("{:.4}", row.ms_per_step.min),
            format!("{:.4}", row.ms_per_step.median),
            format!("{:.4}", row.ms_per_step.p99),
            row.contacts.to_string(),
            mm(Some(row.max_penetration)),
            mm(Some(row.mean_penetration)),
            mm(row.sunk),
            mm(row.joint_gap),
            short(row.error),
            short(row.momentum_error),
            row.asleep.to_string(),
            row.escaped.to_string(),
        ]);
    }
    for column in table.column_iter_mut().skip(4) {
        column.set_cell_alignment(CellAlignment::Right);
    }
    table.to_string()
}
