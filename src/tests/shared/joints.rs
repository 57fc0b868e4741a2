//! What the tests of joints share: steps of a sixtieth of a second, gaps and energy.

use lamina2d::settings::{Precision, Settings};
use lamina2d::simulation::Simulation;

pub(crate) const DT_SECS: f64 = 1.0 / 60.0;
pub(crate) const GRAVITY: f64 = 9.81;

pub(crate) fn in_f64() -> Settings {
    Settings::default().with_precision(Precision::F64)
}

pub(crate) fn advance(world: &mut dyn Simulation, steps: usize) {
    for _ in 0..steps {
        world.step(DT_SECS).expect("the state stays finite");
    }
}

/// How far the anchors of hinges and welds are apart: the most, and all together, metres.
pub(crate) fn gaps(world: &dyn Simulation) -> [f64; 2] {
    let apart = |[a, b]: [[f64; 2]; 2]| (b[0] - a[0]).hypot(b[1] - a[1]);
    world.joint_anchors().into_iter().map(apart).fold([0.0, 0.0], |[most, sum], d| [d.max(most), sum + d])
}

pub(crate) fn energy(world: &dyn Simulation) -> f64 {
    let sums = world.invariants();
    sums.kinetic_energy + sums.potential_energy
}
