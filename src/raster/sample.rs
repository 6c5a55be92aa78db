//! Sampled coverage: n × n samples a pixel, and pixel centres alone.

use super::cell::Strip;
use super::edge::Edge;
use crate::style::FillRule;
use crate::surface::block::BLOCK_HEIGHT;

/// Working memory of the sampling rasterizer.
#[derive(Debug, Default)]
pub(crate) struct SampleScratch {
    /// Crossings of each sample row of a strip: (sample column, winding).
    rows: Vec<Vec<(i32, i32)>>,
}

/// Adds to a strip's cells how many of the n × n samples of each pixel lie inside the outline.
///
/// Samples lie at the centres of a regular n × n grid in the pixel. A sample on an edge is inside if the
/// inside is to its right (or, on a vertex, below it): along each sample row an edge takes part for
/// y0 ≤ y < y1, and its crossing belongs to the samples at and right of it.
pub(crate) fn add_samples(
    cells: &mut Strip<'_>,
    edges: &[Edge],
    top: i32,
    grid: u8,
    rule: FillRule,
    scratch: &mut SampleScratch,
) {
    let n = i32::from(grid.clamp(1, 16));
    let sample_rows = BLOCK_HEIGHT * n as usize;
    scratch.rows.resize_with(sample_rows.max(scratch.rows.len()), Vec::new);
    let Some(rows) = scratch.rows.get_mut(..sample_rows) else { return };
    rows.iter_mut().for_each(Vec::clear);

    // Sample row k lies at y = top + (2k + 1) · 256 / 2n; positions are compared times 2n, so that
    // nothing is rounded.
    let scale = 2 * i64::from(n);
    for edge in edges {
        let (x0, y0, x1, y1, winding) = edge.downward();
        // The first sample row at or below y0: (2k + 1) · 256 ≥ (y0 − top) · 2n.
        let first_at = |y: i32| {
            let scaled = (i64::from(y) - i64::from(top)) * scale - 256;
            (-(-scaled).div_euclid(512)).clamp(0, sample_rows as i64) as usize
        };
        let (first, last) = (first_at(y0), first_at(y1));
        let (dx, dy) = (i64::from(x1) - i64::from(x0), i64::from(y1) - i64::from(y0));
        for (k, row) in rows.iter_mut().enumerate().take(last).skip(first) {
            // x · 2n · dy at this sample row, exactly; then the first sample column at or right of it:
            // (2j + 1) · 256 ≥ x · 2n.
            let below = i64::from(top) * scale + (2 * k as i64 + 1) * 256 - i64::from(y0) * scale;
            let x_times = i128::from(x0) * i128::from(scale) * i128::from(dy) + i128::from(dx) * i128::from(below);
            let column = -(256 * i128::from(dy) - x_times).div_euclid(512 * i128::from(dy));
            row.push((column as i32, winding));
        }
    }

    for (k, row) in rows.iter_mut().enumerate() {
        row.sort_unstable();
        let pixel_row = k / n as usize;
        let mut around = 0_i32;
        let mut start = 0;
        for &(column, winding) in row.iter() {
            let was = inside(around, rule);
            around = around.wrapping_add(winding);
            match (was, inside(around, rule)) {
                (false, true) => start = column,
                (true, false) if start < column => add_span(cells, pixel_row, start, column, n),
                _ => {}
            }
        }
        // Edges right of everything that can be drawn are not listed: what is inside stays so.
        if inside(around, rule) {
            add_span(cells, pixel_row, start, i32::MAX, n);
        }
    }
}

/// Whether a winding number is inside by a fill rule.
#[inline(always)]
pub(crate) fn inside(winding: i32, rule: FillRule) -> bool {
    match rule {
        FillRule::NonZero => winding != 0,
        FillRule::EvenOdd => winding & 1 != 0,
    }
}

/// Adds the samples `start..end` of a sample row to pixel row `row`, n samples a pixel.
pub(crate) fn add_span(cells: &mut Strip<'_>, row: usize, start: i32, end: i32, n: i32) {
    let columns = cells.columns.len() as i32;
    let (start, end) = (start.max(0), end.min((columns - 1) * n));
    if start >= end {
        return;
    }
    cells.occupy((start / n) as usize, (end / n) as usize + 1);
    for (at, sign) in [(start, 1), (end, -1)] {
        let (column, within) = ((at / n) as usize, at % n);
        if let Some([here, next]) = cells.columns.get_mut(column..).and_then(|c| c.first_chunk_mut::<2>()) {
            if let (Some(here), Some(next)) = (here.0.get_mut(row), next.0.get_mut(row)) {
                *here += sign * (n - within);
                *next += sign * within;
            }
        }
    }
}
