//! The rows of a band that is being painted: the target's own, or a layer's.

use fearless_simd::prelude::*;
use fearless_simd::{u8x32, u32x8};

use crate::geom::IntRect;
use crate::surface::block::{BLOCK_HEIGHT, BLOCK_WIDTH, PixelBlock, Rows};

/// Bytes of a block's row.
pub(super) const ROW_BYTES: usize = BLOCK_WIDTH * 4;
/// A transparent block.
pub(super) const NO_PIXELS: PixelBlock = [[0; ROW_BYTES]; BLOCK_HEIGHT];

/// Premultiplied RGBA8 rows of one band.
pub(super) struct Surface<'a> {
    data: &'a mut [u8],
    stride: usize,
    /// The block column (16 pixels each, from the canvas's left side) at which rows start.
    first_block: usize,
    /// Bytes in a row that can be drawn.
    row_bytes: usize,
    rows: usize,
}

impl<'a> Surface<'a> {
    pub(super) fn new(data: &'a mut [u8], stride: usize, first_block: usize, width: usize, rows: usize) -> Self {
        Self { data, stride, first_block, row_bytes: width * 4, rows }
    }

    /// The same rows, for a shorter time.
    pub(super) fn reborrow(&mut self) -> Surface<'_> {
        Surface { data: self.data, ..*self }
    }

    /// The device pixels that it holds, if its first row lies at `top`.
    pub(super) fn area(&self, top: i32) -> IntRect {
        let left = (self.first_block * BLOCK_WIDTH) as i32;
        IntRect { left, top, right: left + (self.row_bytes / 4) as i32, bottom: top + self.rows as i32 }
    }

    /// Makes every pixel this one.
    #[inline(never)]
    pub(super) fn fill<S: Simd>(&mut self, simd: S, color: [u8; 4]) {
        simd.vectorize(
            #[inline(always)]
            || {
                for line in self.data.chunks_mut(self.stride.max(1)).take(self.rows) {
                    fill_line(simd, line.get_mut(..self.row_bytes).unwrap_or(&mut []), color);
                }
            },
        );
    }

    /// What there is of a row from the device column `column` on, which the surface must hold; the surface's first row is 0.
    #[inline(always)]
    pub(super) fn from(&mut self, row: i32, column: i32) -> &mut [u8] {
        let start = (column - (self.first_block * BLOCK_WIDTH) as i32) as usize * 4;
        self.data.get_mut(row as usize * self.stride + start..).unwrap_or(&mut [])
    }

    /// The rows of strip `strip` that exist.
    #[inline(always)]
    pub(super) fn strip(&mut self, strip: usize) -> StripRows<'_> {
        let Self { stride, first_block, row_bytes: width, rows, .. } = *self;
        let count = rows.saturating_sub(strip * BLOCK_HEIGHT).min(BLOCK_HEIGHT);
        let bytes = self.data.get_mut(strip * BLOCK_HEIGHT * stride..).unwrap_or(&mut []);
        StripRows { bytes, stride, first_block, width, count }
    }
}

/// A strip's rows.
pub(super) struct StripRows<'a> {
    bytes: &'a mut [u8],
    stride: usize,
    first_block: usize,
    /// Bytes in a row that can be drawn.
    width: usize,
    /// How many there are: 0 ..= 8.
    count: usize,
}

impl StripRows<'_> {
    pub(super) fn count(&self) -> usize {
        self.count
    }

    /// The rows in blocks `start..end`, as far as they exist.
    #[inline(always)]
    pub(super) fn lines(&mut self, start: usize, end: usize) -> Lines<'_> {
        let from = (start.saturating_sub(self.first_block) * ROW_BYTES).min(self.width);
        let to = (end.saturating_sub(self.first_block) * ROW_BYTES).min(self.width);
        let bytes = self.bytes.get_mut(from..).unwrap_or(&mut []);
        Lines { bytes, stride: self.stride, width: to.saturating_sub(from), count: self.count }
    }

    /// Calls `f` with a block's rows. At the right side, where rows end inside the block, these are a copy.
    #[inline(always)]
    pub(super) fn with_block(&mut self, block: usize, f: impl FnOnce(BlockRows<'_>)) {
        let &mut Self { stride, count, .. } = self;
        let from = block.wrapping_sub(self.first_block).wrapping_mul(ROW_BYTES);
        let is_whole = block >= self.first_block && from + ROW_BYTES <= self.width;
        let mut copy = if is_whole { None } else { Some(self.lines(block, block + 1).cut_block()) };
        // One place that calls `f`, which is long.
        f(match &mut copy {
            Some(copy) => BlockRows { bytes: copy.as_flattened_mut(), stride: ROW_BYTES, count },
            None => BlockRows { bytes: self.bytes.get_mut(from..).unwrap_or(&mut []), stride, count },
        });
        if let Some(copy) = &copy {
            self.lines(block, block + 1).put_cut_block(copy);
        }
    }

    /// A copy of a block; pixels that do not exist are transparent.
    #[inline(always)]
    pub(super) fn load(&mut self, block: usize) -> PixelBlock {
        let mut copy = NO_PIXELS;
        self.with_block(
            block,
            #[inline(always)]
            |mut rows| {
                rows.each(
                    Rows::ALL,
                    #[inline(always)]
                    |row, pixels| {
                        if let Some(copy) = copy.get_mut(row) {
                            *copy = *pixels;
                        }
                    },
                );
            },
        );
        copy
    }

    /// Writes a block back.
    #[inline(always)]
    pub(super) fn store(&mut self, block: usize, pixels: &PixelBlock) {
        self.with_block(
            block,
            #[inline(always)]
            |mut rows| {
                rows.each(
                    Rows::ALL,
                    #[inline(always)]
                    |row, out| {
                        if let Some(pixels) = pixels.get(row) {
                            *out = *pixels;
                        }
                    },
                );
            },
        );
    }
}

/// Fills part of a row with one colour.
#[inline(always)]
pub(super) fn fill_line<S: Simd>(simd: S, line: &mut [u8], color: [u8; 4]) {
    // Not four bytes at a time, which would be stored one by one.
    let eight: u8x32<S> = u32x8::splat(simd, u32::from_ne_bytes(color)).bitcast();
    let (blocks, tail) = line.as_chunks_mut::<32>();
    for pixels in blocks {
        eight.store_array(pixels);
    }
    if !tail.is_empty() {
        fill_tail(tail, color);
    }
}

/// Out of the way of the loop above, as only rows that end inside a block come here.
#[cold]
#[inline(never)]
fn fill_tail(tail: &mut [u8], color: [u8; 4]) {
    for pixel in tail.as_chunks_mut::<4>().0 {
        *pixel = color;
    }
}

/// Calls `f` with each value and what there is from its row's start on: without a product for each row.
#[inline(always)]
fn downwards<T>(mut bytes: &mut [u8], stride: usize, values: impl Iterator<Item = T>, mut f: impl FnMut(T, &mut [u8])) {
    for value in values {
        f(value, bytes);
        bytes = bytes.get_mut(stride..).unwrap_or(&mut []);
    }
}

/// Parts of a strip's rows.
pub(super) struct Lines<'a> {
    bytes: &'a mut [u8],
    stride: usize,
    /// Bytes of each part.
    width: usize,
    count: usize,
}

impl Lines<'_> {
    /// Applies `f` to each row's part, downwards.
    #[inline(always)]
    pub(super) fn each(&mut self, mut f: impl FnMut(&mut [u8])) {
        downwards(
            self.bytes,
            self.stride,
            0..self.count,
            #[inline(always)]
            |_, rest| {
                if let Some(part) = rest.get_mut(..self.width) {
                    f(part);
                }
            },
        );
    }

    /// Applies `f` to each value and its row's part, downwards.
    #[inline(always)]
    pub(super) fn with<T>(&mut self, values: &[T; BLOCK_HEIGHT], mut f: impl FnMut(&T, &mut [u8])) {
        downwards(
            self.bytes,
            self.stride,
            values.iter().take(self.count),
            #[inline(always)]
            |value, rest| {
                if let Some(part) = rest.get_mut(..self.width) {
                    f(value, part);
                }
            },
        );
    }

    /// The part of row `row` of the strip; nothing if there is no such row.
    #[inline(always)]
    fn row(&mut self, row: usize) -> &mut [u8] {
        if row >= self.count {
            return &mut [];
        }
        let from = row * self.stride;
        self.bytes.get_mut(from..from + self.width).unwrap_or(&mut [])
    }

    /// A copy of a block of which these are what exists; the rest is transparent.
    #[inline(never)]
    fn cut_block(&mut self) -> PixelBlock {
        let mut copy = NO_PIXELS;
        for (row, copy) in copy.iter_mut().enumerate() {
            for (copy, byte) in copy.iter_mut().zip(self.row(row)) {
                *copy = *byte;
            }
        }
        copy
    }

    #[inline(never)]
    fn put_cut_block(&mut self, copy: &PixelBlock) {
        for (row, copy) in copy.iter().enumerate() {
            for (byte, copy) in self.row(row).iter_mut().zip(copy) {
                *byte = *copy;
            }
        }
    }
}

/// A block's rows in place.
pub(super) struct BlockRows<'a> {
    bytes: &'a mut [u8],
    stride: usize,
    count: usize,
}

impl BlockRows<'_> {
    /// Applies `f` to the pixels of all rows, downwards.
    #[inline(always)]
    pub(super) fn each_one(&mut self, mut f: impl FnMut(&mut [u8; ROW_BYTES])) {
        let mut rest = &mut *self.bytes;
        for _ in 0..self.count {
            let Some(pixels) = rest.first_chunk_mut::<ROW_BYTES>() else { return };
            f(pixels);
            rest = rest.get_mut(self.stride..).unwrap_or(&mut []);
        }
    }

    /// Applies `f` to each value and the pixels of its row, downwards.
    #[inline(always)]
    pub(super) fn with<T>(&mut self, values: &[T; BLOCK_HEIGHT], mut f: impl FnMut(&T, &mut [u8; ROW_BYTES])) {
        downwards(
            self.bytes,
            self.stride,
            values.iter().take(self.count),
            #[inline(always)]
            |value, rest| {
                if let Some(pixels) = rest.first_chunk_mut::<ROW_BYTES>() {
                    f(value, pixels);
                }
            },
        );
    }

    /// Applies `f` to the numbers and pixels of those of `rows` that exist.
    #[inline(always)]
    pub(super) fn each(&mut self, rows: Rows, mut f: impl FnMut(usize, &mut [u8; ROW_BYTES])) {
        rows.within(self.count).for_each(
            #[inline(always)]
            |row| {
                let rest = self.bytes.get_mut(row * self.stride..);
                if let Some(pixels) = rest.and_then(|rest| rest.first_chunk_mut::<ROW_BYTES>()) {
                    f(row, pixels);
                }
            },
        );
    }
}
