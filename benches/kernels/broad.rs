//! Candidate pairs of a settled pile, method by method.

use std::rc::Rc;

use lamina2d::internals::{BroadPhase, PlainWorld, find_at};
use lamina2d::lanes::Lanes;
use lamina2d::settings::Broad;

use super::{Kernel, SIZES, Stage, answer_of, list_widths, margin};
use crate::common::{Answer, SETTLE_STEPS};

/// Candidate pairs, found anew in each call.
struct Pairs {
    world: Rc<PlainWorld>,
    method: Broad,
}

impl Stage for Pairs {
    type Memory<L: Lanes<Elem = f32>> = BroadPhase<f32>;

    fn elements(&self) -> usize {
        self.world.bodies().live()
    }

    fn memory<L: Lanes<Elem = f32>>(&self) -> BroadPhase<f32> {
        BroadPhase::default()
    }

    fn run<L: Lanes<Elem = f32>>(&self, broad: &mut BroadPhase<f32>) {
        find_at(L::WIDTH, broad, self.world.bodies(), self.method, margin());
    }

    fn answer<L: Lanes<Elem = f32>>(&self, broad: &BroadPhase<f32>) -> Answer {
        let pairs = broad.pairs();
        answer_of(pairs.len(), pairs.iter().flatten().map(|&slot| u64::from(slot)))
    }
}

/// Every method that looks for pairs.
pub(super) fn list(kernels: &mut Vec<Kernel>) {
    for size in SIZES {
        for method in [Broad::Brute, Broad::Sweep, Broad::Grid] {
            // The methods must give the same pairs in the same order.
            list_widths(
                kernels,
                &format!("broad/{method}/{size}"),
                &format!("broad/{size}"),
                move |settled| Pairs { world: settled.get(&format!("circles/{size}"), SETTLE_STEPS), method },
            );
        }
    }
}
