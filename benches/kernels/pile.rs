//! Settled bodies with the pairs and contacts of their next step: what contact kernels work on.

use lamina2d::body::{Bodies, Form};
use lamina2d::contact::Manifolds;
use lamina2d::force::{Field, Forces};
use lamina2d::internals::{
    BroadPhase, HERTZ_TIMES_SUBSTEP, Motion, Narrow, Plan, SolverContext, Solving, Workers, find_at, run_at,
};
use lamina2d::joint::Joints;
use lamina2d::lanes::Lanes;
use lamina2d::settings::{Broad, Integrator, Skips, Solver};

use super::{TRAITS, margin};
use crate::common::{DT_SECS, SETTLE_STEPS, Settled};

/// A settled scene before its next step, whose manifolds have been found.
pub(super) struct Pile {
    pub(super) bodies: Bodies<f32>,
    pub(super) joints: Joints<f32>,
    pub(super) pairs: Vec<[u32; 2]>,
    pub(super) narrow: Narrow<f32>,
    fields: Vec<Field<f32>>,
}

impl Pile {
    /// Of the mix `mix` with `size` bodies.
    pub(super) fn of(settled: &Settled, mix: &str, size: usize) -> Self {
        Self::after(settled, &format!("{mix}/{size}"), SETTLE_STEPS)
    }

    /// Of a scene after some steps.
    pub(super) fn after(settled: &Settled, scene: &str, steps: usize) -> Self {
        let world = settled.get(scene, steps);
        let (mut bodies, joints) = (world.bodies().clone(), world.joints().clone().without_impulses());
        bodies.refresh_polygons();
        let (mut broad, mut narrow) = (BroadPhase::default(), Narrow::default());
        broad.keep_apart(joints.apart());
        find_at(8, &mut broad, &bodies, Broad::Auto, margin());
        run_at(8, &mut narrow, &bodies, broad.pairs(), margin());
        Self { pairs: broad.pairs().to_vec(), bodies, joints, narrow, fields: Forces::gravity().fields() }
    }

    /// The pairs of these forms, whichever of the two comes first.
    pub(super) fn pairs_of(&self, [a, b]: [Form; 2]) -> Vec<[u32; 2]> {
        let is_of = |pair: &[u32; 2]| {
            let forms = pair.map(|slot| self.bodies.form(slot as usize));
            forms == [a, b] || forms == [b, a]
        };
        self.pairs.iter().copied().filter(is_of).collect()
    }

    /// Motion memory as a step begins.
    pub(super) fn motion(&self) -> Motion<f32> {
        let mut motion = Motion::default();
        motion.resize(&self.bodies);
        motion
    }

    /// Constraints of all contacts, and the manifolds that know where they are.
    pub(super) fn solving<L: Lanes<Elem = f32>>(&self) -> (Solving<L>, Manifolds<f32>) {
        let (mut solving, mut narrow) = (Solving::default(), self.narrow.clone());
        solving.prepare(&self.bodies, narrow.found(), true, (&Workers::ALONE, &self.motion()));
        (solving, narrow.manifolds)
    }

    /// How bodies move: one substep under gravity.
    pub(super) fn plan(&self, solver: Solver) -> Plan<'_, f32> {
        Plan {
            integrator: Integrator::VelocityVerlet,
            fields: &self.fields,
            h_secs: DT_SECS,
            since_secs: 0.0,
            substeps: 1,
            skips: Skips::NONE,
            moving: lamina2d::internals::pushes(solver),
            carries: lamina2d::internals::carries_impulses(solver),
            workers: &Workers::ALONE,
        }
    }
}

/// What a solver's pass works in.
#[derive(Clone)]
pub(super) struct State<L: Lanes<Elem = f32>> {
    pub(super) motion: Motion<f32>,
    pub(super) manifolds: Manifolds<f32>,
    pub(super) solving: Solving<L>,
}

/// As a pass found it, and as it left it.
pub(super) struct Memory<L: Lanes<Elem = f32>> {
    pub(super) before: State<L>,
    pub(super) now: State<L>,
}

impl<L: Lanes<Elem = f32>> Memory<L> {
    /// Before a first call.
    pub(super) fn new(before: State<L>) -> Self {
        Self { now: before.clone(), before }
    }

    /// Back to before the first call, in the same memory.
    pub(super) fn reset(&mut self) {
        let Self { before, now } = self;
        now.solving.clone_from(&before.solving);
        now.motion.clone_from(&before.motion);
        now.manifolds.clone_from(&before.manifolds);
    }
}

/// A step of `plan`, as its solver sees it.
pub(super) fn context<'a>(solver: Solver, plan: &'a Plan<'a, f32>) -> SolverContext<'a, f32> {
    SolverContext { solver, needs: TRAITS, dt_secs: DT_SECS, stiffness: HERTZ_TIMES_SUBSTEP, plan }
}
