//! What the narrow phase writes to: the places of the list.

use super::{Changed, Code, Manifolds};
use crate::lanes::{IN_ORDER, LaneMask, Lanes, ROW, Real, set_lanes};

/// Manifolds with other codes than before, and whether the pairs that touch, or how many points they have, may be others.
#[derive(Debug, Default)]
pub struct Recoded {
    manifolds: Vec<Changed>,
    changed: bool,
}

/// The places of all pairs.
#[derive(Debug)]
pub struct Places<'a, R: Real> {
    code: &'a mut [R],
    geometry: &'a mut [[R; ROW]],
    gap: &'a mut [[R; 4]],
    recoded: Recoded,
}

impl<R: Real> Manifolds<R> {
    /// All places; what is written to them is known by [`Manifolds::keep`].
    pub fn places(&mut self) -> Places<'_, R> {
        let pairs = self.pairs();
        let recoded = Recoded { manifolds: std::mem::take(&mut self.recoded), changed: self.changed };
        Places {
            code: &mut self.now.code.padded_mut()[..pairs],
            geometry: &mut self.now.geometry.rows_mut()[..pairs],
            gap: &mut self.now.gap.fours_mut()[..pairs],
            recoded,
        }
    }

    /// Takes in what was written.
    pub fn keep(&mut self, recoded: Recoded) {
        (self.recoded, self.changed) = (recoded.manifolds, recoded.changed);
    }
}

impl<R: Real> Places<'_, R> {
    /// What has changed.
    pub fn finish(self) -> Recoded {
        self.recoded
    }

    /// Writes what was found for `WIDTH` pairs: rows given as lanes, codes ≥ 0. Places that are none of these are left out.
    #[inline(always)]
    pub fn write<L: Lanes<Elem = R>>(&mut self, places: &[u32], code: L, geometry: [L; ROW], gap: [L; 4]) {
        let (first, last) = (places[0] as usize, places[L::WIDTH - 1] as usize);
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
            let at = place as usize;
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
            let at = place as usize;
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
            let place = at as u32;
            self.recoded.manifolds.push(Changed { place, before, now });
        }
    }
}
