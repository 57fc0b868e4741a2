//! The bar at the top: opening files, theme, scale, and what went wrong.

use std::path::PathBuf;

use eframe::egui::{DragValue, Key, RichText, Role, TextEdit, Ui, vec2};

use super::name;
use crate::app::Viewer;
use crate::command::Command;

/// Draws it.
pub fn show(ui: &mut Ui, viewer: &mut Viewer) {
    ui.add_space(2.0);
    ui.horizontal_wrapped(|ui| {
        open(ui, viewer);
        ui.separator();
        let theme = if viewer.view.dark { "Light" } else { "Dark" };
        if ui.button(theme).on_hover_text("the other theme").clicked() {
            viewer.view.dark = !viewer.view.dark;
        }
        ui.label("Scale");
        let scale = DragValue::new(&mut viewer.view.ui_scale)
            .range(0.5..=3.0)
            .speed(0.01)
            .update_while_editing(false);
        let scale = ui.add(scale.fixed_decimals(2)).on_hover_text("size of everything in the window");
        name(&scale, Role::SpinButton, "Scale of the window");
        if ui.button("Keys (?)").clicked() {
            viewer.run(Command::Help);
        }
    });
    let mut dismissed = false;
    if let Some(why) = &viewer.error {
        ui.horizontal_wrapped(|ui| {
            dismissed = ui.button("Dismiss").clicked();
            ui.label(RichText::new(why).color(ui.visuals().error_fg_color));
        });
    }
    if dismissed {
        viewer.error = None;
    }
    for pane in &viewer.panes {
        if let Some(loss) = pane.source.loss() {
            let text = format!("{} is damaged or unfinished: {loss}", pane.source.name());
            ui.label(RichText::new(text).color(ui.visuals().warn_fg_color));
        }
        if let Some(why) = pane.error() {
            ui.label(RichText::new(why).color(ui.visuals().error_fg_color));
        }
    }
    ui.add_space(2.0);
}

fn open(ui: &mut Ui, viewer: &mut Viewer) {
    let field = TextEdit::singleline(&mut viewer.path).hint_text("path of a recording");
    let field = ui.add_sized(vec2(300.0, 20.0), field);
    name(&field, Role::TextInput, "Path of a recording");
    let entered = field.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
    let typed = PathBuf::from(viewer.path.trim());
    let some = !typed.as_os_str().is_empty();
    let first = ui.add_enabled(some, eframe::egui::Button::new("Open")).clicked();
    if some && (first || entered) {
        viewer.try_open(&typed, false);
    }
    let second = some && !viewer.panes.is_empty();
    let second = ui.add_enabled(second, eframe::egui::Button::new("Open as second"));
    if second.on_hover_text("beside the first, at the same step").clicked() {
        viewer.try_open(&typed, true);
    }
    if viewer.panes.len() > 1 && ui.button("Close second").clicked() {
        viewer.close_second();
    }
}
