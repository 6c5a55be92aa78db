//! Triangle rasterization: rows 44 to 73 of the checklist.

use std::collections::BTreeSet;

use rastrum::space::compress::{TileCode, tiled_index, to_tiled};
use rastrum::space::*;
use rastrum::{Color, IntRect};

use crate::oracle::triangle::{self as oracle, Triangle};
use crate::oracle::{Pixel, Random};
use crate::space_support::*;

fn set(pixels: &[Pixel]) -> BTreeSet<Pixel> {
    pixels.iter().copied().collect()
}

fn clip(pixels: BTreeSet<Pixel>, size: i32) -> BTreeSet<Pixel> {
    pixels.into_iter().filter(|(x, y)| (0..size).contains(x) && (0..size).contains(y)).collect()
}

/// Draws a list of triangles, each in counts of one.
fn count_mesh(triangles: &[Triangle], size: u32, threads: usize) -> Vec<u8> {
    let list: Vec<Vertex> = triangles.iter().flat_map(|t| vertices(*t, 0.5, [0.0; 4], size as f32)).collect();
    let mut target = Target::new(size, size).unwrap();
    counting(size).with_threads(threads).draw(&mut target, &Primitives::triangles(&list), &pass(), &ONE);
    counts(&target)
}

#[test]
fn s044_triangles_are_planar_convex_and_have_unique_weights() {
    let mut random = Random::new(44);
    for _ in 0..200 {
        let t = random_triangle(&mut random, 32, 0);
        let drawn = raster(t, 32);
        // Convex: whatever lies between two drawn pixels of a row is drawn.
        for y in 0..32 {
            let row: Vec<i32> = drawn.iter().filter(|p| p.1 == y).map(|p| p.0).collect();
            if let (Some(first), Some(last)) = (row.iter().min(), row.iter().max()) {
                assert_eq!(row.len() as i32, last - first + 1, "{t:?}");
            }
        }
    }
    // Without area nothing is drawn: a point, a segment twice, a segment with its middle.
    for t in [[(500, 500); 3], [(100, 100), (2000, 1500), (100, 100)], [(0, 0), (2560, 2560), (5120, 5120)]] {
        assert!(raster(t, 32).is_empty(), "{t:?}");
    }
}

#[test]
fn s045_a_pixel_is_sampled_at_its_centre() {
    // The hypotenuse passes through the centre of pixel 0: one of the two halves has it, by the tie rule.
    let half = [(0, 0), (256, 0), (0, 256)];
    let other = [(256, 0), (256, 256), (0, 256)];
    assert!(raster(half, 8).is_empty());
    assert_eq!(raster(other, 8), set(&[(0, 0)]));
    // A little larger, and the centre is inside.
    assert_eq!(raster([(0, 0), (258, 0), (0, 258)], 8), set(&[(0, 0)]));
}

#[test]
fn s046_positions_are_fixed_point() {
    let mut random = Random::new(46);
    let default = counting(32);
    let coarse = Pipeline { state: State { subpixel_bits: 2, ..default.state }, ..default };
    let at = |t: [(f32, f32); 3]| t.map(|(x, y)| Vertex::new(device(x, y, 0.5, 1.0, 32.0), [0.0; 4]));
    let draw = |pipeline: &Pipeline, t: [(f32, f32); 3]| {
        let mut target = Target::new(32, 32).unwrap();
        pipeline.draw(&mut target, &Primitives::triangles(&at(t)), &pass(), &ONE);
        drawn(&target)
    };
    let mut differ = 0;
    for _ in 0..300 {
        let fixed = random_triangle(&mut random, 32, 0);
        let exact = fixed.map(|(x, y)| (x as f32 / 256.0, y as f32 / 256.0));
        // Less than 1/512 pixel off, the snapped triangle is the same.
        let moved = exact.map(|(x, y)| {
            let mut off = || (random.within(-9..10) as f32) / 10.0 / 512.0;
            (x + off(), y + off())
        });
        let expected: BTreeSet<Pixel> = oracle::every_pixel(fixed, 32).drawn.into_iter().collect();
        assert_eq!(draw(&default, exact), expected);
        assert_eq!(draw(&default, moved), expected, "{fixed:?}");
        // Two bits: positions round to quarters of a pixel.
        let quarters = fixed.map(|(x, y)| ((x + 32).div_euclid(64) * 64, (y + 32).div_euclid(64) * 64));
        let tie = fixed.iter().any(|(x, y)| x.rem_euclid(64) == 32 || y.rem_euclid(64) == 32);
        if !tie {
            let expected: BTreeSet<Pixel> = oracle::every_pixel(quarters, 32).drawn.into_iter().collect();
            assert_eq!(draw(&coarse, exact), expected, "{fixed:?}");
            differ += usize::from(expected != draw(&default, exact));
        }
    }
    assert!(differ > 100, "a grid of quarters shows: {differ}");
}

#[test]
fn s047_edge_functions_are_zero_on_their_edge_and_twice_the_area_opposite() {
    let mut random = Random::new(47);
    for _ in 0..1000 {
        let [a, b, c] = random_triangle(&mut random, 64, 20);
        let area = oracle::edge(a, b, c);
        for (p, q, r) in [(a, b, c), (b, c, a), (c, a, b)] {
            assert_eq!([oracle::edge(p, q, p), oracle::edge(p, q, q), oracle::edge(p, q, r)], [0, 0, area]);
        }
    }
    // The same through the pipeline: on a vertex that lies on a pixel's centre its weight is 1.
    let corners = [(2, 1), (20, 1), (5, 25)].map(|(x, y)| (128 + 256 * x, 128 + 256 * y));
    let mut list = vertices(corners, 0.5, [0.0; 4], 32.0);
    for (i, vertex) in list.iter_mut().enumerate() {
        vertex.values[i] = 1.0;
    }
    let seen = std::sync::Mutex::new(Vec::new());
    let shader = pixel_fn(3, |fragment: &Fragment| {
        seen.lock().unwrap().push(((fragment.x, fragment.y), [0, 1, 2].map(|i| fragment.varyings[i])));
        Some([1.0; 4])
    });
    let mut target = Target::new(32, 32).unwrap();
    counting(32).draw(&mut target, &Primitives::triangles(&list), &pass(), &shader);
    let seen = seen.into_inner().unwrap();
    // The first corner owns its centre by the top-left rule.
    let (_, weights) = seen.iter().find(|(pixel, _)| *pixel == (2, 1)).unwrap();
    assert_eq!(*weights, [1.0, 0.0, 0.0]);
}

#[test]
fn s048_inside_is_where_all_edge_functions_are_positive() {
    let mut random = Random::new(48);
    for _ in 0..2000 {
        let [a, b, c] = random_triangle(&mut random, 40, 10);
        let expected: BTreeSet<Pixel> = oracle::every_pixel([a, b, c], 40).drawn.into_iter().collect();
        assert_eq!(raster([a, b, c], 40), expected, "{:?}", [a, b, c]);
        assert_eq!(raster([a, c, b], 40), expected, "the other winding");
    }
}

#[test]
fn s049_three_cross_products_agree_off_the_edges() {
    let mut random = Random::new(49);
    for _ in 0..500 {
        let t = random_triangle(&mut random, 32, 4);
        let drawn = raster(t, 32);
        for (x, y) in (0..32).flat_map(|y| (0..32).map(move |x| (x, y))) {
            let p = oracle::center((x, y));
            let crosses = oracle::sides(t).map(|(a, b)| {
                let (u, v) = ((b.0 - a.0, b.1 - a.1), (p.0 - a.0, p.1 - a.1));
                u.0 * v.1 - u.1 * v.0
            });
            if crosses.contains(&0) {
                continue;
            }
            let inside = crosses.iter().all(|c| *c > 0) || crosses.iter().all(|c| *c < 0);
            assert_eq!(drawn.contains(&(x, y)), inside, "{t:?} at {x}, {y}");
        }
    }
}

#[test]
fn s050_mccools_rule_is_the_top_left_rule() {
    // With y down, a = −Δy and b = Δx of an edge whose inside is to the right.
    let table = [
        (-1, -1, false),
        (-1, 0, false),
        (-1, 1, false),
        (0, -1, false),
        (0, 1, true),
        (1, -1, true),
        (1, 0, true),
        (1, 1, true),
    ];
    for (a, b, owns) in table {
        assert_eq!(oracle::mccool(a, b), owns);
        assert_eq!(oracle::top_left((0, 0), (b, -a)), owns, "{a} {b}");
        // In the pipeline: a triangle with an edge through the centre of pixel (4, 4), and its third corner to the edge's right.
        let middle = (4 * 256 + 128, 4 * 256 + 128);
        let (p, q) = ((middle.0 - b * 512, middle.1 + a * 512), (middle.0 + b * 512, middle.1 - a * 512));
        let third = (middle.0 + a * 1024, middle.1 + b * 1024);
        assert!(oracle::edge(p, q, third) > 0);
        assert_eq!(raster([p, q, third], 16).contains(&(4, 4)), owns, "{a} {b}");
    }
}

/// A mesh of the whole square: a jittered grid, each cell cut in two, so that 10,000 triangles share all edges.
fn jittered_mesh(random: &mut Random, cells: i64, size: i64, jitter: i64) -> Vec<Triangle> {
    let step = size * 256 / cells;
    let mut points = Vec::new();
    for j in 0..=cells {
        for i in 0..=cells {
            let mut place = |k: i64| match k {
                0 => -256,
                k if k == cells => size * 256 + 256,
                k => k * step + random.within(-step / jitter..step / jitter),
            };
            points.push((place(i), place(j)));
        }
    }
    let at = |i: i64, j: i64| points[(j * (cells + 1) + i) as usize];
    let mut triangles = Vec::new();
    for j in 0..cells {
        for i in 0..cells {
            let (a, b, c, d) = (at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
            if (i + j) % 2 == 0 {
                triangles.extend([[a, b, c], [a, c, d]]);
            } else {
                triangles.extend([[b, c, d], [b, d, a]]);
            }
        }
    }
    triangles
}

#[test]
fn s051_shared_edges_are_drawn_exactly_once() {
    let mut random = Random::new(51);
    let mesh = jittered_mesh(&mut random, 71, 256, 5);
    assert!(mesh.len() > 10_000);
    for threads in [1, 3] {
        let counts = count_mesh(&mesh, 256, threads);
        assert!(counts.iter().all(|count| *count == 1), "a hole or an overlap");
    }
    // Grids of quads turned by several angles, large enough to cover all of the square.
    for (cos, sin) in [(1.0, 0.0), (0.8, 0.6), (0.6, 0.8), (0.96, 0.28), (0.707, 0.707)] {
        let place = |i: i64, j: i64| {
            let (x, y) = ((i - 20) as f64 * 9.37, (j - 20) as f64 * 7.91);
            let (x, y) = (x * cos - y * sin + 64.0, x * sin + y * cos + 64.0);
            ((x * 256.0).round() as i64, (y * 256.0).round() as i64)
        };
        let mut mesh = Vec::new();
        for j in 0..40 {
            for i in 0..40 {
                let (a, b, c, d) = (place(i, j), place(i + 1, j), place(i + 1, j + 1), place(i, j + 1));
                mesh.extend([[a, b, c], [a, c, d]]);
            }
        }
        assert!(count_mesh(&mesh, 128, 1).iter().all(|count| *count == 1), "{cos} {sin}");
    }
}

#[test]
fn s052_a_tie_by_an_off_screen_point_also_draws_each_pixel_once() {
    let mut random = Random::new(52);
    // Corners on centres, so that ties are many.
    let mut mesh = jittered_mesh(&mut random, 16, 64, 8);
    for corner in mesh.iter_mut().flatten() {
        *corner = ((corner.0 >> 8 << 8) + 128, (corner.1 >> 8 << 8) + 128);
    }
    let mut ties = 0;
    for y in 2..62 {
        for x in 2..62 {
            let p = oracle::center((x, y));
            let hits = mesh.iter().filter(|t| oracle::inside(**t, p, oracle::off_screen)).count();
            let top_left = mesh.iter().filter(|t| oracle::inside(**t, p, oracle::top_left)).count();
            let closed = mesh.iter().filter(|t| oracle::inside(**t, p, |_, _| true)).count();
            assert_eq!((hits, top_left), (1, 1), "{x} {y}");
            ties += usize::from(closed > 1);
        }
    }
    assert!(ties > 100, "the test is about ties: {ties}");
}

/// Random triangles for the traversals.
fn triangles_for_walks(seed: u64, count: usize) -> Vec<Triangle> {
    let mut random = Random::new(seed);
    (0..count).map(|_| random_triangle(&mut random, 40, 0)).filter(|t| oracle::oriented(*t).is_some()).collect()
}

#[test]
fn s053_visiting_every_pixel_is_the_oracle() {
    for t in triangles_for_walks(53, 500) {
        let walk = oracle::every_pixel(t, 40);
        assert_eq!(walk.visited.len(), 1600);
        assert_eq!(raster(t, 40), set(&walk.drawn), "{t:?}");
    }
}

#[test]
fn s054_bounding_box_traversal() {
    for t in triangles_for_walks(54, 500) {
        let walk = oracle::bounding_box(t);
        let (x0, x1, y0, y1) = oracle::bounds(t);
        assert_eq!(walk.visited.len() as i32, (x1 - x0 + 1) * (y1 - y0 + 1));
        assert_eq!(clip(set(&walk.drawn), 40), raster(t, 40));
    }
}

#[test]
fn s055_backtrack_traversal_wastes_nothing_on_the_left() {
    for t in triangles_for_walks(55, 500) {
        let walk = oracle::backtrack(t);
        let box_walk = oracle::bounding_box(t);
        assert_eq!(clip(set(&walk.drawn), 40), raster(t, 40), "{t:?}");
        assert!(walk.visited.len() <= box_walk.visited.len());
        // In a row after one that has pixels, at most as many pixels are looked at left of the first as its start moved.
        let rows: BTreeSet<i32> = walk.drawn.iter().map(|p| p.1).collect();
        for y in rows.iter().skip(1).filter(|y| rows.contains(&(**y - 1))) {
            let first = |y: i32| walk.drawn.iter().filter(|p| p.1 == y).map(|p| p.0).min().unwrap();
            let wasted = walk.visited.iter().filter(|p| p.1 == *y && p.0 < first(*y)).count() as i32;
            assert!(wasted <= (first(*y) - first(*y - 1)).max(0) + 1, "{t:?} row {y}: {wasted}");
        }
    }
}

#[test]
fn s056_zigzag_traversal_turns_at_each_row() {
    for t in triangles_for_walks(56, 500) {
        let walk = oracle::zigzag(t);
        assert_eq!(clip(set(&walk.drawn), 40), raster(t, 40));
        let (x0, x1, y0, y1) = oracle::bounds(t);
        if x1 > x0 {
            for y in y0..=y1 {
                let row: Vec<i32> = walk.visited.iter().filter(|p| p.1 == y).map(|p| p.0).collect();
                assert_eq!(row[1] > row[0], (y - y0) % 2 == 0);
            }
        }
        // Neighbours in the order are neighbours on the grid.
        for pair in walk.visited.windows(2) {
            assert_eq!((pair[1].0 - pair[0].0).abs() + (pair[1].1 - pair[0].1).abs(), 1);
        }
    }
}

#[test]
fn s057_tiled_traversal_at_any_tile_size() {
    for t in triangles_for_walks(57, 300) {
        let expected = raster(t, 40);
        for tile in [1, 2, 4, 8, 16] {
            assert_eq!(clip(set(&oracle::tiled(t, tile).drawn), 40), expected, "{t:?} in tiles of {tile}");
        }
    }
}

#[test]
fn s058_pinedas_walk_by_increments_alone() {
    for t in triangles_for_walks(58, 500) {
        assert_eq!(clip(set(&oracle::pineda(t).drawn), 40), raster(t, 40), "{t:?}");
    }
}

#[test]
fn s059_no_overlapping_tile_is_rejected() {
    let mut random = Random::new(59);
    let (mut rejected, mut checked) = (0, 0);
    for _ in 0..50_000 {
        let t = random_triangle(&mut random, 64, 16);
        let walk: Option<BTreeSet<Pixel>> = (checked % 500 == 0).then(|| set(&oracle::every_pixel(t, 64).drawn));
        for _ in 0..20 {
            checked += 1;
            let (tx, ty) = (random.within(0..8) as i32 * 8, random.within(0..8) as i32 * 8);
            let overlaps = oracle::tile_overlaps(t, (tx, ty), 8);
            rejected += usize::from(!overlaps);
            if !overlaps {
                // One random centre of the tile, and sometimes all of them.
                let (x, y) = (tx + random.within(0..8) as i32, ty + random.within(0..8) as i32);
                assert!(!oracle::covers(t, (x, y)), "{t:?} at {x}, {y}");
                if let Some(drawn) = &walk {
                    assert!(!drawn.iter().any(|(x, y)| x & !7 == tx && y & !7 == ty));
                }
            }
        }
    }
    assert!(checked >= 1_000_000 && rejected > 100_000, "{checked} {rejected}");
}

/// Layers at the given depths, each in its own colour: triangles that hold the whole picture.
fn layers(depths: impl Iterator<Item = f32>) -> Vec<Vertex> {
    let corners = |z: f32| [(-1.0, -1.0), (3.0, -1.0), (-1.0, 3.0)].map(|(x, y)| [x, y, z * 2.0 - 1.0, 1.0]);
    depths.enumerate().flat_map(|(i, z)| corners(z).map(|p| Vertex::new(p, [i as f32 / 255.0, z, 0.25, 1.0]))).collect()
}

fn stack(list: &[Vertex], hierarchical: bool) -> (Target, Counters) {
    let mut target = Target::new(128, 128).unwrap();
    let state = State { hierarchical_depth: hierarchical, ..State::default() };
    let pipeline = Pipeline::new(128, 128).with_state(state).with_threads(1);
    let counters = pipeline.draw(&mut target, &Primitives::triangles(list), &pass(), &Values);
    (target, counters)
}

#[test]
fn s060_zmax_culling_rejects_what_lies_behind() {
    let list = layers((0..100).map(|i| 0.1 + i as f32 * 0.008));
    let (with, counters) = stack(&list, true);
    let (without, plain) = stack(&list, false);
    assert_eq!(with.to_pixmap().unwrap(), without.to_pixmap().unwrap());
    assert_eq!(with.depths(), without.depths());
    assert!(counters.tiles_hidden * 100 >= counters.tiles * 95, "{counters:?}");
    assert_eq!(plain.tiles_hidden, 0);
    assert_eq!(counters.fragments, 128 * 128);
}

#[test]
fn s061_zmin_culling_skips_depth_reads() {
    let list = layers((0..100).map(|i| 0.9 - i as f32 * 0.008));
    let (with, counters) = stack(&list, true);
    let (without, plain) = stack(&list, false);
    assert_eq!(with.to_pixmap().unwrap(), without.to_pixmap().unwrap());
    assert_eq!(with.depths(), without.depths());
    assert!(counters.tiles_in_front * 100 >= counters.tiles * 90, "{counters:?}");
    assert_eq!((plain.tiles_in_front, plain.fragments), (0, counters.fragments));
}

#[test]
fn s062_tile_compression_is_lossless() {
    let mut random = Random::new(62);
    // Depths of one plane, as the pipeline stores them in 24 bits: few bytes.
    let mut target = Target::with_format(64, 64, DepthFormat::D24, Samples::One).unwrap();
    let mut corners = quad(0.5, [0.0; 4]);
    for vertex in &mut corners {
        vertex.position[2] = vertex.position[0] * 0.3 + vertex.position[1] * 0.2;
    }
    Pipeline::new(64, 64).draw(&mut target, &Primitives::triangles(&corners), &pass(), &Values);
    let mut kinds = [0; 4];
    let mut check = |tile: [[u32; 8]; 8], clear: u32| {
        let code = TileCode::compress(&tile, clear);
        assert_eq!(code.expand(clear), tile, "{code:?}");
        kinds[match code {
            TileCode::Cleared => 0,
            TileCode::Constant(_) => 1,
            TileCode::Plane { .. } => 2,
            TileCode::Raw(_) => 3,
        }] += 1;
        code.size()
    };
    let mut bytes = 0;
    for (tx, ty) in (0..8).flat_map(|y| (0..8).map(move |x| (x, y))) {
        let at = |x: usize, y: usize| target.depth(tx * 8 + x as u32, ty * 8 + y as u32).unwrap();
        bytes += check(std::array::from_fn(|y| std::array::from_fn(|x| DepthFormat::D24.key(at(x, y)) as u32)), 77);
    }
    assert!(bytes <= 64 * 44, "planes compress: {bytes}");
    for _ in 0..500 {
        let (start, right, down) = (random.bits() as u32, random.within(-5000..5000), random.within(-5000..5000));
        let noise = random.within(1..12);
        let plane = |x: usize, y: usize| start.wrapping_add((right * x as i64 + down * y as i64) as u32);
        let tile =
            std::array::from_fn(|y| std::array::from_fn(|x| plane(x, y).wrapping_add(random.within(0..noise) as u32)));
        check(tile, 5);
        check([[start; 8]; 8], 5);
        check([[5; 8]; 8], 5);
        check(std::array::from_fn(|_| std::array::from_fn(|_| random.bits() as u32)), 5);
    }
    assert!(kinds.iter().all(|kind| *kind >= 50), "{kinds:?}");
}

#[test]
fn s063_a_tiled_texture_is_the_linear_one() {
    let mut random = Random::new(63);
    for (width, height) in [(16, 16), (13, 7), (4, 1), (1, 9)] {
        let texels: Vec<u32> = (0..width * height).map(|_| random.bits() as u32).collect();
        let tiled = to_tiled(&texels, width, height).unwrap();
        let mut places = BTreeSet::new();
        for (x, y) in (0..height).flat_map(|y| (0..width).map(move |x| (x, y))) {
            let place = tiled_index(x, y, width);
            assert_eq!(tiled[place], texels[y * width + x]);
            assert!(places.insert(place), "two texels in one place");
        }
        // The four texels of a bilinear sample that does not cross tiles lie within 16.
        if width > 3 && height > 3 {
            let four = [(1, 1), (2, 1), (1, 2), (2, 2)].map(|(x, y)| tiled_index(x, y, width));
            assert!(four.iter().max().unwrap() - four.iter().min().unwrap() < 16);
        }
    }
    assert!(to_tiled(&[0; 5], 2, 2).is_none());
}

#[test]
fn s064_conservative_rasterization_is_a_superset_of_what_is_touched() {
    let mut random = Random::new(64);
    let mut pipeline = counting(32);
    pipeline.state.conservative = true;
    for _ in 0..500 {
        let t = random_triangle(&mut random, 32, 0);
        let Some(clockwise) = oracle::oriented(t) else { continue };
        let drawn = raster_with(pipeline, t, 32);
        assert!(drawn.is_superset(&raster(t, 32)));
        // A corner on the line between two pixels touches both.
        let (x0, _, y0, _) = oracle::bounds(t.map(|(x, y)| (x - 1, y - 1)));
        let (_, x1, _, y1) = oracle::bounds(t);
        for (x, y) in (0..32).flat_map(|y| (0..32).map(move |x| (x, y))) {
            // Some of 17 × 17 points of the open pixel strictly inside: it is touched.
            let touched = (1..16).any(|j| {
                (1..16).any(|i| {
                    let p = (i64::from(x) * 256 + i * 16, i64::from(y) * 256 + j * 16);
                    oracle::sides(clockwise).iter().all(|(a, b)| oracle::edge(*a, *b, p) > 0)
                })
            });
            assert!(!touched || drawn.contains(&(x, y)), "{t:?} at {x}, {y}");
            // And nothing outside the box is drawn.
            assert!(!drawn.contains(&(x, y)) || ((x0..=x1).contains(&x) && (y0..=y1).contains(&y)));
        }
    }
}

#[test]
fn s065_setup_and_cull_are_counted() {
    let size = 64.0;
    let at = |t: Triangle| vertices(t, 0.5, [1.0; 4], size);
    let mut list = Vec::new();
    list.extend(at([(256, 256), (2560, 256), (256, 2560)])); // drawn
    list.extend(at([(256, 256), (2560, 2560), (5120, 5120)])); // no area
    list.extend(at([(-5000, 0), (-1000, 0), (-1000, 5000)])); // off the screen
    list.extend(at([(130, 130), (200, 140), (150, 200)])); // between centres
    list.extend([Vertex::new([f32::NAN, 0.0, 0.0, 1.0], [0.0; 4]); 3]); // not a number
    list.extend([
        Vertex::new([0.0, 0.0, 5.0, 1.0], [0.0; 4]),
        Vertex::new([1.0, 0.0, 5.0, 1.0], [0.0; 4]),
        Vertex::new([0.0, 1.0, 5.0, 1.0], [0.0; 4]),
    ]); // beyond far
    let indices: Vec<u32> = (0..list.len() as u32).chain([0, 1, 999]).collect();
    let mut target = Target::new(64, 64).unwrap();
    let pipeline = Pipeline::new(64, 64).with_threads(1);
    let c = pipeline.draw(&mut target, &Primitives::indexed(&list, &indices), &pass(), &Values);
    assert_eq!((c.primitives, c.setups, c.zero_area, c.outside, c.no_samples, c.invalid), (7, 1, 1, 2, 1, 2), "{c:?}");
    // One of the windings is culled.
    let mut pipeline = pipeline;
    for (cull, culled) in [(Cull::Back, 1), (Cull::Front, 0)] {
        // The first triangle runs clockwise on the screen: it shows its back.
        pipeline.state.cull = cull;
        let c = pipeline.draw(&mut target, &Primitives::indexed(&list, &indices), &pass(), &Values);
        assert_eq!((c.culled, c.setups), (culled, 1 - culled));
    }
}

/// A list of random triangles, in front of one another, on a square of 256 pixels.
fn pile(seed: u64, count: usize) -> (Vec<Triangle>, Vec<Vertex>) {
    let mut random = Random::new(seed);
    let triangles: Vec<Triangle> = (0..count).map(|_| random_triangle(&mut random, 256, 60)).collect();
    let list = triangles
        .iter()
        .flat_map(|t| {
            let color = [0; 3].map(|_| random.within(0..256) as f32 / 255.0);
            vertices(*t, random.within(0..1000) as f32 / 1000.0, [color[0], color[1], color[2], 1.0], 256.0)
        })
        .collect();
    (triangles, list)
}

#[test]
fn s066_every_bin_that_is_covered_lists_the_triangle() {
    let (triangles, list) = pile(66, 400);
    let target = Target::new(256, 256).unwrap();
    let pipeline = Pipeline::new(256, 256).with_threads(4);
    let (rows, bins) = pipeline.bins(&target, &Primitives::triangles(&list), &pass());
    assert!(bins.len() > 4, "{}", bins.len());
    for (i, t) in triangles.iter().enumerate() {
        let drawn = raster(*t, 256);
        let needed: BTreeSet<usize> = drawn.iter().map(|p| p.1 as usize / rows as usize).collect();
        for bin in needed {
            assert!(bins[bin].contains(&(i as u32)), "triangle {i} covers band {bin}");
        }
        // And not everything is in every bin.
        let (_, _, y0, y1) = oracle::bounds(*t);
        for (band, bin) in bins.iter().enumerate() {
            let (top, bottom) = (band as i32 * rows as i32, (band as i32 + 1) * rows as i32);
            assert!(!bin.contains(&(i as u32)) || (y1 >= top && y0 < bottom));
        }
    }
}

#[test]
fn s067_the_bins_together_are_the_direct_draw() {
    let (_, list) = pile(67, 300);
    let draw = |threads: usize| {
        let mut target = Target::new(256, 256).unwrap();
        let pipeline = Pipeline::new(256, 256).with_threads(threads);
        let c = pipeline.draw(&mut target, &Primitives::triangles(&list), &pass(), &Values);
        (target.to_pixmap().unwrap(), target.depths(), c.samples_passed)
    };
    let direct = draw(1);
    for threads in [2, 3, 8] {
        assert!(draw(threads) == direct, "{threads} threads");
    }
}

#[test]
fn s068_lists_keep_the_order_of_submission() {
    let (_, list) = pile(68, 20_000);
    let target = Target::new(256, 256).unwrap();
    let pipeline = Pipeline::new(256, 256).with_threads(4);
    let (_, bins) = pipeline.bins(&target, &Primitives::triangles(&list), &pass());
    for bin in &bins {
        assert!(bin.windows(2).all(|pair| pair[0] < pair[1]));
    }
    assert!(bins.iter().map(Vec::len).sum::<usize>() > 20_000);
}

#[test]
fn s069_a_visibility_buffer_shades_to_the_same_bytes() {
    let mut random = Random::new(69);
    let scene = random_scene(&mut random, 60);
    let projection = camera::perspective(1.2, 1.0, 0.5, 20.0);
    // Some reach behind the viewer and are clipped.
    let mut list = projected(&scene, &projection, |i, k| [i as f32 / 60.0, k as f32 / 2.0, 0.5, 1.0]);
    for (i, p) in [[0.3, -1.0, 1.0, 1.0], [2.0, -1.0, -6.0, 1.0], [-2.5, -1.5, -7.0, 1.0]].into_iter().enumerate() {
        list.push(Vertex::new(camera::transform(&projection, p), [1.0, i as f32 / 2.0, 0.0, 1.0]));
    }
    let primitives = Primitives::triangles(&list);
    for threads in [1, 3] {
        let pipeline = Pipeline::new(128, 128).with_threads(threads);
        let mut forward = Target::new(128, 128).unwrap();
        let direct = pipeline.draw(&mut forward, &primitives, &pass(), &Values);
        assert!(direct.clipped >= 1);
        let mut ids = Target::new(128, 128).unwrap();
        pipeline.draw_visibility(&mut ids, &primitives, &pass());
        let mut deferred = Target::new(128, 128).unwrap();
        let c = pipeline.shade_visibility(&ids, &mut deferred, &primitives, &pass(), &Values);
        assert!(forward.to_pixmap().unwrap() == deferred.to_pixmap().unwrap());
        // Each visible pixel is shaded once.
        let visible = ids.to_pixmap().unwrap().data().as_chunks::<4>().0.iter().filter(|id| **id != [0; 4]).count();
        assert_eq!(c.fragments as usize, visible);
        assert!(c.fragments < direct.fragments);
    }
}

/// Writes albedo, normal and depth to attachments.
struct Material;

impl FragmentShader for Material {
    #[inline(always)]
    fn shade<S: rastrum::fearless_simd::Simd>(&self, fragments: &Fragments<'_, S>) -> Shade<S> {
        Shade::opaque(fragments.varyings(0))
    }

    #[inline(always)]
    fn attachment<S: rastrum::fearless_simd::Simd>(
        &self,
        fragments: &Fragments<'_, S>,
        attachment: usize,
    ) -> rastrum::fearless_simd::u32x8<S> {
        use rastrum::fearless_simd::prelude::*;
        match attachment {
            0 => pack([fragments.varying(3), fragments.varying(3), fragments.varying(3), fragments.varying(3)]),
            _ => fragments.depth().bitcast(),
        }
    }
}

#[test]
fn s070_a_g_buffer_holds_the_materials_of_what_is_seen() {
    let (triangles, mut list) = pile(70, 60);
    for (i, vertex) in list.iter_mut().enumerate() {
        vertex.values[3] = (i / 3) as f32 / 255.0;
    }
    let mut target = Target::new(256, 256).unwrap().with_attachments(2).unwrap();
    let pipeline = Pipeline::new(256, 256).with_threads(2);
    pipeline.draw(&mut target, &Primitives::triangles(&list), &pass(), &Material);
    let depths: Vec<f32> = (0..triangles.len()).map(|i| (list[3 * i].position[2] + 1.0) * 0.5).collect();
    for (x, y) in (0..256).step_by(3).flat_map(|y| (0..256).step_by(3).map(move |x| (x, y))) {
        let over: Vec<usize> = (0..triangles.len()).filter(|i| oracle::covers(triangles[*i], (x, y))).collect();
        let nearest = over.into_iter().min_by(|a, b| depths[*a].total_cmp(&depths[*b]));
        let (x, y) = (x as u32, y as u32);
        let Some(i) = nearest else {
            assert_eq!(target.attachment(0, x, y), Some(0));
            continue;
        };
        let color = list[3 * i].values;
        let expected = [0, 1, 2].map(|k| (color[k] * 255.0 + 0.5) as u8);
        assert_eq!(target.pixel(x, y).unwrap()[..3], expected);
        assert_eq!(target.attachment(0, x, y), Some(i as u32 * 0x0101_0101));
        let depth = f32::from_bits(target.attachment(1, x, y).unwrap());
        assert!((depth - depths[i]).abs() < 1e-6);
        assert!((target.depth(x, y).unwrap() - depth).abs() < 1e-6);
    }
    assert!(Target::new(8, 8).unwrap().with_attachments(9).is_err());
}

#[test]
fn s071_a_depth_prepass_shades_each_pixel_at_most_once() {
    let (_, list) = pile(71, 200);
    let primitives = Primitives::triangles(&list);
    let pipeline = Pipeline::new(256, 256).with_threads(2);
    let mut direct = Target::new(256, 256).unwrap();
    let once = pipeline.draw(&mut direct, &primitives, &pass(), &Values);
    let mut target = Target::new(256, 256).unwrap();
    pipeline.draw_depth(&mut target, &primitives, &pass());
    assert!(drawn(&target).is_empty(), "the first pass draws no colour");
    let second = pipeline.after_prepass().draw(&mut target, &primitives, &pass(), &Values);
    // Random depths of a thousand steps: where two are equal the later wins instead of the earlier.
    let covered = drawn(&target).len() as u64;
    let ties = second.fragments - covered;
    assert!(ties * 50 < covered, "{ties} of {covered}");
    assert!(once.fragments > covered * 3 / 2);
    if ties == 0 {
        assert!(direct.to_pixmap().unwrap() == target.to_pixmap().unwrap());
    }
    assert_eq!(direct.depths(), target.depths());
}

#[test]
fn s071_a_prepass_gives_the_same_image_where_depths_differ() {
    let (triangles, mut list) = pile(171, 150);
    for i in 0..triangles.len() {
        for vertex in &mut list[3 * i..3 * i + 3] {
            vertex.position[2] = ((i * 67) % 150) as f32 / 75.0 - 1.0;
        }
    }
    let primitives = Primitives::triangles(&list);
    let pipeline = Pipeline::new(256, 256).with_threads(1);
    let (mut direct, mut target) = (Target::new(256, 256).unwrap(), Target::new(256, 256).unwrap());
    pipeline.draw(&mut direct, &primitives, &pass(), &Values);
    pipeline.draw_depth(&mut target, &primitives, &pass());
    let second = pipeline.after_prepass().draw(&mut target, &primitives, &pass(), &Values);
    assert!(direct.to_pixmap().unwrap() == target.to_pixmap().unwrap());
    assert_eq!(second.fragments as usize, drawn(&target).len());
}

#[test]
fn s072_the_path_for_small_triangles_equals_the_one_for_large_ones() {
    // The same small triangles with several samples at one place go through the other path: all of a pixel's samples are in or
    // out together only at 1×, so the oracle is the judge of both.
    let mut random = Random::new(72);
    for _ in 0..3000 {
        let corner = (random.within(0..40 * 256), random.within(0..40 * 256));
        let t: Triangle = std::array::from_fn(|_| (corner.0 + random.within(0..900), corner.1 + random.within(0..900)));
        let expected = clip(set(&oracle::bounding_box(t).drawn), 48);
        assert_eq!(raster(t, 48), expected, "{t:?}");
    }
    // A large triangle, and the same cut into small ones by a scissor of each tile: the same pixels and depths.
    let t = [(700, 300), (11_500, 5000), (2000, 12_000)];
    let mut list = vertices(t, 0.5, [0.2, 0.9, 0.4, 1.0], 64.0);
    for (vertex, z) in list.iter_mut().zip([-0.7, 0.1, 0.9]) {
        vertex.position[2] = z;
    }
    let mut whole = Target::new(64, 64).unwrap();
    let pipeline = Pipeline::new(64, 64).with_threads(1);
    pipeline.draw(&mut whole, &Primitives::triangles(&list), &pass(), &Values);
    let mut pieces = Target::new(64, 64).unwrap();
    for (x, y) in (0..16).flat_map(|y| (0..16).map(move |x| (x, y))) {
        let scissor = Some(IntRect::from_xywh(x * 4, y * 4, 4, 4));
        let pipeline = pipeline.with_state(State { scissor, ..State::default() });
        pipeline.draw(&mut pieces, &Primitives::triangles(&list), &pass(), &Values);
    }
    assert_eq!(whole.to_pixmap().unwrap(), pieces.to_pixmap().unwrap());
    assert_eq!(whole.depths(), pieces.depths());
    let _ = Color::WHITE;
}

#[test]
fn s073_reversed_float_depth_separates_what_forward_depth_does_not() {
    // Two walls at 9,000 and 9,010 with the near plane at 0.01.
    let wall = |projection: &rastrum::glam::Mat4, z: f32, color: [f32; 4]| {
        [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
            .map(|(x, y)| Vertex::new(camera::transform(projection, [x * -z * 3.0, y * -z * 3.0, z, 1.0]), color))
    };
    let (near, far) = ([1.0, 0.0, 0.0, 1.0], [0.0, 0.0, 1.0, 1.0]);
    let draw = |projection: rastrum::glam::Mat4, clip_depth: ClipDepth, clear: f32, compare: Compare| {
        let mut target = Target::new(32, 32).unwrap();
        target.clear_depth(clear);
        let state = State { depth: Depth::compare(compare), ..State::default() };
        let mut pipeline = Pipeline::new(32, 32).with_state(state);
        pipeline.viewport.clip_depth = clip_depth;
        // The nearer first: where the farther replaces it, they fight.
        let list: Vec<Vertex> =
            wall(&projection, -9000.0, near).into_iter().chain(wall(&projection, -9010.0, far)).collect();
        pipeline.draw(&mut target, &Primitives::triangles(&list), &pass(), &Values);
        let pixels = target.to_pixmap().unwrap();
        pixels.data().as_chunks::<4>().0.iter().filter(|pixel| **pixel == [255, 0, 0, 255]).count()
    };
    let reversed = draw(camera::perspective_reversed(1.0, 1.0, 0.01), ClipDepth::ZeroToOne, 0.0, Compare::Greater);
    assert_eq!(reversed, 32 * 32);
    let forward = camera::perspective(1.0, 1.0, 0.01, 10_000.0);
    let fought = draw(forward, ClipDepth::MinusOneToOne, 1.0, Compare::LessEqual);
    assert!(fought < 32 * 32, "forward depth tells them apart: {fought}");
}
