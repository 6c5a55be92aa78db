//! Which outlines are rectangles with equally rounded corners: ellipses and circles among them.
//!
//! What they cover can be reckoned without flattening them, however they came to be: from this crate's shapes, from
//! those of another, or from an SVG file.

use fearless_simd::f32x8;
use fearless_simd::prelude::*;

use super::Verb;
use super::shapes::QUARTER;
use crate::geom::{Point, Rect};

/// How far, in pixels, a point may lie from where it belongs.
const TOLERANCE: f32 = 1.0 / 256.0;

/// The points of a quarter by how far it goes, from the corner that it rounds: x and y of its start, its control points and its end. First
/// of one that starts level, then of one that starts upright.
const QUARTERS: [[f32; 8]; 2] = {
    const REST: f32 = 1.0 - QUARTER;
    [[-1.0, 0.0, -REST, 0.0, 0.0, REST, 0.0, 1.0], [0.0, -1.0, 0.0, -REST, REST, 0.0, 1.0, 0.0]]
};

/// Whether an outline has as many segments of the kinds that [`round_rect`] looks for.
#[inline(always)]
pub(crate) fn may_be_round_rect(verbs: &[Verb], points: &[Point]) -> bool {
    // Four cubics, and at most a line before each of them and one after the last.
    (13..=18).contains(&points.len()) && verbs.len() <= 11 && verbs.contains(&Verb::CubicTo)
}

/// The horizontal and vertical radius of a rectangle's corners, if an outline (device pixels) of those `bounds` is nothing else: four
/// quarters of an ellipse one after another, each a cubic, with lines along the rectangle's sides between them where there are any.
#[inline(always)]
pub(crate) fn round_rect<S: Simd>(simd: S, verbs: &[Verb], points: &[Point], bounds: Rect) -> Option<Point> {
    let is_near = |a: f32, b: f32| (a - b).abs() <= TOLERANCE;
    let is_at = |a: Point, b: Point| is_near(a.x, b.x) & is_near(a.y, b.y);
    // Nothing lies between two points on one side.
    let on_one_side = |a: Point, b: Point| {
        is_near(a.x, b.x) && (is_near(a.x, bounds.left) || is_near(a.x, bounds.right))
            || is_near(a.y, b.y) && (is_near(a.y, bounds.top) || is_near(a.y, bounds.bottom))
    };
    let (Verb::MoveTo, verbs) = verbs.split_first()? else { return None };
    let verbs = verbs.strip_suffix(&[Verb::Close]).unwrap_or(verbs);
    // From the point on at which the next segment starts.
    let mut rest = points;
    let start = *points.first()?;
    let (corners, center) = (bounds.corners(), bounds.center());
    let (mut radii, mut count) = (Point::ZERO, 0);
    // The corner of the last curve, and which way around the curves go: one or three corners on.
    let (mut corner_before, mut way) = (0, 0);
    for verb in verbs {
        match verb {
            Verb::LineTo => {
                let ([at, end], _) = rest.split_first_chunk()?;
                if !on_one_side(*at, *end) {
                    return None;
                }
                rest = rest.get(1..)?;
            }
            Verb::CubicTo => {
                let (curve @ [at, c1, _, end], _) = rest.split_first_chunk()?;
                let [level, upright] = QUARTERS;
                let (tip, quarter) = if is_near(c1.x, at.x) {
                    (Point::new(at.x, end.y), upright)
                } else {
                    (Point::new(end.x, at.y), level)
                };
                let corner = match (tip.x > center.x, tip.y > center.y) {
                    (false, false) => 0,
                    (true, false) => 1,
                    (true, true) => 2,
                    (false, true) => 3,
                };
                let (x, y) = (end.x - at.x, end.y - at.y);
                let size = Point::new(x.abs(), y.abs());
                let found = f32x8::load_array(simd, bytemuck::cast(*curve)) - pairs(simd, tip);
                let expected = pairs(simd, Point::new(x, y)) * f32x8::load_array(simd, quarter);
                let far = (found - expected).abs().simd_gt(TOLERANCE).to_bitmask();
                if !is_at(tip, *corners.get(corner)?) || far != 0 {
                    return None;
                }
                let step = (corner + 4 - corner_before) % 4;
                match count {
                    0 => radii = size,
                    1 if step.is_multiple_of(2) => return None,
                    1 => way = step,
                    _ if step != way => return None,
                    _ => {}
                }
                if !is_at(size, radii) {
                    return None;
                }
                (rest, corner_before, count) = (rest.get(3..)?, corner, count + 1);
            }
            Verb::MoveTo | Verb::QuadTo | Verb::Close => return None,
        }
    }
    let [end] = rest else { return None };
    // Quarters that overlap have a line back between them.
    let fit = 2.0 * radii.x <= bounds.width() + TOLERANCE && 2.0 * radii.y <= bounds.height() + TOLERANCE;
    (count == 4 && fit && (is_at(*end, start) || on_one_side(*end, start))).then_some(radii)
}

/// A point's x and y, four times.
#[inline(always)]
fn pairs<S: Simd>(simd: S, p: Point) -> f32x8<S> {
    f32x8::load_array(simd, [p.x, p.y, p.x, p.y, p.x, p.y, p.x, p.y])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geom::Transform;
    use crate::num::level::{SimdLevel, dispatch};
    use crate::path::Path;

    fn look(verbs: &[Verb], points: &[Point]) -> Option<(Rect, Point)> {
        let bounds = Rect::from_points(points)?;
        let found = SimdLevel::available()
            .into_iter()
            .map(|level| dispatch!(level, simd => round_rect(simd, verbs, points, bounds)));
        let found: Vec<_> = found.collect();
        assert!(found.windows(2).all(|pair| pair[0] == pair[1]));
        let radii = found[0]?;
        assert!(may_be_round_rect(verbs, points));
        Some((bounds, radii))
    }

    fn recognized(path: &Path) -> Option<(Rect, Point)> {
        look(path.verbs(), path.points())
    }

    #[test]
    fn circles_ellipses_and_rounded_rectangles_are_recognized_whichever_way_they_lie() {
        let mut circle = Path::new();
        circle.circle((20.0, 30.0), 7.5);
        let mut ellipse = Path::new();
        ellipse.ellipse((20.0, 30.0), 10.0, 5.0);
        let mut rounded = Path::new();
        rounded.round_rect(Rect::from_ltrb(10.0, 10.0, 50.0, 40.0), (6.0, 4.0));
        let shapes = [
            (circle, Rect::from_ltrb(12.5, 22.5, 27.5, 37.5), Point::new(7.5, 7.5)),
            (ellipse, Rect::from_ltrb(10.0, 25.0, 30.0, 35.0), Point::new(10.0, 5.0)),
            (rounded, Rect::from_ltrb(10.0, 10.0, 50.0, 40.0), Point::new(6.0, 4.0)),
        ];
        for (path, rect, radii) in shapes {
            assert_eq!(recognized(&path), Some((rect, radii)));
            assert!(recognized(&path.reversed()).is_some());
            assert!(recognized(&path.transformed(Transform::from_scale(-1.5, 0.7))).is_some());
            let quarter = path.transformed(Transform::from_row(0.0, 1.0, -1.0, 0.0, 90.0, 3.0));
            let (turned, turned_radii) = recognized(&quarter).unwrap();
            assert_eq!((turned.width(), turned_radii), (rect.height(), Point::new(radii.y, radii.x)));
        }
    }

    #[test]
    fn other_outlines_are_not() {
        let circle = |path: &mut Path| {
            path.circle((20.0, 30.0), 7.5);
        };
        let mut path = Path::new();
        circle(&mut path);
        // A slanted ellipse, a second subpath, three quarters.
        assert_eq!(recognized(&path.transformed(Transform::from_row(1.0, 0.2, 0.1, 1.0, 0.0, 0.0))), None);
        let mut two = path.clone();
        circle(&mut two);
        assert_eq!(recognized(&two), None);
        let mut part = Path::new();
        part.arc((20.0, 30.0), 7.5, 0.0, 270.0).close();
        assert_eq!(recognized(&part), None);
        let mut unequal = Path::new();
        unequal.round_rect(Rect::from_ltrb(0.0, 0.0, 40.0, 30.0), [4.0, 4.0, 8.0, 4.0]);
        assert_eq!(recognized(&unequal), None);
        // One point moved, each in turn.
        let (verbs, points) = (path.verbs(), path.points());
        for moved in 0..points.len() {
            for by in [Point::new(0.05, 0.0), Point::new(0.0, 0.05), Point::new(-0.05, 0.0), Point::new(0.0, -0.05)] {
                let mut points = points.to_vec();
                points[moved] = points[moved] + by;
                assert_eq!(look(verbs, &points), None, "point {moved} moved by {by:?}");
            }
        }
        // The same corners in another order, or curved inwards.
        let k = QUARTER;
        let arcs = |corners: [[f32; 2]; 4], inwards: bool| {
            let mut path = Path::new();
            path.move_to((5.0, 0.0));
            for [x, y] in corners {
                let from = path.current_point().unwrap();
                let tip = Point::new(x, y);
                let to = Point::new(if from.x == 5.0 { x } else { 5.0 }, if from.x == 5.0 { 5.0 } else { y });
                let pull = if inwards { Point::new(5.0, 5.0) } else { tip };
                path.cubic_to(from.lerp(pull, k), to.lerp(pull, k), to);
            }
            path.close();
            path
        };
        // Quarters wider than half of the box, with lines back along its sides.
        let mut lens = Path::new();
        lens.move_to((6.0, 0.0));
        for (from, tip, to) in [
            ((4.0, 0.0), (10.0, 0.0), (10.0, 6.0)),
            ((10.0, 4.0), (10.0, 10.0), (4.0, 10.0)),
            ((6.0, 10.0), (0.0, 10.0), (0.0, 4.0)),
            ((0.0, 6.0), (0.0, 0.0), (6.0, 0.0)),
        ] {
            let [from, tip, to] = [from, tip, to].map(Point::from);
            lens.line_to(from).cubic_to(from.lerp(tip, k), to.lerp(tip, k), to);
        }
        assert_eq!(recognized(lens.close()), None);
        let around = [[10.0, 0.0], [10.0, 10.0], [0.0, 10.0], [0.0, 0.0]];
        assert!(recognized(&arcs(around, false)).is_some());
        assert_eq!(recognized(&arcs(around, true)), None);
    }
}
