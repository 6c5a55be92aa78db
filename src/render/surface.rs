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

    /// Applies `f` to each row's number in the strip and its 16 pixels in block `block`, for the rows that `wanted` says
    /// yes to. At the right side, where rows end inside the block, to a copy.
    #[inline(always)]
    pub(super) fn for_block(
        &mut self,
        strip: usize,
        block: usize,
        wanted: impl Fn(usize) -> bool,
        mut f: impl FnMut(usize, &mut [u8; ROW_BYTES]),
    ) {
        let rows = self.strip_rows(strip);
        let from = block.saturating_sub(self.first_block) * ROW_BYTES;
        let cut = from + ROW_BYTES > self.row_bytes;
        let end = if cut { self.row_bytes.max(from) } else { from + ROW_BYTES };
        let lines = self.data.get_mut(strip * BLOCK_HEIGHT * self.stride..).unwrap_or(&mut []);
        for (row, line) in lines.chunks_mut(self.stride.max(1)).take(rows).enumerate() {
            if !wanted(row) {
                continue;
            }
            let Some(slice) = line.get_mut(from..end) else { break };
            // One place that calls `f`, which is long.
            let mut copy = [0; ROW_BYTES];
            if cut {
                for (copy, byte) in copy.iter_mut().zip(slice.iter()) {
                    *copy = *byte;
                }
            }
            let pixels = slice.first_chunk_mut::<ROW_BYTES>();
            f(row, pixels.unwrap_or(&mut copy));
            if cut {
                for (byte, copy) in slice.iter_mut().zip(copy) {
                    *byte = copy;
                }
            }
        }
    }

    /// A copy of a block; pixels that do not exist are transparent.
    #[inline(always)]
    pub(super) fn load(&mut self, strip: usize, block: usize) -> PixelBlock {
        let mut copy = [[0; ROW_BYTES]; BLOCK_HEIGHT];
        self.for_block(
            strip,
            block,
            |_| true,
            #[inline(always)]
            |row, pixels| {
                if let Some(copy) = copy.get_mut(row) {
                    *copy = *pixels;
                }
            },
        );
        copy
    }

    /// Writes a block back.
    #[inline(always)]
    pub(super) fn store(&mut self, strip: usize, block: usize, pixels: &PixelBlock) {
        self.for_block(
            strip,
            block,
            |_| true,
            #[inline(always)]
            |row, out| {
                if let Some(pixels) = pixels.get(row) {
                    *out = *pixels;
                }
            },
        );
    }
}
