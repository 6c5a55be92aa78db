//! The pixels of a block of 16 × 8, from any paint.

use fearless_simd::prelude::*;

use super::prepare::PreparedPaint;
use crate::surface::block::PixelBlock;

/// Writes the premultiplied pixels of the block whose top left pixel is (x, y) in device space. Colours are
/// taken at pixel centres; each is a function of its own pixel, wherever the block begins.
#[inline(always)]
pub(crate) fn fetch_block<S: Simd>(simd: S, paint: &PreparedPaint, x: i32, y: i32, out: &mut PixelBlock) {
    match paint {
        PreparedPaint::Nothing => out.as_flattened_mut().fill(0),
        PreparedPaint::Solid(pixel) => out.as_flattened_mut().as_chunks_mut::<4>().0.fill(*pixel),
        PreparedPaint::Gradient(gradient) => simd.vectorize(
            #[inline(always)]
            || gradient.fetch(simd, x, y, out),
        ),
        PreparedPaint::Pattern(pattern) => simd.vectorize(
            #[inline(always)]
            || pattern.fetch(simd, x, y, out),
        ),
    }
}
