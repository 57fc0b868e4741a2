//! What a step ends with: bounces, and what was deep in something else moved out of it.

use super::{Follow, Solving};
use crate::contact::Manifolds;
use crate::each::Each as _;
use crate::lanes::{Lanes, Real};
use crate::motion::Motion;
use crate::settings::Solver;
use crate::solve::bounce::{self, Bouncing, MoveOut};
use crate::solve::joint::Stiffness;
use crate::solve::{SolverContext, deep, soft};

impl<L: Lanes> Solving<L> {
    /// After the last substep: bounces, and deep overlaps.
    pub fn end(
        &mut self,
        context: &SolverContext<'_, L::Elem>,
        manifolds: &mut Manifolds<L::Elem>,
        motion: &mut Motion<L::Elem>,
    ) {
        let settled =
            self.substep_groups.count() > 1 || matches!(context.solver, Solver::Xpbd | Solver::Avbd);
        if self.bouncing.any {
            self.take_rows(manifolds, motion);
            if self.bounce(context, motion, settled) {
                self.bounce_with_joints(context, motion, settled);
                if self.in_rows {
                    self.stream.write_rows(manifolds, None);
                }
            }
        }
        if self.deep.steps > 0 && context.solver == Solver::Soft {
            self.deep.steps = if self.part_deep(context, motion, settled) { self.deep.steps - 1 } else { 0 };
        }
        self.behind = !settled;
    }

    /// Gives bounces their impulses and displacements; says whether there were any.
    fn bounce(
        &mut self,
        context: &SolverContext<'_, L::Elem>,
        motion: &mut Motion<L::Elem>,
        settled: bool,
    ) -> bool {
        let Self { bouncing: Bouncing { displaced, bounces, .. }, stream, .. } = self;
        let (rows, moved) = (motion.velocity.fours_mut(), motion.moved.fours());
        // Left as zeros by what was displaced before.
        displaced.resize(rows.len(), [L::Elem::ZERO; 4]);
        let before = (!settled).then_some(moved);
        let touch = L::lit(context.needs.touch());
        let mut pass = bounce::Bounce { rows, displaced, touch, moved: before, bounces, any: false };
        stream.visit(&mut pass);
        if !pass.any {
            return false;
        }
        let entered = bounce::by_bounces::<L>;
        stream.visit(&mut MoveOut { rows, displaced, moved: before, entered, any: false });
        self.displace(motion, settled);
        true
    }

    /// What joints hold bounces as they let it: joints take from a bounce what would part them, and it is given again. An
    /// impact is no load for joints to go on with.
    fn bounce_with_joints(
        &mut self,
        context: &SolverContext<'_, L::Elem>,
        motion: &mut Motion<L::Elem>,
        settled: bool,
    ) {
        if self.bouncing.rounds == 0 {
            return;
        }
        let how = Stiffness::soft(context.plan.h_secs, context.plan.impulse_share());
        self.joints.note();
        for _ in 0..self.bouncing.rounds {
            self.joints.relax_velocities(motion.velocity.fours_mut(), &how);
            self.bounce(context, motion, settled);
        }
        self.joints.relax_velocities(motion.velocity.fours_mut(), &how);
        self.joints.restore();
    }

    /// Moves what is deep in something else out of it; says whether anything is.
    fn part_deep(
        &mut self,
        context: &SolverContext<'_, L::Elem>,
        motion: &mut Motion<L::Elem>,
        settled: bool,
    ) -> bool {
        let Self { bouncing: Bouncing { displaced, .. }, stream, .. } = self;
        let (rows, moved) = (motion.velocity.fours(), motion.moved.fours());
        displaced.resize(rows.len(), [L::Elem::ZERO; 4]);
        let [deep, most] = [deep::DEEP, soft::PUSH_CAP].each(|share| L::lit(share * context.needs.length));
        let entered = |gap, way, mass| deep::owed(deep, most, [gap, way, mass]);
        let moved = (!settled).then_some(moved);
        let mut pass = MoveOut { rows, displaced, moved, entered, any: false };
        stream.visit(&mut pass);
        let any = pass.any;
        if any {
            self.displace(motion, settled);
        }
        any
    }

    /// Adds what was displaced to the step's displacements, and leaves zeros.
    fn displace(&mut self, motion: &mut Motion<L::Elem>, settled: bool) {
        let Self { bouncing: Bouncing { displaced, .. }, stream, .. } = self;
        if settled {
            stream.visit(&mut Follow { moved: displaced });
        }
        for (moved, displaced) in motion.moved.fours_mut().iter_mut().zip(displaced) {
            let changes = std::mem::replace(displaced, [L::Elem::ZERO; 4]);
            for (way, change) in moved.iter_mut().zip(changes).take(3) {
                *way += change;
            }
        }
    }

    /// Where the solver works on the pairs: constraints, which note bounces and give them, are made of their rows.
    pub(super) fn take_rows(&mut self, manifolds: &Manifolds<L::Elem>, motion: &Motion<L::Elem>) {
        if self.in_rows {
            self.stream.take_rows(manifolds);
            self.stream.prepare(manifolds, motion.inverse_masses.fours(), None);
        }
    }
}
