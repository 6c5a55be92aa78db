//! Thin bars in one colour: from their runs of coverage straight into the rows, without cells and blocks.

use fearless_simd::prelude::*;
use fearless_simd::u16x16;

use super::band::Frame;
use super::surface::Surface;
use crate::blend::SolidRun;
use crate::raster::bar::{RUN, RunSink};
use crate::raster::bins::BarItem;

/// Draws a bar in one colour over what is there. What is hidden is painted as well: what hides it comes later, and overwrites it.
#[inline(never)]
pub(super) fn paint_bar<S: Simd>(
    simd: S,
    frame: &Frame<'_>,
    item: &BarItem,
    color: [u8; 4],
    surface: &mut Surface<'_>,
) {
    simd.vectorize(
        #[inline(always)]
        || {
            if color[3] == 255 {
                paint_bar_inner::<S, true>(simd, frame, item, color, surface);
            } else {
                paint_bar_inner::<S, false>(simd, frame, item, color, surface);
            }
        },
    )
}

#[inline(always)]
fn paint_bar_inner<S: Simd, const OPAQUE: bool>(
    simd: S,
    frame: &Frame<'_>,
    item: &BarItem,
    color: [u8; 4],
    surface: &mut Surface<'_>,
) {
    let clip = item.clip.intersect(surface.area(frame.top));
    let (left, right, top) = (clip.left, clip.right, frame.top);
    let painter = &mut RunPainter::<S, OPAQUE> { color: SolidRun::new(simd, color), surface, top, left, right };
    item.bar.cover(simd, clip, painter);
}

/// Puts a colour over runs.
struct RunPainter<'a, 'b, S: Simd, const OPAQUE: bool> {
    color: SolidRun<S>,
    surface: &'a mut Surface<'b>,
    /// Device y of the surface's first row.
    top: i32,
    /// The columns that may be drawn.
    left: i32,
    right: i32,
}

impl<S: Simd, const OPAQUE: bool> RunSink<S> for RunPainter<'_, '_, S, OPAQUE> {
    #[inline(always)]
    fn run(&mut self, simd: S, row: i32, column: i32, coverage: u16x16<S>) {
        if column >= self.left && column + RUN <= self.right {
            if let Some(pixels) = self.surface.from(row - self.top, column).first_chunk_mut::<32>() {
                self.color.over::<OPAQUE>(simd, pixels, coverage);
            }
        } else {
            self.cut_run(simd, row, column, coverage);
        }
    }
}

impl<S: Simd, const OPAQUE: bool> RunPainter<'_, '_, S, OPAQUE> {
    /// As [`run`](RunSink::run), for one of which not all may be drawn.
    #[cold]
    #[inline(never)]
    fn cut_run(&mut self, simd: S, row: i32, column: i32, coverage: u16x16<S>) {
        let (start, end) = (column.max(self.left), (column + RUN).min(self.right));
        if start >= end {
            return;
        }
        let Some(part) = self.surface.from(row - self.top, start).get_mut(..(end - start) as usize * 4) else { return };
        let mut pixels = [0; 32];
        let inside = (start - column) as usize * 4..(end - column) as usize * 4;
        let Some(copy) = pixels.get_mut(inside.clone()) else { return };
        copy.copy_from_slice(part);
        let coverage = coverage.to_array();
        let color = self.color;
        simd.vectorize(
            #[inline(always)]
            || color.over::<OPAQUE>(simd, &mut pixels, u16x16::load_array(simd, coverage)),
        );
        if let Some(copy) = pixels.get(inside) {
            part.copy_from_slice(copy);
        }
    }
}
