//! Named scenes as they begin: counts, no overlap, what touches; and bodies that go round a pivot.

#![expect(clippy::unwrap_used, reason = "functions generic over lanes are tests too")]

use std::f64::consts::TAU;

use lamina2d::body::BodyId;
use lamina2d::force::Forces;
use lamina2d::lanes::{Lanes, Real, f32s, f64s};
use lamina2d::scene::{BodyKind, BodySpec, SCENES, Scene, ShapeSpec, by_name, file};
use lamina2d::settings::{Precision, Settings, Solver};
use lamina2d::simulation::simulate;
use lamina2d::world::World;
use serde::Serialize;

use crate::shared_motion::{at_every_width, disc, scene_of, start};
use crate::shared_scenes as scenes;

const DT_SECS: f64 = 1.0 / 60.0;

fn named(name: &str) -> Scene {
    by_name(name, None, 1).unwrap()
}

fn in_f64() -> Settings {
    Settings::default().with_precision(Precision::F64)
}

/// A world that has looked for contacts and not had the time to move.
fn begun(name: &str) -> World<f64s::X4> {
    let mut world = World::from_scene(&named(name), in_f64()).unwrap();
    world.step(1e-12).unwrap();
    world
}

#[test]
fn scenes_have_the_bodies_they_are_documented_with() {
    for (name, movable, fixed) in [
        ("pyramid", 5050, 1),
        ("pyramid/1", 1, 1),
        ("pyramid/7", 28, 1),
        ("pyramids", 5500, 10),
        ("pyramids/1", 55, 1),
        ("pyramids/3", 165, 2),
        ("stack", 10, 1),
        ("columns", 40, 1),
        ("heavy", 2, 1),
        ("sizes", 6, 1),
        ("two_feet", 3, 1),
        ("arch", 21, 3),
        ("cards", 26, 1),
        ("cards/1", 2, 1),
        ("cards/5", 40, 1),
        ("dominoes", 30, 1),
        ("rain", 1000, 3),
        ("tumbler", 2004, 0),
        ("spinner", 2001, 4),
        ("bullet", 1, 1),
        ("bullets", 3, 3),
        ("circles_confined", 625, 4),
        ("chain", 30, 1),
        ("chain/1", 1, 1),
        ("bridge", 40, 2),
        ("joint_grid", 398, 2),
        ("joint_grid/1", 0, 1),
        ("joint_grid/2", 2, 2),
        ("pendulum", 1, 1),
        ("spin", 3, 0),
        ("slide", 1, 1),
        ("incline", 1, 1),
        ("roll", 1, 1),
        ("slide_to_roll", 1, 1),
        ("bounce", 1, 1),
        ("rod_hit", 2, 0),
    ] {
        let scene = named(name);
        assert_eq!((scene.movable(), scene.bodies.len()), (movable, movable + fixed), "{name}");
    }
}

#[test]
fn every_scene_is_taken_in_and_nothing_overlaps_at_first() {
    scenes::are_taken_in_and_overlap_nowhere(SCENES);
}

#[test]
fn seeds_choose_what_is_random_and_nothing_else() {
    scenes::differ_by_seed_where_random(SCENES);
}

#[test]
fn parameters_beyond_a_million_bodies_are_refused_by_scene_and_limit() {
    for (name, limit) in [("pyramid", 1413), ("pyramids", 18_000), ("cards", 816), ("rain", 1_000_000)] {
        let beyond = limit + 1;
        let message = by_name(&format!("{name}/{beyond}"), None, 1).unwrap_err().to_string();
        for part in [format!("'{name}'"), format!("1 to {limit}"), format!("'{beyond}'")] {
            assert!(message.contains(&part), "{message} without {part}");
        }
        let message = by_name(name, Some(beyond), 1).unwrap_err().to_string();
        assert_eq!(message, format!("scene '{name}': bodies must be 1 to {limit}, got {beyond}"));
    }
    let message = by_name("arch/3", None, 1).unwrap_err().to_string();
    assert_eq!(message, "scene 'arch' takes nothing after the slash, got '3'");
}

/// Each box of a pyramid rests on two, with both points of either face; gaps are those a step later.
#[test]
fn rows_of_a_pyramid_touch() {
    let world = begun("pyramid/6");
    let touching: Vec<_> = world.contacts().into_iter().filter(|c| c.normal[1].abs() > 0.5).collect();
    assert_eq!(touching.len(), 6 + 2 * 15, "six on the floor, fifteen on two each");
    for contact in &touching {
        assert!(contact.points.len() == 2 && contact.points.iter().all(|p| p.separation.abs() < 1e-4));
    }
}

/// Joints of the arch are faces; cards touch at corners, or are as far apart as they are said to be.
#[test]
fn arch_and_cards_touch_where_they_should() {
    let arch = begun("arch").contacts();
    assert_eq!(arch.len(), 18 + 4, "joints, boxes");
    for point in arch.iter().flat_map(|c| &c.points) {
        assert!(point.separation.abs() < 1e-14, "{point:?}");
    }
    assert!(arch.iter().all(|c| c.points.len() == 2));
    let near = |c: &&lamina2d::contact::Contact| c.points.iter().any(|p| p.separation.abs() < 1e-15);
    let cards = begun("cards/3").contacts();
    // Twelve feet, six pairs leaning, and per lying card: both cards of an outer pair, one of an inner.
    assert_eq!(cards.iter().filter(near).count(), 12 + 6 + (3 + 3) + 4);
}

/// With steps small enough for any solver: what statics lets stand, stands.
#[test]
fn what_is_to_stand_stands() {
    let settings = Settings { solver: Solver::Pgs, substeps: 8, ..in_f64() };
    for name in ["arch", "cards/3", "columns/5", "pyramid/5", "two_feet", "heavy/10"] {
        let mut world = start(&named(name), settings);
        let before = world.states();
        for _ in 0..480 {
            world.step(1.0 / 240.0).unwrap();
        }
        for (a, b) in before.iter().zip(world.states()) {
            let drift = (b.position[0] - a.position[0]).hypot(b.position[1] - a.position[1]);
            assert!(drift < 1e-3, "{name}: {drift} m");
        }
    }
}

/// Steps of 1/60 s set a projectile down before its wall and behind it, never in it: it passes unless it is stopped.
#[test]
fn bullets_pass_their_walls_between_two_steps() {
    for scene in [named("bullet"), named("bullets")] {
        for continuous in [false, true] {
            let mut world = start(&scene, Settings { continuous, ..in_f64() });
            for _ in 0..scene.steps {
                world.step(DT_SECS).unwrap();
            }
            for shot in world.states().chunks(2) {
                let stopped = shot[0].position[0] < shot[1].position[0];
                assert_eq!(stopped, continuous, "{}: {shot:?}", scene.name);
            }
        }
        for shot in scene.bodies.chunks(2) {
            let reach = shot[0].shape.build().unwrap().bounding_radius() + 0.05;
            let gap =
                |step: u64| (shot[0].velocity[0] * DT_SECS * step as f64 - shot[1].position[0]).abs() - reach;
            assert!((0..scene.steps).all(|step| gap(step) > 0.0), "{shot:?}");
            assert!((0..scene.steps).any(|step| gap(step) < 2.0), "it gets there: {shot:?}");
        }
    }
}

/// The k-th wall of the tumbler, alone in the world.
fn wall(k: usize) -> BodySpec {
    named("tumbler").bodies[k].clone()
}

/// Held to the circle after 10,000 steps: where it should be, as it should be turned.
fn stays_on_its_circle<L: Lanes>() {
    for spec in [wall(0), wall(3), BodySpec { angular_velocity: -40.0, angle: 2.0, ..wall(1) }] {
        let mut world = World::<L>::from_scene(
            &scene_of(vec![spec.clone()], Forces::gravity()),
            Settings { substeps: 3, ..Settings::default() },
        )
        .unwrap();
        let [px, py] = spec.pivot.unwrap();
        let (arm_x, arm_y) = (spec.position[0] - px, spec.position[1] - py);
        let radius = arm_x.hypot(arm_y);
        for _ in 0..10_000 {
            world.step(DT_SECS).unwrap();
        }
        let turned = (spec.angular_velocity * DT_SECS * 10_000.0) % TAU;
        let (s, c) = turned.sin_cos();
        let bodies = world.bodies();
        let [x, y] = [bodies.x[1].to_f64() - px, bodies.y[1].to_f64() - py];
        assert!((x.hypot(y) / radius - 1.0).abs() < 1e-5, "radius {} of {radius}", x.hypot(y));
        let off = (x - (c * arm_x - s * arm_y)).hypot(y - (s * arm_x + c * arm_y));
        assert!(off < 1e-5 * radius, "{off} m from its place");
        let (s, c) = (turned + spec.angle).sin_cos();
        let off = (bodies.c[1].to_f64() - c).hypot(bodies.s[1].to_f64() - s);
        assert!(off < 1e-5, "{off} rad from its attitude");
    }
}

#[test]
fn driven_bodies_stay_on_their_circles() {
    stays_on_its_circle::<f32s::X8>();
    stays_on_its_circle::<f64s::X4>();
}

#[test]
fn driven_bodies_move_alike_at_every_width_and_under_every_step() {
    let scene = by_name("tumbler", Some(40), 1).unwrap();
    let end = |settings: Settings| {
        let mut world = start(&scene, settings);
        for k in 0..120 {
            world.step(if k % 3 == 0 { 0.5 * DT_SECS } else { DT_SECS }).unwrap();
        }
        (world.hash(), world.states())
    };
    for settings in at_every_width(Settings::default()) {
        let lanes = Settings::default().with_precision(settings.precision).lanes;
        let (hash, states) = end(settings);
        assert_eq!(hash, end(Settings { lanes, ..settings }).0, "{settings:?}");
        let turned = 25f64.to_radians() * 100.0 * DT_SECS;
        for (state, spec) in states.iter().zip(&scene.bodies[..4]) {
            let expected = glam::DVec2::from_angle(turned).rotate(spec.position.into());
            assert!(expected.distance(state.position.into()) < 1e-5, "steps of two lengths: {state:?}");
        }
    }
}

#[test]
fn a_driven_body_has_its_velocity_before_the_first_step_and_other_settings_keep_its_circle() {
    let spec = BodySpec::new(ShapeSpec::Circle(0.5), [3.0, 1.0]).about([1.0, 1.0]).moving([0.0; 2], 2.0);
    let mut world = start(&scene_of(vec![spec], Forces::default()), in_f64());
    assert_eq!(world.states()[0].velocity, [0.0, 4.0]);
    world.step(DT_SECS).unwrap();
    let mut other = world.with_settings(Settings { substeps: 4, ..in_f64() }).unwrap();
    for _ in 0..100 {
        world.step(DT_SECS).unwrap();
        other.step(DT_SECS).unwrap();
    }
    for world in [world, other] {
        let [x, y] = world.states()[0].position;
        let (s, c) = (2.0 * 101.0 * DT_SECS).sin_cos();
        assert!((x - 1.0 - 2.0 * c).hypot(y - 1.0 - 2.0 * s) < 1e-12, "{x} {y}");
    }
}

/// Removed and its slot filled again: the new body goes straight on. Written over by hand: it comes back.
#[test]
fn a_circle_goes_with_its_body() {
    let mut world = World::<f32s::X8>::from_scene(
        &scene_of(vec![wall(0), wall(1)], Forces::default()),
        Settings::default(),
    )
    .unwrap();
    let id = |world: &World<f32s::X8>, slot| -> BodyId { world.bodies().id(slot).unwrap() };
    let bytes = world.bodies().bytes();
    world.remove(id(&world, 1)).unwrap();
    assert_eq!(world.bodies().bytes(), bytes - 72);
    let straight = BodySpec { kind: BodyKind::Kinematic, ..disc([0.0; 2]) }.moving([1.0, 0.0], 3.0);
    assert_eq!(world.insert(&straight).unwrap().slot(), 1);
    world.bodies_mut().x[2] = 99.0;
    for _ in 0..60 {
        world.step(DT_SECS).unwrap();
    }
    let bodies = world.bodies();
    assert!((bodies.x[1] - 1.0).abs() < 1e-5 && bodies.y[1] == 0.0, "{} {}", bodies.x[1], bodies.y[1]);
    let [x, y] = wall(1).position;
    assert!((f64::from(bodies.x[2]).hypot(bodies.y[2].into()) - x.hypot(y)).abs() < 1e-4);
}

#[test]
fn bad_pivots_are_refused_by_body_field_and_value() {
    let good = BodySpec::new(ShapeSpec::Circle(0.5), [3.0, 0.0]).about([0.0; 2]).moving([0.0; 2], 2.0);
    let refused = |bad: BodySpec| {
        let mut world = World::<f32s::X8>::new(Forces::default(), Settings::default()).unwrap();
        world.insert(&good).unwrap();
        let bytes = world.bodies().bytes();
        let message = world.insert(&bad).unwrap_err().to_string();
        assert_eq!((world.bodies().live(), world.bodies().bytes()), (1, bytes), "nothing has changed");
        message
    };
    let of_kind = |kind| BodySpec { kind, angular_velocity: 0.0, ..good.clone() };
    let at = |pivot| BodySpec { pivot: Some(pivot), ..good.clone() };
    let only = "only a kinematic body goes round a pivot, this one is";
    for (bad, message) in [
        (of_kind(BodyKind::Dynamic), format!("{only} dynamic; make it kinematic")),
        (of_kind(BodyKind::Static), format!("{only} static; make it kinematic")),
        (at([f64::NAN, 0.0]), "pivot is not finite in this precision: NaN".into()),
        (at([0.0, f64::NEG_INFINITY]), "pivot is not finite in this precision: -inf".into()),
        (at([0.0, 1e39]), format!("pivot is not finite in this precision: {:?}", 1e39)),
        (
            at([1e16, 0.0]),
            "pivot must be less than 1e15 (f32) or 1e97 (f64) from the origin, got 1e16".into(),
        ),
        (
            BodySpec { velocity: [0.0, 1.5], ..good.clone() },
            "its pivot and angular_velocity give its velocity; leave out velocity, got 1.5".into(),
        ),
        (
            BodySpec { angular_velocity: 2e38, ..good.clone() },
            format!("velocity round the pivot is not finite in this precision: {:?}", 6e38),
        ),
    ] {
        assert_eq!(refused(bad), format!("body 1: {message}"));
    }
}

#[test]
fn pivots_are_written_to_files_and_read_from_them() {
    #[derive(Serialize)]
    struct File {
        body: Vec<BodySpec>,
    }
    let bodies = vec![wall(0), disc([1.0, 2.0]), wall(1)];
    let text = toml::to_string(&File { body: bodies.clone() }).unwrap();
    assert_eq!(text.matches("pivot").count(), 2, "{text}");
    let (scene, settings) = file::parse("s.toml", &text).unwrap();
    assert_eq!(scene.bodies, bodies);
    assert!(simulate(&scene, settings).is_ok());
    let arm = "[[body]]\nshape = { circle = 1.0 }\nposition = [2, 0]\nkind = \"kinematic\"\n";
    let (scene, _) = file::parse("s.toml", &format!("{arm}pivot = [0, 1]\n")).unwrap();
    assert_eq!(scene.bodies[0].pivot, Some([0.0, 1.0]));
    let message = file::parse("s.toml", &format!("{arm}pivot = [0, 1, 2]\n")).unwrap_err().to_string();
    assert!(message.contains("expected two numbers [x, y], got 3"), "{message}");
}
