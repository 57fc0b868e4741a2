//! Semi-implicit (symplectic) Euler: v₁ = v₀ + h·a(x₀, v₀), x₁ = x₀ + h·v₁. The thesis's "Euler".
//!
//! Order 1, stable on an oscillator for hω < 2, energy bounded. Source: Hairer, Lubich, Wanner,
//! Geometric Numerical Integration, I.1.2.

use super::{Advance, Scheme, Step, along};
use crate::each::Each as _;
use crate::lanes::Lanes;
use crate::motion::Block;

pub(super) struct SemiImplicitEuler;

impl Scheme for SemiImplicitEuler {
    #[inline(always)]
    fn advance<L: Lanes>(
        step: Step<L>,
        x: &Block<L>,
        v: &Block<L>,
        accel: impl Fn(&Block<L>, &Block<L>, f64) -> Block<L>,
    ) -> Advance<L> {
        let a = accel(x, v, 0.0);
        let velocity = along(v, step.h, &a);
        Advance { displacement: velocity.each(|v| v * step.h), velocity }
    }

    #[inline(always)]
    fn spin<L: Lanes>(step: Step<L>, w: L, alpha: L) -> (L, L) {
        let w = w + step.h * alpha;
        (step.h * w, w)
    }
}
