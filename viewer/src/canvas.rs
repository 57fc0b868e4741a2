//! The drawing: one frame of one run, or two over each other, into a rectangle of the screen.
//!
//! Everything that can be many goes into one mesh; words alone are shapes of their own.

pub mod bodies;
mod brush;
mod camera;
mod contacts;
mod grid;
mod joints;
mod legend;
mod palette;
mod trails;

use eframe::egui::{Align2, Context, FontId, Painter, Pos2, Rect, Shape};
use lamina2d::scene::BodyKind;

use crate::pane::Pane;
use crate::view::View;

pub use brush::Brush;
pub use camera::Camera;
pub use palette::Palette;

/// What is drawn, and how.
#[derive(Clone, Copy, Debug)]
pub struct Scenery<'a> {
    /// What to show.
    pub view: &'a View,
    /// From where.
    pub camera: Camera,
    /// Where on the screen.
    pub rect: Rect,
    /// In which colours.
    pub palette: Palette,
    /// The selected body's slot.
    pub selected: Option<usize>,
}

impl Scenery<'_> {
    fn screen(&self, world: [f64; 2]) -> Pos2 {
        self.camera.screen(self.rect, world)
    }
    /// Is something of this radius about there in sight? Points.
    fn sees(&self, at: Pos2, radius: f32) -> bool {
        at.x.is_finite() && at.y.is_finite() && self.rect.expand(radius + 4.0).contains(at)
    }
}

/// Draws a run; with a `twin` that one over it, and lines from each body to its counterpart.
pub fn paint(painter: &Painter, scenery: &Scenery<'_>, pane: &Pane, twin: Option<&Pane>) {
    painter.rect_filled(scenery.rect, 0.0, scenery.palette.back);
    let mut brush = Brush::default();
    let labels = if scenery.view.grid { grid::draw(&mut brush, scenery) } else { Vec::new() };
    trails::draw(&mut brush, scenery, pane);
    let alpha = if twin.is_some() { 0.55 } else { 1.0 };
    bodies::draw(&mut brush, scenery, pane, alpha);
    if let Some(twin) = twin {
        bodies::draw(&mut brush, scenery, twin, 0.3);
        bodies::connect(&mut brush, scenery, pane, twin);
    }
    joints::draw(&mut brush, scenery, pane);
    contacts::draw(&mut brush, scenery, pane);
    painter.add(Shape::mesh(brush.finish()));
    let font = FontId::proportional(10.5);
    for (at, align, text) in labels {
        painter.text(at, align, text, font.clone(), scenery.palette.text);
    }
    legend::draw(painter, scenery, pane);
}

/// The name of a run, its step and time, at the top of its canvas.
pub fn caption(painter: &Painter, scenery: &Scenery<'_>, text: &str) {
    let at = scenery.rect.left_top() + eframe::egui::vec2(8.0, 6.0);
    let font = FontId::proportional(13.0);
    let galley = painter.layout_no_wrap(text.to_owned(), font, scenery.palette.text);
    let back = Rect::from_min_size(at, galley.size()).expand2(eframe::egui::vec2(4.0, 2.0));
    painter.rect_filled(back, 3.0, scenery.palette.back.gamma_multiply(0.85));
    painter.galley(at, galley, scenery.palette.text);
}

/// A sentence in the middle of an empty canvas.
pub fn notice(painter: &Painter, rect: Rect, palette: &Palette, text: &str) {
    painter.rect_filled(rect, 0.0, palette.back);
    painter.text(rect.center(), Align2::CENTER_CENTER, text, FontId::proportional(15.0), palette.text);
}

/// The box around what a view of the runs should show, metres: all that moves, and what stands close to it.
pub fn bounds(panes: &[Pane]) -> Option<[[f64; 2]; 2]> {
    let moving = boxes(panes, |kind| kind != BodyKind::Static).reduce(union);
    let Some(moving) = moving else { return boxes(panes, |_| true).reduce(union) };
    let reach = [0, 1].map(|k| (moving[1][k] - moving[0][k]).max(1.0) * 0.15);
    let near = [
        [moving[0][0] - reach[0], moving[0][1] - reach[1]],
        [moving[1][0] + reach[0], moving[1][1] + reach[1]],
    ];
    let cut = |[low, high]: [[f64; 2]; 2]| {
        let cut = [[0, 1].map(|k| low[k].max(near[0][k])), [0, 1].map(|k| high[k].min(near[1][k]))];
        (0..2).all(|k| cut[0][k] <= cut[1][k]).then_some(cut)
    };
    let standing = boxes(panes, |kind| kind == BodyKind::Static).filter_map(cut);
    Some(standing.fold(moving, union))
}

fn union(a: [[f64; 2]; 2], b: [[f64; 2]; 2]) -> [[f64; 2]; 2] {
    [[0, 1].map(|k| a[0][k].min(b[0][k])), [0, 1].map(|k| a[1][k].max(b[1][k]))]
}

fn boxes(panes: &[Pane], of: impl Fn(BodyKind) -> bool) -> impl Iterator<Item = [[f64; 2]; 2]> {
    let bodies = panes.iter().flat_map(|pane| pane.bodies().map(move |(slot, body)| (pane, slot, body)));
    let chosen = bodies.filter(move |(_, _, body)| of(body.kind));
    let around = chosen.map(|(pane, slot, body)| bodies::bounds(pane.frame(), slot, &body.shape));
    around.filter(|found| found.iter().flatten().all(|value| value.is_finite()))
}

/// Asks egui for another picture soon: something moves.
pub fn again(ctx: &Context) {
    ctx.request_repaint();
}
