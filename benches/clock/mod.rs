//! What the two criterion benches share: the clock's settings, and answers that must agree.
//!
//! A bench checks its answer where criterion first calls it, before the clock runs: `cargo test --benches`,
//! which runs each once, checks all of them.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::time::Duration;

use criterion::Criterion;

use crate::common::Answer;

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

/// The answers of benches, by what those have in common that must answer the same.
#[derive(Debug, Default)]
pub(crate) struct Agreement {
    firsts: RefCell<BTreeMap<String, (String, Answer)>>,
}

impl Agreement {
    /// Compares with the first answer of those that are `alike`.
    ///
    /// # Panics
    /// Where they differ.
    pub(crate) fn check(&self, alike: &str, bench: &str, answer: Answer) {
        let mut firsts = self.firsts.borrow_mut();
        let (other, expected) = firsts.entry(alike.to_owned()).or_insert_with(|| (bench.to_owned(), answer));
        assert_eq!(answer, *expected, "{bench} (left) and {other} (right) disagree");
    }
}
