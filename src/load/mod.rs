//! 3D models from files: glTF and GLB, OBJ with MTL, STL and PLY.

mod accessor;
mod base64;
mod budget;
mod gltf;
mod obj;
mod ply;
mod stl;
mod textures;

use std::path::Path;

use crate::error::{Error, Result};
use crate::scene::{Mesh, Scene};

/// A scene from a file.
#[derive(Clone, Debug)]
pub struct Model {
    /// The scene, without lights.
    pub scene: Scene,
    /// What was left out or replaced, for people to read.
    pub warnings: Vec<String>,
}

/// The kinds of files.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ModelFormat {
    /// glTF 2.0, as JSON or as GLB.
    Gltf,
    /// Wavefront OBJ, with its MTL.
    Obj,
    /// STL, as text or binary.
    Stl,
    /// PLY, as text or binary of either byte order.
    Ply,
}

impl ModelFormat {
    /// The format that a file's name ending stands for.
    pub fn from_path(path: &Path) -> Option<Self> {
        let ending = path.extension()?.to_str()?.to_ascii_lowercase();
        Some(match ending.as_str() {
            "gltf" | "glb" => Self::Gltf,
            "obj" => Self::Obj,
            "stl" => Self::Stl,
            "ply" => Self::Ply,
            _ => return None,
        })
    }
}

impl Model {
    /// Reads a model from a file; the format follows from the name's ending. What it refers to (buffers, materials,
    /// textures) is looked for from the file's folder.
    ///
    /// # Errors
    /// [`Error::Io`] if the file cannot be read; [`Error::Parameter`] for a name with another ending; else as [`Model::decode`].
    pub fn load(path: impl AsRef<Path>) -> Result<Self> {
        let path = path.as_ref();
        let Some(format) = ModelFormat::from_path(path) else {
            return Err(Error::Parameter(format!(
                "{}: not a model; names end in .glb, .gltf, .obj, .stl or .ply",
                path.display()
            )));
        };
        let bytes = std::fs::read(path).map_err(|source| Error::Io { path: path.to_owned(), source })?;
        Self::decode(&bytes, format, path.parent()).map_err(|error| match error {
            Error::Format(text) => Error::Format(format!("{}: {text}", path.display())),
            Error::Limit(text) => Error::Limit(format!("{}: {text}", path.display())),
            other => other,
        })
    }

    /// Reads a model from bytes. `folder` is where files that it refers to are looked for; without one they count as missing.
    /// Missing textures and materials are warnings; the mesh is drawn without.
    ///
    /// A model takes at most 64 times the size of its files, or 64 MiB where that is more, and 128 MiB for a picture while it is
    /// decoded. Textures beyond that become smaller, with a warning; anything else is an error.
    ///
    /// # Errors
    /// [`Error::Format`] for data that is not what it claims to be, [`Error::Limit`] for what is too large.
    pub fn decode(bytes: &[u8], format: ModelFormat, folder: Option<&Path>) -> Result<Self> {
        match format {
            ModelFormat::Gltf => gltf::read(bytes, folder),
            ModelFormat::Obj => obj::read(bytes, folder),
            ModelFormat::Stl => stl::read(bytes),
            ModelFormat::Ply => ply::read(bytes),
        }
    }
}

/// A scene of one mesh.
fn single(name: &str, mesh: Mesh) -> Scene {
    let mut scene = Scene::new();
    scene.add_material(crate::scene::Material::default());
    scene.add_mesh(name, mesh, glam::Mat4::IDENTITY);
    scene
}

/// A file that a model refers to: below the model's folder alone, so that a model cannot read what it is not given.
fn referenced(folder: Option<&Path>, name: &str) -> std::result::Result<Vec<u8>, String> {
    let Some(folder) = folder else { return Err(format!("{name}: there is no folder to look in")) };
    let relative = Path::new(name);
    let inside = relative
        .components()
        .all(|part| matches!(part, std::path::Component::Normal(_) | std::path::Component::CurDir));
    if !inside {
        return Err(format!("{name}: outside of the model's folder"));
    }
    std::fs::read(folder.join(relative)).map_err(|error| format!("{name}: {error}"))
}
