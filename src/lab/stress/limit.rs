//! The number at which a case breaks.

use lamina2d::settings::Settings;

use super::case::{Case, Worse};
use super::run::run;

/// A limit is known to this share of itself.
const SHARE: f64 = 0.05;

/// Up to where a case holds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limit {
    /// The last number seen to hold; `None` where none did, down to the mildest.
    pub holds: Option<f64>,
    /// The harshest that was tried held too.
    pub whole_range: bool,
}

/// Looks for the number up to which a case holds, beginning where the table looks: harsher by twos until it breaks, or
/// milder until it holds; then between.
///
/// What breaks once and holds again further on is not seen: the breach nearest to what is asked counts.
///
/// # Errors
/// A scene that cannot be run.
pub fn limit(case: &Case, settings: Settings, secs: f64) -> anyhow::Result<Limit> {
    let parameter = &case.parameter;
    let [least, most] = parameter.range;
    anyhow::ensure!(least > 0.0, "{}: what is doubled must not begin at 0", case.name);
    let (mild, harsh) = if parameter.worse == Worse::Larger { (least, most) } else { (most, least) };
    let round = |value: f64| if parameter.whole { value.round() } else { value };
    let holds = |value: f64| Ok::<_, anyhow::Error>(run(case, value, settings, secs)?.pass);
    let further = |value: f64, end: f64| {
        let next = if end > value { (2.0 * value).min(end) } else { (0.5 * value).max(end) };
        round(next)
    };
    let (mild, harsh, asked) = (round(mild), round(harsh), round(parameter.value));
    let holds_as_asked = holds(asked)?;
    let end = if holds_as_asked { harsh } else { mild };
    let (mut last, mut next) = (asked, asked);
    loop {
        if next == end {
            return Ok(Limit { holds: holds_as_asked.then_some(end), whole_range: holds_as_asked });
        }
        next = further(last, end);
        if holds(next)? != holds_as_asked {
            break;
        }
        last = next;
    }
    let (mut good, mut bad) = if holds_as_asked { (last, next) } else { (next, last) };
    while (bad - good).abs() > SHARE * good.abs() && !(parameter.whole && (bad - good).abs() <= 1.0) {
        let middle = round((good * bad).sqrt());
        if holds(middle)? { good = middle } else { bad = middle }
    }
    Ok(Limit { holds: Some(good), whole_range: false })
}
