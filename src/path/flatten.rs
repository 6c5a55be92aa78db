//! Curves to line segments.

use crate::geom::Point;

/// Takes closed polygons in device pixels, one point after another.
pub(crate) trait PolygonSink {
    /// Starts a polygon at `p`.
    fn begin(&mut self, p: Point);
    /// Adds a straight edge to `p`.
    fn line(&mut self, p: Point);
    /// Adds straight edges to the first `count` points, up to all of them.
    #[inline(always)]
    fn lines<const N: usize>(&mut self, points: &[Point; N], count: usize) {
        for p in points.iter().take(count) {
            self.line(*p);
        }
    }
    /// Ends the polygon with an edge back to its start.
    fn end(&mut self);
}

use fearless_simd::prelude::*;
use fearless_simd::{f32x8, f32x16, f64x8, i32x8};

use super::builder::Verb;

/// How far, in device pixels, a flattened curve may lie from the true one: an eighth of what makes a
/// step of coverage visible along a whole pixel, and small against 24.8 rounding after squaring.
pub(crate) const TOLERANCE: f32 = 0.05;

/// A curve is never cut into more pieces than this; at [`TOLERANCE`] that is enough for a cubic of
/// 100,000 pixels.
const MAX_PIECES: f32 = 1024.0;

/// Writes a path, whose points are in device pixels, as closed polygons: what filling it covers.
///
/// Curves are cut at equal parameters into the number of pieces that Wang's formula gives (Wang 1984;
/// Sederberg, *Computer Aided Geometric Design*, §10.6), eight points at a time; see [`balance_share`] for where
/// the points lie. Subpaths of a single point are left out.
#[inline(always)]
pub(crate) fn flatten_fill<S: Simd, K: PolygonSink>(simd: S, verbs: &[Verb], points: &[Point], sink: &mut K) {
    let mut open = false;
    let mut start = Point::ZERO;
    let mut last = Point::ZERO;
    let mut rest = points;
    let mut verbs = verbs;
    while let Some((verb, after_verb)) = verbs.split_first() {
        verbs = after_verb;
        if matches!(verb, Verb::MoveTo | Verb::Close) {
            if open {
                sink.end();
                open = false;
            }
        } else if !open {
            sink.begin(last);
            open = true;
        }
        match verb {
            Verb::MoveTo => {
                let Some(([p], after)) = rest.split_first_chunk() else { break };
                rest = after;
                start = *p;
                last = start;
            }
            Verb::Close => last = start,
            Verb::LineTo => {
                let Some(([p], after)) = rest.split_first_chunk() else { break };
                rest = after;
                last = *p;
                sink.line(last);
            }
            Verb::QuadTo => {
                let mut from = pairs(simd, &last);
                // Curves mostly follow each other.
                loop {
                    let Some(([c, p], after)) = rest.split_first_chunk() else { return end(open, sink) };
                    rest = after;
                    from = quad(simd, from, [c, p], sink);
                    last = *p;
                    let Some((Verb::QuadTo, after)) = verbs.split_first() else { break };
                    verbs = after;
                }
            }
            Verb::CubicTo => {
                let mut from = pairs(simd, &last);
                loop {
                    let Some(([c1, c2, p], after)) = rest.split_first_chunk() else { return end(open, sink) };
                    rest = after;
                    from = cubic(simd, from, [c1, c2, p], sink);
                    last = *p;
                    let Some((Verb::CubicTo, after)) = verbs.split_first() else { break };
                    verbs = after;
                }
            }
        }
    }
    end(open, sink);
}

#[inline(always)]
fn end<K: PolygonSink>(open: bool, sink: &mut K) {
    if open {
        sink.end();
    }
}

/// A point eight times, x and y in lanes next to each other.
#[inline(always)]
fn pairs<S: Simd>(simd: S, p: &Point) -> f32x16<S> {
    // Read as one number, not as two that are put together again.
    f64x8::splat(simd, f64::from_bits(bytemuck::pod_read_unaligned(bytemuck::bytes_of(p)))).bitcast()
}

/// The point of which there are eight.
#[inline(always)]
fn point<S: Simd>(pairs: f32x16<S>) -> Point {
    let [x, y, ..] = pairs.to_array();
    Point::new(x, y)
}

/// Writes a quadratic curve from `from` on; gives back its end.
#[inline(always)]
fn quad<S: Simd, K: PolygonSink>(simd: S, from: f32x16<S>, [c, p]: [&Point; 2], sink: &mut K) -> f32x16<S> {
    let (by, to) = (pairs(simd, c), pairs(simd, p));
    let bend = from - by - (by - to);
    // |second derivative| / 8 / tolerance, for n² pieces.
    let fourth = squared_length(bend) * (0.25 / TOLERANCE * (0.25 / TOLERANCE));
    let b = (by - from) * 2.0;
    if let Some(few) = Few::of(simd, fourth) {
        let start = from - bend * few.double_share;
        few.write(
            simd,
            #[inline(always)]
            |at| (at * bend + b) * at + start,
            to,
            sink,
        );
    } else {
        let pieces = many_pieces(fourth);
        let start = from - bend * (2.0 * balance_share(pieces as f32));
        polynomial(simd, [Point::ZERO, point(bend), point(b), point(start)], pieces, *p, sink);
    }
    to
}

/// As [`quad`], of a cubic one.
#[inline(always)]
fn cubic<S: Simd, K: PolygonSink>(simd: S, from: f32x16<S>, [c1, c2, p]: [&Point; 3], sink: &mut K) -> f32x16<S> {
    let (one, two, to) = (pairs(simd, c1), pairs(simd, c2), pairs(simd, p));
    let (bend1, bend2) = (from - one - (one - two), one - two - (two - to));
    let (d1, d2) = (squared_length(bend1), squared_length(bend2));
    let fourth = (if d1 > d2 { d1 } else { d2 }) * (0.75 / TOLERANCE * (0.75 / TOLERANCE));
    let a = (to - from) - (two - one) * 3.0;
    let b = bend1 * 3.0;
    let c = (one - from) * 3.0;
    if let Some(few) = Few::of(simd, fourth) {
        let (c, start) = (c - a * (3.0 * few.double_share), from - b * few.double_share);
        few.write(
            simd,
            #[inline(always)]
            |at| ((at * a + b) * at + c) * at + start,
            to,
            sink,
        );
    } else {
        let pieces = many_pieces(fourth);
        let double_share = 2.0 * balance_share(pieces as f32);
        let (c, start) = (c - a * (3.0 * double_share), from - b * double_share);
        polynomial(simd, [point(a), point(b), point(c), point(start)], pieces, *p, sink);
    }
    to
}

#[inline(always)]
fn squared_length<S: Simd>(pairs: f32x16<S>) -> f32 {
    let [x, y, ..] = (pairs * pairs).to_array();
    x + y
}

/// What curves of up to eight pieces have in common, as nearly all have no more.
struct Few {
    /// The parameters of their points, each twice.
    times: [f32; 16],
    count: usize,
    pieces: f32,
    /// Twice what [`balance_share`] says.
    double_share: f32,
}

impl Few {
    const MOST: usize = 8;

    /// Those of one piece, of two, …
    const ALL: [Self; Self::MOST] = {
        let mut all = [const { Self { times: [0.0; 16], count: 0, pieces: 0.0, double_share: 0.0 } }; Self::MOST];
        let mut index = 0;
        while index < Self::MOST {
            let pieces = (index + 1) as f32;
            let mut lane = 0;
            while lane < 16 {
                all[index].times[lane] = (lane / 2 + 1) as f32 * (1.0 / pieces);
                lane += 1;
            }
            all[index].count = index + 1;
            all[index].pieces = pieces;
            all[index].double_share = 2.0 * balance_share(pieces);
            index += 1;
        }
        all
    };

    /// Those of a curve of which the fourth power of the number of pieces is given, if they are few.
    #[inline(always)]
    fn of<S: Simd>(simd: S, fourth: f32) -> Option<&'static Self> {
        // Comparing fourth powers needs no root, and all of them at once no branch: how many pieces a curve has is hard to
        // guess.
        let powers = f32x8::simd_from(simd, [1.0, 16.0, 81.0, 256.0, 625.0, 1296.0, 2401.0, 4096.0]);
        let passed = f32x8::splat(simd, fourth).simd_gt(powers).to_bitmask() as u32;
        Self::ALL.get(passed.count_ones() as usize)
    }

    /// Writes the points of the curve `at` their parameters, and instead of the last the curve's end.
    #[inline(always)]
    fn write<S: Simd, K: PolygonSink>(
        &self,
        simd: S,
        at: impl Fn(f32x16<S>) -> f32x16<S>,
        end: f32x16<S>,
        sink: &mut K,
    ) {
        let numbers =
            f32x16::simd_from(simd, [1.0, 1.0, 2.0, 2.0, 3.0, 3.0, 4.0, 4.0, 5.0, 5.0, 6.0, 6.0, 7.0, 7.0, 8.0, 8.0]);
        let points = numbers.simd_eq(self.pieces).select(end, at(f32x16::load_array_ref(simd, &self.times)));
        let points: [Point; Self::MOST] = bytemuck::cast(points.to_array());
        sink.lines(&points, self.count);
    }
}

/// The fourth root of `fourth`, rounded up, for curves of more than eight pieces, within [`MAX_PIECES`]; 1 if it is not finite.
#[cold]
fn many_pieces(fourth: f32) -> u32 {
    let pieces = fourth.sqrt().sqrt();
    match pieces {
        _ if !fourth.is_finite() => 1,
        _ if pieces < MAX_PIECES => pieces as u32 + 1,
        _ => MAX_PIECES as u32,
    }
}

/// The part of its second derivative that is taken from a curve before its inner points are computed.
///
/// A chord over the parameter range h is on average h² / 12 · C″ off the curve, always to the inside: with its
/// points on the curve, a disc would be too small. So the points move outwards by as much, and the polygon has the
/// curve's area. As the ends stay where they are, the others move a little farther, but no more than the chord's
/// greatest distance, h² / 8 · C″.
const fn balance_share(pieces: f32) -> f32 {
    let squares = pieces * pieces;
    if pieces > 2.0 { 1.0 / (12.0 * (squares - pieces)) } else { 0.125 / squares }
}

/// Writes the points of ((a·t + b)·t + c)·t + d at t = 1/n … (n − 1)/n, and `end`.
#[inline(always)]
fn polynomial<S: Simd, K: PolygonSink>(simd: S, [a, b, c, d]: [Point; 4], pieces: u32, end: Point, sink: &mut K) {
    let step = 1.0 / pieces as f32;
    let mut index = 1;
    loop {
        let counts = i32x8::simd_from(simd, [0, 1, 2, 3, 4, 5, 6, 7]) + index as i32;
        let t = counts.to_float::<f32x8<S>>() * step;
        let x = ((t * a.x + b.x) * t + c.x) * t + d.x;
        let y = ((t * a.y + b.y) * t + c.y) * t + d.y;
        let (low, high) = x.interleave(y);
        let points: [Point; 8] = bytemuck::cast([low.to_array(), high.to_array()]);
        sink.lines(&points, (pieces - index).min(8) as usize);
        index += 8;
        if index >= pieces {
            break;
        }
    }
    sink.line(end);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::level::{SimdLevel, dispatch};
    use crate::path::Path;

    #[derive(Default)]
    struct Points(Vec<Point>);

    impl PolygonSink for Points {
        fn begin(&mut self, p: Point) {
            self.0.push(p);
        }
        fn line(&mut self, p: Point) {
            self.0.push(p);
        }
        fn end(&mut self) {}
    }

    fn flattened(path: &Path) -> Vec<[f64; 2]> {
        let mut sink = Points::default();
        dispatch!(SimdLevel::Scalar, simd => {
            flatten_fill(simd, path.verbs(), path.points(), &mut sink);
        });
        sink.0.iter().map(|p| [f64::from(p.x), f64::from(p.y)]).collect()
    }

    /// Twice the signed area.
    fn double_area(points: &[[f64; 2]]) -> f64 {
        points.iter().zip(points.iter().cycle().skip(1)).map(|(a, b)| a[0] * b[1] - a[1] * b[0]).sum()
    }

    #[test]
    fn flattened_curves_keep_their_area() {
        // A curve of control points p encloses with its chord, by Green's theorem, these sums of cross products.
        let quad = [[10.0, 10.0], [60.0, 250.0], [200.0, 30.0]];
        let cubic = [[10.0, 10.0], [60.0, 150.0], [180.0, 160.0], [200.0, 30.0]];
        let cross = |a: [f64; 2], b: [f64; 2]| a[0] * b[1] - a[1] * b[0];
        let [a, b, c] = quad;
        let quad_area = (2.0 * cross(a, b) + 2.0 * cross(b, c) + cross(a, c)) / 3.0 + cross(c, a);
        let [p, q, r, s] = cubic;
        let cubic_area = (6.0 * cross(p, q)
            + 3.0 * cross(p, r)
            + cross(p, s)
            + 3.0 * cross(q, r)
            + 3.0 * cross(q, s)
            + 6.0 * cross(r, s))
            / 10.0
            + cross(s, p);
        let point = |p: [f64; 2]| Point::new(p[0] as f32, p[1] as f32);
        let mut path = Path::new();
        path.move_to(point(a)).quad_to(point(b), point(c));
        let mut other = Path::new();
        other.move_to(point(p)).cubic_to(point(q), point(r), point(s));
        for (path, area) in [(path, quad_area), (other, cubic_area)] {
            let points = flattened(&path);
            assert!(points.len() > 8, "{} points", points.len());
            // Points on the curve would lose an area of two thirds of the tolerance along some 300 pixels.
            let lost = (double_area(&points) - area).abs() / 2.0;
            assert!(lost < 0.05 * 300.0 * f64::from(TOLERANCE), "{lost} of {area}");
        }
    }

    #[test]
    fn flattened_curves_stay_within_the_tolerance() {
        for (c1, c2) in [((60.0, 250.0), (70.0, 30.0)), ((300.0, 0.0), (-100.0, 200.0)), ((12.0, 13.0), (15.0, 12.0))] {
            let mut path = Path::new();
            path.move_to((10.0, 10.0)).cubic_to(c1, c2, (20.0, 30.0));
            let chords = flattened(&path);
            for step in 0..=1000 {
                let t = f64::from(step) / 1000.0;
                let u = 1.0 - t;
                let at = |a: f64, b: f32, c: f32, d: f64| {
                    a * u * u * u + 3.0 * (f64::from(b) * u * u * t + f64::from(c) * u * t * t) + d * t * t * t
                };
                let [x, y] = [at(10.0, c1.0, c2.0, 20.0), at(10.0, c1.1, c2.1, 30.0)];
                let nearest = chords.windows(2).map(|chord| {
                    let [ax, ay] = chord[0];
                    let (dx, dy) = (chord[1][0] - ax, chord[1][1] - ay);
                    let along = (((x - ax) * dx + (y - ay) * dy) / (dx * dx + dy * dy)).clamp(0.0, 1.0);
                    let (ex, ey) = (x - ax - dx * along, y - ay - dy * along);
                    (ex * ex + ey * ey).sqrt()
                });
                let distance = nearest.fold(f64::MAX, f64::min);
                assert!(distance <= f64::from(TOLERANCE) + 1e-4, "{distance} at {t} with {c1:?} {c2:?}");
            }
        }
    }
}
