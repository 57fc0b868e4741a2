//! A joint as the direct solve sees it: up to three rows, each with what it takes of both bodies.

use super::block::{Block, Triple};
use crate::solve::constraint::Side;
use crate::solve::joint::Stiffness;
use crate::solve::joint::pin::Pin;
use crate::solve::joint::rod::Rod;
use crate::vec2::Vec2;

/// Which lane of which batches.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Kind {
    /// A point: two rows.
    Pin,
    /// A point and an angle: three.
    Weld,
    /// A length: one.
    Rod,
}

/// A joint in its rows.
#[derive(Clone, Copy, Debug)]
pub(super) enum Link {
    /// A pin or a weld, with what its angle is held at.
    Pin(Pin<f64>, f64, Kind),
    /// A rod, with the length it is held at and its impulse.
    Rod(Rod<f64>, f64, f64),
}

impl Link {
    /// Rows.
    pub(super) fn rows(&self) -> usize {
        match self {
            Self::Pin(_, _, Kind::Weld) => 3,
            Self::Pin(..) => 2,
            Self::Rod(..) => 1,
        }
    }

    /// From the centroid of A (0) or B (1) to where it holds, metres.
    pub(super) fn arm(&self, end: usize) -> Vec2<f64> {
        match self {
            Self::Pin(pin, ..) => pin.arm(end),
            Self::Rod(rod, ..) => rod.arm(end),
        }
    }

    /// What each row takes of a body: along x, y and its spin; of B as given, of A with the other sign.
    pub(super) fn jacobian(&self, end: usize) -> Block {
        let (sign, arm) = (if end == 0 { -1.0 } else { 1.0 }, self.arm(end));
        let rows = match self {
            Self::Pin(_, _, kind) => {
                let angle = if *kind == Kind::Weld { [0.0, 0.0, 1.0] } else { [0.0; 3] };
                [[1.0, 0.0, -arm.y], [0.0, 1.0, arm.x], angle]
            }
            Self::Rod(rod, ..) => {
                let n = rod.axis();
                [[n.x, n.y, arm.cross(n)], [0.0; 3], [0.0; 3]]
            }
        };
        rows.map(|row| row.map(|value| sign * value))
    }

    /// What the rows' velocities are to be rid of: with bias where a push says how.
    pub(super) fn wanted(&self, a: &Side<f64>, b: &Side<f64>, how: Option<&Stiffness<f64>>) -> Triple {
        match self {
            Self::Pin(pin, rest, kind) => {
                let point = pin.wanted(a, b, how);
                let bias = how.map_or(0.0, |how| (pin.angle() - rest) * how.bias_rate);
                let angle = if *kind == Kind::Weld { (b.spin - a.spin) + bias } else { 0.0 };
                [point.x, point.y, angle]
            }
            Self::Rod(rod, rest, _) => [rod.wanted(a, b, *rest, how), 0.0, 0.0],
        }
    }

    /// The force part of its impulse on B, N·s, in units of v.
    pub(super) fn impulse(&self) -> Vec2<f64> {
        match self {
            Self::Pin(pin, ..) => pin.impulse(),
            Self::Rod(rod, _, impulse) => rod.axis() * *impulse,
        }
    }

    /// The force part of an impulse of its rows.
    pub(super) fn force(&self, rows: Triple) -> Vec2<f64> {
        match self {
            Self::Pin(..) => Vec2::new(rows[0], rows[1]),
            Self::Rod(rod, ..) => rod.axis() * rows[0],
        }
    }

    /// 1/m, of a rod's length: what it pulls with over that is how stiff it is across; pins turn instead.
    pub(super) fn per_length(&self) -> f64 {
        match self {
            Self::Pin(..) => 0.0,
            Self::Rod(_, rest, _) => 1.0 / rest.max(f64::MIN_POSITIVE),
        }
    }

    /// Bodies turn with this inertia, 1/(kg·m²).
    pub(super) fn set_inv_inertia(&mut self, values: [f64; 2]) {
        match self {
            Self::Pin(pin, ..) => pin.set_inv_inertia(0, values),
            Self::Rod(rod, ..) => rod.set_inv_inertia(0, values),
        }
    }
}
