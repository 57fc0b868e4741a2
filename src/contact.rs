//! What narrow phase and solver share: the manifolds of all candidate pairs, kept from step to step.
//!
//! Each candidate pair has a place in one list, ordered by bucket and slots, and keeps its manifold there until the
//! pair leaves the list. A pair that does not touch has a manifold of no points. When the list of pairs changes, one walk
//! along both lists takes over what persists.
//!
//! Gaps and impulses of a contact that is solved are in the lane of the constraint that [`Home`] names, and nowhere else;
//! those of a contact without one (it sleeps, or has just begun, or its solver works on pairs) are in its own rows.
//!
//! Bytes per pair in f32: geometry 32, gap 16, impulse 16, code 4, slots 8, home 8. One-point and two-point
//! manifolds have the same rows; what is unused is 0 or not looked at.

mod places;
mod rest;
mod row;
mod table;

use crate::lanes::{Lanes, ROW, Real};
use places::Recoded;
use table::PairTable;

pub use places::Places;
pub use row::{CONTACT_COLUMNS, ContactRow, GapsAndImpulses};

/// Which features touch, the same from step to step while they do: for polygons bit 7 says whose face
/// is the reference (1: B's), bits 4–6 its edge, bits 1–3 the other's edge, bit 0 which end of it.
pub type Feature = u16;

/// Entries of a manifold's geometry row.
pub mod geometry {
    /// Unit normal from A to B, x; y follows.
    pub const NORMAL: usize = 0;
    /// Arm from A's centroid to point 0, world axes, metres: x; y, and point 1, follow.
    pub const ARM_A: usize = 2;
    /// From A's centroid to B's, metres: x; y follows. An arm from B is the arm from A less this.
    pub const TO_B: usize = 6;
}

/// Entries of a manifold's gap row.
pub mod gap {
    /// Separation of point 0, metres, negative where they overlap; point 1 follows. The solver keeps it up to
    /// date while the manifold is reused.
    pub const SEPARATION: usize = 0;
    /// Coulomb coefficient: the smaller of the two bodies'.
    pub const FRICTION: usize = 2;
    /// Coefficient of restitution: the smaller of the two bodies'.
    pub const RESTITUTION: usize = 3;
}

/// Entries of a contact's impulse row.
pub mod impulse {
    /// Normal impulse of point 0, N·s per substep; point 1 follows.
    pub const NORMAL: usize = 0;
    /// Friction impulse, N·s per substep, along the normal turned a quarter counter-clockwise.
    pub const TANGENT: usize = 2;
    /// Stiffness, N/m, of a solver that keeps one; else 0.
    pub const STIFFNESS: usize = 3;
}

/// Which lane of which list of constraints holds a contact's gaps and impulses.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Home {
    /// The list, by number.
    pub list: u16,
    /// Is it solved as a contact of two points?
    pub two: bool,
    /// Which of the list's lanes.
    pub lane: u32,
}

impl Home {
    /// In no list: the pair's rows hold what there is.
    pub const NONE: Self = Self { list: u16::MAX, two: false, lane: 0 };

    /// Is there a lane?
    #[inline(always)]
    pub fn is_some(self) -> bool {
        self.list != u16::MAX
    }
}

/// A manifold that has other points than before, or other features.
#[derive(Clone, Copy, Debug)]
pub struct Changed {
    /// The pair.
    pub place: u32,
    /// Points and features it had.
    pub before: Code,
    /// Those it has.
    pub now: Code,
}

impl Changed {
    /// Where the impulse of each point comes from: which point of the manifold before has the feature of today's.
    fn sources(&self) -> [Option<usize>; 2] {
        let had = |k: usize| {
            (0..self.before.points()).rev().find(|&j| self.before.feature(j) == self.now.feature(k))
        };
        crate::each::indexed(|k| (k < self.now.points()).then(|| had(k)).flatten())
    }
}

/// Points and features of a manifold in one number that lanes can hold: f₀ + 2⁸·f₁ + 2¹⁶·points, exact in f32.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Code(u32);

impl Code {
    /// A pair the narrow phase has not looked at.
    const UNKNOWN: f64 = -1.0;

    /// From what a column holds.
    #[inline(always)]
    pub fn of<R: Real>(value: R) -> Self {
        // Negative for a pair that is new: no points.
        Self(value.to_f64() as u32)
    }
    /// The lanes' codes: features ≤ 255, `points` 0, 1 or 2 as numbers.
    #[inline(always)]
    pub fn lanes<L: Lanes>(features: [L; 2], points: L) -> L {
        features[0] + features[1] * L::lit(256.0) + points * L::lit(65536.0)
    }
    /// 0, 1 or 2.
    #[inline(always)]
    pub fn points(self) -> usize {
        (self.0 >> 16) as usize
    }
    /// The feature of a point.
    #[inline(always)]
    pub fn feature(self, k: usize) -> Feature {
        (self.0 >> (8 * k) & 0xff) as Feature
    }
}

/// The manifolds of all candidate pairs, in the order of buckets and slots. Contacts of what sleeps rest apart:
/// lists, lengths and places leave them out ([`Manifolds::regroup`]).
#[derive(Clone, Debug)]
pub struct Manifolds<R: Real> {
    now: PairTable<R>,
    before: PairTable<R>,
    /// Contacts of what sleeps.
    rest: rest::SleepingContacts<R>,
    /// Of each pair of the list being taken, and whether its second body is A.
    bucket_of: Vec<(u8, bool)>,
    /// Places of the pairs that touch, ascending.
    touching: Vec<u32>,
    /// Manifolds with other codes than when these were last taken; whether pairs that touch, or how many points they have, may
    /// differ from when `touching` was made.
    recoded: Recoded,
    /// The same of what workers beside the first have found, empty between their calls.
    beside: Vec<Recoded>,
    /// Homes of pairs that left the list.
    gone: Vec<Home>,
}

impl<R: Real> Default for Manifolds<R> {
    fn default() -> Self {
        Self {
            now: PairTable::default(),
            before: PairTable::default(),
            rest: rest::SleepingContacts::default(),
            bucket_of: Vec::new(),
            touching: Vec::new(),
            recoded: Recoded::default(),
            beside: Vec::new(),
            gone: Vec::new(),
        }
    }
}

impl<R: Real> Manifolds<R> {
    /// Takes a new list of pairs; `bucket(pair)` names each one's bucket, and says whether its second body is A. What pairs
    /// of the last list keep is taken over.
    pub fn rebuild(&mut self, pairs: &[[u32; 2]], bucket: impl Fn([u32; 2]) -> (usize, bool)) {
        std::mem::swap(&mut self.now, &mut self.before);
        self.bucket_of.clear();
        let mut counts = [0; 6];
        self.bucket_of.extend(pairs.iter().map(|&pair| {
            let (number, flips) = bucket(pair);
            counts[number] += 1;
            (number as u8, flips)
        }));
        self.before.make_room(pairs.len());
        let table = &mut self.now;
        table.resize(pairs.len());
        let mut next = [0; 6];
        for number in 1..6 {
            next[number] = next[number - 1] + counts[number - 1];
        }
        for (&[low, high], &(number, flips)) in pairs.iter().zip(&self.bucket_of) {
            let at = &mut next[number as usize];
            (table.a[*at], table.b[*at]) = if flips { (high, low) } else { (low, high) };
            *at += 1;
        }
        table.ends = next;
        table.close();
        self.take_over();
        self.recoded.changed = true;
    }

    fn take_over(&mut self) {
        let Self { now, before, gone, .. } = self;
        let mut leave = |old_at: usize| {
            let home = before.home[old_at];
            if home.is_some() {
                gone.push(home);
            }
        };
        for number in 0..6 {
            let mut old = before.bucket(number);
            for at in now.bucket(number) {
                let order = now.order(at);
                while !old.is_empty() && before.order(old.start) < order {
                    leave(old.start);
                    old.start += 1;
                }
                if !old.is_empty() && before.order(old.start) == order {
                    now.take_place(at, before, old.start);
                    old.start += 1;
                } else {
                    now.clear_place(at, R::from_f64(Code::UNKNOWN));
                }
            }
            for old_at in old {
                leave(old_at);
            }
        }
    }

    /// Homes of the pairs that have left the list since they were last taken, the last lanes first.
    pub fn take_gone(&mut self, into: &mut Vec<Home>) {
        into.clear();
        into.append(&mut self.gone);
        into.sort_unstable_by(|a, b| b.cmp(a));
    }

    /// Forgets all pairs and what they kept: bodies came or went, and slots may mean others now.
    pub fn forget(&mut self) {
        self.now.ends = [0; 6];
        self.now.close();
        self.rest.forget();
        self.touching.clear();
        self.recoded.manifolds.clear();
        self.gone.clear();
        self.recoded.changed = true;
    }

    /// Candidate pairs.
    pub fn pairs(&self) -> usize {
        self.now.ends[5]
    }
    /// A place that is no pair and holds zeros.
    pub fn padding(&self) -> u32 {
        self.pairs() as u32
    }
    /// A place that is no pair, for answers nobody reads.
    pub fn spill(&self) -> u32 {
        self.pairs() as u32 + 1
    }
    /// The places of a bucket's pairs.
    pub fn bucket(&self, number: usize) -> std::ops::Range<usize> {
        self.now.bucket(number)
    }
    /// Slots of bodies A and B of the pair at a place. A is the one of the lesser form (circle < box < polygon),
    /// or the lower slot.
    #[inline(always)]
    pub fn slots(&self, at: usize) -> [u32; 2] {
        [self.now.a[at], self.now.b[at]]
    }
    /// Points and features of the pair at a place.
    #[inline(always)]
    pub fn code(&self, at: usize) -> Code {
        Code::of(self.now.code[at])
    }
    /// Has the narrow phase ever looked at the pair?
    #[inline(always)]
    pub fn is_known(&self, at: usize) -> bool {
        self.now.code[at] >= R::ZERO
    }
    /// Rows per place; see [`geometry`].
    #[inline]
    pub fn geometry(&self) -> &[[R; ROW]] {
        self.now.geometry.rows()
    }
    /// Rows per place; see [`gap`].
    #[inline]
    pub fn gaps(&self) -> &[[R; 4]] {
        self.now.gap.fours()
    }
    /// Rows per place; see [`gap`].
    #[inline]
    pub fn gaps_mut(&mut self) -> &mut [[R; 4]] {
        self.now.gap.fours_mut()
    }
    /// Rows per place; see [`impulse`].
    #[inline]
    pub fn impulses(&self) -> &[[R; 4]] {
        self.now.impulse.fours()
    }
    /// Rows per place; see [`impulse`].
    #[inline]
    pub fn impulses_mut(&mut self) -> &mut [[R; 4]] {
        self.now.impulse.fours_mut()
    }
    /// Where the gaps and impulses of each place are.
    pub fn homes(&self) -> &[Home] {
        &self.now.home
    }
    /// The same, to change.
    pub fn homes_mut(&mut self) -> &mut [Home] {
        &mut self.now.home
    }

    /// Impulses of a pair's row stay with their features, new points begin at 0.
    pub fn rematch(&mut self, changed: &Changed) {
        let row = &mut self.now.impulse.fours_mut()[changed.place as usize];
        let before = *row;
        *row = [R::ZERO; 4];
        for (k, source) in changed.sources().into_iter().enumerate() {
            if let Some(j) = source {
                row[impulse::NORMAL + k] = before[impulse::NORMAL + j];
                row[impulse::TANGENT] = before[impulse::TANGENT];
                row[impulse::STIFFNESS] = before[impulse::STIFFNESS];
            }
        }
    }

    /// Brings the list of touching pairs up to date. Says whether it, or a number of points, changed.
    pub fn refresh(&mut self) -> bool {
        let changed = std::mem::take(&mut self.recoded.changed);
        if changed {
            let one = R::from_f64(65536.0);
            let codes = &self.now.code.as_slice()[..self.now.ends[5]];
            self.touching.resize(codes.len(), 0);
            let mut touching = 0;
            for (at, code) in codes.iter().enumerate() {
                // Written always, kept when wanted: no branch to mispredict.
                self.touching[touching] = at as u32;
                touching += usize::from(*code >= one);
            }
            self.touching.truncate(touching);
        }
        changed
    }

    /// Places of the pairs that touch, ascending.
    pub fn touching(&self) -> &[u32] {
        &self.touching
    }
    /// Pairs that touch.
    pub fn len(&self) -> usize {
        self.touching.len()
    }
    /// Nothing touches?
    pub fn is_empty(&self) -> bool {
        self.touching.is_empty()
    }

    /// The `k`-th touching pair's contact.
    pub fn contact(&self, k: usize) -> Contact {
        self.now.contact(self.touching[k] as usize)
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        let tables = self.now.bytes() + self.before.bytes() + self.rest.bytes();
        tables + self.touching.capacity() * 4 + self.bucket_of.capacity() * 2
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
    /// Friction, N·s per substep, along the normal turned a quarter counter-clockwise.
    pub tangent_impulse: f64,
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
    /// Normal impulse, N·s per substep.
    pub impulse: f64,
}
