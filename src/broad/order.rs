//! Puts pairs into their one order: by a, then b.

/// Memory of the sort, kept from step to step.
#[derive(Clone, Debug, Default)]
pub(super) struct PairOrder {
    /// Where the next pair of each slot goes.
    next: Vec<u32>,
    scratch: Vec<[u32; 2]>,
}

impl PairOrder {
    /// Sorts `pairs`, whose entries are below `slots`: two stable counting sorts, by b and then by a.
    ///
    /// One counting sort by a and a small sort per run took twice the instructions.
    pub(super) fn sort(&mut self, pairs: &mut Vec<[u32; 2]>, slots: usize) {
        if pairs.is_sorted() {
            return;
        }
        self.sort_by(1, pairs, slots);
        self.sort_by(0, pairs, slots);
    }

    fn sort_by(&mut self, which: usize, pairs: &mut Vec<[u32; 2]>, slots: usize) {
        self.next.clear();
        self.next.resize(slots, 0);
        for pair in pairs.iter() {
            self.next[pair[which] as usize] += 1;
        }
        let mut start = 0;
        for next in &mut self.next {
            start += std::mem::replace(next, start);
        }
        // Not cleared first: all of it is written.
        self.scratch.resize(pairs.len(), [0; 2]);
        for &pair in pairs.iter() {
            let next = &mut self.next[pair[which] as usize];
            self.scratch[*next as usize] = pair;
            *next += 1;
        }
        std::mem::swap(pairs, &mut self.scratch);
    }

    /// Merges the sorted `pairs[..middle]` with the rest, which it sorts first.
    pub(super) fn merge(&mut self, pairs: &mut Vec<[u32; 2]>, middle: usize) {
        let (head, tail) = pairs.split_at_mut(middle);
        tail.sort_unstable();
        self.scratch.clear();
        let mut head = &*head;
        for &pair in &*tail {
            let before = head.iter().take_while(|other| **other < pair).count();
            self.scratch.extend_from_slice(&head[..before]);
            self.scratch.push(pair);
            head = &head[before..];
        }
        self.scratch.extend_from_slice(head);
        std::mem::swap(pairs, &mut self.scratch);
    }
}
