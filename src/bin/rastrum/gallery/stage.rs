//! Small 3D draws for pictures: triangles by device pixels, scenes, and what they leave.

use rastrum::glam::Mat4;
use rastrum::scene::{Camera, Light, Material, Mesh, Scene, SceneAntialias, SceneSettings, SceneStats, render_picture};
use rastrum::space::{
    Blend, Counters, Depth, Fragment, Pipeline, Primitives, Samples, State, Target, VertexColor, VertexFn, camera,
    pixel_fn, vertex_fn,
};
use rastrum::{Color, Pixmap, Rect, Result};

use super::board::{Board, PAPER};

/// A vertex that needs no shader.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Vertex {
    pub(crate) position: [f32; 4],
    pub(crate) values: [f32; 4],
}

/// What colours a pixel; one type for all, so that the pipeline is compiled once.
pub(crate) type Shade<'a> = &'a (dyn Fn(&Fragment) -> Option<[f32; 4]> + Sync);

/// Corners in pixels, y down.
pub(crate) type Triangle = [(f32, f32); 3];

fn pass(vertex: &Vertex, out: &mut [f32]) -> [f32; 4] {
    out.copy_from_slice(&vertex.values);
    vertex.position
}

/// A pipeline on one thread.
pub(crate) fn pipeline(width: u32, height: u32, state: State) -> Pipeline {
    Pipeline::new(width, height).with_state(state).with_threads(1)
}

/// Draws a list of triangles.
pub(crate) fn draw(target: &mut Target, pipeline: &Pipeline, vertices: &[Vertex], shade: Shade<'_>) -> Counters {
    pipeline.draw(target, &Primitives::triangles(vertices), &shader(), &pixel_fn(4, shade))
}

/// Draws a list of opaque triangles by the colours that they carry, depth first.
pub(crate) fn draw_opaque(target: &mut Target, pipeline: &Pipeline, vertices: &[Vertex]) -> Counters {
    pipeline.draw(target, &Primitives::triangles(vertices), &shader(), &VertexColor)
}

/// The vertex shader of all of these.
pub(crate) fn shader() -> VertexFn<Vertex, fn(&Vertex, &mut [f32]) -> [f32; 4]> {
    vertex_fn(4, pass)
}

/// The same of other primitives.
pub(crate) fn draw_primitives(
    target: &mut Target,
    pipeline: &Pipeline,
    primitives: &Primitives<'_, Vertex>,
    shade: Shade<'_>,
) -> Counters {
    pipeline.draw(target, primitives, &shader(), &pixel_fn(4, shade))
}

/// Which primitives each band lists.
pub(crate) fn bins(target: &Target, pipeline: &Pipeline, vertices: &[Vertex]) -> (u32, Vec<Vec<u32>>) {
    pipeline.bins(target, &Primitives::triangles(vertices), &shader())
}

/// The clip position of a place in device pixels with a depth of 0 ..= 1 and w = 1.
pub(crate) fn device((x, y): (f32, f32), z: f32, (width, height): (u32, u32)) -> [f32; 4] {
    [x / width as f32 * 2.0 - 1.0, 1.0 - y / height as f32 * 2.0, z * 2.0 - 1.0, 1.0]
}

/// A triangle at one depth with one colour, opaque unless the colour is not.
pub(crate) fn flat(triangle: Triangle, z: f32, color: Color, size: (u32, u32)) -> [Vertex; 3] {
    triangle.map(|at| Vertex { position: device(at, z, size), values: components(color) })
}

/// A rectangle (left, top, right, bottom) as two triangles.
pub(crate) fn quad([l, t, r, b]: [f32; 4], z: f32, color: Color, size: (u32, u32)) -> Vec<Vertex> {
    let mut out = flat([(l, t), (l, b), (r, b)], z, color, size).to_vec();
    out.extend(flat([(l, t), (r, b), (r, t)], z, color, size));
    out
}

/// Premultiplied components.
pub(crate) fn components(color: Color) -> [f32; 4] {
    [color.r * color.a, color.g * color.a, color.b * color.a, color.a]
}

/// The colour that the vertices carry.
pub(crate) fn carried(fragment: &Fragment) -> Option<[f32; 4]> {
    let [r, g, b, a, ..] = fragment.varyings;
    Some([r, g, b, a])
}

/// A target of paper.
pub(crate) fn paper(width: u32, height: u32, samples: Samples) -> Result<Target> {
    let mut target = Target::with_format(width, height, rastrum::space::DepthFormat::D32F, samples)?;
    target.clear_color(Color::WHITE);
    Ok(target)
}

/// What the pipeline draws of triangles with their colours.
pub(crate) fn picture(
    vertices: &[Vertex],
    (width, height): (u32, u32),
    samples: Samples,
    state: State,
) -> Result<Pixmap> {
    let mut target = paper(width, height, samples)?;
    draw(&mut target, &pipeline(width, height, state), vertices, &carried);
    target.to_pixmap()
}

/// The pixels that the pipeline draws of a triangle, row by row.
pub(crate) fn covered(triangle: Triangle, (width, height): (u32, u32), state: State) -> Result<Vec<(i32, i32)>> {
    let mut target = Target::new(width, height)?;
    let state = State { depth: Depth::OFF, blend: Blend::Replace, ..state };
    draw(&mut target, &pipeline(width, height, state), &flat(triangle, 0.5, Color::BLACK, (width, height)), &carried);
    let drawn = |x: u32, y: u32| target.pixel(x, y).is_some_and(|pixel| pixel[3] != 0);
    Ok((0..height)
        .flat_map(|y| (0..width).map(move |x| (x, y)))
        .filter(|(x, y)| drawn(*x, *y))
        .map(|(x, y)| (x as i32, y as i32))
        .collect())
}

/// A material of one colour.
pub(crate) fn matte(color: Color) -> Material {
    Material { color: [color.r, color.g, color.b, 1.0], specular: 0.2, ..Material::default() }
}

/// A scene of meshes with their materials in their places, lit from the upper right.
pub(crate) fn scene(parts: Vec<(Mesh, Material, Mat4)>) -> Scene {
    let mut scene = Scene::new();
    for (mut mesh, material, place) in parts {
        mesh.material = scene.add_material(material);
        scene.add_mesh("part", mesh, place);
    }
    scene.ambient = 0.35;
    scene.lights.push(Light::directional([0.5, 0.9, 0.7]));
    scene
}

/// A square in the xz plane at height `y`.
pub(crate) fn floor(half: f32, y: f32) -> Mesh {
    Mesh::cuboid([-half, y - 0.05, -half], [half, y, half], 0)
}

pub(crate) fn at(x: f32, y: f32, z: f32) -> Mat4 {
    camera::translation([x, y, z])
}

/// Settings of the pictures: one thread, paper behind.
pub(crate) fn settings() -> SceneSettings {
    SceneSettings { threads: 1, background: PAPER, ..SceneSettings::default() }
}

pub(crate) fn view(
    scene: &Scene,
    camera: &Camera,
    (width, height): (u32, u32),
    settings: &SceneSettings,
) -> Result<(Pixmap, SceneStats)> {
    render_picture(scene, camera, width, height, settings)
}

/// Draws a scene as large as a rectangle of the board, with smooth edges.
pub(crate) fn show(
    board: &mut Board,
    rect: Rect,
    scene: &Scene,
    camera: &Camera,
    settings: &SceneSettings,
) -> Result<SceneStats> {
    let smooth = SceneSettings { antialias: SceneAntialias::Samples(Samples::Msaa8), ..*settings };
    let (picture, stats) = view(scene, camera, (rect.width() as u32, rect.height() as u32), &smooth)?;
    board.picture(rect, picture);
    Ok(stats)
}

/// Random numbers for pictures: the same ones always.
pub(crate) struct Random(u64);

impl Random {
    pub(crate) fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1)
    }

    /// A number in `from .. to`.
    pub(crate) fn within(&mut self, from: f32, to: f32) -> f32 {
        // xorshift64*
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        let bits = (self.0.wrapping_mul(0x2545_f491_4f6c_dd1d) >> 40) as f32;
        from + (to - from) * (bits / (1 << 24) as f32)
    }
}
