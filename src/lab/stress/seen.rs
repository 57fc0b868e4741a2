//! What a run was seen to do.

use serde::{Deserialize, Deserializer, Serialize};

use lamina2d::measure::Penetration;
use lamina2d::scene::{BodyKind, Scene};
use lamina2d::simulation::{BodyState, Simulation};

/// Looks at overlaps in the second half.
const LOOKS: u32 = 16;
/// Slower bodies rest, m/s.
const AT_REST: f64 = 0.01;
/// Beyond what encloses them bodies have escaped, metres.
const OUTSIDE_M: f64 = 1.0;

/// What the table has of each run: see [`super`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Metrics {
    /// m.
    #[serde(deserialize_with = "number")]
    pub pen: f64,
    /// m/s.
    #[serde(deserialize_with = "number")]
    pub jit: f64,
    /// m.
    #[serde(deserialize_with = "number")]
    pub drift: f64,
    /// J.
    #[serde(deserialize_with = "number")]
    pub energy_gain: f64,
    /// s.
    pub settle_secs: Option<f64>,
    /// 1 where the run broke off.
    pub non_finite: usize,
    /// Bodies.
    pub escaped: usize,
}

/// A number that JSON has as null where it is none.
fn number<'de, D: Deserializer<'de>>(from: D) -> Result<f64, D::Error> {
    Ok(Option::deserialize(from)?.unwrap_or(f64::NAN))
}

/// A run, from its beginning to its end.
#[derive(Clone, Debug)]
pub struct Seen {
    /// What was run.
    pub scene: Scene,
    /// The states at the beginning, at half the time, and at the end; of bodies that were removed none.
    pub start: Vec<BodyState>,
    /// At half the time.
    pub half: Vec<BodyState>,
    /// At the end.
    pub end: Vec<BodyState>,
    /// The metrics.
    pub metrics: Metrics,
    /// The fastest any body ever was, m/s.
    pub fastest: f64,
    /// The highest any body ever was over where it began, metres.
    pub highest: f64,
    /// The most that all joints together were apart, at any look in the second half, metres.
    pub stretch: f64,
    /// Kinetic and potential energy, momentum and angular momentum at the start and at the end.
    pub sums: [lamina2d::measure::Invariants; 2],
    /// Joints that were solved directly in the last step.
    pub direct_joints: usize,
    /// The most substeps an island had in the last step.
    pub most_substeps: u32,
    /// Why it broke off.
    pub failed: Option<String>,
    kinds: Vec<BodyKind>,
}

fn speed(state: &BodyState) -> f64 {
    state.velocity[0].hypot(state.velocity[1])
}

fn apart(a: &BodyState, b: &BodyState) -> f64 {
    (a.position[0] - b.position[0]).hypot(a.position[1] - b.position[1])
}

/// Watches a run.
#[derive(Debug)]
pub(super) struct Watch {
    seen: Seen,
    secs: f64,
    energy: f64,
    squares: f64,
    samples: f64,
    slow_since: Option<f64>,
    next_look: u32,
    next_energy_secs: f64,
}

impl Watch {
    pub(super) fn begin(scene: &Scene, world: &dyn Simulation, secs: f64) -> Self {
        let start = world.states();
        let sums = world.invariants();
        let seen = Seen {
            scene: scene.clone(),
            half: start.clone(),
            end: start.clone(),
            start,
            metrics: Metrics::default(),
            fastest: 0.0,
            highest: 0.0,
            stretch: 0.0,
            sums: [sums; 2],
            direct_joints: 0,
            most_substeps: 0,
            failed: None,
            kinds: scene.bodies.iter().map(|body| body.kind).collect(),
        };
        Self {
            seen,
            secs,
            energy: sums.kinetic_energy + sums.potential_energy,
            squares: 0.0,
            samples: 0.0,
            slow_since: None,
            next_look: 0,
            next_energy_secs: 0.0,
        }
    }

    /// After a step that ended at a time.
    pub(super) fn look(&mut self, world: &dyn Simulation, secs: f64) {
        let states = world.states();
        let Self { seen, .. } = self;
        let mut top = 0.0f64;
        for ((state, start), kind) in states.iter().zip(&seen.start).zip(&seen.kinds) {
            if *kind != BodyKind::Dynamic {
                continue;
            }
            let speed = speed(state);
            top = top.max(speed);
            seen.highest = seen.highest.max(state.position[1] - start.position[1]);
            if secs > self.secs - 1.0 {
                self.squares += speed * speed;
                self.samples += 1.0;
            }
        }
        seen.fastest = seen.fastest.max(top);
        self.slow_since = if top < AT_REST { self.slow_since.or(Some(secs)) } else { None };
        if secs <= 0.5 * self.secs {
            seen.half.clone_from(&states);
        } else if secs >= self.secs * (0.5 + 0.5 * f64::from(self.next_look + 1) / f64::from(LOOKS)) - 1e-9 {
            self.next_look += 1;
            let Penetration { max, .. } = world.penetration();
            seen.metrics.pen = seen.metrics.pen.max(max);
            let gaps = world.joint_anchors().into_iter().map(|[a, b]| (a[0] - b[0]).hypot(a[1] - b[1]));
            seen.stretch = seen.stretch.max(gaps.sum());
        }
        if secs >= self.next_energy_secs {
            self.next_energy_secs = secs + 0.1;
            let sums = world.invariants();
            let gain = sums.kinetic_energy + sums.potential_energy - self.energy;
            seen.metrics.energy_gain = seen.metrics.energy_gain.max(gain);
        }
        seen.end = states;
    }

    pub(super) fn finish(mut self, world: &dyn Simulation, failed: Option<String>) -> Seen {
        let seen = &mut self.seen;
        seen.sums[1] = world.invariants();
        seen.direct_joints = world.counts().direct_joints;
        seen.most_substeps = world.counts().substeps[1];
        seen.metrics.jit = if self.samples > 0.0 { (self.squares / self.samples).sqrt() } else { 0.0 };
        seen.metrics.drift = farthest(&seen.half, &seen.end, &seen.kinds);
        seen.metrics.settle_secs = self.slow_since;
        seen.metrics.non_finite = usize::from(failed.is_some());
        seen.failed = failed;
        seen.metrics.escaped = seen.outside();
        self.seen
    }
}

/// The farthest any dynamic body is in one state from itself in another, metres.
fn farthest(from: &[BodyState], to: &[BodyState], kinds: &[BodyKind]) -> f64 {
    let pairs = from.iter().zip(to).zip(kinds).filter(|(_, kind)| **kind == BodyKind::Dynamic);
    pairs.map(|((a, b), _)| apart(a, b)).fold(0.0, f64::max)
}

impl Seen {
    /// The dynamic bodies at the start and at the end.
    pub fn moved(&self) -> impl Iterator<Item = (&BodyState, &BodyState)> {
        let pairs = self.start.iter().zip(&self.end).zip(&self.kinds);
        pairs.filter(|(_, kind)| **kind == BodyKind::Dynamic).map(|(pair, _)| pair)
    }

    /// The farthest any body is at the end from where it began, metres.
    pub fn farthest(&self) -> f64 {
        farthest(&self.start, &self.end, &self.kinds)
    }

    /// The most any body has sunk, metres.
    pub fn sunk(&self) -> f64 {
        self.moved().map(|(start, end)| start.position[1] - end.position[1]).fold(0.0, f64::max)
    }

    /// The largest overlap over a length, metres.
    pub fn pen_over(&self, length: f64) -> f64 {
        self.metrics.pen / length
    }

    /// Bodies outside of the rectangle about all bodies that do not move freely.
    fn outside(&self) -> usize {
        let held = self.start.iter().zip(&self.kinds).zip(&self.scene.bodies);
        let mut bounds = [f64::MAX, f64::MAX, f64::MIN, f64::MIN];
        for ((state, kind), body) in held {
            if *kind == BodyKind::Dynamic {
                continue;
            }
            let reach = match &body.shape {
                lamina2d::scene::ShapeSpec::Circle(radius) => [*radius; 2],
                lamina2d::scene::ShapeSpec::Box(half) => *half,
                lamina2d::scene::ShapeSpec::Polygon(_) => [0.0; 2],
            };
            for k in 0..2 {
                bounds[k] = bounds[k].min(state.position[k] - reach[k] - OUTSIDE_M);
                bounds[k + 2] = bounds[k + 2].max(state.position[k] + reach[k] + OUTSIDE_M);
            }
        }
        // Only what is enclosed on all sides can escape upwards.
        let walls = self.kinds.iter().filter(|kind| **kind != BodyKind::Dynamic).count();
        if walls < 4 {
            bounds = [f64::MIN, bounds[1], f64::MAX, f64::MAX];
        }
        let out =
            |state: &BodyState| (0..2).any(|k| !(bounds[k]..=bounds[k + 2]).contains(&state.position[k]));
        if walls == 0 { 0 } else { self.moved().filter(|(_, end)| out(end)).count() }
    }
}
