//! The error of a run whose exact result is known: the same `f64` code for every engine.

use lamina2d::simulation::Simulation;

use super::{Exact, Scene, exact};

/// How far a scene's bodies are from where its closed form ([`exact`]) has them after `t_secs`; `None` where it has
/// none.
///
/// `pose` gives the centroid, metres, and the cosine and sine of the attitude of the k-th body of the scene. Of each
/// body the larger of two errors counts, of all bodies the largest: the distance from the exact place over the way
/// gone by then (or over the bounding radius, if that is larger), and the chord between the two attitudes, which is
/// their difference in radians where it is small.
pub fn case_error(scene: &Scene, t_secs: f64, pose: impl Fn(usize) -> ([f64; 2], [f64; 2])) -> Option<f64> {
    let of = |wanted: &Exact| {
        let spec = &scene.bodies[wanted.body];
        let ([x, y], [c, s]) = pose(wanted.body);
        let away = |from: [f64; 2], to: [f64; 2]| (to[0] - from[0]).hypot(to[1] - from[1]);
        let size = spec.shape.build().map_or(f64::NAN, |shape| shape.bounding_radius());
        let scale = away(spec.position, wanted.position).max(size);
        let turned = away([c, s], [wanted.angle.cos(), wanted.angle.sin()]);
        (away([x, y], wanted.position) / scale).max(turned)
    };
    // A NaN is the largest error there is.
    let worst = |a: f64, b: f64| if a.is_nan() || b.is_nan() { f64::NAN } else { a.max(b) };
    Some(exact(scene, t_secs)?.iter().map(of).fold(0.0, worst))
}

/// [`case_error`] of one of our worlds, which was made of `scene`.
pub fn error_of(world: &dyn Simulation, scene: &Scene, t_secs: f64) -> Option<f64> {
    let states = world.states();
    case_error(scene, t_secs, |body| (states[body].position, states[body].rotation))
}
