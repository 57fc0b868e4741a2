//! How far beyond its bounds a body may meet another within the step to come.

use crate::body::{Bodies, BodyKind};
use crate::column::Column;
use crate::each::Each as _;
use crate::lanes::{Lanes, Real};

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
    /// Half of `margin`, and the larger of half of `skin` and what a body moves in `ahead_secs`. While some sleep,
    /// only the slots in `awake` move, and paths are relative to what sleeps.
    pub(super) fn measure<L: Lanes<Elem = R>>(
        &mut self,
        bodies: &Bodies<R>,
        margin: R,
        skin: R,
        ahead_secs: R,
        awake: Option<&[u32]>,
    ) {
        self.together.resize(bodies.len());
        self.alone.resize(bodies.len());
        let half = R::from_f64(0.5);
        self.at_rest = half * (margin + skin);
        if ahead_secs <= R::ZERO || awake.is_some() {
            self.together.as_mut_slice().fill(self.at_rest);
            self.alone.as_mut_slice().fill(self.at_rest);
        }
        if ahead_secs <= R::ZERO {
            return;
        }
        if let Some(awake) = awake {
            for k in awake.iter().map(|&slot| slot as usize) {
                let path = path_ahead(bodies.vx[k], bodies.vy[k], half * margin, half * skin, ahead_secs);
                (self.together[k], self.alone[k]) = (path, path);
            }
            return;
        }
        let [mean_x, mean_y] = mean_velocity(bodies).each(L::splat);
        let (margin, skin, ahead) = (L::splat(half * margin), L::splat(half * skin), L::splat(ahead_secs));
        let (vx, vy) = (bodies.vx.lanes::<L>(), bodies.vy.lanes::<L>());
        for at in 0..bodies.len().div_ceil(L::WIDTH) {
            let path = |x, y| path_ahead(x, y, margin, skin, ahead);
            self.together.lanes_mut::<L>()[at] = path(vx[at] - mean_x, vy[at] - mean_y);
            self.alone.lanes_mut::<L>()[at] = path(vx[at], vy[at]);
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
