//! The workloads W1–W11, W3a and W10x: 1024 × 1024 unless said, seeds fixed.
//!
//! Where the names leave something open, it is decided here, once, for all engines: shapes lie wholly on the canvas
//! unless they are circles, colours are random, and nothing is drawn outside the lists below.

use std::f32::consts::{PI, TAU};

use crate::random::Random;
use crate::scene::{Gradient, IDENTITY, Image, Join, Paint, Point, Rule, Scene, Segment, Shape, Spread, Stroke, Style};

const SIDE: f32 = 1024.0;

/// The workloads' names, in the order in which they run.
pub const NAMES: [&str; 13] = ["W1", "W2", "W3", "W3a", "W4", "W5", "W6", "W7", "W8", "W9", "W10", "W10x", "W11"];

/// A workload by its name.
pub fn workload(name: &str) -> Option<Scene> {
    Some(match name {
        "W1" => rectangles(),
        "W2" => small_polygons(),
        "W3" => large_polygons(name, 255),
        "W3a" => large_polygons(name, 128),
        "W4" => circles(),
        "W5" => line_segments(),
        "W6" => cubics(),
        "W7" => polyline(200_000),
        "W8" => rounded_rectangles(),
        "W9" => images(),
        "W10" => coastline(8_000, 4096),
        "W10x" => random_polygon(8_000, 4096),
        "W11" => glyphs(),
        _ => return None,
    })
}

/// 10,000 opaque rectangles, sides of 8–64 px, corners anywhere between pixels.
fn rectangles() -> Scene {
    let mut scene = Scene::new("W1", "10,000 rects 8-64 px, not aligned, opaque", 1024);
    let mut random = Random::new(1);
    for _ in 0..10_000 {
        let (width, height) = (random.within(8.0, 64.0), random.within(8.0, 64.0));
        let (x, y) = (random.within(0.0, SIDE - width), random.within(0.0, SIDE - height));
        scene.fill(Shape::Rect([x, y, x + width, y + height]), Rule::NonZero, random.color(255));
    }
    scene
}

/// 1,000 polygons of 20 random corners in a square of 200 px, even-odd, half transparent.
fn small_polygons() -> Scene {
    let mut scene = Scene::new("W2", "1,000 polygons, 20 vertices in 200 px, even-odd, alpha .5", 1024);
    let mut random = Random::new(2);
    for _ in 0..1_000 {
        let at = [random.within(0.0, SIDE - 200.0), random.within(0.0, SIDE - 200.0)];
        let corners = scattered(&mut random, 20, at, 200.0);
        scene.fill(polygon(&corners), Rule::EvenOdd, random.color(128));
    }
    scene
}

/// 200 polygons of 50 random corners anywhere on the canvas, nonzero.
fn large_polygons(name: &str, alpha: u8) -> Scene {
    let kind = if alpha == 255 { "opaque" } else { "alpha .5" };
    let mut scene = Scene::new(name, &format!("200 polygons, 50 vertices over the canvas, nonzero, {kind}"), 1024);
    // W3 and W3a: the same polygons in the same colours.
    let mut random = Random::new(3);
    for _ in 0..200 {
        let corners = scattered(&mut random, 50, [0.0, 0.0], SIDE);
        scene.fill(polygon(&corners), Rule::NonZero, random.color(alpha));
    }
    scene
}

/// 5,000 opaque circles (four cubics each) of radius 2–40, centres anywhere on the canvas.
fn circles() -> Scene {
    let mut scene = Scene::new("W4", "5,000 circles, radius 2-40, opaque", 1024);
    let mut random = Random::new(4);
    for _ in 0..5_000 {
        let center = [random.within(0.0, SIDE), random.within(0.0, SIDE)];
        scene.fill(circle(center, random.within(2.0, 40.0)), Rule::NonZero, random.color(255));
    }
    scene
}

/// 10,000 opaque strokes of one line each, 4–100 px long in any direction, butt caps, width 1.5.
fn line_segments() -> Scene {
    let mut scene = Scene::new("W5", "10,000 line segments, width 1.5", 1024);
    let mut random = Random::new(5);
    for _ in 0..10_000 {
        let (length, angle) = (random.within(4.0, 100.0), random.within(0.0, TAU));
        let [dx, dy] = around([0.0, 0.0], [length, length], angle);
        let inside = |random: &mut Random, d: f32| random.within(0.0 - d.min(0.0), SIDE - d.max(0.0));
        let (x, y) = (inside(&mut random, dx), inside(&mut random, dy));
        let line = vec![Segment::Move([x, y]), Segment::Line([x + dx, y + dy])];
        scene.stroke(Shape::Path(line), Stroke::new(1.5), random.color(255));
    }
    scene
}

/// 1,000 opaque strokes of one cubic each, its four points random in a square of 300 px, butt caps, round joins.
fn cubics() -> Scene {
    let mut scene = Scene::new("W6", "1,000 cubics, width 3, round joins", 1024);
    let mut random = Random::new(6);
    let stroke = Stroke { join: Join::Round, ..Stroke::new(3.0) };
    for _ in 0..1_000 {
        let at = [random.within(0.0, SIDE - 300.0), random.within(0.0, SIDE - 300.0)];
        let p = scattered(&mut random, 4, at, 300.0);
        let curve = vec![Segment::Move(p[0]), Segment::Cubic(p[1], p[2], p[3])];
        scene.stroke(Shape::Path(curve), stroke.clone(), random.color(255));
    }
    scene
}

/// One opaque polyline, width 1, mitred: a walk in steps of 1–12 px that turns by up to a right angle at each
/// vertex and is thrown back by the canvas's sides.
pub fn polyline(vertices: usize) -> Scene {
    let mut scene = Scene::new("W7", "one polyline, 200,000 vertices, width 1", 1024);
    let mut random = Random::new(7);
    let (mut x, mut y, mut angle) = (SIDE / 2.0, SIDE / 2.0, 0.0_f32);
    let mut path = vec![Segment::Move([x, y])];
    for _ in 1..vertices {
        angle = (angle + random.within(-PI / 2.0, PI / 2.0)).rem_euclid(TAU);
        let step = random.within(1.0, 12.0);
        let [dx, dy] = around([0.0, 0.0], [step, step], angle);
        if !(0.0..SIDE).contains(&(x + dx)) {
            angle = PI - angle;
        }
        if !(0.0..SIDE).contains(&(y + dy)) {
            angle = -angle;
        }
        [x, y] = around([x, y], [step, step], angle);
        path.push(Segment::Line([x, y]));
    }
    scene.stroke(Shape::Path(path), Stroke::new(1.0), [20, 60, 140, 255]);
    scene
}

/// 2,000 rounded rectangles, sides of 20–120 px, corners of radius 4–12 (cubics), each with a gradient of its own: three
/// random opaque colours along its diagonal.
fn rounded_rectangles() -> Scene {
    let mut scene = Scene::new("W8", "2,000 rounded rects, linear gradient", 1024);
    let mut random = Random::new(8);
    for _ in 0..2_000 {
        let (width, height) = (random.within(20.0, 120.0), random.within(20.0, 120.0));
        let (x, y) = (random.within(0.0, SIDE - width), random.within(0.0, SIDE - height));
        let rect = [x, y, x + width, y + height];
        let shape = rounded_rectangle(rect, random.within(4.0, 12.0));
        let stops = [0.0, 0.5, 1.0].map(|position| (position, random.color(255))).to_vec();
        let gradient = Gradient { stops, spread: Spread::Pad, opacity: 1.0, transform: IDENTITY };
        let paint = Paint::Linear { start: [x, y], end: [x + width, y + height], gradient };
        scene.push(shape, Style::Fill(Rule::NonZero), paint);
    }
    scene
}

/// 500 images of 64 × 64 px drawn as 100 × 100 between pixels: every second one is an opaque photograph-like picture,
/// the others have a soft round edge.
fn images() -> Scene {
    let mut scene = Scene::new("W9", "500 images 64->100 px, bilinear", 1024);
    let mut random = Random::new(9);
    scene.images = (0..8).map(|index| picture(&mut random, 64, index % 2 == 0)).collect();
    for index in 0..500 {
        let (x, y) = (random.within(0.0, SIDE - 100.0), random.within(0.0, SIDE - 100.0));
        let scale = 100.0 / 64.0;
        let transform = [scale, 0.0, 0.0, scale, x, y];
        let paint = Paint::Image { index: index % 8, smooth: true, opacity: 1.0, transform };
        scene.push(Shape::Rect([x, y, x + 100.0, y + 100.0]), Style::Fill(Rule::NonZero), paint);
    }
    scene
}

/// One opaque coastline: a ring whose sides are broken at displaced midpoints until there are enough vertices.
pub fn coastline(vertices: usize, side: u32) -> Scene {
    let mut scene = Scene::new("W10", "one 8,000-vertex coastline at 4096 x 4096", side);
    let mut random = Random::new(10);
    let (middle, radius) = (side as f32 / 2.0, side as f32 * 0.36);
    let mut ring: Vec<Point> = (0..8)
        .map(|corner| {
            let r = radius * random.within(0.7, 1.1);
            around([middle, middle], [r, r], corner as f32 / 8.0 * TAU)
        })
        .collect();
    while ring.len() < vertices {
        // The last round breaks only as many sides as are wanted.
        let wanted = vertices - ring.len();
        let mut finer = Vec::with_capacity(ring.len() * 2);
        for (index, a) in ring.iter().enumerate() {
            let b = ring[(index + 1) % ring.len()];
            finer.push(*a);
            if index < wanted {
                let bend = random.within(-0.2, 0.2);
                let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
                finer.push([(a[0] + b[0]) / 2.0 - dy * bend, (a[1] + b[1]) / 2.0 + dx * bend]);
            }
        }
        ring = finer;
    }
    scene.fill(polygon(&ring), Rule::NonZero, [70, 120, 60, 255]);
    scene
}

/// One opaque polygon of random corners anywhere on the canvas, nonzero as in W3.
pub fn random_polygon(vertices: usize, side: u32) -> Scene {
    let mut scene = Scene::new("W10x", "one random 8,000-vertex polygon at 4096 x 4096", side);
    let mut random = Random::new(11);
    let corners = scattered(&mut random, vertices, [0.0, 0.0], side as f32);
    scene.fill(polygon(&corners), Rule::NonZero, [150, 60, 60, 255]);
    scene
}

/// 20,000 glyph-like paths, an em of 10–14 px, in lines of text from the top left; a full page is written over. Each has an outer
/// contour of twelve quadratic curves and a counter of eight that runs the other way, and is a path of its own.
fn glyphs() -> Scene {
    let mut scene = Scene::new("W11", "20,000 glyph-like paths, 10-14 px, 20 curves", 1024);
    let mut random = Random::new(12);
    let (mut x, mut y) = (2.0, 2.0);
    for _ in 0..20_000 {
        let size = random.within(10.0, 14.0);
        let (width, height) = (size * random.within(0.45, 0.8), size);
        if x + width > SIDE - 2.0 {
            (x, y) = (2.0, y + 15.0);
        }
        if y + 14.0 > SIDE - 2.0 {
            y = 2.0 + random.within(0.0, 8.0);
        }
        let center = [x + width / 2.0, y + height / 2.0];
        let mut path = Vec::new();
        blob(&mut random, &mut path, 12, center, [width / 2.0, height / 2.0]);
        blob(&mut random, &mut path, -8, center, [width / 5.0, height / 4.5]);
        let [r, g, b, _] = random.color(255);
        scene.fill(Shape::Path(path), Rule::NonZero, [r / 3, g / 3, b / 3, 255]);
        x += width + 1.0;
    }
    scene
}

/// A closed contour of `curves` quadratic curves (run backwards if negative) around a centre, its points between
/// 0.7 and 1 of the radii away: bumps and hollows like those of letters.
pub fn blob(random: &mut Random, path: &mut Vec<Segment>, curves: i32, center: Point, radii: [f32; 2]) {
    let count = curves.unsigned_abs();
    let mut at = |step: u32| {
        let angle = step as f32 / (2 * count) as f32 * TAU * curves.signum() as f32;
        let r = random.within(0.7, 1.0);
        around(center, [radii[0] * r, radii[1] * r], angle)
    };
    let start = at(0);
    path.push(Segment::Move(start));
    for curve in 0..count {
        let control = at(2 * curve + 1);
        let end = if curve + 1 == count { start } else { at(2 * curve + 2) };
        path.push(Segment::Quad(control, end));
    }
    path.push(Segment::Close);
}

/// The point of an ellipse's outline at an angle. Sines come from `libm`, so that every machine draws the same.
fn around(center: Point, radii: [f32; 2], angle: f32) -> Point {
    let (sin, cos) = libm::sincosf(angle);
    [center[0] + radii[0] * cos, center[1] + radii[1] * sin]
}

/// `count` points in a square.
fn scattered(random: &mut Random, count: usize, at: Point, side: f32) -> Vec<Point> {
    (0..count).map(|_| [at[0] + random.within(0.0, side), at[1] + random.within(0.0, side)]).collect()
}

pub fn polygon(corners: &[Point]) -> Shape {
    let mut path: Vec<Segment> = corners.iter().map(|p| Segment::Line(*p)).collect();
    if let Some(first) = path.first_mut() {
        *first = Segment::Move(corners[0]);
    }
    path.push(Segment::Close);
    Shape::Path(path)
}

/// Four cubics, at most 0.03 % of the radius off.
pub fn circle([x, y]: Point, radius: f32) -> Shape {
    rounded_rectangle([x - radius, y - radius, x + radius, y + radius], radius)
}

pub fn rounded_rectangle([l, t, r, b]: [f32; 4], radius: f32) -> Shape {
    use Segment::{Close, Cubic, Line, Move};
    // How far the control points lie from the corner.
    let k = radius * (1.0 - 0.552_284_8);
    let straight = radius * 2.0 < r - l || radius * 2.0 < b - t;
    let mut path = vec![Move([l + radius, t])];
    let mut corner = |from: Point, c1: Point, c2: Point, to: Point| {
        if straight {
            path.push(Line(from));
        }
        path.push(Cubic(c1, c2, to));
    };
    corner([r - radius, t], [r - k, t], [r, t + k], [r, t + radius]);
    corner([r, b - radius], [r, b - k], [r - k, b], [r - radius, b]);
    corner([l + radius, b], [l + k, b], [l, b - k], [l, b - radius]);
    corner([l, t + radius], [l, t + k], [l + k, t], [l + radius, t]);
    path.push(Close);
    Shape::Path(path)
}

/// A picture of soft random waves, opaque or with a soft round edge.
fn picture(random: &mut Random, side: u32, opaque: bool) -> Image {
    let mut wave = || [random.within(0.02, 0.25), random.within(0.02, 0.25), random.within(0.0, TAU)];
    let waves = [wave(), wave(), wave()];
    let mut rgba = Vec::with_capacity((side * side * 4) as usize);
    for y in 0..side {
        for x in 0..side {
            let (x, y) = (x as f32 + 0.5, y as f32 + 0.5);
            let middle = side as f32 / 2.0;
            let distance = ((x - middle) * (x - middle) + (y - middle) * (y - middle)).sqrt();
            let alpha = if opaque { 1.0 } else { ((middle - distance) / 8.0).clamp(0.0, 1.0) };
            for [fx, fy, phase] in waves {
                let value = (libm::sinf(x * fx + y * fy + phase) * 0.5 + 0.5) * alpha;
                rgba.push((value * 255.0 + 0.5) as u8);
            }
            rgba.push((alpha * 255.0 + 0.5) as u8);
        }
    }
    Image { width: side, height: side, rgba }
}

/// Scenes whose cost should grow with one number; see `scaling.rs`.
pub mod growing {
    use super::{Random, Rule, Scene, circle, coastline, rounded_rectangle};

    /// So many half transparent circles of radius 4 on 1024 × 1024.
    pub fn shapes(count: usize) -> Scene {
        let mut scene = Scene::new("shapes", "circles of radius 4", 1024);
        let mut random = Random::new(21);
        for _ in 0..count {
            let center = [random.within(4.0, 1020.0), random.within(4.0, 1020.0)];
            scene.fill(circle(center, 4.0), Rule::NonZero, random.color(128));
        }
        scene
    }

    /// One path of so many vertices on 1024 × 1024.
    pub fn vertices(count: usize) -> Scene {
        Scene { name: "vertices".to_owned(), title: "vertices of one coastline".to_owned(), ..coastline(count, 1024) }
    }

    /// A hundred half transparent circles that grow with the canvas.
    pub fn canvas(side: usize) -> Scene {
        let mut scene = Scene::new("canvas", "pixels of the canvas under 100 circles", side as u32);
        let mut random = Random::new(22);
        let scale = side as f32 / 1024.0;
        for _ in 0..100 {
            let center = [random.within(0.0, 1024.0) * scale, random.within(0.0, 1024.0) * scale];
            scene.fill(circle(center, random.within(16.0, 128.0) * scale), Rule::NonZero, random.color(128));
        }
        scene
    }

    /// So many half transparent layers, each over nearly the whole of 1024 × 1024.
    pub fn overdraw(count: usize) -> Scene {
        let mut scene = Scene::new("overdraw", "layers over the canvas", 1024);
        let mut random = Random::new(23);
        for _ in 0..count {
            let inset = random.within(0.5, 8.0);
            let shape = rounded_rectangle([inset, inset, 1024.0 - inset, 1024.0 - inset], 40.0);
            scene.fill(shape, Rule::NonZero, random.color(128));
        }
        scene
    }
}
