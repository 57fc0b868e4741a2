//! A data-oriented SIMD 2D rigid-body engine built to be measured: how fast a scene of any shape mix runs,
//! how large the error is that the speed costs, and where it breaks.
//!
//! ```
//! use lamina2d::{lanes::f32s, scene, settings::Settings, world::World};
//!
//! let scene = scene::by_name("stack/3", None, 1)?;
//! let mut world = World::<f32s::X8>::from_scene(&scene, Settings::default())?;
//! for _ in 0..60 {
//!     world.step(1.0 / 60.0)?;
//! }
//! assert_eq!(world.contacts().len(), 3);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Rooms
//! Dependencies run downward only.
//!
//! | room | what is in it |
//! |---|---|
//! | `report`, `cli` (feature `cli`) | experiments, plots, the page; the program `lamina` |
//! | [`simulation`] | a world of any precision and width behind one interface |
//! | [`thesis`] | the baseline engine, faithful and tidy |
//! | [`scene`], [`measure`], [`clock`] | named scenes and scene files; times, counts, errors, hash; fixed steps |
//! | [`world`] | the step, top to bottom |
//! | [`broad`], [`narrow`], [`integrate`], [`solve`] | the stages; they never import each other |
//! | [`island`] | which bodies are at rest together and sleep |
//! | [`contact`], [`force`], [`body`], [`drive`], [`shape`] | manifolds and carried impulses; fields; columns; driven bodies; shapes |
//! | [`mod@column`], [`vec2`], [`lanes`] | aligned columns; vectors and rotations; the only file that names `wide` |
//!
//! # One step
//! | stage | reads | writes |
//! |---|---|---|
//! | drive | pose of bodies with a pivot | their velocity |
//! | broad | position, bounding radius, attitude of long bodies | candidate pairs, a < b, in order |
//! | narrow | pose, shape, pairs | manifolds, polygons' world rows |
//! | prepare | manifolds, last impulses | carried impulses, colours, batches |
//! | per substep: predict | position, velocity, fields | solver rows, free velocity, displacement |
//! | per substep: solve | manifolds, batches, rows | rows, impulses |
//! | per substep: correct | rows | velocity, displacement since the step began |
//! | finish | displacement | position, attitude |
//! | doze (with `sleep`) | velocity, touching pairs | time quiet; of what falls asleep: velocity 0, runs, watched pairs |
//! | measure | pose, velocity | finite check, counts |
//!
//! Where nothing touches, predict to finish are one pass over the columns ([`integrate::fly`]). With
//! [`settings::Settings::sleep`] a step goes over blocks and pairs that hold something awake, and where nothing is it
//! ends after drive ([`island`]).
//!
//! # Invariants
//! 1. Lane width, thread count, debug or release never change a bit of a result. Kernels use + − × ÷ √,
//!    comparisons and select; no fused or approximate operation, no sum across lanes. Golden hashes
//!    (`src/tests/golden.rs`) hold every width and build to it.
//! 2. Columns are whole lanes; padding is inert (no mass, out of reach). There are no tail loops.
//! 3. A colour holds no dynamic body twice. Order comes from body and pair ids, never from memory or time.
//! 4. Enums are matched once per stage, bucket or block, never per lane value. Width 1 is the scalar version.
//! 5. After warm-up a step allocates only where a count reaches a new maximum.
//! 6. A kernel answers for each lane as if it were alone: which pairs share a batch changes nothing.
//! 7. `unsafe` is forbidden; the library does no I/O but for reading a scene file it is asked for.
//! 8. Bad input is refused where it enters, naming body, field and value; a state that turns non-finite
//!    stops the run with step, body and stage.
//!
//! # Conventions
//! Normals point from A to B; metres, kilograms, seconds, radians; y up; angles counter-clockwise. A body
//! stands where its centroid is. `_world` and `_body` name a frame where both exist.
//!
//! # Tried and lost
//! - Positional correction and velocity one point after the other: a resting box turned at 0.02 rad/s.
//! - `impulse` as the default: one pass without memory lets 150 polygons sink into each other by 22 cm on
//!   average and keeps them boiling; [`settings::Solver::Pgs`] goes over the contacts twice (warm
//!   start and solve) but finds a quarter fewer, because bodies stay apart.
//! - One counting sort of pairs by a and a small sort per run: twice the instructions of two counting sorts.
//! - Loops over a counted number of polygon edges: a third more instructions than unrolled to 4, 6 or 8.
//! - `array::from_fn` inside a gather: left as a call by the compiler, 12 % of a step.

pub mod body;
pub mod broad;
pub mod clock;
pub mod column;
pub mod contact;
pub mod drive;
pub mod force;
pub mod integrate;
pub mod island;
pub mod lanes;
pub mod measure;
pub mod narrow;
mod pair;
#[cfg(feature = "cli")]
pub mod report;
pub mod scene;
pub mod settings;
pub mod shape;
pub mod simulation;
pub mod solve;
pub mod thesis;
pub mod vec2;
pub mod world;
