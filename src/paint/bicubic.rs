//! Images between their pixels, by the cubic filter over sixteen of them, in `f32`.

use fearless_simd::prelude::*;
use fearless_simd::{f32x8, i32x8, u32x8};

use super::bilinear::gather;
use super::pattern::ImagePattern;
use super::taps::CubicTaps;
use crate::num::lanes::{max_f32, min_f32, truncate_f32};
use crate::surface::block::PixelBlock;

/// Eight pixels' red, green, blue and alpha, 0 ..= 255 and beyond by what the filter overshoots.
type Channels<S> = [f32x8<S>; 4];

/// Four pixels of a row filtered for each of eight samples; a row's pixels begin at `start[lane]`. Not
/// inlined: code size.
#[inline(never)]
fn filter_row<S: Simd>(simd: S, pixels: &[[u8; 4]], taps: &CubicTaps<S>, start: i32x8<S>) -> Channels<S> {
    simd.vectorize(
        #[inline(always)]
        || filter(simd, pixels, taps, start),
    )
}

#[inline(always)]
fn filter<S: Simd>(simd: S, pixels: &[[u8; 4]], taps: &CubicTaps<S>, start: i32x8<S>) -> Channels<S> {
    let mut sum = [f32x8::splat(simd, 0.0); 4];
    for k in 0..4 {
        let texels = gather(simd, pixels, taps.index[k] + start);
        for (channel, sum) in sum.iter_mut().enumerate() {
            let component = (texels >> (8 * channel as u32)) & 255;
            *sum += component.to_float::<f32x8<S>>() * taps.weight[k];
        }
    }
    sum
}

/// Clamped to a valid premultiplied pixel (the filter has negative lobes) and rounded to nearest.
#[inline(always)]
fn pack<S: Simd>(simd: S, [r, g, b, a]: Channels<S>) -> [u8; 32] {
    let zero = f32x8::splat(simd, 0.0);
    let a = min_f32(max_f32(a, zero), f32x8::splat(simd, 255.0));
    let pixels: u32x8<S> = (component(simd, r, a)
        | (component(simd, g, a) << 8)
        | (component(simd, b, a) << 16)
        | (component(simd, a, a) << 24))
        .bitcast();
    pixels.to_bytes().to_array()
}

/// `v` clamped to 0 ..= `limit` and rounded.
#[inline(always)]
fn component<S: Simd>(simd: S, v: f32x8<S>, limit: f32x8<S>) -> i32x8<S> {
    truncate_f32(min_f32(max_f32(v, f32x8::splat(simd, 0.0)), limit) + 0.5)
}

/// The block at (x, y) where the image is scaled and moved only: rows of the image are filtered along x
/// once and kept while the block's next rows need them.
#[inline(always)]
pub(super) fn fetch_aligned<S: Simd>(simd: S, pattern: &ImagePattern, x: i32, y: i32, out: &mut PixelBlock) {
    let (columns, rows) = pattern.aligned_points(simd, x, y);
    let row_taps = CubicTaps::new(simd, rows, &pattern.axes[1]);
    let start = i32x8::splat(simd, 0);
    let zero = f32x8::splat(simd, 0.0);
    for (half, column) in columns.into_iter().enumerate() {
        let taps = CubicTaps::new(simd, column, &pattern.axes[0]);
        // Filtered rows by image row modulo 4; −1 where there is none yet.
        let mut kept = [(-1, [zero; 4]); 4];
        for (row, line) in out.iter_mut().enumerate() {
            let mut sum = [zero; 4];
            for k in 0..4 {
                let needed = row_taps.index[k].to_array()[row & 7];
                let weight = row_taps.weight[k].to_array()[row & 7];
                let slot = &mut kept[needed as usize & 3];
                if slot.0 != needed {
                    *slot = (needed, filter_row(simd, pattern.row(needed), &taps, start));
                }
                for (sum, value) in sum.iter_mut().zip(slot.1) {
                    *sum += value * weight;
                }
            }
            if let Some(target) = line.as_chunks_mut::<32>().0.get_mut(half) {
                *target = pack(simd, sum);
            }
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
        let taps = CubicTaps::new(simd, f32x8::simd_from(simd, point[0]), &pattern.axes[0]);
        let rows = CubicTaps::new(simd, f32x8::simd_from(simd, point[1]), &pattern.axes[1]);
        let mut sum = [f32x8::splat(simd, 0.0); 4];
        for k in 0..4 {
            let filtered = filter_row(simd, pixels, &taps, rows.index[k] * width);
            for (sum, value) in sum.iter_mut().zip(filtered) {
                *sum += value * rows.weight[k];
            }
        }
        *group = pack(simd, sum);
    }
}
