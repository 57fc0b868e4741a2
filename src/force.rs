//! Fields a scene may carry, and what they do to a block of bodies.
//!
//! A scene's [`Forces`] become a list of [`Field`]s; a field that is absent is not in the list and costs
//! nothing. The list is walked once per block of [`BLOCK`] lane values, so an enum is matched outside
//! the lane loop.

use serde::{Deserialize, Serialize};

use crate::integrate::BLOCK;
use crate::lanes::{Lanes, Real};
use crate::pair;
use crate::vec2::Vec2;

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
}

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
            .chain(
                self.central
                    .into_iter()
                    .flat_map(|c| [c.center[0], c.center[1], c.strength])
                    .map(|v| ("central", v)),
            )
            .chain(self.magnetic.map(|v| ("magnetic", v)));
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

    /// The fields present, rounded to the engine's precision, constant ones first.
    pub fn fields<R: Real>(&self) -> Vec<Field<R>> {
        let pair = |v: [f64; 2]| v.map(R::from_f64);
        let wind = pair(self.wind.unwrap_or_default());
        let mut fields = Vec::new();
        fields.extend(self.gravity.map(|g| Field::Gravity(pair(g))));
        fields.extend(self.linear_drag.map(|k| Field::LinearDrag { k: R::from_f64(k), wind }));
        fields.extend(self.quadratic_drag.map(|k| Field::QuadraticDrag { k: R::from_f64(k), wind }));
        fields.extend(
            self.spring
                .map(|s| Field::Spring { anchor: pair(s.anchor), stiffness: R::from_f64(s.stiffness) }),
        );
        fields.extend(
            self.central
                .map(|c| Field::Central { center: pair(c.center), strength: R::from_f64(c.strength) }),
        );
        fields.extend(self.magnetic.map(|k| Field::Magnetic(R::from_f64(k))));
        fields
    }

    /// Potential energy of a body of `mass` kg with its centroid at `position`, J (drags and magnetic fields have none).
    pub fn potential_energy(&self, mass: f64, position: [f64; 2]) -> f64 {
        let [x, y] = position;
        let gravity = self.gravity.map_or(0.0, |[gx, gy]| -mass * (gx * x + gy * y));
        let spring = self.spring.map_or(0.0, |s| {
            let d = (x - s.anchor[0]).hypot(y - s.anchor[1]);
            0.5 * s.stiffness * d * d
        });
        let central = self.central.map_or(0.0, |c| {
            -mass * c.strength / (x - c.center[0]).hypot(y - c.center[1]).max(f64::MIN_POSITIVE)
        });
        gravity + spring + central
    }
}

/// One field, ready for lanes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Field<R> {
    /// Uniform acceleration.
    Gravity([R; 2]),
    /// F = −k·(v − wind).
    LinearDrag {
        /// kg/s.
        k: R,
        /// m/s.
        wind: [R; 2],
    },
    /// F = −k·|v − wind|·(v − wind).
    QuadraticDrag {
        /// kg/m.
        k: R,
        /// m/s.
        wind: [R; 2],
    },
    /// F = −stiffness·(x − anchor).
    Spring {
        /// Metres.
        anchor: [R; 2],
        /// N/m.
        stiffness: R,
    },
    /// a = −μ·r/|r|³.
    Central {
        /// Metres.
        center: [R; 2],
        /// m³/s².
        strength: R,
    },
    /// F = k·(`v_y`, −`v_x`).
    Magnetic(R),
    /// A constant force per body, from its columns.
    PerBody,
}

impl<R: Real> Field<R> {
    /// Is its acceleration the same wherever a body is and however it moves?
    pub fn is_constant(&self) -> bool {
        matches!(self, Self::Gravity(_) | Self::PerBody)
    }
}

/// What fields need to know of a block of bodies, beside position and velocity.
#[derive(Clone, Copy, Debug)]
pub struct Matter<'a, L> {
    /// 1/kg; 0 for static and kinematic bodies.
    pub inv_mass: &'a [L; BLOCK],
    /// Constant force in x and y, N, where some body has one.
    pub force: Option<(&'a [L; BLOCK], &'a [L; BLOCK])>,
}

/// The acceleration of a block of bodies at `position` with `velocity`, m/s²: the sum over `fields` in
/// their order; 0 for static and kinematic bodies.
#[inline(always)]
pub fn acceleration<L: Lanes>(
    fields: &[Field<L::Elem>],
    matter: Matter<'_, L>,
    position: &[Vec2<L>; BLOCK],
    velocity: &[Vec2<L>; BLOCK],
) -> [Vec2<L>; BLOCK] {
    let mut sum = [Vec2::zero(); BLOCK];
    for field in fields {
        match *field {
            Field::Gravity(g) => {
                let g = Vec2::splat(g);
                for k in 0..BLOCK {
                    // Not g·m·(1/m): a body falls with g to the bit, whatever its mass.
                    let held = matter.inv_mass[k].le(L::zero());
                    sum[k] = sum[k] + Vec2::select(held, Vec2::zero(), g);
                }
            }
            Field::LinearDrag { k: drag, wind } => {
                let (drag, wind) = (L::splat(drag), Vec2::splat(wind));
                for k in 0..BLOCK {
                    sum[k] = sum[k] - (velocity[k] - wind) * (drag * matter.inv_mass[k]);
                }
            }
            Field::QuadraticDrag { k: drag, wind } => {
                let (drag, wind) = (L::splat(drag), Vec2::splat(wind));
                for k in 0..BLOCK {
                    let air = velocity[k] - wind;
                    sum[k] = sum[k] - air * (air.length_squared().sqrt() * drag * matter.inv_mass[k]);
                }
            }
            Field::Spring { anchor, stiffness } => {
                let (anchor, stiffness) = (Vec2::splat(anchor), L::splat(stiffness));
                for k in 0..BLOCK {
                    sum[k] = sum[k] - (position[k] - anchor) * (stiffness * matter.inv_mass[k]);
                }
            }
            Field::Central { center, strength } => {
                let (center, strength) = (Vec2::splat(center), L::splat(strength));
                for k in 0..BLOCK {
                    let r = position[k] - center;
                    let square = r.length_squared();
                    let cube = square * square.sqrt();
                    // At the centre itself, and for held bodies, no pull rather than 0/0.
                    let none = matter.inv_mass[k].le(L::zero()) | cube.le(L::zero());
                    let factor = L::select(none, L::zero(), strength / L::select(none, L::one(), cube));
                    sum[k] = sum[k] - r * factor;
                }
            }
            Field::Magnetic(strength) => {
                let strength = L::splat(strength);
                for k in 0..BLOCK {
                    sum[k] = sum[k] + velocity[k].right() * (strength * matter.inv_mass[k]);
                }
            }
            Field::PerBody => {
                if let Some((fx, fy)) = matter.force {
                    for k in 0..BLOCK {
                        sum[k] = sum[k] + Vec2::new(fx[k], fy[k]) * matter.inv_mass[k];
                    }
                }
            }
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(forces: &Forces, x: [f64; 2], v: [f64; 2], inv_mass: f64) -> [f64; 2] {
        let (mass, no_force) = ([inv_mass; BLOCK], None);
        let matter = Matter { inv_mass: &mass, force: no_force };
        let a =
            acceleration::<f64>(&forces.fields(), matter, &[Vec2::splat(x); BLOCK], &[Vec2::splat(v); BLOCK]);
        [a[0].x, a[0].y]
    }

    #[test]
    fn each_field_has_its_formula() {
        let none = Forces::default();
        assert_eq!(at(&Forces::gravity(), [1.0, 2.0], [3.0, 4.0], 0.5), [0.0, -9.81]);
        let drag = Forces { linear_drag: Some(2.0), wind: Some([1.0, 0.0]), ..none };
        assert_eq!(at(&drag, [0.0; 2], [3.0, 4.0], 0.5), [-2.0, -4.0]);
        let drag = Forces { quadratic_drag: Some(2.0), ..none };
        assert_eq!(at(&drag, [0.0; 2], [3.0, 4.0], 0.5), [-15.0, -20.0]);
        let spring = Forces { spring: Some(Spring { anchor: [1.0, 1.0], stiffness: 4.0 }), ..none };
        assert_eq!(at(&spring, [2.0, 3.0], [0.0; 2], 0.5), [-2.0, -4.0]);
        let central = Forces { central: Some(Central { center: [0.0, 0.0], strength: 8.0 }), ..none };
        assert_eq!(at(&central, [0.0, 2.0], [0.0; 2], 0.5), [0.0, -2.0]);
        assert_eq!(at(&central, [0.0, 0.0], [0.0; 2], 0.5), [0.0, 0.0]);
        let magnetic = Forces { magnetic: Some(2.0), ..none };
        assert_eq!(at(&magnetic, [0.0; 2], [3.0, 4.0], 0.5), [4.0, -3.0]);
    }

    #[test]
    fn held_bodies_feel_nothing() {
        let all = Forces {
            gravity: Some([1.0, 2.0]),
            wind: Some([5.0, 5.0]),
            linear_drag: Some(1.0),
            quadratic_drag: Some(1.0),
            spring: Some(Spring { anchor: [1.0, 1.0], stiffness: 4.0 }),
            central: Some(Central { center: [0.0, 0.0], strength: 8.0 }),
            magnetic: Some(1.0),
        };
        assert_eq!(at(&all, [2.0, 3.0], [1.0, 1.0], 0.0), [0.0, 0.0]);
    }

    #[test]
    fn bad_coefficients_are_named() {
        let bad = Forces { linear_drag: Some(-1.0), ..Forces::default() };
        assert_eq!(bad.check(), Err(ForceError::Negative { field: "linear_drag", value: -1.0 }));
        let bad = Forces { wind: Some([1.0, 0.0]), ..Forces::default() };
        assert_eq!(bad.check(), Err(ForceError::WindWithoutDrag));
        let bad = Forces { gravity: Some([0.0, f64::NAN]), ..Forces::default() };
        assert!(matches!(bad.check(), Err(ForceError::NonFinite { field: "gravity", .. })));
    }
}
