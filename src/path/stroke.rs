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
use super::far;
use super::flatten::PolygonSink;
use super::outline::{LONGEST_MITER, Outliner, Pen, PointMap, Unmapped};
use super::steps::Steps;
use super::stretch::Stretch;
use super::{Segment, Stroke};
use crate::geom::{Point, Rect, Transform};
use crate::num::level::SimdLevel;

/// No polygon point is farther out than this; a stroke that could have one draws nothing.
const FARTHEST: f32 = 1e37;

/// Memory that strokes reuse; after the first few strokes nothing more is allocated.
#[derive(Debug)]
pub(crate) struct StrokeScratch {
    /// The level at which curves are looked at.
    pub(crate) level: SimdLevel,
    /// The right contour of the subpath in work, in device pixels.
    pub(super) right: Vec<Point>,
    pub(super) steps: Steps,
    dash: DashScratch,
}

impl Default for StrokeScratch {
    fn default() -> Self {
        let (right, steps, dash) = Default::default();
        Self { level: SimdLevel::best(), right, steps, dash }
    }
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
    let Some(reach) = Rect::from_points(points).and_then(|bounds| reach(bounds, style, transform)) else { return };
    let may_be_far = reach.in_device && f64::from(reach.extent) > far::FAR;
    let job = Job { verbs, points, style, transform, visible, in_device: reach.in_device, may_be_far, stretch: None };
    job.start(&reach, tolerance, scratch, sink);
}

/// As [`stroke`], of one of a path's [stretches](super::stretch::stretches).
#[expect(clippy::too_many_arguments, reason = "as for the whole")]
pub(crate) fn stroke_stretch<K: PolygonSink>(
    verbs: &[Verb],
    points: &[Point],
    style: &Stroke,
    transform: Transform,
    tolerance: f32,
    stretch: Stretch,
    scratch: &mut StrokeScratch,
    sink: &mut K,
) {
    // That all of the path lies near is known.
    let Some(reach) = reach(Rect::default(), style, transform) else { return };
    let (visible, in_device) = (Rect::default(), reach.in_device);
    let job = Job { verbs, points, style, transform, visible, in_device, may_be_far: false, stretch: Some(stretch) };
    job.start(&reach, tolerance, scratch, sink);
}

/// The pen, and how far it gets.
pub(super) struct Reach {
    /// By how much what is offset is stretched afterwards.
    scale: f32,
    /// The pen's radius in the space in which contours are offset.
    radius: f32,
    /// Whether that is device space.
    in_device: bool,
    /// A bound of the coordinates that the path has in either space.
    pub(super) extent: f32,
}

/// How a path within `bounds` is stroked; `None` if nothing is drawn of it.
pub(super) fn reach(bounds: Rect, style: &Stroke, transform: Transform) -> Option<Reach> {
    if !(style.width >= 0.0 && style.width.is_finite() && transform.is_finite()) {
        return None;
    }
    let hairline = style.width == 0.0;
    let similarity = similarity_scale(transform);
    let (scale, radius) = match similarity {
        _ if hairline => (1.0, 0.5),
        Some(scale) => (scale, style.width * 0.5 * scale),
        None => (transform.scale_range().0, style.width * 0.5),
    };
    let margin = radius * LONGEST_MITER;
    let in_device = hairline || similarity.is_some();
    let extent = farthest(bounds, transform, if in_device { 0.0 } else { margin });
    (extent + margin < FARTHEST).then_some(Reach { scale, radius, in_device, extent })
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

/// One call of [`stroke`] after its checks.
pub(super) struct Job<'a> {
    verbs: &'a [Verb],
    pub(super) points: &'a [Point],
    style: &'a Stroke,
    pub(super) transform: Transform,
    /// Device pixels that have to be right.
    pub(super) visible: Rect,
    /// Whether contours are offset in device space, not in user space.
    pub(super) in_device: bool,
    /// Whether device positions may be so far away that `f32` has lost their digits.
    may_be_far: bool,
    /// What of it is stroked, if not all.
    stretch: Option<Stretch>,
}

impl<'a> Job<'a> {
    /// The path's subpaths, in order.
    pub(super) fn subpaths(&self) -> Subpaths<'a> {
        Subpaths { verbs: self.verbs, points: self.points, start: Point::ZERO }
    }

    /// Chooses the space in which contours are offset, and strokes.
    fn start<K: PolygonSink>(&self, reach: &Reach, tolerance: f32, scratch: &mut StrokeScratch, sink: &mut K) {
        let Reach { scale, radius, .. } = *reach;
        let (style, transform) = (self.style, self.transform);
        let tolerance = if tolerance > 1e-3 { tolerance } else { 1e-3 };
        if self.in_device {
            let pen = Pen::new(style, radius, tolerance, transform.map_direction(Point::new(1.0, 0.0)));
            self.run(transform, Unmapped, &pen, scratch, sink);
        } else if scale > 0.0 {
            let pen = Pen::new(style, radius, tolerance / scale, Point::new(1.0, 0.0));
            self.run(Unmapped, transform, &pen, scratch, sink);
        }
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
        if let Some(stretch) = self.stretch {
            return self.run_stretch(stretch, (before, after), pen, scratch, sink);
        }
        let mut outliner = Outliner::new(scratch.level, *pen, after, (&mut scratch.right, &mut scratch.steps), sink);
        if let Some(dash) = &self.style.dash
            && dash::dash(self, dash, before, &mut scratch.dash, &mut outliner)
        {
            return;
        }
        for subpath in self.subpaths() {
            if self.may_be_far && far::stroke_far_lines(&subpath, self.transform, &mut outliner) {
                continue;
            }
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::path::{LineCap, LineJoin, Path};

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
            assert_eq!(draw(LineCap::Square), std::slice::from_ref(&square));
            let disc = draw(LineCap::Round);
            assert_eq!(disc.len(), 1);
            assert!(disc[0].len() >= 12);
            // Within the tolerance of the circle on both sides, so that the area is the disc's.
            for p in &disc[0] {
                assert!(((*p - Point::new(5.0, 5.0)).length() - 1.0).abs() < 0.01);
            }
            let next = disc[0].iter().cycle().skip(1);
            let area: f32 = disc[0].iter().zip(next).map(|(a, b)| a.cross(*b) * 0.5).sum();
            assert!((area.abs() - std::f32::consts::PI).abs() < 0.01, "{area}");
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
