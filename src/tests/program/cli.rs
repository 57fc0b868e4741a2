//! Good runs of the program: each scene and a scene file run, every `--json` is one document with the
//! promised fields, a run that turns non-finite says where, and a reader may leave early.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

use std::io::Read;
use std::process::{Command, Stdio};

use assert_cmd::cargo::cargo_bin;
use lamina::cases::SCENES;
use lamina2d::measure::Stage;
use lamina2d::settings::Skip;
use serde_json::Value;

use crate::shared_cli::{Answer, folder, lamina, nulls, run_file};

/// One of each shape and kind, most fields, and settings that are not the defaults.
const SCENE_FILE: &str = r#"
about = "a bit of everything"

[settings]
dt = 0.01
steps = 20
integrator = "rk4"
solver = "impulse"
substeps = 2
broad = "sweep"
lanes = 4
precision = "f64"
skip = "closed_form,friction"
sleep = true

[forces]
gravity = [0, -9.81]
wind = [1, 0]
linear_drag = 0.1

[[body]]
shape = { box = [10, 0.5] }
position = [0, -0.5]
kind = "static"

[[body]]
shape = { circle = 0.5 }
position = [0, 0.5]
velocity = [1, 0]
mass = 2

[[body]]
shape = { polygon = [[0, 0], [1, 0], [0, 1]] }
position = [3, 2]
angle = 0.5
density = 3
friction = 0.2
restitution = 0.4

[[body]]
shape = { box = [0.5, 0.5] }
position = [-3, 2]
kind = "kinematic"
angular_velocity = 1
"#;

fn is_hash(value: &Value) -> bool {
    value.as_str().is_some_and(|h| h.len() == 16 && h.chars().all(|c| matches!(c, '0'..='9' | 'a'..='f')))
}

/// A test of a value's type.
type Is = fn(&Value) -> bool;

/// Holds a result of `run --json` against the promised fields and their types.
fn check_run(result: &Value) {
    let bad = |field: &str| panic!("{field} of {result:#}");
    let wanted: [(Is, &[&str]); 3] = [
        (Value::is_string, &["scene", "integrator", "solver", "broad", "precision", "hash"]),
        (Value::is_u64, &["bodies", "steps", "substeps", "lanes", "seed"]),
        (Value::is_f64, &["dt"]),
    ];
    for (is_right, fields) in wanted {
        fields.iter().filter(|f| !is_right(&result[**f])).for_each(|f| bad(f));
    }
    for (group, fields) in [
        ("ms_per_step", vec!["min", "median", "mean", "p99"]),
        ("stages_ns", Stage::ALL.iter().map(|s| s.name()).collect()),
        ("counts", vec!["candidates", "pairs", "contacts", "sleeping", "islands"]),
        (
            "error",
            vec![
                "max_penetration",
                "mean_penetration",
                "kinetic_energy",
                "potential_energy",
                "angular_momentum",
            ],
        ),
    ] {
        fields.iter().filter(|f| !result[group][**f].is_number()).for_each(|f| bad(f));
    }
    for skip in Skip::ALL {
        assert!(result["counts"]["skipped"][skip.name()].is_u64(), "{skip} of {result:#}");
    }
    let momentum = result["error"]["momentum"].as_array().unwrap();
    assert!(momentum.len() == 2 && momentum.iter().all(Value::is_number), "{result:#}");
    assert!(is_hash(&result["hash"]), "{result:#}");
    assert_eq!(nulls("result", result), [""; 0], "NaN or infinity in {result:#}");
}

#[test]
fn every_scene_runs_and_its_json_keeps_the_contract() {
    for info in SCENES {
        let result = lamina(&["run", info.name, "--steps", "3", "--json"]).json();
        check_run(&result);
        let scene = result["scene"].as_str().unwrap();
        assert!(scene.starts_with(info.name), "{scene} is not {}", info.name);
        assert_eq!(result["steps"], 3);
        let table = lamina(&["run", info.name, "--steps", "3"]);
        assert!(table.succeeds().contains(result["hash"].as_str().unwrap()), "{table:#?}");
    }
}

#[test]
fn every_option_reaches_the_run() {
    let line = "run polygons --bodies 40 --steps 5 --dt 0.005 --integrator yoshida4 --solver impulse \
                --substeps 3 --broad grid --lanes 4 --precision f64 --seed 7 --skip rotation,friction --sleep --json";
    let result = lamina(&line.split_whitespace().collect::<Vec<_>>()).json();
    check_run(&result);
    let said = |field: &str| result[field].to_string().replace('"', "");
    for (field, value) in [
        ("scene", "polygons/40"),
        ("bodies", "45"),
        ("steps", "5"),
        ("dt", "0.005"),
        ("integrator", "yoshida4"),
        ("solver", "impulse"),
        ("substeps", "3"),
        ("broad", "grid"),
        ("lanes", "4"),
        ("precision", "f64"),
        ("seed", "7"),
        ("skip", "rotation,friction"),
        ("sleep", "true"),
    ] {
        assert_eq!(said(field), value, "--{field}");
    }
}

#[test]
fn a_scene_file_runs_with_its_settings_and_options_win_over_them() {
    let result = run_file(SCENE_FILE, &["--json"]).json();
    check_run(&result);
    for (field, value) in [
        ("bodies", "4"),
        ("steps", "20"),
        ("dt", "0.01"),
        ("integrator", "\"rk4\""),
        ("substeps", "2"),
        ("broad", "\"sweep\""),
        ("lanes", "4"),
        ("precision", "\"f64\""),
        ("skip", "\"closed_form,friction\""),
        ("sleep", "true"),
    ] {
        assert_eq!(result[field].to_string(), value, "{field}");
    }
    let result =
        run_file(SCENE_FILE, &["--steps", "4", "--precision", "f32", "--skip", "all", "--json"]).json();
    let now = ["steps", "precision", "skip", "lanes"].map(|field| result[field].to_string());
    assert_eq!(now, ["4", "\"f32\"", "\"all\"", "8"]);
}

#[test]
fn an_empty_scene_file_is_a_scene_without_bodies_and_says_so() {
    let answer = run_file("", &["--steps", "2", "--json"]);
    assert!(answer.err.contains("scene.toml: no [[body]]: the scene is empty"), "{answer:#?}");
    let result = Answer { err: String::new(), ..answer }.json();
    check_run(&result);
    assert_eq!(result["bodies"], 0);
}

#[test]
fn seeds_choose_other_scenes_and_lanes_do_not() {
    let hash = |more: &str| {
        let line = format!("run all --steps 30 --json {more}");
        lamina(&line.split_whitespace().collect::<Vec<_>>()).json()["hash"].clone()
    };
    assert_eq!(hash("--lanes 1"), hash("--lanes 16"));
    assert_eq!(hash("--lanes 4 --skip exact"), hash("--lanes 16 --skip none"));
    assert_ne!(hash("--seed 1"), hash("--seed 2"));
}

#[test]
fn the_list_of_scenes_is_complete_as_table_and_as_json() {
    let table = lamina(&["scenes"]);
    let document = lamina(&["scenes", "--json"]).json();
    let rows = document["rows"].as_array().unwrap();
    assert_eq!(rows.len(), SCENES.len());
    for (row, info) in rows.iter().zip(SCENES) {
        assert_eq!(row["name"], info.name);
        assert!(table.succeeds().contains(info.name), "{table:#?}");
    }
}

#[test]
fn the_determinism_experiment_prints_rows_as_table_and_as_json() {
    let document = lamina(&["determinism", "--json"]).json();
    let rows = document["rows"].as_array().unwrap();
    assert!(!rows.is_empty());
    for row in rows {
        assert!(
            row["identical"].is_boolean() && row["hashes"].as_array().unwrap().iter().all(is_hash),
            "{row}"
        );
    }
    assert!(lamina(&["determinism"]).succeeds().contains("thesis"));
}

#[test]
fn a_state_that_turns_non_finite_stops_the_run_with_step_body_and_stage() {
    let light = "[[body]]\nshape = { circle = 1 }\nposition = [0, 0]\nmass = 1e-3\n";
    let pushed = format!("[[body]]\nshape = {{ circle = 1 }}\nposition = [9, 0]\n{light}force = [1e38, 0]");
    run_file(&pushed, &[]).fails(1, &["scene.toml", "step 1", "body 1", "vx = inf", "integrate"]);
    // An oscillator far beyond its stable step doubles again and again.
    let shaken = format!(
        "{light}velocity = [1, 0]\n[forces.spring]\nanchor = [0, 0]\nstiffness = 1e6\n[settings]\nstiff_fields = \"scheme\""
    );
    run_file(&shaken, &[]).fails(1, &["body 0", "integrate"]);
    lamina(&["run", "stack", "--dt", "1e30"]).fails(1, &["stack/10", "step 1", "body "]);
}

#[test]
fn a_measure_that_is_no_number_fails_rather_than_printing_null() {
    let fast = "[settings]\nprecision = 'f64'\n[[body]]\nshape = { circle = 1 }\nposition = [0, 0]\n\
                velocity = [1e200, 0]";
    run_file(fast, &["--steps", "2", "--json"]).fails(1, &["step 2", "kinetic_energy", "inf"]);
}

#[test]
fn a_reader_that_leaves_early_is_no_error() {
    for args in [&["scenes"][..], &["scenes", "--json"], &["run", "stack", "--steps", "2"], &["--help"]] {
        let mut child = Command::new(cargo_bin!("lamina"))
            .args(args)
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        drop(child.stdout.take());
        let output = child.wait_with_output().unwrap();
        assert!(output.status.success() && output.stderr.is_empty(), "{args:?}: {output:?}");
    }
}

/// Rows enough for many buffers: what is written after the reader has gone is no error either.
#[test]
fn a_reader_of_an_export_may_leave_early() {
    let folder = folder();
    let path = folder.path().join("a.mcap");
    let path = path.to_str().unwrap();
    let recorded = lamina(&["run", "circles/100", "--steps", "200", "--record", path]);
    assert_eq!(recorded.code, Some(0), "{recorded:#?}");
    for format in ["--csv", "--json"] {
        let mut child = Command::new(cargo_bin!("lamina"))
            .args(["export", path, format])
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let mut head = [0; 64];
        child.stdout.take().unwrap().read_exact(&mut head).unwrap();
        let output = child.wait_with_output().unwrap();
        assert!(output.status.success() && output.stderr.is_empty(), "{format}: {output:?}");
    }
}

#[test]
fn help_and_version_are_answers() {
    assert!(lamina(&["--version"]).succeeds().starts_with("lamina "));
    for command in ["scenes", "run", "bench", "determinism", "report"] {
        assert!(lamina(&[command, "--help"]).succeeds().contains("--json"), "{command}");
    }
}

#[test]
fn single_experiments_print_their_tables_and_write_nothing() {
    let limits = lamina(&["report", "--quick", "--only", "limits", "--json"]).json();
    let rows = limits["limits"].as_array().unwrap();
    assert!(rows.iter().all(|row| row["median"].as_f64().unwrap() > 0.0));
    let of = |lanes: u64| {
        rows.iter().find(|row| row["lanes"] == lanes && row["bytes"] == 0).unwrap()["best"].as_f64().unwrap()
    };
    assert!(of(8) > of(1), "eight lanes calculate no more than one");
    assert!(lamina(&["report", "--quick", "--only", "limits"]).succeeds().contains("Limits of this machine"));
}
