//! The container: MCAP, written in whole chunks and read chunk by chunk. The only module that knows the crate.
//!
//! All that counts lies in chunks, whose checksum covers what they hold; a chunk without one is refused. Where the
//! summary at the end is missing or damaged, chunks are found one after the other from the front.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom, Write};

use mcap::records::{MessageHeader, Record};
use mcap::sans_io::summary_reader::{SummaryReadEvent, SummaryReader, SummaryReaderOptions};
use mcap::sans_io::{LinearReadEvent, LinearReader, LinearReaderOptions};
use mcap::write::NoSeek;
use mcap::{McapError, WriteOptions, Writer};

use super::layout::Topic;

/// The opcode of a chunk record.
const CHUNK: u8 = 0x06;
/// Opcode and length of a record.
const RECORD_HEAD: u64 = 9;
/// Footer record and end magic, bytes.
const TAIL: u64 = RECORD_HEAD + 20 + mcap::MAGIC.len() as u64;
/// What LZ4 can make of a byte at most.
const LZ4_RATIO: u64 = 255;
/// A chunk that says it unpacks to more is not one of ours: 10,000,000 bodies in f64 take a third of it.
const LARGEST_CHUNK: u64 = 2 << 30;

/// Why a part of a file cannot be read.
#[derive(Debug, thiserror::Error)]
pub(super) enum Damage {
    /// The system says no.
    #[error(transparent)]
    Io(#[from] io::Error),
    /// The container is not whole.
    #[error("{0}")]
    Container(#[from] McapError),
    /// Something else does not fit.
    #[error("{0}")]
    Content(String),
}

/// Why a file cannot be written.
pub(super) type WriteError = McapError;

/// Says what does not fit.
pub(super) fn damage(what: impl Into<String>) -> Damage {
    Damage::Content(what.into())
}

/// LZ4 knows levels below 0, each of which skips faster over what does not pack: floats hardly do. A frame of 1000
/// settled bodies, 131 kB: level 0 takes 0.25 to 0.5 ms and leaves 105 kB, −16 0.24 ms and 119 kB, −32 0.2 ms and 126 kB.
const LEVEL: i32 = -16;

/// A file being written.
pub(super) struct Sink<W: Write> {
    writer: Writer<NoSeek<W>>,
    channels: [u16; Topic::ALL.len()],
    /// Of the chunk being written.
    bytes: usize,
    chunks: u32,
}

/// A chunk is closed when it holds so many bytes: enough to pack well, few enough to read for one frame.
const CHUNK_BYTES: usize = 1 << 20;

impl<W: Write> Sink<W> {
    pub(super) fn new(writer: W) -> Result<Self, McapError> {
        let mut writer = WriteOptions::new()
            .profile("lamina2d")
            .library(format!("lamina2d {}", env!("CARGO_PKG_VERSION")))
            .compression(Some(mcap::Compression::Lz4))
            .compression_level(LEVEL as u32)
            // Each chunk has one.
            .calculate_data_section_crc(false)
            // Chunks are closed here, so that their numbers are known, and written whole.
            .chunk_size(None)
            .disable_seeking(true)
            .create(NoSeek::new(writer))?;
        let mut channels = [0; Topic::ALL.len()];
        for (channel, topic) in channels.iter_mut().zip(Topic::ALL) {
            let (name, layout) = (format!("lamina2d{}", topic.name().replace('/', ".")), topic.layout());
            let schema = match layout {
                Some(layout) => writer.add_schema(&name, "lamina2d-layout", layout.as_bytes())?,
                None => 0,
            };
            *channel = writer.add_channel(schema, topic.name(), topic.encoding(), &BTreeMap::new())?;
        }
        Ok(Self { writer, channels, bytes: 0, chunks: 0 })
    }

    /// Appends a message of a step, at a time in the run.
    pub(super) fn put(
        &mut self,
        topic: Topic,
        step: u64,
        time_secs: f64,
        data: &[u8],
    ) -> Result<(), McapError> {
        let time = (time_secs * 1e9).round() as u64;
        let channel_id = self.channels[topic as usize];
        let header = MessageHeader { channel_id, sequence: step as u32, log_time: time, publish_time: time };
        self.bytes += data.len();
        self.writer.write_to_known_channel(&header, data)
    }

    /// The number of the chunk that the next message goes into.
    pub(super) fn chunk(&self) -> u32 {
        self.chunks
    }

    /// Closes the chunk if it is full.
    pub(super) fn end_if_full(&mut self) -> Result<(), McapError> {
        if self.bytes >= CHUNK_BYTES { self.end_chunk() } else { Ok(()) }
    }

    /// Closes the chunk: what is in it can be read whatever happens to the rest.
    pub(super) fn end_chunk(&mut self) -> Result<(), McapError> {
        if self.bytes > 0 {
            self.writer.flush()?;
            self.bytes = 0;
            self.chunks += 1;
        }
        Ok(())
    }

    /// Leaves the file as it is.
    pub(super) fn abandon(self) {
        // Dropped, the writer would try to write its summary, and panic where that fails too.
        let _ = self.writer.into_inner();
    }

    /// Writes the summary.
    pub(super) fn finish(mut self) -> Result<W, McapError> {
        match self.end_chunk().and_then(|()| self.writer.finish()) {
            Ok(_) => Ok(self.writer.into_inner().into_inner()),
            Err(why) => {
                self.abandon();
                Err(why)
            }
        }
    }
}

/// One message of a chunk.
#[derive(Debug)]
pub(super) struct Message {
    pub(super) topic: Topic,
    pub(super) data: Vec<u8>,
}

/// Where a chunk lies.
#[derive(Clone, Copy, Debug)]
struct Place {
    offset: u64,
    length: u64,
}

/// A file being read.
#[derive(Debug)]
pub(super) struct Source {
    file: File,
    /// Bytes.
    pub(super) length: u64,
    chunks: Vec<Place>,
    topics: BTreeMap<u16, Topic>,
}

impl Source {
    /// Looks at a file's beginning; no chunk is known yet.
    pub(super) fn open(mut file: File) -> Result<Self, Damage> {
        let length = file.metadata()?.len();
        let mut magic = [0; 8];
        let read = file.read(&mut magic)?;
        if magic[..read] != *mcap::MAGIC {
            return Err(damage("it does not begin as an MCAP file does"));
        }
        Ok(Self { file, length, chunks: Vec::new(), topics: BTreeMap::new() })
    }

    /// Chunks known.
    pub(super) fn chunks(&self) -> usize {
        self.chunks.len()
    }

    /// Learns of all chunks from the summary at the end.
    pub(super) fn read_summary(&mut self) -> Result<(), Damage> {
        self.check_summary()?;
        let options = SummaryReaderOptions::default()
            .with_file_size(self.length)
            .with_record_length_limit(self.length as usize);
        let mut reader = SummaryReader::new_with_options(options);
        while let Some(event) = reader.next_event() {
            match event? {
                SummaryReadEvent::ReadRequest(n) => {
                    let wanted = n.min(self.length as usize);
                    let read = self.file.read(reader.insert(wanted))?;
                    reader.notify_read(read);
                }
                SummaryReadEvent::SeekRequest(to) => {
                    let at = self.file.seek(to)?;
                    reader.notify_seeked(at);
                }
            }
        }
        let summary = reader.finish().ok_or_else(|| damage("it has no summary"))?;
        let channels: BTreeMap<_, _> = summary.channels.iter().collect();
        for (&id, channel) in channels {
            self.learn(id, &channel.topic);
        }
        let place = |chunk: &mcap::records::ChunkIndex| Place {
            offset: chunk.chunk_start_offset,
            length: chunk.chunk_length,
        };
        self.chunks = summary.chunk_indexes.iter().map(place).collect();
        self.chunks.sort_by_key(|chunk| chunk.offset);
        Ok(())
    }

    /// The summary's checksum: it covers all from the summary's start to the checksum itself.
    fn check_summary(&mut self) -> Result<(), Damage> {
        let tail_at = self.length.checked_sub(TAIL).ok_or_else(|| damage("it ends early"))?;
        let tail = self.bytes(tail_at, TAIL)?;
        let number = |at: usize| u64::from_le_bytes(tail[at..at + 8].try_into().unwrap_or_default());
        let head = RECORD_HEAD as usize;
        let (start, crc) = (number(head), number(head + 16) as u32);
        if tail[0] != 0x02 || !tail.ends_with(mcap::MAGIC) || start == 0 || start > tail_at || crc == 0 {
            return Err(damage("it has no summary"));
        }
        let covered = self.bytes(start, tail_at - start + RECORD_HEAD + 16)?;
        if crc32fast::hash(&covered) == crc { Ok(()) } else { Err(damage("its summary is damaged")) }
    }

    fn learn(&mut self, id: u16, topic: &str) {
        if let Some(topic) = Topic::ALL.into_iter().find(|known| known.name() == topic) {
            self.topics.insert(id, topic);
        }
    }

    /// The record that begins at `offset`: opcode and its length with all.
    fn record_at(&mut self, offset: u64) -> Result<(u8, u64), Damage> {
        let head = self.bytes(offset, RECORD_HEAD)?;
        let length = u64::from_le_bytes(head[1..9].try_into().unwrap_or_default());
        match length.checked_add(RECORD_HEAD) {
            Some(length) if length <= self.length - offset => Ok((head[0], length)),
            _ => Err(damage("a record reaches past the end")),
        }
    }

    /// Finds chunks from the front, and hands each to `take` until one of the two fails; says where and why, or
    /// `None` if all of the file was gone through.
    pub(super) fn scan(
        &mut self,
        mut take: impl FnMut(u32, Vec<Message>) -> Result<(), Damage>,
    ) -> (u64, Option<Damage>) {
        self.chunks.clear();
        self.topics.clear();
        let mut offset = mcap::MAGIC.len() as u64;
        let end = self.length.saturating_sub(mcap::MAGIC.len() as u64);
        while offset < end {
            let (opcode, length) = match self.record_at(offset) {
                Ok(record) => record,
                Err(why) => return (offset, Some(why)),
            };
            if opcode == CHUNK {
                self.chunks.push(Place { offset, length });
                let chunk = self.chunks.len() - 1;
                let taken = self.read(chunk).and_then(|messages| take(chunk as u32, messages));
                if let Err(why) = taken {
                    self.chunks.pop();
                    return (offset, Some(why));
                }
            }
            offset += length;
        }
        let mut magic = [0; 8];
        let whole = self.file.seek(SeekFrom::Start(end)).and_then(|_| self.file.read_exact(&mut magic));
        let cut_off = whole.is_err() || magic != *mcap::MAGIC;
        (offset, cut_off.then(|| damage("it was not finished")))
    }

    /// The messages of a chunk, once its checksum holds.
    pub(super) fn read(&mut self, chunk: usize) -> Result<Vec<Message>, Damage> {
        let place = *self.chunks.get(chunk).ok_or_else(|| damage(format!("it has no chunk {chunk}")))?;
        if self.record_at(place.offset)? != (CHUNK, place.length) {
            return Err(damage("a chunk is not where the summary says"));
        }
        let record = self.bytes(place.offset, place.length)?;
        let body = &record[RECORD_HEAD as usize..];
        let Record::Chunk { header, data } = mcap::parse_record(CHUNK, body)? else {
            return Err(damage("a chunk is none"));
        };
        let most = (data.len() as u64).saturating_mul(LZ4_RATIO).saturating_add(4096);
        if header.uncompressed_crc == 0 || header.uncompressed_size > most.min(LARGEST_CHUNK) {
            return Err(damage("a chunk's head is damaged"));
        }
        let limit = (header.uncompressed_size as usize).max(record.len());
        let mut messages = Vec::new();
        each_record(&record, limit, |record| match record {
            Record::Channel(channel) => self.learn(channel.id, &channel.topic),
            Record::Message { header, data } => {
                if let Some(&topic) = self.topics.get(&header.channel_id) {
                    messages.push(Message { topic, data: data.into_owned() });
                }
            }
            _ => {}
        })?;
        Ok(messages)
    }

    /// Bytes of the file, as many as it says it has.
    fn bytes(&mut self, offset: u64, length: u64) -> Result<Vec<u8>, Damage> {
        if offset.checked_add(length).is_none_or(|end| end > self.length) {
            return Err(damage("it ends early"));
        }
        self.file.seek(SeekFrom::Start(offset))?;
        let mut bytes = vec![0; length as usize];
        self.file.read_exact(&mut bytes)?;
        Ok(bytes)
    }
}

/// Unpacks a chunk, compares its checksum, and only then hands on its records: a length among them may be any number
/// while it is not known to be whole. `limit`: bytes that any part of it may take.
fn each_record(chunk: &[u8], limit: usize, mut take: impl FnMut(Record<'_>)) -> Result<(), Damage> {
    let options = LinearReaderOptions::default()
        .with_skip_start_magic(true)
        .with_skip_end_magic(true)
        .with_prevalidate_chunk_crcs(true)
        .with_record_length_limit(limit);
    let mut reader = LinearReader::new_with_options(options);
    let mut rest = chunk;
    while let Some(event) = reader.next_event() {
        match event? {
            LinearReadEvent::ReadRequest(wanted) => {
                let (next, after) = rest.split_at(wanted.min(rest.len()));
                reader.insert(next.len()).copy_from_slice(next);
                reader.notify_read(next.len());
                rest = after;
            }
            LinearReadEvent::Record { data, opcode } => take(mcap::parse_record(opcode, data)?),
        }
    }
    Ok(())
}
