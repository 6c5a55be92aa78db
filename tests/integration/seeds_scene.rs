//! Scenes, shadows and antialiasing in 3D: rows 86, 92, 95, 97, 103, 104, 114, 116 to 120, 127 to 131 and 139 of the checklist.

#![expect(clippy::disallowed_methods, reason = "formulas compared with a tolerance")]

use std::sync::Arc;

use rastrum::glam::Mat4;
use rastrum::scene::*;
use rastrum::space::*;
use rastrum::{Color, Pixmap, Rect};

use crate::oracle::Random;
use crate::oracle::rays::{self, V3};
use crate::space_support::{Values, drawn, pass, picture as flat_picture, quad, vertices};

const EYE: [f32; 3] = [0.0, 0.0, 5.0];

pub(crate) fn camera() -> Camera {
    Camera { near: 0.5, far: 50.0, ..Camera::look_at(EYE, [0.0; 3], [0.0, 1.0, 0.0]) }
}

fn tan_half(camera: &Camera) -> f64 {
    1.0 / f64::from(camera.projection_matrix(1.0).to_cols_array_2d()[1][1])
}

pub(crate) fn render(scene: &Scene, size: u32, settings: &SceneSettings) -> Pixmap {
    render_picture(scene, &camera(), size, size, settings).unwrap().0
}

/// A square in the plane z = `z` around the origin, facing +z.
pub(crate) fn square(half: f32, z: f32, material: usize) -> Mesh {
    let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
    let vertices = corners
        .map(|(x, y)| MeshVertex {
            position: [x * half, y * half, z],
            uv: [x * 0.5 + 0.5, 0.5 - y * 0.5],
            ..MeshVertex::default()
        })
        .to_vec();
    Mesh { vertices, indices: vec![0, 1, 2, 0, 2, 3], topology: Topology::Triangles, material }
}

pub(crate) fn unlit(color: [f32; 4], alpha: AlphaMode) -> Material {
    Material { shading: Shading::Unlit, color, alpha, ..Material::default() }
}

pub(crate) fn scene_of(parts: Vec<(Mesh, Material, Mat4)>) -> Scene {
    let mut scene = Scene::new();
    for (mut mesh, material, transform) in parts {
        mesh.material = scene.add_material(material);
        scene.add_mesh("part", mesh, transform);
    }
    scene
}

pub(crate) fn shift(x: f32, y: f32, z: f32) -> Mat4 {
    camera::translation([x, y, z])
}

#[test]
fn s086_per_pixel_phong_is_the_formula_at_each_ray() {
    let mut scene = scene_of(vec![(Mesh::sphere(1.5, 96, 64, 0), Material::default(), Mat4::IDENTITY)]);
    scene.lights.push(Light::directional([1.0, 2.0, 3.0]));
    let got = render(&scene, 96, &SceneSettings::default());
    let light = rays::normalize([1.0, 2.0, 3.0]);
    let mesh = &scene.meshes[0];
    let triangles: Vec<([V3; 3], [V3; 3])> = mesh
        .triangles()
        .iter()
        .map(|t| {
            let v = t.map(|i| mesh.vertices[i as usize]);
            (v.map(|v| v.position.map(f64::from)), v.map(|v| v.normal.map(f64::from)))
        })
        .collect();
    let eye = EYE.map(f64::from);
    let mut compared = 0;
    for (x, y) in (0..96).step_by(3).flat_map(|y| (0..96).step_by(3).map(move |x| (x, y))) {
        let ray = rays::through(x, y, (96, 96), tan_half(&camera()));
        let hits = triangles.iter().filter_map(|(p, n)| rays::meet(eye, ray, *p).map(|hit| (hit, p, n)));
        let Some((hit, p, n)) = hits.filter(|(hit, ..)| hit.margin() > 0.001).min_by(|a, b| a.0.t.total_cmp(&b.0.t))
        else {
            continue;
        };
        let mix = |v: &[V3; 3]| -> V3 {
            std::array::from_fn(|i| v[0][i] * (1.0 - hit.u - hit.v) + v[1][i] * hit.u + v[2][i] * hit.v)
        };
        let normal = rays::normalize(mix(n));
        let viewer = rays::normalize(rays::sub(eye, mix(p)));
        if rays::dot(normal, viewer) < 0.1 {
            continue;
        }
        let cosine = rays::dot(normal, light);
        let half = rays::normalize(std::array::from_fn(|i| light[i] + viewer[i]));
        let shine = if cosine > 0.0 { 0.5 * rays::dot(normal, half).max(0.0).powi(32) } else { 0.0 };
        let expected = (0.8 * (0.1 + 0.9 * cosine.max(0.0)) + shine).min(1.0) * 255.0;
        let pixel = got.pixel(x, y).unwrap();
        assert!((f64::from(pixel[0]) - expected).abs() <= 1.5, "{x} {y}: {pixel:?} {expected}");
        compared += 1;
    }
    assert!(compared > 150, "{compared}");
}

#[test]
fn s092_fog_is_its_formula() {
    for kind in
        [FogKind::Linear { start: 2.0, end: 14.0 }, FogKind::Exponential(0.15), FogKind::ExponentialSquared(0.12)]
    {
        for distance in [1.0_f32, 2.5, 5.0, 9.0, 13.9, 20.0] {
            let color = [0.2, 0.8, 0.4, 1.0];
            let z = 5.0 - distance;
            let mut scene = scene_of(vec![(square(40.0, z, 0), unlit(color, AlphaMode::Opaque), Mat4::IDENTITY)]);
            scene.fog = Some(Fog { kind, color: [1.0, 0.5, 0.0] });
            let got = render(&scene, 8, &SceneSettings::default()).pixel(4, 4).unwrap();
            let w = f64::from(distance);
            let f = match kind {
                FogKind::Linear { start, end } => (f64::from(end) - w) / f64::from(end - start),
                FogKind::Exponential(d) => (-f64::from(d) * w).exp(),
                FogKind::ExponentialSquared(d) => (-(f64::from(d) * w).powi(2)).exp(),
            }
            .clamp(0.0, 1.0);
            for (i, fog) in [1.0, 0.5, 0.0].into_iter().enumerate() {
                let expected = (f64::from(color[i]) * f + fog * (1.0 - f)) * 255.0;
                assert!((f64::from(got[i]) - expected).abs() <= 1.0, "{kind:?} {distance}: {got:?} {expected}");
            }
        }
    }
}

#[test]
fn s095_a_billboard_faces_the_camera_and_is_cut_out_by_alpha() {
    // A disc of alpha on a sprite.
    let side = 32_u32;
    let inside = |x: u32, y: u32| {
        let (dx, dy) = (x as f32 + 0.5 - 16.0, y as f32 + 0.5 - 16.0);
        dx * dx + dy * dy < 15.0 * 15.0
    };
    let texels = (0..side * side).map(|i| if inside(i % side, i / side) { 0xff00_80ff } else { 0 }).collect();
    let texture = Texture::new(side, side, 1, texels, Sampler::new(Address::Clamp, Filter::Nearest)).unwrap();
    let material = Material { texture: Some(Arc::new(texture)), ..unlit([1.0; 4], AlphaMode::Mask(0.5)) };
    let mut scene = scene_of(vec![(square(1.0, 0.0, 0), material, camera::rotation([0.3, 1.0, 0.2], 1.2))]);
    let area = |scene: &Scene, eye: [f32; 3]| {
        let camera = Camera { near: 0.5, ..Camera::look_at(eye, [0.0; 3], [0.0, 1.0, 0.0]) };
        let (picture, _) = render_picture(scene, &camera, 100, 100, &SceneSettings::default()).unwrap();
        picture.data().as_chunks::<4>().0.iter().filter(|p| p[3] != 0).count() as f32
    };
    scene.nodes[0].billboard = true;
    // π r² of the disc as seen straight on at distance 5: the half side of 1 is 50 · cot 30° / 5 pixels.
    let half = 50.0 * 3_f32.sqrt() / 5.0;
    let expected = std::f32::consts::PI * (half * 15.0 / 16.0).powi(2);
    for eye in [[0.0, 0.0, 5.0], [5.0, 0.0, 0.0], [3.0, 0.0, -4.0], [0.0, 3.0, 4.0], [-3.0, 2.4, 3.2]] {
        let got = area(&scene, eye);
        assert!((got / expected - 1.0).abs() < 0.05, "{eye:?}: {got} {expected}");
    }
    scene.nodes[0].billboard = false;
    assert!(area(&scene, [0.0, 0.0, 5.0]) < expected * 0.9);
}

/// The test scene of shadows: a floor y = 0 and a box above it, lit from the side.
fn shadow_scene(light: LightKind) -> Scene {
    let floor = Mesh::cuboid([-4.0, -0.1, -4.0], [4.0, 0.0, 4.0], 0);
    let cube = Mesh::cuboid([-0.5, 1.0, -0.5], [0.5, 2.0, 0.5], 0);
    let material = Material { specular: 0.0, color: [1.0; 4], ..Material::default() };
    let mut scene = scene_of(vec![(floor, material.clone(), Mat4::IDENTITY), (cube, material, Mat4::IDENTITY)]);
    scene.lights.push(Light { kind: light, color: [1.0; 3], shadows: true });
    scene
}

fn from_above() -> Camera {
    Camera {
        near: 1.0,
        far: 50.0,
        projection: Projection::Orthographic(8.0),
        ..Camera::look_at([0.0, 20.0, 0.0], [0.0; 3], [0.0, 0.0, -1.0])
    }
}

/// Whether the box keeps light from a place on the floor, by a ray.
fn in_shadow(x: f64, z: f64, towards: V3) -> bool {
    // Slabs.
    let (mut enter, mut leave) = (0.0_f64, f64::INFINITY);
    for (p, d, low, high) in [(x, towards[0], -0.5, 0.5), (0.0, towards[1], 1.0, 2.0), (z, towards[2], -0.5, 0.5)] {
        if d.abs() < 1e-12 {
            if p < low || p > high {
                return false;
            }
            continue;
        }
        let (a, b) = ((low - p) / d, (high - p) / d);
        (enter, leave) = (enter.max(a.min(b)), leave.min(a.max(b)));
    }
    enter < leave
}

/// Pixels of the floor, seen from above, that are dark though they should be lit or the reverse: all, and those farther than
/// `margin` from the true outline.
fn shadow_errors(scene: &Scene, towards: [f32; 3], margin: f64) -> (usize, usize) {
    let size = 160;
    let (picture, _) = render_picture(scene, &from_above(), size, size, &SceneSettings::default()).unwrap();
    let towards = towards.map(f64::from);
    let (mut all, mut far) = (0, 0);
    for (px, py) in (0..size).flat_map(|y| (0..size).map(move |x| (x, y))) {
        let place = |i: u32| (f64::from(i) + 0.5) / f64::from(size) * 8.0 - 4.0;
        let (x, z) = (place(px), place(py));
        if (x.abs() < 0.6 && z.abs() < 0.6) || x.abs() > 3.9 || z.abs() > 3.9 {
            continue;
        }
        let dark = picture.pixel(px, py).unwrap()[0] < 60;
        let expected = in_shadow(x, z, towards);
        let certain = [(-1.0, 0.0), (1.0, 0.0), (0.0, -1.0), (0.0, 1.0)]
            .iter()
            .all(|(dx, dz)| in_shadow(x + dx * margin, z + dz * margin, towards) == expected);
        all += usize::from(dark != expected);
        far += usize::from(dark != expected && certain);
    }
    (all, far)
}

const SUN: [f32; 3] = [1.0, 1.6, 0.5];

fn hard(resolution: u32) -> ShadowSettings {
    ShadowSettings { resolution, radius: 0, ..ShadowSettings::default() }
}

#[test]
fn s127_the_depth_image_of_a_light_equals_ray_casting() {
    let mut scene = shadow_scene(LightKind::Directional(SUN));
    scene.shadows = ShadowSettings { resolution: 64, bias_slope: 0.0, ..ShadowSettings::default() };
    let (side, depths, to_light) = light_depths(&scene, &camera(), 0).unwrap().unwrap();
    let back = camera::inverse(&to_light).unwrap();
    let mut triangles: Vec<[V3; 3]> = Vec::new();
    for mesh in &scene.meshes {
        triangles.extend(mesh.triangles().iter().map(|t| t.map(|i| mesh.vertices[i as usize].position.map(f64::from))));
    }
    let world = |x: f32, y: f32, z: f32| {
        let [x, y, z, w] = camera::transform(&back, [x, y, z, 1.0]);
        [x / w, y / w, z / w].map(f64::from)
    };
    let (mut hits, mut empty) = (0, 0);
    for (x, y) in (0..side).flat_map(|y| (0..side).map(move |x| (x, y))) {
        let ndc = ((x as f32 + 0.5) / side as f32 * 2.0 - 1.0, 1.0 - (y as f32 + 0.5) / side as f32 * 2.0);
        let (start, end) = (world(ndc.0, ndc.1, -1.0), world(ndc.0, ndc.1, 1.0));
        let Some(nearest) = rays::nearest(start, rays::sub(end, start), &triangles, 0.01) else { continue };
        let got = f64::from(depths[(y * side + x) as usize]);
        match nearest {
            Some((_, hit)) => {
                assert!((got - hit.t).abs() < 1e-3, "{x} {y}: {got} {}", hit.t);
                hits += 1;
            }
            None => {
                assert_eq!(got, 1.0);
                empty += 1;
            }
        }
    }
    assert!(hits > 800 && empty > 100, "{hits} {empty}");
}

#[test]
fn s128_the_shadow_of_a_box_is_its_projection_within_a_texel() {
    let mut scene = shadow_scene(LightKind::Directional(SUN));
    scene.shadows = hard(1024);
    // The scene is about 12 wide: a texel of the map is about 0.012, on the floor along the light about twice that.
    let (all, far) = shadow_errors(&scene, SUN, 0.03);
    assert_eq!(far, 0, "{all} differ");
    scene.lights[0].shadows = false;
    assert!(shadow_errors(&scene, SUN, 0.03).1 > 200, "without a map there is no shadow");
    // A spot light's map, in perspective: dark under the box, lit beside it.
    let kind = LightKind::Spot { position: [0.0, 6.0, 0.0], direction: [0.0, -1.0, 0.0], range: 100.0, angle: 0.9 };
    let mut scene = shadow_scene(kind);
    let seen = |scene: &Scene, x: f32| {
        let camera = Camera::look_at([x, 0.6, 8.0], [x, 0.0, 0.0], [0.0, 1.0, 0.0]);
        render_picture(scene, &camera, 33, 33, &SceneSettings::default()).unwrap().0.pixel(16, 16).unwrap()[0]
    };
    assert!(seen(&scene, 0.0) < 40 && seen(&scene, 2.0) > 150, "{} {}", seen(&scene, 0.0), seen(&scene, 2.0));
    scene.lights[0].shadows = false;
    assert!(seen(&scene, 0.0) > 150);
}

#[test]
fn s129_the_default_bias_leaves_no_acne_and_none_shows_it() {
    // A lit floor alone: any dark pixel is acne.
    let acne = |shadows: ShadowSettings| {
        let mut scene = shadow_scene(LightKind::Directional([2.0, 1.0, 0.7]));
        scene.nodes[1].transform = shift(0.0, 500.0, 0.0);
        scene.shadows = shadows;
        scene.nodes.truncate(1);
        scene.roots.truncate(1);
        let (picture, _) = render_picture(&scene, &from_above(), 96, 96, &SceneSettings::default()).unwrap();
        let lit = picture.pixel(48, 48).map_or(0, |_| 255);
        let values: Vec<u8> = picture.data().as_chunks::<4>().0.iter().map(|p| p[0]).collect();
        let most = *values.iter().max().unwrap();
        assert!(lit > 0 && most > 60);
        values[96 * 4..96 * 92].iter().filter(|v| most - **v > 10).count()
    };
    assert_eq!(acne(ShadowSettings::default()), acne(ShadowSettings { bias: 0.1, ..ShadowSettings::default() }));
    let none = ShadowSettings { bias: 0.0, bias_slope: 0.0, radius: 0, resolution: 256 };
    assert!(acne(none) > acne(ShadowSettings::default()) + 1000, "{}", acne(none));
}

#[test]
fn s130_the_error_falls_with_the_resolution() {
    let error = |resolution: u32| {
        let mut scene = shadow_scene(LightKind::Directional(SUN));
        scene.shadows = ShadowSettings { bias: 0.002, ..hard(resolution) };
        shadow_errors(&scene, SUN, 0.03).0
    };
    let errors = [32, 64, 128, 256].map(error);
    for pair in errors.windows(2) {
        assert!(pair[1] * 10 < pair[0] * 7, "{errors:?}");
    }
}

#[test]
fn s131_filtering_gives_a_monotone_penumbra() {
    let mut scene = shadow_scene(LightKind::Directional([1.0, 1.5, 0.0]));
    scene.shadows = ShadowSettings { resolution: 128, radius: 4, ..ShadowSettings::default() };
    let (picture, _) = render_picture(&scene, &from_above(), 160, 160, &SceneSettings::default()).unwrap();
    // Along the row through the middle from the shadow's core to the lit floor on its left.
    let row: Vec<u8> = (0..160).map(|x| picture.pixel(x, 80).unwrap()[0]).collect();
    let core = (8..70).min_by_key(|x| row[*x]).unwrap();
    let left = &row[8..=core];
    assert!(left.windows(2).all(|pair| pair[0] >= pair[1]), "{left:?}");
    let steps: std::collections::BTreeSet<u8> = left.iter().copied().collect();
    assert!(steps.len() >= 5, "a penumbra, not a step: {steps:?}");
    scene.shadows.radius = 0;
    let (picture, _) = render_picture(&scene, &from_above(), 160, 160, &SceneSettings::default()).unwrap();
    let hard: std::collections::BTreeSet<u8> = (8..=core as u32).map(|x| picture.pixel(x, 80).unwrap()[0]).collect();
    assert!(hard.len() <= 3, "{hard:?}");
}

#[test]
fn s097_stencil_shadows_by_z_fail_equal_the_analytic_mask() {
    for sun in [true, false] {
        let lamp = [2.0_f32, 5.0, 1.5];
        let light = if sun { [SUN[0], SUN[1], SUN[2], 0.0] } else { [lamp[0], lamp[1], lamp[2], 1.0] };
        let cube = Mesh::cuboid([-0.5, 1.0, -0.5], [0.5, 2.0, 0.5], 0);
        let corners = |mesh: &Mesh| -> Vec<[[f32; 3]; 3]> {
            mesh.triangles().iter().map(|t| t.map(|i| mesh.vertices[i as usize].position)).collect()
        };
        let volumes = shadow_volumes(&corners(&cube), light);
        let floor = Mesh::cuboid([-4.0, -0.1, -4.0], [4.0, 0.0, 4.0], 0);
        // Looking from inside the shadow's volume too: z-fail does not mind.
        for camera in [from_above(), Camera::look_at([0.2, 1.9, 2.5], [-0.5, 0.0, -0.2], [0.0, 1.0, 0.0])] {
            let size = 128;
            let m = camera::product(&camera.projection_matrix(1.0), &camera.view);
            let to_list = |triangles: &[[[f32; 4]; 3]]| -> Vec<crate::space_support::Vertex> {
                let point = |p: &[f32; 4]| crate::space_support::Vertex::new(camera::transform(&m, *p), [1.0; 4]);
                triangles.iter().flatten().map(point).collect()
            };
            let solid = |t: Vec<[[f32; 3]; 3]>| -> Vec<[[f32; 4]; 3]> {
                t.into_iter().map(|t| t.map(|[x, y, z]| [x, y, z, 1.0])).collect()
            };
            let mut target = Target::new(size, size).unwrap();
            let pipeline = Pipeline::new(size, size);
            for mesh in [&floor, &cube] {
                pipeline.draw_depth(&mut target, &Primitives::triangles(&to_list(&solid(corners(mesh)))), &pass());
            }
            let count = |op: StencilOp| StencilFace { depth_fail: op, ..StencilFace::default() };
            let stencil = Stencil { back: count(StencilOp::IncrementWrap), front: count(StencilOp::DecrementWrap) };
            let depth = Depth { write: false, clamp: true, ..Depth::compare(Compare::Less) };
            let state = State { stencil: Some(stencil), depth, color_mask: [false; 4], ..State::default() };
            pipeline.with_state(state).draw(&mut target, &Primitives::triangles(&to_list(&volumes)), &pass(), &Values);
            let (mut wrong, mut dark) = (0, 0);
            let back = camera::inverse(&m).unwrap();
            for (x, y) in (0..size).flat_map(|y| (0..size).map(move |x| (x, y))) {
                let depth = target.depth(x, y).unwrap();
                let ndc = [(x as f32 + 0.5) / 64.0 - 1.0, 1.0 - (y as f32 + 0.5) / 64.0, depth * 2.0 - 1.0, 1.0];
                let [px, py, pz, w] = camera::transform(&back, ndc);
                let place = [px / w, py / w, pz / w].map(f64::from);
                if depth == 1.0 || place[1].abs() > 0.01 {
                    continue;
                }
                let towards: V3 =
                    std::array::from_fn(|i| f64::from(light[i]) - if light[3] > 0.0 { place[i] } else { 0.0 });
                let expected = in_shadow(place[0], place[2], towards);
                let sure = [(-0.02, 0.0), (0.02, 0.0), (0.0, -0.02), (0.0, 0.02)]
                    .iter()
                    .all(|(dx, dz)| in_shadow(place[0] + dx, place[2] + dz, towards) == expected);
                dark += usize::from(expected);
                wrong += usize::from(sure && expected != (target.stencil(x, y) != Some(0)));
            }
            assert_eq!(wrong, 0, "sun {sun}");
            assert!(dark > 50, "{dark}");
        }
    }
}

#[test]
fn s103_transparency_is_right_sorted_and_wrong_unsorted() {
    let colors = [[1.0, 0.0, 0.0, 0.5], [0.0, 1.0, 0.0, 0.5], [0.0, 0.0, 1.0, 0.5]];
    // Nearest first in the scene: the wrong order for blending.
    let parts = colors
        .iter()
        .enumerate()
        .map(|(i, color)| (square(1.0, 1.0 - i as f32, 0), unlit(*color, AlphaMode::Blend), Mat4::IDENTITY))
        .collect();
    let scene = scene_of(parts);
    let draw = |sort: bool| {
        let settings = SceneSettings { sort_transparent: sort, background: Color::WHITE, ..SceneSettings::default() };
        render(&scene, 32, &settings).pixel(16, 16).unwrap()
    };
    let blend = |order: [usize; 3]| {
        let mut c = [1.0; 3];
        for i in order {
            for k in 0..3 {
                c[k] = c[k] * 0.5 + colors[i][k] * 0.5;
            }
        }
        c.map(|v| v * 255.0)
    };
    let near = |got: [u8; 4], expected: [f32; 3]| (0..3).all(|i| (f32::from(got[i]) - expected[i]).abs() <= 2.0);
    assert!(near(draw(true), blend([2, 1, 0])), "{:?}", draw(true));
    assert!(!near(draw(false), blend([2, 1, 0])) && near(draw(false), blend([0, 1, 2])), "{:?}", draw(false));
}

#[test]
fn s104_painters_algorithm_equals_the_depth_buffer_on_a_disjoint_scene() {
    let mut random = Random::new(104);
    let parts = (0..20)
        .map(|i| {
            let color = [0; 3].map(|_| random.within(0..256) as f32 / 255.0);
            let z = -(((i * 7) % 20) as f32) * 0.4;
            let material = unlit([color[0], color[1], color[2], 1.0], AlphaMode::Opaque);
            let place = shift(random.within(-15..15) as f32 / 10.0, random.within(-15..15) as f32 / 10.0, z);
            (square(0.7, 0.0, 0), material, place)
        })
        .collect();
    let scene = scene_of(parts);
    let with = render(&scene, 96, &SceneSettings::default());
    let painted = render(&scene, 96, &SceneSettings { painter: true, ..SceneSettings::default() });
    assert_eq!(with, painted);
}

#[test]
fn s114_multisampling_shades_once_a_pixel_and_triangle() {
    let t = [(700, 300), (15_000, 4000), (2500, 14_500)];
    let list = vertices(t, 0.5, [0.3, 0.6, 0.9, 1.0], 64.0);
    let single = {
        let mut target = Target::new(64, 64).unwrap();
        Pipeline::new(64, 64).draw(&mut target, &Primitives::triangles(&list), &pass(), &Values);
        target
    };
    for samples in [Samples::Msaa2, Samples::Msaa4, Samples::Msaa8] {
        let mut target = Target::with_format(64, 64, DepthFormat::D32F, samples).unwrap();
        let c = Pipeline::new(64, 64).draw(&mut target, &Primitives::triangles(&list), &pass(), &Values);
        let touched = drawn(&target).len() as u64;
        assert_eq!(c.fragments, touched, "once a pixel");
        assert!(c.samples_passed > touched * (samples.coverage() as u64 - 1), "{c:?}");
        let (mut inside, mut area) = (0, 0.0);
        for (x, y) in (0..64).flat_map(|y| (0..64).map(move |x| (x, y))) {
            let all = (0..samples.coverage()).all(|s| target.sample_color(x, y, s).unwrap()[3] == 255);
            if all {
                assert_eq!(target.pixel(x, y), single.pixel(x, y));
                inside += 1;
            }
            // Coverage is the number of samples inside, by the exact positions.
            let count = samples
                .positions()
                .iter()
                .filter(|(sx, sy)| {
                    let p = (i64::from(x) * 256 + i64::from(*sx) * 16, i64::from(y) * 256 + i64::from(*sy) * 16);
                    crate::oracle::triangle::inside(t, p, crate::oracle::triangle::top_left)
                })
                .count();
            let expected = (count as f64 * 255.0 / samples.coverage() as f64).round() as i32;
            assert!((i32::from(target.pixel(x, y).unwrap()[3]) - expected).abs() <= 1, "{samples:?} {x} {y}");
            area += count as f64 / samples.coverage() as f64;
        }
        let exact = crate::oracle::triangle::edge(t[0], t[1], t[2]).abs() as f64 / 2.0 / 65536.0;
        assert!(inside > 800 && (area / exact - 1.0).abs() < 0.01);
    }
}

/// The mean error of a half-plane's coverage over many directions.
fn half_plane_error(samples: Samples) -> f64 {
    let mut random = Random::new(116);
    let (mut sum, mut count) = (0.0, 0);
    for _ in 0..60 {
        let mut at = || random.within(2 * 256..14 * 256);
        let (p, q) = ((at(), at()), (at(), at()));
        let d = ((q.0 - p.0), (q.1 - p.1));
        if d.0.abs() + d.1.abs() < 512 {
            continue;
        }
        // A triangle whose one side is the line, so large that nothing else shows.
        let a = (p.0 - d.0 * 20, p.1 - d.1 * 20);
        let b = (p.0 + d.0 * 20, p.1 + d.1 * 20);
        let c = (p.0 - d.1 * 40, p.1 + d.0 * 40);
        let list = vertices([a, b, c], 0.5, [1.0; 4], 16.0);
        let mut target = Target::with_format(16, 16, DepthFormat::D32F, samples).unwrap();
        Pipeline::new(16, 16).draw(&mut target, &Primitives::triangles(&list), &pass(), &Values);
        let polygon = [a, b, c].map(|(x, y)| (x as f64 / 256.0, y as f64 / 256.0));
        for (x, y) in (0..16).flat_map(|y| (0..16).map(move |x| (x, y))) {
            let exact = crate::oracle::area::coverage(&polygon, x, y);
            if exact > 0.001 && exact < 0.999 {
                sum += (f64::from(target.pixel(x, y).unwrap()[3]) / 255.0 - exact).abs();
                count += 1;
            }
        }
    }
    sum / f64::from(count)
}

#[test]
fn s116_sixteen_coverage_samples_with_four_colours_beat_msaa_4() {
    let (csaa, msaa) = (half_plane_error(Samples::Csaa16x4), half_plane_error(Samples::Msaa4));
    assert!(csaa < msaa * 0.6, "{csaa} {msaa}");
    assert_eq!((Samples::Csaa16x4.coverage(), Samples::Csaa16x4.colors()), (16, 4));
}

#[test]
fn s117_eqaa_has_more_coverage_samples_than_colours() {
    for samples in Samples::ALL {
        assert!(samples.coverage() >= samples.colors());
    }
    assert_eq!((Samples::Eqaa8x4.coverage(), Samples::Eqaa8x4.colors()), (8, 4));
    let (eqaa, four, eight) =
        (half_plane_error(Samples::Eqaa8x4), half_plane_error(Samples::Msaa4), half_plane_error(Samples::Msaa8));
    assert!(eqaa < four && (eqaa - eight).abs() < 1e-9, "{eqaa} {four} {eight}");
    // Two colours in a pixel are resolved exactly as by eight colours; with five, one is forgotten and the others go on.
    let bands = |n: i64| -> Vec<_> {
        (0..n)
            .flat_map(|i| {
                let (y0, y1) = (i * 256 / n, (i + 1) * 256 / n);
                let c = [(i + 1) as f32 / n as f32, 0.5, 0.0, 1.0];
                let (a, b, c2, d) = ((-256, y0), (512, y0), (512, y1), (-256, y1));
                [vertices([a, b, c2], 0.5, c, 16.0), vertices([a, c2, d], 0.5, c, 16.0)]
            })
            .flatten()
            .collect()
    };
    let draw = |samples: Samples, n: i64| {
        let mut target = Target::with_format(16, 16, DepthFormat::D32F, samples).unwrap();
        let off = State { depth: Depth::OFF, ..State::default() };
        let pipeline = Pipeline::new(16, 16).with_state(off);
        pipeline.draw(&mut target, &Primitives::triangles(&bands(n)), &pass(), &Values);
        target
    };
    for n in 1..=3 {
        assert_eq!(draw(Samples::Eqaa8x4, n).pixel(0, 0), draw(Samples::Msaa8, n).pixel(0, 0), "{n}");
    }
    let many = draw(Samples::Eqaa8x4, 8);
    let known = (0..8).filter(|s| many.sample_color(0, 0, *s).is_some()).count();
    assert_eq!((known, many.pixel(0, 0).unwrap()[3]), (4, 255));
}

#[test]
fn s118_fxaa_lowers_the_error_of_edges_and_leaves_flat_areas_alone() {
    let mut random = Random::new(118);
    let (mut before, mut after, mut same) = (0.0, 0.0, 0);
    for _ in 0..12 {
        let mut at = || random.within(4 * 256..60 * 256);
        let t = [(at(), at()), (at(), at()), (at(), at())];
        if crate::oracle::triangle::edge(t[0], t[1], t[2]).abs() < 400 * 65536 {
            continue;
        }
        let mut list = quad(0.9, [0.0, 0.0, 0.0, 1.0]).to_vec();
        list.extend(vertices(t, 0.5, [1.0; 4], 64.0));
        let aliased = flat_picture(&Pipeline::new(64, 64), 64, &list);
        let smooth = antialias::fxaa(&aliased).unwrap();
        let polygon = t.map(|(x, y)| (x as f64 / 256.0, y as f64 / 256.0));
        for (x, y) in (0..64).flat_map(|y| (0..64).map(move |x| (x, y))) {
            let exact = crate::oracle::area::coverage(&polygon, x, y) * 255.0;
            let value = |p: &Pixmap, x: u32, y: u32| f64::from(p.pixel(x, y).unwrap()[0]);
            before += (value(&aliased, x, y) - exact).abs();
            after += (value(&smooth, x, y) - exact).abs();
            let flat = (0..3).all(|j| {
                (0..3).all(|i| {
                    let (nx, ny) = ((x + i).saturating_sub(1).min(63), (y + j).saturating_sub(1).min(63));
                    aliased.pixel(nx, ny) == aliased.pixel(x, y)
                })
            });
            if flat {
                assert_eq!(aliased.pixel(x, y), smooth.pixel(x, y));
                same += 1;
            }
        }
    }
    assert!(after < before * 0.8 && same > 20_000, "{before} {after} {same}");
}

#[test]
fn s119_jittered_accumulation_converges_to_supersampling() {
    let mesh = Mesh::sphere(1.3, 24, 16, 0);
    let mut scene = scene_of(vec![(mesh, Material::default(), Mat4::IDENTITY)]);
    scene.lights.push(Light::directional([1.0, 1.0, 1.0]));
    let draw = |antialias: SceneAntialias| render(&scene, 48, &SceneSettings { antialias, ..SceneSettings::default() });
    let truth = draw(SceneAntialias::Supersample(8));
    let error = |picture: &Pixmap| {
        let pairs = picture.data().iter().zip(truth.data());
        pairs.map(|(a, b)| f64::from(a.abs_diff(*b))).sum::<f64>() / truth.data().len() as f64
    };
    let errors = [1, 4, 16, 64].map(|n| error(&draw(SceneAntialias::Temporal(n))));
    assert!(errors.windows(2).all(|pair| pair[1] < pair[0]), "{errors:?}");
    assert!(errors[3] < 0.35 && errors[3] * 5.0 < error(&draw(SceneAntialias::None)), "{errors:?}");
}

#[test]
fn s120_two_pixels_share_their_middle_samples() {
    // Six samples for two pixels: columns 0, 1 and 2, two rows.
    let value = |x: u32, y: u32| (10 + 40 * x + 7 * y) as u8;
    let mut samples = Pixmap::new(3, 2).unwrap();
    for (i, pixel) in samples.data_mut().as_chunks_mut::<4>().0.iter_mut().enumerate() {
        *pixel = [value(i as u32 % 3, i as u32 / 3), 0, 0, 255];
    }
    let picture = antialias::shared_samples(&samples).unwrap();
    assert_eq!((picture.width(), picture.height()), (2, 1));
    for x in 0..2 {
        let sum: u32 = [(x, 0), (x + 1, 0), (x, 1), (x + 1, 1)].iter().map(|(x, y)| u32::from(value(*x, *y))).sum();
        assert_eq!(picture.pixel(x, 0).unwrap()[0], ((2 * sum + 4) / 8) as u8);
    }
    // A change of a middle sample changes both.
    samples.data_mut()[4] += 80;
    let changed = antialias::shared_samples(&samples).unwrap();
    assert!((0..2).all(|x| changed.pixel(x, 0).unwrap()[0] == picture.pixel(x, 0).unwrap()[0] + 20));
    assert!(antialias::shared_samples(&Pixmap::new(3, 3).unwrap()).is_err());
}

#[test]
fn s139_nested_transforms_compose() {
    let mut scene = Scene::new();
    let material = scene.add_material(unlit([1.0; 4], AlphaMode::Opaque));
    scene.meshes.push(square(0.2, 0.0, material));
    let turn = camera::rotation([0.0, 0.0, 1.0], std::f32::consts::FRAC_PI_2);
    let node = |transform: Mat4, meshes: Vec<usize>, children: Vec<usize>| Node {
        transform,
        meshes,
        children,
        ..Node::default()
    };
    // An arm of three: moved by 1 along x, turned a quarter, moved by 1 along x again, scaled.
    scene.nodes.push(node(shift(1.0, 0.0, 0.0), vec![], vec![1]));
    scene.nodes.push(node(turn, vec![], vec![2]));
    scene.nodes.push(node(camera::product(&shift(1.0, 0.0, 0.0), &camera::scale([2.0, 1.0, 1.0])), vec![0], vec![]));
    scene.roots.push(0);
    let (_, world) = scene.world_transforms()[2];
    let at = |x: f32, y: f32| camera::transform(&world, [x, y, 0.0, 1.0]);
    for (got, expected) in [(at(0.0, 0.0), [1.0, 1.0]), (at(0.5, 0.0), [1.0, 2.0]), (at(0.0, 0.5), [0.5, 1.0])] {
        assert!((got[0] - expected[0]).abs() < 1e-6 && (got[1] - expected[1]).abs() < 1e-6, "{got:?}");
    }
    // What is drawn is where projection says.
    let picture = render(&scene, 101, &SceneSettings::default());
    let whole = Rect::from_xywh(0.0, 0.0, 101.0, 101.0);
    let (place, depth) = camera().project([1.0, 1.0, 0.0], whole).unwrap();
    assert_eq!(picture.pixel(place.x as u32, place.y as u32), Some([255; 4]));
    assert!(depth > 0.0 && depth < 1.0);
    assert_eq!(camera().project([0.0, 0.0, 9.0], whole), None);
    // A cycle, and a child that is not there, end.
    scene.nodes[2].children = vec![0, 77];
    assert_eq!(scene.world_transforms().len(), 3);
}

#[test]
fn every_shading_and_antialiasing_is_the_same_at_every_level_and_thread_count() {
    let mut scene = shadow_scene(LightKind::Directional(SUN));
    scene.lights.push(Light {
        kind: LightKind::Point { position: [1.0, 3.0, 2.0], range: 4.0 },
        color: [1.0, 0.6, 0.2],
        shadows: false,
    });
    scene.fog = Some(Fog { kind: FogKind::Exponential(0.05), color: [0.5; 3] });
    let camera = Camera::look_at([3.0, 3.0, 5.0], [0.0, 0.5, 0.0], [0.0, 1.0, 0.0]);
    for shading in [Shading::Unlit, Shading::Flat, Shading::Gouraud, Shading::Phong, Shading::Pbr] {
        for antialias in [
            SceneAntialias::None,
            SceneAntialias::Fxaa,
            SceneAntialias::Supersample(2),
            SceneAntialias::Samples(Samples::Msaa4),
        ] {
            let draw = |threads: usize, level: rastrum::SimdLevel| {
                let settings =
                    SceneSettings { shading: Some(shading), antialias, threads, level, ..SceneSettings::default() };
                render_picture(&scene, &camera, 50, 40, &settings).unwrap().0
            };
            let expected = draw(1, rastrum::SimdLevel::Scalar);
            assert!(expected.data().iter().any(|v| *v > 0 && *v < 255));
            for level in rastrum::SimdLevel::available() {
                for threads in [1, 2, 3] {
                    assert!(draw(threads, level) == expected, "{shading:?} {antialias:?} {threads} {level:?}");
                }
            }
        }
    }
}

#[test]
fn what_is_hidden_is_not_shaded_unless_pixels_may_be_dropped() {
    // Three walls one behind the other, each of which fills the picture.
    let wall = |z: f32, alpha: AlphaMode| {
        let material = Material { alpha, color: [0.5, 0.7, 0.9, 1.0], ..Material::default() };
        (Mesh::cuboid([-9.0, -9.0, z], [9.0, 9.0, z + 0.1], 0), material, Mat4::IDENTITY)
    };
    let camera = Camera::look_at([0.0, 0.0, 3.0], [0.0; 3], [0.0, 1.0, 0.0]);
    let shaded = |alpha: AlphaMode, look: Look| {
        let scene = scene_of([1.0, 0.0, -1.0].map(|z| wall(z, alpha)).into());
        let settings = SceneSettings { look, ..SceneSettings::default() };
        let (picture, stats) = render_picture(&scene, &camera, 40, 30, &settings).unwrap();
        assert!(picture.data().as_chunks::<4>().0.iter().all(|pixel| pixel[3] == 255));
        stats.counters.fragments
    };
    assert_eq!(shaded(AlphaMode::Opaque, Look::Materials), 40 * 30);
    // What may be cut out does not hide before it is known where.
    assert!(shaded(AlphaMode::Mask(0.5), Look::Materials) > 40 * 30);
    assert_eq!(shaded(AlphaMode::Mask(0.5), Look::Normals), 40 * 30);
}
