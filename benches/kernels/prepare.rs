//! Contacts become constraints: colours, batches, masses and levers.

use lamina2d::internals::{Motion, Narrow, Solving};
use lamina2d::lanes::Lanes;
use lamina2d::scene::BodyKind;

use super::pile::Pile;
use super::{Kernel, SIZES, Stage, answer_of, list_widths};
use crate::common::Answer;

/// All contacts of a pile, as where the graph of contacts has changed.
struct Prepare {
    pile: Pile,
    motion: Motion<f32>,
}

impl Stage for Prepare {
    type Memory<L: Lanes<Elem = f32>> = (Solving<L>, Narrow<f32>);

    fn elements(&self) -> usize {
        self.pile.narrow.manifolds.len()
    }

    fn memory<L: Lanes<Elem = f32>>(&self) -> Self::Memory<L> {
        (Solving::default(), self.pile.narrow.clone())
    }

    fn run<L: Lanes<Elem = f32>>(&self, (solving, narrow): &mut Self::Memory<L>) {
        solving.prepare(&self.pile.bodies, narrow.found(), true, &self.motion);
    }

    fn answer<L: Lanes<Elem = f32>>(&self, (solving, _): &Self::Memory<L>) -> Answer {
        check_colors(&self.pile, solving);
        let order = solving.coloring().order();
        answer_of(order.len(), order.iter().map(|&place| u64::from(place)))
    }
}

/// Every contact is in one colour, and no colour holds a dynamic body twice.
fn check_colors<L: Lanes<Elem = f32>>(pile: &Pile, solving: &Solving<L>) {
    let (coloring, manifolds) = (solving.coloring(), &pile.narrow.manifolds);
    let mut contacts_seen = vec![false; manifolds.pairs()];
    for color in coloring.colors() {
        let mut bodies_seen = vec![false; pile.bodies.len()];
        for &place in &coloring.order()[color.two.start..color.one.end] {
            let again = std::mem::replace(&mut contacts_seen[place as usize], true);
            assert!(!again, "the contact at {place} has two colours");
            for slot in manifolds.slots(place as usize).map(|slot| slot as usize) {
                let again = std::mem::replace(&mut bodies_seen[slot], true);
                let moves = pile.bodies.kind(slot) == BodyKind::Dynamic;
                assert!(!(again && moves), "body {slot} twice in a colour");
            }
        }
    }
    let colored = contacts_seen.iter().filter(|&&seen| seen).count();
    assert!(!manifolds.is_empty(), "nothing touches");
    assert_eq!(colored + coloring.overflow().len(), manifolds.len(), "a contact without a colour");
}

/// Contacts of one point, and mostly of two.
pub(super) fn list(kernels: &mut Vec<Kernel>) {
    for mix in ["circles", "polygons"] {
        for size in SIZES {
            let kernel = format!("prepare/{mix}/{size}");
            list_widths(kernels, &kernel, &kernel, move |settled| {
                let pile = Pile::of(settled, mix, size);
                Prepare { motion: pile.motion(), pile }
            });
        }
    }
}
