//! What both bench files share: the clock's settings, settled scenes, and answers that must agree.
//!
//! A bench checks its answer where criterion first calls it, before the clock runs: `cargo test --benches`,
//! which runs each once, checks all of them.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::rc::Rc;
use std::time::Duration;

use criterion::Criterion;
use lamina2d::lanes::f32s;
use lamina2d::scene::{Scene, by_name};
use lamina2d::settings::Settings;
use lamina2d::world::World;

/// Seconds per step everywhere.
pub(crate) const DT_SECS: f64 = 1.0 / 60.0;
/// Steps that let a mix fall and come to rest: the thesis's 10 s.
pub(crate) const SETTLE_STEPS: usize = 600;
/// Of every scene that draws numbers.
const SEED: u64 = 1;

/// Samples few and short: some three hundred benches have to fit into a quarter of an hour. The command
/// line overrides.
pub(crate) fn criterion() -> Criterion {
    Criterion::default()
        .sample_size(20)
        .warm_up_time(Duration::from_millis(200))
        .measurement_time(Duration::from_millis(500))
        .nresamples(10_000)
        .configure_from_args()
}

/// The scene of a name like `polygons/150`.
pub(crate) fn scene(name: &str) -> Scene {
    by_name(name, None, SEED).expect("a scene of the table")
}

/// Scenes after some steps, each stepped once per process and only when first asked for.
#[derive(Debug, Default)]
pub(crate) struct Settled {
    worlds: RefCell<BTreeMap<String, Rc<World<f32s::X8>>>>,
}

impl Settled {
    /// The scene after `steps` steps with default settings; whoever asks again must ask for as many.
    pub(crate) fn get(&self, name: &str, steps: usize) -> Rc<World<f32s::X8>> {
        let mut worlds = self.worlds.borrow_mut();
        let world = worlds.entry(name.to_owned()).or_insert_with(|| {
            let mut world = World::from_scene(&scene(name), Settings::default()).expect("a scene that runs");
            for _ in 0..steps {
                world.step(DT_SECS).expect("a scene that stays finite");
            }
            Rc::new(world)
        });
        assert_eq!(world.steps(), steps as u64, "{name} was settled with another number of steps");
        Rc::clone(world)
    }
}

/// What a bench computed, small enough to compare.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Answer {
    /// How much of what was looked for: pairs, contacts, bodies moved.
    pub(crate) count: usize,
    /// Of every bit of it.
    pub(crate) hash: u64,
}

/// The answer of those benches that must all answer the same: set by the first that runs.
#[derive(Debug, Default)]
pub(crate) struct Agreement {
    first: RefCell<Option<(String, Answer)>>,
}

impl Agreement {
    /// Compares with the first answer.
    ///
    /// # Panics
    /// Where they differ.
    pub(crate) fn check(&self, bench: &str, answer: Answer) {
        let mut first = self.first.borrow_mut();
        let (other, expected) = first.get_or_insert_with(|| (bench.to_owned(), answer));
        assert_eq!(answer, *expected, "{bench} (left) and {other} (right) disagree");
    }
}
