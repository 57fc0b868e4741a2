//! Which pairs are looked at.

use super::MovedBodies;
use crate::contact::Manifolds;
use crate::lanes::{Lanes, Real};

/// The pairs of one bucket to look at: A, B and places apart so that a batch's are three slices.
#[derive(Clone, Debug, Default)]
pub(super) struct Todo {
    pub(super) a: Vec<u32>,
    pub(super) b: Vec<u32>,
    pub(super) place: Vec<u32>,
    /// Pairs; behind them the world against itself, up to whole lanes at every width.
    pub(super) len: usize,
}

impl Todo {
    pub(super) fn fill<R: Real>(
        &mut self,
        manifolds: &Manifolds<R>,
        bucket: usize,
        has_moved: MovedBodies<'_>,
    ) {
        let places = manifolds.bucket(bucket);
        if places.is_empty() {
            self.len = 0;
            return;
        }
        for list in [&mut self.a, &mut self.b, &mut self.place] {
            if list.len() < places.len() + 16 {
                list.resize(places.len() + 16, 0);
            }
        }
        let mut chosen = 0;
        for at in places {
            let [a, b] = manifolds.slots(at);
            let look = match has_moved {
                MovedBodies::All => true,
                MovedBodies::These(bodies) => {
                    bodies[a as usize] | bodies[b as usize] | !manifolds.is_known(at)
                }
            };
            // Written always, kept when wanted: no branch to mispredict.
            (self.a[chosen], self.b[chosen], self.place[chosen]) = (a, b, at as u32);
            chosen += usize::from(look);
        }
        self.end(chosen, manifolds);
    }

    /// Where the first batch begins of which no pair has a body below a slot.
    pub(super) fn batch_from<L: Lanes>(&self, slot: u32) -> usize {
        let (mut low, mut high) = (0, self.len.div_ceil(L::WIDTH));
        while low < high {
            let middle = usize::midpoint(low, high);
            let at = middle * L::WIDTH;
            if self.a[at].min(self.b[at]) < slot { low = middle + 1 } else { high = middle }
        }
        low * L::WIDTH
    }

    /// So many pairs are all: padding follows.
    pub(super) fn end<R: Real>(&mut self, chosen: usize, manifolds: &Manifolds<R>) {
        self.len = chosen;
        let padding = chosen..chosen.next_multiple_of(16);
        self.a[padding.clone()].fill(0);
        self.b[padding.clone()].fill(0);
        self.place[padding].fill(manifolds.spill());
    }
}
