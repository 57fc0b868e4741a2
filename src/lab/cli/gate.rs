//! `lamina gate`: instruction counts against those that were blessed.

use std::io::Write;
use std::path::{Path, PathBuf};

use anyhow::{Context, anyhow};
use lamina::gate::{
    self, BaselineError, Baselines, Comparison, Document, Export, Row, RunError, Toolchain, Verdict,
};

use super::{output, refuse};

/// Arguments of `lamina gate`.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// The blessed counts; history.md beside it has a line per blessing.
    #[arg(long, value_name = "FILE", default_value = "reports/instructions.toml")]
    baseline: PathBuf,
    /// Compare counts that --format json printed, instead of counting.
    #[arg(long, value_name = "FILE")]
    counts: Option<PathBuf>,
    /// Make the counts the ones to compare with, for this reason.
    #[arg(long, value_name = "REASON")]
    bless: Option<String>,
    /// Prove that the gate catches 1 % more work, twice the work, and counts that are absent, 0 or of another toolchain.
    #[arg(long, conflicts_with_all = ["bless", "counts", "format"])]
    self_test: bool,
    /// Print the counts for other tools.
    #[arg(long, value_enum)]
    format: Option<Format>,
}

/// Documents for other tools.
#[derive(Clone, Copy, Debug, clap::ValueEnum)]
enum Format {
    /// Bencher Metric Format.
    Bencher,
    /// github-action-benchmark's customSmallerIsBetter.
    GithubAction,
    /// Toolchain, counts and comparison.
    Json,
}

impl From<Format> for Export {
    fn from(format: Format) -> Self {
        match format {
            Format::Bencher => Self::Bencher,
            Format::GithubAction => Self::GithubAction,
            Format::Json => Self::Json,
        }
    }
}

pub(crate) fn main(args: &Args) -> anyhow::Result<()> {
    if args.self_test {
        return self_test();
    }
    let reason = args.bless.as_deref().map(checked_reason).transpose()?;
    // Read before anything is counted: a file that cannot be used is known at once.
    let baselines = match gate::baseline(&args.baseline) {
        Err(BaselineError::Missing { .. }) if reason.is_some() => Baselines::default(),
        Err(error @ BaselineError::Missing { .. }) => return Err(error.into()),
        Err(error) => return Err(refuse(error)),
        Ok(baselines) => baselines,
    };
    let document = match &args.counts {
        Some(path) => gate::counted(path).map_err(refuse)?,
        None => count(&baselines, reason.is_some())?,
    };
    let old = baselines.of(&document.toolchain).map(gate::Baseline::counts);
    let comparison = gate::compare(&old.clone().unwrap_or_default(), &document.counts);
    if let Some(reason) = reason {
        bless(args, baselines, &document, &comparison, reason)?;
    }
    print(args.format, &document, &comparison)?;
    match (reason, old, comparison.failure()) {
        (Some(_), ..) | (None, Some(_), None) => Ok(()),
        (None, None, _) => Err(anyhow!(unknown(args, &document.toolchain)?)),
        (None, Some(_), Some(failure)) => {
            Err(anyhow!("{failure}; if that is meant to be so: lamina gate --bless REASON"))
        }
    }
}

/// A reason is one line of a table.
fn checked_reason(reason: &str) -> anyhow::Result<&str> {
    let reason = reason.trim();
    if reason.is_empty() || reason.contains(['\n', '\r', '|']) {
        return Err(refuse(anyhow!("--bless: a reason is one line without '|', got {reason:?}")));
    }
    Ok(reason)
}

/// The tools, or what installs them.
fn toolchain() -> anyhow::Result<Toolchain> {
    Toolchain::find().map_err(refuse)
}

/// Counts, unless it is known beforehand that there is nothing to compare with.
fn count(baselines: &Baselines, blessing: bool) -> anyhow::Result<Document> {
    let toolchain = toolchain()?;
    if !blessing && baselines.of(&toolchain).is_none() {
        return Err(anyhow!(baselines.unknown(&toolchain)));
    }
    let known = baselines.of(&toolchain).map_or(0, |entry| entry.counts().len());
    let bar = output::progress(known as u64, "instructions");
    let counted = gate::count(&mut |_| bar.inc(1));
    bar.finish_and_clear();
    Ok(Document { toolchain, counts: counted.map_err(failed)? })
}

fn failed(error: RunError) -> anyhow::Error {
    match error {
        RunError::Checkout(_) => refuse(error),
        error => error.into(),
    }
}

fn unknown(args: &Args, toolchain: &Toolchain) -> anyhow::Result<String> {
    Ok(gate::baseline(&args.baseline)?.unknown(toolchain))
}

/// Writes the counts and the line of history.
fn bless(
    args: &Args,
    mut baselines: Baselines,
    document: &Document,
    comparison: &Comparison,
    reason: &str,
) -> anyhow::Result<()> {
    let Document { toolchain, counts } = document;
    if counts.is_empty() {
        return Err(anyhow!("nothing was counted: nothing to bless"));
    }
    if let Some(name) = counts.zero() {
        return Err(anyhow!("the count of '{name}' is 0: not blessed"));
    }
    let commit = gate::commit();
    baselines.bless(toolchain, counts, format!("{commit}: {reason}"));
    let writing = |path: &Path| format!("cannot write {}", path.display());
    let history = args.baseline.with_file_name("history.md");
    let line = gate::history_line(&commit, reason, toolchain, comparison);
    std::fs::write(&args.baseline, baselines.to_text()?).with_context(|| writing(&args.baseline))?;
    gate::append_history(&history, &line).with_context(|| writing(&history))
}

/// The document, or the table and what it comes to.
fn print(format: Option<Format>, document: &Document, comparison: &Comparison) -> anyhow::Result<()> {
    if let Some(format) = format {
        let written = Export::from(format).write(document, Some(comparison));
        return output::print_text(&serde_json::to_string_pretty(&written)?);
    }
    let header = ["bench", "old", "new", "change", "bound", "verdict"];
    output::print_text(&output::table(&header, comparison.rows.iter().map(cells)))?;
    let of = |verdict| comparison.count(verdict);
    output::print_text(&format!(
        "{} benches: {} the same, {} within their bound, {} fewer, {} more; {}",
        comparison.rows.len(),
        of(Verdict::Same),
        of(Verdict::Within),
        of(Verdict::Fewer),
        of(Verdict::More),
        document.toolchain,
    ))?;
    if of(Verdict::Fewer) > 0 {
        output::print_text("Fewer past the bound: keep them with lamina gate --bless REASON")?;
    }
    Ok(())
}

fn cells(row: &Row) -> Vec<String> {
    let count = |count: Option<u64>| count.map_or_else(|| "–".to_owned(), |count| count.to_string());
    vec![
        row.name.clone(),
        count(row.old),
        count(row.new),
        row.change.map_or_else(|| "–".to_owned(), |change| format!("{:+.3} %", change * 100.0)),
        format!("{:.1} %", row.bound * 100.0),
        row.verdict.name().to_owned(),
    ]
}

fn self_test() -> anyhow::Result<()> {
    let proofs = gate::prove(&toolchain()?).map_err(failed)?;
    let rows = proofs.iter().map(|proof| {
        let holds = if proof.holds { "yes" } else { "NO" };
        vec![proof.what.clone(), proof.said.clone(), holds.to_owned()]
    });
    output::print_text(&output::table(&["tried", "the gate said", "right"], rows))?;
    std::io::stdout().flush()?;
    let wrong: Vec<_> = proofs.iter().filter(|proof| !proof.holds).map(|proof| proof.what.as_str()).collect();
    if wrong.is_empty() { Ok(()) } else { Err(anyhow!("the gate does not catch: {}", wrong.join(", "))) }
}
