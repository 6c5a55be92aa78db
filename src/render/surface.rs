//! The rows of a band that is being painted: the target's own, or a layer's.

use crate::surface::block::{BLOCK_HEIGHT, BLOCK_WIDTH, PixelBlock};

const ROW_BYTES: usize = BLOCK_WIDTH * 4;

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

    /// Pixels in a row.
    pub(super) fn width(&self) -> usize {
        self.row_bytes / 4
    }

    /// Rows.
    pub(super) fn rows(&self) -> usize {
        self.rows
    }

    /// The rows of strip `strip` that exist: 0 ..= 8.
    #[inline(always)]
    pub(super) fn strip_rows(&self, strip: usize) -> usize {
        self.rows.saturating_sub(strip * BLOCK_HEIGHT).min(BLOCK_HEIGHT)
    }

    /// The part of a row in blocks `start..end`.
    #[inline(always)]
    pub(super) fn row(&mut self, row: usize, start: usize, end: usize) -> &mut [u8] {
        let from = start.saturating_sub(self.first_block) * ROW_BYTES;
        let to = (end.saturating_sub(self.first_block) * ROW_BYTES).min(self.row_bytes);
        let base = row * self.stride;
        self.data.get_mut(base + from.min(to)..base + to).unwrap_or(&mut [])
    }

    /// Applies `f` to the 16 pixels of `row` in block `block`. At the right side, where a row ends inside the
    /// block, to a copy.
    #[inline(always)]
    pub(super) fn with_row(&mut self, row: usize, block: usize, f: impl FnOnce(&mut [u8; ROW_BYTES])) {
        let slice = self.row(row, block, block + 1);
        if let Some(pixels) = slice.first_chunk_mut::<ROW_BYTES>() {
            f(pixels);
        } else {
            let mut pixels = [0; ROW_BYTES];
            for (copy, byte) in pixels.iter_mut().zip(slice.iter()) {
                *copy = *byte;
            }
            f(&mut pixels);
            for (byte, copy) in slice.iter_mut().zip(pixels) {
                *byte = copy;
            }
        }
    }

    /// A copy of a block; pixels that do not exist are transparent.
    #[inline(always)]
    pub(super) fn load(&mut self, strip: usize, block: usize) -> PixelBlock {
        let mut pixels = [[0; ROW_BYTES]; BLOCK_HEIGHT];
        let rows = self.strip_rows(strip);
        for (row, out) in pixels.iter_mut().enumerate().take(rows) {
            let slice = self.row(strip * BLOCK_HEIGHT + row, block, block + 1);
            if let Some(whole) = slice.first_chunk::<ROW_BYTES>() {
                *out = *whole;
            } else {
                for (out, byte) in out.iter_mut().zip(slice.iter()) {
                    *out = *byte;
                }
            }
        }
        pixels
    }

    /// Writes a block back.
    #[inline(always)]
    pub(super) fn store(&mut self, strip: usize, block: usize, pixels: &PixelBlock) {
        let rows = self.strip_rows(strip);
        for (row, pixels) in pixels.iter().enumerate().take(rows) {
            let slice = self.row(strip * BLOCK_HEIGHT + row, block, block + 1);
            if let Some(whole) = slice.first_chunk_mut::<ROW_BYTES>() {
                *whole = *pixels;
            } else {
                for (byte, pixel) in slice.iter_mut().zip(pixels) {
                    *byte = *pixel;
                }
            }
        }
    }
}
