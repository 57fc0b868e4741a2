//! Deep overlaps: what begins in something else, or was put there, is moved out of it without being given speed.
//!
//! A push of [`soft`](super::soft) gives bodies speed that its relaxation takes back, one contact after the other. In a
//! heap that begins in itself much of it stays: twenty bodies at one point parted with eight times the cap, 34 m/s, and
//! still with a half of it after fifteen relaxations more. So points deeper than [`DEEP`] only stop closing, and as the
//! step ends [`PartDeep`] moves them apart, by [`PUSH_CAP`](super::soft::PUSH_CAP) at most: displacements alone, after
//! which momentum is what it was.

use super::block::part;
use super::bounce::gaps;
use super::constraint::{Constraint, Normals, Side};
use super::stream::{Ends, Visit};
use crate::each::Each as _;
use crate::lanes::{LaneMask, Lanes};

/// Overlaps over this share of the scene's median radius are deep, where bodies have just come or changed. What sinks into
/// something under a load is not treated so: a pile of 10,000 that fell with 2 substeps lost its springs' push and
/// collapsed (0.2 m of overlap on average instead of 0.02).
pub(super) const DEEP: f64 = 0.03;
/// Steps for which deep points are moved apart after bodies have come.
pub(super) const STEPS: u32 = 120;

/// Whether anything is to be moved apart.
#[derive(Clone, Copy, Debug)]
pub(super) struct Apart {
    /// Bodies have come or changed: some may have been put into others.
    pub fresh: bool,
    /// Steps for which deep points are moved apart.
    pub steps: u32,
}

impl Default for Apart {
    fn default() -> Self {
        Self { fresh: true, steps: 0 }
    }
}

/// The pass that moves deep points apart.
#[derive(Debug)]
pub(super) struct PartDeep<'a, L: Lanes> {
    /// Velocities per slot, for their inverse masses.
    pub(super) rows: &'a [[L::Elem; 4]],
    /// What is moved, per slot.
    pub(super) displaced: &'a mut [[L::Elem; 4]],
    /// Displacement of the last substep per slot; `None` where gaps are up to date.
    pub(super) moved: Option<&'a [[L::Elem; 4]]>,
    /// What is deep, metres.
    pub(super) deep: L,
    /// The most a point is moved, metres.
    pub(super) most: L,
    /// Is anything deep?
    pub(super) any: bool,
}

impl<L: Lanes> Visit<L> for PartDeep<'_, L> {
    #[inline(always)]
    fn visit<const POINTS: usize>(&mut self, c: &mut Constraint<L, POINTS>, ends: Ends<'_>, _: usize) {
        let zero = L::zero();
        let over = gaps(c, &ends, self.moved).each(|gap| zero.min(gap + self.deep));
        let is_deep = |k: usize| over[k].lt(zero) & zero.lt(c.points[k].mass);
        if !(0..POINTS).any(|k| is_deep(k).any()) {
            return;
        }
        self.any = true;
        let side = |slots: &[u32]| {
            Side::displacement(self.displaced, slots, Side::<L>::gather(self.rows, slots).inv_mass)
        };
        let (mut to_a, mut to_b) = (side(ends.a), side(ends.b));
        let ways = Normals::begin(c, &to_a, &to_b);
        let entered: [L; POINTS] = crate::each::indexed(|k| {
            let owed = over[k].max(-self.most) + ways.velocity(&c.points[k]);
            L::select(is_deep(k), zero.min(owed), zero)
        });
        part(c, ways, entered, [&mut to_a, &mut to_b]);
        to_a.scatter(self.displaced, ends.a);
        to_b.scatter(self.displaced, ends.b);
    }
}
