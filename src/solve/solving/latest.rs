//! Where gaps and impulses of the last step are, and what gaps have yet to hear of.

use crate::lanes::{Lanes, Real};
use crate::motion::Motion;
use crate::solve::constraint::Constraint;
use crate::solve::stream::{Ends, Visit};

/// Where today's gaps and impulses are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Latest {
    /// In the pairs' rows.
    #[default]
    InPairs,
    /// In the constraints.
    InConstraints,
    /// In the constraints, whose gaps have yet to hear of the last displacements.
    BeforeDisplacements,
}

/// Gaps hear of displacements.
pub(super) struct Follow<'a, R> {
    pub(super) moved: &'a [[R; 4]],
}

impl<L: Lanes> Visit<L> for Follow<'_, L::Elem> {
    #[inline(always)]
    fn visit<const POINTS: usize>(&mut self, c: &mut Constraint<L, POINTS>, ends: Ends<'_>, _: usize) {
        c.follow(self.moved, &ends);
    }
}

impl Latest {
    /// The displacements that gaps have yet to hear of; none where a settling pass has told them.
    pub(super) fn yet_to_follow<R: Real>(self, motion: &Motion<R>) -> Option<&[[R; 4]]> {
        (self == Self::BeforeDisplacements).then_some(motion.moved.fours())
    }
}
