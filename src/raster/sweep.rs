//! The sweep: accumulated cells to coverage, block by block, by the fill rule.

use fearless_simd::prelude::*;
use fearless_simd::{f32x8, f64x2, i32x8, u8x16, u16x16};

use super::cell::{Column, FULL, Strip};
use crate::num::lanes::{high_product, min_i32, min_u16, truncate_f32};
use crate::surface::block::{BLOCK_HEIGHT, BLOCK_WIDTH, BlockCoverage, MaskBlock, Rows};

/// How accumulated values become coverage.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum CoverageRule {
    /// Areas by the nonzero rule.
    NonZero,
    /// Areas by the even-odd rule.
    EvenOdd,
    /// Counts of covered samples, of so many a pixel.
    Samples(u16),
}

/// Takes a strip's coverage from left to right.
pub(crate) trait BlockSink<S: Simd> {
    /// Whether the coverage of block `index` matters: if not, it may be left out.
    #[inline(always)]
    fn wants(&self, index: usize) -> bool {
        let _ = index;
        true
    }
    /// Coverage of the block `index` (16 columns each) of the strip.
    fn block(&mut self, simd: S, index: usize, coverage: BlockCoverage<'_>);
    /// Blocks `start..end` are covered by the same value along each row.
    fn run(&mut self, simd: S, start: usize, end: usize, rows: &[u8; BLOCK_HEIGHT]);
}

/// Turns a strip's cells into coverage and leaves them zero. Blocks without coverage are not reported.
///
/// `blocks` is the number of blocks that can be drawn; the cells have one more.
#[inline(always)]
pub(crate) fn sweep<S: Simd, K: BlockSink<S>>(
    simd: S,
    cells: &mut Strip<'_>,
    blocks: usize,
    rule: CoverageRule,
    sink: &mut K,
) {
    match rule {
        CoverageRule::NonZero => sweep_with(
            simd,
            cells,
            blocks,
            sink,
            #[inline(always)]
            |a, b| non_zero(simd, a, b),
        ),
        CoverageRule::EvenOdd => sweep_with(
            simd,
            cells,
            blocks,
            sink,
            #[inline(always)]
            |a, b| even_odd(simd, a, b),
        ),
        CoverageRule::Samples(count) => {
            let scale = 255.0 / f32::from(count);
            sweep_with(
                simd,
                cells,
                blocks,
                sink,
                #[inline(always)]
                |a, b| samples(a, b, scale),
            );
        }
    }
}

#[inline(always)]
fn sweep_with<S: Simd, K: BlockSink<S>>(
    simd: S,
    cells: &mut Strip<'_>,
    blocks: usize,
    sink: &mut K,
    coverage: impl Fn(i32x8<S>, i32x8<S>) -> u16x16<S>,
) {
    let mut cover = i32x8::splat(simd, 0);
    let mut done = 0;
    for word_index in 0..cells.occupied.len() {
        let Some(word) = cells.occupied.get_mut(word_index) else { break };
        let mut bits = core::mem::take(word);
        while bits != 0 {
            let index = word_index * 64 + bits.trailing_zeros() as usize;
            bits &= bits - 1;
            if index > done && done < blocks {
                uniform(simd, coverage(cover, cover), done, index.min(blocks), sink);
            }
            let Some(columns) =
                cells.columns.get_mut(index * BLOCK_WIDTH..).and_then(|c| c.first_chunk_mut::<BLOCK_WIDTH>())
            else {
                break;
            };
            if index >= blocks {
                // A block in which nothing is drawn, such as the one into which the last column spills.
                *columns = [Column::default(); BLOCK_WIDTH];
                done = index + 1;
                continue;
            }
            if !sink.wants(index) {
                for column in columns.iter_mut() {
                    cover += i32x8::load_array_ref(simd, &column.0);
                    *column = Column::default();
                }
                done = index + 1;
                continue;
            }
            // Sixteen columns, four times written out: as a loop it takes a third more instructions.
            let [a, b, c, d] = columns.as_chunks_mut::<4>().0 else { break };
            let quads @ [a, b, c, d] = [
                four_columns(simd, &mut cover, a, &coverage),
                four_columns(simd, &mut cover, b, &coverage),
                four_columns(simd, &mut cover, c, &coverage),
                four_columns(simd, &mut cover, d, &coverage),
            ];
            // Lanes are rows: what there is in a row is found before it becomes one.
            let (none, all) = (i32x8::splat(simd, 0), i32x8::splat(simd, -1));
            let covered = Rows::ALL.without(Rows::of_bits((a | b | c | d).simd_eq(none).to_bitmask() as u8));
            let full = Rows::of_bits((a & b & c & d).simd_eq(all).to_bitmask() as u8);
            sink.block(simd, index, BlockCoverage { mask: &transposed(simd, quads), covered, full });
            done = index + 1;
        }
    }
    if done < blocks {
        uniform(simd, coverage(cover, cover), done, blocks, sink);
    }
}

/// Coverage of four columns, a byte each in the lanes of their rows; `cover` is the sum of all columns so far.
#[inline(always)]
fn four_columns<S: Simd>(
    simd: S,
    cover: &mut i32x8<S>,
    columns: &mut [Column; 4],
    coverage: &impl Fn(i32x8<S>, i32x8<S>) -> u16x16<S>,
) -> i32x8<S> {
    let mut sums = [*cover; 4];
    for (sum, column) in sums.iter_mut().zip(columns) {
        *cover += i32x8::load_array_ref(simd, &column.0);
        *column = Column::default();
        *sum = *cover;
    }
    let [a, b, c, d] = sums;
    (coverage(a, c) | (coverage(b, d) << 8)).bitcast()
}

/// Rows of 16 bytes from four vectors of 8 rows, 4 bytes each: in each half of four rows, a 4 × 4 transpose.
#[inline(always)]
fn transposed<S: Simd>(simd: S, [a, b, c, d]: [i32x8<S>; 4]) -> MaskBlock {
    let mut mask = [[0; BLOCK_WIDTH]; BLOCK_HEIGHT];
    let ((a0, a1), (b0, b1), (c0, c1), (d0, d1)) = (a.split(), b.split(), c.split(), d.split());
    let (upper, lower) = mask.split_at_mut(4);
    for (rows, [a, b, c, d]) in [(upper, [a0, b0, c0, d0]), (lower, [a1, b1, c1, d1])] {
        let pairs = [(a.zip_low(b), c.zip_low(d)), (a.zip_high(b), c.zip_high(d))];
        for (rows, (left, right)) in rows.as_chunks_mut::<2>().0.iter_mut().zip(pairs) {
            let (left, right): (f64x2<S>, f64x2<S>) = (left.bitcast(), right.bitcast());
            let [first, second] = rows;
            u8x16::store_array(left.zip_low(right).bitcast(), first);
            u8x16::store_array(left.zip_high(right).bitcast(), second);
        }
    }
    let _ = simd;
    mask
}

/// Reports blocks `start..end`, where nothing changes along x.
#[inline(always)]
fn uniform<S: Simd, K: BlockSink<S>>(simd: S, coverage: u16x16<S>, start: usize, end: usize, sink: &mut K) {
    let lanes = coverage.bitcast::<i32x8<S>>().to_array();
    if lanes != [0; BLOCK_HEIGHT] {
        // Not `map`: outside of link-time optimisation it stays a call.
        let mut rows = [0; BLOCK_HEIGHT];
        for (row, lane) in rows.iter_mut().zip(lanes) {
            *row = lane as u8;
        }
        sink.run(simd, start, end, &rows);
    }
}

/// What of a word's sum makes coverage: see [`scaled`].
const HALF: u16 = 65;
const SCALE: u16 = 510;

/// Coverage of a pixel of which so much is covered, in 1/2^15: scaled to 0 ..= 255 and rounded.
///
/// In words, of which one instruction multiplies two columns: ⌊(v + 65) · 510 / 2^16⌋ = ⌊v · 255 / 2^15 + 0.506⌋. A little more than
/// half, since v was rounded down; what is covered by half is 128.
#[inline(always)]
fn scaled<S: Simd>(quarters: u16x16<S>) -> u16x16<S> {
    high_product(quarters + HALF, SCALE)
}

/// As [`scaled`], for areas in 1/65,536.
#[inline(always)]
pub(super) fn scaled_area(area: u32) -> u8 {
    ((((area >> 1) + u32::from(HALF)) * u32::from(SCALE)) >> 16) as u8
}

/// [`scaled_area`] of eight.
#[inline(always)]
pub(super) fn scaled_areas<S: Simd>(areas: i32x8<S>) -> i32x8<S> {
    (((areas >> 1) + i32::from(HALF)) * i32::from(SCALE)) >> 16
}

/// Quarters of two columns' sums, which are 1/2^15 of a pixel, modulo 2^16: of the first in even lanes, of the second in odd ones.
#[inline(always)]
fn quarters<S: Simd>(first: i32x8<S>, second: i32x8<S>) -> u16x16<S> {
    const LOW: i32 = 0xffff;
    (((first >> 2) & LOW) | ((second << 14) & !LOW)).bitcast()
}

/// |v|, at most full, of two columns.
#[inline(always)]
fn non_zero<S: Simd>(simd: S, first: i32x8<S>, second: i32x8<S>) -> u16x16<S> {
    scaled(quarters(magnitude(simd, first), magnitude(simd, second)))
}

#[inline(always)]
fn magnitude<S: Simd>(simd: S, v: i32x8<S>) -> i32x8<S> {
    let sign = v >> 31;
    min_i32((v ^ sign) - sign, i32x8::splat(simd, FULL))
}

/// The distance to the nearest even winding, of two columns. Two windings are 2^16 quarters: words forget them.
#[inline(always)]
fn even_odd<S: Simd>(simd: S, first: i32x8<S>, second: i32x8<S>) -> u16x16<S> {
    let quarters = quarters(first, second);
    scaled(min_u16(quarters, u16x16::splat(simd, 0) - quarters))
}

/// A count of samples times 255 / all samples, rounded, of two columns.
#[inline(always)]
fn samples<S: Simd>(first: i32x8<S>, second: i32x8<S>, scale: f32) -> u16x16<S> {
    let first = truncate_f32(first.to_float::<f32x8<S>>() * scale + 0.5);
    let second = truncate_f32(second.to_float::<f32x8<S>>() * scale + 0.5);
    (first | (second << 16)).bitcast()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::level::{SimdLevel, dispatch};

    #[test]
    fn coverage_is_the_area_rounded_at_every_level() {
        for area in 0..=1 << 16_u32 {
            let (got, exact) = (scaled_area(area), f64::from(area) * 255.0 / 65_536.0);
            assert!((f64::from(got) - exact).abs() < 0.515, "{got}, not {exact}");
        }
        assert_eq!([0, 1 << 14, 1 << 15, 1 << 16].map(scaled_area), [0, 64, 128, 255]);
        for level in SimdLevel::available() {
            dispatch!(level, simd => {
                for area in (0..=FULL).step_by(6) {
                    // 2^17 of a sum are one pixel; and by the even-odd rule what two windings more are.
                    let [sum, other] = [area, FULL - area].map(|v| i32x8::splat(simd, v));
                    let expected = [area, FULL - area].map(|v| u16::from(scaled_area(v as u32 >> 1)));
                    let lanes = |words: u16x16<_>| [words.to_array()[6], words.to_array()[7]];
                    assert_eq!(lanes(non_zero(simd, sum, other)), expected, "{area} at {level:?}");
                    assert_eq!(lanes(non_zero(simd, sum + 5 * FULL, other * -1)), [255, expected[1]], "{area} at {level:?}");
                    let wound = even_odd(simd, sum + 6 * FULL, other - 4 * FULL);
                    assert_eq!(lanes(wound), expected, "{area} at {level:?}");
                }
            });
        }
    }
}
