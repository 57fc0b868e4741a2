//! A13 and A16: charged particles and free spin.

use lamina2d::force::Forces;
use lamina2d::scene::{BodySpec, Scene, ShapeSpec};

use super::{at, only, particle, scene};
use crate::cases::Exact;

/// kB/m of the charged particles, rad/s.
const RATE: f64 = 3.0;

/// A13: 2 kg in a field of 6 kg/s: a circle of radius v/3.
pub(super) fn circle() -> Scene {
    let forces = Forces { magnetic: Some(2.0 * RATE), ..Forces::default() };
    scene("a charged particle goes round", vec![particle([0.0; 2], [1.0, 0.5], 2.0)], forces)
}

/// A13: the same field and one across it, here gravity's: from rest a cycloid that drifts at E/B.
pub(super) fn drift() -> Scene {
    let forces = Forces { magnetic: Some(2.0 * RATE), gravity: Some([0.0, 1.0]), ..Forces::default() };
    scene("a charged particle drifts across two fields", vec![particle([0.0; 2], [0.0; 2], 2.0)], forces)
}

/// Beside its drift u = (`a_y`, −`a_x`)/Ω the velocity turns clockwise at Ω.
pub(super) fn charged_at(scene: &Scene, t: f64) -> Vec<Exact> {
    let [ax, ay] = scene.forces.gravity.unwrap_or_default();
    let drift = [ay / RATE, -ax / RATE];
    let body = only(scene);
    let [wx, wy] = [body.velocity[0] - drift[0], body.velocity[1] - drift[1]];
    let (s, c) = (RATE * t).sin_cos();
    at([drift[0] * t + (wx * s + wy * (1.0 - c)) / RATE, drift[1] * t + (wx * (c - 1.0) + wy * s) / RATE])
}

/// A16: bars far apart that spin at 1, 10, 100 and 1000 rad/s.
pub(super) fn spin() -> Scene {
    let bar = |(k, w): (usize, f64)| {
        BodySpec::new(ShapeSpec::Box([0.5, 0.1]), [4.0 * k as f64, 0.0]).moving([0.0; 2], w)
    };
    let bars = [1.0, 10.0, 100.0, 1000.0].into_iter().enumerate().map(bar);
    scene("bars that spin freely", bars.collect(), Forces::default())
}

/// θ = ωt.
pub(super) fn spin_at(scene: &Scene, t: f64) -> Vec<Exact> {
    let at = |(body, bar): (usize, &BodySpec)| Exact {
        body,
        position: bar.position,
        angle: bar.angle + bar.angular_velocity * t,
    };
    scene.bodies.iter().enumerate().map(at).collect()
}
