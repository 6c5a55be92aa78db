//! Pipeline and vertices: rows 1 to 12 and 140 to 142 of the checklist.

use std::collections::BTreeSet;
use std::sync::Mutex;

use rastrum::SimdLevel;
use rastrum::space::*;

use crate::oracle::{Random, rays};
use crate::space_support::*;

#[test]
fn s001_the_stages_one_after_another_are_the_draw() {
    let mut random = Random::new(1);
    let scene = random_scene(&mut random, 20);
    let projection = camera::perspective(1.1, 1.0, 0.5, 20.0);
    let view: Vec<[f32; 3]> = scene.iter().flatten().map(|p| p.map(|v| v as f32)).collect();
    // Stage 1, vertices: a function on one vertex.
    let vertex = vertex_fn(3, |p: &[f32; 3], out: &mut [f32]| {
        out.copy_from_slice(&p.map(|v| v * 0.1 + 0.5));
        camera::transform(&projection, [p[0], p[1], p[2], 1.0])
    });
    // Stage 3, fragments: a function on one fragment.
    let color = |f: &Fragment| [f.varyings[0], f.varyings[1], 0.5, 1.0];

    let pipeline = Pipeline::new(64, 64).with_threads(1);
    let mut direct = Target::new(64, 64).unwrap();
    let shader = pixel_fn(3, |f: &Fragment| Some(color(f)));
    pipeline.draw(&mut direct, &Primitives::triangles(&view), &vertex, &shader);

    let shaded: Vec<Vertex> = view
        .iter()
        .map(|p| {
            let mut out = [0.0; 3];
            let position = vertex.shade(p, &mut out);
            Vertex::new(position, [out[0], out[1], out[2], 0.0])
        })
        .collect();
    // Stage 2, rasterization: vertices in, fragments out, no framebuffer.
    let fragments = Mutex::new(Vec::new());
    let raster = pixel_fn(3, |f: &Fragment| {
        fragments.lock().unwrap().push(*f);
        None
    });
    let mut nothing = Target::new(64, 64).unwrap();
    let off = pipeline.with_state(State { depth: Depth::OFF, ..State::default() });
    off.draw(&mut nothing, &Primitives::triangles(&shaded), &pass(), &raster);
    assert!(drawn(&nothing).is_empty());
    // Stage 4, the framebuffer: the nearest wins.
    let mut frame = vec![([0_u8; 4], DepthFormat::D32F.key(1.0)); 64 * 64];
    for f in fragments.into_inner().unwrap() {
        let stored = &mut frame[(f.y * 64 + f.x) as usize];
        let key = DepthFormat::D32F.key(f.depth.clamp(0.0, 1.0));
        if key < stored.1 {
            *stored = (color(&f).map(|v| (v.clamp(0.0, 1.0) * 255.0 + 0.5) as u8), key);
        }
    }
    let bytes: Vec<u8> = frame.iter().flat_map(|(color, _)| *color).collect();
    assert!(direct.to_pixmap().unwrap().data() == bytes);
    assert!(bytes.iter().filter(|v| **v != 0).count() > 2000);
}

#[test]
fn s002_the_nearest_triangle_is_the_one_that_a_ray_meets_first() {
    let mut random = Random::new(2);
    let projection = camera::perspective(1.2, 1.0, 0.5, 20.0);
    let tan_half = 1.0 / f64::from(projection.to_cols_array_2d()[1][1]);
    for round in 0..5 {
        let scene = random_scene(&mut random, 50);
        let list = projected(&scene, &projection, |_, _| [0.0; 4]);
        let mut target = Target::new(96, 96).unwrap();
        Pipeline::new(96, 96).draw(&mut target, &Primitives::triangles(&list), &pass(), &PrimitiveIds);
        let mut compared = 0;
        for (x, y) in (0..96).flat_map(|y| (0..96).map(move |x| (x, y))) {
            let ray = rays::through(x, y, (96, 96), tan_half);
            let Some(nearest) = rays::nearest([0.0; 3], ray, &scene, 0.01) else { continue };
            // Where two are as near as the depth resolves, either may win.
            let second = scene.iter().enumerate().filter_map(|(i, t)| rays::meet([0.0; 3], ray, *t).map(|h| (i, h)));
            let close = |hit: &rays::Hit| nearest.is_some_and(|(_, n)| (hit.t - n.t).abs() < 1e-3);
            if second.filter(|(_, hit)| hit.margin() > 0.0 && close(hit)).count() > 1 {
                continue;
            }
            compared += 1;
            let [r, g, b, _] = target.pixel(x, y).unwrap();
            let id = u32::from_le_bytes([r, g, b, 0]);
            assert_eq!(id, nearest.map_or(0, |(i, _)| i as u32 + 1), "round {round} at {x}, {y}");
        }
        assert!(compared > 6000, "{compared}");
    }
}

/// The oracle of row 2, image order, on what can be computed by hand.
#[test]
fn s003_a_ray_meets_triangles_where_arithmetic_says() {
    let near = [[-1.0, -1.0, -4.0], [3.0, -1.0, -4.0], [-1.0, 3.0, -4.0]];
    let far = near.map(|[x, y, _]| [x, y, -8.0]);
    let hit = rays::meet([0.0; 3], [0.0, 0.0, -1.0], near).unwrap();
    assert!((hit.t - 4.0).abs() < 1e-9 && hit.margin() > 0.0);
    // Twice as far away, and beside the triangle: the plane is met all the same.
    assert!((rays::meet([0.0; 3], [0.5, 0.0, -1.0], far).unwrap().t - 8.0).abs() < 1e-9);
    // Past the hypotenuse, behind the eye and along the plane there is nothing to meet.
    for direction in [[0.6, 0.6, -1.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]] {
        assert!(
            rays::meet([0.0; 3], direction, near).is_none_or(|hit| hit.t < 0.0 || hit.margin() < 0.0),
            "{direction:?}"
        );
    }
    for scene in [[near, far], [far, near]] {
        let (index, hit) = rays::nearest([0.0; 3], [0.0, 0.0, -1.0], &scene, 0.01).unwrap().unwrap();
        assert_eq!((scene[index], hit.t), (near, 4.0));
    }
}

#[test]
fn s004_ndc_plus_and_minus_one_are_the_viewports_corners() {
    let viewport = Viewport { x: 10.0, y: 20.0, width: 100.0, height: 50.0, ..Viewport::new(1, 1) };
    assert_eq!(viewport.project([-1.0, -1.0, -1.0, 1.0]), [10.0, 70.0, 0.0]);
    assert_eq!(viewport.project([2.0, 2.0, 2.0, 2.0]), [110.0, 20.0, 1.0]);
    // A triangle around all of it fills the viewport alone.
    let list = [[-9.0, -9.0], [9.0, -9.0], [0.0, 18.0]].map(|[x, y]| Vertex::new([x, y, 0.0, 1.0], [1.0; 4]));
    let mut target = Target::new(128, 128).unwrap();
    let pipeline = Pipeline { viewport, ..Pipeline::new(128, 128) };
    pipeline.draw(&mut target, &Primitives::triangles(&list), &pass(), &Values);
    let expected: BTreeSet<_> = (20..70).flat_map(|y| (10..110).map(move |x| (x, y))).collect();
    assert_eq!(drawn(&target), expected);
    // Outside in any direction: no fragment.
    for (axis, sign) in (0..3).flat_map(|axis| [(axis, 1.0), (axis, -1.0)]) {
        let list = [[0.0, 0.0], [0.5, 0.0], [0.0, 0.5]].map(|[x, y]| {
            let mut p = [x, y, 0.0, 1.0];
            p[axis] += sign * 1.6;
            Vertex::new(p, [1.0; 4])
        });
        let mut target = Target::new(128, 128).unwrap();
        let counters = pipeline.draw(&mut target, &Primitives::triangles(&list), &pass(), &Values);
        assert_eq!((counters.fragments, counters.outside), (0, 1), "{axis} {sign}");
    }
}

#[test]
fn s005_a_vertex_goes_through_model_view_and_projection() {
    let model = camera::product(&camera::translation([1.0, 2.0, -3.0]), &camera::rotation([0.0, 1.0, 0.0], 0.5));
    let view = camera::look_at([0.0, 1.0, 5.0], [0.0, 0.0, 0.0], [0.0, 1.0, 0.0]);
    let projection = camera::perspective(0.9, 1.5, 0.1, 50.0);
    let p = [0.3_f32, -0.2, 0.7, 1.0];
    let whole = camera::product(&camera::product(&projection, &view), &model);
    // By hand in double precision, row by row.
    let multiply = |m: &rastrum::glam::Mat4, v: [f64; 4]| {
        let m = m.to_cols_array_2d();
        [0, 1, 2, 3].map(|r| (0..4).map(|c| f64::from(m[c][r]) * v[c]).sum::<f64>())
    };
    let expected = multiply(&projection, multiply(&view, multiply(&model, p.map(f64::from))));
    for (got, expected) in camera::transform(&whole, p).iter().zip(expected) {
        assert!((f64::from(*got) - expected).abs() < 1e-5, "{got} {expected}");
    }
    // The view matrix is V⁻¹: it takes the eye to the origin and what is looked at onto −z.
    let eye = camera::transform(&view, [0.0, 1.0, 5.0, 1.0]);
    let at = camera::transform(&view, [0.0, 0.0, 0.0, 1.0]);
    assert!(eye[..3].iter().all(|v| v.abs() < 1e-6));
    assert!(at[0].abs() < 1e-6 && at[1].abs() < 1e-6 && (at[2] + 26_f32.sqrt()).abs() < 1e-5);
    // And the inverse undoes it.
    let back = camera::transform(&camera::inverse(&view).unwrap(), at);
    assert!(back[..3].iter().all(|v| v.abs() < 1e-5));
}

#[test]
fn s006_the_perspective_matrix() {
    let (l, r, b, t, n, f) = (-2.0, 3.0, -1.0, 2.0, 1.5, 20.0);
    let m = camera::frustum(l, r, b, t, n, f);
    let row = |i: usize| m.to_cols_array_2d().map(|column| column[i]);
    assert_eq!(row(0), [2.0 * n / (r - l), 0.0, (r + l) / (r - l), 0.0]);
    assert_eq!(row(3), [0.0, 0.0, -1.0, 0.0]);
    // The near rectangle's corners are NDC corners at −1; the far rectangle's at +1; w is the view distance.
    for (x, y, nx, ny) in [(l, b, -1.0, -1.0), (r, t, 1.0, 1.0), (l, t, -1.0, 1.0)] {
        for (z, k, nz) in [(n, 1.0, -1.0), (f, f / n, 1.0)] {
            let [cx, cy, cz, cw] = camera::transform(&m, [x * k, y * k, -z, 1.0]);
            assert!((cw - z).abs() < 1e-5);
            let expected = [nx, ny, nz];
            for (got, expected) in [cx / cw, cy / cw, cz / cw].iter().zip(expected) {
                assert!((got - expected).abs() < 1e-5, "{got} {expected}");
            }
        }
    }
}

#[test]
fn s007_parallel_projection_is_linear_in_depth_and_does_not_shorten() {
    let m = camera::orthographic(-4.0, 4.0, -3.0, 3.0, 1.0, 9.0);
    for z in [1.0, 3.0, 5.0, 9.0] {
        let [x, y, depth, w] = camera::transform(&m, [2.0, 1.5, -z, 1.0]);
        assert_eq!((x, y, w), (0.5, 0.5, 1.0));
        assert!((depth - ((z - 1.0) / 4.0 - 1.0)).abs() < 1e-6);
    }
    // The same quad at two distances draws the same pixels.
    let quad = |z: f32| {
        let corner = |x: f32, y: f32| Vertex::new(camera::transform(&m, [x, y, -z, 1.0]), [1.0; 4]);
        [corner(-1.0, -1.0), corner(2.0, -1.0), corner(-1.0, 2.5)]
    };
    let pipeline = Pipeline::new(64, 48);
    let draw = |z: f32| {
        let mut target = Target::new(64, 48).unwrap();
        pipeline.draw(&mut target, &Primitives::triangles(&quad(z)), &pass(), &Values);
        drawn(&target)
    };
    assert_eq!(draw(2.0), draw(8.0));
    assert!(draw(2.0).len() > 100);
}

#[test]
fn s008_vertex_attributes_reach_each_fragment() {
    // Position, RGBA, u and v, and depth.
    let shader = vertex_fn(6, |v: &([f32; 4], [f32; 4], [f32; 2]), out: &mut [f32]| {
        out[..4].copy_from_slice(&v.1);
        out[4..].copy_from_slice(&v.2);
        v.0
    });
    let list: Vec<_> = [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)]
        .map(|(u, v)| (device(64.0 * u, 64.0 * v, 0.25 + 0.5 * u, 1.0, 64.0), [u, v, 1.0 - u, 1.0], [u * 4.0, v * 8.0]))
        .to_vec();
    let seen = Mutex::new(0);
    let fragment = pixel_fn(6, |f: &Fragment| {
        let (u, v) = ((f.x as f32 + 0.5) / 64.0, (f.y as f32 + 0.5) / 64.0);
        let expected = [u, v, 1.0 - u, 1.0, u * 4.0, v * 8.0];
        for (got, expected) in f.varyings.iter().zip(expected) {
            assert!((got - expected).abs() < 1e-5);
        }
        assert!((f.depth - (0.25 + 0.5 * u)).abs() < 1e-6 && f.w == 1.0 && f.primitive == 0);
        *seen.lock().unwrap() += 1;
        Some([1.0; 4])
    });
    let mut target = Target::new(64, 64).unwrap();
    Pipeline::new(64, 64).draw(&mut target, &Primitives::triangles(&list), &shader, &fragment);
    assert!(seen.into_inner().unwrap() > 2000);
}

#[test]
fn s009_gouraud_shading_is_phong_at_the_vertices_and_linear_between() {
    let light = rays::normalize([1.0, 2.0, 3.0]);
    let phong = |n: [f32; 3]| {
        let n = rays::normalize(n.map(f64::from));
        (0.1 + 0.9 * rays::dot(n, light).max(0.0)) as f32
    };
    let normals = [[0.0, 0.0, 1.0], [1.0, 0.0, 0.2], [-1.0, 0.3, 0.1]];
    let places = [(0.5, 0.5), (62.5, 0.5), (0.5, 62.5)];
    let shader = vertex_fn(3, |v: &([f32; 4], [f32; 3]), out: &mut [f32]| {
        out.fill(phong(v.1));
        v.0
    });
    let list: Vec<_> = places.iter().zip(normals).map(|((x, y), n)| (device(*x, *y, 0.5, 1.0, 64.0), n)).collect();
    let mut target = Target::new(64, 64).unwrap();
    Pipeline::new(64, 64).draw(&mut target, &Primitives::triangles(&list), &shader, &VertexColor);
    let at = normals.map(phong);
    for (x, y) in drawn(&target) {
        let (u, v) = (x as f32 / 62.0, y as f32 / 62.0);
        let expected = ((at[0] * (1.0 - u - v) + at[1] * u + at[2] * v) * 255.0).round() as i32;
        let got = i32::from(target.pixel(x as u32, y as u32).unwrap()[0]);
        assert!((got - expected).abs() <= 1, "{x} {y}: {got} {expected}");
    }
    assert_eq!(i32::from(target.pixel(0, 0).unwrap()[0]), (at[0] * 255.0).round() as i32);
}

#[test]
fn s010_list_strip_fan_and_indexed_forms_are_the_same_triangles() {
    // A ring of points around a centre, and a zigzag band.
    let place = |x: f32, y: f32| Vertex::new(device(x, y, 0.5, 1.0, 64.0), [1.0, 0.5, 0.25, 1.0]);
    let band: Vec<Vertex> =
        (0..10).map(|i| place(4.0 + 6.0 * i as f32, if i % 2 == 0 { 10.0 } else { 50.0 })).collect();
    let draw = |primitives: &Primitives<'_, Vertex>, cull: Cull| {
        let mut target = Target::new(64, 64).unwrap();
        let pipeline = Pipeline::new(64, 64).with_state(State { cull, ..State::default() });
        pipeline.draw(&mut target, primitives, &pass(), &PrimitiveIds);
        target.to_pixmap().unwrap()
    };
    let strip = Primitives::new(&band, Topology::TriangleStrip);
    assert_eq!(strip.count(), 8);
    let list: Vec<Vertex> = strip.iter().flatten().map(|i| band[i as usize]).collect();
    let indices: Vec<u32> = strip.iter().flatten().collect();
    assert_eq!(indices[..6], [0, 1, 2, 1, 3, 2]);
    for cull in [Cull::None, Cull::Back, Cull::Front] {
        let expected = draw(&strip, cull);
        assert_eq!(draw(&Primitives::triangles(&list), cull), expected);
        assert_eq!(draw(&Primitives::indexed(&band, &indices), cull), expected);
        // All of a strip's triangles wind alike: culling takes all or none.
        let empty = expected.data().iter().all(|v| *v == 0);
        assert_eq!(empty, cull == Cull::Front, "{cull:?}");
    }
    let mut hub = vec![place(32.0, 32.0)];
    hub.extend([(60.0, 32.0), (50.0, 50.0), (32.0, 60.0), (10.0, 50.0), (4.0, 30.0)].map(|(x, y)| place(x, y)));
    let fan = Primitives::new(&hub, Topology::TriangleFan);
    let indices: Vec<u32> = fan.iter().flatten().collect();
    assert_eq!(indices, [0, 1, 2, 0, 2, 3, 0, 3, 4, 0, 4, 5]);
    assert_eq!(draw(&fan, Cull::None), draw(&Primitives::indexed(&hub, &indices), Cull::None));
    // Each vertex is shaded once, however often it is used.
    let calls = Mutex::new(0);
    let counted = vertex_fn(0, |v: &Vertex, _: &mut [f32]| {
        *calls.lock().unwrap() += 1;
        v.position
    });
    let mut target = Target::new(64, 64).unwrap();
    Pipeline::new(64, 64).draw(&mut target, &Primitives::indexed(&hub, &indices), &counted, &ONE);
    assert_eq!(calls.into_inner().unwrap(), hub.len());
}

#[test]
fn s011_points_are_squares_of_their_size() {
    let mut random = Random::new(11);
    for _ in 0..200 {
        let (x, y) = (random.within(1..64 * 256), random.within(1..64 * 256));
        let point = [Vertex::new(device(x as f32 / 256.0, y as f32 / 256.0, 0.5, 1.0, 64.0), [1.0; 4])];
        let draw = |size: f32| {
            let mut target = Target::new(64, 64).unwrap();
            let pipeline = Pipeline::new(64, 64).with_state(State { point_size: size, ..State::default() });
            pipeline.draw(&mut target, &Primitives::new(&point, Topology::Points), &pass(), &Values);
            drawn(&target)
        };
        if x % 256 != 0 && y % 256 != 0 {
            assert_eq!(draw(1.0).into_iter().collect::<Vec<_>>(), [(x as i32 >> 8, y as i32 >> 8)]);
        }
        for size in [2, 3, 8] {
            // n × n pixels, as far as they are on the target.
            let square = draw(size as f32);
            let first = |v: i64| ((v - 128 * size + 127) >> 8) as i32;
            let expected: BTreeSet<_> = (0..size as i32)
                .flat_map(|j| (0..size as i32).map(move |i| (i, j)))
                .map(|(i, j)| (first(x) + i, first(y) + j))
                .filter(|(x, y)| (0..64).contains(x) && (0..64).contains(y))
                .collect();
            assert_eq!(square, expected, "{x} {y} {size}");
        }
    }
}

#[test]
fn s012_a_strip_of_segments_draws_each_joint_once() {
    let mut random = Random::new(12);
    for _ in 0..100 {
        // Distinct pixels in a chain whose segments meet at the joints alone: x grows by at least 2.
        let points: Vec<(i32, i32)> = (0..8).map(|i| (4 + 7 * i, random.within(2..62) as i32)).collect();
        let list: Vec<Vertex> = points
            .iter()
            .map(|(x, y)| Vertex::new(device(*x as f32 + 0.5, *y as f32 + 0.5, 0.5, 1.0, 64.0), [0.0; 4]))
            .collect();
        let draw = |topology: Topology| {
            let mut target = Target::new(64, 64).unwrap();
            counting(64).draw(&mut target, &Primitives::new(&list, topology), &pass(), &ONE);
            target
        };
        let strip = draw(Topology::LineStrip);
        for (x, y) in &points {
            assert_eq!(strip.pixel(*x as u32, *y as u32).unwrap()[3], 1, "a joint or an end");
        }
        // Bresenham's pixels of each segment.
        let expected: BTreeSet<_> =
            points.windows(2).flat_map(|pair| rastrum::raster::line::bresenham(pair[0], pair[1])).collect();
        let got = drawn(&strip);
        assert_eq!(got, expected);
        // Separate lines draw both ends; a loop closes.
        assert!(draw(Topology::Lines).pixel(points[1].0 as u32, points[1].1 as u32).unwrap()[3] == 1);
        assert!(counts(&draw(Topology::LineLoop)).iter().filter(|c| **c > 0).count() > got.len());
    }
}

#[test]
fn s140_no_graphics_interface_is_in_the_dependency_tree() {
    let lock = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/Cargo.lock")).unwrap();
    let names: Vec<&str> = lock.lines().filter_map(|line| line.strip_prefix("name = ")).collect();
    assert!(names.len() > 20);
    for name in names {
        let name = name.trim_matches('"');
        let gpu = ["wgpu", "ash", "vulkano", "glow", "gl", "glutin", "metal", "opencl3", "cudarc", "glium", "d3d12"];
        assert!(!gpu.contains(&name) && !name.starts_with("wgpu"), "{name}");
    }
}

#[test]
fn s141_threads_and_levels_give_the_same_bytes() {
    let mut random = Random::new(141);
    let scene = random_scene(&mut random, 200);
    let projection = camera::perspective(1.3, 1.0, 0.5, 9.0);
    let list = projected(&scene, &projection, |i, k| [i as f32 / 200.0, k as f32 / 2.0, 0.3, 0.8]);
    for samples in Samples::ALL {
        let draw = |threads: usize, level: SimdLevel| {
            let mut target = Target::with_format(150, 130, DepthFormat::D24, samples).unwrap();
            let mut pipeline = Pipeline::new(150, 130).with_threads(threads).with_level(level);
            let counters = pipeline.draw(&mut target, &Primitives::triangles(&list), &pass(), &Values);
            pipeline.state.blend = Blend::SourceOver;
            pipeline.state.fill = Fill::Wireframe;
            pipeline.state.depth = Depth { write: false, ..Depth::compare(Compare::LessEqual) };
            pipeline.draw(&mut target, &Primitives::triangles(&list), &pass(), &Values);
            (target.to_pixmap().unwrap(), target.depths(), counters.samples_passed)
        };
        let expected = draw(1, SimdLevel::Scalar);
        for level in SimdLevel::available() {
            for threads in [1, 2, 3, 8] {
                assert!(draw(threads, level) == expected, "{samples:?} {threads} {level:?}");
            }
        }
    }
}

#[test]
fn s142_micropolygons_of_a_patch_are_its_tessellation() {
    // A bicubic patch diced so finely that no side is longer than a pixel, and the same patch as triangles of several pixels: the same
    // silhouette within a pixel and the same colours within 2.
    let patch: [[[f32; 3]; 4]; 4] = std::array::from_fn(|j| {
        std::array::from_fn(|i| {
            [i as f32 / 1.5 - 1.0, j as f32 / 1.5 - 1.0, if (i + j) % 2 == 0 { 0.4 } else { -0.3 } - 3.0]
        })
    });
    let bernstein = |t: f32| {
        let s = 1.0 - t;
        [s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t]
    };
    let at = |u: f32, v: f32| {
        let (bu, bv) = (bernstein(u), bernstein(v));
        let mut p = [0.0; 3];
        for j in 0..4 {
            for i in 0..4 {
                for k in 0..3 {
                    p[k] += bu[i] * bv[j] * patch[j][i][k];
                }
            }
        }
        p
    };
    let projection = camera::perspective(0.9, 1.0, 1.0, 10.0);
    let dice = |n: usize| {
        let mut vertices = Vec::new();
        for j in 0..=n {
            for i in 0..=n {
                let (u, v) = (i as f32 / n as f32, j as f32 / n as f32);
                let [x, y, z] = at(u, v);
                vertices.push(Vertex::new(camera::transform(&projection, [x, y, z, 1.0]), [u, v, 0.5, 1.0]));
            }
        }
        let mut indices = Vec::new();
        for j in 0..n {
            for i in 0..n {
                let a = (j * (n + 1) + i) as u32;
                let (b, d, c) = (a + 1, a + n as u32 + 1, a + n as u32 + 2);
                indices.extend([a, b, c, a, c, d]);
            }
        }
        let mut target = Target::new(128, 128).unwrap();
        Pipeline::new(128, 128).draw(&mut target, &Primitives::indexed(&vertices, &indices), &pass(), &Values);
        target
    };
    let (fine, coarse) = (dice(160), dice(24));
    let (a, b) = (drawn(&fine), drawn(&coarse));
    assert!(a.len() > 5000);
    for (x, y) in a.symmetric_difference(&b) {
        let near = |set: &BTreeSet<(i32, i32)>| {
            (-1..=1).flat_map(|j| (-1..=1).map(move |i| (i, j))).any(|(i, j)| !set.contains(&(x + i, y + j)))
        };
        assert!(near(&a) || near(&b), "{x} {y}");
    }
    for (x, y) in a.intersection(&b) {
        let (p, q) = (fine.pixel(*x as u32, *y as u32).unwrap(), coarse.pixel(*x as u32, *y as u32).unwrap());
        assert!(p.iter().zip(q).all(|(p, q)| p.abs_diff(q) <= 2), "{x} {y}: {p:?} {q:?}");
    }
}
