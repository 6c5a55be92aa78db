//! Culling and what finds the way to it: rows 132 to 138 of the checklist.

use rastrum::glam::Mat4;
use rastrum::scene::*;
use rastrum::space::*;

use crate::oracle::Random;
use crate::seeds_scene::{camera, scene_of, shift, square, unlit};
use crate::space_support::{Values, pass};

#[test]
fn s132_backface_culling_by_the_normal_is_that_by_the_signed_area() {
    // Parallel rays along −z: l·N > 0 with l towards the viewer.
    let mesh = Mesh::sphere(0.9, 40, 24, 0);
    let mut agree = 0;
    for triangle in mesh.triangles() {
        let [a, b, c] = triangle.map(|i| mesh.vertices[i as usize].position);
        let (u, v): ([f32; 3], [f32; 3]) = (std::array::from_fn(|i| b[i] - a[i]), std::array::from_fn(|i| c[i] - a[i]));
        let facing = u[0] * v[1] - u[1] * v[0];
        let list = [a, b, c].map(|[x, y, z]| crate::space_support::Vertex::new([x, y, z, 1.0], [1.0; 4]));
        let state = State { cull: Cull::Back, ..State::default() };
        let mut target = Target::new(512, 512).unwrap();
        let counters = Pipeline::new(512, 512).with_state(state).with_threads(1).draw(
            &mut target,
            &Primitives::triangles(&list),
            &pass(),
            &Values,
        );
        if facing.abs() > 1e-4 {
            assert_eq!(counters.culled == 0, facing > 0.0);
            agree += 1;
        }
    }
    assert!(agree > 1000);
    // A closed mesh looks the same without its backs, with half the work.
    let mut scene = scene_of(vec![(mesh, Material::default(), Mat4::IDENTITY)]);
    scene.lights.push(Light::directional([1.0, 1.0, 1.0]));
    let draw = |cull: Cull| {
        let settings = SceneSettings { cull: Some(cull), ..SceneSettings::default() };
        render_picture(&scene, &camera(), 64, 64, &settings).unwrap()
    };
    let (all, fronts) = (draw(Cull::None), draw(Cull::Back));
    assert!(all.0 == fronts.0);
    assert!(fronts.1.counters.culled * 3 > fronts.1.counters.primitives);
}

/// Many small boxes around the camera.
fn crowd(seed: u64, count: usize) -> Scene {
    let mut random = Random::new(seed);
    let parts = (0..count)
        .map(|_| {
            let mut at = |r: i64| random.within(-r * 100..r * 100) as f32 / 100.0;
            let place = shift(at(20), at(20), at(20));
            let color = [at(1).abs(), at(1).abs(), at(1).abs(), 1.0];
            (Mesh::cuboid([-0.6, -0.6, -0.6], [0.6, 0.6, 0.6], 0), unlit(color, AlphaMode::Opaque), place)
        })
        .collect();
    scene_of(parts)
}

#[test]
fn s133_frustum_culling_never_culls_what_is_seen() {
    let scene = crowd(133, 300);
    let draw = |frustum_culling: bool| {
        let settings = SceneSettings { frustum_culling, ..SceneSettings::default() };
        render_picture(&scene, &camera(), 96, 96, &settings).unwrap()
    };
    let (with, without) = (draw(true), draw(false));
    assert!(with.0 == without.0);
    assert!(with.1.frustum_culled > 100 && without.1.frustum_culled == 0, "{:?}", with.1);
    assert!(with.1.counters.vertices < without.1.counters.vertices);
}

#[test]
fn s134_occlusion_culling_skips_what_is_hidden_and_shows_the_same() {
    let mut scene = crowd(134, 300);
    let wall = scene.add_material(unlit([0.5, 0.5, 0.5, 1.0], AlphaMode::Opaque));
    scene.add_mesh("wall", square(2.5, 2.0, wall), Mat4::IDENTITY);
    let draw = |occlusion_culling: bool| {
        let settings = SceneSettings { occlusion_culling, ..SceneSettings::default() };
        render_picture(&scene, &camera(), 96, 96, &settings).unwrap()
    };
    let (with, without) = (draw(true), draw(false));
    assert!(with.0 == without.0);
    assert!(with.1.occlusion_culled > 20 && without.1.occlusion_culled == 0, "{:?}", with.1);
}

#[test]
fn s135_boxes_are_exact_and_do_not_mind_nan() {
    let t = [[1.0, -2.0, 3.0], [0.5, 7.0, -1.0], [2.0, 0.0, 0.0]];
    let bounds = Aabb::of_points(t);
    assert_eq!((bounds.min, bounds.max), ([0.5, -2.0, -1.0], [2.0, 7.0, 3.0]));
    let with_bad = Aabb::of_points(t.into_iter().chain([[f32::NAN, 0.0, 0.0], [0.0, f32::INFINITY, 0.0]]));
    assert_eq!(with_bad, bounds);
    assert!(Aabb::of_points([[f32::NAN; 3]]).is_empty() && Aabb::EMPTY.is_empty() && !bounds.is_empty());
    let mesh = Mesh::sphere(2.0, 64, 32, 0);
    let own = mesh.bounds();
    for v in &mesh.vertices {
        assert!((0..3).all(|i| own.min[i] <= v.position[i] && v.position[i] <= own.max[i]));
    }
    assert_eq!((own.min[1], own.max[1]), (-2.0, 2.0));
    assert_eq!(own.union(&bounds).min, [-2.0; 3]);
}

fn random_boxes(seed: u64, count: usize) -> Vec<Aabb> {
    let mut random = Random::new(seed);
    (0..count)
        .map(|_| {
            let mut at = |r: i64| random.within(-r * 100..r * 100) as f32 / 100.0;
            let center = [at(30), at(30), at(30)];
            let half = [at(1).abs() + 0.05, at(1).abs() + 0.05, at(1).abs() + 0.05];
            Aabb {
                min: std::array::from_fn(|i| center[i] - half[i]),
                max: std::array::from_fn(|i| center[i] + half[i]),
            }
        })
        .collect()
}

#[test]
fn s136_every_item_is_in_one_leaf_and_parents_hold_children() {
    for count in [0, 1, 4, 5, 6, 100, 1001] {
        let boxes = random_boxes(136, count);
        let bvh = Bvh::new(&boxes);
        let mut seen = vec![0; count];
        let mut reached = 0;
        let mut stack = if count > 0 { vec![0] } else { Vec::new() };
        while let Some(number) = stack.pop() {
            let node = &bvh.nodes[number];
            reached += 1;
            match node.children {
                Some(children) => {
                    for child in children {
                        assert!(node.bounds.contains(&bvh.nodes[child].bounds));
                        stack.push(child);
                    }
                }
                None => {
                    for item in &bvh.items[node.items.clone()] {
                        seen[*item] += 1;
                        assert!(node.bounds.contains(&boxes[*item]));
                    }
                }
            }
        }
        assert!(seen.iter().all(|n| *n == 1) && reached == bvh.nodes.len());
    }
    // Many in one place do not stop it.
    assert_eq!(Bvh::new(&vec![random_boxes(1, 1)[0]; 500]).items.len(), 500);
}

#[test]
fn s137_a_frustum_query_equals_the_loop_with_fewer_tests() {
    let boxes = random_boxes(137, 5000);
    let bvh = Bvh::new(&boxes);
    let mut random = Random::new(1370);
    for _ in 0..20 {
        let mut at = |r: i64| random.within(-r * 100..r * 100) as f32 / 100.0;
        let camera =
            Camera { far: 20.0, ..Camera::look_at([at(30), at(30), at(30)], [at(5), at(5), at(5)], [0.0, 1.0, 0.0]) };
        let frustum = Frustum::new(&camera::product(&camera.projection_matrix(1.5), &camera.view));
        let expected: Vec<usize> = (0..boxes.len()).filter(|i| frustum.meets(&boxes[*i])).collect();
        let (found, tests) = bvh.query(&frustum);
        assert_eq!(found, expected);
        assert!(tests < boxes.len(), "{tests}");
    }
}

/// The lecture's octree, as a slow oracle: cells of eight, an item in every leaf that its box meets.
fn octree(boxes: &[Aabb], items: &[usize], cell: Aabb, depth: usize, nodes: &mut usize, entries: &mut Vec<usize>) {
    *nodes += 1;
    if items.len() <= 4 || depth == 0 {
        entries.extend(items);
        return;
    }
    let c = cell.center();
    for k in 0..8 {
        let part = Aabb {
            min: std::array::from_fn(|i| if k >> i & 1 == 0 { cell.min[i] } else { c[i] }),
            max: std::array::from_fn(|i| if k >> i & 1 == 0 { c[i] } else { cell.max[i] }),
        };
        let inside: Vec<usize> = items.iter().copied().filter(|i| boxes[*i].meets(&part)).collect();
        octree(boxes, &inside, part, depth - 1, nodes, entries);
    }
}

#[test]
fn s138_an_octree_repeats_objects_and_has_more_nodes() {
    let boxes = random_boxes(138, 1000);
    let bvh = Bvh::new(&boxes);
    let (mut nodes, mut entries) = (0, Vec::new());
    let all: Vec<usize> = (0..boxes.len()).collect();
    octree(&boxes, &all, bvh.nodes[0].bounds, 6, &mut nodes, &mut entries);
    assert!(entries.len() > boxes.len(), "objects repeat: {}", entries.len());
    assert!(bvh.nodes.len() < nodes, "{} {nodes}", bvh.nodes.len());
    entries.sort_unstable();
    entries.dedup();
    assert_eq!(entries, all);
    assert_eq!(bvh.items.len(), boxes.len());
}
