//! What the oracle tests share: the engine's stages by width number, its contacts as bits, and a naive
//! `f64` picture of its bodies with separating axes over explicit vertices.

use glam::DVec2;
use lamina2d::body::{Bodies, Form};
use lamina2d::contact::Code;
use lamina2d::internals::{BroadPhase, Narrow};
use lamina2d::lanes::{ROW, Real, f32s, f64s};
use lamina2d::scene::BodySpec;
use lamina2d::settings::Broad;

/// A precision and the widths it runs at, chosen by number.
pub(crate) trait Everywhere: Real {
    /// Its widths.
    const WIDTHS: &'static [usize];
    /// [`BroadPhase::find`].
    fn find(broad: &mut BroadPhase<Self>, width: usize, bodies: &Bodies<Self>, method: Broad, margin: f64);
    /// [`Narrow::run`].
    fn collide(
        narrow: &mut Narrow<Self>,
        width: usize,
        bodies: &Bodies<Self>,
        pairs: &[[u32; 2]],
        margin: f64,
    );
}

macro_rules! everywhere {
    ($real:ty, $($width:literal => $lanes:ty),+) => {
        impl Everywhere for $real {
            const WIDTHS: &'static [usize] = &[$($width),+];
            fn find(broad: &mut BroadPhase<Self>, width: usize, bodies: &Bodies<Self>, method: Broad, margin: f64) {
                let margin = Self::from_f64(margin);
                match width {
                    $($width => broad.find::<$lanes>(&lamina2d::internals::Workers::ALONE, bodies, method, margin.into(), Self::ZERO, false),)+
                    _ => unreachable!("no width {width}"),
                };
            }
            fn collide(
                narrow: &mut Narrow<Self>,
                width: usize,
                bodies: &Bodies<Self>,
                pairs: &[[u32; 2]],
                margin: f64,
            ) {
                let margin = Self::from_f64(margin);
                match width {
                    $($width => narrow.run::<$lanes>(bodies, pairs, margin),)+
                    _ => unreachable!("no width {width}"),
                }
            }
        }
    };
}
everywhere!(f32, 1 => f32s::X1, 4 => f32s::X4, 8 => f32s::X8, 16 => f32s::X16);
everywhere!(f64, 1 => f64s::X1, 4 => f64s::X4);

/// Bodies from specifications, polygons ready for the narrow phase.
pub(crate) fn bodies_of<R: Real>(specs: &[BodySpec]) -> Bodies<R> {
    let mut bodies = Bodies::new();
    for spec in specs {
        bodies.insert(spec).expect("a good body");
    }
    bodies.refresh_polygons();
    bodies
}

/// A contact down to its bits.
pub(crate) type ContactBits = ([u32; 2], Code, [u64; ROW], [u64; 4]);

/// The contacts of some pairs, in their order, as bits.
pub(crate) fn contact_bits<R: Everywhere>(
    width: usize,
    bodies: &Bodies<R>,
    pairs: &[[u32; 2]],
    margin: f64,
) -> Vec<ContactBits> {
    let mut narrow = Narrow::default();
    R::collide(&mut narrow, width, bodies, pairs, margin);
    let found = &narrow.manifolds;
    let bits = |value: R| value.to_f64().to_bits();
    let contact = |&place: &u32| {
        let at = place as usize;
        (found.slots(at), found.code(at), found.geometry()[at].map(bits), found.gaps()[at].map(bits))
    };
    found.touching().iter().map(contact).collect()
}

/// A body as the engine holds it, exact in `f64`.
#[derive(Clone, Debug)]
pub(crate) struct Solid {
    pub(crate) centre: DVec2,
    /// Radius of a disc, 0 for outlines.
    pub(crate) radius: f64,
    /// Vertices about the centre, world axes, counter-clockwise; empty for discs.
    pub(crate) vertices: Vec<DVec2>,
}

impl Solid {
    /// The body in a slot.
    pub(crate) fn new<R: Real>(bodies: &Bodies<R>, slot: usize) -> Self {
        let disc = bodies.form(slot) == Form::Circle;
        Self {
            centre: DVec2::new(bodies.x[slot].to_f64(), bodies.y[slot].to_f64()),
            radius: if disc { bodies.extent_x[slot].to_f64() } else { 0.0 },
            vertices: bodies.outline(slot).into_iter().map(DVec2::from).collect(),
        }
    }

    /// The largest distance of a point from the centre.
    pub(crate) fn reach(&self) -> f64 {
        self.vertices.iter().map(|v| v.length()).fold(self.radius, f64::max)
    }

    /// The smallest width over its faces: how thin it is.
    pub(crate) fn thinness(&self) -> f64 {
        let width = |(n, p): (DVec2, DVec2)| self.vertices.iter().map(|v| n.dot(p - *v)).fold(0.0, f64::max);
        self.faces()
            .map(width)
            .fold(if self.vertices.is_empty() { self.radius * 2.0 } else { f64::MAX }, f64::min)
    }

    /// Outward unit normal and first vertex of each edge.
    pub(crate) fn faces(&self) -> impl Iterator<Item = (DVec2, DVec2)> + '_ {
        self.edges().map(|(p, q)| (-(q - p).perp().normalize(), p))
    }

    /// Edges from vertex to vertex.
    pub(crate) fn edges(&self) -> impl Iterator<Item = (DVec2, DVec2)> + '_ {
        let next = self.vertices.iter().cycle().skip(1);
        self.vertices.iter().zip(next).map(|(&p, &q)| (p, q))
    }

    /// Signed distance of a point (about the centre) from the boundary, negative inside.
    pub(crate) fn distance_to(&self, point: DVec2) -> f64 {
        if self.vertices.is_empty() {
            return point.length() - self.radius;
        }
        let deepest = self.faces().map(|(n, p)| n.dot(point - p)).fold(f64::MIN, f64::max);
        if deepest <= 0.0 {
            deepest
        } else {
            self.edges().map(|e| to_segment(point, e)).fold(f64::MAX, f64::min)
        }
    }
}

fn to_segment(point: DVec2, (p, q): (DVec2, DVec2)) -> f64 {
    let along = ((point - p).dot(q - p) / (q - p).length_squared()).clamp(0.0, 1.0);
    point.distance(p.lerp(q, along))
}

/// Depth of the overlap as a negative number; where there is none, a positive lower bound of the distance.
pub(crate) fn separation(a: &Solid, b: &Solid) -> f64 {
    let d = b.centre - a.centre;
    match (a.vertices.is_empty(), b.vertices.is_empty()) {
        (true, true) => d.length() - a.radius - b.radius,
        (true, false) => b.distance_to(-d) - a.radius,
        (false, true) => a.distance_to(d) - b.radius,
        (false, false) => parting(a, b, d).max(parting(b, a, -d)),
    }
}

/// How far the faces of `a` part it from `b`, which lies at `d`.
fn parting(a: &Solid, b: &Solid, d: DVec2) -> f64 {
    let least = |n: DVec2, p: DVec2| b.vertices.iter().map(|v| n.dot(*v + d - p)).fold(f64::MAX, f64::min);
    a.faces().map(|(n, p)| least(n, p)).fold(f64::MIN, f64::max)
}
