//! The program: one JSON document with every field of the contract, a table, refusals with exit code 2.

use assert_cmd::Command;
use serde_json::Value;

fn peers(arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_lamina-peers"));
    command.args(arguments);
    command
}

const FIELDS: [&str; 13] = [
    "scene",
    "bodies",
    "engine",
    "version",
    "threads",
    "settings",
    "ms_per_step",
    "contacts",
    "max_penetration",
    "mean_penetration",
    "error",
    "hash",
    "momentum_error",
];

#[test]
fn json_has_the_contract() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("rows.json");
    let output =
        peers(&["stack/3", "roll", "chain/4", "--json", "--out", file.to_str().unwrap()]).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let document: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert!(document["machine"]["rustc"].is_string());
    for engine in document["engines"].as_array().unwrap() {
        for field in ["name", "version", "build", "defaults"] {
            assert!(!engine[field].is_null(), "{field}");
        }
        for field in ["compiler", "flags", "simd"] {
            assert!(engine["build"][field].is_string(), "{field}");
        }
    }
    let rows = document["rows"].as_array().unwrap();
    for row in rows {
        for field in FIELDS {
            assert!(row.get(field).is_some(), "{field}");
        }
        for field in ["min", "median", "p99"] {
            assert!(row["ms_per_step"][field].as_f64().unwrap() > 0.0, "{field}");
        }
        assert_eq!(row["finite"], true);
        assert_eq!(row["stopped"], Value::Null);
    }
    let engines: Vec<_> = rows.iter().filter(|r| r["scene"] == "stack/3").map(|r| &r["engine"]).collect();
    assert_eq!(engines, ["lamina2d", "box2d", "rapier2d"]);
    assert!(rows.iter().filter(|r| r["scene"] == "roll").all(|r| r["error"].as_f64().unwrap() < 0.1));
    let chains = rows.iter().filter(|r| r["scene"] == "chain/4");
    assert!(chains.clone().count() == 3 && chains.clone().all(|r| r["joint_gap"].as_f64().unwrap() < 0.02));
    let written: Value = serde_json::from_slice(&std::fs::read(file).unwrap()).unwrap();
    assert_eq!(written, document);
}

#[test]
fn a_scene_no_peer_can_run_is_a_gap_not_a_row() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("drag.toml");
    let text = "[settings]\nsteps = 4\n[forces]\nlinear_drag = 0.1\n[[body]]\nshape = { circle = 0.5 }\nposition = [0, 0]\n";
    std::fs::write(&file, text).unwrap();
    let output = peers(&[file.to_str().unwrap(), "--json"]).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let document: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(document["rows"].as_array().unwrap().len(), 1);
    let gaps = document["gaps"].as_array().unwrap();
    assert_eq!(gaps.len(), 2);
    assert!(gaps[0]["why"].as_str().unwrap().contains("it has no field linear_drag"));
}

#[test]
fn unknown_scenes_are_refused_with_the_choices() {
    for (arguments, says) in [
        (["nowhere", "--json"], "unknown scene 'nowhere': one of circles, "),
        (["stack/0", "--json"], "takes a number of boxes (1 to 1000000) after the slash, got '0'"),
        (["absent.toml", "--json"], "cannot read scene file absent.toml"),
    ] {
        let output = peers(&arguments).output().unwrap();
        assert_eq!(output.status.code(), Some(2));
        let said = String::from_utf8(output.stderr).unwrap();
        assert!(said.contains(says), "{said}");
        assert_eq!(said.lines().count(), 1, "{said}");
    }
}

#[test]
fn the_plan_is_listed() {
    for arguments in [&["--list"][..], &["--list", "--quick"]] {
        let output = peers(arguments).output().unwrap();
        assert!(output.status.success());
        let said = String::from_utf8(output.stdout).unwrap();
        assert!(said.contains("stack/10, "), "{said}");
    }
}

/// Every engine is held to the same numbers; what it cannot express is a gap, and counts follow from the rows.
#[test]
fn wild_cases_are_counted_by_engine() {
    let output = peers(&["wild", "margins", "events", "--json"]).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let document: Value = serde_json::from_slice(&output.stdout).unwrap();
    let (rows, counts) = (document["rows"].as_array().unwrap(), document["counts"].as_array().unwrap());
    for (count, engine) in counts.iter().zip(["lamina2d", "box2d", "rapier2d"]) {
        assert_eq!(count["engine"], engine);
        let of = |row: &&Value| row["engine"] == engine;
        let names = |met: bool| -> std::collections::BTreeSet<_> {
            let found = rows.iter().filter(of).filter(|row| !met || row["met"] == false);
            found.map(|row| row["case"].as_str().unwrap()).collect()
        };
        let (all, wrong) = (names(false).len(), names(true).len());
        assert_eq!(
            (count["cases"].as_u64().unwrap(), count["right"].as_u64().unwrap()),
            (all as u64, (all - wrong) as u64)
        );
        assert!(all >= 8 && all - wrong >= 4, "{engine}: {wrong} of {all} wrong");
    }
    let gaps = document["gaps"].as_array().unwrap();
    assert!(
        gaps.len() >= 16 && gaps.iter().all(|gap| gap["why"].as_str().unwrap().contains("done to it")),
        "{gaps:?}"
    );
}
