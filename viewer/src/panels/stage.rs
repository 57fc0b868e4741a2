//! The middle of the window: one canvas, or two side by side, and what the pointer does there.

use eframe::egui::{Rect, Response, Role, Sense, Ui, vec2};

use super::name;
use crate::app::{Tab, Viewer};
use crate::canvas::{self, Palette, Scenery};
use crate::view::Arrangement;

/// Draws it.
pub fn show(ui: &mut Ui, viewer: &mut Viewer) {
    let rect = ui.available_rect_before_wrap();
    let palette = Palette::of(viewer.view.dark);
    if viewer.panes.is_empty() {
        let text = "Open a recording: type its path above, or drop the file here.";
        canvas::notice(&ui.painter_at(rect), rect, &palette, text);
        return;
    }
    let beside = viewer.panes.len() > 1 && viewer.view.arrangement == Arrangement::SideBySide;
    let rects = if beside { halves(rect) } else { vec![rect] };
    if viewer.fit {
        if let Some(bounds) = canvas::bounds(&viewer.panes) {
            viewer.camera.fit(bounds, rects[0].size().into());
        }
        viewer.fit = false;
    }
    for (at, rect) in rects.into_iter().enumerate() {
        let response = ui.interact(rect, ui.scope_id().with(("canvas", at)), Sense::click_and_drag());
        let label = if at == 0 { "Canvas" } else { "Second canvas" };
        name(&response, Role::Canvas, label);
        point(ui, viewer, at, rect, &response);
        draw(ui, viewer, at, rect);
    }
}

fn halves(rect: Rect) -> Vec<Rect> {
    let (left, right) = rect.split_left_right_at_fraction(0.5);
    vec![left.with_max_x(left.right() - 1.0), right.with_min_x(right.left() + 1.0)]
}

/// Drags, clicks, wheels and pinches.
fn point(ui: &Ui, viewer: &mut Viewer, at: usize, rect: Rect, response: &Response) {
    if response.dragged() {
        let by = response.drag_delta();
        viewer.camera.pan([by.x, -by.y]);
        viewer.view.follow &= by == vec2(0.0, 0.0);
    }
    if let Some(pointer) = response.hover_pos() {
        let (zoom, scroll) = ui.input(|input| (input.zoom_delta(), input.smooth_scroll_delta()));
        if zoom != 1.0 {
            viewer.camera.zoom(rect, pointer, zoom.into());
        } else if scroll != vec2(0.0, 0.0) {
            viewer.camera.pan([scroll.x, -scroll.y]);
        }
    }
    if response.clicked()
        && let Some(pointer) = response.interact_pointer_pos()
    {
        let world = viewer.camera.world(rect, pointer);
        viewer.selected = viewer.panes[at].body_at(world);
        if viewer.selected.is_some() {
            viewer.tab = Tab::Body;
        }
    }
}

fn draw(ui: &Ui, viewer: &Viewer, at: usize, rect: Rect) {
    let pane = &viewer.panes[at];
    let overlaid = viewer.view.arrangement == Arrangement::Overlaid;
    let twin = if overlaid { viewer.panes.get(1) } else { None };
    let scenery = Scenery {
        view: &viewer.view,
        camera: viewer.camera,
        rect,
        palette: Palette::of(viewer.view.dark),
        selected: viewer.selected,
    };
    let painter = ui.painter_at(rect);
    canvas::paint(&painter, &scenery, pane, twin);
    let frame = pane.frame();
    let over = twin.map(|twin| format!(", and {} over it", twin.source.name())).unwrap_or_default();
    let text = format!("{}{over}: step {}, {:.3} s", pane.source.name(), frame.step, frame.time_secs);
    canvas::caption(&painter, &scenery, &text);
}
