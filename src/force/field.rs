//! Fields ready for lanes, and what they do to a block of bodies.

use crate::integrate::BLOCK;
use crate::lanes::{Lanes, Real};
use crate::vec2::{Rot, Vec2};

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
    /// a = −λ·(2xy, x² − y²).
    HenonHeiles(R),
    /// a = amplitude·cos(rate·t + phase). Its time is kept outside the lanes, in `f64`.
    Drive {
        /// m/s².
        amplitude: [R; 2],
        /// rad/s.
        rate: f64,
        /// At time 0, rad.
        phase: f64,
        /// At the beginning of the step, rad, less than a turn.
        begun: f64,
    },
    /// a = ΣG·`m_j`·r/|r|³ over the dynamic bodies of the block, which must be all there are.
    Attraction(R),
    /// A constant force per body, from its columns.
    PerBody,
}

impl<R: Real> Field<R> {
    /// Is its acceleration the same wherever a body is and however it moves?
    pub fn is_constant(&self) -> bool {
        matches!(self, Self::Gravity(_) | Self::PerBody)
    }

    /// Does a body's acceleration depend on where others are at the same moment?
    pub fn couples(&self) -> bool {
        matches!(self, Self::Attraction(_))
    }

    /// A step begins at `time_secs`.
    pub fn begin(&mut self, time_secs: f64) {
        if let Self::Drive { rate, phase, begun, .. } = self {
            // Reduced in f64, so that rounding to the engine's precision costs no more late than early.
            *begun = (*phase + *rate * time_secs) % std::f64::consts::TAU;
        }
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

/// The acceleration of a block of bodies at `position` with `velocity`, `since_secs` after the step began, m/s²: the
/// sum over `fields` in their order; 0 for static and kinematic bodies.
#[inline(always)]
pub fn acceleration<L: Lanes>(
    fields: &[Field<L::Elem>],
    matter: Matter<'_, L>,
    since_secs: f64,
    position: &[Vec2<L>; BLOCK],
    velocity: &[Vec2<L>; BLOCK],
) -> [Vec2<L>; BLOCK] {
    let mut sum = [Vec2::zero(); BLOCK];
    for (at, field) in fields.iter().enumerate() {
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
                    sum[k] = sum[k] - pull(position[k] - center, strength, matter.inv_mass[k]);
                }
            }
            Field::Magnetic(strength) => {
                let strength = L::splat(strength);
                for k in 0..BLOCK {
                    sum[k] = sum[k] + velocity[k].right() * (strength * matter.inv_mass[k]);
                }
            }
            Field::HenonHeiles(_) | Field::Drive { .. } | Field::Attraction(_) => {
                return seldom::<L>(&fields[at..], matter.inv_mass, since_secs, *position, sum);
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

/// Adds the fields that few scenes have, which [`Forces::fields`](super::Forces::fields) puts last. A call of its own, by
/// values, from which the loop is not returned to: inlined into every stage of every scheme it cost those without such
/// fields a fifth more instructions, by references or returned from a tenth, for their blocks left the registers.
#[inline(never)]
fn seldom<L: Lanes>(
    fields: &[Field<L::Elem>],
    inv_mass: &[L; BLOCK],
    since_secs: f64,
    position: [Vec2<L>; BLOCK],
    mut sum: [Vec2<L>; BLOCK],
) -> [Vec2<L>; BLOCK] {
    for field in fields {
        match *field {
            Field::HenonHeiles(strength) => {
                let (one, two) = (L::splat(strength), L::splat(strength + strength));
                for k in 0..BLOCK {
                    let Vec2 { x, y } = position[k];
                    let a = Vec2::new(two * x * y, one * (x * x - y * y));
                    sum[k] = sum[k] - freed(a, inv_mass[k]);
                }
            }
            Field::Drive { amplitude, rate, begun, .. } => {
                // The engine's own cosine of a scalar: the same bits at every width.
                let phase = <L::Elem as Real>::from_f64(begun + rate * since_secs);
                let a = Vec2::splat(amplitude) * L::splat(Rot::from_angle(phase).c);
                for k in 0..BLOCK {
                    sum[k] = sum[k] + freed(a, inv_mass[k]);
                }
            }
            Field::Attraction(strength) => attract(&mut sum, strength, inv_mass, &position),
            _ => unreachable!("Forces::fields puts the fields that few scenes have last"),
        }
    }
    sum
}

/// μ·r/|r|³, 0 at the centre itself and for held bodies.
#[inline(always)]
fn pull<L: Lanes>(r: Vec2<L>, strength: L, inv_mass: L) -> Vec2<L> {
    let square = r.length_squared();
    let cube = square * square.sqrt();
    // At the centre itself, and for held bodies, no pull rather than 0/0.
    let none = inv_mass.le(L::zero()) | cube.le(L::zero());
    r * L::select(none, L::zero(), strength / L::select(none, L::one(), cube))
}

/// `a` where a body is dynamic, 0 where it is held.
#[inline(always)]
fn freed<L: Lanes>(a: Vec2<L>, inv_mass: L) -> Vec2<L> {
    Vec2::select(inv_mass.le(L::zero()), Vec2::zero(), a)
}

/// Adds what every dynamic body of the block pulls every other with: one after the other in slot order, each against
/// all in lanes, so that no sum goes across lanes.
#[inline(always)]
fn attract<L: Lanes>(
    sum: &mut [Vec2<L>; BLOCK],
    strength: L::Elem,
    inv_mass: &[L; BLOCK],
    position: &[Vec2<L>; BLOCK],
) {
    for from in 0..BLOCK {
        let (x, y, inv) =
            (position[from].x.to_array(), position[from].y.to_array(), inv_mass[from].to_array());
        for lane in (0..L::WIDTH).filter(|&lane| inv[lane] > L::Elem::ZERO) {
            let (at, strength) = (Vec2::splat([x[lane], y[lane]]), L::splat(strength / inv[lane]));
            for k in 0..BLOCK {
                sum[k] = sum[k] - pull(position[k] - at, strength, inv_mass[k]);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::force::{Central, Drive, ForceError, Forces, Spring};

    fn at(forces: &Forces, x: [f64; 2], v: [f64; 2], inv_mass: f64) -> [f64; 2] {
        let (mass, no_force) = ([inv_mass; BLOCK], None);
        let matter = Matter { inv_mass: &mass, force: no_force };
        let a = acceleration::<f64>(
            &forces.fields(),
            matter,
            0.0,
            &[Vec2::splat(x); BLOCK],
            &[Vec2::splat(v); BLOCK],
        );
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
        let both = Forces { companion: Some(Central { center: [0.0, 4.0], strength: 4.0 }), ..central };
        assert_eq!(at(&both, [0.0, 2.0], [0.0; 2], 0.5), [0.0, -1.0]);
        let cubic = Forces { henon_heiles: Some(2.0), ..none };
        assert_eq!(at(&cubic, [3.0, 1.0], [0.0; 2], 0.5), [-12.0, -16.0]);
        let drive = Forces { drive: Some(Drive { amplitude: [2.0, -1.0], rate: 3.0, phase: 0.0 }), ..none };
        assert_eq!(at(&drive, [0.0; 2], [0.0; 2], 0.5), [2.0, -1.0]);
    }

    /// The phase is that of the step plus what has gone by since, in `f64`.
    #[test]
    fn a_drive_swings_in_time() {
        let drive = Drive { amplitude: [2.0, 0.0], rate: 3.0, phase: 0.25 };
        let mut fields = Forces { drive: Some(drive), ..Forces::default() }.fields::<f64>();
        fields[0].begin(100.0);
        let (mass, still) = ([1.0; BLOCK], [Vec2::zero(); BLOCK]);
        let a = acceleration::<f64>(&fields, Matter { inv_mass: &mass, force: None }, 0.5, &still, &still);
        assert!((a[0].x - 2.0 * (0.25f64 + 3.0 * 100.5).cos()).abs() < 1e-13, "{}", a[0].x);
    }

    /// Momentum does not change, and the pull is G·m/r².
    #[test]
    fn bodies_attract_each_other_by_their_masses() {
        let fields = Forces { attraction: Some(3.0), ..Forces::default() }.fields::<f64>();
        let inv_mass = [1.0, 0.5, 0.0, 0.25];
        let at = [[0.0, 0.0], [2.0, 0.0], [1.0, 1.0], [0.0, 4.0]].map(Vec2::splat);
        let matter = Matter { inv_mass: &inv_mass, force: None };
        let a = acceleration::<f64>(&fields, matter, 0.0, &at, &[Vec2::zero(); BLOCK]);
        assert_eq!([a[0].x, a[0].y], [3.0 * 2.0 / 4.0, 3.0 * 4.0 / 16.0]);
        assert_eq!([a[2].x, a[2].y], [0.0; 2], "a held body is not pulled");
        let momentum = |of: fn(Vec2<f64>) -> f64| of(a[0]) + 2.0 * of(a[1]) + 4.0 * of(a[3]);
        assert!(momentum(|v| v.x).abs() < 1e-15 && momentum(|v| v.y).abs() < 1e-15);
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
            companion: Some(Central { center: [1.0, 0.0], strength: 2.0 }),
            henon_heiles: Some(1.0),
            drive: Some(Drive { amplitude: [1.0, 2.0], rate: 3.0, phase: 0.5 }),
            attraction: Some(1.0),
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
