//! Each stage's kernels alone, on the bodies of settled scenes, at every lane width.
//!
//! `group/kernel/bodies/xLANES`. Time per element: bodies for `integrate` and `broad`, pairs for `narrow`,
//! contacts for `prepare` and `solve`.
//!
//! | group | timed call | its answer |
//! |---|---|---|
//! | `integrate` | [`integrate::fly`]: one step of free flight, attitudes turned | state hash, same with the closed form |
//! | `broad` | [`BroadPhase::find`] | the pairs, same for all methods |
//! | `narrow` | [`Narrow::run`] on the pairs of one bucket, its pose rows included | the manifolds |
//! | `prepare` | [`Solving::prepare`]: colours, batches, constraints at 8 lanes | every contact once, no dynamic body twice in a colour |
//! | `solve` | [`Solving::solve`]: what a substep solves before bodies move | the rows |

mod common;

use std::any::Any;
use std::hint::black_box;
use std::time::{Duration, Instant};

use criterion::measurement::WallTime;
use criterion::{Bencher, BenchmarkGroup, BenchmarkId, Criterion, Throughput};
use lamina2d::body::{Bodies, Form};
use lamina2d::broad::BroadPhase;
use lamina2d::force::{Field, Forces};
use lamina2d::integrate::{self, Motion, Plan};
use lamina2d::lanes::{Lanes, f32s};
use lamina2d::measure::state_hash;
use lamina2d::narrow::Narrow;
use lamina2d::scene::BodyKind;
use lamina2d::settings::{Broad, Integrator, Skip, Skips, Solver};
use lamina2d::solve::{self, Solving, Task, Traits};
use lamina2d::world::World;
use xxhash_rust::xxh3::Xxh3Default;

use common::{Agreement, Answer, DT_SECS, SETTLE_STEPS, Settled, criterion};

/// Dynamic bodies of the scenes.
const SIZES: [usize; 2] = [150, 1000];
/// Median bounding radius of the mixes' bodies, near enough, metres.
const LENGTH_M: f64 = 0.4;

/// The gap within which solvers want to hear of contacts, metres.
fn margin() -> f32 {
    Traits { friction: true, restitution: true, length: LENGTH_M, gravity: 9.81 }.margin(Solver::Soft)
}

type Group<'a> = BenchmarkGroup<'a, WallTime>;

fn main() {
    let mut criterion = criterion();
    let settled = Settled::default();
    integrate_alone(&mut criterion, &settled);
    broad_alone(&mut criterion, &settled);
    narrow_alone(&mut criterion, &settled);
    prepare_alone(&mut criterion, &settled);
    solve_alone(&mut criterion, &settled);
    criterion.final_summary();
}

/// One stage on one input, at any width.
trait Stage {
    /// What a call writes.
    type Memory;
    /// Elements a call handles.
    fn elements(&self) -> usize;
    /// The memory of a first call.
    fn memory(&self) -> Self::Memory;
    /// The call.
    fn run<L: Lanes<Elem = f32>>(&self, memory: &mut Self::Memory);
    /// What the first call left in its memory.
    fn answer(&self, memory: &Self::Memory) -> Answer;
    /// Times calls one after the other in the same memory.
    fn time<L: Lanes<Elem = f32>>(&self, bencher: &mut Bencher<'_>, memory: &mut Self::Memory) {
        bencher.iter(|| self.run::<L>(black_box(&mut *memory)));
    }
}

/// Benches a stage at 1, 4, 8 and 16 lanes.
fn at_every_width<S: Stage>(
    group: &mut Group<'_>,
    kernel: &str,
    size: usize,
    stage: &S,
    agreement: &Agreement,
) {
    at_width::<f32s::X1, S>(group, kernel, size, stage, agreement);
    at_width::<f32s::X4, S>(group, kernel, size, stage, agreement);
    at_width::<f32s::X8, S>(group, kernel, size, stage, agreement);
    at_width::<f32s::X16, S>(group, kernel, size, stage, agreement);
}

fn at_width<L: Lanes<Elem = f32>, S: Stage>(
    group: &mut Group<'_>,
    kernel: &str,
    size: usize,
    stage: &S,
    agreement: &Agreement,
) {
    let (function, lanes) = (format!("{kernel}/{size}"), format!("x{}", L::WIDTH));
    let name = format!("{function}/{lanes}");
    let mut checked = None;
    group.throughput(Throughput::Elements(stage.elements() as u64));
    group.bench_function(BenchmarkId::new(function, lanes), |bencher| {
        let memory = checked.get_or_insert_with(|| {
            let mut memory = stage.memory();
            stage.run::<L>(&mut memory);
            let answer = stage.answer(&memory);
            assert!(answer.count > 0, "{name} found nothing to do");
            agreement.check(&name, answer);
            memory
        });
        stage.time::<L>(bencher, memory);
    });
}

/// `count` things that consist of `values`.
fn answer_of(count: usize, values: impl Iterator<Item = u64>) -> Answer {
    let mut hasher = Xxh3Default::new();
    for value in values {
        hasher.update(&value.to_le_bytes());
    }
    Answer { count, hash: hasher.digest() }
}

/// One step of bodies that touch nothing.
struct Flight {
    bodies: Bodies<f32>,
    fields: Vec<Field<f32>>,
    integrator: Integrator,
    skips: Skips,
}

impl Stage for Flight {
    type Memory = Bodies<f32>;

    fn elements(&self) -> usize {
        self.bodies.live()
    }

    fn memory(&self) -> Bodies<f32> {
        self.bodies.clone()
    }

    fn run<L: Lanes<Elem = f32>>(&self, bodies: &mut Bodies<f32>) {
        let Self { integrator, ref fields, skips, .. } = *self;
        integrate::fly::<L>(
            &Plan { integrator, fields, h_secs: DT_SECS, substeps: 1, skips, moving: false },
            bodies,
        );
    }

    fn answer(&self, bodies: &Bodies<f32>) -> Answer {
        let moved = bodies.slots().filter(|&slot| bodies.y[slot] != self.bodies.y[slot]);
        Answer { count: moved.count(), hash: state_hash(bodies) }
    }
}

fn integrate_alone(criterion: &mut Criterion, settled: &Settled) {
    let mut group = criterion.benchmark_group("integrate");
    for size in SIZES {
        let mut bodies = settled.get(&format!("free_flight/{size}"), 0).bodies().clone();
        for slot in bodies.slots().collect::<Vec<_>>() {
            bodies.w[slot] = 1.0;
        }
        for &integrator in Integrator::ALL {
            // Under gravity alone the closed form is the same to the bit.
            let agreement = Agreement::default();
            // Nothing else is left out: attitudes are turned.
            let fields = Forces::gravity().fields();
            let mut stage = Flight { bodies: bodies.clone(), fields, integrator, skips: Skips::NONE };
            at_every_width(&mut group, integrator.name(), size, &stage, &agreement);
            stage.skips = Skips::NONE.with(Skip::ClosedForm);
            if matches!(integrator, Integrator::ExplicitEuler | Integrator::SemiImplicitEuler) {
                // They have one stage and no closed form.
                continue;
            }
            at_every_width(&mut group, &format!("{integrator}_closed_form"), size, &stage, &agreement);
        }
    }
    group.finish();
}

/// Candidate pairs.
struct Pairs<'a> {
    bodies: &'a Bodies<f32>,
    method: Broad,
}

impl Stage for Pairs<'_> {
    type Memory = BroadPhase<f32>;

    fn elements(&self) -> usize {
        self.bodies.live()
    }

    fn memory(&self) -> BroadPhase<f32> {
        BroadPhase::default()
    }

    fn run<L: Lanes<Elem = f32>>(&self, broad: &mut BroadPhase<f32>) {
        broad.find::<L>(self.bodies, self.method, margin(), false);
    }

    fn answer(&self, broad: &BroadPhase<f32>) -> Answer {
        let pairs = broad.pairs();
        answer_of(pairs.len(), pairs.iter().flatten().map(|&slot| u64::from(slot)))
    }
}

fn broad_alone(criterion: &mut Criterion, settled: &Settled) {
    let mut group = criterion.benchmark_group("broad");
    for size in SIZES {
        let world = settled.get(&format!("circles/{size}"), SETTLE_STEPS);
        // The methods must give the same pairs in the same order.
        let agreement = Agreement::default();
        for method in [Broad::Brute, Broad::Sweep, Broad::Grid] {
            let stage = Pairs { bodies: world.bodies(), method };
            at_every_width(&mut group, method.name(), size, &stage, &agreement);
        }
    }
    group.finish();
}

/// Pairs of one bucket.
struct Bucket<'a> {
    bodies: &'a Bodies<f32>,
    pairs: Vec<[u32; 2]>,
}

impl Stage for Bucket<'_> {
    type Memory = Narrow<f32>;

    fn elements(&self) -> usize {
        self.pairs.len()
    }

    fn memory(&self) -> Narrow<f32> {
        Narrow::default()
    }

    fn run<L: Lanes<Elem = f32>>(&self, narrow: &mut Narrow<f32>) {
        narrow.run::<L>(self.bodies, &self.pairs, margin());
    }

    fn answer(&self, narrow: &Narrow<f32>) -> Answer {
        let found = &narrow.manifolds;
        let contacts = found.touching().iter().map(|&place| place as usize).flat_map(|at| {
            let ([a, b], code) = (found.slots(at), found.code(at));
            let names = [a, b, code.points() as u32, code.feature(0).into(), code.feature(1).into()];
            let rows = found.geometry()[at].into_iter().chain(found.gaps()[at]);
            names.map(u64::from).into_iter().chain(rows.map(|value| u64::from(value.to_bits())))
        });
        answer_of(found.len(), contacts)
    }
}

/// A bucket and a mix whose piles fill it.
const BUCKETS: [(&str, [Form; 2], &str); 6] = [
    ("circle-circle", [Form::Circle, Form::Circle], "circles"),
    ("circle-box", [Form::Circle, Form::Box], "all"),
    ("circle-polygon", [Form::Circle, Form::Polygon], "circles_polygons"),
    ("box-box", [Form::Box, Form::Box], "all"),
    ("box-polygon", [Form::Box, Form::Polygon], "all"),
    ("polygon-polygon", [Form::Polygon, Form::Polygon], "polygons"),
];

fn narrow_alone(criterion: &mut Criterion, settled: &Settled) {
    let mut group = criterion.benchmark_group("narrow");
    for (kernel, forms, mix) in BUCKETS {
        for size in SIZES {
            let pile = Pile::of(&settled.get(&format!("{mix}/{size}"), SETTLE_STEPS));
            let stage = Bucket { pairs: pile.pairs_of(forms), bodies: &pile.bodies };
            at_every_width(&mut group, kernel, size, &stage, &Agreement::default());
        }
    }
    group.finish();
}

/// Settled bodies with the pairs and contacts of their next step.
struct Pile {
    bodies: Bodies<f32>,
    pairs: Vec<[u32; 2]>,
    narrow: Narrow<f32>,
}

impl Pile {
    fn of(world: &World<f32s::X8>) -> Self {
        let mut bodies = world.bodies().clone();
        bodies.refresh_polygons();
        let (mut broad, mut narrow) = (BroadPhase::default(), Narrow::default());
        broad.find::<f32s::X8>(&bodies, Broad::Auto, margin(), false);
        narrow.run::<f32s::X8>(&bodies, broad.pairs(), margin());
        Self { pairs: broad.pairs().to_vec(), bodies, narrow }
    }

    /// The pairs of these forms, whichever of the two comes first.
    fn pairs_of(&self, [a, b]: [Form; 2]) -> Vec<[u32; 2]> {
        let is_of = |pair: &[u32; 2]| {
            let forms = pair.map(|slot| self.bodies.form(slot as usize));
            forms == [a, b] || forms == [b, a]
        };
        self.pairs.iter().copied().filter(is_of).collect()
    }

    /// Motion memory as a step begins.
    fn motion(&self) -> Motion<f32> {
        let mut motion = Motion::default();
        motion.resize(&self.bodies);
        motion
    }

    /// Constraints of all contacts.
    fn solving<L: Lanes<Elem = f32>>(&self) -> Solving<L> {
        let (mut solving, mut narrow) = (Solving::default(), self.narrow.clone());
        solving.prepare(&self.bodies, &mut narrow, true, &self.motion());
        solving
    }
}

fn prepare_alone(criterion: &mut Criterion, settled: &Settled) {
    let mut group = criterion.benchmark_group("prepare");
    for mix in ["circles", "polygons"] {
        for size in SIZES {
            let pile = Pile::of(&settled.get(&format!("{mix}/{size}"), SETTLE_STEPS));
            check_colors(&pile);
            let (mut solving, mut narrow) = (Solving::<f32s::X8>::default(), pile.narrow.clone());
            let motion = pile.motion();
            group.throughput(Throughput::Elements(narrow.manifolds.len() as u64));
            group.bench_function(BenchmarkId::new(mix, size), |bencher| {
                bencher.iter(|| black_box(&mut solving).prepare(&pile.bodies, &mut narrow, true, &motion));
            });
        }
    }
    group.finish();
}

/// Every contact is in one colour, and no colour holds a dynamic body twice.
fn check_colors(pile: &Pile) {
    let solving = pile.solving::<f32s::X16>();
    let (coloring, manifolds) = (solving.coloring(), &pile.narrow.manifolds);
    let mut contacts_seen = vec![false; manifolds.pairs()];
    for color in coloring.colors() {
        let mut bodies_seen = vec![false; pile.bodies.len()];
        for &place in &coloring.order()[color.two.start..color.one.end] {
            let again = std::mem::replace(&mut contacts_seen[place as usize], true);
            assert!(!again, "the contact at {place} has two colours");
            for slot in manifolds.slots(place as usize).map(|slot| slot as usize) {
                let again = std::mem::replace(&mut bodies_seen[slot], true);
                let moves = pile.bodies.kind(slot) == BodyKind::Dynamic;
                assert!(!(again && moves), "body {slot} twice in a colour");
            }
        }
    }
    let colored = contacts_seen.iter().filter(|&&seen| seen).count();
    assert!(!manifolds.is_empty(), "nothing touches");
    assert_eq!(colored + coloring.overflow().len(), manifolds.len(), "a contact without a colour");
}

/// One substep's contacts of a pile, before bodies move.
struct Pass<'a> {
    solver: Solver,
    pile: &'a Pile,
    fields: Vec<Field<f32>>,
}

/// What a solver works in, for the width in use: `Solving<L>` as it was and as a pass left it.
struct PassMemory {
    motion: Motion<f32>,
    fresh: Motion<f32>,
    solving: Box<dyn Any>,
    untouched: Box<dyn Any>,
    width: usize,
}

impl Pass<'_> {
    fn task<'a>(&'a self, plan: &'a Plan<'a, f32>) -> Task<'a, f32> {
        let traits = Traits { friction: true, restitution: true, length: LENGTH_M, gravity: 9.81 };
        Task { solver: self.solver, traits, dt_secs: DT_SECS, plan }
    }

    fn plan(&self) -> Plan<'_, f32> {
        Plan {
            integrator: Integrator::VelocityVerlet,
            fields: &self.fields,
            h_secs: DT_SECS,
            substeps: 1,
            skips: Skips::NONE,
            moving: solve::pushes(self.solver),
        }
    }

    /// Constraints and rows as the first substep finds them under gravity.
    fn reset<L: Lanes<Elem = f32>>(&self, memory: &mut PassMemory) {
        if memory.width != L::WIDTH {
            let (plan, bodies) = (self.plan(), &self.pile.bodies);
            let mut solving = self.pile.solving::<L>();
            memory.motion = self.pile.motion();
            solving.begin(&self.task(&plan), bodies, &mut memory.motion);
            integrate::predict::<L>(&plan, bodies, &mut memory.motion, true);
            memory.fresh = memory.motion.clone();
            memory.untouched = Box::new(solving.clone());
            memory.solving = Box::new(solving);
            memory.width = L::WIDTH;
        }
        let expected = "built for this width above";
        let untouched = memory.untouched.downcast_ref::<Solving<L>>().expect(expected);
        memory.solving.downcast_mut::<Solving<L>>().expect(expected).clone_from(untouched);
        memory.motion.velocity.padded_mut().copy_from_slice(memory.fresh.velocity.padded());
    }

    fn pass<L: Lanes<Elem = f32>>(&self, memory: &mut PassMemory) {
        let plan = self.plan();
        let solving = memory.solving.downcast_mut::<Solving<L>>().expect("built by a reset");
        solving.solve(&self.task(&plan), &mut memory.motion, true);
    }
}

impl Stage for Pass<'_> {
    type Memory = PassMemory;

    fn elements(&self) -> usize {
        self.pile.narrow.manifolds.len()
    }

    fn memory(&self) -> PassMemory {
        let (motion, fresh) = (self.pile.motion(), self.pile.motion());
        PassMemory { motion, fresh, solving: Box::new(()), untouched: Box::new(()), width: 0 }
    }

    fn run<L: Lanes<Elem = f32>>(&self, memory: &mut PassMemory) {
        self.reset::<L>(memory);
        self.pass::<L>(memory);
    }

    fn answer(&self, memory: &PassMemory) -> Answer {
        let (after, before) = (memory.motion.velocity.fours(), memory.fresh.velocity.fours());
        let changed = after.iter().zip(before).filter(|(after, before)| after != before);
        answer_of(changed.count(), after.iter().flatten().map(|value| u64::from((value + 0.0).to_bits())))
    }

    /// A second pass would find the contacts solved: each gets constraints and rows as they were, copied into the
    /// same memory so that they stay in cache, while the clock stands.
    fn time<L: Lanes<Elem = f32>>(&self, bencher: &mut Bencher<'_>, memory: &mut PassMemory) {
        bencher.iter_custom(|passes| {
            let mut elapsed = Duration::ZERO;
            for _ in 0..passes {
                self.reset::<L>(memory);
                let start = Instant::now();
                self.pass::<L>(black_box(&mut *memory));
                elapsed += start.elapsed();
            }
            elapsed
        });
    }
}

fn solve_alone(criterion: &mut Criterion, settled: &Settled) {
    for &solver in Solver::ALL {
        let mut group = criterion.benchmark_group(format!("solve {solver}"));
        // Contacts of one point, and mostly of two.
        for mix in ["circles", "polygons"] {
            for size in SIZES {
                let pile = Pile::of(&settled.get(&format!("{mix}/{size}"), SETTLE_STEPS));
                let stage = Pass { solver, pile: &pile, fields: Forces::gravity().fields() };
                at_every_width(&mut group, mix, size, &stage, &Agreement::default());
            }
        }
        group.finish();
    }
}
