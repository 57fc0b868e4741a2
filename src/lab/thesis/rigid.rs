//! What both versions keep of a body, and the thesis's three integrators.
//!
//! All three schemes are kept as they were coded, errors included, because their free-fall figures are how
//! the baseline is recognised. With g the acceleration and h the step, n steps of free fall from rest end at
//! - Euler: g h² n(n+1)/2, half a step ahead of ½g(nh)²;
//! - Verlet: g h² (n(n−1)/2 + ½), half a step behind, because the acceleration "before the first step" is 0;
//! - RK4: g h² (c n(n−1)/2 + n(½ + h/6 + h²/24)) with c = 1 + h/2 + h²/6 + h³/24, because velocity increments
//!   are added to the acceleration as if both had one unit. To the leading order that is Euler's error.

use glam::{Vec2, Vec3};

/// Below this inverse mass (1/2000) a body counts as static: the thesis's test for zero.
const STATIC_INVERSE_MASS: f32 = 0.0005;

/// How the thesis's engine moves a body through a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ThesisIntegrator {
    /// Semi-implicit Euler: velocity first.
    Euler,
    /// "Velocity Verlet" whose first step takes the earlier acceleration for zero.
    Verlet,
    /// "Runge–Kutta 4" that adds velocity increments to the acceleration.
    Rk4,
}

impl ThesisIntegrator {
    /// All three, in the thesis's order.
    pub const ALL: [Self; 3] = [Self::Euler, Self::Verlet, Self::Rk4];
}

/// The state of a body and what resists its change. Pixels, y down, seconds, radians clockwise.
///
/// 56 bytes; the acceleration lives here only because Verlet needs the one before.
#[derive(Clone, Debug)]
pub(super) struct Rigid {
    pub(super) position_px: Vec2,
    pub(super) rotation: f32,
    pub(super) velocity_px: Vec2,
    pub(super) spin: f32,
    /// Linear and angular, of the last step; zero before the first.
    pub(super) acceleration: Vec3,
    pub(super) mass: f32,
    pub(super) inverse_mass: f32,
    pub(super) inverse_inertia: f32,
    pub(super) elasticity: f32,
    pub(super) friction: f32,
}

impl Rigid {
    /// A heavy body is static too: a defect that is kept.
    #[inline(always)]
    pub(super) fn is_static(&self) -> bool {
        self.inverse_mass <= STATIC_INVERSE_MASS
    }

    /// The velocity of the point `arm` away from the centre.
    #[inline(always)]
    pub(super) fn velocity_at(&self, arm_px: Vec2) -> Vec2 {
        self.velocity_px + self.spin * arm_px.perp()
    }

    /// Changes the velocities by an impulse at `arm`; static bodies take none.
    #[inline(always)]
    pub(super) fn push(&mut self, impulse: Vec2, arm_px: Vec2) {
        if !self.is_static() {
            self.velocity_px += impulse * self.inverse_mass;
            self.spin += arm_px.perp_dot(impulse) * self.inverse_inertia;
        }
    }

    /// One step of `h` seconds under a constant force; the caller has left out static bodies.
    pub(super) fn advance(&mut self, integrator: ThesisIntegrator, force: Vec2, h: f32) {
        // Torque is always 0 here: it is a column of the scheme because the original integrates it too.
        let acceleration = (force * self.inverse_mass).extend(0.0);
        let before = std::mem::replace(&mut self.acceleration, acceleration);
        let mut place = self.position_px.extend(self.rotation);
        let mut rate = self.velocity_px.extend(self.spin);
        match integrator {
            ThesisIntegrator::Euler => {
                rate += acceleration * h;
                place += rate * h;
            }
            ThesisIntegrator::Verlet => {
                place += rate * h + acceleration * (h * h / 2.0);
                rate += (acceleration + before) * (h / 2.0);
            }
            ThesisIntegrator::Rk4 => {
                let (place_change, rate_change) = rk4_increments(rate, acceleration, h);
                place += place_change;
                rate += rate_change;
            }
        }
        self.position_px = place.truncate();
        self.rotation = place.z % std::f32::consts::TAU;
        self.velocity_px = rate.truncate();
        self.spin = rate.z;
    }
}

/// Four stages weighted 1:2:2:1; each leads with part of the last stage's *velocity* increment, which is
/// right for the place and wrong for the acceleration.
fn rk4_increments(rate: Vec3, acceleration: Vec3, h: f32) -> (Vec3, Vec3) {
    let (mut place_sum, mut rate_sum, mut increment) = (Vec3::ZERO, Vec3::ZERO, Vec3::ZERO);
    for (lead, weight) in [(0.0, 1.0), (0.5, 2.0), (0.5, 2.0), (1.0, 1.0)] {
        let led = lead * increment;
        place_sum += weight * ((rate + led) * h);
        increment = (acceleration + led) * h;
        rate_sum += weight * increment;
    }
    (place_sum / 6.0, rate_sum / 6.0)
}
