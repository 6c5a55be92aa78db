//! Blend modes: what becomes of a source pixel over a destination pixel.

/// How a source colour meets what is drawn already.
///
/// The first twelve and `Plus` are the Porter–Duff operators; `Modulate` multiplies component by
/// component; the others are the separable and non-separable modes of the W3C Compositing and Blending
/// specification. Where a shape covers a pixel in part, the result is mixed with the destination by that
/// coverage; pixels that the shape does not touch stay as they are, in every mode.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum BlendMode {
    /// Transparent.
    Clear,
    /// The source alone.
    Source,
    /// The destination alone.
    Destination,
    /// The source over the destination: the default.
    #[default]
    SourceOver,
    /// The destination over the source.
    DestinationOver,
    /// The source where the destination is.
    SourceIn,
    /// The destination where the source is.
    DestinationIn,
    /// The source where the destination is not.
    SourceOut,
    /// The destination where the source is not.
    DestinationOut,
    /// The source over the destination, inside the destination.
    SourceAtop,
    /// The destination over the source, inside the source.
    DestinationAtop,
    /// Either, where the other is not.
    Xor,
    /// The sum, saturating.
    Plus,
    /// The product of the premultiplied components.
    Modulate,
    /// The complement of the product of the complements.
    Screen,
    /// Multiply or screen, by the destination.
    Overlay,
    /// The darker component.
    Darken,
    /// The lighter component.
    Lighten,
    /// Brightens the destination to reflect the source.
    ColorDodge,
    /// Darkens the destination to reflect the source.
    ColorBurn,
    /// Multiply or screen, by the source.
    HardLight,
    /// Darkens or lightens, softly, by the source.
    SoftLight,
    /// The absolute difference.
    Difference,
    /// Like difference, with less contrast.
    Exclusion,
    /// The product of the colours.
    Multiply,
    /// The source's hue with the destination's saturation and luminosity.
    Hue,
    /// The source's saturation with the destination's hue and luminosity.
    Saturation,
    /// The source's hue and saturation with the destination's luminosity.
    Color,
    /// The source's luminosity with the destination's hue and saturation.
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
}
