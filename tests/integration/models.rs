//! Model files that are broken, hostile or incomplete: pixels or one clear error, within bounds of memory.

use std::fs;
use std::path::PathBuf;

use rastrum::load::{Model, ModelFormat};
use rastrum::scene::{Camera, SceneSettings, render_picture};

/// A folder of its own for each test, gone afterwards.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("rastrum-models-{name}-{}", std::process::id()));
        fs::create_dir_all(&path).unwrap();
        Self(path)
    }

    fn write(&self, name: &str, bytes: impl AsRef<[u8]>) -> PathBuf {
        let path = self.0.join(name);
        fs::write(&path, bytes).unwrap();
        path
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// The pixels that a model, seen from the front, covers of 32 × 32.
fn seen(model: &Model) -> usize {
    let camera = Camera::look_at([0.0, 0.0, 3.0], [0.0; 3], [0.0, 1.0, 0.0]);
    let (picture, _) = render_picture(&model.scene, &camera, 32, 32, &SceneSettings::default()).unwrap();
    picture.data().as_chunks::<4>().0.iter().filter(|pixel| pixel[3] != 0).count()
}

fn base64(bytes: &[u8]) -> String {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut out = String::new();
    for chunk in bytes.chunks(3) {
        let value = chunk.iter().fold(0_u32, |value, byte| value << 8 | u32::from(*byte)) << (8 * (3 - chunk.len()));
        let digits = (0..4).map(|i| char::from(DIGITS[(value >> (18 - 6 * i) & 63) as usize]));
        out.extend(digits.take(chunk.len() + 1));
        out.extend(std::iter::repeat_n('=', 3 - chunk.len()));
    }
    out
}

/// A glTF file of one triangle in the plane z = 0; `change` may break its text.
fn triangle(change: impl Fn(String) -> String) -> Vec<u8> {
    let corners = [[-1.0_f32, -1.0, 0.0], [1.0, -1.0, 0.0], [0.0, 1.0, 0.0]];
    let uv = [[0.0_f32, 1.0], [1.0, 1.0], [0.5, 0.0]];
    let floats = corners.iter().flatten().chain(uv.iter().flatten());
    let bytes: Vec<u8> = floats.flat_map(|v| v.to_le_bytes()).collect();
    let text = format!(
        r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0}}],
        "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0,"TEXCOORD_0":1}},"material":0}}]}}],
        "materials":[{{"pbrMetallicRoughness":{{"baseColorTexture":{{"index":0}}}}}}],
        "textures":[{{"source":0}}],"images":[{{"uri":"gone.png"}}],
        "accessors":[{{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[-1,-1,0],"max":[1,1,0]}},
        {{"bufferView":1,"componentType":5126,"count":3,"type":"VEC2"}}],
        "bufferViews":[{{"buffer":0,"byteOffset":0,"byteLength":36}},{{"buffer":0,"byteOffset":36,"byteLength":24}}],
        "buffers":[{{"byteLength":60,"uri":"data:application/octet-stream;base64,{}"}}]}}"#,
        base64(&bytes)
    );
    change(text).into_bytes()
}

fn gltf(change: impl Fn(String) -> String) -> rastrum::Result<Model> {
    let folder = Folder::new("gltf");
    let model = Model::decode(&triangle(change), ModelFormat::Gltf, Some(&folder.0));
    drop(folder);
    model
}

#[test]
fn a_missing_texture_is_a_warning_and_the_mesh_is_drawn_without_it() {
    let model = gltf(|text| text).unwrap();
    assert!(model.warnings.iter().any(|warning| warning.contains("gone.png")), "{:?}", model.warnings);
    assert!(model.scene.materials.iter().all(|material| material.texture.is_none()));
    assert!(seen(&model) > 100);

    let folder = Folder::new("obj");
    folder.write("a.mtl", "newmtl m\nKd 1 0 0\nmap_Kd gone.png\n");
    let obj = "mtllib a.mtl\nusemtl m\nv -1 -1 0\nv 1 -1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n";
    let model = Model::load(folder.write("a.obj", obj)).unwrap();
    assert!(model.warnings.iter().any(|warning| warning.contains("gone.png")), "{:?}", model.warnings);
    assert!(seen(&model) > 100);
    // Without the MTL, too.
    let model = Model::load(folder.write("b.obj", obj.replace("a.mtl", "b.mtl"))).unwrap();
    assert!(!model.warnings.is_empty() && seen(&model) > 100);
}

#[test]
fn textures_of_no_pixels_are_left_out() {
    // PNG headers that claim 0 × 0, 0 × 5 and 5 × 0 pixels; a JPEG and a PNG that end at once.
    let header = |width: u32, height: u32| {
        let mut bytes = b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR".to_vec();
        bytes.extend(width.to_be_bytes());
        bytes.extend(height.to_be_bytes());
        bytes.extend([8, 6, 0, 0, 0, 0, 0, 0, 0]);
        bytes
    };
    for image in [header(0, 0), header(0, 5), header(5, 0), b"\xff\xd8\xff".to_vec(), b"\x89PNG".to_vec(), Vec::new()] {
        let uri = format!("data:image/png;base64,{}", base64(&image));
        let model = gltf(|text| text.replace("gone.png", &uri)).unwrap();
        assert!(!model.warnings.is_empty(), "{image:?}");
        assert!(model.scene.materials.iter().all(|material| material.texture.is_none()) && seen(&model) > 100);
    }
}

#[test]
fn nodes_that_hold_one_another_are_drawn_once_or_refused() {
    for nodes in [
        r#""nodes":[{"mesh":0,"children":[1]},{"children":[0]}]"#,
        r#""nodes":[{"mesh":0,"children":[0]}]"#,
        r#""nodes":[{"mesh":0,"children":[1,1]},{"mesh":0}]"#,
        r#""nodes":[{"children":[1]},{"children":[2]},{"mesh":0,"children":[1]}]"#,
    ] {
        match gltf(|text| text.replace(r#""nodes":[{"mesh":0}]"#, nodes)) {
            Ok(model) => assert!(seen(&model) > 100 && model.scene.world_transforms().len() <= 3, "{nodes}"),
            Err(error) => assert!(error.to_string().len() > 10, "{nodes}"),
        }
    }
}

#[test]
fn accessors_and_views_beyond_their_buffer_are_one_error() {
    for (from, to) in [
        (r#""count":3,"type":"VEC3""#, r#""count":4,"type":"VEC3""#),
        (r#""count":3,"type":"VEC3""#, r#""count":4294967295,"type":"VEC3""#),
        (r#""count":3,"type":"VEC3""#, r#""count":9223372036854775807,"type":"VEC3""#),
        (r#""byteOffset":0,"byteLength":36"#, r#""byteOffset":60,"byteLength":36"#),
        (r#""byteOffset":0,"byteLength":36"#, r#""byteOffset":18446744073709551600,"byteLength":36"#),
        (r#""bufferView":0"#, r#""bufferView":9"#),
        (r#""POSITION":0"#, r#""POSITION":7"#),
        (r#""byteLength":60"#, r#""byteLength":600"#),
        (r#""bufferViews":[{"buffer":0,"#, r#""bufferViews":[{"buffer":5,"#),
        ("data:application/octet-stream;base64,", "data:application/octet-stream;base64,?"),
        ("data:application/octet-stream;base64,", "gone-"),
    ] {
        match gltf(|text| text.replacen(from, to, 1)) {
            Ok(model) => assert_eq!(seen(&model), 0, "{to} was drawn"),
            Err(error) => {
                let text = error.to_string();
                assert!(text.len() > 10 && !text.contains('\n'), "{to}: {text}");
            }
        }
    }
}

/// A binary STL of `held` facets that claims `claimed`.
fn stl(claimed: u32, held: usize) -> Vec<u8> {
    let mut bytes = vec![b' '; 80];
    bytes.extend(claimed.to_le_bytes());
    // Many large ones would take a minute to draw over each other.
    let side = if held == 1 { 2.0 } else { 0.01 };
    for i in 0..held {
        let at = i as f32 / held.max(1) as f32 - 0.5;
        let corners = [0.0, 0.0, 1.0, at, -1.0, 0.0, at + 0.2 * side, -1.0, 0.0, at, side - 1.0, 0.1_f32];
        bytes.extend(corners.iter().flat_map(|v| v.to_le_bytes()));
        bytes.extend([0, 0]);
    }
    bytes
}

#[test]
fn an_stl_that_claims_four_billion_facets_is_one_error() {
    let decode = |bytes: &[u8]| Model::decode(bytes, ModelFormat::Stl, None);
    assert!(seen(&decode(&stl(1, 1)).unwrap()) > 10);
    for bytes in [stl(u32::MAX, 1), stl(u32::MAX, 0), stl(2, 1), Vec::new(), vec![0; 83], b"solid".to_vec()] {
        if let Ok(model) = decode(&bytes) {
            assert_eq!(seen(&model), 0);
        }
    }
    assert!(decode(&stl(u32::MAX, 1)).unwrap_err().to_string().contains("claims 4294967295 facets"));
    // One whose header begins as a text does.
    let mut bytes = stl(u32::MAX, 1);
    bytes[..5].copy_from_slice(b"solid");
    assert!(decode(&bytes).is_err() || decode(&bytes).is_ok_and(|model| seen(&model) == 0));
}

/// Runs `rastrum mesh` within 64 times the file's size, the targets, and what the program itself takes.
#[cfg(all(feature = "cli", target_os = "linux"))]
fn within_bounds(path: &std::path::Path) -> std::process::Output {
    let size = fs::metadata(path).unwrap().len();
    // 1280 × 720 pixels of colour, depth and the picture; the program, its libraries and heaps take no more than 256 MiB of addresses.
    let kilobytes = (size * 64 + 1280 * 720 * 16) / 1024 + (256 << 10);
    let script = format!("ulimit -v {kilobytes} && exec \"$0\" mesh \"$1\" -o \"$1.png\" --threads 1");
    let program = env!("CARGO_BIN_EXE_rastrum");
    std::process::Command::new("sh").args(["-c", &script, program]).arg(path).output().unwrap()
}

/// As many primitives as asked for, each of all of the same triangles.
fn shared(primitives: usize, vertices: usize, kind: &str, component: u32) -> Vec<u8> {
    let positions = (0..vertices).flat_map(|i| [(i % 100) as f32, (i / 100) as f32, 0.0]);
    let mut bytes: Vec<u8> = positions.flat_map(f32::to_le_bytes).collect();
    let views = format!(
        r#"{{"buffer":0,"byteLength":{}}},{{"buffer":0,"byteOffset":{},"byteLength":{}}}"#,
        bytes.len(),
        bytes.len(),
        4 * vertices
    );
    bytes.extend((0..vertices as u32).flat_map(u32::to_le_bytes));
    let part = vec![r#"{"attributes":{"POSITION":0},"indices":1}"#; primitives].join(",");
    format!(
        r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0}}],"meshes":[{{"primitives":[{part}]}}],
        "accessors":[{{"bufferView":0,"componentType":5126,"count":{vertices},"type":"VEC3","min":[0,0,0],"max":[99,9999,0]}},
        {{"bufferView":1,"componentType":{component},"count":{vertices},"type":"{kind}"}}],"bufferViews":[{views}],
        "buffers":[{{"byteLength":{},"uri":"data:application/octet-stream;base64,{}"}}]}}"#,
        bytes.len(),
        base64(&bytes)
    )
    .into_bytes()
}

#[test]
fn data_named_often_is_refused_and_parts_of_it_are_not() {
    let decode = |bytes: Vec<u8>| Model::decode(&bytes, ModelFormat::Gltf, None);
    let error = decode(shared(3_000, 30_000, "SCALAR", 5125)).unwrap_err();
    assert!(error.to_string().contains("64 times"), "{error}");
    assert!(decode(shared(20, 3_000, "SCALAR", 5125)).is_ok());
    for error in [decode(shared(1, 30, "SCALAR", 5126)).unwrap_err(), decode(shared(1, 15, "VEC2", 5123)).unwrap_err()]
    {
        assert!(error.to_string().contains("indices must be unsigned integers"), "{error}");
    }
    // Indices of a part: three of 3,000 vertices are kept.
    let part = String::from_utf8(shared(2_000, 3_000, "SCALAR", 5125)).unwrap();
    let part = part.replace(r#""componentType":5125,"count":3000"#, r#""componentType":5125,"count":3"#);
    let model = decode(part.into_bytes()).unwrap();
    assert_eq!(model.scene.meshes.len(), 2_000);
    for mesh in &model.scene.meshes {
        let places: Vec<_> = mesh.triangles()[0].iter().map(|i| mesh.vertices[*i as usize].position).collect();
        assert_eq!((mesh.vertices.len(), places), (3, vec![[0.0; 3], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0]]));
    }
}

#[test]
fn indices_beyond_the_vertices_are_named_and_left_out() {
    for normals in ["", r#","NORMAL":0"#] {
        let text = String::from_utf8(shared(1, 30, "SCALAR", 5125)).unwrap();
        // Positions, and normals where there are any, of 27 of the 30 vertices.
        let text = text.replace(r#""componentType":5126,"count":30"#, r#""componentType":5126,"count":27"#);
        let text = text.replace(r#""POSITION":0"#, &format!(r#""POSITION":0{normals}"#));
        let model = Model::decode(text.as_bytes(), ModelFormat::Gltf, None).unwrap();
        assert!(model.warnings.iter().any(|w| w.starts_with("3 indices")), "{:?}", model.warnings);
        let mesh = &model.scene.meshes[0];
        // The last of ten triangles: left out, or without an area.
        assert_eq!(mesh.indices.len(), 30);
        let corner = |i: u32| mesh.vertices.get(i as usize).map(|v| v.position);
        let places: Vec<_> = mesh.indices[27..].iter().map(|i| corner(*i)).collect();
        assert!(places.iter().all(|place| *place == places[0]), "{places:?}");
    }
}

#[test]
fn pictures_named_often_are_decoded_once() {
    let model = gltf(|text| {
        let texture = format!("[{}]", vec![r#"{"source":0}"#; 500].join(","));
        let material = (0..500)
            .map(|i| format!(r#"{{"pbrMetallicRoughness":{{"baseColorTexture":{{"index":{i}}}}}}}"#))
            .collect::<Vec<_>>()
            .join(",");
        let png = rastrum::Pixmap::new(1024, 1024).unwrap().encode_png().unwrap();
        text.replace(r#"[{"source":0}]"#, &texture)
            .replace(r#"{"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}"#, &material)
            .replace("gone.png", &format!("data:image/png;base64,{}", base64(&png)))
    })
    .unwrap();
    let textures: Vec<_> = model.scene.materials.iter().filter_map(|m| m.texture.as_ref()).collect();
    assert_eq!((model.warnings, textures.len()), (vec![], 500));
    assert!(textures.iter().all(|texture| std::sync::Arc::ptr_eq(texture, textures[0])));
}

/// A PNG of one colour.
fn flat_png(side: u32, red: u8) -> Vec<u8> {
    let data = [red, 0, 0, 255].repeat((side * side) as usize);
    rastrum::Pixmap::from_straight(side, side, data).unwrap().encode_png().unwrap()
}

/// The triangle with so many textures, each with a material, of so many images.
fn textured(textures: &str, images: &str, count: usize) -> Vec<u8> {
    let materials = (0..count).map(|i| format!(r#"{{"pbrMetallicRoughness":{{"baseColorTexture":{{"index":{i}}}}}}}"#));
    let materials = materials.collect::<Vec<_>>().join(",");
    triangle(|text| {
        text.replace(r#"[{"source":0}]"#, &format!("[{textures}]"))
            .replace(r#"{"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}"#, &materials)
            .replace(r#"{"uri":"gone.png"}"#, images)
    })
}

fn list(count: usize, item: impl Fn(usize) -> String) -> String {
    (0..count).map(item).collect::<Vec<_>>().join(",")
}

#[test]
fn textures_share_their_pictures_and_become_smaller_where_memory_ends() {
    let folder = Folder::new("textures");
    folder.write("a.png", flat_png(1024, 9));
    folder.write("b.png", flat_png(2048, 200));
    let load = |name: &str, bytes: Vec<u8>| Model::load(folder.write(name, bytes)).unwrap();
    let textures =
        |model: &Model| -> Vec<_> { model.scene.materials.iter().filter_map(|m| m.texture.clone()).collect() };
    // Forty images of one file.
    let images = list(40, |_| r#"{"uri":"a.png"}"#.to_owned());
    let model = load("same.gltf", textured(&list(40, |i| format!(r#"{{"source":{i}}}"#)), &images, 40));
    let same = textures(&model);
    assert_eq!((model.warnings, same.len()), (vec![], 40));
    assert!(same.iter().all(|texture| std::sync::Arc::ptr_eq(texture, &same[0]) && texture.size() == [1024, 1024, 1]));
    // The same picture with and without mipmaps are two textures. Each of these takes 43 or 32 MiB, of 64.
    let samplers = r#""samplers":[{"minFilter":9987},{"minFilter":9729}],"textures""#;
    let two = textured(r#"{"source":0,"sampler":0},{"source":0,"sampler":1}"#, r#"{"uri":"b.png"}"#, 2);
    let model = load("two.gltf", String::from_utf8(two).unwrap().replace(r#""textures""#, samplers).into_bytes());
    let two = textures(&model);
    assert_eq!(two.iter().map(|texture| texture.size()[0]).collect::<Vec<_>>(), [2048, 1024]);
    assert_eq!(two.iter().map(|texture| texture.levels()).collect::<Vec<_>>(), [12, 1]);
    assert_eq!(two[1].texel(0, 5, 7, 0), Some(0xff00_00c8));
    assert_eq!(model.warnings.len(), 1);
    let (begin, end) = ("texture 1 of 2048 × 2048 texels", "it is made 1024 × 1024");
    assert!(model.warnings[0].starts_with(begin) && model.warnings[0].ends_with(end), "{:?}", model.warnings);
    // OBJ the same.
    folder.write("c.mtl", "newmtl m\nmap_Kd b.png\nnewmtl n\nmap_Kd a.png\nnewmtl o\nmap_Kd b.png\n".repeat(3));
    let obj = "mtllib c.mtl\nmtllib c.mtl\nusemtl m\nv -1 -1 0\nv 1 -1 0\nv 0 1 0\nf 1 2 3\n";
    let model = load("c.obj", obj.as_bytes().to_vec());
    let found = textures(&model);
    assert_eq!((model.warnings, found.len()), (vec![], 9));
    assert!(std::sync::Arc::ptr_eq(&found[0], &found[8]) && std::sync::Arc::ptr_eq(&found[1], &found[7]));
}

#[test]
fn extras_may_be_anything() {
    for extras in ["[1,2]", "\"text\"", "{\"a\":[{}]}", "3"] {
        let model =
            gltf(|text| text.replace(r#""asset":{"#, &format!(r#""extras":{extras},"asset":{{"extras":{extras},"#)));
        assert!(seen(&model.unwrap()) > 100, "{extras}");
    }
}

#[test]
#[cfg(all(feature = "cli", target_os = "linux"))]
fn memory_is_bounded_by_the_files_size() {
    let folder = Folder::new("memory");
    let vertices = |n: usize| (0..n).map(|i| format!("{} {} 0\n", i % 100, i / 100)).collect::<String>();
    let ply = |claimed: u64, n: usize| {
        let rest = "property float x\nproperty float y\nproperty float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n";
        format!("ply\nformat ascii 1.0\nelement vertex {claimed}\n{rest}{}3 0 1 100\n", vertices(n))
    };
    let obj = |n: usize| {
        (0..n).map(|i| format!("v {} {} 0\n", i % 300, i / 300)).collect::<String>()
            + &(1..n - 301).map(|i| format!("f {} {} {}\n", i, i + 1, i + 300)).collect::<String>()
    };
    let large = [
        ("large.stl", stl(150_000, 150_000)),
        ("large.obj", obj(60_000).into_bytes()),
        ("large.ply", ply(60_000, 60_000).into_bytes()),
    ];
    for (name, bytes) in large {
        let output = within_bounds(&folder.write(name, bytes));
        assert!(output.status.success(), "{name}: {output:?}");
    }
    let count = |text: String| text.replace(r#""count":3,"#, r#""count":4000000000,"#);
    let buffers = list(50, |_| r#"{"byteLength":60,"uri":"a.bin"}"#.to_owned());
    let nodes = ",{}".repeat(1_000_000);
    let hostile = [
        ("claims.stl", stl(u32::MAX, 10)),
        ("claims.ply", ply(4_000_000_000, 200).into_bytes()),
        ("claims.gltf", triangle(count)),
        ("fan.obj", format!("v 0 0 0\nv 1 0 0\nv 0 1 0\nf {}\n", "1 2 3 ".repeat(2_000)).into_bytes()),
        ("shared.gltf", shared(3_000, 30_000, "SCALAR", 5125)),
        ("huge.gltf", triangle(|text| text.replace(r#""byteLength":60"#, r#""byteLength":6000000000"#))),
        (
            "pictures.gltf",
            textured(&list(8, |i| format!(r#"{{"source":{i}}}"#)), &list(8, |i| format!(r#"{{"uri":"{i}.png"}}"#)), 8),
        ),
        ("large_picture.gltf", triangle(|text| text.replace("gone.png", "8.png"))),
        ("buffers.gltf", triangle(|text| text.replace(r#""buffers":["#, &format!(r#""buffers":[{},"#, buffers)))),
        (
            "nodes.gltf",
            triangle(|text| text.replace(r#""nodes":[{"mesh":0}"#, &format!(r#""nodes":[{{"mesh":0}}{nodes}"#))),
        ),
        ("objects.obj", format!("v 0 0 0\nv 1 0 0\nv 0 1 0\n{}", "o a\nf 1 2 3\n".repeat(400_000)).into_bytes()),
        (
            "indented_objects.obj",
            format!("v 0 0 0\nv 1 0 0\nv 0 1 0\n{}", " o a\nf 1 2 3\n".repeat(400_000)).into_bytes(),
        ),
        ("materials.obj", format!("{}v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "mtllib a.mtl\n".repeat(20)).into_bytes()),
    ];
    for i in 0..8 {
        folder.write(&format!("{i}.png"), flat_png(2048, i));
    }
    folder.write("8.png", flat_png(4096, 8));
    folder.write("a.bin", vec![0; 8 << 20]);
    folder.write("a.mtl", "newmtl a\n".repeat(50_000));
    for (name, bytes) in hostile {
        let output = within_bounds(&folder.write(name, bytes));
        // Pixels, or one line.
        let text = String::from_utf8_lossy(&output.stderr);
        assert!(matches!(output.status.code(), Some(0 | 2)) && text.lines().count() <= 8, "{name}: {output:?}");
        assert!(!text.contains("panicked") && !text.contains("memory allocation"), "{name}: {text}");
    }
}
