//! A step that meets no new maximum of bodies, pairs or contacts allocates nothing.
//!
//! Settled first, so that the counts wander about what was seen before; then 60 steps are counted.

#[path = "shared/motion.rs"]
#[allow(dead_code, reason = "each binary takes the helpers it needs")]
mod shared_motion;

use lamina2d::scene::{Scene, by_name};
use lamina2d::settings::{Broad, Integrator, Precision, Settings, Skips};
use lamina2d::simulation::Simulation;
use shared_motion::{every_field, ghosts, scene_of, start};

/// Allocations in the next `steps` steps of 1/60 s.
fn allocations(world: &mut dyn Simulation, steps: usize) -> u64 {
    allocation_counter::measure(|| {
        for _ in 0..steps {
            world.step(1.0 / 60.0).expect("stays finite");
        }
    })
    .count_total
}

/// Holds a scene to no allocation after `settle` steps, with every broad phase.
fn hold(scene: &Scene, settings: Settings, settle: usize) {
    for &broad in Broad::ALL {
        let mut world = start(scene, Settings { broad, ..settings });
        let before = allocations(&mut *world, settle);
        let after = allocations(&mut *world, 60);
        println!("{:20} {broad:6}: {before} in {settle} steps, {after} in 60 more", scene.name);
        assert_eq!(after, 0, "{} {broad} {settings:?}", scene.name);
    }
}

fn named(name: &str) -> Scene {
    by_name(name, None, 1).expect("a named scene")
}

#[test]
fn settled_mixes_allocate_nothing() {
    for name in ["circles/150", "circles_polygons/150", "polygons/150", "all/150"] {
        hold(&named(name), Settings::default(), 600);
    }
}

#[test]
fn settled_mixes_allocate_nothing_in_f64_and_with_substeps() {
    let settings = Settings { substeps: 3, ..Settings::default().with_precision(Precision::F64) };
    hold(&named("all/150"), Settings { skips: Skips::NONE, ..settings }, 600);
}

#[test]
fn resting_stacks_allocate_nothing() {
    hold(&named("stack/10"), Settings::default(), 600);
}

#[test]
fn paced_islands_allocate_nothing() {
    let settings = Settings { max_sag: Some(1e-3), ..Settings::default() };
    for name in ["stack/10", "pyramids/3", "bridge/40"] {
        hold(&named(name), settings, 600);
    }
}

#[test]
fn joints_allocate_nothing() {
    for name in ["bridge/40", "pendulum", "joint_grid/8"] {
        hold(&named(name), Settings::default(), 600);
    }
}

/// One step is warm-up enough where nothing meets, though all fly apart and the grid gets more cells.
#[test]
fn free_flight_allocates_nothing_after_its_first_step() {
    hold(&named("free_flight/500"), Settings::default(), 1);
    let mut burst = named("free_flight/500");
    for body in &mut burst.bodies {
        body.velocity = body.position.map(|x| 3.0 * (x - 11.0));
    }
    hold(&burst, Settings::default(), 1);
}

/// Bodies far apart in every field, some with forces of their own.
#[test]
fn no_integrator_and_no_field_allocates() {
    let mut bodies = ghosts(100);
    for body in &mut bodies {
        body.position = body.position.map(|x| 100.0 * x);
    }
    bodies[3].torque = 1.0;
    let scene = scene_of(bodies, every_field());
    for &integrator in Integrator::ALL {
        let settings = Settings { integrator, ..Settings::default() };
        // What moves ever faster reaches ever further: candidates have their maximum early.
        // What moves ever faster reaches ever further: candidates, and those that are swept, have their maximum early.
        hold(&scene, settings, 160);
    }
}
