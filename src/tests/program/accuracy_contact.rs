//! Table B, case by case, at reduced length: those that meet their target at the default settings or at those they
//! name are held to it, the others to what they reach, each with what keeps it from its target.
//!
//! `cargo test --test program accuracy_contact -- --nocapture` prints what was observed.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

use lamina::accuracy::{CASES, Case, FAILING, chosen, contact, once};
use lamina::cases::by_name;
use lamina2d::settings::{Precision, Settings, Solver};

fn case(name: &str) -> &'static Case {
    chosen(&[name.to_owned()], false).unwrap()[0]
}

/// Seconds that show what a long case is about.
fn secs(case: &Case) -> f64 {
    match case.name {
        "b11_elastic_ball" => 45.0,
        "b16_box_billiard" => 30.0,
        _ => case.horizon_secs,
    }
}

/// Error and target at some settings.
fn run(name: &str, settings: Settings) -> [f64; 2] {
    let case = case(name);
    let error = once(case, settings, Some(secs(case))).unwrap().expect("the run stays finite");
    let target = contact::target(case, settings, secs(case)).unwrap();
    let Settings { solver, substeps, dt_secs, precision, .. } = settings;
    let met = if error <= target { "met" } else { "missed" };
    println!(
        "{name:20} {solver} ×{substeps} h {dt_secs:.2e} {precision}: {error:.2e} of {target:.0e}, {met}"
    );
    [error, target]
}

fn named(name: &str) -> [f64; 2] {
    run(name, contact::named(case(name)))
}

macro_rules! table {
    (met: $($met:ident),+; missed: $($missed:ident <= $bound:literal),+ $(,)?) => {
        $(#[test]
        fn $met() {
            let [error, target] = named(stringify!($met));
            assert!(error <= target, "{error:e} for {target:e}");
        })+

        $(#[test]
        fn $missed() {
            let [error, _] = named(stringify!($missed));
            assert!(error <= $bound, "{error:e}, was at most {:e}", $bound);
        })+

        const HELD: &[&str] = &[$(stringify!($met),)+ $(stringify!($missed)),+];
    };
}

table! {
    met:
        b01_sliding_block,
        b02_stick_limit,
        b02_creep,
        b03_incline_slide,
        b03_topple,
        b04_rolling_disc,
        b04_slipping_disc,
        b05_slide_to_roll,
        b10_bounces,
        b10_rest,
        b11_elastic_ball,
        b12_head_on,
        b12_head_on_boxes,
        b13_oblique,
        b14_rod_hit,
        b16_box_billiard,
        b17_cradle_gaps,
        b17_cradle_touching,
        b18_stack,
        b18_offset,
        b21_overhang,
        b22_arch,
        b24_pushed_board,
        b25_conveyor,
        b26_hanging_chain,
        b27_dominoes,
        b28_collisions,
        b28_maxwell,
        b28_energy,
        b31_painleve;
    missed:
        // 1e-3, order 2 in the table. Bowl and loop are 720 facets, whose dents alone take 0.6 and 0.9 % of the energy a
        // radian (scene::contact, rolling): the swing shrinks, and its period with it.
        b06_bowl <= 0.06,
        // At 1/60 s a disc at 10 m/s is (vh)²/2R = 8 mm deep in facets of 17 mm before they are heard of, as near to
        // their ends as to their faces, and is thrown back by an end: it does not go round from 1.3 times the height.
        b08_loop_sliding <= 0.31,
        b08_loop_rolling <= 0.31,
        // 1e-6: discs that touch hand on the push that stops the first, so that 2 and 3 go on together as Newton's law has
        // it, but the bounce is the first pair's alone: (-0.17, 0.58, 0.58).
        b17_cradle_at_once <= 0.17,
        // 1e-3: of order 1 in the step and the same at any number of substeps, as points are found once per step; and what
        // the corner sags by as it takes over, g·10 µm, is 1e-3 of the 0.135 J/kg there are.
        b23_rocking_block <= 0.035,
        // 1e-2, with an uncertainty of as much: bodies are heard of when they overlap.
        b28_pressure <= 0.03,
        // ε·e^(2λt) would be 1e-7 with the λ of 4/s of the solver impulse. The rack's gaps of 0.1 mm close within a step:
        // which balls meet first is not known, and is otherwise on the way back.
        b30_break <= 20.0,
}

/// No item of the table without a case, no case without its test, and a scene behind each.
#[test]
fn every_item_has_a_case_and_every_case_a_test() {
    let contact: Vec<_> = CASES.iter().filter(|case| case.is_contact() && !case.is_mix()).collect();
    for item in [1, 2, 3, 4, 5, 6, 8, 10, 11, 12, 13, 14, 16, 17, 18, 21, 22, 23, 24, 25, 26, 27, 28, 30, 31]
    {
        let item = format!("B{item}");
        assert!(contact.iter().any(|case| case.item == item), "{item} is missing");
    }
    for case in &contact {
        assert!(HELD.contains(&case.name), "{} has no test", case.name);
        assert!(by_name(case.scene, None, 1).is_ok(), "{} has no scene", case.name);
    }
    assert_eq!(HELD.len(), contact.len());
    assert!(FAILING.iter().any(|failing| failing.name == "b16_circle_billiard"));
}

/// Way and sag are of order 2 in the substep: 16 times better with 4 times as many.
///
/// A block slides ½μgh² too far in its first substep, whose displacement knows no friction yet, and μgh² too little where
/// it stops, as the friction of the substep before is carried into the displacement.
#[test]
fn ways_and_sag_are_of_order_2_in_the_substep() {
    let double = Settings::default().with_precision(Precision::F64);
    for name in
        ["b01_sliding_block", "b03_incline_slide", "b05_slide_to_roll", "b25_conveyor", "b26_hanging_chain"]
    {
        let [few, _] = run(name, double);
        let [many, _] = run(name, Settings { substeps: 16, ..double });
        let ratio = few / many;
        assert!((12.0..24.0).contains(&ratio), "{name}: {ratio}");
    }
}

/// Impacts are located within the step: a thousandth of a step or a whole one, a ball rises to where it fell from.
#[test]
fn a_ball_keeps_its_energy_at_every_step() {
    let double = Settings::default().with_precision(Precision::F64);
    for solver in [Solver::Soft, Solver::Xpbd] {
        for per_sec in [30.0, 60.0, 97.0, 480.0] {
            let settings = Settings { solver, dt_secs: 1.0 / per_sec, ..double };
            let [error, target] = run("b11_elastic_ball", settings);
            assert!(error <= target && error < 1e-12, "{solver} {per_sec}: {error:e}");
        }
    }
}

/// Nothing is met by chance of the lane width.
#[test]
fn lanes_change_no_bit() {
    for name in ["b05_slide_to_roll", "b13_oblique", "b18_offset", "b24_pushed_board"] {
        for precision in [Precision::F32, Precision::F64] {
            let at = |&lanes: &usize| {
                let settings = Settings { lanes, ..Settings::default().with_precision(precision) };
                once(case(name), settings, None).unwrap().map(f64::to_bits)
            };
            let all: Vec<_> = Settings::widths(precision).iter().map(at).collect();
            assert!(all.iter().all(|bits| *bits == all[0]), "{name} {precision}: {all:?}");
        }
    }
}
