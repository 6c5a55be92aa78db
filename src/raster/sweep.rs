//! The sweep: accumulated cells to coverage, block by block, by the fill rule.

use fearless_simd::prelude::*;
use fearless_simd::{f32x8, i32x8};

use super::cell::{FULL, StripCells};
use crate::num::lanes::{min_i32, truncate_f32};
use crate::surface::block::{BLOCK_HEIGHT, BLOCK_WIDTH, MaskBlock};

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
    fn block(&mut self, simd: S, index: usize, mask: &MaskBlock);
    /// Blocks `start..end` are covered by the same value along each row.
    fn run(&mut self, simd: S, start: usize, end: usize, rows: &[u8; BLOCK_HEIGHT]);
}

/// Turns a strip's cells into coverage and leaves them zero. Blocks without coverage are not reported.
///
/// `blocks` is the number of blocks that can be drawn; the cells have one more.
#[inline(always)]
pub(crate) fn sweep<S: Simd, K: BlockSink<S>>(
    simd: S,
    cells: &mut StripCells<'_>,
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
            |v| non_zero(simd, v),
        ),
        CoverageRule::EvenOdd => sweep_with(
            simd,
            cells,
            blocks,
            sink,
            #[inline(always)]
            |v| even_odd(simd, v),
        ),
        CoverageRule::Samples(count) => {
            let scale = 255.0 / f32::from(count);
            sweep_with(
                simd,
                cells,
                blocks,
                sink,
                #[inline(always)]
                |v| samples(simd, v, scale),
            );
        }
    }
}

#[inline(always)]
fn sweep_with<S: Simd, K: BlockSink<S>>(
    simd: S,
    cells: &mut StripCells<'_>,
    blocks: usize,
    sink: &mut K,
    coverage: impl Fn(i32x8<S>) -> i32x8<S>,
) {
    let mut cover = i32x8::splat(simd, 0);
    let mut done = 0;
    let mut mask: MaskBlock = [[0; BLOCK_WIDTH]; BLOCK_HEIGHT];
    for word_index in 0..cells.occupied.len() {
        let Some(word) = cells.occupied.get_mut(word_index) else { break };
        let mut bits = core::mem::take(word);
        while bits != 0 {
            let index = word_index * 64 + bits.trailing_zeros() as usize;
            bits &= bits - 1;
            if index > done && done < blocks {
                uniform(simd, coverage(cover), done, index.min(blocks), sink);
            }
            let Some(columns) =
                cells.columns.get_mut(index * BLOCK_WIDTH..).and_then(|c| c.first_chunk_mut::<BLOCK_WIDTH>())
            else {
                break;
            };
            if index >= blocks {
                // A block in which nothing is drawn, such as the one into which the last column spills.
                *columns = [[0; BLOCK_HEIGHT]; BLOCK_WIDTH];
                done = index + 1;
                continue;
            }
            if !sink.wants(index) {
                for column in columns.iter_mut() {
                    cover += i32x8::load_array_ref(simd, column);
                    *column = [0; BLOCK_HEIGHT];
                }
                done = index + 1;
                continue;
            }
            let mut quads = [[0_i32; BLOCK_HEIGHT]; 4];
            for (quad, columns) in quads.iter_mut().zip(columns.as_chunks_mut::<4>().0) {
                let mut packed = i32x8::splat(simd, 0);
                for (shift, column) in columns.iter_mut().enumerate() {
                    cover += i32x8::load_array_ref(simd, column);
                    *column = [0; BLOCK_HEIGHT];
                    packed |= coverage(cover) << (8 * shift as u32);
                }
                packed.store_array(quad);
            }
            for (row, out) in mask.iter_mut().enumerate() {
                for (quad, out) in quads.iter().zip(out.as_chunks_mut::<4>().0) {
                    *out = quad.get(row).copied().unwrap_or(0).to_le_bytes();
                }
            }
            sink.block(simd, index, &mask);
            done = index + 1;
        }
    }
    if done < blocks {
        uniform(simd, coverage(cover), done, blocks, sink);
    }
}

/// Reports blocks `start..end`, where nothing changes along x.
#[inline(always)]
fn uniform<S: Simd, K: BlockSink<S>>(simd: S, coverage: i32x8<S>, start: usize, end: usize, sink: &mut K) {
    let lanes = coverage.to_array();
    if lanes != [0; BLOCK_HEIGHT] {
        // Not `map`: outside of link-time optimisation it stays a call.
        let mut rows = [0; BLOCK_HEIGHT];
        for (row, lane) in rows.iter_mut().zip(lanes) {
            *row = lane as u8;
        }
        sink.run(simd, start, end, &rows);
    }
}

/// |v|, at most full, scaled to 0 ..= 255 and rounded.
#[inline(always)]
fn non_zero<S: Simd>(simd: S, v: i32x8<S>) -> i32x8<S> {
    let sign = v >> 31;
    let magnitude = min_i32((v ^ sign) - sign, i32x8::splat(simd, FULL));
    (magnitude * 255 + FULL / 2) >> 17
}

/// The distance to the nearest even winding, scaled to 0 ..= 255 and rounded.
#[inline(always)]
fn even_odd<S: Simd>(simd: S, v: i32x8<S>) -> i32x8<S> {
    let wrapped = v & (2 * FULL - 1);
    let folded = min_i32(wrapped, i32x8::splat(simd, 2 * FULL) - wrapped);
    (folded * 255 + FULL / 2) >> 17
}

/// A count of samples times 255 / all samples, rounded.
#[inline(always)]
fn samples<S: Simd>(simd: S, v: i32x8<S>, scale: f32) -> i32x8<S> {
    let _ = simd;
    truncate_f32(v.to_float::<f32x8<S>>() * scale + 0.5)
}
