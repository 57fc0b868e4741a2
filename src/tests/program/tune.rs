//! `lamina tune` as users run it: what it finds keeps the error, by the command it gives; what cannot be is said.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

use crate::shared_cli::lamina;
use serde_json::Value;

fn tuned(args: &[&str]) -> Value {
    let answer = lamina(&[&["tune", "--json"], args].concat());
    assert_eq!(answer.code, Some(0), "{answer:#?}");
    serde_json::from_str(&answer.out).unwrap()
}

fn best(answer: &Value) -> &Vec<Value> {
    answer["best"].as_array().unwrap()
}

/// Runs the command of the winner; returns what it says of errors.
fn run_again(run: &Value) -> Value {
    let command = run["command"].as_str().unwrap();
    let args: Vec<&str> = command.strip_prefix("lamina ").unwrap().split(' ').chain(["--json"]).collect();
    let answer = lamina(&args);
    assert_eq!(answer.code, Some(0), "{command}: {answer:#?}");
    let document: Value = serde_json::from_str(&answer.out).unwrap();
    document["error"].clone()
}

#[test]
fn the_cheapest_for_a_closed_form_keeps_its_error() {
    let mut times = Vec::new();
    for max_error in [1e-2, 1e-5] {
        let answer = tuned(&["a05_oscillator", "--seconds", "2", "--max-error", &max_error.to_string()]);
        assert_eq!((&answer["metric"], &answer["unit"]), (&"case".into(), &"relative".into()));
        assert_eq!(answer["met"], true);
        assert!(answer["tried"].as_u64().unwrap() > 5);
        for run in best(&answer) {
            assert!(run["error"].as_f64().unwrap() <= max_error);
            assert_eq!(run["solver"], Value::Null, "nothing touches");
        }
        let ns = |run: &Value| run["ns_per_simulated_second"].as_f64().unwrap();
        assert!(best(&answer).is_sorted_by(|a, b| ns(a) <= ns(b)));
        assert!(run_again(&best(&answer)[0])["case"].as_f64().unwrap() <= max_error);
        times.push(best(&answer)[0]["h"].as_f64().unwrap() / ns(&best(&answer)[0]));
    }
    assert!(times[0] > 0.0 && times[1] > 0.0);
}

#[test]
fn overlap_is_kept_by_the_command_it_gives() {
    let answer = tuned(&["stack/4", "--seconds", "2", "--max-error", "2e-3", "--budget", "20"]);
    assert_eq!((&answer["metric"], &answer["met"]), (&"overlap".into(), &true.into()));
    let winner = &best(&answer)[0];
    assert!(winner["solver"].is_string());
    let again = run_again(winner);
    // The metric is a mean over the last half second; a stack at rest is at its end as it was before.
    let (said, found) = (winner["error"].as_f64().unwrap(), again["mean_penetration"].as_f64().unwrap());
    assert!(found <= 2.5e-3 && (found - said).abs() < 1e-3, "{said} {found}");
}

#[test]
fn a_converged_run_judges_what_has_no_closed_form() {
    let answer =
        tuned(&["a11_double_pendulum", "--metric", "trajectory", "--seconds", "1", "--max-error", "1e-2"]);
    assert!(best(&answer)[0]["error"].as_f64().unwrap() <= 1e-2);
    let stricter =
        tuned(&["a11_double_pendulum", "--metric", "trajectory", "--seconds", "1", "--max-error", "1e-4"]);
    let rounds = |answer: &Value| {
        let run = &best(answer)[0];
        run["substeps"].as_f64().unwrap() / run["h"].as_f64().unwrap()
    };
    assert!(rounds(&stricter) > rounds(&answer), "less error is more work");
}

#[test]
fn it_says_so_when_none_does() {
    let answer = lamina(&["tune", "a05_oscillator", "--seconds", "1", "--max-error", "1e-18"]);
    assert_eq!(answer.code, Some(1), "{answer:#?}");
    let said = "no settings tried keep case of a05_oscillator under 0.000000000000000001 relative";
    assert!(answer.err.contains(said), "{answer:#?}");
    assert!(answer.out.contains("None meets it; nearest"), "{answer:#?}");
}

#[test]
fn what_cannot_be_told_is_refused() {
    for (args, mentions) in [
        (&["stack/2", "--max-error", "0"][..], &["--max-error", "positive", "0"][..]),
        (&["stack/2", "--max-error", "nan"], &["--max-error", "NaN"]),
        (&["stack/2", "--max-error", "1", "--seconds", "-1"], &["--seconds", "-1"]),
        (&["stack/2", "--max-error", "1", "--metric", "speed"], &["speed", "overlap", "trajectory"]),
        (&["nothing", "--max-error", "1"], &["unknown scene 'nothing'"]),
        (&["all/20", "--max-error", "1", "--metric", "case", "--seconds", "0.1"], &["no closed form"]),
        (&["a05_oscillator", "--max-error", "1", "--metric", "overlap"], &["nothing touches"]),
        (
            &["all/30", "--max-error", "1e-9", "--metric", "trajectory", "--seconds", "2"],
            &["itself unsure", "--seconds"],
        ),
    ] {
        lamina(&[&["tune"], args].concat()).fails(2, mentions);
    }
}

/// The upper of two boxes leans and is hit by a ball: an engine under which it falls and slides for ever has little
/// overlap. What is chosen comes out as another solver's converged run does, and the default stands beside it.
#[test]
fn what_comes_out_otherwise_than_a_converged_run_is_not_chosen() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("hit.toml");
    let scene = "[settings]\nsteps = 180\n[forces]\ngravity = [0, -9.81]
        [[body]]\nkind = 'static'\nshape = { box = [20, 0.5] }\nposition = [0, -0.5]
        [[body]]\nshape = { box = [0.5, 0.5] }\nposition = [0, 0.5]
        [[body]]\nshape = { box = [0.5, 0.5] }\nposition = [0.1, 1.55]\nangle = 0.05
        [[body]]\nshape = { circle = 0.2 }\nposition = [-4, 1.5]\nvelocity = [8, 0]\n";
    std::fs::write(&file, scene).unwrap();
    let path = file.to_str().unwrap();
    let answer = tuned(&[path, "--max-error", "2e-3", "--budget", "15"]);
    assert_eq!(answer["met"], true);
    assert!(answer["disagreed"].as_u64().unwrap() > 0, "some keep the overlap and come out otherwise");
    for run in best(&answer) {
        assert_eq!((&run["agrees"], &run["differs"]), (&true.into(), &Value::Null));
    }
    let default = &answer["default"];
    assert_eq!((&default["solver"], &default["substeps"]), (&"soft".into(), &4.into()));
    assert!(default["ns_per_simulated_second"].as_f64().unwrap() > 0.0);
    // Energies of a run by another solver in 64 times as many steps, and of the winner.
    let converged = ["run", path, "--steps", "11520", "--dt", "0.00026041666666666666", "--solver", "xpbd"];
    let converged = lamina(&[&converged[..], &["--precision", "f64", "--json"]].concat());
    let converged: Value = serde_json::from_str(&converged.out).unwrap();
    let again = run_again(&best(&answer)[0]);
    let [found, right] =
        [&again, &converged["error"]].map(|error| error["potential_energy"].as_f64().unwrap());
    assert!((found - right).abs() < 0.3, "the upper box lies elsewhere: {found} J, {right} J");
}
