//! The layout as the thesis has it: boxed bodies, boxed shapes behind an interface, work done twice.
//!
//! Where a choice was open it copies the cost of the original: the kind is asked for through the interface
//! twice per pair, a narrow test begins with dynamic casts, an edge's normal costs a square root each time
//! it is looked at, and every resolved contact rebuilds the corners of both bodies (the floor's too) through
//! a 4×4 matrix although only the position changed.
//! One cost cannot be copied: a C++ `dynamic_cast` searches the class hierarchy, `downcast_ref` compares a
//! 128-bit number.

use std::any::Any;
use std::fmt::Debug;

use glam::Vec2;

use lamina2d::vec2::Rot;

use super::build::{Blueprint, Kind};
use super::narrow::{Hull, bounds_meet, circle_circle, hull_circle, hull_hull};
use super::resolve::{Contact, resolve};
use super::rigid::{Rigid, ThesisIntegrator};
use super::sweep::Layout;

type Matrix = [[f32; 4]; 4];

/// What differs by shape.
trait Form: Debug + Send + Sync {
    fn kind(&self) -> Kind;
    fn rebuild(&mut self, rotation: f32, position_px: Vec2);
    fn as_any(&self) -> &dyn Any;
}

/// The base class: its fields are read without a virtual call, as in C++.
#[derive(Debug)]
struct Shape<F: ?Sized> {
    radius_px: f32,
    rotation: f32,
    position_px: Vec2,
    form: F,
}

#[derive(Debug)]
struct CircleForm;

impl Form for CircleForm {
    fn kind(&self) -> Kind {
        Kind::Circle
    }
    fn rebuild(&mut self, _rotation: f32, _position_px: Vec2) {}
    fn as_any(&self) -> &dyn Any {
        self
    }
}

#[derive(Debug)]
struct HullForm {
    kind: Kind,
    local_px: Vec<Vec2>,
    world_px: Vec<Vec2>,
}

impl Form for HullForm {
    fn kind(&self) -> Kind {
        self.kind
    }
    fn rebuild(&mut self, rotation: f32, position_px: Vec2) {
        let matrix = about_z(rotation);
        for (world, local) in self.world_px.iter_mut().zip(&self.local_px) {
            let [x, y, ..] = transform(&matrix, [local.x, local.y, 0.0, 1.0]);
            *world = Vec2::new(x, y) + position_px;
        }
    }
    fn as_any(&self) -> &dyn Any {
        self
    }
}

impl Hull for HullForm {
    const STOPS_EARLY: bool = false;

    #[inline(always)]
    fn corners(&self) -> &[Vec2] {
        &self.world_px
    }
    #[inline(always)]
    fn normal(&self, k: usize) -> Vec2 {
        let (here, next) = (self.world_px[k], self.world_px[(k + 1) % self.world_px.len()]);
        let edge = if self.kind == Kind::Box { next - here } else { here - next };
        edge.perp().normalize()
    }
    #[inline(always)]
    fn swallows_centres(&self) -> bool {
        self.kind == Kind::Polygon
    }
}

/// Columns of the rotation by `angle` about z.
fn about_z(angle: f32) -> Matrix {
    let Rot { c, s } = Rot::from_angle(angle);
    [[c, s, 0.0, 0.0], [-s, c, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]]
}

#[inline(always)]
fn transform(columns: &Matrix, v: [f32; 4]) -> [f32; 4] {
    let [a, b, c, d] = columns;
    let of = |row: usize| (a[row] * v[0] + b[row] * v[1]) + (c[row] * v[2] + d[row] * v[3]);
    [of(0), of(1), of(2), of(3)]
}

#[derive(Debug)]
struct Body {
    rigid: Rigid,
    force: Vec2,
    shape: Box<Shape<dyn Form>>,
}

impl Body {
    fn new(blueprint: &Blueprint) -> Self {
        let Blueprint { rigid, kind, radius_px, local_px } = blueprint;
        let (radius_px, rotation, position_px) = (*radius_px, rigid.rotation, rigid.position_px);
        let shape: Box<Shape<dyn Form>> = if *kind == Kind::Circle {
            Box::new(Shape { radius_px, rotation, position_px, form: CircleForm })
        } else {
            let form = HullForm {
                kind: *kind,
                local_px: local_px.clone(),
                world_px: vec![Vec2::ZERO; local_px.len()],
            };
            Box::new(Shape { radius_px, rotation, position_px, form })
        };
        let mut body = Self { rigid: rigid.clone(), force: Vec2::ZERO, shape };
        body.rebuild();
        body
    }

    fn rebuild(&mut self) {
        let shape = &mut *self.shape;
        (shape.rotation, shape.position_px) = (self.rigid.rotation, self.rigid.position_px);
        shape.form.rebuild(shape.rotation, shape.position_px);
    }

    fn kind(&self) -> Kind {
        self.shape.form.kind()
    }

    #[inline(always)]
    fn hull(&self) -> Option<&HullForm> {
        self.shape.form.as_any().downcast_ref()
    }

    #[inline(always)]
    fn is_circle(&self) -> bool {
        self.shape.form.as_any().is::<CircleForm>()
    }
}

fn touch_circle(hull: &Body, circle: &Body) -> Option<Contact> {
    let form = hull.hull().filter(|_| circle.is_circle())?;
    hull_circle(form, circle.rigid.position_px, circle.shape.radius_px)
}

/// The bodies in the original's layout.
#[derive(Debug)]
pub(super) struct FaithfulBodies {
    #[expect(clippy::vec_box, reason = "the original's vector of owning pointers is what is measured")]
    bodies: Vec<Box<Body>>,
}

impl FaithfulBodies {
    pub(super) fn new(blueprints: &[Blueprint]) -> Self {
        Self { bodies: blueprints.iter().map(|b| Box::new(Body::new(b))).collect() }
    }
}

impl Layout for FaithfulBodies {
    #[inline(always)]
    fn len(&self) -> usize {
        self.bodies.len()
    }

    #[inline(always)]
    fn rigid(&self, body: usize) -> &Rigid {
        &self.bodies[body].rigid
    }

    fn advance(&mut self, integrator: ThesisIntegrator, gravity_px: Vec2, h: f32) {
        for body in &mut self.bodies {
            body.force += gravity_px * body.rigid.mass;
            if body.rigid.is_static() {
                continue;
            }
            body.rigid.advance(integrator, body.force, h);
            body.force = Vec2::ZERO;
            body.rebuild();
        }
    }

    #[inline(always)]
    fn both_circles(&self, i: usize, j: usize) -> bool {
        let (a, b) = (self.bodies[i].kind(), self.bodies[j].kind());
        a == Kind::Circle && b == Kind::Circle
    }

    #[inline(always)]
    fn bounds_meet(&self, i: usize, j: usize) -> bool {
        let (a, b) = (&self.bodies[i], &self.bodies[j]);
        bounds_meet(a.rigid.position_px, a.shape.radius_px, b.rigid.position_px, b.shape.radius_px)
    }

    fn collide(&mut self, i: usize, j: usize) -> bool {
        let (head, tail) = self.bodies.split_at_mut(j);
        let (a, b) = (&mut *head[i], &mut *tail[0]);
        let (first, second, contact) = match (a.kind(), b.kind()) {
            (Kind::Circle, Kind::Circle) => {
                let contact = circle_circle(
                    a.rigid.position_px,
                    a.shape.radius_px,
                    b.rigid.position_px,
                    b.shape.radius_px,
                );
                (a, b, Some(contact))
            }
            (Kind::Circle, _) => {
                let contact = touch_circle(b, a);
                (b, a, contact)
            }
            (_, Kind::Circle) => {
                let contact = touch_circle(a, b);
                (a, b, contact)
            }
            _ => {
                let contact = a.hull().zip(b.hull()).and_then(|(a, b)| hull_hull(a, b));
                (a, b, contact)
            }
        };
        let resolved = contact.is_some_and(|contact| resolve(&mut first.rigid, &mut second.rigid, &contact));
        if resolved {
            first.rebuild();
            second.rebuild();
        }
        resolved
    }
}
