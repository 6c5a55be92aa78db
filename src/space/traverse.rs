//! Traversal: which pixels a triangle covers, tile by tile, and which of them pass the depth test.
//!
//! Small triangles are walked row by row in the one or few tiles that they touch. Larger ones ask of each row of tiles which
//! tiles can be reached at all (one exact division an edge), then of each tile whether it lies outside, inside or across each
//! edge. Inside a tile an edge function fits 32 bits, eight pixels a vector.

use fearless_simd::prelude::*;
use fearless_simd::{f32x8, i32x8, mask32x8};

use super::batch::{Batch, BatchTriangle, GROUPS, Group, TRIANGLES};
use super::bin::{Binning, DrawRef, Kind, Vertices};
use super::counters::Counters;
use super::hiz::{self, Verdict};
use super::setup::{self, Edge, Gradients, PixelBox};
use super::target::{BandMut, DepthBounds, TILE};
use super::test::{Tests, depth_keys, depth_passes, lane_offsets, test_group};
use super::vertex::ScreenVertex;
use crate::num::level::{SimdLevel, dispatch_up_to_avx2};

/// Tiles side by side that are asked at once whether they hide a triangle.
const RUN: i32 = 16;

/// Tiles of a row from which on it pays to find where those begin and end that a triangle covers as a whole.
const LONG: i32 = 8;

/// What a flush is given: the batch, its vertices, where to draw, and counters.
pub(crate) type Flush<'f> = &'f mut dyn FnMut(&Batch, Vertices<'_>, &mut BandMut<'_>, &mut Counters);

/// What does not change over a draw.
pub(crate) struct Traversal<'a> {
    pub(crate) binning: &'a Binning,
    pub(crate) tests: Tests,
    /// Whether tests run before shading; else they run after it, in the flush.
    pub(crate) early: bool,
    /// Whether the flush takes whole tiles as one group.
    pub(crate) tiles: bool,
    pub(crate) level: SimdLevel,
}

/// Draws one band's list of one chunk.
pub(crate) fn draw(
    traversal: &Traversal<'_>,
    draws: &[DrawRef],
    vertices: Vertices<'_>,
    band: &mut BandMut<'_>,
    batch: &mut Batch,
    counters: &mut Counters,
    flush: Flush<'_>,
) {
    let area = traversal.binning.area.intersect(&PixelBox {
        left: band.area.left,
        top: band.area.top,
        right: band.area.right,
        bottom: band.area.bottom,
    });
    dispatch_up_to_avx2!(traversal.level, simd => {
        let mut walk = Walk { traversal, vertices, band, batch, counters, flush, area };
        for draw in draws {
            walk.draw(simd, draw);
        }
        walk.flush();
    });
}

struct Walk<'w, 'b, 'f> {
    traversal: &'w Traversal<'w>,
    vertices: Vertices<'w>,
    band: &'w mut BandMut<'b>,
    batch: &'w mut Batch,
    counters: &'w mut Counters,
    flush: Flush<'f>,
    /// The pixels of this band that may be drawn.
    area: PixelBox,
}

impl Walk<'_, '_, '_> {
    #[inline(never)]
    fn flush(&mut self) {
        if !self.batch.groups.is_empty() {
            (self.flush)(self.batch, self.vertices, self.band, self.counters);
        }
        self.batch.clear();
    }

    /// Makes room for a triangle and a tile's rows.
    #[inline(always)]
    fn reserve(&mut self) {
        if self.batch.groups.len() + TILE > GROUPS || self.batch.triangles.len() == TRIANGLES {
            self.flush();
        }
    }

    #[inline(always)]
    fn draw<S: Simd>(&mut self, simd: S, draw: &DrawRef) {
        match draw.kind {
            Kind::Triangle | Kind::Clipped | Kind::Point => self.triangle(simd, draw),
            Kind::Line | Kind::OpenLine => self.line(simd, draw),
        }
    }

    #[inline(always)]
    fn triangle<S: Simd>(&mut self, simd: S, draw: &DrawRef) {
        let binning = self.traversal.binning;
        let mut indices = draw.vertices;
        let mut v = indices.map(|i| self.vertices.screen(i));
        let mut area = setup::double_area(&v);
        let clockwise = area > 0;
        if !clockwise {
            v.swap(1, 2);
            indices.swap(1, 2);
            area = -area;
        }
        let extent = &binning.extent;
        let whole = setup::sample_box(v.map(|v| v.x()), v.map(|v| v.y()), extent).intersect(&binning.area);
        let bounds = whole.intersect(&self.area);
        if bounds.is_empty() || area == 0 {
            return;
        }
        // Counted by the band that holds its top, so that the number does not depend on bands.
        self.counters.setups += u64::from(bounds.top == whole.top);
        let edges = setup::edges(&v, binning.state.conservative);
        let front = draw.kind == Kind::Point || binning.is_front(clockwise);
        let triangle = Lazy { draw: *draw, indices, v, area, front };
        let tiles_x = (bounds.left >> 3, (bounds.right - 1) >> 3);
        let tiles_y = (bounds.top >> 3, (bounds.bottom - 1) >> 3);
        let small = (tiles_x.1 - tiles_x.0) < 2 && (tiles_y.1 - tiles_y.0) < 2;
        match (self.band.samples.coverage() == 1, small) {
            (true, true) => self.small(simd, &triangle, &edges, bounds),
            (true, false) => self.large::<S, true>(simd, &triangle, &edges, bounds),
            (false, true) => self.small_many(simd, &triangle, &edges, bounds),
            (false, false) => self.large::<S, false>(simd, &triangle, &edges, bounds),
        }
    }

    /// One sample a pixel, at most 2 × 2 tiles: rows are walked without looking at tiles first.
    #[inline(always)]
    fn small<S: Simd>(&mut self, simd: S, triangle: &Lazy, edges: &[Edge; 3], bounds: PixelBox) {
        let constants = edges.map(|edge| edge.constant(128, 128));
        let lanes = i32x8::load_array(simd, [0, 1, 2, 3, 4, 5, 6, 7]);
        let mut prepared: Option<BatchTriangle> = None;
        for tile_x in bounds.left >> 3..=(bounds.right - 1) >> 3 {
            let x = tile_x << 3;
            let mut e: [i32x8<S>; 3] = std::array::from_fn(|i| {
                let Edge { a, b, .. } = edges[i];
                let first = i64::from(a) * i64::from(x) + i64::from(b) * i64::from(bounds.top) + constants[i];
                // Cut from a large triangle the values may be larger: beyond 2^30 the sign alone counts.
                lanes * a + first.clamp(-(1 << 30), 1 << 30) as i32
            });
            // Lanes left and right of the box: covered by edges only where the area cuts the box.
            let inside = lanes.simd_ge(i32x8::splat(simd, bounds.left - x))
                & lanes.simd_lt(i32x8::splat(simd, bounds.right - x));
            for y in bounds.top..bounds.bottom {
                let covered = (e[0] | e[1] | e[2]).simd_ge(i32x8::splat(simd, 0)) & inside;
                e = [e[0] + edges[0].b, e[1] + edges[1].b, e[2] + edges[2].b];
                if !covered.any_true() {
                    continue;
                }
                let prepared = match &prepared {
                    Some(triangle) => triangle,
                    None => {
                        self.reserve();
                        prepared.insert(triangle.prepare(&self.traversal.tests, self.vertices))
                    }
                };
                self.row(simd, prepared, x, y, covered);
            }
        }
        if let Some(prepared) = prepared {
            self.keep(prepared);
        }
    }

    /// Several samples a pixel, at most 2 × 2 tiles.
    #[inline(never)]
    fn small_many<S: Simd>(&mut self, simd: S, triangle: &Lazy, edges: &[Edge; 3], bounds: PixelBox) {
        simd.vectorize(
            #[inline(always)]
            || self.small_many_inlined(simd, triangle, edges, bounds),
        );
    }

    #[inline(always)]
    fn small_many_inlined<S: Simd>(&mut self, simd: S, triangle: &Lazy, edges: &[Edge; 3], bounds: PixelBox) {
        let positions = self.band.samples.positions();
        let lanes = i32x8::load_array(simd, [0, 1, 2, 3, 4, 5, 6, 7]);
        let zero = i32x8::splat(simd, 0);
        // Edge functions at the pixels' corners, and what a sample's place adds: the difference of two constants, so that the sum is exact.
        let corners = edges.map(|edge| edge.constant(0, 0));
        let mut offsets = [[0_i32; 3]; 16];
        for (offset, (x, y)) in offsets.iter_mut().zip(positions) {
            *offset = std::array::from_fn(|i| {
                (edges[i].constant(i32::from(*x) * 16, i32::from(*y) * 16) - corners[i]) as i32
            });
        }
        let offsets = &offsets[..positions.len().min(16)];
        let mut prepared: Option<BatchTriangle> = None;
        for tile_x in bounds.left >> 3..=(bounds.right - 1) >> 3 {
            let x = tile_x << 3;
            let mut e: [i32x8<S>; 3] = std::array::from_fn(|i| {
                let Edge { a, b, .. } = edges[i];
                let first = i64::from(a) * i64::from(x) + i64::from(b) * i64::from(bounds.top) + corners[i];
                // As for one sample; 16 rows, 7 columns and a sample's place are less than 2^30.
                lanes * a + first.clamp(-(1 << 30), 1 << 30) as i32
            });
            let inside = lanes.simd_ge(i32x8::splat(simd, bounds.left - x))
                & lanes.simd_lt(i32x8::splat(simd, bounds.right - x));
            for y in bounds.top..bounds.bottom {
                let mut masks = [0_u64; 2];
                for (sample, offset) in offsets.iter().enumerate() {
                    let e = (e[0] + offset[0]) | (e[1] + offset[1]) | (e[2] + offset[2]);
                    masks[sample / 8] |= (e.simd_ge(zero) & inside).to_bitmask() << (8 * (sample & 7));
                }
                e = [e[0] + edges[0].b, e[1] + edges[1].b, e[2] + edges[2].b];
                if masks == [0; 2] {
                    continue;
                }
                if prepared.is_none() {
                    self.reserve();
                }
                let prepared = prepared.get_or_insert_with(|| triangle.prepare(&self.traversal.tests, self.vertices));
                if self.batch.groups.len() == GROUPS {
                    self.batch.triangles.push(*prepared);
                    self.flush();
                }
                if self.traversal.early {
                    masks = test_group(simd, &self.traversal.tests, prepared, self.band, (x as u16, y as u16), masks);
                }
                if masks != [0; 2] {
                    self.push(x, y, masks);
                    if self.traversal.tests.depth.write {
                        self.forget_bounds(x, y);
                    }
                }
            }
        }
        if let Some(prepared) = prepared {
            self.keep(prepared);
        }
    }

    /// Keeps the triangle if any of its pixels is to be shaded.
    #[inline(always)]
    fn keep(&mut self, triangle: BatchTriangle) {
        let next = self.batch.triangles.len() as u16;
        if self.batch.groups.last().is_some_and(|group| group.triangle == next) {
            self.batch.triangles.push(triangle);
        }
    }

    /// Tests a row of eight pixels of a small triangle, and queues what is left of it.
    #[inline(always)]
    fn row<S: Simd>(&mut self, simd: S, triangle: &BatchTriangle, x: i32, y: i32, covered: mask32x8<S>) {
        // A small triangle's rows are at most 32, more than a reserved tile's: check each.
        if self.batch.groups.len() == GROUPS {
            self.batch.triangles.push(*triangle);
            self.flush();
        }
        let tests = &self.traversal.tests;
        let masks = if !self.traversal.early {
            [covered.to_bitmask(), 0]
        } else if tests.stencil.is_some() {
            test_group(simd, tests, triangle, self.band, (x as u16, y as u16), [covered.to_bitmask(), 0])
        } else if tests.depth.is_on() {
            let tile = (y as usize / TILE - self.band.first) * self.band.tiles_x + x as usize / TILE;
            let Some(depth) = self.band.depth.get_mut(tile) else { return };
            let stored_row = &mut depth[y as usize % TILE];
            let dx = lane_offsets(simd) + (x as f32 + 0.5 - triangle.gradients.x0);
            let dy = f32x8::splat(simd, y as f32 + 0.5 - triangle.gradients.y0);
            let key = depth_keys(&tests.depth, triangle, dx, dy);
            let stored = i32x8::load_array_ref(simd, stored_row);
            let pass = depth_passes(tests.depth.compare, key, stored) & covered;
            if tests.depth.write {
                pass.select(key, stored).store_array(stored_row);
            }
            [pass.to_bitmask(), 0]
        } else {
            [covered.to_bitmask(), 0]
        };
        if masks[0] != 0 {
            self.push(x, y, masks);
            if tests.depth.write {
                self.forget_bounds(x, y);
            }
        }
    }

    /// A small triangle does not reckon its range over the tile: the tile's is open at the side that may have grown.
    #[inline(always)]
    fn forget_bounds(&mut self, x: i32, y: i32) {
        use super::state::Compare;
        let tile = (y as usize / TILE - self.band.first) * self.band.tiles_x + x as usize / TILE;
        if let Some(bounds) = self.band.bounds.get_mut(tile) {
            match self.traversal.tests.depth.compare {
                Compare::Less | Compare::LessEqual => bounds.nearest = i32::MIN,
                Compare::Greater | Compare::GreaterEqual => bounds.farthest = i32::MAX,
                _ => *bounds = DepthBounds { nearest: i32::MIN, farthest: i32::MAX },
            }
        }
    }

    #[inline(always)]
    fn push(&mut self, x: i32, y: i32, masks: [u64; 2]) {
        let triangle = self.batch.triangles.len() as u16;
        self.batch.groups.push(Group { x: x as u16, y: y as u16, triangle, masks });
    }

    /// Any triangle: rows of tiles, then tiles.
    #[inline(never)]
    fn large<S: Simd, const ONE: bool>(&mut self, simd: S, triangle: &Lazy, edges: &[Edge; 3], bounds: PixelBox) {
        simd.vectorize(
            #[inline(always)]
            || self.large_inlined::<S, ONE>(simd, triangle, edges, bounds),
        );
    }

    #[inline(always)]
    fn large_inlined<S: Simd, const ONE: bool>(
        &mut self,
        simd: S,
        triangle: &Lazy,
        edges: &[Edge; 3],
        bounds: PixelBox,
    ) {
        let samples = self.band.samples;
        let positions = samples.positions();
        // For each edge the constant of each sample, and of the most and least favourable one.
        let mut constants = [[0_i64; 16]; 3];
        let (mut most, mut least) = ([i64::MIN; 3], [i64::MAX; 3]);
        for (i, edge) in edges.iter().enumerate() {
            for (constant, (x, y)) in constants[i].iter_mut().zip(positions) {
                *constant = edge.constant(i32::from(*x) * 16, i32::from(*y) * 16);
                most[i] = most[i].max(*constant);
                least[i] = least[i].min(*constant);
            }
        }
        self.reserve();
        let tests = &self.traversal.tests;
        let prepared = triangle.prepare(tests, self.vertices);
        let hierarchical = tests.depth.hierarchical && tests.depth.is_on() && tests.stencil.is_none();
        // Outer corners where samples are not at the centre.
        let inset = if ONE { 0.5 } else { 0.0 };
        for tile_y in bounds.top >> 3..=(bounds.bottom - 1) >> 3 {
            let y = tile_y << 3;
            // The columns that every edge can reach from some row of this row of tiles.
            let (mut left, mut right) = (i64::from(bounds.left), i64::from(bounds.right - 1));
            for (edge, most) in edges.iter().zip(most) {
                let (a, b) = (i64::from(edge.a), i64::from(edge.b));
                let highest = most + b * i64::from(y) + if b > 0 { 7 * b } else { 0 };
                if a > 0 {
                    // a·X + highest ≥ 0
                    left = left.max(-highest.div_euclid(a));
                } else if a < 0 {
                    right = right.min(highest.div_euclid(-a));
                } else if highest < 0 {
                    right = i64::MIN;
                }
            }
            if left > right {
                continue;
            }
            let rows = (bounds.top.max(y) - y, bounds.bottom.min(y + 8) - y);
            let (first, last) = ((left >> 3) as i32, (right >> 3) as i32);
            // And in long rows the columns that every edge has inside in all rows.
            let mut inner = (i64::MAX, i64::MIN);
            if last - first >= LONG && rows == (0, 8) {
                inner = (i64::from(bounds.left), i64::from(bounds.right - 1));
                for (edge, least) in edges.iter().zip(least) {
                    let (a, b) = (i64::from(edge.a), i64::from(edge.b));
                    let lowest = least + b * i64::from(y) + if b < 0 { 7 * b } else { 0 };
                    if a > 0 {
                        inner.0 = inner.0.max(-lowest.div_euclid(a));
                    } else if a < 0 {
                        inner.1 = inner.1.min(lowest.div_euclid(-a));
                    } else if lowest < 0 {
                        inner.0 = i64::MAX;
                    }
                }
            }
            let row = (y as usize / TILE - self.band.first) * self.band.tiles_x;
            let (mut next, mut checked) = (first, first);
            while next <= last {
                let tile_x = next;
                let x = tile_x << 3;
                if hierarchical && tile_x >= checked {
                    // Many tiles at once: what lies behind a wall costs one test for sixteen of them.
                    let tiles = (last + 1 - tile_x).min(RUN);
                    checked = tile_x + tiles;
                    let range = hiz::range_over_tiles(&tests.depth, &prepared, (x, y), tiles, inset);
                    let bounds = self.band.bounds.get(row + tile_x as usize..row + checked as usize);
                    if bounds.is_some_and(|bounds| hiz::all_hidden(tests.depth.compare, range, bounds)) {
                        self.counters.tiles += tiles as u64;
                        self.counters.tiles_hidden += tiles as u64;
                        next = checked;
                        continue;
                    }
                }
                next += 1;
                self.counters.tiles += 1;
                let mut crossing = [false; 3];
                let mut corner = [0_i64; 3];
                let mut full = i64::from(x) >= inner.0 && i64::from(x) + 7 <= inner.1;
                if !full {
                    let mut outside = false;
                    for i in 0..3 {
                        let (a, b) = (i64::from(edges[i].a), i64::from(edges[i].b));
                        corner[i] = a * i64::from(x) + b * i64::from(y);
                        let (down, up) = (7 * (a.min(0) + b.min(0)), 7 * (a.max(0) + b.max(0)));
                        outside |= corner[i] + most[i] + up < 0;
                        crossing[i] = corner[i] + least[i] + down < 0;
                    }
                    if outside {
                        continue;
                    }
                    full = rows == (0, 8) && x >= bounds.left && x + 8 <= bounds.right && crossing == [false; 3];
                }
                self.counters.tiles_accepted += u64::from(full);
                let index = row + tile_x as usize;
                let mut in_front = false;
                let mut range = (i32::MIN, i32::MAX);
                if hierarchical {
                    range = hiz::range_over_tiles(&tests.depth, &prepared, (x, y), 1, inset);
                    let Some(bounds) = self.band.bounds.get(index) else { continue };
                    match hiz::verdict(tests.depth.compare, range, bounds) {
                        Verdict::Hidden => {
                            self.counters.tiles_hidden += 1;
                            continue;
                        }
                        Verdict::InFront => in_front = true,
                        Verdict::Unknown => {}
                    }
                }
                if self.batch.groups.len() + TILE > GROUPS {
                    // The triangle goes on in the next batch.
                    self.keep(prepared);
                    self.flush();
                }
                let tile = TileWalk { edges, constants: &constants, corner, crossing, full, x, y, rows, bounds };
                let stored = if ONE {
                    self.tile_one(simd, &prepared, &tile, in_front)
                } else {
                    self.tile_many(simd, &prepared, &tile)
                };
                if tests.depth.write && stored {
                    let Some(bounds) = self.band.bounds.get_mut(index) else { continue };
                    if hierarchical {
                        let early = self.traversal.early;
                        hiz::update(tests.depth.compare, range, full && early, in_front && early, bounds);
                        self.counters.tiles_in_front += u64::from(in_front && early);
                    } else {
                        *bounds = DepthBounds { nearest: i32::MIN, farthest: i32::MAX };
                    }
                }
            }
        }
        self.keep(prepared);
    }

    /// The rows of one tile, one sample a pixel. Whether any pixel is left.
    #[inline(always)]
    fn tile_one<S: Simd>(&mut self, simd: S, triangle: &BatchTriangle, tile: &TileWalk<'_>, in_front: bool) -> bool {
        let &TileWalk { edges, constants, corner, crossing, full, x, y, rows, bounds } = tile;
        let lanes = i32x8::load_array(simd, [0, 1, 2, 3, 4, 5, 6, 7]);
        let zero = i32x8::splat(simd, 0);
        let tests = &self.traversal.tests;
        let next = self.batch.triangles.len() as u16;
        let count = self.batch.groups.len();
        // Edges that cross the tile fit 30 bits; the others are taken as 0 everywhere.
        let mut e: [i32x8<S>; 3] = std::array::from_fn(|i| {
            let start = corner[i] + constants[i][0] + i64::from(edges[i].b) * i64::from(rows.0);
            if crossing[i] { lanes * edges[i].a + start as i32 } else { zero }
        });
        let step: [i32; 3] = std::array::from_fn(|i| if crossing[i] { edges[i].b } else { 0 });
        let inside =
            lanes.simd_ge(i32x8::splat(simd, bounds.left - x)) & lanes.simd_lt(i32x8::splat(simd, bounds.right - x));
        let simple = self.traversal.early && tests.stencil.is_none();
        let depth_on = simple && tests.depth.is_on();
        let index = (y as usize / TILE - self.band.first) * self.band.tiles_x + x as usize / TILE;
        let dx = lane_offsets(simd) + (x as f32 + 0.5 - triangle.gradients.x0);
        if !simple {
            for row in rows.0..rows.1 {
                let covered = (e[0] | e[1] | e[2]).simd_ge(zero) & inside;
                e = [e[0] + step[0], e[1] + step[1], e[2] + step[2]];
                let mut masks = [covered.to_bitmask(), 0];
                if masks[0] != 0 && self.traversal.early {
                    masks = test_group(simd, tests, triangle, self.band, (x as u16, (y + row) as u16), masks);
                }
                if masks[0] != 0 {
                    self.batch.groups.push(Group { x: x as u16, y: (y + row) as u16, triangle: next, masks });
                }
            }
            return self.batch.groups.len() > count;
        }
        let Some(depth) = self.band.depth.get_mut(index) else { return false };
        if full && self.traversal.tiles && (in_front || !depth_on) {
            // All of the tile: nothing to compare, one entry in the queue.
            if tests.depth.write {
                for (row, stored) in depth.iter_mut().enumerate() {
                    let dy = f32x8::splat(simd, (y + row as i32) as f32 + 0.5 - triangle.gradients.y0);
                    depth_keys(&tests.depth, triangle, dx, dy).store_array(stored);
                }
            }
            self.batch.groups.push(Group { x: x as u16, y: y as u16, triangle: next, masks: [!0, 0] });
            return true;
        }
        for row in rows.0..rows.1 {
            let covered = if full {
                mask32x8::splat(simd, true)
            } else {
                let covered = (e[0] | e[1] | e[2]).simd_ge(zero) & inside;
                e = [e[0] + step[0], e[1] + step[1], e[2] + step[2]];
                covered
            };
            let mut mask = covered;
            if depth_on {
                let stored_row = &mut depth[row as usize & 7];
                let dy = f32x8::splat(simd, (y + row) as f32 + 0.5 - triangle.gradients.y0);
                let key = depth_keys(&tests.depth, triangle, dx, dy);
                let stored = i32x8::load_array_ref(simd, stored_row);
                mask = if in_front { covered } else { depth_passes(tests.depth.compare, key, stored) & covered };
                if tests.depth.write {
                    mask.select(key, stored).store_array(stored_row);
                }
            }
            let masks = [mask.to_bitmask(), 0];
            if masks[0] != 0 {
                self.batch.groups.push(Group { x: x as u16, y: (y + row) as u16, triangle: next, masks });
            }
        }
        self.batch.groups.len() > count
    }

    /// The rows of one tile, several samples a pixel. Whether any sample is left.
    #[inline(always)]
    fn tile_many<S: Simd>(&mut self, simd: S, triangle: &BatchTriangle, tile: &TileWalk<'_>) -> bool {
        let &TileWalk { edges, constants, corner, full, x, y, rows, bounds, .. } = tile;
        let lanes = i32x8::load_array(simd, [0, 1, 2, 3, 4, 5, 6, 7]);
        let zero = i32x8::splat(simd, 0);
        let samples = self.band.samples.coverage();
        let inside =
            lanes.simd_ge(i32x8::splat(simd, bounds.left - x)) & lanes.simd_lt(i32x8::splat(simd, bounds.right - x));
        let all = [if samples >= 8 { !0 } else { (1 << (8 * samples)) - 1 }, if samples > 8 { !0 } else { 0_u64 }];
        let across: [i32x8<S>; 3] = std::array::from_fn(|i| lanes * edges[i].a);
        let count = self.batch.groups.len();
        for row in rows.0..rows.1 {
            let mut masks = all;
            if !full {
                masks = [0; 2];
                for sample in 0..samples {
                    let e: [i32x8<S>; 3] = std::array::from_fn(|i| {
                        let start = corner[i] + constants[i][sample & 15] + i64::from(edges[i].b) * i64::from(row);
                        // Far from the tile the sign alone counts; 2^30 is farther than an edge gets across eight pixels.
                        across[i] + start.clamp(-(1 << 30), 1 << 30) as i32
                    });
                    let covered = (e[0] | e[1] | e[2]).simd_ge(zero) & inside;
                    masks[(sample / 8) & 1] |= covered.to_bitmask() << (8 * (sample & 7));
                }
            }
            if masks == [0; 2] {
                continue;
            }
            if self.traversal.early {
                masks =
                    test_group(simd, &self.traversal.tests, triangle, self.band, (x as u16, (y + row) as u16), masks);
            }
            if masks != [0; 2] {
                self.push(x, y + row, masks);
            }
        }
        self.batch.groups.len() > count
    }

    /// A line, one pixel wide: Bresenham's from the pixel of one end to that of the other, every sample of a pixel.
    #[inline(never)]
    fn line<S: Simd>(&mut self, simd: S, draw: &DrawRef) {
        simd.vectorize(
            #[inline(always)]
            || self.line_inlined(simd, draw),
        );
    }

    #[inline(always)]
    fn line_inlined<S: Simd>(&mut self, simd: S, draw: &DrawRef) {
        let [from, to, _] = draw.vertices;
        let (a, b) = (self.vertices.screen(from), self.vertices.screen(to));
        self.reserve();
        let gradients = Gradients::of_line(&a, &b);
        let tests = self.traversal.tests;
        let mut z = gradients.plane(a.z, b.z, a.z);
        if tests.depth.logarithm.is_some() {
            z = [0.0; 3];
        }
        let triangle = BatchTriangle {
            vertices: [from, to, to],
            primitive: draw.primitive,
            piece: draw.piece,
            front: true,
            clipped: false,
            gradients,
            z,
            inverse_w: gradients.plane(a.inverse_w, b.inverse_w, a.inverse_w),
        };
        let samples = self.band.samples.coverage();
        let (x0, y0) = (i64::from(a.x() >> 8), i64::from(a.y() >> 8));
        let (dx, dy) = (i64::from(b.x() >> 8) - x0, i64::from(b.y() >> 8) - y0);
        let (long, short) = (dx.abs().max(dy.abs()), dx.abs().min(dy.abs()));
        let steep = dy.abs() > dx.abs();
        // Only the steps whose pixel can be inside the area: a line may be 65,000 pixels long, a band is 8 rows.
        let (major_start, sign, low, high) = if steep {
            (y0, dy.signum(), i64::from(self.area.top), i64::from(self.area.bottom))
        } else {
            (x0, dx.signum(), i64::from(self.area.left), i64::from(self.area.right))
        };
        let (first, last) = if sign >= 0 {
            (low - major_start, high - 1 - major_start)
        } else {
            (major_start - high + 1, major_start - low)
        };
        let end = if draw.kind == Kind::Line { long } else { long - 1 };
        for step in first.max(0)..=last.min(end) {
            // The minor offset: step · short / long, rounded to nearest, ties towards the left or upper end, so that the line is
            // the same from both ends.
            let tie = if sign >= 0 { 1 } else { 0 };
            let minor = if long == 0 { 0 } else { (2 * step * short + long - tie) / (2 * long) };
            let (x, y) = if steep {
                (x0 + dx.signum() * minor, y0 + dy.signum() * step)
            } else {
                (x0 + dx.signum() * step, y0 + dy.signum() * minor)
            };
            let inside = x >= i64::from(self.area.left)
                && x < i64::from(self.area.right)
                && y >= i64::from(self.area.top)
                && y < i64::from(self.area.bottom);
            if !inside {
                continue;
            }
            if self.batch.groups.len() == GROUPS {
                self.keep(triangle);
                self.flush();
            }
            let (x, y) = (x as i32, y as i32);
            let mut masks = [0_u64; 2];
            for sample in 0..samples {
                masks[(sample / 8) & 1] |= 1 << (8 * (sample & 7) + (x as usize & 7));
            }
            let place = (x & !7, y);
            if self.traversal.early {
                masks = test_group(simd, &tests, &triangle, self.band, (place.0 as u16, y as u16), masks);
            }
            if masks != [0; 2] {
                self.push(place.0, y, masks);
                if tests.depth.write {
                    let tile = (y as usize / TILE - self.band.first) * self.band.tiles_x + x as usize / TILE;
                    if let Some(bounds) = self.band.bounds.get_mut(tile) {
                        *bounds = DepthBounds { nearest: i32::MIN, farthest: i32::MAX };
                    }
                }
            }
        }
        self.keep(triangle);
    }
}

/// A tile on the way of a triangle.
struct TileWalk<'a> {
    edges: &'a [Edge; 3],
    /// Each edge's constant for each sample.
    constants: &'a [[i64; 16]; 3],
    /// What the tile's place adds to them, where not all of the tile is covered.
    corner: [i64; 3],
    crossing: [bool; 3],
    /// Whether all of the tile is covered.
    full: bool,
    /// The first pixel.
    x: i32,
    y: i32,
    /// The rows of the tile that may be drawn, the second excluded.
    rows: (i32, i32),
    bounds: PixelBox,
}

/// A triangle whose planes are reckoned once a pixel of it is found to be covered.
struct Lazy {
    draw: DrawRef,
    indices: [u32; 3],
    v: [ScreenVertex; 3],
    area: i64,
    front: bool,
}

impl Lazy {
    #[inline(always)]
    fn prepare(&self, tests: &Tests, vertices: Vertices<'_>) -> BatchTriangle {
        if self.draw.kind == Kind::Clipped {
            return prepare_clipped(tests, &self.draw, self.indices, self.front, vertices);
        }
        prepare(tests, &self.draw, self.indices, &self.v, self.area, self.front)
    }
}

/// [`prepare`] for a piece of a triangle: its planes go through other vertices; see [`Kind::Clipped`].
#[cold]
pub(crate) fn prepare_clipped(
    tests: &Tests,
    draw: &DrawRef,
    corners: [u32; 3],
    front: bool,
    vertices: Vertices<'_>,
) -> BatchTriangle {
    let mut indices = corners.map(|i| i + 3);
    let mut v = indices.map(|i| vertices.screen(i));
    let area = setup::double_area(&v);
    if area < 0 {
        // A sliver, the other way round by rounding.
        v.swap(1, 2);
        indices.swap(1, 2);
    }
    prepare(tests, draw, indices, &v, area.abs(), front)
}

/// The planes of a triangle that runs clockwise.
#[inline(always)]
pub(crate) fn prepare(
    tests: &Tests,
    draw: &DrawRef,
    vertices: [u32; 3],
    v: &[ScreenVertex; 3],
    area: i64,
    front: bool,
) -> BatchTriangle {
    let gradients = Gradients::of_triangle(v, area);
    let mut z = gradients.plane(v[0].z, v[1].z, v[2].z);
    let rule = &tests.depth;
    if rule.logarithm.is_some() {
        z = [rule.bias_units * rule.format.resolution(1.0), 0.0, 0.0];
    } else if rule.bias_slope != 0.0 || rule.bias_units != 0.0 {
        let slope = if z[1].abs() > z[2].abs() { z[1].abs() } else { z[2].abs() };
        let largest = v.iter().fold(0.0, |largest, v| if v.z > largest { v.z } else { largest });
        z[0] += rule.bias_slope * slope + rule.bias_units * rule.format.resolution(largest);
    }
    BatchTriangle {
        vertices,
        primitive: draw.primitive,
        piece: draw.piece,
        front,
        clipped: draw.kind == Kind::Clipped,
        gradients,
        z,
        inverse_w: gradients.plane(v[0].inverse_w, v[1].inverse_w, v[2].inverse_w),
    }
}
