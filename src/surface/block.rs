//! The seam between coverage and colour: blocks of 16 × 8 pixels.
//!
//! A rasterizer says how much of each pixel is covered ([`MaskBlock`]), a paint gives colours
//! ([`PixelBlock`]), and blending joins the two with what is there. Neither side knows the other.

use fearless_simd::i32x4;
use fearless_simd::prelude::*;

/// Columns of a block.
pub(crate) const BLOCK_WIDTH: usize = 16;
/// Rows of a block; also the rows of a strip, the rasterizer's unit of work.
pub(crate) const BLOCK_HEIGHT: usize = 8;

/// Coverage of a block, rows top down, 0 (outside) ..= 255 (covered).
pub(crate) type MaskBlock = [[u8; BLOCK_WIDTH]; BLOCK_HEIGHT];

/// Premultiplied RGBA8 pixels of a block, rows top down.
pub(crate) type PixelBlock = [[u8; BLOCK_WIDTH * 4]; BLOCK_HEIGHT];

/// Some of a block's rows: bit 4 · i stands for row i.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Rows(u32);

impl Rows {
    pub(crate) const ALL: Self = Self(0x1111_1111);

    /// Those that are covered somewhere.
    #[inline(always)]
    pub(crate) fn covered<S: Simd>(simd: S, mask: &MaskBlock) -> Self {
        Self::ALL.without(Self::alike(simd, mask, 0))
    }

    /// Those that are covered whole.
    #[inline(always)]
    pub(crate) fn full<S: Simd>(simd: S, mask: &MaskBlock) -> Self {
        Self::alike(simd, mask, -1)
    }

    /// Those of which every four bytes are `word`.
    #[inline(always)]
    fn alike<S: Simd>(simd: S, mask: &MaskBlock, word: i32) -> Self {
        let mut equal = 0;
        // Row by row, as masks are written: to read two at a time would wait for both to reach the cache.
        for (row, values) in mask.iter().enumerate() {
            let words = i32x4::load_array(simd, bytemuck::cast(*values));
            equal |= (words.simd_eq(i32x4::splat(simd, word)).to_bitmask() as u32) << (4 * row);
        }
        Self(equal & equal >> 1 & equal >> 2 & equal >> 3 & Self::ALL.0)
    }

    /// Those among the first `count` rows.
    #[inline(always)]
    pub(crate) fn within(self, count: usize) -> Self {
        if count < BLOCK_HEIGHT { Self(self.0 & ((1 << (4 * count)) - 1)) } else { self }
    }

    #[inline(always)]
    pub(crate) fn without(self, other: Self) -> Self {
        Self(self.0 & !other.0)
    }

    /// Calls `f` with each row, downwards.
    #[inline(always)]
    pub(crate) fn for_each(self, mut f: impl FnMut(usize)) {
        let mut bits = self.0;
        while bits != 0 {
            f(bits.trailing_zeros() as usize / 4 % BLOCK_HEIGHT);
            bits &= bits - 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::level::{SimdLevel, dispatch};

    #[test]
    fn rows_are_found_by_their_coverage() {
        let mut mask = [[0; BLOCK_WIDTH]; BLOCK_HEIGHT];
        // One byte at every place of a row; rows that lack one.
        mask[1][0] = 1;
        mask[2] = [255; BLOCK_WIDTH];
        mask[4][15] = 128;
        mask[5] = [255; BLOCK_WIDTH];
        mask[5][7] = 254;
        mask[7] = [255; BLOCK_WIDTH];
        let listed = |rows: Rows| {
            let mut list = Vec::new();
            rows.for_each(|row| list.push(row));
            list
        };
        for level in SimdLevel::available() {
            let (covered, full) = dispatch!(level, simd => (Rows::covered(simd, &mask), Rows::full(simd, &mask)));
            assert_eq!(listed(covered), [1, 2, 4, 5, 7], "{level:?}");
            assert_eq!(listed(full), [2, 7], "{level:?}");
            assert_eq!(listed(covered.without(full)), [1, 4, 5], "{level:?}");
            assert_eq!(listed(covered.within(5)), [1, 2, 4], "{level:?}");
            assert_eq!((listed(covered.within(0)), covered.within(8)), (Vec::new(), covered));
        }
    }
}
