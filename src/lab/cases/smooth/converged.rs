//! Scenes without a closed form, as equations for an integrator of references: in `f64`, by state vectors, and without
//! a line of the engine.

use super::orbits::ARENSTORF_MU;
use crate::reference::ode::{self, Slope};

/// An initial value problem beside a scene.
#[derive(Clone, Copy, Debug)]
pub struct Problem {
    /// The scene's name.
    pub scene: &'static str,
    /// The state as the scene begins.
    pub start: fn() -> Vec<f64>,
    /// Its slope, written into the second argument.
    pub slope: fn(&[f64], &mut [f64]),
    /// Centroids of the movable bodies, in the scene's order, metres.
    pub places: fn(&[f64]) -> Vec<[f64; 2]>,
    /// Extrapolated steps per second that bring it to round-off.
    pub steps_per_sec: f64,
}

const PROBLEMS: &[Problem] = &[
    Problem {
        scene: "a04_quadratic_shot",
        start: || vec![0.0, 0.0, 20.0, 20.0],
        slope: shot,
        places: first_place,
        steps_per_sec: 64.0,
    },
    Problem {
        scene: "a11_double_pendulum",
        start: || vec![std::f64::consts::FRAC_PI_2, std::f64::consts::FRAC_PI_2, 0.0, 0.0],
        slope: double_pendulum,
        places: |y| {
            let ([s1, c1], [s2, c2]) = ([y[0].sin(), y[0].cos()], [y[1].sin(), y[1].cos()]);
            vec![[s1, -c1], [s1 + s2, -c1 - c2]]
        },
        steps_per_sec: 64.0,
    },
    Problem {
        scene: "a14_arenstorf",
        start: || vec![0.994, 0.0, 0.0, -2.001_585_106_379_082_4],
        slope: arenstorf,
        places: first_place,
        steps_per_sec: 1024.0,
    },
    Problem {
        scene: "a15_pleiades",
        start: || {
            let at = [3.0, 3.0, 3.0, -3.0, -1.0, 2.0, -3.0, 0.0, 2.0, 0.0, -2.0, -4.0, 2.0, 4.0];
            let moving = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -1.25, 0.0, 1.0, 1.75, 0.0, -1.5, 0.0];
            [at, moving].concat()
        },
        slope: pleiades,
        places: |y| y[..14].chunks_exact(2).map(|p| [p[0], p[1]]).collect(),
        steps_per_sec: 1024.0,
    },
    Problem {
        scene: "a15_henon_heiles",
        start: || vec![0.0, 0.1, 0.5, 0.0],
        slope: henon_heiles,
        places: first_place,
        steps_per_sec: 8.0,
    },
];

/// The problem beside a scene that has no closed form; `None` where it has one, or none of both.
pub fn converged(scene: &str) -> Option<&'static Problem> {
    PROBLEMS.iter().find(|problem| problem.scene == scene)
}

impl Problem {
    /// Centroids after each of `times`, ascending, seconds, with `refined` times the usual number of steps.
    pub fn course(&self, times: &[f64], refined: u32) -> Vec<Vec<[f64; 2]>> {
        let slope: Slope<'_> = &self.slope;
        let (mut state, mut now) = ((self.start)(), 0.0);
        let mut to = |&time: &f64| {
            let steps = ((time - now) * self.steps_per_sec).ceil().max(1.0) as u32 * refined;
            state = ode::extrapolated(slope, &state, time - now, steps);
            now = time;
            (self.places)(&state)
        };
        times.iter().map(&mut to).collect()
    }
}

fn first_place(y: &[f64]) -> Vec<[f64; 2]> {
    vec![[y[0], y[1]]]
}

/// v′ = g − k|v|v.
fn shot(y: &[f64], d: &mut [f64]) {
    let drag = 0.4 * y[2].hypot(y[3]);
    (d[0], d[1]) = (y[2], y[3]);
    (d[2], d[3]) = (-drag * y[2], -9.81 - drag * y[3]);
}

/// Angles from below and their rates, of two equal masses on two rods of 1 m.
///
/// With δ = θ₁ − θ₂ the equations of Lagrange are 2θ₁″ + cos δ·θ₂″ = −sin δ·θ₂′² − 2g sin θ₁ and
/// θ₂″ + cos δ·θ₁″ = sin δ·θ₁′² − g sin θ₂, of determinant 2 − cos² δ.
fn double_pendulum(y: &[f64], d: &mut [f64]) {
    const G: f64 = 9.81;
    let (s, c) = (y[0] - y[1]).sin_cos();
    let first = -s * y[3] * y[3] - 2.0 * G * y[0].sin();
    let second = s * y[2] * y[2] - G * y[1].sin();
    let determinant = 2.0 - c * c;
    (d[0], d[1]) = (y[2], y[3]);
    (d[2], d[3]) = ((first - c * second) / determinant, (2.0 * second - c * first) / determinant);
}

/// The restricted problem of three bodies in the turning frame.
fn arenstorf(y: &[f64], d: &mut [f64]) {
    let (mu, earth) = (ARENSTORF_MU, 1.0 - ARENSTORF_MU);
    let near_earth = (y[0] + mu).hypot(y[1]).powi(3);
    let near_moon = (y[0] - earth).hypot(y[1]).powi(3);
    (d[0], d[1]) = (y[2], y[3]);
    d[2] = y[0] + 2.0 * y[3] - earth * (y[0] + mu) / near_earth - mu * (y[0] - earth) / near_moon;
    d[3] = y[1] - 2.0 * y[2] - earth * y[1] / near_earth - mu * y[1] / near_moon;
}

/// Seven bodies of 1 to 7 kg, G = 1.
fn pleiades(y: &[f64], d: &mut [f64]) {
    d[..14].copy_from_slice(&y[14..]);
    for a in 0..7 {
        let mut pull = [0.0; 2];
        for b in (0..7).filter(|&b| b != a) {
            let (dx, dy) = (y[2 * b] - y[2 * a], y[2 * b + 1] - y[2 * a + 1]);
            let factor = (b + 1) as f64 / dx.hypot(dy).powi(3);
            pull = [pull[0] + factor * dx, pull[1] + factor * dy];
        }
        d[14 + 2 * a..16 + 2 * a].copy_from_slice(&pull);
    }
}

/// −∇(½(x² + y²) + x²y − ⅓y³).
fn henon_heiles(y: &[f64], d: &mut [f64]) {
    (d[0], d[1]) = (y[2], y[3]);
    (d[2], d[3]) = (-y[0] - 2.0 * y[0] * y[1], -y[1] - y[0] * y[0] + y[1] * y[1]);
}
