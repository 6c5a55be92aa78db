//! Inputs without sense, and the promises that hold for every input: the same bytes at every level and
//! from every block, and no panic.

use std::sync::Arc;

use super::random::{QUALITIES, Random, SPREADS};
use super::render;
use crate::color::Color;
use crate::geom::{Point, Transform};
use crate::num::level::SimdLevel;
use crate::paint::prepare::PreparedPaint;
use crate::paint::{
    FilterQuality, GradientStop, LinearGradient, Pattern, RadialGradient, Shader, SpreadMode, SweepGradient,
};
use crate::surface::Pixmap;

const RED: [u8; 4] = [255, 0, 0, 255];
const BLUE: [u8; 4] = [0, 0, 255, 255];

fn red_to_blue() -> Vec<GradientStop> {
    vec![GradientStop::new(0.0, Color::RED), GradientStop::new(1.0, Color::BLUE)]
}

fn prepare(shader: impl Into<Shader>) -> PreparedPaint {
    PreparedPaint::new(&shader.into(), Transform::IDENTITY, 1.0)
}

fn is_nothing(shader: impl Into<Shader>) -> bool {
    matches!(prepare(shader), PreparedPaint::Nothing)
}

fn solid(shader: impl Into<Shader>) -> Option<[u8; 4]> {
    match prepare(shader) {
        PreparedPaint::Solid(pixel) => Some(pixel),
        _ => None,
    }
}

fn pixel(shader: impl Into<Shader>, x: i32, y: i32) -> [u8; 4] {
    render(&prepare(shader), SimdLevel::best(), [x, y], [1, 1])[0]
}

#[test]
fn paints_are_shared_between_threads() {
    fn check<T: Clone + Send + Sync>() {}
    check::<PreparedPaint>();
}

#[test]
fn every_level_gives_the_same_bytes() {
    let mut random = Random(7);
    for round in 0..600 {
        let shader = random.shader();
        let paint = PreparedPaint::new(&shader, random.transform(), random.range(0.5, 1.5));
        let pictures: Vec<_> =
            SimdLevel::available().iter().map(|level| render(&paint, *level, [-7, 3], [64, 40])).collect();
        assert!(pictures.windows(2).all(|two| two[0] == two[1]), "round {round}: {shader:?}");
    }
}

#[test]
fn a_pixel_does_not_depend_on_its_block() {
    let mut random = Random(8);
    for round in 0..600 {
        let shader = random.shader();
        let paint = PreparedPaint::new(&shader, random.transform(), 1.0);
        let whole = render(&paint, SimdLevel::best(), [-7, 3], [64, 40]);
        let (dx, dy) = (1 + random.below(15), 1 + random.below(7));
        let part = render(&paint, SimdLevel::best(), [-7 + dx as i32, 3 + dy as i32], [64 - dx, 40 - dy]);
        for (k, pixel) in part.iter().enumerate() {
            let (x, y) = (k % (64 - dx) + dx, k / (64 - dx) + dy);
            assert_eq!(*pixel, whole[y * 64 + x], "round {round} ({x}, {y}): {shader:?}");
        }
    }
}

#[test]
fn opaque_means_opaque() {
    let mut random = Random(9);
    let mut seen = 0;
    for _ in 0..600 {
        let shader = random.shader();
        let paint = PreparedPaint::new(&shader, random.transform(), 1.0);
        if paint.is_opaque() {
            seen += 1;
            let pixels = render(&paint, SimdLevel::best(), [-40, -40], [128, 128]);
            assert!(pixels.iter().all(|pixel| pixel[3] == 255), "{shader:?}");
        }
    }
    assert!(seen > 50, "only {seen} opaque paints");
    assert!(prepare(LinearGradient::new((0.0, 0.0), (9.0, 2.0), red_to_blue())).is_opaque());
    let faded = PreparedPaint::new(&Shader::Solid(Color::RED), Transform::IDENTITY, 0.5);
    assert!(!faded.is_opaque());
}

#[test]
fn stops_without_sense() {
    let line = |stops: Vec<GradientStop>| LinearGradient::new((0.0, 0.0), (100.0, 0.0), stops);
    assert!(is_nothing(line(vec![])));
    assert_eq!(solid(line(vec![GradientStop::new(0.7, Color::RED)])), Some(RED));
    assert_eq!(solid(line(vec![GradientStop::new(0.7, Color::RED)]).with_spread(SpreadMode::Decal)), Some(RED));
    // NaN is 0; a position before its predecessor's is raised to it; the later of two wins from there on.
    let stops = vec![
        GradientStop::new(f32::NAN, Color::RED),
        GradientStop::new(0.5, Color::RED),
        GradientStop::new(0.25, Color::BLUE),
        GradientStop::new(7.0, Color::BLUE),
    ];
    assert_eq!(pixel(line(stops.clone()), 49, 0), RED);
    assert_eq!(pixel(line(stops), 50, 0), BLUE);
    // All at one place, and at either end.
    for position in [0.0, 0.5, 1.0] {
        let stops = vec![GradientStop::new(position, Color::RED), GradientStop::new(position, Color::BLUE)];
        let edge = (position * 100.0) as i32;
        assert_eq!(pixel(line(stops.clone()), edge - 1, 0), RED, "{position}");
        assert_eq!(pixel(line(stops), edge, 0), BLUE, "{position}");
    }
    let invisible = vec![GradientStop::new(0.0, Color::TRANSPARENT), GradientStop::new(1.0, Color::TRANSPARENT)];
    assert_eq!(solid(line(invisible)), Some([0; 4]));
}

#[test]
fn a_hard_stop_wins_at_its_very_position() {
    // The pixel centre 50.5 lies exactly at 0.5.
    let stops = vec![GradientStop::new(0.5, Color::RED), GradientStop::new(0.5, Color::BLUE)];
    let gradient = LinearGradient::new((0.5, 0.0), (100.5, 0.0), stops);
    assert_eq!(pixel(gradient.clone(), 49, 0), RED);
    assert_eq!(pixel(gradient, 50, 0), BLUE);
}

#[test]
fn geometry_without_extent() {
    let line = |a: (f32, f32), b: (f32, f32)| LinearGradient::new(a, b, red_to_blue());
    assert_eq!(solid(line((5.0, 5.0), (5.0, 5.0))), Some(BLUE));
    assert_eq!(solid(line((5.0, 5.0), (5.0, 5.0)).with_spread(SpreadMode::Repeat)), Some(BLUE));
    assert!(is_nothing(line((f32::NAN, 0.0), (5.0, 5.0))));
    assert!(is_nothing(line((0.0, 0.0), (f32::INFINITY, 5.0))));
    assert!(is_nothing(line((0.0, 0.0), (5.0, 5.0)).with_transform(Transform::from_scale(0.0, 1.0))));
    let singular = PreparedPaint::new(&line((0.0, 0.0), (5.0, 5.0)).into(), Transform::from_scale(1.0, 0.0), 1.0);
    assert!(matches!(singular, PreparedPaint::Nothing));

    let circles = |r0: f32, x1: f32, r1: f32| RadialGradient::two_point((0.0, 0.0), r0, (x1, 0.0), r1, red_to_blue());
    assert!(is_nothing(circles(5.0, 0.0, 5.0)));
    assert!(is_nothing(circles(0.0, 9.0, 0.0)));
    assert!(is_nothing(circles(-1.0, 9.0, 5.0)));
    assert!(is_nothing(circles(1.0, 9.0, f32::NAN)));
    assert!(is_nothing(circles(f32::INFINITY, 9.0, 5.0)));

    let sweep = |a: f32, b: f32| SweepGradient::new((0.0, 0.0), red_to_blue()).with_angles(a, b);
    assert!(is_nothing(sweep(90.0, 90.0)));
    assert!(is_nothing(sweep(90.0, 10.0)));
    assert!(is_nothing(sweep(f32::NAN, 10.0)));
}

#[test]
fn one_circle_outside_the_other_leaves_holes() {
    let cone = RadialGradient::two_point((0.0, 0.0), 1.0, (50.0, 0.0), 10.0, red_to_blue());
    assert_eq!(pixel(cone.clone(), 100, 0), BLUE, "in front, padded");
    assert_eq!(pixel(cone.clone(), 10, 90), [0; 4], "beside");
    assert_eq!(pixel(cone.clone(), -40, 0), [0; 4], "behind the tip");
    let mut same = cone;
    same.stops = vec![GradientStop::new(0.0, Color::RED), GradientStop::new(1.0, Color::RED)].into();
    assert_eq!(pixel(same.clone(), 10, 90), [0; 4]);
    assert_eq!(pixel(same, 10, 0), RED);
}

#[test]
fn angles_a_whole_turn_apart_are_one() {
    let quarter = |a: f32, b: f32| SweepGradient::new((0.0, 0.0), red_to_blue()).with_angles(a, b);
    for (start, end) in [(-90.0, 270.0), (270.0, 630.0), (990.0, 1350.0)] {
        // Straight up is the start, a hair to the right of it early, a hair to the left late.
        assert!(pixel(quarter(start, end), 1, -2000)[0] > 250, "{start}");
        assert!(pixel(quarter(start, end), -2, -2000)[2] > 250, "{start}");
    }
}

#[test]
fn one_pixel_is_a_colour() {
    let image = Arc::new(Pixmap::from_vec(1, 1, vec![9, 8, 7, 255]).unwrap());
    let mut random = Random(10);
    for quality in QUALITIES {
        for spread in [SpreadMode::Pad, SpreadMode::Repeat, SpreadMode::Reflect] {
            let transform = random.transform();
            let pattern = Pattern::new(image.clone()).with_quality(quality).with_spread(spread);
            let paint = prepare(pattern.with_transform(transform));
            let pixels = render(&paint, SimdLevel::best(), [-20, -20], [40, 40]);
            // The cubic's weights add up to 1 but for their last bits.
            assert!(pixels.iter().all(|pixel| *pixel == [9, 8, 7, 255]), "{quality:?} {spread:?} {transform:?}");
        }
    }
}

#[test]
fn whole_moves_copy_pixels_at_every_quality() {
    let mut random = Random(11);
    let image = random.image(40, 20, false);
    for quality in QUALITIES {
        let pattern = Pattern::new(image.clone()).with_quality(quality).with_spread(SpreadMode::Decal);
        let paint = prepare(pattern.with_transform(Transform::from_translate(-3.0, 5.0)));
        let pixels = render(&paint, SimdLevel::best(), [0, 0], [48, 32]);
        for (k, found) in pixels.iter().enumerate() {
            let (x, y) = (k as u32 % 48 + 3, (k as u32 / 48).wrapping_sub(5));
            assert_eq!(*found, image.pixel(x, y).unwrap_or_default(), "{quality:?} {k}");
        }
    }
}

#[test]
fn wild_numbers_give_pixels_and_no_panic() {
    let wild = [0.0, -0.0, 1.0, -1.0, 0.5, 1e-30, 1e-45, 1e30, -1e30, f32::MAX, f32::MIN, f32::NAN, f32::INFINITY];
    let mut random = Random(12);
    let image = random.image(5, 3, false);
    for round in 0..4000 {
        let mut number =
            || if random.below(3) == 0 { wild[random.below(wild.len())] } else { random.range(-9.0, 99.0) };
        let transform = Transform::from_row(number(), number(), number(), number(), number(), number());
        let (p, q) = (Point::new(number(), number()), Point::new(number(), number()));
        let (a, b) = (number(), number());
        let stops = vec![
            GradientStop::new(number(), Color::from_rgba(number(), number(), number(), number())),
            GradientStop::new(number(), Color::from_rgba(number(), number(), number(), number())),
        ];
        let opacity = number();
        let spread = SPREADS[random.below(4)];
        let pattern = Pattern::new(image.clone()).with_quality(QUALITIES[random.below(3)]).with_spread(spread);
        let shaders: [Shader; 4] = [
            LinearGradient::new(p, q, stops.clone()).with_spread(spread).into(),
            RadialGradient::two_point(p, a, q, b, stops.clone()).with_spread(spread).into(),
            SweepGradient::new(p, stops).with_angles(a, b).with_spread(spread).into(),
            pattern.into(),
        ];
        for shader in shaders {
            let paint = PreparedPaint::new(&shader, transform, opacity);
            for corner in [[0, 0], [i32::MAX - 7, i32::MIN], [-32_000, 32_000]] {
                let pictures: Vec<_> =
                    SimdLevel::available().iter().map(|level| render(&paint, *level, corner, [16, 8])).collect();
                assert!(pictures.windows(2).all(|two| two[0] == two[1]), "round {round}: {shader:?} {transform:?}");
            }
        }
    }
}

#[test]
fn images_far_away_are_defined() {
    let mut random = Random(13);
    let image = random.image(4, 4, true);
    for quality in QUALITIES {
        let away = Transform::from_translate(1e30, -1e30);
        let pattern = Pattern::new(image.clone()).with_quality(quality).with_transform(away);
        let last = image.pixel(0, 3).unwrap();
        assert_eq!(pixel(pattern.clone().with_spread(SpreadMode::Pad), 3, 3), last, "{quality:?}");
        assert_eq!(pixel(pattern.clone().with_spread(SpreadMode::Decal), 3, 3), [0; 4], "{quality:?}");
        assert_eq!(pixel(pattern.with_spread(SpreadMode::Repeat), 3, 3)[3], 255, "{quality:?}");
    }
    let tiny = Transform::from_scale(1e-30, 1e-30);
    let pattern = Pattern::new(image).with_quality(FilterQuality::Nearest).with_transform(tiny);
    assert_eq!(pixel(pattern, 3, 3)[3], 255);
}
