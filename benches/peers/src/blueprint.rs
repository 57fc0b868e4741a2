//! A scene as every engine gets it: placed by centroids, masses reckoned once, in `f64`.
//!
//! The library builds its own world of the scene in `f64` and everything is read from there: what the scene is
//! refused for, poses, masses, anchors of joints and circles of driven bodies are the library's by construction.

use glam::DVec2;
use lamina2d::body::Bodies;
use lamina2d::joint::{Joint, JointSpring};
use lamina2d::lanes::f64s;
use lamina2d::measure::Outline;
use lamina2d::scene::{BodyKind, BodySpec, Scene};
use lamina2d::settings::{Precision, Settings};
use lamina2d::shape::Shape;
use lamina2d::simulation::BodyState;
use lamina2d::world::World;

use crate::engine::{Gap, Name};

/// A body as engines get it.
#[derive(Clone, Debug)]
pub struct Body {
    /// As the scene has it.
    pub spec: BodySpec,
    /// Its form.
    pub shape: Shape,
    /// About the centroid, counter-clockwise; empty for circles.
    pub outline: Vec<[f64; 2]>,
    /// Where it begins.
    pub start: BodyState,
    /// kg; 0 unless dynamic.
    pub mass: f64,
    /// kg·m²; 0 unless dynamic.
    pub inertia: f64,
}

/// A scene as engines get it.
#[derive(Clone, Debug)]
pub struct Blueprint {
    /// The scene's name.
    pub scene: String,
    /// Its bodies, in order.
    pub bodies: Vec<Body>,
    /// Its joints, in order, anchors in the frames of their bodies.
    pub joints: Vec<Joint>,
    /// m/s².
    pub gravity: [f64; 2],
    /// Seconds.
    pub dt_secs: f64,
    /// Fields beside gravity, by name: no peer has any.
    pub fields: Vec<&'static str>,
    /// How many events it has.
    pub events: usize,
    driver: Driver,
}

impl Blueprint {
    /// Of a scene.
    ///
    /// # Errors
    /// What the library refuses the scene for.
    pub fn of(scene: &Scene) -> anyhow::Result<Self> {
        let settings = Settings { dt_secs: scene.dt_secs, ..Settings::default() };
        let settings = Settings { lanes: 1, ..settings.with_precision(Precision::F64) };
        let world = World::<f64s::X1>::from_scene(scene, settings)?;
        let placed = world.bodies();
        let bodies = (scene.bodies.iter().zip(placed.slots()))
            .map(|(spec, slot)| Ok(body(spec, spec.shape.build()?, placed, slot)))
            .collect::<anyhow::Result<Vec<_>>>()?;
        let joints = (world.joints().ids())
            .map(|id| Ok(world.joints().get(id)?.clone()))
            .collect::<anyhow::Result<Vec<_>>>()?;
        let driven = scene.bodies.iter().enumerate().filter(|(_, b)| b.pivot.is_some()).map(|(k, _)| k);
        Ok(Self {
            scene: scene.name.clone(),
            driver: Driver { driven: driven.collect(), bodies: placed.clone() },
            bodies,
            joints,
            gravity: scene.forces.gravity.unwrap_or([0.0; 2]),
            dt_secs: scene.dt_secs,
            fields: scene.forces.beyond_gravity().collect(),
            events: scene.events.len(),
        })
    }

    /// Refuses the scene where it has a field beside gravity, or events.
    ///
    /// # Errors
    /// The field.
    pub fn without_fields(&self, engine: Name) -> Result<(), Gap> {
        match self.fields.first() {
            None if self.events > 0 => Err(self.gap(engine, "nothing is done to it on its way".to_owned())),
            None => Ok(()),
            Some(field) => Err(self.gap(engine, format!("it has no field {field}"))),
        }
    }

    /// The sentence for what an engine lacks.
    pub fn gap(&self, engine: Name, lacks: String) -> Gap {
        Gap { engine, scene: self.scene.clone(), lacks }
    }

    /// The numbers of a joint's bodies.
    pub fn ends(joint: &Joint) -> [usize; 2] {
        // The k-th body of a scene is in slot k + 1.
        joint.bodies.map(|id| id.slot() - 1)
    }

    /// A weld's spring by what the peers go by, who reckon its hertz and damping from the bodies' inertia alone:
    /// ours counts that the welded point is held, which makes turning about it harder.
    ///
    /// With J = 1/k the inertia that is felt and I = 1/(1/I_A + 1/I_B): J·ω² = I·ω′² and J·ζω = I·ζ′ω′, so both
    /// numbers grow by √(J/I).
    pub fn weld_spring(&self, joint: &Joint, spring: JointSpring) -> JointSpring {
        let ends = Self::ends(joint);
        let inverse = |value: f64| if value == 0.0 { 0.0 } else { 1.0 / value };
        let m: f64 = ends.iter().map(|&k| inverse(self.bodies[k].mass)).sum();
        let [ia, ib] = ends.map(|k| inverse(self.bodies[k].inertia));
        let [ra, rb] = [0, 1].map(|k| {
            let turn = DVec2::from(self.bodies[ends[k]].start.rotation);
            turn.rotate(DVec2::from(joint.anchors_body[k]))
        });
        let cross = ra.perp_dot(rb);
        let determinant =
            m * m + m * (ia * ra.length_squared() + ib * rb.length_squared()) + ia * ib * cross * cross;
        let felt = m * (m * (ia + ib) + ia * ib * (ra - rb).length_squared()) / determinant;
        let harder = ((ia + ib) / felt).sqrt();
        JointSpring { hertz: spring.hertz * harder, damping: spring.damping * harder }
    }

    /// The circles of driven bodies.
    pub fn driver(&self) -> Driver {
        self.driver.clone()
    }

    /// Discs and outlines of the bodies in given states, for the library's check.
    pub fn outlines(&self, states: &[BodyState]) -> Vec<Outline> {
        (self.bodies.iter().zip(states)).map(|(body, state)| body.outline_at(state)).collect()
    }
}

impl Body {
    /// Its disc or outline in a state.
    pub fn outline_at(&self, state: &BodyState) -> Outline {
        let ([x, y], [c, s]) = (state.position, state.rotation);
        Outline {
            centre: state.position,
            radius: if let Shape::Circle { radius } = self.shape { radius } else { 0.0 },
            vertices: self.outline.iter().map(|[u, v]| [x + c * u - s * v, y + s * u + c * v]).collect(),
            fixed: self.spec.kind == BodyKind::Static,
        }
    }
}

fn body(spec: &BodySpec, shape: Shape, placed: &Bodies<f64>, slot: usize) -> Body {
    let inverse = |value: f64| if value == 0.0 { 0.0 } else { 1.0 / value };
    Body {
        spec: spec.clone(),
        outline: shape.outline().into_iter().map(|DVec2 { x, y }| [x, y]).collect(),
        shape,
        start: BodyState {
            position: [placed.x[slot], placed.y[slot]],
            rotation: [placed.c[slot], placed.s[slot]],
            velocity: [placed.vx[slot], placed.vy[slot]],
            angular_velocity: placed.w[slot],
        },
        mass: inverse(placed.inv_mass[slot]),
        inertia: inverse(placed.inv_inertia[slot]),
    }
}

/// Keeps driven bodies on their circles: the library's own reckoning, with an engine's poses.
#[derive(Clone, Debug)]
pub struct Driver {
    driven: Vec<usize>,
    bodies: Bodies<f64>,
}

impl Driver {
    /// The numbers of the bodies that are driven.
    pub fn driven(&self) -> &[usize] {
        &self.driven
    }

    /// The velocities (m/s, rad/s) that bring the driven bodies, in the order of [`Driver::driven`], from where
    /// they stand to where their circles have them a step later. Advances the circles.
    pub fn velocities(&mut self, dt_secs: f64, stands: impl Fn(usize) -> BodyState) -> Vec<([f64; 2], f64)> {
        for &body in &self.driven {
            let state = stands(body);
            ([self.bodies.x[body + 1], self.bodies.y[body + 1]], self.bodies.c[body + 1]) =
                (state.position, state.rotation[0]);
            self.bodies.s[body + 1] = state.rotation[1];
        }
        self.bodies.drive(dt_secs);
        let read = |&body: &usize| {
            let slot = body + 1;
            ([self.bodies.vx[slot], self.bodies.vy[slot]], self.bodies.w[slot])
        };
        self.driven.iter().map(read).collect()
    }
}
