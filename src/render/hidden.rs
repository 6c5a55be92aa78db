//! The search for what is painted over, before a band is painted. The coverage that it finds on the way is kept for the
//! painting, so that it costs little where it finds nothing.

use fearless_simd::Simd;

use super::band::{BandScratch, Frame};
use super::coverage::{accumulate, rectangle};
use super::kept::KeepSink;
use super::occlusion::{HALF_WIDTH, Halves, Occlusion};
use crate::display_list::{Command, Draw};
use crate::geom::{FixedRect, IntRect};
use crate::num::fixed;
use crate::raster::bins::{Boundary, Content, Role};
use crate::raster::round_rect::RoundRect;
use crate::surface::block::{BLOCK_HEIGHT, BLOCK_WIDTH};

/// A shape with more edges in a band than so many for each block that its bounds could hold is not asked what it hides.
const EDGES_PER_BLOCK: usize = 24;
/// So many edges are accumulated in search of hidden blocks in any case, more only if each block costs no more.
const FAIR_TRIAL: usize = 256;
const WORK_PER_BLOCK: usize = 100;
/// The width of half a block.
const HALF: i32 = (HALF_WIDTH as i32) << fixed::SHIFT;

/// Lets the band's opaque shapes claim the blocks that they cover whole, front to back.
#[inline(never)]
pub(super) fn find_hidden<S: Simd>(simd: S, frame: &Frame<'_>, scratch: &mut BandScratch) {
    let mut place =
        frame.pieces.iter().filter_map(|piece| piece.chunk.band(frame.index)).map(|band| band.items.len()).sum();
    let (mut depth, mut work) = (0_u32, 0);
    for piece in frame.pieces.iter().rev() {
        let Some(band) = piece.chunk.band(frame.index) else { continue };
        let frame = &frame.of(piece);
        for item in band.items.iter().rev() {
            place -= 1;
            match item.role {
                Role::Opaque if depth == 0 => {}
                Role::Opaque | Role::Plain => continue,
                Role::Bracket => {
                    match frame.list.commands.get(item.command as usize) {
                        Some(Command::EndLayer(_) | Command::EndMask(..)) => depth += 1,
                        _ => depth = depth.saturating_sub(1),
                    }
                    continue;
                }
            }
            // Where little is hidden, the search costs more than it gains.
            if work > FAIR_TRIAL && scratch.occlusion.count() * WORK_PER_BLOCK < work || scratch.kept.is_full() {
                return;
            }
            if let Content::Rect(rect, _) = item.content {
                // Its coverage is found again as soon as it would be read.
                if place > 0 {
                    work += usize::from(claim_rect(frame, &mut scratch.occlusion, rect, place as u32));
                }
            } else if let Some(Command::Draw(draw)) = frame.list.commands.get(item.command as usize) {
                let boundary = piece.chunk.boundary(band, *item);
                if may_hide(frame, draw, boundary.cost(), place) {
                    work += boundary.cost() + 1;
                    claim_blocks(simd, frame, scratch, draw, boundary, place as u32);
                }
            }
        }
    }
}

/// Whether an opaque shape is worth a look: with room for whole blocks, and not mostly edges; the less so, the fewer
/// items lie beneath it.
fn may_hide(frame: &Frame<'_>, draw: &Draw, edges: usize, beneath: usize) -> bool {
    let (top, bottom) = (draw.bounds.top.max(frame.top), draw.bounds.bottom.min(frame.top + frame.rows as i32));
    let across =
        draw.bounds.right / BLOCK_WIDTH as i32 - (draw.bounds.left + BLOCK_WIDTH as i32 - 1) / BLOCK_WIDTH as i32;
    let blocks = across.max(0) as usize * ((bottom - top).max(0) as usize / BLOCK_HEIGHT);
    edges <= EDGES_PER_BLOCK.min(beneath) * blocks && blocks * beneath > 0
}

/// Keeps a shape's coverage where it can be seen and claims the blocks that it covers whole.
#[inline(never)]
fn claim_blocks<S: Simd>(
    simd: S,
    frame: &Frame<'_>,
    scratch: &mut BandScratch,
    draw: &Draw,
    boundary: Boundary<'_>,
    order: u32,
) {
    let seen = find_visible(frame, scratch, draw.bounds);
    if seen && let Some(rect) = rectangle(frame, &draw.geometry, draw.antialias, draw.bounds) {
        // Its coverage is found again as soon as it would be read.
        claim_rect(frame, &mut scratch.occlusion, rect, order);
        return;
    }
    if seen && let Boundary::RoundRect(shape) = boundary {
        claim_round_rect(frame, &mut scratch.occlusion, &shape, draw.bounds, order);
        return;
    }
    scratch.kept.begin(order);
    if !seen {
        return;
    }
    let coverage = accumulate(simd, frame, scratch, &draw.geometry, draw.antialias, draw.bounds, boundary);
    simd.vectorize(
        #[inline(always)]
        || {
            let BandScratch { cells, occlusion, visible, kept, .. } = scratch;
            for strip in frame.strips_of(draw.bounds) {
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

/// Claims the blocks, and halves of blocks, that a rectangle covers whole; false where it is too narrow for any. One of which nothing is seen is noted: it need not
/// be looked at again.
#[inline(always)]
fn claim_rect(frame: &Frame<'_>, occlusion: &mut Occlusion, rect: FixedRect, order: u32) -> bool {
    const STRIP: i32 = (BLOCK_HEIGHT as i32) << fixed::SHIFT;
    let bounds = rect.pixels();
    if !occlusion.is_seen(frame.strips_of(bounds), Halves::touched(bounds)) {
        occlusion.set_gone(order);
        return true;
    }
    let (first, end) = ((rect.left.max(0) + HALF - 1) / HALF, rect.right.max(0) / HALF);
    if first >= end {
        return false;
    }
    let (top, bottom) = (rect.top - (frame.top << fixed::SHIFT), rect.bottom - (frame.top << fixed::SHIFT));
    let first_strip = (top.max(0) + STRIP - 1) / STRIP;
    // The last strip may have fewer rows than others.
    let is_to_end = bottom >= (frame.rows as i32) << fixed::SHIFT;
    let end_strip = if is_to_end { frame.strips as i32 } else { bottom.max(0) / STRIP };
    occlusion.claim(order, first_strip as usize..end_strip as usize, first as usize..end as usize);
    true
}

/// Claims the blocks that a shape covers whole within `bounds` (device pixels).
#[inline(always)]
fn claim_round_rect(frame: &Frame<'_>, occlusion: &mut Occlusion, shape: &RoundRect, bounds: IntRect, order: u32) {
    const STRIP: i32 = BLOCK_HEIGHT as i32;
    let inside = shape.rect.intersect(bounds);
    let (band_top, band_bottom) = (frame.top << fixed::SHIFT, (frame.top + frame.rows as i32) << fixed::SHIFT);
    // The strips that lie within the shape.
    let first = ((inside.top - band_top).max(0) + (STRIP << fixed::SHIFT) - 1) / (STRIP << fixed::SHIFT);
    let arc = shape.arc();
    for strip in first..frame.strips as i32 {
        let top = band_top + ((strip * STRIP) << fixed::SHIFT);
        let bottom = (top + (STRIP << fixed::SHIFT)).min(band_bottom);
        if bottom > inside.bottom {
            break;
        }
        let (left, right) = shape.inner(arc, top, bottom);
        let (left, right) = (left.max(inside.left).max(0), right.min(inside.right).max(0));
        let (start, end) = ((left + HALF - 1) / HALF, right / HALF);
        if start < end {
            occlusion.claim(order, strip as usize..strip as usize + 1, start as usize..end as usize);
        }
    }
}

/// Notes for each strip where a draw within `bounds` can be seen; false if nowhere. Without hidden blocks it notes
/// nothing, which stands for everywhere.
#[inline(always)]
pub(super) fn find_visible(frame: &Frame<'_>, scratch: &mut BandScratch, bounds: IntRect) -> bool {
    let BandScratch { occlusion, visible, .. } = scratch;
    visible.clear();
    if !occlusion.is_some() {
        return true;
    }
    let strips = frame.strips_of(bounds);
    visible.resize(frame.strips, (0, 0));
    occlusion.find_visible(strips.start, bounds, visible.get_mut(strips).unwrap_or(&mut []))
}
