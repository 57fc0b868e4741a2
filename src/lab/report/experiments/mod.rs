//! What is measured: each experiment a function that returns rows.
//!
//! Engines are timed in one process, in alternating windows, so that a slow spell of the machine meets
//! all of them; medians are reported. Every experiment checks what it timed: lane widths must agree on
//! the state hash, on/off pairs on contacts or hash.

pub mod accuracy;
pub mod broad_phase;
pub mod contacts;
pub mod determinism;
pub mod flight;
pub mod lanes;
pub mod limits;
pub mod matrix;
pub mod recording;
pub mod skips;
pub mod sleep;
pub mod stability;

use std::time::Instant;

use lamina2d::measure::{Outline, Penetration, penetration};
use lamina2d::scene::{Scene, ShapeSpec};
use lamina2d::settings::Integrator;
use lamina2d::simulation::Simulation;

use crate::thesis::{ThesisIntegrator, ThesisWorld, Version};

/// Seconds per step in all timed experiments.
const DT_SECS: f64 = 1.0 / 60.0;
/// Steps that let a mix fall and settle: the thesis's 10 s.
const SETTLE_STEPS: usize = 600;

/// An engine under the clock.
enum Contestant {
    Ours(Box<dyn Simulation>),
    Baseline(Box<ThesisWorld>),
}

impl Contestant {
    fn baseline(
        scene: &Scene,
        integrator: ThesisIntegrator,
        version: Version,
        broad: bool,
    ) -> anyhow::Result<Self> {
        Ok(Self::Baseline(Box::new(ThesisWorld::new(scene, integrator, version, broad)?)))
    }

    fn step(&mut self) -> anyhow::Result<()> {
        match self {
            Self::Ours(world) => world.step(DT_SECS)?,
            Self::Baseline(world) => world.step(DT_SECS as f32),
        }
        Ok(())
    }

    fn steps(&mut self, count: usize) -> anyhow::Result<()> {
        (0..count).try_for_each(|_| self.step())
    }

    /// Time of each of `count` steps, ms, after one untimed: others have had the caches meanwhile.
    fn window(&mut self, count: usize, samples_ms: &mut Vec<f64>) -> anyhow::Result<()> {
        self.step()?;
        for _ in 0..count {
            let start = Instant::now();
            self.step()?;
            samples_ms.push(start.elapsed().as_secs_f64() * 1e3);
        }
        Ok(())
    }

    fn contacts(&self) -> usize {
        match self {
            Self::Ours(world) => world.counts().contacts,
            Self::Baseline(world) => world.contacts(),
        }
    }

    fn hash(&self) -> u64 {
        match self {
            Self::Ours(world) => world.hash(),
            Self::Baseline(world) => world.hash(),
        }
    }

    fn penetration(&self) -> Penetration {
        match self {
            Self::Ours(world) => world.penetration(),
            Self::Baseline(world) => penetration(&outlines(world)),
        }
    }
}

/// The baseline's bodies as outlines, for the check all engines share.
fn outlines(world: &ThesisWorld) -> Vec<Outline> {
    let positions = world.positions_m();
    let outline = |body: usize| {
        let vertices = world.outline_m(body);
        let radius = if vertices.is_empty() { world.radius_m(body) } else { 0.0 };
        Outline { centre: positions[body], radius, vertices, fixed: world.is_static(body) }
    };
    (0..world.len()).map(outline).collect()
}

/// Our name of a baseline's integrator.
fn integrator_of(integrator: ThesisIntegrator) -> Integrator {
    match integrator {
        ThesisIntegrator::Euler => Integrator::SemiImplicitEuler,
        ThesisIntegrator::Verlet => Integrator::VelocityVerlet,
        ThesisIntegrator::Rk4 => Integrator::Rk4,
    }
}

/// The scene with its bodies where a simulation of it has them now; anchors of joints stay where they were.
pub fn posed(scene: &Scene, world: &dyn Simulation) -> Scene {
    let mut scene = scene.clone();
    for (spec, state) in scene.bodies.iter_mut().zip(world.states()) {
        let [c, s] = state.rotation;
        let offset = match &spec.shape {
            ShapeSpec::Polygon(_) => {
                spec.shape.build().map_or(glam::DVec2::ZERO, |s| s.mass_properties().centroid)
            }
            _ => glam::DVec2::ZERO,
        };
        // The outline's origin, from its centroid.
        spec.position = [
            state.position[0] - (c * offset.x - s * offset.y),
            state.position[1] - (s * offset.x + c * offset.y),
        ];
        spec.angle = s.atan2(c);
        if spec.kind != lamina2d::scene::BodyKind::Static {
            (spec.velocity, spec.angular_velocity) = (state.velocity, state.angular_velocity);
        }
    }
    scene
}
