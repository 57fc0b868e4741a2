//! Good runs of the program: each scene and a scene file run, every `--json` is one document with the
//! promised fields, a run that turns non-finite says where, and a reader may leave early.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

mod common_cli;

use std::process::{Command, Stdio};

use assert_cmd::cargo::cargo_bin;
use common_cli::{Answer, folder, lamina, run_file};
use lamina2d::measure::Stage;
use lamina2d::report::strip::SHOTS;
use lamina2d::scene::SCENES;
use lamina2d::settings::Skip;
use serde_json::Value;

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

impl Answer {
    /// Exit code 0 and a quiet stderr; returns stdout.
    fn succeeds(&self) -> &str {
        assert_eq!(self.code, Some(0), "{self:#?}");
        assert!(self.err.is_empty(), "stderr is for problems: {self:#?}");
        &self.out
    }

    /// Stdout as one JSON object with `machine` whose numbers all are numbers.
    fn json(&self) -> Value {
        let document: Value = serde_json::from_str(self.succeeds()).unwrap_or_else(|e| {
            panic!("stdout is not one JSON document: {e}: {self:#?}");
        });
        let machine = &document["machine"];
        for field in ["cpu", "os", "rustc", "build", "flags", "commit", "version"] {
            assert!(machine[field].is_string(), "machine.{field}: {machine:#}");
        }
        assert!(machine["features"].is_array() && machine["threads"].is_u64(), "{machine:#}");
        document
    }
}

/// The paths of all nulls in a document: serde_json writes NaN and infinity as null.
fn nulls(path: &str, value: &Value) -> Vec<String> {
    match value {
        Value::Null => vec![path.to_owned()],
        Value::Object(fields) => fields.iter().flat_map(|(k, v)| nulls(&format!("{path}.{k}"), v)).collect(),
        Value::Array(items) => {
            items.iter().enumerate().flat_map(|(k, v)| nulls(&format!("{path}[{k}]"), v)).collect()
        }
        _ => Vec::new(),
    }
}

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
fn an_empty_scene_file_is_a_scene_without_bodies() {
    let result = run_file("", &["--steps", "2", "--json"]).json();
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
    let shaken = format!("{light}velocity = [1, 0]\n[forces.spring]\nanchor = [0, 0]\nstiffness = 1e6");
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

#[test]
fn help_and_version_are_answers() {
    assert!(lamina(&["--version"]).succeeds().starts_with("lamina "));
    for command in ["scenes", "run", "bench", "determinism", "report"] {
        assert!(lamina(&[command, "--help"]).succeeds().contains("--json"), "{command}");
    }
}

#[test]
#[ignore = "minutes without optimisation: .ci/run runs it with --release"]
fn the_long_commands_print_one_json_document_and_the_report_leaves_its_files() {
    let bench = lamina(&["bench", "--quick", "--json"]).json();
    let rows = bench["rows"].as_array().unwrap();
    for engine in ["lamina2d", "thesis", "tidy"] {
        assert!(rows.iter().any(|row| row["engine"] == engine), "no row of {engine}");
    }
    for row in rows {
        let named = ["mix", "integrator", "engine", "hash"].iter().all(|f| row[*f].is_string());
        let counted = ["bodies", "lanes", "contacts"].iter().all(|f| row[*f].is_u64());
        let timed = ["min", "median", "mean", "p99"].iter().all(|f| row["ms_per_step"][*f].is_number());
        assert!(named && counted && timed && row["max_penetration"].is_number(), "{row:#}");
    }
    assert_eq!(nulls("rows", &bench["rows"]), [""; 0]);

    let folder = folder();
    let out = folder.path().join("new/report");
    let report = lamina(&["report", "--quick", "--json", "--out", out.to_str().unwrap()]).json();
    assert!(!report["rows"].as_array().unwrap().is_empty());
    for file in [
        "index.html",
        "summary.md",
        "data.json",
        "results.csv",
        "matrix.csv",
        "determinism.csv",
        "skips.csv",
        "limits.csv",
        "limit_shares.csv",
        "mix_by_integrator.svg",
        "stages.svg",
    ] {
        assert!(out.join(file).metadata().unwrap().len() > 0, "{file}");
    }
    for shot in SHOTS {
        let bytes = out.join(shot.file).metadata().unwrap().len();
        assert!((1..72 << 10).contains(&bytes), "{}: {bytes} bytes", shot.file);
    }
    let left = std::fs::read_dir(&out).unwrap().map(|entry| entry.unwrap().file_name());
    assert!(left.filter(|name| name.to_string_lossy().ends_with(".part")).count() == 0);
    let page = std::fs::read_to_string(out.join("index.html")).unwrap();
    // The only address is the name of SVG's namespace, which nobody fetches.
    let fetched = page.replace("http://www.w3.org/2000/svg", "");
    assert!(!fetched.contains("http"), "the page reaches for the network");
    // Every plot and table says which command makes it.
    for (shown, made_by) in [("<figure", "<figcaption>"), ("<h3", "Made by <code>lamina")] {
        assert!(
            page.matches(shown).count() > 3 && page.matches(shown).count() <= page.matches(made_by).count()
        );
    }
    let again = folder.path().join("again");
    let (again, out) = (again.to_str().unwrap(), out.to_str().unwrap());
    let compared = lamina(&["report", "--quick", "--json", "--out", again, "--against", out]).json();
    assert!(compared["controls"].as_u64().unwrap() >= 8 && compared["drift"].as_f64().unwrap() > 0.1);
    for row in compared["rows"].as_array().unwrap() {
        assert!(["faster", "slower", "alike"].contains(&row["verdict"].as_str().unwrap()), "{row:#}");
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
