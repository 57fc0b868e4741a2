//! What would move does not sleep, whatever its speed is now.

use lamina2d::force::{Drive, Forces};
use lamina2d::joint::{Distance, JointKind, JointSpec, JointSpring, Motor, Revolute};
use lamina2d::scene::{BodySpec, Scene, ShapeSpec, by_name};
use lamina2d::settings::Settings;
use lamina2d::simulation::BodyState;

use crate::shared_motion::{scene_of, start};

const DT_SECS: f64 = 1.0 / 60.0;

fn drowsy() -> Settings {
    Settings { sleep: true, ..Settings::default() }
}

/// The last body's state, with and without sleep.
fn both(scene: &Scene, secs: f64) -> [BodyState; 2] {
    [drowsy(), Settings::default()].map(|settings| {
        let mut world = start(scene, settings);
        for _ in 0..(secs / DT_SECS).round() as usize {
            world.step(DT_SECS).expect("stays finite");
        }
        *world.states().last().expect("a body")
    })
}

fn same(case: &str, scene: &Scene, secs: f64, within: f64) -> BodyState {
    let [asleep, awake] = both(scene, secs);
    let off = (0..2).map(|k| (asleep.position[k] - awake.position[k]).abs()).fold(0.0, f64::max);
    let turned = (0..2).map(|k| (asleep.rotation[k] - awake.rotation[k]).abs()).fold(0.0, f64::max);
    assert!(off.max(turned) < within, "{case}: {asleep:?} instead of {awake:?}");
    asleep
}

/// Boxes of 20 cm to 5 m on their corner, off balance by 1e-4 rad and more (f32 loses what is ten times less): they fall.
#[test]
fn boxes_on_their_corner_fall() {
    for half in [0.1, 0.5, 2.5] {
        for off in [1e-4, 1e-3, 1e-2] {
            let floor = BodySpec::new(ShapeSpec::Box([50.0, 0.5]), [0.0, -0.5]).surface(0.0, 1.0).fixed();
            let high = half * std::f64::consts::SQRT_2;
            let tilted = BodySpec::new(ShapeSpec::Box([half; 2]), [0.0, high]).mass(1.0).surface(0.0, 1.0);
            let scene =
                scene_of(vec![floor, tilted.turned(std::f64::consts::FRAC_PI_4 + off)], Forces::gravity());
            // λ = √(g·r·m/I) about the corner; a radian takes ln(1/off) of its time, and some to lie down.
            let rate = (9.81 * 1.5 / high).sqrt();
            let secs = (1.0 / off).ln() / rate + 12.0 / rate + 2.0;
            let end = same(&format!("{half} m, {off} rad"), &scene, secs, 1.0);
            assert!((end.position[1] - half).abs() < 0.02 * half, "{half} m, {off} rad: {end:?}");
        }
    }
}

/// Pendulums of 1 to 200 m, where they turn.
#[test]
fn pendulums_swing_on() {
    for (length, radius, swing) in [(1.0, 0.05, 0.01), (20.0, 0.5, 0.2), (200.0, 2.0, 0.7)] {
        let anchor = BodySpec::new(ShapeSpec::Circle(0.01), [0.0, length]).fixed();
        let drop = length - f64::sqrt(length * length - swing * swing);
        let bob = BodySpec::new(ShapeSpec::Circle(radius), [swing, drop]).mass(1.0);
        let mut scene = scene_of(vec![anchor, bob], Forces::gravity());
        scene.joints = vec![JointSpec::new(0, 1, JointKind::Distance(Distance::default()))];
        let period = std::f64::consts::TAU * (length / 9.81f64).sqrt();
        let end = same(&format!("{length} m"), &scene, 2.5 * period, 0.03 * swing);
        assert!((end.position[0] + swing).abs() < 0.05 * swing, "{length} m: {end:?}");
    }
}

/// Springs between a body and the world, without gravity, and motors, down to a turn in a day.
#[test]
fn slow_springs_and_motors_go_on() {
    for hertz in [0.02, 0.05, 0.5] {
        let anchor = BodySpec::new(ShapeSpec::Circle(0.1), [-2.0, 0.0]).fixed();
        let bob = BodySpec::new(ShapeSpec::Circle(0.5), [0.1, 0.0]).mass(1.0);
        let mut scene = scene_of(vec![anchor, bob], Forces::default());
        let spring = Some(JointSpring { hertz, damping: 0.0 });
        let distance = Distance { length: Some(2.0), spring, ..Distance::default() };
        scene.joints = vec![JointSpec::new(0, 1, JointKind::Distance(distance))];
        let end = same(&format!("{hertz} Hz"), &scene, 1.5 / hertz, 2e-3);
        assert!((end.position[0] + 0.1).abs() < 0.01, "{hertz} Hz: {end:?}");
    }
    for speed in [7e-5, 1e-3, 0.1] {
        let hub = BodySpec::new(ShapeSpec::Circle(0.02), [0.0; 2]).fixed();
        let arm = BodySpec::new(ShapeSpec::Box([0.5, 0.05]), [0.5, 0.0]).mass(1.0);
        let mut scene = scene_of(vec![hub, arm], Forces::gravity());
        let motor = Some(Motor { speed, max_torque: 100.0 });
        scene.joints = vec![JointSpec::new(
            0,
            1,
            JointKind::Revolute(Revolute { anchor: [0.0; 2], motor, limits: None }),
        )];
        let end = same(&format!("{speed} rad/s"), &scene, 20.0, 1e-6);
        let angle = end.rotation[1].atan2(end.rotation[0]);
        assert!((angle / (20.0 * speed) - 1.0).abs() < 0.1, "{speed} rad/s: {angle}");
    }
}

/// A field that grows, slopes just above friction, discs that roll slowly.
#[test]
fn what_is_about_to_move_moves() {
    let floor = || BodySpec::new(ShapeSpec::Box([50.0, 0.5]), [0.0, -0.5]).fixed();
    let drive = Drive { amplitude: [0.0, 20.0], rate: 0.2, phase: -std::f64::consts::FRAC_PI_2 };
    let lifted = Forces { drive: Some(drive), ..Forces::gravity() };
    let still = BodySpec::new(ShapeSpec::Box([0.5; 2]), [0.0, 0.5]).mass(1.0);
    let end = same("drive", &scene_of(vec![floor(), still], lifted), 5.0, 0.02);
    assert!((end.position[1] - 8.234).abs() < 0.05, "{end:?}");
    for more in [1e-3, 1e-2] {
        let (friction, angle) = (0.5, f64::atan(0.5 + more));
        let (sin, cos) = angle.sin_cos();
        let slope =
            BodySpec::new(ShapeSpec::Box([50.0, 0.5]), [0.0; 2]).turned(angle).surface(0.0, friction).fixed();
        let rests = BodySpec::new(ShapeSpec::Box([0.5; 2]), [-sin, cos]).turned(angle).mass(1.0);
        let scene = scene_of(vec![slope, rests.surface(0.0, friction)], Forces::gravity());
        let end = same(&format!("slope {more}"), &scene, 6.0, 0.05);
        let slid = (end.position[0] + sin).hypot(end.position[1] - cos);
        assert!(slid > 0.5 * 0.5 * 9.81 * cos * more * 36.0, "{more}: {slid} m");
    }
    let rolls = BodySpec::new(ShapeSpec::Circle(0.5), [0.0, 0.5]).mass(1.0).moving([2e-3, 0.0], -4e-3);
    let end = same("roll", &scene_of(vec![floor(), rolls], Forces::gravity()), 20.0, 1e-3);
    assert!((end.position[0] - 0.04).abs() < 4e-3, "{end:?}");
}

/// Settled mixes and heaps do sleep, and lie where they would lie awake.
#[test]
fn what_rests_sleeps() {
    for name in ["polygons/150", "pyramid/20", "stack/10", "cards/3"] {
        let mut world = start(&by_name(name, None, 1).expect("a named scene"), drowsy());
        let mut slept = None;
        for step in 0..900 {
            world.step(DT_SECS).expect("stays finite");
            if slept.is_none() && world.counts().sleeping > 0 {
                slept = Some(step);
            }
        }
        println!("{name}: asleep from step {slept:?}");
        assert!(slept.is_some(), "{name} does not sleep in 15 s");
    }
}
