//! Keeping a pair list: found with a skin, it holds until some body has moved half of it (a Verlet list).
//!
//! The list then is a superset of the true pairs; the narrow phase finds the same contacts in the same
//! order. A circle that turns stays where it is, but a long body's box does not: its turn counts as the
//! distance its far end moves. Where bodies outrun the skin at once, lists are found without one for a
//! while: [`PAUSE`] steps.
//!
//! Only distances between bodies count. Where all are free to move (no floor, no wall, none asleep), what they have
//! moved is taken relative to one of them: 100,000 bodies in flight side by side keep one list all the way.

use crate::body::Bodies;
use crate::column::Column;
use crate::each::Each as _;
use crate::lanes::{LaneMask, Lanes, Real};

/// Skin over the median radius of movable bodies. From 0.15 to 0.5 `tumbler/2000`, `spinner/2000` and falling polygons take as long,
/// with 1.2 up to a tenth longer; falling circles, which are cheap to look at, 0.82 of it with 0.8.
const SKIN: f64 = 0.15;
/// Steps without a skin after one that lasted a single step.
const PAUSE: u32 = 16;

/// Where bodies were when the list was found.
#[derive(Clone, Debug)]
pub(super) struct Keep<R: Real> {
    x: Column<R>,
    y: Column<R>,
    /// Attitudes of long bodies: slot, cos, sin.
    long: Vec<(u32, R, R)>,
    skin: R,
    /// Steps the list has served; `None` where it cannot be kept.
    age: Option<u32>,
    pause: u32,
}

impl<R: Real> Default for Keep<R> {
    fn default() -> Self {
        Self {
            x: Column::new(R::FAR),
            y: Column::new(R::FAR),
            long: Vec::new(),
            skin: R::ZERO,
            age: None,
            pause: 0,
        }
    }
}

impl<R: Real> Keep<R> {
    /// The world has changed: the list is of no use.
    pub(super) fn forget(&mut self) {
        self.age = None;
    }

    /// Does the list still hold? Counts the step if so. `along` is a dynamic body relative to which all others may be
    /// seen: those with mass are all there are.
    pub(super) fn holds<L: Lanes<Elem = R>>(
        &mut self,
        bodies: &Bodies<R>,
        ahead_secs: R,
        along: Option<usize>,
    ) -> bool {
        let Some(age) = self.age else { return false };
        if self.outrun::<L>(bodies, ahead_secs, along) {
            self.pause = if age == 0 { PAUSE } else { 0 };
            return false;
        }
        self.age = Some(age + 1);
        true
    }

    /// The skin to find the next list with, metres: 0 during a pause.
    pub(super) fn next_skin(&mut self, median_radius: f64) -> R {
        if self.pause > 0 {
            self.pause -= 1;
            return R::ZERO;
        }
        let skin = R::from_f64(SKIN * median_radius);
        if skin.is_finite() { skin } else { R::ZERO }
    }

    /// Notes where bodies are, as a list is found with `skin`.
    pub(super) fn begin(&mut self, bodies: &Bodies<R>, long: impl Iterator<Item = u32>, skin: R) {
        if skin <= R::ZERO {
            self.age = None;
            return;
        }
        self.skin = skin;
        self.age = Some(0);
        for (noted, now) in [(&mut self.x, &bodies.x), (&mut self.y, &bodies.y)] {
            noted.resize(now.len());
            noted.as_mut_slice().copy_from_slice(now.as_slice());
        }
        self.long.clear();
        self.long.extend(long.map(|slot| (slot, bodies.c[slot as usize], bodies.s[slot as usize])));
    }

    /// Displacement and velocity of the body that others are seen relative to; zero where there is none.
    fn shift(&self, bodies: &Bodies<R>, along: Option<usize>) -> [R; 4] {
        along.map_or([R::ZERO; 4], |slot| {
            let (dx, dy) = (bodies.x[slot] - self.x[slot], bodies.y[slot] - self.y[slot]);
            [dx, dy, bodies.vx[slot], bodies.vy[slot]]
        })
    }

    /// Has a body left its half of the skin, or will it within `ahead_secs`?
    fn outrun<L: Lanes<Elem = R>>(&self, bodies: &Bodies<R>, ahead_secs: R, along: Option<usize>) -> bool {
        // A hair less than half, for the rounding of the distances themselves.
        let bound = R::from_f64(0.499) * self.skin;
        let square = L::splat(bound * bound);
        let (bound_l, ahead) = (L::splat(bound), L::splat(ahead_secs));
        let looks_ahead = ahead_secs > R::ZERO;
        let columns =
            [&bodies.x, &bodies.y, &self.x, &self.y, &bodies.vx, &bodies.vy].each(Column::lanes::<L>);
        let masses = bodies.inv_mass.lanes::<L>();
        let chunks = bodies.len().div_ceil(L::WIDTH);
        let [sx, sy, su, sv] = self.shift(bodies, along).each(L::splat);
        let moved = (0..chunks).any(|k| {
            let (dx, dy) = (columns[0][k] - columns[2][k] - sx, columns[1][k] - columns[3][k] - sy);
            let path = dx * dx + dy * dy;
            let out = if looks_ahead {
                let (vx, vy) = (columns[4][k] - su, columns[5][k] - sv);
                bound_l.lt(path.sqrt() + (vx * vx + vy * vy).sqrt() * ahead)
            } else {
                square.lt(path)
            };
            // Slots without a body stay where they are.
            if along.is_some() { (out & L::zero().lt(masses[k])).any() } else { out.any() }
        });
        moved
            || self.long.iter().any(|&(slot, c, s)| {
                let k = slot as usize;
                let (dc, ds) = (bodies.c[k] - c, bodies.s[k] - s);
                let (dx, dy) = (bodies.x[k] - self.x[k], bodies.y[k] - self.y[k]);
                let reach = bodies.radius[k];
                let path = Lanes::sqrt(dx * dx + dy * dy) + reach * Lanes::sqrt(dc * dc + ds * ds);
                bound < path
            })
    }
}
