//! Strokes: the outline that a pen leaves along a path.
//!
//! Each subpath becomes one polygon, or two if it is closed: the contours to the left and to the right of
//! the line at half its width. The left one is written to the sink as the path is walked, the right one is
//! kept and written backwards. Where a contour would turn back on itself (the inner side of a sharp corner
//! with short legs, a curve tighter than the pen) it goes through the path itself instead, so that every
//! piece of the outline winds the same way: no hole can show under the nonzero rule, whatever overlaps.
//! Raph Levien and Arman Uguray call this property strong correctness ("GPU-friendly Stroke Expansion",
//! 2024); here it is reached for polylines, and for curves after they are cut into steps.

use super::builder::{Verb, segments};
use super::dash::{self, DashScratch};
use super::flatten::PolygonSink;
use super::{LineCap, LineJoin, Segment, Stroke};
use crate::geom::{Point, Rect, Transform};

/// The longest miter that is drawn, as a multiple of half the width, whatever the limit asks for: at
/// sharper corners `f32` no longer knows the direction of the tip.
const LONGEST_MITER: f32 = 1000.0;

/// No polygon point is farther out than this; a stroke that could have one draws nothing.
const FARTHEST: f32 = 1e37;

/// Memory that strokes reuse; after the first few strokes nothing more is allocated.
#[derive(Default)]
pub(crate) struct StrokeScratch {
    /// The right contour of the subpath in work, in device pixels.
    right: Vec<Point>,
    dash: DashScratch,
}

/// Writes the outline of a stroked path to `sink`: polygons in device pixels whose nonzero fill is the
/// stroke. Nothing is written if a point or the transform is not finite, or if the width is negative or
/// not finite.
///
/// The pen is transformed with the path; width 0 is a pen of one device pixel. `tolerance` is the
/// allowed distance from the true outline in device pixels. Only what lies in `visible` (device pixels)
/// has to be right: dashes outside may be left out.
#[expect(clippy::too_many_arguments, reason = "one call from the renderer; a struct would only rename them")]
pub(crate) fn stroke<K: PolygonSink>(
    verbs: &[Verb],
    points: &[Point],
    style: &Stroke,
    transform: Transform,
    tolerance: f32,
    visible: Rect,
    scratch: &mut StrokeScratch,
    sink: &mut K,
) {
    let Some(bounds) = Rect::from_points(points) else { return };
    if !(style.width >= 0.0 && style.width.is_finite() && transform.is_finite()) {
        return;
    }
    let tolerance = if tolerance > 1e-3 { tolerance } else { 1e-3 };
    let hairline = style.width == 0.0;
    let similarity = similarity_scale(transform);
    let (scale, radius) = match similarity {
        _ if hairline => (1.0, 0.5),
        Some(scale) => (scale, style.width * 0.5 * scale),
        None => (transform.scale_range().0, style.width * 0.5),
    };
    let reach = radius * LONGEST_MITER;
    if !(farthest(bounds, transform, if similarity.is_some() || hairline { 0.0 } else { reach }) + reach < FARTHEST) {
        return;
    }
    let in_device = hairline || similarity.is_some();
    let job = Job { verbs, points, style, transform, visible, in_device };
    if in_device {
        let pen = Pen::new(style, radius, tolerance, transform.map_direction(Point::new(1.0, 0.0)));
        job.run(transform, Unmapped, &pen, scratch, sink);
    } else if scale > 0.0 {
        let pen = Pen::new(style, radius, tolerance / scale, Point::new(1.0, 0.0));
        job.run(Unmapped, transform, &pen, scratch, sink);
    }
}

/// An upper bound of the coordinates that points in `bounds`, moved by up to `reach`, are mapped to.
fn farthest(bounds: Rect, t: Transform, reach: f32) -> f32 {
    let larger = |a: f32, b: f32| if a > b { a } else { b };
    let x = larger(bounds.left.abs(), bounds.right.abs()) + reach;
    let y = larger(bounds.top.abs(), bounds.bottom.abs()) + reach;
    let across = t.sx.abs() * x + t.kx.abs() * y + t.tx.abs();
    let down = t.ky.abs() * x + t.sy.abs() * y + t.ty.abs();
    larger(larger(x, y), larger(across, down))
}

/// The factor by which `t` stretches everything, if it stretches all directions alike (to 1e-5).
fn similarity_scale(t: Transform) -> Option<f32> {
    let scale = (t.sx * t.sx + t.ky * t.ky).sqrt();
    let near = |a: f32, b: f32| (a - b).abs() <= 1e-5 * scale;
    let turned = near(t.sx, t.sy) && near(t.kx, -t.ky);
    let mirrored = near(t.sx, -t.sy) && near(t.kx, t.ky);
    (scale > 0.0 && scale.is_finite() && (turned || mirrored)).then_some(scale)
}

/// How points travel from one space to the next.
pub(super) trait PointMap: Copy {
    fn map_point(self, p: Point) -> Point;
    fn map_direction(self, v: Point) -> Point;
}

/// Points stay as they are.
#[derive(Clone, Copy)]
pub(super) struct Unmapped;

impl PointMap for Unmapped {
    #[inline(always)]
    fn map_point(self, p: Point) -> Point {
        p
    }

    fn map_direction(self, v: Point) -> Point {
        v
    }
}

impl PointMap for Transform {
    #[inline(always)]
    fn map_point(self, p: Point) -> Point {
        self.map(p)
    }

    fn map_direction(self, v: Point) -> Point {
        unit(self.map_vector(v), 0.0).map_or(v, |(d, _)| d)
    }
}

/// One call of [`stroke`] after its checks.
pub(super) struct Job<'a> {
    verbs: &'a [Verb],
    points: &'a [Point],
    style: &'a Stroke,
    pub(super) transform: Transform,
    /// Device pixels that have to be right.
    pub(super) visible: Rect,
    /// Whether contours are offset in device space, not in user space.
    pub(super) in_device: bool,
}

impl<'a> Job<'a> {
    /// The path's subpaths, in order.
    pub(super) fn subpaths(&self) -> Subpaths<'a> {
        Subpaths { verbs: self.verbs, points: self.points, start: Point::ZERO }
    }

    /// Strokes in the space that `before` maps to; `after` maps from there to device pixels.
    fn run<B: PointMap, A: PointMap, K: PolygonSink>(
        &self,
        before: B,
        after: A,
        pen: &Pen,
        scratch: &mut StrokeScratch,
        sink: &mut K,
    ) {
        let mut outliner = Outliner::new(*pen, after, &mut scratch.right, sink);
        if let Some(dash) = &self.style.dash
            && dash::dash(self, dash, before, &mut scratch.dash, &mut outliner)
        {
            return;
        }
        for subpath in self.subpaths() {
            outliner.begin(before.map_point(subpath.start), subpath.closed);
            for segment in subpath.segments() {
                match segment {
                    Segment::LineTo(p) => outliner.line(before.map_point(p)),
                    Segment::QuadTo(c, p) => outliner.quad(before.map_point(c), before.map_point(p)),
                    Segment::CubicTo(c1, c2, p) => {
                        outliner.cubic(before.map_point(c1), before.map_point(c2), before.map_point(p));
                    }
                    Segment::MoveTo(_) | Segment::Close => {}
                }
            }
            outliner.finish();
        }
    }
}

/// The subpaths of a path that draw something: a move alone is none.
pub(super) struct Subpaths<'a> {
    verbs: &'a [Verb],
    points: &'a [Point],
    start: Point,
}

/// A move, the segments after it and whether a close ends them.
#[derive(Clone, Copy)]
pub(super) struct Subpath<'a> {
    pub(super) start: Point,
    verbs: &'a [Verb],
    points: &'a [Point],
    pub(super) closed: bool,
}

impl<'a> Subpath<'a> {
    /// Its lines and curves; the line that closes it is not among them.
    pub(super) fn segments(&self) -> impl Iterator<Item = Segment> + 'a {
        segments(self.verbs, self.points)
    }
}

impl<'a> Iterator for Subpaths<'a> {
    type Item = Subpath<'a>;

    fn next(&mut self) -> Option<Subpath<'a>> {
        loop {
            let (verb, verbs) = self.verbs.split_first()?;
            if *verb == Verb::MoveTo {
                let (start, points) = self.points.split_first()?;
                self.start = *start;
                self.verbs = verbs;
                self.points = points;
            }
            let mut used = 0;
            let mut length = self.verbs.len();
            let mut closed = false;
            for (i, verb) in self.verbs.iter().enumerate() {
                used += match verb {
                    Verb::LineTo => 1,
                    Verb::QuadTo => 2,
                    Verb::CubicTo => 3,
                    Verb::MoveTo | Verb::Close => {
                        length = i;
                        closed = *verb == Verb::Close;
                        break;
                    }
                };
            }
            let (body, verbs) = self.verbs.split_at_checked(length)?;
            let (points, rest) = self.points.split_at_checked(used)?;
            self.verbs = verbs.get(usize::from(closed)..)?;
            self.points = rest;
            if closed || !body.is_empty() {
                return Some(Subpath { start: self.start, verbs: body, points, closed });
            }
        }
    }
}

/// Steps of a half turn, with cosine and sine of one step. More steps than 512 are never used.
const HALF_TURNS: [(u32, f32, f32); 19] = [
    (2, 0.0, 1.0),
    (3, 0.5, 0.866_025_4),
    (4, 0.707_106_8, 0.707_106_8),
    (5, 0.809_017, 0.587_785_24),
    (6, 0.866_025_4, 0.5),
    (7, 0.900_968_85, 0.433_883_73),
    (8, 0.923_879_5, 0.382_683_43),
    (10, 0.951_056_54, 0.309_017),
    (12, 0.965_925_8, 0.258_819_04),
    (14, 0.974_927_9, 0.222_520_93),
    (16, 0.980_785_25, 0.195_090_32),
    (20, 0.987_688_36, 0.156_434_47),
    (24, 0.991_444_9, 0.130_526_2),
    (32, 0.995_184_7, 0.098_017_14),
    (48, 0.997_858_9, 0.065_403_13),
    (64, 0.998_795_44, 0.049_067_676),
    (128, 0.999_698_8, 0.024_541_229),
    (256, 0.999_924_7, 0.012_271_538),
    (512, 0.999_981_16, 0.006_135_885),
];

/// A turn by a fixed angle, of which a whole number makes a half turn.
#[derive(Clone, Copy)]
struct ArcStep {
    half_turn: u32,
    cos: f32,
    sin: f32,
}

impl ArcStep {
    /// The largest step whose chords stay within `tolerance` of a circle.
    fn new(radius: f32, tolerance: f32) -> Self {
        // A chord over the angle θ is r (1 − cos θ/2) inside the arc, and cos θ = 2 cos² θ/2 − 1.
        let half_cos = 1.0 - tolerance / radius;
        let least = if half_cos > 0.0 { 2.0 * half_cos * half_cos - 1.0 } else { -1.0 };
        let mut step = Self { half_turn: 2, cos: 0.0, sin: 1.0 };
        for (half_turn, cos, sin) in HALF_TURNS {
            step = Self { half_turn, cos, sin };
            if cos >= least {
                break;
            }
        }
        step
    }

    /// `v` turned clockwise on the canvas, or the other way.
    #[inline(always)]
    fn turn(self, v: Point, clockwise: bool) -> Point {
        let sin = if clockwise { self.sin } else { -self.sin };
        Point::new(v.x * self.cos - v.y * sin, v.x * sin + v.y * self.cos)
    }
}

/// What is the same for all subpaths of a stroke, in the space in which contours are offset.
#[derive(Clone, Copy)]
pub(super) struct Pen {
    pub(super) radius: f32,
    tolerance: f32,
    cap: LineCap,
    join: LineJoin,
    /// At least 1.
    miter_limit: f32,
    /// Segments shorter than this are left out: their direction is rounding noise.
    pub(super) shortest: f32,
    arc: ArcStep,
    /// Largest 1 − cos of the angle that a curve may turn by in one step.
    turn: f32,
    /// The radius in the error estimate of curves: bounded, so that the number of steps is.
    turn_radius: f32,
    /// The direction of squares that stand for subpaths without one.
    pub(super) axis: Point,
}

impl Pen {
    fn new(style: &Stroke, radius: f32, tolerance: f32, axis: Point) -> Self {
        let limit = style.miter_limit;
        let miter_limit = if limit > 1.0 { limit } else { 1.0 };
        let arc = ArcStep::new(radius, tolerance);
        // 1 − cos grows with the square of the angle: twice the arc's is 1.4 times its angle, at most 60°.
        let turn = 2.0 * (1.0 - arc.cos);
        Self {
            radius,
            tolerance,
            cap: style.cap,
            join: style.join,
            miter_limit: if miter_limit < LONGEST_MITER { miter_limit } else { LONGEST_MITER },
            shortest: tolerance * (1.0 / 1024.0),
            arc,
            turn: if turn < 0.5 { turn } else { 0.5 },
            // 8 tolerance / angle² with the angle of 1/1024 turn.
            turn_radius: if radius < tolerance * 2e5 { radius } else { tolerance * 2e5 },
            axis,
        }
    }

    /// How far from the path the pen's mark can reach.
    pub(super) fn reach(&self) -> f32 {
        let join = match self.join {
            LineJoin::Miter | LineJoin::MiterClip => self.miter_limit,
            LineJoin::Round | LineJoin::Bevel => 1.0,
        };
        self.radius * if join > 1.5 { join } else { 1.5 }
    }
}

/// The unit vector along `v` and the length of `v`; `None` where it is not longer than `shortest`.
#[inline(always)]
fn unit(v: Point, shortest: f32) -> Option<(Point, f32)> {
    let squared = v.dot(v);
    // Outside this range the square has lost its digits.
    if squared > 1e-30 && squared < 1e37 {
        let length = squared.sqrt();
        (length > shortest).then(|| (v * (1.0 / length), length))
    } else {
        unit_of_extreme(v, shortest)
    }
}

#[cold]
fn unit_of_extreme(v: Point, shortest: f32) -> Option<(Point, f32)> {
    let (x, y) = (f64::from(v.x), f64::from(v.y));
    let length = (x * x + y * y).sqrt();
    (length > f64::from(shortest)).then(|| (Point::new((x / length) as f32, (y / length) as f32), length as f32))
}

/// The right-hand normal on the canvas: `v` turned by a quarter clockwise.
#[inline(always)]
fn right_of(v: Point) -> Point {
    Point::new(-v.y, v.x)
}

/// The greatest absolute coordinate.
#[inline(always)]
fn farthest_of(points: [Point; 4]) -> f32 {
    let mut farthest = 0.0;
    for p in points {
        for v in [p.x.abs(), p.y.abs()] {
            farthest = if v > farthest { v } else { farthest };
        }
    }
    farthest
}

/// Walks subpaths and writes their outlines.
pub(super) struct Outliner<'a, A: PointMap, K: PolygonSink> {
    pub(super) pen: Pen,
    after: A,
    sink: &'a mut K,
    right: &'a mut Vec<Point>,
    closed: bool,
    /// Whether a polygon is begun in the sink.
    begun: bool,
    /// The subpath's first point.
    start: Point,
    /// Direction and length of its first step; meaningless until `walking`.
    first: (Point, f32),
    walking: bool,
    /// Where the pen is, and the direction and length of the step that led there. The contours have not
    /// got there yet: the next join or cap writes their points.
    at: Point,
    last: (Point, f32),
}

impl<'a, A: PointMap, K: PolygonSink> Outliner<'a, A, K> {
    fn new(pen: Pen, after: A, right: &'a mut Vec<Point>, sink: &'a mut K) -> Self {
        right.clear();
        let none = (Point::ZERO, 0.0);
        Self {
            pen,
            after,
            sink,
            right,
            closed: false,
            begun: false,
            start: Point::ZERO,
            first: none,
            walking: false,
            at: Point::ZERO,
            last: none,
        }
    }

    /// Starts a subpath; [`Outliner::finish`] ends it.
    pub(super) fn begin(&mut self, p: Point, closed: bool) {
        self.closed = closed;
        self.begun = false;
        self.walking = false;
        self.start = p;
        self.at = p;
        self.right.clear();
    }

    /// A straight line to `p`.
    #[inline(always)]
    pub(super) fn line(&mut self, p: Point) {
        if let Some((d, length)) = unit(p - self.at, self.pen.shortest) {
            self.depart(d, length);
            self.at = p;
            self.last = (d, length);
        }
    }

    /// A quadratic curve, as the cubic that is the same curve.
    pub(super) fn quad(&mut self, c: Point, p: Point) {
        self.cubic(self.at.lerp(c, 2.0 / 3.0), p.lerp(c, 2.0 / 3.0), p);
    }

    /// A cubic curve, in steps whose chords stay within the tolerance of both contours.
    pub(super) fn cubic(&mut self, c1: Point, c2: Point, end: Point) {
        /// No curve is cut finer.
        const FINEST: f32 = 1.0 / 4096.0;
        let origin = self.at;
        if !(farthest_of([origin, c1, c2, end]) < 1e15) {
            return self.cubic_of_extremes(c1, c2, end);
        }
        let (e1, e2, e3) = (c1 - origin, c2 - origin, end - origin);
        let shortest = self.pen.shortest;
        let first_unit = |a, b, c| unit(a, shortest).or_else(|| unit(b, shortest)).or_else(|| unit(c, shortest));
        let Some((start_direction, _)) = first_unit(e1, e2, e3) else { return };
        let end_direction = first_unit(e3 - e2, e3 - e1, e3).map_or(start_direction, |(d, _)| d);
        let curve = Coefficients::new(e1, e2, e3);
        let radius = self.pen.radius;
        let tolerance = self.pen.tolerance;
        let bend = curve.greatest_bend();
        // A chord is never farther from the curve than step² · |C″| / 8. The estimate below is finer, but
        // looks at the ends of a step alone: this bounds its error to twice the tolerance.
        let longest_step = (16.0 * tolerance / bend).sqrt();
        let longest_step = if longest_step < 1.0 { longest_step } else { 1.0 };

        let mut t = 0.0_f32;
        let mut p = origin;
        let mut direction = start_direction;
        let mut velocity = curve.velocity(0.0);
        let mut density = self.error_density(velocity, curve.acceleration(0.0));
        let mut step = (8.0 * tolerance / density).sqrt();
        let mut arrived = false;
        // Each round advances or halves the step, which stays above FINEST / 2.
        while !arrived {
            step = if step < longest_step { step } else { longest_step };
            step = if step > FINEST { step } else { FINEST };
            let rest = 1.0 - t;
            // Two equal steps to the end instead of a long one and a crumb.
            let even = if step >= rest {
                rest
            } else if step * 2.0 > rest {
                rest * 0.5
            } else {
                step
            };
            let last = even == rest;
            let next_t = if last { 1.0 } else { t + even };
            let next_velocity = curve.velocity(next_t);
            let (next_p, next_direction) = if last {
                (end, end_direction)
            } else {
                let d = unit(next_velocity, shortest).map_or(direction, |(d, _)| d);
                (origin + curve.position(next_t), d)
            };
            let next_density = self.error_density(next_velocity, curve.acceleration(next_t));
            let kink = 1.0 - direction.dot(next_direction) > self.pen.turn;
            let rough = even * even * (density + next_density) > 24.0 * tolerance;
            if (kink || rough) && even > FINEST {
                // Within a step this short, the shape of the turn does not show.
                let travel = even * (velocity.length() + even * bend);
                if travel > tolerance * 0.25 {
                    step = even * 0.5;
                    continue;
                }
            }
            let chord = next_p - p;
            let length = chord.length();
            if t == 0.0 {
                self.depart(start_direction, length);
            }
            if kink {
                self.offset(next_p, direction);
                self.at = next_p;
                self.round_corner(direction, next_direction);
            } else {
                let (from, to) = (right_of(direction) * radius, right_of(next_direction) * radius);
                self.fold(p, next_p, chord, length, to - from);
            }
            if !last {
                self.offset(next_p, next_direction);
            }
            arrived = last;
            self.last = (next_direction, length);
            self.at = next_p;
            t = next_t;
            p = next_p;
            direction = next_direction;
            velocity = next_velocity;
            density = next_density;
            step = (8.0 * tolerance / density).sqrt();
        }
        self.at = end;
    }

    /// A cubic with coordinates whose products overflow: lines between points evenly spaced in t.
    #[cold]
    fn cubic_of_extremes(&mut self, c1: Point, c2: Point, end: Point) {
        let start = self.at;
        for i in 1..64_u8 {
            let t = f32::from(i) / 64.0;
            let (a, b, c) = (start.lerp(c1, t), c1.lerp(c2, t), c2.lerp(end, t));
            self.line(a.lerp(b, t).lerp(b.lerp(c, t), t));
        }
        self.line(end);
    }

    /// The distance between the outer contour and its chord, over the step's square and times 8: at
    /// speed s and angular speed ω it is s·ω for the curve and r·ω² for the pen.
    #[inline(always)]
    fn error_density(&self, velocity: Point, acceleration: Point) -> f32 {
        let squared = velocity.dot(velocity);
        if squared > 1e-20 {
            let cross = velocity.cross(acceleration).abs();
            let angular = cross / squared;
            cross / squared.sqrt() + self.pen.turn_radius * angular * angular
        } else {
            0.0
        }
    }

    /// Ends the subpath: caps, or the closing line and its joins.
    pub(super) fn finish(&mut self) {
        if self.closed {
            self.line(self.start);
        }
        if !self.walking {
            self.dot(self.start, self.pen.axis);
            return;
        }
        if self.closed {
            self.at = self.start;
            let (d, length) = self.first;
            self.join(d, length);
            self.sink.end();
            let mut points = self.right.iter().rev();
            if let Some(p) = points.next() {
                self.sink.begin(*p);
                points.for_each(|p| self.sink.line(*p));
                self.sink.end();
            }
        } else {
            let (start, at) = (self.start, self.at);
            self.cap(at, self.last.0, false);
            for p in self.right.iter().rev() {
                self.sink.line(*p);
            }
            if self.pen.cap == LineCap::Round {
                self.half_circle(start, -self.first.0);
            }
            self.sink.end();
        }
        self.begun = false;
    }

    /// The mark of a subpath or dash without length: a disc, a square along `direction`, or nothing.
    pub(super) fn dot(&mut self, p: Point, direction: Point) {
        let along = direction * self.pen.radius;
        let right = right_of(along);
        match self.pen.cap {
            LineCap::Butt => return,
            LineCap::Square => {
                self.begun = false;
                self.left(p - along - right);
                self.left(p + along - right);
                self.left(p + along + right);
                self.left(p - along + right);
            }
            LineCap::Round => {
                self.begun = false;
                self.left(p - right);
                self.half_circle(p, direction);
                self.left(p + right);
                self.half_circle(p, -direction);
            }
        }
        self.sink.end();
        self.begun = false;
    }

    /// Leaves the current point in direction `d` for a step of `length`: the join there, or the start.
    #[inline(always)]
    fn depart(&mut self, d: Point, length: f32) {
        if self.walking {
            self.join(d, length);
        } else {
            self.walking = true;
            self.first = (d, length);
            if !self.closed {
                self.cap(self.at, d, true);
            }
        }
    }

    /// The two corners of an end, and the half circle of a round one; that of the start comes last of all,
    /// when the outline is back there.
    #[inline(always)]
    fn cap(&mut self, p: Point, d: Point, at_start: bool) {
        let along = d * self.pen.radius;
        let right = right_of(along);
        let p = match self.pen.cap {
            LineCap::Square if at_start => p - along,
            LineCap::Square => p + along,
            LineCap::Butt | LineCap::Round => p,
        };
        self.left(p - right);
        self.right(p + right);
        if self.pen.cap == LineCap::Round && !at_start {
            self.half_circle(p, d);
        }
    }

    /// The points between the left and the right end of a half circle around `p` that bulges along `d`.
    fn half_circle(&mut self, p: Point, d: Point) {
        let mut v = -right_of(d);
        for _ in 1..self.pen.arc.half_turn {
            v = self.pen.arc.turn(v, true);
            self.left(p + v * self.pen.radius);
        }
    }

    /// Writes both contours at `p`, where the path goes in direction `d`.
    #[inline(always)]
    fn offset(&mut self, p: Point, d: Point) {
        let right = right_of(d) * self.pen.radius;
        self.left(p - right);
        self.right(p + right);
    }

    /// Keeps a contour from running backwards between two points of a curve that is tighter than the
    /// pen: it visits the path, then the chord's own rectangle, and the path again.
    #[inline(always)]
    fn fold(&mut self, from: Point, to: Point, chord: Point, length: f32, change: Point) {
        let forward = length * length;
        let gain = chord.dot(change);
        if gain.abs() > forward {
            let side = right_of(chord) * (self.pen.radius / length);
            if !side.is_finite() {
                return;
            }
            let right = gain < 0.0;
            let side = if right { side } else { -side };
            for p in [from, from + side, to + side, to] {
                self.push(right, p);
            }
        }
    }

    /// Joins the last step to one in direction `d` of the given length.
    #[inline(always)]
    fn join(&mut self, d: Point, length: f32) {
        let pen = &self.pen;
        let (d0, length0) = self.last;
        let radius = pen.radius;
        let cos = d0.dot(d);
        let (from, to) = (right_of(d0) * radius, right_of(d) * radius);
        // The contours of the two steps meet at ±tip: on the outer side that is the miter, on the inner
        // side the corner itself, if it is not farther along the steps than half their length.
        let whole = 1.0 + cos;
        let tip = (from + to) * (1.0 / whole);
        let shorter = if length < length0 { length } else { length0 };
        let inner_meets = cos > -0.999 && 4.0 * radius * radius * (1.0 - cos) <= shorter * shorter * whole;
        // Where miter, arc and bevel differ by less than the tolerance, the miter is one point.
        let slight = cos > 0.0 && radius * (1.0 - cos) <= pen.tolerance;
        let miter = matches!(pen.join, LineJoin::Miter | LineJoin::MiterClip)
            && 2.0 <= pen.miter_limit * pen.miter_limit * whole;
        let at = self.at;
        if inner_meets && (slight || miter) {
            self.left(at - tip);
            self.right(at + tip);
        } else {
            self.corner(d, inner_meets, slight || miter);
        }
    }

    /// A join whose sides differ.
    fn corner(&mut self, d: Point, inner_meets: bool, miter: bool) {
        let (at, d0, radius) = (self.at, self.last.0, self.pen.radius);
        let cos = d0.dot(d);
        let (from, to) = (right_of(d0) * radius, right_of(d) * radius);
        let tip = (from + to) * (1.0 / (1.0 + cos));
        let clockwise = d0.cross(d) >= 0.0;
        // Turning clockwise, the right side is the inner one.
        let side = if clockwise { 1.0 } else { -1.0 };
        if inner_meets {
            self.push(clockwise, at + tip * side);
        } else {
            self.push(clockwise, at + from * side);
            self.push(clockwise, at);
            self.push(clockwise, at + to * side);
        }
        let outer = !clockwise;
        if miter {
            self.push(outer, at - tip * side);
            return;
        }
        self.push(outer, at - from * side);
        match self.pen.join {
            LineJoin::Round => self.arc(outer, d0, d, clockwise),
            LineJoin::MiterClip => {
                // Cut at limit · r from the corner, across the line that halves the angle.
                let half_cos = (0.5 * (1.0 + if cos > -1.0 { cos } else { -1.0 })).sqrt();
                let half_sin = (0.5 * (1.0 - cos)).sqrt();
                let along = radius * (self.pen.miter_limit - half_cos) / half_sin;
                if along.is_finite() {
                    self.push(outer, at - from * side + d0 * along);
                    self.push(outer, at - to * side - d * along);
                }
            }
            LineJoin::Miter | LineJoin::Bevel => {}
        }
        self.push(outer, at - to * side);
    }

    /// A round join at the current point where a curve turns from `d0` to `d` on the spot.
    fn round_corner(&mut self, d0: Point, d: Point) {
        let clockwise = d0.cross(d) >= 0.0;
        let side = if clockwise { self.pen.radius } else { -self.pen.radius };
        self.push(clockwise, self.at);
        self.arc(!clockwise, d0, d, clockwise);
        self.push(clockwise, self.at + right_of(d) * side);
        self.push(!clockwise, self.at - right_of(d) * side);
    }

    /// The points between the ends of an arc around the current point, on the outer side of a turn from
    /// direction `d0` to `d`.
    fn arc(&mut self, right: bool, d0: Point, d: Point, clockwise: bool) {
        let (arc, at) = (self.pen.arc, self.at);
        let reach = if clockwise { -self.pen.radius } else { self.pen.radius };
        // A rest of up to 1.05 steps is the last one: no crumb from rounding.
        let near = arc.cos - 0.1 * (1.0 - arc.cos);
        let mut v = d0;
        for _ in 1..arc.half_turn {
            if v.dot(d) >= near {
                break;
            }
            v = arc.turn(v, clockwise);
            self.push(right, at + right_of(v) * reach);
        }
    }

    #[inline(always)]
    fn push(&mut self, right: bool, p: Point) {
        if right { self.right(p) } else { self.left(p) }
    }

    #[inline(always)]
    fn left(&mut self, p: Point) {
        let p = self.after.map_point(p);
        if self.begun {
            self.sink.line(p);
        } else {
            self.begun = true;
            self.sink.begin(p);
        }
    }

    #[inline(always)]
    fn right(&mut self, p: Point) {
        self.right.push(self.after.map_point(p));
    }
}

/// A cubic as a polynomial, relative to its first point.
struct Coefficients {
    a: Point,
    b: Point,
    c: Point,
}

impl Coefficients {
    fn new(e1: Point, e2: Point, e3: Point) -> Self {
        Self { a: e3 - e2 * 3.0 + e1 * 3.0, b: e2 * 3.0 - e1 * 6.0, c: e1 * 3.0 }
    }

    #[inline(always)]
    fn position(&self, t: f32) -> Point {
        ((self.a * t + self.b) * t + self.c) * t
    }

    #[inline(always)]
    fn velocity(&self, t: f32) -> Point {
        (self.a * (3.0 * t) + self.b * 2.0) * t + self.c
    }

    #[inline(always)]
    fn acceleration(&self, t: f32) -> Point {
        self.a * (6.0 * t) + self.b * 2.0
    }

    /// The greatest |C″|: it is linear in t, so at an end.
    fn greatest_bend(&self) -> f32 {
        let (start, end) = (self.acceleration(0.0).length(), self.acceleration(1.0).length());
        if start > end { start } else { end }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::path::Path;

    /// Polygons as lists of points.
    #[derive(Default)]
    struct Polygons {
        done: Vec<Vec<Point>>,
        open: Option<Vec<Point>>,
    }

    impl PolygonSink for Polygons {
        fn begin(&mut self, p: Point) {
            assert!(self.open.is_none() && p.is_finite(), "{p:?}");
            self.open = Some(vec![p]);
        }
        fn line(&mut self, p: Point) {
            assert!(p.is_finite());
            self.open.as_mut().unwrap().push(p);
        }
        fn end(&mut self) {
            self.done.push(self.open.take().unwrap());
        }
    }

    const EVERYWHERE: Rect = Rect::from_ltrb(-1e9, -1e9, 1e9, 1e9);

    fn outline(path: &Path, style: &Stroke, transform: Transform, tolerance: f32) -> Vec<Vec<Point>> {
        let mut sink = Polygons::default();
        let mut scratch = StrokeScratch::default();
        stroke(path.verbs(), path.points(), style, transform, tolerance, EVERYWHERE, &mut scratch, &mut sink);
        assert!(sink.open.is_none());
        sink.done
    }

    fn points(list: &[(f32, f32)]) -> Vec<Point> {
        list.iter().map(|p| Point::from(*p)).collect()
    }

    /// The winding of polygons around a point, edge by edge.
    fn winding(polygons: &[Vec<Point>], p: Point) -> i32 {
        let mut winding = 0;
        for polygon in polygons {
            for (i, a) in polygon.iter().enumerate() {
                let b = polygon[(i + 1) % polygon.len()];
                let side = f64::from(b.x - a.x) * f64::from(p.y - a.y) - f64::from(p.x - a.x) * f64::from(b.y - a.y);
                if a.y <= p.y && b.y > p.y && side > 0.0 {
                    winding += 1;
                }
                if a.y > p.y && b.y <= p.y && side < 0.0 {
                    winding -= 1;
                }
            }
        }
        winding
    }

    /// The distance from a point to a line segment.
    fn distance(a: Point, b: Point, p: Point) -> f32 {
        let (v, w) = (b - a, p - a);
        let t = if v.dot(v) > 0.0 { (w.dot(v) / v.dot(v)).clamp(0.0, 1.0) } else { 0.0 };
        (w - v * t).length()
    }

    /// The distance from a point to the nearest edge of any polygon.
    fn boundary_distance(polygons: &[Vec<Point>], p: Point) -> f32 {
        let mut nearest = f32::MAX;
        for polygon in polygons {
            for (i, a) in polygon.iter().enumerate() {
                nearest = nearest.min(distance(*a, polygon[(i + 1) % polygon.len()], p));
            }
        }
        nearest
    }

    /// Numbers in 0 ..< 1 (SplitMix64).
    struct Random(u64);

    impl Random {
        fn next(&mut self) -> f32 {
            self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
            let mut z = self.0;
            z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
            z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
            ((z ^ (z >> 31)) >> 40) as f32 / 16_777_216.0
        }
        fn point(&mut self, size: f32) -> Point {
            Point::new(self.next() * size, self.next() * size)
        }
    }

    /// A path's lines and curves as chains of 200 chords each, in `f64` de Casteljau.
    fn chords(path: &Path) -> Vec<(Point, Point)> {
        let mut chords = Vec::new();
        let (mut at, mut start) = (Point::ZERO, Point::ZERO);
        for segment in path.segments() {
            let cubic = match segment {
                Segment::MoveTo(p) => {
                    (at, start) = (p, p);
                    continue;
                }
                Segment::LineTo(p) => [at, at, p, p],
                Segment::Close => [at, at, start, start],
                Segment::QuadTo(c, p) => [at, at.lerp(c, 2.0 / 3.0), p.lerp(c, 2.0 / 3.0), p],
                Segment::CubicTo(c1, c2, p) => [at, c1, c2, p],
            };
            let curve = super::super::curve::Cubic::new(cubic[0], cubic[1], cubic[2], cubic[3]);
            let mut last = at;
            for i in 1..=200 {
                let p = curve.at(f64::from(i) / 200.0);
                chords.push((last, p));
                last = p;
            }
            at = cubic[3];
        }
        chords
    }

    #[test]
    fn half_turn_steps_are_those_of_trigonometry() {
        for (steps, cos, sin) in HALF_TURNS {
            let (true_sin, true_cos) = crate::num::trig::sin_cos(std::f64::consts::PI / f64::from(steps));
            assert!((f64::from(cos) - true_cos).abs() < 1e-7, "{steps}");
            assert!((f64::from(sin) - true_sin).abs() < 1e-7, "{steps}");
        }
    }

    #[test]
    fn a_segment_with_butt_caps_is_four_points() {
        let mut path = Path::new();
        path.move_to((1.0, 5.0)).line_to((9.0, 5.0));
        let got = outline(&path, &Stroke::new(2.0), Transform::IDENTITY, 0.1);
        assert_eq!(got, [points(&[(1.0, 4.0), (9.0, 4.0), (9.0, 6.0), (1.0, 6.0)])]);
    }

    #[test]
    fn a_square_cap_adds_half_the_width() {
        let mut path = Path::new();
        path.move_to((1.0, 5.0)).line_to((9.0, 5.0));
        let got = outline(&path, &Stroke::new(2.0).with_cap(LineCap::Square), Transform::IDENTITY, 0.1);
        assert_eq!(got, [points(&[(0.0, 4.0), (10.0, 4.0), (10.0, 6.0), (0.0, 6.0)])]);
    }

    #[test]
    fn a_right_angle_with_a_miter_is_six_points() {
        let mut path = Path::new();
        path.move_to((0.0, 0.0)).line_to((10.0, 0.0)).line_to((10.0, 10.0));
        let got = outline(&path, &Stroke::new(2.0), Transform::IDENTITY, 0.1);
        assert_eq!(got, [points(&[(0.0, -1.0), (11.0, -1.0), (11.0, 10.0), (9.0, 10.0), (9.0, 1.0), (0.0, 1.0)])]);
    }

    #[test]
    fn a_square_is_two_contours_that_wind_against_each_other() {
        let mut path = Path::new();
        path.move_to((0.0, 0.0)).line_to((10.0, 0.0)).line_to((10.0, 10.0)).line_to((0.0, 10.0)).close();
        let got = outline(&path, &Stroke::new(2.0), Transform::IDENTITY, 0.1);
        assert_eq!(
            got,
            [
                points(&[(11.0, -1.0), (11.0, 11.0), (-1.0, 11.0), (-1.0, -1.0)]),
                points(&[(1.0, 1.0), (1.0, 9.0), (9.0, 9.0), (9.0, 1.0)]),
            ]
        );
    }

    #[test]
    fn a_miter_over_the_limit_is_a_bevel_or_cut_at_the_limit() {
        // The miter of a right angle is √2 times half the width long.
        let mut path = Path::new();
        path.move_to((0.0, 0.0)).line_to((10.0, 0.0)).line_to((10.0, 10.0));
        let bevel = outline(&path, &Stroke::new(2.0).with_miter_limit(1.4), Transform::IDENTITY, 0.01);
        let bevel_points =
            points(&[(0.0, -1.0), (10.0, -1.0), (11.0, 0.0), (11.0, 10.0), (9.0, 10.0), (9.0, 1.0), (0.0, 1.0)]);
        assert_eq!(bevel, [bevel_points]);
        let style = Stroke::new(2.0).with_join(LineJoin::MiterClip).with_miter_limit(1.2);
        let clipped = outline(&path, &style, Transform::IDENTITY, 0.01);
        // Both cut points lie on x − y = const, 1.2 from the corner along its diagonal, on the square's sides.
        let (a, b) = (clipped[0][2], clipped[0][3]);
        assert!((a.y + 1.0).abs() < 1e-5 && (b.x - 11.0).abs() < 1e-5, "{clipped:?}");
        for p in [a, b] {
            assert!((((p.x - 10.0) - p.y) / 2.0_f32.sqrt() - 1.2).abs() < 1e-5, "{p:?}");
        }
    }

    #[test]
    fn subpaths_without_length_draw_their_caps() {
        let mut line = Path::new();
        line.move_to((5.0, 5.0)).line_to((5.0, 5.0));
        let mut closed = Path::new();
        closed.move_to((5.0, 5.0)).close();
        let mut alone = Path::new();
        alone.move_to((5.0, 5.0));
        let square = points(&[(4.0, 4.0), (6.0, 4.0), (6.0, 6.0), (4.0, 6.0)]);
        for path in [&line, &closed] {
            let draw = |cap| outline(path, &Stroke::new(2.0).with_cap(cap), Transform::IDENTITY, 0.01);
            assert!(draw(LineCap::Butt).is_empty());
            assert_eq!(draw(LineCap::Square), [square.clone()]);
            let disc = draw(LineCap::Round);
            assert_eq!(disc.len(), 1);
            assert!(disc[0].len() >= 12);
            for p in &disc[0] {
                assert!(((*p - Point::new(5.0, 5.0)).length() - 1.0).abs() < 1e-5);
            }
        }
        for cap in [LineCap::Butt, LineCap::Square, LineCap::Round] {
            assert!(outline(&alone, &Stroke::new(2.0).with_cap(cap), Transform::IDENTITY, 0.01).is_empty());
        }
    }

    #[test]
    fn width_zero_is_one_device_pixel_at_any_transform() {
        let mut path = Path::new();
        path.move_to((0.0, 1.0)).line_to((2.0, 1.0));
        let got = outline(&path, &Stroke::new(0.0), Transform::from_scale(10.0, 3.0), 0.1);
        assert_eq!(got, [points(&[(0.0, 2.5), (20.0, 2.5), (20.0, 3.5), (0.0, 3.5)])]);
    }

    #[test]
    fn the_pen_is_scaled_with_the_path() {
        let mut path = Path::new();
        path.move_to((0.0, 0.0)).line_to((10.0, 0.0)).line_to((10.0, 10.0));
        let got = outline(&path, &Stroke::new(2.0), Transform::from_scale(3.0, 0.5), 0.1);
        let by_hand = [(0.0, -0.5), (33.0, -0.5), (33.0, 5.0), (27.0, 5.0), (27.0, 0.5), (0.0, 0.5)];
        assert_eq!(got, [points(&by_hand)]);
    }

    #[test]
    fn strokes_cover_what_tiny_skias_cover() {
        let mut random = Random(1);
        let (mut compared, mut inside) = (0, 0);
        for round in 0..240 {
            let mut path = Path::new();
            let mut reference = tiny_skia::PathBuilder::new();
            let p = random.point(100.0);
            path.move_to(p);
            reference.move_to(p.x, p.y);
            // Curves at rounds where the pen is thin only: tiny-skia leaves holes in tight curves.
            let curves = round % 3 == 0;
            for _ in 0..1 + round % 4 {
                let (a, b, c) = (random.point(100.0), random.point(100.0), random.point(100.0));
                if curves {
                    path.cubic_to(a, b, c);
                    reference.cubic_to(a.x, a.y, b.x, b.y, c.x, c.y);
                } else {
                    path.line_to(a);
                    reference.line_to(a.x, a.y);
                }
            }
            if round % 5 == 0 {
                path.close();
                reference.close();
            }
            let width = if curves { 0.5 + random.next() } else { 1.0 + 20.0 * random.next() };
            let caps = [LineCap::Butt, LineCap::Round, LineCap::Square];
            let joins = [LineJoin::Miter, LineJoin::Round, LineJoin::Bevel, LineJoin::MiterClip];
            let style = Stroke::new(width).with_cap(caps[round % 3]).with_join(joins[round / 3 % 4]);
            let their_style = tiny_skia::Stroke {
                width,
                miter_limit: style.miter_limit,
                line_cap: [tiny_skia::LineCap::Butt, tiny_skia::LineCap::Round, tiny_skia::LineCap::Square][round % 3],
                line_join: [
                    tiny_skia::LineJoin::Miter,
                    tiny_skia::LineJoin::Round,
                    tiny_skia::LineJoin::Bevel,
                    tiny_skia::LineJoin::MiterClip,
                ][round / 3 % 4],
                dash: None,
            };
            let ours = outline(&path, &style, Transform::IDENTITY, 0.01);
            let theirs = reference.finish().unwrap().stroke(&their_style, 20.0).unwrap();
            let theirs = flat(&theirs);
            for _ in 0..300 {
                let p = random.point(140.0) - Point::new(20.0, 20.0);
                if boundary_distance(&theirs, p) < 0.1 {
                    continue;
                }
                compared += 1;
                let expected = winding(&theirs, p) != 0;
                inside += i32::from(expected);
                assert_eq!(winding(&ours, p) != 0, expected, "{p:?} in round {round}: {path:?} {style:?}");
            }
        }
        assert!(compared > 50_000 && inside > 3_000, "{compared} {inside}");
    }

    /// tiny-skia's path as polygons of short chords.
    fn flat(path: &tiny_skia::Path) -> Vec<Vec<Point>> {
        use tiny_skia::PathSegment;
        let mut polygons: Vec<Vec<Point>> = Vec::new();
        let point = |p: tiny_skia::Point| Point::new(p.x, p.y);
        for segment in path.segments() {
            if let PathSegment::MoveTo(p) = segment {
                polygons.push(vec![point(p)]);
                continue;
            }
            let polygon = polygons.last_mut().unwrap();
            let at = *polygon.last().unwrap();
            match segment {
                PathSegment::LineTo(p) => polygon.push(point(p)),
                PathSegment::QuadTo(c, p) => {
                    for i in 1..=32_u8 {
                        let t = f32::from(i) / 32.0;
                        polygon.push(at.lerp(point(c), t).lerp(point(c).lerp(point(p), t), t));
                    }
                }
                PathSegment::CubicTo(..) => unreachable!("strokes are made of lines and quadratic curves"),
                PathSegment::MoveTo(_) | PathSegment::Close => {}
            }
        }
        polygons
    }

    #[test]
    fn a_round_stroke_is_every_point_near_the_path_and_winds_one_way() {
        // The distance to the path is the truth, for tight curves, loops and cusps too.
        let mut random = Random(7);
        // With the sign of their windings: a pen that is mapped as a whole may be mirrored.
        let transforms = [
            (Transform::IDENTITY, 1),
            (Transform::from_rotate(30.0), 1),
            (Transform::from_scale(-1.0, 1.0), 1),
            (Transform::from_row(1.5, 0.3, -0.8, 0.6, 3.0, -5.0), 1),
            (Transform::from_row(1.5, 0.3, 0.8, -0.6, 3.0, -5.0), -1),
        ];
        for round in 0..150 {
            let mut path = Path::new();
            let size = if round % 2 == 0 { 100.0 } else { 15.0 };
            path.move_to(random.point(size));
            for i in 0..1 + round % 3 {
                match (round + i) % 4 {
                    0 => path.line_to(random.point(size)),
                    1 => path.quad_to(random.point(size), random.point(size)),
                    _ => path.cubic_to(random.point(size), random.point(size), random.point(size)),
                };
            }
            if round % 7 == 0 {
                path.close();
            }
            let width = 2.0 + 12.0 * random.next();
            let style = Stroke::new(width).with_cap(LineCap::Round).with_join(LineJoin::Round);
            let (transform, sign) = transforms[round % 5];
            let polygons = outline(&path, &style, transform, 0.01);
            let chords = chords(&path);
            for _ in 0..200 {
                let p = random.point(size * 1.4) - Point::new(size * 0.2, size * 0.2);
                let near = chords.iter().map(|(a, b)| distance(*a, *b, p)).fold(f32::MAX, f32::min);
                if (near - width * 0.5).abs() < 0.05 {
                    continue;
                }
                let winding = winding(&polygons, transform.map(p)) * sign;
                assert!(winding >= 0, "{p:?} winds {winding} in round {round}: {path:?} {width}");
                assert_eq!(winding > 0, near < width * 0.5, "{p:?} in round {round}: {path:?} {width} {transform:?}");
            }
        }
    }

    #[test]
    fn hostile_input_ends_in_finite_points_quickly() {
        let far = [0.0, 1.0, -3.0, 1e-30, 1e9, -1e18, 1e30, 3e38, f32::NAN, f32::INFINITY];
        let widths = [0.0, -0.0, 1e-40, 1.0, 1e10, 1e30, 3e38, -1.0, f32::NAN, f32::INFINITY];
        let transforms = [
            Transform::IDENTITY,
            Transform::from_scale(3.8, 3.8),
            Transform::from_scale(0.0, 0.0),
            Transform::from_row(1.0, 2.0, 2.0, 4.0, 0.0, 0.0),
            Transform::from_scale(1e30, 1e-30),
            Transform::from_scale(f32::NAN, 1.0),
        ];
        let joins = [LineJoin::Miter, LineJoin::Round, LineJoin::Bevel, LineJoin::MiterClip];
        let caps = [LineCap::Butt, LineCap::Round, LineCap::Square];
        let mut random = Random(3);
        let mut count = 0;
        for round in 0..3_000 {
            // The last three draw nothing, so that they are rare.
            let kinds = if round % 8 == 0 { 10.0 } else { 7.0 };
            let mut pick = || far[(random.next() * kinds) as usize];
            let mut path = Path::new();
            path.move_to((pick(), pick())).line_to((pick(), pick()));
            path.cubic_to((pick(), pick()), (pick(), pick()), (pick(), pick())).line_to((pick(), pick()));
            if round % 2 == 0 {
                path.close();
            }
            let limits = [4.0, 0.0, f32::NAN, 1e30];
            let mut style = Stroke::new(widths[round % 10])
                .with_cap(caps[round % 3])
                .with_join(joins[round % 4])
                .with_miter_limit(limits[round / 3 % 4]);
            if round % 3 == 0 {
                style = style.with_dash([1.0, far[round % 10], 0.0], far[round / 10 % 10]);
            }
            let polygons = outline(&path, &style, transforms[round / 7 % 6], [0.1, 0.0, f32::NAN][round % 3]);
            count += polygons.len();
        }
        assert!(count > 100, "{count}");
    }

    #[test]
    fn a_pen_wider_than_everything_covers_everything() {
        let mut path = Path::new();
        path.move_to((3.0, 6.0)).line_to((11.0, 6.0)).line_to((11.0, -158_758_583.0));
        let style = Stroke::new(1e30).with_cap(LineCap::Round).with_join(LineJoin::Round);
        let got = outline(&path, &style, Transform::from_scale(3.8, 3.8), 0.1);
        assert!(got.iter().map(Vec::len).sum::<usize>() < 4096);
        assert!(winding(&got, Point::new(1e20, -1e20)) != 0);
    }

    #[test]
    fn a_curve_of_coincident_points_is_a_line_or_a_dot() {
        let a = Point::new(2.0, 2.0);
        let b = Point::new(8.0, 2.0);
        for (c1, c2) in [(a, a), (b, b), (a, b), (b, a)] {
            let mut path = Path::new();
            path.move_to(a).cubic_to(c1, c2, b);
            let got = outline(&path, &Stroke::new(2.0), Transform::IDENTITY, 0.1);
            for (p, inside) in [((5.0, 1.5), true), ((5.0, 2.5), true), ((1.5, 2.0), false), ((5.0, 3.5), false)] {
                assert_eq!(winding(&got, p.into()) != 0, inside, "{c1:?} {c2:?} {p:?}");
            }
        }
    }
}
