//! Runs groups: each engine settles on its own, then they take turns under the clock, in one process, so that a
//! slow spell of the machine meets all of them.

use anyhow::Context;
use lamina2d::scene::Scene;
use serde::Serialize;

use crate::blueprint::Blueprint;
use crate::engine::{self, Engine, Gap, Setup};
use crate::plan::Group;
use crate::row::Row;

/// What an engine could not run.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Missing {
    /// The scene.
    pub scene: String,
    /// The engine.
    pub engine: &'static str,
    /// Why.
    pub why: String,
}

/// What came of a run.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Results {
    /// Of each engine on each scene.
    pub rows: Vec<Row>,
    /// Scenes an engine cannot express, or broke on before the clock ran.
    pub gaps: Vec<Missing>,
}

/// An engine under the clock.
struct Contestant {
    setup: Setup,
    engine: Box<dyn Engine>,
    samples_ms: Vec<f64>,
    steps: usize,
    stopped: Option<String>,
}

impl Contestant {
    /// A run that breaks is over, not an error of the others.
    fn advance(&mut self, count: usize, work: impl FnOnce(&mut Self) -> anyhow::Result<()>) {
        if self.stopped.is_some() {
            return;
        }
        match work(self) {
            Ok(()) => self.steps += count,
            Err(why) => self.stopped = Some(format!("after step {} or later: {why:#}", self.steps)),
        }
    }
}

impl Results {
    /// Runs a group on its scene and adds its rows; `tick` is called after each engine has settled and after each
    /// round of turns.
    ///
    /// # Errors
    /// A scene that none can run.
    pub fn add(&mut self, scene: &Scene, group: &Group, tick: &mut dyn FnMut()) -> anyhow::Result<()> {
        let blueprint = Blueprint::of(scene).with_context(|| format!("scene {}", scene.name))?;
        let mut contestants = Vec::new();
        for &setup in &group.setups {
            if let Some(mut contestant) = self.enter(scene, setup)? {
                contestant.advance(group.before, |c| c.engine.run(group.before));
                contestants.push(contestant);
            }
            tick();
        }
        for _ in 0..group.windows {
            for contestant in &mut contestants {
                contestant.advance(1 + group.steps, |c| c.engine.window(group.steps, &mut c.samples_ms));
            }
            tick();
        }
        for Contestant { setup, engine, samples_ms, steps, stopped } in contestants {
            if samples_ms.is_empty() {
                let why = stopped.unwrap_or_else(|| "no step was timed".to_owned());
                self.miss(scene, setup, format!("{} on {}: {why}", setup.engine, scene.name));
                continue;
            }
            let row = Row::of(scene, &blueprint, setup, engine.as_ref(), &samples_ms, steps, stopped);
            self.rows.push(row);
        }
        Ok(())
    }

    /// Notes what an engine could not run, once.
    fn miss(&mut self, scene: &Scene, setup: Setup, why: String) {
        let missing = Missing { scene: scene.name.clone(), engine: setup.engine.name(), why };
        if !self.gaps.contains(&missing) {
            self.gaps.push(missing);
        }
    }

    /// A new contestant; `None`, and a gap, where the engine cannot express the scene.
    fn enter(&mut self, scene: &Scene, setup: Setup) -> anyhow::Result<Option<Contestant>> {
        match engine::build(scene, setup) {
            Ok(engine) => {
                Ok(Some(Contestant { setup, engine, samples_ms: Vec::new(), steps: 0, stopped: None }))
            }
            Err(error) => {
                let why = error.downcast_ref::<Gap>().map(ToString::to_string);
                let Some(why) = why else { return Err(error.context(format!("scene {}", scene.name))) };
                self.miss(scene, setup, why);
                Ok(None)
            }
        }
    }
}

/// How often [`Results::add`] calls its `tick`.
pub fn ticks(group: &Group) -> u64 {
    (group.setups.len() + group.windows) as u64
}
