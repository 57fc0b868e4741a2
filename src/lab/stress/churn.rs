//! T24's tumbler: bodies come and go while it turns, for as long as one likes.

use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg32;

use lamina2d::body::BodyId;
use lamina2d::scene::{BodyKind, BodySpec, Scene, ShapeSpec};
use lamina2d::settings::Settings;
use lamina2d::simulation::{Simulation, simulate};

use super::case::Trial;

/// Steps from one insertion or removal to the next.
const EVERY: u64 = 5;
/// Distance from the centre beyond which a body has got out: the tumbler of 150 has corners at 4 m.
const OUT_M: f64 = 10.0;

/// What a churned tumbler showed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Churned {
    /// Ids of living bodies that were refused, of dead ones that were not, or that named another body.
    pub wrong_ids: u64,
    /// Bodies that were outside when they were taken out, or at the end.
    pub escaped: u64,
    /// Insertions and removals.
    pub changes: u64,
    /// Slots at the end.
    pub most_bodies: usize,
}

/// A tumbler whose bodies a seeded die inserts and removes.
#[derive(Debug)]
pub struct Churn {
    random: Pcg32,
    ids: Vec<BodyId>,
    gone: Vec<BodyId>,
    /// What was seen so far.
    pub seen: Churned,
}

impl Churn {
    /// Of the bodies a world has.
    pub fn new(scene: &Scene, world: &dyn Simulation, seed: u64) -> Self {
        let movable = scene.bodies.iter().enumerate().filter(|(_, body)| body.kind == BodyKind::Dynamic);
        let ids = movable.filter_map(|(k, _)| world.body(k + 1)).map(|body| body.id).collect();
        Self { random: Pcg32::seed_from_u64(seed), ids, gone: Vec::new(), seen: Churned::default() }
    }

    /// Between steps: inserts or removes a body now and then.
    ///
    /// # Errors
    /// A body that is refused.
    pub fn stir(&mut self, world: &mut dyn Simulation) -> anyhow::Result<()> {
        if !world.steps().is_multiple_of(EVERY) {
            return Ok(());
        }
        self.seen.changes += 1;
        let inserts = self.ids.len() < 100 || (self.ids.len() < 200 && self.random.random_bool(0.5));
        if inserts {
            let at = [(); 2].map(|()| self.random.random_range(-0.5..0.5));
            let shape = match self.random.random_range(0..3) {
                0 => ShapeSpec::Circle(self.random.random_range(0.05..0.15)),
                1 => ShapeSpec::Box([(); 2].map(|()| self.random.random_range(0.05..0.15))),
                _ => ShapeSpec::Polygon(vec![[0.15, 0.0], [-0.1, 0.12], [-0.1, -0.12]]),
            };
            self.ids.push(world.insert(&BodySpec::new(shape, at).surface(0.2, 0.6))?);
        } else {
            let id = self.ids.swap_remove(self.random.random_range(0..self.ids.len()));
            match world.body(id.slot()).filter(|body| body.id == id) {
                Some(body) => self.seen.escaped += u64::from(is_out(body.state.position)),
                None => self.seen.wrong_ids += 1,
            }
            self.seen.wrong_ids += u64::from(world.remove(id).is_err());
            self.gone.push(id);
        }
        if self.gone.len() > 64 {
            // Slots are filled again, ids never.
            let dead = self.gone.drain(..).filter(|&id| world.remove(id).is_ok()).count();
            self.seen.wrong_ids += dead as u64;
        }
        self.seen.most_bodies = self.seen.most_bodies.max(world.bodies());
        Ok(())
    }

    /// At the end: every id that should live does.
    pub fn finish(&mut self, world: &dyn Simulation) {
        for id in &self.ids {
            match world.body(id.slot()).filter(|body| body.id == *id) {
                Some(body) => self.seen.escaped += u64::from(is_out(body.state.position)),
                None => self.seen.wrong_ids += 1,
            }
        }
    }
}

fn is_out(position: [f64; 2]) -> bool {
    let distance = position[0].hypot(position[1]);
    distance.is_nan() || distance > OUT_M
}

/// Wrong ids, escaped bodies, and the megabytes that the process has grown by since a tenth of the time.
pub(super) fn churned(trial: &Trial<'_>) -> anyhow::Result<f64> {
    let scene = (trial.case.build)(trial.value);
    let mut world = simulate(&scene, Settings { dt_secs: scene.dt_secs, ..trial.settings })?;
    let mut churn = Churn::new(&scene, world.as_ref(), 1);
    let steps = (trial.secs / scene.dt_secs).round() as u64;
    let mut at_first = None;
    for step in 0..steps {
        if world.step(scene.dt_secs).is_err() {
            return Ok(f64::NAN);
        }
        churn.stir(world.as_mut())?;
        if step == steps / 10 {
            at_first = resident_mb();
        }
    }
    churn.finish(world.as_ref());
    let grown = resident_mb().zip(at_first).map_or(0.0, |(end, first)| (end - first).max(0.0));
    Ok((churn.seen.wrong_ids + churn.seen.escaped) as f64 + grown)
}

/// What the process holds in memory, MB; `None` where the system does not say so in a file.
fn resident_mb() -> Option<f64> {
    let text = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = text.lines().find_map(|line| line.strip_prefix("VmRSS:"))?;
    let kb: f64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kb / 1024.0)
}
