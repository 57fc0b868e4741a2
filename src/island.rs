//! Islands of touching bodies, and which of them sleep.
//!
//! An island is a connected component of dynamic bodies over touching pairs; what nothing moves joins nobody to
//! anybody. It falls asleep when all its bodies have been quiet for [`QUIET_SECS`]: velocities become exactly 0,
//! poses, manifolds and impulses stay as they are, and a step leaves it out until something wakes it.
//!
//! | event | cost |
//! |---|---|
//! | each step | one pass in lanes over the blocks that are awake: how long bodies have been quiet |
//! | a body has just become quiet, or contacts came or went while one is | union-find over the touching pairs that are awake |
//! | an island falls asleep or wakes | one pass over bodies and pairs |
//! | all that can move sleeps | none: the step ends where it begins |
//!
//! Measured in f32 with 8 lanes beside one body at 50 m/s, for which pairs are found anew in every step: 5000 sleeping discs
//! cost 0.9 ns each a step (broad phase 0.4, colours 0.4); the block of the one that is awake 4 µs. All asleep: 15 ns a
//! step.
//!
//! A pair that touches never has an awake and a sleeping end: an awake body that comes to touch a sleeping one, or
//! a kinematic body that moves, wakes the whole island in the step that finds the contact, before it is solved.
//!
//! An island that rests on nothing sleeps only where no field acts: a thrown body is slow at its apex, an
//! oscillator where it turns, and no time tells them from a body at rest.
//!
//! When a body is quiet is said in `island/quiet.rs`, what of an island may not sleep though its bodies are quiet in
//! [`Demand`].

mod fall_asleep;
mod quiet;

use std::ops::Range;

use crate::body::{Bodies, BodyKind};
use crate::contact::Manifolds;
use crate::each::Each as _;
use crate::lanes::{Lanes, Real};
use crate::partition::Sets;

use quiet::Quiet;

pub use quiet::{Pull, QuietTime};

/// What a body's island is known to be, by its root: bits.
mod trait_bits {
    /// A body has not been quiet for long enough, or a moving kinematic body touches.
    pub(super) const RESTLESS: u8 = 1;
    /// Something touches that stands still.
    pub(super) const SUPPORTED: u8 = 2;
    /// A body's velocity is not zero.
    pub(super) const DRIFTING: u8 = 4;
}
use trait_bits::{DRIFTING, RESTLESS, SUPPORTED};

/// What a link asks of its ends before they may sleep.
#[derive(Clone, Copy, Debug)]
pub struct Demand {
    /// Slots of its ends.
    pub ends: [u32; 2],
    /// For how long they must have been quiet, seconds; for ever where it keeps them moving.
    pub quiet_secs: f64,
    /// How far from each other it holds their centroids, metres: the longer an island's links together, the slower it
    /// may swing.
    pub reach: f64,
}

/// Who sleeps; memory is kept from step to step.
///
/// Bytes per slot in f32: two flags 2, ring 4, set 4, bits 1, reach 8, quiet 28.
#[derive(Clone, Debug)]
pub struct Islands<R: Real> {
    asleep: Vec<bool>,
    /// Dynamic bodies that do not sleep, kinematic ones that move.
    awake: Vec<bool>,
    /// Of a body that sleeps, the next one of its island: a ring, so that waking costs what the island has.
    next: Vec<u32>,
    quiet: Quiet<R>,
    making: Making,
    kinematic: Vec<u32>,
    /// Slots that hang together without touching.
    links: Vec<[u32; 2]>,
    /// Those of the last look, while they are compared.
    last_links: Vec<[u32; 2]>,
    census: Census,
    /// Kinematic bodies may have been given other velocities.
    pushed: bool,
    /// All times are 0.
    fresh: bool,
    /// How often who is awake has changed.
    changes: u64,
}

/// Islands in the making.
#[derive(Clone, Debug, Default)]
struct Making {
    sets: Sets,
    /// By root, see [`trait_bits`].
    bits: Vec<u8>,
    /// Of links, while they are asked.
    demands: Vec<Demand>,
    /// Metres, by root, while demands are met.
    reach: Vec<f64>,
    /// A link's demand was not met yet that time may meet.
    waits: bool,
}

/// How many there are.
#[derive(Clone, Copy, Debug, Default)]
struct Census {
    dynamic: usize,
    moving_kinematic: usize,
    /// Bodies that sleep, and their islands.
    sleeping: usize,
    rings: usize,
}

impl<R: Real> Default for Islands<R> {
    fn default() -> Self {
        Self {
            asleep: Vec::new(),
            awake: Vec::new(),
            next: Vec::new(),
            quiet: Quiet::default(),
            making: Making::default(),
            kinematic: Vec::new(),
            links: Vec::new(),
            last_links: Vec::new(),
            census: Census::default(),
            pushed: false,
            fresh: true,
            changes: 0,
        }
    }
}

impl<R: Real> Islands<R> {
    /// Bodies that sleep.
    pub fn sleeping(&self) -> usize {
        self.census.sleeping
    }
    /// Islands that sleep.
    pub fn len(&self) -> usize {
        self.census.rings
    }
    /// Nobody sleeps?
    pub fn is_empty(&self) -> bool {
        self.census.rings == 0
    }
    /// [`Islands::awake`] where somebody sleeps; `None` where all are to be reckoned with.
    pub fn awake_beside_sleepers(&self) -> Option<&[bool]> {
        (!self.is_empty()).then_some(&self.awake[..])
    }
    /// Per slot, whether its body sleeps.
    pub fn asleep(&self) -> &[bool] {
        &self.asleep
    }
    /// Per slot, whether its body is one that moves or may begin to: dynamic and awake, or kinematic and moving.
    pub fn awake(&self) -> &[bool] {
        &self.awake
    }
    /// Does the body in a slot sleep?
    pub fn is_asleep(&self, slot: usize) -> bool {
        self.asleep.get(slot).is_some_and(|&asleep| asleep)
    }
    /// How often who is awake has changed.
    pub fn changes(&self) -> u64 {
        self.changes
    }

    /// Takes in which bodies there are, and `links` between their slots: pairs that are one island though they
    /// need not touch, in an order that persists. Links that come or go wake both their ends.
    pub fn look_over(&mut self, bodies: &Bodies<R>, links: impl IntoIterator<Item = [u32; 2]>) {
        let len = bodies.len();
        self.asleep.resize(len, false);
        self.awake.resize(len, false);
        self.next.resize(len, 0);
        self.making.bits.resize(len, 0);
        self.quiet.resize(len);
        self.making.reach.resize(len, 0.0);
        self.kinematic.clear();
        self.census.dynamic = 0;
        for slot in 0..len {
            let dynamic = bodies.kind(slot) == BodyKind::Dynamic;
            self.awake[slot] = dynamic && !self.asleep[slot];
            self.census.dynamic += usize::from(dynamic);
            if bodies.kind(slot) == BodyKind::Kinematic {
                self.kinematic.push(slot as u32);
            }
        }
        self.pushed = true;
        self.changes += 1;
        std::mem::swap(&mut self.links, &mut self.last_links);
        self.links.clear();
        self.links.extend(links);
        self.wake_relinked();
    }

    /// Wakes the ends of links that are not the same as before.
    fn wake_relinked(&mut self) {
        let (now, before) = (std::mem::take(&mut self.links), std::mem::take(&mut self.last_links));
        let same = now.iter().zip(&before).take_while(|(a, b)| a == b).count();
        let (ours, theirs) = (&now[same..], &before[same..]);
        let tail = ours.iter().rev().zip(theirs.iter().rev()).take_while(|(a, b)| a == b).count();
        for &ends in ours[..ours.len() - tail].iter().chain(&theirs[..theirs.len() - tail]) {
            self.wake_ends(ends);
        }
        (self.links, self.last_links) = (now, before);
    }

    /// Can a step be left out, because all that can move sleeps and no kinematic body moves?
    pub fn is_still(&mut self, bodies: &Bodies<R>) -> bool {
        if std::mem::take(&mut self.pushed) || bodies.is_driven() {
            self.census.moving_kinematic = 0;
            for &slot in &self.kinematic {
                let at = slot as usize;
                let moves = !is_at_rest(bodies, at);
                self.census.moving_kinematic += usize::from(moves);
                self.changes += u64::from(std::mem::replace(&mut self.awake[at], moves) != moves);
            }
        }
        self.census.sleeping > 0
            && self.census.sleeping == self.census.dynamic
            && self.census.moving_kinematic == 0
    }

    /// Wakes the island of the body in a slot; the time of a body that does not sleep begins anew.
    pub fn wake(&mut self, slot: usize) {
        if !self.is_asleep(slot) {
            self.quiet.begin(slot);
            return;
        }
        let mut at = slot;
        loop {
            (self.asleep[at], self.awake[at]) = (false, true);
            self.quiet.begin(at);
            self.census.sleeping -= 1;
            at = self.next[at] as usize;
            if at == slot {
                break;
            }
        }
        self.census.rings -= 1;
        self.changes += 1;
    }

    /// Wakes all, whatever may have been done to them.
    pub fn wake_all(&mut self) {
        self.pushed = true;
        if self.fresh {
            return;
        }
        for slot in 0..self.asleep.len() {
            if self.asleep[slot] {
                self.wake(slot);
            }
        }
        self.quiet.begin_all();
        self.fresh = true;
    }

    /// Wakes the islands that rest on the body in a slot, or hang on it.
    pub fn wake_around(&mut self, slot: usize, manifolds: &Manifolds<R>) {
        self.wake(slot);
        let touching = manifolds.touching().iter().map(|&place| manifolds.slots(place as usize));
        let touching = manifolds.resting().chain(touching);
        let links = std::mem::take(&mut self.links);
        for ends in touching.chain(links.iter().copied()) {
            if ends.contains(&(slot as u32)) {
                self.wake_ends(ends);
            }
        }
        self.links = links;
    }

    /// Wakes the islands that something awake touches or is linked to. Did it wake any?
    pub fn wake_touched(&mut self, manifolds: &Manifolds<R>) -> bool {
        let before = self.census.rings;
        // A pair that touches and does not rest has an end that is awake.
        for &place in manifolds.touching() {
            self.wake_ends(manifolds.slots(place as usize));
        }
        let links = std::mem::take(&mut self.links);
        for &ends in &links {
            if ends.iter().any(|&end| self.awake[end as usize]) {
                self.wake_ends(ends);
            }
        }
        self.links = links;
        self.census.rings != before
    }

    fn wake_ends(&mut self, ends: [u32; 2]) {
        for end in ends.each(|end| end as usize) {
            if self.is_asleep(end) {
                self.wake(end);
            }
        }
    }

    /// Reckons how long bodies in `runs` have been quiet, a step of `dt_secs` under `gravity` (m/s²) done.
    pub fn accumulate_quiet_time<L: Lanes<Elem = R>>(
        &mut self,
        bodies: &Bodies<R>,
        runs: &[Range<usize>],
        pull: Pull,
        dt_secs: f64,
    ) -> QuietTime {
        self.fresh = false;
        self.quiet.accumulate::<L>(bodies, runs, pull, dt_secs)
    }
}

/// Are all velocities of a body exactly 0?
fn is_at_rest<R: Real>(bodies: &Bodies<R>, slot: usize) -> bool {
    [&bodies.vx, &bodies.vy, &bodies.w].iter().all(|column| column[slot] == R::ZERO)
}
