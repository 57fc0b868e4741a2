//! Sweep along an axis: circles sorted by their lower ends, each tested in lanes while ranges overlap. The axis is the one along
//! which they are spread wider, by [`CLEARLY`]: on the other, discs above each other would all overlap. Coordinates are exchanged
//! for it, which no test minds: squares are added in either order to the same bits.
//!
//! The order of the last step is nearly right for this one, so an insertion sort keeps it. Ties are
//! broken by slot: the order never depends on history.
//!
//! Ends lie 4ε of a radius further out than the circle. Where fl(x' − r'(1 + 4ε)) > fl(x + r(1 + 4ε)), as
//! rounding is monotone, x' − x > (r + r')(1 + 3ε), and [`super::meet`] says no after its own rounding, too.
//! With bare ends a pair whose r + r' rounds up was lost, or found by wider lanes alone.

use super::{Circles, ordered};
use crate::column::Column;
use crate::lanes::{LaneMask, Lanes, Real, set_lanes};

/// The axis changes where the other spread is so many times this one.
const CLEARLY: f64 = 2.0;

/// The circles sorted by lower end.
#[derive(Clone, Debug)]
pub(super) struct Sweep<R: Real> {
    /// Positions in the packed circles, sorted.
    order: Vec<u32>,
    /// Their x and y, exchanged where the axis is y.
    sorted: Circles<R>,
    along_y: bool,
}

impl<R: Real> Default for Sweep<R> {
    fn default() -> Self {
        Self { order: Vec::new(), sorted: Circles::new(), along_y: false }
    }
}

impl<R: Real> Sweep<R> {
    pub(super) fn bytes(&self) -> usize {
        self.order.capacity() * 8 + self.sorted.x.bytes() * 3
    }

    pub(super) fn find<L: Lanes<Elem = R>>(&mut self, circles: &Circles<R>, pairs: &mut Vec<[u32; 2]>) {
        self.choose_axis(circles);
        self.sort(circles);
        let n = self.sorted.len();
        for a in 0..n {
            let (x, y, r, slot) = self.sorted.get(a);
            let upper_end = x + widened(r);
            let (lx, ly, lr) = (L::splat(x), L::splat(y), L::splat(r));
            let mut at = a + 1;
            while at < n && self.sorted.x[at] - widened(self.sorted.r[at]) <= upper_end {
                let in_reach = (n - at).min(L::WIDTH);
                let hits = self.sorted.meeting(at, lx, ly, lr).bits() & ((1 << in_reach) - 1);
                for lane in set_lanes(hits) {
                    pairs.push(ordered(slot, self.sorted.slot[at + lane]));
                }
                at += L::WIDTH;
            }
        }
    }

    fn choose_axis(&mut self, circles: &Circles<R>) {
        let spread = |column: &Column<R>| {
            mean_distance(column.padded()[..circles.len()].iter().map(|value| value.to_f64()))
        };
        let (x, y) = (spread(&circles.x), spread(&circles.y));
        let changes = if self.along_y { x > CLEARLY * y } else { y > CLEARLY * x };
        if changes {
            self.along_y = !self.along_y;
            self.order.clear();
        }
    }

    fn sort(&mut self, circles: &Circles<R>) {
        let n = circles.len();
        let along = if self.along_y { &circles.y } else { &circles.x };
        let lower_end = |at: usize| along[at] - widened(circles.r[at]);
        let key = |at: u32| (lower_end(at as usize), circles.slot[at as usize]);
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
            let (x, y, r, slot) = circles.get(from as usize);
            let [x, y] = exchanged(self.along_y, [x, y]);
            self.sorted.set(to, (x, y, r, slot));
        }
    }
}

/// The axis that circles are sorted along first.
#[inline(always)]
pub(super) fn exchanged<T>(along_y: bool, [x, y]: [T; 2]) -> [T; 2] {
    if along_y { [y, x] } else { [x, y] }
}

/// Mean distance from the mean: a spread that outliers move little.
pub(super) fn mean_distance(values: impl Iterator<Item = f64> + Clone) -> f64 {
    let count = values.clone().count() as f64;
    let mean = values.clone().sum::<f64>() / count;
    values.map(|value| (value - mean).abs()).sum::<f64>() / count
}

/// The radius that reaches an end; see the module.
#[inline(always)]
fn widened<R: Real>(radius: R) -> R {
    radius * (R::ONE + R::from_f64(4.0) * R::EPSILON)
}
