//! What two bodies do that meet within a step.

use glam::DVec2;

use crate::body::{Bodies, Placed};
use crate::each::Each as _;
use crate::lanes::Real;

/// A body's motion at an instant.
#[derive(Clone, Copy, Debug)]
pub(super) struct Motion {
    pub(super) velocity: DVec2,
    pub(super) spin: f64,
}

impl Motion {
    pub(super) fn of<R: Real>(bodies: &Bodies<R>, slot: usize) -> Self {
        let [x, y, spin] = [&bodies.vx, &bodies.vy, &bodies.w].each(|column| column[slot].to_f64());
        Self { velocity: DVec2::new(x, y), spin }
    }

    fn at(&self, arm: DVec2) -> DVec2 {
        self.velocity + arm.perp() * self.spin
    }
}

/// Where two shapes touch that meet along an axis: a corner, or the middle of what lies face to face, metres.
fn meeting_point(a: &Placed, b: &Placed, axis: DVec2) -> DVec2 {
    let tangent = axis.perp();
    let reached = |placed: &Placed, axis: DVec2| {
        let most = placed.extent(axis);
        if placed.count == 0 {
            let along = (placed.centre + axis * most).dot(tangent);
            return ([along; 2], (placed.centre + axis * most).dot(axis));
        }
        // What lies as far out but for a hair is a face.
        let near = |v: &&DVec2| axis.dot(**v) >= most - 1e-3 * placed.corners()[0].length();
        let along = placed.corners().iter().filter(near).map(|v| (placed.centre + *v).dot(tangent));
        let ends = along.fold([f64::MAX, f64::MIN], |[low, high], at| [low.min(at), high.max(at)]);
        (ends, placed.centre.dot(axis) + most)
    };
    let (of_a, depth) = reached(a, axis);
    let (of_b, _) = reached(b, -axis);
    let along = 0.5 * (of_a[0].max(of_b[0]) + of_a[1].min(of_b[1]));
    tangent * along + axis * depth
}

/// Gives two bodies that meet along `axis`, from the first to the second, the impulse of their restitution, and friction
/// within its cone; says whether they approached. Newton's law for one point: jₙ = −(1 + e)·vₙ/kₙ.
pub(super) fn collide<R: Real>(
    bodies: &Bodies<R>,
    slots: [usize; 2],
    placed: [&Placed; 2],
    axis: DVec2,
    motions: [&mut Motion; 2],
) -> bool {
    let [a, b] = motions;
    let point = meeting_point(placed[0], placed[1], axis);
    let arms = placed.each(|placed| point - placed.centre);
    let [ma, mb] = slots.each(|slot| bodies.inv_mass[slot].to_f64());
    let [ia, ib] = slots.each(|slot| bodies.inv_inertia[slot].to_f64());
    let least = |column: &crate::column::Column<R>| {
        let [first, second] = slots.each(|slot| column[slot].to_f64());
        first.min(second)
    };
    let response = |way: DVec2| {
        let [la, lb] = arms.each(|arm| arm.perp_dot(way));
        ma + mb + ia * la * la + ib * lb * lb
    };
    let give = |a: &mut Motion, b: &mut Motion, impulse: DVec2| {
        a.velocity -= impulse * ma;
        b.velocity += impulse * mb;
        a.spin -= ia * arms[0].perp_dot(impulse);
        b.spin += ib * arms[1].perp_dot(impulse);
    };
    let approach = (b.at(arms[1]) - a.at(arms[0])).dot(axis);
    let k = response(axis);
    let normal = -(1.0 + least(&bodies.restitution)) * approach / k;
    // A state that is not finite is told of as the step ends.
    if approach >= 0.0 || k <= 0.0 || !normal.is_finite() {
        return false;
    }
    give(a, b, axis * normal);
    let across = axis.perp();
    let slip = (b.at(arms[1]) - a.at(arms[0])).dot(across);
    let bound = least(&bodies.friction) * normal;
    give(a, b, across * (-slip / response(across)).clamp(-bound, bound));
    true
}
