//! What is worked out of a snapshot beside the step: its hash, energy, momentum and overlaps.

use super::layout::{STATISTICS, StepRow};
use crate::contact::CONTACT_COLUMNS;
use crate::force::Forces;
use crate::measure::{Invariants, Stage, StageTimes, hash_of};
use crate::world::{BodyTable, COLUMNS, Snapshot};

/// Where a contact's columns hold separations.
const SEPARATION: usize = 6;

/// Masses by slot, and what the step before had come to.
#[derive(Debug, Default)]
pub(super) struct Sums {
    /// Per slot less one: mass and inertia of dynamic bodies, kg and kg·m².
    matter: Vec<Option<[f64; 2]>>,
    forces: Forces,
    before: StageTimes,
    numbers: Vec<f64>,
}

impl Sums {
    /// Bodies are others from here on.
    pub(super) fn take(&mut self, table: &BodyTable) {
        self.forces = table.forces;
        self.matter.clear();
        for body in &table.bodies {
            self.matter.resize(body.slot as usize, None);
            self.matter[body.slot as usize - 1] = (body.mass > 0.0).then_some([body.mass, body.inertia]);
        }
    }

    /// A step's numbers; overlaps only where contacts were taken down.
    pub(super) fn row(&mut self, snapshot: &Snapshot, time_secs: f64, contacts: bool) -> StepRow {
        let (slots, counts) = (snapshot.slots, &snapshot.counts);
        self.numbers.clear();
        let all = 0..COLUMNS.len() * slots;
        self.numbers.extend(all.map(|at| Snapshot::number(&snapshot.columns, snapshot.width, at)));
        let hash = hash_of(COLUMNS.iter().enumerate().flat_map(|(column, _)| {
            let numbers = &self.numbers[column * slots..(column + 1) * slots];
            numbers
                .iter()
                .zip(&snapshot.flags)
                .filter(|(_, flags)| **flags & 1 != 0)
                .map(|(number, _)| *number)
        }));
        let stage = |stage: Stage| {
            let (now, before) = (snapshot.times.total(stage), self.before.total(stage));
            now.saturating_sub(before).as_nanos() as f64
        };
        let [broad, narrow, prepare, integrate, solve, measure] = Stage::ALL.map(stage);
        self.before = snapshot.times;
        let sum = self.invariants(slots);
        let [most, mean] = if contacts { overlaps(snapshot) } else { [f64::NAN; 2] };
        let values: [f64; STATISTICS.len()] = [
            time_secs,
            broad,
            narrow,
            prepare,
            integrate,
            solve,
            measure,
            counts.candidates as f64,
            counts.pairs as f64,
            counts.contacts as f64,
            counts.sleeping as f64,
            counts.islands as f64,
            f64::from(counts.substeps[0]),
            f64::from(counts.substeps[1]),
            sum.kinetic_energy,
            sum.potential_energy,
            sum.momentum[0],
            sum.momentum[1],
            sum.angular_momentum,
            most,
            mean,
            counts.direct_joints as f64,
            counts.direct_contacts as f64,
            counts.stiff as f64,
        ];
        StepRow { step: snapshot.step, hash, values }
    }

    /// As [`crate::measure::invariants`], of the numbers taken down.
    fn invariants(&self, slots: usize) -> Invariants {
        let mut sum = Invariants::default();
        let bodies = self.matter.iter().enumerate().filter_map(|(at, m)| Some((at, (*m)?)));
        let number = |column: usize, at: usize| self.numbers[column * slots + at];
        let placed = |(at, [mass, _]): (usize, [f64; 2])| (mass, [number(0, at), number(1, at)]);
        sum.add_attraction(&self.forces, &bodies.clone().map(placed));
        for (at, matter) in bodies {
            let read = |column: usize| number(column, at);
            sum.add(matter, [read(0), read(1)], [read(4), read(5)], read(6), &self.forces);
        }
        sum
    }
}

/// The largest overlap of a contact point, and the mean of those that overlap, metres.
fn overlaps(snapshot: &Snapshot) -> [f64; 2] {
    let (mut most, mut sum, mut count) = (0.0f64, 0.0, 0u32);
    for at in 0..snapshot.pairs.len() {
        for point in 0..2 {
            let entry = at * CONTACT_COLUMNS.len() + SEPARATION + point;
            let overlap = -Snapshot::number(&snapshot.contacts, snapshot.contact_width, entry);
            if overlap > 0.0 {
                most = most.max(overlap);
                sum += overlap;
                count += 1;
            }
        }
    }
    [most, sum / f64::from(count.max(1))]
}
