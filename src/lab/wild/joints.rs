//! Joints under load: what hangs or stands on them stays where it is; what they guide keeps its energy.

use lamina2d::joint::{Distance, JointKind, JointSpec, Limits, Motor, Revolute, Weld};
use lamina2d::settings::Solver;

use super::case::{Case, Column, G, What, disc, rectangle};

fn rod(a: usize, b: usize) -> JointSpec {
    JointSpec::new(a, b, JointKind::Distance(Distance::default()))
}

fn weld(a: usize, b: usize, anchor: [f64; 2]) -> JointSpec {
    JointSpec::new(a, b, JointKind::Weld(Weld { anchor, spring: None }))
}

/// `n` rods of half a metre with discs of 0.1 kg between them hang straight, with a load at the end: nothing moves.
fn chain(n: usize, load: f64) -> Case {
    let bead = |k: usize| disc(0.1, [0.0, -0.5 * k as f64]).mass(if k == n { load } else { 0.1 });
    let bodies = std::iter::once(disc(0.1, [0.0, 0.0]).fixed()).chain((1..=n).map(bead)).collect();
    let joints = (0..n).map(|k| rod(k, k + 1)).collect();
    let long = 0.5 * n as f64;
    Case::new(format!("{load} kg on a chain of {n} rods"), bodies, 10.0)
        .joined(joints)
        .end(n, Column::Y, -long, 0.01 * long)
        .end(n, Column::X, 0.0, 0.01 * long)
}

/// `n` hinged links of half a metre hang straight, with a load at the end.
fn hinges(n: usize, load: f64) -> Case {
    let link = |k: usize| rectangle([0.05, 0.25], [0.0, -0.25 - 0.5 * k as f64]).mass(0.1);
    let mut bodies = vec![disc(0.05, [0.0, 0.05]).fixed()];
    bodies.extend((0..n).map(link));
    bodies.push(disc(0.3, [0.0, -0.5 * n as f64 - 0.3]).mass(load));
    let joints = (0..=n).map(|k| JointSpec::new(k, k + 1, JointKind::hinge([0.0, -0.5 * k as f64])));
    let joints = joints.collect();
    Case::new(format!("{load} kg on a chain of {n} hinges"), bodies, 10.0).joined(joints).end(
        n + 1,
        Column::Y,
        -0.5 * n as f64 - 0.3,
        0.005 * n as f64,
    )
}

/// `n` boxes welded on each other and on the floor, with 100 kg welded on, 0.4 m off the axis: a rigid body.
fn tower(n: usize) -> Case {
    let mut bodies = vec![rectangle([5.0, 0.5], [0.0, -0.5]).fixed()];
    bodies.extend((0..n).map(|k| rectangle([0.5; 2], [0.0, 0.5 + k as f64]).mass(1.0)));
    bodies.push(rectangle([0.5; 2], [0.4, 0.5 + n as f64]).mass(100.0));
    let joints = (0..=n).map(|k| weld(k, k + 1, [0.0, k as f64])).collect();
    Case::new(format!("100 kg off the axis of {n} welded boxes"), bodies, 10.0)
        .joined(joints)
        .end(n + 1, Column::X, 0.4, 0.05)
        .end(n + 1, Column::Y, 0.5 + n as f64, 0.05)
}

/// 500 kg on two chains of hinged links: a loop through the ground.
fn platform(n: usize) -> Case {
    let high = 0.5 * n as f64;
    let mut bodies = vec![
        disc(0.05, [-1.5, high]).fixed(),
        disc(0.05, [1.5, high]).fixed(),
        rectangle([2.0, 0.1], [0.0, 0.0]).mass(500.0),
    ];
    let mut joints = Vec::new();
    for (end, x) in [(0, -1.5), (1, 1.5)] {
        let first = bodies.len();
        bodies.extend((0..n).map(|k| rectangle([0.05, 0.25], [x, 0.25 + 0.5 * k as f64]).mass(0.1)));
        let body = |k: usize| match k {
            0 => 2,
            k if k > n => end,
            k => first + k - 1,
        };
        let hinge = |k: usize| JointSpec::new(body(k), body(k + 1), JointKind::hinge([x, 0.5 * k as f64]));
        joints.extend((0..=n).map(hinge));
    }
    Case::new(format!("500 kg on two chains of {n} links"), bodies, 10.0)
        .joined(joints)
        .end(2, Column::Y, 0.0, 0.01 * high)
        .end(2, Column::X, 0.0, 0.01 * high)
        .end(2, Column::Angle, 0.0, 0.01)
}

/// A truss of `bays` squares of a metre, of rods with a tenth of a kilogram at each node, pinned at both lower ends, with a load in
/// the middle of its upper chord: rigid. `crossed`: both diagonals of each bay, of which one is more than it takes.
fn truss(bays: usize, load: f64, crossed: bool) -> Case {
    let nodes = bays + 1;
    let middle = nodes + bays / 2;
    let node = |k: usize| {
        let at = [(k % nodes) as f64, (k / nodes) as f64];
        let one = disc(0.1, at);
        if k == 0 || k == bays { one.fixed() } else { one.mass(if k == middle { load } else { 0.1 }) }
    };
    let bodies = (0..2 * nodes).map(node).collect();
    let mut joints: Vec<_> = (0..nodes).map(|k| rod(k, nodes + k)).collect();
    for k in 0..bays {
        joints.extend([rod(k, k + 1), rod(nodes + k, nodes + k + 1), rod(k, nodes + k + 1)]);
        joints.extend(crossed.then(|| rod(k + 1, nodes + k)));
    }
    let with = if crossed { "both diagonals" } else { "a diagonal" };
    Case::new(format!("{load} kg on a truss of {bays} bays with {with}"), bodies, 10.0)
        .joined(joints)
        .end(middle, Column::Y, 1.0, 2e-3 * bays as f64)
        .end(middle, Column::X, (bays / 2) as f64, 2e-3 * bays as f64)
}

/// A ring of eight welded boxes hangs from its topmost with a load at its lowest: one body.
fn welded_ring(load: f64) -> Case {
    let turn = std::f64::consts::TAU / 8.0;
    let radius = 0.5 / (0.5 * turn).sin();
    let at = |k: f64| [-radius * (k * turn).sin(), radius * (k * turn).cos()];
    let link = |k: usize| {
        let mut one = rectangle([0.4, 0.1], at(k as f64));
        one.angle = k as f64 * turn;
        if k == 0 { one.fixed() } else { one.mass(if k == 4 { load } else { 0.5 }) }
    };
    let joints = (0..8).map(|k| weld(k, (k + 1) % 8, at(k as f64 + 0.5))).collect();
    Case::new(format!("{load} kg on a ring of eight welded boxes"), (0..8).map(link).collect(), 10.0)
        .joined(joints)
        .end(4, Column::Y, -radius, 0.02)
        .end(4, Column::X, 0.0, 0.02)
}

/// A net of rods, half a metre wide each, hung from its upper row, with a load in the middle of its lowest.
fn net(side: usize, load: f64) -> Case {
    let (loaded, deep) = (side * side - 1 - side / 2, 0.5 * (side - 1) as f64);
    let node = |k: usize| {
        let one = disc(0.1, [0.5 * (k % side) as f64, -0.5 * (k / side) as f64]);
        if k < side { one.fixed() } else { one.mass(if k == loaded { load } else { 0.1 }) }
    };
    let right = |k: &usize| *k >= side && k % side + 1 < side;
    let mut joints: Vec<_> = (0..side * side).filter(right).map(|k| rod(k, k + 1)).collect();
    joints.extend((0..side * (side - 1)).map(|k| rod(k, k + side)));
    let x = 0.5 * (loaded % side) as f64;
    Case::new(format!("{load} kg on a net of {side} by {side}"), (0..side * side).map(node).collect(), 10.0)
        .joined(joints)
        .end(loaded, Column::Y, -deep, 0.01 * deep)
        .end(loaded, Column::X, x, 0.01 * deep)
}

/// A chain of `n` rods with a load at its end, all in a line let go at 0.04 rad: it swings as one, by the load's period.
fn swung(n: usize, load: f64) -> Case {
    let angle = 0.04f64;
    let at = |k: usize| [0.5 * k as f64 * angle.sin(), -0.5 * k as f64 * angle.cos()];
    let bead = |k: usize| disc(0.1, at(k)).mass(if k == n { load } else { 0.1 });
    let bodies = std::iter::once(disc(0.1, [0.0, 0.0]).fixed()).chain((1..=n).map(bead)).collect();
    let long = 0.5 * n as f64;
    let secs: f64 = 5.0;
    // 1 + a²/16 of the period.
    let phase = secs * (G / long).sqrt() / (1.0 + angle * angle / 16.0);
    Case::new(format!("{load} kg swing on a chain of {n} rods"), bodies, secs)
        .joined((0..n).map(|k| rod(k, k + 1)).collect())
        .end(n, Column::X, long * (angle * phase.cos()).sin(), 0.02 * long * angle)
        .end(n / 2, Column::X, 0.5 * long * (angle * phase.cos()).sin(), 0.02 * long * angle)
}

/// An arm of half a metre and so many kg lies on the lower limit of its hinge.
fn limit(mass: f64) -> Case {
    let bodies = vec![disc(0.02, [0.0, 0.0]).fixed(), rectangle([0.5, 0.05], [0.5, 0.0]).mass(mass)];
    let limits = Some(Limits { lower: -0.5, upper: 0.5 });
    let hinge = JointKind::Revolute(Revolute { anchor: [0.0; 2], motor: None, limits });
    let (s, c) = 0.5f64.sin_cos();
    Case::new(format!("{mass} kg on a limit of -0.5 rad"), bodies, 10.0)
        .joined(vec![JointSpec::new(0, 1, hinge)])
        .end(1, Column::X, 0.5 * c, 0.005)
        .end(1, Column::Y, -0.5 * s, 0.005)
}

/// A motor holds its speed against a weight, if its torque is enough: m·g·r = 4.9 N·m.
fn motor(max_torque: f64) -> Case {
    let bodies = vec![disc(0.02, [0.0, 0.0]).fixed(), rectangle([0.5, 0.05], [0.5, 0.0]).mass(1.0)];
    let motor = Some(Motor { speed: 2.0, max_torque });
    let hinge = JointKind::Revolute(Revolute { anchor: [0.0; 2], motor, limits: None });
    Case::new(format!("motor of {max_torque} N·m lifts an arm at 2 rad/s"), bodies, 10.0)
        .joined(vec![JointSpec::new(0, 1, hinge)])
        .end(1, Column::W, 2.0, 0.02)
}

/// Two discs on a rod turn about each other without gravity: L = 2·m·r·v, ½·m·v² each.
fn dumbbell(solver: Solver) -> Case {
    let one = |side: f64| disc(0.1, [0.5 * side, 0.0]).mass(1.0).moving([0.0, 5.0 * side], 0.0);
    let case = Case::new(format!("dumbbell, {solver}"), vec![one(1.0), one(-1.0)], 60.0)
        .weightless()
        .joined(vec![rod(0, 1)])
        .expect(What::AngularMomentum, 5.0, 0.05)
        .expect(What::Kinetic, 25.0, 0.5);
    Case { solver: Some(solver), ..case }
}

/// A ball on a rod bounces to and fro between both sides of a wall, elastically: an ideal rod does no work.
fn bounces(secs: f64) -> Case {
    let still = |body: lamina2d::scene::BodySpec| body.surface(1.0, 0.0).fixed();
    let bodies = vec![
        still(disc(0.05, [0.0, 0.0])),
        still(rectangle([1.0, 0.05], [-2.0, 0.0])),
        disc(0.25, [2.0, 0.0]).mass(1.0).surface(1.0, 0.0).moving([0.0, 3.0], 0.0),
    ];
    Case::new(format!("ball on a rod bounces off a wall for {secs} s"), bodies, secs)
        .weightless()
        .joined(vec![rod(0, 2)])
        .expect(What::KineticAlways, 4.5, 0.045)
}

/// A pendulum of a metre swings by 0.1 rad: after ten periods it is where it was let go.
fn pendulum() -> Case {
    let (s, c) = 0.1f64.sin_cos();
    let bodies = vec![disc(0.05, [0.0, 0.0]).fixed(), disc(0.05, [s, -c]).mass(1.0)];
    // A rod holds the centroid: a point mass. Half-way terms of the period: 1 + a²/16 + 11a⁴/3072.
    let period = std::f64::consts::TAU * (1.0 / G).sqrt() * (1.0 + 0.01 / 16.0 + 11.0 * 1e-4 / 3072.0);
    let steps = (10.0 * period * 60.0).round();
    let late = steps / 60.0 - 10.0 * period;
    let x = s - 0.5 * G * s * c * late * late;
    Case::new("pendulum after ten periods".to_owned(), bodies, steps / 60.0)
        .joined(vec![rod(0, 1)])
        .end(1, Column::X, x, 0.02 * s)
        .end(1, Column::Y, -c, 1e-3)
}

pub(super) fn cases() -> Vec<Case> {
    let chains = [(3, 10.0), (10, 10.0), (20, 1000.0), (40, 1000.0)].map(|(n, load)| chain(n, load));
    let hinged = [(10, 100.0), (40, 1000.0)].map(|(n, load)| hinges(n, load));
    let solvers = [Solver::Soft, Solver::Pgs, Solver::Xpbd, Solver::Impulse].map(dumbbell);
    chains
        .into_iter()
        .chain(hinged)
        .chain([(20, 100.0), (20, 1000.0), (4, 10_000.0)].map(|(n, load)| swung(n, load)))
        .chain([3, 9, 14].map(tower))
        .chain([(4, 10.0), (10, 100.0), (10, 1000.0)].map(|(bays, load)| truss(bays, load, false)))
        .chain([(2, 1000.0), (10, 100.0), (10, 1000.0)].map(|(bays, load)| truss(bays, load, true)))
        .chain([10.0, 100.0].map(welded_ring))
        .chain([(4, 100.0), (6, 1000.0)].map(|(side, load)| net(side, load)))
        .chain([10, 20].map(platform))
        .chain([1.0, 100.0].map(limit))
        .chain([10.0, 1000.0].map(motor))
        .chain(solvers)
        .chain([10.0, 60.0].map(bounces))
        .chain([pendulum()])
        .collect()
}
