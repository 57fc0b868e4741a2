//! What people report of 2D engines, as scenes with the right numbers beside them.
//!
//! | file | kind of report |
//! |---|---|
//! | `seams` | what slides, rolls or bounces over flush statics is caught |
//! | `margins` | what passes close by is touched |
//! | `impacts` | bullets and heavy bodies pass, stick, gain energy |
//! | `joints` | what is joined stretches, folds, loses energy |
//! | `restless` | what would move falls asleep, and what rests does not |
//! | `stiff` | strong drags, springs and magnets end in nonsense |
//! | `weight` | weight given as a force, or more of it, behaves otherwise |
//! | `edges` | numbers that cannot be run with are run with |
//! | `events` | what is done to a scene on its way does nothing, or too much |
//! | `case`, `run` | what a case is; a case with an engine, held to its numbers |
//!
//! Each number is worked out by hand from a closed form beside its case; none comes from an engine.

mod case;
mod edges;
mod events;
mod impacts;
mod joints;
mod margins;
mod restless;
mod run;
mod seams;
mod stiff;
mod weight;

pub use case::{Case, Column, Expect, Sense, What};
pub use run::{Course, Row, Tally, World, rows, tally};

/// The names of the kinds, in order.
pub const KINDS: [&str; 9] =
    ["seams", "margins", "impacts", "joints", "restless", "stiff", "weight", "edges", "events"];

/// Every case, kind by kind.
pub fn cases() -> Vec<Case> {
    let kinds = [
        seams::cases(),
        margins::cases(),
        impacts::cases(),
        joints::cases(),
        restless::cases(),
        stiff::cases(),
        weight::cases(),
        edges::cases(),
        events::cases(),
    ];
    let named =
        |(kind, cases): (&'static str, Vec<Case>)| cases.into_iter().map(move |case| Case { kind, ..case });
    KINDS.into_iter().zip(kinds).flat_map(named).collect()
}

/// The cases whose name or kind begins with one of the words; all where there are none.
///
/// # Errors
/// A word that no case's name and no kind begins with.
pub fn chosen(words: &[String]) -> anyhow::Result<Vec<Case>> {
    let all = cases();
    let fits =
        |case: &Case, word: &String| case.name.starts_with(word.as_str()) || case.kind == word.as_str();
    for word in words {
        anyhow::ensure!(
            all.iter().any(|case| fits(case, word)),
            "unknown case '{word}': a kind ({}) or how a case's name begins",
            KINDS.join(", ")
        );
    }
    Ok(all.into_iter().filter(|case| words.is_empty() || words.iter().any(|word| fits(case, word))).collect())
}
