//! Scenes by name: the table the program, benches and tests share.

use super::mixes::{Mix, determinism, mix};
use super::{BodySpec, Scene, SceneError, ShapeSpec, Takes};
use super::{basics, driven, jointed, stacks};
use crate::force::Forces;

/// One line of the table of scenes.
#[derive(Clone, Copy, Debug)]
pub struct SceneInfo {
    /// The name.
    pub name: &'static str,
    /// What its parameter means.
    pub takes: Takes,
    /// The parameter when none is given.
    pub default: usize,
    /// What it shows.
    pub about: &'static str,
    /// Builds it from its parameter and a seed.
    pub build: fn(usize, u64) -> Scene,
}

/// A scene of which nothing can be chosen.
pub const fn fixed(
    name: &'static str,
    about: &'static str,
    build: fn(usize, u64) -> Scene,
    bodies: usize,
) -> SceneInfo {
    SceneInfo { name, takes: Takes::Nothing, default: bodies, about, build }
}

/// Every scene of the engine.
pub const SCENES: &[SceneInfo] = &[
    SceneInfo {
        name: "circles",
        takes: Takes::Bodies,
        default: 150,
        about: "the thesis's box, circles",
        build: |n, seed| mix(Mix::Circles, n, seed),
    },
    SceneInfo {
        name: "circles_polygons",
        takes: Takes::Bodies,
        default: 150,
        about: "the thesis's box, circles and six-sided polygons in turn",
        build: |n, seed| mix(Mix::CirclesPolygons, n, seed),
    },
    SceneInfo {
        name: "polygons",
        takes: Takes::Bodies,
        default: 150,
        about: "the thesis's box, six-sided polygons",
        build: |n, seed| mix(Mix::Polygons, n, seed),
    },
    SceneInfo {
        name: "all",
        takes: Takes::Bodies,
        default: 150,
        about: "the thesis's box, circles, boxes and polygons in turn",
        build: |n, seed| mix(Mix::All, n, seed),
    },
    SceneInfo {
        name: "determinism",
        takes: Takes::Nothing,
        default: 6,
        about: "the thesis's six bodies, run twice to see whether they agree",
        build: |_, _| determinism(),
    },
    SceneInfo {
        name: "free_flight",
        takes: Takes::Bodies,
        default: 10_000,
        about: "circles rising and falling side by side that never touch",
        build: |n, _| free_flight(n),
    },
    SceneInfo {
        name: "head_on",
        takes: Takes::Pairs,
        default: 100,
        about: "pairs of circles, and of boxes, meeting head on without gravity",
        build: |n, _| head_on(n),
    },
    SceneInfo {
        name: "stack",
        takes: Takes::Height,
        default: 10,
        about: "boxes of 1 m resting on each other",
        build: |n, _| stack(n),
    },
    SceneInfo {
        name: "pyramid",
        takes: Takes::Base,
        default: 100,
        about: "a pyramid of boxes of 1 m, each resting on two",
        build: |n, _| stacks::pyramid(n),
    },
    SceneInfo {
        name: "pyramids",
        takes: Takes::Pyramids,
        default: 100,
        about: "pyramids of 55 boxes side by side on several floors",
        build: |n, _| stacks::pyramids(n),
    },
    SceneInfo {
        name: "columns",
        takes: Takes::Height,
        default: 40,
        about: "a column of boxes, 1 cm to the right and to the left in turn",
        build: |n, _| stacks::columns(n),
    },
    SceneInfo {
        name: "heavy",
        takes: Takes::Ratio,
        default: 100,
        about: "a box on a box of the same size and a fraction of its mass",
        build: |n, _| stacks::heavy(n),
    },
    SceneInfo {
        name: "sizes",
        takes: Takes::Nothing,
        default: 6,
        about: "boxes of 1 to 32 m on each other, the smallest at the bottom",
        build: |_, _| stacks::sizes(),
    },
    SceneInfo {
        name: "two_feet",
        takes: Takes::Nothing,
        default: 3,
        about: "a box of 20 m on two boxes of 1 m",
        build: |_, _| stacks::two_feet(),
    },
    SceneInfo {
        name: "arch",
        takes: Takes::Nothing,
        default: 21,
        about: "a semicircular arch of 17 wedges with four boxes on its keystone",
        build: |_, _| stacks::arch(),
    },
    SceneInfo {
        name: "cards",
        takes: Takes::Levels,
        default: 4,
        about: "a house of cards of 0.4 m and 2 mm",
        build: |n, _| stacks::cards(n),
    },
    SceneInfo {
        name: "dominoes",
        takes: Takes::Bodies,
        default: 30,
        about: "a row of dominoes, the first one falling",
        build: |n, _| driven::dominoes(n),
    },
    SceneInfo {
        name: "rain",
        takes: Takes::Bodies,
        default: 1000,
        about: "circles, boxes and polygons falling between two walls",
        build: driven::rain,
    },
    SceneInfo {
        name: "tumbler",
        takes: Takes::Bodies,
        default: 2000,
        about: "small boxes in a box that turns about its centre",
        build: |n, _| driven::tumbler(n),
    },
    SceneInfo {
        name: "spinner",
        takes: Takes::Bodies,
        default: 2000,
        about: "circles, boxes and octagons stirred by a long bar",
        build: driven::spinner,
    },
    SceneInfo {
        name: "bullet",
        takes: Takes::Nothing,
        default: 1,
        about: "a circle at 200 m/s against a wall of 0.1 m",
        build: |_, _| driven::bullet(),
    },
    SceneInfo {
        name: "bullets",
        takes: Takes::Nothing,
        default: 3,
        about: "wedge, sliver and plate at 100 and 200 m/s, each against its wall",
        build: |_, _| driven::bullets(),
    },
    SceneInfo {
        name: "circles_confined",
        takes: Takes::Nothing,
        default: 625,
        about: "discs packed into a box without gravity, pushing each other about",
        build: |_, seed| driven::circles_confined(seed),
    },
    SceneInfo {
        name: "chain",
        takes: Takes::Links,
        default: 30,
        about: "a chain of boxes that swings down from one end",
        build: |n, _| jointed::chain(n, None),
    },
    SceneInfo {
        name: "bridge",
        takes: Takes::Links,
        default: 40,
        about: "a hanging bridge of planks, both ends fixed",
        build: |n, _| jointed::bridge(n),
    },
    SceneInfo {
        name: "joint_grid",
        takes: Takes::Side,
        default: 20,
        about: "a square net of jointed circles, hung at its upper corners",
        build: |n, _| jointed::joint_grid(n),
    },
    SceneInfo {
        name: "pendulum",
        takes: Takes::Nothing,
        default: 1,
        about: "a disc on a rod of 1 m, let go level",
        build: |_, _| jointed::pendulum(),
    },
    SceneInfo {
        name: "spin",
        takes: Takes::Nothing,
        default: 3,
        about: "bars at 1, 10 and 100 rad/s, free: their attitudes are known",
        build: |_, _| basics::spin(),
    },
    SceneInfo {
        name: "slide",
        takes: Takes::Nothing,
        default: 1,
        about: "a block at 5 m/s slides to a stop on a level floor",
        build: |_, _| basics::slide(),
    },
    SceneInfo {
        name: "incline",
        takes: Takes::Nothing,
        default: 1,
        about: "a block slides down a slope of 30°",
        build: |_, _| basics::incline(),
    },
    SceneInfo {
        name: "roll",
        takes: Takes::Nothing,
        default: 1,
        about: "a disc rolls down a slope of 20°",
        build: |_, _| basics::roll(),
    },
    SceneInfo {
        name: "slide_to_roll",
        takes: Takes::Nothing,
        default: 1,
        about: "a disc at 6 m/s slides until it rolls",
        build: |_, _| basics::slide_to_roll(),
    },
    SceneInfo {
        name: "bounce",
        takes: Takes::Nothing,
        default: 1,
        about: "a disc dropped from 2 m bounces four times",
        build: |_, _| basics::bounce(),
    },
    SceneInfo {
        name: "rod_hit",
        takes: Takes::Nothing,
        default: 2,
        about: "a disc hits a free rod off its middle",
        build: |_, _| basics::rod_hit(),
    },
];

/// The largest number of bodies a named scene is built with.
pub const MAX_BODIES: usize = 1_000_000;

/// The scene `name` or `name/parameter`; `bodies` overrides the parameter.
///
/// # Errors
/// An unknown name, a parameter that is not a number from 1 to [`Takes::most`], a parameter for a scene
/// that takes none.
pub fn by_name(name: &str, bodies: Option<usize>, seed: u64) -> Result<Scene, SceneError> {
    by_name_in(SCENES, name, bodies, seed)
}

/// As [`by_name`], among the scenes of another table.
///
/// # Errors
/// Those of [`by_name`].
pub fn by_name_in(
    scenes: &[SceneInfo],
    name: &str,
    bodies: Option<usize>,
    seed: u64,
) -> Result<Scene, SceneError> {
    let (base, parameter) = match name.split_once('/') {
        Some((base, parameter)) => (base, Some(parameter)),
        None => (name, None),
    };
    let info = scenes.iter().find(|s| s.name == base).ok_or_else(|| SceneError::UnknownScene {
        name: name.to_owned(),
        choices: scenes.iter().map(|s| s.name).collect::<Vec<_>>().join(", "),
    })?;
    let [takes, problem] = info.takes.wanted();
    let good = |n: &usize| info.takes != Takes::Nothing && (1..=info.takes.most()).contains(n);
    let parsed = parameter
        .map(|given| {
            given.parse().ok().filter(good).ok_or_else(|| SceneError::Parameter {
                scene: base.to_owned(),
                takes,
                given: given.to_owned(),
            })
        })
        .transpose()?;
    if let Some(given) = bodies.filter(|n| !good(n)) {
        return Err(SceneError::Bodies { scene: base.to_owned(), problem, given });
    }
    let count = bodies.or(parsed).unwrap_or(info.default);
    let name = if info.takes == Takes::Nothing { base.to_owned() } else { format!("{base}/{count}") };
    Ok(Scene { name, ..(info.build)(count, seed) })
}

/// A scene with steps of 1/60 s; its name comes from the table.
pub fn scene(about: &str, bodies: Vec<BodySpec>, forces: Forces, steps: u64) -> Scene {
    Scene {
        name: String::new(),
        about: about.to_owned(),
        bodies,
        joints: Vec::new(),
        forces,
        events: Vec::new(),
        dt_secs: 1.0 / 60.0,
        steps,
        seed: 0,
    }
}

/// Circles of 0.25 m on a square grid of pitch 1 m, all with the same velocity: distances never change.
fn free_flight(n: usize) -> Scene {
    let columns = (n as f64).sqrt().ceil() as usize;
    let bodies = (0..n)
        .map(|k| {
            let position = [(k % columns) as f64, (k / columns) as f64];
            BodySpec::new(ShapeSpec::Circle(0.25), position).moving([3.0, 20.0], 0.0).mass(1.0)
        })
        .collect();
    scene("bodies that never touch", bodies, Forces::gravity(), 240)
}

/// Rows of pairs 4 m apart: even rows circles, odd rows boxes; masses 1 and 2, elastic, no friction.
fn head_on(pairs: usize) -> Scene {
    let bodies = (0..pairs)
        .flat_map(|k| {
            let y = 4.0 * k as f64;
            let shape = if k % 2 == 0 { ShapeSpec::Circle(0.5) } else { ShapeSpec::Box([0.5, 0.5]) };
            let body = |x: f64, v: f64, m: f64| {
                BodySpec::new(shape.clone(), [x, y]).moving([v, 0.0], 0.0).mass(m).surface(1.0, 0.0)
            };
            [body(-2.0, 1.0, 1.0), body(2.0, -1.0, 2.0)]
        })
        .collect();
    scene("pairs that meet head on", bodies, Forces::default(), 180)
}

/// `n` boxes of 1 m and 1 kg on a floor, touching exactly.
fn stack(n: usize) -> Scene {
    let floor = BodySpec::new(ShapeSpec::Box([20.0, 0.5]), [0.0, -0.5]).surface(0.0, 0.5).fixed();
    let boxes = (0..n).map(|k| {
        BodySpec::new(ShapeSpec::Box([0.5, 0.5]), [0.0, 0.5 + k as f64]).mass(1.0).surface(0.0, 0.5)
    });
    scene("a resting stack", std::iter::once(floor).chain(boxes).collect(), Forces::gravity(), 600)
}
