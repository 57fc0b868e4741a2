//! `lamina accuracy` as users run it: files, the contract of its JSON, refusals.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

use lamina::accuracy::{CASES, FAILING};
use serde_json::Value;

use crate::shared_cli::{folder, lamina, write};

const KEYS: [&str; 18] = [
    "case",
    "method",
    "integrator",
    "solver",
    "h",
    "substeps",
    "stiffness",
    "precision",
    "lanes",
    "error",
    "error_unit",
    "ns_per_step",
    "ns_total",
    "order",
    "target",
    "met",
    "instructions_per_step",
    "instructions_total",
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
        assert!(a["instructions_total"].is_null(), "nothing was asked to be counted: {a}");
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

/// Counted instructions: the same twice, about as many per step at half the step, and more for the scheme of four stages. A row
/// without an error has none. Where there is no valgrind, a sentence.
#[test]
fn instructions_are_counted_or_it_says_what_is_missing() {
    let folder = folder();
    let out = folder.path().to_str().unwrap();
    let arguments = ["accuracy", "a02_linear_drag", "--quick", "--instructions", "--json", "--out", out];
    if std::process::Command::new("valgrind").arg("--version").output().is_err() {
        lamina(&arguments).fails(2, &["--instructions", "valgrind", "apt-get install"]);
        return;
    }
    let [first, second] = [(); 2].map(|()| {
        let answer = lamina(&arguments);
        assert_eq!(answer.code, Some(0), "{answer:#?}");
        serde_json::from_str::<Value>(&answer.out).unwrap()
    });
    let counts = |document: &Value, method: &str| -> Vec<f64> {
        let own = rows(document).iter().filter(|row| row["method"] == method && row["precision"] == "f32");
        own.map(|row| row["instructions_per_step"].as_f64().unwrap()).collect()
    };
    for method in ["semi_implicit_euler", "rk4"] {
        assert_eq!(counts(&first, method), counts(&second, method));
    }
    let [euler, rk4] = ["semi_implicit_euler", "rk4"].map(|method| counts(&first, method));
    assert!(euler.iter().zip(&rk4).all(|(euler, rk4)| euler > &1.0 && rk4 > euler), "{euler:?} {rk4:?}");
    assert!(euler.iter().all(|count| (count / euler[0] - 1.0).abs() < 0.5), "{euler:?}");
    assert!(folder.path().join("a02_linear_drag.instructions.svg").exists());
}

/// What a mix is asked, and what the rows answer.
#[test]
fn a_mix_is_answered_in_sentences() {
    let (_folder, document) = quick(&["m_circles_penetration", "m_circles_momentum", "m_all_penetration"]);
    let mix = &document["mixes"][0];
    assert_eq!(mix["mix"], "circles");
    let number = |field: &str| mix[field].as_f64().unwrap();
    assert!((1e-4..1e-2).contains(&number("penetration")), "{mix}");
    assert!(number("momentum") < 1e-4, "{mix}");
    assert!(number("growth_per_sec") > 1.0, "a pile is chaotic: {mix}");
    let answers = document["answers"].as_array().unwrap();
    for part in [
        "Shapes change accuracy",
        "costlier integrator",
        "Cheapest at an overlap of 1e-2 diameters: circles with",
    ] {
        assert!(
            answers.iter().any(|answer| answer.as_str().unwrap().contains(part)),
            "no '{part}' in {answers:?}"
        );
    }
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
    let file = write(folder.path(), "taken", "");
    let out = file.join("inside");
    lamina(&["accuracy", "a01_gravity", "--out", out.to_str().unwrap()]).fails(2, &["--out", "taken"]);
}
