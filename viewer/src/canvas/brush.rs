//! One mesh for everything: fills, rims and lines with soft edges of one pixel, which egui gives its own shapes only.

use eframe::egui::epaint::{Mesh, Vertex, WHITE_UV};
use eframe::egui::{Color32, Pos2, Vec2};

/// Width of a soft edge, points.
const SOFT: f32 = 1.0;
/// A corner's offset is at most so many times the edge's.
const MITRE: f32 = 3.0;

/// Collects triangles.
#[derive(Debug, Default)]
pub struct Brush {
    mesh: Mesh,
    /// Offsets of an outline's corners, kept from one to the next.
    corners: Vec<Vec2>,
}

impl Brush {
    /// What was drawn.
    pub fn finish(self) -> Mesh {
        self.mesh
    }

    fn vertex(&mut self, pos: Pos2, color: Color32) -> u32 {
        let index = self.mesh.vertices.len() as u32;
        self.mesh.vertices.push(Vertex { pos, uv: WHITE_UV, color });
        index
    }

    /// A convex outline, filled, with a rim of `width` points just inside it. Outlines that turn either way will do;
    /// one that is not finite is left out.
    pub fn convex(&mut self, outline: &[Pos2], fill: Color32, rim: Color32, width: f32) {
        if outline.len() < 3 || !outline.iter().all(|p| p.x.is_finite() && p.y.is_finite()) {
            return;
        }
        let mut corners = std::mem::take(&mut self.corners);
        outward(outline, &mut corners);
        let first = self.ring(outline, &corners, -width, fill);
        let n = outline.len() as u32;
        for k in 1..n - 1 {
            self.mesh.add_triangle(first, first + k, first + k + 1);
        }
        if width > 0.0 {
            let inner = self.ring(outline, &corners, -width, rim);
            let outer = self.ring(outline, &corners, 0.0, rim);
            self.join(inner, outer, n);
            let soft = self.ring(outline, &corners, SOFT, Color32::TRANSPARENT);
            self.join(outer, soft, n);
        } else {
            let soft = self.ring(outline, &corners, SOFT, Color32::TRANSPARENT);
            self.join(first, soft, n);
        }
        self.corners = corners;
    }

    /// The rim of a closed outline alone.
    pub fn outline(&mut self, outline: &[Pos2], color: Color32, width: f32) {
        let closed = outline.iter().copied().chain(outline.first().copied());
        let mut last: Option<Pos2> = None;
        for point in closed {
            if let Some(from) = last {
                self.line(from, point, color, width);
            }
            last = Some(point);
        }
    }

    /// A line with soft sides.
    pub fn line(&mut self, from: Pos2, to: Pos2, color: Color32, width: f32) {
        self.fading_line([from, to], [color, color], width);
    }

    /// A line whose colour goes over from one end to the other.
    pub fn fading_line(&mut self, [from, to]: [Pos2; 2], colors: [Color32; 2], width: f32) {
        let along = to - from;
        if !(along.x.is_finite() && along.y.is_finite()) || along == Vec2::ZERO {
            return;
        }
        let across = along.normalized().rot90();
        let (hard, soft) = (across * (0.5 * width), across * (0.5 * width + SOFT));
        let mut row = |at: Pos2, color: Color32| {
            let first = self.vertex(at + soft, Color32::TRANSPARENT);
            self.vertex(at + hard, color);
            self.vertex(at - hard, color);
            self.vertex(at - soft, Color32::TRANSPARENT);
            first
        };
        let (a, b) = (row(from, colors[0]), row(to, colors[1]));
        for k in 0..3 {
            self.mesh.add_triangle(a + k, a + k + 1, b + k);
            self.mesh.add_triangle(a + k + 1, b + k + 1, b + k);
        }
    }

    /// A line with a head at its end.
    pub fn arrow(&mut self, from: Pos2, to: Pos2, color: Color32, width: f32) {
        self.line(from, to, color, width);
        let along = to - from;
        let length = along.length();
        if length.is_finite() && length > 2.0 {
            let back = along / length * (length * 0.4).min(6.0);
            let side = back.rot90() * 0.5;
            self.line(to, to - back + side, color, width);
            self.line(to, to - back - side, color, width);
        }
    }

    /// A small square on its corner: a point.
    pub fn point(&mut self, at: Pos2, radius: f32, color: Color32) {
        let corners = [
            Vec2::new(radius, 0.0),
            Vec2::new(0.0, radius),
            Vec2::new(-radius, 0.0),
            Vec2::new(0.0, -radius),
        ];
        self.convex(&corners.map(|corner| at + corner), color, color, 0.0);
    }

    fn ring(&mut self, outline: &[Pos2], corners: &[Vec2], by: f32, color: Color32) -> u32 {
        let first = self.mesh.vertices.len() as u32;
        let moved = outline.iter().zip(corners).map(|(point, out)| Vertex {
            pos: *point + *out * by,
            uv: WHITE_UV,
            color,
        });
        self.mesh.vertices.extend(moved);
        first
    }

    fn join(&mut self, inner: u32, outer: u32, n: u32) {
        for k in 0..n {
            let next = (k + 1) % n;
            self.mesh.add_triangle(inner + k, outer + k, inner + next);
            self.mesh.add_triangle(inner + next, outer + k, outer + next);
        }
    }
}

/// At each corner, how it moves when both its edges move out by one.
fn outward(outline: &[Pos2], corners: &mut Vec<Vec2>) {
    let n = outline.len();
    let normal = |k: usize| (outline[(k + 1) % n] - outline[k % n]).normalized().rot90();
    let doubled: f32 = (1..n - 1)
        .map(|k| {
            let (a, b) = (outline[k] - outline[0], outline[k + 1] - outline[0]);
            a.x * b.y - a.y * b.x
        })
        .sum();
    let out = if doubled > 0.0 { 1.0 } else { -1.0 };
    corners.clear();
    let mut before = normal(n - 1);
    for k in 0..n {
        let after = normal(k);
        let mitre = (before + after) / (1.0 + before.dot(after)).max(2.0 / (MITRE * MITRE));
        corners.push(mitre * out);
        before = after;
    }
}
