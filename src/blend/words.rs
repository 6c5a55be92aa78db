//! Eight pixels at a time, or sixteen, in sixteen-bit lanes.
//!
//! A vector of 32 bytes is eight RGBA pixels, one of 64 a row of a block. Its even bytes (red, blue) and odd bytes (green, alpha)
//! become one vector of 16-bit lanes each by a mask and a shift: nothing moves between lanes, and
//! products of two components fit.

use fearless_simd::prelude::*;
use fearless_simd::{u8x32, u8x64, u16x16, u16x32};

use crate::num::lanes::{doubled_words, high_product, high_row_product};
use crate::surface::block::{MaskBlock, PixelBlock};

/// Eight RGBA pixels: component k of pixel i is in lane 2i + ⌊k / 2⌋ of `even` or `odd`.
#[derive(Clone, Copy)]
pub(super) struct Words<S: Simd> {
    /// Red and blue.
    pub(super) even: u16x16<S>,
    /// Green and alpha.
    pub(super) odd: u16x16<S>,
}

impl<S: Simd> Words<S> {
    #[inline(always)]
    pub(super) fn from_bytes(bytes: u8x32<S>) -> Self {
        let words: u16x16<S> = bytes.bitcast();
        Self { even: words & 255, odd: words >> 8 }
    }

    /// The bytes again; every lane must be below 256.
    #[inline(always)]
    pub(super) fn to_bytes(self) -> u8x32<S> {
        (self.even | (self.odd << 8)).bitcast()
    }

    /// Every lane times `by`, with the 128 that [`quotient_255`] rounds by.
    #[inline(always)]
    pub(super) fn times(self, by: u16x16<S>) -> Self {
        Self { even: self.even * by + 128, odd: self.odd * by + 128 }
    }

    /// Each pixel's alpha in both of its lanes.
    #[inline(always)]
    pub(super) fn alpha(self) -> u16x16<S> {
        duplicate_odd(self.odd)
    }
}

/// [`Words`] of 16 pixels: one instruction for each where vectors have 512 bits.
#[derive(Clone, Copy)]
pub(super) struct RowWords<S: Simd> {
    pub(super) even: u16x32<S>,
    pub(super) odd: u16x32<S>,
}

impl<S: Simd> RowWords<S> {
    #[inline(always)]
    pub(super) fn from_bytes(bytes: u8x64<S>) -> Self {
        let words: u16x32<S> = bytes.bitcast();
        Self { even: words & 255, odd: words >> 8 }
    }

    /// The bytes again; every lane must be below 256.
    #[inline(always)]
    pub(super) fn to_bytes(self) -> u8x64<S> {
        (self.even | (self.odd << 8)).bitcast()
    }

    /// Every lane times `by`, with the 128 that [`quotient_255`] rounds by.
    #[inline(always)]
    pub(super) fn times(self, by: u16x32<S>) -> Self {
        Self { even: self.even * by + 128, odd: self.odd * by + 128 }
    }

    /// [`quotient_255`] of every lane.
    #[inline(always)]
    pub(super) fn quotients_255(self) -> Self {
        Self { even: row_quotient_255(self.even), odd: row_quotient_255(self.odd) }
    }

    /// Each pixel's alpha in both of its lanes.
    #[inline(always)]
    pub(super) fn alpha(self) -> u16x32<S> {
        let odd = self.odd.unzip_high(self.odd);
        odd.zip_low(odd)
    }
}

/// [`quotient_255`] of a row.
#[inline(always)]
pub(super) fn row_quotient_255<S: Simd>(v: u16x32<S>) -> u16x32<S> {
    high_row_product(v, 257)
}

/// The odd lanes of `v`, each twice. The compiler joins the two moves into one shuffle (two at SSE2).
#[inline(always)]
pub(super) fn duplicate_odd<S: Simd>(v: u16x16<S>) -> u16x16<S> {
    let odd = v.unzip_high(v);
    odd.zip_low(odd)
}

/// ⌊v · 257 / 2^16⌋ per lane: with v = n + 128 it is n / 255 rounded to nearest, for n in 0 ..= 65,407.
#[inline(always)]
pub(super) fn quotient_255<S: Simd>(v: u16x16<S>) -> u16x16<S> {
    high_product(v, 257)
}

/// v / 255 rounded to nearest, for v in 0 ..= 65,407.
#[inline(always)]
pub(super) fn div255<S: Simd>(v: u16x16<S>) -> u16x16<S> {
    quotient_255(v + 128)
}

/// (from · (255 − mask) + to · mask) / 255, rounded once. Mask 0 gives `from`, 255 gives `to`.
#[inline(always)]
pub(super) fn mix<S: Simd>(from: Words<S>, to: Words<S>, mask: u16x16<S>) -> Words<S> {
    let rest = mask ^ 255;
    Words { even: div255(from.even * rest + to.even * mask), odd: div255(from.odd * rest + to.odd * mask) }
}

/// The smaller byte.
#[inline(always)]
#[expect(clippy::disallowed_methods, reason = "integer minimum is the same at every level")]
pub(super) fn min_u8<S: Simd>(a: u8x32<S>, b: u8x32<S>) -> u8x32<S> {
    a.min(b)
}

/// The pixels with components above their alpha lowered to it, as words, and the alpha by lane.
#[inline(always)]
pub(super) fn clamped<S: Simd>(bytes: u8x32<S>) -> (Words<S>, u16x16<S>) {
    let alpha = Words::from_bytes(bytes).alpha();
    let limit: u8x32<S> = (alpha | (alpha << 8)).bitcast();
    (Words::from_bytes(min_u8(bytes, limit)), alpha)
}

/// Replaces every pixel of `dst` by a mix, by `mask`, of itself and `blend(dst, src)`, eight pixels at a time.
///
/// Not inlined, so that every mode is a function of its own: there are many, and their callers should not
/// carry them. `blend` must be a closure marked `#[inline(always)]`.
#[inline(never)]
pub(super) fn mix_block<S: Simd>(
    simd: S,
    dst: &mut PixelBlock,
    src: &PixelBlock,
    mask: &MaskBlock,
    blend: impl Fn(u8x32<S>, u8x32<S>) -> Words<S>,
) {
    simd.vectorize(
        #[inline(always)]
        || {
            for ((dst, src), mask) in dst.iter_mut().zip(src).zip(mask) {
                let masks = doubled_words(simd, mask);
                let halves = dst.as_chunks_mut::<32>().0.iter_mut().zip(src.as_chunks::<32>().0);
                for ((dst, src), mask) in halves.zip(masks) {
                    let below = u8x32::load_array_ref(simd, dst);
                    let blended = blend(below, u8x32::load_array_ref(simd, src));
                    mix(Words::from_bytes(below), blended, mask).to_bytes().store_array(dst);
                }
            }
        },
    );
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::level::{SimdLevel, dispatch};

    #[test]
    fn div255_rounds_to_nearest_over_its_range() {
        for level in SimdLevel::available() {
            dispatch!(level, simd => {
                for n in 0..=65_407_u16 {
                    let lanes = div255(u16x16::splat(simd, n)).to_array();
                    assert_eq!(lanes, [((u32::from(n) * 2 + 255) / 510) as u16; 16], "{n} at {level:?}");
                }
            });
        }
    }

    #[test]
    fn words_keep_every_byte_in_its_place() {
        let bytes: [u8; 32] = std::array::from_fn(|i| 3 + 7 * i as u8);
        let mask: [u8; 16] = std::array::from_fn(|i| 255 - 13 * i as u8);
        for level in SimdLevel::available() {
            dispatch!(level, simd => {
                let words = Words::from_bytes(u8x32::load_array_ref(simd, &bytes));
                assert_eq!(words.to_bytes().to_array(), bytes, "{level:?}");
                let alpha = words.alpha().to_array();
                let masks = doubled_words(simd, &mask).map(|half| half.to_array());
                for pixel in 0..8 {
                    let expected = u16::from(bytes[4 * pixel + 3]);
                    assert_eq!(alpha[2 * pixel..2 * pixel + 2], [expected; 2], "{level:?}");
                    for (half, lanes) in masks.iter().enumerate() {
                        let expected = u16::from(mask[8 * half + pixel]);
                        assert_eq!(lanes[2 * pixel..2 * pixel + 2], [expected; 2], "{level:?}");
                    }
                }
            });
        }
    }

    #[test]
    fn colour_above_alpha_is_lowered_to_it() {
        let bytes: [u8; 32] = std::array::from_fn(|i| [200, 90, 100, 100][i % 4]);
        for level in SimdLevel::available() {
            dispatch!(level, simd => {
                let (words, alpha) = clamped(u8x32::load_array_ref(simd, &bytes));
                let expected: [u8; 32] = std::array::from_fn(|i| [100, 90, 100, 100][i % 4]);
                assert_eq!(words.to_bytes().to_array(), expected, "{level:?}");
                assert_eq!(alpha.to_array(), [100; 16], "{level:?}");
            });
        }
    }
}
