//! Convex polygon against convex polygon (or box): separating axes, then clipping.
//!
//! For each edge k of one hull the separation is minⱼ nₖ·vⱼ + nₖ·d − oₖ over the other's vertices; the
//! largest over both hulls is the separation of the pair. A batch whose lanes are all apart along A's
//! axes does not look at B's.

use super::clip::{PREFER_A, Reference, any_within, clip};
use super::{Found, Pose};
use crate::body::HullRows;
use crate::lanes::{Lanes, ROW, Real};
use crate::vec2::Vec2;

/// `WIDTH` convex polygons about their centroids, world axes.
///
/// Entries past a lane's own count repeat its entry 0: loops run to `EDGES`, at least the largest count in
/// the world, unrolled; and the edge from vertex k ends at
/// vertex (k + 1) mod 8 in every lane.
#[derive(Clone, Copy, Debug)]
pub(super) struct Hull<L> {
    x: [L; ROW],
    y: [L; ROW],
    normal_x: [L; ROW],
    normal_y: [L; ROW],
}

/// One edge per lane.
#[derive(Clone, Copy, Debug)]
pub(super) struct Edge<L> {
    /// Outward unit normal.
    pub(super) normal: Vec2<L>,
    /// First vertex, counter-clockwise.
    pub(super) start: Vec2<L>,
    /// Second vertex.
    pub(super) end: Vec2<L>,
    /// Its number.
    pub(super) index: L,
}

impl<L: Lanes> Edge<L> {
    /// `other` where `mask` is set.
    #[inline(always)]
    pub(super) fn replaced(&self, mask: L::Mask, other: &Self) -> Self {
        Self {
            normal: Vec2::select(mask, other.normal, self.normal),
            start: Vec2::select(mask, other.start, self.start),
            end: Vec2::select(mask, other.end, self.end),
            index: L::select(mask, other.index, self.index),
        }
    }
}

impl<L: Lanes> Hull<L> {
    #[inline(always)]
    pub(super) fn gather(polygons: &[HullRows<L::Elem>], index: &[u32]) -> Self {
        let [x, y, normal_x, normal_y] = L::gather_quads(polygons, index);
        Self { x, y, normal_x, normal_y }
    }

    /// A box as a hull of four edges: right, top, left, bottom.
    #[inline(always)]
    pub(super) fn of_box(pose: &Pose<L>) -> Self {
        let h = pose.extent;
        let corner = |x: L, y: L| pose.rot.apply(Vec2::new(x, y));
        let [p, q, r, s] = [corner(h.x, -h.y), corner(h.x, h.y), corner(-h.x, h.y), corner(-h.x, -h.y)];
        let right = Vec2::new(pose.rot.c, pose.rot.s);
        let up = -right.right();
        let row = |[a, b, c, d]: [L; 4]| [a, b, c, d, a, a, a, a];
        Self {
            x: row([p.x, q.x, r.x, s.x]),
            y: row([p.y, q.y, r.y, s.y]),
            normal_x: row([right.x, up.x, -right.x, -up.x]),
            normal_y: row([right.y, up.y, -right.y, -up.y]),
        }
    }

    #[inline(always)]
    pub(super) fn edge(&self, k: usize) -> Edge<L> {
        Edge {
            normal: self.normal(k),
            start: self.vertex(k),
            end: self.vertex(k + 1),
            index: L::splat(L::Elem::from_f64(k as f64)),
        }
    }

    #[inline(always)]
    fn vertex(&self, k: usize) -> Vec2<L> {
        Vec2::new(self.x[k % ROW], self.y[k % ROW])
    }

    #[inline(always)]
    fn normal(&self, k: usize) -> Vec2<L> {
        Vec2::new(self.normal_x[k % ROW], self.normal_y[k % ROW])
    }

    /// min n·v over the vertices.
    #[inline(always)]
    fn support<const EDGES: usize>(&self, n: Vec2<L>) -> L {
        let mut least = n.dot(self.vertex(0));
        for j in 1..EDGES {
            least = least.min(n.dot(self.vertex(j)));
        }
        least
    }

    /// The edge that parts this hull furthest from `other`, whose centroid lies at `d`, and by how much.
    #[inline(always)]
    fn parting_edge<const EDGES: usize>(&self, other: &Self, d: Vec2<L>) -> (Edge<L>, L) {
        let apart = |k: usize| {
            let n = self.normal(k);
            other.support::<EDGES>(n) + n.dot(d - self.vertex(k))
        };
        let (mut edge, mut separation) = (self.edge(0), apart(0));
        for k in 1..EDGES {
            let next = apart(k);
            let better = separation.lt(next);
            edge = edge.replaced(better, &self.edge(k));
            separation = separation.max(next);
        }
        (edge, separation)
    }

    /// The edge that looks most against `n`.
    #[inline(always)]
    fn facing_edge<const EDGES: usize>(&self, n: Vec2<L>) -> Edge<L> {
        let (mut edge, mut least) = (self.edge(0), self.normal(0).dot(n));
        for k in 1..EDGES {
            let next = self.normal(k).dot(n);
            edge = edge.replaced(next.lt(least), &self.edge(k));
            least = least.min(next);
        }
        edge
    }
}

/// Two hulls.
#[inline(always)]
pub(super) fn collide<L: Lanes, const EDGES: usize>(
    a: &Pose<L>,
    b: &Pose<L>,
    hull_a: &Hull<L>,
    hull_b: &Hull<L>,
    margin: L,
) -> Found<L> {
    let d = b.x - a.x;
    let (edge_a, sep_a) = hull_a.parting_edge::<EDGES>(hull_b, d);
    if !any_within(sep_a, margin) {
        return Found::nothing();
    }
    let (edge_b, sep_b) = hull_b.parting_edge::<EDGES>(hull_a, -d);
    let separation = sep_a.max(sep_b);
    if !any_within(separation, margin) {
        return Found::nothing();
    }

    let tangent_a = -edge_a.normal.right();
    let tangent_b = -edge_b.normal.right();
    let (length_a, length_b) =
        ((edge_a.end - edge_a.start).dot(tangent_a), (edge_b.end - edge_b.start).dot(tangent_b));
    let flipped = (sep_a + length_a.min(length_b) * L::lit(PREFER_A)).lt(sep_b);
    let face = edge_a.replaced(flipped, &edge_b);
    let incident =
        hull_b.facing_edge::<EDGES>(face.normal).replaced(flipped, &hull_a.facing_edge::<EDGES>(face.normal));
    let tangent = Vec2::select(flipped, tangent_b, tangent_a);
    let reference = Reference {
        normal: face.normal,
        offset: face.normal.dot(face.start),
        start: tangent.dot(face.start),
        length: L::select(flipped, length_b, length_a),
    };
    let to_incident = Vec2::select(flipped, -d, d);
    let ends = [incident.start + to_incident, incident.end + to_incident];
    let feature = L::select(flipped, L::lit(128.0), L::zero())
        + face.index * L::lit(16.0)
        + incident.index * L::lit(2.0);
    clip(&reference, ends, flipped, d, feature, margin).unless_apart(separation, margin)
}
