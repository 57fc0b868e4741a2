//! What the tests of the thesis baseline share.

use lamina::thesis::{THESIS_DT_SECS, ThesisIntegrator, ThesisWorld, Version};
use lamina2d::scene::{BodyKind, Scene, by_name};

pub(crate) const MIXES: [&str; 4] = ["circles", "circles_polygons", "polygons", "all"];
const SEED: u64 = 7;

pub(crate) fn mix(name: &str, bodies: usize) -> Scene {
    by_name(name, Some(bodies), SEED).expect("a scene of the table")
}

pub(crate) fn world_with(
    scene: &Scene,
    integrator: ThesisIntegrator,
    version: Version,
    broad: bool,
) -> ThesisWorld {
    ThesisWorld::new(scene, integrator, version, broad).expect("a scene the baseline can run")
}

pub(crate) fn run(world: &mut ThesisWorld, steps: usize) {
    for _ in 0..steps {
        world.step(THESIS_DT_SECS);
    }
}

/// The scene in the state a world has reached, so that both versions can start from it.
pub(crate) fn continued(scene: &Scene, world: &ThesisWorld) -> Scene {
    let (positions, velocities) = (world.positions_m(), world.velocities_m_per_s());
    let (angles, spins) = (world.angles_rad(), world.angular_velocities_rad_per_s());
    let mut scene = scene.clone();
    for (k, body) in scene.bodies.iter_mut().enumerate() {
        if body.kind == BodyKind::Dynamic {
            (body.position, body.angle) = (positions[k], angles[k]);
            (body.velocity, body.angular_velocity) = (velocities[k], spins[k]);
        }
    }
    scene
}
