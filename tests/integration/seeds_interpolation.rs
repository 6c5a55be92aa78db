//! Interpolation and clipping: rows 74 to 88 of the checklist.

use std::sync::Mutex;

use rastrum::fearless_simd::{Simd, prelude::*};
use rastrum::space::*;

use crate::oracle::triangle as oracle;
use crate::oracle::{Random, rays};
use crate::space_support::*;

/// What a draw's fragments were, in whatever order.
fn fragments(size: u32, list: &[Vertex]) -> Vec<Fragment> {
    let seen = Mutex::new(Vec::new());
    let shader = pixel_fn(4, |fragment: &Fragment| {
        seen.lock().unwrap().push(*fragment);
        Some([1.0; 4])
    });
    let mut target = Target::new(size, size).unwrap();
    counting(size).draw(&mut target, &Primitives::triangles(list), &pass(), &shader);
    seen.into_inner().unwrap()
}

/// Notes barycentrics, screen-linear and perspective values of each pixel.
#[derive(Default)]
struct Notes(Mutex<Vec<Note>>);

#[derive(Clone, Copy, Debug)]
struct Note {
    x: u32,
    y: u32,
    weights: [f32; 3],
    linear: f32,
    varying: f32,
    steps: (f32, f32),
}

impl FragmentShader for Notes {
    #[inline(always)]
    fn shade<S: Simd>(&self, f: &Fragments<'_, S>) -> Shade<S> {
        let weights = f.barycentrics().map(|w| w.to_array());
        let (linear, varying) = (f.linear(0).to_array(), f.varying(0).to_array());
        let (right, down) = f.derivatives(0);
        let (right, down) = (right.to_array(), down.to_array());
        for i in (0..8).filter(|i| f.mask() >> i & 1 == 1) {
            self.0.lock().unwrap().push(Note {
                x: f.x() + i as u32,
                y: f.y(),
                weights: weights.map(|w| w[i]),
                linear: linear[i],
                varying: varying[i],
                steps: (right[i], down[i]),
            });
        }
        Shade::color([f.varying(0); 4])
    }
}

fn notes(size: u32, list: &[Vertex]) -> Vec<Note> {
    let shader = Notes::default();
    let mut target = Target::new(size, size).unwrap();
    counting(size).draw(&mut target, &Primitives::triangles(list), &pass(), &shader);
    shader.0.into_inner().unwrap()
}

fn point(x: u32, y: u32) -> (i64, i64) {
    oracle::center((x as i32, y as i32))
}

#[test]
fn s074_barycentrics_are_areas_over_the_area() {
    let mut random = Random::new(74);
    for _ in 0..200 {
        let Some([a, b, c]) = oracle::oriented(random_triangle(&mut random, 64, 8)) else { continue };
        let area = oracle::edge(a, b, c) as f64;
        if area < 65536.0 * 8.0 {
            continue;
        }
        for note in notes(64, &vertices([a, b, c], 0.5, [0.0; 4], 64.0)) {
            let p = point(note.x, note.y);
            let expected = [(b, c), (c, a), (a, b)].map(|(q, r)| oracle::edge(q, r, p) as f64 / area);
            assert!((note.weights.iter().sum::<f32>() - 1.0).abs() < 1e-6);
            for (got, expected) in note.weights.iter().zip(expected) {
                assert!((f64::from(*got) - expected).abs() < 2e-5, "{note:?} {expected}");
            }
        }
    }
    // Corners on centres have unit weights: the formula, at the corners themselves.
    let t = [(128, 128), (128 + 256 * 40, 128), (128, 128 + 256 * 40)];
    let corner = notes(64, &vertices(t, 0.5, [0.0; 4], 64.0)).into_iter().find(|n| (n.x, n.y) == (0, 0)).unwrap();
    assert_eq!(corner.weights, [1.0, 0.0, 0.0]);
}

#[test]
fn s075_u_and_v_are_edge_functions_over_twice_the_area() {
    let [a, b, c] = [(700, 300), (15_000, 4000), (2500, 14_500)];
    let area = oracle::edge(a, b, c) as f64;
    let seen = notes(64, &vertices([a, b, c], 0.5, [0.0; 4], 64.0));
    assert!(seen.len() > 500);
    for note in seen {
        let p = point(note.x, note.y);
        // u belongs to b: the edge opposite to it is c → a.
        let (u, v) = (oracle::edge(c, a, p) as f64 / area, oracle::edge(a, b, p) as f64 / area);
        assert!((f64::from(note.weights[1]) - u).abs() < 1e-6 && (f64::from(note.weights[2]) - v).abs() < 1e-6);
    }
}

#[test]
fn s076_without_perspective_values_are_linear_on_the_screen() {
    let t = [(700, 300), (15_000, 4000), (2500, 14_500)];
    let values = [0.1_f32, 0.9, 0.4];
    let mut list = vertices(t, 0.5, [0.0; 4], 64.0);
    for ((vertex, value), w) in list.iter_mut().zip(values).zip([1.0, 4.0, 2.0]) {
        vertex.values[0] = value;
        vertex.position = vertex.position.map(|p| p * w);
    }
    let area = oracle::edge(t[0], t[1], t[2]) as f64;
    let mut apart = 0.0_f32;
    for note in notes(64, &list) {
        let p = point(note.x, note.y);
        let w = [(t[1], t[2]), (t[2], t[0]), (t[0], t[1])].map(|(q, r)| oracle::edge(q, r, p) as f64 / area);
        let expected: f64 = w.iter().zip(values).map(|(w, v)| w * f64::from(v)).sum();
        assert!((f64::from(note.linear) - expected).abs() < 1e-5);
        apart = apart.max((note.linear - note.varying).abs());
    }
    assert!(apart > 0.05, "with different w, perspective is something else: {apart}");
}

/// A tilted checker plane, its u by the pipeline and by ray casting; also by the closed forms, which must agree within 1e-5.
fn perspective_against_rays(check: impl Fn(f64, f64, f64)) {
    let projection = camera::perspective(1.0, 1.0, 0.5, 100.0);
    let tan_half = f64::from(0.5_f32).tan_half();
    let plane = [[-4.0, -1.0, -2.0], [4.0, -1.5, -3.0], [0.5, 3.0, -40.0]];
    let uv = [0.0_f32, 8.0, 3.0];
    let list = projected(&[plane], &projection, |_, k| [uv[k], 0.0, 0.0, 1.0]);
    let seen = fragments(64, &list);
    assert!(seen.len() > 400);
    let screen = list.iter().map(|v| Viewport::new(64, 64).project(v.position).map(f64::from)).collect::<Vec<_>>();
    for f in seen {
        let ray = rays::through(f.x, f.y, (64, 64), tan_half);
        let hit = rays::meet([0.0; 3], ray, plane).unwrap();
        let expected = f64::from(uv[0]) * (1.0 - hit.u - hit.v) + f64::from(uv[1]) * hit.u + f64::from(uv[2]) * hit.v;
        check(f64::from(f.varyings[0]), expected, f64::from(f.w));
        // The lecture's closed form with weights on the screen.
        let p = (f64::from(f.x) + 0.5, f64::from(f.y) + 0.5);
        let edge = |a: &[f64], b: &[f64]| (b[0] - a[0]) * (p.1 - a[1]) - (b[1] - a[1]) * (p.0 - a[0]);
        let e = [edge(&screen[1], &screen[2]), edge(&screen[2], &screen[0]), edge(&screen[0], &screen[1])];
        let z = [0, 1, 2].map(|i| f64::from(list[i].position[3]));
        let over: Vec<f64> = (0..3).map(|i| e[i] / z[i]).collect();
        let closed = (0..3).map(|i| over[i] * f64::from(uv[i])).sum::<f64>() / over.iter().sum::<f64>();
        let depth = e.iter().sum::<f64>() / over.iter().sum::<f64>();
        // Snapping moves corners by up to 1/512 pixel; the plane's steepest u per pixel there is below 2.
        assert!(
            (closed - f64::from(f.varyings[0])).abs() < 5e-3 * closed.abs().max(1.0),
            "{closed} {:?}",
            f.varyings[0]
        );
        assert!((depth / f64::from(f.w) - 1.0).abs() < 5e-3);
    }
}

/// tan of the angle itself: the field of view's half is given.
trait TanHalf {
    fn tan_half(self) -> f64;
}

impl TanHalf for f64 {
    fn tan_half(self) -> f64 {
        1.0 / f64::from(camera::perspective(self as f32 * 2.0, 1.0, 0.5, 100.0).to_cols_array_2d()[1][1])
    }
}

/// Corners on the subpixel grid with several w: no snapping, so that closed forms are tight.
fn exact_perspective() -> ([(i64, i64); 3], [f32; 3], [f32; 3], Vec<Vertex>) {
    let t = [(640, 256), (15_360, 4096), (2560, 14_592)];
    let (w, values) = ([1.0_f32, 4.0, 2.0], [0.25_f32, 1.0, -0.5]);
    let mut list = vertices(t, 0.5, [0.0; 4], 64.0).to_vec();
    for i in 0..3 {
        list[i].values[0] = values[i];
        list[i].position = list[i].position.map(|p| p * w[i]);
    }
    (t, w, values, list)
}

#[test]
fn s077_interpolated_i_over_z_divided_by_one_over_z() {
    let (t, w, values, list) = exact_perspective();
    let area = oracle::edge(t[0], t[1], t[2]) as f64;
    for note in notes(64, &list) {
        let p = point(note.x, note.y);
        let e = [(t[1], t[2]), (t[2], t[0]), (t[0], t[1])].map(|(q, r)| oracle::edge(q, r, p) as f64 / area);
        let top: f64 = (0..3).map(|i| e[i] * f64::from(values[i]) / f64::from(w[i])).sum();
        let bottom: f64 = (0..3).map(|i| e[i] / f64::from(w[i])).sum();
        assert!((f64::from(note.varying) - top / bottom).abs() < 1e-5, "{note:?}");
    }
}

#[test]
fn s078_edge_functions_over_w_are_the_perspective_weights() {
    let (t, w, values, list) = exact_perspective();
    for note in notes(64, &list) {
        let p = point(note.x, note.y);
        let f: Vec<f64> = [(t[1], t[2]), (t[2], t[0]), (t[0], t[1])]
            .iter()
            .zip(w)
            .map(|((q, r), w)| oracle::edge(*q, *r, p) as f64 / f64::from(w))
            .collect();
        let sum: f64 = f.iter().sum();
        let expected: f64 = f.iter().zip(values).map(|(f, v)| f / sum * f64::from(v)).sum();
        assert!((f64::from(note.varying) - expected).abs() < 1e-5);
    }
}

#[test]
fn s079_the_checker_plane_equals_ray_casting() {
    perspective_against_rays(|seen, expected, _| {
        // Positions snap to 1/256 pixel; u changes by less than 0.05 there but near the horizon.
        assert!((seen - expected).abs() < 2e-3 * expected.abs().max(1.0), "{seen} {expected}");
    });
    // Without snapping, as tight as the row asks: corners on the grid, w exact.
    let (t, w, values, list) = exact_perspective();
    // The plane in view space: x = ndc·w and so on, with rays through the same pixels.
    let view = [0, 1, 2].map(|i| {
        let [x, y, _, _] = list[i].position;
        [f64::from(x), f64::from(y), -f64::from(w[i])]
    });
    let _ = t;
    for note in notes(64, &list) {
        let ray = rays::through(note.x, note.y, (64, 64), 1.0);
        let hit = rays::meet([0.0; 3], ray, view).unwrap();
        let expected =
            f64::from(values[0]) * (1.0 - hit.u - hit.v) + f64::from(values[1]) * hit.u + f64::from(values[2]) * hit.v;
        assert!((f64::from(note.varying) - expected).abs() < 1e-4);
        // Derivatives: against the neighbours' rays.
        let at = |x: f64, y: f64| {
            let ray = [x / 32.0 - 1.0, 1.0 - y / 32.0, -1.0];
            let hit = rays::meet([0.0; 3], ray, view).unwrap();
            f64::from(values[0]) * (1.0 - hit.u - hit.v) + f64::from(values[1]) * hit.u + f64::from(values[2]) * hit.v
        };
        let (x, y) = (f64::from(note.x) + 0.5, f64::from(note.y) + 0.5);
        let right = (at(x + 0.01, y) - at(x - 0.01, y)) / 0.02;
        let down = (at(x, y + 0.01) - at(x, y - 0.01)) / 0.02;
        assert!((f64::from(note.steps.0) - right).abs() < 1e-4 && (f64::from(note.steps.1) - down).abs() < 1e-4);
    }
}

#[test]
fn s080_the_homogeneous_divide() {
    let viewport = Viewport::new(200, 100);
    let m = camera::perspective(0.8, 2.0, 1.0, 10.0);
    let [x, y, z, w] = camera::transform(&m, [0.7, -0.4, -3.0, 1.0]);
    let [sx, sy, sz] = viewport.project([x, y, z, w]);
    assert!((sx - (x / w + 1.0) * 100.0).abs() < 1e-4);
    assert!((sy - (1.0 - y / w) * 50.0).abs() < 1e-4);
    assert!((sz - (z / w + 1.0) / 2.0).abs() < 1e-6);
    // The pipeline draws there: a point.
    let mut target = Target::new(200, 100).unwrap();
    let point = [Vertex::new([x, y, z, w], [1.0; 4])];
    Pipeline::new(200, 100).draw(&mut target, &Primitives::new(&point, Topology::Points), &pass(), &Values);
    assert_eq!(drawn(&target).into_iter().collect::<Vec<_>>(), [(sx as i32, sy as i32)]);
}

#[test]
fn s081_setup_happens_once_a_triangle() {
    let mut random = Random::new(81);
    let list: Vec<Vertex> =
        (0..500).flat_map(|_| vertices(random_triangle(&mut random, 64, 0), 0.5, [1.0; 4], 64.0)).collect();
    let mut target = Target::new(64, 64).unwrap();
    let c = counting(64).draw(&mut target, &Primitives::triangles(&list), &pass(), &Values);
    assert_eq!(c.setups + c.zero_area + c.no_samples, 500);
    // Each pixel of each triangle goes through the shader once.
    let expected: u64 = list
        .chunks(3)
        .map(|t| {
            let mut alone = Target::new(64, 64).unwrap();
            counting(64).draw(&mut alone, &Primitives::triangles(t), &pass(), &ONE);
            drawn(&alone).len() as u64
        })
        .sum();
    assert_eq!(c.fragments, expected);
}

#[test]
fn s082_linear_evaluation_does_not_drift() {
    // A gradient across 4,096 pixels, in double precision by the formula.
    let corner = |x: f32, y: f32, v: f32| Vertex::new([x, y, 0.0, 1.0], [v, 0.0, 0.0, 1.0]);
    let list = [corner(-1.0, -1.0, 0.0), corner(3.0, -1.0, 2.0), corner(-1.0, 3.0, 0.0)];
    let shader = Notes::default();
    let mut target = Target::new(4096, 8).unwrap();
    let pipeline = Pipeline::new(4096, 8).with_state(State { depth: Depth::OFF, ..State::default() });
    pipeline.draw(&mut target, &Primitives::triangles(&list), &pass(), &shader);
    let seen = shader.0.into_inner().unwrap();
    assert_eq!(seen.len(), 4096 * 8);
    for note in seen {
        let expected = (f64::from(note.x) + 0.5) / 4096.0;
        assert!((f64::from(note.varying) - expected).abs() < 1e-4 * 0.01, "{note:?}");
    }
}

#[test]
fn s083_plane_coefficients_by_cramers_rule() {
    let mut random = Random::new(83);
    for _ in 0..100 {
        let t = random_triangle(&mut random, 64, 0);
        let Some(clockwise) = oracle::oriented(t) else { continue };
        if oracle::edge(clockwise[0], clockwise[1], clockwise[2]) < 65536 * 40 {
            continue;
        }
        let values = [0; 3].map(|_| random.within(0..1000) as f32 / 1000.0);
        let mut list = vertices(t, 0.5, [0.0; 4], 64.0);
        for (vertex, value) in list.iter_mut().zip(values) {
            vertex.values[0] = value;
        }
        // v = a·x + b·y + c through the three corners.
        let [p, q, r] = t.map(|(x, y)| (x as f64 / 256.0, y as f64 / 256.0));
        let det = |m: [[f64; 3]; 3]| rays::dot(m[0], rays::cross(m[1], m[2]));
        let columns = |x: [f64; 3], y: [f64; 3], one: [f64; 3]| det([x, y, one]);
        let (xs, ys, ones, vs) = ([p.0, q.0, r.0], [p.1, q.1, r.1], [1.0; 3], values.map(f64::from));
        let d = columns(xs, ys, ones);
        let (a, b, c) = (columns(vs, ys, ones) / d, columns(xs, vs, ones) / d, columns(xs, ys, vs) / d);
        for note in notes(64, &list) {
            let expected = a * (f64::from(note.x) + 0.5) + b * (f64::from(note.y) + 0.5) + c;
            assert!((f64::from(note.varying) - expected).abs() < 2e-5, "{t:?}");
        }
    }
    // Singular: no coefficients, nothing drawn.
    assert!(notes(64, &vertices([(0, 0), (4000, 4000), (8000, 8000)], 0.5, [0.0; 4], 64.0)).is_empty());
}

#[test]
fn s084_one_to_sixteen_varyings() {
    for count in 1..=16_usize {
        let shader = vertex_fn(count, |v: &Vertex, out: &mut [f32]| {
            assert_eq!(out.len(), count);
            for (i, value) in out.iter_mut().enumerate() {
                *value = v.values[0] * (i + 1) as f32 + i as f32;
            }
            v.position
        });
        let seen = Mutex::new(Vec::new());
        let fragment = pixel_fn(count, |f: &Fragment| {
            seen.lock().unwrap().push(f.varyings);
            Some([1.0; 4])
        });
        let (_, _, _, list) = exact_perspective();
        let mut target = Target::new(64, 64).unwrap();
        counting(64).draw(&mut target, &Primitives::triangles(&list), &shader, &fragment);
        let seen = seen.into_inner().unwrap();
        assert!(seen.len() > 500);
        for values in seen {
            for (i, value) in values.iter().enumerate() {
                let expected = if i < count { values[0] * (i + 1) as f32 + i as f32 } else { 0.0 };
                assert!((value - expected).abs() < 1e-5 * (i + 2) as f32, "{i} of {count}: {value} {expected}");
            }
        }
    }
}

#[test]
fn s085_normals_are_weighted_then_normalised() {
    // Two unit normals along an edge: half way their sum has length √2 / 2, and is normalised by the shader.
    let t = [(0, 0), (16_384, 0), (0, 16_384)];
    let mut list = vertices(t, 0.5, [0.0; 4], 64.0);
    list[0].values = [1.0, 0.0, 0.0, 0.0];
    list[1].values = [0.0, 1.0, 0.0, 0.0];
    list[2].values = [1.0, 0.0, 0.0, 0.0];
    for f in fragments(64, &list) {
        let [x, y, z] = [0, 1, 2].map(|i| f.varyings[i]);
        let t = (f64::from(f.x) + 0.5) / 64.0;
        let raw = (1.0 - t, t);
        assert!((f64::from(x) - raw.0).abs() < 1e-5 && (f64::from(y) - raw.1).abs() < 1e-5 && z == 0.0);
        let length = (x * x + y * y + z * z).sqrt();
        let expected = raw.0 / (raw.0 * raw.0 + raw.1 * raw.1).sqrt();
        assert!((f64::from(x / length) - expected).abs() < 1e-5);
    }
}

#[test]
fn s087_a_clipped_draw_equals_the_ray_oracle() {
    let mut random = Random::new(87);
    let projection = camera::perspective(1.4, 1.0, 0.5, 12.0);
    let tan_half = 1.0 / f64::from(projection.to_cols_array_2d()[1][1]);
    let mut clipped = 0;
    for round in 0..30 {
        // Corners all around the camera: behind it, in its plane, beyond far and to all sides.
        let scene: Vec<[[f64; 3]; 3]> = (0..6)
            .map(|_| {
                std::array::from_fn(|_| {
                    let mut c = |r: i64| random.within(-r * 100..r * 100) as f64 / 100.0;
                    [c(6), c(6), c(14)]
                })
            })
            .collect();
        let list = projected(&scene, &projection, |i, _| [(i + 1) as f32 / 255.0, 0.0, 0.0, 1.0]);
        let mut target = Target::new(64, 64).unwrap();
        let pipeline = Pipeline::new(64, 64).with_threads(1);
        clipped += pipeline.draw(&mut target, &Primitives::triangles(&list), &pass(), &Values).clipped;
        let mut compared = 0;
        for (x, y) in (0..64).flat_map(|y| (0..64).map(move |x| (x, y))) {
            let ray = rays::through(x, y, (64, 64), tan_half);
            // Near and far cut: distances along −z are t itself.
            let hits: Vec<_> = scene.iter().map(|t| rays::meet([0.0; 3], ray, *t)).collect();
            let doubtful = hits
                .iter()
                .flatten()
                .any(|hit| hit.margin().abs() < 0.02 || (hit.t - 0.5).abs() < 0.02 || (hit.t - 12.0).abs() < 0.1);
            if doubtful {
                continue;
            }
            let seen = hits.iter().enumerate().filter_map(|(i, hit)| hit.map(|hit| (i, hit)));
            let seen: Vec<_> = seen.filter(|(_, hit)| hit.margin() > 0.0 && hit.t > 0.5 && hit.t < 12.0).collect();
            let mut sorted = seen.clone();
            sorted.sort_by(|a, b| a.1.t.total_cmp(&b.1.t));
            if sorted.len() > 1 && sorted[1].1.t - sorted[0].1.t < 0.05 {
                continue;
            }
            compared += 1;
            let expected = sorted.first().map_or(0, |(i, _)| *i as u8 + 1);
            assert_eq!(target.pixel(x, y).unwrap()[0], expected, "round {round} at {x}, {y}: {sorted:?}");
        }
        assert!(compared > 1500, "{compared}");
    }
    assert!(clipped > 60, "{clipped}");
    // w ≤ 0 throughout, w = 0, and infinities draw nothing and stop nothing.
    for w in [0.0, -1.0, f32::INFINITY, f32::NEG_INFINITY, f32::NAN] {
        let bad = [[0.0, 0.0, 0.0, w], [1.0, 0.0, 0.0, w], [0.0, 1.0, 0.0, w]].map(|p| Vertex::new(p, [1.0; 4]));
        assert!(picture(&Pipeline::new(16, 16), 16, &bad).data().iter().all(|v| *v == 0), "{w}");
    }
}

/// The coefficients (right, down, constant, in pixels of a square of `size`) of what is linear on the screen and has, divided by w, the
/// given values at three places in clip space: Cramer's rule over x, y and w, so that places behind the viewer are no exception.
fn homogeneous_plane(places: [[f64; 4]; 3], values: [f64; 3], size: f64) -> [f64; 3] {
    let determinant = |m: [[f64; 3]; 3]| {
        let minor = |i: usize, j: usize| m[1][i] * m[2][j] - m[1][j] * m[2][i];
        m[0][0] * minor(1, 2) - m[0][1] * minor(0, 2) + m[0][2] * minor(0, 1)
    };
    let rows = places.map(|[x, y, _, w]| [x, y, w]);
    let whole = determinant(rows);
    let [a, b, c] = [0, 1, 2].map(|column| {
        let mut rows = rows;
        for (row, value) in rows.iter_mut().zip(values) {
            row[column] = value;
        }
        determinant(rows) / whole
    });
    // From −1 ..= 1 to pixels, y downwards.
    [a * 2.0 / size, -b * 2.0 / size, c - a + b]
}

#[test]
fn s087_depths_and_varyings_of_clipped_triangles_lie_on_their_planes() {
    let size = 64;
    let projection = camera::perspective(1.2, 1.0, 0.1, 100.0);
    let mut random = Random::new(8787);
    let (mut compared, mut clipped) = (0, 0);
    for round in 0..300 {
        // Floors and walls that run past the camera, thin ones too, and triangles all around it; corners up to 1e5 screens away.
        let mut within = |r: f64| random.within(-1_000_000..1_000_000) as f64 * r * 1e-6;
        let along = 50.0 * within(1.0).abs() + 1.0;
        let scene: [[f64; 3]; 3] = match round % 3 {
            0 => {
                let (y, width) = (-0.05 - within(1.0).abs(), [0.001, 0.01, 0.1, 1.0, 10.0][round / 3 % 5]);
                let x = within(1.0);
                [[x - width, y, along], [x + width, y, along], [x, y + within(0.02), -90.0]]
            }
            1 => {
                let x = 0.02 + within(0.5).abs();
                [[x, within(1.0), 5.0 * within(1.0)], [x + within(0.01), within(1.0), -along], [x, within(1.0), along]]
            }
            _ => std::array::from_fn(|_| [within(6.0), within(6.0), within(14.0)]),
        };
        let list = projected(&[scene], &projection, |_, corner| [corner as f32 * 2.0 - 1.0, 7.0, corner as f32, 0.0]);
        let first = list[0].values;
        let places = [0, 1, 2].map(|i| list[i].position.map(f64::from));
        let plane = |values: [f64; 3]| homogeneous_plane(places, values, f64::from(size));
        let z = plane(places.map(|p| 0.5 * (p[2] + p[3])));
        let inverse_w = plane([1.0; 3]);
        let over_w = plane([0, 1, 2].map(|i| f64::from(list[i].values[0])));
        let (seen, provoking) = (Mutex::new(Vec::new()), Mutex::new(Vec::new()));
        let shader = pixel_fn(4, |fragment: &Fragment| {
            seen.lock().unwrap().push(*fragment);
            Some([1.0; 4])
        });
        let mut target = Target::new(size, size).unwrap();
        let counters = counting(size).draw(&mut target, &Primitives::triangles(&list), &pass(), &shader);
        counting(size).draw(&mut target, &Primitives::triangles(&list), &pass(), &Provoking(&provoking));
        assert!(provoking.into_inner().unwrap().iter().all(|values| *values == first), "round {round}");
        clipped += counters.clipped;
        for f in seen.into_inner().unwrap() {
            let at = |[a, b, c]: [f64; 3]| a * (f64::from(f.x) + 0.5) + b * (f64::from(f.y) + 0.5) + c;
            let w = 1.0 / at(inverse_w);
            // Coverage is decided within 1/512 pixel: a centre may lie as far beyond the plane's own sides.
            if !(0.11..90.0).contains(&w) {
                continue;
            }
            compared += 1;
            let slope = z[0].abs() + z[1].abs();
            assert!(
                (f64::from(f.depth) - at(z)).abs() < 2e-6 + slope / 4096.0,
                "round {round} at {}, {}: {} {}, slope {slope}",
                f.x,
                f.y,
                f.depth,
                at(z)
            );
            let expected = at(over_w) * w;
            let slope = w * ((over_w[0] - expected * inverse_w[0]).abs() + (over_w[1] - expected * inverse_w[1]).abs());
            assert!(
                (f64::from(f.varyings[0]) - expected).abs() < 1e-4 + slope / 1024.0,
                "round {round} at {}, {}: {} {expected}, slope {slope}",
                f.x,
                f.y,
                f.varyings[0]
            );
            assert!((f.varyings[1] - 7.0).abs() < 1e-4, "{}", f.varyings[1]);
        }
    }
    assert!(compared > 30_000 && clipped > 150, "{compared} {clipped}");
}

/// Notes the values of the provoking vertex.
struct Provoking<'a>(&'a Mutex<Vec<[f32; 4]>>);

impl FragmentShader for Provoking<'_> {
    #[inline(always)]
    fn shade<S: Simd>(&self, f: &Fragments<'_, S>) -> Shade<S> {
        self.0.lock().unwrap().push([0, 1, 2, 3].map(|i| f.flat(i)));
        Shade::color([f.varying(0); 4])
    }
}

#[test]
fn s088_the_four_clip_cases() {
    let vertex = |p: [f32; 4], v: f32| ClipVertex::new(p, &[v]);
    let triangle = |x: [f32; 3]| {
        let y = [-0.5, 0.5, 0.0];
        [0, 1, 2].map(|i| vertex([x[i], y[i], 0.0, 1.0], x[i]))
    };
    let left = &ClipPlane::VIEW_VOLUME[..1];
    // All in: the triangle itself. All out: nothing.
    assert_eq!(clip_polygon(&triangle([0.0, 0.2, 0.5]), left), triangle([0.0, 0.2, 0.5]));
    assert!(clip_polygon(&triangle([-3.0, -2.0, -1.5]), left).is_empty());
    // One in: one triangle. Two in: a quadrilateral, two triangles.
    let one = clip_polygon(&triangle([-2.0, -3.0, 0.5]), left);
    let two = clip_polygon(&triangle([0.0, 0.5, -3.0]), left);
    assert_eq!((one.len(), two.len()), (3, 4));
    for v in one.iter().chain(&two) {
        assert!(v.position[0] >= -1.0 - 1e-6);
        assert!((v.varyings[0] - v.position[0]).abs() < 1e-6, "varyings are cut at the same place");
    }
    // Area: what lies inside and what lies outside make the whole.
    let area = |polygon: &[ClipVertex]| {
        polygon
            .iter()
            .zip(polygon.iter().cycle().skip(1))
            .map(|(a, b)| f64::from(a.position[0] * b.position[1] - a.position[1] * b.position[0]))
            .sum::<f64>()
            .abs()
            / 2.0
    };
    let outside = [ClipPlane([-1.0, 0.0, 0.0, -1.0])];
    for x in [[0.0, 0.5, -3.0], [-2.0, -3.0, 0.5], [-1.5, 0.7, -0.2]] {
        let whole = area(&triangle(x));
        let parts = area(&clip_polygon(&triangle(x), left)) + area(&clip_polygon(&triangle(x), &outside));
        assert!((parts - whole).abs() < 1e-5 * whole.max(1.0), "{x:?}: {parts} {whole}");
    }
    // All six planes at once: a triangle around the whole volume becomes its silhouette.
    let around = [[-9.0, -9.0], [9.0, -9.0], [0.0, 18.0]].map(|[x, y]| vertex([x, y, 0.0, 1.0], 0.0));
    let inside = clip_triangle(around);
    assert!((area(&inside) - 4.0).abs() < 1e-5);
}
