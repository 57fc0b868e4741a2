//! Writes down what the JSON must say about the peers' builds: the C compiler, its flags, the versions.

use std::path::Path;
use std::process::Command;

/// The arguments boxdd-sys has its C files compiled with: its own, and after them those of `CFLAGS_<target>`.
///
/// The same calls as in its build script, and `cc` answers the same way to both. Paths are left out.
fn c_build() -> Option<(String, String)> {
    let release = std::env::var("PROFILE").is_ok_and(|profile| profile == "release");
    let mut build = cc::Build::new();
    build.flag("-std=c17").flag("-ffp-contract=off").debug(!release).opt_level(if release { 2 } else { 0 });
    if std::env::var("CARGO_CFG_TARGET_ARCH").is_ok_and(|arch| arch == "x86_64") {
        build.define("BOX2D_AVX2", None).flag_if_supported("-mavx2");
    }
    let compiler = build.try_get_compiler().ok()?;
    let said = Command::new(compiler.path()).arg("--version").output().ok()?;
    let version = String::from_utf8_lossy(&said.stdout).lines().next()?.trim().to_owned();
    let flags: Vec<_> = compiler.args().iter().map(|a| a.to_string_lossy()).collect();
    Some((version, flags.join(" ")))
}

/// The version of a package in the workspace's lock file.
fn locked(lock: &str, package: &str) -> String {
    let entry = lock.split("[[package]]").find(|entry| entry.contains(&format!("name = \"{package}\"\n")));
    let version = entry.and_then(|entry| entry.lines().find_map(|line| line.strip_prefix("version = ")));
    version.map_or_else(|| "unknown".to_owned(), |version| version.trim_matches('"').to_owned())
}

fn main() {
    let root = Path::new("../..");
    let lock = std::fs::read_to_string(root.join("Cargo.lock")).unwrap_or_default();
    let (compiler, flags) = c_build().unwrap_or_else(|| ("unknown".to_owned(), "unknown".to_owned()));
    for (name, value) in [
        ("PEERS_C_COMPILER", compiler),
        ("PEERS_C_FLAGS", flags),
        ("PEERS_BOXDD", locked(&lock, "boxdd-sys")),
        ("PEERS_RAPIER", locked(&lock, "rapier2d")),
        ("PEERS_PARRY", locked(&lock, "parry2d")),
    ] {
        println!("cargo::rustc-env={name}={value}");
    }
    println!("cargo::rerun-if-changed=src/build.rs");
    println!("cargo::rerun-if-changed=../../Cargo.lock");
}
