//! Recordings that no recorder wrote: each has whole checksums and one thing that cannot be.

use std::path::{Path, PathBuf};

use lamina2d::record::{Recorder, Recording, STATISTICS};
use lamina2d::scene;
use lamina2d::settings::Settings;
use lamina2d::simulation::simulate;
use mcap::{Compression, WriteOptions};

use crate::shared_recording::{replace, rewrite};

type Outcome = Result<(), Box<dyn std::error::Error>>;

/// A good recording of a stack, and where a changed one may be put.
fn good() -> Result<(tempfile::TempDir, PathBuf, Vec<u8>), Box<dyn std::error::Error>> {
    let folder = tempfile::tempdir()?;
    let path = folder.path().join("a.mcap");
    let scene = scene::by_name("stack/3", None, 1)?;
    let mut world = simulate(&scene, Settings::default())?;
    let mut recorder = Recorder::create(&path, &scene, world.as_ref(), 1)?;
    for _ in 0..20 {
        world.step(1.0 / 60.0)?;
        recorder.record(world.as_ref(), false)?;
    }
    recorder.finish()?;
    let bytes = std::fs::read(&path)?;
    Ok((folder, path, bytes))
}

fn packed() -> WriteOptions {
    WriteOptions::new().compression(Some(Compression::Lz4))
}

/// Opens the rewritten recording and reads all of it; what went wrong, if anything.
fn read_all(path: &Path, bytes: &[u8]) -> Result<Recording, String> {
    std::fs::write(path, bytes).map_err(|why| why.to_string())?;
    let mut recording = Recording::open(path).map_err(|why| why.to_string())?;
    for frame in 0..recording.frames() {
        recording.frame(frame).map_err(|why| why.to_string())?;
        let step = recording.step_of(frame).ok_or("a frame without a step")?;
        recording.bodies(step).map_err(|why| why.to_string())?;
    }
    match recording.loss() {
        Some(loss) => Err(loss.to_string()),
        None => Ok(recording),
    }
}

/// What each kind of message is turned into, and what is said of it.
type Edit = fn(&mut Vec<u8>);

fn put_u32(data: &mut [u8], at: usize, value: u32) {
    data[at..at + 4].copy_from_slice(&value.to_le_bytes());
}

#[test]
fn what_cannot_be_is_refused_by_name() -> Outcome {
    let table: &[(&str, Edit, &[&str])] = &[
        (
            "/run",
            |data| replace(data, "\"format\":2", "\"format\":99"),
            &["format 99", "up to 2", "lamina2d"],
        ),
        ("/run", |data| replace(data, "\"format\":2", "\"format\":\"x\""), &["expected u32", "recording"]),
        ("/run", |data| replace(data, "\"substeps\":4", "\"substeps\":0"), &["substeps", "got 0"]),
        ("/run", |data| replace(data, "\"soft\"", "\"magic\""), &["magic", "soft"]),
        ("/run", |data| data.truncate(20), &["recording"]),
        ("/run", |data| data.fill(0xff), &["recording"]),
        ("/scene", |data| replace(data, "\"bodies\"", "\"bodes\""), &["bodes"]),
        ("/bodies", |data| replace(data, "\"slot\":1,", "\"slot\":0,"), &["slot 0"]),
        ("/bodies", |data| replace(data, "\"slot\":2,", "\"slot\":1,"), &["slot 1"]),
        ("/bodies", |data| replace(data, "\"box\":", "\"cone\":"), &["cone"]),
        ("/frame", |data| put_u32(data, 16, u32::MAX), &["step 0", "ends early"]),
        ("/frame", |data| put_u32(data, 16, 2), &["step 0", "too many"]),
        ("/frame", |data| put_u32(data, 20, 3), &["numbers of 3 bytes"]),
        ("/frame", |data| put_u32(data, 20, 0), &["numbers of 0 bytes"]),
        ("/frame", |data| data.push(0), &["1 bytes too many"]),
        ("/frame", |data| data.truncate(10), &["ends early"]),
        ("/frame", |data| put_u32(data, 0, 7777), &["does not hold it"]),
        ("/frame", |data| data.truncate(3), &["ends early"]),
        ("/contacts", |data| put_u32(data, 8, u32::MAX), &["ends early"]),
        ("/contacts", |data| put_u32(data, 12, 5), &["numbers of 5 bytes"]),
        ("/index", |data| put_u32(data, 0, u32::MAX), &["ends early"]),
        ("/index", |data| put_u32(data, 4, 9), &["out of order"]),
        ("/contents", |data| replace(data, "\"steps\":21", "\"steps\":22"), &["index is not whole"]),
        (
            "/contents",
            |data| replace(data, "\"index\":[", "\"index\":[4000000000,"),
            &["no chunk 4000000000"],
        ),
    ];
    let (_folder, path, bytes) = good()?;
    read_all(&path, &rewrite(&bytes, packed(), |_, _| true)?)?;
    for (topic, edit, mentions) in table {
        let changed = rewrite(&bytes, packed(), |known, data| {
            if known == *topic {
                edit(data);
            }
            true
        })?;
        let said =
            read_all(&path, &changed).err().unwrap_or_else(|| panic!("{topic} {mentions:?}: no error"));
        for mention in *mentions {
            assert!(said.contains(mention), "{topic}: no '{mention}' in '{said}'");
        }
    }
    Ok(())
}

/// Contacts of bodies that are not there.
#[test]
fn a_contact_of_no_body_is_refused() -> Outcome {
    let (_folder, path, bytes) = good()?;
    for (at, value, mention) in [(16, 77, "slot 77"), (0, 0, "of 0 points")] {
        let changed = rewrite(&bytes, packed(), |topic, data| {
            let count = u32::from_le_bytes(data[8..12].try_into().unwrap_or_default());
            if topic == "/contacts" && count > 0 {
                // The first slot A, or the first code behind all slots.
                let at = if at == 0 { 16 + 8 * count as usize } else { at };
                put_u32(data, at, value);
            }
            true
        })?;
        let said = read_all(&path, &changed).expect_err("an error");
        assert!(said.contains(mention), "no '{mention}' in '{said}'");
    }
    Ok(())
}

/// Messages that are missing: without its index a file is gone through from the front, without its run it is none.
#[test]
fn a_missing_message_is_made_good_or_named() -> Outcome {
    let (_folder, path, bytes) = good()?;
    for (topic, mentions) in [
        ("/run", &["no /run"][..]),
        ("/scene", &["no /scene"]),
        ("/bodies", &["bodies"]),
        ("/frame", &["does not hold it"]),
        ("/index", &["index is not whole"]),
        ("/contents", &["no /contents"]),
    ] {
        let changed = rewrite(&bytes, packed(), |known, _| known != topic)?;
        let said = read_all(&path, &changed).err().unwrap_or_else(|| panic!("{topic}: no error"));
        assert!(mentions.iter().all(|mention| said.contains(mention)), "{topic}: '{said}'");
    }
    // Without index, and without summary, every frame is still there.
    let changed = rewrite(&bytes, packed().emit_summary_records(false), |known, _| known != "/contents")?;
    std::fs::write(&path, changed)?;
    let mut recording = Recording::open(&path)?;
    assert_eq!((recording.frames(), recording.rows().len()), (21, 21));
    assert!((0..21).all(|frame| recording.frame(frame).is_ok()));
    Ok(())
}

/// Recordings of format 1 lack the last three statistics of each step: they are read as not known, by the index and without it.
#[test]
fn recordings_of_format_1_are_read() -> Outcome {
    const ROW: usize = 2 * 8 + STATISTICS.len() * 8;
    let (_folder, path, bytes) = good()?;
    let older = |known: &str, data: &mut Vec<u8>| match known {
        "/run" => replace(data, "\"format\":2", "\"format\":1"),
        "/step" => data.truncate(ROW - 3 * 8),
        "/index" => {
            let rows = data[4..].chunks(ROW + 4).flat_map(|row| [&row[..ROW - 3 * 8], &row[ROW..]].concat());
            *data = data[..4].iter().copied().chain(rows).collect();
        }
        _ => {}
    };
    for left_out in ["", "/contents"] {
        let changed = rewrite(&bytes, packed().emit_summary_records(left_out.is_empty()), |known, data| {
            older(known, data);
            known != left_out
        })?;
        std::fs::write(&path, changed)?;
        let recording = Recording::open(&path)?;
        assert_eq!((recording.info().format, recording.rows().len()), (1, 21));
        for row in recording.rows() {
            assert!(row.get("islands").is_some_and(f64::is_finite), "{row:?}");
            assert!(
                ["direct_joints", "direct_contacts", "stiff"]
                    .iter()
                    .all(|name| row.get(name).is_some_and(f64::is_nan))
            );
        }
    }
    Ok(())
}

/// A chunk without a checksum cannot be told from a damaged one.
#[test]
fn a_file_without_checksums_is_refused() -> Outcome {
    let (_folder, path, bytes) = good()?;
    let changed = rewrite(&bytes, packed().calculate_chunk_crcs(false), |_, _| true)?;
    let said = read_all(&path, &changed).expect_err("an error");
    assert!(said.contains("head is damaged"), "{said}");
    // Other tools may have taken the packing away: that is no damage.
    let unpacked = rewrite(&bytes, WriteOptions::new().compression(None), |_, _| true)?;
    read_all(&path, &unpacked)?;
    Ok(())
}

/// Files that are something else.
#[test]
fn other_files_are_refused() -> Outcome {
    let (folder, path, _) = good()?;
    let open = |bytes: &[u8]| {
        std::fs::write(&path, bytes).map_err(|why| why.to_string())?;
        Recording::open(&path).map(|_| ()).map_err(|why| why.to_string())
    };
    for bytes in [&b""[..], b"{}", b"\x89MCA", &[0; 4096]] {
        let said = open(bytes).expect_err("no recording");
        assert!(said.contains("MCAP"), "{said}");
    }
    let said = open(mcap::MAGIC).expect_err("no recording");
    assert!(said.contains("nothing in it can be read"), "{said}");
    let said = Recording::open(folder.path()).expect_err("a folder").to_string();
    assert!(said.contains("folder"), "{said}");
    let said = Recording::open(&folder.path().join("none.mcap")).expect_err("no file").to_string();
    assert!(said.contains("none.mcap"), "{said}");
    Ok(())
}
