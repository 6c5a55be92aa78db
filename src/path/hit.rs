//! Whether a point is in a path's fill or stroke, and what is filled for either as a path of its own.

use super::curve::Cubic;
use super::flatten::{PolygonSink, flatten_fill};
use super::stroke::{StrokeScratch, stroke};
use super::{Path, Segment, Stroke};
use crate::geom::{Point, Rect, Transform};
use crate::num::level::{SimdLevel, dispatch_up_to_avx2};
use crate::style::FillRule;

impl Path {
    /// Whether the path, filled by `rule`, covers `point`. Open subpaths are closed with a line; a point
    /// on the outline counts where the fill lies to the right of it or below. A path with a non-finite
    /// point covers nothing. Curves are halved until the side is certain, in `f64`.
    pub fn contains(&self, point: impl Into<Point>, rule: FillRule) -> bool {
        let point = point.into();
        if !point.is_finite() || self.control_bounds().is_none() {
            return false;
        }
        let target = [f64::from(point.x), f64::from(point.y)];
        let line = |p: Point, q: Point| crossings(&Cubic::new(p, p, q, q), target, 0);
        let (mut at, mut start) = (Point::ZERO, Point::ZERO);
        let mut winding = 0_i64;
        for segment in self.segments() {
            let (crossed, end) = match segment {
                Segment::MoveTo(p) => {
                    let closing = line(at, start);
                    start = p;
                    (closing, p)
                }
                Segment::LineTo(p) => (line(at, p), p),
                Segment::QuadTo(c, p) => (crossings(&Cubic::from_quad(at, c, p), target, 0), p),
                Segment::CubicTo(c1, c2, p) => (crossings(&Cubic::new(at, c1, c2, p), target, 0), p),
                Segment::Close => (line(at, start), start),
            };
            winding += crossed;
            at = end;
        }
        winding += line(at, start);
        match rule {
            FillRule::NonZero => winding != 0,
            FillRule::EvenOdd => winding % 2 != 0,
        }
    }

    /// Whether the path, stroked with `style` without a transform, covers `point`. A hairline is one unit
    /// wide. Curved parts of the outline are exact to about a thousandth of the width.
    pub fn stroke_contains(&self, point: impl Into<Point>, style: &Stroke) -> bool {
        let point = point.into();
        if !point.is_finite() {
            return false;
        }
        // The stroker's tolerance is meant for pixels: scaled by a power of two, the pen is 64 to 128 wide.
        let width = if style.width > 0.0 { style.width } else { 1.0 };
        let mut scale = 1.0_f32;
        while width * scale < 64.0 && scale < 1e18 {
            scale *= 2.0;
        }
        while width * scale >= 128.0 && scale > 1e-18 {
            scale *= 0.5;
        }
        let style = if style.width == 0.0 { Stroke { width: 1.0, ..style.clone() } } else { style.clone() };
        let p = point * scale;
        let mut sink = Winding { point: [f64::from(p.x), f64::from(p.y)], winding: 0, start: p, at: p };
        let transform = Transform::from_scale(scale, scale);
        let visible = Rect::from_ltrb(p.x, p.y, p.x, p.y);
        stroke(self.verbs(), self.points(), &style, transform, 0.05, visible, &mut StrokeScratch::default(), &mut sink);
        sink.winding != 0
    }

    /// The stroke's outline as a path of straight lines: filled with the nonzero rule, it is the stroke of
    /// this path. `tolerance` is the allowed distance from the true outline, in user space; at least 0.001.
    /// A width of 0 is one unit.
    #[must_use]
    pub fn stroked(&self, style: &Stroke, tolerance: f32) -> Self {
        let mut outline = Outline(Self::new());
        let everywhere = Rect::from_ltrb(f32::NEG_INFINITY, f32::NEG_INFINITY, f32::INFINITY, f32::INFINITY);
        stroke(
            self.verbs(),
            self.points(),
            style,
            Transform::IDENTITY,
            tolerance,
            everywhere,
            &mut StrokeScratch::default(),
            &mut outline,
        );
        outline.0
    }

    /// What filling this path under `transform` fills: closed polygons in device pixels, whose lines lie within
    /// 0.05 pixels of the curves. Subpaths of a single point are left out.
    #[must_use]
    pub fn flattened(&self, transform: Transform) -> Self {
        let mut outline = Outline(Self::new());
        let points: Vec<Point> = self.points().iter().map(|p| transform.map(*p)).collect();
        dispatch_up_to_avx2!(SimdLevel::best(), simd => {
            flatten_fill(simd, self.verbs(), &points, &mut outline);
        });
        outline.0
    }
}

/// How often a curve crosses the ray that goes left from `target`: +1 for each crossing downwards, −1 for
/// each upwards. Ends are half-open in y; a crossing at the target itself counts.
fn crossings(cubic: &Cubic, target: [f64; 2], depth: u32) -> i64 {
    let [x, y] = target;
    let [first, .., last] = cubic.p;
    if cubic.p.iter().all(|p| p[1] > y) || cubic.p.iter().all(|p| p[1] <= y) || cubic.p.iter().all(|p| p[0] > x) {
        return 0;
    }
    let net = i64::from(first[1] <= y) - i64::from(last[1] <= y);
    if cubic.p.iter().all(|p| p[0] <= x) {
        return net;
    }
    // A line is decided at once: the side of the target is the sign of a cross product.
    let straight = cubic.p[0] == cubic.p[1] && cubic.p[2] == cubic.p[3];
    if straight || depth == 48 {
        let side = (last[0] - first[0]) * (y - first[1]) - (x - first[0]) * (last[1] - first[1]);
        // Downwards, a target to the right of the line has a negative cross product.
        let beyond = if last[1] > first[1] { side <= 0.0 } else { side >= 0.0 };
        return if beyond { net } else { 0 };
    }
    let (a, b) = cubic.halves();
    crossings(&a, target, depth + 1) + crossings(&b, target, depth + 1)
}

/// Adds up the winding around one point.
struct Winding {
    point: [f64; 2],
    winding: i64,
    start: Point,
    at: Point,
}

impl PolygonSink for Winding {
    fn begin(&mut self, p: Point) {
        self.start = p;
        self.at = p;
    }

    fn line(&mut self, p: Point) {
        self.winding += crossings(&Cubic::new(self.at, self.at, p, p), self.point, 0);
        self.at = p;
    }

    fn end(&mut self) {
        self.line(self.start);
    }
}

/// Collects polygons as closed subpaths.
struct Outline(Path);

impl PolygonSink for Outline {
    fn begin(&mut self, p: Point) {
        self.0.move_to(p);
    }

    fn line(&mut self, p: Point) {
        self.0.line_to(p);
    }

    fn end(&mut self) {
        self.0.close();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::path::{LineCap, LineJoin};

    #[test]
    fn a_squares_left_and_top_edges_are_inside() {
        let mut path = Path::new();
        path.rect(Rect::from_ltrb(1.0, 1.0, 3.0, 3.0));
        for rule in [FillRule::NonZero, FillRule::EvenOdd] {
            for (p, inside) in [
                ((2.0, 2.0), true),
                ((1.0, 2.0), true),
                ((3.0, 2.0), false),
                ((2.0, 1.0), true),
                ((2.0, 3.0), false),
                ((0.9, 2.0), false),
                ((f32::NAN, 2.0), false),
            ] {
                assert_eq!(path.contains(p, rule), inside, "{p:?} {rule:?}");
                assert_eq!(path.reversed().contains(p, rule), inside, "reversed {p:?} {rule:?}");
            }
        }
    }

    #[test]
    fn nested_circles_differ_by_the_rule() {
        let mut path = Path::new();
        path.circle((0.0, 0.0), 4.0).circle((0.0, 0.0), 2.0);
        for (x, nonzero, even_odd) in
            [(0.0, true, false), (1.99, true, false), (2.01, true, true), (4.01, false, false)]
        {
            for (sin, cos) in [(0.0, 1.0), (1.0, 0.0), (0.6, -0.8), (-0.96, 0.28)] {
                let p = Point::new(x * cos, x * sin);
                assert_eq!(path.contains(p, FillRule::NonZero), nonzero, "{p:?}");
                assert_eq!(path.contains(p, FillRule::EvenOdd), even_odd, "{p:?}");
            }
        }
    }

    #[test]
    fn an_open_subpath_is_closed_before_the_next_begins() {
        let mut path = Path::new();
        path.polyline(&[Point::ZERO, Point::new(4.0, 0.0), Point::new(4.0, 4.0)]).move_to((9.0, 9.0));
        assert!(path.contains((3.0, 1.0), FillRule::NonZero));
        assert!(!path.contains((1.0, 3.0), FillRule::NonZero));
    }

    #[test]
    fn a_curves_fill_is_what_a_thousand_chords_enclose() {
        let points = [(0.0, 0.0), (30.0, 20.0), (-25.0, 18.0), (9.0, -7.0)].map(Point::from);
        let mut path = Path::new();
        path.move_to(points[0]).cubic_to(points[1], points[2], points[3]);
        let cubic = Cubic::new(points[0], points[1], points[2], points[3]);
        let chords: Vec<_> = (0..=1000).map(|i| cubic.at(f64::from(i) / 1000.0)).collect();
        let mut polygon = Path::new();
        polygon.polygon(&chords);
        let mut inside = 0;
        for i in 0..60_u8 {
            for j in 0..60_u8 {
                let p = Point::new(f32::from(i) * 0.5 - 10.013, f32::from(j) * 0.5 - 10.017);
                let expected = polygon.contains(p, FillRule::NonZero);
                assert_eq!(path.contains(p, FillRule::NonZero), expected, "{p:?}");
                inside += u32::from(expected);
            }
        }
        assert!(inside > 100, "{inside}");
    }

    #[test]
    fn a_strokes_hits_are_measured_from_its_line() {
        let mut path = Path::new();
        path.move_to((0.0, 0.0)).line_to((1.0, 0.0));
        let butt = Stroke::new(0.1);
        let round = butt.clone().with_cap(LineCap::Round).with_join(LineJoin::Round);
        for (p, in_butt, in_round) in [
            ((0.5, 0.0499), true, true),
            ((0.5, 0.0501), false, false),
            ((-0.04, 0.0), false, true),
            ((1.049, 0.0), false, true),
            ((1.04, 0.04), false, false),
        ] {
            assert_eq!(path.stroke_contains(p, &butt), in_butt, "{p:?}");
            assert_eq!(path.stroke_contains(p, &round), in_round, "{p:?}");
        }
        let dashed = butt.with_dash([0.25, 0.25], 0.0);
        for (x, on) in [(0.1, true), (0.3, false), (0.6, true), (0.9, false)] {
            assert_eq!(path.stroke_contains((x, 0.0), &dashed), on, "{x}");
        }
    }

    #[test]
    fn a_stroked_path_fills_what_the_stroke_covers() {
        let mut path = Path::new();
        path.circle((10.0, 10.0), 6.0);
        let ring = path.stroked(&Stroke::new(2.0), 0.01);
        for (x, inside) in [(10.0, false), (14.9, false), (15.1, true), (16.9, true), (17.1, false)] {
            assert_eq!(ring.contains((x, 10.0), FillRule::NonZero), inside, "{x}");
        }
    }
}
