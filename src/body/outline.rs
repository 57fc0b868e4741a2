//! Outlines of bodies in `f64`: in their own frame, and where they are.

use glam::DVec2;

use super::{Bodies, Form};
use crate::lanes::Real;
use crate::shape::MAX_VERTICES;

/// A shape where it is.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Placed {
    /// Centroid, metres.
    pub(crate) centre: DVec2,
    /// Radius of a disc; 0 for outlines.
    pub(crate) disc: f64,
    /// Corners, world axes, from the centroid, counter-clockwise.
    pub(crate) corners: [DVec2; MAX_VERTICES],
    /// How many; 0 for a disc.
    pub(crate) count: usize,
}

impl Placed {
    /// The corners there are.
    #[inline]
    pub(crate) fn corners(&self) -> &[DVec2] {
        &self.corners[..self.count]
    }
}

impl<R: Real> Bodies<R> {
    /// The outline of the body in a slot about its centroid, world axes, in `f64`; empty for circles.
    pub fn outline(&self, slot: usize) -> Vec<[f64; 2]> {
        let (c, s) = (self.c[slot].to_f64(), self.s[slot].to_f64());
        self.outline_body(slot).into_iter().map(|[x, y]| [c * x - s * y, s * x + c * y]).collect()
    }

    /// [`Bodies::outline`] in the body frame.
    pub fn outline_body(&self, slot: usize) -> Vec<[f64; 2]> {
        let (corners, count) = self.corners_body(slot);
        corners[..count].iter().map(glam::DVec2::to_array).collect()
    }

    /// Corners of a box or polygon in the body frame, metres, counter-clockwise; how many: 0 for a circle.
    pub(crate) fn corners_body(&self, slot: usize) -> ([DVec2; MAX_VERTICES], usize) {
        let mut corners = [DVec2::ZERO; MAX_VERTICES];
        let count = match self.form(slot) {
            Form::Circle => 0,
            Form::Box => {
                let (hx, hy) = (self.extent_x[slot].to_f64(), self.extent_y[slot].to_f64());
                for (k, (x, y)) in [(-hx, -hy), (hx, -hy), (hx, hy), (-hx, hy)].into_iter().enumerate() {
                    corners[k] = DVec2::new(x, y);
                }
                4
            }
            Form::Polygon => {
                let at = self.shapes(slot).start;
                let [x, y, ..] = &self.polygons.body[at];
                let count = usize::from(self.polygons.count[at]);
                for (k, corner) in corners[..count].iter_mut().enumerate() {
                    *corner = DVec2::new(x[k].to_f64(), y[k].to_f64());
                }
                count
            }
        };
        (corners, count)
    }

    /// Radius of a circle, metres; 0 for boxes and polygons.
    pub(crate) fn disc(&self, slot: usize) -> f64 {
        if self.form(slot) == Form::Circle { self.extent_x[slot].to_f64() } else { 0.0 }
    }

    /// A body where it is.
    pub(crate) fn placed(&self, slot: usize) -> Placed {
        let turn = DVec2::new(self.c[slot].to_f64(), self.s[slot].to_f64());
        let (mut corners, count) = self.corners_body(slot);
        for corner in &mut corners[..count] {
            *corner = turn.rotate(*corner);
        }
        Placed { centre: DVec2::from(self.place(slot)), disc: self.disc(slot), corners, count }
    }

    /// How far a body reaches from its centroid along a direction, metres, as [`Bodies::placed`] has it.
    pub(crate) fn extent(&self, slot: usize, along: DVec2) -> f64 {
        let turn = DVec2::new(self.c[slot].to_f64(), self.s[slot].to_f64());
        let reach = |x: R, y: R| along.dot(turn.rotate(DVec2::new(x.to_f64(), y.to_f64())));
        let (hx, hy) = (self.extent_x[slot], self.extent_y[slot]);
        match self.form(slot) {
            Form::Circle => hx.to_f64(),
            Form::Box => reach(hx, hy).max(reach(-hx, hy)).max(reach(hx, -hy)).max(reach(-hx, -hy)),
            Form::Polygon => {
                let at = self.shapes(slot).start;
                let [x, y, ..] = &self.polygons.body[at];
                let corners = x.iter().zip(y).take(usize::from(self.polygons.count[at]));
                corners.map(|(&x, &y)| reach(x, y)).fold(f64::MIN, f64::max)
            }
        }
    }
}
