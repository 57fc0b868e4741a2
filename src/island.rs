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

use std::ops::Range;

use crate::body::{Bodies, BodyKind};
use crate::column::Column;
use crate::contact::Manifolds;
use crate::each::Each as _;
use crate::lanes::{LaneMask, Lanes, Real};
use crate::motion::lanes_in;
use crate::partition::Sets;

/// All bodies of an island must have been quiet for so long before it falls asleep.
pub(crate) const QUIET_SECS: f64 = 0.5;
/// Below this speed, in bounding radii per second, a body is quiet: in [`QUIET_SECS`] it then goes no further than
/// a manifold is held to be unchanged ([`crate::motion::CONTACT_REUSE_DISTANCE`]).
///
/// Measured (largest speed of any body per half second): pyramid/10 falls below 1 mm/s in 2 s, pyramid/20 below 5
/// mm/s in 4.5 s, polygons/150 below 2 mm/s in 8 s, rain/200 and cards/3 likewise, all of them decaying towards 0;
/// an arch creeps by 1 mm/s, a column of 20 boxes wavers by 1.7 mm/s. What must not sleep: in circles/150 a disc of
/// 0.6 m rolls on by 9.2 mm/s. With radii of 0.6 to 1 m the bound is 5 to 8 mm/s, between the two.
///
/// `pgs` leaves a resting body ½gh of velocity, 2 cm/s with the defaults, which its next step takes away: under it
/// nothing of ordinary size falls asleep.
const QUIET_RADII_PER_SEC: f64 = crate::motion::CONTACT_REUSE_DISTANCE / QUIET_SECS;
/// And below what gravity gives in so many seconds: large bodies and weak gravity take their time to begin a fall.
const QUIET_FALL_SECS: f64 = 1e-3;

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

/// Whether islands are worth a look after a step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct QuietTime {
    /// Some dynamic body has been quiet for [`QUIET_SECS`].
    pub some: bool,
    /// One has been so since this step.
    pub newly: bool,
}

/// Who sleeps; memory is kept from step to step.
///
/// Bytes per slot in f32: two flags 2, ring 4, set 4, bits 1, quiet time 4.
#[derive(Clone, Debug)]
pub struct Islands<R: Real> {
    asleep: Vec<bool>,
    /// Dynamic bodies that do not sleep, kinematic ones that move.
    awake: Vec<bool>,
    /// Of a body that sleeps, the next one of its island: a ring, so that waking costs what the island has.
    next: Vec<u32>,
    /// Seconds a body has been quiet; far below 0 while it sleeps, so that it does not tire again.
    quiet_secs: Column<R>,
    /// Islands in the making.
    sets: Sets,
    bits: Vec<u8>,
    kinematic: Vec<u32>,
    /// Slots that hang together without touching.
    links: Vec<[u32; 2]>,
    /// Those of the last look, while they are compared.
    last_links: Vec<[u32; 2]>,
    moving_kinematic: usize,
    dynamic: usize,
    sleeping: usize,
    rings: usize,
    /// Kinematic bodies may have been given other velocities.
    pushed: bool,
    /// All times are 0.
    fresh: bool,
    /// How often who is awake has changed.
    changes: u64,
}

impl<R: Real> Default for Islands<R> {
    fn default() -> Self {
        Self {
            asleep: Vec::new(),
            awake: Vec::new(),
            next: Vec::new(),
            quiet_secs: Column::new(R::ZERO),
            sets: Sets::default(),
            bits: Vec::new(),
            kinematic: Vec::new(),
            links: Vec::new(),
            last_links: Vec::new(),
            moving_kinematic: 0,
            dynamic: 0,
            sleeping: 0,
            rings: 0,
            pushed: false,
            fresh: true,
            changes: 0,
        }
    }
}

impl<R: Real> Islands<R> {
    /// Bodies that sleep.
    pub fn sleeping(&self) -> usize {
        self.sleeping
    }
    /// Islands that sleep.
    pub fn len(&self) -> usize {
        self.rings
    }
    /// Nobody sleeps?
    pub fn is_empty(&self) -> bool {
        self.rings == 0
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
        self.bits.resize(len, 0);
        self.quiet_secs.resize(len);
        self.kinematic.clear();
        self.dynamic = 0;
        for slot in 0..len {
            let dynamic = bodies.kind(slot) == BodyKind::Dynamic;
            self.awake[slot] = dynamic && !self.asleep[slot];
            self.dynamic += usize::from(dynamic);
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
            self.moving_kinematic = 0;
            for &slot in &self.kinematic {
                let at = slot as usize;
                let moves = !is_at_rest(bodies, at);
                self.moving_kinematic += usize::from(moves);
                self.changes += u64::from(std::mem::replace(&mut self.awake[at], moves) != moves);
            }
        }
        self.sleeping > 0 && self.sleeping == self.dynamic && self.moving_kinematic == 0
    }

    /// Wakes the island of the body in a slot; the time of a body that does not sleep begins anew.
    pub fn wake(&mut self, slot: usize) {
        if !self.is_asleep(slot) {
            if slot < self.quiet_secs.len() {
                self.quiet_secs[slot] = R::ZERO;
            }
            return;
        }
        let mut at = slot;
        loop {
            (self.asleep[at], self.awake[at]) = (false, true);
            self.quiet_secs[at] = R::ZERO;
            self.sleeping -= 1;
            at = self.next[at] as usize;
            if at == slot {
                break;
            }
        }
        self.rings -= 1;
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
        self.quiet_secs.padded_mut().fill(R::ZERO);
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
        let before = self.rings;
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
        self.rings != before
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
        dt_secs: f64,
        gravity: f64,
    ) -> QuietTime {
        let (zero, dt, window) = (L::zero(), L::lit(dt_secs), L::lit(QUIET_SECS));
        let per_sec = L::lit(QUIET_RADII_PER_SEC);
        let fall = if gravity > 0.0 { L::lit(QUIET_FALL_SECS * gravity) } else { L::splat(R::FAR) };
        let columns = [&bodies.vx, &bodies.vy, &bodies.w, &bodies.radius, &bodies.inv_mass];
        let columns = columns.each(Column::lanes::<L>);
        let times = self.quiet_secs.lanes_mut::<L>();
        let mut quiet_time = QuietTime::default();
        for at in lanes_in::<L>(runs) {
            let [vx, vy, w, radius, inv_mass] = columns.each(|column| column[at]);
            let speed = (vx.abs() + vy.abs()) + radius * w.abs();
            let quiet = speed.lt((per_sec * radius).min(fall));
            let before = times[at];
            let after = L::select(quiet, before + dt, zero);
            times[at] = after;
            let ripe = window.le(after) & zero.lt(inv_mass);
            if ripe.any() {
                quiet_time.some = true;
                quiet_time.newly |= (ripe & before.lt(window)).any();
            }
        }
        self.fresh = false;
        quiet_time
    }

    /// Lets the islands in `runs` fall asleep that may. `fields`: does any act?
    pub fn settle(
        &mut self,
        bodies: &mut Bodies<R>,
        manifolds: &Manifolds<R>,
        runs: &[Range<usize>],
        fields: bool,
    ) {
        self.join(bodies, manifolds, runs);
        for slot in runs.iter().cloned().flatten() {
            if !self.awake[slot] || bodies.kind(slot) != BodyKind::Dynamic {
                continue;
            }
            let root = self.sets.of(slot as u32) as usize;
            let bits = self.bits[root];
            let rests = bits & SUPPORTED != 0 || !(fields || bits & DRIFTING != 0);
            if bits & RESTLESS == 0 && rests {
                self.put_to_sleep(bodies, slot, root);
            }
        }
    }

    /// Finds the islands of awake bodies and what they are.
    fn join(&mut self, bodies: &Bodies<R>, manifolds: &Manifolds<R>, runs: &[Range<usize>]) {
        self.sets.part(bodies.len(), runs);
        for slot in runs.iter().cloned().flatten() {
            self.bits[slot] = 0;
        }
        let is_dynamic = |slot: u32| bodies.kind(slot as usize) == BodyKind::Dynamic;
        let Self { links, awake, sets, bits, .. } = self;
        let awake_links = links.iter().filter(|ends| ends.iter().any(|&end| awake[end as usize]));
        let touching = manifolds.touching().iter().map(|&place| manifolds.slots(place as usize));
        let edges = touching.chain(awake_links.copied());
        for ends in edges.clone() {
            if ends.into_iter().all(is_dynamic) {
                sets.join(ends);
            }
        }
        for [a, b] in edges {
            for (own, other) in [(a, b), (b, a)] {
                if is_dynamic(own) && !is_dynamic(other) {
                    let root = sets.of(own) as usize;
                    bits[root] |= if awake[other as usize] { RESTLESS } else { SUPPORTED };
                }
            }
        }
        let window = R::from_f64(QUIET_SECS);
        for slot in runs.iter().cloned().flatten().filter(|&slot| is_dynamic(slot as u32)) {
            let quiet = window <= self.quiet_secs[slot];
            let root = sets.of(slot as u32) as usize;
            bits[root] |= if quiet { 0 } else { RESTLESS };
            bits[root] |= if is_at_rest(bodies, slot) { 0 } else { DRIFTING };
        }
    }

    fn put_to_sleep(&mut self, bodies: &mut Bodies<R>, slot: usize, root: usize) {
        // Slots ascend and a root is the lowest: it always begins its ring.
        if slot == root {
            self.next[slot] = slot as u32;
            self.rings += 1;
        } else {
            self.next[slot] = std::mem::replace(&mut self.next[root], slot as u32);
        }
        (self.asleep[slot], self.awake[slot]) = (true, false);
        self.quiet_secs[slot] = -R::FAR;
        for column in [&mut bodies.vx, &mut bodies.vy, &mut bodies.w] {
            column[slot] = R::ZERO;
        }
        self.sleeping += 1;
        self.changes += 1;
    }
}

/// Are all velocities of a body exactly 0?
fn is_at_rest<R: Real>(bodies: &Bodies<R>, slot: usize) -> bool {
    [&bodies.vx, &bodies.vy, &bodies.w].iter().all(|column| column[slot] == R::ZERO)
}
