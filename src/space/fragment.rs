//! The fragment stage: shaders on eight pixels at a time.

use fearless_simd::prelude::*;
use fearless_simd::{f32x4, f32x8, i32x8, u32x8};

use super::batch::BatchTriangle;
use super::bin::Vertices;
use super::test::{lane_offsets, plane_at};
use super::vertex::MAX_VARYINGS;
use crate::num::lanes::{each, max_i32, truncate_f32};

/// The program that gives eight pixels their colours.
///
/// It is compiled for each SIMD level: write it with the vectors of [`fearless_simd`](crate::fearless_simd), mark
/// it `#[inline(always)]`, and use `+ − × ÷ √`, comparisons and selections alone if the same bytes are wanted at every level (`mul_add`,
/// approximate reciprocals, `min` and `max` of floats are not the same). For one pixel at a time there is [`pixel_fn`].
pub trait FragmentShader: Sync {
    /// Whether [`Shade::keep`] may drop pixels in this draw; asked once a draw. Tests then run after the shader instead of
    /// before. The default is false.
    fn may_discard(&self) -> bool {
        false
    }

    /// The colours of eight pixels that one triangle covers in part or whole. Lanes outside
    /// [`Fragments::mask`] are of no consequence, but must not stop the program.
    fn shade<S: Simd>(&self, fragments: &Fragments<'_, S>) -> Shade<S>;

    /// The value that goes to an attachment of the target, 0 unless overridden.
    #[inline(always)]
    fn attachment<S: Simd>(&self, fragments: &Fragments<'_, S>, attachment: usize) -> u32x8<S> {
        let _ = attachment;
        u32x8::splat(fragments.simd(), 0)
    }
}

/// What a fragment shader gives.
#[derive(Clone, Copy, Debug)]
pub struct Shade<S: Simd> {
    /// Premultiplied RGBA8, red in the lowest byte.
    pub color: u32x8<S>,
    /// The pixels to keep, bit i for pixel i; heeded only if [`FragmentShader::may_discard`].
    pub keep: u8,
}

impl<S: Simd> Shade<S> {
    /// All pixels kept, with packed colours.
    #[inline(always)]
    pub fn packed(color: u32x8<S>) -> Self {
        Self { color, keep: !0 }
    }

    /// All pixels kept, with premultiplied components 0 ..= 1; see [`pack`].
    #[inline(always)]
    pub fn color(components: [f32x8<S>; 4]) -> Self {
        Self::packed(pack(components))
    }

    /// All pixels kept and opaque, with components 0 ..= 1; see [`pack`].
    #[inline(always)]
    pub fn opaque([r, g, b]: [f32x8<S>; 3]) -> Self {
        Self::packed(level(r) | level(g) << 8 | level(b) << 16 | 0xff00_0000)
    }
}

/// Premultiplied components 0 ..= 1 as packed RGBA8, red lowest: ⌊255·v + ½⌋, clamped; NaN is 0.
#[inline(always)]
pub fn pack<S: Simd>([r, g, b, a]: [f32x8<S>; 4]) -> u32x8<S> {
    level(r) | level(g) << 8 | level(b) << 16 | level(a) << 24
}

/// ⌊255·v + ½⌋ within 0 ..= 255.
#[inline(always)]
fn level<S: Simd>(v: f32x8<S>) -> u32x8<S> {
    let simd = v.simd;
    let v = v * 255.0 + 0.5;
    let most = f32x8::splat(simd, 255.0);
    // What is below 0 or not a number becomes an integer of at most 0 at every level.
    let v: i32x8<S> = truncate_f32(v.simd_ge(most).select(most, v));
    max_i32(v, i32x8::splat(simd, 0)).bitcast()
}

/// Packed RGBA8 as components 0 ..= 1.
#[inline(always)]
pub fn unpack<S: Simd>(color: u32x8<S>) -> [f32x8<S>; 4] {
    let component = |shift: u32| {
        let v: i32x8<S> = ((color >> shift) & 255).bitcast();
        let v: f32x8<S> = v.to_float();
        v * (1.0 / 255.0)
    };
    [component(0), component(8), component(16), component(24)]
}

/// A triangle's planes: everything that is reckoned once for all of its pixels.
#[derive(Clone, Copy)]
pub(crate) struct Planes<'a> {
    pub(crate) triangle: BatchTriangle,
    /// Varyings divided by w: values at the first vertex as snapped, steps right, steps down.
    pub(crate) value: [f32; MAX_VARYINGS],
    pub(crate) right: [f32; MAX_VARYINGS],
    pub(crate) down: [f32; MAX_VARYINGS],
    /// The varyings of the three vertices.
    pub(crate) corners: [&'a [f32]; 3],
    /// Those of the primitive's first vertex.
    pub(crate) provoking: &'a [f32],
}

impl<'a> Planes<'a> {
    /// Reckons the planes of a triangle's varyings, four at a time, into `self`.
    #[inline(always)]
    pub(crate) fn load<S: Simd>(&mut self, simd: S, triangle: &BatchTriangle, vertices: Vertices<'a>) {
        self.triangle = *triangle;
        self.corners = triangle.vertices.map(|i| vertices.varyings(i));
        self.provoking = if triangle.clipped { vertices.varyings(triangle.vertices[0] + 3) } else { self.corners[0] };
        let w = triangle.vertices.map(|i| vertices.screen(i).inverse_w);
        let g = &triangle.gradients;
        let [a, b, c] = self.corners.map(|corner| corner.as_chunks::<4>().0);
        let values = self.value.as_chunks_mut::<4>().0.iter_mut();
        let steps = self.right.as_chunks_mut::<4>().0.iter_mut().zip(self.down.as_chunks_mut::<4>().0);
        for ((((a, b), c), value), (right, down)) in a.iter().zip(b).zip(c).zip(values).zip(steps) {
            let four = |v: &[f32; 4]| f32x4::load_array_ref(simd, v);
            let v0 = four(a) * w[0];
            let (d1, d2) = (four(b) * w[1] - v0, four(c) * w[2] - v0);
            (v0 + (d1 * g.l1 + d2 * g.l2)).store_array(value);
            (d1 * g.x1 + d2 * g.x2).store_array(right);
            (d1 * g.y1 + d2 * g.y2).store_array(down);
        }
    }

    pub(crate) fn new() -> Self {
        Self {
            triangle: BatchTriangle {
                vertices: [0; 3],
                primitive: 0,
                piece: 0,
                front: true,
                clipped: false,
                gradients: super::setup::Gradients::default(),
                z: [0.0; 3],
                inverse_w: [1.0, 0.0, 0.0],
            },
            value: [0.0; MAX_VARYINGS],
            right: [0.0; MAX_VARYINGS],
            down: [0.0; MAX_VARYINGS],
            corners: [&[]; 3],
            provoking: &[],
        }
    }
}

/// Eight pixels of one row that one primitive covers in part or whole, with everything that is interpolated.
///
/// Values are taken at pixel centres, and reckoned when they are asked for.
#[derive(Clone, Copy)]
pub struct Fragments<'a, S: Simd> {
    simd: S,
    planes: &'a Planes<'a>,
    /// Pixels from the first vertex to the centres.
    dx: f32x8<S>,
    dy: f32x8<S>,
    w: f32x8<S>,
    x: u32,
    y: u32,
    mask: u8,
}

impl<'a, S: Simd> Fragments<'a, S> {
    #[inline(always)]
    pub(crate) fn new(simd: S, planes: &'a Planes<'a>, x: u16, y: u16, mask: u8) -> Self {
        let dx = lane_offsets(simd) + (f32::from(x) + 0.5 - planes.triangle.gradients.x0);
        let dy = f32x8::splat(simd, f32::from(y) + 0.5 - planes.triangle.gradients.y0);
        let inverse_w = plane_at(planes.triangle.inverse_w, dx, dy);
        let w = f32x8::splat(simd, 1.0) / inverse_w;
        Self { simd, planes, dx, dy, w, x: u32::from(x), y: u32::from(y), mask }
    }

    /// The token of the SIMD level.
    #[inline(always)]
    pub fn simd(&self) -> S {
        self.simd
    }

    /// The first pixel's column.
    #[inline(always)]
    pub fn x(&self) -> u32 {
        self.x
    }

    /// The pixels' row.
    #[inline(always)]
    pub fn y(&self) -> u32 {
        self.y
    }

    /// Which of the eight pixels are drawn, bit i for pixel i.
    #[inline(always)]
    pub fn mask(&self) -> u8 {
        self.mask
    }

    /// The x of the pixels' centres in device pixels.
    #[inline(always)]
    pub fn center_x(&self) -> f32x8<S> {
        lane_offsets(self.simd) + (self.x as f32 + 0.5)
    }

    /// The y of the pixels' centres in device pixels.
    #[inline(always)]
    pub fn center_y(&self) -> f32x8<S> {
        f32x8::splat(self.simd, self.y as f32 + 0.5)
    }

    /// The clip-space w of the pixels: for perspective the distance along the view axis.
    #[inline(always)]
    pub fn w(&self) -> f32x8<S> {
        self.w
    }

    /// The depth before the depth format rounds and clamps it.
    #[inline(always)]
    pub fn depth(&self) -> f32x8<S> {
        plane_at(self.planes.triangle.z, self.dx, self.dy)
    }

    /// A varying, interpolated with perspective: the interpolated u / w times the interpolated w. 0 for one that the
    /// vertex shader did not write.
    #[inline(always)]
    pub fn varying(&self, index: usize) -> f32x8<S> {
        let i = index & (MAX_VARYINGS - 1);
        plane_at([self.planes.value[i], self.planes.right[i], self.planes.down[i]], self.dx, self.dy) * self.w
    }

    /// Several varyings from `first` on.
    #[inline(always)]
    pub fn varyings<const N: usize>(&self, first: usize) -> [f32x8<S>; N] {
        each(self.simd, |i| self.varying(first + i))
    }

    /// How a varying grows per pixel to the right and down, exactly (not by differences of neighbours): (∂/∂x, ∂/∂y).
    #[inline(always)]
    pub fn derivatives(&self, index: usize) -> (f32x8<S>, f32x8<S>) {
        let i = index & (MAX_VARYINGS - 1);
        let value = self.varying(index);
        let [_, wx, wy] = self.planes.triangle.inverse_w;
        let x = (-value * wx + self.planes.right[i]) * self.w;
        let y = (-value * wy + self.planes.down[i]) * self.w;
        (x, y)
    }

    /// A varying interpolated in screen space, without perspective.
    #[inline(always)]
    pub fn linear(&self, index: usize) -> f32x8<S> {
        let v = self.planes.corners.map(|corner| corner.get(index).copied().unwrap_or_default());
        plane_at(self.planes.triangle.gradients.plane(v[0], v[1], v[2]), self.dx, self.dy)
    }

    /// A varying's value at the provoking vertex, exactly: the primitive's first vertex.
    #[inline(always)]
    pub fn flat(&self, index: usize) -> f32 {
        self.planes.provoking.get(index).copied().unwrap_or_default()
    }

    /// A varying's value at vertex `corner` (0 ..= 2) of the triangle; see [`Fragments::barycentrics`] for their order.
    #[inline(always)]
    pub fn corner(&self, corner: usize, index: usize) -> f32 {
        self.planes.corners.get(corner).and_then(|corner| corner.get(index)).copied().unwrap_or_default()
    }

    /// The weights of the three vertices in screen space: 1 in all. The order of the second and third is the triangle's,
    /// or the other way round if it runs counter-clockwise on the screen. Where clipping cut the primitive, the vertices are three corners
    /// of what is seen of it, and weights may be negative beyond them.
    #[inline(always)]
    pub fn barycentrics(&self) -> [f32x8<S>; 3] {
        let g = &self.planes.triangle.gradients;
        let u = plane_at([g.l1, g.x1, g.y1], self.dx, self.dy);
        let v = plane_at([g.l2, g.x2, g.y2], self.dx, self.dy);
        [f32x8::splat(self.simd, 1.0) - u - v, u, v]
    }

    /// The number of the primitive within the draw.
    #[inline(always)]
    pub fn primitive(&self) -> u32 {
        self.planes.triangle.primitive
    }

    /// Which piece of the primitive this is, where clipping cut it into several.
    #[inline(always)]
    pub fn piece(&self) -> u8 {
        self.planes.triangle.piece
    }

    /// Whether the triangle is seen from its front. Lines and points are.
    #[inline(always)]
    pub fn is_front(&self) -> bool {
        self.planes.triangle.front
    }
}

/// One pixel of a primitive: what [`pixel_fn`] hands to its closure.
#[derive(Clone, Copy, Debug)]
pub struct Fragment {
    /// Column.
    pub x: u32,
    /// Row.
    pub y: u32,
    /// Depth before rounding to the format.
    pub depth: f32,
    /// Clip-space w.
    pub w: f32,
    /// The number of the primitive within the draw.
    pub primitive: u32,
    /// Whether the primitive is seen from its front.
    pub is_front: bool,
    /// The varyings, with perspective.
    pub varyings: [f32; MAX_VARYINGS],
}

/// A [`FragmentShader`] from a closure on one pixel; see [`pixel_fn`].
#[derive(Clone, Copy, Debug)]
pub struct PixelFn<F> {
    varyings: usize,
    shade: F,
}

/// A fragment shader from a closure that takes one pixel and gives its premultiplied RGBA in 0 ..= 1, or `None` to
/// discard it. For convenience, not for speed. `varyings` of them are interpolated.
pub fn pixel_fn<F: Fn(&Fragment) -> Option<[f32; 4]> + Sync>(varyings: usize, shade: F) -> PixelFn<F> {
    PixelFn { varyings: varyings.min(MAX_VARYINGS), shade }
}

impl<F: Fn(&Fragment) -> Option<[f32; 4]> + Sync> FragmentShader for PixelFn<F> {
    fn may_discard(&self) -> bool {
        true
    }

    #[inline(always)]
    fn shade<S: Simd>(&self, fragments: &Fragments<'_, S>) -> Shade<S> {
        let simd = fragments.simd();
        let mut varyings = [[0.0_f32; 8]; MAX_VARYINGS];
        for (i, values) in varyings.iter_mut().enumerate().take(self.varyings) {
            *values = fragments.varying(i).to_array();
        }
        let (depth, w) = (fragments.depth().to_array(), fragments.w().to_array());
        let mut out = [[0.0_f32; 8]; 4];
        let mut keep = 0;
        for lane in 0..8 {
            if fragments.mask() >> lane & 1 == 0 {
                continue;
            }
            let fragment = Fragment {
                x: fragments.x() + lane as u32,
                y: fragments.y(),
                depth: depth[lane],
                w: w[lane],
                primitive: fragments.primitive(),
                is_front: fragments.is_front(),
                varyings: varyings.map(|values| values[lane]),
            };
            if let Some(color) = (self.shade)(&fragment) {
                keep |= 1 << lane;
                for (out, value) in out.iter_mut().zip(color) {
                    out[lane] = value;
                }
            }
        }
        Shade { color: pack(each(simd, |i| f32x8::load_array_ref(simd, &out[i]))), keep }
    }
}

/// The simplest shader: one colour.
#[derive(Clone, Copy, Debug)]
pub struct Solid(pub crate::color::Color);

impl FragmentShader for Solid {
    #[inline(always)]
    fn shade<S: Simd>(&self, fragments: &Fragments<'_, S>) -> Shade<S> {
        Shade::packed(u32x8::splat(fragments.simd(), u32::from_le_bytes(self.0.premultiply())))
    }
}

/// Interpolated opaque colour: varyings `0 .. 3` are red, green and blue, 0 ..= 1.
#[derive(Clone, Copy, Debug)]
pub struct VertexColor;

impl FragmentShader for VertexColor {
    #[inline(always)]
    fn shade<S: Simd>(&self, fragments: &Fragments<'_, S>) -> Shade<S> {
        Shade::opaque(fragments.varyings(0))
    }
}

/// The number of the primitive plus 1 in red, green and blue, red lowest; opaque.
#[derive(Clone, Copy, Debug)]
pub struct PrimitiveIds;

impl FragmentShader for PrimitiveIds {
    #[inline(always)]
    fn shade<S: Simd>(&self, fragments: &Fragments<'_, S>) -> Shade<S> {
        let id = fragments.primitive().wrapping_add(1);
        Shade::packed(u32x8::splat(fragments.simd(), id | 0xff00_0000))
    }
}
