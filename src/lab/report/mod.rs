//! The report: experiments in, a folder with a page, tables and plots out.
//!
//! | file | what |
//! |---|---|
//! | [`experiments`] | what is measured, each a table of rows |
//! | `data` | the list of experiments: what a report consists of |
//! | `headline` | the result table |
//! | [`sweep`] | an accuracy sweep of an earlier run |
//! | `readme` | what the README repeats |
//! | [`peers`], [`wild`] | what `lamina-peers` measured, and how many wild scenes each engine gets right, read from its files |
//! | [`instructions`] | what `lamina gate` holds, read from its file |
//! | `plots` | SVG from rows |
//! | [`strip`] | SVG of scenes at a few moments |
//! | `page` | HTML and Markdown from tables and plots |
//! | [`compare`] | two reports side by side |

pub mod compare;
mod data;
pub mod experiments;
mod headline;
pub mod instructions;
mod page;
pub mod peers;
mod plots;
pub mod readme;
pub mod strip;
pub mod sweep;
pub mod wild;

use std::path::Path;

pub use data::{Data, EXPERIMENTS, Experiment, Stopped};
pub use headline::Headline;

pub use crate::present::{Earlier, Machine, Record, Table, Timing, fitted_exponent, median};

/// Writes the page (`index.html`, `summary.md`), each table as CSV, all as JSON, and the plots as SVG.
///
/// # Errors
/// A folder or file that cannot be written.
pub fn write(data: &Data, folder: &Path) -> anyhow::Result<()> {
    std::fs::create_dir_all(folder)?;
    std::fs::write(folder.join("data.json"), serde_json::to_string_pretty(data)?)?;
    let tables = data.tables()?;
    for table in &tables {
        table.write_csv(std::fs::File::create(folder.join(format!("{}.csv", table.name)))?)?;
    }
    if !data.accuracy.lines.is_empty() {
        sweep::write(&data.accuracy, &data.machine, folder)?;
    }
    let plots = plots::draw(data)?;
    for plot in &plots {
        std::fs::write(folder.join(&*plot.file), &plot.svg)?;
    }
    let page = page::Page::new(data, &tables, &plots);
    std::fs::write(folder.join("index.html"), page.html()?)?;
    std::fs::write(folder.join("summary.md"), page.markdown()?)?;
    Ok(())
}
