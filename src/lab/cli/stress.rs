//! `lamina stress`: where it breaks, case by case.

use std::path::PathBuf;

use anyhow::Context;
use indicatif::ProgressBar;
use lamina::report::Record;
use lamina::stress::{Case, Limit, Row, answers, chosen, limit, run, write};
use lamina2d::settings::{Precision, Settings, Solver};
use serde_json::json;

use super::{output, refuse};

/// Arguments of `lamina stress`.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// Only these cases; all where none is named.
    #[arg(value_name = "CASE")]
    cases: Vec<String>,
    /// Only this solver; else the default with each number of substeps, and the others with the middle one.
    #[arg(long)]
    solver: Option<Solver>,
    /// Rounds per step, separated by commas.
    #[arg(long, value_delimiter = ',', default_values_t = [4, 8, 16], value_name = "N,…")]
    substeps: Vec<u32>,
    /// f32 or f64.
    #[arg(long, default_value = "f32")]
    precision: Precision,
    /// Look for the number at which each case breaks.
    #[arg(long)]
    limit: bool,
    /// Shorter runs: under three minutes.
    #[arg(long)]
    quick: bool,
    /// Print the rows as JSON.
    #[arg(long)]
    json: bool,
    /// Where each case's CSV, JSON and drawing go, and stress.json with all rows.
    #[arg(long, value_name = "DIR", default_value = "reports/latest/stress")]
    out: PathBuf,
}

pub(crate) fn main(args: &Args) -> anyhow::Result<()> {
    let cases = chosen(&args.cases).map_err(refuse)?;
    let settings = settings(args)?;
    std::fs::create_dir_all(&args.out)
        .with_context(|| format!("--out: cannot write into {}", args.out.display()))
        .map_err(refuse)?;
    let bar = output::progress((cases.len() * settings.len()) as u64, "stress");
    let mut all = Vec::new();
    for &case in &cases {
        bar.set_message(case.name);
        let rows = run_case(args, case, &settings, &bar)?;
        write::case(case, &rows, &args.out)?;
        all.extend(rows);
        // What is there when a later case is interrupted is whole.
        write::all(&all, &args.out)?;
    }
    bar.finish_and_clear();
    if args.json {
        return output::print_json(&json!({"rows": all}));
    }
    output::print_text(&output::table(Row::HEADER, all.iter().map(Record::cells)))?;
    output::print_text("")?;
    for sentence in answers(&all) {
        output::print_text(&sentence)?;
    }
    output::print_text(&format!("\nRows and drawings: {}", args.out.display()))
}

/// A case with all settings, on two threads where nothing else is asked: nothing is timed.
fn run_case(args: &Args, case: &Case, settings: &[Settings], bar: &ProgressBar) -> anyhow::Result<Vec<Row>> {
    let secs = case.secs[usize::from(args.quick)];
    let one = |settings: Settings| -> anyhow::Result<Row> {
        let mut row = run(case, case.parameter.value, settings, secs)?;
        if args.limit && case.parameter.range[0] < case.parameter.range[1] {
            let Limit { holds, whole_range } = limit(case, settings, case.secs[1])?;
            row.limit = holds;
            row.limit_note = match holds {
                None => Some("none".to_owned()),
                Some(_) if whole_range => Some("harshest".to_owned()),
                Some(_) => None,
            };
        }
        bar.inc(1);
        Ok(row)
    };
    let next = std::sync::atomic::AtomicUsize::new(0);
    let work = || -> anyhow::Result<Vec<(usize, Row)>> {
        let mut rows = Vec::new();
        while let Some((k, &settings)) = {
            let k = next.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
            settings.get(k).map(|settings| (k, settings))
        } {
            rows.push((k, one(settings)?));
        }
        Ok(rows)
    };
    let threads = std::thread::available_parallelism().map_or(1, usize::from).min(settings.len());
    let mut rows = std::thread::scope(|scope| {
        let workers: Vec<_> = (0..threads).map(|_| scope.spawn(work)).collect();
        let mut rows = Vec::new();
        for worker in workers {
            rows.extend(worker.join().map_err(|_| anyhow::anyhow!("{}: a worker panicked", case.name))??);
        }
        anyhow::Ok(rows)
    })?;
    rows.sort_by_key(|(k, _)| *k);
    Ok(rows.into_iter().map(|(_, row)| row).collect())
}

/// The default solver with every number of substeps, the others with the middle one unless named.
fn settings(args: &Args) -> anyhow::Result<Vec<Settings>> {
    let default = Settings::default().with_precision(args.precision);
    let mut all = Vec::new();
    for &solver in Solver::ALL.iter().filter(|solver| args.solver.is_none_or(|only| only == **solver)) {
        let whole = solver == default.solver || args.solver.is_some();
        let middle = args.substeps.len() / 2;
        for (_, &substeps) in args.substeps.iter().enumerate().filter(|(k, _)| whole || *k == middle) {
            let settings = Settings { solver, substeps, ..default };
            settings.check().map_err(refuse)?;
            all.push(settings);
        }
    }
    Ok(all)
}
