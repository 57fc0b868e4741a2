//! B26: a chain that hangs from both ends.

use lamina2d::force::Forces;
use lamina2d::joint::{JointKind, JointSpec};
use lamina2d::scene::named::scene;

use super::{BodySpec, Scene, ShapeSpec};
use crate::cases::{Exact, moved};

/// Links of B26; half the way from joint to joint and half the thickness of one, and from end to end, metres.
const LINKS: usize = 20;
const LINK: [f64; 2] = [0.25, 0.02];
const SPAN_M: f64 = 8.0;
/// What sag is compared with, metres.
pub const CHAIN_LENGTH_M: f64 = 2.0 * LINK[0] * LINKS as f64;

/// Slope of the k-th of n links, rad, for a horizontal tension of so many weights of a link.
///
/// The pulls at the ends of link i (from 1) are H across, and w(N/2 − i + 1) and w(N/2 − i) up; about its centre they
/// balance along the link: tan θ = w(N + 1 − 2i)/2H, here downwards.
fn slope(k: usize, tension: f64) -> f64 {
    -((LINKS as f64 - 1.0 - 2.0 * k as f64) / (2.0 * tension)).atan()
}

/// The horizontal tension, weights of a link: Σℓ cos θ = span, by halving; the span grows with it.
fn tension() -> f64 {
    let span = |tension: f64| (0..LINKS).map(|k| 2.0 * LINK[0] * slope(k, tension).cos()).sum::<f64>();
    let (mut low, mut high) = (0.0, 1e3);
    for _ in 0..100 {
        let middle = f64::midpoint(low, high);
        if span(middle) < SPAN_M { low = middle } else { high = middle }
    }
    f64::midpoint(low, high)
}

/// Where the joints of the chain are at rest, metres, from left to right, and the slopes of the links between.
pub fn chain_at() -> (Vec<[f64; 2]>, Vec<f64>) {
    let tension = tension();
    let slopes: Vec<f64> = (0..LINKS).map(|k| slope(k, tension)).collect();
    let mut joints = vec![[0.0, 0.0]];
    let mut at = [0.0, 0.0];
    for slope in &slopes {
        at = [at[0] + 2.0 * LINK[0] * slope.cos(), at[1] + 2.0 * LINK[0] * slope.sin()];
        joints.push(at);
    }
    (joints, slopes)
}

/// B26: twenty links of 0.5 m hung 8 m apart, where they rest. Bodies: the left post, the links, the right post.
pub(super) fn hanging() -> Scene {
    let (joints, slopes) = chain_at();
    let post = |[x, y]: [f64; 2], side: f64| {
        BodySpec::new(ShapeSpec::Circle(0.02), [x + 0.1 * side, y]).surface(0.0, 0.0).fixed()
    };
    let link = |k: usize| {
        let middle = [0, 1].map(|axis| f64::midpoint(joints[k][axis], joints[k + 1][axis]));
        // Shorter than from joint to joint: neighbours do not touch, and it is the joints that are asked.
        let shape = ShapeSpec::Box([LINK[0] - LINK[1], LINK[1]]);
        BodySpec::new(shape, middle).turned(slopes[k]).surface(0.0, 0.0)
    };
    let bodies: Vec<_> = std::iter::once(post(joints[0], -1.0))
        .chain((0..LINKS).map(link))
        .chain(std::iter::once(post(joints[LINKS], 1.0)))
        .collect();
    let hinge = |k: usize| JointSpec::new(k, k + 1, JointKind::hinge(joints[k]));
    let hinges = (0..=LINKS).map(hinge).collect();
    let scene = scene("a chain that hangs from both ends", bodies, Forces::gravity(), 600);
    Scene { joints: hinges, ..scene }
}

/// Where it began: at rest.
pub(super) fn hanging_at(scene: &Scene, _: f64) -> Vec<Exact> {
    (1..=LINKS).map(|k| moved(k, &scene.bodies[k], glam::DVec2::ZERO, 0.0)).collect()
}
