//! Fields a scene may carry, and what they do to a block of bodies.
//!
//! A scene's [`Forces`] become a list of [`Field`]s; a field that is absent is not in the list and costs
//! nothing. The list is walked once per block of [`BLOCK`](crate::column::BLOCK) lane values, so an enum is
//! matched outside the lane loop.

mod field;

use serde::{Deserialize, Serialize};

use crate::each::Each as _;
use crate::lanes::Real;
use crate::pair;
use crate::settings::Settings;

pub(crate) use field::acceleration_of;
pub use field::{Field, Matter, acceleration};

/// A field whose coefficients cannot be run with.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ForceError {
    /// NaN, infinite, or too large for the world's precision.
    #[error("force {field}: {value:?} is not finite in this precision")]
    NonFinite {
        /// The field.
        field: &'static str,
        /// What was given.
        value: f64,
    },
    /// Below zero where that would feed energy in.
    #[error("force {field}: coefficient must not be negative, got {value:?}")]
    Negative {
        /// The field.
        field: &'static str,
        /// What was given.
        value: f64,
    },
    /// Wind acts through drag.
    #[error("force wind: has no effect without linear_drag or quadratic_drag; give one of them")]
    WindWithoutDrag,
    /// A block of the narrowest common width holds so many.
    #[error("force attraction: at most {MOST_ATTRACTED} bodies attract each other, got {0}")]
    TooManyAttracted(usize),
    /// Bodies that attract each other must all move at once.
    #[error("force attraction: all bodies must move at once; run it without {0}")]
    NotAtOnce(&'static str),
}

/// Bodies that may attract each other: with the world's own slot they fill one block of the widest `f64` lanes,
/// whose stages are in step.
pub const MOST_ATTRACTED: usize = 15;

/// A pull towards a fixed point.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Spring {
    /// Where it is at rest, metres.
    #[serde(deserialize_with = "pair::required")]
    pub anchor: [f64; 2],
    /// N/m.
    pub stiffness: f64,
}

/// Kepler's attraction.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Central {
    /// Where it pulls to, metres.
    #[serde(deserialize_with = "pair::required")]
    pub center: [f64; 2],
    /// μ = GM, m³/s²: the acceleration at distance r is μ/r².
    pub strength: f64,
}

/// A push that swings in time: a = amplitude·cos(rate·t + phase).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Drive {
    /// m/s².
    #[serde(deserialize_with = "pair::required")]
    pub amplitude: [f64; 2],
    /// rad/s.
    pub rate: f64,
    /// At the first step's beginning, rad.
    #[serde(default)]
    pub phase: f64,
}

/// The fields of a scene, as they are written down. All act at the centroid of dynamic bodies.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Forces {
    /// Uniform acceleration, m/s².
    #[serde(default, skip_serializing_if = "Option::is_none", deserialize_with = "pair::optional")]
    pub gravity: Option<[f64; 2]>,
    /// Velocity of the air, m/s: both drags act on the velocity relative to it.
    #[serde(default, skip_serializing_if = "Option::is_none", deserialize_with = "pair::optional")]
    pub wind: Option<[f64; 2]>,
    /// k in F = −k·(v − wind), kg/s.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub linear_drag: Option<f64>,
    /// k in F = −k·|v − wind|·(v − wind), kg/m.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub quadratic_drag: Option<f64>,
    /// F = −stiffness·(x − anchor).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub spring: Option<Spring>,
    /// a = −μ·(x − center)/|x − center|³.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub central: Option<Central>,
    /// k in F = k·(`v_y`, −`v_x`), kg/s (charge times a field out of the plane).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub magnetic: Option<f64>,
    /// A second centre that pulls like `central`. With k = 2m of `magnetic` and a spring of −m about the origin the
    /// frame turns at 1 rad/s and these are the two primaries of the restricted three-body problem.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub companion: Option<Central>,
    /// λ in a = −λ·(2xy, x² − y²), 1/(m·s²): the cubic part of the potential of Hénon and Heiles.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub henon_heiles: Option<f64>,
    /// A push that swings in time.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub drive: Option<Drive>,
    /// G in a = ΣG·`m_j`·r/|r|³, m³/(kg·s²): dynamic bodies attract each other, at most [`MOST_ATTRACTED`].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub attraction: Option<f64>,
}

impl Forces {
    /// Standard gravity, downwards.
    pub fn gravity() -> Self {
        Self { gravity: Some([0.0, -9.81]), ..Self::default() }
    }

    /// Names of the fields it has beside gravity: what an engine that knows gravity alone must refuse.
    pub fn beyond_gravity(&self) -> impl Iterator<Item = &'static str> {
        let given = [
            ("wind", self.wind.is_some()),
            ("linear_drag", self.linear_drag.is_some()),
            ("quadratic_drag", self.quadratic_drag.is_some()),
            ("spring", self.spring.is_some()),
            ("central", self.central.is_some()),
            ("magnetic", self.magnetic.is_some()),
            ("companion", self.companion.is_some()),
            ("henon_heiles", self.henon_heiles.is_some()),
            ("drive", self.drive.is_some()),
            ("attraction", self.attraction.is_some()),
        ];
        given.into_iter().filter(|(_, given)| *given).map(|(name, _)| name)
    }

    /// Refuses coefficients that cannot be run with in any precision.
    ///
    /// # Errors
    /// Coefficients that are not finite, drags below zero, wind without drag.
    pub fn check(&self) -> Result<(), ForceError> {
        self.check_in::<f64>()
    }

    /// Refuses coefficients that cannot be run with in the precision of `R`.
    ///
    /// # Errors
    /// Those of [`Forces::check`], of coefficients rounded to `R`.
    pub fn check_in<R: Real>(&self) -> Result<(), ForceError> {
        let pair = |p: Option<[f64; 2]>| p.into_iter().flatten();
        let centre = |c: Option<Central>| c.into_iter().flat_map(|c| [c.center[0], c.center[1], c.strength]);
        let values = (pair(self.gravity).map(|v| ("gravity", v)))
            .chain(pair(self.wind).map(|v| ("wind", v)))
            .chain(self.linear_drag.map(|v| ("linear_drag", v)))
            .chain(self.quadratic_drag.map(|v| ("quadratic_drag", v)))
            .chain(
                self.spring
                    .into_iter()
                    .flat_map(|s| [s.anchor[0], s.anchor[1], s.stiffness])
                    .map(|v| ("spring", v)),
            )
            .chain(centre(self.central).map(|v| ("central", v)))
            .chain(self.magnetic.map(|v| ("magnetic", v)))
            .chain(centre(self.companion).map(|v| ("companion", v)))
            .chain(self.henon_heiles.map(|v| ("henon_heiles", v)))
            .chain(
                self.drive
                    .into_iter()
                    .flat_map(|d| [d.amplitude[0], d.amplitude[1], d.rate, d.phase])
                    .map(|v| ("drive", v)),
            )
            .chain(self.attraction.map(|v| ("attraction", v)));
        for (field, value) in values {
            if !R::from_f64(value).is_finite() {
                return Err(ForceError::NonFinite { field, value });
            }
        }
        for (field, value) in [("linear_drag", self.linear_drag), ("quadratic_drag", self.quadratic_drag)] {
            if let Some(value) = value.filter(|v| *v < 0.0) {
                return Err(ForceError::Negative { field, value });
            }
        }
        if self.wind.is_some() && self.linear_drag.is_none() && self.quadratic_drag.is_none() {
            return Err(ForceError::WindWithoutDrag);
        }
        Ok(())
    }

    /// Refuses what bodies that attract each other cannot be run with: `slots` are those of the world, its own included.
    ///
    /// # Errors
    /// More bodies than one block holds, settings by which some of them would move without the others.
    pub fn check_coupling(&self, slots: usize, settings: &Settings) -> Result<(), ForceError> {
        if self.attraction.is_none() {
            return Ok(());
        }
        if slots > MOST_ATTRACTED + 1 {
            return Err(ForceError::TooManyAttracted(slots - 1));
        }
        let apart = [("sleep", settings.sleep), ("max-sag", settings.max_sag.is_some())];
        match apart.into_iter().find(|(_, on)| *on) {
            Some((setting, _)) => Err(ForceError::NotAtOnce(setting)),
            None => Ok(()),
        }
    }

    /// The fields present, rounded to the engine's precision: constant ones first, those few scenes have last.
    pub fn fields<R: Real>(&self) -> Vec<Field<R>> {
        let pair = |v: [f64; 2]| v.each(R::from_f64);
        let wind = pair(self.wind.unwrap_or_default());
        let mut fields = Vec::new();
        fields.extend(self.gravity.map(|g| Field::Gravity(pair(g))));
        fields.extend(self.linear_drag.map(|k| Field::LinearDrag { k: R::from_f64(k), wind }));
        fields.extend(self.quadratic_drag.map(|k| Field::QuadraticDrag { k: R::from_f64(k), wind }));
        fields.extend(
            self.spring
                .map(|s| Field::Spring { anchor: pair(s.anchor), stiffness: R::from_f64(s.stiffness) }),
        );
        for c in [self.central, self.companion].into_iter().flatten() {
            fields.push(Field::Central { center: pair(c.center), strength: R::from_f64(c.strength) });
        }
        fields.extend(self.magnetic.map(|k| Field::Magnetic(R::from_f64(k))));
        fields.extend(self.henon_heiles.map(|k| Field::HenonHeiles(R::from_f64(k))));
        fields.extend(self.drive.map(|d| Field::Drive {
            amplitude: pair(d.amplitude),
            rate: d.rate,
            phase: d.phase,
            begun: d.phase,
        }));
        fields.extend(self.attraction.map(|g| Field::Attraction(R::from_f64(g))));
        fields
    }

    /// The same fields for a world that begins `secs` later.
    #[must_use]
    pub fn after(self, secs: f64) -> Self {
        Self { drive: self.drive.map(|d| Drive { phase: d.phase + d.rate * secs, ..d }), ..self }
    }

    /// Potential energy of a body of `mass` kg with its centroid at `position`, J. Drags, magnetic fields and drives
    /// have none; that of mutual attraction belongs to pairs, see [`Forces::pair_energy`].
    pub fn potential_energy(&self, mass: f64, position: [f64; 2]) -> f64 {
        let [x, y] = position;
        let gravity = self.gravity.map_or(0.0, |[gx, gy]| -mass * (gx * x + gy * y));
        let spring = self.spring.map_or(0.0, |s| {
            let d = (x - s.anchor[0]).hypot(y - s.anchor[1]);
            0.5 * s.stiffness * d * d
        });
        let centre = |c: Option<Central>| {
            c.map_or(0.0, |c| {
                -mass * c.strength / (x - c.center[0]).hypot(y - c.center[1]).max(f64::MIN_POSITIVE)
            })
        };
        let cubic = self.henon_heiles.map_or(0.0, |k| mass * k * (x * x * y - y * y * y / 3.0));
        gravity + spring + centre(self.central) + centre(self.companion) + cubic
    }

    /// Potential energy of the mutual attraction of two bodies, each a mass, kg, and a centroid, metres; J.
    pub fn pair_energy(&self, a: (f64, [f64; 2]), b: (f64, [f64; 2])) -> f64 {
        self.attraction
            .map_or(0.0, |g| -g * a.0 * b.0 / (a.1[0] - b.1[0]).hypot(a.1[1] - b.1[1]).max(f64::MIN_POSITIVE))
    }
}
