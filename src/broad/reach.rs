//! How far beyond its bounds a body may meet another within the step to come.

use crate::body::{Bodies, BodyKind};
use crate::column::Column;
use crate::each::Each as _;
use crate::lanes::{Lanes, Real};
use crate::motion::Near;

/// Metres per slot, half the margin included.
#[derive(Clone, Debug)]
pub(super) struct Reach<R: Real> {
    /// For pairs of bodies found by their circles: path relative to the mean velocity of all dynamic bodies, so that bodies
    /// that fall together do not reach out for each other.
    pub(super) together: Column<R>,
    /// For pairs with a huge body: path as such.
    pub(super) alone: Column<R>,
    /// Of a body at rest.
    pub(super) at_rest: R,
}

impl<R: Real> Default for Reach<R> {
    fn default() -> Self {
        Self { together: Column::new(R::ZERO), alone: Column::new(R::ZERO), at_rest: R::ZERO }
    }
}

impl<R: Real> Reach<R> {
    /// Half of `margin`, in which a body's own length counts, and for what nothing moves the `largest` there is: of two bodies
    /// that is no less than the margin of the pair. And the larger of half of `skin` and what a body moves in `ahead_secs`. While
    /// some sleep, only the slots in `awake` move, and paths are relative to what sleeps.
    pub(super) fn measure<L: Lanes<Elem = R>>(
        &mut self,
        bodies: &Bodies<R>,
        (margin, largest): (Near<R>, R),
        skin: R,
        ahead_secs: R,
        awake: Option<&[u32]>,
    ) {
        self.together.resize(bodies.len());
        self.alone.resize(bodies.len());
        let half = R::from_f64(0.5);
        let (metres, share, skin) = (half * margin.metres, half * margin.share, half * skin);
        self.at_rest = metres + share * largest + skin;
        if let Some(awake) = awake {
            self.together.as_mut_slice().fill(self.at_rest);
            self.alone.as_mut_slice().fill(self.at_rest);
            for k in awake.iter().map(|&slot| slot as usize) {
                let length = if bodies.kind(k) == BodyKind::Dynamic { bodies.radius[k] } else { largest };
                let path = path_ahead(bodies.vx[k], bodies.vy[k], metres + share * length, skin, ahead_secs);
                (self.together[k], self.alone[k]) = (path, path);
            }
            return;
        }
        let mean = if ahead_secs > R::ZERO { mean_velocity(bodies) } else { [R::ZERO; 2] };
        let [mean_x, mean_y] = mean.each(L::splat);
        let [metres, share, largest, skin, ahead] = [metres, share, largest, skin, ahead_secs].each(L::splat);
        let columns = [&bodies.vx, &bodies.vy, &bodies.radius, &bodies.inv_mass].each(Column::lanes::<L>);
        for at in 0..bodies.len().div_ceil(L::WIDTH) {
            let [vx, vy, radius, inv_mass] = columns.each(|column| column[at]);
            let own = metres + share * L::select(L::zero().lt(inv_mass), radius, largest);
            let path = |x, y| path_ahead(x, y, own, skin, ahead);
            self.together.lanes_mut::<L>()[at] = path(vx - mean_x, vy - mean_y);
            self.alone.lanes_mut::<L>()[at] = path(vx, vy);
        }
    }
}

/// `margin` and the larger of `skin` and the path at velocity (x, y).
#[inline(always)]
fn path_ahead<L: Lanes>(x: L, y: L, margin: L, skin: L, ahead_secs: L) -> L {
    margin + Lanes::max(skin, Lanes::sqrt(x * x + y * y) * ahead_secs)
}

/// Of dynamic bodies, m/s; summed in slot order, so that no width changes it.
fn mean_velocity<R: Real>(bodies: &Bodies<R>) -> [R; 2] {
    let mut sum = [0.0; 2];
    let mut count = 0.0_f64;
    for slot in (0..bodies.len()).filter(|&slot| bodies.kind(slot) == BodyKind::Dynamic) {
        sum[0] += bodies.vx[slot].to_f64();
        sum[1] += bodies.vy[slot].to_f64();
        count += 1.0;
    }
    sum.each(|v| R::from_f64(v / count.max(1.0)))
}
