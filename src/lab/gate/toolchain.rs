//! What beside the code decides how many instructions it takes, and the tools that count them.

use std::process::{Command, Stdio};

use serde::{Deserialize, Serialize};

/// The version of iai-callgrind in Cargo.toml; its runner must have the same.
pub const FRAMEWORK_VERSION: &str = "0.16.1";

/// What installs the tools.
pub const INSTALL: &str =
    "apt-get install valgrind && cargo install --locked --version 0.16.1 iai-callgrind-runner";

/// What decides the counts beside the code: they compare only where all of it is the same.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Toolchain {
    /// The compiler's version.
    pub rustc: String,
    /// Valgrind's version.
    pub valgrind: String,
    /// The processor it is compiled for.
    pub target_cpu: String,
    /// What runs the benches under valgrind.
    pub framework: String,
}

impl std::fmt::Display for Toolchain {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { rustc, valgrind, target_cpu, framework } = self;
        write!(f, "rustc {rustc}, valgrind {valgrind}, target-cpu {target_cpu}, {framework}")
    }
}

/// A tool that counting needs.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ToolError {
    /// It is not there.
    #[error(
        "the gate needs valgrind and iai-callgrind-runner {FRAMEWORK_VERSION}: there is no {tool}: {INSTALL}"
    )]
    Absent {
        /// Its name.
        tool: &'static str,
    },
    /// It is another.
    #[error(
        "the gate needs iai-callgrind-runner {FRAMEWORK_VERSION}, this one is {found}: cargo install --locked \
         --version {FRAMEWORK_VERSION} --force iai-callgrind-runner"
    )]
    Version {
        /// What it says of itself.
        found: String,
    },
    /// Valgrind cannot run what is built.
    #[error(
        "valgrind knows no AVX-512, and this is built with it for target-cpu {0}: build for x86-64-v3, \
         RUSTFLAGS=\"-C target-cpu=x86-64-v3\""
    )]
    Processor(String),
}

impl Toolchain {
    /// Of this machine, with the flags this program was built with.
    ///
    /// # Errors
    /// Valgrind or the runner is absent, the runner is of another version than the library in Cargo.toml, or the flags
    /// ask for instructions valgrind does not know.
    pub fn find() -> Result<Self, ToolError> {
        let valgrind = said("valgrind", &["--version"]).ok_or(ToolError::Absent { tool: "valgrind" })?;
        let tool = "iai-callgrind-runner";
        let runner = said(tool, &["--version"]).ok_or(ToolError::Absent { tool })?;
        let found = runner_version(&runner);
        if found != Some(FRAMEWORK_VERSION) {
            return Err(ToolError::Version { found: found.unwrap_or("of an unknown version").to_owned() });
        }
        let target_cpu = target_cpu(crate::stamp::STAMP.flags);
        if cfg!(target_feature = "avx512f") {
            return Err(ToolError::Processor(target_cpu));
        }
        let rustc = std::env::var("RUSTC").unwrap_or_else(|_| "rustc".to_owned());
        let rustc = said(&rustc, &["--version"]).ok_or(ToolError::Absent { tool: "rustc" })?;
        Ok(Self {
            rustc: rustc.trim_start_matches("rustc ").to_owned(),
            valgrind: valgrind.trim_start_matches("valgrind-").to_owned(),
            target_cpu,
            framework: format!("iai-callgrind {FRAMEWORK_VERSION}"),
        })
    }
}

/// What a program prints on both streams; `None` where it does not exist.
fn said(program: &str, arguments: &[&str]) -> Option<String> {
    let output = Command::new(program).args(arguments).stdin(Stdio::null()).output().ok()?;
    let text = [output.stdout, output.stderr].concat();
    Some(String::from_utf8_lossy(&text).trim().to_owned())
}

/// The runner has no `--version`: whatever it is asked without a bench, it complains and says its own.
fn runner_version(said: &str) -> Option<&str> {
    let behind = said.split("iai-callgrind-runner").nth(1)?;
    let version = behind.trim_start_matches([' ', '(']);
    version.split(|c: char| !(c.is_ascii_digit() || c == '.')).next().filter(|version| !version.is_empty())
}

/// The `target-cpu` among compiler flags.
fn target_cpu(flags: &str) -> String {
    let mut named = flags.split_whitespace().filter_map(|flag| flag.split_once("target-cpu="));
    named.next_back().map_or_else(|| format!("that of {}", std::env::consts::ARCH), |(_, cpu)| cpu.to_owned())
}

/// The commit that is checked out, with `+changes` where files differ from it.
pub fn commit() -> String {
    let git = |arguments: &[&str]| {
        let output = Command::new("git").args(arguments).stderr(Stdio::null()).output().ok()?;
        output.status.success().then(|| String::from_utf8_lossy(&output.stdout).trim().to_owned())
    };
    let Some(commit) = git(&["rev-parse", "--short=12", "HEAD"]) else { return "unknown".to_owned() };
    let changed = git(&["status", "--porcelain", "--untracked-files=no"]);
    if changed.is_some_and(|changed| !changed.is_empty()) { format!("{commit}+changes") } else { commit }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_runner_tells_its_version_by_complaining() {
        let complaint = "iai_callgrind_runner: Error: No version information found for iai-callgrind but \
                         iai-callgrind-runner (0.16.1) is >= '0.3.0'. Please update";
        assert_eq!(runner_version(complaint), Some("0.16.1"));
        assert_eq!(runner_version("iai-callgrind-runner 0.17.0"), Some("0.17.0"));
        assert_eq!(runner_version("what?"), None);
        assert_eq!(runner_version("iai-callgrind-runner (new)"), None);
    }

    #[test]
    fn the_last_target_cpu_counts() {
        assert_eq!(target_cpu("-C target-cpu=x86-64-v3"), "x86-64-v3");
        assert_eq!(target_cpu("-Ctarget-cpu=a -C opt-level=3 -C target-cpu=b"), "b");
        assert!(target_cpu("").contains(std::env::consts::ARCH));
    }
}
