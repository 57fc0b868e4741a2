//! What contacts and joints hold, read out.

use super::Solving;
use crate::contact::{ContactRow, Manifolds};
use crate::lanes::Lanes;
use crate::motion::Motion;
use crate::solve::joint::JointStream;
use crate::solve::stream::Stream;

impl<L: Lanes> Solving<L> {
    /// The manifolds with today's gaps and impulses.
    pub fn brought_up_to_date(
        &self,
        manifolds: &Manifolds<L::Elem>,
        motion: &Motion<L::Elem>,
    ) -> Manifolds<L::Elem> {
        let mut manifolds = manifolds.clone();
        self.write_rows(&mut manifolds, motion);
        manifolds
    }

    /// Writes today's gaps and impulses to the rows of their pairs, for whoever reads those.
    pub fn write_rows(&self, manifolds: &mut Manifolds<L::Elem>, motion: &Motion<L::Elem>) {
        if !self.in_rows {
            self.stream.write_rows(manifolds, self.behind.then_some(motion.moved.fours()));
        }
    }

    /// Tells of each touching pair with its gaps and impulses of the step's end, those of sleeping bodies last.
    pub fn each_contact(
        &self,
        manifolds: &Manifolds<L::Elem>,
        motion: &Motion<L::Elem>,
        mut tell: impl FnMut(&ContactRow<L::Elem>),
    ) {
        let moved = self.behind.then_some(motion.moved.fours());
        self.stream.each_contact(manifolds, moved, self.in_rows, &mut tell);
        manifolds.resting_rows().for_each(|row| tell(&row));
    }

    /// Contacts that were solved directly in the last step.
    pub fn direct_contacts(&self) -> usize {
        self.direct.len()
    }

    /// Joints that are solved directly.
    pub fn direct_joints(&self) -> usize {
        self.joints.direct()
    }

    /// The joints' constraints.
    pub fn joints(&self) -> &JointStream<L> {
        &self.joints
    }
    /// The constraints.
    pub fn stream(&self) -> &Stream<L> {
        &self.stream
    }
}
