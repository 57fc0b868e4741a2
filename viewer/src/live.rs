//! A running world behind the interface that recordings have: real time by fixed steps, acted upon by hand.
//!
//! Everything done is an event of the [`Session`], so that the run can be saved: it is run once more into a recording,
//! which `lamina verify` then reproduces to the bit.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, TryRecvError, channel};
use std::time::Instant;

use lamina2d::body::BodyId;
use lamina2d::clock::Accumulator;
use lamina2d::record::{FrameData, RecordError, Recorded, Recorder, RunInfo, StepRow, Tape, save};
use lamina2d::scene::{BodyKind, BodySpec, Scene, ShapeSpec, mixes};
use lamina2d::session::{Action, ActionError, Session};
use lamina2d::settings::Settings;
use lamina2d::world::{BodyTable, WorldError};

use crate::source::{Source, SourceError};

/// Frames are kept in as much memory, bytes.
const MOST_BYTES: usize = 256 << 20;
/// Stepping takes no longer between two pictures: a world that is too slow for real time falls behind.
const BUDGET_SECS: f64 = 0.04;
/// Over this the share of real time is averaged, seconds.
const SHARE_OVER_SECS: f64 = 1.0;

/// What a click on the canvas does to a running world.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Tool {
    /// Selects a body; a drag pulls it.
    #[default]
    Hand,
    /// Puts a circle there.
    Circle,
    /// Puts a box there.
    Box,
    /// Puts a random polygon there.
    Polygon,
}

impl Tool {
    /// Every tool, in order.
    pub const ALL: [Self; 4] = [Self::Hand, Self::Circle, Self::Box, Self::Polygon];

    /// The name in the panel.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Hand => "hand",
            Self::Circle => "new circle",
            Self::Box => "new box",
            Self::Polygon => "new polygon",
        }
    }
}

/// A world that runs while it is looked at. Its frames are numbered by steps.
#[derive(Debug)]
pub struct Live {
    scene: Scene,
    begun_with: Settings,
    info: RunInfo,
    session: Session,
    tape: Tape,
    clock: Accumulator,
    /// Where the pulled point is to be from the next step on, metres.
    target: Option<[f64; 2]>,
    recorder: Option<Recorder>,
    saving: Option<Receiver<Result<Recorded, RecordError>>>,
    /// Why it no longer runs.
    stopped: Option<String>,
    /// Of new bodies: radius or half a side, metres.
    pub size: f64,
    /// Of new bodies, kg/m².
    pub density: f64,
    /// Where it is to be saved, as typed.
    pub path: String,
    /// What became of the last saving.
    pub said: Option<String>,
    polygons: u64,
    /// Of bodies that were made static, kg.
    masses: BTreeMap<BodyId, f64>,
    /// Real and simulated seconds of late.
    lately: [f64; 2],
}

impl Live {
    /// A scene at its beginning; with `record` everything is recorded as it happens.
    ///
    /// # Errors
    /// Settings, fields or bodies that cannot be run with; a file that cannot be written.
    pub fn new(scene: Scene, settings: Settings, record: Option<PathBuf>) -> Result<Self, LiveError> {
        let session = Session::new(&scene, settings)?;
        let recorder = record.map(|path| Recorder::create(&path, &scene, session.world(), 1)).transpose()?;
        let mut tape = Tape::new(MOST_BYTES);
        tape.record(session.world());
        let matter = tape.bodies(0).and_then(|table| middling(&table));
        let [size, density] = matter.unwrap_or([0.5, 1.0]);
        Ok(Self {
            info: RunInfo::of(&scene, session.world(), 1),
            clock: Accumulator::new(settings.dt_secs, Accumulator::CLAMP_SECS),
            path: format!("{}.mcap", scene.name.replace('/', "_")),
            scene,
            begun_with: settings,
            session,
            tape,
            target: None,
            recorder,
            saving: None,
            stopped: None,
            size,
            density,
            said: None,
            polygons: 0,
            masses: BTreeMap::new(),
            lately: [0.0; 2],
        })
    }

    /// The same scene at its beginning, with the settings it began with.
    ///
    /// # Errors
    /// Those of [`Live::new`].
    pub fn anew(&self) -> Result<Self, LiveError> {
        Self::new(self.scene.clone(), self.begun_with, None)
    }

    /// The settings of now; those it began with are [`Source::info`]'s.
    pub fn settings(&self) -> &Settings {
        self.session.world().settings()
    }
    /// The session.
    pub fn session(&self) -> &Session {
        &self.session
    }
    /// Why it no longer runs.
    pub fn stopped(&self) -> Option<&str> {
        self.stopped.as_deref()
    }
    /// Is it recorded as it happens?
    pub fn records(&self) -> bool {
        self.recorder.is_some()
    }
    /// Simulated seconds per second, of late; 0 while it stands still.
    pub fn share_of_real_time(&self) -> f64 {
        if self.lately[0] > 0.0 { self.lately[1] / self.lately[0] } else { 0.0 }
    }

    /// Lets real time pass, `speed` times as fast. Returns how many steps were taken.
    pub fn advance(&mut self, elapsed_secs: f64, speed: f64) -> usize {
        let due = self.clock.steps_due(elapsed_secs * speed) as usize;
        let begin = Instant::now();
        let mut taken = 0;
        while taken < due && begin.elapsed().as_secs_f64() < BUDGET_SECS && self.step() {
            taken += 1;
        }
        let kept = (1.0 - elapsed_secs / SHARE_OVER_SECS).clamp(0.0, 1.0);
        let passed = [elapsed_secs, taken as f64 * self.begun_with.dt_secs];
        self.lately = [0, 1].map(|k| self.lately[k] * kept + passed[k]);
        taken
    }

    /// Takes a step; false if the world had stopped.
    pub fn step(&mut self) -> bool {
        if self.stopped.is_some() {
            return false;
        }
        if let (Some(target), Some(pull)) = (self.target.take(), self.session.pull().copied())
            && pull.target != target
        {
            let slot = pull.id.slot() as u32;
            // A body that is gone is no longer pulled.
            let _ = self.act(Action::Pull { slot, point_body: pull.point_body, target });
        }
        let stepped = self.session.step();
        self.tape.record(self.session.world());
        let recorded = self.recorder.as_mut().map(|recorder| {
            let broken = stepped.is_err();
            recorder.record(self.session.world(), broken)
        });
        self.stopped = stepped.err().map(|why| why.to_string());
        if let Some(Err(why)) = recorded {
            self.lose_recorder(&why);
        }
        true
    }

    fn lose_recorder(&mut self, why: &RecordError) {
        self.recorder = None;
        self.said = Some(why.to_string());
    }

    /// Does something to the world, at once. Returns the slot of a body that came.
    ///
    /// # Errors
    /// Those of [`Session::apply`].
    pub fn act(&mut self, action: Action) -> Result<Option<u32>, ActionError> {
        let slot = self.session.apply(action)?;
        if let (Some(recorder), Some(event)) = (&mut self.recorder, self.session.events().last())
            && let Err(why) = recorder.event(event)
        {
            self.lose_recorder(&why);
        }
        self.tape.record(self.session.world());
        Ok(slot)
    }

    /// Puts a body of the size and density chosen there, metres; `None` for the hand.
    ///
    /// # Errors
    /// A size or density that cannot be run with.
    pub fn spawn(&mut self, tool: Tool, position: [f64; 2]) -> Result<Option<u32>, ActionError> {
        let size = self.size;
        let shape = match tool {
            Tool::Hand => return Ok(None),
            Tool::Circle => ShapeSpec::Circle(size),
            Tool::Box => ShapeSpec::Box([size; 2]),
            Tool::Polygon => {
                self.polygons += 1;
                match mixes::polygon(self.scene.seed.wrapping_mul(7919).wrapping_add(self.polygons)) {
                    ShapeSpec::Polygon(outline) => {
                        ShapeSpec::Polygon(outline.iter().map(|corner| corner.map(|v| v * size)).collect())
                    }
                    other => other,
                }
            }
        };
        let spec = BodySpec { density: Some(self.density), ..BodySpec::new(shape, position) };
        self.act(Action::Insert(Box::new(spec)))
    }

    /// Makes a static body dynamic, with the mass it had before or by its area, and any other static.
    ///
    /// # Errors
    /// A slot without a body.
    pub fn toggle_static(&mut self, slot: usize) -> Result<(), ActionError> {
        let body = self.session.world().body(slot);
        let (kind, mass) = match body.map(|body| body.kind) {
            Some(BodyKind::Static) => {
                (BodyKind::Dynamic, body.and_then(|body| self.masses.get(&body.id).copied()))
            }
            _ => (BodyKind::Static, None),
        };
        self.act(Action::Change { slot: slot as u32, kind, mass })?;
        if let Some(body) = body.filter(|body| body.inv_mass > 0.0) {
            self.masses.insert(body.id, 1.0 / body.inv_mass);
        }
        Ok(())
    }

    /// Takes a dynamic body by a point of the world, metres. False if there is none to be taken.
    pub fn grab(&mut self, slot: usize, at: [f64; 2]) -> bool {
        let Some(body) = self.session.world().body(slot) else { return false };
        let [c, s] = body.state.rotation;
        let [dx, dy] = [0, 1].map(|k| at[k] - body.state.position[k]);
        let point_body = [c * dx + s * dy, c * dy - s * dx];
        self.target = None;
        self.act(Action::Pull { slot: slot as u32, point_body, target: at }).is_ok()
    }

    /// Where the point taken is to go, metres.
    pub fn drag(&mut self, to: [f64; 2]) {
        self.target = Some(to);
    }

    /// Lets go.
    pub fn let_go(&mut self) {
        self.target = None;
        if self.session.pull().is_some() {
            // Letting go needs nothing and is never refused.
            let _ = self.act(Action::LetGo);
        }
    }

    /// From the point that is pulled to where it is to be, metres.
    pub fn pull_line(&self) -> Option<[[f64; 2]; 2]> {
        let pull = self.session.pull()?;
        let state = self.session.world().body(pull.id.slot())?.state;
        let ([c, s], [x, y]) = (state.rotation, pull.point_body);
        let from = [state.position[0] + c * x - s * y, state.position[1] + s * x + c * y];
        Some([from, self.target.unwrap_or(pull.target)])
    }

    /// Begins to save what happened so far to the path typed, beside what goes on.
    pub fn save(&mut self) {
        let (scene, settings) = (self.scene.clone(), self.begun_with);
        let (events, steps) = (self.session.events().to_vec(), self.session.world().steps());
        let path = PathBuf::from(self.path.trim());
        let (tell, told) = channel();
        let work = move || {
            // Nobody listens any more once the window is closed.
            let _ = tell.send(save(&path, &scene, settings, &events, steps, 1));
        };
        match std::thread::Builder::new().name("lamina-save".to_owned()).spawn(work) {
            Ok(_) => (self.saving, self.said) = (Some(told), Some("saving …".to_owned())),
            Err(why) => self.said = Some(format!("cannot save: {why}")),
        }
    }

    /// Is it being saved? Takes down what became of it.
    pub fn is_saving(&mut self) -> bool {
        let Some(told) = &self.saving else { return false };
        self.said = match told.try_recv() {
            Err(TryRecvError::Empty) => return true,
            Ok(Ok(recorded)) => {
                Some(format!("saved {} steps, {:.2} MB", recorded.steps - 1, recorded.bytes as f64 / 1e6))
            }
            Ok(Err(why)) => Some(why.to_string()),
            Err(TryRecvError::Disconnected) => Some("saving broke off".to_owned()),
        };
        self.saving = None;
        false
    }

    /// Finishes the recording made as it happened, if there is one.
    ///
    /// # Errors
    /// A disk that says no.
    pub fn finish(&mut self) -> Result<Option<Recorded>, RecordError> {
        self.recorder.take().map(Recorder::finish).transpose()
    }
}

/// A middling dynamic body: radius or half a side (metres) and density (kg/m²).
fn middling(table: &BodyTable) -> Option<[f64; 2]> {
    let dynamic = table.bodies.iter().filter(|body| body.kind == BodyKind::Dynamic);
    let mut found: Vec<_> = dynamic
        .filter_map(|body| {
            let area = body.shape.build().ok()?.mass_properties().area;
            let size = match body.shape {
                ShapeSpec::Circle(radius) => radius,
                _ => 0.5 * area.sqrt(),
            };
            Some([size, body.mass / area])
        })
        .collect();
    found.sort_by(|a, b| a[0].total_cmp(&b[0]));
    found.get(found.len() / 2).copied()
}

/// Why a world cannot be run here.
#[derive(Debug, thiserror::Error)]
pub enum LiveError {
    /// Settings, fields or bodies.
    #[error(transparent)]
    World(#[from] WorldError),
    /// Its recording.
    #[error(transparent)]
    Record(#[from] RecordError),
}

impl Source for Live {
    fn name(&self) -> &str {
        &self.scene.name
    }
    fn info(&self) -> &RunInfo {
        &self.info
    }
    fn scene(&self) -> &Scene {
        &self.scene
    }
    fn facts(&self) -> Vec<(&'static str, String)> {
        vec![
            ("it is", "running here".to_owned()),
            ("scene is", self.scene.about.clone()),
            ("things done", self.session.events().len().to_string()),
        ]
    }
    fn loss(&self) -> Option<String> {
        None
    }
    fn first(&self) -> usize {
        self.tape.kept().start as usize
    }
    fn frames(&self) -> usize {
        self.tape.kept().end as usize
    }
    fn step_of(&self, frame: usize) -> Option<u64> {
        self.tape.kept().contains(&(frame as u64)).then_some(frame as u64)
    }
    fn frame_at(&self, step: u64) -> Option<usize> {
        let kept = self.tape.kept();
        (step >= kept.start).then_some(step.min(kept.end - 1) as usize)
    }
    fn rows(&self) -> &[StepRow] {
        self.tape.rows()
    }
    fn frame(&mut self, frame: usize) -> Result<FrameData, SourceError> {
        self.tape.frame(frame as u64).ok_or(SourceError::NotKept(frame))
    }
    fn bodies(&mut self, step: u64) -> Result<Arc<BodyTable>, SourceError> {
        self.tape.bodies(step).ok_or(SourceError::NotKept(step as usize))
    }
    fn live(&mut self) -> Option<&mut Live> {
        Some(self)
    }
}

impl Drop for Live {
    /// Closing the window ends a recording; who wants to know how it went calls [`Live::finish`] first.
    fn drop(&mut self) {
        let _ = self.finish();
    }
}
