//! Sweep along x: circles sorted by their left ends, each tested in lanes while x-ranges overlap.
//!
//! The order of the last step is nearly right for this one, so an insertion sort keeps it. Ties are
//! broken by slot: the order never depends on history.
//!
//! Ends lie 4ε of a radius further out than the circle. Where fl(x' − r'(1 + 4ε)) > fl(x + r(1 + 4ε)), as
//! rounding is monotone, x' − x > (r + r')(1 + 3ε), and [`super::meet`] says no after its own rounding, too.
//! With bare ends a pair whose r + r' rounds up was lost, or found by wider lanes alone.

use super::{Circles, ordered};
use crate::lanes::{LaneMask, Lanes, Real, set_lanes};

/// The circles sorted by left end.
#[derive(Clone, Debug)]
pub(super) struct Sweep<R: Real> {
    /// Positions in the packed circles, sorted.
    order: Vec<u32>,
    sorted: Circles<R>,
}

impl<R: Real> Default for Sweep<R> {
    fn default() -> Self {
        Self { order: Vec::new(), sorted: Circles::new() }
    }
}

impl<R: Real> Sweep<R> {
    pub(super) fn bytes(&self) -> usize {
        self.order.capacity() * 8 + self.sorted.x.bytes() * 3
    }

    pub(super) fn find<L: Lanes<Elem = R>>(&mut self, circles: &Circles<R>, pairs: &mut Vec<[u32; 2]>) {
        self.sort(circles);
        let n = self.sorted.len();
        for a in 0..n {
            let (x, y, r, slot) = self.sorted.get(a);
            let right_end = x + widened(r);
            let (lx, ly, lr) = (L::splat(x), L::splat(y), L::splat(r));
            let mut at = a + 1;
            while at < n && self.sorted.x[at] - widened(self.sorted.r[at]) <= right_end {
                let in_reach = (n - at).min(L::WIDTH);
                let hits = self.sorted.meeting(at, lx, ly, lr).bits() & ((1 << in_reach) - 1);
                for lane in set_lanes(hits) {
                    pairs.push(ordered(slot, self.sorted.slot[at + lane]));
                }
                at += L::WIDTH;
            }
        }
    }

    fn sort(&mut self, circles: &Circles<R>) {
        let n = circles.len();
        let left_end = |at: usize| circles.x[at] - widened(circles.r[at]);
        let key = |at: u32| (left_end(at as usize), circles.slot[at as usize]);
        let before = |a: u32, b: u32| key(a) < key(b);
        if self.order.len() == n {
            for k in 1..n {
                let mut at = k;
                while at > 0 && before(self.order[at], self.order[at - 1]) {
                    self.order.swap(at, at - 1);
                    at -= 1;
                }
            }
        } else {
            self.order.clear();
            self.order.extend(0..n as u32);
            self.order
                .sort_unstable_by(|&a, &b| key(a).partial_cmp(&key(b)).unwrap_or(std::cmp::Ordering::Equal));
            self.sorted.resize(n);
        }
        for (to, &from) in self.order.iter().enumerate() {
            self.sorted.set(to, circles.get(from as usize));
        }
    }
}

/// The radius that reaches an end; see the module.
#[inline(always)]
fn widened<R: Real>(radius: R) -> R {
    radius * (R::ONE + R::from_f64(4.0) * R::EPSILON)
}
