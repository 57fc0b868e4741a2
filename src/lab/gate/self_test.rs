//! Proof that the gate catches what it is there for: real counts of a kernel with more to do, through the comparison
//! every run goes through, and what else must never pass.

use super::{Baselines, Counts, RunError, Toolchain, Verdict, baseline, compare, run};

/// The name under which kernels are compared, whatever they had to do.
const NAME: &str = "integrate/rk4";

/// One thing that must be so.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Proof {
    /// What was tried.
    pub what: String,
    /// What the gate said.
    pub said: String,
    /// Was it right?
    pub holds: bool,
}

/// Counts a kernel, the same with a hundredth more to do and with twice as much, and tries everything that must fail.
///
/// # Errors
/// Those of [`super::count`]; a kernel that was not counted.
pub fn prove(toolchain: &Toolchain) -> Result<Vec<Proof>, RunError> {
    let counted = run::count_proof()?;
    let of = |name: &str| {
        let found = counted.iter().find(|(bench, _)| bench.starts_with(&format!("proof/{name}/")));
        found.map(|(_, count)| *count).ok_or(RunError::Summary { bench: name.to_owned(), why: "not run" })
    };
    let [once, more, twice] = [of("once")?, of("one_percent_more")?, of("twice")?];
    let mut proofs = vec![
        against(once, Some(once), Verdict::Same, "the same kernel"),
        against(once, Some(more), Verdict::More, "one percent more to do"),
        against(once, Some(twice), Verdict::More, "twice as much to do"),
        against(twice, Some(once), Verdict::Fewer, "half as much to do"),
        against(once, None, Verdict::NotRun, "a bench that did not run"),
        against(once, Some(0), Verdict::Zero, "a count of 0"),
    ];
    proofs.extend(never_pass(once, toolchain));
    Ok(proofs)
}

fn kernel(count: Option<u64>) -> Counts {
    Counts { kernels: count.map(|count| (NAME.to_owned(), count)).into_iter().collect(), ..Counts::default() }
}

/// Blesses `old` in memory and compares with `new`.
fn against(old: u64, new: Option<u64>, expected: Verdict, what: &str) -> Proof {
    let compared = compare(&kernel(Some(old)), &kernel(new));
    let verdicts: Vec<_> = compared.rows.iter().map(|row| row.verdict).collect();
    let said = match compared.rows.first() {
        Some(row) => {
            let change = row.change.map_or_else(String::new, |change| format!(" ({:+.3} %)", change * 100.0));
            format!(
                "{} → {}: {}{change}",
                old,
                new.map_or("–".to_owned(), |new| new.to_string()),
                row.verdict.name()
            )
        }
        None => "nothing".to_owned(),
    };
    let holds = verdicts == [expected] && compared.passes() != expected.fails();
    Proof { what: what.to_owned(), said, holds }
}

/// What has nothing to compare with.
fn never_pass(count: u64, toolchain: &Toolchain) -> [Proof; 4] {
    let proof = |what: &str, said: String, holds: bool| Proof { what: what.to_owned(), said, holds };
    let unblessed = compare(&Counts::default(), &kernel(Some(count)));
    let nothing = compare(&Counts::default(), &Counts::default());
    let mut baselines = Baselines::default();
    let other = Toolchain { rustc: format!("{} of another day", toolchain.rustc), ..toolchain.clone() };
    baselines.bless(&other, &kernel(Some(count)), "self-test".to_owned());
    let missing = baseline("no such folder/instructions.toml".as_ref());
    [
        proof(
            "a bench without a blessed count",
            unblessed.failure().unwrap_or_default(),
            unblessed.count(Verdict::NotBlessed) == 1 && !unblessed.passes(),
        ),
        proof("no count at all", nothing.failure().unwrap_or_default(), !nothing.passes()),
        proof(
            "counts of another compiler alone",
            baselines.unknown(toolchain),
            baselines.of(toolchain).is_none() && baselines.of(&other).is_some(),
        ),
        match missing {
            Ok(_) => proof("a missing file", "read".to_owned(), false),
            Err(error) => proof("a missing file", error.to_string(), true),
        },
    ]
}
