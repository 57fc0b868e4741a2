//! Velocity Verlet: x₁ = x₀ + h·v₀ + ½h²·a₀, v₁ = v₀ + h·(a₀ + a₁)/2 with a₁ = a(x₁, v₀ + h·a₀).
//!
//! Order 2, also for forces of velocity, thanks to the predicted velocity; stable on an oscillator for
//! hω < 2. Source: Swope, Andersen, Berens, Wilson, J. Chem. Phys. 76 (1982) 637.
//! Written as v₀ + h·(a₀ + (a₁ − a₀)/2) it is exact to the bit under constant force.

use super::{Advance, Scheme, Step, along, drift};
use crate::lanes::Lanes;
use crate::motion::Block;

pub(super) struct VelocityVerlet;

impl Scheme for VelocityVerlet {
    #[inline(always)]
    fn advance<L: Lanes>(
        step: Step<L>,
        x: &Block<L>,
        v: &Block<L>,
        accel: impl Fn(&Block<L>, &Block<L>, f64) -> Block<L>,
    ) -> Advance<L> {
        let a0 = accel(x, v, 0.0);
        let displacement = drift(step, v, &a0);
        let x1: Block<L> = crate::each::indexed(|i| x[i] + displacement[i]);
        let a1 = accel(&x1, &along(v, step.h, &a0), 1.0);
        let mean: Block<L> = crate::each::indexed(|i| a0[i] + (a1[i] - a0[i]) * L::lit(0.5));
        Advance { displacement, velocity: along(v, step.h, &mean) }
    }
}
