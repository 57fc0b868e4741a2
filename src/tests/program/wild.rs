//! `lamina wild` as users run it: rows with the fields others script against, counts that follow from them, refusals.

use crate::shared_cli::lamina;
use lamina::wild::{Case, Course, KINDS, What, World, cases, rows, tally};
use lamina2d::scene::{BodySpec, ShapeSpec};
use lamina2d::settings::Precision;
use lamina2d::simulation::BodyState;
use serde_json::Value;

#[test]
fn the_collection_has_a_hundred_cases_of_every_kind_each_named_once() {
    let all = cases();
    assert!(all.len() >= 100, "{}", all.len());
    for kind in KINDS {
        assert!(all.iter().filter(|case| case.kind == kind).count() >= 8, "{kind}");
    }
    let mut names: Vec<_> = all.iter().map(|case| &case.name).collect();
    names.sort_unstable();
    names.dedup();
    assert_eq!(names.len(), all.len());
    for case in &all {
        assert!(!case.expects.is_empty(), "{}", case.name);
        for expect in &case.expects {
            assert!(expect.expected.is_finite() && expect.tolerance >= 0.0, "{}: {expect:?}", case.name);
            if let What::Body { step, .. } = expect.what {
                assert!((1..=case.scene.steps).contains(&step), "{}: {expect:?}", case.name);
            }
        }
    }
}

#[test]
fn rows_have_these_fields_and_counts_follow_from_them() {
    let answer = lamina(&["wild", "edges", "margins", "--json"]);
    assert_eq!(answer.code, Some(0), "{answer:#?}");
    let document: Value = serde_json::from_str(&answer.out).unwrap();
    let rows = document["rows"].as_array().unwrap();
    for row in rows {
        for field in ["case", "kind", "what", "sense"] {
            assert!(row[field].is_string(), "{field} in {row}");
        }
        assert!(
            row["expected"].is_number() && row["tolerance"].is_number() && row["met"].is_boolean(),
            "{row}"
        );
        assert!(row.get("found").is_some(), "{row}");
        let (kind, met) = (row["kind"].as_str().unwrap(), row["met"].as_bool().unwrap());
        assert!(kind == "edges" || kind == "margins", "{row}");
        if met && row["sense"] == "near" {
            let [found, expected, tolerance] =
                ["found", "expected", "tolerance"].map(|field| row[field].as_f64().unwrap());
            assert!((found - expected).abs() <= tolerance, "{row}");
        }
    }
    let wrong: std::collections::BTreeSet<_> =
        rows.iter().filter(|row| row["met"] == false).map(|row| row["case"].as_str().unwrap()).collect();
    let cases: std::collections::BTreeSet<_> = rows.iter().map(|row| row["case"].as_str().unwrap()).collect();
    assert_eq!(document["cases"].as_u64().unwrap() as usize, cases.len());
    assert_eq!(document["right"].as_u64().unwrap() as usize, cases.len() - wrong.len());
}

/// A world in which nothing moves.
struct Still(usize);

impl Course for Still {
    fn step(&mut self) -> anyhow::Result<()> {
        Ok(())
    }
    fn states(&self) -> Vec<BodyState> {
        let still =
            BodyState { position: [0.0; 2], rotation: [1.0, 0.0], velocity: [0.0; 2], angular_velocity: 0.0 };
        vec![still; self.0]
    }
    fn asleep(&self) -> Option<usize> {
        Some(0)
    }
}

/// An engine that does nothing gets none of the moving cases right: what is held to the numbers is what was run.
#[test]
fn an_engine_that_does_nothing_is_found_out() {
    let still = |case: &Case| Ok(Box::new(Still(case.scene.bodies.len())) as Box<dyn Course>);
    for kind in ["seams", "impacts", "restless", "events", "edges"] {
        let of: Vec<_> =
            cases().iter().filter(|case| case.kind == kind).flat_map(|case| rows(case, still)).collect();
        let found = tally(&of);
        assert!(found.cases >= 8 && found.right == 0, "{kind}: {found:?}");
    }
    let broken = |_: &Case| -> anyhow::Result<Box<dyn Course>> { anyhow::bail!("it has no such thing") };
    let case = &cases()[0];
    assert!(
        rows(case, broken).iter().all(|row| !row.met && row.note.as_deref() == Some("it has no such thing"))
    );
}

/// What is kilometres away, more of it and far larger than what is here, changes nothing that is right.
#[test]
fn what_is_far_away_changes_nothing() {
    let ours = |case: &Case| Ok(Box::new(World::new(case, Precision::F32)?) as Box<dyn Course>);
    let kinds = ["seams", "margins", "impacts", "restless", "weight"];
    for case in cases().into_iter().filter(|case| kinds.contains(&case.kind)) {
        let mut beside = case.clone();
        let giant = |k: usize| {
            let place = [1e4 + 300.0 * k as f64, -1e4];
            BodySpec::new(ShapeSpec::Box([100.0, 50.0]), place).fixed()
        };
        beside.scene.bodies.extend((0..=case.scene.bodies.len()).map(giant));
        let [alone, with] = [case, beside].map(|case| rows(&case, ours));
        for (alone, with) in alone.iter().zip(with) {
            assert_eq!(alone.met, with.met, "{alone:?}\n{with:?}");
        }
    }
}

#[test]
fn what_is_not_there_is_refused() {
    let answer = lamina(&["wild", "nonsense"]);
    assert_eq!(answer.code, Some(2), "{answer:#?}");
    assert!(answer.err.contains("unknown case 'nonsense': a kind (seams, margins, "), "{answer:#?}");
}
