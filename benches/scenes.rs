//! Whole steps of settled scenes: what they are, see [`steps`]. Time per step, and per body.
//!
//! Before the clock runs, every bench takes the steps of its window once; all lane widths, and skips and the broad
//! phase on and off, must then be in the same state, with contacts (in free flight: without). Beside the cases of
//! [`steps`] the group `baselines`: the thesis's engine, faithful and tidy, at 150, from the states `mixes` starts from.

mod clock;
mod common;
mod steps;

use std::time::{Duration, Instant};

use criterion::measurement::WallTime;
use criterion::{BenchmarkGroup, BenchmarkId, Criterion, SamplingMode, Throughput};
use lamina::report::experiments::posed;
use lamina::thesis::{ThesisIntegrator, ThesisWorld, Version};
use lamina2d::scene::Scene;
use lamina2d::scene::mixes::Mix;
use lamina2d::simulation::Simulation;

use clock::criterion;
use common::{Agreement, Answer, DT_SECS, SETTLE_STEPS, Settled, scene, step_through};
use steps::{Case, Touch, WINDOW_STEPS};

type Group<'a> = BenchmarkGroup<'a, WallTime>;

fn main() {
    let mut criterion = criterion();
    let settled = Settled::new(step_through);
    let agreement = Agreement::default();
    let cases = steps::all();
    for cases in cases.chunk_by(|a, b| group_of(a) == group_of(b)) {
        let mut group = group(&mut criterion, group_of(&cases[0]));
        for case in cases {
            group.throughput(Throughput::Elements(case.bodies));
            // Ten thousand bodies: a step is as long as a sample of the others.
            group.sample_size(if case.bodies > 2000 { 10 } else { 20 });
            for &lanes in case.lanes {
                let start = || Ours { world: case.start(&settled, lanes), touch: case.touch };
                bench_steps(&mut group, &case.at(lanes), &case.alike, start, &agreement);
            }
        }
        group.finish();
    }
    baselines(&mut criterion, &settled, &agreement);
    criterion.final_summary();
}

fn group_of(case: &Case) -> &str {
    case.name.split('/').next().unwrap_or_default()
}

fn group<'a>(criterion: &'a mut Criterion, name: &str) -> Group<'a> {
    let mut group = criterion.benchmark_group(name);
    // Steps take long and are all alike: no need for samples of growing length.
    group.sampling_mode(SamplingMode::Flat);
    group
}

/// A world in the state from which steps are timed.
trait Engine: Sized {
    /// The same state again.
    fn again(&self) -> Self;
    /// Steps once.
    fn step(&mut self);
    /// Contacts of the last step and hash of the state.
    fn answer(&self, name: &str) -> Answer;
}

/// One of our worlds.
struct Ours {
    world: Box<dyn Simulation>,
    touch: Touch,
}

impl Engine for Ours {
    fn again(&self) -> Self {
        Self { world: self.world.duplicate(), touch: self.touch }
    }

    fn step(&mut self) {
        steps::step(self.world.as_mut());
    }

    fn answer(&self, name: &str) -> Answer {
        steps::answer(name, self.world.as_ref(), self.touch)
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

    fn answer(&self, name: &str) -> Answer {
        let count = self.world.contacts();
        assert!(count > 0, "{name}: no contacts");
        Answer { count, hash: self.world.hash() }
    }
}

/// Benches the steps after the state that `start` builds, which is called only if the bench runs. `name` is that of
/// its group, the function and, behind the last slash, the variant.
fn bench_steps<E: Engine>(
    group: &mut Group<'_>,
    name: &str,
    alike: &str,
    start: impl Fn() -> E,
    agreement: &Agreement,
) {
    let (function, variant) = name.rsplit_once('/').expect("a name with a variant");
    let function = function.split_once('/').expect("a name with a group").1;
    let mut checked = None;
    group.bench_function(BenchmarkId::new(function, variant), |bencher| {
        let settled = checked.get_or_insert_with(|| {
            let settled = start();
            let mut world = ready(&settled);
            (0..WINDOW_STEPS).for_each(|_| world.step());
            agreement.check(alike, name, world.answer(name));
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

fn baselines(criterion: &mut Criterion, settled: &Settled, agreement: &Agreement) {
    let mut group = group(criterion, "baselines");
    group.throughput(Throughput::Elements(150)).sample_size(20);
    for mix in Mix::ALL {
        let name = &format!("{}/150", mix.name());
        let start = posed(&scene(name), &*settled.get(name, SETTLE_STEPS));
        for integrator in ThesisIntegrator::ALL {
            let label = format!("baselines/{name}/{}", format!("{integrator:?}").to_lowercase());
            for (engine, version) in [("thesis", Version::Faithful), ("tidy", Version::Tidy)] {
                let (start, name) =
                    (|| Baseline::new(&start, integrator, version), format!("{label}/{engine}"));
                // The two agree to rounding only: of each, only the contacts are checked.
                bench_steps(&mut group, &name, &name, start, agreement);
            }
        }
    }
    group.finish();
}
