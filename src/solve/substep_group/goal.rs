//! What islands are paced by, and the number of substeps that comes of it.

use crate::each::Each as _;
use crate::force::Forces;
use crate::lanes::Real;
use crate::settings::{Settings, Solver};
use crate::solve::SolverContext;

/// Numbers of substeps an island may have.
pub(crate) const RUNGS: [u32; 15] = [2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64, 96, 128, 192, 256];

/// A stack that has sagged and needs over so many times the substeps it has had is let fall: its contacts, stiffer rung by
/// rung, would throw it up. Columns with 8 whose prop went after half a second leapt by 0.2 m with a need of 6 times as
/// many, by 4 m with 7, by 39 m with 19.
const HOPELESS: f64 = 6.0;
/// What a lower rung must have to spare.
const SPARE: f64 = 1.25;
/// The same where only slender stacks ask: their need is a bound, and hardly wavers once they stand.
const TOWER_SPARE: f64 = 1.05;

/// What islands are paced by.
#[derive(Clone, Copy, Debug)]
pub struct Goal {
    /// The most a contact may sag, metres; without, no island has fewer than `base`.
    pub max_sag: Option<f64>,
    /// Substeps of bodies that touch nothing.
    pub base: u32,
    /// Seconds per step.
    pub dt_secs: f64,
    /// Of contacts, hz·h.
    pub stiffness: f64,
    /// What an impulse changes displacements by, over what it changes velocities by.
    pub share: f64,
    /// What sinks in by much of its size gets more: neither a bound nor a stiffness was asked for.
    pub holds_up: bool,
}

impl Goal {
    /// What islands of a step are paced by; `None` where all have one number. Bodies that attract each
    /// other must be in step.
    pub fn of<R: Real>(context: &SolverContext<'_, R>, settings: &Settings, forces: &Forces) -> Option<Self> {
        let SolverContext { dt_secs, stiffness, plan, .. } = *context;
        let (max_sag, base, share) = (settings.max_sag, plan.substeps, plan.impulse_share());
        let looks_for_towers =
            context.solver == Solver::Soft && !settings.fixed_substeps && forces.attraction.is_none();
        let paced = max_sag.is_some() || looks_for_towers;
        let holds_up = max_sag.is_none() && settings.stiffness.is_none();
        paced.then_some(Self { max_sag, base, dt_secs, stiffness, share, holds_up })
    }

    /// Substeps with which what is loaded by `load` (N/m_eff·dt, m/s) sags by the bound.
    fn needed(&self, load: f64) -> f64 {
        let omega_h = 2.0 * std::f64::consts::PI * self.stiffness;
        self.max_sag.map_or(0.0, |max_sag| (load * self.dt_secs / (omega_h * omega_h * max_sag)).sqrt())
    }

    /// By how much a contact of an effective mass, kg, gives way under `force`, N, with one substep, metres.
    pub(in crate::solve) fn sinking(&self, force: f64, mass: f64) -> f64 {
        let per_step = 2.0 * std::f64::consts::PI * self.stiffness / self.dt_secs;
        if mass > 0.0 { force * self.share / (mass * per_step * per_step) } else { 0.0 }
    }

    /// How much of what keeps a contact from leaning `moment`, N·m per radian, takes up with one substep; `turn`:
    /// effective mass times length squared, kg·m². Nothing where it has none.
    pub(in crate::solve) fn leaning(&self, moment: f64, turn: f64) -> f64 {
        let per_step = 2.0 * std::f64::consts::PI * self.stiffness / self.dt_secs;
        if turn > 0.0 { moment * self.share / (turn * per_step * per_step) } else { 0.0 }
    }
}

/// The next higher rung.
fn above(substeps: u32) -> u32 {
    RUNGS.into_iter().find(|&n| n > substeps).unwrap_or(substeps)
}

/// The next lower rung.
fn below(substeps: u32) -> u32 {
    RUNGS.into_iter().rev().find(|&n| n < substeps).unwrap_or(RUNGS[0])
}

/// What joints should have that have `held` and need so many: more at once, fewer rung by rung.
pub(super) fn substeps_to_follow(needs: f64, held: u32, looked: bool) -> u32 {
    if needs > f64::from(held) {
        return RUNGS.into_iter().find(|&n| f64::from(n) >= needs).unwrap_or(RUNGS[RUNGS.len() - 1]);
    }
    let lower = below(held);
    if !looked || needs * SPARE > f64::from(lower) { held } else { lower }
}

/// What an island is known to be.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Island {
    /// N/m_eff·dt of its hardest contact, m/s: what both of the last looks saw, and what one of them did.
    pub(super) load: [f64; 2],
    /// Substeps its most slender stack takes.
    pub(super) slender_stack: f64,
    /// Substeps with which what presses hard does not sink in. It gets them rung by rung: it has sunk in by then.
    pub(super) sinking: f64,
    /// Some of it holds on to itself in rings: a pile, which is not weighed.
    pub(super) ringed: bool,
    /// The most a part of it has had.
    pub(super) substeps: u32,
    /// Something touches or is joined.
    pub(super) touches: bool,
    /// Something is joined.
    pub(super) joined: bool,
}

/// What an island should have after a look; `fresh`: before it has sagged.
pub(super) fn aimed(goal: &Goal, island: &Island, fresh: bool) -> u32 {
    let hopeless = !fresh && island.slender_stack > HOPELESS * f64::from(island.substeps);
    let slender_stack = if hopeless { 0.0 } else { island.slender_stack };
    let sinking = if hopeless || island.ringed { 0.0 } else { island.sinking };
    if fresh && slender_stack > f64::from(island.substeps) {
        let enough = RUNGS.into_iter().find(|&n| f64::from(n) >= slender_stack);
        return enough.unwrap_or(RUNGS[RUNGS.len() - 1]).max(island.substeps);
    }
    let [both, either] = island.load.each(|load| goal.needed(load).max(slender_stack).max(sinking));
    let (least, spare) = if goal.max_sag.is_some() { (RUNGS[0], SPARE) } else { (goal.base, TOWER_SPARE) };
    let lower = below(island.substeps).max(least);
    if both > f64::from(island.substeps) {
        above(island.substeps)
    } else if either * spare <= f64::from(lower) {
        lower
    } else {
        island.substeps
    }
}
