//! One band, from its first command to its last: where "which pixels" meets "what colour".
//!
//! A shape's edges are accumulated into strips of cells ([`cell`](crate::raster::cell)), the cells are swept
//! into blocks of coverage ([`sweep`](crate::raster::sweep)), and a [`Painter`] takes each block: it cuts it
//! by the clip, fetches colours ([`paint`](crate::paint)) and blends them ([`blend`](crate::blend)) into the
//! band's rows, or into those of the layer that is open.

use fearless_simd::Simd;

use super::clip::{BandMask, ClipBlock, ClipSink};
use super::occlusion::{ClaimSink, Occlusion, reach};
use super::plan::Plan;
use super::prepare::Chunk;
use super::surface::Surface;
use crate::blend::{
    BlendMode, composite_block, mix_pixels_row, multiply_block_by_mask, over_opaque_row, over_pixels_full,
    over_pixels_row, over_solid_full, over_solid_row, scale_mask_row, scale_mask_row_by,
};
use crate::display_list::{ClipId, ClipKind, ClipNode, Command, DisplayList, Draw, Geometry, LayerStart, Span};
use crate::geom::IntRect;
use crate::num::level::{SimdLevel, dispatch};
use crate::paint::{PreparedPaint, fetch_block};
use crate::raster::cell::{self, Accumulator, Reach};
use crate::raster::edge::Edge;
use crate::raster::exact::{self, ExactScratch};
use crate::raster::sample::{self, SampleScratch};
use crate::raster::sweep::{BlockSink, CoverageRule, sweep};
use crate::style::{Antialias, FillRule};
use crate::surface::block::{BLOCK_HEIGHT, BLOCK_WIDTH, MaskBlock, PixelBlock};
use crate::surface::{Mask, MaskKind};

const ROW_BYTES: usize = BLOCK_WIDTH * 4;
const EMPTY_MASK: MaskBlock = [[0; BLOCK_WIDTH]; BLOCK_HEIGHT];
/// A shape with more edges in a band than so many for each block that its bounds could hold is not asked what it hides.
const EDGES_PER_BLOCK: usize = 4;
/// So many edges are accumulated in search of hidden blocks in any case, more only if each block costs no more.
const FAIR_TRIAL: usize = 256;
const WORK_PER_BLOCK: usize = 12;
const NO_PIXELS: PixelBlock = [[0; ROW_BYTES]; BLOCK_HEIGHT];

/// Working memory of one thread.
#[derive(Debug, Default)]
pub(super) struct BandScratch {
    cells: Accumulator,
    exact: ExactScratch,
    sample: SampleScratch,
    layers: Vec<LayerBuffer>,
    spare_layers: Vec<LayerBuffer>,
    clips: ClipCache,
    occlusion: Occlusion,
    /// Of the draw in hand, for each strip: the blocks in which it can be seen, and their columns.
    visible: Vec<(usize, usize)>,
    reaches: Vec<Reach>,
    /// Chunk, item and place in the band of what may hide something.
    candidates: Vec<(usize, usize, u32)>,
}

/// The pixels of an open layer in this band. They take memory from the first draw on: layers that only hold
/// layers can be as deep as anyone likes.
#[derive(Debug, Default)]
struct LayerBuffer {
    data: Vec<u8>,
    first_block: usize,
    blocks: usize,
}

impl LayerBuffer {
    fn reset(&mut self, bounds: IntRect) {
        self.first_block = bounds.left.max(0) as usize / BLOCK_WIDTH;
        self.blocks = (bounds.right.max(0) as usize).div_ceil(BLOCK_WIDTH).saturating_sub(self.first_block);
        self.data.clear();
    }

    /// Whether nothing was drawn on it.
    fn is_untouched(&self) -> bool {
        self.data.is_empty()
    }

    fn surface(&mut self, rows: usize) -> Surface<'_> {
        self.data.resize(self.blocks * ROW_BYTES * rows, 0);
        let width = self.blocks * BLOCK_WIDTH;
        Surface::new(&mut self.data, width * 4, self.first_block, width, rows)
    }
}

/// The clips of one band: where their edges lie, and the coverage of those in use.
#[derive(Debug, Default)]
struct ClipCache {
    /// Clip, chunk, and range of the chunk's edges; in order of clips.
    edges: Vec<(u32, usize, (u32, u32))>,
    /// The coverage of a chain of clips, each within the one before.
    chain: Vec<(u32, BandMask)>,
    spare: Vec<BandMask>,
}

/// What all of a band's steps need to know.
struct Frame<'a> {
    list: &'a DisplayList,
    plan: &'a Plan,
    chunks: &'a [Chunk],
    index: usize,
    /// Device y of the band's first row.
    top: i32,
    rows: usize,
    strips: usize,
    blocks: usize,
}

/// Paints band `index`, whose first row is device row `top`, onto `target`.
#[expect(clippy::too_many_arguments, reason = "the frame's facts, passed once per band")]
pub(super) fn render(
    list: &DisplayList,
    plan: &Plan,
    chunks: &[Chunk],
    index: usize,
    top: i32,
    mut target: Surface<'_>,
    scratch: &mut BandScratch,
    level: SimdLevel,
) {
    let (width, rows) = (target.width(), target.rows());
    let strips = rows.div_ceil(BLOCK_HEIGHT);
    let frame = Frame { list, plan, chunks, index, top, rows, strips, blocks: width.div_ceil(BLOCK_WIDTH) };
    scratch.cells.resize(width, strips);
    scratch.clips.reset();
    scratch.occlusion.reset(frame.blocks, strips);
    dispatch!(level, simd => render_with(simd, &frame, &mut target, scratch));
    // A recording ends with every layer closed; were one open, its memory is kept all the same.
    scratch.spare_layers.append(&mut scratch.layers);
}

#[inline(always)]
fn render_with<S: Simd>(simd: S, frame: &Frame<'_>, target: &mut Surface<'_>, scratch: &mut BandScratch) {
    find_hidden(simd, frame, scratch);
    let mut order = 0;
    for (chunk_index, chunk) in frame.chunks.iter().enumerate() {
        let Some(band) = chunk.band(frame.index) else { continue };
        for item in &band.items {
            scratch.occlusion.release(order);
            order += 1;
            let Some(command) = frame.list.commands.get(item.command as usize) else { continue };
            let edges = band.edges.get(item.start as usize..item.end as usize).unwrap_or(&[]);
            match command {
                Command::Draw(draw) => {
                    let Some(paint) = frame.list.paints.get(draw.paint as usize) else { continue };
                    paint_draw(simd, frame, target, scratch, draw, paint, edges);
                }
                Command::Clip(id) => scratch.clips.edges.push((id.0, chunk_index, (item.start, item.end))),
                Command::BeginLayer(LayerStart { bounds, .. }) | Command::BeginMask(bounds) => {
                    let mut layer = scratch.spare_layers.pop().unwrap_or_default();
                    layer.reset(*bounds);
                    scratch.layers.push(layer);
                }
                Command::EndLayer(layer) => {
                    let Some(mut pixels) = scratch.layers.pop() else { continue };
                    if !(pixels.is_untouched() && layer.blend_mode == BlendMode::SourceOver) {
                        paint_layer(simd, frame, target, scratch, layer, &mut pixels, edges);
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
                        paint: 0,
                        antialias: Antialias::None,
                        blend_mode: effect.blend_mode,
                        clip: effect.clip,
                        bounds: picture.bounds,
                    };
                    paint_draw(simd, frame, target, scratch, &draw, &picture.paint, edges);
                }
            }
        }
    }
}

/// Lets the band's opaque shapes claim the blocks that they cover whole, front to back.
#[inline(never)]
fn find_hidden<S: Simd>(simd: S, frame: &Frame<'_>, scratch: &mut BandScratch) {
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
                    if depth == 0 && may_hide(frame, draw, (item.end - item.start) as usize, order as usize) =>
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
        if work > FAIR_TRIAL && scratch.occlusion.count() * WORK_PER_BLOCK < work {
            break;
        }
        let Some(band) = frame.chunks.get(chunk).and_then(|chunk| chunk.band(frame.index)) else { continue };
        let Some(item) = band.items.get(item) else { continue };
        let Some(Command::Draw(draw)) = frame.list.commands.get(item.command as usize) else { continue };
        let edges = band.edges.get(item.start as usize..item.end as usize).unwrap_or(&[]);
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
        && draw.antialias == Antialias::Analytic
        && matches!(draw.geometry, Geometry::Fill { .. } | Geometry::Bounds)
        && frame.list.paints.get(draw.paint as usize).is_some_and(PreparedPaint::is_opaque);
    let (top, bottom) = (draw.bounds.top.max(frame.top), draw.bounds.bottom.min(frame.top + frame.rows as i32));
    let across =
        draw.bounds.right / BLOCK_WIDTH as i32 - (draw.bounds.left + BLOCK_WIDTH as i32 - 1) / BLOCK_WIDTH as i32;
    let blocks = across.max(0) as usize * ((bottom - top).max(0) as usize / BLOCK_HEIGHT);
    opaque && edges <= EDGES_PER_BLOCK.min(beneath) * blocks && blocks * beneath > 0
}

/// Accumulates a shape where it can be seen and claims the blocks that it covers whole.
#[inline(never)]
fn claim_blocks<S: Simd>(
    simd: S,
    frame: &Frame<'_>,
    scratch: &mut BandScratch,
    draw: &Draw,
    edges: &[Edge],
    order: u32,
) {
    if !find_visible(frame, scratch, draw.bounds) {
        return;
    }
    let rule = accumulate(simd, frame, scratch, &draw.geometry, draw.antialias, edges);
    simd.vectorize(
        #[inline(always)]
        || {
            let BandScratch { cells, occlusion, visible, .. } = scratch;
            for strip in 0..frame.strips {
                if cells.is_occupied(strip)
                    && let Some(mut cells) = cells.strip(strip)
                {
                    let rows = frame.rows.saturating_sub(strip * BLOCK_HEIGHT).min(BLOCK_HEIGHT);
                    let end = visible.get(strip).map_or(frame.blocks, |(_, end)| *end);
                    let mut sink = ClaimSink { occlusion, order, strip, rows };
                    sweep(simd, &mut cells, end, rule, &mut sink);
                }
            }
        },
    );
}

/// Notes for each strip where a draw within `bounds` can be seen; false if nowhere. Without hidden blocks it notes
/// nothing, which stands for everywhere.
fn find_visible(frame: &Frame<'_>, scratch: &mut BandScratch, bounds: IntRect) -> bool {
    scratch.visible.clear();
    scratch.reaches.clear();
    if !scratch.occlusion.is_some() {
        return true;
    }
    let mut seen = false;
    for strip in 0..frame.strips {
        let visible = scratch.occlusion.visible(strip, bounds);
        seen |= visible.0 < visible.1;
        scratch.visible.push(visible);
        scratch.reaches.push(reach(visible));
    }
    seen
}

/// Draws one shape onto the open layer, or onto the target.
#[inline(never)]
fn paint_draw<S: Simd>(
    simd: S,
    frame: &Frame<'_>,
    target: &mut Surface<'_>,
    scratch: &mut BandScratch,
    draw: &Draw,
    paint: &PreparedPaint,
    edges: &[Edge],
) {
    simd.vectorize(
        #[inline(always)]
        || paint_draw_inner(simd, frame, target, scratch, draw, paint, edges),
    )
}

#[inline(always)]
fn paint_draw_inner<S: Simd>(
    simd: S,
    frame: &Frame<'_>,
    target: &mut Surface<'_>,
    scratch: &mut BandScratch,
    draw: &Draw,
    paint: &PreparedPaint,
    edges: &[Edge],
) {
    let source = match paint {
        PreparedPaint::Nothing if draw.blend_mode == BlendMode::SourceOver => return,
        PreparedPaint::Nothing => Source::Solid([0; 4]),
        PreparedPaint::Solid(color) => Source::Solid(*color),
        paint => Source::Paint(paint),
    };
    // The clip's own edges go through the same cells, so it comes first.
    clip_for(simd, frame, scratch, draw.clip);
    if !find_visible(frame, scratch, draw.bounds) {
        return;
    }
    let rule = accumulate(simd, frame, scratch, &draw.geometry, draw.antialias, edges);
    let BandScratch { cells, layers, clips, occlusion, visible, .. } = scratch;
    let surface = &mut open_surface(frame, target, layers);
    let clip = clips.current(draw.clip);
    // Opaque colours replace what is below either way; the usual mode has the shorter paths.
    let blend_mode = match draw.blend_mode {
        BlendMode::Source if paint.is_opaque() => BlendMode::SourceOver,
        mode => mode,
    };
    let look = Look { source, blend_mode, opacity: 255, clip };
    paint_cells(simd, frame, cells, rule, look, surface, (occlusion, visible));
}

/// The rows to draw on: those of the innermost open layer, or the target's.
#[inline(always)]
fn open_surface<'a>(frame: &Frame<'_>, target: &'a mut Surface<'_>, layers: &'a mut [LayerBuffer]) -> Surface<'a> {
    match layers.last_mut() {
        Some(layer) => layer.surface(frame.rows),
        None => target.reborrow(),
    }
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
    edges: &[Edge],
) {
    simd.vectorize(
        #[inline(always)]
        || paint_layer_inner(simd, frame, target, scratch, layer, pixels, edges),
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
    edges: &[Edge],
) {
    clip_for(simd, frame, scratch, layer.clip);
    if !find_visible(frame, scratch, layer.bounds) {
        return;
    }
    let rule = accumulate(simd, frame, scratch, &Geometry::Bounds, Antialias::Analytic, edges);
    let BandScratch { cells, layers, clips, occlusion, visible, .. } = scratch;
    let surface = &mut open_surface(frame, target, layers);
    let source = Source::Layer(pixels.surface(frame.rows));
    let clip = clips.current(layer.clip);
    let look = Look { source, blend_mode: layer.blend_mode, opacity: layer.opacity, clip };
    paint_cells(simd, frame, cells, rule, look, surface, (occlusion, visible));
}

/// Multiplies a layer by what was drawn as its mask.
#[inline(never)]
fn mask_layer<S: Simd>(
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
        for block in first..last {
            let shown = mask.load(strip, block);
            let mut coverage = EMPTY_MASK;
            for (y, (out, row)) in (frame.top + (strip * BLOCK_HEIGHT) as i32..).zip(coverage.iter_mut().zip(&shown)) {
                for (x, (out, pixel)) in
                    ((block * BLOCK_WIDTH) as i32..).zip(out.iter_mut().zip(row.as_chunks::<4>().0))
                {
                    let inside = bounds.left <= x && x < bounds.right && bounds.top <= y && y < bounds.bottom;
                    *out = if inside { kind.coverage(*pixel) } else { 0 };
                }
            }
            let mut pixels = layer.load(strip, block);
            multiply_block_by_mask(simd, &mut pixels, &coverage);
            layer.store(strip, block, &pixels);
        }
    }
}

/// Accumulates a shape into the cells and says how to read them.
#[inline(never)]
fn accumulate<S: Simd>(
    simd: S,
    frame: &Frame<'_>,
    scratch: &mut BandScratch,
    geometry: &Geometry,
    antialias: Antialias,
    edges: &[Edge],
) -> CoverageRule {
    simd.vectorize(
        #[inline(always)]
        || accumulate_inner(simd, frame, scratch, geometry, antialias, edges),
    )
}

#[inline(always)]
fn accumulate_inner<S: Simd>(
    simd: S,
    frame: &Frame<'_>,
    scratch: &mut BandScratch,
    geometry: &Geometry,
    antialias: Antialias,
    edges: &[Edge],
) -> CoverageRule {
    let rule = match geometry {
        Geometry::Fill { rule, .. } => *rule,
        _ => FillRule::NonZero,
    };
    if let Geometry::Spans(range) = geometry {
        add_spans(frame, &mut scratch.cells, frame.list.spans.get(range.0 as usize..range.1 as usize).unwrap_or(&[]));
        return CoverageRule::NonZero;
    }
    let top = frame.top << 8;
    let grid = match antialias {
        Antialias::Analytic => {
            // Sums by the even-odd rule may wrap around: what is lost is even.
            if edges.len() >= cell::CROWD && rule == FillRule::NonZero {
                cell::add_crowd(simd, &mut scratch.cells, edges, top, frame.strips, &scratch.reaches);
                return rule.into();
            }
            for edge in edges {
                cell::add_edge::<S, false>(simd, &mut scratch.cells, *edge, top, frame.strips, &scratch.reaches);
            }
            return rule.into();
        }
        Antialias::Exact => {
            let crowded = exact::crowded_strips(edges, top, frame.strips);
            cell::add_touching_edges(simd, &mut scratch.cells, edges, top, frame.strips);
            for strip in 0..frame.strips {
                let Some(mut cells) = scratch.cells.strip(strip) else { break };
                let strip_top = top + ((strip * BLOCK_HEIGHT) << 8) as i32;
                let all_rows = crowded >> strip & 1 == 1;
                exact::resolve(&mut cells, edges, strip_top, rule, all_rows, &mut scratch.exact);
            }
            return rule.into();
        }
        Antialias::Supersample(grid) => grid.clamp(1, 16),
        Antialias::None => 1,
    };
    for strip in 0..frame.strips {
        if let Some(mut cells) = scratch.cells.strip(strip) {
            let strip_top = top + ((strip * BLOCK_HEIGHT) << 8) as i32;
            sample::add_samples(&mut cells, edges, strip_top, grid, rule, &mut scratch.sample);
        }
    }
    CoverageRule::Samples(u16::from(grid) * u16::from(grid))
}

/// Adds the whole pixels of `spans` (in order of rows) that lie in this band.
fn add_spans(frame: &Frame<'_>, cells: &mut Accumulator, spans: &[Span]) {
    let first = spans.partition_point(|span| span.y < frame.top);
    let end = spans.partition_point(|span| span.y < frame.top + frame.rows as i32);
    for span in spans.get(first..end).unwrap_or(&[]) {
        let row = (span.y - frame.top) as usize;
        let Some(mut strip) = cells.strip(row / BLOCK_HEIGHT) else { continue };
        let limit = (frame.blocks * BLOCK_WIDTH) as i32;
        let (start, end) = (span.start.clamp(0, limit), span.end.clamp(0, limit));
        if start < end {
            let row = row % BLOCK_HEIGHT;
            strip.add_row_piece(row, start << 8, start << 8, 256);
            strip.add_row_piece(row, end << 8, end << 8, -256);
        }
    }
}

/// Brings the coverage of `clip` into the cache's chain, at its end.
#[inline(always)]
fn clip_for<S: Simd>(simd: S, frame: &Frame<'_>, scratch: &mut BandScratch, clip: ClipId) {
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
    scratch.reaches.clear();
    for (id, node) in missing.into_iter().rev() {
        let mut mask = scratch.clips.spare.pop().unwrap_or_default();
        mask.reset(frame.blocks, frame.strips);
        match &node.kind {
            ClipKind::Geometry { geometry, antialias } => {
                let found = scratch.clips.edges.binary_search_by_key(&id, |(clip, ..)| *clip);
                let place = found.ok().and_then(|index| scratch.clips.edges.get(index)).copied();
                let edges = place
                    .and_then(|(_, chunk, (start, end))| {
                        frame.chunks.get(chunk)?.band(frame.index)?.edges.get(start as usize..end as usize)
                    })
                    .unwrap_or(&[]);
                let rule = accumulate(simd, frame, scratch, geometry, *antialias, edges);
                let parent = scratch.clips.chain.last().map(|(_, mask)| mask);
                for strip in 0..frame.strips {
                    if scratch.cells.is_occupied(strip)
                        && let Some(mut cells) = scratch.cells.strip(strip)
                    {
                        let mut sink = ClipSink { mask: &mut mask, strip, parent };
                        sweep(simd, &mut cells, frame.blocks, rule, &mut sink);
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

impl ClipCache {
    fn reset(&mut self) {
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
    fn current(&self, clip: ClipId) -> Option<&BandMask> {
        if clip == ClipId::NONE { None } else { self.chain.last().map(|(_, mask)| mask) }
    }
}

/// Where a painter's colours come from.
enum Source<'a> {
    /// One premultiplied colour.
    Solid([u8; 4]),
    /// A function of the pixel.
    Paint(&'a PreparedPaint),
    /// A finished layer.
    Layer(Surface<'a>),
}

/// How covered pixels look.
struct Look<'a> {
    source: Source<'a>,
    blend_mode: BlendMode,
    /// What coverage is multiplied by.
    opacity: u8,
    clip: Option<&'a BandMask>,
}

/// Sweeps all strips' cells onto a surface.
#[inline(never)]
fn paint_cells<S: Simd>(
    simd: S,
    frame: &Frame<'_>,
    cells: &mut Accumulator,
    rule: CoverageRule,
    look: Look<'_>,
    surface: &mut Surface<'_>,
    seen: (&Occlusion, &[(usize, usize)]),
) {
    simd.vectorize(
        #[inline(always)]
        || paint_cells_inner(simd, frame, cells, rule, look, surface, seen),
    )
}

#[inline(always)]
fn paint_cells_inner<S: Simd>(
    simd: S,
    frame: &Frame<'_>,
    cells: &mut Accumulator,
    rule: CoverageRule,
    mut look: Look<'_>,
    surface: &mut Surface<'_>,
    (occlusion, visible): (&Occlusion, &[(usize, usize)]),
) {
    let mut pattern = [0; ROW_BYTES];
    if let Source::Solid(color) = look.source {
        for pixel in pattern.as_chunks_mut::<4>().0 {
            *pixel = color;
        }
    }
    for strip in 0..frame.strips {
        if !cells.is_occupied(strip) {
            continue;
        }
        let rows = surface.strip_rows(strip);
        let top = frame.top + (strip * BLOCK_HEIGHT) as i32;
        if let Some(mut cells) = cells.strip(strip) {
            let end = visible.get(strip).map_or(frame.blocks, |(_, end)| *end);
            let occlusion = visible.get(strip).map(|_| occlusion);
            let mut painter = Painter { look: &mut look, pattern, occlusion, surface, strip, rows, top };
            sweep(simd, &mut cells, end, rule, &mut painter);
        }
    }
}

/// Draws the coverage of one strip.
struct Painter<'a, 'b, 'c> {
    look: &'a mut Look<'b>,
    /// A block's row of the one colour, if there is one.
    pattern: [u8; ROW_BYTES],
    /// What is hidden, if anything is.
    occlusion: Option<&'a Occlusion>,
    surface: &'a mut Surface<'c>,
    strip: usize,
    /// Rows of the strip that exist.
    rows: usize,
    /// Device y of the strip's first row.
    top: i32,
}

impl<S: Simd> BlockSink<S> for Painter<'_, '_, '_> {
    #[inline(always)]
    fn wants(&self, index: usize) -> bool {
        self.occlusion.is_none_or(|occlusion| !occlusion.is_hidden(self.strip, index))
    }

    #[inline(always)]
    fn block(&mut self, simd: S, index: usize, mask: &MaskBlock) {
        if self.look.clip.is_none() && self.look.opacity == 255 {
            self.paint(simd, index, mask);
            return;
        }
        let mut mask = *mask;
        if self.cut(simd, index, &mut mask) {
            self.paint(simd, index, &mask);
        }
    }

    #[inline(always)]
    fn run(&mut self, simd: S, mut start: usize, end: usize, rows: &[u8; BLOCK_HEIGHT]) {
        if self.occlusion.is_some() {
            // Between hidden blocks.
            while start < end {
                if !BlockSink::<S>::wants(self, start) {
                    start += 1;
                    continue;
                }
                let from = start;
                while start < end && BlockSink::<S>::wants(self, start) {
                    start += 1;
                }
                self.visible_run(simd, from, start, rows);
            }
        } else {
            self.visible_run(simd, start, end, rows);
        }
    }
}

impl Painter<'_, '_, '_> {
    #[inline(always)]
    fn visible_run<S: Simd>(&mut self, simd: S, start: usize, end: usize, rows: &[u8; BLOCK_HEIGHT]) {
        if self.look.clip.is_none()
            && self.look.blend_mode == BlendMode::SourceOver
            && let Source::Solid(color) = self.look.source
        {
            self.fill_run(simd, start, end, rows, color);
            return;
        }
        let mut mask = EMPTY_MASK;
        for (out, value) in mask.iter_mut().zip(rows) {
            *out = [*value; BLOCK_WIDTH];
        }
        for index in start..end {
            self.block(simd, index, &mask);
        }
    }

    /// Multiplies coverage by opacity and clip; false where nothing is left.
    #[inline(never)]
    fn cut<S: Simd>(&self, simd: S, index: usize, mask: &mut MaskBlock) -> bool {
        simd.vectorize(
            #[inline(always)]
            || self.cut_inner(simd, index, mask),
        )
    }

    #[inline(always)]
    fn cut_inner<S: Simd>(&self, simd: S, index: usize, mask: &mut MaskBlock) -> bool {
        match self.look.clip.map_or(ClipBlock::Full, |clip| clip.get(self.strip, index)) {
            ClipBlock::Empty => return false,
            ClipBlock::Full => {}
            ClipBlock::Partial(clip) => {
                for (mask, clip) in mask.iter_mut().zip(clip) {
                    scale_mask_row(simd, mask, clip);
                }
            }
        }
        if self.look.opacity != 255 {
            for mask in mask.iter_mut() {
                scale_mask_row_by(simd, mask, self.look.opacity);
            }
        }
        true
    }

    /// Source-over of one colour along whole blocks of constant coverage.
    #[inline(never)]
    fn fill_run<S: Simd>(&mut self, simd: S, start: usize, end: usize, rows: &[u8; BLOCK_HEIGHT], color: [u8; 4]) {
        simd.vectorize(
            #[inline(always)]
            || self.fill_run_inner(simd, start, end, rows, color),
        );
    }

    #[inline(always)]
    fn fill_run_inner<S: Simd>(
        &mut self,
        simd: S,
        start: usize,
        end: usize,
        rows: &[u8; BLOCK_HEIGHT],
        color: [u8; 4],
    ) {
        for (row, &coverage) in rows.iter().enumerate().take(self.rows) {
            if coverage == 0 {
                continue;
            }
            let row = self.strip * BLOCK_HEIGHT + row;
            let slice = self.surface.row(row, start, end);
            let (blocks, tail) = slice.as_chunks_mut::<ROW_BYTES>();
            if coverage == 255 && color[3] == 255 {
                // Whole blocks at a time: four bytes at a time would be stored one by one.
                for pixels in blocks {
                    *pixels = self.pattern;
                }
                for (byte, pattern) in tail.iter_mut().zip(self.pattern) {
                    *byte = pattern;
                }
                continue;
            }
            let last = start + blocks.len();
            for pixels in blocks {
                if coverage == 255 {
                    over_solid_full(simd, pixels, color);
                } else {
                    over_solid_row(simd, pixels, color, &[coverage; BLOCK_WIDTH]);
                }
            }
            if !tail.is_empty() {
                self.surface.with_row(
                    row,
                    last,
                    #[inline(always)]
                    |pixels| {
                        over_solid_row(simd, pixels, color, &[coverage; BLOCK_WIDTH]);
                    },
                );
            }
        }
    }

    /// Draws one block by its final coverage.
    #[inline(never)]
    fn paint<S: Simd>(&mut self, simd: S, index: usize, mask: &MaskBlock) {
        simd.vectorize(
            #[inline(always)]
            || self.paint_inner(simd, index, mask),
        );
    }

    #[inline(always)]
    fn paint_inner<S: Simd>(&mut self, simd: S, index: usize, mask: &MaskBlock) {
        let first_row = self.strip * BLOCK_HEIGHT;
        let over = self.look.blend_mode == BlendMode::SourceOver;
        if over && let Source::Solid(color) = self.look.source {
            for (row, mask) in mask.iter().enumerate().take(self.rows) {
                if *mask == [0; BLOCK_WIDTH] {
                    continue;
                }
                let pattern = &self.pattern;
                self.surface.with_row(
                    first_row + row,
                    index,
                    #[inline(always)]
                    |pixels| {
                        if color[3] == 255 && *mask == [255; BLOCK_WIDTH] {
                            *pixels = *pattern;
                        } else if color[3] == 255 {
                            over_opaque_row(simd, pixels, color, mask);
                        } else {
                            over_solid_row(simd, pixels, color, mask);
                        }
                    },
                );
            }
            return;
        }
        let mut source = NO_PIXELS;
        let mut opaque = false;
        match &mut self.look.source {
            Source::Solid(_) => source = [self.pattern; BLOCK_HEIGHT],
            Source::Paint(paint) => {
                opaque = paint.is_opaque();
                fetch_block(simd, paint, (index * BLOCK_WIDTH) as i32, self.top, &mut source);
            }
            Source::Layer(layer) => {
                source = layer.load(self.strip, index);
                if over && source == NO_PIXELS {
                    return;
                }
            }
        }
        if !over {
            let mut pixels = self.surface.load(self.strip, index);
            composite_block(simd, self.look.blend_mode, &mut pixels, &source, mask);
            self.surface.store(self.strip, index, &pixels);
            return;
        }
        for (row, (mask, source)) in mask.iter().zip(&source).enumerate().take(self.rows) {
            if *mask == [0; BLOCK_WIDTH] {
                continue;
            }
            let full = *mask == [255; BLOCK_WIDTH];
            self.surface.with_row(
                first_row + row,
                index,
                #[inline(always)]
                |pixels| match (opaque, full) {
                    (true, true) => *pixels = *source,
                    (true, false) => mix_pixels_row(simd, pixels, source, mask),
                    (false, true) => over_pixels_full(simd, pixels, source),
                    (false, false) => over_pixels_row(simd, pixels, source, mask),
                },
            );
        }
    }
}

impl From<FillRule> for CoverageRule {
    fn from(rule: FillRule) -> Self {
        match rule {
            FillRule::NonZero => Self::NonZero,
            FillRule::EvenOdd => Self::EvenOdd,
        }
    }
}
