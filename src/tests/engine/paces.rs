//! Substeps per island: a bound on the sag is kept, what needs few gets few, what touches nothing keeps its bits,
//! and no lane width sees other numbers than the others.

use lamina2d::force::Forces;
use lamina2d::joint::{Distance, JointKind, JointSpec};
use lamina2d::lanes::f32s::X8;
use lamina2d::scene::{BodyKind, BodySpec, Scene, ShapeSpec, by_name, stacks};
use lamina2d::settings::{Precision, Settings};
use lamina2d::simulation::Simulation;
use lamina2d::world::World;

use crate::shared_motion::{at_every_width, disc, scene_of, start};

const DT_SECS: f64 = 1.0 / 60.0;

fn paced(max_sag: f64) -> Settings {
    Settings { max_sag: Some(max_sag), ..Settings::default() }
}

fn advance(world: &mut dyn Simulation, steps: usize) {
    for _ in 0..steps {
        world.step(DT_SECS).expect("stays finite");
    }
}

fn unit_box(x: f64, y: f64) -> BodySpec {
    BodySpec::new(ShapeSpec::Box([0.5; 2]), [x, y]).surface(0.0, 0.6)
}

/// Columns of boxes on a floor, as high as said, 3 m apart, and a disc far above them that falls.
fn columns(heights: &[usize]) -> Scene {
    let floor = BodySpec::new(ShapeSpec::Box([60.0, 0.5]), [0.0, -0.5]).surface(0.0, 0.6).fixed();
    let mut bodies = vec![floor];
    for (k, &height) in heights.iter().enumerate() {
        bodies.extend((0..height).map(|level| unit_box(3.0 * k as f64, 0.5 + level as f64)));
    }
    bodies.push(disc([-20.0, 4000.0]).moving([1.0, 2.0], 3.0));
    scene_of(bodies, Forces::gravity())
}

fn rms_speed(world: &dyn Simulation) -> f64 {
    let states = world.states();
    // All but the disc.
    let of = |v: [f64; 2]| v[0] * v[0] + v[1] * v[1];
    let piled = &states[..states.len() - 1];
    (piled.iter().map(|s| of(s.velocity)).sum::<f64>() / piled.len() as f64).sqrt()
}

#[test]
fn a_bound_on_the_sag_is_kept_with_no_more_substeps_than_it_takes() {
    for (max_sag, least) in [(1e-2, 4), (1e-3, 12), (2e-4, 24)] {
        let mut world = start(&columns(&[20, 1]), paced(max_sag));
        advance(&mut *world, 600);
        let (deepest, substeps) = (world.penetration().max, world.counts().substeps);
        println!(
            "20 boxes, {max_sag:e} m: {deepest:.2e} m with {substeps:?} substeps, {:.1e} m/s",
            rms_speed(&*world)
        );
        assert!(deepest < max_sag, "{deepest} m");
        assert!(deepest > 0.1 * max_sag, "{deepest} m: more substeps than the bound asks for");
        assert!(rms_speed(&*world) < 1e-4, "{} m/s", rms_speed(&*world));
        assert!(substeps[1] >= least && substeps[1] <= 4 * least, "{substeps:?}");
        assert!(substeps[0] <= 4, "the single box needs few: {substeps:?}");
    }
}

#[test]
fn what_touches_nothing_keeps_its_bits() {
    for settings in [Settings::default(), Settings::default().with_precision(Precision::F64)] {
        let scene = columns(&[10, 2]);
        let (mut plain, mut paced) =
            (start(&scene, settings), start(&scene, Settings { max_sag: Some(1e-4), ..settings }));
        for step in 0..300 {
            advance(&mut *plain, 1);
            advance(&mut *paced, 1);
            let ends = [&plain, &paced].map(|world| *world.states().last().expect("the disc"));
            assert_eq!(ends[0].position.map(f64::to_bits), ends[1].position.map(f64::to_bits), "step {step}");
            assert_eq!(ends[0].velocity.map(f64::to_bits), ends[1].velocity.map(f64::to_bits), "step {step}");
        }
        assert!(paced.counts().substeps[1] > 8, "{:?}", paced.counts().substeps);
    }
}

/// Bounces, driven bodies, joints, islands that meet and part.
#[test]
fn paces_are_the_same_at_every_width() {
    let of_sag =
        ["all/60", "tumbler/40", "bridge/10", "pyramids/3", "dominoes"].map(|name| (name, paced(2e-3)));
    let slender =
        ["columns/40", "columns/20"].map(|name| (name, Settings { substeps: 2, ..Settings::default() }));
    for (name, settings) in of_sag.into_iter().chain(slender) {
        let scene = by_name(name, None, 1).expect("a named scene");
        for &precision in Precision::ALL {
            let ends: Vec<_> = at_every_width(settings)
                .filter(|settings| settings.precision == precision)
                .map(|settings| {
                    let mut world = start(&scene, settings);
                    advance(&mut *world, 300);
                    (world.hash(), world.counts().substeps)
                })
                .collect();
            println!("{name} {precision}: {:?}", ends[0]);
            assert!(ends.iter().all(|end| *end == ends[0]), "{name} {precision}: {ends:?}");
        }
    }
}

/// A wavering column of 40 buckles with the substeps of the default and stands with those it asks for.
#[test]
fn a_column_that_buckles_gets_the_substeps_it_needs() {
    let scene = by_name("columns/40", None, 1).expect("a named scene");
    let mut world = start(&scene, paced(1e-3));
    let top = world.states().last().expect("boxes").position[1];
    advance(&mut *world, 1800);
    let sunk = top - world.states().last().expect("boxes").position[1];
    println!("columns/40: sunk {sunk:.3} m with {:?} substeps", world.counts().substeps);
    assert!((0.0..0.05).contains(&sunk), "{sunk} m");
}

/// A box lands on a column that has many substeps: islands become one and part again, and nothing is thrown.
#[test]
fn islands_that_meet_and_part_gain_no_energy() {
    let mut scene = columns(&[12, 1]);
    scene.bodies.push(unit_box(0.1, 16.0));
    scene.bodies.push(unit_box(3.05, 6.0).moving([0.0, -4.0], 0.0));
    let mut world = start(&scene, paced(5e-4));
    let energy = |world: &dyn Simulation| {
        let sums = world.invariants();
        sums.kinetic_energy + sums.potential_energy
    };
    let begun = energy(&*world);
    for step in 0..900 {
        advance(&mut *world, 1);
        let gained = energy(&*world) - begun;
        // The disc falls 4 km: f32 keeps seven digits of it.
        assert!(gained < 1e-4 * begun.abs(), "step {step}: {gained} J of {begun}");
    }
    assert!(world.penetration().max < 5e-4, "{}", world.penetration().max);
}

/// A moving kinematic body takes part in every pace, and moves a step per step.
#[test]
fn a_kinematic_body_moves_as_far_as_it_should() {
    let mut scene = columns(&[12, 1]);
    let belt =
        BodySpec::new(ShapeSpec::Box([2.0, 0.25]), [20.0, 0.25]).surface(0.0, 0.6).moving([-0.25, 0.0], 0.0);
    let belt = BodySpec { kind: BodyKind::Kinematic, ..belt };
    scene.bodies.push(belt);
    scene.bodies.push(unit_box(20.0, 1.0));
    let mut world = start(&scene, paced(5e-4).with_precision(Precision::F64));
    advance(&mut *world, 240);
    let states = world.states();
    let [belt, rider] = [states.len() - 2, states.len() - 1].map(|k| states[k]);
    assert!((belt.position[0] - 19.0).abs() < 1e-9, "{}", belt.position[0]);
    assert!((rider.position[0] - 19.0).abs() < 0.05, "friction carries it: {}", rider.position[0]);
    assert!((rider.velocity[0] + 0.25).abs() < 1e-6, "{}", rider.velocity[0]);
    assert!(world.penetration().max < 5e-4, "{}", world.penetration().max);
}

/// How far the top of a column has come down or gone aside, m, and the substeps of the last step.
fn swayed(name: &str, settings: Settings, steps: usize) -> (f64, [u32; 2]) {
    let scene = by_name(name, None, 1).expect("a named scene");
    let mut world = start(&scene, settings);
    let top = |world: &dyn Simulation| world.states().last().expect("boxes").position;
    let begun = top(&*world);
    advance(&mut *world, steps);
    let [x, y] = top(&*world);
    ((x - begun[0]).hypot(y - begun[1]), world.counts().substeps)
}

/// Slender stacks get the substeps that keep them from buckling, unasked; with those of the settings they lean and fall.
#[test]
fn a_slender_stack_gets_the_substeps_it_stands_with() {
    for (name, substeps, most) in [("columns/40", 4, 16), ("columns/80", 8, 32)] {
        let settings = Settings { substeps, ..Settings::default() };
        let (swayed_m, used) = swayed(name, settings, 1800);
        println!("{name}: {swayed_m:.3} m with {used:?} substeps");
        assert!(swayed_m < 0.15, "{name}: {swayed_m} m");
        assert!(used[1] > substeps && used[1] <= most, "{name}: {used:?}");
        let (fallen_m, used) = swayed(name, Settings { fixed_substeps: true, ..settings }, 1800);
        println!("{name}: {fallen_m:.3} m with {used:?} substeps");
        assert!(fallen_m > 1.0 && used == [substeps; 2], "{name}: {fallen_m} m, {used:?}");
    }
}

/// What carries each other in rings, or stands low, needs no more than it is given.
#[test]
fn what_is_not_slender_keeps_its_substeps() {
    for name in ["pyramid/20", "stack/12", "polygons/150", "bridge/20", "tumbler/100", "heavy/8"] {
        let (_, used) = swayed(name, Settings::default(), 400);
        assert_eq!(used, [4; 2], "{name}");
    }
}

/// Ten boxes on each other, small or large, under much gravity, or one with so many times its weight on it: none sinks by
/// more than a thousandth of its size, nor is one thrown up.
#[test]
fn what_presses_hard_gets_the_substeps_that_hold_it() {
    let held = |bodies: Vec<BodySpec>, size: f64, gravity: f64, precision: Precision| {
        let mut scene = scene_of(bodies, Forces { gravity: Some([0.0, -gravity]), ..Forces::default() });
        scene.dt_secs = 1.0 / 60.0;
        let settings = Settings { dt_secs: scene.dt_secs, ..Settings::default() };
        let mut world = start(&scene, settings.with_precision(precision));
        let mut highest = f64::MIN;
        for _ in 0..300 {
            advance(&mut *world, 1);
            for (state, spec) in world.states().iter().zip(&scene.bodies) {
                highest = highest.max(state.position[1] - spec.position[1]);
            }
        }
        let (overlap, [_, used]) = (world.penetration().max, world.counts().substeps);
        let contacts = world.contacts();
        let points = contacts.iter().flat_map(|contact| &contact.points);
        let known = points.map(|point| -point.separation).fold(0.0, f64::max);
        // Gaps are kept to so much of what they have changed by: contacts know how deep they are.
        assert!(
            (known - overlap).abs() <= 0.02 * overlap + 1e-6 * size,
            "{known} m, and in truth {overlap} m"
        );
        println!("{size} m, {gravity} m/s²: {overlap:.1e} m with {used}, risen {highest:.1e} m");
        // Or are solved at once, where masses are far apart.
        let cared_for = used > 4 || world.counts().direct_contacts > 0;
        assert!(overlap <= 1.1e-3 * size && cared_for, "{size} m, {gravity} m/s²: {overlap} m with {used}");
        assert!(highest <= 1e-3 * size, "{size} m, {gravity} m/s²: thrown up by {highest} m");
    };
    let on_each_other = |size: f64, masses: &[f64]| {
        let half = 0.5 * size;
        let one = |(k, mass): (usize, &f64)| {
            BodySpec::new(ShapeSpec::Box([half; 2]), [0.0, half + k as f64 * size]).mass(*mass)
        };
        let ground = BodySpec::new(ShapeSpec::Box([10.0 * size, half]), [0.0, -half]).fixed();
        std::iter::once(ground).chain(masses.iter().enumerate().map(one)).collect::<Vec<_>>()
    };
    for precision in Precision::ALL {
        for size in [0.02, 0.3, 1.0, 10.0] {
            for gravity in [98.0, 200.0] {
                // Ten of 10 m under 98 m/s² are borne by what they have.
                if size < 10.0 || gravity > 98.0 {
                    held(on_each_other(size, &[1.0; 10]), size, gravity, *precision);
                }
            }
        }
        for ratio in [50.0, 300.0, 1000.0] {
            held(on_each_other(1.0, &[1.0, ratio]), 1.0, 9.81, *precision);
        }
    }
}

/// A column is built while others rest: it gets its substeps before it has sagged, and gives them back when it is gone.
#[test]
fn a_column_that_comes_later_gets_its_substeps_and_takes_them_along() {
    let scene = columns(&[3, 2]);
    let mut world = start(&scene, Settings::default());
    advance(&mut *world, 100);
    assert_eq!(world.counts().substeps, [4; 2]);
    let boxes = (0..60).map(|level| unit_box(12.0, 0.5 + f64::from(level)));
    let ids: Vec<_> = boxes.map(|spec| world.insert(&spec).expect("a box")).collect();
    advance(&mut *world, 600);
    assert_eq!(world.counts().substeps, [4, 24], "60 boxes need 20 by the bound");
    let top = world.body(ids[59].slot()).expect("the topmost").state.position;
    assert!((top[0] - 12.0).abs() < 0.01 && (top[1] - 59.5).abs() < 0.05, "{top:?}");
    for id in ids {
        world.remove(id).expect("a living body");
    }
    advance(&mut *world, 100);
    assert_eq!(world.counts().substeps, [4; 2]);
}

/// A column of 1 m boxes that sags under 8 substeps, not taken for a tower while its topmost hangs on a slack rope:
/// the highest any box was once the rope is gone, and where the topmost ends, metres.
fn sagged_and_seen(boxes: usize) -> [f64; 2] {
    let mut scene = stacks::columns(boxes);
    let post = scene.bodies.len();
    scene.bodies.push(unit_box(5.0, boxes as f64 - 0.5).fixed());
    let kind = JointKind::Distance(Distance { max: Some(50.0), ..Distance::default() });
    scene.joints.push(JointSpec { bodies: [boxes, post], kind, collide: false });
    let settings = Settings { substeps: 8, ..Settings::default() };
    let mut world = World::<X8>::from_scene(&scene, settings).expect("a world");
    advance(&mut world, 30);
    assert_eq!(world.counts().substeps, [8; 2]);
    let rope = world.joints().ids().next().expect("the rope");
    world.remove_joint(rope).expect("a living joint");
    let mut highest = f64::MIN;
    for _ in 0..900 {
        advance(&mut world, 1);
        let heights = &world.bodies().y.as_slice()[1..=boxes + 1];
        highest = heights.iter().fold(highest, |most, y| most.max(f64::from(*y)));
    }
    [highest, f64::from(world.bodies().y[boxes + 1])]
}

/// Help that comes late comes rung by rung; what is past help is let fall: its contacts would throw it up.
#[test]
fn a_column_that_has_sagged_is_held_or_let_fall_but_not_thrown() {
    let [highest, top] = sagged_and_seen(100);
    assert!(highest < 99.5 + 0.2 && (top - 99.5).abs() < 0.05, "{highest} m, {top} m: it was at 99.5");
    let [highest, top] = sagged_and_seen(200);
    assert!(highest < 199.5 + 0.2 && top < 190.0, "{highest} m, {top} m: it was at 199.5");
}
