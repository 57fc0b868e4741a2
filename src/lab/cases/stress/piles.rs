//! What must stand.

use lamina2d::force::Forces;
use lamina2d::scene::named::scene;
use lamina2d::scene::similar;
use lamina2d::scene::{BodySpec, Scene, ShapeSpec, stacks};

use super::{LADEN_BOXES, TILTED_BOXES};

fn floor(half_width: f64) -> BodySpec {
    BodySpec::new(ShapeSpec::Box([half_width, 0.5]), [0.0, -0.5]).surface(0.0, 0.6).fixed()
}

fn brick(half: f64, position: [f64; 2]) -> BodySpec {
    BodySpec::new(ShapeSpec::Box([half; 2]), position).surface(0.0, 0.6)
}

/// T1, T2: `boxes` on each other, 1 cm to the right and to the left in turn.
pub fn column(boxes: f64) -> Scene {
    stacks::columns(boxes as usize)
}

/// T3: ten columns of ten boxes of 1 m, the k-th leaning by (2k + 1)/20 of `most` a box: of 0.2 m by 1, 3, … 19 cm.
///
/// The centre of the upper m boxes is (m + 1)/2 leans beyond the middle of the box below, and must be within ½ m: a
/// column of ten stands up to 10 cm a box.
pub fn tilted(most: f64) -> Scene {
    let columns = (0..10).flat_map(|k| {
        let lean = most * (2.0 * f64::from(k) + 1.0) / 20.0;
        (0..TILTED_BOXES)
            .map(move |row| brick(0.5, [24.0 * (f64::from(k) - 4.5) + lean * row as f64, 0.5 + row as f64]))
    });
    let bodies = std::iter::once(floor(140.0)).chain(columns).collect();
    scene("columns that lean, some of them too far", bodies, Forces::gravity(), 3600)
}

/// T4: a pyramid of boxes of 1 m, `base` in its lowest row.
pub fn pyramid(base: f64) -> Scene {
    stacks::pyramid(base as usize)
}

/// T5: a pyramid of base 10 whose topmost box is `density` times as dense.
pub fn crowned(density: f64) -> Scene {
    let mut scene = stacks::pyramid(10);
    if let Some(top) = scene.bodies.last_mut() {
        top.density = Some(density);
    }
    scene
}

/// T6: a box of `side` metres on two of 1 m under its ends: side² times the mass of either.
pub fn footed(side: f64) -> Scene {
    let foot = |sign: f64| brick(0.5, [sign * 0.45 * side, 0.5]);
    let large = BodySpec::new(ShapeSpec::Box([side / 2.0; 2]), [0.0, 1.0 + side / 2.0]).surface(0.0, 0.6);
    let bodies = vec![floor(2.0 * side + 10.0), foot(-1.0), foot(1.0), large];
    scene("a large box on two small feet", bodies, Forces::gravity(), 3600)
}

/// T7: a box of `ratio` kg on one of the same size and 1 kg.
pub fn heavy(ratio: f64) -> Scene {
    let mut scene = stacks::heavy(1);
    if let Some(top) = scene.bodies.last_mut() {
        top.mass = Some(ratio);
    }
    scene
}

/// T8: `count` boxes, each twice the size of the one below, the lowest of 1 m.
pub fn sizes(count: f64) -> Scene {
    let boxes = (0..count as i32).map(|k| {
        let size = 2f64.powi(k);
        brick(size / 2.0, [0.0, size - 1.0 + size / 2.0])
    });
    let bodies = std::iter::once(floor(2f64.powf(count) + 40.0)).chain(boxes).collect();
    scene("each box twice the size of the one below", bodies, Forces::gravity(), 3600)
}

/// T12: a house of cards of `levels` storeys.
pub fn card_house(levels: f64) -> Scene {
    stacks::cards(levels as usize)
}

/// T13: the arch with `boxes` on its keystone.
pub fn arched(boxes: f64) -> Scene {
    let mut scene = stacks::arch();
    let without = scene.bodies.len() - 4;
    let lowest = scene.bodies[without].clone();
    scene.bodies.truncate(without);
    scene.bodies.extend((0..boxes as usize).map(|k| {
        let [x, y] = lowest.position;
        BodySpec { position: [x, y + 0.5 * k as f64], ..lowest.clone() }
    }));
    scene
}

/// T14: ten columns of ten boxes of 1 m, each `share` of its side in those about it, without gravity.
pub fn sunk(share: f64) -> Scene {
    let pitch = 1.0 - share;
    let boxes = (0..100).map(|k| {
        let [column, row] = [k % 10, k / 10].map(|k| f64::from(k) - 4.5);
        brick(0.5, [pitch * column, pitch * row])
    });
    scene("boxes that begin in each other", boxes.collect(), Forces::default(), 600)
}

/// T16: five boxes of 1 m and 1 kg under one of `ratio` kg, the last body.
pub fn laden(ratio: f64) -> Scene {
    let boxes = (0..=LADEN_BOXES).map(|k| {
        let kg = if k == LADEN_BOXES { ratio } else { 1.0 };
        brick(0.5, [0.0, 0.5 + k as f64]).mass(kg)
    });
    let bodies = std::iter::once(floor(20.0)).chain(boxes).collect();
    scene("a weight on a column, to be taken away", bodies, Forces::gravity(), 600)
}

/// T21: a pyramid of base 10, `distance` metres to the right of the origin and eight tenths of that below.
pub fn far(distance: f64) -> Scene {
    similar::shifted(&stacks::pyramid(10), [distance, -0.8 * distance])
}

/// T22: five boxes on a floor `half_width` metres wide to either side.
pub fn wide(half_width: f64) -> Scene {
    let boxes = (0..5).map(|k| brick(0.5, [0.0, 0.5 + f64::from(k)]));
    let bodies = std::iter::once(floor(half_width)).chain(boxes).collect();
    scene("a column on a wide floor", bodies, Forces::gravity(), 500)
}

/// T23: a pyramid of base 30 of boxes of `size` metres, in steps of √`size`/60 s: gravity stays what it is.
pub fn scaled(size: f64) -> Scene {
    let mut scene = stacks::pyramid(30);
    scene.dt_secs *= size.sqrt();
    for body in &mut scene.bodies {
        body.position = body.position.map(|x| x * size);
        if let ShapeSpec::Box(half) = &mut body.shape {
            *half = half.map(|x| x * size);
        }
    }
    scene
}
