//! Depth formats: depths as integers whose order is theirs.
//!
//! Every format is kept as an `i32` key with key(a) < key(b) where a < b, so that one integer comparison serves all:
//! 16- and 24-bit depths as their integers, 32-bit floats as their bits (non-negative floats order like integers).

use fearless_simd::prelude::*;
use fearless_simd::{f32x8, i32x8};

use crate::num::lanes::{max_f32, min_f32, truncate_f32};

/// How depths are stored.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum DepthFormat {
    /// 16-bit unsigned normalised: steps of 1 / 65535.
    D16,
    /// 24-bit unsigned normalised: steps of 1 / (2^24 − 1).
    D24,
    /// 32-bit float: the default.
    #[default]
    D32F,
}

impl DepthFormat {
    /// The largest stored integer of a normalised format.
    fn scale(self) -> f32 {
        match self {
            Self::D16 => 65_535.0,
            Self::D24 => 16_777_215.0,
            Self::D32F => 0.0,
        }
    }

    /// The key of a depth. D16 and D24 clamp to 0 ..= 1 and round to nearest; D32F takes any float, infinities
    /// included; NaN counts as 0.
    pub fn key(self, depth: f32) -> i32 {
        if self == Self::D32F {
            if depth.is_nan() {
                return 0;
            }
            let bits = (depth + 0.0).to_bits() as i32;
            // Negative floats order backwards: their other bits are turned over.
            return bits ^ ((bits >> 31) & i32::MAX);
        }
        let depth = if depth > 0.0 { if depth < 1.0 { depth } else { 1.0 } } else { 0.0 };
        let v = depth * self.scale();
        if v >= 8_388_608.0 { v as i32 } else { (v + 0.5) as i32 }
    }

    /// The depth of a key.
    pub fn value(self, key: i32) -> f32 {
        match self {
            Self::D32F => f32::from_bits((key ^ ((key >> 31) & i32::MAX)) as u32),
            Self::D16 | Self::D24 => key as f32 / self.scale(),
        }
    }

    /// The smallest step that the format resolves near a depth: for D32F the step of a float of that exponent.
    pub fn resolution(self, depth: f32) -> f32 {
        match self {
            Self::D16 | Self::D24 => 1.0 / self.scale(),
            Self::D32F => {
                let exponent = ((depth.abs().to_bits() >> 23) & 255).clamp(24, 254);
                f32::from_bits((exponent - 23) << 23)
            }
        }
    }

    /// Keys of eight depths, clamped to 0 ..= 1; equal to [`DepthFormat::key`] of the clamped depth.
    #[inline(always)]
    pub(crate) fn keys<S: Simd>(self, z: f32x8<S>) -> i32x8<S> {
        let simd = z.simd;
        let z = min_f32(max_f32(z, f32x8::splat(simd, 0.0)), f32x8::splat(simd, 1.0));
        match self {
            Self::D32F => z.bitcast(),
            Self::D16 => truncate_f32(z * 65_535.0 + 0.5),
            Self::D24 => {
                let v = z * 16_777_215.0;
                let large = v.simd_ge(f32x8::splat(simd, 8_388_608.0));
                truncate_f32(large.select(v, v + 0.5))
            }
        }
    }
}

/// log₂ of eight positive finite floats, within 4·10⁻⁶ of the true value relative to max(1, |log₂|).
///
/// Exponent and mantissa are split by their bits; with m in √½ ..= √2, log₂ m = 2/ln 2 · artanh(t), t = (m − 1) / (m + 1),
/// |t| < 0.1716, by its series up to t⁹.
#[inline(always)]
pub(crate) fn log2<S: Simd>(v: f32x8<S>) -> f32x8<S> {
    let bits: i32x8<S> = v.bitcast();
    // The exponent is taken at √½, so that the mantissa lies around 1.
    let shifted = bits - 0x3f35_04f3;
    let exponent = shifted >> 23;
    let mantissa: f32x8<S> = (bits - (exponent << 23)).bitcast();
    let t = (mantissa - 1.0) / (mantissa + 1.0);
    let t2 = t * t;
    let series = t2 * 0.111_111_11 + 0.142_857_15;
    let series = t2 * series + 0.2;
    let series = t2 * series + 0.333_333_34;
    let series = t2 * series + 1.0;
    let exponent: f32x8<S> = exponent.to_float();
    exponent + t * series * 2.885_39
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::level::{SimdLevel, dispatch};

    #[test]
    fn keys_order_like_depths_and_lanes_equal_scalars() {
        let mut depths: Vec<f32> = (0..=4096).map(|i| i as f32 / 4096.0).collect();
        depths.extend([1e-30, 1e-7, 0.999_999_9, 0.5 + 1e-7, 0.499_999_97]);
        depths.sort_by(f32::total_cmp);
        for format in [DepthFormat::D16, DepthFormat::D24, DepthFormat::D32F] {
            for pair in depths.windows(2) {
                assert!(format.key(pair[0]) <= format.key(pair[1]), "{format:?} {pair:?}");
                let value = format.value(format.key(pair[0]));
                // Half a step, and what `f32` rounds on the way: 1/256 of a step at D16, half of one at D24.
                let steps = if format == DepthFormat::D24 { 1.0 } else { 0.504 };
                assert!((value - pair[0]).abs() <= steps * format.resolution(1.0).max(1e-9), "{format:?} {pair:?}");
            }
            for level in SimdLevel::available() {
                dispatch!(level, simd => {
                    for &z in &depths {
                        let lanes = format.keys(f32x8::splat(simd, z)).to_array();
                        assert_eq!(lanes, [format.key(z); 8], "{format:?} {z} {level:?}");
                    }
                });
            }
        }
        assert!(DepthFormat::D32F.key(-1.0) < DepthFormat::D32F.key(-0.0));
        assert!(DepthFormat::D32F.key(f32::INFINITY) > DepthFormat::D32F.key(1.0));
        assert_eq!(DepthFormat::D32F.value(DepthFormat::D32F.key(-1.0)), -1.0);
    }

    #[test]
    #[expect(clippy::disallowed_methods, reason = "compared with a tolerance")]
    fn logarithms_are_right() {
        dispatch!(SimdLevel::best(), simd => {
            for i in -300..300 {
                let v = (f64::from(i) / 10.0).exp2() as f32;
                let expected = f64::from(v).ln() / std::f64::consts::LN_2;
                let got = f64::from(log2(f32x8::splat(simd, v)).to_array()[3]);
                assert!((got - expected).abs() <= 4e-6 * expected.abs().max(1.0), "{v}: {got} {expected}");
            }
        });
    }
}
