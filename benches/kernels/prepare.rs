//! Contacts become constraints: colours, batches, masses and levers.

use lamina2d::contact::Home;
use lamina2d::internals::{Motion, Narrow, Solving, Workers};
use lamina2d::lanes::Lanes;
use lamina2d::scene::BodyKind;

use super::pile::Pile;
use super::{Kernel, SIZES, Stage, answer_of, list_widths};
use crate::common::Answer;

/// All contacts of a pile, as if they had all come at once.
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
        // As if they had come just now, each time.
        solving.forget();
        narrow.manifolds.homes_mut().fill(Home::NONE);
        solving.prepare(&self.pile.bodies, narrow.found(), true, (&Workers::ALONE, &self.motion));
    }

    fn answer<L: Lanes<Elem = f32>>(&self, (solving, _): &Self::Memory<L>) -> Answer {
        let order = check_colors(&self.pile, solving);
        answer_of(order.len(), order.into_iter().map(u64::from))
    }
}

/// Every contact is in one colour, and no colour holds a dynamic body twice. Returns the contacts, colour by colour.
fn check_colors<L: Lanes<Elem = f32>>(pile: &Pile, solving: &Solving<L>) -> Vec<u32> {
    let manifolds = &pile.narrow.manifolds;
    let mut contacts_seen = vec![false; manifolds.pairs()];
    let mut order = Vec::new();
    for (overflow, places) in solving.stream().places() {
        let mut bodies_seen = vec![false; pile.bodies.len()];
        for place in places {
            let again = std::mem::replace(&mut contacts_seen[place as usize], true);
            assert!(!again, "the contact at {place} has two colours");
            order.push(place);
            for slot in manifolds.slots(place as usize).map(|slot| slot as usize) {
                let again = std::mem::replace(&mut bodies_seen[slot], true);
                let moves = pile.bodies.kind(slot) == BodyKind::Dynamic;
                assert!(!(again && moves) || overflow, "body {slot} twice in a colour");
            }
        }
    }
    assert!(!manifolds.is_empty(), "nothing touches");
    assert_eq!(order.len(), manifolds.len(), "a contact without a colour");
    order
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
