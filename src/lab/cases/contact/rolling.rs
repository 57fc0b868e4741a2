//! B4, B6 and B8: discs that roll on slopes, in bowls and round loops.
//!
//! Shapes are convex: bowl and loop are rings of flat facets around a circle of radius R. A disc that rolls over the
//! dent between two of them, δ apart, meets the next with a velocity δ below it; the impact keeps the share
//! (1 + 2cos δ)/3 ≈ 1 − δ²/3 of its spin when it rolls, cos δ ≈ 1 − δ²/2 of its speed when it slides: over an angle Θ
//! of Θ/δ facets ⅔Θδ and Θδ of its energy are lost. With 720 facets that is 0.9 % a radian, 2.7 % to the top of a loop
//! (measured: 2.8 % with steps of 1/3840 s), which bounds what these cases can show.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use lamina2d::force::Forces;
use lamina2d::scene::basics::on_slope;
use lamina2d::scene::named::scene;
use lamina2d::vec2::Rot;

use super::{BodySpec, GRAVITY, Scene, ShapeSpec};
use crate::cases::{Exact, downhill, moved, radius};
use crate::reference::elliptic::complete_first;

/// A disc of 0.5 m let go on a slope of 45° with μ = 0.2, less than tan θ/3: it slips.
pub(super) fn slipping() -> Scene {
    on_slope("a disc slips down a slope", ShapeSpec::Circle(0.5), 0.5, 45f64.to_radians(), 0.2, 180)
}

/// a = g(sin θ − μ cos θ), α = μmg cos θ·R/½mR² = 2μg cos θ/R; to the left, counter-clockwise.
pub(super) fn slipping_at(scene: &Scene, t: f64) -> Vec<Exact> {
    let (rot, down) = downhill(scene);
    let disc = &scene.bodies[1];
    let half_square = 0.5 * GRAVITY * t * t;
    let way = half_square * (rot.s - disc.friction * rot.c);
    let turn = half_square * 2.0 * disc.friction * rot.c / radius(disc);
    vec![moved(1, disc, down * way, turn)]
}

/// Radii of bowl and loop, and of what rolls in them, metres.
const RADIUS_M: f64 = 2.0;
const DISC_RADIUS_M: f64 = 0.25;
/// Facets of a whole circle.
const FACETS: usize = 720;

/// Facets of a circle of [`RADIUS_M`] about the origin, seen from inside; angles from the lowest point.
fn facets(from: f64, to: f64, friction: f64) -> impl Iterator<Item = BodySpec> {
    let sector = TAU / FACETS as f64;
    let count = ((to - from) / sector).round() as usize;
    let half = [RADIUS_M * (0.5 * sector).tan(), 0.1];
    (0..count).map(move |k| {
        let rot = Rot::from_angle(from + (k as f64 + 0.5) * sector);
        let out = RADIUS_M + half[1];
        let facet = BodySpec::new(ShapeSpec::Box(half), [out * rot.s, -out * rot.c]);
        facet.turned(from + (k as f64 + 0.5) * sector).surface(0.0, friction).fixed()
    })
}

/// Where the disc of B6 is let go, rad from the lowest point.
const BOWL_START_RAD: f64 = PI / 3.0;

/// A disc inside the circle, `angle` rad from its lowest point.
fn inside(angle: f64, friction: f64) -> BodySpec {
    let rot = Rot::from_angle(angle);
    let reach = RADIUS_M - DISC_RADIUS_M;
    BodySpec::new(ShapeSpec::Circle(DISC_RADIUS_M), [reach * rot.s, -reach * rot.c]).surface(0.0, friction)
}

/// B6: a disc of 0.25 m let go at 60° in a bowl of 2 m, of facets of half a degree. The disc is the last body.
pub(super) fn bowl() -> Scene {
    let bodies = facets(-FRAC_PI_2, FRAC_PI_2, 1.0).chain([inside(BOWL_START_RAD, 1.0)]).collect();
    scene("a disc rolls in a bowl", bodies, Forces::gravity(), 360)
}

/// The period of B6, seconds: 4√(3(R − r)/2g)·K(sin ½φ₀). Rolling makes the disc 3/2 as inert as it is heavy.
pub fn bowl_period_secs() -> f64 {
    let reach = RADIUS_M - DISC_RADIUS_M;
    4.0 * (1.5 * reach / GRAVITY).sqrt() * complete_first((0.5 * BOWL_START_RAD).sin())
}

/// Radius of the way of the centre of B8's disc, metres: heights are measured in it.
pub const LOOP_RADIUS_M: f64 = RADIUS_M - DISC_RADIUS_M;

/// A disc at the lowest point of a loop, as fast as if it had come down from `height` m: sliding without friction
/// v² = 2gh, or rolling with μ = 2, v² = 4gh/3. It goes round from 2.5 or 2.75 radii on: ½mv² or ¾mv² must leave
/// v² = gR at the top, 2R up. The disc is the last body.
pub fn loop_at(height: f64, rolls: bool) -> Scene {
    let (friction, share) = if rolls { (2.0, 4.0 / 3.0) } else { (0.0, 2.0) };
    let speed = (share * GRAVITY * height).sqrt();
    let spin = if rolls { -speed / DISC_RADIUS_M } else { 0.0 };
    let disc = inside(0.0, friction).moving([speed, 0.0], spin);
    let bodies = facets(-PI, PI, friction).chain([disc]).collect();
    scene("a disc goes round a loop", bodies, Forces::gravity(), 120)
}

pub(super) fn loop_sliding() -> Scene {
    loop_at(2.5 * LOOP_RADIUS_M, false)
}

pub(super) fn loop_rolling() -> Scene {
    loop_at(2.75 * LOOP_RADIUS_M, true)
}
