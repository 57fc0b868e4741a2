//! What commands print: one JSON document or a table on stdout, progress on stderr.

use std::io::Write;

use comfy_table::{CellAlignment, ContentArrangement, Table, presets};
use indicatif::{ProgressBar, ProgressStyle};
use serde::Serialize;
use serde_json::{Map, Value, json};

use lamina2d::report::Machine;

/// Prints `{"machine": …, …fields}` as one document.
pub(crate) fn print_json(fields: &impl Serialize) -> anyhow::Result<()> {
    let mut document = Map::new();
    document.insert("machine".to_owned(), json!(Machine::read()));
    match serde_json::to_value(fields)? {
        Value::Object(object) => document.extend(object),
        rows => {
            document.insert("rows".to_owned(), rows);
        }
    }
    print_text(&serde_json::to_string_pretty(&document)?)
}

/// Prints text and a line end; a closed pipe is an error the caller can tell from others.
pub(crate) fn print_text(text: &str) -> anyhow::Result<()> {
    let mut out = std::io::stdout().lock();
    writeln!(out, "{text}")?;
    Ok(out.flush()?)
}

/// A table with the given header: the first column to the left, the others to the right.
pub(crate) fn table(header: &[&str], rows: impl IntoIterator<Item = Vec<String>>) -> String {
    let mut table = Table::new();
    table.load_style(presets::ASCII_MARKDOWN).set_content_arrangement(ContentArrangement::Disabled);
    table.set_header(header.to_vec());
    for row in rows {
        table.add_row(row);
    }
    for column in table.column_iter_mut().skip(1) {
        column.set_cell_alignment(CellAlignment::Right);
    }
    table.to_string()
}

/// A bar on stderr; invisible where stderr is not a terminal.
pub(crate) fn progress(total: u64, what: &'static str) -> ProgressBar {
    let bar = ProgressBar::new(total).with_message(what);
    if let Ok(style) = ProgressStyle::with_template("{msg} {wide_bar} {pos}/{len} {eta}") {
        bar.set_style(style);
    }
    bar
}
