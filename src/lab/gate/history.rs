//! One line per blessing: what the engine cost before a change and after it.

use std::path::Path;

use super::{Comparison, Toolchain};

/// The bench that stands for the engine: settled polygons with default settings.
pub const HEADLINE: &str = "mixes/polygons/150/velocity_verlet/x8";

/// The file before its first line.
const HEADER: &str = "\
# History

Instructions before and after each change whose counts were blessed (`lamina gate --bless REASON`), oldest first. The
commit is the one that was checked out, `+changes` what was edited on top of it. One step is that of 150 settled polygons
(`mixes/polygons/150/velocity_verlet/x8`); *all* is the geometric mean of after over before of every bench.

| commit | reason | toolchain | instructions per step | all |
|---|---|---|---|---|
";

/// The line of a blessing.
pub fn history_line(commit: &str, reason: &str, toolchain: &Toolchain, comparison: &Comparison) -> String {
    let headline = comparison.rows.iter().find(|row| row.name == HEADLINE);
    let per_step = |count: Option<u64>| {
        count.map_or_else(|| "–".to_owned(), |count| (count / super::STEPS_PER_COUNT).to_string())
    };
    let [before, after] = [headline.and_then(|row| row.old), headline.and_then(|row| row.new)].map(per_step);
    let all = comparison.mean_ratio().map_or_else(|| "–".to_owned(), |ratio| format!("{ratio:.4}"));
    format!("| {commit} | {reason} | {toolchain} | {before} → {after} | {all} |\n")
}

/// Appends a line, and begins the file where there is none.
///
/// # Errors
/// A file that cannot be read or written.
pub fn append_history(path: &Path, line: &str) -> std::io::Result<()> {
    let text = match std::fs::read_to_string(path) {
        Ok(text) => text,
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => HEADER.to_owned(),
        Err(error) => return Err(error),
    };
    let end = if text.ends_with('\n') || text.is_empty() { "" } else { "\n" };
    std::fs::write(path, format!("{text}{end}{line}"))
}
