//! The instruction gate: what it compares, what it keeps, what it refuses, and what it prints for others.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

use std::path::Path;

use assert_cmd::cargo::cargo_bin_cmd;
use lamina::gate::{
    BaselineError, Baselines, Counts, FRAMEWORK_VERSION, INSTALL, Kind, STEPS_PER_COUNT, Toolchain, Verdict,
    append_history, baseline, compare, history_line,
};
use serde_json::Value;

use crate::shared_cli::{Answer, folder, lamina, write};

fn toolchain(rustc: &str) -> Toolchain {
    Toolchain {
        rustc: rustc.to_owned(),
        valgrind: "3.19.0".to_owned(),
        target_cpu: "x86-64-v3".to_owned(),
        framework: format!("iai-callgrind {FRAMEWORK_VERSION}"),
    }
}

fn counts(kernels: &[(&str, u64)], steps: &[(&str, u64)]) -> Counts {
    let map = |rows: &[(&str, u64)]| rows.iter().map(|&(name, count)| (name.to_owned(), count)).collect();
    Counts { kernels: map(kernels), steps: map(steps) }
}

/// Counts as `lamina gate --format json` prints them, with a file of blessed counts beside them.
struct Gate {
    folder: tempfile::TempDir,
}

impl Gate {
    fn new(blessed: Option<&Counts>, counted: &Counts) -> Self {
        let gate = Self { folder: folder() };
        if let Some(blessed) = blessed {
            let mut baselines = Baselines::default();
            baselines.bless(&toolchain("1.95.0"), blessed, "abc: first".to_owned());
            write(gate.folder.path(), "instructions.toml", baselines.to_text().unwrap());
        }
        gate.count(counted);
        gate
    }

    fn count(&self, counted: &Counts) {
        let document = serde_json::json!({"toolchain": toolchain("1.95.0"), "counts": counted});
        write(self.folder.path(), "counts.json", document.to_string());
    }

    fn path(&self, name: &str) -> String {
        self.folder.path().join(name).to_str().unwrap().to_owned()
    }

    fn run(&self, more: &[&str]) -> Answer {
        let (baseline, counts) = (self.path("instructions.toml"), self.path("counts.json"));
        let mut args = vec!["gate", "--baseline", &baseline, "--counts", &counts];
        args.extend(more);
        lamina(&args)
    }
}

#[test]
fn each_kind_has_its_bound_and_every_failure_its_verdict() {
    // 0.2 % of kernels, 1 % of scenes, inclusive.
    let table = [
        (Kind::Kernel, Some(1000), Some(1000), Verdict::Same, false),
        (Kind::Kernel, Some(1000), Some(1002), Verdict::Within, false),
        (Kind::Kernel, Some(1000), Some(1003), Verdict::More, true),
        (Kind::Kernel, Some(1000), Some(998), Verdict::Within, false),
        (Kind::Kernel, Some(1000), Some(997), Verdict::Fewer, false),
        (Kind::Kernel, Some(499), Some(500), Verdict::More, true),
        (Kind::Steps, Some(1000), Some(1010), Verdict::Within, false),
        (Kind::Steps, Some(1000), Some(1011), Verdict::More, true),
        (Kind::Steps, Some(1000), Some(2000), Verdict::More, true),
        (Kind::Steps, Some(1000), Some(500), Verdict::Fewer, false),
        (Kind::Steps, Some(u64::MAX - 1), Some(u64::MAX), Verdict::Within, false),
        (Kind::Kernel, Some(1), Some(u64::MAX), Verdict::More, true),
        (Kind::Kernel, Some(1000), Some(0), Verdict::Zero, true),
        (Kind::Kernel, Some(0), Some(0), Verdict::Zero, true),
        (Kind::Kernel, None, Some(0), Verdict::Zero, true),
        (Kind::Kernel, Some(1000), None, Verdict::NotRun, true),
        (Kind::Kernel, None, Some(1000), Verdict::NotBlessed, true),
    ];
    for (kind, old, new, verdict, fails) in table {
        let side = |count: Option<u64>| {
            let mut counts = Counts::default();
            counts.of_mut(kind).extend(count.map(|count| ("a".to_owned(), count)));
            counts
        };
        let comparison = compare(&side(old), &side(new));
        let verdicts: Vec<_> = comparison.rows.iter().map(|row| row.verdict).collect();
        assert_eq!(verdicts, [verdict], "{kind:?} {old:?} → {new:?}");
        assert_eq!(!comparison.passes(), fails, "{kind:?} {old:?} → {new:?}");
        assert_eq!(comparison.failure().is_some(), fails);
    }
    let nothing = compare(&Counts::default(), &Counts::default());
    assert!(!nothing.passes() && nothing.failure().is_some(), "nothing counted passes");
}

#[test]
fn rows_come_in_a_fixed_order_and_a_name_of_another_kind_is_another_bench() {
    let old = counts(&[("b", 10), ("a", 10)], &[("c", 10)]);
    let new = counts(&[("a", 10), ("c", 10)], &[("b", 10), ("c", 10)]);
    let comparison = compare(&old, &new);
    let rows: Vec<_> = comparison.rows.iter().map(|row| (row.kind, row.name.as_str(), row.verdict)).collect();
    let expected = [
        (Kind::Kernel, "a", Verdict::Same),
        (Kind::Kernel, "b", Verdict::NotRun),
        (Kind::Kernel, "c", Verdict::NotBlessed),
        (Kind::Steps, "b", Verdict::NotBlessed),
        (Kind::Steps, "c", Verdict::Same),
    ];
    assert_eq!(rows, expected);
    let ratio = compare(&counts(&[("a", 100), ("b", 100)], &[]), &counts(&[("a", 50), ("b", 200)], &[]));
    assert!((ratio.mean_ratio().unwrap() - 1.0).abs() < 1e-12);
}

#[test]
fn blessing_keeps_other_toolchains_and_reasons() {
    let mut baselines = Baselines::default();
    let [one, other] = [toolchain("1.95.0"), toolchain("1.96.0")];
    baselines.bless(&one, &counts(&[("a", 10)], &[]), "c1: first".to_owned());
    baselines.bless(&other, &counts(&[("a", 11)], &[]), "c2: new compiler".to_owned());
    baselines.bless(&one, &counts(&[("b", 12)], &[("s", 3)]), "c3: faster".to_owned());
    let folder = folder();
    let path = write(folder.path(), "instructions.toml", baselines.to_text().unwrap());
    let read = baseline(&path).unwrap();
    assert_eq!(read, baselines, "written and read again");
    assert_eq!(read.of(&one).unwrap().reasons, ["c1: first", "c3: faster"]);
    assert_eq!(read.of(&one).unwrap().counts(), counts(&[("b", 12)], &[("s", 3)]), "counts are replaced");
    assert_eq!(read.of(&other).unwrap().counts(), counts(&[("a", 11)], &[]));
    assert!(read.of(&toolchain("1.97.0")).is_none());
}

#[test]
fn a_file_has_one_line_per_bench_by_name() {
    let mut baselines = Baselines::default();
    let mixed = counts(&[("z/1", 1), ("a/1", 2)], &[("m/2", 3)]);
    baselines.bless(&toolchain("1.95.0"), &mixed, "c1: first".to_owned());
    let text = baselines.to_text().unwrap();
    let lines: Vec<_> = text.lines().filter(|line| line.starts_with('"')).collect();
    assert_eq!(lines, ["\"a/1\" = 2", "\"z/1\" = 1", "\"m/2\" = 3"]);
}

#[test]
fn history_begins_once_and_grows_by_a_line() {
    let folder = folder();
    let path = folder.path().join("history.md");
    let name = lamina::gate::HEADLINE;
    let comparison = compare(
        &counts(&[], &[(name, 100 * STEPS_PER_COUNT)]),
        &counts(&[], &[(name, 50 * STEPS_PER_COUNT)]),
    );
    for reason in ["first", "second"] {
        append_history(&path, &history_line("abc", reason, &toolchain("1.95.0"), &comparison)).unwrap();
    }
    let text = std::fs::read_to_string(&path).unwrap();
    assert_eq!(text.matches("# History").count(), 1);
    let lines: Vec<_> = text.lines().filter(|line| line.starts_with("| abc")).collect();
    assert_eq!(lines.len(), 2);
    assert!(lines[0].contains("first") && lines[1].contains("second"), "newest last: {text}");
    assert!(lines[0].contains("100 → 50") && lines[0].contains("0.5000"), "{text}");
}

#[test]
fn a_malformed_file_is_refused_by_line_and_field() {
    let entry = "[[baseline]]\nreasons = ['c: first']\n";
    let tools = "[baseline.toolchain]\nrustc = '1'\nvalgrind = '3'\ntarget_cpu = 'a'\nframework = 'f'\n";
    let table: &[(String, &[&str])] = &[
        ("baseline".to_owned(), &["line 1"]),
        ("[[baselines]]".to_owned(), &["line 1", "`baselines`", "`baseline`"]),
        ("baseline = 3".to_owned(), &["line 1", "baseline"]),
        (entry.to_owned(), &["line 1", "`toolchain`"]),
        (format!("{entry}{tools}"), &["`kernels`"]),
        (format!("{entry}colour = 1\n{tools}"), &["line 3", "`colour`"]),
        (format!("{entry}{tools}libc = '2'\n"), &["line 8", "`libc`"]),
        (format!("{entry}{tools}[baseline.kernels]\na = 'many'\n[baseline.steps]"), &["line 9", "\"many\""]),
        (format!("{entry}{tools}[baseline.kernels]\na = -1\n[baseline.steps]"), &["line 9", "-1"]),
        (format!("{entry}{tools}[baseline.kernels]\na = 1.5\n[baseline.steps]"), &["line 9", "1.5"]),
        (format!("{entry}{tools}[baseline.kernels]\na = 1\na = 2\n[baseline.steps]"), &["line 10", "a"]),
        (format!("{entry}{tools}[baseline.kernels]\n'x/y' = 0\n[baseline.steps]"), &["'x/y'", "is 0"]),
    ];
    let same = format!("{entry}{tools}[baseline.kernels]\na = 1\n[baseline.steps]\n");
    let twice: (String, &[&str]) = (format!("{same}{same}"), &["two entries", "rustc 1"]);
    let gate = Gate::new(None, &counts(&[("a", 1)], &[]));
    for (text, mentions) in table.iter().chain([&twice]) {
        write(gate.folder.path(), "instructions.toml", text);
        for more in [&[][..], &["--bless", "anew"]] {
            let answer = gate.run(more);
            answer.fails(2, &["instructions.toml"]);
            answer.fails(2, mentions);
        }
        let left = std::fs::read_to_string(gate.path("instructions.toml")).unwrap();
        assert_eq!(left, *text, "a refused file is left alone");
    }
    assert!(matches!(
        baseline(Path::new(&gate.path("instructions.toml"))),
        Err(BaselineError::Syntax { .. })
    ));
}

#[test]
fn counts_that_cannot_be_read_are_refused() {
    let gate = Gate::new(Some(&counts(&[("a", 1)], &[])), &Counts::default());
    for (text, mention) in [
        ("{", "line 1"),
        ("{}", "toolchain"),
        ("[1]", "line 1"),
        (r#"{"toolchain": {"rustc": 1}, "counts": {}}"#, "integer `1`"),
    ] {
        write(gate.folder.path(), "counts.json", text);
        gate.run(&[]).fails(2, &["counts.json", mention]);
    }
    std::fs::remove_file(gate.path("counts.json")).unwrap();
    gate.run(&[]).fails(2, &["cannot read counts", "counts.json"]);
}

#[test]
fn the_gate_opens_only_for_counts_within_their_bounds() {
    let blessed = counts(&[("k", 1000)], &[("s", 1000)]);
    let gate = Gate::new(Some(&blessed), &counts(&[("k", 1002)], &[("s", 990)]));
    let answer = gate.run(&[]);
    assert_eq!(answer.code, Some(0), "{answer:#?}");
    assert!(answer.out.contains("+0.200 %") && answer.out.contains("within"), "{answer:#?}");
    let table: &[(Counts, &[&str])] = &[
        (counts(&[("k", 1003)], &[("s", 1000)]), &["1 of 2", "k MORE", "+0.30 %", "--bless"]),
        (counts(&[("k", 0)], &[("s", 1000)]), &["k ZERO"]),
        (counts(&[], &[("s", 1000)]), &["k NOT RUN"]),
        (counts(&[("k", 1000), ("new", 5)], &[("s", 1000)]), &["new NOT BLESSED"]),
        (Counts::default(), &["2 of 2", "k NOT RUN", "s NOT RUN"]),
    ];
    for (counted, mentions) in table {
        gate.count(counted);
        let answer = gate.run(&[]);
        assert_eq!(answer.code, Some(1), "{answer:#?}");
        assert!(mentions.iter().all(|mention| answer.err.contains(mention)), "{mentions:?} {answer:#?}");
        assert!(answer.out.contains("verdict"), "the table is printed all the same: {answer:#?}");
    }
}

#[test]
fn what_has_nothing_to_compare_with_fails_and_says_how_to_bless() {
    let counted = counts(&[("k", 1000)], &[]);
    let missing = Gate::new(None, &counted);
    missing.run(&[]).fails(1, &["no baseline", "instructions.toml", "--bless REASON"]);
    let gate = Gate::new(None, &counted);
    let mut baselines = Baselines::default();
    baselines.bless(&toolchain("1.90.0"), &counted, "c: other compiler".to_owned());
    write(gate.folder.path(), "instructions.toml", baselines.to_text().unwrap());
    let answer = gate.run(&[]);
    assert_eq!(answer.code, Some(1), "{answer:#?}");
    for mention in ["no baseline for this toolchain", "rustc 1.95.0", "rustc 1.90.0", "--bless REASON"] {
        assert!(answer.err.contains(mention), "no '{mention}' in {answer:#?}");
    }
}

#[test]
fn a_blessing_is_written_with_its_reason_and_then_passes() {
    let gate = Gate::new(None, &counts(&[("k", 1000)], &[]));
    assert_eq!(gate.run(&["--bless", "first counts"]).code, Some(0));
    assert_eq!(gate.run(&[]).code, Some(0));
    gate.count(&counts(&[("k", 1100)], &[]));
    assert_eq!(gate.run(&[]).code, Some(1));
    assert_eq!(gate.run(&["--bless", "worth it"]).code, Some(0));
    assert_eq!(gate.run(&[]).code, Some(0));
    let reasons = baseline(Path::new(&gate.path("instructions.toml"))).unwrap().baseline.remove(0).reasons;
    assert!(reasons[0].ends_with(": first counts") && reasons[1].ends_with(": worth it"), "{reasons:?}");
    let history = std::fs::read_to_string(gate.path("history.md")).unwrap();
    assert!(history.contains("first counts") && history.contains("worth it"), "{history}");
    for reason in ["", "  ", "two\nlines", "a | b"] {
        gate.run(&["--bless", reason]).fails(2, &["--bless", "reason"]);
    }
    gate.count(&counts(&[("k", 0)], &[]));
    gate.run(&["--bless", "nothing"]).fails(1, &["'k'", "is 0"]);
    gate.count(&Counts::default());
    gate.run(&["--bless", "nothing"]).fails(1, &["nothing"]);
}

#[test]
fn exports_are_what_dashboards_read() {
    let counted = counts(&[("k", 1000)], &[("s", 2000)]);
    let gate = Gate::new(Some(&counted), &counted);
    let json = |format: &str| -> Value {
        let answer = gate.run(&["--format", format]);
        assert_eq!(answer.code, Some(0), "{answer:#?}");
        serde_json::from_str(&answer.out).unwrap()
    };
    assert_eq!(json("bencher")["k"]["instructions"]["value"], 1000);
    assert_eq!(json("bencher").as_object().unwrap().len(), 2);
    let entry = serde_json::json!({"name": "s", "unit": "instructions", "value": 2000});
    assert_eq!(json("github-action")[1], entry);
    let full = json("json");
    assert_eq!(full["counts"]["steps"]["s"], 2000);
    assert_eq!(full["passes"], true);
    assert_eq!(full["rows"][0]["verdict"], "same");
    assert_eq!(full["toolchain"]["rustc"], "1.95.0");
    // What it prints is what it reads.
    write(gate.folder.path(), "counts.json", full.to_string());
    assert_eq!(gate.run(&[]).code, Some(0));
    // A shut gate still exports what was counted.
    gate.count(&counts(&[("k", 2000)], &[("s", 2000)]));
    let shut = gate.run(&["--format", "json"]);
    assert_eq!(shut.code, Some(1), "{shut:#?}");
    assert_eq!(serde_json::from_str::<Value>(&shut.out).unwrap()["passes"], false);
    gate.run(&["--format", "xml"]).fails(2, &["--format", "xml", "bencher"]);
}

#[test]
fn absent_tools_are_named_with_what_installs_them() {
    let gate = Gate::new(Some(&counts(&[("k", 1)], &[])), &Counts::default());
    let baseline = gate.path("instructions.toml");
    for args in [&["gate", "--baseline", &baseline][..], &["gate", "--self-test"]] {
        let run = |path: &Path| {
            let output = cargo_bin_cmd!("lamina").args(args).env("PATH", path).output().unwrap();
            (output.status.code(), String::from_utf8(output.stderr).unwrap())
        };
        let (code, err) = run(gate.folder.path());
        assert_eq!(code, Some(2), "{err}");
        assert!(err.contains("no valgrind") && err.contains(INSTALL), "{err}");
    }
}

#[cfg(unix)]
#[test]
fn a_runner_of_another_version_is_refused() {
    use std::os::unix::fs::PermissionsExt;

    let gate = Gate::new(Some(&counts(&[("k", 1)], &[])), &Counts::default());
    let tools = folder();
    let script = |name: &str, said: &str| {
        let path = write(tools.path(), name, format!("#!/bin/sh\necho '{said}' >&2\n"));
        std::fs::set_permissions(path, std::fs::Permissions::from_mode(0o755)).unwrap();
    };
    script("valgrind", "valgrind-3.19.0");
    let baseline = gate.path("instructions.toml");
    let run = || {
        let args = ["gate", "--baseline", &baseline];
        let output = cargo_bin_cmd!("lamina").args(args).env("PATH", tools.path()).output().unwrap();
        (output.status.code(), String::from_utf8(output.stderr).unwrap())
    };
    let (code, err) = run();
    assert_eq!(code, Some(2), "{err}");
    assert!(err.contains("no iai-callgrind-runner") && err.contains(INSTALL), "{err}");
    script("iai-callgrind-runner", "Error: iai-callgrind-runner (0.15.2) is something else");
    let (code, err) = run();
    assert_eq!(code, Some(2), "{err}");
    assert!(err.contains(FRAMEWORK_VERSION) && err.contains("0.15.2") && err.contains("--force"), "{err}");
}

#[test]
fn the_versions_the_gate_names_are_those_of_the_manifest() {
    let manifest = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/Cargo.toml")).unwrap();
    assert!(manifest.contains(&format!("iai-callgrind = \"={FRAMEWORK_VERSION}\"")));
    assert!(INSTALL.contains(FRAMEWORK_VERSION));
    let steps =
        std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/../../benches/steps/mod.rs")).unwrap();
    assert!(steps.contains(&format!("WINDOW_STEPS: u64 = {STEPS_PER_COUNT};")));
}

#[test]
fn the_committed_counts_are_in_order() {
    let read =
        baseline(Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../reports/instructions.toml"))).unwrap();
    assert!(!read.baseline.is_empty());
    for entry in &read.baseline {
        assert!(!entry.reasons.is_empty() && !entry.kernels.is_empty() && !entry.steps.is_empty());
        assert!(entry.steps.contains_key(lamina::gate::HEADLINE), "history needs it");
    }
}
