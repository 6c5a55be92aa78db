//! Culling and binning: which triangles are drawn at all, and which bands they reach, in submission order.
//!
//! A chunk of primitives is looked at once: vertices outside the safe range are clipped here, triangles that draw nothing are
//! dropped, the others are listed for each band. With one band, as one thread has it, the list is short and stays in cache.

use super::assembly::{Primitives, Topology};
use super::clip::{ClipPlane, ClipVertex, clip_polygon, clip_segment, outcode};
use super::counters::Counters;
use super::setup::{PixelBox, SampleExtent, double_area, sample_box};
use super::state::{Cull, Fill, FrontFace, State};
use super::target::TILE;
use super::vertex::{FINE, ScreenVertex, ShadedVertices, Snap, Transform};

/// What a [`DrawRef`] draws.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    Triangle,
    /// A piece that clipping left of a triangle. After its three vertices come the three that its planes go through, and a copy of the
    /// primitive's first.
    Clipped,
    /// Half of a point's square: always seen from the front.
    Point,
    /// A line from the first vertex to the second, without its last pixel.
    OpenLine,
    /// A line with both ends.
    Line,
}

/// One thing to draw: vertices by index, those from clipping counted on from the shaded ones.
#[derive(Clone, Copy, Debug)]
pub(crate) struct DrawRef {
    pub(crate) vertices: [u32; 3],
    pub(crate) primitive: u32,
    pub(crate) piece: u8,
    pub(crate) kind: Kind,
}

/// What a chunk of primitives left for each band.
#[derive(Debug, Default)]
pub(crate) struct Chunk {
    pub(crate) bands: Vec<Vec<DrawRef>>,
    /// Vertices made by clipping, and of points.
    pub(crate) screen: Vec<ScreenVertex>,
    pub(crate) varyings: Vec<f32>,
    pub(crate) counters: Counters,
}

/// Vertices by index, wherever they are.
#[derive(Clone, Copy)]
pub(crate) struct Vertices<'a> {
    pub(crate) shaded: &'a ShadedVertices,
    pub(crate) screen: &'a [ScreenVertex],
    pub(crate) varyings: &'a [f32],
}

impl<'a> Vertices<'a> {
    pub(crate) fn new(shaded: &'a ShadedVertices, chunk: &'a Chunk) -> Self {
        Self { shaded, screen: &chunk.screen, varyings: &chunk.varyings }
    }

    #[inline(always)]
    pub(crate) fn screen(&self, index: u32) -> ScreenVertex {
        let index = index as usize;
        match self.shaded.screen.get(index) {
            Some(vertex) => *vertex,
            None => self.screen.get(index - self.shaded.screen.len()).copied().unwrap_or(ScreenVertex::UNSAFE),
        }
    }

    /// The vertex's varyings, a multiple of four of them.
    #[inline(always)]
    pub(crate) fn varyings(&self, index: u32) -> &'a [f32] {
        let (index, stride) = (index as usize, self.shaded.stride);
        let shaded = self.shaded.screen.len();
        let (all, index) =
            if index < shaded { (&self.shaded.varyings[..], index) } else { (self.varyings, index - shaded) };
        all.get(index * stride..(index + 1) * stride).unwrap_or_default()
    }
}

/// What does not change over a draw.
#[derive(Debug)]
pub(crate) struct Binning {
    pub(crate) state: State,
    pub(crate) transform: Transform,
    pub(crate) snap: Snap,
    pub(crate) extent: SampleExtent,
    /// The pixels that may be drawn.
    pub(crate) area: PixelBox,
    /// Rows of pixels of a band.
    pub(crate) band_rows: i32,
    pub(crate) bands: usize,
    planes: Vec<ClipPlane>,
    /// The view volume: as `planes`, but for its sides, which are not the guard band's.
    volume: Vec<ClipPlane>,
}

impl Binning {
    pub(crate) fn new(
        state: State,
        transform: Transform,
        snap: Snap,
        extent: SampleExtent,
        area: PixelBox,
        band_tiles: usize,
        bands: usize,
    ) -> Self {
        let [gx, gy] = transform.guard();
        let mut planes = Vec::new();
        if state.depth.clamp {
            planes.push(ClipPlane([0.0, 0.0, 0.0, 1.0]));
        } else {
            planes.push(ClipPlane([0.0, 0.0, 1.0, -transform.near]));
            planes.push(ClipPlane([0.0, 0.0, -1.0, 1.0]));
        }
        let mut volume = planes.clone();
        volume.extend_from_slice(&ClipPlane::VIEW_VOLUME[..4]);
        planes.extend([
            ClipPlane([1.0, 0.0, 0.0, gx]),
            ClipPlane([-1.0, 0.0, 0.0, gx]),
            ClipPlane([0.0, 1.0, 0.0, gy]),
            ClipPlane([0.0, -1.0, 0.0, gy]),
        ]);
        Self { state, transform, snap, extent, area, band_rows: (band_tiles * TILE) as i32, bands, planes, volume }
    }

    /// Bins some primitives.
    pub(crate) fn run<V>(
        &self,
        primitives: &Primitives<'_, V>,
        range: std::ops::Range<usize>,
        shaded: &ShadedVertices,
        chunk: &mut Chunk,
    ) {
        chunk.bands.resize_with(self.bands, Vec::new);
        chunk.bands.iter_mut().for_each(Vec::clear);
        chunk.screen.clear();
        chunk.varyings.clear();
        chunk.counters = Counters { primitives: range.len() as u64, ..Counters::default() };
        let solid = self.state.fill == Fill::Solid
            && matches!(primitives.topology, Topology::Triangles | Topology::TriangleStrip | Topology::TriangleFan);
        for primitive in range.clone() {
            let Some(corners) = primitives.corners(primitive) else {
                chunk.counters.invalid += 1;
                continue;
            };
            let id = primitive as u32;
            let screen = corners.map(|i| shaded.screen.get(i as usize).copied().unwrap_or(ScreenVertex::UNSAFE));
            if solid && !screen.iter().any(ScreenVertex::is_unsafe) {
                self.triangle(Kind::Triangle, corners, &screen, id, 0, chunk);
                continue;
            }
            match primitives.topology {
                Topology::Points => self.point(corners[0], id, 0, shaded, chunk),
                Topology::Lines => self.line(corners[0], corners[1], Kind::Line, id, 0, shaded, chunk),
                Topology::LineStrip => {
                    let last = primitive + 1 == primitives.count();
                    let kind = if last { Kind::Line } else { Kind::OpenLine };
                    self.line(corners[0], corners[1], kind, id, 0, shaded, chunk);
                }
                Topology::LineLoop => self.line(corners[0], corners[1], Kind::OpenLine, id, 0, shaded, chunk),
                _ => match self.state.fill {
                    Fill::Solid => self.clipped(corners, id, shaded, chunk),
                    Fill::Wireframe | Fill::Points if self.is_culled(corners, shaded) => chunk.counters.culled += 1,
                    Fill::Wireframe => {
                        for (piece, (a, b)) in [(0, 1), (1, 2), (2, 0)].into_iter().enumerate() {
                            self.line(corners[a], corners[b], Kind::OpenLine, id, piece as u8, shaded, chunk);
                        }
                    }
                    Fill::Points => {
                        for (piece, corner) in corners.into_iter().enumerate() {
                            self.point(corner, id, piece as u8, shaded, chunk);
                        }
                    }
                },
            }
        }
    }

    /// Whether the side that a triangle of twice the area `area` shows is culled.
    #[inline(always)]
    fn culls(&self, area_is_positive: bool) -> bool {
        match self.state.cull {
            Cull::None => false,
            Cull::Front => self.is_front(area_is_positive),
            Cull::Back => !self.is_front(area_is_positive),
        }
    }

    /// Whether a triangle that runs clockwise on the screen, or does not, shows its front.
    #[inline(always)]
    pub(crate) fn is_front(&self, clockwise: bool) -> bool {
        clockwise == (self.state.front_face == FrontFace::Clockwise)
    }

    /// Culling of triangles that are drawn as lines or points; those with a corner behind the viewer count as seen.
    fn is_culled(&self, corners: [u32; 3], shaded: &ShadedVertices) -> bool {
        let screen = corners.map(|i| shaded.screen.get(i as usize).copied().unwrap_or(ScreenVertex::UNSAFE));
        if self.state.cull == Cull::None || screen.iter().any(ScreenVertex::is_unsafe) {
            return false;
        }
        let area = double_area(&screen);
        area != 0 && self.culls(area > 0)
    }

    /// A triangle of safe vertices: dropped, or listed for the bands that it reaches.
    #[inline(always)]
    fn triangle(
        &self,
        kind: Kind,
        vertices: [u32; 3],
        screen: &[ScreenVertex; 3],
        primitive: u32,
        piece: u8,
        chunk: &mut Chunk,
    ) {
        let bounds = sample_box(screen.map(|v| v.x()), screen.map(|v| v.y()), &self.extent);
        if bounds.is_empty() {
            chunk.counters.no_samples += 1;
            return;
        }
        let bounds = bounds.intersect(&self.area);
        if bounds.is_empty() {
            chunk.counters.outside += 1;
            return;
        }
        let area = double_area(screen);
        if area == 0 {
            chunk.counters.zero_area += 1;
            return;
        }
        if self.culls(area > 0) {
            chunk.counters.culled += 1;
            return;
        }
        self.list(DrawRef { vertices, primitive, piece, kind }, bounds.top, bounds.bottom, chunk);
    }

    /// Lists something for the bands of the rows `top..bottom`, which are inside the area.
    #[inline(always)]
    fn list(&self, draw: DrawRef, top: i32, bottom: i32, chunk: &mut Chunk) {
        if let [only] = &mut chunk.bands[..] {
            only.push(draw);
            return;
        }
        let (first, last) = (top / self.band_rows, (bottom - 1) / self.band_rows);
        for band in chunk.bands.get_mut(first as usize..=last as usize).unwrap_or_default() {
            band.push(draw);
        }
    }

    /// A triangle with a vertex that is not safe: clipped, and its pieces drawn as a fan.
    ///
    /// Coverage comes from clipping to the guard band, which cuts few of the edges that neighbours share. Planes through corners
    /// that far away would be coarse: depths and varyings come from what is left inside of the view volume.
    #[cold]
    fn clipped(&self, corners: [u32; 3], primitive: u32, shaded: &ShadedVertices, chunk: &mut Chunk) {
        let [Some(a), Some(b), Some(c)] = corners.map(|i| shaded.clip_vertex(i as usize)) else { return };
        let triangle = [a, b, c];
        if !triangle.iter().all(|v| v.position.iter().all(|p| p.is_finite())) {
            chunk.counters.invalid += 1;
            return;
        }
        let outside = triangle.iter().fold(!0, |all, v| all & outcode(v.position, &self.volume)) != 0;
        if outside {
            chunk.counters.outside += 1;
            return;
        }
        chunk.counters.clipped += 1;
        let polygon = clip_polygon(&triangle, &self.planes);
        let seen = self.largest_triangle(&clip_polygon(&triangle, &self.volume));
        for (piece, pair) in polygon.windows(2).skip(1).enumerate() {
            let corners = [&polygon[0], &pair[0], &pair[1]];
            let screen = corners.map(|v| self.on_screen(v));
            if screen.iter().any(ScreenVertex::is_unsafe) {
                continue;
            }
            let first = (shaded.screen.len() + chunk.screen.len()) as u32;
            for vertex in corners {
                self.add(vertex, shaded, chunk);
            }
            for vertex in seen.as_ref().map_or(corners, |seen| seen.each_ref()) {
                self.add(vertex, shaded, chunk);
            }
            self.add(&a, shaded, chunk);
            self.triangle(Kind::Clipped, [first, first + 1, first + 2], &screen, primitive, piece as u8, chunk);
        }
    }

    /// The three vertices of a convex polygon that span the largest area on the screen, in its order; `None` where none is spanned.
    fn largest_triangle(&self, polygon: &[ClipVertex]) -> Option<[ClipVertex; 3]> {
        let places: Vec<ScreenVertex> = polygon.iter().map(|v| self.on_screen(v)).collect();
        let mut largest = (0, None);
        for i in 0..places.len() {
            for j in i + 1..places.len() {
                for k in j + 1..places.len() {
                    let screen = [places[i], places[j], places[k]];
                    let area = double_area(&screen).abs();
                    if area > largest.0 && !screen.iter().any(ScreenVertex::is_unsafe) {
                        largest = (area, Some([polygon[i], polygon[j], polygon[k]]));
                    }
                }
            }
        }
        largest.1
    }

    /// A point: a square of its size around it, as two triangles; a pixel's centre on its left or upper side is in.
    fn point(&self, corner: u32, primitive: u32, piece: u8, shaded: &ShadedVertices, chunk: &mut Chunk) {
        let Some(vertex) = shaded.clip_vertex(corner as usize) else { return };
        let screen = self.transform.screen(vertex.position, self.state.depth.clamp, self.snap);
        if screen.is_unsafe() {
            let finite = vertex.position.iter().all(|p| p.is_finite());
            *(if finite { &mut chunk.counters.outside } else { &mut chunk.counters.invalid }) += 1;
            return;
        }
        let size = self.state.point_size;
        let size = if size >= 1.0 { if size <= 4096.0 { size } else { 4096.0 } } else { 1.0 };
        let half = (size * 128.0) as i32;
        let first = (shaded.screen.len() + chunk.screen.len()) as u32;
        let corners = [(-half, -half), (half, -half), (half, half), (-half, half)].map(|(dx, dy)| ScreenVertex {
            fine_x: (screen.x() + dx) << FINE,
            fine_y: (screen.y() + dy) << FINE,
            ..screen
        });
        for corner in corners {
            chunk.screen.push(corner);
            chunk.varyings.extend_from_slice(vertex.varyings.get(..shaded.stride).unwrap_or_default());
        }
        for (half, at) in [[0, 1, 2], [0, 2, 3]].into_iter().enumerate() {
            let bounds = sample_box(at.map(|i: usize| corners[i].x()), at.map(|i| corners[i].y()), &self.extent);
            let bounds = bounds.intersect(&self.area);
            if !bounds.is_empty() {
                let vertices = at.map(|i| first + i as u32);
                let draw = DrawRef { vertices, primitive, piece: 2 * piece + half as u8, kind: Kind::Point };
                self.list(draw, bounds.top, bounds.bottom, chunk);
            }
        }
    }

    /// A line, clipped where it has to be.
    #[expect(clippy::too_many_arguments, reason = "what a line is")]
    fn line(
        &self,
        from: u32,
        to: u32,
        kind: Kind,
        primitive: u32,
        piece: u8,
        shaded: &ShadedVertices,
        chunk: &mut Chunk,
    ) {
        let (Some(a), Some(b)) = (shaded.clip_vertex(from as usize), shaded.clip_vertex(to as usize)) else { return };
        let own = |i: u32| shaded.screen.get(i as usize).copied().unwrap_or(ScreenVertex::UNSAFE);
        let (mut indices, mut ends, mut kind) = ([from, to], [own(from), own(to)], kind);
        if ends.iter().any(ScreenVertex::is_unsafe) {
            if !a.position.iter().chain(&b.position).all(|p| p.is_finite()) {
                chunk.counters.invalid += 1;
                return;
            }
            let Some((start, end)) = clip_segment(a, b, &self.planes) else {
                chunk.counters.outside += 1;
                return;
            };
            chunk.counters.clipped += 1;
            if ends[1].is_unsafe() {
                // The end was cut off, and no other line starts there.
                kind = Kind::Line;
            }
            let first = (shaded.screen.len() + chunk.screen.len()) as u32;
            indices = [first, first + 1];
            ends = [self.add(&start, shaded, chunk), self.add(&end, shaded, chunk)];
            if ends.iter().any(ScreenVertex::is_unsafe) {
                return;
            }
        }
        let rows = [ends[0].y() >> 8, ends[1].y() >> 8];
        let (top, bottom) = (rows[0].min(rows[1]).max(self.area.top), (rows[0].max(rows[1]) + 1).min(self.area.bottom));
        if top >= bottom || self.area.is_empty() {
            chunk.counters.outside += 1;
            return;
        }
        let vertices = [indices[0], indices[1], indices[1]];
        self.list(DrawRef { vertices, primitive, piece, kind }, top, bottom, chunk);
    }

    /// Where a vertex is that clipping made: between near and far but for rounding.
    fn on_screen(&self, vertex: &ClipVertex) -> ScreenVertex {
        self.transform.screen(vertex.position, true, self.snap)
    }

    /// Adds a vertex that clipping made.
    fn add(&self, vertex: &ClipVertex, shaded: &ShadedVertices, chunk: &mut Chunk) -> ScreenVertex {
        let screen = self.on_screen(vertex);
        chunk.screen.push(screen);
        chunk.varyings.extend_from_slice(vertex.varyings.get(..shaded.stride).unwrap_or_default());
        screen
    }
}
