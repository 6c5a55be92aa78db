//! The recording: what a canvas was told to draw, in order.

mod command;
mod paint;

pub(crate) use command::{
    ClipId, ClipKind, ClipNode, Command, DisplayList, Draw, Effect, EffectKind, Geometry, LayerStart, PaintRef, Span,
};
pub use paint::{ImagePaint, Paint, ToPaint};
