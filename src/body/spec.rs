//! Bodies as they are written down, before they are checked: what scenes are made of.

use glam::DVec2;
use serde::{Deserialize, Serialize};

use crate::pair::{self, Pair};
use crate::shape::{Shape, ShapeError};

/// What forces and contacts may do to a body.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum BodyKind {
    /// Never moves.
    Static,
    /// Moves with the velocity it is given; nothing changes it.
    Kinematic,
    /// Moves by forces and contacts.
    #[default]
    Dynamic,
}

/// A shape as it is written down; checked when it becomes a [`Shape`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", try_from = "ShapeKeys")]
pub enum ShapeSpec {
    /// Radius, metres.
    Circle(f64),
    /// Half-extents, metres.
    Box([f64; 2]),
    /// Outline, metres, about the body's position; clockwise outlines are reversed.
    Polygon(Vec<[f64; 2]>),
}

/// A shape as a file may have it, before it is known to be exactly one.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct ShapeKeys {
    circle: Option<f64>,
    r#box: Option<Pair>,
    polygon: Option<Vec<Pair>>,
}

impl TryFrom<ShapeKeys> for ShapeSpec {
    type Error = &'static str;
    fn try_from(keys: ShapeKeys) -> Result<Self, Self::Error> {
        match (keys.circle, keys.r#box, keys.polygon) {
            (Some(radius), None, None) => Ok(Self::Circle(radius)),
            (None, Some(half), None) => Ok(Self::Box(half.0)),
            (None, None, Some(outline)) => Ok(Self::Polygon(outline.into_iter().map(|v| v.0).collect())),
            (None, None, None) => Err("a shape needs one of circle, box or polygon"),
            _ => Err("a shape is only one of circle, box or polygon"),
        }
    }
}

impl ShapeSpec {
    /// Checks it.
    ///
    /// # Errors
    /// Those of [`Shape::circle`], [`Shape::rectangle`] and [`Shape::polygon`].
    pub fn build(&self) -> Result<Shape, ShapeError> {
        match self {
            Self::Circle(radius) => Shape::circle(*radius),
            Self::Box([x, y]) => Shape::rectangle(*x, *y),
            Self::Polygon(outline) => {
                let outline: Vec<_> = outline.iter().map(|&v| DVec2::from(v)).collect();
                Shape::polygon(&outline)
            }
        }
    }
}

fn half() -> f64 {
    0.5
}
fn all_bits() -> u32 {
    u32::MAX
}
fn first_bit() -> u32 {
    1
}

/// A body as it is written down. Metres, kilograms, seconds, radians; y up.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BodySpec {
    /// Its form.
    pub shape: ShapeSpec,
    /// Static, kinematic or dynamic.
    #[serde(default)]
    pub kind: BodyKind,
    /// Where the shape's origin lies (for a polygon the origin of its outline, not its centroid).
    #[serde(deserialize_with = "pair::required")]
    pub position: [f64; 2],
    /// Attitude, rad, counter-clockwise.
    #[serde(default)]
    pub angle: f64,
    /// Velocity of the centroid, m/s.
    #[serde(default, deserialize_with = "pair::required")]
    pub velocity: [f64; 2],
    /// rad/s, counter-clockwise.
    #[serde(default)]
    pub angular_velocity: f64,
    /// Metres: round this point a kinematic body goes with its angular velocity, its attitude turning along;
    /// its velocity follows from that and is left out.
    #[serde(default, skip_serializing_if = "Option::is_none", deserialize_with = "pair::optional")]
    pub pivot: Option<[f64; 2]>,
    /// Kilograms; excludes `density`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mass: Option<f64>,
    /// kg/m²; 1 where neither it nor `mass` is given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub density: Option<f64>,
    /// Coulomb coefficient; a pair has the smaller of its two.
    #[serde(default = "half")]
    pub friction: f64,
    /// Coefficient of restitution, 0 to 1; a pair has the smaller of its two.
    #[serde(default)]
    pub restitution: f64,
    /// The categories it is in, one bit each.
    #[serde(default = "first_bit")]
    pub category: u32,
    /// The categories it collides with.
    #[serde(default = "all_bits")]
    pub collides_with: u32,
    /// Constant force at the centroid, N.
    #[serde(default, deserialize_with = "pair::required")]
    pub force: [f64; 2],
    /// Constant torque, N·m.
    #[serde(default)]
    pub torque: f64,
}

impl BodySpec {
    /// A dynamic body at rest with the defaults of a scene file.
    pub fn new(shape: ShapeSpec, position: [f64; 2]) -> Self {
        Self {
            shape,
            kind: BodyKind::Dynamic,
            position,
            angle: 0.0,
            velocity: [0.0; 2],
            angular_velocity: 0.0,
            pivot: None,
            mass: None,
            density: None,
            friction: half(),
            restitution: 0.0,
            category: first_bit(),
            collides_with: all_bits(),
            force: [0.0; 2],
            torque: 0.0,
        }
    }

    /// The same body, immovable.
    #[must_use]
    pub fn fixed(self) -> Self {
        Self { kind: BodyKind::Static, ..self }
    }

    /// The same body, kinematic, going round `pivot` (metres) with its angular velocity.
    #[must_use]
    pub fn about(self, pivot: [f64; 2]) -> Self {
        Self { kind: BodyKind::Kinematic, pivot: Some(pivot), ..self }
    }

    /// The same body with restitution and friction.
    #[must_use]
    pub fn surface(self, restitution: f64, friction: f64) -> Self {
        Self { friction, restitution, ..self }
    }

    /// The same body with a mass, kg.
    #[must_use]
    pub fn mass(self, mass: f64) -> Self {
        Self { mass: Some(mass), ..self }
    }

    /// The same body turned by `angle` rad.
    #[must_use]
    pub fn turned(self, angle: f64) -> Self {
        Self { angle, ..self }
    }

    /// The same body moving.
    #[must_use]
    pub fn moving(self, velocity: [f64; 2], angular_velocity: f64) -> Self {
        Self { velocity, angular_velocity, ..self }
    }
}
