//! Cubic Bézier curves in double precision: points, pieces, lengths, extrema.

use crate::geom::Point;

/// A cubic Bézier curve in `f64`. Lines and quadratic curves are raised to it without loss.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cubic {
    pub(super) p: [[f64; 2]; 4],
}

fn wide(p: Point) -> [f64; 2] {
    [f64::from(p.x), f64::from(p.y)]
}

fn mix(a: [f64; 2], b: [f64; 2], t: f64) -> [f64; 2] {
    [a[0] + (b[0] - a[0]) * t, a[1] + (b[1] - a[1]) * t]
}

fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    let (x, y) = (b[0] - a[0], b[1] - a[1]);
    (x * x + y * y).sqrt()
}

fn narrow(p: [f64; 2]) -> Point {
    Point::new(p[0] as f32, p[1] as f32)
}

impl Cubic {
    /// The cubic with the given control points.
    pub(super) fn new(p0: Point, p1: Point, p2: Point, p3: Point) -> Self {
        Self { p: [p0, p1, p2, p3].map(wide) }
    }

    /// The quadratic curve from `p0` with control point `c` to `p`.
    pub(super) fn from_quad(p0: Point, c: Point, p: Point) -> Self {
        let (p0, c, p) = (wide(p0), wide(c), wide(p));
        Self { p: [p0, mix(p0, c, 2.0 / 3.0), mix(p, c, 2.0 / 3.0), p] }
    }

    /// The control points in `f32`.
    pub(super) fn points(&self) -> [Point; 4] {
        self.p.map(narrow)
    }

    /// The curve's point at `t`.
    pub(super) fn at(&self, t: f64) -> Point {
        let [a, b, c, d] = self.p;
        let (ab, bc, cd) = (mix(a, b, t), mix(b, c, t), mix(c, d, t));
        narrow(mix(mix(ab, bc, t), mix(bc, cd, t), t))
    }

    /// The two halves.
    pub(super) fn halves(&self) -> (Self, Self) {
        let [a, b, c, d] = self.p;
        let (ab, bc, cd) = (mix(a, b, 0.5), mix(b, c, 0.5), mix(c, d, 0.5));
        let (abc, bcd) = (mix(ab, bc, 0.5), mix(bc, cd, 0.5));
        let middle = mix(abc, bcd, 0.5);
        (Self { p: [a, ab, abc, middle] }, Self { p: [middle, bcd, cd, d] })
    }

    /// The piece between the parameters `t0` and `t1`, as its blossom gives it.
    pub(super) fn piece(&self, t0: f64, t1: f64) -> Self {
        let [a, b, c, d] = self.p;
        let blossom = |r: f64, s: f64, t: f64| {
            let (ab, bc, cd) = (mix(a, b, r), mix(b, c, r), mix(c, d, r));
            mix(mix(ab, bc, s), mix(bc, cd, s), t)
        };
        Self { p: [blossom(t0, t0, t0), blossom(t0, t0, t1), blossom(t0, t1, t1), blossom(t1, t1, t1)] }
    }

    /// The derivative at `t`.
    pub(super) fn velocity(&self, t: f64) -> [f64; 2] {
        let [a, b, c, d] = self.p;
        let u = 1.0 - t;
        [0, 1].map(|i| 3.0 * ((b[i] - a[i]) * u * u + 2.0 * (c[i] - b[i]) * u * t + (d[i] - c[i]) * t * t))
    }

    /// The unit tangent at `t`, taken from a little farther in where the derivative vanishes; the x axis
    /// for a curve that is one point.
    pub(super) fn direction(&self, t: f64) -> Point {
        for t in [t, t + (0.5 - t) * 1e-4, 0.5] {
            let [x, y] = self.velocity(t);
            let length = (x * x + y * y).sqrt();
            if length > 0.0 {
                return Point::new((x / length) as f32, (y / length) as f32);
            }
        }
        Point::new(1.0, 0.0)
    }

    /// The length between two parameters by five-point Gauss–Legendre quadrature.
    pub(super) fn length_between(&self, t0: f64, t1: f64) -> f64 {
        const NODES: [(f64, f64); 5] = [
            (0.0, 0.568_888_888_888_888_9),
            (-0.538_469_310_105_683_1, 0.478_628_670_499_366_5),
            (0.538_469_310_105_683_1, 0.478_628_670_499_366_5),
            (-0.906_179_845_938_664, 0.236_926_885_056_189_1),
            (0.906_179_845_938_664, 0.236_926_885_056_189_1),
        ];
        let (middle, half) = ((t0 + t1) * 0.5, (t1 - t0) * 0.5);
        let mut sum = 0.0;
        for (node, weight) in NODES {
            let [x, y] = self.velocity(middle + half * node);
            sum += weight * (x * x + y * y).sqrt();
        }
        sum * half
    }

    /// The length, in sixteen pieces.
    pub(super) fn length(&self) -> f64 {
        (0..16).map(|i| self.length_between(f64::from(i) / 16.0, f64::from(i + 1) / 16.0)).sum()
    }

    /// The length of the control polygon, which the curve's does not exceed.
    pub(super) fn longest(&self) -> f64 {
        let [a, b, c, d] = self.p;
        distance(a, b) + distance(b, c) + distance(c, d)
    }

    /// The parameters strictly between 0 and 1 at which x (`axis` 0) or y (1) may have an extremum.
    pub(super) fn extrema(&self, axis: usize) -> [Option<f64>; 2] {
        let [a, b, c, d] = self.p.map(|p| p.get(axis).copied().unwrap_or(0.0));
        // The derivative over 3 is q t² + 2 h t + k.
        let (q, h, k) = (d - 3.0 * c + 3.0 * b - a, c - 2.0 * b + a, b - a);
        let inside = |t: f64| (t > 0.0 && t < 1.0).then_some(t);
        let discriminant = h * h - q * k;
        if !(discriminant >= 0.0) {
            return [None, None];
        }
        // Of the two forms of a root, the one that does not cancel: the products of the roots is k / q.
        let root = discriminant.sqrt();
        let sum = if h < 0.0 { root - h } else { -root - h };
        [inside(sum / q), inside(k / sum)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn quarter() -> Cubic {
        let k = 0.552_284_8;
        Cubic::new(Point::new(1.0, 0.0), Point::new(1.0, k), Point::new(k, 1.0), Point::new(0.0, 1.0))
    }

    #[test]
    fn a_quarter_circles_length_is_half_pi() {
        assert!((quarter().length() - std::f64::consts::FRAC_PI_2).abs() < 4e-4);
    }

    #[test]
    fn the_length_of_a_parabola_is_its_integral() {
        // y = x², x in 0 ..= 1: √5 / 2 + asinh(2) / 4.
        let parabola = Cubic::from_quad(Point::ZERO, Point::new(0.5, 0.0), Point::new(1.0, 1.0));
        assert!((parabola.length() - 1.478_942_857_544_597).abs() < 1e-9, "{}", parabola.length());
    }

    #[test]
    fn a_piece_runs_along_the_curve() {
        let piece = quarter().piece(0.25, 0.75);
        for i in 0..=8 {
            let t = f64::from(i) / 8.0;
            let (p, q) = (piece.at(t), quarter().at(0.25 + 0.5 * t));
            assert!((p - q).length() < 1e-6, "{t}");
        }
    }

    #[test]
    fn extrema_are_where_the_derivative_vanishes() {
        let s = Cubic::new(Point::ZERO, Point::new(4.0, 3.0), Point::new(-3.0, -2.0), Point::new(1.0, 0.0));
        for axis in 0..2 {
            for t in s.extrema(axis).map(|t| t.unwrap()) {
                assert!(s.velocity(t)[axis].abs() < 1e-12, "{t}");
            }
        }
    }
}
