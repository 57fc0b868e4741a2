//! The classical Runge–Kutta method of order 4 on (x, v).
//!
//! k₁ = a(x₀, v₀), k₂ = a(x₀ + ½h·v₀, v₀ + ½h·k₁), k₃ = a(x₀ + ½h·v₂, v₀ + ½h·k₂), k₄ = a(x₀ + h·v₃, v₀ + h·k₃);
//! stable on an oscillator for hω < 2√2. Source: Kutta, Z. Math. Phys. 46 (1901) 435.
//!
//! The weighted sums are written as a mean plus deviations, which vanish under constant force:
//! (k₁ + 2k₂ + 2k₃ + k₄)/6 = m + ⅔(n − m) with m = (k₁ + k₄)/2, n = (k₂ + k₃)/2, and
//! h/6·(v₀ + 2v₂ + 2v₃ + v₄) = h·v₀ + ½h²·(k₁ + ((k₂ − k₁) + (k₃ − k₁))/3).

use super::{Advance, Scheme, Step, along, drift};
use crate::lanes::Lanes;
use crate::motion::Block;

pub(super) struct Rk4;

impl Scheme for Rk4 {
    #[inline(always)]
    fn advance<L: Lanes>(
        step: Step<L>,
        x: &Block<L>,
        v: &Block<L>,
        accel: impl Fn(&Block<L>, &Block<L>, f64) -> Block<L>,
    ) -> Advance<L> {
        let (h, half_h) = (step.h, step.half_h);
        let k1 = accel(x, v, 0.0);
        let v2 = along(v, half_h, &k1);
        let k2 = accel(&along(x, half_h, v), &v2, 0.5);
        let v3 = along(v, half_h, &k2);
        let k3 = accel(&along(x, half_h, &v2), &v3, 0.5);
        let v4 = along(v, h, &k3);
        let k4 = accel(&along(x, h, &v3), &v4, 1.0);
        let (half, third, two_thirds) = (L::lit(0.5), L::lit(1.0 / 3.0), L::lit(2.0 / 3.0));
        let kick: Block<L> = crate::each::indexed(|i| {
            let (ends, middle) = ((k1[i] + k4[i]) * half, (k2[i] + k3[i]) * half);
            ends + (middle - ends) * two_thirds
        });
        let pull: Block<L> = crate::each::indexed(|i| k1[i] + ((k2[i] - k1[i]) + (k3[i] - k1[i])) * third);
        Advance { displacement: drift(step, v, &pull), velocity: along(v, h, &kick) }
    }
}
