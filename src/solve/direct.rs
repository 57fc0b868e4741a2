//! A direct solve for contacts between bodies whose masses are far apart.
//!
//! Contact by contact, what is heavy gives a light body beneath it nearly its own speed, the ground stops that, and the heavy
//! one has lost a share m/M of what it is to lose: ten tonnes that fall on a kilogram take 10⁴ visits, and have long gone through it
//! by then. So contacts of bodies that hang together by such a pair ([`HARD_RATIO`]) are solved at once, after
//! the pass over all contacts, in `f64`: λ ≥ 0, w = K·λ + q ≥ 0, λ·w = 0, with K = J·M⁻¹·Jᵀ of all their points and q what
//! their velocities, with bias before bodies move, would be without λ ([`complementarity`]).
//! They are rigid: the stiffness of a soft contact is said for the lighter body's mass, and a load of 10⁴ times that would sink in by
//! metres. What overlaps is pushed out as elsewhere, by rows that yield a little ([`COMPLIANCE`], of the heaviest body's
//! response): where pushes contradict each other, as in a stack pressed into itself, rigid ones would have no limit.
//!
//! What is deep in something else ([`DEEP`]), as a stack that was pressed into itself, is left to visits: its normals point every way,
//! and friction, which is not solved with them, threw what lay there at 80 m/s.
//!
//! Which they are is found anew in each step, where masses in the scene are far enough apart; elsewhere this costs one
//! comparison. Components of more than [`MOST_ROWS`] points are left to visits and substeps: work grows with the cube.
//! Normals only: friction is solved contact by contact, within the cones of what is found here.

mod complementarity;
mod row;

use super::stream::Stream;
use crate::body::{Bodies, BodyKind};
use crate::each::Each as _;
use crate::lanes::{Lanes, Real};
use crate::partition::Sets;
use complementarity::Complementarity;
use row::{All, Read, Row, Write, sign};

pub(super) use row::{Bias, Pass};

/// Masses so far apart are too far for visits, as of joints.
pub(crate) const HARD_RATIO: f64 = 64.0;
/// What points that are pushed out of overlap yield, as a share of what the component's heaviest body does: a load M sinks in by
/// this share of g·h over the bias rate, 0.2 mm at 4 substeps.
const COMPLIANCE: f64 = 0.1;
/// Deeper than this share of the smaller body's core ([`Bodies::core`]) is deep.
const DEEP: f64 = 0.2;
/// Points of a component that are solved at once.
const MOST_ROWS: usize = 96;

/// A contact that may belong to a hard component.
#[derive(Clone, Copy, Debug)]
struct Contact {
    slots: [u32; 2],
    /// Points in its batch (1 or 2), batch, lane.
    at: [u32; 3],
    points: u32,
    /// Its least gap, metres.
    gap: f64,
}

/// Contacts that hang together by dynamic bodies.
#[derive(Clone, Copy, Debug, Default)]
struct Component {
    points: usize,
    hard: bool,
    deep: bool,
}

impl Component {
    fn is_solved(self) -> bool {
        self.hard && !self.deep && self.points <= MOST_ROWS
    }
}

/// Contacts that are solved at once; memory is kept.
#[derive(Clone, Debug, Default)]
pub(super) struct DirectContacts {
    /// The bodies' revision that `spread` is of.
    looked_at: Option<u64>,
    /// Masses in the scene are far enough apart.
    spread: bool,
    contacts: Vec<Contact>,
    sets: Sets,
    /// Per slot: contacts it has.
    touches: Vec<u32>,
    /// Per lowest slot.
    components: Vec<Component>,
    /// Lanes that are solved directly, of batches of one and two points.
    picked: [Vec<u32>; 2],
    rows: Vec<Row>,
    /// Rows, component by component.
    order: Vec<u32>,
    /// Changes of velocities per slot.
    changes: Vec<[f64; 3]>,
    system: Complementarity,
    count: usize,
}

impl DirectContacts {
    /// Contacts that are solved directly in this step.
    pub(super) fn len(&self) -> usize {
        self.count
    }

    /// Were a body's contacts solved directly in the last step?
    pub(super) fn holds(&self, slot: u32) -> bool {
        let known = self.count > 0 && (slot as usize) < self.components.len();
        known && self.components[self.sets.seen(slot) as usize].is_solved()
    }

    /// Bodies have come, gone or changed.
    pub(super) fn forget(&mut self) {
        self.looked_at = None;
    }

    /// None in this step.
    pub(super) fn clear(&mut self) {
        self.count = 0;
    }

    /// Are masses in the scene far enough apart?
    pub(super) fn may_have_any<R: Real>(&mut self, bodies: &Bodies<R>) -> bool {
        if self.looked_at != Some(bodies.revision()) {
            self.looked_at = Some(bodies.revision());
            let inv_masses = movable(bodies).map(|slot| bodies.inv_mass[slot].to_f64());
            let span = inv_masses.fold([f64::INFINITY, 0.0f64], |[low, high], m| [low.min(m), high.max(m)]);
            self.spread = span[1] >= HARD_RATIO * span[0];
        }
        self.spread
    }

    /// As a step begins: finds the contacts that masses make hard.
    pub(super) fn choose<L: Lanes>(&mut self, stream: &mut Stream<L>, bodies: &Bodies<L::Elem>) {
        self.count = 0;
        if !self.may_have_any(bodies) || stream.batches() == [0; 2] {
            return;
        }
        self.contacts.clear();
        stream.each(|first, contacts| contacts.visit(&mut All { first, contacts: &mut self.contacts }));
        let moves = |slot: u32| bodies.kind(slot as usize) == BodyKind::Dynamic;
        let is_hard =
            |contact: &Contact| contact.slots.into_iter().all(moves) && is_hard(bodies, contact.slots);
        if !self.contacts.iter().any(is_hard) {
            return;
        }
        self.find_components(bodies);
        for (picked, batches) in self.picked.iter_mut().rev().zip(stream.batches()) {
            picked.clear();
            picked.resize(batches, 0);
        }
        for contact in &self.contacts {
            let [points, batch, lane] = contact.at;
            if self.component_of(contact.slots, bodies).is_some() {
                self.picked[points as usize - 1][batch as usize] |= 1 << lane;
                self.count += 1;
            }
        }
    }

    /// Which contacts hang together, and which of that is hard.
    fn find_components<R: Real>(&mut self, bodies: &Bodies<R>) {
        let Self { contacts, sets, touches, components, .. } = self;
        sets.part(bodies.len(), std::slice::from_ref(&(0..bodies.len())));
        touches.clear();
        touches.resize(bodies.len(), 0);
        components.clear();
        components.resize(bodies.len(), Component::default());
        let moves = |slot: u32| bodies.kind(slot as usize) == BodyKind::Dynamic;
        for contact in &*contacts {
            if contact.slots.into_iter().all(moves) {
                sets.join(contact.slots);
            }
            contact.slots.into_iter().for_each(|slot| touches[slot as usize] += 1);
        }
        for contact in &*contacts {
            let Some(end) = contact.slots.into_iter().find(|&slot| moves(slot)) else { continue };
            let component = &mut components[sets.of(end) as usize];
            component.points += contact.points as usize;
            let movable = contact.slots.into_iter().filter(|&slot| moves(slot));
            let core = movable.map(|slot| bodies.core[slot as usize].to_f64()).fold(f64::MAX, f64::min);
            component.deep |= contact.gap < -DEEP * core;
            if contact.slots.into_iter().all(moves) {
                let [a, b] = contact.slots.each(|slot| bodies.inv_mass[slot as usize]);
                let light = contact.slots[usize::from(b > a)] as usize;
                component.hard |= is_hard(bodies, contact.slots) && touches[light] > 1;
            }
        }
    }

    /// The component of a contact, where that is solved directly.
    fn component_of<R: Real>(&self, slots: [u32; 2], bodies: &Bodies<R>) -> Option<u32> {
        let end = slots.into_iter().find(|&slot| bodies.kind(slot as usize) == BodyKind::Dynamic)?;
        let component = self.sets.seen(end);
        self.components[component as usize].is_solved().then_some(component)
    }

    /// Solves the contacts chosen, as they are after the pass over all; `rows`: velocities, in the units of the pass.
    pub(super) fn solve<L: Lanes>(
        &mut self,
        stream: &mut Stream<L>,
        rows: &mut [[L::Elem; 4]],
        pass: Pass<'_>,
    ) {
        if self.count == 0 {
            return;
        }
        let share = if let Pass::Push(bias) = pass { bias.share } else { 1.0 };
        self.rows.clear();
        let Self { rows: points, sets, picked, changes, .. } = self;
        stream.each(|first, contacts| {
            let velocities = &rows[first..];
            contacts.visit(&mut Read { points, sets, picked, first, velocities, pass, share });
        });
        changes.resize(rows.len(), [0.0; 3]);
        self.sort_rows();
        let component = |row: &u32, rows: &[Row]| rows[*row as usize].component;
        let mut first = 0;
        while first < self.order.len() {
            let which = component(&self.order[first], &self.rows);
            let rest = &self.order[first..];
            let count = rest.iter().take_while(|&row| component(row, &self.rows) == which).count();
            self.solve_component(first..first + count, rows);
            first += count;
        }
        let mut next = 0;
        stream.each(|_, contacts| {
            contacts.visit(&mut Write { points: &self.rows, next: &mut next, picked: &self.picked, share });
        });
        for slot in self.rows.iter().flat_map(|row| row.slots) {
            let change = std::mem::take(&mut self.changes[slot as usize]);
            for (value, change) in rows[slot as usize].iter_mut().zip(change) {
                *value = L::Elem::from_f64(value.to_f64() + change);
            }
        }
    }

    /// By component and pair: the order of lanes is that in which contacts came.
    fn sort_rows(&mut self) {
        let Self { rows, order, .. } = self;
        order.clear();
        order.extend(0..rows.len() as u32);
        order.sort_unstable_by_key(|&row| (rows[row as usize].component, rows[row as usize].slots, row));
    }

    /// The rows of one component.
    fn solve_component<R: Real>(&mut self, range: std::ops::Range<usize>, velocities: &[[R; 4]]) {
        let Self { rows, order, changes, system, .. } = self;
        let picked = &order[range];
        let ends = picked.iter().flat_map(|&at| rows[at as usize].slots);
        let inv_masses = ends.map(|slot| velocities[slot as usize][3].to_f64()).filter(|&m| m > 0.0);
        let compliance = COMPLIANCE * inv_masses.fold(f64::MAX, f64::min);
        system.begin(picked.len());
        for (i, &at) in picked.iter().enumerate() {
            let row = &rows[at as usize];
            for (j, &other) in picked.iter().enumerate().take(i + 1) {
                system.set(i, j, row.response(&rows[other as usize], velocities));
            }
            let yields = if row.pushed { compliance } else { 0.0 };
            system.want(i, row.speed(velocities) - row.least, row.impulse, yields);
        }
        if !system.solve() {
            return;
        }
        for (i, &at) in picked.iter().enumerate() {
            let row = &mut rows[at as usize];
            let given = system.answer(i) - row.impulse;
            row.impulse = system.answer(i);
            for end in 0..2 {
                let slot = row.slots[end] as usize;
                let [impulse, inv_mass] = [sign(end) * given, velocities[slot][3].to_f64()];
                let change = &mut changes[slot];
                change[0] += impulse * inv_mass * row.normal[0];
                change[1] += impulse * inv_mass * row.normal[1];
                change[2] += impulse * row.inv_inertia[end] * row.levers[end];
            }
        }
    }
}

/// Are two masses too far apart for visits?
fn is_hard<R: Real>(bodies: &Bodies<R>, slots: [u32; 2]) -> bool {
    let [a, b] = slots.each(|slot| bodies.inv_mass[slot as usize].to_f64());
    a.max(b) >= HARD_RATIO * a.min(b)
}

fn movable<R: Real>(bodies: &Bodies<R>) -> impl Iterator<Item = usize> {
    bodies.slots().filter(|&slot| bodies.kind(slot) == BodyKind::Dynamic)
}
