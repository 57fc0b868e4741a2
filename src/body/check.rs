//! What a body is refused for: each field checked where it enters, named with its value.

use glam::DVec2;

use super::{BodyKind, BodySpec};
use crate::lanes::Real;
use crate::shape::{Shape, ShapeError};

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
    /// Bodies that attract each other fill one block at most.
    #[error("body {body}: force attraction: at most {most} bodies attract each other")]
    Attracted {
        /// Its number.
        body: usize,
        /// How many may.
        most: usize,
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
    /// Only a kinematic body goes where a pivot takes it.
    #[error("body {body}: only a kinematic body goes round a pivot, this one is {kind}; make it kinematic")]
    PivotNotKinematic {
        /// Its number.
        body: usize,
        /// What it is.
        kind: &'static str,
    },
    /// The pivot and the angular velocity say how the body moves.
    #[error(
        "body {body}: its pivot and angular_velocity give its velocity; leave out velocity, got {value:?}"
    )]
    PivotAndVelocity {
        /// Its number.
        body: usize,
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
    /// A static body has no velocity.
    #[error("body in slot {0} is static: it takes no velocity; make it kinematic")]
    StaticInSlot(u32),
    /// A pivot takes the body along.
    #[error(
        "body in slot {0} goes round a pivot, which says where it is and how fast; change its kind first"
    )]
    Driven(u32),
}

pub(super) struct InverseMass {
    pub(super) inv_mass: f64,
    pub(super) inv_inertia: f64,
}

/// Checks the fields of the `body`-th specification.
pub(super) struct Checker {
    pub(super) body: usize,
}

impl Checker {
    pub(super) fn check<R: Real>(&self, spec: &BodySpec, shape: &Shape) -> Result<InverseMass, BodyError> {
        let body = self.body;
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
            self.finite::<R>(field, value)?;
        }
        for value in spec.position {
            self.near::<R>("position", value)?;
        }
        let radius = shape.bounding_radius();
        let small = radius < R::FAR.to_f64() * 1e-3;
        within("shape size", radius, "less than 1e15 (f32) or 1e97 (f64) metres", small)?;
        within("friction", spec.friction, "at least 0", spec.friction >= 0.0)?;
        within("restitution", spec.restitution, "0 to 1", (0.0..=1.0).contains(&spec.restitution))?;
        if spec.kind == BodyKind::Static {
            let moving = [("velocity", spec.velocity[0]), ("velocity", spec.velocity[1])];
            let spin = [("angular_velocity", spec.angular_velocity)];
            if let Some(&(field, value)) = moving.iter().chain(&spin).find(|(_, value)| *value != 0.0) {
                return Err(BodyError::StaticMoves { body, field, value });
            }
        }
        if let Some(pivot) = spec.pivot {
            self.pivot::<R>(spec, shape, pivot)?;
        }
        self.inverse_mass::<R>(spec, shape)
    }

    fn pivot<R: Real>(&self, spec: &BodySpec, shape: &Shape, pivot: [f64; 2]) -> Result<(), BodyError> {
        let body = self.body;
        let kind = match spec.kind {
            BodyKind::Kinematic => None,
            BodyKind::Static => Some("static"),
            BodyKind::Dynamic => Some("dynamic"),
        };
        if let Some(kind) = kind {
            return Err(BodyError::PivotNotKinematic { body, kind });
        }
        for value in pivot {
            self.finite::<R>("pivot", value)?;
            self.near::<R>("pivot", value)?;
        }
        if let Some(&value) = spec.velocity.iter().find(|v| **v != 0.0) {
            return Err(BodyError::PivotAndVelocity { body, value });
        }
        let arm = DVec2::from(spec.position).distance(pivot.into());
        let reach = arm + shape.mass_properties().centroid.length();
        self.finite::<R>("velocity round the pivot", reach * spec.angular_velocity)
    }

    pub(super) fn finite<R: Real>(&self, field: &'static str, value: f64) -> Result<(), BodyError> {
        if R::from_f64(value).is_finite() {
            Ok(())
        } else {
            Err(BodyError::NonFinite { body: self.body, field, value })
        }
    }

    /// Further out a squared distance would overflow, or meet the padding.
    pub(super) fn near<R: Real>(&self, field: &'static str, value: f64) -> Result<(), BodyError> {
        if value.abs() < R::FAR.to_f64() * 1e-3 {
            return Ok(());
        }
        let range = "less than 1e15 (f32) or 1e97 (f64) from the origin";
        Err(BodyError::OutOfRange { body: self.body, field, range, value })
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
