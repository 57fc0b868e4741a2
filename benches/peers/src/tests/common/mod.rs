//! Small scenes and what tests ask of an engine.

use lamina_peers::engine::{self, Engine, Name, Setup};
use lamina2d::force::Forces;
use lamina2d::joint::{JointKind, JointSpec};
use lamina2d::scene::{self, BodySpec, Scene, ShapeSpec};
use lamina2d::simulation::BodyState;

/// Both peers.
pub const PEERS: [Name; 2] = [Name::Box2d, Name::Rapier2d];

/// A scene of the library.
pub fn named(name: &str) -> Scene {
    scene::by_name(name, None, 1).unwrap()
}

/// A scene of one's own, under gravity.
pub fn scene_of(bodies: Vec<BodySpec>, joints: Vec<JointSpec>) -> Scene {
    let base = named("stack/1");
    Scene { name: "own".to_owned(), bodies, joints, forces: Forces::gravity(), ..base }
}

/// A static disc at the origin and a disc of 1 kg, joined.
pub fn hung(position: [f64; 2], kind: JointKind) -> Scene {
    let disc = |at| BodySpec::new(ShapeSpec::Circle(0.1), at).mass(1.0);
    scene_of(vec![disc([0.0; 2]).fixed(), disc(position)], vec![JointSpec::new(0, 1, kind)])
}

/// A world of the scene in an engine as it comes.
pub fn world(scene: &Scene, engine: Name) -> Box<dyn Engine> {
    engine::build(scene, Setup::new(engine)).unwrap()
}

/// The states after so many steps.
pub fn after(scene: &Scene, engine: Name, steps: usize) -> Vec<BodyState> {
    let mut world = world(scene, engine);
    world.run(steps).unwrap();
    world.states()
}

/// The angle of an attitude, rad.
pub fn angle(state: &BodyState) -> f64 {
    state.rotation[1].atan2(state.rotation[0])
}

/// Asserts that two numbers are closer than `by`.
#[track_caller]
pub fn close(what: &str, a: f64, b: f64, by: f64) {
    assert!((a - b).abs() <= by, "{what}: {a} and {b}");
}
