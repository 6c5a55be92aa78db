//! Long polylines stroked stretch by stretch, so that threads can share one.
//!
//! A stretch is a closed polygon of its own: at either end, but the path's, it is cut from the last point that the left contour has
//! there to that of the right one. Its neighbour is cut along the same line the other way, so that in sums of areas the
//! two cuts vanish to the bit and what is left is the outline of the whole.

use super::builder::Verb;
use super::flatten::PolygonSink;
use super::outline::{Outliner, Pen, PointMap};
use super::stroke::{Job, StrokeScratch, reach};
use super::{Path, Stroke, far};
use crate::geom::{Point, Transform};

/// So many vertices are worth a stretch of their own: some 0.2 ms of work.
const VERTICES: usize = 8192;
/// No path has more stretches: each has lists for all bands.
const MOST: usize = 64;
/// Where a contour is at a cut is found by walking there over so many vertices.
const WARM_UP: usize = 16;

/// Which of a polyline's stretches.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Stretch {
    pub(crate) index: usize,
    pub(crate) count: usize,
}

/// Where a walk is between two segments, and the last points of its contours in device pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Cut {
    pub(super) at: Point,
    /// Direction and length of the step that led there.
    pub(super) last: (Point, f32),
    pub(super) left: Point,
    pub(super) right: Point,
}

/// How many stretches a path's stroke has. What the path alone decides, so that the pixels do not depend on who draws them:
/// one, which is all of it, unless it is one long open polyline, without dashes, nowhere far away.
#[inline]
pub(crate) fn stretches(path: &Path, style: &Stroke, transform: Transform) -> usize {
    let count = path.points().len() / VERTICES;
    if count > 1 && style.dash.is_none() && is_near_polyline(path, style, transform) { count.min(MOST) } else { 1 }
}

#[cold]
fn is_near_polyline(path: &Path, style: &Stroke, transform: Transform) -> bool {
    let is_open_polyline = path
        .verbs()
        .split_first()
        .is_some_and(|(first, rest)| *first == Verb::MoveTo && rest.iter().all(|verb| *verb == Verb::LineTo));
    is_open_polyline
        && path
            .control_bounds()
            .and_then(|bounds| reach(bounds, style, transform))
            .is_some_and(|reach| f64::from(reach.extent) <= far::FAR)
}

impl Job<'_> {
    /// Strokes one of several stretches.
    pub(super) fn run_stretch<B: PointMap, A: PointMap, K: PolygonSink>(
        &self,
        stretch: Stretch,
        (before, after): (B, A),
        pen: &Pen,
        scratch: &mut StrokeScratch,
        sink: &mut K,
    ) {
        let StrokeScratch { level, right, steps, .. } = scratch;
        let vertex = |cut: usize| cut * self.points.len() / stretch.count.max(1);
        let mut cut_at = |cut: usize| {
            let warm_up = self.points.get(vertex(cut).saturating_sub(WARM_UP)..vertex(cut))?;
            let mut left = LastPoint(Point::ZERO);
            let mut outliner = Outliner::new(*level, *pen, after, (&mut *right, &mut *steps), &mut left);
            walk(&mut outliner, before, warm_up);
            let (at, last, right) = outliner.place()?;
            Some(Cut { at, last, left: left.0, right })
        };
        let start = if stretch.index == 0 { None } else { cut_at(stretch.index) };
        if start.is_none() && stretch.index > 0 {
            // The stretch before goes on here.
            return;
        }
        let end = (stretch.index + 1..stretch.count).find_map(|cut| Some((vertex(cut), cut_at(cut)?)));
        let first = vertex(stretch.index);
        let Some(points) = self.points.get(first..end.map_or(self.points.len(), |(vertex, _)| vertex)) else { return };
        let mut outliner = Outliner::new(*level, *pen, after, (right, steps), sink);
        match start {
            Some(cut) => {
                outliner.begin_at(&cut);
                points.iter().for_each(|p| outliner.line(before.map_point(*p)));
            }
            None => walk(&mut outliner, before, points),
        }
        match end {
            Some((_, cut)) => outliner.finish_at(&cut),
            None => outliner.finish(),
        }
    }
}

/// Begins an open subpath and walks along it.
fn walk<B: PointMap, A: PointMap, K: PolygonSink>(outliner: &mut Outliner<'_, A, K>, before: B, points: &[Point]) {
    if let Some((first, rest)) = points.split_first() {
        outliner.begin(before.map_point(*first), false);
        rest.iter().for_each(|p| outliner.line(before.map_point(*p)));
    }
}

/// Keeps the last point alone.
struct LastPoint(Point);

impl PolygonSink for LastPoint {
    fn begin(&mut self, p: Point) {
        self.0 = p;
    }

    fn line(&mut self, p: Point) {
        self.0 = p;
    }

    fn end(&mut self) {}
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::*;
    use crate::geom::Rect;
    use crate::path::polygons::Polygons;
    use crate::path::stroke::{stroke, stroke_stretch};
    use crate::path::{Dash, LineCap, LineJoin};

    /// How often each edge is passed from its smaller end to its greater one, more than the other way.
    type Edges = BTreeMap<[u32; 4], i32>;

    fn add_edges(polygons: &Polygons, edges: &mut Edges) {
        for polygon in polygons.iter() {
            for (a, b) in polygon.iter().zip(polygon.iter().cycle().skip(1)) {
                let (a, b) = ([a.x.to_bits(), a.y.to_bits()], [b.x.to_bits(), b.y.to_bits()]);
                let (low, high, way) = if a < b { (a, b, 1) } else { (b, a, -1) };
                if a != b {
                    *edges.entry([low[0], low[1], high[0], high[1]]).or_default() += way;
                }
            }
        }
        edges.retain(|_, passed| *passed != 0);
    }

    fn whole(path: &Path, style: &Stroke, transform: Transform) -> Edges {
        let everywhere = Rect::from_ltrb(-1e9, -1e9, 1e9, 1e9);
        let (mut polygons, mut edges) = (Polygons::default(), Edges::default());
        let scratch = &mut StrokeScratch::default();
        stroke(path.verbs(), path.points(), style, transform, 0.05, everywhere, scratch, &mut polygons);
        add_edges(&polygons, &mut edges);
        edges
    }

    /// Of all stretches, and how many of them there were in truth.
    fn in_stretches(path: &Path, style: &Stroke, transform: Transform, count: usize) -> (Edges, usize) {
        let mut edges = Edges::default();
        let mut drawn = 0;
        for index in 0..count {
            let (stretch, scratch) = (Stretch { index, count }, &mut StrokeScratch::default());
            let mut polygons = Polygons::default();
            stroke_stretch(path.verbs(), path.points(), style, transform, 0.05, stretch, scratch, &mut polygons);
            drawn += usize::from(polygons.count() > 0);
            add_edges(&polygons, &mut edges);
        }
        (edges, drawn)
    }

    /// A walk of a hundred steps; every point is there `repeated` times.
    fn polyline(seed: u32, repeated: usize) -> Path {
        let mut seed = seed;
        let mut random = || {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (seed >> 8) as f32 / 16_777_216.0 * 20.0 - 10.0
        };
        let mut at = Point::new(100.0, 100.0);
        let mut points = Vec::new();
        for _ in 0..100 {
            at = at + Point::new(random(), random());
            points.extend(std::iter::repeat_n(at, repeated));
        }
        let mut path = Path::new();
        path.polyline(&points);
        path
    }

    #[test]
    fn stretches_together_are_the_outline_of_the_whole() {
        let joins = [LineJoin::Miter, LineJoin::MiterClip, LineJoin::Round, LineJoin::Bevel];
        let caps = [LineCap::Butt, LineCap::Square, LineCap::Round];
        for (index, join) in joins.into_iter().enumerate() {
            for cap in caps {
                for transform in [Transform::IDENTITY, Transform::from_scale(1.5, 0.5)] {
                    for (width, repeated) in [(1.0, 1), (9.0, 1), (0.0, 1), (3.0, 3), (3.0, 40)] {
                        let path = polyline(index as u32 + 1, repeated);
                        let style = Stroke::new(width).with_join(join).with_cap(cap);
                        let (edges, drawn) = in_stretches(&path, &style, transform, 5);
                        assert!(edges == whole(&path, &style, transform), "{join:?} {cap:?} {width} {repeated}");
                        // A cut among forty points in one place finds no join on the way there.
                        assert!(drawn == if repeated < 40 { 5 } else { 1 }, "{drawn} of {repeated}");
                    }
                }
            }
        }
    }

    #[test]
    fn a_place_is_one_dot_however_many_points_it_has() {
        let mut path = Path::new();
        path.polyline(&[Point::new(5.0, 6.0); 200]);
        let style = Stroke::new(4.0).with_cap(LineCap::Round);
        let (edges, drawn) = in_stretches(&path, &style, Transform::IDENTITY, 4);
        assert!(drawn == 1 && edges == whole(&path, &style, Transform::IDENTITY));
    }

    /// Points nearer to each other than a step may be: where steps end depends on where the walk began.
    #[test]
    fn noise_leaves_no_gap() {
        let mut path = Path::new();
        let noise = |i: i32| ((i * 7919) % 13) as f32 * 1e-5;
        let points: Vec<Point> =
            (0..2000).map(|i| Point::new(10.0 + i as f32 * 4e-5 + noise(i), 20.0 + noise(i + 5))).collect();
        path.polyline(&points).line_to((40.0, 30.0));
        let style = Stroke::new(2.0);
        let area = |edges: &Edges| {
            let twice = edges.iter().map(|(ends, passed)| {
                let [x0, y0, x1, y1] = ends.map(|bits| f64::from(f32::from_bits(bits)));
                (x0 * y1 - x1 * y0) * f64::from(*passed)
            });
            twice.sum::<f64>() * 0.5
        };
        let (edges, drawn) = in_stretches(&path, &style, Transform::IDENTITY, 20);
        assert!(drawn > 10);
        let expected = area(&whole(&path, &style, Transform::IDENTITY));
        assert!((area(&edges) - expected).abs() < 0.01 && expected.abs() > 60.0, "{} {expected}", area(&edges));
    }

    #[test]
    fn only_what_is_long_and_simple_has_stretches() {
        let long: Vec<Point> = (0..20_000).map(|i| Point::new((i % 100) as f32, (i / 100) as f32)).collect();
        let (mut path, style) = (Path::new(), Stroke::new(1.0));
        path.polyline(&long);
        let count = |path: &Path, style: &Stroke| stretches(path, style, Transform::IDENTITY);
        assert_eq!(count(&path, &style), 2);
        let dashed = Stroke { dash: Some(Dash { intervals: vec![3.0, 2.0].into(), offset: 0.0 }), ..style.clone() };
        assert_eq!(count(&path, &dashed), 1);
        assert_eq!(stretches(&path, &style, Transform::from_scale(1e4, 1e4)), 1);
        for change in [
            |path: &mut Path| _ = path.close(),
            |path: &mut Path| _ = path.quad_to((3.0, 4.0), (5.0, 6.0)),
            |path: &mut Path| _ = path.move_to((1.0, 1.0)).line_to((2.0, 2.0)),
        ] {
            let mut other = path.clone();
            change(&mut other);
            assert_eq!(count(&other, &style), 1);
        }
        let mut short = Path::new();
        short.polyline(&long[..16_000]);
        assert_eq!(count(&short, &style), 1);
    }
}
