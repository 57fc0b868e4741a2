//! Where frames come from: a recording, or a running world ([`Live`]).

use std::path::Path;
use std::sync::Arc;

use lamina2d::record::{FrameData, RecordError, Recording, RunInfo, StepRow};
use lamina2d::scene::Scene;
use lamina2d::world::BodyTable;

use crate::live::Live;

/// Why a source has nothing to show.
#[derive(Debug, thiserror::Error)]
pub enum SourceError {
    /// What the recording says.
    #[error(transparent)]
    Record(#[from] RecordError),
    /// A run that was ended before its first frame was on disk.
    #[error("{0}: no frame of it can be read")]
    NoFrames(String),
    /// A running world keeps its last frames only.
    #[error("frame {0} is no longer kept")]
    NotKept(usize),
}

/// Frames in the order of their steps, and the numbers of every step.
pub trait Source: std::fmt::Debug {
    /// A short name for captions.
    fn name(&self) -> &str;
    /// What is run, with what.
    fn info(&self) -> &RunInfo;
    /// What it began with.
    fn scene(&self) -> &Scene;
    /// What else is worth telling: names and values.
    fn facts(&self) -> Vec<(&'static str, String)>;
    /// How far the source is good, if not all of it is.
    fn loss(&self) -> Option<String>;
    /// The first frame there still is.
    fn first(&self) -> usize {
        0
    }
    /// Frames there are now, those no longer kept included.
    fn frames(&self) -> usize;
    /// The step of a frame.
    fn step_of(&self, frame: usize) -> Option<u64>;
    /// The last frame at or before a step.
    fn frame_at(&self, step: u64) -> Option<usize>;
    /// The numbers of every step so far, ascending.
    fn rows(&self) -> &[StepRow];
    /// Bodies and contacts of a frame.
    ///
    /// # Errors
    /// A frame that is not there or damaged.
    fn frame(&mut self, frame: usize) -> Result<FrameData, SourceError>;
    /// What bodies are at a step.
    ///
    /// # Errors
    /// A table that is damaged.
    fn bodies(&mut self, step: u64) -> Result<Arc<BodyTable>, SourceError>;
    /// The recording behind it, if there is one: the library compares those.
    fn recording(&mut self) -> Option<&mut Recording> {
        None
    }
    /// The running world behind it, if there is one.
    fn live(&mut self) -> Option<&mut Live> {
        None
    }

    /// The numbers of a step.
    fn row(&self, step: u64) -> Option<&StepRow> {
        let rows = self.rows();
        rows.binary_search_by_key(&step, |row| row.step).ok().map(|at| &rows[at])
    }
    /// Simulated seconds at a frame; by its step's length where that number is lost.
    fn time_of(&self, frame: usize) -> f64 {
        let step = self.step_of(frame).unwrap_or(0);
        let known = self.row(step).and_then(|row| row.get("time_secs")).filter(|time| time.is_finite());
        known.unwrap_or(step as f64 * self.info().settings.dt_secs)
    }
}

/// A recording, read frame by frame.
#[derive(Debug)]
pub struct Replay {
    recording: Recording,
    name: String,
    /// The table given out last.
    table: Option<Arc<BodyTable>>,
}

impl Replay {
    /// Opens a recording; none of its frames but the first chunk's is read.
    ///
    /// # Errors
    /// Those of [`Recording::open`]; a recording without a frame.
    pub fn open(path: &Path) -> Result<Self, SourceError> {
        let recording = Recording::open(path)?;
        if recording.frames() == 0 {
            return Err(SourceError::NoFrames(path.display().to_string()));
        }
        let name = path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned();
        Ok(Self { recording, name, table: None })
    }
}

impl Source for Replay {
    fn name(&self) -> &str {
        &self.name
    }
    fn info(&self) -> &RunInfo {
        self.recording.info()
    }
    fn scene(&self) -> &Scene {
        self.recording.scene()
    }
    fn facts(&self) -> Vec<(&'static str, String)> {
        let (recording, scene) = (&self.recording, self.recording.scene());
        let joints = if scene.joints.is_empty() { "none".to_owned() } else { scene.joints.len().to_string() };
        vec![
            ("file", recording.path().display().to_string()),
            ("size", format!("{:.2} MB", recording.bytes() as f64 / 1e6)),
            ("frames", recording.frames().to_string()),
            ("steps", recording.rows().last().map_or(0, |row| row.step).to_string()),
            ("scene is", scene.about.clone()),
            ("bodies", scene.bodies.len().to_string()),
            ("joints", joints),
            ("things done", recording.events().len().to_string()),
        ]
    }
    fn loss(&self) -> Option<String> {
        self.recording.loss().map(ToString::to_string)
    }
    fn frames(&self) -> usize {
        self.recording.frames()
    }
    fn step_of(&self, frame: usize) -> Option<u64> {
        self.recording.step_of(frame)
    }
    fn frame_at(&self, step: u64) -> Option<usize> {
        self.recording.frame_at(step)
    }
    fn rows(&self) -> &[StepRow] {
        self.recording.rows()
    }
    fn frame(&mut self, frame: usize) -> Result<FrameData, SourceError> {
        Ok(self.recording.frame(frame)?)
    }
    fn bodies(&mut self, step: u64) -> Result<Arc<BodyTable>, SourceError> {
        let table = self.recording.bodies(step)?;
        match &self.table {
            Some(known) if known.step == table.step => Ok(Arc::clone(known)),
            _ => {
                let table = Arc::new(table.clone());
                self.table = Some(Arc::clone(&table));
                Ok(table)
            }
        }
    }
    fn recording(&mut self) -> Option<&mut Recording> {
        Some(&mut self.recording)
    }
}
