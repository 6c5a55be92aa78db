//! What the tests of the 3D pipeline share.

use std::collections::BTreeSet;

use rastrum::space::*;
use rastrum::{Color, Pixmap};

use crate::oracle::triangle::Triangle;
use crate::oracle::{Pixel, Random};

/// A vertex that needs no shader: clip position and four values.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Vertex {
    pub(crate) position: [f32; 4],
    pub(crate) values: [f32; 4],
}

impl Vertex {
    pub(crate) fn new(position: [f32; 4], values: [f32; 4]) -> Self {
        Self { position, values }
    }
}

/// A vertex shader that hands on what is there, with four varyings.
pub(crate) fn pass() -> impl VertexShader<Vertex = Vertex> {
    vertex_fn(4, |vertex: &Vertex, out: &mut [f32]| {
        out.copy_from_slice(&vertex.values);
        vertex.position
    })
}

/// The clip position of a place in device pixels, with depth z (0 ..= 1) and w; exact where `size` is a power of two.
pub(crate) fn device(x: f32, y: f32, z: f32, w: f32, size: f32) -> [f32; 4] {
    [(x / size * 2.0 - 1.0) * w, (1.0 - y / size * 2.0) * w, (z * 2.0 - 1.0) * w, w]
}

/// An oracle's triangle as vertices at depth `z`.
pub(crate) fn vertices(triangle: Triangle, z: f32, values: [f32; 4], size: f32) -> [Vertex; 3] {
    triangle.map(|(x, y)| Vertex::new(device(x as f32 / 256.0, y as f32 / 256.0, z, 1.0, size), values))
}

/// A random triangle whose corners are on the subpixel grid, up to `beyond` pixels off a square of `size`.
pub(crate) fn random_triangle(random: &mut Random, size: i64, beyond: i64) -> Triangle {
    std::array::from_fn(|_| {
        let mut place = || random.within(-beyond * 256..(size + beyond) * 256);
        (place(), place())
    })
}

/// A pipeline without depth that adds one to each component where it draws.
pub(crate) fn counting(size: u32) -> Pipeline {
    let state = State { depth: Depth::OFF, blend: Blend::Additive, ..State::default() };
    Pipeline::new(size, size).with_state(state).with_threads(1)
}

/// The colour 1/255 in all components.
pub(crate) const ONE: Solid = Solid(Color { r: 1.0, g: 1.0, b: 1.0, a: 1.0 / 255.0 });

/// How often each pixel was drawn, by what [`counting`] left.
pub(crate) fn counts(target: &Target) -> Vec<u8> {
    target.to_pixmap().unwrap().data().as_chunks::<4>().0.iter().map(|pixel| pixel[3]).collect()
}

/// The pixels with any alpha.
pub(crate) fn drawn(target: &Target) -> BTreeSet<Pixel> {
    let picture = target.to_pixmap().unwrap();
    let width = picture.width() as i32;
    let pixels = picture.data().as_chunks::<4>().0.iter().enumerate();
    pixels.filter(|(_, pixel)| pixel[3] != 0).map(|(i, _)| (i as i32 % width, i as i32 / width)).collect()
}

/// The pixels that the pipeline draws of a triangle on a square of `size`.
pub(crate) fn raster(triangle: Triangle, size: u32) -> BTreeSet<Pixel> {
    raster_with(counting(size), triangle, size)
}

pub(crate) fn raster_with(pipeline: Pipeline, triangle: Triangle, size: u32) -> BTreeSet<Pixel> {
    let mut target = Target::new(size, size).unwrap();
    pipeline.draw(&mut target, &Primitives::triangles(&vertices(triangle, 0.5, [0.0; 4], size as f32)), &pass(), &ONE);
    assert!(counts(&target).iter().all(|count| *count <= 1), "a pixel comes twice");
    drawn(&target)
}

/// A full-target quad at one depth as two triangles.
pub(crate) fn quad(z: f32, values: [f32; 4]) -> [Vertex; 6] {
    let z = z * 2.0 - 1.0;
    let corner = |x: f32, y: f32| Vertex::new([x, y, z, 1.0], values);
    [corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)]
}

/// Colours by the four values, premultiplied already.
pub(crate) struct Values;

impl FragmentShader for Values {
    #[inline(always)]
    fn shade<S: rastrum::fearless_simd::Simd>(&self, fragments: &Fragments<'_, S>) -> Shade<S> {
        Shade::color(fragments.varyings(0))
    }
}

/// Draws and gives the picture.
pub(crate) fn picture(pipeline: &Pipeline, size: u32, vertices: &[Vertex]) -> Pixmap {
    let mut target = Target::new(size, size).unwrap();
    pipeline.draw(&mut target, &Primitives::triangles(vertices), &pass(), &Values);
    target.to_pixmap().unwrap()
}

/// |a − b| ≤ `relative` · max(|a|, |b|): the lecture's approxEqual.
pub(crate) fn approx_equal(a: f64, b: f64, relative: f64) -> bool {
    (a - b).abs() <= relative * a.abs().max(b.abs())
}

/// A random scene in view space before a camera at the origin, as triangles.
pub(crate) fn random_scene(random: &mut Random, count: usize) -> Vec<[[f64; 3]; 3]> {
    (0..count)
        .map(|_| {
            let mut within =
                |from: f64, to: f64| from + (to - from) * (random.within(0..1 << 20) as f64 / f64::from(1 << 20));
            let center = [within(-2.0, 2.0), within(-1.5, 1.5), within(-8.0, -2.5)];
            std::array::from_fn(|_| center.map(|c| (c + within(-1.2, 1.2)) as f32 as f64))
        })
        .collect()
}

/// Its triangles through a projection, each with the values that `values` gives for triangle and corner.
pub(crate) fn projected(
    scene: &[[[f64; 3]; 3]],
    projection: &rastrum::glam::Mat4,
    values: impl Fn(usize, usize) -> [f32; 4],
) -> Vec<Vertex> {
    let corner = |i: usize, k: usize, p: &[f64; 3]| {
        let [x, y, z] = p.map(|v| v as f32);
        Vertex::new(camera::transform(projection, [x, y, z, 1.0]), values(i, k))
    };
    scene.iter().enumerate().flat_map(|(i, t)| t.iter().enumerate().map(move |(k, p)| corner(i, k, p))).collect()
}
