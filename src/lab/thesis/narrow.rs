//! The three narrow tests, written once over [`Hull`] for both layouts.

use glam::Vec2;

use super::resolve::Contact;

/// A convex outline in the window's axes that knows the normals of its edges.
pub(super) trait Hull {
    /// Whether the separating-axis loop may end at the first axis that separates. The answer is the same;
    /// the original runs through.
    const STOPS_EARLY: bool;

    /// The corners, px, at the body's present place.
    fn corners(&self) -> &[Vec2];

    /// The outward unit normal of the edge from corner `k` to the next.
    fn normal(&self, k: usize) -> Vec2;

    /// Whether a circle whose centre is inside gets the inward normal.
    ///
    /// Boxes are wound one way and polygons the other in the original; one of its branches misses the
    /// difference, so polygons pull such circles further in and boxes push them out.
    fn swallows_centres(&self) -> bool;
}

/// Do two bounding circles touch?
#[inline(always)]
pub(super) fn bounds_meet(a_px: Vec2, radius_a_px: f32, b_px: Vec2, radius_b_px: f32) -> bool {
    let reach = radius_a_px + radius_b_px;
    a_px.distance_squared(b_px) <= reach * reach
}

/// Two circles that [`bounds_meet`] has found touching: for them that is the narrow test.
///
/// Coincident centres have no direction: the normal is NaN, as in the original.
pub(super) fn circle_circle(a_px: Vec2, radius_a_px: f32, b_px: Vec2, radius_b_px: f32) -> Contact {
    let normal = (b_px - a_px).normalize();
    let (start_px, end_px) = (b_px - normal * radius_b_px, a_px + normal * radius_a_px);
    Contact { normal, depth_px: end_px.distance(start_px), start_px, end_px }
}

/// A hull (first) and a circle (second).
///
/// Takes the first edge that sees the centre outside. Near a corner the next edge may see it farther out;
/// the first edge then measures to its own end, or to its own line: a defect.
pub(super) fn hull_circle<H: Hull>(hull: &H, center_px: Vec2, radius_px: f32) -> Option<Contact> {
    let corners = hull.corners();
    let (mut edge, mut distance) = (0, -f32::MAX);
    for (k, &corner) in corners.iter().enumerate() {
        let above = (center_px - corner).dot(hull.normal(k));
        if above > distance {
            (edge, distance) = (k, above);
        }
        if above > 0.0 {
            break;
        }
    }
    let outward = hull.normal(edge);
    if distance <= 0.0 {
        let normal = if hull.swallows_centres() { -outward } else { outward };
        return Some(Contact {
            normal,
            depth_px: radius_px - distance,
            start_px: center_px - normal * radius_px,
            end_px: center_px - outward * distance,
        });
    }
    let (here, next) = (corners[edge], corners[(edge + 1) % corners.len()]);
    // Zones A and B: beyond either end of the edge the corner is what is nearest.
    for (corner, other) in [(here, next), (next, here)] {
        let from_corner = center_px - corner;
        if from_corner.dot(other - corner) < 0.0 {
            return outside(center_px, radius_px, from_corner.length(), || from_corner.normalize());
        }
    }
    outside(center_px, radius_px, distance, || outward)
}

/// The contact of a circle at `distance` from what is nearest of the hull; the direction only if it touches.
fn outside(
    center_px: Vec2,
    radius_px: f32,
    distance: f32,
    direction: impl FnOnce() -> Vec2,
) -> Option<Contact> {
    if distance > radius_px {
        return None;
    }
    let normal = direction();
    let depth_px = radius_px - distance;
    let start_px = center_px - normal * radius_px;
    Some(Contact { normal, depth_px, start_px, end_px: start_px + normal * depth_px })
}

/// Two hulls by the separating axis theorem: the axis of least overlap, one point, no clipping.
pub(super) fn hull_hull<H: Hull>(a: &H, b: &H) -> Option<Contact> {
    let by_a = least_overlap(a, b)?;
    let by_b = least_overlap(b, a)?;
    if by_a.gap > by_b.gap {
        let (normal, depth_px) = (a.normal(by_a.edge), -by_a.gap);
        let start_px = by_a.corner;
        Some(Contact { normal, depth_px, start_px, end_px: start_px + normal * depth_px })
    } else {
        let (normal, depth_px) = (-b.normal(by_b.edge), -by_b.gap);
        let end_px = by_b.corner;
        Some(Contact { normal, depth_px, start_px: end_px - normal * depth_px, end_px })
    }
}

/// The edge along whose normal the other hull reaches least far in.
struct Axis {
    edge: usize,
    /// Negative: how far.
    gap: f32,
    /// The other hull's corner that does.
    corner: Vec2,
}

/// `None` where an edge of `hull` has all of `other` outside.
fn least_overlap<H: Hull>(hull: &H, other: &H) -> Option<Axis> {
    let mut best = Axis { edge: 0, gap: -f32::MAX, corner: Vec2::ZERO };
    for (edge, &corner) in hull.corners().iter().enumerate() {
        let normal = hull.normal(edge);
        let (mut low, mut deepest) = (f32::MAX, Vec2::ZERO);
        for &candidate in other.corners() {
            let height = (candidate - corner).dot(normal);
            if height < low {
                (low, deepest) = (height, candidate);
            }
        }
        if H::STOPS_EARLY && low >= 0.0 {
            return None;
        }
        if low > best.gap {
            best = Axis { edge, gap: low, corner: deepest };
        }
    }
    (best.gap < 0.0).then_some(best)
}
