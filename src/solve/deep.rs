//! Deep overlaps: what begins in something else, or was put there, is moved out of it without being given speed.
//!
//! A push of [`soft`](super::soft) gives bodies speed that its relaxation takes back, one contact after the other. In a
//! heap that begins in itself much of it stays: twenty bodies at one point parted with eight times the cap, 34 m/s, and
//! still with a half of it after fifteen relaxations more. So points deeper than [`DEEP`] only stop closing, and as the
//! step ends they are moved apart ([`owed`]), by [`PUSH_CAP`](super::soft::PUSH_CAP) at most: displacements alone, after
//! which momentum is what it was.

use crate::lanes::Lanes;

/// Overlaps over this share of the pair's length are deep, where bodies have just come or changed. What sinks into
/// something under a load is not treated so: a pile of 10,000 that fell with 2 substeps lost its springs' push and
/// collapsed (0.2 m of overlap on average instead of 0.02).
pub(super) const DEEP: f64 = 0.03;
/// Steps for which deep points are moved apart after bodies have come.
pub(super) const STEPS: u32 = 120;

/// Whether anything is to be moved apart.
#[derive(Clone, Copy, Debug)]
pub(super) struct Apart {
    /// Bodies have come or changed: some may have been put into others.
    pub fresh: bool,
    /// Steps for which deep points are moved apart.
    pub steps: u32,
}

impl Default for Apart {
    fn default() -> Self {
        Self { fresh: true, steps: 0 }
    }
}

/// How far a point is to be moved out of another that is in it by more than `deep`, by `most` at most: the law of
/// [`MoveOut`](super::bounce::MoveOut).
pub(super) fn owed<L: Lanes>(deep: L, most: L, [gap, way, mass]: [L; 3]) -> L {
    let zero = L::zero();
    let over = zero.min(gap + deep);
    let is_deep = over.lt(zero) & zero.lt(mass);
    L::select(is_deep, zero.min(over.max(-most) + way), zero)
}
