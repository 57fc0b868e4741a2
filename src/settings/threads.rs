//! How many threads a step is done by.

use serde::{Deserialize, Serialize};

use super::SettingsError;

/// Threads at most.
pub const MOST_THREADS: usize = 16;

/// How many threads a step is done by: written as a number, or `auto`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(try_from = "Written", into = "Written")]
pub enum Threads {
    /// As many as the machine has cores, or one where bodies are too few to share.
    Auto,
    /// So many.
    Exactly(usize),
}

impl Threads {
    /// The thread that calls for the step.
    pub const ONE: Self = Self::Exactly(1);

    /// Is it [`Threads::ONE`]?
    pub fn is_one(&self) -> bool {
        *self == Self::ONE
    }

    /// Refuses numbers that cannot be run with.
    pub(super) fn check(self) -> Result<(), SettingsError> {
        match self {
            Self::Exactly(count) if !(1..=MOST_THREADS).contains(&count) => {
                Err(SettingsError::Threads(count))
            }
            _ => Ok(()),
        }
    }
}

impl Default for Threads {
    fn default() -> Self {
        Self::ONE
    }
}

impl std::fmt::Display for Threads {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Auto => f.write_str("auto"),
            Self::Exactly(count) => write!(f, "{count}"),
        }
    }
}

impl std::str::FromStr for Threads {
    type Err = String;
    fn from_str(given: &str) -> Result<Self, String> {
        let refused = || format!("threads must be auto or 1 to {MOST_THREADS}, got '{given}'");
        let threads =
            if given == "auto" { Self::Auto } else { Self::Exactly(given.parse().map_err(|_| refused())?) };
        threads.check().map_err(|_| refused()).map(|()| threads)
    }
}

/// As files have it.
#[derive(Serialize, Deserialize)]
#[serde(untagged)]
enum Written {
    Number(usize),
    Word(String),
}

impl From<Threads> for Written {
    fn from(threads: Threads) -> Self {
        match threads {
            Threads::Auto => Self::Word("auto".to_owned()),
            Threads::Exactly(count) => Self::Number(count),
        }
    }
}

impl TryFrom<Written> for Threads {
    type Error = String;
    fn try_from(written: Written) -> Result<Self, String> {
        match written {
            Written::Number(count) => count.to_string().parse(),
            Written::Word(word) => word.parse(),
        }
    }
}
