//! Hostile input: what the documentation says comes of it, or nothing, and never a panic or a wait.

use std::f32::consts::PI;
use std::sync::Arc;
use std::time::{Duration, Instant};

use rastrum::{
    Antialias, BlendMode, Canvas, Color, Error, FillRule, FilterQuality, GradientStop, ImagePaint, IntRect, LineCap,
    LineJoin, LinearGradient, Mask, MaskKind, Paint, Path, Pattern, Pixmap, Point, RadialGradient, Rect,
    RenderSettings, Shadow, SimdLevel, SpreadMode, Stroke, SweepGradient, Transform,
};

use crate::oracle::Random;

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

#[test]
fn sane_numbers_draw_something() {
    for (name, call) in CALLS {
        for antialias in MODES {
            let pixels = drawn(antialias, |c, p| call(c, p, &Stroke::new(3.0), SANE));
            assert!(pixels.iter().any(|v| *v != 0), "{name}, {antialias:?}");
        }
    }
}

#[test]
fn a_number_that_is_not_finite_draws_nothing() {
    for (name, call) in CALLS {
        for slot in 0..numbers_read(name) {
            // An arc whose end is nowhere is a line to its corner.
            if name.contains("arc") && (slot == 4 || slot == 5) {
                continue;
            }
            for bad in NOT_FINITE {
                let mut v = SANE;
                v[slot] = bad;
                for width in [0.0, 3.0] {
                    let what = format!("{name} with {bad} at {slot}, width {width}");
                    draws_nothing(&what, |c, p| call(c, p, &Stroke::new(width), v));
                }
            }
        }
    }
}

#[test]
fn a_transform_that_is_not_finite_draws_nothing() {
    for (name, call) in CALLS {
        for slot in 0..6 {
            for bad in NOT_FINITE {
                let mut v = [1.0, 0.0, 0.0, 1.0, 0.0, 0.0];
                v[slot] = bad;
                let transform = Transform::from_row(v[0], v[1], v[2], v[3], v[4], v[5]);
                if name == "fill_pixel_polygon" {
                    continue;
                }
                draws_nothing(&format!("{name} by {transform:?}"), |c, p| {
                    c.set_transform(transform);
                    call(c, p, &Stroke::new(3.0), SANE);
                });
            }
        }
    }
    // The calls that are not about user space do not mind.
    let bad = Transform::from_row(f32::NAN, 0.0, 0.0, f32::INFINITY, 0.0, 0.0);
    draws_everywhere("fill", |c, p| {
        c.set_transform(bad);
        c.fill(p);
    });
    draws_like(
        "pixels",
        0,
        |c, p| {
            c.set_transform(bad);
            c.draw_pixel_line((3, 4), (50, 30), p);
        },
        |c, p| c.draw_pixel_line((3, 4), (50, 30), p),
    );
}

#[test]
fn huge_numbers_draw_within_a_moment() {
    for (name, call) in CALLS {
        for slot in 0..numbers_read(name) {
            for huge in HUGE {
                let mut v = SANE;
                v[slot] = huge;
                let _ = name;
                for width in [0.0, 3.0] {
                    survives(|c, p| call(c, p, &Stroke::new(width), v));
                }
                survives(|c, p| {
                    c.scale(huge, 1.0);
                    call(c, p, &Stroke::new(3.0), v);
                });
            }
        }
        for scale in [1e30, -1e30, f32::MAX, 1e15, 1e-30, f32::MIN_POSITIVE] {
            survives(|c, p| {
                c.scale(scale, scale);
                call(c, p, &Stroke::new(3.0), SANE);
            });
            survives(|c, p| {
                c.transform(Transform::from_row(scale, 1.0, scale, -1.0, -scale, scale));
                call(c, p, &Stroke::new(0.0), SANE);
            });
        }
    }
}

#[test]
fn what_reaches_beyond_all_sides_covers_everything() {
    for far in [1e5, 1e7, 1e10, 1e30, 1e38] {
        let rect = Rect::from_ltrb(-far, -far, far, far);
        draws_everywhere(&format!("rect {far}"), |c, p| c.fill_rect(rect, p));
        draws_everywhere(&format!("clip {far}"), |c, p| {
            c.clip_rect(rect, p.antialias);
            c.fill(p);
        });
        draws_everywhere(&format!("scale {far}"), |c, p| {
            c.scale(far, far);
            c.fill_rect(Rect::from_ltrb(-1.0, -1.0, 1.0, 1.0), p);
        });
        draws_everywhere(&format!("turned clip path {far}"), |c, p| {
            c.rotate(30.0);
            let mut path = Path::new();
            path.rect(Rect::from_ltrb(-far / 4.0, -far / 4.0, far / 4.0, far / 4.0));
            c.clip_path(&path, FillRule::EvenOdd, p.antialias);
            c.fill(p);
        });
        draws_everywhere(&format!("circle {far}"), |c, p| c.fill_circle((0.0, 0.0), far / 2.0, p));
    }
    // All edges but one are far away: at 1e30 the left one is where it always was.
    for far in [1e5, 1e30, 1e38] {
        draws_like(
            &format!("half {far}"),
            0,
            |c, p| c.fill_rect(Rect::from_ltrb(20.25, -far, far, far), p),
            |c, p| c.fill_rect(Rect::from_ltrb(20.25, 0.0, 64.0, 48.0), p),
        );
    }
    for far in [1e5, 1e10, 1e30] {
        draws_like(
            &format!("level line {far}"),
            1,
            |c, p| c.draw_line((-far, 24.25), (far, 24.25), &Stroke::new(7.0), p),
            |c, p| c.draw_line((-100.0, 24.25), (200.0, 24.25), &Stroke::new(7.0), p),
        );
    }
    for far in [1e5, 1e9, 1e30, 1e36] {
        draws_like(
            &format!("diagonal line {far}"),
            1,
            |c, p| c.draw_line((-far, -far), (far, far), &Stroke::new(7.0), p),
            |c, p| c.draw_line((-100.0, -100.0), (200.0, 200.0), &Stroke::new(7.0), p),
        );
        // A chart with an outlier: up and down again beside each other, and the corners in view as they are. One sample of
        // sixteen may change sides.
        let chart = |high: f32| [(4.0, 40.0), (15.8, 24.0), (28.0, -high), (40.1, 24.0), (60.0, 30.0)].map(Point::from);
        for closed in [false, true] {
            let draw = move |c: &mut Canvas<'_>, p: &Paint, high: f32| {
                let stroke = Stroke::new(5.0).with_join(LineJoin::Round).with_cap(LineCap::Square);
                if closed {
                    c.stroke_polygon(&chart(high), &stroke, p);
                } else {
                    c.draw_polyline(&chart(high), &stroke, p);
                }
            };
            draws_like(&format!("outlier {far}"), 17, |c, p| draw(c, p, far), |c, p| draw(c, p, 6e4));
        }
    }
    // Beyond the numbers themselves: the corners are not finite.
    draws_nothing("scaled off", |c, p| {
        c.scale(1e30, 1e30);
        c.fill_rect(Rect::from_ltrb(-1e30, -1e30, 1e30, 1e30), p);
    });
}

#[test]
fn rectangles_without_area_fill_nothing_and_swapped_edges_do_not_matter() {
    for (left, top, right, bottom) in
        [(10.0, 10.0, 10.0, 30.0), (10.0, 10.0, 40.0, 10.0), (10.5, 10.5, 10.5, 10.5), (0.0, 0.0, -0.0, 40.0)]
    {
        let rect = Rect::from_ltrb(left, top, right, bottom);
        draws_nothing("fill", |c, p| c.fill_rect(rect, p));
        draws_nothing("round", |c, p| c.fill_round_rect(rect, 4.0, p));
        draws_nothing("clip", |c, p| {
            c.clip_rect(rect, p.antialias);
            c.fill(p);
        });
        draws_nothing("clip path", |c, p| {
            c.rotate(10.0);
            c.clip_rect(rect, p.antialias);
            c.fill(p);
        });
        draws_nothing("image", |c, _| {
            c.draw_image(&image(), Rect::from_ltrb(0.0, 0.0, 4.0, 4.0), rect, &ImagePaint::default());
        });
        for join in [LineJoin::Miter, LineJoin::Round, LineJoin::Bevel, LineJoin::MiterClip] {
            survives(|c, p| c.stroke_rect(rect, &Stroke::new(4.0).with_join(join), p));
        }
    }
    let sane = Rect::from_ltrb(10.25, 12.5, 40.75, 30.0);
    let swapped = Rect::from_ltrb(40.75, 30.0, 10.25, 12.5);
    draws_like("fill", 0, |c, p| c.fill_rect(swapped, p), |c, p| c.fill_rect(sane, p));
    draws_like("round", 1, |c, p| c.fill_round_rect(swapped, 6.0, p), |c, p| c.fill_round_rect(sane, 6.0, p));
    let stroke = Stroke::new(3.0);
    draws_like("stroke", 0, |c, p| c.stroke_rect(swapped, &stroke, p), |c, p| c.stroke_rect(sane, &stroke, p));
    let clipped = |rect: Rect| {
        move |c: &mut Canvas<'_>, p: &Paint| {
            c.clip_rect(rect, p.antialias);
            c.fill(p);
        }
    };
    draws_like("clip", 0, clipped(swapped), clipped(sane));
    let cleared = |rect: Rect| {
        move |c: &mut Canvas<'_>, p: &Paint| {
            c.fill(p);
            c.clear_rect(rect);
        }
    };
    draws_like("clear", 0, cleared(swapped), cleared(sane));
    for radius in [-3.0, f32::NAN] {
        draws_like("radius", 0, |c, p| c.fill_round_rect(sane, radius, p), |c, p| c.fill_round_rect(sane, 0.0, p));
    }
    for radius in [1e30, f32::INFINITY] {
        survives(|c, p| c.fill_round_rect(sane, radius, p));
    }
    for radius in [-1.0, f32::NAN, f32::INFINITY] {
        draws_nothing("circle", |c, p| c.fill_circle((20.0, 20.0), radius, p));
        draws_nothing("ring", |c, p| c.stroke_circle((20.0, 20.0), radius, &Stroke::new(2.0), p));
    }
}

#[test]
fn degenerate_curves() {
    let at = (20.5, 20.5);
    let curves = {
        let (mut quad, mut cubic, mut line) = (Path::new(), Path::new(), Path::new());
        quad.move_to(at).quad_to(at, at);
        cubic.move_to(at).cubic_to(at, at, at);
        line.move_to(at).line_to(at);
        [quad, cubic, line]
    };
    for path in &curves {
        draws_nothing("fill of a point", |c, p| c.fill_path(path, FillRule::NonZero, p));
        draws_nothing("butt caps at a point", |c, p| c.stroke_path(path, &Stroke::new(8.0), p));
        draws_like(
            "round caps at a point",
            16,
            // A radius at which no pixel's centre lies on the circle.
            |c, p| c.stroke_path(path, &Stroke::new(8.2).with_cap(LineCap::Round), p),
            |c, p| c.fill_circle(at, 4.1, p),
        );
        draws_like(
            "square caps at a point",
            0,
            |c, p| c.stroke_path(path, &Stroke::new(8.0).with_cap(LineCap::Square), p),
            |c, p| c.fill_rect(Rect::from_ltrb(16.5, 16.5, 24.5, 24.5), p),
        );
    }
    // A curve along a line, there and back, is the line.
    let (mut quad, mut cubic) = (Path::new(), Path::new());
    quad.move_to((10.0, 20.5)).quad_to((25.0, 20.5), (40.0, 20.5));
    cubic.move_to((10.0, 20.5)).cubic_to((15.0, 20.5), (30.0, 20.5), (40.0, 20.5));
    for path in [&quad, &cubic] {
        draws_nothing("fill of a line", |c, p| c.fill_path(path, FillRule::NonZero, p));
        draws_like(
            "stroke of a line",
            1,
            |c, p| c.stroke_path(path, &Stroke::new(5.0), p),
            |c, p| c.draw_line((10.0, 20.5), (40.0, 20.5), &Stroke::new(5.0), p),
        );
    }
    // Cusps and a curve that turns back on itself; the pen is wider than the curve is bent.
    for v in [
        [10.0, 40.0, 54.0, 8.0, 10.0, 8.0, 54.0, 40.0],
        [10.0, 10.0, 60.0, 10.0, 0.0, 10.0, 50.0, 10.0],
        [20.0, 20.0, 20.0, 20.0, 40.0, 20.0, 20.0, 20.0],
        [20.0, 20.0, 50.0, 20.000_001, 20.0, 20.0, 50.0, 20.0],
    ] {
        for join in [LineJoin::Miter, LineJoin::Round, LineJoin::Bevel, LineJoin::MiterClip] {
            for cap in [LineCap::Butt, LineCap::Round, LineCap::Square] {
                let stroke = Stroke::new(12.0).with_join(join).with_cap(cap);
                for antialias in MODES {
                    let pixels = drawn(antialias, |c, p| c.stroke_path(&cubic_of(v), &stroke, p));
                    assert!(pixels.contains(&255), "{v:?} {stroke:?}");
                }
            }
        }
    }
}

fn cubic_of(v: [f32; 8]) -> Path {
    cubic(v)
}

#[test]
fn stroke_widths() {
    let line = |width: f32, cap: LineCap| {
        move |c: &mut Canvas<'_>, p: &Paint| {
            c.draw_line((10.0, 24.25), (54.0, 24.25), &Stroke::new(width).with_cap(cap), p);
        }
    };
    for width in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, -1.0, -1e30, -f32::MIN_POSITIVE] {
        for cap in [LineCap::Butt, LineCap::Round, LineCap::Square] {
            draws_nothing(&format!("width {width}"), line(width, cap));
        }
    }
    for width in [1e-30, f32::MIN_POSITIVE] {
        draws_nothing("invisible", line(width, LineCap::Butt));
        survives(line(width, LineCap::Round));
        survives(line(width, LineCap::Square));
    }
    // 0 and −0 are hairlines, a pixel wide at any scale.
    for width in [0.0, -0.0] {
        for scale in [1.0, 2.0, 0.25] {
            let hairline = move |c: &mut Canvas<'_>, p: &Paint| {
                c.scale(scale, scale);
                let y = 24.5 / scale;
                c.draw_line((10.0 / scale, y), (54.0 / scale, y), &Stroke::new(width), p);
            };
            for antialias in [Antialias::Analytic, Antialias::Exact, Antialias::Supersample(4)] {
                let expected = drawn(antialias, |c, p| c.fill_rect(Rect::from_ltrb(10.0, 24.0, 54.0, 25.0), p));
                assert!(drawn(antialias, hairline) == expected, "{antialias:?}");
            }
            // Both end pixels of a Bresenham line count.
            let expected = drawn(Antialias::None, |c, p| c.fill_rect(Rect::from_ltrb(10.0, 24.0, 55.0, 25.0), p));
            assert!(drawn(Antialias::None, hairline) == expected);
        }
    }
    for width in [1e5, 1e10, 1e30] {
        draws_like(&format!("butt caps, width {width}"), 1, line(width, LineCap::Butt), |c, p| {
            c.fill_rect(Rect::from_ltrb(10.0, 0.0, 54.0, 48.0), p)
        });
        draws_everywhere(&format!("round caps, width {width}"), line(width, LineCap::Round));
        draws_everywhere(&format!("square caps, width {width}"), line(width, LineCap::Square));
        for join in [LineJoin::Miter, LineJoin::Round, LineJoin::Bevel, LineJoin::MiterClip] {
            survives(|c, p| c.stroke_path(&cubic(SANE), &Stroke::new(width).with_join(join), p));
            survives(|c, p| {
                c.transform(Transform::from_row(2.0, 0.0, 1.0, 1e-3, 0.0, 0.0));
                c.stroke_polygon(&points(SANE), &Stroke::new(width).with_join(join), p);
            });
        }
    }
    survives(|c, p| c.stroke_polygon(&points(SANE), &Stroke::new(f32::MAX), p));
}

#[test]
fn dashes() {
    let dashed = |intervals: &[f32], offset: f32, cap: LineCap| {
        let stroke = Stroke::new(5.0).with_cap(cap).with_dash(intervals, offset);
        move |c: &mut Canvas<'_>, p: &Paint| c.draw_line((2.0, 24.5), (62.0, 24.5), &stroke, p)
    };
    let solid = |c: &mut Canvas<'_>, p: &Paint| c.draw_line((2.0, 24.5), (62.0, 24.5), &Stroke::new(5.0), p);
    for intervals in [
        &[][..],
        &[0.0],
        &[0.0, 0.0],
        &[0.0, -0.0, 0.0],
        &[-1.0, 3.0],
        &[4.0, f32::NAN],
        &[f32::INFINITY, 1.0],
        &[4.0, f32::NEG_INFINITY],
        &[f32::MIN_POSITIVE / 4.0, f32::MIN_POSITIVE / 4.0],
        &[1e-9, 1e-9],
        &[2e-5, 2e-5],
        // A gap without length is none; a dash that never ends shows no gap.
        &[3.0, 0.0],
        &[1e30, 4.0],
        &[f32::MAX, f32::MAX],
    ] {
        draws_like(&format!("{intervals:?}"), 0, dashed(intervals, 0.0, LineCap::Butt), solid);
        for offset in [f32::NAN, f32::INFINITY, -1e30, 1e30, f32::MAX, 1e-30] {
            survives(dashed(intervals, offset, LineCap::Round));
        }
    }
    let expected = dashed(&[4.0, 6.0], 0.0, LineCap::Butt);
    draws_like("offset NaN", 0, dashed(&[4.0, 6.0], f32::NAN, LineCap::Butt), &expected);
    draws_like("offset of periods", 0, dashed(&[4.0, 6.0], -1e7, LineCap::Butt), &expected);
    draws_like("zeros between", 0, dashed(&[2.0, 0.0, 2.0, 6.0], 0.0, LineCap::Butt), &expected);
    draws_nothing("dashes without length", dashed(&[0.0, 5.0], 0.0, LineCap::Butt));
    // A radius at which no pixel's centre lies on the circle.
    let dots = Stroke::new(5.2).with_cap(LineCap::Round).with_dash([0.0, 100.0], -30.0);
    draws_like(
        "dots",
        16,
        |c, p| c.draw_line((2.0, 24.5), (62.0, 24.5), &dots, p),
        |c, p| c.fill_circle((32.0, 24.5), 2.6, p),
    );

    // Nearly a million dashes cover half of their line.
    let pixels = drawn(Antialias::Analytic, dashed(&[1e-4, 1e-4], 0.0, LineCap::Butt));
    let alpha = pixels[(24 * 64 + 30) * 4 + 3];
    assert!((120..=136).contains(&alpha), "{alpha}");
    survives(dashed(&[1e-3, 1e-3], 0.0, LineCap::Round));
    // A million lengths, of which 60 are seen.
    let many = vec![1.0; 1_000_000];
    draws_like("many lengths", 0, dashed(&many, 0.0, LineCap::Butt), dashed(&[1.0, 1.0], 0.0, LineCap::Butt));
    draws_like("many zeros", 0, dashed(&vec![0.0; 1_000_000], 0.0, LineCap::Butt), solid);
    // Far longer than what is seen.
    draws_like(
        "long line",
        1,
        |c, p| c.draw_line((-1e7, 24.5), (1e7, 24.5), &Stroke::new(5.0).with_dash([8.0, 8.0], 0.0), p),
        |c, p| c.draw_line((-16.0, 24.5), (80.0, 24.5), &Stroke::new(5.0).with_dash([8.0, 8.0], 0.0), p),
    );
    survives(|c, p| c.draw_line((-1e30, 24.5), (1e30, 20.5), &Stroke::new(5.0).with_dash([8.0, 8.0], 0.0), p));
}

#[test]
fn miter_limits() {
    let corner = |limit: f32, join: LineJoin| {
        move |c: &mut Canvas<'_>, p: &Paint| {
            let stroke = Stroke::new(6.0).with_join(join).with_miter_limit(limit);
            c.draw_polyline(&[Point::new(10.0, 10.0), Point::new(50.0, 24.0), Point::new(10.0, 38.0)], &stroke, p);
        }
    };
    for join in [LineJoin::Miter, LineJoin::MiterClip] {
        for limit in [0.5, 0.0, -4.0, f32::NAN, f32::NEG_INFINITY] {
            draws_like(&format!("{join:?} {limit}"), 0, corner(limit, join), corner(1.0, join));
        }
        for limit in [1e30, f32::INFINITY, f32::MAX] {
            draws_like(&format!("{join:?} {limit}"), 0, corner(limit, join), corner(100.0, join));
        }
    }
}

#[test]
fn singular_transforms() {
    let transforms = [
        Transform::from_scale(0.0, 0.0),
        Transform::from_scale(0.0, 1.0),
        Transform::from_scale(1.0, 0.0),
        Transform::from_row(1.0, 1.0, 1.0, 1.0, 5.0, 5.0),
        Transform::from_row(0.5, -0.25, -1.0, 0.5, 30.0, 20.0),
        Transform::from_scale(1e-30, 1e-30),
    ];
    let stops = [GradientStop::new(0.0, Color::RED), GradientStop::new(1.0, Color::BLUE)];
    for transform in transforms {
        for (name, call) in CALLS {
            // The pixel calls are without the transform; a hairline is a pixel wide at any.
            if name == "fill_pixel_polygon" {
                continue;
            }
            draws_nothing(&format!("{name} by {transform:?}"), |c, p| {
                c.set_transform(transform);
                call(c, p, &Stroke::new(3.0), SANE);
            });
            survives(|c, p| {
                c.set_transform(transform);
                call(c, p, &Stroke::new(0.0), SANE);
                call(c, p, &Stroke::new(3.0).with_dash([2.0, 1.0], 0.5).with_cap(LineCap::Round), SANE);
            });
        }
        if transform.invert().is_some() {
            continue;
        }
        draws_nothing("pattern", |c, _| c.fill(Pattern::new(image()).with_transform(transform)));
        draws_nothing("linear", |c, _| {
            c.fill(LinearGradient::new((0.0, 0.0), (64.0, 0.0), stops).with_transform(transform));
        });
        draws_nothing("radial", |c, _| {
            c.fill(RadialGradient::new((32.0, 24.0), 20.0, stops).with_transform(transform));
        });
        draws_nothing("sweep", |c, _| c.fill(SweepGradient::new((32.0, 24.0), stops).with_transform(transform)));
        draws_nothing("gradient under it", |c, _| {
            c.set_transform(transform);
            c.fill(LinearGradient::new((0.0, 0.0), (64.0, 0.0), stops));
        });
    }
}

#[test]
fn unbalanced_restores_and_layers() {
    let shape = |c: &mut Canvas<'_>, p: &Paint| c.fill_circle((30.0, 20.0), 12.0, p);
    draws_like(
        "restores first",
        0,
        |c, p| {
            for _ in 0..1000 {
                c.restore();
                c.pop_layer();
                c.pop_mask();
            }
            shape(c, p);
        },
        shape,
    );
    draws_like(
        "restores inside a layer stay inside",
        0,
        |c, p| {
            c.save();
            c.translate(5.0, 5.0);
            c.push_layer(1.0, BlendMode::SourceOver);
            c.restore();
            c.restore();
            c.translate(-5.0, -5.0);
            shape(c, p);
            c.pop_mask();
            c.pop_layer();
            c.restore();
        },
        shape,
    );
    draws_like(
        "layers that nobody closes",
        0,
        |c, p| {
            c.push_layer(1.0, BlendMode::SourceOver);
            shape(c, p);
            c.push_layer(0.5, BlendMode::SourceOver);
            c.save();
        },
        shape,
    );
    draws_like(
        "a mask without a layer masks nothing",
        0,
        |c, p| {
            shape(c, p);
            c.push_mask(MaskKind::Alpha);
            c.fill(p);
            c.pop_mask();
        },
        shape,
    );
}

#[test]
fn a_million_saves() {
    let shape = |c: &mut Canvas<'_>, p: &Paint| c.fill_circle((30.0, 20.0), 12.0, p);
    draws_like(
        "alike",
        0,
        |c, p| {
            (0..1_000_000).for_each(|_| c.save());
            shape(c, p);
            (0..1_000_001).for_each(|_| c.restore());
        },
        shape,
    );
    draws_like(
        "each different",
        0,
        |c, p| {
            for _ in 0..1_000_000 {
                c.save();
                c.translate(1.0, 0.0);
            }
            (0..1_000_000).for_each(|_| c.restore());
            shape(c, p);
        },
        shape,
    );
}

#[test]
fn ten_thousand_layers() {
    let shape = |c: &mut Canvas<'_>, p: &Paint| c.fill_circle((30.0, 20.0), 12.0, p);
    draws_like(
        "nested",
        0,
        |c, p| {
            (0..10_000).for_each(|_| c.push_layer(1.0, BlendMode::SourceOver));
            shape(c, p);
            (0..10_000).for_each(|_| c.pop_layer());
        },
        shape,
    );
    draws_like(
        "nested and left open",
        0,
        |c, p| {
            for _ in 0..10_000 {
                c.push_layer(1.0, BlendMode::SourceOver);
                c.save();
            }
            shape(c, p);
        },
        shape,
    );
    draws_like(
        "one after another",
        0,
        |c, p| {
            for _ in 0..10_000 {
                c.push_layer(1.0, BlendMode::SourceOver);
                c.pop_layer();
            }
            shape(c, p);
        },
        shape,
    );
}

#[test]
fn ten_thousand_clips() {
    draws_like(
        "nested",
        0,
        |c, p| {
            for _ in 0..10_000 {
                c.save();
                c.clip_rect(Rect::from_ltrb(10.0, 10.0, 50.0, 40.0), p.antialias);
            }
            c.fill(p);
        },
        |c, p| c.fill_rect(Rect::from_ltrb(10.0, 10.0, 50.0, 40.0), p),
    );
    // The same with coverage: each clip multiplies the one before, so that nothing is left but what is whole.
    let mut path = Path::new();
    path.circle((30.0, 24.0), 15.0);
    survives(|c, p| {
        for _ in 0..1_000 {
            c.clip_path(&path, FillRule::NonZero, p.antialias);
        }
        c.fill(p);
    });
}

#[test]
fn gradients() {
    let red = GradientStop::new(0.5, Color::RED);
    let two = [GradientStop::new(0.0, Color::RED), GradientStop::new(1.0, Color::BLUE)];
    let red_everywhere = |c: &mut Canvas<'_>, _: &Paint| c.fill(Color::RED);
    let blue_everywhere = |c: &mut Canvas<'_>, _: &Paint| c.fill(Color::BLUE);
    draws_nothing("no stop", |c, _| c.fill(LinearGradient::new((0.0, 0.0), (9.0, 0.0), [])));
    draws_nothing("no stop", |c, _| c.fill(RadialGradient::new((9.0, 9.0), 9.0, [])));
    draws_nothing("no stop", |c, _| c.fill(SweepGradient::new((9.0, 9.0), [])));
    draws_like("one stop", 0, |c, _| c.fill(LinearGradient::new((0.0, 0.0), (9.0, 0.0), [red])), red_everywhere);
    draws_like("no length", 0, |c, _| c.fill(LinearGradient::new((9.0, 9.0), (9.0, 9.0), two)), blue_everywhere);
    // Stops in one place are an edge; one below its predecessor is raised to it.
    for stops in [
        [(0.0, Color::RED), (0.5, Color::RED), (0.5, Color::GREEN), (0.5, Color::BLUE)],
        [(0.0, Color::RED), (0.5, Color::RED), (0.2, Color::GREEN), (0.1, Color::BLUE)],
        [(f32::NAN, Color::RED), (0.5, Color::RED), (f32::NEG_INFINITY, Color::GREEN), (-3.0, Color::BLUE)],
    ] {
        let stops = stops.map(|(at, color)| GradientStop::new(at, color));
        draws_like(
            "an edge",
            0,
            |c, _| c.fill(LinearGradient::new((0.0, 0.0), (64.0, 0.0), stops)),
            |c, _| {
                c.fill_rect(Rect::from_ltrb(0.0, 0.0, 32.0, 48.0), Color::RED);
                c.fill_rect(Rect::from_ltrb(32.0, 0.0, 64.0, 48.0), Color::BLUE);
            },
        );
    }
    for bad in NOT_FINITE {
        draws_nothing("linear", |c, _| c.fill(LinearGradient::new((bad, 0.0), (9.0, 0.0), two)));
        draws_nothing("radial", |c, _| c.fill(RadialGradient::new((9.0, bad), 9.0, two)));
        draws_nothing("radial", |c, _| c.fill(RadialGradient::new((9.0, 9.0), bad, two)));
        draws_nothing("sweep", |c, _| c.fill(SweepGradient::new((bad, 9.0), two)));
        draws_nothing("sweep", |c, _| c.fill(SweepGradient::new((9.0, 9.0), two).with_angles(bad, 90.0)));
    }
    for radius in [-1.0, 0.0, -1e30] {
        draws_nothing("radius", |c, _| c.fill(RadialGradient::new((9.0, 9.0), radius, two)));
    }
    draws_nothing("equal circles", |c, _| {
        c.fill(RadialGradient::two_point((9.0, 9.0), 5.0, (9.0, 9.0), 5.0, two));
    });
    draws_nothing("no angle", |c, _| c.fill(SweepGradient::new((9.0, 9.0), two).with_angles(90.0, 90.0)));
    draws_nothing("negative angle", |c, _| c.fill(SweepGradient::new((9.0, 9.0), two).with_angles(90.0, 10.0)));
    let odd = [0.0, 1e-30, 1e-6, 1.0, 20.0, 1e7, 1e30, f32::MAX];
    for spread in [SpreadMode::Pad, SpreadMode::Repeat, SpreadMode::Reflect, SpreadMode::Decal] {
        for a in odd {
            for b in odd {
                survives(|c, _| c.fill(LinearGradient::new((a, -b), (b, a), two).with_spread(spread)));
                // The start on the rim of the end circle, inside and outside of it.
                for x in [a, a - b, a + b] {
                    let radial = RadialGradient::two_point((32.0 + x, 24.0), b, (32.0, 24.0), a, two);
                    survives(|c, _| c.fill(radial.clone().with_spread(spread)));
                }
                let sweep = SweepGradient::new((32.0, 24.0), two).with_angles(a - b, a).with_spread(spread);
                survives(|c, _| c.fill(sweep.clone()));
            }
        }
    }
    let many: Vec<_> = (0..100_000_u32).map(|i| GradientStop::new(i as f32 / 1e5, Color::RED)).collect();
    draws_like(
        "many stops",
        0,
        |c, _| c.fill(LinearGradient::new((0.0, 0.0), (64.0, 48.0), many.clone())),
        red_everywhere,
    );
}

#[test]
fn clips() {
    let circle = |c: &mut Canvas<'_>, p: &Paint| c.fill_circle((30.0, 20.0), 12.0, p);
    for far in [1e5, 1e30, f32::MAX] {
        draws_like(
            &format!("huge {far}"),
            0,
            |c, p| {
                c.clip_rect(Rect::from_ltrb(-far, -far, far, far), p.antialias);
                circle(c, p);
            },
            circle,
        );
    }
    draws_nothing("empty path", |c, p| {
        c.clip_path(&Path::new(), FillRule::NonZero, p.antialias);
        circle(c, p);
    });
    draws_nothing("outside", |c, p| {
        c.clip_rect(Rect::from_ltrb(100.0, 0.0, 200.0, 50.0), p.antialias);
        circle(c, p);
        c.push_layer(1.0, BlendMode::Source);
        circle(c, p);
        c.pop_layer();
        c.clear(Color::RED);
        c.draw_pixel_line((0, 0), (9, 9), p);
    });
    draws_nothing("apart", |c, p| {
        c.clip_rect(Rect::from_ltrb(0.0, 0.0, 20.0, 48.0), p.antialias);
        c.clip_rect(Rect::from_ltrb(20.0, 0.0, 64.0, 48.0), p.antialias);
        c.fill(p);
    });
    let mask = Arc::new(Mask::from_vec(2, 2, vec![255; 4]).unwrap());
    for at in [i32::MIN, -2, 64, i32::MAX - 1, i32::MAX] {
        draws_nothing("mask outside", |c, p| {
            c.clip_mask(Arc::clone(&mask), at, 5);
            c.fill(p);
        });
        draws_nothing("mask outside", |c, p| {
            c.clip_mask(Arc::clone(&mask), 5, at);
            c.fill(p);
        });
    }
}

#[test]
fn sample_counts_outside_their_range() {
    let star = |antialias: Antialias| drawn(antialias, |c, p| c.fill_polygon(&points(SANE), FillRule::EvenOdd, p));
    assert!(star(Antialias::Supersample(0)) == star(Antialias::Supersample(1)));
    assert!(star(Antialias::Supersample(255)) == star(Antialias::Supersample(16)));
    assert!(star(Antialias::Supersample(1)) == star(Antialias::None));
}

#[test]
fn opacities_and_colours_outside_their_range() {
    let circle = |c: &mut Canvas<'_>, p: Paint| c.fill_circle((30.0, 20.0), 12.0, p);
    for opacity in [f32::NAN, -1.0, f32::NEG_INFINITY, 0.0, -0.0] {
        draws_nothing("paint", |c, p| circle(c, p.clone().with_opacity(opacity)));
        draws_nothing("layer", |c, p| {
            c.push_layer(opacity, BlendMode::SourceOver);
            circle(c, p.clone());
            c.pop_layer();
        });
        draws_nothing("image", |c, _| {
            c.draw_image_at(&image(), (5.0, 5.0), &ImagePaint { opacity, ..ImagePaint::default() });
        });
        draws_nothing("alpha", |c, _| circle(c, Color::from_rgba(1.0, 1.0, 1.0, opacity).into()));
    }
    for opacity in [2.0, f32::INFINITY, f32::MAX] {
        draws_like("paint", 0, |c, p| circle(c, p.clone().with_opacity(opacity)), |c, p| circle(c, p.clone()));
        draws_like(
            "layer",
            0,
            |c, p| {
                c.push_layer(opacity, BlendMode::SourceOver);
                circle(c, p.clone());
                c.pop_layer();
            },
            |c, p| circle(c, p.clone()),
        );
    }
    draws_like(
        "colour",
        0,
        |c, _| circle(c, Color::from_rgba(7.0, -3.0, f32::NAN, f32::INFINITY).into()),
        |c, _| circle(c, Color::RED.into()),
    );
}

#[test]
fn shadows() {
    let rect = Rect::from_ltrb(10.0, 8.0, 30.0, 20.0);
    let shadow = Shadow { offset_x: 6.0, offset_y: 5.0, deviation: 0.0, color: Color::RED };
    let cast = |shadow: Shadow| {
        move |c: &mut Canvas<'_>, p: &Paint| {
            c.set_shadow(shadow);
            c.fill_rect(rect, p);
        }
    };
    let plain = |c: &mut Canvas<'_>, p: &Paint| c.fill_rect(rect, p);
    for bad in NOT_FINITE {
        draws_like("offset", 0, cast(Shadow { offset_x: bad, ..shadow }), plain);
        draws_like("offset", 0, cast(Shadow { offset_y: bad, ..shadow }), plain);
        draws_like("deviation", 0, cast(Shadow { deviation: bad, ..shadow }), plain);
    }
    for alpha in [0.0, -1.0, f32::NAN] {
        let color = Color::from_rgba(1.0, 0.0, 0.0, alpha);
        draws_like("transparent", 0, cast(Shadow { color, ..shadow }), plain);
    }
    for far in [1e30, -1e30, f32::MAX, 2e9, -2e9] {
        draws_like("far", 0, cast(Shadow { offset_x: far, ..shadow }), plain);
        draws_like("far", 0, cast(Shadow { offset_x: far, offset_y: far, ..shadow }), plain);
    }
    draws_like("negative", 0, cast(Shadow { deviation: -4.0, ..shadow }), cast(shadow));
}

#[test]
fn a_shadow_blurred_without_measure() {
    let draw = |deviation: f32| {
        drawn(Antialias::Analytic, |c, p| {
            c.set_shadow(Shadow { offset_x: 1.0, offset_y: 1.0, deviation, color: Color::RED });
            c.fill_circle((30.0, 20.0), 12.0, p);
        })
    };
    assert!(draw(1e30) == draw(1000.0));
}

#[test]
fn images() {
    let mut pixel = Pixmap::new(1, 1).unwrap();
    pixel.fill(Color::RED);
    let pixel = Arc::new(pixel);
    let all = Rect::from_ltrb(0.0, 0.0, 1.0, 1.0);
    let target = Rect::from_ltrb(5.0, 6.0, 45.0, 40.0);
    for quality in [FilterQuality::Nearest, FilterQuality::Bilinear, FilterQuality::Bicubic] {
        for antialias in MODES {
            let paint = ImagePaint { quality, antialias, ..ImagePaint::default() };
            let found = drawn(antialias, |c, _| c.draw_image(&pixel, all, target, &paint));
            assert!(found == drawn(antialias, |c, _| c.fill_rect(target, Color::RED)), "{quality:?} {antialias:?}");
            // Half of the source lies left of the image and is transparent.
            let half = Rect::from_ltrb(-1.0, 0.0, 1.0, 1.0);
            let found = drawn(antialias, |c, _| c.draw_image(&pixel, half, target, &paint));
            let right = Rect::from_ltrb(25.0, 6.0, 45.0, 40.0);
            assert!(found == drawn(antialias, |c, _| c.fill_rect(right, Color::RED)), "{quality:?} {antialias:?}");
        }
        let paint = ImagePaint { quality, ..ImagePaint::default() };
        for source in [
            Rect::from_ltrb(1.0, 0.0, 2.0, 1.0),
            Rect::from_ltrb(-5.0, -5.0, 0.0, 0.0),
            Rect::from_ltrb(0.5, 0.5, 0.5, 0.9),
            Rect::from_ltrb(1e30, 0.0, 2e30, 1.0),
            Rect::from_ltrb(f32::NAN, 0.0, 1.0, 1.0),
            Rect::from_ltrb(0.0, 0.0, f32::INFINITY, 1.0),
        ] {
            draws_nothing(&format!("{source:?}"), |c, _| c.draw_image(&pixel, source, target, &paint));
        }
        for (source, target) in [
            (Rect::from_ltrb(-1e30, -1e30, 1e30, 1e30), target),
            (Rect::from_ltrb(0.0, 0.0, 1e-30, 1e-30), target),
            (all, Rect::from_ltrb(-1e30, -1e30, 1e30, 1e30)),
            (all, Rect::from_ltrb(5.0, 5.0, 5.0 + 1e-6, 1e30)),
        ] {
            survives(|c, _| c.draw_image(&pixel, source, target, &paint));
        }
        for spread in [SpreadMode::Pad, SpreadMode::Repeat, SpreadMode::Reflect] {
            for v in [1e-30, 1e-7, 1e7, 1e15, 1e30, f32::MAX] {
                let pattern = Pattern::new(Arc::clone(&pixel)).with_quality(quality).with_spread(spread);
                // Whatever the scale, a picture of one colour is that colour.
                for transform in [
                    Transform::from_scale(v, v),
                    Transform::from_translate(v, -v),
                    Transform::from_row(v, v, -v, v, v, v),
                ] {
                    let pixels = drawn(Antialias::Analytic, |c, _| c.fill(pattern.clone().with_transform(transform)));
                    let uniform = pixels.as_chunks::<4>().0.iter().all(|p| *p == [255, 0, 0, 255] || *p == [0; 4]);
                    assert!(uniform, "{quality:?} {spread:?} {transform:?}");
                }
            }
        }
    }
    let swapped = Rect::from_ltrb(45.0, 40.0, 5.0, 6.0);
    draws_like(
        "swapped edges",
        0,
        |c, _| c.draw_image(&pixel, Rect::from_ltrb(1.0, 1.0, 0.0, 0.0), swapped, &ImagePaint::default()),
        |c, _| c.draw_image(&pixel, all, target, &ImagePaint::default()),
    );
}

#[test]
fn pixels_out_of_bounds() {
    let mut red = Pixmap::new(8, 8).unwrap();
    red.fill(Color::RED);
    for at in [i32::MIN, i32::MIN + 7, -8, 64, i32::MAX - 7, i32::MAX] {
        draws_nothing("write", |c, _| c.write_pixels(red.as_ref(), at, 0).unwrap());
        draws_nothing("write", |c, _| c.write_pixels(red.as_ref(), 0, at).unwrap());
    }
    draws_like(
        "partly outside",
        0,
        |c, _| c.write_pixels(red.as_ref(), -3, 44).unwrap(),
        |c, _| c.fill_rect(Rect::from_ltrb(0.0, 44.0, 5.0, 48.0), Color::RED),
    );
    let mut canvas = Canvas::new(64, 48).unwrap();
    canvas.clear(Color::WHITE);
    let outside = canvas.read_pixels(IntRect::from_ltrb(i32::MIN, i32::MIN, i32::MIN + 9, i32::MIN + 9)).unwrap();
    assert!(outside.data().iter().all(|v| *v == 0));
    let corner = canvas.read_pixels(IntRect::from_ltrb(63, 47, 65, 49)).unwrap();
    assert_eq!(
        [corner.pixel(0, 0), corner.pixel(1, 0), corner.pixel(1, 1)],
        [Some([255; 4]), Some([0; 4]), Some([0; 4])]
    );
    let start = Instant::now();
    for rect in [
        IntRect::EMPTY,
        IntRect::from_ltrb(9, 9, 5, 5),
        IntRect::from_ltrb(i32::MIN, i32::MIN, i32::MAX, i32::MAX),
        IntRect::from_ltrb(0, 0, 32_768, 1),
    ] {
        assert!(canvas.read_pixels(rect).is_err(), "{rect:?}");
    }
    assert!(start.elapsed() < Duration::from_secs(1), "{:?}", start.elapsed());
}

#[test]
fn pixel_primitives_at_the_ends_of_their_numbers() {
    const ENDS: [i32; 7] = [i32::MIN, i32::MIN / 2, -1, 20, 64, i32::MAX / 2, i32::MAX];
    for x0 in ENDS {
        for y0 in ENDS {
            for (x1, y1) in [(i32::MIN, i32::MAX), (i32::MAX, 20), (20, i32::MIN), (30, 40), (i32::MAX, i32::MAX)] {
                survives(|c, p| {
                    c.draw_pixel_line((x0, y0), (x1, y1), p);
                    c.draw_supercover_line((x0, y0), (x1, y1), p);
                    c.draw_pixel_polyline(&[(x0, y0), (x1, y1), (y0, x0)], p);
                    c.draw_pixel_polygon(&[(x0, y0), (x1, y1), (y0, x0)], p);
                });
            }
            for radius in [0, 1, 40, u32::MAX / 2, u32::MAX] {
                survives(|c, p| {
                    c.draw_pixel_circle((x0, y0), radius, p);
                    c.fill_pixel_circle((y0, x0), radius, p);
                });
            }
        }
    }
    draws_everywhere("the largest disc", |c, p| c.fill_pixel_circle((0, 0), u32::MAX, p));
    draws_like(
        "a line across all numbers",
        0,
        |c, p| c.draw_pixel_line((i32::MIN, 7), (i32::MAX, 7), p),
        |c, p| c.fill_rect(Rect::from_ltrb(0.0, 7.0, 64.0, 8.0), p),
    );
    draws_nothing("no corner", |c, p| {
        c.draw_pixel_polyline(&[], p);
        c.draw_pixel_polygon(&[], p);
        c.fill_pixel_polygon(&[], FillRule::NonZero, p);
        c.fill_polygon(&[], FillRule::NonZero, p);
        c.draw_polyline(&[], &Stroke::new(3.0), p);
    });
}

#[test]
fn sizes() {
    let start = Instant::now();
    for (width, height) in [(0, 1), (1, 0), (0, 0), (0, u32::MAX)] {
        assert!(matches!(Canvas::new(width, height), Err(Error::Parameter(_))), "{width} × {height}");
    }
    for (width, height) in [(65_536, 65_536), (32_768, 1), (1, 32_768), (32_767, 32_767), (u32::MAX, u32::MAX)] {
        assert!(matches!(Canvas::new(width, height), Err(Error::Limit(_))), "{width} × {height}");
        assert!(matches!(Mask::new(width, height), Err(Error::Limit(_))), "{width} × {height}");
    }
    // Taking and clearing 16 GiB would take longer than this.
    assert!(start.elapsed() < Duration::from_secs(1), "{:?}", start.elapsed());

    // The largest side can be drawn on to its last pixel, in both directions and in every mode.
    for (width, height) in [(32_767, 1), (1, 32_767)] {
        for antialias in MODES {
            let mut canvas = Canvas::new(width, height).unwrap();
            canvas.set_shadow(Shadow { offset_x: 2.0, offset_y: 2.0, deviation: 3.0, color: Color::RED });
            let paint = Paint::new(Color::BLACK).with_antialias(antialias);
            canvas.fill_rect(Rect::from_ltrb(32_766.0, 0.0, 32_767.0, 1.0), &paint);
            canvas.fill_rect(Rect::from_ltrb(0.0, 32_766.0, 1.0, 32_767.0), &paint);
            canvas.set_shadow(None);
            let pixmap = canvas.into_pixmap();
            assert_eq!(pixmap.pixel(width - 1, height - 1), Some([0, 0, 0, 255]), "{width} {antialias:?}");
            assert_eq!(pixmap.pixel(0, 0), Some([0; 4]), "{width} {antialias:?}");
        }
    }
}

#[test]
fn a_shadow_that_is_too_large_costs_no_other_pixel() {
    let mut canvas = Canvas::new(32_767, 1).unwrap();
    canvas.set_shadow(Shadow { offset_x: 0.0, offset_y: 0.0, deviation: 2.0, color: Color::RED });
    canvas.fill(Color::BLACK);
    canvas.set_shadow(None);
    canvas.fill_rect(Rect::from_ltrb(5.0, 0.0, 6.0, 1.0), Color::GREEN);
    // Whether there is room for the shadow is the machine's business.
    let _ = canvas.flush();
    let pixmap = canvas.into_pixmap();
    assert_eq!(pixmap.pixel(4, 0), Some([0, 0, 0, 255]));
    assert_eq!(pixmap.pixel(5, 0), Some([0, 255, 0, 255]));
}

#[cfg(feature = "svg")]
#[test]
fn path_data_garbage() {
    for data in [
        "",
        " ",
        "M",
        "M1",
        "M1,",
        "Z",
        "MZ",
        "zz",
        "L 1 2",
        "M 1 2 L",
        "M0 0 A 1 1 0 2 2 5 5",
        "M 1e400 0 L 1 1",
        "M0 0 L 1e39 1e39",
        "M0 0 C",
        "M 0 0 h nan",
        "M0 0 l inf 0",
        "\u{0}",
        "M0 0\u{fffd}",
        "M 0 0 T 1 1 S 2 2 3 3",
        "M--1 0",
        "M+.5.5.5",
        "M 0 0 A 0 0 0 0 0 0 0",
        "M 0 0 A 1e30 1e-30 1e30 1 1 1e30 -1e30",
    ] {
        if let Ok(path) = Path::from_svg_data(data) {
            survives(|c, p| {
                c.fill_path(&path, FillRule::NonZero, p);
                c.stroke_path(&path, &Stroke::new(2.0), p);
            });
        }
    }
    let mut random = Random::new(1);
    let letters = b"MmLlHhVvCcSsQqTtAaZz0123456789.-+eE ,,   ";
    let (mut good, mut canvas) = (0, Canvas::new(64, 48).unwrap());
    for _ in 0..20_000 {
        let length = random.within(0..24);
        let mut data = String::from("M5 5");
        for _ in 0..length {
            data.push(char::from(letters[random.within(0..letters.len() as i64) as usize]));
        }
        if let Ok(path) = Path::from_svg_data(&data) {
            good += 1;
            canvas.fill_path(&path, FillRule::EvenOdd, Color::BLACK);
            canvas.stroke_path(&path, &Stroke::new(1.5), Color::RED);
        }
    }
    canvas.flush().unwrap();
    assert!(good > 100, "hardly any path data is right: {good}");
}

/// Four inputs on which tiny-skia 0.12 panics.
#[test]
fn what_others_panic_on() {
    #[cfg(feature = "svg")]
    {
        // A triangle whose tip is 6·10⁸ pixels up: over the canvas its long side is upright.
        let spike = Path::from_svg_data("m3 6h8v-158758583").unwrap();
        draws_like(
            "a spike",
            1,
            |c, p| {
                c.scale(3.8, 3.8);
                c.fill_path(&spike, FillRule::NonZero, p);
            },
            |c, p| c.fill_rect(Rect::from_ltrb(11.4, 0.0, 41.8, 22.8), p),
        );
        survives(|c, p| {
            c.scale(3.8, 3.8);
            c.stroke_path(&spike, &Stroke::new(1.0), p);
            c.stroke_path(&spike, &Stroke::new(0.0), p);
        });
    }
    draws_everywhere("a huge rectangle", |c, p| c.fill_rect(Rect::from_ltrb(-1e30, -1e30, 1e30, 1e30), p));
    draws_everywhere("a huge pen", |c, p| {
        c.draw_line((10.0, 10.0), (50.0, 40.0), &Stroke::new(1e30).with_cap(LineCap::Round), p);
    });
    let mut canvas = Canvas::new(100, 100).unwrap();
    let paint = Paint::new(Color::BLACK).with_antialias(Antialias::None);
    canvas.stroke_rect(Rect::from_ltrb(0.0, 0.0, 100.0, 100.0), &Stroke::new(0.0), paint);
    let pixmap = canvas.into_pixmap();
    for y in 0..100 {
        for x in 0..100 {
            // Pixels 100 of both axes, where the other two sides lie, do not exist.
            let expected = if x == 0 || y == 0 { [0, 0, 0, 255] } else { [0; 4] };
            assert_eq!(pixmap.pixel(x, y), Some(expected), "{x}, {y}");
        }
    }
}

/// An outline wound around more often than an accumulator's bits can count.
#[test]
fn tens_of_thousands_of_windings() {
    for count in [16_383, 16_384, 16_385, 32_768, 40_001, 65_536] {
        let mut path = Path::new();
        for _ in 0..count {
            path.rect(Rect::from_ltrb(8.0, 8.0, 40.0, 32.0));
        }
        let once = |c: &mut Canvas<'_>, p: &Paint| c.fill_rect(Rect::from_ltrb(8.0, 8.0, 40.0, 32.0), p);
        draws_like(&format!("{count} times"), 0, |c, p| c.fill_path(&path, FillRule::NonZero, p), once);
        if count % 2 == 1 {
            draws_like(&format!("{count} times"), 0, |c, p| c.fill_path(&path, FillRule::EvenOdd, p), once);
        } else {
            draws_nothing(&format!("{count} times"), |c, p| c.fill_path(&path, FillRule::EvenOdd, p));
        }
    }
}

#[test]
fn crowds_of_edges_look_the_same_at_every_setting() {
    // Wound around 17,000 times in some strips, once in others.
    let mut path = Path::new();
    path.circle((30.0, 40.0), 25.0);
    for _ in 0..17_000 {
        path.rect(Rect::from_ltrb(8.3, 8.6, 40.1, 21.2));
    }
    for antialias in [Antialias::Analytic, Antialias::Exact] {
        let draw = |settings: RenderSettings| {
            let mut canvas = Canvas::with_settings(64, 80, settings).unwrap();
            canvas.fill_path(&path, FillRule::NonZero, Paint::new(Color::BLACK).with_antialias(antialias));
            canvas.into_pixmap()
        };
        let plain = draw(RenderSettings { level: SimdLevel::Scalar, threads: 1, band_height: 8 });
        for level in SimdLevel::available() {
            for band_height in [8, 16, 128] {
                let settings = RenderSettings { level, threads: 2, band_height };
                assert!(draw(settings) == plain, "{antialias:?} {settings:?}");
            }
        }
        // The rectangle covers 0.7 and 0.1 of the columns, 0.4 of the row at its sides: by the sum of all, everything.
        let alpha = |x, y| f32::from(plain.pixel(x, y).unwrap()[3]);
        for (x, y, coverage) in [(8, 12, 0.7), (40, 12, 0.1), (20, 8, 0.4), (20, 12, 1.0), (20, 50, 1.0), (8, 8, 0.28)]
        {
            let coverage = if antialias == Antialias::Analytic { 1.0 } else { coverage };
            assert!((alpha(x, y) - coverage * 255.0).abs() < 2.0, "{antialias:?}: {} at {x}, {y}", alpha(x, y));
        }
        // In the circle alone both are the same.
        assert_eq!(plain.pixel(30, 14).unwrap()[3], 255);
        assert_eq!(plain.pixel(2, 78).unwrap()[3], 0);
    }
}

/// Draws numbers and choices at random, most of them odd ones.
struct Odd(Random);

impl Odd {
    fn choose<T: Clone>(&mut self, from: &[T]) -> T {
        from[self.0.within(0..from.len() as i64) as usize].clone()
    }

    fn number(&mut self) -> f32 {
        const POOL: [f32; 16] = [
            0.0,
            1e-30,
            1e-10,
            0.5,
            1.0,
            12.3,
            31.0,
            40.5,
            255.99,
            1e4,
            3.2767e4,
            1e7,
            1e15,
            1e30,
            f32::MAX,
            f32::INFINITY,
        ];
        match self.0.within(0..40) {
            0 => f32::NAN,
            // Whole shapes should not always be spoiled by one number.
            1..20 => self.0.within(-20 * 16..80 * 16) as f32 / 16.0,
            _ => self.choose(&POOL) * self.choose(&[1.0, -1.0]),
        }
    }

    fn numbers(&mut self) -> [f32; 8] {
        [(); 8].map(|()| self.number())
    }

    fn color(&mut self) -> Color {
        let mut component = || match self.0.within(0..8) {
            0 => self.number(),
            v => v as f32 / 7.0,
        };
        Color::from_rgba(component(), component(), component(), component())
    }

    fn stops(&mut self) -> Vec<GradientStop> {
        (0..self.0.within(0..6)).map(|_| GradientStop::new(self.number() / 30.0, self.color())).collect()
    }

    fn transform(&mut self) -> Transform {
        let v = self.numbers();
        match self.0.within(0..6) {
            0 => Transform::from_row(v[0], v[1], v[2], v[3], v[4], v[5]),
            1 => Transform::from_rotate(v[0]),
            2 => Transform::from_skew(v[0], v[1]),
            3 => Transform::from_scale(v[0] / 20.0, v[1] / 20.0),
            4 => Transform::from_translate(v[0], v[1]),
            _ => Transform::IDENTITY,
        }
    }

    fn paint(&mut self, image: &Arc<Pixmap>) -> Paint {
        let (v, stops, transform) = (self.numbers(), self.stops(), self.transform());
        let spread = self.choose(&[SpreadMode::Pad, SpreadMode::Repeat, SpreadMode::Reflect, SpreadMode::Decal]);
        let quality = self.choose(&[FilterQuality::Nearest, FilterQuality::Bilinear, FilterQuality::Bicubic]);
        let (a, b) = ((v[0], v[1]), (v[2], v[3]));
        let paint = match self.0.within(0..8) {
            0 => Paint::new(LinearGradient::new(a, b, stops).with_spread(spread).with_transform(transform)),
            1 => {
                let radial = RadialGradient::two_point(a, v[4], b, v[5], stops);
                Paint::new(radial.with_spread(spread).with_transform(transform))
            }
            2 => {
                let sweep = SweepGradient::new(a, stops).with_angles(v[4], v[5]);
                Paint::new(sweep.with_spread(spread).with_transform(transform))
            }
            3 => {
                let pattern = Pattern::new(Arc::clone(image)).with_quality(quality).with_spread(spread);
                Paint::new(pattern.with_transform(transform))
            }
            _ => Paint::new(self.color()),
        };
        let opacity = self.choose(&[1.0, 1.0, 0.5, 2.0, -1.0, f32::NAN]);
        let mode = if self.0.within(0..3) == 0 { self.choose(&BlendMode::ALL) } else { BlendMode::SourceOver };
        paint.with_antialias(self.antialias()).with_opacity(opacity).with_blend_mode(mode)
    }

    fn antialias(&mut self) -> Antialias {
        let odd = [Antialias::Supersample(0), Antialias::Supersample(3), Antialias::Supersample(255)];
        if self.0.within(0..8) == 0 { self.choose(&odd) } else { self.choose(&MODES) }
    }

    fn stroke(&mut self) -> Stroke {
        let mut stroke = Stroke::new(self.choose(&[0.0, 1e-30, 0.3, 1.0, 5.0, 40.0, 1e4, 1e30, -1.0, f32::NAN]))
            .with_cap(self.choose(&[LineCap::Butt, LineCap::Round, LineCap::Square]))
            .with_join(self.choose(&[LineJoin::Miter, LineJoin::MiterClip, LineJoin::Round, LineJoin::Bevel]))
            .with_miter_limit(self.choose(&[4.0, 0.0, 1.0, 1e30, f32::NAN, -1.0]));
        if self.0.within(0..4) == 0 {
            let intervals: Vec<f32> =
                (0..self.0.within(0..5)).map(|_| self.choose(&[0.0, 0.5, 3.0, 7.0, 1e30])).collect();
            stroke = stroke.with_dash(intervals, self.number());
        }
        stroke
    }

    fn path(&mut self) -> Path {
        let mut path = Path::new();
        for _ in 0..self.0.within(1..7) {
            let v = self.numbers();
            let (a, b, c) = ((v[0], v[1]), (v[2], v[3]), (v[4], v[5]));
            match self.0.within(0..12) {
                0 => path.move_to(a),
                1..4 => path.line_to(a),
                4 => path.quad_to(a, b),
                5..7 => path.cubic_to(a, b, c),
                7 => path.close(),
                8 => path.arc(a, v[2], v[3] * PI, v[4] * PI),
                9 => path.arc_to(a, b, v[4]),
                10 => path.svg_arc_to(v[0], v[1], v[2], v[3] > 0.0, v[4] > 0.0, c),
                _ => path.ellipse(a, v[2], v[3]),
            };
        }
        path
    }

    /// One random call.
    fn call(&mut self, canvas: &mut Canvas<'_>, image: &Arc<Pixmap>) {
        let (paint, stroke, v) = (self.paint(image), self.stroke(), self.numbers());
        let whole = |v: f32| v as i32;
        match self.0.within(0..24) {
            0 => canvas.save(),
            1 => canvas.restore(),
            2 => canvas.transform(self.transform()),
            3 => canvas.set_transform(Transform::IDENTITY),
            4 => canvas.push_layer(v[0], self.choose(&BlendMode::ALL)),
            5 | 6 => canvas.pop_layer(),
            7 => {
                let kind = self.choose(&[MaskKind::Alpha, MaskKind::Luminance]);
                canvas.push_mask(kind);
                let (name, call) = self.choose(&CALLS);
                let _ = name;
                call(canvas, &paint, &stroke, v);
                canvas.pop_mask();
            }
            8 => {
                let deviation = self.choose(&[0.0, 0.7, 3.0, -1.0, f32::NAN]);
                let (offset_x, offset_y, color) = (self.number(), self.number(), self.color());
                canvas.set_shadow(Shadow { offset_x, offset_y, deviation, color });
            }
            9 => canvas.set_shadow(None),
            10 => {
                let path = self.path();
                canvas.save();
                canvas.clip_path(&path, FillRule::EvenOdd, paint.antialias);
            }
            11 => {
                let mask = Mask::from_vec(3, 2, vec![255, 128, 0, 1, 200, 90]).unwrap();
                canvas.save();
                canvas.clip_mask(mask, whole(v[0]), whole(v[1]));
            }
            12 => {
                canvas.draw_pixel_line((whole(v[0]), whole(v[1])), (whole(v[2]), whole(v[3])), &paint);
                canvas.draw_pixel_circle((whole(v[4]), whole(v[5])), v[6] as u32, &paint);
                canvas.fill_pixel_circle((whole(v[5]), whole(v[6])), v[7] as u32, &paint);
            }
            13 => canvas.write_pixels(image.as_ref().as_ref(), whole(v[0]), whole(v[1])).unwrap(),
            14 => {
                let rect = IntRect::from_xywh(whole(v[0]), whole(v[1]), 7, 5);
                let _ = canvas.read_pixels(rect).map(|part| canvas.write_pixels(part.as_ref(), 3, 3));
            }
            15 => {
                let path = self.path();
                let _ = canvas.is_point_in_path(&path, FillRule::NonZero, (v[0], v[1]));
                let _ = canvas.is_point_in_stroke(&path, &stroke, (v[2], v[3]));
            }
            16..19 => canvas.fill_path(&self.path(), self.choose(&[FillRule::NonZero, FillRule::EvenOdd]), &paint),
            19..22 => canvas.stroke_path(&self.path(), &stroke, &paint),
            _ => self.choose(&CALLS).1(canvas, &paint, &stroke, v),
        }
    }
}

#[test]
fn random_calls_with_odd_numbers_neither_panic_nor_depend_on_the_settings() {
    let image = {
        let mut canvas = Canvas::new(9, 7).unwrap();
        canvas.clear(Color::from_rgba(0.2, 0.8, 0.4, 0.5));
        canvas.fill_circle((4.0, 3.0), 3.0, Color::RED);
        Arc::new(canvas.into_pixmap())
    };
    let draw = |seed: u64, settings: RenderSettings| {
        let mut odd = Odd(Random::new(seed));
        let mut canvas = Canvas::with_settings(64, 48, settings).unwrap();
        canvas.clear(Color::WHITE);
        for _ in 0..12 {
            odd.call(&mut canvas, &image);
        }
        canvas.into_pixmap().into_vec()
    };
    let mut shown = 0;
    for seed in 0..700 {
        let start = Instant::now();
        let found = draw(seed, RenderSettings::default());
        assert!(start.elapsed() < HANG, "seed {seed} takes {:?}", start.elapsed());
        let plain = RenderSettings { level: SimdLevel::Scalar, threads: 1, band_height: 8 };
        assert!(found == draw(seed, plain), "seed {seed} differs");
        shown += u32::from(found.iter().any(|v| *v != 255));
    }
    assert!(shown > 350, "most pictures are empty: {shown}");
}
