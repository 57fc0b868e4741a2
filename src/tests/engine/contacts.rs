//! Contacts against mechanics: what rests, slides, bounces and is carried, with the default solver and settings.

use lamina2d::force::Forces;
use lamina2d::scene::{BodySpec, Scene, ShapeSpec, by_name};
use lamina2d::settings::{Precision, Settings, Skip, Skips, Solver};
use lamina2d::simulation::{BodyState, Simulation};

use crate::shared_motion::{disc, scene_of, start};

const G: f64 = 9.81;
const DT_SECS: f64 = 1.0 / 60.0;

fn named(name: &str) -> Scene {
    by_name(name, None, 1).expect("a named scene")
}

fn step(world: &mut dyn Simulation, steps: usize) {
    for _ in 0..steps {
        world.step(DT_SECS).expect("stays finite");
    }
}

/// Root of the mean square speed of bodies that move, m/s.
fn rms_speed(states: &[BodyState]) -> f64 {
    let squares = states.iter().map(|s| s.velocity[0].powi(2) + s.velocity[1].powi(2));
    (squares.sum::<f64>() / states.len() as f64).sqrt()
}

/// Total mechanical energy, J.
fn energy(world: &dyn Simulation) -> f64 {
    let now = world.invariants();
    now.kinetic_energy + now.potential_energy
}

/// Ten boxes of 1 kg at rest: jitter, and Σmg in each contact (CASES.md B18).
#[test]
fn a_stack_of_ten_rests_and_each_contact_carries_what_lies_above() {
    for precision in [Precision::F32, Precision::F64] {
        let settings = Settings::default().with_precision(precision);
        let mut world = start(&named("stack/10"), settings);
        step(&mut *world, 600);
        let jitter = rms_speed(&world.states());
        assert!(jitter < 1e-4, "{jitter} m/s in {precision}");
        let contacts = world.contacts();
        assert_eq!(contacts.len(), 10);
        for contact in contacts {
            let above = 11.0 - f64::from(contact.b.max(contact.a) - 1);
            let per_sec = f64::from(settings.substeps) / DT_SECS;
            let force = contact.points.iter().map(|p| p.impulse).sum::<f64>() * per_sec;
            let error = (force / (above * G) - 1.0).abs();
            assert!(error < 1e-3, "{force} N under {above} boxes in {precision}: off by {error}");
        }
    }
}

/// The sag of a stack is Σ N/(2·m_eff·ω²) per contact with ω = 2π·0.18/h: the load error substeps shrink by h².
#[test]
fn the_sag_of_a_stack_is_that_of_its_springs_and_shrinks_with_the_square_of_the_substep() {
    for substeps in [4, 8, 16] {
        let mut world = start(&named("stack/10"), Settings { substeps, ..Settings::default() });
        step(&mut *world, 600);
        let omega = std::f64::consts::TAU * 0.18 * f64::from(substeps) / DT_SECS;
        let contacts = world.contacts();
        let (depth, expected) = contacts.iter().fold((0.0, 0.0), |(depth, expected), contact| {
            let above = 11.0 - f64::from(contact.b.max(contact.a) - 1);
            let grounded = contact.a.min(contact.b) == 1;
            // 1/m_eff at a corner of a 1 kg box, arm 0.5 m, inertia 1/6: 1 + 0.25·6 for each body that moves.
            let yields = if grounded { 2.5 } else { 5.0 };
            let own = -contact.points.iter().map(|p| p.separation).sum::<f64>() / contact.points.len() as f64;
            (depth + own, expected + above * G / 2.0 * yields / (2.0 * omega * omega))
        });
        assert!((depth / expected - 1.0).abs() < 0.02, "{substeps} substeps: {depth} m for {expected} m");
    }
}

/// Columns that must stand for 60 s.
#[test]
fn columns_stand_for_a_minute() {
    for (name, substeps, sway_m) in
        [("stack/20", 4, 1e-6), ("stack/40", 4, 1e-6), ("stack/80", 8, 1e-6), ("columns/15", 4, 1e-2)]
    {
        let scene = named(name);
        let mut world = start(&scene, Settings { substeps, ..Settings::default() });
        step(&mut *world, 3600);
        let states = world.states();
        let sway = states.iter().map(|s| s.position[0].abs()).fold(0.0, f64::max);
        assert!(
            sway < sway_m + 1e-2 * f64::from(u8::from(name.starts_with("columns"))),
            "{name}: sways {sway} m"
        );
        let (top, was) = (states.last().expect("a box"), scene.bodies.last().expect("a box"));
        let sunk = was.position[1] - top.position[1];
        assert!((0.0..0.15).contains(&sunk), "{name} at {substeps} substeps: top sank {sunk} m");
        assert!(rms_speed(&states) < 1e-4, "{name}: {} m/s", rms_speed(&states));
    }
}

/// One hundred times its own weight on a box overlaps by less than 1 % of its size; an arch and a house of
/// cards stand.
#[test]
fn heavy_bodies_arches_and_cards_hold() {
    for (name, deepest_m, sinks_m) in
        [("heavy/100", 0.01, 0.02), ("arch", 0.005, 0.03), ("cards/3", 1e-3, 5e-3)]
    {
        let scene = named(name);
        let mut world = start(&scene, Settings::default());
        step(&mut *world, 3600);
        let penetration = world.penetration();
        assert!(penetration.max < deepest_m, "{name} overlaps by {} m", penetration.max);
        let (top, was) = (*world.states().last().expect("a body"), scene.bodies.last().expect("a body"));
        let sunk = was.position[1] - top.position[1];
        assert!(sunk < sinks_m, "{name}: the last body sank {sunk} m");
        assert!(rms_speed(&world.states()) < 1e-3, "{name} still moves at {}", rms_speed(&world.states()));
    }
}

/// A box on a fixed slope of angle θ with μ = 0.5, where it touches down without falling.
fn slope(tan: f64) -> Scene {
    let angle = tan.atan();
    let (s, c) = angle.sin_cos();
    let ramp = BodySpec::new(ShapeSpec::Box([50.0, 0.5]), [0.5 * s, -0.5 * c])
        .turned(angle)
        .surface(0.0, 0.5)
        .fixed();
    let block = BodySpec::new(ShapeSpec::Box([0.5, 0.25]), [-0.25 * s, 0.25 * c])
        .turned(angle)
        .surface(0.0, 0.5)
        .mass(1.0);
    scene_of(vec![ramp, block], Forces::gravity())
}

/// CASES.md B2 and B3: below the limit nothing creeps, above it slides with g(sin θ − μ cos θ).
#[test]
fn a_block_sticks_below_the_limit_of_friction_and_slides_above_it() {
    let along = |state: &BodyState, tan: f64| {
        let (s, c) = tan.atan().sin_cos();
        state.position[0] * c + state.position[1] * s
    };
    for precision in [Precision::F32, Precision::F64] {
        let settings = Settings::default().with_precision(precision);
        let tan = 0.99 * 0.5;
        let mut world = start(&slope(tan), settings);
        step(&mut *world, 120);
        let before = along(&world.states()[1], tan);
        step(&mut *world, 1200);
        let creep = (along(&world.states()[1], tan) - before).abs() / 20.0;
        assert!(creep < 1e-6, "creeps at {creep} m/s in {precision}");

        let tan = 1.01 * 0.5;
        let mut world = start(&slope(tan), settings);
        let mut speed_after = |steps| {
            step(&mut *world, steps);
            let state = world.states()[1];
            state.velocity[0].hypot(state.velocity[1])
        };
        let speed = -speed_after(60) + speed_after(120);
        let (s, c) = tan.atan().sin_cos();
        let expected = G * (s - 0.5 * c) * 2.0;
        assert!(
            (speed / expected - 1.0).abs() < 0.02,
            "slides at {speed}, not {expected} m/s, in {precision}"
        );
    }
}

/// The highest points between bounces of a disc of 0.25 m dropped from 2 m, metres above where it touches.
fn heights(restitution: f64, bounces: usize, precision: Precision) -> Vec<f64> {
    let floor = BodySpec::new(ShapeSpec::Box([10.0, 0.5]), [0.0, -0.5]).surface(1.0, 0.5).fixed();
    let ball = BodySpec::new(ShapeSpec::Circle(0.25), [0.0, 2.25]).surface(restitution, 0.5).mass(1.0);
    let mut world =
        start(&scene_of(vec![floor, ball], Forces::gravity()), Settings::default().with_precision(precision));
    let mut heights = Vec::new();
    let mut rising = false;
    for _ in 0..20_000 {
        step(&mut *world, 1);
        let ball = world.states()[1];
        let vy = ball.velocity[1];
        if rising && vy <= 0.0 {
            // The top lay between two steps: v²/2g above where it is now.
            heights.push(ball.position[1] - 0.25 + vy * vy / (2.0 * G));
            if heights.len() == bounces {
                break;
            }
        }
        rising = vy > 0.0;
    }
    heights
}

/// CASES.md B10, B11: e = 1 loses less than 1e-3 of its height per bounce, e = 0.5 reaches e²ⁿ·H.
#[test]
fn balls_bounce_as_high_as_their_restitution_says() {
    for precision in [Precision::F32, Precision::F64] {
        let elastic = heights(1.0, 50, precision);
        assert_eq!(elastic.len(), 50, "the ball stopped in {precision}");
        for (n, pair) in elastic.windows(2).enumerate() {
            let lost = 1.0 - pair[1] / pair[0];
            assert!(lost.abs() < 1e-3, "bounce {n}: {lost} of {} m in {precision}", pair[0]);
        }
        for (n, height) in (1..).zip(heights(0.5, 3, precision)) {
            let expected = 2.0 * 0.25_f64.powi(n);
            assert!((height - expected).abs() < 1e-3 * expected.max(1.0), "{n}: {height} for {expected} m");
        }
    }
}

/// Falling, meeting and coming to rest, a pile never has more energy than it began with.
#[test]
fn no_pile_gains_energy() {
    for name in ["circles/60", "polygons/60", "all/60", "pyramid/10", "head_on/20"] {
        for solver in [Solver::Soft, Solver::Pgs] {
            let mut world = start(&named(name), Settings { solver, ..Settings::default() });
            let begun = energy(&*world);
            let scale = world.invariants().kinetic_energy.max(begun.abs());
            for _ in 0..300 {
                step(&mut *world, 1);
                let more = energy(&*world) - begun;
                assert!(more <= 1e-4 * scale, "{name}, {solver}: {more} J more than {begun} J");
            }
        }
    }
}

/// A settled pile with and without reused manifolds: overlaps agree within the stated bound of reuse, 4·CONTACT_REUSE_DISTANCE·radius.
#[test]
fn reused_manifolds_keep_overlaps_within_their_bound() {
    for name in ["stack/10", "polygons/60", "all/60"] {
        let by = |skips| {
            let mut world = start(&named(name), Settings { skips, ..Settings::default() });
            step(&mut *world, 900);
            (world.penetration().max, rms_speed(&world.states()), world.counts())
        };
        let (with, without) = (by(Skips::ALL), by(Skips::ALL.without(Skip::ManifoldReuse)));
        assert!(with.2.skipped[Skip::ManifoldReuse as usize] > 0, "{name} reuses nothing");
        assert_eq!(without.2.skipped[Skip::ManifoldReuse as usize], 0);
        let bound = 4.0 * lamina2d::internals::CONTACT_REUSE_DISTANCE * 0.7;
        assert!((with.0 - without.0).abs() < bound, "{name}: {} m and {} m", with.0, without.0);
        assert!(with.1 < 1e-2, "{name} does not rest: {} m/s", with.1);
    }
}

/// Friction takes a sliding disc to rolling: v = ⅔v₀ after v₀/3μg (CASES.md B5).
#[test]
fn a_sliding_disc_ends_rolling_at_two_thirds_of_its_speed() {
    let floor = BodySpec::new(ShapeSpec::Box([60.0, 0.5]), [0.0, -0.5]).surface(0.0, 0.5).fixed();
    let ball = BodySpec { position: [0.0, 0.1], ..disc([0.0; 2]) }.moving([3.0, 0.0], 0.0).surface(0.0, 0.5);
    let ShapeSpec::Circle(radius) = ball.shape else { unreachable!("a disc") };
    let ball = BodySpec { position: [0.0, radius], ..ball };
    let mut world = start(&scene_of(vec![floor, ball], Forces::gravity()), Settings::default());
    step(&mut *world, 60);
    let state = world.states()[1];
    assert!((state.velocity[0] / 2.0 - 1.0).abs() < 2e-3, "{} m/s", state.velocity[0]);
    assert!((-state.angular_velocity * radius / state.velocity[0] - 1.0).abs() < 1e-3);
}
