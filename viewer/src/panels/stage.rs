//! The middle of the window: one canvas, or two side by side, and what the pointer does there.

use eframe::egui::{Rect, Response, Role, Sense, Stroke, Ui, vec2};

use super::name;
use crate::app::{Tab, Viewer};
use crate::canvas::{self, Palette, Scenery};
use crate::live::Tool;
use crate::view::Arrangement;

/// Draws it.
pub fn show(ui: &mut Ui, viewer: &mut Viewer) {
    let rect = ui.available_rect_before_wrap();
    let palette = Palette::of(viewer.view.dark);
    if viewer.panes.is_empty() {
        let text = "Open a recording: type its path above, or drop the file here.\n\nlamina-viewer --live SCENE runs a scene.";
        canvas::notice(&ui.painter_at(rect), rect, &palette, text);
        return;
    }
    let beside = viewer.panes.len() > 1 && viewer.view.arrangement == Arrangement::SideBySide;
    let rects = if beside { halves(rect) } else { vec![rect] };
    // A view that was fitted and has not been moved since stays fitted while panels and window find their sizes.
    let size: [f32; 2] = rects[0].size().into();
    let outgrown = viewer.fitted.is_some_and(|(camera, fitted)| camera == viewer.camera && fitted != size);
    if viewer.fit || outgrown {
        if let Some(bounds) = canvas::bounds(&viewer.panes) {
            viewer.camera.fit(bounds, size);
            viewer.fitted = Some((viewer.camera, size));
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
    let live = at == 0 && viewer.live().is_some();
    if live {
        pull(viewer, rect, response);
    }
    let pulling = viewer.live().is_some_and(|live| live.session().pull().is_some());
    if response.dragged() && !pulling {
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
        if live && viewer.tool != Tool::Hand {
            let tool = viewer.tool;
            if let Some(slot) = viewer.act(|live| live.spawn(tool, world)).flatten() {
                viewer.selected = Some(slot as usize);
            }
            return;
        }
        viewer.selected = viewer.panes[at].body_at(world);
        if viewer.selected.is_some() && !live {
            viewer.tab = Tab::Body;
        }
    }
}

/// Takes a dynamic body of a running world by the hand, moves it, lets it go.
fn pull(viewer: &mut Viewer, rect: Rect, response: &Response) {
    let Some(pointer) = response.interact_pointer_pos() else { return };
    let world = viewer.camera.world(rect, pointer);
    if response.drag_started() && viewer.tool == Tool::Hand {
        // Where the button went down, not where the pointer is by now.
        let began = response.ctx.input(|input| input.pointer.press_origin()).unwrap_or(pointer);
        let began = viewer.camera.world(rect, began);
        if let Some(slot) = viewer.panes[0].body_at(began)
            && viewer.live().is_some_and(|live| live.grab(slot, began))
        {
            viewer.selected = Some(slot);
            viewer.follow_live();
        }
    }
    let Some(live) = viewer.live() else { return };
    if response.dragged() {
        live.drag(world);
    }
    if response.drag_stopped() && live.session().pull().is_some() {
        live.let_go();
        viewer.follow_live();
    }
}

fn draw(ui: &Ui, viewer: &mut Viewer, at: usize, rect: Rect) {
    let line = viewer.live().filter(|_| at == 0).and_then(|live| live.pull_line());
    let viewer = &*viewer;
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
    if let Some(ends) = line {
        let ends = ends.map(|end| viewer.camera.screen(rect, end));
        painter.line_segment(ends, Stroke::new(2.0, scenery.palette.selected));
        painter.circle_filled(ends[1], 4.0, scenery.palette.selected);
    }
    let frame = pane.frame();
    let over = twin.map(|twin| format!(", and {} over it", twin.source.name())).unwrap_or_default();
    let text = format!("{}{over}: step {}, {:.3} s", pane.source.name(), frame.step, frame.time_secs);
    canvas::caption(&painter, &scenery, &text);
}
