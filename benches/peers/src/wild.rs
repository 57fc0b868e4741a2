//! Scenes from problem reports, each engine held to the same right numbers.

use lamina::wild::{self, Case, Course, Tally, tally};
use lamina2d::settings::{Precision, Solver};
use lamina2d::simulation::BodyState;
use serde::Serialize;

use crate::engine::{Engine, Name, Setup, build};

/// An engine behind what a case asks of it.
struct Held(Box<dyn Engine>);

impl Course for Held {
    fn step(&mut self) -> anyhow::Result<()> {
        self.0.step()
    }
    fn states(&self) -> Vec<BodyState> {
        self.0.states()
    }
    fn asleep(&self) -> Option<usize> {
        Some(self.0.asleep())
    }
}

/// A number of a case, with the engine it was found by.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// The engine.
    pub engine: Name,
    /// The number.
    #[serde(flatten)]
    pub row: wild::Row,
}

/// A case that an engine cannot express.
#[derive(Clone, Debug, Serialize)]
pub struct Missing {
    /// The engine.
    pub engine: Name,
    /// The case.
    pub case: String,
    /// What it has not.
    pub why: String,
}

/// How many cases an engine gets right, of those it can express.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Count {
    /// The engine.
    pub engine: Name,
    /// Of those it can express.
    #[serde(flatten)]
    pub tally: Tally,
}

/// What every engine makes of the cases.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Wild {
    /// Engine by engine.
    pub counts: Vec<Count>,
    /// Number by number.
    pub rows: Vec<Row>,
    /// What could not be run.
    pub gaps: Vec<Missing>,
}

/// Runs every case with every engine as it comes; `tell` hears the case that is about to be run.
pub fn run(cases: &[Case], mut tell: impl FnMut(&str)) -> Wild {
    let mut wild = Wild::default();
    for case in cases {
        tell(&case.name);
        for engine in Name::ALL {
            let rows = match engine {
                Name::Lamina2d => Ok(wild::rows(case, ours)),
                _ => peer(case, engine).map(|held| wild::rows(case, |_| Ok(held))),
            };
            match rows {
                Ok(rows) => wild.rows.extend(rows.into_iter().map(|row| Row { engine, row })),
                Err(why) => {
                    wild.gaps.push(Missing { engine, case: case.name.clone(), why: format!("{why:#}") });
                }
            }
        }
    }
    let of = |engine: Name| {
        let rows = wild.rows.iter().filter(|row| row.engine == engine);
        Count { engine, tally: tally(rows.map(|row| &row.row)) }
    };
    wild.counts = Name::ALL.map(of).into();
    wild
}

fn ours(case: &Case) -> anyhow::Result<Box<dyn Course>> {
    Ok(Box::new(wild::World::new(case, Precision::F32)?))
}

/// A case in another engine. What our own engine refuses before it is placed is no case for the others, which would have
/// to be asked in their own ways.
fn peer(case: &Case, engine: Name) -> anyhow::Result<Box<dyn Course>> {
    anyhow::ensure!(case.solver.is_none_or(|solver| solver == Solver::Soft), "another solver of lamina2d");
    let setup = Setup::new(engine);
    let setup = if case.sleep { setup.sleep() } else { setup };
    Ok(Box::new(Held(build(&case.scene, setup)?)))
}
