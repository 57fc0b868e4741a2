//! The accuracy laboratory in a quick sweep: what a report shows of it.

use serde::{Deserialize, Serialize};

use crate::accuracy::answers::{MixLine, answers, mix_lines};
use crate::accuracy::contact::{self, Verdict};
use crate::accuracy::{Effort, Fastest, Line, Results, chosen, lines, measure, write};

/// Drawings a report has room for: cases and their files.
const DRAWN: [(&str, &str); 19] = [
    ("a03_quadratic_drop", "accuracy_quadratic_drop.svg"),
    ("a05_oscillator", "accuracy_oscillator.svg"),
    ("a09_pendulum", "accuracy_pendulum.svg"),
    ("a12_kepler_e09", "accuracy_kepler.svg"),
    ("a13_circle", "accuracy_magnetic.svg"),
    ("a14_arenstorf", "accuracy_arenstorf.svg"),
    ("b01_sliding_block", "accuracy_sliding_block.svg"),
    ("b10_bounces", "accuracy_bouncing_ball.svg"),
    ("b16_box_billiard", "accuracy_billiard.svg"),
    ("b18_stack", "accuracy_stack_forces.svg"),
    ("b26_hanging_chain", "accuracy_chain.svg"),
    ("m_circles_penetration", "accuracy_circles.svg"),
    ("m_circles_momentum", "accuracy_circles_momentum.svg"),
    ("m_circles_polygons_penetration", "accuracy_circles_polygons.svg"),
    ("m_circles_polygons_momentum", "accuracy_circles_polygons_momentum.svg"),
    ("m_polygons_penetration", "accuracy_polygons.svg"),
    ("m_polygons_momentum", "accuracy_polygons_momentum.svg"),
    ("m_all_penetration", "accuracy_all.svg"),
    ("m_all_momentum", "accuracy_all_momentum.svg"),
];

/// Run time against error of one case.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Drawing {
    /// File name in the report's folder.
    pub file: String,
    /// What it shows.
    pub about: String,
    /// The drawing.
    #[serde(skip)]
    pub svg: String,
}

/// What was measured.
#[derive(Clone, Debug, Default)]
pub struct Accuracy {
    /// A line per case and method.
    pub lines: Vec<Line>,
    /// What is asked of contact, and what it shows.
    pub contact: Vec<Verdict>,
    /// A line per shape mix.
    pub mixes: Vec<MixLine>,
    /// What the rows answer.
    pub answers: Vec<String>,
    /// A line per case.
    pub fastest: Vec<Fastest>,
    /// Drawings of some cases.
    pub drawings: Vec<Drawing>,
}

/// Sweeps every case quickly; `tick` is called before each.
///
/// # Errors
/// A scene that cannot be run, widths that differ in a bit; what `tick` says.
pub fn run(tick: &mut dyn FnMut() -> anyhow::Result<()>) -> anyhow::Result<Accuracy> {
    let mut accuracy = Accuracy::default();
    let mut all = Vec::new();
    let cases = chosen(&[], true)?;
    for &case in &cases {
        tick()?;
        let drawn = DRAWN.iter().any(|(name, _)| *name == case.name);
        let results = measure(case, if drawn { Effort::REPORT } else { Effort::QUICK })?;
        accuracy.lines.extend(lines(&results));
        accuracy.fastest.push(Fastest::of(&results));
        accuracy.drawings.extend(draw(&results)?);
        all.push(results);
    }
    accuracy.mixes = mix_lines(&all)?;
    accuracy.answers = answers(&accuracy.mixes, &accuracy.fastest);
    accuracy.contact = contact::verdicts(&cases)?;
    Ok(accuracy)
}

/// How often [`run`] calls its `tick`.
pub fn rounds() -> u64 {
    chosen(&[], true).map_or(0, |cases| cases.len() as u64)
}

fn draw(results: &Results) -> anyhow::Result<Option<Drawing>> {
    let Some((_, file)) = DRAWN.iter().find(|(case, _)| *case == results.case.name) else { return Ok(None) };
    let about = format!("Run time against error of each method: {}", results.case.about);
    Ok(write::drawing(results)?.map(|svg| Drawing { file: (*file).to_owned(), about, svg }))
}
