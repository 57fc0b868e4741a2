//! A run that is acted upon: bodies come and go, one is pulled about, settings change, and everything done is an
//! [`Event`], so that the same run can be had again, to the bit.
//!
//! An event holds concrete numbers only. What one does depends on nothing but them and the world's state, which is the
//! same at every lane width; so is a run made of the same scene, settings and events.

use serde::{Deserialize, Serialize};

use crate::body::{BodyError, BodyId};
use crate::each::Each as _;
use crate::force::Forces;
use crate::pair;
use crate::scene::{BodyKind, BodySpec, Scene};
use crate::settings::{Integrator, Settings, Solver};
use crate::simulation::{BodyView, Simulation, simulate};
use crate::world::{StepError, WorldError};

/// Undamped oscillations per second of the spring that pulls a body, as if nothing else were about.
const PULL_HERTZ: f64 = 5.0;
/// Its damping ratio.
const PULL_DAMPING: f64 = 0.9;
/// It changes a body's velocity by no more than this, m/s².
const PULL_MOST: f64 = 1000.0;

/// Something done to a world between two steps. Bodies are named by their slots.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Action {
    /// A body comes.
    Insert(Box<BodySpec>),
    /// A body goes, and its joints with it.
    Remove {
        /// The body.
        slot: u32,
    },
    /// A body becomes static, kinematic or dynamic.
    Change {
        /// The body.
        slot: u32,
        /// What it becomes.
        kind: BodyKind,
        /// Kilograms; its area times 1 kg/m² where left out.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        mass: Option<f64>,
    },
    /// A dynamic body is pulled until [`Action::LetGo`], or until another is.
    Pull {
        /// The body.
        slot: u32,
        /// Where it is held, metres from its centroid in its own axes.
        #[serde(deserialize_with = "pair::required")]
        point_body: [f64; 2],
        /// Where that point is to be, metres.
        #[serde(deserialize_with = "pair::required")]
        target: [f64; 2],
    },
    /// What is pulled is let go.
    LetGo,
    /// Other methods from here on; a bound on the sag goes with the solver that knows one.
    Choose {
        /// Smooth motion.
        integrator: Integrator,
        /// Contacts.
        solver: Solver,
        /// Rounds per step.
        substeps: u32,
    },
    /// Other fields from here on.
    Fields(Box<Forces>),
}

/// An action and when it was done.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Event {
    /// After this step, before the next one.
    pub step: u64,
    /// What was done.
    pub action: Action,
}

/// Why an action was refused; nothing has changed then.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ActionError {
    /// No living body is there.
    #[error("no body lives in slot {0}")]
    NoBody(u32),
    /// A pull needs places.
    #[error("pull: {field} is not finite: {value:?}")]
    NonFinite {
        /// Which.
        field: &'static str,
        /// What was given.
        value: f64,
    },
    /// A body or its mass.
    #[error(transparent)]
    Body(#[from] BodyError),
    /// A setting or a field.
    #[error(transparent)]
    World(#[from] WorldError),
}

/// What is pulled, where, and where to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pull {
    /// The body.
    pub id: BodyId,
    /// Metres from its centroid, its own axes.
    pub point_body: [f64; 2],
    /// Metres.
    pub target: [f64; 2],
}

/// A world with the events that made it what it is.
pub struct Session {
    world: Box<dyn Simulation>,
    events: Vec<Event>,
    pull: Option<Pull>,
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
        Ok(Self { world, events: Vec::new(), pull: None })
    }

    /// The world.
    pub fn world(&self) -> &dyn Simulation {
        self.world.as_ref()
    }
    /// What was done so far.
    pub fn events(&self) -> &[Event] {
        &self.events
    }
    /// What is pulled.
    pub fn pull(&self) -> Option<&Pull> {
        self.pull.as_ref()
    }

    /// Does something before the next step. Returns the slot of a body that came.
    ///
    /// # Errors
    /// A slot without a body, numbers that cannot be run with.
    pub fn apply(&mut self, action: Action) -> Result<Option<u32>, ActionError> {
        let slot = self.perform(&action)?;
        self.events.push(Event { step: self.world.steps(), action });
        Ok(slot)
    }

    fn perform(&mut self, action: &Action) -> Result<Option<u32>, ActionError> {
        match action {
            Action::Insert(spec) => return Ok(Some(self.world.insert(spec)?.slot() as u32)),
            Action::Remove { slot } => self.world.remove(self.body(*slot)?.id)?,
            Action::Change { slot, kind, mass } => {
                let id = self.body(*slot)?.id;
                self.world.set_kind(id, *kind, *mass)?;
            }
            Action::Pull { slot, point_body, target } => {
                let places = point_body.each(|v| ("point_body", v)).into_iter();
                let mut places = places.chain(target.each(|v| ("target", v)));
                if let Some((field, value)) = places.find(|(_, value)| !value.is_finite()) {
                    return Err(ActionError::NonFinite { field, value });
                }
                let body = self.body(*slot)?;
                if body.kind != BodyKind::Dynamic {
                    return Err(BodyError::NotDynamic(*slot).into());
                }
                self.pull = Some(Pull { id: body.id, point_body: *point_body, target: *target });
            }
            Action::LetGo => self.pull = None,
            Action::Choose { integrator, solver, substeps } => {
                let (integrator, solver, substeps) = (*integrator, *solver, *substeps);
                let settings = *self.world.settings();
                let of_soft = |asked: Option<f64>| asked.filter(|_| solver == Solver::Soft);
                let [max_sag, stiffness] = [settings.max_sag, settings.stiffness].each(of_soft);
                let asked = Settings { integrator, solver, substeps, max_sag, stiffness, ..settings };
                self.world.set_settings(asked)?;
            }
            Action::Fields(forces) => self.world.set_forces(**forces)?,
        }
        Ok(None)
    }

    fn body(&self, slot: u32) -> Result<BodyView, ActionError> {
        self.world.body(slot as usize).ok_or(ActionError::NoBody(slot))
    }

    /// Advances by the step of the settings.
    ///
    /// # Errors
    /// Those of [`crate::world::World::step`].
    pub fn step(&mut self) -> Result<(), StepError> {
        let dt_secs = self.world.settings().dt_secs;
        let held = self.pull.and_then(|pull| Some((pull, self.world.body(pull.id.slot())?)));
        let held = held.filter(|(pull, body)| body.id == pull.id && body.kind == BodyKind::Dynamic);
        self.pull = held.map(|(pull, _)| pull);
        if let Some((pull, body)) = held {
            let (linear, angular) = impulse(&pull, &body, dt_secs);
            // What is too large for the precision pulls not at all.
            let _ = self.world.apply_impulse(pull.id, linear, angular);
        }
        self.world.step(dt_secs)
    }

    /// Advances to a step, doing `events` when they are due: those of steps before the world's own have been done.
    ///
    /// # Errors
    /// An event that is refused.
    pub fn follow(&mut self, events: &[Event], to: u64) -> Result<(), ActionError> {
        while self.world.steps() < to {
            let now = self.world.steps();
            let due = events.partition_point(|event| event.step < now);
            for event in events[due..].iter().take_while(|event| event.step == now) {
                self.apply(event.action.clone())?;
            }
            // A state that is not finite was one when it was recorded: it is compared like any other.
            let _ = self.step();
        }
        Ok(())
    }
}

/// The impulse (N·s, N·m·s) of a damped spring between a point of a body and its target over a step, by the end of
/// which it is worked out, so that no step is too long for it.
///
/// With k and c of the spring for the body's mass: γ = 1/(h(c + hk)), β = hk/(c + hk), and p = −(K + γ)⁻¹(v + βC/h),
/// where K is the inverse mass seen at the point, v its velocity and C its distance from the target
/// (E. Catto, "Soft Constraints", GDC 2011).
fn impulse(pull: &Pull, body: &BodyView, h_secs: f64) -> ([f64; 2], f64) {
    let state = &body.state;
    let [c, s] = state.rotation;
    let [px, py] = pull.point_body;
    let arm = [c * px - s * py, s * px + c * py];
    let w = state.angular_velocity;
    let velocity = [state.velocity[0] - w * arm[1], state.velocity[1] + w * arm[0]];
    let mass = 1.0 / body.inv_mass;
    let omega = std::f64::consts::TAU * PULL_HERTZ;
    let (stiffness, damping) = (mass * omega * omega, 2.0 * mass * PULL_DAMPING * omega);
    let soft = damping + h_secs * stiffness;
    let (gamma, beta) = (1.0 / (h_secs * soft), stiffness / soft);
    let wanted = [0, 1].each(|k| velocity[k] + beta * (state.position[k] + arm[k] - pull.target[k]));
    let (m, i) = (body.inv_mass, body.inv_inertia);
    let k11 = m + i * arm[1] * arm[1] + gamma;
    let k12 = -i * arm[0] * arm[1];
    let k22 = m + i * arm[0] * arm[0] + gamma;
    let inverse = 1.0 / (k11 * k22 - k12 * k12);
    let p = [-inverse * (k22 * wanted[0] - k12 * wanted[1]), -inverse * (k11 * wanted[1] - k12 * wanted[0])];
    let (length, most) = ((p[0] * p[0] + p[1] * p[1]).sqrt(), mass * PULL_MOST * h_secs);
    let scale = if length > most { most / length } else { 1.0 };
    let p = p.each(|part| part * scale);
    (p, arm[0] * p[1] - arm[1] * p[0])
}
