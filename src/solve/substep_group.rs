//! Substeps per island: hard piles get more, quiet ones fewer.
//!
//! Unless substeps are fixed, an island in which a slender stack would buckle gets those that [`slender_stack`](super::slender_stack)
//! asks for, or what presses hard would sink in: always on, as it costs a look every [`TOWER_STEPS`] steps until there is
//! one. A bound on the sag is asked for by the settings.
//!
//! A contact that carries N sags by s ≈ N/(m_eff·ω²), ω = 2π·hz with hz·h the stiffness: of n substeps in a
//! step of dt, by (N/m_eff)·dt²/(n²·(2π·hz·h)²). With a bound on the sag each island has the n its hardest contact asks for.
//!
//! * Every [`LOOK_STEPS`] steps loads are read from the impulses, and at once where contacts come or go islands are
//!   joined anew: what touches has one substep group, the highest of its parts.
//! * Numbers of substeps are `RUNGS`. An island climbs a rung where two looks in a row see a load that asks for it
//!   (an impact asks for nothing), and comes down one where two see less, with a quarter to spare. One rung a look:
//!   made stiff at once, a column of twelve that had sunk under 2 substeps leapt up with 0.7 m/s under 12. Slender
//!   stacks are judged by their weight: as bodies come they have all they need at once, before they have sagged.
//! * Bodies that touch nothing keep the number of the settings, and its bits. Joints carry no load here: an island
//!   with joints has at least the number of the settings, and all such islands have one number. Only what hangs on rods
//!   that are solved directly asks for more: their pulls T swing a body across them with ω² = Σ T/(m·L), which
//!   substeps must follow, ωh ≤ [`FOLLOWED`] (2 is where a string of beads blows up, at Σ/2). It gets them at once: joints do not sag.
//! * Impulses belong to a substep: where it changes they are scaled.
//!
//! Substep groups run one after another; in each, lanes of bodies with another substep group keep their rows. Static and kinematic
//! bodies take part in all.

mod goal;

use std::ops::Range;

use super::batches::{Ends, Visit};
use super::constraint::Constraint;
use super::direct::DirectContacts;
use super::slender_stack::{SlenderStacks, Touching};
use crate::body::{Bodies, BodyKind};
use crate::column::{Column, PAD};
use crate::contact::Manifolds;
use crate::each::Each as _;
use crate::force::Field;
use crate::lanes::{Lanes, Real};
use crate::motion::TOUCH;
use crate::partition::Sets;

use goal::{Island, aimed};

pub(crate) use goal::Goal;

/// Steps from one look at the loads to the next.
pub(crate) const LOOK_STEPS: u32 = 8;
/// The same where all islands have the number of the settings, and are only looked over for slender stacks.
pub(crate) const TOWER_STEPS: u32 = 32;

/// ωh of what swings on rods.
const FOLLOWED: f64 = 1.0;

/// Who has which number of substeps; memory is kept from step to step.
#[derive(Clone, Debug)]
pub struct SubstepGroups<R: Real> {
    /// In use, ascending.
    substeps: Vec<u32>,
    /// The slots each goes over, as [`crate::motion::Motion::runs`].
    runs: Vec<Vec<Range<usize>>>,
    /// Substeps per slot; not empty only where islands have their own.
    of_slot: Vec<u32>,
    before: Vec<u32>,
    /// Which of `substeps` a slot has.
    index: Column<R>,
    seen: Looked,
    /// Bodies have come since the last look: what they stand on has hardly sagged yet.
    fresh: bool,
    /// Islands, while they are looked for.
    sets: Sets,
    /// Per root.
    islands: Vec<Island>,
    /// Substeps of all islands with joints.
    joined: Option<u32>,
    steps: u32,
    /// Nothing touched in the last step, and lists of contacts are those of the one before.
    pub(super) flew: bool,
}

/// What looks have found.
#[derive(Clone, Debug, Default)]
struct Looked {
    /// N/m_eff·dt per slot, of this look and the last, m/s.
    load: [Vec<f64>; 2],
    /// Substeps it takes per slot to keep stacks from buckling, and from sinking in.
    slender_stack_needs: Vec<[f64; 2]>,
    slender_stacks: SlenderStacks,
    /// Substeps with which what hangs on rods is followed.
    swing_needs: f64,
}

impl<R: Real> Default for SubstepGroups<R> {
    fn default() -> Self {
        Self {
            substeps: vec![0],
            runs: Vec::new(),
            of_slot: Vec::new(),
            before: Vec::new(),
            index: Column::new(R::ZERO),
            seen: Looked::default(),
            fresh: true,
            sets: Sets::default(),
            islands: Vec::new(),
            joined: None,
            steps: 0,
            flew: false,
        }
    }
}

impl<R: Real> SubstepGroups<R> {
    /// SubstepGroups in use: 1 where islands are not paced.
    pub fn count(&self) -> usize {
        self.substeps.len()
    }
    /// Substeps of a substep group, where islands have their own.
    pub fn substeps(&self, substep_group: usize) -> Option<u32> {
        self.substeps.get(substep_group).copied().filter(|&n| n > 0)
    }
    /// The least and the most substeps in use, where islands have their own.
    pub fn span(&self) -> Option<[u32; 2]> {
        Some([self.substeps(0)?, self.substeps(self.count() - 1)?])
    }
    /// The slots a substep group goes over.
    pub fn runs_mut(&mut self, substep_group: usize) -> &mut Vec<Range<usize>> {
        &mut self.runs[substep_group]
    }
    /// Which substep group each slot has.
    pub fn index(&self) -> &Column<R> {
        &self.index
    }
    /// The substep group of a pair that touches. What nothing moves has the first.
    #[inline]
    pub fn of_pair(&self, slots: [u32; 2]) -> usize {
        if self.count() == 1 {
            return 0;
        }
        let [a, b] = slots.each(|slot| self.index[slot as usize].to_f64() as usize);
        a.max(b)
    }

    /// Substeps of all islands with joints, where islands have their own.
    pub fn of_joints(&self) -> Option<u32> {
        self.joined
    }

    /// Do islands have numbers of their own?
    fn is_paced(&self) -> bool {
        !self.of_slot.is_empty()
    }

    /// Is it time to read the loads?
    pub fn looks(&self, goal: &Goal) -> bool {
        let often = self.is_paced() || goal.max_sag.is_some() || self.fresh;
        let every = if often { LOOK_STEPS } else { TOWER_STEPS };
        self.steps == 1 || (self.steps > 0 && self.steps.is_multiple_of(every))
    }

    /// Bodies have come.
    pub fn freshen(&mut self) {
        self.fresh = true;
    }

    /// Notes ω, rad/s, of what swings fastest on rods.
    pub(super) fn note_swing(&mut self, goal: &Goal, swing: f64) {
        self.seen.swing_needs = swing * goal.dt_secs / FOLLOWED;
    }

    /// Are islands to be told apart in this step? `looked`: it began with a look.
    pub fn wants(&self, goal: &Goal, looked: bool) -> bool {
        let asked =
            || self.seen.slender_stack_needs.as_flattened().iter().any(|&needs| needs > f64::from(goal.base));
        let swings = self.seen.swing_needs > f64::from(goal.base);
        self.is_paced() || goal.max_sag.is_some() || (looked && asked()) || swings
    }

    /// Counts a step that began with a look, or did not.
    pub fn count_step(&mut self, looked: bool) {
        self.fresh &= !looked;
        self.steps = self.steps.wrapping_add(1);
    }

    /// A visitor that reads the loads.
    pub fn reading(&mut self) -> Loads<'_> {
        self.seen.load.swap(0, 1);
        self.seen.load[0].clear();
        self.seen.load[0].resize(self.of_slot.len(), 0.0);
        Loads { load: &mut self.seen.load[0], substeps: &self.of_slot, first: 0 }
    }

    /// A visitor that notes what touches.
    pub(super) fn touching<L: Lanes>(&mut self) -> Touching<'_, L> {
        self.seen.slender_stacks.reading(TOUCH)
    }

    /// What stacks need, by what has been noted. `joints`: the slots they join; `direct`: contacts that are solved at once.
    pub(super) fn weigh(
        &mut self,
        goal: &Goal,
        bodies: (&Bodies<R>, &[Field<R>]),
        joints: impl Iterator<Item = [u32; 2]>,
        direct: &DirectContacts,
    ) {
        self.seen.slender_stacks.look(goal, bodies, (joints, direct), &mut self.seen.slender_stack_needs);
    }

    /// Decides who has which substep group; says whether that has changed for anyone. `joints`: the slots they join; `looked`: the
    /// step began with a look.
    pub fn decide(
        &mut self,
        goal: &Goal,
        bodies: &Bodies<R>,
        manifolds: &Manifolds<R>,
        joints: impl Iterator<Item = [u32; 2]>,
        runs: &[Range<usize>],
        looked: bool,
    ) -> bool {
        let resized = self.of_slot.len() != bodies.len();
        self.of_slot.resize(bodies.len(), goal.base);
        self.before.clone_from(&self.of_slot);
        self.seen.load.iter_mut().for_each(|load| load.resize(bodies.len(), 0.0));
        self.seen.slender_stack_needs.resize(bodies.len(), [0.0; 2]);
        self.join(bodies, manifolds, joints, runs);
        let joined = self.common_of_joined(goal, looked);
        self.joined = Some(joined);
        for slot in runs.iter().cloned().flatten().filter(|&slot| bodies.kind(slot) == BodyKind::Dynamic) {
            let at = self.sets.of(slot as u32) as usize;
            self.of_slot[slot] = match self.islands[at] {
                Island { joined: true, .. } => joined,
                Island { touches: false, .. } => goal.base,
                island if looked => aimed(goal, &island, self.fresh),
                island => island.substeps,
            };
        }
        for slot in (0..bodies.len()).filter(|&slot| !bodies.is_alive(slot)) {
            self.of_slot[slot] = goal.base;
        }
        let changed = resized || self.of_slot != self.before;
        if changed {
            self.sort(goal, bodies, runs);
        } else if goal.max_sag.is_none() && self.of_slot.iter().all(|&substeps| substeps == goal.base) {
            self.give_up();
        }
        changed
    }

    /// All have the number of the settings again, and have had it in the last step.
    fn give_up(&mut self) {
        (self.substeps, self.joined) = (vec![0], None);
        self.of_slot.clear();
    }

    /// The number all islands with joints have.
    fn common_of_joined(&self, goal: &Goal, looked: bool) -> u32 {
        let of = |island: &Island| if looked { aimed(goal, island, self.fresh) } else { island.substeps };
        let joined = self.islands.iter().filter(|island| island.joined);
        let asked = joined.map(of).max().unwrap_or(goal.base).max(goal.base);
        asked.max(goal::substeps_to_follow(self.seen.swing_needs, self.joined.unwrap_or(goal.base), looked))
    }

    /// Islands, what they carry and what they have had.
    fn join(
        &mut self,
        bodies: &Bodies<R>,
        manifolds: &Manifolds<R>,
        joints: impl Iterator<Item = [u32; 2]>,
        runs: &[Range<usize>],
    ) {
        self.sets.part(bodies.len(), runs);
        self.islands.clear();
        self.islands.resize(bodies.len(), Island::default());
        let is_dynamic = |slot: u32| bodies.kind(slot as usize) == BodyKind::Dynamic;
        let touching = manifolds.touching().iter().map(|&place| manifolds.slots(place as usize));
        for (ends, joined) in touching.map(|ends| (ends, false)).chain(joints.map(|ends| (ends, true))) {
            if ends.into_iter().all(is_dynamic) {
                self.sets.join(ends);
            }
            // Noted on bodies for now: their roots are known when all are joined.
            for end in ends {
                self.islands[end as usize].touches = true;
                self.islands[end as usize].joined |= joined;
            }
        }
        for slot in runs.iter().cloned().flatten().filter(|&slot| is_dynamic(slot as u32)) {
            let own = self.islands[slot];
            let at = self.sets.of(slot as u32) as usize;
            let island = &mut self.islands[at];
            let [now, last] = self.seen.load.each_ref().each(|load| load[slot]);
            island.load = [island.load[0].max(now.min(last)), island.load[1].max(now.max(last))];
            let [leaning, sinking] = self.seen.slender_stack_needs[slot];
            island.slender_stack = island.slender_stack.max(leaning);
            island.sinking = island.sinking.max(sinking);
            island.ringed |= sinking < 0.0;
            island.substeps = island.substeps.max(self.of_slot[slot]);
            island.touches |= own.touches;
            island.joined |= own.joined;
        }
    }

    /// The substep groups in use and where their bodies are.
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

    /// What impulses on a slot are to be multiplied by, where its substeps have changed.
    pub fn scale(&self, slot: usize) -> Option<R> {
        let (before, now) = (*self.before.get(slot)?, self.of_slot[slot]);
        (before != now).then(|| R::from_f64(f64::from(before) / f64::from(now)))
    }
}

/// Reads what contacts carry.
#[derive(Debug)]
pub struct Loads<'a> {
    load: &'a mut [f64],
    substeps: &'a [u32],
    first: usize,
}

impl Loads<'_> {
    /// The same, of contacts whose slots count from this one.
    pub(super) fn from(&mut self, first: usize) -> &mut Self {
        self.first = first;
        self
    }
}

impl<L: Lanes> Visit<L> for Loads<'_> {
    fn visit<const POINTS: usize>(&mut self, c: &mut Constraint<L, POINTS>, ends: Ends<'_>, _: usize) {
        let held = c.points.iter().fold(L::zero(), |most, point| most.max(point.velocity_impulse)).to_array();
        for (lane, held) in held.iter().enumerate().take(L::WIDTH) {
            for slot in [ends.a[lane], ends.b[lane]].each(|slot| slot as usize + self.first) {
                // Bodies come and go between a step and the next.
                if let (Some(load), Some(&substeps)) = (self.load.get_mut(slot), self.substeps.get(slot)) {
                    *load = load.max(held.to_f64() * f64::from(substeps));
                }
            }
        }
    }
}
