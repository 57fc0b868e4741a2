//! What the colours mean, in the canvas's upper right corner.

use eframe::egui::{Align2, Color32, FontId, Painter, Pos2, Rect, vec2};
use lamina2d::scene::{BodyKind, ShapeSpec};

use super::{Palette, Scenery, bodies};
use crate::pane::Pane;
use crate::view::Colour;

/// Height of a line, points.
const LINE: f32 = 15.0;

/// Is it of this shape?
type Which = fn(&ShapeSpec) -> bool;

/// Draws a line for each colour that bodies of this frame can have.
pub(super) fn draw(painter: &Painter, scenery: &Scenery<'_>, pane: &Pane) {
    if scenery.rect.width() < 260.0 {
        return;
    }
    let palette = &scenery.palette;
    let mut lines: Vec<(Option<Color32>, String)> = match scenery.view.colour {
        Colour::Shape => {
            let is_there = |which: Which| {
                pane.bodies().any(|(_, body)| body.kind == BodyKind::Dynamic && which(&body.shape))
            };
            let kinds: [(Which, &str); 3] = [
                (|shape| matches!(shape, ShapeSpec::Circle(_)), "circle"),
                (|shape| matches!(shape, ShapeSpec::Box(_)), "box"),
                (|shape| matches!(shape, ShapeSpec::Polygon(_)), "polygon"),
            ];
            let named = kinds.into_iter().zip(palette.shapes).filter(|((which, _), _)| is_there(*which));
            named.map(|((_, name), color)| (Some(color), name.to_owned())).collect()
        }
        Colour::Sleep => {
            vec![(Some(palette.shapes[1]), "awake".to_owned()), (Some(palette.asleep), "asleep".to_owned())]
        }
        Colour::Island => {
            vec![
                (None, format!("{} islands", pane.island_count())),
                (Some(palette.island(0)), "alone".to_owned()),
            ]
        }
        Colour::Speed => {
            let top = bodies::top_speed(pane);
            [1.0, 0.5, 0.0]
                .map(|share| (Some(Palette::ramp(share)), format!("{:.3} m/s", share * top)))
                .to_vec()
        }
    };
    for (kind, color, name) in
        [(BodyKind::Static, palette.fixed, "static"), (BodyKind::Kinematic, palette.kinematic, "kinematic")]
    {
        if pane.bodies().any(|(_, body)| body.kind == kind) {
            lines.push((Some(color), name.to_owned()));
        }
    }
    let corner = scenery.rect.right_top() + vec2(-8.0, 8.0);
    let back =
        Rect::from_min_max(corner + vec2(-92.0, -4.0), corner + vec2(4.0, LINE * lines.len() as f32 + 2.0));
    painter.rect_filled(back, 3.0, palette.back.gamma_multiply(0.85));
    for (at, (color, name)) in lines.into_iter().enumerate() {
        let middle = Pos2::new(corner.x, corner.y + LINE * (at as f32 + 0.5));
        let words = Pos2::new(corner.x - 14.0, middle.y);
        painter.text(words, Align2::RIGHT_CENTER, name, FontId::proportional(11.5), palette.text);
        if let Some(color) = color {
            painter.rect_filled(Rect::from_center_size(middle - vec2(4.0, 0.0), vec2(9.0, 9.0)), 2.0, color);
        }
    }
}
