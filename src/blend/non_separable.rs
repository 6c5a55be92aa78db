//! The non-separable modes: hue, saturation and luminosity.
//!
//! Source: W3C Compositing and Blending Level 1, section 10.2, whose functions `Lum`, `SetLum`, `ClipColor`,
//! `Sat` and `SetSat` are homogeneous: they commute with multiplying all colours by sa·da. So they
//! work on s·da and d·sa here, whole numbers up to 255², and nothing is unpremultiplied.

use fearless_simd::f32x8;
use fearless_simd::prelude::*;

use super::separable::Planes;
use crate::num::lanes::{max_f32, min_f32};

type Rgb<S> = [f32x8<S>; 3];

/// SetLum(SetSat(Cs, Sat(Cb)), Lum(Cb))
#[inline(always)]
pub(super) fn hue<S: Simd>(d: Planes<S>, s: Planes<S>) -> Rgb<S> {
    let (below, above) = overlap(d, s);
    set_luminosity(set_saturation(above, saturation_of(below)), luminosity_of(below), s.alpha * d.alpha)
}

/// SetLum(SetSat(Cb, Sat(Cs)), Lum(Cb))
#[inline(always)]
pub(super) fn saturation<S: Simd>(d: Planes<S>, s: Planes<S>) -> Rgb<S> {
    let (below, above) = overlap(d, s);
    set_luminosity(set_saturation(below, saturation_of(above)), luminosity_of(below), s.alpha * d.alpha)
}

/// SetLum(Cs, Lum(Cb))
#[inline(always)]
pub(super) fn color<S: Simd>(d: Planes<S>, s: Planes<S>) -> Rgb<S> {
    let (below, above) = overlap(d, s);
    set_luminosity(above, luminosity_of(below), s.alpha * d.alpha)
}

/// SetLum(Cb, Lum(Cs))
#[inline(always)]
pub(super) fn luminosity<S: Simd>(d: Planes<S>, s: Planes<S>) -> Rgb<S> {
    let (below, above) = overlap(d, s);
    set_luminosity(below, luminosity_of(above), s.alpha * d.alpha)
}

/// Both colours times both alphas: (sa·da·Cb, sa·da·Cs).
#[inline(always)]
fn overlap<S: Simd>(d: Planes<S>, s: Planes<S>) -> (Rgb<S>, Rgb<S>) {
    (times(d.rgb, s.alpha), times(s.rgb, d.alpha))
}

#[inline(always)]
fn times<S: Simd>([r, g, b]: Rgb<S>, by: f32x8<S>) -> Rgb<S> {
    [r * by, g * by, b * by]
}

#[inline(always)]
fn largest<S: Simd>([r, g, b]: Rgb<S>) -> f32x8<S> {
    max_f32(r, max_f32(g, b))
}

#[inline(always)]
fn smallest<S: Simd>([r, g, b]: Rgb<S>) -> f32x8<S> {
    min_f32(r, min_f32(g, b))
}

/// `Lum`: 0.3 R + 0.59 G + 0.11 B
#[inline(always)]
fn luminosity_of<S: Simd>([r, g, b]: Rgb<S>) -> f32x8<S> {
    r * 0.3 + g * 0.59 + b * 0.11
}

/// `Sat`: the distance between the largest and the smallest component
#[inline(always)]
fn saturation_of<S: Simd>(rgb: Rgb<S>) -> f32x8<S> {
    largest(rgb) - smallest(rgb)
}

/// `SetSat`: moves the smallest component to 0 and the largest to `saturation`; grey becomes black.
#[inline(always)]
fn set_saturation<S: Simd>(rgb: Rgb<S>, saturation: f32x8<S>) -> Rgb<S> {
    let low = smallest(rgb);
    // Whole numbers: a range that is not 0 is at least 1, and in grey all the numerators are 0.
    let range = max_f32(saturation_of(rgb), f32x8::splat(low.simd, 1.0));
    let [r, g, b] = rgb;
    [(r - low) * saturation / range, (g - low) * saturation / range, (b - low) * saturation / range]
}

/// `SetLum` and `ClipColor`: shifts the colour to `luminosity`, then pulls what left 0 ..= `full` toward
/// the grey of that luminosity.
#[inline(always)]
fn set_luminosity<S: Simd>(rgb: Rgb<S>, luminosity: f32x8<S>, full: f32x8<S>) -> Rgb<S> {
    let shift = luminosity - luminosity_of(rgb);
    let rgb = [rgb[0] + shift, rgb[1] + shift, rgb[2] + shift];
    let grey = luminosity_of(rgb);
    let (low, high) = (smallest(rgb), largest(rgb));
    let (zero, one) = (f32x8::splat(full.simd, 0.0), f32x8::splat(full.simd, 1.0));
    // Components are at most `full` apart, so that a colour cannot leave at both ends. A divisor exceeds
    // what is to be clipped; where only rounding is to be, it is held to 1, or 1/255² of the range.
    let rise = grey / max_f32(grey - low, one);
    let fall = (full - grey) / max_f32(high - grey, one);
    let pull = low.simd_lt(zero).select(rise, high.simd_gt(full).select(fall, one));
    let [r, g, b] = rgb;
    [hold(grey + (r - grey) * pull, full), hold(grey + (g - grey) * pull, full), hold(grey + (b - grey) * pull, full)]
}

/// v held to 0 ..= `full`, from which rounding may have taken it.
#[inline(always)]
fn hold<S: Simd>(v: f32x8<S>, full: f32x8<S>) -> f32x8<S> {
    min_f32(max_f32(v, f32x8::splat(full.simd, 0.0)), full)
}
