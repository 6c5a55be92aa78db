//! glTF 2.0 and GLB, through the `gltf` crate; accessors are read here.

use std::collections::{HashMap, HashSet};
use std::path::Path;
use std::sync::Arc;

use gltf::mesh::{Mode, Semantic};
use gltf::texture::WrappingMode;

use super::accessor::Values;
use super::budget::Budget;
use super::textures::{Place, Textures};
use super::{Model, base64, referenced};
use crate::error::{Error, Result};
use crate::scene::{AlphaMode, Camera, Material, Mesh, MeshVertex, Node, Projection, Scene, Shading};
use crate::space::{Address, Filter, Sampler, Texture, Topology, camera};

/// Bytes that an object of the JSON takes at most, as the crate keeps it and in the scene: a node.
const OBJECT: usize = 400;

pub(super) fn read(bytes: &[u8], folder: Option<&Path>) -> Result<Model> {
    let mut budget = Budget::new(bytes.len());
    let objects = bytes.iter().filter(|byte| **byte == b'{').count();
    budget.take_each(objects, OBJECT, "the objects of its JSON")?;
    let unsound = |error: gltf::Error| Error::Format(format!("not sound glTF: {error}"));
    // The crate's validation looks up the accessors of positions before it has looked whether they are there.
    let unchecked = gltf::Gltf::from_slice_without_validation(bytes).map_err(unsound)?;
    let json = unchecked.document.as_json();
    let accessors = json.accessors.len();
    let mut used = json.meshes.iter().flat_map(|mesh| &mesh.primitives).flat_map(|part| part.attributes.values());
    if let Some(missing) = used.find(|index| index.value() >= accessors) {
        return Err(Error::Format(format!("not sound glTF: there is no accessor {}", missing.value())));
    }
    drop(unchecked);
    let mut file = gltf::Gltf::from_slice(bytes).map_err(unsound)?;
    let mut warnings = Vec::new();
    let buffers = buffers(&mut file, folder, &mut budget)?;
    let mut scene = Scene::new();
    let fallback = file.materials().len();
    // The meshes of each glTF mesh, one for each of its primitives.
    let mut parts = Vec::new();
    for mesh in file.meshes() {
        let mut numbers = Vec::new();
        for primitive in mesh.primitives() {
            if let Some(mut part) = mesh_of(&primitive, &buffers, &mut budget, &mut warnings)? {
                part.material = primitive.material().index().unwrap_or(fallback);
                scene.meshes.push(part);
                numbers.push(scene.meshes.len() - 1);
            }
        }
        parts.push(numbers);
    }
    // After the meshes: textures can do with what is left.
    let textures = textures(&file, &buffers, folder, &mut budget, &mut warnings);
    for material in file.materials() {
        scene.add_material(material_of(&material, &textures));
    }
    scene.add_material(Material { shading: Shading::Pbr, color: [1.0; 4], ..Material::default() });
    for node in file.nodes() {
        let meshes = node.mesh().and_then(|mesh| parts.get(mesh.index())).cloned().unwrap_or_default();
        scene.nodes.push(Node {
            name: node.name().map_or_else(|| format!("node {}", node.index()), str::to_owned),
            transform: glam::Mat4::from_cols_array_2d(&node.transform().matrix()),
            meshes,
            children: node.children().map(|child| child.index()).collect(),
            billboard: false,
        });
    }
    let chosen = file.default_scene().or_else(|| file.scenes().next());
    scene.roots = match chosen {
        Some(chosen) => chosen.nodes().map(|node| node.index()).collect(),
        None => {
            let children: HashSet<usize> = scene.nodes.iter().flat_map(|node| node.children.clone()).collect();
            (0..scene.nodes.len()).filter(|i| !children.contains(i)).collect()
        }
    };
    let world: HashMap<usize, glam::Mat4> = scene.world_transforms().into_iter().collect();
    for node in file.nodes() {
        let Some(own) = node.camera() else { continue };
        let Some(place) = world.get(&node.index()) else { continue };
        let name = own.name().or(node.name()).unwrap_or("camera").to_owned();
        let (projection, near, far) = match own.projection() {
            gltf::camera::Projection::Perspective(p) => {
                (Projection::Perspective(p.yfov()), p.znear(), p.zfar().unwrap_or(p.znear() * 1e5))
            }
            gltf::camera::Projection::Orthographic(p) => {
                (Projection::Orthographic(p.ymag() * 2.0), p.znear(), p.zfar())
            }
        };
        match camera::inverse(place) {
            Some(view) => scene.cameras.push((name, Camera { view, projection, near, far })),
            None => warnings.push(format!("camera {name}: its node flattens space; left out")),
        }
    }
    let reached = world.len();
    if reached < scene.nodes.len() {
        warnings.push(format!("{} nodes are outside of the scene; left out", scene.nodes.len() - reached));
    }
    let named: usize = world.keys().filter_map(|node| scene.nodes.get(*node)).map(|node| node.children.len()).sum();
    if named + scene.roots.len() > reached {
        warnings.push("nodes are children of several nodes, or of themselves: they are drawn once".to_owned());
    }
    Ok(Model { scene, warnings })
}

/// The bytes of every buffer. Buffers of the same source share them.
fn buffers(file: &mut gltf::Gltf, folder: Option<&Path>, budget: &mut Budget) -> Result<Vec<Arc<Vec<u8>>>> {
    let binary = file.blob.take().map(Arc::new);
    let mut named: HashMap<&str, Arc<Vec<u8>>> = HashMap::new();
    let mut buffers = Vec::new();
    for buffer in file.document.buffers() {
        let number = buffer.index();
        let data = match buffer.source() {
            gltf::buffer::Source::Bin => {
                binary.clone().ok_or_else(|| Error::Format("the file has no binary part".to_owned()))?
            }
            gltf::buffer::Source::Uri(uri) => match named.get(uri) {
                Some(data) => Arc::clone(data),
                None => {
                    let data = if uri.starts_with("data:") {
                        base64::data_uri(uri).ok_or_else(|| "broken data URI".to_owned())
                    } else {
                        referenced(folder, &base64::unescape(uri)).inspect(|data| budget.add_file(data.len()))
                    };
                    let data = Arc::new(data.map_err(|text| Error::Format(format!("buffer {number}: {text}")))?);
                    named.insert(uri, Arc::clone(&data));
                    data
                }
            },
        };
        if data.len() < buffer.length() {
            return Err(Error::Format(format!(
                "buffer {number} claims {} bytes and has {}",
                buffer.length(),
                data.len()
            )));
        }
        buffers.push(data);
    }
    Ok(buffers)
}

/// Every texture, or `None` where it cannot be had.
fn textures(
    file: &gltf::Document,
    buffers: &[Arc<Vec<u8>>],
    folder: Option<&Path>,
    budget: &mut Budget,
    warnings: &mut Vec<String>,
) -> Vec<Option<Arc<Texture>>> {
    let mut textures = Textures::new(folder);
    let mut out = Vec::new();
    for texture in file.textures() {
        let name = format!("texture {}", texture.index());
        let place = match texture.source().source() {
            gltf::image::Source::View { view, .. } => {
                let range = view.offset()..view.offset().saturating_add(view.length());
                match buffers.get(view.buffer().index()).and_then(|buffer| buffer.get(range)) {
                    Some(bytes) => Place::Bytes(bytes),
                    None => {
                        warnings.push(format!("{name} is left out: its buffer view is beyond the buffer"));
                        out.push(None);
                        continue;
                    }
                }
            }
            gltf::image::Source::Uri { uri, .. } if uri.starts_with("data:") => Place::Data(uri),
            gltf::image::Source::Uri { uri, .. } => Place::File(base64::unescape(uri)),
        };
        out.push(textures.get(&name, place, sampler_of(&texture.sampler()), budget, warnings));
    }
    out
}

fn sampler_of(own: &gltf::texture::Sampler<'_>) -> Sampler {
    let address = |mode: WrappingMode| match mode {
        WrappingMode::Repeat => Address::Wrap,
        WrappingMode::ClampToEdge => Address::Clamp,
        WrappingMode::MirroredRepeat => Address::Mirror,
    };
    let filter = match (own.mag_filter(), own.min_filter()) {
        (Some(gltf::texture::MagFilter::Nearest), _) => Filter::Nearest,
        // Smaller sizes are not asked for. Where the file does not say, they are the better choice.
        (_, Some(gltf::texture::MinFilter::Linear | gltf::texture::MinFilter::Nearest)) => Filter::Bilinear,
        _ => Filter::Trilinear,
    };
    Sampler { address: [address(own.wrap_s()), address(own.wrap_t()), Address::Clamp], filter }
}

fn material_of(material: &gltf::Material<'_>, textures: &[Option<Arc<Texture>>]) -> Material {
    let pbr = material.pbr_metallic_roughness();
    let texture = pbr.base_color_texture().and_then(|info| textures.get(info.texture().index()).cloned().flatten());
    Material {
        shading: if material.unlit() { Shading::Unlit } else { Shading::Pbr },
        color: pbr.base_color_factor(),
        texture,
        metallic: pbr.metallic_factor(),
        roughness: pbr.roughness_factor(),
        alpha: match material.alpha_mode() {
            gltf::material::AlphaMode::Opaque => AlphaMode::Opaque,
            gltf::material::AlphaMode::Mask => AlphaMode::Mask(material.alpha_cutoff().unwrap_or(0.5)),
            gltf::material::AlphaMode::Blend => AlphaMode::Blend,
        },
        double_sided: material.double_sided(),
        ..Material::default()
    }
}

/// A glTF primitive as a mesh of the vertices that it uses; `None` without positions.
fn mesh_of(
    primitive: &gltf::Primitive<'_>,
    buffers: &[Arc<Vec<u8>>],
    budget: &mut Budget,
    warnings: &mut Vec<String>,
) -> Result<Option<Mesh>> {
    let Some(positions) = primitive.get(&Semantic::Positions) else {
        warnings.push(format!("primitive {} has no positions; left out", primitive.index()));
        return Ok(None);
    };
    let values = |accessor: Option<gltf::Accessor<'_>>| accessor.map(|a| Values::new(&a, buffers)).transpose();
    let positions = Values::new(&positions, buffers)?;
    let normals = values(primitive.get(&Semantic::Normals))?;
    let set = primitive.material().pbr_metallic_roughness().base_color_texture().map_or(0, |info| info.tex_coord());
    let uvs = values(primitive.get(&Semantic::TexCoords(set)))?;
    let colors = values(primitive.get(&Semantic::Colors(0)))?;
    let vertex = |i: usize| {
        let plain = MeshVertex::default();
        let single = |v: [f64; 3]| v.map(|v| v as f32);
        MeshVertex {
            position: positions.get(i, 0.0).map_or(plain.position, single),
            normal: normals.as_ref().and_then(|v| v.get(i, 0.0)).map_or(plain.normal, single),
            uv: uvs.as_ref().and_then(|v| v.get::<2>(i, 0.0)).map_or(plain.uv, |v| v.map(|v| v as f32)),
            color: colors.as_ref().and_then(|v| v.get::<4>(i, 1.0)).map_or(plain.color, |v| v.map(|v| v as f32)),
        }
    };
    let (vertices, indices) = match primitive.indices() {
        Some(indices) => {
            let values = Values::of_indices(&indices, buffers)?;
            let read = |i: usize| values.get(i, 0.0).map_or(0, |[index]: [f64; 1]| index as u32);
            let (all, count) = (positions.len(), values.len());
            // Many primitives may share one accessor, of which each uses a part.
            if count < all {
                budget.take_mesh(count, 2 * count)?;
                let indices: Vec<u32> = (0..count).map(read).collect();
                let mut used = indices.clone();
                used.sort_unstable();
                used.dedup();
                // Indices beyond the vertices stay beyond them.
                let place = |index: u32| match used.binary_search(&index) {
                    Ok(place) if (index as usize) < all => place as u32,
                    _ => u32::MAX,
                };
                let indices = indices.into_iter().map(place).collect();
                used.retain(|index| (*index as usize) < all);
                (used.into_iter().map(|i| vertex(i as usize)).collect(), indices)
            } else {
                budget.take_mesh(all, count)?;
                ((0..all).map(vertex).collect::<Vec<_>>(), (0..count).map(read).collect())
            }
        }
        None => {
            budget.take_mesh(positions.len(), positions.len())?;
            ((0..positions.len()).map(vertex).collect(), (0..positions.len() as u32).collect())
        }
    };
    let topology = match primitive.mode() {
        Mode::Triangles => Topology::Triangles,
        Mode::TriangleStrip => Topology::TriangleStrip,
        Mode::TriangleFan => Topology::TriangleFan,
        Mode::Lines => Topology::Lines,
        Mode::LineStrip => Topology::LineStrip,
        Mode::LineLoop => Topology::LineLoop,
        Mode::Points => Topology::Points,
    };
    let mut mesh = Mesh { vertices, indices, topology, material: 0 };
    let beyond = mesh.indices.iter().filter(|index| **index as usize >= mesh.vertices.len()).count();
    if beyond > 0 {
        warnings.push(format!("{beyond} indices name vertices that are not there; what they belong to is left out"));
    }
    if normals.is_none() {
        // The specification asks for flat normals: a vertex for each corner.
        let triangles = mesh.triangles();
        if !triangles.is_empty() {
            budget.take_mesh(3 * triangles.len(), 3 * triangles.len())?;
            mesh.flat_normals();
        }
    }
    Ok(Some(mesh))
}
