//! What the writing thread does with each step.

use std::io::Write;

use super::container::{Sink, WriteError};
use super::layout::{Order, StepRow, Topic, write_contacts, write_frame};
use super::recorder::{Job, Recorded};
use super::recording::Contents;
use super::sums::Sums;
use super::{NO_FRAME, RunInfo};
use crate::scene::Scene;
use crate::world::Snapshot;

/// Steps per block of the index.
const BLOCK: usize = 1 << 16;

/// A recording's file and what is yet to be written of its index.
pub(super) struct Pen<W: Write> {
    sink: Sink<W>,
    dt_secs: f64,
    sums: Sums,
    /// Step rows and chunks of their frames, since the last block.
    block: Vec<(StepRow, u32)>,
    contents: Contents,
    recorded: Recorded,
    order: Order,
    bytes: Vec<u8>,
}

impl<W: Write> Pen<W> {
    /// Writes down what the run is, in a chunk of its own.
    pub(super) fn begin(file: W, info: &RunInfo, scene: &Scene) -> Result<Self, WriteError> {
        let mut sink = Sink::new(file)?;
        let json = |sink: &mut Sink<W>, topic, value: serde_json::Result<Vec<u8>>| {
            sink.put(topic, 0, 0.0, &value.map_err(std::io::Error::other)?)
        };
        let written = json(&mut sink, Topic::Run, serde_json::to_vec(info))
            .and_then(|()| json(&mut sink, Topic::Scene, serde_json::to_vec(scene)))
            .and_then(|()| sink.end_chunk());
        if let Err(why) = written {
            sink.abandon();
            return Err(why);
        }
        Ok(Self {
            sink,
            dt_secs: info.settings.dt_secs,
            sums: Sums::default(),
            block: Vec::new(),
            contents: Contents::default(),
            recorded: Recorded::default(),
            order: Order::default(),
            bytes: Vec::new(),
        })
    }

    /// Leaves the file as it is.
    pub(super) fn abandon(self) {
        self.sink.abandon();
    }

    pub(super) fn write(&mut self, job: &Job) -> Result<(), WriteError> {
        match job {
            Job::Bodies(table) => {
                let json = serde_json::to_vec(table).map_err(std::io::Error::other)?;
                self.contents.bodies.push((table.step, self.sink.chunk()));
                self.sink.put(Topic::Bodies, table.step, self.time(table.step), &json)?;
                self.sums.take(table);
                Ok(())
            }
            Job::Event(event) => {
                let json = serde_json::to_vec(event).map_err(std::io::Error::other)?;
                let chunk = self.sink.chunk();
                if self.contents.events.last() != Some(&chunk) {
                    self.contents.events.push(chunk);
                }
                self.sink.put(Topic::Event, event.step, self.time(event.step), &json)
            }
            Job::Step { snapshot, frame } => self.step(snapshot, *frame),
        }
    }

    fn time(&self, step: u64) -> f64 {
        step as f64 * self.dt_secs
    }

    fn put(&mut self, topic: Topic, step: u64) -> Result<(), WriteError> {
        self.recorded.unpacked_bytes += self.bytes.len() as u64;
        self.sink.put(topic, step, step as f64 * self.dt_secs, &self.bytes)
    }

    fn step(&mut self, snapshot: &Snapshot, frame: bool) -> Result<(), WriteError> {
        let (step, time_secs) = (snapshot.step, self.time(snapshot.step));
        let row = self.sums.row(snapshot, time_secs, frame);
        let chunk = if frame { self.sink.chunk() } else { NO_FRAME };
        if frame {
            write_frame(snapshot, time_secs, &mut self.bytes);
            self.put(Topic::Frame, step)?;
            write_contacts(snapshot, &mut self.order, &mut self.bytes);
            self.put(Topic::Contacts, step)?;
            self.recorded.frames += 1;
        }
        self.bytes.clear();
        row.write(&mut self.bytes);
        self.put(Topic::Step, step)?;
        self.recorded.steps += 1;
        self.block.push((row, chunk));
        self.sink.end_if_full()?;
        if self.block.len() == BLOCK { self.write_block() } else { Ok(()) }
    }

    /// A block of the index, in a chunk of its own.
    fn write_block(&mut self) -> Result<(), WriteError> {
        self.sink.end_chunk()?;
        self.bytes.clear();
        self.bytes.extend_from_slice(&(self.block.len() as u32).to_le_bytes());
        for (row, chunk) in self.block.drain(..) {
            row.write(&mut self.bytes);
            self.bytes.extend_from_slice(&chunk.to_le_bytes());
        }
        self.contents.index.push(self.sink.chunk());
        self.sink.put(Topic::Index, 0, 0.0, &self.bytes)?;
        self.sink.end_chunk()
    }

    /// Writes the index and the summary.
    pub(super) fn finish(mut self) -> Result<(W, Recorded), WriteError> {
        let written = self.write_block().and_then(|()| {
            (self.contents.steps, self.contents.frames) = (self.recorded.steps, self.recorded.frames);
            let json = serde_json::to_vec(&self.contents).map_err(std::io::Error::other)?;
            self.sink.put(Topic::Contents, 0, 0.0, &json)
        });
        match written {
            Ok(()) => Ok((self.sink.finish()?, self.recorded)),
            Err(why) => {
                self.sink.abandon();
                Err(why)
            }
        }
    }
}
