//! Which frame is shown, and how time moves on.

/// The speeds offered: simulated seconds per second.
pub const SPEEDS: [f64; 7] = [0.125, 0.25, 0.5, 1.0, 2.0, 4.0, 8.0];
/// Two times closer than this are one, seconds.
const SAME_SECS: f64 = 1e-9;

/// A place in a run, moved by hand or by the clock.
#[derive(Clone, Debug)]
pub struct Playback {
    /// Of each frame, seconds, ascending.
    times: Vec<f64>,
    /// Those before it are no longer there.
    first: usize,
    /// Do frames come from a world that runs? Then time moves on by [`Playback::follow`].
    live: bool,
    frame: usize,
    /// Between frames while playing.
    time_secs: f64,
    playing: bool,
    /// Simulated seconds per second.
    pub speed: f64,
    /// Does the end lead back to the beginning?
    pub looping: bool,
}

impl Default for Playback {
    fn default() -> Self {
        Self {
            times: Vec::new(),
            first: 0,
            live: false,
            frame: 0,
            time_secs: 0.0,
            playing: false,
            speed: 1.0,
            looping: false,
        }
    }
}

impl Playback {
    /// Gives it another run's frame times, seconds, ascending; speed and looping stay.
    pub fn set_times(&mut self, times: Vec<f64>) {
        (self.times, self.first, self.live, self.playing) = (times, 0, false, false);
        self.go_to(0);
    }

    /// Frames come from a world that runs: there are those from `first` on, the last of them at `time_of` it. Shows the
    /// last.
    pub fn follow(&mut self, frames: std::ops::Range<usize>, time_of: impl Fn(usize) -> f64) {
        (self.live, self.first) = (true, frames.start);
        let known = self.times.len();
        self.times.extend((known..frames.end).map(time_of));
        self.go_to(self.last());
    }

    /// The frame to show.
    pub fn frame(&self) -> usize {
        self.frame
    }
    /// Frames there are.
    pub fn frames(&self) -> usize {
        self.times.len()
    }
    /// The first frame that is still there.
    pub fn first(&self) -> usize {
        self.first
    }
    /// Is the newest frame shown of a world that runs?
    pub fn at_present(&self) -> bool {
        self.live && self.frame == self.last()
    }
    /// The last frame; 0 where there is none.
    pub fn last(&self) -> usize {
        self.times.len().saturating_sub(1)
    }
    /// Simulated seconds of the frame shown.
    pub fn time_secs(&self) -> f64 {
        self.times.get(self.frame).copied().unwrap_or(0.0)
    }
    /// Simulated seconds of the last frame.
    pub fn end_secs(&self) -> f64 {
        self.times.last().copied().unwrap_or(0.0)
    }
    /// Does time move on by itself?
    pub fn playing(&self) -> bool {
        self.playing
    }

    /// Shows a frame, or the last if there are fewer.
    pub fn go_to(&mut self, frame: usize) {
        self.frame = frame.clamp(self.first.min(self.last()), self.last());
        self.time_secs = self.time_secs();
    }

    /// Shows the last frame at or before a time, seconds.
    pub fn seek(&mut self, time_secs: f64) {
        let frame = self.frame_at(time_secs);
        self.go_to(frame);
    }

    /// Pauses and moves by frames.
    pub fn step(&mut self, by: isize) {
        self.playing = false;
        self.go_to(self.frame.saturating_add_signed(by));
    }

    /// Moves by seconds, and by a frame at least.
    pub fn jump(&mut self, by_secs: f64) {
        let before = self.frame;
        self.seek(self.time_secs() + by_secs);
        if self.frame == before {
            self.go_to(before.saturating_add_signed(if by_secs < 0.0 { -1 } else { 1 }));
        }
    }

    /// Plays or pauses; at the end a recording plays from the beginning, and a world that runs goes on at its end.
    pub fn toggle(&mut self) {
        self.playing = !self.playing && (self.live || self.frames() > 1);
        if self.playing && self.live {
            self.go_to(self.last());
        } else if self.playing && self.frame == self.last() {
            self.go_to(0);
        }
    }

    /// Pauses.
    pub fn pause(&mut self) {
        self.playing = false;
    }

    /// Lets `elapsed_secs` of real time pass over a recording.
    pub fn advance(&mut self, elapsed_secs: f64) {
        if !self.playing || self.live {
            return;
        }
        self.time_secs += elapsed_secs.max(0.0) * self.speed;
        if self.time_secs <= self.end_secs() {
            self.frame = self.frame_at(self.time_secs);
        } else if self.looping {
            self.go_to(0);
        } else {
            self.playing = false;
            self.go_to(self.last());
        }
    }

    /// The last frame at or before a time, seconds; the first where there is none.
    pub fn frame_at(&self, time_secs: f64) -> usize {
        self.times.partition_point(|time| *time <= time_secs + SAME_SECS).saturating_sub(1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tenths() -> Playback {
        let mut playback = Playback::default();
        playback.set_times((0..=30).map(|k| f64::from(k) * 0.1).collect());
        playback
    }

    #[test]
    fn jumps_and_steps_stay_within_the_run() {
        let mut playback = tenths();
        playback.jump(1.0);
        assert_eq!(playback.frame(), 10);
        playback.jump(-0.1);
        assert_eq!(playback.frame(), 9);
        playback.jump(0.01);
        assert_eq!(playback.frame(), 10, "less than a frame is a frame");
        playback.step(-100);
        assert_eq!(playback.frame(), 0);
        playback.jump(1e9);
        assert_eq!(playback.frame(), 30);
    }

    #[test]
    fn plays_at_its_speed_and_stops_or_loops_at_the_end() {
        let mut playback = tenths();
        playback.speed = 2.0;
        playback.toggle();
        playback.advance(0.5);
        assert_eq!(playback.frame(), 10);
        playback.advance(9.0);
        assert_eq!((playback.frame(), playback.playing()), (30, false));
        playback.looping = true;
        playback.toggle();
        assert_eq!(playback.frame(), 0, "from the end it plays from the beginning");
        playback.advance(9.0);
        assert_eq!((playback.frame(), playback.playing()), (0, true));
    }

    #[test]
    fn nothing_to_play_plays_nothing() {
        let mut playback = Playback::default();
        playback.toggle();
        playback.advance(1.0);
        playback.step(1);
        playback.jump(-1.0);
        assert_eq!((playback.frame(), playback.playing(), playback.end_secs()), (0, false, 0.0));
    }
}
