//! From a scene and a camera to pixels.

use glam::Mat4;

use super::antialias;
use super::bounds::{Aabb, Frustum};
use super::bvh::Bvh;
use super::light::PreparedLight;
use super::model::{AlphaMode, Camera, Material, Mesh, MeshVertex, Projection, Scene, Shading};
use super::shadow::{self, ShadowMap};
use super::surface_shader::{COLOR, LIGHT, NORMAL, POSITION, SurfaceShader, UV, VARYINGS, Vector};
use crate::color::Color;
use crate::error::{Error, Result};
use crate::num::level::SimdLevel;
use crate::space::{
    Accumulation, Blend, Compare, Counters, Cull, Depth, DepthFormat, Fill, Pipeline, Primitives, Samples, Solid,
    State, Target, Topology, VertexShader, Viewport, camera, vertex_fn,
};
use crate::surface::Pixmap;

/// What is shown of surfaces.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Look {
    /// Their materials in the scene's light: the default.
    #[default]
    Materials,
    /// 0.5 + 0.5·N as RGB, the normal in world space.
    Normals,
    /// The distance along the view axis: white at the near plane, black at the far plane.
    Depth,
    /// The number of the primitive plus 1 over all meshes in the order of drawing, red lowest.
    Ids,
}

/// How edges are smoothed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum SceneAntialias {
    /// Not at all: the default.
    #[default]
    None,
    /// FXAA on the finished picture; see [`antialias::fxaa`].
    Fxaa,
    /// n × n samples a pixel, everything shaded for each; 1 ..= 8.
    Supersample(u32),
    /// Several samples a pixel, shaded once for each triangle.
    Samples(Samples),
    /// The mean of n frames, the camera moved by less than a pixel from one to the next; 1 ..= 4096. See [`antialias::jitter`].
    Temporal(u32),
}

/// How a scene is drawn. The default: materials, no antialiasing, depth buffer, frustum culling, a transparent ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SceneSettings {
    /// What is shown.
    pub look: Look,
    /// Shading instead of the materials' own.
    pub shading: Option<Shading>,
    /// Whether textures are used. Default true.
    pub textures: bool,
    /// Culling instead of the materials' own.
    pub cull: Option<Cull>,
    /// Surfaces, their edges or their corners.
    pub fill: Fill,
    /// The side of points in pixels. Default 1.
    pub point_size: f32,
    /// Edges.
    pub antialias: SceneAntialias,
    /// Painter's algorithm: all triangles from far to near, without a depth test.
    pub painter: bool,
    /// Whether transparent triangles are sorted from far to near. Default true.
    pub sort_transparent: bool,
    /// Whether meshes outside of the view are skipped. Default true.
    pub frustum_culling: bool,
    /// Whether meshes whose box is hidden by what is drawn already are skipped; nearest first then. Default false.
    pub occlusion_culling: bool,
    /// Behind the scene.
    pub background: Color,
    /// The most threads, 0 for one per core.
    pub threads: usize,
    /// The SIMD level.
    pub level: SimdLevel,
}

impl Default for SceneSettings {
    fn default() -> Self {
        Self {
            look: Look::Materials,
            shading: None,
            textures: true,
            cull: None,
            fill: Fill::Solid,
            point_size: 1.0,
            antialias: SceneAntialias::None,
            painter: false,
            sort_transparent: true,
            frustum_culling: true,
            occlusion_culling: false,
            background: Color::TRANSPARENT,
            threads: 0,
            level: SimdLevel::best(),
        }
    }
}

/// What drawing a scene did.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SceneStats {
    /// Meshes in nodes that are reached.
    pub meshes: u64,
    /// Those outside of the view.
    pub frustum_culled: u64,
    /// Boxes tested against the view.
    pub frustum_tests: u64,
    /// Those hidden behind others.
    pub occlusion_culled: u64,
    /// The pipeline's counts, shadow maps left out.
    pub counters: Counters,
}

/// One mesh in its place.
pub(super) struct Item<'a> {
    pub(super) mesh: &'a Mesh,
    pub(super) world: Mat4,
    normals: [[f32; 3]; 3],
    pub(super) bounds: Aabb,
    /// The number of its first primitive over the scene.
    first_primitive: u32,
    /// Distance of the box's middle along the view axis.
    distance: f32,
}

/// Draws a scene as a picture of `width` × `height` pixels.
///
/// # Errors
/// As [`Target::with_format`], for the picture and the samples that antialiasing asks for; [`Error::Parameter`] for a camera whose
/// numbers make no projection.
pub fn render_picture(
    scene: &Scene,
    camera: &Camera,
    width: u32,
    height: u32,
    settings: &SceneSettings,
) -> Result<(Pixmap, SceneStats)> {
    let samples = match settings.antialias {
        SceneAntialias::Samples(samples) => samples,
        _ => Samples::One,
    };
    match settings.antialias {
        SceneAntialias::Supersample(n) => {
            let n = n.clamp(1, 8);
            let (picture, stats) = frame(scene, camera, width * n, height * n, samples, (0.0, 0.0), settings)?;
            Ok((antialias::box_average(&picture, n)?, stats))
        }
        SceneAntialias::Temporal(n) => {
            let mut sum = Accumulation::new(width, height)?;
            let mut stats = SceneStats::default();
            for index in 0..n.clamp(1, 4096) {
                let (picture, one) = frame(scene, camera, width, height, samples, antialias::jitter(index), settings)?;
                sum.add(&picture, 1)?;
                stats = one;
            }
            Ok((sum.average()?, stats))
        }
        _ => {
            let (picture, stats) = frame(scene, camera, width, height, samples, (0.0, 0.0), settings)?;
            let fxaa = settings.antialias == SceneAntialias::Fxaa;
            Ok((if fxaa { antialias::fxaa(&picture)? } else { picture }, stats))
        }
    }
}

/// One frame on a target of its own.
fn frame(
    scene: &Scene,
    camera: &Camera,
    width: u32,
    height: u32,
    samples: Samples,
    offset: (f32, f32),
    settings: &SceneSettings,
) -> Result<(Pixmap, SceneStats)> {
    let mut target = Target::with_format(width, height, DepthFormat::D32F, samples)?;
    target.clear_color(settings.background);
    let viewport = Viewport { x: offset.0, y: offset.1, ..Viewport::new(width, height) };
    let stats = draw_scene(scene, camera, &mut target, &viewport, settings)?;
    Ok((target.to_pixmap()?, stats))
}

/// Draws a scene onto a target that was cleared, depth to 1; antialiasing beyond the target's samples, and the background, are the
/// caller's.
///
/// # Errors
/// [`Error::Parameter`] for a camera whose numbers make no projection; [`Error::Limit`] where memory for a shadow map is not to be had.
pub fn draw_scene(
    scene: &Scene,
    camera: &Camera,
    target: &mut Target,
    viewport: &Viewport,
    settings: &SceneSettings,
) -> Result<SceneStats> {
    let projection = camera.projection_matrix(viewport.width / viewport.height);
    let to_clip = camera::product(&projection, &camera.view);
    if !to_clip.to_cols_array().iter().all(|v| v.is_finite()) {
        return Err(Error::Parameter(
            "the camera makes no projection: near, far, field of view and place must be finite, and near not far"
                .to_owned(),
        ));
    }
    let mut stats = SceneStats::default();
    let mut items = collect(scene, camera);
    stats.meshes = items.len() as u64;
    let lights = prepare_lights(scene, &items, settings)?;
    if settings.frustum_culling {
        let frustum = Frustum::new(&to_clip);
        let boxes: Vec<Aabb> = items.iter().map(|item| item.bounds).collect();
        let (visible, tests) = Bvh::new(&boxes).query(&frustum);
        stats.frustum_tests = tests as u64;
        stats.frustum_culled = (items.len() - visible.len()) as u64;
        let mut number = 0;
        items.retain(|_| {
            number += 1;
            visible.binary_search(&(number - 1)).is_ok()
        });
    }
    if settings.occlusion_culling {
        items.sort_by(|a, b| a.distance.total_cmp(&b.distance).then(a.first_primitive.cmp(&b.first_primitive)));
    }
    let fallback = Material::default();
    let material_of = |item: &Item<'_>| scene.materials.get(item.mesh.material).unwrap_or(&fallback);
    let forward = Forward { scene, camera, to_clip, viewport, lights: &lights, settings };
    let blends = |item: &Item<'_>| material_of(item).alpha == AlphaMode::Blend && settings.look == Look::Materials;
    if settings.painter {
        let all: Vec<&Item<'_>> = items.iter().collect();
        forward.sorted(&all, &material_of, Depth::OFF, target, &mut stats);
        return Ok(stats);
    }
    for item in items.iter().filter(|item| !blends(item)) {
        if settings.occlusion_culling && forward.is_hidden(item, target) {
            stats.occlusion_culled += 1;
            continue;
        }
        let primitives = Primitives {
            vertices: &item.mesh.vertices,
            indices: Some(&item.mesh.indices),
            topology: item.mesh.topology,
        };
        stats.counters += forward.draw(item, material_of(item), &primitives, 0, Depth::default(), target);
    }
    let transparent: Vec<&Item<'_>> = items.iter().filter(|item| blends(item)).collect();
    let depth = Depth { write: false, ..Depth::compare(Compare::LessEqual) };
    forward.sorted(&transparent, &material_of, depth, target, &mut stats);
    Ok(stats)
}

/// The meshes of a scene in their places, in drawing order.
fn collect<'a>(scene: &'a Scene, camera: &Camera) -> Vec<Item<'a>> {
    let mut items = Vec::new();
    let mut first_primitive = 0_u32;
    for (number, mut world) in scene.world_transforms() {
        let Some(node) = scene.nodes.get(number) else { continue };
        if node.billboard {
            world = facing(&world, &camera.view);
        }
        for mesh in node.meshes.iter().filter_map(|mesh| scene.meshes.get(*mesh)) {
            let bounds = mesh.bounds().transformed(&world);
            let [x, y, z] = bounds.center();
            let view = camera::transform(&camera.view, [x, y, z, 1.0]);
            let normals = camera::normal_matrix(&world);
            items.push(Item { mesh, world, normals, bounds, first_primitive, distance: -view[2] });
            let primitives =
                Primitives { vertices: &mesh.vertices, indices: Some(&mesh.indices), topology: mesh.topology };
            first_primitive = first_primitive.wrapping_add(primitives.count() as u32);
        }
    }
    items
}

/// A billboard's transform: its place and scale, the camera's axes.
fn facing(world: &Mat4, view: &Mat4) -> Mat4 {
    let (m, v) = (world.to_cols_array_2d(), view.to_cols_array_2d());
    let length = |c: [f32; 4]| (c[0] * c[0] + c[1] * c[1] + c[2] * c[2]).sqrt();
    // The rows of the view matrix are the camera's axes in world space.
    let axis = |i: usize| {
        let scale = length(m[i]);
        [v[0][i] * scale, v[1][i] * scale, v[2][i] * scale, 0.0]
    };
    Mat4::from_cols_array_2d(&[axis(0), axis(1), axis(2), m[3]])
}

/// Lights with their shadow maps.
fn prepare_lights(scene: &Scene, items: &[Item<'_>], settings: &SceneSettings) -> Result<Vec<PreparedLight>> {
    let bounds = items.iter().fold(Aabb::EMPTY, |bounds, item| bounds.union(&item.bounds));
    let mut lights = Vec::new();
    for light in &scene.lights {
        let mut prepared = PreparedLight::new(light);
        if light.shadows && settings.look == Look::Materials {
            prepared.shadow = ShadowMap::new(&scene.shadows, light, items, &bounds, settings)?;
        }
        lights.push(prepared);
    }
    Ok(lights)
}

/// The depth image of a scene's light, as [`draw_scene`] makes it: (side, depths 0 ..= 1 with rows top down, the matrix from world space to the
/// light's clip space). `None` for no such light, for one without a scene, and for a point light, whose map has six faces.
///
/// # Errors
/// [`Error::Limit`] where memory is not to be had.
pub fn light_depths(scene: &Scene, camera: &Camera, light: usize) -> Result<Option<(u32, Vec<f32>, Mat4)>> {
    let Some(light) = scene.lights.get(light) else { return Ok(None) };
    let items = collect(scene, camera);
    let bounds = items.iter().fold(Aabb::EMPTY, |bounds, item| bounds.union(&item.bounds));
    let Some(to_light) = shadow::flat_view(light, &bounds) else { return Ok(None) };
    let map = ShadowMap::flat(&scene.shadows, to_light, &items, &SceneSettings::default())?;
    Ok(Some((map.side, map.depths, to_light)))
}

/// What the meshes of one frame share.
struct Forward<'a> {
    scene: &'a Scene,
    camera: &'a Camera,
    to_clip: Mat4,
    viewport: &'a Viewport,
    lights: &'a [PreparedLight],
    settings: &'a SceneSettings,
}

/// The vertex shader of scenes.
struct SceneVertices<'a> {
    item: &'a Item<'a>,
    to_clip: Mat4,
    /// For lighting at the vertices.
    gouraud: Option<&'a SurfaceShader<'a>>,
}

impl VertexShader for SceneVertices<'_> {
    type Vertex = MeshVertex;

    fn varyings(&self) -> usize {
        VARYINGS
    }

    #[inline]
    fn shade(&self, vertex: &MeshVertex, out: &mut [f32]) -> [f32; 4] {
        let [x, y, z] = vertex.position;
        let [wx, wy, wz, _] = camera::transform(&self.item.world, [x, y, z, 1.0]);
        let n = vertex.normal;
        let m = &self.item.normals;
        let normal: [f32; 3] = std::array::from_fn(|i| m[0][i] * n[0] + m[1][i] * n[1] + m[2][i] * n[2]);
        // Of length 1, so that normals of scaled nodes weigh alike between vertices.
        let length = (normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]).sqrt();
        let normal = if length > 0.0 && length.is_finite() { normal.map(|v| v / length) } else { [0.0; 3] };
        if let Some(out) = out.first_chunk_mut::<VARYINGS>() {
            out[POSITION..POSITION + 3].copy_from_slice(&[wx, wy, wz]);
            out[NORMAL..NORMAL + 3].copy_from_slice(&normal);
            out[UV..UV + 2].copy_from_slice(&vertex.uv);
            out[COLOR..COLOR + 4].copy_from_slice(&vertex.color);
            if let Some(shader) = self.gouraud {
                out[LIGHT..LIGHT + 4].copy_from_slice(&light_vertex(shader, [wx, wy, wz], normal));
            }
        }
        camera::transform(&self.to_clip, [wx, wy, wz, 1.0])
    }
}

/// Phong's light at one vertex: three factors of the colour, and the highlight.
fn light_vertex(shader: &SurfaceShader<'_>, position: [f32; 3], normal: [f32; 3]) -> [f32; 4] {
    use fearless_simd::prelude::*;
    // The scalar level: the same numbers as any other.
    let simd = fearless_simd::Fallback::new();
    let vector = |v: [f32; 3]| -> Vector<_> { v.map(|v| fearless_simd::f32x8::splat(simd, v)) };
    let (diffuse, highlight) = shader.phong(simd, &vector(position), &vector(normal), 1);
    let light = diffuse.map(|v| v.to_array()[0] * (1.0 - shader.ambient) + shader.ambient);
    let shine = highlight.map(|v| v.to_array()[0]);
    [light[0], light[1], light[2], (shine[0] + shine[1] + shine[2]) / 3.0]
}

impl Forward<'_> {
    fn state(&self, material: &Material, depth: Depth) -> State {
        let cull = if material.double_sided { Cull::None } else { Cull::Back };
        let blend = if material.alpha == AlphaMode::Blend && self.settings.look == Look::Materials {
            Blend::SourceOver
        } else {
            Blend::Replace
        };
        State {
            cull: self.settings.cull.unwrap_or(cull),
            depth,
            blend,
            fill: self.settings.fill,
            point_size: self.settings.point_size,
            ..State::default()
        }
    }

    fn pipeline(&self, state: State) -> Pipeline {
        Pipeline { state, viewport: *self.viewport, threads: self.settings.threads, level: self.settings.level }
    }

    /// Draws primitives of one mesh, the first of which has number `first` in it.
    fn draw(
        &self,
        item: &Item<'_>,
        material: &Material,
        primitives: &Primitives<'_, MeshVertex>,
        first: u32,
        depth: Depth,
        target: &mut Target,
    ) -> Counters {
        let surfaces =
            matches!(primitives.topology, Topology::Triangles | Topology::TriangleStrip | Topology::TriangleFan);
        let shading = match self.settings.shading.unwrap_or(material.shading) {
            // Lines and points have no side.
            Shading::Flat if !surfaces || self.settings.fill != Fill::Solid => Shading::Phong,
            shading => shading,
        };
        let (view, depth_range) = (&self.camera.view.to_cols_array_2d(), (self.camera.near, self.camera.far));
        let shader = SurfaceShader {
            look: self.settings.look,
            material,
            shading,
            lights: self.lights,
            ambient: self.scene.ambient.clamp(0.0, 1.0),
            fog: self.scene.fog,
            eye: self.camera.eye(),
            view: match self.camera.projection {
                Projection::Perspective(_) => None,
                // The third row of the view matrix points to the viewer.
                Projection::Orthographic(_) => Some([view[0][2], view[1][2], view[2][2]]),
            },
            first_primitive: item.first_primitive.wrapping_add(first),
            use_texture: self.settings.textures,
            depth_range,
        };
        let gouraud = (shading == Shading::Gouraud).then_some(&shader);
        let vertices = SceneVertices { item, to_clip: self.to_clip, gouraud };
        self.pipeline(self.state(material, depth)).draw(target, primitives, &vertices, &shader)
    }

    /// Whether what is drawn hides a mesh's box: no sample of its sides would pass the depth test. A box that comes near the eye is
    /// not hidden.
    fn is_hidden(&self, item: &Item<'_>, target: &mut Target) -> bool {
        if item.bounds.is_empty() {
            return true;
        }
        let grow: [f32; 3] = std::array::from_fn(|i| (item.bounds.max[i] - item.bounds.min[i]) * 0.01 + 1e-4);
        let bounds = Aabb {
            min: std::array::from_fn(|i| item.bounds.min[i] - grow[i]),
            max: std::array::from_fn(|i| item.bounds.max[i] + grow[i]),
        };
        let cube = Mesh::cuboid(bounds.min, bounds.max, 0);
        let m = self.to_clip;
        let clip = |v: &MeshVertex| camera::transform(&m, [v.position[0], v.position[1], v.position[2], 1.0]);
        if cube.vertices.iter().map(clip).any(|[_, _, z, w]| !(z > -w)) {
            return false;
        }
        let vertex = vertex_fn(0, |v: &MeshVertex, _: &mut [f32]| clip(v));
        let depth = Depth { write: false, ..Depth::compare(Compare::LessEqual) };
        let state = State { depth, color_mask: [false; 4], ..State::default() };
        let primitives = Primitives::indexed(&cube.vertices, &cube.indices);
        self.pipeline(state).draw(target, &primitives, &vertex, &Solid(Color::BLACK)).samples_passed == 0
    }

    /// Draws the triangles of some meshes from far to near, by the middle of their corners.
    fn sorted<'i>(
        &self,
        items: &[&'i Item<'i>],
        material_of: &dyn Fn(&Item<'_>) -> &'i Material,
        depth: Depth,
        target: &mut Target,
        stats: &mut SceneStats,
    ) where
        Self: 'i,
    {
        let mut order: Vec<(f32, usize, u32, [u32; 3])> = Vec::new();
        for (i, item) in items.iter().enumerate() {
            let m = camera::product(&self.camera.view, &item.world);
            for (number, corners) in item.mesh.triangles().into_iter().enumerate() {
                let depth = corners
                    .iter()
                    .filter_map(|c| item.mesh.vertices.get(*c as usize))
                    .map(|v| camera::transform(&m, [v.position[0], v.position[1], v.position[2], 1.0])[2])
                    .sum::<f32>();
                order.push((depth, i, number as u32, corners));
            }
        }
        if self.settings.sort_transparent || self.settings.painter {
            // View z is negative: the farthest is the smallest. The sort keeps the order of equals.
            order.sort_by(|a, b| a.0.total_cmp(&b.0));
        }
        let mut rest = &order[..];
        while let Some((_, i, first, _)) = rest.first() {
            let ids = self.settings.look == Look::Ids;
            let run = if ids { 1 } else { rest.iter().take_while(|other| other.1 == *i).count() };
            let (now, later) = rest.split_at(run);
            let indices: Vec<u32> = now.iter().flat_map(|(_, _, _, corners)| *corners).collect();
            if let Some(item) = items.get(*i) {
                let primitives = Primitives::indexed(&item.mesh.vertices, &indices);
                stats.counters += self.draw(item, material_of(item), &primitives, *first, depth, target);
            }
            rest = later;
        }
    }
}
