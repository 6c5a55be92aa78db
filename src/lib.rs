//! A CPU canvas for 2D and 3D.

mod blend;
mod canvas;
#[cfg(feature = "codec")]
mod codec;
mod color;
mod display_list;
mod error;
mod filter;
mod geom;
mod num;
mod paint;
mod path;
pub mod raster;
mod render;
mod style;
mod surface;
#[cfg(feature = "svg")]
pub mod svg;

pub use blend::BlendMode;
pub use canvas::{Canvas, SaveGuard, Shadow};
pub use color::Color;
pub use display_list::{ImagePaint, Paint};
pub use error::{Error, Result};
pub use geom::{IntRect, Point, Rect, Transform};
pub use glam;
pub use num::level::SimdLevel;
pub use paint::{
    FilterQuality, GradientStop, LinearGradient, Pattern, RadialGradient, Shader, SpreadMode, SweepGradient,
};
pub use path::{Dash, LineCap, LineJoin, Path, Radii, Segment, Stroke, Verb};
pub use render::RenderSettings;
pub use style::{Antialias, FillRule};
pub use surface::{Limits, Mask, MaskKind, Pixmap, PixmapMut, PixmapRef};
