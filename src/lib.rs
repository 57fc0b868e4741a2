//! lamina2d.

pub mod body;
pub mod broad;
pub mod clock;
pub mod column;
pub mod contact;
pub mod force;
pub mod integrate;
pub mod lanes;
pub mod measure;
pub mod narrow;
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
