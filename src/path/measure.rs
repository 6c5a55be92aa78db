//! The size of a path: its tight bounding box and its length.

use super::curve::Cubic;
use super::{Path, Segment};
use crate::geom::{Point, Rect};

impl Path {
    /// The bounding box of the path itself: of its end points and the extrema of its curves. `None` for an
    /// empty path or one with a non-finite point.
    pub fn bounds(&self) -> Option<Rect> {
        let hull = self.control_bounds()?;
        let mut at = Point::ZERO;
        let mut bounds: Option<Rect> = None;
        for segment in self.segments() {
            let cubic = match segment {
                Segment::MoveTo(p) | Segment::LineTo(p) => {
                    grow(&mut bounds, p);
                    at = p;
                    continue;
                }
                Segment::Close => continue,
                Segment::QuadTo(c, p) => Cubic::from_quad(at, c, p),
                Segment::CubicTo(c1, c2, p) => Cubic::new(at, c1, c2, p),
            };
            for axis in [0, 1] {
                for t in cubic.extrema(axis).into_iter().flatten() {
                    let p = cubic.at(t);
                    // Rounding must not lead out of the control points' box.
                    grow(&mut bounds, Point::new(p.x.clamp(hull.left, hull.right), p.y.clamp(hull.top, hull.bottom)));
                }
            }
            at = cubic.points()[3];
            grow(&mut bounds, at);
        }
        bounds
    }

    /// The length of all subpaths, closing lines included; not finite if a point is not.
    pub fn length(&self) -> f64 {
        let (mut at, mut start) = (Point::ZERO, Point::ZERO);
        let mut sum = 0.0;
        for segment in self.segments() {
            let line = |p: Point| Cubic::new(at, at, p, p).longest();
            let (length, end) = match segment {
                Segment::MoveTo(p) => {
                    start = p;
                    (0.0, p)
                }
                Segment::LineTo(p) => (line(p), p),
                Segment::QuadTo(c, p) => (Cubic::from_quad(at, c, p).length(), p),
                Segment::CubicTo(c1, c2, p) => (Cubic::new(at, c1, c2, p).length(), p),
                Segment::Close => (line(start), start),
            };
            sum += length;
            at = end;
        }
        sum
    }
}

fn grow(bounds: &mut Option<Rect>, p: Point) {
    let point = Rect::from_ltrb(p.x, p.y, p.x, p.y);
    *bounds = Some(bounds.map_or(point, |bounds| bounds.union(point)));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bounds_are_those_of_the_curve_not_of_its_control_points() {
        // x = 2t(1−t)·4 + t²·2 … by hand: y = 2t(1−t)·6 is highest at t = ½, 3.
        let mut path = Path::new();
        path.move_to((0.0, 0.0)).quad_to((1.0, 6.0), (2.0, 0.0));
        assert_eq!(path.bounds(), Some(Rect::from_ltrb(0.0, 0.0, 2.0, 3.0)));
        // y = 3t(1−t)²·4 + 3t²(1−t)·4 = 12 t(1−t): 3 at ½.
        let mut path = Path::new();
        path.move_to((0.0, 0.0)).cubic_to((1.0, 4.0), (2.0, 4.0), (3.0, 0.0));
        assert_eq!(path.bounds(), Some(Rect::from_ltrb(0.0, 0.0, 3.0, 3.0)));
    }

    #[test]
    fn bounds_hold_every_point_of_the_curve() {
        let curves = [[3.0, -9.0, 20.0, 1.0], [0.0, 0.0, 7.0, 0.0], [5.0, 5.0, 5.0, 5.0], [1.0, 2.0, 3.0, 4.0]];
        for x in curves {
            for y in curves {
                let p = |i: usize| Point::new(x[i], y[3 - i]);
                let mut path = Path::new();
                path.move_to(p(0)).cubic_to(p(1), p(2), p(3));
                let bounds = path.bounds().unwrap();
                let cubic = Cubic::new(p(0), p(1), p(2), p(3));
                let points: Vec<_> = (0..=1000).map(|i| cubic.at(f64::from(i) / 1000.0)).collect();
                let sampled = Rect::from_points(&points).unwrap();
                assert!(bounds.outset(1e-5).union(sampled) == bounds.outset(1e-5), "{bounds:?} {sampled:?}");
                assert!(sampled.outset(1e-3).union(bounds) == sampled.outset(1e-3), "{bounds:?} {sampled:?}");
            }
        }
    }

    #[test]
    fn the_length_of_a_closed_triangle_is_its_three_sides() {
        let mut path = Path::new();
        path.move_to((0.0, 0.0)).line_to((3.0, 0.0)).line_to((3.0, 4.0)).close();
        path.move_to((10.0, 10.0)).line_to((10.0, 11.0));
        assert_eq!(path.length(), 3.0 + 4.0 + 5.0 + 1.0);
    }

    #[test]
    fn an_empty_path_has_neither_bounds_nor_length() {
        assert_eq!(Path::new().bounds(), None);
        assert_eq!(Path::new().length(), 0.0);
        let mut path = Path::new();
        path.move_to((0.0, 0.0)).line_to((f32::NAN, 0.0));
        assert_eq!(path.bounds(), None);
    }
}
