//! One band, from its first command to its last: where "which pixels" meets "what colour".
//!
//! A shape's edges are accumulated into strips of cells ([`cell`](crate::raster::cell)), the cells are swept
//! into blocks of coverage ([`sweep`](crate::raster::sweep)), and a [`Painter`] takes each block: it cuts it
//! by the clip, fetches colours ([`paint`](crate::paint)) and blends them ([`blend`](crate::blend)) into the
//! band's rows, or into those of the layer that is open.

use std::ops::Range;

use fearless_simd::Simd;

use super::bar::paint_bar;
use super::clip_cache::{ClipCache, clip_for};
use super::coverage::{Coverage, accumulate, accumulate_stretches};
use super::hidden::{find_hidden, find_visible};
use super::kept::Kept;
use super::layer::{LayerBuffer, mask_layer, open_surface};
use super::occlusion::Occlusion;
use super::opaque_rect::paint_opaque_rect;
use super::painter::{Look, Source, paint_coverage, paint_kept, paint_rect};
use super::plan::Plan;
use super::surface::Surface;
use super::{Drawing, Piece};
use crate::blend::BlendMode;
use crate::display_list::{Command, DisplayList, Draw, Geometry, LayerStart, PaintRef};
use crate::geom::{FixedRect, IntRect};
use crate::num::level::{SimdLevel, dispatch};
use crate::paint::PreparedPaint;
use crate::path::stretch::Stretch;
use crate::raster::bins::{Boundary, Content};
use crate::raster::cell::Accumulator;
use crate::raster::edge::Edge;
use crate::raster::kernel::Reach;
use crate::raster::sample::SampleScratch;
use crate::style::Antialias;
use crate::surface::block::{BLOCK_HEIGHT, BLOCK_WIDTH};

/// Pictures of more pixels, 16 MiB, are taken not to stay in a cache.
const UNCACHED_PIXELS: u64 = 1 << 22;

/// Working memory of one thread.
#[derive(Debug, Default)]
pub(super) struct BandScratch {
    /// Who used it last.
    pub(super) user: Option<std::thread::ThreadId>,
    pub(super) cells: Accumulator,
    pub(super) edges: Vec<Edge>,
    pub(super) sample: SampleScratch,
    pub(super) layers: Vec<LayerBuffer>,
    pub(super) spare_layers: Vec<LayerBuffer>,
    pub(super) clips: ClipCache,
    pub(super) occlusion: Occlusion,
    pub(super) kept: Kept,
    /// Of the draw in hand, for each strip: the blocks in which it can be seen, and their columns.
    pub(super) visible: Vec<(usize, usize)>,
    pub(super) reaches: Vec<Reach>,
}

/// What all of a band's steps need to know.
#[derive(Clone, Copy)]
pub(super) struct Frame<'a> {
    /// The recording of the piece in work.
    pub(super) list: &'a DisplayList,
    pub(super) plan: &'a Plan,
    pub(super) pieces: &'a [Piece<'a>],
    pub(super) index: usize,
    /// Device y of the band's first row.
    pub(super) top: i32,
    pub(super) rows: usize,
    pub(super) strips: usize,
    pub(super) blocks: usize,
    /// The first and the end of the blocks that are drawn.
    pub(super) seen: (usize, usize),
    /// Whether the picture is larger than a cache. Memory that is written line after line need not be read first: what covers
    /// all of a band is then quicker written whole than where nothing will hide it.
    is_uncached: bool,
}

impl<'a> Frame<'a> {
    /// Band `index` of a drawing: `rows` rows from device row `top` on, in the blocks `seen`.
    pub(super) fn new(drawing: &Drawing<'a>, index: usize, top: i32, rows: usize, seen: (usize, usize)) -> Self {
        let Drawing { list, plan, pieces, frame } = *drawing;
        let (strips, blocks) = (rows.div_ceil(BLOCK_HEIGHT), (frame.width() as usize).div_ceil(BLOCK_WIDTH));
        let is_uncached = u64::from(frame.width()) * u64::from(frame.height()) > UNCACHED_PIXELS;
        Self { list, plan, pieces, index, top, rows, strips, blocks, seen, is_uncached }
    }

    /// The same for what `piece` holds.
    #[inline(always)]
    pub(super) fn of(&self, piece: &Piece<'a>) -> Self {
        Self { list: piece.list, ..*self }
    }

    /// The band's device pixels, up to the end of the last block.
    pub(super) fn area(&self) -> IntRect {
        IntRect::from_xywh(0, self.top, (self.blocks * BLOCK_WIDTH) as u32, self.rows as u32)
    }

    /// The columns of `bounds` that are drawn.
    pub(super) fn seen(&self, bounds: IntRect) -> IntRect {
        let (first, end) = ((self.seen.0 * BLOCK_WIDTH) as i32, (self.seen.1 * BLOCK_WIDTH) as i32);
        IntRect { left: bounds.left.max(first), right: bounds.right.min(end), ..bounds }
    }

    /// The band's strips that touch `bounds` (device pixels).
    #[inline(always)]
    pub(super) fn strips_of(&self, bounds: IntRect) -> Range<usize> {
        let strip_of = |y: i32| ((y - self.top).max(0) as usize / BLOCK_HEIGHT).min(self.strips);
        strip_of(bounds.top)..strip_of(bounds.bottom + (BLOCK_HEIGHT as i32 - 1))
    }

    /// Device y of a strip's first row.
    #[inline(always)]
    pub(super) fn strip_top(&self, strip: usize) -> i32 {
        self.top + (strip * BLOCK_HEIGHT) as i32
    }
}

/// Paints a band onto `target`, which holds the blocks that are drawn.
pub(super) fn render(frame: &Frame<'_>, mut target: Surface<'_>, scratch: &mut BandScratch, level: SimdLevel) {
    scratch.cells.resize(frame.blocks * BLOCK_WIDTH, frame.strips);
    scratch.clips.reset();
    scratch.occlusion.reset(frame.blocks, frame.strips);
    scratch.occlusion.hide_outside(frame.seen, frame.blocks, frame.strips);
    scratch.kept.clear();
    dispatch!(level, simd => render_with(simd, frame, &mut target, scratch));
    // A recording ends with every layer closed; were one open, its memory is kept all the same.
    scratch.spare_layers.append(&mut scratch.layers);
}

#[inline(always)]
fn render_with<S: Simd>(simd: S, frame: &Frame<'_>, target: &mut Surface<'_>, scratch: &mut BandScratch) {
    find_hidden(simd, frame, scratch);
    let (mut order, mut list) = (0, frame.list);
    // Stretches before are painted.
    let mut next_stretch = 0;
    for (piece_index, piece) in frame.pieces.iter().enumerate() {
        let Some(band) = piece.chunk.band(frame.index) else { continue };
        if piece_index < next_stretch {
            order += band.items.len() as u32;
            continue;
        }
        let frame = &frame.of(piece);
        if !std::ptr::eq(frame.list, list) {
            // Clips are named within a recording.
            scratch.clips.reset();
            list = frame.list;
        }
        for item in &band.items {
            let place = order;
            order += 1;
            if scratch.occlusion.is_gone(place) {
                continue;
            }
            scratch.occlusion.release(place);
            if scratch.kept.drop_hidden(place) {
                continue;
            }
            if let Content::Rect(rect, color) = item.content {
                if place == 0 && frame.is_uncached && covers(frame, target, rect) && color[3] == 255 {
                    target.fill(simd, color);
                    continue;
                }
                let BandScratch { layers, occlusion, .. } = &mut *scratch;
                let surface = &mut open_surface(frame, target, layers);
                if color[3] == 255 {
                    paint_opaque_rect(simd, frame, rect, color, surface, occlusion);
                } else {
                    paint_rect(simd, frame, rect, color, surface, occlusion);
                }
                continue;
            }
            if let Content::Bar(index) = item.content
                && let Some(bar) = piece.chunk.bar(index)
                && let Some(color) = bar.color
            {
                if find_visible(frame, scratch, bar.bounds()) {
                    let BandScratch { layers, .. } = &mut *scratch;
                    paint_bar(simd, frame, bar, color, &mut open_surface(frame, target, layers));
                }
                continue;
            }
            let Some(command) = frame.list.commands.get(item.command as usize) else { continue };
            let boundary = piece.chunk.boundary(band, *item);
            match command {
                Command::Draw(draw) => {
                    let Some(paint) = frame.list.paint(draw.paint) else { continue };
                    let paint = &*paint;
                    if scratch.kept.holds(place) {
                        paint_kept(simd, frame, &mut scratch.kept, Look::new(draw, paint, None), target);
                    } else if let Some(Stretch { index, count }) = piece.chunk.stretch() {
                        next_stretch = piece_index + (count - index);
                        let stretches = frame.pieces.get(piece_index..next_stretch).unwrap_or(&[]);
                        paint_draw(simd, frame, target, scratch, draw, paint, boundary, stretches);
                    } else {
                        paint_draw(simd, frame, target, scratch, draw, paint, boundary, &[]);
                    }
                }
                Command::Clip(id) => scratch.clips.edges.push((id.0, piece_index, *item)),
                Command::BeginLayer(LayerStart { bounds, .. }) | Command::BeginMask(bounds) => {
                    let mut layer = scratch.spare_layers.pop().unwrap_or_default();
                    layer.reset(frame.seen(*bounds));
                    scratch.layers.push(layer);
                }
                Command::EndLayer(layer) => {
                    let Some(mut pixels) = scratch.layers.pop() else { continue };
                    if !(pixels.is_untouched() && layer.blend_mode == BlendMode::SourceOver) {
                        paint_layer(simd, frame, target, scratch, layer, &mut pixels);
                    }
                    scratch.spare_layers.push(pixels);
                }
                Command::EndMask(bounds, kind) => {
                    let Some(mut mask) = scratch.layers.pop() else { continue };
                    if let Some(layer) = scratch.layers.last_mut()
                        && !layer.is_untouched()
                    {
                        mask_layer(simd, frame, layer, &mut mask, *bounds, *kind);
                    }
                    scratch.spare_layers.push(mask);
                }
                Command::Effect(effect) => {
                    let Some(picture) = frame.plan.picture(item.command) else { continue };
                    let draw = Draw {
                        geometry: Geometry::Bounds,
                        paint: PaintRef::of_color([0; 4]),
                        antialias: Antialias::None,
                        blend_mode: effect.blend_mode,
                        clip: effect.clip,
                        bounds: picture.bounds,
                        opaque: picture.paint.is_opaque(),
                    };
                    paint_draw(simd, frame, target, scratch, &draw, &picture.paint, boundary, &[]);
                }
            }
        }
    }
}

/// Whether a rectangle covers all of a band's rows.
fn covers(frame: &Frame<'_>, target: &Surface<'_>, rect: FixedRect) -> bool {
    let area = FixedRect::of_pixels(target.area(frame.top));
    rect.left <= area.left && rect.top <= area.top && rect.right >= area.right && rect.bottom >= area.bottom
}

/// Draws one shape onto the open layer, or onto the target. It has the edges of `boundary` or, if it is a long stroke, those of all its
/// `stretches`.
#[inline(never)]
#[expect(clippy::too_many_arguments, reason = "a draw's facts, from the only place that knows them")]
fn paint_draw<S: Simd>(
    simd: S,
    frame: &Frame<'_>,
    target: &mut Surface<'_>,
    scratch: &mut BandScratch,
    draw: &Draw,
    paint: &PreparedPaint,
    boundary: Boundary<'_>,
    stretches: &[Piece<'_>],
) {
    simd.vectorize(
        #[inline(always)]
        || paint_draw_inner(simd, frame, target, scratch, draw, paint, boundary, stretches),
    )
}

#[inline(always)]
#[expect(clippy::too_many_arguments, reason = "as for paint_draw")]
fn paint_draw_inner<S: Simd>(
    simd: S,
    frame: &Frame<'_>,
    target: &mut Surface<'_>,
    scratch: &mut BandScratch,
    draw: &Draw,
    paint: &PreparedPaint,
    boundary: Boundary<'_>,
    stretches: &[Piece<'_>],
) {
    if matches!(paint, PreparedPaint::Nothing) && draw.blend_mode == BlendMode::SourceOver {
        return;
    }
    // The clip's own edges go through the same cells, so it comes first.
    clip_for(simd, frame, scratch, draw.clip);
    if !find_visible(frame, scratch, draw.bounds) {
        return;
    }
    let coverage = if stretches.is_empty() {
        accumulate(simd, frame, scratch, &draw.geometry, draw.antialias, draw.bounds, boundary)
    } else {
        accumulate_stretches(simd, frame, scratch, draw.bounds, stretches)
    };
    let BandScratch { cells, layers, clips, occlusion, visible, .. } = scratch;
    let surface = &mut open_surface(frame, target, layers);
    let clip = clips.current(draw.clip);
    let look = Look::new(draw, paint, clip);
    paint_coverage(simd, frame, cells, (coverage, draw.bounds), look, surface, (occlusion, visible));
}

/// Draws a finished layer onto the one below, or onto the target.
#[inline(never)]
fn paint_layer<S: Simd>(
    simd: S,
    frame: &Frame<'_>,
    target: &mut Surface<'_>,
    scratch: &mut BandScratch,
    layer: &LayerStart,
    pixels: &mut LayerBuffer,
) {
    simd.vectorize(
        #[inline(always)]
        || paint_layer_inner(simd, frame, target, scratch, layer, pixels),
    )
}

#[inline(always)]
fn paint_layer_inner<S: Simd>(
    simd: S,
    frame: &Frame<'_>,
    target: &mut Surface<'_>,
    scratch: &mut BandScratch,
    layer: &LayerStart,
    pixels: &mut LayerBuffer,
) {
    clip_for(simd, frame, scratch, layer.clip);
    if !find_visible(frame, scratch, layer.bounds) {
        return;
    }
    let coverage = Coverage::Rect(FixedRect::of_pixels(layer.bounds.intersect(frame.area())));
    let BandScratch { cells, layers, clips, occlusion, visible, .. } = scratch;
    let surface = &mut open_surface(frame, target, layers);
    let source = Source::Layer(pixels.surface(frame.rows));
    let clip = clips.current(layer.clip);
    let look = Look { source, blend_mode: layer.blend_mode, opacity: layer.opacity, clip };
    paint_coverage(simd, frame, cells, (coverage, layer.bounds), look, surface, (occlusion, visible));
}
