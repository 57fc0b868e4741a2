//! The stress laboratory: cases that hold, limits that are found, rows that are read as they were written.

use lamina::stress::churn::Churn;
use lamina::stress::{CASES, Limit, Row, chosen, limit, run};
use lamina2d::settings::{Precision, Settings, Solver};

use crate::shared_soak::{at_8, case, soak};

/// A case as the table has it, for the seconds of a quick run.
fn row_of(name: &str, settings: Settings) -> Row {
    let case = case(name);
    run(case, case.parameter.value, settings, case.secs[1]).expect("a scene that can be run")
}

#[test]
fn every_item_of_the_table_has_a_case_and_every_case_its_scene() {
    let items: Vec<String> = (1..=28).filter(|item| *item != 11).map(|item| format!("T{item}")).collect();
    for item in &items {
        assert!(CASES.iter().any(|case| case.item == item), "{item} has no case");
    }
    for case in CASES {
        assert!(items.iter().any(|item| item == case.item), "{} is none of the table's", case.item);
        let scene = (case.build)(case.parameter.value);
        assert!(!scene.bodies.is_empty());
        if let Ok(named) = lamina::cases::by_name(case.name, None, 1) {
            assert!(named.bodies == scene.bodies && named.joints == scene.joints, "{}", case.name);
        }
        let [least, most] = case.parameter.range;
        assert!((least..=most).contains(&case.parameter.value), "{}", case.name);
    }
    assert!(chosen(&["t99".to_owned()]).is_err_and(|error| error.to_string().contains("t01_column")));
}

/// Each at the length of a quick run; those that take long without optimisation are left to `lamina stress`.
#[test]
fn cheap_cases_hold_at_eight_substeps() {
    for name in [
        "t01_column",
        "t06_feet",
        "t07_heavy",
        "t08_sizes",
        "t10_chain",
        "t12_cards",
        "t16_removed",
        "t18_bullet",
        "t19_bullets",
        "t21_far",
        "t21_fine",
        "t22_wide",
        "t27_drift",
        "t28_shapes",
    ] {
        let row = row_of(name, at_8());
        assert!(row.pass, "{name}: {} asked, {:?} found, {:?}", row.threshold, row.found, row.failed);
    }
}

/// What does not hold is seen not to: a tower beyond all limits, a weight far too heavy, a hole in the floor.
#[test]
fn what_breaks_is_seen() {
    // The default solves such contacts at once.
    let visited = Settings { substeps: 1, solver: Solver::Xpbd, ..Settings::default() };
    let case = case("t07_heavy");
    let row = run(case, 1e6, visited, 4.0).expect("a scene that can be run");
    assert!(!row.pass && row.worst_share() > 1.0, "{row:?}");
    let fired = self::case("t18_bullet");
    let through = Settings { continuous: false, ..at_8() };
    let row = run(fired, 1e4, through, 1.0).expect("a scene that can be run");
    assert!(!row.pass, "{row:?}");
}

#[test]
fn a_limit_is_between_what_holds_and_what_does_not() {
    let case = case("t07_heavy");
    let settings = Settings { solver: Solver::Xpbd, ..Settings::default() };
    let Limit { holds, whole_range } = limit(case, settings, 3.0).expect("a scene that can be run");
    let ratio = holds.expect("equal boxes stand");
    assert!(!whole_range && ratio > 10.0, "{ratio}");
    assert!(run(case, ratio, settings, 3.0).expect("a scene").pass);
    assert!(!run(case, 1.1 * ratio, settings, 3.0).expect("a scene").pass);
}

#[test]
fn rows_are_read_as_they_were_written() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut rows = vec![row_of("t18_bullet", at_8()), row_of("t28_shapes", at_8())];
    rows[1].limit_note = Some("none".to_owned());
    lamina::stress::write::case(case("t18_bullet"), &rows[..1], folder.path()).expect("can be written");
    for ending in ["csv", "json", "svg"] {
        assert!(folder.path().join(format!("t18_bullet.{ending}")).exists(), "{ending}");
    }
    lamina::stress::write::all(&rows, folder.path()).expect("can be written");
    let (read, from) = lamina::stress::write::read(&folder.path().join("stress.json")).expect("can be read");
    assert!(from.is_some_and(|from| from.when.is_some()));
    assert_eq!(read, rows);
    let again = row_of("t18_bullet", at_8());
    assert_eq!(again, rows[0], "two runs find the same");
}

/// T23: sizes by powers of four, steps by powers of two: the same bits, from a millimetre to a kilometre.
#[test]
fn pyramids_of_any_size_do_the_same_in_their_own_time() {
    let own = case("t23_tiny").own.expect("compares runs");
    for (precision, power) in
        [(Precision::F32, -5), (Precision::F32, 5), (Precision::F64, -5), (Precision::F64, 5)]
    {
        let size = 4f64.powi(power);
        let settings = at_8().with_precision(precision);
        // As many steps as the large one takes in a second.
        let secs = size.sqrt();
        let row = run(case("t23_tiny"), size, settings, secs).expect("a scene that can be run");
        assert_eq!(row.found, [Some(0.0)], "{size} m in {precision}: {}", own.what);
    }
    for size in [1e-3, 1e3] {
        let row = run(case("t23_tiny"), size, at_8(), size.sqrt()).expect("a scene that can be run");
        assert!(row.pass, "{size} m: {:?}", row.found);
    }
}

#[test]
fn piles_nets_and_tumblers_last() {
    soak("t24_pile", 3000);
    soak("t24_net", 3000);
    soak("t24_churn", 1500);
}

/// Memory of a churned world: what was allocated and not given back is no more at the end than early on.
#[test]
fn a_churned_world_does_not_grow() {
    let case = case("t24_churn");
    let scene = (case.build)(case.parameter.value);
    for solver in [Solver::Soft, Solver::Avbd] {
        let settings = Settings { solver, substeps: 2, sleep: true, ..Settings::default() };
        let mut world = lamina2d::simulation::simulate(&scene, settings).expect("a good scene");
        let mut churn = Churn::new(&scene, world.as_ref(), 7);
        let mut go = |steps: u64| {
            allocation_counter::measure(|| {
                for _ in 0..steps {
                    world.step(scene.dt_secs).expect("stays finite");
                    churn.stir(world.as_mut()).expect("bodies are good");
                }
            })
            .bytes_current
        };
        let begun = go(1500);
        let grown = go(1500);
        println!("{solver}: {begun} B in 1500 steps, {grown} B in 1500 more");
        // Columns grow by doubling: room for the most that ever touched is found late now and then.
        assert!(grown <= begun.max(1 << 16) / 2, "{solver}: {grown} after {begun}");
        churn.finish(world.as_ref());
        assert_eq!((churn.seen.wrong_ids, churn.seen.escaped), (0, 0));
        assert!(churn.seen.changes >= 600);
    }
}
