//! Broad phase: which bodies may touch.
//!
//! A pair is a candidate when its bounding circles meet and, where one of the two is *long* (a box or
//! polygon of aspect ratio ≥ 3, or anything four times the median size), the other's circle also meets
//! its oriented box. That definition is symmetric and evaluated with the same operations everywhere, so
//! all methods give the same pairs in the same order: by slot, a < b.
//!
//! | method | work | picked by `auto` |
//! |---|---|---|
//! | `off` | no test: all pairs | never |
//! | `brute` | each body against all later ones, in lanes | up to [`BRUTE_LIMIT`] bodies |
//! | `sweep` | sorted along the axis of the wider spread, in lanes while ranges overlap | up to [`SWEEP_LIMIT`] |
//! | `grid` | sorted cells, three runs of whole lanes per body, levels by size | above; up to [`CROWDED_LIMIT`] where cells are not crowded |
//!
//! Measured (µs per step, 8 lanes, `lamina run SCENE --steps 200 --broad B`, sweep and grid): `tumbler/1000` 155, 136; `tumbler/2000` 416,
//! 292; `spinner/2000` 327, 340; `circles/3000` 299, 251; `polygons/5000` 552, 387; `polygons/9000` 1003, 625; falling circles, N = 150:
//! brute 9, sweep 10, grid 24; 100,000 in free flight: sweep 22 ms, grid 13 ms. A run of cells holds about one circle, so grid
//! gains nothing from lanes there. What stretches the grid, an outlier far away, crowds its cells: sweep does not mind.
//!
//! Huge bodies never enter cells or the sweep: each is tested against all others in lanes. Long ones are found by their circles.
//!
//! While some bodies sleep ([`BroadPhase::freeze`]), only pairs with one that is awake are found, among these by the
//! method for so many. Where there are many static bodies ([`MANY_STATICS`]) they always count as asleep, and pairs of two are
//! not looked at, but for those with a huge one.

mod brute;
mod frozen;
mod grid;
mod keep;
mod long;
mod order;
mod reach;
mod sweep;

use crate::body::{Bodies, BodyKind};
use crate::column::Column;
use crate::lanes::{Lanes, Real};
use crate::motion::Near;
use crate::settings::Broad;
use crate::workers::Workers;

/// Up to this many bodies `auto` compares all with all.
pub const BRUTE_LIMIT: usize = 400;
/// Up to this many bodies `auto` sweeps.
pub const SWEEP_LIMIT: usize = 1500;
/// Up to this many bodies `auto` sweeps where cells would be crowded.
const CROWDED_LIMIT: usize = 10_000;

/// From so many static bodies on, which are not huge, they are kept apart from what may move.
const MANY_STATICS: usize = 64;

/// Bounding circles of some bodies, packed: the columns all methods test in lanes.
///
/// Padding is out of reach.
#[derive(Clone, Debug)]
pub(crate) struct Circles<R: Real> {
    x: Column<R>,
    y: Column<R>,
    /// Bounding radius plus the body's reach.
    r: Column<R>,
    slot: Vec<u32>,
}

impl<R: Real> Circles<R> {
    fn new() -> Self {
        // Padding is nowhere: a reach that overflows covers whatever is far.
        let nowhere = R::from_f64(f64::NAN);
        Self { x: Column::new(nowhere), y: Column::new(nowhere), r: Column::new(R::ZERO), slot: Vec::new() }
    }

    #[inline]
    fn len(&self) -> usize {
        self.slot.len()
    }

    fn resize(&mut self, len: usize) {
        // Shrinking to nothing first makes all padding inert again.
        for column in [&mut self.x, &mut self.y, &mut self.r] {
            column.resize(0);
            column.resize(len + 2 * 16);
            column.resize(len);
        }
        self.slot.resize(len, 0);
    }

    #[inline(always)]
    fn set(&mut self, at: usize, circle: (R, R, R, u32)) {
        (self.x[at], self.y[at], self.r[at], self.slot[at]) = circle;
    }

    #[inline(always)]
    fn get(&self, at: usize) -> (R, R, R, u32) {
        (self.x[at], self.y[at], self.r[at], self.slot[at])
    }

    /// Which of the `WIDTH` circles from `at` on (any alignment) meet the given one.
    #[inline(always)]
    fn meeting<L: Lanes<Elem = R>>(&self, at: usize, x: L, y: L, r: L) -> L::Mask {
        let load = |column: &Column<R>| L::load(&column.padded()[at..]);
        meet(x, y, r, load(&self.x), load(&self.y), load(&self.r))
    }
}

/// Do two bounding circles meet? Symmetric to the bit.
#[inline(always)]
fn meet<L: Lanes>(ax: L, ay: L, ar: L, bx: L, by: L, br: L) -> L::Mask {
    let (dx, dy, reach) = (ax - bx, ay - by, ar + br);
    (dx * dx + dy * dy).le(reach * reach)
}

/// What the broad phase did in a step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct BroadCounts {
    /// Pairs that passed the bounding tests (`off`: all pairs).
    pub candidates: usize,
    /// Of these, pairs that may collide: one of them dynamic, categories and masks agreeing.
    pub pairs: usize,
    /// The list of an earlier step served once more.
    pub kept: bool,
}

/// Finds candidate pairs; memory is kept from step to step.
#[derive(Clone, Debug)]
pub struct BroadPhase<R: Real> {
    pairs: Vec<[u32; 2]>,
    circles: Circles<R>,
    reach: reach::Reach<R>,
    long: long::LongBodies<R>,
    order: order::PairOrder,
    sweep: sweep::Sweep<R>,
    grid: grid::Grid<R>,
    keep: keep::Keep<R>,
    frozen: frozen::Frozen<R>,
    /// Some bodies sleep.
    some_sleep: bool,
    /// Per slot, while statics are being frozen.
    awake: Vec<bool>,
    kept: BroadCounts,
    /// What found the last list.
    in_use: Option<Broad>,
    /// Lists found so far.
    lists: u64,
    revision: Option<u64>,
    /// Pairs that may not collide for other reasons than their categories, ordered like `pairs`.
    apart: Vec<[u32; 2]>,
}

impl<R: Real> Default for BroadPhase<R> {
    fn default() -> Self {
        Self {
            pairs: Vec::new(),
            circles: Circles::new(),
            reach: reach::Reach::default(),
            long: long::LongBodies::default(),
            order: order::PairOrder::default(),
            sweep: sweep::Sweep::default(),
            grid: grid::Grid::default(),
            keep: keep::Keep::default(),
            frozen: frozen::Frozen::default(),
            some_sleep: false,
            awake: Vec::new(),
            kept: BroadCounts::default(),
            in_use: None,
            lists: 0,
            revision: None,
            apart: Vec::new(),
        }
    }
}

impl<R: Real> BroadPhase<R> {
    /// The pairs of the last [`BroadPhase::find`]: slots a < b, ordered by a, then b.
    pub fn pairs(&self) -> &[[u32; 2]] {
        &self.pairs
    }

    /// How many lists have been found: which one [`BroadPhase::pairs`] is.
    pub fn lists(&self) -> u64 {
        self.lists
    }

    /// The method `auto` stands for with this many bodies.
    pub fn resolve(method: Broad, bodies: usize) -> Broad {
        match method {
            Broad::Auto if bodies <= BRUTE_LIMIT => Broad::Brute,
            Broad::Auto if bodies <= SWEEP_LIMIT => Broad::Sweep,
            Broad::Auto => Broad::Grid,
            chosen => chosen,
        }
    }

    /// The method that found the last list; before there is one, what `method` stands for with so many bodies.
    pub fn in_use(&self, method: Broad, bodies: usize) -> Broad {
        self.in_use.unwrap_or_else(|| Self::resolve(method, bodies))
    }

    /// Sorts bodies into long and plain ones if they have changed; returns the median bounding radius of those
    /// that move, metres, 0 where none does.
    pub fn look_over(&mut self, bodies: &Bodies<R>) -> f64 {
        if self.revision != Some(bodies.revision()) {
            self.long.classify(bodies);
            self.revision = Some(bodies.revision());
            self.keep.forget();
            if !self.some_sleep {
                self.freeze_statics(bodies);
            }
        }
        let median = self.long.median_radius();
        if median.is_finite() { median } else { 0.0 }
    }

    /// Bodies may have changed in any way: they are looked over before the next list.
    pub fn forget(&mut self) {
        self.revision = None;
    }

    /// Leaves these pairs out from now on: slots a < b, ordered by a, then b. The next list is found afresh.
    pub fn keep_apart(&mut self, pairs: Vec<[u32; 2]>) {
        self.apart = pairs;
        self.keep.forget();
    }

    /// The pairs left out, see [`BroadPhase::keep_apart`].
    pub fn kept_apart(&self) -> &[[u32; 2]] {
        &self.apart
    }

    /// From now on only pairs are found with a body that is `awake`, by slot; all if `None`. Until the next call what
    /// is not awake does not move.
    pub fn freeze(&mut self, bodies: &Bodies<R>, awake: Option<&[bool]>) {
        self.look_over(bodies);
        self.keep.forget();
        self.some_sleep = awake.is_some();
        match awake {
            Some(awake) => self.frozen.sort(bodies, self.long.plain_slots(), awake),
            None => self.freeze_statics(bodies),
        }
    }

    /// Where none sleeps, many statics count as asleep. Huge ones do not: they are tested in lanes.
    fn freeze_statics(&mut self, bodies: &Bodies<R>) {
        let is_static = |slot: u32| bodies.kind(slot as usize) == BodyKind::Static;
        let statics = self.long.plain_slots().iter().filter(|&&slot| is_static(slot)).count();
        self.frozen.active = false;
        if statics >= MANY_STATICS {
            let counts_as_awake = |slot: u32| !is_static(slot) || self.long.is_huge(slot);
            self.awake.clear();
            self.awake.extend((0..bodies.len() as u32).map(counts_as_awake));
            self.frozen.sort(bodies, self.long.plain_slots(), &self.awake);
        }
    }

    /// Finds all pairs closer than `margin` by their bounds now or, as they move now, within `ahead_secs`;
    /// with `keep` a list may be found with a skin and serve for several steps.
    pub fn find<L: Lanes<Elem = R>>(
        &mut self,
        workers: &Workers,
        bodies: &Bodies<R>,
        method: Broad,
        margin: Near<R>,
        ahead_secs: R,
        keep: bool,
    ) -> BroadCounts {
        self.look_over(bodies);
        let frozen = self.frozen.active;
        let searched = if frozen { self.frozen.awake_slots().len() } else { bodies.live() };
        let gives_way = method == Broad::Auto && searched <= CROWDED_LIMIT;
        let method = Self::resolve(method, searched);
        let keep = keep && method != Broad::Off;
        let along = if frozen { None } else { self.long.all_free() };
        if keep && self.keep.holds::<L>(bodies, ahead_secs, along) {
            return BroadCounts { kept: true, ..self.kept };
        }
        let skin = if keep { self.keep.next_skin(self.long.median_radius()) } else { R::ZERO };
        // Statics alone are no reason to see paths otherwise than relative to each other.
        let awake = self.some_sleep.then_some(self.frozen.awake_slots());
        let largest = R::from_f64(self.long.largest_radius());
        self.reach.measure::<L>(bodies, (margin, largest), skin, ahead_secs, awake);
        self.find_afresh::<L>(workers, bodies, method, gives_way);
        self.lists += 1;
        let candidates = self.pairs.len();
        self.keep_collidable(bodies);
        self.keep.begin(bodies, self.long.slots(), skin);
        self.kept = BroadCounts { candidates, pairs: self.pairs.len(), kept: false };
        self.kept
    }

    /// `gives_way`: the grid does, where its cells are crowded.
    fn find_afresh<L: Lanes<Elem = R>>(
        &mut self,
        workers: &Workers,
        bodies: &Bodies<R>,
        method: Broad,
        gives_way: bool,
    ) {
        self.pairs.clear();
        self.in_use = Some(method);
        if method == Broad::Off {
            return all_pairs(bodies, &mut self.pairs);
        }
        self.pack_plain(bodies);
        self.in_use = Some(match method {
            Broad::Brute => {
                brute::find::<L>(&self.circles, &mut self.pairs);
                Broad::Brute
            }
            Broad::Grid if self.grid.find::<L>(workers, &self.circles, &mut self.pairs, gives_way) => {
                Broad::Grid
            }
            _ => {
                self.sweep.find::<L>(&self.circles, &mut self.pairs);
                Broad::Sweep
            }
        });
        if self.frozen.active {
            return self.find_beside_frozen::<L>(bodies);
        }
        self.long.hold_against_boxes(bodies, &self.reach.together, &mut self.pairs);
        let plain = self.pairs.len();
        self.long.find::<L>(bodies, &self.reach.alone, &mut self.pairs);
        if method == Broad::Brute {
            self.order.merge(&mut self.pairs, plain);
        } else {
            self.order.sort(&mut self.pairs, bodies.len());
        }
    }

    /// The pairs of what is awake with what is not, and of huge bodies.
    fn find_beside_frozen<L: Lanes<Elem = R>>(&mut self, bodies: &Bodies<R>) {
        let (frozen, reach) = (&self.frozen, &self.reach);
        // Of statics, relative to what moves, all go the same way.
        let theirs = frozen.any_slot().map_or(reach.at_rest, |slot| reach.together[slot as usize]);
        frozen.find::<L>(&self.circles, theirs, &mut self.pairs);
        self.long.hold_against_boxes(bodies, &reach.together, &mut self.pairs);
        let awake = |slot| frozen.is_awake(slot);
        self.long.find_of::<L>(bodies, &reach.alone, awake, &mut self.pairs);
        self.long.find_near(bodies, &reach.alone, awake, frozen.awake_slots(), &mut self.pairs);
        if 4 * self.pairs.len() < bodies.len() {
            self.pairs.sort_unstable();
        } else {
            self.order.sort(&mut self.pairs, bodies.len());
        }
    }

    /// Drops the pairs that may not collide, or of which neither may move.
    fn keep_collidable(&mut self, bodies: &Bodies<R>) {
        let mut kept = 0;
        for at in 0..self.pairs.len() {
            let pair = self.pairs[at];
            // Written always, kept when wanted: no branch to mispredict.
            self.pairs[kept] = pair;
            let may_move = !self.frozen.active || pair.iter().any(|&slot| self.frozen.is_awake(slot));
            kept += usize::from(bodies.may_collide(pair[0] as usize, pair[1] as usize) & may_move);
        }
        self.pairs.truncate(kept);
        if !self.apart.is_empty() {
            // Both lists are in order: one walk along both.
            let mut apart = self.apart.as_slice();
            self.pairs.retain(|&[a, b]| {
                while apart.first().is_some_and(|&[c, d]| (c, d) < (a, b)) {
                    apart = &apart[1..];
                }
                apart.first() != Some(&[a, b])
            });
        }
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        let circles = self.circles.x.bytes() * 3 + self.circles.slot.capacity() * 4;
        self.pairs.capacity() * 8 + circles + self.grid.bytes() + self.sweep.bytes()
    }

    fn pack_plain(&mut self, bodies: &Bodies<R>) {
        let plain = if self.frozen.active { self.frozen.plain_slots() } else { self.long.plain_slots() };
        if self.circles.len() != plain.len() {
            self.circles.resize(plain.len());
        }
        for (at, slot) in plain.iter().enumerate() {
            let k = *slot as usize;
            self.circles
                .set(at, (bodies.x[k], bodies.y[k], bodies.radius[k] + self.reach.together[k], *slot));
        }
    }
}

fn all_pairs<R: Real>(bodies: &Bodies<R>, pairs: &mut Vec<[u32; 2]>) {
    for a in bodies.slots() {
        pairs.extend((a + 1..bodies.len()).filter(|&b| bodies.is_alive(b)).map(|b| [a as u32, b as u32]));
    }
}

/// Slots in ascending order.
#[inline(always)]
fn ordered(a: u32, b: u32) -> [u32; 2] {
    if a < b { [a, b] } else { [b, a] }
}
