//! The instruction gate: what `benches/instructions.rs` counts under callgrind, held against what was blessed.
//!
//! Time differs from run to run, instructions do not: the same code on the same toolchain takes the same number, on a
//! busy machine and an idle one. So a change that costs half a percent of a kernel is seen where it is made.
//!
//! | file | what |
//! |---|---|
//! | `toolchain` | what beside the code decides the counts, and the tools that take them |
//! | `run` | the bench run, its counts read |
//! | `baseline` | `reports/instructions.toml`: counts per toolchain, and why they were blessed |
//! | `compare` | old against new: kernels within 0.2 %, scenes within 1 % |
//! | `history` | `reports/history.md`: one line per blessing |
//! | `export` | the counts for other tools' dashboards |
//! | `self_test` | proof that the gate catches what it is there for |
//!
//! Nothing passes in silence: a count that is absent or 0, a bench that only one side knows, a toolchain or a file that
//! has no counts all fail.
//!
//! ```
//! # std::env::set_current_dir("../..").expect("a checkout");
//! let blessed = lamina::gate::baseline("reports/instructions.toml".as_ref())?;
//! for counts in &blessed.baseline {
//!     assert!(!counts.reasons.is_empty(), "counts of {} without a reason", counts.toolchain);
//! }
//! # Ok::<(), lamina::gate::BaselineError>(())
//! ```

mod baseline;
mod compare;
mod export;
mod history;
mod run;
mod self_test;
mod toolchain;

pub use baseline::{Baseline, BaselineError, Baselines, baseline};
pub use compare::{Comparison, Counts, Kind, Row, Verdict, compare};
pub use export::{CountsError, Document, Export, counted};
pub use history::{HEADLINE, append_history, history_line};
pub use run::{RunError, count};
pub use self_test::{Proof, prove};
pub use toolchain::{FRAMEWORK_VERSION, INSTALL, ToolError, Toolchain, commit};

/// Steps of a scene that one count covers; of a kernel it covers one call. The benches' `WINDOW_STEPS`.
pub const STEPS_PER_COUNT: u64 = 20;
