//! Hash, finiteness, energy and momentum of a world's state.

use std::ops::Range;

use xxhash_rust::xxh3::Xxh3Default;

use crate::body::Bodies;
use crate::column::Column;
use crate::force::Forces;
use crate::lanes::{LaneMask, Lanes, Real};
use crate::motion::lanes_of;

/// xxh3 (64 bits) over x, y, c, s, vx, vy, w of every living body in slot order, as `f64` bits.
pub fn state_hash<R: Real>(bodies: &Bodies<R>) -> u64 {
    let columns = [&bodies.c, &bodies.s, &bodies.vx, &bodies.vy, &bodies.w];
    let places = (0..2).flat_map(|k| bodies.slots().map(move |slot| bodies.place(slot)[k]));
    hash_of(
        places.chain(columns.into_iter().flat_map(|column| bodies.slots().map(|slot| column[slot].to_f64()))),
    )
}

/// xxh3 (64 bits) over the bits of numbers, in their order.
///
/// −0 counts as 0 and every NaN as one: their bits differ between machines that agree in all values.
pub fn hash_of(values: impl Iterator<Item = f64>) -> u64 {
    let mut hasher = Xxh3Default::new();
    // A block at a time: a hasher fed with single numbers takes three times as long.
    let (mut block, mut filled) = ([0u64; 128], 0);
    for value in values {
        block[filled] = if value.is_nan() { 0x7ff8_0000_0000_0000 } else { (value + 0.0).to_bits() };
        filled += 1;
        if filled == block.len() {
            hasher.update(bytemuck::cast_slice(&block));
            filled = 0;
        }
    }
    hasher.update(bytemuck::cast_slice(&block[..filled]));
    hasher.digest()
}

/// The first body (by column, then slot) whose state is NaN or infinite: slot, column, value. Only the slots
/// in `runs`, which begin at multiples of [`PAD`](crate::column::PAD), are suspected.
pub fn first_non_finite<L: Lanes>(
    bodies: &Bodies<L::Elem>,
    runs: &[Range<usize>],
) -> Option<(usize, &'static str, f64)> {
    let columns = state_columns(bodies);
    let mut doubtful = L::zero();
    for run in runs {
        let chunks = lanes_of::<L>(run);
        for (_, column) in columns {
            for value in &column.lanes::<L>()[chunks.clone()] {
                // 0 where the value is finite, NaN where it is not, and NaN stays.
                doubtful = doubtful + *value * L::zero();
            }
        }
    }
    if !(!doubtful.equals(L::zero())).any() {
        return None;
    }
    columns.into_iter().find_map(|(name, column)| {
        let slot = bodies.slots().find(|&slot| !column[slot].is_finite())?;
        Some((slot, name, column[slot].to_f64()))
    })
}

/// The first column of a slot that is NaN or infinite, and its value.
pub fn non_finite_in<R: Real>(bodies: &Bodies<R>, slot: usize) -> Option<(&'static str, f64)> {
    let (name, column) = state_columns(bodies).into_iter().find(|(_, column)| !column[slot].is_finite())?;
    Some((name, column[slot].to_f64()))
}

/// The columns a step changes, by name, in the order in which a state that is not finite is looked for.
fn state_columns<R: Real>(bodies: &Bodies<R>) -> [(&'static str, &Column<R>); 7] {
    [
        ("vx", &bodies.vx),
        ("vy", &bodies.vy),
        ("w", &bodies.w),
        ("x", &bodies.x),
        ("y", &bodies.y),
        ("c", &bodies.c),
        ("s", &bodies.s),
    ]
}

/// Sums over all dynamic bodies, in `f64`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Invariants {
    /// ½mv² + ½Iω², J.
    pub kinetic_energy: f64,
    /// Of gravity, springs and central fields, J.
    pub potential_energy: f64,
    /// Σmv, kg·m/s.
    pub momentum: [f64; 2],
    /// Σ(m·x×v + Iω) about the origin, kg·m²/s.
    pub angular_momentum: f64,
}

impl Invariants {
    /// Adds a body: mass and inertia, centroid, velocity and angular velocity.
    pub fn add(
        &mut self,
        [mass, inertia]: [f64; 2],
        [x, y]: [f64; 2],
        [vx, vy]: [f64; 2],
        w: f64,
        forces: &Forces,
    ) {
        self.kinetic_energy += 0.5 * (mass * (vx * vx + vy * vy) + inertia * w * w);
        self.potential_energy += forces.potential_energy(mass, [x, y]);
        self.momentum[0] += mass * vx;
        self.momentum[1] += mass * vy;
        self.angular_momentum += mass * (x * vy - y * vx) + inertia * w;
    }
}

impl Invariants {
    /// Adds what bodies attract each other with, each a mass, kg, and a centroid, metres.
    pub fn add_attraction(
        &mut self,
        forces: &Forces,
        bodies: &(impl Iterator<Item = (f64, [f64; 2])> + Clone),
    ) {
        if forces.attraction.is_none() {
            return;
        }
        for (k, a) in bodies.clone().enumerate() {
            for b in bodies.clone().skip(k + 1) {
                self.potential_energy += forces.pair_energy(a, b);
            }
        }
    }
}

/// Energy and momentum of a world's dynamic bodies.
pub fn invariants<R: Real>(bodies: &Bodies<R>, forces: &Forces) -> Invariants {
    let mut sum = Invariants { potential_energy: attraction_energy(bodies, forces), ..Invariants::default() };
    for slot in dynamic(bodies) {
        sum.add_slot(bodies, forces, slot);
    }
    sum
}

/// Those of the dynamic body in one slot, attraction left out.
pub fn invariants_of<R: Real>(bodies: &Bodies<R>, forces: &Forces, slot: usize) -> Invariants {
    let mut sum = Invariants::default();
    sum.add_slot(bodies, forces, slot);
    sum
}

/// What a world's dynamic bodies attract each other with, J.
pub fn attraction_energy<R: Real>(bodies: &Bodies<R>, forces: &Forces) -> f64 {
    let placed = |slot: usize| (1.0 / bodies.inv_mass[slot].to_f64(), bodies.place(slot));
    let mut sum = Invariants::default();
    sum.add_attraction(forces, &dynamic(bodies).map(placed));
    sum.potential_energy
}

fn dynamic<R: Real>(bodies: &Bodies<R>) -> impl Iterator<Item = usize> + Clone {
    bodies.slots().filter(|&slot| bodies.inv_mass[slot] > R::ZERO)
}

impl Invariants {
    fn add_slot<R: Real>(&mut self, bodies: &Bodies<R>, forces: &Forces, slot: usize) {
        let read = |column: &Column<R>| column[slot].to_f64();
        let matter = [1.0 / read(&bodies.inv_mass), 1.0 / read(&bodies.inv_inertia)];
        let (at, velocity) = (bodies.place(slot), [read(&bodies.vx), read(&bodies.vy)]);
        self.add(matter, at, velocity, read(&bodies.w), forces);
    }
}
