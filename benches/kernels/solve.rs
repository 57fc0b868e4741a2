//! One solver's pass over the contacts of a pile, and what it leaves read out.

use lamina2d::internals;
use lamina2d::lanes::Lanes;
use lamina2d::settings::Solver;

use super::pile::{Memory, Pile, State, context};
use super::{Kernel, SIZES, Stage, answer_of, bits, list_widths};
use crate::common::Answer;

/// Which part of a substep is the call.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Part {
    /// [`Solving::solve`]: before bodies move.
    Solve,
    /// [`Solving::settle`]: after.
    Settle,
    /// [`Solving::write_rows`]: when the step is over and somebody asks.
    Store,
}

/// One substep's contacts of a pile.
struct Pass {
    solver: Solver,
    part: Part,
    pile: Pile,
}

impl Pass {
    /// Everything as the part finds it in a step's first substep under gravity.
    fn begin<L: Lanes<Elem = f32>>(&self) -> State<L> {
        let (plan, bodies) = (self.pile.plan(self.solver), &self.pile.bodies);
        let context = context(self.solver, &plan);
        let (solving, manifolds) = self.pile.solving::<L>();
        let mut state = State { motion: self.pile.motion(), manifolds, solving };
        let State { motion, manifolds, solving } = &mut state;
        let warm = solving.begin(&context, bodies, manifolds, motion);
        internals::predict::<L>(&plan, bodies, motion, warm);
        if self.part == Part::Solve {
            return state;
        }
        solving.solve(&context, motion, true);
        assert!(internals::advance::<L>(&plan, motion), "a substep that stays finite");
        if self.part == Part::Settle && self.solver == Solver::Avbd {
            // It cuts bodies into batches in its first pass after contacts have changed: not what a pass is.
            let untouched = (state.motion.clone(), state.manifolds.clone());
            state.solving.relax(&context, bodies, &mut state.manifolds, &mut state.motion);
            (state.motion, state.manifolds) = untouched;
        }
        if self.part == Part::Store {
            let State { motion, manifolds, solving } = &mut state;
            solving.relax(&context, bodies, manifolds, motion);
            solving.end(&context, manifolds, motion);
        }
        state
    }
}

impl Stage for Pass {
    type Memory<L: Lanes<Elem = f32>> = Memory<L>;

    /// A second pass would find the contacts solved.
    const RESETS: bool = true;

    fn elements(&self) -> usize {
        self.pile.narrow.manifolds.len()
    }

    fn memory<L: Lanes<Elem = f32>>(&self) -> Memory<L> {
        Memory::new(self.begin())
    }

    fn reset<L: Lanes<Elem = f32>>(&self, memory: &mut Memory<L>) {
        memory.reset();
    }

    fn run<L: Lanes<Elem = f32>>(&self, Memory { now, .. }: &mut Memory<L>) {
        let plan = self.pile.plan(self.solver);
        let context = context(self.solver, &plan);
        let State { motion, manifolds, solving } = now;
        match self.part {
            Part::Solve => solving.solve(&context, motion, true),
            Part::Settle => solving.relax(&context, &self.pile.bodies, manifolds, motion),
            Part::Store => solving.write_rows(manifolds, motion),
        }
    }

    fn answer<L: Lanes<Elem = f32>>(&self, Memory { before, now }: &Memory<L>) -> Answer {
        let rows = |state: &State<L>| {
            let motion = &state.motion;
            // A displacement's fourth number says nothing, and is the mass where a lane beside it was visited.
            let moved = motion.moved.fours().iter().map(|&[x, y, angle, _]| [x, y, angle, 0.0]);
            let columns = motion.velocity.fours().iter().copied().chain(moved);
            // Rows beside the pairs are where padding lanes write.
            let pairs = state.manifolds.pairs();
            let pairs = state.manifolds.gaps()[..pairs].iter().chain(&state.manifolds.impulses()[..pairs]);
            columns.chain(pairs.copied()).collect::<Vec<[f32; 4]>>()
        };
        let (before, after) = (rows(before), rows(now));
        let changed = after.iter().zip(&before).filter(|(after, before)| after != before);
        answer_of(changed.count(), bits(after.iter().flatten()))
    }
}

/// The passes over contacts: before bodies move, and after.
const PASSES: [(&str, Solver, Part); 7] = [
    ("impulse", Solver::Impulse, Part::Solve),
    ("impulse_settle", Solver::Impulse, Part::Settle),
    ("pgs", Solver::Pgs, Part::Solve),
    ("soft", Solver::Soft, Part::Solve),
    ("soft_settle", Solver::Soft, Part::Settle),
    // These two see contacts only after bodies have moved.
    ("xpbd_settle", Solver::Xpbd, Part::Settle),
    ("avbd_settle", Solver::Avbd, Part::Settle),
];

/// Every pass, and the hand-back, on contacts of one point and mostly of two.
pub(super) fn list(kernels: &mut Vec<Kernel>) {
    let mut pass = |name: &str, solver: Solver, part: Part| {
        for mix in ["circles", "polygons"] {
            for size in SIZES {
                let kernel = format!("{name}/{mix}/{size}");
                list_widths(kernels, &kernel, &kernel, move |settled| Pass {
                    solver,
                    part,
                    pile: Pile::of(settled, mix, size),
                });
            }
        }
    };
    for (name, solver, part) in PASSES {
        pass(&format!("solve/{name}"), solver, part);
    }
    pass("store", Solver::Soft, Part::Store);
}
