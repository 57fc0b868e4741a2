//! B28 and B30: many discs that collide elastically.

use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg32;

use lamina2d::force::Forces;
use lamina2d::scene::named::scene;
use lamina2d::simulation::BodyState;

use super::impact::box_walls;
use super::{BodySpec, Scene, ShapeSpec};

/// The gas of B28.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gas {
    /// Discs along each side at first.
    pub side: usize,
    /// Of a disc, metres.
    pub radius_m: f64,
    /// Half the inner side of the box, metres.
    pub half_m: f64,
}

/// 400 discs that fill a fifth of their box.
pub const GAS: Gas = Gas { side: 20, radius_m: 0.1, half_m: 4.0 };

/// B28: discs on a grid with random velocities and momentum 0 (but for rounding), of 1 kg and 1 m/s in the mean square;
/// e = 1, no friction, no gravity. The first four bodies are the walls.
pub(super) fn gas(seed: u64) -> Scene {
    let Gas { side, radius_m, half_m } = GAS;
    let mut random = Pcg32::seed_from_u64(seed);
    let count = side * side;
    let mut velocities: Vec<[f64; 2]> =
        (0..count).map(|_| [(); 2].map(|()| random.random_range(-1.0..=1.0))).collect();
    let mean = [0, 1].map(|k| velocities.iter().map(|v| v[k]).sum::<f64>() / count as f64);
    let square = |v: &[f64; 2]| (v[0] - mean[0]).powi(2) + (v[1] - mean[1]).powi(2);
    let scale = (velocities.iter().map(square).sum::<f64>() / count as f64).sqrt().recip();
    for velocity in &mut velocities {
        *velocity = [0, 1].map(|k| (velocity[k] - mean[k]) * scale);
    }
    let pitch = 2.0 * half_m / side as f64;
    let at = |k: usize| (k as f64 + 0.5) * pitch - half_m;
    let disc = |(k, velocity): (usize, [f64; 2])| {
        let disc = BodySpec::new(ShapeSpec::Circle(radius_m), [at(k % side), at(k / side)]);
        disc.mass(1.0).surface(1.0, 0.0).moving(velocity, 0.0)
    };
    let discs = velocities.into_iter().enumerate().map(disc);
    let bodies = box_walls([half_m; 2]).into_iter().chain(discs).collect();
    Scene { seed, ..scene("a gas of hard discs", bodies, Forces::default(), 6000) }
}

/// Radius of a ball of B30, and the gap between neighbours in the rack, metres.
const BALL_M: f64 = 0.03;
const RACK_GAP_M: f64 = 1e-4;

/// B30: a ball at 2 m/s breaks a rack of fifteen on a table of 2 m by 1 m, e = 1, without friction. The first four
/// bodies are the cushions.
pub(super) fn billiard_break() -> Scene {
    let ball =
        |position: [f64; 2]| BodySpec::new(ShapeSpec::Circle(BALL_M), position).mass(1.0).surface(1.0, 0.0);
    let pitch = 2.0 * BALL_M + RACK_GAP_M;
    let rack = (0..5).flat_map(|row: usize| {
        let x = 0.3 + 0.75f64.sqrt() * pitch * row as f64;
        (0..=row).map(move |k| [x, pitch * (k as f64 - 0.5 * row as f64)])
    });
    // A little off the middle: both halves of the rack would else mirror each other.
    let cue = ball([-0.3, 0.004]).moving([2.0, 0.0], 0.0);
    let bodies = box_walls([1.0, 0.5]).into_iter().chain([cue]).chain(rack.map(ball)).collect();
    scene("a billiard break", bodies, Forces::default(), 60)
}

/// The scene with its bodies where a run has left them, going back the way they came.
#[must_use]
pub fn reversed(scene: &Scene, states: &[BodyState]) -> Scene {
    let back = |(spec, state): (&BodySpec, &BodyState)| BodySpec {
        position: state.position,
        angle: state.rotation[1].atan2(state.rotation[0]),
        velocity: state.velocity.map(|v| -v),
        angular_velocity: -state.angular_velocity,
        ..spec.clone()
    };
    Scene { bodies: scene.bodies.iter().zip(states).map(back).collect(), ..scene.clone() }
}
