//! Dependencies between rooms run downward only: every path that source names is held against the tables of rooms at the
//! heads of the two packages.

#![expect(clippy::unwrap_used, reason = "what reads the sources is part of the test")]

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Row by row from the top, the rooms of a crate's table: words in back quotes in the first cells.
fn rows(head: &str) -> Vec<Vec<String>> {
    let cells = head.lines().filter_map(|line| line.strip_prefix("//! | ")?.split(" | ").next());
    let names = cells.map(|cell| cell.split('`').skip(1).step_by(2).map(|name| name.replace("mod@", "")));
    names.map(|names| names.filter(|name| !name.contains('/')).collect()).collect()
}

/// The level of each room, from the top: a row's last room lies highest in it.
fn levels(head: &str) -> BTreeMap<String, usize> {
    let names = rows(head).into_iter().flat_map(|row| row.into_iter().rev());
    names.enumerate().map(|(level, name)| (name, level)).collect()
}

fn sources(folder: &Path, out: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() && !path.ends_with("src/lab") && !path.ends_with("src/tests") {
            sources(&path, out);
        } else if path.extension().is_some_and(|e| e == "rs") {
            out.push(path);
        }
    }
}

/// The rooms that a line of code names after `crate::`, in braces too.
fn named(code: &str) -> Vec<String> {
    let mut names = Vec::new();
    for (at, found) in code.match_indices("crate::") {
        if code[..at].ends_with(|c: char| c.is_alphanumeric() || c == '_') {
            continue;
        }
        let rest = &code[at + found.len()..];
        let word = |text: &str| text.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect();
        match rest.strip_prefix('{') {
            None => names.push(word(rest)),
            Some(list) => {
                let list = list.split('}').next().unwrap_or(list);
                names.extend(list.split(',').map(|item| word(item.trim())));
            }
        }
    }
    names
}

/// Arrows of a package's sources that do not point downward: `file: room → room`.
fn upward(root: &Path, head: &str) -> (usize, Vec<String>) {
    let levels = levels(head);
    // None of the row of stages knows another.
    let stages =
        rows(head).into_iter().find(|row| row.iter().any(|room| room == "broad")).unwrap_or_default();
    let is_stage = |room: &str| stages.iter().any(|stage| stage == room);
    let mut files = Vec::new();
    sources(root, &mut files);
    let (mut arrows, mut wrong) = (0, Vec::new());
    for file in &files {
        let inside = file.strip_prefix(root).unwrap();
        let first = inside.components().next().unwrap().as_os_str().to_string_lossy();
        let own = first.trim_end_matches(".rs");
        if ["lib", "main", "build"].contains(&own) {
            continue;
        }
        let text = std::fs::read_to_string(file).unwrap();
        let code: Vec<_> = text.lines().filter(|line| !line.trim_start().starts_with("//")).collect();
        for room in named(&code.join("\n")).into_iter().filter(|room| room != own) {
            let Some(&to) = levels.get(&room) else { continue };
            let Some(&from) = levels.get(own) else {
                wrong.push(format!("{}: room {own} is in no row", inside.display()));
                continue;
            };
            arrows += 1;
            if to <= from || is_stage(own) && is_stage(&room) {
                wrong.push(format!("{}: {own} → {room}", inside.display()));
            }
        }
    }
    (arrows, wrong)
}

#[test]
fn rooms_know_only_what_lies_below_them() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    for (folder, least) in [(root.clone(), 200), (root.join("lab"), 30)] {
        let head = std::fs::read_to_string(folder.join("lib.rs")).unwrap();
        let (arrows, wrong) = upward(&folder, &head);
        assert!(arrows >= least, "{}: {arrows} arrows seen", folder.display());
        assert!(wrong.is_empty(), "{}: arrows that point upward:\n{}", folder.display(), wrong.join("\n"));
    }
}

/// The test would see one.
#[test]
fn an_upward_arrow_is_found() {
    let folder = tempfile::tempdir().unwrap();
    let head = "//! | room | what |\n//! |---|---|\n//! | [`top`] | |\n//! | [`left`], [`right`] | |\n//! | [`deep`] | |\n";
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
    write("top.rs", "use crate::{deep, left::Left};\n");
    write("right.rs", "use crate::left;\n// use crate::top;\n");
    write("left.rs", "use crate::deep::Deep;\n");
    assert_eq!(upward(folder.path(), head), (4, vec![]));
    write("deep.rs", "fn f() -> crate::top::Top {}\n");
    write("left.rs", "use crate::right;\n");
    let (_, mut wrong) = upward(folder.path(), head);
    wrong.sort();
    assert_eq!(wrong, ["deep.rs: deep → top", "left.rs: left → right"]);
}
