//! Narrow phase: pairs bucketed by form, one batched kernel per pair of forms.
//!
//! Forms are ordered circle < box < polygon, so six buckets cover all pairs; within a pair the body of
//! the lesser form is A. A kernel sees `WIDTH` pairs as lanes of [`Pose`]s and answers with [`Found`].
//! The last batch of a bucket is padded with the world against itself and its answer masked away.
//! Which pairs share a batch never changes an answer: loops that run to the batch's largest vertex
//! count meet only repeated vertices beyond a lane's own.
//!
//! Pairs of an outline of which neighbours cover something are met one by one (`seamed.rs`).
//!
//! A pair is looked at when it is new or one of its bodies has moved ([`MovedBodies`]); else it keeps its manifold.

mod box_box;
mod circle_box;
mod circle_circle;
mod circle_polygon;
mod clip;
mod look;
mod margin;
mod passing;
mod polygon_polygon;
mod seamed;
mod todo;

use crate::body::{Bodies, Form};
use crate::column::{Column, PAD};
use crate::contact::Manifolds;
use crate::each::Each as _;
use crate::lanes::{IN_ORDER, Lanes, ROW, Real};
use crate::motion::Near;
use crate::seams::Seams;
use crate::vec2::{Rot, Vec2};
use crate::workers::{Parts, Workers, share_rows};

use margin::Margin;
use polygon_polygon::Hull;
use todo::Todo;

pub use passing::Stride;

/// Where `WIDTH` bodies are and what they are like.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pose<L> {
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
        // The entries of a body's pose row, in order.
        let [x, y, c, s, ex, ey, friction, restitution] = L::gather_rows(rows, index);
        Self { x: Vec2::new(x, y), rot: Rot { c, s }, extent: Vec2::new(ex, ey), friction, restitution }
    }
}

/// What a kernel answers for `WIDTH` pairs.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Found<L: Lanes> {
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

/// Which bodies have moved more than a little since their manifolds were found.
#[derive(Clone, Copy, Debug)]
pub enum MovedBodies<'a> {
    /// All of them: every pair is looked at.
    All,
    /// Those whose slots hold `true`.
    These(&'a [bool]),
}

/// Pose rows, the pairs to look at and the manifolds found; memory is kept from step to step.
#[derive(Clone, Debug)]
pub struct Narrow<R: Real> {
    poses: Column<R>,
    /// Rows of four per slot: vx, vy, bounding radius, inner radius of what moves; only where a margin looks ahead.
    speeds: Column<R>,
    /// What centroids are beyond the rows of `poses`; see [`Bodies::fine`].
    fine: Column<R>,
    is_fine: bool,
    todo: [Todo; 6],
    /// Slots of the bodies in pairs to look at, where they are few; else all are.
    wanted: Vec<u32>,
    /// Per slot, whether it is among them.
    is_wanted: Vec<bool>,
    few: bool,
    /// What of static outlines is covered, and the places of pairs to look at of which one body is such a one.
    seams: Seams,
    seamed: Vec<u32>,
    /// The manifolds of all pairs.
    pub manifolds: Manifolds<R>,
}

impl<R: Real> Default for Narrow<R> {
    fn default() -> Self {
        Self {
            poses: Column::new(R::ZERO),
            speeds: Column::new(R::ZERO),
            fine: Column::new(R::ZERO),
            is_fine: false,
            todo: Default::default(),
            wanted: Vec::new(),
            is_wanted: Vec::new(),
            few: false,
            seams: Seams::default(),
            seamed: Vec::new(),
            manifolds: Manifolds::default(),
        }
    }
}

impl<R: Real> Narrow<R> {
    /// Finds the contacts of `pairs`: points closer than `margin` metres (0: only where bodies overlap).
    ///
    /// Reads poses and shapes; polygons' world rows must be fresh ([`Bodies::refresh_polygons`]).
    pub fn run<L: Lanes<Elem = R>>(&mut self, bodies: &Bodies<R>, pairs: &[[u32; 2]], margin: R) {
        self.rebuild(bodies, pairs);
        self.choose(bodies.len(), MovedBodies::All);
        let stride = Stride { secs: R::ZERO, fallen: [R::ZERO; 2] };
        let alone = (&Workers::ALONE, &Parts::default());
        self.collide::<L>(alone, bodies, margin.into(), R::ZERO, stride);
        self.manifolds.refresh();
    }

    /// Takes a new list of pairs; it serves until the next.
    pub fn rebuild(&mut self, bodies: &Bodies<R>, pairs: &[[u32; 2]]) {
        self.manifolds.rebuild(pairs, |[a, b]| {
            let (form_a, form_b) = (bodies.form(a as usize), bodies.form(b as usize));
            let flips = form_a > form_b;
            (if flips { bucket_of(form_b, form_a) } else { bucket_of(form_a, form_b) }, flips)
        });
    }

    /// Chooses the pairs last dealt that are new or have a moved body, of which there are `bodies`. Returns how
    /// many.
    pub fn choose(&mut self, bodies: usize, has_moved: MovedBodies<'_>) -> usize {
        for (number, todo) in self.todo.iter_mut().enumerate() {
            todo.fill(&self.manifolds, number, has_moved);
        }
        self.set_seamed_apart();
        let chosen = self.todo.iter().map(|todo| todo.len).sum::<usize>() + self.seamed.len();
        self.few = 4 * chosen < bodies;
        for slot in self.wanted.drain(..) {
            self.is_wanted[slot as usize] = false;
        }
        self.wanted.reserve(bodies);
        self.is_wanted.resize(bodies, false);
        if self.few {
            for todo in &self.todo {
                for &slot in todo.a[..todo.len].iter().chain(&todo.b[..todo.len]) {
                    if !std::mem::replace(&mut self.is_wanted[slot as usize], true) {
                        self.wanted.push(slot);
                    }
                }
            }
        }
        chosen
    }

    /// Slots of the bodies in pairs that will be looked at, where they are few; else all may be.
    pub fn wanted(&self) -> Option<&[u32]> {
        self.few.then_some(&self.wanted)
    }

    /// Finds the contacts of the pairs chosen; see [`Narrow::run`]. The margin of a pair is wider by what its
    /// centroids can close in `ahead_secs`, up to half the smaller one's radius: a contact is there before bodies overlap.
    /// What is apart now and will not meet in a stride is no contact (`passing.rs`).
    pub(crate) fn collide<L: Lanes<Elem = R>>(
        &mut self,
        shares: (&Workers, &Parts),
        bodies: &Bodies<R>,
        margin: Near<R>,
        ahead_secs: R,
        stride: Stride<R>,
    ) {
        self.meet_seamed(bodies, margin, ahead_secs);
        if self.todo.iter().all(|todo| todo.len == 0) {
            return;
        }
        self.write_poses::<L>(shares, bodies);
        self.is_fine = bodies.fine.is_some();
        if let Some(rows) = &bodies.fine {
            self.fine.clone_from(rows);
        }
        if ahead_secs > R::ZERO || margin.share > R::ZERO {
            self.write_speeds::<L>(shares, bodies);
        }
        let [still, share, ahead] = [margin.metres, margin.share, ahead_secs].each(L::splat);
        let margin = Margin { still, share, ahead, stride };
        let [cc, cb, cp, bb, bp, pp] = std::mem::take(&mut self.todo);
        self.run_bucket::<L>(shares, bodies, &cc, margin, |a, b, _, margin| {
            circle_circle::collide(a, b, margin)
        });
        self.run_bucket::<L>(shares, bodies, &cb, margin, |a, b, _, margin| {
            circle_box::collide(a, b, margin)
        });
        self.run_bucket::<L>(shares, bodies, &bb, margin, |a, b, _, margin| box_box::collide(a, b, margin));
        // Loops over edges are unrolled to the next of these: a third fewer instructions than counted ones.
        match bodies.polygons.max_count() {
            0..=4 => self.run_edged::<L, 4>(shares, bodies, [&cp, &bp, &pp], margin),
            5 | 6 => self.run_edged::<L, 6>(shares, bodies, [&cp, &bp, &pp], margin),
            _ => self.run_edged::<L, 8>(shares, bodies, [&cp, &bp, &pp], margin),
        }
        self.todo = [cc, cb, cp, bb, bp, pp];
    }

    /// The buckets with polygons, none of which has more than `EDGES` vertices.
    fn run_edged<L: Lanes<Elem = R>, const EDGES: usize>(
        &mut self,
        shares: (&Workers, &Parts),
        bodies: &Bodies<R>,
        [cp, bp, pp]: [&Todo; 3],
        margin: Margin<L>,
    ) {
        let hull =
            |slots: &[u32]| Hull::<L>::gather(&bodies.polygons.world, &polygon_index::<L, R>(bodies, slots));
        self.run_bucket::<L>(shares, bodies, cp, margin, |a, b, [_, ib], margin| {
            circle_polygon::collide(a, b, &hull(ib), EDGES, margin)
        });
        self.run_bucket::<L>(shares, bodies, bp, margin, |a, b, [_, ib], margin| {
            polygon_polygon::collide::<L, EDGES>(a, b, &Hull::of_box(a), &hull(ib), margin)
        });
        self.run_bucket::<L>(shares, bodies, pp, margin, |a, b, [ia, ib], margin| {
            polygon_polygon::collide::<L, EDGES>(a, b, &hull(ia), &hull(ib), margin)
        });
    }

    /// Pairs in each bucket, with the bucket's forms.
    pub fn bucket_sizes(&self) -> [(Form, Form, usize); 6] {
        crate::each::indexed(|k| (BUCKETS[k].0, BUCKETS[k].1, self.manifolds.bucket(k).len()))
    }

    /// All manifolds, and the places of the pairs last looked at.
    pub fn found(&mut self) -> (&mut Manifolds<R>, impl Iterator<Item = &[u32]> + Clone) {
        (&mut self.manifolds, looked_at(&self.todo, &self.seamed))
    }

    /// The deepest overlap of the pairs last looked at, negative, as a share of its pair's length; 0 where there is none. Read out
    /// of what was found, as few steps ask (noted while looking it cost all of them 2 to 7 % of this phase).
    pub fn deepest(&self, bodies: &Bodies<R>) -> f64 {
        let places = looked_at(&self.todo, &self.seamed).flatten().map(|&place| place as usize);
        let gaps = places.flat_map(|at| {
            let [a, b] = self.manifolds.slots(at).map(|slot| bodies.length(slot as usize).to_f64());
            let found = &self.manifolds.gaps()[at][..self.manifolds.code(at).points()];
            found.iter().map(move |gap| gap.to_f64() / a.min(b))
        });
        gaps.fold(0.0, f64::min)
    }

    fn write_poses<L: Lanes<Elem = R>>(&mut self, shares: (&Workers, &Parts), bodies: &Bodies<R>) {
        let padded = bodies.len().next_multiple_of(PAD);
        self.poses.resize(padded * ROW);
        self.speeds.resize(padded * 4);
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
        .each(Column::lanes::<L>);
        let rows = self.poses.rows_mut();
        if self.few {
            let columns = columns.each(bytemuck::cast_slice::<L, R>);
            for slot in self.wanted.iter().map(|&slot| slot as usize) {
                rows[slot] = columns.each(|column| column[slot]);
            }
            return;
        }
        share_rows(shares, &mut rows[..padded], |first, rows| {
            for (at, rows) in (first / L::WIDTH..).zip(rows.chunks_exact_mut(L::WIDTH)) {
                L::store_rows(columns.each(|column| column[at]), rows);
            }
        });
    }

    fn write_speeds<L: Lanes<Elem = R>>(&mut self, shares: (&Workers, &Parts), bodies: &Bodies<R>) {
        let columns = [&bodies.vx, &bodies.vy, &bodies.radius, &bodies.core];
        if self.few {
            for slot in self.wanted.iter().map(|&slot| slot as usize) {
                let [vx, vy, radius, core] = columns.each(|column| column[slot]);
                let inner = if core < R::FAR { core + core } else { R::ZERO };
                self.speeds.fours_mut()[slot] = [vx, vy, radius, inner];
            }
            return;
        }
        let columns = columns.each(Column::lanes::<L>);
        let rows = &mut self.speeds.fours_mut()[..bodies.len().next_multiple_of(PAD)];
        share_rows(shares, rows, |first, rows| {
            for (at, rows) in (first / L::WIDTH..).zip(rows.chunks_exact_mut(L::WIDTH)) {
                let [vx, vy, radius, core] = columns.each(|column| column[at]);
                // The core is half of the inner radius, of what moves.
                let inner = L::select(core.lt(L::splat(R::FAR)), core + core, L::zero());
                L::scatter_fours([vx, vy, radius, inner], rows, &IN_ORDER);
            }
        });
    }
}

fn looked_at<'a>(todo: &'a [Todo; 6], seamed: &'a [u32]) -> impl Iterator<Item = &'a [u32]> + Clone {
    todo.iter().map(|todo| &todo.place[..todo.len]).chain(std::iter::once(seamed))
}

/// Where the polygons of `WIDTH` bodies are; the world, in padding lanes, has polygon 0 and is masked away.
#[inline(always)]
fn polygon_index<L: Lanes, R: Real>(bodies: &Bodies<R>, slots: &[u32]) -> [u32; 16] {
    let mut index = [0; 16];
    for (lane, &slot) in slots[..L::WIDTH].iter().enumerate() {
        index[lane] = bodies.shapes(slot as usize).start as u32;
    }
    index
}
