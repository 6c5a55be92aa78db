//! The pipeline: vertices in, pixels out.

use super::assembly::Primitives;
use super::batch::{Batch, Group, TRIANGLES};
use super::bin::{Binning, Chunk, DrawRef, Kind, Vertices};
use super::counters::Counters;
use super::fragment::{FragmentShader, Fragments, Shade};
use super::hiz::DepthRule;
use super::setup::{PixelBox, SampleExtent, double_area};
use super::shade::{self, Output};
use super::state::{Blend, Depth, Fill, State};
use super::target::{BandMut, TILE, Target};
use super::test::Tests;
use super::traverse::{self, Traversal};
use super::vertex::{ShadedVertices, Snap, VertexShader, Viewport, shade_vertices};
use crate::num::level::SimdLevel;
use crate::pool;
use fearless_simd::prelude::*;
use fearless_simd::u32x8;

/// Primitives that are binned at a time, where one thread does it all: few enough for their list to stay in cache.
const CHUNK: usize = 4096;

/// The rendering pipeline: vertex shader, primitive assembly, clipping, culling, set-up, traversal, tests, fragment
/// shader, blending.
///
/// Neither threads nor the SIMD level change a byte of what is drawn.
///
/// ```
/// use rastrum::space::{Pipeline, Primitives, Target, VertexColor, vertex_fn};
///
/// let corners = [([-0.9, -0.9], [1.0, 0.0, 0.0]), ([0.9, -0.9], [0.0, 1.0, 0.0]), ([0.0, 0.9], [0.0, 0.0, 1.0])];
/// let shader = vertex_fn(3, |(position, color): &([f32; 2], [f32; 3]), varyings: &mut [f32]| {
///     varyings.copy_from_slice(color);
///     [position[0], position[1], 0.0, 1.0]
/// });
/// let mut target = Target::new(64, 64)?;
/// let drawn = Pipeline::new(64, 64).draw(&mut target, &Primitives::triangles(&corners), &shader, &VertexColor);
/// assert_eq!(drawn.setups, 1);
/// assert_eq!(target.pixel(2, 2), Some([0; 4]));
/// assert_eq!(target.pixel(32, 40).map(|pixel| pixel[3]), Some(255));
/// # Ok::<(), rastrum::Error>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Pipeline {
    /// Fixed-function state.
    pub state: State,
    /// Where normalised device coordinates land.
    pub viewport: Viewport,
    /// The most threads; 0 (the default) stands for one per core.
    pub threads: usize,
    /// The SIMD level. Default: the best.
    pub level: SimdLevel,
}

/// What a draw needs besides its vertices.
struct Prepared {
    binning: Binning,
    tests: Tests,
    snap: Snap,
    threads: usize,
    level: SimdLevel,
    band_tiles: usize,
}

impl Pipeline {
    /// A pipeline with the default state and a viewport of all of a target of the given size.
    pub fn new(width: u32, height: u32) -> Self {
        Self { state: State::default(), viewport: Viewport::new(width, height), threads: 0, level: SimdLevel::best() }
    }

    /// The same with another state.
    #[must_use]
    pub fn with_state(self, state: State) -> Self {
        Self { state, ..self }
    }

    /// The same with a number of threads.
    #[must_use]
    pub fn with_threads(self, threads: usize) -> Self {
        Self { threads, ..self }
    }

    /// The same with a SIMD level.
    #[must_use]
    pub fn with_level(self, level: SimdLevel) -> Self {
        Self { level, ..self }
    }

    fn prepare(&self, target: &Target) -> Prepared {
        let (threads, level) = (pool::threads(self.threads), self.level.or_scalar());
        let state = self.state;
        // Pixels whose centre is in the viewport, the scissor and the target.
        let first =
            |v: f32| if v > -1e6 { if v < 1e6 { (v - 0.5).ceil() as i32 } else { 1_000_000 } } else { -1_000_000 };
        let v = &self.viewport;
        let mut area =
            PixelBox { left: first(v.x), top: first(v.y), right: first(v.x + v.width), bottom: first(v.y + v.height) };
        area = area.intersect(&PixelBox { left: 0, top: 0, right: target.width as i32, bottom: target.height as i32 });
        if let Some(s) = state.scissor {
            area = area.intersect(&PixelBox { left: s.left, top: s.top, right: s.right, bottom: s.bottom });
        }
        let band_tiles = if threads <= 1 { target.tiles_y } else { target.tiles_y.div_ceil(threads * 8).clamp(1, 8) };
        let bands = target.tiles_y.div_ceil(band_tiles.max(1));
        let snap = Snap::new(state.subpixel_bits);
        let conservative = state.conservative && target.samples.coverage() == 1;
        let extent = SampleExtent::new(target.samples.positions(), conservative);
        let state = State { conservative, ..state };
        let binning = Binning::new(state, v.transform(), snap, extent, area, band_tiles, bands);
        let tests = Tests {
            depth: DepthRule::new(&state.depth, target.format, state.hierarchical_depth),
            stencil: state.stencil,
        };
        Prepared { binning, tests, snap, threads, level, band_tiles }
    }

    /// Draws primitives onto the target; see the type. What cannot be drawn (indices beyond the vertices, positions that are
    /// not numbers) is left out and counted.
    pub fn draw<V: VertexShader, F: FragmentShader>(
        &self,
        target: &mut Target,
        primitives: &Primitives<'_, V::Vertex>,
        vertex: &V,
        fragment: &F,
    ) -> Counters {
        let prepared = self.prepare(target);
        if self.state.stencil.is_some() {
            target.make_stencil();
        }
        let shaded = shade_vertices(
            vertex,
            primitives.vertices,
            &prepared.binning.transform,
            self.state.depth.clamp,
            prepared.snap,
            prepared.threads,
        );
        let output = self.output(fragment, &prepared.tests, target);
        let mut counters = Counters { vertices: primitives.vertices.len() as u64, ..Counters::default() };
        let level = prepared.level;
        let flush = |batch: &Batch, vertices: Vertices<'_>, band: &mut BandMut<'_>, counters: &mut Counters| {
            shade::flush(level, fragment, &output, batch, vertices, band, counters);
        };
        let traversal = Traversal {
            binning: &prepared.binning,
            tests: prepared.tests,
            early: output.early,
            tiles: output.plain,
            level,
        };
        let count = primitives.count();
        if prepared.threads <= 1 {
            let mut batch = Batch::new();
            let mut chunk = Chunk::default();
            let mut bands = target.bands(prepared.band_tiles);
            let Some(band) = bands.first_mut() else { return counters };
            for start in (0..count).step_by(CHUNK) {
                prepared.binning.run(primitives, start..(start + CHUNK).min(count), &shaded, &mut chunk);
                counters += chunk.counters;
                let Some(draws) = chunk.bands.first() else { continue };
                let vertices = Vertices::new(&shaded, &chunk);
                traverse::draw(&traversal, draws, vertices, band, &mut batch, &mut counters, &mut { flush });
            }
            shaded.recycle();
            return counters;
        }
        let chunks = prepared.bin(primitives, &shaded);
        for chunk in &chunks {
            counters += chunk.counters;
        }
        let total = std::sync::Mutex::new(counters);
        let jobs: Vec<_> = target.bands(prepared.band_tiles).into_iter().enumerate().collect();
        pool::for_each(prepared.threads, jobs, |(index, mut band)| {
            let mut own = Counters::default();
            let mut batch = Batch::new();
            for chunk in &chunks {
                let Some(draws) = chunk.bands.get(index) else { continue };
                if draws.is_empty() {
                    continue;
                }
                let vertices = Vertices::new(&shaded, chunk);
                traverse::draw(&traversal, draws, vertices, &mut band, &mut batch, &mut own, &mut { flush });
            }
            if let Ok(mut total) = total.lock() {
                *total += own;
            }
        });
        shaded.recycle();
        recycle(chunks);
        total.into_inner().unwrap_or_default()
    }

    fn output<F: FragmentShader>(&self, fragment: &F, tests: &Tests, target: &Target) -> Output {
        let mask = self.state.color_mask.map(|write| if write { 255 } else { 0 });
        let discards = fragment.may_discard();
        let early = !discards && self.state.alpha_test.is_none();
        let color_mask = u32::from_le_bytes(mask);
        let plain = early
            && color_mask == !0
            && self.state.blend == Blend::Replace
            && target.samples.coverage() == 1
            && target.attachments.is_empty();
        let (alpha_test, blend) = (self.state.alpha_test, self.state.blend);
        Output { tests: *tests, discards, early, alpha_test, blend, color_mask, plain }
    }

    /// Which primitives each band of rows lists, and how many rows a band has: what [`Pipeline::draw`] makes of the primitives with
    /// [`Pipeline::threads`] threads before it draws any. A list's order is the order of submission; with one thread there is one band.
    pub fn bins<V: VertexShader>(
        &self,
        target: &Target,
        primitives: &Primitives<'_, V::Vertex>,
        vertex: &V,
    ) -> (u32, Vec<Vec<u32>>) {
        let prepared = self.prepare(target);
        let (transform, clamp) = (&prepared.binning.transform, self.state.depth.clamp);
        let shaded = shade_vertices(vertex, primitives.vertices, transform, clamp, prepared.snap, prepared.threads);
        let mut bins = vec![Vec::new(); prepared.binning.bands];
        for chunk in prepared.bin(primitives, &shaded) {
            for (bin, draws) in bins.iter_mut().zip(&chunk.bands) {
                bin.extend(draws.iter().map(|draw| draw.primitive));
            }
        }
        (prepared.binning.band_rows as u32, bins)
    }

    /// The first pass of a depth prepass: draws depths alone. The colours come with a second [`Pipeline::draw`] of the same
    /// primitives by the state of [`Pipeline::after_prepass`], which shades each pixel at most once.
    pub fn draw_depth<V: VertexShader>(
        &self,
        target: &mut Target,
        primitives: &Primitives<'_, V::Vertex>,
        vertex: &V,
    ) -> Counters {
        let mut pipeline = *self;
        pipeline.state.color_mask = [false; 4];
        pipeline.draw(target, primitives, vertex, &Nothing)
    }

    /// This pipeline with the depth test for equality and without depth writes.
    #[must_use]
    pub fn after_prepass(&self) -> Self {
        let mut pipeline = *self;
        pipeline.state.depth = Depth { compare: super::state::Compare::Equal, write: false, ..self.state.depth };
        pipeline
    }

    /// The first pass of a visibility buffer: each pixel's colour becomes the number of the nearest primitive, eightfold, plus the
    /// piece that clipping cut, plus 1 (0 is nothing). The target's colours are to be cleared to 0 bits, with one sample. At most
    /// 2^29 − 2 primitives; solid triangles without blending.
    pub fn draw_visibility<V: VertexShader>(
        &self,
        target: &mut Target,
        primitives: &Primitives<'_, V::Vertex>,
        vertex: &V,
    ) -> Counters {
        let mut pipeline = *self;
        pipeline.state.blend = Blend::Replace;
        pipeline.state.alpha_test = None;
        pipeline.state.color_mask = [true; 4];
        pipeline.state.fill = Fill::Solid;
        pipeline.draw(target, primitives, vertex, &VisibilityIds)
    }

    /// The second pass of a visibility buffer: shades each pixel of `target` by the triangle that `visible`, drawn by
    /// [`Pipeline::draw_visibility`] with the same primitives, shader and viewport, names there: once a pixel, and to the very
    /// bytes that a direct draw would have given. Depth and stencil are left alone. Targets of different sizes or several samples: nothing is drawn.
    pub fn shade_visibility<V: VertexShader, F: FragmentShader>(
        &self,
        visible: &Target,
        target: &mut Target,
        primitives: &Primitives<'_, V::Vertex>,
        vertex: &V,
        fragment: &F,
    ) -> Counters {
        let mut counters = Counters::default();
        let same = (visible.width, visible.height) == (target.width, target.height);
        if !same || visible.samples.coverage() != 1 || target.samples.coverage() != 1 {
            return counters;
        }
        let mut pipeline = *self;
        pipeline.state.fill = Fill::Solid;
        pipeline.state.depth = Depth::OFF;
        pipeline.state.stencil = None;
        pipeline.threads = 1;
        let prepared = pipeline.prepare(target);
        let depth_clamp = self.state.depth.clamp;
        let transform = &prepared.binning.transform;
        let shaded = shade_vertices(vertex, primitives.vertices, transform, depth_clamp, prepared.snap, 1);
        counters.vertices = primitives.vertices.len() as u64;
        let output = Output { early: true, ..pipeline.output(fragment, &prepared.tests, target) };
        let (tiles_x, level) = (target.tiles_x, prepared.level);
        let mut bands = target.bands(prepared.band_tiles);
        let Some(band) = bands.first_mut() else { return counters };
        // Every tile on its own: its triangles are set up, and its pixels given to them.
        for (index, tile) in visible.color.iter().enumerate() {
            let mut wanted: Vec<u32> = tile.iter().flatten().copied().filter(|id| *id != 0).collect();
            wanted.sort_unstable();
            wanted.dedup();
            for ids in wanted.chunks(TRIANGLES / 8) {
                let mut batch = Batch::new();
                let mut chunk = Chunk::default();
                let mut all = Chunk { bands: vec![Vec::new()], ..Chunk::default() };
                for id in ids {
                    let primitive = ((id - 1) >> 3) as usize;
                    prepared.binning.run(primitives, primitive..primitive + 1, &shaded, &mut chunk);
                    append(&mut all, &chunk, &shaded, ((id - 1) & 7) as u8);
                }
                let vertices = Vertices::new(&shaded, &all);
                for draw in all.bands.first().map(Vec::as_slice).unwrap_or_default() {
                    let slot = batch.triangles.len() as u16;
                    let Some(triangle) = set_up(&prepared, draw, vertices) else { continue };
                    let id = (draw.primitive << 3 | u32::from(draw.piece)) + 1;
                    for (row, values) in tile.iter().enumerate() {
                        let mask = (0..TILE).fold(0_u64, |mask, i| mask | u64::from(values[i] == id) << i);
                        let (x, y) = (index % tiles_x * TILE, index / tiles_x * TILE + row);
                        if mask != 0 {
                            batch.groups.push(Group { x: x as u16, y: y as u16, triangle: slot, masks: [mask, 0] });
                        }
                    }
                    batch.triangles.push(triangle);
                }
                shade::flush(level, fragment, &output, &batch, vertices, band, &mut counters);
            }
        }
        counters
    }
}

thread_local! {
    /// The lists of the last draw on several threads: their memory is used again.
    static KEPT: std::cell::Cell<Vec<Chunk>> = const { std::cell::Cell::new(Vec::new()) };
}

/// Entries of lists whose memory is kept for the next draw, at most.
const KEPT_DRAWS: usize = 1 << 21;

/// Leaves the memory of lists to the thread's next draw.
fn recycle(chunks: Vec<Chunk>) {
    if chunks.iter().flat_map(|chunk| &chunk.bands).map(Vec::capacity).sum::<usize>() <= KEPT_DRAWS {
        KEPT.set(chunks);
    }
}

/// Adds one piece of what `from` has to `to`, its own vertices renumbered.
fn append(to: &mut Chunk, from: &Chunk, shaded: &ShadedVertices, piece: u8) {
    let own = shaded.screen.len() as u32;
    let offset = to.screen.len() as u32;
    let draws = from.bands.first().map(Vec::as_slice).unwrap_or_default();
    if let (Some(draw), Some(list)) = (draws.iter().find(|draw| draw.piece == piece), to.bands.first_mut()) {
        let vertices = draw.vertices.map(|i| if i < own { i } else { i + offset });
        list.push(DrawRef { vertices, ..*draw });
        to.screen.extend_from_slice(&from.screen);
        to.varyings.extend_from_slice(&from.varyings);
    }
}

/// Sets up a triangle as traversal does.
fn set_up(prepared: &Prepared, draw: &DrawRef, vertices: Vertices<'_>) -> Option<super::batch::BatchTriangle> {
    if !matches!(draw.kind, Kind::Triangle | Kind::Clipped) {
        return None;
    }
    let mut indices = draw.vertices;
    let mut v = indices.map(|i| vertices.screen(i));
    let area = double_area(&v);
    if area < 0 {
        v.swap(1, 2);
        indices.swap(1, 2);
    }
    let front = prepared.binning.is_front(area > 0);
    if draw.kind == Kind::Clipped {
        return Some(traverse::prepare_clipped(&prepared.tests, draw, indices, front, vertices));
    }
    (area != 0).then(|| traverse::prepare(&prepared.tests, draw, indices, &v, area.abs(), front))
}

impl Prepared {
    /// Bins all primitives, on all threads.
    fn bin<V: Sync>(&self, primitives: &Primitives<'_, V>, shaded: &ShadedVertices) -> Vec<Chunk> {
        let count = primitives.count();
        let size = count.div_ceil(self.threads * 4).max(CHUNK);
        let mut chunks = KEPT.take();
        chunks.resize_with(count.div_ceil(size), Chunk::default);
        let jobs: Vec<_> = chunks.iter_mut().enumerate().collect();
        pool::for_each(self.threads, jobs, |(index, chunk)| {
            let start = index * size;
            self.binning.run(primitives, start..(start + size).min(count), shaded, chunk);
        });
        chunks
    }
}

/// A shader for draws without colour.
struct Nothing;

impl FragmentShader for Nothing {
    #[inline(always)]
    fn shade<S: Simd>(&self, fragments: &Fragments<'_, S>) -> Shade<S> {
        Shade::packed(u32x8::splat(fragments.simd(), 0))
    }
}

/// The ids of a visibility buffer.
struct VisibilityIds;

impl FragmentShader for VisibilityIds {
    #[inline(always)]
    fn shade<S: Simd>(&self, fragments: &Fragments<'_, S>) -> Shade<S> {
        let id = (fragments.primitive() << 3 | u32::from(fragments.piece())).wrapping_add(1);
        Shade::packed(u32x8::splat(fragments.simd(), id))
    }
}
