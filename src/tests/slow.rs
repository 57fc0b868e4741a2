//! What takes minutes, or takes them without optimisation: `cargo test --release --test slow`.

#[path = "shared/cli.rs"]
#[allow(dead_code, reason = "each binary takes the helpers it needs")]
mod shared_cli;
#[path = "shared/joints.rs"]
#[allow(dead_code, reason = "each binary takes the helpers it needs")]
mod shared_joints;
#[path = "shared/motion.rs"]
#[allow(dead_code, reason = "each binary takes the helpers it needs")]
mod shared_motion;
#[path = "shared/orders.rs"]
mod shared_orders;
#[path = "shared/soak.rs"]
mod shared_soak;
#[path = "shared/victim.rs"]
mod shared_victim;

use lamina::report::strip::SHOTS;

use shared_cli::{folder, lamina, nulls};
use shared_soak::soak;
use shared_victim::{Outcome, Victim};

/// Of the ranges below the engine's own tests run some cases: here, optimised, all of them.
const EVERY: usize = 1;

mod engine {
    mod chains;
    mod loads;
    mod nets;
    mod seams;
}

#[test]
fn bench_and_report_print_one_json_document_each_and_leave_their_files() {
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

/// Ctrl-C leaves what was measured, and says what was not.
#[test]
fn an_interrupted_report_leaves_what_is_done() {
    let folder = folder();
    let out = folder.path().join("report");
    let mut report = std::process::Command::new(assert_cmd::cargo::cargo_bin!("lamina"));
    report.args(["report", "--full", "--out", out.to_str().unwrap()]);
    let mut report = report.stderr(std::process::Stdio::piped()).spawn().unwrap();
    // It has begun by then, and is minutes away from its end.
    std::thread::sleep(std::time::Duration::from_secs(3));
    let kill = std::process::Command::new("kill").args(["-INT", &report.id().to_string()]).status().unwrap();
    assert!(kill.success());
    let code = report.wait().unwrap().code();
    let mut said = String::new();
    std::io::Read::read_to_string(&mut report.stderr.take().unwrap(), &mut said).unwrap();
    assert_eq!(code, Some(1), "{said}");
    assert!(
        said.contains("interrupted: ending after this round") && said.contains("not run: matrix"),
        "{said}"
    );
    let page = std::fs::read_to_string(out.join("index.html")).unwrap();
    assert!(page.contains("Interrupted.") && page.contains("Not measured: matrix"), "{page}");
}

#[test]
fn long_orbits_have_their_orders() {
    for name in shared_orders::LONG {
        shared_orders::hold(name);
    }
}

#[test]
fn piles_nets_and_tumblers_last() {
    for name in ["t24_pile", "t24_net", "t24_churn"] {
        soak(name, 100_000);
    }
}

/// With any one bit flipped no wrong frame is shown as right: every bit of every byte.
#[test]
fn no_flipped_bit_shows_a_wrong_frame() -> Outcome {
    let (_folder, path) = shared_victim::folder();
    let file = Victim::small(&path)?;
    for at in 0..file.bytes.len() {
        for bit in 0..8 {
            file.flip(at, bit)?;
        }
    }
    Ok(())
}
