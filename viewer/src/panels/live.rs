//! What is done to a running world, and how fast it runs.

use eframe::egui::{ComboBox, DragValue, Role, Slider, TextEdit, Ui, vec2};
use lamina2d::force::Forces;
use lamina2d::scene::BodyKind;
use lamina2d::session::Action;
use lamina2d::settings::{Integrator, Solver};

use super::{facts, name, number};
use crate::app::Viewer;
use crate::command::Command;
use crate::live::Tool;

/// Sizes of new bodies, metres, and their densities, kg/m².
const RANGES: [std::ops::RangeInclusive<f64>; 2] = [0.01..=10.0, 1e-3..=1e4];

/// Draws it.
pub fn show(ui: &mut Ui, viewer: &mut Viewer) {
    if viewer.live().is_none() {
        ui.weak("No world is running: lamina-viewer --live SCENE starts one.");
        return;
    }
    tools(ui, viewer);
    selected(ui, viewer);
    methods(ui, viewer);
    speed(ui, viewer);
    saving(ui, viewer);
}

fn tools(ui: &mut Ui, viewer: &mut Viewer) {
    ui.strong("A click on the canvas");
    ui.horizontal_wrapped(|ui| {
        for tool in Tool::ALL {
            ui.selectable_value(&mut viewer.tool, tool, tool.name());
        }
    });
    let [sizes, densities] = RANGES;
    let Some(live) = viewer.live() else { return };
    let size = ui.add(Slider::new(&mut live.size, sizes).logarithmic(true).suffix(" m").text("size"));
    name(&size, Role::Slider, "Size of new bodies");
    let density =
        Slider::new(&mut live.density, densities).logarithmic(true).suffix(" kg/m²").text("density");
    name(&ui.add(density), Role::Slider, "Density of new bodies");
    ui.add_space(6.0);
}

fn selected(ui: &mut Ui, viewer: &mut Viewer) {
    ui.strong("The selected body");
    let slot = viewer.selected;
    let body = viewer.live().and_then(|live| live.session().world().body(slot?));
    let Some(body) = body else {
        ui.weak("none: click one with the hand, or drag it");
        ui.add_space(6.0);
        return;
    };
    ui.horizontal(|ui| {
        ui.label(format!("body {}", body.id.slot()));
        let pin = if body.kind == BodyKind::Static { "Make dynamic" } else { "Make static" };
        if ui.button(pin).on_hover_text("S").clicked() {
            viewer.run(Command::Pin);
        }
        if ui.button("Delete").on_hover_text("delete").clicked() {
            viewer.run(Command::Delete);
        }
    });
    ui.add_space(6.0);
}

/// A choice among names; the one chosen, if another than before.
fn choice<T: Copy + PartialEq + std::fmt::Display>(ui: &mut Ui, what: &str, all: &[T], now: T) -> Option<T> {
    let mut chosen = now;
    let field = ComboBox::from_id_salt(what).width(160.0).selected_text(now.to_string()).show_ui(ui, |ui| {
        for &one in all {
            ui.selectable_value(&mut chosen, one, one.to_string());
        }
    });
    name(&field.response, Role::ComboBox, what);
    (chosen != now).then_some(chosen)
}

fn methods(ui: &mut Ui, viewer: &mut Viewer) {
    ui.strong("Methods and fields");
    let Some(live) = viewer.live() else { return };
    let settings = *live.settings();
    let forces = live.session().world().body_table().forces;
    let (mut integrator, mut solver) = (settings.integrator, settings.solver);
    let (mut substeps, mut gravity) = (settings.substeps, forces.gravity.unwrap_or_default());
    integrator = choice(ui, "Integrator", Integrator::ALL, integrator).unwrap_or(integrator);
    solver = choice(ui, "Solver", Solver::ALL, solver).unwrap_or(solver);
    ui.horizontal(|ui| {
        ui.label("substeps");
        let field = DragValue::new(&mut substeps).range(1..=64).speed(0.05).update_while_editing(false);
        name(&ui.add(field), Role::SpinButton, "Substeps");
    });
    ui.horizontal(|ui| {
        ui.label("gravity");
        for (value, axis) in gravity.iter_mut().zip(["Gravity x", "Gravity y"]) {
            let field = DragValue::new(value).range(-100.0..=100.0).speed(0.05).update_while_editing(false);
            name(&ui.add(field.suffix(" m/s²")), Role::SpinButton, axis);
        }
    });
    if (integrator, solver, substeps) != (settings.integrator, settings.solver, settings.substeps) {
        viewer.act(|live| live.act(Action::Choose { integrator, solver, substeps }));
    }
    if gravity != forces.gravity.unwrap_or_default() {
        let gravity = Some(gravity);
        viewer.act(|live| live.act(Action::Fields(Box::new(Forces { gravity, ..forces }))));
    }
    ui.add_space(6.0);
}

fn speed(ui: &mut Ui, viewer: &mut Viewer) {
    ui.strong("How fast");
    let (fps, playing) = (viewer.fps, viewer.playback.playing());
    let Some(live) = viewer.live() else { return };
    let world = live.session().world();
    let row = crate::source::Source::rows(live).last();
    let get = |name: &str| row.and_then(|row| row.get(name)).unwrap_or(0.0);
    let stages = ["broad", "narrow", "prepare", "integrate", "solve", "measure"];
    let ms = stages.map(|stage| (stage, get(&format!("{stage}_ns")) * 1e-6));
    let total: f64 = ms.iter().map(|(_, ms)| ms).sum();
    let mut rows = vec![
        ("pictures per second", if playing { format!("{fps:.0}") } else { "paused".to_owned() }),
        ("of real time", format!("{:.2} ×", live.share_of_real_time())),
        ("bodies", world.bodies().to_string()),
        ("contacts", number(get("contacts"))),
        ("steps", world.steps().to_string()),
        ("a step", format!("{total:.3} ms")),
    ];
    rows.extend(ms.map(|(stage, ms)| (stage, format!("{ms:.3} ms"))));
    facts(ui, "live", rows);
    ui.add_space(6.0);
}

fn saving(ui: &mut Ui, viewer: &mut Viewer) {
    ui.strong("Recording");
    let Some(live) = viewer.live() else { return };
    if live.records() {
        ui.label("It is recorded as it happens; closing the window finishes the file.");
    }
    let busy = live.is_saving();
    if busy {
        crate::canvas::again(ui.ctx());
    }
    let field = ui.add_sized(vec2(220.0, 20.0), TextEdit::singleline(&mut live.path).hint_text("path"));
    name(&field, Role::TextInput, "Path to save to");
    let some = !busy && !live.path.trim().is_empty();
    let save = ui.add_enabled(some, eframe::egui::Button::new("Save recording"));
    if save.on_hover_text("from the first step on, with everything done").clicked() {
        live.save();
    }
    let restart = ui.add_enabled(!live.records(), eframe::egui::Button::new("Start anew"));
    let restart = restart.on_hover_text("the scene as it was at first").clicked();
    if let Some(said) = &live.said {
        ui.label(said);
    }
    if restart {
        match live.anew() {
            Ok(live) => viewer.set_live(live),
            Err(why) => viewer.error = Some(why.to_string()),
        }
    }
}
