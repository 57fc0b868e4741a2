//! A9 to A11: pendulums held by joints.

use lamina2d::force::Forces;
use lamina2d::joint::{JointKind, JointSpec};
use lamina2d::scene::{BodySpec, Scene, ShapeSpec};

use super::scene;
use crate::cases::Exact;
use crate::reference::elliptic::pendulum_angle;

const G: f64 = 9.81;

fn disc(radius: f64, position: [f64; 2]) -> BodySpec {
    BodySpec::new(ShapeSpec::Circle(radius), position).surface(0.0, 0.0)
}

fn post() -> BodySpec {
    disc(0.02, [0.0; 2]).fixed()
}

/// A9: 1 kg on a massless rod of 1 m, let go level.
pub(super) fn pendulum() -> Scene {
    let joints = vec![JointSpec::new(0, 1, JointKind::rod())];
    let bodies = vec![post(), disc(0.1, [1.0, 0.0]).mass(1.0)];
    Scene { joints, ..scene("a pendulum let go level", bodies, Forces::gravity()) }
}

/// sin ½θ = k·sn(t√(g/L) + K), T = 4√(L/g)·K(k), k = sin ½θ₀.
pub(super) fn pendulum_at(_: &Scene, t: f64) -> Vec<Exact> {
    let angle = pendulum_angle(std::f64::consts::FRAC_PI_2, t * G.sqrt());
    vec![Exact { body: 1, position: [angle.sin(), -angle.cos()], angle: 0.0 }]
}

/// Half the length and half the thickness of the rod of [`rod`], metres.
const ROD: [f64; 2] = [0.5, 0.01];

/// A10: a rod of 1 m and 1 kg hinged at its left end, let go level.
pub(super) fn rod() -> Scene {
    let rod = BodySpec::new(ShapeSpec::Box(ROD), [ROD[0], 0.0]).surface(0.0, 0.0).mass(1.0);
    let joints = vec![JointSpec::new(0, 1, JointKind::hinge([0.0; 2]))];
    // Beside the rod's end, not in it.
    let post = disc(0.02, [-0.02, 0.0]).fixed();
    Scene { joints, ..scene("a rod on a hinge let go level", vec![post, rod], Forces::gravity()) }
}

/// As [`pendulum_at`], of the length I/(md) = ⅔L·(1 + ¼(thickness/length)²): the slender rod's 2L/3 but for its thickness.
pub(super) fn rod_at(_: &Scene, t: f64) -> Vec<Exact> {
    let [half, thick] = ROD;
    let reduced = (half * half + thick * thick) / 3.0 / half + half;
    let angle = pendulum_angle(std::f64::consts::FRAC_PI_2, t * (G / reduced).sqrt());
    let turn = angle - std::f64::consts::FRAC_PI_2;
    vec![Exact { body: 1, position: [half * angle.sin(), -half * angle.cos()], angle: turn }]
}

/// A11: two discs of 1 kg on two rods of 1 m, let go level: no closed form is known.
pub(super) fn double_pendulum() -> Scene {
    let joints = vec![JointSpec::new(0, 1, JointKind::rod()), JointSpec::new(1, 2, JointKind::rod())];
    let bodies = vec![post(), disc(0.1, [1.0, 0.0]).mass(1.0), disc(0.1, [2.0, 0.0]).mass(1.0)];
    Scene { joints, ..scene("a double pendulum let go level", bodies, Forces::gravity()) }
}
