//! A row of the table of orders, held cell by cell by the laboratory's own full sweep.

use lamina::accuracy::{Expect, MIN_HALVINGS, Observed, TOLERANCE, chosen, observe};

/// Twenty seconds to a minute each without optimisation: held by `cargo test --release --test slow`.
pub(crate) const LONG: [&str; 3] = ["a12_kepler_e09", "a14_arenstorf", "a15_pleiades"];

/// Runs a case and holds every method to what is expected of it.
pub(crate) fn hold(name: &str) {
    let case = chosen(&[name.to_owned()], false).expect("a case of this name")[0];
    let all = observe(case).expect("stays finite");
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
}
