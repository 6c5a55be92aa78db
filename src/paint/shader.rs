//! The kinds of paint, as callers describe them.

use std::sync::Arc;

use crate::color::Color;
use crate::geom::{Point, Transform};
use crate::surface::Pixmap;

/// What colour each pixel of a shape gets.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub enum Shader {
    /// One colour.
    Solid(Color),
    /// Colours along a line.
    LinearGradient(LinearGradient),
    /// Colours between two circles.
    RadialGradient(RadialGradient),
    /// Colours around a point.
    SweepGradient(SweepGradient),
    /// An image, repeated or not.
    Pattern(Pattern),
}

/// One colour of a gradient.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GradientStop {
    /// Where, in 0 ..= 1; values outside are clamped, NaN is 0, and a value below its predecessor's
    /// is raised to it.
    pub position: f32,
    /// The colour there. Between stops, straight components are interpolated, then premultiplied.
    pub color: Color,
}

impl GradientStop {
    /// A colour at a position.
    pub const fn new(position: f32, color: Color) -> Self {
        Self { position, color }
    }
}

/// What a gradient shows before its first and after its last stop, and a pattern beyond its edges.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum SpreadMode {
    /// The nearest end's colour goes on: the default.
    #[default]
    Pad,
    /// Starts again from the other end.
    Repeat,
    /// Runs back and forth.
    Reflect,
    /// Transparent.
    Decal,
}

/// Colours along the line from `start` to `end`, constant across it.
///
/// No stop paints nothing; one stop paints its colour everywhere; so does a line of length 0, with
/// the last stop's colour.
#[derive(Clone, Debug)]
pub struct LinearGradient {
    /// Where position 0 lies, in user space.
    pub start: Point,
    /// Where position 1 lies, in user space.
    pub end: Point,
    /// The colours, by position.
    pub stops: Arc<[GradientStop]>,
    /// What lies outside 0 ..= 1.
    pub spread: SpreadMode,
    /// From the gradient's space to user space. A singular one paints nothing.
    pub transform: Transform,
}

/// Colours between two circles: position 0 on the first, 1 on the second, as on an HTML canvas.
///
/// Of the circles through a pixel the one with the largest position and a radius ≥ 0 counts; a pixel on none
/// is transparent. Negative or non-finite radii and two equal circles paint nothing.
#[derive(Clone, Debug)]
pub struct RadialGradient {
    /// The first circle's centre (SVG: `fx`, `fy`).
    pub start_center: Point,
    /// The first circle's radius (SVG: `fr`).
    pub start_radius: f32,
    /// The second circle's centre.
    pub end_center: Point,
    /// The second circle's radius.
    pub end_radius: f32,
    /// The colours, by position.
    pub stops: Arc<[GradientStop]>,
    /// What lies outside 0 ..= 1.
    pub spread: SpreadMode,
    /// From the gradient's space to user space. A singular one paints nothing.
    pub transform: Transform,
}

/// Colours around a point, clockwise on the canvas from the positive x axis.
///
/// An angle and the same a whole turn on are one direction. The one in 0° .. 360° counts where it lies
/// between `start_angle` and `end_angle`, else the one a turn more or less that does; where none does, the
/// position is outside 0 ..= 1. A range of 360° or more has no outside.
#[derive(Clone, Debug)]
pub struct SweepGradient {
    /// The point.
    pub center: Point,
    /// The angle of position 0, in degrees.
    pub start_angle: f32,
    /// The angle of position 1, in degrees; not above `start_angle` paints nothing.
    pub end_angle: f32,
    /// The colours, by position.
    pub stops: Arc<[GradientStop]>,
    /// What lies outside 0 ..= 1.
    pub spread: SpreadMode,
    /// From the gradient's space to user space. A singular one paints nothing.
    pub transform: Transform,
}

/// How an image is sampled between its pixels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum FilterQuality {
    /// The nearest pixel.
    Nearest,
    /// Linear between the four nearest pixels: the default.
    #[default]
    Bilinear,
    /// Cubic over the sixteen nearest pixels (Mitchell–Netravali, B = C = ⅓).
    Bicubic,
}

/// An image as a paint. Its pixel (0, 0) covers the unit square at the origin of the pattern's space.
#[derive(Clone, Debug)]
pub struct Pattern {
    /// The image.
    pub image: Arc<Pixmap>,
    /// How it is sampled.
    pub quality: FilterQuality,
    /// What lies beyond its left and right edges.
    pub spread_x: SpreadMode,
    /// What lies beyond its top and bottom edges.
    pub spread_y: SpreadMode,
    /// From the image's pixels to user space. A singular one paints nothing.
    pub transform: Transform,
}

impl From<Color> for Shader {
    fn from(color: Color) -> Self {
        Self::Solid(color)
    }
}

impl From<LinearGradient> for Shader {
    fn from(gradient: LinearGradient) -> Self {
        Self::LinearGradient(gradient)
    }
}

impl From<RadialGradient> for Shader {
    fn from(gradient: RadialGradient) -> Self {
        Self::RadialGradient(gradient)
    }
}

impl From<SweepGradient> for Shader {
    fn from(gradient: SweepGradient) -> Self {
        Self::SweepGradient(gradient)
    }
}

impl From<Pattern> for Shader {
    fn from(pattern: Pattern) -> Self {
        Self::Pattern(pattern)
    }
}

impl LinearGradient {
    /// A padded gradient from `start` to `end`.
    pub fn new(start: impl Into<Point>, end: impl Into<Point>, stops: impl Into<Arc<[GradientStop]>>) -> Self {
        Self {
            start: start.into(),
            end: end.into(),
            stops: stops.into(),
            spread: SpreadMode::Pad,
            transform: Transform::IDENTITY,
        }
    }

    /// The same gradient with `spread` outside 0 ..= 1.
    #[must_use]
    pub fn with_spread(mut self, spread: SpreadMode) -> Self {
        self.spread = spread;
        self
    }

    /// The same gradient with `transform` from its own space to user space, in place of what it had.
    #[must_use]
    pub fn with_transform(mut self, transform: Transform) -> Self {
        self.transform = transform;
        self
    }
}

impl RadialGradient {
    /// A padded gradient from the centre of a circle to its rim.
    pub fn new(center: impl Into<Point>, radius: f32, stops: impl Into<Arc<[GradientStop]>>) -> Self {
        let center = center.into();
        Self::two_point(center, 0.0, center, radius, stops)
    }

    /// A padded gradient from one circle to another.
    pub fn two_point(
        start_center: impl Into<Point>,
        start_radius: f32,
        end_center: impl Into<Point>,
        end_radius: f32,
        stops: impl Into<Arc<[GradientStop]>>,
    ) -> Self {
        Self {
            start_center: start_center.into(),
            start_radius,
            end_center: end_center.into(),
            end_radius,
            stops: stops.into(),
            spread: SpreadMode::Pad,
            transform: Transform::IDENTITY,
        }
    }

    /// The same gradient with `spread` outside 0 ..= 1.
    #[must_use]
    pub fn with_spread(mut self, spread: SpreadMode) -> Self {
        self.spread = spread;
        self
    }

    /// The same gradient with `transform` from its own space to user space, in place of what it had.
    #[must_use]
    pub fn with_transform(mut self, transform: Transform) -> Self {
        self.transform = transform;
        self
    }
}

impl SweepGradient {
    /// A gradient once around `center`, from 0° to 360°.
    pub fn new(center: impl Into<Point>, stops: impl Into<Arc<[GradientStop]>>) -> Self {
        Self {
            center: center.into(),
            start_angle: 0.0,
            end_angle: 360.0,
            stops: stops.into(),
            spread: SpreadMode::Pad,
            transform: Transform::IDENTITY,
        }
    }

    /// The same gradient from `start_angle` (position 0) to `end_angle` (position 1), in degrees.
    #[must_use]
    pub fn with_angles(mut self, start_angle: f32, end_angle: f32) -> Self {
        self.start_angle = start_angle;
        self.end_angle = end_angle;
        self
    }

    /// The same gradient with `spread` outside 0 ..= 1.
    #[must_use]
    pub fn with_spread(mut self, spread: SpreadMode) -> Self {
        self.spread = spread;
        self
    }

    /// The same gradient with `transform` from its own space to user space, in place of what it had.
    #[must_use]
    pub fn with_transform(mut self, transform: Transform) -> Self {
        self.transform = transform;
        self
    }
}

impl Pattern {
    /// A repeated image with bilinear sampling.
    pub fn new(image: impl Into<Arc<Pixmap>>) -> Self {
        Self {
            image: image.into(),
            quality: FilterQuality::Bilinear,
            spread_x: SpreadMode::Repeat,
            spread_y: SpreadMode::Repeat,
            transform: Transform::IDENTITY,
        }
    }

    /// The same pattern sampled with `quality`.
    #[must_use]
    pub fn with_quality(mut self, quality: FilterQuality) -> Self {
        self.quality = quality;
        self
    }

    /// The same pattern with `spread` beyond all four edges; set the fields for one of each axis.
    #[must_use]
    pub fn with_spread(mut self, spread: SpreadMode) -> Self {
        self.spread_x = spread;
        self.spread_y = spread;
        self
    }

    /// The same pattern with `transform` from the image's pixels to user space, in place of what it had.
    #[must_use]
    pub fn with_transform(mut self, transform: Transform) -> Self {
        self.transform = transform;
        self
    }
}
