//! The program's arguments: pictures without a display, and one sentence for what is refused.

mod common;

use std::path::Path;

use assert_cmd::Command;
use common::circles;

fn viewer(folder: &Path, arguments: &[&str]) -> (i32, String) {
    let mut command = Command::new(env!("CARGO_BIN_EXE_lamina-viewer"));
    command.current_dir(folder).env_remove("DISPLAY").env_remove("WAYLAND_DISPLAY").args(arguments);
    let output = command.output().expect("it runs");
    (output.status.code().expect("a code"), String::from_utf8_lossy(&output.stderr).into_owned())
}

#[test]
fn pictures_need_no_display() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    circles(folder);
    let taken =
        viewer(folder, &["circles.mcap", "--screenshot", "a.png", "--frame", "7", "--size", "640x480"]);
    assert_eq!(taken, (0, String::new()));
    assert!(folder.join("a.png").is_file());
    let taken = viewer(
        folder,
        &["circles.mcap", "--frames", "3..5", "--sequence", "s", "--size", "400x300", "--light"],
    );
    assert_eq!(taken, (0, String::new()));
    assert_eq!(folder.join("s").read_dir().expect("a folder").count(), 2);
}

#[test]
fn what_is_refused_is_named() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    circles(folder);
    std::fs::write(folder.join("notes.txt"), "words").expect("written");
    for (arguments, named) in [
        (vec!["missing.mcap"], "missing.mcap"),
        (vec!["notes.txt"], "notes.txt"),
        (vec!["circles.mcap", "notes.txt"], "notes.txt"),
        (vec!["circles.mcap", "--screenshot", "a.png", "--frame", "121"], "--frame 121"),
        (vec!["circles.mcap", "--frames", "9..200", "--sequence", "s"], "--frames 9..200"),
        (vec!["circles.mcap", "--frames", "9..3", "--sequence", "s"], "9..3"),
        (vec!["--sequence", "s"], "--sequence"),
        (vec!["--size", "12"], "'12'"),
        (vec!["--frame", "x"], "'x'"),
    ] {
        let (code, said) = viewer(folder, &arguments);
        assert_eq!(code, 2, "{arguments:?}: {said}");
        assert!(said.contains(named), "{arguments:?}: {said}");
        assert!(!said.contains("panicked"), "{said}");
    }
}
