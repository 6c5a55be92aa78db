//! STL, text and binary, through `stl_io`.

use std::io::Cursor;

use super::{Model, single};
use crate::error::{Error, Result};
use crate::scene::{Mesh, MeshVertex};
use crate::space::Topology;

pub(super) fn read(bytes: &[u8]) -> Result<Model> {
    if bytes.is_empty() {
        return Err(Error::Format("an empty file is not STL".to_owned()));
    }
    // A binary file says how many facets of 50 bytes it has; a text begins with "solid".
    let claimed = bytes.get(80..).and_then(|rest| rest.first_chunk::<4>()).map(|count| u32::from_le_bytes(*count));
    if !bytes.starts_with(b"solid") {
        let held = bytes.len().saturating_sub(84) / 50;
        match claimed {
            Some(claimed) if claimed as usize <= held => {}
            Some(claimed) => {
                return Err(Error::Format(format!("STL that claims {claimed} facets and has room for {held}")));
            }
            None => return Err(Error::Format("neither text nor binary STL".to_owned())),
        }
    }
    let mesh =
        stl_io::read_stl(&mut Cursor::new(bytes)).map_err(|error| Error::Format(format!("not sound STL: {error}")))?;
    let mut vertices = Vec::with_capacity(mesh.faces.len() * 3);
    for face in &mesh.faces {
        let corners = face.vertices.map(|i| mesh.vertices.get(i).map_or([0.0; 3], |v| v.0));
        vertices.extend(corners.map(|position| MeshVertex { position, ..MeshVertex::default() }));
    }
    let indices = (0..vertices.len() as u32).collect();
    let mut out = Mesh { vertices, indices, topology: Topology::Triangles, material: 0 };
    // Facets often come without their normal; the corners tell it.
    out.flat_normals();
    Ok(Model { scene: single("stl", out), warnings: Vec::new() })
}
