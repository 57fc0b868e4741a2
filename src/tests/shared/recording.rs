//! Recordings that no recorder wrote: other messages under whole checksums.

use std::collections::BTreeMap;
use std::io::Cursor;

use mcap::records::MessageHeader;
use mcap::{Summary, WriteOptions};

/// Writes a recording once more, chunk by chunk, with other messages. `edit` is given topic and data, and leaves a
/// message out where it says false.
pub(crate) fn rewrite(
    bytes: &[u8],
    options: WriteOptions,
    mut edit: impl FnMut(&str, &mut Vec<u8>) -> bool,
) -> Result<Vec<u8>, Box<dyn std::error::Error>> {
    let summary = Summary::read(bytes)?.ok_or("a whole recording has a summary")?;
    let mut chunks = summary.chunk_indexes.clone();
    chunks.sort_by_key(|chunk| chunk.chunk_start_offset);
    let mut out = Cursor::new(Vec::new());
    {
        let mut writer = options.chunk_size(None).create(&mut out)?;
        for chunk in &chunks {
            for message in summary.stream_chunk(bytes, chunk)? {
                let message = message?;
                let (topic, mut data) = (message.channel.topic.clone(), message.data.to_vec());
                if edit(&topic, &mut data) {
                    let encoding = &message.channel.message_encoding;
                    let channel_id = writer.add_channel(0, &topic, encoding, &BTreeMap::new())?;
                    let header = MessageHeader {
                        channel_id,
                        sequence: message.sequence,
                        log_time: message.log_time,
                        publish_time: message.publish_time,
                    };
                    writer.write_to_known_channel(&header, &data)?;
                }
            }
            writer.flush()?;
        }
        writer.finish()?;
    }
    Ok(out.into_inner())
}

/// Puts `by` where the text of a message first has `what`.
pub(crate) fn replace(data: &mut Vec<u8>, what: &str, by: &str) {
    let text = String::from_utf8(std::mem::take(data)).expect("JSON");
    assert!(text.contains(what), "{what} is not in {text}");
    *data = text.replacen(what, by, 1).into_bytes();
}
