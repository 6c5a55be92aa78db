//! One recording gives one image, whatever renders it. Tolerance 0.

use rastrum::{
    Antialias, BlendMode, Canvas, Color, FillRule, GradientStop, LineJoin, LinearGradient, Paint, Path, Point, Rect,
    RenderSettings, Shadow, SimdLevel, Stroke,
};

/// Shapes of all kinds over 200 × 150 pixels, from a seeded generator.
fn draw(canvas: &mut Canvas<'_>, antialias: Antialias) {
    let mut seed = 7_u32;
    let mut random = |limit: f32| {
        seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (seed >> 8) as f32 / 16_777_216.0 * limit
    };
    canvas.clear(Color::WHITE);
    let stops = [GradientStop::new(0.0, Color::RED), GradientStop::new(1.0, Color::from_rgba(0.0, 0.2, 1.0, 0.4))];
    for (index, mode) in BlendMode::ALL.into_iter().enumerate() {
        let mut path = Path::new();
        path.move_to((random(200.0), random(150.0)));
        for _ in 0..6 {
            path.cubic_to(
                (random(240.0) - 20.0, random(180.0) - 15.0),
                (random(240.0) - 20.0, random(180.0) - 15.0),
                (random(200.0), random(150.0)),
            );
        }
        let rule = if index % 2 == 0 { FillRule::EvenOdd } else { FillRule::NonZero };
        let color = Color::from_rgba(random(1.0), random(1.0), random(1.0), random(1.0));
        let paint = match index % 3 {
            0 => Paint::new(LinearGradient::new((10.0, 20.0), (180.0, 120.0), stops)),
            _ => Paint::new(color),
        };
        let paint = paint.with_antialias(antialias).with_opacity(0.7);
        canvas.save();
        canvas.translate(random(8.0), random(8.0));
        if index % 4 == 1 {
            let mut clip = Path::new();
            clip.circle((100.0, 75.0), 40.0 + random(40.0));
            canvas.clip_path(&clip, FillRule::NonZero, antialias);
        }
        if index % 5 == 2 {
            canvas.push_layer(0.6, mode);
            canvas.fill_path(&path, rule, &paint);
            canvas.pop_layer();
        } else {
            canvas.fill_path(&path, rule, paint.clone().with_blend_mode(mode));
        }
        canvas.stroke_path(&path, &Stroke::new(random(6.0)).with_join(LineJoin::Round), &paint);
        for width in [0.0, 0.7, 1.5, 3.0] {
            let (from, to) = ((random(200.0), random(150.0)), (random(200.0), random(150.0)));
            canvas.draw_line(from, to, &Stroke::new(width), Paint::new(color).with_antialias(antialias));
            canvas.draw_line(to, (to.0 + random(20.0), to.1 - random(20.0)), &Stroke::new(width), &paint);
        }
        canvas.restore();
    }
    canvas.set_shadow(Shadow { offset_x: 5.0, offset_y: 4.0, deviation: 3.0, color: Color::BLACK });
    canvas.fill_round_rect(Rect::from_xywh(20.0, 90.5, 60.0, 40.0), 9.0, Color::GREEN);
    canvas.set_shadow(None);
    canvas.draw_pixel_line((0, 149), (199, 3), Color::BLACK);
}

fn render(settings: RenderSettings, antialias: Antialias) -> Vec<u8> {
    let mut canvas = Canvas::with_settings(200, 150, settings).unwrap();
    draw(&mut canvas, antialias);
    canvas.into_pixmap().into_vec()
}

#[test]
fn every_level_thread_count_and_band_height_gives_the_same_bytes() {
    for antialias in [Antialias::Analytic, Antialias::Exact, Antialias::Supersample(4), Antialias::None] {
        let settings = RenderSettings::default();
        let expected = render(settings.with_level(SimdLevel::Scalar).with_threads(1), antialias);
        assert!(expected.as_chunks::<4>().0.iter().any(|p| *p != [255; 4]), "nothing was drawn");
        for level in SimdLevel::available() {
            for threads in [1, 2, 3, 8] {
                for band_height in [0, 8, 32, 64] {
                    let settings = settings.with_level(level).with_threads(threads).with_band_height(band_height);
                    assert!(render(settings, antialias) == expected, "{antialias:?} differs with {settings:?}");
                }
            }
        }
    }
}

/// Thousands of shapes with all that may come between them, drawn in two frames: what each shows, and what is read in the middle of it.
fn draw_long(settings: RenderSettings, heights: [u32; 3]) -> Vec<Vec<u8>> {
    let mut canvas = Canvas::with_settings(200, 150, settings).unwrap();
    let all = rastrum::IntRect::from_xywh(0, 0, 200, 150);
    let mut seed = 3_u32;
    let mut random = |limit: f32| {
        seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (seed >> 8) as f32 / 16_777_216.0 * limit
    };
    let stops = [GradientStop::new(0.0, Color::RED), GradientStop::new(1.0, Color::from_rgba(0.0, 0.2, 1.0, 0.4))];
    let mut seen = Vec::new();
    let mut star = Path::new();
    star.polygon(&[(0.0, 9.0), (3.0, -9.0), (6.0, 9.0), (-4.0, -3.0), (9.0, -1.0)].map(Point::from));
    let mut shapes = |canvas: &mut Canvas<'_>, count: usize| {
        for index in 0..count {
            let at = (random(200.0), random(150.0));
            let color = Color::from_rgba(random(1.0), random(1.0), random(1.0), 0.3 + random(0.9).min(0.7));
            match index % 5 {
                0 => canvas.fill_rect(Rect::from_xywh(at.0, at.1, random(12.0), random(50.0)), color),
                1 => canvas.fill_circle(at, random(7.0), color),
                2 => canvas.draw_line(at, (at.0 + random(30.0), at.1 - random(30.0)), &Stroke::new(1.5), color),
                3 => canvas.draw_pixel_circle((at.0 as i32, at.1 as i32), 5, color),
                _ => {
                    canvas.save();
                    canvas.translate(at.0, at.1);
                    let gradient = LinearGradient::new((-5.0, -9.0), (5.0, 9.0), stops);
                    canvas.fill_path(&star, FillRule::EvenOdd, gradient);
                    canvas.restore();
                }
            }
        }
    };
    canvas.clear(Color::WHITE);
    for _ in 0..2 {
        shapes(&mut canvas, 2500);
        canvas.set_settings(settings.with_band_height(heights[0]));
        canvas.save();
        let mut round = Path::new();
        round.circle((90.0, 60.0), 55.5);
        canvas.clip_path(&round, FillRule::NonZero, Antialias::Analytic);
        shapes(&mut canvas, 700);
        canvas.restore();
        // Clips of sections that have ended.
        shapes(&mut canvas, 1500);
        canvas.save();
        let mut other = Path::new();
        other.circle((140.0, 90.0), 45.5);
        canvas.clip_path(&other, FillRule::NonZero, Antialias::Analytic);
        shapes(&mut canvas, 60);
        canvas.restore();
        shapes(&mut canvas, 1200);
        canvas.push_layer(0.6, BlendMode::Multiply);
        shapes(&mut canvas, 1300);
        seen.push(canvas.read_pixels(all).unwrap().into_vec());
        canvas.pop_layer();
        canvas.set_settings(settings.with_band_height(heights[1]));
        shapes(&mut canvas, 1500);
        canvas.set_shadow(Shadow { offset_x: 5.0, offset_y: 4.0, deviation: 3.0, color: Color::BLACK });
        shapes(&mut canvas, 3);
        canvas.set_shadow(None);
        shapes(&mut canvas, 1500);
        canvas.set_settings(settings.with_band_height(heights[2]));
        // With a clip that goes on in the next frame, whose sections begin when it ends.
        canvas.save();
        canvas.clip_path(&round, FillRule::NonZero, Antialias::Analytic);
        shapes(&mut canvas, 5);
        canvas.flush().unwrap();
        seen.push(canvas.read_pixels(all).unwrap().into_vec());
        shapes(&mut canvas, 5);
        canvas.restore();
    }
    seen
}

#[test]
fn what_is_prepared_while_the_rest_is_recorded_gives_the_same_bytes() {
    let settings = RenderSettings::default();
    let expected = draw_long(settings.with_threads(1), [32, 32, 32]);
    assert!(expected.windows(2).all(|pair| pair[0] != pair[1]), "frames are alike");
    for threads in [2, 5] {
        for heights in [[0, 0, 0], [32, 32, 32], [8, 64, 16]] {
            let drawn = draw_long(settings.with_threads(threads), heights);
            assert!(drawn == expected, "{threads} threads, bands of {heights:?} rows");
        }
    }
}

/// A shadow is a recording within the recording: that an outline is long enough to be prepared at once is nothing to it.
#[test]
fn the_shadow_of_a_long_outline_is_the_same_on_every_thread_count() {
    let comb: Vec<Point> = (0..20_000).map(|i| Point::new(20.0 + i as f32 / 160.0, [20.5, 110.25][i % 2])).collect();
    let picture = |threads: usize| {
        // A path of its own, as one that was drawn before is not copied.
        let mut path = Path::new();
        path.polygon(&comb);
        let mut canvas = Canvas::with_settings(200, 150, RenderSettings::default().with_threads(threads)).unwrap();
        canvas.clear(Color::WHITE);
        canvas.set_shadow(Shadow { offset_x: 9.0, offset_y: 7.0, deviation: 2.0, color: Color::BLUE });
        canvas.fill_path(&path, FillRule::EvenOdd, Color::RED);
        canvas.stroke_path(&path, &Stroke::new(0.5), Color::BLACK);
        canvas.into_pixmap()
    };
    let expected = picture(1);
    // The shadow reaches below the comb, and nothing else does.
    assert!(expected.pixel(90, 119).unwrap() != expected.pixel(5, 5).unwrap());
    assert!(picture(2).data() == expected.data());
}

/// A long polyline is stroked by several threads. With another subpath, of which nothing is seen, it is stroked in one go.
#[test]
fn a_long_polyline_is_drawn_as_one_that_cannot_be_shared() {
    let mut seed = 5_u32;
    let mut random = |limit: f32| {
        seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (seed >> 8) as f32 / 16_777_216.0 * limit
    };
    // It leaves the canvas on all sides, and has more edges in a band than a sum of areas holds.
    let mut at = Point::new(100.0, 75.0);
    let mut step = || {
        at = Point::new(
            (at.x + random(60.0) - 30.0).clamp(-30.0, 230.0),
            (at.y + random(60.0) - 30.0).clamp(-30.0, 180.0),
        );
        at
    };
    let points: Vec<Point> = (0..50_000).map(|_| step()).collect();
    let near: Vec<Point> = (0..20_000).map(|i| Point::new(20.0 + i as f32 / 150.0, 60.0 + random(20.0))).collect();
    let picture = |settings: RenderSettings, is_shared: bool, is_drawn_again: bool| {
        let path = |points: &[Point]| {
            let mut path = Path::new();
            path.polyline(points);
            if !is_shared {
                path.move_to(points[0]).line_to(points[0]);
            }
            path
        };
        let (long, near) = (path(&points), path(&near));
        let mut canvas = Canvas::with_settings(200, 150, settings).unwrap();
        for _ in 0..=usize::from(is_drawn_again) {
            canvas.clear(Color::WHITE);
            canvas.fill_circle((60.0, 60.0), 30.0, Color::from_rgba(0.2, 0.7, 0.3, 0.8));
            canvas.save();
            let mut round = Path::new();
            round.circle((120.0, 80.0), 60.0);
            canvas.clip_path(&round, FillRule::NonZero, Antialias::Analytic);
            canvas.stroke_path(&long, &Stroke::new(0.02), Color::from_rgba(0.8, 0.1, 0.1, 0.7));
            canvas.restore();
            canvas.push_layer(0.7, BlendMode::Multiply);
            canvas.set_shadow(Shadow { offset_x: 5.0, offset_y: 4.0, deviation: 2.0, color: Color::BLACK });
            canvas.stroke_path(&near, &Stroke::new(1.5).with_join(LineJoin::Round), Color::BLUE);
            canvas.pop_layer();
            canvas.fill_rect(Rect::from_xywh(90.0, 60.0, 40.0, 40.0), Color::GREEN);
            canvas.stroke_path(&near, &Stroke::new(0.4), Color::BLACK);
            // What cannot be seen is no command.
            canvas.stroke_path(&near, &Stroke::new(0.4), Color::TRANSPARENT);
            canvas.stroke_path(&near, &Stroke::new(0.3), Paint::new(Color::RED).with_antialias(Antialias::None));
            canvas.flush().unwrap();
        }
        canvas.into_pixmap().into_vec()
    };
    let settings = RenderSettings::default().with_threads(1);
    let expected = picture(settings, false, false);
    let best = SimdLevel::best();
    for (threads, band_height, level, is_drawn_again) in [
        (1, 32, best, false),
        (2, 32, best, true),
        (2, 8, best, false),
        (5, 64, best, true),
        (2, 32, SimdLevel::Scalar, false),
    ] {
        let settings = settings.with_threads(threads).with_band_height(band_height).with_level(level);
        assert!(
            picture(settings, true, is_drawn_again) == expected,
            "{threads} threads, bands of {band_height} rows, {level:?}, {is_drawn_again}"
        );
    }
}

/// Fixtures ask one question each, so the one that fails says which step is to blame.
#[cfg(all(feature = "svg", feature = "codec"))]
#[test]
fn every_fixture_gives_the_same_bytes() {
    use super::fixtures;

    for name in fixtures::all() {
        let tree = fixtures::parse(&name);
        let settings = RenderSettings::default();
        let expected = fixtures::render(&name, &tree, settings.with_level(SimdLevel::Scalar).with_threads(1));
        assert!(expected.data().iter().any(|byte| *byte != 0), "fixtures/{name}.svg draws nothing");
        for level in SimdLevel::available() {
            for threads in [1, 2, 3, 8] {
                for band_height in [8, 64] {
                    let settings = settings.with_level(level).with_threads(threads).with_band_height(band_height);
                    let actual = fixtures::render(&name, &tree, settings);
                    assert!(actual == expected, "fixtures/{name}.svg differs with {settings:?}");
                }
            }
        }
    }
}

/// What opaque shapes hide is not drawn at all: the picture must be the one that drawing everything gives.
#[test]
fn hidden_shapes_leave_no_trace() {
    let mut random = crate::oracle::Random::new(5);
    let mut below = move |limit: i64| random.within(0..limit);
    for round in 0..40 {
        let mut shapes = Vec::new();
        for _ in 0..60 {
            let corners = 3 + below(6) as usize;
            let spread = if below(3) == 0 { 2600 } else { 700 };
            let (x, y) = (below(2000), below(1300));
            let points: Vec<Point> = (0..corners)
                .map(|_| (x + below(spread) - spread / 2, y + below(spread) - spread / 2))
                .map(|(x, y)| Point::new(x as f32 / 10.0, y as f32 / 10.0))
                .collect();
            let opacity = if below(4) == 0 { 0.5 } else { 1.0 };
            let color = Color::from_rgb8(below(256) as u8, below(256) as u8, 90).with_opacity(opacity);
            shapes.push((points, color, below(12)));
        }
        // A canvas that is asked for its pixels after each shape cannot leave any out.
        let draw = |at_once: bool| {
            let mut canvas = Canvas::new(203, 131).unwrap();
            for (points, color, kind) in &shapes {
                let rule = if kind % 2 == 0 { FillRule::NonZero } else { FillRule::EvenOdd };
                match kind {
                    0 => canvas.clear(*color),
                    1 => canvas.push_layer(0.7, BlendMode::Multiply),
                    2 => canvas.fill_polygon(points, rule, Paint::new(*color).with_blend_mode(BlendMode::Source)),
                    3 => canvas.fill_polygon(points, rule, Paint::new(*color).with_blend_mode(BlendMode::Difference)),
                    4 => canvas.fill_rect(Rect::from_ltrb(points[0].x, points[0].y, points[1].x, points[1].y), *color),
                    5 => canvas.fill_polygon(points, rule, Paint::new(*color).with_antialias(Antialias::Exact)),
                    _ => canvas.fill_polygon(points, rule, *color),
                }
                if *kind == 1 {
                    canvas.fill_polygon(points, rule, *color);
                    canvas.pop_layer();
                }
                if !at_once {
                    canvas.flush().unwrap();
                }
            }
            canvas.into_pixmap().into_vec()
        };
        assert!(draw(true) == draw(false), "round {round}");
    }
}

/// Rectangles have ways of their own to be searched for what they hide and to be painted: the bytes must be those of the same
/// outline with a corner more, which is a path like any other.
#[test]
fn rectangles_are_painted_as_paths_are() {
    let mut random = crate::oracle::Random::new(11);
    let mut below = move |limit: i64| random.within(0..limit);
    for round in 0..30 {
        let mut rects = Vec::new();
        for _ in 0..80 {
            // Sides on 1/256 of pixels, on pixels and on blocks; some leave the canvas.
            let step = [1, 256, 16 * 256][below(3) as usize];
            let mut side = |from: i64, length: i64| (from * 256 + below(length * 256)) / step * step;
            let (left, top) = (side(-20, 220), side(-20, 150));
            let (right, bottom) = (left + 1 + side(0, 70), top + 1 + side(0, 50));
            let opacity = if below(5) == 0 { 0.6 } else { 1.0 };
            let color = Color::from_rgb8(below(256) as u8, below(256) as u8, 40).with_opacity(opacity);
            let [left, top, right, bottom] = [left, top, right, bottom].map(|v| v as f32 / 256.0);
            rects.push((Rect::from_ltrb(left, top, right, bottom), color));
        }
        let draw = |as_paths: bool, level: SimdLevel| {
            let mut canvas = Canvas::with_settings(203, 131, RenderSettings::default().with_level(level)).unwrap();
            for (rect, color) in &rects {
                if as_paths {
                    let mut path = Path::new();
                    path.move_to((rect.left, rect.top)).line_to(((rect.left + rect.right) / 2.0, rect.top));
                    path.line_to((rect.right, rect.top)).line_to((rect.right, rect.bottom));
                    path.line_to((rect.left, rect.bottom)).close();
                    canvas.fill_path(&path, FillRule::NonZero, *color);
                } else {
                    canvas.fill_rect(*rect, *color);
                }
            }
            canvas.into_pixmap().into_vec()
        };
        let expected = draw(true, SimdLevel::Scalar);
        for level in SimdLevel::available() {
            assert!(draw(false, level) == expected, "round {round} at {level:?}");
        }
    }
}

/// Beyond 4,194,304 pixels what covers a whole band is written in one go, hidden or not.
#[test]
fn large_pictures_are_as_small_ones() {
    // The right side cuts a block, and eight pixels; the lower side a strip.
    const SIZE: (u32, u32) = (2301, 2003);
    assert!(SIZE.0 * SIZE.1 > 1 << 22);
    let colors = [Color::BLUE, Color::from_rgba(0.3, 0.2, 0.1, 0.4)];
    let draw = |canvas: &mut Canvas<'_>, (x, y): (f32, f32)| {
        canvas.clear(colors[0]);
        canvas.translate(-x, -y);
        // Its edges go down by as much as across: where they are cut is exact.
        let diamond = [(1100.25, -300.5), (2400.25, 999.5), (1100.25, 2299.5), (-199.75, 999.5)].map(Point::from);
        canvas.fill_polygon(&diamond, FillRule::NonZero, Color::RED);
        canvas.fill_rect(Rect::from_ltrb(1990.25, 1500.5, 2400.0, 2400.0), colors[1]);
    };
    for level in SimdLevel::available() {
        for threads in [1, 2] {
            let settings = RenderSettings::default().with_level(level).with_threads(threads);
            let mut large = Canvas::new(SIZE.0, SIZE.1).unwrap();
            large.set_settings(settings);
            draw(&mut large, (0.0, 0.0));
            let large = large.into_pixmap();
            for (x, y) in [(0, 770), (0, 0), (2237, 1939), (1780, 330), (1000, 1000)] {
                let mut small = Canvas::new(64, 64).unwrap();
                draw(&mut small, (x as f32, y as f32));
                let small = small.into_pixmap();
                let differs = (0..64 * 64)
                    .map(|i| (i % 64, i / 64))
                    .find(|(i, j)| large.pixel(x + i, y + j).is_some_and(|pixel| small.pixel(*i, *j) != Some(pixel)));
                assert_eq!(differs, None, "at ({x}, {y}), {level:?}, {threads} threads");
            }
        }
    }
}
