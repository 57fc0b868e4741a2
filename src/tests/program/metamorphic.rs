//! Metamorphic tests: a scene changed in a way whose effect is known needs no reference.
//!
//! Powers of two change no mantissa: what is heavier by 2ᵏ, or larger by 4ᵏ and slower by 2ᵏ, moves the same to the last
//! bit unless an engine hides a number with a unit.

#![expect(clippy::unwrap_used, reason = "functions generic over lanes are tests too")]

use lamina::cases::by_name;
use lamina2d::scene::similar::{drifting, enlarged, heavier, mirrored, shifted, turned};
use lamina2d::scene::{Scene, ShapeSpec};
use lamina2d::settings::{Precision, Settings, Skips, Solver};
use lamina2d::simulation::{BodyState, simulate};

/// Stacks, what slides, rolls, topples, bounces, is thrown together.
const SCENES: [&str; 8] = [
    "stack/5",
    "b01_sliding_block",
    "b04_rolling_disc",
    "b13_oblique",
    "b18_offset",
    "b27_dominoes",
    "cards/2",
    "all/40",
];

fn named(name: &str) -> Scene {
    by_name(name, None, 1).unwrap()
}

/// Every solver in both precisions.
fn everywhere() -> impl Iterator<Item = Settings> {
    let of = |&precision: &Precision| {
        let settings = Settings::default().with_precision(precision);
        Solver::ALL.iter().map(move |&solver| Settings { solver, ..settings })
    };
    Precision::ALL.iter().flat_map(of)
}

/// The states after so many steps of the scene's own length.
fn run(scene: &Scene, settings: Settings, steps: u32) -> Vec<BodyState> {
    let mut world = simulate(scene, Settings { dt_secs: scene.dt_secs, ..settings }).unwrap();
    for _ in 0..steps {
        world.step(scene.dt_secs).unwrap();
    }
    world.states()
}

/// The largest difference between states once one has been seen like the other.
fn apart(states: &[BodyState], others: &[BodyState], seen: impl Fn(&BodyState) -> BodyState) -> f64 {
    let row = |s: &BodyState| {
        let ([x, y], [c, r], [vx, vy]) = (s.position, s.rotation, s.velocity);
        [x, y, c, r, vx, vy, s.angular_velocity]
    };
    let of = |(a, b): (&BodyState, &BodyState)| {
        row(a).into_iter().zip(row(&seen(b))).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
    };
    assert_eq!(states.len(), others.len());
    states.iter().zip(others).map(of).fold(0.0, f64::max)
}

/// Below this nothing is held: what is so small in `f32` has no whole mantissa left, or loses it when it is scaled. It is
/// the least normal number times the largest factor between two runs here (2⁴ squared in lengths, 2⁷ in masses).
const LEAST: f64 = f32::MIN_POSITIVE as f64 * 256.0;

/// Holds two runs to each other bit by bit.
#[track_caller]
fn same(
    name: &str,
    settings: Settings,
    states: &[BodyState],
    others: &[BodyState],
    seen: impl Fn(&BodyState) -> BodyState,
) {
    let difference = apart(states, others, seen);
    assert!(difference < LEAST, "{name}, {} in {}: {difference:e}", settings.solver, settings.precision);
}

const STEPS: u32 = 90;

#[test]
fn masses_times_a_power_of_two_change_no_bit() {
    for name in SCENES {
        let scene = named(name);
        for settings in everywhere() {
            let plain = run(&scene, settings, STEPS);
            for k in [-7, 5] {
                same(name, settings, &plain, &run(&heavier(&scene, k), settings, STEPS), |s| *s);
            }
        }
    }
}

#[test]
fn lengths_times_four_and_times_times_two_change_no_bit() {
    for name in SCENES {
        let scene = named(name);
        for settings in everywhere() {
            let plain = run(&scene, settings, STEPS);
            for k in [-3, 4] {
                let (length, time) = (4f64.powi(k), 2f64.powi(k));
                let back = |s: &BodyState| BodyState {
                    position: s.position.map(|x| x / length),
                    velocity: s.velocity.map(|v| v / time),
                    angular_velocity: s.angular_velocity * time,
                    ..*s
                };
                same(name, settings, &plain, &run(&enlarged(&scene, k), settings, STEPS), back);
            }
        }
    }
}

/// But for `avbd`, which solves three equations at once: x before y.
#[test]
fn a_quarter_turn_changes_no_bit() {
    let back = |s: &BodyState| BodyState {
        position: [s.position[1], -s.position[0]],
        velocity: [s.velocity[1], -s.velocity[0]],
        ..*s
    };
    for name in SCENES {
        let scene = named(name);
        for settings in everywhere().filter(|settings| settings.solver != Solver::Avbd) {
            let plain = run(&scene, settings, STEPS);
            same(name, settings, &plain, &run(&turned(&scene), settings, STEPS), back);
        }
    }
}

/// Discs, and boxes that stand straight: to the bit. Where the points of a face come in the other order their sums are
/// rounded otherwise: in `f64` to 1e-6 after 90 steps, where nothing is at the point of toppling.
#[test]
fn a_mirror_changes_signs() {
    let flip = |s: &BodyState| BodyState {
        position: [-s.position[0], s.position[1]],
        rotation: [s.rotation[0], -s.rotation[1]],
        velocity: [-s.velocity[0], s.velocity[1]],
        angular_velocity: -s.angular_velocity,
    };
    for settings in everywhere() {
        for name in ["stack/5", "b04_rolling_disc", "b13_oblique"] {
            let scene = named(name);
            let plain = run(&scene, settings, STEPS);
            same(name, settings, &plain, &run(&mirrored(&scene), settings, STEPS), flip);
        }
        for name in ["b01_sliding_block", "b18_offset"] {
            let scene = named(name);
            let difference =
                apart(&run(&scene, settings, STEPS), &run(&mirrored(&scene), settings, STEPS), flip);
            assert!(
                difference <= 2e-6,
                "{name}, {} in {}: {difference:e}",
                settings.solver,
                settings.precision
            );
        }
    }
}

/// By so much, metres.
const SHIFT_M: [f64; 2] = [256.0, -512.0];

/// What is far away is rounded to the ulp there: 5e-5 m in `f32` and 1e-13 m in `f64` at 512 m. `impulse` alone carries
/// nothing from step to step, and what stands off its middle may tip either way.
#[test]
fn a_shift_costs_a_few_ulp() {
    let back = |s: &BodyState| BodyState {
        position: [s.position[0] - SHIFT_M[0], s.position[1] - SHIFT_M[1]],
        ..*s
    };
    for name in ["stack/5", "b01_sliding_block", "b18_offset"] {
        let scene = named(name);
        for settings in everywhere().filter(|settings| settings.solver != Solver::Impulse) {
            let far = run(&shifted(&scene, SHIFT_M), settings, STEPS);
            let difference = apart(&run(&scene, settings, STEPS), &far, back);
            let bound = if settings.precision == Precision::F32 { 1e-3 } else { 5e-12 };
            assert!(
                difference <= bound,
                "{name}, {} in {}: {difference:e}",
                settings.solver,
                settings.precision
            );
        }
    }
}

/// With everything on its way at 2 m/s a stack stands as it does at rest; the floor is then kinematic.
#[test]
fn a_uniform_velocity_is_not_seen() {
    let scene = named("stack/5");
    let secs = f64::from(STEPS) * scene.dt_secs;
    let back = |s: &BodyState| BodyState {
        position: [s.position[0] - 2.0 * secs, s.position[1]],
        velocity: [s.velocity[0] - 2.0, s.velocity[1]],
        ..*s
    };
    for settings in everywhere() {
        let on_its_way = run(&drifting(&scene, [2.0, 0.0]), settings, STEPS);
        let difference = apart(&run(&scene, settings, STEPS), &on_its_way, back);
        let bound = if settings.precision == Precision::F32 { 3e-5 } else { 5e-14 };
        assert!(difference <= bound, "{} in {}: {difference:e}", settings.solver, settings.precision);
    }
}

/// Two scenes 4 km apart in one world, and each alone: the same bits, whatever the size of the other's bodies: lengths
/// without a scale of their own are shares of the two bodies that meet ([`lamina2d::body::Bodies::length`]). Where manifolds
/// are kept, what moves anywhere decides when impulses are summed anew: the last bits of sums, and no more.
#[test]
fn scenes_far_apart_do_not_see_each_other() {
    let scaled = |by: f64| {
        let mut scene = named("stack/4");
        for body in &mut scene.bodies {
            body.position = body.position.map(|x| x * by);
            body.shape = match &body.shape {
                ShapeSpec::Box(half) => ShapeSpec::Box(half.map(|h| h * by)),
                other => other.clone(),
            };
        }
        shifted(&scene, [4096.0, 0.0])
    };
    for near in ["stack/5", "b01_sliding_block", "b18_offset", "cards/2"].map(named) {
        for far in [1.0, 0.125, 4.0, 32.0].map(scaled) {
            let both =
                Scene { bodies: near.bodies.iter().chain(&far.bodies).cloned().collect(), ..near.clone() };
            for settings in everywhere().map(|settings| Settings { skips: Skips::EXACT, ..settings }) {
                let together = run(&both, settings, STEPS);
                let (first, second) = together.split_at(near.bodies.len());
                same(&near.name, settings, &run(&near, settings, STEPS), first, |s| *s);
                let far = Scene { dt_secs: near.dt_secs, ..far.clone() };
                same("far", settings, &run(&far, settings, STEPS), second, |s| *s);
            }
        }
    }
}
