//! Rectangles in one opaque colour, of which user interfaces, plots and grids are made: without the painter's choices among colours,
//! blends and clips.

use fearless_simd::Simd;

use super::band::Frame;
use super::occlusion::{Halves, Occlusion, bits};
use super::painter::fill_run;
use super::surface::{StripRows, Surface, fill_line};
use crate::blend::{OpaqueRow, over_opaque_row};
use crate::geom::FixedRect;
use crate::num::fixed;
use crate::raster::rect::{RectColumns, RectRows, RectSide};

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
        || paint_inner(simd, frame, rect, color, surface, occlusion),
    )
}

#[inline(always)]
fn paint_inner<S: Simd>(
    simd: S,
    frame: &Frame<'_>,
    rect: FixedRect,
    color: [u8; 4],
    surface: &mut Surface<'_>,
    occlusion: &Occlusion,
) {
    let Some(columns) = RectColumns::of(rect, frame.blocks) else { return };
    let sides = [Side::new(simd, columns.left, color), Side::new(simd, columns.right, color)];
    let bounds = rect.pixels();
    let (strips, halves) = (frame.strips_of(bounds), Halves::touched(bounds));
    // Canvases of up to 1,024 pixels have one word a row.
    for word in Halves::words(&halves) {
        let (asked, whole) = (Halves::of(&halves, word), bits(columns.whole.clone(), word));
        for strip in strips.clone() {
            let mut seen = occlusion.seen(strip, word, asked);
            if seen == 0 {
                continue;
            }
            let rows = &RectRows::of(simd, rect, frame.strip_top(strip) << fixed::SHIFT);
            let pixels = &mut surface.strip(strip);
            for side in sides.iter().flatten() {
                if side.side.block / 64 == word && seen >> (side.side.block % 64) & 1 == 1 {
                    paint_side(simd, pixels, side, rows, color);
                }
            }
            seen &= whole;
            while seen != 0 {
                let first = seen.trailing_zeros();
                let count = (seen >> first).trailing_ones();
                let (from, to) = (word * 64 + first as usize, word * 64 + (first + count) as usize);
                if rows.are_whole {
                    pixels.lines(from, to).each(
                        #[inline(always)]
                        |line| fill_line(simd, line, color),
                    );
                } else {
                    fill_run(simd, pixels, from, to, &rows.coverage, color, true);
                }
                // What is added to the lowest of the ones carries past the last of its run.
                seen &= seen.wrapping_add(1 << first);
            }
        }
    }
}

/// A block in which a rectangle starts or ends.
struct Side<S: Simd> {
    side: RectSide,
    /// The colour by the coverage that most rows share.
    whole: OpaqueRow<S>,
}

impl<S: Simd> Side<S> {
    #[inline(always)]
    fn new(simd: S, side: Option<RectSide>, color: [u8; 4]) -> Option<Self> {
        let side = side?;
        Some(Self { side, whole: OpaqueRow::new(simd, color, &side.row(simd, fixed::ONE)) })
    }
}

#[inline(never)]
fn paint_side<S: Simd>(simd: S, pixels: &mut StripRows<'_>, side: &Side<S>, rows: &RectRows, color: [u8; 4]) {
    simd.vectorize(
        #[inline(always)]
        || paint_side_inner(simd, pixels, side, rows, color),
    );
}

#[inline(always)]
fn paint_side_inner<S: Simd>(simd: S, pixels: &mut StripRows<'_>, side: &Side<S>, rows: &RectRows, color: [u8; 4]) {
    let Side { side, whole } = side;
    pixels.with_block(
        side.block,
        #[inline(always)]
        |mut block| {
            if rows.are_whole {
                block.each_one(
                    #[inline(always)]
                    |pixels| whole.over(simd, pixels),
                );
                return;
            }
            block.with(
                &rows.heights,
                #[inline(always)]
                |height, pixels| match *height {
                    0 => {}
                    fixed::ONE => whole.over(simd, pixels),
                    part => over_opaque_row(simd, pixels, color, &side.row(simd, part)),
                },
            );
        },
    );
}
