//! B11 to B17: bodies that hit walls and each other, and what they do after.

use lamina2d::force::Forces;
use lamina2d::scene::basics::floor;
use lamina2d::scene::named::scene;

use super::{BodySpec, GRAVITY, Scene, ShapeSpec};
use crate::cases::{Exact, mass, radius};

/// Height above the floor that the ball of B11 falls from, metres.
pub const ELASTIC_DROP_M: f64 = 0.25;

/// B11: a disc of 0.25 m that bounces with e = 1.
pub(super) fn elastic_ball() -> Scene {
    let ball = BodySpec::new(ShapeSpec::Circle(0.25), [0.0, 0.25 + ELASTIC_DROP_M]).surface(1.0, 0.0);
    let seconds = 2.0 * (2.0 * ELASTIC_DROP_M / GRAVITY).sqrt() * 1000.0;
    scene("a disc bounces for ever", vec![floor(0.0, 1.0), ball], Forces::gravity(), (60.0 * seconds) as u64)
}

/// Masses, kg, and coefficients of restitution of B12's pairs.
const MASSES: [[f64; 2]; 4] = [[1.0, 1.0], [1.0, 2.0], [1.0, 1000.0], [3.0, 0.1]];
const RESTITUTIONS: [f64; 4] = [0.0, 0.3, 0.7, 1.0];
/// Speed of each body of B12 towards the other, m/s.
const HEAD_ON_SPEED: f64 = 1.0;

/// B12: pairs of discs, each body at 1 m/s towards the other, of four ratios of masses and four e; 4 m from pair to
/// pair, without gravity. They meet after half a second.
pub(super) fn head_on() -> Scene {
    pairs(&ShapeSpec::Circle(0.5))
}

/// B12: the same of boxes, which meet with a whole face: in two points.
pub(super) fn head_on_boxes() -> Scene {
    pairs(&ShapeSpec::Box([0.5, 0.5]))
}

fn pairs(shape: &ShapeSpec) -> Scene {
    let mut bodies = Vec::new();
    for masses in MASSES {
        for restitution in RESTITUTIONS {
            let y = 2.0 * bodies.len() as f64;
            let body = |x: f64, mass: f64| {
                let velocity = [-HEAD_ON_SPEED * x.signum(), 0.0];
                let body = BodySpec::new(shape.clone(), [x, y]).moving(velocity, 0.0);
                body.mass(mass).surface(restitution, 0.0)
            };
            bodies.extend([body(-1.0, masses[0]), body(1.0, masses[1])]);
        }
    }
    scene("pairs that meet head on", bodies, Forces::default(), 60)
}

/// Speeds to the right of B12's bodies after they met, m/s: momentum and Newton's law, `v_a` − J/m with
/// J = (1 + e)(`v_a` − `v_b`)/(1/`m_a` + 1/`m_b`).
pub fn after_head_on(scene: &Scene) -> Vec<f64> {
    let meet = |pair: &[BodySpec]| {
        let ([a, b], [va, vb]) = ([&pair[0], &pair[1]], [pair[0].velocity[0], pair[1].velocity[0]]);
        let impulse = (1.0 + a.restitution) * (va - vb) / (1.0 / mass(a) + 1.0 / mass(b));
        [va - impulse / mass(a), vb + impulse / mass(b)]
    };
    scene.bodies.chunks_exact(2).flat_map(meet).collect()
}

/// e, μ, speed along the wall (m/s) and spin (rad/s) of B13's discs: some stick, some slip, some do neither more.
const OBLIQUE: [[f64; 4]; 8] = [
    [1.0, 0.3, 2.0, 5.0],
    [0.5, 0.3, 2.0, -4.0],
    [0.0, 0.5, 1.0, 8.0],
    [0.8, 0.9, -2.0, 3.0],
    [0.5, 0.1, 3.0, 0.0],
    [0.0, 0.2, -2.0, -6.0],
    [1.0, 0.9, 0.5, -2.0],
    [0.7, 0.05, 1.0, 10.0],
];
/// Towards the wall, m/s.
const OBLIQUE_SPEED: f64 = 3.0;

/// B13: discs of 0.25 m meet an upright wall at 3 m/s, each with its own e, μ, speed along the wall and spin; without
/// gravity. Bodies: the wall, the discs.
pub(super) fn oblique() -> Scene {
    let wall = BodySpec::new(ShapeSpec::Box([0.5, 40.0]), [0.5, 0.0]).surface(1.0, 1.0).fixed();
    let disc = |(k, [restitution, friction, along, spin]): (usize, [f64; 4])| {
        let y = 8.0 * (k as f64 - 3.5);
        BodySpec::new(ShapeSpec::Circle(0.25), [-1.0, y])
            .moving([OBLIQUE_SPEED, along], spin)
            .surface(restitution, friction)
    };
    let bodies = std::iter::once(wall).chain(OBLIQUE.into_iter().enumerate().map(disc)).collect();
    scene("spinning discs meet a wall", bodies, Forces::default(), 60)
}

/// Velocity (m/s) and spin (rad/s) of B13's discs after the impact.
///
/// The point of contact slides at u = `v_t` + Rω; an impulse J along the wall changes `v_t` by J/m and Rω by
/// R²J/½mR² = 2J/m, so u by 3J/m. It sticks with J = −⅓mu if that is within μ(1 + e)m|`v_n`|.
pub fn after_oblique(scene: &Scene) -> Vec<[f64; 3]> {
    let meet = |disc: &BodySpec| {
        let ([normal, along], spin, r) = (disc.velocity, disc.angular_velocity, radius(disc));
        let bound = disc.friction * (1.0 + disc.restitution) * normal;
        let change = (-(along + r * spin) / 3.0).clamp(-bound, bound);
        [-disc.restitution * normal, along + change, spin + 2.0 * change / r]
    };
    scene.bodies[1..].iter().map(meet).collect()
}

/// Half the inner width and height of B16's box, and the radius of its disc, metres.
const BILLIARD: [f64; 2] = [1.0, 0.75];
const BILLIARD_DISC_M: f64 = 0.1;
/// What places in B16 are compared with, metres.
pub const BILLIARD_SIZE_M: f64 = 2.0;
/// The whole seconds in which B16 counts 1000 bounces: 3.1/1.8 + 2.3/1.3 a second.
pub const BILLIARD_SECS: f64 = 287.0;

/// Four static walls around a box, 1 m thick, that bounce with e = 1.
pub(super) fn box_walls(half: [f64; 2]) -> [BodySpec; 4] {
    let wall = |size: [f64; 2], position: [f64; 2]| {
        BodySpec::new(ShapeSpec::Box(size), position).surface(1.0, 0.0).fixed()
    };
    let [x, y] = half;
    [
        wall([0.5, y + 1.0], [x + 0.5, 0.0]),
        wall([0.5, y + 1.0], [-x - 0.5, 0.0]),
        wall([x, 0.5], [0.0, y + 0.5]),
        wall([x, 0.5], [0.0, -y - 0.5]),
    ]
}

/// B16: a disc of 0.1 m in a box of 2 m by 1.5 m, e = 1, without gravity or friction. The disc is the last body.
pub(super) fn box_billiard() -> Scene {
    let disc = BodySpec::new(ShapeSpec::Circle(BILLIARD_DISC_M), [0.1, -0.2]).moving([3.1, 2.3], 0.0);
    let bodies = box_walls(BILLIARD).into_iter().chain([disc.surface(1.0, 0.0)]).collect();
    scene("a disc in a box", bodies, Forces::default(), (60.0 * BILLIARD_SECS) as u64)
}

/// Unfolding: the disc goes straight on through mirrored boxes, x is the triangle wave of x₀ + vt.
pub(super) fn box_billiard_at(scene: &Scene, t: f64) -> Vec<Exact> {
    let body = scene.bodies.len() - 1;
    let disc = &scene.bodies[body];
    let along = |k: usize| {
        let half = BILLIARD[k] - BILLIARD_DISC_M;
        let way = (disc.position[k] + disc.velocity[k] * t + half).rem_euclid(4.0 * half);
        half - (way - 2.0 * half).abs()
    };
    vec![Exact { body, position: [along(0), along(1)], angle: 0.0 }]
}

fn cradle(x: impl Iterator<Item = f64>) -> Scene {
    let disc = |(k, x): (usize, f64)| {
        let speed = if k == 0 { 1.0 } else { 0.0 };
        BodySpec::new(ShapeSpec::Circle(0.25), [x, 0.0]).moving([speed, 0.0], 0.0).surface(1.0, 0.0)
    };
    scene("Newton's cradle", x.enumerate().map(disc).collect(), Forces::default(), 60)
}

/// B17: five equal discs 5 cm apart, the first at 1 m/s, e = 1, without gravity.
pub(super) fn cradle_gaps() -> Scene {
    cradle((0..5).map(|k| 0.55 * f64::from(k)))
}

/// Each hands all of its speed to the next.
pub fn cradle_gaps_after() -> Vec<f64> {
    vec![0.0, 0.0, 0.0, 0.0, 1.0]
}

/// B17: a disc at 1 m/s against two that touch.
pub(super) fn cradle_touching() -> Scene {
    cradle([-0.75, 0.0, 0.5].into_iter())
}

/// One impact after the other: the first disc hands all it has to the second, that to the third. The law that holds
/// here, and in cradles of steel.
pub fn cradle_touching_after() -> Vec<f64> {
    vec![0.0, 0.0, 1.0]
}

/// Newton's law at both contacts at once: 1 and 2 part at the speed they met with, 2 and 3 go on touching, and momentum
/// stays: (−⅓, ⅔, ⅔). Energy stays too; nothing but the law chooses between both.
pub fn cradle_at_once_after() -> Vec<f64> {
    vec![-1.0 / 3.0, 2.0 / 3.0, 2.0 / 3.0]
}
