//! While some bodies sleep, or many are static: pairs of what is awake, with each other and with what is not. Statics count as
//! asleep throughout.
//!
//! What cannot move stays sorted along the axis of its wider spread from one list to the next (coordinates are exchanged where that
//! is y, as in the sweep); a body that is awake meets those whose centre is no further along it than both radii, the widest of
//! them for all. Ends lie 8ε of that further out: fl(x − e) > x' means x − x' > e exactly, as rounding is monotone, and then
//! [`super::meet`] says no after its own rounding, at every width.

use super::sweep::{exchanged, mean_distance};
use super::{Circles, ordered};
use crate::body::Bodies;
use crate::column::Column;
use crate::lanes::{LaneMask, Lanes, Real, set_lanes};

/// What is awake, and what is not.
#[derive(Clone, Debug)]
pub(super) struct Frozen<R: Real> {
    /// Is anything kept here? If not, nothing of this is looked at.
    pub(super) active: bool,
    /// Per slot.
    is_awake: Vec<bool>,
    /// Slots of plain bodies that are awake, ascending.
    plain: Vec<u32>,
    /// Slots of all bodies that are awake, ascending.
    awake: Vec<u32>,
    /// Plain bodies that are not awake, sorted; radii without reach.
    circles: Circles<R>,
    along_y: bool,
    widest: R,
    order: Vec<u32>,
}

impl<R: Real> Default for Frozen<R> {
    fn default() -> Self {
        Self {
            active: false,
            is_awake: Vec::new(),
            plain: Vec::new(),
            awake: Vec::new(),
            circles: Circles::new(),
            along_y: false,
            widest: R::ZERO,
            order: Vec::new(),
        }
    }
}

impl<R: Real> Frozen<R> {
    /// Takes in who is awake; `plain` has the slots of plain bodies, ascending.
    pub(super) fn sort(&mut self, bodies: &Bodies<R>, plain: &[u32], awake: &[bool]) {
        self.active = true;
        self.is_awake.clear();
        self.is_awake.extend_from_slice(awake);
        self.awake.clear();
        self.awake.extend((0..awake.len() as u32).filter(|&slot| awake[slot as usize]));
        self.plain.clear();
        self.order.clear();
        for &slot in plain {
            let list = if awake[slot as usize] { &mut self.plain } else { &mut self.order };
            list.push(slot);
        }
        let spread =
            |column: &Column<R>| mean_distance(self.order.iter().map(|&slot| column[slot as usize].to_f64()));
        self.along_y = spread(&bodies.y) > spread(&bodies.x);
        let along = if self.along_y { &bodies.y } else { &bodies.x };
        let key = |slot: u32| (along[slot as usize], slot);
        let by_x = |a: &u32, b: &u32| key(*a).partial_cmp(&key(*b)).unwrap_or(std::cmp::Ordering::Equal);
        self.order.sort_unstable_by(by_x);
        self.circles.resize(self.order.len());
        self.widest = R::ZERO;
        for (at, &slot) in self.order.iter().enumerate() {
            let k = slot as usize;
            let radius = bodies.radius[k];
            let [x, y] = exchanged(self.along_y, [bodies.x[k], bodies.y[k]]);
            self.circles.set(at, (x, y, radius, slot));
            if self.widest < radius {
                self.widest = radius;
            }
        }
    }

    /// Slot of some plain body that is not awake.
    pub(super) fn any_slot(&self) -> Option<u32> {
        self.order.first().copied()
    }
    /// Slots of plain bodies that are awake, ascending.
    pub(super) fn plain_slots(&self) -> &[u32] {
        &self.plain
    }
    /// Slots of all bodies that are awake, ascending.
    pub(super) fn awake_slots(&self) -> &[u32] {
        &self.awake
    }
    /// Is the body in a slot awake?
    pub(super) fn is_awake(&self, slot: u32) -> bool {
        self.is_awake[slot as usize]
    }

    /// Appends the pairs of one plain body that is awake and one that is not, whose reach is `reach` metres.
    pub(super) fn find<L: Lanes<Elem = R>>(&self, awake: &Circles<R>, reach: R, pairs: &mut Vec<[u32; 2]>) {
        let n = self.circles.len();
        let xs = self.circles.x.as_slice();
        for k in 0..awake.len() {
            let (x, y, r, slot) = awake.get(k);
            let [x, y] = exchanged(self.along_y, [x, y]);
            let r = r + reach;
            let end = (r + self.widest) * (R::ONE + R::from_f64(8.0) * R::EPSILON);
            let (lx, ly, lr) = (L::splat(x), L::splat(y), L::splat(r));
            let (first, last) = (x - end, x + end);
            let mut at = xs[..n].partition_point(|&x| x < first);
            while at < n && xs[at] <= last {
                let in_reach = (n - at).min(L::WIDTH);
                let hits = self.circles.meeting(at, lx, ly, lr).bits() & ((1 << in_reach) - 1);
                for lane in set_lanes(hits) {
                    pairs.push(ordered(slot, self.circles.slot[at + lane]));
                }
                at += L::WIDTH;
            }
        }
    }
}
