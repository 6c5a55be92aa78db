//! Every pixel of random paints within its limit of the formula.

use super::random::Random;
use super::{oracle, render};
use crate::geom::Transform;
use crate::num::level::SimdLevel;
use crate::paint::prepare::PreparedPaint;
use crate::paint::{FilterQuality, GradientStop, LinearGradient, Shader};

/// How far apart pixel and formula are at worst, over the block of size × size from `corner` on.
///
/// Where the formula jumps (hard stops, seams, rims of holes) a rounding error decides between the two
/// sides: the pixel is held against all values within a thousandth of a pixel.
fn worst(shader: &Shader, transform: Transform, opacity: f32, corner: [i32; 2], size: usize) -> (f64, String) {
    let paint = PreparedPaint::new(shader, transform, opacity);
    let pixels = render(&paint, SimdLevel::best(), corner, [size, size]);
    let mut worst = (0.0, String::new());
    for (k, pixel) in pixels.iter().enumerate() {
        let x = f64::from(corner[0]) + (k % size) as f64 + 0.5;
        let y = f64::from(corner[1]) + (k / size) as f64 + 0.5;
        let h = 1e-3;
        let near = [(0.0, 0.0), (h, 0.0), (-h, 0.0), (0.0, h), (0.0, -h)];
        let near = near.map(|(dx, dy)| oracle::color(shader, transform, f64::from(opacity), x + dx, y + dy));
        for channel in 0..4 {
            let low = near.iter().map(|c| c[channel]).fold(f64::INFINITY, f64::min);
            let high = near.iter().map(|c| c[channel]).fold(f64::NEG_INFINITY, f64::max);
            let value = f64::from(pixel[channel]);
            let error = (low - value).max(value - high);
            if error > worst.0 {
                worst = (error, format!("({x}, {y}) is {pixel:?}, not {:?}", near[0]));
            }
        }
        assert!(pixel[..3].iter().all(|v| *v <= pixel[3]), "{pixel:?} is not premultiplied");
    }
    worst
}

/// Limits on the distance to the unrounded truth. Rounding alone costs 0.5.
fn limit(shader: &Shader, opacity: f32) -> f64 {
    let filter = match shader {
        Shader::Pattern(pattern) => match pattern.quality {
            FilterQuality::Nearest => 0.5,
            // Weights in 1/256 and two roundings; noise of full contrast is the worst there is.
            FilterQuality::Bilinear => 2.0,
            FilterQuality::Bicubic => 0.51,
        },
        _ => 0.51,
    };
    // Patterns fade after they are rounded, by an opacity in 1/255.
    if opacity < 1.0 && matches!(shader, Shader::Pattern(_)) { filter + 1.0 } else { filter }
}

#[test]
fn random_paints_follow_the_formula() {
    let mut random = Random(1);
    for round in 0..1500 {
        let shader = random.shader();
        let transform = random.transform();
        let opacity = if random.below(3) == 0 { random.range(0.0, 1.0) } else { 1.0 };
        let corner = [random.below(60) as i32 - 10, random.below(60) as i32 - 10];
        let (error, place) = worst(&shader, transform, opacity, corner, 48);
        let limit = limit(&shader, opacity);
        assert!(error <= limit, "round {round}: {error} at {place}\n{shader:?}\n{transform:?} {opacity}");
    }
}

#[test]
fn linear_gradients_keep_their_accuracy_far_from_the_origin() {
    let mut random = Random(2);
    for round in 0..100 {
        let (x, y) = (random.range(20_000.0, 32_000.0), random.range(20_000.0, 32_000.0));
        let stops = random.stops(2);
        let end = (x + random.range(10.0, 40.0), y + random.range(-20.0, 20.0));
        let shader: Shader = LinearGradient::new((x, y), end, stops).into();
        let (error, place) = worst(&shader, Transform::IDENTITY, 1.0, [x as i32 - 8, y as i32 - 8], 48);
        assert!(error <= 0.52, "round {round}: {error} at {place}");
    }
}

#[test]
fn many_and_coincident_stops_are_exact() {
    let mut random = Random(3);
    for count in [3, 4, 5, 8, 9, 10, 20, 100] {
        for round in 0..20 {
            let mut stops: Vec<GradientStop> = (0..count)
                .map(|_| {
                    GradientStop::new(random.below(count) as f32 / (count - 1) as f32, random.color(round % 2 == 0))
                })
                .collect();
            stops.sort_by(|a, b| a.position.total_cmp(&b.position));
            let slant = (random.range(-9.0, 9.0), random.range(90.0, 110.0));
            let shader: Shader = LinearGradient::new((0.0, 0.0), slant, stops).into();
            let (error, place) = worst(&shader, Transform::IDENTITY, 1.0, [0, 0], 112);
            assert!(error <= 0.51, "{count} stops, round {round}: {error} at {place}\n{shader:?}");
        }
    }
}

#[test]
fn bilinear_noise_is_mostly_within_one() {
    let mut random = Random(4);
    let (mut sum, mut count) = (0.0, 0.0);
    for _ in 0..40 {
        let image = random.image(16, 16, true);
        let pattern = crate::paint::Pattern::new(image).with_transform(Transform::from_scale(1.5625, 1.5625));
        let shader: Shader = pattern.into();
        let pixels =
            render(&PreparedPaint::new(&shader, Transform::IDENTITY, 1.0), SimdLevel::best(), [0, 0], [25, 25]);
        for (k, pixel) in pixels.iter().enumerate() {
            let (x, y) = ((k % 25) as f64 + 0.5, (k / 25) as f64 + 0.5);
            let truth = oracle::color(&shader, Transform::IDENTITY, 1.0, x, y);
            for channel in 0..3 {
                sum += (f64::from(pixel[channel]) - truth[channel]).abs();
                count += 1.0;
            }
        }
    }
    // Rounding alone would give 0.25.
    assert!(sum / count < 0.4, "mean error {}", sum / count);
}
