//! Curves to line segments.

use crate::geom::Point;

/// Takes closed polygons in device pixels, one point after another.
pub(crate) trait PolygonSink {
    /// Starts a polygon at `p`.
    fn begin(&mut self, p: Point);
    /// Adds a straight edge to `p`.
    fn line(&mut self, p: Point);
    /// Adds straight edges to the first `count` (0 ..= 8) points.
    #[inline(always)]
    fn lines(&mut self, points: &[Point; 8], count: usize) {
        for p in points.iter().take(count) {
            self.line(*p);
        }
    }
    /// Ends the polygon with an edge back to its start.
    fn end(&mut self);
}

use fearless_simd::prelude::*;
use fearless_simd::{f32x8, i32x8};

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
/// Sederberg, *Computer Aided Geometric Design*, §10.6), eight points at a time; see [`balance`] for where
/// the points lie. Subpaths of a single point are left out.
#[inline(always)]
pub(crate) fn flatten_fill<S: Simd, K: PolygonSink>(simd: S, verbs: &[Verb], points: &[Point], sink: &mut K) {
    let mut open = false;
    let mut start = Point::ZERO;
    let mut last = Point::ZERO;
    let mut rest = points;
    for verb in verbs {
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
                let Some(([c, p], after)) = rest.split_first_chunk() else { break };
                rest = after;
                let (c, p) = (*c, *p);
                let bend = last - c - (c - p);
                // |second derivative| / 8 / tolerance, for n² pieces.
                let pieces = piece_count(simd, bend.dot(bend), 0.25 / TOLERANCE);
                let b = (c - last) * 2.0;
                let start = last - bend * (2.0 * balance(pieces));
                polynomial(simd, [Point::ZERO, bend, b, start], pieces, p, sink);
                last = p;
            }
            Verb::CubicTo => {
                let Some(([c1, c2, p], after)) = rest.split_first_chunk() else { break };
                rest = after;
                let (c1, c2, p) = (*c1, *c2, *p);
                let (bend1, bend2) = (last - c1 - (c1 - c2), c1 - c2 - (c2 - p));
                let (d1, d2) = (bend1.dot(bend1), bend2.dot(bend2));
                let pieces = piece_count(simd, if d1 > d2 { d1 } else { d2 }, 0.75 / TOLERANCE);
                let a = (p - last) - (c2 - c1) * 3.0;
                let b = bend1 * 3.0;
                let share = balance(pieces);
                let c = (c1 - last) * 3.0 - a * (6.0 * share);
                polynomial(simd, [a, b, c, last - b * (2.0 * share)], pieces, p, sink);
                last = p;
            }
        }
    }
    if open {
        sink.end();
    }
}

/// ⌈√(factor · √squared)⌉ within 1 ..= [`MAX_PIECES`]; 1 if it is not finite.
#[inline(always)]
fn piece_count<S: Simd>(simd: S, squared: f32, factor: f32) -> u32 {
    // Comparing fourth powers needs no root, and all of them at once no branch: how many pieces a curve has is hard to
    // guess.
    let fourth = squared * (factor * factor);
    let powers = f32x8::simd_from(simd, [1.0, 16.0, 81.0, 256.0, 625.0, 1296.0, 2401.0, 4096.0]);
    let more = f32x8::splat(simd, fourth).simd_gt(powers).to_bitmask() as u32;
    if more < 0xff { more.count_ones() + 1 } else { many_pieces(fourth) }
}

/// As [`piece_count`], of the fourth power of the count, for curves of more than eight.
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
#[inline(always)]
fn balance(pieces: u32) -> f32 {
    const FEW: [f32; 17] = {
        let mut shares = [0.0; 17];
        let mut pieces = 1;
        while pieces < 17 {
            shares[pieces] = balance_share(pieces as f32);
            pieces += 1;
        }
        shares
    };
    // A division each would cost as much as a point of the curve.
    FEW.get(pieces as usize).copied().unwrap_or_else(|| balance_share(pieces as f32))
}

/// 1 / pieces.
#[inline(always)]
fn reciprocal(pieces: u32) -> f32 {
    const FEW: [f32; 17] = {
        let mut parts = [1.0; 17];
        let mut pieces = 1;
        while pieces < 17 {
            parts[pieces] = 1.0 / pieces as f32;
            pieces += 1;
        }
        parts
    };
    FEW.get(pieces as usize).copied().unwrap_or_else(|| 1.0 / pieces as f32)
}

const fn balance_share(pieces: f32) -> f32 {
    let squares = pieces * pieces;
    if pieces > 2.0 { 1.0 / (12.0 * (squares - pieces)) } else { 0.125 / squares }
}

/// Writes the points of ((a·t + b)·t + c)·t + d at t = 1/n … (n − 1)/n, and `end`.
#[inline(always)]
fn polynomial<S: Simd, K: PolygonSink>(simd: S, [a, b, c, d]: [Point; 4], pieces: u32, end: Point, sink: &mut K) {
    let step = reciprocal(pieces);
    let mut index = 1;
    loop {
        let counts = i32x8::simd_from(simd, [0, 1, 2, 3, 4, 5, 6, 7]) + index as i32;
        let t = counts.to_float::<f32x8<S>>() * step;
        let x = ((t * a.x + b.x) * t + c.x) * t + d.x;
        let y = ((t * a.y + b.y) * t + c.y) * t + d.y;
        let (low, high) = x.interleave(y);
        let points: [Point; 8] = bytemuck::cast([low.to_array(), high.to_array()]);
        // Curves of one piece go this way as well: no point counts then, and there is no branch.
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
