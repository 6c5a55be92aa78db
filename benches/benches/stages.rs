//! The stages of drawing, one by one.
//!
//! They are private to the library, so each is measured through the canvas, by a picture in which it takes most of the time:
//!
//! - `flatten`, `stroke`, `edges`: much geometry around a clip of one pixel. Paths are recorded, flattened or stroked, and made
//!   into edges; next to nothing is accumulated or painted. (Should the library learn to skip curves outside of clips, these need another
//!   picture.)
//! - `cells`: many edges on the canvas, few pixels for each.
//! - `sweep`: few edges in many rows and columns, so that winding is summed over long spans.
//! - `fetch`: the whole canvas from one paint by `Source`: no coverage, no blending.
//! - `blend`: the whole canvas in one half transparent colour, by each blend mode.
//!
//! All on 1024 × 1024 pixels and one thread; recording is part of the time.

use std::f32::consts::TAU;
use std::hint::black_box;
use std::sync::Arc;
use std::time::Duration;

use criterion::{Criterion, criterion_group, criterion_main};
use rastrum::{
    Antialias, BlendMode, Canvas, Color, FillRule, FilterQuality, GradientStop, LineCap, LineJoin, LinearGradient,
    Paint, Path, Pattern, Pixmap, RadialGradient, Rect, RenderSettings, Stroke, SweepGradient, Transform,
};

const SIDE: f32 = 1024.0;

fn canvas() -> Canvas<'static> {
    let settings = RenderSettings::default().with_threads(1);
    let mut canvas = Canvas::with_settings(SIDE as u32, SIDE as u32, settings).expect("the size is valid");
    canvas.clear(Color::WHITE);
    canvas
}

/// Times drawing and rendering.
fn bench(criterion: &mut Criterion, name: &str, mut draw: impl FnMut(&mut Canvas<'_>)) {
    let mut canvas = canvas();
    criterion.bench_function(name, |bencher| {
        bencher.iter(|| {
            draw(black_box(&mut canvas));
            canvas.flush()
        });
    });
}

/// The same where one pixel alone can be painted.
fn bench_clipped(criterion: &mut Criterion, name: &str, mut draw: impl FnMut(&mut Canvas<'_>)) {
    bench(criterion, name, |canvas| {
        let mut canvas = canvas.saved();
        canvas.clip_rect(Rect::from_xywh(512.0, 512.0, 1.0, 1.0), Antialias::Analytic);
        draw(&mut canvas);
    });
}

/// A closed ring of `count` segments whose points lie between 200 and 500 px from the middle.
fn ring(count: usize, curves: bool) -> Path {
    let point = |step: usize| {
        let angle = step as f32 / (count * 3) as f32 * TAU;
        let (sin, cos) = libm::sincosf(angle);
        let radius = 350.0 + 150.0 * libm::sinf(angle * 61.0 + (step % 3) as f32);
        (SIDE / 2.0 + radius * cos, SIDE / 2.0 + radius * sin)
    };
    let mut path = Path::new();
    path.move_to(point(0));
    for segment in 0..count {
        let at = segment * 3;
        match curves {
            true => path.cubic_to(point(at + 1), point(at + 2), point(at + 3)),
            false => path.line_to(point(at + 3)),
        };
    }
    path.close();
    path
}

fn geometry(criterion: &mut Criterion) {
    let (lines, curves) = (ring(20_000, false), ring(5_000, true));
    bench_clipped(criterion, "flatten/5,000 cubics", |canvas| {
        canvas.fill_path(&curves, FillRule::NonZero, Color::BLACK)
    });
    bench_clipped(criterion, "edges/20,000 lines", |canvas| canvas.fill_path(&lines, FillRule::NonZero, Color::BLACK));
    let plain = Stroke::new(1.0);
    let round = Stroke::new(3.0).with_join(LineJoin::Round).with_cap(LineCap::Round);
    let dashed = Stroke::new(1.0).with_dash([4.0, 3.0], 0.0);
    bench_clipped(criterion, "stroke/20,000 lines, mitred", |canvas| canvas.stroke_path(&lines, &plain, Color::BLACK));
    bench_clipped(criterion, "stroke/20,000 lines, round", |canvas| canvas.stroke_path(&lines, &round, Color::BLACK));
    bench_clipped(criterion, "stroke/5,000 cubics, round", |canvas| canvas.stroke_path(&curves, &round, Color::BLACK));
    // Dashes outside of clips are left out, so these are painted.
    bench(criterion, "stroke/5,000 cubics, dashed", |canvas| canvas.stroke_path(&curves, &dashed, Color::BLACK));
}

fn coverage(criterion: &mut Criterion) {
    // A comb of steep and one of flat teeth.
    let comb = |across: bool| {
        let mut path = Path::new();
        path.move_to((0.0, 0.0));
        for tooth in 0..500 {
            let at = tooth as f32 * 2.0 + 0.3;
            for (x, y) in [(at, 1023.5), (at + 1.1, 0.5)] {
                path.line_to(if across { (y, x) } else { (x, y) });
            }
        }
        path.close();
        path
    };
    for (name, antialias) in [("analytic", Antialias::Analytic), ("exact", Antialias::Exact)] {
        let paint = Paint::new(Color::BLACK).with_antialias(antialias);
        for (direction, comb) in [("steep", comb(false)), ("flat", comb(true))] {
            bench(criterion, &format!("cells/1,000 {direction} edges, {name}"), |canvas| {
                canvas.fill_path(&comb, FillRule::NonZero, &paint);
            });
        }
        let mut wedge = Path::new();
        wedge.move_to((0.3, 0.2)).line_to((1023.0, 3.4)).line_to((1020.5, 1023.1)).line_to((4.7, 1019.0)).close();
        bench(criterion, &format!("sweep/four edges around the canvas, {name}"), |canvas| {
            canvas.fill_path(&wedge, FillRule::NonZero, &paint);
        });
    }
}

fn fetch(criterion: &mut Criterion) {
    let stops = |count: u8| -> Vec<GradientStop> {
        let stop = |index: u8| {
            let level = index.wrapping_mul(97);
            GradientStop::new(f32::from(index) / f32::from(count - 1), Color::from_rgb8(level, 255 - level, level / 2))
        };
        (0..count).map(stop).collect()
    };
    let middle = (SIDE / 2.0, SIDE / 2.0);
    let wave = |index: usize| ((index * 37) % 251) as u8;
    let image: Vec<u8> =
        (0..256 * 256).flat_map(|pixel| [wave(pixel), wave(pixel / 256), wave(pixel / 7), 255]).collect();
    let image = Arc::new(Pixmap::from_vec(256, 256, image).expect("the size is valid"));
    let pattern = |quality: FilterQuality, transform: Transform| {
        Paint::new(Pattern::new(image.clone()).with_quality(quality).with_transform(transform))
    };
    let (scaled, turned) = (Transform::from_scale(1.7, 1.7), Transform::from_rotate(30.0));
    let paints = [
        ("solid", Paint::new(Color::RED)),
        ("linear gradient, 2 stops", LinearGradient::new((0.0, 0.0), (SIDE, 500.0), stops(2)).into()),
        ("linear gradient, 8 stops", LinearGradient::new((0.0, 0.0), (SIDE, 500.0), stops(8)).into()),
        ("radial gradient", RadialGradient::new(middle, 600.0, stops(3)).into()),
        ("focal gradient", RadialGradient::two_point((400.0, 480.0), 10.0, middle, 600.0, stops(3)).into()),
        ("sweep gradient", SweepGradient::new(middle, stops(3)).into()),
        ("image, not scaled", pattern(FilterQuality::Nearest, Transform::IDENTITY)),
        ("image, scaled, nearest", pattern(FilterQuality::Nearest, scaled)),
        ("image, scaled, bilinear", pattern(FilterQuality::Bilinear, scaled)),
        ("image, scaled, bicubic", pattern(FilterQuality::Bicubic, scaled)),
        ("image, turned, nearest", pattern(FilterQuality::Nearest, turned)),
        ("image, turned, bilinear", pattern(FilterQuality::Bilinear, turned)),
        ("image, turned, bicubic", pattern(FilterQuality::Bicubic, turned)),
    ];
    for (name, paint) in paints {
        let paint = paint.with_blend_mode(BlendMode::Source);
        bench(criterion, &format!("fetch/{name}"), |canvas| canvas.fill(&paint));
    }
}

fn blend(criterion: &mut Criterion) {
    for mode in BlendMode::ALL {
        let paint = Paint::new(Color::from_rgba8(200, 120, 40, 128)).with_blend_mode(mode);
        bench(criterion, &format!("blend/{}", mode.name()), |canvas| canvas.fill(&paint));
    }
}

criterion_group! {
    name = stages;
    config = Criterion::default()
        .sample_size(20)
        .warm_up_time(Duration::from_millis(300))
        .measurement_time(Duration::from_secs(1));
    targets = geometry, coverage, fetch, blend
}
criterion_main!(stages);
