//! Colouring: contacts of one colour share no dynamic body, so a batch of lanes may solve them together.
//!
//! A contact keeps its colour while its bodies touch; new ones take, in the order of pairs, the lowest colour
//! neither of their dynamic bodies has yet. A body with more than [`COLORS`] contacts overflows; those are
//! solved one at a time, in order, after all colours. Bodies that nothing moves constrain no colour.

use crate::body::{Bodies, BodyKind};
use crate::lanes::Real;

/// Colours a body can take part in: one bit each. The number of the overflow, too.
pub(crate) const COLORS: usize = 64;

/// Which colours each body has; memory is kept from step to step.
#[derive(Clone, Debug, Default)]
pub(super) struct Colors {
    /// Per slot. Of bodies that nothing moves nobody asks.
    used: Vec<u64>,
}

impl Colors {
    /// Forgets all contacts.
    pub(super) fn clear(&mut self) {
        self.used.clear();
    }

    /// The colour of a new contact of two slots; [`COLORS`] where there is none left.
    pub(super) fn take<R: Real>(&mut self, slots: [u32; 2], bodies: &Bodies<R>) -> usize {
        if self.used.len() < bodies.len() {
            self.used.resize(bodies.len(), 0);
        }
        let mut taken = 0;
        for slot in slots {
            if bodies.kind(slot as usize) == BodyKind::Dynamic {
                taken |= self.used[slot as usize];
            }
        }
        let color = taken.trailing_ones() as usize;
        if color < COLORS {
            for slot in slots {
                self.used[slot as usize] |= 1 << color;
            }
        }
        color
    }

    /// A contact with this colour is no more.
    pub(super) fn free(&mut self, slots: [u32; 2], color: usize) {
        if color < COLORS {
            for slot in slots {
                self.used[slot as usize] &= !(1 << color);
            }
        }
    }
}
