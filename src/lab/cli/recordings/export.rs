//! `lamina export`: a recording as a table for other tools.

#[cfg(feature = "parquet")]
mod parquet;

use std::fs::File;
use std::io::{BufWriter, IsTerminal, Write};
use std::path::PathBuf;

use anyhow::Context;
use lamina2d::contact::CONTACT_COLUMNS;
use lamina2d::record::{FrameData, Recording, STATISTICS};
use lamina2d::world::COLUMNS;

use crate::cli::refuse;

/// Arguments of `lamina export`.
#[derive(Debug, clap::Args)]
#[command(group = clap::ArgGroup::new("format").required(true))]
pub(crate) struct Args {
    /// A recording, finished or not.
    file: PathBuf,
    /// Comma-separated values with a header.
    #[arg(long, group = "format")]
    csv: bool,
    /// Parquet, packed with Snappy; needs a program built with `--features lamina/parquet`.
    #[arg(long, group = "format")]
    parquet: bool,
    /// One JSON object per line.
    #[arg(long, group = "format")]
    json: bool,
    /// The rows: each body, each contact, or the numbers of each step.
    #[arg(long, value_enum, default_value_t = Rows::Bodies)]
    rows: Rows,
    /// Where to [default: standard output].
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
}

/// What a row is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
enum Rows {
    /// A body in a frame.
    Bodies,
    /// A contact in a frame.
    Contacts,
    /// A step.
    Steps,
}

impl Rows {
    /// Column names, the first ones whole numbers.
    fn header(self) -> (Vec<&'static str>, usize) {
        match self {
            Self::Bodies => ([&["step", "slot", "asleep", "time_secs"][..], &COLUMNS].concat(), 3),
            Self::Contacts => (
                [&["step", "slot_a", "slot_b", "points", "feature0", "feature1"][..], &CONTACT_COLUMNS]
                    .concat(),
                6,
            ),
            Self::Steps => ([&["step"][..], &STATISTICS].concat(), 1),
        }
    }
}

/// Takes rows in; all numbers of one are `f64`, in which steps and slots are exact.
trait Table {
    fn row(&mut self, row: &[f64]) -> anyhow::Result<()>;
    fn end(self: Box<Self>) -> anyhow::Result<()>;
}

pub(crate) fn main(args: &Args) -> anyhow::Result<()> {
    if args.parquet && cfg!(not(feature = "parquet")) {
        return Err(refuse(anyhow::anyhow!(
            "--parquet: this program was built without Parquet, whose crates take long to build; \
             cargo run --release --features lamina/parquet -- export … has it, --csv and --json need nothing"
        )));
    }
    let mut recording = super::open(&args.file)?;
    if args.parquet && args.out.is_none() && std::io::stdout().is_terminal() {
        return Err(refuse(anyhow::anyhow!("--parquet writes bytes: name a file with --out, or pipe it")));
    }
    let out: Box<dyn Write + Send> = match &args.out {
        Some(path) => {
            let file = File::create(path).with_context(|| path.display().to_string()).map_err(refuse)?;
            Box::new(BufWriter::new(file))
        }
        None => Box::new(BufWriter::new(std::io::stdout())),
    };
    let (header, whole) = args.rows.header();
    let mut table: Box<dyn Table> = if args.csv {
        Box::new(Csv::new(out, &header, whole)?)
    } else if args.json {
        Box::new(Lines { out, header, whole })
    } else {
        packed(out, &header)?
    };
    write_rows(args.rows, &mut recording, table.as_mut())?;
    table.end()
}

#[cfg(feature = "parquet")]
fn packed(out: Box<dyn Write + Send>, header: &[&str]) -> anyhow::Result<Box<dyn Table>> {
    Ok(Box::new(parquet::Parquet::new(out, header)?))
}

#[cfg(not(feature = "parquet"))]
fn packed(_: Box<dyn Write + Send>, _: &[&str]) -> anyhow::Result<Box<dyn Table>> {
    anyhow::bail!("built without Parquet")
}

fn write_rows(rows: Rows, recording: &mut Recording, table: &mut dyn Table) -> anyhow::Result<()> {
    if rows == Rows::Steps {
        for row in recording.rows() {
            let cells: Vec<f64> = std::iter::once(row.step as f64).chain(row.values).collect();
            table.row(&cells)?;
        }
        return Ok(());
    }
    let mut cells = Vec::new();
    for frame in 0..recording.frames() {
        let FrameData { frame, contacts } = recording.frame(frame).map_err(refuse)?;
        if rows == Rows::Bodies {
            for slot in frame.slots() {
                let asleep = f64::from(u8::from(frame.asleep[slot - 1]));
                cells.clear();
                cells.extend([frame.step as f64, slot as f64, asleep, frame.time_secs]);
                cells.extend((0..COLUMNS.len()).map(|column| frame.get(column, slot)));
                table.row(&cells)?;
            }
        } else {
            for contact in contacts {
                let [a, b] = contact.slots.map(f64::from);
                let [f0, f1] = contact.features.map(f64::from);
                cells.clear();
                cells.extend([frame.step as f64, a, b, contact.points as f64, f0, f1]);
                cells.extend(contact.values);
                table.row(&cells)?;
            }
        }
    }
    Ok(())
}

/// A number as text: whole ones without a point, others so that reading gives the same bits.
fn text(value: f64, whole: bool) -> String {
    if whole { format!("{value:.0}") } else { format!("{value:?}") }
}

/// The system's error as it is, so that a reader that went away is known as such.
fn io_error(error: csv::Error) -> anyhow::Error {
    match error.into_kind() {
        csv::ErrorKind::Io(error) => error.into(),
        other => anyhow::anyhow!("CSV: {other:?}"),
    }
}

struct Csv(csv::Writer<Box<dyn Write + Send>>, usize);

impl Csv {
    fn new(out: Box<dyn Write + Send>, header: &[&str], whole: usize) -> anyhow::Result<Self> {
        let mut writer = csv::Writer::from_writer(out);
        writer.write_record(header).map_err(io_error)?;
        Ok(Self(writer, whole))
    }
}

impl Table for Csv {
    fn row(&mut self, row: &[f64]) -> anyhow::Result<()> {
        let cells = row.iter().enumerate().map(|(at, value)| text(*value, at < self.1));
        self.0.write_record(cells).map_err(io_error)
    }
    fn end(mut self: Box<Self>) -> anyhow::Result<()> {
        Ok(self.0.flush()?)
    }
}

struct Lines {
    out: Box<dyn Write + Send>,
    header: Vec<&'static str>,
    whole: usize,
}

impl Table for Lines {
    fn row(&mut self, row: &[f64]) -> anyhow::Result<()> {
        let field = |(at, (name, value)): (usize, (&&str, &f64))| {
            // JSON has no NaN and no infinity.
            let value = if value.is_finite() { text(*value, at < self.whole) } else { "null".to_owned() };
            format!("\"{name}\":{value}")
        };
        let fields: Vec<_> = self.header.iter().zip(row).enumerate().map(field).collect();
        Ok(writeln!(self.out, "{{{}}}", fields.join(","))?)
    }
    fn end(mut self: Box<Self>) -> anyhow::Result<()> {
        Ok(self.out.flush()?)
    }
}
