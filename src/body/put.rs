//! Bodies that are put elsewhere, or given another velocity, between steps.

use super::check::Checker;
use super::{Bodies, BodyError, BodyId, BodyKind};
use crate::lanes::Real;
use crate::vec2::Rot;

impl<R: Real> Bodies<R> {
    /// Puts a body's centroid somewhere (metres) and turns it (rad); what is left out stays as it is.
    ///
    /// # Errors
    /// An id whose body is gone, a body that goes round a pivot, a number that is not finite or out of reach. Nothing has
    /// changed then.
    pub fn set_pose(
        &mut self,
        id: BodyId,
        position: Option<[f64; 2]>,
        angle: Option<f64>,
    ) -> Result<(), BodyError> {
        let slot = self.check_free(id)?;
        let checker = Checker { body: slot - 1 };
        for value in position.into_iter().flatten() {
            checker.finite::<R>("position", value)?;
            checker.near::<R>("position", value)?;
        }
        if let Some(angle) = angle {
            checker.finite::<R>("angle", angle)?;
            let turn = Rot::<f64>::from_angle(angle % std::f64::consts::TAU);
            (self.c[slot], self.s[slot]) = (R::from_f64(turn.c), R::from_f64(turn.s));
        }
        if let Some(position) = position {
            self.set_place(slot, position);
        }
        self.revision += 1;
        // What was known of its pairs is as if it had come anew.
        self.removals += 1;
        Ok(())
    }

    /// Gives a kinematic or dynamic body a velocity (m/s, rad/s); what is left out stays as it is.
    ///
    /// # Errors
    /// An id whose body is gone, a body that is static or goes round a pivot, a number that is not finite. Nothing has
    /// changed then.
    pub fn set_velocity(
        &mut self,
        id: BodyId,
        velocity: Option<[f64; 2]>,
        angular_velocity: Option<f64>,
    ) -> Result<(), BodyError> {
        let slot = self.check_free(id)?;
        if self.kind[slot] == BodyKind::Static {
            return Err(BodyError::StaticInSlot(id.slot));
        }
        let checker = Checker { body: slot - 1 };
        for value in velocity.into_iter().flatten() {
            checker.finite::<R>("velocity", value)?;
        }
        if let Some(value) = angular_velocity {
            checker.finite::<R>("angular_velocity", value)?;
            self.w[slot] = R::from_f64(value);
        }
        if let Some([x, y]) = velocity {
            (self.vx[slot], self.vy[slot]) = (R::from_f64(x), R::from_f64(y));
        }
        Ok(())
    }

    /// The slot of a living body that no pivot takes along.
    fn check_free(&self, id: BodyId) -> Result<usize, BodyError> {
        let slot = self.check_alive(id)?;
        if self.drives.has(slot) { Err(BodyError::Driven(id.slot)) } else { Ok(slot) }
    }
}
