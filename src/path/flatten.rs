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
