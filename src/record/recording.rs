//! Reading: any frame of a recording, straight from its chunk.

use std::fs::File;
use std::path::{Path, PathBuf};

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use super::container::{Damage, Message, Source, damage};
use super::layout::{
    Bytes, Frame, RecordedContact, STATISTICS, StepRow, Topic, read_contacts, statistics_in,
};
use super::{FORMAT, NO_FRAME, RecordError, RunInfo};
use crate::scene::Scene;
use crate::session::Event;
use crate::world::BodyTable;

/// What lies where; the last message of a whole file.
#[derive(Debug, Default, Serialize, Deserialize)]
pub(super) struct Contents {
    /// Chunks of the index's blocks.
    pub(super) index: Vec<u32>,
    /// Steps from which bodies are others, and the chunks of their tables.
    pub(super) bodies: Vec<(u64, u32)>,
    /// Chunks that hold events.
    #[serde(default)]
    pub(super) events: Vec<u32>,
    /// Step rows.
    pub(super) steps: u64,
    /// Frames.
    pub(super) frames: u64,
}

/// How far a file is good that was not finished or is damaged.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Loss {
    /// Bytes from the front that can be read.
    pub good_bytes: u64,
    /// Bytes of the file.
    pub bytes: u64,
    /// What ended there.
    pub why: String,
}

impl std::fmt::Display for Loss {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "good up to byte {} of {}: {}", self.good_bytes, self.bytes, self.why)
    }
}

/// A frame with the contacts found in its step.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FrameData {
    /// Bodies.
    pub frame: Frame,
    /// Contacts, in the order of their slots.
    pub contacts: Vec<RecordedContact>,
}

/// A recording opened for reading.
#[derive(Debug)]
pub struct Recording {
    path: PathBuf,
    source: Source,
    info: RunInfo,
    scene: Scene,
    rows: Vec<StepRow>,
    /// Steps with a frame, and the chunks these are in.
    frames: Vec<(u64, u32)>,
    bodies: Vec<(u64, u32)>,
    events: Vec<Event>,
    loss: Option<Loss>,
    /// The chunk read last.
    cached: Option<(u32, Vec<Message>)>,
    /// The table read last.
    table: Option<(u64, BodyTable)>,
}

impl Recording {
    /// Opens a recording. One that was not finished, or whose end is damaged, is opened as far as it is good:
    /// [`Recording::loss`] says so.
    ///
    /// # Errors
    /// A file that cannot be read, is no recording of this program, was made by a newer one, or of which not even what
    /// was run can be read.
    pub fn open(path: &Path) -> Result<Self, RecordError> {
        let refused = |why: Damage| RecordError::unreadable(path, &why);
        if path.is_dir() {
            return Err(RecordError::Folder(path.to_owned()));
        }
        let file = File::open(path).map_err(|why| RecordError::io(path, why))?;
        let mut source = Source::open(file).map_err(refused)?;
        let indexed = source.read_summary().and_then(|()| read_index(&mut source));
        let (index, loss) = match indexed {
            Ok(index) => (index, None),
            Err(why) => scan(&mut source, &why),
        };
        if source.chunks() == 0 {
            let why = loss.map_or_else(|| "it is empty".to_owned(), |loss| loss.why);
            return Err(refused(damage(format!("nothing in it can be read: {why}"))));
        }
        let first = source.read(0).map_err(refused)?;
        let info = read_info(path, &first)?;
        let scene: Scene = json(&first, Topic::Scene).map_err(refused)?;
        let Index { rows, frames, bodies, events } = index;
        let recording = Self {
            path: path.to_owned(),
            source,
            info,
            scene,
            rows,
            frames,
            bodies,
            events,
            loss,
            cached: None,
            table: None,
        };
        recording.check_order().map_err(refused)?;
        Ok(recording)
    }

    /// Steps ascend, and so do frames and events.
    fn check_order(&self) -> Result<(), Damage> {
        let rows = self.rows.iter().map(|row| row.step).is_sorted_by(|a, b| a < b);
        let frames = self.frames.iter().map(|(step, _)| step).is_sorted_by(|a, b| a < b);
        let events = self.events.iter().map(|event| event.step).is_sorted();
        if rows && frames && events { Ok(()) } else { Err(damage("its steps are out of order")) }
    }

    /// Where it lies.
    pub fn path(&self) -> &Path {
        &self.path
    }
    /// Its size, bytes.
    pub fn bytes(&self) -> u64 {
        self.source.length
    }
    /// What was run.
    pub fn info(&self) -> &RunInfo {
        &self.info
    }
    /// The scene that was run.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }
    /// The numbers of every step, ascending; the state before the first is step 0.
    pub fn rows(&self) -> &[StepRow] {
        &self.rows
    }
    /// Frames.
    pub fn frames(&self) -> usize {
        self.frames.len()
    }
    /// The step of a frame.
    pub fn step_of(&self, frame: usize) -> Option<u64> {
        self.frames.get(frame).map(|(step, _)| *step)
    }
    /// The last frame at or before a step.
    pub fn frame_at(&self, step: u64) -> Option<usize> {
        self.frames.partition_point(|(known, _)| *known <= step).checked_sub(1)
    }
    /// The first frame at or after a step; [`Recording::frames`] if there is none.
    pub fn frame_from(&self, step: u64) -> usize {
        self.frames.partition_point(|(known, _)| *known < step)
    }
    /// The numbers of a step.
    pub fn row(&self, step: u64) -> Option<&StepRow> {
        self.rows.binary_search_by_key(&step, |row| row.step).ok().map(|at| &self.rows[at])
    }
    /// What was done to the world, in order.
    pub fn events(&self) -> &[Event] {
        &self.events
    }
    /// How far the file is good, if it is not whole.
    pub fn loss(&self) -> Option<&Loss> {
        self.loss.as_ref()
    }

    /// Reads a frame, in no more than its chunk takes.
    ///
    /// # Errors
    /// A number past the last; a chunk that is damaged: then this frame is lost, and perhaps its neighbours.
    pub fn frame(&mut self, frame: usize) -> Result<FrameData, RecordError> {
        let missing = || RecordError::NoFrame { frame, frames: self.frames.len() };
        let (step, chunk) = *self.frames.get(frame).ok_or_else(missing)?;
        self.read_frame(step, chunk).map_err(|why| RecordError::frame(&self.path, step, &why))
    }

    fn read_frame(&mut self, step: u64, chunk: u32) -> Result<FrameData, Damage> {
        let mut data = FrameData::default();
        let mut found = false;
        for message in self.chunk(chunk)? {
            match message.topic {
                Topic::Frame if Frame::step_of(&message.data)? == step => {
                    data.frame = Frame::read(&message.data)?;
                    found = true;
                }
                Topic::Contacts if Frame::step_of(&message.data)? == step => {
                    (_, data.contacts) = read_contacts(&message.data)?;
                }
                _ => {}
            }
        }
        // Slot 0 is the world.
        let lives = |slot: &u32| *slot == 0 || data.frame.lives(*slot as usize);
        if !found {
            return Err(damage("its chunk does not hold it"));
        }
        match data.contacts.iter().flat_map(|contact| &contact.slots).find(|slot| !lives(slot)) {
            Some(slot) => Err(damage(format!("a contact of slot {slot}, where no body lives"))),
            None => Ok(data),
        }
    }

    /// What bodies are at a step: shapes, masses, kinds.
    ///
    /// # Errors
    /// A chunk that is damaged.
    pub fn bodies(&mut self, step: u64) -> Result<&BodyTable, RecordError> {
        if let Err(why) = self.read_bodies(step) {
            return Err(RecordError::frame(&self.path, step, &why));
        }
        let missing = || RecordError::frame(&self.path, step, &damage("no bodies are known"));
        self.table.as_ref().map(|(_, table)| table).ok_or_else(missing)
    }

    /// Brings the table of a step into memory.
    fn read_bodies(&mut self, step: u64) -> Result<(), Damage> {
        let at = self.bodies.partition_point(|(since, _)| *since <= step).checked_sub(1);
        let (since, chunk) = at.map(|at| self.bodies[at]).ok_or_else(|| damage("no bodies are known"))?;
        if self.table.as_ref().is_none_or(|(known, _)| *known != since) {
            let messages = self.chunk(chunk)?;
            let tables = messages.iter().filter(|message| message.topic == Topic::Bodies);
            let tables = tables.map(|message| read_table(&message.data)).collect::<Result<Vec<_>, _>>()?;
            let table = tables.into_iter().rfind(|table| table.step == since);
            self.table =
                Some((since, table.ok_or_else(|| damage("its bodies are not where they should be"))?));
        }
        Ok(())
    }

    fn chunk(&mut self, chunk: u32) -> Result<&[Message], Damage> {
        if self.cached.as_ref().is_none_or(|(known, _)| *known != chunk) {
            self.cached = None;
            self.cached = Some((chunk, self.source.read(chunk as usize)?));
        }
        self.cached.as_ref().map(|(_, messages)| messages.as_slice()).ok_or_else(|| damage("no chunk"))
    }
}

/// What is known of a file without its frames.
#[derive(Debug, Default)]
struct Index {
    rows: Vec<StepRow>,
    frames: Vec<(u64, u32)>,
    bodies: Vec<(u64, u32)>,
    events: Vec<Event>,
}

impl Index {
    fn add(&mut self, row: StepRow, chunk: u32) {
        if chunk != NO_FRAME {
            self.frames.push((row.step, chunk));
        }
        self.rows.push(row);
    }
}

/// How many statistics the rows of a file have whose first chunk this is.
fn known_statistics(first: &[Message]) -> usize {
    #[derive(Deserialize)]
    struct Format {
        format: u32,
    }
    // What cannot be read is refused by whoever asks what was run.
    let format = json(first, Topic::Run).map_or(FORMAT, |Format { format }| format);
    statistics_in(format)
}

/// The index at the end of a whole file.
fn read_index(source: &mut Source) -> Result<Index, Damage> {
    let known = known_statistics(&source.read(0)?);
    let last = source.chunks().checked_sub(1).ok_or_else(|| damage("it has no chunks"))?;
    let contents: Contents = json(&source.read(last)?, Topic::Contents)?;
    let mut index = Index { bodies: contents.bodies, ..Index::default() };
    for chunk in contents.events {
        for message in source.read(chunk as usize)?.iter().filter(|message| message.topic == Topic::Event) {
            index.events.push(parse(&message.data)?);
        }
    }
    for chunk in contents.index {
        for message in source.read(chunk as usize)?.iter().filter(|message| message.topic == Topic::Index) {
            let mut from = Bytes(&message.data);
            for _ in 0..from.u32()? {
                let row = StepRow::take(&mut from, known)?;
                index.add(row, from.u32()?);
            }
            from.end("the index")?;
        }
    }
    if (index.rows.len() as u64, index.frames.len() as u64) == (contents.steps, contents.frames) {
        Ok(index)
    } else {
        Err(damage("its index is not whole"))
    }
}

/// Goes through a file from the front, where its index cannot be read for the reason given.
fn scan(source: &mut Source, why: &Damage) -> (Index, Option<Loss>) {
    let (mut index, mut known) = (Index::default(), STATISTICS.len());
    let (good_bytes, ended) = source.scan(|chunk, messages| {
        if chunk == 0 {
            known = known_statistics(&messages);
        }
        let (mut rows, mut frames, mut bodies, mut events) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        for message in messages {
            match message.topic {
                Topic::Step => rows.push(StepRow::read(&message.data, known)?),
                Topic::Frame => frames.push((Frame::step_of(&message.data)?, chunk)),
                Topic::Event => events.push(parse(&message.data)?),
                Topic::Bodies => bodies.push((parse::<BodyTable>(&message.data)?.step, chunk)),
                _ => {}
            }
        }
        // All of a chunk or nothing.
        index.rows.append(&mut rows);
        index.frames.append(&mut frames);
        index.bodies.append(&mut bodies);
        index.events.append(&mut events);
        Ok(())
    });
    let why = ended.map_or_else(|| why.to_string(), |ended| ended.to_string());
    (index, Some(Loss { good_bytes, bytes: source.length, why }))
}

/// What was run, if this program can read it.
fn read_info(path: &Path, first: &[Message]) -> Result<RunInfo, RecordError> {
    /// All that every format has.
    #[derive(Deserialize)]
    struct Any {
        format: u32,
        crate_version: String,
    }
    let refused = |why: Damage| RecordError::unreadable(path, &why);
    let any: Any = json(first, Topic::Run).map_err(refused)?;
    if any.format > FORMAT {
        return Err(RecordError::Newer {
            path: path.to_owned(),
            format: any.format,
            version: any.crate_version,
        });
    }
    let info: RunInfo = json(first, Topic::Run).map_err(refused)?;
    info.settings.check().map_err(|why| refused(damage(why.to_string())))?;
    Ok(info)
}

/// What bodies are: slots ascend from 1, shapes have an inside.
fn read_table(bytes: &[u8]) -> Result<BodyTable, Damage> {
    let table: BodyTable = parse(bytes)?;
    let mut before = 0;
    for body in &table.bodies {
        if body.slot <= before {
            return Err(damage(format!("a body in slot {} after slot {before}", body.slot)));
        }
        before = body.slot;
        body.shape.build().map_err(|why| damage(format!("body in slot {}: {why}", body.slot)))?;
    }
    Ok(table)
}

fn json<T: DeserializeOwned>(messages: &[Message], topic: Topic) -> Result<T, Damage> {
    let message = messages.iter().find(|message| message.topic == topic);
    let message =
        message.ok_or_else(|| damage(format!("it is no recording of lamina: it has no {}", topic.name())))?;
    parse(&message.data)
}

fn parse<T: DeserializeOwned>(bytes: &[u8]) -> Result<T, Damage> {
    serde_json::from_slice(bytes).map_err(|why| damage(why.to_string()))
}
