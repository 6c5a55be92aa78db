//! Outlines that leave the pixels to be drawn: their edges cut to a rectangle.
//!
//! Edges left and right of the rectangle are laid onto its sides, so that the windings inside stay right and those
//! outside are zero; edges above and below are dropped.

use super::edge::{Edge, EdgeLine};
use crate::geom::{IntRect, Point};
use crate::num::fixed;

/// The rectangle that edges are cut to, in fixed point, and where they go.
pub(crate) struct Cutter<F: FnMut(Edge)> {
    x_min: i32,
    x_max: i32,
    y_min: i32,
    y_max: i32,
    /// Whether what lies right of the rectangle can be dropped, because nothing is drawn there.
    open_right: bool,
    list: F,
}

impl<F: FnMut(Edge)> Cutter<F> {
    /// Cuts to `clip`. `open_right` says that no pixel right of `clip` can be drawn.
    pub(crate) fn new(clip: IntRect, open_right: bool, list: F) -> Self {
        Self {
            x_min: clip.left << fixed::SHIFT,
            x_max: clip.right << fixed::SHIFT,
            y_min: clip.top << fixed::SHIFT,
            y_max: clip.bottom << fixed::SHIFT,
            open_right,
            list,
        }
    }

    /// Cuts the edges of a closed polygon, in device pixels.
    pub(crate) fn polygon(&mut self, points: &[Point]) {
        let Some((first, rest)) = points.split_first() else { return };
        let (mut last, mut last_fixed) = (*first, to_fixed(*first));
        for p in rest.iter().chain(std::iter::once(first)) {
            let p_fixed = to_fixed(*p);
            match (last_fixed, p_fixed) {
                (Some(from), Some(to)) => self.edge(from, to),
                _ => self.far_edge(last, *p),
            }
            (last, last_fixed) = (*p, p_fixed);
        }
    }

    /// An edge between two points in fixed point, each within 2^28 of the origin.
    #[inline(always)]
    pub(super) fn edge(&mut self, (x0, y0): (i32, i32), (x1, y1): (i32, i32)) {
        if y0 == y1 {
            return;
        }
        let outside = |v: i32, low: i32, high: i32| v < low || v > high;
        if outside(x0, self.x_min, self.x_max)
            || outside(x1, self.x_min, self.x_max)
            || outside(y0, self.y_min, self.y_max)
            || outside(y1, self.y_min, self.y_max)
        {
            self.clipped_edge(Edge { x0, y0, x1, y1 });
        } else {
            (self.list)(Edge { x0, y0, x1, y1 });
        }
    }

    /// An edge that may leave the clip rectangle.
    #[inline(never)]
    fn clipped_edge(&mut self, edge: Edge) {
        let (mut x0, mut y0, mut x1, mut y1, winding) = edge.downward();
        if y1 <= self.y_min || y0 >= self.y_max || (self.open_right && x0 >= self.x_max && x1 >= self.x_max) {
            return;
        }
        let line = EdgeLine::new(x0, y0, x1, y1);
        if y0 < self.y_min {
            (x0, y0) = (line.x_at(self.y_min), self.y_min);
        }
        if y1 > self.y_max {
            (x1, y1) = (line.x_at(self.y_max), self.y_max);
        }
        // Where the line crosses the left and the right side, cut it; each piece then lies on one side.
        let mut cuts = [(x0, y0), (x1, y1), (x1, y1), (x1, y1)];
        let mut count = 1;
        let sides = if x0 < x1 { [self.x_min, self.x_max] } else { [self.x_max, self.x_min] };
        for side in sides {
            if (x0 < side) != (x1 < side) && x0 != side && x1 != side {
                let rise = i64::from(side - x0) * i64::from(y1 - y0);
                let run = i64::from(x1 - x0);
                // Round half up; the quotient lies in 0 ..= y1 − y0.
                let y = y0 + ((2 * rise.abs() + run.abs()) / (2 * run.abs())) as i32;
                if let Some(cut) = cuts.get_mut(count) {
                    *cut = (side, y);
                    count += 1;
                }
            }
        }
        if let Some(cut) = cuts.get_mut(count) {
            *cut = (x1, y1);
        }
        for pair in cuts.windows(2).take(count) {
            if let [(xa, ya), (xb, yb)] = *pair {
                if ya >= yb || (self.open_right && xa >= self.x_max && xb >= self.x_max) {
                    continue;
                }
                let (xa, xb) = (xa.clamp(self.x_min, self.x_max), xb.clamp(self.x_min, self.x_max));
                (self.list)(if winding > 0 {
                    Edge { x0: xa, y0: ya, x1: xb, y1: yb }
                } else {
                    Edge { x0: xb, y0: yb, x1: xa, y1: ya }
                });
            }
        }
    }

    /// An edge with an end beyond the range of fixed point: cut in `f64` to where it can be
    /// represented, with what lies beyond the left and right ends laid onto them.
    #[inline(never)]
    fn far_edge(&mut self, from: Point, to: Point) {
        let limit = f64::from(fixed::LIMIT);
        let (mut a, mut b) = ((f64::from(from.x), f64::from(from.y)), (f64::from(to.x), f64::from(to.y)));
        if (a.1 < -limit && b.1 < -limit) || (a.1 > limit && b.1 > limit) {
            return;
        }
        // Cut at ±limit in y: both ends are then inside in y, and the piece between keeps its winding.
        let at_y = |y: f64| {
            let t = (y - f64::from(from.y)) / (f64::from(to.y) - f64::from(from.y));
            (f64::from(from.x) * (1.0 - t) + f64::from(to.x) * t, y)
        };
        let (from_x, to_x) = (a.0, b.0);
        if a.1.abs() > limit {
            a = at_y(limit.copysign(a.1));
        }
        if b.1.abs() > limit {
            b = at_y(limit.copysign(b.1));
        }
        let (low, high) = if from_x < to_x { (from_x, to_x) } else { (to_x, from_x) };
        (a.0, b.0) = (a.0.clamp(low, high), b.0.clamp(low, high));
        // Cut at ±limit in x; the outer pieces become vertical.
        let mut points = [a, a, b, b];
        let at_x = |x: f64| {
            let t = (x - a.0) / (b.0 - a.0);
            (x, a.1 * (1.0 - t) + b.1 * t)
        };
        if a.0.abs() > limit && (b.0.abs() <= limit || b.0.signum() != a.0.signum()) {
            points[1] = at_x(limit.copysign(a.0));
        }
        if b.0.abs() > limit && (a.0.abs() <= limit || b.0.signum() != a.0.signum()) {
            points[2] = at_x(limit.copysign(b.0));
        }
        let points =
            points.map(|(x, y)| (fixed::from_f64(x.clamp(-limit, limit)), fixed::from_f64(y.clamp(-limit, limit))));
        for pair in points.windows(2) {
            if let [a, b] = *pair {
                self.edge(a, b);
            }
        }
    }
}

/// `p` in fixed point, if it is in range.
#[inline(always)]
fn to_fixed(p: Point) -> Option<(i32, i32)> {
    (p.x.abs() <= fixed::LIMIT && p.y.abs() <= fixed::LIMIT).then(|| (fixed::from_f32(p.x), fixed::from_f32(p.y)))
}
