//! Puts pairs into their one order: by a, then b. A counting sort by a, then each short run by b.

/// Memory of the sort, kept from step to step.
#[derive(Clone, Debug, Default)]
pub(super) struct PairOrder {
    /// Where the run of each a ends while pairs are placed.
    ends: Vec<u32>,
    scratch: Vec<[u32; 2]>,
}

impl PairOrder {
    /// Sorts `pairs`, whose entries are below `slots`.
    pub(super) fn sort(&mut self, pairs: &mut Vec<[u32; 2]>, slots: usize) {
        if pairs.is_sorted() {
            return;
        }
        self.ends.clear();
        self.ends.resize(slots + 1, 0);
        for pair in pairs.iter() {
            self.ends[pair[0] as usize + 1] += 1;
        }
        for a in 0..slots {
            self.ends[a + 1] += self.ends[a];
        }
        self.scratch.clear();
        self.scratch.resize(pairs.len(), [0; 2]);
        for &pair in pairs.iter() {
            // `ends[a]` is where a's run starts, and moves to its end as pairs are placed.
            let end = &mut self.ends[pair[0] as usize];
            self.scratch[*end as usize] = pair;
            *end += 1;
        }
        let mut start = 0;
        for &end in &self.ends[..slots] {
            self.scratch[start..end as usize].sort_unstable();
            start = end as usize;
        }
        std::mem::swap(pairs, &mut self.scratch);
    }
}
