//! Shapes on their ways through a step.

use glam::DVec2;

use super::Reach;
use crate::body::{Bodies, Form, Placed};
use crate::each::Each as _;
use crate::lanes::Real;
use crate::motion::Fast;
use crate::shape::MAX_VERTICES;
use crate::vec2::{Rot, Vec2};

/// A body's way through what is left of a step, but for its outline; time runs from 0 to 1.
#[derive(Clone, Copy, Debug)]
pub(super) struct Course {
    /// Centroid at the beginning, metres.
    pub(super) x: DVec2,
    /// Metres per step.
    pub(super) moved: DVec2,
    /// Bounding radius.
    pub(super) radius: f64,
    /// Rad per step.
    pub(super) angle: f64,
    pub(super) rot: Rot<f64>,
    /// A disc: its spin closes nothing.
    pub(super) round: bool,
}

impl Course {
    pub(super) fn of_fast<R: Real>(bodies: &Bodies<R>, fast: &Fast<R>) -> Self {
        let slot = fast.slot as usize;
        let [x, y, c, s] = fast.start.each(R::to_f64);
        let [dx, dy, angle] = fast.moved.each(R::to_f64);
        let [x, y] = if bodies.fine.is_some() {
            let [x, y] = bodies.place(slot);
            [x - dx, y - dy]
        } else {
            [x, y]
        };
        let (radius, round) = (bodies.radius[slot].to_f64(), bodies.form(slot) == Form::Circle);
        Self { x: DVec2::new(x, y), moved: DVec2::new(dx, dy), radius, angle, rot: Rot { c, s }, round }
    }

    /// The poses of obstacles are those at the step's end: a kinematic one came there by its velocity.
    pub(super) fn of_obstacle<R: Real>(bodies: &Bodies<R>, slot: usize, dt_secs: f64) -> Self {
        let [x, y] = bodies.place(slot);
        let [c, s, vx, vy, w] =
            [&bodies.c, &bodies.s, &bodies.vx, &bodies.vy, &bodies.w].each(|column| column[slot].to_f64());
        let (moved, angle) = (DVec2::new(vx, vy) * dt_secs, w * dt_secs);
        let (x, rot) = (DVec2::new(x, y) - moved, Rot { c, s }.turned(-angle));
        let (radius, round) = (bodies.radius[slot].to_f64(), bodies.form(slot) == Form::Circle);
        Self { x, moved, radius, angle, rot, round }
    }

    pub(super) fn is_finite(&self) -> bool {
        self.x.is_finite() && self.moved.is_finite() && self.angle.is_finite()
    }

    /// Do the bounding circles meet on their way?
    #[inline]
    pub(super) fn may_meet(&self, other: &Self, reach: &Reach) -> bool {
        let (from, way) = (other.x - self.x, other.moved - self.moved);
        let length_squared = way.length_squared();
        let nearest =
            if length_squared > 0.0 { (-from.dot(way) / length_squared).clamp(0.0, 1.0) } else { 0.0 };
        let near = self.radius + other.radius + reach.touching;
        (from + way * nearest).length_squared() <= near * near
    }

    /// What spin can close along any axis: a disc's none.
    #[inline]
    pub(super) fn spin_speed(&self) -> f64 {
        if self.round { 0.0 } else { self.angle.abs() * self.radius }
    }

    /// What is left of the way from a time on.
    #[inline]
    pub(super) fn after(&self, t: f64) -> Self {
        // Where nothing has met anything yet all of it is left, and no attitude to be turned.
        if t == 0.0 {
            return *self;
        }
        Self {
            x: self.x + self.moved * t,
            rot: self.rot.turned(self.angle * t),
            moved: self.moved * (1.0 - t),
            angle: self.angle * (1.0 - t),
            ..*self
        }
    }
}

/// A shape on its way.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sweep {
    pub(super) course: Course,
    /// Radius of a disc; 0 for outlines.
    disc: f64,
    /// Vertices in the body frame, counter-clockwise.
    vertices: [DVec2; MAX_VERTICES],
    pub(super) count: usize,
}

impl Sweep {
    /// The body in a slot, on this way.
    pub(super) fn of<R: Real>(bodies: &Bodies<R>, slot: usize, course: Course) -> Self {
        let (vertices, count) = bodies.corners_body(slot);
        Self { course, disc: bodies.disc(slot), vertices, count }
    }

    /// The disc about the centroid.
    pub(super) fn core(&self, radius: f64) -> Self {
        let course = Course { radius, round: true, ..self.course };
        Self { course, disc: radius, count: 0, vertices: self.vertices }
    }

    /// The same on another way.
    pub(super) fn on(&self, course: Course) -> Self {
        Self { course, ..*self }
    }

    #[inline]
    pub(super) fn at(&self, t: f64) -> Placed {
        let Course { x, rot, moved, angle, .. } = self.course;
        let rot = rot.turned(angle * t);
        let turned = |v: DVec2| {
            let v = rot.apply(Vec2::new(v.x, v.y));
            DVec2::new(v.x, v.y)
        };
        Placed {
            centre: x + moved * t,
            disc: self.disc,
            corners: self.vertices.each(turned),
            count: self.count,
        }
    }
}

/// An obstacle, and its faces as the step begins.
#[derive(Clone, Debug)]
pub(super) struct Wall {
    pub(super) sweep: Sweep,
    /// Outward normal, and how far the shape reaches along it; as many as the shape has vertices.
    faces: [(DVec2, f64); MAX_VERTICES],
}

impl Wall {
    pub(super) fn new<R: Real>(bodies: &Bodies<R>, slot: usize, dt_secs: f64) -> Self {
        let sweep = Sweep::of(bodies, slot, Course::of_obstacle(bodies, slot, dt_secs));
        let placed = sweep.at(0.0);
        let mut faces = [(DVec2::ZERO, 0.0); MAX_VERTICES];
        for (face, normal) in faces.iter_mut().zip(placed.normals()) {
            *face = (normal, placed.extent(normal));
        }
        Self { sweep, faces }
    }

    /// Does a face promise that `body` does not come near in this step, whatever its outline? See [`approach`],
    /// whose first advance would say so too.
    pub(super) fn keeps_clear(&self, body: &Course, reach: &Reach) -> bool {
        let course = &self.sweep.course;
        let (from, way) = (body.x - course.x, body.moved - course.moved);
        let spin = body.spin_speed() + course.spin_speed();
        self.faces[..self.sweep.count].iter().any(|&(normal, extent)| {
            let apart = normal.dot(from) - extent - body.radius;
            apart > reach.touching && apart - reach.clear >= spin - normal.dot(way)
        })
    }
}

impl Placed {
    /// How far the shape reaches from its centre along `axis`.
    #[inline]
    pub(super) fn extent(&self, axis: DVec2) -> f64 {
        if self.count == 0 {
            return self.disc;
        }
        let mut extent = f64::MIN;
        for corner in self.corners() {
            extent = extent.max(axis.dot(*corner));
        }
        extent
    }

    /// Outward unit normals of the faces.
    #[inline]
    pub(super) fn normals(&self) -> impl Iterator<Item = DVec2> + '_ {
        let next = self.corners().iter().cycle().skip(1);
        self.corners().iter().zip(next).map(|(&p, &q)| -(q - p).perp().normalize())
    }

    /// From a disc's centre towards the nearest vertex, or the centre of the other disc.
    pub(super) fn towards(&self, other: &Self) -> DVec2 {
        let to = other.centre - self.centre;
        let nearer = |a: DVec2, b: &DVec2| {
            let b = to + *b;
            if b.length_squared() < a.length_squared() { b } else { a }
        };
        let start = other.corners().first().map_or(to, |v| to + *v);
        other.corners().iter().fold(start, nearer).normalize_or(DVec2::Y)
    }
}
