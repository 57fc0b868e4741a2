//! Long and huge bodies: floors, walls, anything whose bounding circle says little.
//!
//! A huge one is tested against all bodies in lanes: bounding circles first, then the other's circle against
//! the body's oriented box, clamped in the box's frame. Others are found by their circles like plain bodies, and their pairs
//! held against their boxes after. (Lost: each against all; 1500 planks of aspect 4 took 5.6 times as long as such of 2.9.)

use super::{meet, ordered};
use crate::body::{Bodies, BodyKind, Form};
use crate::column::Column;
use crate::each::Each as _;
use crate::lanes::{LaneMask, Lanes, Real, set_lanes};
use crate::vec2::{Rot, Vec2};

/// A box or polygon this many times longer than wide is long.
const LONG_ASPECT: f64 = 3.0;
/// A body this many times larger than the median movable body is huge.
const HUGE_RATIO: f64 = 4.0;

/// An oriented box that holds a long body.
#[derive(Clone, Copy, Debug)]
struct Bound<R> {
    slot: u32,
    /// Centre in the body frame, metres.
    centre: [R; 2],
    /// Half-extents, widened like the bounding radius.
    half: [R; 2],
    /// Tested against all; else found by its circle.
    huge: bool,
}

/// The long bodies of a world, and the others.
#[derive(Clone, Debug)]
pub(super) struct LongBodies<R> {
    bounds: Vec<Bound<R>>,
    /// Slots of bodies found by their circles, ascending.
    plain: Vec<u32>,
    /// Some of these are long.
    any_slender: bool,
    median_radius: f64,
    largest_radius: f64,
    all_dynamic: bool,
}

impl<R> Default for LongBodies<R> {
    fn default() -> Self {
        Self {
            bounds: Vec::new(),
            plain: Vec::new(),
            any_slender: false,
            median_radius: 0.0,
            largest_radius: 0.0,
            all_dynamic: false,
        }
    }
}

impl<R: Real> LongBodies<R> {
    pub(super) fn plain_slots(&self) -> &[u32] {
        &self.plain
    }

    pub(super) fn slots(&self) -> impl Iterator<Item = u32> + '_ {
        self.bounds.iter().map(|bound| bound.slot)
    }

    /// Some body, where all are plain and dynamic.
    pub(super) fn all_free(&self) -> Option<usize> {
        let first = self.plain.first().map(|&slot| slot as usize);
        first.filter(|_| self.bounds.is_empty() && self.all_dynamic)
    }

    /// Of movable bodies, metres; infinite where none moves.
    pub(super) fn median_radius(&self) -> f64 {
        self.median_radius
    }

    /// Of movable bodies, metres; 0 where none moves.
    pub(super) fn largest_radius(&self) -> f64 {
        self.largest_radius
    }

    /// Splits the living bodies into long and plain ones.
    pub(super) fn classify(&mut self, bodies: &Bodies<R>) {
        let mut radii: Vec<f64> = bodies
            .slots()
            .filter(|&slot| bodies.kind(slot) != BodyKind::Static)
            .map(|slot| bodies.radius[slot].to_f64())
            .collect();
        radii.sort_unstable_by(f64::total_cmp);
        let median = radii.get(radii.len() / 2).copied().unwrap_or(f64::INFINITY);
        self.median_radius = median;
        self.largest_radius = radii.last().copied().unwrap_or(0.0);
        self.bounds.clear();
        self.plain.clear();
        self.any_slender = false;
        self.all_dynamic = bodies.slots().all(|slot| bodies.kind(slot) == BodyKind::Dynamic);
        for slot in bodies.slots() {
            let (low, high) = extent(bodies, slot);
            let half = [(high[0] - low[0]) / 2.0, (high[1] - low[1]) / 2.0];
            let aspect = half[0].max(half[1]) / half[0].min(half[1]);
            let huge = bodies.radius[slot].to_f64() > HUGE_RATIO * median;
            if aspect >= LONG_ASPECT || huge {
                self.any_slender |= !huge;
                self.bounds.push(Bound {
                    huge,
                    slot: slot as u32,
                    centre: [
                        R::from_f64(f64::midpoint(low[0], high[0])),
                        R::from_f64(f64::midpoint(low[1], high[1])),
                    ],
                    half: half.each(|h| R::from_f64(h * (1.0 + 1e-5))),
                });
            }
            if !huge {
                self.plain.push(slot as u32);
            }
        }
    }

    /// Is a body in a slot huge?
    pub(super) fn is_huge(&self, slot: u32) -> bool {
        self.bound_of(slot).is_some_and(|bound| bound.huge)
    }

    fn bound_of(&self, slot: u32) -> Option<&Bound<R>> {
        let at = self.bounds.binary_search_by_key(&slot, |bound| bound.slot).ok()?;
        Some(&self.bounds[at])
    }

    /// Drops the pairs found by their circles whose boxes say no.
    pub(super) fn hold_against_boxes(
        &self,
        bodies: &Bodies<R>,
        reach: &Column<R>,
        pairs: &mut Vec<[u32; 2]>,
    ) {
        if self.any_slender {
            let meets = |own: u32, other: u32| {
                self.bound_of(own).is_none_or(|bound| {
                    let k = other as usize;
                    let own = Placed::<R>::new(bodies, bound, reach);
                    own.meets(bodies.x[k], bodies.y[k], bodies.radius[k] + reach[k]).any()
                })
            };
            pairs.retain(|&[a, b]| meets(a, b) && meets(b, a));
        }
    }

    /// Appends the pairs that have a huge body in them.
    pub(super) fn find<L: Lanes<Elem = R>>(
        &self,
        bodies: &Bodies<R>,
        reach: &Column<R>,
        pairs: &mut Vec<[u32; 2]>,
    ) {
        self.find_of::<L>(bodies, reach, |_| true, pairs);
    }

    /// Like [`LongBodies::find`], for the long bodies whose slots are `wanted`: a pair of two such is found if the
    /// lower one's is.
    pub(super) fn find_of<L: Lanes<Elem = R>>(
        &self,
        bodies: &Bodies<R>,
        reach: &Column<R>,
        wanted: impl Fn(u32) -> bool,
        pairs: &mut Vec<[u32; 2]>,
    ) {
        let (xs, ys) = (bodies.x.lanes::<L>(), bodies.y.lanes::<L>());
        let radii = bodies.radius.lanes::<L>();
        for bound in self.bounds.iter().filter(|bound| bound.huge && wanted(bound.slot)) {
            let own = Placed::<L>::new(bodies, bound, reach);
            for chunk in 0..bodies.len().div_ceil(L::WIDTH) {
                let hits = own.meets(xs[chunk], ys[chunk], radii[chunk] + reach.lanes::<L>()[chunk]);
                for lane in set_lanes(hits.bits()) {
                    self.accept(bodies, reach, bound, (chunk * L::WIDTH + lane) as u32, pairs);
                }
            }
        }
    }

    /// What [`LongBodies::find_of`] left out of pairs with `others`: those of the long bodies that are not `wanted`.
    pub(super) fn find_near(
        &self,
        bodies: &Bodies<R>,
        reach: &Column<R>,
        wanted: impl Fn(u32) -> bool,
        others: &[u32],
        pairs: &mut Vec<[u32; 2]>,
    ) {
        for bound in self.bounds.iter().filter(|bound| bound.huge && !wanted(bound.slot)) {
            let own = Placed::<R>::new(bodies, bound, reach);
            for &other in others {
                let k = other as usize;
                if own.meets(bodies.x[k], bodies.y[k], bodies.radius[k] + reach[k]).any() {
                    self.accept(bodies, reach, bound, other, pairs);
                }
            }
        }
    }

    /// A pair of huge bodies is met twice: the lower slot reports it. If the other has a box, that must agree.
    fn accept(
        &self,
        bodies: &Bodies<R>,
        reach: &Column<R>,
        bound: &Bound<R>,
        other: u32,
        pairs: &mut Vec<[u32; 2]>,
    ) {
        // A reach that overflows covers padding too.
        if other == bound.slot || other as usize >= bodies.len() {
            return;
        }
        if let Some(their) = self.bound_of(other) {
            let k = bound.slot as usize;
            let theirs = Placed::<R>::new(bodies, their, reach);
            let radius = bodies.radius[k] + reach[k];
            if (their.huge && other < bound.slot) || !theirs.meets(bodies.x[k], bodies.y[k], radius).any() {
                return;
            }
        }
        pairs.push(ordered(bound.slot, other));
    }
}

/// A long body where it is now, in every lane.
struct Placed<L> {
    x: L,
    y: L,
    r: L,
    rot: Rot<L>,
    centre: Vec2<L>,
    half: Vec2<L>,
}

impl<L: Lanes> Placed<L> {
    fn new(bodies: &Bodies<L::Elem>, bound: &Bound<L::Elem>, reach: &Column<L::Elem>) -> Self {
        let k = bound.slot as usize;
        let half = bound.half.each(|h| h + reach[k]);
        Self {
            x: L::splat(bodies.x[k]),
            y: L::splat(bodies.y[k]),
            r: L::splat(bodies.radius[k] + reach[k]),
            rot: Rot { c: L::splat(bodies.c[k]), s: L::splat(bodies.s[k]) },
            centre: Vec2::splat(bound.centre),
            half: Vec2::splat(half),
        }
    }

    /// Which circles meet both the bounding circle and the oriented box. Slots that are holes, and the
    /// world, are out of reach of both.
    #[inline(always)]
    fn meets(&self, x: L, y: L, r: L) -> L::Mask {
        let local = self.rot.apply_inverse(Vec2::new(x - self.x, y - self.y)) - self.centre;
        let beyond = |v: L, half: L| L::zero().max(v.abs() - half);
        let gap = Vec2::new(beyond(local.x, self.half.x), beyond(local.y, self.half.y));
        meet(self.x, self.y, self.r, x, y, r) & gap.length_squared().le(r * r)
    }
}

/// Lower and upper corner of the body's shape in its own frame.
fn extent<R: Real>(bodies: &Bodies<R>, slot: usize) -> ([f64; 2], [f64; 2]) {
    let (hx, hy) = (bodies.extent_x[slot].to_f64(), bodies.extent_y[slot].to_f64());
    match bodies.form(slot) {
        Form::Circle => ([-hx, -hx], [hx, hx]),
        Form::Box => ([-hx, -hy], [hx, hy]),
        Form::Polygon => {
            let at = bodies.shapes(slot).start;
            let range = |row: &[R]| {
                row.iter().map(|v| v.to_f64()).fold((f64::MAX, f64::MIN), |(l, h), v| (l.min(v), h.max(v)))
            };
            let [x, y, ..] = &bodies.polygons.body[at];
            let (x, y) = (range(x), range(y));
            ([x.0, y.0], [x.1, y.1])
        }
    }
}
