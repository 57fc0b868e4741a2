//! The contacts of what sleeps: a table of their own, which no step goes through.
//!
//! A pair with an end that is awake has its place in the list of pairs; what else touches rests here with its
//! manifold, gaps and impulses, and comes back when an end wakes. What is too far apart to touch is forgotten: it is
//! still too far apart when it wakes, and pairs are found anew then.

use super::{Code, Contact, Manifolds, PairTable};
use crate::lanes::Real;

/// Contacts at rest, and the memory of the last sorting.
#[derive(Clone, Debug)]
pub(super) struct SleepingContacts<R: Real> {
    now: PairTable<R>,
    before: PairTable<R>,
}

impl<R: Real> Default for SleepingContacts<R> {
    fn default() -> Self {
        Self { now: PairTable::default(), before: PairTable::default() }
    }
}

impl<R: Real> SleepingContacts<R> {
    /// Forgets all.
    pub(super) fn forget(&mut self) {
        self.now.ends = [0; 6];
    }

    /// The pairs at rest.
    pub(super) fn table(&self) -> &PairTable<R> {
        &self.now
    }

    /// Places of those that touch.
    pub(super) fn touching(&self) -> impl Iterator<Item = usize> + '_ {
        (0..self.now.ends[5]).filter(|&at| Code::of(self.now.code[at]).points() > 0)
    }

    /// Bytes held.
    pub(super) fn bytes(&self) -> usize {
        self.now.bytes() + self.before.bytes()
    }
}

/// Where sorted pairs go.
struct Sorting<'a, R: Real> {
    awake: Option<&'a [bool]>,
    listed: &'a mut PairTable<R>,
    rest: &'a mut PairTable<R>,
    ends: [usize; 2],
}

impl<R: Real> Sorting<'_, R> {
    #[inline(always)]
    fn take(&mut self, old: &PairTable<R>, old_at: usize) {
        let (a, b) = (old.a[old_at], old.b[old_at]);
        let stirs = self.awake.is_none_or(|awake| awake[a as usize] | awake[b as usize]);
        let (table, end) =
            if stirs { (&mut *self.listed, &mut self.ends[0]) } else { (&mut *self.rest, &mut self.ends[1]) };
        if stirs || Code::of(old.code[old_at]).points() > 0 {
            (table.a[*end], table.b[*end]) = (a, b);
            table.take_place(*end, old, old_at);
            *end += 1;
        }
    }
}

impl<R: Real> Manifolds<R> {
    /// Sorts pairs into the list, where a slot of theirs holds `true`, and those at rest; all into the list if `None`.
    pub fn regroup(&mut self, awake: Option<&[bool]>) {
        std::mem::swap(&mut self.now, &mut self.before);
        std::mem::swap(&mut self.rest.now, &mut self.rest.before);
        let (listed, resting) = (&self.before, &self.rest.before);
        let most = listed.ends[5] + resting.ends[5];
        self.now.resize(most);
        self.rest.now.resize(most);
        let mut sorting = Sorting { awake, listed: &mut self.now, rest: &mut self.rest.now, ends: [0; 2] };
        for number in 0..6 {
            // A pair forgotten while it rested belongs to bodies that are gone.
            let mut woken = resting.bucket(number).filter(|&at| resting.code[at] >= R::ZERO).peekable();
            for at in listed.bucket(number) {
                let order = listed.order(at);
                while let Some(earlier) = woken.next_if(|&old| resting.order(old) < order) {
                    sorting.take(resting, earlier);
                }
                sorting.take(listed, at);
            }
            for later in woken {
                sorting.take(resting, later);
            }
            sorting.listed.ends[number] = sorting.ends[0];
            sorting.rest.ends[number] = sorting.ends[1];
        }
        self.rest.before.make_room(most);
        self.before.make_room(most);
        self.now.close();
        self.rest.now.close();
        self.recoded.changed = true;
    }

    /// Forgets the pairs of one slot, which will mean another body or none.
    pub fn forget_slot(&mut self, slot: usize) {
        let slot = slot as u32;
        for table in [&mut self.now, &mut self.rest.now] {
            for at in 0..table.ends[5] {
                if table.a[at] == slot || table.b[at] == slot {
                    table.clear_place(at, R::from_f64(Code::UNKNOWN));
                }
            }
        }
        let (a, b) = (&self.now.a, &self.now.b);
        self.touching.retain(|&at| a[at as usize] != slot && b[at as usize] != slot);
        self.recoded.changed = true;
    }

    /// Slots of the pairs that touch and whose bodies all sleep or cannot move.
    pub fn resting(&self) -> impl Iterator<Item = [u32; 2]> + '_ {
        let table = &self.rest.now;
        self.rest.touching().map(|at| [table.a[at], table.b[at]])
    }

    /// How many those are.
    pub fn resting_len(&self) -> usize {
        self.rest.now.ends[5]
    }

    /// All contacts in the order of buckets and slots, the resting ones included.
    pub fn contacts(&self) -> Vec<Contact> {
        let mut contacts = Vec::with_capacity(self.len() + self.resting_len());
        for (table, touching) in [(&self.now, Some(&self.touching)), (&self.rest.now, None)] {
            for number in 0..6 {
                let touches = |at: &usize| match touching {
                    Some(list) => list.binary_search(&(*at as u32)).is_ok(),
                    None => Code::of(table.code[*at]).points() > 0,
                };
                let found = table.bucket(number).filter(touches);
                contacts.extend(found.map(|at| (number, table.order(at), table.contact(at))));
            }
        }
        contacts.sort_by_key(|(number, order, _)| (*number, *order));
        contacts.into_iter().map(|(_, _, contact)| contact).collect()
    }
}
