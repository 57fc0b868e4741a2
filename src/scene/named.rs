//! Scenes by name: the table the program, benches and tests share.

use super::mixes::{Mix, determinism, mix};
use super::{BodySpec, Scene, SceneError, ShapeSpec};
use crate::force::Forces;

/// What a scene's parameter after the slash or `--bodies` means.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Takes {
    /// Nothing: the scene is what it is.
    Nothing,
    /// A number of bodies.
    Bodies,
    /// A number of pairs of bodies.
    Pairs,
    /// A number of boxes on top of each other.
    Height,
}

impl Takes {
    /// In a word.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Nothing => "none",
            Self::Bodies => "bodies",
            Self::Pairs => "pairs",
            Self::Height => "boxes",
        }
    }
}

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
    build: fn(usize, u64) -> Scene,
}

/// Every scene of the library.
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
];

/// The largest number of bodies a named scene is built with.
pub const MAX_BODIES: usize = 1_000_000;

/// The scene `name` or `name/parameter`; `bodies` overrides the parameter.
///
/// # Errors
/// An unknown name, a parameter that is not a number from 1 to [`MAX_BODIES`], a parameter for a scene
/// that takes none.
pub fn by_name(name: &str, bodies: Option<usize>, seed: u64) -> Result<Scene, SceneError> {
    let (base, parameter) = match name.split_once('/') {
        Some((base, parameter)) => (base, Some(parameter)),
        None => (name, None),
    };
    let info = SCENES.iter().find(|s| s.name == base).ok_or_else(|| SceneError::UnknownScene {
        name: name.to_owned(),
        choices: SCENES.iter().map(|s| s.name).collect::<Vec<_>>().join(", "),
    })?;
    let takes = match info.takes {
        Takes::Nothing => "nothing",
        Takes::Bodies => "a number of bodies (1 to 1000000)",
        Takes::Pairs => "a number of pairs (1 to 1000000)",
        Takes::Height => "a number of boxes (1 to 1000000)",
    };
    let parsed = parameter
        .map(|given| {
            let number = given.parse().ok().filter(|n| (1..=MAX_BODIES).contains(n));
            number.filter(|_| info.takes != Takes::Nothing).ok_or_else(|| SceneError::Parameter {
                scene: base.to_owned(),
                takes,
                given: given.to_owned(),
            })
        })
        .transpose()?;
    if let Some(given) = bodies {
        let problem = match info.takes {
            Takes::Nothing => Some("cannot be chosen"),
            _ if !(1..=MAX_BODIES).contains(&given) => Some("must be 1 to 1000000"),
            _ => None,
        };
        if let Some(problem) = problem {
            return Err(SceneError::Bodies { scene: base.to_owned(), problem, given });
        }
    }
    let count = bodies.or(parsed).unwrap_or(info.default);
    let mut scene = (info.build)(count, seed);
    if info.takes != Takes::Nothing {
        scene.name = format!("{base}/{count}");
    }
    Ok(scene)
}

fn scene(about: &str, bodies: Vec<BodySpec>, forces: Forces, steps: u64) -> Scene {
    Scene {
        name: String::new(),
        about: about.to_owned(),
        bodies,
        forces,
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
