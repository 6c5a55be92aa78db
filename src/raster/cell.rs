//! Cells: signed area and cover of edges, accumulated eight rows at a time.
//!
//! The accumulation is the exact-area method that FreeType and AGG made known, laid out anew: a strip
//! is eight rows high, each pixel column of it is one vector whose lanes are the rows, and the sum along
//! x is one vector addition per column.
//!
//! A piece of an edge inside one pixel that climbs d/256 of its height, at distances f_in and f_out
//! from the pixel's left side (in 1/256), winding s, adds s·(512·d − a) to its own column and s·a to
//! the next one, where a = d·(f_in + f_out). Summed from the left, a pixel then holds 2 · 256² = [`FULL`]
//! times its covered area, and all pixels right of the piece s·d·512. What is added up are integers: the
//! order of edges does not matter.

use fearless_simd::prelude::*;
use fearless_simd::{f32x8, i32x8};

use super::edge::{Edge, EdgeLine};
use crate::num::fixed;
use crate::num::lanes::{max_f32, max_i32, min_f32, min_i32, round_f32};
use crate::surface::block::{BLOCK_HEIGHT, BLOCK_WIDTH};

/// The accumulated value of a fully covered pixel.
pub(crate) const FULL: i32 = 1 << 17;

/// A column of a strip: one value per row.
pub(crate) type Column = [i32; BLOCK_HEIGHT];

/// An edge that runs over more columns than this in a row is walked row by row: eight lanes would
/// mostly idle.
const FLAT_COLUMNS_PER_ROW: f32 = 10.0;

/// Accumulators of the strips of one band.
#[derive(Debug, Default)]
pub(crate) struct Accumulator {
    /// Columns of strip after strip; zero between draws.
    columns: Vec<Column>,
    /// For each column the rows (as bits) that an edge passes through, and those where a second does.
    /// Kept for exact antialiasing only.
    touched: Vec<[u8; 2]>,
    /// One bit for each block of 16 columns that may hold values, strip after strip.
    occupied: Vec<u64>,
    /// Sums of more edges than `columns` can hold; empty but while a crowd of edges is added.
    wide: Vec<[i64; BLOCK_HEIGHT]>,
    /// Columns per strip: the band's, rounded up to blocks, and one block to spill into.
    stride: usize,
    /// Words of `occupied` per strip.
    words: usize,
}

impl Accumulator {
    /// Makes room for `strips` strips of `width` pixels. All values must be zero, as
    /// [`sweep`](super::sweep) leaves them.
    pub(crate) fn resize(&mut self, width: usize, strips: usize) {
        let blocks = width.div_ceil(BLOCK_WIDTH) + 1;
        self.stride = blocks * BLOCK_WIDTH;
        self.words = blocks.div_ceil(64);
        self.columns.resize(self.stride * strips, [0; BLOCK_HEIGHT]);
        self.touched.resize(self.stride * strips, [0; 2]);
        self.occupied.resize(self.words * strips, 0);
    }

    /// Whether some block of strip `index` is occupied.
    pub(crate) fn is_occupied(&self, index: usize) -> bool {
        self.occupied
            .get(index * self.words..(index + 1) * self.words)
            .is_some_and(|words| words.iter().any(|word| *word != 0))
    }

    /// Moves all values to where there is room for any number of them.
    fn set_aside(&mut self) {
        self.wide.resize(self.columns.len(), [0; BLOCK_HEIGHT]);
        for (wide, column) in self.wide.iter_mut().zip(&mut self.columns) {
            for (wide, value) in wide.iter_mut().zip(column) {
                *wide += i64::from(std::mem::take(value));
            }
        }
    }

    /// Brings them back, as values whose sums along x are those set aside, but no farther from zero than a full
    /// pixel's: what the nonzero rule makes of them is the same.
    fn bring_back(&mut self) {
        let full = i64::from(FULL);
        for (columns, wide) in self.columns.chunks_mut(self.stride.max(1)).zip(self.wide.chunks(self.stride.max(1))) {
            let (mut sum, mut before) = ([0_i64; BLOCK_HEIGHT], [0_i64; BLOCK_HEIGHT]);
            for (column, wide) in columns.iter_mut().zip(wide) {
                for (row, value) in column.iter_mut().enumerate() {
                    if let (Some(sum), Some(before), Some(wide)) =
                        (sum.get_mut(row), before.get_mut(row), wide.get(row))
                    {
                        *sum += wide;
                        let cut = (*sum).clamp(-full, full);
                        *value = (cut - *before) as i32;
                        *before = cut;
                    }
                }
            }
        }
        self.wide.clear();
    }

    /// The marks of a pixel's column.
    #[inline(always)]
    fn marks(&mut self, pixel: BandPixel) -> Option<&mut [u8; 2]> {
        self.touched.get_mut(pixel.strip * self.stride..(pixel.strip + 1) * self.stride)?.get_mut(pixel.column)
    }

    /// The accumulator of strip `index`, or `None` past the last.
    #[inline(always)]
    pub(crate) fn strip(&mut self, index: usize) -> Option<StripCells<'_>> {
        Some(StripCells {
            columns: self.columns.get_mut(index * self.stride..(index + 1) * self.stride)?,
            touched: self.touched.get_mut(index * self.stride..(index + 1) * self.stride)?,
            occupied: self.occupied.get_mut(index * self.words..(index + 1) * self.words)?,
        })
    }
}

/// The accumulator of one strip.
pub(crate) struct StripCells<'a> {
    pub(crate) columns: &'a mut [Column],
    pub(crate) touched: &'a mut [[u8; 2]],
    pub(crate) occupied: &'a mut [u64],
}

impl StripCells<'_> {
    /// Marks the blocks that hold columns `first ..= last` as occupied.
    #[inline(always)]
    pub(crate) fn occupy(&mut self, first: usize, last: usize) {
        let (first, last) = (first / BLOCK_WIDTH, last / BLOCK_WIDTH);
        let (first_word, last_word) = (first / 64, last / 64);
        // Edges that cross a strip within one word of 1,024 columns need one OR.
        let low = u64::MAX << (first % 64);
        let high = u64::MAX >> (63 - last % 64);
        if first_word == last_word {
            if let Some(word) = self.occupied.get_mut(first_word) {
                *word |= low & high;
            }
        } else if let Some(words) = self.occupied.get_mut(first_word..=last_word) {
            for (index, word) in words.iter_mut().enumerate() {
                let index = first_word + index;
                *word |= if index == first_word {
                    low
                } else if index == last_word {
                    high
                } else {
                    u64::MAX
                };
            }
        }
    }

    /// Adds a piece of an edge that lies within one row: from x0 to x1 (either order), climbing `dy` (0 ..= 256,
    /// times the winding). The scalar specification of the kernel below, and the way very flat edges go.
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
        let total = dy.abs();
        let winding = dy.signum();
        let run = right - left;
        // Heights in 1/512 of 1/256 pixel, so that what is rounded does not show.
        let mut climbed = 0;
        for (index, pair) in (first..=last).zip(0..) {
            let base = index << fixed::SHIFT;
            let boundary = base + fixed::ONE;
            // How high the piece has climbed at the pixel's right side.
            let height = if index == last {
                total * 512
            } else {
                ((1024 * i64::from(boundary - left) * i64::from(total) + i64::from(run)) / (2 * i64::from(run))) as i32
            };
            let cover = height - climbed;
            climbed = height;
            let (enter, leave) = (left.max(base) - base, right.min(boundary) - base);
            let area = (cover * (enter + leave) + 256) >> 9;
            if let Some([here, next]) = columns.get_mut(pair..pair + 2).and_then(|c| c.first_chunk_mut::<2>()) {
                if let (Some(here), Some(next)) = (here.get_mut(row), next.get_mut(row)) {
                    *here = here.wrapping_add(winding * (cover - area));
                    *next = next.wrapping_add(winding * area);
                }
            }
        }
    }
}

/// Fraction bits of x where an edge enters and leaves a strip: it is rounded there once more, and finer
/// than its ends, so that this does not show.
const FINE_SHIFT: u32 = 12;

/// A difference of x in 20.12 fixed point, in 1/256 pixel.
#[inline(always)]
fn fine(x: i32) -> f32 {
    x as f32 * (1.0 / 16.0)
}

/// Adds the part of an edge that lies in one strip, from (start_x, start_y) down to (end_x, end_y); `top` is
/// the strip's top. x in 20.12, y in 24.8 fixed point. With `TOUCH`, notes which pixels it passes through.
#[inline(always)]
pub(crate) fn add_piece<S: Simd, const TOUCH: bool>(
    simd: S,
    cells: &mut StripCells<'_>,
    (start_x, start_y): (i32, i32),
    (end_x, end_y): (i32, i32),
    winding: i32,
    top: i32,
) {
    let (low_x, high_x) = if start_x < end_x { (start_x, end_x) } else { (end_x, start_x) };
    let first = low_x >> FINE_SHIFT;
    let last = high_x >> FINE_SHIFT;
    let (run, rise) = (fine(end_x - start_x), (end_y - start_y) as f32);

    let columns_count = (last - first) as f32;
    if columns_count * 256.0 > FLAT_COLUMNS_PER_ROW * rise && columns_count > 4.0 {
        let round = |x: i32| (x + (1 << (FINE_SHIFT - fixed::SHIFT - 1))) >> (FINE_SHIFT - fixed::SHIFT);
        add_flat::<TOUCH>(cells, round(start_x), start_y, round(end_x), end_y, top, winding);
        return;
    }

    cells.occupy(first as usize, last as usize + 1);
    let Some(columns) = cells.columns.get_mut(first as usize..last as usize + 2) else { return };

    // Each row's part: from `upper` to `lower`, at x `upper_x` and `lower_x` right of the first column.
    // Everything below is float until a column's area and cover are rounded: x is then good to far less
    // than 1/256 pixel, and signs are exact, so that what two edges share cancels.
    let rows = i32x8::simd_from(simd, [0, 256, 512, 768, 1024, 1280, 1536, 1792]) + top;
    let start_y8 = i32x8::splat(simd, start_y);
    let end_y8 = i32x8::splat(simd, end_y);
    let upper = min_i32(max_i32(rows, start_y8), end_y8) - start_y;
    let lower = min_i32(max_i32(rows + 256, start_y8), end_y8) - start_y;
    let dy = (lower - upper).to_float::<f32x8<S>>();
    let slope = run / rise;
    let base = first << FINE_SHIFT;
    let low8 = f32x8::splat(simd, fine(low_x - base));
    let high8 = f32x8::splat(simd, fine(high_x - base));
    let start8 = f32x8::splat(simd, fine(start_x - base));
    let upper_x = upper.to_float::<f32x8<S>>() * slope + start8;
    let lower_x = lower.to_float::<f32x8<S>>() * slope + start8;
    let upper_x = min_f32(max_f32(upper_x, low8), high8);
    let lower_x = min_f32(max_f32(lower_x, low8), high8);
    let sign = winding as f32;

    if first == last {
        let area = round_f32(dy * sign * (upper_x + lower_x));
        let cover = round_f32(dy * (512.0 * sign));
        if let [here, next, ..] = columns {
            (i32x8::load_array_ref(simd, here) + cover - area).store_array(here);
            (i32x8::load_array_ref(simd, next) + area).store_array(next);
        }
        if TOUCH {
            touch(&mut cells.touched.get_mut(first as usize), rows_of(cover, simd));
        }
        return;
    }

    let left = min_f32(upper_x, lower_x);
    let right = max_f32(upper_x, lower_x);
    // How much a row's part climbs per unit of x.
    let steep = f32x8::splat(simd, rise / if run < 0.0 { -run } else { run });
    let zero = f32x8::splat(simd, 0.0);
    let mut climbed = zero;
    let mut covered = i32x8::splat(simd, 0);
    let mut carry = i32x8::splat(simd, 0);
    let mut base = 0.0;
    let (body, spill) = columns.split_at_mut(columns.len() - 1);
    for (index, column) in body.iter_mut().enumerate() {
        let base8 = f32x8::splat(simd, base);
        let boundary8 = base8 + 256.0;
        // How high the part has climbed at the column's right side.
        let reach = min_f32(max_f32((boundary8 - left) * steep, zero), dy);
        let height = right.simd_lt(boundary8).select(dy, reach);
        let d = (height - climbed) * sign;
        climbed = height;
        // The sum of the covers is the rounded height, whatever each is rounded to.
        let height = round_f32(height * (512.0 * sign));
        let cover = height - covered;
        covered = height;
        let middle = max_f32(left, base8) + min_f32(right, boundary8) - 2.0 * base;
        let area = round_f32(d * middle);
        (i32x8::load_array_ref(simd, column) + (cover - area) + carry).store_array(column);
        carry = area;
        if TOUCH {
            touch(&mut cells.touched.get_mut(first as usize + index), rows_of(cover, simd));
        }
        base += 256.0;
    }
    if let Some(column) = spill.first_mut() {
        (i32x8::load_array_ref(simd, column) + carry).store_array(column);
    }
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
    pub(crate) const EVERYTHING: Self = Self { low: i32::MIN, high: i32::MAX };
    pub(crate) const NOTHING: Self = Self { low: i32::MIN, high: i32::MIN };

    /// The columns `first..end`.
    pub(crate) fn columns(first: usize, end: usize) -> Self {
        Self { low: (first as i32) << FINE_SHIFT, high: (end as i32) << FINE_SHIFT }
    }
}

/// A strip's height in fixed point.
const STRIP: i32 = (BLOCK_HEIGHT as i32) << fixed::SHIFT;

/// Adds the part of `edge` inside the band whose top is at `top` (fixed point, a whole strip) and which has
/// `strips` strips.
///
/// Where an edge leaves a strip is a function of the edge and of that scanline, so that it does not
/// matter in which band the strip is. `reaches` says of each strip which columns matter; all of those of strips that it
/// does not have.
#[inline(always)]
pub(crate) fn add_edge<S: Simd, const TOUCH: bool>(
    simd: S,
    cells: &mut Accumulator,
    edge: Edge,
    top: i32,
    strips: usize,
    reaches: &[Reach],
) {
    let (x0, y0, x1, y1, winding) = edge.downward();
    let first = (y0 - top).div_euclid(STRIP);
    let last = (y1 - 1 - top).div_euclid(STRIP);
    let line = (first != last).then(|| EdgeLine::new(x0, y0, x1, y1));
    for index in first.max(0)..(last + 1).min(strips as i32) {
        let strip_top = top + index * STRIP;
        let bottom = strip_top + STRIP;
        let (mut start, mut end) = ((x0 << 4, y0), (x1 << 4, y1));
        if let Some(line) = line {
            if y0 < strip_top {
                start = (line.fine_x_at(strip_top), strip_top);
            }
            if y1 > bottom {
                end = (line.fine_x_at(bottom), bottom);
            }
        }
        let Reach { low, high } = reaches.get(index as usize).copied().unwrap_or(Reach::EVERYTHING);
        if start.0 >= high && end.0 >= high {
            continue;
        }
        if start.0 < low && end.0 < low {
            (start.0, end.0) = (low, low);
        }
        if let Some(mut strip) = cells.strip(index as usize) {
            add_piece::<S, TOUCH>(simd, &mut strip, start, end, winding, strip_top);
        }
    }
}

/// From so many edges on, the sums of their areas could leave the 32 bits of a cell.
pub(crate) const CROWD: usize = (i32::MAX / FULL) as usize;

/// Adds any number of edges, to be read by the nonzero rule: by the crowd, whose sums are set aside.
#[inline(always)]
pub(crate) fn add_crowd<S: Simd>(
    simd: S,
    cells: &mut Accumulator,
    edges: &[Edge],
    top: i32,
    strips: usize,
    reaches: &[Reach],
) {
    for crowd in edges.chunks(CROWD - 1) {
        for edge in crowd {
            add_edge::<S, false>(simd, cells, *edge, top, strips, reaches);
        }
        cells.set_aside();
    }
    cells.bring_back();
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

/// A pixel of a band.
#[derive(Clone, Copy)]
struct BandPixel {
    strip: usize,
    column: usize,
    row: usize,
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

/// The rows of a column in which an edge climbs, as bits.
#[inline(always)]
fn rows_of<S: Simd>(d: i32x8<S>, simd: S) -> u8 {
    d.simd_eq(i32x8::splat(simd, 0)).to_bitmask() as u8 ^ 0xff
}

#[inline(always)]
fn touch(column: &mut Option<&mut [u8; 2]>, rows: u8) {
    if let Some([once, twice]) = column {
        *twice |= *once & rows;
        *once |= rows;
    }
}

/// Adds a flat piece row by row.
#[inline(never)]
fn add_flat<const TOUCH: bool>(
    cells: &mut StripCells<'_>,
    start_x: i32,
    start_y: i32,
    end_x: i32,
    end_y: i32,
    top: i32,
    winding: i32,
) {
    let line = EdgeLine::new(start_x, start_y, end_x, end_y);
    let (mut x, mut y) = (start_x, start_y);
    while y < end_y {
        let row = (y - top) >> fixed::SHIFT;
        let next_y = end_y.min(top + ((row + 1) << fixed::SHIFT));
        let next_x = if next_y == end_y { end_x } else { line.x_at(next_y) };
        cells.add_row_piece(row as usize, x, next_x, (next_y - y) * winding);
        if TOUCH {
            let (left, right) = if x < next_x { (x, next_x) } else { (next_x, x) };
            let (first, last) = (left >> fixed::SHIFT, (right >> fixed::SHIFT).max(left >> fixed::SHIFT));
            for column in cells.touched.get_mut(first as usize..=last as usize).unwrap_or(&mut []) {
                touch(&mut Some(column), 1 << row);
            }
        }
        (x, y) = (next_x, next_y);
    }
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

    fn accumulate(level: SimdLevel, edges: &[Edge], width: usize) -> Vec<Column> {
        let mut cells = Accumulator::default();
        cells.resize(width, 1);
        for edge in edges {
            dispatch!(level, simd => add_edge::<_, true>(simd, &mut cells, *edge, 0, 1, &[]));
        }
        let strip = cells.strip(0).unwrap();
        let mut sum = [0_i32; 8];
        let out = strip.columns[..width]
            .iter()
            .map(|column| {
                for (s, c) in sum.iter_mut().zip(column) {
                    *s += c;
                }
                sum
            })
            .collect();
        for (column, values) in strip.columns.iter().enumerate() {
            let bit = strip.occupied[column / 16 / 64] >> (column / 16 % 64) & 1;
            assert!(bit == 1 || *values == [0; 8], "column {column} holds values but is not marked");
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
    fn total_cover_is_exact_right_of_an_edge() {
        let edge = Edge { x0: 3 * 256 + 7, y0: 100, x1: 29 * 256 + 200, y1: 1300 };
        for level in SimdLevel::available() {
            let sums = accumulate(level, &[edge], 40);
            let expected = [156 * 512, FULL, FULL, FULL, FULL, 20 * 512, 0, 0];
            assert_eq!(sums[35], expected, "{level:?}");
        }
    }
}
