//! What lanes hold, read out: for reports and recordings, for pairs whose contacts leave, and for `avbd`, which works on
//! pairs.

use super::moves::{impulses_of, write};
use super::{LaneValues, Stream, at};
use crate::contact::{ContactRow, Home, Manifolds};
use crate::each::Each as _;
use crate::lanes::Lanes;

impl<L: Lanes> Stream<L> {
    /// What a lane holds.
    #[inline]
    pub(super) fn lane(&self, home: Home) -> LaneValues<L::Elem> {
        self.lists[home.list as usize].lane(home)
    }

    /// What a lane holds, with gaps that have heard of `moved`.
    #[inline]
    fn read(&self, home: Home, slots: [u32; 2], moved: Option<&[[L::Elem; 4]]>) -> LaneValues<L::Elem> {
        let mut values = self.lane(home);
        let fresh = self.lists[home.list as usize].is_fresh(home);
        if let Some(moved) = moved.filter(|_| !fresh) {
            // As `Constraint::gap_change` reckons, to the bit.
            let [a, b] = slots.each(|slot| moved[slot as usize]);
            let along = (b[0] - a[0]) * values[0] + (b[1] - a[1]) * values[1];
            for (levers, separation) in at::LEVERS.into_iter().zip(at::SEPARATION) {
                let change = along + (b[2] * values[levers + 1] - a[2] * values[levers]);
                values[separation] += change;
            }
        }
        values
    }

    /// Tells of each touching pair, with the gaps and impulses that its lane or its rows hold.
    pub fn each_contact(
        &self,
        manifolds: &Manifolds<L::Elem>,
        moved: Option<&[[L::Elem; 4]]>,
        in_rows: bool,
        mut tell: impl FnMut(&ContactRow<L::Elem>),
    ) {
        for &place in manifolds.touching() {
            let place = place as usize;
            let home = manifolds.homes()[place];
            if in_rows || !home.is_some() {
                tell(&manifolds.own_row(place));
                continue;
            }
            let values = self.read(home, manifolds.slots(place), moved);
            let [first, second] = at::SEPARATION;
            let [n0, n1, tangent, _] = impulses_of(&values);
            tell(&manifolds.row(place, ([values[first], values[second]], [n0, n1], tangent)));
        }
    }

    /// Writes what lanes hold to the pairs' rows, which stay where they are.
    pub fn write_rows(&self, manifolds: &mut Manifolds<L::Elem>, moved: Option<&[[L::Elem; 4]]>) {
        for k in 0..manifolds.len() {
            let place = manifolds.touching()[k] as usize;
            let home = manifolds.homes()[place];
            if home.is_some() {
                let values = self.read(home, manifolds.slots(place), moved);
                write(manifolds, place, &values);
            }
        }
    }

    /// Lanes take the impulses that the pairs' rows hold, and are to be prepared: before constraints are asked where a solver
    /// works on the pairs.
    pub fn take_rows(&mut self, manifolds: &Manifolds<L::Elem>) {
        for &place in manifolds.touching() {
            let home = manifolds.homes()[place as usize];
            if home.is_some() {
                let row = manifolds.impulses()[place as usize];
                self.lists[home.list as usize].set_impulses(home, row);
            }
        }
    }
}
