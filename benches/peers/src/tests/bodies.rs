//! Each engine gets the same bodies: counts, masses, poses, fall, mixing rules, categories, forces, circles.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

mod common;

use common::{PEERS, after, angle, close, named, scene_of, world};
use lamina::cases::case_error;
use lamina_peers::blueprint::Blueprint;
use lamina_peers::box2d::Box2d;
use lamina_peers::engine::{self, Name, Setup};
use lamina2d::measure::hash_of;
use lamina2d::scene::{BodySpec, Scene, ShapeSpec};
use lamina2d::settings::Settings;
use lamina2d::simulation::simulate;

#[test]
fn bodies_masses_and_poses_are_ours() {
    for name in ["all/12", "rain/30", "tumbler/20", "determinism", "arch"] {
        let scene = named(name);
        let blueprint = Blueprint::of(&scene).unwrap();
        for engine in PEERS {
            let world = world(&scene, engine);
            let (states, masses) = (world.states(), world.masses());
            assert_eq!(states.len(), scene.bodies.len());
            for (body, (state, mass)) in blueprint.bodies.iter().zip(states.iter().zip(masses)) {
                let what = format!("{name}, {engine}");
                close(&what, mass[0], body.mass, 1e-5 * body.mass);
                close(&what, mass[1], body.inertia, 1e-5 * body.inertia);
                for k in 0..2 {
                    let size = 1.0 + body.start.position[k].abs();
                    close(&what, state.position[k], body.start.position[k], 1e-6 * size);
                    close(&what, state.rotation[k], body.start.rotation[k], 1e-6);
                    close(&what, state.velocity[k], body.start.velocity[k], 1e-5);
                }
                close(&what, state.angular_velocity, body.start.angular_velocity, 1e-5);
            }
        }
    }
}

#[test]
fn a_step_of_free_fall() {
    let scene = named("free_flight/9");
    let t = scene.dt_secs;
    for engine in Name::ALL {
        for (state, spec) in after(&scene, engine, 1).iter().zip(&scene.bodies) {
            close("x", state.position[0], spec.position[0] + 3.0 * t, 1e-5);
            // Theirs is of first order: half a substep's share of gt² is missing.
            close("y", state.position[1], spec.position[1] + 20.0 * t - 0.5 * 9.81 * t * t, 4e-4);
            close("vy", state.velocity[1], 20.0 - 9.81 * t, 1e-4);
        }
    }
}

/// How far a run of all the scene's steps is from its closed form.
fn error(scene: &Scene, engine: Name) -> f64 {
    let states = after(scene, engine, scene.steps as usize);
    let t_secs = scene.steps as f64 * scene.dt_secs;
    case_error(scene, t_secs, |k| (states[k].position, states[k].rotation)).unwrap()
}

#[test]
fn a_pair_has_the_smaller_friction_and_restitution() {
    for engine in Name::ALL {
        // The closed form goes by the block's 0.3 and the disc's 0.8.
        let mut slope = named("incline");
        slope.bodies[0].friction = 0.9;
        assert!(error(&slope, engine) < 0.01, "{engine}: friction of the floor");
        let mut floor = named("bounce");
        floor.bodies[0].restitution = 1.0;
        assert!(error(&floor, engine) < 0.1, "{engine}: restitution of the floor");

        let way = |scene: &Scene| after(scene, engine, 120)[1].position;
        let mut block = named("incline");
        (block.bodies[0].friction, block.bodies[1].friction) = (0.3, 0.9);
        for k in 0..2 {
            close("the other way round", way(&block)[k], way(&slope)[k], 1e-4);
        }
    }
}

#[test]
fn categories_that_do_not_collide_pass() {
    let floor = BodySpec::new(ShapeSpec::Box([5.0, 0.5]), [0.0, -0.5]).fixed();
    let ball = BodySpec::new(ShapeSpec::Circle(0.2), [0.0, 1.0]);
    let through = BodySpec { category: 2, ..ball.clone() };
    let scene = scene_of(vec![BodySpec { collides_with: 1, ..floor }, through, ball], Vec::new());
    for engine in Name::ALL {
        let mut scene = scene.clone();
        scene.bodies[2].position[0] = 2.0;
        let states = after(&scene, engine, 90);
        assert!(states[1].position[1] < -2.0, "{engine}: stopped");
        close("stands", states[2].position[1], 0.2, 0.01);
    }
}

#[test]
fn constant_forces_and_torques_act() {
    let mut bar = BodySpec::new(ShapeSpec::Box([0.5, 0.1]), [0.0; 2]).mass(2.0);
    (bar.force, bar.torque) = ([4.0, 2.0 * 9.81], 0.1);
    let scene = scene_of(vec![bar], Vec::new());
    let inertia = Blueprint::of(&scene).unwrap().bodies[0].inertia;
    for engine in Name::ALL {
        let state = after(&scene, engine, 60)[0];
        close("vx", state.velocity[0], 2.0, 1e-3);
        close("vy", state.velocity[1], 0.0, 1e-3);
        close("w", state.angular_velocity, 0.1 / inertia, 1e-3);
    }
}

#[test]
fn driven_bodies_stay_on_their_circles() {
    let scene = named("tumbler/4");
    let radius = |k: usize| scene.bodies[k].position[0].hypot(scene.bodies[k].position[1]);
    for engine in Name::ALL {
        let states = after(&scene, engine, 600);
        for (k, wall) in states[..4].iter().enumerate() {
            close("radius", wall.position[0].hypot(wall.position[1]), radius(k), 1e-4);
            // 10 s at 25° a second.
            close("angle", angle(wall), 250f64.to_radians() - std::f64::consts::TAU, 1e-3);
        }
    }
}

#[test]
fn touching_pairs_are_counted_alike() {
    for engine in Name::ALL {
        let mut world = world(&named("stack/5"), engine);
        world.run(60).unwrap();
        assert_eq!(world.contacts(), 5, "{engine}");
    }
}

#[test]
fn what_rests_sleeps_where_it_may() {
    let scene = named("stack/3");
    for engine in Name::ALL {
        let mut world = engine::build(&scene, Setup::new(engine).sleep()).unwrap();
        world.run(300).unwrap();
        assert_eq!(world.asleep(), 3, "{engine}");
    }
}

#[test]
fn two_threads_change_nothing_of_box2d() {
    let scene = named("rain/60");
    let run = |threads| {
        let mut world = engine::build(&scene, Setup::new(Name::Box2d).threads(threads)).unwrap();
        world.run(90).unwrap();
        world.states()
    };
    assert_eq!(run(1), run(2));
}

#[test]
fn a_row_has_the_librarys_hash() {
    let scene = named("all/20");
    let mut own = simulate(&scene, Settings::default()).unwrap();
    let mut ours = world(&scene, Name::Lamina2d);
    for _ in 0..30 {
        own.step(scene.dt_secs).unwrap();
    }
    ours.run(30).unwrap();
    assert_eq!(hash_of(lamina_peers::row::columns(&ours.states())), own.hash());
}

#[test]
fn box2d_says_itself_whether_it_asserts() {
    assert_eq!(Box2d::asserts(), !env!("PEERS_C_FLAGS").contains("-DNDEBUG"));
}
