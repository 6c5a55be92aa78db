//! Positions in 24.8 fixed point: whole numbers of 1/256 pixel.

/// One pixel.
pub(crate) const ONE: i32 = 256;
/// Fractional bits.
pub(crate) const SHIFT: u32 = 8;

/// Positions beyond this many pixels from the origin are clipped in `f64` before they become fixed
/// point; differences of two positions inside it fit 30 bits.
pub(crate) const LIMIT: f32 = 1_048_576.0;

/// `v` pixels (|v| ≤ [`LIMIT`]) as fixed point, rounded to nearest, ties to even.
///
/// Adding 1.5 · 2^52 leaves the rounded integer in the low bits of an `f64`'s mantissa: the same
/// on every machine, without a call where there is no rounding instruction.
#[inline(always)]
pub(crate) fn from_f32(v: f32) -> i32 {
    from_f64(f64::from(v))
}

/// As [`from_f32`], for a position that was computed in `f64`.
#[inline(always)]
pub(crate) fn from_f64(v: f64) -> i32 {
    (v * 256.0 + 6_755_399_441_055_744.0).to_bits() as i32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rounds_to_nearest_with_ties_to_even() {
        for (v, expected) in [
            (0.0, 0),
            (1.0, 256),
            (-1.0, -256),
            (0.5 / 256.0, 0),
            (1.5 / 256.0, 2),
            (-0.5 / 256.0, 0),
            (-1.5 / 256.0, -2),
            (0.6 / 256.0, 1),
            (-0.6 / 256.0, -1),
            (LIMIT, 1 << 28),
            (-LIMIT, -(1 << 28)),
            (32_767.996, 8_388_607),
        ] {
            assert_eq!(from_f32(v), expected, "{v}");
        }
    }
}
