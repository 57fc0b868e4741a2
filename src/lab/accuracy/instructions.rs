//! Instructions, counted by callgrind: the axis of time that says the same on every run.
//!
//! The program runs itself under valgrind, once per case. Each row at the usual lane width is one call of
//! `counted_window`: callgrind collects from its entry to its exit, and writes down what it has there.

use std::path::Path;
use std::process::{Command, Stdio};

use anyhow::{Context, bail, ensure};

use lamina2d::settings::{Precision, Settings};
use lamina2d::simulation::{Simulation, simulate};

use super::case::Case;
use super::sweep::{Bench, Effort, Results, Row};

/// Steps of a window, at most: an instruction takes fifty times as long there.
const MOST_STEPS: u32 = 40;

/// So many steps, or as many as stay finite. Not to be inlined: it is found by its name.
#[inline(never)]
fn counted_window(world: &mut dyn Simulation, h_secs: f64, steps: u32) -> u32 {
    (0..steps).take_while(|_| world.step(h_secs).is_ok()).count() as u32
}

impl Bench {
    /// Precisions in the order of the rows, each with the settings of the usual width.
    fn usual() -> [Settings; 2] {
        [Precision::F64, Precision::F32].map(|precision| Settings::default().with_precision(precision))
    }

    fn counted_steps(&self, steps: u32) -> u32 {
        if self.case.is_mix() { steps } else { steps.min(MOST_STEPS) }
    }
}

/// What runs under valgrind: the window of each row of [`count`], in its order.
///
/// # Errors
/// A scene that cannot be run.
pub fn windows(case: &'static Case, effort: Effort) -> anyhow::Result<()> {
    let bench = Bench::of(case, effort)?;
    for &(method, _) in case.methods {
        for usual in Bench::usual() {
            for pace in bench.paces(method) {
                let settings = Settings { dt_secs: pace.h_secs, ..bench.settings(method, usual) };
                let mut world = simulate(&bench.timed.0, settings)?;
                counted_window(world.as_mut(), pace.h_secs, bench.counted_steps(pace.steps));
            }
        }
    }
    Ok(())
}

/// Counts the rows of a case that came to their end, at the usual lane widths.
///
/// # Errors
/// No valgrind, one that cannot run this program, another number of windows than of rows.
pub fn count(results: &mut Results, effort: Effort) -> anyhow::Result<()> {
    let bench = Bench::of(results.case, effort)?;
    let folder = std::env::temp_dir().join(format!("lamina-counts-{}", std::process::id()));
    std::fs::create_dir_all(&folder)?;
    let counted = run(results.case.name, effort, &folder).and_then(|()| read(&folder));
    std::fs::remove_dir_all(&folder)?;
    let mut counts = counted?.into_iter();
    let usual = Bench::usual().map(|settings| (settings.precision.name(), settings.lanes));
    for row in results.rows.iter_mut().filter(|row| usual.contains(&(row.precision, row.lanes))) {
        let Some(count) = counts.next() else { bail!("{}: fewer windows than rows", row.case) };
        let steps = (bench.case.horizon_of(row) / row.h).round();
        let per_step = count as f64 / f64::from(bench.counted_steps(steps as u32)) / bench.timed.1 as f64;
        if row.error.is_some() {
            row.instructions_per_step = Some(per_step);
            row.instructions_total = Some(per_step * steps);
        }
    }
    ensure!(counts.next().is_none(), "{}: more windows than rows", results.case.name);
    Ok(())
}

impl Case {
    /// Seconds a row ran.
    fn horizon_of(&self, row: &Row) -> f64 {
        match self.sweep {
            super::case::Sweep::Halvings { .. } => self.horizon_secs,
            super::case::Sweep::Limits { .. } => f64::from(super::sweep::LIMIT_STEPS) * row.h,
        }
    }
}

/// Is there a valgrind?
///
/// # Errors
/// None: says what installs it.
pub fn check() -> anyhow::Result<()> {
    let found = Command::new("valgrind").arg("--version").stdin(Stdio::null()).output();
    ensure!(
        found.is_ok_and(|found| found.status.success()),
        "--instructions: there is no valgrind: apt-get install valgrind"
    );
    Ok(())
}

fn run(case: &str, effort: Effort, folder: &Path) -> anyhow::Result<()> {
    let mut command = Command::new("valgrind");
    // In full: of two patterns callgrind heeds the first.
    let window = concat!(module_path!(), "::counted_window");
    command.args(["--tool=callgrind", "--collect-atstart=no"]);
    command.args([format!("--toggle-collect={window}"), format!("--dump-after={window}")]);
    command.arg(format!("--callgrind-out-file={}", folder.join("window").display()));
    command.arg(std::env::current_exe()?).args(["accuracy", case, "--counted-windows"]);
    if effort.quick {
        command.arg("--quick");
    }
    // The environment lies on the stack, and its size moves what lies there.
    let path = std::env::var_os("PATH").unwrap_or_default();
    let said = command.env_clear().env("PATH", path).stdin(Stdio::null()).output();
    let said = said.context("valgrind cannot be started")?;
    let last = String::from_utf8_lossy(&said.stderr).lines().last().unwrap_or_default().to_owned();
    ensure!(said.status.success(), "{case} under valgrind: {}: {last}", said.status);
    Ok(())
}

/// The total of each dump, `window.1` first.
fn read(folder: &Path) -> anyhow::Result<Vec<u64>> {
    let mut counts = Vec::new();
    loop {
        let path = folder.join(format!("window.{}", counts.len() + 1));
        if !path.exists() {
            return Ok(counts);
        }
        let text = std::fs::read_to_string(&path)?;
        let total = text.lines().find_map(|line| line.strip_prefix("totals: "));
        let total = total.and_then(|total| total.trim().parse().ok());
        counts.push(total.with_context(|| format!("{} has no total", path.display()))?);
    }
}
