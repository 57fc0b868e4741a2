//! What the two criterion benches share: the clock's settings.
//!
//! A bench checks its answer where criterion first calls it, before the clock runs: `cargo test --benches`,
//! which runs each once, checks all of them.

use std::time::Duration;

use criterion::Criterion;

/// Samples few and short: some five hundred benches have to fit into a quarter of an hour. The command
/// line overrides.
pub(crate) fn criterion() -> Criterion {
    Criterion::default()
        .sample_size(20)
        .warm_up_time(Duration::from_millis(200))
        .measurement_time(Duration::from_millis(500))
        .nresamples(10_000)
        .configure_from_args()
}
