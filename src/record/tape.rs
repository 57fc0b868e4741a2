//! A running world's frames in memory, as a recording of it would have them; and its recording, made afterwards.

use std::collections::VecDeque;
use std::path::Path;
use std::sync::Arc;

use super::layout::{Frame, Order, StepRow, read_contacts, write_contacts, write_frame};
use super::sums::Sums;
use super::{FrameData, RecordError, Recorded, Recorder};
use crate::scene::Scene;
use crate::session::{Event, Session};
use crate::settings::Settings;
use crate::simulation::Simulation;
use crate::world::{BodyTable, Snapshot};

/// Where step rows hold the stages' times.
const TIMES: std::ops::Range<usize> = 1..7;

/// A frame's messages.
#[derive(Debug, Default)]
struct Packed {
    frame: Vec<u8>,
    contacts: Vec<u8>,
}

impl Packed {
    fn bytes(&self) -> usize {
        self.frame.len() + self.contacts.len()
    }
}

/// The numbers of every step, and the frames of the last ones: one a step, as many as memory is given for.
#[derive(Debug)]
pub struct Tape {
    most_bytes: usize,
    bytes: usize,
    rows: Vec<StepRow>,
    /// Of the steps up to the last.
    frames: VecDeque<Packed>,
    /// Bodies, and since which step they are so.
    tables: Vec<Arc<BodyTable>>,
    known: Option<[u64; 3]>,
    sums: Sums,
    order: Order,
    snapshot: Snapshot,
}

impl Tape {
    /// A tape that keeps frames of no more than `most_bytes`, and the last one in any case.
    pub fn new(most_bytes: usize) -> Self {
        Self {
            most_bytes,
            bytes: 0,
            rows: Vec::new(),
            frames: VecDeque::new(),
            tables: Vec::new(),
            known: None,
            sums: Sums::default(),
            order: Order::default(),
            snapshot: Snapshot::default(),
        }
    }

    /// Takes down the state after a step; where it is the step taken down last, in place of that. Steps follow one
    /// another, from 0.
    pub fn record(&mut self, world: &dyn Simulation) {
        world.snapshot(&mut self.snapshot, true);
        let (step, snapshot) = (self.snapshot.step, &self.snapshot);
        if self.known != Some(snapshot.revision) {
            self.known = Some(snapshot.revision);
            let table = world.body_table();
            self.sums.take(&table);
            if self.tables.last().is_some_and(|last| last.step == step) {
                self.tables.pop();
            }
            self.tables.push(Arc::new(table));
        }
        let time_secs = step as f64 * world.settings().dt_secs;
        let mut row = self.sums.row(snapshot, time_secs, true);
        if let Some(before) = self.rows.pop_if(|row| row.step == step) {
            // The step took as long as it did.
            row.values[TIMES].copy_from_slice(&before.values[TIMES]);
            self.bytes -= self.frames.pop_back().map_or(0, |last| last.bytes());
        }
        self.rows.push(row);
        let mut packed = Packed::default();
        write_frame(snapshot, time_secs, &mut packed.frame);
        write_contacts(snapshot, &mut self.order, &mut packed.contacts);
        self.bytes += packed.bytes();
        self.frames.push_back(packed);
        while self.bytes > self.most_bytes && self.frames.len() > 1 {
            self.bytes -= self.frames.pop_front().map_or(0, |first| first.bytes());
        }
    }

    /// The numbers of every step, ascending from step 0.
    pub fn rows(&self) -> &[StepRow] {
        &self.rows
    }
    /// Steps whose frames are kept: from the first to the last, exclusive.
    pub fn kept(&self) -> std::ops::Range<u64> {
        let end = self.rows.last().map_or(0, |row| row.step + 1);
        end - self.frames.len() as u64..end
    }
    /// The frame of a step, if it is kept.
    pub fn frame(&self, step: u64) -> Option<FrameData> {
        let at = step.checked_sub(self.kept().start)? as usize;
        let packed = self.frames.get(at)?;
        let frame = Frame::read(&packed.frame).ok()?;
        let (_, contacts) = read_contacts(&packed.contacts).ok()?;
        Some(FrameData { frame, contacts })
    }
    /// What bodies are at a step.
    pub fn bodies(&self, step: u64) -> Option<Arc<BodyTable>> {
        let at = self.tables.partition_point(|table| table.step <= step).checked_sub(1)?;
        self.tables.get(at).cloned()
    }
}

/// Records a run that is over, by running it again with all that was done in it: `steps` steps of `scene`, begun with
/// `settings`. Each `every`-th step becomes a frame, and so do the first and the last.
///
/// # Errors
/// Those of [`Recorder::create`] and [`Recorder::record`]; settings or events that are refused.
pub fn save(
    path: &Path,
    scene: &Scene,
    settings: Settings,
    events: &[Event],
    steps: u64,
    every: u64,
) -> Result<Recorded, RecordError> {
    let refused = |why: String| RecordError::Run { path: path.to_owned(), why };
    let mut session = Session::new(scene, settings).map_err(|why| refused(why.to_string()))?;
    let mut recorder = Recorder::create(path, scene, session.world(), every)?;
    for step in 0..steps {
        let known = session.events().len();
        let followed = session.follow(events, step + 1);
        followed.map_err(|why| RecordError::event(path, step, &why))?;
        for event in &session.events()[known..] {
            recorder.event(event)?;
        }
        recorder.record(session.world(), step + 1 == steps)?;
    }
    recorder.finish()
}
