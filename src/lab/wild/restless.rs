//! Sleep: what would move does not fall asleep, however slow it is now; what rests does.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, TAU};

use lamina2d::force::{Drive, Forces};
use lamina2d::joint::{Distance, JointKind, JointSpec, JointSpring, Motor, Revolute};

use super::case::{Case, Column, Expect, G, RATE, What, disc, floor, rectangle};

/// A box stands on its corner, a little off balance: it grows by √(0.5303·g/h) a second, topples and lies flat.
fn corner(half: f64, off_rad: f64) -> Case {
    let bodies = vec![
        floor(50.0).surface(0.0, 1.0),
        rectangle([half; 2], [0.0, half * 2f64.sqrt()])
            .turned(FRAC_PI_4 + off_rad)
            .mass(1.0)
            .surface(0.0, 1.0),
    ];
    let rate = (0.5303 * G / half).sqrt();
    // To 0.1 rad, and as long again to lie still.
    let secs = 2.0 * (0.1 / off_rad).ln() / rate + 10.0 * half.sqrt();
    Case::new(format!("box of {half} m on its corner, {off_rad} rad off"), bodies, secs)
        .sleepy()
        .end(1, Column::Y, half, 0.01 * half)
        .end(1, Column::Angle, FRAC_PI_2, 0.01)
}

/// A bob on a long rod swings by 0.7 m: half a period later it is on the other side.
fn pendulum(length: f64) -> Case {
    let swing = 0.7 / length;
    let (s, c) = swing.sin_cos();
    let bodies =
        vec![disc(0.1, [0.0, length]).fixed(), disc(2.0, [length * s, length * (1.0 - c)]).mass(1.0)];
    let period = TAU * (length / G).sqrt() * (1.0 + swing * swing / 16.0);
    let half = (0.5 * period * RATE).round();
    let case = Case::new(format!("bob on {length} m swings 0.7 m"), bodies, 2.0 * half / RATE)
        .joined(vec![JointSpec::new(0, 1, JointKind::Distance(Distance::default()))])
        .sleepy();
    case.expect(What::Body { body: 1, column: Column::X, step: half as u64 }, -0.7, 0.02).end(
        1,
        Column::X,
        0.7,
        0.02,
    )
}

/// A disc on a slow spring: half a period later it is on the other side of its rest.
fn spring(hertz: f64) -> Case {
    let bodies = vec![disc(0.5, [0.0, 0.0]).fixed(), disc(0.5, [2.1, 0.0]).mass(1.0)];
    let spring = Some(JointSpring { hertz, damping: 0.0 });
    let distance = Distance { length: Some(2.0), spring, ..Distance::default() };
    Case::new(format!("disc on a spring of {hertz} Hz"), bodies, 0.5 / hertz)
        .weightless()
        .joined(vec![JointSpec::new(0, 1, JointKind::Distance(distance))])
        .sleepy()
        .end(1, Column::X, 1.9, 0.005)
}

/// A motor turns an arm slowly for a minute.
fn motor(speed: f64) -> Case {
    let bodies = vec![disc(0.02, [0.0, 0.0]).fixed(), rectangle([0.5, 0.05], [0.5, 0.0]).mass(1.0)];
    let motor = Some(Motor { speed, max_torque: 100.0 });
    let hinge = JointKind::Revolute(Revolute { anchor: [0.0; 2], motor, limits: None });
    let (s, c) = (60.0 * speed).sin_cos();
    Case::new(format!("motor of {speed} rad/s"), bodies, 60.0)
        .joined(vec![JointSpec::new(0, 1, hinge)])
        .sleepy()
        .end(1, Column::X, 0.5 * c, 1e-3)
        .end(1, Column::Y, 0.5 * s, 0.02 * 0.5 * s)
}

/// A push upwards of A·sin(0.2·t) lifts a box off where it passes g.
///
/// From then on, at t₀: v = −5A·(cos 0.2t − cos 0.2t₀) − g(t − t₀), and y is its integral.
fn lift(amplitude: f64) -> Case {
    let (rate, begun) = (0.2, (G / amplitude).asin() / 0.2);
    let secs = (begun + 2.0).ceil();
    let drive = Drive { amplitude: [0.0, amplitude], rate, phase: -FRAC_PI_2 };
    let (late, cos) = (secs - begun, (rate * begun).cos());
    let risen = amplitude / rate * (cos * late - ((rate * secs).sin() - (rate * begun).sin()) / rate)
        - 0.5 * G * late * late;
    Case::new(
        format!("push of {amplitude} m/s² lifts a box"),
        vec![floor(5.0), rectangle([0.5; 2], [0.0, 0.5])],
        secs,
    )
    .under(Forces { drive: Some(drive), ..Forces::gravity() })
    .sleepy()
    .end(1, Column::Y, 0.5 + risen, 0.02 * risen + 0.01)
}

/// A disc on top of a fixed disc, a little off: it rolls down and falls for ever.
fn on_disc(off_rad: f64) -> Case {
    let (s, c) = off_rad.sin_cos();
    let rough = |body: lamina2d::scene::BodySpec| body.surface(0.0, 1.0);
    let bodies = vec![rough(disc(0.5, [0.0, 0.0])).fixed(), rough(disc(0.5, [s, c])).mass(1.0)];
    let case = Case::new(format!("disc on a disc, {off_rad} rad off"), bodies, 10.0).sleepy();
    let y = case.last(1, Column::Y);
    case.holds(Expect::at_most(y, -10.0))
}

/// A box on a slope steeper than its friction by a little: it slides ½·g·(sin α − μ cos α)·t². What pulls it is a
/// thousandth of its weight: a solver that has the normal force right to a thousandth is off by a third of the way.
fn slope(excess: f64) -> Case {
    let angle = 0.3f64;
    let (s, c) = angle.sin_cos();
    let mu = s / c - excess;
    let along = |t: f64, n: f64| [t * c + n * s, -t * s + n * c];
    let bodies = vec![
        rectangle([50.0, 0.5], along(0.0, -0.5)).turned(-angle).surface(0.0, mu).fixed(),
        rectangle([0.5, 0.25], along(0.0, 0.25)).turned(-angle).mass(1.0).surface(0.0, mu),
    ];
    let secs = 5.0;
    let way = 0.5 * G * c * excess * secs * secs;
    Case::new(format!("box on a slope, friction short by {excess}"), bodies, secs).sleepy().end(
        1,
        Column::X,
        along(way, 0.25)[0],
        0.3 * way,
    )
}

/// A box on a slope that holds it stays, and sleeps.
fn holds() -> Case {
    let angle = 0.3f64;
    let (s, c) = angle.sin_cos();
    let along = |t: f64, n: f64| [t * c + n * s, -t * s + n * c];
    let bodies = vec![
        rectangle([50.0, 0.5], along(0.0, -0.5)).turned(-angle).surface(0.0, 0.5).fixed(),
        rectangle([0.5, 0.25], along(0.0, 0.25)).turned(-angle).mass(1.0),
    ];
    Case::new("box on a slope that holds it".to_owned(), bodies, 10.0)
        .sleepy()
        .end(1, Column::X, along(0.0, 0.25)[0], 0.01)
        .holds(Expect::at_least(What::Asleep, 1.0))
}

/// Stacks, side by side, that stand from the beginning: all of them sleep.
fn stacks(count: usize, high: usize) -> Case {
    let at = |k: usize| [3.0 * (k / high) as f64, 0.5 + (k % high) as f64];
    let mut bodies = vec![rectangle([3.0 * count as f64, 0.5], [1.5 * count as f64, -0.5]).fixed()];
    bodies.extend((0..count * high).map(|k| rectangle([0.5; 2], at(k)).mass(1.0)));
    Case::new(format!("{count} stacks of {high}"), bodies, 10.0)
        .sleepy()
        .end(high, Column::Y, high as f64 - 0.5, 0.02)
        .holds(Expect::at_least(What::Asleep, (count * high) as f64))
}

/// A disc that rolls on level ground without losing anything rolls on.
fn rolls(speed: f64) -> Case {
    let ball = disc(0.5, [0.0, 0.5]).mass(1.0).moving([speed, 0.0], -speed / 0.5);
    let secs = 20.0;
    Case::new(format!("disc rolls at {speed} m/s"), vec![floor(50.0), ball], secs)
        .sleepy()
        .end(1, Column::X, speed * secs, 0.01 * speed * secs)
        .end(1, Column::Vx, speed, 0.01 * speed)
}

pub(super) fn cases() -> Vec<Case> {
    let corners = [(0.25, 1e-4), (0.5, 1e-4), (0.5, 1e-3), (2.0, 1e-4)].map(|(half, off)| corner(half, off));
    corners
        .into_iter()
        .chain([50.0, 200.0].map(pendulum))
        .chain([0.05, 0.02].map(spring))
        .chain([1e-3, 3e-4].map(motor))
        .chain([15.0, 20.0].map(lift))
        .chain([1e-4, 1e-3].map(on_disc))
        .chain([1e-2, 1e-3].map(slope))
        .chain([holds()])
        .chain([(1, 5), (5, 4)].map(|(count, high)| stacks(count, high)))
        .chain([0.05, 1.0].map(rolls))
        .collect()
}
