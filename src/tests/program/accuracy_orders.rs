//! Table A, cell by cell: every integrator on every smooth case, by the laboratory's own full sweep in `f64`.
//!
//! An order is the slope of log error over log h over at least four halvings, and must be within 0.15 of the table's.
//! `cargo test --test program accuracy_orders -- --nocapture` prints what was observed.

use lamina::accuracy::CASES;

use crate::shared_orders::{LONG, hold};

/// One test per case: each holds the row's cells. The long ones are held optimised, by `slow`.
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
                assert!(held.contains(&case.name) || LONG.contains(&case.name), "{} has no test", case.name);
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
    a12_energy,
    a12_momentum,
    a12_apsis,
    a13_circle,
    a13_drift,
    a15_henon_heiles,
    a16_spin,
}
