//! The paint of a drawing call: what colour, how it blends, how edges are treated.

use std::borrow::Cow;

use crate::blend::BlendMode;
use crate::color::Color;
use crate::paint::{FilterQuality, LinearGradient, Pattern, RadialGradient, Shader, SweepGradient};
use crate::style::Antialias;

/// How a shape is coloured.
///
/// Drawing calls take whatever is [`ToPaint`]: a [`Color`] or a gradient will do where the defaults suit.
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

/// What a drawing call takes as its paint: a [`Color`], a gradient, a [`Pattern`] or a [`Shader`] where the other defaults
/// suit, a [`Paint`], or a reference to any of them. A reference to a paint is read where it is.
///
/// ```
/// use rastrum::{Canvas, Color, Paint, Rect};
///
/// let mut canvas = Canvas::new(8, 8)?;
/// let paint = Paint::new(Color::RED).with_opacity(0.5);
/// canvas.fill_rect(Rect::from_xywh(0.0, 0.0, 4.0, 4.0), &paint);
/// canvas.fill_rect(Rect::from_xywh(4.0, 4.0, 4.0, 4.0), Color::BLUE);
/// let picture = canvas.into_pixmap();
/// assert_eq!((picture.pixel(1, 1), picture.pixel(6, 6)), (Some([128, 0, 0, 128]), Some([0, 0, 255, 255])));
/// # Ok::<(), rastrum::Error>(())
/// ```
pub trait ToPaint {
    /// The paint.
    fn to_paint(&self) -> Cow<'_, Paint>;
}

impl ToPaint for Paint {
    fn to_paint(&self) -> Cow<'_, Paint> {
        Cow::Borrowed(self)
    }
}

impl<T: ToPaint + ?Sized> ToPaint for &T {
    fn to_paint(&self) -> Cow<'_, Paint> {
        (**self).to_paint()
    }
}

macro_rules! paint_from {
    ($($shader:ty),*) => {
        $(
            impl From<$shader> for Paint {
                fn from(shader: $shader) -> Self {
                    Self::new(shader)
                }
            }

            impl ToPaint for $shader {
                fn to_paint(&self) -> Cow<'_, Paint> {
                    Cow::Owned(Paint::new(self.clone()))
                }
            }
        )*
    };
}

paint_from!(Shader, Color, LinearGradient, RadialGradient, SweepGradient, Pattern);

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
