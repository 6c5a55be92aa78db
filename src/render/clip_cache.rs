//! The clips of a band: built where a draw uses them, and kept as long as they are in use.

use fearless_simd::Simd;

use super::band::{BandScratch, Frame};
use super::clip::{BandMask, ClipSink};
use super::coverage::accumulate;
use crate::display_list::{ClipId, ClipKind, ClipNode};
use crate::geom::IntRect;
use crate::raster::bins::BandItem;
use crate::surface::Mask;
use crate::surface::block::{BLOCK_HEIGHT, BLOCK_WIDTH, MaskBlock};

const EMPTY_MASK: MaskBlock = [[0; BLOCK_WIDTH]; BLOCK_HEIGHT];

/// The clips of one band: where their edges lie, and the coverage of those in use.
#[derive(Debug, Default)]
pub(super) struct ClipCache {
    /// Clip, piece, and what the piece lists for it; in order of clips.
    pub(super) edges: Vec<(u32, usize, BandItem)>,
    /// The coverage of a chain of clips, each within the one before.
    chain: Vec<(u32, BandMask)>,
    spare: Vec<BandMask>,
}

impl ClipCache {
    pub(super) fn reset(&mut self) {
        self.edges.clear();
        while !self.chain.is_empty() {
            self.drop_last();
        }
    }

    fn drop_last(&mut self) {
        if let Some((_, mask)) = self.chain.pop() {
            self.spare.push(mask);
        }
    }

    /// The coverage of `clip`, which [`clip_for`] has brought in; `None` for no clip.
    #[inline(always)]
    pub(super) fn current(&self, clip: ClipId) -> Option<&BandMask> {
        if clip == ClipId::NONE { None } else { self.chain.last().map(|(_, mask)| mask) }
    }
}

/// Brings the coverage of `clip` into the cache's chain, at its end.
#[inline(always)]
pub(super) fn clip_for<S: Simd>(simd: S, frame: &Frame<'_>, scratch: &mut BandScratch, clip: ClipId) {
    if clip != ClipId::NONE && scratch.clips.chain.last().is_none_or(|(id, _)| *id != clip.0) {
        build_clip(simd, frame, scratch, clip);
    }
}

#[inline(never)]
fn build_clip<S: Simd>(simd: S, frame: &Frame<'_>, scratch: &mut BandScratch, clip: ClipId) {
    simd.vectorize(
        #[inline(always)]
        || build_clip_inner(simd, frame, scratch, clip),
    );
}

#[inline(always)]
fn build_clip_inner<S: Simd>(simd: S, frame: &Frame<'_>, scratch: &mut BandScratch, clip: ClipId) {
    // The clips from `clip` outwards, up to one whose coverage is known. Parents are older than their
    // children, so that known ones younger than the clip in hand are of another branch.
    let mut missing: Vec<(u32, &ClipNode)> = Vec::new();
    let mut id = clip;
    while let Some(node) = frame.list.clip(id) {
        while scratch.clips.chain.last().is_some_and(|(known, _)| *known > id.0) {
            scratch.clips.drop_last();
        }
        if scratch.clips.chain.last().is_some_and(|(known, _)| *known == id.0) {
            break;
        }
        missing.push((id.0, node));
        id = node.parent;
    }
    if id == ClipId::NONE {
        while !scratch.clips.chain.is_empty() {
            scratch.clips.drop_last();
        }
    }
    // Other draws may show what this one hides.
    scratch.visible.clear();
    for (id, node) in missing.into_iter().rev() {
        let mut mask = scratch.clips.spare.pop().unwrap_or_default();
        mask.reset(frame.blocks, frame.strips);
        match &node.kind {
            ClipKind::Geometry { geometry, antialias } => {
                let found = scratch.clips.edges.binary_search_by_key(&id, |(clip, ..)| *clip);
                let place = found.ok().and_then(|index| scratch.clips.edges.get(index)).copied();
                let boundary = place
                    .and_then(|(_, piece, item)| {
                        let chunk = frame.pieces.get(piece)?.chunk;
                        Some(chunk.boundary(chunk.band(frame.index)?, item))
                    })
                    .unwrap_or_default();
                let coverage = accumulate(simd, frame, scratch, geometry, *antialias, node.bounds, boundary);
                let parent = scratch.clips.chain.last().map(|(_, mask)| mask);
                for strip in frame.strips_of(node.bounds) {
                    if !coverage.is_empty(frame, &scratch.cells, strip) {
                        let mut sink = ClipSink { mask: &mut mask, strip, parent };
                        coverage.sweep(simd, frame, &mut scratch.cells, strip, frame.blocks, &mut sink);
                    }
                }
            }
            ClipKind::Mask { mask: source, x, y } => {
                let parent = scratch.clips.chain.last().map(|(_, mask)| mask);
                place_mask(frame, source, (*x, *y), node.bounds, parent, &mut mask);
            }
        }
        scratch.clips.chain.push((id, mask));
    }
}

/// Cuts the blocks of this band out of a mask whose top left lies at (x, y).
fn place_mask(
    frame: &Frame<'_>,
    source: &Mask,
    (x, y): (i32, i32),
    bounds: IntRect,
    parent: Option<&BandMask>,
    out: &mut BandMask,
) {
    let band = IntRect::from_xywh(0, frame.top, (frame.blocks * BLOCK_WIDTH) as u32, frame.rows as u32);
    let inside = IntRect::from_xywh(x, y, source.width(), source.height()).intersect(bounds).intersect(band);
    if inside.is_empty() {
        return;
    }
    let stride = source.width() as usize;
    for strip in 0..frame.strips {
        for block in inside.left as usize / BLOCK_WIDTH..(inside.right as usize).div_ceil(BLOCK_WIDTH) {
            let mut mask = EMPTY_MASK;
            for (row, values) in (frame.top + (strip * BLOCK_HEIGHT) as i32..).zip(&mut mask) {
                if row < inside.top || row >= inside.bottom {
                    continue;
                }
                let line = source.data().get((row - y) as usize * stride..).unwrap_or(&[]);
                for (column, value) in ((block * BLOCK_WIDTH) as i32..).zip(values) {
                    if inside.left <= column && column < inside.right {
                        *value = line.get((column - x) as usize).copied().unwrap_or(0);
                    }
                }
            }
            out.set(strip, block, &mask, parent);
        }
    }
}
