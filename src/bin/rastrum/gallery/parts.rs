//! Primitives, the scene graph, and how the work is shared out.

use rastrum::glam::Mat4;
use rastrum::scene::{Camera, Mesh, Node, Scene};
use rastrum::space::{Blend, Depth, Primitives, Samples, State, Topology, camera};
use rastrum::{Color, FillRule, Point, Rect, Result, Stroke};

use super::board::{AMBER, BLUE, Board, GREEN, GREY, INK, MINT, PALE, RED, ROSE, SKY, VIOLET, mix};
use super::stage::{self, Vertex};
use super::{Row, row};

pub(super) const ROWS: &[Row] = &[
    row(
        10,
        "Primitive assembly",
        "The same numbered vertices as a list (three for each triangle), a strip (each new one with the two before) and a fan (each new one with the first).",
        assembly,
    ),
    row(
        11,
        "Points",
        "Points of size 1, 2, 3, 5 and 8: squares of so many pixels around their place (dots). Size 1 lights exactly its pixel.",
        points,
    ),
    row(
        12,
        "Segments and chains",
        "Drawn with half-transparent ink: separate segments paint each joint twice (dark cells), a chain paints it once.",
        chains,
    ),
    row(
        139,
        "Scene graph",
        "Each part hangs on another. Turning the shoulder by a little turns everything beyond it: three poses that differ in two angles.",
        graph,
    ),
    row(
        140,
        "No graphics interface",
        "From the drawing call to the picture in memory there is only this library: no driver and no GPU.",
        stack,
    ),
    row(
        141,
        "Independent parallel stages",
        "The bands that 1, 2 and 8 threads take turns at, in colours, and the triangles that each of them drew: the bytes are the same.",
        threads,
    ),
    row(
        142,
        "REYES micropolygons",
        "A curved patch: its control net, the diced grid with a colour for each micropolygon, and the patch shaded.",
        reyes,
    ),
];

fn assembly(board: &mut Board) -> Result<()> {
    let panels = board.panels(["LIST", "STRIP", "FAN"]);
    let zigzag = [(1.0, 7.0), (2.5, 2.5), (4.0, 7.5), (6.0, 3.0), (7.0, 8.0), (9.0, 3.5)];
    let wheel = [(5.0, 7.0), (0.8, 6.0), (1.8, 2.2), (5.0, 0.8), (8.4, 2.4), (9.2, 6.2)];
    let kinds = [(Topology::Triangles, zigzag), (Topology::TriangleStrip, zigzag), (Topology::TriangleFan, wheel)];
    for (rect, (topology, places)) in panels.into_iter().zip(kinds) {
        let grid = board.grid(rect, 10, 10);
        let primitives = Primitives::new(&places, topology);
        for (i, corners) in primitives.iter().enumerate() {
            let at: Vec<Point> =
                corners.iter().filter_map(|k| places.get(*k as usize)).map(|(x, y)| grid.map(*x, *y)).collect();
            board.canvas.fill_polygon(&at, FillRule::NonZero, [SKY, MINT, ROSE, AMBER][i % 4]);
            board.canvas.stroke_polygon(&at, &Stroke::new(1.6), INK);
            let middle =
                at.iter().fold(Point::new(0.0, 0.0), |sum, p| Point::new(sum.x + p.x / 3.0, sum.y + p.y / 3.0));
            board.middle(middle, 11.0, &format!("T{i}"), GREY);
        }
        for (i, (x, y)) in places.iter().enumerate() {
            board.canvas.fill_circle(grid.map(*x, *y), 9.0, INK);
            board.middle(grid.map(*x, *y), 9.0, &i.to_string(), Color::WHITE);
        }
    }
    Ok(())
}

fn points(board: &mut Board) -> Result<()> {
    let whole = board.whole();
    let size = (34, 18);
    let mut target = stage::paper(size.0, size.1, Samples::One)?;
    let places = [(3.5, 9.5), (8.0, 9.0), (13.5, 9.5), (20.5, 9.5), (28.0, 9.0)];
    let sizes = [1, 2, 3, 5, 8];
    for ((place, n), color) in places.into_iter().zip(sizes).zip([RED, AMBER, GREEN, BLUE, VIOLET]) {
        let vertices = [Vertex { position: stage::device(place, 0.5, size), values: stage::components(color) }];
        let state = State { point_size: n as f32, ..State::default() };
        let primitives = Primitives::new(&vertices, Topology::Points);
        stage::draw_primitives(&mut target, &stage::pipeline(size.0, size.1, state), &primitives, &stage::carried);
    }
    let grid = board.zoomed(whole, target.to_pixmap()?);
    for ((x, y), n) in places.into_iter().zip(sizes) {
        board.dot(&grid, x, y, 3.0, INK);
        board.middle(grid.map(x, 15.5), 13.0, &n.to_string(), INK);
    }
    Ok(())
}

fn chains(board: &mut Board) -> Result<()> {
    let [left, right] = board.panels(["SEGMENTS", "CHAIN"]);
    let size = (22, 22);
    let places = [(2.5, 18.5), (6.5, 5.5), (11.5, 14.5), (15.5, 3.5), (19.5, 19.5)];
    let vertex =
        |at| Vertex { position: stage::device(at, 0.5, size), values: stage::components(BLUE.with_opacity(0.45)) };
    let chain: Vec<Vertex> = places.into_iter().map(vertex).collect();
    let pairs: Vec<Vertex> = chain.windows(2).flatten().copied().collect();
    let state = State { depth: Depth::OFF, blend: Blend::SourceOver, ..State::default() };
    for (rect, vertices, topology) in [(left, &pairs, Topology::Lines), (right, &chain, Topology::LineStrip)] {
        let mut target = stage::paper(size.0, size.1, Samples::One)?;
        let pipeline = stage::pipeline(size.0, size.1, state);
        if topology == Topology::Lines {
            // A segment does not draw its last pixel: the way back draws it, so that each is whole.
            for pair in vertices.chunks(2) {
                let primitives = Primitives::new(pair, Topology::LineLoop);
                let whole = whole_segment(&pipeline, &primitives, size)?;
                stage::draw_primitives(
                    &mut target,
                    &pipeline,
                    &Primitives::new(&whole, Topology::Points),
                    &stage::carried,
                );
            }
        } else {
            stage::draw_primitives(&mut target, &pipeline, &Primitives::new(vertices, topology), &stage::carried);
        }
        board.zoomed(rect, target.to_pixmap()?);
    }
    Ok(())
}

/// The pixels of a segment with both its ends, as points.
fn whole_segment(
    pipeline: &rastrum::space::Pipeline,
    primitives: &Primitives<'_, Vertex>,
    size: (u32, u32),
) -> Result<Vec<Vertex>> {
    let mut mask = rastrum::space::Target::new(size.0, size.1)?;
    stage::draw_primitives(&mut mask, pipeline, primitives, &stage::carried);
    let values = primitives.vertices.first().map_or([0.0; 4], |vertex| vertex.values);
    let mut out = Vec::new();
    for y in 0..size.1 {
        for x in 0..size.0 {
            if mask.pixel(x, y).is_some_and(|pixel| pixel[3] != 0) {
                let at = (x as f32 + 0.5, y as f32 + 0.5);
                out.push(Vertex { position: stage::device(at, 0.5, size), values });
            }
        }
    }
    Ok(out)
}

/// An arm of three nodes, the shoulder and the elbow turned.
fn arm(shoulder: f32, elbow: f32) -> Scene {
    let mut scene = Scene::new();
    let limb = |scene: &mut Scene, color, length: f32| {
        let material = scene.add_material(stage::matte(color));
        scene.meshes.push(Mesh::cuboid([0.0, -0.16, -0.16], [length, 0.16, 0.16], material));
        scene.meshes.len() - 1
    };
    let (upper, lower, hand) = (limb(&mut scene, BLUE, 1.2), limb(&mut scene, GREEN, 1.0), limb(&mut scene, RED, 0.4));
    let turn = |angle| camera::rotation([0.0, 0.0, 1.0], angle);
    let nodes = [
        (turn(shoulder), vec![upper], vec![1]),
        (camera::product(&stage::at(1.2, 0.0, 0.0), &turn(elbow)), vec![lower], vec![2]),
        (camera::product(&stage::at(1.0, 0.0, 0.0), &turn(elbow * 0.6)), vec![hand], vec![]),
    ];
    scene.nodes = nodes
        .into_iter()
        .map(|(transform, meshes, children)| Node { transform, meshes, children, ..Node::default() })
        .collect();
    scene.roots = vec![0];
    scene.ambient = 0.35;
    scene.lights.push(rastrum::scene::Light::directional([0.4, 0.8, 1.0]));
    scene
}

fn graph(board: &mut Board) -> Result<()> {
    let panels = board.panels(["SHOULDER 0, ELBOW 20", "40, 20", "40, 70"]);
    let camera = Camera::look_at([1.3, 0.9, 4.6], [1.15, 0.75, 0.0], [0.0, 1.0, 0.0]);
    let degrees = |d: f32| d * std::f32::consts::PI / 180.0;
    for (rect, (shoulder, elbow)) in panels.into_iter().zip([(0.0, 20.0), (40.0, 20.0), (40.0, 70.0)]) {
        let (top, tree) = (Rect { bottom: rect.top + 230.0, ..rect }, Rect { top: rect.top + 240.0, ..rect });
        stage::show(board, top, &arm(degrees(shoulder), degrees(elbow)), &camera, &stage::settings())?;
        for (i, (name, color)) in [("UPPER ARM", BLUE), ("LOWER ARM", GREEN), ("HAND", RED)].into_iter().enumerate() {
            let (x, y) = (tree.left + 6.0 + 22.0 * i as f32, tree.top + 14.0 + 32.0 * i as f32);
            if i > 0 {
                board.segment(Point::new(x - 15.0, y - 18.0), Point::new(x - 15.0, y + 5.0), 1.4, GREY);
                board.segment(Point::new(x - 15.0, y + 5.0), Point::new(x - 5.0, y + 5.0), 1.4, GREY);
            }
            board.label(x, y, 10.0, name, color);
        }
    }
    Ok(())
}

fn stack(board: &mut Board) -> Result<()> {
    let layers = [
        ("DRAWING CALL", SKY),
        ("SCENE: NODES, LIGHTS", MINT),
        ("SPACE: VERTICES, TILES, FRAGMENTS", AMBER),
        ("PIXELS IN MEMORY", ROSE),
    ];
    for (i, (name, color)) in layers.into_iter().enumerate() {
        let rect = Rect::from_xywh(24.0, 22.0 + i as f32 * 92.0, 400.0, 66.0);
        board.bar(rect, mix(color, Color::WHITE, 0.3));
        board.frame(rect, INK);
        board.middle(rect.center(), 12.0, name, INK);
        if i > 0 {
            board.arrow(Point::new(224.0, rect.top - 24.0), Point::new(224.0, rect.top - 4.0), INK);
        }
    }
    for (i, name) in ["DRIVER", "GPU"].into_iter().enumerate() {
        let rect = Rect::from_xywh(470.0, 114.0 + i as f32 * 110.0, 140.0, 66.0);
        board.bar(rect, PALE);
        board.frame(rect, GREY);
        board.middle(rect.center(), 12.0, name, GREY);
        board.segment(
            Point::new(rect.left - 6.0, rect.top - 6.0),
            Point::new(rect.right + 6.0, rect.bottom + 6.0),
            4.0,
            RED,
        );
        board.segment(
            Point::new(rect.left - 6.0, rect.bottom + 6.0),
            Point::new(rect.right + 6.0, rect.top - 6.0),
            4.0,
            RED,
        );
    }
    Ok(())
}

/// Random triangles of colours of their own on a square of `size`.
pub(super) fn confetti(count: usize, size: u32, seed: u64) -> Vec<Vertex> {
    let mut random = stage::Random::new(seed);
    let mut out = Vec::new();
    for i in 0..count {
        let (cx, cy) = (random.within(0.0, size as f32), random.within(0.0, size as f32));
        let reach = size as f32 * 0.22;
        let corners = [(); 3].map(|()| (cx + random.within(-reach, reach), cy + random.within(-reach, reach)));
        let color = [RED, AMBER, GREEN, BLUE, VIOLET, SKY, MINT, ROSE][i % 8];
        out.extend(stage::flat(corners, random.within(0.05, 0.95), color, (size, size)));
    }
    out
}

fn threads(board: &mut Board) -> Result<()> {
    let panels = board.panels(["1 THREAD", "2 THREADS", "8 THREADS"]);
    let list = confetti(60, 128, 5);
    let mut first: Option<Vec<u8>> = None;
    for (rect, count) in panels.into_iter().zip([1, 2, 8]) {
        let pipeline = stage::pipeline(128, 128, State::default()).with_threads(count);
        let mut target = stage::paper(128, 128, Samples::One)?;
        stage::draw(&mut target, &pipeline, &list, &stage::carried);
        let (rows, bands) = stage::bins(&target, &pipeline, &list);
        let picture = target.to_pixmap()?;
        let same = *first.get_or_insert_with(|| picture.data().to_vec()) == picture.data();
        let top = Rect { bottom: rect.top + 210.0, ..rect };
        let grid = board.picture(top, picture);
        let side = grid.rect();
        for (i, band) in bands.iter().enumerate() {
            let y = i as f32 * rows as f32 / 128.0 * side.height();
            let height = (rows as f32 / 128.0 * side.height()).min(side.height() - y).max(0.0);
            let strip = Rect::from_xywh(
                side.left,
                side.bottom + 12.0 + y * 0.55,
                side.width() * band.len() as f32 / 60.0,
                height * 0.55 - 1.0,
            );
            board.bar(strip, [SKY, MINT, ROSE, AMBER][i % 4]);
            if y > 0.0 {
                board.segment(Point::new(side.left, side.top + y), Point::new(side.right, side.top + y), 1.2, INK);
            }
        }
        let at = Point::new(side.center().x, 388.0);
        board.middle(at, 10.0, if same { "SAME BYTES" } else { "DIFFERENT" }, if same { GREEN } else { RED });
    }
    Ok(())
}

/// A point of the curved patch.
fn patch(u: f32, v: f32) -> [f32; 3] {
    let bell = |t: f32| 4.0 * t * (1.0 - t);
    [u * 2.0 - 1.0, bell(u) * bell(v) * 0.9 - 0.35 * bell(u) * (1.0 - v), v * 2.0 - 1.0]
}

fn reyes(board: &mut Board) -> Result<()> {
    let panels = board.panels(["CONTROL NET", "DICED", "SHADED"]);
    let camera = Camera::look_at([1.5, 2.0, 2.6], [0.0, 0.1, 0.0], [0.0, 1.0, 0.0]);
    for (i, rect) in panels.into_iter().enumerate() {
        let n: u32 = [4, 16, 96][i];
        let mut mesh = Mesh::default();
        let mut random = stage::Random::new(3);
        for y in 0..n {
            for x in 0..n {
                let first = mesh.vertices.len() as u32;
                let tint = if i == 1 {
                    [random.within(0.3, 1.0), random.within(0.4, 1.0), random.within(0.5, 1.0), 1.0]
                } else {
                    [0.35, 0.6, 0.95, 1.0]
                };
                for (dx, dy) in [(0, 0), (1, 0), (1, 1), (0, 1)] {
                    let position = patch((x + dx) as f32 / n as f32, (y + dy) as f32 / n as f32);
                    mesh.vertices.push(rastrum::scene::MeshVertex { position, color: tint, ..Default::default() });
                }
                mesh.indices.extend([0, 2, 1, 0, 3, 2].map(|k| first + k));
            }
        }
        mesh.flat_normals();
        let scene = stage::scene(vec![(mesh, stage::matte(Color::WHITE), Mat4::IDENTITY)]);
        let mut settings = stage::settings();
        if i == 0 {
            settings.fill = rastrum::space::Fill::Wireframe;
            settings.shading = Some(rastrum::scene::Shading::Unlit);
        }
        stage::show(board, rect, &scene, &camera, &settings)?;
    }
    Ok(())
}
