//! Joints under load, hit joints, weights that are no gravity.

use lamina2d::force::Forces;
use lamina2d::joint::{Distance, JointKind, JointSpec, Weld};
use lamina2d::scene::{BodySpec, Scene, ShapeSpec};
use lamina2d::settings::{Settings, SettingsError};
use lamina2d::simulation::{Simulation, simulate};

use crate::EVERY;
use crate::shared_motion::{at_every_width, scene_of, start};

const DT_SECS: f64 = 1.0 / 60.0;

fn advanced(scene: &Scene, steps: usize) -> Box<dyn Simulation> {
    let mut world = start(scene, Settings::default());
    for _ in 0..steps {
        world.step(DT_SECS).expect("stays finite");
    }
    world
}

fn rod(a: usize, b: usize) -> JointSpec {
    JointSpec::new(a, b, JointKind::Distance(Distance::default()))
}

fn weld(a: usize, b: usize, anchor: [f64; 2]) -> JointSpec {
    JointSpec::new(a, b, JointKind::Weld(Weld { anchor, spring: None }))
}

/// Rods between light discs, hung straight, carry a load: nothing moves, whatever the ratio.
#[test]
fn chains_of_rods_carry_what_hangs_on_them() {
    let cases =
        [3, 10, 20, 40].into_iter().flat_map(|links| [10.0, 1000.0, 10_000.0].map(|load| (links, load)));
    for (links, load) in cases.step_by(EVERY) {
        let mut bodies = vec![BodySpec::new(ShapeSpec::Circle(0.05), [0.0, 0.0]).fixed()];
        for k in 1..=links {
            let mass = if k == links { load } else { 0.1 };
            bodies.push(BodySpec::new(ShapeSpec::Circle(0.05), [0.0, -0.5 * f64::from(k)]).mass(mass));
        }
        let mut scene = scene_of(bodies, Forces::gravity());
        scene.joints = (0..links as usize).map(|k| rod(k, k + 1)).collect();
        let world = advanced(&scene, 600);
        let [x, y] = world.states().last().expect("a load").position;
        let right = -0.5 * f64::from(links);
        assert!((y / right - 1.0).abs() < 0.01 && x.abs() < 0.05, "{links} rods, {load} kg: {x}, {y}");
        assert_eq!(world.counts().direct_joints, links as usize, "{links} rods, {load} kg");
    }
}

/// Boxes welded on each other and to the ground, with a load off their axis, stand as one body.
#[test]
fn welded_towers_stand_as_one_body() {
    for height in [3, 9, 14] {
        for (load, aside) in [(100.0, 0.4), (1000.0, 0.2), (100.0, -1.5)] {
            let mut bodies = vec![BodySpec::new(ShapeSpec::Box([20.0, 0.5]), [0.0, -0.5]).fixed()];
            for k in 0..height {
                bodies.push(BodySpec::new(ShapeSpec::Box([0.5, 0.5]), [0.0, 0.5 + f64::from(k)]).mass(1.0));
            }
            let top = [aside, 0.5 + f64::from(height)];
            bodies.push(BodySpec::new(ShapeSpec::Box([0.5, 0.5]), top).mass(load));
            let mut scene = scene_of(bodies, Forces::gravity());
            scene.joints = (0..=height as usize).map(|k| weld(k, k + 1, [0.0, k as f64])).collect();
            let world = advanced(&scene, 600);
            let [x, y] = world.states().last().expect("a load").position;
            let off = (x - top[0]).hypot(y - top[1]);
            assert!(off < 0.05, "{height} high, {load} kg {aside} m aside: off by {off} m");
        }
    }
}

/// A hinge, a rod, a weld in one tree, of very different masses, swings with its energy.
#[test]
fn trees_of_mixed_joints_keep_their_energy() {
    let mut bodies = vec![BodySpec::new(ShapeSpec::Circle(0.05), [0.0, 0.0]).fixed()];
    for (k, mass) in [0.2, 0.1, 5.0, 40.0].into_iter().enumerate() {
        bodies.push(BodySpec::new(ShapeSpec::Box([0.4, 0.05]), [0.5 + k as f64, 0.0]).mass(mass));
    }
    let mut scene = scene_of(bodies, Forces::gravity());
    scene.joints = vec![
        JointSpec::new(0, 1, JointKind::hinge([0.0, 0.0])),
        weld(1, 2, [1.0, 0.0]),
        JointSpec::new(2, 3, JointKind::hinge([2.0, 0.0])),
        rod(3, 4),
    ];
    let mut world = start(&scene, Settings { substeps: 16, ..Settings::default() });
    let energy = |world: &dyn Simulation| {
        let sums = world.invariants();
        sums.kinetic_energy + sums.potential_energy
    };
    let (begun, mut swung) = (energy(&*world), 0.0f64);
    for step in 0..300 {
        world.step(DT_SECS).expect("stays finite");
        swung = swung.max(world.invariants().kinetic_energy);
        let off = (energy(&*world) - begun) / 1000.0;
        assert!((-0.2..0.05).contains(&off), "step {step}: {off} of a swing's energy");
    }
    assert!(swung > 500.0, "{swung} J");
}

/// A ball hits a free wheel of welded parts, off its middle: plastic as one rigid body would be.
#[test]
fn an_impact_on_welded_bodies_is_as_plastic_as_on_one() {
    for speed in [0.5, 5.0, 30.0] {
        let hub = BodySpec::new(ShapeSpec::Circle(1.0), [0.0, 0.0]).mass(10.0).surface(0.0, 0.0);
        let arm = |side: f64| {
            BodySpec::new(ShapeSpec::Box([1.0, 0.2]), [side * 2.0, 0.0]).mass(2.0).surface(0.0, 0.0)
        };
        let ball = BodySpec::new(ShapeSpec::Circle(0.1), [2.5, -1.0]).mass(1.0).surface(0.0, 0.0);
        let bodies = vec![hub, arm(1.0), arm(-1.0), ball.moving([0.0, speed], 0.0)];
        let mut scene = scene_of(bodies, Forces::default());
        scene.joints = vec![weld(0, 1, [1.0, 0.0]), weld(0, 2, [-1.0, 0.0])];
        let steps = (2.0 / speed / DT_SECS).ceil() as usize + 60;
        let world = advanced(&scene, steps);
        // I = ½·10 + 2·(2·(2² + 0.4²)/12 + 2·2²), hit 2.5 m from the middle by 1 kg.
        let inertia = 5.0 + 2.0 * (2.0 * 4.16 / 12.0 + 8.0);
        let impulse = speed / (1.0 + 1.0 / 14.0 + 2.5 * 2.5 / inertia);
        let kinetic = 0.5 * (speed - impulse).powi(2)
            + 0.5 * impulse * impulse / 14.0
            + 0.5 * (2.5 * impulse).powi(2) / inertia;
        let found = world.invariants().kinetic_energy;
        let lost = 0.5 * speed * speed - kinetic;
        assert!((found - kinetic).abs() < 0.02 * lost, "{speed} m/s: {found} J instead of {kinetic} J");
    }
}

/// A column of boxes stands alike whether gravity or a force on each is its weight.
#[test]
fn weight_is_weight() {
    for boxes in [20, 80] {
        let stacked = |force: Option<[f64; 2]>| {
            let mut bodies = vec![BodySpec::new(ShapeSpec::Box([5.0, 0.5]), [0.0, -0.5]).fixed()];
            for k in 0..boxes {
                let spec = BodySpec::new(ShapeSpec::Box([0.5, 0.5]), [0.0, 0.5 + f64::from(k)]).mass(1.0);
                bodies.push(BodySpec { force: force.unwrap_or_default(), ..spec });
            }
            let forces = if force.is_some() { Forces::default() } else { Forces::gravity() };
            let world = advanced(&scene_of(bodies, forces), 600);
            (world.states().last().expect("a top").position, world.counts().substeps)
        };
        let (by_gravity, by_force) = (stacked(None), stacked(Some([0.0, -9.81])));
        let right = f64::from(boxes) - 0.5;
        for (place, substeps) in [by_gravity, by_force] {
            assert!(
                place[0].abs() < 0.01 && (place[1] - right).abs() < 0.05,
                "{boxes}: {place:?} {substeps:?}"
            );
        }
        assert_eq!(by_gravity.1, by_force.1, "{boxes} boxes");
    }
}

/// A step that single precision cannot carry is refused by name, before anything moves.
#[test]
fn steps_too_short_for_the_precision_are_refused() {
    let scene = scene_of(vec![BodySpec::new(ShapeSpec::Circle(0.5), [0.0; 2])], Forces::gravity());
    for settings in at_every_width(Settings::default()) {
        let least = settings.precision.shortest_step_secs();
        for dt_secs in [0.5 * least, 1e-3 * least] {
            let refused =
                simulate(&scene, Settings { dt_secs, ..settings }).err().map(|error| error.to_string());
            let expected = SettingsError::ShortDt { precision: settings.precision, given: dt_secs, least };
            assert_eq!(refused, Some(expected.to_string()));
        }
        let mut world = start(&scene, settings);
        assert!(world.step(0.5 * least).is_err() && world.steps() == 0);
        assert_eq!(world.step(2.0 * least), Ok(()));
    }
}
