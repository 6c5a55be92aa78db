//! Images between their pixels, linearly: weights in 1/256, in 16-bit lanes.
//!
//! Every sample mixes two pixels of a row, rounds, and mixes two rows, rounds. Both routes do so in the same
//! order, so that they give the same bytes; the result is within 2/255 of the exact value, and mostly within
//! 1/255.

use fearless_simd::prelude::*;
use fearless_simd::{f32x8, i32x8, u16x16, u32x8, u64x4};

use super::pattern::ImagePattern;
use super::taps::{Axis, LinearTaps};
use crate::num::lanes::{max_i32, min_i32};
use crate::surface::block::{BLOCK_HEIGHT, PixelBlock};

/// Eight pixels in 16-bit lanes: red and blue, green and alpha.
#[derive(Clone, Copy)]
struct Wide<S: Simd> {
    even: u16x16<S>,
    odd: u16x16<S>,
}

impl<S: Simd> Wide<S> {
    #[inline(always)]
    fn new(pixels: u32x8<S>) -> Self {
        let pixels: u16x16<S> = pixels.bitcast();
        Self { even: pixels & 255, odd: pixels >> 8 }
    }

    /// (self·weight + other·other_weight) / 256, rounded; the weights add up to 256 at most.
    #[inline(always)]
    fn mix(self, weight: u16x16<S>, other: Self, other_weight: u16x16<S>) -> Self {
        Self {
            even: (self.even * weight + other.even * other_weight + 128) >> 8,
            odd: (self.odd * weight + other.odd * other_weight + 128) >> 8,
        }
    }

    #[inline(always)]
    fn pack(self) -> [u8; 32] {
        (self.even | (self.odd << 8)).to_bytes().to_array()
    }
}

/// A weight in both 16-bit halves of each lane.
#[inline(always)]
fn doubled<S: Simd>(weight: i32x8<S>) -> u16x16<S> {
    (weight | (weight << 16)).bitcast()
}

/// What eight samples read from a row.
#[derive(Clone, Copy)]
struct RowTaps<S: Simd> {
    /// The left one of two neighbouring pixels, or just the first pixel.
    first: i32x8<S>,
    /// The second pixel, where the two are not neighbours.
    second: i32x8<S>,
    weight: [u16x16<S>; 2],
    /// Whether all eight can be read as neighbours: always, but at the seam of a repeated image.
    neighbours: bool,
}

impl<S: Simd> RowTaps<S> {
    /// The taps at coordinates `v`. Not inlined: code size.
    #[inline(never)]
    fn new(simd: S, v: f32x8<S>, axis: &Axis) -> Self {
        simd.vectorize(
            #[inline(always)]
            || Self::compute(simd, v, axis),
        )
    }

    #[inline(always)]
    fn compute(simd: S, v: f32x8<S>, axis: &Axis) -> Self {
        let LinearTaps { index: [i0, i1], weight: [w0, w1] } = LinearTaps::new(simd, v, axis);
        let none = i32x8::splat(simd, 0);
        // At a padded edge both taps are one pixel, in a mirrored image they are in reverse order: all that
        // is one load of two neighbours, with the weights going to whichever of them is meant.
        let left = max_i32(min_i32(min_i32(i0, i1), i32x8::splat(simd, axis.size as i32 - 2)), none);
        let right = left + 1;
        let neighbours = axis.size >= 2.0 && !(i0.simd_gt(right) | i1.simd_gt(right)).any_true();
        if neighbours {
            let to = |index: i32x8<S>| i0.simd_eq(index).select(w0, none) + i1.simd_eq(index).select(w1, none);
            let weight = [doubled(to(left)), doubled(to(right))];
            Self { first: left, second: right, weight, neighbours }
        } else {
            Self { first: i0, second: i1, weight: [doubled(w0), doubled(w1)], neighbours }
        }
    }

    /// The mixed pixels of one row, whose pixels begin at `start[lane]` of `pixels`.
    #[inline(always)]
    fn mix(&self, simd: S, pixels: &[[u8; 4]], start: i32x8<S>) -> Wide<S> {
        let (first, second) = if self.neighbours {
            let at: u32x8<S> = (self.first + start).bitcast();
            let at = at.to_array();
            let low = [pair(pixels, at[0]), pair(pixels, at[1]), pair(pixels, at[2]), pair(pixels, at[3])];
            let high = [pair(pixels, at[4]), pair(pixels, at[5]), pair(pixels, at[6]), pair(pixels, at[7])];
            let low: u32x8<S> = u64x4::simd_from(simd, low).bitcast();
            let high: u32x8<S> = u64x4::simd_from(simd, high).bitcast();
            (low.unzip_low(high), low.unzip_high(high))
        } else {
            (gather(simd, pixels, self.first + start), gather(simd, pixels, self.second + start))
        };
        Wide::new(first).mix(self.weight[0], Wide::new(second), self.weight[1])
    }
}

#[inline(always)]
fn one(pixels: &[[u8; 4]], index: u32) -> u32 {
    u32::from_ne_bytes(pixels.get(index as usize).copied().unwrap_or_default())
}

/// Two neighbouring pixels, the left one in the low half.
#[inline(always)]
fn pair(pixels: &[[u8; 4]], index: u32) -> u64 {
    let index = index as usize;
    let found = pixels.get(index..index.saturating_add(2)).map(<[[u8; 4]]>::as_flattened);
    u64::from_le_bytes(found.and_then(|bytes| bytes.first_chunk::<8>()).copied().unwrap_or_default())
}

/// Eight pixels by index.
#[inline(always)]
pub(super) fn gather<S: Simd>(simd: S, pixels: &[[u8; 4]], index: i32x8<S>) -> u32x8<S> {
    let i: u32x8<S> = index.bitcast();
    let i = i.to_array();
    let low = [one(pixels, i[0]), one(pixels, i[1]), one(pixels, i[2]), one(pixels, i[3])];
    let high = [one(pixels, i[4]), one(pixels, i[5]), one(pixels, i[6]), one(pixels, i[7])];
    u32x8::simd_from(simd, [low[0], low[1], low[2], low[3], high[0], high[1], high[2], high[3]])
}

/// The block at (x, y) where the image is scaled and moved only: each row of the image that the block needs
/// is mixed along x once and kept for the next row of the block.
#[inline(always)]
pub(super) fn fetch_aligned<S: Simd>(simd: S, pattern: &ImagePattern, x: i32, y: i32, out: &mut PixelBlock) {
    let (columns, rows) = pattern.aligned_points(simd, x, y);
    let taps = [RowTaps::new(simd, columns[0], &pattern.axes[0]), RowTaps::new(simd, columns[1], &pattern.axes[0])];
    let row_taps = LinearTaps::new(simd, rows, &pattern.axes[1]);
    let row_index = [row_taps.index[0].to_array(), row_taps.index[1].to_array()];
    let row_weight = [row_taps.weight[0].to_array(), row_taps.weight[1].to_array()];
    let empty = Wide { even: u16x16::splat(simd, 0), odd: u16x16::splat(simd, 0) };
    // The last two mixed rows, with their image rows; −1 where there is none yet.
    let mut kept = [(-1, [empty; 2]); 2];
    for row in 0..BLOCK_HEIGHT {
        let needed = [row_index[0][row], row_index[1][row]];
        let mut slots = [0; 2];
        for k in 0..2 {
            slots[k] = if kept[0].0 == needed[k] {
                0
            } else if kept[1].0 == needed[k] {
                1
            } else {
                // The row that the other tap wants stays.
                let slot = usize::from(kept[0].0 == needed[1 - k]);
                let pixels = pattern.row(needed[k]);
                let start = i32x8::splat(simd, 0);
                kept[slot].0 = needed[k];
                for (mixed, taps) in kept[slot].1.iter_mut().zip(&taps) {
                    *mixed = taps.mix(simd, pixels, start);
                }
                slot
            };
        }
        let [upper, lower] = [kept[slots[0] & 1].1, kept[slots[1] & 1].1];
        let upper_weight = u16x16::splat(simd, row_weight[0][row] as u16);
        let lower_weight = u16x16::splat(simd, row_weight[1][row] as u16);
        let halves = out[row].as_chunks_mut::<32>().0;
        for (half, target) in halves.iter_mut().enumerate().take(2) {
            *target = upper[half & 1].mix(upper_weight, lower[half & 1], lower_weight).pack();
        }
    }
}

/// The block at (x, y) under any map.
#[inline(always)]
pub(super) fn fetch<S: Simd>(simd: S, pattern: &ImagePattern, x: i32, y: i32, out: &mut PixelBlock) {
    let pixels = pattern.pixels();
    let width = pattern.axes[0].size as i32;
    let groups = out.as_flattened_mut().as_chunks_mut::<32>().0;
    for (group, point) in groups.iter_mut().zip(pattern.points(simd, x, y)) {
        let taps = RowTaps::new(simd, f32x8::simd_from(simd, point[0]), &pattern.axes[0]);
        let rows = LinearTaps::new(simd, f32x8::simd_from(simd, point[1]), &pattern.axes[1]);
        let upper = taps.mix(simd, pixels, rows.index[0] * width);
        let lower = taps.mix(simd, pixels, rows.index[1] * width);
        *group = upper.mix(doubled(rows.weight[0]), lower, doubled(rows.weight[1])).pack();
    }
}
