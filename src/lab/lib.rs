//! The laboratory of [`lamina2d`]: how large the error is that speed costs, where the engine breaks, how fast it is beside
//! others; and what the program `lamina` is made of.
//!
//! | room | what is in it |
//! |---|---|
//! | [`report`] | experiments, plots, the page |
//! | [`accuracy`] | run time against error, case by case; settings for an error |
//! | [`stress`] | what holds, and up to where |
//! | [`wild`] | scenes from problem reports, with the right numbers |
//! | [`gate`] | instruction counts against blessed ones |
//! | [`reference`](mod@reference), [`cases`] | what references are made of, and scenes with one |
//! | [`thesis`] | the baseline engine, faithful and tidy |
//! | [`present`] | rows as tables, drawings, times, machines |
//! | [`stamp`] | which build this is |
//!
//! It uses the engine's public interface and, to time single stages, [`lamina2d::internals`].
//!
//! # What building costs
//! Crates that take over 5 s of a release build on two cores in which the engine takes 151 s (commit 61f47dc; `cargo build
//! --release --timings`), what they give, and what became of them.
//!
//! | crate | s | gives | state |
//! |---|---|---|---|
//! | parquet, with zerocopy and num-bigint | 63 | `export --parquet` | feature `parquet`, off |
//! | lz4-sys | 24 | chunks of recordings | kept: the format |
//! | clap_builder, clap_derive | 20 | the command line | kept |
//! | wide | 11 | lanes | kept |
//! | glam | 10 | `f64` vectors of scenes, `f32` of the baseline | its integer types left out: 3 |
//! | mcap, with binrw | 11 | recordings that other tools read | kept |
//! | askama, with its parser and derive | 10 | the page | kept: templates are checked when built |
//! | toml | 7 | scene files, blessed counts | kept |
//! | rustix, with all that the viewer asks of it | 11 | the width of the terminal | its features moved to tests: 1 |
//! | linreg, with syn 1 | 5 | slopes | gone: two numbers of statrs |
//! | comfy-table | 4 | tables in the terminal | without crossterm, of which nothing was used |
//!
//! The engine itself, ratios of the processor seconds of `touch src/lib.rs; cargo build --release -p lamina2d` (136 s), one after the
//! other:
//!
//! | codegen units, LTO among them | time | instructions of 150 settled polygons |
//! |---|---|---|
//! | 16, thin (cargo's default, kept) | 1 | 1 |
//! | 16, none | 0.7 before copies went | as the next |
//! | 4, none | 0.57 then, 0.95 since what knows no lanes is compiled once | 1.16; 1.02 since hot paths do without `zip`, `copy_from_slice`, `Peekable` and closures behind `&mut`, which the standard library leaves as calls |
//! | 4, thin | 0.75 then | not counted |
//! | 1 | 1.1 then, on one core | not counted |
//!
//! The baselines of [`thesis`] lost more without thin LTO than the engine: `tidy` 1.1 to 1.7 times. This package is therefore one
//! unit, and their small functions are inlined by name: as fast as with thin LTO (100 polygons, least of three alternating
//! runs, ms: tidy 0.088 for 0.096, thesis 0.29 for 0.29).
//!
//! `lto = "off"` in the profile of tests: 200 → 152 s. LLVM's passes are flat: inlining 10 %, combining 9 %, selection 7 %,
//! registers 6 %.

pub mod accuracy;
pub mod cases;
pub mod gate;
pub mod present;
pub mod reference;
pub mod report;
pub mod stamp;
pub mod stress;
pub mod thesis;
pub mod wild;
