//! Clipping: where an incident edge passes over a reference face, in two points without branches.

use super::Found;
use crate::each::Each as _;
use crate::lanes::{LaneMask, Lanes};
use crate::vec2::Vec2;

/// The face of one body that the other is measured from.
#[derive(Clone, Copy, Debug)]
pub(super) struct Reference<L> {
    /// Outward unit normal.
    pub(super) normal: Vec2<L>,
    /// normal · face, from the reference body's centroid.
    pub(super) offset: L,
    /// Where the face begins along its tangent (normal turned a quarter counter-clockwise).
    pub(super) start: L,
    /// The face's length.
    pub(super) length: L,
}

impl<L: Lanes> Found<L> {
    /// Without the points of lanes whose bodies are further apart than `margin` along some axis.
    ///
    /// A batch leaves early when all its lanes are apart, so a lane that is apart must say so too: the
    /// slack of [`PREFER_A`] may have chosen a face along which the bodies still overlap.
    #[inline(always)]
    pub(super) fn unless_apart(mut self, separation: L, margin: L) -> Self {
        let close = separation.le(margin);
        self.hits = self.hits.each(|hit| hit & close);
        self
    }

    /// No points at all.
    #[inline(always)]
    pub(super) fn nothing() -> Self {
        Self::single(Vec2::zero(), Vec2::zero(), L::one(), L::zero())
    }
}

/// Clips the segment from `p` to `q` (from the reference body's centroid) to the face's width.
///
/// `flipped` lanes have B as the reference body; `from_a` is xB − xA. Both points lie on the incident
/// edge even where it misses the face altogether; then they coincide and only one is kept.
#[inline(always)]
pub(super) fn clip<L: Lanes>(
    face: &Reference<L>,
    [p, q]: [Vec2<L>; 2],
    flipped: L::Mask,
    from_a: Vec2<L>,
    feature: L,
    margin: L,
) -> Found<L> {
    let tangent = -face.normal.right();
    let (along_p, along_q) = (p.dot(tangent), q.dot(tangent));
    let (height_p, height_q) = (p.dot(face.normal) - face.offset, q.dot(face.normal) - face.offset);
    let (span, rise) = (along_q - along_p, height_q - height_p);
    let upright = span.equals(L::zero());
    let per_span = L::one() / L::select(upright, L::one(), span);
    let (low, high) = (face.start, face.start + face.length);

    let share = |along: L, end: L| {
        let clamped = low.max(high.min(along));
        let share = (clamped - along_p) * per_span;
        let share = L::zero().max(L::one().min(share));
        // An end inside the face keeps its exact coordinates.
        L::select(upright | clamped.equals(along), end, share)
    };
    let shares = [share(along_p, L::zero()), share(along_q, L::one())];
    let separations = shares.each(|u| height_p + rise * u);
    let half = L::lit(0.5);
    let arms: [Vec2<L>; 2] = crate::each::indexed(|k| {
        let along = along_p + span * shares[k];
        let arm = tangent * along + face.normal * (face.offset + separations[k] * half);
        Vec2::select(flipped, arm + from_a, arm)
    });
    let distinct = !shares[0].equals(shares[1]);
    let (first, second) = (separations[0].le(margin), separations[1].le(margin) & distinct);

    // The one point of a lane goes first.
    let only_second = second & !first;
    let pick = |a: L, b: L| L::select(only_second, b, a);
    let features = [feature, feature + L::one()];
    Found {
        normal: Vec2::select(flipped, -face.normal, face.normal),
        arms: [Vec2::select(only_second, arms[1], arms[0]), arms[1]],
        separations: [pick(separations[0], separations[1]), separations[1]],
        features: Some([pick(features[0], features[1]), features[1]]),
        hits: [first | second, first & second],
    }
}

/// Does any lane come closer than `margin`?
#[inline(always)]
pub(super) fn any_within<L: Lanes>(separation: L, margin: L) -> bool {
    separation.le(margin).any()
}

/// By how much B's face must part the bodies further than A's to become the reference: a thousandth
/// of the smaller extent, so that rounding does not flip the reference from step to step.
pub(super) const PREFER_A: f64 = 1e-3;
