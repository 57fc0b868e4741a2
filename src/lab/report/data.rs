//! What a report consists of: the list of experiments and their rows.

use serde::Serialize;
use serde_json::{Map, Value, json};

use super::experiments::{
    accuracy, broad_phase, contacts, determinism, flight, lanes, limits, matrix, recording, skips, sleep,
    stability,
};
use super::headline::{Headline, headlines};
use super::peers::{self, Peers};
use super::strip::Strip;
use super::sweep::{self, Sweep};
use super::wild;
use super::{Machine, instructions};
use crate::accuracy::Line;
use crate::present::Earlier;
use crate::present::table::{Record, Table};
use crate::stress::{self, LimitLine, PassLine};

/// Everything a report shows.
#[derive(Clone, Debug, Serialize)]
pub struct Data {
    /// Where and with which build.
    pub machine: Machine,
    /// Quick mode: fewer bodies and repeats.
    pub quick: bool,
    /// Shape mix × integrator × bodies × lanes, beside the baseline.
    pub matrix: Vec<matrix::Row>,
    /// Broad phase on and off.
    pub broad_phase: Vec<broad_phase::Row>,
    /// Two runs, compared by bits.
    pub determinism: Vec<determinism::Row>,
    /// Kernels at each width.
    pub lanes: Vec<lanes::Row>,
    /// Where a step of a settled pile goes.
    pub contacts: Vec<contacts::Row>,
    /// Piles that are hard to hold, by every solver.
    pub stability: Vec<stability::Row>,
    /// Piles awake and asleep.
    pub sleep: Vec<sleep::Row>,
    /// Run time against error of every case.
    #[serde(skip)]
    pub accuracy: accuracy::Accuracy,
    /// What recording costs.
    pub recording: Vec<recording::Row>,
    /// Each skip on and off.
    pub skips: Vec<skips::Row>,
    /// Free flight against copy bandwidth.
    pub flight: Vec<flight::Row>,
    /// What the machine can copy and calculate.
    pub limits: Vec<limits::Row>,
    /// Experiments that an interrupted run did not come to.
    pub not_run: Vec<&'static str>,
    /// The accuracy sweep of a full report, shown where this one has none.
    #[serde(skip)]
    pub earlier_accuracy: Option<Sweep>,
    /// What `lamina-peers` measured, in a file of its own.
    #[serde(skip)]
    pub peers: Option<Peers>,
    /// What `lamina gate` holds, in a file of its own.
    #[serde(skip)]
    pub instructions: (Vec<instructions::Row>, Option<Earlier>),
    /// What `lamina stress` found, in a file of its own.
    #[serde(skip)]
    pub stress: (Vec<stress::Row>, Option<Earlier>),
    /// What `lamina-peers wild` found, in a file of its own.
    #[serde(skip)]
    pub wild: (Vec<wild::Line>, Option<Earlier>),
    /// What the scenes look like, in files of their own.
    #[serde(skip)]
    pub strips: Vec<Strip>,
}

/// One experiment: fills its rows of a report.
#[derive(Clone, Copy, Debug)]
pub struct Experiment {
    /// What `lamina report --only` calls it: the name of its table.
    pub name: &'static str,
    /// Is it part of a quick report?
    quick: bool,
    run: fn(&mut Data, Tick<'_>) -> anyhow::Result<()>,
}

/// Called between the rounds of an experiment; an error of it ends the experiment.
pub(super) type Tick<'a> = &'a mut dyn FnMut() -> anyhow::Result<()>;

/// The run was asked to end: what was measured before is kept.
#[derive(Clone, Copy, Debug, thiserror::Error)]
#[error("interrupted")]
pub struct Stopped;

impl Experiment {
    /// Those of a quick report, or all.
    pub fn of_report(quick: bool) -> Vec<Self> {
        EXPERIMENTS.iter().filter(|experiment| experiment.quick || !quick).copied().collect()
    }
}

/// All experiments, in the order in which they run.
pub const EXPERIMENTS: &[Experiment] = &[
    Experiment {
        name: matrix::Row::NAME,
        quick: true,
        run: |data, tick| {
            data.matrix = matrix::run(&plan(data.quick), tick)?;
            Ok(())
        },
    },
    Experiment {
        name: broad_phase::Row::NAME,
        quick: true,
        run: |data, _| {
            data.broad_phase = broad_phase::run(data.quick, if data.quick { 4 } else { 16 })?;
            Ok(())
        },
    },
    Experiment {
        name: determinism::Row::NAME,
        quick: true,
        run: |data, _| {
            data.determinism = determinism::run()?;
            Ok(())
        },
    },
    Experiment {
        name: lanes::Row::NAME,
        quick: true,
        run: |data, _| {
            data.lanes = lanes::run(if data.quick { 8 } else { 40 })?;
            Ok(())
        },
    },
    Experiment {
        name: contacts::Row::NAME,
        quick: true,
        run: |data, _| {
            data.contacts = contacts::run(data.quick, if data.quick { 5 } else { 20 })?;
            Ok(())
        },
    },
    Experiment {
        name: stability::Row::NAME,
        quick: false,
        run: |data, _| {
            data.stability = stability::run(data.quick, if data.quick { 2.0 } else { 10.0 })?;
            Ok(())
        },
    },
    Experiment {
        name: Line::NAME,
        quick: false,
        run: |data, tick| {
            data.accuracy = accuracy::run(tick)?;
            Ok(())
        },
    },
    Experiment {
        name: sleep::Row::NAME,
        quick: true,
        run: |data, _| {
            data.sleep = sleep::run(data.quick)?;
            Ok(())
        },
    },
    Experiment {
        name: skips::Row::NAME,
        quick: true,
        run: |data, _| {
            data.skips = skips::run(if data.quick { 4 } else { 16 })?;
            Ok(())
        },
    },
    Experiment {
        name: recording::Row::NAME,
        quick: true,
        run: |data, _| {
            data.recording = recording::run(data.quick)?;
            Ok(())
        },
    },
    Experiment {
        name: flight::Row::NAME,
        quick: true,
        run: |data, _| {
            data.flight = flight::run(if data.quick { 20 } else { 100 })?;
            Ok(())
        },
    },
    Experiment {
        name: limits::Row::NAME,
        quick: true,
        run: |data, _| {
            data.limits = limits::run(if data.quick { 8 } else { 40 });
            Ok(())
        },
    },
];

fn plan(quick: bool) -> matrix::Plan {
    if quick { matrix::Plan::quick() } else { matrix::Plan::full() }
}

impl Data {
    /// A report of this machine without a row.
    pub fn empty(quick: bool) -> Self {
        Self {
            machine: Machine::read(),
            quick,
            matrix: Vec::new(),
            broad_phase: Vec::new(),
            determinism: Vec::new(),
            lanes: Vec::new(),
            contacts: Vec::new(),
            stability: Vec::new(),
            accuracy: accuracy::Accuracy::default(),
            sleep: Vec::new(),
            skips: Vec::new(),
            flight: Vec::new(),
            recording: Vec::new(),
            limits: Vec::new(),
            not_run: Vec::new(),
            earlier_accuracy: None,
            peers: None,
            instructions: Default::default(),
            stress: Default::default(),
            wild: Default::default(),
            strips: Vec::new(),
        }
    }

    /// How often [`Data::measure`] calls its `tick`.
    pub fn rounds(quick: bool, experiments: &[Experiment]) -> u64 {
        let of = |e: &Experiment| match e.name {
            matrix::Row::NAME => plan(quick).rounds() + 1,
            Line::NAME => accuracy::rounds() + 1,
            _ => 1,
        };
        experiments.iter().map(of).sum()
    }

    /// Runs these experiments; `tick` is told what is being done, and that another round of it is. Where it answers
    /// [`Stopped`], what was measured so far is the report, and [`Data::not_run`] names the rest.
    ///
    /// # Errors
    /// A scene that cannot be run, results that differ between lane widths.
    pub fn measure(
        quick: bool,
        experiments: &[Experiment],
        tick: &mut dyn FnMut(&'static str) -> Result<(), Stopped>,
    ) -> anyhow::Result<Self> {
        let mut data = Self::empty(quick);
        for (k, experiment) in experiments.iter().enumerate() {
            let mut round = || Ok(tick(experiment.name)?);
            let done = round().and_then(|()| (experiment.run)(&mut data, &mut round));
            if let Err(error) = done {
                if !error.is::<Stopped>() {
                    return Err(error);
                }
                data.not_run = experiments[k..].iter().map(|experiment| experiment.name).collect();
                break;
            }
        }
        Ok(data)
    }

    /// The headline: how many times faster than the baseline with its Euler each mix runs, at 8 lanes.
    pub fn headlines(&self) -> Vec<Headline> {
        headlines(self)
    }

    /// What it found, in at most five lines.
    pub fn five_lines(&self) -> Vec<String> {
        super::headline::five_lines(self)
    }

    /// Every table that has rows, in the order of the page.
    ///
    /// # Errors
    /// A row that has no JSON.
    pub fn tables(&self) -> anyhow::Result<Vec<Table>> {
        let of_peers = || self.peers.as_ref().map(|peers| peers.machine.clone());
        let (rows_of_stress, of_stress) = &self.stress;
        let own = [
            Table::of(&self.headlines())?,
            Table::of(&self.matrix)?,
            Table::of(&self.broad_phase)?,
            Table::of(&self.determinism)?,
            Table::of(&self.stability)?,
            Table::of(&self.peers.as_ref().map(Peers::scenes).unwrap_or_default())?.of_run(of_peers()),
            Table::of(self.peers.as_ref().map_or(&[][..], |peers| &peers.rows))?.of_run(of_peers()),
            Table::of(&self.wild.0)?.of_run(self.wild.1.clone()),
            Table::of(&stress::pass_lines(rows_of_stress))?.of_run(of_stress.clone()),
            Table::of(&stress::limit_lines(rows_of_stress))?.of_run(of_stress.clone()),
            Table::of(&self.contacts)?,
            Table::of(&self.lanes)?,
            Table::of(&self.skips)?,
            Table::of(&self.sleep)?,
            Table::of(&self.recording)?,
            Table::of(&self.instructions.0)?.of_run(self.instructions.1.clone()),
            Table::of(&limits::shares(self))?,
            Table::of(&self.limits)?,
            Table::of(&self.flight)?,
        ];
        let accuracy = sweep::tables(&self.accuracy)?;
        let measured = own.into_iter().chain(accuracy).filter(|table| !table.raw.is_empty());
        Ok(measured.chain(self.earlier_accuracy.iter().flat_map(|sweep| sweep.tables.clone())).collect())
    }

    /// What `lamina report --json` prints: the result table under `rows`, every other table under its name.
    ///
    /// # Errors
    /// A row that has no JSON.
    pub fn summary(&self) -> anyhow::Result<Value> {
        let mut summary = Map::new();
        for table in self.tables()?.into_iter().filter(|table| table.earlier.is_none()) {
            // The matrix is large, and in the report's folder.
            match table.name.as_str() {
                matrix::Row::NAME if !self.headlines().is_empty() => {}
                // In files of their own.
                peers::Row::NAME
                | instructions::Row::NAME
                | PassLine::NAME
                | LimitLine::NAME
                | wild::Line::NAME => {}
                Headline::NAME => {
                    summary.insert("rows".to_owned(), json!(table.raw));
                }
                name => {
                    summary.insert(name.to_owned(), json!(table.raw));
                }
            }
        }
        Ok(Value::Object(summary))
    }
}
