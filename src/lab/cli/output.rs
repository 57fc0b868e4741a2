//! What commands print: one JSON document or a table on stdout, progress on stderr.

use std::io::Write;

use comfy_table::{CellAlignment, ContentArrangement, Table, presets};
use indicatif::{ProgressBar, ProgressStyle};
use serde::Serialize;
use serde_json::{Map, Value, json};

use lamina::report::Machine;

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
pub(crate) fn table(header: &[impl AsRef<str>], rows: impl IntoIterator<Item = Vec<String>>) -> String {
    let mut table = Table::new();
    table.load_style(presets::ASCII_MARKDOWN).set_content_arrangement(ContentArrangement::Disabled);
    table.set_header(header.iter().map(AsRef::as_ref));
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

/// Says something on stderr that does not end the command.
pub(crate) fn warn(text: &str) {
    // Not `eprintln!`, which panics where stderr is closed.
    let _ = writeln!(std::io::stderr(), "lamina: {text}");
}

/// Prints an object as a table of fields; inner ones by their paths.
pub(crate) fn print_fields(object: &Value) -> anyhow::Result<()> {
    let mut rows = Vec::new();
    for (key, value) in object.as_object().into_iter().flatten() {
        flatten(key, value, &mut rows);
    }
    print_text(&table(&["field", "value"], rows))
}

fn flatten(key: &str, value: &Value, rows: &mut Vec<Vec<String>>) {
    match value {
        Value::Object(fields) => fields.iter().for_each(|(k, v)| flatten(&format!("{key}.{k}"), v, rows)),
        Value::Array(items) => {
            items.iter().enumerate().for_each(|(k, v)| flatten(&format!("{key}.{k}"), v, rows));
        }
        Value::String(text) => rows.push(vec![key.to_owned(), text.clone()]),
        Value::Number(n) if n.is_f64() => {
            rows.push(vec![key.to_owned(), short(n.as_f64().unwrap_or(f64::NAN))]);
        }
        other => rows.push(vec![key.to_owned(), other.to_string()]),
    }
}

/// Five significant digits, for reading.
fn short(value: f64) -> String {
    let magnitude = value.abs();
    if value == 0.0 || (1e-3..1e6).contains(&magnitude) {
        let digits =
            if value == 0.0 { 0 } else { (4 - magnitude.log10().floor() as i32).clamp(0, 6) as usize };
        format!("{value:.digits$}")
    } else {
        format!("{value:.4e}")
    }
}
