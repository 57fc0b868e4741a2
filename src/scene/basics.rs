//! One or a few bodies whose motion is known: what is simplest to measure an engine by.

use glam::DVec2;

use super::named::scene;
use super::{BodySpec, Scene, ShapeSpec};
use crate::force::Forces;
use crate::vec2::Rot;

/// A static floor with its top at height 0.
pub fn floor(friction: f64, restitution: f64) -> BodySpec {
    BodySpec::new(ShapeSpec::Box([50.0, 0.5]), [0.0, -0.5]).surface(restitution, friction).fixed()
}

/// A body on a slope of `angle` rad: bodies are the slope, whose surface passes through the origin, and the body, which
/// touches it there from above, `height` metres from its centre.
pub fn on_slope(about: &str, shape: ShapeSpec, height: f64, angle: f64, friction: f64, steps: u64) -> Scene {
    let rot = Rot::from_angle(angle);
    let normal = DVec2::new(-rot.s, rot.c);
    let slope = BodySpec::new(ShapeSpec::Box([60.0, 0.5]), (normal * -0.5).to_array());
    let body = BodySpec::new(shape, (normal * height).to_array());
    let bodies =
        vec![slope.turned(angle).surface(0.0, friction).fixed(), body.turned(angle).surface(0.0, friction)];
    scene(about, bodies, Forces::gravity(), steps)
}

/// Three bars far apart, without gravity, at 1, 10 and 100 rad/s.
pub fn spin() -> Scene {
    let bars = [1.0, 10.0, 100.0]
        .into_iter()
        .enumerate()
        .map(|(k, w)| BodySpec::new(ShapeSpec::Box([0.5, 0.1]), [4.0 * k as f64, 0.0]).moving([0.0; 2], w));
    scene("bars that spin freely", bars.collect(), Forces::default(), 600)
}

/// A flat block sent over a level floor at 5 m/s with μ = 0.5.
pub fn slide() -> Scene {
    let block =
        BodySpec::new(ShapeSpec::Box([0.5, 0.25]), [0.0, 0.25]).surface(0.0, 0.5).moving([5.0, 0.0], 0.0);
    scene("a block slides to a stop", vec![floor(0.5, 0.0), block], Forces::gravity(), 120)
}

/// A flat block let go on a slope of 30° with μ = 0.3.
pub fn incline() -> Scene {
    let (about, angle) = ("a block slides down a slope", 30f64.to_radians());
    on_slope(about, ShapeSpec::Box([0.5, 0.25]), 0.25, angle, 0.3, 180)
}

/// A disc let go on a slope of 20° with μ = 0.5, enough for it to roll.
pub fn roll() -> Scene {
    let (about, angle) = ("a disc rolls down a slope", 20f64.to_radians());
    on_slope(about, ShapeSpec::Circle(0.5), 0.5, angle, 0.5, 180)
}

/// A disc sent over a level floor at 6 m/s without spin, μ = 0.3.
pub fn slide_to_roll() -> Scene {
    let disc = BodySpec::new(ShapeSpec::Circle(0.5), [0.0, 0.5]).surface(0.0, 0.3).moving([6.0, 0.0], 0.0);
    scene("a disc slides until it rolls", vec![floor(0.3, 0.0), disc], Forces::gravity(), 120)
}

/// A disc dropped from 2 m with e = 0.8: four bounces.
pub fn bounce() -> Scene {
    let disc = BodySpec::new(ShapeSpec::Circle(0.25), [0.0, 2.25]).surface(0.8, 0.0);
    scene("a disc bounces", vec![floor(0.0, 0.8), disc], Forces::gravity(), 240)
}

/// A disc of 1 kg at 2 m/s hits an upright rod of 2 kg 0.6 m above its middle, e = 1, without gravity.
pub fn rod_hit() -> Scene {
    let disc = BodySpec::new(ShapeSpec::Circle(0.2), [-1.3, 0.6])
        .mass(1.0)
        .surface(1.0, 0.0)
        .moving([2.0, 0.0], 0.0);
    let rod = BodySpec::new(ShapeSpec::Box([0.1, 1.0]), [0.0; 2]).mass(2.0).surface(1.0, 0.0);
    scene("a disc hits a free rod off its middle", vec![disc, rod], Forces::default(), 60)
}
