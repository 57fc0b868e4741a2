//! The vertices and normals of polygons, in rows that a gather brings whole.

use crate::lanes::{ROW, Real};
use crate::shape::{Shape, edge_normals};

/// A polygon's four rows: x and y of its vertices, x and y of the outward normals of the edges that start
/// there. Entry `k` of a row belongs to vertex or edge `k`.
///
/// Entries past the last repeat entry 0: a repeated axis or vertex changes no minimum and no maximum, so
/// polygons of different counts may share a batch, and the edge from vertex k ends at vertex
/// (k + 1) mod 8 for every count.
pub type HullRows<R> = [[R; ROW]; 4];

/// Vertices and normals of all polygons; one entry per polygon, so that a gather finds its rows together.
#[derive(Clone, Debug, Default)]
pub struct Polygons<R> {
    /// In the body frame, about the centroid.
    pub body: Vec<HullRows<R>>,
    /// In world axes, about the centroid; refreshed each step.
    pub world: Vec<HullRows<R>>,
    /// Vertices.
    pub count: Vec<u8>,
    /// The body that has it; 0 where it is free.
    pub owner: Vec<u32>,
    free: Vec<u32>,
}

impl<R: Real> Polygons<R> {
    pub(super) fn insert(&mut self, shape: &Shape, owner: u32) -> u32 {
        let at = self.free.pop().map_or(self.owner.len(), |at| at as usize);
        if at == self.owner.len() {
            self.body.push([[R::ZERO; ROW]; 4]);
            self.world.push([[R::ZERO; ROW]; 4]);
            self.count.push(0);
            self.owner.push(0);
        }
        let outline = shape.outline();
        let normals = edge_normals(&outline);
        let row = |f: &dyn Fn(usize) -> f64| {
            crate::each::indexed(|k| R::from_f64(f(if k < outline.len() { k } else { 0 })))
        };
        self.body[at] =
            [row(&|k| outline[k].x), row(&|k| outline[k].y), row(&|k| normals[k].x), row(&|k| normals[k].y)];
        self.count[at] = outline.len() as u8;
        self.owner[at] = owner;
        at as u32
    }

    pub(super) fn remove(&mut self, at: u32) {
        self.owner[at as usize] = 0;
        self.free.push(at);
    }

    /// The largest number of vertices of any polygon; 0 without polygons.
    pub fn max_count(&self) -> usize {
        self.count.iter().fold(0, |most, count| most.max(*count)).into()
    }
}
