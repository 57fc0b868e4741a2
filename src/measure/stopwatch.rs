//! Time per stage, and which steps are timed.

use std::time::{Duration, Instant};

use super::Stage;

/// Time per stage, summed over the steps that were timed.
#[derive(Clone, Copy, Debug, Default)]
pub struct StageTimes {
    total: [Duration; Stage::ALL.len()],
    /// Steps summed.
    pub steps: u64,
}

impl StageTimes {
    /// Time of a stage, summed.
    pub fn total(&self, stage: Stage) -> Duration {
        self.total[stage as usize]
    }

    /// Mean time of a stage per step, ns.
    pub fn mean_ns(&self, stage: Stage) -> f64 {
        self.total[stage as usize].as_nanos() as f64 / self.steps.max(1) as f64
    }
}

/// Worlds of fewer bodies than this are timed every [`EVERY`] steps: a step of theirs takes microseconds, and reading
/// the clock at each of its twenty-odd stages took a quarter of one body's (70 ns a reading).
const SMALL: usize = 64;
/// See [`SMALL`].
const EVERY: u32 = 16;

/// Times the stages of steps: all of them, or some where a world is small.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Stopwatch {
    times: StageTimes,
    /// Someone wants to know of every step.
    every_step: bool,
    /// Steps that are not timed until the next that is.
    until: u32,
    /// When the stage began, in a step that is timed.
    begun: Option<Instant>,
}

impl Stopwatch {
    /// A step of so many bodies begins.
    pub(crate) fn begin(&mut self, bodies: usize) {
        self.begun = self.count(bodies).then(Instant::now);
    }

    /// Counts a step, in which nothing may have to be done; says whether it is timed.
    pub(crate) fn count(&mut self, bodies: usize) -> bool {
        let timed = self.every_step || bodies >= SMALL || self.until == 0;
        self.until = if timed { EVERY - 1 } else { self.until - 1 };
        self.times.steps += u64::from(timed);
        timed
    }

    /// A stage ends, and the next begins.
    #[inline]
    pub(crate) fn lap(&mut self, stage: Stage) {
        if let Some(begun) = &mut self.begun {
            let now = Instant::now();
            self.times.total[stage as usize] += now - *begun;
            *begun = now;
        }
    }

    /// From now on every step is timed.
    pub(crate) fn time_every_step(&mut self) {
        self.every_step = true;
    }

    /// What has been summed.
    pub(crate) fn times(&self) -> &StageTimes {
        &self.times
    }

    /// Begins to sum anew, with the next step.
    pub(crate) fn reset(&mut self) {
        (self.times, self.until) = (StageTimes::default(), 0);
    }
}
