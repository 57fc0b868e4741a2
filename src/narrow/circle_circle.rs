//! Circle against circle: s = |xB − xA| − (rA + rB) along the line of centres.

use super::{Found, Pose};
use crate::lanes::Lanes;

/// One point, midway between the circles; coincident centres part along +y.
#[inline(always)]
pub(super) fn collide<L: Lanes>(a: &Pose<L>, b: &Pose<L>, margin: L) -> Found<L> {
    let (normal, distance) = (b.x - a.x).normalized();
    let separation = distance - (a.extent.x + b.extent.x);
    let arm = normal * (a.extent.x + L::lit(0.5) * separation);
    Found::single(normal, arm, separation, margin)
}
