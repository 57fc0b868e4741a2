//! The selected body: its columns and its contacts.

use eframe::egui::Ui;
use lamina2d::record::RecordedContact;
use lamina2d::scene::{BodyKind, ShapeSpec};

use super::choices::describe;
use super::{facts, number};
use crate::app::Viewer;
use crate::canvas::bodies::speed;
use crate::pane::{Pane, column};

/// Columns with their units, in the order of [`lamina2d::world::COLUMNS`].
const UNITS: [(&str, &str); 7] =
    [("x", "m"), ("y", "m"), ("cos", ""), ("sin", ""), ("vx", "m/s"), ("vy", "m/s"), ("w", "rad/s")];

/// Draws it.
pub fn show(ui: &mut Ui, viewer: &mut Viewer) {
    let Some(slot) = viewer.selected else {
        ui.weak("Click a body on the canvas or in the list.");
        return;
    };
    let mut chosen = None;
    for pane in &viewer.panes {
        if viewer.panes.len() > 1 {
            ui.strong(pane.source.name());
        }
        if let Some(other) = body(ui, pane, slot) {
            chosen = Some(other);
        }
        ui.add_space(8.0);
    }
    if chosen.is_some() {
        viewer.selected = chosen;
    }
}

/// Draws one run's body; returns another one that was clicked.
fn body(ui: &mut Ui, pane: &Pane, slot: usize) -> Option<usize> {
    let (Some(body), Some(_)) = (pane.entry(slot), pane.position(slot)) else {
        ui.label(format!("No body lives in slot {slot} at step {}.", pane.frame().step));
        return None;
    };
    ui.heading(describe(slot, body));
    let frame = pane.frame();
    let mut rows: Vec<(&str, String)> = UNITS
        .iter()
        .enumerate()
        .map(|(at, (name, unit))| (*name, format!("{} {unit}", number(frame.get(at, slot)))))
        .collect();
    let angle = frame.get(column::SIN, slot).atan2(frame.get(column::COS, slot));
    let asleep = frame.asleep.get(slot - 1).is_some_and(|asleep| *asleep);
    rows.push(("angle", format!("{} rad", number(angle))));
    rows.push(("speed", format!("{} m/s", number(speed(frame, slot)))));
    rows.push(("state", if asleep { "asleep" } else { "awake" }.to_owned()));
    if body.kind == BodyKind::Dynamic {
        let island = pane.island(slot);
        rows.push(("island", if island == 0 { "alone".to_owned() } else { format!("of body {island}") }));
    }
    rows.push(("mass", format!("{} kg", number(body.mass))));
    rows.push(("inertia", format!("{} kg·m²", number(body.inertia))));
    rows.push(("friction", number(body.friction)));
    rows.push(("restitution", number(body.restitution)));
    rows.push((
        "size",
        match &body.shape {
            ShapeSpec::Circle(radius) => format!("radius {} m", number(*radius)),
            ShapeSpec::Box([x, y]) => format!("half {} × {} m", number(*x), number(*y)),
            ShapeSpec::Polygon(_) => format!("bounding radius {} m", number(body.radius)),
        },
    ));
    rows.push(("generation", body.generation.to_string()));
    facts(ui, &format!("body {}", pane.source.name()), rows);
    contacts(ui, pane, slot)
}

fn contacts(ui: &mut Ui, pane: &Pane, slot: usize) -> Option<usize> {
    let touches = |contact: &&RecordedContact| contact.slots.contains(&(slot as u32));
    let found: Vec<_> = pane.data().contacts.iter().filter(touches).collect();
    ui.add_space(4.0);
    ui.strong(format!("{} contacts", found.len()));
    let mut chosen = None;
    for contact in found {
        let is_a = contact.slots[0] == slot as u32;
        let other = contact.slots[usize::from(is_a)] as usize;
        let [nx, ny] = contact.normal();
        ui.horizontal_wrapped(|ui| {
            let with = if other == 0 { "the world".to_owned() } else { format!("body {other}") };
            if ui.link(with).clicked() && other > 0 {
                chosen = Some(other);
            }
            ui.weak(format!("A {}, B {}, normal {nx:.3}, {ny:.3}", contact.slots[0], contact.slots[1]));
        });
        for k in 0..contact.points {
            let (gap, push) = (number(contact.separation(k)), number(contact.impulse(k)));
            ui.label(format!("   gap {gap} m, impulse {push} N·s"));
        }
        if contact.tangent_impulse() != 0.0 {
            ui.label(format!("   friction {} N·s", number(contact.tangent_impulse())));
        }
    }
    chosen
}
