//! From a [`Scene`] in metres, y up, to the thesis's bodies in pixels, y down; and what it cannot take.

use glam::{DVec2, Vec2, Vec3};

use lamina2d::force::{ForceError, Forces};
use lamina2d::scene::mixes::PX_PER_M;
use lamina2d::scene::{BodyKind, BodySpec, Scene, ShapeSpec};
use lamina2d::shape::ShapeError;

use super::rigid::Rigid;

/// Why the baseline cannot run a scene. Bodies are numbered from 0 in the scene's order.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ThesisError {
    /// The thesis has static and dynamic bodies only.
    #[error("body {body}: the thesis baseline has no kinematic bodies: make it static or dynamic")]
    Kinematic {
        /// Its number.
        body: usize,
    },
    /// Gravity is the only field.
    #[error("force {field}: the thesis baseline knows gravity only: remove it")]
    Field {
        /// The field.
        field: &'static str,
    },
    /// A field's coefficients are bad.
    #[error(transparent)]
    Force(#[from] ForceError),
    /// Neither constant loads nor collision filters.
    #[error("body {body}: the thesis baseline has no {feature}: leave the field out")]
    Feature {
        /// Its number.
        body: usize,
        /// The field.
        feature: &'static str,
    },
    /// No joints.
    #[error("the thesis baseline has no joints, the scene has {joints}: remove them")]
    Joints {
        /// How many there are.
        joints: usize,
    },
    /// Nothing is done to it on its way.
    #[error("the thesis baseline knows no events, the scene has {events}: remove them")]
    Events {
        /// How many there are.
        events: usize,
    },
    /// A shape is bad.
    #[error("body {body}: shape: {why}")]
    Shape {
        /// Its number.
        body: usize,
        /// What is wrong with it.
        why: ShapeError,
    },
    /// A number is outside the range its field has.
    #[error("body {body}: {field} must be {range}, got {value}")]
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
    #[error("body {body}: give mass or density, not both")]
    MassAndDensity {
        /// Its number.
        body: usize,
    },
}

/// The thesis's three shapes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Circle,
    Box,
    Polygon,
}

/// What both layouts are built from.
#[derive(Clone, Debug)]
pub(super) struct Blueprint {
    pub(super) rigid: Rigid,
    pub(super) kind: Kind,
    /// Of the bounding circle about the body's position; of a box the length of its half-extents.
    pub(super) radius_px: f32,
    /// Corners about the body's position; empty for a circle. The angle grows from corner to corner in a
    /// polygon and falls in a box: the original's two windings.
    pub(super) local_px: Vec<Vec2>,
}

/// Metres, y up, to pixels, y down. Its own inverse but for the scale.
pub(super) fn px_from_m([x, y]: [f64; 2]) -> Vec2 {
    DVec2::new(x * PX_PER_M, -y * PX_PER_M).as_vec2()
}

/// Pixels, y down, to metres, y up.
pub(super) fn m_from_px(v: Vec2) -> [f64; 2] {
    [f64::from(v.x) / PX_PER_M, -f64::from(v.y) / PX_PER_M]
}

/// Gravity in px/s², after every other field has been refused.
pub(super) fn gravity_px(forces: &Forces) -> Result<Vec2, ThesisError> {
    forces.check()?;
    match forces.beyond_gravity().next() {
        Some(field) => Err(ThesisError::Field { field }),
        None => Ok(forces.gravity.map_or(Vec2::ZERO, px_from_m)),
    }
}

/// All bodies of a scene, in its order.
pub(super) fn blueprints(scene: &Scene) -> Result<Vec<Blueprint>, ThesisError> {
    if !scene.joints.is_empty() {
        return Err(ThesisError::Joints { joints: scene.joints.len() });
    }
    if !scene.events.is_empty() {
        return Err(ThesisError::Events { events: scene.events.len() });
    }
    scene.bodies.iter().enumerate().map(|(body, spec)| blueprint(body, spec)).collect()
}

fn blueprint(body: usize, spec: &BodySpec) -> Result<Blueprint, ThesisError> {
    check(body, spec)?;
    let shape = spec.shape.build().map_err(|why| ThesisError::Shape { body, why })?;
    let mass = if spec.kind == BodyKind::Static {
        0.0
    } else {
        // `check` has refused mass and density together.
        let density = spec.density.unwrap_or(1.0);
        let mass = spec.mass.unwrap_or_else(|| density * shape.mass_properties().area);
        in_range(body, "mass", "positive and finite", mass, mass > 0.0)?;
        mass as f32
    };
    let (kind, radius_px, local_px) = form(&spec.shape);
    let inertia = inertia(kind, radius_px, &local_px, mass);
    let inverse = |x: f32| if x > 0.0 { 1.0 / x } else { 0.0 };
    let rigid = Rigid {
        position_px: px_from_m(spec.position),
        rotation: -spec.angle as f32,
        velocity_px: px_from_m(spec.velocity),
        spin: -spec.angular_velocity as f32,
        acceleration: Vec3::ZERO,
        mass,
        inverse_mass: inverse(mass),
        inverse_inertia: inverse(inertia),
        elasticity: spec.restitution as f32,
        friction: spec.friction as f32,
    };
    Ok(Blueprint { rigid, kind, radius_px, local_px })
}

fn in_range(
    body: usize,
    field: &'static str,
    range: &'static str,
    value: f64,
    inside: bool,
) -> Result<(), ThesisError> {
    if inside && value.is_finite() {
        Ok(())
    } else {
        Err(ThesisError::OutOfRange { body, field, range, value })
    }
}

fn check(body: usize, spec: &BodySpec) -> Result<(), ThesisError> {
    if spec.kind == BodyKind::Kinematic {
        return Err(ThesisError::Kinematic { body });
    }
    let missing = [
        ("constant force", spec.force != [0.0; 2]),
        ("constant torque", spec.torque != 0.0),
        ("collision categories", spec.category != 1 || spec.collides_with != u32::MAX),
        (
            "moving static bodies",
            spec.kind == BodyKind::Static && (spec.velocity != [0.0; 2] || spec.angular_velocity != 0.0),
        ),
    ];
    if let Some((feature, _)) = missing.into_iter().find(|&(_, given)| given) {
        return Err(ThesisError::Feature { body, feature });
    }
    if spec.mass.is_some() && spec.density.is_some() {
        return Err(ThesisError::MassAndDensity { body });
    }
    let [x, y] = spec.position;
    let [vx, vy] = spec.velocity;
    for (field, value) in [
        ("position x", x),
        ("position y", y),
        ("velocity x", vx),
        ("velocity y", vy),
        ("angle", spec.angle),
        ("angular velocity", spec.angular_velocity),
    ] {
        in_range(body, field, "finite", value, true)?;
    }
    let restitution = spec.restitution;
    in_range(body, "restitution", "0 to 1", restitution, (0.0..=1.0).contains(&restitution))?;
    in_range(body, "friction", "0 or more and finite", spec.friction, spec.friction >= 0.0)
}

/// Kind, bounding radius and corners of a shape that has been checked.
fn form(shape: &ShapeSpec) -> (Kind, f32, Vec<Vec2>) {
    match shape {
        ShapeSpec::Circle(radius) => (Kind::Circle, (radius * PX_PER_M) as f32, Vec::new()),
        ShapeSpec::Box(half) => {
            let half = px_from_m(*half).abs();
            let corners = [(-1.0, 1.0), (1.0, 1.0), (1.0, -1.0), (-1.0, -1.0)];
            (Kind::Box, half.length(), corners.map(|c| half * Vec2::from(c)).to_vec())
        }
        ShapeSpec::Polygon(outline) => {
            let mut corners: Vec<Vec2> = outline.iter().copied().map(px_from_m).collect();
            if signed_area(&corners) < 0.0 {
                // The first corner stays first: the order decides which edge a circle meets.
                corners[1..].reverse();
            }
            let radius = corners.iter().map(|v| v.length()).fold(0.0, f32::max);
            (Kind::Polygon, radius, corners)
        }
    }
}

/// Positive where the angle grows from corner to corner.
pub(super) fn signed_area(corners: &[Vec2]) -> f32 {
    let next = corners.iter().cycle().skip(1);
    corners.iter().zip(next).map(|(a, b)| a.perp_dot(*b)).sum::<f32>() / 2.0
}

/// The original's moments of inertia about the body's position, kg px².
///
/// A box of half-extents (x, y) has m(x² + y²)/3; it gets a quarter, the formula for full extents. A polygon
/// gets ∫r² dA / ∫dA, the radius of gyration squared: right for 1 kg if its position were its centroid.
/// By the same slip a static polygon is not immovable in the denominator of an impulse.
fn inertia(kind: Kind, radius_px: f32, local_px: &[Vec2], mass: f32) -> f32 {
    match kind {
        Kind::Circle => 0.5 * mass * radius_px * radius_px,
        Kind::Box => mass * radius_px * radius_px / 12.0,
        Kind::Polygon => {
            let next = local_px.iter().cycle().skip(1);
            let (moment, area) = local_px.iter().zip(next).fold((0.0, 0.0), |(moment, area), (a, b)| {
                let doubled = a.perp_dot(*b).abs();
                (moment + doubled * (a.dot(*a) + a.dot(*b) + b.dot(*b)), area + doubled)
            });
            moment / (6.0 * area)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn outlines_of_either_winding_come_out_alike() {
        let counter_clockwise = vec![[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]];
        let mut clockwise = counter_clockwise.clone();
        clockwise[1..].reverse();
        let [a, b] = [counter_clockwise, clockwise].map(|outline| form(&ShapeSpec::Polygon(outline)));
        assert_eq!(a.2, b.2);
        assert!(signed_area(&a.2) > 0.0);
        assert!(signed_area(&form(&ShapeSpec::Box([2.0, 1.0])).2) < 0.0);
    }

    #[test]
    fn box_inertia_is_a_quarter_and_polygon_inertia_ignores_the_mass() {
        let blueprint = |shape: ShapeSpec, mass: f64| {
            blueprint(0, &BodySpec::new(shape, [0.0; 2]).mass(mass)).unwrap().rigid
        };
        let boxed = blueprint(ShapeSpec::Box([2.0, 1.0]), 3.0);
        let right = 3.0 * (50.0_f32.powi(2) + 25.0_f32.powi(2)) / 3.0;
        assert!((1.0 / boxed.inverse_inertia - right / 4.0).abs() < 1e-2);
        let outline = vec![[-2.0, -1.0], [2.0, -1.0], [2.0, 1.0], [-2.0, 1.0]];
        let light = blueprint(ShapeSpec::Polygon(outline.clone()), 1.0);
        let heavy = blueprint(ShapeSpec::Polygon(outline), 100.0);
        assert_eq!(light.inverse_inertia, heavy.inverse_inertia);
        assert!((1.0 / light.inverse_inertia - right / 3.0).abs() < 1e-2);
    }
}
