//! Commands that read recordings: `lamina info`, `verify`, `diff`, `export`.

pub(crate) mod export;

use std::path::{Path, PathBuf};

use anyhow::ensure;
use lamina2d::record::{Apart, Difference, Recording, common_frames, first_difference, verify};
use lamina2d::settings::Settings;
use serde_json::{Value, json};

use super::{output, refuse};

/// Rows of a table of growth.
const GROWTH_ROWS: usize = 12;

/// Arguments of `lamina info`.
#[derive(Debug, clap::Args)]
pub(crate) struct InfoArgs {
    /// A recording, finished or not.
    file: PathBuf,
    /// Print JSON.
    #[arg(long)]
    json: bool,
}

/// Arguments of `lamina verify`.
#[derive(Debug, clap::Args)]
pub(crate) struct VerifyArgs {
    /// A recording, finished or not.
    file: PathBuf,
    /// Run it at this lane width, or at `all` [default: the one it was recorded at].
    #[arg(long)]
    lanes: Option<String>,
    /// Print JSON.
    #[arg(long)]
    json: bool,
}

/// Arguments of `lamina diff`.
#[derive(Debug, clap::Args)]
pub(crate) struct DiffArgs {
    /// A recording.
    a: PathBuf,
    /// Another one.
    b: PathBuf,
    /// Print JSON.
    #[arg(long)]
    json: bool,
}

/// Opens a recording; says on stderr how far it is good if it is not whole.
fn open(path: &Path) -> anyhow::Result<Recording> {
    let recording = Recording::open(path).map_err(refuse)?;
    if let Some(loss) = recording.loss() {
        output::warn(&format!("{}: {loss}", path.display()));
    }
    Ok(recording)
}

pub(crate) fn info(args: &InfoArgs) -> anyhow::Result<()> {
    let mut recording = open(&args.file)?;
    let bodies = recording.bodies(0).map(|table| table.bodies.len()).ok();
    let last = recording.rows().last().copied();
    let per_frame = recording.bytes() as f64 / recording.frames().max(1) as f64;
    let facts = json!({
        "file": args.file.display().to_string(),
        "run": recording.info(),
        "bodies": bodies,
        "steps": recording.rows().len(),
        "frames": recording.frames(),
        "events": recording.events().len(),
        "seconds": last.map(|row| row.values[0]),
        "hash": last.map(|row| format!("{:016x}", row.hash)),
        "bytes": recording.bytes(),
        "bytes_per_frame": per_frame.round(),
        "bytes_per_body_and_frame": bodies.map(|bodies| (per_frame / bodies.max(1) as f64 * 10.0).round() / 10.0),
        "loss": recording.loss().map(|loss| json!({
            "good_bytes": loss.good_bytes,
            "why": loss.why,
        })),
    });
    if args.json { output::print_json(&facts) } else { output::print_fields(&facts) }
}

pub(crate) fn verify_file(args: &VerifyArgs) -> anyhow::Result<()> {
    let mut recording = open(&args.file)?;
    let recorded = recording.info().settings;
    let widths = Settings::widths(recorded.precision);
    let lanes = match args.lanes.as_deref() {
        None => vec![recorded.lanes],
        Some("all") => widths.to_vec(),
        Some(given) => {
            let lanes = given.parse().ok().filter(|lanes| widths.contains(lanes));
            let refused =
                || refuse(anyhow::anyhow!("--lanes must be all or one of {widths:?}, got '{given}'"));
            vec![lanes.ok_or_else(refused)?]
        }
    };
    let steps = recording.rows().len();
    let mut rows = Vec::new();
    for &lanes in &lanes {
        let bar = output::progress(steps as u64, "verify");
        let difference = verify(&mut recording, Some(lanes), |step| {
            if step.is_multiple_of(64) {
                bar.set_position(step);
            }
        });
        bar.finish_and_clear();
        rows.push((lanes, difference.map_err(refuse)?));
    }
    let parted = rows.iter().any(|(_, difference)| difference.is_some());
    if args.json {
        let rows: Vec<Value> = rows
            .iter()
            .map(|(lanes, difference)| json!({ "lanes": lanes, "first_difference": difference }))
            .collect();
        output::print_json(&json!({ "steps": steps, "identical": !parted, "runs": rows }))?;
    } else {
        for (lanes, difference) in &rows {
            let said = difference.as_ref().map_or_else(
                || format!("identical: {steps} states, {lanes} lanes"),
                |difference| format!("{lanes} lanes: {}", sentence(difference, ["recorded", "run again"])),
            );
            output::print_text(&said)?;
        }
    }
    ensure!(!parted, "{}: the run is not the one recorded", args.file.display());
    Ok(())
}

/// A difference in words; `names`: of the two sides.
fn sentence(difference: &Difference, names: [&str; 2]) -> String {
    let step = difference.step;
    let said = format!("differs from step {step} on");
    let (Some(frame), Some(slot), Some(column), Some([a, b])) =
        (difference.frame_step, difference.slot, difference.column, difference.values)
    else {
        return said;
    };
    let later = if frame == step { String::new() } else { format!(" (first frame: step {frame})") };
    format!("{said}{later}: body {}, {column}: {} {a:?}, {} {b:?}", slot - 1, names[0], names[1])
}

pub(crate) fn diff(args: &DiffArgs) -> anyhow::Result<()> {
    let (mut a, mut b) = (open(&args.a)?, open(&args.b)?);
    let difference = first_difference(&mut a, &mut b).map_err(refuse)?;
    let growth = match &difference {
        Some(difference) => growth(&mut a, &mut b, difference.step)?,
        None => Vec::new(),
    };
    let common = a.rows().iter().filter(|row| b.row(row.step).is_some()).count();
    ensure!(common > 0, refuse(anyhow::anyhow!("the two recordings have no step in common")));
    let lengths = [a.rows().len(), b.rows().len()];
    if args.json {
        output::print_json(&json!({
            "identical": difference.is_none() && lengths[0] == lengths[1],
            "common_steps": common,
            "steps": lengths,
            "first_difference": difference,
            "growth": growth,
        }))?;
    } else {
        let said = difference.as_ref().map_or_else(
            || format!("identical: {common} states of {} and {}", lengths[0], lengths[1]),
            |difference| sentence(difference, ["first", "second"]),
        );
        output::print_text(&said)?;
        if !growth.is_empty() {
            output::print_text(&growth_table(&growth))?;
        }
    }
    ensure!(difference.is_none() && lengths[0] == lengths[1], "the two recordings are not the same");
    Ok(())
}

/// How far the two are apart: where they part, then at distances from there that double, then at the end.
fn growth(a: &mut Recording, b: &mut Recording, from: u64) -> anyhow::Result<Vec<Apart>> {
    let frames = common_frames(a, b, from);
    let last = frames.len().saturating_sub(1);
    let mut wanted: Vec<usize> = (0..GROWTH_ROWS as u32).map(|k| (1usize << k) - 1).collect();
    wanted.retain(|&at| at < last);
    wanted.push(last);
    let mut rows = Vec::new();
    for [in_a, in_b] in wanted.into_iter().filter_map(|at| frames.get(at).copied()) {
        let (a, b) = (a.frame(in_a).map_err(refuse)?, b.frame(in_b).map_err(refuse)?);
        rows.push(Apart::of(&a.frame, &b.frame));
    }
    Ok(rows)
}

fn growth_table(rows: &[Apart]) -> String {
    let header = ["step", "seconds", "bodies", "apart m", "turned rad", "velocity m/s"];
    let cells = rows.iter().map(|row| {
        vec![
            row.step.to_string(),
            format!("{:.3}", row.time_secs),
            row.bodies.to_string(),
            format!("{:.3e}", row.position),
            format!("{:.3e}", row.angle),
            format!("{:.3e}", row.velocity),
        ]
    });
    output::table(&header, cells)
}
