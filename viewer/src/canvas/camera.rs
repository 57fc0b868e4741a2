//! From metres to points of the screen and back.

use eframe::egui::{Pos2, Rect};

/// Points per metre at least and at most.
const ZOOM: [f64; 2] = [1e-6, 1e7];

/// What part of the world is looked at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// In the middle of the canvas, metres.
    pub centre: [f64; 2],
    /// Points of the screen per metre.
    pub points_per_metre: f64,
}

impl Default for Camera {
    fn default() -> Self {
        Self { centre: [0.0; 2], points_per_metre: 50.0 }
    }
}

impl Camera {
    /// Shows a box of the world whole, with a little air around it. `bounds`: least and greatest corner, metres.
    pub fn fit(&mut self, bounds: [[f64; 2]; 2], size: [f32; 2]) {
        let [low, high] = bounds;
        let middle = [0, 1].map(|k| 0.5 * (low[k] + high[k]));
        let span = [0, 1].map(|k| (high[k] - low[k]).max(1e-6) * 1.08);
        if middle.iter().chain(&span).all(|value| value.is_finite()) {
            self.centre = middle;
            let zooms = [0, 1].map(|k| f64::from(size[k]).max(1.0) / span[k]);
            self.points_per_metre = zooms[0].min(zooms[1]).clamp(ZOOM[0], ZOOM[1]);
        }
    }

    /// Magnifies by a factor about a point of the screen, which stays where it is.
    pub fn zoom(&mut self, rect: Rect, about: Pos2, factor: f64) {
        let fixed = self.world(rect, about);
        let zoomed = (self.points_per_metre * factor).clamp(ZOOM[0], ZOOM[1]);
        let kept = self.points_per_metre / zoomed;
        if kept.is_finite() {
            self.centre = [0, 1].map(|k| fixed[k] + (self.centre[k] - fixed[k]) * kept);
            self.points_per_metre = zoomed;
        }
    }

    /// Moves what is seen by points of the screen.
    pub fn pan(&mut self, by: [f32; 2]) {
        self.centre[0] -= f64::from(by[0]) / self.points_per_metre;
        self.centre[1] += f64::from(by[1]) / self.points_per_metre;
    }

    /// Where a point of the world is seen; y is up there and down here.
    pub fn screen(&self, rect: Rect, world: [f64; 2]) -> Pos2 {
        let middle = rect.center();
        Pos2::new(
            middle.x + ((world[0] - self.centre[0]) * self.points_per_metre) as f32,
            middle.y - ((world[1] - self.centre[1]) * self.points_per_metre) as f32,
        )
    }

    /// Which point of the world is seen there, metres.
    pub fn world(&self, rect: Rect, screen: Pos2) -> [f64; 2] {
        let offset = screen - rect.center();
        [
            self.centre[0] + f64::from(offset.x) / self.points_per_metre,
            self.centre[1] - f64::from(offset.y) / self.points_per_metre,
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn zoom_keeps_the_point_under_the_pointer() {
        let rect = Rect::from_min_max(Pos2::new(100.0, 50.0), Pos2::new(500.0, 350.0));
        let mut camera = Camera { centre: [3.0, -2.0], points_per_metre: 20.0 };
        let pointer = Pos2::new(420.0, 90.0);
        let before = camera.world(rect, pointer);
        camera.zoom(rect, pointer, 3.0);
        let after = camera.world(rect, pointer);
        assert!((before[0] - after[0]).abs() < 1e-9 && (before[1] - after[1]).abs() < 1e-9);
        assert_eq!(camera.points_per_metre, 60.0);
        let back = camera.screen(rect, after);
        assert!((back - pointer).length() < 1e-3);
    }

    #[test]
    fn what_is_not_finite_moves_no_camera() {
        let mut camera = Camera::default();
        camera.fit([[f64::NAN, 0.0], [1.0, f64::INFINITY]], [100.0, 100.0]);
        assert_eq!(camera, Camera::default());
    }
}
