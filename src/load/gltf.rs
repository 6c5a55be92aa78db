//! glTF 2.0 and GLB, through the `gltf` crate; accessors are read here.

use std::path::Path;
use std::sync::Arc;

use gltf::mesh::{Mode, Semantic};
use gltf::texture::WrappingMode;

use super::{Model, accessor, base64, referenced};
use crate::error::{Error, Result};
use crate::scene::{AlphaMode, Camera, Material, Mesh, MeshVertex, Node, Projection, Scene, Shading};
use crate::space::{Address, Filter, Sampler, Texture, Topology, camera};
use crate::surface::Pixmap;

pub(super) fn read(bytes: &[u8], folder: Option<&Path>) -> Result<Model> {
    let unsound = |error: gltf::Error| Error::Format(format!("not sound glTF: {error}"));
    // The crate's validation looks up the accessors of positions before it has looked whether they are there.
    let unchecked = gltf::Gltf::from_slice_without_validation(bytes).map_err(unsound)?;
    let json = unchecked.document.as_json();
    let accessors = json.accessors.len();
    let mut used = json.meshes.iter().flat_map(|mesh| &mesh.primitives).flat_map(|part| part.attributes.values());
    if let Some(missing) = used.find(|index| index.value() >= accessors) {
        return Err(Error::Format(format!("not sound glTF: there is no accessor {}", missing.value())));
    }
    let file = gltf::Gltf::from_slice(bytes).map_err(unsound)?;
    let mut warnings = Vec::new();
    let buffers = buffers(&file, folder)?;
    let mut scene = Scene::new();
    let textures = textures(&file, &buffers, folder, &mut warnings);
    for material in file.materials() {
        scene.add_material(material_of(&material, &textures));
    }
    let fallback = scene.add_material(Material { shading: Shading::Pbr, color: [1.0; 4], ..Material::default() });
    // The meshes of each glTF mesh, one for each of its primitives.
    let mut parts = Vec::new();
    for mesh in file.meshes() {
        let mut numbers = Vec::new();
        for primitive in mesh.primitives() {
            if let Some(mut part) = mesh_of(&primitive, &buffers, &mut warnings)? {
                part.material = primitive.material().index().unwrap_or(fallback);
                scene.meshes.push(part);
                numbers.push(scene.meshes.len() - 1);
            }
        }
        parts.push(numbers);
    }
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
            let children: Vec<usize> = scene.nodes.iter().flat_map(|node| node.children.clone()).collect();
            (0..scene.nodes.len()).filter(|i| !children.contains(i)).collect()
        }
    };
    let world = scene.world_transforms();
    for node in file.nodes() {
        let (Some(own), Some((_, place))) = (node.camera(), world.iter().find(|(number, _)| *number == node.index()))
        else {
            continue;
        };
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
        warnings.push(format!("{} nodes are outside of the scene, or come twice", scene.nodes.len() - reached));
    }
    Ok(Model { scene, warnings })
}

fn buffers(file: &gltf::Gltf, folder: Option<&Path>) -> Result<Vec<Vec<u8>>> {
    let mut buffers = Vec::new();
    for buffer in file.buffers() {
        let number = buffer.index();
        let data = match buffer.source() {
            gltf::buffer::Source::Bin => {
                file.blob.clone().ok_or_else(|| Error::Format("the file has no binary part".to_owned()))?
            }
            gltf::buffer::Source::Uri(uri) if uri.starts_with("data:") => {
                base64::data_uri(uri).ok_or_else(|| Error::Format(format!("buffer {number}: broken data URI")))?
            }
            gltf::buffer::Source::Uri(uri) => referenced(folder, &base64::unescape(uri))
                .map_err(|text| Error::Format(format!("buffer {number}: {text}")))?,
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
    file: &gltf::Gltf,
    buffers: &[Vec<u8>],
    folder: Option<&Path>,
    warnings: &mut Vec<String>,
) -> Vec<Option<Arc<Texture>>> {
    let mut out = Vec::new();
    for texture in file.textures() {
        let bytes = match texture.source().source() {
            gltf::image::Source::View { view, .. } => {
                let range = view.offset()..view.offset().saturating_add(view.length());
                let data = buffers.get(view.buffer().index()).and_then(|buffer| buffer.get(range));
                data.map(<[u8]>::to_vec).ok_or_else(|| "its buffer view is beyond the buffer".to_owned())
            }
            gltf::image::Source::Uri { uri, .. } if uri.starts_with("data:") => {
                base64::data_uri(uri).ok_or_else(|| "broken data URI".to_owned())
            }
            gltf::image::Source::Uri { uri, .. } => referenced(folder, &base64::unescape(uri)),
        };
        let address = |mode: WrappingMode| match mode {
            WrappingMode::Repeat => Address::Wrap,
            WrappingMode::ClampToEdge => Address::Clamp,
            WrappingMode::MirroredRepeat => Address::Mirror,
        };
        let own = texture.sampler();
        let filter = match (own.mag_filter(), own.min_filter()) {
            (Some(gltf::texture::MagFilter::Nearest), _) => Filter::Nearest,
            // Smaller sizes are not asked for. Where the file does not say, they are the better choice.
            (_, Some(gltf::texture::MinFilter::Linear | gltf::texture::MinFilter::Nearest)) => Filter::Bilinear,
            _ => Filter::Trilinear,
        };
        let sampler = Sampler { address: [address(own.wrap_s()), address(own.wrap_t()), Address::Clamp], filter };
        let loaded = bytes.and_then(|bytes| picture(&bytes, sampler));
        out.push(match loaded {
            Ok(texture) => Some(texture),
            Err(text) => {
                warnings.push(format!("texture {} is left out: {text}", texture.index()));
                None
            }
        });
    }
    out
}

/// A picture's bytes as a texture.
pub(super) fn picture(bytes: &[u8], sampler: Sampler) -> std::result::Result<Arc<Texture>, String> {
    let pixmap = Pixmap::decode(bytes).map_err(|error| error.to_string())?;
    Ok(Arc::new(Texture::from_pixmap(&pixmap, sampler).map_err(|error| error.to_string())?))
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

/// A glTF primitive as a mesh; `None` without positions.
fn mesh_of(primitive: &gltf::Primitive<'_>, buffers: &[Vec<u8>], warnings: &mut Vec<String>) -> Result<Option<Mesh>> {
    let Some(positions) = primitive.get(&Semantic::Positions) else {
        warnings.push(format!("primitive {} has no positions; left out", primitive.index()));
        return Ok(None);
    };
    let positions = accessor::read::<3>(&positions, buffers, 0.0)?;
    let normals = primitive.get(&Semantic::Normals).map(|a| accessor::read::<3>(&a, buffers, 0.0)).transpose()?;
    let set = primitive.material().pbr_metallic_roughness().base_color_texture().map_or(0, |info| info.tex_coord());
    let uvs = primitive.get(&Semantic::TexCoords(set)).map(|a| accessor::read::<2>(&a, buffers, 0.0)).transpose()?;
    let colors = primitive.get(&Semantic::Colors(0)).map(|a| accessor::read::<4>(&a, buffers, 1.0)).transpose()?;
    let vertices: Vec<MeshVertex> = positions
        .iter()
        .enumerate()
        .map(|(i, position)| {
            let plain = MeshVertex::default();
            let at =
                |values: &Option<Vec<[f64; 3]>>| values.as_ref().and_then(|v| v.get(i)).map(|v| v.map(|v| v as f32));
            MeshVertex {
                position: position.map(|v| v as f32),
                normal: at(&normals).unwrap_or(plain.normal),
                uv: uvs.as_ref().and_then(|v| v.get(i)).map_or(plain.uv, |v| v.map(|v| v as f32)),
                color: colors.as_ref().and_then(|v| v.get(i)).map_or(plain.color, |v| v.map(|v| v as f32)),
            }
        })
        .collect();
    let indices = match primitive.indices() {
        Some(indices) => accessor::read::<1>(&indices, buffers, 0.0)?.into_iter().map(|[i]| i as u32).collect(),
        None => (0..vertices.len() as u32).collect(),
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
    if normals.is_none() {
        // The specification asks for flat normals.
        if !mesh.triangles().is_empty() {
            mesh.flat_normals();
        }
    }
    Ok(Some(mesh))
}
