//! Bodies that hit bodies, at any speed and ratio of masses.
//!
//! Along the line of centres: v₁′ = (m₁ − e·m₂)v/(m₁ + m₂), v₂′ = (1 + e)m₁·v/(m₁ + m₂).

use lamina2d::joint::{JointKind, JointSpec, Weld};

use super::case::{Case, Column, Expect, G, What, disc, floor, rectangle};

/// A bullet of so many kg at 300 m/s hits a plate of 1 kg in its middle.
fn bullet(mass: f64, restitution: f64) -> Case {
    let plate = rectangle([0.05, 1.0], [0.0, 0.0]).mass(1.0).surface(restitution, 0.0);
    let ball = disc(0.02, [-12.0, 0.0]).mass(mass).surface(restitution, 0.0).moving([300.0, 0.0], 0.0);
    let both = mass + 1.0;
    let of_plate = (1.0 + restitution) * mass * 300.0 / both;
    let of_ball = (mass - restitution) * 300.0 / both;
    let name = format!("bullet of {mass} kg at 300 m/s against 1 kg, e = {restitution}");
    Case::new(name, vec![plate, ball], 0.2)
        .weightless()
        .end(0, Column::Vx, of_plate, 0.01 * 300.0 * mass.min(1.0))
        .end(1, Column::Vx, of_ball, 3.0)
        .expect(What::Momentum(0), 300.0 * mass, 1e-3 * 300.0 * mass)
}

/// Two discs head on, one of them heavier.
fn head_on(ratio: f64) -> Case {
    let one =
        |x: f64, v: f64, mass: f64| disc(0.1, [x, 0.0]).mass(mass).surface(1.0, 0.0).moving([v, 0.0], 0.0);
    let (heavy, light, v) = (ratio, 1.0, 50.0);
    let relative = 2.0 * v;
    let of_light = -v + 2.0 * heavy * relative / (heavy + light);
    let of_heavy = v - 2.0 * light * relative / (heavy + light);
    Case::new(format!("head on, {ratio} to 1, e = 1"), vec![one(-2.0, v, heavy), one(2.0, -v, light)], 0.1)
        .weightless()
        .end(0, Column::Vx, of_heavy, 0.01 * v)
        .end(1, Column::Vx, of_light, 0.01 * relative)
        .expect(What::Kinetic, 0.5 * (heavy + light) * v * v, 0.005 * (heavy + light) * v * v)
}

/// An elastic disc to and fro between two faces, ten metres apart, for ten seconds.
fn room(speed: f64) -> Case {
    let wall = |x: f64| rectangle([0.5, 2.0], [x, 0.0]).surface(1.0, 0.0).fixed();
    let ball = disc(0.1, [0.0, 0.0]).mass(1.0).surface(1.0, 0.0).moving([speed, 0.0], 0.0);
    let (inner, way) = (9.8, speed * 10.0);
    // Unfolded: how far along the way to and fro.
    let folded = (way + 0.5 * inner).rem_euclid(2.0 * inner);
    let x = if folded < inner { folded - 0.5 * inner } else { 1.5 * inner - folded };
    let v = if folded < inner { speed } else { -speed };
    Case::new(format!("disc to and fro at {speed} m/s"), vec![wall(-5.5), wall(5.5), ball], 10.0)
        .weightless()
        .end(2, Column::X, x, 0.002 * speed)
        .end(2, Column::Vx, v, 0.002 * speed)
        .expect(What::KineticAlways, 0.5 * speed * speed, 1e-3 * speed * speed)
}

/// A heavy box falls two metres onto a light one that lies on the floor.
fn drop(ratio: f64) -> Case {
    let half = [0.5; 2];
    let bodies =
        vec![floor(50.0), rectangle(half, [0.0, 0.5]).mass(1.0), rectangle(half, [0.0, 3.5]).mass(ratio)];
    Case::new(format!("{ratio} kg fall 2 m onto 1 kg"), bodies, 10.0)
        .end(1, Column::Y, 0.5, 0.02)
        .end(2, Column::Y, 1.5, 0.02)
        .end(1, Column::X, 0.0, 0.02)
}

/// So many kg fall two metres onto something of a kilogram each that stands on the floor: `at` and half-extents of each, and the
/// half-extents of what falls, `aside` of the middle. All stays where rigid bodies would.
fn crush(what: &str, light: &[[f64; 2]], half: [f64; 2], aside: f64, mass: f64) -> Case {
    let top = light.iter().map(|at| at[1] + 0.5).fold(0.0, f64::max);
    let mut bodies = vec![floor(50.0)];
    bodies.extend(light.iter().map(|&at| rectangle([0.5; 2], at).mass(1.0)));
    bodies.push(rectangle(half, [aside, top + 2.0 + half[1]]).mass(mass));
    let falls = bodies.len() - 1;
    let case = Case::new(format!("{mass} kg fall 2 m onto {what} of 1 kg"), bodies, 10.0);
    let case = light
        .iter()
        .enumerate()
        .fold(case, |case, (k, &[x, y])| case.end(k + 1, Column::X, x, 0.02).end(k + 1, Column::Y, y, 0.02));
    case.end(falls, Column::Y, top + half[1], 0.02).end(falls, Column::X, aside, 0.02)
}

/// Two heavy boxes meet with a light one between them, plastically: all go on at the mean, one behind the other.
fn squeezed(mass: f64) -> Case {
    let one = |x: f64, mass: f64, v: f64| {
        rectangle([0.5; 2], [x, 0.0]).mass(mass).surface(0.0, 0.0).moving([v, 0.0], 0.0)
    };
    let (speed, first) = (-10.0 * mass / (2.0 * mass + 1.0), -10.0 * mass / (mass + 1.0));
    // The light one is met after 2.8 m, and goes 0.2 m with what has met it.
    let x = speed * (5.0 - 2.8 / 10.0 + 0.2 / first);
    let bodies = vec![one(0.0, mass, 0.0), one(1.2, 1.0, 0.0), one(5.0, mass, -10.0)];
    let case = Case::new(format!("1 kg between {mass} kg and {mass} kg at 10 m/s, e = 0"), bodies, 5.0);
    let case = case.weightless().expect(What::Momentum(0), -10.0 * mass, 1e-3 * mass);
    (0..3).fold(case, |case, body| {
        case.end(body, Column::Vx, speed, 0.01).end(body, Column::X, x + body as f64, 0.02)
    })
}

/// A disc hits a windmill of four rotors welded to a hub, plastically.
///
/// I = ½·M·R² + 4·(m·(w² + h²)/3 + m·8²) about the hub; the impulse is v/(1/m + 1/M + arm²/I).
fn windmill() -> Case {
    let smooth = |body: lamina2d::scene::BodySpec| body.surface(0.0, 0.0);
    let rotors = [
        ([3.0, 0.5], [8.0, 0.0]),
        ([3.0, 0.5], [-8.0, 0.0]),
        ([0.5, 3.0], [0.0, 8.0]),
        ([0.5, 3.0], [0.0, -8.0]),
    ];
    let mut bodies = vec![smooth(disc(5.0, [0.0, 0.0]))];
    bodies.extend(rotors.map(|(half, at)| smooth(rectangle(half, at))));
    bodies.push(smooth(disc(0.25, [-3.0, 10.0])).mass(1.0).moving([5.0, 0.0], 0.0));
    let anchors = [[5.0, 0.0], [-5.0, 0.0], [0.0, 5.0], [0.0, -5.0]];
    let weld = |(k, anchor)| JointSpec::new(0, k + 1, JointKind::Weld(Weld { anchor, spring: None }));
    let joints = anchors.into_iter().enumerate().map(weld).collect();
    let hub = std::f64::consts::PI * 25.0;
    let (mass, inertia) = (hub + 24.0, 0.5 * hub * 25.0 + 4.0 * (6.0 * 9.25 / 3.0 + 6.0 * 64.0));
    let impulse = 5.0 / (1.0 + 1.0 / mass + 100.0 / inertia);
    let energy = 12.5 - 0.5 * impulse * 5.0;
    Case::new("disc against a welded windmill, e = 0".to_owned(), bodies, 10.0)
        .weightless()
        .joined(joints)
        .expect(What::Kinetic, energy, 0.05 * energy)
        .expect(What::Momentum(0), 5.0, 0.01)
        .expect(What::AngularMomentum, -50.0, 0.1)
}

/// A disc falls onto the floor from so high, with so much restitution: it rises to e²·h.
fn bounce(height: f64, e: f64) -> Case {
    let ball = disc(0.1, [0.0, 0.1 + height]).mass(1.0).surface(e, 0.0);
    let fall_secs = (2.0 * height / G).sqrt();
    let rise_secs = e * fall_secs;
    let steps = ((fall_secs + rise_secs) * 60.0).round();
    let late = steps / 60.0 - fall_secs - rise_secs;
    let bodies = vec![floor(5.0).surface(1.0, 0.0), ball];
    Case::new(format!("disc falls {height} m, e = {e}"), bodies, steps / 60.0)
        .end(1, Column::Y, 0.1 + e * e * height - 0.5 * G * late * late, 0.02 * height)
        .holds(Expect::near(What::Body { body: 1, column: Column::X, step: steps as u64 }, 0.0, 1e-4))
}

pub(super) fn cases() -> Vec<Case> {
    let bullets = [0.05, 0.5, 5.0].into_iter().flat_map(|mass| [0.0, 0.5, 1.0].map(|e| bullet(mass, e)));
    let drops = [10.0, 100.0, 1000.0, 10_000.0, 100_000.0].map(drop);
    let stack = [0.5, 1.5, 2.5, 3.5].map(|y| [0.0, y]);
    let crushed = [100.0, 10_000.0].into_iter().flat_map(|mass| {
        [
            crush("four boxes on each other", &stack, [0.5; 2], 0.0, mass),
            crush("two boxes", &[[-1.5, 0.5], [1.5, 0.5]], [2.5, 0.5], 0.0, mass),
            crush("a box, aside of its middle,", &stack[..1], [0.5; 2], 0.2, mass),
        ]
    });
    let bounces = [(1.0, 1.0), (1.0, 0.5), (20.0, 1.0), (20.0, 0.5)].map(|(height, e)| bounce(height, e));
    bullets
        .chain([1.0, 100.0, 1e5].map(head_on))
        .chain([30.0, 300.0, 1000.0].map(room))
        .chain(drops)
        .chain(crushed)
        .chain([100.0, 10_000.0, 100_000.0].map(squeezed))
        .chain([windmill()])
        .chain(bounces)
        .collect()
}
