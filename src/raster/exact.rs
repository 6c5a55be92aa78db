//! Exact coverage where edges meet inside a pixel.
//!
//! Summed areas are exact for a pixel that one edge passes through. Where two do, the sum knows how much
//! each covers, not how much both do: the fill rule then has to be applied to the windings before
//! the areas are added. (Two that follow each other up or down count as one: no scanline crosses both.)
//! This is done for whole rows of a strip in which some pixel is touched twice: the row is cut at edge ends
//! and at crossings into slabs in which the edges keep their order, the rule picks the edges that
//! separate inside from outside, and those alone are accumulated again.

use fearless_simd::Simd;

use super::cell::{Accumulator, BandPixel, StripCells};
use super::edge::{Edge, EdgeLine};
use super::kernel::{CROWD, add_edge};
use super::sample::inside;
use crate::num::fixed;
use crate::style::FillRule;
use crate::surface::block::{BLOCK_HEIGHT, BLOCK_WIDTH};

/// At most so many edge pieces are sorted per row: with many edges in a row, the slabs get coarser
/// (never fewer than [`FEWEST_SLABS`]), so that a row's cost stays linear in its edges. With more edges than that their
/// crossings are not looked for.
const PIECES_PER_ROW: usize = 8192;
const FEWEST_SLABS: usize = 4;

/// Working memory.
#[derive(Debug, Default)]
pub(crate) struct ExactScratch {
    /// For each row of the strip the edges that it crosses.
    rows: [Vec<Part>; BLOCK_HEIGHT],
    ends: Vec<i32>,
    active: Vec<Crossing>,
}

/// The strips (as bits) of a band with so many edges that their cells' sums mean nothing, so that all rows
/// have to be resolved. `top` is the band's top in fixed point.
pub(crate) fn crowded_strips(edges: &[Edge], top: i32, strips: usize) -> u128 {
    if edges.len() < CROWD {
        return 0;
    }
    let mut counts = [0_usize; 128];
    for edge in edges {
        let (_, y0, _, y1, _) = edge.downward();
        let strip = |y: i32| ((y - top) / (BLOCK_HEIGHT as i32 * fixed::ONE)).max(0) as usize;
        for count in counts.iter_mut().take(strips.min(strip(y1 - 1) + 1)).skip(strip(y0)) {
            *count += 1;
        }
    }
    counts.iter().enumerate().fold(0, |bits, (strip, count)| bits | u128::from(*count >= CROWD) << strip)
}

/// Adds the edges of a shape and notes which pixels they touch once and more often.
///
/// Where an edge goes on, up or down, from the end of the one before it, the pixel in which they meet is not touched
/// twice: along each scanline only one of them is crossed, and the sum of their areas is right by any fill rule.
#[inline(always)]
pub(crate) fn add_touching_edges<S: Simd>(simd: S, cells: &mut Accumulator, edges: &[Edge], top: i32, strips: usize) {
    let mut before: Option<Edge> = None;
    for edge in edges {
        let joint = before.filter(|before| before.goes_on_with(*edge)).and_then(|_| pixel_within(edge, top));
        let marks = joint.and_then(|joint| cells.marks(joint).map(|marks| (joint, *marks)));
        add_edge::<S, true>(simd, cells, *edge, top, strips, &[]);
        if let Some((joint, [once, twice])) = marks
            && let Some(marks) = cells.marks(joint)
        {
            let row = 1 << joint.row;
            *marks = [marks[0] & !row | once & row, marks[1] & !row | twice & row];
        }
        before = Some(*edge);
    }
}

/// The pixel in which an edge starts, if that is inside of it and not on a side, where its neighbour might be meant.
#[inline(always)]
fn pixel_within(edge: &Edge, top: i32) -> Option<BandPixel> {
    let (x, y) = (edge.x0, edge.y0 - top);
    let inside = |v: i32| v >= 0 && v & (fixed::ONE - 1) != 0;
    if !inside(x) || !inside(y) {
        return None;
    }
    let row = (y >> fixed::SHIFT) as usize;
    Some(BandPixel { strip: row / BLOCK_HEIGHT, column: (x >> fixed::SHIFT) as usize, row: row % BLOCK_HEIGHT })
}

/// The part of an edge in one row.
#[derive(Clone, Copy, Debug)]
struct Part {
    line: EdgeLine,
    y0: i32,
    y1: i32,
    winding: i32,
}

/// A part in one slab: where it enters at the top and leaves at the bottom.
#[derive(Clone, Copy, Debug)]
struct Crossing {
    top_x: i32,
    bottom_x: i32,
    winding: i32,
}

/// Replaces the cells of rows in which some pixel is touched twice by exact ones, or those of all rows. `top` is
/// the strip's top in fixed point; `edges` are all that were added to it.
pub(crate) fn resolve(
    cells: &mut StripCells<'_>,
    edges: &[Edge],
    top: i32,
    rule: FillRule,
    all_rows: bool,
    scratch: &mut ExactScratch,
) {
    let all = if all_rows { 0xff } else { 0 };
    let rows = take_touched(cells) | rows_with_horizontal_edges(edges, top) | all;
    if rows == 0 {
        return;
    }
    clear_rows(cells, rows);
    scratch.rows.iter_mut().for_each(Vec::clear);
    for edge in edges {
        let (x0, y0, x1, y1, winding) = edge.downward();
        let first = ((y0 - top) >> fixed::SHIFT).max(0);
        let last = ((y1 - 1 - top) >> fixed::SHIFT).min(BLOCK_HEIGHT as i32 - 1);
        if first > last {
            continue;
        }
        let line = EdgeLine::new(x0, y0, x1, y1);
        for row in first..=last {
            if rows >> row & 1 == 1 {
                let row_top = top + (row << fixed::SHIFT);
                let part = Part { line, y0: y0.max(row_top), y1: y1.min(row_top + fixed::ONE), winding };
                if let Some(list) = scratch.rows.get_mut(row as usize) {
                    list.push(part);
                }
            }
        }
    }
    for (row, parts) in scratch.rows.iter().enumerate() {
        if rows >> row & 1 == 1 {
            resolve_row(cells, row, parts, rule, &mut scratch.ends, &mut scratch.active);
        }
    }
}

/// The rows with a pixel that two edges touch; clears the marks.
fn take_touched(cells: &mut StripCells<'_>) -> u8 {
    let mut rows = 0;
    for_occupied(cells.occupied, |block| {
        let start = block * BLOCK_WIDTH;
        for column in cells.touched.get_mut(start..start + BLOCK_WIDTH).unwrap_or(&mut []) {
            let [once, twice] = column;
            rows |= *twice;
            (*once, *twice) = (0, 0);
        }
    });
    rows
}

/// The rows inside which an outline goes on horizontally. Such edges are not listed, for they enclose nothing, but
/// the cover that begins or ends with them reaches pixels that no other edge touches.
///
/// They show as ends inside a row that no other edge takes up: of each corner of an outline one edge arrives and one
/// departs, so that the differences of a hash of their positions sum to zero.
fn rows_with_horizontal_edges(edges: &[Edge], top: i32) -> u8 {
    let mut sums = [0_u32; BLOCK_HEIGHT];
    let mut add = |x: i32, y: i32, sign: u32| {
        let row = (y - top) >> fixed::SHIFT;
        if y & (fixed::ONE - 1) != 0
            && let Some(sum) = usize::try_from(row).ok().and_then(|row| sums.get_mut(row))
        {
            let hash = (x as u32).wrapping_mul(0x9e37_79b1) ^ (y as u32).wrapping_mul(0x85eb_ca77);
            *sum = sum.wrapping_add((hash ^ hash >> 15).wrapping_mul(sign));
        }
    };
    for edge in edges {
        add(edge.x0, edge.y0, 1);
        add(edge.x1, edge.y1, u32::MAX);
    }
    sums.iter().enumerate().fold(0, |rows, (row, sum)| rows | u8::from(*sum != 0) << row)
}

/// Sets the cells of the given rows to zero.
fn clear_rows(cells: &mut StripCells<'_>, rows: u8) {
    let mut keep = [0; BLOCK_HEIGHT];
    for (row, keep) in keep.iter_mut().enumerate() {
        *keep = if rows >> row & 1 == 1 { 0 } else { -1 };
    }
    for_occupied(cells.occupied, |block| {
        let start = block * BLOCK_WIDTH;
        for column in cells.columns.get_mut(start..start + BLOCK_WIDTH).unwrap_or(&mut []) {
            for (value, keep) in column.iter_mut().zip(keep) {
                *value &= keep;
            }
        }
    });
}

fn for_occupied(occupied: &[u64], mut f: impl FnMut(usize)) {
    for (index, word) in occupied.iter().enumerate() {
        let mut bits = *word;
        while bits != 0 {
            f(index * 64 + bits.trailing_zeros() as usize);
            bits &= bits - 1;
        }
    }
}

fn resolve_row(
    cells: &mut StripCells<'_>,
    row: usize,
    parts: &[Part],
    rule: FillRule,
    ends: &mut Vec<i32>,
    active: &mut Vec<Crossing>,
) {
    ends.clear();
    ends.extend(parts.iter().flat_map(|part| [part.y0, part.y1]));
    ends.sort_unstable();
    ends.dedup();
    let thinnest =
        (fixed::ONE as usize * parts.len() / PIECES_PER_ROW).clamp(1, fixed::ONE as usize / FEWEST_SLABS) as i32;
    let crowded = parts.len() > PIECES_PER_ROW;
    let mut rest = &ends[..];
    while let [top, after @ ..] = rest {
        let Some(bottom) = after.iter().find(|y| **y - top >= thinnest).or(after.last()).copied() else { break };
        rest = &rest[rest.iter().position(|y| *y == bottom).unwrap_or(rest.len())..];
        let mut top = *top;
        while top < bottom {
            enter(parts, top, bottom, active);
            let cut = if crowded { bottom } else { first_crossing(active, top, bottom, thinnest) };
            if cut < bottom {
                enter(parts, top, cut, active);
            }
            add_slab(cells, row, active, top, cut, rule);
            top = cut;
        }
    }
}

/// The parts that cross a slab, by where they enter it.
///
/// Where ends closer together than the thinnest slab are passed over, the parts that cross the slab's
/// middle stand for it: along one scanline, windings close.
fn enter(parts: &[Part], top: i32, bottom: i32, active: &mut Vec<Crossing>) {
    let middle = top + (bottom - top) / 2;
    active.clear();
    active.extend(parts.iter().filter(|part| part.y0 <= middle && middle < part.y1).map(|part| {
        let (y0, y1) = (part.y0.max(top), part.y1.min(bottom));
        Crossing { top_x: part.line.x_at(y0), bottom_x: part.line.x_at(y1), winding: part.winding }
    }));
    active.sort_unstable_by_key(|c| (c.top_x, c.bottom_x));
}

/// Changes of order by less than 1/32 pixel do not move coverage visibly.
const NEAR: i32 = 8;
const SWAPS_PER_EDGE: usize = 16;

/// Where the first two neighbours change their order, or `bottom`. Never less than `thinnest` below `top`.
///
/// `active` is sorted by x at the top. Neighbours that cross right there are swapped, so that each meets its
/// neighbours below the crossing.
fn first_crossing(active: &mut [Crossing], top: i32, bottom: i32, thinnest: i32) -> i32 {
    let mut cut = bottom;
    let mut index = 0;
    // Each swap mends the order at the bottom: there are no more swaps than crossings. Where there are very many, what
    // is left of them shows no more.
    let mut swaps_left = SWAPS_PER_EDGE * active.len();
    while let Some([a, b]) = active.get_mut(index..).and_then(|rest| rest.first_chunk_mut()) {
        let (apart, past) = (i64::from(b.top_x - a.top_x), i64::from(a.bottom_x - b.bottom_x));
        if past > i64::from(NEAR) {
            if apart <= i64::from(NEAR) && swaps_left > 0 {
                swaps_left -= 1;
                std::mem::swap(a, b);
                index = index.saturating_sub(1);
                continue;
            }
            let apart = apart.max(0);
            cut = cut.min(top + (i64::from(bottom - top) * apart / (apart + past)) as i32);
        }
        index += 1;
    }
    cut.max(top + thinnest).min(bottom)
}

/// Accumulates the edges of a slab that separate inside from outside.
fn add_slab(cells: &mut StripCells<'_>, row: usize, active: &mut [Crossing], top: i32, bottom: i32, rule: FillRule) {
    active.sort_unstable_by_key(|c| i64::from(c.top_x) + i64::from(c.bottom_x));
    let mut around = 0_i32;
    for crossing in active.iter() {
        let was = inside(around, rule);
        around = around.wrapping_add(crossing.winding);
        let is = inside(around, rule);
        if was != is {
            let dy = bottom - top;
            cells.add_row_piece(row, crossing.top_x, crossing.bottom_x, if is { dy } else { -dy });
        }
    }
}
