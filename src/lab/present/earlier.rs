//! Where and when rows were measured that are not of the report's own run.

use std::fmt;

use serde::{Deserialize, Serialize};

/// The run that rows come from, where it is not the report's own.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Earlier {
    /// The commit it was built from.
    pub commit: String,
    /// The processor, or what took its place.
    pub cpu: String,
    /// When it was measured, UTC; files of before 2026-11-28 do not say.
    #[serde(default)]
    pub when: Option<String>,
}

impl fmt::Display for Earlier {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.when {
            Some(when) => write!(f, "measured {when} at commit {} on {}", self.commit, self.cpu),
            None => write!(f, "measured earlier, at commit {} on {}", self.commit, self.cpu),
        }
    }
}

impl Earlier {
    /// Of a document whose `machine` says where it is from; `None` where it does not.
    pub fn of(document: &serde_json::Value) -> Option<Self> {
        serde_json::from_value(document.get("machine")?.clone()).ok()
    }
}
