//! Surfaces: pixels, masks, and the blocks in which coverage meets colour.

pub(crate) mod aligned;
pub(crate) mod block;
mod mask;
mod pixmap;

pub(crate) use aligned::allocate;
pub use mask::{Mask, MaskKind};
pub use pixmap::{Limits, Pixmap, PixmapMut, PixmapRef};
