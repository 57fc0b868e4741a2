//! The rows and columns of a step in progress, cut into parts: what a worker alone writes to.

use std::ops::Range;

use super::{Group, Motion};
use crate::column::Column;
use crate::lanes::{IN_ORDER, Lanes, Real};
use crate::workers::{Parts, PerPart, Workers, take};

/// The slots of one part, with what a step writes to them. Slices, once: in a loop columns would look them up again after every
/// store.
pub(crate) struct Span<'a, L: Lanes> {
    /// Its first slot, in lane values.
    pub(crate) first: usize,
    /// See [`Motion`]: columns from the first slot on.
    pub(crate) total: [&'a mut [L]; 3],
    pub(crate) free: [&'a mut [L]; 3],
    pub(crate) ahead: [&'a mut [L]; 3],
    pub(crate) drift: &'a mut [L],
    /// Rows from the first slot on.
    pub(crate) velocity: &'a mut [[L::Elem; 4]],
    pub(crate) moved: &'a mut [[L::Elem; 4]],
    pub(crate) has_moved: &'a mut [bool],
}

/// What all parts read.
#[derive(Clone, Copy)]
pub(crate) struct Common<'a, R: Real> {
    pub(crate) runs: &'a [Range<usize>],
    pub(crate) group: &'a Group<R>,
}

impl<R: Real> Motion<R> {
    /// Does something with every part and what goes with it, of which there is one per part.
    #[inline]
    pub(crate) fn each_span<L: Lanes<Elem = R>, T: Send>(
        &mut self,
        workers: &Workers,
        beside: &mut [T],
        task: impl Fn(Common<'_, R>, &mut Span<'_, L>, &mut T) + Sync,
    ) {
        let Self { total, free, ahead, velocity, moved, drift, has_moved, runs, group, parts, .. } = self;
        let common = Common { runs, group };
        let mut all = Span {
            first: 0,
            total: three(total),
            free: three(free),
            ahead: three(ahead),
            drift: drift.lanes_mut(),
            velocity: velocity.fours_mut(),
            moved: moved.fours_mut(),
            has_moved,
        };
        if parts.count() == 1 {
            return task(common, &mut all, &mut beside[0]);
        }
        each_of_several((workers, parts), all, beside, |span, beside| task(common, span, beside));
    }
}

/// Out of line: a world of one part has no use for the memory of many.
#[inline(never)]
fn each_of_several<L: Lanes, T: Send>(
    (workers, parts): (&Workers, &Parts),
    mut all: Span<'_, L>,
    beside: &mut [T],
    task: impl Fn(&mut Span<'_, L>, &mut T) + Sync,
) {
    let mut jobs: PerPart<_> = std::array::from_fn(|_| None);
    for ((job, beside), end) in jobs.iter_mut().zip(beside).zip(parts.ends()) {
        *job = Some((all.take(end), beside));
    }
    workers.each(&mut jobs[..parts.count()], |_, job| {
        if let Some((span, beside)) = job {
            task(span, beside);
        }
    });
}

/// In full: `map` is left as a call.
#[inline(always)]
fn three<L: Lanes>([x, y, angle]: &mut [Column<L::Elem>; 3]) -> [&mut [L]; 3] {
    [x.lanes_mut(), y.lanes_mut(), angle.lanes_mut()]
}

impl<'a, L: Lanes> Span<'a, L> {
    /// Takes what comes before slot `end`, or all.
    fn take(&mut self, end: Option<usize>) -> Self {
        let lanes = end.map(|end| end / L::WIDTH - self.first);
        let slots = lanes.map(|lanes| lanes * L::WIDTH);
        let three = |columns: &mut [&'a mut [L]; 3]| columns.each_mut().map(|column| take(column, lanes));
        let taken = Self {
            first: self.first,
            total: three(&mut self.total),
            free: three(&mut self.free),
            ahead: three(&mut self.ahead),
            drift: take(&mut self.drift, lanes),
            velocity: take(&mut self.velocity, slots),
            moved: take(&mut self.moved, slots),
            has_moved: take(&mut self.has_moved, slots),
        };
        self.first += lanes.unwrap_or_default();
        taken
    }

    /// Of some runs of slots, what is in this part, as slots counted from its first.
    #[inline]
    pub(crate) fn own<'r>(
        &self,
        runs: &'r [Range<usize>],
    ) -> impl Iterator<Item = Range<usize>> + use<'r, L> {
        let first = self.first * L::WIDTH;
        let end = first + self.velocity.len();
        let cut = move |slot: usize| slot.clamp(first, end) - first;
        runs.iter().map(move |run| cut(run.start)..cut(run.end)).filter(|run| !run.is_empty())
    }
}

/// `WIDTH` consecutive rows of four, transposed.
#[inline(always)]
pub(crate) fn four_of<L: Lanes>(rows: &[[L::Elem; 4]], at: usize) -> [L; 4] {
    L::gather_fours(&rows[at * L::WIDTH..(at + 1) * L::WIDTH], &IN_ORDER)
}

/// The inverse of [`four_of`].
#[inline(always)]
pub(crate) fn put_four<L: Lanes>(rows: &mut [[L::Elem; 4]], at: usize, values: [L; 4]) {
    L::scatter_fours(values, &mut rows[at * L::WIDTH..(at + 1) * L::WIDTH], &IN_ORDER);
}
