//! What a scene is made of: nodes, meshes, materials, lights, fog, cameras.

use std::sync::Arc;

use glam::Mat4;

use super::bounds::Aabb;
use crate::geom::{Point, Rect};
use crate::space::{Texture, Topology, camera};

/// A vertex of a mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeshVertex {
    /// Position in the node's space.
    pub position: [f32; 3],
    /// The normal; any length but 0, normalised for each pixel.
    pub normal: [f32; 3],
    /// Texture coordinates, v growing downwards in the picture.
    pub uv: [f32; 2],
    /// Straight RGBA, 0 ..= 1; multiplies the material's colour.
    pub color: [f32; 4],
}

impl Default for MeshVertex {
    fn default() -> Self {
        Self { position: [0.0; 3], normal: [0.0, 0.0, 1.0], uv: [0.0; 2], color: [1.0; 4] }
    }
}

/// A mesh of one material.
#[derive(Clone, Debug, Default)]
pub struct Mesh {
    /// The vertices.
    pub vertices: Vec<MeshVertex>,
    /// Indices into them; primitives with one beyond are not drawn.
    pub indices: Vec<u32>,
    /// How indices make primitives.
    pub topology: Topology,
    /// The number of its material in [`Scene::materials`]; beyond them, the default material.
    pub material: usize,
}

impl Mesh {
    /// The box of the vertices.
    pub fn bounds(&self) -> Aabb {
        Aabb::of_points(self.vertices.iter().map(|v| v.position))
    }

    /// The corners of each triangle, as vertex numbers; triangles that name vertices that are not there are left out.
    pub fn triangles(&self) -> Vec<[u32; 3]> {
        self.numbered_triangles().flatten().collect()
    }

    /// The triangles by their numbers, `None` for one that names a vertex that is not there.
    fn numbered_triangles(&self) -> impl Iterator<Item = Option<[u32; 3]>> {
        let primitives = crate::space::Primitives {
            vertices: &self.vertices,
            indices: Some(&self.indices),
            topology: self.topology,
        };
        let count = match self.topology {
            Topology::Triangles | Topology::TriangleStrip | Topology::TriangleFan => primitives.count(),
            _ => 0,
        };
        (0..count).map(move |number| primitives.corners(number))
    }

    /// Gives each vertex the mean of the normals of its triangles, weighted by their areas.
    pub fn smooth_normals(&mut self) {
        let mut sums = vec![[0.0_f64; 3]; self.vertices.len()];
        for triangle in self.triangles() {
            let normal = self.face_normal(triangle);
            for corner in triangle {
                if let Some(sum) = sums.get_mut(corner as usize) {
                    for i in 0..3 {
                        sum[i] += normal[i];
                    }
                }
            }
        }
        for (vertex, sum) in self.vertices.iter_mut().zip(sums) {
            vertex.normal = unit(sum).unwrap_or([0.0, 0.0, 1.0]);
        }
    }

    /// Gives each triangle vertices of its own, with its normal.
    pub fn flat_normals(&mut self) {
        let mut vertices = Vec::with_capacity(self.indices.len());
        for triangle in self.numbered_triangles() {
            // One that names a vertex that is not there keeps its number, and has no area.
            let Some(triangle) = triangle else {
                vertices.extend([MeshVertex::default(); 3]);
                continue;
            };
            let normal = unit(self.face_normal(triangle)).unwrap_or([0.0, 0.0, 1.0]);
            let corners = triangle.map(|i| self.vertices.get(i as usize).copied().unwrap_or_default());
            vertices.extend(corners.map(|vertex| MeshVertex { normal, ..vertex }));
        }
        self.indices = (0..vertices.len() as u32).collect();
        self.vertices = vertices;
        self.topology = Topology::Triangles;
    }

    /// The normal of a triangle, as long as twice its area.
    fn face_normal(&self, triangle: [u32; 3]) -> [f64; 3] {
        let [a, b, c] = triangle.map(|i| self.vertices.get(i as usize).map_or([0.0; 3], |v| v.position.map(f64::from)));
        let (u, v): ([f64; 3], [f64; 3]) = (std::array::from_fn(|i| b[i] - a[i]), std::array::from_fn(|i| c[i] - a[i]));
        [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
    }

    /// A box, each side with its normal and u and v from 0 to 1; counter-clockwise from outside.
    pub fn cuboid(min: [f32; 3], max: [f32; 3], material: usize) -> Self {
        let mut mesh = Self { material, ..Self::default() };
        for axis in 0..3 {
            for (side, at) in [(1.0, max[axis]), (-1.0, min[axis])] {
                let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
                let first = mesh.vertices.len() as u32;
                for (u, v) in [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)] {
                    let mut position = [0.0; 3];
                    position[axis] = at;
                    position[i] = min[i] + (max[i] - min[i]) * u;
                    position[j] = min[j] + (max[j] - min[j]) * v;
                    let mut normal = [0.0; 3];
                    normal[axis] = side;
                    mesh.vertices.push(MeshVertex { position, normal, uv: [u, 1.0 - v], ..MeshVertex::default() });
                }
                let quad = if side > 0.0 { [0, 1, 2, 0, 2, 3] } else { [0, 2, 1, 0, 3, 2] };
                mesh.indices.extend(quad.map(|k| first + k));
            }
        }
        mesh
    }

    /// A ball around the origin, of `columns` × `rows` pieces, 3 × 2 at the least; counter-clockwise from outside.
    pub fn sphere(radius: f32, columns: u32, rows: u32, material: usize) -> Self {
        let (columns, rows) = (columns.clamp(3, 4096), rows.clamp(2, 4096));
        let mut mesh = Self { material, ..Self::default() };
        for j in 0..=rows {
            for i in 0..=columns {
                let (u, v) = (f64::from(i) / f64::from(columns), f64::from(j) / f64::from(rows));
                let (sa, ca) = crate::num::trig::sin_cos(u * std::f64::consts::TAU);
                let (sb, cb) = crate::num::trig::sin_cos(v * std::f64::consts::PI);
                let normal = [sb * ca, cb, -sb * sa].map(|v| v as f32);
                let uv = [u as f32, v as f32];
                mesh.vertices.push(MeshVertex { position: normal.map(|v| v * radius), normal, uv, color: [1.0; 4] });
            }
        }
        for j in 0..rows {
            for i in 0..columns {
                let a = j * (columns + 1) + i;
                let (b, c, d) = (a + 1, a + columns + 2, a + columns + 1);
                mesh.indices.extend([a, d, c, a, c, b]);
            }
        }
        mesh
    }
}

/// A vector of length 1 in the direction of another; `None` for one without a direction.
pub(crate) fn unit(v: [f64; 3]) -> Option<[f32; 3]> {
    let length = (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt();
    (length > 0.0 && length.is_finite()).then(|| v.map(|v| (v / length) as f32))
}

/// How a surface answers to light. Colours are as they are stored: there is no gamma.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Shading {
    /// Not at all: its colour.
    Unlit,
    /// As Phong, by the triangle's own normal turned to the viewer.
    Flat,
    /// Phong at the vertices, linear between.
    Gouraud,
    /// Per pixel: rgb·(ambient + (1 − ambient)·Σ max(N·L, 0)) + specular·Σ max(N·H, 0)^shininess, the last where N·L > 0: the
    /// default.
    #[default]
    Phong,
    /// Per pixel, metallic-roughness as glTF 2.0 defines it (appendix B): GGX distribution, Smith's visibility, Schlick's Fresnel
    /// term; a light of intensity 1 lights a white diffuse surface that faces it to 1.
    Pbr,
}

/// What alpha means.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum AlphaMode {
    /// Nothing: the default.
    #[default]
    Opaque,
    /// Pixels below the value are not drawn, the others are opaque.
    Mask(f32),
    /// Pixels are blended, the farthest triangles first.
    Blend,
}

/// The look of a mesh.
#[derive(Clone, Debug)]
pub struct Material {
    /// How it is lit.
    pub shading: Shading,
    /// Straight RGBA, 0 ..= 1.
    pub color: [f32; 4],
    /// Multiplies the colour, by the vertices' u and v.
    pub texture: Option<Arc<Texture>>,
    /// Strength of Phong's highlight. Default 0.5.
    pub specular: f32,
    /// Exponent of Phong's highlight, 1 ..= 1024. Default 32.
    pub shininess: u32,
    /// For PBR: 0 (dielectric) ..= 1 (metal). Default 0.
    pub metallic: f32,
    /// For PBR: 0 (mirror) ..= 1. Default 0.6.
    pub roughness: f32,
    /// What alpha means.
    pub alpha: AlphaMode,
    /// Whether backs are drawn. Default true.
    pub double_sided: bool,
}

impl Default for Material {
    fn default() -> Self {
        Self {
            shading: Shading::Phong,
            color: [0.8, 0.8, 0.8, 1.0],
            texture: None,
            specular: 0.5,
            shininess: 32,
            metallic: 0.0,
            roughness: 0.6,
            alpha: AlphaMode::Opaque,
            double_sided: true,
        }
    }
}

/// Where light comes from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LightKind {
    /// From infinitely far: the direction towards the light, in world space.
    Directional([f32; 3]),
    /// From a place in world space, fading as 1 / (1 + (distance / range)²).
    Point {
        /// The place.
        position: [f32; 3],
        /// The distance at which half is left.
        range: f32,
    },
    /// From a place, within a cone.
    Spot {
        /// The place.
        position: [f32; 3],
        /// Where it shines.
        direction: [f32; 3],
        /// The distance at which half is left.
        range: f32,
        /// The cone's half angle in radians, below π / 2: full light up to three quarters of it, then falling to 0.
        angle: f32,
    },
}

/// A light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Light {
    /// Where it comes from.
    pub kind: LightKind,
    /// RGB times intensity; 1, 1, 1 is white.
    pub color: [f32; 3],
    /// Whether it casts shadows, by a shadow map: one picture for directional and spot lights, the six faces of a cube for point lights.
    pub shadows: bool,
}

impl Light {
    /// White light from a direction (towards the light), without shadows.
    pub fn directional(towards: [f32; 3]) -> Self {
        Self { kind: LightKind::Directional(towards), color: [1.0; 3], shadows: false }
    }
}

/// How shadow maps are made and read.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShadowSettings {
    /// Columns and rows of the map, 16 ..= 8192; of each face of a point light's, 16 ..= 4096. Default 1024.
    pub resolution: u32,
    /// Depth added when the map is drawn, in multiples of the slope per texel, once more for each step of `radius`; see
    /// [`Depth::bias_slope`](crate::space::Depth::bias_slope). Default 1.5.
    pub bias_slope: f32,
    /// Depth (of the light's 0 ..= 1; for point lights, of the distance to the scene's farthest side) that a surface may lie behind the
    /// map's. Default 0.001.
    pub bias: f32,
    /// Percentage-closer filtering: (2·radius + 1)² texels are compared and averaged, 0 ..= 8. Default 1. Faces of a point light's map
    /// reach as far over their sides, so that filtering sees no seams.
    pub radius: u32,
}

impl Default for ShadowSettings {
    fn default() -> Self {
        Self { resolution: 1024, bias_slope: 1.5, bias: 0.001, radius: 1 }
    }
}

/// How colours fade into the distance w along the view axis: color·f + fog·(1 − f), f clamped to 0 ..= 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FogKind {
    /// f = (end − w) / (end − start)
    Linear {
        /// Where fog begins.
        start: f32,
        /// Where nothing else is left.
        end: f32,
    },
    /// f = e^(−density·w)
    Exponential(f32),
    /// f = e^(−(density·w)²)
    ExponentialSquared(f32),
}

/// Fog.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fog {
    /// Its law.
    pub kind: FogKind,
    /// Its colour, RGB 0 ..= 1.
    pub color: [f32; 3],
}

/// A node of the scene graph.
#[derive(Clone, Debug)]
pub struct Node {
    /// A name, for people.
    pub name: String,
    /// From the node's space to its parent's.
    pub transform: Mat4,
    /// The meshes drawn here, as numbers in [`Scene::meshes`].
    pub meshes: Vec<usize>,
    /// The nodes within, as numbers in [`Scene::nodes`]. A node that is reached a second time, also by a cycle, is left out.
    pub children: Vec<usize>,
    /// Whether the node turns its x, y and z axes along the camera's: a sprite. Its place and scale stay.
    pub billboard: bool,
}

impl Default for Node {
    fn default() -> Self {
        Self {
            name: String::new(),
            transform: Mat4::IDENTITY,
            meshes: Vec::new(),
            children: Vec::new(),
            billboard: false,
        }
    }
}

/// How a camera projects.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Projection {
    /// Perspective, by its vertical field of view in radians.
    Perspective(f32),
    /// Parallel, by the height of the view in world units.
    Orthographic(f32),
}

/// A camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// From world space to view space (looking along −z).
    pub view: Mat4,
    /// The projection.
    pub projection: Projection,
    /// Distance of the near plane, above 0 for perspective.
    pub near: f32,
    /// Distance of the far plane.
    pub far: f32,
}

impl Camera {
    /// A perspective camera at `eye` that looks at `at`: 60° high, near 0.1, far 1000.
    pub fn look_at(eye: [f32; 3], at: [f32; 3], up: [f32; 3]) -> Self {
        Self {
            view: camera::look_at(eye, at, up),
            projection: Projection::Perspective(std::f32::consts::FRAC_PI_3),
            near: 0.1,
            far: 1000.0,
        }
    }

    /// The projection matrix for a picture of the given width / height.
    pub fn projection_matrix(&self, aspect: f32) -> Mat4 {
        match self.projection {
            Projection::Perspective(fov) => camera::perspective(fov, aspect, self.near, self.far),
            Projection::Orthographic(height) => {
                let (x, y) = (height * aspect * 0.5, height * 0.5);
                camera::orthographic(-x, x, -y, y, self.near, self.far)
            }
        }
    }

    /// The camera's place in world space; the origin if the view matrix has no inverse.
    pub fn eye(&self) -> [f32; 3] {
        let inverse = camera::inverse(&self.view).unwrap_or(Mat4::IDENTITY);
        let [x, y, z, _] = inverse.to_cols_array_2d()[3];
        [x, y, z]
    }

    /// Where a point in world space lands in `rect` of a canvas, and its depth 0 ..= 1 between near and far plane: for labels. `None`
    /// for one behind the camera, or not a number.
    pub fn project(&self, point: [f32; 3], rect: Rect) -> Option<(Point, f32)> {
        let [x, y, z] = point;
        let (width, height) = (rect.right - rect.left, rect.bottom - rect.top);
        let m = camera::product(&self.projection_matrix(width / height), &self.view);
        let clip = camera::transform(&m, [x, y, z, 1.0]);
        if !(clip[3] > 0.0) {
            return None;
        }
        let ndc = [0, 1, 2].map(|i| clip[i] / clip[3]);
        let place = Point::new(rect.left + (ndc[0] + 1.0) * 0.5 * width, rect.top + (1.0 - ndc[1]) * 0.5 * height);
        (place.is_finite() && ndc[2].is_finite()).then_some((place, (ndc[2] + 1.0) * 0.5))
    }
}

/// A scene: nodes and everything that they refer to by number.
#[derive(Clone, Debug, Default)]
pub struct Scene {
    /// All nodes.
    pub nodes: Vec<Node>,
    /// The nodes that stand in no other, in drawing order.
    pub roots: Vec<usize>,
    /// Meshes.
    pub meshes: Vec<Mesh>,
    /// Materials.
    pub materials: Vec<Material>,
    /// Lights.
    pub lights: Vec<Light>,
    /// The share of light that comes from everywhere, 0 ..= 1.
    pub ambient: f32,
    /// Fog, if any.
    pub fog: Option<Fog>,
    /// How shadow maps are made.
    pub shadows: ShadowSettings,
    /// The scene's own cameras, with the names they came with.
    pub cameras: Vec<(String, Camera)>,
}

impl Scene {
    /// An empty scene with an ambient share of 0.1.
    pub fn new() -> Self {
        Self { ambient: 0.1, ..Self::default() }
    }

    /// Adds a material; gives its number.
    pub fn add_material(&mut self, material: Material) -> usize {
        self.materials.push(material);
        self.materials.len() - 1
    }

    /// Adds a mesh in a node of its own at the root; gives the node's number.
    pub fn add_mesh(&mut self, name: &str, mesh: Mesh, transform: Mat4) -> usize {
        self.meshes.push(mesh);
        let meshes = vec![self.meshes.len() - 1];
        self.nodes.push(Node { name: name.to_owned(), transform, meshes, ..Node::default() });
        self.roots.push(self.nodes.len() - 1);
        self.nodes.len() - 1
    }

    /// Every node that is reached from the roots, in depth-first order, with its transform to world space: the product of all transforms
    /// from the root down.
    pub fn world_transforms(&self) -> Vec<(usize, Mat4)> {
        let mut out = Vec::new();
        let mut seen = vec![false; self.nodes.len()];
        let mut stack: Vec<(usize, Mat4)> = self.roots.iter().rev().map(|root| (*root, Mat4::IDENTITY)).collect();
        while let Some((number, parent)) = stack.pop() {
            let (Some(node), Some(seen)) = (self.nodes.get(number), seen.get_mut(number)) else { continue };
            if std::mem::replace(seen, true) {
                continue;
            }
            let world = camera::product(&parent, &node.transform);
            out.push((number, world));
            stack.extend(node.children.iter().rev().map(|child| (*child, world)));
        }
        out
    }

    /// The box of all meshes in world space.
    pub fn bounds(&self) -> Aabb {
        let mut bounds = Aabb::EMPTY;
        for (number, world) in self.world_transforms() {
            let Some(node) = self.nodes.get(number) else { continue };
            for mesh in node.meshes.iter().filter_map(|mesh| self.meshes.get(*mesh)) {
                let points = mesh.vertices.iter().map(|v| {
                    let [x, y, z] = v.position;
                    let [x, y, z, _] = camera::transform(&world, [x, y, z, 1.0]);
                    [x, y, z]
                });
                bounds = bounds.union(&Aabb::of_points(points));
            }
        }
        bounds
    }
}
