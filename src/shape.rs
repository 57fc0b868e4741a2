//! Circle, box and convex polygon: checked construction, mass properties, bounds.
//!
//! Shapes are built and measured in `f64`; a world rounds them once to its own precision.
//! A body owns a *range* of shapes in the layout (see [`crate::body`]); today the range has length 1,
//! and a concave outline, which would need several convex pieces, is refused with the vertex that dents.

use glam::DVec2;

/// The most vertices a convex polygon can have: one row of lanes.
pub const MAX_VERTICES: usize = 8;
/// Two vertices closer than this share of the outline's extent are the same one.
const DUPLICATE_TOLERANCE: f64 = 1e-6;
/// |sin| of the turn at a vertex below which its two edges are one line.
const COLLINEAR_TOLERANCE: f64 = 1e-6;

/// Why a shape was refused. Vertices are numbered from 0 in the order they were given.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ShapeError {
    /// A circle's radius must be positive and finite.
    #[error("radius must be positive and finite, got {0:?}")]
    Radius(f64),
    /// A box's half-extents must be positive and finite.
    #[error("half-extent {axis} must be positive and finite, got {value:?}")]
    HalfExtent {
        /// `x` or `y`.
        axis: char,
        /// What was given.
        value: f64,
    },
    /// A polygon needs three vertices.
    #[error("a polygon needs at least 3 vertices, got {0}")]
    TooFewVertices(usize),
    /// A polygon holds at most [`MAX_VERTICES`] vertices.
    #[error("a polygon has at most {MAX_VERTICES} vertices, got {0}: split it or drop vertices")]
    TooManyVertices(usize),
    /// A coordinate, or its square, is NaN or infinite.
    #[error("vertex {vertex} is not finite or too far out: ({x:?}, {y:?})")]
    NonFinite {
        /// Its number.
        vertex: usize,
        /// What was given.
        x: f64,
        /// What was given.
        y: f64,
    },
    /// Two vertices coincide (closer than 1e-6 of the outline's extent).
    #[error("vertex {second} repeats vertex {first}: remove one of them")]
    Duplicate {
        /// The earlier one.
        first: usize,
        /// The later one.
        second: usize,
    },
    /// Two edges cross each other.
    #[error("the outline crosses itself: the edge from vertex {first} meets the edge from vertex {second}")]
    SelfCrossing {
        /// Start of one edge.
        first: usize,
        /// Start of the other.
        second: usize,
    },
    /// All vertices lie on one line.
    #[error("the outline encloses no area: its vertices lie on one line (vertex {0} does not leave it)")]
    ZeroArea(usize),
    /// A vertex lies on the line through its neighbours.
    #[error("vertex {0} lies on the line through its neighbours: remove it")]
    Collinear(usize),
    /// The outline turns inwards at a vertex.
    #[error("the outline is concave at vertex {0}: split it there into convex polygons")]
    Concave(usize),
}

/// Area, centroid and second moment of a shape of unit density.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MassProperties {
    /// Square metres.
    pub area: f64,
    /// Centroid in the coordinates the outline was given in, metres.
    pub centroid: DVec2,
    /// ∫|r|² dA about the centroid, m⁴; times density it is the moment of inertia.
    pub second_moment: f64,
}

/// A convex polygon: 3 to 8 vertices, counter-clockwise, centroid at the origin.
#[derive(Clone, Debug, PartialEq)]
pub struct Polygon {
    vertices: Vec<DVec2>,
    centroid_given: DVec2,
}

impl Polygon {
    /// Checks the outline and recentres it on its centroid; clockwise outlines are reversed.
    ///
    /// The body's position is then the position of the centroid: add [`Polygon::centroid_given`],
    /// turned by the body's angle, to place the outline where it was drawn.
    ///
    /// # Errors
    /// Fewer than 3 or more than 8 vertices, or a vertex that is not finite, repeats another, lies on the
    /// line of its neighbours or dents the outline; an outline that crosses itself or encloses no area.
    pub fn new(outline: &[DVec2]) -> Result<Self, ShapeError> {
        check_vertices(outline)?;
        check_crossings(outline)?;
        let clockwise = signed_area(outline) < 0.0;
        check_corners(outline, if clockwise { -1.0 } else { 1.0 })?;
        let mut vertices = outline.to_vec();
        if clockwise {
            vertices.reverse();
        }
        let properties = polygon_mass(&vertices);
        for v in &mut vertices {
            *v -= properties.centroid;
        }
        Ok(Self { vertices, centroid_given: properties.centroid })
    }

    /// The vertices, counter-clockwise about the centroid at the origin, metres.
    pub fn vertices(&self) -> &[DVec2] {
        &self.vertices
    }

    /// Where the centroid lay in the outline as given, metres.
    pub fn centroid_given(&self) -> DVec2 {
        self.centroid_given
    }

    /// The sum of the interior angles, rad; (n − 2)π for every simple outline.
    pub fn interior_angle_sum_rad(&self) -> f64 {
        let n = self.vertices.len();
        (0..n)
            .map(|k| {
                let v = self.vertices[k];
                let (before, after) = (self.vertices[(k + n - 1) % n] - v, self.vertices[(k + 1) % n] - v);
                after.angle_to(before).rem_euclid(std::f64::consts::TAU)
            })
            .sum()
    }
}

/// The form of a body.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// A disc of the given radius, metres.
    Circle {
        /// Metres, positive.
        radius: f64,
    },
    /// A rectangle of the given half-extents, metres.
    Box {
        /// Half width and half height, metres, positive.
        half: DVec2,
    },
    /// A convex polygon.
    Polygon(Polygon),
}

impl Shape {
    /// A disc.
    ///
    /// # Errors
    /// A radius that is not positive and finite.
    pub fn circle(radius: f64) -> Result<Self, ShapeError> {
        if radius > 0.0 && radius.is_finite() {
            Ok(Self::Circle { radius })
        } else {
            Err(ShapeError::Radius(radius))
        }
    }

    /// A rectangle by its half-extents.
    ///
    /// # Errors
    /// A half-extent that is not positive and finite.
    pub fn rectangle(half_x: f64, half_y: f64) -> Result<Self, ShapeError> {
        for (axis, value) in [('x', half_x), ('y', half_y)] {
            if !(value > 0.0 && value.is_finite()) {
                return Err(ShapeError::HalfExtent { axis, value });
            }
        }
        Ok(Self::Box { half: DVec2::new(half_x, half_y) })
    }

    /// A convex polygon from its outline; see [`Polygon::new`].
    ///
    /// # Errors
    /// Those of [`Polygon::new`].
    pub fn polygon(outline: &[DVec2]) -> Result<Self, ShapeError> {
        Polygon::new(outline).map(Self::Polygon)
    }

    /// Area, centroid (the origin but for polygons as given) and second moment.
    pub fn mass_properties(&self) -> MassProperties {
        match self {
            Self::Circle { radius } => {
                let area = std::f64::consts::PI * radius * radius;
                MassProperties { area, centroid: DVec2::ZERO, second_moment: 0.5 * area * radius * radius }
            }
            Self::Box { half } => {
                let area = 4.0 * half.x * half.y;
                let second_moment = area * half.length_squared() / 3.0;
                MassProperties { area, centroid: DVec2::ZERO, second_moment }
            }
            Self::Polygon(polygon) => {
                let about_centroid = polygon_mass(&polygon.vertices);
                MassProperties { centroid: polygon.centroid_given, ..about_centroid }
            }
        }
    }

    /// The radius of the smallest circle about the centroid that holds the shape, metres.
    pub fn bounding_radius(&self) -> f64 {
        match self {
            Self::Circle { radius } => *radius,
            Self::Box { half } => half.length(),
            Self::Polygon(polygon) => polygon.vertices.iter().map(|v| v.length()).fold(0.0, f64::max),
        }
    }

    /// The radius of the largest circle about the centroid that the shape holds, metres.
    pub fn inner_radius(&self) -> f64 {
        match self {
            Self::Circle { radius } => *radius,
            Self::Box { half } => half.x.min(half.y),
            Self::Polygon(Polygon { vertices, .. }) => {
                edge_normals(vertices).iter().zip(vertices).map(|(n, v)| n.dot(*v)).fold(f64::MAX, f64::min)
            }
        }
    }

    /// The outline of a box or polygon, counter-clockwise about the centroid; empty for a circle.
    pub fn outline(&self) -> Vec<DVec2> {
        match self {
            Self::Circle { .. } => Vec::new(),
            Self::Box { half } => [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
                .map(|(x, y)| DVec2::new(x, y) * *half)
                .to_vec(),
            Self::Polygon(polygon) => polygon.vertices.clone(),
        }
    }
}

/// Outward unit normals of a counter-clockwise outline, one per edge from vertex k to k + 1.
pub fn edge_normals(outline: &[DVec2]) -> Vec<DVec2> {
    let next = outline.iter().cycle().skip(1);
    outline.iter().zip(next).map(|(&a, &b)| -(b - a).perp().normalize()).collect()
}

fn signed_area(outline: &[DVec2]) -> f64 {
    let origin = outline[0];
    outline[1..].windows(2).map(|w| (w[0] - origin).perp_dot(w[1] - origin)).sum::<f64>() / 2.0
}

/// Sums triangles from the first vertex: differences, not coordinates, so that an outline far from the
/// origin loses nothing. Each triangle's moment follows from its three corner vectors
/// (Mirtich, Fast and Accurate Computation of Polyhedral Mass Properties, 1996, in the plane).
fn polygon_mass(vertices: &[DVec2]) -> MassProperties {
    let origin = vertices[0];
    let (mut area, mut first, mut second) = (0.0, DVec2::ZERO, 0.0);
    for pair in vertices[1..].windows(2) {
        let (a, b) = (pair[0] - origin, pair[1] - origin);
        let doubled = a.perp_dot(b);
        area += doubled / 2.0;
        first += (a + b) * (doubled / 6.0);
        second += doubled / 12.0 * (a.dot(a) + a.dot(b) + b.dot(b));
    }
    let centroid = first / area;
    MassProperties {
        area,
        centroid: origin + centroid,
        second_moment: second - area * centroid.length_squared(),
    }
}

fn check_vertices(outline: &[DVec2]) -> Result<(), ShapeError> {
    if outline.len() < 3 {
        return Err(ShapeError::TooFewVertices(outline.len()));
    }
    if outline.len() > MAX_VERTICES {
        return Err(ShapeError::TooManyVertices(outline.len()));
    }
    if let Some(vertex) = outline.iter().position(|v| !v.length_squared().is_finite()) {
        return Err(ShapeError::NonFinite { vertex, x: outline[vertex].x, y: outline[vertex].y });
    }
    let extent = outline.iter().map(|v| v.distance(outline[0])).fold(0.0, f64::max);
    for second in 1..outline.len() {
        for first in 0..second {
            if outline[first].distance(outline[second]) <= DUPLICATE_TOLERANCE * extent {
                return Err(ShapeError::Duplicate { first, second });
            }
        }
    }
    Ok(())
}

/// Two edges without a common vertex cross when each has the other's ends on both sides.
fn check_crossings(outline: &[DVec2]) -> Result<(), ShapeError> {
    let n = outline.len();
    let edge = |k: usize| (outline[k], outline[(k + 1) % n]);
    let splits = |(a, b): (DVec2, DVec2), (p, q): (DVec2, DVec2)| {
        (b - a).perp_dot(p - a) * (b - a).perp_dot(q - a) < 0.0
    };
    for first in 0..n {
        for second in first + 2..n {
            let adjacent = first == 0 && second == n - 1;
            if !adjacent && splits(edge(first), edge(second)) && splits(edge(second), edge(first)) {
                return Err(ShapeError::SelfCrossing { first, second });
            }
        }
    }
    Ok(())
}

/// With no crossing edges the outline is simple, so one turn the wrong way is a dent.
fn check_corners(outline: &[DVec2], winding: f64) -> Result<(), ShapeError> {
    let n = outline.len();
    let turn = |k: usize| {
        let (before, after) = (outline[k] - outline[(k + n - 1) % n], outline[(k + 1) % n] - outline[k]);
        before.perp_dot(after) / (before.length() * after.length()) * winding
    };
    if (0..n).all(|k| turn(k).abs() <= COLLINEAR_TOLERANCE) {
        return Err(ShapeError::ZeroArea(1));
    }
    if let Some(dent) = (0..n).find(|&k| turn(k) < -COLLINEAR_TOLERANCE) {
        return Err(ShapeError::Concave(dent));
    }
    match (0..n).find(|&k| turn(k) <= COLLINEAR_TOLERANCE) {
        Some(flat) => Err(ShapeError::Collinear(flat)),
        None => Ok(()),
    }
}
