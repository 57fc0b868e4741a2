//! What the tests of the program share: running `lamina`, and what every answer of it must be.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

use std::path::{Path, PathBuf};

use assert_cmd::cargo::cargo_bin_cmd;
use serde_json::Value;
use tempfile::TempDir;

/// What one run of the program left behind.
#[derive(Debug)]
pub(crate) struct Answer {
    /// What was asked, for messages.
    pub(crate) asked: String,
    /// The exit code.
    pub(crate) code: Option<i32>,
    /// Standard output.
    pub(crate) out: String,
    /// Standard error.
    pub(crate) err: String,
}

/// Runs `lamina` with arguments.
pub(crate) fn lamina(args: &[&str]) -> Answer {
    let output = cargo_bin_cmd!("lamina").args(args).output().unwrap();
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
    let answer = Answer {
        asked: args.join(" "),
        code: output.status.code(),
        out: text(output.stdout),
        err: text(output.stderr),
    };
    assert!(!answer.err.contains("panicked"), "{answer:#?}");
    answer
}

impl Answer {
    /// Nothing on stdout, one message on stderr that has each of `mentions`, and the exit code.
    pub(crate) fn fails(&self, code: i32, mentions: &[&str]) {
        assert_eq!(self.code, Some(code), "{self:#?}");
        assert!(self.out.is_empty(), "stdout is for results: {self:#?}");
        let said = |prefix| self.err.lines().filter(|line| line.starts_with(prefix)).count();
        assert_eq!(said("lamina: ") + said("error: "), 1, "one message: {self:#?}");
        for mention in mentions {
            assert!(self.err.contains(mention), "no '{mention}' in {self:#?}");
        }
        let first = self.err.lines().next().unwrap_or_default();
        let parts: Vec<_> = first.split(": ").collect();
        assert!(parts.windows(2).all(|w| w[0] != w[1]), "says it twice: {self:#?}");
    }
}

/// A folder that goes away with the test.
pub(crate) fn folder() -> TempDir {
    tempfile::tempdir().unwrap()
}

/// Writes a scene file.
pub(crate) fn write(folder: &Path, name: &str, content: impl AsRef<[u8]>) -> PathBuf {
    let path = folder.join(name);
    std::fs::write(&path, content).unwrap();
    path
}

/// Writes `text` as a scene file and runs it with further arguments.
pub(crate) fn run_file(text: &str, more: &[&str]) -> Answer {
    let folder = folder();
    let path = write(folder.path(), "scene.toml", text);
    let mut args = vec!["run", path.to_str().unwrap()];
    args.extend(more);
    let answer = lamina(&args);
    Answer { asked: format!("{}\n{text}", answer.asked), ..answer }
}

impl Answer {
    /// Exit code 0 and a quiet stderr; returns stdout.
    pub(crate) fn succeeds(&self) -> &str {
        assert_eq!(self.code, Some(0), "{self:#?}");
        assert!(self.err.is_empty(), "stderr is for problems: {self:#?}");
        &self.out
    }

    /// Stdout as one JSON object with `machine` whose numbers all are numbers.
    pub(crate) fn json(&self) -> Value {
        let document: Value = serde_json::from_str(self.succeeds()).unwrap_or_else(|e| {
            panic!("stdout is not one JSON document: {e}: {self:#?}");
        });
        let machine = &document["machine"];
        for field in ["cpu", "os", "rustc", "build", "flags", "commit", "version"] {
            assert!(machine[field].is_string(), "machine.{field}: {machine:#}");
        }
        assert!(machine["features"].is_array() && machine["threads"].is_u64(), "{machine:#}");
        document
    }
}

/// The paths of all nulls in a document: serde_json writes NaN and infinity as null.
pub(crate) fn nulls(path: &str, value: &Value) -> Vec<String> {
    match value {
        Value::Null => vec![path.to_owned()],
        Value::Object(fields) => fields.iter().flat_map(|(k, v)| nulls(&format!("{path}.{k}"), v)).collect(),
        Value::Array(items) => {
            items.iter().enumerate().flat_map(|(k, v)| nulls(&format!("{path}[{k}]"), v)).collect()
        }
        _ => Vec::new(),
    }
}
