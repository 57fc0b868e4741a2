//! Panels around the canvas. Every control has a name of its own, for those who cannot see it, and for the tests.

pub mod bar;
pub mod choices;
pub mod compare;
pub mod curves;
pub mod inspector;
pub mod keys;
pub mod live;
pub mod metadata;
pub mod stage;
pub mod timeline;

use eframe::egui::{Grid, Response, Role, ScrollArea, Ui, WidgetInfo};

use lamina2d::settings::Settings;

use crate::app::{Tab, Viewer};

/// The panel on the right: tabs, and what is behind them.
pub fn details(ui: &mut Ui, viewer: &mut Viewer) {
    ui.add_space(4.0);
    ui.horizontal(|ui| {
        let live = viewer.live().is_some().then_some((Tab::Live, "Live"));
        let tabs = [(Tab::Body, "Body"), (Tab::Run, "Run"), (Tab::Compare, "Compare")];
        for (tab, name) in live.into_iter().chain(tabs) {
            ui.selectable_value(&mut viewer.tab, tab, name);
        }
    });
    ui.separator();
    ScrollArea::vertical().id_salt(("details", viewer.tab as u8)).auto_shrink(false).show(ui, |ui| {
        match viewer.tab {
            Tab::Body => inspector::show(ui, viewer),
            Tab::Run => metadata::show(ui, viewer),
            Tab::Compare => compare::show(ui, viewer),
            Tab::Live => live::show(ui, viewer),
        }
    });
}

/// Gives a control the name that readers of screens say.
fn name(response: &Response, role: Role, name: &str) {
    response.widget_info(|| WidgetInfo::labeled(role, true, name));
}

/// Settings by the names they have on the command line and in scene files.
fn settings_named(settings: &Settings) -> Vec<(&'static str, String)> {
    vec![
        ("integrator", settings.integrator.to_string()),
        ("solver", settings.solver.to_string()),
        ("substeps", settings.substeps.to_string()),
        (
            "max sag",
            settings.max_sag.map_or_else(|| "unbounded".to_owned(), |sag| format!("{} m", number(sag))),
        ),
        ("contact stiffness", number(settings.contact_stiffness())),
        ("step", format!("{} s", number(settings.dt_secs))),
        ("broad phase", settings.broad.to_string()),
        ("precision", settings.precision.to_string()),
        ("lanes", settings.lanes.to_string()),
        ("threads", settings.threads.to_string()),
        ("skips", settings.skips.to_string()),
        ("continuous", settings.continuous.to_string()),
        ("may sleep", settings.sleep.to_string()),
    ]
}

/// Names and values in two columns.
fn facts<'a>(ui: &mut Ui, id: &str, facts: impl IntoIterator<Item = (&'a str, String)>) {
    Grid::new(id).num_columns(2).striped(true).spacing([10.0, 3.0]).show(ui, |ui| {
        for (name, value) in facts {
            ui.weak(name);
            ui.add(eframe::egui::Label::new(value).wrap());
            ui.end_row();
        }
    });
}

/// A number as it is best read: plain where it is neither large nor small.
pub fn number(value: f64) -> String {
    if value.fract() == 0.0 && value.abs() < 1e9 {
        format!("{value:.0}")
    } else if (1e-3..1e5).contains(&value.abs()) {
        format!("{value:.5}")
    } else {
        format!("{value:.4e}")
    }
}
