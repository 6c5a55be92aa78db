//! Wavefront OBJ and MTL, through `tobj`.

use std::cell::RefCell;
use std::collections::{HashMap, HashSet};
use std::io::Cursor;
use std::path::Path;
use std::sync::Arc;

use super::budget::Budget;
use super::textures::{Place, Textures};
use super::{Model, referenced};
use crate::error::{Error, Result};
use crate::scene::{AlphaMode, Material, Mesh, MeshVertex, Scene};
use crate::space::{Address, Filter, Sampler, Texture, Topology};

/// How the lines begin that may start another mesh, the bytes that one takes, and those of a material.
const STARTS: [&[u8]; 3] = [b"o", b"g", b"usemtl"];
const MESH: usize = 1024;
const MATERIAL: usize = 640;

pub(super) fn read(bytes: &[u8], folder: Option<&Path>) -> Result<Model> {
    let (budget, warnings) = (RefCell::new(Budget::new(bytes.len())), RefCell::new(Vec::new()));
    let lines = bytes.split(|byte| *byte == b'\n').map(<[u8]>::trim_ascii_start);
    let meshes = lines.filter(|line| STARTS.iter().any(|start| line.starts_with(start)));
    budget.borrow_mut().take_each(meshes.count(), MESH, "its objects")?;
    let read_once = RefCell::new(HashSet::new());
    let options = tobj::LoadOptions { single_index: true, triangulate: true, ..tobj::LoadOptions::default() };
    let materials = |path: &Path| {
        let name = path.to_string_lossy().into_owned();
        if !read_once.borrow_mut().insert(name.clone()) {
            return Ok((Vec::new(), HashMap::new()));
        }
        let bytes = referenced(folder, &name).and_then(|bytes| {
            let mut budget = budget.borrow_mut();
            budget.add_file(bytes.len());
            let count = bytes.windows(6).filter(|window| window == b"newmtl").count();
            budget.take_each(count, MATERIAL, "its materials").map_err(|error| format!("{name}: {error}"))?;
            Ok(bytes)
        });
        match bytes {
            Ok(bytes) => tobj::load_mtl_buf(&mut Cursor::new(bytes)),
            Err(text) => {
                warnings.borrow_mut().push(format!("materials are left out: {text}"));
                Ok((Vec::new(), HashMap::new()))
            }
        }
    };
    let (models, loaded) = tobj::load_obj_buf(&mut Cursor::new(bytes), &options, materials)
        .map_err(|error| Error::Format(format!("not sound OBJ: {error}")))?;
    let (mut budget, mut warnings) = (budget.into_inner(), warnings.into_inner());
    let loaded = loaded.unwrap_or_else(|error| {
        warnings.push(format!("materials are left out: {error}"));
        Vec::new()
    });
    let mut scene = Scene::new();
    let mut textures = Textures::new(folder);
    for material in &loaded {
        let sampler = Sampler::new(Address::Wrap, Filter::Trilinear);
        let texture = material.diffuse_texture.as_ref().and_then(|name| {
            // Options may stand before the name.
            let file = name.split_whitespace().last().unwrap_or(name).replace('\\', "/");
            textures.get("texture", Place::File(file), sampler, &mut budget, &mut warnings)
        });
        scene.add_material(material_of(material, texture));
    }
    let fallback = scene.add_material(Material::default());
    for model in models {
        let own = model.mesh;
        let triple = |values: &[f32], i: usize| values.get(3 * i..)?.first_chunk::<3>().copied();
        let count = own.positions.len() / 3;
        let vertices = (0..count)
            .map(|i| {
                let plain = MeshVertex::default();
                let uv = own.texcoords.get(2 * i..).and_then(|uv| uv.first_chunk::<2>());
                let [r, g, b] = triple(&own.vertex_color, i).unwrap_or([1.0; 3]);
                MeshVertex {
                    position: triple(&own.positions, i).unwrap_or_default(),
                    normal: triple(&own.normals, i).unwrap_or(plain.normal),
                    // v points up in OBJ.
                    uv: uv.map_or(plain.uv, |[u, v]| [*u, 1.0 - *v]),
                    color: [r, g, b, 1.0],
                }
            })
            .collect();
        let material = own.material_id.filter(|id| *id < loaded.len()).unwrap_or(fallback);
        // With triangulation, faces of one or two vertices stay as such: they have no area.
        let indices = own.indices;
        let mut mesh = Mesh { vertices, indices, topology: Topology::Triangles, material };
        if own.normals.is_empty() {
            mesh.smooth_normals();
        }
        scene.add_mesh(&model.name, mesh, glam::Mat4::IDENTITY);
    }
    Ok(Model { scene, warnings })
}

fn material_of(material: &tobj::Material, texture: Option<Arc<Texture>>) -> Material {
    let [r, g, b] = material.diffuse.unwrap_or([0.8; 3]);
    let opacity = material.dissolve.unwrap_or(1.0);
    Material {
        color: [r, g, b, opacity],
        texture,
        specular: material.specular.map_or(0.5, |[r, g, b]| (r + g + b) / 3.0),
        shininess: material.shininess.map_or(32, |exponent| exponent.clamp(1.0, 1024.0) as u32),
        alpha: if opacity < 1.0 { AlphaMode::Blend } else { AlphaMode::Opaque },
        ..Material::default()
    }
}
