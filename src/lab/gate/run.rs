//! The bench run under callgrind, and its counts read.

use std::collections::BTreeMap;
use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::sync::mpsc;

use serde_json::Value;

use super::{Counts, Kind};

/// Why there are no counts.
#[derive(Debug, thiserror::Error)]
pub enum RunError {
    /// Not where the sources are.
    #[error("the gate runs in a checkout of lamina2d: {0}")]
    Checkout(String),
    /// A program that cannot be started or read.
    #[error("cannot run {BENCH}: {0}")]
    Start(#[from] std::io::Error),
    /// The bench did not build, or a bench failed.
    #[error("{BENCH} failed: {0}")]
    Failed(std::process::ExitStatus),
    /// The runner said something else than expected.
    #[error("the runner's summary of {bench}: {why}")]
    Summary {
        /// The bench, as far as it is known.
        bench: String,
        /// What is missing.
        why: &'static str,
    },
}

/// What runs, for messages.
const BENCH: &str = "cargo bench --bench instructions";

/// What `benches/instructions.rs` is told to run by `LAMINA_INSTRUCTIONS`.
const KERNELS: &str = "kernels";
const SCENES: &str = "scenes";
const PROOF: &str = "proof";

/// Counts all kernels and scenes, in two processes at once: counts do not depend on what else runs. `tick` is told
/// each bench that is done.
///
/// # Errors
/// No checkout, a bench that does not build or fails, a summary without a count.
pub fn count(tick: &mut dyn FnMut(&str)) -> Result<Counts, RunError> {
    let mut counts = Counts::default();
    run(&[KERNELS, SCENES], &mut |kind, name, count| {
        tick(&name);
        counts.of_mut(kind).insert(name, count);
    })?;
    Ok(counts)
}

/// Counts the kernel that the gate proves itself with: by name.
///
/// # Errors
/// Those of [`count`].
pub(super) fn count_proof() -> Result<BTreeMap<String, u64>, RunError> {
    let mut counts = BTreeMap::new();
    run(&[PROOF], &mut |_, name, count| {
        counts.insert(name, count);
    })?;
    Ok(counts)
}

/// Runs groups at once and hands on what they counted, as it comes.
fn run(groups: &[&str], tell: &mut dyn FnMut(Kind, String, u64)) -> Result<(), RunError> {
    build()?;
    let mut runs = groups.iter().map(|group| start(group)).collect::<Result<Vec<_>, _>>()?;
    let (said, lines) = mpsc::channel();
    std::thread::scope(|scope| {
        for output in runs.iter_mut().filter_map(|run| run.0.stdout.take()) {
            let said = said.clone();
            scope.spawn(move || BufReader::new(output).lines().try_for_each(|line| said.send(line)));
        }
        drop(said);
        let mut heard = Ok(());
        for line in lines {
            match line.map_err(RunError::from).and_then(|line| read(&line)) {
                Ok(None) => {}
                Ok(Some((kind, name, count))) => tell(kind, name, count),
                // The others go on: a process that is left alone would run on beside whatever comes next.
                Err(error) => heard = heard.and(Err(error)),
            }
        }
        heard
    })?;
    runs.into_iter().try_for_each(Run::end)
}

/// A `cargo bench` on its way.
struct Run(Child);

impl Run {
    fn end(mut self) -> Result<(), RunError> {
        let status = self.0.wait()?;
        if status.success() { Ok(()) } else { Err(RunError::Failed(status)) }
    }
}

/// Builds the bench, so that processes started afterwards need not wait for each other.
fn build() -> Result<(), RunError> {
    if !Path::new("benches/instructions.rs").is_file() {
        return Err(RunError::Checkout("there is no benches/instructions.rs here".to_owned()));
    }
    Run(cargo(&["--no-run"]).spawn()?).end()
}

fn start(group: &str) -> Result<Run, RunError> {
    let mut command = cargo(&["--quiet", "--", "--output-format=json", "--nosummary"]);
    Ok(Run(command.env("LAMINA_INSTRUCTIONS", group).spawn()?))
}

/// The bench by the cargo that runs this program, with the flags this program was built with.
fn cargo(more: &[&str]) -> Command {
    let program = std::env::var("CARGO").unwrap_or_else(|_| "cargo".to_owned());
    let mut command = Command::new(program);
    command.args(["bench", "--bench", "instructions"]).args(more);
    command.env("CARGO_ENCODED_RUSTFLAGS", crate::stamp::STAMP.flags.replace(' ', "\u{1f}"));
    command.stdin(Stdio::null()).stdout(Stdio::piped());
    command
}

/// Kind, name and instructions from one line of the runner; `None` for lines that are no summary.
fn read(line: &str) -> Result<Option<(Kind, String, u64)>, RunError> {
    let Some(summary) = serde_json::from_str::<Value>(line).ok().filter(Value::is_object) else {
        return Ok(None);
    };
    let function = summary["function_name"].as_str().unwrap_or_default();
    let details = summary["details"].as_str().unwrap_or_default();
    let missing = |why| RunError::Summary { bench: format!("{function} {details}"), why };
    // The argument as it stands in the source: kernel("narrow/box-box/150/x8").
    let name = details.split('"').nth(1).ok_or_else(|| missing("no name in its details"))?;
    let kind = match function {
        "kernels_once" | "proof_once" => Kind::Kernel,
        "steps_of_window" => Kind::Steps,
        _ => return Err(missing("a function the gate does not know")),
    };
    let count = &summary["profiles"][0]["summaries"]["total"]["summary"]["Callgrind"]["Ir"]["metrics"];
    // New alone, or new and that of the run before.
    let new = if count["Left"].is_null() { &count["Both"][0] } else { &count["Left"] };
    let new = new["Int"].as_u64().ok_or_else(|| missing("no instruction count"))?;
    Ok(Some((kind, name.to_owned(), new)))
}
