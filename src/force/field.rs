//! Fields ready for lanes, and what they do to a block of bodies.

use crate::body::Bodies;
use crate::column::BLOCK;
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

/// The acceleration of one body at a place, metres, with a velocity, m/s, `since_secs` after the step began, m/s².
pub(crate) fn acceleration_of<R: Real>(
    fields: &[Field<R>],
    bodies: &Bodies<R>,
    slot: usize,
    [place, velocity]: [[f64; 2]; 2],
    since_secs: f64,
) -> [f64; 2] {
    let vector = |v: [f64; 2]| [Vec2::new(R::from_f64(v[0]), R::from_f64(v[1])); BLOCK];
    let inv_mass = [bodies.inv_mass[slot]; BLOCK];
    let force = bodies.force.as_ref().map(|force| [[force[0][slot]; BLOCK], [force[1][slot]; BLOCK]]);
    let matter = Matter { inv_mass: &inv_mass, force: force.as_ref().map(|[x, y]| (x, y)) };
    let [pulled, ..] = acceleration::<R>(fields, matter, since_secs, &vector(place), &vector(velocity));
    [pulled.x.to_f64(), pulled.y.to_f64()]
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
                    sum[k] = sum[k] + freed(g, matter.inv_mass[k]);
                }
            }
            Field::PerBody => {
                if let Some((fx, fy)) = matter.force {
                    for k in 0..BLOCK {
                        sum[k] = sum[k] + Vec2::new(fx[k], fy[k]) * matter.inv_mass[k];
                    }
                }
            }
            _ => return varying::<L>(&fields[at..], matter.inv_mass, since_secs, *position, *velocity, sum),
        }
    }
    sum
}

/// Adds the fields that depend on place, velocity or time, which [`Forces::fields`](super::Forces::fields) puts last. A
/// call of its own, by values, from which the loop is not returned to: inlined into every stage of every scheme they were
/// a seventh of the engine's code, and those that few scenes have cost all others a fifth more instructions; by references
/// or returned from a tenth, for blocks left the registers.
#[inline(never)]
fn varying<L: Lanes>(
    fields: &[Field<L::Elem>],
    inv_mass: &[L; BLOCK],
    since_secs: f64,
    position: [Vec2<L>; BLOCK],
    velocity: [Vec2<L>; BLOCK],
    mut sum: [Vec2<L>; BLOCK],
) -> [Vec2<L>; BLOCK] {
    for field in fields {
        match *field {
            Field::LinearDrag { k: drag, wind } => {
                let (drag, wind) = (L::splat(drag), Vec2::splat(wind));
                for k in 0..BLOCK {
                    sum[k] = sum[k] - (velocity[k] - wind) * (drag * inv_mass[k]);
                }
            }
            Field::QuadraticDrag { k: drag, wind } => {
                let (drag, wind) = (L::splat(drag), Vec2::splat(wind));
                for k in 0..BLOCK {
                    let air = velocity[k] - wind;
                    sum[k] = sum[k] - air * (air.length_squared().sqrt() * drag * inv_mass[k]);
                }
            }
            Field::Spring { anchor, stiffness } => {
                let (anchor, stiffness) = (Vec2::splat(anchor), L::splat(stiffness));
                for k in 0..BLOCK {
                    sum[k] = sum[k] - (position[k] - anchor) * (stiffness * inv_mass[k]);
                }
            }
            Field::Central { center, strength } => {
                let (center, strength) = (Vec2::splat(center), L::splat(strength));
                for k in 0..BLOCK {
                    sum[k] = sum[k] - pull(position[k] - center, strength, inv_mass[k]);
                }
            }
            Field::Magnetic(strength) => {
                let strength = L::splat(strength);
                for k in 0..BLOCK {
                    sum[k] = sum[k] + velocity[k].right() * (strength * inv_mass[k]);
                }
            }
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
            Field::Gravity(_) | Field::PerBody => unreachable!("Forces::fields puts constant fields first"),
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
