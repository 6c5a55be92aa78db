//! Paths: lines and Bézier curves, and what is made of them.

mod builder;
mod curve;
mod dash;
pub(crate) mod flatten;
pub(crate) mod stroke;
mod stroke_style;

pub use builder::{Path, Segment, Verb};
pub use stroke_style::{Dash, LineCap, LineJoin, Stroke};
