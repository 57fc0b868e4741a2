//! What narrow phase and solver share: manifolds.
//!
//! A manifold is two rows of eight reals, written by the narrow phase straight into the layout a solver
//! gathers, beside a key of 16 bytes: 80 B per contact in f32. One-point and two-point manifolds have
//! the same rows; what is unused is 0.

use crate::column::Column;
use crate::lanes::{Lanes, ROW, Real};

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
    pub points: u16,
    /// The narrow phase's bucket it came from, 0 to 5.
    pub bucket: u16,
}

impl Key {
    /// Ascends along the list of contacts, and names a pair of slots from step to step: bucket, lower
    /// slot, higher slot.
    #[inline(always)]
    fn order(&self) -> u64 {
        u64::from(self.bucket) << 60 | u64::from(self.a.min(self.b)) << 30 | u64::from(self.a.max(self.b))
    }
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

/// Entries of a contact's row of impulses.
pub mod impulse {
    /// Normal impulse of point 0, N·s; point 1 follows.
    pub const NORMAL: usize = 0;
    /// Tangent impulse of point 0, N·s, along the normal turned a quarter counter-clockwise; point 1 follows.
    pub const TANGENT: usize = 2;
    /// Velocity with which point 0 is to part in this step, m/s, negated; point 1 follows.
    pub const BOUNCE: usize = 4;
}

/// Impulses carried from step to step by contacts that persist: same pair, same features.
#[derive(Clone, Debug)]
pub struct Impulses<R: Real> {
    keys: Vec<Key>,
    rows: Column<R>,
    old_rows: Column<R>,
}

impl<R: Real> Default for Impulses<R> {
    fn default() -> Self {
        let rows = || Column::new(R::ZERO);
        Self { keys: Vec::new(), rows: rows(), old_rows: rows() }
    }
}

impl<R: Real> Impulses<R> {
    /// Forgets everything: bodies came or went, and slots may mean others now.
    pub fn forget(&mut self) {
        self.keys.clear();
    }

    /// Rows of impulses, one per contact of the last [`Impulses::carry`]; see [`impulse`].
    pub fn rows_mut(&mut self) -> &mut [[R; ROW]] {
        self.rows.rows_mut()
    }

    /// Takes over the impulses of contacts that persist and starts new ones at 0. Both lists ascend, so one
    /// walk along them finds all. Says whether the contacts are the very same as last time, one for one.
    pub fn carry(&mut self, manifolds: &Manifolds<R>) -> bool {
        if self.keys == manifolds.keys {
            for row in &mut self.rows.rows_mut()[..self.keys.len()] {
                row[impulse::BOUNCE..impulse::BOUNCE + 2].fill(R::ZERO);
            }
            return true;
        }
        std::mem::swap(&mut self.rows, &mut self.old_rows);
        if self.rows.rows().len() < manifolds.len() {
            self.rows.resize(manifolds.len() * ROW * 2);
        }
        let (old_rows, rows) = (self.old_rows.rows(), self.rows.rows_mut());
        let mut old = self.keys.iter().zip(old_rows).map(|(key, row)| (key.order(), key, row)).peekable();
        for (row, key) in rows.iter_mut().zip(&manifolds.keys) {
            let order = key.order();
            while old.next_if(|(old_order, ..)| *old_order < order).is_some() {}
            *row = match old.next_if(|(old_order, ..)| *old_order == order) {
                Some((_, old_key, old_row)) => carried(key, old_key, old_row),
                None => [R::ZERO; ROW],
            };
        }
        self.keys.clone_from(&manifolds.keys);
        debug_assert!(
            self.keys.is_sorted_by_key(Key::order),
            "the narrow phase goes through its buckets in order"
        );
        false
    }
}

/// The impulses of the points that persist, matched by feature.
#[inline(always)]
fn carried<R: Real>(key: &Key, old_key: &Key, old: &[R; ROW]) -> [R; ROW] {
    let mut row = [R::ZERO; ROW];
    for k in 0..key.points as usize {
        for j in 0..old_key.points as usize {
            if old_key.features[j] == key.features[k] {
                row[impulse::NORMAL + k] = old[impulse::NORMAL + j];
                row[impulse::TANGENT + k] = old[impulse::TANGENT + j];
            }
        }
    }
    row
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

    /// Makes room for `more` contacts.
    pub fn reserve(&mut self, more: usize) {
        self.keys.reserve(more);
        let rows = self.keys.len() + more;
        if self.geometry.rows().len() < rows {
            self.geometry.resize(rows * ROW * 2);
            self.surface.resize(rows * ROW * 2);
        }
    }

    /// Appends a contact; there must be room for it.
    #[inline(always)]
    pub fn push(&mut self, key: Key, geometry: [R; ROW], surface: [R; ROW]) {
        let at = self.keys.len();
        self.keys.push(key);
        self.geometry.rows_mut()[at] = geometry;
        self.surface.rows_mut()[at] = surface;
    }

    /// Appends a whole batch of contacts, rows given as lanes; there must be room for them.
    #[inline(always)]
    pub fn push_all<L: Lanes<Elem = R>>(
        &mut self,
        keys: impl Iterator<Item = Key>,
        geometry: [L; ROW],
        surface: [L; ROW],
    ) {
        let at = self.keys.len();
        self.keys.extend(keys);
        L::store_rows(geometry, &mut self.geometry.rows_mut()[at..]);
        L::store_rows(surface, &mut self.surface.rows_mut()[at..]);
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
