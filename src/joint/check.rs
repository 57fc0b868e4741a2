//! What a joint is refused for: each field checked where it enters, named with its value.

use crate::body::BodyError;
use crate::lanes::Real;

use super::spec::{Distance, JointKind, JointSpring, Motor, Revolute};

/// Why a joint was refused: which one (in order of insertion), which field, which value.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum JointError {
    /// A scene has no body of this number.
    #[error("joint {joint}: bodies: there is no body {body}, the scene has {bodies}, numbered from 0")]
    MissingBody {
        /// Its number in order of insertion, from 0.
        joint: usize,
        /// The body asked for.
        body: usize,
        /// How many there are.
        bodies: usize,
    },
    /// A body is gone.
    #[error("joint {joint}: {why}")]
    Body {
        /// Its number.
        joint: usize,
        /// Which.
        why: BodyError,
    },
    /// Both ends are the same body.
    #[error("joint {joint}: bodies: joins the body in slot {slot} to itself; name two bodies")]
    Itself {
        /// Its number.
        joint: usize,
        /// The body's slot.
        slot: usize,
    },
    /// Nothing there that a joint could move.
    #[error("joint {joint}: bodies: one of the two must be dynamic, these are {a} and {b}")]
    NoneDynamic {
        /// Its number.
        joint: usize,
        /// What A is.
        a: &'static str,
        /// What B is.
        b: &'static str,
    },
    /// NaN, infinite, or too large for the world's precision.
    #[error("joint {joint}: {field} is not finite in this precision: {value:?}")]
    NonFinite {
        /// Its number.
        joint: usize,
        /// The field.
        field: &'static str,
        /// What was given.
        value: f64,
    },
    /// Outside the range the field has.
    #[error("joint {joint}: {field} must be {range}, got {value:?}")]
    OutOfRange {
        /// Its number.
        joint: usize,
        /// The field.
        field: &'static str,
        /// What is allowed.
        range: &'static str,
        /// What was given.
        value: f64,
    },
    /// A lower bound above its upper one.
    #[error("joint {joint}: {low} must not be above {high}, got {below:?} and {above:?}")]
    Crossed {
        /// Its number.
        joint: usize,
        /// The lower bound's field.
        low: &'static str,
        /// The upper bound's field.
        high: &'static str,
        /// The lower bound given.
        below: f64,
        /// The upper bound given.
        above: f64,
    },
    /// Only a hinge has a motor.
    #[error("joint {joint}: it is no hinge and has no motor")]
    NoHinge {
        /// Its place.
        joint: usize,
    },
    /// No joint is in this place.
    #[error("there is no joint {joint}")]
    NoJoint {
        /// The place.
        joint: usize,
    },
    /// No joint has this id.
    #[error("no joint has the id of place {place}, generation {generation}")]
    Stale {
        /// The id's place.
        place: u32,
        /// The id's generation.
        generation: u32,
    },
}

/// Checks the fields of the `joint`-th specification.
pub(super) struct Checker {
    pub(super) joint: usize,
}

impl Checker {
    /// Everything but what takes two bodies to know.
    pub(super) fn check<R: Real>(&self, kind: &JointKind) -> Result<(), JointError> {
        match kind {
            JointKind::Distance(distance) => self.distance::<R>(distance),
            JointKind::Revolute(revolute) => self.revolute::<R>(revolute),
            JointKind::Weld(weld) => {
                self.point::<R>("anchor", weld.anchor)?;
                self.spring(weld.spring)
            }
        }
    }

    fn distance<R: Real>(&self, distance: &Distance) -> Result<(), JointError> {
        for (field, anchor) in [("anchor_a", distance.anchor_a), ("anchor_b", distance.anchor_b)] {
            if let Some(anchor) = anchor {
                self.point::<R>(field, anchor)?;
            }
        }
        let lengths = [("length", distance.length), ("min", distance.min), ("max", distance.max)];
        for (field, value) in lengths {
            if let Some(value) = value {
                self.finite::<R>(field, value)?;
            }
        }
        if let Some(length) = distance.length {
            self.length(length)?;
        }
        if let Some(min) = distance.min {
            self.within("min", "at least 0", min, min >= 0.0)?;
        }
        if let Some(max) = distance.max {
            self.within("max", "positive", max, max > 0.0)?;
        }
        if let (Some(below), Some(above)) = (distance.min, distance.max) {
            self.ordered("min", "max", below, above)?;
        }
        self.spring(distance.spring)
    }

    fn revolute<R: Real>(&self, revolute: &Revolute) -> Result<(), JointError> {
        self.point::<R>("anchor", revolute.anchor)?;
        if let Some(motor) = revolute.motor {
            self.motor::<R>(motor)?;
        }
        if let Some(limits) = revolute.limits {
            self.finite::<R>("limits lower", limits.lower)?;
            self.finite::<R>("limits upper", limits.upper)?;
            self.ordered("limits lower", "limits upper", limits.lower, limits.upper)?;
        }
        Ok(())
    }

    pub(super) fn motor<R: Real>(&self, motor: Motor) -> Result<(), JointError> {
        self.finite::<R>("motor speed", motor.speed)?;
        self.finite::<R>("motor max_torque", motor.max_torque)?;
        self.within("motor max_torque", "at least 0", motor.max_torque, motor.max_torque >= 0.0)
    }

    /// A rod's length, given or found.
    pub(super) fn length(&self, value: f64) -> Result<(), JointError> {
        self.within("length", "positive", value, value > 0.0)
    }

    fn spring(&self, spring: Option<JointSpring>) -> Result<(), JointError> {
        let Some(JointSpring { hertz, damping }) = spring else { return Ok(()) };
        self.finite::<f64>("spring hertz", hertz)?;
        self.finite::<f64>("spring damping", damping)?;
        self.within("spring hertz", "positive", hertz, hertz > 0.0)?;
        self.within("spring damping", "at least 0", damping, damping >= 0.0)
    }

    fn point<R: Real>(&self, field: &'static str, point: [f64; 2]) -> Result<(), JointError> {
        for value in point {
            self.finite::<R>(field, value)?;
            let range = "less than 1e15 (f32) or 1e97 (f64) from the origin";
            self.within(field, range, value, value.abs() < R::FAR.to_f64() * 1e-3)?;
        }
        Ok(())
    }

    fn ordered(
        &self,
        low: &'static str,
        high: &'static str,
        below: f64,
        above: f64,
    ) -> Result<(), JointError> {
        let joint = self.joint;
        if below <= above { Ok(()) } else { Err(JointError::Crossed { joint, low, high, below, above }) }
    }

    fn finite<R: Real>(&self, field: &'static str, value: f64) -> Result<(), JointError> {
        if R::from_f64(value).is_finite() {
            Ok(())
        } else {
            Err(JointError::NonFinite { joint: self.joint, field, value })
        }
    }

    fn within(
        &self,
        field: &'static str,
        range: &'static str,
        value: f64,
        good: bool,
    ) -> Result<(), JointError> {
        if good { Ok(()) } else { Err(JointError::OutOfRange { joint: self.joint, field, range, value }) }
    }
}
