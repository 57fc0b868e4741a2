//! Contacts: where bodies touch, which way, how deep and how hard.

use eframe::egui::Pos2;

use super::{Brush, Scenery};
use crate::pane::Pane;

/// Length of a unit normal, points.
const NORMAL: f32 = 16.0;
/// Length of the frame's largest impulse at scale 1, points.
const LARGEST_IMPULSE: f64 = 60.0;

/// A point of a contact in the world, and what acts there.
#[derive(Clone, Copy, Debug)]
pub(super) struct Touch {
    /// Midway between the two surfaces, metres.
    middle: [f64; 2],
    /// On the surfaces of A and of B, metres.
    ends: [[f64; 2]; 2],
    /// Unit, from A to B.
    normal: [f64; 2],
    /// N·s per substep.
    impulse: f64,
}

/// The points of a frame's contacts. Arms are from A's centroid when the manifold was found, so a point may have moved
/// by as much as A has since.
pub(super) fn touches(pane: &Pane) -> impl Iterator<Item = Touch> + '_ {
    pane.data().contacts.iter().flat_map(move |contact| {
        let from = pane.position(contact.slots[0] as usize).unwrap_or([0.0; 2]);
        (0..contact.points).map(move |k| {
            let (arm, normal) = (contact.arm(k), contact.normal());
            let middle = [from[0] + arm[0], from[1] + arm[1]];
            let half = 0.5 * contact.separation(k);
            let end = |side: f64| [0, 1].map(|axis| middle[axis] + side * half * normal[axis]);
            Touch { middle, ends: [end(-1.0), end(1.0)], normal, impulse: contact.impulse(k) }
        })
    })
}

/// Draws what the view asks for.
pub(super) fn draw(brush: &mut Brush, scenery: &Scenery<'_>, pane: &Pane) {
    let (view, palette) = (scenery.view, &scenery.palette);
    if !(view.contacts || view.normals || view.depths || view.impulses) {
        return;
    }
    let largest =
        touches(pane).map(|touch| touch.impulse.abs()).filter(|size| size.is_finite()).fold(0.0, f64::max);
    let per_impulse = LARGEST_IMPULSE * f64::from(view.impulse_scale) / largest.max(f64::MIN_POSITIVE);
    for touch in touches(pane) {
        let at = scenery.screen(touch.middle);
        if !scenery.sees(at, 80.0) {
            continue;
        }
        let [nx, ny] = touch.normal.map(|value| value as f32);
        let along = |length: f32| Pos2::new(at.x + nx * length, at.y - ny * length);
        if view.impulses && touch.impulse != 0.0 {
            let half = (0.5 * touch.impulse * per_impulse) as f32;
            brush.line(along(-half), along(half), palette.impulse, 3.0);
        }
        if view.normals {
            brush.arrow(at, along(NORMAL), palette.normal, 1.0);
        }
        if view.contacts {
            brush.point(at, 3.5, palette.contact);
        }
        if view.depths {
            let [a, b] = touch.ends.map(|end| scenery.screen(end));
            brush.line(a, b, palette.contact, 1.0);
            brush.point(a, 2.2, palette.depths[0]);
            brush.point(b, 2.2, palette.depths[1]);
        }
    }
}
