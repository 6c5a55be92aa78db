//! Images as paint: preparation, and the nearest pixel.

use std::sync::Arc;

use fearless_simd::prelude::*;
use fearless_simd::{f32x8, u16x16, u32x8};

use super::plane::{Affine, Plane};
use super::shader::{FilterQuality, Pattern, SpreadMode};
use super::taps::Axis;
use super::{bicubic, bilinear};
use crate::num::lanes::div255_u16;
use crate::surface::Pixmap;
use crate::surface::block::{BLOCK_HEIGHT, PixelBlock};

/// An image ready to be fetched.
#[derive(Debug)]
pub(crate) struct ImagePattern {
    image: Arc<Pixmap>,
    /// Device pixels to image pixels.
    pub(super) plane: Plane,
    pub(super) axes: [Axis; 2],
    quality: FilterQuality,
    opacity: u8,
    opaque: bool,
}

/// Images of more pixels than this are not looked through for transparent ones: a drawing call that
/// shows a corner of a large map would pay for all of it.
const MOST_PIXELS_SCANNED: usize = 1 << 20;

impl ImagePattern {
    /// The pattern under `to_device` (image to device space), or `None` if that is singular.
    pub(super) fn new(pattern: &Pattern, to_device: Affine, opacity: f32) -> Option<Self> {
        let to_image = to_device.invert()?;
        let (width, height) = (pattern.image.width(), pattern.image.height());
        let middle = [f64::from(width) * 0.5, f64::from(height) * 0.5];
        let decal = [pattern.spread_x, pattern.spread_y].contains(&SpreadMode::Decal);
        let opacity = (opacity * 255.0 + 0.5) as u8;
        let scan = !decal && opacity == 255 && pattern.image.data().len() / 4 <= MOST_PIXELS_SCANNED;
        Some(Self {
            plane: Plane::new(to_image, to_device.map(middle)),
            axes: [Axis::new(width, pattern.spread_x), Axis::new(height, pattern.spread_y)],
            // Pixel on pixel there is nothing to interpolate, and a blur would be no service.
            quality: if is_whole_move(to_image) { FilterQuality::Nearest } else { pattern.quality },
            opacity,
            opaque: scan && is_image_opaque(pattern.image.data()),
            image: Arc::clone(&pattern.image),
        })
    }

    /// Whether every pixel it gives is opaque; false too for large images that are.
    pub(super) fn is_opaque(&self) -> bool {
        self.opaque
    }

    /// The pixels of the block at (x, y).
    #[inline(always)]
    pub(super) fn fetch<S: Simd>(&self, simd: S, x: i32, y: i32, out: &mut PixelBlock) {
        match (self.quality, self.plane.is_axis_aligned()) {
            (FilterQuality::Nearest, true) => nearest_aligned(simd, self, x, y, out),
            (FilterQuality::Nearest, false) => nearest(simd, self, x, y, out),
            (FilterQuality::Bilinear, true) => bilinear::fetch_aligned(simd, self, x, y, out),
            (FilterQuality::Bilinear, false) => bilinear::fetch(simd, self, x, y, out),
            (FilterQuality::Bicubic, true) => bicubic::fetch_aligned(simd, self, x, y, out),
            (FilterQuality::Bicubic, false) => bicubic::fetch(simd, self, x, y, out),
        }
        if self.opacity != 255 {
            fade(simd, self.opacity, out);
        }
    }

    /// The pixels of row `y` of the image; none outside.
    #[inline(always)]
    pub(super) fn row(&self, y: i32) -> &[[u8; 4]] {
        let width = self.image.width() as usize;
        let pixels = self.pixels();
        let start = y as usize * width;
        pixels.get(start..start + width).unwrap_or_default()
    }

    /// All pixels of the image.
    #[inline(always)]
    pub(super) fn pixels(&self) -> &[[u8; 4]] {
        self.image.data().as_chunks::<4>().0
    }

    /// The image coordinates of each group of eight pixels of the block, in order.
    #[inline(always)]
    pub(super) fn points<S: Simd>(&self, simd: S, x: i32, y: i32) -> [[[f32; 8]; 2]; 16] {
        let columns = [self.plane.columns(simd, 0, x), self.plane.columns(simd, 1, x)];
        let rows = [self.plane.rows(0, y), self.plane.rows(1, y)];
        let mut points = [[[0.0; 8]; 2]; 16];
        for (row, pair) in points.as_chunks_mut::<2>().0.iter_mut().enumerate() {
            for half in 0..2 {
                for axis in 0..2 {
                    pair[half][axis] = (columns[axis][half] + rows[axis][row & 7]).to_array();
                }
            }
        }
        points
    }

    /// The image columns' coordinates of the 16 pixels from `x` on, and the image rows' of the 8 from `y`
    /// on, where columns decide one and rows the other.
    #[inline(always)]
    pub(super) fn aligned_points<S: Simd>(&self, simd: S, x: i32, y: i32) -> ([f32x8<S>; 2], f32x8<S>) {
        // The row part of the first coordinate and the column part of the second are the same throughout.
        let [left, right] = self.plane.columns(simd, 0, x);
        let base = self.plane.rows(0, y)[0];
        ([left + base, right + base], f32x8::simd_from(simd, self.plane.rows(1, y)))
    }
}

/// Whether `to_image` moves by whole pixels and does nothing else, to within what a weight in 1/256 shows.
fn is_whole_move(to_image: Affine) -> bool {
    let Affine { a, b, c, d, e, f } = to_image;
    let rest = |v: f64| (v - v.round()).abs();
    let unit = (a - 1.0).abs() < 1e-7 && (d - 1.0).abs() < 1e-7 && b.abs() < 1e-7 && c.abs() < 1e-7;
    unit && rest(e) < 1.0 / 1024.0 && rest(f) < 1.0 / 1024.0
}

fn is_image_opaque(data: &[u8]) -> bool {
    // In chunks, so that the inner loop has no exit and the outer one ends at the first transparent part.
    data.chunks(4096).all(|chunk| {
        let all = chunk.as_chunks::<4>().0.iter().fold(u32::MAX, |all, pixel| all & u32::from_le_bytes(*pixel));
        all >> 24 == 255
    })
}

/// Multiplies every component by `opacity` / 255, rounded to nearest.
#[inline(always)]
fn fade<S: Simd>(simd: S, opacity: u8, out: &mut PixelBlock) {
    let scale = u16x16::splat(simd, u16::from(opacity));
    let low_bytes = u16x16::splat(simd, 255);
    for group in out.as_flattened_mut().as_chunks_mut::<32>().0 {
        let pixels: u16x16<S> = u32x8::from_bytes(fearless_simd::u8x32::simd_from(simd, *group)).bitcast();
        let even = div255_u16((pixels & low_bytes) * scale);
        let odd = div255_u16((pixels >> 8) * scale);
        *group = (even | (odd << 8)).to_bytes().to_array();
    }
}

/// The nearest pixels where the image is scaled and moved only.
#[inline(always)]
fn nearest_aligned<S: Simd>(simd: S, pattern: &ImagePattern, x: i32, y: i32, out: &mut PixelBlock) {
    let (columns, rows) = pattern.aligned_points(simd, x, y);
    let mut index = [0; 16];
    let mut shown = [0_u32; 16];
    for half in 0..2 {
        let (i, inside) = pattern.axes[0].nearest(simd, columns[half]);
        index[half * 8..half * 8 + 8].copy_from_slice(i.as_slice());
        let mask = inside.select(u32x8::splat(simd, u32::MAX), u32x8::splat(simd, 0));
        shown[half * 8..half * 8 + 8].copy_from_slice(mask.as_slice());
    }
    let (row_index, row_shown) = pattern.axes[1].nearest(simd, rows);
    let row_index = row_index.to_array();
    let first = index[0];
    let consecutive = index.iter().enumerate().all(|(k, i)| *i == first + k as i32);
    let whole = shown.iter().all(|mask| *mask != 0);
    for row in 0..BLOCK_HEIGHT {
        let target = out[row].as_chunks_mut::<4>().0;
        if !row_shown.test(row) {
            target.fill([0; 4]);
            continue;
        }
        let source = pattern.row(row_index[row]);
        if consecutive && let Some(run) = source.get(first as usize..first as usize + target.len()) {
            target.copy_from_slice(run);
        } else {
            for (pixel, i) in target.iter_mut().zip(index) {
                *pixel = source.get(i as usize).copied().unwrap_or_default();
            }
        }
        if !whole {
            for (pixel, mask) in target.iter_mut().zip(shown) {
                *pixel = (u32::from_ne_bytes(*pixel) & mask).to_ne_bytes();
            }
        }
    }
}

/// The nearest pixels under any map.
#[inline(always)]
fn nearest<S: Simd>(simd: S, pattern: &ImagePattern, x: i32, y: i32, out: &mut PixelBlock) {
    let pixels = pattern.pixels();
    let width = pattern.axes[0].size as i32;
    let groups = out.as_flattened_mut().as_chunks_mut::<32>().0;
    for (group, point) in groups.iter_mut().zip(pattern.points(simd, x, y)) {
        let (column, column_shown) = pattern.axes[0].nearest(simd, f32x8::simd_from(simd, point[0]));
        let (row, row_shown) = pattern.axes[1].nearest(simd, f32x8::simd_from(simd, point[1]));
        let index = (row * width + column).to_array();
        let shown = (column_shown & row_shown).select(u32x8::splat(simd, u32::MAX), u32x8::splat(simd, 0));
        let mut found = [0; 8];
        for (pixel, i) in found.iter_mut().zip(index) {
            *pixel = u32::from_ne_bytes(pixels.get(i as usize).copied().unwrap_or_default());
        }
        *group = (u32x8::simd_from(simd, found) & shown).to_bytes().to_array();
    }
}
