//! Why a world could not be built, or a step not be taken to its end.

use crate::measure::Stage;
use crate::scene::SceneError;
use crate::settings::{Precision, SettingsError};

/// A step that could not be taken to its end.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum StepError {
    /// A body's state became NaN or infinite; the world holds that state.
    #[error("step {step}: body in slot {slot} is no longer finite: {column} = {value} after {stage}")]
    NonFinite {
        /// The step's number, from 1.
        step: u64,
        /// The body.
        slot: usize,
        /// The column.
        column: &'static str,
        /// What it holds.
        value: f64,
        /// Where it first was so: the integrator or the solver.
        stage: Stage,
    },
    /// A body is faster than [`Settings::max_speed`](crate::settings::Settings::max_speed); the world holds that state.
    #[error(
        "step {step}: body in slot {slot} runs away: {speed} m/s is over max-speed = {bound} m/s after {stage}"
    )]
    Runaway {
        /// The step's number, from 1.
        step: u64,
        /// The fastest body.
        slot: usize,
        /// Its speed, m/s.
        speed: f64,
        /// The most it may be.
        bound: f64,
        /// What made it so fast: the integrator or the solver.
        stage: Stage,
    },
    /// There is more energy over the beginning than [`Settings::max_gain`](crate::settings::Settings::max_gain); the world holds that state.
    #[error(
        "step {step}: energy has grown by {gain} J, over max-gain = {bound} J; its {term} part grew most in slot {slot}, \
         after {stage}"
    )]
    Gain {
        /// The step's number, from 1; looked at each [`WATCHED_EVERY`](super::WATCHED_EVERY)th.
        step: u64,
        /// The body whose energy grew most since the last look.
        slot: usize,
        /// Gained since the account began, J.
        gain: f64,
        /// The most it may be.
        bound: f64,
        /// `kinetic` or `potential`: what grew more.
        term: &'static str,
        /// What moves that body faster than it was predicted to be: the solver, else the integrator.
        stage: Stage,
    },
    /// Something that the scene does to itself could not be done; see [`crate::event::SceneEvent`].
    #[error("step {step}: event {event}: {why}")]
    Event {
        /// The step's number, from 1.
        step: u64,
        /// The event's number in the scene, from 0.
        event: usize,
        /// What is wrong with it.
        why: String,
    },
    /// Steps have a positive, finite length.
    #[error("dt must be positive and finite, got {0:?}")]
    Dt(f64),
    /// A step too short for the precision; see [`Precision::shortest_step_secs`](crate::settings::Precision::shortest_step_secs).
    #[error("dt must be at least {least:e} s, got {given:?}")]
    ShortDt {
        /// Seconds.
        given: f64,
        /// Seconds.
        least: f64,
    },
}

/// Why a world could not be built.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum WorldError {
    /// A body or field.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// A setting.
    #[error(transparent)]
    Settings(#[from] SettingsError),
    /// A running world keeps its precision.
    #[error("a world of {have} cannot become one of {asked}")]
    Precision {
        /// What it is built on.
        have: &'static str,
        /// What was asked for.
        asked: Precision,
    },
    /// A running world keeps its lane width.
    #[error("a world of {have} lanes cannot become one of {asked}")]
    Lanes {
        /// What it is built on.
        have: usize,
        /// What was asked for.
        asked: usize,
    },
}

impl StepError {
    /// The body it speaks of.
    pub fn slot(&self) -> Option<usize> {
        match *self {
            Self::NonFinite { slot, .. } | Self::Runaway { slot, .. } | Self::Gain { slot, .. } => Some(slot),
            Self::Event { .. } | Self::Dt(_) | Self::ShortDt { .. } => None,
        }
    }
}
