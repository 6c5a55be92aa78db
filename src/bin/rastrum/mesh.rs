//! `rastrum mesh`: 3D models as pictures.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;

use clap::{Args, ValueEnum};
use rastrum::glam::Mat4;
use rastrum::load::Model;
use rastrum::scene::{
    Aabb, Camera, Fog, FogKind, Light, LightKind, Look, Material, Mesh, MeshVertex, Node, Projection, Scene,
    SceneAntialias, SceneSettings, SceneStats, Shading, draw_scene, render_picture,
};
use rastrum::space::{Cull, Fill, Filter, Samples, Target, Texture, Topology, Viewport, camera};
use rastrum::{Color, Pixmap};

use crate::args::Timings;
use crate::depth_file;
use crate::files::write_whole;
use crate::json;
use crate::plan::is_standard_output;
use crate::report::{self, Failure, Outcome};

const EXAMPLES: &str = "\
Examples:
  rastrum mesh part.stl                                 writes part.png: framed by itself, from the front, right and above
  rastrum mesh car.glb -o car.png --view left --aa msaa4 --background FFFFFF
  rastrum mesh a.obj b.ply -o both.png --eye 3,2,5 --at 0,0,0 --fov 40
  rastrum mesh head.obj -o turn.png --turntable 36      turn-000.png to turn-035.png
  rastrum mesh scan.ply --shading depth --depth-out scan.npy
  rastrum mesh scene.gltf --info";

/// Draw 3D models (GLB, glTF, OBJ, STL, PLY) as PNG.
///
/// Several models share one scene. Without --eye or --camera the camera stands where all of the scene just fits the picture.
#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub(crate) struct MeshArguments {
    /// Files that end in .glb, .gltf, .obj, .stl or .ply.
    #[arg(required = true, value_name = "MODEL")]
    models: Vec<PathBuf>,

    /// Where the picture goes: a file, or - for standard output. Default: beside the only model, ending in .png.
    #[arg(short, long, value_name = "OUT")]
    output: Option<PathBuf>,

    /// Write depths, too, as 32-bit floats in rows from the top: 0 at the near plane, 1 at the far plane and where nothing is, not linear in
    /// distance unless --ortho. A name that ends in .npy makes a NumPy array, .pfm a PFM picture, any other the floats alone, little
    /// endian. Without antialiasing, whatever --aa is.
    #[arg(long, value_name = "FILE", conflicts_with = "turntable")]
    depth_out: Option<PathBuf>,

    /// Width and height in pixels.
    #[arg(long, value_name = "WxH", default_value = "1280x720", value_parser = size)]
    size: (u32, u32),

    /// Where the camera stands.
    #[arg(long, value_enum, default_value_t = View::Iso)]
    view: View,

    /// Degrees around the up axis from the front, to the right. Default: the view's.
    #[arg(long, value_name = "DEGREES", allow_negative_numbers = true, value_parser = finite)]
    azimuth: Option<f32>,

    /// Degrees above the horizon. Default: the view's.
    #[arg(long, value_name = "DEGREES", allow_negative_numbers = true, value_parser = finite)]
    elevation: Option<f32>,

    /// The camera's place.
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true, value_parser = triple)]
    eye: Option<Triple>,

    /// What the camera looks at. Default: the scene's middle.
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true, value_parser = triple)]
    at: Option<Triple>,

    /// What is up in the picture. Default: the up axis.
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true, value_parser = triple)]
    up: Option<Triple>,

    /// Vertical field of view in degrees, 1 to 170. Default: 45, or the model camera's.
    #[arg(long, value_name = "DEGREES", value_parser = fov)]
    fov: Option<f32>,

    /// Distance of the near plane. Default: just before the scene.
    #[arg(long, value_name = "DISTANCE", value_parser = positive)]
    near: Option<f32>,

    /// Distance of the far plane. Default: just behind the scene.
    #[arg(long, value_name = "DISTANCE", value_parser = positive)]
    far: Option<f32>,

    /// Parallel projection, as high as the perspective one is at the point looked at.
    #[arg(long)]
    ortho: bool,

    /// Use the file's camera of this number, from 0.
    #[arg(long, value_name = "N", conflicts_with_all = ["eye", "azimuth", "elevation"])]
    camera: Option<usize>,

    /// The model's axis that points up.
    #[arg(long, value_enum, default_value_t = Axis::Y)]
    up_axis: Axis,

    /// How surfaces are shaded. phong: rgb·(a + (1 − a)·max(N·L, 0)) + 0.5·max(N·H, 0)^32 with a = --ambient. Default: the
    /// materials' own.
    #[arg(long, value_enum)]
    shading: Option<MeshShading>,

    /// Edges instead of surfaces.
    #[arg(long, conflicts_with = "points")]
    wireframe: bool,

    /// Corners instead of surfaces.
    #[arg(long)]
    points: bool,

    /// One colour for everything.
    #[arg(long, value_name = "RRGGBB", value_parser = hex)]
    color: Option<Color>,

    /// Leave textures out.
    #[arg(long)]
    no_textures: bool,

    /// How textures are sampled; only trilinear uses mipmaps. Default: as the model's samplers say, trilinear where they say nothing.
    #[arg(long, value_enum)]
    filter: Option<TextureFilter>,

    /// Which side of triangles is left out. Default: as the materials say.
    #[arg(long, value_enum)]
    cull: Option<MeshCull>,

    /// The direction towards the light, in world space.
    #[arg(long, value_name = "X,Y,Z", default_value = "1,2,3", allow_hyphen_values = true, value_parser = triple)]
    light: Triple,

    /// The share of light that comes from everywhere, 0 to 1.
    #[arg(long, value_name = "SHARE", default_value_t = 0.1, value_parser = share)]
    ambient: f32,

    /// The light casts shadows.
    #[arg(long)]
    shadows: bool,

    /// Fog in the background's colour: this much of the scene's farthest part is lost in it, 0 to 1.
    #[arg(long, value_name = "SHARE", value_parser = share)]
    fog: Option<f32>,

    /// How edges are smoothed.
    #[arg(long, value_enum, default_value_t = Smoothing::None)]
    aa: Smoothing,

    /// Colour behind the scene.
    #[arg(long, value_name = "RRGGBB|transparent", default_value = "transparent", value_parser = background)]
    background: Color,

    /// Draw a grid on the ground.
    #[arg(long)]
    grid: bool,

    /// Draw the axes: x red, y green, z blue.
    #[arg(long)]
    axes: bool,

    /// N pictures all around, numbered before the output's ending.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=10_000))]
    turntable: Option<u32>,

    /// Threads, 0 for all. The picture is the same with any number.
    #[arg(long, value_name = "N", default_value_t = 0)]
    threads: usize,

    /// Say what is in the files, and draw nothing unless there is an output.
    #[arg(long)]
    info: bool,

    /// Print how long it took, one JSON object, to standard output (to standard error if the picture goes there).
    #[arg(long, value_name = "FORMAT")]
    timings: Option<Timings>,
}

/// Three numbers.
#[derive(Clone, Copy, Debug)]
struct Triple([f32; 3]);

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum View {
    Front,
    Back,
    Left,
    Right,
    Top,
    Bottom,
    Iso,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Axis {
    X,
    Y,
    Z,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum MeshShading {
    Flat,
    Gouraud,
    Phong,
    Pbr,
    Unlit,
    /// 0.5 + 0.5·N as colours.
    Normals,
    /// White near, black far.
    Depth,
    /// Primitive number + 1 over the meshes in the order of their nodes' names, little endian in RGB.
    Ids,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum TextureFilter {
    Nearest,
    Bilinear,
    Trilinear,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum MeshCull {
    None,
    Back,
    Front,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Smoothing {
    None,
    Fxaa,
    Ssaa2,
    Msaa4,
    Msaa8,
}

fn finite(text: &str) -> Result<f32, String> {
    text.parse::<f32>().ok().filter(|v| v.is_finite()).ok_or_else(|| "must be a number".to_owned())
}

fn positive(text: &str) -> Result<f32, String> {
    finite(text).ok().filter(|v| *v > 0.0).ok_or_else(|| "must be a number above 0".to_owned())
}

fn fov(text: &str) -> Result<f32, String> {
    finite(text).ok().filter(|v| (1.0..=170.0).contains(v)).ok_or_else(|| "must be 1 to 170 degrees".to_owned())
}

fn share(text: &str) -> Result<f32, String> {
    finite(text).ok().filter(|v| (0.0..=1.0).contains(v)).ok_or_else(|| "must be a number from 0 to 1".to_owned())
}

fn triple(text: &str) -> Result<Triple, String> {
    let values: Vec<f32> = text.split(',').map(|v| finite(v.trim())).collect::<Result<_, _>>()?;
    values
        .first_chunk::<3>()
        .filter(|_| values.len() == 3)
        .map(|v| Triple(*v))
        .ok_or_else(|| "must be three numbers: 1,2,3".to_owned())
}

fn size(text: &str) -> Result<(u32, u32), String> {
    let side = |v: &str| v.parse::<u32>().ok().filter(|v| (1..=32_767).contains(v));
    text.split_once('x')
        .and_then(|(w, h)| Some((side(w)?, side(h)?)))
        .ok_or_else(|| "must be a width and a height: 1280x720".to_owned())
}

fn hex(text: &str) -> Result<Color, String> {
    let digits = text.strip_prefix('#').unwrap_or(text);
    u32::from_str_radix(digits, 16)
        .ok()
        .filter(|_| digits.len() == 6)
        .map(|v| Color::from_rgb8((v >> 16) as u8, (v >> 8) as u8, v as u8))
        .ok_or_else(|| "must be six hexadecimal digits: FF8000".to_owned())
}

fn background(text: &str) -> Result<Color, String> {
    if text == "transparent" { Ok(Color::TRANSPARENT) } else { hex(text) }
}

pub(crate) fn run(arguments: &MeshArguments) -> Result<Outcome, Failure> {
    let started = Instant::now();
    let (mut scene, mut warnings, text) = load(arguments)?;
    let parsed = started.elapsed();
    let mut bounds = scene.bounds();
    if bounds.is_empty() {
        warnings.push("the models hold nothing to draw".to_owned());
        bounds = Aabb { min: [0.0; 3], max: [0.0; 3] };
    }
    let complain = |warning: &String| report::complain(&Failure::new(format!("warning: {warning}")).to_string());
    warnings.iter().for_each(complain);
    if arguments.info {
        report::print(text.as_bytes())?;
    }
    let output = match (&arguments.output, arguments.models.as_slice()) {
        (Some(output), _) => output.clone(),
        (None, _) if arguments.info => return Ok(Outcome::Done),
        (None, [model]) => model.with_extension("png"),
        (None, _) => return Err(Failure::new("several models make one picture; name it with -o FILE")),
    };
    let output = &output;
    prepare(&mut scene, arguments, &bounds);
    if let Some(filter) = arguments.filter {
        filter_textures(&mut scene, filter)?;
    }
    let settings = settings(arguments);
    let frames = arguments.turntable.unwrap_or(1);
    let (mut drawing, mut encoding) = (0.0, 0.0);
    let mut stats = SceneStats::default();
    for frame in 0..frames {
        let turn = frame as f32 / frames as f32 * 360.0;
        let camera = camera_for(arguments, &scene, &bounds, turn)?;
        if let Some(share) = arguments.fog {
            scene.fog = fog(&scene, &camera, &bounds, share, arguments.background);
        }
        let (width, height) = arguments.size;
        let start = Instant::now();
        let drawn = render_picture(&scene, &camera, width, height, &settings);
        let (picture, counted) = drawn.map_err(|error| Failure::new(error.to_string()))?;
        stats = counted;
        let invalid = stats.counters.invalid;
        if frame == 0 && invalid > 0 {
            warnings.push(format!("{invalid} primitives have corners that are not there or not numbers; left out"));
            warnings.last().into_iter().for_each(complain);
        }
        drawing += start.elapsed().as_secs_f64() * 1e3;
        let start = Instant::now();
        let path = if arguments.turntable.is_some() { numbered(output, frame) } else { output.clone() };
        save(&picture, &path)?;
        if let Some(path) = &arguments.depth_out {
            save_depths(&scene, &camera, arguments, &settings, path)?;
        }
        encoding += start.elapsed().as_secs_f64() * 1e3;
    }
    if arguments.timings.is_some() {
        let line = format!(
            "{{\"output\":{},\"width\":{},\"height\":{},\"frames\":{frames},\"triangles\":{},\"fragments\":{},\"parse_ms\":{:.3},\"draw_ms\":{drawing:.3},\"encode_ms\":{encoding:.3},\"warnings\":{}}}\n",
            json::string(&output.display().to_string()),
            arguments.size.0,
            arguments.size.1,
            stats.counters.primitives,
            stats.counters.fragments,
            parsed.as_secs_f64() * 1e3,
            json::strings(warnings.iter().map(String::as_str)),
        );
        if is_standard_output(output.as_os_str()) {
            eprint!("{line}");
        } else {
            report::print(line.as_bytes())?;
        }
    }
    Ok(Outcome::Done)
}

/// All models in one scene, what was left out, and what `--info` prints.
fn load(arguments: &MeshArguments) -> Result<(Scene, Vec<String>, String), Failure> {
    let (mut whole, mut warnings, mut text) = (Scene::new(), Vec::new(), String::new());
    for path in &arguments.models {
        let model = Model::load(path).map_err(|error| match error {
            rastrum::Error::Io { path, source } => {
                Failure::new(format!("{}: {}", path.display(), report::why_unread(&source)))
            }
            other => Failure::new(other.to_string()),
        })?;
        let scene = model.scene;
        let bounds = scene.bounds();
        let triangles: usize = scene.meshes.iter().map(|mesh| mesh.triangles().len()).sum();
        let vertices: usize = scene.meshes.iter().map(|mesh| mesh.vertices.len()).sum();
        let textures = scene.materials.iter().filter(|material| material.texture.is_some()).count();
        text.push_str(&format!(
            "{}: {} nodes, {} meshes, {vertices} vertices, {triangles} triangles, {} materials, {textures} with textures, \
             {} cameras, {}\n",
            path.display(),
            scene.nodes.len(),
            scene.meshes.len(),
            scene.materials.len(),
            scene.cameras.len(),
            if bounds.is_empty() { "no box".to_owned() } else { format!("box {:?} to {:?}", bounds.min, bounds.max) },
        ));
        warnings.extend(model.warnings.into_iter().map(|warning| format!("{}: {warning}", path.display())));
        append(&mut whole, scene);
    }
    Ok((whole, warnings, text))
}

/// Adds a scene to another, its numbers shifted.
fn append(whole: &mut Scene, mut part: Scene) {
    let (nodes, meshes, materials) = (whole.nodes.len(), whole.meshes.len(), whole.materials.len());
    for node in &mut part.nodes {
        node.meshes.iter_mut().for_each(|mesh| *mesh += meshes);
        node.children.iter_mut().for_each(|child| *child += nodes);
    }
    for mesh in &mut part.meshes {
        mesh.material += materials;
    }
    whole.roots.extend(part.roots.iter().map(|root| root + nodes));
    whole.nodes.extend(part.nodes);
    whole.meshes.extend(part.meshes);
    whole.materials.extend(part.materials);
    whole.cameras.extend(part.cameras);
}

/// The up axis as a direction.
fn up_of(arguments: &MeshArguments) -> [f32; 3] {
    match (arguments.up, arguments.up_axis) {
        (Some(up), _) => up.0,
        (None, Axis::X) => [1.0, 0.0, 0.0],
        (None, Axis::Y) => [0.0, 1.0, 0.0],
        (None, Axis::Z) => [0.0, 0.0, 1.0],
    }
}

/// Gives all textures one filter; materials that share a texture share it still.
fn filter_textures(scene: &mut Scene, filter: TextureFilter) -> Result<(), Failure> {
    let filter = match filter {
        TextureFilter::Nearest => Filter::Nearest,
        TextureFilter::Bilinear => Filter::Bilinear,
        TextureFilter::Trilinear => Filter::Trilinear,
    };
    let mut done: Vec<(Arc<Texture>, Arc<Texture>)> = Vec::new();
    for texture in scene.materials.iter_mut().filter_map(|material| material.texture.as_mut()) {
        if let Some((_, filtered)) = done.iter().find(|(before, _)| Arc::ptr_eq(before, texture)) {
            *texture = Arc::clone(filtered);
            continue;
        }
        let filtered = Arc::new(texture.with_filter(filter).map_err(|error| Failure::new(error.to_string()))?);
        done.push((std::mem::replace(texture, Arc::clone(&filtered)), filtered));
    }
    Ok(())
}

/// Lights, overridden materials, grid and axes; for ids, meshes in the order of their nodes' names.
fn prepare(scene: &mut Scene, arguments: &MeshArguments, bounds: &Aabb) {
    scene.ambient = arguments.ambient;
    let kind = LightKind::Directional(arguments.light.0);
    scene.lights.push(Light { kind, color: [1.0; 3], shadows: arguments.shadows });
    let phong = arguments.shading == Some(MeshShading::Phong);
    for material in &mut scene.materials {
        if let Some(color) = arguments.color {
            material.color = [color.r, color.g, color.b, material.color[3]];
        }
        if phong {
            (material.specular, material.shininess) = (0.5, 32);
        }
    }
    if arguments.shading == Some(MeshShading::Ids) {
        let mut world = scene.world_transforms();
        let name = |number: usize| scene.nodes.get(number).map(|node| node.name.clone()).unwrap_or_default();
        world.sort_by_key(|(number, _)| (name(*number), *number));
        let nodes = world
            .iter()
            .map(|(number, transform)| Node {
                name: name(*number),
                transform: *transform,
                meshes: scene.nodes.get(*number).map(|node| node.meshes.clone()).unwrap_or_default(),
                ..Node::default()
            })
            .collect();
        scene.nodes = nodes;
        scene.roots = (0..scene.nodes.len()).collect();
        return;
    }
    let radius = bounds.radius().max(1e-6);
    let center = bounds.center();
    let mut lines = Vec::new();
    if arguments.grid {
        let up = up_of(arguments);
        let axis = (0..3).max_by(|a, b| up[*a].abs().total_cmp(&up[*b].abs())).unwrap_or(1);
        let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
        for k in -10..=10 {
            let offset = k as f32 / 10.0 * radius * 2.0;
            for (along, across) in [(i, j), (j, i)] {
                let end = |sign: f32| {
                    let mut p = center;
                    p[axis] = if up[axis] < 0.0 { bounds.max[axis] } else { bounds.min[axis] };
                    p[along] += sign * radius * 2.0;
                    p[across] += offset;
                    p
                };
                lines.push((end(-1.0), end(1.0), [0.5, 0.5, 0.5, 1.0]));
            }
        }
    }
    if arguments.axes {
        for axis in 0..3 {
            let (mut end, mut color) = ([0.0; 3], [0.1, 0.1, 0.1, 1.0]);
            end[axis] = radius * 1.2;
            color[axis] = 0.9;
            lines.push(([0.0; 3], end, color));
        }
    }
    if !lines.is_empty() {
        let material = Material { shading: Shading::Unlit, color: [1.0; 4], ..Material::default() };
        let material = scene.add_material(material);
        let vertices: Vec<MeshVertex> = lines
            .iter()
            .flat_map(|(a, b, color)| {
                [*a, *b].map(|position| MeshVertex { position, color: *color, ..MeshVertex::default() })
            })
            .collect();
        let indices = (0..vertices.len() as u32).collect();
        scene.add_mesh("lines", Mesh { vertices, indices, topology: Topology::Lines, material }, Mat4::IDENTITY);
    }
}

fn settings(arguments: &MeshArguments) -> SceneSettings {
    let (look, shading) = match arguments.shading {
        None => (Look::Materials, None),
        Some(MeshShading::Flat) => (Look::Materials, Some(Shading::Flat)),
        Some(MeshShading::Gouraud) => (Look::Materials, Some(Shading::Gouraud)),
        Some(MeshShading::Phong) => (Look::Materials, Some(Shading::Phong)),
        Some(MeshShading::Pbr) => (Look::Materials, Some(Shading::Pbr)),
        Some(MeshShading::Unlit) => (Look::Materials, Some(Shading::Unlit)),
        Some(MeshShading::Normals) => (Look::Normals, None),
        Some(MeshShading::Depth) => (Look::Depth, None),
        Some(MeshShading::Ids) => (Look::Ids, None),
    };
    SceneSettings {
        look,
        shading,
        textures: !arguments.no_textures,
        cull: arguments.cull.map(|cull| match cull {
            MeshCull::None => Cull::None,
            MeshCull::Back => Cull::Back,
            MeshCull::Front => Cull::Front,
        }),
        fill: match (arguments.wireframe, arguments.points) {
            (true, _) => Fill::Wireframe,
            (_, true) => Fill::Points,
            _ => Fill::Solid,
        },
        antialias: match arguments.aa {
            Smoothing::None => SceneAntialias::None,
            Smoothing::Fxaa => SceneAntialias::Fxaa,
            Smoothing::Ssaa2 => SceneAntialias::Supersample(2),
            Smoothing::Msaa4 => SceneAntialias::Samples(Samples::Msaa4),
            Smoothing::Msaa8 => SceneAntialias::Samples(Samples::Msaa8),
        },
        background: arguments.background,
        threads: arguments.threads,
        ..SceneSettings::default()
    }
}

/// The camera of a frame, `turn` degrees around the up axis.
fn camera_for(arguments: &MeshArguments, scene: &Scene, bounds: &Aabb, turn: f32) -> Result<Camera, Failure> {
    let up = up_of(arguments);
    let (center, radius) = (bounds.center(), bounds.radius().max(1e-6));
    let aspect = arguments.size.0 as f32 / arguments.size.1 as f32;
    let fov = arguments.fov.unwrap_or(45.0).to_radians();
    let at = arguments.at.map_or(center, |at| at.0);
    let planes = arguments.near.is_some() && arguments.far.is_some();
    let given = (arguments.eye.is_some() && planes) || (arguments.camera.is_some() && !arguments.ortho);
    if radius > LARGEST && !given {
        return Err(Failure::new(format!(
            "the scene reaches {radius:e} from its middle, and a camera is found for no more than {LARGEST:e}: give --eye, --at, --near and --far, or scale the model"
        )));
    }
    let mut camera = if let Some(number) = arguments.camera {
        let count = scene.cameras.len();
        let found = scene.cameras.get(number).map(|(_, camera)| *camera);
        let mut camera =
            found.ok_or_else(|| Failure::new(format!("there is no camera {number}: the files have {count}")))?;
        if let (Some(fov), Projection::Perspective(_)) = (arguments.fov, camera.projection) {
            camera.projection = Projection::Perspective(fov.to_radians());
        }
        camera
    } else {
        let eye = arguments.eye.map_or_else(|| framed(arguments, up, at, bounds, fov, aspect), |eye| eye.0);
        Camera { projection: Projection::Perspective(fov), ..Camera::look_at(eye, at, up) }
    };
    if turn != 0.0 {
        // The scene turns, which is the camera going around the other way.
        let there = camera::translation(center.map(|v| -v));
        let round = camera::product(&camera::rotation(up, turn.to_radians()), &there);
        camera.view = camera::product(&camera.view, &camera::product(&camera::translation(center), &round));
    }
    if arguments.ortho {
        let eye = camera.eye();
        let d: [f32; 3] = std::array::from_fn(|i| at[i] - eye[i]);
        let distance = (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]).sqrt();
        // 1 / tan of the half angle is an entry of the matrix.
        let scale = camera::perspective(fov, 1.0, 0.1, 1.0).to_cols_array_2d()[1][1];
        camera.projection = Projection::Orthographic((2.0 * distance / scale).max(1e-6));
    }
    // Planes around the scene's box, and the lines', unless they were given.
    if arguments.camera.is_none() || arguments.ortho {
        let away = |[x, y, z]: [f32; 3]| -camera::transform(&camera.view, [x, y, z, 1.0])[2];
        let depths = bounds.corners().map(away);
        let mut nearest = depths.iter().fold(f32::INFINITY, |nearest, depth| nearest.min(*depth)) - radius * 0.01;
        let mut farthest = depths.iter().fold(f32::NEG_INFINITY, |far, depth| far.max(*depth)) + radius * 0.01;
        if arguments.grid || arguments.axes {
            (nearest, farthest) = (nearest.min(away(center) - radius * 3.0), farthest.max(away(center) + radius * 3.0));
        }
        camera.far = farthest.max(radius * 0.01);
        // Parallel projection sees what is behind the camera, too.
        camera.near = if arguments.ortho { nearest } else { nearest.max(camera.far * 1e-3) };
    }
    camera.near = arguments.near.unwrap_or(camera.near);
    camera.far = arguments.far.unwrap_or(camera.far);
    if camera.near >= camera.far {
        return Err(Failure::new(format!("--near ({}) must be less than --far ({})", camera.near, camera.far)));
    }
    Ok(camera)
}

/// Room between the scene and the picture's border.
const MARGIN: f32 = 1.05;

/// How far a scene may reach from its middle, so that squares and products of distances are numbers.
const LARGEST: f32 = 1e15;

/// Where the camera stands so that the scene's box just fits the picture; on turntables, whatever the turn.
fn framed(arguments: &MeshArguments, up: [f32; 3], at: [f32; 3], bounds: &Aabb, fov: f32, aspect: f32) -> [f32; 3] {
    let (azimuth, elevation) = match arguments.view {
        View::Front => (0.0, 0.0),
        View::Right => (90.0, 0.0),
        View::Back => (180.0, 0.0),
        View::Left => (-90.0, 0.0),
        View::Top => (0.0, 90.0),
        View::Bottom => (0.0, -90.0),
        View::Iso => (45.0, 35.264_39),
    };
    // 90 degrees would leave "up" along the view: a hair less keeps it in the picture.
    let elevation = arguments.elevation.unwrap_or(elevation).clamp(-89.99, 89.99);
    let azimuth = arguments.azimuth.unwrap_or(azimuth);
    // The front is +z where y is up, −y where z is up, and +z where x is up.
    let (front, axis) = match arguments.up_axis {
        Axis::Z if arguments.up.is_none() => ([0.0, -1.0, 0.0], up),
        _ => ([0.0, 0.0, 1.0], up),
    };
    let side = {
        let c = [
            axis[1] * front[2] - axis[2] * front[1],
            axis[2] * front[0] - axis[0] * front[2],
            axis[0] * front[1] - axis[1] * front[0],
        ];
        if c.iter().any(|v| *v != 0.0) { c } else { [1.0, 0.0, 0.0] }
    };
    let turn = camera::product(
        &camera::rotation(axis, azimuth.to_radians()),
        &camera::rotation(side, -elevation.to_radians()),
    );
    let [x, y, z, _] = camera::transform(&turn, [front[0], front[1], front[2], 0.0]);
    let scale = camera::perspective(fov, 1.0, 0.1, 1.0).to_cols_array_2d()[1][1];
    let (vertical, horizontal) = (1.0 / scale, aspect / scale);
    let distance = if arguments.turntable.is_some() {
        // The ball around the box: its radius is the distance times the sine of the half angle.
        let tangent = vertical.min(horizontal);
        let from_middle = [0, 1, 2].map(|i| at[i] - bounds.center()[i]);
        let off = from_middle.iter().map(|v| v * v).sum::<f32>().sqrt();
        (bounds.radius() + off) / (tangent / (1.0 + tangent * tangent).sqrt())
    } else {
        // Each corner asks for a distance at which it is on the picture's border.
        let view = camera::look_at([at[0] + x, at[1] + y, at[2] + z], at, up);
        let corners = bounds.corners().map(|[x, y, z]| camera::transform(&view, [x, y, z, 1.0]));
        corners.iter().fold(0.0, |distance: f32, [x, y, z, _]| {
            let towards = if arguments.ortho { 0.0 } else { z + 1.0 };
            distance.max(towards + x.abs() / horizontal).max(towards + y.abs() / vertical)
        })
    };
    let distance = (distance * MARGIN).max(1e-6);
    [at[0] + x * distance, at[1] + y * distance, at[2] + z * distance]
}

/// Linear fog that leaves 1 − `share` of the scene's farthest part.
fn fog(_: &Scene, camera: &Camera, bounds: &Aabb, share: f32, color: Color) -> Option<Fog> {
    let ([x, y, z], radius) = (bounds.center(), bounds.radius());
    let middle = -camera::transform(&camera.view, [x, y, z, 1.0])[2];
    let (start, last) = (middle - radius, middle + radius);
    let kind = FogKind::Linear { start, end: start + (last - start) / share.max(1e-3) };
    (share > 0.0 && last > start).then_some(Fog { kind, color: [color.r, color.g, color.b] })
}

/// The name of a turntable's frame.
fn numbered(output: &Path, frame: u32) -> PathBuf {
    let stem = output.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
    let ending = output.extension().map_or_else(|| "png".to_owned(), |e| e.to_string_lossy().into_owned());
    output.with_file_name(format!("{stem}-{frame:03}.{ending}"))
}

/// Draws the scene's depths, and writes them.
fn save_depths(
    scene: &Scene,
    camera: &Camera,
    arguments: &MeshArguments,
    settings: &SceneSettings,
    path: &Path,
) -> Result<(), Failure> {
    let (width, height) = arguments.size;
    let mut target = Target::new(width, height).map_err(|error| Failure::new(error.to_string()))?;
    draw_scene(scene, camera, &mut target, &Viewport::new(width, height), settings)
        .map_err(|error| Failure::new(error.to_string()))?;
    let bytes = depth_file::encode(path, width, height, &target.depths());
    write_whole(path, &bytes).map_err(|error| Failure::new(format!("{}: {error}", path.display())))
}

fn save(picture: &Pixmap, path: &Path) -> Result<(), Failure> {
    if is_standard_output(path.as_os_str()) {
        let bytes = picture.encode_png().map_err(|error| Failure::new(error.to_string()))?;
        return report::print(&bytes);
    }
    picture.save_png(path).map_err(|error| Failure::new(error.to_string()))
}
