//! Brute force: each circle against all later ones, `WIDTH` at a time.

use super::Circles;
use crate::lanes::{LaneMask, Lanes, set_lanes};

/// Pairs come out in order, as circles are packed by ascending slot.
pub(super) fn find<L: Lanes>(circles: &Circles<L::Elem>, pairs: &mut Vec<[u32; 2]>) {
    let n = circles.len();
    let chunks = n.div_ceil(L::WIDTH);
    let (xs, ys, rs) = (circles.x.lanes::<L>(), circles.y.lanes::<L>(), circles.r.lanes::<L>());
    let (xs, ys, rs) = (&xs[..chunks], &ys[..chunks], &rs[..chunks]);
    for a in 0..n {
        let (x, y, r, slot) = circles.get(a);
        let (x, y, r) = (L::splat(x), L::splat(y), L::splat(r));
        let first = (a + 1) / L::WIDTH;
        // Lanes up to `a` itself belong to earlier rows.
        let mut later = !0u32 << ((a + 1) % L::WIDTH);
        for chunk in first..chunks {
            let hits = super::meet(x, y, r, xs[chunk], ys[chunk], rs[chunk]).bits() & later;
            later = !0;
            if hits != 0 {
                let slots = &circles.slot[chunk * L::WIDTH..];
                for lane in set_lanes(hits) {
                    pairs.push([slot, slots[lane]]);
                }
            }
        }
    }
}
