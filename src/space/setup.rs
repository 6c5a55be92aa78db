//! Triangle set-up: from three screen vertices to exact integer edge functions and interpolation planes.
//!
//! Edge functions after Pineda, *A parallel algorithm for polygon rasterization*, 1988. Positions are 24.8 fixed point; all
//! samples of one kind lie at the same fraction of their pixel, so that an edge function over pixels is a·X + b·Y + k with k the
//! exact value at that fraction, divided by 256 and rounded down: its sign is the exact one.

use super::vertex::{FINE, ScreenVertex};

/// An edge function over pixels: not negative at (X, Y) where the sample is inside, ties by the top-left rule included.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Edge {
    /// Step to the right: at most 2^25.
    pub(crate) a: i32,
    /// Step down.
    pub(crate) b: i32,
    /// The value at pixel (0, 0), in double width, before the sample's fraction: E(0, 0) · 256 with the tie's bias.
    origin: i64,
}

impl Edge {
    /// The edge from `p` to `q` of a triangle that lies to its right on the screen (clockwise, y down).
    #[inline(always)]
    fn new(p: &ScreenVertex, q: &ScreenVertex, conservative: bool) -> Self {
        let (a, b) = (p.y() - q.y(), q.x() - p.x());
        // Top-left rule: a centre on an edge belongs to the triangle whose left or upper edge it is.
        let owns_ties = a > 0 || (a == 0 && b > 0);
        let mut origin = -(i64::from(a) * i64::from(p.x()) + i64::from(b) * i64::from(p.y())) - i64::from(!owns_ties);
        if conservative {
            // The pixel's corner that is farthest inside, ties included.
            origin += (i64::from(a.abs()) + i64::from(b.abs())) * 128 + i64::from(!owns_ties);
        }
        Self { a, b, origin }
    }

    /// The value at pixel (0, 0) for samples at the fraction (x, y) of 1/256 pixel.
    #[inline(always)]
    pub(crate) fn constant(&self, x: i32, y: i32) -> i64 {
        (self.origin + i64::from(self.a) * i64::from(x) + i64::from(self.b) * i64::from(y)) >> 8
    }
}

/// A box of pixels, the right and lower sides excluded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct PixelBox {
    pub(crate) left: i32,
    pub(crate) top: i32,
    pub(crate) right: i32,
    pub(crate) bottom: i32,
}

impl PixelBox {
    #[inline(always)]
    pub(crate) fn is_empty(&self) -> bool {
        self.left >= self.right || self.top >= self.bottom
    }

    #[inline(always)]
    pub(crate) fn intersect(&self, other: &Self) -> Self {
        Self {
            left: self.left.max(other.left),
            top: self.top.max(other.top),
            right: self.right.min(other.right),
            bottom: self.bottom.min(other.bottom),
        }
    }
}

/// Where samples lie in their pixel, at the least and at the most, in 1/256 pixel.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SampleExtent {
    pub(crate) least: (i32, i32),
    pub(crate) most: (i32, i32),
}

impl SampleExtent {
    pub(crate) fn new(positions: &[(u8, u8)], conservative: bool) -> Self {
        if conservative {
            return Self { least: (0, 0), most: (256, 256) };
        }
        let mut extent = Self { least: (256, 256), most: (0, 0) };
        for (x, y) in positions {
            let (x, y) = (i32::from(*x) * 16, i32::from(*y) * 16);
            extent.least = (extent.least.0.min(x), extent.least.1.min(y));
            extent.most = (extent.most.0.max(x), extent.most.1.max(y));
        }
        extent
    }
}

/// The pixels whose samples may be inside the box of some vertices.
#[inline(always)]
pub(crate) fn sample_box(x: [i32; 3], y: [i32; 3], extent: &SampleExtent) -> PixelBox {
    let (min_x, max_x) = (x[0].min(x[1]).min(x[2]), x[0].max(x[1]).max(x[2]));
    let (min_y, max_y) = (y[0].min(y[1]).min(y[2]), y[0].max(y[1]).max(y[2]));
    PixelBox {
        left: (min_x - extent.most.0 + 255) >> 8,
        top: (min_y - extent.most.1 + 255) >> 8,
        right: ((max_x - extent.least.0) >> 8) + 1,
        bottom: ((max_y - extent.least.1) >> 8) + 1,
    }
}

/// Twice the signed area in (1/256 pixel)²: positive where the vertices run clockwise on the screen.
#[inline(always)]
pub(crate) fn double_area(v: &[ScreenVertex; 3]) -> i64 {
    let (x1, y1) = (i64::from(v[1].x() - v[0].x()), i64::from(v[1].y() - v[0].y()));
    let (x2, y2) = (i64::from(v[2].x() - v[0].x()), i64::from(v[2].y() - v[0].y()));
    x1 * y2 - x2 * y1
}

/// The three edges of a triangle that runs clockwise.
#[inline(always)]
pub(crate) fn edges(v: &[ScreenVertex; 3], conservative: bool) -> [Edge; 3] {
    [
        Edge::new(&v[0], &v[1], conservative),
        Edge::new(&v[1], &v[2], conservative),
        Edge::new(&v[2], &v[0], conservative),
    ]
}

/// How the weights of the second and third vertex grow over the screen: value(x, y) = v0 + (v1 − v0)·w1 + (v2 − v0)·w2 with
/// w1 = l1 + x1·dx + y1·dy and so on, dx and dy in pixels from the first vertex on the subpixel grid.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Gradients {
    /// The first vertex in pixels, snapped: exact, so that steps to pixels' centres are, too.
    pub(crate) x0: f32,
    pub(crate) y0: f32,
    pub(crate) x1: f32,
    pub(crate) y1: f32,
    pub(crate) x2: f32,
    pub(crate) y2: f32,
    /// The weights there: not 0, as planes go through the first vertex as it was.
    pub(crate) l1: f32,
    pub(crate) l2: f32,
}

impl Gradients {
    /// Those of a triangle of twice the area `area` on the subpixel grid (in (1/256 pixel)², not 0), through its positions before snapping.
    #[inline(always)]
    pub(crate) fn of_triangle(v: &[ScreenVertex; 3], area: i64) -> Self {
        let p = v.map(|v| (i64::from(v.fine_x), i64::from(v.fine_y)));
        // Sides of at most 130,000 pixels, 2^30.99 in these units: products fit, and so does their difference, at most the box's area.
        let fine = (p[1].0 - p[0].0) * (p[2].1 - p[0].1) - (p[2].0 - p[0].0) * (p[1].1 - p[0].1);
        let rounded = fine >> (2 * FINE);
        let base = (v[0].x(), v[0].y());
        if rounded <= area >> 1 || rounded >> 1 >= area {
            // So thin that snapping made another triangle of it: planes through the one that is drawn.
            return Self::new(v.map(|v| (i64::from(v.x()), i64::from(v.y()))), area, 256.0, base);
        }
        let gradients = Self::new(p, fine, (256 << FINE) as f32, base);
        let rest = |snapped: i32, fine: i32| ((snapped << FINE) - fine) as f32 / (256 << FINE) as f32;
        let (dx, dy) = (rest(base.0, v[0].fine_x), rest(base.1, v[0].fine_y));
        let (l1, l2) = (gradients.x1 * dx + gradients.y1 * dy, gradients.x2 * dx + gradients.y2 * dy);
        Self { l1, l2, ..gradients }
    }

    /// Those of positions in units of 1 / `unit` pixels, from a base in 1/256 pixels.
    #[inline(always)]
    fn new(p: [(i64, i64); 3], area: i64, unit: f32, base: (i32, i32)) -> Self {
        let scale = unit / area as f32;
        let step = |d: i64| d as f32 * scale;
        Self {
            x0: base.0 as f32 / 256.0,
            y0: base.1 as f32 / 256.0,
            x1: step(p[2].1 - p[0].1),
            y1: step(p[0].0 - p[2].0),
            x2: step(p[0].1 - p[1].1),
            y2: step(p[1].0 - p[0].0),
            l1: 0.0,
            l2: 0.0,
        }
    }

    /// Those of a line: the weight of the second vertex grows along it alone.
    pub(crate) fn of_line(a: &ScreenVertex, b: &ScreenVertex) -> Self {
        let (dx, dy) = ((b.x() - a.x()) as f32 / 256.0, (b.y() - a.y()) as f32 / 256.0);
        let length = dx * dx + dy * dy;
        let scale = if length > 0.0 { 1.0 / length } else { 0.0 };
        let (x0, y0) = (a.x() as f32 / 256.0, a.y() as f32 / 256.0);
        Self { x0, y0, x1: dx * scale, y1: dy * scale, ..Self::default() }
    }

    /// A value at the three vertices as its value at the base and its steps right and down.
    #[inline(always)]
    pub(crate) fn plane(&self, v0: f32, v1: f32, v2: f32) -> [f32; 3] {
        let (d1, d2) = (v1 - v0, v2 - v0);
        [v0 + (d1 * self.l1 + d2 * self.l2), d1 * self.x1 + d2 * self.x2, d1 * self.y1 + d2 * self.y2]
    }
}
