//! Rectangles in one opaque colour, of which user interfaces, plots and grids are made: without the painter's choices among colours,
//! blends and clips.

use fearless_simd::Simd;

use super::band::Frame;
use super::occlusion::Occlusion;
use super::painter::fill_run;
use super::surface::{StripRows, Surface, fill_line};
use crate::blend::{OpaqueRow, over_opaque_row};
use crate::geom::FixedRect;
use crate::num::fixed;
use crate::raster::sweep::{BlockSink, RectSide, sweep_rect};
use crate::surface::block::{BLOCK_HEIGHT, BlockCoverage};

/// Draws a rectangle in one opaque colour over what is there: its coverage is reckoned strip by strip.
#[inline(never)]
pub(super) fn paint_opaque_rect<S: Simd>(
    simd: S,
    frame: &Frame<'_>,
    rect: FixedRect,
    color: [u8; 4],
    surface: &mut Surface<'_>,
    occlusion: &Occlusion,
) {
    simd.vectorize(
        #[inline(always)]
        || {
            let bounds = rect.pixels();
            for strip in frame.strips_of(bounds) {
                let (first, end) = occlusion.visible(strip, bounds);
                if first < end {
                    let mut painter = OpaquePainter { occlusion, rows: surface.strip(strip), strip, color };
                    sweep_rect(simd, rect, frame.strip_top(strip) << fixed::SHIFT, end, &mut painter);
                }
            }
        },
    )
}

/// Draws the coverage of one strip.
struct OpaquePainter<'a, 'b> {
    occlusion: &'a Occlusion,
    rows: StripRows<'b>,
    strip: usize,
    color: [u8; 4],
}

impl<S: Simd> BlockSink<S> for OpaquePainter<'_, '_> {
    #[inline(always)]
    fn wants(&self, index: usize) -> bool {
        !self.occlusion.is_hidden(self.strip, index)
    }

    #[inline(always)]
    fn block(&mut self, simd: S, index: usize, coverage: BlockCoverage<'_>) {
        let color = self.color;
        self.rows.with_block(
            index,
            #[inline(always)]
            |mut rows| {
                rows.each(
                    coverage.covered,
                    #[inline(always)]
                    |row, pixels| {
                        if let Some(mask) = coverage.mask.get(row) {
                            over_opaque_row(simd, pixels, color, mask);
                        }
                    },
                );
            },
        );
    }

    #[inline(always)]
    fn side(&mut self, simd: S, index: usize, side: &RectSide<'_>) {
        paint_side(simd, &mut self.rows, index, side, self.color);
    }

    #[inline(always)]
    fn run(&mut self, simd: S, mut start: usize, end: usize, rows: &[u8; BLOCK_HEIGHT]) {
        while let Some((from, to)) = self.occlusion.visible_run(self.strip, start, end) {
            // Nearly always all rows are covered whole.
            if *rows == [u8::MAX; BLOCK_HEIGHT] {
                let color = self.color;
                self.rows.lines(from, to).each(
                    #[inline(always)]
                    |line| fill_line(simd, line, color),
                );
            } else {
                fill_run(simd, &mut self.rows, from, to, rows, self.color, true);
            }
            start = to;
        }
    }
}

/// A block in which a rectangle starts or ends.
#[inline(never)]
fn paint_side<S: Simd>(simd: S, rows: &mut StripRows<'_>, index: usize, side: &RectSide<'_>, color: [u8; 4]) {
    simd.vectorize(
        #[inline(always)]
        || paint_side_inner(simd, rows, index, side, color),
    );
}

#[inline(always)]
fn paint_side_inner<S: Simd>(simd: S, rows: &mut StripRows<'_>, index: usize, side: &RectSide<'_>, color: [u8; 4]) {
    // Most rows share their coverage.
    let whole = OpaqueRow::new(simd, color, &side.row(simd, fixed::ONE));
    rows.with_block(
        index,
        #[inline(always)]
        |mut rows| {
            if side.whole_rows {
                rows.each_one(
                    #[inline(always)]
                    |pixels| whole.over(simd, pixels),
                );
                return;
            }
            rows.with(
                side.heights,
                #[inline(always)]
                |height, pixels| match height {
                    0 => {}
                    256 => whole.over(simd, pixels),
                    part => over_opaque_row(simd, pixels, color, &side.row(simd, *part)),
                },
            );
        },
    );
}
