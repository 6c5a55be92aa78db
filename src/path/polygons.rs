//! Flattened outlines: closed polygons, kept until they are turned into edges.

use super::flatten::PolygonSink;
use crate::geom::Point;

/// Closed polygons in device pixels, one after another. The edge from the last point of each back to its first is
/// understood.
#[derive(Debug, Default)]
pub(crate) struct Polygons {
    points: Vec<Point>,
    /// Where each polygon's points end.
    ends: Vec<u32>,
}

impl Polygons {
    /// Removes all polygons and keeps the memory.
    pub(crate) fn clear(&mut self) {
        self.points.clear();
        self.ends.clear();
    }

    /// The points of all polygons.
    pub(crate) fn points(&self) -> &[Point] {
        &self.points
    }

    /// The points of the polygon, if there is but one.
    pub(crate) fn only(&self) -> Option<&[Point]> {
        (self.ends.len() == 1).then_some(&self.points)
    }

    /// The points of each polygon.
    pub(crate) fn iter(&self) -> impl Iterator<Item = &[Point]> {
        let mut start = 0;
        self.ends.iter().map(move |end| {
            let end = *end as usize;
            let polygon = self.points.get(start..end).unwrap_or(&[]);
            start = end;
            polygon
        })
    }
}

impl PolygonSink for Polygons {
    #[inline(always)]
    fn begin(&mut self, p: Point) {
        self.points.push(p);
    }

    #[inline(always)]
    fn line(&mut self, p: Point) {
        self.points.push(p);
    }

    #[inline(always)]
    fn lines<const N: usize>(&mut self, points: &[Point; N], count: usize) {
        // All of them in one piece, and back to those that count: cheaper than one by one.
        let end = self.points.len() + count;
        self.points.extend_from_slice(points);
        self.points.truncate(end);
    }

    #[inline(always)]
    fn end(&mut self) {
        self.ends.push(self.points.len() as u32);
    }
}
