//! Worlds, made from bodies and scenes.

use super::act::Acts;
use super::made_from::MadeFrom;
use super::{Laws, Log, World, WorldError};
use crate::body::Bodies;
use crate::broad::BroadPhase;
use crate::continuous::Continuous;
use crate::force::Forces;
use crate::integrate::Stiff;
use crate::island::Islands;
use crate::joint::{JointError, Joints};
use crate::lanes::Lanes;
use crate::motion::Motion;
use crate::narrow::Narrow;
use crate::scene::{Scene, SceneError};
use crate::settings::{Precision, Settings};
use crate::solve::{SceneNeeds, Solving};

impl<L: Lanes> World<L> {
    /// An empty world.
    ///
    /// # Errors
    /// Settings or fields that cannot be run with.
    pub fn new(forces: Forces, settings: Settings) -> Result<Self, WorldError> {
        Self::from_bodies(Bodies::new(), forces, settings)
    }

    /// A world around existing bodies.
    ///
    /// # Errors
    /// Settings or fields that cannot be run with.
    pub fn from_bodies(
        bodies: Bodies<L::Elem>,
        forces: Forces,
        settings: Settings,
    ) -> Result<Self, WorldError> {
        Self::from_parts(bodies, Joints::default(), forces, settings)
    }

    /// A world around existing bodies and the joints between them; those of which a body is gone go with the first
    /// step. Lanes and precision of its settings are those of its type.
    ///
    /// # Errors
    /// Settings or fields that cannot be run with.
    pub fn from_parts(
        bodies: Bodies<L::Elem>,
        joints: Joints<L::Elem>,
        forces: Forces,
        settings: Settings,
    ) -> Result<Self, WorldError> {
        // The type has decided; settings that came from elsewhere must not say otherwise.
        let settings = Settings { lanes: L::WIDTH, precision: Precision::of::<L::Elem>(), ..settings };
        settings.check()?;
        forces.check_in::<L::Elem>().map_err(SceneError::from)?;
        forces.check_coupling(bodies.len(), &settings).map_err(SceneError::from)?;
        let mut bodies = bodies;
        bodies.set_fine(settings.is_fine());
        let laws = Laws {
            forces,
            fields: Vec::new(),
            stiff: Stiff::default(),
            needs: SceneNeeds::default(),
            revision: 0,
            acts: Acts::default(),
        };
        Ok(Self {
            bodies,
            joints,
            settings,
            laws,
            broad: BroadPhase::default(),
            narrow: Narrow::default(),
            solving: Solving::default(),
            motion: Motion::default(),
            continuous: Continuous::default(),
            islands: Islands::default(),
            made: MadeFrom::default(),
            log: Log::default(),
        })
    }

    /// A world with the bodies and joints of a scene, in their order: the k-th body is in slot k + 1. Lanes and precision of
    /// its settings are those of its type, whatever `settings` say; their step is that of `settings`, not the scene's
    /// (which [`load`](crate::scene::load) puts there).
    ///
    /// # Errors
    /// Settings, fields, bodies, joints or events that cannot be run with.
    pub fn from_scene(scene: &Scene, settings: Settings) -> Result<Self, WorldError> {
        let mut world = Self::new(scene.forces, settings)?;
        let insert = |spec| world.insert(spec).map_err(SceneError::from);
        let ids: Vec<_> = scene.bodies.iter().map(insert).collect::<Result<_, _>>()?;
        for (joint, spec) in scene.joints.iter().enumerate() {
            let id = |body: usize| {
                let missing = JointError::MissingBody { joint, body, bodies: ids.len() };
                ids.get(body).copied().ok_or(SceneError::from(missing))
            };
            let ends = [id(spec.bodies[0])?, id(spec.bodies[1])?];
            world.insert_joint(ends, spec.kind.clone(), spec.collide).map_err(SceneError::from)?;
        }
        world.plan(&scene.events, ids)?;
        Ok(world)
    }
}
