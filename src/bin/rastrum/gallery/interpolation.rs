//! Values between the corners of a triangle.

use rastrum::glam::Mat4;
use rastrum::scene::{Camera, Mesh, SceneSettings, Shading};
use rastrum::space::{Primitives, Samples, State, Target, camera, pixel_fn, vertex_fn};
use rastrum::{Color, FillRule, Pixmap, Point, Rect, Result};

use super::board::{AMBER, BLUE, Board, FAINT, GREEN, GREY, INK, MINT, RED, ROSE, SKY, VIOLET, grey, mix};
use super::parts::confetti;
use super::stage::{self, Triangle, Vertex};
use super::{Row, row};

pub(super) const ROWS: &[Row] = &[
    row(
        74,
        "Barycentrics from areas",
        "A point cuts the triangle into three. Each one's share of the area, in percent, is the weight of the corner across (same colour); they add up to 100.",
        areas,
    ),
    row(
        75,
        "u and v from edge functions",
        "u and v in percent at every pixel: an edge function over twice the area. u is 0 on one side and 100 at the corner across from it.",
        u_and_v,
    ),
    row(
        76,
        "Interpolation without perspective",
        "A value of 0, 50 and 100 at the corners. On every row the steps from pixel to pixel are equal, and the lines of equal value are straight and evenly spaced.",
        affine,
    ),
    row(
        77,
        "I/z and 1/z",
        "A value along an edge that goes into the distance. 1/z (grey) and I/z (amber) are linear on the screen; their quotient is the true value (blue), plain interpolation (red) is not.",
        quotient,
    ),
    row(
        78,
        "Weights by e / w",
        "A triangle whose right corner is four times as far. Bands are tenths of that corner's weight: evenly spaced by e alone (left), crowded towards the far corner by e/w (right).",
        weights,
    ),
    row(
        79,
        "u/w, then divide",
        "A checkered floor of two triangles. Interpolated on the screen it breaks along the diagonal; by u/w and 1/w, divided at each pixel, it is flat.",
        checker,
    ),
    row(
        80,
        "Homogeneous divide",
        "Points (x, w) and their rays through the origin. Dividing by w lands all points of a ray on the same place of the line w = 1.",
        divide,
    ),
    row(
        81,
        "Once per triangle, once per pixel",
        "Set-up work (three corners' worth) is done once for each triangle, the rest once for each pixel of it. Bars: triangles, and pixels drawn.",
        work,
    ),
    row(
        82,
        "Incremental evaluation",
        "A linear value over 4,096 pixels by adding the step each time (red), against one product (blue): the error of the sum grows, here in millionths, and stays small.",
        drift,
    ),
    row(
        83,
        "Plane coefficients",
        "a·x + b·y + c through three corners' values by Cramer's rule. The plane goes on beyond the triangle, and is met at each corner.",
        plane,
    ),
    row(
        84,
        "Several parameters at once",
        "One triangle with sixteen varyings, each with its own three values at the corners.",
        varyings,
    ),
    row(
        85,
        "Normals between corners",
        "Weighted normals are too short in the middle (red); normalised they keep their length (green). Right: the length before.",
        normals,
    ),
    row(86, "Phong per pixel", "Ambient, diffuse and specular light, computed at each pixel, and their sum.", phong),
];

const CORNERS: Triangle = [(1.5, 8.0), (6.0, 1.0), (12.5, 7.0)];

fn areas(board: &mut Board) -> Result<()> {
    let whole = board.whole();
    let grid = board.grid(whole, 14, 9);
    let p = (6.2, 5.2);
    let area =
        |a: (f32, f32), b: (f32, f32), c: (f32, f32)| ((b.0 - a.0) * (c.1 - a.1) - (b.1 - a.1) * (c.0 - a.0)).abs();
    let [a, b, c] = CORNERS;
    for ((q, r), color) in [((b, c), ROSE), ((c, a), MINT), ((a, b), SKY)] {
        let points = [p, q, r].map(|(x, y)| grid.map(x, y));
        board.canvas.fill_polygon(&points, FillRule::NonZero, color);
        let share = area(p, q, r) / area(a, b, c);
        let middle = grid.map((p.0 + q.0 + r.0) / 3.0, (p.1 + q.1 + r.1) / 3.0);
        board.middle(middle, 16.0, &format!("{:.0}", share * 100.0), INK);
    }
    board.outline(&grid, &CORNERS, 2.0, INK);
    for (at, color) in CORNERS.into_iter().zip([RED, GREEN, BLUE]) {
        board.segment(grid.map(p.0, p.1), grid.map(at.0, at.1), 1.4, INK);
        board.dot(&grid, at.0, at.1, 8.0, color);
    }
    board.dot(&grid, p.0, p.1, 6.0, INK);
    Ok(())
}

/// The weights of a triangle's corners at a place.
fn weights_at([a, b, c]: Triangle, x: f32, y: f32) -> [f32; 3] {
    let edge = |p: (f32, f32), q: (f32, f32)| (q.0 - p.0) * (y - p.1) - (q.1 - p.1) * (x - p.0);
    let sum = edge(b, c) + edge(c, a) + edge(a, b);
    [edge(b, c) / sum, edge(c, a) / sum, edge(a, b) / sum]
}

fn u_and_v(board: &mut Board) -> Result<()> {
    let [left, right] = board.panels(["U", "V"]);
    let t = [(0.6, 9.2), (4.0, 0.6), (9.4, 7.4)];
    for (rect, which, color) in [(left, 1, ROSE), (right, 2, SKY)] {
        let grid = board.grid(rect, 10, 10);
        let pixels = stage::covered(t, (10, 10), State::default())?;
        for (x, y) in &pixels {
            let w = weights_at(t, *x as f32 + 0.5, *y as f32 + 0.5)[which];
            board.cell(&grid, (*x, *y), mix(Color::WHITE, color, w));
        }
        board.lines(&grid);
        board.outline(&grid, &t, 1.6, INK);
        for (x, y) in pixels {
            let w = weights_at(t, x as f32 + 0.5, y as f32 + 0.5)[which];
            board.mark(&grid, (x, y), &format!("{:.0}", w * 100.0), INK);
        }
    }
    Ok(())
}

fn affine(board: &mut Board) -> Result<()> {
    let whole = board.whole();
    let grid = board.grid(whole, 14, 9);
    let value = |x: f32, y: f32| {
        let [_, b, c] = weights_at(CORNERS, x, y);
        b * 50.0 + c * 100.0
    };
    let pixels = stage::covered(CORNERS, (14, 9), State::default())?;
    for (x, y) in &pixels {
        board.cell(&grid, (*x, *y), mix(SKY, ROSE, value(*x as f32 + 0.5, *y as f32 + 0.5) / 100.0));
    }
    board.lines(&grid);
    board.outline(&grid, &CORNERS, 1.8, INK);
    for (x, y) in pixels {
        board.mark(&grid, (x, y), &format!("{:.0}", value(x as f32 + 0.5, y as f32 + 0.5)), INK);
    }
    for ((x, y), text) in CORNERS.into_iter().zip(["0", "50", "100"]) {
        let out = (x + (x - 6.7) * 0.09, y + (y - 5.0) * 0.14);
        board.middle(grid.map(out.0, out.1), 14.0, text, RED);
    }
    Ok(())
}

fn quotient(board: &mut Board) -> Result<()> {
    let whole = board.whole();
    let axes = board.axes(whole, (0.0, 1.0), (0.0, 1.05), ("PLACE ON THE SCREEN", "VALUE"));
    let (z0, z1) = (1.0, 8.0);
    let one_over = |t: f32| (1.0 - t) / z0 + t / z1;
    let over = |t: f32| t * 1.0 / z1;
    let steps = || (0..=100).map(|i| i as f32 / 100.0);
    board.curve(&axes, steps().map(|t| (t, one_over(t))), GREY);
    board.curve(&axes, steps().map(|t| (t, over(t))), AMBER);
    board.curve(&axes, steps().map(|t| (t, t)), RED);
    board.curve(&axes, steps().map(|t| (t, over(t) / one_over(t))), BLUE);
    for (t, y, text, color) in [
        (0.05, 0.99, "1/Z", GREY),
        (0.75, 0.16, "I/Z", AMBER),
        (0.34, 0.5, "I ON THE SCREEN", RED),
        (0.5, 0.09, "I", BLUE),
    ] {
        let at = axes.map(t, y);
        board.label(at.x, at.y - 14.0, 12.0, text, color);
    }
    Ok(())
}

fn weights(board: &mut Board) -> Result<()> {
    let [left, right] = board.panels(["E", "E / W"]);
    let t = [(2.0, 30.0), (4.0, 4.0), (45.0, 20.0)];
    for (rect, w) in [(left, 1.0), (right, 4.0)] {
        let size = (48, 34);
        let mut vertices = stage::flat(t, 0.5, SKY, size);
        vertices[2].position = vertices[2].position.map(|v| v * w);
        for (i, vertex) in vertices.iter_mut().enumerate() {
            vertex.values = [if i == 2 { 1.0 } else { 0.0 }, 0.0, 0.0, 0.0];
        }
        let mut target = stage::paper(size.0, size.1, Samples::One)?;
        stage::draw(&mut target, &stage::pipeline(size.0, size.1, State::default()), &vertices, &|fragment| {
            let band = (fragment.varyings[0] * 10.0).floor();
            let color = mix(SKY, RED, band / 10.0);
            let dim = if band as i32 % 2 == 0 { 1.0 } else { 0.82 };
            let [r, g, b, a] = stage::components(color);
            Some([r * dim, g * dim, b * dim, a])
        });
        board.picture(rect, target.to_pixmap()?);
    }
    Ok(())
}

/// A checkered floor, with or without perspective.
fn plane_of_checkers(perspective: bool, size: (u32, u32)) -> Result<Pixmap> {
    let aspect = size.0 as f32 / size.1 as f32;
    let view = camera::look_at([0.0, 1.5, 3.6], [0.0, 0.2, 0.0], [0.0, 1.0, 0.0]);
    let m = camera::product(&camera::perspective(0.85, aspect, 0.1, 50.0), &view);
    let corner = |(x, z): (f32, f32)| {
        let mut position = camera::transform(&m, [x, 0.0, z, 1.0]);
        if !perspective {
            let w = position[3];
            position = position.map(|v| v / w);
        }
        Vertex { position, values: [(x + 2.0) * 2.0, (z + 3.0) * 2.0, 0.0, 1.0] }
    };
    let [a, b, c, d] = [(-2.0, 1.6), (2.0, 1.6), (2.0, -3.0), (-2.0, -3.0)].map(corner);
    let mut target = stage::paper(size.0, size.1, Samples::Msaa4)?;
    stage::draw(&mut target, &stage::pipeline(size.0, size.1, State::default()), &[a, b, c, a, c, d], &|fragment| {
        let [u, v, ..] = fragment.varyings;
        Some(stage::components(if (u.floor() + v.floor()) as i32 % 2 == 0 { SKY } else { BLUE }))
    });
    target.to_pixmap()
}

fn checker(board: &mut Board) -> Result<()> {
    let [left, right] = board.panels(["ON THE SCREEN", "WITH PERSPECTIVE"]);
    for (rect, perspective) in [(left, false), (right, true)] {
        board.picture(rect, plane_of_checkers(perspective, (rect.width() as u32, rect.height() as u32))?);
    }
    Ok(())
}

fn divide(board: &mut Board) -> Result<()> {
    let whole = board.whole();
    let axes = board.axes(whole, (-1.0, 4.2), (0.0, 3.4), ("X", "W"));
    board.segment(axes.map(-1.0, 1.0), axes.map(4.2, 1.0), 2.5, BLUE);
    let at = axes.map(3.55, 1.0);
    board.label(at.x, at.y + 8.0, 12.0, "W = 1", BLUE);
    for (x, w, color) in [(-0.25_f32, 1.0_f32, VIOLET), (0.3, 1.0, GREEN), (0.95, 1.0, AMBER), (1.35, 1.0, RED)] {
        board.segment(axes.map(0.0, 0.0), axes.map(x * 3.1, w * 3.1), 1.4, FAINT);
        for s in [0.5, 1.6, 2.3, 2.9] {
            let from = axes.map(x * s, w * s);
            board.canvas.fill_circle(from, 5.0, color);
        }
        let to = axes.map(x, w);
        let from = axes.map(x * 1.55, w * 1.55);
        board.arrow(from, to, color);
        board.canvas.stroke_circle(to, 8.0, &rastrum::Stroke::new(2.5), color);
    }
    board.canvas.fill_circle(axes.map(0.0, 0.0), 6.0, INK);
    Ok(())
}

fn work(board: &mut Board) -> Result<()> {
    let [left, right] = board.panels(["PICTURE", "COUNTED"]);
    let list = confetti(24, 96, 12);
    let mut target = stage::paper(96, 96, Samples::One)?;
    let counters = stage::draw_opaque(&mut target, &stage::pipeline(96, 96, State::default()), &list);
    board.picture(left, target.to_pixmap()?);
    let base = right.bottom - 40.0;
    let bars = [("SET-UPS", counters.setups, BLUE), ("PIXELS", counters.fragments, RED)];
    for (i, (name, count, color)) in bars.into_iter().enumerate() {
        let x = right.left + 50.0 + i as f32 * 120.0;
        let height = count as f32 / counters.fragments.max(1) as f32 * 240.0;
        board.bar(Rect::from_xywh(x, base - height.max(2.0), 70.0, height.max(2.0)), color);
        board.middle(Point::new(x + 35.0, base + 16.0), 11.0, name, INK);
        board.middle(Point::new(x + 35.0, base - height - 16.0), 13.0, &count.to_string(), color);
    }
    Ok(())
}

fn drift(board: &mut Board) -> Result<()> {
    let whole = board.whole();
    let step = 1.0_f32 / 4096.0 * 0.731_34;
    let mut sum = 0.113_f32;
    let mut errors = Vec::new();
    for x in 0..=4096_u32 {
        let exact = f64::from(0.113_f32) + f64::from(step) * f64::from(x);
        let product = 0.113_f32 + step * x as f32;
        errors.push((x as f32, ((f64::from(sum) - exact) * 1e6) as f32, ((f64::from(product) - exact) * 1e6) as f32));
        sum += step;
    }
    let most = errors.iter().map(|(_, e, _)| e.abs()).fold(0.5, f32::max);
    let axes = board.axes(whole, (0.0, 4096.0), (-most * 1.1, most * 1.1), ("PIXEL", "ERROR IN MILLIONTHS"));
    board.curve(&axes, errors.iter().step_by(8).map(|(x, e, _)| (*x, *e)), RED);
    board.curve(&axes, errors.iter().step_by(8).map(|(x, _, e)| (*x, *e)), BLUE);
    let at = axes.map(4096.0, 0.0);
    board.label(at.x - 190.0, at.y + 30.0, 11.0, &format!("MOST: {most:.1}"), RED);
    Ok(())
}

fn plane(board: &mut Board) -> Result<()> {
    let whole = board.whole();
    let grid = board.grid(whole, 28, 18);
    let t = [(6.5, 14.5), (10.5, 3.5), (21.5, 11.5)];
    let values = [10.0, 60.0, 90.0_f32];
    // Cramer's rule on the differences to the first corner.
    let (dx1, dy1, dx2, dy2) = (t[1].0 - t[0].0, t[1].1 - t[0].1, t[2].0 - t[0].0, t[2].1 - t[0].1);
    let (d1, d2) = (values[1] - values[0], values[2] - values[0]);
    let determinant = dx1 * dy2 - dx2 * dy1;
    let (a, b) = ((d1 * dy2 - d2 * dy1) / determinant, (dx1 * d2 - dx2 * d1) / determinant);
    let c = values[0] - a * t[0].0 - b * t[0].1;
    for (x, y) in (0..18).flat_map(|y| (0..28).map(move |x| (x, y))) {
        let v = a * (x as f32 + 0.5) + b * (y as f32 + 0.5) + c;
        let banded = (v / 10.0).floor() / 10.0;
        board.cell(
            &grid,
            (x, y),
            mix(
                mix(SKY, ROSE, banded.clamp(0.0, 1.0)),
                Color::WHITE,
                if (0.0..=1.0).contains(&banded) { 0.0 } else { 0.5 },
            ),
        );
    }
    board.lines(&grid);
    board.outline(&grid, &t, 2.2, INK);
    for ((x, y), value) in t.into_iter().zip(values) {
        board.dot(&grid, x, y, 5.0, RED);
        let at = grid.map(x + (x - 12.8) * 0.14, y + (y - 9.8) * 0.2);
        board.middle(at, 15.0, &format!("{value:.0}"), INK);
    }
    let at = grid.map(0.6, 0.6);
    board.label(at.x, at.y, 12.0, &format!("A {a:.2}  B {b:.2}  C {c:.1}"), INK);
    Ok(())
}

/// A clip position and sixteen values.
type Wide = ([f32; 4], [f32; 16]);

fn wide(vertex: &Wide, out: &mut [f32]) -> [f32; 4] {
    out.copy_from_slice(&vertex.1);
    vertex.0
}

fn varyings(board: &mut Board) -> Result<()> {
    let titles: Vec<String> = (1..=16).map(|i| i.to_string()).collect();
    let titles: Vec<&str> = titles.iter().map(String::as_str).collect();
    let panels = board.tiles(4, &titles);
    let size = (24, 12);
    let mut random = stage::Random::new(84);
    let t = [(1.0, 11.5), (9.0, 0.5), (23.5, 9.0)];
    let vertices: Vec<Wide> =
        t.iter().map(|at| (stage::device(*at, 0.5, size), [(); 16].map(|()| random.within(0.0, 1.0)))).collect();
    let shader = vertex_fn(16, wide as fn(&Wide, &mut [f32]) -> [f32; 4]);
    for (k, rect) in panels.into_iter().enumerate() {
        let mut target: Target = stage::paper(size.0, size.1, Samples::One)?;
        let tint = [BLUE, GREEN, RED, VIOLET][k % 4];
        let shade: stage::Shade<'_> = &|fragment| {
            let t = (fragment.varyings.get(k).copied().unwrap_or(0.0) * 8.0).floor() / 8.0;
            Some(stage::components(mix(mix(Color::WHITE, tint, 0.15), tint, t)))
        };
        let pipeline = stage::pipeline(size.0, size.1, State::default());
        pipeline.draw(&mut target, &Primitives::triangles(&vertices), &shader, &pixel_fn(16, shade));
        board.picture(rect, target.to_pixmap()?);
    }
    Ok(())
}

fn normals(board: &mut Board) -> Result<()> {
    let [left, right] = board.panels(["BETWEEN TWO CORNERS", "LENGTH"]);
    let (a, b) = ((-0.8_f32, 0.6_f32), (0.8, 0.6));
    let mix = |t: f32| (a.0 + (b.0 - a.0) * t, a.1 + (b.1 - a.1) * t);
    let length = |n: (f32, f32)| (n.0 * n.0 + n.1 * n.1).sqrt();
    let base = left.bottom - 90.0;
    board.segment(Point::new(left.left + 40.0, base), Point::new(left.right - 40.0, base), 2.0, INK);
    for i in 0..=8 {
        let t = i as f32 / 8.0;
        let foot = Point::new(left.left + 40.0 + t * (left.width() - 80.0), base);
        let n = mix(t);
        let tip = |n: (f32, f32), s: f32| Point::new(foot.x + n.0 * s, foot.y - n.1 * s);
        let unit = (n.0 / length(n), n.1 / length(n));
        board.arrow(foot, tip(unit, 95.0), GREEN);
        board.arrow(foot, tip(n, 95.0), RED);
    }
    let axes = board.axes(right, (0.0, 1.0), (0.0, 1.1), ("T", "LENGTH"));
    board.curve(&axes, [(0.0, 1.0), (1.0, 1.0)], GREEN);
    board.curve(&axes, (0..=50).map(|i| i as f32 / 50.0).map(|t| (t, length(mix(t)))), RED);
    Ok(())
}

fn phong(board: &mut Board) -> Result<()> {
    let panels = board.tiles(2, &["AMBIENT", "DIFFUSE", "SPECULAR", "SUM"]);
    let camera = Camera::look_at([0.0, 0.3, 2.5], [0.0; 3], [0.0, 1.0, 0.0]);
    for (i, rect) in panels.into_iter().enumerate() {
        let mut material = stage::matte(RED);
        material.specular = if i >= 2 { 0.6 } else { 0.0 };
        if i == 2 {
            material.color = [0.0, 0.0, 0.0, 1.0];
        }
        let mut scene = stage::scene(vec![(Mesh::sphere(1.0, 60, 30, 0), material, Mat4::IDENTITY)]);
        scene.ambient = [0.3, 0.0, 0.0, 0.3][i];
        if i == 0 {
            scene.lights.clear();
        }
        let settings = SceneSettings { shading: Some(Shading::Phong), background: grey(0.92), ..stage::settings() };
        stage::show(board, rect, &scene, &camera, &settings)?;
    }
    Ok(())
}
