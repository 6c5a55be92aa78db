//! Bars: thin parallelograms, such as the stroke of a line, into runs of eight pixels without edges or cells.
//!
//! Where a bar is steep, eight rows are reckoned at once, each from the pixel in which it starts in that row; where it is flat, eight columns. Let
//! `t` be a place across: what of a row lies between a side of the bar and `t` is
//!
//! > height · R(t − middle),  R(u) = 0 up to −half, u from half on, (u + half)² / (4 half) in between
//!
//! where `height` is how much of the row the side climbs through, and `middle` ± `half` is where it does. The area of the bar up to `t` is the sum
//! of that for its sides, one way for those at its start, the other way for those at its end; a pixel's coverage is the difference of two such areas. It is exact
//! but for the rounding of `f32`, and a function of the bar and of the row or column alone: neither the band nor what is clipped away matters.

use std::ops::Range;

use fearless_simd::prelude::*;
use fearless_simd::{f32x8, u8x32, u16x16, u32x8};

use super::cell::{Accumulator, FULL};
use super::edge::FixedPoint;
use super::kernel::Reach;
use crate::geom::{IntRect, Point};
use crate::num::fixed;
use crate::num::lanes::{doubled_words, greater_f32, lesser_f32, round_raised_f32, truncate_f32};
use crate::surface::block::BLOCK_HEIGHT;

/// Pixels of a run.
pub(crate) const RUN: i32 = 8;

/// A bar that may reach over more of a row, and of a column, is drawn by its edges: less than would touch more pixels than a run has, by
/// what the sides may be off being parallel.
const WIDEST: f32 = RUN as f32 - 1.0 - MARGIN;
const MARGIN: f32 = 0.125;
/// Longer ones, in pixels, and those further away are drawn by their edges: `f32` would round too much of them.
const LONGEST: i32 = 2_048;
const FARTHEST: f32 = 65_536.0;

/// A thin parallelogram, in device space.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bar {
    corners: [FixedPoint; 4],
    /// The pixels that it may touch.
    pub(crate) bounds: IntRect,
    /// Whether a row holds no more of it than a run; if not, a column does.
    is_steep: bool,
    /// How many pixels a row touches at most, if it is steep.
    reach: i32,
}

/// Takes a bar's coverage.
pub(crate) trait RunSink<S: Simd> {
    /// The coverage of the eight pixels from (column, row) on, 0 ..= 255, twice each. Some of them may be beyond what is to be drawn.
    fn run(&mut self, simd: S, row: i32, column: i32, coverage: u16x16<S>);
}

impl Bar {
    /// That of a polygon, if it is one.
    pub(crate) fn new(polygon: &[Point]) -> Option<Self> {
        let corners: &[Point; 4] = polygon.try_into().ok()?;
        if !corners.iter().all(|p| p.x.abs() < FARTHEST && p.y.abs() < FARTHEST) {
            return None;
        }
        let corners = corners.map(|p| FixedPoint { x: fixed::from_f32(p.x), y: fixed::from_f32(p.y) });
        let [a, b, c, d] = corners;
        // Rounding takes its sides out of parallel by as much.
        let is_parallel = (a.x - b.x + c.x - d.x).abs() <= 2 && (a.y - b.y + c.y - d.y).abs() <= 2;
        let (one, other) = ((b.x - a.x, b.y - a.y), (d.x - a.x, d.y - a.y));
        let area =
            (i64::from(one.0) * i64::from(other.1) - i64::from(one.1) * i64::from(other.0)).unsigned_abs() as f32;
        let low = |v: [i32; 4]| v[0].min(v[1]).min(v[2]).min(v[3]) >> fixed::SHIFT;
        let high = |v: [i32; 4]| (v[0].max(v[1]).max(v[2]).max(v[3]) + fixed::ONE - 1) >> fixed::SHIFT;
        let (xs, ys) = ([a.x, b.x, c.x, d.x], [a.y, b.y, c.y, d.y]);
        let bounds = IntRect::from_ltrb(low(xs), low(ys), high(xs), high(ys));
        let (width, height) = (bounds.right - bounds.left, bounds.bottom - bounds.top);
        if !is_parallel || area == 0.0 || width > LONGEST || height > LONGEST {
            return None;
        }
        let long = if one.0.abs() + one.1.abs() > other.0.abs() + other.1.abs() { one } else { other };
        let (across, down) = (long.0.abs() as f32, long.1.abs() as f32);
        // How much of a row lies between the two long sides, wherever it is cut, and of a column.
        let of_row = if long.1 == 0 { f32::MAX } else { area / (down * fixed::ONE as f32) + across / down };
        let of_column = if long.0 == 0 { f32::MAX } else { area / (across * fixed::ONE as f32) + down / across };
        let is_steep = of_row < WIDEST || width < RUN;
        if !is_steep && of_column >= WIDEST {
            return None;
        }
        let reach = ((of_row.min(f32::from(u8::MAX)) + MARGIN) as i32 + 2).min(width).min(RUN);
        Some(Self { corners, bounds, is_steep, reach })
    }

    /// Reports what lies within `clip` (device pixels), and a little around it in runs that hold some of it.
    #[inline(always)]
    pub(crate) fn cover<S: Simd, K: RunSink<S>>(&self, simd: S, clip: IntRect, sink: &mut K) {
        let area = self.bounds.intersect(clip);
        if area.is_empty() {
            return;
        }
        if self.is_steep {
            self.cover_rows(simd, area, sink);
        } else {
            self.cover_columns(simd, area, sink);
        }
    }

    /// Its sides, with places along and across from its box's corner on: first those two that are longer along, of which the bar starts at the first.
    #[inline(always)]
    fn sides(&self) -> Sides {
        let (left, top) = (self.bounds.left << fixed::SHIFT, self.bounds.top << fixed::SHIFT);
        let [a, b, c, d] = self.corners;
        let place = |p: FixedPoint| if self.is_steep { (p.y - top, p.x - left) } else { (p.x - left, p.y - top) };
        let (a, b, c, d) = (place(a), place(b), place(c), place(d));
        // From a to b it goes on.
        let (a, b, c, d) = if (b.0 - a.0).abs() < (d.0 - a.0).abs() { (b, c, d, a) } else { (a, b, c, d) };
        let (a, b, c, d) = if b.0 < a.0 { (c, d, a, b) } else { (a, b, c, d) };
        let turn = i64::from(b.0 - a.0) * i64::from(d.1 - a.1) - i64::from(b.1 - a.1) * i64::from(d.0 - a.0);
        let (a, b, c, d) = if turn < 0 { (d, c, b, a) } else { (a, b, c, d) };
        Sides { first: Side::new(a, b), last: Side::new(c, d), ends: [Side::new(b, c), Side::new(d, a)] }
    }

    /// Eight rows at a time: each in one run.
    #[inline(always)]
    fn cover_rows<S: Simd, K: RunSink<S>>(&self, simd: S, area: IntRect, sink: &mut K) {
        let sides = self.sides();
        let mut row = area.top;
        while row < area.bottom {
            let along = (row - self.bounds.top) as f32;
            let (low, packed);
            if sides.is_between_ends(along) {
                let parts = sides.long_parts(simd, along);
                low = lesser_f32(parts[0].low, parts[1].low);
                packed = self.packed(
                    simd,
                    low,
                    #[inline(always)]
                    |at| area_between(simd, parts, at),
                );
            } else {
                let parts = sides.parts(simd, along);
                low = least_low(simd, &parts);
                packed = self.packed(
                    simd,
                    low,
                    #[inline(always)]
                    |at| area_up_to(simd, &parts, at),
                );
            }
            let columns = (truncate_f32(low) + self.bounds.left).to_array();
            let pairs = packed.as_flattened().as_chunks::<16>().0.iter().zip(columns.as_chunks::<2>().0);
            for ((pair, columns), first) in pairs.zip((row..area.bottom).step_by(2)) {
                let [a, b] = doubled_words(simd, pair);
                sink.run(simd, first, columns[0], a);
                if first + 1 < area.bottom {
                    sink.run(simd, first + 1, columns[1], b);
                }
            }
            row += BLOCK_HEIGHT as i32;
        }
    }

    /// The coverage of eight pixels of each of eight rows, from those on that hold `low`; `area` is what lies up to a place.
    #[inline(always)]
    fn packed<S: Simd>(&self, simd: S, low: f32x8<S>, area: impl Fn(f32x8<S>) -> f32x8<S>) -> [[u8; 32]; 2] {
        let mut at = truncate_f32(low).to_float::<f32x8<S>>();
        let mut before = f32x8::splat(simd, 0.0);
        let mut packed = [u32x8::splat(simd, 0); 2];
        for (packed, from) in packed.iter_mut().zip([0, 4]) {
            let count = (self.reach - from).clamp(0, 4);
            // A pixel a byte, the first of them the lowest in the end.
            for _ in 0..count {
                at += 1.0;
                let area = area(at);
                let coverage: u32x8<S> = round_raised_f32((area - before) * 255.0);
                *packed = (*packed >> 8) | (coverage << 24);
                before = area;
            }
            if count > 0 {
                *packed >>= 32 - 8 * count as u32;
            }
        }
        let [near, far] = packed;
        let mut bytes = [[0; 32]; 2];
        let [upper, lower] = &mut bytes;
        near.zip_low(far).bitcast::<u8x32<S>>().store_array(upper);
        near.zip_high(far).bitcast::<u8x32<S>>().store_array(lower);
        bytes
    }

    /// Eight columns at a time: a run in each row that they touch.
    #[inline(always)]
    fn cover_columns<S: Simd, K: RunSink<S>>(&self, simd: S, area: IntRect, sink: &mut K) {
        /// What rounding may take off a row's side.
        const SLACK: f32 = 1.0 / 64.0;
        let sides = self.sides();
        let IntRect { left, top, .. } = self.bounds;
        let (first, end) = sides.columns_of_rows((area.top - top) as f32, (area.bottom - top) as f32);
        let mut column = area.left.max(left + first);
        let last = area.right.min(left.saturating_add(end));
        while column < last {
            let along = (column - left) as f32;
            let (low, high) = sides.extent(along);
            let rows = (low - SLACK) as i32 + top..(high + SLACK) as i32 + 1 + top;
            if sides.is_between_ends(along) {
                let parts = sides.long_parts(simd, along);
                self.cover_runs(
                    simd,
                    column,
                    rows,
                    area,
                    sink,
                    #[inline(always)]
                    |at| area_between(simd, parts, at),
                );
            } else {
                let parts = sides.parts(simd, along);
                self.cover_runs(
                    simd,
                    column,
                    rows,
                    area,
                    sink,
                    #[inline(always)]
                    |at| area_up_to(simd, &parts, at),
                );
            }
            column += RUN;
        }
    }

    /// Reports those of `rows` that lie in `area`; `area_to` is what of eight columns lies up to a place.
    #[inline(always)]
    fn cover_runs<S: Simd, K: RunSink<S>>(
        &self,
        simd: S,
        column: i32,
        rows: Range<i32>,
        area: IntRect,
        sink: &mut K,
        area_to: impl Fn(f32x8<S>) -> f32x8<S>,
    ) {
        let (start, end) = (rows.start.max(area.top), rows.end.min(area.bottom));
        let mut at = f32x8::splat(simd, (start - self.bounds.top) as f32);
        // Nothing lies before the first row.
        let mut before = if start > rows.start { area_to(at) } else { f32x8::splat(simd, 0.0) };
        for row in start..end {
            at += 1.0;
            let area = area_to(at);
            let coverage: u32x8<S> = round_raised_f32((area - before) * 255.0);
            let coverage = coverage & 255;
            sink.run(simd, row, column, (coverage | (coverage << 16)).bitcast());
            before = area;
        }
    }
}

/// The sides of a bar.
struct Sides {
    /// The long sides: the one at which it starts across, and the one at which it ends.
    first: Side,
    last: Side,
    /// Those at its ends.
    ends: [Side; 2],
}

/// A side of a bar, from its start along to its end.
#[derive(Clone, Copy)]
struct Side {
    start: f32,
    end: f32,
    /// Where across it starts, and how much further it is one further along.
    at: f32,
    slope: f32,
    /// Half of what it is further along one further across.
    curve: f32,
    /// 1 where the bar starts at it, −1 where it ends.
    sign: f32,
}

/// What of a side lies in each of eight rows, or columns.
#[derive(Clone, Copy)]
struct Parts<S: Simd> {
    /// From where on across.
    low: f32x8<S>,
    /// How far it gets from there.
    spread: f32x8<S>,
    /// How much of the row it climbs through, and the factor of what grows with the square; negative where the bar ends at it.
    height: f32x8<S>,
    curve: f32x8<S>,
}

impl Sides {
    /// Whether the long sides alone lie in the eight rows, or columns, from a place along on, and all of those.
    #[inline(always)]
    fn is_between_ends(&self, along: f32) -> bool {
        let Self { first, last, .. } = self;
        let end = along + BLOCK_HEIGHT as f32;
        first.start <= along && last.start <= along && first.end >= end && last.end >= end
    }

    /// The parts of the long sides where there are no others.
    #[inline(always)]
    fn long_parts<S: Simd>(&self, simd: S, along: f32) -> [Parts<S>; 2] {
        [self.first.whole_parts(simd, along), self.last.whole_parts(simd, along)]
    }

    /// The parts of all sides.
    #[inline(always)]
    fn parts<S: Simd>(&self, simd: S, along: f32) -> [Parts<S>; 4] {
        let Self { first, last, ends: [a, b] } = self;
        [first.parts(simd, along), last.parts(simd, along), a.parts(simd, along), b.parts(simd, along)]
    }

    /// From where to where across the bar is in the eight columns from a place along on.
    #[inline(always)]
    fn extent(&self, along: f32) -> (f32, f32) {
        let Self { first, last, ends: [a, b] } = self;
        let (mut low, mut high) = (f32::MAX, 0.0_f32);
        for side in [first, last, a, b] {
            if side.start < along + RUN as f32 && side.end > along {
                for place in [side.across(along), side.across(along + RUN as f32)] {
                    low = if place < low { place } else { low };
                    high = if place > high { place } else { high };
                }
            }
        }
        (low, high)
    }

    /// The first and the end of the columns in which the bar lies between two scanlines, or a little more.
    #[inline(always)]
    fn columns_of_rows(&self, upper: f32, lower: f32) -> (i32, i32) {
        let Self { first, last, ends: [a, b] } = self;
        let (mut from, mut to) = (f32::MAX, 0.0_f32);
        for side in [first, last, a, b] {
            let (one, other) = (side.at, side.across(side.end));
            let (high, low) = if one < other { (one, other) } else { (other, one) };
            if high > lower + 1.0 || low < upper - 1.0 {
                continue;
            }
            let (start, end) = if side.slope < 0.0 { (lower, upper) } else { (upper, lower) };
            // One that is too flat to tell lies there as a whole.
            let is_level = side.slope.abs() < 1.0 / 1024.0;
            let place = |across: f32| (side.start + (across - side.at) / side.slope).clamp(side.start, side.end);
            let (start, end) = if is_level { (side.start, side.end) } else { (place(start), place(end)) };
            from = if start < from { start } else { from };
            to = if end > to { end } else { to };
        }
        ((from - 1.0) as i32, (to + 2.0) as i32)
    }
}

impl Side {
    /// That between two corners, in 1/256 pixel.
    #[inline(always)]
    fn new(from: (i32, i32), to: (i32, i32)) -> Self {
        let place = |v: i32| v as f32 * (1.0 / fixed::ONE as f32);
        let (start, end, sign) = if from.0 < to.0 { (from, to, 1.0) } else { (to, from, -1.0) };
        let (long, wide) = (place(end.0 - start.0), place(end.1 - start.1));
        Self {
            start: place(start.0),
            end: place(end.0),
            at: place(start.1),
            slope: if long > 0.0 { wide / long } else { 0.0 },
            curve: if wide == 0.0 { 0.0 } else { 0.5 * long / wide.abs() },
            sign,
        }
    }

    /// Where across it is so far along, or at that end that is nearer.
    #[inline(always)]
    fn across(&self, along: f32) -> f32 {
        self.at + (along.clamp(self.start, self.end) - self.start) * self.slope
    }

    /// What of it lies in the eight rows from a place along on.
    #[inline(always)]
    fn parts<S: Simd>(&self, simd: S, along: f32) -> Parts<S> {
        let along = f32x8::load_array(simd, LANES) + along;
        let (start, end) = (f32x8::splat(simd, self.start), f32x8::splat(simd, self.end));
        let upper = lesser_f32(greater_f32(along, start), end);
        let lower = lesser_f32(greater_f32(along + 1.0, start), end);
        let height = lower - upper;
        let middle = ((upper + lower) * 0.5 - start) * self.slope + self.at;
        let spread = height * self.slope.abs();
        Parts {
            low: middle - spread * 0.5,
            spread,
            height: height * self.sign,
            curve: f32x8::splat(simd, self.curve * self.sign),
        }
    }

    /// As [`parts`](Self::parts), to the bit, where it climbs through all of the rows; whichever way it bounds the bar.
    #[inline(always)]
    fn whole_parts<S: Simd>(&self, simd: S, along: f32) -> Parts<S> {
        let middles = f32x8::load_array(simd, LANES) + (along + 0.5);
        let middle = (middles - self.start) * self.slope + self.at;
        let spread = f32x8::splat(simd, self.slope.abs());
        let one = f32x8::splat(simd, 1.0);
        Parts { low: middle - spread * 0.5, spread, height: one, curve: f32x8::splat(simd, self.curve) }
    }
}

const LANES: [f32; 8] = [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0];

impl<S: Simd> Parts<S> {
    /// How much further than a place across the row is covered up to it, and beyond it: by so much of its height, and of its square.
    #[inline(always)]
    fn passed(&self, simd: S, at: f32x8<S>) -> (f32x8<S>, f32x8<S>) {
        let zero = f32x8::splat(simd, 0.0);
        let passed = at - self.low;
        let on_it = lesser_f32(greater_f32(passed, zero), self.spread);
        (on_it * on_it * self.curve, greater_f32(passed - self.spread, zero))
    }
}

/// Where sides start across, of those that lie in a row.
#[inline(always)]
fn least_low<S: Simd>(simd: S, parts: &[Parts<S>; 4]) -> f32x8<S> {
    let mut low = f32x8::splat(simd, LONGEST as f32);
    for part in parts {
        low = part.height.simd_eq(0.0).select(low, lesser_f32(part.low, low));
    }
    low
}

/// What of a bar lies up to a place across, in each of eight rows or columns.
#[inline(always)]
fn area_up_to<S: Simd>(simd: S, parts: &[Parts<S>; 4], at: f32x8<S>) -> f32x8<S> {
    let mut area = f32x8::splat(simd, 0.0);
    for part in parts {
        let (on_it, beyond) = part.passed(simd, at);
        area += on_it + beyond * part.height;
    }
    area
}

/// The same, to the bit, where the two long sides alone lie in the rows.
#[inline(always)]
fn area_between<S: Simd>(simd: S, [first, last]: [Parts<S>; 2], at: f32x8<S>) -> f32x8<S> {
    let ((on_first, beyond_first), (on_last, beyond_last)) = (first.passed(simd, at), last.passed(simd, at));
    (on_first + beyond_first) - (on_last + beyond_last)
}

/// Adds what of a bar lies within `clip` (device pixels, from the band's first column on) to the cells of the band whose top is at device row `top`.
/// `reaches` says of each strip which columns matter; all of those of strips that it does not have.
#[inline(always)]
pub(crate) fn add_bar<S: Simd>(
    simd: S,
    cells: &mut Accumulator,
    bar: &Bar,
    clip: IntRect,
    top: i32,
    reaches: &[Reach],
) {
    bar.cover(simd, clip, &mut CellSink { cells, clip, top, reaches });
}

/// Turns runs into differences of cells.
struct CellSink<'a> {
    cells: &'a mut Accumulator,
    clip: IntRect,
    top: i32,
    reaches: &'a [Reach],
}

impl<S: Simd> RunSink<S> for CellSink<'_> {
    fn run(&mut self, _: S, row: i32, column: i32, coverage: u16x16<S>) {
        let row = (row - self.top) as usize;
        let (mut low, mut high) = (self.clip.left.max(0), self.clip.right);
        if let Some(reach) = self.reaches.get(row / BLOCK_HEIGHT) {
            let (first, end) = reach.to_columns();
            (low, high) = (low.max(first), high.min(end));
        }
        let (low, high) = (low.max(column), high.min(column + RUN));
        let Some(mut strip) = self.cells.strip(row / BLOCK_HEIGHT) else { return };
        if low >= high {
            return;
        }
        strip.occupy(low as usize, high as usize);
        let coverage = coverage.to_array();
        let mut before = 0;
        for column_here in low..=high {
            // Rounded up, it is the same coverage when the sweep rounds it.
            let value = match coverage.get(2 * (column_here - column) as usize) {
                Some(coverage) if column_here < high => (i32::from(*coverage) * FULL + 254) / 255,
                _ => 0,
            };
            if let Some(column) = strip.columns.get_mut(column_here as usize) {
                let cell = &mut column.0[row % BLOCK_HEIGHT];
                *cell = cell.wrapping_add(value - before);
            }
            before = value;
        }
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::*;
    use crate::num::level::{SimdLevel, dispatch};
    use crate::raster::sweep::{BlockSink, CoverageRule, sweep};
    use crate::surface::block::{BLOCK_WIDTH, BlockCoverage};

    /// Coverage by row and column.
    type Pixels = BTreeMap<(i32, i32), u8>;

    /// Writes down what of runs lies in a clip.
    struct Notes(IntRect, Pixels);

    impl<S: Simd> RunSink<S> for Notes {
        fn run(&mut self, _: S, row: i32, column: i32, coverage: u16x16<S>) {
            for (column, pair) in (column..).zip(coverage.to_array().as_chunks::<2>().0) {
                assert!(pair[0] == pair[1] && pair[0] <= 255);
                if self.0.contains(IntRect::from_xywh(column, row, 1, 1)) && pair[0] > 0 {
                    assert_eq!(self.1.insert((row, column), pair[0] as u8), None, "{row}, {column} twice");
                }
            }
        }
    }

    fn covered(bar: &Bar, clip: IntRect, level: SimdLevel) -> Pixels {
        let mut notes = Notes(clip, Pixels::new());
        dispatch!(level, simd => bar.cover(simd, clip, &mut notes));
        notes.1
    }

    /// The part of a pixel that lies in a convex polygon, cut by the pixel's sides one after another.
    fn area(corners: &[FixedPoint; 4], column: i32, row: i32) -> f64 {
        let pixel = |v: i32| f64::from(v) / 256.0;
        let mut polygon: Vec<[f64; 2]> = corners.iter().map(|p| [pixel(p.x), pixel(p.y)]).collect();
        for (axis, at, sign) in [(0, column, 1.0), (0, column + 1, -1.0), (1, row, 1.0), (1, row + 1, -1.0)] {
            let inside = |p: &[f64; 2]| (p[axis] - f64::from(at)) * sign;
            let mut cut = Vec::new();
            for (i, p) in polygon.iter().enumerate() {
                let q = &polygon[(i + 1) % polygon.len()];
                let (a, b) = (inside(p), inside(q));
                if a >= 0.0 {
                    cut.push(*p);
                }
                if a * b < 0.0 {
                    let t = a / (a - b);
                    cut.push([p[0] + (q[0] - p[0]) * t, p[1] + (q[1] - p[1]) * t]);
                }
            }
            polygon = cut;
        }
        let cross = |(i, p): (usize, &[f64; 2])| {
            let q = &polygon[(i + 1) % polygon.len()];
            p[0] * q[1] - p[1] * q[0]
        };
        polygon.iter().enumerate().map(cross).sum::<f64>().abs() / 2.0
    }

    /// The stroke of a line.
    fn stroke(x: f32, y: f32, length: f32, degrees: f32, width: f32) -> [Point; 4] {
        let (sin, cos) = crate::num::trig::sin_cos(f64::from(degrees).to_radians());
        let (along, across) =
            (Point::new(cos as f32, sin as f32) * length, Point::new(-sin as f32, cos as f32) * width);
        let at = Point::new(x, y);
        [at, at + along, at + along + across, at + across]
    }

    /// Bars at all angles, thin and less so, long and short, whichever way around and from whichever corner; some that lean.
    fn bars() -> Vec<Bar> {
        let mut bars = Vec::new();
        for step in 0..180 {
            let degrees = step as f32 * 2.0 + 0.37 * (step % 3) as f32;
            let width = [0.1, 0.75, 1.5, 2.6, 4.0][step % 5];
            let length = [0.3, 5.0, 40.0, 73.3, 120.0, 3.0, 16.2][step % 7];
            let x = if step % 6 == 0 { -3.2 } else { 70.3 };
            let mut corners = stroke(x + step as f32 / 7.0, 80.9 - step as f32 / 11.0, length, degrees, width);
            if step % 4 == 1 {
                corners.reverse();
            }
            if step % 5 == 2 {
                let lean = Point::new(0.8, -0.3);
                corners = [corners[0], corners[1], corners[2] + lean, corners[3] + lean];
            }
            corners.rotate_left(step % 4);
            bars.extend(Bar::new(&corners));
        }
        assert!(bars.len() > 150, "{}", bars.len());
        let steep = bars.iter().filter(|bar| bar.is_steep).count();
        assert!(steep >= 20 && bars.len() - steep >= 20, "{steep} of {}", bars.len());
        bars
    }

    #[test]
    fn coverage_is_area() {
        let everywhere = IntRect::from_ltrb(-1000, -1000, 1000, 1000);
        for bar in bars() {
            let found = covered(&bar, everywhere, SimdLevel::best());
            let IntRect { left, top, right, bottom } = bar.bounds;
            assert!(found.keys().all(|(row, column)| bar.bounds.contains(IntRect::from_xywh(*column, *row, 1, 1))));
            for (row, column) in (top..bottom).flat_map(|row| (left..right).map(move |column| (row, column))) {
                let expected = area(&bar.corners, column, row) * 255.0;
                let found = f64::from(found.get(&(row, column)).copied().unwrap_or(0));
                assert!((found - expected).abs() < 0.51, "{found}, not {expected}, at {column}, {row} of {bar:?}");
            }
        }
    }

    #[test]
    fn pixels_are_the_same_at_every_level_and_in_any_part() {
        let everywhere = IntRect::from_ltrb(-1000, -1000, 1000, 1000);
        for (index, bar) in bars().into_iter().enumerate() {
            let expected = covered(&bar, everywhere, SimdLevel::best());
            for level in SimdLevel::available() {
                assert_eq!(covered(&bar, everywhere, level), expected, "{bar:?} at {level:?}");
            }
            let IntRect { left, top, right, bottom } = bar.bounds;
            let (row, column) =
                (top + (bottom - top) * (index as i32 % 7) / 7, left + (right - left) * (index as i32 % 5) / 5);
            let mut parts = Pixels::new();
            for part in [
                IntRect::from_ltrb(left - 9, top - 9, column, row),
                IntRect::from_ltrb(column, top - 9, right + 9, row),
                IntRect::from_ltrb(left - 9, row, column, bottom + 9),
                IntRect::from_ltrb(column, row, right + 9, bottom + 9),
            ] {
                parts.extend(covered(&bar, part, SimdLevel::best()));
            }
            assert_eq!(parts, expected, "{bar:?} cut at {column}, {row}");
        }
    }

    /// Writes down what a strip's sweep reports.
    struct Swept(i32, Pixels);

    impl<S: Simd> BlockSink<S> for Swept {
        fn block(&mut self, _: S, index: usize, coverage: BlockCoverage<'_>) {
            for (row, values) in (self.0..).zip(coverage.mask) {
                for (column, value) in ((index * BLOCK_WIDTH) as i32..).zip(values) {
                    if *value > 0 {
                        self.1.insert((row, column), *value);
                    }
                }
            }
        }
        fn run(&mut self, _: S, start: usize, end: usize, rows: &[u8; BLOCK_HEIGHT]) {
            panic!("{rows:?} from {start} to {end}");
        }
    }

    #[test]
    fn cells_give_the_same_coverage() {
        let (clip, top) = (IntRect::from_ltrb(3, 41, 200, 96), 40);
        let mut cells = Accumulator::default();
        cells.resize(208, 7);
        for (index, bar) in bars().into_iter().enumerate() {
            let mut swept = Swept(0, Pixels::new());
            // Every other time some columns do not matter.
            let reaches = [Reach::columns(64, 112); 7];
            let reaches = if index % 2 == 0 { &reaches[..0] } else { &reaches };
            dispatch!(SimdLevel::best(), simd => {
                add_bar(simd, &mut cells, &bar, clip, top, reaches);
                for strip in 0..7 {
                    swept.0 = top + 8 * strip as i32;
                    sweep(simd, &mut cells.strip(strip).unwrap(), 13, CoverageRule::NonZero, &mut swept);
                }
            });
            let seen = if index % 2 == 0 { clip } else { IntRect::from_ltrb(64, 41, 112, 96) };
            assert_eq!(swept.1, covered(&bar, seen, SimdLevel::best()), "{bar:?}");
            assert!((0..7).all(|strip| !cells.is_occupied(strip)));
        }
    }

    #[test]
    fn what_is_wide_or_crooked_or_far_is_no_bar() {
        assert!(Bar::new(&stroke(5.0, 5.0, 30.0, 20.0, 3.0)).is_some());
        assert!(Bar::new(&stroke(5.0, 5.0, 30.0, 20.0, 9.0)).is_none());
        assert!(Bar::new(&stroke(5.0, 5.0, 30.0, 20.0, 0.0)).is_none());
        assert!(Bar::new(&stroke(5.0, 5.0, 3000.0, 20.0, 3.0)).is_none());
        assert!(Bar::new(&stroke(1e6, 5.0, 30.0, 20.0, 3.0)).is_none());
        assert!(Bar::new(&stroke(f32::NAN, 5.0, 30.0, 20.0, 3.0)).is_none());
        let mut crooked = stroke(5.0, 5.0, 30.0, 20.0, 3.0);
        crooked[2].x += 1.0;
        assert!(Bar::new(&crooked).is_none());
        assert!(Bar::new(&crooked[..3]).is_none());
    }
}
