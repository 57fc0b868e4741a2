//! What runs are held against: special functions and a solver of ordinary differential equations for closed and
//! converged courses, and what can still be said where courses are chaotic. Nothing of the engine is used.

pub mod chaos;
pub mod elliptic;
pub mod kepler;
pub mod ode;
