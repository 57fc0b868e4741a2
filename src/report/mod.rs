//! The report: experiments in, a folder with a page, tables and plots out.
//!
//! | file | what |
//! |---|---|
//! | [`experiments`] | what is measured, each a table of rows |
//! | `machine` | where it was measured, and with which build |
//! | `plots` | SVG from rows |
//! | `page` | HTML and Markdown from rows and plots |

pub mod experiments;
mod machine;
mod page;
mod plots;
mod timing;

use std::path::Path;

use serde::Serialize;
use serde_json::{Value, json};

use experiments::{broad_phase, contacts, determinism, flight, lanes, matrix, skips, sleep, stability};

pub use machine::Machine;
pub use timing::{Timing, fitted_exponent, median};

/// Everything a report shows.
#[derive(Clone, Debug, Serialize)]
pub struct Data {
    /// Where and with which build.
    pub machine: Machine,
    /// Quick mode: fewer bodies and repeats.
    pub quick: bool,
    /// Shape mix × integrator × bodies × lanes, beside the baseline.
    pub matrix: Vec<matrix::Row>,
    /// Broad phase on and off.
    pub broad_phase: Vec<broad_phase::Row>,
    /// Two runs, compared by bits.
    pub determinism: Vec<determinism::Row>,
    /// Kernels at each width.
    pub lanes: Vec<lanes::Row>,
    /// Where a step of a settled pile goes.
    pub contacts: Vec<contacts::Row>,
    /// Piles that are hard to hold, by every solver.
    pub stability: Vec<stability::Row>,
    /// Piles awake and asleep.
    pub sleep: Vec<sleep::Row>,
    /// Each skip on and off.
    pub skips: Vec<skips::Row>,
    /// Free flight against copy bandwidth.
    pub flight: Vec<flight::Row>,
}

impl Data {
    /// How often [`Data::measure`] calls its `tick`.
    pub fn rounds(quick: bool) -> u64 {
        plan(quick).rounds() + 8
    }

    /// Runs all experiments; `tick` is told what has just been done.
    ///
    /// # Errors
    /// A scene that cannot be run, results that differ between lane widths.
    pub fn measure(quick: bool, tick: &mut dyn FnMut(&'static str)) -> anyhow::Result<Self> {
        let matrix = matrix::run(&plan(quick), &mut || tick("performance matrix"))?;
        let broad_phase = broad_phase::run(if quick { 4 } else { 16 })?;
        tick("broad phase on and off");
        let determinism = determinism::run()?;
        tick("determinism");
        let lanes = lanes::run(if quick { 8 } else { 40 })?;
        tick("lanes");
        let contacts = contacts::run(quick, if quick { 5 } else { 20 })?;
        tick("contacts");
        let stability = stability::run(quick, if quick { 2.0 } else { 10.0 })?;
        tick("stability");
        let sleep = sleep::run(quick)?;
        tick("sleep");
        let skips = skips::run(if quick { 4 } else { 16 })?;
        tick("skips");
        let flight = flight::run(if quick { 20 } else { 100 })?;
        tick("free flight");
        Ok(Self {
            machine: Machine::read(),
            quick,
            matrix,
            broad_phase,
            determinism,
            lanes,
            contacts,
            stability,
            sleep,
            skips,
            flight,
        })
    }

    /// The headline: how many times faster than the baseline with its Euler each mix runs, at 8 lanes.
    pub fn headlines(&self) -> Vec<Headline> {
        let ours = self.matrix.iter().filter(|r| {
            r.engine == "lamina2d" && r.integrator == matrix::HEADLINE_INTEGRATOR.name() && r.lanes == 8
        });
        ours.map(|row| {
            let base = |engine| {
                let wanted = |r: &&matrix::Row| {
                    r.engine == engine
                        && r.mix == row.mix
                        && r.bodies == row.bodies
                        && r.integrator == "semi_implicit_euler"
                };
                self.matrix.iter().find(wanted)
            };
            let against = |engine| base(engine).map(|r| r.ms_per_step.median / row.ms_per_step.median);
            Headline {
                mix: row.mix.clone(),
                bodies: row.bodies,
                substeps: row.substeps,
                ms: row.ms_per_step.median,
                times_thesis: against("thesis"),
                times_tidy: against("tidy"),
                mean_penetration: row.mean_penetration,
                thesis_mean_penetration: base("thesis").map(|r| r.mean_penetration),
                contacts: row.contacts,
            }
        })
        .collect()
    }

    /// What `lamina report --json` prints.
    pub fn summary(&self) -> Value {
        json!({
            "rows": self.headlines(),
            "lanes": self.lanes,
            "contacts": self.contacts,
            "stability": self.stability,
            "sleep": self.sleep,
            "skips": self.skips,
            "flight": self.flight,
            "determinism": self.determinism,
            "broad_phase": self.broad_phase,
        })
    }
}

fn plan(quick: bool) -> matrix::Plan {
    if quick { matrix::Plan::quick() } else { matrix::Plan::full() }
}

/// One line of the result table.
#[derive(Clone, Debug, Serialize)]
pub struct Headline {
    /// The shape mix.
    pub mix: String,
    /// Dynamic bodies.
    pub bodies: usize,
    /// Our substeps per step.
    pub substeps: u32,
    /// Our median, ms per step.
    pub ms: f64,
    /// The faithful baseline's median over ours.
    pub times_thesis: Option<f64>,
    /// The tidy baseline's median over ours.
    pub times_tidy: Option<f64>,
    /// Our mean overlap, metres.
    pub mean_penetration: f64,
    /// The faithful baseline's mean overlap, metres.
    pub thesis_mean_penetration: Option<f64>,
    /// Our contacts.
    pub contacts: usize,
}

/// Writes the page (`index.html`, `summary.md`), each table as CSV and JSON, and the plots as SVG.
///
/// # Errors
/// A folder or file that cannot be written.
pub fn write(data: &Data, folder: &Path) -> anyhow::Result<()> {
    std::fs::create_dir_all(folder)?;
    std::fs::write(folder.join("data.json"), serde_json::to_string_pretty(data)?)?;
    write_csv(folder, "matrix", &data.matrix)?;
    write_csv(folder, "broad_phase", &data.broad_phase)?;
    write_csv(folder, "determinism", &data.determinism)?;
    write_csv(folder, "lanes", &data.lanes)?;
    write_csv(folder, "contacts", &data.contacts)?;
    write_csv(folder, "stability", &data.stability)?;
    write_csv(folder, "sleep", &data.sleep)?;
    write_csv(folder, "skips", &data.skips)?;
    write_csv(folder, "flight", &data.flight)?;
    let plots = plots::draw(data)?;
    for plot in &plots {
        std::fs::write(folder.join(plot.file), &plot.svg)?;
    }
    std::fs::write(folder.join("index.html"), page::html(data, &plots)?)?;
    std::fs::write(folder.join("summary.md"), page::markdown(data)?)?;
    Ok(())
}

/// The result table for a terminal; `table` draws it from a header and rows.
pub fn terminal_summary(data: &Data, table: fn(&[&str], Vec<Vec<String>>) -> String) -> String {
    let (header, rows) = page::result_table(data);
    table(&header, rows)
}

/// Rows with nested fields become columns `outer_inner`.
fn write_csv<T: Serialize>(folder: &Path, name: &str, rows: &[T]) -> anyhow::Result<()> {
    let mut writer = csv::Writer::from_path(folder.join(format!("{name}.csv")))?;
    for (k, row) in rows.iter().enumerate() {
        let mut cells = Vec::new();
        flatten("", &serde_json::to_value(row)?, &mut cells);
        if k == 0 {
            writer.write_record(cells.iter().map(|c| &c.0))?;
        }
        writer.write_record(cells.iter().map(|c| &c.1))?;
    }
    Ok(writer.flush()?)
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
