//! What the tests of the program share: running `lamina`, and what every answer of it must be.

use std::path::{Path, PathBuf};

use assert_cmd::cargo::cargo_bin_cmd;
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
