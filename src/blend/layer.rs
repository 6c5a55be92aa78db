//! Masks and whole layers scaled by masks and opacities.

use fearless_simd::prelude::*;
use fearless_simd::{u8x16, u8x64, u16x8, u16x16};

use super::words::{RowWords, div255};
use crate::num::lanes::doubled_row;
use crate::surface::block::{MaskBlock, PixelBlock};

/// mask ← mask·by / 255, rounded to nearest: one coverage inside another.
#[inline(always)]
pub(crate) fn scale_mask_row<S: Simd>(simd: S, mask: &mut [u8; 16], by: &[u8; 16]) {
    let product = split_bytes(simd, mask) * split_bytes(simd, by);
    join_bytes(div255(product)).store_array(mask);
}

/// mask ← mask·opacity / 255, rounded to nearest.
#[inline(always)]
pub(crate) fn scale_mask_row_by<S: Simd>(simd: S, mask: &mut [u8; 16], opacity: u8) {
    let product = split_bytes(simd, mask) * u16x16::splat(simd, u16::from(opacity));
    join_bytes(div255(product)).store_array(mask);
}

/// Every component of every pixel times its mask / 255, rounded to nearest.
#[inline(always)]
pub(crate) fn multiply_block_by_mask<S: Simd>(simd: S, pixels: &mut PixelBlock, mask: &MaskBlock) {
    for (row, mask) in pixels.iter_mut().zip(mask) {
        multiply_row_by_mask(simd, row, mask);
    }
}

/// [`multiply_block_by_mask`] for one row.
#[inline(always)]
pub(crate) fn multiply_row_by_mask<S: Simd>(simd: S, row: &mut [u8; 64], mask: &[u8; 16]) {
    let words = RowWords::from_bytes(u8x64::load_array_ref(simd, row)).times(doubled_row(simd, mask));
    words.quotients_255().to_bytes().store_array(row);
}

/// Sixteen bytes as words: the even ones, then the odd ones.
#[inline(always)]
fn split_bytes<S: Simd>(simd: S, bytes: &[u8; 16]) -> u16x16<S> {
    let words: u16x8<S> = u8x16::load_array_ref(simd, bytes).bitcast();
    (words & 255).combine(words >> 8)
}

/// The inverse of [`split_bytes`].
#[inline(always)]
fn join_bytes<S: Simd>(words: u16x16<S>) -> u8x16<S> {
    let (even, odd) = words.split();
    (even | (odd << 8)).bitcast()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::lanes;
    use crate::num::level::{SimdLevel, dispatch};

    #[test]
    fn products_of_all_pairs_are_rounded_to_nearest() {
        for level in SimdLevel::available() {
            dispatch!(level, simd => {
                for by in 0..=255_u8 {
                    for first in (0..=240_u8).step_by(16) {
                        let values: [u8; 16] = std::array::from_fn(|i| first + i as u8);
                        let expected = values.map(|v| lanes::div255(u32::from(v) * u32::from(by)) as u8);
                        let mut mask = values;
                        scale_mask_row_by(simd, &mut mask, by);
                        assert_eq!(mask, expected, "by {by} at {level:?}");
                        mask = [by; 16];
                        scale_mask_row(simd, &mut mask, &values);
                        assert_eq!(mask, expected, "{values:?} by {by} at {level:?}");
                    }
                }
            });
        }
    }

    #[test]
    fn a_layer_is_multiplied_by_its_mask_pixel_by_pixel() {
        let pixels: PixelBlock = std::array::from_fn(|y| std::array::from_fn(|i| (y * 71 + i * 37) as u8));
        let mask: MaskBlock = std::array::from_fn(|y| std::array::from_fn(|x| (y * 16 + x) as u8 * 2));
        for level in SimdLevel::available() {
            let mut out = pixels;
            dispatch!(level, simd => multiply_block_by_mask(simd, &mut out, &mask));
            for (y, (row, before)) in out.iter().zip(&pixels).enumerate() {
                for (i, (v, before)) in row.iter().zip(before).enumerate() {
                    let expected = lanes::div255(u32::from(*before) * u32::from(mask[y][i / 4]));
                    assert_eq!(u32::from(*v), expected, "row {y}, byte {i} at {level:?}");
                }
            }
        }
    }
}
