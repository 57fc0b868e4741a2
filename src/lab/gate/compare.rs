//! Old counts against new ones.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

/// What was counted: it decides by how much a count may change.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Kind {
    /// One call of a stage's kernel.
    Kernel,
    /// [`super::STEPS_PER_COUNT`] steps of a scene.
    Steps,
}

impl Kind {
    /// The change that is allowed, in thousandths of the old count, inclusive.
    pub const fn per_mille(self) -> u64 {
        match self {
            Self::Kernel => 2,
            Self::Steps => 10,
        }
    }
}

/// Instructions by the benches' names.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Counts {
    /// Of one call of each kernel.
    pub kernels: BTreeMap<String, u64>,
    /// Of [`super::STEPS_PER_COUNT`] steps of each scene.
    pub steps: BTreeMap<String, u64>,
}

impl Counts {
    /// The counts of a kind.
    pub fn of(&self, kind: Kind) -> &BTreeMap<String, u64> {
        match kind {
            Kind::Kernel => &self.kernels,
            Kind::Steps => &self.steps,
        }
    }

    /// The counts of a kind, to change.
    pub fn of_mut(&mut self, kind: Kind) -> &mut BTreeMap<String, u64> {
        match kind {
            Kind::Kernel => &mut self.kernels,
            Kind::Steps => &mut self.steps,
        }
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.kernels.len() + self.steps.len()
    }

    /// Is there none?
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The name of a bench that counted nothing.
    pub fn zero(&self) -> Option<&str> {
        let all = self.kernels.iter().chain(&self.steps);
        all.filter(|(_, count)| **count == 0).map(|(name, _)| name.as_str()).next()
    }
}

/// What became of a count.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// The same to the instruction.
    Same,
    /// Another, within the bound.
    Within,
    /// Fewer than the bound allows: to be blessed, so that it is kept.
    Fewer,
    /// More than the bound allows.
    More,
    /// A bench that counted nothing.
    Zero,
    /// In the baseline, but it did not run.
    NotRun,
    /// It ran, but is not in the baseline.
    NotBlessed,
}

impl Verdict {
    /// Does the gate stay shut?
    pub const fn fails(self) -> bool {
        matches!(self, Self::More | Self::Zero | Self::NotRun | Self::NotBlessed)
    }

    /// In a word or two.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Same => "same",
            Self::Within => "within",
            Self::Fewer => "fewer: bless it",
            Self::More => "MORE",
            Self::Zero => "ZERO",
            Self::NotRun => "NOT RUN",
            Self::NotBlessed => "NOT BLESSED",
        }
    }

    fn of(kind: Kind, old: Option<u64>, new: Option<u64>) -> Self {
        let (old, new) = match (old, new) {
            (_, Some(0)) | (Some(0), _) => return Self::Zero,
            (_, None) => return Self::NotRun,
            (None, _) => return Self::NotBlessed,
            (Some(old), Some(new)) => (old, new),
        };
        let past = 1000 * u128::from(old.abs_diff(new)) > u128::from(kind.per_mille()) * u128::from(old);
        match (past, new.cmp(&old)) {
            (_, std::cmp::Ordering::Equal) => Self::Same,
            (false, _) => Self::Within,
            (true, std::cmp::Ordering::Less) => Self::Fewer,
            (true, std::cmp::Ordering::Greater) => Self::More,
        }
    }
}

/// One bench, old and new.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Row {
    /// The bench's name, as criterion has it.
    pub name: String,
    /// What it counts.
    pub kind: Kind,
    /// Instructions that were blessed.
    pub old: Option<u64>,
    /// Instructions counted now.
    pub new: Option<u64>,
    /// New less old, over old; where both are there.
    pub change: Option<f64>,
    /// The change that is allowed, a share of the old count.
    pub bound: f64,
    /// What follows.
    pub verdict: Verdict,
}

/// All benches, kernels first, each kind by name.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Comparison {
    /// One per bench that either side knows.
    pub rows: Vec<Row>,
}

/// Compares every bench that either side knows.
pub fn compare(old: &Counts, new: &Counts) -> Comparison {
    let mut rows = Vec::new();
    for kind in [Kind::Kernel, Kind::Steps] {
        let (old, new) = (old.of(kind), new.of(kind));
        let names: std::collections::BTreeSet<_> = old.keys().chain(new.keys()).collect();
        rows.extend(names.into_iter().map(|name| {
            let (old, new) = (old.get(name).copied(), new.get(name).copied());
            let change = old.zip(new).filter(|(old, _)| *old > 0);
            Row {
                name: name.clone(),
                kind,
                old,
                new,
                change: change.map(|(old, new)| (new as f64 - old as f64) / old as f64),
                bound: kind.per_mille() as f64 / 1000.0,
                verdict: Verdict::of(kind, old, new),
            }
        }));
    }
    Comparison { rows }
}

impl Comparison {
    /// Does the gate open? Not if a bench fails, and not where there is none.
    pub fn passes(&self) -> bool {
        !self.rows.is_empty() && !self.rows.iter().any(|row| row.verdict.fails())
    }

    /// How many benches have a verdict.
    pub fn count(&self, verdict: Verdict) -> usize {
        self.rows.iter().filter(|row| row.verdict == verdict).count()
    }

    /// The geometric mean of new over old, over the benches both sides know; `None` where there is none.
    pub fn mean_ratio(&self) -> Option<f64> {
        let both = |row: &Row| row.old.zip(row.new).filter(|&(old, new)| old > 0 && new > 0);
        let logs: Vec<f64> =
            self.rows.iter().filter_map(both).map(|(old, new)| (new as f64 / old as f64).ln()).collect();
        (!logs.is_empty()).then(|| (logs.iter().sum::<f64>() / logs.len() as f64).exp())
    }

    /// What a shut gate says: how many of what, and the first names.
    pub fn failure(&self) -> Option<String> {
        if self.rows.is_empty() {
            return Some("nothing was counted".to_owned());
        }
        let failed: Vec<_> = self.rows.iter().filter(|row| row.verdict.fails()).collect();
        let said = |row: &&Row| {
            let change = row.change.map(|change| format!(" ({:+.2} %)", change * 100.0));
            format!("{} {}{}", row.name, row.verdict.name(), change.unwrap_or_default())
        };
        let mut names: Vec<_> = failed.iter().take(5).map(said).collect();
        if failed.len() > names.len() {
            names.push(format!("and {} more", failed.len() - names.len()));
        }
        let all = self.rows.len();
        (!failed.is_empty()).then(|| format!("{} of {all} benches: {}", failed.len(), names.join(", ")))
    }
}
