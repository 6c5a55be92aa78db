//! Hostile input: what the documentation says comes of it, or nothing, and never a panic or a wait.

mod layers;
mod numbers;
mod outlines;
mod paints;
mod pixels;
mod random;

use std::sync::Arc;
use std::time::{Duration, Instant};

use rastrum::{Antialias, Canvas, Color, FillRule, ImagePaint, Paint, Path, Pixmap, Point, Rect, Stroke};

const MODES: [Antialias; 4] = [Antialias::Analytic, Antialias::Exact, Antialias::Supersample(4), Antialias::None];
const NOT_FINITE: [f32; 3] = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY];
const HUGE: [f32; 4] = [1e30, -1e30, f32::MAX, f32::MIN];

/// Only what hangs is caught: the machine may be busy.
const HANG: Duration = Duration::from_secs(60);

/// What a draw by black paint leaves on 64 × 48 transparent pixels.
fn drawn(antialias: Antialias, draw: impl FnOnce(&mut Canvas<'_>, &Paint)) -> Vec<u8> {
    let mut canvas = Canvas::new(64, 48).unwrap();
    let start = Instant::now();
    draw(&mut canvas, &Paint::new(Color::BLACK).with_antialias(antialias));
    let pixels = canvas.into_pixmap().into_vec();
    assert!(start.elapsed() < HANG, "{:?}", start.elapsed());
    pixels
}

/// The draw may leave anything.
fn survives(draw: impl Fn(&mut Canvas<'_>, &Paint)) {
    for antialias in MODES {
        drawn(antialias, &draw);
    }
}

/// The draw leaves nothing, in every mode.
#[track_caller]
fn draws_nothing(name: &str, draw: impl Fn(&mut Canvas<'_>, &Paint)) {
    for antialias in MODES {
        assert!(drawn(antialias, &draw).iter().all(|v| *v == 0), "{name}, {antialias:?}: something is drawn");
    }
}

/// The draw covers every pixel, in every mode.
#[track_caller]
fn draws_everywhere(name: &str, draw: impl Fn(&mut Canvas<'_>, &Paint)) {
    for antialias in MODES {
        let pixels = drawn(antialias, &draw);
        assert!(pixels.as_chunks::<4>().0.iter().all(|p| *p == [0, 0, 0, 255]), "{name}, {antialias:?}: not all");
    }
}

/// The draw leaves what the other does, to within `tolerance` / 255.
#[track_caller]
fn draws_like(
    name: &str,
    tolerance: u8,
    draw: impl Fn(&mut Canvas<'_>, &Paint),
    other: impl Fn(&mut Canvas<'_>, &Paint),
) {
    for antialias in MODES {
        let (found, expected) = (drawn(antialias, &draw), drawn(antialias, &other));
        assert!(expected.iter().any(|v| *v != 0), "{name}: the other draws nothing");
        for (index, (found, expected)) in found.iter().zip(&expected).enumerate() {
            let (x, y) = (index / 4 % 64, index / 4 / 64);
            assert!(
                found.abs_diff(*expected) <= tolerance,
                "{name}, {antialias:?}: {found}, not {expected} at {x}, {y}"
            );
        }
    }
}

fn image() -> Arc<Pixmap> {
    let mut pixmap = Pixmap::new(4, 4).unwrap();
    pixmap.fill(Color::RED);
    Arc::new(pixmap)
}

/// Every call that draws with user coordinates, each with its numbers taken from `v`; those that take a path draw
/// each kind of segment. All of them draw something if every number is sane.
const CALLS: [(&str, fn(&mut Canvas<'_>, &Paint, &Stroke, [f32; 8])); 24] = [
    ("fill_rect", |c, p, _, v| c.fill_rect(Rect::from_ltrb(v[0], v[1], v[2], v[3]), p)),
    ("stroke_rect", |c, p, s, v| c.stroke_rect(Rect::from_ltrb(v[0], v[1], v[2], v[3]), s, p)),
    ("fill_round_rect", |c, p, _, v| c.fill_round_rect(Rect::from_ltrb(v[0], v[1], v[2], v[3]), 3.0, p)),
    ("stroke_round_rect", |c, p, s, v| c.stroke_round_rect(Rect::from_ltrb(v[0], v[1], v[2], v[3]), 3.0, s, p)),
    ("fill_circle", |c, p, _, v| c.fill_circle((v[0], v[1]), v[2], p)),
    ("stroke_circle", |c, p, s, v| c.stroke_circle((v[0], v[1]), v[2], s, p)),
    ("fill_ellipse", |c, p, _, v| c.fill_ellipse((v[0], v[1]), v[2], v[3], p)),
    ("stroke_ellipse", |c, p, s, v| c.stroke_ellipse((v[0], v[1]), v[2], v[3], s, p)),
    ("draw_line", |c, p, s, v| c.draw_line((v[0], v[1]), (v[2], v[3]), s, p)),
    ("draw_polyline", |c, p, s, v| c.draw_polyline(&points(v), s, p)),
    ("fill_polygon", |c, p, _, v| c.fill_polygon(&points(v), FillRule::NonZero, p)),
    ("fill_polygon, even-odd", |c, p, _, v| c.fill_polygon(&points(v), FillRule::EvenOdd, p)),
    ("stroke_polygon", |c, p, s, v| c.stroke_polygon(&points(v), s, p)),
    ("fill quad", |c, p, _, v| c.fill_path(&quad(v), FillRule::NonZero, p)),
    ("stroke quad", |c, p, s, v| c.stroke_path(&quad(v), s, p)),
    ("fill cubic", |c, p, _, v| c.fill_path(&cubic(v), FillRule::NonZero, p)),
    ("stroke cubic", |c, p, s, v| c.stroke_path(&cubic(v), s, p)),
    ("fill arc", |c, p, _, v| c.fill_path(&arcs(v), FillRule::EvenOdd, p)),
    ("stroke arc", |c, p, s, v| c.stroke_path(&arcs(v), s, p)),
    ("fill_pixel_polygon", |c, p, _, v| c.fill_pixel_polygon(&points(v), FillRule::NonZero, p)),
    ("draw_image", |c, p, _, v| {
        let (source, target) = (Rect::from_ltrb(0.0, 0.0, 4.0, 4.0), Rect::from_ltrb(v[0], v[1], v[2], v[3]));
        c.draw_image(&image(), source, target, &ImagePaint { antialias: p.antialias, ..ImagePaint::default() });
    }),
    ("draw_image's source", |c, p, _, v| {
        let source = Rect::from_ltrb(v[0] / 16.0, v[1] / 16.0, v[2] / 16.0, v[3] / 16.0);
        let paint = ImagePaint { antialias: p.antialias, ..ImagePaint::default() };
        c.draw_image(&image(), source, Rect::from_ltrb(4.0, 4.0, 40.0, 40.0), &paint);
    }),
    ("draw_image_at", |c, p, _, v| {
        c.draw_image_at(&image(), (v[0], v[1]), &ImagePaint { antialias: p.antialias, ..ImagePaint::default() });
    }),
    ("clip_rect", |c, p, _, v| {
        c.clip_rect(Rect::from_ltrb(v[0], v[1], v[2], v[3]), p.antialias);
        c.fill(p);
    }),
];

/// Sane numbers for [`CALLS`], and how many of them each reads.
const SANE: [f32; 8] = [12.5, 9.25, 40.0, 30.5, 50.0, 8.0, 20.0, 44.0];

fn numbers_read(name: &str) -> usize {
    match name {
        "fill_circle" | "stroke_circle" => 3,
        "draw_image_at" => 2,
        "fill quad" | "stroke quad" => 6,
        _ if ["poly", "cubic", "arc"].iter().any(|part| name.contains(part)) => 8,
        _ => 4,
    }
}

fn points(v: [f32; 8]) -> Vec<Point> {
    v.as_chunks::<2>().0.iter().map(|[x, y]| Point::new(*x, *y)).collect()
}

fn quad(v: [f32; 8]) -> Path {
    let mut path = Path::new();
    path.move_to((v[0], v[1])).quad_to((v[2], v[3]), (v[4], v[5]));
    path
}

fn cubic(v: [f32; 8]) -> Path {
    let mut path = Path::new();
    path.move_to((v[0], v[1])).cubic_to((v[2], v[3]), (v[4], v[5]), (v[6], v[7]));
    path
}

fn arcs(v: [f32; 8]) -> Path {
    let mut path = Path::new();
    path.move_to((v[0], v[1])).arc_to((v[2], v[3]), (v[4], v[5]), 7.0).line_to((v[6], v[7]));
    path
}
