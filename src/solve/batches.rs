//! Contacts of one colour as constraints in batches of lanes: what passes visit.
//!
//! Padding lanes hold all zeros, between the bodies of their batch's first lane: what they do changes no row, and that lane is
//! written after them ([`Lanes::scatter_fours`]). So every loop over lanes is of fixed length. Only the last batch has some: what
//! leaves gives its lane to the last.

use super::constraint::{Constraint, LANE_VALUES, LaneValues, Parts};
use crate::contact::Manifolds;
use crate::each::Each as _;
use crate::lanes::{Lanes, Real};

/// What a pass does to one batch; `POINTS` is 1 or 2.
pub(super) trait Visit<L: Lanes> {
    /// The places of the pairs, and slots of bodies A and B, `WIDTH` each; `at` counts batches of as many points.
    fn visit<const POINTS: usize>(
        &mut self,
        constraint: &mut Constraint<L, POINTS>,
        ends: Ends<'_>,
        at: usize,
    );
}

/// Whom a batch's lanes join, as slots from the first of its part on: `WIDTH` entries each count. Slots are held by value: a scatter then needs no
/// second check of what the gather has checked.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ends<'a> {
    /// Slots of bodies A.
    pub a: &'a [u32; 16],
    /// Slots of bodies B.
    pub b: &'a [u32; 16],
    /// The gaps already know the displacements that others have yet to follow.
    pub fresh: bool,
}

/// Contacts that a list has room for when it gets its first.
const ROOM: usize = 64;

/// Batches of contacts solved with the same number of points.
#[derive(Clone, Debug)]
pub(super) struct Batches<L, const POINTS: usize> {
    constraints: Vec<Constraint<L, POINTS>>,
    /// The pair of each lane; `WIDTH` entries per batch, as are `a` and `b`.
    place: Vec<u32>,
    a: Vec<u32>,
    b: Vec<u32>,
    /// Which lanes' manifolds were found anew.
    stale: Vec<u32>,
    /// Batches prepared in this step.
    fresh: Vec<bool>,
    /// Lanes in use; all but the last batch are full.
    used: usize,
}

impl<L, const POINTS: usize> Default for Batches<L, POINTS> {
    fn default() -> Self {
        Self {
            constraints: Vec::new(),
            place: Vec::new(),
            a: Vec::new(),
            b: Vec::new(),
            stale: Vec::new(),
            fresh: Vec::new(),
            used: 0,
        }
    }
}

impl<L: Lanes, const POINTS: usize> Batches<L, POINTS> {
    pub(super) fn clear(&mut self) {
        self.used = 0;
        self.cut();
    }

    /// Drops batches without a lane in use.
    fn cut(&mut self) {
        let batches = self.used.div_ceil(L::WIDTH);
        self.constraints.truncate(batches);
        self.stale.truncate(batches);
        self.fresh.truncate(batches);
        for list in [&mut self.place, &mut self.a, &mut self.b] {
            list.truncate(batches * L::WIDTH);
        }
    }

    /// Batches.
    #[inline(always)]
    pub(super) fn len(&self) -> usize {
        self.constraints.len()
    }

    /// Contacts.
    pub(super) fn used(&self) -> usize {
        self.used
    }

    /// The pairs of lanes in use.
    pub(super) fn places(&self) -> &[u32] {
        &self.place[..self.used]
    }

    /// Slots of bodies A and B of a lane.
    pub(super) fn slots(&self, lane: u32) -> [u32; 2] {
        [self.a[lane as usize], self.b[lane as usize]]
    }

    /// Appends a contact; returns its lane, which holds zeros. With `alone` no other shares its batch.
    pub(super) fn push(&mut self, (place, [a, b]): (u32, [u32; 2]), padding: u32, alone: bool) -> u32 {
        if alone {
            self.used = self.len() * L::WIDTH;
        }
        let lane = self.used;
        if lane == self.len() * L::WIDTH {
            self.make_room();
            self.constraints.push(Constraint::nothing());
            self.stale.push(0);
            self.fresh.push(false);
            let lanes = self.len() * L::WIDTH;
            self.place.resize(lanes, padding);
            self.a.resize(lanes, 0);
            self.b.resize(lanes, 0);
        }
        (self.place[lane], self.a[lane], self.b[lane]) = (place, a, b);
        self.used += 1;
        if lane.is_multiple_of(L::WIDTH) {
            self.pad(lane / L::WIDTH);
        }
        lane as u32
    }

    /// Padding lanes of a batch get the slots of its first.
    fn pad(&mut self, batch: usize) {
        let first = batch * L::WIDTH;
        if batch < self.len() {
            let padding = self.used.clamp(first + 1, first + L::WIDTH)..first + L::WIDTH;
            for list in [&mut self.a, &mut self.b] {
                let slot = list[first];
                list[padding.clone()].fill(slot);
            }
        }
    }

    /// Room to spare, so that a list that wavers does not allocate.
    fn make_room(&mut self) {
        if self.constraints.capacity() > self.len() {
            return;
        }
        let more = self.len().max(ROOM.div_ceil(L::WIDTH));
        self.constraints.reserve(more);
        self.stale.reserve(more);
        self.fresh.reserve(more);
        for list in [&mut self.place, &mut self.a, &mut self.b] {
            list.reserve(more * L::WIDTH);
        }
    }

    /// Takes a contact out. The last lane moves to its place: returns the pair that has moved.
    pub(super) fn remove(&mut self, lane: u32, padding: u32) -> Option<u32> {
        let (lane, last) = (lane as usize, self.used - 1);
        let nothing = [L::Elem::ZERO; LANE_VALUES];
        let moved = (lane != last).then(|| {
            let values = self.lane(last as u32);
            self.constraints[lane / L::WIDTH].set_lane(lane % L::WIDTH, &values);
            for list in [&mut self.place, &mut self.a, &mut self.b] {
                list[lane] = list[last];
            }
            let stale = self.stale[last / L::WIDTH] >> (last % L::WIDTH) & 1;
            let bits = &mut self.stale[lane / L::WIDTH];
            *bits = *bits & !(1 << (lane % L::WIDTH)) | stale << (lane % L::WIDTH);
            self.place[lane]
        });
        self.constraints[last / L::WIDTH].set_lane(last % L::WIDTH, &nothing);
        self.stale[last / L::WIDTH] &= !(1 << (last % L::WIDTH));
        self.place[last] = padding;
        self.used = last;
        self.cut();
        self.pad(last / L::WIDTH);
        moved
    }

    /// What a lane holds.
    #[inline]
    pub(super) fn lane(&self, lane: u32) -> LaneValues<L::Elem> {
        self.constraints[lane as usize / L::WIDTH].lane(lane as usize % L::WIDTH)
    }

    /// Impulses of a lane: of both points, along the tangent, –; N·s.
    #[inline]
    pub(super) fn impulses(&self, lane: u32) -> [L::Elem; 4] {
        self.constraints[lane as usize / L::WIDTH].impulses(lane as usize % L::WIDTH)
    }

    /// Changes the impulses of a lane that is to be prepared; N·s.
    #[inline]
    pub(super) fn set_impulses(&mut self, lane: u32, row: [L::Elem; 4]) {
        self.constraints[lane as usize / L::WIDTH].set_impulses(lane as usize % L::WIDTH, row);
        self.touch(lane);
    }

    /// Changes what a lane holds.
    #[inline]
    pub(super) fn set_lane(&mut self, lane: u32, values: &LaneValues<L::Elem>) {
        self.constraints[lane as usize / L::WIDTH].set_lane(lane as usize % L::WIDTH, values);
    }

    /// Have a lane's gaps heard of the last displacements, because it was prepared after them?
    #[inline]
    pub(super) fn is_fresh(&self, lane: u32) -> bool {
        self.fresh[lane as usize / L::WIDTH]
    }

    /// Was a lane's manifold found anew since it was prepared?
    pub(super) fn is_stale(&self, lane: u32) -> bool {
        self.stale[lane as usize / L::WIDTH] >> (lane as usize % L::WIDTH) & 1 == 1
    }

    /// Notes that a lane's manifold was found anew.
    #[inline(always)]
    pub(super) fn touch(&mut self, lane: u32) {
        self.stale[lane as usize / L::WIDTH] |= 1 << (lane as usize % L::WIDTH);
    }

    /// Notes that the manifolds of all lanes in use were found anew.
    pub(super) fn touch_all(&mut self) {
        for (at, stale) in self.stale.iter_mut().enumerate() {
            *stale = (1 << L::WIDTH.min(self.used - at * L::WIDTH)) - 1;
        }
    }

    /// A lane's pair has another place.
    pub(super) fn rename(&mut self, lane: u32, place: u32) {
        self.place[lane as usize] = place;
    }

    /// The place that is no pair is another.
    #[inline]
    pub(super) fn rename_padding(&mut self, padding: u32) {
        self.place[self.used..].fill(padding);
    }

    /// Marks every constraint's separation as out of date.
    pub(super) fn age(&mut self) {
        self.fresh.fill(false);
    }

    #[inline(always)]
    pub(super) fn visit(&mut self, visitor: &mut impl Visit<L>, base: usize) {
        let count = self.len();
        // Slices once: in the loop they would be looked up again after every store.
        let (constraints, fresh) = (&mut self.constraints[..count], &self.fresh[..count]);
        let slots = [&self.a, &self.b].each(Vec::as_slice);
        for at in 0..count {
            // In full: handed out by a function, arrays cost a pass 6 % and more.
            let [of_a, of_b] = slots.each(|of| &of[at * L::WIDTH..][..L::WIDTH]);
            let (mut a, mut b) = ([0; 16], [0; 16]);
            for lane in 0..L::WIDTH {
                (a[lane], b[lane]) = (of_a[lane], of_b[lane]);
            }
            let ends = Ends { a: &a, b: &b, fresh: fresh[at] };
            visitor.visit(&mut constraints[at], ends, base + at);
        }
    }

    /// Prepares the lanes whose manifolds are new. What else is in their batches hears of `moved`, where it has not.
    pub(super) fn prepare(
        &mut self,
        manifolds: &Manifolds<L::Elem>,
        inverse_masses: &[[L::Elem; 4]],
        moved: Option<&[[L::Elem; 4]]>,
    ) {
        for at in 0..self.len() {
            let stale = std::mem::take(&mut self.stale[at]);
            if stale == 0 {
                continue;
            }
            let (a, b) = ends_of::<L>([&self.a, &self.b], at);
            let places = &self.place[at * L::WIDTH..(at + 1) * L::WIDTH];
            let constraint = &mut self.constraints[at];
            let parts = parts::<L, POINTS>(constraint, manifolds, inverse_masses, places, [&a, &b]);
            let lanes = L::WIDTH.min(self.used - at * L::WIDTH);
            if stale.count_ones() as usize == lanes {
                *constraint = Constraint::prepare(&parts);
            } else {
                if let Some(moved) = moved {
                    constraint.follow(moved, &Ends { a: &a, b: &b, fresh: self.fresh[at] });
                }
                constraint.take_lanes(&Constraint::prepare(&parts), stale);
            }
            self.fresh[at] = true;
        }
    }
}

/// Slots of one batch.
#[inline(always)]
fn ends_of<L: Lanes>([of_a, of_b]: [&[u32]; 2], at: usize) -> ([u32; 16], [u32; 16]) {
    let [of_a, of_b] = [of_a, of_b].each(|of| &of[at * L::WIDTH..][..L::WIDTH]);
    let (mut a, mut b) = ([0; 16], [0; 16]);
    for lane in 0..L::WIDTH {
        (a[lane], b[lane]) = (of_a[lane], of_b[lane]);
    }
    (a, b)
}

/// What a batch is prepared from: manifolds as found, masses, and the impulses it holds.
#[inline(always)]
fn parts<L: Lanes, const POINTS: usize>(
    held: &Constraint<L, POINTS>,
    manifolds: &Manifolds<L::Elem>,
    inverse_masses: &[[L::Elem; 4]],
    places: &[u32],
    slots: [&[u32; 16]; 2],
) -> Parts<L> {
    let mut two_points = [L::Elem::ZERO; 16];
    if POINTS == 2 {
        for (lane, &place) in places[..L::WIDTH].iter().enumerate() {
            two_points[lane] =
                if manifolds.code(place as usize).points() == 2 { L::Elem::ONE } else { L::Elem::ZERO };
        }
    }
    let masses = |slots: &[u32; 16]| {
        let [inv_mass, inv_inertia, length, _] = L::gather_fours(inverse_masses, slots);
        [inv_mass, inv_inertia, length]
    };
    let second = if POINTS == 2 { held.points[POINTS - 1].impulse() } else { L::zero() };
    Parts {
        geometry: L::gather_rows(manifolds.geometry(), places),
        gap: L::gather_fours(manifolds.gaps(), places),
        impulses: [held.points[0].impulse(), second, held.tangent_impulse],
        matter: slots.each(masses),
        two_points: L::zero().lt(L::load(&two_points)),
    }
}
