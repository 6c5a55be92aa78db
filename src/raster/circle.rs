//! Aliased circles and discs around a pixel's centre.
//!
//! All of them take any `i32` centre and any `u32` radius and can be clipped to a rectangle at a cost
//! that depends on the visible part only. Pixels beyond the ends of `i32` are left out.

use std::iter::FusedIterator;
use std::ops::Range;

use super::line::PixelBox;
use crate::geom::IntRect;

/// The pixels of the circle around the pixel `center` with `radius` in pixels: the midpoint algorithm
/// with the integer start p₀ = 1 − r (Pitteway 1967, Van Aken 1984), each pixel once.
///
/// They come in order around the circle, clockwise on the canvas from the top, each a neighbour of
/// the one before it. The set has the eight symmetries of the square. Radius 0 is one pixel.
pub fn circle(center: (i32, i32), radius: u32) -> Circle {
    let mut circle =
        Circle { shape: Shape::new(center, radius), clip: Some(PixelBox::ALL), octant: 0, arc: Arc::default() };
    circle.arc = circle.start_octant(0);
    circle
}

/// The rows of the circle of [`circle`] filled up: spans `(y, x_start..x_end)` from the top down, one
/// a row.
pub fn filled_circle(center: (i32, i32), radius: u32) -> Disc {
    let shape = Shape::new(center, radius);
    let reach = shape.radius as i64;
    Disc::new(shape, Outline::Midpoint, -reach..=reach)
}

/// The pixels whose centres lie inside the ideal circle, F(x, y) = x² + y² − r² < 0 from the centre of
/// the pixel `center`: spans `(y, x_start..x_end)` from the top down, one a row.
///
/// Centres on the circle itself are outside, so that radius 0 has no pixel and radius 1 has one.
pub fn disc(center: (i32, i32), radius: u32) -> Disc {
    let shape = Shape::new(center, radius);
    let reach = shape.radius as i64 - 1;
    Disc::new(shape, Outline::Inside, -reach..=reach)
}

/// A circle as integers: what is known of it without walking along it.
#[derive(Clone, Copy, Debug)]
struct Shape {
    x: i64,
    y: i64,
    radius: u64,
    /// The last x of the octant from the top, 0 ≤ x ≤ y.
    diagonal: i64,
}

impl Shape {
    fn new(center: (i32, i32), radius: u32) -> Self {
        let r = u64::from(radius);
        // The last x with x² − x < r² − x², which is x ≤ y(x): (4x − 1)² ≤ 8·r² − 7.
        let diagonal = match (u128::from(r * r) * 8).checked_sub(7) {
            Some(c) => ((c.isqrt() + 1) / 4) as i64,
            None => 0,
        };
        Self { x: i64::from(center.0), y: i64::from(center.1), radius: r, diagonal }
    }

    /// The circle's y over `x`, 0 ≤ x ≤ r: √(r² − x²) to the nearest integer. There are no ties, since
    /// (y + ½)² is never an integer.
    fn height(&self, x: i64) -> i64 {
        let rest = self.radius * self.radius - x.unsigned_abs() * x.unsigned_abs();
        let root = rest.isqrt();
        (root + u64::from(rest - root * root > root)) as i64
    }

    /// The last x ≥ 0 of the octant with a height of `y` or more; −1 if there is none.
    fn last_reaching(&self, y: i64) -> i64 {
        if y <= 0 {
            return self.diagonal;
        }
        let y = y.unsigned_abs();
        if y > self.radius {
            return -1;
        }
        // y² − y < r² − x²
        match (self.radius * self.radius).checked_sub(y * (y - 1) + 1) {
            Some(rest) => (rest.isqrt() as i64).min(self.diagonal),
            None => -1,
        }
    }
}

/// The pixels of a circle, from [`circle`].
#[derive(Clone, Debug)]
pub struct Circle {
    shape: Shape,
    /// `None` where nothing is visible.
    clip: Option<PixelBox>,
    /// The octant under way, 0 ..= 7 clockwise from the top.
    octant: u8,
    arc: Arc,
}

impl Circle {
    /// The pixels still to come that lie in `clip`, at the cost of those.
    #[must_use]
    pub fn clipped(mut self, clip: IntRect) -> Self {
        self.clip = match (self.clip, PixelBox::new(clip)) {
            (Some(old), Some(new)) => old.intersect(new),
            _ => None,
        };
        let steps = self.visible_steps(self.octant);
        self.arc.narrow(&self.shape, steps);
        self
    }

    /// The x of an octant's own (0 ≤ x ≤ y) that the octant owns and the clip lets through: the first,
    /// and one past the last.
    fn visible_steps(&self, octant: u8) -> Range<i64> {
        let Some(clip) = self.clip else { return 0..0 };
        let shape = &self.shape;
        if shape.radius == 0 && octant > 0 {
            // The one pixel lies on every axis.
            return 0..0;
        }
        let (swapped, sign_x, sign_y) = ORIENTATION[usize::from(octant & 7)];
        // What the clip allows for sign·value from the centre.
        let allowed = |low: i64, high: i64, center: i64, sign: i64| {
            let (a, b) = ((low - center) * sign, (high - center) * sign);
            (a.min(b), a.max(b))
        };
        let across = allowed(clip.left, clip.right, shape.x, sign_x);
        let down = allowed(clip.top, clip.bottom, shape.y, sign_y);
        let (minor, major) = if swapped { (down, across) } else { (across, down) };
        // Pixels on an axis or a diagonal lie in two octants; the even one owns them.
        let odd = octant % 2 == 1;
        let shared = odd && shape.height(shape.diagonal) == shape.diagonal;
        let first = i64::from(odd).max(minor.0);
        let last = (shape.diagonal - i64::from(shared)).min(minor.1);
        // Heights fall along the octant: those of major.0 or more come first.
        let first = first.max(shape.last_reaching(major.1.saturating_add(1)) + 1);
        let last = last.min(shape.last_reaching(major.0));
        first..last.max(first - 1) + 1
    }

    fn start_octant(&self, octant: u8) -> Arc {
        Arc::new(&self.shape, self.visible_steps(octant), octant % 2 == 1)
    }
}

/// How the octants lie, clockwise from the top: whether x and y change places, and their signs.
const ORIENTATION: [(bool, i64, i64); 8] = [
    (false, 1, -1),
    (true, 1, -1),
    (true, 1, 1),
    (false, 1, 1),
    (false, -1, 1),
    (true, -1, 1),
    (true, -1, -1),
    (false, -1, -1),
];

impl Iterator for Circle {
    type Item = (i32, i32);

    #[inline]
    fn next(&mut self) -> Option<(i32, i32)> {
        loop {
            if let Some((x, y)) = self.arc.next() {
                let (swapped, sign_x, sign_y) = ORIENTATION[usize::from(self.octant & 7)];
                let (x, y) = if swapped { (y, x) } else { (x, y) };
                return Some(((self.shape.x + sign_x * x) as i32, (self.shape.y + sign_y * y) as i32));
            }
            if self.octant >= 7 {
                return None;
            }
            self.octant += 1;
            self.arc = self.start_octant(self.octant);
        }
    }
}

impl FusedIterator for Circle {}

/// A walk along the octant 0 ≤ x ≤ y, either way.
#[derive(Clone, Debug, Default)]
struct Arc {
    x: i64,
    y: i64,
    /// x² + y² − y − r²: negative, and not so for y + 1. The midpoint algorithm's p for the next pixel
    /// is this at x + 1.
    excess: i64,
    left: i64,
    backward: bool,
}

impl Arc {
    fn new(shape: &Shape, steps: Range<i64>, backward: bool) -> Self {
        if steps.is_empty() {
            return Self::default();
        }
        let x = if backward { steps.end - 1 } else { steps.start };
        let y = shape.height(x);
        let square = |v: i64| i128::from(v) * i128::from(v);
        let excess = square(x) + square(y) - i128::from(y) - square(shape.radius as i64);
        Self { x, y, excess: excess as i64, left: steps.end - steps.start, backward }
    }

    /// Keeps those pixels still to come whose x lies in `steps`.
    fn narrow(&mut self, shape: &Shape, steps: Range<i64>) {
        let own = if self.backward { self.x + 1 - self.left..self.x + 1 } else { self.x..self.x + self.left };
        *self = Self::new(shape, own.start.max(steps.start)..own.end.min(steps.end), self.backward);
    }

    #[inline]
    fn next(&mut self) -> Option<(i64, i64)> {
        if self.left <= 0 {
            return None;
        }
        self.left -= 1;
        let pixel = (self.x, self.y);
        if self.backward {
            self.excess -= 2 * self.x - 1;
            self.x -= 1;
            if self.excess + 2 * self.y < 0 {
                self.excess += 2 * self.y;
                self.y += 1;
            }
        } else {
            self.excess += 2 * self.x + 1;
            self.x += 1;
            if self.excess >= 0 {
                self.excess -= 2 * (self.y - 1);
                self.y -= 1;
            }
        }
        Some(pixel)
    }
}

#[derive(Clone, Copy, Debug)]
enum Outline {
    Midpoint,
    Inside,
}

/// The spans of a disc, from [`filled_circle`] and [`disc`].
#[derive(Clone, Debug)]
pub struct Disc {
    shape: Shape,
    outline: Outline,
    clip: PixelBox,
    /// The next row and one past the last, on the canvas.
    row: i64,
    end: i64,
}

impl Disc {
    fn new(shape: Shape, outline: Outline, rows: std::ops::RangeInclusive<i64>) -> Self {
        let all = IntRect::from_ltrb(i32::MIN, i32::MIN, i32::MAX, i32::MAX);
        let disc =
            Self { shape, outline, clip: PixelBox::ALL, row: shape.y + rows.start(), end: shape.y + rows.end() + 1 };
        // A span's end has to be a number, too: the last column and row of `i32` are left out.
        disc.clipped(all)
    }

    /// The spans still to come, cut to `clip`, at the cost of its rows.
    #[must_use]
    pub fn clipped(mut self, clip: IntRect) -> Self {
        match PixelBox::new(clip).and_then(|clip| self.clip.intersect(clip)) {
            Some(clip) => {
                self.clip = clip;
                self.row = self.row.max(clip.top);
                self.end = self.end.min(clip.bottom + 1);
            }
            None => self.end = self.row,
        }
        self
    }

    /// How far the row at `dy` from the centre reaches to either side.
    fn reach(&self, dy: i64) -> i64 {
        let squares = self.shape.radius * self.shape.radius;
        match self.outline {
            // Rows beside the centre end in the side octants, those beyond the diagonal in the upper
            // and lower ones.
            Outline::Midpoint if dy <= self.shape.diagonal => self.shape.height(dy),
            Outline::Midpoint => self.shape.last_reaching(dy),
            // x² ≤ r² − y² − 1
            Outline::Inside => squares.saturating_sub(dy.unsigned_abs() * dy.unsigned_abs() + 1).isqrt() as i64,
        }
    }
}

impl Iterator for Disc {
    type Item = (i32, Range<i32>);

    fn next(&mut self) -> Option<(i32, Range<i32>)> {
        while self.row < self.end {
            let row = self.row;
            self.row += 1;
            let reach = self.reach((row - self.shape.y).abs());
            let start = (self.shape.x - reach).max(self.clip.left);
            let end = (self.shape.x + reach).min(self.clip.right) + 1;
            if start < end {
                return Some((row as i32, start as i32..end as i32));
            }
        }
        None
    }
}

impl FusedIterator for Disc {}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    fn draw<const N: usize>(pixels: impl Iterator<Item = (i32, i32)>) -> [String; N] {
        let mut grid = [[b'.'; N]; N];
        for (x, y) in pixels {
            assert_eq!(grid[y as usize][x as usize], b'.', "({x}, {y}) twice");
            grid[y as usize][x as usize] = b'#';
        }
        grid.map(|row| String::from_utf8(row.to_vec()).unwrap())
    }

    fn pixels(spans: impl Iterator<Item = (i32, Range<i32>)>) -> impl Iterator<Item = (i32, i32)> {
        spans.flat_map(|(y, xs)| xs.map(move |x| (x, y)))
    }

    #[test]
    fn small_circles() {
        assert_eq!(draw(circle((1, 1), 0)), ["...", ".#.", "..."]);
        assert_eq!(draw(circle((1, 1), 1)), [".#.", "#.#", ".#."]);
        assert_eq!(
            draw(circle((4, 4), 4)),
            [
                "...###...",
                ".##...##.",
                ".#.....#.",
                "#.......#",
                "#.......#",
                "#.......#",
                ".#.....#.",
                ".##...##.",
                "...###...",
            ]
        );
        assert_eq!(draw(pixels(filled_circle((2, 2), 2))), [".###.", "#####", "#####", "#####", ".###."]);
        assert_eq!(draw(pixels(disc((2, 2), 2))), [".....", ".###.", ".###.", ".###.", "....."]);
        assert_eq!((disc((0, 0), 0).count(), disc((0, 0), 1).count()), (0, 1));
    }

    /// The textbook's loop: the first octant from (0, r), mirrored seven times.
    fn textbook(center: (i32, i32), radius: i32) -> BTreeSet<(i32, i32)> {
        let (mut x, mut y, mut p) = (0, radius, 1 - radius);
        let mut set = BTreeSet::new();
        while x <= y {
            for (a, b) in [(x, y), (y, x)] {
                for (a, b) in [(a, b), (-a, b), (a, -b), (-a, -b)] {
                    set.insert((center.0 + a, center.1 + b));
                }
            }
            x += 1;
            if p < 0 {
                p += 2 * x + 1;
            } else {
                y -= 1;
                p += 2 * (x - y) + 1;
            }
        }
        set
    }

    #[test]
    fn every_radius_equals_the_textbook_and_walks_round() {
        for radius in 0..300 {
            let walk: Vec<_> = circle((5, -3), radius as u32).collect();
            let set = textbook((5, -3), radius);
            assert_eq!(walk.len(), set.len(), "radius {radius}: a pixel twice or missing");
            assert_eq!(walk.iter().copied().collect::<BTreeSet<_>>(), set);
            assert_eq!(walk[0], (5, -3 - radius));
            for i in 0..walk.len() {
                let (a, b) = (walk[i], walk[(i + 1) % walk.len()]);
                assert!((a.0 - b.0).abs() <= 1 && (a.1 - b.1).abs() <= 1, "radius {radius}: {a:?} to {b:?}");
            }
        }
    }

    #[test]
    fn clipping_keeps_exactly_the_pixels_inside() {
        let inside = |clip: IntRect| {
            move |&(x, y): &(i32, i32)| (clip.left..clip.right).contains(&x) && (clip.top..clip.bottom).contains(&y)
        };
        for radius in 0..24 {
            for x in (-30..30).step_by(3) {
                for y in -30..30 {
                    let clip = IntRect::from_ltrb(x, y, x + 11, y + 7);
                    let whole = || circle((1, 2), radius);
                    assert!(whole().clipped(clip).eq(whole().filter(inside(clip))), "radius {radius} {clip:?}");
                    let (mut begun, mut rest) = (whole(), whole());
                    assert_eq!(begun.nth(9), rest.nth(9));
                    assert!(begun.clipped(clip).eq(rest.filter(inside(clip))));
                    for spans in [disc((1, 2), radius), filled_circle((1, 2), radius)] {
                        assert!(pixels(spans.clone().clipped(clip)).eq(pixels(spans).filter(inside(clip))));
                    }
                }
            }
        }
        assert_eq!(circle((0, 0), 5).clipped(IntRect::EMPTY).next(), None);
    }

    #[test]
    fn a_filled_circle_is_the_circle_and_what_it_encloses() {
        for radius in 0..60 {
            let mut rows = std::collections::BTreeMap::<i32, (i32, i32)>::new();
            for (x, y) in textbook((0, 0), radius) {
                let row = rows.entry(y).or_insert((x, x));
                *row = (row.0.min(x), row.1.max(x));
            }
            let expected = rows.into_iter().map(|(y, (a, b))| (y, a..b + 1));
            assert!(filled_circle((0, 0), radius as u32).eq(expected), "radius {radius}");
        }
    }

    #[test]
    fn the_largest_circles_are_clipped_at_once() {
        let radius = 1 << 30;
        // The top row ends where √(r² − x²) < r − ½, which is x² ≥ r: at column 2^15.
        let top = IntRect::from_ltrb(-40_000, -radius, 40_000, -radius + 1);
        let run: Vec<_> = circle((0, 0), radius as u32).clipped(top).map(|p| p.0).collect();
        assert_eq!((run.iter().min(), run.iter().max()), (Some(&-32_767), Some(&32_767)));
        assert_eq!(run.len(), 65_535);
        for &(dx, dy) in &[(0, 0), (760_000_000, 759_000_000), (-1_000_000_000, 380_000_000)] {
            let clip = IntRect::from_xywh(dx, dy, 500_000, 400_000);
            for (x, y) in circle((0, 0), radius as u32).clipped(clip).take(1000) {
                // Within half a pixel of the circle along the shorter axis, hence (d + ½)² bounds.
                let (major, minor) = (i128::from(x.abs().max(y.abs())), i128::from(x.abs().min(y.abs())));
                let rest = (1_i128 << 60) - minor * minor;
                assert!(major * (major - 1) < rest && rest <= major * (major + 1));
            }
        }
        let far = circle((i32::MAX, i32::MIN), u32::MAX).clipped(IntRect::from_ltrb(0, 0, 100, 100));
        assert!(far.count() <= 200);
        // Around a corner of `i32`, the largest circle passes through the opposite corner's sides.
        let (min, max) = (i32::MIN, i32::MAX);
        let corner = IntRect::from_ltrb(min, max - 3, min + 3, max);
        assert_eq!(
            circle((max, max), u32::MAX).clipped(corner).collect::<Vec<_>>(),
            [(min, max - 1), (min, max - 2), (min, max - 3)]
        );
        assert_eq!(disc((max, max), u32::MAX).clipped(corner).count(), 3);
        assert_eq!(filled_circle((i32::MAX, i32::MAX), 2).map(|(_, xs)| xs.len()).collect::<Vec<_>>(), [1, 2]);
    }
}
