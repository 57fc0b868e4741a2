//! Writing: the step's own thread copies columns and contacts, another one hashes, sums up, packs and writes them.

use std::fs::{self, File};
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::thread::JoinHandle;

use serde::Serialize;

use super::container::WriteError;
use super::pen::Pen;
use super::{RecordError, RunInfo};
use crate::scene::Scene;
use crate::session::Event;
use crate::simulation::Simulation;
use crate::world::{BodyTable, Snapshot};

/// Snapshots on their way to the writing thread at most: as many steps the writer may be behind.
const AHEAD: usize = 8;

/// What was recorded.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Recorded {
    /// Steps, the state before the first included.
    pub steps: u64,
    /// Frames.
    pub frames: u64,
    /// Bytes of the file.
    pub bytes: u64,
    /// Bytes of frames, contacts and step rows before they were packed.
    pub unpacked_bytes: u64,
}

/// What the writing thread is to do.
pub(super) enum Job {
    /// Bodies are others from here on.
    Bodies(Box<BodyTable>),
    /// Something was done to the world.
    Event(Box<Event>),
    /// A step, whole as a `frame` or by its numbers alone.
    Step { snapshot: Box<Snapshot>, frame: bool },
}

/// A recording being written.
#[derive(Debug)]
pub struct Recorder {
    jobs: Option<SyncSender<Job>>,
    used: Receiver<Box<Snapshot>>,
    writer: Option<JoinHandle<Result<Recorded, RecordError>>>,
    every: u64,
    known: Option<[u64; 3]>,
}

impl Recorder {
    /// Begins a recording of a run of `scene` with the settings of `world`, whose state becomes its first frame. Each
    /// `every`-th step becomes a frame; every step's numbers and hash are kept.
    ///
    /// It is written to `path` with `.part` appended, and gets its name when it is finished.
    ///
    /// # Errors
    /// A path that is a folder, lies in none, or whose `.part` is there; a disk that says no.
    pub fn create(
        path: &Path,
        scene: &Scene,
        world: &dyn Simulation,
        every: u64,
    ) -> Result<Self, RecordError> {
        let (part, file) = create_part(path)?;
        let info = RunInfo::of(scene, world, every);
        let (jobs, todo) = sync_channel(AHEAD);
        let (done, used) = sync_channel(AHEAD + 2);
        let (path, scene) = (path.to_owned(), scene.clone());
        let work = move || {
            let counting = Counting { inner: BufWriter::with_capacity(1 << 18, file), bytes: 0 };
            write_all(&path, &part, counting, &info, &scene, &todo, &done)
        };
        let writer = std::thread::Builder::new().name("lamina-record".to_owned()).spawn(work);
        let writer = writer.map_err(|why| RecordError::io(Path::new("the recording thread"), why))?;
        let mut recorder =
            Self { jobs: Some(jobs), used, writer: Some(writer), every: every.max(1), known: None };
        recorder.record(world, true)?;
        Ok(recorder)
    }

    /// Takes down the state after a step; `frame`: whole, even if it is not its turn.
    ///
    /// # Errors
    /// A disk that said no: at this or at an earlier step.
    pub fn record(&mut self, world: &dyn Simulation, frame: bool) -> Result<(), RecordError> {
        let mut snapshot = self.used.try_recv().unwrap_or_default();
        let frame = frame || world.steps().is_multiple_of(self.every);
        world.snapshot(&mut snapshot, frame);
        if self.known != Some(snapshot.revision) {
            self.known = Some(snapshot.revision);
            self.send(Job::Bodies(Box::new(world.body_table())))?;
        }
        self.send(Job::Step { snapshot, frame })
    }

    /// Takes down something that was done to the world after the step recorded last.
    ///
    /// # Errors
    /// A disk that said no: at this or at an earlier step.
    pub fn event(&mut self, event: &Event) -> Result<(), RecordError> {
        self.send(Job::Event(Box::new(event.clone())))
    }

    fn send(&mut self, job: Job) -> Result<(), RecordError> {
        let sent = self.jobs.as_ref().is_some_and(|jobs| jobs.send(job).is_ok());
        if sent { Ok(()) } else { self.end().map(|_| ()).and(Err(RecordError::Ended)) }
    }

    fn end(&mut self) -> Result<Recorded, RecordError> {
        self.jobs = None;
        let writer = self.writer.take().ok_or(RecordError::Ended)?;
        writer.join().map_err(|_| RecordError::Ended)?
    }

    /// Writes what is left, the index and the summary, and gives the file its name.
    ///
    /// # Errors
    /// A disk that says no; then what was written stays in the `.part`.
    pub fn finish(mut self) -> Result<Recorded, RecordError> {
        self.end()
    }
}

impl Drop for Recorder {
    /// A recording that is not finished keeps what it has.
    fn drop(&mut self) {
        if self.writer.is_some() {
            let _ = self.end();
        }
    }
}

/// The path a recording is written to before it gets its name.
pub fn part_of(path: &Path) -> PathBuf {
    let mut name = path.as_os_str().to_owned();
    name.push(".part");
    name.into()
}

fn create_part(path: &Path) -> Result<(PathBuf, File), RecordError> {
    if path.is_dir() {
        return Err(RecordError::Folder(path.to_owned()));
    }
    let part = part_of(path);
    match File::options().write(true).create_new(true).open(&part) {
        Ok(file) => Ok((part, file)),
        Err(why) if why.kind() == std::io::ErrorKind::AlreadyExists => Err(RecordError::PartExists(part)),
        Err(why) => Err(RecordError::io(&part, why)),
    }
}

/// Counts what passes.
struct Counting<W> {
    inner: W,
    bytes: u64,
}

impl<W: Write> Write for Counting<W> {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        let written = self.inner.write(bytes)?;
        self.bytes += written as u64;
        Ok(written)
    }
    fn flush(&mut self) -> std::io::Result<()> {
        self.inner.flush()
    }
}

/// The writing thread.
fn write_all(
    path: &Path,
    part: &Path,
    file: Counting<BufWriter<File>>,
    info: &RunInfo,
    scene: &Scene,
    todo: &Receiver<Job>,
    done: &SyncSender<Box<Snapshot>>,
) -> Result<Recorded, RecordError> {
    let stopped = |why: WriteError| RecordError::Stopped { part: part.to_owned(), why: why.to_string() };
    let failed = |why: std::io::Error| RecordError::io(part, why);
    let mut pen = Pen::begin(file, info, scene).map_err(stopped)?;
    for job in todo {
        match pen.write(&job) {
            Ok(()) => {
                if let Job::Step { snapshot, .. } = job {
                    // Nobody waits for it once the run is over.
                    let _ = done.try_send(snapshot);
                }
            }
            Err(why) => {
                pen.abandon();
                return Err(stopped(why));
            }
        }
    }
    let (file, mut recorded) = pen.finish().map_err(stopped)?;
    recorded.bytes = file.bytes;
    let file = file.inner.into_inner().map_err(|why| failed(why.into_error()))?;
    file.sync_all().map_err(failed)?;
    drop(file);
    fs::rename(part, path).map_err(|why| RecordError::io(path, why))?;
    Ok(recorded)
}
