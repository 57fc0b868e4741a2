//! The only file that calls Box2D: a world that owns its bodies, by their numbers.
//!
//! Why each call is sound: every id comes from this world, which lives as long as the [`World`] and whose bodies
//! and shapes are never destroyed before it; definitions come from Box2D's own defaults and outlive the call, which
//! copies them; no pointer of ours is kept. Worlds share one table inside Box2D, written only where one is made or
//! destroyed: that is done under a lock.

use std::ffi::{CStr, c_char, c_int};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, MutexGuard, OnceLock, PoisonError};

use boxdd_sys::ffi;

/// What a world is made with; everything else is Box2D's default.
#[derive(Clone, Copy, Debug)]
pub(super) struct NewWorld {
    pub(super) gravity: [f32; 2],
    pub(super) sleep: bool,
    pub(super) workers: i32,
}

/// How a body moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Static,
    Kinematic,
    Dynamic,
}

/// A form about the body's origin.
#[derive(Clone, Debug)]
pub(super) enum Form {
    Circle(f32),
    /// At most eight vertices, counter-clockwise.
    Polygon(Vec<[f32; 2]>),
}

/// A body with its one shape; its origin is its centre of mass.
#[derive(Clone, Debug)]
pub(super) struct NewBody {
    pub(super) kind: Kind,
    pub(super) form: Form,
    pub(super) position: [f32; 2],
    pub(super) rotation: [f32; 2],
    pub(super) velocity: [f32; 2],
    pub(super) angular_velocity: f32,
    pub(super) mass: f32,
    pub(super) inertia: f32,
    pub(super) area: f32,
    pub(super) friction: f32,
    pub(super) restitution: f32,
    pub(super) category: u64,
    pub(super) collides_with: u64,
}

/// Where a joint holds its bodies: anchors in their frames, and how their frames are turned.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ends {
    pub(super) bodies: [usize; 2],
    pub(super) anchors: [[f32; 2]; 2],
    pub(super) turns: [[f32; 2]; 2],
    pub(super) collide: bool,
}

/// What a joint holds.
#[derive(Clone, Copy, Debug)]
pub(super) enum NewJoint {
    /// A spring of 0 Hz between bounds is a rope or a strut.
    Distance { length: f32, spring: Option<[f32; 2]>, bounds: Option<[f32; 2]> },
    /// Speed and torque of a motor; lower and upper limit.
    Revolute { motor: Option<[f32; 2]>, limits: Option<[f32; 2]> },
    /// Hertz and damping of the angle; rigid without.
    Weld { spring: Option<[f32; 2]> },
}

/// A body's pose and velocity.
#[derive(Clone, Copy, Debug)]
pub(super) struct State {
    pub(super) position: [f32; 2],
    pub(super) rotation: [f32; 2],
    pub(super) velocity: [f32; 2],
    pub(super) angular_velocity: f32,
}

/// A world of Box2D.
#[derive(Debug)]
pub(super) struct World {
    id: ffi::b2WorldId,
    bodies: Vec<(ffi::b2BodyId, ffi::b2ShapeId)>,
}

/// Held while a world is made or destroyed.
fn table() -> MutexGuard<'static, ()> {
    static TABLE: Mutex<()> = Mutex::new(());
    TABLE.lock().unwrap_or_else(PoisonError::into_inner)
}

const fn vec(v: [f32; 2]) -> ffi::b2Vec2 {
    ffi::b2Vec2 { x: v[0], y: v[1] }
}

/// The library's rule for friction and restitution: the smaller of the two.
unsafe extern "C" fn smaller(a: f32, _: u64, b: f32, _: u64) -> f32 {
    a.min(b)
}

/// Set while [`asserts`] breaks a rule on purpose.
static PROBING: AtomicBool = AtomicBool::new(false);
static ASSERTED: AtomicBool = AtomicBool::new(false);

unsafe extern "C" fn on_assert(condition: *const c_char, _file: *const c_char, line: c_int) -> c_int {
    if PROBING.load(Ordering::SeqCst) {
        ASSERTED.store(true, Ordering::SeqCst);
        return 0;
    }
    // SAFETY: Box2D passes the text of its condition, a literal.
    let condition = unsafe { CStr::from_ptr(condition) };
    eprintln!("Box2D: line {line}: {} does not hold", condition.to_string_lossy());
    1
}

/// Were Box2D's assertions compiled in? Asked by breaking one: a hull of no points.
pub(super) fn asserts() -> bool {
    static ANSWER: OnceLock<bool> = OnceLock::new();
    *ANSWER.get_or_init(|| {
        let _guard = table();
        PROBING.store(true, Ordering::SeqCst);
        // SAFETY: plain values; where assertions are off, Box2D answers a bad hull with a square.
        unsafe {
            ffi::b2SetAssertFcn(Some(on_assert));
            let hull = ffi::b2Hull { points: [vec([0.0; 2]); 8], count: 0 };
            let _square = ffi::b2MakePolygon(&raw const hull, 0.0);
        }
        PROBING.store(false, Ordering::SeqCst);
        ASSERTED.load(Ordering::SeqCst)
    })
}

/// Major, minor, revision.
pub(super) fn version() -> [i32; 3] {
    // SAFETY: takes nothing, gives a value.
    let v = unsafe { ffi::b2GetVersion() };
    [v.major, v.minor, v.revision]
}

/// What [`World::new`] leaves as it comes, by name.
pub(super) fn defaults() -> Vec<(&'static str, f32)> {
    // SAFETY: takes nothing, gives a value.
    let def = unsafe { ffi::b2DefaultWorldDef() };
    vec![
        ("contact_hertz", def.contactHertz),
        ("contact_damping_ratio", def.contactDampingRatio),
        ("contact_speed_m_per_s", def.contactSpeed),
        ("restitution_threshold_m_per_s", def.restitutionThreshold),
        ("maximum_linear_speed_m_per_s", def.maximumLinearSpeed),
    ]
}

impl World {
    /// An empty world; `None` where Box2D has no room for another.
    pub(super) fn new(new: NewWorld) -> Option<Self> {
        let _answer = asserts();
        let _guard = table();
        // SAFETY: the definition is Box2D's own with values set, and outlives the call.
        let id = unsafe {
            let mut def = ffi::b2DefaultWorldDef();
            def.gravity = vec(new.gravity);
            def.enableSleep = new.sleep;
            def.workerCount = new.workers;
            def.frictionCallback = Some(smaller);
            def.restitutionCallback = Some(smaller);
            ffi::b2CreateWorld(&raw const def)
        };
        (id.index1 != 0).then_some(Self { id, bodies: Vec::new() })
    }

    /// Takes a body in; it gets the next number.
    pub(super) fn add(&mut self, new: &NewBody, sleep: bool) {
        // SAFETY: the definitions are Box2D's own with values set, and outlive the calls.
        let pair = unsafe {
            let mut def = ffi::b2DefaultBodyDef();
            def.type_ = match new.kind {
                Kind::Static => ffi::b2BodyType_b2_staticBody,
                Kind::Kinematic => ffi::b2BodyType_b2_kinematicBody,
                Kind::Dynamic => ffi::b2BodyType_b2_dynamicBody,
            };
            def.position = vec(new.position);
            def.rotation = ffi::b2Rot { c: new.rotation[0], s: new.rotation[1] };
            def.linearVelocity = vec(new.velocity);
            def.angularVelocity = new.angular_velocity;
            def.enableSleep = sleep;
            let body = ffi::b2CreateBody(self.id, &raw const def);
            (body, add_shape(body, new))
        };
        self.bodies.push(pair);
        if new.kind == Kind::Dynamic {
            let mass =
                ffi::b2MassData { mass: new.mass, center: vec([0.0; 2]), rotationalInertia: new.inertia };
            // SAFETY: the body was made above, in this world.
            unsafe { ffi::b2Body_SetMassData(pair.0, mass) };
        }
    }

    /// Joins two bodies.
    pub(super) fn join(&mut self, ends: &Ends, joint: NewJoint) {
        let [a, b] = ends.bodies.map(|k| self.bodies[k].0);
        let frame = |k: usize| ffi::b2Transform {
            p: vec(ends.anchors[k]),
            q: ffi::b2Rot { c: ends.turns[k][0], s: ends.turns[k][1] },
        };
        let place = |base: &mut ffi::b2JointDef| {
            (base.bodyIdA, base.bodyIdB) = (a, b);
            (base.localFrameA, base.localFrameB) = (frame(0), frame(1));
            base.collideConnected = ends.collide;
        };
        // SAFETY: the definitions are Box2D's own with values set, and outlive the calls; the bodies are this world's.
        unsafe {
            match joint {
                NewJoint::Distance { length, spring, bounds } => {
                    let mut def = ffi::b2DefaultDistanceJointDef();
                    place(&mut def.base);
                    def.length = length;
                    if let Some([hertz, damping]) = spring {
                        (def.enableSpring, def.hertz, def.dampingRatio) = (true, hertz, damping);
                    }
                    if let Some([min, max]) = bounds {
                        (def.enableLimit, def.minLength, def.maxLength) = (true, min, max);
                    }
                    ffi::b2CreateDistanceJoint(self.id, &raw const def);
                }
                NewJoint::Revolute { motor, limits } => {
                    let mut def = ffi::b2DefaultRevoluteJointDef();
                    place(&mut def.base);
                    if let Some([speed, torque]) = motor {
                        (def.enableMotor, def.motorSpeed, def.maxMotorTorque) = (true, speed, torque);
                    }
                    if let Some([lower, upper]) = limits {
                        (def.enableLimit, def.lowerAngle, def.upperAngle) = (true, lower, upper);
                    }
                    ffi::b2CreateRevoluteJoint(self.id, &raw const def);
                }
                NewJoint::Weld { spring } => {
                    let mut def = ffi::b2DefaultWeldJointDef();
                    place(&mut def.base);
                    if let Some([hertz, damping]) = spring {
                        (def.angularHertz, def.angularDampingRatio) = (hertz, damping);
                    }
                    ffi::b2CreateWeldJoint(self.id, &raw const def);
                }
            }
        }
    }

    /// Advances by `dt_secs` in so many substeps.
    pub(super) fn step(&mut self, dt_secs: f32, substeps: i32) {
        // SAFETY: the world is alive, and no other thread has it: this is a unique borrow.
        unsafe { ffi::b2World_Step(self.id, dt_secs, substeps) };
    }

    /// Adds a force (N) and a torque (N·m) until the next step ends; what sleeps does not wake.
    pub(super) fn push(&mut self, body: usize, force: [f32; 2], torque: f32) {
        let id = self.bodies[body].0;
        // SAFETY: the body is this world's.
        unsafe {
            ffi::b2Body_ApplyForceToCenter(id, vec(force), false);
            ffi::b2Body_ApplyTorque(id, torque, false);
        }
    }

    /// Sets a body's velocity.
    pub(super) fn set_velocity(&mut self, body: usize, velocity: [f32; 2], angular_velocity: f32) {
        let id = self.bodies[body].0;
        // SAFETY: the body is this world's.
        unsafe {
            ffi::b2Body_SetLinearVelocity(id, vec(velocity));
            ffi::b2Body_SetAngularVelocity(id, angular_velocity);
        }
    }

    /// A body's state.
    pub(super) fn state(&self, body: usize) -> State {
        let id = self.bodies[body].0;
        // SAFETY: the body is this world's.
        let (p, q, v, w) = unsafe {
            (
                ffi::b2Body_GetWorldCenter(id),
                ffi::b2Body_GetRotation(id),
                ffi::b2Body_GetLinearVelocity(id),
                ffi::b2Body_GetAngularVelocity(id),
            )
        };
        State { position: [p.x, p.y], rotation: [q.c, q.s], velocity: [v.x, v.y], angular_velocity: w }
    }

    /// A body's mass (kg) and moment of inertia (kg·m²).
    pub(super) fn mass(&self, body: usize) -> [f32; 2] {
        // SAFETY: the body is this world's.
        let data = unsafe { ffi::b2Body_GetMassData(self.bodies[body].0) };
        [data.mass, data.rotationalInertia]
    }

    /// Pairs whose manifold has a point.
    pub(super) fn contacts(&self) -> usize {
        let mut found: Vec<ffi::b2ContactData> = Vec::new();
        let mut pairs = 0;
        for &(body, shape) in &self.bodies {
            // SAFETY: the body is this world's; at most `room` records are written where there is room for as many,
            // and as many as were written are then read.
            unsafe {
                let room = ffi::b2Body_GetContactCapacity(body);
                found.clear();
                found.reserve(usize::try_from(room).unwrap_or(0));
                let written = ffi::b2Body_GetContactData(body, found.as_mut_ptr(), room);
                found.set_len(usize::try_from(written).unwrap_or(0));
            }
            // Both bodies of a pair name it: it counts where its first shape is asked.
            let first =
                |c: &&ffi::b2ContactData| c.shapeIdA.index1 == shape.index1 && c.manifold.pointCount > 0;
            pairs += found.iter().filter(first).count();
        }
        pairs
    }

    /// Bodies that are awake, static ones left out.
    pub(super) fn awake(&self) -> usize {
        // SAFETY: the world is alive.
        usize::try_from(unsafe { ffi::b2World_GetAwakeBodyCount(self.id) }).unwrap_or(0)
    }
}

/// Gives a body its shape.
///
/// # Safety
/// The body lives.
unsafe fn add_shape(body: ffi::b2BodyId, new: &NewBody) -> ffi::b2ShapeId {
    // SAFETY: the definitions are Box2D's own with values set, and outlive the calls; a hull has at most eight points,
    // as the caller of `add` has seen to.
    unsafe {
        let mut def = ffi::b2DefaultShapeDef();
        def.material.friction = new.friction;
        def.material.restitution = new.restitution;
        def.filter.categoryBits = new.category;
        def.filter.maskBits = new.collides_with;
        // From it Box2D also takes the extents by which it tells what is fast.
        def.density = if new.area > 0.0 { new.mass / new.area } else { 0.0 };
        match &new.form {
            Form::Circle(radius) => {
                let circle = ffi::b2Circle { center: vec([0.0; 2]), radius: *radius };
                ffi::b2CreateCircleShape(body, &raw const def, &raw const circle)
            }
            Form::Polygon(outline) => {
                // The outline as it is: Box2D's own hull would weld and drop vertices.
                let count = c_int::try_from(outline.len()).unwrap_or(0);
                let mut hull = ffi::b2Hull { points: [vec([0.0; 2]); 8], count };
                for (point, v) in hull.points.iter_mut().zip(outline) {
                    *point = vec(*v);
                }
                let polygon = ffi::b2MakePolygon(&raw const hull, 0.0);
                ffi::b2CreatePolygonShape(body, &raw const def, &raw const polygon)
            }
        }
    }
}

impl Drop for World {
    fn drop(&mut self) {
        let _guard = table();
        // SAFETY: made by `new`, destroyed once.
        unsafe { ffi::b2DestroyWorld(self.id) };
    }
}
