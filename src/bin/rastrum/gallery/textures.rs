//! Textures, fog and sprites.

use std::sync::Arc;

use rastrum::glam::Mat4;
use rastrum::scene::{
    AlphaMode, Camera, Fog, FogKind, Material, Mesh, MeshVertex, Node, Scene, SceneSettings, Shading,
};
use rastrum::space::{Address, Filter, Sampler, Texture, camera};
use rastrum::{Color, Pixmap, Rect, Result};

use super::board::{AMBER, BLUE, Board, GREEN, INK, MINT, PAPER, RED, SKY, VIOLET, mix};
use super::stage;
use super::{Row, row};

pub(super) const ROWS: &[Row] = &[
    row(
        89,
        "Texturing",
        "A texture of 6 × 6 texels on a square larger than it: nearest and bilinear, wrapped, clamped and mirrored beyond its sides.",
        texturing,
    ),
    row(
        90,
        "Textures of one, two and three dimensions",
        "A ramp looked up by u, a picture by u and v, and a block of 4 × 4 × 4 texels cut through at four heights.",
        dimensions,
    ),
    row(
        91,
        "Moiré and mipmaps",
        "A checkered floor to the horizon. Without mipmaps its far end breaks up into moiré (left); with them it fades to grey (right).",
        mipmaps,
    ),
    row(
        92,
        "Fog",
        "Linear, exponential and squared-exponential fog over the same row of boxes, and their curves.",
        fog,
    ),
    row(
        95,
        "Billboards",
        "Trees are flat sprites that turn to the camera, cut out by their alpha: from both sides of the meadow they look the same.",
        billboards,
    ),
];

fn letters() -> Vec<u32> {
    // An arrow, so that turned and mirrored copies can be told apart.
    let rows = ["......", "..#...", ".###..", "#.#.#.", "..#..o", "..#.oo"];
    let texel = |c: char| match c {
        '#' => BLUE,
        'o' => AMBER,
        _ => mix(SKY, Color::WHITE, 0.6),
    };
    rows.iter().flat_map(|row| row.chars()).map(|c| u32::from_le_bytes(texel(c).premultiply())).collect()
}

/// A square seen head on whose u and v run from −`beyond` to 1 + `beyond`.
fn square(texture: Texture, beyond: f32) -> (Scene, Camera) {
    let mut mesh = Mesh { indices: vec![0, 1, 2, 0, 2, 3], ..Mesh::default() };
    for (x, y) in [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0_f32)] {
        let to_uv = |v: f32| 0.5 + v * (0.5 + beyond);
        mesh.vertices.push(MeshVertex { position: [x, y, 0.0], uv: [to_uv(x), to_uv(-y)], ..MeshVertex::default() });
    }
    let material =
        Material { shading: Shading::Unlit, color: [1.0; 4], texture: Some(Arc::new(texture)), ..Material::default() };
    let camera = Camera {
        projection: rastrum::scene::Projection::Orthographic(2.0),
        ..Camera::look_at([0.0, 0.0, 3.0], [0.0; 3], [0.0, 1.0, 0.0])
    };
    (stage::scene(vec![(mesh, material, Mat4::IDENTITY)]), camera)
}

fn texturing(board: &mut Board) -> Result<()> {
    let names =
        ["NEAREST, WRAP", "NEAREST, CLAMP", "NEAREST, MIRROR", "BILINEAR, WRAP", "BILINEAR, CLAMP", "BILINEAR, MIRROR"];
    let panels = board.tiles(3, &names);
    for (i, rect) in panels.into_iter().enumerate() {
        let filter = if i < 3 { Filter::Nearest } else { Filter::Bilinear };
        let address = [Address::Wrap, Address::Clamp, Address::Mirror][i % 3];
        let texture = Texture::new(6, 6, 1, letters(), Sampler::new(address, filter))?;
        let (scene, camera) = square(texture, 0.6);
        let side = rect.width().min(rect.height()) as u32;
        let (picture, _) = stage::view(&scene, &camera, (side, side), &stage::settings())?;
        board.picture(rect, picture);
    }
    Ok(())
}

fn dimensions(board: &mut Board) -> Result<()> {
    let [one, two, three] = board.panels(["1D", "2D", "3D, FOUR CUTS"]);
    let pack = |color: Color| u32::from_le_bytes(color.premultiply());
    let ramp: Vec<u32> = [BLUE, GREEN, AMBER, RED].map(pack).to_vec();
    for (rect, texture) in [
        (one, Texture::new(4, 1, 1, ramp, Sampler::new(Address::Clamp, Filter::Nearest))?),
        (two, Texture::new(6, 6, 1, letters(), Sampler::new(Address::Clamp, Filter::Nearest))?),
    ] {
        let (scene, camera) = square(texture, 0.0);
        let side = rect.width() as u32;
        board.picture(rect, stage::view(&scene, &camera, (side, side), &stage::settings())?.0);
    }
    let texel = |x: u32, y: u32, z: u32| {
        let t = |v: u32| v as f32 / 3.0;
        pack(Color::from_rgba(0.25 + 0.7 * t(x), 0.25 + 0.7 * t(y), 0.25 + 0.7 * t(z), 1.0))
    };
    let cells = (0..4).flat_map(|z| (0..4).flat_map(move |y| (0..4).map(move |x| (x, y, z))));
    let block = Texture::new(4, 4, 4, cells.map(|(x, y, z)| texel(x, y, z)).collect(), Sampler::default())?;
    for z in 0..4 {
        let rect =
            Rect::from_xywh(three.left + (z % 2) as f32 * 96.0, three.top + 60.0 + (z / 2) as f32 * 120.0, 90.0, 90.0);
        let mut data = Vec::new();
        for (x, y) in (0..4).flat_map(|y| (0..4).map(move |x| (x, y))) {
            data.extend(block.texel(0, x, y, z).unwrap_or(0).to_le_bytes());
        }
        board.zoomed(rect, Pixmap::from_vec(4, 4, data)?);
    }
    Ok(())
}

fn mipmaps(board: &mut Board) -> Result<()> {
    let [left, right] = board.panels(["NEAREST", "TRILINEAR"]);
    for (rect, filter) in [(left, Filter::Nearest), (right, Filter::Trilinear)] {
        let cells = (0..64).flat_map(|y| (0..64).map(move |x| (x / 16 + y / 16) % 2));
        let texels = cells.map(|c| u32::from_le_bytes(if c == 0 { INK } else { PAPER }.premultiply())).collect();
        let texture = Texture::new(64, 64, 1, texels, Sampler::new(Address::Wrap, filter))?;
        let mut mesh = Mesh { indices: vec![0, 1, 2, 0, 2, 3], ..Mesh::default() };
        for (x, z) in [(-40.0, 2.0), (40.0, 2.0), (40.0, -80.0), (-40.0, -80.0)] {
            mesh.vertices.push(MeshVertex { position: [x, 0.0, z], uv: [x * 0.35, z * 0.35], ..MeshVertex::default() });
        }
        let material = Material {
            shading: Shading::Unlit,
            color: [1.0; 4],
            texture: Some(Arc::new(texture)),
            ..Material::default()
        };
        let scene = stage::scene(vec![(mesh, material, Mat4::IDENTITY)]);
        let camera = Camera::look_at([0.0, 1.4, 2.0], [0.0, 0.9, -2.0], [0.0, 1.0, 0.0]);
        let size = (rect.width() as u32 / 2, rect.height() as u32 / 2);
        let settings = SceneSettings { background: SKY, ..stage::settings() };
        let (picture, _) = stage::view(&scene, &camera, size, &settings)?;
        board.picture(rect, picture);
    }
    Ok(())
}

fn boxes() -> Scene {
    let part = |i: usize| {
        let color = [RED, AMBER, GREEN, BLUE, VIOLET][i % 5];
        (
            Mesh::cuboid([-0.5, 0.0, -0.5], [0.5, 1.4, 0.5], 0),
            stage::matte(color),
            stage::at(-2.4 + i as f32 * 1.2, 0.0, -2.2 * i as f32),
        )
    };
    let mut parts: Vec<_> = (0..6).map(part).collect();
    parts.push((stage::floor(30.0, 0.0), stage::matte(MINT), Mat4::IDENTITY));
    stage::scene(parts)
}

fn fog(board: &mut Board) -> Result<()> {
    let panels = board.tiles(2, &["LINEAR", "EXP", "EXP2", "CURVES"]);
    let camera = Camera::look_at([-1.2, 1.6, 3.4], [0.5, 0.6, -3.0], [0.0, 1.0, 0.0]);
    let kinds =
        [FogKind::Linear { start: 2.0, end: 16.0 }, FogKind::Exponential(0.14), FogKind::ExponentialSquared(0.11)];
    for (rect, kind) in panels.iter().zip(kinds) {
        let mut scene = boxes();
        scene.fog = Some(Fog { kind, color: [PAPER.r, PAPER.g, PAPER.b] });
        stage::show(board, *rect, &scene, &camera, &stage::settings())?;
    }
    let Some(last) = panels.last() else { return Ok(()) };
    let axes = board.axes(*last, (0.0, 20.0), (0.0, 1.05), ("DISTANCE", "SHARE LEFT"));
    let steps = || (0..=100).map(|i| i as f32 / 5.0);
    board.curve(&axes, steps().map(|w| (w, ((16.0 - w) / 14.0).clamp(0.0, 1.0))), RED);
    board.curve(&axes, steps().map(|w| (w, libm::expf(-0.14 * w))), BLUE);
    board.curve(&axes, steps().map(|w| (w, libm::expf(-(0.11 * w) * (0.11 * w)))), GREEN);
    Ok(())
}

/// A tree with a round crown, transparent around.
fn tree() -> Result<Texture> {
    let side = 64_u32;
    let mut texels = Vec::new();
    for (x, y) in (0..side).flat_map(|y| (0..side).map(move |x| (x, y))) {
        let (dx, dy) = (x as f32 - 31.5, y as f32 - 22.0);
        let crown = dx * dx + dy * dy < 440.0 + 60.0 * if (x / 5 + y / 4) % 2 == 0 { 1.0 } else { -0.6 };
        let trunk = dx.abs() < 4.0 && y > 30;
        let color = if crown { mix(GREEN, MINT, ((x * 7 + y * 13) % 11) as f32 / 22.0) } else { mix(AMBER, INK, 0.55) };
        texels.push(if crown || trunk { u32::from_le_bytes(color.premultiply()) } else { 0 });
    }
    Texture::new(side, side, 1, texels, Sampler::new(Address::Clamp, Filter::Bilinear))
}

fn billboards(board: &mut Board) -> Result<()> {
    let [left, right] = board.panels(["FROM THE SOUTH", "FROM THE EAST"]);
    let texture = Arc::new(tree()?);
    let mut scene = stage::scene(vec![
        (stage::floor(3.0, 0.0), stage::matte(MINT), Mat4::IDENTITY),
        (Mesh::cuboid([-0.3, 0.0, -0.3], [0.3, 0.6, 0.3], 0), stage::matte(RED), Mat4::IDENTITY),
    ]);
    let material = scene.add_material(Material {
        shading: Shading::Unlit,
        color: [1.0; 4],
        texture: Some(texture),
        alpha: AlphaMode::Mask(0.5),
        ..Material::default()
    });
    let mut sprite = Mesh { indices: vec![0, 1, 2, 0, 2, 3], material, ..Mesh::default() };
    for (x, y, u, v) in [(-0.6, 0.0, 0.0, 1.0), (0.6, 0.0, 1.0, 1.0), (0.6, 1.2, 1.0, 0.0), (-0.6, 1.2, 0.0, 0.0)] {
        sprite.vertices.push(MeshVertex { position: [x, y, 0.0], uv: [u, v], ..MeshVertex::default() });
    }
    scene.meshes.push(sprite);
    let mesh = scene.meshes.len() - 1;
    for (x, z) in [(-1.9, -1.6), (1.6, -1.9), (-1.2, 1.5), (2.0, 1.2), (0.4, -0.9)] {
        scene.nodes.push(Node {
            transform: camera::translation([x, 0.0, z]),
            meshes: vec![mesh],
            billboard: true,
            ..Node::default()
        });
        scene.roots.push(scene.nodes.len() - 1);
    }
    for (rect, eye) in [(left, [0.0, 2.2, 6.4]), (right, [6.4, 2.2, 0.0])] {
        let camera = Camera::look_at(eye, [0.0, 0.3, 0.0], [0.0, 1.0, 0.0]);
        let settings = SceneSettings { background: mix(SKY, Color::WHITE, 0.4), ..stage::settings() };
        stage::show(board, rect, &scene, &camera, &settings)?;
    }
    Ok(())
}
