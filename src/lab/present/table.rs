//! From rows to tables: what an experiment's row must know to be shown, and the tables made of it.

use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::Earlier;

/// A row of an experiment, and how a reader sees a table of such rows.
pub trait Record: Serialize {
    /// File name of the raw rows, without its ending; also the table's anchor on the page.
    const NAME: &'static str;
    /// The table's heading.
    const TITLE: &'static str;
    /// The command that makes the rows.
    const COMMAND: &'static str;
    /// How to read the table: what was run, what an unusual column means.
    const NOTE: &'static str;
    /// The columns.
    const HEADER: &'static [&'static str];

    /// One cell per column.
    fn cells(&self) -> Vec<String>;

    /// All lines of the table.
    fn lines(rows: &[Self]) -> Vec<Vec<String>>
    where
        Self: Sized,
    {
        rows.iter().map(Self::cells).collect()
    }
}

/// A table, with the raw rows it was made of.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct Table {
    /// File name of the raw rows, without its ending.
    pub name: String,
    /// Its heading.
    pub title: String,
    /// The command that makes its rows.
    pub command: String,
    /// How to read it.
    pub note: String,
    /// The columns.
    pub header: Vec<String>,
    /// The lines.
    pub lines: Vec<Vec<String>>,
    /// The rows themselves, as JSON.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub raw: Vec<Value>,
    /// The run they are from; `None` for the report's own.
    #[serde(skip)]
    pub earlier: Option<Earlier>,
}

impl Table {
    /// Of all rows of an experiment.
    ///
    /// # Errors
    /// A row that has no JSON.
    pub fn of<R: Record>(rows: &[R]) -> anyhow::Result<Self> {
        Ok(Self {
            name: R::NAME.to_owned(),
            title: R::TITLE.to_owned(),
            command: R::COMMAND.to_owned(),
            note: R::NOTE.to_owned(),
            header: R::HEADER.iter().map(|&cell| cell.to_owned()).collect(),
            lines: R::lines(rows),
            raw: rows.iter().map(serde_json::to_value).collect::<Result<_, _>>()?,
            earlier: None,
        })
    }

    /// The same table, of rows from another run.
    #[must_use]
    pub fn of_run(self, earlier: Option<Earlier>) -> Self {
        Self { earlier, ..self }
    }

    /// The same table without its raw rows.
    #[must_use]
    pub fn without_raw(self) -> Self {
        Self { raw: Vec::new(), ..self }
    }

    /// The raw rows as CSV; nested fields become columns `outer_inner`, empty in the rows that lack them.
    ///
    /// # Errors
    /// Those of the writer.
    pub fn write_csv(&self, to: impl std::io::Write) -> anyhow::Result<()> {
        let rows: Vec<_> = self.raw.iter().map(cells_of).collect();
        let header = header_of(&rows);
        let mut writer = csv::Writer::from_writer(to);
        writer.write_record(&header)?;
        for row in &rows {
            let cell = |key: &&str| row.iter().find(|(k, _)| k == key).map_or("", |(_, cell)| cell);
            writer.write_record(header.iter().map(cell))?;
        }
        Ok(writer.flush()?)
    }
}

/// A row's cells, each with its column.
fn cells_of(row: &Value) -> Vec<(String, String)> {
    let mut cells = Vec::new();
    flatten("", row, &mut cells);
    cells
}

/// All columns of some rows; one that the first row lacks stands behind the one it follows where it first occurs.
fn header_of(rows: &[Vec<(String, String)>]) -> Vec<&str> {
    let mut header: Vec<&str> = Vec::new();
    for row in rows {
        let mut at = 0;
        for (key, _) in row {
            if let Some(known) = header.iter().position(|known| known == key) {
                at = known;
            } else {
                header.insert(at, key);
            }
            at += 1;
        }
    }
    header
}

fn flatten(key: &str, value: &Value, cells: &mut Vec<(String, String)>) {
    let inner = |k: &str| if key.is_empty() { k.to_owned() } else { format!("{key}_{k}") };
    match value {
        Value::Object(map) => map.iter().for_each(|(k, v)| flatten(&inner(k), v, cells)),
        Value::Array(items) => {
            items.iter().enumerate().for_each(|(k, v)| flatten(&inner(&k.to_string()), v, cells));
        }
        Value::String(text) => cells.push((key.to_owned(), text.clone())),
        Value::Null => cells.push((key.to_owned(), String::new())),
        other => cells.push((key.to_owned(), other.to_string())),
    }
}

/// `12.3×`, or a dash where there is nothing to compare with.
pub(crate) fn times(ratio: Option<f64>) -> String {
    ratio.map_or_else(|| "–".to_owned(), |r| format!("{r:.1}×"))
}

/// Three significant digits without trailing zeros; as a power of ten where that is shorter.
pub(crate) fn significant(value: f64) -> String {
    if value != 0.0 && !(1e-3..1e4).contains(&value.abs()) {
        return format!("{value:.1e}").replace(".0e", "e");
    }
    let digits = if value == 0.0 { 0 } else { (2 - value.abs().log10().floor() as i32).clamp(0, 5) as usize };
    let text = format!("{value:.digits$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

/// The value, or a dash.
pub(crate) fn or_dash(value: Option<impl ToString>) -> String {
    value.map_or_else(|| "–".to_owned(), |v| v.to_string())
}

/// yes or no.
pub(crate) fn yes_no(yes: bool) -> String {
    if yes { "yes" } else { "no" }.to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_that_lack_columns_leave_their_cells_empty() {
        let raw = serde_json::from_str(
            r#"[{"a": 1, "best": null, "z": true}, {"a": 2, "best": {"h": 0.5, "name": "x,y"}, "z": false}]"#,
        );
        let raw = raw.expect("JSON");
        let table = Table { raw, ..Table::default() };
        let mut csv = Vec::new();
        table.write_csv(&mut csv).expect("a vector takes all");
        let text = String::from_utf8(csv).expect("UTF-8");
        assert_eq!(text, "a,best_h,best_name,best,z\n1,,,,true\n2,0.5,\"x,y\",,false\n");
    }
}
