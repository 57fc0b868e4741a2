//! One aligned, padded column of numbers, seen as scalars, as lanes or as rows.

use crate::lanes::{Lanes, ROW, Real};

/// Lane values that smooth motion advances together; fields are matched once for all of them.
pub const BLOCK: usize = 4;

/// Columns are padded to a multiple of this many elements: a whole number of [`BLOCK`]s at the widest lanes. Every width sees the same padding,
/// so a kernel has no tail loop and the padding cannot tell widths apart.
pub const PAD: usize = 64;

/// A growable column: 64-byte aligned, whole lanes at every width, padding filled with an inert value.
///
/// Memory is 1 element per entry, rounded up to [`PAD`]. The scalar view and the lane view are the same
/// memory. Entries at `len..` are padding and hold the value given to [`Column::new`].
#[derive(Clone, Debug)]
pub struct Column<R: Real> {
    lines: Vec<R::Line>,
    len: usize,
    padding: R,
}

impl<R: Real> Column<R> {
    /// An empty column whose padding holds `padding`.
    pub fn new(padding: R) -> Self {
        Self { lines: Vec::new(), len: 0, padding }
    }

    /// A column of `len` entries, all `padding`.
    pub fn filled(len: usize, padding: R) -> Self {
        let mut column = Self::new(padding);
        column.resize(len);
        column
    }

    /// Entries, padding not counted.
    pub fn len(&self) -> usize {
        self.len
    }

    /// Has no entries?
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// Sets the number of entries; new ones, and those cut off, hold the padding value.
    pub fn resize(&mut self, len: usize) {
        let padding = self.padding;
        if len < self.len {
            let old_len = self.len;
            self.padded_mut()[len..old_len].fill(padding);
        }
        let per_line = size_of::<R::Line>() / size_of::<R>();
        let lines = len.div_ceil(PAD) * PAD / per_line;
        if lines > self.lines.len() {
            let fresh = self.lines.len() * per_line;
            self.lines.resize(lines, bytemuck::Zeroable::zeroed());
            self.padded_mut()[fresh..].fill(padding);
        }
        self.len = len;
    }

    /// Appends one entry.
    pub fn push(&mut self, value: R) {
        self.resize(self.len + 1);
        let last = self.len - 1;
        self.padded_mut()[last] = value;
    }

    /// The entries, without padding.
    pub fn as_slice(&self) -> &[R] {
        &self.padded()[..self.len]
    }

    /// The entries, without padding.
    pub fn as_mut_slice(&mut self) -> &mut [R] {
        let len = self.len;
        &mut self.padded_mut()[..len]
    }

    /// Entries and padding.
    #[inline(always)]
    pub fn padded(&self) -> &[R] {
        bytemuck::cast_slice(&self.lines)
    }

    /// Entries and padding. Writers keep the padding inert.
    #[inline(always)]
    pub fn padded_mut(&mut self) -> &mut [R] {
        bytemuck::cast_slice_mut(&mut self.lines)
    }

    /// Entries and padding as lanes: at least ⌈len/[`PAD`]⌉·[`PAD`]/`WIDTH` values, as memory never shrinks.
    #[inline(always)]
    pub fn lanes<L: Lanes<Elem = R>>(&self) -> &[L] {
        bytemuck::cast_slice(&self.lines)
    }

    /// Entries and padding as lanes.
    #[inline(always)]
    pub fn lanes_mut<L: Lanes<Elem = R>>(&mut self) -> &mut [L] {
        bytemuck::cast_slice_mut(&mut self.lines)
    }

    /// Entries and padding as rows of [`ROW`] elements: what [`Lanes::gather_rows`] reads.
    #[inline(always)]
    pub fn rows(&self) -> &[[R; ROW]] {
        bytemuck::cast_slice(&self.lines)
    }

    /// Entries and padding as rows of [`ROW`] elements.
    #[inline(always)]
    pub fn rows_mut(&mut self) -> &mut [[R; ROW]] {
        bytemuck::cast_slice_mut(&mut self.lines)
    }

    /// Entries and padding as rows of four: what [`Lanes::gather_fours`] reads.
    #[inline(always)]
    pub fn fours(&self) -> &[[R; 4]] {
        bytemuck::cast_slice(&self.lines)
    }

    /// Entries and padding as rows of four.
    #[inline(always)]
    pub fn fours_mut(&mut self) -> &mut [[R; 4]] {
        bytemuck::cast_slice_mut(&mut self.lines)
    }

    /// Bytes held, padding included.
    pub fn bytes(&self) -> usize {
        size_of_val(self.lines.as_slice())
    }
}

impl<R: Real> std::ops::Index<usize> for Column<R> {
    type Output = R;
    #[inline(always)]
    fn index(&self, at: usize) -> &R {
        &self.padded()[at]
    }
}

impl<R: Real> std::ops::IndexMut<usize> for Column<R> {
    #[inline(always)]
    fn index_mut(&mut self, at: usize) -> &mut R {
        &mut self.padded_mut()[at]
    }
}
