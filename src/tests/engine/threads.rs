//! Threads change no bit of a result, whatever a world is made of and whatever is done to it.

use lamina2d::force::Forces;
use lamina2d::scene::{BodyKind, BodySpec, Scene, ShapeSpec, by_name};
use lamina2d::settings::{Broad, Precision, Settings, Skips, Solver, Threads};
use lamina2d::simulation::Simulation;

use crate::shared_motion::{DT_SECS, scatter, scene_of, start};

/// Threads beside one, each with another number of lanes: none of both says anything.
const THREADS: [(usize, usize); 4] = [(2, 8), (3, 1), (4, 4), (16, 16)];

/// Holds a scene to the bits of one thread, every eighth step.
fn hold(scene: &Scene, settings: Settings, steps: usize) {
    let mut alone = start(scene, settings);
    let mut worlds = THREADS.map(|(threads, lanes)| {
        let lanes = if settings.precision == Precision::F64 { 4 } else { lanes };
        let settings = Settings { threads: Threads::Exactly(threads), lanes, ..settings };
        (threads, start(scene, settings))
    });
    for step in 0..steps {
        alone.step(DT_SECS).expect("stays finite");
        for (threads, world) in &mut worlds {
            world.step(DT_SECS).expect("stays finite");
            if step % 8 == 7 || step + 1 == steps {
                assert_eq!(world.hash(), alone.hash(), "{} step {step}, {threads} threads", scene.name);
            }
        }
    }
}

fn named(name: &str) -> Scene {
    by_name(name, None, 1).expect("a named scene")
}

#[test]
fn piles_and_what_stirs_them_end_alike_with_any_number_of_threads() {
    let settings = Settings::default();
    hold(&named("pyramid/24"), settings, 40);
    hold(&named("polygons/900"), Settings { broad: Broad::Grid, ..settings }, 120);
    hold(&named("tumbler/500"), Settings { broad: Broad::Grid, ..settings }, 96);
    hold(&named("all/400"), Settings { skips: Skips::EXACT, ..settings }, 96);
    hold(&named("circles/600"), Settings { skips: Skips::NONE, ..settings }, 64);
}

#[test]
fn joints_substep_groups_and_what_sleeps_end_alike_with_any_number_of_threads() {
    let settings = Settings::default();
    hold(&named("joint_grid/14"), settings, 64);
    hold(&named("columns/30"), settings, 96);
    hold(&named("pyramids/8"), Settings { sleep: true, ..settings }, 240);
}

#[test]
fn every_solver_and_precision_ends_alike_with_any_number_of_threads() {
    for &solver in Solver::ALL {
        hold(&named("polygons/300"), Settings { solver, ..Settings::default() }, 72);
    }
    let fine = Settings { positions: Some(Precision::F64), ..Settings::default() };
    hold(&named("pyramid/16"), fine, 32);
    hold(&named("pyramid/16"), Settings::default().with_precision(Precision::F64), 32);
}

/// A heap of every shape above a floor; where `apart`, one body in eight is a hundred times as heavy.
fn heap(bodies: usize, salt: usize, apart: bool) -> Scene {
    let mut specs =
        vec![BodySpec { kind: BodyKind::Static, ..BodySpec::new(ShapeSpec::Box([40.0, 1.0]), [0.0, -1.0]) }];
    for k in 0..bodies {
        let size = 0.3 + 0.2 * scatter(k, salt);
        let shape = match (k + salt) % 3 {
            0 => ShapeSpec::Circle(size),
            1 => ShapeSpec::Box([size, 0.6 * size]),
            _ => ShapeSpec::Polygon(vec![[-size, -size], [size, -0.8 * size], [0.2 * size, size]]),
        };
        let place = [(k % 20) as f64 * 1.1 - 11.0, 0.6 + (k / 20) as f64 * 1.1];
        let mass = if apart && k % 8 == 0 { 100.0 } else { 1.0 };
        let spec = BodySpec::new(shape, place).mass(mass).surface(0.3, 0.5);
        let spec = spec.moving([scatter(k, salt + 1), scatter(k, salt + 2)], scatter(k, salt + 3));
        specs.push(BodySpec { angle: 3.0 * scatter(k, salt + 4), ..spec });
    }
    scene_of(specs, Forces { gravity: Some([0.0, -9.81]), ..Forces::default() })
}

/// Takes bodies from a world and puts others in, the same at every call.
fn change(world: &mut dyn Simulation, round: usize) {
    for k in 0..6 {
        let slot = 1 + (round * 131 + k * 47) % (world.bodies() - 1);
        if let Some(body) = world.body(slot) {
            world.remove(body.id).expect("it lives");
        }
        let spec = BodySpec::new(ShapeSpec::Circle(0.25), [scatter(k, round) * 8.0, 20.0 + k as f64]);
        world.insert(&spec).expect("a good body");
    }
}

#[test]
fn worlds_that_are_changed_and_threads_that_come_and_go_end_alike() {
    for salt in 0..6 {
        let scene = heap(240 + 40 * salt, salt, salt % 2 == 1);
        let settings = Settings { lanes: [1, 4, 8][salt % 3], sleep: salt % 2 == 0, ..Settings::default() };
        let (mut alone, mut shared) = (start(&scene, settings), start(&scene, settings));
        for step in 0..120 {
            if step % 24 == 12 {
                change(&mut *alone, step);
                change(&mut *shared, step);
            }
            if step % 20 == 0 {
                let threads = Threads::Exactly([2, 3, 1, 16, 4, 2][step / 20]);
                let settings = Settings { threads, ..*shared.settings() };
                shared.set_settings(settings).expect("good settings");
            }
            alone.step(DT_SECS).expect("stays finite");
            shared.step(DT_SECS).expect("stays finite");
            assert_eq!(shared.hash(), alone.hash(), "heap {salt} step {step}");
        }
    }
}

#[test]
fn copies_of_a_world_share_its_threads() {
    let settings = Settings { threads: Threads::Exactly(2), lanes: 1, ..Settings::default() };
    let mut world = start(&named("pyramid/12"), settings);
    world.step(DT_SECS).expect("stays finite");
    let mut hashes = Vec::new();
    std::thread::scope(|scope| {
        let threads: Vec<_> = (0..3)
            .map(|_| {
                let mut copy = world.duplicate();
                scope.spawn(move || {
                    for _ in 0..40 {
                        copy.step(DT_SECS).expect("stays finite");
                    }
                    copy.hash()
                })
            })
            .collect();
        hashes.extend(threads.into_iter().map(|thread| thread.join().expect("no panic")));
    });
    assert!(hashes.iter().all(|hash| *hash == hashes[0]), "{hashes:?}");
}
