//! Time stepping: fixed steps that catch up with real time, or the frame's own duration for contrast.

/// Turns frame durations into a whole number of fixed steps.
///
/// What is left over waits for the next frame. A frame longer than the clamp counts as the clamp: the
/// simulation falls behind rather than taking ever more steps for ever longer frames.
#[expect(clippy::struct_field_names, reason = "units belong to names")]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Accumulator {
    step_secs: f64,
    clamp_secs: f64,
    lag_secs: f64,
}

impl Accumulator {
    /// The thesis's clamp, seconds.
    pub const CLAMP_SECS: f64 = 0.2;

    /// Steps of `dt_secs`, at most `clamp_secs` of real time per frame.
    pub fn new(dt_secs: f64, clamp_secs: f64) -> Self {
        Self { step_secs: dt_secs, clamp_secs, lag_secs: 0.0 }
    }

    /// The steps due after a frame of `frame_secs`; negative and NaN durations count as none.
    pub fn steps_due(&mut self, frame_secs: f64) -> u32 {
        self.lag_secs += frame_secs.max(0.0).min(self.clamp_secs);
        let due = (self.lag_secs / self.step_secs).floor();
        self.lag_secs -= due * self.step_secs;
        due as u32
    }

    /// How far real time is ahead of the last step, as a share of a step, 0 to 1: for drawing in between.
    pub fn blend(&self) -> f64 {
        self.lag_secs / self.step_secs
    }
}
