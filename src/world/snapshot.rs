//! What a step left behind, as bytes: columns are copied whole, and each touching pair becomes one row, so that a
//! recording costs a step little.

use bytemuck::{bytes_of, cast_slice};
use serde::{Deserialize, Serialize};

use super::World;
use crate::body::Bodies;
use crate::contact::ContactRow;
use crate::force::Forces;
use crate::lanes::{Lanes, Real};
use crate::measure::{Counts, StageTimes};
use crate::scene::{BodyKind, ShapeSpec};

/// The columns of a snapshot, in order.
pub const COLUMNS: [&str; 7] = ["x", "y", "c", "s", "vx", "vy", "w"];

/// A world's state after a step; memory is kept from one to the next.
///
/// Numbers are native: little-endian on every machine this crate is built for.
#[derive(Clone, Debug, Default)]
pub struct Snapshot {
    /// Steps taken.
    pub step: u64,
    /// Bytes per number of a column: 4 or 8.
    pub width: usize,
    /// Bytes per number of a contact: 4 or 8.
    pub contact_width: usize,
    /// Bodies that have a place in the columns, living or not: slots 1 to this.
    pub slots: usize,
    /// [`COLUMNS`] one after the other, `slots` numbers each: metres, cos, sin, m/s, rad/s.
    pub columns: Vec<u8>,
    /// Per slot: 1 where a body lives, 3 where it sleeps.
    pub flags: Vec<u8>,
    /// Slots of bodies A and B and the code of [`crate::contact::Code`], per contact, in no particular order.
    pub pairs: Vec<[u32; 3]>,
    /// [`crate::contact::CONTACT_COLUMNS`] per contact, as rows.
    pub contacts: Vec<u8>,
    /// What the step counted.
    pub counts: Counts,
    /// Stage times, summed since they were last set to zero.
    pub times: StageTimes,
    /// Changes of which bodies there are, of their masses and forces, see [`crate::body::Bodies::revision`] and [`crate::body::Bodies::pushes`], and of
    /// the fields.
    pub revision: [u64; 3],
}

impl<L: Lanes> World<L> {
    /// Writes down poses, velocities and contacts as they are between steps; nothing of the world changes.
    /// `contacts`: the touching pairs too.
    pub fn snapshot(&self, into: &mut Snapshot, contacts: bool) {
        let bodies = &self.bodies;
        into.step = self.log.steps;
        into.counts = self.log.counts;
        into.times = *self.log.stopwatch.times();
        into.revision = [bodies.revision() + bodies.pushes(), bodies.removals(), self.laws.revision];
        into.take_bodies(bodies, self.islands.asleep());
        into.pairs.clear();
        into.contacts.clear();
        if contacts {
            self.solving.each_contact(&self.narrow.manifolds, &self.motion, |row: &ContactRow<L::Elem>| {
                into.pairs.push([row.slots[0], row.slots[1], row.code]);
                into.contacts.extend_from_slice(bytes_of(&row.values));
            });
        }
    }
}

impl Snapshot {
    /// Poses and velocities, and who lives and sleeps.
    fn take_bodies<R: Real>(&mut self, bodies: &Bodies<R>, asleep: &[bool]) {
        let slots = bodies.len() - 1;
        self.contact_width = size_of::<R>();
        self.width = if bodies.fine.is_some() { size_of::<f64>() } else { self.contact_width };
        self.slots = slots;
        self.columns.clear();
        if bodies.fine.is_some() {
            let places = (0..2).flat_map(|k| (1..=slots).map(move |slot| bodies.place(slot)[k]));
            let columns = [&bodies.c, &bodies.s, &bodies.vx, &bodies.vy, &bodies.w];
            let others = columns.into_iter().flat_map(|column| &column.as_slice()[1..=slots]);
            let all = places.chain(others.map(|value| value.to_f64()));
            self.columns.extend(all.flat_map(f64::to_le_bytes));
        } else {
            for column in [&bodies.x, &bodies.y, &bodies.c, &bodies.s, &bodies.vx, &bodies.vy, &bodies.w] {
                self.columns.extend_from_slice(cast_slice(&column.as_slice()[1..=slots]));
            }
        }
        self.flags.clear();
        self.flags.extend((1..=slots).map(|slot| {
            u8::from(bodies.is_alive(slot)) | u8::from(asleep.get(slot).copied().unwrap_or(false)) << 1
        }));
    }
}

/// What one body is.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct BodyEntry {
    /// Where it stands in the columns.
    pub slot: u32,
    /// How often the slot has been given anew.
    pub generation: u32,
    /// Static, kinematic or dynamic.
    pub kind: BodyKind,
    /// About its centroid, metres.
    pub shape: ShapeSpec,
    /// Bounding radius about the centroid, metres.
    pub radius: f64,
    /// Kilograms; 0 where nothing can push it.
    pub mass: f64,
    /// kg·m²; 0 where nothing can turn it.
    pub inertia: f64,
    /// Coulomb coefficient.
    pub friction: f64,
    /// Coefficient of restitution.
    pub restitution: f64,
}

/// What all living bodies are, in the order of their slots, and the fields they move in, from a step on.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct BodyTable {
    /// The first step it holds after.
    pub step: u64,
    /// The bodies.
    pub bodies: Vec<BodyEntry>,
    /// The fields.
    pub forces: Forces,
}

impl<L: Lanes> World<L> {
    /// What bodies are, and the fields they move in.
    pub fn body_table(&self) -> BodyTable {
        BodyTable::of(&self.bodies, self.log.steps, self.laws.forces)
    }
}

impl BodyTable {
    fn of<R: Real>(bodies: &Bodies<R>, step: u64, forces: Forces) -> Self {
        let inverse = |value: R| if value > R::ZERO { 1.0 / value.to_f64() } else { 0.0 };
        let entry = |slot: usize| BodyEntry {
            slot: slot as u32,
            generation: bodies.generation(slot),
            kind: bodies.kind(slot),
            shape: bodies.shape_spec(slot),
            radius: bodies.radius[slot].to_f64(),
            mass: inverse(bodies.inv_mass[slot]),
            inertia: inverse(bodies.inv_inertia[slot]),
            friction: bodies.friction[slot].to_f64(),
            restitution: bodies.restitution[slot].to_f64(),
        };
        Self { step, bodies: bodies.slots().map(entry).collect(), forces }
    }
}

impl Snapshot {
    /// The number at `at` of a run of `width`-byte numbers.
    pub fn number(bytes: &[u8], width: usize, at: usize) -> f64 {
        let read = &bytes[at * width..(at + 1) * width];
        match width {
            4 => f64::from(f32::from_le_bytes(read.try_into().unwrap_or_default())),
            _ => f64::from_le_bytes(read.try_into().unwrap_or_default()),
        }
    }
}

#[cfg(target_endian = "big")]
compile_error!("snapshots and recordings are little-endian; nothing here swaps bytes");
