//! The separable modes: each colour component on its own.
//!
//! Source: W3C Compositing and Blending Level 1, section 10.1. With s, d premultiplied components, sa, da
//! the alphas and B the mode's function of the straight colours,
//!
//! > result = s·(1 − da) + d·(1 − sa) + sa·da·B(d / da, s / sa)
//!
//! The alpha is sa + da − sa·da: what the formula gives for s = sa, d = da, B = 1. Modes in which
//! sa·da·B is a polynomial of the four are exact in 16-bit integers and rounded once. Those that divide
//! or take roots go through `f32`, whose ÷ and √ every machine rounds alike.

use fearless_simd::prelude::*;
use fearless_simd::{f32x8, i32x8, u8x32, u16x16, u32x8};

use super::porter_duff::Operands;
use super::words::{Words, clamped, mix_block};
use crate::num::lanes::{max_f32, min_f32, truncate_f32};
use crate::surface::block::{MaskBlock, PixelBlock};

/// max(a, b) by saturation, which SSE2 has for unsigned words where it lacks the maximum.
#[inline(always)]
fn max_u16<S: Simd>(a: u16x16<S>, b: u16x16<S>) -> u16x16<S> {
    a + b.saturating_sub(a)
}

/// min(a, b), likewise.
#[inline(always)]
fn min_u16<S: Simd>(a: u16x16<S>, b: u16x16<S>) -> u16x16<S> {
    a - a.saturating_sub(b)
}

/// B = Cb·Cs
#[inline(always)]
pub(super) fn multiply<S: Simd>(o: Operands<S>) -> u16x16<S> {
    o.outside() + o.s * o.d
}

/// B = Cb + Cs − Cb·Cs; that is s + d·(1 − s)
#[inline(always)]
pub(super) fn screen<S: Simd>(o: Operands<S>) -> u16x16<S> {
    o.s * 255 + o.d * (o.s ^ 255)
}

/// B = 2·Cb·Cs where Cs ≤ ½, else 1 − 2·(1 − Cb)·(1 − Cs)
#[inline(always)]
pub(super) fn hard_light<S: Simd>(o: Operands<S>) -> u16x16<S> {
    o.outside() + multiply_or_screen(o, (o.s + o.s).simd_le(o.sa))
}

/// Hard light with source and destination exchanged: the destination decides.
#[inline(always)]
pub(super) fn overlay<S: Simd>(o: Operands<S>) -> u16x16<S> {
    o.outside() + multiply_or_screen(o, (o.d + o.d).simd_le(o.da))
}

/// sa·da·B of [`hard_light`]. A lane that is not chosen may wrap around.
#[inline(always)]
fn multiply_or_screen<S: Simd>(o: Operands<S>, multiply: <u16x16<S> as SimdBase<S>>::Mask) -> u16x16<S> {
    let product = o.s * o.d;
    let complement = (o.sa - o.s) * (o.da - o.d);
    multiply.select(product + product, o.sa * o.da - (complement + complement))
}

/// B = min(Cb, Cs)
#[inline(always)]
pub(super) fn darken<S: Simd>(o: Operands<S>) -> u16x16<S> {
    o.outside() + min_u16(o.s * o.da, o.d * o.sa)
}

/// B = max(Cb, Cs)
#[inline(always)]
pub(super) fn lighten<S: Simd>(o: Operands<S>) -> u16x16<S> {
    o.outside() + max_u16(o.s * o.da, o.d * o.sa)
}

/// B = |Cb − Cs|
#[inline(always)]
pub(super) fn difference<S: Simd>(o: Operands<S>) -> u16x16<S> {
    let (s, d) = (o.s * o.da, o.d * o.sa);
    // One of the two differences is 0. Alpha wants sa·da instead, which is s.
    let difference = s.saturating_sub(d) | d.saturating_sub(s);
    o.outside() + (difference | (s & o.is_alpha))
}

/// B = Cb + Cs − 2·Cb·Cs; that is s·(1 − d) + d·(1 − s)
#[inline(always)]
pub(super) fn exclusion<S: Simd>(o: Operands<S>) -> u16x16<S> {
    // Alpha wants s·d on top of it.
    o.s * (o.d ^ 255) + o.d * (o.s ^ 255) + ((o.s * o.d) & o.is_alpha)
}

/// One component or alpha of 8 pixels, in 0 ..= 255, for formulas that divide.
#[derive(Clone, Copy)]
pub(super) struct Component<S: Simd> {
    /// Source, at most its alpha.
    pub(super) s: f32x8<S>,
    /// Destination, at most its alpha.
    pub(super) d: f32x8<S>,
    /// The source's alpha.
    pub(super) sa: f32x8<S>,
    /// The destination's alpha.
    pub(super) da: f32x8<S>,
}

/// 8 pixels as four vectors, one a component.
#[derive(Clone, Copy)]
pub(super) struct Planes<S: Simd> {
    pub(super) rgb: [f32x8<S>; 3],
    pub(super) alpha: f32x8<S>,
}

impl<S: Simd> Planes<S> {
    /// The pixels with components above their alpha lowered to it.
    #[inline(always)]
    fn from_bytes(bytes: u8x32<S>) -> Self {
        let pixels: u32x8<S> = clamped(bytes).0.to_bytes().bitcast();
        let (r, g, b) = (pixels & 255, (pixels >> 8) & 255, (pixels >> 16) & 255);
        Self { rgb: [to_float(r), to_float(g), to_float(b)], alpha: to_float(pixels >> 24) }
    }
}

/// Small integers as floats, through the signed conversion, which every level has.
#[inline(always)]
fn to_float<S: Simd>(v: u32x8<S>) -> f32x8<S> {
    v.bitcast::<i32x8<S>>().to_float()
}

/// v / 255 rounded to nearest and held to 0 ..= 255, for finite v well inside ±2^31.
#[inline(always)]
fn to_component<S: Simd>(v: f32x8<S>) -> u32x8<S> {
    let rounded = v * (1.0 / 255.0) + 0.5;
    let held = min_f32(max_f32(rounded, f32x8::splat(v.simd, 0.0)), f32x8::splat(v.simd, 255.0));
    truncate_f32(held).bitcast()
}

/// Composites by a formula that gives 255²·sa·da·B, the part of the result where source and destination
/// overlap, of all three components of 8 pixels.
#[inline(always)]
pub(super) fn composite_planes<S: Simd>(
    simd: S,
    dst: &mut PixelBlock,
    src: &PixelBlock,
    mask: &MaskBlock,
    formula: impl Fn(Planes<S>, Planes<S>) -> [f32x8<S>; 3],
) {
    mix_block(
        simd,
        dst,
        src,
        mask,
        #[inline(always)]
        |dst, src| {
            let (d, s) = (Planes::from_bytes(dst), Planes::from_bytes(src));
            let [r, g, b] = formula(d, s);
            let full = f32x8::splat(simd, 255.0);
            let (outside_s, outside_d) = (full - d.alpha, full - s.alpha);
            let r = to_component(s.rgb[0] * outside_s + d.rgb[0] * outside_d + r);
            let g = to_component(s.rgb[1] * outside_s + d.rgb[1] * outside_d + g);
            let b = to_component(s.rgb[2] * outside_s + d.rgb[2] * outside_d + b);
            let a = to_component(s.alpha * outside_s + d.alpha * full);
            Words::from_bytes((r | (g << 8) | (b << 16) | (a << 24)).bitcast())
        },
    );
}

/// [`composite_planes`] for a formula of one component.
#[inline(always)]
pub(super) fn composite_components<S: Simd>(
    simd: S,
    dst: &mut PixelBlock,
    src: &PixelBlock,
    mask: &MaskBlock,
    formula: impl Fn(Component<S>) -> f32x8<S>,
) {
    composite_planes(
        simd,
        dst,
        src,
        mask,
        #[inline(always)]
        |d, s| {
            let component =
                |s_component, d_component| Component { s: s_component, d: d_component, sa: s.alpha, da: d.alpha };
            [
                formula(component(s.rgb[0], d.rgb[0])),
                formula(component(s.rgb[1], d.rgb[1])),
                formula(component(s.rgb[2], d.rgb[2])),
            ]
        },
    );
}

/// B = 0 where Cb = 0, else 1 where Cs = 1, else min(1, Cb / (1 − Cs))
#[inline(always)]
pub(super) fn color_dodge<S: Simd>(c: Component<S>) -> f32x8<S> {
    let (zero, one) = (f32x8::splat(c.d.simd, 0.0), f32x8::splat(c.d.simd, 1.0));
    // Components are whole numbers, so a divisor that is not 0 is at least 1.
    let divisor = max_f32(c.sa - c.s, one);
    let dodged = c.sa * min_f32(c.da, c.d * c.sa / divisor);
    let full = c.sa * c.da;
    c.d.simd_eq(zero).select(zero, c.s.simd_ge(c.sa).select(full, dodged))
}

/// B = 1 where Cb = 1, else 0 where Cs = 0, else 1 − min(1, (1 − Cb) / Cs)
#[inline(always)]
pub(super) fn color_burn<S: Simd>(c: Component<S>) -> f32x8<S> {
    let (zero, one) = (f32x8::splat(c.d.simd, 0.0), f32x8::splat(c.d.simd, 1.0));
    let divisor = max_f32(c.s, one);
    let burnt = c.sa * (c.da - min_f32(c.da, (c.da - c.d) * c.sa / divisor));
    let full = c.sa * c.da;
    c.d.simd_ge(c.da).select(full, c.s.simd_eq(zero).select(zero, burnt))
}

/// B = Cb − (1 − 2·Cs)·Cb·(1 − Cb) where Cs ≤ ½, else Cb + (2·Cs − 1)·(D − Cb) with
/// D = ((16·Cb − 12)·Cb + 4)·Cb where Cb ≤ ¼, else √Cb
#[inline(always)]
pub(super) fn soft_light<S: Simd>(c: Component<S>) -> f32x8<S> {
    let (zero, one) = (f32x8::splat(c.d.simd, 0.0), f32x8::splat(c.d.simd, 1.0));
    let straight = c.d / max_f32(c.da, one);
    let lean = c.s + c.s - c.sa;
    let darker = lean * c.d * (one - straight);
    let polynomial = ((straight * 16.0 - 12.0) * straight + 3.0) * straight;
    let root = straight.sqrt() - straight;
    let lighter = lean * c.da * (c.d * 4.0).simd_le(c.da).select(polynomial, root);
    c.d * c.sa + lean.simd_le(zero).select(darker, lighter)
}
