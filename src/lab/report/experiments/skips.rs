//! What each skip saves: every scene with all exact skips, with all but one, and with none; and what reusing
//! manifolds saves and changes on top.

use serde::Serialize;

use lamina2d::settings::{Integrator, Settings, Skip, Skips};
use lamina2d::simulation::simulate;

use super::Contestant;
use crate::cases::by_name;
use crate::present::table::yes_no;
use crate::report::{Record, median};

/// One skip on one scene.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// The scene.
    pub scene: &'static str,
    /// The integrator.
    pub integrator: Integrator,
    /// The skip that is off in the second run; `exact` where none is on.
    pub skip: &'static str,
    /// Median with all exact skips, and this one, ms per step.
    pub on_ms: f64,
    /// Median without, ms per step.
    pub off_ms: f64,
    /// Share of the time without that is saved; the noise of these machines is a few percent.
    pub saved: f64,
    /// Same state to the bit with and without.
    pub same_hash: bool,
    /// Bodies, contacts or pairs it spared work in the last step.
    pub spared: u64,
    /// Deepest overlap with and without, metres.
    pub max_penetration_m: [f64; 2],
    /// Kinetic energy with and without, J.
    pub kinetic_energy_j: [f64; 2],
}

impl Record for Row {
    const NAME: &'static str = "skips";
    const TITLE: &'static str = "Skips";
    const COMMAND: &'static str = "lamina report --only skips";
    const NOTE: &'static str = "All exact skips on, against all but one, and against none (exact); reused manifolds on top of all, \
               against without. Overlap and energy: on / off.";
    const HEADER: &'static [&'static str] = &[
        "scene",
        "integrator",
        "skip off",
        "on ms",
        "off ms",
        "saved",
        "same bits",
        "spared",
        "max overlap mm",
        "kinetic energy J",
    ];

    fn cells(&self) -> Vec<String> {
        vec![
            self.scene.to_owned(),
            self.integrator.to_string(),
            self.skip.to_owned(),
            format!("{:.4}", self.on_ms),
            format!("{:.4}", self.off_ms),
            format!("{:.1} %", self.saved * 100.0),
            yes_no(self.same_hash),
            self.spared.to_string(),
            self.max_penetration_m.map(|m| format!("{:.3}", m * 1e3)).join(" / "),
            self.kinetic_energy_j.map(|j| format!("{j:.1e}")).join(" / "),
        ]
    }
}

const SCENES: [(&str, Integrator, usize); 6] = [
    ("free_flight/10000", Integrator::Rk4, 30),
    ("free_flight/10000", Integrator::SemiImplicitEuler, 30),
    ("head_on/100", Integrator::SemiImplicitEuler, 30),
    ("stack/10", Integrator::SemiImplicitEuler, 300),
    ("all/150", Integrator::Rk4, 600),
    ("polygons/1000", Integrator::VelocityVerlet, 900),
];

/// Times every skip on every scene in `windows` alternating windows.
///
/// # Errors
/// A scene that cannot be run.
pub fn run(windows: usize) -> anyhow::Result<Vec<Row>> {
    let mut rows = Vec::new();
    for (name, integrator, settle) in SCENES {
        let scene = by_name(name, None, 1)?;
        let single = Skip::ALL.iter().map(|&skip| {
            let with = Skips::EXACT.with(skip);
            (skip.name(), Some(skip), with, with.without(skip))
        });
        for (label, skip, with, without) in single.chain([("exact", None, Skips::EXACT, Skips::NONE)]) {
            let build = |skips| simulate(&scene, Settings { integrator, skips, ..Settings::default() });
            let mut pair = [Contestant::Ours(build(with)?), Contestant::Ours(build(without)?)];
            let mut samples = [Vec::new(), Vec::new()];
            for contestant in &mut pair {
                contestant.steps(settle)?;
            }
            for _ in 0..windows {
                for (contestant, samples) in pair.iter_mut().zip(&mut samples) {
                    contestant.window(10, samples)?;
                }
            }
            let [on_ms, off_ms] = samples.map(|s| median(&s));
            let counted = match &pair[0] {
                Contestant::Ours(world) => world.counts().skipped,
                Contestant::Baseline(_) => Default::default(),
            };
            rows.push(Row {
                scene: name,
                integrator,
                skip: label,
                on_ms,
                off_ms,
                saved: 1.0 - on_ms / off_ms,
                same_hash: pair[0].hash() == pair[1].hash(),
                spared: skip.map_or_else(|| counted.iter().sum(), |s| counted[s as usize]),
                max_penetration_m: [0, 1].map(|k| pair[k].penetration().max),
                kinetic_energy_j: [0, 1].map(|k| match &pair[k] {
                    Contestant::Ours(world) => world.invariants().kinetic_energy,
                    Contestant::Baseline(_) => 0.0,
                }),
            });
        }
    }
    Ok(rows)
}
