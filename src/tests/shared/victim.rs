//! Recordings made for tests, whole and damaged.

use std::fs::OpenOptions;
use std::io::{Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use lamina2d::record::{FrameData, Recorder, Recording};
use lamina2d::scene::{self, Scene};
use lamina2d::settings::Settings;
use lamina2d::simulation::{Simulation, simulate};

pub(crate) type Outcome = Result<(), Box<dyn std::error::Error>>;

/// Records `steps` steps and hands the world to `look` before the first and after each.
pub(crate) fn record(
    path: &Path,
    scene: &Scene,
    settings: Settings,
    (steps, every): (u64, u64),
    mut look: impl FnMut(&dyn Simulation),
) -> Outcome {
    let mut world = simulate(scene, settings)?;
    let mut recorder = Recorder::create(path, scene, world.as_ref(), every)?;
    look(world.as_ref());
    for step in 1..=steps {
        world.step(settings.dt_secs)?;
        recorder.record(world.as_ref(), step == steps)?;
        look(world.as_ref());
    }
    recorder.finish()?;
    Ok(())
}

pub(crate) fn folder() -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("a.mcap");
    (folder, path)
}

pub(crate) fn frames(recording: &mut Recording) -> Vec<FrameData> {
    (0..recording.frames()).map(|frame| recording.frame(frame).expect("a frame of a whole file")).collect()
}

/// A file whose bytes can be changed in place.
#[derive(Debug)]
pub(crate) struct Victim {
    path: PathBuf,
    pub(crate) bytes: Vec<u8>,
    pub(crate) whole: Vec<FrameData>,
    rows: Vec<(u64, u64)>,
}

impl Victim {
    /// Two boxes for a few steps, in several chunks: a chunk is closed when the bodies' table is new.
    pub(crate) fn small(path: &Path) -> Result<Self, Box<dyn std::error::Error>> {
        let scene = scene::by_name("stack/2", None, 1)?;
        record(path, &scene, Settings::default(), (6, 2), |_| {})?;
        let mut recording = Recording::open(path)?;
        let rows = recording.rows().iter().map(|row| (row.step, row.hash)).collect();
        let (whole, bytes) = (frames(&mut recording), std::fs::read(path)?);
        Ok(Self { path: path.to_owned(), bytes, whole, rows })
    }

    /// Opens the file as it is now: what can be read must be what was. Says how many frames could.
    pub(crate) fn check(&self, what: &str) -> usize {
        let Ok(mut recording) = Recording::open(&self.path) else { return 0 };
        for row in recording.rows() {
            assert!(self.rows.contains(&(row.step, row.hash)), "{what}: step {} is another", row.step);
        }
        let mut good = 0;
        for frame in 0..recording.frames() {
            let Ok(data) = recording.frame(frame) else { continue };
            let known = self.whole.iter().find(|known| known.frame.step == data.frame.step);
            assert_eq!(known, Some(&data), "{what}: a wrong frame");
            good += 1;
        }
        assert!(
            good == self.whole.len() || recording.loss().is_some() || good < recording.frames(),
            "{what}"
        );
        good
    }

    pub(crate) fn write(&self, at: usize, bytes: &[u8]) -> std::io::Result<()> {
        let mut file = OpenOptions::new().write(true).open(&self.path)?;
        file.seek(SeekFrom::Start(at as u64))?;
        file.write_all(bytes)
    }

    /// One bit of a byte is another; afterwards the file is whole again.
    pub(crate) fn flip(&self, at: usize, bit: usize) -> Result<usize, Box<dyn std::error::Error>> {
        self.write(at, &[self.bytes[at] ^ 1 << bit])?;
        let good = self.check(&format!("byte {at}, bit {bit}"));
        self.write(at, &self.bytes[at..=at])?;
        Ok(good)
    }
}
