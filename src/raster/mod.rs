//! Which pixels a shape covers, without a canvas: for callers with a grid of their own.
//!
//! Everything here is integer arithmetic and exact to the pixel. Shapes of whole pixels (lines,
//! outlines, circles) are iterators of `(x, y)`; filled shapes are spans `(y, x_start..x_end)`. A point
//! `(x, y)` of integers *is* the pixel with that address, so lines run from pixel centre to pixel
//! centre; a [`Point`](crate::Point) is a place in pixels, y down, with pixel centres at .5.
//!
//! ```
//! use rastrum::raster::line::bresenham;
//!
//! let mut grid = [[b'.'; 8]; 3];
//! for (x, y) in bresenham((0, 0), (7, 2)) {
//!     grid[y as usize][x as usize] = b'#';
//! }
//! assert_eq!(grid, [*b"##......", *b"..####..", *b"......##"]);
//! ```

pub(crate) mod bar;
pub(crate) mod batch;
pub(crate) mod bins;
mod boxes;
pub(crate) mod cell;
pub mod circle;
mod cut;
pub(crate) mod edge;
pub(crate) mod exact;
pub(crate) mod kernel;
pub mod line;
mod orientation;
pub mod polygon;
pub(crate) mod rect;
pub(crate) mod round_rect;
pub(crate) mod sample;
mod stair;
mod star;
pub(crate) mod sweep;
pub mod triangulate;
