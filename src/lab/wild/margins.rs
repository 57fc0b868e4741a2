//! A body that would not touch is not touched: it falls or flies past an edge as if that were not there.
//!
//! Free flight: x = vx·t, y = y₀ + vy·t − ½g·t², to the half of a step that a scheme of order 1 is off by, and nothing of the
//! wall.

use super::case::{Case, Column, G, RATE, disc, rectangle};

/// A disc or box falls past a wall, so many times as large as a ball of 27 mm, the gap 1/27 of its width.
fn falls_past(round: bool, scale: f64) -> Case {
    let (half, gap) = (0.0135 * scale, 5e-4 * scale);
    let wall = rectangle([0.05 * scale; 2], [-half - gap - 0.05 * scale, 0.0]).surface(0.9, 0.0).fixed();
    let from = 0.5 * scale;
    let body = if round { disc(half, [0.0, from]) } else { rectangle([half; 2], [0.0, from]) };
    let body = body.mass(1.0).surface(0.9, 0.0);
    // Past the wall for as long again.
    let steps = ((4.0 * from / G).sqrt() * RATE).ceil();
    let secs = steps / RATE;
    let shape = if round { "disc" } else { "box" };
    Case::new(format!("{shape} of {half} m falls past a wall"), vec![wall, body], secs)
        .end(1, Column::X, 0.0, 1e-6 * scale)
        .end(1, Column::Vx, 0.0, 1e-5)
        .end(1, Column::Y, from - 0.5 * G * secs * secs, 0.5 * G * secs / 60.0)
        .end(1, Column::W, 0.0, 1e-5)
}

/// A disc flies over the corner of a block, closer than it moves in a step.
fn flies_over(speed: f64, gap: f64) -> Case {
    let block = rectangle([0.5, 0.5], [5.0, -0.5]).surface(1.0, 0.5).fixed();
    let ball = disc(0.1, [0.0, 0.1 + gap]).mass(1.0).surface(1.0, 0.5).moving([speed, 0.0], 0.0);
    let secs = (10.0 / speed * RATE).ceil() / RATE;
    Case::new(format!("disc flies over a block at {speed} m/s, {gap} m above it"), vec![block, ball], secs)
        .weightless()
        .end(1, Column::X, speed * secs, 1e-4 * speed * secs)
        .end(1, Column::Y, 0.1 + gap, 1e-6)
        .end(1, Column::Vy, 0.0, 1e-6)
        .end(1, Column::W, 0.0, 1e-6)
}

/// Two discs pass each other with a gap.
fn pass(gap: f64) -> Case {
    let one = |x: f64, y: f64, v: f64| disc(0.1, [x, y]).mass(1.0).surface(1.0, 0.5).moving([v, 0.0], 0.0);
    let bodies = vec![one(-3.0, 0.0, 20.0), one(3.0, 0.2 + gap, -20.0)];
    Case::new(format!("discs pass each other {gap} m apart"), bodies, 0.5)
        .weightless()
        .end(0, Column::X, 7.0, 1e-4)
        .end(0, Column::Vy, 0.0, 1e-6)
        .end(1, Column::X, -7.0, 1e-4)
        .end(1, Column::Y, 0.2 + gap, 1e-6)
}

pub(super) fn cases() -> Vec<Case> {
    let falls = [(true, 1.0), (true, 10.0), (true, 100.0), (false, 1.0), (false, 10.0), (false, 100.0)];
    let falls = falls.map(|(round, scale)| falls_past(round, scale));
    let flies = [(5.0, 1e-3), (50.0, 1e-3), (50.0, 1e-2)].map(|(speed, gap)| flies_over(speed, gap));
    falls.into_iter().chain(flies).chain([1e-3, 1e-2].map(pass)).collect()
}
