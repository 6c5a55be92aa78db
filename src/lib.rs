//! A CPU canvas for 2D and 3D.

mod blend;
#[cfg(feature = "codec")]
mod codec;
mod color;
mod error;
mod geom;
mod num;
mod paint;
mod path;
mod style;
mod surface;

pub use blend::BlendMode;
pub use color::Color;
pub use error::{Error, Result};
pub use geom::{IntRect, Point, Rect, Transform};
pub use glam;
pub use num::level::SimdLevel;
pub use paint::{
    FilterQuality, GradientStop, LinearGradient, Pattern, RadialGradient, Shader, SpreadMode, SweepGradient,
};
pub use path::{Dash, LineCap, LineJoin, Path, Segment, Stroke, Verb};
pub use style::{Antialias, FillRule};
pub use surface::{Limits, Mask, MaskKind, Pixmap, PixmapMut, PixmapRef};
