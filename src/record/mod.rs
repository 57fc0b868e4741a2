//! Recordings: what a run did, frame by frame, in a file that other tools can open too.
//!
//! A recording is an [MCAP](https://mcap.dev) file with LZ4 chunks of about 1 MB. Whatever was written before a run was
//! killed can be read: chunks are written whole, each with a checksum over what it holds.
//!
//! | topic | encoding | when | what |
//! |---|---|---|---|
//! | `/run` | JSON | once | [`RunInfo`]: format, version, commit, compiler, settings, seed |
//! | `/scene` | JSON | once | the [`Scene`], as scene files have it |
//! | `/bodies` | JSON | where they change | shapes, kinds and masses by slot ([`BodyTable`](crate::world::BodyTable)) |
//! | `/event` | JSON | after a step | what was done to the world before the next ([`Event`](crate::session::Event)) |
//! | `/frame` | bytes | every k-th step | columns of all bodies ([`Frame`]) |
//! | `/contacts` | bytes | every k-th step | touching pairs ([`RecordedContact`]) |
//! | `/step` | bytes | each step | hash, stage times, counts, energy, momentum, overlap ([`StepRow`]) |
//! | `/index`, `/contents` | bytes, JSON | at the end | the steps once more, and in which chunk each frame is |
//!
//! A message's log time is simulated time, its sequence the step. Bytes are little-endian without padding; the schema of
//! each such topic says in words what is in it. `width` is 4 (f32) or 8 (f64).
//!
//! | message | layout |
//! |---|---|
//! | `/frame` | u64 step, f64 time, u32 slots, u32 width; `slots` numbers each of x, y, c, s, vx, vy, w; `slots` flags: 1 lives, 2 sleeps |
//! | `/contacts` | u64 step, u32 count, u32 width; `count` u32 each of slot A, slot B, code; `count` numbers of each of [`CONTACT_COLUMNS`] |
//! | `/step` | u64 step, u64 hash, f64 each of [`STATISTICS`]; of format 1 without the last three |
//!
//! Entry k − 1 is slot k; c and s are cos and sin of the attitude. With Python's `mcap` and `lz4`:
//! ```python
//! import struct
//! from mcap.reader import make_reader
//!
//! def frames(path):
//!     """Yields (step, time, {column: numbers by slot, from 1}, flags)."""
//!     with open(path, "rb") as file:
//!         for _, channel, message in make_reader(file).iter_messages(topics=["/frame"]):
//!             data = message.data
//!             step, time, slots, width = struct.unpack_from("<QdII", data)
//!             number, at, columns = {4: "f", 8: "d"}[width], 24, {}
//!             for name in ["x", "y", "c", "s", "vx", "vy", "w"]:
//!                 columns[name] = struct.unpack_from(f"<{slots}{number}", data, at)
//!                 at += slots * width
//!             yield step, time, columns, data[at:]
//!
//! for step, time, columns, flags in frames("a.mcap"):
//!     print(step, time, columns["x"][0], columns["y"][0])
//! ```
//!
//! # What it costs
//! Bytes per frame before packing: 29 per body and 56 per contact in f32, 57 and 100 in f64; 208 per step. Packed, of the
//! mix `all` in f32: 119 per body and frame once it has settled, 84 while it falls; 1.5 in free flight.
//!
//! The step's own thread copies columns and contacts (20 to 30 µs at 1000 bodies); another one hashes, sums up, packs and
//! writes about 550 MB/s. Where steps are so short that they make more than that (1.1 GB/s: 1000 settled bodies, 0.11 ms a
//! step), they wait for it, and recording each of them takes longer than the step: `--every` 4 then keeps up. Tried and
//! lost: LZ4 at −32 and −64 (a tenth to a third faster, hardly packs).

mod compare;
mod container;
mod layout;
mod pen;
mod recorder;
mod recording;
mod sums;
mod tape;

use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use serde::{Deserialize, Serialize};

use crate::contact::CONTACT_COLUMNS;
use crate::scene::Scene;
use crate::session::ActionError;
use crate::settings::Settings;
use crate::simulation::Simulation;
use crate::world::COLUMNS;

pub use compare::{Apart, Difference, common_frames, first_difference, verify};
pub use layout::{Frame, RecordedContact, STATISTICS, StepRow};
pub use recorder::{Recorded, Recorder, part_of};
pub use recording::{FrameData, Loss, Recording};
pub use tape::{Tape, save};

/// The format written. A newer one is refused.
pub const FORMAT: u32 = 2;
/// In the index: a step without a frame.
const NO_FRAME: u32 = u32::MAX;

/// The build of the program that records. A library does not know it: programs say it once, by [`set_stamp`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stamp {
    /// The commit it was built from.
    pub commit: &'static str,
    /// The compiler.
    pub rustc: &'static str,
    /// Flags given to the compiler.
    pub flags: &'static str,
}

impl Default for Stamp {
    fn default() -> Self {
        Self { commit: "unknown", rustc: "unknown", flags: "" }
    }
}

static STAMP: OnceLock<Stamp> = OnceLock::new();

/// Says which build all recordings of this process are from; only the first call counts.
pub fn set_stamp(stamp: Stamp) {
    let _ = STAMP.set(stamp);
}

/// What was run, with what.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RunInfo {
    /// [`FORMAT`].
    pub format: u32,
    /// Of this crate.
    pub crate_version: String,
    /// It was built from.
    pub commit: String,
    /// It was built with.
    pub rustc: String,
    /// Flags given to the compiler.
    pub flags: String,
    /// Vector features the code was compiled for.
    pub features: Vec<String>,
    /// The scene's name.
    pub scene: String,
    /// What its random numbers came from.
    pub seed: u64,
    /// Steps from frame to frame.
    pub every: u64,
    /// All settings.
    pub settings: Settings,
    /// A frame's columns, in order.
    pub columns: Vec<String>,
    /// A contact's columns, in order.
    pub contact_columns: Vec<String>,
    /// A step row's columns, in order.
    pub statistics: Vec<String>,
}

impl RunInfo {
    /// What a recording of `scene`, begun with the settings of `world`, says of itself.
    pub fn of(scene: &Scene, world: &dyn Simulation, every: u64) -> Self {
        let stamp = STAMP.get().copied().unwrap_or_default();
        let names = |names: &[&str]| names.iter().map(|name| (*name).to_owned()).collect();
        Self {
            format: FORMAT,
            crate_version: env!("CARGO_PKG_VERSION").to_owned(),
            commit: stamp.commit.to_owned(),
            rustc: stamp.rustc.to_owned(),
            flags: stamp.flags.to_owned(),
            features: crate::processor::features().into_iter().map(str::to_owned).collect(),
            scene: scene.name.clone(),
            seed: scene.seed,
            every,
            settings: *world.settings(),
            columns: names(&COLUMNS),
            contact_columns: names(&CONTACT_COLUMNS),
            statistics: names(&STATISTICS),
        }
    }
}

/// Why a recording could not be written or read.
#[derive(Debug, thiserror::Error)]
pub enum RecordError {
    /// The system says no.
    #[error("{}: {why}", path.display())]
    Io {
        /// Which file.
        path: PathBuf,
        /// What it says.
        why: std::io::Error,
    },
    /// A recording is one file.
    #[error("{}: a folder, not a file", .0.display())]
    Folder(PathBuf),
    /// Another run writes there, or did when it was killed.
    #[error(
        "{} is there: another run is recording to it, or was killed as it did; it can be read as it is, moved or removed",
        .0.display()
    )]
    PartExists(PathBuf),
    /// Writing had to end.
    #[error("recording stopped: {}: {why}; what was written before can be read there", part.display())]
    Stopped {
        /// The unfinished file.
        part: PathBuf,
        /// What ended it.
        why: String,
    },
    /// Writing has ended before.
    #[error("recording has ended")]
    Ended,
    /// No part of the file is of use.
    #[error("cannot read {} as a recording: {why}", path.display())]
    Unreadable {
        /// Which file.
        path: PathBuf,
        /// What does not fit.
        why: String,
    },
    /// A program of the future wrote it.
    #[error(
        "{} has format {format}, written by lamina2d {version}; this program reads formats up to {FORMAT}",
        path.display()
    )]
    Newer {
        /// Which file.
        path: PathBuf,
        /// Its format.
        format: u32,
        /// Of the crate that wrote it.
        version: String,
    },
    /// Frames are numbered from 0.
    #[error("there is no frame {frame}: the recording has {frames}")]
    NoFrame {
        /// What was asked for.
        frame: usize,
        /// What there is.
        frames: usize,
    },
    /// What was recorded cannot be run again.
    #[error("{}: {why}", path.display())]
    Run {
        /// Which file.
        path: PathBuf,
        /// Why not.
        why: String,
    },
    /// A frame is lost.
    #[error("{}: step {step} cannot be read: {why}", path.display())]
    Frame {
        /// Which file.
        path: PathBuf,
        /// Of the frame.
        step: u64,
        /// What does not fit.
        why: String,
    },
}

impl RecordError {
    fn io(path: &Path, why: std::io::Error) -> Self {
        Self::Io { path: path.to_owned(), why }
    }
    fn frame(path: &Path, step: u64, why: &container::Damage) -> Self {
        Self::Frame { path: path.to_owned(), step, why: why.to_string() }
    }
    fn event(path: &Path, step: u64, why: &ActionError) -> Self {
        Self::Run { path: path.to_owned(), why: format!("what was done after step {step} cannot be: {why}") }
    }
    fn unreadable(path: &Path, why: &container::Damage) -> Self {
        Self::Unreadable { path: path.to_owned(), why: why.to_string() }
    }
}
