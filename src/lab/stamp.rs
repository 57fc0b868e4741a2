//! The build of this program: what reports and recordings say of where their numbers come from.

use lamina2d::record::Stamp;

/// Compiler, commit and flags, as the build script found them.
pub const STAMP: Stamp =
    Stamp { commit: env!("LAMINA_COMMIT"), rustc: env!("LAMINA_RUSTC"), flags: env!("LAMINA_FLAGS") };

/// Profile and optimisation level.
pub const PROFILE: &str = env!("LAMINA_PROFILE");
