//! Scenes that move: falling, toppling, stirred and fast bodies.

use rand::RngExt;
use rand::SeedableRng;
use rand_pcg::Pcg32;

use super::named::scene;
use super::{BodyKind, BodySpec, Scene, ShapeSpec};
use crate::force::Forces;
use crate::vec2::Rot;

/// The number of bodies tumbler and spinner are drawn for; other numbers scale the box by √(n/2000).
const REFERENCE_BODIES: f64 = 2000.0;

/// A static box by its half-extents, metres.
fn block(half: [f64; 2], position: [f64; 2]) -> BodySpec {
    BodySpec::new(ShapeSpec::Box(half), position).surface(0.0, 0.6).fixed()
}

/// Right, top, left and bottom wall, 1 m thick, about the origin: inside are 2·`half` m each way.
///
/// Each reaches over the end of the one before, so that corners are closed and no wall overlaps another.
fn enclosure(half: f64) -> [BodySpec; 4] {
    let (far, long) = (half + 0.5, half + 0.5);
    [
        block([0.5, long], [far, 0.5]),
        block([long, 0.5], [-0.5, far]),
        block([0.5, long], [-far, -0.5]),
        block([long, 0.5], [0.5, -far]),
    ]
}

fn seeded(scene: Scene, seed: u64) -> Scene {
    Scene { seed, ..scene }
}

/// `n` dominoes of 1 m, 0.5 m apart on a static floor, the first one turning about its foot fast enough to
/// fall onto the second.
pub fn dominoes(n: usize) -> Scene {
    let half = [0.1, 0.5];
    let length = 0.5 * (n as f64 - 1.0);
    // Its centre has to rise by √0.26 − 0.5 m: from 0.75 rad/s it does.
    let spin = -1.5;
    let dominoes = (0..n).map(|k| {
        let domino = BodySpec::new(ShapeSpec::Box(half), [0.5 * k as f64, half[1]]).surface(0.0, 0.6);
        // About its lower right corner: ω × r.
        if k == 0 { domino.moving([-spin * half[1], -spin * half[0]], spin) } else { domino }
    });
    let ground = block([length / 2.0 + 5.0, 0.5], [length / 2.0, -0.5]);
    // Each needs a fifth of a second.
    let steps = 120 + 14 * n as u64;
    scene("a row of dominoes", std::iter::once(ground).chain(dominoes).collect(), Forces::gravity(), steps)
}

/// `n` circles, boxes and polygons in turn falling from a jittered grid, four times as high as wide, onto a
/// static floor between two static walls.
pub fn rain(n: usize, seed: u64) -> Scene {
    let mut random = Pcg32::seed_from_u64(seed);
    let columns = (n as f64 / 4.0).sqrt().ceil() as usize;
    let half_width = columns as f64 / 2.0 + 0.5;
    let half_height = (n.div_ceil(columns) as f64) / 2.0 + 1.0;
    let wall = |side: f64| block([0.5, half_height], [side * (half_width + 0.5), half_height]);
    let mut bodies = vec![block([half_width + 1.0, 0.5], [0.0, -0.5]), wall(-1.0), wall(1.0)];
    for k in 0..n {
        // A cell of 1 m holds 0.4 m about its centre wherever the jitter puts it.
        let [column, row] = [k % columns, k / columns];
        let cell = [column as f64 - (columns as f64 - 1.0) / 2.0, row as f64 + 1.0];
        let position = cell.map(|at| at + random.random_range(-0.08..=0.08));
        let drop = match k % 3 {
            0 => BodySpec::new(ShapeSpec::Circle(random.random_range(0.2..0.4)), position),
            1 => {
                let half = [(); 2].map(|()| random.random_range(0.15..0.28));
                BodySpec::new(ShapeSpec::Box(half), position).turned(random.random_range(-1.5..1.5))
            }
            _ => BodySpec::new(pebble(&mut random), position),
        };
        bodies.push(drop.surface(0.0, 0.6));
    }
    seeded(scene("a rain of circles, boxes and polygons", bodies, Forces::gravity(), 600), seed)
}

/// A polygon of 5 to 8 vertices on a circle of 0.25 to 0.4 m, each within a quarter of its sector.
fn pebble(random: &mut Pcg32) -> ShapeSpec {
    let vertices = random.random_range(5..=8_u32);
    let radius = random.random_range(0.25..0.4);
    let sector = std::f64::consts::TAU / f64::from(vertices);
    let outline = (0..vertices).map(|k| {
        let rot = Rot::from_angle((f64::from(k) + random.random_range(-0.25..0.25)) * sector);
        [radius * rot.c, radius * rot.s]
    });
    ShapeSpec::Polygon(outline.collect())
}

/// `n` boxes of 0.25 m in a square of 20 m whose four kinematic walls turn about its centre by 25° a
/// second.
pub fn tumbler(n: usize) -> Scene {
    let half = (10.0 * (n as f64 / REFERENCE_BODIES).sqrt()).max(1.0);
    let omega = 25f64.to_radians();
    let walls = enclosure(half).map(|wall| wall.about([0.0; 2]).moving([0.0; 2], omega));
    let pitch = 0.3;
    let columns = ((2.0 * half - pitch) / pitch) as usize;
    let rows = n.div_ceil(columns);
    let boxes = (0..n).map(|k| {
        let at = |k: usize, of: usize| (k as f64 - (of as f64 - 1.0) / 2.0) * pitch;
        let position = [at(k % columns, columns), at(k / columns, rows)];
        BodySpec::new(ShapeSpec::Box([0.125; 2]), position).surface(0.0, 0.6)
    });
    // One turn takes 864 steps.
    scene("boxes in a turning box", walls.into_iter().chain(boxes).collect(), Forces::gravity(), 900)
}

/// `n` circles, boxes and elongated octagons in turn in a static square of 40 m, stirred by a kinematic bar
/// nine tenths as long that turns about its centre by 1 rad a second.
pub fn spinner(n: usize, seed: u64) -> Scene {
    let mut random = Pcg32::seed_from_u64(seed);
    let half = (20.0 * (n as f64 / REFERENCE_BODIES).sqrt()).max(3.0);
    let bar =
        BodySpec { kind: BodyKind::Kinematic, ..block([0.9 * half, 0.3], [0.0; 2]).moving([0.0; 2], 1.0) };
    let pitch = 0.6;
    let columns = ((2.0 * half - pitch) / pitch) as usize;
    let mut bodies: Vec<BodySpec> = enclosure(half).into_iter().chain([bar]).collect();
    for k in 0..n {
        // In turn above and below the bar, away from it.
        let (side, place) = (if k % 2 == 0 { 1.0 } else { -1.0 }, k / 2);
        let x = ((place % columns) as f64 - (columns as f64 - 1.0) / 2.0) * pitch;
        let y = side * (1.0 + (place / columns) as f64 * pitch);
        let position = [x, y].map(|at| at + random.random_range(-0.04..=0.04));
        let shape = match k % 3 {
            0 => ShapeSpec::Circle(0.2),
            1 => ShapeSpec::Box([0.18, 0.14]),
            _ => ShapeSpec::Polygon(CAPSULE.to_vec()),
        };
        bodies.push(BodySpec::new(shape, position).surface(0.0, 0.3));
    }
    seeded(scene("a bar stirring small bodies", bodies, Forces::gravity(), 3000), seed)
}

/// An octagon with round ends: half circles of radius 0.1 m about (±0.14, 0), cut at ±30° and ±90°.
const CAPSULE: [[f64; 2]; 8] = [
    [0.14, -0.1],
    [0.2266, -0.05],
    [0.2266, 0.05],
    [0.14, 0.1],
    [-0.14, 0.1],
    [-0.2266, 0.05],
    [-0.2266, -0.05],
    [-0.14, -0.1],
];

/// A shape flying to the right from `height` on the y axis, and its own static wall of 0.1 m, which lies in
/// the middle between two places where steps of 1/60 s would set the shape down.
pub fn shot(shape: ShapeSpec, height: f64, speed: f64) -> [BodySpec; 2] {
    let stride = speed / 60.0;
    let strides = (8.0 / stride).floor() + 0.5;
    let wall = block([0.05, 2.0], [strides * stride, height]);
    [BodySpec::new(shape, [0.0, height]).surface(0.0, 0.6).moving([speed, 0.0], 0.0), wall]
}

/// A circle of 0.1 m at 200 m/s against a static wall 0.1 m thick, without gravity.
pub fn bullet() -> Scene {
    let bodies = shot(ShapeSpec::Circle(0.1), 0.0, 200.0).to_vec();
    scene("a fast circle against a thin wall", bodies, Forces::default(), 60)
}

/// A wedge and a sliver, point first, and a plate broadside.
pub fn projectiles() -> [ShapeSpec; 3] {
    let wedge = ShapeSpec::Polygon(vec![[0.2, 0.0], [-0.1, 0.1], [-0.1, -0.1]]);
    let sliver = ShapeSpec::Polygon(vec![[0.4, 0.0], [-0.2, 0.01], [-0.2, -0.01]]);
    [wedge, sliver, ShapeSpec::Box([0.01, 0.5])]
}

/// A wedge at 200 m/s, a sliver point first and a thin box broadside at 100 m/s, each against its own
/// static wall 0.1 m thick, without gravity: 6 bodies.
pub fn bullets() -> Scene {
    let [wedge, sliver, plate] = projectiles();
    let shots = [shot(wedge, 0.0, 200.0), shot(sliver, 10.0, 100.0), shot(plate, 20.0, 100.0)];
    scene("fast wedge, sliver and plate against thin walls", shots.concat(), Forces::default(), 60)
}

/// 625 discs of 0.39 m on a grid of 0.8 m, filling a static square of 20 m, with velocities up to 0.5 m/s
/// along either axis and without gravity: 629 bodies.
pub fn circles_confined(seed: u64) -> Scene {
    let mut random = Pcg32::seed_from_u64(seed);
    let mut bodies = enclosure(10.0).to_vec();
    bodies.extend((0..625).map(|k| {
        let position = [k % 25, k / 25].map(|at| f64::from(at - 12) * 0.8);
        let velocity = [(); 2].map(|()| random.random_range(-0.5..=0.5));
        BodySpec::new(ShapeSpec::Circle(0.39), position).surface(0.0, 0.6).moving(velocity, 0.0)
    }));
    seeded(scene("discs packed into a box without gravity", bodies, Forces::default(), 3600), seed)
}
