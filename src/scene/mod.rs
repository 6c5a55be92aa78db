//! Scenes: nodes, meshes, materials, lights, shadows, fog and cameras, drawn by [`crate::space`].
//!
//! ```
//! use rastrum::scene::{Camera, Light, Material, Mesh, Scene, SceneSettings, render_picture};
//!
//! let mut scene = Scene::new();
//! let red = scene.add_material(Material { color: [0.9, 0.2, 0.1, 1.0], ..Material::default() });
//! scene.add_mesh("ball", Mesh::sphere(1.0, 32, 16, red), rastrum::glam::Mat4::IDENTITY);
//! scene.lights.push(Light::directional([1.0, 2.0, 3.0]));
//!
//! let camera = Camera::look_at([0.0, 1.0, 4.0], [0.0; 3], [0.0, 1.0, 0.0]);
//! let (picture, _) = render_picture(&scene, &camera, 64, 64, &SceneSettings::default())?;
//! assert_eq!(picture.pixel(0, 0), Some([0; 4]));
//! assert!(picture.pixel(32, 32).is_some_and(|[r, g, _, a]| r > 2 * g && a == 255));
//! # Ok::<(), rastrum::Error>(())
//! ```

pub mod antialias;
mod bounds;
mod bvh;
mod light;
mod model;
mod render;
mod shadow;
mod surface_shader;

pub use bounds::{Aabb, Frustum};
pub use bvh::{Bvh, BvhNode};
pub use light::shadow_volumes;
pub use model::{
    AlphaMode, Camera, Fog, FogKind, Light, LightKind, Material, Mesh, MeshVertex, Node, Projection, Scene, Shading,
    ShadowSettings,
};
pub use render::{Look, SceneAntialias, SceneSettings, SceneStats, draw_scene, light_depths, render_picture};
