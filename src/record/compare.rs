//! Where two runs part: frame against frame, and a recording against the run it describes.

use serde::Serialize;

use super::layout::{Frame, write_frame};
use super::{RecordError, Recording};
use crate::session::Session;
use crate::settings::Settings;
use crate::world::{COLUMNS, Snapshot};

/// The first thing that differs.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Difference {
    /// The first step after which states differ, by their hashes.
    pub step: u64,
    /// The first step from there on of which both have a frame, if any; the rest is of that.
    pub frame_step: Option<u64>,
    /// The first slot that differs.
    pub slot: Option<usize>,
    /// Its first column that does; `alive` where a body lives in one alone.
    pub column: Option<&'static str>,
    /// What it holds in the one and in the other.
    pub values: Option<[f64; 2]>,
}

/// Do two numbers differ? No more than for the hash: −0 is 0, and a NaN a NaN.
fn differ(a: f64, b: f64) -> bool {
    a != b && !(a.is_nan() && b.is_nan())
}

impl Difference {
    fn at(step: u64) -> Self {
        Self { step, frame_step: None, slot: None, column: None, values: None }
    }

    /// Looks for it in a frame of both.
    fn look(&mut self, a: &Frame, b: &Frame) {
        self.frame_step = Some(a.step);
        for slot in 1..=a.alive.len().max(b.alive.len()) {
            let found = match (a.lives(slot), b.lives(slot)) {
                (true, true) => COLUMNS.iter().enumerate().find_map(|(column, name)| {
                    let values = [a.get(column, slot), b.get(column, slot)];
                    differ(values[0], values[1]).then_some((*name, values))
                }),
                (false, false) => None,
                (a, b) => Some(("alive", [a, b].map(|lives| f64::from(u8::from(lives))))),
            };
            if let Some((name, values)) = found {
                (self.slot, self.column, self.values) = (Some(slot), Some(name), Some(values));
                return;
            }
        }
    }
}

/// How far two runs are apart at one step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Apart {
    /// The step.
    pub step: u64,
    /// Simulated seconds.
    pub time_secs: f64,
    /// Bodies of which something differs, or that live in one alone.
    pub bodies: usize,
    /// The largest distance of a body from itself, metres.
    pub position: f64,
    /// The largest difference of two attitudes, rad.
    pub angle: f64,
    /// The largest difference of two velocities, m/s.
    pub velocity: f64,
}

impl Apart {
    /// Of two frames of one step.
    pub fn of(a: &Frame, b: &Frame) -> Self {
        let mut apart = Self { step: a.step, time_secs: a.time_secs, ..Self::default() };
        for slot in 1..=a.alive.len().max(b.alive.len()) {
            if !(a.lives(slot) && b.lives(slot)) {
                apart.bodies += usize::from(a.lives(slot) != b.lives(slot));
                continue;
            }
            let change = |column: usize| b.get(column, slot) - a.get(column, slot);
            apart.bodies += usize::from((0..COLUMNS.len()).any(|k| differ(a.get(k, slot), b.get(k, slot))));
            let ([ca, sa], [cb, sb]) = ([a.get(2, slot), a.get(3, slot)], [b.get(2, slot), b.get(3, slot)]);
            let turned = (ca * sb - sa * cb).atan2(ca * cb + sa * sb).abs();
            apart.position = apart.position.max(change(0).hypot(change(1)));
            apart.angle = apart.angle.max(turned);
            apart.velocity = apart.velocity.max(change(4).hypot(change(5)));
        }
        apart
    }
}

/// The first step at which two recordings differ, of those both have.
///
/// # Errors
/// A frame that cannot be read.
pub fn first_difference(a: &mut Recording, b: &mut Recording) -> Result<Option<Difference>, RecordError> {
    let parted = a.rows().iter().find_map(|row| {
        let other = b.row(row.step)?;
        (other.hash != row.hash).then_some(row.step)
    });
    let Some(step) = parted else { return Ok(None) };
    let mut difference = Difference::at(step);
    for [frame_a, frame_b] in common_frames(a, b, step) {
        let (in_a, in_b) = (a.frame(frame_a)?, b.frame(frame_b)?);
        difference.look(&in_a.frame, &in_b.frame);
        if difference.slot.is_some() {
            break;
        }
    }
    Ok(Some(difference))
}

/// The frames of steps from `from` on that both recordings have.
pub fn common_frames(a: &Recording, b: &Recording, from: u64) -> Vec<[usize; 2]> {
    let pair = |frame: usize| {
        let step = a.step_of(frame)?;
        let other = b.frame_at(step)?;
        (b.step_of(other) == Some(step)).then_some([frame, other])
    };
    (a.frame_from(from)..a.frames()).filter_map(pair).collect()
}

/// Runs what a recording says was run, at another lane width if one is given, and compares every step by its hash;
/// `tell` hears of each step. Says where the two first differ: recorded first, then run again.
///
/// # Errors
/// Settings or a scene that cannot be run with; a frame that cannot be read.
pub fn verify(
    recording: &mut Recording,
    lanes: Option<usize>,
    mut tell: impl FnMut(u64),
) -> Result<Option<Difference>, RecordError> {
    let settings = recording.info().settings;
    let settings = Settings { lanes: lanes.unwrap_or(settings.lanes), ..settings };
    let mut session = Session::new(recording.scene(), settings)
        .map_err(|why| RecordError::Run { path: recording.path().to_owned(), why: why.to_string() })?;
    let rows: Vec<_> = recording.rows().iter().map(|row| (row.step, row.hash)).collect();
    for (step, hash) in rows {
        follow(&mut session, recording, step)?;
        if session.world().hash() != hash {
            return name_difference(recording, &mut session, step).map(Some);
        }
        tell(step);
    }
    Ok(None)
}

/// Advances to a step, doing what was done.
fn follow(session: &mut Session, recording: &Recording, to: u64) -> Result<(), RecordError> {
    let followed = session.follow(recording.events(), to);
    followed.map_err(|why| RecordError::event(recording.path(), session.world().steps(), &why))
}

/// Looks in the first frame from `step` on.
fn name_difference(
    recording: &mut Recording,
    session: &mut Session,
    step: u64,
) -> Result<Difference, RecordError> {
    let mut difference = Difference::at(step);
    let frame = recording.frame_from(step);
    if frame < recording.frames() {
        let recorded = recording.frame(frame)?.frame;
        follow(session, recording, recorded.step)?;
        let (mut snapshot, mut bytes) = (Snapshot::default(), Vec::new());
        session.world().snapshot(&mut snapshot, false);
        write_frame(&snapshot, recorded.time_secs, &mut bytes);
        let again = Frame::read(&bytes).map_err(|why| RecordError::frame(recording.path(), step, &why))?;
        difference.look(&recorded, &again);
    }
    Ok(difference)
}
