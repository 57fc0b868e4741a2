//! The laboratory of [`lamina2d`]: how large the error is that speed costs, where the engine breaks, how fast it is beside
//! others; and what the program `lamina` is made of.
//!
//! | room | what is in it |
//! |---|---|
//! | [`report`] | experiments, plots, tables, the page |
//! | [`accuracy`] | run time against error, case by case; settings for an error |
//! | [`stress`] | what holds, and up to where |
//! | [`gate`] | instruction counts against blessed ones |
//! | [`cases`], [`reference`](mod@reference) | scenes with a reference, and what references are made of |
//! | [`thesis`] | the baseline engine, faithful and tidy |
//! | [`stamp`] | which build this is |
//!
//! It uses the engine's public interface and, to time single stages, [`lamina2d::internals`].

pub mod accuracy;
pub mod cases;
pub mod gate;
pub mod reference;
pub mod report;
pub mod stamp;
pub mod stress;
pub mod thesis;
