//! Paints, images and shadows out of their range.

use std::sync::Arc;

use rastrum::{
    Antialias, BlendMode, Canvas, Color, FillRule, FilterQuality, GradientStop, ImagePaint, LinearGradient, Paint,
    Pattern, Pixmap, RadialGradient, Rect, Shadow, SpreadMode, SweepGradient, Transform,
};

use super::{MODES, NOT_FINITE, SANE, drawn, draws_like, draws_nothing, image, points, survives};

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
