//! Explicit Euler: x₁ = x₀ + h·v₀, v₁ = v₀ + h·a(x₀, v₀).
//!
//! Order 1. Its amplitude on an oscillator grows by √(1 + (hω)²) per step: it has no stability limit
//! because it is never stable. Source: Euler, Institutionum calculi integralis, 1768.

use super::{Advance, Scheme, Step, along};
use crate::each::Each as _;
use crate::lanes::Lanes;
use crate::motion::Block;

pub(super) struct ExplicitEuler;

impl Scheme for ExplicitEuler {
    #[inline(always)]
    fn advance<L: Lanes>(
        step: Step<L>,
        x: &Block<L>,
        v: &Block<L>,
        accel: impl Fn(&Block<L>, &Block<L>, f64) -> Block<L>,
    ) -> Advance<L> {
        let a = accel(x, v, 0.0);
        Advance { displacement: v.each(|v| v * step.h), velocity: along(v, step.h, &a) }
    }

    #[inline(always)]
    fn spin<L: Lanes>(step: Step<L>, w: L, alpha: L) -> (L, L) {
        (step.h * w, w + step.h * alpha)
    }
}
