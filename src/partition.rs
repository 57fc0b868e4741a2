//! Who belongs together: sets of slots that are joined pair by pair.

use std::ops::Range;

/// Disjoint sets of slots (union–find; paths are halved on the way). A set is known by its lowest slot, so that order
/// never comes from the order of joining.
#[derive(Clone, Debug, Default)]
pub(crate) struct Sets {
    parent: Vec<u32>,
}

impl Sets {
    /// Every slot of `runs` is a set of its own again; there are `len` slots. Of others nothing may be asked.
    pub(crate) fn part(&mut self, len: usize, runs: &[Range<usize>]) {
        self.parent.resize(len, 0);
        for run in runs {
            let slots = run.start as u32..run.end as u32;
            self.parent[run.clone()].iter_mut().zip(slots).for_each(|(parent, slot)| *parent = slot);
        }
    }

    /// The lowest slot of the set that a slot is in.
    pub(crate) fn of(&mut self, slot: u32) -> u32 {
        let mut at = slot;
        while self.parent[at as usize] != at {
            let above = self.parent[self.parent[at as usize] as usize];
            self.parent[at as usize] = above;
            at = above;
        }
        at
    }

    /// The same, of sets that are not to be changed.
    pub(crate) fn seen(&self, slot: u32) -> u32 {
        let mut at = slot;
        while self.parent[at as usize] != at {
            at = self.parent[at as usize];
        }
        at
    }

    /// Makes one set of those that two slots are in. `None` where they were in one, else its lowest slot and that of the
    /// set which it took in.
    pub(crate) fn join(&mut self, [a, b]: [u32; 2]) -> Option<[u32; 2]> {
        let (a, b) = (self.of(a), self.of(b));
        let (low, high) = (a.min(b), a.max(b));
        self.parent[high as usize] = low;
        (low != high).then_some([low, high])
    }
}
