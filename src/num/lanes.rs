//! Small pieces of lane arithmetic that every level rounds alike.

use fearless_simd::prelude::*;
use fearless_simd::{Level, f32x8, f32x16, f64x2, i32x4, i32x8, i32x16, u8x16, u8x64, u16x8, u16x16, u16x32};

/// An array of `f` of each index. `array::from_fn` and `array::map` are not always inlined, and vectors in them are then reckoned
/// without the caller's SIMD level: every operation becomes a call.
#[inline(always)]
pub(crate) fn each<S: Simd, const N: usize>(simd: S, f: impl Fn(usize) -> f32x8<S>) -> [f32x8<S>; N] {
    let mut out = [f32x8::splat(simd, 0.0); N];
    for (i, out) in out.iter_mut().enumerate() {
        *out = f(i);
    }
    out
}

/// ⌊v / 255 + ½⌋ for v in 0 ..= 255·255, per lane, exactly.
#[inline(always)]
pub(crate) fn div255_u16<S: Simd>(v: u16x16<S>) -> u16x16<S> {
    // (v + 128 + ((v + 128) >> 8)) >> 8 equals the rounded quotient on the whole range.
    let biased = v + 128;
    (biased + (biased >> 8)) >> 8
}

/// ⌊v / 255 + ½⌋ for v in 0 ..= 255·255, exactly.
#[inline(always)]
pub(crate) fn div255(v: u32) -> u32 {
    let biased = v + 128;
    (biased + (biased >> 8)) >> 8
}

/// The larger lane of two vectors without NaN. `a > b ? a : b` spelled out, since the native maximum
/// differs between instruction sets on NaN and on zeros of different sign.
#[inline(always)]
pub(crate) fn max_f32<S: Simd, V: SimdBase<S, Element = f32>>(a: V, b: V) -> V {
    a.simd_gt(b).select(a, b)
}

/// The smaller lane of two vectors without NaN; see [`max_f32`].
#[inline(always)]
pub(crate) fn min_f32<S: Simd, V: SimdBase<S, Element = f32>>(a: V, b: V) -> V {
    a.simd_lt(b).select(a, b)
}

/// The larger lane of two vectors without NaN; of two zeros, either: for values that end as integers, in which a zero's
/// sign is lost. One instruction, where [`max_f32`] takes two.
#[inline(always)]
#[expect(clippy::disallowed_methods, reason = "without NaN, levels differ in the sign of zero alone")]
pub(crate) fn greater_f32<S: Simd, V: SimdBase<S, Element = f32>>(a: V, b: V) -> V {
    a.max(b)
}

/// The smaller lane of two vectors; see [`greater_f32`].
#[inline(always)]
#[expect(clippy::disallowed_methods, reason = "without NaN, levels differ in the sign of zero alone")]
pub(crate) fn lesser_f32<S: Simd, V: SimdBase<S, Element = f32>>(a: V, b: V) -> V {
    a.min(b)
}

/// The larger lane of two integer vectors.
#[inline(always)]
#[expect(clippy::disallowed_methods, reason = "integer maximum is the same at every level")]
pub(crate) fn max_i32<S: Simd, V: SimdBase<S, Element = i32>>(a: V, b: V) -> V {
    a.max(b)
}

/// The smaller lane of two integer vectors.
#[inline(always)]
#[expect(clippy::disallowed_methods, reason = "integer minimum is the same at every level")]
pub(crate) fn min_i32<S: Simd, V: SimdBase<S, Element = i32>>(a: V, b: V) -> V {
    a.min(b)
}

/// [`least_of_each`] of vectors twice as long.
#[inline(always)]
#[expect(clippy::disallowed_methods, reason = "integer minimum is the same at every level")]
pub(crate) fn least_of_sixteen<S: Simd>([a, b, c, d]: [i32x16<S>; 4]) -> [i32; 4] {
    let ((a, e), (b, f), (c, g), (d, h)) = (a.split(), b.split(), c.split(), d.split());
    least_of_each([a.min(e), b.min(f), c.min(g), d.min(h)])
}

/// The least lane of each of four vectors.
#[inline(always)]
#[expect(clippy::disallowed_methods, reason = "integer minimum is the same at every level")]
pub(crate) fn least_of_each<S: Simd>([a, b, c, d]: [i32x8<S>; 4]) -> [i32; 4] {
    let ((a, e), (b, f), (c, g), (d, h)) = (a.split(), b.split(), c.split(), d.split());
    let (a, b, c, d) = (a.min(e), b.min(f), c.min(g), d.min(h));
    // Two lanes of each are left, then one.
    let (a_b, c_d) = (a.zip_low(b).min(a.zip_high(b)), c.zip_low(d).min(c.zip_high(d)));
    let (a_b, c_d): (f64x2<S>, f64x2<S>) = (a_b.bitcast(), c_d.bitcast());
    let (one, other): (i32x4<S>, i32x4<S>) = (a_b.zip_low(c_d).bitcast(), a_b.zip_high(c_d).bitcast());
    one.min(other).to_array()
}

/// Truncation toward zero of lanes that are known to lie within ±2^31.
#[inline(always)]
#[expect(clippy::disallowed_methods, reason = "in range, every level truncates alike")]
pub(crate) fn truncate_f32<S: Simd>(v: f32x8<S>) -> i32x8<S> {
    v.to_int()
}

/// [`truncate_f32`] of sixteen.
#[inline(always)]
#[expect(clippy::disallowed_methods, reason = "in range, every level truncates alike")]
pub(crate) fn truncate_sixteen_f32<S: Simd>(v: f32x16<S>) -> i32x16<S> {
    v.to_int()
}

/// The smaller lane of two vectors of words.
#[inline(always)]
#[expect(clippy::disallowed_methods, reason = "integer minimum is the same at every level")]
pub(crate) fn min_u16<S: Simd>(a: u16x16<S>, b: u16x16<S>) -> u16x16<S> {
    a.min(b)
}

/// ⌊v · factor / 2^16⌋ per lane.
///
/// There is no high half of a product in the portable vectors; but the widening product followed by
/// the odd lanes is what every x86 compiler backend folds to that one instruction. Against shifts and
/// adds this made source-over a third faster at AVX2 and SSE2.
#[inline(always)]
pub(crate) fn high_product<S: Simd>(v: u16x16<S>, factor: u16) -> u16x16<S> {
    let (low, high) = v.widening_mul(factor);
    let (low, high): (u16x16<S>, u16x16<S>) = (low.bitcast(), high.bitcast());
    low.unzip_high(high)
}

/// [`high_product`] of twice as many.
#[inline(always)]
pub(crate) fn high_row_product<S: Simd>(v: u16x32<S>, factor: u16) -> u16x32<S> {
    let (low, high) = v.widening_mul(factor);
    let (low, high): (u16x32<S>, u16x32<S>) = (low.bitcast(), high.bitcast());
    low.unzip_high(high)
}

/// Sixteen bytes as words, each twice: the coverage of a block's row, in both lanes of its pixel.
#[inline(always)]
pub(crate) fn doubled_row<S: Simd>(simd: S, bytes: &[u8; 16]) -> u16x32<S> {
    let bytes = u8x16::load_array_ref(simd, bytes);
    if has_byte_shuffle(simd) {
        // Indices 16 and up read whatever the level gives, hence the `& 255`, which costs nothing at AVX2:
        // index 255 is zero there, so the compiler knows. One load and one shuffle a vector.
        let indices = u8x64::load_array(simd, const { pixel_indices() });
        let words: u16x32<S> = u8x64::block_splat(bytes).swizzle_dyn_within_blocks(indices).bitcast();
        words & 255
    } else {
        let zero = u8x16::splat(simd, 0);
        let low: u16x8<S> = bytes.zip_low(zero).bitcast();
        let high: u16x8<S> = bytes.zip_high(zero).bitcast();
        let (low, high) =
            (low.zip_low(low).combine(low.zip_high(low)), high.zip_low(high).combine(high.zip_high(high)));
        low.combine(high)
    }
}

/// The two halves of [`doubled_row`].
#[inline(always)]
pub(crate) fn doubled_words<S: Simd>(simd: S, bytes: &[u8; 16]) -> [u16x16<S>; 2] {
    let (low, high) = doubled_row(simd, bytes).split();
    [low, high]
}

/// Whether the level moves bytes by a vector of indices in one instruction. Known when compiled.
#[inline(always)]
fn has_byte_shuffle<S: Simd>(simd: S) -> bool {
    match simd.level() {
        Level::Fallback(_) => false,
        #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
        Level::Sse2(_) => false,
        _ => true,
    }
}

/// Shuffle indices that put byte i into the low byte of both lanes of pixel i.
const fn pixel_indices() -> [u8; 64] {
    let mut indices = [255; 64];
    let mut lane = 0;
    while lane < 32 {
        indices[2 * lane] = (lane / 2) as u8;
        lane += 1;
    }
    indices
}

/// What [`round_raised_f32`] adds.
pub(crate) const RAISED: i32 = 0x4b40_0000;

/// The nearest integer, ties to even, of lanes within ±2^22, plus [`RAISED`].
///
/// Adding 1.5 · 2^23 leaves the rounded integer in the low bits of the mantissa: one addition at every level, where a
/// native rounding instruction is missing from some. In differences, what was added is lost.
#[inline(always)]
pub(crate) fn round_raised_f32<S, F, I>(v: F) -> I
where
    S: Simd,
    F: SimdFloat<S, Element = f32>,
    I: SimdInt<S, ByteVector = F::ByteVector>,
{
    (v + 12_582_912.0).bitcast()
}

/// The nearest integer, ties to even, of a value within ±2^31, as [`round_raised_f32`] finds it.
#[inline(always)]
pub(crate) fn round_f64(v: f64) -> i32 {
    (v + 6_755_399_441_055_744.0).to_bits() as i32
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::level::{SimdLevel, dispatch};

    #[test]
    fn the_least_of_four_vectors_is_found_in_any_lane() {
        for level in SimdLevel::available() {
            dispatch!(level, simd => {
                for lane in 0..8 {
                    let of = |least: i32, lane: usize| {
                        i32x8::load_array(simd, std::array::from_fn(|i| if i == lane & 7 { least } else { least + 9 + i as i32 }))
                    };
                    let found = least_of_each([of(-7, lane), of(5, lane + 1), of(i32::MIN, lane + 3), of(80, lane + 6)]);
                    assert_eq!(found, [-7, 5, i32::MIN, 80], "{lane} at {level:?}");
                }
            });
        }
    }

    #[test]
    fn div255_rounds_to_nearest_on_its_whole_range() {
        for v in 0..=255 * 255_u32 {
            assert_eq!(div255(v), (2 * v + 255) / 510, "{v}");
        }
        for level in SimdLevel::available() {
            dispatch!(level, simd => {
                for v in 0..=65_025_u16 {
                    let lanes = div255_u16(u16x16::splat(simd, v)).to_array();
                    assert_eq!(u32::from(lanes[7]), div255(u32::from(v)), "{v} at {level:?}");
                }
            });
        }
    }
}
