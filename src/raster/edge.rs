//! Edges: the straight pieces of outlines, in 24.8 fixed point.

use fearless_simd::prelude::*;
use fearless_simd::{f32x16, i32x8};

use crate::geom::Point;
use crate::num::fixed;
use crate::num::lanes::{round_f64, truncate_sixteen_f32};

/// A corner of an outline, in 1/256 pixel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(crate) struct FixedPoint {
    pub(crate) x: i32,
    pub(crate) y: i32,
}

/// A piece of an outline from (x0, y0) to (x1, y1) in 1/256 pixel. Never horizontal; it winds
/// positively where it goes down.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Edge {
    pub(crate) x0: i32,
    pub(crate) y0: i32,
    pub(crate) x1: i32,
    pub(crate) y1: i32,
}

impl Edge {
    /// The edge from top to bottom, and its winding: (x0, y0, x1, y1, ±1).
    #[inline(always)]
    pub(crate) fn downward(self) -> (i32, i32, i32, i32, i32) {
        if self.y0 < self.y1 {
            (self.x0, self.y0, self.x1, self.y1, 1)
        } else {
            (self.x1, self.y1, self.x0, self.y0, -1)
        }
    }
}

/// A line through an edge, from which x at any y is one multiplication away.
///
/// x(y) is a pure function of the edge and of y, so that bands, strips and rows that share a scanline
/// agree on where it is crossed.
#[derive(Clone, Copy, Debug)]
pub(crate) struct EdgeLine {
    x0: i64,
    y0: i64,
    /// dx / dy in 32.32 fixed point.
    slope: i64,
}

impl EdgeLine {
    /// The line through (x0, y0) and (x1, y1), y0 < y1, |x1 − x0| < 2^30.
    #[inline(always)]
    pub(crate) fn new(x0: i32, y0: i32, x1: i32, y1: i32) -> Self {
        let slope = (i64::from(x1) - i64::from(x0)) * (1 << 32) / (i64::from(y1) - i64::from(y0));
        Self { x0: i64::from(x0), y0: i64::from(y0), slope }
    }

    /// x at y, for y between the edge's ends: |slope · (y − y0)| ≤ |dx| · 2^32 < 2^62.
    #[inline(always)]
    pub(crate) fn x_at(self, y: i32) -> i32 {
        (self.x0 + ((self.slope * (i64::from(y) - self.y0) + (1 << 31)) >> 32)) as i32
    }
}

/// Where an edge crosses the tops of strips, finer than its ends, so that it does not show that this is rounded once more.
///
/// In `f64`, which has room for the product whole but for bits that do not matter: a vector of edges at once is as easy as
/// one of them.
#[derive(Clone, Copy, Debug)]
pub(super) struct FineLine {
    /// x where it starts.
    pub(super) x: f64,
    /// dx / dy, in 1/4096 pixel per 1/256.
    pub(super) slope: f64,
}

impl FineLine {
    /// Fraction bits of x.
    pub(super) const SHIFT: u32 = 12;

    /// The line from x0 to x1, for edges that are clipped to a surface, which goes down by `height` > 0.
    #[inline(always)]
    pub(super) fn new(x0: i32, x1: i32, height: i32) -> Self {
        const FINER: f64 = (1 << (FineLine::SHIFT - fixed::SHIFT)) as f64;
        Self { x: f64::from(x0) * FINER, slope: f64::from(x1 - x0) * FINER / f64::from(height) }
    }

    /// x so far below its start, in 20.12 fixed point.
    #[inline(always)]
    pub(super) fn x_at(self, down: i32) -> i32 {
        round_f64(self.x + self.slope * f64::from(down))
    }
}

/// Eight points in fixed point. Not a closure: those are not always inlined, and lose the SIMD level then.
#[inline(always)]
fn rounded<S: Simd>(simd: S, block: [Point; 8]) -> [FixedPoint; 8] {
    // A float times a power of two is exact, so that it is rounded once.
    let v = f32x16::load_array(simd, bytemuck::cast(block)) * fixed::ONE as f32;
    bytemuck::cast(truncate_sixteen_f32(v.round_ties_even()).to_array())
}

/// Appends a closed polygon's corners in fixed point, rounded to nearest, ties to even: eight device points within ±2^22 at a time, of which
/// `count` are the polygon's and the others are as its first. The answer says how many of them there are with the first one once more at
/// the end, where it may have been before; those that follow are as the first.
#[inline(always)]
pub(super) fn append_eights<S: Simd>(simd: S, eights: &[[Point; 8]], count: usize, out: &mut Vec<FixedPoint>) -> usize {
    let start = out.len();
    for block in eights {
        out.extend_from_slice(&rounded(simd, *block));
    }
    let ends = [out.get(start), out.get(start + count.saturating_sub(1))];
    if count > 1 && ends[0] == ends[1] { count } else { count + 1 }
}

/// As [`append_eights`], without what follows.
#[inline(always)]
pub(super) fn append_closed<S: Simd>(simd: S, eights: &[[Point; 8]], count: usize, out: &mut Vec<FixedPoint>) {
    let start = out.len();
    let count = append_eights(simd, eights, count, out);
    out.truncate(start + count);
}

/// Calls `f` with eight corners of an outline at a time: with the number of the first of them, with the corner after them, which is the first of
/// all where there is none, and with how many of the eight edges from corner to corner are among the first `count` of all.
#[inline(always)]
pub(super) fn for_eights(
    corners: &[FixedPoint],
    count: usize,
    mut f: impl FnMut(usize, &[FixedPoint; 8], FixedPoint, usize),
) {
    let first = corners.first().copied().unwrap_or_default();
    let mut rest = corners;
    for place in (0..count).step_by(8) {
        let Some((eight, after)) = rest.split_first_chunk::<8>() else { break };
        rest = after;
        f(place, eight, after.first().copied().unwrap_or(first), (count - place).min(8));
    }
}

/// The x and the y of eight points.
#[inline(always)]
pub(super) fn coordinates<S: Simd>(simd: S, points: &[FixedPoint; 8]) -> (i32x8<S>, i32x8<S>) {
    let [low, high]: [[i32; 8]; 2] = bytemuck::cast(*points);
    i32x8::load_array(simd, low).deinterleave(i32x8::load_array(simd, high))
}
