//! Circle against box: the box's point closest to the centre, found by clamping in the box's frame.

use super::{Found, Pose};
use crate::lanes::Lanes;
use crate::vec2::Vec2;

/// A is the circle, B the box. A centre inside leaves by the nearest face.
#[inline(always)]
pub(super) fn collide<L: Lanes>(a: &Pose<L>, b: &Pose<L>, margin: L) -> Found<L> {
    let (radius, half) = (a.extent.x, b.extent);
    let centre = b.rot.apply_inverse(a.x - b.x);
    let closest = Vec2::new(clamp(centre.x, half.x), clamp(centre.y, half.y));
    let (outward, distance) = (centre - closest).normalized();

    // Inside, the clamp changes nothing and the distance is exactly 0.
    let inside = distance.le(L::zero());
    let depth = Vec2::new(half.x - centre.x.abs(), half.y - centre.y.abs());
    let sign = |v: L| L::select(v.lt(L::zero()), -L::one(), L::one());
    let through_x = depth.x.lt(depth.y);
    let face =
        Vec2::select(through_x, Vec2::new(sign(centre.x), L::zero()), Vec2::new(L::zero(), sign(centre.y)));
    let outward = Vec2::select(inside, face, outward);
    let distance = L::select(inside, -depth.x.min(depth.y), distance);

    let normal = -b.rot.apply(outward);
    let separation = distance - radius;
    Found::single(normal, normal * (radius + L::lit(0.5) * separation), separation, margin)
}

#[inline(always)]
fn clamp<L: Lanes>(v: L, bound: L) -> L {
    (-bound).max(bound.min(v))
}
