//! Dashes: the pieces of a path that a pattern leaves.
//!
//! Lengths are measured in user space, in `f64`. Pieces of curves stay curves and pieces keep the corners
//! that lie inside them, so that a dashed line looks like the solid one where it is drawn. What lies
//! outside the visible rectangle only moves the pattern on.

use super::curve::Cubic;
use super::flatten::PolygonSink;
use super::outline::{Outliner, PointMap};
use super::stroke::{Job, Subpath};
use super::{Dash, Segment};
use crate::geom::{Point, Rect};

/// With more dashes and gaps than this in the visible part of a path, the line is drawn solid.
const MOST_INTERVALS: f64 = 1_000_000.0;

/// Memory that dashing reuses.
#[derive(Debug, Default)]
pub(super) struct DashScratch {
    /// Where each interval of the pattern ends.
    ends: Vec<f64>,
    /// The dash at the start of a subpath, kept back until it is known whether the last one runs into it.
    first: Vec<Segment>,
}

/// Strokes the dashes of every subpath; false, with nothing drawn, if the line is to be solid.
pub(super) fn dash<B: PointMap, A: PointMap, K: PolygonSink>(
    job: &Job<'_>,
    dash: &Dash,
    before: B,
    scratch: &mut DashScratch,
    outliner: &mut Outliner<'_, A, K>,
) -> bool {
    let Some(period) = measure(dash, &mut scratch.ends) else { return false };
    let window = window(job, outliner.pen.reach());
    let per_length = scratch.ends.len() as f64 / period;
    let all: f64 = job.subpaths().map(|subpath| lengths(subpath, Track::longest)).sum();
    if all * per_length > MOST_INTERVALS {
        let visible: f64 =
            job.subpaths().map(|subpath| lengths(subpath, |track| visible_length(track, window, 0))).sum();
        if !(visible * per_length <= MOST_INTERVALS) {
            return false;
        }
    }
    let offset = f64::from(dash.offset);
    let offset = if offset.is_finite() { offset.rem_euclid(period) } else { 0.0 };
    let axis = outliner.pen.axis;
    let mut walker = Walker {
        before,
        outliner,
        ends: &scratch.ends,
        period,
        window,
        first: &mut scratch.first,
        first_start: (Point::ZERO, Point::ZERO),
        has_first: false,
        recording: false,
        drawing: false,
        index: 0,
        left: 0.0,
        spent: 0,
    };
    for subpath in job.subpaths() {
        walker.subpath(subpath, offset, axis);
    }
    true
}

/// Fills `ends` with the ends of the intervals and gives the pattern's period; `None` for a pattern that
/// makes the line solid.
fn measure(dash: &Dash, ends: &mut Vec<f64>) -> Option<f64> {
    ends.clear();
    if !dash.intervals.iter().all(|length| *length >= 0.0 && length.is_finite()) {
        return None;
    }
    let rounds = if dash.intervals.len() % 2 == 1 { 2 } else { 1 };
    let mut end = 0.0;
    for _ in 0..rounds {
        for length in dash.intervals.iter() {
            end += f64::from(*length);
            ends.push(end);
        }
    }
    (end > 0.0).then_some(end)
}

/// What is visible, in user space and grown by the pen's reach; all of the plane where the transform
/// cannot be undone.
fn window(job: &Job<'_>, reach: f32) -> Rect {
    let everything = Rect::from_ltrb(f32::NEG_INFINITY, f32::NEG_INFINITY, f32::INFINITY, f32::INFINITY);
    // One pixel more, since the clipping below is rounded.
    let visible = job.visible.normalized().outset(1.0 + if job.in_device { reach } else { 0.0 });
    let user = job.transform.invert().and_then(|inverse| inverse.map_rect(visible));
    user.map_or(everything, |user| if job.in_device { user } else { user.outset(reach) })
}

/// A line or a curve to measure along.
#[derive(Clone, Copy)]
enum Track {
    Line(Point, Point),
    Curve(Cubic),
}

impl Track {
    /// The length of a line, or of a curve's control polygon.
    fn longest(self) -> f64 {
        match self {
            Self::Line(p, q) => line_length(p, q),
            Self::Curve(cubic) => cubic.longest(),
        }
    }
}

fn line_length(p: Point, q: Point) -> f64 {
    let (x, y) = (f64::from(q.x) - f64::from(p.x), f64::from(q.y) - f64::from(p.y));
    (x * x + y * y).sqrt()
}

/// Calls `visit` with every line and curve of a subpath, the closing line included.
fn for_each_track(subpath: Subpath<'_>, mut visit: impl FnMut(Track)) {
    let mut at = subpath.start;
    for segment in subpath.segments() {
        match segment {
            Segment::LineTo(p) => {
                visit(Track::Line(at, p));
                at = p;
            }
            Segment::QuadTo(c, p) => {
                visit(Track::Curve(Cubic::from_quad(at, c, p)));
                at = p;
            }
            Segment::CubicTo(c1, c2, p) => {
                visit(Track::Curve(Cubic::new(at, c1, c2, p)));
                at = p;
            }
            Segment::MoveTo(_) | Segment::Close => {}
        }
    }
    if subpath.closed {
        visit(Track::Line(at, subpath.start));
    }
}

fn lengths(subpath: Subpath<'_>, length: impl Fn(Track) -> f64) -> f64 {
    let mut sum = 0.0;
    for_each_track(subpath, |track| sum += length(track));
    sum
}

/// How a curve meets the window.
enum View {
    Outside,
    /// Much longer than the window: to be looked at in halves.
    TooLong,
    Inside,
}

fn view(cubic: &Cubic, window: Rect, depth: u32) -> View {
    let Some(hull) = Rect::from_points(&cubic.points()) else { return View::Inside };
    let apart =
        hull.right < window.left || hull.left > window.right || hull.bottom < window.top || hull.top > window.bottom;
    if apart {
        return View::Outside;
    }
    let size = 2.0 * (f64::from(window.width()) + f64::from(window.height()));
    // 40 halvings bring 1e12 times the window's size down to it.
    if depth < 40 && cubic.longest() > size { View::TooLong } else { View::Inside }
}

/// How much of a track is in the window, or a little more.
fn visible_length(track: Track, window: Rect, depth: u32) -> f64 {
    match track {
        Track::Line(p, q) => match clip(p, q, window) {
            Some((enter, leave)) => (leave - enter) * line_length(p, q),
            None => 0.0,
        },
        Track::Curve(cubic) => match view(&cubic, window, depth) {
            View::Outside => 0.0,
            View::Inside => cubic.longest(),
            View::TooLong => {
                let (a, b) = cubic.halves();
                visible_length(Track::Curve(a), window, depth + 1) + visible_length(Track::Curve(b), window, depth + 1)
            }
        },
    }
}

/// The parameters between which a line is in the window (Liang and Barsky), or `None`.
fn clip(p: Point, q: Point, window: Rect) -> Option<(f64, f64)> {
    let (mut enter, mut leave) = (0.0_f64, 1.0_f64);
    let axes = [(p.x, q.x, window.left, window.right), (p.y, q.y, window.top, window.bottom)];
    for (from, to, low, high) in axes {
        let [from, to, low, high] = [from, to, low, high].map(f64::from);
        let along = to - from;
        if along == 0.0 {
            if from < low || from > high {
                return None;
            }
            continue;
        }
        let (a, b) = ((low - from) / along, (high - from) / along);
        let (near, far) = if a < b { (a, b) } else { (b, a) };
        enter = if near > enter { near } else { enter };
        leave = if far < leave { far } else { leave };
    }
    (enter < leave).then_some((enter, leave))
}

/// Walks tracks and the pattern side by side.
struct Walker<'a, 'b, B: PointMap, A: PointMap, K: PolygonSink> {
    before: B,
    outliner: &'a mut Outliner<'b, A, K>,
    ends: &'a [f64],
    period: f64,
    window: Rect,
    /// The subpath's first dash, mapped, and where and in which direction it starts.
    first: &'a mut Vec<Segment>,
    first_start: (Point, Point),
    has_first: bool,
    /// Whether what is drawn goes to `first`.
    recording: bool,
    /// Whether a dash is under way.
    drawing: bool,
    /// The current interval, a dash if even, and how much of it is left.
    index: usize,
    left: f64,
    spent: u32,
}

impl<B: PointMap, A: PointMap, K: PolygonSink> Walker<'_, '_, B, A, K> {
    fn subpath(&mut self, subpath: Subpath<'_>, offset: f64, axis: Point) {
        self.seek(offset);
        self.first.clear();
        self.has_first = false;
        self.drawing = false;
        self.recording = self.is_on();
        let mut length = 0.0;
        for_each_track(subpath, |track| length += self.track(track, 0));
        if length == 0.0 {
            if self.is_on() {
                self.outliner.dot(self.before.map_point(subpath.start), axis);
            }
            return;
        }
        if self.drawing {
            if self.recording {
                self.recording = false;
                self.drawing = false;
                self.replay_first(subpath.closed);
            } else if subpath.closed && self.has_first {
                self.has_first = false;
                self.draw_first();
                self.pen_up();
            } else {
                self.pen_up();
            }
        }
        if self.has_first {
            self.replay_first(false);
        }
    }

    /// Walks one track and gives its length.
    fn track(&mut self, track: Track, depth: u32) -> f64 {
        match track {
            Track::Line(p, q) => {
                let length = line_length(p, q);
                if length == 0.0 {
                    return 0.0;
                }
                let Some((enter, leave)) = clip(p, q, self.window) else {
                    self.skip(length);
                    return length;
                };
                let mut line = Line { p, q, length };
                if enter > 0.0 {
                    self.skip(enter * length);
                }
                self.walk(&mut line, enter * length, leave * length);
                if leave < 1.0 {
                    self.skip((1.0 - leave) * length);
                }
                length
            }
            Track::Curve(cubic) => match view(&cubic, self.window, depth) {
                View::Outside => {
                    let length = cubic.length();
                    self.skip(length);
                    length
                }
                View::TooLong => {
                    let (a, b) = cubic.halves();
                    self.track(Track::Curve(a), depth + 1) + self.track(Track::Curve(b), depth + 1)
                }
                View::Inside => {
                    let mut curve = Curve::new(cubic);
                    let length = curve.length();
                    if length > 0.0 {
                        self.walk(&mut curve, 0.0, length);
                    }
                    length
                }
            },
        }
    }

    /// Goes on to a position in the pattern.
    fn seek(&mut self, position: f64) {
        let position = if position < self.period { position } else { position % self.period };
        self.index = self.ends.partition_point(|end| *end <= position);
        self.left = match self.ends.get(self.index) {
            Some(end) => end - position,
            None => {
                self.index = 0;
                self.ends.first().copied().unwrap_or(f64::INFINITY)
            }
        };
        // A dash without length starts where it ends, and the search went past it.
        while let Some(previous) = self.index.checked_sub(1)
            && self.length_of(previous) == 0.0
            && self.ends.get(previous) == Some(&position)
        {
            self.index = previous;
            self.left = 0.0;
        }
    }

    fn length_of(&self, index: usize) -> f64 {
        let end = self.ends.get(index).copied().unwrap_or(0.0);
        end - index.checked_sub(1).and_then(|i| self.ends.get(i)).copied().unwrap_or(0.0)
    }

    fn is_on(&self) -> bool {
        self.index.is_multiple_of(2)
    }

    /// Moves on by `length` without drawing. Both ends are out of sight.
    fn skip(&mut self, length: f64) {
        if self.drawing {
            self.pen_up();
        }
        self.recording = false;
        if length <= self.left {
            self.left -= length;
        } else if let Some(end) = self.ends.get(self.index) {
            self.seek(end - self.left + length);
        }
    }

    /// Draws the dashes between two distances from the track's start.
    fn walk(&mut self, track: &mut impl Measured, from: f64, to: f64) {
        let mut position = from;
        let mut t = track.seek(from);
        if self.is_on() && !self.drawing {
            self.pen_down(track.at(t), track.direction(t));
        }
        loop {
            if self.left >= to - position {
                self.left -= to - position;
                if self.drawing {
                    let end = track.seek(to);
                    track.draw(t, end, self);
                }
                return;
            }
            position += self.left;
            let next = track.seek(position);
            if self.drawing {
                track.draw(t, next, self);
            }
            t = next;
            self.turn_over(track.at(t), track.direction(t));
        }
    }

    /// Goes on to the next interval at a point of the path. A gap without length ends a dash and starts one.
    fn turn_over(&mut self, p: Point, direction: Point) {
        self.spent = self.spent.saturating_add(1);
        if f64::from(self.spent) > 4.0 * MOST_INTERVALS {
            // Many lengthless dashes, met again and again: the rest is solid.
            self.index = 0;
            self.left = f64::INFINITY;
        } else {
            self.index = if self.index + 1 < self.ends.len() { self.index + 1 } else { 0 };
            self.left = self.length_of(self.index);
            if !self.is_on() && self.left == 0.0 {
                if self.drawing {
                    self.pen_up();
                }
                self.index = if self.index + 1 < self.ends.len() { self.index + 1 } else { 0 };
                self.left = self.length_of(self.index);
            }
        }
        match (self.is_on(), self.drawing) {
            (true, false) => self.pen_down(p, direction),
            (false, true) => self.pen_up(),
            _ => {}
        }
    }

    fn pen_down(&mut self, p: Point, direction: Point) {
        self.drawing = true;
        let (p, direction) = (self.before.map_point(p), self.before.map_direction(direction));
        if self.recording {
            self.first_start = (p, direction);
        } else {
            self.outliner.pen.axis = direction;
            self.outliner.begin(p, false);
        }
    }

    fn pen_up(&mut self) {
        self.drawing = false;
        if self.recording {
            self.recording = false;
            self.has_first = true;
        } else {
            self.outliner.finish();
        }
    }

    fn draw(&mut self, segment: Segment) {
        if self.recording {
            self.first.push(segment);
        } else {
            match segment {
                Segment::LineTo(p) => self.outliner.line(p),
                Segment::CubicTo(c1, c2, p) => self.outliner.cubic(c1, c2, p),
                Segment::MoveTo(_) | Segment::QuadTo(..) | Segment::Close => {}
            }
        }
    }

    /// Draws the kept dash at the end of the current one.
    fn draw_first(&mut self) {
        for i in 0..self.first.len() {
            if let Some(segment) = self.first.get(i) {
                self.draw(*segment);
            }
        }
    }

    /// Draws the kept dash as a subpath of its own.
    fn replay_first(&mut self, closed: bool) {
        self.has_first = false;
        let (start, direction) = self.first_start;
        self.outliner.pen.axis = direction;
        self.outliner.begin(start, closed);
        self.draw_first();
        self.outliner.finish();
    }
}

/// A track with a way from lengths to points.
trait Measured {
    /// The parameter at a distance from the start. Distances of successive calls do not fall.
    fn seek(&mut self, distance: f64) -> f64;
    fn at(&self, t: f64) -> Point;
    fn direction(&self, t: f64) -> Point;
    /// Draws the piece between two parameters; the walker is at the first.
    fn draw<B: PointMap, A: PointMap, K: PolygonSink>(&self, t0: f64, t1: f64, walker: &mut Walker<'_, '_, B, A, K>);
}

struct Line {
    p: Point,
    q: Point,
    length: f64,
}

impl Measured for Line {
    fn seek(&mut self, distance: f64) -> f64 {
        let t = distance / self.length;
        if t < 1.0 { t } else { 1.0 }
    }

    fn at(&self, t: f64) -> Point {
        if t >= 1.0 {
            return self.q;
        }
        let mix = |a: f32, b: f32| (f64::from(a) + (f64::from(b) - f64::from(a)) * t) as f32;
        Point::new(mix(self.p.x, self.q.x), mix(self.p.y, self.q.y))
    }

    fn direction(&self, _: f64) -> Point {
        let x = (f64::from(self.q.x) - f64::from(self.p.x)) / self.length;
        let y = (f64::from(self.q.y) - f64::from(self.p.y)) / self.length;
        Point::new(x as f32, y as f32)
    }

    fn draw<B: PointMap, A: PointMap, K: PolygonSink>(&self, _: f64, t1: f64, walker: &mut Walker<'_, '_, B, A, K>) {
        walker.draw(Segment::LineTo(walker.before.map_point(self.at(t1))));
    }
}

/// A curve with its length up to every sixteenth of its parameter.
struct Curve {
    cubic: Cubic,
    lengths: [f64; 17],
    /// The sixteenth that the last distance was in.
    part: usize,
}

impl Curve {
    fn new(cubic: Cubic) -> Self {
        let mut lengths = [0.0; 17];
        let mut sum = 0.0;
        let mut t = 0.0;
        for length in lengths.iter_mut().skip(1) {
            sum += cubic.length_between(t, t + 0.0625);
            t += 0.0625;
            *length = sum;
        }
        Self { cubic, lengths, part: 0 }
    }

    fn length(&self) -> f64 {
        self.lengths[16]
    }
}

impl Measured for Curve {
    fn seek(&mut self, distance: f64) -> f64 {
        while self.part < 15 && self.lengths.get(self.part + 1).is_some_and(|end| *end < distance) {
            self.part += 1;
        }
        let low = self.lengths.get(self.part).copied().unwrap_or(0.0);
        let high = self.lengths.get(self.part + 1).copied().unwrap_or(0.0);
        let start = self.part as f64 * 0.0625;
        if !(high > low) || distance >= self.length() {
            return if distance >= self.length() { 1.0 } else { start };
        }
        let mut t = start + 0.0625 * ((distance - low) / (high - low));
        // Newton's method on the length; three rounds leave less than 1e-6 of the piece.
        for _ in 0..3 {
            let [x, y] = self.cubic.velocity(t);
            let speed = (x * x + y * y).sqrt();
            let better = t - (low + self.cubic.length_between(start, t) - distance) / speed;
            if better >= start && better <= start + 0.0625 {
                t = better;
            }
        }
        t
    }

    fn at(&self, t: f64) -> Point {
        self.cubic.at(t)
    }

    fn direction(&self, t: f64) -> Point {
        self.cubic.direction(t)
    }

    fn draw<B: PointMap, A: PointMap, K: PolygonSink>(&self, t0: f64, t1: f64, walker: &mut Walker<'_, '_, B, A, K>) {
        let piece = if t0 == 0.0 && t1 == 1.0 { self.cubic } else { self.cubic.piece(t0, t1) };
        let [_, c1, c2, p] = piece.points().map(|p| walker.before.map_point(p));
        walker.draw(Segment::CubicTo(c1, c2, p));
    }
}

#[cfg(test)]
mod tests {
    use crate::geom::{Point, Rect, Transform};
    use crate::path::flatten::PolygonSink;
    use crate::path::stroke::{StrokeScratch, stroke};
    use crate::path::{LineCap, LineJoin, Path, Stroke};

    /// Collects polygons.
    #[derive(Default)]
    struct Polygons(Vec<Vec<Point>>);

    impl PolygonSink for Polygons {
        fn begin(&mut self, p: Point) {
            self.0.push(vec![p]);
        }
        fn line(&mut self, p: Point) {
            self.0.last_mut().unwrap().push(p);
        }
        fn end(&mut self) {}
    }

    const SCREEN: Rect = Rect::from_ltrb(0.0, 0.0, 1000.0, 1000.0);

    fn draw_mapped(path: &Path, style: &Stroke, transform: Transform) -> Vec<Vec<Point>> {
        let mut sink = Polygons::default();
        let mut scratch = StrokeScratch::default();
        stroke(path.verbs(), path.points(), style, transform, 0.05, SCREEN, &mut scratch, &mut sink);
        sink.0
    }

    fn draw(path: &Path, style: &Stroke) -> Vec<Vec<Point>> {
        draw_mapped(path, style, Transform::IDENTITY)
    }

    fn line(x0: f32, x1: f32) -> Path {
        let mut path = Path::new();
        path.move_to((x0, 10.0)).line_to((x1, 10.0));
        path
    }

    /// From where to where each polygon reaches in x, in order.
    fn spans(polygons: &[Vec<Point>]) -> Vec<(f32, f32)> {
        let mut spans: Vec<_> = polygons
            .iter()
            .map(|polygon| {
                let bounds = Rect::from_points(polygon).unwrap();
                (bounds.left, bounds.right)
            })
            .collect();
        spans.sort_by(|a, b| a.0.total_cmp(&b.0));
        spans
    }

    fn area(polygon: &[Point]) -> f32 {
        let next = polygon.iter().cycle().skip(1);
        polygon.iter().zip(next).map(|(a, b)| a.cross(*b)).sum::<f32>() * 0.5
    }

    #[test]
    fn dashes_lie_where_the_pattern_puts_them() {
        let cases: [(&[f32], f32, &[(f32, f32)]); 8] = [
            (&[3.0, 2.0], 0.0, &[(0.0, 3.0), (5.0, 8.0), (10.0, 12.0)]),
            (&[3.0, 2.0], 1.0, &[(0.0, 2.0), (4.0, 7.0), (9.0, 12.0)]),
            (&[3.0, 2.0], 4.0, &[(1.0, 4.0), (6.0, 9.0), (11.0, 12.0)]),
            (&[3.0, 2.0], -1.0, &[(1.0, 4.0), (6.0, 9.0), (11.0, 12.0)]),
            (&[3.0, 2.0], 5_000.0, &[(0.0, 3.0), (5.0, 8.0), (10.0, 12.0)]),
            // An odd pattern is 1 on, 2 off, 3 on, 1 off, 2 on, 3 off.
            (&[1.0, 2.0, 3.0], 0.0, &[(0.0, 1.0), (3.0, 6.0), (7.0, 9.0)]),
            (&[4.0], 0.0, &[(0.0, 4.0), (8.0, 12.0)]),
            // A gap without length parts two dashes that touch.
            (&[3.0, 0.0, 1.0, 2.0], 0.0, &[(0.0, 3.0), (3.0, 4.0), (6.0, 9.0), (9.0, 10.0)]),
        ];
        for (pattern, offset, expected) in cases {
            let got = spans(&draw(&line(0.0, 12.0), &Stroke::new(2.0).with_dash(pattern, offset)));
            assert_eq!(got, expected, "{pattern:?} {offset}");
        }
    }

    #[test]
    fn senseless_patterns_are_solid() {
        let patterns: [&[f32]; 6] = [&[], &[0.0], &[0.0, 0.0], &[3.0, -1.0], &[f32::NAN, 1.0], &[f32::INFINITY, 1.0]];
        for pattern in patterns {
            let got = spans(&draw(&line(0.0, 12.0), &Stroke::new(2.0).with_dash(pattern, 0.0)));
            assert_eq!(got, [(0.0, 12.0)], "{pattern:?}");
        }
        let odd_offset = Stroke::new(2.0).with_dash([8.0, 8.0], f32::NAN);
        assert_eq!(spans(&draw(&line(0.0, 12.0), &odd_offset)), [(0.0, 8.0)]);
    }

    #[test]
    fn dashes_without_length_are_dots_along_the_path() {
        let mut path = Path::new();
        path.move_to((100.0, 100.0)).line_to((130.0, 140.0));
        let style = Stroke::new(2.0).with_dash([0.0, 20.0], 10.0);
        assert!(draw(&path, &style).is_empty());
        let squares = draw(&path, &style.clone().with_cap(LineCap::Square));
        // At 10 and 30 of 50: centres on the line, sides along (3, 4) / 5.
        assert_eq!(squares.len(), 2);
        for (square, center) in squares.iter().zip([(106.0, 108.0), (118.0, 124.0)]) {
            let corners = [(0.2, -1.4), (1.4, 0.2), (-0.2, 1.4), (-1.4, -0.2)];
            assert_eq!(square.len(), 4);
            for (x, y) in corners {
                let corner = Point::new(center.0 + x, center.1 + y);
                assert!(square.iter().any(|p| (*p - corner).length() < 1e-4), "{square:?} lacks {corner:?}");
            }
        }
        let discs = draw(&path, &style.with_cap(LineCap::Round));
        assert_eq!(discs.len(), 2);
        let bounds = Rect::from_points(&discs[1]).unwrap();
        assert!((bounds.center() - Point::new(118.0, 124.0)).length() < 0.1, "{bounds:?}");
    }

    #[test]
    fn a_closed_subpaths_last_dash_runs_into_its_first() {
        let mut square = Path::new();
        square.rect(Rect::from_ltrb(100.0, 100.0, 110.0, 110.0));
        // 40 around; on 0 to 5, 10 to 15, …: with offset 2, on −2 to 3 around the first corner.
        let style = Stroke::new(2.0).with_dash([5.0, 5.0], 2.0);
        let dashes = draw(&square, &style);
        assert_eq!(dashes.len(), 4);
        let corner = dashes.iter().find(|dash| dash.iter().any(|p| *p == Point::new(99.0, 99.0))).unwrap();
        let bounds = Rect::from_points(corner).unwrap();
        assert_eq!(bounds, Rect::from_ltrb(99.0, 99.0, 103.0, 102.0));
        // Open, the two halves have caps of their own.
        let mut open = Path::new();
        open.polyline(
            &[(100.0, 100.0), (110.0, 100.0), (110.0, 110.0), (100.0, 110.0), (100.0, 100.0)].map(Point::from),
        );
        assert_eq!(draw(&open, &style).len(), 5);
        // A dash longer than the way around closes it.
        let whole = draw(&square, &Stroke::new(2.0).with_dash([100.0, 1.0], 0.0));
        assert_eq!(whole, draw(&square, &Stroke::new(2.0)));
    }

    #[test]
    fn dashes_turn_corners_with_their_joins() {
        let mut path = Path::new();
        path.polyline(&[(100.0, 100.0), (110.0, 100.0), (110.0, 110.0)].map(Point::from));
        let dashes = draw(&path, &Stroke::new(2.0).with_dash([4.0, 4.0], 0.0));
        assert_eq!(dashes.len(), 3);
        let corner = [(108.0, 99.0), (111.0, 99.0), (111.0, 102.0), (109.0, 102.0), (109.0, 101.0), (108.0, 101.0)];
        assert!(dashes.contains(&corner.map(Point::from).to_vec()), "{dashes:?}");
    }

    #[test]
    fn dashes_on_a_circle_have_the_area_of_ring_sectors() {
        // Circumference 2π·50; sixteenths of it, on and off. A sector of a ring of width 4 on the circle has
        // area length · 4.
        let sixteenth = std::f32::consts::PI * 100.0 / 16.0;
        let mut path = Path::new();
        path.circle((200.0, 200.0), 50.0);
        let style = Stroke::new(4.0).with_dash([sixteenth, sixteenth], 0.0);
        for (transform, scale) in [(Transform::IDENTITY, 1.0), (Transform::from_scale(3.0, 0.5), 1.5)] {
            let dashes = draw_mapped(&path, &style, transform);
            assert_eq!(dashes.len(), 8);
            for dash in &dashes {
                let error = area(dash) / (sixteenth * 4.0 * scale) - 1.0;
                assert!(error.abs() < 0.01, "{error}");
            }
        }
    }

    #[test]
    fn what_is_out_of_sight_only_moves_the_pattern() {
        // 7 × 142,857,142 = 999,999,994: the pattern starts anew 6 before the origin.
        let style = Stroke::new(2.0).with_dash([3.0, 4.0], 0.0);
        let mut path = Path::new();
        path.move_to((-1e9, 10.0)).line_to((1e9, 10.0));
        let spans = spans(&draw(&path, &style));
        assert!((140..150).contains(&spans.len()), "{}", spans.len());
        for (left, right) in spans {
            // The first and the last may be cut where they no longer show.
            if left > 0.0 && right < 1000.0 {
                assert!(((left + 6.0) % 7.0).abs() < 0.01 && (right - left - 3.0).abs() < 0.01, "{left} {right}");
            }
        }
    }

    #[test]
    fn what_is_out_of_sight_changes_nothing_in_sight() {
        let mut path = Path::new();
        path.move_to((-300.0, 200.0)).cubic_to((400.0, -900.0), (700.0, 1900.0), (1400.0, 300.0));
        path.line_to((1400.0, 500.0)).line_to((-50.0, 700.0)).quad_to((-900.0, 900.0), (300.0, 900.0));
        let styles = [LineCap::Butt, LineCap::Round]
            .map(|cap| Stroke::new(9.0).with_cap(cap).with_join(LineJoin::Round).with_dash([31.0, 17.0, 4.0], 11.0));
        for style in styles {
            let part = draw(&path, &style);
            let whole = path.stroked(&style, 0.05);
            let mut culled = Path::new();
            part.iter().for_each(|polygon| {
                culled.polygon(polygon);
            });
            assert!(culled.verbs().len() < whole.verbs().len());
            let (mut inside, mut different) = (0, 0);
            for i in 0..250_u16 {
                for j in 0..250_u16 {
                    let p = Point::new(f32::from(i) * 4.0 + 1.7, f32::from(j) * 4.0 + 2.3);
                    let rule = crate::style::FillRule::NonZero;
                    let on = whole.contains(p, rule);
                    inside += u32::from(on);
                    different += u32::from(culled.contains(p, rule) != on);
                }
            }
            // Where a step of a curve begins depends on where its piece does: within the tolerance.
            assert!(inside > 500 && different < 10, "{inside} {different}");
        }
    }

    #[test]
    fn patterns_too_fine_to_draw_are_solid_and_large_ones_are_quick() {
        let solid = draw(&line(0.0, 500.0), &Stroke::new(2.0).with_dash([1e-9, 1e-9], 0.0));
        assert_eq!(spans(&solid), [(0.0, 500.0)]);
        let million: Vec<f32> = vec![1e-3; 1_000_000];
        assert_eq!(draw(&line(0.0, 100.0), &Stroke::new(2.0).with_dash(million, 0.0)).len(), 50_000);
        // Lengthless dots a million times in one place.
        let mut dots = vec![0.0_f32; 1_000_000];
        dots[999_999] = 0.5;
        dots[500_001] = 0.5;
        let drawn = draw(&line(0.0, 500.0), &Stroke::new(2.0).with_cap(LineCap::Round).with_dash(dots, 0.0));
        assert_eq!(drawn.len(), 1);
        let mut spiral = Path::new();
        spiral.move_to((-1e9, 0.0)).cubic_to((1e9, 2e9), (1e9, -2e9), (-1e9, 1000.0)).close();
        let drawn = draw(&spiral, &Stroke::new(2.0).with_dash([3.0, 4.0], 0.0));
        assert!(drawn.len() < 10_000, "{}", drawn.len());
    }
}
