//! What is done to a world between two steps: by whoever holds it, and by events of its scene when they are due.

use super::{StepError, World, WorldError};
use crate::body::{Bodies, BodyError, BodyId, BodyKind};
use crate::each::Each as _;
use crate::event::{Action, SceneEvent, When};
use crate::joint::{JointError, Motor};
use crate::lanes::{Lanes, Real};
use crate::scene::SceneError;
use crate::settings::{Settings, Solver};

/// Undamped oscillations per second of the spring that pulls a body, as if nothing else were about.
const PULL_HERTZ: f64 = 5.0;
/// Its damping ratio.
const PULL_DAMPING: f64 = 0.9;
/// It changes a body's velocity by no more than this, m/s².
const PULL_MOST: f64 = 1000.0;

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
    /// What the scene does to itself could not be done.
    #[error("{0}")]
    Event(String),
    /// A body or its mass.
    #[error(transparent)]
    Body(#[from] BodyError),
    /// A joint's motor.
    #[error(transparent)]
    Joint(#[from] JointError),
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

/// What a scene's events have yet to do, and what is pulled.
#[derive(Clone, Debug, Default)]
pub struct Acts {
    /// With their numbers in the scene, in its order.
    waiting: Vec<(usize, SceneEvent)>,
    /// The bodies that came by scene and events, in the order of their coming.
    came: Vec<BodyId>,
    pull: Option<Pull>,
}

impl Acts {
    /// The same for a world that counts steps and seconds from now on.
    fn after(mut self, steps: u64, time_secs: f64) -> Self {
        for (_, event) in &mut self.waiting {
            event.at = match event.at {
                When::Step(step) => When::Step(step.saturating_sub(steps)),
                When::Time(secs) => When::Time((secs - time_secs).max(0.0)),
            };
        }
        self
    }

    /// Is nothing to be done, now or later?
    fn is_empty(&self) -> bool {
        self.waiting.is_empty() && self.pull.is_none()
    }
}

impl<L: Lanes> World<L> {
    /// Takes in a scene's events, each of which is tried on a copy first.
    pub(super) fn plan(&mut self, events: &[SceneEvent], came: Vec<BodyId>) -> Result<(), SceneError> {
        if events.is_empty() {
            return Ok(());
        }
        let dt_secs = self.settings.dt_secs;
        let mut in_turn: Vec<_> = events.iter().cloned().enumerate().collect();
        let mut trial = self.clone();
        trial.laws.acts.came.clone_from(&came);
        SceneEvent::sort(&mut in_turn, dt_secs);
        for (event, at) in in_turn {
            let done = if at.secs(dt_secs) < 0.0 || !at.secs(dt_secs).is_finite() {
                Err(format!("time must be finite and at least 0, got {:?}", at.secs(dt_secs)))
            } else {
                trial.perform(at.action)
            };
            done.map_err(|why| SceneError::Event { event, why })?;
        }
        self.laws.acts = Acts { waiting: events.iter().cloned().enumerate().collect(), came, pull: None };
        Ok(())
    }

    /// Does what is due before the step that begins, and pulls what is pulled.
    pub(super) fn act_before(&mut self, dt_secs: f64) -> Result<(), StepError> {
        if self.laws.acts.is_empty() {
            return Ok(());
        }
        let (steps, time_secs) = (self.log.steps, self.log.time_secs);
        let is_due = |event: &mut (usize, SceneEvent)| event.1.is_due(steps, time_secs, dt_secs);
        let mut due: Vec<_> = self.laws.acts.waiting.extract_if(.., is_due).collect();
        // In the order they were tried in.
        SceneEvent::sort(&mut due, dt_secs);
        for k in 0..due.len() {
            let (event, at) = due[k].clone();
            if let Err(why) = self.perform(at.action) {
                self.laws.acts.waiting.splice(0..0, due.drain(k..));
                return Err(StepError::Event { step: steps + 1, event, why });
            }
        }
        if let Some(pull) = self.laws.acts.pull {
            match self.bodies.check_alive(pull.id).map(|slot| self.bodies.kind(slot)) {
                Ok(BodyKind::Dynamic) => {
                    let (linear, angular) = impulse_of(&self.bodies, &pull, dt_secs);
                    // What is too large for the precision pulls not at all.
                    let _ = self.apply_impulse(pull.id, linear, angular);
                }
                _ => self.laws.acts.pull = None,
            }
        }
        Ok(())
    }

    /// Does what an event of the scene says, whose bodies are named in the order of their coming.
    fn perform(&mut self, mut action: Action) -> Result<(), String> {
        let name = action.name();
        let mut named = String::new();
        if let Some(slot) = action.slot_mut() {
            let body = slot.wrapping_sub(1);
            named = format!(", body {body}");
            let came = self.laws.acts.came.get(body as usize).copied();
            let alive = came.filter(|&id| self.bodies.check_alive(id).is_ok());
            let why = if came.is_none() { "there is none" } else { "it is gone by then" };
            *slot = alive.ok_or(format!("{name}{named}: {why}"))?.slot() as u32;
        }
        let came = self.act(&action).map_err(|why| format!("{name}{named}: {why}"))?;
        self.laws.acts.came.extend(came);
        Ok(())
    }

    /// Does something before the next step. Returns the id of a body that came.
    ///
    /// # Errors
    /// A slot without a body, a place without a joint, numbers that cannot be run with. Nothing has changed then.
    pub fn act(&mut self, action: &Action) -> Result<Option<BodyId>, ActionError> {
        let living = |slot: u32| self.bodies.id(slot as usize).ok_or(ActionError::NoBody(slot));
        match action {
            Action::Insert(spec) => return Ok(Some(self.insert(spec)?)),
            Action::Remove { slot } => self.remove(living(*slot)?)?,
            Action::Change { slot, kind, mass } => self.set_kind(living(*slot)?, *kind, *mass)?,
            Action::Teleport { slot, position, angle } => {
                self.set_pose(living(*slot)?, *position, *angle)?;
            }
            Action::Velocity { slot, velocity, angular_velocity } => {
                self.set_velocity(living(*slot)?, *velocity, *angular_velocity)?;
            }
            Action::Impulse { slot, linear, angular } => {
                self.apply_impulse(living(*slot)?, *linear, *angular)?;
            }
            Action::Force { slot, force, torque } => self.set_force(living(*slot)?, *force, *torque)?,
            &Action::Motor { joint, speed, max_torque } => {
                self.set_motor(joint, Motor { speed, max_torque })?;
            }
            Action::Pull { slot, point_body, target } => {
                let places = point_body.each(|v| ("point_body", v)).into_iter();
                let mut places = places.chain(target.each(|v| ("target", v)));
                if let Some((field, value)) = places.find(|(_, value)| !value.is_finite()) {
                    return Err(ActionError::NonFinite { field, value });
                }
                let id = living(*slot)?;
                if self.bodies.kind(id.slot()) != BodyKind::Dynamic {
                    return Err(BodyError::NotDynamic(*slot).into());
                }
                self.laws.acts.pull = Some(Pull { id, point_body: *point_body, target: *target });
            }
            Action::LetGo => self.laws.acts.pull = None,
            Action::Choose { integrator, solver, substeps } => {
                let (integrator, solver, substeps) = (*integrator, *solver, *substeps);
                let settings = self.settings;
                let of_soft = |asked: Option<f64>| asked.filter(|_| solver == Solver::Soft);
                let [max_sag, stiffness] = [settings.max_sag, settings.stiffness].each(of_soft);
                let asked = Settings { integrator, solver, substeps, max_sag, stiffness, ..settings };
                self.set_settings(asked)?;
            }
            Action::Fields(forces) => self.set_forces(**forces).map_err(WorldError::from)?,
        }
        Ok(None)
    }

    /// What a world in this state, whose steps are counted from now on, has yet to do.
    pub(crate) fn acts_from_now(&self) -> Acts {
        self.laws.acts.clone().after(self.log.steps, self.log.time_secs)
    }

    /// The same world with that to do.
    #[must_use]
    pub(crate) fn with_acts(mut self, acts: Acts) -> Self {
        self.laws.acts = acts;
        self
    }

    /// What is pulled.
    pub fn pulled(&self) -> Option<&Pull> {
        self.laws.acts.pull.as_ref()
    }
}

/// The impulse (N·s, N·m·s) of a damped spring between a point of a body and its target over a step, by the end of
/// which it is worked out, so that no step is too long for it.
///
/// With k and c of the spring for the body's mass: γ = 1/(h(c + hk)), β = hk/(c + hk), and p = −(K + γ)⁻¹(v + βC/h),
/// where K is the inverse mass seen at the point, v its velocity and C its distance from the target
/// (E. Catto, "Soft Constraints", GDC 2011).
fn impulse_of<R: Real>(bodies: &Bodies<R>, pull: &Pull, h_secs: f64) -> ([f64; 2], f64) {
    let slot = pull.id.slot();
    let [c, s, w, vx, vy, m, i] =
        [&bodies.c, &bodies.s, &bodies.w, &bodies.vx, &bodies.vy, &bodies.inv_mass, &bodies.inv_inertia]
            .each(|column| column[slot].to_f64());
    let position = bodies.place(slot);
    let [px, py] = pull.point_body;
    let arm = [c * px - s * py, s * px + c * py];
    let velocity = [vx - w * arm[1], vy + w * arm[0]];
    let mass = 1.0 / m;
    let omega = std::f64::consts::TAU * PULL_HERTZ;
    let (stiffness, damping) = (mass * omega * omega, 2.0 * mass * PULL_DAMPING * omega);
    let soft = damping + h_secs * stiffness;
    let (gamma, beta) = (1.0 / (h_secs * soft), stiffness / soft);
    let wanted = [0, 1].each(|k| velocity[k] + beta * (position[k] + arm[k] - pull.target[k]));
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
