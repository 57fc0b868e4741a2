//! The pass that ends a step.

use super::{note_fast, path_of, turn_block};
use crate::body::Bodies;
use crate::column::BLOCK;
use crate::each::Each as _;
use crate::lanes::{LaneMask, Lanes};
use crate::motion::{CONTACT_REUSE_DISTANCE, FastBodies, Motion, blocks_in, load_four};

/// Ends a step: velocities go back to their columns, displacements are added to the poses, and bodies that
/// have gone further than [`CONTACT_REUSE_DISTANCE`] of their radius since they last did are noted as having moved, fast ones in `fast`.
/// `speeds`, m/s, that no two bodies' points reach together while no body's reaches half of them: those of
/// [`Outlook`](crate::motion::Outlook).
pub(crate) fn finish<L: Lanes>(
    bodies: &mut Bodies<L::Elem>,
    motion: &mut Motion<L::Elem>,
    mut fast: FastBodies<'_, L::Elem>,
    speeds: [f64; 2],
) {
    let (bound, [half_speculative, half_bouncing]) =
        (L::lit(CONTACT_REUSE_DISTANCE), speeds.each(|speed| L::lit(0.5 * speed)));
    let (mut any_has_moved, mut any_speculative, mut any_bouncing) = (0, 0, 0);
    let is_fine = bodies.fine.is_some();
    let runs = std::mem::take(&mut motion.runs);
    for (start, end) in blocks_in::<L>(&runs) {
        let mut angle = [L::zero(); BLOCK];
        for i in 0..BLOCK {
            let at = start + i;
            if at >= end {
                break;
            }
            let [vx, vy, w, _] = load_four::<L>(&motion.velocity, at);
            let last = load_four::<L>(&motion.moved, at);
            let moved: [L; 3] = crate::each::indexed(|k| motion.total[k].lanes::<L>()[at] + last[k]);
            let radius = bodies.radius.lanes::<L>()[at];
            let path = path_of(moved, radius);
            if let Some(fast) = &mut fast {
                note_fast(bodies, at, path, moved, fast);
            }
            for (column, value) in [(&mut bodies.vx, vx), (&mut bodies.vy, vy), (&mut bodies.w, w)] {
                column.lanes_mut::<L>()[at] = value;
            }
            if is_fine {
                bodies.move_lanes(at, [moved[0], moved[1]]);
            } else {
                for (column, step) in [(&mut bodies.x, moved[0]), (&mut bodies.y, moved[1])] {
                    column.lanes_mut::<L>()[at] = column.lanes::<L>()[at] + step;
                }
            }
            angle[i] = moved[2];
            let speed = (vx.abs() + vy.abs()) + radius * w.abs();
            any_speculative |= half_speculative.le(speed).bits();
            any_bouncing |= half_bouncing.le(speed).bits();
            let drift = motion.drift.lanes::<L>()[at] + path;
            let stirs = (bound * radius).lt(drift);
            motion.drift.lanes_mut::<L>()[at] = L::select(stirs, L::zero(), drift);
            let bits = stirs.bits();
            any_has_moved |= bits;
            for (lane, has_moved) in
                motion.has_moved[at * L::WIDTH..(at + 1) * L::WIDTH].iter_mut().enumerate()
            {
                *has_moved = bits >> lane & 1 == 1;
            }
        }
        turn_block(bodies, start..end, &angle);
    }
    motion.runs = runs;
    motion.outlook.any_has_moved = any_has_moved != 0;
    (motion.outlook.needs_speculative_margin, motion.outlook.may_bounce) =
        (any_speculative != 0, any_bouncing != 0);
}
