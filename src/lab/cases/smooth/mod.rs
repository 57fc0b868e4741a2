//! Smooth motion, table A of the cases: one file per family, each scene with its closed form beside it where one is
//! known. What a converged run must stand in for is in [`converged`].

mod charged;
mod converged;
mod drag;
mod orbits;
mod oscillator;
mod pendulum;

use lamina2d::scene::named::{SceneInfo, fixed as info};

use lamina2d::force::Forces;

use super::{BodySpec, Scene, ShapeSpec};
use super::{Exact, Form};

pub use converged::{Problem, converged};
pub use orbits::{ARENSTORF_MU, ARENSTORF_PERIOD_SECS};
pub use oscillator::STIFF_RATE;

/// A small disc of so many kilograms.
fn particle(position: [f64; 2], velocity: [f64; 2], mass: f64) -> BodySpec {
    BodySpec::new(ShapeSpec::Circle(0.01), position).moving(velocity, 0.0).mass(mass)
}

/// The only body of a scene.
fn only(scene: &Scene) -> &BodySpec {
    &scene.bodies[0]
}

/// Where the only body is.
fn at(position: [f64; 2]) -> Vec<Exact> {
    vec![Exact { body: 0, position, angle: 0.0 }]
}

/// A scene of 2 s.
fn scene(about: &str, bodies: Vec<BodySpec>, forces: Forces) -> Scene {
    super::scene(about, bodies, forces, 120)
}

/// The scenes of table A, in its order.
pub(super) const SCENES: &[SceneInfo] = &[
    info("a01_gravity", "A1: a throw", |_, _| drag::gravity(), 1),
    info("a02_linear_drag", "A2: a throw with linear drag in a wind", |_, _| drag::linear_drag(), 1),
    info("a03_quadratic_drop", "A3: a drop with quadratic drag", |_, _| drag::quadratic_drop(), 1),
    info("a04_quadratic_shot", "A4: a shot with quadratic drag", |_, _| drag::quadratic_shot(), 1),
    info("a05_oscillator", "A5: an oscillator", |_, _| oscillator::oscillator(), 1),
    info("a06_stiff", "A6: a stiff oscillator", |_, _| oscillator::stiff(), 1),
    info("a07_damped", "A7: a damped oscillator", |_, _| oscillator::damped(), 1),
    info("a07_overdamped", "A7: an overdamped spring between two bodies", |_, _| oscillator::overdamped(), 1),
    info("a08_resonance", "A8: an oscillator in resonance", |_, _| oscillator::resonance(), 1),
    info("a09_pendulum", "A9: a pendulum let go level", |_, _| pendulum::pendulum(), 1),
    info("a10_rod", "A10: a rod on a hinge let go level", |_, _| pendulum::rod(), 1),
    info("a11_double_pendulum", "A11: a double pendulum let go level", |_, _| pendulum::double_pendulum(), 2),
    info("a12_kepler_e05", "A12: an orbit of eccentricity 0.5", |_, _| orbits::kepler_half(), 1),
    info("a12_kepler_e09", "A12: an orbit of eccentricity 0.9", |_, _| orbits::kepler_nine_tenths(), 1),
    info("a13_circle", "A13: a charged particle goes round", |_, _| charged::circle(), 1),
    info("a13_drift", "A13: a charged particle drifts across two fields", |_, _| charged::drift(), 1),
    info("a14_arenstorf", "A14: a closed orbit between Earth and Moon", |_, _| orbits::arenstorf(), 1),
    info("a15_pleiades", "A15: seven bodies that attract each other", |_, _| orbits::pleiades(), 7),
    info(
        "a15_henon_heiles",
        "A15: a star in the potential of Hénon and Heiles",
        |_, _| orbits::henon_heiles(),
        1,
    ),
    info("a16_spin", "A16: bars that spin freely", |_, _| charged::spin(), 4),
];

/// The closed forms of those that have one.
pub(super) const FORMS: &[(&str, Form)] = &[
    ("a01_gravity", drag::gravity_at),
    ("a02_linear_drag", drag::linear_drag_at),
    ("a03_quadratic_drop", drag::quadratic_drop_at),
    ("a05_oscillator", oscillator::oscillator_at),
    ("a06_stiff", oscillator::stiff_at),
    ("a07_damped", oscillator::damped_at),
    ("a07_overdamped", oscillator::overdamped_at),
    ("a08_resonance", oscillator::resonance_at),
    ("a09_pendulum", pendulum::pendulum_at),
    ("a10_rod", pendulum::rod_at),
    ("a12_kepler_e05", orbits::kepler_at),
    ("a12_kepler_e09", orbits::kepler_at),
    ("a13_circle", charged::charged_at),
    ("a13_drift", charged::charged_at),
    ("a16_spin", charged::spin_at),
];
