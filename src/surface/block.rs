//! The seam between coverage and colour: blocks of 16 × 8 pixels.
//!
//! A rasterizer says how much of each pixel is covered ([`MaskBlock`]), a paint gives colours
//! ([`PixelBlock`]), and blending joins the two with what is there. Neither side knows the other.

/// Columns of a block.
pub(crate) const BLOCK_WIDTH: usize = 16;
/// Rows of a block; also the rows of a strip, the rasterizer's unit of work.
pub(crate) const BLOCK_HEIGHT: usize = 8;

/// Coverage of a block, rows top down, 0 (outside) ..= 255 (covered).
pub(crate) type MaskBlock = [[u8; BLOCK_WIDTH]; BLOCK_HEIGHT];

/// Premultiplied RGBA8 pixels of a block, rows top down.
pub(crate) type PixelBlock = [[u8; BLOCK_WIDTH * 4]; BLOCK_HEIGHT];
