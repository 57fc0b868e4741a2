//! Pairs of bodies for the narrow phase: every pair of forms, every degenerate case.

use glam::DVec2;
use lamina2d::scene::{BodySpec, ShapeSpec};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg32;

use crate::shared_oracle::{Solid, bodies_of, separation};

/// Two bodies, the second in its place.
pub(crate) type Pair = [BodySpec; 2];

/// How two bodies lie to each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Case {
    Random,
    Touching,
    Coincident,
    ParallelEdges,
    Slivers,
    Deep,
    Contained,
    Corners,
    Stacked,
    Far,
}

/// All of them.
pub(crate) const CASES: [Case; 10] = [
    Case::Random,
    Case::Touching,
    Case::Coincident,
    Case::ParallelEdges,
    Case::Slivers,
    Case::Deep,
    Case::Contained,
    Case::Corners,
    Case::Stacked,
    Case::Far,
];

/// A convex outline on an ellipse: 3 to 8 corners, unevenly spaced, none sharper than the ellipse makes it.
fn outline(size: f64, aspect: f64, random: &mut Pcg32) -> ShapeSpec {
    let sides = random.random_range(3..=8);
    let corner = |k: i32, jitter: f64| {
        let v = DVec2::from_angle((f64::from(k) + jitter) * std::f64::consts::TAU / f64::from(sides)) * size;
        [v.x, v.y / aspect]
    };
    ShapeSpec::Polygon((0..sides).map(|k| corner(k, random.random_range(-0.3..0.3))).collect())
}

/// Form 0 to 2, size (about a radius), length over width.
fn shape(form: usize, size: f64, aspect: f64, random: &mut Pcg32) -> ShapeSpec {
    match form {
        0 => ShapeSpec::Circle(size),
        1 => ShapeSpec::Box([size, size / aspect]),
        _ => outline(size, aspect, random),
    }
}

fn placed(shape: ShapeSpec, at: DVec2, angle: f64) -> BodySpec {
    BodySpec::new(shape, at.into()).turned(angle)
}

/// Moves the second body along `direction` until it just touches the first, then `further`.
fn touching([a, b]: Pair, direction: DVec2, further: f64) -> Pair {
    let bodies = bodies_of::<f64>(&[a.clone(), b.clone()]);
    let (fixed, mut moved) = (Solid::new(&bodies, 1), Solid::new(&bodies, 2));
    let start = moved.centre;
    let (mut low, mut high) = (0.0, 2.0 * (fixed.reach() + moved.reach()) + start.distance(fixed.centre));
    for _ in 0..80 {
        let middle = f64::midpoint(low, high);
        moved.centre = start + direction * middle;
        if separation(&fixed, &moved) < 0.0 { low = middle } else { high = middle }
    }
    let at = DVec2::from(b.position) + direction * (low + further);
    [a, BodySpec { position: at.into(), ..b }]
}

/// The `k`-th pair of a case.
pub(crate) fn pair(case: Case, k: usize) -> Pair {
    let random = &mut Pcg32::seed_from_u64(k as u64 * 64 + case as u64);
    let forms = [k % 3, k / 3 % 3];
    let angle = |random: &mut Pcg32| random.random_range(-3.2..3.2);
    let direction = DVec2::from_angle(angle(random));
    let sizes: [f64; 2] = std::array::from_fn(|_| 10f64.powf(random.random_range(-0.7..0.7)));
    let aspects: [f64; 2] = std::array::from_fn(|_| match case {
        Case::Slivers => 10f64.powf(random.random_range(0.0..3.0)),
        _ => random.random_range(1.0..3.0),
    });
    let [a, b] = [0, 1].map(|s| shape(forms[s], sizes[s], aspects[s], random));
    let base = [placed(a, DVec2::ZERO, angle(random)), placed(b, DVec2::ZERO, angle(random))];
    let reach = sizes[0] + sizes[1];
    let tiny =
        |random: &mut Pcg32| random.random_range(-1.0..1.0) * 10f64.powf(random.random_range(-9.0..-3.0));
    match case {
        Case::Random => shifted(base, direction * reach * random.random_range(0.0..1.1)),
        // Every other sliver crosses or stabs the other body.
        Case::Slivers if !(k / 9).is_multiple_of(2) => {
            shifted(base, direction * reach * random.random_range(0.0..0.8))
        }
        Case::Touching | Case::Slivers => {
            let further = tiny(random);
            touching(base, direction, further)
        }
        Case::Coincident => base,
        Case::ParallelEdges => parallel(base, k, random),
        Case::Deep => shifted(base, direction * reach * random.random_range(1e-6..0.2)),
        Case::Contained => {
            let small = shape(forms[1], 0.02 * sizes[0], 1.5, random);
            let at = direction * sizes[0] * random.random_range(0.0..0.3);
            [base[0].clone(), placed(small, at, base[1].angle)]
        }
        Case::Corners => corners(random),
        Case::Stacked => stacked(k, random),
        Case::Far => {
            let [a, b] = shifted(base, direction * reach * random.random_range(0.0..1.1));
            let away = DVec2::new(1e4, -7e3);
            [a, b].map(|s| BodySpec { position: (DVec2::from(s.position) + away).into(), ..s })
        }
    }
}

fn shifted([a, b]: Pair, by: DVec2) -> Pair {
    let at = DVec2::from(b.position) + by;
    [a, BodySpec { position: at.into(), ..b }]
}

/// Two facing edges at 0, 1e-7 or 1e-3 rad, overlapping a little: boxes, or polygons with a face down.
fn parallel([a, b]: Pair, k: usize, random: &mut Pcg32) -> Pair {
    let tilt = [0.0, 1e-7, -1e-7, 1e-3, -1e-3][k % 5];
    let angle = if k.is_multiple_of(2) { 0.0 } else { a.angle };
    let faced = |spec: BodySpec, angle: f64| match &spec.shape {
        ShapeSpec::Polygon(v) => {
            // The edge 0–1 looks along +x where the body is turned by minus the angle of its normal.
            let edge = DVec2::from(v[1]) - DVec2::from(v[0]);
            let normal = -edge.perp();
            BodySpec { angle: angle - normal.y.atan2(normal.x), ..spec }
        }
        _ => BodySpec { angle, ..spec },
    };
    let (a, b) = (faced(a, angle), faced(b, angle + std::f64::consts::PI + tilt));
    let direction = DVec2::from_angle(angle);
    let depth = random.random_range(-1e-3..5e-3);
    touching([a, b], direction, -depth)
}

/// Two boxes or polygons corner to corner, within a thousandth of their size: where `PREFER_A` decides.
fn corners(random: &mut Pcg32) -> Pair {
    let sides = random.random_range(3..=8);
    let square = |half: f64| ShapeSpec::Box([half, half]);
    let a = placed(square(1.0), DVec2::ZERO, 0.0);
    let (size, turn) = (10f64.powf(random.random_range(-1.0..1.0)), random.random_range(0.1..1.4));
    let b = if random.random() {
        placed(
            square(size),
            DVec2::new(size * (DVec2::from_angle(turn).x + DVec2::from_angle(turn).y), 0.0),
            turn,
        )
    } else {
        placed(outline(size, 1.0, random), DVec2::new(0.0, 0.0), turn)
    };
    // B's leftmost corner, a few ten-thousandths of a metre from A's upper right one.
    let bodies = bodies_of::<f64>(std::slice::from_ref(&b));
    let solid = Solid::new(&bodies, 1);
    let left =
        solid.vertices.iter().copied().fold(DVec2::MAX, |l, v| if v.x < l.x { v } else { l }) + solid.centre;
    let near = DVec2::new(random.random_range(-3e-3..1e-3), random.random_range(-1e-3..3e-3));
    let pair = shifted([a, b], DVec2::ONE + near - left);
    if sides < 6 { pair } else { [pair[1].clone(), pair[0].clone()] }
}

/// Equal boxes exactly on or in each other, on the axes or turned together.
fn stacked(k: usize, random: &mut Pcg32) -> Pair {
    let half = [[0.5, 0.5], [1.0, 0.25], [0.3, 0.7]][k % 3];
    let angle = if k.is_multiple_of(2) { 0.0 } else { random.random_range(-3.0..3.0) };
    let depth = [0.0, 1e-3, 0.125][k / 3 % 3];
    let up = DVec2::from_angle(angle).perp() * (2.0 * half[1] - depth);
    let slide = DVec2::from_angle(angle) * [0.0, 0.0, half[0] * 0.5][k % 3];
    [placed(ShapeSpec::Box(half), DVec2::ZERO, angle), placed(ShapeSpec::Box(half), up + slide, angle)]
}

/// Bodies that rest on another: everything a resting contact does from step to step must keep its features.
pub(crate) fn resting() -> Vec<Pair> {
    let hexagon = |size: f64| {
        let corner = |k: i32| DVec2::from_angle(f64::from(k) * std::f64::consts::FRAC_PI_3) * size;
        ShapeSpec::Polygon((0..6).map(|k| corner(k).into()).collect())
    };
    let height = 3f64.sqrt() / 2.0;
    let square = |half: f64| ShapeSpec::Box([half, half]);
    [
        (square(0.5), 0.5, square(0.5), 0.5),
        (ShapeSpec::Box([10.0, 0.3]), 0.3, square(0.5), 0.5),
        (ShapeSpec::Box([10.0, 0.3]), 0.3, hexagon(1.0), height),
        (square(0.5), 0.5, hexagon(2.0), 2.0 * height),
        (hexagon(1.0), height, hexagon(1.0), height),
        (hexagon(3.0), 3.0 * height, square(0.2), 0.2),
    ]
    .into_iter()
    .flat_map(|(below, top, above, bottom)| {
        [0.0, 0.123].map(|slide| {
            let at = [slide, top + bottom - 1e-3];
            [BodySpec::new(below.clone(), [0.0, 0.0]), BodySpec::new(above.clone(), at)]
        })
    })
    .collect()
}
