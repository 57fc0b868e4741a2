//! Writes down what numbers and recordings must say about their build: compiler, commit, profile, flags.
//!
//! Of laboratory and viewer, not of the engine: a commit rebuilds what says its name, and no more.

use std::path::{Path, PathBuf};
use std::process::Command;

fn output(program: &str, arguments: &[&str]) -> Option<String> {
    let output = Command::new(program).args(arguments).output().ok()?;
    let text = String::from_utf8(output.stdout).ok()?;
    output.status.success().then(|| text.trim().to_owned())
}

fn main() {
    let rustc = std::env::var("RUSTC").unwrap_or_else(|_| "rustc".to_owned());
    let version = output(&rustc, &["--version"]);
    let commit = output("git", &["rev-parse", "--short=12", "HEAD"]).map(|commit| {
        let changed = output("git", &["status", "--porcelain", "--untracked-files=no"]);
        if changed.is_some_and(|c| !c.is_empty()) { format!("{commit}+changes") } else { commit }
    });
    // Flags, not paths: what decides the code that was generated.
    let flags = std::env::var("CARGO_ENCODED_RUSTFLAGS").unwrap_or_default().replace('\u{1f}', " ");
    let profile = std::env::var("PROFILE").unwrap_or_default();
    let level = std::env::var("OPT_LEVEL").unwrap_or_default();
    for (name, value) in [
        ("LAMINA_RUSTC", version.unwrap_or_else(|| "unknown".to_owned())),
        ("LAMINA_COMMIT", commit.unwrap_or_else(|| "unknown".to_owned())),
        ("LAMINA_FLAGS", flags),
        ("LAMINA_PROFILE", format!("{profile}, opt-level {level}")),
    ] {
        println!("cargo::rustc-env={name}={value}");
    }
    // In a linked worktree they are not below .git; a path that does not exist would mean a build each time.
    for file in ["HEAD", "logs/HEAD"] {
        let path = output("git", &["rev-parse", "--path-format=absolute", "--git-path", file]);
        if let Some(path) = path.filter(|path| Path::new(path).exists()) {
            println!("cargo::rerun-if-changed={path}");
        }
    }
    // An edit makes the commit "+changes", and rebuilds in any case; tests are nobody's code but their own.
    let top = output("git", &["rev-parse", "--show-toplevel"]).map(|top| PathBuf::from(top).join("src"));
    let entries = top.and_then(|top| std::fs::read_dir(top).ok()).into_iter().flatten().flatten();
    for path in entries.map(|entry| entry.path()).filter(|path| !path.ends_with("tests")) {
        println!("cargo::rerun-if-changed={}", path.display());
    }
}
