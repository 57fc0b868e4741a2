//! Points of contacts as rows of a direct solve: read from the lanes, and written back.

use super::Contact;
use crate::each::Each as _;
use crate::lanes::{Lanes, Real, set_lanes};
use crate::partition::Sets;
use crate::solve::batches::{Ends, Visit};
use crate::solve::constraint::Constraint;

/// An impulse acts on B (1) along the normal, on A (0) against it.
pub(super) fn sign(end: usize) -> f64 {
    if end == 0 { -1.0 } else { 1.0 }
}

/// A point of a contact of a hard component.
#[derive(Clone, Copy, Debug)]
pub(super) struct Row {
    /// The lowest slot of its component.
    pub component: u32,
    pub slots: [u32; 2],
    /// From A to B.
    pub normal: [f64; 2],
    pub levers: [f64; 2],
    pub inv_inertia: [f64; 2],
    /// Effective mass, kg.
    pub mass: f64,
    /// Impulse, in the units of the pass.
    pub impulse: f64,
    /// What its velocity is to be at least, m/s.
    pub least: f64,
    /// It is pushed out of overlap.
    pub pushed: bool,
}

/// Which pass: what rows are asked for.
#[derive(Clone, Copy, Debug)]
pub(in crate::solve) enum Pass<'a> {
    /// Before bodies move.
    Push(&'a Bias),
    /// After, without bias; 1/h.
    Relax(f64),
}

/// How rows are biased before bodies move.
#[derive(Clone, Copy, Debug)]
pub(in crate::solve) struct Bias {
    /// 1/h.
    pub per_sec: f64,
    /// Bias velocity per metre of overlap, 1/s.
    pub rate: f64,
    /// Fastest push over the pair's length, 1/s, negated.
    pub push_cap: f64,
    /// Points with a smaller separation over the pair's length only stop closing.
    pub deep: f64,
    /// What an impulse changes moving velocities by, over what it changes velocities by.
    pub share: f64,
}

impl Row {
    /// The velocity of B's point seen from A's along the normal, m/s.
    pub(super) fn speed<R: Real>(&self, velocities: &[[R; 4]]) -> f64 {
        let of = |end: usize| {
            let [x, y, spin, _] = velocities[self.slots[end] as usize].each(Real::to_f64);
            sign(end) * (x * self.normal[0] + y * self.normal[1] + spin * self.levers[end])
        };
        of(0) + of(1)
    }

    /// What a unit impulse of another row changes this one's velocity by, 1/kg.
    pub(super) fn response<R: Real>(&self, other: &Self, velocities: &[[R; 4]]) -> f64 {
        let along = self.normal[0] * other.normal[0] + self.normal[1] * other.normal[1];
        let mut sum = 0.0;
        for (end, &slot) in self.slots.iter().enumerate() {
            for (there, &theirs) in other.slots.iter().enumerate() {
                if slot == theirs {
                    let turning = self.inv_inertia[end] * self.levers[end] * other.levers[there];
                    let inv_mass = velocities[slot as usize][3].to_f64();
                    sum += sign(end) * sign(there) * (inv_mass * along + turning);
                }
            }
        }
        sum
    }
}

fn number<L: Lanes>(value: L, lane: usize) -> f64 {
    value.to_array()[lane].to_f64()
}

/// Notes all contacts.
pub(super) struct All<'a> {
    pub first: usize,
    pub contacts: &'a mut Vec<Contact>,
}

impl<L: Lanes> Visit<L> for All<'_> {
    fn visit<const POINTS: usize>(&mut self, c: &mut Constraint<L, POINTS>, ends: Ends<'_>, at: usize) {
        let masses = c.points.each(|point| point.mass.to_array());
        for lane in 0..L::WIDTH {
            let points = masses.iter().filter(|mass| mass[lane] > L::Elem::ZERO).count() as u32;
            if points > 0 {
                let slots = [ends.a[lane], ends.b[lane]].each(|slot| slot + self.first as u32);
                let at = [POINTS as u32, at as u32, lane as u32];
                let exist = c.points.iter().filter(|point| number(point.mass, lane) > 0.0);
                let gap = exist.map(|point| number(point.separation, lane)).fold(0.0, f64::min);
                self.contacts.push(Contact { slots, at, points, gap });
            }
        }
    }
}

/// Notes the points of chosen contacts.
pub(super) struct Read<'a, R> {
    pub points: &'a mut Vec<Row>,
    pub sets: &'a Sets,
    pub picked: &'a [Vec<u32>; 2],
    /// The slot that contacts' slots count from, and rows are from.
    pub first: usize,
    pub velocities: &'a [[R; 4]],
    pub pass: Pass<'a>,
    pub share: f64,
}

impl<L: Lanes> Visit<L> for Read<'_, L::Elem> {
    fn visit<const POINTS: usize>(&mut self, c: &mut Constraint<L, POINTS>, ends: Ends<'_>, at: usize) {
        for lane in set_lanes(self.picked[POINTS - 1][at]) {
            let own = [ends.a[lane], ends.b[lane]];
            let moves = |slot: &u32| self.velocities[*slot as usize][3] > L::Elem::ZERO;
            let slots = own.each(|slot| slot + self.first as u32);
            let end = if moves(&own[0]) { slots[0] } else { slots[1] };
            let component = self.sets.seen(end);
            for point in &c.points {
                let [mass, separation] = [point.mass, point.separation].each(|value| number(value, lane));
                // Of a contact with one point the second does not exist.
                if mass <= 0.0 {
                    continue;
                }
                let stopped = number(point.velocity_impulse, lane);
                self.points.push(Row {
                    component,
                    slots,
                    normal: [c.normal.x, c.normal.y].each(|value| number(value, lane)),
                    levers: point.levers.each(|value| number(value, lane)),
                    inv_inertia: c.inv_inertia.each(|value| number(value, lane)),
                    mass,
                    impulse: stopped * mass * self.share,
                    least: self.pass.least(separation, stopped, number(c.length, lane)),
                    pushed: matches!(self.pass, Pass::Push(_)) && separation <= 0.0,
                });
            }
        }
    }
}

impl Pass<'_> {
    /// What the velocity of a point is to be at least, m/s.
    fn least(&self, separation: f64, stopped: f64, length: f64) -> f64 {
        match self {
            Pass::Push(bias) if separation > 0.0 => -separation * bias.per_sec,
            Pass::Push(bias) if separation < bias.deep * length => 0.0,
            Pass::Push(bias) => -(separation * bias.rate).max(bias.push_cap * length),
            // A point that carried nothing may go on closing its gap.
            Pass::Relax(per_sec) if stopped <= 0.0 => -separation.max(0.0) * per_sec,
            Pass::Relax(_) => 0.0,
        }
    }
}

/// Hands impulses back to the contacts, in the order in which they were read.
pub(super) struct Write<'a> {
    pub points: &'a [Row],
    pub next: &'a mut usize,
    pub picked: &'a [Vec<u32>; 2],
    pub share: f64,
}

impl<L: Lanes> Visit<L> for Write<'_> {
    fn visit<const POINTS: usize>(&mut self, c: &mut Constraint<L, POINTS>, _: Ends<'_>, at: usize) {
        for lane in set_lanes(self.picked[POINTS - 1][at]) {
            for point in c.points.iter_mut().filter(|point| number(point.mass, lane) > 0.0) {
                let row = &self.points[*self.next];
                *self.next += 1;
                let mut stopped = point.velocity_impulse.to_array();
                stopped[lane] = L::Elem::from_f64(row.impulse / (row.mass * self.share));
                point.velocity_impulse = L::load(&stopped);
            }
        }
    }
}
