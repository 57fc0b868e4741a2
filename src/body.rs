//! Bodies as a structure of arrays.
//!
//! One column per quantity; slot 0 is the immovable world. A body keeps its slot until it is removed;
//! its hole is inert and is filled again by the next insertion, lowest slot first. Ids carry a
//! generation, so the id of a removed body is never mistaken for its successor's.
//!
//! # Bytes per body
//! Hot columns, read or written each step: position 2, attitude 2, velocity 3, inverse mass and inertia
//! 2, extents 2, bounding radius 1, friction 1, restitution 1: 14 reals = 56 B in f32 (112 B in f64).
//! Cold, 23 B: kind 1, shape form 1, shape start 4, generation 4, filter 12 (category, collides-with,
//! dynamic), flags 1. Only where some body needs them: constant force and torque 3 reals (12 B), a polygon's
//! vertices and normals in both frames: 8 rows of 8 (256 B in f32), beside vertex
//! count 1 and owner 4.
//! Rejected: mass beside inverse mass (8 B that no kernel reads); an angle beside the unit complex
//! number (4 B and a trigonometric call wherever it is used).

use std::ops::Range;

use crate::column::Column;
use crate::lanes::{ROW, Real};
use crate::scene::{BodyKind, BodySpec};
use crate::shape::{Shape, ShapeError, edge_normals};

/// A body's stable name: slot and generation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct BodyId {
    slot: u32,
    generation: u32,
}

impl BodyId {
    /// The slot in the columns; valid while the body lives.
    pub fn slot(self) -> usize {
        self.slot as usize
    }
}

/// Why a body was refused: which one (in order of insertion), which field, which value.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum BodyError {
    /// Its shape is bad.
    #[error("body {body}: shape: {why}")]
    Shape {
        /// Its number in order of insertion, from 0.
        body: usize,
        /// What is wrong with the shape.
        why: ShapeError,
    },
    /// NaN, infinite, or too large for the world's precision.
    #[error("body {body}: {field} is not finite in this precision: {value:?}")]
    NonFinite {
        /// Its number.
        body: usize,
        /// The field.
        field: &'static str,
        /// What was given.
        value: f64,
    },
    /// Outside the range the field has.
    #[error("body {body}: {field} must be {range}, got {value:?}")]
    OutOfRange {
        /// Its number.
        body: usize,
        /// The field.
        field: &'static str,
        /// What is allowed.
        range: &'static str,
        /// What was given.
        value: f64,
    },
    /// Both were given.
    #[error("body {body}: give mass or density, not both (mass {mass:?}, density {density:?})")]
    MassAndDensity {
        /// Its number.
        body: usize,
        /// What was given.
        mass: f64,
        /// What was given.
        density: f64,
    },
    /// A static body cannot move.
    #[error("body {body}: a static body has no {field}, got {value:?}; make it kinematic")]
    StaticMoves {
        /// Its number.
        body: usize,
        /// The field.
        field: &'static str,
        /// What was given.
        value: f64,
    },
    /// No living body has this id.
    #[error("no living body has the id of slot {slot}, generation {generation}")]
    Stale {
        /// The id's slot.
        slot: u32,
        /// The id's generation.
        generation: u32,
    },
    /// NaN, infinite, or too large for the world's precision, for a body that is in the world.
    #[error("body in slot {slot}: {field} is not finite in this precision: {value:?}")]
    NonFiniteInSlot {
        /// Its slot: once slots are filled again, its number is not to be had from it.
        slot: u32,
        /// The field.
        field: &'static str,
        /// What was given.
        value: f64,
    },
    /// Only dynamic bodies take impulses.
    #[error("body in slot {0} is not dynamic: an impulse cannot move it")]
    NotDynamic(u32),
}

/// The kinds a kernel can be written for, in the order in which a pair names them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[repr(u8)]
pub enum Form {
    /// A disc.
    Circle = 0,
    /// A rectangle.
    Box = 1,
    /// A convex polygon.
    Polygon = 2,
}

/// A polygon's four rows: x and y of its vertices, x and y of the outward normals of the edges that start
/// there. Entry `k` of a row belongs to vertex or edge `k`.
///
/// Entries past the last repeat entry 0: a repeated axis or vertex changes no minimum and no maximum, so
/// polygons of different counts may share a batch, and the edge from vertex k ends at vertex
/// (k + 1) mod 8 for every count.
pub type HullRows<R> = [[R; ROW]; 4];

/// Vertices and normals of all polygons; one entry per polygon, so that a gather finds its rows together.
#[derive(Clone, Debug, Default)]
pub struct Polygons<R> {
    /// In the body frame, about the centroid.
    pub body: Vec<HullRows<R>>,
    /// In world axes, about the centroid; refreshed each step.
    pub world: Vec<HullRows<R>>,
    /// Vertices.
    pub count: Vec<u8>,
    /// The body that has it; 0 where it is free.
    pub owner: Vec<u32>,
    free: Vec<u32>,
}

impl<R: Real> Polygons<R> {
    fn insert(&mut self, shape: &Shape, owner: u32) -> u32 {
        let at = self.free.pop().map_or(self.owner.len(), |at| at as usize);
        if at == self.owner.len() {
            self.body.push([[R::ZERO; ROW]; 4]);
            self.world.push([[R::ZERO; ROW]; 4]);
            self.count.push(0);
            self.owner.push(0);
        }
        let outline = shape.outline();
        let normals = edge_normals(&outline);
        let row = |f: &dyn Fn(usize) -> f64| {
            std::array::from_fn(|k| R::from_f64(f(if k < outline.len() { k } else { 0 })))
        };
        self.body[at] =
            [row(&|k| outline[k].x), row(&|k| outline[k].y), row(&|k| normals[k].x), row(&|k| normals[k].y)];
        self.count[at] = outline.len() as u8;
        self.owner[at] = owner;
        at as u32
    }

    fn remove(&mut self, at: u32) {
        self.owner[at as usize] = 0;
        self.free.push(at);
    }

    /// The largest number of vertices of any polygon; 0 without polygons.
    pub fn max_count(&self) -> usize {
        self.count.iter().copied().max().unwrap_or(0).into()
    }
}

/// What decides whether a pair may collide, together so that a pair costs two loads. 12 B.
#[derive(Clone, Copy, Debug, Default)]
struct Filter {
    category: u32,
    collides_with: u32,
    dynamic: bool,
}

/// All bodies of a world.
#[derive(Clone, Debug)]
pub struct Bodies<R: Real> {
    /// Centroid, metres.
    pub x: Column<R>,
    /// Centroid, metres.
    pub y: Column<R>,
    /// cos of the attitude.
    pub c: Column<R>,
    /// sin of the attitude.
    pub s: Column<R>,
    /// Velocity of the centroid, m/s.
    pub vx: Column<R>,
    /// Velocity of the centroid, m/s.
    pub vy: Column<R>,
    /// Angular velocity, rad/s.
    pub w: Column<R>,
    /// 1/kg; 0 unless dynamic.
    pub inv_mass: Column<R>,
    /// 1/(kg·m²); 0 unless dynamic.
    pub inv_inertia: Column<R>,
    /// Radius of a circle, half width of a box; 0 for polygons. Metres.
    pub extent_x: Column<R>,
    /// Half height of a box; 0 else. Metres.
    pub extent_y: Column<R>,
    /// Bounding radius about the centroid, metres, widened by 1e-5 of itself so that rounding never
    /// hides a touching pair from the broad phase.
    pub radius: Column<R>,
    /// Coulomb coefficient.
    pub friction: Column<R>,
    /// Coefficient of restitution.
    pub restitution: Column<R>,
    /// Constant force and torque per body (N, N, N·m), where some body has one.
    pub force: Option<[Column<R>; 3]>,
    /// Vertices of polygons.
    pub polygons: Polygons<R>,
    form: Vec<Form>,
    kind: Vec<BodyKind>,
    shape_start: Vec<u32>,
    filter: Vec<Filter>,
    generation: Vec<u32>,
    alive: Vec<bool>,
    free: Vec<u32>,
    inserted: usize,
    live: usize,
    revision: u64,
}

impl<R: Real> Default for Bodies<R> {
    fn default() -> Self {
        Self::new()
    }
}

impl<R: Real> Bodies<R> {
    /// The world alone.
    pub fn new() -> Self {
        let zero = || Column::new(R::ZERO);
        let mut bodies = Self {
            x: Column::new(R::FAR),
            y: Column::new(R::FAR),
            c: Column::new(R::ONE),
            s: zero(),
            vx: zero(),
            vy: zero(),
            w: zero(),
            inv_mass: zero(),
            inv_inertia: zero(),
            extent_x: zero(),
            extent_y: zero(),
            radius: zero(),
            friction: zero(),
            restitution: zero(),
            force: None,
            polygons: Polygons::default(),
            form: Vec::new(),
            kind: Vec::new(),
            shape_start: Vec::new(),
            filter: Vec::new(),
            generation: Vec::new(),
            alive: Vec::new(),
            free: Vec::new(),
            inserted: 0,
            live: 0,
            revision: 0,
        };
        bodies.grow();
        bodies
    }

    /// Slots in use, holes and the world included: columns are valid for `0..len()`.
    pub fn len(&self) -> usize {
        self.x.len()
    }
    /// Never: slot 0 is always there.
    pub fn is_empty(&self) -> bool {
        false
    }
    /// Living bodies, the world not counted.
    pub fn live(&self) -> usize {
        self.live
    }
    /// Grows whenever a body is inserted, removed or given another mass or force.
    pub fn revision(&self) -> u64 {
        self.revision
    }
    /// The kind of shape in a slot.
    #[inline(always)]
    pub fn form(&self, slot: usize) -> Form {
        self.form[slot]
    }
    /// Static, kinematic or dynamic; holes and the world are static.
    #[inline(always)]
    pub fn kind(&self, slot: usize) -> BodyKind {
        self.kind[slot]
    }
    /// Does a living body occupy the slot?
    pub fn is_alive(&self, slot: usize) -> bool {
        self.alive[slot]
    }
    /// How many living bodies are in a range of slots, of which some may lie past the last.
    pub fn live_in(&self, slots: Range<usize>) -> usize {
        self.alive[slots.start..slots.end.min(self.len())].iter().filter(|&&alive| alive).count()
    }
    /// Slots of living bodies, ascending.
    pub fn slots(&self) -> impl Iterator<Item = usize> + '_ {
        (1..self.len()).filter(|&slot| self.alive[slot])
    }
    /// The id of the living body in a slot.
    pub fn id(&self, slot: usize) -> Option<BodyId> {
        let alive = self.alive.get(slot).copied().unwrap_or(false);
        alive.then(|| BodyId { slot: slot as u32, generation: self.generation[slot] })
    }

    /// The body's shapes in the table of its form (the door for compounds: today one).
    #[inline(always)]
    pub fn shapes(&self, slot: usize) -> Range<usize> {
        let start = self.shape_start[slot] as usize;
        start..start + 1
    }

    /// May the two collide: one of them dynamic, and each in a category the other collides with?
    #[inline(always)]
    pub fn may_collide(&self, a: usize, b: usize) -> bool {
        let (fa, fb) = (&self.filter[a], &self.filter[b]);
        (fa.dynamic || fb.dynamic)
            && fa.category & fb.collides_with != 0
            && fb.category & fa.collides_with != 0
    }

    /// Takes a body in.
    ///
    /// # Errors
    /// A shape, mass, density, friction, restitution, pose or velocity that is out of range or not finite
    /// in this precision; a static body with a velocity. Nothing has changed then.
    pub fn insert(&mut self, spec: &BodySpec) -> Result<BodyId, BodyError> {
        let body = self.inserted;
        let shape = spec.shape.build().map_err(|why| BodyError::Shape { body, why })?;
        let matter = Checker { body }.check::<R>(spec, &shape)?;
        let slot = match self.free.pop() {
            Some(slot) => slot as usize,
            None => self.grow(),
        };
        let form = match shape {
            Shape::Circle { .. } => Form::Circle,
            Shape::Box { .. } => Form::Box,
            Shape::Polygon(_) => Form::Polygon,
        };
        let (extent, offset) = match &shape {
            Shape::Circle { radius } => ([*radius, 0.0], glam::DVec2::ZERO),
            Shape::Box { half } => ([half.x, half.y], glam::DVec2::ZERO),
            Shape::Polygon(p) => ([0.0, 0.0], p.centroid_given()),
        };
        let turn = glam::DVec2::from_angle(spec.angle);
        let centroid = glam::DVec2::from(spec.position) + turn.rotate(offset);
        for (column, value) in [
            (&mut self.x, centroid.x),
            (&mut self.y, centroid.y),
            (&mut self.c, turn.x),
            (&mut self.s, turn.y),
            (&mut self.vx, spec.velocity[0]),
            (&mut self.vy, spec.velocity[1]),
            (&mut self.w, spec.angular_velocity),
            (&mut self.inv_mass, matter.inv_mass),
            (&mut self.inv_inertia, matter.inv_inertia),
            (&mut self.extent_x, extent[0]),
            (&mut self.extent_y, extent[1]),
            (&mut self.radius, shape.bounding_radius() * (1.0 + 1e-5)),
            (&mut self.friction, spec.friction),
            (&mut self.restitution, spec.restitution),
        ] {
            column[slot] = R::from_f64(value);
        }
        self.form[slot] = form;
        self.kind[slot] = spec.kind;
        self.filter[slot] = Filter {
            category: spec.category,
            collides_with: spec.collides_with,
            dynamic: spec.kind == BodyKind::Dynamic,
        };
        self.alive[slot] = true;
        if form == Form::Polygon {
            self.shape_start[slot] = self.polygons.insert(&shape, slot as u32);
        }
        self.inserted += 1;
        self.live += 1;
        self.revision += 1;
        self.write_force(slot, [spec.force[0], spec.force[1], spec.torque]);
        Ok(BodyId { slot: slot as u32, generation: self.generation[slot] })
    }

    /// Takes a body out; its slot becomes an inert hole.
    ///
    /// # Errors
    /// An id whose body is gone.
    pub fn remove(&mut self, id: BodyId) -> Result<(), BodyError> {
        let slot = self.check_alive(id)?;
        if self.form[slot] == Form::Polygon {
            self.polygons.remove(self.shape_start[slot]);
        }
        self.write_force(slot, [0.0; 3]);
        self.make_inert(slot);
        self.generation[slot] += 1;
        // Kept descending, so that the lowest hole is filled first whatever the order of removals.
        let at = self.free.partition_point(|&f| f > slot as u32);
        self.free.insert(at, slot as u32);
        self.live -= 1;
        self.revision += 1;
        Ok(())
    }

    /// The slot of a living body.
    ///
    /// # Errors
    /// An id whose body is gone.
    pub fn check_alive(&self, id: BodyId) -> Result<usize, BodyError> {
        let slot = id.slot();
        if slot < self.len() && self.alive[slot] && self.generation[slot] == id.generation {
            Ok(slot)
        } else {
            Err(BodyError::Stale { slot: id.slot, generation: id.generation })
        }
    }

    /// Adds a linear impulse (N·s) at the centroid and an angular one (N·m·s).
    ///
    /// # Errors
    /// An id whose body is gone, a body that is not dynamic, an impulse that is not finite.
    pub fn apply_impulse(&mut self, id: BodyId, linear: [f64; 2], angular: f64) -> Result<(), BodyError> {
        let slot = self.check_alive(id)?;
        if self.kind[slot] != BodyKind::Dynamic {
            return Err(BodyError::NotDynamic(id.slot));
        }
        for value in [linear[0], linear[1], angular] {
            if !R::from_f64(value).is_finite() {
                return Err(BodyError::NonFiniteInSlot { slot: id.slot, field: "impulse", value });
            }
        }
        self.vx[slot] += R::from_f64(linear[0]) * self.inv_mass[slot];
        self.vy[slot] += R::from_f64(linear[1]) * self.inv_mass[slot];
        self.w[slot] += R::from_f64(angular) * self.inv_inertia[slot];
        Ok(())
    }

    /// Sets the constant force (N) and torque (N·m) on a body.
    ///
    /// # Errors
    /// An id whose body is gone, a value that is not finite.
    pub fn set_force(&mut self, id: BodyId, force: [f64; 2], torque: f64) -> Result<(), BodyError> {
        let slot = self.check_alive(id)?;
        for (field, value) in [("force", force[0]), ("force", force[1]), ("torque", torque)] {
            if !R::from_f64(value).is_finite() {
                return Err(BodyError::NonFiniteInSlot { slot: id.slot, field, value });
            }
        }
        self.write_force(slot, [force[0], force[1], torque]);
        self.revision += 1;
        Ok(())
    }

    /// Turns the vertices and normals of all polygons into world axes.
    pub fn refresh_polygons(&mut self) {
        let Polygons { body, world, owner, .. } = &mut self.polygons;
        let (cs, ss) = (self.c.padded(), self.s.padded());
        for ((body, world), &owner) in body.iter().zip(world).zip(&*owner) {
            let (c, s) = (cs[owner as usize], ss[owner as usize]);
            // Fixed-size rows, built whole: the compiler turns each into vectors of the target's width.
            let turn = |x: &[R; ROW], y: &[R; ROW]| -> [[R; ROW]; 2] {
                [std::array::from_fn(|k| c * x[k] - s * y[k]), std::array::from_fn(|k| s * x[k] + c * y[k])]
            };
            let ([x, y], [nx, ny]) = (turn(&body[0], &body[1]), turn(&body[2], &body[3]));
            *world = [x, y, nx, ny];
        }
    }

    /// The outline of the body in a slot about its centroid, world axes, in `f64`; empty for circles.
    pub fn outline(&self, slot: usize) -> Vec<[f64; 2]> {
        let (c, s) = (self.c[slot].to_f64(), self.s[slot].to_f64());
        let body: Vec<[f64; 2]> = match self.form[slot] {
            Form::Circle => Vec::new(),
            Form::Box => {
                let (hx, hy) = (self.extent_x[slot].to_f64(), self.extent_y[slot].to_f64());
                vec![[-hx, -hy], [hx, -hy], [hx, hy], [-hx, hy]]
            }
            Form::Polygon => {
                let at = self.shapes(slot).start;
                let [x, y, ..] = &self.polygons.body[at];
                (0..self.polygons.count[at] as usize).map(|k| [x[k].to_f64(), y[k].to_f64()]).collect()
            }
        };
        body.into_iter().map(|[x, y]| [c * x - s * y, s * x + c * y]).collect()
    }

    /// Bytes held by columns and polygon rows.
    pub fn bytes(&self) -> usize {
        let columns = [
            &self.x,
            &self.y,
            &self.c,
            &self.s,
            &self.vx,
            &self.vy,
            &self.w,
            &self.inv_mass,
            &self.inv_inertia,
            &self.extent_x,
            &self.extent_y,
            &self.radius,
            &self.friction,
            &self.restitution,
        ];
        let force = self.force.iter().flatten().map(Column::bytes).sum::<usize>();
        let rows = self.polygons.owner.len() * (2 * size_of::<HullRows<R>>() + 5);
        let cold = self.len() * (2 + 2 * 4 + size_of::<Filter>() + 1);
        columns.iter().map(|c| c.bytes()).sum::<usize>() + force + rows + cold
    }

    fn grow(&mut self) -> usize {
        let slot = self.len();
        for column in [
            &mut self.x,
            &mut self.y,
            &mut self.c,
            &mut self.s,
            &mut self.vx,
            &mut self.vy,
            &mut self.w,
            &mut self.inv_mass,
            &mut self.inv_inertia,
            &mut self.extent_x,
            &mut self.extent_y,
            &mut self.radius,
            &mut self.friction,
            &mut self.restitution,
        ] {
            column.resize(slot + 1);
        }
        for column in self.force.iter_mut().flatten() {
            column.resize(slot + 1);
        }
        self.form.push(Form::Circle);
        self.kind.push(BodyKind::Static);
        self.shape_start.push(0);
        self.filter.push(Filter::default());
        self.generation.push(0);
        self.alive.push(false);
        slot
    }

    /// Padding, said once: no mass, no extent, out of reach, in no category.
    fn make_inert(&mut self, slot: usize) {
        for column in [
            &mut self.s,
            &mut self.vx,
            &mut self.vy,
            &mut self.w,
            &mut self.inv_mass,
            &mut self.inv_inertia,
            &mut self.extent_x,
            &mut self.extent_y,
            &mut self.radius,
            &mut self.friction,
            &mut self.restitution,
        ] {
            column[slot] = R::ZERO;
        }
        self.c[slot] = R::ONE;
        self.x[slot] = R::FAR;
        self.y[slot] = R::FAR;
        self.form[slot] = Form::Circle;
        self.kind[slot] = BodyKind::Static;
        self.filter[slot] = Filter::default();
        self.alive[slot] = false;
    }

    fn write_force(&mut self, slot: usize, values: [f64; 3]) {
        if self.force.is_none() && values != [0.0; 3] {
            self.force = Some(std::array::from_fn(|_| Column::filled(self.x.len(), R::ZERO)));
        }
        if let Some(columns) = &mut self.force {
            for (column, value) in columns.iter_mut().zip(values) {
                column[slot] = R::from_f64(value);
            }
        }
    }
}

struct InverseMass {
    inv_mass: f64,
    inv_inertia: f64,
}

/// Checks the fields of the `body`-th specification.
struct Checker {
    body: usize,
}

impl Checker {
    fn check<R: Real>(&self, spec: &BodySpec, shape: &Shape) -> Result<InverseMass, BodyError> {
        let body = self.body;
        let finite = |field, value: f64| {
            if R::from_f64(value).is_finite() {
                Ok(())
            } else {
                Err(BodyError::NonFinite { body, field, value })
            }
        };
        let within = |field, value: f64, range, good: bool| {
            if good { Ok(()) } else { Err(BodyError::OutOfRange { body, field, range, value }) }
        };
        for (field, value) in [
            ("position", spec.position[0]),
            ("position", spec.position[1]),
            ("angle", spec.angle),
            ("velocity", spec.velocity[0]),
            ("velocity", spec.velocity[1]),
            ("angular_velocity", spec.angular_velocity),
            ("force", spec.force[0]),
            ("force", spec.force[1]),
            ("torque", spec.torque),
            ("friction", spec.friction),
        ] {
            finite(field, value)?;
        }
        // Beyond this a squared distance would overflow, or meet the padding.
        let reach = R::FAR.to_f64() * 1e-3;
        for value in spec.position {
            within(
                "position",
                value,
                "less than 1e15 (f32) or 1e97 (f64) from the origin",
                value.abs() < reach,
            )?;
        }
        let radius = shape.bounding_radius();
        within("shape size", radius, "less than 1e15 (f32) or 1e97 (f64) metres", radius < reach)?;
        within("friction", spec.friction, "at least 0", spec.friction >= 0.0)?;
        within("restitution", spec.restitution, "0 to 1", (0.0..=1.0).contains(&spec.restitution))?;
        if spec.kind == BodyKind::Static {
            let moving = [("velocity", spec.velocity[0]), ("velocity", spec.velocity[1])];
            let spin = [("angular_velocity", spec.angular_velocity)];
            if let Some(&(field, value)) = moving.iter().chain(&spin).find(|(_, value)| *value != 0.0) {
                return Err(BodyError::StaticMoves { body, field, value });
            }
        }
        self.inverse_mass::<R>(spec, shape)
    }

    fn inverse_mass<R: Real>(&self, spec: &BodySpec, shape: &Shape) -> Result<InverseMass, BodyError> {
        let body = self.body;
        let range = "positive and finite";
        for (field, value) in [("mass", spec.mass), ("density", spec.density)] {
            if let Some(value) = value.filter(|v| !(*v > 0.0 && v.is_finite())) {
                return Err(BodyError::OutOfRange { body, field, range, value });
            }
        }
        let properties = shape.mass_properties();
        let mass = match (spec.mass, spec.density) {
            (Some(mass), Some(density)) => return Err(BodyError::MassAndDensity { body, mass, density }),
            (Some(mass), None) => mass,
            (None, density) => density.unwrap_or(1.0) * properties.area,
        };
        if spec.kind != BodyKind::Dynamic {
            return Ok(InverseMass { inv_mass: 0.0, inv_inertia: 0.0 });
        }
        let inertia = mass / properties.area * properties.second_moment;
        let representable = |field, value: f64| {
            let inverse = R::from_f64(1.0 / value);
            if inverse.is_finite() && inverse > R::ZERO {
                Ok(1.0 / value)
            } else {
                Err(BodyError::OutOfRange { body, field, range: "invertible in this precision", value })
            }
        };
        Ok(InverseMass {
            inv_mass: representable("mass", mass)?,
            inv_inertia: representable("moment of inertia", inertia)?,
        })
    }
}
