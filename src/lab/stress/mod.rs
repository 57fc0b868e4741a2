//! The stress laboratory: where it breaks.
//!
//! | file | what |
//! |---|---|
//! | `case` | what a case is: a scene by one number, what is done to it, and what must hold |
//! | [`table`] | the cases of table T |
//! | `seen` | what a run was seen to do |
//! | `own` | cases that compare runs, or vary the step |
//! | [`run`](mod@run) | a case with one solver, number of substeps and precision |
//! | [`limit`](mod@limit) | the number at which it breaks, by halving |
//!
//! # Metrics
//! | name | unit | what |
//! |---|---|---|
//! | pen | m | the largest overlap at any of 16 looks in the second half |
//! | jit | m/s | root mean square of the speeds over the last second |
//! | drift | m | the farthest any body is at the end from where it was at half the time |
//! | energy_gain | J | the most energy over that at the start, looked at ten times a second |
//! | settle_secs | s | from when on no body is faster than 1 cm/s; null where that never is so |
//! | non_finite | – | 1 where the run ended in a state that is not finite |
//! | escaped | – | bodies that end more than 1 m outside of what encloses them |

mod case;
pub mod churn;
pub mod limit;
mod own;
pub mod run;
mod seen;
pub mod table;
mod tables;
pub mod write;

pub use case::{Case, Check, Deed, Own, Pace, Parameter, Trial, Worse};
pub use limit::{Limit, limit};
pub use run::{Row, run};
pub use seen::{Metrics, Seen};
pub use table::CASES;
pub use tables::{LimitLine, PassLine, answers, limit_lines, pass_lines, passed_items};

/// The cases of some names, all where there are none, in the order of the table.
///
/// # Errors
/// A name that no case has: the message says which there are.
pub fn chosen(names: &[String]) -> anyhow::Result<Vec<&'static Case>> {
    for name in names {
        if !CASES.iter().any(|case| case.name == name) {
            let choices = CASES.iter().map(|case| case.name).collect::<Vec<_>>().join(", ");
            anyhow::bail!("unknown case '{name}': one of {choices}");
        }
    }
    let wanted = |case: &&Case| names.is_empty() || names.iter().any(|name| name == case.name);
    Ok(CASES.iter().filter(wanted).collect())
}
