//! Joints as they are written down. Metres, kilograms, seconds, radians.

use serde::{Deserialize, Deserializer, Serialize};

use crate::pair;

/// A joint of a scene: which bodies, and how they are held together.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct JointSpec {
    /// The bodies A and B, by their numbers in the scene, from 0.
    #[serde(deserialize_with = "two")]
    pub bodies: [usize; 2],
    /// How.
    pub kind: JointKind,
    /// Do the two bodies collide with each other?
    #[serde(default)]
    pub collide: bool,
}

/// What a joint holds. Anchors are points of the world when the joint is made; from then on they go with their
/// bodies. Angles are B's attitude seen from A, counter-clockwise, 0 when the joint is made.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum JointKind {
    /// The distance of two points.
    Distance(Distance),
    /// A point of both bodies: a hinge.
    Revolute(Revolute),
    /// A point of both bodies, and the angle between them.
    Weld(Weld),
}

/// Holds the distance of two points: at a length, by a spring about it, or within bounds.
///
/// Rigid where neither a spring nor a bound is given. Bounds without a spring leave it free between them.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Distance {
    /// Where it holds A, metres, world; A's centroid where left out.
    #[serde(default, skip_serializing_if = "Option::is_none", deserialize_with = "pair::optional")]
    pub anchor_a: Option<[f64; 2]>,
    /// Where it holds B, metres, world; B's centroid where left out.
    #[serde(default, skip_serializing_if = "Option::is_none", deserialize_with = "pair::optional")]
    pub anchor_b: Option<[f64; 2]>,
    /// Metres; what it is when the joint is made where left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub length: Option<f64>,
    /// A spring in place of the rod.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub spring: Option<JointSpring>,
    /// The least distance, inclusive, metres.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub min: Option<f64>,
    /// The greatest distance, inclusive, metres.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub max: Option<f64>,
}

/// Holds a point of A on a point of B.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Revolute {
    /// The point, metres, world.
    #[serde(deserialize_with = "pair::required")]
    pub anchor: [f64; 2],
    /// What turns B against A.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub motor: Option<Motor>,
    /// How far B may turn against A; whole turns count.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub limits: Option<Limits>,
}

/// Holds a point of A on a point of B, and the angle between the bodies.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Weld {
    /// The point, metres, world.
    #[serde(deserialize_with = "pair::required")]
    pub anchor: [f64; 2],
    /// A spring that holds the angle, in place of a rigid weld; the point stays rigid.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub spring: Option<JointSpring>,
}

/// A damped spring, by what the two bodies it joins do with nothing else about.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct JointSpring {
    /// Undamped oscillations per second.
    pub hertz: f64,
    /// Damping ratio: 1 is critical.
    #[serde(default)]
    pub damping: f64,
}

/// Turns B against A at a speed, as far as its torque goes.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Motor {
    /// rad/s, counter-clockwise.
    pub speed: f64,
    /// N·m.
    pub max_torque: f64,
}

/// Bounds of an angle, both inclusive.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Limits {
    /// rad.
    pub lower: f64,
    /// rad.
    pub upper: f64,
}

impl JointSpec {
    /// A joint of the `a`-th and the `b`-th body of a scene, which then do not collide with each other.
    pub fn new(a: usize, b: usize, kind: JointKind) -> Self {
        Self { bodies: [a, b], kind, collide: false }
    }
}

impl JointKind {
    /// A hinge at a point of the world, metres, that turns freely.
    pub fn hinge(anchor: [f64; 2]) -> Self {
        Self::Revolute(Revolute { anchor, motor: None, limits: None })
    }

    /// Where it holds A and B, metres, world; `None`: at the centroid.
    pub fn anchors(&self) -> [Option<[f64; 2]>; 2] {
        match self {
            Self::Distance(distance) => [distance.anchor_a, distance.anchor_b],
            Self::Revolute(Revolute { anchor, .. }) | Self::Weld(Weld { anchor, .. }) => [Some(*anchor); 2],
        }
    }

    /// A rod between the centroids, as long as they are apart.
    pub fn rod() -> Self {
        Self::Distance(Distance::default())
    }

    /// A rigid weld at a point of the world, metres.
    pub fn weld(anchor: [f64; 2]) -> Self {
        Self::Weld(Weld { anchor, spring: None })
    }
}

/// Exactly two numbers of bodies: see [`crate::pair`].
fn two<'de, D: Deserializer<'de>>(source: D) -> Result<[usize; 2], D::Error> {
    let numbers = Vec::<usize>::deserialize(source)?;
    <[usize; 2]>::try_from(numbers)
        .map_err(|n| serde::de::Error::custom(format!("expected the numbers of two bodies, got {}", n.len())))
}
