//! Scenes with a reference: the tables as they begin, and the closed forms of the simplest.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

use lamina::cases::{SCENES, by_name, error_of, exact};
use lamina2d::scene::Scene;
use lamina2d::settings::Settings;
use lamina2d::simulation::simulate;

use crate::shared_scenes as scenes;

/// Scenes with a closed form.
const CASES: [&str; 10] = [
    "free_flight/4",
    "spin",
    "pendulum",
    "slide",
    "incline",
    "roll",
    "slide_to_roll",
    "bounce",
    "head_on/2",
    "rod_hit",
];

fn named(name: &str) -> Scene {
    by_name(name, None, 1).unwrap()
}

#[test]
fn every_case_is_taken_in_and_nothing_overlaps_at_first() {
    scenes::are_taken_in_and_overlap_nowhere(SCENES);
}

#[test]
fn seeds_choose_what_is_random_in_cases_and_nothing_else() {
    scenes::differ_by_seed_where_random(SCENES);
}

/// Formula against formula: the pendulum's reference returns after T = 4√(L/g)·K(sin ½θ₀) = 7.4162987·√(L/g) from 90°.
#[test]
fn the_pendulums_reference_has_the_period_of_its_elliptic_integral() {
    let scene = named("pendulum");
    let period = 7.416_298_709_205_49 / 9.81f64.sqrt();
    for quarters in 0..=4 {
        let at = exact(&scene, period * f64::from(quarters) / 4.0).unwrap()[0].position;
        let expected = [[1.0, 0.0], [0.0, -1.0], [-1.0, 0.0], [0.0, -1.0], [1.0, 0.0]][quarters as usize];
        let off = (at[0] - expected[0]).hypot(at[1] - expected[1]);
        assert!(off < 1e-9, "after {quarters} quarters {off} m away");
    }
}

/// Each closed form begins where the scene does and moves on continuously with its velocity.
#[test]
fn closed_forms_begin_as_their_scenes_do() {
    for name in CASES {
        let scene = named(name);
        let (begin, soon) = (exact(&scene, 0.0).unwrap(), exact(&scene, 1e-6).unwrap());
        assert_eq!(begin.len(), scene.movable(), "{name}");
        for (begin, soon) in begin.iter().zip(soon) {
            let spec = &scene.bodies[begin.body];
            assert_eq!(begin.angle, spec.angle, "{name}");
            for axis in 0..2 {
                assert!((begin.position[axis] - spec.position[axis]).abs() < 1e-15, "{name}");
                let speed = (soon.position[axis] - begin.position[axis]) / 1e-6;
                assert!((speed - spec.velocity[axis]).abs() < 1e-4, "{name}: {speed}");
            }
        }
    }
    assert_eq!(exact(&named("stack"), 1.0), None);
}

/// What the default settings make of each case with 4 and with 16 substeps: bounds at most twice what was measured.
/// In `f32` more substeps add more roundings, which is all the error of the smooth cases.
#[test]
fn every_case_is_near_its_closed_form() {
    let mut failed = Vec::new();
    for (name, at_4, at_16) in [
        ("free_flight/4", 2e-5, 1e-4),
        ("spin", 1e-4, 2e-4),
        ("pendulum", 5e-4, 2e-3),
        ("slide", 1e-4, 5e-5),
        ("incline", 5e-5, 5e-6),
        ("roll", 5e-4, 3e-4),
        ("slide_to_roll", 3e-4, 1e-3),
        // When they meet is known to the step only.
        ("bounce", 5e-2, 5e-2),
        ("head_on/2", 5e-2, 5e-2),
        ("rod_hit", 1e-6, 1e-6),
    ] {
        for (substeps, bound) in [(4, at_4), (16, at_16)] {
            let scene = named(name);
            let mut world = simulate(&scene, Settings { substeps, ..Settings::default() }).unwrap();
            for _ in 0..scene.steps {
                world.step(scene.dt_secs).unwrap();
            }
            let error = error_of(world.as_ref(), &scene, scene.steps as f64 * scene.dt_secs).unwrap();
            let line = format!("{name}, {substeps} substeps: {error:.2e}");
            println!("{line}");
            if error.is_nan() || error >= bound {
                failed.push(line);
            }
        }
    }
    assert!(failed.is_empty(), "{failed:#?}");
}
