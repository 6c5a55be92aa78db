//! Edges: the straight pieces of outlines in 24.8 fixed point, clipped, and listed by band.

use crate::geom::{IntRect, Point};
use crate::num::fixed;
use crate::path::flatten::PolygonSink;

/// A piece of an outline from (x0, y0) to (x1, y1) in 1/256 pixel. Never horizontal; it winds
/// positively where it goes down.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Edge {
    pub(crate) x0: i32,
    pub(crate) y0: i32,
    pub(crate) x1: i32,
    pub(crate) y1: i32,
}

impl Edge {
    /// The edge from top to bottom, and its winding: (x0, y0, x1, y1, ±1).
    #[inline(always)]
    pub(crate) fn downward(self) -> (i32, i32, i32, i32, i32) {
        if self.y0 < self.y1 {
            (self.x0, self.y0, self.x1, self.y1, 1)
        } else {
            (self.x1, self.y1, self.x0, self.y0, -1)
        }
    }
}

impl Edge {
    /// Whether `next` starts where this edge ends and goes on up or down as it does.
    #[inline(always)]
    pub(crate) fn goes_on_with(self, next: Self) -> bool {
        (self.x1, self.y1) == (next.x0, next.y0) && (self.y0 < self.y1) == (next.y0 < next.y1)
    }
}

/// A line through an edge, from which x at any y is one multiplication away.
///
/// x(y) is a pure function of the edge and of y, so that bands, strips and rows that share a scanline
/// agree on where it is crossed.
#[derive(Clone, Copy, Debug)]
pub(crate) struct EdgeLine {
    x0: i64,
    y0: i64,
    /// dx / dy in 32.32 fixed point.
    slope: i64,
}

impl EdgeLine {
    /// The line through (x0, y0) and (x1, y1), y0 < y1, |x1 − x0| < 2^30.
    #[inline(always)]
    pub(crate) fn new(x0: i32, y0: i32, x1: i32, y1: i32) -> Self {
        let slope = (i64::from(x1) - i64::from(x0)) * (1 << 32) / (i64::from(y1) - i64::from(y0));
        Self { x0: i64::from(x0), y0: i64::from(y0), slope }
    }

    /// x at y in 20.12 fixed point, as [`x_at`](Self::x_at), for edges that are clipped to a surface.
    #[inline(always)]
    pub(crate) fn fine_x_at(self, y: i32) -> i32 {
        ((self.x0 << 4) + ((self.slope * (i64::from(y) - self.y0) + (1 << 27)) >> 28)) as i32
    }

    /// x at y, for y between the edge's ends: |slope · (y − y0)| ≤ |dx| · 2^32 < 2^62.
    #[inline(always)]
    pub(crate) fn x_at(self, y: i32) -> i32 {
        (self.x0 + ((self.slope * (i64::from(y) - self.y0) + (1 << 31)) >> 32)) as i32
    }
}

/// One draw's edges in one band: `edges[start..end]` belong to command `command`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BandItem {
    pub(crate) command: u32,
    pub(crate) start: u32,
    pub(crate) end: u32,
}

/// What one band has to draw, in the order of the commands.
#[derive(Debug, Default)]
pub(crate) struct BandList {
    pub(crate) edges: Vec<Edge>,
    pub(crate) items: Vec<BandItem>,
}

/// Lists of edges for each band of a frame.
///
/// An edge is copied into each band that it touches: a band then reads its edges as one stream, and
/// most edges touch one band only.
#[derive(Debug, Default)]
pub(crate) struct EdgeBins {
    bands: Vec<BandList>,
    /// log2 of a band's height in 1/256 pixel.
    band_shift: u32,
}

impl EdgeBins {
    /// Empties the bins and sets them up for bands of `1 << height_shift` rows.
    pub(crate) fn reset(&mut self, bands: usize, height_shift: u32) {
        self.band_shift = height_shift + fixed::SHIFT;
        for band in &mut self.bands {
            band.edges.clear();
            band.items.clear();
        }
        self.bands.resize_with(bands, BandList::default);
    }

    /// What was listed for band `index`.
    pub(crate) fn band(&self, index: usize) -> Option<&BandList> {
        self.bands.get(index)
    }

    /// Lists `command` for every band that `bounds` touches; edges added until the next call are its own.
    pub(crate) fn begin(&mut self, command: u32, bounds: IntRect) {
        for band in self.touched(bounds) {
            let start = band.edges.len() as u32;
            band.items.push(BandItem { command, start, end: start });
        }
    }

    /// Ends the edges of the command that [`begin`](Self::begin) listed with the same `bounds`, and drops it
    /// from the bands where it has none.
    pub(crate) fn end(&mut self, bounds: IntRect) {
        for band in self.touched(bounds) {
            let end = band.edges.len() as u32;
            if let Some(item) = band.items.last_mut() {
                item.end = end;
                if item.start == end {
                    band.items.pop();
                }
            }
        }
    }

    /// Lists `command`, which has no edges, for every band that `bounds` touches.
    pub(crate) fn list(&mut self, command: u32, bounds: IntRect) {
        self.begin(command, bounds);
    }

    fn touched(&mut self, bounds: IntRect) -> &mut [BandList] {
        if bounds.is_empty() {
            return &mut [];
        }
        let shift = self.band_shift - fixed::SHIFT;
        let first = (bounds.top.max(0) >> shift) as usize;
        let last = ((bounds.bottom.max(0) + (1 << shift) - 1) >> shift) as usize;
        let last = last.min(self.bands.len());
        self.bands.get_mut(first..last).unwrap_or(&mut [])
    }

    #[inline(always)]
    fn push(&mut self, edge: Edge) {
        let (low, high) = if edge.y0 < edge.y1 { (edge.y0, edge.y1) } else { (edge.y1, edge.y0) };
        let first = (low >> self.band_shift) as usize;
        let last = ((high - 1) >> self.band_shift) as usize;
        if first == last {
            if let Some(band) = self.bands.get_mut(first) {
                band.edges.push(edge);
            }
        } else if let Some(bands) = self.bands.get_mut(first..=last) {
            for band in bands {
                band.edges.push(edge);
            }
        }
    }
}

/// Takes polygons in device pixels, clips them to a rectangle and lists their edges by band.
///
/// Edges left and right of the rectangle are laid onto its sides, so that the windings inside stay
/// right and those outside are zero; edges above and below are dropped.
pub(crate) struct EdgeSink<'a> {
    bins: &'a mut EdgeBins,
    x_min: i32,
    x_max: i32,
    y_min: i32,
    y_max: i32,
    /// Whether what lies right of the rectangle can be dropped, because nothing is drawn there.
    open_right: bool,
    start: Point,
    last: Point,
    last_fixed: (i32, i32),
    start_fixed: (i32, i32),
    last_in_range: bool,
    start_in_range: bool,
}

impl<'a> EdgeSink<'a> {
    /// A sink that clips to `clip`. `open_right` says that no pixel right of `clip` can be drawn.
    pub(crate) fn new(bins: &'a mut EdgeBins, clip: IntRect, open_right: bool) -> Self {
        Self {
            bins,
            x_min: clip.left << fixed::SHIFT,
            x_max: clip.right << fixed::SHIFT,
            y_min: clip.top << fixed::SHIFT,
            y_max: clip.bottom << fixed::SHIFT,
            open_right,
            start: Point::ZERO,
            last: Point::ZERO,
            last_fixed: (0, 0),
            start_fixed: (0, 0),
            last_in_range: true,
            start_in_range: true,
        }
    }

    /// An edge between two points in fixed point, each within 2^28 of the origin.
    #[inline(always)]
    fn edge(&mut self, (x0, y0): (i32, i32), (x1, y1): (i32, i32)) {
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
            self.bins.push(Edge { x0, y0, x1, y1 });
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
                self.bins.push(if winding > 0 {
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

    #[inline(always)]
    fn connect(&mut self, p: Point, p_fixed: (i32, i32), in_range: bool) {
        if in_range && self.last_in_range {
            self.edge(self.last_fixed, p_fixed);
        } else {
            self.far_edge(self.last, p);
        }
    }
}

/// `p` in fixed point, and whether it is in range (if not, the first value means nothing).
#[inline(always)]
fn to_fixed(p: Point) -> ((i32, i32), bool) {
    ((fixed::from_f32(p.x), fixed::from_f32(p.y)), p.x.abs() <= fixed::LIMIT && p.y.abs() <= fixed::LIMIT)
}

impl PolygonSink for EdgeSink<'_> {
    #[inline(always)]
    fn begin(&mut self, p: Point) {
        (self.last_fixed, self.last_in_range) = to_fixed(p);
        self.last = p;
        (self.start, self.start_fixed, self.start_in_range) = (p, self.last_fixed, self.last_in_range);
    }

    #[inline(always)]
    fn line(&mut self, p: Point) {
        let (p_fixed, in_range) = to_fixed(p);
        self.connect(p, p_fixed, in_range);
        (self.last, self.last_fixed, self.last_in_range) = (p, p_fixed, in_range);
    }

    #[inline(always)]
    fn end(&mut self) {
        self.connect(self.start, self.start_fixed, self.start_in_range);
        (self.last, self.last_fixed, self.last_in_range) = (self.start, self.start_fixed, self.start_in_range);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn edges_of(points: &[(f32, f32)], clip: IntRect, open_right: bool) -> Vec<Edge> {
        let mut bins = EdgeBins::default();
        bins.reset(1, 12);
        bins.begin(0, clip);
        let mut sink = EdgeSink::new(&mut bins, clip, open_right);
        sink.begin(points[0].into());
        for p in &points[1..] {
            sink.line((*p).into());
        }
        sink.end();
        bins.end(clip);
        bins.band(0).unwrap().edges.clone()
    }

    /// The winding of a clipped outline at a pixel's centre, by the edges left of it.
    fn winding(edges: &[Edge], x: f64, y: f64) -> i32 {
        edges
            .iter()
            .map(|e| {
                let (x0, y0, x1, y1, s) = e.downward();
                let (x0, y0, x1, y1) =
                    (f64::from(x0) / 256.0, f64::from(y0) / 256.0, f64::from(x1) / 256.0, f64::from(y1) / 256.0);
                if y0 <= y && y < y1 && x0 + (x1 - x0) * (y - y0) / (y1 - y0) <= x { s } else { 0 }
            })
            .sum()
    }

    #[test]
    fn clipping_keeps_windings_inside_and_clears_them_outside() {
        let clip = IntRect::from_ltrb(10, 10, 30, 30);
        let far = 3e7;
        for points in [
            vec![(-5.0, 0.0), (50.0, 20.0), (0.0, 45.0)],
            vec![(0.0, 0.0), (40.0, 0.0), (40.0, 40.0), (0.0, 40.0)],
            vec![(-far, -far), (far, -far), (far, far), (-far, far)],
            vec![(15.0, -1e30), (25.0, -1e30), (20.0, 1e30)],
            vec![(-1e30, 15.0), (1e30, 15.5), (1e30, 25.3), (-1e30, 24.3)],
            vec![(12.0, 12.0), (f32::MAX, 20.0), (12.0, 28.0)],
        ] {
            for open_right in [false, true] {
                let edges = edges_of(&points, clip, open_right);
                for e in &edges {
                    assert!(e.y0 != e.y1 && [e.x0, e.x1].iter().all(|x| (2560..=7680).contains(x)), "{e:?}");
                    assert!([e.y0, e.y1].iter().all(|y| (2560..=7680).contains(y)), "{e:?}");
                }
                for y in 0..40 {
                    for x in 0..40 {
                        let (px, py) = (f64::from(x) + 0.5, f64::from(y) + 0.5);
                        let inside = (10..30).contains(&x) && (10..30).contains(&y);
                        if !inside && open_right && x >= 30 {
                            continue;
                        }
                        let n = points.len();
                        let mut nearest = f64::MAX;
                        let expected: i32 = (0..n)
                            .map(|i| {
                                let (x0, y0) = (f64::from(points[i].0), f64::from(points[i].1));
                                let (x1, y1) = (f64::from(points[(i + 1) % n].0), f64::from(points[(i + 1) % n].1));
                                let crosses = (y0 <= py) != (y1 <= py);
                                let t = (py - y0) / (y1 - y0);
                                let at = x0 * (1.0 - t) + x1 * t;
                                if crosses {
                                    nearest = nearest.min((at - px).abs());
                                }
                                if crosses && at <= px { if y1 > y0 { 1 } else { -1 } } else { 0 }
                            })
                            .sum();
                        if nearest > 0.02 {
                            let expected = if inside { expected } else { 0 };
                            assert_eq!(winding(&edges, px, py), expected, "({x}, {y}) of {points:?}");
                        }
                    }
                }
            }
        }
    }

    #[test]
    fn an_edge_is_listed_in_each_band_that_it_touches() {
        let mut bins = EdgeBins::default();
        bins.reset(4, 3);
        let clip = IntRect::from_ltrb(0, 0, 32, 32);
        bins.begin(7, clip);
        let mut sink = EdgeSink::new(&mut bins, clip, true);
        sink.begin(Point::new(1.0, 8.0));
        sink.line(Point::new(1.0, 24.0));
        sink.line(Point::new(9.0, 24.0));
        sink.end();
        bins.end(clip);
        let counts: Vec<_> = (0..4).map(|b| bins.band(b).unwrap().edges.len()).collect();
        assert_eq!(counts, [0, 2, 2, 0]);
        let items: Vec<_> = (0..4).map(|b| bins.band(b).unwrap().items.len()).collect();
        assert_eq!(items, [0, 1, 1, 0], "bands without edges do not list the command");
    }
}
