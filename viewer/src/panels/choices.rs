//! The panel on the left: what the canvas shows, and the list of bodies.

use eframe::egui::{Role, ScrollArea, Slider, TextEdit, Ui};
use lamina2d::scene::{BodyKind, ShapeSpec};
use lamina2d::world::BodyEntry;

use super::name;
use crate::app::{Tab, Viewer};
use crate::command::Command;
use crate::view::{Arrangement, Colour, MOST_TRAIL, TrailsOf};

/// Draws it.
pub fn show(ui: &mut Ui, viewer: &mut Viewer) {
    ui.add_space(4.0);
    ScrollArea::vertical().id_salt("choices").max_height(ui.available_height() * 0.72).show(ui, |ui| {
        colours(ui, viewer);
        overlays(ui, viewer);
        trails(ui, viewer);
        camera(ui, viewer);
    });
    ui.separator();
    bodies(ui, viewer);
}

fn colours(ui: &mut Ui, viewer: &mut Viewer) {
    ui.strong("Colour by");
    ui.horizontal_wrapped(|ui| {
        for colour in Colour::ALL {
            ui.selectable_value(&mut viewer.view.colour, colour, colour.name());
        }
    });
    ui.add_space(6.0);
}

fn overlays(ui: &mut Ui, viewer: &mut Viewer) {
    let view = &mut viewer.view;
    ui.strong("Show");
    ui.checkbox(&mut view.grid, "grid");
    ui.checkbox(&mut view.contacts, "contact points");
    ui.checkbox(&mut view.normals, "normals");
    ui.checkbox(&mut view.depths, "contact start and end");
    ui.checkbox(&mut view.impulses, "impulses");
    if view.impulses {
        let scale =
            ui.add(Slider::new(&mut view.impulse_scale, 0.1..=10.0).logarithmic(true).show_value(false));
        name(&scale.on_hover_text("length of impulses"), Role::Slider, "Length of impulses");
    }
    ui.checkbox(&mut view.joints, "joint lines");
    ui.checkbox(&mut view.circles, "bounding circles");
    ui.checkbox(&mut view.velocities, "velocities");
    ui.add_space(6.0);
}

fn trails(ui: &mut Ui, viewer: &mut Viewer) {
    let view = &mut viewer.view;
    ui.strong("Trails");
    for of in TrailsOf::ALL {
        ui.radio_value(&mut view.trails, of, of.name());
    }
    if view.trails != TrailsOf::None {
        ui.spacing_mut().slider_width = 84.0;
        let length = ui.add(Slider::new(&mut view.trail_frames, 1..=MOST_TRAIL));
        name(&length, Role::Slider, "Length of trails");
    }
    ui.add_space(6.0);
}

fn camera(ui: &mut Ui, viewer: &mut Viewer) {
    ui.strong("Camera");
    if ui.button("Fit").on_hover_text("all bodies in view (F)").clicked() {
        viewer.run(Command::Fit);
    }
    ui.checkbox(&mut viewer.view.follow, "follow selected");
    if viewer.panes.len() > 1 {
        ui.add_space(6.0);
        ui.strong("Two runs");
        let arrangement = &mut viewer.view.arrangement;
        ui.radio_value(arrangement, Arrangement::SideBySide, "side by side");
        ui.radio_value(arrangement, Arrangement::Overlaid, "overlaid");
    }
}

/// What a body is, in a line.
pub fn describe(slot: usize, body: &BodyEntry) -> String {
    let shape = match &body.shape {
        ShapeSpec::Circle(_) => "circle".to_owned(),
        ShapeSpec::Box(_) => "box".to_owned(),
        ShapeSpec::Polygon(outline) => format!("polygon of {}", outline.len()),
    };
    let kind = match body.kind {
        BodyKind::Static => "static ",
        BodyKind::Kinematic => "kinematic ",
        BodyKind::Dynamic => "",
    };
    format!("{slot}: {kind}{shape}")
}

fn bodies(ui: &mut Ui, viewer: &mut Viewer) {
    ui.strong("Bodies");
    let field = ui.add(TextEdit::singleline(&mut viewer.filter).hint_text("number, shape or kind"));
    name(&field, Role::TextInput, "Filter of bodies");
    let Some(pane) = viewer.panes.first() else { return };
    let wanted = viewer.filter.trim().to_lowercase();
    let number = wanted.parse::<usize>().ok();
    let fits = |slot: usize, body: &BodyEntry| match number {
        Some(number) => number == slot,
        None => wanted.is_empty() || describe(slot, body).contains(&wanted),
    };
    let found: Vec<_> =
        pane.bodies().filter(|(slot, body)| fits(*slot, body)).map(|(slot, _)| slot).collect();
    ui.weak(format!("{} found", found.len()));
    let height = ui.spacing().interact_size.y;
    let mut chosen = None;
    ScrollArea::vertical().id_salt("bodies").auto_shrink(false).show_rows(
        ui,
        height,
        found.len(),
        |ui, rows| {
            for &slot in found.get(rows).unwrap_or_default() {
                if let Some(body) = pane.entry(slot)
                    && ui.selectable_label(viewer.selected == Some(slot), describe(slot, body)).clicked()
                {
                    chosen = Some(slot);
                }
            }
        },
    );
    if chosen.is_some() {
        (viewer.selected, viewer.tab) = (chosen, Tab::Body);
    }
}
