//! The paint of a drawing call: what colour, how it blends, how edges are treated.

use crate::blend::BlendMode;
use crate::color::Color;
use crate::paint::{FilterQuality, LinearGradient, Pattern, RadialGradient, Shader, SweepGradient};
use crate::style::Antialias;

/// How a shape is coloured.
///
/// Every drawing call takes `impl Into<Paint>`: a [`Color`] or a gradient will do where the defaults
/// suit.
#[derive(Clone, Debug)]
pub struct Paint {
    /// What colour each pixel gets. The default is opaque black.
    pub shader: Shader,
    /// What the shader's alpha is multiplied by, in 0 ..= 1. The default is 1.
    pub opacity: f32,
    /// How the colour meets what is there. The default is [`BlendMode::SourceOver`].
    pub blend_mode: BlendMode,
    /// How partly covered pixels are drawn. The default is [`Antialias::Analytic`].
    pub antialias: Antialias,
}

impl Default for Paint {
    fn default() -> Self {
        Self::new(Color::BLACK)
    }
}

impl Paint {
    /// A paint with the given shader and the defaults for the rest.
    pub fn new(shader: impl Into<Shader>) -> Self {
        Self { shader: shader.into(), opacity: 1.0, blend_mode: BlendMode::SourceOver, antialias: Antialias::Analytic }
    }

    /// The same with the given opacity.
    #[must_use]
    pub fn with_opacity(self, opacity: f32) -> Self {
        Self { opacity, ..self }
    }

    /// The same with the given blend mode.
    #[must_use]
    pub fn with_blend_mode(self, blend_mode: BlendMode) -> Self {
        Self { blend_mode, ..self }
    }

    /// The same with the given treatment of edges.
    #[must_use]
    pub fn with_antialias(self, antialias: Antialias) -> Self {
        Self { antialias, ..self }
    }
}

impl From<&Paint> for Paint {
    fn from(paint: &Paint) -> Self {
        paint.clone()
    }
}

impl From<Shader> for Paint {
    fn from(shader: Shader) -> Self {
        Self::new(shader)
    }
}

impl From<Color> for Paint {
    fn from(color: Color) -> Self {
        Self::new(color)
    }
}

impl From<LinearGradient> for Paint {
    fn from(gradient: LinearGradient) -> Self {
        Self::new(gradient)
    }
}

impl From<RadialGradient> for Paint {
    fn from(gradient: RadialGradient) -> Self {
        Self::new(gradient)
    }
}

impl From<SweepGradient> for Paint {
    fn from(gradient: SweepGradient) -> Self {
        Self::new(gradient)
    }
}

impl From<Pattern> for Paint {
    fn from(pattern: Pattern) -> Self {
        Self::new(pattern)
    }
}

/// How an image is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ImagePaint {
    /// How it is sampled between its pixels. The default is [`FilterQuality::Bilinear`].
    pub quality: FilterQuality,
    /// What its alpha is multiplied by, in 0 ..= 1. The default is 1.
    pub opacity: f32,
    /// How it meets what is there. The default is [`BlendMode::SourceOver`].
    pub blend_mode: BlendMode,
    /// How its edges are drawn. The default is [`Antialias::Analytic`].
    pub antialias: Antialias,
}

impl Default for ImagePaint {
    fn default() -> Self {
        Self {
            quality: FilterQuality::Bilinear,
            opacity: 1.0,
            blend_mode: BlendMode::SourceOver,
            antialias: Antialias::Analytic,
        }
    }
}
