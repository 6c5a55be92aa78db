//! Blend modes: what becomes of a source pixel over a destination pixel.

mod layer;
mod non_separable;
mod over;
mod porter_duff;
#[cfg(test)]
mod reference;
mod separable;
#[cfg(test)]
mod specification;
mod words;

use std::fmt;
use std::str::FromStr;

use fearless_simd::Simd;

use crate::error::{Error, Result};
use crate::surface::block::{MaskBlock, PixelBlock};
pub(crate) use layer::{multiply_block_by_mask, scale_mask_row, scale_mask_row_by};
pub(crate) use over::{
    OpaqueRow, SolidRun, mix_pixels_row, over_opaque_row, over_pixels_full, over_pixels_row, over_solid_full,
    over_solid_row,
};
use porter_duff::{Operands, composite};
use separable::{composite_components, composite_planes};

/// How a source colour meets what is drawn already.
///
/// The first twelve and `Plus` are the Porter–Duff operators; `Modulate` multiplies component by
/// component; the others are the separable and non-separable modes of the W3C
/// [Compositing and Blending Level 1](https://www.w3.org/TR/compositing-1/), whose sections 9 and 10
/// define all but `Modulate`. Where a shape covers a pixel in part, the result is mixed with the
/// destination by that coverage (`Plus` adds the source scaled by it, and saturates last); pixels that the
/// shape does not touch stay as they are, in every mode.
///
/// In the formulas s and d are premultiplied components of source and destination, sa and da their
/// alphas, Cs = s / sa and Cb = d / da the straight colours, all in 0 ..= 1. Up to `Modulate` a formula
/// gives the result, alpha included. From `Screen` on it gives B(Cb, Cs), and the result is
/// s·(1 − da) + d·(1 − sa) + sa·da·B with alpha sa + da − sa·da. `Lum`, `Sat`, `SetLum` and `SetSat` are
/// the specification's, with Lum = 0.3 R + 0.59 G + 0.11 B.
///
/// Results are rounded to nearest. A component above its alpha counts as equal to it or saturates; it
/// never wraps around.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum BlendMode {
    /// Transparent.
    ///
    /// 0
    Clear,
    /// The source alone.
    ///
    /// s
    Source,
    /// The destination alone.
    ///
    /// d
    Destination,
    /// The source over the destination: the default.
    ///
    /// s + d·(1 − sa)
    #[default]
    SourceOver,
    /// The destination over the source.
    ///
    /// d + s·(1 − da)
    DestinationOver,
    /// The source where the destination is.
    ///
    /// s·da
    SourceIn,
    /// The destination where the source is.
    ///
    /// d·sa
    DestinationIn,
    /// The source where the destination is not.
    ///
    /// s·(1 − da)
    SourceOut,
    /// The destination where the source is not.
    ///
    /// d·(1 − sa)
    DestinationOut,
    /// The source over the destination, inside the destination.
    ///
    /// s·da + d·(1 − sa)
    SourceAtop,
    /// The destination over the source, inside the source.
    ///
    /// d·sa + s·(1 − da)
    DestinationAtop,
    /// Either, where the other is not.
    ///
    /// s·(1 − da) + d·(1 − sa)
    Xor,
    /// The sum, saturating.
    ///
    /// min(1, s + d)
    Plus,
    /// The product of the premultiplied components.
    ///
    /// s·d
    Modulate,
    /// The complement of the product of the complements.
    ///
    /// B = Cb + Cs − Cb·Cs
    Screen,
    /// Multiply or screen, by the destination.
    ///
    /// B = HardLight with Cb and Cs exchanged
    Overlay,
    /// The darker component.
    ///
    /// B = min(Cb, Cs)
    Darken,
    /// The lighter component.
    ///
    /// B = max(Cb, Cs)
    Lighten,
    /// Brightens the destination to reflect the source.
    ///
    /// B = 0 where Cb = 0, else 1 where Cs = 1, else min(1, Cb / (1 − Cs))
    ColorDodge,
    /// Darkens the destination to reflect the source.
    ///
    /// B = 1 where Cb = 1, else 0 where Cs = 0, else 1 − min(1, (1 − Cb) / Cs)
    ColorBurn,
    /// Multiply or screen, by the source.
    ///
    /// B = 2·Cb·Cs where Cs ≤ ½, else 1 − 2·(1 − Cb)·(1 − Cs)
    HardLight,
    /// Darkens or lightens, softly, by the source.
    ///
    /// B = Cb − (1 − 2·Cs)·Cb·(1 − Cb) where Cs ≤ ½, else Cb + (2·Cs − 1)·(D − Cb), with
    /// D = ((16·Cb − 12)·Cb + 4)·Cb where Cb ≤ ¼, else √Cb
    SoftLight,
    /// The absolute difference.
    ///
    /// B = |Cb − Cs|
    Difference,
    /// Like difference, with less contrast.
    ///
    /// B = Cb + Cs − 2·Cb·Cs
    Exclusion,
    /// The product of the colours.
    ///
    /// B = Cb·Cs
    Multiply,
    /// The source's hue with the destination's saturation and luminosity.
    ///
    /// B = SetLum(SetSat(Cs, Sat(Cb)), Lum(Cb))
    Hue,
    /// The source's saturation with the destination's hue and luminosity.
    ///
    /// B = SetLum(SetSat(Cb, Sat(Cs)), Lum(Cb))
    Saturation,
    /// The source's hue and saturation with the destination's luminosity.
    ///
    /// B = SetLum(Cs, Lum(Cb))
    Color,
    /// The source's luminosity with the destination's hue and saturation.
    ///
    /// B = SetLum(Cb, Lum(Cs))
    Luminosity,
}

impl BlendMode {
    /// Every mode, in the order of declaration.
    pub const ALL: [Self; 29] = [
        Self::Clear,
        Self::Source,
        Self::Destination,
        Self::SourceOver,
        Self::DestinationOver,
        Self::SourceIn,
        Self::DestinationIn,
        Self::SourceOut,
        Self::DestinationOut,
        Self::SourceAtop,
        Self::DestinationAtop,
        Self::Xor,
        Self::Plus,
        Self::Modulate,
        Self::Screen,
        Self::Overlay,
        Self::Darken,
        Self::Lighten,
        Self::ColorDodge,
        Self::ColorBurn,
        Self::HardLight,
        Self::SoftLight,
        Self::Difference,
        Self::Exclusion,
        Self::Multiply,
        Self::Hue,
        Self::Saturation,
        Self::Color,
        Self::Luminosity,
    ];

    /// The mode's name in CSS: that of `mix-blend-mode` where it has the mode ("normal" is
    /// [`BlendMode::SourceOver`], "plus-lighter" is [`BlendMode::Plus`]), else that of an HTML canvas's
    /// `globalCompositeOperation` ("copy" is [`BlendMode::Source`]), else the variant's own in the same style.
    /// [`FromStr`] reads it back.
    pub fn name(self) -> &'static str {
        match self {
            Self::Clear => "clear",
            Self::Source => "copy",
            Self::Destination => "destination",
            Self::SourceOver => "normal",
            Self::DestinationOver => "destination-over",
            Self::SourceIn => "source-in",
            Self::DestinationIn => "destination-in",
            Self::SourceOut => "source-out",
            Self::DestinationOut => "destination-out",
            Self::SourceAtop => "source-atop",
            Self::DestinationAtop => "destination-atop",
            Self::Xor => "xor",
            Self::Plus => "plus-lighter",
            Self::Modulate => "modulate",
            Self::Screen => "screen",
            Self::Overlay => "overlay",
            Self::Darken => "darken",
            Self::Lighten => "lighten",
            Self::ColorDodge => "color-dodge",
            Self::ColorBurn => "color-burn",
            Self::HardLight => "hard-light",
            Self::SoftLight => "soft-light",
            Self::Difference => "difference",
            Self::Exclusion => "exclusion",
            Self::Multiply => "multiply",
            Self::Hue => "hue",
            Self::Saturation => "saturation",
            Self::Color => "color",
            Self::Luminosity => "luminosity",
        }
    }
}

impl fmt::Display for BlendMode {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

/// Reads [`BlendMode::name`] and the canvas's other words, "source-over" and "lighter".
///
/// # Errors
/// [`Error::Parameter`] for any other text; upper case is other text, as in SVG attributes.
impl FromStr for BlendMode {
    type Err = Error;

    fn from_str(text: &str) -> Result<Self> {
        match text {
            "source-over" => Ok(Self::SourceOver),
            "lighter" => Ok(Self::Plus),
            _ => Self::ALL
                .into_iter()
                .find(|mode| mode.name() == text)
                .ok_or_else(|| Error::Parameter(format!("{text:?} is no blend mode: \"normal\" is one"))),
        }
    }
}

/// Composites the pixels of `src` onto `dst` by `mode` where `mask` says, as [`BlendMode`] defines.
///
/// Mask 255 gives exactly the blended pixel, rounded; mask 0 leaves the destination's bytes; between, the
/// two are mixed and rounded again, at most 1 off in all.
///
/// Two modes scale the source by the mask instead: source-over, for speed (see [`over_pixels_row`]), and
/// `Plus`, whose clamp must come last. Up to rounding, mixing and scaling are the same in all modes but
/// `Clear`, `Source`, `SourceIn`, `SourceOut`, `DestinationIn`, `DestinationAtop`, `Modulate` and `Plus`;
/// mixing is preferred since a source rounded before it enters a product can be 1½ off.
#[inline(always)]
pub(crate) fn composite_block<S: Simd>(
    simd: S,
    mode: BlendMode,
    dst: &mut PixelBlock,
    src: &PixelBlock,
    mask: &MaskBlock,
) {
    // Every formula goes into a closure that must be inlined: a function handed over as such is called
    // through a shim that lacks the level's instructions, which made these modes ten times slower.
    macro_rules! words {
        ($formula:path) => {
            composite(
                simd,
                dst,
                src,
                mask,
                #[inline(always)]
                |operands| $formula(operands),
            )
        };
    }
    macro_rules! components {
        ($formula:path) => {
            composite_components(
                simd,
                dst,
                src,
                mask,
                #[inline(always)]
                |component| $formula(component),
            )
        };
    }
    macro_rules! planes {
        ($formula:path) => {
            composite_planes(
                simd,
                dst,
                src,
                mask,
                #[inline(always)]
                |d, s| $formula(d, s),
            )
        };
    }
    match mode {
        BlendMode::Destination => {}
        BlendMode::SourceOver => {
            for ((dst, src), mask) in dst.iter_mut().zip(src).zip(mask) {
                over_pixels_row(simd, dst, src, mask);
            }
        }
        BlendMode::Source => {
            for ((dst, src), mask) in dst.iter_mut().zip(src).zip(mask) {
                mix_pixels_row(simd, dst, src, mask);
            }
        }
        BlendMode::Clear => words!(Operands::nothing),
        BlendMode::Plus => porter_duff::plus(simd, dst, src, mask),
        BlendMode::DestinationOver => words!(porter_duff::destination_over),
        BlendMode::SourceIn => words!(porter_duff::source_in),
        BlendMode::DestinationIn => words!(porter_duff::destination_in),
        BlendMode::SourceOut => words!(Operands::source_outside),
        BlendMode::DestinationOut => words!(Operands::destination_outside),
        BlendMode::SourceAtop => words!(porter_duff::source_atop),
        BlendMode::DestinationAtop => words!(porter_duff::destination_atop),
        BlendMode::Xor => words!(Operands::outside),
        BlendMode::Modulate => words!(porter_duff::modulate),
        BlendMode::Multiply => words!(separable::multiply),
        BlendMode::Screen => words!(separable::screen),
        BlendMode::Overlay => words!(separable::overlay),
        BlendMode::Darken => words!(separable::darken),
        BlendMode::Lighten => words!(separable::lighten),
        BlendMode::HardLight => words!(separable::hard_light),
        BlendMode::Difference => words!(separable::difference),
        BlendMode::Exclusion => words!(separable::exclusion),
        BlendMode::ColorDodge => components!(separable::color_dodge),
        BlendMode::ColorBurn => components!(separable::color_burn),
        BlendMode::SoftLight => components!(separable::soft_light),
        BlendMode::Hue => planes!(non_separable::hue),
        BlendMode::Saturation => planes!(non_separable::saturation),
        BlendMode::Color => planes!(non_separable::color),
        BlendMode::Luminosity => planes!(non_separable::luminosity),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_distinct_and_read_back() {
        for mode in BlendMode::ALL {
            assert_eq!(mode.name().parse::<BlendMode>().unwrap(), mode);
        }
        assert_eq!("source-over".parse::<BlendMode>().unwrap(), BlendMode::default());
        assert_eq!("lighter".parse::<BlendMode>().unwrap(), BlendMode::Plus);
        for text in ["", "Normal", "colour", "normal "] {
            assert!(matches!(text.parse::<BlendMode>(), Err(Error::Parameter(_))), "{text:?}");
        }
    }

    #[test]
    fn css_names_are_those_of_the_specification() {
        // W3C Compositing and Blending Level 2, `mix-blend-mode`, in its order.
        let css = [
            "normal",
            "multiply",
            "screen",
            "overlay",
            "darken",
            "lighten",
            "color-dodge",
            "color-burn",
            "hard-light",
            "soft-light",
            "difference",
            "exclusion",
            "hue",
            "saturation",
            "color",
            "luminosity",
            "plus-lighter",
        ];
        for name in css {
            assert_eq!(name.parse::<BlendMode>().unwrap().to_string(), name);
        }
    }
}
