//! lamina2d.

pub mod body;
pub mod column;
pub mod force;
pub mod integrate;
pub mod lanes;
pub mod scene;
pub mod settings;
pub mod shape;
pub mod vec2;
