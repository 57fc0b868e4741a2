//! How close is close enough, and who passes.

use super::Found;
use super::passing::Stride;
use crate::each::Each as _;
use crate::lanes::{LaneMask, Lanes, Real};
use crate::vec2::Vec2;

/// How close is close enough.
#[derive(Clone, Copy, Debug)]
pub(super) struct Margin<L: Lanes> {
    /// Metres, for bodies at rest.
    pub(super) still: L,
    /// Of a pair's length, in addition.
    pub(super) share: L,
    /// Seconds of approach that are added.
    pub(super) ahead: L,
    /// How far bodies may go.
    pub(super) stride: Stride<L::Elem>,
}

impl<L: Lanes> Margin<L> {
    /// For bodies at rest.
    #[inline(always)]
    pub(super) fn at_rest(&self, length: L) -> L {
        self.still + self.share * length
    }

    #[inline(always)]
    pub(super) fn of(&self, ahead: &Ahead<L>) -> L {
        let path = ahead.velocity.length_squared().sqrt() * self.ahead;
        self.at_rest(ahead.length) + path.min(L::lit(0.5) * ahead.radius)
    }
}

/// How the bodies of `WIDTH` pairs move.
pub(super) struct Ahead<L> {
    /// Of B seen from A, m/s.
    velocity: Vec2<L>,
    /// The smaller bounding radius, metres.
    radius: L,
    /// The pair's length, metres.
    pub(super) length: L,
    /// The sum of the radii of discs that both cover, metres.
    inner: L,
}

impl<L: Lanes> Ahead<L> {
    #[inline(always)]
    pub(super) fn of(speeds: &[[L::Elem; 4]], slots: [&[u32]; 2]) -> Self {
        let [a, b] = slots.each(|slots| L::gather_fours(speeds, slots));
        let velocity = Vec2::new(b[0] - a[0], b[1] - a[1]);
        Self {
            velocity,
            radius: a[2].min(b[2]),
            length: length_of(&a).min(length_of(&b)),
            inner: a[3] + b[3],
        }
    }

    /// Which pairs are apart, come as far as that in a stride, and do not go straight at each other: of those it has to be
    /// found out.
    #[inline(always)]
    pub(super) fn may_pass(&self, found: &Found<L>, to_b: Vec2<L>, stride: Stride<L::Elem>) -> u32 {
        let zero = L::zero();
        let way = self.velocity * L::splat(stride.secs);
        let length = way.length_squared().sqrt();
        let [fx, fy] = stride.fallen.each(L::splat);
        let fallen = fx.abs() + fy.abs();
        let separation = found.separations[0];
        let comes = separation.lt(length + fallen) & zero.lt(separation) & found.hits[0];
        (comes & ((self.inner - fallen) * length).lt(to_b.cross(way).abs())).bits()
    }
}

/// What lengths are shares of, from a row of speeds: the radius of what moves, of others beyond all.
#[inline(always)]
fn length_of<L: Lanes>([_, _, radius, inner]: &[L; 4]) -> L {
    L::select(L::zero().lt(*inner), *radius, L::splat(L::Elem::FAR))
}

/// The lengths of `WIDTH` pairs, metres.
#[inline(always)]
pub(super) fn lengths<L: Lanes>(speeds: &[[L::Elem; 4]], slots: [&[u32]; 2]) -> L {
    let [a, b] = slots.each(|slots| length_of(&L::gather_fours(speeds, slots)));
    a.min(b)
}
