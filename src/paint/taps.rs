//! Which pixels of an image a sample reads, along one axis.

use fearless_simd::prelude::*;
use fearless_simd::{f32x8, i32x8, mask32x8};

use super::shader::SpreadMode;
use crate::num::lanes::{max_f32, min_f32, truncate_f32};

/// One axis of an image: its length in pixels and what lies beyond.
#[derive(Clone, Copy, Debug)]
pub(super) struct Axis {
    /// Pixels, 1 ..= 32,767.
    pub(super) size: f32,
    inverse: f32,
    pub(super) spread: SpreadMode,
}

/// Coordinates are clamped to ± this, 2^22: far beyond any image, and far enough below 2^24 that whole
/// numbers and halves are still told apart.
const FAR: f32 = 4_194_304.0;

impl Axis {
    pub(super) fn new(size: u32, spread: SpreadMode) -> Self {
        let size = size as f32;
        Self { size, inverse: 1.0 / size, spread }
    }

    /// The pixel that holds coordinate `v`; see [`Axis::wrap`]. Not inlined: code size.
    #[inline(never)]
    pub(super) fn nearest<S: Simd>(&self, simd: S, v: f32x8<S>) -> (i32x8<S>, mask32x8<S>) {
        simd.vectorize(
            #[inline(always)]
            || self.wrap(simd, clamp_far(simd, v).floor()),
        )
    }

    /// The pixel that whole coordinate `i` (|i| ≤ 2^23) shows, and whether there is one: false in the
    /// lanes beyond the edges of a decal, whose index is that of the nearest edge.
    #[inline(always)]
    fn wrap<S: Simd>(&self, simd: S, i: f32x8<S>) -> (i32x8<S>, mask32x8<S>) {
        let zero = f32x8::splat(simd, 0.0);
        let last = f32x8::splat(simd, self.size - 1.0);
        let inside = i.simd_ge(zero) & i.simd_le(last);
        let folded = match self.spread {
            SpreadMode::Pad | SpreadMode::Decal => i,
            SpreadMode::Repeat => remainder(simd, i, self.size, self.inverse),
            SpreadMode::Reflect => {
                let r = remainder(simd, i, self.size * 2.0, self.inverse * 0.5);
                r.simd_gt(last).select(last + last + 1.0 - r, r)
            }
        };
        let index = truncate_f32(min_f32(max_f32(folded, zero), last));
        let shown = if self.spread == SpreadMode::Decal { inside } else { zero.simd_eq(zero) };
        (index, shown)
    }
}

/// `i` modulo `divisor`, both whole: the quotient from a product may be off by one, the rest is exact.
#[inline(always)]
fn remainder<S: Simd>(simd: S, i: f32x8<S>, divisor: f32, inverse: f32) -> f32x8<S> {
    let zero = f32x8::splat(simd, 0.0);
    let r = i - (i * inverse).floor() * divisor;
    let r = r.simd_lt(zero).select(r + divisor, r);
    r.simd_ge(divisor).select(r - divisor, r)
}

/// A coordinate clamped to where its neighbours can be told apart; NaN goes to the low end.
#[inline(always)]
fn clamp_far<S: Simd>(simd: S, v: f32x8<S>) -> f32x8<S> {
    min_f32(max_f32(v, f32x8::splat(simd, -FAR)), f32x8::splat(simd, FAR))
}

/// Eight samples of a bilinear filter along one axis: two pixels each, with weights in 1/256 that add up
/// to 256 (less at a decal's edges).
#[derive(Clone, Copy)]
pub(super) struct LinearTaps<S: Simd> {
    pub(super) index: [i32x8<S>; 2],
    pub(super) weight: [i32x8<S>; 2],
}

impl<S: Simd> LinearTaps<S> {
    /// The taps at coordinates `v` (pixel centres at .5). Not inlined: code size.
    #[inline(never)]
    pub(super) fn new(simd: S, v: f32x8<S>, axis: &Axis) -> Self {
        simd.vectorize(
            #[inline(always)]
            || Self::compute(simd, v, axis),
        )
    }

    #[inline(always)]
    fn compute(simd: S, v: f32x8<S>, axis: &Axis) -> Self {
        let v = clamp_far(simd, v - 0.5);
        let first = v.floor();
        let second_weight = truncate_f32((v - first) * 256.0 + 0.5);
        let first_weight = i32x8::splat(simd, 256) - second_weight;
        let (i0, shown0) = axis.wrap(simd, first);
        let (i1, shown1) = axis.wrap(simd, first + 1.0);
        let none = i32x8::splat(simd, 0);
        Self { index: [i0, i1], weight: [shown0.select(first_weight, none), shown1.select(second_weight, none)] }
    }
}

/// Eight samples of a bicubic filter along one axis: four pixels each, with weights that add up to 1
/// (less at a decal's edges).
#[derive(Clone, Copy)]
pub(super) struct CubicTaps<S: Simd> {
    pub(super) index: [i32x8<S>; 4],
    pub(super) weight: [f32x8<S>; 4],
}

impl<S: Simd> CubicTaps<S> {
    /// The taps at coordinates `v`, of the cubic with B = C = ⅓ (Mitchell and Netravali, *Reconstruction
    /// Filters in Computer Graphics*, 1988). Not inlined: code size.
    #[inline(never)]
    pub(super) fn new(simd: S, v: f32x8<S>, axis: &Axis) -> Self {
        simd.vectorize(
            #[inline(always)]
            || Self::compute(simd, v, axis),
        )
    }

    #[inline(always)]
    fn compute(simd: S, v: f32x8<S>, axis: &Axis) -> Self {
        let v = clamp_far(simd, v - 0.5);
        let first = v.floor();
        let f = v - first;
        let g = f32x8::splat(simd, 1.0) - f;
        let weights = [far_weight(g), near_weight(g), near_weight(f), far_weight(f)];
        let none = f32x8::splat(simd, 0.0);
        let mut index = [i32x8::splat(simd, 0); 4];
        let mut weight = [none; 4];
        for k in 0..4 {
            let (i, shown) = axis.wrap(simd, first + (k as f32 - 1.0));
            index[k] = i;
            weight[k] = shown.select(weights[k], none);
        }
        Self { index, weight }
    }
}

/// The filter at distance 1 − t, t in 0 ..= 1: (1 + 9t + 27t² − 21t³) / 18.
#[inline(always)]
fn near_weight<S: Simd>(t: f32x8<S>) -> f32x8<S> {
    (((t * -21.0 + 27.0) * t + 9.0) * t + 1.0) * (1.0 / 18.0)
}

/// The filter at distance 2 − t, t in 0 ..= 1: (7t³ − 6t²) / 18.
#[inline(always)]
fn far_weight<S: Simd>(t: f32x8<S>) -> f32x8<S> {
    t * t * (t * 7.0 - 6.0) * (1.0 / 18.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::level::{SimdLevel, dispatch};

    /// The pixel by integer arithmetic.
    fn wrap_slowly(i: i64, size: i64, spread: SpreadMode) -> Option<i64> {
        match spread {
            SpreadMode::Pad => Some(i.clamp(0, size - 1)),
            SpreadMode::Decal => (0..size).contains(&i).then_some(i),
            SpreadMode::Repeat => Some(i.rem_euclid(size)),
            SpreadMode::Reflect => {
                let r = i.rem_euclid(2 * size);
                Some(if r < size { r } else { 2 * size - 1 - r })
            }
        }
    }

    #[test]
    fn wrapping_is_exact_far_out() {
        for level in SimdLevel::available() {
            dispatch!(level, simd => {
                for spread in [SpreadMode::Pad, SpreadMode::Repeat, SpreadMode::Reflect, SpreadMode::Decal] {
                    for size in [1_u32, 2, 3, 7, 64, 1000, 32_767] {
                        let axis = Axis::new(size, spread);
                        for base in (-40..40).chain([-4_194_304, -1_000_003, 999_999, 4_194_300]) {
                            let i = f32x8::splat(simd, base as f32);
                            let (index, shown) = axis.wrap(simd, i);
                            let truth = wrap_slowly(base, i64::from(size), spread);
                            assert_eq!(shown.all_true(), truth.is_some(), "{base} in {size} {spread:?}");
                            if let Some(truth) = truth {
                                assert_eq!(i64::from(index.to_array()[5]), truth, "{base} in {size} {spread:?}");
                            }
                        }
                    }
                }
            });
        }
    }

    #[test]
    fn cubic_weights_are_the_filter_of_mitchell_and_netravali() {
        /// The filter as the paper states it, at distance x.
        fn filter(x: f64) -> f64 {
            let (b, c, x) = (1.0 / 3.0, 1.0 / 3.0, x.abs());
            let (x2, x3) = (x * x, x * x * x);
            let sum = if x < 1.0 {
                (12.0 - 9.0 * b - 6.0 * c) * x3 + (-18.0 + 12.0 * b + 6.0 * c) * x2 + (6.0 - 2.0 * b)
            } else if x < 2.0 {
                (-b - 6.0 * c) * x3 + (6.0 * b + 30.0 * c) * x2 + (-12.0 * b - 48.0 * c) * x + (8.0 * b + 24.0 * c)
            } else {
                0.0
            };
            sum / 6.0
        }
        dispatch!(SimdLevel::Scalar, simd => {
            for step in 0..100 {
                let v = 7.0 + step as f32 / 100.0;
                let taps = CubicTaps::new(simd, f32x8::splat(simd, v), &Axis::new(50, SpreadMode::Pad));
                for k in 0..4 {
                    let center = f64::from(taps.index[k].to_array()[0]) + 0.5;
                    let truth = filter(f64::from(v) - center);
                    assert!((f64::from(taps.weight[k].to_array()[0]) - truth).abs() < 1e-6, "{v} {k}");
                }
            }
        });
    }
}
