//! rapier2d: world, bodies and joints as a blueprint has them, the rest at its defaults.

mod joints;

use lamina2d::scene::BodyKind;
use lamina2d::shape::Shape;
use lamina2d::simulation::BodyState;
use rapier2d::math::{Pose, Rotation, Vector};
use rapier2d::parry::shape::ConvexPolygon;
use rapier2d::prelude::{
    CoefficientCombineRule, Collider, ColliderBuilder, Group, IntegrationParameters, InteractionGroups,
    InteractionTestMode, MassProperties, PhysicsWorld, RigidBody, RigidBodyBuilder, RigidBodyHandle,
    SharedShape,
};

use crate::blueprint::{Blueprint, Body, Driver};
use crate::engine::{self, Engine, Name, Setup};

/// A world of rapier.
#[expect(missing_debug_implementations, reason = "rapier's has none")]
pub struct Rapier {
    world: PhysicsWorld,
    bodies: Vec<RigidBodyHandle>,
    driver: Driver,
    dt_secs: f64,
    /// Steps run inside it, so that a step never waits for another thread to take it up. `None` without the
    /// feature `parallel`.
    #[cfg(feature = "parallel")]
    pool: std::sync::Arc<rayon::ThreadPool>,
}

/// Two numbers, rounded to rapier's precision.
fn vector(v: [f64; 2]) -> Vector {
    Vector::new(v[0] as f32, v[1] as f32)
}

fn rotation(r: [f64; 2]) -> Rotation {
    Rotation::from_cos_sin_unchecked(r[0] as f32, r[1] as f32)
}

impl Rapier {
    /// The world of a scene.
    ///
    /// # Errors
    /// What rapier has not: [`engine::Gap`]; threads that cannot be had.
    pub fn build(blueprint: &Blueprint, setup: Setup) -> anyhow::Result<Self> {
        blueprint.without_fields(Name::Rapier2d)?;
        let mut world = PhysicsWorld::new();
        world.gravity = vector(blueprint.gravity);
        world.integration_parameters = IntegrationParameters {
            dt: blueprint.dt_secs as f32,
            num_solver_iterations: setup.substeps as usize,
            ..IntegrationParameters::default()
        };
        let mut bodies = Vec::new();
        for (number, body) in blueprint.bodies.iter().enumerate() {
            let Some(collider) = collider(body) else {
                let lacks = format!("it refuses the outline of body {number}");
                return Err(blueprint.gap(Name::Rapier2d, lacks).into());
            };
            let (handle, _) = world.insert(rigid_body(body, setup.sleep), collider);
            // They stay until they are taken back.
            world.bodies[handle].add_force(vector(body.spec.force), false);
            world.bodies[handle].add_torque(body.spec.torque as f32, false);
            bodies.push(handle);
        }
        for (number, joint) in blueprint.joints.iter().enumerate() {
            let [a, b] = Blueprint::ends(joint).map(|k| bodies[k]);
            world.insert_impulse_joint(a, b, joints::joint(blueprint, number, joint)?);
        }
        #[cfg(not(feature = "parallel"))]
        anyhow::ensure!(
            setup.threads == 1,
            "rapier2d: built without the feature parallel, it has one thread"
        );
        Ok(Self {
            world,
            bodies,
            driver: blueprint.driver(),
            dt_secs: blueprint.dt_secs,
            #[cfg(feature = "parallel")]
            pool: rayon::ThreadPoolBuilder::new().num_threads(setup.threads).build()?.into(),
        })
    }

    /// Its defaults that decide a result, by name.
    pub fn defaults() -> Vec<(&'static str, f32)> {
        let p = IntegrationParameters::default();
        vec![
            ("contact_hertz", p.contact_softness.natural_frequency),
            ("contact_damping_ratio", p.contact_softness.damping_ratio),
            ("static_contact_hertz", p.static_contact_softness.natural_frequency),
            ("prediction_distance_m", p.prediction_distance()),
            ("allowed_linear_error_m", p.allowed_linear_error()),
            ("max_corrective_velocity_m_per_s", p.max_corrective_velocity()),
            ("internal_pgs_iterations", p.num_internal_pgs_iterations as f32),
            ("stabilization_iterations", p.num_internal_stabilization_iterations as f32),
            ("max_ccd_substeps", p.max_ccd_substeps as f32),
        ]
    }
}

impl Engine for Rapier {
    fn step(&mut self) -> anyhow::Result<()> {
        if !self.driver.driven().is_empty() {
            let (world, bodies) = (&mut self.world, &self.bodies);
            let moves = self.driver.velocities(self.dt_secs, |body| state(&world.bodies[bodies[body]]));
            for (&body, (velocity, spin)) in self.driver.driven().iter().zip(moves) {
                let body = &mut world.bodies[bodies[body]];
                body.set_linvel(vector(velocity), true);
                body.set_angvel(spin as f32, true);
            }
        }
        self.world.step();
        let broken = self.world.quarantine();
        anyhow::ensure!(broken.is_empty(), "rapier2d took bodies out whose state was not finite");
        Ok(())
    }

    #[cfg(feature = "parallel")]
    fn run(&mut self, count: usize) -> anyhow::Result<()> {
        let pool = self.pool.clone();
        pool.install(|| engine::steps(self, count))
    }

    #[cfg(feature = "parallel")]
    fn window(&mut self, count: usize, samples_ms: &mut Vec<f64>) -> anyhow::Result<()> {
        let pool = self.pool.clone();
        pool.install(|| engine::timed(self, count, samples_ms))
    }

    fn states(&self) -> Vec<BodyState> {
        self.bodies.iter().map(|&handle| state(&self.world.bodies[handle])).collect()
    }

    fn contacts(&self) -> usize {
        let touching = |m: &rapier2d::prelude::ContactManifold| m.data.num_active_contacts() > 0;
        self.world.contact_pairs().filter(|pair| pair.solver_manifolds().iter().any(touching)).count()
    }

    fn masses(&self) -> Vec<[f64; 2]> {
        let inverse = |value: f32| if value == 0.0 { 0.0 } else { 1.0 / f64::from(value) };
        let of = |handle: &RigidBodyHandle| {
            let body = &self.world.bodies[*handle];
            let local = body.mass_properties().local_mprops;
            if body.is_dynamic() {
                [inverse(local.inv_mass), inverse(local.inv_principal_inertia)]
            } else {
                [0.0; 2]
            }
        };
        self.bodies.iter().map(of).collect()
    }

    fn asleep(&self) -> usize {
        let asleep = |handle: &&RigidBodyHandle| {
            let body = &self.world.bodies[**handle];
            !body.is_fixed() && body.is_sleeping()
        };
        self.bodies.iter().filter(asleep).count()
    }
}

fn state(body: &RigidBody) -> BodyState {
    // Its centre of mass: where the body's origin is, by construction.
    let (p, r, v) = (body.center_of_mass(), body.rotation(), body.linvel());
    BodyState {
        position: [p.x, p.y].map(f64::from),
        rotation: [r.re, r.im].map(f64::from),
        velocity: [v.x, v.y].map(f64::from),
        angular_velocity: f64::from(body.angvel()),
    }
}

fn rigid_body(body: &Body, sleep: bool) -> RigidBodyBuilder {
    let (spec, start) = (&body.spec, &body.start);
    let builder = match spec.kind {
        BodyKind::Static => RigidBodyBuilder::fixed(),
        BodyKind::Kinematic => RigidBodyBuilder::kinematic_velocity_based(),
        BodyKind::Dynamic => RigidBodyBuilder::dynamic(),
    };
    builder
        .pose(Pose::from_parts(vector(start.position), rotation(start.rotation)))
        .linvel(vector(start.velocity))
        .angvel(start.angular_velocity as f32)
        .can_sleep(sleep)
}

/// The body's shape, with its mass; `None` where rapier refuses the outline.
fn collider(body: &Body) -> Option<Collider> {
    let spec = &body.spec;
    let builder = match &body.shape {
        Shape::Circle { radius } => ColliderBuilder::ball(*radius as f32),
        Shape::Box { half } => ColliderBuilder::cuboid(half.x as f32, half.y as f32),
        Shape::Polygon(_) => {
            let outline = body.outline.iter().map(|&v| vector(v)).collect();
            let polygon = ConvexPolygon::from_convex_polyline_unmodified(outline)?;
            ColliderBuilder::new(SharedShape::new(polygon))
        }
    };
    let groups = InteractionGroups::new(
        Group::from_bits_retain(spec.category),
        Group::from_bits_retain(spec.collides_with),
        InteractionTestMode::And,
    );
    let mass = MassProperties::new(Vector::ZERO, body.mass as f32, body.inertia as f32);
    let builder = builder
        .mass_properties(mass)
        .friction(spec.friction as f32)
        .friction_combine_rule(CoefficientCombineRule::Min)
        .restitution(spec.restitution as f32)
        .restitution_combine_rule(CoefficientCombineRule::Min)
        .collision_groups(groups);
    Some(builder.build())
}
