//! The list of keys.

use eframe::egui::{Align2, Context, Grid, Window};

use crate::app::Viewer;
use crate::command::BINDINGS;

/// What the pointer does.
const POINTER: [(&str, &str); 4] = [
    ("click", "select a body"),
    ("drag, or scroll", "move the view"),
    ("ctrl scroll, or pinch", "zoom"),
    ("click a curve", "go to that time"),
];

/// Draws it where it is asked for.
pub fn show(ctx: &Context, viewer: &mut Viewer) {
    let mut open = viewer.help;
    let window = Window::new("Keys")
        .open(&mut open)
        .resizable(false)
        .collapsible(false)
        .anchor(Align2::CENTER_CENTER, [0.0, 0.0]);
    window.show(ctx, |ui| {
        Grid::new("keys").num_columns(2).striped(true).spacing([18.0, 4.0]).show(ui, |ui| {
            let keys = BINDINGS.iter().filter(|binding| !binding.keys.is_empty());
            for (keys, about) in keys.map(|binding| (binding.keys, binding.about)).chain(POINTER) {
                ui.monospace(keys);
                ui.label(about);
                ui.end_row();
            }
        });
    });
    viewer.help = open;
}
