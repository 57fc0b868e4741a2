//! Scenes whose motion has a closed form, and that form beside each: what the error of any engine is measured against.
//!
//! [`exact`] knows nothing of an engine: it reads the scene's own numbers and gives each movable body's pose at a
//! time, in `f64`. The letters are those of the cases' usual names: A smooth motion, B contact.
//!
//! | scene | case | closed form |
//! |---|---|---|
//! | `free_flight` | A1 | x₀ + v₀t + ½gt² |
//! | `spin` | A16 | θ₀ + ωt |
//! | `pendulum` | A9 | sin ½θ = k·sn(t√(g/L) + K), T = 4√(L/g)·K(k), k = sin ½θ₀ |
//! | `slide` | B1 | stops after v₀²/2μg |
//! | `incline` | B3 | ½g(sin θ − μ cos θ)t² |
//! | `roll` | B4 | ⅓g sin θ·t², angle s/R |
//! | `slide_to_roll` | B5 | until v₀/3μg slides, then rolls at ⅔v₀ |
//! | `bounce` | B10 | parabolas, each e times as fast as the last |
//! | `head_on` | B12 | momentum and Newton's law of restitution |
//! | `a…` of [`smooth`] | A1 to A16 | beside each |
//! | `b…` of [`contact`] | B1 to B31 | beside each |
//! | `rod_hit` | B14 | J = (1 + e)v / (1/m₁ + 1/m₂ + d²/I) |

use glam::DVec2;

use lamina2d::vec2::Rot;

use super::{BodyKind, BodySpec, Scene, ShapeSpec, contact, smooth};
use crate::reference::elliptic::pendulum_angle;

/// Where a body is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Exact {
    /// Its number in the scene.
    pub body: usize,
    /// Centroid, metres.
    pub position: [f64; 2],
    /// Attitude, rad, counter-clockwise and not wrapped.
    pub angle: f64,
}

/// A case's closed form: one pose per movable body of the scene, after so many seconds.
pub(crate) type Form = fn(&Scene, f64) -> Vec<Exact>;

const FORMS: &[(&str, Form)] = &[
    ("free_flight", ballistic),
    ("spin", ballistic),
    ("pendulum", swing),
    ("slide", slide_at),
    ("incline", incline_at),
    ("roll", roll_at),
    ("slide_to_roll", slide_to_roll_at),
    ("bounce", bounce_at),
    ("head_on", head_on_at),
    ("rod_hit", rod_hit_at),
];

/// Where every movable body of a scene is after `t_secs`; `None` where no closed form is known. Goes by the scene's
/// name, so the scene must be as [`super::by_name`] made it.
pub fn exact(scene: &Scene, t_secs: f64) -> Option<Vec<Exact>> {
    let base = scene.name.split('/').next().unwrap_or_default();
    let form = FORMS.iter().chain(smooth::FORMS).chain(contact::FORMS).find(|(name, _)| *name == base)?.1;
    Some(form(scene, t_secs))
}

/// m/s², downward.
pub(crate) fn gravity(scene: &Scene) -> f64 {
    scene.forces.gravity.map_or(0.0, |g| -g[1])
}

fn movable(scene: &Scene) -> impl Iterator<Item = (usize, &BodySpec)> {
    scene.bodies.iter().enumerate().filter(|(_, b)| b.kind != BodyKind::Static)
}

/// A pose `along` an axis of the body's beginning.
pub(crate) fn moved(body: usize, spec: &BodySpec, by: DVec2, turn: f64) -> Exact {
    Exact { body, position: (DVec2::from(spec.position) + by).to_array(), angle: spec.angle + turn }
}

fn ballistic(scene: &Scene, t: f64) -> Vec<Exact> {
    let fall = DVec2::new(0.0, -0.5 * gravity(scene) * t * t);
    let at =
        |(k, b): (usize, &BodySpec)| moved(k, b, DVec2::from(b.velocity) * t + fall, b.angular_velocity * t);
    movable(scene).map(at).collect()
}

fn swing(scene: &Scene, t: f64) -> Vec<Exact> {
    let (pivot, bob) = (DVec2::from(scene.bodies[0].position), DVec2::from(scene.bodies[1].position));
    let arm = bob - pivot;
    // From the lowest point, counter-clockwise.
    let angle = pendulum_angle(arm.x.atan2(-arm.y), t * (gravity(scene) / arm.length()).sqrt());
    let at = pivot + arm.length() * DVec2::new(angle.sin(), -angle.cos());
    // The rod ends in the disc's centre: nothing turns it.
    vec![moved(1, &scene.bodies[1], at - bob, 0.0)]
}

pub(crate) fn slide_at(scene: &Scene, t: f64) -> Vec<Exact> {
    let block = &scene.bodies[1];
    let slowing = block.friction * gravity(scene);
    let t = t.min(block.velocity[0] / slowing);
    vec![moved(1, block, DVec2::new(block.velocity[0] * t - 0.5 * slowing * t * t, 0.0), 0.0)]
}

/// Down the slope that body 0 is, per metre of way.
pub(crate) fn downhill(scene: &Scene) -> (Rot<f64>, DVec2) {
    let rot = Rot::from_angle(scene.bodies[0].angle);
    (rot, DVec2::new(-rot.c, -rot.s))
}

pub(crate) fn incline_at(scene: &Scene, t: f64) -> Vec<Exact> {
    let (rot, down) = downhill(scene);
    let block = &scene.bodies[1];
    let way = 0.5 * gravity(scene) * (rot.s - block.friction * rot.c) * t * t;
    vec![moved(1, block, down * way, 0.0)]
}

pub(crate) fn radius(spec: &BodySpec) -> f64 {
    spec.shape.build().map_or(f64::NAN, |shape| shape.bounding_radius())
}

pub(crate) fn roll_at(scene: &Scene, t: f64) -> Vec<Exact> {
    let (rot, down) = downhill(scene);
    let disc = &scene.bodies[1];
    let way = gravity(scene) * rot.s / 3.0 * t * t;
    // Downhill is to the left: it turns counter-clockwise.
    vec![moved(1, disc, down * way, way / radius(disc))]
}

pub(crate) fn slide_to_roll_at(scene: &Scene, t: f64) -> Vec<Exact> {
    let disc = &scene.bodies[1];
    let (v, slowing) = (disc.velocity[0], disc.friction * gravity(scene));
    let sliding = t.min(v / (3.0 * slowing));
    let rolling = t - sliding;
    let way = v * sliding - 0.5 * slowing * sliding * sliding + 2.0 / 3.0 * v * rolling;
    // α = 2μg/R while it slides, ω = v/R once it rolls; clockwise.
    let turn = slowing * sliding * sliding + 2.0 / 3.0 * v * rolling;
    vec![moved(1, disc, DVec2::new(way, 0.0), -turn / radius(disc))]
}

pub(crate) fn bounce_at(scene: &Scene, t: f64) -> Vec<Exact> {
    let disc = &scene.bodies[1];
    let (g, drop) = (gravity(scene), disc.position[1] - radius(disc));
    let first = (2.0 * drop / g).sqrt();
    let (mut speed, mut left) = (g * first, t - first);
    let mut height = drop - 0.5 * g * t * t;
    while left > 0.0 {
        speed *= disc.restitution;
        let flight = 2.0 * speed / g;
        if flight < 1e-6 {
            height = 0.0;
            break;
        }
        height = speed * left - 0.5 * g * left * left;
        left -= flight;
    }
    vec![moved(1, disc, DVec2::new(0.0, height - drop), 0.0)]
}

/// Half the width of a body as it stands.
fn half_width(spec: &BodySpec) -> f64 {
    match &spec.shape {
        ShapeSpec::Box([x, _]) => *x,
        _ => radius(spec),
    }
}

pub(crate) fn mass(spec: &BodySpec) -> f64 {
    spec.mass.unwrap_or(f64::NAN)
}

fn head_on_at(scene: &Scene, t: f64) -> Vec<Exact> {
    let meet = |(k, pair): (usize, &[BodySpec])| {
        let ([a, b], [va, vb]) = ([&pair[0], &pair[1]], [pair[0].velocity[0], pair[1].velocity[0]]);
        let gap = b.position[0] - a.position[0] - half_width(a) - half_width(b);
        let before = t.min(gap / (va - vb));
        let impulse = (1.0 + a.restitution) * (va - vb) / (1.0 / mass(a) + 1.0 / mass(b));
        let after = t - before;
        let way = |spec, v: f64, change: f64| v * before + (v + change / mass(spec)) * after;
        [
            moved(2 * k, a, DVec2::new(way(a, va, -impulse), 0.0), 0.0),
            moved(2 * k + 1, b, DVec2::new(way(b, vb, impulse), 0.0), 0.0),
        ]
    };
    scene.bodies.chunks_exact(2).enumerate().flat_map(meet).collect()
}

pub(crate) fn rod_hit_at(scene: &Scene, t: f64) -> Vec<Exact> {
    let (disc, rod) = (&scene.bodies[0], &scene.bodies[1]);
    let [half_x, half_y] = match rod.shape {
        ShapeSpec::Box(half) => half,
        _ => [f64::NAN; 2],
    };
    let inertia = mass(rod) / 3.0 * (half_x * half_x + half_y * half_y);
    let arm = disc.position[1] - rod.position[1];
    let v = disc.velocity[0];
    let gap = rod.position[0] - disc.position[0] - half_x - radius(disc);
    let impulse = (1.0 + rod.restitution) * v / (1.0 / mass(disc) + 1.0 / mass(rod) + arm * arm / inertia);
    let before = t.min(gap / v);
    let after = t - before;
    let disc_way = v * before + (v - impulse / mass(disc)) * after;
    // A push to the right above the middle turns it clockwise.
    vec![
        moved(0, disc, DVec2::new(disc_way, 0.0), 0.0),
        moved(1, rod, DVec2::new(impulse / mass(rod) * after, 0.0), -impulse * arm / inertia * after),
    ]
}
