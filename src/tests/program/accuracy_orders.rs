//! Table A, cell by cell: every integrator on every smooth case, by the laboratory's own full sweep in `f64`.
//!
//! An order is the slope of log error over log h over at least four halvings, and must be within 0.15 of the table's.
//! `cargo test --test program accuracy_orders -- --nocapture` prints what was observed.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

use lamina::accuracy::{CASES, Expect, MIN_HALVINGS, Observed, TOLERANCE, chosen, observe};

/// Runs a case and holds every method to what is expected of it.
fn hold(name: &str) -> Vec<Observed> {
    let case = chosen(&[name.to_owned()], false).unwrap()[0];
    let all = observe(case).unwrap();
    for observed in &all {
        let Observed { method, expect, errors, order, .. } = observed;
        let least = errors.iter().filter_map(|(_, error)| *error).fold(f64::INFINITY, f64::min);
        let order = order.map_or_else(|| "none".to_owned(), |order| format!("{:.4}", order.order));
        println!("{name:20} {method:28} {expect}: order {order}, least error {least:.1e}");
    }
    for observed in &all {
        if let (Expect::Order(wanted), Some(got)) = (observed.expect, observed.order) {
            assert!(got.halvings >= MIN_HALVINGS && (got.order - wanted).abs() <= TOLERANCE, "{observed:?}");
        }
        assert!(observed.met, "{name} {}: {observed:?}", observed.method);
    }
    all
}

/// One test per case: each holds the row's cells.
macro_rules! cells {
    ($($name:ident),+ $(,)?) => {
        $(#[test]
        fn $name() {
            hold(stringify!($name));
        })+

        /// No case of the table without its test.
        #[test]
        fn every_case_is_held() {
            let held = [$(stringify!($name)),+];
            for case in CASES.iter().filter(|case| !case.is_contact()) {
                assert!(held.contains(&case.name), "{} has no test", case.name);
            }
        }
    };
}

cells! {
    a01_gravity,
    a02_linear_drag,
    a03_quadratic_drop,
    a04_quadratic_shot,
    a05_oscillator,
    a06_stiff,
    a07_damped,
    a07_overdamped,
    a08_resonance,
    a09_pendulum,
    a09_length,
    a09_energy,
    a10_rod,
    a11_double_pendulum,
    a12_kepler_e05,
    a12_kepler_e09,
    a12_energy,
    a12_momentum,
    a12_apsis,
    a13_circle,
    a13_drift,
    a14_arenstorf,
    a15_pleiades,
    a15_henon_heiles,
    a16_spin,
}
