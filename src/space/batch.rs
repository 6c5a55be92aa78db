//! The queue between coverage and shading: triangles, and the rows of eight pixels of them that are to be shaded.
//!
//! Traversal is compiled once and knows no shader; shading is compiled once for each shader and knows no edges. They meet here, a
//! thousand rows at a time, so that the call between them costs nothing.

use super::setup::Gradients;

/// Rows of eight pixels that a batch holds.
pub(crate) const GROUPS: usize = 1024;
/// Triangles that a batch holds.
pub(crate) const TRIANGLES: usize = 256;

/// A primitive that was set up.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BatchTriangle {
    /// The vertices that its planes go through.
    pub(crate) vertices: [u32; 3],
    pub(crate) primitive: u32,
    /// Which piece of the primitive it is, where clipping cut it.
    pub(crate) piece: u8,
    pub(crate) front: bool,
    /// Whether clipping made its vertices; see [`Kind::Clipped`](super::bin::Kind::Clipped).
    pub(crate) clipped: bool,
    pub(crate) gradients: Gradients,
    /// Depth: value at the first vertex, steps right and down.
    pub(crate) z: [f32; 3],
    /// 1 / w likewise.
    pub(crate) inverse_w: [f32; 3],
}

/// Up to eight pixels of one row of one tile that one triangle covers, or the whole tile.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Group {
    /// The first pixel, a multiple of 8.
    pub(crate) x: u16,
    pub(crate) y: u16,
    pub(crate) triangle: u16,
    /// One bit a pixel and sample: bit 8·s + i is pixel i's sample s; samples 8 to 15 are in the second. All bits of the first, with
    /// one sample a pixel, stand for all rows of a tile; see [`Traversal`](super::traverse::Traversal).
    pub(crate) masks: [u64; 2],
}

impl Group {
    /// Whether a group of a target with one sample a pixel is a whole tile.
    #[inline(always)]
    pub(crate) fn is_tile(&self) -> bool {
        self.masks[0] == !0
    }

    /// The pixels with any sample.
    #[inline(always)]
    pub(crate) fn pixels(&self) -> u8 {
        let all = self.masks[0] | self.masks[1];
        let all = all | all >> 32;
        let all = all | all >> 16;
        (all | all >> 8) as u8
    }
}

/// See the module.
#[derive(Debug)]
pub(crate) struct Batch {
    pub(crate) triangles: Vec<BatchTriangle>,
    pub(crate) groups: Vec<Group>,
}

impl Batch {
    pub(crate) fn new() -> Self {
        Self { triangles: Vec::with_capacity(TRIANGLES), groups: Vec::with_capacity(GROUPS) }
    }

    pub(crate) fn clear(&mut self) {
        self.triangles.clear();
        self.groups.clear();
    }
}
