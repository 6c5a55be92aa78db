//! The search for what is painted over, before a band is painted. The coverage that it finds on the way is kept for the
//! painting, so that it costs little where it finds nothing.

use fearless_simd::Simd;

use super::band::{BandScratch, Frame};
use super::coverage::accumulate;
use super::kept::KeepSink;
use super::occlusion::reach;
use crate::blend::BlendMode;
use crate::display_list::{ClipId, Command, Draw, Geometry};
use crate::geom::IntRect;
use crate::paint::PreparedPaint;
use crate::raster::bins::Edges;
use crate::surface::block::{BLOCK_HEIGHT, BLOCK_WIDTH};

/// A shape with more edges in a band than so many for each block that its bounds could hold is not asked what it hides.
const EDGES_PER_BLOCK: usize = 24;
/// So many edges are accumulated in search of hidden blocks in any case, more only if each block costs no more.
const FAIR_TRIAL: usize = 256;
const WORK_PER_BLOCK: usize = 100;

/// Lets the band's opaque shapes claim the blocks that they cover whole, front to back.
#[inline(never)]
pub(super) fn find_hidden<S: Simd>(simd: S, frame: &Frame<'_>, scratch: &mut BandScratch) {
    let mut candidates = std::mem::take(&mut scratch.candidates);
    candidates.clear();
    let (mut order, mut depth) = (0_u32, 0_u32);
    for (chunk_index, chunk) in frame.chunks.iter().enumerate() {
        let Some(band) = chunk.band(frame.index) else { continue };
        for (item_index, item) in band.items.iter().enumerate() {
            match frame.list.commands.get(item.command as usize) {
                Some(Command::BeginLayer(_) | Command::BeginMask(_)) => depth += 1,
                Some(Command::EndLayer(_) | Command::EndMask(..)) => depth = depth.saturating_sub(1),
                Some(Command::Draw(draw))
                    if depth == 0 && may_hide(frame, draw, chunk.edges(band, *item).len(), order as usize) =>
                {
                    candidates.push((chunk_index, item_index, order));
                }
                _ => {}
            }
            order += 1;
        }
    }
    let mut work = 0;
    for &(chunk, item, order) in candidates.iter().rev() {
        // Where little is hidden, the search costs more than it gains.
        if work > FAIR_TRIAL && scratch.occlusion.count() * WORK_PER_BLOCK < work || scratch.kept.is_full() {
            break;
        }
        let Some(chunk) = frame.chunks.get(chunk) else { continue };
        let Some(band) = chunk.band(frame.index) else { continue };
        let Some(item) = band.items.get(item) else { continue };
        let Some(Command::Draw(draw)) = frame.list.commands.get(item.command as usize) else { continue };
        let edges = chunk.edges(band, *item);
        work += edges.len() + 1;
        claim_blocks(simd, frame, scratch, draw, edges, order);
    }
    scratch.candidates = candidates;
}

/// Whether a shape is worth a look: opaque, with room for whole blocks, and not mostly edges; the less so, the fewer
/// items lie beneath it.
fn may_hide(frame: &Frame<'_>, draw: &Draw, edges: usize, beneath: usize) -> bool {
    let opaque = matches!(draw.blend_mode, BlendMode::SourceOver | BlendMode::Source)
        && draw.clip == ClipId::NONE
        && matches!(draw.geometry, Geometry::Fill { .. } | Geometry::Rect(_) | Geometry::Bounds)
        && frame.list.paints.get(draw.paint as usize).is_some_and(PreparedPaint::is_opaque);
    let (top, bottom) = (draw.bounds.top.max(frame.top), draw.bounds.bottom.min(frame.top + frame.rows as i32));
    let across =
        draw.bounds.right / BLOCK_WIDTH as i32 - (draw.bounds.left + BLOCK_WIDTH as i32 - 1) / BLOCK_WIDTH as i32;
    let blocks = across.max(0) as usize * ((bottom - top).max(0) as usize / BLOCK_HEIGHT);
    opaque && edges <= EDGES_PER_BLOCK.min(beneath) * blocks && blocks * beneath > 0
}

/// Keeps a shape's coverage where it can be seen and claims the blocks that it covers whole.
#[inline(never)]
fn claim_blocks<S: Simd>(
    simd: S,
    frame: &Frame<'_>,
    scratch: &mut BandScratch,
    draw: &Draw,
    edges: Edges<'_>,
    order: u32,
) {
    scratch.kept.begin(order);
    if !find_visible(frame, scratch, draw.bounds) {
        return;
    }
    let coverage = accumulate(simd, frame, scratch, &draw.geometry, draw.antialias, draw.bounds, edges);
    simd.vectorize(
        #[inline(always)]
        || {
            let BandScratch { cells, occlusion, visible, kept, .. } = scratch;
            for strip in 0..frame.strips {
                if !coverage.is_empty(frame, cells, strip) {
                    let rows = frame.rows.saturating_sub(strip * BLOCK_HEIGHT).min(BLOCK_HEIGHT);
                    let end = visible.get(strip).map_or(frame.blocks, |(_, end)| *end);
                    let mut sink = KeepSink { kept, occlusion, order, strip, rows };
                    coverage.sweep(simd, frame, cells, strip, end, &mut sink);
                }
            }
        },
    );
}

/// Notes for each strip where a draw within `bounds` can be seen; false if nowhere. Without hidden blocks it notes
/// nothing, which stands for everywhere.
pub(super) fn find_visible(frame: &Frame<'_>, scratch: &mut BandScratch, bounds: IntRect) -> bool {
    scratch.visible.clear();
    scratch.reaches.clear();
    if !scratch.occlusion.is_some() {
        return true;
    }
    let mut seen = false;
    for strip in 0..frame.strips {
        let top = frame.strip_top(strip);
        let outside = bounds.top >= top + BLOCK_HEIGHT as i32 || bounds.bottom <= top;
        let visible = if outside { (0, 0) } else { scratch.occlusion.visible(strip, bounds) };
        seen |= visible.0 < visible.1;
        scratch.visible.push(visible);
        scratch.reaches.push(reach(visible));
    }
    seen
}
