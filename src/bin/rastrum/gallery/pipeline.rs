//! The pipeline's stages and what vertices go through.

use rastrum::glam::Mat4;
use rastrum::scene::{Camera, Mesh, Projection, Scene, Shading};
use rastrum::space::{Pipeline, Samples, State, Target, Viewport, camera};
use rastrum::{Color, Pixmap, Point, Rect, Result};

use super::board::{AMBER, BLUE, Board, FAINT, GREEN, GREY, Grid, INK, MINT, RED, ROSE, SKY, VIOLET, mix};
use super::stage::{self, Triangle, Vertex};
use super::{Row, row};

pub(super) const ROWS: &[Row] = &[
    row(
        1,
        "Vertex, raster, fragment, framebuffer",
        "One triangle through four stages: its corners land on the screen, pixel centres inside are found, each gets its colour, and what is nearer than the blue triangle stays.",
        stages,
    ),
    row(
        2,
        "Visibility: the nearest point wins",
        "Three triangles that cut through each other. The curves are their depths along the marked row; the lowest one shows.",
        visibility,
    ),
    row(
        3,
        "Ray casting",
        "Image order: a ray through each pixel's centre finds the triangle it meets first (red dots). Right: the triangles of the last picture, cast ray by ray.",
        ray_casting,
    ),
    row(
        4,
        "Normalised device coordinates",
        "The square from −1 to 1 is stretched onto the viewport, y turned over. The same triangle lands in two viewports of one target; what leaves the square is cut off.",
        ndc,
    ),
    row(
        5,
        "Model, view, projection",
        "One house seen from above in each space: its own, the world's, the camera's (camera at the dot), and after the divide, where what is far has become small.",
        transforms,
    ),
    row(
        6,
        "Perspective matrix",
        "The view volume from the side, and what it becomes: the near plane (green) goes to −1, the far plane (red) to +1. Equal steps in depth are squeezed together towards the far plane.",
        perspective,
    ),
    row(
        7,
        "Parallel projection",
        "Equal boxes, one behind another: with perspective the far ones shrink; in parallel projection all stay the same size.",
        parallel,
    ),
    row(
        8,
        "Vertex attributes",
        "The same triangle's position, colour, texture coordinates and depth, each interpolated and read for every fragment.",
        attributes,
    ),
    row(
        9,
        "Gouraud shading",
        "Phong's formula at the vertices and linear between them (left) loses the highlight that the formula at each pixel gives (right).",
        gouraud,
    ),
];

/// The first two triangles of the section, as vertices on a grid of 20 × 15.
const SIZE: (u32, u32) = (20, 15);
const NEAR: Triangle = [(2.2, 12.6), (9.4, 1.4), (17.6, 11.2)];
const FAR: Triangle = [(6.0, 13.8), (12.5, 2.0), (19.0, 6.5)];

fn near() -> [Vertex; 3] {
    let colors = [RED, AMBER, GREEN];
    let mut vertices = stage::flat(NEAR, 0.5, RED, SIZE);
    for ((vertex, color), z) in vertices.iter_mut().zip(colors).zip([0.2, 0.3, 0.8_f32]) {
        vertex.values = stage::components(color);
        vertex.position[2] = z * 2.0 - 1.0;
    }
    vertices
}

fn stages(board: &mut Board) -> Result<()> {
    let panels = board.tiles(2, &["VERTEX", "RASTER", "FRAGMENT", "FRAMEBUFFER"]);
    let [vertex, raster, fragment, framebuffer] = panels.as_slice() else { return Ok(()) };
    let grid = board.pixels(*vertex, SIZE, [], SKY);
    for ((x, y), color) in NEAR.into_iter().zip([RED, AMBER, GREEN]) {
        board.dot(&grid, x, y, 6.0, color);
    }
    let grid = board.pixels(*raster, SIZE, stage::covered(NEAR, SIZE, State::default())?, FAINT);
    board.centers(&grid);
    board.outline(&grid, &NEAR, 1.5, INK);
    board.zoomed(*fragment, stage::picture(&near(), SIZE, Samples::One, State::default())?);
    let mut both = stage::flat(FAR, 0.5, SKY, SIZE).to_vec();
    both.extend(near());
    board.zoomed(*framebuffer, stage::picture(&both, SIZE, Samples::One, State::default())?);
    Ok(())
}

/// Three triangles that cut each other: corners in pixels of 48 × 40 with depth, and colours.
fn crossing() -> [([(f32, f32, f32); 3], Color); 3] {
    [
        ([(3.0, 6.0, 0.1), (45.0, 18.0, 0.9), (4.0, 32.0, 0.15)], SKY),
        ([(45.0, 5.0, 0.15), (44.0, 35.0, 0.2), (2.0, 20.0, 0.85)], ROSE),
        ([(24.0, 2.0, 0.45), (34.0, 38.0, 0.5), (12.0, 38.0, 0.4)], AMBER),
    ]
}

fn crossing_vertices() -> Vec<Vertex> {
    let place = |(corners, color): ([(f32, f32, f32); 3], Color)| {
        corners
            .map(|(x, y, z)| Vertex { position: stage::device((x, y), z, (48, 40)), values: stage::components(color) })
    };
    crossing().into_iter().flat_map(place).collect()
}

/// The depth of a triangle at a place, if it is inside.
fn depth_at(t: &[(f32, f32, f32); 3], x: f32, y: f32) -> Option<f32> {
    let edge = |a: (f32, f32, f32), b: (f32, f32, f32)| (b.0 - a.0) * (y - a.1) - (b.1 - a.1) * (x - a.0);
    let [a, b, c] = *t;
    let (u, v, w) = (edge(b, c), edge(c, a), edge(a, b));
    let sum = u + v + w;
    (u * sum >= 0.0 && v * sum >= 0.0 && w * sum >= 0.0).then(|| (u * a.2 + v * b.2 + w * c.2) / sum)
}

fn visibility(board: &mut Board) -> Result<()> {
    let [left, right] = board.panels(["PICTURE", "DEPTHS ALONG THE ROW"]);
    let grid = board.zoomed(left, stage::picture(&crossing_vertices(), (48, 40), Samples::One, State::default())?);
    let y = 20.5;
    board.segment(grid.map(0.0, y), grid.map(48.0, y), 2.0, INK);
    let axes = board.axes(right, (0.0, 48.0), (0.0, 1.0), ("X", "DEPTH"));
    let samples = || (0..480).map(|i| i as f32 / 10.0);
    for (triangle, color) in crossing() {
        board.curve(&axes, samples().filter_map(|x| Some((x, depth_at(&triangle, x, y)?))), color);
    }
    let nearest = |x: f32| crossing().iter().filter_map(|(t, _)| depth_at(t, x, y)).min_by(f32::total_cmp);
    for (x, z) in samples().filter_map(|x| Some((x, nearest(x)?))) {
        board.canvas.fill_circle(axes.map(x, z), 1.3, INK);
    }
    Ok(())
}

fn ray_casting(board: &mut Board) -> Result<()> {
    let [left, right] = board.panels(["FROM THE SIDE", "CAST RAY BY RAY"]);
    let eye = Point::new(left.left + 6.0, left.top + left.height() / 2.0);
    let plane = left.left + 70.0;
    let walls = [((150.0, -120.0), (200.0, 10.0), SKY), ((270.0, -60.0), (210.0, 120.0), ROSE)];
    for ((x0, y0), (x1, y1), color) in walls {
        board.segment(Point::new(left.left + x0, eye.y + y0), Point::new(left.left + x1, eye.y + y1), 5.0, color);
    }
    for i in 0..9 {
        let dy = (i as f32 - 4.0) * 12.0;
        let slope = dy / (plane - eye.x);
        // The nearest wall along eye + t·(1, slope).
        let hit = walls.iter().filter_map(|((x0, y0), (x1, y1), _)| {
            let (ax, ay, dx, dy) = (x0 - 6.0, *y0, x1 - x0, y1 - y0);
            let s = (slope * ax - ay) / (dy - slope * dx);
            (0.0..=1.0).contains(&s).then_some(ax + s * dx)
        });
        let end = hit.min_by(f32::total_cmp);
        let far = end.unwrap_or(285.0);
        let to = Point::new(eye.x + far, eye.y + far * slope);
        board.segment(eye, to, 1.2, GREY);
        if end.is_some() {
            board.canvas.fill_circle(to, 4.5, RED);
        }
        board.frame(Rect::from_xywh(plane - 5.0, eye.y + dy - 6.0, 10.0, 12.0), INK);
    }
    board.canvas.fill_circle(eye, 6.0, INK);
    let triangles = crossing();
    let mut data = Vec::new();
    for y in 0..20 {
        for x in 0..24 {
            let (px, py) = (x as f32 * 2.0 + 1.0, y as f32 * 2.0 + 1.0);
            let hits = triangles.iter().filter_map(|(t, color)| Some((depth_at(t, px, py)?, *color)));
            let nearest = hits.min_by(|a, b| a.0.total_cmp(&b.0));
            data.extend(nearest.map_or(Color::WHITE, |(_, color)| color).premultiply());
        }
    }
    let grid = board.zoomed(right, Pixmap::from_vec(24, 20, data)?);
    board.centers(&grid);
    Ok(())
}

fn ndc(board: &mut Board) -> Result<()> {
    let [left, right] = board.panels(["NDC, Y UP", "TWO VIEWPORTS"]);
    let shape = [(-0.8, -0.7), (1.35, -0.2), (-0.1, 0.9)];
    let grid = board.grid(left, 3, 3);
    let square = [(0.5, 0.5), (2.5, 0.5), (2.5, 2.5), (0.5, 2.5)];
    board.outline(&grid, &square, 2.0, BLUE);
    let corners = shape.map(|(x, y)| (x + 1.5, 1.5 - y));
    board.outline(&grid, &corners, 2.0, RED);
    board.segment(grid.map(0.3, 1.5), grid.map(2.7, 1.5), 1.0, GREY);
    board.segment(grid.map(1.5, 0.3), grid.map(1.5, 2.7), 1.0, GREY);
    board.middle(grid.map(0.5, 2.68), 12.0, "-1,-1", BLUE);
    board.middle(grid.map(2.5, 0.32), 12.0, "1,1", BLUE);
    let mut target = stage::paper(28, 28, Samples::One)?;
    let clip = shape.map(|(x, y)| Vertex { position: [x, y, 0.0, 1.0], values: stage::components(RED) });
    let views = [(2.0, 2.0, 16.0, 10.0), (12.0, 14.0, 14.0, 12.0)];
    for (x, y, width, height) in views {
        let viewport = Viewport { x, y, width, height, ..Viewport::new(28, 28) };
        stage::draw(
            &mut target,
            &Pipeline { viewport, ..stage::pipeline(28, 28, State::default()) },
            &clip,
            &stage::carried,
        );
    }
    let grid = board.zoomed(right, target.to_pixmap()?);
    for (x, y, w, h) in views {
        board.outline(&grid, &[(x, y), (x + w, y), (x + w, y + h), (x, y + h)], 2.0, BLUE);
    }
    Ok(())
}

fn transforms(board: &mut Board) -> Result<()> {
    let panels = board.tiles(4, &["MODEL", "WORLD", "VIEW", "NDC"]);
    let house = [(-1.0, 1.0), (-1.0, -1.0), (0.0, -1.8), (1.0, -1.0), (1.0, 1.0)];
    let model = camera::product(&camera::translation([1.4, 0.0, -2.2]), &camera::rotation([0.0, 1.0, 0.0], 0.7));
    let view = camera::look_at([-1.6, 0.0, 3.4], [1.0, 0.0, -2.0], [0.0, 1.0, 0.0]);
    let projection = camera::perspective(0.9, 1.0, 2.0, 10.0);
    let world_view = camera::product(&view, &model);
    let all = camera::product(&projection, &world_view);
    let steps = [Mat4::IDENTITY, model, world_view, all];
    let tall: Vec<Rect> = panels;
    for ((rect, matrix), i) in tall.into_iter().zip(steps).zip(0..) {
        let scale = if i == 3 { 2.6 } else { 13.0 };
        let axes = board.axes(rect, (-scale / 2.0, scale / 2.0), (-scale * 1.15, scale * 1.15), ("X", "Z"));
        let corners: Vec<Point> = house
            .iter()
            .map(|(x, z)| {
                let [x, _, z, w] = camera::transform(&matrix, [*x, 0.0, *z, 1.0]);
                axes.map(x / w, if i == 3 { z / w } else { -z / w })
            })
            .collect();
        board.canvas.fill_polygon(&corners, rastrum::FillRule::NonZero, SKY);
        board.canvas.stroke_polygon(&corners, &rastrum::Stroke::new(2.0), BLUE);
        match i {
            1 => board.canvas.fill_circle(axes.map(-1.6, -3.4), 5.0, RED),
            2 => board.canvas.fill_circle(axes.map(0.0, 0.0), 5.0, RED),
            3 => {
                let (a, b) = (axes.map(-1.0, 1.0), axes.map(1.0, -1.0));
                board.frame(Rect::from_ltrb(a.x, a.y, b.x, b.y), RED);
            }
            _ => {}
        }
    }
    Ok(())
}

fn perspective(board: &mut Board) -> Result<()> {
    let [left, right] = board.panels(["VIEW VOLUME", "NDC"]);
    let (near, far) = (1.0_f32, 6.0_f32);
    let eye = Point::new(left.left + 4.0, left.top + left.height() / 2.0);
    let place = |z: f32, t: f32| Point::new(eye.x + z * 46.0, eye.y + t * z * 24.0);
    let grid = Grid { left: right.left + 30.0, top: right.top + 40.0, cell: 240.0, columns: 1, rows: 1 };
    let m = camera::perspective(0.9, 1.0, near, far);
    let ndc = |z: f32| {
        let [_, _, cz, cw] = camera::transform(&m, [0.0, 0.0, -z, 1.0]);
        cz / cw
    };
    for i in 0..=10 {
        let z = near + (far - near) * i as f32 / 10.0;
        let color = match i {
            0 => GREEN,
            10 => RED,
            _ => mix(MINT, ROSE, i as f32 / 10.0),
        };
        let width = if i % 10 == 0 { 3.5 } else { 2.0 };
        board.segment(place(z, -1.0), place(z, 1.0), width, color);
        let x = (ndc(z) + 1.0) / 2.0;
        board.segment(grid.map(x, 0.0), grid.map(x, 1.0), width, color);
    }
    for t in [-1.0, 1.0] {
        board.segment(eye, place(far, t), 1.4, INK);
        let y = (t + 1.0) / 2.0;
        board.segment(grid.map(0.0, y), grid.map(1.0, y), 1.4, INK);
    }
    board.canvas.fill_circle(eye, 6.0, INK);
    board.middle(Point::new(place(near, 0.0).x, eye.y + 60.0), 12.0, "N", GREEN);
    board.middle(Point::new(place(far, 0.0).x, eye.y + 162.0), 12.0, "F", RED);
    board.middle(grid.map(0.0, 1.08), 12.0, "-1", GREEN);
    board.middle(grid.map(1.0, 1.08), 12.0, "+1", RED);
    Ok(())
}

fn boxes() -> Scene {
    let part = |i: usize| {
        let color = [RED, AMBER, GREEN, BLUE, VIOLET][i % 5];
        let place = stage::at(-1.6 + i as f32 * 0.8, 0.0, -1.7 * i as f32);
        (Mesh::cuboid([-0.4, -0.5, -0.4], [0.4, 0.5, 0.4], 0), stage::matte(color), place)
    };
    stage::scene((0..5).map(part).collect())
}

fn parallel(board: &mut Board) -> Result<()> {
    let [left, right] = board.panels(["PERSPECTIVE", "PARALLEL"]);
    let eye = Camera::look_at([0.6, 2.2, 4.4], [0.2, -0.1, -2.0], [0.0, 1.0, 0.0]);
    stage::show(board, left, &boxes(), &eye, &stage::settings())?;
    let flat = Camera { projection: Projection::Orthographic(6.4), ..eye };
    stage::show(board, right, &boxes(), &flat, &stage::settings())?;
    Ok(())
}

fn attributes(board: &mut Board) -> Result<()> {
    let panels = board.tiles(2, &["POSITION X, Y", "COLOUR", "U, V", "DEPTH"]);
    let depths = [0.0, 0.45, 1.0_f32];
    let corner = |i: usize, values: [f32; 4]| {
        let mut position = stage::device(NEAR[i], 0.0, SIZE);
        position[2] = depths[i] * 2.0 - 1.0;
        Vertex { position, values }
    };
    let colors = [RED, GREEN, BLUE].map(stage::components);
    let uv = [[0.0, 0.0, 0.0, 1.0], [3.0, 0.0, 0.0, 1.0], [0.0, 3.0, 0.0, 1.0]];
    for (i, rect) in panels.into_iter().enumerate() {
        let mut target = Target::new(SIZE.0 * 2, SIZE.1 * 2)?;
        target.clear_color(Color::WHITE);
        let values = if i == 1 { colors } else { uv };
        let vertices: Vec<Vertex> = (0..3).map(|k| corner(k, values[k])).collect();
        let pipeline = stage::pipeline(SIZE.0 * 2, SIZE.1 * 2, State::default());
        stage::draw(&mut target, &pipeline, &vertices, &|fragment| {
            let [u, v, ..] = fragment.varyings;
            Some(match i {
                0 => [fragment.x as f32 / 40.0, fragment.y as f32 / 30.0, 0.3, 1.0],
                1 => return stage::carried(fragment),
                2 if (u.floor() + v.floor()) as i32 % 2 == 0 => stage::components(SKY),
                2 => stage::components(VIOLET),
                _ => [fragment.depth, fragment.depth, fragment.depth, 1.0],
            })
        });
        board.zoomed(rect, target.to_pixmap()?);
    }
    Ok(())
}

fn gouraud(board: &mut Board) -> Result<()> {
    let [left, right] = board.panels(["AT THE VERTICES", "AT EACH PIXEL"]);
    let mut scene = stage::scene(vec![(Mesh::sphere(1.0, 14, 8, 0), stage::matte(BLUE), Mat4::IDENTITY)]);
    if let Some(material) = scene.materials.first_mut() {
        (material.specular, material.shininess) = (0.9, 40);
    }
    scene.ambient = 0.15;
    let camera = Camera::look_at([0.3, 0.8, 2.2], [0.0; 3], [0.0, 1.0, 0.0]);
    for (rect, shading) in [(left, Shading::Gouraud), (right, Shading::Phong)] {
        let settings = rastrum::scene::SceneSettings { shading: Some(shading), ..stage::settings() };
        stage::show(board, rect, &scene, &camera, &settings)?;
    }
    Ok(())
}
