//! Fast bodies stop at walls; whatever is not fast, or meets nothing, keeps its bits.

use lamina2d::force::Forces;
use lamina2d::scene::{BodyKind, BodySpec, Scene, ShapeSpec, by_name, file};
use lamina2d::settings::{Precision, Settings, Solver};
use lamina2d::simulation::Simulation;

use crate::shared_motion::{at_every_width, scene_of, start};

const DT_SECS: f64 = 1.0 / 60.0;

fn named(name: &str) -> Scene {
    by_name(name, None, 1).expect("a named scene")
}

fn run(scene: &Scene, settings: Settings, steps: usize) -> Box<dyn Simulation> {
    let mut world = start(scene, settings);
    for _ in 0..steps {
        world.step(DT_SECS).expect("stays finite");
    }
    world
}

/// Every solver in both precisions.
fn every_solver() -> impl Iterator<Item = Settings> {
    Precision::ALL.iter().flat_map(|&precision| {
        let of = move |&solver: &Solver| Settings { solver, ..Settings::default().with_precision(precision) };
        Solver::ALL.iter().map(of)
    })
}

/// Projectiles and walls in turn, as in `bullet` and `bullets`: does the k-th projectile end before its wall?
fn held(world: &dyn Simulation) -> Vec<bool> {
    world.states().chunks(2).map(|shot| shot[0].position[0] < shot[1].position[0]).collect()
}

#[test]
fn bullets_stop_at_their_walls() {
    for settings in every_solver() {
        for name in ["bullet", "bullets"] {
            let scene = named(name);
            let through = run(&scene, Settings { continuous: false, ..settings }, 60);
            assert!(held(&*through).iter().all(|held| !held), "{name}: slow enough without");
            let mut world = start(&scene, settings);
            for step in 0..60 {
                world.step(DT_SECS).expect("stays finite");
                let overlap = world.penetration().max;
                assert!(overlap < 0.01, "{name} {settings:?}: {overlap} m in step {step}");
            }
            assert!(held(&*world).iter().all(|held| *held), "{name} {settings:?}: {:?}", world.states());
        }
    }
}

/// A projectile of each kind, turning or not, against a wall, at places all along a step's stride.
#[test]
fn nothing_passes_wherever_its_steps_end() {
    let wedge = ShapeSpec::Polygon(vec![[0.2, 0.0], [-0.1, 0.1], [-0.1, -0.1]]);
    let sliver = ShapeSpec::Polygon(vec![[0.4, 0.0], [-0.2, 0.01], [-0.2, -0.01]]);
    let shapes = [
        (ShapeSpec::Circle(0.1), 200.0),
        (wedge, 200.0),
        (sliver, 100.0),
        (ShapeSpec::Box([0.01, 0.5]), 100.0),
    ];
    for (shape, speed) in shapes {
        for spin in [0.0, -7.0, 60.0] {
            for place in 0..20 {
                let x = 6.0 + f64::from(place) / 20.0 * speed * DT_SECS;
                let wall = BodySpec::new(ShapeSpec::Box([0.05, 4.0]), [x, 0.0]).fixed();
                let shot = BodySpec::new(shape.clone(), [0.0; 2]).moving([speed, 0.0], spin);
                let world = run(&scene_of(vec![shot, wall], Forces::default()), Settings::default(), 30);
                assert!(held(&*world)[0], "{shape:?} at {spin} rad/s through a wall at {x}");
            }
        }
    }
}

/// A wall that comes: kinematic bodies are met where they will be, and turning ones too.
#[test]
fn moving_walls_are_met() {
    for velocity in [[-50.0, 0.0], [30.0, 0.0]] {
        let wall =
            BodySpec { kind: BodyKind::Kinematic, ..BodySpec::new(ShapeSpec::Box([0.05, 4.0]), [6.0, 0.0]) }
                .moving(velocity, 0.0);
        let shot = BodySpec::new(ShapeSpec::Circle(0.1), [0.0; 2]).moving([200.0, 0.0], 0.0);
        let world = run(&scene_of(vec![shot, wall], Forces::default()), Settings::default(), 20);
        assert!(held(&*world)[0], "{velocity:?}: {:?}", world.states());
    }
}

/// 1 mm beside a wall's end, above and below it and along it: as if there were no wall.
#[test]
fn a_bullet_that_passes_beside_a_wall_keeps_its_bits() {
    for settings in at_every_width(Settings::default()) {
        for shape in [ShapeSpec::Circle(0.1), ShapeSpec::Box([0.1, 0.1])] {
            for (half, at) in
                [([0.05, 2.0], [5.0, 2.101]), ([2.0, 0.05], [5.0, -0.151]), ([0.5, 0.05], [5.0, 0.151])]
            {
                let shot = BodySpec::new(shape.clone(), [0.0; 2]).moving([200.0, 0.0], 0.0);
                let wall = BodySpec::new(ShapeSpec::Box(half), at).fixed();
                let forces = Forces { gravity: Some([0.0, 0.0]), ..Forces::default() };
                let free = run(&scene_of(vec![shot.clone()], forces), settings, 20);
                let past = run(&scene_of(vec![shot, wall], forces), settings, 20);
                assert_eq!(free.states()[0], past.states()[0], "{settings:?} wall at {at:?}");
            }
        }
    }
}

#[test]
fn filters_hold_for_fast_bodies() {
    let mut scene = named("bullet");
    scene.bodies[1].category = 2;
    scene.bodies[0].collides_with = 1;
    assert_eq!(held(&*run(&scene, Settings::default(), 60)), [false]);
}

#[test]
fn no_width_moves_a_bit_of_a_bullet() {
    let rain = by_name("rain", Some(60), 1).expect("a named scene");
    let fast =
        Scene {
            bodies: rain
                .bodies
                .iter()
                .map(|b| {
                    if b.kind == BodyKind::Dynamic {
                        b.clone().moving([30.0, -90.0], 20.0)
                    } else {
                        b.clone()
                    }
                })
                .collect(),
            ..rain
        };
    for scene in [named("bullet"), named("bullets"), fast] {
        for &precision in Precision::ALL {
            let by =
                |&lanes: &usize| run(&scene, Settings { precision, lanes, ..Settings::default() }, 60).hash();
            let hashes: Vec<_> = Settings::widths(precision).iter().map(by).collect();
            assert!(hashes.iter().all(|hash| *hash == hashes[0]), "{}: {hashes:?}", scene.name);
        }
    }
}

#[test]
fn scenes_without_fast_bodies_keep_their_bits() {
    for name in ["polygons/40", "stack/10", "columns/10", "circles_confined", "arch"] {
        let hash = |continuous| run(&named(name), Settings { continuous, ..Settings::default() }, 120).hash();
        assert_eq!(hash(true), hash(false), "{name}");
    }
}

/// The list of fast bodies is as long as it ever gets after the first step; stopping them takes no memory.
#[test]
fn stopping_fast_bodies_allocates_nothing() {
    let mut bodies = Vec::new();
    for k in 0..20 {
        let y = f64::from(k);
        let shot = BodySpec::new(ShapeSpec::Circle(0.1), [0.3 * y, y]).moving([200.0, 0.0], 0.0);
        bodies.push(shot.surface(1.0, 0.0));
    }
    for x in [-3.0, 63.0] {
        bodies.push(BodySpec::new(ShapeSpec::Box([0.05, 40.0]), [x, 0.0]).surface(1.0, 0.0).fixed());
    }
    let mut world = start(&scene_of(bodies, Forces::default()), Settings::default());
    let mut steps = |count: usize| {
        allocation_counter::measure(|| {
            for _ in 0..count {
                world.step(DT_SECS).expect("stays finite");
            }
        })
        .count_total
    };
    let before = steps(240);
    assert_eq!(steps(60), 0, "{before} before");
    let states = world.states();
    assert!(states[..20].iter().all(|s| s.position[0] > -3.0 && s.position[0] < 63.0), "{states:?}");
    assert!(states[..20].iter().all(|s| s.velocity[0].abs() > 150.0), "still fast: {states:?}");
}

#[test]
fn scene_files_say_whether_fast_bodies_stop() {
    for (text, expected) in [("", true), ("[settings]\ncontinuous = false\n", false)] {
        assert_eq!(file::parse("s.toml", text).expect("good").1.continuous, expected);
    }
    let message = file::parse("s.toml", "[settings]\ncontinuous = 3\n").expect_err("a number").to_string();
    assert!(message.contains("continuous") && message.contains("boolean"), "{message}");
}
