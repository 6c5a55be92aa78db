//! 3D scenes among 2D drawing, and models from bad files.

use rastrum::glam::Mat4;
use rastrum::scene::*;
use rastrum::space::*;
use rastrum::{BlendMode, Canvas, Color, ImagePaint, IntRect, Rect};

fn scene() -> (Scene, Camera) {
    let mut scene = Scene::new();
    let unlit = Material { shading: Shading::Unlit, color: [0.0, 1.0, 0.0, 1.0], ..Material::default() };
    let material = scene.add_material(unlit);
    scene.add_mesh("cube", Mesh::cuboid([-1.0; 3], [1.0; 3], material), Mat4::IDENTITY);
    (scene, Camera::look_at([0.0, 0.0, 5.0], [0.0; 3], [0.0, 1.0, 0.0]))
}

#[test]
fn a_scene_takes_its_turn_among_two_dimensional_drawing() {
    let (scene, camera) = scene();
    let mut canvas = Canvas::new(100, 100).unwrap();
    canvas.clear(Color::WHITE);
    canvas.fill_rect(Rect::from_xywh(0.0, 0.0, 100.0, 50.0), Color::RED);
    canvas.draw_scene(&scene, &camera, Rect::from_xywh(10.0, 20.0, 60.0, 60.0)).unwrap();
    canvas.fill_rect(Rect::from_xywh(38.0, 48.0, 4.0, 4.0), Color::BLUE);
    let picture = canvas.into_pixmap();
    assert_eq!(picture.pixel(40, 50), Some([0, 0, 255, 255]), "what comes after is above");
    assert_eq!(picture.pixel(36, 50), Some([0, 255, 0, 255]), "the scene");
    assert_eq!(picture.pixel(12, 22), Some([255, 0, 0, 255]), "where the scene is empty, what was before");
    assert_eq!(picture.pixel(12, 78), Some([255; 4]));
    // The very pixels of the scene drawn alone, where both are on the pixel grid.
    let settings = SceneSettings { antialias: SceneAntialias::Samples(Samples::Msaa4), ..SceneSettings::default() };
    let (alone, _) = render_picture(&scene, &camera, 60, 60, &settings).unwrap();
    let mut canvas = Canvas::new(100, 100).unwrap();
    canvas.draw_scene(&scene, &camera, Rect::from_xywh(10.0, 20.0, 60.0, 60.0)).unwrap();
    let placed = canvas.read_pixels(IntRect::from_xywh(10, 20, 60, 60)).unwrap();
    assert_eq!(placed, alone);
}

#[test]
fn a_scene_obeys_clips_layers_and_opacity() {
    let (scene, camera) = scene();
    let mut canvas = Canvas::new(60, 60).unwrap();
    canvas.clear(Color::BLACK);
    canvas.clip_rect(Rect::from_xywh(0.0, 0.0, 30.0, 60.0), rastrum::Antialias::default());
    canvas.push_layer(0.5, BlendMode::SourceOver);
    canvas.draw_scene(&scene, &camera, Rect::from_xywh(0.0, 0.0, 60.0, 60.0)).unwrap();
    canvas.pop_layer();
    let picture = canvas.into_pixmap();
    assert_eq!(picture.pixel(40, 30), Some([0, 0, 0, 255]), "clipped");
    assert!(picture.pixel(25, 30).unwrap()[1].abs_diff(128) <= 1, "half of it shows");
    let mut canvas = Canvas::new(60, 60).unwrap();
    let paint = ImagePaint { opacity: 0.25, ..ImagePaint::default() };
    let whole = Rect::from_xywh(0.0, 0.0, 60.0, 60.0);
    canvas.draw_scene_with(&scene, &camera, whole, &SceneSettings::default(), &paint).unwrap();
    assert!(canvas.draw_scene(&scene, &camera, Rect::from_xywh(0.0, 0.0, 0.0, 5.0)).is_err());
    assert!(canvas.into_pixmap().pixel(30, 30).unwrap()[3].abs_diff(64) <= 1);
    // A label's place.
    let (place, _) = camera.project([0.0, 0.0, 1.0], whole).unwrap();
    assert!((place.x - 30.0).abs() < 1e-3 && (place.y - 30.0).abs() < 1e-3);
}

#[cfg(feature = "mesh")]
mod models {
    use rastrum::Error;
    use rastrum::load::{Model, ModelFormat};

    fn fails(bytes: &[u8], format: ModelFormat) {
        match Model::decode(bytes, format, None) {
            Err(Error::Format(_) | Error::Limit(_)) => {}
            other => panic!("{format:?}: {other:?}"),
        }
    }

    #[test]
    fn stl_text_and_binary() {
        let text = b"solid t\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid t\n";
        let model = Model::decode(text, ModelFormat::Stl, None).unwrap();
        assert_eq!(model.scene.meshes[0].triangles(), [[0, 1, 2]]);
        assert_eq!(model.scene.meshes[0].vertices[2].normal, [0.0, 0.0, 1.0]);
        fails(b"", ModelFormat::Stl);
        let mut claims = vec![0; 84];
        claims[80..].copy_from_slice(&u32::MAX.to_le_bytes());
        fails(&claims, ModelFormat::Stl);
        fails(b"nothing of the kind", ModelFormat::Stl);
    }

    #[test]
    fn ply_with_colours_and_polygons() {
        let text = b"ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0 255 0 0\n1 0 0 0 255 0\n1 1 0 0 0 255\n0 1 0 51 51 51\n4 0 1 2 3\n";
        let model = Model::decode(text, ModelFormat::Ply, None).unwrap();
        let mesh = &model.scene.meshes[0];
        assert_eq!(mesh.triangles(), [[0, 1, 2], [0, 2, 3]]);
        assert_eq!(mesh.vertices[3].color, [0.2, 0.2, 0.2, 1.0]);
        fails(
            b"ply\nformat binary_little_endian 1.0\nelement vertex 4000000000\nproperty float x\nend_header\n",
            ModelFormat::Ply,
        );
        fails(b"ply\n", ModelFormat::Ply);
    }

    #[test]
    fn obj_without_its_materials_is_drawn_without() {
        let text = b"mtllib gone.mtl\no one\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 4 3\n";
        let model = Model::decode(text, ModelFormat::Obj, None).unwrap();
        assert_eq!(model.scene.meshes[0].triangles().len(), 2);
        assert!(model.warnings.iter().any(|warning| warning.contains("gone.mtl")), "{:?}", model.warnings);
        fails(b"v 0 0 0\nf 1 2 3\n", ModelFormat::Obj);
    }

    /// A glTF file of one triangle; `accessor` and `nodes` are parts of its JSON.
    fn gltf(accessor: &str, nodes: &str) -> Vec<u8> {
        // (0,0,0) (1,0,0) (0,1,0) as floats.
        let data = "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA";
        format!(
            r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{nodes}],
            "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}}}}]}}],
            "buffers":[{{"byteLength":36,"uri":"data:application/octet-stream;base64,{data}"}}],
            "bufferViews":[{{"buffer":0,"byteLength":36}}],
            "accessors":[{{"bufferView":0,"componentType":5126,"type":"VEC3","min":[0,0,0],"max":[1,1,0],{accessor}}}]}}"#
        )
        .into_bytes()
    }

    #[test]
    fn s139_gltf_nodes_compose() {
        let nodes = r#"{"name":"a","translation":[1,0,0],"children":[1]},{"name":"b","scale":[2,2,2],"mesh":0}"#;
        let model = Model::decode(&gltf(r#""count":3"#, nodes), ModelFormat::Gltf, None).unwrap();
        let bounds = model.scene.bounds();
        assert_eq!((bounds.min, bounds.max), ([1.0, 0.0, 0.0], [3.0, 2.0, 0.0]));
        assert_eq!(model.scene.meshes[0].vertices[0].normal, [0.0, 0.0, 1.0]);
    }

    #[test]
    fn broken_gltf_is_one_error() {
        let node = r#"{"mesh":0}"#;
        for count in ["4", "4000000000"] {
            fails(&gltf(&format!(r#""count":{count}"#), node), ModelFormat::Gltf);
        }
        fails(&gltf(r#""count":3,"byteOffset":4"#, node), ModelFormat::Gltf);
        fails(b"", ModelFormat::Gltf);
        fails(b"glTF\x02\0\0\0", ModelFormat::Gltf);
        fails(b"{}", ModelFormat::Gltf);
        // A cycle ends: the mesh is drawn once.
        let cycle = r#"{"children":[1]},{"mesh":0,"children":[0]}"#;
        if let Ok(model) = Model::decode(&gltf(r#""count":3"#, cycle), ModelFormat::Gltf, None) {
            assert_eq!(model.scene.world_transforms().len(), 2);
        }
    }
}

#[test]
fn triangles_that_are_no_numbers_or_huge_stop_nothing() {
    let bad = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 1e30, -1e30, 0.0, 1e-38, f32::MAX];
    let mut list = Vec::new();
    for (i, a) in bad.iter().enumerate() {
        for (j, b) in bad.iter().enumerate() {
            let w = bad[(i + j) % bad.len()];
            list.push([*a, *b, 0.5, 1.0]);
            list.push([*b, 0.3, *a, w]);
            list.push([0.1, *a, *b, *b]);
        }
    }
    let indices: Vec<u32> = (0..list.len() as u32 + 40).chain([u32::MAX; 5]).collect();
    for samples in Samples::ALL {
        for topology in [
            Topology::Triangles,
            Topology::TriangleStrip,
            Topology::TriangleFan,
            Topology::Lines,
            Topology::LineLoop,
            Topology::Points,
        ] {
            for fill in [Fill::Solid, Fill::Wireframe, Fill::Points] {
                for clamp in [false, true] {
                    let mut target = Target::with_format(40, 30, DepthFormat::D24, samples).unwrap();
                    let depth = Depth { clamp, bias_slope: 1.0, bias_units: 1.0, ..Depth::default() };
                    let state = State { depth, fill, point_size: f32::NAN, ..State::default() };
                    let vertex = vertex_fn(4, |v: &[f32; 4], out: &mut [f32]| {
                        out.copy_from_slice(v);
                        *v
                    });
                    let primitives = Primitives { vertices: &list, indices: Some(&indices), topology };
                    Pipeline::new(40, 30).with_state(state).draw(&mut target, &primitives, &vertex, &VertexColor);
                }
            }
        }
    }
    // Nothing at all is fine, too.
    let nothing: [[f32; 4]; 0] = [];
    let vertex = vertex_fn(0, |v: &[f32; 4], _: &mut [f32]| *v);
    let mut target = Target::new(8, 8).unwrap();
    let counters = Pipeline::new(8, 8).draw(&mut target, &Primitives::triangles(&nothing), &vertex, &VertexColor);
    assert_eq!(counters, Counters::default());
    assert!(
        Target::new(0, 8).is_err() && Target::with_format(30_000, 30_000, DepthFormat::D16, Samples::Msaa8).is_err()
    );
}
