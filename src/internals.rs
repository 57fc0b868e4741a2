//! What those need who measure the engine's inside: benches, laboratory and tests. Not part of the interface: it changes
//! with the stages.
//!
//! The functions here take lanes as a number, of `f32`. They are compiled with the engine, so that whoever calls them does
//! not compile its kernels once more.

use crate::body::Bodies;
use crate::lanes::f32s;
use crate::scene::Scene;
use crate::settings::{Broad, Settings};
use crate::simulation::Simulation;
use crate::workers::Parts;
use crate::world::World;

pub use crate::broad::{BRUTE_LIMIT, BroadCounts, BroadPhase, SWEEP_LIMIT};
pub use crate::column::BLOCK;
pub use crate::integrate::{advance, fly, predict};
pub use crate::island::{Demand, Islands, Pull, QuietTime};
pub use crate::motion::{CONTACT_REUSE_DISTANCE, Motion, Plan, Warm};
pub use crate::narrow::{MovedBodies, Narrow, Stride};
pub use crate::solve::soft::{HERTZ_TIMES_SUBSTEP, PUSH_CAP};
pub use crate::solve::{SceneNeeds, SolverContext, Solving, carries_impulses, pushes};
pub use crate::workers::Workers;

/// Why a scene did not get to where it was to be.
pub type Failed = Box<dyn std::error::Error + Send + Sync>;

/// Runs `$function::<L, …>` with as many lanes as `$lanes` says: the width of a kernel is chosen here and in
/// [`crate::simulation`].
macro_rules! at_width {
    ($lanes:expr, $($path:ident).+ ( $($arg:expr),* )) => {
        match $lanes {
            1 => $($path).+::<f32s::X1>($($arg),*),
            4 => $($path).+::<f32s::X4>($($arg),*),
            8 => $($path).+::<f32s::X8>($($arg),*),
            _ => $($path).+::<f32s::X16>($($arg),*),
        }
    };
}

/// A world of benches: 8 lanes, default settings.
pub type PlainWorld = World<f32s::X8>;

/// The world of a scene before its first step.
///
/// # Errors
/// A scene that cannot be run.
pub fn plain_world(scene: &Scene) -> Result<PlainWorld, Failed> {
    Ok(World::from_scene(scene, Settings::default())?)
}

/// Takes so many steps.
///
/// # Errors
/// A state that is not finite.
pub fn step_plain(world: &mut PlainWorld, dt_secs: f64, steps: usize) -> Result<(), Failed> {
    (0..steps).try_for_each(|_| world.step(dt_secs).map_err(Failed::from))
}

/// The world behind the interface of all widths.
pub fn as_simulation(world: &PlainWorld) -> &dyn Simulation {
    world
}

/// The bodies and candidate pairs of a scene after so many of its steps at 8 lanes.
///
/// # Errors
/// A scene that cannot be run, or a state that is not finite.
pub fn bodies_after(scene: &Scene, steps: usize) -> Result<(Bodies<f32>, Vec<[u32; 2]>), Failed> {
    let mut world = plain_world(scene)?;
    step_plain(&mut world, scene.dt_secs, steps)?;
    Ok((world.bodies().clone(), world.pairs().to_vec()))
}

/// [`BroadPhase::find`] of what is within a margin, metres, without speed or kept lists.
pub fn find_at(
    lanes: usize,
    broad: &mut BroadPhase<f32>,
    bodies: &Bodies<f32>,
    method: Broad,
    margin: f32,
) -> BroadCounts {
    at_width!(lanes, broad.find(&Workers::ALONE, bodies, method, margin.into(), 0.0, false))
}

/// [`Narrow::run`] with a margin, metres.
pub fn run_at(lanes: usize, narrow: &mut Narrow<f32>, bodies: &Bodies<f32>, pairs: &[[u32; 2]], margin: f32) {
    at_width!(lanes, narrow.run(bodies, pairs, margin));
}

/// [`Narrow::collide`] without margin.
pub fn collide_at(lanes: usize, narrow: &mut Narrow<f32>, bodies: &Bodies<f32>) {
    at_width!(
        lanes,
        narrow.collide(
            (&Workers::ALONE, &Parts::default()),
            bodies,
            0.0.into(),
            0.0,
            Stride { secs: 0.0, fallen: [0.0; 2] }
        )
    );
}

/// [`fly`] without noting fast bodies.
pub fn fly_at(lanes: usize, plan: &Plan<'_, f32>, bodies: &mut Bodies<f32>) {
    at_width!(lanes, fly(plan, bodies, None));
}
