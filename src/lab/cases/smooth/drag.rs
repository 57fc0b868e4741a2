//! A1 to A4: gravity and drag.

use lamina2d::force::Forces;
use lamina2d::scene::Scene;

use super::{at, only, particle, scene};
use crate::cases::Exact;

const WIND: [f64; 2] = [1.0, 0.5];
const GRAVITY: [f64; 2] = [1.25, -9.81];

/// A1: a throw under constant gravity, the control.
pub(super) fn gravity() -> Scene {
    let forces = Forces { gravity: Some(GRAVITY), ..Forces::default() };
    scene("a throw", vec![particle([1.0, 2.0], [3.0, 20.0], 3.0)], forces)
}

/// x₀ + v₀t + ½gt².
pub(super) fn gravity_at(scene: &Scene, t: f64) -> Vec<Exact> {
    let body = only(scene);
    let along = |k: usize| body.position[k] + body.velocity[k] * t + 0.5 * GRAVITY[k] * t * t;
    at([along(0), along(1)])
}

/// A2: 2 kg under gravity and a drag of 12 kg/s, in a wind.
pub(super) fn linear_drag() -> Scene {
    let forces = Forces { linear_drag: Some(12.0), wind: Some(WIND), ..Forces::gravity() };
    scene("a throw with linear drag in a wind", vec![particle([0.0; 2], [3.0, 4.0], 2.0)], forces)
}

/// v = v∞ + (v₀ − v∞)e^(−kt/m).
pub(super) fn linear_drag_at(scene: &Scene, t: f64) -> Vec<Exact> {
    const RATE: f64 = 12.0 / 2.0;
    let v0 = only(scene).velocity;
    let faded = 1.0 - (-RATE * t).exp();
    let along = |k: usize| {
        let last = WIND[k] + [0.0, -9.81][k] / RATE;
        last * t + (v0[k] - last) * faded / RATE
    };
    at([along(0), along(1)])
}

/// A3: 0.25 kg dropped, with a drag of 0.5 kg/m.
pub(super) fn quadratic_drop() -> Scene {
    let forces = Forces { quadratic_drag: Some(0.5), ..Forces::gravity() };
    scene("a drop with quadratic drag", vec![particle([0.0; 2], [0.0; 2], 0.25)], forces)
}

/// y = −(`v_t`²/g) ln cosh(gt/`v_t`), `v_t` = √(mg/k).
pub(super) fn quadratic_drop_at(_: &Scene, t: f64) -> Vec<Exact> {
    let (g, fastest) = (9.81f64, (0.25f64 * 9.81 / 0.5).sqrt());
    at([0.0, -(fastest * fastest / g) * (g * t / fastest).cosh().ln()])
}

/// A4: 1 kg shot at 45° with a drag of 0.4 kg/m: no closed form is known.
pub(super) fn quadratic_shot() -> Scene {
    let forces = Forces { quadratic_drag: Some(0.4), ..Forces::gravity() };
    scene("a shot with quadratic drag", vec![particle([0.0; 2], [20.0, 20.0], 1.0)], forces)
}
