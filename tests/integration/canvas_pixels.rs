//! The canvas: images, pixel primitives, hit tests, and where pixels go.

use std::collections::BTreeSet;
use std::sync::Arc;

use rastrum::raster::{circle, line};
use rastrum::{
    Antialias, BlendMode, Canvas, Color, Error, FillRule, FilterQuality, ImagePaint, IntRect, Limits, Mask, Paint,
    Path, Pattern, Pixmap, PixmapMut, PixmapRef, Point, SpreadMode, Stroke, Transform,
};

use crate::canvas::{HALF_BLACK, alphas, drawn, rect, text, unit};
use crate::oracle::{Pixel, Random};

// Images

fn two_by_two() -> Arc<Pixmap> {
    Arc::new(drawn(2, 2, |canvas| {
        canvas.fill_rect(rect(0.0, 0.0, 1.0, 1.0), Color::RED);
        canvas.fill_rect(rect(1.0, 0.0, 2.0, 1.0), Color::GREEN);
        canvas.fill_rect(rect(0.0, 1.0, 1.0, 2.0), Color::BLUE);
    }))
}

#[test]
fn an_image_goes_from_its_source_to_its_destination() {
    let image = two_by_two();
    let nearest = ImagePaint { quality: FilterQuality::Nearest, ..ImagePaint::default() };
    let all = rect(0.0, 0.0, 2.0, 2.0);
    let at = drawn(5, 4, |canvas| canvas.draw_image_at(&image, (1.0, 1.0), &ImagePaint::default()));
    assert_eq!(text(&at), [".....", ".RG..", ".B...", "....."]);
    let stretched = drawn(7, 4, |canvas| canvas.draw_image(&image, all, rect(1.0, 0.0, 7.0, 4.0), &nearest));
    assert_eq!(text(&stretched), [".RRRGGG", ".RRRGGG", ".BBB...", ".BBB..."]);
    let right_column =
        drawn(4, 4, |canvas| canvas.draw_image(&image, rect(1.0, 0.0, 2.0, 2.0), rect(0.0, 0.0, 4.0, 4.0), &nearest));
    assert_eq!(text(&right_column), ["GGGG", "GGGG", "....", "...."]);
    // Half of the source does not exist: its part of the destination stays empty.
    let beyond =
        drawn(4, 2, |canvas| canvas.draw_image(&image, rect(-2.0, 0.0, 2.0, 2.0), rect(0.0, 0.0, 4.0, 2.0), &nearest));
    assert_eq!(text(&beyond), ["..RG", "..B."]);
    let turned = drawn(4, 4, |canvas| {
        canvas.translate(4.0, 0.0);
        canvas.rotate(90.0);
        canvas.draw_image(&image, all, rect(0.0, 0.0, 4.0, 4.0), &nearest);
    });
    assert_eq!(text(&turned), ["BBRR", "BBRR", "..GG", "..GG"]);
}

#[test]
fn bilinear_is_linear_between_pixel_centres_and_stays_in_its_source() {
    let ramp = Pixmap::from_straight(3, 1, vec![0, 0, 0, 255, 255, 255, 255, 255, 40, 40, 40, 255]).unwrap();
    let ramp = Arc::new(ramp);
    let paint = ImagePaint::default();
    let reds = |picture: &Pixmap| (0..8).map(|x| picture.pixel(x, 0).unwrap()[0]).collect::<Vec<_>>();
    // Centres lie at (x + 0.5) / 4 − 0.5 = −0.375, −0.125, 0.125 … of the two pixels' distance.
    let close = |found: Vec<u8>, expected: [f32; 8]| {
        for (found, expected) in found.iter().zip(expected) {
            assert!((f32::from(*found) - expected).abs() <= 1.0, "{found}, not {expected}");
        }
    };
    let source = rect(0.0, 0.0, 2.0, 1.0);
    let picture = drawn(8, 1, |canvas| canvas.draw_image(&ramp, source, rect(0.0, 0.0, 8.0, 1.0), &paint));
    close(reds(&picture), [0.0, 0.0, 31.9, 95.6, 159.4, 223.1, 255.0, 255.0]);
    // The middle pixel alone: its neighbours do not bleed in.
    let source = rect(1.0, 0.0, 2.0, 1.0);
    let picture = drawn(8, 1, |canvas| canvas.draw_image(&ramp, source, rect(0.0, 0.0, 8.0, 1.0), &paint));
    close(reds(&picture), [255.0; 8]);
    // Opacity and mode: 255 · 128 / 255 over black.
    let picture = drawn(8, 1, |canvas| {
        canvas.clear(Color::BLACK);
        let paint = ImagePaint { opacity: 0.5, blend_mode: BlendMode::Plus, ..paint };
        canvas.draw_image(&ramp, source, rect(2.0, 0.0, 8.0, 1.0), &paint);
    });
    close(reds(&picture), [0.0, 0.0, 128.0, 128.0, 128.0, 128.0, 128.0, 128.0]);
}

// Pixel primitives

fn set(picture: &Pixmap) -> BTreeSet<Pixel> {
    let mut set = BTreeSet::new();
    for y in 0..picture.height() {
        set.extend((0..picture.width()).filter(|x| picture.pixel(*x, y) != Some([0; 4])).map(|x| (x as i32, y as i32)));
    }
    set
}

#[test]
fn pixel_primitives_are_the_rasterizers_pixels_without_the_transform() {
    let clip = IntRect::from_ltrb(0, 0, 30, 24);
    let star = [(4, 20), (14, 2), (24, 20), (2, 8), (27, 8)];
    let points: Vec<Point> = star.iter().map(|&(x, y)| Point::new(x as f32, y as f32 + 0.3)).collect();
    let pixels = |draw: &dyn Fn(&mut Canvas<'_>)| {
        let moved = drawn(30, 24, |canvas| {
            canvas.transform(Transform::from_row(3.0, 1.0, -2.0, 0.5, 9.0, 9.0));
            draw(canvas);
        });
        set(&moved)
    };
    let black = Color::BLACK;
    assert_eq!(
        pixels(&|canvas| canvas.draw_pixel_line((-5, 3), (40, 21), black)),
        line::bresenham((-5, 3), (40, 21)).clipped(clip).collect()
    );
    assert_eq!(
        pixels(&|canvas| canvas.draw_supercover_line((1, 3), (22, 21), black)),
        line::supercover((1, 3), (22, 21)).clipped(clip).collect()
    );
    assert_eq!(
        pixels(&|canvas| canvas.draw_pixel_polyline(&star, black)),
        line::polyline(&star).clipped(clip).collect()
    );
    assert_eq!(pixels(&|canvas| canvas.draw_pixel_polygon(&star, black)), line::outline(&star).clipped(clip).collect());
    assert_eq!(
        pixels(&|canvas| canvas.draw_pixel_circle((20, 12), 11, black)),
        circle::circle((20, 12), 11).clipped(clip).collect()
    );
    let disc = circle::filled_circle((20, 12), 11).clipped(clip);
    assert_eq!(
        pixels(&|canvas| canvas.fill_pixel_circle((20, 12), 11, black)),
        disc.flat_map(|(y, columns)| columns.map(move |x| (x, y))).collect()
    );
    for rule in [FillRule::NonZero, FillRule::EvenOdd] {
        let filled = drawn(30, 24, |canvas| {
            canvas.fill_polygon(&points, rule, Paint::new(black).with_antialias(Antialias::None));
        });
        assert_eq!(pixels(&|canvas| canvas.fill_pixel_polygon(&points, rule, black)), set(&filled), "{rule:?}");
    }
}

#[test]
fn a_pixel_met_twice_is_painted_once_and_clips_apply() {
    let picture = drawn(5, 5, |canvas| {
        canvas.clip_rect(rect(0.0, 0.0, 5.0, 3.0), Antialias::Analytic);
        canvas.push_layer(0.5, BlendMode::SourceOver);
        canvas.draw_pixel_polyline(&[(0, 1), (4, 1), (2, 1), (2, 4), (2, 0)], HALF_BLACK);
        canvas.pop_layer();
    });
    // 128 · 128 / 255 = 64.3
    assert_eq!(alphas(&picture, 1), [64; 5]);
    assert_eq!(alphas(&picture, 0), [0, 0, 64, 0, 0]);
    assert_eq!(alphas(&picture, 3), [0; 5]);
}

#[test]
fn an_aliased_hairline_is_bresenhams() {
    let picture = drawn(12, 8, |canvas| {
        canvas.scale(2.0, 2.0);
        let paint = Paint::new(Color::BLACK).with_antialias(Antialias::None);
        canvas.draw_line((0.3, 0.2), (5.2, 3.1), &Stroke::new(0.0), paint);
    });
    // The pixels that hold (0.6, 0.4) and (10.4, 6.2), and the line between.
    assert_eq!(set(&picture), line::bresenham((0, 0), (10, 6)).collect());
}

// Lines

/// Lines of all directions and widths, some of which leave a canvas of 64 × 48.
fn lines(mut draw: impl FnMut(Point, Point, &Stroke)) {
    let mut random = Random::new(17);
    let mut within = |low: i64, high: i64| random.within(100 * low..100 * high) as f32 / 100.0;
    for index in 0..120 {
        let from = Point::new(within(-20, 84), within(-20, 68));
        let to = if index % 3 == 0 {
            from + Point::new(within(-9, 9), within(-9, 9))
        } else {
            Point::new(within(-20, 84), within(-20, 68))
        };
        // Some along an axis.
        let to = if index % 8 == 5 { Point::new(to.x, from.y) } else { to };
        draw(from, to, &Stroke::new(within(0, 5)));
    }
}

#[test]
fn a_line_covers_the_same_with_any_paint_and_through_clips_and_layers() {
    let black = Arc::new(drawn(1, 1, |canvas| canvas.clear(Color::BLACK)));
    let pattern = Pattern::new(black).with_spread(SpreadMode::Repeat);
    let mut around = Path::new();
    around.polygon(&[(-90.0, -90.0), (300.0, -90.0), (-90.0, 300.0)].map(Point::from));
    lines(|from, to, stroke| {
        let plain = drawn(64, 48, |canvas| canvas.draw_line(from, to, stroke, Color::BLACK));
        let exact = Paint::new(Color::BLACK).with_antialias(Antialias::Exact);
        let pictures = [
            drawn(64, 48, |canvas| canvas.draw_line(from, to, stroke, pattern.clone())),
            drawn(64, 48, |canvas| canvas.draw_line(from, to, stroke, exact)),
            drawn(64, 48, |canvas| {
                let paint = Paint::new(Color::BLACK).with_blend_mode(BlendMode::DestinationOver);
                canvas.draw_line(from, to, stroke, paint);
            }),
            drawn(64, 48, |canvas| {
                canvas.clip_path(&around, FillRule::NonZero, Antialias::Analytic);
                canvas.draw_line(from, to, stroke, Color::BLACK);
            }),
            drawn(64, 48, |canvas| {
                canvas.push_layer(1.0, BlendMode::SourceOver);
                canvas.draw_line(from, to, stroke, Color::BLACK);
                canvas.pop_layer();
            }),
        ];
        for (index, picture) in pictures.iter().enumerate() {
            assert!(*picture == plain, "{index}: {from:?} to {to:?}, {stroke:?}");
        }
    });
}

#[test]
fn a_line_is_cut_at_the_canvas_and_at_clips_of_whole_pixels() {
    lines(|from, to, stroke| {
        let large = drawn(128, 96, |canvas| canvas.draw_line(from, to, stroke, HALF_BLACK));
        let small = drawn(64, 48, |canvas| canvas.draw_line(from, to, stroke, HALF_BLACK));
        let clipped = drawn(64, 48, |canvas| {
            canvas.clip_rect(rect(13.0, 9.0, 45.0, 41.0), Antialias::Analytic);
            canvas.draw_line(from, to, stroke, HALF_BLACK);
        });
        for (x, y) in (0..48).flat_map(|y| (0..64).map(move |x| (x, y))) {
            let whole = large.pixel(x, y);
            assert_eq!(small.pixel(x, y), whole, "{x}, {y}: {from:?} to {to:?}, {stroke:?}");
            let is_inside = (13..45).contains(&x) && (9..41).contains(&y);
            let expected = if is_inside { whole } else { Some([0; 4]) };
            assert_eq!(clipped.pixel(x, y), expected, "{x}, {y}: {from:?} to {to:?}, {stroke:?}");
        }
    });
}

// Hit tests

#[test]
fn hits_are_where_a_drawing_covers_pixel_centres() {
    let mut path = Path::new();
    path.move_to((2.0, 3.0))
        .cubic_to((20.0, -6.0), (-2.0, 22.0), (15.0, 12.0))
        .quad_to((18.0, 2.0), (8.0, 6.0))
        .close();
    path.circle((9.0, 8.0), 4.0);
    let stroke = Stroke::new(2.0);
    let transform = Transform::from_row(2.2, 0.4, -0.5, 1.7, 6.3, 1.9);
    for rule in [FillRule::NonZero, FillRule::EvenOdd] {
        // A pixel that is covered whole, or not at all, shows what holds at its centre.
        let sure = |draw: &dyn Fn(&mut Canvas<'_>, Paint), hit: &dyn Fn(&Canvas<'_>, Point) -> bool| {
            let mut canvas = Canvas::new(48, 40).unwrap();
            canvas.set_transform(transform);
            draw(&mut canvas, Paint::new(Color::BLACK).with_antialias(Antialias::Supersample(16)));
            let picture = canvas.read_pixels(IntRect::from_xywh(0, 0, 48, 40)).unwrap();
            let mut counts = [0, 0];
            for y in 0..40_u8 {
                for x in 0..48_u8 {
                    let alpha = picture.pixel(x.into(), y.into()).unwrap()[3];
                    let center = Point::new(f32::from(x) + 0.5, f32::from(y) + 0.5);
                    if alpha == 0 || alpha == 255 {
                        assert_eq!(hit(&canvas, center), alpha == 255, "{center:?} {rule:?}");
                        counts[usize::from(alpha == 255)] += 1;
                    }
                }
            }
            assert!(counts[0] > 100 && counts[1] > 50, "{counts:?}");
        };
        sure(&|canvas, paint| canvas.fill_path(&path, rule, paint), &|canvas, p| {
            canvas.is_point_in_path(&path, rule, p)
        });
        sure(&|canvas, paint| canvas.stroke_path(&path, &stroke, paint), &|canvas, p| {
            canvas.is_point_in_stroke(&path, &stroke, p)
        });
    }
    let mut canvas = Canvas::new(48, 40).unwrap();
    let mut path = Path::new();
    path.circle((9.0, 8.0), 4.0);
    canvas.clip_rect(rect(0.0, 0.0, 0.0, 0.0), Antialias::None);
    assert!(canvas.is_point_in_path(&path, FillRule::NonZero, (9.0, 8.0)), "the clip does not matter");
    canvas.scale(0.0, 1.0);
    assert!(!canvas.is_point_in_path(&path, FillRule::NonZero, (0.0, 8.0)));
    assert!(!canvas.is_point_in_stroke(&path, &stroke, (0.0, 8.0)));
}

// Targets

#[test]
fn a_borrowed_buffer_is_complete_after_a_flush_and_after_the_canvas() {
    // Rows of three pixels and a byte that is none of the canvas's.
    let mut buffer = vec![7; 13 * 2 - 1];
    {
        let mut canvas = Canvas::on(PixmapMut::from_bytes_with_stride(&mut buffer, 3, 2, 13).unwrap());
        assert_eq!((canvas.width(), canvas.height()), (3, 2));
        canvas.clear(Color::WHITE);
        canvas.flush().unwrap();
        assert_eq!(text(&canvas.read_pixels(IntRect::from_xywh(0, 0, 3, 2)).unwrap()), ["WWW", "WWW"]);
        canvas.fill_rect(rect(2.0, 0.0, 3.0, 1.0), Color::RED);
        canvas.push_layer(1.0, BlendMode::SourceOver);
        canvas.fill_rect(rect(0.0, 1.0, 1.0, 2.0), Color::BLUE);
    }
    let white = [255; 4];
    let expected =
        [&[white, white, [255, 0, 0, 255]].concat()[..], &[7], &[[0, 0, 255, 255], white, white].concat()].concat();
    assert_eq!(buffer, expected);

    let mut pixmap = Pixmap::new(2, 1).unwrap();
    let mut canvas = Canvas::on(pixmap.as_mut());
    canvas.fill_rect(unit(), Color::GREEN);
    let copy = canvas.into_pixmap();
    assert_eq!(text(&copy), ["G."]);
    assert_eq!(copy, pixmap);
    // A picture that is there is drawn over.
    let mut canvas = Canvas::from_pixmap(pixmap);
    canvas.fill_rect(rect(1.0, 0.0, 2.0, 1.0), Color::RED);
    assert_eq!(text(&canvas.into_pixmap()), ["GR"]);
}

// Pictures

#[test]
fn sizes_and_lengths_are_checked() {
    assert!(matches!(Pixmap::new(0, 3), Err(Error::Parameter(_))));
    assert!(matches!(Pixmap::from_vec(2, 2, vec![0; 15]), Err(Error::Parameter(_))));
    assert!(matches!(Pixmap::from_straight(2, 2, vec![0; 17]), Err(Error::Parameter(_))));
    assert!(matches!(PixmapRef::from_bytes(&[0; 15], 2, 2), Err(Error::Parameter(_))));
    assert!(matches!(PixmapMut::from_bytes(&mut [0; 17], 2, 2), Err(Error::Parameter(_))));
    assert!(matches!(Mask::from_vec(2, 2, vec![0; 3]), Err(Error::Parameter(_))));
    let small = Limits { max_side: 100, max_pixels: 2_000 };
    assert!(Canvas::with_limits(100, 20, small).is_ok());
    for (width, height) in [(101, 1), (1, 101), (100, 21)] {
        assert!(matches!(Canvas::with_limits(width, height, small), Err(Error::Limit(_))), "{width} × {height}");
    }
    let text = Canvas::with_limits(101, 1, small).err().unwrap().to_string();
    assert!(text.contains("101 × 1") && text.contains("100"), "{text}");
}

#[test]
fn straight_alpha_is_multiplied_in_and_divided_out_to_the_nearest() {
    let straight = vec![255, 128, 1, 255, 255, 128, 1, 128, 200, 100, 3, 51, 9, 9, 9, 0];
    let pixmap = Pixmap::from_straight(4, 1, straight).unwrap();
    // c · a / 255: 128 · 128 / 255 = 64.3, 200 · 51 / 255 = 40.
    assert_eq!(pixmap.data(), [255, 128, 1, 255, 128, 64, 1, 128, 40, 20, 1, 51, 0, 0, 0, 0]);
    // c · 255 / a: 64 · 255 / 128 = 127.5, 1 · 255 / 128 = 2.0
    assert_eq!(pixmap.to_straight(), [255, 128, 1, 255, 255, 128, 2, 128, 200, 100, 5, 51, 0, 0, 0, 0]);
    // Every premultiplied pixel goes to straight and back unchanged.
    let all: Vec<u8> = (0..=255_u8).flat_map(|a| (0..=a).flat_map(move |v| [v, 0, a, a])).collect();
    let pixmap = Pixmap::from_vec(257 * 128, 1, all.clone());
    assert!(pixmap.is_err(), "wider than a picture may be");
    let pixmap = Pixmap::from_vec(257, 128, all).unwrap();
    assert!(Pixmap::from_straight(257, 128, pixmap.to_straight()).unwrap() == pixmap);
}

#[cfg(feature = "codec")]
mod codec {
    use super::*;

    fn noise(width: u32, height: u32) -> Pixmap {
        let mut random = Random::new(9);
        let straight = (0..width * height * 4).map(|_| random.bits() as u8).collect();
        Pixmap::from_straight(width, height, straight).unwrap()
    }

    #[test]
    fn a_png_file_holds_every_pixel() {
        for (width, height) in [(1, 1), (17, 5), (3, 200), (256, 33)] {
            let pixmap = noise(width, height);
            let bytes = pixmap.encode_png().unwrap();
            assert!(Pixmap::decode_png(&bytes).unwrap() == pixmap, "{width} × {height}");
            assert!(Pixmap::decode(&bytes).unwrap() == pixmap);
            assert_eq!(pixmap.encode_png().unwrap(), bytes, "the same picture is the same file");
        }
    }

    #[test]
    fn broken_png_files_are_refused() {
        let bytes = noise(20, 20).encode_png().unwrap();
        for length in [0, 7, 8, 20, 33, bytes.len() / 2, bytes.len() - 13] {
            assert!(matches!(Pixmap::decode_png(&bytes[..length]), Err(Error::Format(_))), "{length}");
        }
        let mut random = Random::new(4);
        for _ in 0..300 {
            let mut broken = bytes.clone();
            for _ in 0..3 {
                let at = random.within(0..broken.len() as i64) as usize;
                broken[at] = random.bits() as u8;
            }
            // Right or wrong, but no panic.
            let _ = Pixmap::decode_png(&broken);
        }
    }

    #[test]
    fn a_save_that_fails_leaves_the_old_file() {
        let folder = std::env::temp_dir().join(format!("rastrum-canvas-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let path = folder.join("picture.png");
        let (old, new) = (noise(3, 3), noise(4, 4));
        old.save_png(&path).unwrap();
        // A file that must not be written.
        let mut permissions = std::fs::metadata(&path).unwrap().permissions();
        permissions.set_readonly(true);
        std::fs::set_permissions(&path, permissions.clone()).unwrap();
        assert!(matches!(new.save_png(&path), Err(Error::Io { .. })));
        assert!(Pixmap::load_png(&path).unwrap() == old);
        #[expect(clippy::permissions_set_readonly_false, reason = "the file is this test's own")]
        permissions.set_readonly(false);
        std::fs::set_permissions(&path, permissions).unwrap();
        // Nowhere to write to.
        assert!(matches!(new.save_png(folder.join("none").join("picture.png")), Err(Error::Io { .. })));
        assert!(matches!(new.save_png(&folder), Err(Error::Io { .. })));
        assert!(Pixmap::load_png(&path).unwrap() == old);
        let names: Vec<_> = std::fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap().file_name()).collect();
        assert_eq!(names, ["picture.png"], "nothing is left beside it");
        new.save_png(&path).unwrap();
        assert!(Pixmap::load_png(&path).unwrap() == new);
        assert!(matches!(Pixmap::load_png(folder.join("none.png")), Err(Error::Io { .. })));
        std::fs::remove_dir_all(&folder).unwrap();
    }
}
