//! Islands wake when they are touched, and alone, and push as before.

use lamina2d::body::Bodies;
use lamina2d::contact::{Contact, Manifolds};
use lamina2d::force::Forces;
use lamina2d::internals::{Islands, Pull};
use lamina2d::joint::{Distance, JointKind, JointSpec};
use lamina2d::lanes::f32s;
use lamina2d::scene::{BodySpec, ShapeSpec};
use lamina2d::settings::{Settings, Skip, Solver};
use lamina2d::world::World;

use crate::shared_sleep::{
    DT_SECS, drowsy, id, max_speed, named, on_floor, pose, put_to_sleep, step, unit_box, world_of,
};

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

/// A body that is driven by a force set anew in each step moves by it; what stands beside it keeps its manifolds and its bits.
#[test]
fn a_force_in_each_step_leaves_what_it_does_not_act_on() {
    let settings = Settings::default();
    let mut scene = named("pyramid/5");
    scene
        .bodies
        .push(BodySpec::new(ShapeSpec::Circle(0.5), [500.0, 100.0]).mass(2.0).moving([0.0, 9.81], 0.0));
    let mut world = world_of::<f32s::X8>(&scene, settings);
    step(&mut world, 600);
    let (slots, ball) = (world.bodies().len() - 1, id(&world, world.bodies().len() - 1));
    let stands: Vec<_> = (1..slots).map(|slot| pose(&world, slot).map(f64::from_bits)).collect();
    let fallen = world.bodies().vy[slots];
    world.set_force(ball, [1.0, 0.0], 0.0).expect("lives");
    step(&mut world, 1);
    let mut speed = 0.5 * DT_SECS;
    for k in 0..60 {
        let force = 1.0 + f64::from(k % 7);
        world.set_force(ball, [force, 2.0 * 9.81], 0.0).expect("lives");
        step(&mut world, 1);
        speed += force / 2.0 * DT_SECS;
        let counts = world.counts();
        assert_eq!(counts.skipped[Skip::ManifoldReuse as usize], counts.pairs as u64, "step {k}");
    }
    let bodies = world.bodies();
    assert!(
        (f64::from(bodies.vx[slots]) - speed).abs() < 1e-5 * speed,
        "{} m/s, not {speed}",
        bodies.vx[slots]
    );
    let falls = f64::from(bodies.vy[slots] - fallen);
    assert!((falls + 9.81 * DT_SECS).abs() < 1e-4, "held against gravity in all steps but one: {falls} m/s");
    for (slot, stood) in (1..slots).zip(&stands) {
        let now = pose(&world, slot).map(f64::from_bits);
        let moved = now.iter().zip(stood).map(|(now, then)| (now - then).abs()).fold(0.0, f64::max);
        assert!(moved < 1e-5, "slot {slot} moved by {moved}");
    }
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
            islands.accumulate_quiet_time::<f32s::X8>(
                bodies,
                runs,
                Pull { gravity: 0.0, spring: 0.0 },
                DT_SECS,
            );
        }
        islands.fall_asleep(bodies, &none_touch, runs, false, 0.0);
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
        // A pendulum of 3 m swings in 3.5 s: for so long they have to be quiet.
        put_to_sleep(world, 400);
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
