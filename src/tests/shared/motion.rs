//! What the tests of motion share: scenes by hand, every width, a run to its end.

use lamina2d::force::{Central, Drive, Forces, Spring};
use lamina2d::scene::{BodySpec, Scene, ShapeSpec};
use lamina2d::settings::{Precision, Settings};
use lamina2d::simulation::{Simulation, simulate};

/// The step of most tests: a power of two, so that products with it do not round.
pub(crate) const DT_SECS: f64 = 1.0 / 64.0;

/// A scene of these bodies, in this order.
pub(crate) fn scene_of(bodies: Vec<BodySpec>, forces: Forces) -> Scene {
    Scene {
        name: "test".into(),
        about: String::new(),
        bodies,
        joints: Vec::new(),
        forces,
        events: Vec::new(),
        dt_secs: DT_SECS,
        steps: 0,
        seed: 0,
    }
}

/// A disc of 0.1 m.
pub(crate) fn disc(position: [f64; 2]) -> BodySpec {
    BodySpec::new(ShapeSpec::Circle(0.1), position)
}

/// Settings at every precision and width, otherwise like `settings`.
pub(crate) fn at_every_width(settings: Settings) -> impl Iterator<Item = Settings> {
    Precision::ALL.iter().flat_map(move |&precision| at_widths(settings, precision))
}

/// Settings at every width of one precision.
pub(crate) fn at_widths(settings: Settings, precision: Precision) -> impl Iterator<Item = Settings> {
    Settings::widths(precision).iter().map(move |&lanes| Settings { precision, lanes, ..settings })
}

/// A world of a scene that is known to be good.
pub(crate) fn start(scene: &Scene, settings: Settings) -> Box<dyn Simulation> {
    simulate(scene, settings).expect("the scene is good")
}

/// The world of a scene after `steps` steps of [`DT_SECS`].
pub(crate) fn run(scene: &Scene, settings: Settings, steps: usize) -> Box<dyn Simulation> {
    let mut world = start(scene, settings);
    for _ in 0..steps {
        world.step(DT_SECS).expect("the state stays finite");
    }
    world
}

/// A number in −1…1 that depends on `k` and `salt` alone.
pub(crate) fn scatter(k: usize, salt: usize) -> f64 {
    ((k * 37 + salt * 59 + 11) % 101) as f64 / 50.5 - 1.0
}

/// Every field at once.
pub(crate) fn every_field() -> Forces {
    Forces {
        gravity: Some([0.5, -9.81]),
        wind: Some([2.0, -1.0]),
        linear_drag: Some(0.3),
        quadratic_drag: Some(0.02),
        spring: Some(Spring { anchor: [3.0, 1.0], stiffness: 0.7 }),
        central: Some(Central { center: [-5.0, 40.0], strength: 30.0 }),
        magnetic: Some(0.4),
        companion: Some(Central { center: [35.0, -12.0], strength: 20.0 }),
        henon_heiles: Some(0.01),
        drive: Some(Drive { amplitude: [0.3, 0.8], rate: 7.0, phase: 0.2 }),
        attraction: None,
    }
}

/// Every field alone, and all of them, by name.
pub(crate) fn fields() -> Vec<(&'static str, Forces)> {
    let (all, none) = (every_field(), Forces::default());
    vec![
        ("no field", none),
        ("gravity", Forces { gravity: all.gravity, ..none }),
        ("linear drag", Forces { linear_drag: all.linear_drag, wind: all.wind, ..none }),
        ("quadratic drag", Forces { quadratic_drag: all.quadratic_drag, ..none }),
        ("spring", Forces { spring: all.spring, ..none }),
        ("central", Forces { central: all.central, ..none }),
        ("magnetic", Forces { magnetic: all.magnetic, ..none }),
        ("companion", Forces { companion: all.companion, ..none }),
        ("Hénon-Heiles", Forces { henon_heiles: all.henon_heiles, ..none }),
        ("drive", Forces { drive: all.drive, ..none }),
        ("every field", all),
    ]
}

/// `n` bodies of different shapes, masses, spins and velocities that pass through each other.
pub(crate) fn ghosts(n: usize) -> Vec<BodySpec> {
    let shape = |k: usize| match k % 3 {
        0 => ShapeSpec::Circle(0.3),
        1 => ShapeSpec::Box([0.4, 0.2]),
        _ => ShapeSpec::Polygon(vec![[-0.3, -0.2], [0.4, -0.1], [0.1, 0.4]]),
    };
    (0..n)
        .map(|k| BodySpec {
            collides_with: 0,
            mass: Some(1.5 + scatter(k, 1)),
            angle: 3.0 * scatter(k, 5),
            ..BodySpec::new(shape(k), [7.0 * scatter(k, 2), 5.0 * scatter(k, 3)])
                .moving([4.0 * scatter(k, 6), 6.0 * scatter(k, 7)], 9.0 * scatter(k, 8))
        })
        .collect()
}
