//! Lanes of four, eight and sixteen: the types of `wide`, and the transposes it lacks.

use std::ops::{BitAnd, BitOr, Not};

use wide::{f32x4, f32x8, f32x16, f64x4};

use super::{LaneMask, Lanes, ROW};
use crate::each::Each as _;

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

/// The first `N` values. Not `copy_from_slice`: what that calls is not inlined, and copies a length it does not know.
#[inline(always)]
fn first<T, const N: usize>(from: &[T]) -> &[T; N] {
    from.first_chunk().unwrap_or_else(|| panic!("{N} values are asked of {}", from.len()))
}

#[inline(always)]
fn first_mut<T, const N: usize>(to: &mut [T]) -> &mut [T; N] {
    let len = to.len();
    to.first_chunk_mut().unwrap_or_else(|| panic!("{N} values are to go into {len}"))
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
                <$v>::new(*first(from))
            }
            #[inline(always)]
            fn store(self, to: &mut [$t]) {
                *first_mut(to) = *self.as_array();
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
    for (lane, out) in to[..8].iter_mut().enumerate() {
        *out = *rows[lane].as_array();
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
    let halves: [[f32x8; 2]; ROW] = from.each(bytemuck::cast);
    store_f32x8(halves.each(|h| h[0]), &mut to[..8]);
    store_f32x8(halves.each(|h| h[1]), &mut to[8..16]);
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
                *first_mut(out) = *low[lane].as_array();
                *first_mut(&mut out[4..]) = *high[lane].as_array();
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
            to[i[3] as usize] = *rows[3].as_array();
            to[i[2] as usize] = *rows[2].as_array();
            to[i[1] as usize] = *rows[1].as_array();
            to[i[0] as usize] = *rows[0].as_array();
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
    let halves: [[f32x4; 2]; 4] = rows.each(bytemuck::cast);
    let low = f32x4::transpose(halves.each(|h| h[0]));
    let high = f32x4::transpose(halves.each(|h| h[1]));
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
    for half in [1, 0] {
        for (lane, row) in rows.iter().enumerate().rev() {
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
    let halves: [[f32x8; 2]; 4] = from.each(bytemuck::cast);
    scatter_fours_f32x8(halves.each(|h| h[1]), to, &index[8..16]);
    scatter_fours_f32x8(halves.each(|h| h[0]), to, &index[..8]);
}
