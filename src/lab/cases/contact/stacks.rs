//! B18, B21 and B22: what statics says of stacks, overhangs and arches.

use std::f64::consts::PI;

use lamina2d::force::Forces;
use lamina2d::scene::basics::floor;
use lamina2d::scene::named::scene;
use lamina2d::vec2::Rot;

use super::{BodySpec, GRAVITY, Scene, ShapeSpec};
use crate::cases::mass;

/// Of B18's boxes from the lowest up, kg.
const STACK_KG: [f64; 10] = [1.0, 3.0, 2.0, 5.0, 1.0, 4.0, 2.0, 1.0, 3.0, 2.0];

fn boxed(half: [f64; 2], position: [f64; 2]) -> BodySpec {
    BodySpec::new(ShapeSpec::Box(half), position).surface(0.0, 0.5)
}

/// B18: ten boxes of 1 m on each other.
pub(super) fn stack() -> Scene {
    let one = |(k, kg): (usize, f64)| boxed([0.5, 0.5], [0.0, 0.5 + k as f64]).mass(kg);
    let bodies = std::iter::once(floor(0.5, 0.0)).chain(STACK_KG.into_iter().enumerate().map(one)).collect();
    scene("boxes of many masses on each other", bodies, Forces::gravity(), 600)
}

/// What each box of B18's stack is carried with, N: the weight of all from it up.
pub fn stack_loads(scene: &Scene) -> Vec<f64> {
    let boxes = &scene.bodies[1..];
    (0..boxes.len()).map(|k| boxes[k..].iter().map(mass).sum::<f64>() * GRAVITY).collect()
}

/// By how much the upper box of B18's pair is to the right, metres, and the masses of both, kg.
const OFFSET_M: f64 = 0.25;
const OFFSET_KG: [f64; 2] = [2.0, 1.0];

/// B18: a box of 1 kg, 0.25 m to the right of one of 2 kg that carries it.
pub(super) fn offset() -> Scene {
    let lower = boxed([0.5, 0.5], [0.0, 0.5]).mass(OFFSET_KG[0]);
    let upper = boxed([0.5, 0.5], [OFFSET_M, 1.5]).mass(OFFSET_KG[1]);
    scene("a box off the middle of another", vec![floor(0.5, 0.0), lower, upper], Forces::gravity(), 600)
}

/// Left and right load, N, under the lower and under the upper box of B18's pair.
///
/// The floor pushes at ±½ m: sum Mg, and ½(R − L) = mgd. The upper box rests on its own left corner at d − ½ and on the
/// lower one's right corner at ½: L + R = mg and, about its centre, R(½ − d) = ½L.
pub fn offset_loads() -> [[f64; 2]; 2] {
    let [lower, upper] = OFFSET_KG.map(|kg| kg * GRAVITY);
    let (half, tilt) = (0.5 * (lower + upper), upper * OFFSET_M);
    let right = 0.5 / (1.0 - OFFSET_M);
    [[half - tilt, half + tilt], [upper * (1.0 - right), upper * right]]
}

/// Blocks of B21.
pub const OVERHANG_BLOCKS: usize = 5;
/// Half the length and half the thickness of a block, metres.
const BLOCK: [f64; 2] = [0.5, 0.1];

/// B21: blocks of 1 m at the edge of a table, each `share` of as far beyond the one below as it can be.
///
/// The k-th from the top reaches 1/2k beyond the next: the k blocks down to it have their common centre ½/k to the left
/// of its right end, as Σ adds up to ½LΣ1/k. The table's edge is at x = 0; bodies: the table, blocks from below.
pub fn overhang(share: f64) -> Scene {
    let table = boxed([5.0, 0.5], [-5.0, -0.5]).fixed();
    let mut right = 0.0;
    let blocks = (1..=OVERHANG_BLOCKS).rev().enumerate().map(|(storey, k)| {
        right += share * BLOCK[0] / k as f64;
        boxed(BLOCK, [right - BLOCK[0], (2.0 * storey as f64 + 1.0) * BLOCK[1]])
    });
    let bodies = std::iter::once(table).chain(blocks).collect();
    scene("blocks that reach out over an edge", bodies, Forces::gravity(), 300)
}

/// Least thickness over mean radius of a semicircular arch with radial joints that carries itself: Milankovitch
/// (1907), Heyman (1969): 0.1075.
pub const ARCH_LIMIT: f64 = 0.1075;
const ARCH_RADIUS_M: f64 = 5.0;
const VOUSSOIRS: usize = 31;

/// B22: a semicircular arch of 31 wedges with radial joints, `ratio` of its mean radius thick, on two static springers;
/// μ = 2, so that nothing slides.
pub fn arch(ratio: f64) -> Scene {
    let half = 0.5 * ratio * ARCH_RADIUS_M;
    let along = |joint: usize| Rot::from_angle(PI * joint as f64 / VOUSSOIRS as f64);
    let on = |joint: usize, radius: f64| [along(joint).c * radius, along(joint).s * radius];
    let [inner, outer] = [ARCH_RADIUS_M - half, ARCH_RADIUS_M + half];
    let springer = |side: f64| {
        let shape = ShapeSpec::Box([2.0 * half, 0.5]);
        BodySpec::new(shape, [side * ARCH_RADIUS_M, -0.5]).surface(0.0, 2.0).fixed()
    };
    let voussoir = |k: usize| {
        let outline = vec![on(k, inner), on(k, outer), on(k + 1, outer), on(k + 1, inner)];
        BodySpec::new(ShapeSpec::Polygon(outline), [0.0; 2]).surface(0.0, 2.0)
    };
    let bodies = [springer(1.0), springer(-1.0)].into_iter().chain((0..VOUSSOIRS).map(voussoir)).collect();
    scene("an arch as thin as it can be", bodies, Forces::gravity(), 600)
}
