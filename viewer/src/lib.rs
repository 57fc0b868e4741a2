//! A window onto recordings of lamina2d: what a run did, frame by frame.
//!
//! ```text
//! file ─ Source ─ Pane (the frame shown, islands, trails) ─ canvas ─┐
//!                 Playback (which frame) ─ timeline, keys ──────────┼─ Viewer::show ─ window, or a PNG
//!                 rows ─ events, curves, inspector, comparison ─────┘
//! ```
//!
//! [`Viewer`] holds everything and draws itself into any egui surface: `main` gives it a window, [`screenshot`] and the
//! tests none. Panels and canvas know no files: they read a [`Source`], which a running world can be as well.
//!
//! A recording may be larger than memory: what is kept of it are its step rows, the frame shown, and a trail of a
//! bounded number of positions.

pub mod app;
pub mod canvas;
pub mod command;
pub mod events;
pub mod live;
pub mod pane;
pub mod panels;
pub mod playback;
pub mod raster;
pub mod screenshot;
pub mod source;
pub mod view;

pub use app::Viewer;
pub use live::Live;
pub use source::{Replay, Source, SourceError};
