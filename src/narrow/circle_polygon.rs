//! Circle against convex polygon by Voronoi zones.
//!
//! The edge of the largest separation from the centre owns the closest point: in the zone beside it
//! (face), before it (zone A: its first vertex) or past it (zone B: its second). Inside, the same edge
//! is the nearest way out. Proof of the choice: for an edge j and the closest vertex v,
//! nⱼ·(c − vⱼ) ≤ nⱼ·(c − v), and that is largest for the edges whose normals enclose c − v: v's own.

use super::polygon_polygon::Hull;
use super::{Found, Pose};
use crate::lanes::{LaneMask, Lanes};
use crate::vec2::Vec2;

/// A is the circle, B the polygon.
#[inline(always)]
pub(super) fn collide<L: Lanes>(
    a: &Pose<L>,
    b: &Pose<L>,
    hull: &Hull<L>,
    edges: usize,
    margin: L,
) -> Found<L> {
    let radius = a.extent.x;
    let centre = a.x - b.x;
    let mut edge = hull.edge(0);
    let mut distance = edge.normal.dot(centre - edge.start);
    for k in 1..edges {
        let next = hull.edge(k);
        let next_distance = next.normal.dot(centre - next.start);
        edge = edge.replaced(distance.lt(next_distance), &next);
        distance = distance.max(next_distance);
    }

    let side = edge.end - edge.start;
    let (before, past) = ((centre - edge.start).dot(side), (centre - edge.end).dot(side));
    let (before, past) = (before.lt(L::zero()), L::zero().lt(past));
    let at_vertex = (before | past) & L::zero().lt(distance);
    let (outward, distance) = if at_vertex.any() {
        let vertex = Vec2::select(before, edge.start, edge.end);
        let (from_vertex, vertex_distance) = (centre - vertex).normalized();
        (Vec2::select(at_vertex, from_vertex, edge.normal), L::select(at_vertex, vertex_distance, distance))
    } else {
        (edge.normal, distance)
    };

    let normal = -outward;
    let separation = distance - radius;
    Found::single(normal, normal * (radius + L::lit(0.5) * separation), separation, margin)
}
