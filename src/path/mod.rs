//! Paths: lines and Bézier curves, and what is made of them.

mod builder;
mod stroke_style;
pub(crate) mod flatten;

pub use builder::{Path, Segment, Verb};
pub use stroke_style::{Dash, LineCap, LineJoin, Stroke};
