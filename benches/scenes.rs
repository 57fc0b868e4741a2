//! Whole steps of settled scenes.
//!
//! `group/scene/bodies/…/xLANES`; time per step, and per body. The steps timed are always the same: the first
//! [`WINDOW_STEPS`] after the settled state, over and over. Before the clock runs, every bench takes those
//! steps once; all lane widths, and the broad phase on and off, must then be in the same state, with contacts
//! (in free flight: without).
//!
//! | group | what runs |
//! |---|---|
//! | `mixes` | the thesis's four mixes × integrators at 150; at 1000 and polygons at 10,000 with one |
//! | `free_flight` | 100,000 circles that never touch |
//! | `stack` | ten boxes at rest on each other |
//! | `broad_on_off` | polygons with the broad phase of `auto` and with all pairs in the narrow phase |
//! | `baselines` | the thesis's engine, faithful and tidy, at 150, from the states `mixes` starts from |

mod common;

use std::time::{Duration, Instant};

use criterion::measurement::WallTime;
use criterion::{BenchmarkGroup, BenchmarkId, Criterion, SamplingMode, Throughput};
use lamina2d::report::experiments::posed;
use lamina2d::scene::Scene;
use lamina2d::scene::mixes::Mix;
use lamina2d::settings::{Broad, Integrator, Settings, Skips};
use lamina2d::simulation::Simulation;
use lamina2d::thesis::{ThesisIntegrator, ThesisWorld, Version};

use common::{Agreement, Answer, DT_SECS, SETTLE_STEPS, Settled, criterion, scene};

/// Steps from the settled state on that are timed, and after which answers are compared.
const WINDOW_STEPS: u64 = 20;
/// Widths that are compared.
const LANES: [usize; 2] = [1, 8];

type Group<'a> = BenchmarkGroup<'a, WallTime>;

fn main() {
    let mut criterion = criterion();
    let settled = Settled::default();
    mixes(&mut criterion, &settled);
    free_flight(&mut criterion, &settled);
    stack(&mut criterion, &settled);
    broad_on_off(&mut criterion, &settled);
    baselines(&mut criterion, &settled);
    criterion.final_summary();
}

/// A world in the state from which steps are timed.
trait Engine: Sized {
    /// The same state again.
    fn again(&self) -> Self;
    /// Steps once.
    fn step(&mut self);
    /// Contacts of the last step and hash of the state.
    fn answer(&self) -> Answer;
}

impl Engine for Box<dyn Simulation> {
    fn again(&self) -> Self {
        self.duplicate()
    }

    fn step(&mut self) {
        (**self).step(DT_SECS).expect("a scene that stays finite");
    }

    fn answer(&self) -> Answer {
        Answer { count: self.counts().contacts, hash: self.hash() }
    }
}

/// The thesis's engine; its worlds cannot be copied, so each is built from the scene.
struct Baseline<'a> {
    scene: &'a Scene,
    integrator: ThesisIntegrator,
    version: Version,
    world: ThesisWorld,
}

impl<'a> Baseline<'a> {
    fn new(scene: &'a Scene, integrator: ThesisIntegrator, version: Version) -> Self {
        let world = ThesisWorld::new(scene, integrator, version, true).expect("a scene the baseline can run");
        Self { scene, integrator, version, world }
    }
}

impl Engine for Baseline<'_> {
    fn again(&self) -> Self {
        Self::new(self.scene, self.integrator, self.version)
    }

    fn step(&mut self) {
        self.world.step(DT_SECS as f32);
    }

    fn answer(&self) -> Answer {
        Answer { count: self.world.contacts(), hash: self.world.hash() }
    }
}

/// Does the scene have contacts?
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Touch {
    Always,
    Never,
}

/// Benches the steps after the state that `start` builds, which is called only if the bench runs.
fn bench_steps<E: Engine>(
    group: &mut Group<'_>,
    [function, variant]: [&str; 2],
    start: impl Fn() -> E,
    touch: Touch,
    agreement: &Agreement,
) {
    let mut checked = None;
    group.bench_function(BenchmarkId::new(function, variant), |bencher| {
        let settled = checked.get_or_insert_with(|| {
            let settled = start();
            let mut world = ready(&settled);
            (0..WINDOW_STEPS).for_each(|_| world.step());
            let (name, answer) = (format!("{function}/{variant}"), world.answer());
            assert_eq!(answer.count > 0, touch == Touch::Always, "{name}: {} contacts", answer.count);
            agreement.check(&name, answer);
            settled
        });
        bencher.iter_custom(|steps| time_steps(settled, steps));
    });
}

/// A copy that has its memory: the first step, in which a copy's vectors grow, is never timed.
fn ready<E: Engine>(settled: &E) -> E {
    let mut world = settled.again();
    world.step();
    world
}

/// Time of `steps` steps, in windows that all start from the same state.
fn time_steps<E: Engine>(settled: &E, steps: u64) -> Duration {
    let (mut left, mut elapsed) = (steps, Duration::ZERO);
    while left > 0 {
        let window = left.min(WINDOW_STEPS);
        let mut world = ready(settled);
        let start = Instant::now();
        (0..window).for_each(|_| world.step());
        elapsed += start.elapsed();
        left -= window;
    }
    elapsed
}

/// One of our scenes: its name, the steps that settle it, what it runs with.
struct Case<'a> {
    scene: &'a str,
    settle_steps: usize,
    settings: Settings,
    touch: Touch,
}

impl Case<'_> {
    /// Benches it at each of [`LANES`] as `function/xLANES`.
    fn bench(&self, group: &mut Group<'_>, settled: &Settled, function: &str, agreement: &Agreement) {
        for lanes in LANES {
            let start = || {
                let world = settled.get(self.scene, self.settle_steps);
                world.with_settings(Settings { lanes, ..self.settings }).expect("settings that run")
            };
            bench_steps(group, [function, &format!("x{lanes}")], start, self.touch, agreement);
        }
    }
}

fn group<'a>(criterion: &'a mut Criterion, name: &str) -> Group<'a> {
    let mut group = criterion.benchmark_group(name);
    // Steps take long and are all alike: no need for samples of growing length.
    group.sampling_mode(SamplingMode::Flat);
    group
}

fn mixes(criterion: &mut Criterion, settled: &Settled) {
    let mut group = group(criterion, "mixes");
    let mut bench = |mix: Mix, bodies: usize, integrator: Integrator| {
        let scene = &format!("{}/{bodies}", mix.name());
        let settings = Settings { integrator, ..Settings::default() };
        let case = Case { scene, settle_steps: SETTLE_STEPS, settings, touch: Touch::Always };
        group.throughput(Throughput::Elements(bodies as u64));
        // Ten thousand bodies: a step is as long as a sample of the others.
        group.sample_size(if bodies > 1000 { 10 } else { 20 });
        case.bench(&mut group, settled, &format!("{scene}/{integrator}"), &Agreement::default());
    };
    for mix in Mix::ALL {
        for &integrator in Integrator::ALL {
            bench(mix, 150, integrator);
        }
        bench(mix, 1000, Integrator::SemiImplicitEuler);
    }
    bench(Mix::Polygons, 10_000, Integrator::SemiImplicitEuler);
    group.finish();
}

fn free_flight(criterion: &mut Criterion, settled: &Settled) {
    let mut group = group(criterion, "free_flight");
    group.throughput(Throughput::Elements(100_000)).sample_size(10);
    let (scene, settings) = ("free_flight/100000", Settings::default());
    let case = Case { scene, settle_steps: 0, settings, touch: Touch::Never };
    case.bench(&mut group, settled, "100000", &Agreement::default());
    group.finish();
}

fn stack(criterion: &mut Criterion, settled: &Settled) {
    let mut group = group(criterion, "stack");
    group.throughput(Throughput::Elements(10));
    let (scene, settings) = ("stack/10", Settings::default());
    let case = Case { scene, settle_steps: 300, settings, touch: Touch::Always };
    case.bench(&mut group, settled, "10", &Agreement::default());
    group.finish();
}

fn broad_on_off(criterion: &mut Criterion, settled: &Settled) {
    let mut group = group(criterion, "broad_on_off");
    // The thesis's numbers of bodies.
    for bodies in [60, 80, 100, 200] {
        let scene = &format!("polygons/{bodies}");
        let agreement = Agreement::default();
        group.throughput(Throughput::Elements(bodies));
        for (name, broad) in [("on", Broad::Auto), ("off", Broad::Off)] {
            // Which pairs are listed decides when manifolds are reused; all other skips keep every bit.
            let settings = Settings { broad, skips: Skips::EXACT, ..Settings::default() };
            let case = Case { scene, settle_steps: SETTLE_STEPS, settings, touch: Touch::Always };
            case.bench(&mut group, settled, &format!("{scene}/{name}"), &agreement);
        }
    }
    group.finish();
}

fn baselines(criterion: &mut Criterion, settled: &Settled) {
    let mut group = group(criterion, "baselines");
    group.throughput(Throughput::Elements(150));
    for mix in Mix::ALL {
        let name = &format!("{}/150", mix.name());
        let start = posed(&scene(name), &*settled.get(name, SETTLE_STEPS));
        for integrator in ThesisIntegrator::ALL {
            let label = format!("{name}/{}", format!("{integrator:?}").to_lowercase());
            for (engine, version) in [("thesis", Version::Faithful), ("tidy", Version::Tidy)] {
                let start = || Baseline::new(&start, integrator, version);
                // The two agree to rounding only: of each, only the contacts are checked.
                bench_steps(&mut group, [&label, engine], start, Touch::Always, &Agreement::default());
            }
        }
    }
    group.finish();
}
