//! Solvers: one per file, all on the same manifolds and colours.
//!
//! A solver changes the rows of [`crate::integrate::Motion`] (velocity and displacement per body) and
//! nothing else. Contacts of one colour share no dynamic body, so the lanes of a batch never meet; static
//! and kinematic bodies may occur in many lanes, but no mass moves them and their rows keep their values.

pub mod color;
mod constraint;
mod impulse;
mod pgs;

use crate::column::Column;
use crate::contact::{Impulses, Manifolds};
use crate::lanes::{Lanes, Real};
use crate::settings::{Skip, Skips, Solver};

use color::Coloring;

/// What a solver needs to know of the scene.
#[derive(Clone, Copy, Debug)]
pub struct Traits {
    /// Some body has friction.
    pub friction: bool,
    /// Some body bounces.
    pub restitution: bool,
}

impl Traits {
    /// The terms a solver must have, given what may be left out.
    #[must_use]
    pub fn needed(self, skips: Skips) -> Self {
        Self {
            friction: self.friction || !skips.has(Skip::Friction),
            restitution: self.restitution || !skips.has(Skip::Restitution),
        }
    }
}

/// Runs one substep of `h_secs` of the chosen solver over all colours.
pub fn solve<L: Lanes>(
    solver: Solver,
    traits: Traits,
    h_secs: f64,
    manifolds: &Manifolds<L::Elem>,
    impulses: &mut Impulses<L::Elem>,
    coloring: &Coloring,
    rows: &mut Column<L::Elem>,
) {
    match solver {
        Solver::Impulse => impulse::solve::<L>(traits, manifolds, coloring, rows),
        Solver::Pgs => pgs::solve::<L>(traits, h_secs, manifolds, impulses, coloring, rows),
    }
}

/// Does a solver begin with the impulses of the last step?
pub fn carries_impulses(solver: Solver) -> bool {
    match solver {
        Solver::Impulse => false,
        Solver::Pgs => true,
    }
}

/// The smallest margin within which a solver wants to hear of contacts, metres.
pub fn margin<R: Real>(solver: Solver) -> R {
    match solver {
        Solver::Impulse => R::ZERO,
        Solver::Pgs => R::from_f64(pgs::MARGIN_M),
    }
}
