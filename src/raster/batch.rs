//! Edges of a draw into cells, looked at sixteen at a time: which way each goes, how steeply, and in which strip and
//! columns, is found for all of them at once, which is one vector of 512 bits or two of 256. Those that stay within one strip, as most of small shapes and of curves
//! do, are then added straight away; the others take the kernel's general way.

use fearless_simd::prelude::*;
use fearless_simd::{f32x16, i32x16, mask32x16};

use super::bins::{Edges, LANES};
use super::cell::{Accumulator, Column};
use super::edge::{FineLine, FixedPoint};
use super::kernel::{
    FINE_SHIFT, PieceLine, Reach, RowParts, STRIP_SHIFT, Slant, add_across, add_downward, add_row_parts,
    add_strip_part, are_flat, fine, is_flat, two_columns,
};
use crate::num::fixed;
use crate::num::lanes::{greater_f32, least_of_sixteen, lesser_f32, max_i32, min_i32};
use crate::surface::block::BLOCK_HEIGHT;

/// From 24.8 to 20.12 fixed point.
const FINER_SHIFT: u32 = FINE_SHIFT - fixed::SHIFT;

/// Adds edges to the band whose top is at `top` and which has `strips` strips, as
/// [`add_edge`](super::kernel::add_edge) does one of them.
#[inline(always)]
pub(crate) fn add_edges<S: Simd>(
    simd: S,
    cells: &mut Accumulator,
    edges: Edges<'_>,
    top: i32,
    strips: usize,
    reaches: &[Reach],
) {
    edges.for_batches(
        #[inline(always)]
        |from, to, count| {
            let batch = Batch::new(simd, from, to, top);
            let all = (1 << count) - 1;
            let (mut single, mut others) = (batch.single & all, batch.climbs & !batch.single & all);
            let small = batch.small & all;
            if is_worth_a_batch(small) {
                single &= !small;
                others = others & !small | add_small(simd, cells, &batch, small, strips, reaches);
            }
            while single != 0 {
                let lane = single.trailing_zeros() as usize & (LANES - 1);
                single &= single - 1;
                if !add_single(simd, cells, &batch, lane, strips, reaches) {
                    others |= 1 << lane;
                }
            }
            let mut across = batch.across & others;
            others &= !across;
            while across != 0 {
                let lane = across.trailing_zeros() as usize & (LANES - 1);
                across &= across - 1;
                let strip = batch.start_y[lane] >> STRIP_SHIFT;
                let ends = (batch.least[lane], batch.greatest[lane]);
                add_across(simd, cells, strip, strips, batch.line(lane), ends, reaches);
            }
            let tall = others & batch.tall;
            if tall & tall.wrapping_sub(1) != 0 {
                add_tall(simd, cells, &batch, others, top, strips, reaches);
                return;
            }
            while others != 0 {
                let lane = others.trailing_zeros() as usize & (LANES - 1);
                others &= others - 1;
                add_downward(simd, cells, batch.downward(lane, top), top, strips, reaches);
            }
        },
    );
}

/// Whether so many edges at once are reckoned faster than each for itself: from three on.
#[inline(always)]
fn is_worth_a_batch(edges: u32) -> bool {
    let but_one = edges & edges.wrapping_sub(1);
    but_one & but_one.wrapping_sub(1) != 0
}

/// Adds edges of at most two rows and two columns; the answer are those of them that are for the general way.
#[inline(always)]
fn add_small<S: Simd>(
    simd: S,
    cells: &mut Accumulator,
    batch: &Batch,
    small: u32,
    strips: usize,
    reaches: &[Reach],
) -> u32 {
    let areas = SmallAreas::new(simd, batch);
    // Mostly they are neighbours: what strips and columns have to be asked is then asked once for all of them.
    let near = Near::new(simd, batch, small);
    if near.is_small() && cells.holds(near.last() + 3) && near.is_seen(reaches) {
        cells.occupy(near.first_strip(), near.first(), near.last() + 1);
        if near.last_strip() != near.first_strip() {
            cells.occupy(near.last_strip(), near.first(), near.last() + 1);
        }
        areas.add(simd, cells, batch, small);
        return 0;
    }
    let mut others = 0;
    let mut left = small;
    while left != 0 {
        let lane = left.trailing_zeros() as usize & (LANES - 1);
        left &= left - 1;
        if batch.single >> lane & 1 == 0 {
            others |= 1 << lane;
            continue;
        }
        let (strip, first, last) = match batch.place(lane, strips, reaches) {
            Place::Seen(strip, first, last) => (strip, first, last),
            Place::Unseen => continue,
            Place::PartlySeen => {
                others |= 1 << lane;
                continue;
            }
        };
        let Some(mut strip) = cells.strip(strip) else { continue };
        strip.occupy_pair(first, last + 1);
        let row = (batch.start_y[lane] >> fixed::SHIFT) as usize & (BLOCK_HEIGHT - 1);
        if let Some(columns) = strip.columns.get_mut(first..).and_then(|rest| rest.first_chunk_mut::<3>()) {
            areas.add_lane(columns, lane, row);
        }
    }
    others
}

/// Where some edges lie.
struct Near {
    /// The least and the greatest x.
    least: i32,
    greatest: i32,
    /// The least y and the greatest that belongs to them, from the band's top.
    top: i32,
    bottom: i32,
}

impl Near {
    /// Edges less far apart are near each other: blocks between them are taken to hold values.
    const FARTHEST: i32 = 48 << fixed::SHIFT;

    #[inline(always)]
    fn new<S: Simd>(simd: S, batch: &Batch, edges: u32) -> Self {
        let chosen = mask32x16::from_bitmask(simd, u64::from(edges));
        let none = i32x16::splat(simd, i32::MAX);
        let (start_y, height) =
            (i32x16::load_array_ref(simd, &batch.start_y), i32x16::load_array_ref(simd, &batch.height));
        // The greatest is the least of what all bits are turned around of.
        let [least, greatest, top, bottom] = least_of_sixteen([
            chosen.select(i32x16::load_array_ref(simd, &batch.least), none),
            chosen.select(!i32x16::load_array_ref(simd, &batch.greatest), none),
            chosen.select(start_y, none),
            chosen.select(!(start_y + height - 1), none),
        ]);
        Self { least, greatest: !greatest, top, bottom: !bottom }
    }

    /// Whether they are near each other, in one strip or two.
    #[inline(always)]
    fn is_small(&self) -> bool {
        self.greatest - self.least < Self::FARTHEST && self.last_strip() - self.first_strip() <= 1
    }

    #[inline(always)]
    fn first(&self) -> usize {
        (self.least >> fixed::SHIFT) as usize
    }

    #[inline(always)]
    fn last(&self) -> usize {
        (self.greatest >> fixed::SHIFT) as usize
    }

    /// The strips in which they lie, which may be above the band or beneath.
    #[inline(always)]
    fn first_strip(&self) -> i32 {
        self.top >> STRIP_SHIFT
    }

    #[inline(always)]
    fn last_strip(&self) -> i32 {
        self.bottom >> STRIP_SHIFT
    }

    /// Whether all of them matters, as far as they are in the band.
    #[inline(always)]
    fn is_seen(&self, reaches: &[Reach]) -> bool {
        let is_seen =
            |strip: i32| reaches.get(strip as usize).is_none_or(|reach| reach.holds(self.least, self.greatest));
        is_seen(self.first_strip()) && is_seen(self.last_strip())
    }
}

/// What edges of at most two rows and two columns add, a lane for each of them: to the cells of the first column, of the
/// next and of the one after, in the row in which they start and in the one beneath. The kernel's formula, across instead of
/// down.
struct SmallAreas {
    columns: [[[i32; LANES]; 2]; 3],
}

/// What is taken from the row that follows: nothing where that is another strip's. Not a closure: those are not always inlined, and lose
/// the SIMD level then.
///
/// Taken, not added: the compiler would make one addition of it and its neighbour above, of 64 bits, which has to wait for the one before
/// where that lay half a row higher.
#[inline(always)]
fn less_in_next_row<S: Simd>(simd: S, is_last: mask32x16<S>, lower: &[i32; LANES]) -> [i32; LANES] {
    let zero = i32x16::splat(simd, 0);
    is_last.select(zero, zero - i32x16::load_array_ref(simd, lower)).to_array()
}

impl SmallAreas {
    #[inline(always)]
    fn new<S: Simd>(simd: S, batch: &Batch) -> Self {
        let (height, start_y) =
            (i32x16::load_array_ref(simd, &batch.height), i32x16::load_array_ref(simd, &batch.start_y));
        let (start, slope) = (f32x16::load_array_ref(simd, &batch.start), f32x16::load_array_ref(simd, &batch.slope));
        // How far down the lower row begins.
        let upper = min_i32(i32x16::splat(simd, 256) - (start_y & 255), height);
        let middle = upper.to_float::<f32x16<S>>() * slope + start;
        let end = height.to_float::<f32x16<S>>() * slope + start;
        let upper_row = Self::row(simd, batch, start, middle, upper);
        let lower_row = Self::row(simd, batch, middle, end, height - upper);
        let ([a, b, c], [d, e, f]) = (upper_row, lower_row);
        Self { columns: [[a, d], [b, e], [c, f]] }
    }

    /// Adds all of `edges`. Rows above and below the band are left out.
    #[inline(always)]
    fn add<S: Simd>(&self, simd: S, cells: &mut Accumulator, batch: &Batch, edges: u32) {
        const ROWS: i32 = BLOCK_HEIGHT as i32;
        const SPAN: usize = 2 * BLOCK_HEIGHT + 2;
        let stride = cells.stride() as i32;
        let row = i32x16::load_array_ref(simd, &batch.start_y) >> fixed::SHIFT;
        let column = i32x16::load_array_ref(simd, &batch.least) >> fixed::SHIFT;
        let within = row & (ROWS - 1);
        // Of their first cells. Outside of the band there is no such place, or it is negative.
        let places = (((row >> ROWS.ilog2()) * stride + column) * ROWS + within).to_array();
        // The row beneath a strip's last is not the cell that follows.
        let is_last = within.simd_eq(ROWS - 1);
        let [[a, lower_a], [b, lower_b], [c, lower_c]] = &self.columns;
        let d = less_in_next_row(simd, is_last, lower_a);
        let e = less_in_next_row(simd, is_last, lower_b);
        let f = less_in_next_row(simd, is_last, lower_c);
        let cells = cells.cells();
        let mut left = edges;
        while left != 0 {
            let lane = left.trailing_zeros() as usize & (LANES - 1);
            left &= left - 1;
            // What is negative lies far beyond the end; where addresses have 32 bits, it may end before it starts, and is no range.
            let place = places[lane] as u32 as usize;
            let span = cells.get_mut(place..place.wrapping_add(SPAN)).and_then(|span| span.first_chunk_mut::<SPAN>());
            let Some(cells) = span else { continue };
            // Where there is no lower row, zeros are taken: a branch would be wrong half of the time.
            cells[0] = cells[0].wrapping_add(a[lane]);
            cells[1] = cells[1].wrapping_sub(d[lane]);
            cells[BLOCK_HEIGHT] = cells[BLOCK_HEIGHT].wrapping_add(b[lane]);
            cells[BLOCK_HEIGHT + 1] = cells[BLOCK_HEIGHT + 1].wrapping_sub(e[lane]);
            cells[2 * BLOCK_HEIGHT] = cells[2 * BLOCK_HEIGHT].wrapping_add(c[lane]);
            cells[2 * BLOCK_HEIGHT + 1] = cells[2 * BLOCK_HEIGHT + 1].wrapping_sub(f[lane]);
        }
        let mut across = edges & !batch.single;
        while across != 0 {
            let lane = across.trailing_zeros() as usize & (LANES - 1);
            across &= across - 1;
            let place = (places[lane] + (stride - 1) * ROWS + 1) as usize;
            if let Some(cells) = cells.get_mut(place..).and_then(|rest| rest.first_chunk_mut::<SPAN>()) {
                for (column, value) in [lower_a, lower_b, lower_c].into_iter().enumerate() {
                    let cell = &mut cells[column * BLOCK_HEIGHT];
                    *cell = cell.wrapping_add(value[lane]);
                }
            }
        }
    }

    /// Adds an edge of one strip in a row and the one below.
    #[inline(always)]
    fn add_lane(&self, columns: &mut [Column; 3], lane: usize, row: usize) {
        let below = (row + 1) & (BLOCK_HEIGHT - 1);
        for (column, [upper, lower]) in columns.iter_mut().zip(&self.columns) {
            column.0[row] = column.0[row].wrapping_add(upper[lane]);
            column.0[below] = column.0[below].wrapping_add(lower[lane]);
        }
    }

    /// What parts add that go from `from` to `to`, so far down.
    #[inline(always)]
    fn row<S: Simd>(simd: S, batch: &Batch, from: f32x16<S>, to: f32x16<S>, climb: i32x16<S>) -> [[i32; LANES]; 3] {
        let signed = climb * i32x16::load_array_ref(simd, &batch.winding);
        let steep = f32x16::load_array_ref(simd, &batch.steep);
        let beyond = (signed + signed).to_float::<f32x16<S>>();
        let (left, right) = (lesser_f32(from, to), greater_f32(from, to));
        let [here, next, after] = two_columns(simd, left, right, steep, beyond, signed << 9);
        [here.to_array(), next.to_array(), after.to_array()]
    }
}

/// Adds edges strip by strip, as the general way does edge by edge: where each of them enters and leaves a strip is found for all
/// at once.
#[inline(never)]
fn add_tall<S: Simd>(
    simd: S,
    cells: &mut Accumulator,
    batch: &Batch,
    edges: u32,
    top: i32,
    strips: usize,
    reaches: &[Reach],
) {
    simd.vectorize(
        #[inline(always)]
        || add_tall_inner(simd, cells, batch, edges, top, strips, reaches),
    )
}

#[inline(always)]
fn add_tall_inner<S: Simd>(
    simd: S,
    cells: &mut Accumulator,
    batch: &Batch,
    edges: u32,
    top: i32,
    strips: usize,
    reaches: &[Reach],
) {
    let crossings = Crossings::new(batch);
    let (first, end) = batch.strips(edges, strips);
    let mut from = crossings.at(simd, batch, (first as i32) << STRIP_SHIFT);
    for index in first..end {
        let strip_top = (index as i32) << STRIP_SHIFT;
        let to = crossings.at(simd, batch, strip_top + (1 << STRIP_SHIFT));
        let pieces = Pieces::new(simd, batch, &from, &to, strip_top);
        let (mut left, mut general) = (pieces.climbs & edges, 0_u32);
        if let Some(mut strip) = cells.strip(index) {
            while left != 0 {
                let lane = left.trailing_zeros() as usize & (LANES - 1);
                left &= left - 1;
                let (first, last) = (pieces.first[lane] as usize, pieces.last[lane] as usize);
                let seen = reaches.get(index).is_none_or(|reach| reach.holds_columns(first, last));
                if pieces.flat >> lane & 1 != 0 || !seen {
                    general |= 1 << lane;
                    continue;
                }
                let (below, height) = (pieces.below[lane], pieces.height[lane]);
                let (start, slant) = (pieces.start[lane], batch.slant(lane));
                let parts = RowParts::of(simd, PieceLine { below, height, start, slant });
                add_row_parts(simd, &mut strip, parts, first, last);
            }
        }
        while general != 0 {
            let lane = general.trailing_zeros() as usize & (LANES - 1);
            general &= general - 1;
            let y = top + strip_top + pieces.below[lane];
            let (start, end) = ((from[lane], y), (to[lane], y + pieces.height[lane]));
            add_strip_part(simd, cells, index, start, end, batch.slant(lane), top, reaches);
        }
        from = to;
    }
}

/// Batch edges' lines, a lane for each, as [`FineLine`](super::edge::FineLine) has them.
struct Crossings {
    x: [f64; LANES],
    slope: [f64; LANES],
}

impl Crossings {
    #[inline(always)]
    fn new(batch: &Batch) -> Self {
        let (mut x, mut slope) = ([0.0; LANES], [0.0; LANES]);
        for lane in 0..LANES {
            let line = FineLine::new(batch.start_x[lane], batch.end_x[lane], batch.height[lane]);
            (x[lane], slope[lane]) = (line.x, line.slope);
        }
        Self { x, slope }
    }

    /// x in 20.12 fixed point where they cross y, from the band's top; where they start or end, if they do not.
    #[inline(always)]
    fn at<S: Simd>(&self, simd: S, batch: &Batch, y: i32) -> [i32; LANES] {
        let (start_y, height) =
            (i32x16::load_array_ref(simd, &batch.start_y), i32x16::load_array_ref(simd, &batch.height));
        let down = i32x16::splat(simd, y) - start_y;
        let (mut x, climbs) = ([0; LANES], down.to_array());
        for lane in 0..LANES {
            x[lane] = FineLine { x: self.x[lane], slope: self.slope[lane] }.x_at(climbs[lane]);
        }
        let (start_x, end_x) =
            (i32x16::load_array_ref(simd, &batch.start_x), i32x16::load_array_ref(simd, &batch.end_x));
        let x = down.simd_ge(height).select(end_x << FINER_SHIFT, i32x16::load_array(simd, x));
        down.simd_le(0).select(start_x << FINER_SHIFT, x).to_array()
    }
}

/// The pieces of the edges in one strip, a lane for each, as a [`PieceLine`] has them.
struct Pieces {
    /// Which of them there are, as bits, and which should be walked row by row.
    climbs: u32,
    flat: u32,
    below: [i32; LANES],
    height: [i32; LANES],
    start: [f32; LANES],
    first: [i32; LANES],
    last: [i32; LANES],
}

impl Pieces {
    /// Those in the strip whose top lies so far below the band's, in which they go from x to x (20.12 fixed point).
    #[inline(always)]
    fn new<S: Simd>(simd: S, batch: &Batch, from: &[i32; LANES], to: &[i32; LANES], strip_top: i32) -> Self {
        let (from, to) = (i32x16::load_array_ref(simd, from), i32x16::load_array_ref(simd, to));
        let start_y = i32x16::load_array_ref(simd, &batch.start_y) - strip_top;
        let end_y = start_y + i32x16::load_array_ref(simd, &batch.height);
        let below = max_i32(start_y, i32x16::splat(simd, 0));
        let height = min_i32(end_y, i32x16::splat(simd, 1 << STRIP_SHIFT)) - below;
        let (first, last) = (min_i32(from, to) >> FINE_SHIFT, max_i32(from, to) >> FINE_SHIFT);
        let start = (from - (first << FINE_SHIFT)).to_float::<f32x16<S>>() * f32x16::splat(simd, fine(1));
        Self {
            climbs: height.simd_gt(0).to_bitmask() as u32,
            flat: are_flat(first, last, height),
            below: below.to_array(),
            height: height.to_array(),
            start: start.to_array(),
            first: first.to_array(),
            last: last.to_array(),
        }
    }
}

/// Adds an edge that keeps to one strip; false if it is for the general way: flat, or only some of its columns matter.
#[inline(always)]
fn add_single<S: Simd>(
    simd: S,
    cells: &mut Accumulator,
    batch: &Batch,
    lane: usize,
    strips: usize,
    reaches: &[Reach],
) -> bool {
    let (strip, first, last) = match batch.place(lane, strips, reaches) {
        Place::Seen(strip, first, last) => (strip, first, last),
        Place::Unseen => return true,
        Place::PartlySeen => return false,
    };
    if is_flat(first, last, batch.height[lane]) {
        return false;
    }
    if let Some(mut strip) = cells.strip(strip) {
        add_row_parts(simd, &mut strip, RowParts::of(simd, batch.line(lane)), first, last);
    }
    true
}

/// Where an edge of one strip lies.
enum Place {
    /// Where nothing matters.
    Unseen,
    /// In columns of which only some matter.
    PartlySeen,
    /// In this strip, and from this column to that.
    Seen(usize, usize, usize),
}

impl Place {
    /// That of what lies in a strip, between two x.
    #[inline(always)]
    fn of(strip: i32, least: i32, greatest: i32, strips: usize, reaches: &[Reach]) -> Self {
        // Above the band the strip is negative, which no index is.
        let strip = strip as usize;
        if strip >= strips {
            return Self::Unseen;
        }
        if let Some(reach) = reaches.get(strip) {
            if reach.ends_before(least) {
                return Self::Unseen;
            }
            if !reach.holds(least, greatest) {
                return Self::PartlySeen;
            }
        }
        Self::Seen(strip, (least >> fixed::SHIFT) as usize, (greatest >> fixed::SHIFT) as usize)
    }
}

/// What there is to know of so many edges: each array has a lane for each.
struct Batch {
    /// Which of them are not horizontal, as bits, and which of these lie within one strip.
    climbs: u32,
    single: u32,
    /// Which of the former have at most two rows and two columns.
    small: u32,
    /// Which of them reach into a second strip and are reckoned in one go all the same.
    across: u32,
    /// Which of them are higher than a strip.
    tall: u32,
    /// Where they start, downwards; y from the band's top.
    start_x: [i32; LANES],
    start_y: [i32; LANES],
    end_x: [i32; LANES],
    height: [i32; LANES],
    /// As a [`PieceLine`] has them.
    start: [f32; LANES],
    slope: [f32; LANES],
    steep: [f32; LANES],
    winding: [i32; LANES],
    /// The least and the greatest x.
    least: [i32; LANES],
    greatest: [i32; LANES],
}

impl Batch {
    #[inline(always)]
    fn new<S: Simd>(simd: S, from: &[FixedPoint; LANES], to: &[FixedPoint; LANES], top: i32) -> Self {
        let ((from_x, from_y), (to_x, to_y)) = (coordinates(simd, from), coordinates(simd, to));
        let down = from_y.simd_lt(to_y);
        let (start_x, end_x) = (down.select(from_x, to_x), down.select(to_x, from_x));
        let (start_y, end_y) = (min_i32(from_y, to_y) - top, max_i32(from_y, to_y) - top);
        let winding = down.select(i32x16::splat(simd, 1), i32x16::splat(simd, -1));
        let (least, greatest) = (min_i32(from_x, to_x), max_i32(from_x, to_x));
        let height = end_y - start_y;
        let one_strip = (start_y >> STRIP_SHIFT).simd_eq((end_y - 1) >> STRIP_SHIFT);
        let climbs = height.simd_gt(0);
        let rows = ((end_y - 1) >> fixed::SHIFT) - (start_y >> fixed::SHIFT);
        let columns = (greatest >> fixed::SHIFT) - (least >> fixed::SHIFT);
        let small = (rows | columns).simd_lt(2);
        let across = climbs & !one_strip & rows.simd_lt(BLOCK_HEIGHT as i32);
        let flat = are_flat(least >> fixed::SHIFT, greatest >> fixed::SHIFT, height);
        let (run, rise) = ((end_x - start_x).to_float::<f32x16<S>>(), height.to_float::<f32x16<S>>());
        let zero = f32x16::splat(simd, 0.0);
        let steep = rise * winding.to_float::<f32x16<S>>() / run.abs();
        Self {
            climbs: climbs.to_bitmask() as u32,
            single: (climbs & one_strip).to_bitmask() as u32,
            small: (climbs & small).to_bitmask() as u32,
            across: across.to_bitmask() as u32 & !flat,
            tall: height.simd_gt(1 << STRIP_SHIFT).to_bitmask() as u32,
            start_x: start_x.to_array(),
            start_y: start_y.to_array(),
            end_x: end_x.to_array(),
            height: height.to_array(),
            start: (start_x - ((least >> fixed::SHIFT) << fixed::SHIFT)).to_float::<f32x16<S>>().to_array(),
            slope: (run / rise).to_array(),
            steep: run.simd_eq(zero).select(zero, steep).to_array(),
            winding: winding.to_array(),
            least: least.to_array(),
            greatest: greatest.to_array(),
        }
    }

    /// The strips that some of `edges` cross: a range within `0..strips`.
    #[inline(always)]
    fn strips(&self, edges: u32, strips: usize) -> (usize, usize) {
        let (mut first, mut last) = (i32::MAX, i32::MIN);
        let mut left = edges;
        while left != 0 {
            let lane = left.trailing_zeros() as usize & (LANES - 1);
            left &= left - 1;
            first = first.min(self.start_y[lane]);
            last = last.max(self.start_y[lane] + self.height[lane] - 1);
        }
        let strip_of = |y: i32| (y.max(0) as usize) >> STRIP_SHIFT;
        (strip_of(first), (strip_of(last) + 1).min(strips))
    }

    /// Where one of those lies that keep to one strip.
    #[inline(always)]
    fn place(&self, lane: usize, strips: usize, reaches: &[Reach]) -> Place {
        let strip = self.start_y[lane] >> STRIP_SHIFT;
        Place::of(strip, self.least[lane], self.greatest[lane], strips, reaches)
    }

    /// One that keeps to a strip, or has no more rows than a strip.
    #[inline(always)]
    fn line(&self, lane: usize) -> PieceLine {
        PieceLine {
            below: self.start_y[lane] & ((1 << STRIP_SHIFT) - 1),
            height: self.height[lane],
            start: self.start[lane],
            slant: self.slant(lane),
        }
    }

    #[inline(always)]
    fn slant(&self, lane: usize) -> Slant {
        Slant { slope: self.slope[lane], steep: self.steep[lane], winding: self.winding[lane] }
    }

    /// An edge as [`Edge::downward`](super::edge::Edge::downward) gives it.
    #[inline(always)]
    fn downward(&self, lane: usize, top: i32) -> (i32, i32, i32, i32, i32) {
        let y = self.start_y[lane] + top;
        (self.start_x[lane], y, self.end_x[lane], y + self.height[lane], self.winding[lane])
    }
}

/// x and y of the points.
#[inline(always)]
fn coordinates<S: Simd>(simd: S, points: &[FixedPoint; LANES]) -> (i32x16<S>, i32x16<S>) {
    let [low, high]: [[i32; LANES]; 2] = bytemuck::cast(*points);
    i32x16::load_array(simd, low).deinterleave(i32x16::load_array(simd, high))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::level::{SimdLevel, dispatch};
    use crate::raster::kernel::add_edge;

    #[test]
    fn edges_of_a_batch_add_what_each_of_them_does() {
        let mut seed = 3_u32;
        let mut random = |n: i32| {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (seed >> 8) as i32 % n
        };
        const STRIPS: usize = 3;
        for case in 0..200 {
            // Small steps make edges within a strip, large ones those that cross strips or are flat; some are level, and
            // some lie above or below the band.
            let step = [200, 900, 9000][case % 3];
            let mut at = FixedPoint { x: 20 * 256, y: 12 * 256 };
            let points: Vec<FixedPoint> = (0..70)
                .map(|_| {
                    at.x = (at.x + random(2 * step) - step).clamp(0, 40 * 256 - 1);
                    at.y = (at.y + (random(2 * step) - step) * i32::from(random(5) > 0)).clamp(-3000, 9000);
                    at
                })
                .collect();
            let starts: Vec<u32> = (0..69).filter(|_| case % 2 == 0 || random(4) > 0).collect();
            let edges = Edges::of(&points, &starts);
            let reaches: Vec<Reach> = match case % 4 {
                0 => Vec::new(),
                1 => vec![Reach::columns(10, 25), Reach::NOTHING, Reach::columns(0, 16)],
                _ => vec![Reach::columns(0, 40); 2],
            };
            let mut expected = Accumulator::default();
            expected.resize(40, STRIPS);
            dispatch!(SimdLevel::Scalar, simd => edges.for_each(
                |edge| add_edge(simd, &mut expected, edge, 256, STRIPS, &reaches)));
            for level in SimdLevel::available() {
                let mut cells = Accumulator::default();
                cells.resize(40, STRIPS);
                dispatch!(level, simd => add_edges(simd, &mut cells, edges, 256, STRIPS, &reaches));
                for strip in 0..STRIPS {
                    let (got, want) = (cells.strip(strip).unwrap(), expected.strip(strip).unwrap());
                    assert_eq!(got.columns, want.columns, "case {case}, strip {strip} at {level:?}");
                    // Blocks between edges that are near each other may be marked as well.
                    let lacks = got.occupied.iter().zip(&*want.occupied).any(|(got, want)| want & !got != 0);
                    assert!(
                        !lacks,
                        "{:x?}, not {:x?}, case {case}, strip {strip} at {level:?}",
                        got.occupied, want.occupied
                    );
                }
            }
        }
    }
}
