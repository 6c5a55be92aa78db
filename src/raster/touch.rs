//! Which pixels the edges of a shape touch once, and which more often: those that exact antialiasing has to look at
//! again ([`exact`](super::exact)).

use fearless_simd::prelude::*;

use super::cell::{Accumulator, BandPixel};
use super::edge::Edge;
use super::kernel::{CROWD, Reach, add_edge};
use crate::num::fixed;
use crate::style::FillRule;
use crate::surface::block::BLOCK_HEIGHT;

/// Where the edges added so far end.
#[derive(Clone, Copy, Default)]
pub(crate) struct Trail {
    before: Option<Edge>,
    chain: Option<Chain>,
}

/// Adds the edges of a shape, which go on from `trail`, within the reaches, and notes which pixels they touch once and more often. Horizontal
/// ones add nothing, but touch pixels as well: windings change at them.
///
/// The pixel in which an edge starts where the one before it ended is not touched twice by that: along each scanline
/// either one of them is crossed, or both, one way and the other, and the sum of their areas is right by any fill rule. So
/// it is with more that follow each other in one pixel, as long as none crosses another: see [`Chain`].
#[inline(always)]
pub(crate) fn add_touching_edges<S: Simd>(
    simd: S,
    cells: &mut Accumulator,
    edges: &[Edge],
    top: i32,
    strips: usize,
    reaches: &[Reach],
    trail: &mut Trail,
) {
    cells.keep_marks();
    let Trail { before, chain } = trail;
    for edge in edges {
        if edge.y0 == edge.y1 {
            touch_horizontally(cells, edge, top);
            *before = None;
            continue;
        }
        let joint = before.filter(|before| before.meets(*edge)).and_then(|before| {
            let pixel = pixel_within(edge.x0, edge.y0 - top)?;
            let extended = match chain.take().filter(|chain| chain.pixel == pixel) {
                Some(chain) => chain.extend(before, *edge),
                None => Chain::new(pixel, before, *edge),
            };
            *chain = Some(extended);
            extended.is_simple().then_some(pixel)
        });
        let old = joint.and_then(|pixel| Some((pixel, *cells.marks(pixel)?)));
        add_edge::<S, true>(simd, cells, *edge, top, strips, reaches);
        if let Some((pixel, old)) = old
            && let Some(marks) = cells.marks(pixel)
        {
            let row = 1 << pixel.row;
            marks.once = marks.once & !row | old.once & row;
            marks.twice = marks.twice & !row | old.twice & row;
        }
        *before = Some(*edge);
    }
}

/// Edges that follow each other, all joints in one pixel.
///
/// None crosses another if all go up or all down, or if they turn one way and by less than half a turn in all: a scanline
/// then crosses one of them, or two that wind against each other.
#[derive(Clone, Copy)]
struct Chain {
    pixel: BandPixel,
    /// Its first edge.
    first: Edge,
    /// Whether all go up or all down.
    monotone: bool,
    /// Whether they turn one way: which, or 0 as long as they go straight on.
    convex: bool,
    turn: i64,
}

impl Chain {
    /// Two edges that meet in `pixel`.
    #[inline(always)]
    fn new(pixel: BandPixel, first: Edge, second: Edge) -> Self {
        let monotone = first.goes_on_with(second);
        let turn = first.turn_to(second);
        // Straight back is no turn to either side.
        Self { pixel, first, monotone, convex: turn != 0 || monotone, turn }
    }

    /// With one edge more, after `before`.
    #[inline(always)]
    fn extend(self, before: Edge, next: Edge) -> Self {
        let goes_on = before.goes_on_with(next);
        let turn = before.turn_to(next);
        let one_way = if turn == 0 { goes_on } else { self.turn == 0 || self.turn == turn };
        let turn = if self.turn == 0 { turn } else { self.turn };
        let convex = self.convex && one_way && (self.first.turn_to(next) == turn);
        Self { monotone: self.monotone && goes_on, convex, turn, ..self }
    }

    #[inline(always)]
    fn is_simple(self) -> bool {
        self.monotone || self.convex
    }
}

/// As [`add_touching_edges`], for more edges than whose areas 32 bits can sum; the cells then keep what they set aside, for
/// [`resolve`](super::exact::resolve) to know the windings.
#[inline(always)]
pub(crate) fn add_touching_crowd<S: Simd>(
    simd: S,
    cells: &mut Accumulator,
    edges: &[Edge],
    top: i32,
    strips: usize,
    rule: FillRule,
) {
    let mut trail = Trail::default();
    for crowd in edges.chunks(CROWD - 1) {
        add_touching_edges(simd, cells, crowd, top, strips, &[], &mut trail);
        cells.set_aside();
    }
    cells.bring_back(rule);
}

/// Marks the pixels inside which a horizontal edge lies.
#[inline(never)]
fn touch_horizontally(cells: &mut Accumulator, edge: &Edge, top: i32) {
    let y = edge.y0 - top;
    if y < 0 || y & (fixed::ONE - 1) == 0 {
        return;
    }
    let (left, right) = if edge.x0 < edge.x1 { (edge.x0, edge.x1) } else { (edge.x1, edge.x0) };
    let row = (y >> fixed::SHIFT) as usize;
    let Some(strip) = cells.strip(row / BLOCK_HEIGHT) else { return };
    let (first, last) = ((left >> fixed::SHIFT) as usize, (right >> fixed::SHIFT) as usize);
    strip.occupy(first, last);
    for marks in strip.marks.get_mut(first..=last).unwrap_or(&mut []) {
        marks.touch(1 << (row % BLOCK_HEIGHT));
    }
}

/// The pixel of a point (y from the band's top), if the point is inside of it and not on a side, where its neighbour might
/// be meant.
#[inline(always)]
fn pixel_within(x: i32, y: i32) -> Option<BandPixel> {
    let inside = |v: i32| v >= 0 && v & (fixed::ONE - 1) != 0;
    if !inside(x) || !inside(y) {
        return None;
    }
    let row = (y >> fixed::SHIFT) as usize;
    Some(BandPixel { strip: row / BLOCK_HEIGHT, column: (x >> fixed::SHIFT) as usize, row: row % BLOCK_HEIGHT })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::level::{SimdLevel, dispatch};

    /// The pixels of a band of 64 × 32 that are touched twice: (column, row).
    fn touched_twice(points: &[(i32, i32)]) -> Vec<(usize, usize)> {
        let mut cells = Accumulator::default();
        cells.resize(64, 4);
        let next = points.iter().cycle().skip(1);
        let edges: Vec<Edge> =
            points.iter().zip(next).map(|(a, b)| Edge { x0: a.0, y0: a.1, x1: b.0, y1: b.1 }).collect();
        dispatch!(SimdLevel::best(), simd => add_touching_edges(simd, &mut cells, &edges, 0, 4, &[], &mut Trail::default()));
        let mut found = Vec::new();
        for strip in 0..4 {
            for (column, marks) in cells.strip(strip).unwrap().marks.iter().enumerate() {
                found.extend((0..8).filter(|row| marks.twice >> row & 1 == 1).map(|row| (column, strip * 8 + row)));
            }
        }
        found
    }

    #[test]
    fn a_smooth_outline_touches_hardly_any_pixel_twice() {
        let points: Vec<(i32, i32)> = (0..40)
            .map(|i| {
                let angle = f64::from(i) / 40.0 * std::f64::consts::TAU;
                let [x, y] = [libm::cos(angle), libm::sin(angle)].map(|v| ((v * 6.0 + 16.03) * 256.0) as i32);
                (x, y)
            })
            .collect();
        let found = touched_twice(&points);
        assert!(found.len() < 5, "{found:?}");
    }
}
