//! A scene seen otherwise: enlarged, heavier, mirrored, turned, shifted, moving. The motion is then known from that of
//! the scene itself, without any reference: what an engine makes of it shows which absolute numbers it hides.
//!
//! Scenes of bodies and gravity alone: joints, other fields and events are left as they are.

use super::{BodySpec, Scene, ShapeSpec};

fn each(scene: &Scene, change: impl Fn(&BodySpec) -> BodySpec) -> Scene {
    Scene { bodies: scene.bodies.iter().map(change).collect(), ..scene.clone() }
}

fn shape(spec: &ShapeSpec, change: impl Fn([f64; 2]) -> [f64; 2]) -> ShapeSpec {
    match spec {
        ShapeSpec::Circle(radius) => ShapeSpec::Circle(change([*radius, 0.0])[0].abs()),
        ShapeSpec::Box(half) => ShapeSpec::Box(change(*half).map(f64::abs)),
        ShapeSpec::Polygon(outline) => ShapeSpec::Polygon(outline.iter().copied().map(change).collect()),
    }
}

/// Lengths times 4ᵏ and times, with the step, times 2ᵏ: gravity stays, and so does every number's mantissa.
#[must_use]
pub fn enlarged(scene: &Scene, k: i32) -> Scene {
    let (length, time) = (4f64.powi(k), 2f64.powi(k));
    let long = |pair: [f64; 2]| pair.map(|v| v * length);
    let scene = Scene { dt_secs: scene.dt_secs * time, ..scene.clone() };
    each(&scene, |body| BodySpec {
        shape: shape(&body.shape, long),
        position: long(body.position),
        velocity: body.velocity.map(|v| v * time),
        angular_velocity: body.angular_velocity / time,
        pivot: body.pivot.map(long),
        ..body.clone()
    })
}

/// Masses and densities times 2ᵏ, and forces with them.
#[must_use]
pub fn heavier(scene: &Scene, k: i32) -> Scene {
    let share = 2f64.powi(k);
    each(scene, |body| BodySpec {
        mass: body.mass.map(|mass| mass * share),
        density: body.density.or(body.mass.is_none().then_some(1.0)).map(|density| density * share),
        force: body.force.map(|force| force * share),
        torque: body.torque * share,
        ..body.clone()
    })
}

/// x becomes −x, and what turned left turns right.
#[must_use]
pub fn mirrored(scene: &Scene) -> Scene {
    let flip = |[x, y]: [f64; 2]| [-x, y];
    let gravity = scene.forces.gravity.map(flip);
    let scene = Scene { forces: crate::force::Forces { gravity, ..scene.forces }, ..scene.clone() };
    each(&scene, |body| BodySpec {
        shape: shape(&body.shape, flip),
        position: flip(body.position),
        angle: -body.angle,
        velocity: flip(body.velocity),
        angular_velocity: -body.angular_velocity,
        pivot: body.pivot.map(flip),
        force: flip(body.force),
        torque: -body.torque,
        ..body.clone()
    })
}

/// All places, velocities and gravity a quarter turn counter-clockwise; boxes and outlines are given turned, so that
/// attitudes stay.
#[must_use]
pub fn turned(scene: &Scene) -> Scene {
    let turn = |[x, y]: [f64; 2]| [-y, x];
    let gravity = scene.forces.gravity.map(turn);
    let scene = Scene { forces: crate::force::Forces { gravity, ..scene.forces }, ..scene.clone() };
    each(&scene, |body| BodySpec {
        shape: match &body.shape {
            circle @ ShapeSpec::Circle(_) => circle.clone(),
            other => shape(other, turn),
        },
        position: turn(body.position),
        velocity: turn(body.velocity),
        pivot: body.pivot.map(turn),
        force: turn(body.force),
        ..body.clone()
    })
}

/// All places moved by so much, metres.
#[must_use]
pub fn shifted(scene: &Scene, by: [f64; 2]) -> Scene {
    let moved = |position: [f64; 2]| [position[0] + by[0], position[1] + by[1]];
    each(scene, |body| BodySpec {
        position: moved(body.position),
        pivot: body.pivot.map(moved),
        ..body.clone()
    })
}

/// All bodies with so much more velocity, m/s; static ones become kinematic.
#[must_use]
pub fn drifting(scene: &Scene, by: [f64; 2]) -> Scene {
    use super::BodyKind::{Kinematic, Static};
    each(scene, |body| BodySpec {
        kind: if body.kind == Static { Kinematic } else { body.kind },
        velocity: [body.velocity[0] + by[0], body.velocity[1] + by[1]],
        ..body.clone()
    })
}
