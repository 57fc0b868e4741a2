//! What a world says of itself is what it does: lanes, precision, step; and what is written into its columns counts.

#![expect(clippy::unwrap_used, reason = "functions generic over lanes are tests too")]

use lamina2d::lanes::{Lanes, f32s, f64s};
use lamina2d::measure::Stage;
use lamina2d::scene::{BodySpec, Scene, ShapeSpec, by_name};
use lamina2d::settings::{Precision, Settings};
use lamina2d::simulation::{Simulation, simulate};
use lamina2d::world::World;

fn says<L: Lanes>(precision: Precision) {
    let scene = by_name("stack/3", None, 1).unwrap();
    let mut world = World::<L>::from_scene(&scene, Settings::default()).unwrap();
    let settings = *world.settings();
    assert_eq!((settings.lanes, settings.precision), (L::WIDTH, precision));
    world.set_settings(settings).unwrap();
    let mut same = simulate(&scene, settings).unwrap();
    for _ in 0..30 {
        world.step(scene.dt_secs).unwrap();
        same.step(scene.dt_secs).unwrap();
    }
    assert_eq!(world.hash(), same.hash());
}

#[test]
fn a_world_says_lanes_and_precision_of_its_type() {
    says::<f32s::X1>(Precision::F32);
    says::<f32s::X4>(Precision::F32);
    says::<f32s::X8>(Precision::F32);
    says::<f32s::X16>(Precision::F32);
    says::<f64s::X1>(Precision::F64);
    says::<f64s::X4>(Precision::F64);
}

#[test]
fn the_step_is_that_of_the_settings() {
    let scene = by_name("stack/3", None, 1).unwrap();
    let mut one = simulate(&scene, Settings { dt_secs: 0.01, ..Settings::default() }).unwrap();
    let mut other = simulate(&scene, Settings::default()).unwrap();
    for _ in 0..20 {
        one.advance().unwrap();
        other.step(0.01).unwrap();
    }
    assert_eq!((one.settings().dt_secs, other.settings().dt_secs), (0.01, 0.01));
    other.advance().unwrap();
    one.step(0.01).unwrap();
    assert_eq!(one.hash(), other.hash());
    assert!(other.step(f64::NAN).is_err());
    assert_eq!(other.settings().dt_secs, 0.01, "a step that is refused changes nothing");
}

/// A block slides on ice that turns rough under it, by a hand that writes into columns: it stops as on rough ground.
#[test]
fn friction_written_into_columns_counts() {
    let mut scene = by_name("slide", None, 1).unwrap();
    let with_friction = |scene: &mut Scene, mu: f64| scene.bodies.iter_mut().for_each(|b| b.friction = mu);
    let end = |scene: &Scene, written: Option<f32>| {
        let mut world = World::<f32s::X8>::from_scene(scene, Settings::default()).unwrap();
        for step in 0..scene.steps {
            if let Some(mu) = written.filter(|_| step == 1) {
                let bodies = world.bodies_mut();
                (bodies.friction[1], bodies.friction[2]) = (mu, mu);
            }
            world.step(scene.dt_secs).unwrap();
        }
        world.states()[1].position[0]
    };
    with_friction(&mut scene, 0.0);
    let [ice, written] = [end(&scene, None), end(&scene, Some(0.5))];
    with_friction(&mut scene, 0.5);
    let rough = end(&scene, None);
    assert!((ice - rough).abs() > 1.0, "{ice} {rough}");
    assert!((written - rough).abs() < 0.1 * (ice - rough).abs(), "{ice} {written} {rough}");
}

/// Of a small world every sixteenth step is timed, of others and where someone asks for it every one.
#[test]
fn small_worlds_are_timed_now_and_then() {
    let timed = |name: &str, always: bool| {
        let scene = by_name(name, None, 1).unwrap();
        let mut world = simulate(&scene, Settings::default()).unwrap();
        if always {
            world.time_every_step();
        }
        (0..33).for_each(|_| world.advance().unwrap());
        let first = world.times().steps;
        world.reset_times();
        world.advance().unwrap();
        (first, world.times().steps, world.times().mean_ns(Stage::Solve) > 0.0)
    };
    assert_eq!(timed("stack/3", false), (3, 1, true));
    assert_eq!(timed("stack/3", true), (33, 1, true));
    assert_eq!(timed("columns/80", false), (33, 1, true));
}

/// One of many statics that is written elsewhere is met where it is.
#[test]
fn statics_written_elsewhere_are_met_there() {
    for statics in [10, 70] {
        let fixed = |k: usize| BodySpec::new(ShapeSpec::Box([0.5, 0.5]), [2.0 * k as f64, -50.0]).fixed();
        let mut bodies: Vec<_> = (0..statics).map(fixed).collect();
        bodies.push(BodySpec::new(ShapeSpec::Circle(0.2), [0.0, 0.0]));
        let scene = Scene { bodies, ..by_name("stack/3", None, 1).unwrap() };
        let mut world = World::<f32s::X8>::from_scene(&scene, Settings::default()).unwrap();
        world.step(1.0 / 60.0).unwrap();
        // The body in slot 1 is the first.
        (world.bodies_mut().x[1], world.bodies_mut().y[1]) = (0.0, -2.0);
        for _ in 0..120 {
            world.step(1.0 / 60.0).unwrap();
        }
        let y = world.bodies().y[statics + 1];
        assert!((y + 1.3).abs() < 0.01, "{statics} statics: at {y}");
    }
}
