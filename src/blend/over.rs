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
//! Measured in cache on one 2.8 GHz core, in Gpx/s (AVX2, SSE2): opaque 4.7, 2.1; translucent 3.5, 1.9;
//! with a rounding a term and shifts for the division 2.0, 1.1.

use fearless_simd::prelude::*;
use fearless_simd::{u8x32, u16x16, u32x8};

use super::words::{Words, duplicate_odd, mask_words, mix, quotient_255};

/// `color` (premultiplied) over 16 pixels by `mask`. Components above the colour's alpha are lowered to it.
#[inline(always)]
pub(crate) fn over_solid_row<S: Simd>(simd: S, row: &mut [u8; 64], color: [u8; 4], mask: &[u8; 16]) {
    let source = solid(simd, color);
    let alpha = u16x16::splat(simd, u16::from(color[3]));
    let masks = mask_words(simd, mask);
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
pub(crate) fn over_opaque_row<S: Simd>(simd: S, row: &mut [u8; 64], [r, g, b, _]: [u8; 4], mask: &[u8; 16]) {
    let source = solid(simd, [r, g, b, 255]);
    let masks = mask_words(simd, mask);
    over_halves(
        simd,
        row,
        masks,
        #[inline(always)]
        |_, below, mask| mix(below, source, mask).to_bytes(),
    );
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

/// 16 premultiplied pixels over 16 others by `mask`. Where a source component exceeds its alpha, the
/// sum saturates at 255.
#[inline(always)]
pub(crate) fn over_pixels_row<S: Simd>(simd: S, dst: &mut [u8; 64], src: &[u8; 64], mask: &[u8; 16]) {
    let src = src.as_chunks::<32>().0;
    let masks = mask_words(simd, mask);
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
    let masks = mask_words(simd, mask);
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

/// Replaces both halves of a row by `blend(half, pixels, mask)`. Both are computed before either is
/// stored, so that their instructions can overlap.
#[inline(always)]
fn over_halves<S: Simd>(
    simd: S,
    row: &mut [u8; 64],
    [low_mask, high_mask]: [u16x16<S>; 2],
    blend: impl Fn(usize, Words<S>, u16x16<S>) -> u8x32<S>,
) {
    let [low, high] = row.as_chunks_mut::<32>().0 else { return };
    let low_out = blend(0, Words::from_bytes(u8x32::load_array_ref(simd, low)), low_mask);
    let high_out = blend(1, Words::from_bytes(u8x32::load_array_ref(simd, high)), high_mask);
    low_out.store_array(low);
    high_out.store_array(high);
}

/// Eight times the colour, components above its alpha lowered to it.
#[inline(always)]
fn solid<S: Simd>(simd: S, color: [u8; 4]) -> Words<S> {
    let color = color.map(|component| if component > color[3] { color[3] } else { component });
    Words::from_bytes(u32x8::splat(simd, u32::from_le_bytes(color)).bitcast())
}

/// Every component times `by` / 255, rounded.
#[inline(always)]
pub(super) fn scale<S: Simd>(pixels: Words<S>, by: u16x16<S>) -> Words<S> {
    Words { even: quotient_255(pixels.even * by + 128), odd: quotient_255(pixels.odd * by + 128) }
}
