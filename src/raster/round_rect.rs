//! Rectangles with equally rounded corners, ellipses and circles among them, into cells without edges.
//!
//! Each side of such a shape meets a row once: eight rows' parts are reckoned at once, from three roots each – where the
//! side enters the row, where it is in the row's middle, and where it leaves it. A part is taken to be straight and moved
//! outwards until its area is that under the arc (by Simpson's rule). At the top and at the bottom, where the outline
//! runs along a row, columns stand beneath an arc instead of rows beside it: their areas are sums of eight heights.
//!
//! All of it is a function of the shape and of the row or column alone: neither the band nor what is hidden matters.

use fearless_simd::prelude::*;
use fearless_simd::{f32x8, i32x8};

use super::cell::{Accumulator, Column, FULL, Strip};
use super::kernel::{Reach, RowParts, STRIP_SHIFT, add_to};
use crate::geom::{FixedRect, IntRect, Point, Rect};
use crate::num::fixed;
use crate::num::lanes::{RAISED, greater_f32, lesser_f32, max_i32, min_i32, round_raised_f32};
use crate::surface::block::BLOCK_HEIGHT;

/// Corners of smaller radii are flattened: their rows are neither steep nor flat.
const LEAST_RADIUS: f32 = 3.0;
/// Corners of larger radii are flattened: a cubic that stands for a quarter circle is up to 0.03 % of the radius outside of it, here less
/// than a flattened one is inside.
const GREATEST_RADIUS: f32 = 128.0;
/// So are those that are somewhere bent more than a circle of this radius: a row or column there would hold too much of a bend.
const LEAST_BEND: f32 = 2.0;
/// Shapes that reach further, in pixels, are flattened, and cut in `f64`.
const FARTHEST: f32 = 65_536.0;

/// A rectangle with equally rounded corners in device space: all in 1/256 pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct RoundRect {
    pub(crate) rect: FixedRect,
    radius_x: u16,
    radius_y: u16,
}

impl RoundRect {
    /// That of a finite rectangle and the radii of its corners, if they are of a size for it.
    pub(crate) fn new(rect: Rect, radii: Point) -> Option<Self> {
        let fits = |radius: f32| (LEAST_RADIUS..=GREATEST_RADIUS).contains(&radius);
        let is_near = [rect.left, rect.top, rect.right, rect.bottom].iter().all(|v| v.abs() < FARTHEST);
        let Point { x, y } = radii;
        // An ellipse's radii of curvature at the ends of its axes.
        let is_round = x * x >= LEAST_BEND * y && y * y >= LEAST_BEND * x;
        if !(fits(x) && fits(y) && is_round && is_near) {
            return None;
        }
        let rect = FixedRect::new(rect);
        // What rounding left of it.
        let radius = |radius: f32, size: i32| fixed::from_f32(radius).min(size / 2) as u16;
        let (radius_x, radius_y) = (radius(x, rect.right - rect.left), radius(y, rect.bottom - rect.top));
        Some(Self { rect, radius_x, radius_y })
    }

    /// How far into a corner a scanline within the shape is: 0 at its top and bottom, the radius in its middle.
    #[inline(always)]
    fn depth(&self, y: i32) -> i32 {
        (y - self.rect.top).min(self.rect.bottom - y).min(i32::from(self.radius_y))
    }

    /// What the sides' distance from the box is a function of.
    #[inline(always)]
    pub(crate) fn arc(&self) -> Arc {
        Arc::new(self.radius_x, self.radius_y)
    }

    /// From where to where, in 1/256 pixel, all scanlines between two of the shape are covered; `arc` is its own.
    #[inline(always)]
    pub(crate) fn inner(&self, arc: Arc, top: i32, bottom: i32) -> (i32, i32) {
        let inset = arc.inset(self.depth(top).min(self.depth(bottom)) as f32) as i32 + 1;
        (self.rect.left + inset, self.rect.right - inset)
    }
}

/// A quarter of an ellipse, seen along one of its axes.
#[derive(Clone, Copy)]
pub(crate) struct Arc {
    /// The radius across, and that along.
    across: f32,
    along: f32,
    /// The former by the latter.
    ratio: f32,
}

impl Arc {
    #[inline(always)]
    fn new(across: u16, along: u16) -> Self {
        let (across, along) = (f32::from(across), f32::from(along));
        Self { across, along, ratio: across / along }
    }

    /// How far from its box the arc is, so far from its tip.
    #[inline(always)]
    fn inset(self, depth: f32) -> f32 {
        // Not 1 − √(1 − t²): near the tip little would be left of it.
        self.across - self.ratio * (depth * (2.0 * self.along - depth)).sqrt()
    }

    /// As [`inset`](Self::inset), eight at once.
    #[inline(always)]
    fn insets<S: Simd>(self, simd: S, depth: f32x8<S>) -> f32x8<S> {
        let chord = (depth * (f32x8::splat(simd, 2.0 * self.along) - depth)).sqrt();
        f32x8::splat(simd, self.across) - chord * self.ratio
    }
}

/// Adds what of a shape lies within `clip` (device pixels, from the band's first column on) to the band whose top is at `top` (fixed point, a whole strip) and
/// which has `strips` strips. `reaches` says of each strip which columns matter; all of those of strips that it does not
/// have.
#[inline(always)]
pub(crate) fn add_round_rect<S: Simd>(
    simd: S,
    cells: &mut Accumulator,
    shape: &RoundRect,
    clip: IntRect,
    top: i32,
    strips: usize,
    reaches: &[Reach],
) {
    let from = shape.rect.top.max(clip.top << fixed::SHIFT);
    let to = shape.rect.bottom.min(clip.bottom << fixed::SHIFT);
    if from >= to {
        return;
    }
    let first = ((from - top) >> STRIP_SHIFT).max(0);
    let last = ((to - 1 - top) >> STRIP_SHIFT).min(strips as i32 - 1);
    for index in first..=last {
        let strip_top = top + (index << STRIP_SHIFT);
        let (mut low, mut high) = (clip.left.max(0), clip.right);
        if let Some(reach) = reaches.get(index as usize) {
            let (first, end) = reach.to_columns();
            (low, high) = (low.max(first), high.min(end));
        }
        let Some(mut strip) = cells.strip(index as usize) else { continue };
        let (from, to) = (from.max(strip_top), to.min(strip_top + (1 << STRIP_SHIFT)));
        if low < high {
            StripPart { shape, strip_top, from, to, low, high }.add(simd, &mut strip);
        }
    }
}

/// What is drawn of a shape in one strip: between two scanlines, in columns `low..high`.
struct StripPart<'a> {
    shape: &'a RoundRect,
    strip_top: i32,
    from: i32,
    to: i32,
    low: i32,
    high: i32,
}

impl StripPart<'_> {
    #[inline(always)]
    fn add<S: Simd>(&self, simd: S, strip: &mut Strip<'_>) {
        let FixedRect { top, bottom, .. } = self.shape.rect;
        // Rows less than one deep, and the one in which that ends, go by columns.
        let upper_end = (top + 2 * fixed::ONE - 1) >> fixed::SHIFT << fixed::SHIFT;
        let lower_start = (bottom - fixed::ONE) >> fixed::SHIFT << fixed::SHIFT;
        let (from, to) = (self.from.max(upper_end), self.to.min(lower_start));
        if from < to {
            self.add_sides(simd, strip, from, to);
        }
        if self.from < upper_end {
            self.add_cap(simd, strip, (self.from, self.to.min(upper_end)), |y| y - top);
        }
        if self.to > lower_start {
            self.add_cap(simd, strip, (self.from.max(lower_start), self.to), |y| bottom - y);
        }
    }

    /// Adds both sides between two scanlines.
    #[inline(always)]
    fn add_sides<S: Simd>(&self, simd: S, strip: &mut Strip<'_>, from: i32, to: i32) {
        let FixedRect { left, right, .. } = self.shape.rect;
        let arc = Arc::new(self.shape.radius_x, self.shape.radius_y);
        let (least, greatest) = (i32x8::splat(simd, from), i32x8::splat(simd, to));
        let rows = RowParts::tops(simd) + self.strip_top;
        let upper = min_i32(max_i32(rows, least), greatest);
        let lower = min_i32(max_i32(rows + fixed::ONE, least), greatest);
        let start = self.insets(simd, arc, upper);
        let end = self.insets(simd, arc, lower);
        let between = self.insets(simd, arc, (upper + lower) >> 1);
        // Simpson's rule: the mean of an arc is a third of its ends' mean and two thirds of its middle. Not beyond the box.
        let bulge = (between - (start + end) * 0.5) * (2.0 / 3.0);
        let zero = f32x8::splat(simd, 0.0);
        let (start, end) = (greater_f32(start + bulge, zero), greater_f32(end + bulge, zero));
        let (near, far) = (lesser_f32(start, end), greater_f32(start, end));
        let climb = (lower - upper).to_float::<f32x8<S>>();
        let width = far - near;
        let steep = width.simd_eq(zero).select(zero, climb / width);
        let (least, greatest) = (least_of(near), greatest_of(far));
        let side = Side { left: near, right: far, steep, beyond: climb + climb, total: (lower - upper) << 9 };
        self.add_side(simd, strip, left, (least, greatest), side);
        let side = Side { left: -far, right: -near, steep: -steep, beyond: side.beyond * -1.0, total: side.total * -1 };
        self.add_side(simd, strip, right, (-greatest, -least), side);
    }

    /// How far from the box the sides are at eight scanlines.
    #[inline(always)]
    fn insets<S: Simd>(&self, simd: S, arc: Arc, y: i32x8<S>) -> f32x8<S> {
        let FixedRect { top, bottom, .. } = self.shape.rect;
        let depth = min_i32(y - top, i32x8::splat(simd, bottom) - y);
        arc.insets(simd, min_i32(depth, i32x8::splat(simd, i32::from(self.shape.radius_y))).to_float::<f32x8<S>>())
    }

    /// Adds one of them, which lies between two x from `base` on.
    #[inline(always)]
    fn add_side<S: Simd>(
        &self,
        simd: S,
        strip: &mut Strip<'_>,
        base: i32,
        (least, greatest): (f32, f32),
        side: Side<S>,
    ) {
        let column_of = |x: f32| (base + x as i32 - i32::from(x < x as i32 as f32)) >> fixed::SHIFT;
        let (first, last) = (column_of(least), column_of(greatest));
        if first >= self.high || last < self.low {
            // Nothing of it is seen but that the row is covered between the two.
            let column = (if last < self.low { self.low } else { self.high }) as usize;
            strip.occupy(column, column);
            if let Some(column) = strip.columns.get_mut(column) {
                add_to(simd, column, side.total);
            }
            return;
        }
        let start = first.max(self.low);
        let end = (last + 1).min(self.high);
        strip.occupy(start as usize, end as usize);
        let Some(columns) = strip.columns.get_mut(start as usize..=end as usize) else { return };
        let Some((spill, columns)) = columns.split_last_mut() else { return };
        let zero = f32x8::splat(simd, 0.0);
        let raised = i32x8::splat(simd, RAISED);
        // From the box's side on, whatever matters, so that all is rounded alike. Whole numbers: they are exact.
        let mut at = f32x8::splat(simd, ((start << fixed::SHIFT) - base) as f32);
        // What lies left of the first column that matters.
        let mut before = if start > first { side.up_to(simd, at) } else { zero };
        let mut area = raised;
        for column in columns {
            at += fixed::ONE as f32;
            let up_to_here = side.up_to(simd, at);
            let here = round_raised_f32(up_to_here - before);
            add_to(simd, column, here - area);
            (before, area) = (up_to_here, here);
        }
        // What lies right of the last column that matters comes right after it, where the other side ends it.
        add_to(simd, spill, side.total + raised - area);
    }

    /// Adds the rows between two scanlines, two at most, by columns; `depth` is how far from the tip a scanline is.
    #[inline(always)]
    fn add_cap<S: Simd>(&self, simd: S, strip: &mut Strip<'_>, (from, to): (i32, i32), depth: impl Fn(i32) -> i32) {
        if from >= to {
            return;
        }
        let FixedRect { left, right, .. } = self.shape.rect;
        let (radius_x, radius_y) = (self.shape.radius_x, self.shape.radius_y);
        let row = (from - self.strip_top) >> fixed::SHIFT;
        let next = (self.strip_top + ((row + 1) << fixed::SHIFT)).min(to);
        let rows = [(from, next), (next, to)].map(|(upper, lower)| {
            let (a, b) = (depth(upper), depth(lower));
            (a.min(b), a.max(b))
        });
        let heights = rows.map(|(low, high)| high - low);
        let deepest = depth(from).max(depth(to));
        let inset = Arc::new(radius_x, radius_y).inset(deepest as f32) as i32;
        let column_of = |x: i32| x >> fixed::SHIFT;
        // Between the corners nothing changes.
        let (corner_end, corner_start) = (left + i32::from(radius_x), right - i32::from(radius_x));
        let (straight, straight_end) = (column_of(corner_end) + 1, column_of(corner_start));
        let mut column = column_of(left + inset).max(self.low);
        let end = (column_of(right - inset) + 1).min(self.high);
        if column >= end {
            return;
        }
        let arc = Arc::new(radius_y, radius_x);
        let row = row as usize & (BLOCK_HEIGHT - 1);
        let below = (row + 1) & (BLOCK_HEIGHT - 1);
        let mut before = [0; 2];
        let mut add = |strip: &mut Strip<'_>, column: i32, area: [i32; 2]| {
            if let Some(Column(cells)) = strip.columns.get_mut(column as usize) {
                cells[row] = cells[row].wrapping_add(area[0] - before[0]);
                cells[below] = cells[below].wrapping_add(area[1] - before[1]);
            }
            before = area;
        };
        while column < end {
            if column >= straight && column < straight_end {
                strip.occupy(column as usize, column as usize);
                add(strip, column, heights.map(|height| height * (FULL >> fixed::SHIFT)));
                column = straight_end;
                continue;
            }
            let areas = eight_columns(simd, arc, (left, right), column, rows, heights);
            let count = (end - column).min(8);
            strip.occupy(column as usize, (column + count - 1) as usize);
            for (lane, column) in (column..column + count).enumerate() {
                add(strip, column, [areas[0][lane & 7], areas[1][lane & 7]]);
            }
            column += 8;
        }
        strip.occupy(end as usize, end as usize);
        add(strip, end, [0; 2]);
    }
}

/// So many heights of a column are added up.
const SAMPLES: i32 = 8;

/// The areas of eight columns in two rows; a row is from so deep to so deep, and so high.
#[inline(always)]
fn eight_columns<S: Simd>(
    simd: S,
    arc: Arc,
    (left, right): (i32, i32),
    column: i32,
    rows: [(i32, i32); 2],
    heights: [i32; 2],
) -> [[i32; 8]; 2] {
    const STEP: i32 = fixed::ONE / SAMPLES;
    let zero = f32x8::splat(simd, 0.0);
    let radius = f32x8::splat(simd, arc.along);
    // Columns are as wide as rows are high.
    let mut from_left = (RowParts::tops(simd) + ((column << fixed::SHIFT) + STEP / 2 - left)).to_float::<f32x8<S>>();
    let width = f32x8::splat(simd, (right - left) as f32);
    let [(_, a), (_, b)] = rows;
    let [c, d] = heights;
    let limits = [(splat(simd, a), splat(simd, c)), (splat(simd, b), splat(simd, d))];
    let mut sums = [zero; 2];
    for _ in 0..SAMPLES {
        let across = greater_f32(lesser_f32(lesser_f32(from_left, width - from_left), radius), zero);
        let depth = arc.insets(simd, across);
        for (sum, (high, height)) in sums.iter_mut().zip(limits) {
            *sum += greater_f32(lesser_f32(high - depth, height), zero);
        }
        from_left += STEP as f32;
    }
    let [a, b] = sums;
    [area(a), area(b)]
}

#[inline(always)]
fn splat<S: Simd>(simd: S, value: i32) -> f32x8<S> {
    f32x8::splat(simd, value as f32)
}

/// The areas of eight columns, of the sums of their heights.
#[inline(always)]
fn area<S: Simd>(sums: f32x8<S>) -> [i32; 8] {
    let raised: i32x8<S> = round_raised_f32(sums * (FULL / fixed::ONE / SAMPLES) as f32);
    (raised - RAISED).to_array()
}

/// A side's parts in eight rows; x in 1/256 pixel from the box's side.
#[derive(Clone, Copy)]
struct Side<S: Simd> {
    left: f32x8<S>,
    right: f32x8<S>,
    /// |dy / dx| times the winding; 0 where it is upright.
    steep: f32x8<S>,
    /// What each 1/256 pixel right of a part adds.
    beyond: f32x8<S>,
    /// What each pixel right of a part adds.
    total: i32x8<S>,
}

impl<S: Simd> Side<S> {
    /// What is covered left of `x`.
    #[inline(always)]
    fn up_to(&self, simd: S, x: f32x8<S>) -> f32x8<S> {
        let zero = f32x8::splat(simd, 0.0);
        let within = greater_f32(lesser_f32(x, self.right) - self.left, zero);
        self.steep * within * within + self.beyond * greater_f32(x - self.right, zero)
    }
}

/// The least of eight lanes.
#[inline(always)]
fn least_of<S: Simd>(lanes: f32x8<S>) -> f32 {
    let [a, b, c, d, e, f, g, h] = lanes.to_array();
    let least = |a: f32, b: f32| if a < b { a } else { b };
    least(least(least(a, b), least(c, d)), least(least(e, f), least(g, h)))
}

/// The greatest of eight lanes.
#[inline(always)]
fn greatest_of<S: Simd>(lanes: f32x8<S>) -> f32 {
    -least_of(lanes * -1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::level::{SimdLevel, dispatch};

    /// Columns and strips of the pictures.
    const WIDTH: usize = 288;
    const STRIPS: usize = 36;

    struct Random(u32);

    impl Random {
        fn within(&mut self, low: f32, high: f32) -> f32 {
            self.0 = self.0.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            low + (high - low) * (self.0 >> 8) as f32 / 16_777_216.0
        }

        /// A circle, an ellipse or a rounded rectangle within the picture.
        fn shape(&mut self, case: usize) -> RoundRect {
            loop {
                let rx = self.within(3.0, [6.0, 20.0, 128.0][case % 3]);
                let ry = if case.is_multiple_of(2) { rx } else { self.within(3.0, 60.0) };
                let straight = [0.0, 0.7, 40.0][case / 3 % 3];
                let (left, top) = (self.within(0.0, 20.0), self.within(0.0, 20.0));
                let (right, bottom) = (left + 2.0 * rx + straight, top + 2.0 * ry + straight);
                if right <= WIDTH as f32 && bottom <= (STRIPS * 8) as f32 {
                    let rect = Rect::from_ltrb(left, top, right, bottom);
                    if let Some(shape) = RoundRect::new(rect, Point::new(rx, ry)) {
                        return shape;
                    }
                }
            }
        }
    }

    fn everywhere() -> IntRect {
        IntRect::from_xywh(0, 0, WIDTH as u32, STRIPS as u32 * 8)
    }

    /// What a shape covers of each pixel, times [`FULL`].
    fn accumulate(level: SimdLevel, shape: &RoundRect, clip: IntRect, reaches: &[Reach]) -> Vec<Vec<i32>> {
        let mut cells = Accumulator::default();
        cells.resize(WIDTH, STRIPS);
        dispatch!(level, simd => add_round_rect(simd, &mut cells, shape, clip, 0, STRIPS, reaches));
        let mut rows = vec![vec![0; WIDTH]; STRIPS * 8];
        for index in 0..STRIPS {
            let strip = cells.strip(index).unwrap();
            for (column, values) in strip.columns.iter().enumerate() {
                let bit = strip.occupied[column / 16 / 64] >> (column / 16 % 64) & 1;
                assert!(bit == 1 || values.0 == [0; 8], "column {column} holds values but is not marked");
            }
            for lane in 0..8 {
                let mut sum = 0;
                for (value, column) in rows[index * 8 + lane].iter_mut().zip(strip.columns.iter()) {
                    sum += column.0[lane];
                    *value = sum;
                }
                let rest: i32 = strip.columns[WIDTH..].iter().map(|column| column.0[lane]).sum();
                assert_eq!(sum + rest, 0, "{shape:?} in {clip:?}: row {lane} of strip {index} is not closed");
            }
        }
        rows
    }

    /// The same, by 128 scanlines a row.
    fn oracle(shape: &RoundRect) -> Vec<Vec<f64>> {
        const SCANLINES: usize = 128;
        let pixels = |v: i32| f64::from(v) / 256.0;
        let FixedRect { left, top, right, bottom } = shape.rect;
        let (left, top, right, bottom) = (pixels(left), pixels(top), pixels(right), pixels(bottom));
        let (rx, ry) = (f64::from(shape.radius_x) / 256.0, f64::from(shape.radius_y) / 256.0);
        let mut rows = vec![vec![0.0; WIDTH]; STRIPS * 8];
        for scanline in 0..STRIPS * 8 * SCANLINES {
            let y = (scanline as f64 + 0.5) / SCANLINES as f64;
            if y < top || y > bottom {
                continue;
            }
            let t = 1.0 - (y - top).min(bottom - y).min(ry) / ry;
            let inset = rx * (1.0 - (1.0 - t * t).sqrt());
            let (from, to) = (left + inset, right - inset);
            for (column, value) in rows[scanline / SCANLINES].iter_mut().enumerate() {
                let column = column as f64;
                *value += (to.min(column + 1.0) - from.max(column)).max(0.0) / SCANLINES as f64;
            }
        }
        rows
    }

    #[test]
    fn areas_equal_the_integral_of_the_arcs_at_every_level() {
        let mut random = Random(7);
        let (mut sum, mut count, mut worst) = (0.0, 0, 0.0_f64);
        for case in 0..90 {
            let shape = random.shape(case);
            let found = accumulate(SimdLevel::Scalar, &shape, everywhere(), &[]);
            for level in SimdLevel::available() {
                assert_eq!(accumulate(level, &shape, everywhere(), &[]), found, "{shape:?} at {level:?}");
            }
            for (y, (row, expected)) in found.iter().zip(oracle(&shape)).enumerate() {
                for (x, (value, expected)) in row.iter().zip(expected).enumerate() {
                    let error = (f64::from(*value) / f64::from(FULL) - expected).abs();
                    assert!(error < 0.025, "{shape:?}: pixel ({x}, {y}) {value} {}", expected * f64::from(FULL));
                    worst = worst.max(error);
                    if expected > 0.0 && expected < 1.0 {
                        (sum, count) = (sum + error, count + 1);
                    }
                }
            }
        }
        println!("mean {:.3}, largest {:.2} of 255", sum / f64::from(count) * 255.0, worst * 255.0);
        assert!(sum / f64::from(count) < 0.0012, "mean error {}", sum / f64::from(count));
    }

    #[test]
    fn what_is_cut_off_or_hidden_changes_nothing_of_the_rest() {
        let mut random = Random(3);
        for case in 0..60 {
            let shape = random.shape(case);
            let whole = accumulate(SimdLevel::Scalar, &shape, everywhere(), &[]);
            let mut edge = |limit: f32| random.within(0.0, limit) as i32;
            let (a, b, c, d) = (edge(60.0), edge(200.0), edge(40.0), edge(100.0));
            let clip = IntRect::from_ltrb(a.min(b), c.min(d), a.max(b), c.max(d));
            for level in SimdLevel::available() {
                let cut = accumulate(level, &shape, clip, &[]);
                for (y, (row, expected)) in (0..).zip(cut.iter().zip(&whole)) {
                    for (x, (value, expected)) in (0..).zip(row.iter().zip(expected)) {
                        let inside = x >= clip.left && x < clip.right && y >= clip.top && y < clip.bottom;
                        let expected = if inside { *expected } else { 0 };
                        assert_eq!(*value, expected, "{shape:?} in {clip:?}: pixel ({x}, {y}) at {level:?}");
                    }
                }
                let reaches: Vec<Reach> = (0..STRIPS)
                    .map(|strip| match strip % 3 {
                        0 => Reach::NOTHING,
                        _ => Reach::columns(clip.left as usize, clip.right as usize),
                    })
                    .collect();
                let seen = accumulate(level, &shape, everywhere(), &reaches);
                for (y, (row, expected)) in seen.iter().zip(&whole).enumerate() {
                    if !(y / 8).is_multiple_of(3) {
                        let (from, to) = (clip.left as usize, clip.right as usize);
                        assert_eq!(row[from..to], expected[from..to], "{shape:?}: row {y} at {level:?}");
                    }
                }
            }
        }
    }

    #[test]
    fn what_is_said_to_be_covered_whole_is() {
        let mut random = Random(5);
        let mut found = 0;
        for case in 0..60 {
            let shape = random.shape(case);
            let covered = accumulate(SimdLevel::Scalar, &shape, everywhere(), &[]);
            for y in (0..STRIPS * 8).step_by(8) {
                let (top, bottom) = ((y as i32) << 8, (y as i32 + 8) << 8);
                if shape.rect.top > top || shape.rect.bottom < bottom {
                    continue;
                }
                let (from, to) = shape.inner(shape.arc(), top, bottom);
                for x in (from + 255) >> 8..to >> 8 {
                    found += 1;
                    for row in &covered[y..y + 8] {
                        let value = row[x as usize];
                        assert!((value - FULL).abs() < 16, "{shape:?}: column {x}, rows from {y}: {value}");
                    }
                }
            }
        }
        assert!(found > 3_000, "{found}");
    }

    #[test]
    fn sizes_for_which_it_is_not_made_are_left_to_others() {
        let rect = Rect::from_ltrb(0.0, 0.0, 300.0, 300.0);
        let new = |rx: f32, ry: f32| RoundRect::new(rect, Point::new(rx, ry)).is_some();
        assert!(new(3.0, 3.0) && new(128.0, 128.0) && new(128.0, 16.1) && new(10.0, 49.0));
        assert!(
            !new(2.9, 3.0)
                && !new(3.0, 2.9)
                && !new(128.1, 20.0)
                && !new(20.0, 128.1)
                && !new(3.0, 5.0)
                && !new(10.0, 4.0)
        );
        assert!(!new(f32::NAN, 3.0));
        let far = Rect::from_ltrb(0.0, 0.0, 70_000.0, 300.0);
        assert_eq!(RoundRect::new(far, Point::new(10.0, 10.0)), None);
    }
}
