//! Outlines of bodies where they are, in `f64`.

use glam::DVec2;

use super::{Bodies, Form};
use crate::lanes::Real;
use crate::shape::MAX_VERTICES;

impl<R: Real> Bodies<R> {
    /// Corners of a box or polygon from its centroid, world axes, metres, counter-clockwise; how many: 0 for a circle.
    pub(crate) fn corners(&self, slot: usize) -> ([DVec2; MAX_VERTICES], usize) {
        let turn = DVec2::new(self.c[slot].to_f64(), self.s[slot].to_f64());
        let mut corners = [DVec2::ZERO; MAX_VERTICES];
        let count = match self.form(slot) {
            Form::Circle => 0,
            Form::Box => {
                let (hx, hy) = (self.extent_x[slot].to_f64(), self.extent_y[slot].to_f64());
                corners[..4].copy_from_slice(&[(-hx, -hy), (hx, -hy), (hx, hy), (-hx, hy)].map(DVec2::from));
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
        for corner in &mut corners[..count] {
            *corner = turn.rotate(*corner);
        }
        (corners, count)
    }
}
