//! Joints: found where they are, and `soft`'s two passes over them.

use lamina2d::contact::Manifolds;
use lamina2d::internals;
use lamina2d::internals::Solving;
use lamina2d::lanes::Lanes;
use lamina2d::settings::Solver;

use super::pile::{Memory, Pile, State, context};
use super::{Kernel, Stage, answer_of, bits, list_widths};
use crate::common::Answer;

/// Which part of a step is the call.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Part {
    /// [`Solving::prepare_joints`] where nothing but poses has changed.
    Place,
    /// [`Solving::solve`]: before bodies move.
    Push,
    /// [`Solving::settle`]: after.
    Relax,
}

/// A net's joints.
struct Net {
    part: Part,
    pile: Pile,
}

impl Net {
    /// Everything as the part finds it in a step's first substep; the net hangs free: no contact is prepared.
    fn begin<L: Lanes<Elem = f32>>(&self) -> State<L> {
        let Pile { bodies, joints, .. } = &self.pile;
        let plan = self.pile.plan(Solver::Soft);
        let context = context(Solver::Soft, &plan);
        let mut state = State {
            motion: self.pile.motion(),
            solving: Solving::default(),
            // None: nothing touches.
            manifolds: Manifolds::default(),
        };
        let State { motion, solving, manifolds } = &mut state;
        solving.prepare_joints(&context, bodies, joints, (None, 0));
        if self.part == Part::Place {
            return state;
        }
        let warm = solving.begin(&context, bodies, manifolds, motion);
        internals::predict::<L>(&plan, bodies, motion, warm);
        if self.part == Part::Relax {
            solving.solve(&context, motion, true);
            assert!(internals::advance::<L>(&plan, motion), "a substep that stays finite");
        }
        state
    }
}

impl Stage for Net {
    type Memory<L: Lanes<Elem = f32>> = Memory<L>;

    /// A second pass would find the joints solved.
    const RESETS: bool = true;

    fn elements(&self) -> usize {
        self.pile.joints.living().count()
    }

    fn memory<L: Lanes<Elem = f32>>(&self) -> Memory<L> {
        Memory::new(self.begin())
    }

    fn reset<L: Lanes<Elem = f32>>(&self, memory: &mut Memory<L>) {
        memory.reset();
    }

    fn run<L: Lanes<Elem = f32>>(&self, Memory { now, .. }: &mut Memory<L>) {
        let Pile { bodies, joints, .. } = &self.pile;
        let plan = self.pile.plan(Solver::Soft);
        let context = context(Solver::Soft, &plan);
        let State { motion, solving, manifolds } = now;
        match self.part {
            Part::Place => solving.prepare_joints(&context, bodies, joints, (None, 0)),
            Part::Push => solving.solve(&context, motion, true),
            Part::Relax => solving.relax(&context, bodies, manifolds, motion),
        }
    }

    fn answer<L: Lanes<Elem = f32>>(&self, Memory { before, now }: &Memory<L>) -> Answer {
        if self.part == Part::Place {
            // What it writes is seen in what the passes make of it.
            let [pins, rods] = now.solving.joints().batches();
            assert!((pins + rods) * L::WIDTH >= self.elements(), "a joint without a constraint");
            return Answer { count: self.elements(), hash: 0 };
        }
        let (after, before) = (now.motion.velocity.fours(), before.motion.velocity.fours());
        let changed = after.iter().zip(before).filter(|(after, before)| after != before);
        answer_of(changed.count(), bits(after.iter().flatten()))
    }
}

/// Nets of about 150 and 1000 discs after a second of falling into their shape.
pub(super) fn list(kernels: &mut Vec<Kernel>) {
    for (name, part) in [("place", Part::Place), ("push", Part::Push), ("relax", Part::Relax)] {
        for side in [12, 32] {
            let kernel = format!("joints/{name}/{}", side * side);
            list_widths(kernels, &kernel, &kernel, move |settled| Net {
                part,
                pile: Pile::after(settled, &format!("joint_grid/{side}"), 60),
            });
        }
    }
}
