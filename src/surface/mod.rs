//! Surfaces: pixels, masks, and the blocks in which coverage meets colour.

pub(crate) mod block;
mod mask;
mod pixmap;

pub use mask::{Mask, MaskKind};
pub(crate) use pixmap::allocate;
pub use pixmap::{Limits, Pixmap, PixmapMut, PixmapRef};
