//! Lanes: the numbers every kernel is written over, and the only room that names `wide`.
//!
//! A kernel is written once over [`Lanes`]. Width 1 is a plain `f32` or `f64`, so it *is* the
//! scalar version. The trait holds only operations whose result is the same to the bit on every
//! backend: + − × ÷ √ |x|, comparisons, select, minimum and maximum (defined as a select), loads, stores and transposes.
//! Deliberately absent: fused multiply-add, approximate reciprocals, horizontal sums and transcendental
//! functions.

mod vector;

use std::fmt::{Debug, Display};
use std::ops::{Add, AddAssign, BitAnd, BitOr, Div, Mul, Neg, Not, Sub, SubAssign};

use bytemuck::Pod;
use wide::{f32x16, f64x8};

pub use vector::{Mask, f32s, f64s};

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
    /// The widest lanes of this scalar.
    type Widest: Lanes<Elem = Self>;
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
    type Widest = f32s::X16;
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
    type Widest = f64s::X4;
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
        for (lane, index) in index[..Self::WIDTH].iter().enumerate() {
            at[lane] = index * 4;
        }
        // A loop: as a closure it was left a call.
        let mut quads = [[Self::zero(); ROW]; 4];
        for quad in &mut quads {
            *quad = Self::gather_rows(rows, &at);
            for at in &mut at {
                *at += 1;
            }
        }
        quads
    }
    /// The inverse of [`Lanes::gather_rows`] over an array of rows: `to[lane][k] = from[k][lane]`,
    /// for the first `WIDTH` rows of `to`.
    fn store_rows(from: [Self; ROW], to: &mut [[Self::Elem; ROW]]);
    /// Like [`Lanes::gather_rows`], for rows of four.
    fn gather_fours(fours: &[[Self::Elem; 4]], index: &[u32]) -> [Self; 4];
    /// The inverse of [`Lanes::gather_fours`]: `to[index[lane]][k] = from[k][lane]`; where lanes name the same
    /// row, the first one's stays. Panics if an index is out of range.
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
