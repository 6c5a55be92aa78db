//! Points, rectangles and affine transforms.

mod point;
mod rect;
mod transform;

pub use point::Point;
pub(crate) use rect::FixedRect;
pub use rect::{IntRect, Rect};
pub use transform::Transform;
