//! Aliased polygon fills: a pixel is in where its centre is.
//!
//! The classical scanline algorithm at y + ½ with an active edge list, in whole numbers throughout.
//! Vertices are rounded once to 1/256 of a pixel; from there on every decision is exact, so that
//! polygons that share an edge share no pixel and leave none out.

use std::ops::Range;

use super::line::row_run;
use crate::geom::{IntRect, Point};
use crate::path::flatten::PolygonSink;
use crate::style::FillRule;

/// One pixel in the units of the vertices.
const ONE: i64 = 256;
/// From a pixel's corner to its centre.
const HALF: i64 = ONE / 2;
/// Real coordinates beyond ± this many pixels are cut off there.
const LIMIT: f64 = 1_073_741_824.0;

/// Fills one closed contour: calls `span(y, x_start..x_end)` for the pixels of `clip` whose centres lie
/// inside. See [`Polygon::fill`].
///
/// ```
/// use rastrum::{FillRule, IntRect, Point, raster::polygon};
///
/// let triangle = [(0.0, 0.0), (6.0, 0.0), (0.0, 3.0)].map(Point::from);
/// let mut spans = Vec::new();
/// polygon::fill(&triangle, FillRule::NonZero, IntRect::from_ltrb(0, 0, 10, 10), |y, xs| spans.push((y, xs)));
/// assert_eq!(spans, [(0, 0..5), (1, 0..3), (2, 0..1)]);
/// ```
pub fn fill(points: &[Point], rule: FillRule, clip: IntRect, span: impl FnMut(i32, Range<i32>)) {
    let mut polygon = Polygon::new();
    polygon.add(points);
    polygon.fill(rule, clip, span);
}

/// Fills the polygon whose corners are pixels together with its outline, as
/// [`outline`](super::line::outline) draws it: calls `span(y, x_start..x_end)` for the pixels of `clip` that
/// are of either, rows from the top down, columns from left to right, no pixel twice.
///
/// The interior is that of [`Polygon::add_pixels`]. There is no gap between it and the outline.
pub fn fill_with_outline(corners: &[(i32, i32)], rule: FillRule, clip: IntRect, mut span: impl FnMut(i32, Range<i32>)) {
    // Each piece of the outline by its first row, and its last.
    let next = corners.iter().cycle().skip(1);
    let mut pieces: Vec<_> = corners.iter().zip(next).map(|(a, b)| (a.1.min(b.1), a.1.max(b.1), *a, *b)).collect();
    pieces.sort_unstable();
    let mut pieces = pieces.into_iter().peekable();
    let mut polygon = Polygon::new();
    polygon.add_pixels(corners);

    let mut interior = polygon.rows(clip);
    let mut active = Vec::new();
    let mut runs: Vec<(i64, i64)> = Vec::new();
    let mut row = clip.top;
    while row < clip.bottom {
        if active.is_empty() {
            // Rows that touch the outline nowhere have no interior either.
            match pieces.peek() {
                Some(piece) => row = row.max(piece.0),
                None => return,
            }
            if row >= clip.bottom {
                return;
            }
        }
        while let Some(piece) = pieces.next_if(|piece| piece.0 <= row) {
            active.push(piece);
        }
        active.retain(|piece| piece.1 >= row);
        runs.clear();
        runs.extend(active.iter().filter_map(|&(_, _, a, b)| row_run(a, b, row)).map(|xs| (*xs.start(), xs.end() + 1)));
        interior.seek(row);
        interior.spans(rule, |start, end| runs.push((start, end)));
        runs.sort_unstable();
        let mut joiner = Joiner::new(clip, |xs| span(row, xs));
        for &(start, end) in &runs {
            joiner.add(start, end);
        }
        joiner.flush();
        row += 1;
    }
}

/// Joins runs that come in order of their starts where they overlap or touch, cuts them to the columns
/// of a clip and passes them on.
struct Joiner<F: FnMut(Range<i32>)> {
    left: i64,
    right: i64,
    pending: Option<(i64, i64)>,
    span: F,
}

impl<F: FnMut(Range<i32>)> Joiner<F> {
    fn new(clip: IntRect, span: F) -> Self {
        Self { left: i64::from(clip.left), right: i64::from(clip.right), pending: None, span }
    }

    #[inline]
    fn add(&mut self, start: i64, end: i64) {
        let (start, end) = (start.max(self.left), end.min(self.right));
        if start >= end {
            return;
        }
        match &mut self.pending {
            Some(run) if start <= run.1 => run.1 = run.1.max(end),
            _ => {
                self.flush();
                self.pending = Some((start, end));
            }
        }
    }

    /// To be called after the last run.
    fn flush(&mut self) {
        if let Some((start, end)) = self.pending.take() {
            (self.span)(start as i32..end as i32);
        }
    }
}

/// A polygon of any number of closed contours, ready to be filled; also the memory for the next one.
///
/// Points are rounded to the nearest 1/256 pixel. Coordinates may be as large as `f32` goes: what lies
/// more than 2^30 pixels from the origin is cut off there. A polygon with a coordinate that is not
/// finite has no pixel until [`clear`](Polygon::clear).
#[derive(Clone, Debug, Default)]
pub struct Polygon {
    edges: Vec<Edge>,
    active: Vec<Active>,
    not_finite: bool,
    /// The contour under construction: its first point and its last.
    start: Point,
    last: Point,
}

impl Polygon {
    /// A polygon without contours.
    pub fn new() -> Self {
        Self::default()
    }

    /// Takes all contours away and keeps the memory.
    pub fn clear(&mut self) {
        self.edges.clear();
        self.active.clear();
        self.not_finite = false;
    }

    /// Adds a closed contour; its last point is joined to its first. Pixel centres lie at .5.
    pub fn add(&mut self, points: &[Point]) {
        if let [first, rest @ ..] = points {
            self.begin(*first);
            for p in rest {
                self.line(*p);
            }
            self.end();
        }
    }

    /// Adds a closed contour through the centres of pixels.
    ///
    /// By the rule for centres on an edge, the rectangle of the corners (0, 0) and (3, 2) fills
    /// columns 0 to 2 and rows 0 and 1; [`fill_with_outline`] adds the rest of the outline.
    pub fn add_pixels(&mut self, points: &[(i32, i32)]) {
        let center = |&(x, y): &(i32, i32)| (i64::from(x) * ONE + HALF, i64::from(y) * ONE + HALF);
        for (a, b) in points.iter().zip(points.iter().cycle().skip(1)) {
            self.push(center(a), center(b));
        }
    }

    /// Calls `span(y, x_start..x_end)` for the pixels of `clip` whose centres lie inside by `rule`: rows
    /// from the top down, columns from left to right, spans neither overlap nor touch.
    ///
    /// A centre exactly on an edge belongs to the side to the right of the edge, or below it if it is
    /// level. Open ends are joined; fewer than three points have no pixel.
    pub fn fill(&mut self, rule: FillRule, clip: IntRect, mut span: impl FnMut(i32, Range<i32>)) {
        let mut rows = self.rows(clip);
        while let Some(row) = rows.next_row() {
            rows.fill_row(rule, |xs| span(row, xs));
        }
    }

    /// The rows of the polygon in `clip`.
    fn rows(&mut self, clip: IntRect) -> Rows<'_> {
        self.edges.sort_unstable_by_key(|edge| edge.first_row);
        self.active.clear();
        let edges = if self.not_finite || clip.is_empty() { &[][..] } else { &self.edges };
        Rows { edges, active: &mut self.active, clip, row: None }
    }

    /// Adds the edge between two points in 1/256 pixels.
    fn push(&mut self, from: (i64, i64), to: (i64, i64)) {
        let (upper, lower, winding) = if from.1 <= to.1 { (from, to, 1) } else { (to, from, -1) };
        // The centre of row r lies at 256·r + 128; it belongs to the edge from the upper end on.
        let row_from = |y: i64| (y - HALF + ONE - 1).div_euclid(ONE);
        let (first_row, end_row) = (row_from(upper.1), row_from(lower.1));
        if first_row < end_row {
            self.edges.push(Edge {
                x: upper.0,
                y: upper.1,
                dx: lower.0 - upper.0,
                dy: lower.1 - upper.1,
                first_row,
                end_row,
                winding,
            });
        }
    }

    /// Adds an edge between points some of whose coordinates lie beyond the limit: cuts off what is
    /// above and below it, and lets what is left and right of it run along it, as it counts as a
    /// crossing for all the pixels on its right.
    #[cold]
    fn push_far(&mut self, from: Point, to: Point) {
        let (mut a, mut b) = ((f64::from(from.x), f64::from(from.y)), (f64::from(to.x), f64::from(to.y)));
        if (a.1 <= -LIMIT && b.1 <= -LIMIT) || (a.1 >= LIMIT && b.1 >= LIMIT) {
            return;
        }
        // The line is x·dy − y·dx = c. Products of two `f32` are exact here, so that c is good to the
        // last bit however far the ends are, and the way back gives the same numbers.
        let (dx, dy) = (b.0 - a.0, b.1 - a.1);
        let c = a.0 * b.1 - a.1 * b.0;
        // One end at least is inside, or they lie on both sides, so that dy is not 0 where it divides.
        for end in [&mut a, &mut b] {
            if end.1.abs() > LIMIT {
                let y = LIMIT.copysign(end.1);
                *end = ((c + y * dx) / dy, y);
            }
        }
        let mut corners = [a; 4];
        let mut count = 1;
        let sides = if a.0 <= b.0 { [-LIMIT, LIMIT] } else { [LIMIT, -LIMIT] };
        for side in sides {
            if (a.0 < side) != (b.0 < side) {
                let (low, high) = if a.1 <= b.1 { (a.1, b.1) } else { (b.1, a.1) };
                corners[count] = (side, ((side * dy - c) / dx).clamp(low, high));
                count += 1;
            }
        }
        corners[count] = b;
        let corners = corners.map(|(x, y)| (to_fixed(x.clamp(-LIMIT, LIMIT)), to_fixed(y)));
        for pair in corners[..=count].windows(2) {
            self.push(pair[0], pair[1]);
        }
    }
}

impl PolygonSink for Polygon {
    fn begin(&mut self, p: Point) {
        (self.start, self.last) = (p, p);
        self.not_finite |= !p.is_finite();
    }

    fn line(&mut self, p: Point) {
        let from = std::mem::replace(&mut self.last, p);
        let near = |v: f32| f64::from(v).abs() <= LIMIT;
        if near(p.x) && near(p.y) && near(from.x) && near(from.y) {
            let fixed = |p: Point| (to_fixed(f64::from(p.x)), to_fixed(f64::from(p.y)));
            self.push(fixed(from), fixed(p));
        } else if p.is_finite() && from.is_finite() {
            self.push_far(from, p);
        } else {
            self.not_finite = true;
        }
    }

    fn end(&mut self) {
        self.line(self.start);
    }
}

/// To the nearest 1/256, halves up. `v` is within the limit.
fn to_fixed(v: f64) -> i64 {
    (v * ONE as f64 + 0.5).floor() as i64
}

/// An edge from its upper end, in 1/256 pixels.
#[derive(Clone, Copy, Debug)]
struct Edge {
    x: i64,
    y: i64,
    dx: i64,
    dy: i64,
    /// The rows whose centres it crosses: the first, and one past the last.
    first_row: i64,
    end_row: i64,
    /// +1 downwards, −1 upwards.
    winding: i32,
}

impl Edge {
    /// The edge as it crosses the centre of `row`, which is one of its own.
    fn enter(&self, row: i64) -> Active {
        // The first column whose centre 256·c + 128 is at or right of x + (centre − y)·dx/dy, hence
        // c = ceil((x·dy + (centre − y)·dx − 128·dy) / (256·dy)).
        let dy = i128::from(self.dy);
        let down = i128::from(row * ONE + HALF - self.y);
        let numerator = i128::from(self.x - HALF) * dy + down * i128::from(self.dx);
        let whole = i128::from(ONE) * dy;
        let numerator = numerator + whole - 1;
        Active {
            column: numerator.div_euclid(whole) as i64,
            rest: numerator.rem_euclid(whole) as i64,
            // A row further the numerator grows by 256·dx.
            step: self.dx.div_euclid(self.dy),
            rest_step: self.dx.rem_euclid(self.dy) * ONE,
            whole: whole as i64,
            end_row: self.end_row,
            winding: self.winding,
        }
    }
}

/// An edge under the scanline: the first column to its right, with the remainder of the division.
#[derive(Clone, Copy, Debug)]
struct Active {
    column: i64,
    rest: i64,
    step: i64,
    rest_step: i64,
    whole: i64,
    end_row: i64,
    winding: i32,
}

impl Active {
    #[inline]
    fn advance(&mut self) {
        self.column += self.step;
        self.rest += self.rest_step;
        if self.rest >= self.whole {
            self.rest -= self.whole;
            self.column += 1;
        }
    }
}

/// The scanline on its way down.
struct Rows<'a> {
    /// Those not reached yet, by their first row.
    edges: &'a [Edge],
    active: &'a mut Vec<Active>,
    clip: IntRect,
    /// The row of `active`.
    row: Option<i32>,
}

impl Rows<'_> {
    /// Goes to the next row of the clip that any edge crosses.
    fn next_row(&mut self) -> Option<i32> {
        let mut row = self.row.map_or(self.clip.top, |row| row + 1);
        loop {
            if row >= self.clip.bottom {
                return None;
            }
            self.seek(row);
            if !self.active.is_empty() {
                return Some(row);
            }
            let next = self.edges.first()?.first_row;
            row = i32::try_from(next).unwrap_or(i32::MAX);
        }
    }

    /// Goes to `row`, at or below the row before it.
    fn seek(&mut self, row: i32) {
        let target = i64::from(row);
        self.active.retain(|edge| edge.end_row > target);
        if !self.active.is_empty() {
            for _ in self.row.unwrap_or(row)..row {
                self.active.iter_mut().for_each(Active::advance);
            }
        }
        self.row = Some(row);
        while let [edge, rest @ ..] = self.edges
            && edge.first_row <= target
        {
            self.edges = rest;
            if edge.end_row > target {
                self.active.push(edge.enter(target));
            }
        }
        sort_by_column(self.active);
    }

    /// The runs of the current row, `start ≤ end`, in order.
    fn spans(&self, rule: FillRule, mut run: impl FnMut(i64, i64)) {
        let mut winding = 0_i32;
        let mut start = None;
        for edge in self.active.iter() {
            winding = match rule {
                FillRule::NonZero => winding.wrapping_add(edge.winding),
                FillRule::EvenOdd => winding ^ 1,
            };
            match start {
                None if winding != 0 => start = Some(edge.column),
                Some(from) if winding == 0 => {
                    run(from, edge.column);
                    start = None;
                }
                _ => {}
            }
        }
    }

    fn fill_row(&self, rule: FillRule, span: impl FnMut(Range<i32>)) {
        let mut joiner = Joiner::new(self.clip, span);
        self.spans(rule, |start, end| joiner.add(start, end));
        joiner.flush();
    }
}

/// Sorts edges that were in order a row before.
///
/// From one row to the next few edges pass one another: insertion sort finds the list almost done (8,000
/// random corners on 4,096 rows: 410 ms, against 640 with a general sort of every row). Where many edges
/// arrive at once it would be quadratic, so that it gives up after a few moves for each edge.
fn sort_by_column(edges: &mut [Active]) {
    let mut moves = 16 * edges.len();
    for i in 1..edges.len() {
        let mut j = i;
        while j > 0 && edges[j - 1].column > edges[j].column {
            edges.swap(j - 1, j);
            j -= 1;
            moves = moves.saturating_sub(1);
        }
        if moves == 0 {
            edges.sort_unstable_by_key(|edge| edge.column);
            return;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::line::outline;
    use super::*;

    const SIZE: usize = 9;
    const CLIP: IntRect = IntRect::from_ltrb(0, 0, SIZE as i32, SIZE as i32);

    fn points(list: &[(f32, f32)]) -> Vec<Point> {
        list.iter().map(|&p| p.into()).collect()
    }

    fn draw<const H: usize>(fill: impl FnOnce(&mut dyn FnMut(i32, Range<i32>))) -> [String; H] {
        let mut grid = [[b'.'; SIZE]; H];
        let mut last = (i32::MIN, 0);
        fill(&mut |y, xs| {
            assert!((y, xs.start) > last && !xs.is_empty(), "spans touch, overlap or are out of order");
            last = (y, xs.end);
            grid[y as usize][xs.start as usize..xs.end as usize].fill(b'#');
        });
        grid.map(|row| String::from_utf8(row.to_vec()).unwrap())
    }

    #[test]
    fn a_centre_on_an_edge_belongs_to_the_right_and_below() {
        let square = points(&[(1.5, 0.5), (4.5, 0.5), (4.5, 2.5), (1.5, 2.5)]);
        assert_eq!(draw(|span| fill(&square, FillRule::NonZero, CLIP, span)), [".###.....", ".###.....", "........."]);
        // Both diagonals of this diamond pass through centres: left in, right out, top in, bottom out.
        let diamond = points(&[(3.5, 0.5), (6.5, 3.5), (3.5, 6.5), (0.5, 3.5)]);
        assert_eq!(
            draw(|span| fill(&diamond, FillRule::EvenOdd, CLIP, span)),
            [
                ".........", //
                "..##.....",
                ".####....",
                "######...",
                ".####....",
                "..##.....",
                ".........",
            ]
        );
    }

    #[test]
    fn the_rules_differ_where_windings_add_up() {
        let mut two = Polygon::new();
        two.add(&points(&[(0.0, 0.0), (6.0, 0.0), (6.0, 3.0), (0.0, 3.0)]));
        two.add(&points(&[(2.0, 1.0), (8.0, 1.0), (8.0, 4.0), (2.0, 4.0)]));
        assert_eq!(
            draw(|span| two.fill(FillRule::NonZero, CLIP, span)),
            ["######...", "########.", "########.", "..######."]
        );
        assert_eq!(
            draw(|span| two.fill(FillRule::EvenOdd, CLIP, span)),
            ["######...", "##....##.", "##....##.", "..######."]
        );
        two.clear();
        assert_eq!(draw(|span| two.fill(FillRule::EvenOdd, CLIP, span)), ["........."]);
    }

    #[test]
    fn a_filled_outline_holds_both() {
        let corners = [(0, 0), (8, 2), (3, 6)];
        assert_eq!(
            draw(|span| fill_with_outline(&corners, FillRule::NonZero, CLIP, span)),
            [
                "###......", //
                "#######..",
                ".########",
                ".#######.",
                "..#####..",
                "..###....",
                "...#.....",
            ]
        );
        assert_eq!(
            draw(|span| fill_with_outline(&[(2, 1)], FillRule::NonZero, CLIP, span)),
            [".........", "..#......"]
        );
        let mut count = 0;
        fill_with_outline(&[(-9, -9), (i32::MAX, i32::MAX)], FillRule::NonZero, CLIP, |_, xs| count += xs.len());
        assert_eq!(count, outline(&[(-9, -9), (i32::MAX, i32::MAX)]).clipped(CLIP).count());
    }

    #[test]
    fn huge_polygons_keep_their_slopes() {
        // Half-planes through the origin's neighbourhood with corners 1e30 and more away.
        let big = 1e30_f32;
        let three_rows = IntRect::from_ltrb(0, 0, 9, 3);
        let below = points(&[(-big, -big), (big, big), (-big, big)]);
        // The diagonal passes through centres, which lie to its right: they are out.
        assert_eq!(
            draw(|span| fill(&below, FillRule::NonZero, three_rows, span)),
            [".........", "#........", "##......."]
        );
        // The edge x = 2·(y + 2): at y = ½ it is x = 5.
        let slope = points(&[(0.0, -2.0), (3e38, 1.5e38), (-3e38, 1.5e38), (-3e38, -2.0)]);
        assert_eq!(
            draw(|span| fill(&slope, FillRule::EvenOdd, three_rows, span)),
            ["#####....", "#######..", "#########"]
        );
        let all = points(&[(-3e38, -3e38), (3e38, -3e38), (3e38, 3e38), (-3e38, 3e38)]);
        assert_eq!(draw(|span| fill(&all, FillRule::NonZero, CLIP, span)), ["#########"; SIZE]);
        let mut pixels = Polygon::new();
        pixels.add_pixels(&[(i32::MIN, i32::MIN), (i32::MAX, i32::MIN), (i32::MAX, i32::MAX), (i32::MIN, i32::MAX)]);
        assert_eq!(draw(|span| pixels.fill(FillRule::NonZero, CLIP, span)), ["#########"; SIZE]);
    }

    #[test]
    fn a_shared_edge_of_any_size_is_cut_off_alike() {
        // By the even-odd rule a quadrilateral is what just one of its two triangles covers.
        let mut seed = 7_u64;
        let mut coordinate = || {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            // 2^−4 to 2^127, so that most corners lie beyond the limit.
            let exponent = 123 + (seed >> 40) as u32 % 131;
            f32::from_bits((seed >> 63 << 31) as u32 | exponent << 23 | (seed >> 33) as u32 & 0x7f_ffff)
        };
        let clip = IntRect::from_ltrb(-20, -20, 20, 20);
        let cover = |corners: &[Point]| {
            let mut rows = [0_u64; 40];
            fill(corners, FillRule::EvenOdd, clip, |y, xs| {
                xs.for_each(|x| rows[(y + 20) as usize] |= 1 << (x + 20));
            });
            rows
        };
        let mut partly = 0;
        for _ in 0..5000 {
            let [a, b, c, d] = [(); 4].map(|()| Point::new(coordinate(), coordinate()));
            let (first, second, both) = (cover(&[a, b, c]), cover(&[a, c, d]), cover(&[a, b, c, d]));
            for row in 0..40 {
                assert_eq!(first[row] ^ second[row], both[row], "{a:?} {b:?} {c:?} {d:?}");
            }
            let count: u32 = both.iter().map(|row| row.count_ones()).sum();
            partly += u32::from(count > 0 && count < 1600);
        }
        assert!(partly > 100, "only {partly} outlines pass through the clip");
    }

    #[test]
    fn what_is_not_finite_has_no_pixel() {
        for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
            for i in 0..3 {
                let mut corners = points(&[(0.0, 0.0), (8.0, 0.0), (0.0, 8.0)]);
                corners[i].y = bad;
                fill(&corners, FillRule::NonZero, CLIP, |_, _| panic!("corner {i} is {bad}"));
            }
            fill(&points(&[(bad, 0.0)]), FillRule::NonZero, CLIP, |_, _| panic!("one point"));
        }
        let corners = points(&[(0.0, 0.0), (8.0, 0.0), (0.0, 8.0)]);
        for clip in [IntRect::EMPTY, IntRect::from_ltrb(5, 5, 3, 9)] {
            fill(&corners, FillRule::NonZero, clip, |_, _| panic!("outside {clip:?}"));
        }
        for n in 0..3 {
            fill(&corners[..n], FillRule::EvenOdd, CLIP, |_, _| panic!("{n} corners"));
        }
    }

    #[test]
    fn many_edges_out_of_order_are_sorted() {
        // The teeth of a comb, from the right to the left and all starting in one row: more moves than
        // insertion sort may make.
        let mut comb = Vec::new();
        for i in (0..200).rev() {
            let x = i as f32 * 4.0;
            comb.extend([(x + 4.0, 4.0), (x + 2.0, 4.0), (x + 2.0, 0.0), (x, 0.0), (x, 4.0)]);
        }
        let wide = IntRect::from_ltrb(-5, 0, 5000, 1);
        let mut teeth = Vec::new();
        fill(&points(&comb), FillRule::NonZero, wide, |_, xs| teeth.push(xs));
        assert_eq!(teeth, (0..200).map(|i| i * 4..i * 4 + 2).collect::<Vec<_>>());
    }
}
