//! Position Verlet (drift, kick, drift): x½ = x₀ + ½h·v₀, v₁ = v₀ + h·a(x½, v₀), x₁ = x½ + ½h·v₁.
//!
//! Order 2 for forces of position, 1 for forces of velocity (the kick sees only v₀); one evaluation per
//! step. Source: Tuckerman, Berne, Martyna, J. Chem. Phys. 97 (1992) 1990.
//! x₁ − x₀ = h·v₀ + ½h²·a is the same displacement, and exact to the bit under constant force.

use super::{Advance, Scheme, Step, along, drift};
use crate::lanes::Lanes;
use crate::motion::Block;

pub(super) struct PositionVerlet;

impl Scheme for PositionVerlet {
    #[inline(always)]
    fn advance<L: Lanes>(
        step: Step<L>,
        x: &Block<L>,
        v: &Block<L>,
        accel: impl Fn(&Block<L>, &Block<L>, f64) -> Block<L>,
    ) -> Advance<L> {
        let a = accel(&along(x, step.half_h, v), v, 0.5);
        Advance { displacement: drift(step, v, &a), velocity: along(v, step.h, &a) }
    }
}
