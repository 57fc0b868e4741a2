//! What a run may choose: precision, lanes, threads, integrator, solver, broad phase, step, skips, sleep.

mod error;
mod skips;
mod threads;

use serde::{Deserialize, Serialize};

use crate::lanes::Real;

pub use error::SettingsError;
pub use skips::Skips;
pub use threads::{MOST_THREADS, Threads};

/// Stiffness: hz·h, the contact's frequency as a share of the substep rate.
///
/// Sag falls with its square, so the largest that stays calm. Measured at 4 substeps of 1/240 s: at 0.25 a pyramid
/// of base 50 shakes for ever (54 J after 20 s), at 0.18 it rests (4e-6 J), at 0.125 too (2e-10 J) with twice the sag.
pub const HERTZ_TIMES_SUBSTEP: f64 = 0.18;

/// A value that is not among the choices.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("unknown {what} '{given}': one of {choices}")]
pub struct UnknownName {
    /// What was asked for, e.g. `integrator`.
    pub what: &'static str,
    /// What was given.
    pub given: String,
    /// The choices, separated by commas.
    pub choices: String,
}

/// Declares an enum whose variants have one name each, for the command line, scene files and JSON alike.
macro_rules! named_enum {
    ($(#[$meta:meta])* $name:ident, $what:literal, $($(#[$vmeta:meta])* $variant:ident = $text:literal),+ $(,)?) => {
        $(#[$meta])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
        pub enum $name {
            $($(#[$vmeta])* #[serde(rename = $text)] $variant,)+
        }

        impl $name {
            /// Every choice, in order.
            pub const ALL: &'static [Self] = &[$(Self::$variant),+];
            /// The name users write.
            pub const fn name(self) -> &'static str {
                match self { $(Self::$variant => $text,)+ }
            }
        }

        impl std::fmt::Display for $name {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.pad(self.name())
            }
        }

        impl std::str::FromStr for $name {
            type Err = UnknownName;
            fn from_str(given: &str) -> Result<Self, UnknownName> {
                Self::ALL.iter().copied().find(|v| v.name() == given).ok_or_else(|| UnknownName {
                    what: $what,
                    given: given.to_owned(),
                    choices: Self::ALL.iter().map(|v| v.name()).collect::<Vec<_>>().join(", "),
                })
            }
        }
    };
}

named_enum! {
    /// How smooth motion is advanced; one file each in [`crate::integrate`].
    Integrator, "integrator",
    /// x += hv; v += ha. Order 1, gains energy.
    ExplicitEuler = "explicit_euler",
    /// v += ha; x += hv. Order 1, symplectic. The thesis's "Euler".
    SemiImplicitEuler = "semi_implicit_euler",
    /// Velocity Verlet with predicted velocity. Order 2.
    VelocityVerlet = "velocity_verlet",
    /// Position Verlet (leapfrog: drift, kick, drift). Order 2 for forces of position.
    PositionVerlet = "position_verlet",
    /// The classical Runge–Kutta method. Order 4.
    Rk4 = "rk4",
    /// Yoshida's composition of three leapfrogs. Order 4 for forces of position, symplectic.
    Yoshida4 = "yoshida4",
}

named_enum! {
    /// How contacts are resolved; one file each in [`crate::solve`].
    Solver, "solver",
    /// The thesis's method, cleaned: one pass, positional correction.
    Impulse = "impulse",
    /// Sequential impulses with warm start and Baumgarte bias.
    Pgs = "pgs",
    /// Substepped soft contacts: the default.
    Soft = "soft",
    /// Small steps of position-based dynamics.
    Xpbd = "xpbd",
    /// Augmented vertex block descent.
    Avbd = "avbd",
}

named_enum! {
    /// Which bodies may touch; see [`crate::broad`].
    Broad, "broad phase",
    /// Every pair goes to the narrow phase: for measuring.
    Off = "off",
    /// Each body against all later ones, in lanes.
    Brute = "brute",
    /// Sorted along x.
    Sweep = "sweep",
    /// Cells sorted by row, levels by size.
    Grid = "grid",
    /// Picks by counts.
    Auto = "auto",
}

named_enum! {
    /// What advances a body whose fields a substep of its scheme cannot follow; see [`crate::integrate`].
    StiffFields, "way with stiff fields",
    /// What those fields do exactly: drag decays, springs and magnetic fields turn.
    Exact = "exact",
    /// The scheme, which leaves such a body: for seeing where.
    Scheme = "scheme",
}

named_enum! {
    /// The scalar a world is built on.
    Precision, "precision",
    /// 32-bit floats.
    F32 = "f32",
    /// 64-bit floats.
    F64 = "f64",
}

named_enum! {
    /// How long a step is.
    Stepping, "stepping",
    /// A fixed step; real time is caught up with by an accumulator.
    Fixed = "fixed",
    /// The frame's own duration: for contrast, not reproducible.
    Variable = "variable",
}

named_enum! {
    /// Work that is left out when a scene does not need it. All but `manifold_reuse` give the same bits on or off.
    Skip, "skip",
    /// Under constant force every integrator of order ≥ 2 collapses to x + hv + ½h²a, v + ha.
    ClosedForm = "closed_form",
    /// With no contact at all the step is one pass over the columns.
    FreeFlight = "free_flight",
    /// Nothing spins and no torque acts: attitudes are not touched.
    Rotation = "rotation",
    /// No body has friction: no tangent rows.
    Friction = "friction",
    /// No body bounces: no restitution terms.
    Restitution = "restitution",
    /// A list of candidate pairs is found with a skin and serves until a body has moved half of it.
    PairList = "pair_list",
    /// A pair whose bodies have hardly moved keeps its manifold; see [`crate::motion::CONTACT_REUSE_DISTANCE`] for the bound.
    ManifoldReuse = "manifold_reuse",
}

impl Precision {
    /// The shortest step, seconds: solvers take 1/h of a substep, down to a thousandth of the step, times lengths and masses,
    /// which single precision loses above 1e38.
    pub fn shortest_step_secs(self) -> f64 {
        match self {
            Self::F32 => 1e-24,
            Self::F64 => 1e-200,
        }
    }

    /// The precision of a scalar.
    pub fn of<R: Real>() -> Self {
        if R::NAME == Self::F64.name() { Self::F64 } else { Self::F32 }
    }
}

/// What a run may choose; written down as in scene files.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Settings {
    /// Seconds per step.
    #[serde(rename = "dt")]
    pub dt_secs: f64,
    /// Smooth motion.
    pub integrator: Integrator,
    /// Contacts.
    pub solver: Solver,
    /// Integrate-and-solve rounds per step; contacts are found once per step.
    pub substeps: u32,
    /// Candidate pairs.
    pub broad: Broad,
    /// Numbers per vector: 1, 4, 8, 16 (f32) or 1, 4 (f64). Never changes a bit of a result.
    pub lanes: usize,
    /// The scalar.
    pub precision: Precision,
    /// How many threads a step is done by; left out where it is one. Never changes a bit of a result.
    #[serde(default, skip_serializing_if = "Threads::is_one")]
    pub threads: Threads,
    /// Work left out where a scene does not need it.
    #[serde(rename = "skip")]
    pub skips: Skips,
    /// Do fast bodies stop at what is in their way; see [`crate::continuous`].
    pub continuous: bool,
    /// Islands of bodies at rest fall asleep; see [`crate::island`].
    pub sleep: bool,
    /// Each island has as many substeps as keep its contacts from sagging by more, metres; see [`crate::solve::substep_group`].
    /// `substeps` is then what bodies have that touch nothing.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub max_sag: Option<f64>,
    /// All islands have `substeps`, slender stacks too, which `soft` else gives as many as keep them from buckling; see
    /// [`crate::solve::slender_stack`].
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub fixed_substeps: bool,
    /// What advances a body whose fields its scheme cannot follow; `None` for [`StiffFields::Exact`].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stiff_fields: Option<StiffFields>,
    /// Stiffness of soft contacts, hz·h: their frequency as a share of the substep rate, over 0 up to
    /// [`MOST_STIFF`]; `None` for [`HERTZ_TIMES_SUBSTEP`], the stiffest that stays calm.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stiffness: Option<f64>,
    /// What centroids are kept in: `f64` with a scalar of `f32` keeps what their columns leave out; see
    /// [`crate::body::Bodies::fine`], for 1.8 % more instructions of a settled step (bench `checks/positions`). `None`: the
    /// scalar.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub positions: Option<Precision>,
    /// A step that ends with a dynamic body faster than this, m/s, is refused; see [`crate::world`].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub max_speed: Option<f64>,
    /// A step that ends with so much more kinetic and potential energy than there was, J, is refused.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub max_gain: Option<f64>,
}

/// Half a swing a substep: beyond, a spring turns faster than substeps can see.
pub const MOST_STIFF: f64 = 0.5;

impl Default for Settings {
    fn default() -> Self {
        Self {
            dt_secs: 1.0 / 60.0,
            integrator: Integrator::VelocityVerlet,
            solver: Solver::Soft,
            substeps: 4,
            broad: Broad::Auto,
            lanes: 8,
            precision: Precision::F32,
            threads: Threads::ONE,
            skips: Skips::ALL,
            continuous: true,
            sleep: false,
            max_sag: None,
            fixed_substeps: false,
            stiff_fields: None,
            stiffness: None,
            positions: None,
            max_speed: None,
            max_gain: None,
        }
    }
}

impl Settings {
    /// Lane widths of a precision.
    pub const fn widths(precision: Precision) -> &'static [usize] {
        match precision {
            Precision::F32 => &[1, 4, 8, 16],
            Precision::F64 => &[1, 4],
        }
    }

    /// The same settings with the widest lanes of `precision` that the default uses: 8 × f32, 4 × f64.
    #[must_use]
    pub fn with_precision(self, precision: Precision) -> Self {
        let lanes = match precision {
            Precision::F32 => 8,
            Precision::F64 => 4,
        };
        Self { lanes, precision, ..self }
    }

    /// Are positions kept in more digits than the scalar has?
    pub fn is_fine(&self) -> bool {
        self.precision == Precision::F32 && self.positions == Some(Precision::F64)
    }

    /// The stiffness of soft contacts, hz·h.
    pub fn contact_stiffness(&self) -> f64 {
        self.stiffness.unwrap_or(HERTZ_TIMES_SUBSTEP)
    }

    /// Refuses what cannot be run.
    ///
    /// # Errors
    /// A step or bound on the sag that is not positive and finite, a stiffness that is no share of a half, either with
    /// a solver other than `soft`, no substep, a lane width the precision does not have.
    pub fn check(&self) -> Result<(), SettingsError> {
        let dt_secs = match self.precision {
            Precision::F32 => f64::from(f32::from_f64(self.dt_secs)),
            Precision::F64 => self.dt_secs,
        };
        if !(dt_secs > 0.0 && dt_secs.is_finite()) {
            return Err(SettingsError::Dt { precision: self.precision, given: self.dt_secs });
        }
        let least = self.precision.shortest_step_secs();
        if dt_secs < least {
            return Err(SettingsError::ShortDt { precision: self.precision, given: self.dt_secs, least });
        }
        self.threads.check()?;
        if !(1..=1000).contains(&self.substeps) {
            return Err(SettingsError::Substeps(self.substeps));
        }
        if let Some(max_sag) = self.max_sag {
            if !(max_sag > 0.0 && max_sag.is_finite()) {
                return Err(SettingsError::MaxSag(max_sag));
            }
            if self.solver != Solver::Soft {
                return Err(SettingsError::MaxSagSolver(self.solver));
            }
            if self.fixed_substeps {
                return Err(SettingsError::FixedSag);
            }
        }
        if (self.precision, self.positions) == (Precision::F64, Some(Precision::F32)) {
            return Err(SettingsError::Positions);
        }
        for (name, bound, unit) in [("max-speed", self.max_speed, "m/s"), ("max-gain", self.max_gain, "J")] {
            if let Some(given) = bound.filter(|bound| !(*bound > 0.0 && bound.is_finite())) {
                return Err(SettingsError::Bound { name, given, unit });
            }
        }
        if let Some(stiffness) = self.stiffness {
            if !(stiffness > 0.0 && stiffness <= MOST_STIFF) {
                return Err(SettingsError::Stiffness(stiffness));
            }
            if self.solver != Solver::Soft {
                return Err(SettingsError::StiffnessSolver(self.solver));
            }
        }
        if !Self::widths(self.precision).contains(&self.lanes) {
            let choices = match self.precision {
                Precision::F32 => "1, 4, 8 or 16",
                Precision::F64 => "1 or 4",
            };
            return Err(SettingsError::Lanes { precision: self.precision, choices, given: self.lanes });
        }
        Ok(())
    }
}
