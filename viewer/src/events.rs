//! What is worth a jump: the steps of a run where something shows.

use lamina2d::record::{Difference, StepRow, first_difference};

use crate::source::{Source, SourceError};

/// What happened at a mark.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum What {
    /// Bodies overlap most.
    Overlap,
    /// Energy changes most from one step to the next.
    Energy,
    /// The second recording is another from here on.
    Difference,
    /// A number is no longer finite.
    NonFinite,
}

impl What {
    /// The name on its button.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Overlap => "Largest overlap",
            Self::Energy => "Largest energy jump",
            Self::Difference => "First difference",
            Self::NonFinite => "Not finite",
        }
    }
}

/// A place on the timeline.
#[derive(Clone, Debug, PartialEq)]
pub struct Mark {
    /// What happened.
    pub what: What,
    /// At this step.
    pub step: u64,
    /// The first frame at or after it, or the last there is.
    pub frame: usize,
    /// A sentence with the numbers.
    pub text: String,
}

impl Mark {
    fn new(source: &dyn Source, what: What, step: u64, text: String) -> Self {
        let at = source.frame_at(step).unwrap_or(0);
        let after = if source.step_of(at).is_some_and(|known| known < step) { at + 1 } else { at };
        Self { what, step, frame: after.min(source.frames().saturating_sub(1)), text }
    }
}

/// Kinetic and potential energy, J.
pub fn energy(row: &StepRow) -> f64 {
    row.get("kinetic_energy").unwrap_or(f64::NAN) + row.get("potential_energy").unwrap_or(f64::NAN)
}

/// Are a step's energies and momenta numbers?
fn is_finite(row: &StepRow) -> bool {
    let sums = ["kinetic_energy", "potential_energy", "momentum_x", "momentum_y", "angular_momentum"];
    sums.iter().all(|name| row.get(name).is_some_and(f64::is_finite))
}

/// The marks of one run.
pub fn marks(source: &dyn Source) -> Vec<Mark> {
    let rows = source.rows();
    let overlap = |row: &&StepRow| row.get("max_overlap").unwrap_or(f64::NAN);
    let deepest =
        rows.iter().filter(|row| overlap(row) > 0.0).max_by(|a, b| overlap(a).total_cmp(&overlap(b)));
    let deepest = deepest.map(|row| {
        let text = format!("bodies overlap by {:.3e} m at step {}", overlap(&row), row.step);
        Mark::new(source, What::Overlap, row.step, text)
    });
    let jumps = rows.windows(2).map(|pair| (pair[1].step, energy(&pair[1]) - energy(&pair[0])));
    let jump = jumps.filter(|(_, jump)| jump.is_finite() && *jump != 0.0);
    let jump = jump.max_by(|a, b| a.1.abs().total_cmp(&b.1.abs())).map(|(step, jump)| {
        Mark::new(source, What::Energy, step, format!("energy changes by {jump:+.3e} J in step {step}"))
    });
    let broken = rows.iter().find(|row| !is_finite(row)).map(|row| {
        let text = format!("energy or momentum is not finite from step {} on", row.step);
        Mark::new(source, What::NonFinite, row.step, text)
    });
    [deepest, jump, broken].into_iter().flatten().collect()
}

/// Where two runs part, by hashes and then by bodies; `None` where they never do. Of sources that are no recordings
/// only the step is found.
///
/// # Errors
/// A frame that cannot be read.
pub fn difference(a: &mut dyn Source, b: &mut dyn Source) -> Result<Option<(Mark, Difference)>, SourceError> {
    let found = if let (Some(a), Some(b)) = (a.recording(), b.recording()) {
        first_difference(a, b)?
    } else {
        let parts = |row: &&StepRow| b.row(row.step).is_some_and(|other| other.hash != row.hash);
        let step = a.rows().iter().find(parts).map(|row| row.step);
        step.map(|step| Difference { step, frame_step: None, slot: None, column: None, values: None })
    };
    Ok(found.map(|difference| {
        let text = format!("the two recordings differ from step {} on", difference.step);
        (Mark::new(a, What::Difference, difference.step, text), difference)
    }))
}
