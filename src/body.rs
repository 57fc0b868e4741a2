//! Bodies as a structure of arrays.
//!
//! One column per quantity; slot 0 is the immovable world. A body keeps its slot until it is removed;
//! its hole is inert and is filled again by the next insertion, lowest slot first. Ids carry a
//! generation, so the id of a removed body is never mistaken for its successor's.
//!
//! # Bytes per body
//! Hot columns, read or written each step: position 2, attitude 2, velocity 3, inverse mass and inertia
//! 2, extents 2, bounding radius 1, core 1, friction 1, restitution 1: 15 reals = 60 B in f32 (120 B in f64).
//! Cold, 23 B: kind 1, shape form 1, shape start 4, generation 4, filter 12 (category, collides-with,
//! dynamic), flags 1. Only where some body needs them: constant force and torque 3 reals (12 B), what positions are beyond
//! a real 4 reals (16 B), a polygon's
//! vertices and normals in both frames: 8 rows of 8 (256 B in f32), beside vertex
//! count 1 and owner 4; a driven body's drive 72.
//! Rejected: mass beside inverse mass (8 B that no kernel reads); an angle beside the unit complex
//! number (4 B and a trigonometric call wherever it is used).

mod check;
mod drive;
mod fine;
mod force;
mod grow;
mod kind;
mod outline;
mod polygons;
mod put;
mod spec;
mod turn;

use std::ops::Range;

use crate::column::Column;
use crate::each::Each as _;
use crate::lanes::Real;
use crate::shape::Shape;
use crate::vec2::Rot;

pub use check::BodyError;
use check::Checker;
use drive::{Drive, Drives};
pub(crate) use fine::{fine_difference, move_finely};
pub(crate) use outline::Placed;
pub use polygons::{HullRows, Polygons};
pub use spec::{BodyKind, BodySpec, ShapeSpec};

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
    /// Half the radius of the largest circle about the centroid that a dynamic body holds, metres: a longer path in
    /// one step is fast ([`crate::continuous`]). Other bodies: out of reach.
    pub core: Column<R>,
    /// Coulomb coefficient.
    pub friction: Column<R>,
    /// Coefficient of restitution.
    pub restitution: Column<R>,
    /// Constant force and torque per body (N, N, N·m), where some body has one.
    pub force: Option<[Column<R>; 3]>,
    /// Rows of four per slot: what the centroid is beyond its columns, x and y, metres, –, –; only with
    /// [`Settings::positions`](crate::settings::Settings::positions) finer than the scalar.
    pub fine: Option<Column<R>>,
    /// Vertices of polygons.
    pub polygons: Polygons<R>,
    form: Vec<Form>,
    kind: Vec<BodyKind>,
    shape_start: Vec<u32>,
    filter: Vec<Filter>,
    generation: Vec<u32>,
    alive: Vec<bool>,
    free: Vec<u32>,
    drives: Drives,
    inserted: usize,
    live: usize,
    revision: u64,
    pushes: u64,
    removals: u64,
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
            core: Column::new(R::FAR),
            friction: zero(),
            restitution: zero(),
            force: None,
            fine: None,
            polygons: Polygons::default(),
            form: Vec::new(),
            kind: Vec::new(),
            shape_start: Vec::new(),
            filter: Vec::new(),
            generation: Vec::new(),
            alive: Vec::new(),
            free: Vec::new(),
            drives: Drives::default(),
            inserted: 0,
            live: 0,
            revision: 0,
            pushes: 0,
            removals: 0,
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
    /// Grows whenever a body is inserted, removed, put elsewhere or given another mass, and with the first force of a body.
    pub fn revision(&self) -> u64 {
        self.revision
    }
    /// Grows whenever a body is given another force.
    pub fn pushes(&self) -> u64 {
        self.pushes
    }
    /// Bodies ever removed: while it stays, a slot means the same body.
    pub fn removals(&self) -> u64 {
        self.removals
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
    #[inline]
    pub fn live_in(&self, slots: Range<usize>) -> usize {
        self.alive[slots.start..slots.end.min(self.len())].iter().filter(|&&alive| alive).count()
    }
    /// Slots of living bodies, ascending.
    pub fn slots(&self) -> impl Iterator<Item = usize> + Clone + '_ {
        (1..self.len()).filter(|&slot| self.alive[slot])
    }
    /// How often the slot has been given anew.
    pub fn generation(&self, slot: usize) -> u32 {
        self.generation[slot]
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
    /// in this precision; a static body with a velocity; a pivot of a body that is not kinematic, or beside
    /// a velocity. Nothing has changed then.
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
        let dynamic = spec.kind == BodyKind::Dynamic;
        let core = if dynamic { 0.5 * shape.inner_radius() } else { R::FAR.to_f64() };
        // Our own sine and cosine: the same bits on every platform.
        let turn = Rot::<f64>::from_angle(spec.angle % std::f64::consts::TAU);
        let turn = glam::DVec2::new(turn.c, turn.s);
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
            (&mut self.core, core),
            (&mut self.friction, spec.friction),
            (&mut self.restitution, spec.restitution),
        ] {
            column[slot] = R::from_f64(value);
        }
        self.set_place(slot, centroid.into());
        self.form[slot] = form;
        self.kind[slot] = spec.kind;
        self.filter[slot] = Filter { category: spec.category, collides_with: spec.collides_with, dynamic };
        self.alive[slot] = true;
        if form == Form::Polygon {
            self.shape_start[slot] = self.polygons.insert(&shape, slot as u32);
        }
        if let Some(pivot) = spec.pivot {
            let drive = Drive::new(slot, pivot.into(), centroid, turn, spec.angular_velocity);
            [self.vx[slot], self.vy[slot]] = drive.velocity().each(R::from_f64);
            self.drives.insert(drive);
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
        self.drives.remove(slot);
        self.make_inert(slot);
        self.generation[slot] += 1;
        // Kept descending, so that the lowest hole is filled first whatever the order of removals.
        let at = self.free.partition_point(|&f| f > slot as u32);
        self.free.insert(at, slot as u32);
        self.live -= 1;
        self.revision += 1;
        self.removals += 1;
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

    /// What lengths without a scale of their own are shares of, for a pair the lesser of both: of a dynamic body its bounding
    /// radius, metres, of others beyond all.
    #[inline]
    pub fn length(&self, slot: usize) -> R {
        if self.kind(slot) == BodyKind::Dynamic { self.radius[slot] } else { R::FAR }
    }

    /// Does some body go round a pivot?
    pub fn is_driven(&self) -> bool {
        !self.drives.is_empty()
    }

    /// Gives the bodies with a pivot the velocities of a step of `dt_secs`; see `body/drive.rs`.
    pub fn drive(&mut self, dt_secs: f64) {
        if !self.drives.is_empty() {
            // Out for the while, so that it may write to the columns beside it.
            let mut drives = std::mem::take(&mut self.drives);
            drives.apply(self, dt_secs);
            self.drives = drives;
        }
    }
}
