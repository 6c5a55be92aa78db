//! Colours, straight and premultiplied.

use crate::num::lanes::div255;

/// A colour with straight alpha: components in 0 ..= 1, in the canvas's own space (sRGB as stored; the
/// canvas blends the stored values, as web browsers do).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Color {
    /// Red.
    pub r: f32,
    /// Green.
    pub g: f32,
    /// Blue.
    pub b: f32,
    /// Alpha: 0 is transparent, 1 opaque.
    pub a: f32,
}

impl Color {
    /// Transparent black.
    pub const TRANSPARENT: Self = Self::from_rgba(0.0, 0.0, 0.0, 0.0);
    /// Opaque black.
    pub const BLACK: Self = Self::from_rgba(0.0, 0.0, 0.0, 1.0);
    /// Opaque white.
    pub const WHITE: Self = Self::from_rgba(1.0, 1.0, 1.0, 1.0);
    /// Opaque red.
    pub const RED: Self = Self::from_rgba(1.0, 0.0, 0.0, 1.0);
    /// Opaque green at full intensity (CSS `lime`).
    pub const GREEN: Self = Self::from_rgba(0.0, 1.0, 0.0, 1.0);
    /// Opaque blue.
    pub const BLUE: Self = Self::from_rgba(0.0, 0.0, 1.0, 1.0);

    /// The colour with the given components, which are not checked: values outside 0 ..= 1 are clamped
    /// and NaN is 0 where the colour is used.
    pub const fn from_rgba(r: f32, g: f32, b: f32, a: f32) -> Self {
        Self { r, g, b, a }
    }

    /// The colour with the given components in 0 ..= 255.
    pub fn from_rgba8(r: u8, g: u8, b: u8, a: u8) -> Self {
        let unit = |v: u8| f32::from(v) / 255.0;
        Self::from_rgba(unit(r), unit(g), unit(b), unit(a))
    }

    /// The opaque colour with the given components in 0 ..= 255.
    pub fn from_rgb8(r: u8, g: u8, b: u8) -> Self {
        Self::from_rgba8(r, g, b, 255)
    }

    /// The same colour with its alpha multiplied by `opacity`.
    #[must_use]
    #[inline]
    pub fn with_opacity(self, opacity: f32) -> Self {
        Self { a: unit(self.a) * unit(opacity), ..self }
    }

    /// The straight components in 0 ..= 255, rounded to nearest.
    pub fn to_rgba8(self) -> [u8; 4] {
        [self.r, self.g, self.b, self.a].map(to_u8)
    }

    /// The premultiplied components in 0 ..= 255: each is rounded once, after the multiplication.
    #[inline]
    pub fn premultiply(self) -> [u8; 4] {
        let a = unit(self.a);
        [unit(self.r) * a, unit(self.g) * a, unit(self.b) * a, a].map(byte)
    }
}

/// `v` clamped to 0 ..= 1; NaN is 0.
pub(crate) fn unit(v: f32) -> f32 {
    if v > 0.0 { if v < 1.0 { v } else { 1.0 } } else { 0.0 }
}

fn to_u8(v: f32) -> u8 {
    byte(unit(v))
}

/// `v`, in 0 ..= 1, in 0 ..= 255.
fn byte(v: f32) -> u8 {
    // Of a sum with 2^20 the whole part lies above 32 bits of fraction: nothing to be checked, as a cast does.
    ((f64::from(v * 255.0 + 0.5) + 1_048_576.0).to_bits() >> 32) as u8
}

/// Straight to premultiplied, rounded to nearest.
pub(crate) fn premultiply_u8([r, g, b, a]: [u8; 4]) -> [u8; 4] {
    let scale = |v: u8| div255(u32::from(v) * u32::from(a)) as u8;
    [scale(r), scale(g), scale(b), a]
}

/// Premultiplied to straight, rounded to nearest; transparent pixels become 0, 0, 0, 0.
pub(crate) fn demultiply_u8([r, g, b, a]: [u8; 4]) -> [u8; 4] {
    if a == 255 {
        return [r, g, b, a];
    }
    if a == 0 {
        return [0; 4];
    }
    let alpha = u32::from(a);
    let divide = |v: u8| ((u32::from(v) * 255 + alpha / 2) / alpha).min(255) as u8;
    [divide(r), divide(g), divide(b), a]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn opaque_colours_survive_both_ways() {
        for v in 0..=255 {
            assert_eq!(premultiply_u8([v, 0, 255, 255]), [v, 0, 255, 255]);
            assert_eq!(Color::from_rgba8(v, v, v, 255).premultiply(), [v, v, v, 255]);
            assert_eq!(Color::from_rgba8(v, v, v, v).to_rgba8(), [v; 4]);
        }
    }

    #[test]
    fn components_are_rounded_to_the_nearest_byte() {
        // Around each boundary, and all over the range.
        let near = (0..=255_u32).flat_map(|byte| {
            let boundary = ((byte as f32 + 0.5) / 255.0).to_bits();
            (boundary - 40..boundary + 40).map(f32::from_bits)
        });
        for v in near.chain((0..=1_000_000).map(|i| i as f32 / 1e6)).chain([0.0, f32::MIN_POSITIVE, 1.0]) {
            if v <= 1.0 {
                assert_eq!(byte(v), (v * 255.0 + 0.5).floor() as u8, "{v}");
            }
        }
    }

    #[test]
    fn demultiply_inverts_premultiply_where_it_can() {
        for a in 1..=255_u8 {
            for v in 0..=a {
                // A premultiplied pixel goes to straight and back unchanged.
                let straight = demultiply_u8([v, v, v, a]);
                assert_eq!(premultiply_u8(straight), [v, v, v, a], "{v} {a}");
            }
        }
    }

    #[test]
    fn nan_and_out_of_range_components_are_defined() {
        assert_eq!(Color::from_rgba(f32::NAN, 2.0, -1.0, 1.0).premultiply(), [0, 255, 0, 255]);
        assert_eq!(Color::RED.with_opacity(f32::NAN).premultiply(), [0; 4]);
    }
}
