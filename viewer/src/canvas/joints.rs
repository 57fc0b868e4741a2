//! Joints: a line from each body to where it is held, and between the two places where they are apart.

use super::{Brush, Scenery};
use crate::pane::Pane;

/// Width of the lines, points.
const WIDTH: f32 = 1.2;

/// Draws them.
pub(super) fn draw(brush: &mut Brush, scenery: &Scenery<'_>, pane: &Pane) {
    if !scenery.view.joints {
        return;
    }
    let color = scenery.palette.joint;
    for (held, centroids) in pane.joints() {
        let places = [centroids[0], held[0], held[1], centroids[1]].map(|at| scenery.screen(at));
        let reach = places.iter().map(|at| (*at - places[1]).length()).fold(0.0, f32::max);
        if !scenery.sees(places[1], reach) {
            continue;
        }
        for pair in places.windows(2).filter(|pair| pair[0] != pair[1]) {
            brush.line(pair[0], pair[1], color, WIDTH);
        }
        for at in &places[1..3] {
            brush.point(*at, 2.0, color);
        }
    }
}
