//! What need not be drawn: backs, what is out of view, what is hidden; and boxes in boxes to find it.

use std::collections::BTreeSet;

use rastrum::glam::Mat4;
use rastrum::scene::{Aabb, Bvh, Camera, Frustum, Look, Mesh, Projection, Scene, SceneSettings};
use rastrum::space::{Cull, Fill, camera};
use rastrum::{Color, Point, Rect, Result, Stroke};

use super::board::{AMBER, BLUE, Board, FAINT, GREEN, GREY, INK, MINT, RED, ROSE, SKY, VIOLET, mix};
use super::stage;
use super::{Row, row};

pub(super) const ROWS: &[Row] = &[
    row(
        132,
        "Backface culling",
        "A ball's edges with all triangles, without those that face away, and without those that face the viewer. A closed mesh looks the same from outside with half the triangles.",
        backfaces,
    ),
    row(
        133,
        "Frustum culling",
        "Seen from above: boxes outside of the view (red) are skipped, all others drawn (green), also those that the view only touches.",
        frustum,
    ),
    row(
        134,
        "Occlusion culling",
        "The camera sees a wall and what stands beside it. From above, boxes that the wall hides (grey) are not drawn; the picture is the same.",
        occlusion,
    ),
    row(
        135,
        "Bounding boxes",
        "The box of a triangle and of a mesh. The box around a turned box (amber) is larger than that of the turned mesh's points (green).",
        boxes,
    ),
    row(
        136,
        "BVH construction",
        "Objects (small boxes) in leaves of up to four, leaves in larger boxes: each level halves the objects along the longer axis. Thin to thick lines are deep to shallow.",
        bvh,
    ),
    row(
        137,
        "BVH query",
        "Blue boxes were tested against the view (amber) and met it, red ones were tested and dropped with all they hold, pale ones were never looked at.",
        query,
    ),
    row(
        138,
        "Octree for contrast",
        "Left: cells of space cut in the middle, where an object lies in each cell it touches. Right: the BVH's leaves, where each object lies once.",
        octree,
    ),
];

fn backfaces(board: &mut Board) -> Result<()> {
    let panels = board.panels(["ALL", "FRONTS", "BACKS"]);
    let scene = stage::scene(vec![(Mesh::sphere(1.0, 16, 9, 0), stage::matte(BLUE), Mat4::IDENTITY)]);
    let camera = Camera::look_at([0.6, 2.2, 3.2], [0.0; 3], [0.0, 1.0, 0.0]);
    for (rect, cull) in panels.into_iter().zip([Cull::None, Cull::Back, Cull::Front]) {
        let settings = SceneSettings {
            fill: Fill::Wireframe,
            shading: Some(rastrum::scene::Shading::Unlit),
            cull: Some(cull),
            ..stage::settings()
        };
        let stats = stage::show(board, rect, &scene, &camera, &settings)?;
        let at = Point::new(rect.center().x, rect.bottom - 40.0);
        board.middle(at, 11.0, &format!("{} DRAWN", stats.counters.primitives - stats.counters.culled), INK);
    }
    Ok(())
}

/// What maps x and z to a panel seen from above, and the other way round.
#[derive(Clone, Copy)]
struct Map {
    rect: Rect,
    half: f32,
}

impl Map {
    fn at(&self, x: f32, z: f32) -> Point {
        let side = self.rect.width().min(self.rect.height()) / (2.0 * self.half);
        let middle = self.rect.center();
        Point::new(middle.x + x * side, middle.y + z * side)
    }

    fn rect(&self, bounds: &Aabb, upright: bool) -> Rect {
        let k = if upright { 1 } else { 2 };
        let (a, b) = (self.at(bounds.min[0], bounds.min[k]), self.at(bounds.max[0], bounds.max[k]));
        Rect::from_ltrb(a.x, a.y, b.x, b.y)
    }
}

fn cube(x: f32, z: f32, half: f32) -> Aabb {
    Aabb { min: [x - half, -half, z - half], max: [x + half, half, z + half] }
}

fn frustum(board: &mut Board) -> Result<()> {
    let map = Map { rect: board.whole(), half: 6.0 };
    let (eye, near, far, fov) = ([-1.0, 0.0, 5.2], 1.2_f32, 9.5_f32, 0.9_f32);
    let view = Camera {
        near,
        far,
        projection: Projection::Perspective(fov),
        ..Camera::look_at(eye, [0.6, 0.0, -2.0], [0.0, 1.0, 0.0])
    };
    let to_clip = camera::product(&view.projection_matrix(1.4), &view.view);
    let planes = Frustum::new(&to_clip);
    let mut random = stage::Random::new(133);
    let mut counts = [0, 0];
    for _ in 0..70 {
        let bounds = cube(random.within(-9.0, 9.0), random.within(-5.6, 5.6), random.within(0.15, 0.4));
        let seen = planes.meets(&bounds);
        counts[usize::from(seen)] += 1;
        let rect = map.rect(&bounds, false);
        board.bar(rect, if seen { MINT } else { ROSE });
        board.canvas.stroke_rect(rect, &Stroke::new(1.5), if seen { GREEN } else { RED });
    }
    let back = camera::inverse(&to_clip).unwrap_or(Mat4::IDENTITY);
    let corner = |x: f32, z: f32| {
        let [px, _, pz, w] = camera::transform(&back, [x, 0.0, z, 1.0]);
        map.at(px / w, pz / w)
    };
    board.canvas.stroke_polygon(
        &[corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)],
        &Stroke::new(2.5),
        INK,
    );
    board.canvas.fill_circle(map.at(eye[0], eye[2]), 6.0, INK);
    board.label(24.0, 24.0, 12.0, &format!("{} DRAWN", counts[1]), GREEN);
    board.label(24.0, 46.0, 12.0, &format!("{} SKIPPED", counts[0]), RED);
    Ok(())
}

fn occlusion(board: &mut Board) -> Result<()> {
    let [left, right] = board.panels(["THE CAMERA'S PICTURE", "FROM ABOVE"]);
    let mut places = vec![(0.0, 1.0)];
    let mut random = stage::Random::new(134);
    for i in 0..24 {
        places.push((-3.6 + (i % 6) as f32 * 1.45 + random.within(-0.2, 0.2), -0.6 - (i / 6) as f32 * 1.1));
    }
    let mesh = |i: usize| {
        if i == 0 {
            Mesh::cuboid([-1.6, -0.6, -0.1], [1.6, 1.0, 0.1], 0)
        } else {
            Mesh::cuboid([-0.3, -0.5, -0.3], [0.3, 0.3, 0.3], 0)
        }
    };
    let colors = [RED, BLUE, GREEN, AMBER, VIOLET];
    let parts = places.iter().enumerate().map(|(i, (x, z))| {
        let color = if i == 0 { GREY } else { colors[i % 5] };
        (mesh(i), stage::matte(color), stage::at(*x, 0.0, *z))
    });
    let scene: Scene = stage::scene(parts.collect());
    let camera = Camera { near: 0.5, far: 30.0, ..Camera::look_at([0.0, 0.4, 5.0], [0.0, 0.1, 0.0], [0.0, 1.0, 0.0]) };
    let size = (right.width() as u32, right.width() as u32);
    let settings = SceneSettings { occlusion_culling: true, ..stage::settings() };
    let (picture, stats) = stage::view(&scene, &camera, size, &settings)?;
    board.picture(left, picture);
    let ids = SceneSettings { look: Look::Ids, background: Color::TRANSPARENT, ..stage::settings() };
    let (ids, _) = stage::view(&scene, &camera, size, &ids)?;
    let pixels = ids.data().as_chunks::<4>().0.iter().filter(|pixel| pixel[3] != 0);
    // Twelve triangles each.
    let seen: BTreeSet<u32> = pixels.map(|pixel| ((u32::from_le_bytes(*pixel) & 0xff_ffff) - 1) / 12).collect();
    let map = Map { rect: Rect { bottom: right.bottom - 40.0, ..right }, half: 5.4 };
    for (i, (x, z)) in places.iter().enumerate() {
        let (half, depth) = if i == 0 { (1.6, 0.1) } else { (0.3, 0.3) };
        let bounds = Aabb { min: [x - half, 0.0, z - depth], max: [x + half, 0.0, z + depth] };
        let color = if i == 0 {
            INK
        } else if seen.contains(&(i as u32)) {
            colors[i % 5]
        } else {
            FAINT
        };
        board.bar(map.rect(&bounds, false), color);
    }
    let eye = map.at(0.0, 5.0);
    board.canvas.fill_circle(eye, 6.0, INK);
    for x in [-1.6, 1.6] {
        let far = map.at(x * 2.6, 5.0 - 4.0 * 2.6);
        board.segment(eye, far, 1.2, GREY);
    }
    let text = format!(
        "{} DRAWN, {} HIDDEN",
        stats.meshes - stats.occlusion_culled - stats.frustum_culled,
        stats.occlusion_culled
    );
    board.middle(Point::new(right.center().x, right.bottom - 10.0), 11.0, &text, INK);
    Ok(())
}

fn boxes(board: &mut Board) -> Result<()> {
    let [left, right] = board.panels(["A TRIANGLE", "A MESH, TURNED"]);
    let map = Map { rect: left, half: 1.6 };
    let corners = [[-1.2, -0.7, 0.0], [1.0, -0.2, 0.0], [0.1, 1.2, 0.0]];
    let points = corners.map(|[x, y, _]| map.at(x, y));
    board.canvas.fill_polygon(&points, rastrum::FillRule::NonZero, SKY);
    board.canvas.stroke_polygon(&points, &Stroke::new(2.0), BLUE);
    board.canvas.stroke_rect(map.rect(&Aabb::of_points(corners), true), &Stroke::new(2.5), GREEN);
    let map = Map { rect: right, half: 1.7 };
    let shape: Vec<[f32; 3]> = (0..16)
        .map(|i| {
            let angle = i as f32 / 16.0 * std::f32::consts::TAU;
            let reach = if i % 2 == 0 { 1.0 } else { 0.6 };
            [libm::cosf(angle) * reach * 1.2, libm::sinf(angle) * reach * 0.6, 0.0]
        })
        .collect();
    let turn = camera::rotation([0.0, 0.0, 1.0], 0.6);
    let turned: Vec<[f32; 3]> = shape
        .iter()
        .map(|[x, y, z]| {
            let [x, y, z, _] = camera::transform(&turn, [*x, *y, *z, 1.0]);
            [x, y, z]
        })
        .collect();
    let points: Vec<Point> = turned.iter().map(|[x, y, _]| map.at(*x, *y)).collect();
    board.canvas.fill_polygon(&points, rastrum::FillRule::NonZero, SKY);
    board.canvas.stroke_polygon(&points, &Stroke::new(2.0), BLUE);
    let own = Aabb::of_points(shape);
    let around: Vec<Point> = own
        .corners()
        .iter()
        .map(|[x, y, _]| {
            let [x, y, ..] = camera::transform(&turn, [*x, *y, 0.0, 1.0]);
            map.at(x, y)
        })
        .collect();
    if let [a, b, c, d, ..] = around.as_slice() {
        board.canvas.stroke_polygon(&[*a, *b, *d, *c], &Stroke::new(1.2), GREY);
    }
    board.canvas.stroke_rect(map.rect(&own.transformed(&turn), true), &Stroke::new(2.5), AMBER);
    board.canvas.stroke_rect(map.rect(&Aabb::of_points(turned), true), &Stroke::new(2.5), GREEN);
    Ok(())
}

/// Flat objects in a few clusters.
fn objects(count: usize) -> Vec<Aabb> {
    let mut random = stage::Random::new(136);
    (0..count)
        .map(|i| {
            let (cx, cy) = [(-5.2, -2.2), (2.0, 1.8), (5.6, -2.4)][i % 3];
            let (x, y) = (cx + random.within(-2.2, 2.2), cy + random.within(-1.7, 1.7));
            let (w, h) = (random.within(0.12, 0.42), random.within(0.12, 0.42));
            Aabb { min: [x - w, y - h, 0.0], max: [x + w, y + h, 0.0] }
        })
        .collect()
}

const LEVELS: [Color; 5] = [INK, BLUE, VIOLET, GREEN, AMBER];

fn bvh(board: &mut Board) -> Result<()> {
    let map = Map { rect: board.whole(), half: 5.0 };
    let objects = objects(36);
    let tree = Bvh::new(&objects);
    for bounds in &objects {
        board.bar(map.rect(bounds, true), SKY);
    }
    let mut stack = vec![(0_usize, 0_usize)];
    while let Some((number, level)) = stack.pop() {
        let Some(node) = tree.nodes.get(number) else { continue };
        let rect = map.rect(&node.bounds, true).outset(6.0 - level as f32 * 1.4);
        board.canvas.stroke_rect(rect, &Stroke::new((4.0 - level as f32 * 0.8).max(1.0)), LEVELS[level.min(4)]);
        stack.extend(node.children.iter().flatten().map(|child| (*child, level + 1)));
    }
    Ok(())
}

fn query(board: &mut Board) -> Result<()> {
    let map = Map { rect: board.whole(), half: 5.0 };
    let objects = objects(60);
    let tree = Bvh::new(&objects);
    // A view of 4.4 × 3.4 units around (1.6, 1.4), along z.
    let view = Aabb { min: [-0.9, 0.0, -1.0], max: [3.5, 3.4, 1.0] };
    let to_clip = camera::orthographic(view.min[0], view.max[0], view.min[1], view.max[1], -1.0, 1.0);
    let planes = Frustum::new(&to_clip);
    let (found, tests) = tree.query(&planes);
    let mut looked_at = vec![false; tree.nodes.len()];
    let mut stack = vec![0_usize];
    while let Some(number) = stack.pop() {
        let (Some(node), Some(seen)) = (tree.nodes.get(number), looked_at.get_mut(number)) else { continue };
        *seen = true;
        if planes.meets(&node.bounds) {
            stack.extend(node.children.iter().flatten());
        }
    }
    for (i, bounds) in objects.iter().enumerate() {
        board.bar(map.rect(bounds, true), if found.contains(&i) { GREEN } else { FAINT });
    }
    for (node, seen) in tree.nodes.iter().zip(&looked_at) {
        let color = if !seen {
            mix(FAINT, Color::WHITE, 0.3)
        } else if planes.meets(&node.bounds) {
            BLUE
        } else {
            RED
        };
        board.canvas.stroke_rect(map.rect(&node.bounds, true), &Stroke::new(1.8), color);
    }
    board.canvas.stroke_rect(map.rect(&view, true), &Stroke::new(3.5), AMBER);
    board.label(24.0, 24.0, 12.0, &format!("{tests} TESTS"), BLUE);
    board.label(24.0, 46.0, 12.0, &format!("PLAIN LOOP: {}", objects.len()), GREY);
    Ok(())
}

/// Cuts a cell in four until it holds at most four objects.
fn cut(board: &mut Board, map: &Map, cell: Aabb, objects: &[Aabb], depth: u32, totals: &mut [usize; 2]) {
    totals[0] += 1;
    let inside: Vec<Aabb> = objects.iter().filter(|bounds| bounds.meets(&cell)).copied().collect();
    if inside.len() <= 4 || depth == 0 {
        totals[1] += inside.len();
        board.canvas.stroke_rect(map.rect(&cell, true), &Stroke::new(1.3), VIOLET);
        return;
    }
    let [mx, my, _] = cell.center();
    for (x0, x1) in [(cell.min[0], mx), (mx, cell.max[0])] {
        for (y0, y1) in [(cell.min[1], my), (my, cell.max[1])] {
            cut(board, map, Aabb { min: [x0, y0, 0.0], max: [x1, y1, 0.0] }, &inside, depth - 1, totals);
        }
    }
}

fn octree(board: &mut Board) -> Result<()> {
    let [left, right] = board.panels(["CELLS OF SPACE", "BVH"]);
    let objects: Vec<Aabb> = objects(48);
    let bounds = objects.iter().fold(Aabb::EMPTY, |all, one| all.union(one));
    let half = bounds.max.iter().chain(&bounds.min).fold(0.0_f32, |most, v| most.max(v.abs()));
    let (cells, boxes) = (Map { rect: left, half }, Map { rect: right, half });
    for bounds in &objects {
        board.bar(cells.rect(bounds, true), SKY);
        board.bar(boxes.rect(bounds, true), SKY);
    }
    let mut totals = [0, 0];
    let root = Aabb { min: [-half, -half, 0.0], max: [half, half, 0.0] };
    cut(board, &cells, root, &objects, 6, &mut totals);
    let tree = Bvh::new(&objects);
    for node in tree.nodes.iter().filter(|node| node.children.is_none()) {
        board.canvas.stroke_rect(boxes.rect(&node.bounds, true), &Stroke::new(1.6), GREEN);
    }
    for (rect, nodes, entries) in [(left, totals[0], totals[1]), (right, tree.nodes.len(), tree.items.len())] {
        let at = Point::new(rect.center().x, rect.bottom - 6.0);
        board.middle(at, 10.0, &format!("{nodes} NODES, {entries} ENTRIES"), INK);
    }
    Ok(())
}
