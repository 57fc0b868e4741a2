//! Runs that are acted upon: what was done is done again, to the bit, at every width; what cannot be is refused.

use lamina2d::event::{SceneEvent, When};
use lamina2d::force::Forces;
use lamina2d::joint::{JointKind, JointSpec};
use lamina2d::record::{RecordError, Recorder, Recording, Tape, save, verify};
use lamina2d::scene::{self, BodyKind, BodySpec, Scene, ShapeSpec};
use lamina2d::session::{Action, Event, Session};
use lamina2d::settings::{Integrator, Precision, Settings, Solver};

use crate::shared_motion::scatter;

type Outcome = Result<(), Box<dyn std::error::Error>>;

fn pull(slot: u32, target: [f64; 2]) -> Action {
    Action::Pull { slot, point_body: [0.05, -0.02], target }
}

/// Something of every kind, over two seconds: slots 1 to 5 are the walls of a mix.
fn script() -> Vec<Event> {
    let triangle = ShapeSpec::Polygon(vec![[-0.3, -0.2], [0.4, -0.2], [0.0, 0.5]]);
    let moon = Forces { gravity: Some([0.3, -1.62]), ..Forces::default() };
    let choose = |integrator, solver, substeps| Action::Choose { integrator, solver, substeps };
    let change = |slot, kind, mass| Action::Change { slot, kind, mass };
    [
        (0, Action::Insert(Box::new(BodySpec::new(ShapeSpec::Circle(0.3), [0.1, 6.0])))),
        (5, Action::Insert(Box::new(BodySpec::new(ShapeSpec::Box([0.4, 0.2]), [1.0, 6.0]).turned(0.7)))),
        (5, Action::Insert(Box::new(BodySpec::new(triangle, [-1.0, 7.0]).mass(3.0)))),
        (10, pull(20, [0.0, 5.0])),
        (14, pull(20, [0.4, 5.5])),
        (20, Action::Remove { slot: 12 }),
        (20, change(15, BodyKind::Static, None)),
        (30, choose(Integrator::Rk4, Solver::Pgs, 2)),
        (35, Action::LetGo),
        (40, Action::Fields(Box::new(moon))),
        (50, choose(Integrator::SemiImplicitEuler, Solver::Xpbd, 6)),
        (60, change(15, BodyKind::Dynamic, Some(2.5))),
        (70, choose(Integrator::VelocityVerlet, Solver::Soft, 4)),
        (80, Action::Insert(Box::new(BodySpec::new(ShapeSpec::Circle(0.2), [0.0, 4.0])))),
        (90, change(16, BodyKind::Kinematic, None)),
        (100, pull(17, [2.0, 3.0])),
        (101, Action::Remove { slot: 17 }),
    ]
    .map(|(step, action)| Event { step, action })
    .into()
}

fn live(scene: &Scene, settings: Settings, events: &[Event], steps: u64) -> Session {
    let mut session = Session::new(scene, settings).expect("a session");
    session.follow(events, steps).expect("all that is done can be");
    session
}

#[test]
fn what_was_done_is_done_again_at_every_width() -> Outcome {
    let folder = tempfile::tempdir()?;
    let path = folder.path().join("live.mcap");
    for (name, precision, sleep) in [
        ("all/60", Precision::F32, false),
        ("all/60", Precision::F32, true),
        ("polygons/60", Precision::F64, false),
        ("joint_grid/6", Precision::F32, false),
    ] {
        let scene = scene::by_name(name, None, 5)?;
        let settings = Settings { sleep, ..Settings::default().with_precision(precision) };
        let session = live(&scene, settings, &script(), 130);
        assert_eq!((session.events(), session.world().steps()), (script().as_slice(), 130));
        save(&path, &scene, settings, session.events(), 130, 1)?;
        let mut recording = Recording::open(&path)?;
        assert_eq!(recording.events(), script());
        assert_eq!(recording.rows().last().map(|row| row.hash), Some(session.world().hash()), "{name}");
        for &lanes in Settings::widths(precision) {
            let mut told = 0;
            assert_eq!(verify(&mut recording, Some(lanes), |_| told += 1)?, None, "{name} at {lanes} lanes");
            assert_eq!(told, 131);
        }
    }
    Ok(())
}

/// What a scene does to itself is done again with it, beside what is done by hand.
#[test]
fn events_of_the_scene_are_done_again_at_every_width() -> Outcome {
    let folder = tempfile::tempdir()?;
    let path = folder.path().join("events.mcap");
    let mut scene = scene::by_name("all/40", None, 5)?;
    scene.events = script()
        .into_iter()
        .filter(|event| event.step < 100)
        .map(|Event { step, action }| SceneEvent { at: When::Step(step + 3), action })
        .collect();
    let by_hand: Vec<_> = script().into_iter().filter(|event| event.step == 80).collect();
    for sleep in [false, true] {
        let settings = Settings { sleep, ..Settings::default() };
        save(&path, &scene, settings, &by_hand, 130, 1)?;
        let mut recording = Recording::open(&path)?;
        assert_eq!(recording.scene().events, scene.events);
        for &lanes in Settings::widths(Precision::F32) {
            assert_eq!(verify(&mut recording, Some(lanes), |_| ())?, None, "{lanes} lanes, sleep {sleep}");
        }
        let without = Scene { events: Vec::new(), ..scene.clone() };
        let plain = live(&without, settings, &by_hand, 130).world().hash();
        assert_ne!(recording.rows().last().map(|row| row.hash), Some(plain), "they do something");
    }
    Ok(())
}

/// A run that was not acted upon in the same way is another one, and the step is named.
#[test]
fn an_event_left_out_is_found() -> Outcome {
    let folder = tempfile::tempdir()?;
    let (with, without) = (folder.path().join("with.mcap"), folder.path().join("without.mcap"));
    let scene = scene::by_name("all/40", None, 5)?;
    let events = script();
    save(&with, &scene, Settings::default(), &events, 60, 1)?;
    let fewer: Vec<_> = events.into_iter().filter(|event| event.step != 10 && event.step != 14).collect();
    save(&without, &scene, Settings::default(), &fewer, 60, 1)?;
    let (mut a, mut b) = (Recording::open(&with)?, Recording::open(&without)?);
    let difference = lamina2d::record::first_difference(&mut a, &mut b)?.expect("a difference");
    assert_eq!((difference.step, difference.slot), (11, Some(20)));
    Ok(())
}

/// Frames on the tape are those of the recording.
#[test]
fn the_tape_holds_what_the_recording_does() -> Outcome {
    let folder = tempfile::tempdir()?;
    let path = folder.path().join("tape.mcap");
    let scene = scene::by_name("all/40", None, 5)?;
    let (settings, events) = (Settings::default(), script());
    save(&path, &scene, settings, &events, 90, 1)?;
    let mut recording = Recording::open(&path)?;
    let mut session = Session::new(&scene, settings)?;
    let (mut tape, mut short) = (Tape::new(usize::MAX), Tape::new(100_000));
    tape.record(session.world());
    for step in 1..=90 {
        session.follow(&events, step)?;
        tape.record(session.world());
        short.record(session.world());
    }
    assert_eq!(tape.kept(), 0..91);
    for (at, row) in tape.rows().iter().enumerate() {
        let recorded = recording.frame(at)?;
        assert_eq!(tape.frame(row.step).expect("kept"), recorded, "step {}", row.step);
        assert_eq!(*tape.bodies(row.step).expect("kept"), *recording.bodies(row.step)?, "step {}", row.step);
        assert_eq!(row.hash, recording.rows()[at].hash);
        // All but the times.
        assert_eq!(row.values[7..], recording.rows()[at].values[7..]);
    }
    let kept = short.kept();
    assert!(kept.start > 1 && kept.end == 91 && kept.contains(&90), "{kept:?}");
    assert_eq!((short.frame(kept.start - 1), short.frame(91)), (None, None));
    assert_eq!(short.frame(90), tape.frame(90));
    Ok(())
}

/// A step taken down again after something was done shows what was done.
#[test]
fn the_tape_shows_a_body_that_came_while_time_stood_still() -> Outcome {
    let scene = scene::by_name("stack/3", None, 1)?;
    let mut session = Session::new(&scene, Settings::default())?;
    let mut tape = Tape::new(usize::MAX);
    session.step()?;
    tape.record(session.world());
    let (before, ns) = (tape.frame(1).expect("kept"), tape.rows()[0].get("broad_ns"));
    let spec = BodySpec::new(ShapeSpec::Circle(0.5), [4.0, 4.0]);
    let slot = session.apply(Action::Insert(Box::new(spec)))?.expect("a slot");
    tape.record(session.world());
    let after = tape.frame(1).expect("kept");
    assert!(!before.frame.lives(slot as usize) && after.frame.lives(slot as usize));
    assert_eq!((tape.rows().len(), tape.rows()[0].get("broad_ns")), (1, ns));
    assert!(tape.bodies(1).expect("kept").bodies.iter().any(|body| body.slot == slot));
    Ok(())
}

#[test]
fn what_cannot_be_done_is_refused_and_changes_nothing() -> Outcome {
    let scene = scene::by_name("stack/30", None, 1)?;
    let mut session = Session::new(&scene, Settings::default())?;
    session.step()?;
    let before = session.world().hash();
    let attraction = Forces { attraction: Some(1.0), ..Forces::default() };
    let spec = BodySpec::new(ShapeSpec::Circle(-1.0), [0.0; 2]);
    let drag = Forces { linear_drag: Some(-1.0), ..Forces::default() };
    let choose = |substeps| Action::Choose { integrator: Integrator::Rk4, solver: Solver::Soft, substeps };
    let heavy = |mass| Action::Change { slot: 2, kind: BodyKind::Dynamic, mass: Some(mass) };
    for (action, said) in [
        (Action::Remove { slot: 0 }, "no body lives in slot 0"),
        (Action::Remove { slot: 99 }, "no body lives in slot 99"),
        (pull(u32::MAX, [0.0; 2]), "no body lives in slot 4294967295"),
        (pull(1, [0.0; 2]), "body in slot 1 is not dynamic"),
        (pull(2, [f64::NAN, 0.0]), "pull: target is not finite: NaN"),
        (Action::Insert(Box::new(spec)), "radius"),
        (Action::Fields(Box::new(drag)), "linear_drag"),
        (Action::Fields(Box::new(attraction)), "at most 15 bodies attract each other, got 31"),
        (choose(0), "substeps must be 1 to 1000, got 0"),
        (heavy(-1.0), "mass"),
        (heavy(f64::INFINITY), "mass"),
    ] {
        let why = session.apply(action).expect_err(said).to_string();
        assert!(why.contains(said), "{why}");
    }
    assert_eq!((session.world().hash(), session.events().len()), (before, 0));
    Ok(())
}

#[test]
fn a_recorded_event_that_cannot_be_is_named() -> Outcome {
    let folder = tempfile::tempdir()?;
    let path = folder.path().join("odd.mcap");
    let scene = scene::by_name("stack/3", None, 1)?;
    let mut session = Session::new(&scene, Settings::default())?;
    let mut recorder = Recorder::create(&path, &scene, session.world(), 1)?;
    recorder.event(&Event { step: 0, action: Action::Remove { slot: 7 } })?;
    session.step()?;
    recorder.record(session.world(), false)?;
    recorder.finish()?;
    let why = verify(&mut Recording::open(&path)?, None, |_| ()).expect_err("refused");
    assert!(matches!(why, RecordError::Run { .. }));
    assert!(why.to_string().contains("after step 0 cannot be: no body lives in slot 7"), "{why}");
    Ok(())
}

/// A run that was killed has the events of its whole chunks.
#[test]
fn events_are_read_from_a_file_that_was_not_finished() -> Outcome {
    let folder = tempfile::tempdir()?;
    let path = folder.path().join("cut.mcap");
    let scene = scene::by_name("all/400", None, 5)?;
    save(&path, &scene, Settings::default(), &script(), 130, 1)?;
    let whole = std::fs::read(&path)?;
    std::fs::write(&path, &whole[..whole.len() * 2 / 3])?;
    let mut recording = Recording::open(&path)?;
    let last = recording.rows().last().expect("some rows").step;
    assert!(recording.loss().is_some() && last < 130 && last > 20);
    let events = recording.events().to_vec();
    assert_eq!(events, script()[..events.len()]);
    let due = script().iter().filter(|event| event.step < last).count();
    assert!(events.len() >= due, "{} of {due} up to step {last}", events.len());
    assert_eq!(verify(&mut recording, Some(1), |_| ())?, None);
    Ok(())
}

#[test]
fn a_pulled_body_comes_to_its_target_and_no_faster_than_it_may() -> Outcome {
    let scene = scene::by_name("stack/1", None, 1)?;
    let mut session = Session::new(&scene, Settings::default())?;
    session.apply(Action::Pull { slot: 2, point_body: [0.0; 2], target: [0.0, 8.0] })?;
    for _ in 0..180 {
        session.step()?;
    }
    let at = session.world().body(2).expect("a body").state.position;
    // At rest each impulse gives back gh; with ω = 10π and ζ = 0.9 of the spring, and −gh/2 the speed at the end of
    // each step, it hangs lower by g(1/ω² + 2ζh/ω + h²) − (gh/2)(2ζ/ω + h).
    let (g, h, omega, zeta) = (9.81, 1.0 / 60.0, 10.0 * std::f64::consts::PI, 0.9);
    let bend = 2.0 * zeta / omega + h;
    let lower = g * (1.0 / (omega * omega) + h * bend) - 0.5 * g * h * bend;
    assert!((at[0]).abs() < 1e-5 && (at[1] - (8.0 - lower)).abs() < 1e-5, "{at:?}, {lower}");
    session.apply(pull(2, [1e6, 1e6]))?;
    for _ in 0..30 {
        session.step()?;
    }
    let speed = session.world().body(2).expect("a body").state.velocity;
    // Half a second at 1000 m/s², and half a second of gravity.
    let speed = speed[0].hypot(speed[1]);
    assert!((480.0..506.0).contains(&speed), "{speed}");
    Ok(())
}

/// A body that is made static stops where it is, one that is made dynamic falls with the mass it is given.
#[test]
fn kinds_change_and_change_back() -> Outcome {
    let scene = scene::by_name("stack/3", None, 1)?;
    for sleep in [false, true] {
        let mut session = Session::new(&scene, Settings { sleep, ..Settings::default() })?;
        let run = |session: &mut Session, steps: u64| {
            (0..steps).try_for_each(|_| session.step()).map(|()| session.world().states())
        };
        run(&mut session, 90)?;
        session.apply(Action::Change { slot: 3, kind: BodyKind::Static, mass: None })?;
        session.apply(Action::Remove { slot: 2 })?;
        let fixed = session.world().body(3).expect("a body");
        assert_eq!((fixed.inv_mass, fixed.inv_inertia, fixed.state.velocity), (0.0, 0.0, [0.0; 2]));
        run(&mut session, 60)?;
        assert_eq!(session.world().body(3).expect("a body").state, fixed.state, "held in the air");
        let above = session.world().body(4).expect("a body").state.position;
        assert!(above[1] > fixed.state.position[1] + 0.5, "what stands on it stays there");
        session.apply(Action::Change { slot: 3, kind: BodyKind::Dynamic, mass: Some(4.0) })?;
        assert_eq!(session.world().body(3).expect("a body").inv_mass, 0.25);
        run(&mut session, 120)?;
        let fallen = session.world().body(3).expect("a body").state.position;
        assert!(fallen[1] < fixed.state.position[1] - 0.5, "sleep {sleep}: {fallen:?}");
    }
    Ok(())
}

/// A joint between bodies that cannot move holds nothing, and holds again when one can.
#[test]
fn a_joint_of_two_static_bodies_waits() -> Outcome {
    let point = [1.0, 5.0];
    for (kind, middle) in
        [(JointKind::hinge(point), 1.0), (JointKind::rod(), 0.0), (JointKind::weld(point), 1.0)]
    {
        let disc = |x| BodySpec::new(ShapeSpec::Circle(0.2), [x, 5.0]);
        let scene = Scene {
            bodies: vec![disc(0.0).fixed(), disc(2.0)],
            joints: vec![JointSpec::new(0, 1, kind)],
            ..scene::by_name("stack/1", None, 1)?
        };
        let mut session = Session::new(&scene, Settings::default())?;
        let run = |session: &mut Session| (0..30).try_for_each(|_| session.step());
        session.apply(Action::Change { slot: 2, kind: BodyKind::Static, mass: None })?;
        run(&mut session)?;
        assert_eq!(session.world().body(2).expect("a body").state.position, [2.0, 5.0]);
        session.apply(Action::Change { slot: 2, kind: BodyKind::Dynamic, mass: None })?;
        run(&mut session)?;
        let at = session.world().body(2).expect("a body").state.position;
        let apart = (at[0] - middle).hypot(at[1] - 5.0);
        assert!((apart - (2.0 - middle)).abs() < 0.02, "{at:?}");
    }
    Ok(())
}

/// Random deeds on random bodies: nothing panics, nothing that was refused is kept, and all of it can be done again.
#[test]
fn random_deeds_are_done_again() -> Outcome {
    let scene = scene::by_name("all/30", None, 2)?;
    for salt in 0..6 {
        let mut session = Session::new(&scene, Settings { lanes: 8, ..Settings::default() })?;
        for k in 0..240 {
            let r = |j: usize| scatter(10 * k + j, salt + 100);
            let slot = (r(1) * 45.0) as u32;
            let place = [6.0 * r(2) - 3.0, 8.0 * r(3)];
            let kind = [BodyKind::Static, BodyKind::Kinematic, BodyKind::Dynamic][(r(4) * 3.0) as usize];
            let size = 0.1 + 0.4 * r(5);
            let shape = if r(6) < 0.5 { ShapeSpec::Circle(size) } else { ShapeSpec::Box([size, 0.2]) };
            let action = match (r(7) * 6.0) as usize {
                0 => Action::Insert(Box::new(BodySpec::new(shape, place))),
                1 => Action::Remove { slot },
                2 => Action::Change { slot, kind, mass: None },
                3 => pull(slot, place),
                4 => Action::LetGo,
                _ => Action::Choose {
                    integrator: Integrator::ALL[(r(8) * 6.0) as usize],
                    solver: Solver::ALL[(r(9) * 5.0) as usize],
                    substeps: 1 + (r(4) * 6.0) as u32,
                },
            };
            let _ = session.apply(action);
            session.step()?;
        }
        assert!(session.events().len() > 100);
        let again = live(&scene, Settings { lanes: 4, ..Settings::default() }, session.events(), 240);
        assert_eq!(again.world().hash(), session.world().hash(), "salt {salt}");
    }
    Ok(())
}
