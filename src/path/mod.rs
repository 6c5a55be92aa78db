//! Paths: lines and Bézier curves, and what is made of them.

mod builder;
pub(crate) mod flatten;
mod stroke_style;

pub use builder::{Path, Segment, Verb};
pub use stroke_style::{Dash, LineCap, LineJoin, Stroke};
