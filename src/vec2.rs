//! Planar vectors and rotations in lanes, and the engine's own sine and cosine.

use std::ops::{Add, Mul, Neg, Sub};

use crate::each::Each as _;
use crate::lanes::{LaneMask, Lanes, Real};

/// `WIDTH` planar vectors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vec2<L> {
    /// Along +x, to the right.
    pub x: L,
    /// Along +y, upwards.
    pub y: L,
}

impl<L: Lanes> Vec2<L> {
    /// The vectors (x, y).
    #[inline(always)]
    pub fn new(x: L, y: L) -> Self {
        Self { x, y }
    }

    /// The same vector in every lane.
    #[inline(always)]
    pub fn splat(v: [L::Elem; 2]) -> Self {
        Self { x: L::splat(v[0]), y: L::splat(v[1]) }
    }

    /// (0, 0).
    #[inline(always)]
    pub fn zero() -> Self {
        Self { x: L::zero(), y: L::zero() }
    }

    /// a·b.
    #[inline(always)]
    pub fn dot(self, b: Self) -> L {
        self.x * b.x + self.y * b.y
    }

    /// a×b = `a_x` `b_y` − `a_y` `b_x`: positive when b lies counter-clockwise of a.
    #[inline(always)]
    pub fn cross(self, b: Self) -> L {
        self.x * b.y - self.y * b.x
    }

    /// ω×r for an angular velocity ω out of the plane: the velocity of arm r.
    #[inline(always)]
    pub fn turned_by(self, omega: L) -> Self {
        Self { x: -(omega * self.y), y: omega * self.x }
    }

    /// The vector turned a quarter clockwise: the outward normal of a counter-clockwise edge.
    #[inline(always)]
    pub fn right(self) -> Self {
        Self { x: self.y, y: -self.x }
    }

    /// |v|².
    #[inline(always)]
    pub fn length_squared(self) -> L {
        self.dot(self)
    }

    /// v·k.
    #[inline(always)]
    pub fn scale(self, k: L) -> Self {
        Self { x: self.x * k, y: self.y * k }
    }

    /// Per lane: `a` where `mask` is set, else `b`.
    #[inline(always)]
    pub fn select(mask: L::Mask, a: Self, b: Self) -> Self {
        Self { x: L::select(mask, a.x, b.x), y: L::select(mask, a.y, b.y) }
    }

    /// The unit vector along v and |v|; where |v|² underflows to 0, (0, 1) and 0.
    ///
    /// The fixed fallback is what keeps coincident centres and zero-length axes from becoming NaN.
    #[inline(always)]
    pub fn normalized(self) -> (Self, L) {
        let length = self.length_squared().sqrt();
        let degenerate = length.le(L::zero());
        let inverse = L::one() / L::select(degenerate, L::one(), length);
        let up = Self { x: L::zero(), y: L::one() };
        (Self::select(degenerate, up, self.scale(inverse)), length)
    }
}

impl<L: Lanes> Add for Vec2<L> {
    type Output = Self;
    #[inline(always)]
    fn add(self, b: Self) -> Self {
        Self { x: self.x + b.x, y: self.y + b.y }
    }
}

impl<L: Lanes> Sub for Vec2<L> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, b: Self) -> Self {
        Self { x: self.x - b.x, y: self.y - b.y }
    }
}

impl<L: Lanes> Neg for Vec2<L> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self { x: -self.x, y: -self.y }
    }
}

impl<L: Lanes> Mul<L> for Vec2<L> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, k: L) -> Self {
        self.scale(k)
    }
}

/// `WIDTH` rotations as unit complex numbers c + i·s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rot<L> {
    /// cos θ.
    pub c: L,
    /// sin θ.
    pub s: L,
}

impl<L: Lanes> Rot<L> {
    /// The rotation by `angle_rad`, with the engine's own sine and cosine: absolute error ≤ 1e-7 in
    /// f32 and ≤ 4e-16 in f64 for |angle| ≤ 10⁴ rad, the same bits at every width and on every target.
    #[inline(always)]
    pub fn from_angle(angle_rad: L) -> Self {
        let (s, c) = sin_cos(angle_rad);
        Self { c, s }
    }

    /// `world = rot · body`.
    #[inline(always)]
    pub fn apply(self, v: Vec2<L>) -> Vec2<L> {
        Vec2 { x: self.c * v.x - self.s * v.y, y: self.s * v.x + self.c * v.y }
    }

    /// `body = rot⁻¹ · world`.
    #[inline(always)]
    pub fn apply_inverse(self, v: Vec2<L>) -> Vec2<L> {
        Vec2 { x: self.c * v.x + self.s * v.y, y: self.c * v.y - self.s * v.x }
    }

    /// The rotation that follows `self` by `other`.
    #[inline(always)]
    pub fn then(self, other: Self) -> Self {
        Self { c: self.c * other.c - self.s * other.s, s: self.s * other.c + self.c * other.s }
    }

    /// `self⁻¹` followed by `other`: the attitude of a body turned by `other` seen from one turned by `self`.
    #[inline(always)]
    pub fn relative(self, other: Self) -> Self {
        Self { c: self.c * other.c + self.s * other.s, s: self.c * other.s - self.s * other.c }
    }

    /// Turned by `angle_rad` exactly (no first-order step) and brought back to unit length.
    ///
    /// A lane turned by zero keeps its bits, so that a stage which knows that nothing spins may be left out.
    /// The length correction is one Newton step of 1/√q at q ≈ 1: k = (3 − q)/2, error O((q−1)²).
    #[inline(always)]
    pub fn turned(self, angle_rad: L) -> Self {
        let turned = self.then(Self::from_angle(angle_rad));
        let q = turned.c * turned.c + turned.s * turned.s;
        let k = L::lit(1.5) - L::lit(0.5) * q;
        let still = angle_rad.equals(L::zero());
        Self { c: L::select(still, self.c, turned.c * k), s: L::select(still, self.s, turned.s * k) }
    }

    /// The angle in (−π, π]; for reports and drawing, never inside a step.
    pub fn angle_rad(self) -> [f64; 16] {
        let (c, s) = (self.c.to_array(), self.s.to_array());
        crate::each::indexed(|k| s[k].to_f64().atan2(c[k].to_f64()))
    }
}

/// sin θ and cos θ.
///
/// Range reduction θ = k·π/2 + r, |r| ≤ π/4, with π/2 in three parts (Cody and Waite, 1980), then the
/// Taylor series of both on r, which converge to round-off there in [`Real::TRIG_TERMS`] terms.
/// Only + − × and comparisons: no platform trigonometry, no fused operation. Lanes with |θ| beyond 10⁴
/// lose digits gradually, as the argument itself does, down to an attitude that is arbitrary.
#[inline(always)]
pub fn sin_cos<L: Lanes>(theta: L) -> (L, L) {
    let quarter = L::lit(std::f64::consts::FRAC_PI_4);
    if !quarter.lt(theta.abs()).any() {
        // What the reduction below yields for k = 0, to the bit: slow spin is the common case.
        return taylor(theta);
    }
    let [p0, p1, p2] = L::Elem::HALF_PI.each(L::splat);
    let inside = theta.abs().le(quarter);
    let k = (theta * L::lit(std::f64::consts::FRAC_2_PI)).round_small();
    let k = L::select(inside, L::zero(), k);
    let r = ((theta - k * p0) - k * p1) - k * p2;
    // Angles whose neighbours are turns apart: any attitude will do that is one. What is no number stays so.
    let r = L::select(L::one().lt(r.abs()), L::zero(), r);
    let (sin_r, cos_r) = taylor(r);
    // The quadrant k mod 4 as a number: ⌊k/4⌋ is the nearest integer to k/4 − 3/8.
    let quadrant = k - L::lit(4.0) * (k * L::lit(0.25) - L::lit(0.375)).round_small();
    let (one, two, three) = (L::one(), L::lit(2.0), L::lit(3.0));
    let swap = quadrant.equals(one) | quadrant.equals(three);
    let (sin_q, cos_q) = (L::select(swap, cos_r, sin_r), L::select(swap, sin_r, cos_r));
    let sin_negative = two.le(quadrant);
    let cos_negative = quadrant.equals(one) | quadrant.equals(two);
    (L::select(sin_negative, -sin_q, sin_q), L::select(cos_negative, -cos_q, cos_q))
}

/// The Taylor series of sin r and cos r by Horner's rule, smallest terms first.
#[inline(always)]
fn taylor<L: Lanes>(r: L) -> (L, L) {
    let z = r * r;
    let (mut sin_tail, mut cos_tail) = (L::zero(), L::zero());
    // From the last term down: sin r = r(1 − z/(2·3)(1 − z/(4·5)(…))), likewise cos with (1·2)(3·4)….
    for n in (1..=L::Elem::TRIG_TERMS).rev() {
        let even = 2.0 * n as f64;
        sin_tail = z * L::lit(-1.0 / (even * (even + 1.0))) * (L::one() + sin_tail);
        cos_tail = z * L::lit(-1.0 / (even * (even - 1.0))) * (L::one() + cos_tail);
    }
    (r + r * sin_tail, L::one() + cos_tail)
}
