//! Arrays mapped without the machinery of `array::map` and `array::from_fn`, which made up a quarter of the code the
//! compiler was handed: those go through iterators and partially initialised memory, at every call anew. Answers are the
//! same; elements and results must be `Copy`, and there must be at least one.

/// Mapping of arrays of copies.
pub(crate) trait Each<T, const N: usize> {
    /// `[f(self[0]), f(self[1]), …]`, called in this order.
    fn each<U: Copy>(self, f: impl FnMut(T) -> U) -> [U; N];
}

impl<T: Copy, const N: usize> Each<T, N> for [T; N] {
    #[inline(always)]
    fn each<U: Copy>(self, mut f: impl FnMut(T) -> U) -> [U; N] {
        indexed(|k| f(self[k]))
    }
}

/// `[f(0), f(1), …]`, called in this order.
#[inline(always)]
pub(crate) fn indexed<U: Copy, const N: usize>(mut f: impl FnMut(usize) -> U) -> [U; N] {
    let mut out = [f(0); N];
    let mut k = 1;
    while k < N {
        out[k] = f(k);
        k += 1;
    }
    out
}
