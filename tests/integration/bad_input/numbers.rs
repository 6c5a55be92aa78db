//! Numbers that are not finite, huge or without extent, and what draws with them.

use rastrum::{
    Antialias, Canvas, Color, FillRule, GradientStop, ImagePaint, LineCap, LineJoin, LinearGradient, Paint, Path,
    Pattern, Point, RadialGradient, Rect, Stroke, SweepGradient, Transform,
};

use super::{
    CALLS, HUGE, MODES, NOT_FINITE, SANE, cubic, drawn, draws_everywhere, draws_like, draws_nothing, image,
    numbers_read, points, survives,
};

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
