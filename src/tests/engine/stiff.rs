//! Fields of any strength: what a substep of a scheme cannot follow is advanced by what the fields do exactly.

use lamina2d::force::{Forces, Spring};
use lamina2d::scene::{BodySpec, Scene, ShapeSpec};
use lamina2d::settings::{Integrator, Precision, Settings, Skips};
use lamina2d::simulation::Simulation;

use crate::shared_motion::{at_every_width, disc, scene_of, start};

const DT_SECS: f64 = 1.0 / 60.0;

fn one(forces: Forces, position: [f64; 2], velocity: [f64; 2]) -> Scene {
    scene_of(vec![disc(position).mass(1.0).moving(velocity, 0.0)], forces)
}

fn schemes() -> Vec<Settings> {
    let mut all = Vec::new();
    for &precision in Precision::ALL {
        for &integrator in Integrator::ALL {
            let lanes = Settings::widths(precision)[0];
            all.push(Settings { integrator, precision, lanes, ..Settings::default() });
        }
    }
    all
}

fn advanced(scene: &Scene, settings: Settings, steps: usize) -> Box<dyn Simulation> {
    let mut world = start(scene, settings);
    for _ in 0..steps {
        world.step(DT_SECS).expect("stays finite");
    }
    world
}

/// v = g/k·(1 − e^(−k·t)) for 1 kg under drag and weight.
#[test]
fn what_falls_through_thick_air_has_its_terminal_speed() {
    for k in [400.0, 500.0, 2e3, 1e5, 1e8] {
        let forces = Forces { linear_drag: Some(k), ..Forces::gravity() };
        for settings in schemes() {
            let world = advanced(&one(forces, [0.0; 2], [0.0; 2]), settings, 120);
            let state = world.states()[0];
            let (v, y) = (-9.81 / k, -9.81 / k * (2.0 - 1.0 / k));
            let tolerance = if settings.precision == Precision::F32 { 2e-6 } else { 1e-12 };
            assert!((state.velocity[1] / v - 1.0).abs() < tolerance, "{k} {settings:?}: {state:?}");
            assert!((state.position[1] / y - 1.0).abs() < 100.0 * tolerance, "{k} {settings:?}: {state:?}");
            assert_eq!(world.counts().stiff, 1, "{k}");
        }
    }
}

/// k·v² = g: the terminal speed of quadratic drag, from rest and from far above it.
#[test]
fn quadratic_drag_of_any_strength_ends_at_its_terminal_speed() {
    for k in [1.0, 1e2, 1e4, 1e6, 1e9] {
        let terminal = (9.81f64 / k).sqrt();
        for begin in [0.0, -20.0, -1e4] {
            let forces = Forces { quadratic_drag: Some(k), ..Forces::gravity() };
            for settings in schemes() {
                let world = advanced(&one(forces, [0.0; 2], [0.0, begin]), settings, 240);
                let found = -world.states()[0].velocity[1];
                assert!((found / terminal - 1.0).abs() < 1e-3, "{k} from {begin} {settings:?}: {found}");
            }
        }
    }
}

/// x = cos(ωt): an oscillator that turns many times within a substep keeps energy and phase.
#[test]
fn a_spring_of_any_stiffness_swings_as_it_should() {
    for k in [6e5, 1e6, 1e9] {
        let forces =
            Forces { spring: Some(Spring { anchor: [0.2, -0.3], stiffness: k }), ..Forces::default() };
        let scene = one(forces, [1.2, -0.3], [0.0; 2]);
        for settings in schemes() {
            let mut world = start(&scene, settings);
            let energy = 0.5 * k;
            for step in 1..=240 {
                world.step(DT_SECS).expect("stays finite");
                let now = world.invariants();
                let sum = now.kinetic_energy + now.potential_energy;
                let drift = (sum / energy - 1.0).abs();
                let most = if settings.precision == Precision::F32 { 2e-3 } else { 1e-13 * k };
                assert!(drift < most, "{k} {settings:?} step {step}: {drift:e}");
            }
            if settings.precision == Precision::F64 {
                let x = world.states()[0].position[0] - 0.2;
                let right = (k.sqrt() * 240.0 * DT_SECS).cos();
                assert!((x - right).abs() < 1e-12 * k, "{k} {settings:?}: {x} instead of {right}");
            }
        }
    }
}

/// A magnetic field turns the velocity and does no work, whatever its strength.
#[test]
fn a_magnetic_field_does_no_work() {
    for q in [300.0, 2e3, 1e6] {
        let forces = Forces { magnetic: Some(q), ..Forces::default() };
        for settings in schemes() {
            let world = advanced(&one(forces, [0.0; 2], [1.0, 0.0]), settings, 240);
            let [vx, vy] = world.states()[0].velocity;
            assert!((vx.hypot(vy) - 1.0).abs() < 1e-4, "{q} {settings:?}: {vx} {vy}");
            let place = world.states()[0].position;
            assert!(place[0].hypot(place[1]) <= 2.0 / q * 1.001 + 1e-6, "{q} {settings:?}: {place:?}");
        }
    }
}

/// All at once, with what no scheme has to fear beside: the same bits at every width, with and without skips.
#[test]
fn stiff_bodies_have_the_same_bits_at_every_width() {
    let forces = Forces {
        linear_drag: Some(3.0),
        quadratic_drag: Some(40.0),
        spring: Some(Spring { anchor: [0.0, 1.0], stiffness: 2e5 }),
        magnetic: Some(30.0),
        wind: Some([0.5, 0.0]),
        ..Forces::gravity()
    };
    // Of light bodies, which are stiff, and heavy ones, which are not, on a floor.
    let bodies = (0..11).map(|k| {
        let at = [f64::from(k) * 0.5 - 2.5, 1.0 + 0.1 * f64::from(k)];
        BodySpec::new(ShapeSpec::Box([0.1, 0.1]), at).mass(10f64.powi(k - 3))
    });
    let floor = BodySpec::new(ShapeSpec::Box([20.0, 0.5]), [0.0, -0.5]).fixed();
    let scene = scene_of(std::iter::once(floor).chain(bodies).collect(), forces);
    let mut ends: Vec<(Precision, u64)> = Vec::new();
    for settings in at_every_width(Settings::default()) {
        for skips in [Skips::ALL, Skips::NONE] {
            let mut world = start(&scene, Settings { skips, ..settings });
            let mut stiff = 0;
            for _ in 0..120 {
                world.step(DT_SECS).expect("stays finite");
                stiff = stiff.max(world.counts().stiff);
            }
            assert!((1..11).contains(&stiff), "{stiff} stiff bodies");
            if skips == Skips::ALL {
                ends.push((settings.precision, world.hash()));
            }
        }
    }
    assert!(ends.iter().all(|end| ends.iter().all(|other| end.0 != other.0 || end == other)), "{ends:?}");
}

/// A body that its scheme can follow keeps its bits: the limit is not passed by a field that is merely there.
#[test]
fn slow_fields_are_left_to_the_scheme() {
    let forces = Forces {
        linear_drag: Some(50.0),
        spring: Some(Spring { anchor: [0.0; 2], stiffness: 1e3 }),
        magnetic: Some(8.0),
        ..Forces::gravity()
    };
    for settings in schemes() {
        let world = advanced(&one(forces, [1.0, 0.0], [0.0; 2]), settings, 60);
        assert_eq!(world.counts().stiff, 0, "{settings:?}");
    }
}
