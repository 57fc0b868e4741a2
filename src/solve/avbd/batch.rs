//! Bodies into batches: coloured so that no two of a batch touch, each with the contacts it visits.

use super::{Avbd, Batch, COLORS};
use crate::body::{Bodies, BodyKind};
use crate::contact::Manifolds;
use crate::lanes::{Lanes, Real};

impl<L: Lanes> Avbd<L> {
    /// Colours the bodies that touch and lists their contacts; to be called when the graph of contacts has changed.
    pub(in crate::solve) fn cut(&mut self, bodies: &Bodies<L::Elem>, manifolds: &Manifolds<L::Elem>) {
        let moves = |slot: u32| bodies.kind(slot as usize) == BodyKind::Dynamic;
        self.ahead.resize(bodies.len() * 4);
        self.target.resize(bodies.len() * 4);
        self.starts.clear();
        self.starts.resize(bodies.len() + 1, 0);
        for &at in manifolds.touching() {
            for slot in manifolds.slots(at as usize) {
                self.starts[slot as usize + 1] += 1;
            }
        }
        for k in 1..self.starts.len() {
            self.starts[k] += self.starts[k - 1];
        }
        self.contacts.clear();
        self.contacts.resize(2 * manifolds.len(), 0);
        for &at in manifolds.touching() {
            for slot in manifolds.slots(at as usize) {
                let next = &mut self.starts[slot as usize];
                self.contacts[*next as usize] = at;
                *next += 1;
            }
        }
        // Each start has run to its end: back by one body.
        self.starts.rotate_right(1);
        self.starts[0] = 0;
        self.color.clear();
        self.color.resize(bodies.len(), u8::MAX);
        for slot in 0..bodies.len() as u32 {
            let mine = self.starts[slot as usize] as usize..self.starts[slot as usize + 1] as usize;
            if mine.is_empty() || !moves(slot) {
                continue;
            }
            let taken = self.contacts[mine].iter().flat_map(|&at| manifolds.slots(at as usize)).fold(
                0u64,
                |taken, other| {
                    let color = self.color[other as usize];
                    if usize::from(color) < COLORS { taken | 1 << color } else { taken }
                },
            );
            self.color[slot as usize] = (taken.trailing_ones() as usize).min(COLORS - 1) as u8;
        }
        self.batch(bodies, manifolds);
        self.list_pairs(manifolds);
    }

    pub(super) fn batch(&mut self, bodies: &Bodies<L::Elem>, manifolds: &Manifolds<L::Elem>) {
        self.slots.clear();
        self.batches.clear();
        self.place.clear();
        self.other.clear();
        self.side.clear();
        for color in 0..COLORS {
            let width = if color + 1 == COLORS { 1 } else { L::WIDTH };
            let mut members =
                (0..bodies.len()).filter(|&slot| usize::from(self.color[slot]) == color).peekable();
            if members.peek().is_none() {
                continue;
            }
            let mut batch = [0u32; 16];
            loop {
                let mut count = 0;
                for (entry, slot) in batch[..width].iter_mut().zip(&mut members) {
                    *entry = slot as u32;
                    count += 1;
                }
                if count == 0 {
                    break;
                }
                let (starts, contacts) = (&self.starts, &self.contacts);
                let of =
                    |slot: u32| &contacts[starts[slot as usize] as usize..starts[slot as usize + 1] as usize];
                let visits = batch[..count].iter().map(|&slot| of(slot).len()).max().unwrap_or(0);
                let start = self.side.len();
                for visit in 0..visits {
                    let mut side = [L::Elem::ZERO; 16];
                    for lane in 0..L::WIDTH {
                        let at = if lane < count { of(batch[lane]).get(visit).copied() } else { None };
                        let (place, other) = match at {
                            Some(at) => {
                                let [a, b] = manifolds.slots(at as usize);
                                side[lane] = if b == batch[lane] { L::Elem::ONE } else { -L::Elem::ONE };
                                (at, if b == batch[lane] { a } else { b })
                            }
                            None => (manifolds.padding(), 0),
                        };
                        self.place.push(place);
                        self.other.push(other);
                    }
                    self.side.push(L::load(&side));
                }
                self.batches.push(Batch { start, end: self.side.len() });
                self.slots.extend_from_slice(&batch[..count]);
                self.slots.resize(self.batches.len() * L::WIDTH, 0);
            }
        }
    }

    pub(super) fn list_pairs(&mut self, manifolds: &Manifolds<L::Elem>) {
        for list in &mut self.pairs {
            list.clear();
        }
        for &at in manifolds.touching() {
            let [a, b] = manifolds.slots(at as usize);
            for (list, entry) in self.pairs.iter_mut().zip([at, a, b]) {
                list.push(entry);
            }
        }
        let padded = manifolds.len().next_multiple_of(L::WIDTH);
        for (list, entry) in self.pairs.iter_mut().zip([manifolds.spill(), 0, 0]) {
            list.resize(padded, entry);
        }
    }
}
