//! Narrow phase: pairs bucketed by form, one batched kernel per pair of forms.
//!
//! Forms are ordered circle < box < polygon, so six buckets cover all pairs; within a pair the body of
//! the lesser form is A. A kernel sees `WIDTH` pairs as lanes of [`Pose`]s and answers with [`Found`].
//! The last batch of a bucket is padded with the world against itself and its answer masked away.
//! Which pairs share a batch never changes an answer: loops that run to the batch's largest vertex
//! count meet only repeated vertices beyond a lane's own.

mod box_box;
mod circle_box;
mod circle_circle;
mod circle_polygon;
mod clip;
mod polygon_polygon;

use crate::body::{Bodies, Form};

use crate::column::{Column, PAD};
use crate::contact::{Key, Manifolds};
use crate::lanes::{LaneMask, Lanes, ROW, Real, set_lanes};
use crate::vec2::{Rot, Vec2};

use polygon_polygon::Hull;

/// Entries of a pose row: what one gather brings of a body.
const POSE_ENTRIES: &str = "x, y, c, s, extent_x, extent_y, friction, restitution";

/// Where `WIDTH` bodies are and what they are like.
#[derive(Clone, Copy, Debug)]
pub struct Pose<L> {
    /// Centroid, metres.
    pub x: Vec2<L>,
    /// Attitude.
    pub rot: Rot<L>,
    /// Radius of a circle, half-extents of a box.
    pub extent: Vec2<L>,
    friction: L,
    restitution: L,
}

impl<L: Lanes> Pose<L> {
    #[inline(always)]
    fn gather(rows: &[[L::Elem; ROW]], index: &[u32]) -> Self {
        debug_assert_eq!(POSE_ENTRIES.split(", ").count(), ROW);
        let [x, y, c, s, ex, ey, friction, restitution] = L::gather_rows(rows, index);
        Self { x: Vec2::new(x, y), rot: Rot { c, s }, extent: Vec2::new(ex, ey), friction, restitution }
    }
}

/// What a kernel answers for `WIDTH` pairs.
#[derive(Clone, Copy, Debug)]
pub struct Found<L: Lanes> {
    /// Unit normal from A to B.
    pub normal: Vec2<L>,
    /// Arms from A's centroid, world axes, metres; midway between the surfaces.
    pub arms: [Vec2<L>; 2],
    /// Metres, negative where they overlap.
    pub separations: [L; 2],
    /// Feature ids as whole numbers; `None` where all are 0.
    pub features: Option<[L; 2]>,
    /// Which points exist; where the second does, so does the first.
    pub hits: [L::Mask; 2],
}

impl<L: Lanes> Found<L> {
    /// One point: feature 0, no second point.
    #[inline(always)]
    fn single(normal: Vec2<L>, arm: Vec2<L>, separation: L, margin: L) -> Self {
        let never = L::one().lt(L::zero());
        Self {
            normal,
            arms: [arm, Vec2::zero()],
            separations: [separation, L::zero()],
            features: None,
            hits: [separation.le(margin), never],
        }
    }
}

/// The six buckets, named by their forms.
const BUCKETS: [(Form, Form); 6] = [
    (Form::Circle, Form::Circle),
    (Form::Circle, Form::Box),
    (Form::Circle, Form::Polygon),
    (Form::Box, Form::Box),
    (Form::Box, Form::Polygon),
    (Form::Polygon, Form::Polygon),
];

/// Forms ordered, the bucket is `a + b + (a > 0)`: 0, 1, 2, then 3, 4, then 5.
#[inline(always)]
fn bucket_of(a: Form, b: Form) -> usize {
    a as usize + b as usize + usize::from(a != Form::Circle)
}

/// Pose rows, buckets and the manifolds found; memory is kept from step to step.
#[derive(Clone, Debug)]
pub struct Narrow<R: Real> {
    poses: Column<R>,
    buckets: [Bucket; 6],
    /// Rows and feature ids of one batch, lane by lane.
    scratch: [[[R; ROW]; 16]; 2],
    features: [[R; 16]; 2],
    /// The contacts of the last [`Narrow::run`].
    pub manifolds: Manifolds<R>,
}

impl<R: Real> Default for Narrow<R> {
    fn default() -> Self {
        Self {
            poses: Column::new(R::ZERO),
            buckets: Default::default(),
            scratch: [[[R::ZERO; ROW]; 16]; 2],
            features: [[R::ZERO; 16]; 2],
            manifolds: Manifolds::default(),
        }
    }
}

impl<R: Real> Narrow<R> {
    /// Finds the contacts of `pairs`: points closer than `margin` metres (0: only where bodies overlap).
    ///
    /// Reads poses and shapes; polygons' world rows must be fresh ([`Bodies::refresh_polygons`]).
    pub fn run<L: Lanes<Elem = R>>(&mut self, bodies: &Bodies<R>, pairs: &[[u32; 2]], margin: R) {
        self.deal(bodies, pairs);
        self.collide::<L>(bodies, margin);
    }

    /// Deals pairs into buckets; they serve until the list of pairs changes.
    pub fn deal(&mut self, bodies: &Bodies<R>, pairs: &[[u32; 2]]) {
        for bucket in &mut self.buckets {
            bucket.clear();
        }
        for &[a, b] in pairs {
            let (form_a, form_b) = (bodies.form(a as usize), bodies.form(b as usize));
            let pair = if form_a <= form_b { [a, b] } else { [b, a] };
            self.buckets[bucket_of(form_a.min(form_b), form_a.max(form_b))].push(pair);
        }
        for bucket in &mut self.buckets {
            bucket.pad();
        }
    }

    /// Finds the contacts of the pairs last dealt; see [`Narrow::run`].
    pub fn collide<L: Lanes<Elem = R>>(&mut self, bodies: &Bodies<R>, margin: R) {
        self.manifolds.clear();
        if self.buckets.iter().all(|bucket| bucket.len == 0) {
            return;
        }
        self.write_poses::<L>(bodies);
        let margin = L::splat(margin);
        let [cc, cb, cp, bb, bp, pp] = std::mem::take(&mut self.buckets);
        self.run_bucket::<L>(0, &cc, |a, b, _| circle_circle::collide(a, b, margin));
        self.run_bucket::<L>(1, &cb, |a, b, _| circle_box::collide(a, b, margin));
        // Loops over edges are unrolled to the next of these: a third fewer instructions than counted ones.
        match bodies.polygons.max_count() {
            0..=4 => self.run_edged::<L, 4>(bodies, [&cp, &bb, &bp, &pp], margin),
            5 | 6 => self.run_edged::<L, 6>(bodies, [&cp, &bb, &bp, &pp], margin),
            _ => self.run_edged::<L, 8>(bodies, [&cp, &bb, &bp, &pp], margin),
        }
        self.buckets = [cc, cb, cp, bb, bp, pp];
    }

    /// The buckets from circle–polygon on, in the order of their numbers (carried impulses are found by it);
    /// no polygon has more than `EDGES` vertices.
    fn run_edged<L: Lanes<Elem = R>, const EDGES: usize>(
        &mut self,
        bodies: &Bodies<R>,
        [cp, bb, bp, pp]: [&Bucket; 4],
        margin: L,
    ) {
        let hull =
            |slots: &[u32]| Hull::<L>::gather(&bodies.polygons.world, &polygon_index::<L, R>(bodies, slots));
        self.run_bucket::<L>(2, cp, |a, b, [_, ib]| circle_polygon::collide(a, b, &hull(ib), EDGES, margin));
        self.run_bucket::<L>(3, bb, |a, b, _| box_box::collide(a, b, margin));
        self.run_bucket::<L>(4, bp, |a, b, [_, ib]| {
            polygon_polygon::collide::<L, EDGES>(a, b, &Hull::of_box(a), &hull(ib), margin)
        });
        self.run_bucket::<L>(5, pp, |a, b, [ia, ib]| {
            polygon_polygon::collide::<L, EDGES>(a, b, &hull(ia), &hull(ib), margin)
        });
    }

    /// Pairs that went into each bucket in the last run, with the bucket's forms.
    pub fn bucket_sizes(&self) -> [(Form, Form, usize); 6] {
        std::array::from_fn(|k| (BUCKETS[k].0, BUCKETS[k].1, self.buckets[k].len))
    }

    fn write_poses<L: Lanes<Elem = R>>(&mut self, bodies: &Bodies<R>) {
        self.poses.resize(bodies.len().next_multiple_of(PAD) * ROW);
        let columns = [
            &bodies.x,
            &bodies.y,
            &bodies.c,
            &bodies.s,
            &bodies.extent_x,
            &bodies.extent_y,
            &bodies.friction,
            &bodies.restitution,
        ]
        .map(Column::lanes::<L>);
        let rows = self.poses.rows_mut();
        for at in 0..bodies.len().div_ceil(L::WIDTH) {
            L::store_rows(columns.map(|column| column[at]), &mut rows[at * L::WIDTH..]);
        }
    }

    #[inline(always)]
    fn run_bucket<L: Lanes<Elem = R>>(
        &mut self,
        number: u16,
        bucket: &Bucket,
        collide: impl Fn(&Pose<L>, &Pose<L>, [&[u32]; 2]) -> Found<L>,
    ) {
        self.manifolds.reserve(bucket.len + 16);
        let mut at = 0;
        while at < bucket.len {
            let slots = [&bucket.a[at..at + L::WIDTH], &bucket.b[at..at + L::WIDTH]];
            let a = Pose::gather(self.poses.rows(), slots[0]);
            let b = Pose::gather(self.poses.rows(), slots[1]);
            let found = collide(&a, &b, slots);
            let real_lanes = (1u32 << (bucket.len - at).min(L::WIDTH)) - 1;
            let hits = found.hits.map(|mask| mask.bits() & real_lanes);
            if hits[0] != 0 {
                self.keep(&a, &b, &found, hits, slots, number);
            }
            at += L::WIDTH;
        }
    }

    #[inline(always)]
    fn keep<L: Lanes<Elem = R>>(
        &mut self,
        a: &Pose<L>,
        b: &Pose<L>,
        found: &Found<L>,
        hits: [u32; 2],
        slots: [&[u32]; 2],
        bucket: u16,
    ) {
        let from_b = a.x - b.x;
        let [arm0, arm1] = found.arms;
        let [arm_b0, arm_b1] = found.arms.map(|arm| arm + from_b);
        let (friction, restitution) = (a.friction.min(b.friction), a.restitution.min(b.restitution));
        let ([s0, s1], zero) = (found.separations, L::zero());
        let geometry = [found.normal.x, found.normal.y, arm0.x, arm0.y, arm1.x, arm1.y, s0, s1];
        let surface = [arm_b0.x, arm_b0.y, arm_b1.x, arm_b1.y, friction, restitution, zero, zero];
        if let Some(features) = found.features {
            features[0].store(&mut self.features[0]);
            features[1].store(&mut self.features[1]);
        }
        let key = |lane: usize| Key {
            a: slots[0][lane],
            b: slots[1][lane],
            features: match found.features {
                Some(_) => [0, 1].map(|k| self.features[k][lane].to_f64() as u16),
                None => [0; 2],
            },
            points: 1 + (hits[1] >> lane & 1) as u16,
            bucket,
        };
        if hits[0].count_ones() as usize == L::WIDTH {
            // Every lane touches, as in a pile most do: rows go straight to their places.
            self.manifolds.push_all::<L>((0..L::WIDTH).map(key), geometry, surface);
        } else {
            let [geometry_rows, surface_rows] = &mut self.scratch;
            L::store_rows(geometry, geometry_rows);
            L::store_rows(surface, surface_rows);
            for lane in set_lanes(hits[0]) {
                self.manifolds.push(key(lane), geometry_rows[lane], surface_rows[lane]);
            }
        }
    }
}

/// The pairs of one pair of forms, A and B apart so that a batch's slots are two slices.
#[derive(Clone, Debug, Default)]
struct Bucket {
    a: Vec<u32>,
    b: Vec<u32>,
    /// Pairs; behind them the world against itself, up to whole lanes at every width.
    len: usize,
}

impl Bucket {
    fn clear(&mut self) {
        self.a.clear();
        self.b.clear();
    }

    #[inline(always)]
    fn push(&mut self, [a, b]: [u32; 2]) {
        self.a.push(a);
        self.b.push(b);
    }

    fn pad(&mut self) {
        self.len = self.a.len();
        let padded = self.len.next_multiple_of(16);
        self.a.resize(padded, 0);
        self.b.resize(padded, 0);
    }
}

/// Where the polygons of `WIDTH` bodies are; the world, in padding lanes, has polygon 0 and is masked away.
#[inline(always)]
fn polygon_index<L: Lanes, R: Real>(bodies: &Bodies<R>, slots: &[u32]) -> [u32; 16] {
    let mut index = [0; 16];
    for (index, &slot) in index[..L::WIDTH].iter_mut().zip(slots) {
        *index = bodies.shapes(slot as usize).start as u32;
    }
    index
}
