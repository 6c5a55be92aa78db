//! Rectangles along the axes: no edges, but two overlaps and a product.

use std::ops::Range;

use fearless_simd::prelude::*;
use fearless_simd::{i32x8, u8x16};

use super::sweep::{BlockSink, scaled_area, scaled_areas};
use crate::geom::FixedRect;
use crate::num::fixed;
use crate::num::lanes::{max_i32, min_i32};
use crate::surface::block::{BLOCK_HEIGHT, BLOCK_WIDTH, BlockCoverage, MaskBlock};

/// Fraction bits of a block's side.
const BLOCK_SHIFT: u32 = fixed::SHIFT + BLOCK_WIDTH.ilog2();

/// Reports the coverage of a rectangle in one strip, whose top is at `top` (fixed point), in blocks `..blocks`: as the
/// sweep of its edges would.
#[inline(always)]
pub(crate) fn sweep_rect<S: Simd, K: BlockSink<S>>(simd: S, rect: FixedRect, top: i32, blocks: usize, sink: &mut K) {
    let Some(RectColumns { left, whole, right }) = RectColumns::of(rect, blocks) else { return };
    if rect.top >= top + ((BLOCK_HEIGHT as i32) << fixed::SHIFT) || rect.bottom <= top {
        return;
    }
    let rows = RectRows::of(simd, rect, top);
    if let Some(side) = left
        && sink.wants(side.block)
    {
        sink.block(simd, side.block, BlockCoverage::of(&side.mask(simd, &rows)));
    }
    if !whole.is_empty() {
        sink.run(simd, whole.start, whole.end, &rows.coverage);
    }
    if let Some(side) = right
        && sink.wants(side.block)
    {
        sink.block(simd, side.block, BlockCoverage::of(&side.mask(simd, &rows)));
    }
}

/// How a rectangle lies across blocks.
#[derive(Clone, Debug)]
pub(crate) struct RectColumns {
    /// The block in which it starts, unless it covers that from side to side.
    pub(crate) left: Option<RectSide>,
    /// The blocks that it covers from side to side.
    pub(crate) whole: Range<usize>,
    /// The block in which it ends, unless it covers that, or starts there as well.
    pub(crate) right: Option<RectSide>,
}

impl RectColumns {
    /// Of what of a rectangle lies in blocks `..blocks`, if anything does.
    #[inline(always)]
    pub(crate) fn of(rect: FixedRect, blocks: usize) -> Option<Self> {
        let (left, right) = (rect.left.max(0), rect.right.min((blocks as i32) << BLOCK_SHIFT));
        if left >= right {
            return None;
        }
        let (first, last) = ((left >> BLOCK_SHIFT) as usize, ((right - 1) >> BLOCK_SHIFT) as usize);
        let side = |block: usize| {
            let start = (block as i32) << BLOCK_SHIFT;
            RectSide { block, left: left - start, right: right - start }
        };
        let is_whole =
            |block: usize| left <= (block as i32) << BLOCK_SHIFT && right >= (block as i32 + 1) << BLOCK_SHIFT;
        let (starts, ends) = (!is_whole(first), !is_whole(last));
        Some(Self {
            left: starts.then(|| side(first)),
            whole: first + usize::from(starts)..last + usize::from(!ends),
            right: (ends && last > first).then(|| side(last)),
        })
    }
}

/// How much of each of a strip's rows a rectangle covers, from top to bottom.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RectRows {
    /// Of 256.
    pub(crate) heights: [i32; BLOCK_HEIGHT],
    /// Rounded, of 255.
    pub(crate) coverage: [u8; BLOCK_HEIGHT],
    /// Whether it is all of every row, as nearly always.
    pub(crate) are_whole: bool,
}

impl RectRows {
    /// In the strip whose top is at `top` (fixed point).
    #[inline(always)]
    pub(crate) fn of<S: Simd>(simd: S, rect: FixedRect, top: i32) -> Self {
        if rect.top <= top && rect.bottom >= top + ((BLOCK_HEIGHT as i32) << fixed::SHIFT) {
            let (heights, coverage) = ([fixed::ONE; BLOCK_HEIGHT], [u8::MAX; BLOCK_HEIGHT]);
            return Self { heights, coverage, are_whole: true };
        }
        let tops = i32x8::simd_from(simd, [0, 256, 512, 768, 1024, 1280, 1536, 1792]) + top;
        let low = max_i32(tops, i32x8::splat(simd, rect.top));
        let high = min_i32(tops + fixed::ONE, i32x8::splat(simd, rect.bottom));
        let heights = max_i32(high - low, i32x8::splat(simd, 0));
        let mut coverage = [0; BLOCK_HEIGHT];
        for (row, lane) in coverage.iter_mut().zip(scaled_areas(heights << fixed::SHIFT).to_array()) {
            *row = lane as u8;
        }
        Self { heights: heights.to_array(), coverage, are_whole: false }
    }
}

/// What of a block a rectangle covers that does not cover it from side to side.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RectSide {
    pub(crate) block: usize,
    /// From where to where, in 1/256 pixel from the block's left side.
    left: i32,
    right: i32,
}

impl RectSide {
    /// The coverage of a row of which `height` / 256 is covered.
    #[inline(always)]
    pub(crate) fn row<S: Simd>(&self, simd: S, height: i32) -> [u8; BLOCK_WIDTH] {
        covered_row(simd, self.left, self.right, height)
    }

    #[inline(always)]
    fn mask<S: Simd>(&self, simd: S, rows: &RectRows) -> MaskBlock {
        // Most rows are covered over their whole height.
        let whole = self.row(simd, fixed::ONE);
        let mut mask = [[0; BLOCK_WIDTH]; BLOCK_HEIGHT];
        for (row, height) in mask.iter_mut().zip(rows.heights) {
            *row = match height {
                0 => continue,
                fixed::ONE => whole,
                part => self.row(simd, part),
            };
        }
        mask
    }
}

/// The coverage of a block's row between `left` and `right`, in 1/256 pixel from the block's left side, for `height` / 256
/// of the row.
#[inline(always)]
fn covered_row<S: Simd>(simd: S, left: i32, right: i32, height: i32) -> [u8; BLOCK_WIDTH] {
    const WIDTH: i32 = (BLOCK_WIDTH as i32) << fixed::SHIFT;
    let value = |width: i32| scaled_area((height * width) as u32);
    let splat = |value: i32| u8x16::splat(simd, value as u8);
    let columns = u8x16::simd_from(simd, [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15]);
    let zero = u8x16::splat(simd, 0);
    let (left, right) = (left.max(0), right.min(WIDTH));
    // The pixels in which it starts and ends, which may be one.
    let (first, last) = (left >> fixed::SHIFT, right >> fixed::SHIFT);
    let inner = u8x16::splat(simd, value(fixed::ONE));
    let mut row = columns.simd_lt(splat(last)).select(inner, zero);
    row = columns.simd_eq(splat(last)).select(u8x16::splat(simd, value(right - (last << fixed::SHIFT))), row);
    row = columns.simd_lt(splat(first)).select(zero, row);
    let end = right.min((first + 1) << fixed::SHIFT);
    row = columns.simd_eq(splat(first)).select(u8x16::splat(simd, value(end - left)), row);
    row.to_array()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::level::{SimdLevel, dispatch};
    use crate::raster::cell::Accumulator;
    use crate::raster::edge::Edge;
    use crate::raster::kernel::add_edge;
    use crate::raster::sweep::{CoverageRule, sweep};

    const BLOCKS: usize = 5;

    #[derive(Default)]
    struct Picture(Vec<[u8; BLOCKS * BLOCK_WIDTH]>);

    impl<S: Simd> BlockSink<S> for Picture {
        fn block(&mut self, _simd: S, index: usize, coverage: BlockCoverage<'_>) {
            let BlockCoverage { mask, covered, full } = coverage;
            let known = BlockCoverage::of(mask);
            assert_eq!((covered, full), (known.covered, known.full), "{mask:?}");
            for (row, values) in self.0.iter_mut().zip(mask) {
                row[index * BLOCK_WIDTH..(index + 1) * BLOCK_WIDTH].copy_from_slice(values);
            }
        }

        fn run(&mut self, _simd: S, start: usize, end: usize, rows: &[u8; BLOCK_HEIGHT]) {
            for (row, value) in self.0.iter_mut().zip(rows) {
                row[start * BLOCK_WIDTH..end * BLOCK_WIDTH].fill(*value);
            }
        }
    }

    #[test]
    fn rectangles_are_covered_as_the_sweep_of_their_edges_says() {
        let mut seed = 5_u32;
        let mut random = |n: i32| {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (seed >> 8) as i32 % n
        };
        for case in 0..600 {
            // Some whole pixels and blocks among them, and some that end above or below the strip.
            let snap = [1, 256, 4096][case % 3];
            let side = |v: i32| v / snap * snap;
            let (x, y) = (side(random(70 * 256)), random(12 * 256) - 512);
            let rect = FixedRect {
                left: x,
                top: y,
                right: (x + side(1 + random(60 * 256))).min((BLOCKS * BLOCK_WIDTH) as i32 * 256),
                bottom: y + 1 + random(9 * 256),
            };
            for level in SimdLevel::available() {
                let empty = || Picture(vec![[0; BLOCKS * BLOCK_WIDTH]; BLOCK_HEIGHT]);
                let (mut swept, mut direct) = (empty(), empty());
                dispatch!(level, simd => {
                    let mut cells = Accumulator::default();
                    cells.resize(BLOCKS * BLOCK_WIDTH, 1);
                    let FixedRect { left, top, right, bottom } = rect;
                    for (x, y0, y1) in [(left, top, bottom), (right, bottom, top)] {
                        let edge = Edge { x0: x, y0, x1: x, y1 };
                        add_edge(simd, &mut cells, edge, 0, 1, &[]);
                    }
                    sweep(simd, &mut cells.strip(0).unwrap(), BLOCKS, CoverageRule::NonZero, &mut swept);
                    sweep_rect(simd, rect, 0, BLOCKS, &mut direct);
                });
                assert_eq!(swept.0, direct.0, "{rect:?} at {level:?}");
            }
        }
    }
}
