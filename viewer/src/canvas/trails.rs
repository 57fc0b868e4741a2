//! Trails: where bodies were in the frames before.

use lamina2d::scene::BodyKind;

use super::{Brush, Scenery};
use crate::pane::Pane;
use crate::view::TrailsOf;

/// Draws the trails the view asks for, fading towards the past.
pub(super) fn draw(brush: &mut Brush, scenery: &Scenery<'_>, pane: &Pane) {
    let slots: Vec<usize> = match scenery.view.trails {
        TrailsOf::None => return,
        TrailsOf::Selected => scenery.selected.into_iter().collect(),
        TrailsOf::All => {
            pane.bodies().filter(|(_, body)| body.kind != BodyKind::Static).map(|(slot, _)| slot).collect()
        }
    };
    let color = scenery.palette.selected;
    let steps = pane.trail().count().max(2) - 1;
    let shade = |age: usize| color.gamma_multiply(0.7 * (1.0 - age as f32 / steps as f32));
    let newest_first = || pane.trail().rev();
    for (age, (new, old)) in newest_first().zip(newest_first().skip(1)).enumerate() {
        let colors = [shade(age), shade(age + 1)];
        for &slot in &slots {
            let place =
                |positions: &[[f32; 2]]| positions.get(slot - 1).map(|at| scenery.screen(at.map(f64::from)));
            if let (Some(from), Some(to)) = (place(new), place(old))
                && scenery.sees(from, 0.0)
            {
                brush.fading_line([from, to], colors, 1.0);
            }
        }
    }
}
