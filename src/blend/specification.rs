//! Blending as the specification writes it: one pixel, straight colours, real numbers. The kernels are
//! held against this, and against tiny-skia.

use super::BlendMode::{self, *};
use super::composite_block;
use crate::num::level::{SimdLevel, dispatch};
use crate::surface::block::{MaskBlock, PixelBlock};

/// Modes whose formulas are exact integers, rounded once.
const INTEGER: [BlendMode; 22] = [
    Clear,
    Source,
    Destination,
    SourceOver,
    DestinationOver,
    SourceIn,
    DestinationIn,
    SourceOut,
    DestinationOut,
    SourceAtop,
    DestinationAtop,
    Xor,
    Plus,
    Modulate,
    Screen,
    Overlay,
    Darken,
    Lighten,
    HardLight,
    Difference,
    Exclusion,
    Multiply,
];

type Rgb = [f64; 3];

fn lum([r, g, b]: Rgb) -> f64 {
    0.3 * r + 0.59 * g + 0.11 * b
}

fn sat(c: Rgb) -> f64 {
    c.into_iter().fold(0.0, f64::max) - c.into_iter().fold(1.0, f64::min)
}

fn clip_color(c: Rgb) -> Rgb {
    let (l, n, x) = (lum(c), c[0].min(c[1]).min(c[2]), c[0].max(c[1]).max(c[2]));
    // The specification compares with 0 and 1 exactly; a little slack keeps rounding out of the divisor.
    if n < -1e-12 {
        c.map(|v| l + (v - l) * l / (l - n))
    } else if x > 1.0 + 1e-12 {
        c.map(|v| l + (v - l) * (1.0 - l) / (x - l))
    } else {
        c
    }
}

fn set_lum(c: Rgb, l: f64) -> Rgb {
    let d = l - lum(c);
    clip_color(c.map(|v| v + d))
}

fn set_sat(c: Rgb, s: f64) -> Rgb {
    let low = c.into_iter().fold(1.0, f64::min);
    let range = sat(c);
    c.map(|v| if range == 0.0 { 0.0 } else { (v - low) * s / range })
}

/// B(Cb, Cs) of one component.
fn separable(mode: BlendMode, cb: f64, cs: f64) -> f64 {
    match mode {
        Multiply => cb * cs,
        Screen => cb + cs - cb * cs,
        Overlay => separable(HardLight, cs, cb),
        Darken => cb.min(cs),
        Lighten => cb.max(cs),
        ColorDodge if cb == 0.0 => 0.0,
        ColorDodge if cs == 1.0 => 1.0,
        ColorDodge => (cb / (1.0 - cs)).min(1.0),
        ColorBurn if cb == 1.0 => 1.0,
        ColorBurn if cs == 0.0 => 0.0,
        ColorBurn => 1.0 - ((1.0 - cb) / cs).min(1.0),
        HardLight if cs <= 0.5 => cb * 2.0 * cs,
        HardLight => separable(Screen, cb, 2.0 * cs - 1.0),
        SoftLight if cs <= 0.5 => cb - (1.0 - 2.0 * cs) * cb * (1.0 - cb),
        SoftLight => {
            let d = if cb <= 0.25 { ((16.0 * cb - 12.0) * cb + 4.0) * cb } else { cb.sqrt() };
            cb + (2.0 * cs - 1.0) * (d - cb)
        }
        Difference => (cb - cs).abs(),
        Exclusion => cb + cs - 2.0 * cb * cs,
        _ => unreachable!("{mode} is no separable mode"),
    }
}

/// The premultiplied result of premultiplied pixels, before rounding; all in 0 ..= 1.
fn blend(mode: BlendMode, d: [f64; 4], s: [f64; 4]) -> [f64; 4] {
    let (da, sa) = (d[3], s[3]);
    let straight = |p: [f64; 4]| [p[0], p[1], p[2]].map(|v| if p[3] == 0.0 { 0.0 } else { v / p[3] });
    let (cb, cs) = (straight(d), straight(s));
    // The Porter–Duff fractions of source and destination.
    let duff = |fa: f64, fb: f64| std::array::from_fn(|i| fa * s[i] + fb * d[i]);
    let b: Rgb = match mode {
        Clear => return duff(0.0, 0.0),
        Source => return duff(1.0, 0.0),
        Destination => return duff(0.0, 1.0),
        SourceOver => return duff(1.0, 1.0 - sa),
        DestinationOver => return duff(1.0 - da, 1.0),
        SourceIn => return duff(da, 0.0),
        DestinationIn => return duff(0.0, sa),
        SourceOut => return duff(1.0 - da, 0.0),
        DestinationOut => return duff(0.0, 1.0 - sa),
        SourceAtop => return duff(da, 1.0 - sa),
        DestinationAtop => return duff(1.0 - da, sa),
        Xor => return duff(1.0 - da, 1.0 - sa),
        Plus => return std::array::from_fn(|i| (s[i] + d[i]).min(1.0)),
        Modulate => return std::array::from_fn(|i| s[i] * d[i]),
        Hue => set_lum(set_sat(cs, sat(cb)), lum(cb)),
        Saturation => set_lum(set_sat(cb, sat(cs)), lum(cb)),
        Color => set_lum(cs, lum(cb)),
        Luminosity => set_lum(cb, lum(cs)),
        _ => std::array::from_fn(|i| separable(mode, cb[i], cs[i])),
    };
    let component = |i: usize| s[i] * (1.0 - da) + d[i] * (1.0 - sa) + sa * da * b[i];
    [component(0), component(1), component(2), sa + da - sa * da]
}

fn unit(p: [u8; 4]) -> [f64; 4] {
    p.map(|v| f64::from(v) / 255.0)
}

fn lowered(p: [u8; 4]) -> [u8; 4] {
    p.map(|v| v.min(p[3]))
}

fn round_255(numerator: u32) -> u8 {
    ((2 * numerator + 255) / 510).min(255) as u8
}

/// One pixel, with the roundings that the kernels state.
fn composite_pixel(mode: BlendMode, dst: [u8; 4], src: [u8; 4], mask: u8) -> [u8; 4] {
    let m = u32::from(mask);
    let (s, d) = (src.map(u32::from), dst.map(u32::from));
    let mix = |blended: [u8; 4]| -> [u8; 4] {
        std::array::from_fn(|i| round_255(d[i] * (255 - m) + u32::from(blended[i]) * m))
    };
    match mode {
        Destination => dst,
        Source => mix(src),
        SourceOver => {
            let alpha = u32::from(round_255(s[3] * m));
            std::array::from_fn(|i| round_255(s[i] * m + d[i] * (255 - alpha)))
        }
        Plus => std::array::from_fn(|i| dst[i].saturating_add(round_255(s[i] * m))),
        _ => mix(blend(mode, unit(lowered(dst)), unit(lowered(src))).map(|v| (255.0 * v + 0.5).floor() as u8)),
    }
}

/// A small generator (Marsaglia's xorshift), so that failures repeat.
struct Random(u32);

impl Random {
    fn next(&mut self) -> u32 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 17;
        self.0 ^= self.0 << 5;
        self.0
    }

    fn byte(&mut self) -> u8 {
        (self.next() >> 11) as u8
    }

    /// Any four bytes, with the ends of the range more often than chance has them.
    fn bytes(&mut self) -> [u8; 4] {
        std::array::from_fn(|_| match self.next() >> 29 {
            0 => 0,
            1 => 255,
            _ => self.byte(),
        })
    }

    /// Components at most alpha; often equal to it, to zero or to each other.
    fn premultiplied(&mut self) -> [u8; 4] {
        let [r, g, b, a] = self.bytes();
        let scale = |v: u8| (u32::from(v) * u32::from(a) / 255) as u8;
        match self.next() >> 29 {
            0 => [scale(r), scale(r), scale(g), a],
            1 => [scale(r), a / 2, scale(g), a],
            _ => [scale(r), scale(g), scale(b), a],
        }
    }
}

/// Pixels and masks of one block, one by one.
fn pixels(block: &PixelBlock) -> impl Iterator<Item = [u8; 4]> {
    block.as_flattened().as_chunks::<4>().0.iter().copied()
}

fn block_of(mut pixel: impl FnMut() -> [u8; 4]) -> PixelBlock {
    let mut block = [[0; 64]; 8];
    block.as_flattened_mut().as_chunks_mut::<4>().0.fill_with(&mut pixel);
    block
}

fn composite(level: SimdLevel, mode: BlendMode, dst: &PixelBlock, src: &PixelBlock, mask: &MaskBlock) -> PixelBlock {
    let mut out = *dst;
    dispatch!(level, simd => composite_block(simd, mode, &mut out, src, mask));
    out
}

fn random_mask(random: &mut Random) -> MaskBlock {
    let mut mask = [[0; 16]; 8];
    mask.as_flattened_mut().fill_with(|| random.bytes()[0]);
    mask
}

/// Under a full mask every mode is the formula, rounded to nearest: ½ off, and what `f32` adds.
#[test]
fn full_masks_give_the_formula_rounded() {
    for mode in BlendMode::ALL {
        let mut random = Random(0x9e37_79b9);
        for _ in 0..200 {
            let (dst, src) = (block_of(|| random.premultiplied()), block_of(|| random.premultiplied()));
            for level in SimdLevel::available() {
                let out = composite(level, mode, &dst, &src, &[[255; 16]; 8]);
                for ((out, d), s) in pixels(&out).zip(pixels(&dst)).zip(pixels(&src)) {
                    let exact = blend(mode, unit(d), unit(s)).map(|v| 255.0 * v);
                    let error = (0..4).map(|i| (f64::from(out[i]) - exact[i]).abs()).fold(0.0, f64::max);
                    assert!(error < 0.501, "{mode}: {s:?} on {d:?} is {out:?} at {level:?}, not {exact:?}");
                }
            }
        }
    }
}

/// Under any mask every mode is within 1 of the blended colour mixed with the destination.
#[test]
fn partial_masks_mix_within_one() {
    for mode in BlendMode::ALL {
        let mut random = Random(0x1234_5678);
        for _ in 0..200 {
            let (dst, src) = (block_of(|| random.premultiplied()), block_of(|| random.premultiplied()));
            let mask = random_mask(&mut random);
            let out = composite(SimdLevel::best(), mode, &dst, &src, &mask);
            let masks = mask.as_flattened().iter();
            for (((out, d), s), m) in pixels(&out).zip(pixels(&dst)).zip(pixels(&src)).zip(masks) {
                let m = f64::from(*m) / 255.0;
                // The clamp of `Plus` comes after the mask: mixing what is clamped already would be another mode.
                let blended: [f64; 4] = match mode {
                    Plus => std::array::from_fn(|i| (unit(d)[i] + m * unit(s)[i]).min(1.0)),
                    _ => {
                        let full = blend(mode, unit(d), unit(s));
                        std::array::from_fn(|i| unit(d)[i] * (1.0 - m) + full[i] * m)
                    }
                };
                let error = (0..4).map(|i| (f64::from(out[i]) - 255.0 * blended[i]).abs()).fold(0.0, f64::max);
                assert!(error < 1.001, "{mode}: {s:?} on {d:?} by {m} is {out:?}, {error} off");
                assert!(out.iter().all(|v| *v <= out[3]), "{mode}: {s:?} on {d:?} by {m} is {out:?}");
            }
        }
    }
}

/// Any bytes, colour above alpha too: integer modes are the specification to the bit; the others differ by
/// 1 at most, where `f32` rounds a tie's neighbourhood the other way.
#[test]
fn every_mode_is_its_specification_on_any_bytes() {
    for mode in BlendMode::ALL {
        let mut random = Random(0xdead_beef);
        let (mut count, mut different) = (0, 0);
        for _ in 0..200 {
            let (dst, src) = (block_of(|| random.bytes()), block_of(|| random.bytes()));
            let mask = random_mask(&mut random);
            for level in SimdLevel::available() {
                let out = composite(level, mode, &dst, &src, &mask);
                let masks = mask.as_flattened().iter();
                for (((out, d), s), m) in pixels(&out).zip(pixels(&dst)).zip(pixels(&src)).zip(masks) {
                    let expected = composite_pixel(mode, d, s, *m);
                    let error = (0..4).map(|i| out[i].abs_diff(expected[i])).max().unwrap();
                    let limit = u8::from(!INTEGER.contains(&mode));
                    assert!(error <= limit, "{mode}: {s:?} on {d:?} by {m} is {out:?} at {level:?}, not {expected:?}");
                    count += 1;
                    different += u32::from(error > 0);
                }
            }
        }
        assert!(different * 1000 <= count, "{mode}: {different} of {count} differ");
    }
}

#[test]
fn all_levels_give_the_same_bytes() {
    let mut random = Random(0x0bad_cafe);
    for _ in 0..500 {
        let (dst, src) = (block_of(|| random.bytes()), block_of(|| random.bytes()));
        let mask = random_mask(&mut random);
        for mode in BlendMode::ALL {
            let scalar = composite(SimdLevel::Scalar, mode, &dst, &src, &mask);
            for level in SimdLevel::available() {
                assert_eq!(composite(level, mode, &dst, &src, &mask), scalar, "{mode} at {level:?}");
            }
        }
    }
}

#[test]
fn mask_zero_leaves_every_byte() {
    let mut random = Random(0x5eed_0001);
    let (dst, src) = (block_of(|| random.bytes()), block_of(|| random.bytes()));
    for mode in BlendMode::ALL {
        for level in SimdLevel::available() {
            assert_eq!(composite(level, mode, &dst, &src, &[[0; 16]; 8]), dst, "{mode} at {level:?}");
        }
    }
}
