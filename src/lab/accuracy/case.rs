//! What a case is: a scene, what its error is, how it is swept, and what is expected of each method.

use serde::Serialize;

use lamina2d::scene::{Scene, SceneError};
use lamina2d::settings::{Integrator, Settings, Solver, StiffFields};

use super::contact::Experiment;
use crate::cases::{self, Exact, by_name, smooth};

/// How a case is stepped.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Method {
    /// Smooth motion.
    pub integrator: Integrator,
    /// Contacts and joints; `None` where there are none, so that none is used.
    pub solver: Option<Solver>,
    /// Rounds per step.
    pub substeps: u32,
    /// Of soft contacts, hz·h; `None` for the default.
    pub stiffness: Option<f64>,
}

impl Method {
    /// An integrator alone.
    pub const fn alone(integrator: Integrator) -> Self {
        Self { integrator, solver: None, substeps: 1, stiffness: None }
    }

    /// The settings it stands for; precision and lanes are those of `settings`.
    #[must_use]
    pub fn settings(self, settings: Settings) -> Settings {
        let Self { integrator, solver, substeps, stiffness } = self;
        // What a method does, not what is done where it cannot.
        let stiff_fields = Some(StiffFields::Scheme);
        let solver = solver.unwrap_or(settings.solver);
        Settings { integrator, solver, substeps, stiffness, stiff_fields, ..settings }
    }
}

impl std::fmt::Display for Method {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self.solver {
            Some(solver) => {
                write!(f, "{solver} ×{}", self.substeps)?;
                self.stiffness.map_or(Ok(()), |stiffness| write!(f, " at {stiffness}"))?;
                write!(f, " {}", self.integrator)
            }
            None => write!(f, "{}", self.integrator),
        }
    }
}

/// What is expected of a method on a case.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Expect {
    /// This order in `f64`, to within [`super::TOLERANCE`].
    Order(f64),
    /// No error but round-off: at most so many times n·ε of the precision after n steps.
    Exact(f64),
    /// At most this error with the shortest step, in `f64`.
    AtMost(f64),
    /// At least this error with the shortest step: what a test that can tell must see.
    AtLeast(f64),
    /// At most this error, in each row alone: contact has no order to expect.
    Target(f64),
    /// Up to the stability limit the amplitude stays, beyond it grows: see [`Sweep::Limits`].
    Limit,
}

impl std::fmt::Display for Expect {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Order(order) => write!(f, "order {order}"),
            Self::Exact(_) => write!(f, "exact"),
            Self::AtMost(error) | Self::Target(error) => write!(f, "<= {error:e}"),
            Self::AtLeast(error) => write!(f, ">= {error:e}"),
            Self::Limit => write!(f, "stability limit"),
        }
    }
}

/// What is measured of a state.
#[derive(Clone, Copy, Debug)]
pub enum Norm {
    /// Distance from the exact place over this length, metres: the largest of all movable bodies and samples.
    Place(f64),
    /// The chord between attitude and exact attitude, rad where it is small.
    Turn,
    /// |E − E₀| over this energy, J: the largest over all steps.
    Energy(f64),
    /// |L/L₀ − 1| of the angular momentum, largest over all steps.
    Momentum,
    /// How far the apsis has turned, rad, largest over all steps.
    Apsis,
    /// ||r| − 1 m| of the last body from the origin, largest over all steps.
    Length,
    /// Largest |x| over the first.
    Growth,
    /// What the case's own experiment finds.
    Own(Experiment),
}

/// Which steps a case is run with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Sweep {
    /// So many steps over the horizon at first, doubled so many times, fewer times in a quick run.
    Halvings {
        /// At first; a multiple of the samples.
        coarsest: u32,
        /// In a quick run.
        quick: u32,
        /// In a full run.
        full: u32,
    },
    /// Shares of the longest stable hω of each integrator in [`Integrator::ALL`]'s order; 0 where none is stable.
    Limits {
        /// Of the oscillator, rad/s.
        rate: f64,
        /// Longest stable hω.
        limits: [f64; 6],
    },
}

/// A case of the laboratory.
#[derive(Clone, Copy, Debug)]
pub struct Case {
    /// Its name, as on the command line and in file names.
    pub name: &'static str,
    /// Its item in the list of cases: `A5`.
    pub item: &'static str,
    /// What it shows.
    pub about: &'static str,
    /// The scene it runs.
    pub scene: &'static str,
    /// Seconds run.
    pub horizon_secs: f64,
    /// Times at which the place is compared, spread evenly, the last at the horizon.
    pub samples: u32,
    /// Its error.
    pub norm: Norm,
    /// The error's unit; `relative` where it is one of lengths and may be compared between cases.
    pub unit: &'static str,
    /// Its steps.
    pub sweep: Sweep,
    /// Its methods, and what is expected of each.
    pub methods: &'static [(Method, Expect)],
}

/// What is asked of the engine and cannot run.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Failing {
    /// Its name.
    pub name: &'static str,
    /// Why.
    pub reason: &'static str,
}

/// So many times better than the best point that is plotted must a reference be.
const GATE: f64 = 100.0;

/// Where bodies must be, at each sample, and how sure that is.
#[derive(Clone, Debug)]
pub struct Reference {
    /// Per sample; empty for norms that need none.
    pub course: Vec<Vec<Exact>>,
    /// How sure it is, in the norm's unit: 0 where it is a number the run began with, round-off where the form is closed, else four times the difference that
    /// half the step makes; other methods were never further away.
    pub floor: f64,
    /// What is below says nothing: a hundred times the floor, 0 where the form is closed.
    pub gate: f64,
}

impl Case {
    /// Its scene.
    ///
    /// # Errors
    /// Those of [`by_name`]: a table that names a scene there is not.
    pub fn scene(&self) -> Result<Scene, SceneError> {
        by_name(self.scene, None, 1)
    }

    /// Is it one of table B, or one of the mixes: about contact?
    pub fn is_contact(&self) -> bool {
        matches!(self.norm, Norm::Own(_))
    }

    /// Is it one of a shape mix?
    pub fn is_mix(&self) -> bool {
        self.item == "M"
    }

    /// Does one error of it take so many runs that a quick sweep of all cases leaves it out?
    pub fn is_ensemble(&self) -> bool {
        self.unit == "standard errors"
    }

    /// The times of its samples, seconds.
    pub fn times(&self) -> Vec<f64> {
        let of = |k: u32| self.horizon_secs * f64::from(k) / f64::from(self.samples);
        (1..=self.samples).map(of).collect()
    }

    /// Where the bodies of its scene must be.
    pub fn reference(&self, scene: &Scene) -> Reference {
        if self.norm.at_every_step() {
            return Reference { course: Vec::new(), floor: 0.0, gate: 0.0 };
        }
        let times = self.times();
        let size = if let Norm::Place(size) = self.norm { size } else { 1.0 };
        let closed: Option<Vec<_>> = times.iter().map(|&t| cases::exact(scene, t)).collect();
        if let Some(course) = closed {
            return Reference { course, floor: f64::EPSILON, gate: 0.0 };
        }
        let Some(problem) = smooth::converged(self.scene) else {
            return Reference { course: Vec::new(), floor: f64::EPSILON, gate: 0.0 };
        };
        let [coarse, fine] = [1, 2].map(|refined| problem.course(&times, refined));
        let pairs = coarse.iter().flatten().zip(fine.iter().flatten());
        let apart = pairs.map(|(a, b)| (a[0] - b[0]).hypot(a[1] - b[1])).fold(0.0, f64::max);
        let exact = |places: &Vec<[f64; 2]>| {
            let movable = super::norm::movable(scene).map(|(body, spec)| (body, spec.angle));
            let place = |((body, angle), &position)| Exact { body, position, angle };
            movable.zip(places).map(place).collect()
        };
        let floor = (4.0 * apart / size).max(4.0 * f64::EPSILON);
        Reference { course: fine.iter().map(exact).collect(), floor, gate: GATE * floor }
    }
}
