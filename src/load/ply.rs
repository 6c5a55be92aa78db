//! PLY, text and binary, through `ply-rs-bw`.

use std::io::Cursor;

use ply_rs_bw::parser::{Parser, Reader};
use ply_rs_bw::ply::{Property, PropertyAccess, PropertyAccessResult};

use super::budget::Budget;
use super::{Model, single};
use crate::error::{Error, Result};
use crate::scene::{Mesh, MeshVertex};
use crate::space::Topology;

/// Bytes that an element takes, as the crate keeps it while its list grows, and in the mesh.
const ELEMENT: usize = 192;

/// Any element: what is known of vertices and faces is kept.
struct Element {
    vertex: MeshVertex,
    has_normal: bool,
    corners: Vec<u32>,
}

impl PropertyAccess for Element {
    fn new() -> Self {
        Self { vertex: MeshVertex::default(), has_normal: false, corners: Vec::new() }
    }

    fn set_property(&mut self, name: &str, property: Property) -> PropertyAccessResult {
        let list = |property: Property| -> Option<Vec<u32>> {
            Some(match property {
                Property::ListChar(v) => v.into_iter().map(|v| v as u32).collect(),
                Property::ListUChar(v) => v.into_iter().map(u32::from).collect(),
                Property::ListShort(v) => v.into_iter().map(|v| v as u32).collect(),
                Property::ListUShort(v) => v.into_iter().map(u32::from).collect(),
                Property::ListInt(v) => v.into_iter().map(|v| v as u32).collect(),
                Property::ListUInt(v) => v,
                _ => return None,
            })
        };
        if matches!(name, "vertex_indices" | "vertex_index") {
            self.corners = list(property).unwrap_or_default();
            return PropertyAccessResult::Set;
        }
        // Integer colours are parts of their type's largest value.
        let (value, scale) = match property {
            Property::Char(v) => (f32::from(v), 127.0),
            Property::UChar(v) => (f32::from(v), 255.0),
            Property::Short(v) => (f32::from(v), 32_767.0),
            Property::UShort(v) => (f32::from(v), 65_535.0),
            Property::Int(v) => (v as f32, 2_147_483_647.0),
            Property::UInt(v) => (v as f32, 4_294_967_295.0),
            Property::Float(v) => (v, 1.0),
            Property::Double(v) => (v as f32, 1.0),
            _ => return PropertyAccessResult::Ignored,
        };
        let vertex = &mut self.vertex;
        match name {
            "x" => vertex.position[0] = value,
            "y" => vertex.position[1] = value,
            "z" => vertex.position[2] = value,
            "nx" | "ny" | "nz" => {
                self.has_normal = true;
                vertex.normal[match name {
                    "nx" => 0,
                    "ny" => 1,
                    _ => 2,
                }] = value;
            }
            "s" | "u" | "texture_u" => vertex.uv[0] = value,
            "t" | "v" | "texture_v" => vertex.uv[1] = 1.0 - value,
            "red" | "r" | "diffuse_red" => vertex.color[0] = value / scale,
            "green" | "g" | "diffuse_green" => vertex.color[1] = value / scale,
            "blue" | "b" | "diffuse_blue" => vertex.color[2] = value / scale,
            "alpha" | "a" => vertex.color[3] = value / scale,
            _ => return PropertyAccessResult::Ignored,
        }
        PropertyAccessResult::Set
    }
}

pub(super) fn read(bytes: &[u8]) -> Result<Model> {
    let fault = |error: &dyn std::fmt::Display| Error::Format(format!("not sound PLY: {error}"));
    let parser = Parser::<Element>::new();
    let mut reader = Reader::new(Cursor::new(bytes));
    let header = parser.read_header(&mut reader).map_err(|error| fault(&error))?;
    let mut budget = Budget::new(bytes.len());
    for (name, element) in &header.elements {
        // Each takes at least one byte of the file, or nothing at all if it has no properties.
        if element.count > bytes.len() {
            return Err(Error::Format(format!("PLY that claims {} of {name} in {} bytes", element.count, bytes.len())));
        }
        budget.take_each(element.count, ELEMENT, &format!("its elements ({name})"))?;
    }
    let payload = parser.read_payload(&mut reader, &header).map_err(|error| fault(&error))?;
    let mut mesh = Mesh::default();
    let mut has_normals = false;
    let mut warnings = Vec::new();
    for (name, elements) in payload {
        match name.as_str() {
            "vertex" => {
                has_normals = elements.first().is_some_and(|element: &Element| element.has_normal);
                mesh.vertices = elements.iter().map(|element| element.vertex).collect();
            }
            "face" => {
                // Polygons as fans.
                for corners in elements.iter().map(|element| &element.corners[..]) {
                    if let [first, rest @ ..] = corners {
                        mesh.indices.extend(rest.windows(2).flat_map(|pair| [*first, pair[0], pair[1]]));
                    }
                }
            }
            other => warnings.push(format!("PLY element {other} is left out")),
        }
    }
    if mesh.indices.is_empty() {
        mesh.topology = Topology::Points;
        mesh.indices = (0..mesh.vertices.len() as u32).collect();
    } else if !has_normals {
        mesh.smooth_normals();
    }
    Ok(Model { scene: single("ply", mesh), warnings })
}
