//! What is measured of a world: stage times, counts, energy and momentum, penetration, state hash.

pub mod momentum;
mod overlap;
pub mod residual;
mod state;
mod stopwatch;

use serde::Serialize;

use crate::body::Bodies;
use crate::broad::BroadCounts;
use crate::contact::Manifolds;
use crate::lanes::Real;
use crate::motion::Skipped;
use crate::settings::Skip;
use crate::solve::SceneNeeds;

pub use overlap::{Outline, Penetration, depths, penetration};
pub use state::{
    Invariants, attraction_energy, first_non_finite, hash_of, invariants, invariants_of, non_finite_in,
    state_hash,
};
pub use stopwatch::StageTimes;
pub(crate) use stopwatch::Stopwatch;

/// The stages of a step, in order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Stage {
    /// Candidate pairs.
    Broad,
    /// Manifolds.
    Narrow,
    /// Colours.
    Prepare,
    /// Prediction, correction, poses.
    Integrate,
    /// Contacts.
    Solve,
    /// Finite check.
    Measure,
}

impl Stage {
    /// All, in order.
    pub const ALL: [Self; 6] =
        [Self::Broad, Self::Narrow, Self::Prepare, Self::Integrate, Self::Solve, Self::Measure];

    /// Its name.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Broad => "broad",
            Self::Narrow => "narrow",
            Self::Prepare => "prepare",
            Self::Integrate => "integrate",
            Self::Solve => "solve",
            Self::Measure => "measure",
        }
    }
}

impl std::fmt::Display for Stage {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.pad(self.name())
    }
}

/// What one step counted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Pairs that passed the broad phase's bounding tests.
    pub candidates: usize,
    /// Pairs handed to the narrow phase.
    pub pairs: usize,
    /// Manifolds with at least one point, those of sleeping bodies included.
    pub contacts: usize,
    /// Bodies that sleep after the step.
    pub sleeping: usize,
    /// Islands they make up.
    pub islands: usize,
    /// The least and the most substeps any body had.
    pub substeps: [u32; 2],
    /// Joints that were solved directly, as masses in their tree or net differ too much for iterative passes.
    pub direct_joints: usize,
    /// Contacts that were solved at once, as masses that hang together by them differ too much for iterative passes.
    pub direct_contacts: usize,
    /// Bodies whose fields a substep of their scheme cannot follow, advanced by what those do exactly: the most in a substep.
    pub stiff: usize,
    /// Per [`Skip`], how many bodies (motion) or contacts (contact terms) it spared work.
    pub skipped: [u64; Skip::ALL.len()],
}

impl Counts {
    pub(crate) fn of<R: Real>(
        found: BroadCounts,
        manifolds: &Manifolds<R>,
        free_flight: bool,
        skipped: Skipped,
        bodies: &Bodies<R>,
        needed: SceneNeeds,
    ) -> Self {
        let contacts = manifolds.len() + manifolds.resting_len();
        let spared = |term_needed: bool| if term_needed { 0 } else { contacts as u64 };
        let mut per_skip = [0; Skip::ALL.len()];
        per_skip[Skip::ClosedForm as usize] = skipped.closed_form;
        per_skip[Skip::Rotation as usize] = skipped.rotation;
        per_skip[Skip::FreeFlight as usize] = if free_flight { bodies.live() as u64 } else { 0 };
        per_skip[Skip::PairList as usize] = if found.kept { bodies.live() as u64 } else { 0 };
        per_skip[Skip::ManifoldReuse as usize] = skipped.manifolds;
        per_skip[Skip::Friction as usize] = spared(needed.friction);
        per_skip[Skip::Restitution as usize] = spared(needed.restitution);
        Self {
            candidates: found.candidates,
            pairs: found.pairs,
            contacts,
            skipped: per_skip,
            ..Self::default()
        }
    }
}
