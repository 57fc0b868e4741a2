//! The result table: our time beside the thesis engine's, and the overlap it costs.

use serde::Serialize;

use lamina2d::settings::{Settings, Stepping};

use super::experiments::matrix;
use super::{Data, page};
use crate::present::table::{Record, or_dash, times};

/// One line of the result table.
#[derive(Clone, Debug, Serialize)]
pub struct Headline {
    /// The shape mix.
    pub mix: String,
    /// Dynamic bodies.
    pub bodies: usize,
    /// Our substeps per step.
    pub substeps: u32,
    /// Our median, ms per step.
    pub ms: f64,
    /// The faithful baseline's median over ours.
    pub times_thesis: Option<f64>,
    /// The tidy baseline's median over ours.
    pub times_tidy: Option<f64>,
    /// Our mean overlap, metres.
    pub mean_penetration: f64,
    /// The faithful baseline's mean overlap, metres.
    pub thesis_mean_penetration: Option<f64>,
    /// Our contacts.
    pub contacts: usize,
}

impl Record for Headline {
    const NAME: &'static str = "results";
    const TITLE: &'static str = "Against the thesis engine";
    const COMMAND: &'static str = "lamina report --only matrix";
    const NOTE: &'static str = "Settled, one thread, 8 lanes, default settings with 4 and with 2 substeps, beside the \
         baselines with their Euler and 1 substep; medians of alternating windows in one run. Speed counts only \
         beside the overlap it costs: the last two columns.";
    const HEADER: &'static [&'static str] = &[
        "mix",
        "bodies",
        "substeps",
        "ms per step",
        "vs thesis",
        "vs tidy",
        "contacts",
        "mean overlap mm",
        "thesis overlap mm",
    ];

    fn cells(&self) -> Vec<String> {
        vec![
            self.mix.clone(),
            self.bodies.to_string(),
            self.substeps.to_string(),
            format!("{:.4}", self.ms),
            times(self.times_thesis),
            times(self.times_tidy),
            self.contacts.to_string(),
            format!("{:.1}", self.mean_penetration * 1e3),
            or_dash(self.thesis_mean_penetration.map(|m| format!("{:.1}", m * 1e3))),
        ]
    }
}

/// How many times faster than the baseline with its Euler each mix runs, at 8 lanes.
pub(super) fn headlines(data: &Data) -> Vec<Headline> {
    let ours = data.matrix.iter().filter(|r| {
        r.engine == "lamina2d" && r.integrator == matrix::HEADLINE_INTEGRATOR.name() && r.lanes == 8
    });
    ours.map(|row| {
        let base = |engine| {
            let wanted = |r: &&matrix::Row| {
                r.engine == engine
                    && r.mix == row.mix
                    && r.bodies == row.bodies
                    && r.integrator == "semi_implicit_euler"
            };
            data.matrix.iter().find(wanted)
        };
        let against = |engine| base(engine).map(|r| r.ms_per_step.median / row.ms_per_step.median);
        Headline {
            mix: row.mix.clone(),
            bodies: row.bodies,
            substeps: row.substeps,
            ms: row.ms_per_step.median,
            times_thesis: against("thesis"),
            times_tidy: against("tidy"),
            mean_penetration: row.mean_penetration,
            thesis_mean_penetration: base("thesis").map(|r| r.mean_penetration),
            contacts: row.contacts,
        }
    })
    .collect()
}

/// What a report found, in at most five lines, all of its own run.
pub(super) fn five_lines(data: &Data) -> Vec<String> {
    let beside = |bodies| page::beside_thesis(data, bodies, Settings::default().substeps);
    [beside(150), beside(1000), lanes(data), same_bits(data), flight(data)].into_iter().flatten().collect()
}

/// What lanes are worth in a whole step.
fn lanes(data: &Data) -> Option<String> {
    let of = |lanes: usize| {
        let row = data.matrix.iter().find(|r| {
            (r.engine.as_str(), r.mix.as_str(), r.bodies, r.lanes) == ("lamina2d", "polygons", 150, lanes)
                && r.integrator == matrix::HEADLINE_INTEGRATOR.name()
                && r.substeps == Settings::default().substeps
        })?;
        Some((row.ms_per_step.median, &row.hash))
    };
    let ((one, one_hash), (eight, eight_hash)) = (of(1)?, of(8)?);
    let bits = if one_hash == eight_hash { "the same bits" } else { "OTHER BITS" };
    Some(format!(
        "A step of 150 polygons takes {:.1} µs at 8 lanes, {:.1} times as long at one, with {bits}.",
        eight * 1e3,
        one / eight
    ))
}

/// Do two runs agree?
fn same_bits(data: &Data) -> Option<String> {
    let ours = || data.determinism.iter().filter(|r| r.engine == "lamina2d" && r.stepping == Stepping::Fixed);
    let same = ours().filter(|row| row.identical).count();
    (ours().count() > 0).then(|| {
        format!("Run twice with a fixed step, {same} of {} runs end in the same bits.", ours().count())
    })
}

/// What bodies cost that touch nothing.
fn flight(data: &Data) -> Option<String> {
    let cheapest = data.flight.iter().min_by(|a, b| a.ns_per_body.total_cmp(&b.ns_per_body))?;
    Some(format!(
        "In free flight {} bodies take {:.2} ns each and step, {:.0} % of the speed of a copy of as many bytes.",
        cheapest.bodies,
        cheapest.ns_per_body,
        cheapest.share * 100.0
    ))
}
