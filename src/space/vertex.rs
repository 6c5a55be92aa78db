//! The vertex stage: a shader on each unique vertex, then the way to the screen.

use super::clip::ClipVertex;
use crate::num::fixed;

/// The most varyings.
pub const MAX_VARYINGS: usize = 16;

/// The program that runs once for each vertex.
pub trait VertexShader: Sync {
    /// A vertex as the caller keeps it.
    type Vertex: Sync;

    /// How many varyings [`VertexShader::shade`] writes, 0 ..= 16; more are cut off.
    fn varyings(&self) -> usize;

    /// The vertex's position in clip space (x, y, z, w); `varyings`, all 0 before, holds
    /// [`VertexShader::varyings`] values to fill.
    fn shade(&self, vertex: &Self::Vertex, varyings: &mut [f32]) -> [f32; 4];
}

/// A [`VertexShader`] from a closure; see [`vertex_fn`].
#[derive(Clone, Copy, Debug)]
pub struct VertexFn<V, F> {
    varyings: usize,
    shade: F,
    vertex: std::marker::PhantomData<fn(&V)>,
}

/// A vertex shader from a closure that takes a vertex, fills its varyings and gives its clip position.
pub fn vertex_fn<V: Sync, F: Fn(&V, &mut [f32]) -> [f32; 4] + Sync>(varyings: usize, shade: F) -> VertexFn<V, F> {
    VertexFn { varyings, shade, vertex: std::marker::PhantomData }
}

impl<V: Sync, F: Fn(&V, &mut [f32]) -> [f32; 4] + Sync> VertexShader for VertexFn<V, F> {
    type Vertex = V;

    fn varyings(&self) -> usize {
        self.varyings
    }

    #[inline]
    fn shade(&self, vertex: &V, varyings: &mut [f32]) -> [f32; 4] {
        (self.shade)(vertex, varyings)
    }
}

/// The range of clip-space z that is inside the view volume.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ClipDepth {
    /// −w ≤ z ≤ w, as in OpenGL: the default.
    #[default]
    MinusOneToOne,
    /// 0 ≤ z ≤ w, as in Direct3D and Vulkan; what reversed float depth needs for its precision.
    ZeroToOne,
}

/// The rectangle of device pixels that normalised device coordinates −1 ..= 1 map to, and the depths that
/// z / w maps to. NDC (−1, −1) is the rectangle's lower left corner, since y points up in clip space and down on the canvas.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Viewport {
    /// Left side in device pixels.
    pub x: f32,
    /// Top side in device pixels.
    pub y: f32,
    /// Columns.
    pub width: f32,
    /// Rows.
    pub height: f32,
    /// The depth of the near plane, 0 ..= 1. Default 0.
    pub near: f32,
    /// The depth of the far plane, 0 ..= 1. Default 1.
    pub far: f32,
    /// What z / w spans.
    pub clip_depth: ClipDepth,
}

impl Viewport {
    /// All of a target of the given size.
    pub fn new(width: u32, height: u32) -> Self {
        Self {
            x: 0.0,
            y: 0.0,
            width: width as f32,
            height: height as f32,
            near: 0.0,
            far: 1.0,
            clip_depth: ClipDepth::MinusOneToOne,
        }
    }

    /// A point in clip space as device x, device y and depth: M · v / w, then the viewport. Not finite where w is 0.
    pub fn project(&self, [x, y, z, w]: [f32; 4]) -> [f32; 3] {
        let transform = self.transform();
        let inverse_w = 1.0 / w;
        [
            x * inverse_w * transform.half_width + transform.center_x,
            transform.center_y - y * inverse_w * transform.half_height,
            z * inverse_w * transform.depth_scale + transform.depth_offset,
        ]
    }

    pub(crate) fn transform(&self) -> Transform {
        let (half_width, half_height) = (self.width * 0.5, self.height * 0.5);
        let (depth_scale, depth_offset) = match self.clip_depth {
            ClipDepth::MinusOneToOne => ((self.far - self.near) * 0.5, (self.far + self.near) * 0.5),
            ClipDepth::ZeroToOne => (self.far - self.near, self.near),
        };
        Transform {
            half_width,
            half_height,
            center_x: self.x + half_width,
            center_y: self.y + half_height,
            depth_scale,
            depth_offset,
            near: match self.clip_depth {
                ClipDepth::MinusOneToOne => -1.0,
                ClipDepth::ZeroToOne => 0.0,
            },
        }
    }
}

/// The viewport as factors.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Transform {
    half_width: f32,
    half_height: f32,
    center_x: f32,
    center_y: f32,
    depth_scale: f32,
    depth_offset: f32,
    /// z ≥ near · w is inside the near plane.
    pub(crate) near: f32,
}

/// Screen positions lie within this many pixels of the origin, so that their differences fit 26 bits of fixed point.
pub(crate) const GUARD: f32 = 65_000.0;

impl Transform {
    /// The guard band in normalised device coordinates: |x| ≤ horizontal · w, |y| ≤ vertical · w stays on the fixed-point screen.
    pub(crate) fn guard(&self) -> [f32; 2] {
        let horizontal = (GUARD - 1.0 - self.center_x.abs()) / self.half_width.abs().max(0.5);
        let vertical = (GUARD - 1.0 - self.center_y.abs()) / self.half_height.abs().max(0.5);
        [if horizontal > 1.0 { horizontal } else { 1.0 }, if vertical > 1.0 { vertical } else { 1.0 }]
    }

    /// The vertex on the screen, or [`ScreenVertex::UNSAFE`] where it lies outside what the rasterizer takes.
    #[inline(always)]
    pub(crate) fn screen(&self, [x, y, z, w]: [f32; 4], depth_clamp: bool, snap: Snap) -> ScreenVertex {
        let inverse_w = 1.0 / w;
        let sx = x * inverse_w * self.half_width + self.center_x;
        let sy = self.center_y - y * inverse_w * self.half_height;
        let inside = depth_clamp || (z >= self.near * w && z <= w);
        // Comparisons with what is not a number fail, so that this accepts only sound vertices.
        if !(w > 1e-30 && inside && sx.abs() <= GUARD && sy.abs() <= GUARD) {
            return ScreenVertex::UNSAFE;
        }
        let z = z * inverse_w * self.depth_scale + self.depth_offset;
        ScreenVertex { fine_x: snap.apply(sx), fine_y: snap.apply(sy), z, inverse_w }
    }
}

/// Rounding of screen positions to the subpixel grid.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Snap {
    scale: f32,
    shift: u32,
}

impl Snap {
    pub(crate) fn new(bits: u32) -> Self {
        let bits = bits.clamp(1, 8);
        Self { scale: (1 << bits) as f32 / 256.0, shift: 8 - bits }
    }

    /// A position in pixels, at most [`GUARD`] and a point's size from 0, to 18.14: rounded to nearest of the grid, and six bits of what
    /// it was before; see [`ScreenVertex`].
    #[inline(always)]
    fn apply(self, position: f32) -> i32 {
        let snapped = fixed::from_f32(position * self.scale) << (self.shift + FINE);
        if self.shift != 0 {
            return snapped;
        }
        let rest = fixed::from_f64(f64::from(position) * f64::from(1 << FINE)) - snapped;
        snapped + rest.clamp(-(1 << (FINE - 1)), (1 << (FINE - 1)) - 1)
    }
}

/// Bits of a position beyond 24.8.
pub(crate) const FINE: u32 = 6;

/// A vertex on the screen.
///
/// Coverage is decided by positions on the subpixel grid, while depths and varyings are planes through the positions as they were: on steep
/// triangles the half of 1/256 pixel between them would show in the depths' sixth digit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ScreenVertex {
    /// Device position, 18.14: the nearest multiple of 64 is the snapped one.
    pub(crate) fine_x: i32,
    pub(crate) fine_y: i32,
    /// Depth in the viewport's range.
    pub(crate) z: f32,
    pub(crate) inverse_w: f32,
}

impl ScreenVertex {
    /// Stands for a vertex that has to be clipped first.
    pub(crate) const UNSAFE: Self = Self { fine_x: i32::MIN, fine_y: 0, z: 0.0, inverse_w: 0.0 };

    /// The snapped x, 24.8.
    #[inline(always)]
    pub(crate) fn x(&self) -> i32 {
        (self.fine_x + (1 << (FINE - 1))) >> FINE
    }

    /// The snapped y, 24.8.
    #[inline(always)]
    pub(crate) fn y(&self) -> i32 {
        (self.fine_y + (1 << (FINE - 1))) >> FINE
    }

    #[inline(always)]
    pub(crate) fn is_unsafe(&self) -> bool {
        self.fine_x == i32::MIN
    }
}

/// What the vertex stage hands on.
#[derive(Debug, Default)]
pub(crate) struct ShadedVertices {
    pub(crate) screen: Vec<ScreenVertex>,
    pub(crate) clip: Vec<[f32; 4]>,
    /// `stride` values a vertex, of which the first `count` are varyings and the others 0.
    pub(crate) varyings: Vec<f32>,
    pub(crate) stride: usize,
    pub(crate) count: usize,
}

/// Values a vertex is given room for: a multiple of four, so that set-up works four at a time.
pub(crate) fn stride_of(varyings: usize) -> usize {
    varyings.next_multiple_of(4)
}

thread_local! {
    /// The vertices of the last draw: their memory is used again, as fresh pages cost as much as shading.
    static KEPT: std::cell::Cell<ShadedVertices> = std::cell::Cell::default();
}

/// Vertices whose memory is kept for the next draw, at most.
const KEPT_VERTICES: usize = 1 << 19;

impl ShadedVertices {
    /// Leaves the memory to the thread's next draw.
    pub(crate) fn recycle(self) {
        if self.screen.capacity() <= KEPT_VERTICES {
            KEPT.set(self);
        }
    }

    pub(crate) fn clip_vertex(&self, index: usize) -> Option<ClipVertex> {
        let mut vertex = ClipVertex { position: *self.clip.get(index)?, varyings: [0.0; MAX_VARYINGS] };
        let source = self.varyings.get(index * self.stride..index * self.stride + self.count)?;
        vertex.varyings.get_mut(..self.count)?.copy_from_slice(source);
        Some(vertex)
    }
}

/// Runs the vertex shader on every vertex.
pub(crate) fn shade_vertices<V: VertexShader>(
    shader: &V,
    vertices: &[V::Vertex],
    transform: &Transform,
    depth_clamp: bool,
    snap: Snap,
    threads: usize,
) -> ShadedVertices {
    let count = shader.varyings().min(MAX_VARYINGS);
    let stride = stride_of(count);
    let mut shaded = ShadedVertices { stride, count, ..KEPT.take() };
    shaded.screen.resize(vertices.len(), ScreenVertex::UNSAFE);
    shaded.clip.resize(vertices.len(), [0.0; 4]);
    shaded.varyings.resize(vertices.len() * stride, 0.0);
    let chunk = if threads <= 1 { vertices.len() } else { vertices.len().div_ceil(threads * 4) }.max(256);
    let mut varyings = shaded.varyings.chunks_mut((chunk * stride).max(1));
    let jobs: Vec<_> = vertices
        .chunks(chunk)
        .zip(shaded.screen.chunks_mut(chunk))
        .zip(shaded.clip.chunks_mut(chunk))
        .map(|((vertices, screen), clip)| (vertices, screen, clip, varyings.next().unwrap_or_default()))
        .collect();
    crate::pool::for_each(threads, jobs, |(vertices, screen, clip, varyings)| {
        let mut varyings = varyings.chunks_exact_mut(stride.max(1));
        for ((vertex, screen), clip) in vertices.iter().zip(screen).zip(clip) {
            let values = varyings.next().unwrap_or_default();
            values.fill(0.0);
            *clip = shader.shade(vertex, values.get_mut(..count).unwrap_or_default());
            *screen = transform.screen(*clip, depth_clamp, snap);
        }
    });
    shaded
}
