//! The same shaders in tiny-skia.

use tiny_skia as ts;

use super::random::Random;
use super::{oracle, render};
use crate::color::Color;
use crate::geom::{Point, Transform};
use crate::num::level::SimdLevel;
use crate::paint::prepare::PreparedPaint;
use crate::paint::{FilterQuality, GradientStop, Shader, SpreadMode};

const SIZE: usize = 96;

fn transform(t: Transform) -> ts::Transform {
    ts::Transform::from_row(t.sx, t.ky, t.kx, t.sy, t.tx, t.ty)
}

fn point(p: Point) -> ts::Point {
    ts::Point::from_xy(p.x, p.y)
}

fn spread(spread: SpreadMode) -> ts::SpreadMode {
    match spread {
        SpreadMode::Pad => ts::SpreadMode::Pad,
        SpreadMode::Repeat => ts::SpreadMode::Repeat,
        SpreadMode::Reflect => ts::SpreadMode::Reflect,
        SpreadMode::Decal => unreachable!("tiny-skia has no decal"),
    }
}

fn stops(stops: &[GradientStop]) -> Vec<ts::GradientStop> {
    let color = |c: Color| ts::Color::from_rgba(c.r, c.g, c.b, c.a).unwrap();
    stops.iter().map(|stop| ts::GradientStop::new(stop.position, color(stop.color))).collect()
}

/// tiny-skia's picture of `shader`, or `None` where it refuses it.
fn reference(shader: &Shader) -> Option<Vec<[u8; 4]>> {
    let image;
    let theirs = match shader {
        Shader::LinearGradient(g) => ts::LinearGradient::new(
            point(g.start),
            point(g.end),
            stops(&g.stops),
            spread(g.spread),
            transform(g.transform),
        )?,
        Shader::RadialGradient(g) => ts::RadialGradient::new(
            point(g.start_center),
            g.start_radius,
            point(g.end_center),
            g.end_radius,
            stops(&g.stops),
            spread(g.spread),
            transform(g.transform),
        )?,
        Shader::SweepGradient(g) => ts::SweepGradient::new(
            point(g.center),
            g.start_angle,
            g.end_angle,
            stops(&g.stops),
            spread(g.spread),
            transform(g.transform),
        )?,
        Shader::Pattern(p) => {
            image = ts::PixmapRef::from_bytes(p.image.data(), p.image.width(), p.image.height())?;
            let quality = match p.quality {
                FilterQuality::Nearest => ts::FilterQuality::Nearest,
                FilterQuality::Bilinear => ts::FilterQuality::Bilinear,
                FilterQuality::Bicubic => ts::FilterQuality::Bicubic,
            };
            ts::Pattern::new(image, spread(p.spread_x), quality, 1.0, transform(p.transform))
        }
        Shader::Solid(_) => return None,
    };
    let mut pixmap = ts::Pixmap::new(SIZE as u32, SIZE as u32)?;
    let paint = ts::Paint { shader: theirs, anti_alias: false, ..Default::default() };
    let everywhere = ts::Rect::from_xywh(0.0, 0.0, SIZE as f32, SIZE as f32)?;
    pixmap.fill_rect(everywhere, &paint, ts::Transform::identity(), None);
    let valid = |[r, g, b, a]: &[u8; 4]| [*r.min(a), *g.min(a), *b.min(a), *a];
    Some(pixmap.data().as_chunks::<4>().0.iter().map(valid).collect())
}

/// Whether the formula jumps or is very steep near the pixel's centre, so that rounding errors decide.
fn is_steep(shader: &Shader, k: usize) -> bool {
    let (x, y) = ((k % SIZE) as f64 + 0.5, (k / SIZE) as f64 + 0.5);
    // tiny-skia's arc tangent is coarser than the rest of its arithmetic.
    let h = if matches!(shader, Shader::SweepGradient(_)) { 0.05 } else { 5e-3 };
    let near = [(0.0, 0.0), (h, h), (-h, h), (h, -h), (-h, -h)]
        .map(|(dx, dy)| oracle::color(shader, Transform::IDENTITY, 1.0, x + dx, y + dy));
    near.iter().any(|c| (0..4).any(|channel| (c[channel] - near[0][channel]).abs() > 1.0))
}

/// The largest difference that is allowed, or `None` where tiny-skia means something else:
///
/// | what | limit | why |
/// |---|---|---|
/// | opaque gradients, nearest | 1 | both round to nearest from different arithmetic |
/// | bilinear | 2 | our weights are in 1/256, and neighbours of full contrast show it |
/// | translucent gradients | 2 | tiny-skia premultiplies in 16 bits and is up to 1.6 from the formula |
/// | bicubic | 2 | as above; where its colours exceed their alpha they are first cut down to it |
/// | patterns along seams | – | tiny-skia mixes other pixels than it weighs; few, and only where it is wrong |
/// | patterns moved only | – | tiny-skia takes the nearest pixel, even for half a pixel |
/// | sweeps that start at 0° or end a whole turn after it | – | tiny-skia 0.12 leaves out their scale |
/// | sweeps that start below 0° or end above 360° | – | tiny-skia takes no angle a turn further |
fn limit(shader: &Shader) -> Option<i32> {
    match shader {
        Shader::Pattern(p) if p.transform.is_translate() && p.quality != FilterQuality::Nearest => None,
        Shader::Pattern(p) if p.quality != FilterQuality::Nearest => Some(2),
        Shader::LinearGradient(g) => Some(gradient_limit(&g.stops)),
        Shader::RadialGradient(g) => Some(gradient_limit(&g.stops)),
        Shader::SweepGradient(g) => {
            let whole = g.start_angle == 0.0 && g.end_angle == 360.0;
            let (scaled, wrapped) = (g.start_angle != 0.0, g.start_angle < 0.0 || g.end_angle > 360.0);
            (whole || (scaled && !wrapped)).then_some(gradient_limit(&g.stops))
        }
        _ => Some(1),
    }
}

fn gradient_limit(stops: &[GradientStop]) -> i32 {
    if stops.iter().all(|stop| stop.color.a == 1.0) { 1 } else { 2 }
}

#[test]
fn random_paints_look_like_tiny_skias() {
    let mut random = Random(21);
    let mut compared = [0; 4];
    for round in 0..1200 {
        let mut shader = match round % 4 {
            0 => random.linear(),
            1 => random.radial(),
            2 => random.sweep(),
            _ => random.pattern().into(),
        };
        let mode = [SpreadMode::Pad, SpreadMode::Repeat, SpreadMode::Reflect][random.below(3)];
        match &mut shader {
            Shader::LinearGradient(g) => g.spread = mode,
            Shader::RadialGradient(g) => g.spread = mode,
            Shader::SweepGradient(g) => g.spread = mode,
            Shader::Pattern(p) => (p.spread_x, p.spread_y) = (mode, mode),
            Shader::Solid(_) => {}
        }
        let (Some(limit), Some(theirs)) = (limit(&shader), reference(&shader)) else { continue };
        let paint = PreparedPaint::new(&shader, Transform::IDENTITY, 1.0);
        let ours = render(&paint, SimdLevel::best(), [0, 0], [SIZE, SIZE]);
        let mut steep = 0;
        for (k, (ours, theirs)) in ours.iter().zip(&theirs).enumerate() {
            if ours.iter().zip(theirs).any(|(a, b)| (i32::from(*a) - i32::from(*b)).abs() > limit) {
                let (x, y) = (k % SIZE, k / SIZE);
                let truth = oracle::color(&shader, Transform::IDENTITY, 1.0, x as f64 + 0.5, y as f64 + 0.5);
                let error = |pixel: &[u8; 4]| {
                    pixel.iter().zip(truth).map(|(v, truth)| (f64::from(*v) - truth).abs()).fold(0.0, f64::max)
                };
                // A few pixels along an image's seams: tiny-skia rounds weights and indices apart.
                let seam = matches!(shader, Shader::Pattern(_)) && error(ours) < 1.5 && error(theirs) > 3.0;
                assert!(
                    seam || is_steep(&shader, k),
                    "round {round} ({x}, {y}): {ours:?}, tiny-skia {theirs:?}, truth {truth:?}\n{shader:?}"
                );
                steep += 1;
            }
        }
        assert!(steep < SIZE * SIZE / 20, "round {round}: {steep} pixels differ where the paint is steep\n{shader:?}");
        compared[round % 4] += 1;
    }
    assert!(compared.iter().all(|count| *count >= 100), "{compared:?}");
}
