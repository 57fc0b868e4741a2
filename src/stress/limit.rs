//! The number at which a case breaks.

use super::case::{Case, Worse};
use super::run::run;
use crate::settings::Settings;

/// A limit is known to this share of itself.
const SHARE: f64 = 0.05;

/// Up to where a case holds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limit {
    /// The last number seen to hold; `None` where not even the mildest did.
    pub holds: Option<f64>,
    /// The harshest that was tried held too.
    pub whole_range: bool,
}

/// Looks for the number up to which a case holds: doubled (or halved) from the mildest until it breaks, then halved between.
///
/// What breaks once and holds again further on is not seen: the first breach counts.
///
/// # Errors
/// A scene that cannot be run.
pub fn limit(case: &Case, settings: Settings, secs: f64) -> anyhow::Result<Limit> {
    let parameter = &case.parameter;
    let [least, most] = parameter.range;
    let (mild, harsh) = if parameter.worse == Worse::Larger { (least, most) } else { (most, least) };
    let round = |value: f64| if parameter.whole { value.round() } else { value };
    let holds = |value: f64| Ok::<_, anyhow::Error>(run(case, value, settings, secs)?.pass);
    if !holds(round(mild))? {
        return Ok(Limit { holds: None, whole_range: false });
    }
    anyhow::ensure!(least > 0.0, "{}: what is doubled must not begin at 0", case.name);
    let (mut good, mut bad) = (round(mild), None);
    while bad.is_none() {
        let next =
            if parameter.worse == Worse::Larger { (2.0 * good).min(harsh) } else { (0.5 * good).max(harsh) };
        let next = round(next);
        if !holds(next)? {
            bad = Some(next);
        } else if next == harsh {
            return Ok(Limit { holds: Some(next), whole_range: true });
        } else {
            good = next;
        }
    }
    let Some(mut bad) = bad else { return Ok(Limit { holds: Some(good), whole_range: true }) };
    while (bad - good).abs() > SHARE * good.abs() && !(parameter.whole && (bad - good).abs() <= 1.0) {
        let middle = round((good * bad).sqrt());
        if holds(middle)? { good = middle } else { bad = middle }
    }
    Ok(Limit { holds: Some(good), whole_range: false })
}
