//! Each stage's kernels alone, on the bodies of settled scenes, at every lane width.
//!
//! `group/kernel/bodies/xLANES`; an element is a body in `integrate` and `broad`, a pair in `narrow`, a contact in
//! `prepare`, `solve` and `store`, a joint in `joints`.
//!
//! | group | what runs | its answer |
//! |---|---|---|
//! | `integrate` | [`lamina2d::internals::fly`]: one step of free flight, attitudes turned | state hash, same with the closed form |
//! | `broad` | [`lamina2d::internals::BroadPhase::find`] | the pairs, same for all methods |
//! | `narrow` | [`lamina2d::internals::Narrow::run`] on the pairs of one bucket, its pose rows included | the manifolds |
//! | `prepare` | colours, batches and constraints of all contacts | the order in colours; every contact once, no dynamic body twice in a colour |
//! | `solve` | a solver's pass over contacts before bodies move, or (`_settle`, of `soft` the relaxation) after | the rows, displacements, impulses |
//! | `store` | gaps and impulses of constraints written to the pairs' rows | gaps and impulses |
//! | `proof` | an `integrate` kernel with as much, a hundredth more and twice as much to do: what `lamina gate --self-test` tells apart | state hash |
//! | `joints` | joints placed, and `soft`'s passes over them | the rows |

mod broad;
mod integrate;
mod joints;
mod narrow;
mod pile;
mod prepare;
mod solve;

use lamina2d::internals::SceneNeeds;
use lamina2d::lanes::{Lanes, f32s};
use xxhash_rust::xxh3::Xxh3Default;

use crate::common::{Answer, Settled};

/// Dynamic bodies of the scenes.
const SIZES: [usize; 2] = [150, 1000];

/// What solvers are told of the scenes: the median bounding radius of the mixes' bodies, near enough.
const TRAITS: SceneNeeds = SceneNeeds { friction: true, restitution: true, gravity: 9.81 };

/// The gap within which solvers want to hear of contacts, metres.
fn margin() -> f32 {
    TRAITS.margin(lamina2d::settings::Solver::Soft)
}

/// A kernel on one input at one width, ready to run.
pub(crate) trait Work {
    /// Elements a call handles.
    fn elements(&self) -> usize;
    /// Must [`Work::reset`] come before each call but the first?
    fn resets(&self) -> bool;
    /// Puts everything back as it was before the call.
    fn reset(&mut self);
    /// The call.
    fn run(&mut self);
    /// What the first call left in its memory.
    fn answer(&self) -> Answer;
}

/// A kernel on one input at one width.
pub(crate) struct Kernel {
    /// `group/kernel/bodies/xLANES`.
    pub(crate) name: String,
    /// Kernels that share it must give the same answer.
    pub(crate) alike: String,
    build: Build,
}

/// Makes a kernel's input and memory.
type Build = Box<dyn Fn(&Settled) -> Box<dyn Work>>;

impl Kernel {
    /// Makes its input and memory.
    pub(crate) fn build(&self, settled: &Settled) -> Box<dyn Work> {
        (self.build)(settled)
    }
}

/// All kernels.
pub(crate) fn all() -> Vec<Kernel> {
    let mut kernels = Vec::new();
    integrate::list(&mut kernels);
    broad::list(&mut kernels);
    narrow::list(&mut kernels);
    prepare::list(&mut kernels);
    solve::list(&mut kernels);
    joints::list(&mut kernels);
    kernels
}

/// One stage on one input, at any width.
trait Stage: 'static {
    /// What a call writes.
    type Memory<L: Lanes<Elem = f32>>: 'static;
    /// Does a second call find the work of the first done?
    const RESETS: bool = false;
    /// Elements a call handles.
    fn elements(&self) -> usize;
    /// The memory of a first call.
    fn memory<L: Lanes<Elem = f32>>(&self) -> Self::Memory<L>;
    /// Memory as it was before the first call; nothing unless [`Stage::RESETS`].
    fn reset<L: Lanes<Elem = f32>>(&self, _memory: &mut Self::Memory<L>) {}
    /// The call.
    fn run<L: Lanes<Elem = f32>>(&self, memory: &mut Self::Memory<L>);
    /// What the first call left in its memory.
    fn answer<L: Lanes<Elem = f32>>(&self, memory: &Self::Memory<L>) -> Answer;
}

/// A stage at one width with its memory.
struct At<L: Lanes<Elem = f32>, S: Stage> {
    stage: S,
    memory: S::Memory<L>,
}

impl<L: Lanes<Elem = f32>, S: Stage> Work for At<L, S> {
    fn elements(&self) -> usize {
        self.stage.elements()
    }
    fn resets(&self) -> bool {
        S::RESETS
    }
    fn reset(&mut self) {
        self.stage.reset::<L>(&mut self.memory);
    }
    fn run(&mut self) {
        self.stage.run::<L>(&mut self.memory);
    }
    fn answer(&self) -> Answer {
        self.stage.answer::<L>(&self.memory)
    }
}

/// Lists a stage at 1, 4, 8 and 16 lanes as `kernel/xLANES`; all widths answer alike, and alike all that say so.
fn list_widths<S: Stage>(
    kernels: &mut Vec<Kernel>,
    kernel: &str,
    alike: &str,
    stage: impl Fn(&Settled) -> S + Clone + 'static,
) {
    list_width::<f32s::X1, S>(kernels, kernel, alike, stage.clone());
    list_width::<f32s::X4, S>(kernels, kernel, alike, stage.clone());
    list_width::<f32s::X8, S>(kernels, kernel, alike, stage.clone());
    list_width::<f32s::X16, S>(kernels, kernel, alike, stage);
}

fn list_width<L: Lanes<Elem = f32> + 'static, S: Stage>(
    kernels: &mut Vec<Kernel>,
    kernel: &str,
    alike: &str,
    stage: impl Fn(&Settled) -> S + 'static,
) {
    let build = move |settled: &Settled| -> Box<dyn Work> {
        let stage = stage(settled);
        Box::new(At::<L, S> { memory: stage.memory::<L>(), stage })
    };
    let name = format!("{kernel}/x{}", L::WIDTH);
    kernels.push(Kernel { name, alike: alike.to_owned(), build: Box::new(build) });
}

/// `count` things that consist of `values`.
fn answer_of(count: usize, values: impl Iterator<Item = u64>) -> Answer {
    let mut hasher = Xxh3Default::new();
    for value in values {
        hasher.update(&value.to_le_bytes());
    }
    Answer { count, hash: hasher.digest() }
}

/// The bits of numbers; −0 counts as 0.
fn bits<'a>(values: impl IntoIterator<Item = &'a f32>) -> impl Iterator<Item = u64> {
    values.into_iter().map(|value| u64::from((value + 0.0).to_bits()))
}
