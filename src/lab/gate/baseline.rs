//! The file of blessed counts.

use std::collections::BTreeMap;
use std::path::Path;

use serde::{Deserialize, Serialize};

use super::{Counts, Toolchain};

/// What the file says to who opens it.
const HEADER: &str = "\
# Instructions by callgrind, per toolchain: of a kernel one call, of a scene 20 steps.
# `lamina gate` holds kernels to 0.2 %, scenes to 1 %. Written by `lamina gate --bless REASON`.

";

/// Why the file of blessed counts cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum BaselineError {
    /// There is none.
    #[error("no baseline: there is no file {path}, make one with lamina gate --bless REASON")]
    Missing {
        /// Its path.
        path: String,
    },
    /// It cannot be read.
    #[error("cannot read baseline {path}: {why}")]
    Unreadable {
        /// Its path.
        path: String,
        /// The system's reason.
        why: std::io::Error,
    },
    /// It is not what it should be.
    #[error("baseline {path}: {why}")]
    Syntax {
        /// Its path.
        path: String,
        /// Line, field and value.
        why: String,
    },
}

/// The file: counts of every toolchain that has been blessed.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Baselines {
    /// One per toolchain, in the order they first came.
    #[serde(default)]
    pub baseline: Vec<Baseline>,
}

/// The counts of one toolchain.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Baseline {
    /// Why counts were blessed, newest last: commit and reason.
    pub reasons: Vec<String>,
    /// What took them.
    pub toolchain: Toolchain,
    /// Instructions of one call, by name.
    pub kernels: BTreeMap<String, u64>,
    /// Instructions of [`super::STEPS_PER_COUNT`] steps, by name.
    pub steps: BTreeMap<String, u64>,
}

impl Baseline {
    /// The counts.
    pub fn counts(&self) -> Counts {
        Counts { kernels: self.kernels.clone(), steps: self.steps.clone() }
    }
}

/// Reads the file of blessed counts.
///
/// # Errors
/// A file that is missing, unreadable, or not of this form: unknown keys, values of another type, a count of 0, two
/// entries for one toolchain.
pub fn baseline(path: &Path) -> Result<Baselines, BaselineError> {
    let shown = || path.display().to_string();
    let text = std::fs::read_to_string(path).map_err(|why| match why.kind() {
        std::io::ErrorKind::NotFound => BaselineError::Missing { path: shown() },
        _ => BaselineError::Unreadable { path: shown(), why },
    })?;
    let syntax = |why: String| BaselineError::Syntax { path: shown(), why };
    let read: Baselines = toml::from_str(&text).map_err(|error| syntax(error.to_string()))?;
    for (k, entry) in read.baseline.iter().enumerate() {
        if let Some(name) = entry.counts().zero() {
            return Err(syntax(format!("the count of '{name}' is 0 for {}", entry.toolchain)));
        }
        if read.baseline[..k].iter().any(|other| other.toolchain == entry.toolchain) {
            return Err(syntax(format!("two entries for {}", entry.toolchain)));
        }
    }
    Ok(read)
}

impl Baselines {
    /// The entry of a toolchain.
    pub fn of(&self, toolchain: &Toolchain) -> Option<&Baseline> {
        self.baseline.iter().find(|entry| entry.toolchain == *toolchain)
    }

    /// What is said where a toolchain has no counts: which it is, and those that have.
    pub fn unknown(&self, toolchain: &Toolchain) -> String {
        let known: Vec<_> = self.baseline.iter().map(|entry| entry.toolchain.to_string()).collect();
        let known = if known.is_empty() { "none".to_owned() } else { known.join("; ") };
        format!(
            "no baseline for this toolchain: {toolchain} (blessed: {known}); bless one with lamina gate --bless REASON"
        )
    }

    /// Takes new counts for a toolchain; reasons and other toolchains are kept.
    pub fn bless(&mut self, toolchain: &Toolchain, counts: &Counts, reason: String) {
        let Counts { kernels, steps } = counts.clone();
        if let Some(entry) = self.baseline.iter_mut().find(|entry| entry.toolchain == *toolchain) {
            entry.reasons.push(reason);
            (entry.kernels, entry.steps) = (kernels, steps);
        } else {
            let toolchain = toolchain.clone();
            self.baseline.push(Baseline { reasons: vec![reason], toolchain, kernels, steps });
        }
    }

    /// The file's text: one line per bench, by name.
    ///
    /// # Errors
    /// Never with the types it holds.
    pub fn to_text(&self) -> Result<String, toml::ser::Error> {
        Ok(format!("{HEADER}{}", toml::to_string_pretty(self)?))
    }
}
