//! One bucket's pairs looked at, batch by batch.

use std::ops::Range;

use super::margin::{Ahead, Margin, lengths};
use super::todo::Todo;
use super::{Found, Narrow, Pose, passing};
use crate::body::{Bodies, fine_difference};
use crate::contact::{Code, Places};
use crate::each::Each as _;
use crate::lanes::{LaneMask, Lanes, ROW, Real};
use crate::settings::MOST_THREADS;
use crate::vec2::Vec2;
use crate::workers::{Parts, Workers};

/// What is known of bodies, in rows per slot.
struct Gathered<'a, R: Real> {
    bodies: &'a Bodies<R>,
    poses: &'a [[R; ROW]],
    speeds: &'a [[R; 4]],
    fine: Option<&'a [[R; 4]]>,
}

/// Pairs of a bucket from which on it is shared out: some 20 µs.
const WORTH: usize = 512;

impl<R: Real> Narrow<R> {
    #[inline(always)]
    pub(super) fn run_bucket<L: Lanes<Elem = R>>(
        &mut self,
        (workers, parts): (&Workers, &Parts),
        bodies: &Bodies<R>,
        todo: &Todo,
        margin: Margin<L>,
        collide: impl Fn(&Pose<L>, &Pose<L>, [&[u32]; 2], L) -> Found<L> + Sync,
    ) {
        if todo.len == 0 {
            return;
        }
        let Self { poses, speeds, fine, is_fine, manifolds, .. } = self;
        let fine = is_fine.then(|| fine.fours());
        let gathered = Gathered { bodies, poses: poses.rows(), speeds: speeds.fours(), fine };
        let mut cuts = [None; MOST_THREADS];
        let (mut one, mut several);
        let jobs = if parts.count() == 1 || todo.len < WORTH {
            one = [Some(manifolds.places())];
            &mut one[..]
        } else {
            // Pairs are in the order of the lower body: those of a part follow each other.
            for (cut, end) in cuts.iter_mut().zip(parts.ends()) {
                *cut = end.map(|end| todo.batch_from::<L>(end as u32));
            }
            let all = manifolds.padding();
            let place = |cut: usize| if cut < todo.len { todo.place[cut] } else { all };
            let ends: [Option<u32>; MOST_THREADS] = crate::each::indexed(|k| cuts[k].map(place));
            several = manifolds.cut_places(&ends[..parts.count()]);
            &mut several[..parts.count()]
        };
        workers.each(jobs, |k, places| {
            if let Some(places) = places {
                let start = if k == 0 { 0 } else { cuts[k - 1].unwrap_or(0) };
                let pairs = start..cuts[k].unwrap_or(todo.len);
                gathered.look(todo, pairs, margin, places, &collide);
            }
        });
        manifolds.join_places();
    }
}

impl<R: Real> Gathered<'_, R> {
    #[inline(always)]
    fn look<L: Lanes<Elem = R>>(
        &self,
        todo: &Todo,
        pairs: Range<usize>,
        margin: Margin<L>,
        kept: &mut Places<'_, R>,
        collide: &impl Fn(&Pose<L>, &Pose<L>, [&[u32]; 2], L) -> Found<L>,
    ) {
        let (looks_ahead, by_length) = (L::zero().lt(margin.ahead).any(), L::zero().lt(margin.share).any());
        let mut at = pairs.start;
        while at < pairs.end {
            let slots = [&todo.a[at..at + L::WIDTH], &todo.b[at..at + L::WIDTH]];
            let places = &todo.place[at..at + L::WIDTH];
            let mut a = Pose::gather(self.poses, slots[0]);
            let mut b = Pose::gather(self.poses, slots[1]);
            if let Some(fine) = self.fine {
                (a.x, b.x) = (Vec2::zero(), to_b_finely(fine, [a.x, b.x], slots));
            }
            let ahead = looks_ahead.then(|| Ahead::of(self.speeds, slots));
            let within = match &ahead {
                Some(ahead) => margin.of(ahead),
                None if by_length => margin.at_rest(lengths(self.speeds, slots)),
                None => margin.still,
            };
            let mut found = collide(&a, &b, slots, within);
            if let Some(ahead) = ahead {
                let doubtful = ahead.may_pass(&found, b.x - a.x, margin.stride);
                if doubtful != 0 {
                    let separations = found.separations[0];
                    found.hits = passing::staying(
                        found.hits,
                        separations,
                        self.bodies,
                        slots,
                        doubtful,
                        margin.stride,
                    );
                }
            }
            if found.hits[0].any() {
                keep(kept, &a, &b, &found, places);
            } else {
                kept.write_apart(places);
            }
            at += L::WIDTH;
        }
    }
}

/// From A to B, where positions are finer than their columns. Out of line: few worlds come here, and kernels keep
/// their registers (inlined it cost all of them 5 %).
#[cold]
#[inline(never)]
fn to_b_finely<L: Lanes>(fine: &[[L::Elem; 4]], centroids: [Vec2<L>; 2], slots: [&[u32]; 2]) -> Vec2<L> {
    fine_difference(centroids, slots.each(|slots| L::gather_fours(fine, slots)))
}

#[inline(always)]
fn keep<L: Lanes>(
    kept: &mut Places<'_, L::Elem>,
    a: &Pose<L>,
    b: &Pose<L>,
    found: &Found<L>,
    places: &[u32],
) {
    let (one, zero) = (L::one(), L::zero());
    let two_points = L::select(found.hits[1], L::lit(2.0), one);
    let features = found.features.unwrap_or([zero, zero]);
    let second = L::select(found.hits[1], features[1], zero);
    let code = L::select(found.hits[0], Code::lanes([features[0], second], two_points), zero);
    let [arm0, arm1] = found.arms;
    let to_b = b.x - a.x;
    let geometry = [found.normal.x, found.normal.y, arm0.x, arm0.y, arm1.x, arm1.y, to_b.x, to_b.y];
    let (friction, restitution) = (a.friction.min(b.friction), a.restitution.min(b.restitution));
    let gap = [found.separations[0], found.separations[1], friction, restitution];
    kept.write(places, code, geometry, gap);
}
