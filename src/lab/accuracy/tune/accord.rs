//! Does a run come out as a converged one does: who is where, stands how, rests and touches, with which energy and momenta?
//!
//! What an error measures may be small for a wrong reason: bodies that fly apart overlap less. So a candidate is held to a
//! converged run, as far as that can be told. How far is seen from the same run by steps twice as long, and from two whose
//! bodies begin a little faster or slower: what these disagree about, no run is held to. Where motion is chaotic they part as
//! λ has it, and so does the bound; where it is not, a tenth of a body's size, or a hundredth of its way, stays the bound.

use rand::RngExt as _;
use rand::SeedableRng as _;
use rand_pcg::Pcg32;

use lamina2d::scene::{BodyKind, Scene};
use lamina2d::settings::{Integrator, Precision, Settings, Solver};
use lamina2d::simulation::{Simulation, simulate};

/// Steps per second of the converged run, each of as many substeps; others take half of that.
const RATE: f64 = 960.0;
const SUBSTEPS: u32 = 8;
/// Speeds of the perturbed runs are off by up to this share of a body's own pace, √(a·r).
const NUDGE: f64 = 2e-3;
/// A place may be off by this share of a body's size, or this share of its way.
const OF_SIZE: f64 = 0.1;
const OF_WAY: f64 = 0.01;
/// An attitude, rad.
const TURN: f64 = 0.1;
/// Sums may be off by this share of what they are made of.
const OF_SUMS: f64 = 0.05;
/// What happens may happen so much too early or too late: a step of the longest tried.
const LATE_SECS: f64 = 1.0 / 30.0;
/// What the converged runs are apart by counts so many times.
const SPREADS: f64 = 3.0;
/// A body that rests is slower than this share of its pace; one that moves is three times as fast.
const REST: f64 = 0.05;
/// Two bodies that touch are no further apart than this share of the smaller one.
const TOUCH: f64 = 0.05;

/// What a run looks like at one time.
#[derive(Clone, Debug, Default)]
struct View {
    places: Vec<[f64; 2]>,
    turns: Vec<[f64; 2]>,
    /// m/s, with what turning adds at the edge.
    speeds: Vec<f64>,
    sizes: Vec<f64>,
    /// rad/s; 0 for discs, which look the same however they are turned.
    spins: Vec<f64>,
    /// Kinetic, potential energy, J; momentum, N·s; angular momentum, N·m·s.
    sums: [f64; 5],
    /// What these are made of, without regard to signs.
    scales: [f64; 5],
    /// The least and the most of `sums` a little before and after.
    around: [[f64; 5]; 2],
    /// Pairs of bodies that touch.
    touching: Vec<[usize; 2]>,
}

/// Kinetic and potential energy, momentum, angular momentum.
fn sums(world: &dyn Simulation) -> [f64; 5] {
    let sums = world.invariants();
    let [px, py] = sums.momentum;
    [sums.kinetic_energy, sums.potential_energy, px, py, sums.angular_momentum]
}

fn view(world: &dyn Simulation, pull: f64) -> View {
    let (states, outlines) = (world.states(), world.outlines());
    let slots: Vec<_> = (1..).filter_map(|slot| world.body(slot)).take(states.len()).collect();
    let mut seen = View::default();
    for ((state, outline), body) in states.iter().zip(&outlines).zip(&slots) {
        let far = |v: &[f64; 2]| (v[0] - outline.centre[0]).hypot(v[1] - outline.centre[1]);
        let size = outline.vertices.iter().map(far).fold(outline.radius, f64::max);
        let ([x, y], [vx, vy], w) = (state.position, state.velocity, state.angular_velocity);
        let inverse = |v: f64| if v > 0.0 { 1.0 / v } else { 0.0 };
        let (mass, inertia) = (inverse(body.inv_mass), inverse(body.inv_inertia));
        let speed = vx.hypot(vy);
        seen.places.push(state.position);
        // A disc looks the same however it is turned.
        seen.turns.push(if outline.radius > 0.0 { [1.0, 0.0] } else { state.rotation });
        seen.speeds.push(if body.kind == BodyKind::Dynamic { speed + size * w.abs() } else { 0.0 });
        seen.sizes.push(size);
        seen.spins.push(if outline.radius > 0.0 { 0.0 } else { w.abs() });
        // Of bodies at rest sums are round-off: they are held to what rest is.
        let pace = speed.max(REST * (pull * size).sqrt());
        let kinetic = 0.5 * (mass * speed * speed + inertia * w * w);
        let angular = (x.hypot(y) + size) * mass * pace + inertia * w.abs();
        let parts = [kinetic, mass * pull * size, mass * pace, mass * pace, angular];
        seen.scales.iter_mut().zip(parts).for_each(|(sum, part)| *sum += part);
    }
    seen.sums = sums(world);
    let place = |slot: u32| slots.iter().position(|body| body.id.slot() == slot as usize);
    seen.touching = (world.contacts().iter())
        .filter_map(|contact| {
            let [a, b] = [place(contact.a)?, place(contact.b)?];
            let near = TOUCH * seen.sizes[a].min(seen.sizes[b]);
            contact.points.iter().any(|point| point.separation <= near).then_some([a, b])
        })
        .collect();
    seen
}

/// What converged runs say at one time.
#[derive(Debug)]
struct Look {
    right: View,
    others: Vec<View>,
}

impl Look {
    /// All that was seen.
    fn all(&self) -> impl Iterator<Item = &View> {
        std::iter::once(&self.right).chain(&self.others)
    }
    /// How far others are from the converged run in a number.
    fn spread(&self, of: impl Fn(&View) -> f64) -> f64 {
        self.others.iter().map(of).fold(0.0, f64::max)
    }
}

/// Knows how a scene comes out.
#[derive(Debug)]
pub(super) struct Accord {
    looks: Vec<Look>,
    /// How far each body has come and turned by each look, metres and rad.
    ways: Vec<Vec<[f64; 2]>>,
    /// Looks shortly after something was done to the scene: a long step may have yet to do it.
    unsure: Vec<bool>,
    /// Largest over the run.
    scales: [f64; 5],
    /// m/s²: of gravity, or what bodies without any do in a second.
    pull: f64,
    horizon_secs: f64,
}

fn apart(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

/// Is an error over its bound, or no number at all?
fn over(off: f64, may: f64) -> bool {
    off.is_nan() || off > may
}

/// The angle between two attitudes, rad.
fn turned(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] * b[1] - a[1] * b[0]).atan2(a[0] * b[0] + a[1] * b[1]).abs()
}

impl Accord {
    /// Runs the scene to its horizon and looks at it `looks` times on its way.
    pub(super) fn new(scene: &Scene, horizon_secs: f64, looks: u32, held: bool) -> anyhow::Result<Self> {
        let fields = scene.forces.gravity.map_or(0.0, |[x, y]| x.hypot(y));
        let fastest = scene.bodies.iter().map(|body| body.velocity[0].hypot(body.velocity[1]));
        let pull = if fields > 0.0 { fields } else { fastest.fold(1.0, f64::max) };
        let right = course(scene, (horizon_secs, looks), RATE, held, pull)?;
        let mut others = vec![course(scene, (horizon_secs, looks), 0.5 * RATE, held, pull)?];
        for seed in [1, 2] {
            others.push(course(&nudged(scene, seed, pull), (horizon_secs, looks), 0.5 * RATE, held, pull)?);
        }
        let mut others: Vec<_> = others.into_iter().map(Vec::into_iter).collect();
        let looks: Vec<_> = (right.into_iter())
            .map(|right| Look { right, others: others.iter_mut().filter_map(Iterator::next).collect() })
            .collect();
        let mut scales = [0.0; 5];
        for part in looks.iter().map(|look| look.right.scales) {
            scales.iter_mut().zip(part).for_each(|(most, part): (&mut f64, f64)| *most = most.max(part));
        }
        // What falls turns one energy into the other.
        let potential = looks.iter().map(|look| look.right.sums[1]);
        let range = potential.clone().fold(f64::MIN, f64::max) - potential.fold(f64::MAX, f64::min);
        let energy = scales[0].max(scales[1]).max(range.max(0.0));
        (scales[0], scales[1]) = (energy, energy);
        let secs = horizon_secs / looks.len() as f64;
        let mut ways: Vec<Vec<[f64; 2]>> = Vec::new();
        for look in &looks {
            let come = |k: usize| {
                let [way, turn] = ways.last().and_then(|before| before.get(k)).copied().unwrap_or_default();
                [way + secs * look.right.speeds[k], turn + secs * look.right.spins[k]]
            };
            ways.push((0..look.right.places.len()).map(come).collect());
        }
        let at = |look: usize| secs * (look + 1) as f64;
        let done = |look: usize| {
            let mut events = scene.events.iter().map(|event| event.secs(scene.dt_secs));
            events.any(|event| event <= at(look) && at(look) - event <= LATE_SECS)
        };
        let unsure = (0..looks.len()).map(done).collect();
        Ok(Self { looks, ways, unsure, scales, pull, horizon_secs })
    }

    /// What a run has otherwise at a look, from 0; `None` where it agrees.
    pub(super) fn differs(&self, world: &dyn Simulation, at: usize) -> Option<String> {
        if self.unsure[at] {
            return None;
        }
        let (look, found) = (&self.looks[at], view(world, self.pull));
        let secs = self.horizon_secs * (at + 1) as f64 / self.looks.len() as f64;
        if look.all().any(|other| other.places.len() != found.places.len()) {
            return Some(format!("it has {} bodies at {secs:.3} s", found.places.len()));
        }
        let said = self.body_differs(look, &found, at).or_else(|| self.sums_differ(look, &found));
        said.or_else(|| self.rests_differ(look, &found)).map(|what| format!("{what} at {secs:.3} s"))
    }

    fn body_differs(&self, look: &Look, found: &View, at: usize) -> Option<String> {
        (0..found.places.len()).find_map(|k| {
            let right = &look.right;
            let off = apart(found.places[k], right.places[k]);
            let told = look.spread(|other| apart(other.places[k], right.places[k]));
            let [way, turn] = self.ways[at][k];
            let may = (OF_SIZE * right.sizes[k]).max(OF_WAY * way).max(SPREADS * told);
            if over(off, may) {
                return Some(format!("body {k} is {off:.2e} m from where it should be"));
            }
            let off = turned(found.turns[k], right.turns[k]);
            let told = look.spread(|other| turned(other.turns[k], right.turns[k]));
            over(off, TURN.max(OF_WAY * turn).max(SPREADS * told))
                .then(|| format!("body {k} is turned by {off:.2} rad from how it should stand"))
        })
    }

    fn sums_differ(&self, look: &Look, found: &View) -> Option<String> {
        const NAMES: [&str; 5] =
            ["kinetic energy", "potential energy", "momentum x", "momentum y", "angular momentum"];
        (0..5).find_map(|k| {
            let (is, right) = (found.sums[k], look.right.sums[k]);
            let told = look.spread(|other| (other.sums[k] - right).abs());
            // What happens within a step is seen at its end: it may come that much too late.
            let [low, high] = look.right.around.map(|sums| sums[k]);
            let off = (is - is.clamp(low.min(right), high.max(right))).abs();
            let may = (OF_SUMS * self.scales[k]).max(SPREADS * told).max(1e-9 * right.abs());
            over(off, may).then(|| format!("{} is {is:.3e} where {right:.3e} is right", NAMES[k]))
        })
    }

    fn rests_differ(&self, look: &Look, found: &View) -> Option<String> {
        let pace = |k: usize| REST * (self.pull * look.right.sizes[k]).sqrt();
        let rests = |view: &View, k: usize| view.speeds[k] < pace(k);
        let moves = |view: &View, k: usize| view.speeds[k] > 3.0 * pace(k);
        for k in 0..found.speeds.len() {
            if look.all().all(|view| rests(view, k)) && moves(found, k) {
                return Some(format!("body {k} moves at {:.2e} m/s where it should rest", found.speeds[k]));
            }
            if look.all().all(|view| moves(view, k)) && rests(found, k) {
                return Some(format!("body {k} rests where it should move"));
            }
        }
        // Of what rests: who touches whom. Elsewhere it is a matter of the instant.
        let still = |pair: &[usize; 2]| pair.iter().all(|&k| look.all().all(|view| rests(view, k)));
        let touches = |view: &View, pair: &[usize; 2]| view.touching.contains(pair);
        let agreed = |pair: &&[usize; 2]| still(pair) && look.all().all(|view| touches(view, pair));
        if let Some([a, b]) = look.right.touching.iter().filter(agreed).find(|pair| !touches(found, pair)) {
            return Some(format!("bodies {a} and {b} do not touch"));
        }
        let never = |pair: &&[usize; 2]| still(pair) && !look.all().any(|view| touches(view, pair));
        found.touching.iter().find(never).map(|[a, b]| format!("bodies {a} and {b} touch"))
    }
}

/// What a converged run looks like at each look.
fn course(
    scene: &Scene,
    (horizon_secs, looks): (f64, u32),
    rate: f64,
    held: bool,
    pull: f64,
) -> anyhow::Result<Vec<View>> {
    let per_look = (horizon_secs * rate / f64::from(looks)).ceil().max(1.0) as u32;
    let dt_secs = horizon_secs / f64::from(per_look * looks);
    let integrator = if held { Integrator::VelocityVerlet } else { Integrator::Rk4 };
    let exact =
        Settings { dt_secs, integrator, solver: Solver::Soft, substeps: SUBSTEPS, ..Settings::default() };
    let mut world = simulate(scene, exact.with_precision(Precision::F64))?;
    let mut course = Vec::new();
    let beside = (LATE_SECS / dt_secs).ceil() as u32;
    let mut around = vec![[[f64::INFINITY; 5], [f64::NEG_INFINITY; 5]]; looks as usize];
    for step in 1..=looks * per_look {
        world.step(dt_secs)?;
        // The look that is nearest, from 1.
        let look = (step + per_look / 2) / per_look;
        if look > 0 && step.abs_diff(look * per_look) <= beside {
            let [low, high] = &mut around[look as usize - 1];
            for (k, sum) in sums(world.as_ref()).into_iter().enumerate() {
                (low[k], high[k]) = (low[k].min(sum), high[k].max(sum));
            }
        }
        if step.is_multiple_of(per_look) {
            course.push(view(world.as_ref(), pull));
        }
    }
    for (view, around) in course.iter_mut().zip(around) {
        view.around = around;
    }
    Ok(course)
}

/// The scene with dynamic bodies a little faster or slower along both axes.
fn nudged(scene: &Scene, seed: u64, pull: f64) -> Scene {
    let mut random = Pcg32::seed_from_u64(seed);
    let mut nudged = scene.clone();
    for body in nudged.bodies.iter_mut().filter(|body| body.kind == BodyKind::Dynamic) {
        let size = body.shape.build().map_or(0.0, |shape| shape.bounding_radius());
        let pace = NUDGE * (pull * size).sqrt();
        body.velocity = body.velocity.map(|v| v + pace * random.random_range(-1.0..=1.0));
    }
    nudged
}
