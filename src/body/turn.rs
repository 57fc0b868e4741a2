//! Outlines of polygons, turned as their bodies are.

use super::polygons::HullRows;
use super::{Bodies, Form, Polygons};
use crate::lanes::{ROW, Real};
use crate::workers::{Parts, Workers, share_rows};

/// A hull's rows turned by a rotation.
#[inline(always)]
fn turned<R: Real>(body: &HullRows<R>, c: R, s: R) -> HullRows<R> {
    // Fixed-size rows, built whole: the compiler turns each into vectors of the target's width.
    let turn = |x: &[R; ROW], y: &[R; ROW]| -> [[R; ROW]; 2] {
        [crate::each::indexed(|k| c * x[k] - s * y[k]), crate::each::indexed(|k| s * x[k] + c * y[k])]
    };
    let ([x, y], [nx, ny]) = (turn(&body[0], &body[1]), turn(&body[2], &body[3]));
    [x, y, nx, ny]
}

impl<R: Real> Bodies<R> {
    /// Turns the vertices and normals of all polygons into world axes.
    pub fn refresh_polygons(&mut self) {
        self.share_polygons((&Workers::ALONE, &Parts::default()));
    }

    /// [`Bodies::refresh_polygons`] by several workers.
    pub(crate) fn share_polygons(&mut self, (workers, parts): (&Workers, &Parts)) {
        let Polygons { body, world, owner, .. } = &mut self.polygons;
        let (cs, ss) = (self.c.padded(), self.s.padded());
        // Owners mostly ascend; where they do not, another worker turns them.
        let from = parts.map(|slot| owner.partition_point(|&owner| (owner as usize) < slot));
        share_rows((workers, &from), world, |first, world| {
            for ((body, world), &owner) in body[first..].iter().zip(world).zip(&owner[first..]) {
                *world = turned(body, cs[owner as usize], ss[owner as usize]);
            }
        });
    }

    /// Like [`Bodies::refresh_polygons`], for the bodies in some slots.
    pub fn refresh_polygons_in(&mut self, slots: &[u32]) {
        for slot in slots.iter().map(|&slot| slot as usize) {
            if self.form[slot] == Form::Polygon {
                for at in self.shapes(slot) {
                    self.polygons.world[at] = turned(&self.polygons.body[at], self.c[slot], self.s[slot]);
                }
            }
        }
    }
}
