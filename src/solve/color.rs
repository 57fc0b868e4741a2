//! Colouring: contacts of one colour share no dynamic body, so a batch of lanes may solve them together.
//!
//! Greedy, in the order of the contacts: each takes the lowest colour neither of its dynamic bodies has
//! yet. A body with more than [`COLORS`] contacts overflows; those contacts are solved one at a time,
//! in order, after all colours. Bodies that nothing moves constrain no colour.
//! Within a colour two-point contacts come before one-point contacts, so that each batch has one kind.

use std::ops::Range;

use crate::body::Bodies;
use crate::contact::Manifolds;
use crate::lanes::{Lanes, Real};
use crate::scene::BodyKind;

/// Colours a body can take part in: one bit each.
pub const COLORS: usize = 64;
/// Groups: for each colour its two-point and its one-point contacts.
const GROUPS: usize = 2 * COLORS;

/// Which contacts and bodies the lanes of a batch hold: one gather list each.
///
/// Padding lanes repeat contact 0's geometry between the world and itself: no mass, never scattered.
#[derive(Clone, Copy, Debug)]
pub struct Batch {
    /// Positions in the list of contacts.
    pub contact: [u32; 16],
    /// Slots of the bodies A.
    pub a: [u32; 16],
    /// Slots of the bodies B.
    pub b: [u32; 16],
    /// Lanes in use.
    pub len: usize,
    /// Points of each of these contacts: 1 or 2.
    pub points: usize,
}

impl Batch {
    /// A group's contacts all have as many points as its first; the overflow comes one contact at a time.
    fn new<R: Real>(manifolds: &Manifolds<R>, contacts: &[u32]) -> Self {
        let points = manifolds.keys[contacts[0] as usize].points as usize;
        let mut batch = Self { contact: [0; 16], a: [0; 16], b: [0; 16], len: contacts.len(), points };
        for (lane, &contact) in contacts.iter().enumerate() {
            let key = &manifolds.keys[contact as usize];
            (batch.contact[lane], batch.a[lane], batch.b[lane]) = (contact, key.a, key.b);
        }
        batch
    }
}

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
    batches: Vec<Batch>,
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

    /// Cuts the colours into batches of at most `WIDTH` contacts, for all passes of the step.
    pub fn cut<L: Lanes>(&mut self, manifolds: &Manifolds<L::Elem>) {
        self.batches.clear();
        for group in 0..=GROUPS {
            let width = if group < GROUPS { L::WIDTH } else { 1 };
            let batches = self.order[self.range(group)].chunks(width);
            self.batches.extend(batches.map(|contacts| Batch::new(manifolds, contacts)));
        }
    }

    /// The batches of the last [`Coloring::cut`], colour by colour.
    pub fn batches(&self) -> &[Batch] {
        &self.batches
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
