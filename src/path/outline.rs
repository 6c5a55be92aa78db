//! The pen and the two contours that it leaves beside a line.

use super::flatten::PolygonSink;
use super::steps::{Coefficients, Curve, Nib, Steps};
use super::stretch::Cut;
use super::{LineCap, LineJoin, Stroke};
use crate::geom::{Point, Transform};
use crate::num::level::{SimdLevel, dispatch};

/// The longest miter that is drawn, as a multiple of half the width, whatever the limit asks for: at
/// sharper corners `f32` no longer knows the direction of the tip.
pub(super) const LONGEST_MITER: f32 = 1000.0;

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
    pub(super) fn new(style: &Stroke, radius: f32, tolerance: f32, axis: Point) -> Self {
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

/// The part of its radius that is added to an arc's inner points, so that chords over angles of the given cosine
/// lie as much outside the arc as inside: angle² / 12, where angle² / 2 is near 1 − cos.
#[inline(always)]
fn balance(cos: f32) -> f32 {
    (1.0 - cos) * (1.0 / 6.0)
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
    /// Memory for the steps of a curve, and the level at which they are found.
    steps: &'a mut Steps,
    level: SimdLevel,
    closed: bool,
    /// Whether the subpath goes on from a cut.
    is_cut: bool,
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
    pub(super) fn new(
        level: SimdLevel,
        pen: Pen,
        after: A,
        (right, steps): (&'a mut Vec<Point>, &'a mut Steps),
        sink: &'a mut K,
    ) -> Self {
        right.clear();
        let none = (Point::ZERO, 0.0);
        Self {
            pen,
            after,
            sink,
            right,
            steps,
            level,
            closed: false,
            is_cut: false,
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
        self.is_cut = false;
        self.begun = false;
        self.walking = false;
        self.start = p;
        self.at = p;
        self.right.clear();
    }

    /// Goes on with an open subpath where it is cut.
    pub(super) fn begin_at(&mut self, cut: &Cut) {
        self.begin(cut.at, false);
        self.is_cut = true;
        self.begun = true;
        self.walking = true;
        self.last = cut.last;
        self.sink.begin(cut.left);
        self.right.push(cut.right);
    }

    /// Where the pen is, the step that led there, and the last point of the right contour; `None` before the first join.
    pub(super) fn place(&self) -> Option<(Point, (Point, f32), Point)> {
        match &self.right[..] {
            [_, .., right] => Some((self.at, self.last, *right)),
            _ => None,
        }
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
        const FEW_STEPS: f32 = 1.0 / 4.0;
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

        let nib = Nib { radius, tolerance, turn_radius: self.pen.turn_radius, turn: self.pen.turn, longest_step };
        let calm = Curve { origin, end, coefficients: curve, start_direction, end_direction };
        // A curve of a few steps is walked sooner than looked at.
        if longest_step < FEW_STEPS && dispatch!(self.level, simd => self.steps.find(simd, &calm, &nib)) {
            return self.take_steps(&calm);
        }

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
                // Chords lie to the inside of a curve, on average by step² / 12 · |C″|, and those of the pen's turn
                // by angle² / 12 of its radius: moved outwards by as much, the contours enclose what they should.
                // What of C″ lies along the curve moves nothing outwards, but a point at a fold beyond it.
                let normal = right_of(next_direction);
                let outwards = normal.dot(curve.acceleration(next_t)) * (even * even * (1.0 / 12.0));
                let balanced = next_p - normal * outwards;
                // After a kink the pen has turned already.
                let turned = if kink { 1.0 } else { direction.dot(next_direction) };
                let right = normal * (radius + radius * balance(turned));
                self.left(balanced - right);
                self.right(balanced + right);
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

    /// Walks along a calm curve.
    #[inline(always)]
    fn take_steps(&mut self, curve: &Curve) {
        let count = self.steps.count();
        let length = |steps: &Steps, to: usize| (steps.position(to) - steps.position(to - 1)).length();
        self.depart(curve.start_direction, length(self.steps, 1));
        for step in 1..count {
            let (left, right) = self.steps.points(step);
            self.left(left);
            self.right(right);
        }
        self.last = (curve.end_direction, length(self.steps, count));
        self.at = curve.end;
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
            self.cap(self.at, self.last.0, false);
            self.come_back();
        }
        self.begun = false;
    }

    /// Ends an open subpath where it is cut.
    pub(super) fn finish_at(&mut self, cut: &Cut) {
        if self.walking {
            self.sink.line(cut.left);
            self.right.push(cut.right);
            self.come_back();
        }
        self.begun = false;
    }

    /// Writes the right contour backwards, and the cap of the start.
    fn come_back(&mut self) {
        for p in self.right.iter().rev() {
            self.sink.line(*p);
        }
        if self.pen.cap == LineCap::Round && !self.is_cut {
            self.half_circle(self.start, -self.first.0);
        }
        self.sink.end();
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
        let reach = self.pen.radius + self.pen.radius * balance(self.pen.arc.cos);
        for _ in 1..self.pen.arc.half_turn {
            v = self.pen.arc.turn(v, true);
            self.left(p + v * reach);
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
        let reach = self.pen.radius + self.pen.radius * balance(arc.cos);
        let reach = if clockwise { -reach } else { reach };
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn half_turn_steps_are_those_of_trigonometry() {
        for (steps, cos, sin) in HALF_TURNS {
            let (true_sin, true_cos) = crate::num::trig::sin_cos(std::f64::consts::PI / f64::from(steps));
            assert!((f64::from(cos) - true_cos).abs() < 1e-7, "{steps}");
            assert!((f64::from(sin) - true_sin).abs() < 1e-7, "{steps}");
        }
    }
}
