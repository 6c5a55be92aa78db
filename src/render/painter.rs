//! Where coverage meets colour: blocks of coverage are cut by the clip, given colours and blended into rows.

use fearless_simd::Simd;

use super::band::Frame;
use super::clip::{BandMask, ClipBlock};
use super::coverage::Coverage;
use super::kept::{Kept, KeptCoverage, Place};
use super::occlusion::Occlusion;
use super::surface::{NO_PIXELS, ROW_BYTES, StripRows, Surface, fill_line};
use crate::blend::{
    BlendMode, composite_block, mix_pixels_row, over_opaque_row, over_pixels_full, over_pixels_row, over_solid_full,
    over_solid_row, scale_mask_row, scale_mask_row_by,
};
use crate::display_list::Draw;
use crate::geom::{FixedRect, IntRect};
use crate::num::fixed;
use crate::paint::{PreparedPaint, fetch_block};
use crate::raster::cell::Accumulator;
use crate::raster::rect::sweep_rect;
use crate::raster::sweep::BlockSink;
use crate::surface::block::{BLOCK_HEIGHT, BLOCK_WIDTH, BlockCoverage, MaskBlock};

const EMPTY_MASK: MaskBlock = [[0; BLOCK_WIDTH]; BLOCK_HEIGHT];

/// Where a painter's colours come from.
pub(super) enum Source<'a> {
    /// One premultiplied colour.
    Solid([u8; 4]),
    /// A function of the pixel.
    Paint(&'a PreparedPaint),
    /// A finished layer.
    Layer(Surface<'a>),
}

/// How covered pixels look.
pub(super) struct Look<'a> {
    pub(super) source: Source<'a>,
    pub(super) blend_mode: BlendMode,
    /// What coverage is multiplied by.
    pub(super) opacity: u8,
    pub(super) clip: Option<&'a BandMask>,
}

/// Draws the coverage of a shape in `bounds` (device pixels) onto a surface; `cells` hold it, or it is a rectangle's.
#[inline(never)]
pub(super) fn paint_coverage<S: Simd>(
    simd: S,
    frame: &Frame<'_>,
    cells: &mut Accumulator,
    (coverage, bounds): (Coverage, IntRect),
    look: Look<'_>,
    surface: &mut Surface<'_>,
    seen: (&Occlusion, &[(usize, usize)]),
) {
    simd.vectorize(
        #[inline(always)]
        || paint_coverage_inner(simd, frame, cells, (coverage, bounds), look, surface, seen),
    )
}

#[inline(always)]
fn paint_coverage_inner<S: Simd>(
    simd: S,
    frame: &Frame<'_>,
    cells: &mut Accumulator,
    (coverage, bounds): (Coverage, IntRect),
    mut look: Look<'_>,
    surface: &mut Surface<'_>,
    (occlusion, visible): (&Occlusion, &[(usize, usize)]),
) {
    let pattern = &look.pattern();
    for strip in frame.strips_of(bounds) {
        if coverage.is_empty(frame, cells, strip) {
            continue;
        }
        let (rows, top) = (surface.strip(strip), frame.strip_top(strip));
        let end = visible.get(strip).map_or(frame.blocks, |(_, end)| *end);
        let occlusion = visible.get(strip).map(|_| occlusion);
        let mut painter = Painter { look: &mut look, pattern, occlusion, rows, strip, top };
        coverage.sweep(simd, frame, cells, strip, end, &mut painter);
    }
}

/// Draws a rectangle in one translucent colour over what is there: its coverage is reckoned strip by strip.
#[inline(never)]
pub(super) fn paint_rect<S: Simd>(
    simd: S,
    frame: &Frame<'_>,
    rect: FixedRect,
    color: [u8; 4],
    surface: &mut Surface<'_>,
    occlusion: &Occlusion,
) {
    simd.vectorize(
        #[inline(always)]
        || paint_rect_inner(simd, frame, rect, color, surface, occlusion),
    )
}

#[inline(always)]
fn paint_rect_inner<S: Simd>(
    simd: S,
    frame: &Frame<'_>,
    rect: FixedRect,
    color: [u8; 4],
    surface: &mut Surface<'_>,
    occlusion: &Occlusion,
) {
    let mut look = Look { source: Source::Solid(color), blend_mode: BlendMode::SourceOver, opacity: 255, clip: None };
    let pattern = &look.pattern();
    let bounds = rect.pixels();
    for strip in frame.strips_of(bounds) {
        let (first, end) = occlusion.visible(strip, bounds);
        if first < end {
            let (rows, top) = (surface.strip(strip), frame.strip_top(strip));
            let mut painter = Painter { look: &mut look, pattern, occlusion: Some(occlusion), rows, strip, top };
            sweep_rect(simd, rect, top << fixed::SHIFT, end, &mut painter);
        }
    }
}

/// Draws the coverage that was kept last.
#[inline(never)]
pub(super) fn paint_kept<S: Simd>(
    simd: S,
    frame: &Frame<'_>,
    kept: &mut Kept,
    look: Look<'_>,
    surface: &mut Surface<'_>,
) {
    simd.vectorize(
        #[inline(always)]
        || paint_kept_inner(simd, frame, kept, look, surface),
    )
}

#[inline(always)]
fn paint_kept_inner<S: Simd>(
    simd: S,
    frame: &Frame<'_>,
    kept: &mut Kept,
    mut look: Look<'_>,
    surface: &mut Surface<'_>,
) {
    let pattern = &look.pattern();
    kept.take(
        #[inline(always)]
        |Place { strip, start, end }, coverage| {
            let (rows, top) = (surface.strip(strip), frame.strip_top(strip));
            let mut painter = Painter { look: &mut look, pattern, occlusion: None, rows, strip, top };
            match coverage {
                KeptCoverage::Mask(coverage) => painter.block(simd, start, coverage),
                KeptCoverage::Rows(rows) => painter.visible_run(simd, start, end, &rows),
            }
        },
    );
}

impl<'a> Look<'a> {
    /// How a draw's covered pixels look.
    pub(super) fn new(draw: &Draw, paint: &'a PreparedPaint, clip: Option<&'a BandMask>) -> Self {
        let source = match paint {
            PreparedPaint::Nothing => Source::Solid([0; 4]),
            PreparedPaint::Solid(color) => Source::Solid(*color),
            paint => Source::Paint(paint),
        };
        // Opaque colours replace what is below either way; the usual mode has the shorter paths.
        let blend_mode = match draw.blend_mode {
            BlendMode::Source if paint.is_opaque() => BlendMode::SourceOver,
            mode => mode,
        };
        Self { source, blend_mode, opacity: 255, clip }
    }

    /// A block's row of the one colour, if there is one.
    fn pattern(&self) -> [u8; ROW_BYTES] {
        let mut pattern = [0; ROW_BYTES];
        if let Source::Solid(color) = self.source {
            for pixel in pattern.as_chunks_mut::<4>().0 {
                *pixel = color;
            }
        }
        pattern
    }
}

/// Draws the coverage of one strip.
struct Painter<'a, 'b, 'c> {
    look: &'a mut Look<'b>,
    /// A block's row of the one colour, if there is one.
    pattern: &'a [u8; ROW_BYTES],
    /// What is hidden, if anything is.
    occlusion: Option<&'a Occlusion>,
    /// The strip's rows.
    rows: StripRows<'c>,
    strip: usize,
    /// Device y of the strip's first row.
    top: i32,
}

impl<S: Simd> BlockSink<S> for Painter<'_, '_, '_> {
    #[inline(always)]
    fn wants(&self, index: usize) -> bool {
        self.occlusion.is_none_or(|occlusion| !occlusion.is_hidden(self.strip, index))
    }

    #[inline(always)]
    fn block(&mut self, simd: S, index: usize, coverage: BlockCoverage<'_>) {
        if self.look.clip.is_none() && self.look.opacity == 255 {
            self.paint(simd, index, coverage);
            return;
        }
        let mut mask = *coverage.mask;
        if self.cut(simd, index, &mut mask) {
            self.paint(simd, index, BlockCoverage::of(&mask));
        }
    }

    #[inline(always)]
    fn run(&mut self, simd: S, mut start: usize, end: usize, rows: &[u8; BLOCK_HEIGHT]) {
        let Some(occlusion) = self.occlusion else { return self.visible_run(simd, start, end, rows) };
        while let Some((from, to)) = occlusion.visible_run(self.strip, start, end) {
            self.visible_run(simd, from, to, rows);
            start = to;
        }
    }
}

impl Painter<'_, '_, '_> {
    #[inline(always)]
    fn visible_run<S: Simd>(&mut self, simd: S, start: usize, end: usize, rows: &[u8; BLOCK_HEIGHT]) {
        if self.look.clip.is_none()
            && let Source::Solid(color) = self.look.source
        {
            let whole = || rows.iter().take(self.rows.count()).all(|coverage| matches!(coverage, 0 | 255));
            match self.look.blend_mode {
                BlendMode::SourceOver => {
                    return fill_run(simd, &mut self.rows, start, end, rows, color, color[3] == 255);
                }
                // What is covered whole is replaced, whatever the colour's alpha.
                BlendMode::Source if whole() => return fill_run(simd, &mut self.rows, start, end, rows, color, true),
                _ => {}
            }
        }
        let mut mask = EMPTY_MASK;
        for (out, value) in mask.iter_mut().zip(rows) {
            *out = [*value; BLOCK_WIDTH];
        }
        let coverage = BlockCoverage::of(&mask);
        for index in start..end {
            self.block(simd, index, coverage);
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

    /// Draws one block by its final coverage.
    #[inline(always)]
    fn paint<S: Simd>(&mut self, simd: S, index: usize, coverage: BlockCoverage<'_>) {
        match self.look.source {
            Source::Solid(color) if self.look.blend_mode == BlendMode::SourceOver => {
                self.paint_solid(simd, index, coverage, color);
            }
            _ => self.paint_pixels(simd, index, coverage),
        }
    }

    /// Source-over of one colour, by far the most frequent.
    #[inline(never)]
    fn paint_solid<S: Simd>(&mut self, simd: S, index: usize, coverage: BlockCoverage<'_>, color: [u8; 4]) {
        simd.vectorize(
            #[inline(always)]
            || self.paint_solid_inner(simd, index, coverage, color),
        );
    }

    #[inline(always)]
    fn paint_solid_inner<S: Simd>(&mut self, simd: S, index: usize, coverage: BlockCoverage<'_>, color: [u8; 4]) {
        let (pattern, opaque) = (self.pattern, color[3] == 255);
        let BlockCoverage { mask, covered, full } = coverage;
        self.rows.with_block(
            index,
            #[inline(always)]
            |mut rows| {
                if !opaque {
                    rows.each(
                        covered,
                        #[inline(always)]
                        |row, pixels| {
                            if let Some(mask) = mask.get(row) {
                                over_solid_row(simd, pixels, color, mask);
                            }
                        },
                    );
                    return;
                }
                rows.each(
                    full,
                    #[inline(always)]
                    |_, pixels| *pixels = *pattern,
                );
                rows.each(
                    covered.without(full),
                    #[inline(always)]
                    |row, pixels| {
                        if let Some(mask) = mask.get(row) {
                            over_opaque_row(simd, pixels, color, mask);
                        }
                    },
                );
            },
        );
    }

    /// Any blend of any source.
    #[inline(never)]
    fn paint_pixels<S: Simd>(&mut self, simd: S, index: usize, coverage: BlockCoverage<'_>) {
        simd.vectorize(
            #[inline(always)]
            || self.paint_pixels_inner(simd, index, coverage),
        );
    }

    #[inline(always)]
    fn paint_pixels_inner<S: Simd>(&mut self, simd: S, index: usize, coverage: BlockCoverage<'_>) {
        let BlockCoverage { mask, covered, full } = coverage;
        let over = self.look.blend_mode == BlendMode::SourceOver;
        let mut source = NO_PIXELS;
        let mut opaque = false;
        match &mut self.look.source {
            Source::Solid(_) => source = [*self.pattern; BLOCK_HEIGHT],
            Source::Paint(paint) => {
                opaque = paint.is_opaque();
                fetch_block(simd, paint, (index * BLOCK_WIDTH) as i32, self.top, &mut source);
            }
            Source::Layer(layer) => {
                source = layer.strip(self.strip).load(index);
                if over && source == NO_PIXELS {
                    return;
                }
            }
        }
        if !over {
            let mut pixels = self.rows.load(index);
            composite_block(simd, self.look.blend_mode, &mut pixels, &source, mask);
            self.rows.store(index, &pixels);
            return;
        }
        self.rows.with_block(
            index,
            #[inline(always)]
            |mut rows| {
                rows.each(
                    full,
                    #[inline(always)]
                    |row, pixels| match source.get(row) {
                        Some(source) if opaque => *pixels = *source,
                        Some(source) => over_pixels_full(simd, pixels, source),
                        None => {}
                    },
                );
                rows.each(
                    covered.without(full),
                    #[inline(always)]
                    |row, pixels| {
                        let (Some(mask), Some(source)) = (mask.get(row), source.get(row)) else { return };
                        if opaque {
                            mix_pixels_row(simd, pixels, source, mask);
                        } else {
                            over_pixels_row(simd, pixels, source, mask);
                        }
                    },
                );
            },
        );
    }
}

/// Source-over of one colour along whole blocks of constant coverage. `replaces` says that nothing stays of what full
/// coverage covers.
#[inline(never)]
pub(super) fn fill_run<S: Simd>(
    simd: S,
    strip: &mut StripRows<'_>,
    start: usize,
    end: usize,
    rows: &[u8; BLOCK_HEIGHT],
    color: [u8; 4],
    replaces: bool,
) {
    simd.vectorize(
        #[inline(always)]
        || fill_run_inner(simd, strip, start, end, rows, color, replaces),
    );
}

#[inline(always)]
fn fill_run_inner<S: Simd>(
    simd: S,
    strip: &mut StripRows<'_>,
    start: usize,
    end: usize,
    rows: &[u8; BLOCK_HEIGHT],
    color: [u8; 4],
    replaces: bool,
) {
    let mut lines = strip.lines(start, end);
    // Nearly always all rows are covered whole.
    if *rows == [u8::MAX; BLOCK_HEIGHT] {
        if replaces {
            lines.each(
                #[inline(always)]
                |line| fill_line(simd, line, color),
            );
        } else {
            lines.each(
                #[inline(always)]
                |line| {
                    let (blocks, tail) = line.as_chunks_mut::<ROW_BYTES>();
                    for pixels in blocks {
                        over_solid_full(simd, pixels, color);
                    }
                    over_cut_row(simd, tail, color, u8::MAX);
                },
            );
        }
        return;
    }
    lines.with(
        rows,
        #[inline(always)]
        |&coverage, line| {
            if coverage == 0 {
                return;
            }
            if coverage == 255 && replaces {
                return fill_line(simd, line, color);
            }
            let (blocks, tail) = line.as_chunks_mut::<ROW_BYTES>();
            for pixels in blocks {
                over_solid_row(simd, pixels, color, &[coverage; BLOCK_WIDTH]);
            }
            over_cut_row(simd, tail, color, coverage);
        },
    );
}

/// Source-over of one colour on a part of a block's row, by the same coverage throughout.
#[inline(always)]
fn over_cut_row<S: Simd>(simd: S, part: &mut [u8], color: [u8; 4], coverage: u8) {
    if !part.is_empty() {
        over_cut_row_of_some(simd, part, color, coverage);
    }
}

/// Out of the way of the loops that go along whole blocks.
#[cold]
#[inline(never)]
fn over_cut_row_of_some<S: Simd>(simd: S, part: &mut [u8], color: [u8; 4], coverage: u8) {
    simd.vectorize(
        #[inline(always)]
        || {
            let mut pixels = [0; ROW_BYTES];
            for (copy, byte) in pixels.iter_mut().zip(part.iter()) {
                *copy = *byte;
            }
            over_solid_row(simd, &mut pixels, color, &[coverage; BLOCK_WIDTH]);
            for (byte, copy) in part.iter_mut().zip(pixels) {
                *byte = copy;
            }
        },
    );
}
