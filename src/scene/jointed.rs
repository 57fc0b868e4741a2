//! Scenes held together by joints.

use super::named::scene;
use super::{BodySpec, Scene, ShapeSpec};
use crate::force::Forces;
use crate::joint::{JointKind, JointSpec};
use crate::vec2::{Rot, Vec2};

/// From joint to joint of a chain or bridge, metres.
const PITCH_M: f64 = 0.5;
/// Half the length and half the thickness of a link: between two there are 4 cm.
const LINK_HALF: [f64; 2] = [0.23, 0.05];
/// Of what a chain or bridge hangs from.
const PIN_RADIUS_M: f64 = 0.05;

fn joined(scene: Scene, joints: Vec<JointSpec>) -> Scene {
    Scene { joints, ..scene }
}

fn disc(radius: f64, position: [f64; 2]) -> BodySpec {
    BodySpec::new(ShapeSpec::Circle(radius), position).surface(0.0, 0.6)
}

/// `n` links of 0.5 m, level at first, hinged to each other and at the left end to a static disc at the origin;
/// with `end_weight` a disc of so many times the mass of a link hangs at the other end.
///
/// Bodies: the static disc, the links from left to right, the weight. Joints likewise: the k-th is at (k/2, 0).
pub fn chain(n: usize, end_weight: Option<f64>) -> Scene {
    let joint_at = |k: usize| [k as f64 * PITCH_M, 0.0];
    let mass = 4.0 * LINK_HALF[0] * LINK_HALF[1];
    let support = disc(PIN_RADIUS_M, [-PIN_RADIUS_M, 0.0]).fixed();
    let links = (0..n).map(|k| {
        let middle = [(k as f64 + 0.5) * PITCH_M, 0.0];
        BodySpec::new(ShapeSpec::Box(LINK_HALF), middle).surface(0.0, 0.6)
    });
    let weight = end_weight.map(|ratio| disc(0.4, [joint_at(n)[0] + 0.4, 0.0]).mass(ratio * mass));
    let bodies: Vec<_> = std::iter::once(support).chain(links).chain(weight).collect();
    let joints = (1..bodies.len()).map(|k| JointSpec::new(k - 1, k, JointKind::hinge(joint_at(k - 1))));
    let joints = joints.collect();
    joined(scene("a chain that swings from one end", bodies, Forces::gravity(), 600), joints)
}

/// Angle of the arc a bridge hangs in at first, rad: a tenth of its span deep.
const BRIDGE_ARC_RAD: f64 = 0.8;

/// `n` planks of 0.5 m hinged to each other, and at both ends to static discs, along an arc of a circle.
///
/// Bodies: the left disc, the planks from left to right, the right disc; the k-th joint is between the k-th body and
/// the next.
pub fn bridge(n: usize) -> Scene {
    let sector = BRIDGE_ARC_RAD / n as f64;
    let radius = PITCH_M / (2.0 * Rot::from_angle(sector / 2.0).s);
    // About the lowest point of the circle, from left to right.
    let on_arc = |angle: f64| {
        let rot = Rot::from_angle(angle);
        [radius * rot.s, -radius * rot.c]
    };
    let joint_angle = |k: usize| (k as f64 - n as f64 / 2.0) * sector;
    let planks = (0..n).map(|k| {
        let ([ax, ay], [bx, by]) = (on_arc(joint_angle(k)), on_arc(joint_angle(k + 1)));
        let middle = [f64::midpoint(ax, bx), f64::midpoint(ay, by)];
        BodySpec::new(ShapeSpec::Box(LINK_HALF), middle)
            .turned(f64::midpoint(joint_angle(k), joint_angle(k + 1)))
            .surface(0.0, 0.6)
    });
    let support = |k: usize, side: f64| {
        let rot = Rot::from_angle(joint_angle(k));
        let out = rot.apply(Vec2::new(side * PIN_RADIUS_M, 0.0));
        let [x, y] = on_arc(joint_angle(k));
        disc(PIN_RADIUS_M, [x + out.x, y + out.y]).fixed()
    };
    let bodies: Vec<_> =
        std::iter::once(support(0, -1.0)).chain(planks).chain(std::iter::once(support(n, 1.0))).collect();
    let joints =
        (0..=n).map(|k| JointSpec::new(k, k + 1, JointKind::hinge(on_arc(joint_angle(k))))).collect();
    joined(scene("a hanging bridge", bodies, Forces::gravity(), 600), joints)
}

/// `side` × `side` discs of 0.4 m, 1 m apart, row by row from the upper left, each hinged to its right and its lower
/// neighbour half way between; the upper corners are static.
pub fn joint_grid(side: usize) -> Scene {
    let at = |k: usize| [(k % side) as f64, -((k / side) as f64)];
    let bodies = (0..side * side).map(|k| {
        let body = disc(0.4, at(k));
        if k == 0 || k + 1 == side { body.fixed() } else { body }
    });
    let mut joints = Vec::new();
    for k in 0..side * side {
        let [x, y] = at(k);
        // Two static corners beside each other take no joint.
        let both_fixed = side == 2 && k == 0;
        if (k + 1) % side != 0 && !both_fixed {
            joints.push(JointSpec::new(k, k + 1, JointKind::hinge([x + 0.5, y])));
        }
        if k / side + 1 < side {
            joints.push(JointSpec::new(k, k + side, JointKind::hinge([x, y - 0.5])));
        }
    }
    joined(scene("a net of jointed circles", bodies.collect(), Forces::gravity(), 600), joints)
}

/// A disc of 1 kg on a massless rod of 1 m, let go level; the rod ends in its centre, so that it does not turn.
pub fn pendulum() -> Scene {
    let bodies = vec![disc(PIN_RADIUS_M, [0.0; 2]).fixed(), disc(0.1, [1.0, 0.0]).mass(1.0)];
    let joints = vec![JointSpec::new(0, 1, JointKind::rod())];
    joined(scene("a disc on a rod", bodies, Forces::gravity(), 600), joints)
}
