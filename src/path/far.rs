//! Lines that come from so far away, or go so far, that `f32` has no digits left for a pen's width there: cut to where
//! they can matter.

use super::Segment;
use super::flatten::PolygonSink;
use super::outline::{Outliner, PointMap};
use super::stroke::Subpath;
use crate::geom::{Point, Transform};

/// Device positions beyond this many pixels are far, and out of sight: at its edge, `f32` still has 1/128 pixel.
pub(super) const FAR: f64 = 65_536.0;
/// A pen that reaches farther could be seen from there.
const WIDEST: f32 = 16_384.0;

/// Strokes a subpath of lines with a far corner, in device space; false if it is none.
///
/// What joins at far corners cannot be seen, so that the subpath is cut there into open ones.
pub(super) fn stroke_far_lines<A: PointMap, K: PolygonSink>(
    subpath: &Subpath<'_>,
    transform: Transform,
    outliner: &mut Outliner<'_, A, K>,
) -> bool {
    let map = |p: Point| {
        let [x, y] = [f64::from(p.x), f64::from(p.y)];
        [
            f64::from(transform.sx) * x + f64::from(transform.kx) * y + f64::from(transform.tx),
            f64::from(transform.ky) * x + f64::from(transform.sy) * y + f64::from(transform.ty),
        ]
    };
    let mut corners = vec![map(subpath.start)];
    for segment in subpath.segments() {
        let Segment::LineTo(p) = segment else { return false };
        corners.push(map(p));
    }
    let Some(first_far) = corners.iter().position(|corner| is_far(*corner)) else { return false };
    if outliner.pen.reach() > WIDEST {
        return false;
    }
    if subpath.closed {
        // From a far corner all around to it: the corner at which the subpath starts is then one like the others.
        corners.rotate_left(first_far);
        corners.extend(corners.first().copied());
    }
    let mut walking = false;
    for pair in corners.windows(2) {
        let [from, to] = *pair else { break };
        let Some((enter, leave)) = cut(from, to) else {
            if std::mem::take(&mut walking) {
                outliner.finish();
            }
            continue;
        };
        if enter != from && std::mem::take(&mut walking) {
            outliner.finish();
        }
        if !walking {
            outliner.begin(point(enter), false);
            walking = true;
        }
        outliner.line(point(leave));
        if leave != to {
            outliner.finish();
            walking = false;
        }
    }
    if walking {
        outliner.finish();
    }
    true
}

fn point([x, y]: [f64; 2]) -> Point {
    Point::new(x as f32, y as f32)
}

/// The part of a line that is not far, from where to where.
///
/// Where it crosses a side comes from the line's equation, not from a fraction of its length: of lines a thousand
/// times longer than a fraction can tell, level ones stay level and diagonals diagonal.
fn cut(from: [f64; 2], to: [f64; 2]) -> Option<([f64; 2], [f64; 2])> {
    let ([ax, ay], [bx, by]) = (from, to);
    let (dx, dy) = (bx - ax, by - ay);
    let c = ay * dx - ax * dy;
    let mut ends: Option<([f64; 2], [f64; 2])> = None;
    for side in [-FAR, FAR] {
        let on_x = ((side - ax) * (side - bx) <= 0.0 && dx != 0.0).then(|| [side, (c + side * dy) / dx]);
        let on_y = ((side - ay) * (side - by) <= 0.0 && dy != 0.0).then(|| [(side * dx - c) / dy, side]);
        for p in [on_x, on_y].into_iter().flatten().filter(|p| p[0].abs() <= FAR && p[1].abs() <= FAR) {
            let along = |p: [f64; 2]| p[0] * dx + p[1] * dy;
            ends = Some(match ends {
                None => (p, p),
                Some((first, last)) => {
                    (if along(p) < along(first) { p } else { first }, if along(p) > along(last) { p } else { last })
                }
            });
        }
    }
    let enter = if is_far(from) { ends?.0 } else { from };
    let leave = if is_far(to) { ends?.1 } else { to };
    Some((enter, leave))
}

fn is_far([x, y]: [f64; 2]) -> bool {
    x.abs() > FAR || y.abs() > FAR
}
