//! Which faces and corners of static outlines their neighbours cover.

use glam::DVec2;

use super::{FLUSH_M, FLUSH_SHARE, Face, Outline, Seams};
use crate::body::{Bodies, BodyKind};
use crate::lanes::Real;
use crate::shape::MAX_VERTICES;

/// Where a face is probed, as shares of its length: all covered, it is.
const PROBES: [f64; 7] = [0.03, 0.17, 0.33, 0.5, 0.67, 0.83, 0.97];
/// Surfaces that turn by less go on straight, rad.
const STRAIGHT_RAD: f64 = 2e-3;

impl Seams {
    /// Looks over the static bodies.
    pub(crate) fn look_over<R: Real>(&mut self, bodies: &Bodies<R>) {
        self.outlines.clear();
        self.of_slot.clear();
        let is_static = |&slot: &usize| bodies.kind(slot) == BodyKind::Static && bodies.is_alive(slot);
        let mut all: Vec<(usize, Outline, [DVec2; 2])> = bodies
            .slots()
            .filter(is_static)
            .filter_map(|slot| outline_of(bodies, slot).map(|outline| (slot, outline)))
            .map(|(slot, outline)| {
                let bounds = bounds_of(&outline);
                (slot, outline, bounds)
            })
            .collect();
        all.sort_by(|a, b| a.2[0].x.total_cmp(&b.2[0].x).then(a.0.cmp(&b.0)));
        let widest = all.iter().map(|(_, _, [low, high])| high.x - low.x).fold(0.0, f64::max);
        let mut found = Vec::new();
        for at in 0..all.len() {
            let (slot, outline, [low, high]) = &all[at];
            let from = all.partition_point(|(_, _, [other, _])| other.x < low.x - widest);
            let near = all[from..].iter().take_while(|(_, _, [other, _])| other.x <= high.x);
            let meets = |[other_low, other_high]: &[DVec2; 2]| {
                other_low.cmple(*high).all() && low.cmple(*other_high).all()
            };
            let neighbours: Vec<&Outline> = near
                .filter(|(other, _, bounds)| other != slot && meets(bounds))
                .map(|(_, outline, _)| outline)
                .collect();
            if !neighbours.is_empty() {
                found.push((*slot, seen_beside(outline, &neighbours)));
            }
        }
        // What is continued by a neighbour's face has to know whether that is covered itself: faces first, then corners.
        let covered: Vec<(usize, Outline)> = found
            .into_iter()
            .filter(|(_, outline)| outline.faces().iter().any(|face| !face.exposed))
            .collect();
        if covered.is_empty() {
            return;
        }
        self.of_slot.resize(bodies.len(), 0);
        for (number, (slot, mut outline)) in covered.iter().cloned().enumerate() {
            let others: Vec<&Outline> =
                covered.iter().filter(|(other, _)| *other != slot).map(|(_, o)| o).collect();
            cut_wedges(&mut outline, &others);
            self.of_slot[slot] = number as u32 + 1;
            self.outlines.push(outline);
        }
    }
}

/// The outline of a box or polygon, all of it exposed.
fn outline_of<R: Real>(bodies: &Bodies<R>, slot: usize) -> Option<Outline> {
    let placed = bodies.placed(slot);
    let count = placed.count;
    if count == 0 {
        return None;
    }
    let faces: [Face; MAX_VERTICES] = crate::each::indexed(|k| placed.face(k));
    let shortest = faces[..count].iter().map(|face| face.length).fold(f64::MAX, f64::min);
    Some(Outline { faces, count, wedges: [None; MAX_VERTICES], reach: FLUSH_M.min(FLUSH_SHARE * shortest) })
}

/// Lowest and highest coordinates, with what counts as flush beyond.
fn bounds_of(outline: &Outline) -> [DVec2; 2] {
    let starts = outline.faces().iter().map(|face| face.start);
    let none = [DVec2::MAX, DVec2::MIN];
    let [low, high] = starts.fold(none, |[low, high], at| [low.min(at), high.max(at)]);
    let more = DVec2::splat(2.0 * outline.reach);
    [low - more, high + more]
}

/// The same outline, with the faces that neighbours cover.
fn seen_beside(outline: &Outline, neighbours: &[&Outline]) -> Outline {
    let mut seen = outline.clone();
    for face in &mut seen.faces[..outline.count] {
        let covers = |share: &f64| {
            let at = face.start + face.tangent * (share * face.length);
            neighbours.iter().any(|other| {
                let probe = at + face.normal * (outline.reach.min(other.reach) * 1.1);
                other.contains(probe)
            })
        };
        face.exposed = !PROBES.iter().all(covers);
    }
    seen
}

/// What is left of each corner: the directions between the normals of the surfaces that meet there.
fn cut_wedges(outline: &mut Outline, others: &[&Outline]) {
    for k in 0..outline.count {
        let (next, last) = (outline.faces[k], outline.faces[(k + outline.count - 1) % outline.count]);
        let corner = next.start;
        // Of the surface that goes on where a face is covered, the one that turns away from the other least.
        let goes_on = |other_end: DVec2, turn: &dyn Fn(DVec2) -> f64| {
            let reach = 2.0 * outline.reach;
            let on = |face: &&Face| {
                let along = face.along(corner);
                face.outside(corner).abs() <= reach && -reach <= along && along <= face.length + reach
            };
            let faces = others.iter().flat_map(|other| other.faces()).filter(|face| face.exposed).filter(on);
            let turns = faces.map(|face| (turn(face.normal), face.normal));
            // One that faces the other way closes the corner.
            let open = turns.filter(|(_, normal)| normal.dot(other_end) > -0.999);
            open.min_by(|a, b| a.0.total_cmp(&b.0)).filter(|(turn, _)| *turn > STRAIGHT_RAD).map(|(_, n)| n)
        };
        let angle = |from: DVec2, to: DVec2| from.perp_dot(to).atan2(from.dot(to));
        outline.wedges[k] = match (last.exposed, next.exposed) {
            (true, true) => Some([last.normal, next.normal]),
            (true, false) => goes_on(last.normal, &|n| angle(last.normal, n)).map(|n| [last.normal, n]),
            (false, true) => goes_on(next.normal, &|n| angle(n, next.normal)).map(|n| [n, next.normal]),
            (false, false) => None,
        };
    }
}
