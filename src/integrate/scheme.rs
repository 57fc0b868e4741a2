//! What an integrator is: a displacement and a new velocity for a block of bodies from (x, v) and the fields.

use crate::lanes::{Lanes, Real};
use crate::motion::Block;

/// h, ½h and ½h² in lanes, seconds.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Step<L> {
    /// h.
    pub h: L,
    /// ½h.
    pub half_h: L,
    /// ½h².
    pub half_h2: L,
}

impl<L: Lanes> Step<L> {
    /// Of a step of `h_secs`.
    #[inline]
    pub(crate) fn new(h_secs: f64) -> Self {
        let h = L::Elem::from_f64(h_secs);
        let half = L::Elem::from_f64(0.5);
        Self { h: L::splat(h), half_h: L::splat(half * h), half_h2: L::splat(half * h * h) }
    }
}

/// What a scheme makes of one step of a block.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Advance<L> {
    /// Metres.
    pub displacement: Block<L>,
    /// At the end of the step, m/s.
    pub velocity: Block<L>,
}

/// An integrator: the same signature for every scheme.
pub(crate) trait Scheme {
    /// Advances (x, v) by one step under `accel(x, v, c)`, whose c is the stage's time in steps since this one began.
    fn advance<L: Lanes>(
        step: Step<L>,
        x: &Block<L>,
        v: &Block<L>,
        accel: impl Fn(&Block<L>, &Block<L>, f64) -> Block<L>,
    ) -> Advance<L>;

    /// The angle turned and the angular velocity reached under constant angular acceleration.
    #[inline(always)]
    fn spin<L: Lanes>(step: Step<L>, w: L, alpha: L) -> (L, L) {
        (step.h * w + step.half_h2 * alpha, w + step.h * alpha)
    }
}

/// What every scheme of order ≥ 2 is under constant acceleration: x + hv + ½h²a, v + ha.
///
/// The schemes are written as this plus deviations between their stages, so the collapse is exact to the bit.
pub(super) struct ClosedForm;

impl Scheme for ClosedForm {
    #[inline(always)]
    fn advance<L: Lanes>(
        step: Step<L>,
        x: &Block<L>,
        v: &Block<L>,
        accel: impl Fn(&Block<L>, &Block<L>, f64) -> Block<L>,
    ) -> Advance<L> {
        let a = accel(x, v, 0.0);
        Advance { displacement: drift(step, v, &a), velocity: along(v, step.h, &a) }
    }
}

/// a + k·b for each body of a block.
#[inline(always)]
pub(super) fn along<L: Lanes>(a: &Block<L>, k: L, b: &Block<L>) -> Block<L> {
    crate::each::indexed(|i| a[i] + b[i] * k)
}

/// h·v + ½h²·a for each body of a block.
#[inline(always)]
pub(super) fn drift<L: Lanes>(step: Step<L>, v: &Block<L>, a: &Block<L>) -> Block<L> {
    crate::each::indexed(|i| v[i] * step.h + a[i] * step.half_h2)
}
