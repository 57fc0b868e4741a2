//! The accuracy laboratory: for every case, every integrator and solver, what error does a microsecond buy?
//!
//! | file | what |
//! |---|---|
//! | [`case`](mod@case) | what a case is: scene, reference, norm, methods, what is expected of each |
//! | `smooth` | the cases of table A |
//! | [`contact`] | the cases of table B, and of the shape mixes |
//! | [`instructions`] | their counts, by callgrind |
//! | `line` | what a method did on a case, in a line |
//! | `norm` | the error of a state against its reference |
//! | [`sweep`] | runs for errors, and others for times: rows |
//! | `order` | the order a line of errors shows |
//! | [`answers`] | the questions of the thesis, answered from the rows |
//! | [`best`] | Pareto staircase, fastest at an error, profiles over all cases |
//! | `plot` | SVG of one case, and of the profiles |
//! | [`tune`](mod@tune) | the cheapest settings for an error |
//! | [`write`](mod@write) | CSV, JSON and SVG into a folder |
//!
//! # Method and bias
//! - Errors come from runs of the scene itself, at the usual lane width; the other widths run the longest step too, and
//!   must agree to the bit. They say the same digits on every run and machine.
//! - Times come from other runs: the minimum and the median of windows of whole steps ([`lamina2d::world::World::step`]).
//!   A scene of one body without joints is timed as a crowd of [`sweep::CROWD`] copies that never meet, side by side
//!   within a millimetre, and the time divided by them: a single body would show the fixed cost of a step, not that
//!   of a scheme, and lanes would have nothing to do. The broad phase of the crowd is in it. A shape mix is timed from
//!   its first step to its last, the cost of bodies that fall and of those that lie.
//! - A run that ends in a state that is not finite is a gap: a row without error, drawn nowhere.
//! - References are closed forms, or order 16 in `f64` at two steps, whose disagreement gives the floor that is drawn; a
//!   test holds them against a Runge–Kutta method of order 8 by others. Errors less than a hundred times that floor are
//!   in the rows, but not in the drawing.

pub mod answers;
pub mod best;
pub mod case;
pub mod contact;
pub mod instructions;
mod line;
mod norm;
mod order;
mod plot;
mod smooth;
pub mod sweep;
pub mod tune;
pub mod write;

pub use best::{Fastest, Profile};
pub use case::{Case, Expect, Failing, Method, Norm};
pub use line::{Line, lines};
pub use order::{MIN_HALVINGS, Order, TOLERANCE};
pub use sweep::{Effort, Observed, Results, Row, measure, observe, once};

/// The cases of single laws: tables A and B.
const LAWS: &[Case] =
    &joined::<_, { smooth::CASES.len() + contact::CASES.len() }>(smooth::CASES, contact::CASES);

/// Every case that runs.
pub const CASES: &[Case] =
    &joined::<_, { LAWS.len() + contact::mixes::CASES.len() }>(LAWS, contact::mixes::CASES);

/// What is asked of the engine and cannot run, with the reason.
pub const FAILING: &[Failing] =
    &joined::<_, { smooth::FAILING.len() + contact::FAILING.len() }>(smooth::FAILING, contact::FAILING);

/// Two tables as one.
const fn joined<T: Copy, const N: usize>(first: &[T], second: &[T]) -> [T; N] {
    let mut all = [first[0]; N];
    let mut k = 0;
    while k < N {
        all[k] = if k < first.len() { first[k] } else { second[k - first.len()] };
        k += 1;
    }
    all
}

/// The cases of some names, in the order of the table; where there are none all, in a `quick` sweep without ensembles.
///
/// # Errors
/// A name that no case has: the message says which there are, or why that one cannot run.
pub fn chosen(names: &[String], quick: bool) -> anyhow::Result<Vec<&'static Case>> {
    for name in names {
        if let Some(failing) = FAILING.iter().find(|failing| failing.name == name) {
            anyhow::bail!("case '{name}' cannot run: {}", failing.reason);
        }
        if !CASES.iter().any(|case| case.name == name) {
            let choices = CASES.iter().map(|case| case.name).collect::<Vec<_>>().join(", ");
            anyhow::bail!("unknown case '{name}': one of {choices}");
        }
    }
    let wanted = |case: &&Case| {
        let by_name = names.iter().any(|name| name == case.name);
        by_name || names.is_empty() && !(quick && case.is_ensemble())
    };
    Ok(CASES.iter().filter(wanted).collect())
}
