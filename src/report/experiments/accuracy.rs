//! The accuracy laboratory in a quick sweep: what a report shows of it.

use crate::accuracy::contact::{self, Verdict};
use crate::accuracy::{CASES, Effort, Fastest, Line, Results, lines, measure, write};

/// Drawings a report has room for: cases and their files.
const DRAWN: [(&str, &str); 6] = [
    ("a03_quadratic_drop", "accuracy_quadratic_drop.svg"),
    ("a05_oscillator", "accuracy_oscillator.svg"),
    ("a09_pendulum", "accuracy_pendulum.svg"),
    ("a12_kepler_e09", "accuracy_kepler.svg"),
    ("a13_circle", "accuracy_magnetic.svg"),
    ("a14_arenstorf", "accuracy_arenstorf.svg"),
];

/// Run time against error of one case.
#[derive(Clone, Debug)]
pub struct Drawing {
    /// File name in the report's folder.
    pub file: &'static str,
    /// What it shows.
    pub about: String,
    /// The drawing.
    pub svg: String,
}

/// What was measured.
#[derive(Clone, Debug, Default)]
pub struct Accuracy {
    /// A line per case and method.
    pub lines: Vec<Line>,
    /// What is asked of contact, and what it shows.
    pub contact: Vec<Verdict>,
    /// A line per case.
    pub fastest: Vec<Fastest>,
    /// Drawings of some cases.
    pub drawings: Vec<Drawing>,
}

/// Sweeps every case quickly.
///
/// # Errors
/// A scene that cannot be run, widths that differ in a bit.
pub fn run() -> anyhow::Result<Accuracy> {
    let mut accuracy = Accuracy::default();
    for case in CASES {
        let results = measure(case, Effort::QUICK)?;
        accuracy.lines.extend(lines(&results));
        accuracy.fastest.push(Fastest::of(&results));
        accuracy.drawings.extend(draw(&results)?);
    }
    accuracy.contact = contact::verdicts(&CASES.iter().collect::<Vec<_>>())?;
    Ok(accuracy)
}

fn draw(results: &Results) -> anyhow::Result<Option<Drawing>> {
    let Some((_, file)) = DRAWN.iter().find(|(case, _)| *case == results.case.name) else { return Ok(None) };
    let about = format!("Run time against error of each integrator: {}", results.case.about);
    Ok(write::drawing(results)?.map(|svg| Drawing { file, about, svg }))
}
