//! Yoshida's method of order 4: three leapfrogs of lengths w₁h, w₀h, w₁h.
//!
//! w₁ = 1/(2 − ∛2), w₀ = 1 − 2w₁. Order 4 for forces of position, lower for forces of velocity;
//! symplectic; stable on an oscillator for hω < 1.573. Source: Yoshida, Phys. Lett. A 150 (1990) 262
//! (Forest and Ruth, Physica D 43 (1990) 105, found it independently).
//!
//! Stage k kicks by `d_k` h at time `c_k` h: (d) = (w₁, w₀, w₁), (c) = (w₁/2, ½, 1 − w₁/2). With Σd = 1
//! and Σd(1 − c) = ½ the sums are written as a₁ plus deviations, which vanish under constant force.

use super::{Advance, Scheme, Step, along, drift};
use crate::lanes::Lanes;
use crate::motion::Block;

pub(super) struct Yoshida4;

/// 1/(2 − ∛2).
const W1: f64 = 1.351_207_191_959_657_6;
/// 1 − 2·W1.
const W0: f64 = 1.0 - 2.0 * W1;

impl Scheme for Yoshida4 {
    #[inline(always)]
    fn advance<L: Lanes>(
        step: Step<L>,
        x: &Block<L>,
        v: &Block<L>,
        accel: impl Fn(&Block<L>, &Block<L>, f64) -> Block<L>,
    ) -> Advance<L> {
        let h = |share: f64| step.h * L::lit(share);
        let x1 = along(x, h(W1 / 2.0), v);
        let a1 = accel(&x1, v, W1 / 2.0);
        let v1 = along(v, h(W1), &a1);
        let x2 = along(&x1, h(f64::midpoint(W1, W0)), &v1);
        let a2 = accel(&x2, &v1, 0.5);
        let v2 = along(&v1, h(W0), &a2);
        let x3 = along(&x2, h(f64::midpoint(W1, W0)), &v2);
        let a3 = accel(&x3, &v2, 1.0 - W1 / 2.0);
        let weighted = |d2: f64, d3: f64| -> Block<L> {
            crate::each::indexed(|i| a1[i] + ((a2[i] - a1[i]) * L::lit(d2) + (a3[i] - a1[i]) * L::lit(d3)))
        };
        let kick = weighted(W0, W1);
        // Twice d·(1 − c): what a kick at c adds to the position at the end, over ½h².
        let pull = weighted(W0, W1 * W1);
        Advance { displacement: drift(step, v, &pull), velocity: along(v, step.h, &kick) }
    }
}
