//! Seams: where static outlines lie flush against each other, and what of them can be touched.
//!
//! **The law.** Boxes and polygons that lie flush make one surface. What slides, rolls or bounces along it feels the surface,
//! not the outlines it is put together of: a face that a neighbour covers can be touched by nobody, and at a corner that a
//! neighbour continues only directions between the two surfaces' normals are outward. So covered faces are never a contact's
//! reference, a corner whose surface goes on straight or turns inward is none, and one that turns outward answers in
//! the wedge that is left of it.
//!
//! Outlines are looked over when bodies have changed. Those of which something is covered have an [`Outline`] here, and their
//! pairs are met one by one, in `f64` ([`Outline::meet`]): they are few, and exactness is what they are here for. All others
//! are left to the lanes of the narrow phase.

mod find;
mod meet;

use glam::DVec2;

use crate::shape::MAX_VERTICES;

pub(crate) use meet::Met;

/// Outlines that are no further apart are flush, metres; less where a face is shorter than a few centimetres
/// ([`FLUSH_SHARE`]).
const FLUSH_M: f64 = 2.4e-4;
/// The same over the length of the shortest face.
const FLUSH_SHARE: f64 = 0.024;

/// A side of an outline.
#[derive(Clone, Copy, Debug, Default)]
struct Face {
    /// Where it begins, counter-clockwise, world, metres.
    start: DVec2,
    /// Unit, from its start to its end.
    tangent: DVec2,
    /// Unit, outward.
    normal: DVec2,
    /// Metres.
    length: f64,
    /// Can it be touched?
    exposed: bool,
}

impl Face {
    /// How far outside of it a point lies, metres.
    fn outside(&self, point: DVec2) -> f64 {
        (point - self.start).dot(self.normal)
    }
    /// How far along it, metres.
    fn along(&self, point: DVec2) -> f64 {
        (point - self.start).dot(self.tangent)
    }
}

/// A static box or polygon of which something is covered.
#[derive(Clone, Debug)]
pub(crate) struct Outline {
    faces: [Face; MAX_VERTICES],
    count: usize,
    /// The outward directions at the corner where a face begins: from one unit vector counter-clockwise to another; none
    /// where the surface goes on.
    wedges: [Option<[DVec2; 2]>; MAX_VERTICES],
    /// How far a face goes on beyond a corner that is none, metres: over what flush neighbours leave open.
    reach: f64,
}

impl Outline {
    fn faces(&self) -> &[Face] {
        &self.faces[..self.count]
    }

    fn contains(&self, point: DVec2) -> bool {
        self.faces().iter().all(|face| face.outside(point) <= 0.0)
    }
}

/// The outlines with something covered; memory is kept.
#[derive(Clone, Debug, Default)]
pub(crate) struct Seams {
    outlines: Vec<Outline>,
    /// By slot: which of those, counted from 1; 0 for none. Empty where there is none at all.
    of_slot: Vec<u32>,
}

impl Seams {
    /// Is nothing covered?
    pub(crate) fn is_empty(&self) -> bool {
        self.outlines.is_empty()
    }

    /// The outline of a static body of which something is covered.
    pub(crate) fn of(&self, slot: u32) -> Option<&Outline> {
        let number = *self.of_slot.get(slot as usize)?;
        self.outlines.get((number as usize).checked_sub(1)?)
    }
}
