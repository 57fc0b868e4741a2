//! Islands fall asleep when they are at rest and not before, keep every bit while they sleep, wake when they are
//! touched, and no lane width sees another night than the others.

mod common_motion;

use common_motion::scene_of;
use lamina2d::body::{Bodies, BodyId};
use lamina2d::contact::{Contact, Manifolds};
use lamina2d::force::{Forces, Spring};
use lamina2d::island::Islands;
use lamina2d::joint::{Distance, JointKind, JointSpec};
use lamina2d::lanes::{Lanes, Real, f32s, f64s};
use lamina2d::scene::{BodyKind, BodySpec, Scene, ShapeSpec, by_name};
use lamina2d::settings::{Broad, Settings, Skips, Solver};
use lamina2d::vec2::Rot;
use lamina2d::world::World;

const DT_SECS: f64 = 1.0 / 60.0;

fn drowsy() -> Settings {
    Settings { sleep: true, ..Settings::default() }
}

fn named(name: &str) -> Scene {
    by_name(name, None, 1).expect("a named scene")
}

fn world_of<L: Lanes>(scene: &Scene, settings: Settings) -> World<L> {
    World::from_scene(scene, settings).expect("the scene is good")
}

fn step<L: Lanes>(world: &mut World<L>, steps: usize) {
    for _ in 0..steps {
        world.step(DT_SECS).expect("stays finite");
    }
}

fn movable<L: Lanes>(world: &World<L>) -> usize {
    let bodies = world.bodies();
    bodies.slots().filter(|&slot| bodies.kind(slot) == BodyKind::Dynamic).count()
}

/// Steps until all that can move sleeps.
fn put_to_sleep<L: Lanes>(world: &mut World<L>, within: usize) {
    for _ in 0..within {
        if world.sleeping() == movable(world) {
            return;
        }
        step(world, 1);
    }
    let (sleeping, all) = (world.sleeping(), movable(world));
    panic!(
        "{sleeping} of {all} asleep after {within} steps, {:e} m/s: {:?}",
        max_speed(world),
        world.settings()
    );
}

fn id<L: Lanes>(world: &World<L>, slot: usize) -> BodyId {
    world.bodies().id(slot).expect("lives")
}

/// The pose columns of a body, to the bit.
fn pose<L: Lanes>(world: &World<L>, slot: usize) -> [u64; 4] {
    let bodies = world.bodies();
    [&bodies.x, &bodies.y, &bodies.c, &bodies.s].map(|column| column[slot].to_f64().to_bits())
}

fn max_speed<L: Lanes>(world: &World<L>) -> f64 {
    let bodies = world.bodies();
    let speed = |slot: usize| bodies.vx[slot].to_f64().hypot(bodies.vy[slot].to_f64());
    bodies.slots().map(speed).fold(0.0, f64::max)
}

fn unit_box(x: f64, y: f64) -> BodySpec {
    BodySpec::new(ShapeSpec::Box([0.5; 2]), [x, y]).surface(0.0, 0.6)
}

fn floor() -> BodySpec {
    BodySpec::new(ShapeSpec::Box([30.0, 0.5]), [0.0, -0.5]).surface(0.0, 0.6).fixed()
}

/// A floor and on it these bodies, under gravity.
fn on_floor(bodies: impl IntoIterator<Item = BodySpec>) -> Scene {
    scene_of(std::iter::once(floor()).chain(bodies).collect(), Forces::gravity())
}

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
    let scene = named("all/40");
    let mut off = world_of::<f32s::X8>(&scene, Settings::default());
    let mut on = world_of::<f32s::X8>(&scene, drowsy());
    while on.sleeping() == 0 && on.steps() < 300 {
        assert_eq!(on.hash(), off.hash(), "step {}", on.steps());
        step(&mut on, 1);
        step(&mut off, 1);
    }
    assert!(on.counts().contacts > 0 && on.sleeping() > 0, "the scene tests contacts up to a first sleeper");
}

#[test]
fn a_box_dropped_on_a_sleeping_pyramid_wakes_it_when_it_lands() {
    let mut world = world_of::<f32s::X8>(&named("pyramid/10"), drowsy());
    put_to_sleep(&mut world, 600);
    let boxes = world.sleeping();
    // Not a ball: one that rolls off the pyramid rolls on for ever.
    let dropped = BodySpec::new(ShapeSpec::Box([0.5, 0.5]), [0.3, 14.0]).mass(2.0);
    let dropped = world.insert(&dropped).expect("a good body");
    step(&mut world, 20);
    assert_eq!(world.sleeping(), boxes, "the box still falls");
    assert!(!world.is_asleep(dropped));
    let mut landed = false;
    for _ in 0..60 {
        step(&mut world, 1);
        landed |= world.sleeping() == 0;
    }
    assert!(landed, "the box woke nobody");
    put_to_sleep(&mut world, 1200);
}

#[test]
fn what_rested_on_a_removed_box_wakes_and_falls() {
    let mut world = world_of::<f32s::X8>(&named("pyramids/2"), drowsy());
    put_to_sleep(&mut world, 600);
    // Slot 1 is the floor, 2 to 11 the first pyramid's lowest row.
    let (top, other) = (12, 2 + 55);
    let (before, far) = (world.bodies().y[top], pose(&world, other));
    for slot in [2, 3] {
        world.remove(id(&world, slot)).expect("lives");
    }
    assert_eq!(world.sleeping(), 55, "the other pyramid sleeps on");
    step(&mut world, 40);
    assert!(world.bodies().y[top] < before - 0.5, "what rested on it falls");
    assert_eq!(pose(&world, other), far);
    // The floor carries the other one: it is known to rest on it though all pairs are new.
    world.remove(id(&world, 1)).expect("lives");
    step(&mut world, 30);
    assert_eq!(world.sleeping(), 0);
    assert!(world.bodies().y[other] < 0.0, "without a floor all falls");
}

#[test]
fn what_is_done_to_a_body_wakes_its_island_alone() {
    let mut world = world_of::<f32s::X8>(&named("pyramids/2"), drowsy());
    put_to_sleep(&mut world, 600);
    assert_eq!(world.counts().islands, 2);
    let (a, b) = (id(&world, 20), id(&world, 80));
    world.apply_impulse(a, [0.0, 1e-4], 0.0).expect("dynamic");
    assert_eq!((world.is_asleep(a), world.is_asleep(b), world.sleeping()), (false, true, 55));
    step(&mut world, 1);
    assert_eq!((world.counts().sleeping, world.counts().islands), (55, 1));
    put_to_sleep(&mut world, 600);
    world.set_force(b, [0.0; 2], 0.0).expect("lives");
    assert!(world.is_asleep(b), "no force as before");
    step(&mut world, 1);
    assert!(world.is_asleep(b), "a change of none is none");
    world.set_force(b, [0.1, 0.0], 0.0).expect("lives");
    assert_eq!((world.is_asleep(a), world.is_asleep(b)), (true, false));
    put_to_sleep(&mut world, 600);
    world.wake(a).expect("lives");
    assert_eq!((world.is_asleep(a), world.is_asleep(b)), (false, true));
    put_to_sleep(&mut world, 600);
    let _ = world.bodies_mut();
    assert_eq!(world.sleeping(), 0, "whatever was done there wakes all");
    put_to_sleep(&mut world, 600);
    world.set_forces(Forces { gravity: Some([0.0, -5.0]), ..Forces::default() }).expect("good fields");
    assert_eq!(world.sleeping(), 0, "other fields wake all");
    step(&mut world, 1);
    assert!(max_speed(&world) > 0.0, "the pyramids spring back a little under less weight");
}

#[test]
fn a_stack_that_wakes_stands() {
    let mut world = world_of::<f32s::X8>(&named("pyramid/10"), drowsy());
    put_to_sleep(&mut world, 600);
    world.apply_impulse(id(&world, 30), [1e-3, 0.0], 0.0).expect("dynamic");
    assert_eq!(world.sleeping(), 0, "one island");
    let mut fastest: f64 = 0.0;
    for _ in 0..60 {
        step(&mut world, 1);
        fastest = fastest.max(max_speed(&world));
    }
    println!("fastest after waking: {fastest:e} m/s");
    assert!(fastest < 1e-2, "{fastest}");
    put_to_sleep(&mut world, 120);
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
    let mut world = world_of::<L>(&named("all/60"), Settings { solver, ..drowsy() });
    let (mut hashes, mut most) = (Vec::new(), 0);
    for k in 0..900 {
        if k % 300 == 299 {
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
        assert!(most > 0 || matches!(solver, Solver::Pgs | Solver::Impulse), "{solver}: nobody sleeps");
        assert_eq!(shot_at::<f32s::X8>(solver).0, narrow, "{solver}");
        assert_eq!(shot_at::<f32s::X16>(solver).0, narrow, "{solver}");
    }
}

#[test]
fn a_bullet_wakes_the_stack_it_hits_and_a_wall_keeps_it_from_the_next() {
    let stack = |x: f64| (0..5).map(move |k| unit_box(x, 0.5 + f64::from(k)));
    let wall = BodySpec::new(ShapeSpec::Box([0.05, 4.0]), [4.0, 4.0]).fixed();
    let scene = on_floor(stack(0.0).chain(stack(6.0)).chain([wall]));
    let mut world = world_of::<f32s::X8>(&scene, drowsy());
    put_to_sleep(&mut world, 600);
    // Two thirds of a box a step at the first stack; through the wall in a third of a step if nothing stopped it.
    let shots = [([-8.0, 2.4], [40.0, 0.0]), ([3.0, 6.5], [200.0, 0.0])];
    let [_, second] = shots.map(|(place, velocity)| {
        let shot = BodySpec::new(ShapeSpec::Circle(0.2), place).mass(0.5).moving(velocity, 0.0);
        world.insert(&shot).expect("a good body")
    });
    let mut woke = None;
    for k in 0..60 {
        step(&mut world, 1);
        woke = woke.or((!world.is_asleep(id(&world, 4))).then_some(k));
        assert!(world.bodies().x[second.slot()] < 4.0, "step {k}: through the wall");
        assert!(world.is_asleep(id(&world, 9)), "step {k}: the stack behind the wall woke");
    }
    let woke = woke.expect("the stack was hit");
    assert!((9..=13).contains(&woke), "7.3 m at 2/3 m a step, not {woke} steps");
    let pushed = world.bodies().x[4];
    assert!(pushed > 0.05, "the box that was hit is at {pushed} m");
}

#[test]
fn contacts_push_as_before_when_they_wake() {
    let settled = |scene, solver| {
        let mut world = world_of::<f32s::X8>(&named(scene), Settings { solver, ..drowsy() });
        put_to_sleep(&mut world, 1200);
        world
    };
    let load = |contacts: &[Contact]| -> Vec<f64> {
        contacts.iter().map(|contact| contact.points.iter().map(|point| point.impulse).sum()).collect()
    };
    let mut world = settled("pyramid/10", Solver::Soft);
    let before = load(&world.contacts());
    // Not a multiple of the steps for which a warm start is carried.
    step(&mut world, 7);
    world.wake(id(&world, 20)).expect("lives");
    assert_eq!(load(&world.contacts()), before, "to wake is not to push");
    for _ in 0..20 {
        step(&mut world, 1);
        let after = load(&world.contacts());
        assert_eq!(after.len(), before.len());
        let largest = before.iter().copied().fold(0.0, f64::max);
        let most = before.iter().zip(&after).map(|(a, b)| (a - b).abs() / largest).fold(0.0, f64::max);
        assert!(most < 0.02, "a contact's impulse is another by {most} of the largest");
    }
    // A solver that carries nothing stands, too.
    let mut world = settled("stack/5", Solver::Xpbd);
    let top = world.bodies().y[6];
    world.wake(id(&world, 2)).expect("lives");
    step(&mut world, 30);
    let moved = world.bodies().y[6] - top;
    assert!(moved.abs() < 1e-3, "the top moved by {moved} m");
}

#[test]
fn links_make_one_island_and_wake_both_ends_when_they_go() {
    let mut bodies = Bodies::<f32>::new();
    for x in [0.0, 3.0, 6.0] {
        bodies.insert(&unit_box(x, 0.0)).expect("a good body");
    }
    let (mut islands, none_touch) = (Islands::default(), Manifolds::default());
    let rest = |islands: &mut Islands<f32>, bodies: &mut Bodies<f32>| {
        let everywhere = 0..bodies.len();
        let runs = std::slice::from_ref(&everywhere);
        for _ in 0..31 {
            islands.tire::<f32s::X8>(bodies, runs, DT_SECS, 0.0);
        }
        islands.settle(bodies, &none_touch, runs, false);
        [1, 2, 3].map(|slot| islands.is_asleep(slot))
    };
    islands.look_over(&bodies, [[1, 2]]);
    bodies.vx[2] = 1.0;
    assert_eq!(rest(&mut islands, &mut bodies), [false, false, true], "its other end moves");
    bodies.vx[2] = 0.0;
    assert_eq!(rest(&mut islands, &mut bodies), [true; 3]);
    assert_eq!(islands.len(), 2);
    islands.wake(2);
    assert_eq!([1, 2, 3].map(|slot| islands.is_asleep(slot)), [false, false, true]);
    assert_eq!(rest(&mut islands, &mut bodies), [true; 3]);
    islands.look_over(&bodies, [[1, 2], [2, 3]]);
    assert_eq!(islands.sleeping(), 0, "a link between two islands wakes both");
    assert_eq!(rest(&mut islands, &mut bodies), [true; 3]);
    assert_eq!(islands.len(), 1);
    islands.look_over(&bodies, [[2, 3]]);
    assert_eq!(islands.sleeping(), 0, "a link that goes wakes its ends");
}

/// Two boxes on a rod, 3 m apart on the floor, and two others without: a push on one wakes what hangs on it.
#[test]
fn what_joints_hold_together_sleeps_and_wakes_together() {
    let mut scene =
        on_floor([unit_box(-6.0, 0.5), unit_box(-3.0, 0.5), unit_box(3.0, 0.5), unit_box(6.0, 0.5)]);
    scene.joints = vec![JointSpec::new(1, 2, JointKind::Distance(Distance::default()))];
    let night = |world: &mut World<f32s::X8>| {
        put_to_sleep(world, 300);
        assert_eq!(world.islands().len(), 3, "the rod makes one island of two");
        let poses: Vec<_> = (2..=5).map(|slot| pose(world, slot)).collect();
        step(world, 60);
        assert_eq!(poses, (2..=5).map(|slot| pose(world, slot)).collect::<Vec<_>>());
        // 4 m/s for a box of 1 kg, to the left, which the rod passes on.
        world.apply_impulse(id(world, 2), [-4.0, 0.0], 0.0).unwrap();
        step(world, 1);
        let awake: Vec<_> = (2..=5).map(|slot| !world.is_asleep(id(world, slot))).collect();
        assert_eq!(awake, [true, true, false, false]);
        assert!(world.bodies().vx[3] < -0.1, "the rod pulls");
        put_to_sleep(world, 600);
        let (a, b) = (world.bodies().x[2], world.bodies().x[3]);
        assert!((b - a - 3.0).abs() < 1e-3, "{} m apart", b - a);
        world.hash()
    };
    let mut world = world_of::<f32s::X8>(&scene, drowsy());
    night(&mut world);
    // Without the rod each sleeps for itself again; taking it out wakes both ends.
    let joint = world.joints().ids().next().unwrap();
    world.remove_joint(joint).unwrap();
    step(&mut world, 1);
    assert!(!world.is_asleep(id(&world, 2)) && !world.is_asleep(id(&world, 3)));
    put_to_sleep(&mut world, 300);
    assert_eq!(world.islands().len(), 4);
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
    let again = allocation_counter::measure(|| step(&mut world, 60)).count_total;
    assert_eq!(world.sleeping(), 110, "woke and fell asleep again meanwhile");
    assert_eq!([asleep, half, again], [0; 3]);
}
