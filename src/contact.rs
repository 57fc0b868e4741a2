//! What narrow phase and solver share: manifolds.
//!
//! A manifold is two rows of eight reals, written by the narrow phase straight into the layout a solver
//! gathers, beside a key of 16 bytes: 80 B per contact in f32. One-point and two-point manifolds have
//! the same rows; what is unused is 0.

use crate::column::Column;
use crate::lanes::{ROW, Real};

/// Which features touch, the same from step to step while they do: for polygons bit 7 says whose face
/// is the reference (1: B's), bits 4–6 its edge, bits 1–3 the other's edge, bit 0 which end of it.
pub type Feature = u16;

/// Who touches whom.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Key {
    /// Slot of body A: the one of the lesser form (circle < box < polygon), or the lower slot.
    pub a: u32,
    /// Slot of body B.
    pub b: u32,
    /// One per point.
    pub features: [Feature; 2],
    /// 1 or 2.
    pub points: u32,
}

/// Entries of a manifold's first row.
pub mod geometry {
    /// Unit normal from A to B, x; y follows.
    pub const NORMAL: usize = 0;
    /// Arm from A's centroid to point 0, world axes, metres: x; y, and point 1, follow.
    pub const ARM_A: usize = 2;
    /// Separation of point 0, metres, negative where they overlap; point 1 follows.
    pub const SEPARATION: usize = 6;
}

/// Entries of a manifold's second row.
pub mod surface {
    /// Arm from B's centroid to point 0, world axes, metres: x; y, and point 1, follow.
    pub const ARM_B: usize = 0;
    /// Coulomb coefficient: the smaller of the two bodies'.
    pub const FRICTION: usize = 4;
    /// Coefficient of restitution: the smaller of the two bodies'.
    pub const RESTITUTION: usize = 5;
}

/// The contacts of a step, in the order of buckets and pairs.
#[derive(Clone, Debug)]
pub struct Manifolds<R: Real> {
    /// Who touches whom.
    pub keys: Vec<Key>,
    /// First rows; see [`geometry`].
    pub geometry: Column<R>,
    /// Second rows; see [`surface`].
    pub surface: Column<R>,
}

impl<R: Real> Default for Manifolds<R> {
    fn default() -> Self {
        Self { keys: Vec::new(), geometry: Column::new(R::ZERO), surface: Column::new(R::ZERO) }
    }
}

impl<R: Real> Manifolds<R> {
    /// Contacts.
    pub fn len(&self) -> usize {
        self.keys.len()
    }
    /// Nothing touches?
    pub fn is_empty(&self) -> bool {
        self.keys.is_empty()
    }
    /// Forgets all contacts, keeps the memory.
    pub fn clear(&mut self) {
        self.keys.clear();
    }

    /// Appends a contact. Rows are kept at least as long as keys; they only grow.
    #[inline(always)]
    pub fn push(&mut self, key: Key, geometry: [R; ROW], surface: [R; ROW]) {
        let at = self.keys.len();
        self.keys.push(key);
        if self.geometry.rows().len() <= at {
            self.geometry.resize((at + 1) * ROW * 2);
            self.surface.resize((at + 1) * ROW * 2);
        }
        self.geometry.rows_mut()[at] = geometry;
        self.surface.rows_mut()[at] = surface;
    }

    /// The contact at a position in the list.
    pub fn contact(&self, at: usize) -> Contact {
        let (key, row) = (self.keys[at], self.geometry.rows()[at]);
        let value = |k: usize| row[k].to_f64();
        let point = |k: usize| ContactPoint {
            arm_a: [value(geometry::ARM_A + 2 * k), value(geometry::ARM_A + 2 * k + 1)],
            separation: value(geometry::SEPARATION + k),
            feature: key.features[k],
        };
        let points = (0..key.points as usize).map(point).collect();
        Contact { a: key.a, b: key.b, normal: [value(0), value(1)], points }
    }
}

/// One contact, spelled out in `f64`: for reports, tests and recordings.
#[derive(Clone, Debug, PartialEq)]
pub struct Contact {
    /// Slot of body A.
    pub a: u32,
    /// Slot of body B.
    pub b: u32,
    /// Unit normal from A to B.
    pub normal: [f64; 2],
    /// One or two.
    pub points: Vec<ContactPoint>,
}

/// One point of a contact.
#[derive(Clone, Debug, PartialEq)]
pub struct ContactPoint {
    /// From A's centroid, world axes, metres; midway between the two surfaces.
    pub arm_a: [f64; 2],
    /// Metres, negative where the bodies overlap.
    pub separation: f64,
    /// Which features touch.
    pub feature: Feature,
}
