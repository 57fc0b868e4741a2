//! Threads: how many a step has, and how its stages share out what they do among them.
//!
//! Slots are cut into [`Parts`], one per worker, and whatever belongs to a part stays with its worker: its columns and rows while
//! bodies are integrated, the pairs whose lower body it holds, the constraints of contacts within it. Contacts between parts
//! are solved by the first worker, colour by colour after those within. Where slots are cut says nothing about a result: of one
//! colour no contact shares a body that moves, and what workers have found is put together in the order of slots.
//!
//! A stage is handed out by `lamina-team`, in 0.1 to 0.3 µs. Parts are weighed every few steps by their bodies and contacts.

use std::sync::{Arc, LazyLock};

use lamina_team::Team;

use crate::settings::{MOST_THREADS as MOST, Threads};

/// Bodies from which on `auto` takes more than one thread: below, what goes from core to core takes what it saves.
const AUTO_BODIES: usize = 4000;

/// Who does a step's work.
#[derive(Clone, Debug, Default)]
pub struct Workers {
    team: Option<Arc<Team>>,
}

impl Workers {
    /// The thread that calls.
    pub const ALONE: Self = Self { team: None };

    /// As many as are asked for with so many bodies, the same as before where they are as many. Where the system gives no threads
    /// a step is done by one.
    pub(crate) fn of(&mut self, threads: Threads, bodies: usize) -> Self {
        static CORES: LazyLock<usize> =
            LazyLock::new(|| std::thread::available_parallelism().map_or(1, std::num::NonZero::get));
        let count = match threads {
            Threads::Auto if bodies < AUTO_BODIES => 1,
            Threads::Auto => (*CORES).min(MOST),
            Threads::Exactly(count) => count,
        };
        if count != self.count() {
            self.team = if count > 1 { Team::new(count).ok().map(Arc::new) } else { None };
        }
        self.clone()
    }

    /// At least one.
    pub(crate) fn count(&self) -> usize {
        self.team.as_ref().map_or(1, |team| team.workers())
    }

    /// Does `task(k, &mut entries[k])` for every entry, beside each other.
    pub(crate) fn each<T: Send>(&self, entries: &mut [T], task: impl Fn(usize, &mut T) + Sync) {
        match &self.team {
            Some(team) => team.each(entries, task),
            None => entries.iter_mut().enumerate().for_each(|(k, entry)| task(k, entry)),
        }
    }
}

/// The heaviest part over the mean from which on parts are cut anew.
const UNEVEN: f64 = 1.1;

/// Ranges of slots that threads share out among them, of whole blocks. Which they are changes no bit of a result.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Parts {
    /// Where each but the last ends; further ones are 0.
    ends: [u32; MOST - 1],
    /// How many do.
    cuts: usize,
}

impl Parts {
    /// Blocks of `block` slots cut into so many parts of about the same weight; none where the largest part of `before` is at most
    /// [`UNEVEN`] of the mean. `extra`: what the first worker does beside its part.
    pub(crate) fn cut(
        (weights, extra): (&[u64], u64),
        parts: usize,
        block: usize,
        before: &Self,
    ) -> Option<Self> {
        let parts = parts.min(weights.len()).max(1);
        let mean = (weights.iter().sum::<u64>() + extra) as f64 / parts as f64;
        if before.count() == parts {
            let mut from = 0;
            let mut heaviest = 0;
            for (part, end) in before.ends().enumerate() {
                let to = end.map_or(weights.len(), |end| end / block).clamp(from, weights.len());
                let own: u64 = weights[std::mem::replace(&mut from, to)..to].iter().sum();
                heaviest = heaviest.max(own + if part == 0 { extra } else { 0 });
            }
            if heaviest as f64 <= UNEVEN * mean {
                return None;
            }
        }
        let (mut cut, mut sum) = (Self::default(), extra);
        for (at, weight) in weights.iter().enumerate() {
            sum += weight;
            if cut.count() < parts && sum as f64 >= mean * cut.count() as f64 {
                cut.push(((at + 1) * block) as u32);
            }
        }
        (cut != *before).then_some(cut)
    }

    /// At least one.
    pub(crate) fn count(&self) -> usize {
        self.cuts + 1
    }

    fn push(&mut self, end: u32) {
        self.ends[self.cuts] = end;
        self.cuts += 1;
    }

    /// Lists that contacts of one colour are in: one per part, and behind these one of contacts between parts.
    pub(crate) fn lists(&self) -> usize {
        if self.cuts == 0 { 1 } else { self.cuts + 2 }
    }

    /// The first slot of a part; 0 behind the last, for what is between parts.
    pub(crate) fn first(&self, part: usize) -> usize {
        if (1..=self.cuts).contains(&part) { self.ends[part - 1] as usize } else { 0 }
    }

    /// What these parts are of something else that is in the order of slots; `begin(slot)`: what of it begins with a slot.
    pub(crate) fn map(&self, begin: impl Fn(usize) -> usize) -> Self {
        let mut mapped = Self::default();
        let mut last = 0;
        for &end in &self.ends[..self.cuts] {
            last = last.max(begin(end as usize) as u32);
            mapped.push(last);
        }
        mapped
    }

    fn of(&self, slot: u32) -> usize {
        self.ends[..self.cuts].partition_point(|&end| end <= slot)
    }

    /// Which of those lists a contact is in.
    pub(crate) fn list_of(&self, [a, b]: [u32; 2]) -> usize {
        let (a, b) = (self.of(a), self.of(b));
        if a == b { a } else { self.cuts + 1 }
    }

    /// Where each part ends, of the last `None`: it ends where slots do.
    pub(crate) fn ends(&self) -> impl Iterator<Item = Option<usize>> {
        self.ends[..self.cuts].iter().map(|&end| Some(end as usize)).chain(std::iter::once(None))
    }
}

/// One of them per part; those beyond the last are `None`.
pub(crate) type PerPart<T> = [Option<T>; MOST];

/// The first `count` entries, or all; leaves the rest.
#[expect(clippy::mut_mut, reason = "what is left is a slice of the same")]
pub(crate) fn take<'a, T>(left: &mut &'a mut [T], count: Option<usize>) -> &'a mut [T] {
    let all = std::mem::take(left);
    let (taken, rest) = all.split_at_mut(count.unwrap_or(all.len()));
    *left = rest;
    taken
}

/// Does something with the rows of every part, of which it is told the first slot.
pub(crate) fn share_rows<T: Send>(
    (workers, parts): (&Workers, &Parts),
    rows: &mut [T],
    task: impl Fn(usize, &mut [T]) + Sync,
) {
    if parts.count() == 1 {
        return task(0, rows);
    }
    let mut jobs: PerPart<_> = std::array::from_fn(|_| None);
    let (mut left, mut first) = (rows, 0);
    for (job, end) in jobs.iter_mut().zip(parts.ends()) {
        *job = Some((first, take(&mut left, end.map(|end| end - first))));
        first = end.unwrap_or(first);
    }
    workers.each(&mut jobs[..parts.count()], |_, job| {
        if let Some((first, rows)) = job {
            task(*first, rows);
        }
    });
}
