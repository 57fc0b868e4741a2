//! Each skip on and off, on a scene it is meant for.

use lamina2d::settings::{Integrator, Settings, Skip, Skips};

use super::{Case, Touch};
use crate::common::SETTLE_STEPS;

/// A skip, its scene, bodies, steps to the state, and whether something touches there.
const SCENES: [(Skip, &str, u64, usize, Touch); Skip::ALL.len()] = [
    (Skip::ClosedForm, "free_flight/150", 150, 0, Touch::Never),
    (Skip::FreeFlight, "free_flight/150", 150, 0, Touch::Never),
    (Skip::Rotation, "free_flight/150", 150, 0, Touch::Never),
    // Pairs that touch from step 90 on for two.
    (Skip::Friction, "head_on/75", 150, 70, Touch::Always),
    (Skip::Restitution, "pyramid/10", 55, 300, Touch::Always),
    (Skip::PairList, "polygons/150", 150, SETTLE_STEPS, Touch::Always),
    (Skip::ManifoldReuse, "polygons/150", 150, SETTLE_STEPS, Touch::Always),
];

/// On is with all skips that change no bit, off without the one.
pub(super) fn cases() -> Vec<Case> {
    let mut cases = Vec::new();
    for (skip, scene, bodies, settle_steps, touch) in SCENES {
        let on = Skips::EXACT.with(skip);
        let name = format!("skips/{skip}/{scene}");
        for (state, skips) in [("on", on), ("off", on.without(skip))] {
            // Only one of them is allowed to change bits.
            let alike = if skip == Skip::ManifoldReuse { format!("{name}/{state}") } else { name.clone() };
            let integrator = match skip {
                Skip::ClosedForm => Integrator::Rk4,
                _ => Settings::default().integrator,
            };
            let settings = Settings { integrator, skips, ..Settings::default() };
            let case = Case::new(&format!("{name}/{state}"), scene, bodies, settle_steps);
            cases.push(Case { alike, touch, ..case.with(settings) });
        }
    }
    for (state, skips) in [("on", Skips::EXACT), ("off", Skips::NONE)] {
        let alike = "skips/exact/polygons/150".to_owned();
        let settings = Settings { skips, ..Settings::default() };
        let case = Case::new(&format!("{alike}/{state}"), "polygons/150", 150, SETTLE_STEPS);
        cases.push(Case { alike, ..case.with(settings) });
    }
    cases
}
