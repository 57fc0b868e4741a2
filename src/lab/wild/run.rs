//! A case with an engine, held to its numbers.

use lamina2d::force::Forces;
use lamina2d::measure::Invariants;
use lamina2d::scene::{BodyKind, Scene};
use lamina2d::settings::{Precision, Settings};
use lamina2d::simulation::{BodyState, Simulation, simulate};
use serde::Serialize;

use super::case::{Case, Column, Expect, Sense, What};
use crate::present::table::Record;

/// A world of any engine with a case's bodies in it, in their order.
pub trait Course {
    /// Advances by the scene's step.
    ///
    /// # Errors
    /// A state that the engine calls broken.
    fn step(&mut self) -> anyhow::Result<()>;
    /// The states of all bodies.
    fn states(&self) -> Vec<BodyState>;
    /// Bodies that sleep; `None` where the engine does not say.
    fn asleep(&self) -> Option<usize>;
}

/// This project's engine.
#[allow(missing_debug_implementations, reason = "a world behind its interface has none")]
pub struct World(Box<dyn Simulation>);

impl World {
    /// A world for a case, with the default settings but for what the case names.
    ///
    /// # Errors
    /// A scene that is refused.
    pub fn new(case: &Case, precision: Precision) -> anyhow::Result<Self> {
        let default = Settings::default().with_precision(precision);
        let settings = Settings {
            dt_secs: case.scene.dt_secs,
            sleep: case.sleep,
            solver: case.solver.unwrap_or(default.solver),
            ..default
        };
        Ok(Self(simulate(&case.scene, settings)?))
    }
}

impl Course for World {
    fn step(&mut self) -> anyhow::Result<()> {
        Ok(self.0.advance()?)
    }
    fn states(&self) -> Vec<BodyState> {
        // By their numbers in the scene: one that has gone is nowhere.
        let nowhere = BodyState {
            position: [f64::NAN; 2],
            rotation: [f64::NAN; 2],
            velocity: [0.0; 2],
            angular_velocity: 0.0,
        };
        let last =
            (1..).filter(|&slot| self.0.body(slot).is_some()).take(self.0.bodies()).last().unwrap_or(0);
        (1..=last).map(|slot| self.0.body(slot).map_or(nowhere, |body| body.state)).collect()
    }
    fn asleep(&self) -> Option<usize> {
        Some(self.0.sleeping())
    }
}

/// A number of a case, and what was found.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// The case.
    pub case: String,
    /// Its kind.
    pub kind: &'static str,
    /// What was looked at.
    pub what: String,
    /// What it must be.
    pub expected: f64,
    /// What it is; null where the run broke off or the engine does not say.
    pub found: Option<f64>,
    /// How far it may be off.
    pub tolerance: f64,
    /// Near, at most or at least.
    pub sense: Sense,
    /// Is it?
    pub met: bool,
    /// Why nothing was found.
    pub note: Option<String>,
}

impl Record for Row {
    const NAME: &'static str = "wild";
    const TITLE: &'static str = "Scenes from problem reports";
    const COMMAND: &'static str = "lamina wild --all";
    const NOTE: &'static str =
        "Each number is worked out from a closed form; a case is right where all its numbers are met.";
    const HEADER: &'static [&'static str] =
        &["kind", "case", "what", "expected", "found", "tolerance", "met", "note"];
    fn cells(&self) -> Vec<String> {
        let sense = match self.sense {
            Sense::Near => "",
            Sense::AtMost => "≤ ",
            Sense::AtLeast => "≥ ",
        };
        vec![
            self.kind.to_owned(),
            self.case.clone(),
            self.what.clone(),
            format!("{sense}{:.6}", self.expected),
            self.found.map_or_else(|| "–".to_owned(), |found| format!("{found:.6}")),
            format!("{:.2e}", self.tolerance),
            if self.met { "yes" } else { "NO" }.to_owned(),
            self.note.clone().unwrap_or_default(),
        ]
    }
}

/// How many cases came out right: those of which every number is met.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Tally {
    /// Cases run.
    pub cases: usize,
    /// Cases of which every number is met.
    pub right: usize,
}

/// Counts the cases among rows, which are in the order of their cases.
pub fn tally<'a>(rows: impl IntoIterator<Item = &'a Row>) -> Tally {
    let (mut tally, mut last, mut good) = (Tally::default(), None, true);
    for row in rows {
        if last != Some(&row.case) {
            tally.right += usize::from(last.is_some() && good);
            tally.cases += 1;
            (last, good) = (Some(&row.case), true);
        }
        good &= row.met;
    }
    tally.right += usize::from(last.is_some() && good);
    tally
}

/// Runs a case in what `build` makes of it and holds it to its numbers.
pub fn rows(case: &Case, build: impl FnOnce(&Case) -> anyhow::Result<Box<dyn Course>>) -> Vec<Row> {
    let mut found = vec![None; case.expects.len()];
    let (mut note, mut refused) = (None, false);
    match build(case) {
        Err(why) => (note, refused) = (Some(format!("{why:#}")), true),
        Ok(mut world) => {
            note = follow(case, world.as_mut(), &mut found).err().map(|why| format!("{why:#}")).or(note);
        }
    }
    let row = |(expect, found): (&Expect, Option<f64>)| {
        let found = if expect.what == What::Refused { Some(f64::from(u8::from(refused))) } else { found };
        Row {
            case: case.name.clone(),
            kind: case.kind,
            what: words(expect.what),
            expected: expect.expected,
            found: found.filter(|found| found.is_finite()),
            tolerance: expect.tolerance,
            sense: expect.sense,
            met: found.is_some_and(|found| expect.is_met(found)),
            note: note.clone(),
        }
    };
    case.expects.iter().zip(found).map(row).collect()
}

fn words(what: What) -> String {
    match what {
        What::Body { body, column, step } => {
            let name = match column {
                Column::X => "x",
                Column::Y => "y",
                Column::Angle => "angle",
                Column::Vx => "vx",
                Column::Vy => "vy",
                Column::W => "w",
            };
            format!("body {body} {name} at step {step}")
        }
        What::KineticAlways => "kinetic energy at every step".to_owned(),
        What::Kinetic => "kinetic energy".to_owned(),
        What::Momentum(axis) => format!("momentum {}", ["x", "y"][axis]),
        What::AngularMomentum => "angular momentum".to_owned(),
        What::Asleep => "asleep".to_owned(),
        What::Refused => "refused".to_owned(),
    }
}

/// Runs to the end, looking on; what is found is in the order of what is expected.
fn follow(case: &Case, world: &mut dyn Course, found: &mut [Option<f64>]) -> anyhow::Result<()> {
    let masses = masses(&case.scene);
    let steps = case.scene.steps;
    for step in 1..=steps {
        world.step()?;
        let always = case.expects.iter().any(|expect| expect.what == What::KineticAlways);
        let looks = |expect: &Expect| matches!(expect.what, What::Body { step: at, .. } if at == step);
        if step != steps && !always && !case.expects.iter().any(looks) {
            continue;
        }
        let states = world.states();
        let sums = sums(&states, &masses);
        for (expect, found) in case.expects.iter().zip(&mut *found) {
            let seen = match expect.what {
                What::Body { body, column, step: at } if at == step => {
                    Some(states.get(body).map_or(f64::NAN, |state| number(state, column)))
                }
                What::KineticAlways => {
                    let energy = sums.kinetic_energy;
                    let off = |energy: f64| (energy - expect.expected).abs();
                    // What is no number stays.
                    Some(found.filter(|&worst| worst.is_nan() || off(worst) >= off(energy)).unwrap_or(energy))
                }
                _ if step != steps => None,
                What::Kinetic => Some(sums.kinetic_energy),
                What::Momentum(axis) => Some(sums.momentum[axis]),
                What::AngularMomentum => Some(sums.angular_momentum),
                What::Asleep => world.asleep().map(|count| count as f64),
                What::Body { .. } | What::Refused => None,
            };
            if seen.is_some() {
                *found = seen;
            }
        }
    }
    Ok(())
}

fn number(state: &BodyState, column: Column) -> f64 {
    match column {
        Column::X => state.position[0],
        Column::Y => state.position[1],
        Column::Angle => state.rotation[1].atan2(state.rotation[0]),
        Column::Vx => state.velocity[0],
        Column::Vy => state.velocity[1],
        Column::W => state.angular_velocity,
    }
}

/// Mass (kg) and moment of inertia (kg·m²) of each body of a scene; 0 unless dynamic.
fn masses(scene: &Scene) -> Vec<[f64; 2]> {
    let of = |body: &lamina2d::scene::BodySpec| match body.shape.build() {
        Ok(shape) if body.kind == BodyKind::Dynamic => {
            let properties = shape.mass_properties();
            let mass = body.mass.unwrap_or_else(|| body.density.unwrap_or(1.0) * properties.area);
            [mass, mass / properties.area * properties.second_moment]
        }
        _ => [0.0; 2],
    };
    scene.bodies.iter().map(of).collect()
}

/// Energy and momenta of all bodies, as every engine's are summed; no field has a part in them.
fn sums(states: &[BodyState], masses: &[[f64; 2]]) -> Invariants {
    let mut sums = Invariants::default();
    for (state, &mass) in states.iter().zip(masses) {
        sums.add(mass, state.position, state.velocity, state.angular_velocity, &Forces::default());
    }
    sums
}
