//! A shader made ready for fetching pixels.

use std::sync::Arc;

use super::gradient::{Gradient, Placed, place_linear, place_radial, place_sweep};
use super::pattern::ImagePattern;
use super::plane::Affine;
use super::ramp::{Colors, last_color};
use super::shader::{FilterQuality, GradientStop, Pattern, Shader, SpreadMode};
use crate::color::unit;
use crate::geom::Transform;
use crate::surface::Pixmap;

/// A shader in device space. Cheap to clone.
#[derive(Clone, Debug)]
pub(crate) enum PreparedPaint {
    /// Paints nothing: the drawing call has no effect, whatever its blend mode.
    Nothing,
    /// The same premultiplied pixel everywhere, transparent ones included.
    Solid([u8; 4]),
    /// A gradient of any kind.
    Gradient(Arc<Gradient>),
    /// An image.
    Pattern(Arc<ImagePattern>),
}

impl PreparedPaint {
    /// `shader` under `transform` (user to device space), its alpha multiplied by `opacity` (0 ..= 1; values
    /// outside are clamped, NaN is 0).
    pub(crate) fn new(shader: &Shader, transform: Transform, opacity: f32) -> Self {
        let opacity = unit(opacity);
        let to_device = |own: Transform| Affine::from(own).then(Affine::from(transform));
        match shader {
            Shader::Solid(color) => Self::Solid(color.with_opacity(opacity).premultiply()),
            Shader::LinearGradient(gradient) => {
                let placed = place_linear(gradient, to_device(gradient.transform));
                Self::from_gradient(placed, &gradient.stops, gradient.spread, opacity)
            }
            Shader::RadialGradient(gradient) => {
                let placed = place_radial(gradient, to_device(gradient.transform));
                Self::from_gradient(placed, &gradient.stops, gradient.spread, opacity)
            }
            Shader::SweepGradient(gradient) => {
                let placed = place_sweep(gradient, to_device(gradient.transform));
                // Once all around there is no outside, and the seam must not be folded to the other end.
                let whole = gradient.end_angle - gradient.start_angle >= 360.0;
                let spread = if whole { SpreadMode::Pad } else { gradient.spread };
                Self::from_gradient(placed, &gradient.stops, spread, opacity)
            }
            Shader::Pattern(pattern) => match ImagePattern::new(pattern, to_device(pattern.transform), opacity) {
                Some(image) => Self::Pattern(Arc::new(image)),
                None => Self::Nothing,
            },
        }
    }

    /// A picture that was drawn for this place, transparent around it: at whole pixels, a copy.
    pub(crate) fn picture(image: Arc<Pixmap>, to_device: Transform, opacity: f32) -> Self {
        let mut pattern = Pattern::new(image);
        pattern.quality = FilterQuality::Bilinear;
        (pattern.spread_x, pattern.spread_y) = (SpreadMode::Decal, SpreadMode::Decal);
        Self::new(&pattern.into(), to_device, opacity)
    }

    fn from_gradient(placed: Placed, stops: &[GradientStop], spread: SpreadMode, opacity: f32) -> Self {
        match placed {
            Placed::Nothing => Self::Nothing,
            Placed::LastColor => last_color(stops, opacity).map_or(Self::Nothing, Self::Solid),
            Placed::At(placement) => match Colors::new(stops, spread, opacity, placement.geometry.has_holes()) {
                Colors::None => Self::Nothing,
                Colors::Constant(pixel) => Self::Solid(pixel),
                Colors::Ramp(ramp) => Self::Gradient(Arc::new(Gradient::new(placement, ramp))),
            },
        }
    }

    /// Whether every pixel it gives has alpha 255, so that nothing beneath shows through.
    pub(crate) fn is_opaque(&self) -> bool {
        match self {
            Self::Nothing => false,
            Self::Solid(pixel) => pixel[3] == 255,
            Self::Gradient(gradient) => gradient.is_opaque(),
            Self::Pattern(pattern) => pattern.is_opaque(),
        }
    }
}
