//! rastrum's 3D pipeline.

use rastrum::fearless_simd::{Simd, f32x8, prelude::*};
use rastrum::space::{
    Address, DepthFormat, Filter, FragmentShader, Fragments, Pipeline, Primitives, Sampler, Samples, Shade, Target,
    Texture, VertexColor, vertex_fn,
};
use rastrum::{Color, Pixmap};

use super::scenes::{self, SIZE, Scene, Shading, Vertex};

/// Per-pixel Phong: 0.1 + 0.9·N·L, and a highlight to the 32nd power.
struct Phong;

impl FragmentShader for Phong {
    #[inline(always)]
    fn shade<S: Simd>(&self, f: &Fragments<'_, S>) -> Shade<S> {
        let simd = f.simd();
        let [x, y, z] = f.varyings(0);
        let inverse = f32x8::splat(simd, 1.0) / (x * x + y * y + z * z).sqrt();
        let (x, y, z) = (x * inverse, y * inverse, z * inverse);
        let zero = f32x8::splat(simd, 0.0);
        let positive = |v: f32x8<S>| v.simd_gt(zero).select(v, zero);
        let diffuse = positive(x * 0.267 + y * 0.534 + z * 0.802) * 0.9 + 0.1;
        let mut shine = positive(x * 0.14 + y * 0.28 + z * 0.95);
        for _ in 0..5 {
            shine = shine * shine;
        }
        Shade::opaque([diffuse * 0.8 + shine * 0.5, diffuse * 0.5 + shine * 0.5, diffuse * 0.3 + shine * 0.5])
    }
}

struct Textured(Texture);

impl FragmentShader for Textured {
    #[inline(always)]
    fn shade<S: Simd>(&self, f: &Fragments<'_, S>) -> Shade<S> {
        let [u, v] = f.varyings(0);
        Shade::packed(self.0.sample_grad(u, v, f.derivatives(0), f.derivatives(1)))
    }
}

pub(crate) fn target(scene: &Scene) -> Target {
    let samples = if scene.samples == 4 { Samples::Msaa4 } else { Samples::One };
    Target::with_format(SIZE.0, SIZE.1, DepthFormat::D32F, samples).expect("a target of 1280 × 720")
}

/// Draws a frame, reads the picture back, and gives the fragments shaded.
pub(crate) fn draw(scene: &Scene, target: &mut Target, threads: usize) -> u64 {
    target.clear_color(Color::BLACK);
    target.clear_depth(1.0);
    let pipeline = Pipeline::new(SIZE.0, SIZE.1).with_threads(threads);
    let vertex = vertex_fn(3, |v: &Vertex, out: &mut [f32]| {
        out.copy_from_slice(&v.values);
        v.position
    });
    let primitives = Primitives::indexed(&scene.vertices, &scene.indices);
    let counters = match scene.shading {
        Shading::Gouraud => pipeline.draw(target, &primitives, &vertex, &VertexColor),
        Shading::Phong => pipeline.draw(target, &primitives, &vertex, &Phong),
        Shading::Bilinear | Shading::Trilinear => {
            let filter = if scene.shading == Shading::Bilinear { Filter::Bilinear } else { Filter::Trilinear };
            let (side, data) = scenes::texture();
            let picture = Pixmap::from_vec(side, side, data).expect("a texture of 256 × 256");
            let texture = Texture::from_pixmap(&picture, Sampler::new(Address::Wrap, filter)).expect("a texture");
            pipeline.draw(target, &primitives, &vertex, &Textured(texture))
        }
    };
    std::hint::black_box(target.to_pixmap().expect("a picture of 1280 × 720"));
    counters.fragments
}
