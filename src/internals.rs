//! What those need who measure the engine's inside: benches, laboratory and tests. Not part of the interface: it changes
//! with the stages.
//!
//! The functions here take lanes as a number, of `f32`. They are compiled with the engine, so that whoever calls them does
//! not compile its kernels once more.

use crate::body::Bodies;
use crate::lanes::f32s;
use crate::scene::Scene;
use crate::settings::{Broad, Settings};
use crate::world::World;

pub use crate::broad::{BRUTE_LIMIT, BroadCounts, BroadPhase, SWEEP_LIMIT};
pub use crate::column::BLOCK;
pub use crate::integrate::{advance, fly, predict};
pub use crate::island::{Demand, Islands, Pull, QuietTime};
pub use crate::motion::{CONTACT_REUSE_DISTANCE, Motion, Plan, Warm};
pub use crate::narrow::{MovedBodies, Narrow, Stride};
pub use crate::solve::soft::{HERTZ_TIMES_SUBSTEP, PUSH_CAP};
pub use crate::solve::{SceneNeeds, SolverContext, Solving, carries_impulses, pushes};

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

/// The bodies and candidate pairs of a scene after so many of its steps at 8 lanes.
///
/// # Errors
/// A scene that cannot be run, or a state that is not finite.
pub fn bodies_after(scene: &Scene, steps: u64) -> Result<(Bodies<f32>, Vec<[u32; 2]>), Failed> {
    let mut world = World::<f32s::X8>::from_scene(scene, Settings::default())?;
    for _ in 0..steps {
        world.step(scene.dt_secs)?;
    }
    Ok((world.bodies().clone(), world.pairs().to_vec()))
}

/// [`BroadPhase::find`] without reach, speed or kept lists.
pub fn find_at(
    lanes: usize,
    broad: &mut BroadPhase<f32>,
    bodies: &Bodies<f32>,
    method: Broad,
) -> BroadCounts {
    at_width!(lanes, broad.find(bodies, method, 0.0, 0.0, false))
}

/// [`Narrow::run`] without margin.
pub fn run_at(lanes: usize, narrow: &mut Narrow<f32>, bodies: &Bodies<f32>, pairs: &[[u32; 2]]) {
    at_width!(lanes, narrow.run(bodies, pairs, 0.0));
}

/// [`Narrow::collide`] without margin.
pub fn collide_at(lanes: usize, narrow: &mut Narrow<f32>, bodies: &Bodies<f32>) {
    at_width!(lanes, narrow.collide(bodies, 0.0, 0.0, Stride { secs: 0.0, fallen: [0.0; 2] }));
}

/// [`fly`] without noting fast bodies.
pub fn fly_at(lanes: usize, plan: &Plan<'_, f32>, bodies: &mut Bodies<f32>) {
    at_width!(lanes, fly(plan, bodies, None));
}
