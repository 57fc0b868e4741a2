//! Islands fall asleep when they are at rest and not before, and keep every bit while they sleep; no lane width sees
//! another night than the others.

use lamina2d::force::{Forces, Spring};
use lamina2d::lanes::{Lanes, f32s, f64s};
use lamina2d::scene::{BodyKind, BodySpec, Scene, ShapeSpec};
use lamina2d::settings::{Broad, Settings, Skips, Solver};
use lamina2d::vec2::Rot;
use lamina2d::world::World;

use crate::shared_motion::scene_of;
use crate::shared_sleep::{
    drowsy, id, max_speed, movable, named, on_floor, pose, put_to_sleep, step, unit_box, world_of,
};

#[test]
fn piles_fall_asleep_and_keep_every_bit() {
    for name in ["pyramid/10", "polygons/150"] {
        let mut world = world_of::<f32s::X8>(&named(name), drowsy());
        put_to_sleep(&mut world, 900);
        println!("{name}: asleep after {} steps, {} islands", world.steps(), world.islands().len());
        let (hash, steps) = (world.hash(), world.steps());
        let poses: Vec<_> = world.bodies().slots().map(|slot| pose(&world, slot)).collect();
        let contacts = world.contacts();
        assert_eq!(max_speed(&world), 0.0, "{name}");
        step(&mut world, 600);
        let after: Vec<_> = world.bodies().slots().map(|slot| pose(&world, slot)).collect();
        assert_eq!((poses, hash, contacts), (after, world.hash(), world.contacts()), "{name}");
        assert_eq!(world.steps(), steps + 600, "steps count on");
        assert_eq!(world.counts().sleeping, movable(&world), "{name}");
    }
}

#[test]
fn a_pyramid_of_twenty_falls_asleep() {
    put_to_sleep(&mut world_of::<f32s::X8>(&named("pyramid/20"), drowsy()), 600);
}

#[test]
fn with_other_settings_stacks_sleep_too() {
    for settings in [
        Settings { skips: Skips::NONE, ..drowsy() },
        Settings { skips: Skips::EXACT, ..drowsy() },
        Settings { broad: Broad::Off, ..drowsy() },
        Settings { substeps: 1, ..drowsy() },
    ] {
        let mut world = world_of::<f32s::X8>(&named("stack/5"), settings);
        put_to_sleep(&mut world, 600);
        let before = pose(&world, 6);
        // One box beside it, awake: the stack's block is gone over and nothing in it moves.
        world.insert(&unit_box(5.0, 8.0)).expect("a good body");
        step(&mut world, 30);
        assert_eq!((world.sleeping(), pose(&world, 6)), (5, before), "{settings:?}");
    }
}

#[test]
fn before_anything_sleeps_no_bit_differs() {
    let scene = named("polygons/40");
    let mut off = world_of::<f32s::X8>(&scene, Settings::default());
    let mut on = world_of::<f32s::X8>(&scene, drowsy());
    while on.sleeping() == 0 && on.steps() < 600 {
        assert_eq!(on.hash(), off.hash(), "step {}", on.steps());
        step(&mut on, 1);
        step(&mut off, 1);
    }
    assert!(on.counts().contacts > 0 && on.sleeping() > 0, "the scene tests contacts up to a first sleeper");
}

#[test]
fn a_tumbler_never_lets_its_content_sleep() {
    let mut world = world_of::<f32s::X8>(&named("tumbler/40"), drowsy());
    for _ in 0..600 {
        step(&mut world, 1);
        assert_eq!(world.sleeping(), 0, "step {}", world.steps());
    }
}

#[test]
fn a_kinematic_body_that_arrives_wakes_and_one_that_stands_carries_sleepers() {
    let bar = |velocity| BodySpec {
        kind: BodyKind::Kinematic,
        ..BodySpec::new(ShapeSpec::Box([0.5; 2]), [-4.0, 0.6]).moving(velocity, 0.0)
    };
    let shelf =
        BodySpec { kind: BodyKind::Kinematic, ..BodySpec::new(ShapeSpec::Box([2.0, 0.5]), [10.0, 3.0]) };
    let mut world = world_of::<f32s::X8>(
        &on_floor([bar([1.0, 0.0]), unit_box(0.0, 0.5), shelf, unit_box(10.0, 4.0)]),
        drowsy(),
    );
    step(&mut world, 120);
    assert_eq!(world.sleeping(), 2, "neither is touched yet by what moves");
    step(&mut world, 120);
    assert_eq!(world.sleeping(), 1, "the bar pushes the box, the shelf stands");
    assert!(world.bodies().x[3] > 0.5, "pushed to {}", world.bodies().x[3]);
    // The bar stops, then the shelf starts.
    world.bodies_mut().vx[2] = 0.0;
    step(&mut world, 240);
    assert_eq!(world.sleeping(), 2);
    world.bodies_mut().vx[4] = 0.2;
    let mut slept = 0;
    for _ in 0..120 {
        step(&mut world, 1);
        slept += usize::from(world.is_asleep(id(&world, 5)));
    }
    assert_eq!(slept, 0, "what a moving shelf carries does not sleep");
}

#[test]
fn what_moves_slowly_does_not_sleep() {
    // Down a slope a little steeper than friction holds, from 2 cm/s on.
    let angle = (0.6f64 + 0.001).atan();
    let rot = Rot::<f64>::from_angle(-angle);
    let slope =
        BodySpec::new(ShapeSpec::Box([30.0, 0.5]), [0.0, 0.0]).turned(-angle).surface(0.0, 0.6).fixed();
    let place = [-rot.s, rot.c];
    let sliding = BodySpec::new(ShapeSpec::Box([0.5; 2]), place).turned(-angle).surface(0.0, 0.6);
    let sliding = sliding.moving([0.02 * rot.c, 0.02 * rot.s], 0.0);
    let slide = scene_of(vec![slope, sliding], Forces::gravity());
    // Along a floor at a centimetre a second.
    let ball = BodySpec::new(ShapeSpec::Circle(0.5), [0.0, 0.5]).surface(0.0, 0.6);
    let roll = on_floor([ball.moving([0.01, 0.0], -0.02)]);
    for (name, scene) in [("slide", slide), ("roll", roll)] {
        let mut world = world_of::<f32s::X8>(&scene, drowsy());
        let start = world.bodies().x[2];
        for _ in 0..600 {
            step(&mut world, 1);
            assert_eq!(world.sleeping(), 0, "{name}: step {} at {} m/s", world.steps(), max_speed(&world));
        }
        assert!(world.bodies().x[2] - start > 0.05, "{name}: moved on");
    }
}

#[test]
fn what_rests_on_nothing_sleeps_only_where_nothing_pulls() {
    let body =
        |velocity: [f64; 2]| scene_of(vec![unit_box(1.0, 0.0).moving(velocity, 0.0)], Forces::default());
    let asleep = |scene: &Scene, forces: Forces| {
        let mut world = world_of::<f32s::X8>(&Scene { forces, ..scene.clone() }, drowsy());
        (0..120).any(|_| {
            step(&mut world, 1);
            world.sleeping() > 0
        })
    };
    let none = Forces::default();
    let spring = Forces { spring: Some(Spring { anchor: [0.0; 2], stiffness: 1e-3 }), ..none };
    let weak = Forces { gravity: Some([0.0, -1e-4]), ..none };
    assert!(asleep(&body([0.0; 2]), none), "at rest for good");
    assert!(!asleep(&body([1e-4, 0.0]), none), "drifting");
    assert!(!asleep(&body([0.0; 2]), spring), "at an oscillation's turning point");
    assert!(!asleep(&body([0.0, 1e-4]), weak), "at its apex");
}

#[test]
fn nothing_is_allocated_while_all_or_some_sleep() {
    let mut world = world_of::<f32s::X8>(&named("pyramids/2"), drowsy());
    put_to_sleep(&mut world, 600);
    let asleep = allocation_counter::measure(|| step(&mut world, 60)).count_total;
    world.apply_impulse(id(&world, 20), [0.0, 1e-4], 0.0).expect("dynamic");
    step(&mut world, 2);
    let half = allocation_counter::measure(|| step(&mut world, 20)).count_total;
    assert_eq!(world.sleeping(), 55);
    put_to_sleep(&mut world, 600);
    world.wake(id(&world, 20)).expect("lives");
    let again = allocation_counter::measure(|| step(&mut world, 160)).count_total;
    assert_eq!(world.sleeping(), 110, "woke and fell asleep again meanwhile");
    assert_eq!([asleep, half, again], [0; 3]);
}

/// Two pyramids fall asleep, a ball lands on the second, a box of the first is taken away: hashes on the way.
fn night<L: Lanes>() -> Vec<u64> {
    night_with::<L>(drowsy())
}

fn night_with<L: Lanes>(settings: Settings) -> Vec<u64> {
    let mut world = world_of::<L>(&named("pyramids/2"), settings);
    let mut hashes = Vec::new();
    let mut watch = |world: &mut World<L>, steps: usize| {
        for _ in 0..steps {
            step(world, 1);
            hashes.extend([world.hash(), world.sleeping() as u64]);
        }
    };
    watch(&mut world, 250);
    assert_eq!(world.sleeping(), 110, "asleep at every width");
    world.insert(&BodySpec::new(ShapeSpec::Circle(0.4), [16.2, 12.0])).expect("a good body");
    watch(&mut world, 60);
    assert_eq!(world.sleeping(), 55, "the ball has landed");
    world.remove(id(&world, 3)).expect("lives");
    watch(&mut world, 120);
    hashes
}

#[test]
fn the_night_is_the_same_at_every_lane_width() {
    let narrow = night::<f32s::X1>();
    assert_eq!(narrow, night::<f32s::X4>());
    assert_eq!(narrow, night::<f32s::X8>());
    assert_eq!(narrow, night::<f32s::X16>());
    assert_eq!(night::<f64s::X1>(), night::<f64s::X4>());
}

#[test]
fn no_broad_phase_moves_a_bit_of_the_night() {
    let brute = night_with::<f32s::X8>(Settings { broad: Broad::Brute, ..drowsy() });
    for broad in [Broad::Sweep, Broad::Grid] {
        let other = night_with::<f32s::X8>(Settings { broad, ..drowsy() });
        let step = brute.iter().zip(&other).position(|(a, b)| a != b);
        assert_eq!(step, None, "{broad}: half steps until hashes or sleepers differ");
    }
}

/// A mix falls, settles and is shot at, under any solver: hashes, sleepers and what moved though it slept.
fn shot_at<L: Lanes>(solver: Solver) -> (Vec<u64>, usize) {
    let mut world = world_of::<L>(&named("polygons/60"), Settings { solver, ..drowsy() });
    let (mut hashes, mut most) = (Vec::new(), 0);
    for k in 0..1500 {
        if k % 500 == 499 {
            let bullet = BodySpec::new(ShapeSpec::Circle(0.2), [-20.0, 3.0]).moving([45.0, 0.0], 0.0);
            world.insert(&bullet).expect("a good body");
        }
        let asleep: Vec<_> = world.bodies().slots().filter(|&slot| world.islands().is_asleep(slot)).collect();
        let before: Vec<_> = asleep.iter().map(|&slot| pose(&world, slot)).collect();
        step(&mut world, 1);
        for (&slot, before) in asleep.iter().zip(before) {
            let sleeps = world.islands().is_asleep(slot);
            assert!(!sleeps || pose(&world, slot) == before, "{solver}: {slot} moved in its sleep, step {k}");
        }
        most = most.max(world.sleeping());
        hashes.push(world.hash());
    }
    (hashes, most)
}

#[test]
fn sleep_is_safe_under_every_solver_and_the_same_at_every_width() {
    for &solver in Solver::ALL {
        let (narrow, most) = shot_at::<f32s::X1>(solver);
        println!("{solver}: {most} asleep at most");
        // Under the others what rests trembles.
        assert!(most > 0 || solver != Solver::Soft, "{solver}: nobody sleeps");
        assert_eq!(shot_at::<f32s::X8>(solver).0, narrow, "{solver}");
        assert_eq!(shot_at::<f32s::X16>(solver).0, narrow, "{solver}");
    }
}
