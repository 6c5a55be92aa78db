//! Flattened outlines: closed polygons, kept until they are turned into edges.

use super::flatten::PolygonSink;
use crate::geom::Point;

/// Closed polygons in device pixels, one after another. The edge from the last point of each back to its first is
/// understood.
///
/// Each starts at a multiple of eight, and its first point follows its last one until there: at least once. Whoever takes them eight at
/// a time has no rest to look after.
#[derive(Debug, Default)]
pub(crate) struct Polygons {
    points: Vec<Point>,
    /// Where each polygon's points end.
    ends: Vec<u32>,
    /// The number of points of all of them.
    count: usize,
}

/// Where what follows a polygon that ends at `end` starts.
#[inline(always)]
fn start_after(end: usize) -> usize {
    (end & !7) + 8
}

impl Polygons {
    /// Removes all polygons and keeps the memory.
    pub(crate) fn clear(&mut self) {
        self.points.clear();
        self.ends.clear();
        self.count = 0;
    }

    /// The number of points of all polygons.
    #[inline(always)]
    pub(crate) fn count(&self) -> usize {
        self.count
    }

    /// All polygons eight points at a time, with those that follow a polygon's last one.
    #[inline(always)]
    pub(crate) fn eights(&self) -> &[[Point; 8]] {
        let (eights, _) = self.points.as_chunks();
        eights
    }

    /// The points of the polygon, if there is but one.
    pub(crate) fn only(&self) -> Option<&[Point]> {
        let [end] = self.ends.as_slice() else { return None };
        self.points.get(..*end as usize)
    }

    /// The points of each polygon.
    pub(crate) fn iter(&self) -> impl Iterator<Item = &[Point]> {
        self.iter_eights().map(|(eights, count)| eights.as_flattened().get(..count).unwrap_or(&[]))
    }

    /// The points of each polygon eight at a time, with those that follow its last one, and how many points it has.
    #[inline(always)]
    pub(crate) fn iter_eights(&self) -> impl Iterator<Item = (&[[Point; 8]], usize)> {
        let eights = self.eights();
        let mut start = 0;
        self.ends.iter().map(move |end| {
            let (own, after) = (start, start_after(*end as usize));
            start = after;
            (eights.get(own / 8..after / 8).unwrap_or(&[]), *end as usize - own)
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
        let start = self.ends.last().map_or(0, |end| start_after(*end as usize));
        let end = self.points.len();
        let Some(first) = self.points.get(start).copied() else { return };
        self.points.extend_from_slice(&[first; 8]);
        self.points.truncate(start_after(end));
        self.ends.push(end as u32);
        self.count += end - start;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polygons_start_at_eights_and_their_first_points_follow_their_last() {
        let point = |polygon: usize, index: usize| Point::new(polygon as f32, index as f32);
        let mut polygons = Polygons::default();
        for _ in 0..2 {
            assert!(polygons.only().is_none() && polygons.eights().is_empty() && polygons.count() == 0);
            let expected: Vec<Vec<_>> =
                (1..20).map(|count| (0..count).map(|index| point(count, index)).collect()).collect();
            for polygon in &expected {
                polygons.begin(polygon[0]);
                // Some one by one, some of more.
                for (index, p) in polygon.iter().enumerate().skip(1) {
                    if index % 3 == 0 { polygons.lines(&[*p, Point::ZERO, Point::ZERO], 1) } else { polygons.line(*p) }
                }
                polygons.end();
                assert_eq!(polygons.only(), (polygon.len() == 1).then_some(&polygon[..]));
            }
            assert!(polygons.iter().eq(&expected));
            assert_eq!(polygons.count(), (1..20).sum::<usize>());
            for ((eights, count), polygon) in polygons.iter_eights().zip(&expected) {
                assert_eq!((count, eights.len()), (polygon.len(), polygon.len() / 8 + 1));
                assert!(eights.as_flattened()[count..].iter().all(|p| *p == polygon[0]));
            }
            let eights: usize = polygons.iter_eights().map(|(eights, _)| eights.len()).sum();
            assert_eq!(polygons.eights().len(), eights);
            polygons.clear();
        }
    }
}
