//! A run that is acted upon: bodies come and go, one is pulled about, settings change, and everything done is an
//! [`Event`], so that the same run can be had again, to the bit.
//!
//! A run made of the same scene, settings and events is the same at every lane width.

use crate::scene::Scene;
use crate::settings::Settings;
use crate::simulation::{Simulation, simulate};
use crate::world::{StepError, WorldError};

pub use crate::event::{Action, Event};
pub use crate::world::{ActionError, Pull};

/// A world with the events that made it what it is.
pub struct Session {
    world: Box<dyn Simulation>,
    events: Vec<Event>,
}

impl std::fmt::Debug for Session {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Session")
            .field("steps", &self.world.steps())
            .field("events", &self.events.len())
            .finish_non_exhaustive()
    }
}

impl Session {
    /// A session at the beginning of a scene.
    ///
    /// # Errors
    /// Those of [`simulate`].
    pub fn new(scene: &Scene, settings: Settings) -> Result<Self, WorldError> {
        let mut world = simulate(scene, settings)?;
        // Who watches a session looks at single steps.
        world.time_every_step();
        Ok(Self { world, events: Vec::new() })
    }

    /// The world.
    pub fn world(&self) -> &dyn Simulation {
        self.world.as_ref()
    }
    /// What was done so far; what the scene does to itself is not among it.
    pub fn events(&self) -> &[Event] {
        &self.events
    }
    /// What is pulled.
    pub fn pull(&self) -> Option<&Pull> {
        self.world.pulled()
    }

    /// Does something before the next step. Returns the slot of a body that came.
    ///
    /// # Errors
    /// A slot without a body, numbers that cannot be run with.
    pub fn apply(&mut self, action: Action) -> Result<Option<u32>, ActionError> {
        let came = self.world.act(&action)?;
        self.events.push(Event { step: self.world.steps(), action });
        Ok(came.map(|id| id.slot() as u32))
    }

    /// Advances by the step of the settings.
    ///
    /// # Errors
    /// Those of [`crate::world::World::step`].
    pub fn step(&mut self) -> Result<(), StepError> {
        self.world.advance()
    }

    /// Advances to a step, doing `events` when they are due: those of steps before the world's own have been done.
    ///
    /// # Errors
    /// An event that is refused, or one of the scene that cannot be done.
    pub fn follow(&mut self, events: &[Event], to: u64) -> Result<(), ActionError> {
        while self.world.steps() < to {
            let now = self.world.steps();
            let due = events.partition_point(|event| event.step < now);
            for event in events[due..].iter().take_while(|event| event.step == now) {
                self.apply(event.action.clone())?;
            }
            // A state that is not finite was one when it was recorded: it is compared like any other.
            if let Err(why @ StepError::Event { .. }) = self.step() {
                return Err(ActionError::Event(why.to_string()));
            }
        }
        Ok(())
    }
}
