//! Lanes: the numbers every kernel is written over, and the only file that names `wide`.
//!
//! A kernel is written once over [`Lanes`]. Width 1 is a plain `f32` or `f64`, so it *is* the
//! scalar version. The trait holds only operations whose result is the same to the bit on every
//! backend: + − × ÷ √ |x|, comparisons, select, minimum and maximum (defined as a select), loads, stores and transposes.
//! Deliberately absent: fused multiply-add, approximate reciprocals, horizontal sums and transcendental
//! functions.

use std::fmt::{Debug, Display};
use std::ops::{Add, AddAssign, BitAnd, BitOr, Div, Mul, Neg, Not, Sub, SubAssign};

use bytemuck::Pod;
use wide::{f32x4, f32x8, f32x16, f64x4, f64x8};

/// 0, 1, 2, …: gathers and scatters of neighbouring rows.
pub const IN_ORDER: [u32; 16] = [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15];

/// Elements per row of a [`RowTable`](crate::column::Column::rows): what one gather brings per body.
pub const ROW: usize = 8;

/// A scalar the engine can be built on: `f32` or `f64`.
pub trait Real:
    Pod
    + Debug
    + Display
    + Default
    + PartialOrd
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + AddAssign
    + SubAssign
    + Lanes<Elem = Self>
    + Send
    + Sync
{
    /// One cache line of elements: columns are stored in these, so they are 64-byte aligned.
    type Line: Pod + Debug + Send + Sync;
    /// The name users choose it by.
    const NAME: &'static str;
    /// 0.
    const ZERO: Self;
    /// 1.
    const ONE: Self;
    /// The distance from 1 to the next larger value.
    const EPSILON: Self;
    /// Added and taken away again, it rounds |x| < 2²² (f32) or 2⁵¹ (f64) to an integer, ties to even.
    const ROUND_MAGIC: Self;
    /// π/2 as a sum of three parts, the first two short enough that k·part is exact for small k.
    const HALF_PI: [Self; 3];
    /// Taylor terms of sine and cosine that reach round-off on |x| ≤ π/4.
    const TRIG_TERMS: usize;
    /// A coordinate no body can reach whose square still is finite: where inert padding lives.
    const FAR: Self;

    /// The nearest value to `x`.
    fn from_f64(x: f64) -> Self;
    /// The same value as an `f64`.
    fn to_f64(self) -> f64;
    /// Neither infinite nor NaN.
    fn is_finite(self) -> bool;
}

impl Real for f32 {
    type Line = f32x16;
    const NAME: &'static str = "f32";
    const ZERO: Self = 0.0;
    const ONE: Self = 1.0;
    const EPSILON: Self = f32::EPSILON;
    const ROUND_MAGIC: Self = 12_582_912.0; // 1.5·2²³
    const HALF_PI: [Self; 3] = [1.570_312_5, 4.837_513e-4, 7.549_79e-8];
    const TRIG_TERMS: usize = 6;
    const FAR: Self = 1e18;

    #[inline(always)]
    #[expect(clippy::cast_possible_truncation, reason = "rounding to the engine's precision is the purpose")]
    fn from_f64(x: f64) -> Self {
        x as f32
    }
    #[inline(always)]
    fn to_f64(self) -> f64 {
        f64::from(self)
    }
    #[inline(always)]
    fn is_finite(self) -> bool {
        self.is_finite()
    }
}

impl Real for f64 {
    type Line = f64x8;
    const NAME: &'static str = "f64";
    const ZERO: Self = 0.0;
    const ONE: Self = 1.0;
    const EPSILON: Self = f64::EPSILON;
    const ROUND_MAGIC: Self = 6_755_399_441_055_744.0; // 1.5·2⁵²
    const HALF_PI: [Self; 3] =
        [1.570_796_326_734_125_6, 6.077_100_506_303_966e-11, 2.022_266_248_795_950_6e-21];
    const TRIG_TERMS: usize = 9;
    const FAR: Self = 1e100;

    #[inline(always)]
    fn from_f64(x: f64) -> Self {
        x
    }
    #[inline(always)]
    fn to_f64(self) -> f64 {
        self
    }
    #[inline(always)]
    fn is_finite(self) -> bool {
        self.is_finite()
    }
}

/// The outcome of a lane-wise comparison.
pub trait LaneMask: Copy + Debug + BitAnd<Output = Self> + BitOr<Output = Self> + Not<Output = Self> {
    /// One bit per lane, lane 0 lowest.
    fn bits(self) -> u32;
    /// Is any lane set?
    #[inline(always)]
    fn any(self) -> bool {
        self.bits() != 0
    }
}

/// `WIDTH` numbers that move together.
///
/// Binary operators act lane by lane. All methods give the same bits as the scalar operation in
/// every lane, on every backend; `src/tests/oracle_lanes.rs` holds each of them to that.
pub trait Lanes:
    Pod
    + Debug
    + PartialEq
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + Send
    + Sync
{
    /// The scalar in each lane.
    type Elem: Real;
    /// What a comparison yields.
    type Mask: LaneMask;
    /// Lanes per value; a power of two, at most 16.
    const WIDTH: usize;

    /// `x` in every lane.
    fn splat(x: Self::Elem) -> Self;
    /// The first `WIDTH` elements of `from` (any alignment). Panics if there are fewer.
    fn load(from: &[Self::Elem]) -> Self;
    /// Writes the lanes to the first `WIDTH` elements of `to`. Panics if there are fewer.
    fn store(self, to: &mut [Self::Elem]);
    /// √x; NaN for negative lanes.
    fn sqrt(self) -> Self;
    /// |x|.
    fn abs(self) -> Self;
    /// self < other.
    fn lt(self, other: Self) -> Self::Mask;
    /// self ≤ other.
    fn le(self, other: Self) -> Self::Mask;
    /// self = other.
    fn equals(self, other: Self) -> Self::Mask;
    /// Per lane: `if_true` where `mask` is set, else `if_false`.
    fn select(mask: Self::Mask, if_true: Self, if_false: Self) -> Self;
    /// self < other ? self : other (so `other` where either is NaN or both are zero).
    fn min(self, other: Self) -> Self;
    /// other < self ? self : other (so `other` where either is NaN or both are zero).
    fn max(self, other: Self) -> Self;
    /// Gathers one row per lane and transposes: element `k` of the result holds `rows[index[lane]][k]`.
    /// `index` has at least `WIDTH` entries. Panics if an index is out of range.
    fn gather_rows(rows: &[[Self::Elem; ROW]], index: &[u32]) -> [Self; ROW];
    /// Like [`Lanes::gather_rows`], for entries of four rows each: one check of the index for all four.
    #[inline(always)]
    fn gather_quads(quads: &[[[Self::Elem; ROW]; 4]], index: &[u32]) -> [[Self; ROW]; 4] {
        let rows: &[[Self::Elem; ROW]] = quads.as_flattened();
        let mut at = [0; 16];
        for (at, index) in at[..Self::WIDTH].iter_mut().zip(index) {
            *at = index * 4;
        }
        let next = |at: &mut [u32; 16]| {
            let lanes = Self::gather_rows(rows, at);
            for at in at {
                *at += 1;
            }
            lanes
        };
        [next(&mut at), next(&mut at), next(&mut at), next(&mut at)]
    }
    /// The inverse of [`Lanes::gather_rows`] over an array of rows: `to[lane][k] = from[k][lane]`,
    /// for the first `WIDTH` rows of `to`.
    fn store_rows(from: [Self; ROW], to: &mut [[Self::Elem; ROW]]);
    /// Like [`Lanes::gather_rows`], for rows of four.
    fn gather_fours(fours: &[[Self::Elem; 4]], index: &[u32]) -> [Self; 4];
    /// The inverse of [`Lanes::gather_fours`]: `to[index[lane]][k] = from[k][lane]`; where lanes name the same
    /// row, the last one's stays. Panics if an index is out of range.
    fn scatter_fours(from: [Self; 4], to: &mut [[Self::Elem; 4]], index: &[u32]);

    /// 0 in every lane.
    #[inline(always)]
    fn zero() -> Self {
        Self::splat(Self::Elem::ZERO)
    }
    /// 1 in every lane.
    #[inline(always)]
    fn one() -> Self {
        Self::splat(Self::Elem::ONE)
    }
    /// `x`, rounded to the element type, in every lane.
    #[inline(always)]
    fn lit(x: f64) -> Self {
        Self::splat(Self::Elem::from_f64(x))
    }
    /// The integer nearest to `x`, ties to even, for |x| < 2²² (f32) or 2⁵¹ (f64).
    #[inline(always)]
    fn round_small(self) -> Self {
        let magic = Self::splat(Self::Elem::ROUND_MAGIC);
        (self + magic) - magic
    }
    /// Lane values as the elements of an array; entries past `WIDTH` are 0.
    #[inline(always)]
    fn to_array(self) -> [Self::Elem; 16] {
        let mut out = [Self::Elem::ZERO; 16];
        self.store(&mut out);
        out
    }
}

macro_rules! scalar_lanes {
    ($t:ty) => {
        impl Lanes for $t {
            type Elem = $t;
            type Mask = bool;
            const WIDTH: usize = 1;

            #[inline(always)]
            fn splat(x: $t) -> Self {
                x
            }
            #[inline(always)]
            fn load(from: &[$t]) -> Self {
                from[0]
            }
            #[inline(always)]
            fn store(self, to: &mut [$t]) {
                to[0] = self;
            }
            #[inline(always)]
            fn sqrt(self) -> Self {
                <$t>::sqrt(self)
            }
            #[inline(always)]
            fn abs(self) -> Self {
                <$t>::abs(self)
            }
            #[inline(always)]
            fn lt(self, other: Self) -> bool {
                self < other
            }
            #[inline(always)]
            fn le(self, other: Self) -> bool {
                self <= other
            }
            #[inline(always)]
            fn equals(self, other: Self) -> bool {
                self == other
            }
            #[inline(always)]
            fn select(mask: bool, if_true: Self, if_false: Self) -> Self {
                if mask { if_true } else { if_false }
            }
            #[inline(always)]
            fn min(self, other: Self) -> Self {
                if self < other { self } else { other }
            }
            #[inline(always)]
            fn max(self, other: Self) -> Self {
                if other < self { self } else { other }
            }
            #[inline(always)]
            fn gather_rows(rows: &[[$t; ROW]], index: &[u32]) -> [Self; ROW] {
                rows[index[0] as usize]
            }
            #[inline(always)]
            fn store_rows(from: [Self; ROW], to: &mut [[$t; ROW]]) {
                to[0] = from;
            }
            #[inline(always)]
            fn gather_fours(fours: &[[$t; 4]], index: &[u32]) -> [Self; 4] {
                fours[index[0] as usize]
            }
            #[inline(always)]
            fn scatter_fours(from: [Self; 4], to: &mut [[$t; 4]], index: &[u32]) {
                to[index[0] as usize] = from;
            }
        }
    };
}
scalar_lanes!(f32);
scalar_lanes!(f64);

impl LaneMask for bool {
    #[inline(always)]
    fn bits(self) -> u32 {
        u32::from(self)
    }
}

/// A mask over the lanes of `V`: all bits of a lane set, or none.
#[derive(Clone, Copy, Debug)]
pub struct Mask<V>(V);

// On x86 `fast_min` and `fast_max` are one instruction that is defined as the select; elsewhere their
// answer for NaN and ±0 is another, so there it is the select itself.
#[cfg(any(target_arch = "x86_64", target_arch = "x86"))]
macro_rules! least {
    ($a:expr, $b:expr, $mask:expr, $fast:ident) => {
        $a.$fast($b)
    };
}
#[cfg(not(any(target_arch = "x86_64", target_arch = "x86")))]
macro_rules! least {
    ($a:expr, $b:expr, $mask:expr, $fast:ident) => {
        $mask.select($a, $b)
    };
}

macro_rules! vector_lanes {
    ($v:ty, $t:ty, $n:literal, $gather:ident, $scatter:ident, $gather_fours:ident, $scatter_fours:ident) => {
        impl LaneMask for Mask<$v> {
            #[inline(always)]
            fn bits(self) -> u32 {
                self.0.to_bitmask()
            }
        }
        impl BitAnd for Mask<$v> {
            type Output = Self;
            #[inline(always)]
            fn bitand(self, other: Self) -> Self {
                Mask(self.0 & other.0)
            }
        }
        impl BitOr for Mask<$v> {
            type Output = Self;
            #[inline(always)]
            fn bitor(self, other: Self) -> Self {
                Mask(self.0 | other.0)
            }
        }
        impl Not for Mask<$v> {
            type Output = Self;
            #[inline(always)]
            fn not(self) -> Self {
                Mask(!self.0)
            }
        }
        impl Lanes for $v {
            type Elem = $t;
            type Mask = Mask<$v>;
            const WIDTH: usize = $n;

            #[inline(always)]
            fn splat(x: $t) -> Self {
                <$v>::splat(x)
            }
            #[inline(always)]
            fn load(from: &[$t]) -> Self {
                let mut lanes = [0.0; $n];
                lanes.copy_from_slice(&from[..$n]);
                <$v>::new(lanes)
            }
            #[inline(always)]
            fn store(self, to: &mut [$t]) {
                to[..$n].copy_from_slice(self.as_array());
            }
            #[inline(always)]
            fn sqrt(self) -> Self {
                <$v>::sqrt(self)
            }
            #[inline(always)]
            fn abs(self) -> Self {
                <$v>::abs(self)
            }
            #[inline(always)]
            fn lt(self, other: Self) -> Mask<$v> {
                Mask(self.simd_lt(other))
            }
            #[inline(always)]
            fn le(self, other: Self) -> Mask<$v> {
                Mask(self.simd_le(other))
            }
            #[inline(always)]
            fn equals(self, other: Self) -> Mask<$v> {
                Mask(self.simd_eq(other))
            }
            #[inline(always)]
            fn select(mask: Mask<$v>, if_true: Self, if_false: Self) -> Self {
                mask.0.select(if_true, if_false)
            }
            #[inline(always)]
            fn min(self, other: Self) -> Self {
                least!(self, other, self.simd_lt(other), fast_min)
            }
            #[inline(always)]
            fn max(self, other: Self) -> Self {
                least!(self, other, other.simd_lt(self), fast_max)
            }
            #[inline(always)]
            fn gather_rows(rows: &[[$t; ROW]], index: &[u32]) -> [Self; ROW] {
                $gather(rows, index)
            }
            #[inline(always)]
            fn store_rows(from: [Self; ROW], to: &mut [[$t; ROW]]) {
                $scatter(from, to);
            }
            #[inline(always)]
            fn gather_fours(fours: &[[$t; 4]], index: &[u32]) -> [Self; 4] {
                $gather_fours(fours, index)
            }
            #[inline(always)]
            fn scatter_fours(from: [Self; 4], to: &mut [[$t; 4]], index: &[u32]) {
                $scatter_fours(from, to, index);
            }
        }
    };
}
vector_lanes!(f32x4, f32, 4, gather_f32x4, store_f32x4, gather_fours_f32x4, scatter_fours_f32x4);
vector_lanes!(f32x8, f32, 8, gather_f32x8, store_f32x8, gather_fours_f32x8, scatter_fours_f32x8);
vector_lanes!(f32x16, f32, 16, gather_f32x16, store_f32x16, gather_fours_f32x16, scatter_fours_f32x16);
vector_lanes!(f64x4, f64, 4, gather_f64x4, store_f64x4, gather_fours_f64x4, scatter_fours_f64x4);

/// The lanes of `f32` that users choose by number.
pub mod f32s {
    pub use wide::{f32x4 as X4, f32x8 as X8, f32x16 as X16};
    /// One lane: the scalar.
    pub type X1 = f32;
}

/// The lanes of `f64` that users choose by number.
pub mod f64s {
    pub use wide::f64x4 as X4;
    /// One lane: the scalar.
    pub type X1 = f64;
}

#[inline(always)]
fn gather_f32x8(rows: &[[f32; ROW]], index: &[u32]) -> [f32x8; ROW] {
    // Spelled out: `array::from_fn` here was left as a call per gather, 12 % of a step of polygons.
    let i: &[u32; 8] = index[..8].try_into().unwrap_or_else(|_| unreachable!("a slice of eight"));
    let row = |lane: usize| f32x8::new(rows[i[lane] as usize]);
    f32x8::transpose([row(0), row(1), row(2), row(3), row(4), row(5), row(6), row(7)])
}

#[inline(always)]
fn store_f32x8(from: [f32x8; ROW], to: &mut [[f32; ROW]]) {
    let rows = f32x8::transpose(from);
    for (row, out) in rows.iter().zip(&mut to[..8]) {
        *out = *row.as_array();
    }
}

#[inline(always)]
fn gather_f32x16(rows: &[[f32; ROW]], index: &[u32]) -> [f32x16; ROW] {
    let [a, b, c, d, e, f, g, h] = gather_f32x8(rows, &index[..8]);
    let [i, j, k, l, m, n, o, p] = gather_f32x8(rows, &index[8..16]);
    let join = |low: f32x8, high: f32x8| bytemuck::cast([low, high]);
    [join(a, i), join(b, j), join(c, k), join(d, l), join(e, m), join(f, n), join(g, o), join(h, p)]
}

#[inline(always)]
fn store_f32x16(from: [f32x16; ROW], to: &mut [[f32; ROW]]) {
    let halves: [[f32x8; 2]; ROW] = from.map(bytemuck::cast);
    store_f32x8(halves.map(|h| h[0]), &mut to[..8]);
    store_f32x8(halves.map(|h| h[1]), &mut to[8..16]);
}

// Four rows of eight are two 4×4 transposes side by side; the same text serves f32 and f64.
macro_rules! four_rows {
    ($v:ty, $t:ty, $gather:ident, $scatter:ident) => {
        #[inline(always)]
        fn $gather(rows: &[[$t; ROW]], index: &[u32]) -> [$v; ROW] {
            let i: &[u32; 4] = index[..4].try_into().unwrap_or_else(|_| unreachable!("a slice of four"));
            let row = |lane: usize| &rows[i[lane] as usize];
            let low = |r: &[$t; ROW]| <$v>::new([r[0], r[1], r[2], r[3]]);
            let high = |r: &[$t; ROW]| <$v>::new([r[4], r[5], r[6], r[7]]);
            let (p, q, r, s) = (row(0), row(1), row(2), row(3));
            let [a, b, c, d] = <$v>::transpose([low(p), low(q), low(r), low(s)]);
            let [e, f, g, h] = <$v>::transpose([high(p), high(q), high(r), high(s)]);
            [a, b, c, d, e, f, g, h]
        }

        #[inline(always)]
        fn $scatter(from: [$v; ROW], to: &mut [[$t; ROW]]) {
            let low = <$v>::transpose([from[0], from[1], from[2], from[3]]);
            let high = <$v>::transpose([from[4], from[5], from[6], from[7]]);
            for (lane, out) in to[..4].iter_mut().enumerate() {
                out[..4].copy_from_slice(low[lane].as_array());
                out[4..].copy_from_slice(high[lane].as_array());
            }
        }
    };
}
four_rows!(f32x4, f32, gather_f32x4, store_f32x4);
four_rows!(f64x4, f64, gather_f64x4, store_f64x4);

macro_rules! four_fours {
    ($v:ty, $t:ty, $gather:ident, $scatter:ident) => {
        #[inline(always)]
        fn $gather(fours: &[[$t; 4]], index: &[u32]) -> [$v; 4] {
            let i: &[u32; 4] = index[..4].try_into().unwrap_or_else(|_| unreachable!("a slice of four"));
            let row = |lane: usize| <$v>::new(fours[i[lane] as usize]);
            <$v>::transpose([row(0), row(1), row(2), row(3)])
        }

        #[inline(always)]
        fn $scatter(from: [$v; 4], to: &mut [[$t; 4]], index: &[u32]) {
            let i: &[u32; 4] = index[..4].try_into().unwrap_or_else(|_| unreachable!("a slice of four"));
            let rows = <$v>::transpose(from);
            to[i[0] as usize] = *rows[0].as_array();
            to[i[1] as usize] = *rows[1].as_array();
            to[i[2] as usize] = *rows[2].as_array();
            to[i[3] as usize] = *rows[3].as_array();
        }
    };
}
four_fours!(f32x4, f32, gather_fours_f32x4, scatter_fours_f32x4);
four_fours!(f64x4, f64, gather_fours_f64x4, scatter_fours_f64x4);

/// Two 4×4 transposes side by side. Its own inverse.
#[cfg(target_feature = "avx")]
#[inline(always)]
fn transpose_halves([a, b, c, d]: [f32x8; 4]) -> [f32x8; 4] {
    use safe_arch::{m256, shuffle_m256, unpack_hi_m256, unpack_lo_m256};
    let [a, b, c, d]: [m256; 4] = bytemuck::cast([a, b, c, d]);
    let (low_ab, high_ab) = (unpack_lo_m256(a, b), unpack_hi_m256(a, b));
    let (low_cd, high_cd) = (unpack_lo_m256(c, d), unpack_hi_m256(c, d));
    bytemuck::cast([
        shuffle_m256::<0b01_00_01_00>(low_ab, low_cd),
        shuffle_m256::<0b11_10_11_10>(low_ab, low_cd),
        shuffle_m256::<0b01_00_01_00>(high_ab, high_cd),
        shuffle_m256::<0b11_10_11_10>(high_ab, high_cd),
    ])
}

#[cfg(not(target_feature = "avx"))]
#[inline(always)]
fn transpose_halves(rows: [f32x8; 4]) -> [f32x8; 4] {
    let halves: [[f32x4; 2]; 4] = rows.map(bytemuck::cast);
    let low = f32x4::transpose(halves.map(|h| h[0]));
    let high = f32x4::transpose(halves.map(|h| h[1]));
    bytemuck::cast([[low[0], high[0]], [low[1], high[1]], [low[2], high[2]], [low[3], high[3]]])
}

#[inline(always)]
fn gather_fours_f32x8(fours: &[[f32; 4]], index: &[u32]) -> [f32x8; 4] {
    let i: &[u32; 8] = index[..8].try_into().unwrap_or_else(|_| unreachable!("a slice of eight"));
    let row = |lane: usize| f32x4::new(fours[i[lane] as usize]);
    let pair = |low: usize, high: usize| bytemuck::cast::<[f32x4; 2], f32x8>([row(low), row(high)]);
    transpose_halves([pair(0, 4), pair(1, 5), pair(2, 6), pair(3, 7)])
}

#[inline(always)]
fn scatter_fours_f32x8(from: [f32x8; 4], to: &mut [[f32; 4]], index: &[u32]) {
    let i: &[u32; 8] = index[..8].try_into().unwrap_or_else(|_| unreachable!("a slice of eight"));
    let rows: [[[f32; 4]; 2]; 4] = bytemuck::cast(transpose_halves(from));
    for half in 0..2 {
        for (lane, row) in rows.iter().enumerate() {
            to[i[4 * half + lane] as usize] = row[half];
        }
    }
}

#[inline(always)]
fn gather_fours_f32x16(fours: &[[f32; 4]], index: &[u32]) -> [f32x16; 4] {
    let [a, b, c, d] = gather_fours_f32x8(fours, &index[..8]);
    let [e, f, g, h] = gather_fours_f32x8(fours, &index[8..16]);
    let join = |low: f32x8, high: f32x8| bytemuck::cast([low, high]);
    [join(a, e), join(b, f), join(c, g), join(d, h)]
}

#[inline(always)]
fn scatter_fours_f32x16(from: [f32x16; 4], to: &mut [[f32; 4]], index: &[u32]) {
    let halves: [[f32x8; 2]; 4] = from.map(bytemuck::cast);
    scatter_fours_f32x8(halves.map(|h| h[0]), to, &index[..8]);
    scatter_fours_f32x8(halves.map(|h| h[1]), to, &index[8..16]);
}

/// The set bits of `bits`, lowest first: which lanes a kernel must hand on.
#[inline(always)]
pub fn set_lanes(mut bits: u32) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        (bits != 0).then(|| {
            let lane = bits.trailing_zeros() as usize;
            bits &= bits - 1;
            lane
        })
    })
}
