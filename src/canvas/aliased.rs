//! Aliased primitives on the canvas: whole pixels, without the transform.

use super::Canvas;
use crate::display_list::{Geometry, Paint, Span, ToPaint};
use crate::geom::{IntRect, Point};
use crate::num::level::{SimdLevel, dispatch_up_to_avx2};
use crate::path::flatten::{PolygonSink, flatten_fill};
use crate::path::{Path, Segment, Verb};
use crate::raster::{circle, line, polygon};
use crate::style::FillRule;

/// Coordinates of these calls are device pixels: (x, y) names the pixel whose top left corner it is. The
/// transform does not matter; clips, layers, paints and blend modes do. A pixel that a call meets twice is painted once.
impl Canvas<'_> {
    /// Paints the pixels of a Bresenham line, both ends included. See [`raster::line::bresenham`](line::bresenham).
    pub fn draw_pixel_line(&mut self, from: (i32, i32), to: (i32, i32), paint: impl ToPaint) {
        self.draw_pixels(&paint.to_paint(), |clip, out| out.extend(line::bresenham(from, to).clipped(clip)));
    }

    /// Paints every pixel that a line between two pixels' centres touches. See
    /// [`raster::line::supercover`](line::supercover).
    pub fn draw_supercover_line(&mut self, from: (i32, i32), to: (i32, i32), paint: impl ToPaint) {
        self.draw_pixels(&paint.to_paint(), |clip, out| out.extend(line::supercover(from, to).clipped(clip)));
    }

    /// Paints an open chain of Bresenham lines. See [`raster::line::polyline`](line::polyline).
    pub fn draw_pixel_polyline(&mut self, points: &[(i32, i32)], paint: impl ToPaint) {
        self.draw_pixels(&paint.to_paint(), |clip, out| out.extend(line::polyline(points).clipped(clip)));
    }

    /// Paints a polygon's outline of Bresenham lines. See [`raster::line::outline`](line::outline).
    pub fn draw_pixel_polygon(&mut self, points: &[(i32, i32)], paint: impl ToPaint) {
        self.draw_pixels(&paint.to_paint(), |clip, out| out.extend(line::outline(points).clipped(clip)));
    }

    /// Paints the pixels of a midpoint circle. See [`raster::circle::circle`](circle::circle).
    pub fn draw_pixel_circle(&mut self, center: (i32, i32), radius: u32, paint: impl ToPaint) {
        self.draw_pixels(&paint.to_paint(), |clip, out| out.extend(circle::circle(center, radius).clipped(clip)));
    }

    /// Paints the pixels of a midpoint circle and those inside it. See
    /// [`raster::circle::filled_circle`](circle::filled_circle).
    pub fn fill_pixel_circle(&mut self, center: (i32, i32), radius: u32, paint: impl ToPaint) {
        self.draw_spans(&paint.to_paint(), |clip, out| {
            out.extend(circle::filled_circle(center, radius).clipped(clip).map(span));
        });
    }

    /// Paints the pixels whose centre lies inside a polygon. See [`raster::polygon::fill`](polygon::fill). This is also what
    /// [`fill_polygon`](Self::fill_polygon) gives with [`Antialias::None`](crate::Antialias::None) and no transform.
    pub fn fill_pixel_polygon(&mut self, points: &[Point], rule: FillRule, paint: impl ToPaint) {
        self.draw_spans(&paint.to_paint(), |clip, out| {
            polygon::fill(points, rule, clip, |y, columns| out.push(span((y, columns))));
        });
    }

    fn draw_pixels(&mut self, paint: &Paint, pixels: impl Fn(IntRect, &mut Vec<(i32, i32)>)) {
        self.draw_spans(paint, |clip, out| {
            let mut list = Vec::new();
            pixels(clip, &mut list);
            out.extend(list.into_iter().map(|(x, y)| Span { y, start: x, end: x + 1 }));
        });
    }

    fn draw_spans(&mut self, paint: &Paint, spans: impl Fn(IntRect, &mut Vec<Span>)) {
        self.draw(paint, |canvas| {
            let mut list = Vec::new();
            let (dx, dy) = canvas.state.origin();
            let bounds = canvas.state.bounds;
            let on_device =
                IntRect::from_ltrb(bounds.left - dx, bounds.top - dy, bounds.right - dx, bounds.bottom - dy);
            spans(on_device, &mut list);
            for span in &mut list {
                *span = Span { y: span.y + dy, start: span.start + dx, end: span.end + dx };
            }
            canvas.record_spans(list)
        });
    }

    /// Stores spans, joined and in order of rows, with the pixels that they touch.
    fn record_spans(&mut self, mut spans: Vec<Span>) -> Option<(Geometry, IntRect)> {
        spans.sort_unstable_by_key(|span| (span.y, span.start));
        let mut bounds: Option<IntRect> = None;
        let first = self.list.spans.len();
        for span in spans {
            let own = IntRect::from_ltrb(span.start, span.y, span.end, span.y + 1);
            bounds = Some(bounds.map_or(own, |all| {
                IntRect::from_ltrb(all.left.min(own.left), all.top, all.right.max(own.right), own.bottom)
            }));
            match self.list.spans.get_mut(first..).and_then(|own| own.last_mut()) {
                Some(last) if last.y == span.y && span.start <= last.end => last.end = last.end.max(span.end),
                _ => self.list.spans.push(span),
            }
        }
        let range = (u32::try_from(first).ok()?, u32::try_from(self.list.spans.len()).ok()?);
        Some((Geometry::Spans(range), bounds?))
    }

    /// Stores the Bresenham lines along a path under the current transform: a stroke of width 0 without
    /// antialiasing. A point lies in the pixel that holds it.
    pub(super) fn record_pixel_outline(&mut self, path: &Path) -> Option<(Geometry, IntRect)> {
        let clip = self.device_bounds(path, 0.0)?.intersect(self.state.bounds);
        let transform = self.state.to_pixels();
        let mut chain = Chain::default();
        let mut start = Point::ZERO;
        let mut last = Point::ZERO;
        let mut pixels = Vec::new();
        for segment in path.segments() {
            let (verb, points) = match segment {
                Segment::MoveTo(p) => {
                    pixels.extend(line::polyline(&chain.points).clipped(clip));
                    chain.points.clear();
                    (start, last) = (p, p);
                    continue;
                }
                Segment::LineTo(p) => (Verb::LineTo, vec![last, p]),
                Segment::QuadTo(c, p) => (Verb::QuadTo, vec![last, c, p]),
                Segment::CubicTo(c1, c2, p) => (Verb::CubicTo, vec![last, c1, c2, p]),
                Segment::Close => (Verb::LineTo, vec![last, start]),
            };
            let placed: Vec<Point> = points.iter().map(|p| transform.map(*p)).collect();
            dispatch_up_to_avx2!(SimdLevel::best(), simd => {
                flatten_fill(simd, &[Verb::MoveTo, verb], &placed, &mut chain);
            });
            last = points.last().copied().unwrap_or(last);
        }
        pixels.extend(line::polyline(&chain.points).clipped(clip));
        self.record_spans(pixels.into_iter().map(|(x, y)| Span { y, start: x, end: x + 1 }).collect())
    }
}

/// Collects the pixels that hold the points of a chain of lines.
#[derive(Default)]
struct Chain {
    points: Vec<(i32, i32)>,
}

impl Chain {
    fn add(&mut self, p: Point) {
        let pixel = (p.x.floor() as i32, p.y.floor() as i32);
        if self.points.last() != Some(&pixel) {
            self.points.push(pixel);
        }
    }
}

impl PolygonSink for Chain {
    fn begin(&mut self, p: Point) {
        self.add(p);
    }

    fn line(&mut self, p: Point) {
        self.add(p);
    }

    fn end(&mut self) {}
}

fn span((y, columns): (i32, std::ops::Range<i32>)) -> Span {
    Span { y, start: columns.start, end: columns.end }
}
