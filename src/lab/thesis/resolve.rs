//! One contact at a time, resolved where it is found: push apart, then one impulse.

use glam::Vec2;

use super::rigid::Rigid;

/// The share of the depth that one resolution removes.
const CORRECTED_SHARE: f32 = 0.7;
/// The depth that is left, px.
pub(super) const SLOP_PX: f32 = 0.01;

/// Where two bodies touch. Pixels, y down.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Contact {
    /// Unit vector from the first body to the second.
    pub(super) normal: Vec2,
    /// How far they overlap along it.
    pub(super) depth_px: f32,
    /// The point of the second body deepest in the first.
    pub(super) start_px: Vec2,
    /// The point of the first body that lies over it.
    pub(super) end_px: Vec2,
}

/// Moves both apart and changes their velocities; false, and nothing done, where neither can move.
///
/// The arms are taken after the correction but to the points found before it, as in the original.
pub(super) fn resolve(a: &mut Rigid, b: &mut Rigid, contact: &Contact) -> bool {
    if a.is_static() && b.is_static() {
        return false;
    }
    let per_inverse_mass =
        (contact.depth_px - SLOP_PX).max(0.0) / (a.inverse_mass + b.inverse_mass) * CORRECTED_SHARE;
    // Not guarded by `is_static`: a body of 2000 kg takes no impulse and yet is pushed away.
    a.position_px -= contact.normal * (per_inverse_mass * a.inverse_mass);
    b.position_px += contact.normal * (per_inverse_mass * b.inverse_mass);
    apply_impulse(a, b, contact);
    true
}

/// Normal and tangential impulse, both with restitution, neither with a condition.
///
/// Along an axis u the impulse that turns the relative speed w into −e·w is
/// j = −(1+e) w / (1/ma + 1/mb + (ra×u)²/Ia + (rb×u)²/Ib). The original uses it for the tangent as well,
/// scaled by f instead of bounded by f·jn, and for pairs that already part, which it so pulls together.
fn apply_impulse(a: &mut Rigid, b: &mut Rigid, contact: &Contact) {
    let elasticity = a.elasticity.min(b.elasticity);
    let friction = a.friction.min(b.friction);
    let (arm_a, arm_b) = (contact.end_px - a.position_px, contact.start_px - b.position_px);
    let relative = a.velocity_at(arm_a) - b.velocity_at(arm_b);
    let along = |axis: Vec2| {
        let (turn_a, turn_b) = (arm_a.perp_dot(axis), arm_b.perp_dot(axis));
        let resistance = a.inverse_mass
            + b.inverse_mass
            + turn_a * turn_a * a.inverse_inertia
            + turn_b * turn_b * b.inverse_inertia;
        -(1.0 + elasticity) * relative.dot(axis) / resistance
    };
    let tangent = contact.normal.perp();
    let impulse = contact.normal * along(contact.normal) + tangent * (friction * along(tangent));
    a.push(impulse, arm_a);
    b.push(-impulse, arm_b);
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;

    fn ball(x: f32, velocity: f32) -> Rigid {
        Rigid {
            position_px: Vec2::new(x, 0.0),
            rotation: 0.0,
            velocity_px: Vec2::new(velocity, 0.0),
            spin: 0.0,
            acceleration: Vec3::ZERO,
            mass: 1.0,
            inverse_mass: 1.0,
            inverse_inertia: 0.01,
            elasticity: 0.5,
            friction: 0.5,
        }
    }

    #[test]
    fn correction_leaves_three_tenths_of_what_exceeds_the_slop() {
        let (mut a, mut b) = (ball(0.0, 0.0), ball(29.0, 0.0));
        let contact = Contact {
            normal: Vec2::X,
            depth_px: 1.01,
            start_px: Vec2::new(14.0, 0.0),
            end_px: Vec2::new(15.0, 0.0),
        };
        assert!(resolve(&mut a, &mut b, &contact));
        assert!((b.position_px.x - a.position_px.x - 29.7).abs() < 1e-5);
    }

    #[test]
    fn elastic_impulse_reverses_the_approach_by_the_restitution() {
        let (mut a, mut b) = (ball(0.0, 3.0), ball(30.0, -1.0));
        let touch = Vec2::new(15.0, 0.0);
        let contact = Contact { normal: Vec2::X, depth_px: 0.0, start_px: touch, end_px: touch };
        resolve(&mut a, &mut b, &contact);
        assert!((b.velocity_px.x - a.velocity_px.x - 0.5 * 4.0).abs() < 1e-5);
    }
}
