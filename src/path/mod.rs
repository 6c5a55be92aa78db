//! Paths: lines and Bézier curves, and what is made of them.

mod builder;
mod curve;
mod dash;
mod far;
pub(crate) mod flatten;
mod hit;
mod known;
mod measure;
mod outline;
pub(crate) mod polygons;
pub(crate) mod round_rect;
mod shapes;
mod steps;
pub(crate) mod stretch;
pub(crate) mod stroke;
mod stroke_style;
#[cfg(feature = "svg")]
mod svg_data;

pub use builder::{Path, Segment, Verb};
pub(crate) use known::Outline;
pub use shapes::Radii;
pub use stroke_style::{Dash, LineCap, LineJoin, Stroke};
