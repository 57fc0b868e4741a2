//! The thesis's questions, answered from the rows: do shapes change accuracy, does complexity pay, what is to be used when?

use std::collections::BTreeMap;

use serde::Serialize;

use lamina2d::scene::mixes::Mix;
use lamina2d::settings::{Integrator, Settings};

use super::best::{Fastest, LEVELS, duration, fastest};
use super::case::Method;
use super::contact::mixes::growth;
use super::sweep::{Results, Row};
use crate::present::Record;

/// Courses are compared to this, metres.
const TOLERANCE_M: f64 = 1e-2;
/// Overlaps asked for, in diameters.
const OVERLAPS: [f64; 2] = [1e-2, 1e-3];

/// What a shape mix shows.
#[derive(Clone, Debug, Serialize)]
pub struct MixLine {
    /// The mix.
    pub mix: &'static str,
    /// How fast twins part, 1/s; null where they do not.
    pub growth_per_sec: Option<f64>,
    /// Until then courses 10 nm apart may be compared to a centimetre, seconds.
    pub horizon_secs: Option<f64>,
    /// At the default settings: 99th percentile of overlaps, in diameters.
    pub penetration: Option<f64>,
    /// Momentum balance, relative.
    pub momentum: Option<f64>,
    /// Signorini and friction residual, in mgh.
    pub laws: Option<f64>,
    /// Standard errors of the piles' height from that of finely stepped ones.
    pub height: Option<f64>,
    /// ns.
    pub ns_per_step: Option<f64>,
    /// The default solver's overlaps over all integrators, least and most.
    pub by_integrator: Option<[f64; 2]>,
    /// Which they are of.
    pub least_and_most: Option<[&'static str; 2]>,
    /// Their times per step, ns.
    pub ns_by_integrator: Option<[f64; 2]>,
    /// The cheapest settings at an overlap of 1e-2 and 1e-3 diameters.
    pub cheapest: [Option<String>; OVERLAPS.len()],
}

/// A line per mix whose cases are among the results.
///
/// # Errors
/// A scene that cannot be run.
pub fn mix_lines(all: &[Results]) -> anyhow::Result<Vec<MixLine>> {
    let of = |mix: Mix| -> anyhow::Result<Option<MixLine>> {
        let Some(overlaps) = find(all, mix, "penetration") else { return Ok(None) };
        let error = |kind| find(all, mix, kind).and_then(|results| usual(results, default_method())?.error);
        let growth = growth(mix)?;
        let by_integrator = Integrator::ALL
            .iter()
            .filter_map(|integrator| usual(overlaps, Method { integrator: *integrator, ..default_method() }));
        let by_integrator: Vec<&Row> = by_integrator.collect();
        let mut by_error: Vec<(f64, &str)> =
            by_integrator.iter().filter_map(|row| Some((row.error?, row.integrator))).collect();
        by_error.sort_by(|a, b| a.0.total_cmp(&b.0));
        let least_and_most = by_error.first().zip(by_error.last()).map(|(least, most)| [least.1, most.1]);
        let cheapest = OVERLAPS.map(|level| {
            let run = fastest(&overlaps.rows, level)?;
            let steps = 1.0 / run.h;
            Some(format!(
                "{} {}×{}, 1/{steps:.0} s: {}",
                run.method,
                run.precision,
                run.lanes,
                duration(run.ns_total)
            ))
        });
        Ok(Some(MixLine {
            mix: mix.name(),
            growth_per_sec: growth.map(|growth| growth.rate),
            horizon_secs: growth
                .map(|growth| growth.horizon_secs(TOLERANCE_M))
                .filter(|secs| secs.is_finite()),
            penetration: error("penetration"),
            momentum: error("momentum"),
            laws: error("laws"),
            height: error("height"),
            ns_per_step: usual(overlaps, default_method()).and_then(|row| row.ns_per_step),
            by_integrator: span(by_integrator.iter().filter_map(|row| row.error)),
            least_and_most,
            ns_by_integrator: span(by_integrator.iter().filter_map(|row| row.ns_per_step)),
            cheapest,
        }))
    };
    let lines: Vec<_> = Mix::ALL.into_iter().map(of).collect::<anyhow::Result<_>>()?;
    Ok(lines.into_iter().flatten().collect())
}

fn default_method() -> Method {
    let Settings { integrator, solver, substeps, stiffness, .. } = Settings::default();
    Method { integrator, solver: Some(solver), substeps, stiffness }
}

fn find<'a>(all: &'a [Results], mix: Mix, kind: &str) -> Option<&'a Results> {
    all.iter().find(|results| results.case.name == format!("m_{}_{kind}", mix.name()))
}

/// The row of a method at the default's step, precision and lanes.
fn usual(results: &Results, method: Method) -> Option<&Row> {
    let Settings { dt_secs, precision, lanes, .. } = Settings::default();
    let same = |row: &&Row| {
        row.method == method.to_string()
            && (row.h / dt_secs - 1.0).abs() < 1e-9
            && row.precision == precision.name()
            && row.lanes == lanes
    };
    results.rows.iter().find(same)
}

fn span(values: impl Iterator<Item = f64>) -> Option<[f64; 2]> {
    values.fold(None, |span, value| {
        let [least, most] = span.unwrap_or([value; 2]);
        Some([value.min(least), value.max(most)])
    })
}

/// What the rows answer, in sentences; those of what was not measured are left out.
pub fn answers(lines: &[MixLine], fastest: &[Fastest]) -> Vec<String> {
    let shapes = shapes(lines);
    let complexity = complexity(lines);
    let mut all: Vec<String> = shapes.into_iter().chain(complexity).collect();
    for (k, level) in OVERLAPS.iter().enumerate() {
        let named = |line: &MixLine| line.cheapest[k].as_ref().map(|run| format!("{} with {run}", line.mix));
        let cheapest: Vec<String> = lines.iter().filter_map(named).collect();
        if !cheapest.is_empty() {
            all.push(format!("Cheapest at an overlap of {level:e} diameters: {}.", cheapest.join("; ")));
        }
    }
    all.extend(smooth(fastest));
    all
}

/// Do shapes change accuracy?
fn shapes(lines: &[MixLine]) -> Option<String> {
    if lines.len() < 2 {
        return None;
    }
    let by = |of: &dyn Fn(&MixLine) -> Option<f64>| {
        let mut values: Vec<(f64, &str)> =
            lines.iter().filter_map(|line| Some((of(line)?, line.mix))).collect();
        values.sort_by(|a, b| a.0.total_cmp(&b.0));
        Some((*values.first()?, *values.last()?))
    };
    let (least, most) = by(&|line| line.penetration)?;
    let (fast, slow) = by(&|line| line.ns_per_step)?;
    let (calm, wild) = by(&|line| line.growth_per_sec)?;
    Some(format!(
        "Shapes change accuracy: at the same settings {} overlap by {:.1e} diameters (99th percentile), {} by {:.1e}, \
         {:.1} times as much; a step takes {} to {}, {} times as long at most ({}). Twins part e-fold {:.1} times a second \
         ({}) to {:.1} ({}).",
        least.1,
        least.0,
        most.1,
        most.0,
        most.0 / least.0,
        duration(fast.0),
        duration(slow.0),
        format_args!("{:.1}", slow.0 / fast.0),
        slow.1,
        calm.0,
        calm.1,
        wild.0,
        wild.1,
    ))
}

/// Does complexity pay?
fn complexity(lines: &[MixLine]) -> Option<String> {
    let ratio = |span: [f64; 2]| span[1] / span[0];
    let [_, error] = span(lines.iter().filter_map(|line| line.by_integrator.map(ratio)))?;
    let [_, time] = span(lines.iter().filter_map(|line| line.ns_by_integrator.map(ratio)))?;
    let named: Vec<String> = lines
        .iter()
        .filter_map(|line| {
            let [least, most] = line.least_and_most.as_ref()?;
            Some(format!("{} {least} to {most}", line.mix))
        })
        .collect();
    let verdict = if error < 1.5 { "does not pay in a pile" } else { "changes a pile, and does not pay" };
    Some(format!(
        "A costlier integrator {verdict}: over all six, with the default solver, overlaps differ by up to {error:.2} times \
         (least and most: {}) and times by up to {time:.2} times.",
        named.join(", ")
    ))
}

/// Which integrator where nothing touches, in a sentence per error?
fn smooth(fastest: &[Fastest]) -> Vec<String> {
    let of = |(k, level): (usize, &f64)| {
        let mut wins: BTreeMap<&str, usize> = BTreeMap::new();
        let alone = |method: &str| Integrator::ALL.iter().any(|integrator| integrator.name() == method);
        for run in fastest.iter().filter_map(|line| line.at[k].as_ref()).filter(|run| alone(&run.method)) {
            *wins.entry(&run.method).or_default() += 1;
        }
        let cases: usize = wins.values().sum();
        let mut wins: Vec<_> = wins.into_iter().collect();
        wins.sort_by_key(|(_, count)| std::cmp::Reverse(*count));
        let wins: Vec<String> = wins.iter().map(|(name, count)| format!("{name} {count}")).collect();
        (cases > 0)
            .then(|| format!("Smooth motion, fastest at {level:e} on {cases} cases: {}.", wins.join(", ")))
    };
    LEVELS.iter().enumerate().filter_map(of).collect()
}

impl Record for MixLine {
    const NAME: &'static str = "mixes";
    const TITLE: &'static str = "Shape mixes: what each costs in time and error";
    const COMMAND: &'static str = "lamina accuracy --quick";
    const NOTE: &'static str = "150 bodies that fall and come to rest over 6 s. Default settings but for the last four columns: the default solver's \
                                overlaps and times over all integrators, and the cheapest settings for an overlap. Courses that begin 10 nm apart \
                                can be compared to a centimetre until the horizon. Height: standard errors between 64 piles and 64 \
                                finely stepped ones.";
    const HEADER: &'static [&'static str] = &[
        "mix",
        "growth 1/s",
        "horizon s",
        "overlap diameters",
        "momentum",
        "laws mgh",
        "height s.e.",
        "ns per step",
        "overlap by integrator",
        "ns by integrator",
        "cheapest at 1e-2",
        "at 1e-3",
    ];

    fn cells(&self) -> Vec<String> {
        let or_dash = |text: Option<String>| text.unwrap_or_else(|| "–".to_owned());
        let number = |value: Option<f64>| or_dash(value.map(|value| format!("{value:.1e}")));
        let plain = |value: Option<f64>| or_dash(value.map(|value| format!("{value:.1}")));
        let spans = |span: Option<[f64; 2]>| or_dash(span.map(|[a, b]| format!("{a:.1e} to {b:.1e}")));
        let whole = self.ns_by_integrator.map(|[a, b]| format!("{a:.0} to {b:.0}"));
        vec![
            self.mix.to_owned(),
            plain(self.growth_per_sec),
            plain(self.horizon_secs),
            number(self.penetration),
            number(self.momentum),
            number(self.laws),
            plain(self.height),
            or_dash(self.ns_per_step.map(|ns| format!("{ns:.0}"))),
            spans(self.by_integrator),
            or_dash(whole),
            or_dash(self.cheapest[0].clone()),
            or_dash(self.cheapest[1].clone()),
        ]
    }
}
