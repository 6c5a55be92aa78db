//! The seam between coverage and colour: blocks of 16 × 8 pixels.
//!
//! A rasterizer says how much of each pixel is covered ([`MaskBlock`]), a paint gives colours
//! ([`PixelBlock`]), and blending joins the two with what is there. Neither side knows the other.

/// Columns of a block.
pub(crate) const BLOCK_WIDTH: usize = 16;
/// Rows of a block; also the rows of a strip, the rasterizer's unit of work.
pub(crate) const BLOCK_HEIGHT: usize = 8;

/// Coverage of a block, rows top down, 0 (outside) ..= 255 (covered).
pub(crate) type MaskBlock = [[u8; BLOCK_WIDTH]; BLOCK_HEIGHT];

/// Premultiplied RGBA8 pixels of a block, rows top down.
pub(crate) type PixelBlock = [[u8; BLOCK_WIDTH * 4]; BLOCK_HEIGHT];

/// Some of a block's rows: bit i stands for row i.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Rows(u8);

impl Rows {
    pub(crate) const ALL: Self = Self(u8::MAX);

    /// Those whose bits are set.
    #[inline(always)]
    pub(crate) fn of_bits(bits: u8) -> Self {
        Self(bits)
    }

    /// Those for which `test` holds.
    #[inline(always)]
    fn that<T>(rows: &[T; BLOCK_HEIGHT], test: impl Fn(&T) -> bool) -> Self {
        Self(rows.iter().enumerate().fold(0, |bits, (row, value)| bits | u8::from(test(value)) << row))
    }

    /// Those among the first `count` rows.
    #[inline(always)]
    pub(crate) fn within(self, count: usize) -> Self {
        if count < BLOCK_HEIGHT { Self(self.0 & ((1 << count) - 1)) } else { self }
    }

    #[inline(always)]
    pub(crate) fn without(self, other: Self) -> Self {
        Self(self.0 & !other.0)
    }

    /// Calls `f` with each row, downwards.
    #[inline(always)]
    pub(crate) fn for_each(self, mut f: impl FnMut(usize)) {
        let mut bits = u32::from(self.0);
        while bits != 0 {
            f(bits.trailing_zeros() as usize % BLOCK_HEIGHT);
            bits &= bits - 1;
        }
    }
}

/// The coverage of a block, and what is known of its rows: most blocks at an outline have some without coverage.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BlockCoverage<'a> {
    pub(crate) mask: &'a MaskBlock,
    /// The rows that are covered somewhere.
    pub(crate) covered: Rows,
    /// The rows that are covered whole.
    pub(crate) full: Rows,
}

impl<'a> BlockCoverage<'a> {
    /// That of a mask of which nothing is known.
    #[inline(always)]
    pub(crate) fn of(mask: &'a MaskBlock) -> Self {
        Self {
            mask,
            covered: Rows::that(mask, |row| *row != [0; BLOCK_WIDTH]),
            full: Rows::that(mask, |row| *row == [u8::MAX; BLOCK_WIDTH]),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
        let BlockCoverage { covered, full, .. } = BlockCoverage::of(&mask);
        assert_eq!(listed(covered), [1, 2, 4, 5, 7]);
        assert_eq!(listed(full), [2, 7]);
        assert_eq!(listed(covered.without(full)), [1, 4, 5]);
        assert_eq!(listed(covered.within(5)), [1, 2, 4]);
        assert_eq!((listed(covered.within(0)), covered.within(8)), (Vec::new(), covered));
    }
}
