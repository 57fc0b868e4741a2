//! What single steps do, held against algebra: oscillators (A5, A6) and free spin (A16).
//!
//! On a linear oscillator with ω = 1 rad/s a step is a 2 × 2 matrix of z = hω, and by Cayley and Hamilton
//! every component obeys u₊ = trace·u − determinant·u₋: trace and determinant are the whole method.

use lamina2d::force::{Forces, Spring};
use lamina2d::lanes::f64s;
use lamina2d::scene::Scene;
use lamina2d::settings::{Integrator, Precision, Settings, Skips, StiffFields};
use lamina2d::world::World;

use crate::shared_motion::{disc, scene_of, start};

/// 1 kg on 1 N/m: ω = 1 rad/s without rounding, so z is the step.
fn oscillator() -> Scene {
    let spring = Spring { anchor: [0.0; 2], stiffness: 1.0 };
    let forces = Forces { spring: Some(spring), ..Forces::default() };
    scene_of(vec![disc([1.0, -0.25]).moving([0.5, 0.125], 0.0).mass(1.0)], forces)
}

/// (x, vx) after each of `steps` steps of z, the start first.
fn course(integrator: Integrator, z: f64, steps: usize) -> Vec<[f64; 2]> {
    course_by(integrator, z, steps, StiffFields::Scheme)
}

fn course_by(integrator: Integrator, z: f64, steps: usize, stiff: StiffFields) -> Vec<[f64; 2]> {
    let settings = Settings::default().with_precision(Precision::F64);
    let settings = Settings { integrator, substeps: 1, stiff_fields: Some(stiff), ..settings };
    let mut world = World::<f64s::X4>::from_scene(&oscillator(), settings).expect("the scene is good");
    let mut states = vec![[1.0, 0.5]];
    for _ in 0..steps {
        world.step(z).expect("stays finite");
        states.push([world.bodies().x[1], world.bodies().vx[1]]);
    }
    states
}

/// Real and imaginary part of RK4's stability function at iz: Σ (iz)ᵏ/k! to k = 4.
fn rk4_factor(z: f64) -> (f64, f64) {
    (1.0 - z * z / 2.0 + z.powi(4) / 24.0, z - z.powi(3) / 6.0)
}

/// A leapfrog step of z (drift, kick, drift) as a matrix on (x, v).
fn leapfrog(z: f64) -> [[f64; 2]; 2] {
    let diagonal = 1.0 - z * z / 2.0;
    [[diagonal, z - z.powi(3) / 4.0], [-z, diagonal]]
}

fn times(a: [[f64; 2]; 2], b: [[f64; 2]; 2]) -> [[f64; 2]; 2] {
    let entry = |i: usize, j: usize| a[i][0] * b[0][j] + a[i][1] * b[1][j];
    [[entry(0, 0), entry(0, 1)], [entry(1, 0), entry(1, 1)]]
}

/// Trace and determinant of a method's step.
fn trace_and_determinant(integrator: Integrator, z: f64) -> (f64, f64) {
    match integrator {
        Integrator::ExplicitEuler => (2.0, 1.0 + z * z),
        Integrator::SemiImplicitEuler | Integrator::VelocityVerlet | Integrator::PositionVerlet => {
            (2.0 - z * z, 1.0)
        }
        Integrator::Rk4 => {
            let (re, im) = rk4_factor(z);
            (2.0 * re, re * re + im * im)
        }
        Integrator::Yoshida4 => {
            let w1 = 1.0 / (2.0 - 2f64.cbrt());
            let (outer, inner) = (leapfrog(w1 * z), leapfrog((1.0 - 2.0 * w1) * z));
            let m = times(outer, times(inner, outer));
            (m[0][0] + m[1][1], 1.0)
        }
    }
}

/// Measured: 5e-16 at most, and 4e-15 for Yoshida, whose middle leapfrog goes back by 1.7 h.
#[test]
fn every_step_on_an_oscillator_has_the_trace_and_determinant_of_its_method() {
    for &integrator in Integrator::ALL {
        let mut worst = 0.0f64;
        for z in [0.01, 0.1, 0.5, 1.0, 1.5] {
            let (trace, determinant) = trace_and_determinant(integrator, z);
            let states = course(integrator, z, 100);
            for w in states.windows(3) {
                let size = w.iter().flatten().fold(0.0f64, |m, v| m.max(v.abs()));
                for k in 0..2 {
                    worst = worst.max((w[2][k] - (trace * w[1][k] - determinant * w[0][k])).abs() / size);
                }
            }
        }
        println!("{integrator:20} one step off by {worst:.1e}");
        assert!(worst < 1e-14, "{integrator}: {worst:e}");
    }
}

/// A5: the leapfrogs swing at (2/h)·asin(hω/2), phase held to 1e-12 over 1000 steps.
#[test]
fn leapfrogs_swing_at_their_own_frequency() {
    for integrator in [Integrator::SemiImplicitEuler, Integrator::VelocityVerlet, Integrator::PositionVerlet]
    {
        for z in [0.1, 0.5, 1.0, 1.5] {
            let states = course(integrator, z, 1000);
            let phi = 2.0 * (z / 2.0f64).asin();
            let (x0, x1) = (states[0][0], states[1][0]);
            let quadrature = (x1 - x0 * phi.cos()) / phi.sin();
            let off = |(n, s): (usize, &[f64; 2])| {
                let (sin, cos) = (n as f64 * phi).sin_cos();
                (s[0] - (x0 * cos + quadrature * sin)).abs()
            };
            let worst = states.iter().enumerate().map(off).fold(0.0, f64::max);
            println!("{integrator:20} z = {z}: off by {worst:.1e} over 1000 steps");
            assert!(worst < 1e-12, "{integrator} z = {z}: {worst:e}");
        }
    }
}

/// A5: per step explicit Euler grows by √(1 + z²), RK4 shrinks by 1 − z⁶/144 and lags by z⁵/120 rad.
#[test]
fn amplitude_and_phase_per_step_are_those_of_the_formula() {
    let turn = |a: [f64; 2], b: [f64; 2]| {
        // v runs ahead of x by a quarter: the angle of (x, v) falls.
        (a[1].atan2(a[0]) - b[1].atan2(b[0])).rem_euclid(std::f64::consts::TAU)
    };
    let size = |s: [f64; 2]| s[0].hypot(s[1]);
    for z in [0.05, 0.1, 0.2, 0.4] {
        let (re, im) = rk4_factor(z);
        for w in course(Integrator::Rk4, z, 200).windows(2) {
            let (grown, turned) = (size(w[1]) / size(w[0]), turn(w[0], w[1]));
            assert!((grown - re.hypot(im)).abs() < 1e-14, "z = {z}: amplitude {grown}");
            assert!((turned - im.atan2(re)).abs() < 1e-14, "z = {z}: phase {turned}");
            // The leading terms; what follows them is z⁸/1152 and z⁷/336, from the series of |R| and arg R.
            assert!((grown - (1.0 - z.powi(6) / 144.0)).abs() < z.powi(8) / 1000.0 + 1e-14);
            assert!((turned - (z - z.powi(5) / 120.0)).abs() < z.powi(7) / 300.0 + 1e-14);
        }
        for w in course(Integrator::ExplicitEuler, z, 200).windows(2) {
            let (grown, turned) = (size(w[1]) / size(w[0]), turn(w[0], w[1]));
            assert!((grown - (1.0 + z * z).sqrt()).abs() < 1e-14, "z = {z}: amplitude {grown}");
            assert!((turned - z.atan()).abs() < 1e-14, "z = {z}: phase {turned}");
        }
    }
}

/// A6: bounded at 0.99 × the limit, growing at 1.01 ×, and bounded there too by what the spring does where the scheme is
/// given up; explicit Euler grows at any step.
#[test]
fn stiff_oscillators_hold_to_the_stability_limit_and_not_beyond() {
    let by = |integrator, z, stiff_fields| {
        course_by(integrator, z, 1000, stiff_fields).iter().flatten().fold(0.0f64, |m, v| m.max(v.abs()))
    };
    let largest = |integrator, z| by(integrator, z, StiffFields::Scheme);
    let limits = [
        (Integrator::SemiImplicitEuler, 2.0),
        (Integrator::VelocityVerlet, 2.0),
        (Integrator::PositionVerlet, 2.0),
        (Integrator::Yoshida4, 1.573),
        (Integrator::Rk4, 8f64.sqrt()),
    ];
    for (integrator, limit) in limits {
        let (held, lost) = (largest(integrator, 0.99 * limit), largest(integrator, 1.01 * limit));
        println!("{integrator:20} limit {limit:.4}: up to {held:.2} within it, {lost:.1e} beyond");
        assert!(held < 30.0, "{integrator}: {held}");
        assert!(lost > 1e10, "{integrator}: {lost}");
        let beyond = by(integrator, 1.01 * limit, StiffFields::Exact);
        assert!(beyond < 1.2, "{integrator}: {beyond}");
    }
    // √(1 + z²)¹⁰⁰⁰ = 1.22, at a hundredth of the others' limit.
    let grown = largest(Integrator::ExplicitEuler, 0.02) / 1f64.hypot(0.5);
    assert!((1.20..1.23).contains(&grown), "{grown}");
}

/// Spins at ω = 1…1000 rad/s for `steps` steps; the largest error of (c, s) over n·ε·(1 + hω).
///
/// Per step the product hω rounds by half an ulp of itself, sine, cosine and the product of two
/// rotations by an ulp of 1; errors of one ω all lean the same way, so they add up with n.
fn worst_spin_error(settings: Settings, dt_secs: f64, epsilon: f64) -> f64 {
    let speeds = [1.0, 3.0, 10.0, 31.0, 100.0, 314.0, 1000.0];
    let spinning = |(k, w): (usize, &f64)| disc([3.0 * k as f64, 0.0]).moving([0.0; 2], *w);
    let scene = scene_of(speeds.iter().enumerate().map(spinning).collect(), Forces::default());
    let mut world = start(&scene, settings);
    let mut worst = 0.0f64;
    for n in 1..=2000 {
        world.step(dt_secs).expect("stays finite");
        for (state, w) in world.states().iter().zip(speeds) {
            assert_eq!(state.angular_velocity, w, "nothing acts on it");
            let (s, c) = (w * dt_secs * f64::from(n)).sin_cos();
            let error = (state.rotation[0] - c).hypot(state.rotation[1] - s);
            worst = worst.max(error / (f64::from(n) * epsilon * (1.0 + w * dt_secs)));
        }
    }
    worst
}

/// A16: θ = ωt to n·ε, in both precisions, flying or by whole steps, in one round or four. Measured: 0.29.
///
/// A first-order turn would be off by (hω)²/3 per radian: 8e-5 at ω = 1, not 1e-7.
#[test]
fn free_spin_turns_by_omega_t_to_round_off() {
    for (precision, epsilon) in [(Precision::F32, f64::from(f32::EPSILON)), (Precision::F64, f64::EPSILON)] {
        for dt_secs in [1.0 / 64.0, 1.0 / 1024.0] {
            for (skips, substeps) in [(Skips::ALL, 1), (Skips::NONE, 1), (Skips::ALL, 4)] {
                let settings = Settings { skips, substeps, ..Settings::default().with_precision(precision) };
                let worst = worst_spin_error(settings, dt_secs, epsilon);
                println!("{precision} dt = {dt_secs} skips {skips} × {substeps}: {worst:.2} n·ε(1 + hω)");
                assert!(worst < 1.0, "{precision} {dt_secs}: {worst}");
            }
        }
    }
}

/// Where h itself rounds (1/60 s), its rounding is all that is added: half an ulp of hω per step.
/// Measured: 0.60 in f32, 0.42 in f64.
#[test]
fn free_spin_at_sixty_hertz_is_off_only_by_the_rounding_of_h() {
    for (precision, epsilon) in [(Precision::F32, f64::from(f32::EPSILON)), (Precision::F64, f64::EPSILON)] {
        let worst = worst_spin_error(Settings::default().with_precision(precision), 1.0 / 60.0, epsilon);
        println!("{precision} at 60 Hz: {worst:.2} n·ε(1 + hω)");
        assert!(worst < 1.0, "{precision}: {worst}");
    }
}
