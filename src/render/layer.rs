//! Open layers: the pixels that are drawn on until the layer ends.

use fearless_simd::Simd;

use super::band::Frame;
use super::surface::{ROW_BYTES, Surface};
use crate::blend::multiply_block_by_mask;
use crate::geom::IntRect;
use crate::surface::MaskKind;
use crate::surface::block::{BLOCK_HEIGHT, BLOCK_WIDTH, MaskBlock};

/// The pixels of an open layer in this band. They take memory from the first draw on: layers that only hold
/// layers can be as deep as anyone likes.
#[derive(Debug, Default)]
pub(super) struct LayerBuffer {
    data: Vec<u8>,
    first_block: usize,
    blocks: usize,
}

impl LayerBuffer {
    pub(super) fn reset(&mut self, bounds: IntRect) {
        self.first_block = bounds.left.max(0) as usize / BLOCK_WIDTH;
        self.blocks = (bounds.right.max(0) as usize).div_ceil(BLOCK_WIDTH).saturating_sub(self.first_block);
        self.data.clear();
    }

    /// Whether nothing was drawn on it.
    pub(super) fn is_untouched(&self) -> bool {
        self.data.is_empty()
    }

    pub(super) fn surface(&mut self, rows: usize) -> Surface<'_> {
        self.data.resize(self.blocks * ROW_BYTES * rows, 0);
        let width = self.blocks * BLOCK_WIDTH;
        Surface::new(&mut self.data, width * 4, self.first_block, width, rows)
    }
}

/// The rows to draw on: those of the innermost open layer, or the target's.
#[inline(always)]
pub(super) fn open_surface<'a>(
    frame: &Frame<'_>,
    target: &'a mut Surface<'_>,
    layers: &'a mut [LayerBuffer],
) -> Surface<'a> {
    match layers.last_mut() {
        Some(layer) => layer.surface(frame.rows),
        None => target.reborrow(),
    }
}

/// Multiplies a layer by what was drawn as its mask.
#[inline(never)]
pub(super) fn mask_layer<S: Simd>(
    simd: S,
    frame: &Frame<'_>,
    layer: &mut LayerBuffer,
    mask: &mut LayerBuffer,
    bounds: IntRect,
    kind: MaskKind,
) {
    simd.vectorize(
        #[inline(always)]
        || mask_layer_inner(simd, frame, layer, mask, bounds, kind),
    )
}

#[inline(always)]
fn mask_layer_inner<S: Simd>(
    simd: S,
    frame: &Frame<'_>,
    layer: &mut LayerBuffer,
    mask: &mut LayerBuffer,
    bounds: IntRect,
    kind: MaskKind,
) {
    let (first, last) = (layer.first_block, layer.first_block + layer.blocks);
    let mut layer = layer.surface(frame.rows);
    let mut mask = mask.surface(frame.rows);
    for strip in 0..frame.strips {
        let (mut layer, mut mask) = (layer.strip(strip), mask.strip(strip));
        for block in first..last {
            let shown = mask.load(block);
            let mut coverage: MaskBlock = [[0; BLOCK_WIDTH]; BLOCK_HEIGHT];
            for (y, (out, row)) in (frame.top + (strip * BLOCK_HEIGHT) as i32..).zip(coverage.iter_mut().zip(&shown)) {
                for (x, (out, pixel)) in
                    ((block * BLOCK_WIDTH) as i32..).zip(out.iter_mut().zip(row.as_chunks::<4>().0))
                {
                    let inside = bounds.left <= x && x < bounds.right && bounds.top <= y && y < bounds.bottom;
                    *out = if inside { kind.coverage(*pixel) } else { 0 };
                }
            }
            let mut pixels = layer.load(block);
            multiply_block_by_mask(simd, &mut pixels, &coverage);
            layer.store(block, &pixels);
        }
    }
}
