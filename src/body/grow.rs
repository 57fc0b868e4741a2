//! What all columns share: room for one more body, the inert state, bytes.

use super::BodyKind;
use super::{Bodies, Filter, Form, HullRows};
use crate::column::Column;
use crate::lanes::Real;

impl<R: Real> Bodies<R> {
    /// Bytes held by columns and polygon rows.
    pub fn bytes(&self) -> usize {
        let columns = [
            &self.x,
            &self.y,
            &self.c,
            &self.s,
            &self.vx,
            &self.vy,
            &self.w,
            &self.inv_mass,
            &self.inv_inertia,
            &self.extent_x,
            &self.extent_y,
            &self.radius,
            &self.core,
            &self.friction,
            &self.restitution,
        ];
        let force = self.force.iter().flatten().map(Column::bytes).sum::<usize>();
        let fine = self.fine.as_ref().map_or(0, Column::bytes);
        let rows = self.polygons.owner.len() * (2 * size_of::<HullRows<R>>() + 5);
        let cold = self.len() * (2 + 2 * 4 + size_of::<Filter>() + 1);
        columns.iter().map(|c| c.bytes()).sum::<usize>() + force + fine + rows + cold + self.drives.bytes()
    }

    pub(super) fn grow(&mut self) -> usize {
        let slot = self.len();
        for column in [
            &mut self.x,
            &mut self.y,
            &mut self.c,
            &mut self.s,
            &mut self.vx,
            &mut self.vy,
            &mut self.w,
            &mut self.inv_mass,
            &mut self.inv_inertia,
            &mut self.extent_x,
            &mut self.extent_y,
            &mut self.radius,
            &mut self.core,
            &mut self.friction,
            &mut self.restitution,
        ] {
            column.resize(slot + 1);
        }
        for column in self.force.iter_mut().flatten() {
            column.resize(slot + 1);
        }
        self.resize_fine(slot + 1);
        self.form.push(Form::Circle);
        self.kind.push(BodyKind::Static);
        self.shape_start.push(0);
        self.filter.push(Filter::default());
        self.generation.push(0);
        self.alive.push(false);
        slot
    }

    /// Padding, said once: no mass, no extent, out of reach, in no category.
    pub(super) fn make_inert(&mut self, slot: usize) {
        for column in [
            &mut self.s,
            &mut self.vx,
            &mut self.vy,
            &mut self.w,
            &mut self.inv_mass,
            &mut self.inv_inertia,
            &mut self.extent_x,
            &mut self.extent_y,
            &mut self.radius,
            &mut self.friction,
            &mut self.restitution,
        ] {
            column[slot] = R::ZERO;
        }
        self.c[slot] = R::ONE;
        self.set_place(slot, [R::FAR.to_f64(); 2]);
        self.core[slot] = R::FAR;
        self.form[slot] = Form::Circle;
        self.kind[slot] = BodyKind::Static;
        self.filter[slot] = Filter::default();
        self.alive[slot] = false;
    }

    pub(super) fn write_force(&mut self, slot: usize, values: [f64; 3]) {
        if self.force.is_none() && values != [0.0; 3] {
            self.force = Some(std::array::from_fn(|_| Column::filled(self.x.len(), R::ZERO)));
        }
        if let Some(columns) = &mut self.force {
            for (column, value) in columns.iter_mut().zip(values) {
                column[slot] = R::from_f64(value);
            }
        }
    }
}
