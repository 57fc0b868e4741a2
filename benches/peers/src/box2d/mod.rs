//! Box2D v3 through `boxdd-sys`: world, bodies and joints as a blueprint has them, the rest at its defaults.

#[expect(unsafe_code, reason = "the C interface; nowhere else")]
mod raw;

use lamina2d::joint::{Joint, JointKind, JointSpring};
use lamina2d::scene::BodyKind;
use lamina2d::shape::Shape;
use lamina2d::simulation::BodyState;

use crate::blueprint::{Blueprint, Body, Driver};
use crate::engine::{Engine, Gap, Name, Setup};

use raw::{Ends, Form, Kind, NewBody, NewJoint, NewWorld, World};

/// The most vertices of its polygons.
const MAX_VERTICES: usize = 8;
/// Its limits of an angle, rad: it has no whole turns.
const MAX_LIMIT_RAD: f64 = 0.99 * std::f64::consts::PI;
/// Longer is no bound at all, metres: its own `B2_HUGE`.
const ENDLESS: f64 = 1e5;

/// A world of Box2D.
#[derive(Debug)]
pub struct Box2d {
    world: World,
    bodies: usize,
    /// Bodies that are neither static nor driven by anything but the world.
    movable: usize,
    /// Constant forces and torques, by body.
    pushed: Vec<(usize, [f32; 2], f32)>,
    driver: Driver,
    dt_secs: f64,
    substeps: i32,
}

impl Box2d {
    /// The world of a scene.
    ///
    /// # Errors
    /// What Box2D has not: [`Gap`]; too many worlds at once.
    pub fn build(blueprint: &Blueprint, setup: Setup) -> anyhow::Result<Self> {
        blueprint.without_fields(Name::Box2d)?;
        let workers = i32::try_from(setup.threads)?;
        let gravity = blueprint.gravity.map(|v| v as f32);
        let world = World::new(NewWorld { gravity, sleep: setup.sleep, workers });
        let mut world = world.ok_or_else(|| anyhow::anyhow!("Box2D has no room for another world"))?;
        for (number, body) in blueprint.bodies.iter().enumerate() {
            if body.outline.len() > MAX_VERTICES {
                let lacks = format!(
                    "body {number} has {} vertices, its polygons have {MAX_VERTICES}",
                    body.outline.len()
                );
                return Err(blueprint.gap(Name::Box2d, lacks).into());
            }
            world.add(&new_body(body), setup.sleep);
        }
        for (number, joint) in blueprint.joints.iter().enumerate() {
            let (ends, new) = new_joint(blueprint, number, joint)?;
            world.join(&ends, new);
        }
        let pushed = blueprint.bodies.iter().enumerate().filter_map(|(k, body)| {
            let (force, torque) = (body.spec.force, body.spec.torque);
            (force != [0.0; 2] || torque != 0.0).then_some((k, force.map(|f| f as f32), torque as f32))
        });
        Ok(Self {
            world,
            bodies: blueprint.bodies.len(),
            movable: blueprint.bodies.iter().filter(|b| b.spec.kind != BodyKind::Static).count(),
            pushed: pushed.collect(),
            driver: blueprint.driver(),
            dt_secs: blueprint.dt_secs,
            substeps: i32::try_from(setup.substeps)?,
        })
    }

    /// Its version.
    pub fn version() -> String {
        raw::version().map(|part| part.to_string()).join(".")
    }

    /// Were its assertions compiled in? The program asks the code itself.
    pub fn asserts() -> bool {
        raw::asserts()
    }

    /// Its defaults that decide a result, by name.
    pub fn defaults() -> Vec<(&'static str, f32)> {
        raw::defaults()
    }
}

impl Engine for Box2d {
    fn step(&mut self) -> anyhow::Result<()> {
        let world = &mut self.world;
        if !self.driver.driven().is_empty() {
            let moves = self.driver.velocities(self.dt_secs, |body| state(world, body));
            for (&body, (velocity, spin)) in self.driver.driven().iter().zip(moves) {
                world.set_velocity(body, velocity.map(|v| v as f32), spin as f32);
            }
        }
        for &(body, force, torque) in &self.pushed {
            world.push(body, force, torque);
        }
        world.step(self.dt_secs as f32, self.substeps);
        Ok(())
    }
    fn states(&self) -> Vec<BodyState> {
        (0..self.bodies).map(|body| state(&self.world, body)).collect()
    }
    fn contacts(&self) -> usize {
        self.world.contacts()
    }
    fn masses(&self) -> Vec<[f64; 2]> {
        (0..self.bodies).map(|body| self.world.mass(body).map(f64::from)).collect()
    }
    fn asleep(&self) -> usize {
        self.movable.saturating_sub(self.world.awake())
    }
}

fn state(world: &World, body: usize) -> BodyState {
    let state = world.state(body);
    BodyState {
        position: state.position.map(f64::from),
        rotation: state.rotation.map(f64::from),
        velocity: state.velocity.map(f64::from),
        angular_velocity: f64::from(state.angular_velocity),
    }
}

fn new_body(body: &Body) -> NewBody {
    let (spec, start) = (&body.spec, &body.start);
    NewBody {
        kind: match spec.kind {
            BodyKind::Static => Kind::Static,
            BodyKind::Kinematic => Kind::Kinematic,
            BodyKind::Dynamic => Kind::Dynamic,
        },
        form: match &body.shape {
            Shape::Circle { radius } => Form::Circle(*radius as f32),
            _ => Form::Polygon(body.outline.iter().map(|v| v.map(|x| x as f32)).collect()),
        },
        position: start.position.map(|x| x as f32),
        rotation: start.rotation.map(|x| x as f32),
        velocity: start.velocity.map(|v| v as f32),
        angular_velocity: start.angular_velocity as f32,
        mass: body.mass as f32,
        inertia: body.inertia as f32,
        area: body.shape.mass_properties().area as f32,
        friction: spec.friction as f32,
        restitution: spec.restitution as f32,
        category: u64::from(spec.category),
        collides_with: u64::from(spec.collides_with),
    }
}

/// A joint by Box2D's names: its frames are turned so that its angle is 0 where ours is.
fn new_joint(blueprint: &Blueprint, number: usize, joint: &Joint) -> Result<(Ends, NewJoint), Gap> {
    let spring = |s: JointSpring| [s.hertz as f32, s.damping as f32];
    let new = match &joint.kind {
        JointKind::Distance(distance) => {
            let bounded = distance.min.is_some() || distance.max.is_some();
            let bounds = [distance.min.unwrap_or(0.0), distance.max.unwrap_or(ENDLESS)];
            let free = bounded.then_some([0.0; 2]);
            NewJoint::Distance {
                length: joint.length as f32,
                spring: distance.spring.map(spring).or(free),
                bounds: bounded.then_some(bounds.map(|b| b as f32)),
            }
        }
        JointKind::Revolute(revolute) => {
            let limits = revolute.limits.map(|l| [l.lower, l.upper]);
            let limits = limits.filter(|l| l.iter().any(|angle| angle.is_finite()));
            if let Some(&angle) = limits.iter().flatten().find(|angle| angle.abs() > MAX_LIMIT_RAD) {
                let lacks = format!("joint {number} has a limit of {angle} rad, it has at most 0.99π");
                return Err(blueprint.gap(Name::Box2d, lacks));
            }
            NewJoint::Revolute {
                motor: revolute.motor.map(|m| [m.speed as f32, m.max_torque as f32]),
                limits: limits.map(|l| l.map(|angle| angle as f32)),
            }
        }
        JointKind::Weld(weld) => {
            NewJoint::Weld { spring: weld.spring.map(|s| spring(blueprint.weld_spring(joint, s))) }
        }
    };
    let [c, s] = joint.reference;
    let ends = Ends {
        bodies: Blueprint::ends(joint),
        anchors: joint.anchors_body.map(|anchor| anchor.map(|x| x as f32)),
        // B's frame turned back by what B is turned against A.
        turns: [[1.0, 0.0], [c as f32, -s as f32]],
        collide: joint.collide,
    };
    Ok((ends, new))
}
