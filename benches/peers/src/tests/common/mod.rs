//! Small scenes and what tests ask of an engine.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

use lamina_peers::engine::{self, Engine, Name, Setup};
use lamina2d::force::Forces;
use lamina2d::joint::JointSpec;
use lamina2d::scene::{BodySpec, Scene};
use lamina2d::simulation::BodyState;

/// Both peers.
pub(crate) const PEERS: [Name; 2] = [Name::Box2d, Name::Rapier2d];

/// A scene of the library.
pub(crate) fn named(name: &str) -> Scene {
    lamina::cases::by_name(name, None, 1).unwrap()
}

/// A scene of one's own, under gravity.
pub(crate) fn scene_of(bodies: Vec<BodySpec>, joints: Vec<JointSpec>) -> Scene {
    let base = named("stack/1");
    Scene { name: "own".to_owned(), bodies, joints, forces: Forces::gravity(), ..base }
}

/// A world of the scene in an engine as it comes.
pub(crate) fn world(scene: &Scene, engine: Name) -> Box<dyn Engine> {
    engine::build(scene, Setup::new(engine)).unwrap()
}

/// The states after so many steps.
pub(crate) fn after(scene: &Scene, engine: Name, steps: usize) -> Vec<BodyState> {
    let mut world = world(scene, engine);
    world.run(steps).unwrap();
    world.states()
}

/// The angle of an attitude, rad.
pub(crate) fn angle(state: &BodyState) -> f64 {
    state.rotation[1].atan2(state.rotation[0])
}

/// Asserts that two numbers are closer than `by`.
#[track_caller]
pub(crate) fn close(what: &str, a: f64, b: f64, by: f64) {
    assert!((a - b).abs() <= by, "{what}: {a} and {b}");
}
