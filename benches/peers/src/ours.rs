//! lamina2d.

use lamina2d::scene::{BodyKind, Scene};
use lamina2d::settings::Settings;
use lamina2d::simulation::{BodyState, Simulation, simulate};

use crate::blueprint::Blueprint;
use crate::engine::{Engine, Name, Setup};

/// A world of lamina2d.
#[expect(missing_debug_implementations, reason = "a simulation has none")]
pub struct Lamina {
    world: Box<dyn Simulation>,
    dt_secs: f64,
    masses: Vec<[f64; 2]>,
}

impl Lamina {
    /// The world of a scene.
    ///
    /// # Errors
    /// More than one thread; what the library refuses the scene for.
    pub fn build(scene: &Scene, blueprint: &Blueprint, setup: Setup) -> anyhow::Result<Self> {
        if setup.threads != 1 {
            let lacks = format!("it has one thread, got {}", setup.threads);
            return Err(blueprint.gap(Name::Lamina2d, lacks).into());
        }
        let settings = Settings {
            dt_secs: scene.dt_secs,
            substeps: setup.substeps,
            sleep: setup.sleep,
            ..Settings::default()
        };
        let dynamic = |b: &crate::blueprint::Body| b.spec.kind == BodyKind::Dynamic;
        let masses = blueprint.bodies.iter().map(|b| if dynamic(b) { [b.mass, b.inertia] } else { [0.0; 2] });
        Ok(Self { world: simulate(scene, settings)?, dt_secs: scene.dt_secs, masses: masses.collect() })
    }
}

impl Engine for Lamina {
    fn step(&mut self) -> anyhow::Result<()> {
        Ok(self.world.step(self.dt_secs)?)
    }
    fn states(&self) -> Vec<BodyState> {
        self.world.states()
    }
    fn contacts(&self) -> usize {
        self.world.counts().contacts
    }
    fn masses(&self) -> Vec<[f64; 2]> {
        self.masses.clone()
    }
    fn asleep(&self) -> usize {
        self.world.counts().sleeping
    }
}
