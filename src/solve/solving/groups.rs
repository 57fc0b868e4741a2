//! Which islands have which number of substeps, and passes over one substep group.

use super::Solving;
use crate::body::{Bodies, BodyKind};
use crate::contact::Manifolds;
use crate::force::Field;
use crate::joint::Joints;
use crate::lanes::{Lanes, Real};
use crate::motion::Motion;
use crate::solve::substep_group::{Goal, SubstepGroups};

impl<L: Lanes> Solving<L> {
    /// As a step begins: reads what contacts carry, and which stand on each other, if it is time to; says whether it was.
    pub fn look(
        &mut self,
        goal: &Goal,
        bodies: (&Bodies<L::Elem>, &[Field<L::Elem>]),
        joints: &Joints<L::Elem>,
    ) -> bool {
        let looked = self.substep_groups.looks(goal);
        if looked {
            // What was in the lists before a flight no longer touches.
            let flew = self.substep_groups.flew;
            let mut loads = goal.max_sag.map(|_| self.substep_groups.reading());
            if let Some(loads) = loads.as_mut().filter(|_| !flew) {
                self.stream.each(|first, contacts| contacts.visit(loads.from(first)));
            }
            let mut touching = self.substep_groups.touching();
            if !flew {
                self.stream.each(|first, contacts| contacts.visit(touching.from(first)));
            }
            self.substep_groups.weigh(goal, bodies, joints.ends(), &self.direct);
        }
        looked
    }

    /// Has some island others than `substeps`?
    pub fn is_paced(&self, substeps: u32) -> bool {
        self.substep_groups.span().is_some_and(|span| span != [substeps; 2])
    }

    /// A step goes by in which nothing touches; `looked`: [`Solving::look`] did.
    pub fn fly(&mut self, looked: bool) {
        self.substep_groups.flew = true;
        self.substep_groups.count_step(looked);
    }

    /// Gives islands their substeps; says whether any has others than before. `looked`: [`Solving::look`] did.
    pub fn decide_substep_groups(
        &mut self,
        (goal, looked): (Goal, bool),
        bodies: &Bodies<L::Elem>,
        manifolds: &mut Manifolds<L::Elem>,
        joints: &Joints<L::Elem>,
        motion: &mut Motion<L::Elem>,
    ) -> bool {
        self.substep_groups.flew = false;
        self.substep_groups.note_swing(&goal, self.joints.swing());
        let wanted = self.substep_groups.wants(&goal, looked);
        let changed = wanted
            && self.substep_groups.decide(&goal, bodies, manifolds, joints.ends(), &motion.runs, looked);
        self.substep_groups.count_step(looked);
        if changed {
            self.catch_up(motion);
            let groups = &self.substep_groups;
            let moves = |slot: &u32| bodies.kind(*slot as usize) == BodyKind::Dynamic;
            let scale = |slots: [u32; 2]| groups.scale(slots.into_iter().find(moves)? as usize);
            let parts = *self.stream.parts();
            self.stream.regroup(manifolds, self.in_rows, (groups, &parts), scale);
            motion.group.of_slot.clone_from(self.substep_groups.index());
        }
        changed
    }

    /// Cuts the world into as many parts as there are workers; says whether it is cut otherwise than before.
    pub fn divide(
        &mut self,
        workers: usize,
        bodies: &Bodies<L::Elem>,
        manifolds: &mut Manifolds<L::Elem>,
        motion: &mut Motion<L::Elem>,
    ) -> bool {
        // What is solved at once is so in the order of lists.
        let count = if self.direct.may_have_any(bodies) { 1 } else { workers };
        let Some(parts) = self.stream.divide(count, bodies, manifolds) else { return false };
        self.catch_up(motion);
        self.stream.regroup(manifolds, self.in_rows, (&self.substep_groups, &parts), |_| None);
        motion.parts = parts;
        true
    }

    /// How often substeps are counted out in a step: once for each number of them.
    pub fn substep_groups(&self) -> &SubstepGroups<L::Elem> {
        &self.substep_groups
    }

    /// Where there are several substep groups: passes go over one, until [`Solving::leave_group`].
    pub fn enter_group(&mut self, substep_group: usize, motion: &mut Motion<L::Elem>) {
        if self.substep_groups.count() > 1 {
            self.substep_group = Some(substep_group);
            self.stream.choose(self.substep_group);
            motion.group.current = Some(L::Elem::from_f64(substep_group as f64));
            std::mem::swap(&mut motion.runs, self.substep_groups.runs_mut(substep_group));
        }
    }

    /// After [`Solving::enter_group`]: passes go over all contacts again. Gaps hear of the last displacements: those of
    /// kinematic bodies will be of another substep when the next step begins.
    pub fn leave_group(&mut self, substep_group: usize, motion: &mut Motion<L::Elem>) {
        if self.substep_group.take().is_some() {
            self.stream.follow_displacements(motion.moved.fours());
            self.stream.choose(None);
            motion.group.current = None;
            std::mem::swap(&mut motion.runs, self.substep_groups.runs_mut(substep_group));
        }
    }
}
