//! Scenes that stand: pyramids, columns, unequal masses and sizes, an arch, a house of cards.
//!
//! Bodies touch exactly, or are at most 0.1 mm apart; none overlaps another. What is meant to stand can:
//! contact forces that balance every weight within the friction cones exist for arch and cards as placed.

use super::named::scene;
use super::{BodySpec, Scene, ShapeSpec};
use crate::force::Forces;
use crate::vec2::{Rot, Vec2};

/// Steps of a minute.
const MINUTE: u64 = 3600;
/// Boxes in the lowest row of each of many pyramids.
const SMALL_BASE: usize = 10;
/// Between neighbours of a pyramid's row, metres: a power of two, so that every position is exact.
const GAP_M: f64 = 1.0 / 64.0;

/// A static floor with its top at height `top`, centred at `x`; metres.
fn floor(x: f64, top: f64, half_width: f64, friction: f64) -> BodySpec {
    BodySpec::new(ShapeSpec::Box([half_width, 0.5]), [x, top - 0.5]).surface(0.0, friction).fixed()
}

/// A box of density 1 that does not bounce, by its half-extents, metres.
fn brick(half: [f64; 2], position: [f64; 2], friction: f64) -> BodySpec {
    BodySpec::new(ShapeSpec::Box(half), position).surface(0.0, friction)
}

/// Rows of `base`, `base` − 1, … 1 boxes of 1 m, the middle of the lowest row's lower side at `foot`.
fn rows(base: usize, foot: [f64; 2]) -> impl Iterator<Item = BodySpec> {
    (0..base).flat_map(move |row| {
        let boxes = base - row;
        (0..boxes).map(move |k| {
            let x = (k as f64 - (boxes as f64 - 1.0) / 2.0) * (1.0 + GAP_M);
            brick([0.5, 0.5], [foot[0] + x, foot[1] + 0.5 + row as f64], 0.6)
        })
    })
}

/// One pyramid on a wide floor: 1 static body, `base`·(`base` + 1)/2 boxes.
pub fn pyramid(base: usize) -> Scene {
    let ground = floor(0.0, 0.0, 0.5 * base as f64 * (1.0 + GAP_M) + 20.0, 0.6);
    let bodies = std::iter::once(ground).chain(rows(base, [0.0; 2])).collect();
    scene("a pyramid of boxes", bodies, Forces::gravity(), 600)
}

/// Small pyramids side by side on storeys of ⌈√n⌉ each: a static floor per storey, 55 boxes per pyramid.
pub fn pyramids(n: usize) -> Scene {
    let across = (n as f64).sqrt().ceil() as usize;
    let pitch = 16.0;
    let storeys = n.div_ceil(across);
    let middle = (across as f64 - 1.0) / 2.0 * pitch;
    let floors = (0..storeys).map(|s| floor(middle, s as f64 * pitch, middle + pitch / 2.0, 0.6));
    let all =
        (0..n).flat_map(|k| rows(SMALL_BASE, [(k % across) as f64 * pitch, (k / across) as f64 * pitch]));
    scene("many small pyramids", floors.chain(all).collect(), Forces::gravity(), 600)
}

/// `n` boxes of 1 m on each other, 1 cm to the right and to the left in turn, on a static floor.
pub fn columns(n: usize) -> Scene {
    let boxes = (0..n).map(|k| {
        let x = if k % 2 == 0 { 0.01 } else { -0.01 };
        brick([0.5, 0.5], [x, 0.5 + k as f64], 0.5)
    });
    let bodies = std::iter::once(floor(0.0, 0.0, 20.0, 0.5)).chain(boxes).collect();
    scene("a column of boxes, each a little off", bodies, Forces::gravity(), MINUTE)
}

/// A box of 1 m and 1 kg on a static floor, and on it the same box with `ratio` kg.
pub fn heavy(ratio: usize) -> Scene {
    let light = brick([0.5, 0.5], [0.0, 0.5], 0.6);
    let heavy = brick([0.5, 0.5], [0.0, 1.5], 0.6).mass(ratio as f64);
    let bodies = vec![floor(0.0, 0.0, 20.0, 0.6), light, heavy];
    scene("a heavy box on a light one", bodies, Forces::gravity(), MINUTE)
}

/// Boxes of 1, 2, 4, 8, 16 and 32 m and of density 1, the smallest at the bottom, on a static floor.
pub fn sizes() -> Scene {
    let boxes = (0..6).map(|k| {
        let size = f64::from(1 << k);
        // What lies below is 1 + 2 + … = size − 1 high.
        brick([size / 2.0, size / 2.0], [0.0, size - 1.0 + size / 2.0], 0.6)
    });
    let bodies = std::iter::once(floor(0.0, 0.0, 100.0, 0.6)).chain(boxes).collect();
    scene("each box twice the size of the one below", bodies, Forces::gravity(), MINUTE)
}

/// A box of 20 m and 400 kg on two of 1 m and 1 kg, on a static floor.
pub fn two_feet() -> Scene {
    let foot = |x| brick([0.5, 0.5], [x, 0.5], 0.6);
    let bodies =
        vec![floor(0.0, 0.0, 40.0, 0.6), foot(-9.0), foot(9.0), brick([10.0, 10.0], [0.0, 11.0], 0.6)];
    scene("a large box on two small feet", bodies, Forces::gravity(), MINUTE)
}

/// Mean radius and thickness of the arch, metres: t/R = 0.28, where a bare one falls below 0.1075.
const ARCH_RADIUS_M: f64 = 5.0;
const ARCH_THICKNESS_M: f64 = 1.4;
/// Odd, so that there is a keystone.
const VOUSSOIRS: usize = 17;

/// A semicircular arch of 17 wedges with radial joints on two static springers, four boxes on its
/// keystone, a static floor 1 m below: 24 bodies.
pub fn arch() -> Scene {
    let (inner, outer) = (ARCH_RADIUS_M - ARCH_THICKNESS_M / 2.0, ARCH_RADIUS_M + ARCH_THICKNESS_M / 2.0);
    let springer = |side: f64| {
        let half = [ARCH_THICKNESS_M, 0.5];
        BodySpec::new(ShapeSpec::Box(half), [side * ARCH_RADIUS_M, -0.5]).surface(0.0, 0.6).fixed()
    };
    let along = |joint: usize| Rot::from_angle(std::f64::consts::PI * joint as f64 / VOUSSOIRS as f64);
    let on = |joint: usize, radius: f64| [along(joint).c * radius, along(joint).s * radius];
    let voussoir = |k: usize| {
        // Neighbours are given the same corners: their faces meet to the last bit.
        let outline = vec![on(k, inner), on(k, outer), on(k + 1, outer), on(k + 1, inner)];
        BodySpec::new(ShapeSpec::Polygon(outline), [0.0; 2]).surface(0.0, 0.6)
    };
    let crown = on(VOUSSOIRS / 2, outer)[1];
    // As wide as the keystone nearly is: nothing else is touched.
    let load = |k: usize| brick([0.5, 0.25], [0.0, crown + 0.25 + 0.5 * k as f64], 0.6);
    let bodies = [floor(0.0, -1.0, 20.0, 0.6), springer(1.0), springer(-1.0)]
        .into_iter()
        .chain((0..VOUSSOIRS).map(voussoir))
        .chain((0..4).map(load))
        .collect();
    scene("an arch of wedges that carries four boxes", bodies, Forces::gravity(), MINUTE)
}

/// Half the length and half the thickness of a card, metres.
const CARD_HALF: [f64; 2] = [0.2, 0.001];
/// Between the ends of lying cards, metres: half of what still counts as touching.
const CARD_GAP_M: f64 = 5e-5;
/// How much further in the outermost pairs of a storey stand, metres: the lying card there reaches over
/// the tops of both their cards instead of hanging on the friction between them.
const CARD_REACH_M: f64 = 0.02;

/// A house of cards: storeys of `levels`, `levels` − 1, … 1 leaning pairs with cards lying on them, on a
/// static floor; `levels`·(`levels` + 1) cards lean, `levels`·(`levels` − 1)/2 lie.
///
/// Lying cards meet end to end over the pairs' tops, each resting on the nearer card of either pair.
pub fn cards(levels: usize) -> Scene {
    let [half_length, half_thickness] = CARD_HALF;
    let card = |half, position| brick(half, position, 0.7);
    let lean_rad = 25f64.to_radians();
    let lean = Rot::from_angle(lean_rad);
    // A card leaning to the right, about its centre: its corner at the right touches the other card, the
    // one at the top carries, which is as far above the centre as the one at the bottom is below.
    let right_corner = lean.apply_inverse(Vec2::new(half_thickness, half_length));
    let top_corner = lean.apply_inverse(Vec2::new(-half_thickness, half_length));
    let pitch = 2.0 * half_length + CARD_GAP_M;
    let storey = 2.0 * (top_corner.y + half_thickness);
    let mut bodies = vec![floor(0.0, 0.0, 0.5 * levels as f64 * pitch + 2.0, 0.7)];
    for level in 0..levels {
        let pairs = levels - level;
        let bottom = level as f64 * storey;
        let middle = |k: usize, of: usize| (k as f64 - (of as f64 - 1.0) / 2.0) * pitch;
        for k in 0..pairs {
            let inward = f64::from(u8::from(k == 0)) - f64::from(u8::from(k + 1 == pairs));
            let x = middle(k, pairs) + inward * CARD_REACH_M;
            for side in [-1.0, 1.0] {
                let centre = [x + side * right_corner.x, bottom + top_corner.y];
                let upright = [half_thickness, half_length];
                bodies.push(card(upright, centre).turned(side * lean_rad));
            }
        }
        let lying = bottom + 2.0 * top_corner.y + half_thickness;
        bodies.extend((1..pairs).map(|k| card(CARD_HALF, [middle(k - 1, pairs - 1), lying])));
    }
    scene("a house of cards", bodies, Forces::gravity(), MINUTE)
}
