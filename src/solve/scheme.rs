//! What a solver is: what it does to joints and contacts of a substep before bodies move, and after.

use super::avbd::Avbd;
use super::direct::DirectContacts;
use super::joint::{JointStream, Stiffness};
use super::stream::Stream;
use super::{SolverContext, avbd, impulse, pgs, soft, xpbd};
use crate::body::Bodies;
use crate::contact::Manifolds;
use crate::lanes::Lanes;
use crate::motion::Motion;
use crate::settings::Solver;

/// A substep as its solver sees it.
pub(crate) struct Substep<'a, L: Lanes> {
    /// The step.
    pub context: &'a SolverContext<'a, L::Elem>,
    /// Contacts of this substep group.
    pub stream: &'a mut Stream<L>,
    /// Those of them that are solved at once.
    pub direct: &'a mut DirectContacts,
    /// Joints, where this substep group solves them.
    pub joints: Option<&'a mut JointStream<L>>,
    /// Rows and displacements.
    pub motion: &'a mut Motion<L::Elem>,
    /// The first of the step?
    pub first: bool,
    /// Have constraints yet to hear of the last displacements?
    pub behind: bool,
    /// Something is deep, see `deep.rs`.
    pub deep: bool,
    /// Further rounds of joints and contacts, where something meets a body that joints hold; see `bounce.rs`.
    pub rounds: u32,
    /// Of contacts whose step has become shorter: their stiffness over what it will be; 1 to the bit where all steps have
    /// one length.
    pub softened: f64,
    /// This substep over that which joints' impulses belong to.
    pub joint_scale: f64,
}

impl<L: Lanes> Substep<'_, L> {
    /// Joints as the last substep left them, then once more: of solvers that see contacts after bodies have moved.
    pub(super) fn push_joints(&mut self) {
        let (h_secs, share) = (self.h_secs(), self.share());
        let scale = if self.first { self.joint_scale } else { 1.0 };
        if let Some(joints) = &mut self.joints {
            let rows = self.motion.velocity.fours_mut();
            joints.warm_start(rows, scale, share);
            joints.push(rows, None, &Stiffness::soft(h_secs, share));
        }
    }
    /// h, seconds.
    pub(super) fn h_secs(&self) -> f64 {
        self.context.plan.h_secs
    }
    /// What an impulse changes displacements by over h, over what it changes velocities by.
    pub(super) fn share(&self) -> f64 {
        self.context.plan.impulse_share()
    }
}

/// What [`ContactSolver::relax`] may see beside the substep.
pub(crate) struct Pairs<'a, L: Lanes> {
    /// Bodies as the step began.
    pub bodies: &'a Bodies<L::Elem>,
    /// All manifolds.
    pub manifolds: &'a mut Manifolds<L::Elem>,
    /// What `avbd` keeps.
    pub avbd: &'a mut Avbd<L>,
}

/// A solver: one file each, which ends as its recipe.
pub(crate) trait ContactSolver<L: Lanes> {
    /// Before bodies move: velocities and impulses.
    fn solve(&self, substep: &mut Substep<'_, L>);
    /// After bodies have moved: velocities without what kept them apart, or positions.
    fn relax(&self, substep: &mut Substep<'_, L>, pairs: Pairs<'_, L>);
}

/// The solver of a name: where the enum is matched.
pub(crate) fn solver_of<L: Lanes>(solver: Solver) -> &'static dyn ContactSolver<L> {
    match solver {
        Solver::Impulse => &impulse::Impulse,
        Solver::Pgs => &pgs::Pgs,
        Solver::Soft => &soft::Soft,
        Solver::Xpbd => &xpbd::Xpbd,
        Solver::Avbd => &avbd::Blocks,
    }
}
