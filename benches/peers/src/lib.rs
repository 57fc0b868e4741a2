//! lamina2d beside Box2D and rapier: the same scenes, body for body, in one run.
//!
//! | room | what is in it |
//! |---|---|
//! | [`blueprint`] | a scene as every engine gets it: placed by centroids, masses reckoned once |
//! | [`engine`] | what an engine is; which one to build, with what |
//! | [`ours`], [`box2d`], [`rapier`] | the engines |
//! | [`plan`], [`run`] | what is run; windows of steps in which the engines take turns |
//! | [`wild`] | scenes from problem reports, every engine held to the same numbers |
//! | [`row`], [`about`] | what is printed: of each run, of each engine's build |
//!
//! Alike for all: shapes, poses, masses, friction and restitution (the smaller of a pair's two), categories,
//! driven bodies, constant forces, gravity, joints. Their own: contact margins, softness, thresholds and
//! continuous collision, as each engine comes. What an engine cannot express is a [`engine::Gap`], never
//! something near it.

pub mod about;
pub mod blueprint;
pub mod box2d;
pub mod engine;
pub mod ours;
pub mod plan;
pub mod rapier;
pub mod row;
pub mod run;
pub mod wild;
