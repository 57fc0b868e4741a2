//! What the narrow phase writes to: the places of the list.

use super::{Changed, Code, Manifolds};
use crate::lanes::{IN_ORDER, LaneMask, Lanes, ROW, Real, set_lanes};
use crate::workers::{PerPart, take};

/// Manifolds with other codes than before, and whether the pairs that touch, or how many points they have, may be others.
#[derive(Clone, Debug, Default)]
pub(super) struct Recoded {
    pub(super) manifolds: Vec<Changed>,
    pub(super) changed: bool,
}

/// The places of some pairs that follow each other.
#[derive(Debug)]
pub struct Places<'a, R: Real> {
    /// The first.
    first: u32,
    code: &'a mut [R],
    geometry: &'a mut [[R; ROW]],
    gap: &'a mut [[R; 4]],
    recoded: &'a mut Recoded,
}

impl<R: Real> Manifolds<R> {
    /// All places.
    pub fn places(&mut self) -> Places<'_, R> {
        let pairs = self.pairs();
        Places {
            first: 0,
            code: &mut self.now.code.padded_mut()[..pairs],
            geometry: &mut self.now.geometry.rows_mut()[..pairs],
            gap: &mut self.now.gap.fours_mut()[..pairs],
            recoded: &mut self.recoded,
        }
    }

    /// All places in several shares, each but the last of which ends before a place; [`Manifolds::join_places`] follows.
    pub(crate) fn cut_places(&mut self, ends: &[Option<u32>]) -> PerPart<Places<'_, R>> {
        let Self { recoded, beside, .. } = self;
        beside.resize_with(beside.len().max(ends.len()), Recoded::default);
        let pairs = self.now.ends[5];
        let mut code = &mut self.now.code.padded_mut()[..pairs];
        let mut geometry = &mut self.now.geometry.rows_mut()[..pairs];
        let mut gap = &mut self.now.gap.fours_mut()[..pairs];
        let mut first = 0;
        let lists = std::iter::once(recoded).chain(beside);
        let mut shares = std::array::from_fn(|_| None);
        for ((share, &end), recoded) in shares.iter_mut().zip(ends).zip(lists) {
            let count = end.map(|end| (end - first) as usize);
            let (code, geometry, gap) =
                (take(&mut code, count), take(&mut geometry, count), take(&mut gap, count));
            *share = Some(Places { first, code, geometry, gap, recoded });
            first = end.unwrap_or(first);
        }
        shares
    }

    /// Manifolds with other points or features than when these were last taken.
    pub fn take_recoded(&mut self, into: &mut Vec<Changed>) {
        into.clear();
        into.append(&mut self.recoded.manifolds);
    }

    /// Puts what has changed in shares behind each other.
    pub(crate) fn join_places(&mut self) {
        for share in &mut self.beside {
            self.recoded.manifolds.append(&mut share.manifolds);
            self.recoded.changed |= std::mem::take(&mut share.changed);
        }
    }
}

impl<R: Real> Places<'_, R> {
    /// Writes what was found for `WIDTH` pairs: rows given as lanes, codes ≥ 0. Places that are none of these are left out.
    #[inline(always)]
    pub fn write<L: Lanes<Elem = R>>(&mut self, places: &[u32], code: L, geometry: [L; ROW], gap: [L; 4]) {
        let at = |place: u32| place.wrapping_sub(self.first) as usize;
        let (first, last) = (at(places[0]), at(places[L::WIDTH - 1]));
        if last < self.code.len() && last - first == L::WIDTH - 1 {
            // Neighbours, as all are where every pair is looked at: rows go straight to their places.
            self.write_neighbours(first, code, geometry, gap);
        } else {
            self.write_scattered(places, code, geometry, gap);
        }
    }

    /// Out of line, as [`Places::write_apart`]: every bucket at every width would hold its copy.
    #[inline(never)]
    fn write_scattered<L: Lanes<Elem = R>>(
        &mut self,
        places: &[u32],
        code: L,
        geometry: [L; ROW],
        gap: [L; 4],
    ) {
        let (mut rows, mut gaps) = ([[R::ZERO; ROW]; 16], [[R::ZERO; 4]; 16]);
        L::store_rows(geometry, &mut rows);
        L::scatter_fours(gap, &mut gaps, &IN_ORDER);
        let codes = code.to_array();
        for (lane, &place) in places[..L::WIDTH].iter().enumerate() {
            let at = place.wrapping_sub(self.first) as usize;
            if at < self.code.len() {
                (self.geometry[at], self.gap[at]) = (rows[lane], gaps[lane]);
                self.set_code(at, codes[lane]);
            }
        }
    }

    #[inline(always)]
    fn write_neighbours<L: Lanes<Elem = R>>(&mut self, at: usize, code: L, geometry: [L; ROW], gap: [L; 4]) {
        let rows = at..at + L::WIDTH;
        L::store_rows(geometry, &mut self.geometry[rows.clone()]);
        L::scatter_fours(gap, &mut self.gap[rows.clone()], &IN_ORDER);
        let codes = &mut self.code[rows];
        let old = L::load(codes);
        let changed = (!old.equals(code)).bits();
        if changed != 0 {
            code.store(codes);
            let (old, fresh) = (old.to_array(), code.to_array());
            for lane in set_lanes(changed) {
                self.recode(at + lane, Code::of(old[lane]), Code::of(fresh[lane]));
            }
        }
    }

    /// Notes that `WIDTH` pairs do not touch.
    #[inline(never)]
    pub fn write_apart(&mut self, places: &[u32]) {
        for &place in places {
            let at = place.wrapping_sub(self.first) as usize;
            if at < self.code.len() {
                self.set_code(at, R::ZERO);
            }
        }
    }

    #[inline(always)]
    fn set_code(&mut self, at: usize, fresh: R) {
        let old = std::mem::replace(&mut self.code[at], fresh);
        if old != fresh {
            self.recode(at, Code::of(old), Code::of(fresh));
        }
    }

    /// A manifold has other points or features than before.
    #[inline(never)]
    fn recode(&mut self, at: usize, before: Code, now: Code) {
        self.recoded.changed |= before.points() != now.points();
        if before != now {
            let place = self.first + at as u32;
            self.recoded.manifolds.push(Changed { place, before, now });
        }
    }
}
