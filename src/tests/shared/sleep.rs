//! What the tests of sleep share: drowsy worlds, and how they are put to sleep.

use lamina2d::body::BodyId;
use lamina2d::force::Forces;
use lamina2d::lanes::{Lanes, Real};
use lamina2d::scene::{BodyKind, BodySpec, Scene, ShapeSpec, by_name};
use lamina2d::settings::Settings;
use lamina2d::world::World;

use crate::shared_motion::scene_of;

pub(crate) const DT_SECS: f64 = 1.0 / 60.0;

pub(crate) fn drowsy() -> Settings {
    Settings { sleep: true, ..Settings::default() }
}

pub(crate) fn named(name: &str) -> Scene {
    by_name(name, None, 1).expect("a named scene")
}

pub(crate) fn world_of<L: Lanes>(scene: &Scene, settings: Settings) -> World<L> {
    World::from_scene(scene, settings).expect("the scene is good")
}

pub(crate) fn step<L: Lanes>(world: &mut World<L>, steps: usize) {
    for _ in 0..steps {
        world.step(DT_SECS).expect("stays finite");
    }
}

pub(crate) fn movable<L: Lanes>(world: &World<L>) -> usize {
    let bodies = world.bodies();
    bodies.slots().filter(|&slot| bodies.kind(slot) == BodyKind::Dynamic).count()
}

/// Steps until all that can move sleeps.
pub(crate) fn put_to_sleep<L: Lanes>(world: &mut World<L>, within: usize) {
    for _ in 0..within {
        if world.sleeping() == movable(world) {
            return;
        }
        step(world, 1);
    }
    let (sleeping, all) = (world.sleeping(), movable(world));
    panic!(
        "{sleeping} of {all} asleep after {within} steps, {:e} m/s: {:?}",
        max_speed(world),
        world.settings()
    );
}

pub(crate) fn id<L: Lanes>(world: &World<L>, slot: usize) -> BodyId {
    world.bodies().id(slot).expect("lives")
}

/// The pose columns of a body, to the bit.
pub(crate) fn pose<L: Lanes>(world: &World<L>, slot: usize) -> [u64; 4] {
    let bodies = world.bodies();
    [&bodies.x, &bodies.y, &bodies.c, &bodies.s].map(|column| column[slot].to_f64().to_bits())
}

pub(crate) fn max_speed<L: Lanes>(world: &World<L>) -> f64 {
    let bodies = world.bodies();
    let speed = |slot: usize| bodies.vx[slot].to_f64().hypot(bodies.vy[slot].to_f64());
    bodies.slots().map(speed).fold(0.0, f64::max)
}

pub(crate) fn unit_box(x: f64, y: f64) -> BodySpec {
    BodySpec::new(ShapeSpec::Box([0.5; 2]), [x, y]).surface(0.0, 0.6)
}

pub(crate) fn floor() -> BodySpec {
    BodySpec::new(ShapeSpec::Box([30.0, 0.5]), [0.0, -0.5]).surface(0.0, 0.6).fixed()
}

/// A floor and on it these bodies, under gravity.
pub(crate) fn on_floor(bodies: impl IntoIterator<Item = BodySpec>) -> Scene {
    scene_of(std::iter::once(floor()).chain(bodies).collect(), Forces::gravity())
}
