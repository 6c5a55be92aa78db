//! Source over destination, the hot path of nearly every picture, in rows of 16 pixels.
//!
//! With s, a a source component and its alpha, d a destination component and m the mask:
//!
//! > a′ = ⌊a·m / 255 + ½⌋,  d ← ⌊(s·m + d·(255 − a′)) / 255 + ½⌋
//!
//! One rounding of the sum instead of one of each term: at most 1 off the exact value instead of 1½,
//! and a fifth less work. Mask 0 leaves d; mask 255 gives s + ⌊d·(255 − a) / 255 + ½⌋; a component that
//! is at most its alpha in source and destination stays so; an opaque source makes it a plain mix.
//!
//! Measured in cache on one 2.8 GHz core, in Gpx/s at AVX2 | SSE2: opaque 4.5 | 2.1; translucent 3.7 | 1.8;
//! pixels 2.6 | 1.3; full mask 6.0 | 2.7. With a rounding a term and shifts for the division, translucent
//! had 2.0 | 1.1.

use fearless_simd::prelude::*;
use fearless_simd::{u8x32, u16x16, u32x8};

use super::words::{Words, duplicate_odd, min_u8, mix, quotient_255};
use crate::num::lanes::doubled_words;

/// `color` (premultiplied) over 16 pixels by `mask`. Components above the colour's alpha are lowered to it.
#[inline(always)]
pub(crate) fn over_solid_row<S: Simd>(simd: S, row: &mut [u8; 64], color: [u8; 4], mask: &[u8; 16]) {
    let source = solid(simd, color);
    let alpha = u16x16::splat(simd, u16::from(color[3]));
    let masks = doubled_words(simd, mask);
    over_halves(
        simd,
        row,
        masks,
        #[inline(always)]
        |_, below, mask| {
            // 255 − ⌊v / 255 + ½⌋ = ⌊(255² − v) / 255 + ½⌋, since 255 is odd and nothing lies halfway.
            let rest = quotient_255(u16x16::splat(simd, 255 * 255 + 128) - alpha * mask);
            Words {
                even: quotient_255(source.even * mask + below.even * rest + 128),
                odd: quotient_255(source.odd * mask + below.odd * rest + 128),
            }
            .to_bytes()
        },
    );
}

/// [`over_solid_row`] for an opaque colour, faster: the alpha of `color` is taken to be 255.
#[inline(always)]
pub(crate) fn over_opaque_row<S: Simd>(simd: S, row: &mut [u8; 64], color: [u8; 4], mask: &[u8; 16]) {
    OpaqueRow::new(simd, color, mask).over(simd, row);
}

/// An opaque colour by a mask, made ready once for rows that share both.
#[derive(Clone, Copy)]
pub(crate) struct OpaqueRow<S: Simd> {
    /// Of each half of the row, what the colour adds, with the half that rounds.
    added: [Words<S>; 2],
    /// How much of what is below stays.
    rest: [u16x16<S>; 2],
}

impl<S: Simd> OpaqueRow<S> {
    /// The alpha of `color` is taken to be 255.
    #[inline(always)]
    pub(crate) fn new(simd: S, [r, g, b, _]: [u8; 4], mask: &[u8; 16]) -> Self {
        let source = solid(simd, [r, g, b, 255]);
        let [low, high] = doubled_words(simd, mask);
        let (low_added, high_added) = (source.times(low), source.times(high));
        Self { added: [low_added, high_added], rest: [low ^ 255, high ^ 255] }
    }

    /// Puts it over 16 pixels.
    #[inline(always)]
    pub(crate) fn over(&self, simd: S, row: &mut [u8; 64]) {
        let [low, high] = self.added;
        over_halves(
            simd,
            row,
            self.rest,
            #[inline(always)]
            |half, below, rest| {
                let added = if half == 0 { low } else { high };
                Words {
                    even: quotient_255(below.even * rest + added.even),
                    odd: quotient_255(below.odd * rest + added.odd),
                }
                .to_bytes()
            },
        );
    }
}

/// [`over_solid_row`] with mask 255 throughout. For an opaque colour this is a fill: write it instead.
#[inline(always)]
pub(crate) fn over_solid_full<S: Simd>(simd: S, row: &mut [u8; 64], color: [u8; 4]) {
    let source = solid(simd, color).to_bytes();
    let rest = u16x16::splat(simd, u16::from(255 - color[3]));
    over_halves(
        simd,
        row,
        [rest; 2],
        #[inline(always)]
        |_, below, rest| {
            // No component exceeds its alpha, so the sum stays below 256.
            source + scale(below, rest).to_bytes()
        },
    );
}

/// One colour, made ready to be put over runs of eight pixels by their coverage: to the same bytes as [`over_solid_row`].
#[derive(Clone, Copy)]
pub(crate) struct SolidRun<S: Simd> {
    source: Words<S>,
    alpha: u16x16<S>,
}

impl<S: Simd> SolidRun<S> {
    #[inline(always)]
    pub(crate) fn new(simd: S, color: [u8; 4]) -> Self {
        Self { source: solid(simd, color), alpha: u16x16::splat(simd, u16::from(color[3])) }
    }

    /// Puts it over eight pixels; `coverage` is in both lanes of its pixel. `OPAQUE` says that the colour is.
    #[inline(always)]
    pub(crate) fn over<const OPAQUE: bool>(&self, simd: S, pixels: &mut [u8; 32], coverage: u16x16<S>) {
        let below = Words::from_bytes(u8x32::load_array_ref(simd, pixels));
        let added = self.source.times(coverage);
        let rest = if OPAQUE {
            coverage ^ 255
        } else {
            quotient_255(u16x16::splat(simd, 255 * 255 + 128) - self.alpha * coverage)
        };
        let words = Words {
            even: quotient_255(below.even * rest + added.even),
            odd: quotient_255(below.odd * rest + added.odd),
        };
        words.to_bytes().store_array(pixels);
    }
}

/// 16 premultiplied pixels over 16 others by `mask`. Where a source component exceeds its alpha, the
/// sum saturates at 255.
#[inline(always)]
pub(crate) fn over_pixels_row<S: Simd>(simd: S, dst: &mut [u8; 64], src: &[u8; 64], mask: &[u8; 16]) {
    let src = src.as_chunks::<32>().0;
    let masks = doubled_words(simd, mask);
    over_halves(
        simd,
        dst,
        masks,
        #[inline(always)]
        |half, below, mask| {
            let Some(src) = src.get(half) else { return below.to_bytes() };
            let source = Words::from_bytes(u8x32::load_array_ref(simd, src));
            let (even, odd) = (source.even * mask, source.odd * mask);
            let rest = duplicate_odd(quotient_255(odd + 128)) ^ 255;
            // Raised by 255, the largest sum that divides to 255 is the largest that a lane holds.
            Words {
                even: quotient_255(even.saturating_add(below.even * rest + (128 + 255)) - 255),
                odd: quotient_255(odd.saturating_add(below.odd * rest + (128 + 255)) - 255),
            }
            .to_bytes()
        },
    );
}

/// [`over_pixels_row`] with mask 255 throughout.
#[inline(always)]
pub(crate) fn over_pixels_full<S: Simd>(simd: S, dst: &mut [u8; 64], src: &[u8; 64]) {
    let src = src.as_chunks::<32>().0;
    let unused = [u16x16::splat(simd, 255); 2];
    over_halves(
        simd,
        dst,
        unused,
        #[inline(always)]
        |half, below, _| {
            let Some(src) = src.get(half) else { return below.to_bytes() };
            let source = u8x32::load_array_ref(simd, src);
            let rest = Words::from_bytes(source).alpha() ^ 255;
            source.saturating_add(scale(below, rest).to_bytes())
        },
    );
}

/// 16 pixels mixed into 16 others by `mask`, rounded once: `BlendMode::Source`; also
/// [`over_pixels_row`], faster and to the same bytes, where every source pixel is opaque.
#[inline(always)]
pub(crate) fn mix_pixels_row<S: Simd>(simd: S, dst: &mut [u8; 64], src: &[u8; 64], mask: &[u8; 16]) {
    let src = src.as_chunks::<32>().0;
    let masks = doubled_words(simd, mask);
    over_halves(
        simd,
        dst,
        masks,
        #[inline(always)]
        |half, below, mask| {
            let Some(src) = src.get(half) else { return below.to_bytes() };
            mix(below, Words::from_bytes(u8x32::load_array_ref(simd, src)), mask).to_bytes()
        },
    );
}

/// Replaces both halves of a row by `blend(half, pixels, mask)`. A loop, which AVX2 code unrolls, and which
/// keeps the scalar level's functions at a size that compilers still get through.
#[inline(always)]
fn over_halves<S: Simd>(
    simd: S,
    row: &mut [u8; 64],
    masks: [u16x16<S>; 2],
    blend: impl Fn(usize, Words<S>, u16x16<S>) -> u8x32<S>,
) {
    for (half, (pixels, mask)) in row.as_chunks_mut::<32>().0.iter_mut().zip(masks).enumerate() {
        blend(half, Words::from_bytes(u8x32::load_array_ref(simd, pixels)), mask).store_array(pixels);
    }
}

/// Eight times the colour, components above its alpha lowered to it.
#[inline(always)]
fn solid<S: Simd>(simd: S, color: [u8; 4]) -> Words<S> {
    let alpha = u8x32::splat(simd, color[3]);
    Words::from_bytes(min_u8(u32x8::splat(simd, u32::from_le_bytes(color)).bitcast(), alpha))
}

/// Every component times `by` / 255, rounded.
#[inline(always)]
pub(super) fn scale<S: Simd>(pixels: Words<S>, by: u16x16<S>) -> Words<S> {
    Words { even: quotient_255(pixels.even * by + 128), odd: quotient_255(pixels.odd * by + 128) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::level::{SimdLevel, dispatch};

    /// ⌊n / 255 + ½⌋
    fn round(n: u32) -> u32 {
        (2 * n + 255) / 510
    }

    /// The module's formula in plain integers.
    fn over(d: [u8; 4], s: [u8; 4], mask: u8) -> [u8; 4] {
        let (m, rest) = (u32::from(mask), 255 - round(u32::from(s[3]) * u32::from(mask)));
        std::array::from_fn(|i| round(u32::from(s[i]) * m + u32::from(d[i]) * rest).min(255) as u8)
    }

    fn row_of(pixel: impl Fn(usize) -> [u8; 4]) -> [u8; 64] {
        std::array::from_fn(|i| pixel(i / 4)[i % 4])
    }

    #[test]
    fn by_hand() {
        // Red of alpha 128 at half coverage (128) on opaque white: a′ = 64, 255 − a′ = 191;
        // red 128·128 + 255·191 = 65089 → 255, green 0 + 255·191 → 191, alpha as red.
        let mut row = [255; 64];
        dispatch!(SimdLevel::best(), simd => over_solid_row(simd, &mut row, [128, 0, 0, 128], &[128; 16]));
        assert_eq!(row, row_of(|_| [255, 191, 191, 255]));
    }

    #[test]
    fn a_solid_colour_is_the_formula_for_every_mask_and_destination() {
        let colors = [[0, 0, 0, 0], [255; 4], [0, 0, 0, 255], [1, 0, 1, 1], [128, 0, 64, 128], [253, 7, 200, 254]];
        for level in SimdLevel::available() {
            dispatch!(level, simd => {
                for color in colors {
                    for (m, d) in (0..=255_u8).flat_map(|m| (0..=240_u8).step_by(16).map(move |d| (m, d))) {
                        let before = row_of(|i| [d + i as u8, 255 - d, d / 2 + i as u8, 255 - i as u8]);
                        let mask: [u8; 16] = std::array::from_fn(|i| m ^ (17 * (i as u8 & 3)));
                        let expected = |i: usize| {
                            let [r, g, b, a] = [0, 1, 2, 3].map(|k| before[4 * i + k]);
                            over([r, g, b, a], color, mask[i])
                        };
                        let mut row = before;
                        over_solid_row(simd, &mut row, color, &mask);
                        assert_eq!(row, row_of(expected), "{color:?} by {mask:?} at {level:?}");
                        if color[3] == 255 {
                            row = before;
                            over_opaque_row(simd, &mut row, color, &mask);
                            assert_eq!(row, row_of(expected), "opaque {color:?} by {mask:?} at {level:?}");
                        }
                        row = before;
                        over_pixels_row(simd, &mut row, &row_of(|_| color), &mask);
                        assert_eq!(row, row_of(expected), "pixels {color:?} by {mask:?} at {level:?}");
                    }
                }
            });
        }
    }

    #[test]
    fn full_rows_are_masked_rows_under_255() {
        for level in SimdLevel::available() {
            dispatch!(level, simd => {
                for a in 0..=255_u8 {
                    let color = [a, a / 2, a / 3, a];
                    let before = row_of(|i| [16 * i as u8, 255 - a, a, 255 - 16 * i as u8]);
                    let (mut full, mut masked) = (before, before);
                    over_solid_full(simd, &mut full, color);
                    over_solid_row(simd, &mut masked, color, &[255; 16]);
                    assert_eq!(full, masked, "{color:?} at {level:?}");
                    // Colour above alpha as well: both saturate.
                    let pixels = row_of(|i| [255 - 16 * i as u8, 16 * i as u8, a, a]);
                    (full, masked) = (before, before);
                    over_pixels_full(simd, &mut full, &pixels);
                    over_pixels_row(simd, &mut masked, &pixels, &[255; 16]);
                    assert_eq!(full, masked, "{pixels:?} at {level:?}");
                }
            });
        }
    }

    #[test]
    fn colour_above_alpha_never_wraps() {
        for level in SimdLevel::available() {
            dispatch!(level, simd => {
                let mut row = [255; 64];
                over_solid_row(simd, &mut row, [255, 255, 255, 0], &[255; 16]);
                assert_eq!(row, [255; 64], "a solid colour is lowered to its alpha, at {level:?}");
                row = [200; 64];
                over_pixels_row(simd, &mut row, &row_of(|_| [255, 100, 55, 0]), &[255; 16]);
                assert_eq!(row, row_of(|_| [255, 255, 255, 200]), "pixels saturate, at {level:?}");
            });
        }
    }

    #[test]
    fn mixing_is_source_over_of_opaque_pixels() {
        let source = row_of(|i| [17 * i as u8, 255 - i as u8, 3, 255]);
        for level in SimdLevel::available() {
            dispatch!(level, simd => {
                for m in 0..=255_u8 {
                    let mask: [u8; 16] = std::array::from_fn(|i| m.wrapping_add(15 * i as u8));
                    let before = row_of(|i| [m, i as u8, 0, 255 - m]);
                    let (mut mixed, mut over) = (before, before);
                    mix_pixels_row(simd, &mut mixed, &source, &mask);
                    over_pixels_row(simd, &mut over, &source, &mask);
                    assert_eq!(mixed, over, "{mask:?} at {level:?}");
                }
            });
        }
    }
}
