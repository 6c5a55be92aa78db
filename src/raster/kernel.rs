//! The kernel: edges into cells, eight rows at a time.
//!
//! A piece of an edge in one row, between x_left and x_right (in 1/256 pixel), climbs `d` (0 ..= 256) with winding s. Left
//! of it nothing is covered, right of it 2·256·d·s, and in between, at a pixel's right side b, the covered area up
//! to there is
//!
//! > s·steep·t²,  t = clamp(b, x_left, x_right) − x_left,  steep = |dy / dx|
//!
//! So a pixel's own area is the difference of two such terms, plus 2·d·s for each 1/256 of it that lies right of x_right:
//! no case to distinguish, and no branch. Cells hold the difference of each pixel's area to its left neighbour's; that
//! of the last is what the sum still lacks, so that what winds around the pixels right of a piece is exact, whatever
//! was rounded. Pieces of three columns and more have a shorter formula ([`add_columns`]), by which pixels that a part has passed
//! in a row while the piece goes on in others are right to some 2^-17 of their area.
//!
//! Edges of at most eight rows are reckoned in one go even where they reach into a second strip: lanes are rows modulo eight. Taller ones are cut at the
//! strips' tops.
//!
//! Slope and steepness are the whole edge's; where it enters and leaves a strip is rounded to 1/4096 pixel.

use fearless_simd::prelude::*;
use fearless_simd::{f32x8, i32x8, mask32x8};

use super::batch::add_edges;
use super::bins::Edges;
use super::cell::{Accumulator, Column, FULL, Strip};
#[cfg(test)]
use super::edge::Edge;
use super::edge::{EdgeLine, FineLine};
use crate::num::fixed;
use crate::num::lanes::{RAISED, greater_f32, lesser_f32, max_i32, min_i32, round_f64, round_raised_f32};
use crate::style::FillRule;
use crate::surface::block::BLOCK_HEIGHT;

/// An edge that runs over more columns than this in a row is walked row by row: eight lanes would
/// mostly idle.
const FLAT_COLUMNS_PER_ROW: i32 = 10;

/// Fraction bits of x where an edge enters and leaves a strip.
pub(super) const FINE_SHIFT: u32 = FineLine::SHIFT;

/// A strip's height in fixed point.
pub(super) const STRIP_SHIFT: u32 = fixed::SHIFT + BLOCK_HEIGHT.ilog2();

/// A difference of x in 20.12 fixed point, in 1/256 pixel.
#[inline(always)]
pub(super) fn fine(x: i32) -> f32 {
    x as f32 * (1.0 / 16.0)
}

/// The columns of a strip whose coverage matters: edges left of them only wind around them, edges right of them do
/// nothing.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Reach {
    /// x in 20.12 fixed point.
    low: i32,
    high: i32,
}

impl Reach {
    /// Whether nothing from a position (24.8 fixed point) on matters.
    #[inline(always)]
    pub(super) fn ends_before(self, least: i32) -> bool {
        least << (FINE_SHIFT - fixed::SHIFT) >= self.high
    }

    /// Whether all that lies between two positions (24.8 fixed point) matters.
    #[inline(always)]
    pub(super) fn holds(self, least: i32, greatest: i32) -> bool {
        least << (FINE_SHIFT - fixed::SHIFT) >= self.low && greatest << (FINE_SHIFT - fixed::SHIFT) < self.high
    }

    /// Whether all columns `first ..= last` matter.
    #[inline(always)]
    pub(super) fn holds_columns(self, first: usize, last: usize) -> bool {
        (first as i32) << FINE_SHIFT >= self.low && (last as i32) << FINE_SHIFT < self.high
    }

    /// Whether nothing up to a position (24.8 fixed point) matters but that it winds around what does.
    #[inline(always)]
    fn starts_after(self, greatest: i32) -> bool {
        greatest << (FINE_SHIFT - fixed::SHIFT) < self.low
    }

    /// The first and the end of the columns that matter.
    #[inline(always)]
    pub(super) fn to_columns(self) -> (i32, i32) {
        (self.low >> FINE_SHIFT, self.high >> FINE_SHIFT)
    }

    pub(crate) const NOTHING: Self = Self { low: i32::MIN, high: i32::MIN };

    /// The columns `first..end`.
    pub(crate) fn columns(first: usize, end: usize) -> Self {
        Self { low: (first as i32) << FINE_SHIFT, high: (end as i32) << FINE_SHIFT }
    }
}

/// Adds the part of `edge` inside the band whose top is at `top` (fixed point, a whole strip) and which has
/// `strips` strips.
///
/// Where an edge leaves a strip is a function of the edge and of that scanline, so that it does not
/// matter in which band the strip is. `reaches` says of each strip which columns matter; all of those of strips that it
/// does not have.
#[cfg(test)]
#[inline(always)]
pub(super) fn add_edge<S: Simd>(
    simd: S,
    cells: &mut Accumulator,
    edge: Edge,
    top: i32,
    strips: usize,
    reaches: &[Reach],
) {
    add_downward(simd, cells, edge.downward(), top, strips, reaches);
}

/// As [`add_edge`], for an edge as [`Edge::downward`] gives it.
#[inline(always)]
pub(super) fn add_downward<S: Simd>(
    simd: S,
    cells: &mut Accumulator,
    edge: (i32, i32, i32, i32, i32),
    top: i32,
    strips: usize,
    reaches: &[Reach],
) {
    let slant = Slant::new(edge);
    let (x0, y0, x1, y1, _) = edge;
    let (least, greatest) = (x0.min(x1), x0.max(x1));
    if is_across((x0 >> fixed::SHIFT, x1 >> fixed::SHIFT), (y0 - top, y1 - top)) {
        let start = (x0 - (least >> fixed::SHIFT << fixed::SHIFT)) as f32;
        let line = PieceLine { below: (y0 - top) & ((1 << STRIP_SHIFT) - 1), height: y1 - y0, start, slant };
        add_across(simd, cells, (y0 - top) >> STRIP_SHIFT, strips, line, (least, greatest), reaches);
        return;
    }
    for_strip_parts(
        edge,
        top,
        strips,
        #[inline(always)]
        |index, start, end| add_strip_part(simd, cells, index, start, end, slant, top, reaches),
    );
}

/// Whether an edge between two columns and two y, from a strip's top, reaches into a second strip and is reckoned in one go all the same.
#[inline(always)]
fn is_across((from, to): (i32, i32), (start_y, end_y): (i32, i32)) -> bool {
    let rows = ((end_y - 1) >> fixed::SHIFT) - (start_y >> fixed::SHIFT);
    let columns = from.abs_diff(to) as usize;
    start_y >> STRIP_SHIFT != (end_y - 1) >> STRIP_SHIFT
        && rows < BLOCK_HEIGHT as i32
        && !is_flat(0, columns, end_y - start_y)
}

/// Adds an edge of at most eight rows, between two x (24.8 fixed point), which starts in `strip` (counted from the band's top) and ends in
/// the next.
#[inline(always)]
pub(super) fn add_across<S: Simd>(
    simd: S,
    cells: &mut Accumulator,
    strip: i32,
    strips: usize,
    line: PieceLine,
    (least, greatest): (i32, i32),
    reaches: &[Reach],
) {
    let (first, last) = ((least >> fixed::SHIFT) as usize, (greatest >> fixed::SHIFT) as usize);
    let whole_rows = line.below & !(fixed::ONE - 1);
    // Rows above the one in which it starts are those of the next strip.
    let offsets = (RowParts::tops(simd) - whole_rows) & ((1 << STRIP_SHIFT) - 1);
    let parts = RowParts::in_rows(simd, line, offsets - (line.below - whole_rows));
    let upper = RowParts::tops(simd).simd_ge(whole_rows);
    let is_seen = |strip: i32| reaches.get(strip as usize).is_none_or(|reach| reach.holds(least, greatest));
    if strip >= 0 && (strip + 1) < strips as i32 && is_seen(strip) && is_seen(strip + 1) {
        if let Some(mut pair) = cells.pair(strip as usize) {
            let [above, below] = &mut pair;
            add_parts_across(simd, [above, below], upper, parts, first, last);
        }
        return;
    }
    for (index, rows) in [(strip, upper), (strip + 1, !upper)] {
        // Above the band the strip is negative, which no index is.
        let index = index as usize;
        let Some(mut strip) = cells.strip(index).filter(|_| index < strips) else { continue };
        let parts = parts.only(simd, rows);
        match reaches.get(index) {
            Some(reach) if reach.ends_before(least) => {}
            Some(reach) if reach.starts_after(greatest) => {
                let column = (reach.low >> FINE_SHIFT) as usize;
                strip.occupy_pair(column, column);
                if let Some(column) = strip.columns.get_mut(column) {
                    add_to(simd, column, parts.total);
                }
            }
            _ => add_row_parts(simd, &mut strip, parts, first, last),
        }
    }
}

/// Adds parts that lie in columns `first ..= last` to two strips, those of the rows of `upper` to the former.
#[inline(always)]
fn add_parts_across<S: Simd>(
    simd: S,
    [above, below]: [&mut Strip<'_>; 2],
    upper: mask32x8<S>,
    row: RowParts<S>,
    first: usize,
    last: usize,
) {
    let zero = i32x8::splat(simd, 0);
    if last - first <= 1 {
        above.occupy_pair(first, last + 1);
        below.occupy_pair(first, last + 1);
        if let (Some(above), Some(below)) = (above.three(first), below.three(first)) {
            let RowParts { left, right, steep, beyond, total } = row;
            let values = two_columns(simd, left, right, steep, beyond, total);
            for ((value, above), below) in values.into_iter().zip(above).zip(below) {
                add_to(simd, above, upper.select(value, zero));
                add_to(simd, below, upper.select(zero, value));
            }
        }
        return;
    }
    above.occupy(first, last + 1);
    below.occupy(first, last + 1);
    if let (Some(above), Some(below)) = (above.columns.get_mut(first..last + 2), below.columns.get_mut(first..last + 2))
    {
        let mut walk = ColumnWalk::new(simd, &row);
        let last = above.len() - 1;
        for (index, (above, below)) in above.iter_mut().zip(below).enumerate() {
            let value = if index < last { walk.next(simd) } else { walk.rest() };
            add_to(simd, above, upper.select(value, zero));
            add_to(simd, below, upper.select(zero, value));
        }
    }
}

/// Calls `part` with each of the strips below `top` that an edge (as [`Edge::downward`] gives it) crosses, and with where it starts and ends there: x in
/// 20.12, y in 24.8 fixed point, downwards.
#[inline(always)]
pub(super) fn for_strip_parts(
    (x0, y0, x1, y1, _): (i32, i32, i32, i32, i32),
    top: i32,
    strips: usize,
    mut part: impl FnMut(usize, (i32, i32), (i32, i32)),
) {
    let first = (y0 - top) >> STRIP_SHIFT;
    let last = (y1 - 1 - top) >> STRIP_SHIFT;
    let (start, end) = ((x0 << 4, y0), (x1 << 4, y1));
    if first == last {
        if (0..strips as i32).contains(&first) {
            part(first as usize, start, end);
        }
        return;
    }
    let line = FineLine::new(x0, x1, y1 - y0);
    let mut from = if first < 0 { (line.x_at(top - y0), top) } else { start };
    for index in first.max(0)..=last.min(strips as i32 - 1) {
        let bottom = top + ((index + 1) << STRIP_SHIFT);
        let to = if index == last { end } else { (line.x_at(bottom - y0), bottom) };
        part(index as usize, from, to);
        from = to;
    }
}

/// Adds the part of an edge that lies in strip `index`, unless it lies where nothing matters.
#[inline(always)]
#[expect(clippy::too_many_arguments, reason = "in the innermost loop; a struct would only rename them")]
pub(super) fn add_strip_part<S: Simd>(
    simd: S,
    cells: &mut Accumulator,
    index: usize,
    mut start: (i32, i32),
    mut end: (i32, i32),
    mut slant: Slant,
    top: i32,
    reaches: &[Reach],
) {
    if let Some(Reach { low, high }) = reaches.get(index) {
        if start.0 >= *high && end.0 >= *high {
            return;
        }
        if start.0 < *low && end.0 < *low {
            (start.0, end.0) = (*low, *low);
            slant = slant.upright();
        }
    }
    if let Some(mut strip) = cells.strip(index) {
        add_piece(simd, &mut strip, start, end, slant, top + ((index as i32) << STRIP_SHIFT));
    }
}

/// Adds the part of an edge that lies in one strip, from (start_x, start_y) down to (end_x, end_y); `top` is
/// the strip's top. x in 20.12, y in 24.8 fixed point.
#[inline(always)]
fn add_piece<S: Simd>(
    simd: S,
    cells: &mut Strip<'_>,
    (start_x, start_y): (i32, i32),
    (end_x, end_y): (i32, i32),
    slant: Slant,
    top: i32,
) {
    let (first, last) = RowParts::<S>::columns((start_x, start_y), (end_x, end_y));
    if is_flat(first, last, end_y - start_y) {
        let round = |x: i32| (x + (1 << (FINE_SHIFT - fixed::SHIFT - 1))) >> (FINE_SHIFT - fixed::SHIFT);
        add_flat(cells, round(start_x), start_y, round(end_x), end_y, top, slant.winding);
        return;
    }

    let row = RowParts::new(simd, (start_x, start_y), (end_x, end_y), slant, top, first);
    add_row_parts(simd, cells, row, first, last);
}

/// Adds parts that lie in columns `first ..= last`.
#[inline(always)]
pub(super) fn add_row_parts<S: Simd>(simd: S, cells: &mut Strip<'_>, row: RowParts<S>, first: usize, last: usize) {
    if last - first <= 1 {
        cells.occupy_pair(first, last + 1);
        if let Some(columns) = cells.three(first) {
            add_two_columns(simd, columns, row);
        }
    } else {
        cells.occupy(first, last + 1);
        if let Some(columns) = cells.columns.get_mut(first..last + 2) {
            add_columns(simd, columns, row);
        }
    }
}

/// The direction of an edge, which is that of its pieces in all strips.
#[derive(Clone, Copy)]
pub(super) struct Slant {
    /// The change of x per unit of y.
    pub(super) slope: f32,
    /// |dy / dx| times the winding; 0 where it is upright.
    pub(super) steep: f32,
    /// ±1.
    pub(super) winding: i32,
}

impl Slant {
    /// That of an edge as [`Edge::downward`] gives it.
    #[inline(always)]
    pub(super) fn new((x0, y0, x1, y1, winding): (i32, i32, i32, i32, i32)) -> Self {
        let (run, rise) = ((x1 - x0) as f32, (y1 - y0) as f32);
        Self {
            slope: run / rise,
            // Upright pieces have t = 0.
            steep: if run == 0.0 { 0.0 } else { rise * winding as f32 / run.abs() },
            winding,
        }
    }

    fn upright(self) -> Self {
        Self { slope: 0.0, steep: 0.0, ..self }
    }
}

/// A piece of an edge in one strip, as numbers that are the same in all of its rows.
#[derive(Clone, Copy)]
pub(super) struct PieceLine {
    /// How far below the strip's top it starts, and how far down it goes, in 1/256 pixel.
    pub(super) below: i32,
    pub(super) height: i32,
    /// x where it starts, in 1/256 pixel from the first column's left side.
    pub(super) start: f32,
    pub(super) slant: Slant,
}

/// Whether a piece between two columns that goes down by `height` should be walked row by row.
#[inline(always)]
pub(super) fn is_flat(first: usize, last: usize, height: i32) -> bool {
    last > first + 4 && (last - first) as i64 * 256 > i64::from(FLAT_COLUMNS_PER_ROW) * i64::from(height)
}

/// Which of several pieces are, as bits.
#[inline(always)]
pub(super) fn are_flat<S: Simd, I: SimdInt<S, Element = i32>>(first: I, last: I, height: I) -> u32 {
    let columns = last - first;
    let many = (columns << fixed::SHIFT).simd_gt(height * FLAT_COLUMNS_PER_ROW);
    (columns.simd_gt(4) & many).to_bitmask() as u32
}

/// The parts of an edge in the eight rows of a strip; x in 1/256 pixel from the first column's left side.
#[derive(Clone, Copy)]
pub(super) struct RowParts<S: Simd> {
    pub(super) left: f32x8<S>,
    pub(super) right: f32x8<S>,
    /// |dy / dx| times the winding.
    steep: f32x8<S>,
    /// What each 1/256 pixel right of a part adds.
    beyond: f32x8<S>,
    /// What each pixel right of a part adds.
    total: i32x8<S>,
}

impl<S: Simd> RowParts<S> {
    /// The first and last column between two points in 20.12 fixed point.
    #[inline(always)]
    pub(super) fn columns((start_x, _): (i32, i32), (end_x, _): (i32, i32)) -> (usize, usize) {
        let (low, high) = if start_x < end_x { (start_x, end_x) } else { (end_x, start_x) };
        ((low >> FINE_SHIFT) as usize, (high >> FINE_SHIFT) as usize)
    }

    /// The parts of the edge from (start_x, start_y) down to (end_x, end_y) in the strip at `top`, whose first column is
    /// `first`. All is float until a pixel's area is rounded: x is then good to far less than 1/256 pixel.
    #[inline(always)]
    pub(super) fn new(
        simd: S,
        (start_x, start_y): (i32, i32),
        (_, end_y): (i32, i32),
        slant: Slant,
        top: i32,
        first: usize,
    ) -> Self {
        let start = fine(start_x - ((first as i32) << FINE_SHIFT));
        Self::of(simd, PieceLine { below: start_y - top, height: end_y - start_y, start, slant })
    }

    /// The parts of a piece.
    #[inline(always)]
    pub(super) fn of(simd: S, line: PieceLine) -> Self {
        let rows = Self::tops(simd) - line.below;
        Self::in_rows(simd, line, rows)
    }

    /// How far below a strip's top its rows start.
    #[inline(always)]
    pub(super) fn tops(simd: S) -> i32x8<S> {
        i32x8::simd_from(simd, [0, 256, 512, 768, 1024, 1280, 1536, 1792])
    }

    /// Of the parts those in some rows.
    #[inline(always)]
    fn only(self, simd: S, rows: mask32x8<S>) -> Self {
        let (zero, nothing) = (f32x8::splat(simd, 0.0), i32x8::splat(simd, 0));
        Self {
            steep: rows.select(self.steep, zero),
            beyond: rows.select(self.beyond, zero),
            total: rows.select(self.total, nothing),
            ..self
        }
    }

    /// The parts of a piece in rows that start so far below it.
    #[inline(always)]
    fn in_rows(simd: S, PieceLine { height, start, slant, .. }: PieceLine, rows: i32x8<S>) -> Self {
        let Slant { slope, steep, winding } = slant;
        let zero = i32x8::splat(simd, 0);
        let limit = i32x8::splat(simd, height);
        let upper = min_i32(max_i32(rows, zero), limit);
        let lower = min_i32(max_i32(rows + 256, zero), limit);
        let dy = lower - upper;
        let start8 = f32x8::splat(simd, start);
        let upper_x = upper.to_float::<f32x8<S>>() * slope + start8;
        let lower_x = lower.to_float::<f32x8<S>>() * slope + start8;
        Self {
            left: lesser_f32(upper_x, lower_x),
            right: greater_f32(upper_x, lower_x),
            steep: f32x8::splat(simd, steep),
            beyond: dy.to_float::<f32x8<S>>() * (2.0 * winding as f32),
            total: dy * (512 * winding),
        }
    }
}

#[inline(always)]
pub(super) fn add_to<S: Simd>(simd: S, column: &mut Column, value: i32x8<S>) {
    (i32x8::load_array_ref(simd, &column.0) + value).store_array(&mut column.0);
}

/// Adds parts that lie in the first two columns.
#[inline(always)]
fn add_two_columns<S: Simd>(simd: S, [here, next, after]: &mut [Column; 3], row: RowParts<S>) {
    let RowParts { left, right, steep, beyond, total, .. } = row;
    let values = two_columns(simd, left, right, steep, beyond, total);
    add_to(simd, here, values[0]);
    add_to(simd, next, values[1]);
    add_to(simd, after, values[2]);
}

/// What parts that lie in the first two columns add to these and to the one after.
#[inline(always)]
pub(super) fn two_columns<S, F, I>(simd: S, left: F, right: F, steep: F, beyond: F, total: I) -> [I; 3]
where
    S: Simd,
    F: SimdFloat<S, Element = f32>,
    I: SimdInt<S, Element = i32, ByteVector = F::ByteVector>,
{
    let zero = F::splat(simd, 0.0);
    let side = F::splat(simd, 256.0);
    let t = greater_f32(lesser_f32(right, side) - left, zero);
    let width = right - left;
    let within = steep * t * t;
    let area: I = round_raised_f32(within + beyond * greater_f32(side - right, zero));
    let rest = steep * width * width - within;
    let next_area: I = round_raised_f32(rest + beyond * lesser_f32(F::splat(simd, 512.0) - right, side));
    [area - RAISED, next_area - area, total + RAISED - next_area]
}

/// Adds parts that lie in all columns but the last, which are three at least: none of them is upright.
///
/// With u = max(b − x_left, 0) and w = max(b − x_right, 0), all that is covered up to a side b is s·steep·(u² − w²): the
/// formula above, and what lies right of x_right, in one.
#[inline(always)]
fn add_columns<S: Simd>(simd: S, columns: &mut [Column], row: RowParts<S>) {
    let Some((spill, columns)) = columns.split_last_mut() else { return };
    let mut walk = ColumnWalk::new(simd, &row);
    for column in columns {
        add_to(simd, column, walk.next(simd));
    }
    add_to(simd, spill, walk.rest());
}

/// What parts add to one column after another.
struct ColumnWalk<S: Simd> {
    from_left: f32x8<S>,
    from_right: f32x8<S>,
    steep: f32x8<S>,
    total: i32x8<S>,
    before: f32x8<S>,
    area: i32x8<S>,
}

impl<S: Simd> ColumnWalk<S> {
    #[inline(always)]
    fn new(simd: S, row: &RowParts<S>) -> Self {
        let whole = f32x8::splat(simd, 256.0);
        let (before, area) = (f32x8::splat(simd, 0.0), i32x8::splat(simd, RAISED));
        let (from_left, from_right) = (whole - row.left, whole - row.right);
        Self { from_left, from_right, steep: row.steep, total: row.total, before, area }
    }

    #[inline(always)]
    fn next(&mut self, simd: S) -> i32x8<S> {
        let (zero, whole) = (f32x8::splat(simd, 0.0), f32x8::splat(simd, 256.0));
        let (u, w) = (greater_f32(self.from_left, zero), greater_f32(self.from_right, zero));
        let up_to_here = self.steep * (u - w) * (u + w);
        let here = round_raised_f32(up_to_here - self.before);
        let value = here - self.area;
        (self.before, self.area) = (up_to_here, here);
        self.from_left += whole;
        self.from_right += whole;
        value
    }

    /// What is left for the column after the last.
    #[inline(always)]
    fn rest(&self) -> i32x8<S> {
        self.total + RAISED - self.area
    }
}

impl Strip<'_> {
    /// Adds a piece of an edge that lies within one row: from x0 to x1 (either order), climbing `dy` (0 ..= 256,
    /// times the winding). The way very flat edges go; the kernel's formula, in plain `f64`.
    pub(crate) fn add_row_piece(&mut self, row: usize, x0: i32, x1: i32, dy: i32) {
        if dy == 0 || row >= BLOCK_HEIGHT {
            return;
        }
        let (left, right) = if x0 < x1 { (x0, x1) } else { (x1, x0) };
        let first = left >> fixed::SHIFT;
        // An end on a pixel's left side belongs to the pixel before.
        let last = first.max((right - 1) >> fixed::SHIFT);
        self.occupy(first as usize, last as usize + 1);
        let Some(columns) = self.columns.get_mut(first as usize..last as usize + 2) else { return };
        let height = f64::from(dy);
        let (width, steep) = (f64::from(right - left), height / f64::from((right - left).max(1)));
        let mut side = f64::from(((first + 1) << fixed::SHIFT) - left);
        let (mut within, mut area) = (0.0, 0);
        let Some((spill, columns)) = columns.split_last_mut() else { return };
        let Some((end, columns)) = columns.split_last_mut() else { return };
        let add = |column: &mut Column, value: i32| {
            if let Some(cell) = column.0.get_mut(row) {
                *cell = cell.wrapping_add(value);
            }
        };
        for column in columns {
            let up_to_here = steep * side * side;
            let here = round_f64(up_to_here - within);
            add(column, here - area);
            (within, area) = (up_to_here, here);
            side += 256.0;
        }
        let here = round_f64(height * width - within + 2.0 * height * (side - width));
        add(end, here - area);
        add(spill, 512 * dy - here);
    }
}

/// Adds a flat piece row by row.
#[inline(never)]
fn add_flat(cells: &mut Strip<'_>, start_x: i32, start_y: i32, end_x: i32, end_y: i32, top: i32, winding: i32) {
    let line = EdgeLine::new(start_x, start_y, end_x, end_y);
    let (mut x, mut y) = (start_x, start_y);
    while y < end_y {
        let row = (y - top) >> fixed::SHIFT;
        let next_y = end_y.min(top + ((row + 1) << fixed::SHIFT));
        let next_x = if next_y == end_y { end_x } else { line.x_at(next_y) };
        cells.add_row_piece(row as usize, x, next_x, (next_y - y) * winding);
        (x, y) = (next_x, next_y);
    }
}

/// From so many edges on, the sums of their areas could leave the 32 bits of a cell.
pub(crate) const CROWD: usize = (i32::MAX / FULL) as usize;

/// Adds any number of edges, to be read by the nonzero rule: by the crowd, whose sums are set aside where there are several.
///
/// Rare, and so not worth another copy of the kernel where shapes are accumulated.
#[inline(never)]
pub(crate) fn add_crowds<S: Simd>(
    simd: S,
    cells: &mut Accumulator,
    edges: &mut dyn Iterator<Item = Edges<'_>>,
    top: i32,
    strips: usize,
    reaches: &[Reach],
) {
    simd.vectorize(
        #[inline(always)]
        || {
            let (mut crowd, mut is_aside) = (0, false);
            for edges in edges.flat_map(|edges| edges.chunks(CROWD - 1)) {
                if crowd + edges.len() >= CROWD {
                    cells.set_aside();
                    (crowd, is_aside) = (0, true);
                }
                crowd += edges.len();
                add_edges(simd, cells, edges, top, strips, reaches);
            }
            if is_aside {
                cells.set_aside();
                cells.bring_back(FillRule::NonZero);
                cells.forget();
            }
        },
    );
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::level::{SimdLevel, dispatch};

    /// Covered area of each pixel times FULL for a set of edges, by integrating each edge on its own in f64.
    fn oracle(edges: &[Edge], width: usize) -> Vec<[f64; 8]> {
        let mut out = vec![[0.0; 8]; width];
        for edge in edges {
            let (x0, y0, x1, y1, s) = edge.downward();
            let f = |v: i32| f64::from(v) / 256.0;
            for row in 0..8 {
                let (top, bottom) = (f(y0).max(f64::from(row)), f(y1).min(f64::from(row) + 1.0));
                let steps = 2000;
                for i in 0..steps {
                    if bottom <= top {
                        break;
                    }
                    let y = top + (bottom - top) * (f64::from(i) + 0.5) / f64::from(steps);
                    let x = f(x0) + (f(x1) - f(x0)) * (y - f(y0)) / (f(y1) - f(y0));
                    for (column, rows) in out.iter_mut().enumerate() {
                        let covered = (column as f64 + 1.0 - x).clamp(0.0, 1.0);
                        rows[row as usize] += f64::from(s) * covered * (bottom - top) / f64::from(steps);
                    }
                }
            }
        }
        out
    }

    fn accumulate(level: SimdLevel, edges: &[Edge], width: usize) -> Vec<[i32; 8]> {
        let mut cells = Accumulator::default();
        cells.resize(width, 1);
        for edge in edges {
            dispatch!(level, simd => add_edge(simd, &mut cells, *edge, 0, 1, &[]));
        }
        let strip = cells.strip(0).unwrap();
        let mut sum = [0_i32; 8];
        let out = strip.columns[..width]
            .iter()
            .map(|column| {
                for (s, c) in sum.iter_mut().zip(&column.0) {
                    *s += c;
                }
                sum
            })
            .collect();
        for (column, values) in strip.columns.iter().enumerate() {
            let bit = strip.occupied[column / 16 / 64] >> (column / 16 % 64) & 1;
            assert!(bit == 1 || values.0 == [0; 8], "column {column} holds values but is not marked");
        }
        out
    }

    #[test]
    fn areas_equal_the_integral_at_every_slope_and_level() {
        let mut seed = 1_u32;
        let mut random = |n: i32| {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (seed >> 8) as i32 % n
        };
        let width = 40;
        for case in 0..300 {
            let flat = if case % 3 == 0 { 300 } else { 6000 };
            let y0 = random(6000) - 2000;
            let edge = Edge { x0: random(40 * 256), y0, x1: random(40 * 256), y1: y0 + 1 + random(flat) };
            let edge = if case % 2 == 0 { edge } else { Edge { x0: edge.x1, y0: edge.y1, x1: edge.x0, y1: edge.y0 } };
            let expected = oracle(&[edge], width);
            let scalar = accumulate(SimdLevel::Scalar, &[edge], width);
            for level in SimdLevel::available() {
                assert_eq!(accumulate(level, &[edge], width), scalar, "{edge:?} at {level:?}");
            }
            for (column, (got, want)) in scalar.iter().zip(&expected).enumerate() {
                for row in 0..8 {
                    let got = f64::from(got[row]) / f64::from(FULL);
                    assert!((got - want[row]).abs() < 0.004, "{edge:?}: pixel ({column}, {row}) {got} {}", want[row]);
                }
            }
        }
    }

    #[test]
    fn an_edge_adds_the_same_whichever_strips_it_lies_in() {
        let mut seed = 5_u32;
        let mut random = |n: i32| {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (seed >> 8) as i32 % n
        };
        for _ in 0..400 {
            // Within a strip of eight rows; then so many rows further down, up to all of it in the next one.
            let [y0, y1] = [random(2049), random(2049)];
            let edge = Edge { x0: random(40 * 256), y0, x1: random(40 * 256), y1 };
            // Very flat ones are walked from where they enter a strip.
            if y0 == y1 || is_flat(0, (edge.x0 >> 8).abs_diff(edge.x1 >> 8) as usize, (y1 - y0).abs()) {
                continue;
            }
            let expected = accumulate(SimdLevel::Scalar, &[edge], 40);
            for level in SimdLevel::available() {
                for rows in 1..8 {
                    let down = rows * 256;
                    let moved = Edge { y0: y0 + down, y1: y1 + down, ..edge };
                    let mut cells = Accumulator::default();
                    cells.resize(40, 2);
                    dispatch!(level, simd => add_edge(simd, &mut cells, moved, 0, 2, &[]));
                    let mut sums = [0; 16];
                    for (column, expected) in expected.iter().enumerate() {
                        for (row, sum) in sums.iter_mut().enumerate() {
                            *sum += cells.strip(row / 8).unwrap().columns[column].0[row % 8];
                        }
                        let found = &sums[rows as usize..rows as usize + 8];
                        assert_eq!(found, expected, "{moved:?}: column {column} at {level:?}");
                    }
                }
            }
        }
    }

    #[test]
    fn total_cover_is_exact_right_of_an_edge() {
        let edge = Edge { x0: 3 * 256 + 7, y0: 100, x1: 29 * 256 + 200, y1: 1300 };
        for level in SimdLevel::available() {
            let sums = accumulate(level, &[edge], 40);
            let expected = [156 * 512, FULL, FULL, FULL, FULL, 20 * 512, 0, 0];
            assert_eq!(sums[35], expected, "{level:?}");
        }
    }
}
