//! Aliased lines and outlines: every pixel an exact decision of integers.
//!
//! All of them take any `i32` coordinates and can be [clipped](Bresenham::clipped) to a rectangle at a
//! cost that depends on the visible part only: the pixels are the very ones of the whole line.

use std::iter::FusedIterator;
use std::ops::RangeInclusive;

use super::stair::Stair;
use crate::geom::IntRect;

/// The pixels of the line between two pixels, both ends included, in order from `from` to `to`
/// (Bresenham, *Algorithm for computer control of a digital plotter*, 1965).
///
/// One pixel a column where the line is at least as wide as high, one pixel a row otherwise; each is
/// the pixel nearest to the ideal line. The line is reckoned from its left end (or its upper one,
/// where it is higher than wide), and a tie keeps the row (column) in which it was, the E of the
/// midpoint algorithm: `d ≤ 0` chooses E. Since both directions are reckoned from the same end, the
/// line back consists of the same pixels.
pub fn bresenham(from: (i32, i32), to: (i32, i32)) -> Bresenham {
    let frame = Frame::new(from, to);
    Bresenham { frame, stair: frame.center_stair(0), step: 0, end: frame.run + 1 }
}

/// Every pixel that the segment between the centres of two pixels touches, both ends included, a
/// column after another (a row, where the line is higher than wide) from `from` to `to`.
///
/// Pixels are closed squares: a segment through the very corner of four pixels touches all four. The
/// order of the ends does not change the set. (Andres' *supercover*.)
pub fn supercover(from: (i32, i32), to: (i32, i32)) -> Band {
    let frame = Frame::new(from, to);
    // In a column the line spans from rise·(i − ½)/run to rise·(i + ½)/run; rounding the lower bound
    // up and the upper one down, each from the half, gives the squares touched. The limits 0 ..= rise
    // cut off the half column beyond each end.
    let (rise, run) = (i128::from(frame.rise), i128::from(frame.run.max(1)));
    let low = Stair::new(frame.rise, frame.run, run - rise - 1);
    let high = Stair::new(frame.rise, frame.run, run + rise);
    Band::new(frame, low, high, 0..=frame.rise)
}

/// The line of [`bresenham`], thickened along the pixel grid: every pixel grows to a run of `width`
/// pixels, upright where the line is at least as wide as high, level otherwise.
///
/// The run is centred; the spare pixel of an even width lies below (to the right). Measured across, a
/// line at 45° is thinner by √2 than a level one: the price of a run a column. Width 0 has no pixel;
/// pixels beyond the ends of `i32` are left out.
pub fn wide(from: (i32, i32), to: (i32, i32), width: u32) -> Band {
    let frame = Frame::new(from, to);
    let (less, more) = (i64::from(width.saturating_sub(1) / 2), i64::from(width / 2));
    let (before, after) = if frame.minor_sign > 0 { (less, more) } else { (more, less) };
    let mut band = Band::new(frame, frame.center_stair(-before), frame.center_stair(after), i64::MIN..=i64::MAX);
    if width == 0 {
        band.end = 0;
    }
    band
}

/// The pixels of the open polyline through `points`, each joint once.
///
/// A piece of no length adds nothing; a single point is one pixel. A polyline that ends where it
/// starts is an [`outline`]. Pixels in which two pieces meet elsewhere than at their joint come once
/// for each piece.
pub fn polyline(points: &[(i32, i32)]) -> Polyline<'_> {
    match points {
        [first, .., last] if first == last => outline(points),
        _ => Polyline::new(points, false),
    }
}

/// The pixels of the closed outline through `points`, each corner once, the start included.
///
/// The last point is joined to the first, whether or not it repeats it. Two points are one line, a
/// single point is one pixel.
pub fn outline(points: &[(i32, i32)]) -> Polyline<'_> {
    let mut points = points;
    while let [first, rest @ .., last] = points
        && first == last
    {
        points = points.get(..=rest.len()).unwrap_or_default();
    }
    Polyline::new(points, points.len() > 2)
}

/// How far along the line from `from` to `to` the pixel `at` lies: 0 at `from`, 1 at `to`, and for a
/// pixel beside the line that of its foot on it (not limited to 0 ..= 1). 0 for a line of no length.
///
/// The closed form v·(q − p₀)/L of the lecture, with exact products and one division, so that the
/// value of a pixel does not depend on those before it.
pub fn parameter(from: (i32, i32), to: (i32, i32), at: (i32, i32)) -> f32 {
    let difference = |a: i32, b: i32| i128::from(a) - i128::from(b);
    let (dx, dy) = (difference(to.0, from.0), difference(to.1, from.1));
    let along = dx * difference(at.0, from.0) + dy * difference(at.1, from.1);
    let length_squared = dx * dx + dy * dy;
    if length_squared == 0 { 0.0 } else { (along as f64 / length_squared as f64) as f32 }
}

/// The value at `t` on the way from `a` to `b`: exactly `a` at 0, exactly `b` at 1, and `a` at every
/// `t` if both are the same. Formed in `f64` and rounded once.
pub fn interpolate(a: f32, b: f32, t: f32) -> f32 {
    let t = f64::from(t);
    (f64::from(a) * (1.0 - t) + f64::from(b) * t) as f32
}

/// The columns of row `y` that the line of [`bresenham`] covers; `None` where it has no pixel there.
pub(super) fn row_run(from: (i32, i32), to: (i32, i32), y: i32) -> Option<RangeInclusive<i64>> {
    let frame = Frame::new(from, to);
    let mut stair = frame.center_stair(0);
    if frame.steep {
        let step = (i64::from(y) - frame.major) * frame.major_sign;
        if !(0..=frame.run).contains(&step) {
            return None;
        }
        stair.seek(step);
        let x = frame.minor + frame.minor_sign * stair.level;
        return Some(x..=x);
    }
    let level = (i64::from(y) - frame.minor) * frame.minor_sign;
    if !(0..=frame.rise).contains(&level) {
        return None;
    }
    let first = stair.first_reaching(level);
    let last = (stair.first_reaching(level + 1) - 1).min(frame.run);
    let (a, b) = (frame.major + frame.major_sign * first, frame.major + frame.major_sign * last);
    Some(a.min(b)..=a.max(b))
}

/// A line seen along its longer side: steps go along the major axis, levels along the minor one.
#[derive(Clone, Copy, Debug)]
struct Frame {
    /// Whether the major axis is y.
    steep: bool,
    /// Where the line starts on the major and on the minor axis.
    major: i64,
    minor: i64,
    /// +1 or −1: the line's way along each axis.
    major_sign: i64,
    minor_sign: i64,
    /// The line's extent along each axis, `0 ≤ rise ≤ run < 2^32`.
    run: i64,
    rise: i64,
}

impl Frame {
    fn new(from: (i32, i32), to: (i32, i32)) -> Self {
        let (x, y) = (i64::from(from.0), i64::from(from.1));
        let (dx, dy) = (i64::from(to.0) - x, i64::from(to.1) - y);
        let sign = |d: i64| if d < 0 { -1 } else { 1 };
        if dy.abs() > dx.abs() {
            let (major_sign, minor_sign) = (sign(dy), sign(dx));
            Self { steep: true, major: y, minor: x, major_sign, minor_sign, run: dy.abs(), rise: dx.abs() }
        } else {
            let (major_sign, minor_sign) = (sign(dx), sign(dy));
            Self { steep: false, major: x, minor: y, major_sign, minor_sign, run: dx.abs(), rise: dy.abs() }
        }
    }

    /// 1 where the line is walked against the direction from which it is reckoned: there a tie goes up.
    fn tie(&self) -> i64 {
        i64::from(self.major_sign < 0)
    }

    /// The stair through the nearest pixels, moved by `shift` levels.
    fn center_stair(&self, shift: i64) -> Stair {
        let run = self.run.max(1);
        // Nearest, a half down: ceil(v − ½) for v = rise·i/run; a half up: floor(v + ½).
        let offset = i128::from(run - 1 + self.tie()) + 2 * i128::from(run) * i128::from(shift);
        Stair::new(self.rise, self.run, offset)
    }

    /// The pixel at a step and a level that lie inside `i32`.
    #[inline]
    fn pixel(&self, step: i64, level: i64) -> (i32, i32) {
        let major = (self.major + self.major_sign * step) as i32;
        let minor = (self.minor + self.minor_sign * level) as i32;
        if self.steep { (minor, major) } else { (major, minor) }
    }

    /// The steps and the levels, both with their last, whose pixels lie inside `clip`, which is not empty.
    fn limits(&self, clip: PixelBox) -> (RangeInclusive<i64>, RangeInclusive<i64>) {
        let range = |low: i64, high: i64, start: i64, sign: i64| {
            let (a, b) = ((low - start) * sign, (high - start) * sign);
            a.min(b)..=a.max(b)
        };
        let x = (clip.left, clip.right);
        let y = (clip.top, clip.bottom);
        let ((major_low, major_high), (minor_low, minor_high)) = if self.steep { (y, x) } else { (x, y) };
        (
            range(major_low, major_high, self.major, self.major_sign),
            range(minor_low, minor_high, self.minor, self.minor_sign),
        )
    }
}

/// A rectangle by its first and last pixels, wide enough for all of `i32`.
#[derive(Clone, Copy, Debug)]
pub(super) struct PixelBox {
    pub(super) left: i64,
    pub(super) top: i64,
    pub(super) right: i64,
    pub(super) bottom: i64,
}

impl PixelBox {
    /// Every pixel with an `i32` address.
    pub(super) const ALL: Self =
        Self { left: i32::MIN as i64, top: i32::MIN as i64, right: i32::MAX as i64, bottom: i32::MAX as i64 };

    /// The pixels of `rect`; `None` if it has none.
    pub(super) fn new(rect: IntRect) -> Option<Self> {
        (!rect.is_empty()).then(|| Self {
            left: i64::from(rect.left),
            top: i64::from(rect.top),
            right: i64::from(rect.right) - 1,
            bottom: i64::from(rect.bottom) - 1,
        })
    }

    /// The pixels in both; `None` if there are none.
    pub(super) fn intersect(self, other: Self) -> Option<Self> {
        let both = Self {
            left: self.left.max(other.left),
            top: self.top.max(other.top),
            right: self.right.min(other.right),
            bottom: self.bottom.min(other.bottom),
        };
        (both.left <= both.right && both.top <= both.bottom).then_some(both)
    }
}

/// The pixels of a line, from [`bresenham`].
#[derive(Clone, Debug)]
pub struct Bresenham {
    frame: Frame,
    stair: Stair,
    step: i64,
    /// One past the last step.
    end: i64,
}

impl Bresenham {
    /// The pixels still to come that lie in `clip`. Costs the same for a line of any length.
    #[must_use]
    pub fn clipped(mut self, clip: IntRect) -> Self {
        let Some(clip) = PixelBox::new(clip) else {
            self.end = self.step;
            return self;
        };
        let (steps, levels) = self.frame.limits(clip);
        let first = self.stair.first_reaching(*levels.start()).max(*steps.start());
        let end = self.stair.first_reaching(levels.end() + 1).min(steps.end() + 1);
        self.limit(first, end);
        self
    }

    /// The decision value d at the pixel that comes next: positive where the step after that pixel
    /// goes diagonally, at most 0 where it goes straight (E). With a = the line's minor extent and b =
    /// its major one it starts at 2a − b, and is twice the implicit function F = a·Δmajor − b·Δminor
    /// at the midpoint between the two candidates.
    ///
    /// On a line walked leftwards (or upwards, if steep) a tie goes the other way, since there the line
    /// is reckoned from its far end; then d = 0 goes diagonally.
    pub fn decision(&self) -> i64 {
        self.stair.decision() - self.frame.tie()
    }

    /// Keeps the steps from `first` up to `end` of those still to come.
    fn limit(&mut self, first: i64, end: i64) {
        self.end = self.end.min(end);
        if first > self.step {
            self.seek(first.min(self.end));
        }
    }

    fn seek(&mut self, step: i64) {
        // Where nothing is left the stair does not matter, and may not be entered.
        self.step = step;
        if step < self.end {
            self.stair.seek(step);
        }
    }
}

impl Iterator for Bresenham {
    type Item = (i32, i32);

    #[inline]
    fn next(&mut self) -> Option<(i32, i32)> {
        if self.step >= self.end {
            return None;
        }
        let pixel = self.frame.pixel(self.step, self.stair.level);
        self.step += 1;
        self.stair.advance();
        Some(pixel)
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        let left = self.end.saturating_sub(self.step).max(0);
        (usize::try_from(left).unwrap_or(usize::MAX), usize::try_from(left).ok())
    }

    fn nth(&mut self, n: usize) -> Option<(i32, i32)> {
        let n = i64::try_from(n).unwrap_or(i64::MAX);
        self.seek(self.step.saturating_add(n).min(self.end).max(self.step));
        self.next()
    }
}

impl FusedIterator for Bresenham {}

/// The pixels of a line that can be more than one pixel thick, from [`supercover`] and [`wide`]:
/// column by column (row by row, where the line is steep), no pixel twice.
#[derive(Clone, Debug)]
pub struct Band {
    frame: Frame,
    /// The first level of the current step's run, and the last.
    low: Stair,
    high: Stair,
    step: i64,
    end: i64,
    /// The levels allowed at every step.
    floor: i64,
    ceiling: i64,
    /// What is left of the current run.
    level: i64,
    last_level: i64,
}

impl Band {
    fn new(frame: Frame, low: Stair, high: Stair, levels: RangeInclusive<i64>) -> Self {
        let (floor, ceiling) = (*levels.start(), *levels.end());
        let end = frame.run + 1;
        let mut band = Self { frame, low, high, step: 0, end, floor, ceiling, level: 0, last_level: -1 };
        band.start_run();
        band.restrict(PixelBox::ALL)
    }

    /// The pixels still to come that lie in `clip`, at the cost of those.
    #[must_use]
    pub fn clipped(mut self, clip: IntRect) -> Self {
        match PixelBox::new(clip) {
            Some(clip) => self.restrict(clip),
            None => {
                self.end = self.step;
                self
            }
        }
    }

    fn restrict(mut self, clip: PixelBox) -> Self {
        let (steps, levels) = self.frame.limits(clip);
        self.floor = self.floor.max(*levels.start());
        self.ceiling = self.ceiling.min(*levels.end());
        let first = self.high.first_reaching(self.floor).max(*steps.start());
        let end = self.low.first_reaching(self.ceiling.saturating_add(1)).min(steps.end() + 1);
        self.end = if self.floor <= self.ceiling { self.end.min(end) } else { self.step };
        if first > self.step {
            self.step = first.min(self.end);
            if self.step < self.end {
                self.low.seek(self.step);
                self.high.seek(self.step);
                self.start_run();
            }
        } else {
            // The run under way keeps its place.
            self.level = self.level.max(self.floor);
            self.last_level = self.last_level.min(self.ceiling);
        }
        self
    }

    fn start_run(&mut self) {
        self.level = self.low.level.max(self.floor);
        self.last_level = self.high.level.min(self.ceiling);
    }
}

impl Iterator for Band {
    type Item = (i32, i32);

    #[inline]
    fn next(&mut self) -> Option<(i32, i32)> {
        while self.step < self.end {
            if self.level <= self.last_level {
                let pixel = self.frame.pixel(self.step, self.level);
                self.level += 1;
                return Some(pixel);
            }
            self.step += 1;
            self.low.advance();
            self.high.advance();
            self.start_run();
        }
        None
    }
}

impl FusedIterator for Band {}

/// The pixels of a chain of lines, from [`polyline`] and [`outline`].
#[derive(Clone, Debug)]
pub struct Polyline<'a> {
    points: &'a [(i32, i32)],
    closed: bool,
    clip: Option<IntRect>,
    /// The piece after the current one, by the index of its first point.
    next_piece: usize,
    piece: Bresenham,
}

impl<'a> Polyline<'a> {
    fn new(points: &'a [(i32, i32)], closed: bool) -> Self {
        // The chain's first pixel is a piece of its own; every piece after it leaves its first one out.
        let first = points.first().copied();
        let mut piece = bresenham(first.unwrap_or_default(), first.unwrap_or_default());
        if first.is_none() {
            piece.end = 0;
        }
        Self { points, closed, clip: None, next_piece: 0, piece }
    }

    /// The pixels still to come that lie in `clip`. A piece outside it costs no more than finding that out.
    #[must_use]
    pub fn clipped(mut self, clip: IntRect) -> Self {
        self.clip = Some(self.clip.map_or(clip, |old| old.intersect(clip)));
        self.piece = self.piece.clipped(clip);
        self
    }
}

impl Iterator for Polyline<'_> {
    type Item = (i32, i32);

    #[inline]
    fn next(&mut self) -> Option<(i32, i32)> {
        loop {
            if let Some(pixel) = self.piece.next() {
                return Some(pixel);
            }
            let from = *self.points.get(self.next_piece)?;
            let closing = self.next_piece + 1 == self.points.len();
            let to = match self.points.get(self.next_piece + 1) {
                Some(to) => *to,
                None if self.closed => *self.points.first()?,
                None => return None,
            };
            self.next_piece += 1;
            let mut piece = bresenham(from, to);
            let end = piece.end - i64::from(closing);
            piece.limit(1, end);
            self.piece = self.clip.map_or(piece.clone(), |clip| piece.clipped(clip));
        }
    }
}

impl FusedIterator for Polyline<'_> {}

#[cfg(test)]
mod tests {
    use super::*;

    const W: usize = 9;

    /// Draws pixels as text; a digit is the number of times a pixel came, if more than once.
    fn draw<const H: usize>(pixels: impl Iterator<Item = (i32, i32)>) -> [String; H] {
        let mut counts = [[0_u8; W]; H];
        for (x, y) in pixels {
            counts[y as usize][x as usize] += 1;
        }
        counts.map(|row| {
            row.map(|n| match n {
                0 => '.',
                1 => '#',
                n => char::from(b'0' + n),
            })
            .iter()
            .collect()
        })
    }

    fn sorted(pixels: impl Iterator<Item = (i32, i32)>) -> Vec<(i32, i32)> {
        let mut pixels: Vec<_> = pixels.collect();
        pixels.sort_unstable();
        pixels
    }

    #[test]
    fn a_tie_stays_in_the_row_of_the_left_end() {
        // Slope 1/2: every second column is a tie.
        assert_eq!(
            draw(bresenham((0, 0), (8, 4))),
            [
                "##.......", //
                "..##.....",
                "....##...",
                "......##.",
                "........#",
            ]
        );
        assert_eq!(
            draw(bresenham((8, 0), (0, 4))),
            [
                "........#", //
                "......##.",
                "....##...",
                "..##.....",
                "##.......",
            ]
        );
    }

    #[test]
    fn supercover_of_a_diagonal_holds_the_pixels_at_its_corners() {
        assert_eq!(
            draw(supercover((1, 1), (3, 3))),
            [
                ".........",
                ".##......", //
                ".###.....",
                "..##.....",
                ".........",
            ]
        );
        assert_eq!(
            draw(supercover((0, 0), (8, 2))),
            [
                "###......",
                "..#####..", //
                "......###",
            ]
        );
    }

    #[test]
    fn supercover_equals_the_squares_that_meet_the_segment() {
        // A segment meets a closed square unless an axis or its own normal separates them.
        let meets = |(x0, y0): (i32, i32), (x1, y1): (i32, i32), (x, y): (i32, i32)| {
            let (dx, dy) = (x1 - x0, y1 - y0);
            let distance = 2 * (dx * (y - y0) - dy * (x - x0));
            x >= x0.min(x1)
                && x <= x0.max(x1)
                && y >= y0.min(y1)
                && y <= y0.max(y1)
                && distance.abs() <= dx.abs() + dy.abs()
        };
        for x in -9..=9 {
            for y in -9..=9 {
                let expected = (-10..=10)
                    .flat_map(|x| (-10..=10).map(move |y| (x, y)))
                    .filter(|&pixel| meets((0, 0), (x, y), pixel));
                assert_eq!(sorted(supercover((0, 0), (x, y))), sorted(expected), "to ({x}, {y})");
            }
        }
    }

    #[test]
    fn clipping_keeps_exactly_the_pixels_inside() {
        let clip = IntRect::from_ltrb(-3, -2, 4, 5);
        let inside = |&(x, y): &(i32, i32)| (-3..4).contains(&x) && (-2..5).contains(&y);
        for x0 in (-8..=8).step_by(2) {
            for y0 in -8..=8 {
                for x1 in -8..=8 {
                    for y1 in (-8..=8).step_by(3) {
                        let (a, b) = ((x0, y0), (x1, y1));
                        assert!(bresenham(a, b).clipped(clip).eq(bresenham(a, b).filter(inside)));
                        assert!(supercover(a, b).clipped(clip).eq(supercover(a, b).filter(inside)));
                        assert!(wide(a, b, 4).clipped(clip).eq(wide(a, b, 4).filter(inside)));
                        // A line already under way, too.
                        let (mut begun, mut whole) = (bresenham(a, b), bresenham(a, b));
                        assert_eq!((begun.nth(2), begun.clipped(clip).count()), {
                            let third = whole.nth(2);
                            (third, whole.filter(inside).count())
                        });
                        let (mut begun, mut whole) = (wide(a, b, 3), wide(a, b, 3));
                        assert_eq!(begun.nth(3), whole.nth(3));
                        assert!(begun.clipped(clip).eq(whole.filter(inside)));
                    }
                }
            }
        }
        assert_eq!(bresenham((0, 0), (5, 5)).clipped(IntRect::EMPTY).next(), None);
        assert_eq!(supercover((0, 0), (5, 5)).clipped(IntRect::EMPTY).next(), None);
    }

    #[test]
    fn the_longest_lines_are_clipped_at_once() {
        let (min, max) = (i32::MIN, i32::MAX);
        let clip = IntRect::from_ltrb(0, 0, 100, 100);
        // From (min, min) to (max, max) every pixel has x = y.
        let diagonal: Vec<_> = bresenham((min, min), (max, max)).clipped(clip).collect();
        assert_eq!(diagonal, (0..100).map(|i| (i, i)).collect::<Vec<_>>());
        assert_eq!(wide((max, max), (min, min), 3).clipped(clip).count(), 298);
        assert_eq!(supercover((max, max), (min, min)).clipped(clip).count(), 298);
        // 2^32 − 1 columns, one row up: the step lies in the middle, between columns −1 and 0.
        let row: Vec<_> = bresenham((min, 7), (max, 8)).clipped(IntRect::from_ltrb(-2, 0, 2, 9)).collect();
        assert_eq!(row, [(-2, 7), (-1, 7), (0, 8), (1, 8)]);
        assert_eq!(bresenham((min, min), (max, max)).size_hint().0 as u64, 1 << 32);
        let end = IntRect::from_ltrb(max - 2, max - 2, max, max);
        assert_eq!(bresenham((min, min), (max, max)).clipped(end).count(), 2);
        assert_eq!(bresenham((max, max), (max, max)).collect::<Vec<_>>(), [(max, max)]);
        // Thick lines at the edge of the numbers lose what lies beyond.
        assert_eq!(wide((max, max), (max - 3, max), 5).count(), 12);
        assert_eq!(wide((0, 0), (0, 0), u32::MAX).clipped(clip).count(), 100);
    }

    #[test]
    fn wide_lines_lay_the_spare_pixel_below() {
        assert_eq!(
            draw(wide((0, 1), (8, 2), 4)),
            [
                "#####....", //
                "#########",
                "#########",
                "#########",
                ".....####",
            ]
        );
        assert!(sorted(wide((0, 1), (8, 2), 4)) == sorted(wide((8, 2), (0, 1), 4)));
        assert_eq!(
            draw(wide((2, 0), (5, 3), 2)),
            [
                "..#......", //
                "..##.....",
                "...##....",
                "....##...",
                ".....#...",
            ]
        );
        assert_eq!(wide((0, 0), (5, 3), 0).count(), 0);
    }

    #[test]
    fn joints_and_the_start_come_once() {
        let corners = [(0, 0), (8, 0), (4, 4)];
        assert_eq!(
            draw(outline(&corners)),
            [
                "#########", //
                ".#.....#.",
                "..#...#..",
                "...#.#...",
                "....#....",
            ]
        );
        assert_eq!(
            draw(polyline(&corners)),
            [
                "#########", //
                ".......#.",
                "......#..",
                ".....#...",
                "....#....",
            ]
        );
        let closed = [(0, 0), (8, 0), (8, 0), (4, 4), (0, 0), (0, 0)];
        assert_eq!(sorted(polyline(&closed)), sorted(outline(&corners)));
        assert_eq!(polyline(&[]).count() + outline(&[]).count(), 0);
        assert_eq!(outline(&[(3, 3); 4]).collect::<Vec<_>>(), [(3, 3)]);
        assert_eq!(outline(&[(0, 0), (3, 0)]).count(), 4);
    }

    #[test]
    fn a_clipped_outline_is_the_outline_inside() {
        let points = [(-7, -3), (9, -8), (3, 2), (12, 9), (-5, 6)];
        let clip = IntRect::from_ltrb(-4, -6, 5, 8);
        let inside = |&(x, y): &(i32, i32)| (-4..5).contains(&x) && (-6..8).contains(&y);
        assert!(outline(&points).clipped(clip).eq(outline(&points).filter(inside)));
    }

    #[test]
    fn row_runs_are_the_pixels_of_each_row() {
        for x in -7..=7 {
            for y in -7..=7 {
                for row in -8..=8 {
                    let in_row = sorted(bresenham((0, 0), (x, y)).filter(|p| p.1 == row));
                    let run = row_run((0, 0), (x, y), row);
                    let run: Vec<_> = run.into_iter().flatten().map(|x| (x as i32, row)).collect();
                    assert_eq!(run, in_row, "({x}, {y}) row {row}");
                }
            }
        }
    }

    #[test]
    fn the_parameter_of_the_longest_line_is_exact_at_its_ends() {
        let (a, b) = ((i32::MIN, i32::MAX), (i32::MAX, i32::MIN));
        assert_eq!((parameter(a, b, a), parameter(a, b, b)), (0.0, 1.0));
        assert_eq!(parameter(a, a, b), 0.0);
    }
}
