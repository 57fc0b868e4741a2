//! Weight is weight: as gravity, as a force on each body, and however much of it there is.

use lamina2d::force::Forces;
use lamina2d::scene::BodySpec;

use super::case::{Case, Column, G, disc, floor, rectangle};

/// Boxes on each other, by gravity or by a force on each: the top stays within a hundredth of a box for each.
fn column(count: usize, by_force: bool) -> Case {
    let one = |k: usize| {
        let body = rectangle([0.5; 2], [0.0, 0.5 + k as f64]).mass(1.0);
        if by_force { BodySpec { force: [0.0, -G], ..body } } else { body }
    };
    let bodies = std::iter::once(floor(50.0)).chain((0..count).map(one)).collect();
    let how = if by_force { "force" } else { "gravity" };
    let case = Case::new(format!("column of {count} by {how}"), bodies, 15.0);
    let case = if by_force { case.weightless() } else { case };
    case.end(count, Column::Y, count as f64 - 0.5, 0.01 * count as f64).end(count, Column::X, 0.0, 0.1)
}

/// Ten boxes on each other, small or large, under much gravity: the lowest sinks by a thousandth of its size at most.
fn sag(size: f64, gravity: f64) -> Case {
    let half = 0.5 * size;
    let one = |k: usize| rectangle([half; 2], [0.0, half + k as f64 * size]).mass(1.0);
    let ground = rectangle([10.0 * size, half], [0.0, -half]).fixed();
    let bodies = std::iter::once(ground).chain((0..10).map(one)).collect();
    Case::new(format!("ten boxes of {size} m at {gravity} m/s²"), bodies, 5.0)
        .under(Forces { gravity: Some([0.0, -gravity]), ..Forces::default() })
        .end(1, Column::Y, half, 1e-3 * size)
        .end(10, Column::Y, half + 9.0 * size, 1e-2 * size)
        .end(10, Column::Angle, 0.0, 0.01)
}

/// A body held up by a force on it stays where it is for a minute.
fn hover(mass: f64) -> Case {
    let body = BodySpec { force: [0.0, G * mass], ..disc(0.5, [0.0, 0.0]).mass(mass) };
    Case::new(format!("{mass} kg hover"), vec![body], 60.0).end(0, Column::Y, 0.0, 0.01)
}

/// A force that presses a box on the floor as a weight would lets it slide as far: v²/(2·μ·(g + F/m)).
fn pressed(force: f64) -> Case {
    let body = rectangle([0.5, 0.25], [0.0, 0.25]).mass(1.0).surface(0.0, 0.5).moving([5.0, 0.0], 0.0);
    let bodies = vec![floor(50.0).surface(0.0, 0.5), BodySpec { force: [0.0, -force], ..body }];
    let way = 25.0 / (2.0 * 0.5 * (G + force));
    Case::new(format!("box slides, pressed by {force} N"), bodies, 3.0).end(1, Column::X, way, 0.03 * way)
}

pub(super) fn cases() -> Vec<Case> {
    let columns = [(20, false), (20, true), (80, false), (80, true)].map(|(n, by)| column(n, by));
    let sags = [0.02, 1.0, 10.0].into_iter().flat_map(|size| [98.1, 200.0].map(|g| sag(size, g)));
    let rest = [3.0, 1000.0].map(hover).into_iter().chain([0.0, 50.0].map(pressed));
    columns.into_iter().chain(sags).chain(rest).collect()
}
