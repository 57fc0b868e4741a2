//! Recordings: what is read is what was, whatever befell the file in between.

use std::fs::OpenOptions;
use std::path::Path;

use lamina2d::record::{FrameData, RecordError, Recorder, Recording, first_difference, part_of, verify};
use lamina2d::scene;
use lamina2d::settings::{Integrator, Precision, Settings};
use lamina2d::simulation::simulate;

use crate::shared_victim::{Outcome, Victim, folder, frames, record};

/// Every state, contact and sum of a run, read back, is what the world said at that step.
#[test]
fn what_is_read_is_what_was() -> Outcome {
    let (_folder, path) = folder();
    for (name, precision, sleep, positions) in [
        ("all/150", Precision::F32, false, None),
        ("polygons/150", Precision::F64, false, None),
        ("stack/4", Precision::F32, true, None),
        ("joint_grid/5", Precision::F32, false, None),
        ("tumbler/30", Precision::F32, false, None),
        ("all/150", Precision::F32, false, Some(Precision::F64)),
    ] {
        let scene = scene::by_name(name, None, 3)?;
        let settings = Settings { sleep, positions, ..Settings::default().with_precision(precision) };
        let mut seen = Vec::new();
        record(&path, &scene, settings, (120, 1), |world| {
            seen.push((world.hash(), world.states(), world.contacts(), world.invariants()));
        })?;
        let mut recording = Recording::open(&path)?;
        assert!(recording.loss().is_none());
        assert_eq!(recording.scene(), &scene);
        assert_eq!(recording.info().settings, settings);
        assert_eq!((recording.frames(), recording.rows().len()), (121, 121));
        // Backwards: nothing may depend on what was read before.
        for (step, (hash, states, contacts, sums)) in seen.iter().enumerate().rev() {
            let FrameData { frame, contacts: read } = recording.frame(step)?;
            let row = *recording.row(step as u64).expect("a row for each step");
            assert_eq!((frame.step, row.hash), (step as u64, *hash), "{name}");
            for (slot, state) in frame.slots().zip(states) {
                let columns: Vec<f64> = (0..7).map(|column| frame.get(column, slot)).collect();
                let ([x, y], [c, s], [vx, vy]) = (state.position, state.rotation, state.velocity);
                assert_eq!(columns, [x, y, c, s, vx, vy, state.angular_velocity], "{name} step {step}");
            }
            assert_eq!(frame.slots().count(), states.len());
            assert_contacts(&read, contacts, name);
            let deepest = contacts.iter().flat_map(|contact| &contact.points);
            let deepest = deepest.fold(0.0f64, |most, point| most.max(-point.separation));
            assert_eq!(row.get("max_overlap"), Some(deepest), "{name} step {step}");
            assert_eq!(row.get("kinetic_energy"), Some(sums.kinetic_energy), "{name} step {step}");
            assert_eq!(row.get("potential_energy"), Some(sums.potential_energy), "{name} step {step}");
            assert_eq!(row.get("angular_momentum"), Some(sums.angular_momentum), "{name} step {step}");
        }
        std::fs::remove_file(&path)?;
    }
    Ok(())
}

fn assert_contacts(
    read: &[lamina2d::record::RecordedContact],
    contacts: &[lamina2d::contact::Contact],
    name: &str,
) {
    let mut contacts: Vec<_> = contacts.iter().collect();
    contacts.sort_by_key(|contact| [contact.a, contact.b]);
    assert_eq!(read.len(), contacts.len(), "{name}");
    for (read, contact) in read.iter().zip(contacts) {
        assert_eq!(read.slots, [contact.a, contact.b], "{name}");
        assert_eq!((read.normal(), read.points), (contact.normal, contact.points.len()), "{name}");
        assert_eq!(read.tangent_impulse(), contact.tangent_impulse, "{name}");
        for (k, point) in contact.points.iter().enumerate() {
            let known = (read.arm(k), read.separation(k), read.impulse(k), u16::from(read.features[k]));
            assert_eq!(known, (point.arm_a, point.separation, point.impulse, point.feature), "{name}");
        }
    }
}

/// Being recorded changes no bit of a run, and what is recorded does not depend on lanes.
#[test]
fn recording_moves_no_bit_and_lanes_none_of_a_recording() -> Outcome {
    let (_folder, path) = folder();
    let scene = scene::by_name("polygons/150", None, 1)?;
    let mut alone = simulate(&scene, Settings::default())?;
    for _ in 0..100 {
        alone.step(1.0 / 60.0)?;
    }
    let mut known: Option<Vec<FrameData>> = None;
    for &lanes in Settings::widths(Precision::F32) {
        let mut last = 0;
        let settings = Settings { lanes, ..Settings::default() };
        record(&path, &scene, settings, (100, 10), |world| last = world.hash())?;
        assert_eq!(last, alone.hash(), "{lanes} lanes");
        let mut recording = Recording::open(&path)?;
        let read = frames(&mut recording);
        assert_eq!(read.len(), 11);
        assert_eq!(known.get_or_insert_with(|| read.clone()), &read, "{lanes} lanes");
        for other in Settings::widths(Precision::F32) {
            assert_eq!(verify(&mut recording, Some(*other), |_| {})?, None);
        }
    }
    Ok(())
}

/// A run with another integrator is told from the one recorded, at the step, body and column where they part.
#[test]
fn two_runs_part_where_they_say() -> Outcome {
    let (_folder, path) = folder();
    let other = path.with_file_name("b.mcap");
    let scene = scene::by_name("circles/20", None, 1)?;
    let settings = Settings::default();
    let euler = Settings { integrator: Integrator::SemiImplicitEuler, ..settings };
    let (mut a_states, mut b_states) = (Vec::new(), Vec::new());
    record(&path, &scene, settings, (50, 1), |world| a_states.push(world.states()))?;
    record(&other, &scene, euler, (50, 5), |world| b_states.push(world.states()))?;
    let (mut a, mut b) = (Recording::open(&path)?, Recording::open(&other)?);
    let expected = a_states.iter().zip(&b_states).position(|(a, b)| a != b).expect("they part") as u64;
    let found = first_difference(&mut a, &mut b)?.expect("a difference");
    assert_eq!(found.step, expected);
    // The second recording has each fifth frame: the place is named in the first both have.
    let frame = expected.next_multiple_of(5);
    assert_eq!(found.frame_step, Some(frame));
    let slot = a_states[frame as usize].iter().zip(&b_states[frame as usize]).position(|(a, b)| a != b);
    assert_eq!(found.slot, slot.map(|body| body + 1));
    assert_eq!(verify(&mut a, None, |_| {})?, None);
    assert_eq!(verify(&mut b, None, |_| {})?, None);
    assert!(first_difference(&mut a, &mut Recording::open(&path)?)?.is_none());
    Ok(())
}

/// Cut off after any byte, a recording opens as far as it goes or is refused, and says so.
#[test]
fn a_recording_cut_off_anywhere_shows_no_wrong_frame() -> Outcome {
    let (_folder, path) = folder();
    let file = Victim::small(&path)?;
    assert_eq!(file.check("whole"), file.whole.len());
    let mut readable = file.whole.len();
    let handle = OpenOptions::new().write(true).open(&path)?;
    for length in (0..file.bytes.len()).rev() {
        handle.set_len(length as u64)?;
        let good = file.check(&format!("cut off at {length}"));
        assert!(good <= readable, "more can be read of less at {length}");
        readable = good;
        if good > 0 {
            assert!(Recording::open(&path)?.loss().is_some(), "cut off at {length}, and said nothing");
        }
    }
    assert_eq!(readable, 0);
    Ok(())
}

/// With any one bit flipped no wrong frame is shown as right: here one bit of each byte.
#[test]
fn a_flipped_bit_shows_no_wrong_frame() -> Outcome {
    let (_folder, path) = folder();
    let file = Victim::small(&path)?;
    let mut readable = 0;
    for at in 0..file.bytes.len() {
        readable += usize::from(file.flip(at, at % 8)? > 0);
    }
    assert_eq!(file.check("whole again"), file.whole.len());
    // Most bytes are not the frames'.
    assert!(readable > file.bytes.len() / 4, "{readable} of {}", file.bytes.len());
    Ok(())
}

/// Lengths that lie: whatever eight bytes are turned into the largest numbers, memory is not asked for.
#[test]
fn lengths_without_end_are_refused() -> Outcome {
    let (_folder, path) = folder();
    let file = Victim::small(&path)?;
    for at in 0..file.bytes.len() - 8 {
        for lie in [u64::MAX, u64::MAX / 2, 1 << 40] {
            file.write(at, &lie.to_le_bytes())?;
            file.check(&format!("{lie} at byte {at}"));
        }
        file.write(at, &file.bytes[at..at + 8])?;
    }
    Ok(())
}

/// Where a recording cannot be written, nothing that is there is lost.
#[test]
fn a_recording_takes_no_place_that_is_taken() -> Outcome {
    let (folder, path) = folder();
    let scene = scene::by_name("stack/2", None, 1)?;
    let world = simulate(&scene, Settings::default())?;
    let create = |path: &Path| Recorder::create(path, &scene, world.as_ref(), 1).map(|_| ());
    assert!(matches!(create(folder.path()), Err(RecordError::Folder(_))));
    assert!(matches!(create(&folder.path().join("none/a.mcap")), Err(RecordError::Io { .. })));
    let first = Recorder::create(&path, &scene, world.as_ref(), 1)?;
    let second = create(&path);
    assert!(matches!(&second, Err(RecordError::PartExists(part)) if *part == part_of(&path)), "{second:?}");
    first.finish()?;
    // A recording that is there stays whole until the next is finished.
    let before = std::fs::read(&path)?;
    let next = Recorder::create(&path, &scene, world.as_ref(), 1)?;
    assert_eq!(std::fs::read(&path)?, before);
    drop(next);
    assert!(Recording::open(&path)?.loss().is_none());
    assert!(!part_of(&path).exists());
    Ok(())
}
