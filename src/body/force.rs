//! Impulses, and the constant forces of single bodies.

use super::{Bodies, BodyError, BodyId, BodyKind};
use crate::each::Each as _;
use crate::lanes::Real;

impl<R: Real> Bodies<R> {
    /// Adds a linear impulse (N·s) at the centroid and an angular one (N·m·s).
    ///
    /// # Errors
    /// An id whose body is gone, a body that is not dynamic, an impulse that is not finite.
    pub fn apply_impulse(&mut self, id: BodyId, linear: [f64; 2], angular: f64) -> Result<(), BodyError> {
        let slot = self.check_alive(id)?;
        if self.kind[slot] != BodyKind::Dynamic {
            return Err(BodyError::NotDynamic(id.slot));
        }
        for value in [linear[0], linear[1], angular] {
            if !R::from_f64(value).is_finite() {
                return Err(BodyError::NonFiniteInSlot { slot: id.slot, field: "impulse", value });
            }
        }
        self.vx[slot] += R::from_f64(linear[0]) * self.inv_mass[slot];
        self.vy[slot] += R::from_f64(linear[1]) * self.inv_mass[slot];
        self.w[slot] += R::from_f64(angular) * self.inv_inertia[slot];
        Ok(())
    }

    /// Sets the constant force (N) and torque (N·m) on a body. May be done in every step: nothing is looked over for it but what
    /// stands on what.
    ///
    /// # Errors
    /// An id whose body is gone, a value that is not finite.
    pub fn set_force(&mut self, id: BodyId, force: [f64; 2], torque: f64) -> Result<(), BodyError> {
        let slot = self.check_alive(id)?;
        for (field, value) in [("force", force[0]), ("force", force[1]), ("torque", torque)] {
            if !R::from_f64(value).is_finite() {
                return Err(BodyError::NonFiniteInSlot { slot: id.slot, field, value });
            }
        }
        let had_none = self.force.is_none();
        self.write_force(slot, [force[0], force[1], torque]);
        self.pushes += 1;
        // Forces of bodies are a field from now on.
        self.revision += u64::from(had_none && self.force.is_some());
        Ok(())
    }

    /// The constant force (N, N) and torque (N·m) on the body in a slot.
    pub fn force_on(&self, slot: usize) -> [R; 3] {
        self.force.as_ref().map_or([R::ZERO; 3], |columns| columns.each_ref().each(|column| column[slot]))
    }
}
