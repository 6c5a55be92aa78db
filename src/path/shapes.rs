//! Shapes that a path can be given whole: rectangles, arcs, ellipses, polygons.
//!
//! Arcs become cubics of at most 90° with handles of 4/3 · tan(θ/4) radii, which miss the circle by less
//! than 0.03 % of the radius.

use super::Path;
use crate::geom::{Point, Rect, Transform};
use crate::num::trig;

/// The corner radii of a rounded rectangle: one horizontal (x) and one vertical (y) for each corner.
/// Negative radii and those that are not numbers are taken as 0.
///
/// A number gives all corners that radius; four numbers go clockwise from the top left, as in CSS; a
/// pair (rx, ry) gives all corners elliptical ones.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Radii {
    /// Of the corner at the smaller x and the smaller y.
    pub top_left: Point,
    /// Of the corner at the larger x and the smaller y.
    pub top_right: Point,
    /// Of the corner at the larger x and the larger y.
    pub bottom_right: Point,
    /// Of the corner at the smaller x and the larger y.
    pub bottom_left: Point,
}

impl From<f32> for Radii {
    fn from(radius: f32) -> Self {
        Self::from([radius; 4])
    }
}

impl From<(f32, f32)> for Radii {
    fn from(radii: (f32, f32)) -> Self {
        Self::from([Point::from(radii); 4])
    }
}

impl From<[f32; 4]> for Radii {
    fn from(radii: [f32; 4]) -> Self {
        Self::from(radii.map(|r| Point::new(r, r)))
    }
}

impl From<[Point; 4]> for Radii {
    fn from([top_left, top_right, bottom_right, bottom_left]: [Point; 4]) -> Self {
        Self { top_left, top_right, bottom_right, bottom_left }
    }
}

impl Radii {
    /// The radii that fit `rect`: scaled down together until neighbours no longer overlap, as in CSS
    /// (Backgrounds and Borders, 4.5); clockwise from the top left.
    fn fitted(self, width: f32, height: f32) -> [Point; 4] {
        let positive = |r: f32| if r > 0.0 { r } else { 0.0 };
        let radii = [self.top_left, self.top_right, self.bottom_right, self.bottom_left]
            .map(|r| Point::new(positive(r.x), positive(r.y)));
        let [a, b, c, d] = radii;
        let mut factor = 1.0_f64;
        for (size, r, s) in [(width, a.x, b.x), (height, b.y, c.y), (width, c.x, d.x), (height, d.y, a.y)] {
            let (size, sum) = (f64::from(size), f64::from(r) + f64::from(s));
            if sum * factor > size {
                factor = size / sum;
            }
        }
        // A factor over infinite radii is 0: the product would not be a number.
        let scale = |r: f32| {
            let scaled = (f64::from(r) * factor) as f32;
            if scaled.is_finite() { scaled } else { 0.0 }
        };
        radii.map(|r| Point::new(scale(r.x), scale(r.y)))
    }
}

/// The handle of a quarter circle of radius 1: 4/3 · tan(90° / 4).
pub(super) const QUARTER: f32 = 0.552_284_75;

impl Path {
    /// Adds a closed rectangle, clockwise from its top left. One with a non-finite edge adds nothing.
    pub fn rect(&mut self, rect: Rect) -> &mut Self {
        if rect.is_finite() {
            self.polygon(&rect.normalized().corners());
        }
        self
    }

    /// Adds a closed rectangle with rounded corners, clockwise from the right end of its top left corner.
    /// Radii that are too large for the rectangle are scaled down together, as in CSS. A rectangle with a
    /// non-finite edge adds nothing.
    pub fn round_rect(&mut self, rect: Rect, radii: impl Into<Radii>) -> &mut Self {
        let rect = rect.normalized();
        if !(rect.is_finite() && rect.width().is_finite() && rect.height().is_finite()) {
            return self;
        }
        let fitted = radii.into().fitted(rect.width(), rect.height());
        let corners = rect.corners();
        // Along the edge to the corner, and away from it along the next edge, clockwise.
        let (right, down) = (Point::new(1.0, 0.0), Point::new(0.0, 1.0));
        let ways = [(-down, right), (right, down), (down, -right), (-right, -down)];
        let along = |way: Point, r: Point| Point::new(way.x * r.x, way.y * r.y);
        let [first_radius, ..] = fitted;
        self.move_to(Point::new(rect.left + first_radius.x, rect.top));
        // The top left corner comes last.
        for i in [1, 2, 3, 0] {
            let (corner, r, (to, from)) = (corners[i], fitted[i], ways[i]);
            let (start, end) = (corner - along(to, r), corner + along(from, r));
            if self.current_point() != Some(start) {
                self.line_to(start);
            }
            if start != end {
                self.cubic_to(start.lerp(corner, QUARTER), end.lerp(corner, QUARTER), end);
            }
        }
        self.close()
    }

    /// Adds a closed circle. A negative or non-finite radius adds nothing.
    pub fn circle(&mut self, center: impl Into<Point>, radius: f32) -> &mut Self {
        self.ellipse(center, radius, radius)
    }

    /// Adds a closed ellipse with horizontal radius `rx` and vertical radius `ry`, clockwise from its
    /// rightmost point. A negative or non-finite radius adds nothing.
    pub fn ellipse(&mut self, center: impl Into<Point>, rx: f32, ry: f32) -> &mut Self {
        let center = center.into();
        if let Some(arc) = EllipseArc::new(center, rx, ry, 0.0, 0.0, 360.0) {
            self.move_to(arc.point(0.0));
            arc.append(self, None);
            self.close();
        }
        self
    }

    /// Adds a circular arc from `start_degrees` (0 is to the right of the centre) over `sweep_degrees`,
    /// clockwise on the canvas if positive; a line leads to its start if a subpath is open, as on an HTML
    /// canvas. Sweeps beyond ±360° are a whole turn. A negative or non-finite radius or angle adds nothing.
    pub fn arc(&mut self, center: impl Into<Point>, radius: f32, start_degrees: f32, sweep_degrees: f32) -> &mut Self {
        self.ellipse_arc(center, radius, radius, 0.0, start_degrees, sweep_degrees)
    }

    /// Adds an arc of the ellipse with radii `rx` and `ry` whose axes are turned by `rotation_degrees`;
    /// start and sweep are measured on the circle that the ellipse is squeezed from, as on an HTML canvas.
    /// All else is as for [`Path::arc`].
    pub fn ellipse_arc(
        &mut self,
        center: impl Into<Point>,
        rx: f32,
        ry: f32,
        rotation_degrees: f32,
        start_degrees: f32,
        sweep_degrees: f32,
    ) -> &mut Self {
        let arc = EllipseArc::new(center.into(), rx, ry, rotation_degrees, start_degrees, sweep_degrees);
        if let Some(arc) = arc {
            let start = arc.point(0.0);
            if self.is_empty() || self.verbs().last() == Some(&super::Verb::Close) {
                self.move_to(start);
            } else if self.current_point() != Some(start) {
                self.line_to(start);
            }
            arc.append(self, None);
        }
        self
    }

    /// Adds a line and an arc that rounds the corner between the current point, `corner` and `end`: the
    /// arc of the given radius that touches both legs, as `arcTo` of an HTML canvas. Where there is no such
    /// arc (a leg without length, legs in one line, a radius that is not positive) a line to `corner`.
    pub fn arc_to(&mut self, corner: impl Into<Point>, end: impl Into<Point>, radius: f32) -> &mut Self {
        let (corner, end) = (corner.into(), end.into());
        let Some(from) = self.current_point() else {
            return self.move_to(corner);
        };
        let leg = |p: Point| {
            let (x, y) = (f64::from(p.x) - f64::from(corner.x), f64::from(p.y) - f64::from(corner.y));
            let length = (x * x + y * y).sqrt();
            (x / length, y / length)
        };
        let (a, b) = (leg(from), leg(end));
        let (cos, sin) = (a.0 * b.0 + a.1 * b.1, a.0 * b.1 - a.1 * b.0);
        let r = f64::from(radius);
        // 1 / tan of half the angle between the legs.
        let distance = r * (1.0 + cos) / sin.abs();
        if !(radius > 0.0 && distance.is_finite() && sin.abs() > 1e-7) {
            return self.line_to(corner);
        }
        let place = |way: (f64, f64), d: f64| (f64::from(corner.x) + way.0 * d, f64::from(corner.y) + way.1 * d);
        let narrow = |(x, y): (f64, f64)| Point::new(x as f32, y as f32);
        let (start, stop) = (place(a, distance), place(b, distance));
        // Coming along −a and leaving along b, the arc turns clockwise where b lies clockwise of −a.
        let side = if sin < 0.0 { 1.0 } else { -1.0 };
        let center = (start.0 + a.1 * r * side, start.1 - a.0 * r * side);
        let first = trig::atan2(start.1 - center.1, start.0 - center.0);
        let turn = trig::acos(-cos) * side;
        let arc = EllipseArc { center, rx: r, ry: r, axes: (1.0, 0.0), start: first, sweep: turn };
        self.line_to(narrow(start));
        arc.append(self, Some(narrow(stop)));
        self
    }

    /// Adds an elliptical arc from the current point to `end`, as SVG's `A` command: of the four arcs of
    /// an ellipse with the given radii, turned by `rotation_degrees`, that join the two points, the one
    /// longer than 180° if `large_arc`, and clockwise if `sweep`. Radii that are too small are scaled up; a
    /// radius of 0 gives a line (SVG 1.1, appendix F.6).
    pub fn svg_arc_to(
        &mut self,
        rx: f32,
        ry: f32,
        rotation_degrees: f32,
        large_arc: bool,
        sweep: bool,
        end: impl Into<Point>,
    ) -> &mut Self {
        let end = end.into();
        let Some(from) = self.current_point() else {
            return self.move_to(end);
        };
        let (mut rx, mut ry) = (f64::from(rx).abs(), f64::from(ry).abs());
        if from == end {
            return self;
        }
        let finite = rx.is_finite() && ry.is_finite() && rotation_degrees.is_finite();
        if !(rx > 0.0 && ry > 0.0 && finite && from.is_finite() && end.is_finite()) {
            return self.line_to(end);
        }
        let [x0, y0, x1, y1] = [from.x, from.y, end.x, end.y].map(f64::from);
        let axes = sin_cos_degrees(f64::from(rotation_degrees));
        let (sin, cos) = axes;
        // Half the way between the points, in the ellipse's own axes.
        let (dx, dy) = ((x0 - x1) * 0.5, (y0 - y1) * 0.5);
        let (x, y) = (cos * dx + sin * dy, cos * dy - sin * dx);
        let excess = (x / rx) * (x / rx) + (y / ry) * (y / ry);
        if excess > 1.0 {
            rx *= excess.sqrt();
            ry *= excess.sqrt();
        }
        let (u, v) = (x / rx, y / ry);
        let squared = u * u + v * v;
        let offset = if squared < 1.0 { (1.0 / squared - 1.0).sqrt() } else { 0.0 };
        let offset = if large_arc == sweep { -offset } else { offset };
        // The centre on the unit circle's plane.
        let (cu, cv) = (offset * v, -offset * u);
        let (cx, cy) = (cu * rx, cv * ry);
        let center = (cos * cx - sin * cy + (x0 + x1) * 0.5, sin * cx + cos * cy + (y0 + y1) * 0.5);
        let start = trig::atan2(v - cv, u - cu);
        let stop = trig::atan2(-v - cv, -u - cu);
        let turn = 2.0 * std::f64::consts::PI;
        let mut angle = stop - start;
        if sweep && angle < 0.0 {
            angle += turn;
        } else if !sweep && angle > 0.0 {
            angle -= turn;
        }
        // A centre too far to compute leaves the chord.
        if !(angle.is_finite() && center.0.is_finite() && center.1.is_finite()) {
            return self.line_to(end);
        }
        EllipseArc { center, rx, ry, axes: (cos, sin), start, sweep: angle }.append(self, Some(end));
        self
    }

    /// Adds a closed polygon. No point adds nothing.
    pub fn polygon(&mut self, points: &[Point]) -> &mut Self {
        if points.is_empty() {
            return self;
        }
        self.polyline(points).close()
    }

    /// Adds a new open subpath of straight lines. No point adds nothing.
    pub fn polyline(&mut self, points: &[Point]) -> &mut Self {
        if let Some((first, rest)) = points.split_first() {
            self.move_to(*first);
            for p in rest {
                self.line_to(*p);
            }
        }
        self
    }

    /// This path run backwards: each subpath starts at its last point. Subpaths keep their order, and
    /// closed ones stay closed.
    #[must_use]
    pub fn reversed(&self) -> Self {
        let mut path = Self::new();
        let mut steps: Vec<(Point, super::Segment)> = Vec::new();
        let mut at = Point::ZERO;
        let mut start = Point::ZERO;
        let flush = |path: &mut Self, steps: &mut Vec<(Point, super::Segment)>, end: Point, closed: bool| {
            path.move_to(end);
            for (from, segment) in steps.drain(..).rev() {
                match segment {
                    super::Segment::LineTo(_) => path.line_to(from),
                    super::Segment::QuadTo(c, _) => path.quad_to(c, from),
                    super::Segment::CubicTo(c1, c2, _) => path.cubic_to(c2, c1, from),
                    super::Segment::MoveTo(_) | super::Segment::Close => path,
                };
            }
            if closed {
                path.close();
            }
        };
        let mut open = false;
        for segment in self.segments() {
            let next = match segment {
                super::Segment::MoveTo(p) => {
                    if open {
                        flush(&mut path, &mut steps, at, false);
                    }
                    open = true;
                    (start, at) = (p, p);
                    continue;
                }
                super::Segment::Close => {
                    flush(&mut path, &mut steps, at, true);
                    open = false;
                    at = start;
                    continue;
                }
                super::Segment::LineTo(p) | super::Segment::QuadTo(_, p) | super::Segment::CubicTo(_, _, p) => p,
            };
            steps.push((at, segment));
            at = next;
        }
        if open {
            flush(&mut path, &mut steps, at, false);
        }
        path
    }
}

/// Sine and cosine of an angle in degrees; exact at multiples of 90°.
fn sin_cos_degrees(degrees: f64) -> (f64, f64) {
    let t = Transform::from_rotate(degrees as f32);
    let quarters = degrees / 90.0;
    if quarters == quarters.floor() { (f64::from(t.ky), f64::from(t.sx)) } else { trig::sin_cos(degrees.to_radians()) }
}

/// An arc of an ellipse; angles in radians.
struct EllipseArc {
    center: (f64, f64),
    rx: f64,
    ry: f64,
    /// Cosine and sine of the rotation.
    axes: (f64, f64),
    start: f64,
    sweep: f64,
}

impl EllipseArc {
    /// `None` for negative or non-finite values.
    fn new(center: Point, rx: f32, ry: f32, rotation: f32, start: f32, sweep: f32) -> Option<Self> {
        let finite = rx.is_finite() && ry.is_finite() && rotation.is_finite() && start.is_finite();
        if !(rx >= 0.0 && ry >= 0.0 && finite && center.is_finite() && !sweep.is_nan()) {
            return None;
        }
        let (sin, cos) = sin_cos_degrees(f64::from(rotation));
        Some(Self {
            center: (f64::from(center.x), f64::from(center.y)),
            rx: f64::from(rx),
            ry: f64::from(ry),
            axes: (cos, sin),
            start: f64::from(start).to_radians(),
            sweep: f64::from(sweep.clamp(-360.0, 360.0)).to_radians(),
        })
    }

    /// The point at a fraction of the sweep.
    fn point(&self, fraction: f64) -> Point {
        let (sin, cos) = self.sin_cos(fraction);
        self.place(cos, sin)
    }

    /// Sine and cosine at a fraction of the sweep; exact at multiples of 90°.
    fn sin_cos(&self, fraction: f64) -> (f64, f64) {
        let angle = self.start + self.sweep * fraction;
        let quarters = angle / std::f64::consts::FRAC_PI_2;
        let whole = (quarters + 0.5).floor();
        if (quarters - whole).abs() < 1e-12 && whole.abs() < 1e9 {
            sin_cos_degrees(whole * 90.0)
        } else {
            trig::sin_cos(angle)
        }
    }

    /// The image of a point of the unit circle's plane.
    fn place(&self, x: f64, y: f64) -> Point {
        let (x, y) = (x * self.rx, y * self.ry);
        let (cos, sin) = self.axes;
        Point::new((self.center.0 + cos * x - sin * y) as f32, (self.center.1 + sin * x + cos * y) as f32)
    }

    /// Adds the cubics; the last ends at `end`, if given.
    fn append(&self, path: &mut Path, end: Option<Point>) {
        // A little less than 90° is allowed to be rounded up.
        let count = (self.sweep.abs() / (std::f64::consts::FRAC_PI_2 * (1.0 + 1e-9))).ceil();
        if !(count >= 1.0) {
            if let Some(end) = end {
                path.line_to(end);
            }
            return;
        }
        let handle = 4.0 / 3.0 * trig::tan(self.sweep / count * 0.25);
        let (mut sin, mut cos) = self.sin_cos(0.0);
        let count = count as u32;
        for i in 1..=count {
            let (next_sin, next_cos) = self.sin_cos(f64::from(i) / f64::from(count));
            let p = if i == count { end } else { None };
            path.cubic_to(
                self.place(cos - handle * sin, sin + handle * cos),
                self.place(next_cos + handle * next_sin, next_sin - handle * next_cos),
                p.unwrap_or_else(|| self.place(next_cos, next_sin)),
            );
            (sin, cos) = (next_sin, next_cos);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::path::{Segment, Verb};

    /// Points along every segment, close to the curve.
    fn samples(path: &Path) -> Vec<Point> {
        let mut at = Point::ZERO;
        let mut all = Vec::new();
        for segment in path.segments() {
            match segment {
                Segment::MoveTo(p) => at = p,
                Segment::LineTo(p) => {
                    all.extend((0..=16_u8).map(|i| at.lerp(p, f32::from(i) / 16.0)));
                    at = p;
                }
                Segment::CubicTo(a, b, p) => {
                    let cubic = crate::path::curve::Cubic::new(at, a, b, p);
                    all.extend((0..=16).map(|i| cubic.at(f64::from(i) / 16.0)));
                    at = p;
                }
                Segment::QuadTo(..) => unreachable!("no shape is made of quadratic curves"),
                Segment::Close => {}
            }
        }
        all
    }

    #[test]
    fn a_circle_is_round_and_touches_its_box() {
        let mut path = Path::new();
        path.circle((10.0, 20.0), 5.0);
        for p in samples(&path) {
            assert!(((p - Point::new(10.0, 20.0)).length() - 5.0).abs() < 0.0015, "{p:?}");
        }
        assert_eq!(path.verbs().len(), 6);
        assert_eq!(path.bounds(), Some(Rect::from_ltrb(5.0, 15.0, 15.0, 25.0)));
        // Clockwise: from the right to the bottom.
        assert_eq!(path.points()[3], Point::new(10.0, 25.0));
    }

    #[test]
    fn an_arc_starts_and_ends_where_its_angles_say() {
        let mut path = Path::new();
        path.arc((0.0, 0.0), 2.0, 30.0, -200.0);
        let first = path.points()[0];
        let last = *path.points().last().unwrap();
        let at = |degrees: f64| {
            let (sin, cos) = trig::sin_cos(degrees.to_radians());
            Point::new(2.0 * cos as f32, 2.0 * sin as f32)
        };
        assert!((first - at(30.0)).length() < 1e-6 && (last - at(-170.0)).length() < 1e-6);
        assert_eq!(path.verbs()[1..], [Verb::CubicTo; 3]);
        path.arc((0.0, 0.0), 2.0, 0.0, 1e9);
        assert_eq!(path.verbs()[4..], [Verb::LineTo, Verb::CubicTo, Verb::CubicTo, Verb::CubicTo, Verb::CubicTo]);
    }

    #[test]
    fn an_ellipse_arc_lies_on_its_ellipse() {
        let mut path = Path::new();
        path.ellipse_arc((1.0, 2.0), 6.0, 2.0, 40.0, 10.0, 300.0);
        let back = Transform::from_rotate(-40.0);
        for p in samples(&path) {
            let q = back.map(p - Point::new(1.0, 2.0));
            assert!((q.x * q.x / 36.0 + q.y * q.y / 4.0 - 1.0).abs() < 2e-3, "{p:?}");
        }
    }

    #[test]
    fn svg_arcs_choose_their_side_and_length() {
        // From (0, 0) to (2, 2) on circles of radius 2 around (2, 0) and (0, 2).
        let cases = [
            (false, true, (0.0, 2.0), std::f64::consts::PI),
            (false, false, (2.0, 0.0), std::f64::consts::PI),
            (true, true, (2.0, 0.0), 3.0 * std::f64::consts::PI),
            (true, false, (0.0, 2.0), 3.0 * std::f64::consts::PI),
        ];
        for (large, sweep, center, length) in cases {
            let mut path = Path::new();
            path.move_to((0.0, 0.0)).svg_arc_to(2.0, 2.0, 0.0, large, sweep, (2.0, 2.0));
            let center = Point::from(center);
            for p in samples(&path) {
                assert!(((p - center).length() - 2.0).abs() < 1e-3, "{large} {sweep} {p:?}");
            }
            assert!((path.length() - length).abs() < 2e-3, "{large} {sweep} {}", path.length());
        }
    }

    #[test]
    fn svg_arcs_with_small_radii_grow_to_a_half_circle() {
        let mut path = Path::new();
        path.move_to((0.0, 0.0)).svg_arc_to(1.0, 1.0, 25.0, false, true, (6.0, 0.0));
        for p in samples(&path) {
            assert!(((p - Point::new(3.0, 0.0)).length() - 3.0).abs() < 1e-3 && p.y < 1e-4, "{p:?}");
        }
        assert_eq!(path.current_point(), Some(Point::new(6.0, 0.0)));
        let mut line = Path::new();
        line.move_to((0.0, 0.0)).svg_arc_to(0.0, 1.0, 0.0, false, true, (6.0, 0.0));
        assert_eq!(line.verbs(), [Verb::MoveTo, Verb::LineTo]);
    }

    #[test]
    fn arc_to_touches_both_legs() {
        for (end, center, turned_to) in
            [((10.0, 10.0), (7.0, 3.0), (10.0, 3.0)), ((10.0, -10.0), (7.0, -3.0), (10.0, -3.0))]
        {
            let mut path = Path::new();
            path.move_to((0.0, 0.0)).arc_to((10.0, 0.0), end, 3.0);
            assert_eq!(path.verbs(), [Verb::MoveTo, Verb::LineTo, Verb::CubicTo]);
            assert!((path.points()[1] - Point::new(7.0, 0.0)).length() < 1e-5);
            assert!((path.current_point().unwrap() - Point::from(turned_to)).length() < 1e-5);
            for p in &samples(&path)[17..] {
                assert!(((*p - Point::from(center)).length() - 3.0).abs() < 1e-3, "{p:?}");
            }
        }
        let mut straight = Path::new();
        straight.move_to((0.0, 0.0)).arc_to((10.0, 0.0), (20.0, 0.0), 3.0);
        assert_eq!(straight.points(), [Point::ZERO, Point::new(10.0, 0.0)]);
    }

    #[test]
    fn large_radii_are_scaled_down_together() {
        // The left side wants 6 + 18 of 12: every radius is halved.
        let mut path = Path::new();
        path.round_rect(Rect::from_xywh(0.0, 0.0, 40.0, 12.0), [6.0, 2.0, 0.0, 18.0]);
        assert_eq!(path.bounds(), Some(Rect::from_xywh(0.0, 0.0, 40.0, 12.0)));
        let points = path.points();
        assert_eq!(points[0], Point::new(3.0, 0.0));
        assert_eq!(points[1], Point::new(39.0, 0.0));
        assert!(points.contains(&Point::new(9.0, 12.0)) && points.contains(&Point::new(0.0, 3.0)), "{points:?}");
        let mut plain = Path::new();
        plain.round_rect(Rect::from_xywh(0.0, 0.0, 4.0, 4.0), f32::NAN);
        assert_eq!(plain.verbs()[1..4], [Verb::LineTo; 3]);
        let mut infinite = Path::new();
        infinite.round_rect(Rect::from_xywh(0.0, 0.0, 4.0, 4.0), f32::INFINITY);
        assert!(infinite.points().iter().all(|p| p.is_finite()));
    }

    #[test]
    fn reversed_paths_enclose_the_same_with_the_other_winding() {
        let mut path = Path::new();
        path.move_to((0.0, 0.0)).line_to((4.0, 0.0)).quad_to((6.0, 2.0), (4.0, 4.0));
        path.cubic_to((3.0, 5.0), (1.0, 5.0), (0.0, 4.0)).close();
        path.move_to((9.0, 9.0)).line_to((8.0, 7.0));
        let reversed = path.reversed();
        assert_eq!(reversed.points()[0], Point::new(0.0, 4.0));
        assert_eq!(reversed.points()[1..4], [Point::new(1.0, 5.0), Point::new(3.0, 5.0), Point::new(4.0, 4.0)]);
        assert_eq!(reversed.verbs().iter().filter(|v| **v == Verb::Close).count(), 1);
        assert_eq!(reversed.points()[reversed.points().len() - 2..], [Point::new(8.0, 7.0), Point::new(9.0, 9.0)]);
        let mut triangle = Path::new();
        triangle.polygon(&[Point::ZERO, Point::new(3.0, 0.0), Point::new(0.0, 3.0)]);
        assert_eq!(triangle.reversed().reversed(), triangle);
    }

    #[test]
    fn odd_numbers_add_nothing_or_stay_finite() {
        for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
            let mut path = Path::new();
            path.circle((0.0, 0.0), bad).arc((bad, 0.0), 1.0, 0.0, 90.0).arc((0.0, 0.0), 1.0, bad, 90.0);
            path.rect(Rect::from_ltrb(0.0, bad, 1.0, 1.0)).round_rect(Rect::from_ltrb(0.0, bad, 1.0, 1.0), 1.0);
            assert!(path.is_empty(), "{bad}");
        }
        let mut path = Path::new();
        path.circle((0.0, 0.0), -1.0).polygon(&[]).polyline(&[]);
        assert!(path.is_empty());
        path.move_to((0.0, 0.0)).svg_arc_to(1e-30, 1e-38, 10.0, true, true, (1e30, -1e30));
        path.arc_to((1e30, 1e30), (-1e30, 1.0), 1e-30);
        assert!(path.points().iter().all(|p| p.is_finite()), "{path:?}");
    }
}
