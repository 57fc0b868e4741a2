//! Colouring: contacts of one colour share no dynamic body, so a batch of lanes may solve them together.
//!
//! Greedy, in the order of the contacts: each takes the lowest colour neither of its dynamic bodies has
//! yet. A body with more than [`COLORS`] contacts overflows; those contacts are solved one at a time,
//! in order, after all colours. Bodies that nothing moves constrain no colour.
//! Within a colour two-point contacts come before one-point contacts, so that each batch has one kind.

use std::ops::Range;

use crate::body::Bodies;
use crate::contact::Manifolds;
use crate::lanes::Real;
use crate::scene::BodyKind;

/// Colours a body can take part in: one bit each.
pub const COLORS: usize = 64;
/// Groups: for each colour its two-point and its one-point contacts.
const GROUPS: usize = 2 * COLORS;

/// Contacts sorted by colour; memory is kept from step to step.
#[derive(Clone, Debug, Default)]
pub struct Coloring {
    /// Per body slot, the colours it has.
    used: Vec<u64>,
    /// Per contact, its group, or `GROUPS` for overflow.
    group: Vec<u8>,
    order: Vec<u32>,
    /// Start of each group in `order`; the last two entries enclose the overflow.
    starts: Vec<u32>,
}

impl Coloring {
    /// Colours all contacts afresh.
    pub fn run<R: Real>(&mut self, bodies: &Bodies<R>, manifolds: &Manifolds<R>) {
        self.used.clear();
        self.used.resize(bodies.len(), 0);
        self.group.clear();
        self.starts.clear();
        self.starts.resize(GROUPS + 2, 0);
        for key in &manifolds.keys {
            let (a, b) = (key.a as usize, key.b as usize);
            let moves = |slot: usize| bodies.kind(slot) == BodyKind::Dynamic;
            let (mask_a, mask_b) = (self.used[a], self.used[b]);
            let (moves_a, moves_b) = (moves(a), moves(b));
            let taken = if moves_a { mask_a } else { 0 } | if moves_b { mask_b } else { 0 };
            let color = taken.trailing_ones() as usize;
            let group = if color < COLORS {
                let bit = 1 << color;
                self.used[a] |= bit;
                self.used[b] |= bit;
                2 * color + usize::from(key.points == 1)
            } else {
                GROUPS
            };
            self.group.push(group as u8);
            self.starts[group + 1] += 1;
        }
        self.place();
    }

    fn place(&mut self) {
        for group in 0..=GROUPS {
            self.starts[group + 1] += self.starts[group];
        }
        self.order.clear();
        self.order.resize(self.group.len(), 0);
        // Each start moves to its group's end while contacts are placed, then all move back by one group.
        for (contact, &group) in self.group.iter().enumerate() {
            let at = &mut self.starts[group as usize];
            self.order[*at as usize] = contact as u32;
            *at += 1;
        }
        self.starts.copy_within(0..=GROUPS, 1);
        self.starts[0] = 0;
    }

    /// Calls `visit(contacts, points, may_batch)` for each group in order: contacts as positions in the
    /// manifold list, the number of points they have (2 for the overflow, whose points vary), and
    /// whether they may share a batch.
    pub fn for_each_group(&self, mut visit: impl FnMut(&[u32], usize, bool)) {
        for group in 0..GROUPS {
            let range = self.range(group);
            if !range.is_empty() {
                visit(&self.order[range], 2 - group % 2, true);
            }
        }
        let overflow = self.range(GROUPS);
        if !overflow.is_empty() {
            visit(&self.order[overflow], 2, false);
        }
    }

    /// Colours in use.
    pub fn colors(&self) -> usize {
        (0..COLORS).filter(|c| !self.range(2 * c).is_empty() || !self.range(2 * c + 1).is_empty()).count()
    }

    /// Contacts that found no colour.
    pub fn overflow(&self) -> usize {
        self.range(GROUPS).len()
    }

    fn range(&self, group: usize) -> Range<usize> {
        self.starts[group] as usize..self.starts[group + 1] as usize
    }
}
