//! Bodies that become static, kinematic or dynamic while they are in a world.

use super::check::Checker;
use super::{Bodies, BodyError, BodyId, Form};
use super::{BodyKind, BodySpec, ShapeSpec};
use crate::lanes::Real;

impl<R: Real> Bodies<R> {
    /// Makes a body static, kinematic or dynamic. It stays where it is; a static one stops, and no kinematic one goes
    /// round its pivot any more. `mass` in kg is that of a dynamic body; where left out, its area times 1 kg/m².
    ///
    /// # Errors
    /// An id whose body is gone, a mass that is not positive and finite. Nothing has changed then.
    pub fn set_kind(&mut self, id: BodyId, kind: BodyKind, mass: Option<f64>) -> Result<(), BodyError> {
        let slot = self.check_alive(id)?;
        let body = slot - 1;
        let spec = BodySpec { kind, mass, ..BodySpec::new(self.shape_spec(slot), [0.0; 2]) };
        let shape = spec.shape.build().map_err(|why| BodyError::Shape { body, why })?;
        let matter = Checker { body }.check::<R>(&spec, &shape)?;
        let dynamic = kind == BodyKind::Dynamic;
        let core = if dynamic { R::from_f64(0.5 * shape.inner_radius()) } else { R::FAR };
        self.inv_mass[slot] = R::from_f64(matter.inv_mass);
        self.inv_inertia[slot] = R::from_f64(matter.inv_inertia);
        self.core[slot] = core;
        if kind == BodyKind::Static {
            for column in [&mut self.vx, &mut self.vy, &mut self.w] {
                column[slot] = R::ZERO;
            }
        }
        if kind != BodyKind::Kinematic {
            self.drives.remove(slot);
        }
        self.kind[slot] = kind;
        self.filter[slot].dynamic = dynamic;
        self.revision += 1;
        // What was known of its pairs is as if it had come anew.
        self.removals += 1;
        Ok(())
    }

    /// The shape in a slot, about its centroid, metres.
    pub fn shape_spec(&self, slot: usize) -> ShapeSpec {
        let extent = [self.extent_x[slot].to_f64(), self.extent_y[slot].to_f64()];
        match self.form(slot) {
            Form::Circle => ShapeSpec::Circle(extent[0]),
            Form::Box => ShapeSpec::Box(extent),
            Form::Polygon => ShapeSpec::Polygon(self.outline_body(slot)),
        }
    }
}
