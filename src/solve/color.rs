//! Colouring: contacts of one colour share no dynamic body, so a batch of lanes may solve them together.
//!
//! A contact keeps its colour while its bodies touch; new ones take, in the order of pairs, the lowest colour
//! neither of their dynamic bodies has yet. A body with more than [`COLORS`] contacts overflows; those are
//! solved one at a time, in order, after all colours. Bodies that nothing moves constrain no colour.
//! Within a colour two-point contacts come before one-point contacts, so that each batch has one kind.

use std::ops::Range;

use crate::body::{Bodies, BodyKind};
use crate::contact::Manifolds;
use crate::each::Each as _;
use crate::lanes::Real;

/// Colours a body can take part in: one bit each.
pub(crate) const COLORS: usize = 64;
/// The lanes a colour's last batch is counted with when one-point contacts may join it: the same at every
/// width, so that width never decides which kernel solves a contact.
const JOIN: usize = 8;

/// One colour's contacts, as ranges of [`Coloring::order`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Color {
    /// Solved as two-point contacts.
    pub two: Range<usize>,
    /// Solved as one-point contacts.
    pub one: Range<usize>,
}

/// Contacts sorted by colour; memory is kept from step to step.
#[derive(Clone, Debug, Default)]
pub struct Coloring {
    /// Per body slot, the colours it has.
    used: Vec<u64>,
    /// Places of contacts: colour by colour, two-point ones first.
    order: Vec<u32>,
    colors: Vec<Color>,
    /// The contacts that found no colour, as a range of `order`.
    overflow: Range<usize>,
}

impl Coloring {
    /// Gives each touching pair a colour and sorts them.
    pub fn run<R: Real>(&mut self, bodies: &Bodies<R>, manifolds: &mut Manifolds<R>) {
        if manifolds.is_empty() {
            self.order.clear();
            self.colors.clear();
            self.overflow = 0..0;
            return;
        }
        self.used.clear();
        self.used.resize(bodies.len(), 0);
        let bits = |at: usize, manifolds: &Manifolds<R>| {
            manifolds.slots(at).each(|slot| (slot as usize, bodies.kind(slot as usize) == BodyKind::Dynamic))
        };
        for k in 0..manifolds.len() {
            let at = manifolds.touching()[k] as usize;
            let color = manifolds.color(at);
            if usize::from(color) < COLORS {
                for (slot, _) in bits(at, manifolds) {
                    self.used[slot] |= 1 << color;
                }
            }
        }
        for k in 0..manifolds.len() {
            let at = manifolds.touching()[k] as usize;
            if usize::from(manifolds.color(at)) >= COLORS {
                let ends = bits(at, manifolds);
                let taken =
                    ends.iter().fold(0, |sum, &(slot, moves)| sum | if moves { self.used[slot] } else { 0 });
                let color = taken.trailing_ones() as usize;
                if color < COLORS {
                    for (slot, _) in ends {
                        self.used[slot] |= 1 << color;
                    }
                }
                manifolds.colors_mut()[at] = color as u8;
            }
        }
        self.sort(manifolds);
    }

    /// Counting sort by colour and number of points, stable.
    fn sort<R: Real>(&mut self, manifolds: &Manifolds<R>) {
        let group = |at: u32| {
            let at = at as usize;
            2 * usize::from(manifolds.color(at)) + usize::from(manifolds.code(at).points() == 1)
        };
        let mut ends = [0; 2 * (COLORS + 1)];
        for &at in manifolds.touching() {
            ends[group(at)] += 1;
        }
        let mut start = 0;
        for end in &mut ends {
            (*end, start) = (start, start + *end);
        }
        self.order.clear();
        self.order.resize(manifolds.len(), 0);
        for &at in manifolds.touching() {
            let next = &mut ends[group(at)];
            self.order[*next] = at;
            *next += 1;
        }
        self.colors.clear();
        let mut start = 0;
        for pair in ends[..2 * COLORS].chunks_exact(2) {
            if pair[1] > start {
                self.colors.push(joined(start, pair[0], pair[1]));
            }
            start = pair[1];
        }
        self.overflow = start..manifolds.len();
    }

    /// Places of the contacts, colour by colour, then the overflow.
    pub fn order(&self) -> &[u32] {
        &self.order
    }
    /// The colours in use.
    pub fn colors(&self) -> &[Color] {
        &self.colors
    }
    /// Contacts that found no colour, as a range of [`Coloring::order`].
    pub fn overflow(&self) -> Range<usize> {
        self.overflow.clone()
    }
    /// Bytes held.
    pub fn bytes(&self) -> usize {
        self.used.capacity() * 8 + self.order.capacity() * 4 + self.colors.capacity() * size_of::<Color>()
    }
}

/// One-point contacts are solved as two-point ones (of which one does nothing) where that saves a batch.
fn joined(start: usize, middle: usize, end: usize) -> Color {
    let batches = |count: usize| count.div_ceil(JOIN);
    if batches(middle - start) + batches(end - middle) > batches(end - start) && middle > start {
        Color { two: start..end, one: end..end }
    } else {
        Color { two: start..middle, one: middle..end }
    }
}
