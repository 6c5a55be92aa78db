//! Outlines: path data that is none, what other renderers panic on, crowds of edges.

use rastrum::{
    Antialias, Canvas, Color, FillRule, LineCap, Paint, Path, Point, Rect, RenderSettings, SimdLevel, Stroke,
};

use super::{draws_everywhere, draws_like, draws_nothing, survives};
use crate::oracle::Random;

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
    // Wound around so often in some strips that the sum of areas in 32 bits, of which a pixel has 17, is nothing; once in others. It is
    // too often to find out where so many edges cross.
    for (antialias, windings, is_resolved) in
        [(Antialias::Analytic, 32_768, false), (Antialias::Exact, 32_768, false), (Antialias::Exact, 50, true)]
    {
        let mut path = Path::new();
        path.circle((30.0, 40.0), 25.0);
        for _ in 0..windings {
            path.rect(Rect::from_ltrb(8.3, 8.6, 40.1, 21.2));
        }
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
            let coverage = if is_resolved { coverage } else { 1.0 };
            assert!((alpha(x, y) - coverage * 255.0).abs() < 2.0, "{antialias:?}: {} at {x}, {y}", alpha(x, y));
        }
        // In the circle alone both are the same.
        assert_eq!(plain.pixel(30, 14).unwrap()[3], 255);
        assert_eq!(plain.pixel(2, 78).unwrap()[3], 0);
    }
}

#[test]
fn a_polyline_around_the_same_corners_thousands_of_times_is_that_around_them_once() {
    // Long enough to be stroked stretch by stretch, none of which is a crowd.
    let around = |times: usize| {
        let corners = [(10.3, 8.6), (50.1, 8.6), (50.1, 60.2), (10.3, 60.2)].map(Point::from);
        let mut path = Path::new();
        path.polyline(&corners.repeat(times));
        path
    };
    // In 32 bits, of which a pixel has 17, the sum of so many is nothing.
    let (once, often) = (around(2), around(32_768));
    let stroke = Stroke::new(6.0);
    let draw = |path: &Path, settings: RenderSettings| {
        let mut canvas = Canvas::with_settings(64, 80, settings).unwrap();
        canvas.stroke_path(path, &stroke, Color::BLACK);
        canvas.into_pixmap()
    };
    let plain = draw(&once, RenderSettings::default());
    assert!(plain.data().iter().skip(3).step_by(4).filter(|alpha| **alpha == 255).count() > 800);
    for level in SimdLevel::available() {
        for (threads, band_height) in [(1, 32), (2, 8), (2, 128)] {
            let drawn = draw(&often, RenderSettings { level, threads, band_height });
            // Where the side of one is within a pixel, areas add up to more than is covered.
            let differ = plain.data().iter().zip(drawn.data()).filter(|(a, b)| matches!(a, 0 | 255) && a != b).count();
            assert_eq!(differ, 0, "{level:?}, {threads} threads, bands of {band_height} rows");
        }
    }
}
