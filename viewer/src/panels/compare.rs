//! How two runs differ: from where on, and by how much now.

use eframe::egui::Ui;
use lamina2d::record::Apart;

use super::{facts, number, settings_named};
use crate::app::Viewer;

/// Draws it.
pub fn show(ui: &mut Ui, viewer: &mut Viewer) {
    let [a, b] = viewer.panes.as_slice() else {
        ui.weak("Open a second recording to compare it with the first.");
        return;
    };
    ui.label(format!("{} against {}", a.source.name(), b.source.name()));
    let (step_a, step_b) = (a.frame().step, b.frame().step);
    if step_a == step_b {
        let apart = Apart::of(a.frame(), b.frame());
        let now = [
            ("step", step_a.to_string()),
            ("bodies that differ", apart.bodies.to_string()),
            ("farthest apart", format!("{} m", number(apart.position))),
            ("most turned", format!("{} rad", number(apart.angle))),
            ("velocity differs by", format!("{} m/s", number(apart.velocity))),
        ];
        facts(ui, "apart", now);
    } else {
        ui.label(format!("The second has no frame of step {step_a}; shown is that of step {step_b}."));
    }
    ui.separator();
    let Some(difference) = &viewer.difference else {
        ui.label("The hashes of all steps both have are the same.");
        return;
    };
    let mut rows = vec![("first difference", format!("step {}", difference.step))];
    if let (Some(slot), Some(column)) = (difference.slot, difference.column) {
        rows.push(("body", slot.to_string()));
        rows.push(("column", column.to_owned()));
    }
    if let Some([first, second]) = difference.values {
        rows.push(("first has", first.to_string()));
        rows.push(("second has", second.to_string()));
    }
    facts(ui, "difference", rows);
    ui.separator();
    ui.strong("Settings that differ");
    let [mine, theirs] = [0, 1].map(|at: usize| settings_named(&viewer.panes[at].source.info().settings));
    let both = mine.into_iter().zip(theirs).filter(|(a, b)| a != b);
    let differ: Vec<_> = both.map(|((name, a), (_, b))| (name, format!("{a}, second {b}"))).collect();
    if differ.is_empty() {
        ui.weak("none");
    }
    facts(ui, "settings apart", differ);
}
