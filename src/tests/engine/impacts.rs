//! Bodies that pass, and bodies that hit: nothing is touched that would not be, and nothing goes through.

use lamina2d::force::Forces;
use lamina2d::scene::{BodySpec, ShapeSpec};
use lamina2d::settings::{Precision, Settings};
use lamina2d::simulation::{BodyState, Simulation};

use crate::shared_motion::{at_every_width, scene_of, start};

const DT_SECS: f64 = 1.0 / 60.0;

fn advanced(bodies: Vec<BodySpec>, forces: Forces, settings: Settings, steps: usize) -> Box<dyn Simulation> {
    let mut world = start(&scene_of(bodies, forces), settings);
    for _ in 0..steps {
        world.step(DT_SECS).expect("stays finite");
    }
    world
}

/// A ball, a box and a polygon fall past the corner of a block by a gap from 1e-4 of their size on: bit for bit as alone.
#[test]
fn what_passes_a_corner_is_not_touched() {
    for size in [0.0135, 0.1, 1.0] {
        let shapes = [
            ShapeSpec::Circle(size),
            ShapeSpec::Box([size, 0.6 * size]),
            ShapeSpec::Polygon(vec![[-size, -0.5 * size], [size, -0.5 * size], [0.0, size]]),
        ];
        for shape in shapes {
            for gap in [1e-3 * size, 0.04 * size, 0.3 * size] {
                for speed in [0.0, 1.0, 20.0] {
                    let wall = BodySpec::new(ShapeSpec::Box([5.0, 1.0]), [-5.0 - size - gap, -2.0]).fixed();
                    let falls =
                        BodySpec::new(shape.clone(), [0.0, 0.0]).surface(0.9, 0.5).moving([0.0, -speed], 0.0);
                    let forces = Forces::gravity();
                    let alone = advanced(vec![falls.clone()], forces, Settings::default(), 50).states()[0];
                    let past = advanced(vec![falls, wall], forces, Settings::default(), 50).states()[0];
                    assert!(
                        past.velocity[0].abs() < 1e-9 && past.position[0].abs() < 1e-9,
                        "{shape:?} {gap}: {past:?}"
                    );
                    assert!(
                        (past.position[1] - alone.position[1]).abs() < 1e-4 * size,
                        "{shape:?} {gap}: {past:?}"
                    );
                }
            }
        }
    }
}

/// Momentum and, as e says, energy of a bullet and a thin plate that is free to move, at places all along a step's stride.
#[test]
fn bullets_hit_plates_that_are_free() {
    for e in [0.0, 0.5, 1.0] {
        for (mass, speed) in [(0.05, 300.0), (1.0, 60.0), (20.0, 120.0)] {
            for place in 0..10 {
                let x = 2.0 + f64::from(place) / 10.0 * speed * DT_SECS;
                let plate = BodySpec::new(ShapeSpec::Box([0.05, 1.0]), [x, 0.0]).mass(1.0).surface(e, 0.0);
                let shot = BodySpec::new(ShapeSpec::Circle(0.02), [0.0; 2]).mass(mass).surface(e, 0.0);
                let bodies = vec![plate, shot.moving([speed, 0.0], 0.0)];
                let world = advanced(bodies, Forces::default(), Settings::default(), 20);
                let [a, b]: [BodyState; 2] = [world.states()[0], world.states()[1]];
                let together = mass * speed / (1.0 + mass);
                let right = [together * (1.0 + e), together - e * speed / (1.0 + mass)];
                for (found, right) in [a.velocity[0], b.velocity[0]].into_iter().zip(right) {
                    let off = (found - right).abs() / speed;
                    assert!(off < 2e-3, "e {e}, {mass} kg at {speed}: {found} instead of {right} m/s at {x}");
                }
                assert!(b.position[0] < a.position[0], "through: {a:?} {b:?}");
            }
        }
    }
}

/// A ball to and fro between two walls, several times a step: neither energy nor way is lost.
#[test]
fn a_fast_ball_loses_no_time_at_walls() {
    for speed in [60.0, 300.0, 3000.0] {
        let wall = |x: f64| BodySpec::new(ShapeSpec::Box([0.5, 5.0]), [x, 0.0]).surface(1.0, 0.0).fixed();
        let ball = BodySpec::new(ShapeSpec::Circle(0.1), [0.0; 2]).mass(1.0).surface(1.0, 0.0);
        let bodies = vec![wall(-5.5), wall(5.5), ball.moving([speed, 0.0], 0.0)];
        let settings = Settings::default().with_precision(Precision::F64);
        let world = advanced(bodies, Forces::default(), settings, 240);
        let state = world.states()[2];
        assert!((state.velocity[0].abs() / speed - 1.0).abs() < 1e-9, "{state:?}");
        // Unfolded: a way of 4 s at that speed, between centres at ±4.9 m.
        let way = (speed * 4.0 + 4.9).rem_euclid(2.0 * 9.8);
        let right = if way < 9.8 { way - 4.9 } else { 9.8 - way + 4.9 };
        assert!(
            (state.position[0] - right).abs() < 2e-3 * speed,
            "{speed}: {} instead of {right}",
            state.position[0]
        );
    }
}

/// Three balls in a row, the first fast: Newton's cradle within a step, at every width alike.
#[test]
fn impacts_within_a_step_go_on_in_their_order() {
    let ball = |x: f64| BodySpec::new(ShapeSpec::Circle(0.1), [x, 0.0]).mass(1.0).surface(1.0, 0.0);
    let mut ends = Vec::new();
    for settings in at_every_width(Settings::default()) {
        let bodies = vec![ball(0.0).moving([200.0, 0.0], 0.0), ball(5.0), ball(5.5), ball(6.1)];
        let world = advanced(bodies, Forces::default(), settings, 10);
        let speeds: Vec<f64> = world.states().iter().map(|state| state.velocity[0]).collect();
        assert!(speeds[..3].iter().all(|v| v.abs() < 0.5) && (speeds[3] - 200.0).abs() < 0.5, "{speeds:?}");
        ends.push((settings.precision, world.hash()));
    }
    assert!(ends.iter().all(|end| ends.iter().all(|other| end.0 != other.0 || end == other)), "{ends:?}");
}

/// What is heavy falls onto what is light, whatever the ratio, their shapes and how many there are: they are solved at once, and
/// nothing ends in anything else.
#[test]
fn what_is_heavy_does_not_crush_what_is_light() {
    let shapes = [ShapeSpec::Box([0.5; 2]), ShapeSpec::Circle(0.5)];
    for (shape, ratio, light) in shapes.iter().flat_map(|shape| {
        [100.0, 1e3, 1e4, 1e5].into_iter().flat_map(move |ratio| [1, 3].map(|light| (shape, ratio, light)))
    }) {
        // In a shaft, so that discs stay on each other.
        let wall = |x: f64| BodySpec::new(ShapeSpec::Box([0.5, 5.0]), [x, 5.0]).fixed().surface(0.0, 0.0);
        let one = |y: f64| BodySpec::new(shape.clone(), [0.0, y]);
        let floor = BodySpec::new(ShapeSpec::Box([5.0, 0.5]), [0.0, -0.5]).fixed();
        let mut bodies = vec![floor, wall(-1.01), wall(1.01)];
        bodies.extend((0..light).map(|k| one(0.5 + f64::from(k)).mass(1.0)));
        bodies.push(one(f64::from(light) + 2.5).mass(ratio));
        let count = light as usize + 1;
        let world = advanced(bodies, Forces::gravity(), Settings::default(), 300);
        for (k, state) in world.states().iter().skip(3).enumerate() {
            let y = state.position[1];
            assert!((y - 0.5 - k as f64).abs() < 2e-3, "{shape:?}, {ratio}:1 on {light}: {k} at {y}");
        }
        assert!(world.counts().direct_contacts >= count, "{:?}", world.counts());
    }
}

/// Bodies that meet in a line, the light one between, come out with the momenta of plastic impacts, and what they had together.
#[test]
fn light_bodies_between_heavy_ones_leave_their_momentum_alone() {
    for (left, light, right) in [(1e2, 1.0, 1e2), (1e4, 1.0, 1e4), (1e5, 1.0, 1e3), (1.0, 1e-3, 10.0)] {
        let one = |x: f64, mass: f64, v: f64| {
            let body = BodySpec::new(ShapeSpec::Box([0.5; 2]), [x, 0.0]).mass(mass);
            body.surface(0.0, 0.0).moving([v, 0.0], 0.0)
        };
        let bodies = vec![one(-3.0, left, 6.0), one(0.0, light, 0.0), one(3.0, right, -6.0)];
        let world = advanced(bodies, Forces::default(), Settings::default(), 120);
        let mean = 6.0 * (left - right) / (left + light + right);
        for state in world.states() {
            assert!(
                (state.velocity[0] - mean).abs() < 1e-3,
                "{left}, {light}, {right}: {state:?}, not {mean}"
            );
        }
    }
}

/// A heavy plank falls onto a light disc and a light box as high: one contact has one point, the other two, and both bear it.
#[test]
fn contacts_of_one_and_of_two_points_are_solved_together() {
    for ratio in [100.0, 1e4] {
        let floor = BodySpec::new(ShapeSpec::Box([5.0, 0.5]), [0.0, -0.5]).fixed();
        let wedge = |x: f64| BodySpec::new(ShapeSpec::Box([0.1, 0.1]), [x, 0.1]).fixed().surface(0.0, 0.0);
        let bodies = vec![
            floor,
            // Keep the disc from rolling.
            wedge(-1.85),
            wedge(-1.15),
            BodySpec::new(ShapeSpec::Circle(0.25), [-1.5, 0.25]).mass(1.0),
            BodySpec::new(ShapeSpec::Box([0.25, 0.25]), [1.5, 0.25]).mass(1.0),
            BodySpec::new(ShapeSpec::Box([2.0, 0.2]), [0.0, 1.2]).mass(ratio),
        ];
        let world = advanced(bodies, Forces::gravity(), Settings::default(), 300);
        let (states, right) = (world.states(), [0.25, 0.25, 0.7]);
        for (state, right) in states[3..].iter().zip(right) {
            assert!((state.position[1] - right).abs() < 2e-3, "{ratio}: {state:?}");
        }
        let plank = states[5];
        assert!(plank.rotation[1].abs() < 2e-3 && plank.velocity[1].abs() < 1e-3, "{ratio}: {plank:?}");
        assert!(world.counts().direct_contacts >= 4, "{:?}", world.counts());
    }
}
