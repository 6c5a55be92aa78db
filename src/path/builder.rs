//! The path and its elementary segments.

use std::sync::Arc;

use super::known::{Known, Outline};
use crate::geom::{Point, Rect, Transform};

/// What a path does next.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verb {
    /// Start a subpath at one point.
    MoveTo,
    /// A straight line to one point.
    LineTo,
    /// A quadratic Bézier curve: control point, end.
    QuadTo,
    /// A cubic Bézier curve: two control points, end.
    CubicTo,
    /// A straight line back to the subpath's start.
    Close,
}

/// One step of a path with its points, as [`Path::segments`] gives it. Starting points are those
/// where the previous segment ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Segment {
    /// Start a subpath.
    MoveTo(Point),
    /// A straight line.
    LineTo(Point),
    /// A quadratic Bézier curve: control point, end.
    QuadTo(Point, Point),
    /// A cubic Bézier curve: two control points, end.
    CubicTo(Point, Point, Point),
    /// A straight line back to the subpath's start.
    Close,
}

/// A path: subpaths of lines and of quadratic and cubic Bézier curves, in user space.
///
/// Methods that add segments return the path, so that they chain. A segment without a
/// [`move_to`](Path::move_to) before it starts where the last subpath started, or, in an empty path, at its own
/// first point, as on an HTML canvas. From the second drawing on a path of 32 points and more that does not change keeps a copy of
/// its segments, which recordings then share instead of copying them anew. Non-finite points are kept here and end the drawing of the
/// whole path: a path with such a point draws nothing.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Path {
    verbs: Vec<Verb>,
    points: Vec<Point>,
    /// Where the current subpath started.
    start: Point,
    known: Known,
}

impl Path {
    /// A path without segments.
    pub fn new() -> Self {
        Self::default()
    }

    /// Whether there is no segment.
    pub fn is_empty(&self) -> bool {
        self.verbs.is_empty()
    }

    /// Removes every segment and keeps the memory.
    pub fn clear(&mut self) {
        self.verbs.clear();
        self.points.clear();
        self.start = Point::ZERO;
        self.known.forget();
    }

    /// The verbs in order; each takes 1, 1, 2, 3 or 0 of [`Path::points`].
    pub fn verbs(&self) -> &[Verb] {
        &self.verbs
    }

    /// The points of all segments, one after another.
    pub fn points(&self) -> &[Point] {
        &self.points
    }

    /// Starts a subpath at `p`.
    pub fn move_to(&mut self, p: impl Into<Point>) -> &mut Self {
        let p = p.into();
        self.start = p;
        self.known.forget();
        if let (Some(Verb::MoveTo), Some(last)) = (self.verbs.last(), self.points.last_mut()) {
            *last = p;
        } else {
            self.verbs.push(Verb::MoveTo);
            self.points.push(p);
        }
        self
    }

    /// Adds a straight line to `p`.
    pub fn line_to(&mut self, p: impl Into<Point>) -> &mut Self {
        let p = p.into();
        self.ensure_subpath(p);
        self.known.forget();
        self.verbs.push(Verb::LineTo);
        self.points.push(p);
        self
    }

    /// Adds a quadratic Bézier curve with control point `c` to `p`.
    pub fn quad_to(&mut self, c: impl Into<Point>, p: impl Into<Point>) -> &mut Self {
        let (c, p) = (c.into(), p.into());
        self.ensure_subpath(c);
        self.known.forget();
        self.verbs.push(Verb::QuadTo);
        self.points.extend([c, p]);
        self
    }

    /// Adds a cubic Bézier curve with control points `c1` and `c2` to `p`.
    pub fn cubic_to(&mut self, c1: impl Into<Point>, c2: impl Into<Point>, p: impl Into<Point>) -> &mut Self {
        let (c1, c2, p) = (c1.into(), c2.into(), p.into());
        self.ensure_subpath(c1);
        self.known.forget();
        self.verbs.push(Verb::CubicTo);
        self.points.extend([c1, c2, p]);
        self
    }

    /// Closes the subpath with a straight line to its start. Nothing happens if it is closed already.
    pub fn close(&mut self) -> &mut Self {
        if !matches!(self.verbs.last(), None | Some(Verb::Close)) {
            self.verbs.push(Verb::Close);
        }
        self
    }

    /// Where the next segment would start: the last segment's end, or the subpath's start after
    /// [`close`](Path::close); `None` in an empty path.
    pub fn current_point(&self) -> Option<Point> {
        match self.verbs.last()? {
            Verb::Close => Some(self.start),
            _ => self.points.last().copied(),
        }
    }

    /// Appends all segments of `other`, mapped by `transform`.
    pub fn extend(&mut self, other: &Path, transform: Transform) -> &mut Self {
        self.known.forget();
        self.verbs.extend_from_slice(&other.verbs);
        self.points.extend(other.points.iter().map(|p| transform.map(*p)));
        if !other.is_empty() {
            self.start = transform.map(other.start);
        }
        self
    }

    /// This path with every point mapped by `transform`.
    #[must_use]
    pub fn transformed(&self, transform: Transform) -> Self {
        let mut path = Self::new();
        path.extend(self, transform);
        path
    }

    /// The bounding box of all points, control points included; `None` for an empty path or one with
    /// a non-finite point.
    pub fn control_bounds(&self) -> Option<Rect> {
        self.known.bounds(&self.points)
    }

    /// What a recording may share instead of copying the segments; `None` if they are few or drawn for the first time.
    pub(crate) fn shared_outline(&self) -> Option<&Arc<Outline>> {
        self.known.outline(&self.verbs, &self.points)
    }

    /// The rectangle that filling the path covers, if the path is one rectangle with edges along the axes.
    pub(crate) fn as_rect(&self) -> Option<Rect> {
        let [a, b, c, d] = match (&self.verbs[..], &self.points[..]) {
            (
                [Verb::MoveTo, Verb::LineTo, Verb::LineTo, Verb::LineTo]
                | [Verb::MoveTo, Verb::LineTo, Verb::LineTo, Verb::LineTo, Verb::Close],
                [a, b, c, d],
            ) => [*a, *b, *c, *d],
            (
                [Verb::MoveTo, Verb::LineTo, Verb::LineTo, Verb::LineTo, Verb::LineTo]
                | [Verb::MoveTo, Verb::LineTo, Verb::LineTo, Verb::LineTo, Verb::LineTo, Verb::Close],
                [a, b, c, d, back],
            ) if back == a => [*a, *b, *c, *d],
            _ => return None,
        };
        let across_first = a.y == b.y && b.x == c.x && c.y == d.y && d.x == a.x;
        let down_first = a.x == b.x && b.y == c.y && c.x == d.x && d.y == a.y;
        (across_first || down_first).then(|| Rect::from_ltrb(a.x, a.y, c.x, c.y).normalized())
    }

    /// The segments in order.
    pub fn segments(&self) -> impl Iterator<Item = Segment> + '_ {
        segments(&self.verbs, &self.points)
    }

    fn ensure_subpath(&mut self, p: Point) {
        match self.verbs.last() {
            None => {
                self.move_to(p);
            }
            Some(Verb::Close) => {
                self.move_to(self.start);
            }
            Some(_) => {}
        }
    }
}

/// The segments that `verbs` make of `points`; ends early if points run out.
pub(crate) fn segments<'a>(verbs: &'a [Verb], points: &'a [Point]) -> impl Iterator<Item = Segment> + 'a {
    let mut rest = points;
    verbs.iter().map_while(move |verb| {
        let (segment, after) = match (verb, rest) {
            (Verb::MoveTo, [p, after @ ..]) => (Segment::MoveTo(*p), after),
            (Verb::LineTo, [p, after @ ..]) => (Segment::LineTo(*p), after),
            (Verb::QuadTo, [c, p, after @ ..]) => (Segment::QuadTo(*c, *p), after),
            (Verb::CubicTo, [c1, c2, p, after @ ..]) => (Segment::CubicTo(*c1, *c2, *p), after),
            (Verb::Close, after) => (Segment::Close, after),
            _ => return None,
        };
        rest = after;
        Some(segment)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rectangles_are_known_as_such() {
        let rect = Rect::from_ltrb(1.0, 2.0, 5.0, 9.0);
        let corners = [(1.0, 2.0), (5.0, 2.0), (5.0, 9.0), (1.0, 9.0)];
        for start in 0..4 {
            for backwards in [false, true] {
                let mut path = Path::new();
                for i in 0..4 {
                    let corner = corners[if backwards { start + 4 - i } else { start + i } % 4];
                    if i == 0 {
                        path.move_to(corner)
                    } else {
                        path.line_to(corner)
                    };
                }
                assert_eq!(path.as_rect(), Some(rect), "{path:?}");
                let mut closed = path.clone();
                assert_eq!(closed.close().as_rect(), Some(rect));
                let mut returning = path.clone();
                returning.line_to(corners[start]);
                assert_eq!(returning.as_rect(), Some(rect));
                returning.close();
                assert_eq!(returning.as_rect(), Some(rect));
                path.line_to((3.0, 3.0));
                assert_eq!(path.as_rect(), None);
            }
        }
        let mut bow_tie = Path::new();
        bow_tie.move_to((0.0, 0.0)).line_to((4.0, 0.0)).line_to((0.0, 4.0)).line_to((4.0, 4.0)).close();
        assert_eq!(bow_tie.as_rect(), None);
        let mut there_and_back = Path::new();
        there_and_back.move_to((0.0, 0.0)).line_to((4.0, 0.0)).line_to((4.0, 0.0)).line_to((0.0, 0.0)).close();
        assert!(there_and_back.as_rect().is_none_or(|rect| rect.height() == 0.0));
    }

    #[test]
    fn a_line_without_a_move_starts_at_its_own_point() {
        let mut path = Path::new();
        path.line_to((3.0, 4.0)).line_to((5.0, 4.0));
        let segments: Vec<_> = path.segments().collect();
        assert_eq!(segments[0], Segment::MoveTo(Point::new(3.0, 4.0)));
        assert_eq!(segments.len(), 3);
    }

    #[test]
    fn a_line_after_close_starts_at_the_subpaths_start() {
        let mut path = Path::new();
        path.move_to((1.0, 2.0)).line_to((5.0, 2.0)).close().close().line_to((1.0, 9.0));
        assert_eq!(path.verbs(), [Verb::MoveTo, Verb::LineTo, Verb::Close, Verb::MoveTo, Verb::LineTo]);
        assert_eq!(path.points()[2], Point::new(1.0, 2.0));
    }

    #[test]
    fn repeated_moves_keep_the_last() {
        let mut path = Path::new();
        path.move_to((1.0, 1.0)).move_to((2.0, 2.0));
        assert_eq!(path.points(), [Point::new(2.0, 2.0)]);
    }

    #[test]
    fn bounds_of_a_path_with_a_nan_are_none() {
        let mut path = Path::new();
        path.move_to((0.0, 0.0)).line_to((f32::NAN, 1.0));
        assert_eq!(path.control_bounds(), None);
    }

    #[test]
    fn bounds_follow_every_change() {
        let mut path = Path::new();
        let mut other = Path::new();
        other.move_to((0.0, 0.0)).line_to((1.0, 1.0));
        type Change = fn(&mut Path, &Path);
        let changes: [Change; 9] = [
            |path, _| {
                path.move_to((5.0, 5.0));
            },
            // Replaces the point before.
            |path, _| {
                path.move_to((6.0, 7.0));
            },
            |path, _| {
                path.line_to((9.0, 1.0));
            },
            |path, _| {
                path.quad_to((20.0, 3.0), (4.0, 4.0));
            },
            |path, _| {
                path.cubic_to((1.0, 30.0), (-5.0, 0.0), (2.0, 2.0));
            },
            |path, _| {
                path.close();
            },
            |path, _| {
                path.line_to((50.0, 2.0));
            },
            |path, other| {
                path.extend(other, Transform::from_translate(-40.0, 8.0));
            },
            |path, _| path.clear(),
        ];
        for change in changes {
            // Asked before and after: what was kept must not outlive the change.
            let _ = path.control_bounds();
            change(&mut path, &other);
            assert_eq!(path.control_bounds(), Rect::from_points(path.points()));
            assert_eq!(path.clone().control_bounds(), path.control_bounds());
        }
    }

    #[test]
    fn a_shared_outline_is_that_of_the_path_as_it_is() {
        let mut path = Path::new();
        path.ellipse((5.0, 5.0), 3.0, 4.0);
        for end in [None, Some(Point::new(1.0, 1.0)), Some(Point::new(20.0, 9.0))] {
            if let Some(end) = end {
                path.line_to(end);
            }
            while path.points().len() < 32 {
                path.line_to((7.0, 8.0));
            }
            assert!(path.shared_outline().is_none(), "drawn once");
            for drawn in [&path, &path.clone(), &path] {
                let parts = drawn.shared_outline().map(|outline| outline.parts());
                assert_eq!(parts, Some((path.verbs(), path.points())));
            }
        }
        path.clear();
        path.move_to((0.0, 0.0)).line_to((5.0, 1.0)).line_to((5.0, 5.0));
        assert!((0..3).all(|_| path.shared_outline().is_none()), "short ones are copied");
    }
}
