//! Who may meet whom.

/// Whom each may meet, ascending, one list after the other; memory is kept from step to step.
#[derive(Clone, Debug, Default)]
pub(super) struct Neighbours {
    pairs: Vec<[u32; 2]>,
    /// Where each one's list ends.
    ends: Vec<u32>,
    /// Where each one's next entry goes, while lists are filled.
    next: Vec<u32>,
    /// The lists in the order of pairs, and ascending.
    unsorted: Vec<u32>,
    sorted: Vec<u32>,
}

impl Neighbours {
    /// Nobody meets anybody.
    pub(super) fn clear(&mut self) {
        self.pairs.clear();
        self.ends.clear();
    }

    /// Two may meet each other; each two are named once.
    pub(super) fn add(&mut self, pair: [u32; 2]) {
        self.pairs.push(pair);
    }

    /// Makes the lists of so many: entries are counted and dealt, as sorting them by comparison took a tenth of a step of
    /// `tumbler/2000`.
    pub(super) fn list(&mut self, count: usize) {
        let Self { pairs, ends, next, unsorted, sorted } = self;
        ends.resize(count, 0);
        for &one in pairs.as_flattened() {
            ends[one as usize] += 1;
        }
        let mut end = 0;
        for length in &mut *ends {
            end += *length;
            *length = end;
        }
        let begin = |next: &mut Vec<u32>| {
            next.clear();
            next.push(0);
            next.extend_from_slice(&ends[..count.saturating_sub(1)]);
        };
        let put = |next: &mut [u32], list: &mut [u32], of: u32, entry: u32| {
            let at = &mut next[of as usize];
            list[*at as usize] = entry;
            *at += 1;
        };
        unsorted.resize(2 * pairs.len(), 0);
        sorted.resize(2 * pairs.len(), 0);
        begin(next);
        for &[a, b] in &*pairs {
            put(next, unsorted, a, b);
            put(next, unsorted, b, a);
        }
        // Read one after the other, each is entered with the others in ascending order.
        begin(next);
        let mut from = 0;
        for (own, &end) in ends.iter().enumerate() {
            for &other in &unsorted[from..end as usize] {
                put(next, sorted, other, own as u32);
            }
            from = end as usize;
        }
    }

    /// Whom one may meet; nobody, where it came after the lists were made.
    pub(super) fn of(&self, one: usize) -> &[u32] {
        let begin = if one == 0 { 0 } else { self.ends.get(one - 1).copied().unwrap_or(0) };
        let end = self.ends.get(one).copied().unwrap_or(begin);
        &self.sorted[begin as usize..end as usize]
    }
}
