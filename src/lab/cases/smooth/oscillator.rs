//! A5 to A8: oscillators.

use lamina2d::force::{Drive, Forces, Spring};
use lamina2d::joint::{Distance, JointKind, JointSpec, JointSpring};
use lamina2d::scene::{BodySpec, Scene, ShapeSpec};

use super::{at, only, particle, scene};
use crate::cases::Exact;

fn sprung(anchor: [f64; 2], stiffness: f64) -> Forces {
    Forces { spring: Some(Spring { anchor, stiffness }), ..Forces::default() }
}

const ANCHOR: [f64; 2] = [0.5, -0.25];

/// A5: 2 kg on 18 N/m, ω = 3 rad/s, about a point off the origin.
pub(super) fn oscillator() -> Scene {
    scene("an oscillator", vec![particle([1.5, 0.0], [0.2, -1.0], 2.0)], sprung(ANCHOR, 18.0))
}

/// x = a + (x₀ − a) cos ωt + (v₀/ω) sin ωt.
fn swings(scene: &Scene, anchor: [f64; 2], rate: f64, t: f64) -> Vec<Exact> {
    let (s, c) = (rate * t).sin_cos();
    let body = only(scene);
    let along = |k: usize| anchor[k] + (body.position[k] - anchor[k]) * c + body.velocity[k] / rate * s;
    at([along(0), along(1)])
}

pub(super) fn oscillator_at(scene: &Scene, t: f64) -> Vec<Exact> {
    swings(scene, ANCHOR, 3.0, t)
}

/// Of the stiff oscillator of A6, rad/s.
pub const STIFF_RATE: f64 = 1000.0;

/// A6: 1 kg on 10⁶ N/m, ω = 1000 rad/s: what a step must not be too long for.
pub(super) fn stiff() -> Scene {
    let forces = sprung([0.0; 2], STIFF_RATE * STIFF_RATE);
    scene("a stiff oscillator", vec![particle([1.0, 0.0], [0.0; 2], 1.0)], forces)
}

pub(super) fn stiff_at(scene: &Scene, t: f64) -> Vec<Exact> {
    swings(scene, [0.0; 2], STIFF_RATE, t)
}

/// A7: 1 kg on 9 N/m with a drag of 1 kg/s.
pub(super) fn damped() -> Scene {
    let forces = Forces { linear_drag: Some(1.0), ..sprung([0.0; 2], 9.0) };
    scene("a damped oscillator", vec![particle([1.0, -0.5], [0.5, 1.0], 1.0)], forces)
}

/// x = e^(−½ct)(x₀ cos νt + (v₀ + ½cx₀)/ν·sin νt), ν = √(ω² − ¼c²).
pub(super) fn damped_at(scene: &Scene, t: f64) -> Vec<Exact> {
    let (half, rate) = (0.5f64, (9.0f64 - 0.25).sqrt());
    let ((s, c), faded) = ((rate * t).sin_cos(), (-half * t).exp());
    let body = only(scene);
    let along =
        |k: usize| faded * (body.position[k] * c + (body.velocity[k] + half * body.position[k]) / rate * s);
    at([along(0), along(1)])
}

/// Undamped oscillations per second, and damping ratio, of [`overdamped`]: c = 2ζω = 10⁴/s.
const OVERDAMPED: JointSpring = JointSpring { hertz: 5.0, damping: 500.0 / std::f64::consts::PI };

/// A7: a disc pulled 0.5 m out of the rest length of a sprung, heavily damped joint: c·h ≫ 2 for any step a game
/// would take. A drag that strong would throw any explicit scheme out; joints are solved for the step's end.
pub(super) fn overdamped() -> Scene {
    let post = BodySpec::new(ShapeSpec::Circle(0.1), [0.0; 2]).fixed();
    let bob = particle([1.5, 0.0], [0.0; 2], 1.0);
    let kind =
        JointKind::Distance(Distance { length: Some(1.0), spring: Some(OVERDAMPED), ..Distance::default() });
    let joints = vec![JointSpec::new(0, 1, kind)];
    Scene { joints, ..scene("an overdamped spring", vec![post, bob], Forces::default()) }
}

/// x = L + d·(r₁e^(r₂t) − r₂e^(r₁t))/(r₁ − r₂), r = −ζω ± ω√(ζ² − 1).
pub(super) fn overdamped_at(scene: &Scene, t: f64) -> Vec<Exact> {
    let rate = std::f64::consts::TAU * OVERDAMPED.hertz;
    let zeta = OVERDAMPED.damping;
    let root = (zeta * zeta - 1.0).sqrt();
    let fast = -rate * (zeta + root);
    // Their product is ω²: the difference of two nearly equal numbers would lose five digits.
    let slow = rate * rate / fast;
    let share = (slow * (fast * t).exp() - fast * (slow * t).exp()) / (slow - fast);
    let bob = Exact { body: 1, position: [1.0 + 0.5 * share, 0.0], angle: 0.0 };
    debug_assert_eq!(scene.bodies.len(), 2);
    vec![bob]
}

/// A8: 1 kg on 9 N/m pushed by cos 3t, at rest at first.
pub(super) fn resonance() -> Scene {
    let drive = Some(Drive { amplitude: [1.0, 0.0], rate: 3.0, phase: 0.0 });
    let forces = Forces { drive, ..sprung([0.0; 2], 9.0) };
    scene("an oscillator in resonance", vec![particle([0.0; 2], [0.0; 2], 1.0)], forces)
}

/// x = (t/2ω) sin ωt.
pub(super) fn resonance_at(_: &Scene, t: f64) -> Vec<Exact> {
    at([t / 6.0 * (3.0 * t).sin(), 0.0])
}
