//! What all benches share: scenes, their settled states, and answers that must agree.
//!
//! A workload has one name in all of them, `group/what/bodies/xLANES`: criterion times it ([`crate::kernels`] in
//! `stages.rs`, [`crate::steps`] in `scenes.rs`), and valgrind counts its instructions (`instructions.rs`).

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::rc::Rc;

use lamina2d::internals::{PlainWorld, plain_world, step_plain};
use lamina2d::scene::{Scene, by_name};

/// Seconds per step everywhere.
pub(crate) const DT_SECS: f64 = 1.0 / 60.0;
/// Steps that let a mix fall and come to rest: the thesis's 10 s.
pub(crate) const SETTLE_STEPS: usize = 600;
/// Of every scene that draws numbers.
const SEED: u64 = 1;

/// The scene of a name like `polygons/150`.
pub(crate) fn scene(name: &str) -> Scene {
    by_name(name, None, SEED).expect("a scene of the table")
}

/// A scene's world before its first step.
pub(crate) fn world(name: &str) -> PlainWorld {
    plain_world(&scene(name)).expect("a scene that runs")
}

/// A scene's world after some steps with default settings.
pub(crate) fn step_through(name: &str, steps: usize) -> PlainWorld {
    let mut world = world(name);
    step_plain(&mut world, DT_SECS, steps).expect("a scene that stays finite");
    world
}

/// Scenes after some steps, each made once per process and only when first asked for.
#[derive(Debug)]
pub(crate) struct Settled {
    /// Makes the scene of a name after some steps.
    make: fn(&str, usize) -> PlainWorld,
    worlds: RefCell<Worlds>,
}

/// By name and steps.
type Worlds = BTreeMap<(String, usize), Rc<PlainWorld>>;

impl Settled {
    /// With what makes a scene of a name after some steps, e.g. [`step_through`].
    pub(crate) fn new(make: fn(&str, usize) -> PlainWorld) -> Self {
        Self { make, worlds: RefCell::default() }
    }

    /// The scene after `steps` steps with default settings.
    pub(crate) fn get(&self, name: &str, steps: usize) -> Rc<PlainWorld> {
        let mut worlds = self.worlds.borrow_mut();
        let world =
            worlds.entry((name.to_owned(), steps)).or_insert_with(|| Rc::new((self.make)(name, steps)));
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

/// The answers of benches, by what those have in common that must answer the same.
#[derive(Debug, Default)]
pub(crate) struct Agreement {
    firsts: RefCell<BTreeMap<String, (String, Answer)>>,
}

impl Agreement {
    /// Compares with the first answer of those that are `alike`.
    ///
    /// # Panics
    /// Where they differ.
    pub(crate) fn check(&self, alike: &str, bench: &str, answer: Answer) {
        let mut firsts = self.firsts.borrow_mut();
        let (other, expected) = firsts.entry(alike.to_owned()).or_insert_with(|| (bench.to_owned(), answer));
        assert_eq!(answer, *expected, "{bench} (left) and {other} (right) disagree");
    }
}
