//! Counts for other tools.

use std::path::Path;

use serde::{Deserialize, Serialize};
use serde_json::{Map, Value, json};

use super::{Comparison, Counts, Toolchain};

/// A form that other tools read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Export {
    /// Bencher Metric Format: `{"name": {"instructions": {"value": 1}}}`.
    Bencher,
    /// benchmark-action's `customSmallerIsBetter`: `[{"name": …, "unit": …, "value": 1}]`.
    GithubAction,
    /// Our own: toolchain, counts, and every bench's comparison.
    Json,
}

/// What [`Export::Json`] holds of a run, and what [`counted`] reads back.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Document {
    /// What took the counts.
    pub toolchain: Toolchain,
    /// The counts.
    pub counts: Counts,
}

/// A file of counts that cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum CountsError {
    /// It cannot be read.
    #[error("cannot read counts {path}: {why}")]
    Unreadable {
        /// Its path.
        path: String,
        /// The system's reason.
        why: std::io::Error,
    },
    /// It is not such a document.
    #[error("counts {path}: {why}")]
    Syntax {
        /// Its path.
        path: String,
        /// Where and why.
        why: serde_json::Error,
    },
}

/// Reads what [`Export::Json`] wrote: counts taken earlier or elsewhere.
///
/// # Errors
/// A file that cannot be read, or is no such document.
pub fn counted(path: &Path) -> Result<Document, CountsError> {
    let shown = path.display().to_string();
    let text =
        std::fs::read_to_string(path).map_err(|why| CountsError::Unreadable { path: shown.clone(), why })?;
    serde_json::from_str(&text).map_err(|why| CountsError::Syntax { path: shown, why })
}

impl Export {
    /// The document; `comparison` where there is something to compare with.
    pub fn write(self, document: &Document, comparison: Option<&Comparison>) -> Value {
        let counts = &document.counts;
        let all = || counts.kernels.iter().chain(&counts.steps);
        match self {
            Self::Bencher => {
                let entry = |(name, count): (&String, &u64)| {
                    (name.clone(), json!({"instructions": {"value": count}}))
                };
                Value::Object(all().map(entry).collect::<Map<_, _>>())
            }
            Self::GithubAction => {
                let entry = |(name, count): (&String, &u64)| json!({"name": name, "unit": "instructions", "value": count});
                Value::Array(all().map(entry).collect())
            }
            Self::Json => json!({
                "toolchain": document.toolchain,
                "steps_per_count": super::STEPS_PER_COUNT,
                "passes": comparison.is_some_and(Comparison::passes),
                "rows": comparison.map(|comparison| &comparison.rows),
                "counts": counts,
            }),
        }
    }
}
