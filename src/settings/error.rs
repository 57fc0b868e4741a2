//! What settings are refused for.

use super::{Precision, Solver};

/// A setting that cannot be run with.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SettingsError {
    /// The step must be positive and finite once rounded to the precision.
    #[error("dt must be positive and finite in {precision}, got {given:?}")]
    Dt {
        /// The precision asked for.
        precision: Precision,
        /// What was given, seconds.
        given: f64,
    },
    /// The inverse of a substep must leave room for what it is multiplied by.
    #[error("dt must be at least {least:e} s in {precision}, got {given:?}")]
    ShortDt {
        /// The precision asked for.
        precision: Precision,
        /// What was given, seconds.
        given: f64,
        /// The shortest step, seconds.
        least: f64,
    },
    /// At least one substep.
    #[error("substeps must be 1 to 1000, got {0}")]
    Substeps(u32),
    /// More threads gain nothing.
    #[error("threads must be auto or 1 to {most}, got {0}", most = super::MOST_THREADS)]
    Threads(usize),
    /// A bound on the sag is a positive length.
    #[error("max-sag must be positive and finite, got {0:?} m")]
    MaxSag(f64),
    /// Only one solver knows what its contacts sag by.
    #[error("max-sag needs the solver soft, got {0}")]
    MaxSagSolver(Solver),
    /// A bound on the sag is kept by numbers of substeps that differ.
    #[error("fixed-substeps and max-sag exclude each other")]
    FixedSag,
    /// A share of the substep rate.
    #[error("stiffness must be over 0 and at most 0.5, got {0:?}")]
    Stiffness(f64),
    /// Positions are not coarser than the scalar.
    #[error("positions must be f64 with f64, got f32")]
    Positions,
    /// A bound of the watchdog is a positive number.
    #[error("{name} must be positive and finite, got {given:?} {unit}")]
    Bound {
        /// `max-speed` or `max-gain`.
        name: &'static str,
        /// What was given.
        given: f64,
        /// Its unit.
        unit: &'static str,
    },
    /// Only one solver's contacts are springs.
    #[error("stiffness needs the solver soft, got {0}")]
    StiffnessSolver(Solver),
    /// Lane widths are 1, 4, 8 and 16 for f32, 1 and 4 for f64.
    #[error("lanes must be {choices} with {precision}, got {given}")]
    Lanes {
        /// The precision asked for.
        precision: Precision,
        /// The widths it has.
        choices: &'static str,
        /// What was given.
        given: usize,
    },
}
