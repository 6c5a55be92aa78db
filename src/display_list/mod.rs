//! The recording: what a canvas was told to draw, in order.

mod command;
mod paint;

pub(crate) use command::{ClipId, ClipKind, ClipNode, Command, DisplayList, Draw, Geometry, LayerStart, Shadow, Span};
pub use paint::{ImagePaint, Paint};
