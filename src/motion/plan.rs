//! How smooth motion is to be advanced: what a step decides once for all bodies.

use crate::force::Field;
use crate::lanes::Real;
use crate::settings::{Integrator, Skip, Skips};
use crate::workers::Workers;

/// How smooth motion is to be advanced.
#[derive(Clone, Copy, Debug)]
pub struct Plan<'a, R> {
    /// The scheme.
    pub integrator: Integrator,
    /// The fields present.
    pub fields: &'a [Field<R>],
    /// Seconds per substep.
    pub h_secs: f64,
    /// From the step's beginning to this substep's, seconds.
    pub since_secs: f64,
    /// Substeps per step.
    pub substeps: u32,
    /// Work that may be left out.
    pub skips: Skips,
    /// Do the solver's rows hold the moving velocity u = displacement/h (else the velocity)?
    pub moving: bool,
    /// Does a substep begin with what contacts changed velocities by in the last?
    pub carries: bool,
    /// Who does it.
    pub workers: &'a Workers,
}

impl<R: Real> Plan<'_, R> {
    /// What an impulse changes the moving velocity by, over what it changes the velocity by: a half where a
    /// scheme moves by the mean of old and new velocity, 1 where by the new one.
    pub fn impulse_share(&self) -> f64 {
        let by_new = matches!(self.integrator, Integrator::ExplicitEuler | Integrator::SemiImplicitEuler);
        if by_new || !self.moving { 1.0 } else { 0.5 }
    }

    /// Does the scheme collapse to its closed form?
    #[inline]
    pub fn collapses(&self) -> bool {
        let staged = !matches!(self.integrator, Integrator::ExplicitEuler | Integrator::SemiImplicitEuler);
        staged && self.skips.has(Skip::ClosedForm) && self.fields.iter().all(Field::is_constant)
    }

    /// Must the stages of all bodies be in step? They are within a block, so all bodies are then one block of the
    /// widest lanes, whatever the width; no width changes a bit.
    #[inline]
    pub fn couples(&self) -> bool {
        self.fields.iter().any(Field::couples)
    }
}
