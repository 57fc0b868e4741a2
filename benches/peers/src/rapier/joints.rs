//! Joints by rapier's names: impulse joints over its generic one.
//!
//! It has no rod: one is its spring between two points, as stiff as its joints are by default. Springs act on
//! accelerations, so that hertz and damping are those of the two bodies alone, as ours are.

use std::f64::consts::{PI, TAU};

use lamina2d::joint::{Distance, Joint, JointKind, JointSpring};
use rapier2d::math::Pose;
use rapier2d::prelude::{
    GenericJoint, GenericJointBuilder, JointAxesMask, JointAxis, MotorModel, SpringCoefficients,
};

use crate::blueprint::Blueprint;
use crate::engine::{Gap, Name};

use super::{rotation, vector};

/// Damping of a motor that is to keep its speed as far as its torque goes: so large that nothing else limits it.
const MOTOR_DAMPING: f32 = 1e6;

/// Stiffness (1/s²) and damping (1/s) per mass of a spring.
fn per_mass(spring: JointSpring) -> [f32; 2] {
    let omega = TAU * spring.hertz;
    [(omega * omega) as f32, (2.0 * spring.damping * omega) as f32]
}

/// A joint as rapier has it.
///
/// # Errors
/// What it has not: a least distance, a limit of more than half a turn.
pub(super) fn joint(blueprint: &Blueprint, number: usize, joint: &Joint) -> Result<GenericJoint, Gap> {
    let gap = |lacks: String| blueprint.gap(Name::Rapier2d, lacks);
    let builder = match &joint.kind {
        JointKind::Distance(distance) => rod(distance, joint.length)
            .map_err(|what| gap(format!("joint {number} has {what}, its ropes and springs have none")))?,
        JointKind::Revolute(revolute) => {
            let mut builder = GenericJointBuilder::new(JointAxesMask::LOCKED_REVOLUTE_AXES);
            if let Some(motor) = revolute.motor {
                builder = builder
                    .motor_velocity(JointAxis::AngX, motor.speed as f32, MOTOR_DAMPING)
                    .motor_max_force(JointAxis::AngX, motor.max_torque as f32);
            }
            if let Some(limits) = revolute.limits {
                if let Some(angle) = [limits.lower, limits.upper].into_iter().find(|angle| angle.abs() > PI) {
                    return Err(gap(format!("joint {number} has a limit of {angle} rad, it has at most π")));
                }
                builder = builder.limits(JointAxis::AngX, [limits.lower as f32, limits.upper as f32]);
            }
            builder
        }
        JointKind::Weld(weld) => match weld.spring {
            None => GenericJointBuilder::new(JointAxesMask::LOCKED_FIXED_AXES),
            Some(spring) => {
                let [stiffness, damping] = per_mass(blueprint.weld_spring(joint, spring));
                GenericJointBuilder::new(JointAxesMask::LOCKED_REVOLUTE_AXES)
                    .motor_model(JointAxis::AngX, MotorModel::AccelerationBased)
                    .motor_position(JointAxis::AngX, 0.0, stiffness, damping)
            }
        },
    };
    let [c, s] = joint.reference;
    let [a, b] = joint.anchors_body;
    Ok(builder
        .local_frame1(Pose::from_translation(vector(a)))
        // B's frame turned back by what B is turned against A: the angle is 0 where ours is.
        .local_frame2(Pose::from_parts(vector(b), rotation([c, -s])))
        .contacts_enabled(joint.collide)
        .build())
}

/// A distance: a rod, a spring, a rope; a least distance it has not.
fn rod(distance: &Distance, length: f64) -> Result<GenericJointBuilder, String> {
    if let Some(min) = distance.min.filter(|min| *min > 0.0) {
        return Err(format!("a least distance of {min} m"));
    }
    let rigid = SpringCoefficients::<f32>::joint_defaults();
    let rigid =
        JointSpring { hertz: f64::from(rigid.natural_frequency), damping: f64::from(rigid.damping_ratio) };
    let mut builder = GenericJointBuilder::new(JointAxesMask::empty()).coupled_axes(JointAxesMask::LIN_AXES);
    let held = distance.spring.or(distance.max.is_none().then_some(rigid));
    if let Some(spring) = held {
        let [stiffness, damping] = per_mass(spring);
        builder = builder.motor_model(JointAxis::LinX, MotorModel::AccelerationBased).motor_position(
            JointAxis::LinX,
            length as f32,
            stiffness,
            damping,
        );
    }
    if let Some(max) = distance.max {
        builder = builder.limits(JointAxis::LinX, [0.0, max as f32]);
    }
    Ok(builder)
}
