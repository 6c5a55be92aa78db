//! Pixels and surfaces out of bounds.

use std::time::{Duration, Instant};

use rastrum::{Canvas, Color, Error, FillRule, IntRect, Mask, Paint, Pixmap, Rect, Shadow, Stroke};

use super::{MODES, draws_everywhere, draws_like, draws_nothing, survives};

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
