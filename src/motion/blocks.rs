//! Columns and rows as blocks of lane values.

use std::ops::Range;

use crate::body::Bodies;
use crate::column::{BLOCK, Column};
use crate::force::Matter;
use crate::lanes::{IN_ORDER, Lanes};
use crate::vec2::Vec2;

/// A vector per body of a block.
pub(crate) type Block<L> = [Vec2<L>; BLOCK];

/// The block of a column that starts at lane value `at`.
#[inline(always)]
pub(crate) fn block<L: Lanes>(column: &Column<L::Elem>, at: usize) -> &[L; BLOCK] {
    column.lanes::<L>()[at..at + BLOCK]
        .try_into()
        .unwrap_or_else(|_| unreachable!("columns are padded to whole blocks"))
}

/// Vectors from two blocks of coordinates.
#[inline(always)]
pub(crate) fn vectors<L: Lanes>(x: &[L; BLOCK], y: &[L; BLOCK]) -> Block<L> {
    crate::each::indexed(|i| Vec2::new(x[i], y[i]))
}

/// The lane values in use of a run of slots.
#[inline(always)]
pub(crate) fn lanes_of<L: Lanes>(run: &Range<usize>) -> Range<usize> {
    run.start / L::WIDTH..run.end.div_ceil(L::WIDTH)
}

/// First lane value of each block in a run of slots.
#[inline]
pub(crate) fn block_starts<L: Lanes>(run: Range<usize>) -> impl Iterator<Item = usize> {
    lanes_of::<L>(&run).step_by(BLOCK)
}

/// First lane value of each block in some runs of slots, and the end of the lane values in use. What lies behind those is
/// padding, which a world of one body would have more of than of anything else.
#[inline]
pub(crate) fn blocks_in<L: Lanes>(runs: &[Range<usize>]) -> impl Iterator<Item = (usize, usize)> {
    let of = |run: Range<usize>| {
        let end = lanes_of::<L>(&run).end;
        block_starts::<L>(run).map(move |start| (start, end.min(start + BLOCK)))
    };
    runs.iter().cloned().flat_map(of)
}

/// The lane values in use of some runs of slots.
pub(crate) fn lanes_in<L: Lanes>(runs: &[Range<usize>]) -> impl Iterator<Item = usize> {
    runs.iter().flat_map(lanes_of::<L>)
}

#[inline(always)]
pub(crate) fn matter<L: Lanes>(bodies: &Bodies<L::Elem>, at: usize) -> Matter<'_, L> {
    let force = bodies.force.as_ref().map(|f| (block(&f[0], at), block(&f[1], at)));
    Matter { inv_mass: block(&bodies.inv_mass, at), force }
}

#[inline(always)]
pub(crate) fn angular_acceleration<L: Lanes>(bodies: &Bodies<L::Elem>, at: usize) -> Option<[L; BLOCK]> {
    let inv_inertia = block::<L>(&bodies.inv_inertia, at);
    bodies.force.as_ref().map(|f| {
        let torque = block::<L>(&f[2], at);
        crate::each::indexed(|i| torque[i] * inv_inertia[i])
    })
}

/// `WIDTH` rows of four, given transposed, to consecutive places.
#[inline(always)]
pub(crate) fn store_four<L: Lanes>(rows: &mut Column<L::Elem>, at: usize, values: [L; 4]) {
    L::scatter_fours(values, &mut rows.fours_mut()[at * L::WIDTH..(at + 1) * L::WIDTH], &IN_ORDER);
}
