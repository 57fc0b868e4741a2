//! Substeps per island: hard piles get more, quiet ones fewer.
//!
//! A contact that carries N sags by s ≈ N/(m_eff·ω²), ω = 2π·hz with hz·h the stiffness: of n substeps in a
//! step of dt, by (N/m_eff)·dt²/(n²·(2π·hz·h)²). With a bound on the sag each island has the n its hardest contact asks for.
//!
//! * Every [`LOOK_STEPS`] steps loads are read from the impulses, and at once where contacts come or go islands are
//!   joined anew: what touches has one pace, the highest of its parts.
//! * Numbers of substeps are [`RUNGS`]. An island climbs a rung where two looks in a row see a load that asks for it
//!   (an impact asks for nothing), and comes down one where two see less, with a quarter to spare. One rung a look:
//!   made stiff at once, a column of twelve that had sunk under 2 substeps leapt up with 0.7 m/s under 12.
//! * Bodies that touch nothing keep the number of the settings, and its bits. Joints carry no load here: an island
//!   with joints has at least the number of the settings, and all such islands have one number.
//! * Impulses belong to a substep: where it changes they are scaled.
//!
//! Paces run one after another; in each, lanes of bodies with another pace keep their rows. Static and kinematic
//! bodies take part in all.

use std::ops::Range;

use super::constraint::Constraint;
use super::stream::{Ends, Visit};
use crate::body::Bodies;
use crate::column::{Column, PAD};
use crate::contact::Manifolds;
use crate::island::root;
use crate::lanes::{Lanes, Real};
use crate::scene::BodyKind;

/// Numbers of substeps an island may have.
pub const RUNGS: [u32; 11] = [2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64];
/// Steps from one look at the loads to the next.
pub const LOOK_STEPS: u32 = 8;
/// What a lower rung must have to spare.
const SPARE: f64 = 1.25;

/// What islands are paced by.
#[derive(Clone, Copy, Debug)]
pub struct Goal {
    /// The most a contact may sag, metres.
    pub max_sag: f64,
    /// Substeps of bodies that touch nothing.
    pub base: u32,
    /// Seconds per step.
    pub dt_secs: f64,
    /// Of contacts, hz·h.
    pub stiffness: f64,
}

impl Goal {
    /// Substeps with which what is loaded by `load` (N/m_eff·dt, m/s) sags by the bound.
    fn needed(&self, load: f64) -> f64 {
        let omega_h = 2.0 * std::f64::consts::PI * self.stiffness;
        (load * self.dt_secs / (omega_h * omega_h * self.max_sag)).sqrt()
    }
}

/// The next higher rung.
fn above(substeps: u32) -> u32 {
    RUNGS.into_iter().find(|&n| n > substeps).unwrap_or(substeps)
}

/// The next lower rung.
fn below(substeps: u32) -> u32 {
    RUNGS.into_iter().rev().find(|&n| n < substeps).unwrap_or(RUNGS[0])
}

/// Who has which number of substeps; memory is kept from step to step.
#[derive(Clone, Debug)]
pub struct Paces<R: Real> {
    /// In use, ascending.
    substeps: Vec<u32>,
    /// The slots each goes over, as [`crate::integrate::Motion::runs`].
    runs: Vec<Vec<Range<usize>>>,
    /// Substeps per slot; not empty only where islands are paced.
    of_slot: Vec<u32>,
    before: Vec<u32>,
    /// Which of `substeps` a slot has.
    index: Column<R>,
    /// N/m_eff·dt per slot, of this look and the last, m/s.
    load: [Vec<f64>; 2],
    parent: Vec<u32>,
    /// Per root.
    islands: Vec<Island>,
    /// Substeps of all islands with joints.
    joined: Option<u32>,
    steps: u32,
}

/// What an island is known to be.
#[derive(Clone, Copy, Debug, Default)]
struct Island {
    /// N/m_eff·dt of its hardest contact, m/s: what both of the last looks saw, and what one of them did.
    load: [f64; 2],
    /// The most a part of it has had.
    substeps: u32,
    /// Something touches or is joined.
    touches: bool,
    /// Something is joined.
    joined: bool,
}

impl<R: Real> Default for Paces<R> {
    fn default() -> Self {
        Self {
            substeps: vec![0],
            runs: Vec::new(),
            of_slot: Vec::new(),
            before: Vec::new(),
            index: Column::new(R::ZERO),
            load: Default::default(),
            parent: Vec::new(),
            islands: Vec::new(),
            joined: None,
            steps: 0,
        }
    }
}

impl<R: Real> Paces<R> {
    /// Paces in use: 1 where islands are not paced.
    pub fn count(&self) -> usize {
        self.substeps.len()
    }
    /// Substeps of a pace, where islands are paced.
    pub fn substeps(&self, pace: usize) -> Option<u32> {
        self.substeps.get(pace).copied().filter(|&n| n > 0)
    }
    /// The least and the most substeps in use, where islands are paced.
    pub fn span(&self) -> Option<[u32; 2]> {
        Some([self.substeps(0)?, self.substeps(self.count() - 1)?])
    }
    /// The slots a pace goes over.
    pub fn runs_mut(&mut self, pace: usize) -> &mut Vec<Range<usize>> {
        &mut self.runs[pace]
    }
    /// Which pace each slot has.
    pub fn index(&self) -> &Column<R> {
        &self.index
    }
    /// The pace of a pair that touches. What nothing moves has the first.
    pub fn of_pair(&self, slots: [u32; 2]) -> usize {
        if self.count() == 1 {
            return 0;
        }
        let [a, b] = slots.map(|slot| self.index[slot as usize].to_f64() as usize);
        a.max(b)
    }

    /// Substeps of all islands with joints, where islands are paced.
    pub fn of_joints(&self) -> Option<u32> {
        self.joined
    }

    /// Is it time to read the loads?
    pub fn looks(&self) -> bool {
        self.steps.is_multiple_of(LOOK_STEPS)
    }

    /// A visitor that reads the loads.
    pub fn reading(&mut self) -> Loads<'_> {
        self.load.swap(0, 1);
        self.load[0].clear();
        self.load[0].resize(self.of_slot.len(), 0.0);
        Loads { load: &mut self.load[0], substeps: &self.of_slot }
    }

    /// Decides who has which pace; says whether that has changed for anyone. `joints`: the slots they join.
    pub fn decide(
        &mut self,
        goal: &Goal,
        bodies: &Bodies<R>,
        manifolds: &Manifolds<R>,
        joints: impl Iterator<Item = [u32; 2]>,
        runs: &[Range<usize>],
    ) -> bool {
        // Before the first step nothing is known of loads.
        let looked = self.looks() && self.steps > 0;
        self.steps = self.steps.wrapping_add(1);
        let fresh = self.of_slot.len() != bodies.len();
        self.of_slot.resize(bodies.len(), goal.base);
        self.before.clone_from(&self.of_slot);
        for load in &mut self.load {
            load.resize(bodies.len(), 0.0);
        }
        self.join(bodies, manifolds, joints, runs);
        let joined = self.common_of_joined(goal, looked);
        self.joined = Some(joined);
        for slot in runs.iter().cloned().flatten().filter(|&slot| bodies.kind(slot) == BodyKind::Dynamic) {
            let at = root(&mut self.parent, slot as u32) as usize;
            self.of_slot[slot] = match self.islands[at] {
                Island { joined: true, .. } => joined,
                Island { touches: false, .. } => goal.base,
                island if looked => aimed(goal, &island),
                island => island.substeps,
            };
        }
        let changed = fresh || self.of_slot != self.before;
        if changed {
            self.sort(goal, bodies, runs);
        }
        changed
    }

    /// The number all islands with joints have.
    fn common_of_joined(&self, goal: &Goal, looked: bool) -> u32 {
        let of = |island: &Island| if looked { aimed(goal, island) } else { island.substeps };
        let joined = self.islands.iter().filter(|island| island.joined);
        joined.map(of).max().unwrap_or(goal.base).max(goal.base)
    }

    /// Islands, what they carry and what they have had.
    fn join(
        &mut self,
        bodies: &Bodies<R>,
        manifolds: &Manifolds<R>,
        joints: impl Iterator<Item = [u32; 2]>,
        runs: &[Range<usize>],
    ) {
        self.parent.resize(bodies.len(), 0);
        self.islands.clear();
        self.islands.resize(bodies.len(), Island::default());
        for slot in runs.iter().cloned().flatten() {
            self.parent[slot] = slot as u32;
        }
        let is_dynamic = |slot: u32| bodies.kind(slot as usize) == BodyKind::Dynamic;
        let touching = manifolds.touching().iter().map(|&place| manifolds.slots(place as usize));
        for (ends, joined) in touching.map(|ends| (ends, false)).chain(joints.map(|ends| (ends, true))) {
            let [a, b] = ends;
            if ends.into_iter().all(is_dynamic) {
                let (a, b) = (root(&mut self.parent, a), root(&mut self.parent, b));
                self.parent[a.max(b) as usize] = a.min(b);
            }
            // Noted on bodies for now: their roots are known when all are joined.
            for end in ends {
                self.islands[end as usize].touches = true;
                self.islands[end as usize].joined |= joined;
            }
        }
        for slot in runs.iter().cloned().flatten().filter(|&slot| is_dynamic(slot as u32)) {
            let own = self.islands[slot];
            let at = root(&mut self.parent, slot as u32) as usize;
            let island = &mut self.islands[at];
            let [now, last] = self.load.each_ref().map(|load| load[slot]);
            island.load = [island.load[0].max(now.min(last)), island.load[1].max(now.max(last))];
            island.substeps = island.substeps.max(self.of_slot[slot]);
            island.touches |= own.touches;
            island.joined |= own.joined;
        }
    }

    /// The paces in use and where their bodies are.
    fn sort(&mut self, goal: &Goal, bodies: &Bodies<R>, runs: &[Range<usize>]) {
        self.substeps.clear();
        let slots = || runs.iter().cloned().flatten();
        for slot in slots().filter(|&slot| bodies.kind(slot) == BodyKind::Dynamic) {
            if !self.substeps.contains(&self.of_slot[slot]) {
                self.substeps.push(self.of_slot[slot]);
            }
        }
        if self.substeps.is_empty() {
            self.substeps.push(goal.base);
        }
        self.substeps.sort_unstable();
        self.index.resize(bodies.len());
        for slot in slots() {
            let dynamic = bodies.kind(slot) == BodyKind::Dynamic;
            let at = self.substeps.iter().position(|&n| dynamic && n == self.of_slot[slot]);
            self.index[slot] = R::from_f64(at.unwrap_or(0) as f64);
        }
        self.runs.resize(self.substeps.len(), Vec::new());
        for (runs_of, &substeps) in self.runs.iter_mut().zip(&self.substeps) {
            runs_of.clear();
            for start in runs.iter().flat_map(|run| run.clone().step_by(PAD)) {
                let end = (start + PAD).min(bodies.len());
                let takes_part =
                    |slot| bodies.kind(slot) != BodyKind::Dynamic || self.of_slot[slot] == substeps;
                if (start..end).any(takes_part) {
                    match runs_of.last_mut().filter(|last: &&mut Range<usize>| last.end == start) {
                        Some(last) => last.end = end,
                        None => runs_of.push(start..end),
                    }
                }
            }
        }
    }

    /// Scales the impulses of pairs whose substeps have changed.
    pub fn scale_impulses(&self, bodies: &Bodies<R>, manifolds: &mut Manifolds<R>) {
        for k in 0..manifolds.len() {
            let at = manifolds.touching()[k] as usize;
            let moves = |slot: &u32| bodies.kind(*slot as usize) == BodyKind::Dynamic;
            let Some(slot) = manifolds.slots(at).into_iter().find(moves) else { continue };
            let (before, now) = (self.before[slot as usize], self.of_slot[slot as usize]);
            if before != now {
                let scale = R::from_f64(f64::from(before) / f64::from(now));
                for impulse in &mut manifolds.impulses_mut()[at][..3] {
                    *impulse = *impulse * scale;
                }
            }
        }
    }
}

/// What an island should have after a look.
fn aimed(goal: &Goal, island: &Island) -> u32 {
    let [both, either] = island.load.map(|load| goal.needed(load));
    let lower = below(island.substeps);
    if both > f64::from(island.substeps) {
        above(island.substeps)
    } else if either * SPARE <= f64::from(lower) {
        lower
    } else {
        island.substeps
    }
}

/// Reads what contacts carry.
#[derive(Debug)]
pub struct Loads<'a> {
    load: &'a mut [f64],
    substeps: &'a [u32],
}

impl<L: Lanes> Visit<L> for Loads<'_> {
    fn visit<const POINTS: usize>(&mut self, c: &mut Constraint<L, POINTS>, ends: Ends<'_>, _: usize) {
        let held = c.points.iter().fold(L::zero(), |most, point| most.max(point.held)).to_array();
        for (lane, held) in held.iter().enumerate().take(L::WIDTH) {
            for slot in [ends.a[lane], ends.b[lane]].map(|slot| slot as usize) {
                // Bodies come and go between a step and the next.
                if let (Some(load), Some(&substeps)) = (self.load.get_mut(slot), self.substeps.get(slot)) {
                    *load = load.max(held.to_f64() * f64::from(substeps));
                }
            }
        }
    }
}
