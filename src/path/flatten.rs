//! Curves to line segments.

use crate::geom::Point;

/// Takes closed polygons in device pixels, one point after another.
pub(crate) trait PolygonSink {
    /// Starts a polygon at `p`.
    fn begin(&mut self, p: Point);
    /// Adds a straight edge to `p`.
    fn line(&mut self, p: Point);
    /// Ends the polygon with an edge back to its start.
    fn end(&mut self);
}

use fearless_simd::prelude::*;
use fearless_simd::{f32x8, i32x8};

use super::builder::{Segment, Verb, segments};
use crate::geom::Transform;

/// How far, in device pixels, a flattened curve may lie from the true one: an eighth of what makes a
/// step of coverage visible along a whole pixel, and small against 24.8 rounding after squaring.
pub(crate) const TOLERANCE: f32 = 0.05;

/// A curve is never cut into more pieces than this; at [`TOLERANCE`] that is enough for a cubic of
/// 100,000 pixels.
const MAX_PIECES: f32 = 1024.0;

/// Writes a path as closed polygons in device pixels: what filling it covers.
///
/// Curves are cut at equal parameters into the number of pieces that Wang's formula gives (Wang 1984;
/// Sederberg, *Computer Aided Geometric Design*, §10.6), eight points at a time. Subpaths of a single
/// point are left out.
#[inline(always)]
pub(crate) fn flatten_fill<S: Simd, K: PolygonSink>(
    simd: S,
    verbs: &[Verb],
    points: &[Point],
    transform: Transform,
    sink: &mut K,
) {
    let mut open = false;
    let mut start = Point::ZERO;
    let mut last = Point::ZERO;
    for segment in segments(verbs, points) {
        match segment {
            Segment::MoveTo(p) => {
                if open {
                    sink.end();
                }
                open = false;
                start = transform.map(p);
                last = start;
                continue;
            }
            Segment::Close => {
                if open {
                    sink.end();
                }
                open = false;
                last = start;
                continue;
            }
            _ => {
                if !open {
                    sink.begin(last);
                    open = true;
                }
            }
        }
        match segment {
            Segment::LineTo(p) => {
                last = transform.map(p);
                sink.line(last);
            }
            Segment::QuadTo(c, p) => {
                let (c, p) = (transform.map(c), transform.map(p));
                let bend = last - c - (c - p);
                // |second derivative| / 8 / tolerance, for n² pieces.
                let pieces = piece_count(bend.dot(bend), 0.25 / TOLERANCE);
                let a = bend;
                let b = (c - last) * 2.0;
                polynomial(simd, [Point::ZERO, a, b, last], pieces, p, sink);
                last = p;
            }
            Segment::CubicTo(c1, c2, p) => {
                let (c1, c2, p) = (transform.map(c1), transform.map(c2), transform.map(p));
                let (bend1, bend2) = (last - c1 - (c1 - c2), c1 - c2 - (c2 - p));
                let (d1, d2) = (bend1.dot(bend1), bend2.dot(bend2));
                let pieces = piece_count(if d1 > d2 { d1 } else { d2 }, 0.75 / TOLERANCE);
                let a = (p - last) - (c2 - c1) * 3.0;
                let b = bend1 * 3.0;
                let c = (c1 - last) * 3.0;
                polynomial(simd, [a, b, c, last], pieces, p, sink);
                last = p;
            }
            Segment::MoveTo(_) | Segment::Close => {}
        }
    }
    if open {
        sink.end();
    }
}

/// ⌈√(factor · √squared)⌉ within 1 ..= [`MAX_PIECES`]; 1 if it is not finite.
#[inline(always)]
fn piece_count(squared: f32, factor: f32) -> u32 {
    let squares = factor * squared.sqrt();
    if squares <= 1.0 || !squares.is_finite() {
        return 1;
    }
    let pieces = squares.sqrt();
    if pieces < MAX_PIECES { pieces as u32 + 1 } else { MAX_PIECES as u32 }
}

/// Writes the points of ((a·t + b)·t + c)·t + d at t = 1/n … (n − 1)/n, and `end`.
#[inline(always)]
fn polynomial<S: Simd, K: PolygonSink>(simd: S, [a, b, c, d]: [Point; 4], pieces: u32, end: Point, sink: &mut K) {
    let step = 1.0 / pieces as f32;
    let mut index = 1;
    while index < pieces {
        let counts = i32x8::simd_from(simd, [0, 1, 2, 3, 4, 5, 6, 7]) + index as i32;
        let t = counts.to_float::<f32x8<S>>() * step;
        let x = ((t * a.x + b.x) * t + c.x) * t + d.x;
        let y = ((t * a.y + b.y) * t + c.y) * t + d.y;
        let (x, y) = (x.to_array(), y.to_array());
        for (x, y) in x.into_iter().zip(y).take((pieces - index) as usize) {
            sink.line(Point::new(x, y));
        }
        index += 8;
    }
    sink.line(end);
}
