//! One run of a contact case, as its experiment sees it.

use lamina2d::scene::Scene;
use lamina2d::settings::Settings;
use lamina2d::simulation::{BodyState, Simulation, simulate};

use crate::cases::{Exact, exact};

/// What a contact case asks: the error of a run at these settings, in the case's unit.
///
/// A run that does not stay finite ends with the [`lamina2d::world::StepError`] it met.
pub type Experiment = fn(&Trial<'_>) -> anyhow::Result<f64>;

/// A scene, how it is stepped, and for how long.
#[derive(Clone, Copy, Debug)]
pub struct Trial<'a> {
    /// The case's.
    pub scene: &'a Scene,
    /// With the step in them.
    pub settings: Settings,
    /// Seconds.
    pub secs: f64,
}

impl Trial<'_> {
    /// The case's own scene as it begins.
    pub(super) fn begin(&self) -> anyhow::Result<Run> {
        self.begin_with(self.scene)
    }

    /// Another scene as it begins.
    pub(super) fn begin_with(&self, scene: &Scene) -> anyhow::Result<Run> {
        let world = simulate(scene, self.settings)?;
        Ok(Run { world, h_secs: self.settings.dt_secs, steps: steps_in(self.secs, self.settings), taken: 0 })
    }

    /// The case's scene at its end.
    pub(super) fn finish(&self) -> anyhow::Result<Run> {
        let mut run = self.begin()?;
        while run.step()? {}
        Ok(run)
    }

    /// Where its bodies must be at a time.
    pub(super) fn exact(&self, secs: f64) -> anyhow::Result<Vec<Exact>> {
        exact(self.scene, secs).ok_or_else(|| anyhow::anyhow!("'{}' has no closed form", self.scene.name))
    }

    /// Seconds of a substep.
    pub(super) fn substep_secs(&self) -> f64 {
        self.settings.dt_secs / f64::from(self.settings.substeps)
    }
}

/// Whole steps in so many seconds, at least one.
fn steps_in(secs: f64, settings: Settings) -> u32 {
    ((secs / settings.dt_secs).round() as u32).max(1)
}

/// A run on its way.
pub(super) struct Run {
    pub(super) world: Box<dyn Simulation>,
    h_secs: f64,
    steps: u32,
    taken: u32,
}

impl Run {
    /// Seconds of a substep of the hardest island, which may have more than were asked for.
    pub(super) fn substep_secs(&self) -> f64 {
        self.h_secs / f64::from(self.world.counts().substeps[1])
    }

    /// One step; false where the end was reached before.
    pub(super) fn step(&mut self) -> anyhow::Result<bool> {
        if self.taken == self.steps {
            return Ok(false);
        }
        self.world.step(self.h_secs)?;
        self.taken += 1;
        Ok(true)
    }

    /// So far.
    pub(super) fn secs(&self) -> f64 {
        f64::from(self.taken) * self.h_secs
    }

    /// The state of a body.
    pub(super) fn body(&self, number: usize) -> BodyState {
        self.world.states()[number]
    }

    /// The state of the last body.
    pub(super) fn last(&self) -> BodyState {
        self.body(self.world.bodies() - 1)
    }
}

/// The largest of some errors; NaN is larger than any.
pub(super) fn worst(errors: impl IntoIterator<Item = f64>) -> f64 {
    let larger = |a: f64, b: f64| if a.is_nan() || b.is_nan() { f64::NAN } else { a.max(b) };
    errors.into_iter().fold(0.0, larger)
}

/// |found/wanted − 1|.
pub(super) fn relative(found: f64, wanted: f64) -> f64 {
    (found / wanted - 1.0).abs()
}

/// The edge between where something holds, at `low` or towards it, and where it does not: halved until it is known to
/// `tolerance`.
pub(super) fn edge(
    [mut low, mut high]: [f64; 2],
    tolerance: f64,
    holds: impl Fn(f64) -> anyhow::Result<bool>,
) -> anyhow::Result<f64> {
    while high - low > tolerance {
        let middle = f64::midpoint(low, high);
        if holds(middle)? { low = middle } else { high = middle }
    }
    Ok(f64::midpoint(low, high))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_edge_is_found_from_either_side() {
        for at in [0.2001, 0.5, 0.8999] {
            let found = edge([0.2, 0.9], 1e-6, |x| Ok(x < at)).expect("nothing fails");
            assert!((found - at).abs() <= 1e-6, "{found} for {at}");
        }
        assert!(worst([0.1, f64::NAN, 0.3]).is_nan());
    }
}
