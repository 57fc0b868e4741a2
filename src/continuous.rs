//! Continuous collision: a fast body stops at the wall in its way instead of passing it between two steps.
//!
//! A body is fast when a point of it may have moved further in one step than half its inner radius
//! ([`Bodies::core`]); the passes that end a step note such bodies ([`Fast`]), at one comparison per lane value.
//! Each is moved back to the first pose of its step, in a straight line at even speed and spin, at which it meets
//! a static or kinematic body; from there a kinematic one takes it along. Its velocity stays: the next step's
//! contact stops it.
//!
//! **Not against dynamic bodies.** Those may be moved back themselves, so that the answer would depend on whose
//! turn is first; and a scene in which everything flies ([`crate::scene`]'s `free_flight`) would test all pairs.
//!
//! # Time of impact
//! Conservative advancement over separating axes (Mirtich, Impulse-based Dynamic Simulation of Rigid Body Systems,
//! 1996, §2.3). Along a fixed axis n two bodies s apart cannot close faster than −n·(v_B − v_A) + |ω_A|·R_A +
//! |ω_B|·R_B, so each axis promises a time without impact, and the longest of them holds. Without spin the face
//! normals promise the exact time; an axis that opens ends the search, so that a body that slides along a wall or
//! passes its end is done at once. All in `f64` scalars: few bodies are fast.
//!
//! # Where a body is stopped
//! The next step must find the contact. Solvers that hear of gaps get a body half a skin away, where they stop it
//! without letting it sink; one that hears of overlaps alone gets it one skin deep. A pair that is nearer than two
//! skins (or overlaps) as the step begins is left to the solver, but for its core, a disc of half the inner radius,
//! which never gets in: a plate that has come down on a corner would turn about it and through. A body whose contact
//! has stopped it, or whose way ends before the wall, is left where it is, however near that is: stopped half a skin
//! early, a billiard ball lost 20 µs. The skin is a thousandth of the scene's median radius, at most a fiftieth of the
//! body's core, at least what a coordinate is rounded by.
//!
//! # What a pair costs
//! Fast bodies are tested against each obstacle's bounding circle first, one after the other: their product is
//! the cost, which is what a scene of thousands of both would pay for. Then against its faces, with the body's
//! bounding circle in its place: a wall's own circle is as wide as the wall is long and turns nothing away. A face
//! that promises a whole step to the circle promises it to the body, so the search would have said the same.

use glam::DVec2;

use crate::body::{Bodies, BodyKind, Form};
use crate::each::Each as _;
use crate::lanes::Real;
use crate::motion::{Fast, FastBodies};
use crate::shape::MAX_VERTICES;
use crate::vec2::{Rot, Vec2};

/// Advances after which a body is stopped where it is known not to have met anything yet.
const ADVANCES: usize = 64;

/// The fast bodies of a step, and what they may meet; memory is kept from step to step.
#[derive(Clone, Debug)]
pub(crate) struct Continuous<R: Real> {
    fast: Vec<Fast<R>>,
    /// Slots of static and kinematic bodies, ascending.
    obstacles: Vec<u32>,
    /// The obstacles' ways through this step, in their order.
    walls: Vec<Wall>,
}

impl<R: Real> Default for Continuous<R> {
    fn default() -> Self {
        Self { fast: Vec::new(), obstacles: Vec::new(), walls: Vec::new() }
    }
}

impl<R: Real> Continuous<R> {
    /// Notes which bodies can be in the way.
    pub(crate) fn look_over(&mut self, bodies: &Bodies<R>) {
        let fixed = bodies.slots().filter(|&slot| bodies.kind(slot) != BodyKind::Dynamic);
        self.obstacles.clear();
        self.obstacles.extend(fixed.map(|slot| slot as u32));
    }

    /// Where a step is to note its fast bodies: nowhere if nothing can be in their way.
    pub(crate) fn begin(&mut self, wanted: bool) -> FastBodies<'_, R> {
        self.fast.clear();
        (wanted && !self.obstacles.is_empty()).then_some(&mut self.fast)
    }

    /// Moves the fast bodies of a step of `dt_secs` back to where they meet something. `skin_m`: what counts as
    /// touching, metres; `margin`: gaps the solver hears of; `apart`: pairs that do not collide, ordered; bodies moved
    /// back are marked in `has_moved`.
    pub(crate) fn stop(
        &mut self,
        bodies: &mut Bodies<R>,
        skin_m: f64,
        margin: R,
        dt_secs: f64,
        apart: &[[u32; 2]],
        has_moved: &mut [bool],
    ) {
        if self.fast.is_empty() {
            return;
        }
        self.walls.clear();
        let walls = self.obstacles.iter().map(|&slot| Wall::new(bodies, slot as usize, dt_secs));
        self.walls.extend(walls);
        for fast in &self.fast {
            let slot = fast.slot as usize;
            let sweep = Sweep::of_fast(bodies, fast);
            if !sweep.is_finite() {
                // The finite check names it.
                continue;
            }
            let reach = Reach::new(
                skin_m,
                margin > R::ZERO,
                bodies.core[slot].to_f64(),
                &sweep,
                bodies.place_epsilon(),
            );
            let mut first: Option<(f64, Sweep)> = None;
            for (&other, wall) in self.obstacles.iter().zip(&self.walls) {
                if !sweep.may_meet(&wall.sweep, &reach) || wall.keeps_clear(&sweep, &reach) {
                    continue;
                }
                let pair = [other.min(slot as u32), other.max(slot as u32)];
                if !bodies.may_collide(slot, other as usize) || apart.binary_search(&pair).is_ok() {
                    continue;
                }
                if let Some(t) = impact(&sweep, &wall.sweep, &reach)
                    && first.is_none_or(|(earliest, _)| t < earliest)
                {
                    first = Some((t, wall.sweep));
                }
            }
            if let Some((t, obstacle)) = first {
                put(bodies, fast, sweep.x, t, &obstacle);
                has_moved[slot] = true;
            }
        }
    }
}

/// Puts a body where it was at the share `t` of its step; what it met there takes it along for the rest.
fn put<R: Real>(bodies: &mut Bodies<R>, fast: &Fast<R>, from: DVec2, t: f64, met: &Sweep) {
    let slot = fast.slot as usize;
    let [.., c, s] = fast.start;
    let [dx, dy, angle] = fast.moved.each(|moved| moved.to_f64() * t);
    let (at, rest) = (from + DVec2::new(dx, dy), 1.0 - t);
    let (carried, turn) = (met.carry(at, t), met.angle * rest);
    let rot = Rot { c, s }.turned(R::from_f64(angle + turn));
    bodies.set_place(slot, carried.into());
    (bodies.c[slot], bodies.s[slot]) = (rot.c, rot.s);
}

/// How near counts, metres.
#[derive(Clone, Copy, Debug)]
struct Reach {
    /// Pairs this near as a step begins are the solver's.
    touching: f64,
    /// The separation bodies are stopped at.
    target: f64,
    /// What a search may miss the target by.
    tolerance: f64,
    /// Bodies that end their way no nearer than this go it to its end.
    clear: f64,
    /// Radius of the disc about the centroid that never gets in, metres.
    core: f64,
}

impl Reach {
    fn new(skin_m: f64, hears_of_gaps: bool, core: f64, sweep: &Sweep, epsilon: f64) -> Self {
        let coordinate = sweep.x.abs().max_element() + sweep.moved.abs().max_element();
        let skin = skin_m.min(core / 50.0).max(16.0 * epsilon * coordinate);
        let (touching, target) = if hears_of_gaps { (2.0 * skin, 0.5 * skin) } else { (0.0, -skin) };
        let tolerance = 0.25 * skin;
        Self { touching, target, tolerance, clear: target.min(-tolerance), core }
    }

    /// For the core: no contact knows of it, so it is stopped however near it begins.
    fn of_core(self) -> Self {
        let target = 2.0 * self.tolerance;
        Self { touching: 0.0, target, clear: target, ..self }
    }
}

/// A shape and its way through a step; time runs from 0 to 1.
#[derive(Clone, Copy, Debug)]
struct Sweep {
    /// Centroid at the beginning, metres.
    x: DVec2,
    rot: Rot<f64>,
    /// Metres and rad per step.
    moved: DVec2,
    angle: f64,
    /// Radius of a disc; 0 for outlines.
    disc: f64,
    /// Bounding radius.
    radius: f64,
    /// Vertices in the body frame, counter-clockwise.
    vertices: [DVec2; MAX_VERTICES],
    count: usize,
}

impl Sweep {
    fn of_fast<R: Real>(bodies: &Bodies<R>, fast: &Fast<R>) -> Self {
        let [x, y, c, s] = fast.start.each(R::to_f64);
        let [dx, dy, angle] = fast.moved.each(R::to_f64);
        let still = Self::shape(bodies, fast.slot as usize);
        let [x, y] = if bodies.fine.is_some() {
            let [x, y] = bodies.place(fast.slot as usize);
            [x - dx, y - dy]
        } else {
            [x, y]
        };
        Self { x: DVec2::new(x, y), rot: Rot { c, s }, moved: DVec2::new(dx, dy), angle, ..still }
    }

    /// The poses of obstacles are those at the step's end: a kinematic one came there by its velocity.
    fn of_obstacle<R: Real>(bodies: &Bodies<R>, slot: usize, dt_secs: f64) -> Self {
        let [x, y] = bodies.place(slot);
        let [c, s, vx, vy, w] =
            [&bodies.c, &bodies.s, &bodies.vx, &bodies.vy, &bodies.w].each(|column| column[slot].to_f64());
        let (moved, angle) = (DVec2::new(vx, vy) * dt_secs, w * dt_secs);
        let (x, rot) = (DVec2::new(x, y) - moved, Rot { c, s }.turned(-angle));
        Self { x, rot, moved, angle, ..Self::shape(bodies, slot) }
    }

    fn shape<R: Real>(bodies: &Bodies<R>, slot: usize) -> Self {
        let (hx, hy) = (bodies.extent_x[slot].to_f64(), bodies.extent_y[slot].to_f64());
        let mut vertices = [DVec2::ZERO; MAX_VERTICES];
        let (disc, count) = match bodies.form(slot) {
            Form::Circle => (hx, 0),
            Form::Box => {
                let corners = [(-hx, -hy), (hx, -hy), (hx, hy), (-hx, hy)].each(DVec2::from);
                vertices[..4].copy_from_slice(&corners);
                (0.0, 4)
            }
            Form::Polygon => {
                let at = bodies.shapes(slot).start;
                let [x, y, ..] = &bodies.polygons.body[at];
                vertices = crate::each::indexed(|k| DVec2::new(x[k].to_f64(), y[k].to_f64()));
                (0.0, usize::from(bodies.polygons.count[at]))
            }
        };
        Self {
            x: DVec2::ZERO,
            rot: Rot { c: 1.0, s: 0.0 },
            moved: DVec2::ZERO,
            angle: 0.0,
            disc,
            radius: bodies.radius[slot].to_f64(),
            vertices,
            count,
        }
    }

    fn is_finite(&self) -> bool {
        self.x.is_finite() && self.moved.is_finite() && self.angle.is_finite()
    }

    /// Do the bounding circles meet on their way?
    fn may_meet(&self, other: &Self, reach: &Reach) -> bool {
        let (from, way) = (other.x - self.x, other.moved - self.moved);
        let length_squared = way.length_squared();
        let nearest =
            if length_squared > 0.0 { (-from.dot(way) / length_squared).clamp(0.0, 1.0) } else { 0.0 };
        let near = self.radius + other.radius + reach.touching;
        (from + way * nearest).length_squared() <= near * near
    }

    /// The disc about the centroid.
    fn core(&self, radius: f64) -> Self {
        Self { disc: radius, radius, count: 0, ..*self }
    }

    /// What spin can close along any axis: a disc's none.
    fn spin_speed(&self) -> f64 {
        if self.count == 0 { 0.0 } else { self.angle.abs() * self.radius }
    }

    /// Where a point that is at `point` at time `t` ends if it goes with the body.
    fn carry(&self, point: DVec2, t: f64) -> DVec2 {
        let arm = point - (self.x + self.moved * t);
        let turn = Rot { c: 1.0, s: 0.0 }.turned(self.angle * (1.0 - t));
        let turned = turn.apply(Vec2::new(arm.x, arm.y));
        point + self.moved * (1.0 - t) + (DVec2::new(turned.x, turned.y) - arm)
    }

    fn at(&self, t: f64) -> Placed {
        let rot = self.rot.turned(self.angle * t);
        let turned = |v: DVec2| {
            let v = rot.apply(Vec2::new(v.x, v.y));
            DVec2::new(v.x, v.y)
        };
        Placed {
            centre: self.x + self.moved * t,
            disc: self.disc,
            vertices: self.vertices.each(turned),
            count: self.count,
        }
    }
}

/// An obstacle, and its faces as the step begins.
#[derive(Clone, Debug)]
struct Wall {
    sweep: Sweep,
    /// Outward normal, and how far the shape reaches along it; as many as the shape has vertices.
    faces: [(DVec2, f64); MAX_VERTICES],
}

impl Wall {
    fn new<R: Real>(bodies: &Bodies<R>, slot: usize, dt_secs: f64) -> Self {
        let sweep = Sweep::of_obstacle(bodies, slot, dt_secs);
        let placed = sweep.at(0.0);
        let mut faces = [(DVec2::ZERO, 0.0); MAX_VERTICES];
        for (face, normal) in faces.iter_mut().zip(placed.normals()) {
            *face = (normal, placed.extent(normal));
        }
        Self { sweep, faces }
    }

    /// Does a face promise that `body` does not come near in this step, whatever its outline? See [`approach`],
    /// whose first advance would say so too.
    fn keeps_clear(&self, body: &Sweep, reach: &Reach) -> bool {
        let (from, way) = (body.x - self.sweep.x, body.moved - self.sweep.moved);
        let spin = body.spin_speed() + self.sweep.spin_speed();
        self.faces[..self.sweep.count].iter().any(|&(normal, extent)| {
            let apart = normal.dot(from) - extent - body.radius;
            apart > reach.touching && apart - reach.clear >= spin - normal.dot(way)
        })
    }
}

/// A shape where it is.
#[derive(Clone, Copy, Debug)]
struct Placed {
    centre: DVec2,
    disc: f64,
    /// About the centre, world axes.
    vertices: [DVec2; MAX_VERTICES],
    count: usize,
}

impl Placed {
    fn vertices(&self) -> &[DVec2] {
        &self.vertices[..self.count]
    }

    /// How far the shape reaches from its centre along `axis`.
    fn extent(&self, axis: DVec2) -> f64 {
        let corners = self.vertices().iter().map(|v| axis.dot(*v));
        if self.count == 0 { self.disc } else { corners.fold(f64::MIN, f64::max) }
    }

    /// Outward unit normals of the faces.
    fn normals(&self) -> impl Iterator<Item = DVec2> + '_ {
        let next = self.vertices().iter().cycle().skip(1);
        self.vertices().iter().zip(next).map(|(&p, &q)| -(q - p).perp().normalize())
    }

    /// From a disc's centre towards the nearest vertex, or the centre of the other disc.
    fn towards(&self, other: &Self) -> DVec2 {
        let to = other.centre - self.centre;
        let nearer = |a: DVec2, b: &DVec2| {
            let b = to + *b;
            if b.length_squared() < a.length_squared() { b } else { a }
        };
        let start = other.vertices().first().map_or(to, |v| to + *v);
        other.vertices().iter().fold(start, nearer).normalize_or(DVec2::Y)
    }
}

/// When a fast body meets an obstacle, as a share of the step. A pair that touches from the beginning is the
/// solver's, which stops points and not what turns about them: there only the body's core is held back.
fn impact(body: &Sweep, obstacle: &Sweep, reach: &Reach) -> Option<f64> {
    match approach(body, obstacle, reach) {
        Approach::Meets(t) => Some(t),
        Approach::Passes => None,
        Approach::Touching => match approach(&body.core(reach.core), obstacle, &reach.of_core()) {
            Approach::Meets(t) => Some(t),
            Approach::Passes | Approach::Touching => None,
        },
    }
}

/// How two bodies come to each other in a step.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Approach {
    /// As near as wanted, for the first time at this share of it.
    Meets(f64),
    /// Never as near.
    Passes,
    /// Near from the beginning.
    Touching,
}

/// See the module's documentation.
fn approach(a: &Sweep, b: &Sweep, reach: &Reach) -> Approach {
    let (velocity, spin) = (b.moved - a.moved, a.spin_speed() + b.spin_speed());
    let mut t = 0.0;
    for _ in 0..ADVANCES {
        let (placed_a, placed_b) = (a.at(t), b.at(t));
        let to_b = placed_b.centre - placed_a.centre;
        let (mut separation, mut wait, mut clear) = (f64::MIN, 0.0f64, false);
        let mut along = |axis: DVec2| {
            let apart = axis.dot(to_b) - placed_a.extent(axis) - placed_b.extent(-axis);
            separation = separation.max(apart);
            let closing = spin - axis.dot(velocity);
            clear |= apart > reach.touching && apart - reach.clear >= closing * (1.0 - t);
            let spare = apart - reach.target;
            if spare > 0.0 {
                wait = wait.max(if closing > 0.0 { spare / closing } else { f64::INFINITY });
            }
        };
        placed_a.normals().for_each(&mut along);
        placed_b.normals().for_each(|axis| along(-axis));
        if a.count == 0 {
            along(placed_a.towards(&placed_b));
        } else if b.count == 0 {
            along(-placed_b.towards(&placed_a));
        }
        if t == 0.0 && separation <= reach.touching {
            return Approach::Touching;
        }
        if wait == f64::INFINITY || clear {
            return Approach::Passes;
        }
        if separation <= reach.target + reach.tolerance {
            return Approach::Meets(t);
        }
        t += wait;
        if t >= 1.0 {
            return Approach::Passes;
        }
    }
    Approach::Meets(t)
}
