//! Pairs that are apart and pass each other.
//!
//! **The law.** A contact over a gap takes from the approach along its normal what is more than the gap: right for faces, which
//! go on to all sides, wrong for corners, which do not. So a pair that is apart is a contact only if the way of the one, seen
//! from the other, meets it: convex shapes that move straight meet if, and only if, their shadows along the way do. What turns
//! is given what its outline may gain by that. Asked where bodies are fast enough that a margin looks ahead for them; slower ones
//! come no nearer to a corner than its margin in a step.

use glam::DVec2;

use crate::body::{Bodies, BodyKind, Form};
use crate::each::Each as _;
use crate::lanes::{Lanes, Real};

/// How a step moves what is free.
#[derive(Clone, Copy, Debug)]
pub struct Stride<R> {
    /// Seconds.
    pub secs: R,
    /// What gravity adds to a way, metres.
    pub fallen: [R; 2],
}

/// The hits without those of `lanes` that pass each other in a stride.
#[cold]
#[inline(never)]
pub(super) fn staying<L: Lanes>(
    hits: [L::Mask; 2],
    separations: L,
    bodies: &Bodies<L::Elem>,
    slots: [&[u32]; 2],
    lanes: u32,
    stride: Stride<L::Elem>,
) -> [L::Mask; 2] {
    let separations = separations.to_array();
    let mut passing = [L::Elem::ZERO; 16];
    for lane in crate::lanes::set_lanes(lanes) {
        let ends = [0, 1].each(|end| slots[end][lane] as usize);
        if pass(bodies, ends, separations[lane].to_f64(), stride) {
            passing[lane] = L::Elem::ONE;
        }
    }
    let stays = L::load(&passing).le(L::zero());
    hits.each(|hits| hits & stays)
}

/// Do two bodies, `separation` metres apart, pass each other within a step?
fn pass<R: Real>(bodies: &Bodies<R>, [a, b]: [usize; 2], separation: f64, stride: Stride<R>) -> bool {
    let secs = stride.secs.to_f64();
    let falls = |slot: usize| if bodies.kind(slot) == BodyKind::Dynamic { 1.0 } else { 0.0 };
    let fallen = falls(b) - falls(a);
    let way = |column: &crate::column::Column<R>, k: usize| {
        (column[b] - column[a]).to_f64() * secs + fallen * stride.fallen[k].to_f64()
    };
    let way = DVec2::new(way(&bodies.vx, 0), way(&bodies.vy, 1));
    // Not a bare root: its last bit decides where discs stand exactly one above the other.
    let length = way.x.hypot(way.y);
    let turned = [a, b].each(|slot| turning(bodies, slot) * secs);
    // What does not come that far closes nothing, and where it goes says nothing: resting bodies tremble.
    if length <= separation {
        return false;
    }
    let across = way.perp() / length;
    let apart = (DVec2::from(bodies.place(b)) - DVec2::from(bodies.place(a))).dot(across);
    // No shadow is longer than its bounding circle's, but for rounding.
    let most = (bodies.radius[a] + bodies.radius[b]).to_f64() * (1.0 + 1e-5);
    if apart.abs() > most + turned[0] + turned[1] {
        return true;
    }
    // From A towards B, and from B towards A.
    let along = if apart < 0.0 { -across } else { across };
    let shadows = bodies.extent(a, along) + bodies.extent(b, -along);
    apart.abs() > shadows + turned[0] + turned[1]
}

/// How fast turning may carry a body's outline outwards, m/s.
fn turning<R: Real>(bodies: &Bodies<R>, slot: usize) -> f64 {
    if bodies.form(slot) == Form::Circle {
        0.0
    } else {
        (bodies.w[slot] * bodies.radius[slot]).to_f64().abs()
    }
}
