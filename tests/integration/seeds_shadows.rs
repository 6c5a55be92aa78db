//! Shadows of point lights: rows 127 to 131 of the checklist for a map of six faces.

use rastrum::glam::Mat4;
use rastrum::scene::*;

use crate::seeds_scene::scene_of;

const LIGHT: [f32; 3] = [0.3, 0.2, -0.1];
/// Between the light and the room's edge x = z = 3: its shadow falls onto both walls, and onto both sides of the line where
/// faces of the map meet.
const BLOCKER: ([f32; 3], [f32; 3]) = ([0.9, -0.4, 0.5], [1.3, 0.5, 1.1]);
const HALF: f32 = 3.0;
const SIZE: u32 = 200;

/// A room of six slabs around a light, with something in it or without.
fn room(blocker: Option<([f32; 3], [f32; 3])>, shadows: ShadowSettings) -> Scene {
    let material = Material { specular: 0.0, color: [1.0; 4], ..Material::default() };
    let mut parts = Vec::new();
    for wall in 0..6 {
        let (mut low, mut high) = ([-HALF - 0.1; 3], [HALF + 0.1; 3]);
        if wall % 2 == 0 {
            low[wall / 2] = HALF;
        } else {
            high[wall / 2] = -HALF;
        }
        parts.push((Mesh::cuboid(low, high, 0), material.clone(), Mat4::IDENTITY));
    }
    if let Some((low, high)) = blocker {
        parts.push((Mesh::cuboid(low, high, 0), material, Mat4::IDENTITY));
    }
    let mut scene = scene_of(parts);
    let kind = LightKind::Point { position: LIGHT, range: 100.0 };
    scene.lights.push(Light { kind, color: [1.0; 3], shadows: true });
    scene.shadows = shadows;
    scene
}

/// The inner side of a wall, seen from nearby: x, y or z (`wall` / 2) at its highest or, odd, its lowest. The picture's axes are the
/// other two.
fn wall_camera(wall: usize) -> Camera {
    let (axis, sign) = (wall / 2, if wall.is_multiple_of(2) { 1.0 } else { -1.0 });
    let (mut eye, mut at, mut up) = ([0.0; 3], [0.0; 3], [0.0; 3]);
    (eye[axis], at[axis], up[(axis + 2) % 3]) = (sign * (HALF - 0.5), sign * HALF, 1.0);
    let projection = Projection::Orthographic(2.0 * HALF);
    Camera { near: 0.1, far: 5.0, projection, ..Camera::look_at(eye, at, up) }
}

/// The place on a wall at a pixel's centre.
fn place(wall: usize, x: u32, y: u32) -> [f64; 3] {
    let (axis, half) = (wall / 2, f64::from(HALF));
    let step = 2.0 * half / f64::from(SIZE);
    let sign = if wall.is_multiple_of(2) { 1.0 } else { -1.0 };
    let mut place = [0.0; 3];
    place[axis] = sign * half;
    // Right is along × up: up is two further in the cycle x, y, z, so that right runs against the one between.
    place[(axis + 1) % 3] = -sign * ((f64::from(x) + 0.5) * step - half);
    place[(axis + 2) % 3] = half - (f64::from(y) + 0.5) * step;
    place
}

/// Whether a box is between a place and the light.
fn in_shadow(place: [f64; 3], (low, high): ([f32; 3], [f32; 3])) -> bool {
    let (mut enter, mut leave) = (0.0_f64, 1.0_f64);
    for i in 0..3 {
        let d = f64::from(LIGHT[i]) - place[i];
        let (a, b) = ((f64::from(low[i]) - place[i]) / d, (f64::from(high[i]) - place[i]) / d);
        (enter, leave) = (enter.max(a.min(b)), leave.min(a.max(b)));
    }
    enter < leave
}

/// Two places `texels` of the map away along the axes of its face, and the two on the other side; on the wall's plane or a little off.
fn around(place: [f64; 3], texels: f64, resolution: u32) -> [[f64; 3]; 4] {
    let way: [f64; 3] = std::array::from_fn(|i| place[i] - f64::from(LIGHT[i]));
    let major = (0..3).fold(0, |best, i| if way[i].abs() > way[best].abs() { i } else { best });
    let step = texels * 2.0 * way[major].abs() / f64::from(resolution);
    [(1, step), (1, -step), (2, step), (2, -step)].map(|(turn, step)| {
        let mut moved = place;
        moved[(major + turn) % 3] += step;
        moved
    })
}

fn draw(scene: &Scene, wall: usize) -> rastrum::Pixmap {
    render_picture(scene, &wall_camera(wall), SIZE, SIZE, &SceneSettings::default()).unwrap().0
}

/// The major axis of the way from the light.
fn face(place: [f64; 3]) -> usize {
    let way = [0, 1, 2].map(|i| (place[i] - f64::from(LIGHT[i])).abs());
    (0..3).fold(0, |best, i| if way[i] > way[best] { i } else { best })
}

/// Pixels of a wall that are dark (by face of the map: across x, y, z), after checking all that are `texels` away from the true outline.
fn check(scene: &Scene, wall: usize, texels: f64) -> [usize; 3] {
    let picture = draw(scene, wall);
    let resolution = scene.shadows.resolution;
    let mut dark = [0; 3];
    for (x, y) in (0..SIZE).flat_map(|y| (0..SIZE).map(move |x| (x, y))) {
        let place = place(wall, x, y);
        let expected = in_shadow(place, BLOCKER);
        if around(place, texels, resolution).iter().any(|p| in_shadow(*p, BLOCKER) != expected) {
            continue;
        }
        let value = picture.pixel(x, y).unwrap()[0];
        assert_eq!(value < 60, expected, "wall {wall}, {x} {y} {place:?}: {value}");
        dark[face(place)] += usize::from(expected);
    }
    dark
}

#[test]
fn s128_a_point_lights_shadow_is_the_blockers_projection_within_a_texel_across_faces() {
    let scene = room(Some(BLOCKER), ShadowSettings { resolution: 256, radius: 0, ..ShadowSettings::default() });
    let walls: Vec<[usize; 3]> = (0..6).map(|wall| check(&scene, wall, 1.0)).collect();
    let [on_x, on_z] = [walls[0], walls[4]];
    assert!(on_x[0] > 300 && on_x[2] > 100 && on_z[2] > 300, "{walls:?}");
    // Without a map all of it is lit.
    let mut lit = scene.clone();
    lit.lights[0].shadows = false;
    assert!(draw(&lit, 0).data().as_chunks::<4>().0.iter().all(|p| p[0] > 60));
}

#[test]
fn s131_filtering_sees_no_seam_between_faces() {
    for radius in [1, 4, 8] {
        let scene = room(Some(BLOCKER), ShadowSettings { resolution: 256, radius, ..ShadowSettings::default() });
        // Taps lie as far as the radius along both axes.
        let texels = f64::from(radius + 1) * 1.5;
        for wall in [0, 4] {
            assert!(check(&scene, wall, texels).iter().sum::<usize>() > 200);
        }
    }
}

#[test]
fn s129_a_point_light_in_a_room_leaves_no_acne_by_default() {
    for resolution in [64, 256, 1024] {
        let scene = room(None, ShadowSettings { resolution, ..ShadowSettings::default() });
        let mut lit = scene.clone();
        lit.lights[0].shadows = false;
        for wall in 0..6 {
            assert!(draw(&scene, wall) == draw(&lit, wall), "wall {wall} at {resolution}");
        }
    }
    let none = room(None, ShadowSettings { resolution: 256, radius: 0, bias: 0.0, bias_slope: 0.0 });
    let dark = draw(&none, 0).data().as_chunks::<4>().0.iter().filter(|p| p[0] < 60).count();
    assert!(dark > 1000, "{dark}");
}

#[test]
fn a_point_lights_shadow_is_the_same_at_every_level_and_thread_count() {
    let scene = room(Some(BLOCKER), ShadowSettings { resolution: 100, radius: 2, ..ShadowSettings::default() });
    let camera = Camera::look_at([-2.0, 1.0, -2.5], [1.0, -0.5, 1.0], [0.0, 1.0, 0.0]);
    for shading in [Shading::Gouraud, Shading::Phong, Shading::Pbr] {
        let draw = |threads: usize, level: rastrum::SimdLevel| {
            let settings = SceneSettings { shading: Some(shading), threads, level, ..SceneSettings::default() };
            render_picture(&scene, &camera, 90, 70, &settings).unwrap().0
        };
        let expected = draw(1, rastrum::SimdLevel::Scalar);
        for level in rastrum::SimdLevel::available() {
            for threads in [1, 2, 3, 8] {
                assert!(draw(threads, level) == expected, "{shading:?} {threads} {level:?}");
            }
        }
    }
}

#[test]
fn point_lights_in_odd_places_end_in_pixels() {
    for position in [[f32::NAN, 0.0, 0.0], [f32::INFINITY; 3], [1e30; 3], [HALF; 3], [1.0, 0.0, 0.8], [1e-30; 3]] {
        let mut scene = room(Some(BLOCKER), ShadowSettings { resolution: 0, radius: 99, ..ShadowSettings::default() });
        scene.lights[0].kind = LightKind::Point { position, range: 1.0 };
        draw(&scene, 0);
        scene.shadows.bias = f32::NAN;
        scene.shadows.bias_slope = f32::INFINITY;
        draw(&scene, 0);
    }
}
