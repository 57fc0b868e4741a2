//! A world behind one interface, whatever its precision and lane width: what the program, the benches
//! and the tests drive. The width is chosen here, once, and nowhere else.

use crate::body::{Bodies, BodyError, BodyId, Form};
use crate::contact::Contact;
use crate::event::Action;
use crate::force::Forces;
use crate::joint::Joints;
use crate::lanes::{Lanes, Real, f32s, f64s};
use crate::measure::{self, Counts, Invariants, Outline, Penetration, StageTimes};
use crate::scene::{BodyKind, BodySpec, Scene};
use crate::settings::{Broad, Precision, Settings};
use crate::world::{ActionError, Acts, BodyTable, Pull, Snapshot, StepError, World, WorldError};

/// One body's state, spelled out in `f64`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyState {
    /// Centroid, metres.
    pub position: [f64; 2],
    /// cos and sin of the attitude.
    pub rotation: [f64; 2],
    /// m/s.
    pub velocity: [f64; 2],
    /// rad/s.
    pub angular_velocity: f64,
}

/// One body: which it is, its state, and what moves it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyView {
    /// Its id.
    pub id: BodyId,
    /// Static, kinematic or dynamic.
    pub kind: BodyKind,
    /// Pose and velocity.
    pub state: BodyState,
    /// 1/kg; 0 where nothing can push it.
    pub inv_mass: f64,
    /// 1/(kg·m²); 0 where nothing can turn it.
    pub inv_inertia: f64,
}

/// A world of any precision and lane width.
pub trait Simulation: Send {
    /// Advances by `dt_secs`.
    ///
    /// # Errors
    /// Those of [`World::step`].
    fn step(&mut self, dt_secs: f64) -> Result<(), StepError>;
    /// Advances by the step of its settings.
    ///
    /// # Errors
    /// Those of [`World::step`].
    fn advance(&mut self) -> Result<(), StepError> {
        self.step(self.settings().dt_secs)
    }
    /// The settings.
    fn settings(&self) -> &Settings;
    /// Steps taken.
    fn steps(&self) -> u64;
    /// Living bodies, static ones included.
    fn bodies(&self) -> usize;
    /// The states of living bodies, in slot order.
    fn states(&self) -> Vec<BodyState>;
    /// The contacts found at the beginning of the last step, with their gaps and impulses at its end.
    fn contacts(&self) -> Vec<Contact>;
    /// What the last step counted.
    fn counts(&self) -> Counts;
    /// Bodies that sleep.
    fn sleeping(&self) -> usize;
    /// Bytes that a pass of the solver streams per two-point and per one-point contact.
    fn bytes_per_contact(&self) -> [usize; 2];
    /// Time per stage since the last reset.
    fn times(&self) -> StageTimes;
    /// Sets stage times to zero.
    fn reset_times(&mut self);
    /// From now on every step is timed; see [`World::time_every_step`].
    fn time_every_step(&mut self);
    /// Hash of pose and velocity columns.
    fn hash(&self) -> u64;
    /// Energy and momentum.
    fn invariants(&self) -> Invariants;
    /// Discs and outlines of living bodies.
    fn outlines(&self) -> Vec<Outline>;
    /// Overlaps, by the `f64` check.
    fn penetration(&self) -> Penetration {
        measure::penetration(&self.outlines())
    }
    /// Poses, velocities and, if wanted, contacts as bytes; see [`World::snapshot`].
    fn snapshot(&self, into: &mut Snapshot, contacts: bool);
    /// What bodies are, and the fields they move in.
    fn body_table(&self) -> BodyTable;
    /// The body in a slot; `None` where none lives.
    fn body(&self, slot: usize) -> Option<BodyView>;
    /// Takes a body in; see [`World::insert`].
    ///
    /// # Errors
    /// Those of [`World::insert`].
    fn insert(&mut self, spec: &BodySpec) -> Result<BodyId, BodyError>;
    /// Takes a body out; see [`World::remove`].
    ///
    /// # Errors
    /// An id whose body is gone.
    fn remove(&mut self, id: BodyId) -> Result<(), BodyError>;
    /// Makes a body static, kinematic or dynamic; see [`World::set_kind`].
    ///
    /// # Errors
    /// Those of [`World::set_kind`].
    fn set_kind(&mut self, id: BodyId, kind: BodyKind, mass: Option<f64>) -> Result<(), BodyError>;
    /// Adds an impulse, N·s and N·m·s; see [`World::apply_impulse`].
    ///
    /// # Errors
    /// Those of [`World::apply_impulse`].
    fn apply_impulse(&mut self, id: BodyId, linear: [f64; 2], angular: f64) -> Result<(), BodyError>;
    /// Does something before the next step; see [`World::act`]. Returns the id of a body that came.
    ///
    /// # Errors
    /// Those of [`World::act`].
    fn act(&mut self, action: &Action) -> Result<Option<BodyId>, ActionError>;
    /// What is pulled.
    fn pulled(&self) -> Option<&Pull>;
    /// Sets the fields; see [`World::set_forces`].
    ///
    /// # Errors
    /// Fields that cannot be run with.
    fn set_forces(&mut self, forces: Forces) -> Result<(), WorldError>;
    /// Goes on with other settings; see [`World::set_settings`].
    ///
    /// # Errors
    /// Those of [`World::set_settings`].
    fn set_settings(&mut self, settings: Settings) -> Result<(), WorldError>;
    /// The candidate pairs of the last step.
    fn pairs(&self) -> Vec<[u32; 2]>;
    /// The method that found the last list of candidate pairs; before there is one, what `auto` stands for.
    fn broad_in_use(&self) -> Broad;
    /// A copy that goes its own way.
    fn duplicate(&self) -> Box<dyn Simulation>;
    /// Where the anchors of each joint lie, on its bodies A and B, metres.
    fn joint_anchors(&self) -> Vec<[[f64; 2]; 2]>;
    /// A world of other settings in the same state: bodies, joints, poses and velocities to the bit.
    ///
    /// # Errors
    /// Settings that cannot be run with, or of another precision.
    fn with_settings(&self, settings: Settings) -> Result<Box<dyn Simulation>, WorldError>;
}

/// Builds a world for a scene with the precision and lanes that `settings` name.
///
/// # Errors
/// Settings, fields or bodies that cannot be run with.
pub fn simulate(scene: &Scene, settings: Settings) -> Result<Box<dyn Simulation>, WorldError> {
    settings.check()?;
    match (settings.precision, settings.lanes) {
        (Precision::F32, 1) => boxed::<f32s::X1>(scene, settings),
        (Precision::F32, 4) => boxed::<f32s::X4>(scene, settings),
        (Precision::F32, 8) => boxed::<f32s::X8>(scene, settings),
        (Precision::F32, _) => boxed::<f32s::X16>(scene, settings),
        (Precision::F64, 1) => boxed::<f64s::X1>(scene, settings),
        (Precision::F64, _) => boxed::<f64s::X4>(scene, settings),
    }
}

fn boxed<L: Lanes>(scene: &Scene, settings: Settings) -> Result<Box<dyn Simulation>, WorldError>
where
    (Bodies<L::Elem>, Joints<L::Elem>, Acts): IntoWorld,
{
    Ok(Box::new(World::<L>::from_scene(scene, settings)?))
}

/// Bodies and joints of a precision and what is yet to be done to them, into a world of any of its widths.
pub trait IntoWorld: Sized {
    /// Builds the world that `settings` name around these.
    ///
    /// # Errors
    /// Settings that cannot be run with, or of another precision.
    fn into_world(self, forces: Forces, settings: Settings) -> Result<Box<dyn Simulation>, WorldError>;
}

impl IntoWorld for (Bodies<f32>, Joints<f32>, Acts) {
    fn into_world(self, forces: Forces, settings: Settings) -> Result<Box<dyn Simulation>, WorldError> {
        let (bodies, joints, acts) = self;
        Ok(match settings.lanes {
            1 => Box::new(World::<f32s::X1>::from_parts(bodies, joints, forces, settings)?.with_acts(acts)),
            4 => Box::new(World::<f32s::X4>::from_parts(bodies, joints, forces, settings)?.with_acts(acts)),
            8 => Box::new(World::<f32s::X8>::from_parts(bodies, joints, forces, settings)?.with_acts(acts)),
            _ => Box::new(World::<f32s::X16>::from_parts(bodies, joints, forces, settings)?.with_acts(acts)),
        })
    }
}

impl IntoWorld for (Bodies<f64>, Joints<f64>, Acts) {
    fn into_world(self, forces: Forces, settings: Settings) -> Result<Box<dyn Simulation>, WorldError> {
        let (bodies, joints, acts) = self;
        Ok(match settings.lanes {
            1 => Box::new(World::<f64s::X1>::from_parts(bodies, joints, forces, settings)?.with_acts(acts)),
            _ => Box::new(World::<f64s::X4>::from_parts(bodies, joints, forces, settings)?.with_acts(acts)),
        })
    }
}

/// The state of the body in a slot.
fn state<R: Real>(bodies: &Bodies<R>, slot: usize) -> BodyState {
    BodyState {
        position: bodies.place(slot),
        rotation: [bodies.c[slot].to_f64(), bodies.s[slot].to_f64()],
        velocity: [bodies.vx[slot].to_f64(), bodies.vy[slot].to_f64()],
        angular_velocity: bodies.w[slot].to_f64(),
    }
}

impl<L: Lanes> Simulation for World<L>
where
    (Bodies<L::Elem>, Joints<L::Elem>, Acts): IntoWorld,
{
    fn step(&mut self, dt_secs: f64) -> Result<(), StepError> {
        self.step(dt_secs)
    }
    fn settings(&self) -> &Settings {
        self.settings()
    }
    fn steps(&self) -> u64 {
        self.steps()
    }
    fn bodies(&self) -> usize {
        self.bodies().live()
    }
    fn states(&self) -> Vec<BodyState> {
        self.bodies().slots().map(|slot| state(self.bodies(), slot)).collect()
    }
    fn body(&self, slot: usize) -> Option<BodyView> {
        let bodies = self.bodies();
        let id = bodies.id(slot)?;
        let (inv_mass, inv_inertia) = (bodies.inv_mass[slot].to_f64(), bodies.inv_inertia[slot].to_f64());
        Some(BodyView { id, kind: bodies.kind(slot), state: state(bodies, slot), inv_mass, inv_inertia })
    }
    fn insert(&mut self, spec: &BodySpec) -> Result<BodyId, BodyError> {
        self.insert(spec)
    }
    fn remove(&mut self, id: BodyId) -> Result<(), BodyError> {
        self.remove(id)
    }
    fn set_kind(&mut self, id: BodyId, kind: BodyKind, mass: Option<f64>) -> Result<(), BodyError> {
        self.set_kind(id, kind, mass)
    }
    fn apply_impulse(&mut self, id: BodyId, linear: [f64; 2], angular: f64) -> Result<(), BodyError> {
        self.apply_impulse(id, linear, angular)
    }
    fn act(&mut self, action: &Action) -> Result<Option<BodyId>, ActionError> {
        self.act(action)
    }
    fn pulled(&self) -> Option<&Pull> {
        self.pulled()
    }
    fn set_forces(&mut self, forces: Forces) -> Result<(), WorldError> {
        Ok(self.set_forces(forces)?)
    }
    fn set_settings(&mut self, settings: Settings) -> Result<(), WorldError> {
        self.set_settings(settings)
    }
    fn contacts(&self) -> Vec<Contact> {
        self.contacts()
    }
    fn counts(&self) -> Counts {
        *self.counts()
    }
    fn sleeping(&self) -> usize {
        self.sleeping()
    }
    fn bytes_per_contact(&self) -> [usize; 2] {
        crate::solve::stream::Stream::<L>::bytes_per_contact()
    }
    fn times(&self) -> StageTimes {
        *self.times()
    }
    fn reset_times(&mut self) {
        self.reset_times();
    }
    fn time_every_step(&mut self) {
        self.time_every_step();
    }
    fn hash(&self) -> u64 {
        self.hash()
    }
    fn invariants(&self) -> Invariants {
        measure::invariants(self.bodies(), self.forces())
    }
    fn outlines(&self) -> Vec<Outline> {
        let bodies = self.bodies();
        let outline = |slot: usize| {
            let centre = bodies.place(slot);
            let disc = bodies.form(slot) == Form::Circle;
            Outline {
                centre,
                radius: if disc { bodies.extent_x[slot].to_f64() } else { 0.0 },
                vertices: bodies.outline(slot).iter().map(|v| [centre[0] + v[0], centre[1] + v[1]]).collect(),
                fixed: bodies.kind(slot) == BodyKind::Static,
            }
        };
        bodies.slots().map(outline).collect()
    }
    fn snapshot(&self, into: &mut Snapshot, contacts: bool) {
        self.snapshot(into, contacts);
    }
    fn body_table(&self) -> BodyTable {
        self.body_table()
    }
    fn pairs(&self) -> Vec<[u32; 2]> {
        self.pairs().to_vec()
    }
    fn joint_anchors(&self) -> Vec<[[f64; 2]; 2]> {
        let joints = self.joints();
        joints.ids().filter_map(|id| joints.anchors_world(id, self.bodies()).ok()).collect()
    }
    fn broad_in_use(&self) -> Broad {
        World::broad_in_use(self)
    }
    fn duplicate(&self) -> Box<dyn Simulation> {
        Box::new(self.clone())
    }
    fn with_settings(&self, settings: Settings) -> Result<Box<dyn Simulation>, WorldError> {
        if settings.precision.name() != <L::Elem as Real>::NAME {
            return Err(WorldError::Precision { have: <L::Elem as Real>::NAME, asked: settings.precision });
        }
        let joints = self.joints().clone().without_impulses();
        let parts = (self.bodies().clone(), joints, self.acts_from_now());
        parts.into_world(self.forces().after(self.time_secs()), settings)
    }
}
