//! Box against box from half-extents alone: four axes, no vertices.
//!
//! With d = xB − xA and R = Rₐᵀ·R_b = [c −s; s c], the separation along A's x axis is
//! |d·ax| − hAx − (|c|·hBx + |s|·hBy), and likewise for the other three.

use super::clip::{PREFER_A, Reference, any_within, clip};
use super::{Found, Pose};
use crate::lanes::Lanes;
use crate::vec2::{Rot, Vec2};

/// Two boxes.
#[inline(always)]
pub(super) fn collide<L: Lanes>(a: &Pose<L>, b: &Pose<L>, margin: L) -> Found<L> {
    let d = b.x - a.x;
    let (d_a, d_b) = (a.rot.apply_inverse(d), b.rot.apply_inverse(d));
    let turn = a.rot.relative(b.rot);
    let (c, s) = (turn.c.abs(), turn.s.abs());
    let reach = |h: Vec2<L>| Vec2::new(c * h.x + s * h.y, s * h.x + c * h.y);
    let apart = |d: Vec2<L>, own: Vec2<L>, other: Vec2<L>| {
        let reach = reach(other);
        Vec2::new(d.x.abs() - own.x - reach.x, d.y.abs() - own.y - reach.y)
    };
    let (sep_a, sep_b) = (apart(d_a, a.extent, b.extent), apart(d_b, b.extent, a.extent));
    let (best_a, best_b) = (sep_a.x.max(sep_a.y), sep_b.x.max(sep_b.y));
    let separation = best_a.max(best_b);
    if !any_within(separation, margin) {
        return Found::nothing();
    }

    let smaller = a.extent.x.min(a.extent.y).min(b.extent.x.min(b.extent.y));
    let flipped = (best_a + smaller * L::lit(PREFER_A)).lt(best_b);
    let pick = |if_a: Vec2<L>, if_b: Vec2<L>| Vec2::select(flipped, if_b, if_a);
    let own = pick(a.extent, b.extent);
    let other = pick(b.extent, a.extent);
    let sep = pick(sep_a, sep_b);
    let to_other = pick(d_a, -d_b);
    let rot = select_rot(flipped, b.rot, a.rot);
    let other_rot = select_rot(flipped, a.rot, b.rot);

    let (face, face_index) = face_towards(sep.y.le(sep.x), to_other, own);
    let normal = rot.apply(face.normal);
    let reference = Reference {
        normal,
        offset: face.offset,
        start: -face.half_width,
        length: face.half_width + face.half_width,
    };

    // The incident edge is the face of the other box that looks most against the normal.
    let against = other_rot.apply_inverse(-normal);
    let (incident, incident_index) = face_towards(against.y.abs().le(against.x.abs()), against, other);
    let outward = other_rot.apply(incident.normal);
    let centre = pick(d, -d) + outward * incident.offset;
    let side = -outward.right() * incident.half_width;
    let feature = L::select(flipped, L::lit(128.0), L::zero())
        + face_index * L::lit(16.0)
        + incident_index * L::lit(2.0);
    clip(&reference, [centre - side, centre + side], flipped, d, feature, margin)
        .unless_apart(separation, margin)
}

/// A face in its box's frame.
struct Face<L> {
    normal: Vec2<L>,
    offset: L,
    half_width: L,
}

/// The x face (where `through_x`) or y face on the side `direction` points to, and its number 0–3.
#[inline(always)]
fn face_towards<L: Lanes>(through_x: L::Mask, direction: Vec2<L>, half: Vec2<L>) -> (Face<L>, L) {
    let along = L::select(through_x, direction.x, direction.y);
    let negative = along.lt(L::zero());
    let sign = L::select(negative, -L::one(), L::one());
    let face = Face {
        normal: Vec2::select(through_x, Vec2::new(sign, L::zero()), Vec2::new(L::zero(), sign)),
        offset: L::select(through_x, half.x, half.y),
        half_width: L::select(through_x, half.y, half.x),
    };
    let index = L::select(through_x, L::zero(), L::one()) + L::select(negative, L::lit(2.0), L::zero());
    (face, index)
}

#[inline(always)]
fn select_rot<L: Lanes>(mask: L::Mask, a: Rot<L>, b: Rot<L>) -> Rot<L> {
    Rot { c: L::select(mask, a.c, b.c), s: L::select(mask, a.s, b.s) }
}
