//! What an engine is here, and which one to build.

use std::time::Instant;

use lamina2d::scene::Scene;
use lamina2d::simulation::BodyState;
use serde::Serialize;

use crate::blueprint::Blueprint;
use crate::box2d::Box2d;
use crate::ours::Lamina;
use crate::rapier::Rapier;

/// The engines.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Name {
    /// This project's.
    Lamina2d,
    /// Box2D v3.
    Box2d,
    /// rapier, in two dimensions.
    Rapier2d,
}

impl Name {
    /// All, ours first.
    pub const ALL: [Self; 3] = [Self::Lamina2d, Self::Box2d, Self::Rapier2d];

    /// As rows have it.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Lamina2d => "lamina2d",
            Self::Box2d => "box2d",
            Self::Rapier2d => "rapier2d",
        }
    }
}

impl std::fmt::Display for Name {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.pad(self.name())
    }
}

/// An engine and what it is run with; everything else is as it comes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Setup {
    /// Which.
    pub engine: Name,
    /// Substeps of ours and of Box2D, solver iterations of rapier: what each calls the rounds of a step.
    pub substeps: u32,
    /// Threads: lamina2d has one.
    pub threads: usize,
    /// May bodies fall asleep?
    pub sleep: bool,
}

/// The rounds of a step that all three come with.
pub const DEFAULT_SUBSTEPS: u32 = 4;

impl Setup {
    /// An engine as it comes, on one thread, nothing asleep.
    pub const fn new(engine: Name) -> Self {
        Self { engine, substeps: DEFAULT_SUBSTEPS, threads: 1, sleep: false }
    }

    /// The same with other rounds per step.
    #[must_use]
    pub const fn substeps(self, substeps: u32) -> Self {
        Self { substeps, ..self }
    }

    /// The same on several threads.
    #[must_use]
    pub const fn threads(self, threads: usize) -> Self {
        Self { threads, ..self }
    }

    /// The same, where bodies may fall asleep.
    #[must_use]
    pub const fn sleep(self) -> Self {
        Self { sleep: true, ..self }
    }

    /// In words.
    pub fn words(&self) -> String {
        let rounds = if self.engine == Name::Rapier2d { "solver iterations" } else { "substeps" };
        let sleep = if self.sleep { ", sleep on" } else { "" };
        format!("{} {rounds}{sleep}", self.substeps)
    }
}

/// What an engine cannot express of a scene: it is left out for that engine, never run as something else.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{engine} cannot run {scene}: {lacks}")]
pub struct Gap {
    /// The engine.
    pub engine: Name,
    /// The scene.
    pub scene: String,
    /// What it has not.
    pub lacks: String,
}

/// A world of any engine, with the bodies of a scene in their order.
pub trait Engine {
    /// Advances by the scene's step.
    ///
    /// # Errors
    /// A state the engine itself calls broken.
    fn step(&mut self) -> anyhow::Result<()>;

    /// Advances by `count` steps.
    ///
    /// # Errors
    /// Those of [`Engine::step`].
    fn run(&mut self, count: usize) -> anyhow::Result<()> {
        steps(self, count)
    }

    /// Adds the time of each of `count` steps, ms, after one untimed: others have had the caches meanwhile.
    ///
    /// # Errors
    /// Those of [`Engine::step`].
    fn window(&mut self, count: usize, samples_ms: &mut Vec<f64>) -> anyhow::Result<()> {
        timed(self, count, samples_ms)
    }

    /// The states of all bodies.
    fn states(&self) -> Vec<BodyState>;

    /// Pairs whose manifold has at least one point, as the engine itself counts: within its own margin.
    fn contacts(&self) -> usize;

    /// Mass (kg) and moment of inertia (kg·m²) of all bodies as the engine has them; 0 unless dynamic.
    fn masses(&self) -> Vec<[f64; 2]>;

    /// Bodies asleep.
    fn asleep(&self) -> usize;
}

/// The loop behind [`Engine::run`].
///
/// # Errors
/// Those of [`Engine::step`].
pub fn steps<E: Engine + ?Sized>(engine: &mut E, count: usize) -> anyhow::Result<()> {
    (0..count).try_for_each(|_| engine.step())
}

/// The loop behind [`Engine::window`].
///
/// # Errors
/// Those of [`Engine::step`].
pub fn timed<E: Engine + ?Sized>(
    engine: &mut E,
    count: usize,
    samples_ms: &mut Vec<f64>,
) -> anyhow::Result<()> {
    engine.step()?;
    for _ in 0..count {
        let start = Instant::now();
        engine.step()?;
        samples_ms.push(start.elapsed().as_secs_f64() * 1e3);
    }
    Ok(())
}

/// Builds the world of `scene` that `setup` names.
///
/// # Errors
/// A scene that no engine can run (the library's sentence), or this one cannot ([`Gap`]).
pub fn build(scene: &Scene, setup: Setup) -> anyhow::Result<Box<dyn Engine>> {
    let blueprint = Blueprint::of(scene)?;
    Ok(match setup.engine {
        Name::Lamina2d => Box::new(Lamina::build(scene, &blueprint, setup)?),
        Name::Box2d => Box::new(Box2d::build(&blueprint, setup)?),
        Name::Rapier2d => Box::new(Rapier::build(&blueprint, setup)?),
    })
}
