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
//! A room knows those of lower rows and those before it in its own row; `src/tests/engine/rooms.rs` holds every `use` to it.
//!
//! | room | what is in it |
//! |---|---|
//! | package `lamina` in `src/lab` | the laboratory and the program: cases, experiments, the page; run time against error; where it breaks; instruction counts; the baseline engine |
//! | [`internals`] | what benches, laboratory and tests measure of the inside |
//! | `processor`, `record` (feature `record`) | the check that programs make first; recordings, written and read |
//! | [`session`] | a run that is acted upon, and done again from its events |
//! | [`simulation`] | a world of any precision and width behind one interface |
//! | [`world`] | the step, top to bottom |
//! | [`scene`], [`measure`] | named scenes and scene files; times, counts, errors, hash |
//! | [`broad`], [`narrow`], [`integrate`], [`solve`], [`continuous`], [`island`] | the stages, and which bodies are at rest together and sleep; none imports another's work, only what it leaves behind |
//! | [`contact`], [`motion`], [`partition`], [`seams`] | manifolds and carried impulses; the rows and displacements of a step in progress; who belongs together; what of static outlines their neighbours cover |
//! | [`body`], [`joint`], [`force`], [`event`] | columns of bodies and what they are written down as; joints; fields; what is done between steps |
//! | [`shape`], [`settings`], [`workers`] | shapes and their masses; what a run may choose; threads, and what they share out |
//! | [`mod@column`], [`vec2`], [`pair`], [`clock`] | aligned columns; vectors and rotations; pairs of numbers in files; fixed steps |
//! | [`each`], [`lanes`] | arrays mapped by loops; lanes, the only room that names `wide` |
//!
//! # One step
//! | stage | reads | writes |
//! |---|---|---|
//! | act, where something is due or pulled | events of the scene | bodies, joints, fields, settings |
//! | drive | pose of bodies with a pivot | their velocity |
//! | broad | position, bounding radius, attitude of long bodies; velocity where something is fast | candidate pairs, a < b, in order |
//! | narrow, where bodies have moved | pose, shape, velocity, pairs; which faces of statics neighbours cover | manifolds, polygons' world rows |
//! | prepare, where manifolds are new | manifolds, masses | a lane of a colour's list per contact, in which its gaps and impulses live from then on |
//! | joints | pose; joints where they have changed | arms, gaps and angles; batches |
//! | begin | constraints, velocity | warm start per body, approaches that will bounce |
//! | per substep: predict | position, velocity, fields, warm start | solver rows, free velocity, displacement; of bodies whose fields it cannot follow, by what those do exactly |
//! | per substep: solve | constraints of joints (hard trees and nets at once), then of contacts (those of masses far apart at once), rows | rows, impulses |
//! | per substep: advance | rows | velocity rows, displacement |
//! | per substep: relax | constraints, rows | rows, impulses (`soft`: relaxation and friction; others: positions) |
//! | end, finish | rows, displacement; where bodies are deep in each other: gaps | velocity, position, attitude, who moved, who is fast |
//! | continuous, where bodies are fast | pose at the step's beginning, shapes, pairs | pose and velocity of those that meet something |
//! | measure | pose, velocity | finite check, counts; with bounds on speed or energy: those |
//! | update_sleep (with `sleep`) | pose, velocity, touching pairs, joints | time quiet; of what falls asleep: velocity 0, runs, pairs at rest |
//!
//! Where nothing touches and nothing is joined, predict to finish are one pass over the columns ([`integrate::fly`]). Where nothing has
//! moved since the last step (a settled pile), narrow, prepare and begin do nothing at all: constraints, impulses
//! and the warm start are still in place. With [`settings::Settings::sleep`] a step goes over blocks and pairs that
//! hold something awake, and where nothing is it ends after drive ([`island`]).
//!
//! # Invariants
//! 1. Lane width, thread count, debug or release never change a bit of a result. Kernels use + − × ÷ √,
//!    comparisons and select; no fused or approximate operation, no sum across lanes. Golden hashes
//!    (`src/tests/golden.rs`) hold every width and build to it.
//! 2. Columns are whole lanes; padding is inert (no mass, out of reach). There are no tail loops.
//! 3. A colour of contacts, or of joints, holds no dynamic body twice. Order comes from body and pair ids, never from memory or time.
//! 4. Enums are matched once per stage, bucket or block, never per lane value. Width 1 is the scalar version.
//! 5. After warm-up a step allocates only where a count reaches a new maximum.
//! 6. A kernel answers for each lane as if it were alone: which pairs share a batch changes nothing.
//! 7. `unsafe` is forbidden; the library does no I/O but for reading a scene file it is asked for. What threads cannot do without
//!    is in `lamina-team` (`src/team`), whose head says why it holds and how it is checked.
//! 8. Bad input is refused where it enters, naming body, field and value; a state that turns non-finite
//!    stops the run with step, body and stage; so does, where a bound is set, a body that runs away or energy from nothing.
//!
//! # Conventions
//! Normals point from A to B; metres, kilograms, seconds, radians; y up; angles counter-clockwise. A body
//! stands where its centroid is. `_world` and `_body` name a frame where both exist.
//!
//! # Levers
//! Instructions per step of 150 settled polygons (270 contacts), `soft`, 4 substeps, by callgrind, of a pile that is left
//! alone: steps 600 to 620 of `lamina run polygons/150` (181,414 at commit 61f47dc, 181,737 in steps 1800 to 1820; 187,997 and
//! 184,789 with 276 contacts since tolerances are of pairs, as it piles up otherwise). The gate's scene of the same name counts
//! 309,674 (347,816 then): it takes over poses and velocities, not impulses, so that its pile moves
//! again, and finds and prepares its contacts in every step.
//!
//! | lever | state |
//! |---|---|
//! | bytes per contact | 92 with two points (goal 96), 72 with one (goal 48 for circles: masses, both levers and places would have to go); friction is one row per contact, not per point |
//! | warm start per body | kept: one pass over contacts per step instead of one per substep, none while nothing moves |
//! | nothing moved, nothing redone | 239,000 → 171,000: gaps and impulses stay in the constraints, manifolds are not looked at; 178,000 since islands and substep groups came: 69 per contact and push, 50 per contact and relaxation |
//! | little moved, little redone | polygons/10000 with 100 of 26,000 pairs to look at: only constraints beside those are prepared, 1.99 → 1.70 ms |
//! | slots checked once per visit | 239,000 → 215,000 together with closures the compiler had left as calls |
//! | narrow and broad phase in lanes | kept; manifolds are coded as numbers, so that a batch is written without a branch per lane |
//! | contacts keep their lane | kept: one that comes or goes touches its colour alone. Against cutting all batches anew and handing gaps and impulses back to pairs: prepare of spinner/2000 350 → 238 µs, tumbler/2000 383 → 267, pyramid/100 965 → 752, polygons/10000 falling 2690 → 2510; narrow, which now notes who comes and goes, takes 1 to 5 % more |
//! | cache blocking | lost: polygons/10000 in the order of their rows and shuffled at random solve alike (1.63, 1.69 ms against 1.13, 1.66): the rows of 10,000 bodies are 160 kB, any order of them stays in L2 while constraints stream by |
//! | threads | kept, as many as are asked for ([`workers`]): the same bits; pyramid/100 with two 0.75 to 0.9 of the time with one, polygons/10000 falling 0.95 to 1.0: half of its step (lists, sorting, bounces, continuous collision) is still one thread's, and reads from the other core what that wrote |
//! | substeps per island | kept: a slender stack gets those it stands with unasked (columns/40 12, where it falls with 4 for all), every island its own by a bound on the sag |
//! | 16 lanes | same bits; slower than 8 without AVX-512 in the target |
//! | lazy work | free flight, closed forms, absent friction and bounces: see the report's table of skips |
//!
//! # Tried and lost
//! - The points of a face one after the other: a resting box turned at 0.02 rad/s, columns of 40 leaned and fell.
//! - Stiffness 0.25/h instead of 0.18/h: a pyramid of base 50 shook for ever.
//! - κ ≥ 0.5 (the softness acting on λ − κ·λ_warm): sag shrinks, but columns of ten shake at 0.05 to 0.3 m/s;
//!   the same with κ·λ low-pass filtered over 3 to 300 substeps.
//! - Friction before the normals in the relaxation, two relaxations per push: no calmer, or 40 % dearer.
//! - `impulse` as the default: one pass without memory lets 150 polygons sink into each other by 22 cm on
//!   average and keeps them boiling.
//! - One counting sort of pairs by a and a small sort per run: twice the instructions of two counting sorts.
//! - Loops over a counted number of polygon edges: a third more instructions than unrolled to 4, 6 or 8.
//! - Friction asked at run time in the passes of `xpbd` and `pgs`, instead of two compiled ones each: 5 to 8 % more
//!   instructions of a pass for 1 % less code. `impulse` has it so: 1.5 %.
//! - Fields that vary inlined into every stage of every scheme: 14 to 18 % more instructions of `rk4`, `velocity_verlet` and
//!   `yoshida4` than in one call per block ([`force`]).
//! - Integrating velocities of the lanes in use alone, where a world is smaller than a block: valgrind does not know an
//!   instruction the compiler makes of it at width 1. Positions are integrated so.
//! - `array::from_fn` inside a gather, or a closure called four times in one: left as calls by the compiler, 12 and 7 % of a step.
//! - Slots of a batch handed to a pass by a function instead of copied in it: passes 15 to 20 % slower.
//! - Threads by rayon's `join`, each worker with rows of its own that every pass copies in and takes back: no faster on two cores. 25
//!   wake-ups a step, or a core that spins; rows cross between cores twice a pass. Rows must stay with their worker.
//! - Slots of a batch counted from a part's first by a subtraction in each visit: 33 instructions a batch, 2.7 % of a push and 8.6 %
//!   of a relaxation. They are counted so in the lists, and passes are handed rows from there on.
//! - `zip` over slots in a gather of joints: left as calls, twice the instructions of placing them; a loop over `WIDTH` a third fewer
//!   than the closure there was.
//! - Columns' slices taken inside a loop over lanes that also stores: looked up again after every store, 6 to 12 % more
//!   instructions of a relaxation and of integrating positions. `L::WIDTH` entries from `at * L::WIDTH` instead of a range in
//!   `load_four`: 7 % more of a prediction.

#![allow(
    rustdoc::private_intra_doc_links,
    reason = "the architecture names rooms that are not public; --document-private-items shows them"
)]

pub mod body;
mod broad;
pub mod clock;
pub mod column;
pub mod contact;
mod continuous;
mod each;
pub mod event;
pub mod force;
mod integrate;
mod island;
pub mod joint;
pub mod lanes;
pub mod measure;
mod motion;
mod narrow;
mod pair;
mod partition;
#[cfg(feature = "record")]
pub mod processor;
#[cfg(feature = "record")]
pub mod record;
pub mod scene;
mod seams;
pub mod session;
pub mod settings;
pub mod shape;
pub mod simulation;
mod solve;
pub mod vec2;
mod workers;
pub mod world;

#[doc(hidden)]
pub mod internals;
