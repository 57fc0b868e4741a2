//! Recordings by the program: what users run, and what they do to files.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use crate::shared_cli::{Answer, folder, lamina};
use crate::shared_recording::{replace, rewrite};
use assert_cmd::cargo::cargo_bin;
use serde_json::Value;

/// Records a scene into `path`.
fn record(args: &str, path: &Path) -> Answer {
    let mut all: Vec<_> = args.split(' ').collect();
    all.extend(["--record", path.to_str().unwrap()]);
    let answer = lamina(&all);
    assert_eq!(answer.code, Some(0), "{answer:#?}");
    answer
}

fn json(answer: &Answer) -> Value {
    serde_json::from_str(&answer.out).unwrap_or_else(|why| panic!("{why}: {answer:#?}"))
}

#[test]
fn a_recording_is_verified_at_every_lane_width_and_another_run_is_told_from_it() {
    let folder = folder();
    let [a, b, c] = ["a.mcap", "b.mcap", "c.mcap"].map(|name| folder.path().join(name));
    let [a_path, b_path, c_path] = [&a, &b, &c].map(|path| path.to_str().unwrap());
    record("run all --bodies 150 --steps 90", &a);
    record("run all --bodies 150 --steps 90 --lanes 4 --every 10", &b);
    record("run all --bodies 150 --steps 90 --integrator semi_implicit_euler", &c);
    let answer = lamina(&["verify", a_path, "--lanes", "all"]);
    assert_eq!(answer.code, Some(0), "{answer:#?}");
    assert_eq!(answer.out.matches("identical: 91 states").count(), 4, "{answer:#?}");
    for file in [b_path, c_path] {
        assert_eq!(json(&lamina(&["verify", file, "--json"]))["identical"], true);
    }
    // Recorded at other widths and distances of frames: the same run.
    let same = lamina(&["diff", a_path, b_path]);
    assert_eq!((same.code, same.out.contains("identical: 91 states")), (Some(0), true), "{same:#?}");
    let apart = lamina(&["diff", a_path, c_path, "--json"]);
    assert_eq!(apart.code, Some(1), "{apart:#?}");
    let apart = json(&apart);
    let step = apart["first_difference"]["step"].as_u64().unwrap();
    let rows = apart["growth"].as_array().unwrap();
    assert_eq!(rows[0]["step"].as_u64(), Some(step), "{apart:#}");
    assert_eq!(rows.last().unwrap()["step"].as_u64(), Some(90), "{apart:#}");
    assert!(rows[0]["bodies"].as_u64() > Some(0), "{apart:#}");
    let text = lamina(&["diff", a_path, c_path]);
    assert!(text.out.contains(&format!("differs from step {step} on: body ")), "{text:#?}");
}

/// The same run with one number of its scene changed is not the run.
#[test]
fn a_recording_of_another_run_is_not_verified() {
    let folder = folder();
    let [scene, path] = ["a.toml", "a.mcap"].map(|name| folder.path().join(name));
    let text =
        |x: f64| format!("[[body]]\nshape = {{ circle = 0.5 }}\nposition = [{x:?}, 0]\nvelocity = [1, 0]\n");
    std::fs::write(&scene, text(0.1)).unwrap();
    record(&format!("run {} --steps 5", scene.to_str().unwrap()), &path);
    // The scene is in the recording: the file beside it does not matter.
    std::fs::write(&scene, text(0.2)).unwrap();
    let answer = lamina(&["verify", path.to_str().unwrap()]);
    assert_eq!(answer.code, Some(0), "{answer:#?}");
    let bytes = std::fs::read(&path).unwrap();
    let changed = rewrite(&bytes, mcap::WriteOptions::new().compression(None), |topic, data| {
        if topic == "/scene" {
            replace(data, "[0.1,0.0]", "[0.3,0.0]");
        }
        true
    });
    std::fs::write(&path, changed.unwrap()).unwrap();
    let answer = lamina(&["verify", path.to_str().unwrap()]);
    assert_eq!(answer.code, Some(1), "{answer:#?}");
    assert!(answer.out.contains("differs from step 0 on: body 0, x: recorded 0.1"), "{answer:#?}");
    assert!(answer.err.contains("not the one recorded"), "{answer:#?}");
}

#[test]
fn exports_hold_the_numbers_of_the_recording() {
    let folder = folder();
    let path = folder.path().join("a.mcap");
    record("run pyramid/3 --steps 10 --every 5", &path);
    let path = path.to_str().unwrap();
    let csv = lamina(&["export", path, "--csv"]);
    let lines: Vec<_> = csv.out.lines().collect();
    assert_eq!(lines[0], "step,slot,asleep,time_secs,x,y,c,s,vx,vy,w");
    // Three frames of six boxes and the ground.
    assert_eq!(lines.len(), 1 + 3 * 7, "{csv:#?}");
    let rows = lamina(&["export", path, "--json", "--rows", "contacts"]);
    let contacts: Vec<Value> = rows.out.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    assert!(
        contacts.iter().any(|row| row["step"] == 10 && row["impulse0"].as_f64() > Some(0.0)),
        "{rows:#?}"
    );
    let steps = lamina(&["export", path, "--csv", "--rows", "steps"]);
    assert_eq!(steps.out.lines().count(), 12, "{steps:#?}");
    let out = folder.path().join("a.parquet");
    let answer = lamina(&["export", path, "--parquet", "--out", out.to_str().unwrap()]);
    if cfg!(feature = "parquet") {
        assert_eq!((answer.code, answer.out.is_empty()), (Some(0), true), "{answer:#?}");
        let bytes = std::fs::read(&out).unwrap();
        assert!(bytes.starts_with(b"PAR1") && bytes.ends_with(b"PAR1"));
    } else {
        answer.fails(2, &["--parquet", "--features lamina/parquet"]);
        assert!(!out.exists());
    }
}

#[test]
fn bad_words_about_recordings_are_refused_by_name() {
    let folder = folder();
    let path = folder.path().join("a.mcap");
    record("run stack/2 --steps 3", &path);
    let (path, out) = (path.to_str().unwrap(), folder.path().to_str().unwrap());
    let nowhere = format!("{out}/none/a.mcap");
    let table: &[(&[&str], &[&str])] = &[
        (&["run", "stack", "--every", "3"], &["--record"]),
        (&["run", "stack", "--record", path, "--every", "0"], &["--every", "at least 1", "got 0"]),
        (&["run", "stack", "--record", path, "--every", "x"], &["--every", "'x'"]),
        (&["run", "stack", "--record", out], &[out, "folder"]),
        (&["run", "stack", "--record", &nowhere], &["none/a.mcap.part"]),
        (&["info", &nowhere], &["none/a.mcap"]),
        (&["info", out], &[out, "folder"]),
        (&["info", "Cargo.toml"], &["Cargo.toml", "MCAP"]),
        (&["verify", path, "--lanes", "3"], &["--lanes", "'3'", "16"]),
        (&["diff", path], &["<B>"]),
        (&["diff", path, "Cargo.toml"], &["Cargo.toml", "MCAP"]),
        (&["export", path], &["--csv"]),
        (&["export", path, "--csv", "--json"], &["--json"]),
        (&["export", path, "--csv", "--rows", "joints"], &["--rows", "'joints'"]),
        (&["export", path, "--csv", "--out", out], &[out]),
    ];
    for (args, mentions) in table {
        lamina(args).fails(2, mentions);
    }
}

/// A run that is killed leaves a file that opens, and nobody writes over it.
#[cfg(unix)]
#[test]
fn a_killed_run_leaves_what_it_recorded() {
    let folder = folder();
    let path = folder.path().join("a.mcap");
    let part = folder.path().join("a.mcap.part");
    let mut run = Command::new(cargo_bin!("lamina"))
        .args(["run", "all/150", "--steps", "100000000", "--record", path.to_str().unwrap()])
        .stdout(Stdio::null())
        .spawn()
        .unwrap();
    let begin = Instant::now();
    let big_enough = || part.metadata().is_ok_and(|data| data.len() > 3 << 20);
    while !big_enough() && begin.elapsed() < Duration::from_mins(1) {
        std::thread::sleep(Duration::from_millis(20));
    }
    // While it runs, a second one is refused.
    lamina(&["run", "stack", "--record", path.to_str().unwrap()]).fails(2, &["a.mcap.part", "another run"]);
    run.kill().unwrap();
    run.wait().unwrap();
    assert!(!path.exists());
    let info = lamina(&["info", part.to_str().unwrap(), "--json"]);
    assert_eq!(info.code, Some(0), "{info:#?}");
    assert!(info.err.contains("good up to byte"), "{info:#?}");
    let info = json(&info);
    let steps = info["steps"].as_u64().unwrap();
    assert!(steps > 10, "{info:#}");
    let verified = lamina(&["verify", part.to_str().unwrap()]);
    assert_eq!(verified.code, Some(0), "{verified:#?}");
    assert!(verified.out.contains(&format!("identical: {steps} states")), "{verified:#?}");
    // It is there until someone takes it away.
    lamina(&["run", "stack", "--record", path.to_str().unwrap()]).fails(2, &["a.mcap.part", "killed"]);
    assert!(part.exists());
}

/// A disk that is full ends the run with a message; what was written before can be read.
#[cfg(unix)]
#[test]
fn a_full_disk_ends_a_recording_and_keeps_what_is_written() {
    let folder = folder();
    let path = folder.path().join("a.mcap");
    let command = format!(
        "trap '' XFSZ; ulimit -f 2048; exec '{}' run all/150 --steps 100000 --record '{}'",
        cargo_bin!("lamina").display(),
        path.display()
    );
    let output = Command::new("bash").args(["-c", &command]).output().unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(!said.contains("panicked"), "{said}");
    assert!(said.contains("recording stopped") && said.contains("a.mcap.part"), "{said}");
    assert!(!path.exists());
    let info = lamina(&["info", folder.path().join("a.mcap.part").to_str().unwrap(), "--json"]);
    assert_eq!(info.code, Some(0), "{info:#?}");
    assert!(json(&info)["frames"].as_u64() > Some(10), "{info:#?}");
}

/// A run whose state turns non-finite is recorded up to that state.
#[test]
fn a_run_that_breaks_leaves_a_whole_recording() {
    let folder = folder();
    let [scene, path] = ["a.toml", "a.mcap"].map(|name| folder.path().join(name));
    let text = "[settings]\nstiff_fields = \"scheme\"\n[forces]\nspring = { anchor = [0, 0], stiffness = 1e9 }\n[[body]]\nshape = { circle = 0.5 }\nposition = [1, 0]\n";
    std::fs::write(&scene, text).unwrap();
    let args = ["run", scene.to_str().unwrap(), "--record", path.to_str().unwrap(), "--every", "1000"];
    let broken = lamina(&args);
    assert_eq!(broken.code, Some(1), "{broken:#?}");
    let info = json(&lamina(&["info", path.to_str().unwrap(), "--json"]));
    // The first state and the last, whatever --every says.
    assert_eq!(info["frames"], 2, "{info:#}");
    assert_eq!(info["loss"], Value::Null, "{info:#}");
    let verified = lamina(&["verify", path.to_str().unwrap()]);
    assert_eq!(verified.code, Some(0), "{verified:#?}");
}

/// How many joints and contacts were solved directly, and how many bodies were advanced beside their scheme, stands in each step's
/// row as in what a run prints.
#[test]
fn what_was_solved_otherwise_is_recorded() {
    let folder = folder();
    let spring = folder.path().join("spring.toml");
    let text = "[forces]\nspring = { anchor = [0, 0], stiffness = 1e6 }\n[[body]]\nshape = { circle = 0.5 }\nposition = [1, 0]\n";
    std::fs::write(&spring, text).unwrap();
    for (scene, column) in [
        (spring.to_str().unwrap(), "stiff"),
        ("t09_chain", "direct_joints"),
        ("heavy/1000", "direct_contacts"),
    ] {
        let path = folder.path().join("a.mcap");
        let path = path.to_str().unwrap();
        let run = lamina(&["run", scene, "--steps", "20", "--record", path, "--json"]);
        let counted = json(&run)["counts"][column].as_f64();
        let csv = lamina(&["export", path, "--csv", "--rows", "steps"]);
        let mut lines = csv.out.lines().map(|line| line.split(',').collect::<Vec<_>>());
        let at = lines.next().unwrap().iter().position(|name| *name == column).unwrap();
        let last = lines.next_back().unwrap()[at].parse::<f64>().ok();
        assert!(last.is_some_and(|count| count > 0.0), "{scene}: {column} {last:?}");
        assert_eq!(last, counted, "{scene}: {column}");
        std::fs::remove_file(path).unwrap();
    }
}

/// The example in the crate documentation reads a recording, where Python has `mcap`.
#[test]
fn python_reads_a_recording_by_the_example() {
    let ready = Command::new("python3").args(["-c", "import mcap, lz4"]).output();
    if !ready.is_ok_and(|output| output.status.success()) {
        eprintln!("skipped: python3 has no mcap or no lz4 (pip install mcap lz4)");
        return;
    }
    let folder = folder();
    let path = folder.path().join("a.mcap");
    record("run circles/150 --steps 20", &path);
    let documentation = include_str!("../../record/mod.rs");
    let lines = documentation.lines().skip_while(|line| *line != "//! ```python").skip(1);
    let example: Vec<_> = lines
        .take_while(|line| *line != "//! ```")
        .map(|line| line.trim_start_matches("//!").strip_prefix(' ').unwrap_or_default())
        .collect();
    let example = example.join("\n");
    let output = Command::new("python3").args(["-c", &example]).current_dir(folder.path()).output().unwrap();
    let said = String::from_utf8(output.stdout).unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let csv = lamina(&["export", path.to_str().unwrap(), "--csv"]);
    let first_body = csv.out.lines().skip(1).map(|line| line.split(',').collect::<Vec<_>>());
    let first_body: Vec<_> = first_body.filter(|cells| cells[1] == "1").collect();
    assert_eq!(said.lines().count(), 21, "{said}");
    for (line, cells) in said.lines().zip(first_body) {
        let numbers: Vec<f64> = line.split(' ').map(|word| word.parse().unwrap()).collect();
        let expected = [cells[0], cells[3], cells[4], cells[5]].map(|cell| cell.parse::<f64>().unwrap());
        assert_eq!(numbers, expected);
    }
}
