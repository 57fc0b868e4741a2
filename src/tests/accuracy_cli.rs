//! `lamina accuracy` as users run it: files, the contract of its JSON, refusals.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

#[expect(dead_code, reason = "shared with tests that need more of it")]
mod common_cli;

use common_cli::{folder, lamina};
use lamina2d::accuracy::{CASES, FAILING};
use serde_json::Value;

const KEYS: [&str; 15] = [
    "case",
    "method",
    "integrator",
    "solver",
    "h",
    "substeps",
    "precision",
    "lanes",
    "error",
    "error_unit",
    "ns_per_step",
    "ns_total",
    "order",
    "target",
    "met",
];

fn rows(document: &Value) -> &Vec<Value> {
    document["rows"].as_array().unwrap()
}

/// Runs cases in a quick sweep into a folder of their own.
fn quick(cases: &[&str]) -> (tempfile::TempDir, Value) {
    let folder = folder();
    let out = folder.path().join("deep").join("er");
    let answer =
        lamina(&[&["accuracy", "--quick", "--json", "--out", out.to_str().unwrap()], cases].concat());
    assert_eq!(answer.code, Some(0), "{answer:#?}");
    (folder, serde_json::from_str(&answer.out).unwrap())
}

#[test]
fn rows_have_these_keys_and_two_runs_the_same_errors() {
    let cases = ["a01_gravity", "a05_oscillator", "a06_stiff", "a16_spin"];
    let (folder, first) = quick(&cases);
    let (_, second) = quick(&cases);
    assert!(rows(&first).len() > 100);
    for (a, b) in rows(&first).iter().zip(rows(&second)) {
        let keys: Vec<_> = a.as_object().unwrap().keys().map(String::as_str).collect();
        assert_eq!(keys, KEYS);
        for same in KEYS.iter().filter(|key| !key.starts_with("ns_")) {
            assert_eq!(a[same].to_string(), b[same].to_string(), "{same} of {a}");
        }
        assert!(a["error"].is_null() == a["ns_total"].is_null(), "a gap has neither error nor time: {a}");
        assert!(a["ns_per_step"].is_null() || a["ns_per_step"].as_f64().unwrap() > 0.0);
        assert_ne!(a["met"], false, "{a}");
    }
    for case in cases {
        for ending in ["csv", "json", "svg"] {
            let path = folder.path().join("deep").join("er").join(format!("{case}.{ending}"));
            assert!(std::fs::metadata(&path).unwrap().len() > 1000, "{}", path.display());
        }
    }
    assert_eq!(first["fastest"].as_array().unwrap().len(), cases.len());
    assert_eq!(first["failing"].as_array().unwrap().len(), FAILING.len());
}

/// The table of a run that is not JSON, and that what the folder holds is what was printed.
#[test]
fn the_table_says_orders_and_the_fastest() {
    let folder = folder();
    let answer = lamina(&["accuracy", "a05_oscillator", "--quick", "--out", folder.path().to_str().unwrap()]);
    assert_eq!(answer.code, Some(0), "{answer:#?}");
    for part in ["order 4", "Fastest at an error", "1e-6", "Cannot run", FAILING[0].name, "yosh"] {
        assert!(answer.out.contains(part), "no '{part}' in {}", answer.out);
    }
    let csv = std::fs::read_to_string(folder.path().join("a05_oscillator.csv")).unwrap();
    let header = csv.lines().next().unwrap();
    assert_eq!(header.split(',').count(), KEYS.len() + 1, "the keys and the median: {header}");
    assert_eq!(csv.lines().count(), 1 + 6 * 9 * 2, "integrators, steps, precisions");
}

#[test]
fn the_list_names_every_case_and_its_scene() {
    let document: Value = serde_json::from_str(&lamina(&["accuracy", "--list", "--json"]).out).unwrap();
    let names: Vec<_> = rows(&document).iter().map(|row| row["case"].as_str().unwrap()).collect();
    assert_eq!(names, CASES.iter().map(|case| case.name).collect::<Vec<_>>());
    // Every item of table A.
    for item in 1..=16 {
        let item = format!("A{item}");
        assert!(rows(&document).iter().any(|row| row["item"] == item), "{item} is missing");
    }
}

#[test]
fn unknown_and_failing_cases_are_refused_by_name() {
    lamina(&["accuracy", "a99"]).fails(2, &["unknown case 'a99'", "a01_gravity", "a16_spin"]);
    let failing = &FAILING[0];
    lamina(&["accuracy", failing.name]).fails(2, &[failing.name, "cannot run", failing.reason]);
    let folder = folder();
    let file = common_cli::write(folder.path(), "taken", "");
    let out = file.join("inside");
    lamina(&["accuracy", "a01_gravity", "--out", out.to_str().unwrap()]).fails(2, &["--out", "taken"]);
}
