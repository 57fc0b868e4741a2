//! What was run, with what, and what the step shown counted.

use eframe::egui::Ui;
use lamina2d::record::STATISTICS;

use super::{facts, number, settings_named};
use crate::app::Viewer;

/// Draws it.
pub fn show(ui: &mut Ui, viewer: &mut Viewer) {
    if viewer.panes.is_empty() {
        ui.weak("Nothing is open.");
    }
    for pane in &viewer.panes {
        let (source, name) = (&pane.source, pane.source.name());
        ui.heading(name);
        let info = source.info();
        let whole = source.loss().map_or_else(|| "whole".to_owned(), |loss| format!("not whole, {loss}"));
        let mut rows = vec![
            ("scene", info.scene.clone()),
            ("seed", info.seed.to_string()),
            ("frame every", format!("{} steps", info.every)),
        ];
        rows.extend(settings_named(&info.settings));
        rows.extend(source.facts());
        rows.push(("the file is", whole));
        rows.push(("crate", format!("lamina2d {} at {}", info.crate_version, info.commit)));
        rows.push(("compiler", info.rustc.clone()));
        rows.push(("flags", info.flags.clone()));
        rows.push(("features", info.features.join(" ")));
        facts(ui, &format!("run {name}"), rows);
        if let Some(row) = source.row(pane.frame().step) {
            ui.add_space(6.0);
            ui.strong(format!("Step {}", row.step));
            let numbers = STATISTICS.iter().zip(row.values).map(|(name, value)| (*name, number(value)));
            let hash = ("hash", format!("{:016x}", row.hash));
            facts(ui, &format!("step {name}"), numbers.chain([hash]));
        }
        ui.add_space(10.0);
    }
}
