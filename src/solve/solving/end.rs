//! What a step ends with: bounces, and what was deep in something else moved out of it.

use super::Solving;
use crate::contact::Manifolds;
use crate::each::Each as _;
use crate::lanes::{Lanes, Real};
use crate::motion::{Motion, TOUCH};
use crate::settings::Solver;
use crate::solve::bounce::{self, Bouncing, MoveOut};
use crate::solve::joint::Stiffness;
use crate::solve::{SolverContext, deep, soft};
use crate::workers::Workers;

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
            if self.bounce(context, motion, settled) && self.in_rows {
                self.stream.write_rows(manifolds, None);
            }
        }
        if self.deep.steps > 0 && context.solver == Solver::Soft {
            self.deep.steps = if self.part_deep(motion, settled) { self.deep.steps - 1 } else { 0 };
        }
        self.behind = !settled;
    }

    /// Gives bounces their impulses and displacements; says whether there were any.
    ///
    /// What joints hold bounces as they let it: they take from a bounce what would part them, and it is given again, first of its
    /// displacements and then of its velocities, seen from where joints are by then. An impact is no load for them to go on with.
    fn bounce(
        &mut self,
        context: &SolverContext<'_, L::Elem>,
        motion: &mut Motion<L::Elem>,
        settled: bool,
    ) -> bool {
        // Left as zeros by what was displaced before.
        self.bouncing.displaced.resize(motion.velocity.fours().len(), [L::Elem::ZERO; 4]);
        self.bouncing.mark_jointed(&self.joints, motion.velocity.fours().len());
        let Some(jointed) = self.bounce_once(motion, settled) else { return false };
        if jointed {
            self.displace_with_joints(context, motion, settled);
            let [h_secs, share] = [context.plan.h_secs, context.plan.impulse_share()];
            let how = Stiffness::soft(h_secs, share);
            self.joints.note();
            for _ in 0..bounce::ROUNDS {
                self.joints.relax_velocities(motion.velocity.fours_mut(), &how);
                self.bounce_once(motion, settled);
            }
            self.joints.relax_velocities(motion.velocity.fours_mut(), &how);
            self.joints.restore();
        }
        let Self { bouncing: Bouncing { displaced, .. }, stream, .. } = self;
        let (rows, moved) = (motion.velocity.fours(), (!settled).then_some(motion.moved.fours()));
        stream.each(|first, contacts| {
            let (rows, displaced) = (&rows[first..], &mut displaced[first..]);
            let moved = moved.map(|moved| &moved[first..]);
            let entered = bounce::by_bounces::<L>;
            contacts.visit(&mut MoveOut { rows, displaced, moved, entered, any: false });
        });
        self.displace(motion, settled);
        true
    }

    /// One round over the contacts that bounce: `None` where none does, else whether joints hold one of their bodies.
    fn bounce_once(&mut self, motion: &mut Motion<L::Elem>, settled: bool) -> Option<bool> {
        let Self { bouncing: Bouncing { displaced, bounces, jointed, .. }, stream, .. } = self;
        let (rows, moved) = (motion.velocity.fours_mut(), (!settled).then_some(motion.moved.fours()));
        let touch = L::lit(TOUCH);
        let (mut any, mut any_jointed) = (false, false);
        stream.each(|first, contacts| {
            let mut pass = bounce::Bounce {
                rows: &mut rows[first..],
                displaced: &mut displaced[first..],
                touch,
                moved: moved.map(|moved| &moved[first..]),
                bounces,
                jointed: &jointed[first..],
                any,
                any_jointed,
            };
            contacts.visit(&mut pass);
            (any, any_jointed) = (pass.any, pass.any_jointed);
        });
        any.then_some(any_jointed)
    }

    /// Joints take from what bounces displace what would part them: a displacement is to its push what a velocity is to its
    /// impulse, over a second. They are seen from half-way along it, where a rod is square to the chord of its arc.
    fn displace_with_joints(
        &mut self,
        context: &SolverContext<'_, L::Elem>,
        motion: &mut Motion<L::Elem>,
        settled: bool,
    ) {
        let over_a_second = Stiffness::soft(1.0, context.plan.impulse_share());
        self.joints.note_and_let_go();
        let half = L::Elem::from_f64(0.5);
        for (displaced, row) in self.bouncing.displaced.iter_mut().zip(motion.velocity.fours()) {
            *displaced = displaced.each(|way| way * half);
            displaced[3] = row[3];
        }
        self.joints.follow(&self.bouncing.displaced);
        for displaced in &mut self.bouncing.displaced {
            displaced.iter_mut().take(3).for_each(|way| *way = *way + *way);
        }
        for _ in 0..bounce::ROUNDS {
            self.joints.relax_velocities(&mut self.bouncing.displaced, &over_a_second);
            self.bounce_once(motion, settled);
        }
        self.joints.relax_velocities(&mut self.bouncing.displaced, &over_a_second);
        self.joints.restore();
        self.joints.follow(&self.bouncing.displaced);
    }

    /// Moves what is deep in something else out of it; says whether anything is.
    fn part_deep(&mut self, motion: &mut Motion<L::Elem>, settled: bool) -> bool {
        let Self { bouncing: Bouncing { displaced, .. }, stream, .. } = self;
        let (rows, moved) = (motion.velocity.fours(), motion.moved.fours());
        displaced.resize(rows.len(), [L::Elem::ZERO; 4]);
        let [deep, most] = [deep::DEEP, soft::PUSH_CAP].each(L::lit);
        let entered =
            |[gap, way, mass, length]: [L; 4]| deep::owed(deep * length, most * length, [gap, way, mass]);
        let moved = (!settled).then_some(moved);
        let mut any = false;
        stream.each(|first, contacts| {
            let (rows, displaced) = (&rows[first..], &mut displaced[first..]);
            let mut pass =
                MoveOut { rows, displaced, moved: moved.map(|moved| &moved[first..]), entered, any };
            contacts.visit(&mut pass);
            any = pass.any;
        });
        if any {
            self.displace(motion, settled);
        }
        any
    }

    /// Adds what was displaced to the step's displacements, and leaves zeros.
    fn displace(&mut self, motion: &mut Motion<L::Elem>, settled: bool) {
        let Self { bouncing: Bouncing { displaced, .. }, stream, .. } = self;
        if settled {
            stream.follow_displacements(displaced);
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
            self.stream.prepare((&Workers::ALONE, false), manifolds, motion.inverse_masses.fours(), None);
        }
    }
}
