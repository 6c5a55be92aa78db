//! The seed checklist's sampling and filtering: rows 14, 113, 115 and 121 to 126.

#![expect(clippy::disallowed_methods, reason = "compared with a tolerance, so that no machine's last bit matters")]

use rastrum::space::Accumulation;
use rastrum::{Antialias, Canvas, Color, FillRule, Paint, Path, Pixmap, Point, Segment, Shadow, Stroke, Transform};

use crate::oracle::area::{Place, area, coverage};
use crate::oracle::polygon::{Vertex, to_point};
use crate::oracle::spectrum::{convolve, product, signal, spectrum};
use crate::oracle::{Random, patch};

/// A drawing in black on nothing; its alpha is the coverage.
fn drawn(width: u32, height: u32, antialias: Antialias, draw: impl FnOnce(&mut Canvas<'_>, &Paint)) -> Pixmap {
    let mut canvas = Canvas::new(width, height).unwrap();
    draw(&mut canvas, &Paint::new(Color::BLACK).with_antialias(antialias));
    canvas.into_pixmap()
}

fn alpha(picture: &Pixmap, x: u32, y: u32) -> u8 {
    picture.pixel(x, y).unwrap()[3]
}

/// A triangle with corners on the rasterizer's grid of 1/256 pixel, as it is drawn and in `f64`.
fn triangle(random: &mut Random, size: i64) -> ([Point; 3], [Place; 3]) {
    let corners: [Vertex; 3] = [(); 3].map(|()| (random.within(0..size * 256), random.within(0..size * 256)));
    (corners.map(to_point), corners.map(|(x, y)| (x as f64 / 256.0, y as f64 / 256.0)))
}

/// The distance from a point to a segment.
fn distance(p: Place, a: Place, b: Place) -> f64 {
    let (dx, dy) = (b.0 - a.0, b.1 - a.1);
    let squared = dx * dx + dy * dy;
    let along = if squared > 0.0 { (((p.0 - a.0) * dx + (p.1 - a.1) * dy) / squared).clamp(0.0, 1.0) } else { 0.0 };
    let (x, y) = (p.0 - a.0 - dx * along, p.1 - a.1 - dy * along);
    (x * x + y * y).sqrt()
}

#[test]
fn s014_curves_to_segments() {
    let wide = |p: Point| (f64::from(p.x), f64::from(p.y));
    let mut random = Random::new(14);
    let (mut largest, mut lines) = (0.0_f64, 0);
    for size in [3, 30, 300, 3000].into_iter().cycle().take(400) {
        let mut point = || Point::new(random.within(0..size * 256) as f32, random.within(0..size * 256) as f32);
        let [a, b, c, d] = [(); 4].map(|()| point());
        let cubic = size % 9 != 0;
        let mut path = Path::new();
        path.move_to(a);
        if cubic {
            path.cubic_to(b, c, d)
        } else {
            path.quad_to(b, d)
        };
        // In device pixels, after the transform, the lines are as near as they are said to be.
        let flat = path.flattened(Transform::from_scale(1.0 / 256.0, 1.0 / 256.0));
        let mut corners = Vec::new();
        for segment in flat.segments() {
            match segment {
                Segment::MoveTo(p) | Segment::LineTo(p) => corners.push(wide(p)),
                Segment::Close => {}
                other => panic!("{other:?} is no line"),
            }
        }
        lines += corners.len();
        // Lines are cut at equal parameters, in order: a point of the curve is near one of three.
        let pieces = corners.len() - 1;
        for step in 0..=1000 {
            let t = f64::from(step) / 1000.0;
            let u = 1.0 - t;
            let on = |a: f32, b: f32, c: f32, d: f32| {
                let [a, b, c, d] = [a, b, c, d].map(f64::from);
                let value = if cubic {
                    a * u * u * u + 3.0 * b * u * u * t + 3.0 * c * u * t * t + d * t * t * t
                } else {
                    a * u * u + 2.0 * b * u * t + d * t * t
                };
                value / 256.0
            };
            let p = (on(a.x, b.x, c.x, d.x), on(a.y, b.y, c.y, d.y));
            let near = (t * pieces as f64) as usize;
            let nearest = (near.saturating_sub(1)..(near + 2).min(pieces))
                .map(|i| distance(p, corners[i], corners[i + 1]))
                .fold(f64::MAX, f64::min);
            largest = largest.max(nearest);
        }
    }
    println!("curves: largest distance {largest:.4} px, {} lines a curve", lines / 400);
    assert!(largest <= 0.1, "{largest} px");
    assert!(lines / 400 < 100, "{lines} lines are too many");
}

/// The surfaces' half of row 14. The triangles are the test's own: what is checked is the bound by which a
/// surface is cut.
#[test]
fn s014_curved_surfaces_to_triangles() {
    let mut random = Random::new(1014);
    for size in [1, 20, 200].into_iter().cycle().take(30) {
        let mut coordinate = || random.within(-size * 256..size * 256) as f64 / 256.0;
        let surface: patch::Patch = [(); 4].map(|()| [(); 4].map(|()| [(); 3].map(|()| coordinate())));
        let n = patch::pieces(&surface, 0.1);
        assert_eq!(patch::triangles(n).count(), 2 * n * n);
        for triangle in patch::triangles(n) {
            let corners = triangle.map(|(u, v)| patch::at(&surface, u, v));
            for weights in [[0.5, 0.5, 0.0], [0.5, 0.0, 0.5], [0.0, 0.5, 0.5], [1.0 / 3.0; 3], [0.6, 0.2, 0.2]] {
                let mix = |values: [f64; 3]| (0..3).map(|i| values[i] * weights[i]).sum::<f64>();
                let on = patch::at(&surface, mix(triangle.map(|c| c.0)), mix(triangle.map(|c| c.1)));
                let flat = [0, 1, 2].map(|axis| mix(corners.map(|c| c[axis])));
                let apart = patch::length([0, 1, 2].map(|axis| on[axis] - flat[axis]));
                assert!(apart <= 0.1, "{apart} with {n} pieces a side");
            }
        }
        // A patch that begins in this one's last row shares its border, to the last bit: no gap can open.
        let mut next = surface;
        next.reverse();
        for i in 0..=n {
            let u = i as f64 / n as f64;
            assert_eq!(patch::at(&surface, u, 1.0), patch::at(&next, u, 0.0));
        }
    }
}

#[test]
fn s113_ssaa_is_the_box_average_of_the_larger_render() {
    const SIZE: u32 = 24;
    let mut random = Random::new(113);
    for n in 1..=16_u8 {
        for rule in [FillRule::NonZero, FillRule::EvenOdd] {
            let corners: Vec<Vertex> =
                (0..7).map(|_| (random.within(0..24 * 256), random.within(0..24 * 256))).collect();
            let points: Vec<Point> = corners.iter().copied().map(to_point).collect();
            let sampled = drawn(SIZE, SIZE, Antialias::Supersample(n), |canvas, paint| {
                canvas.fill_polygon(&points, rule, paint);
            });
            let factor = u32::from(n);
            let larger = drawn(SIZE * factor, SIZE * factor, Antialias::None, |canvas, paint| {
                canvas.scale(f32::from(n), f32::from(n));
                canvas.fill_polygon(&points, rule, paint);
            });
            let mut partial = 0;
            for y in 0..SIZE {
                for x in 0..SIZE {
                    let inside = (0..factor * factor)
                        .filter(|i| alpha(&larger, x * factor + i % factor, y * factor + i / factor) == 255)
                        .count();
                    let average = (inside as f64 * 255.0 / f64::from(factor * factor) + 0.5).floor();
                    assert_eq!(f64::from(alpha(&sampled, x, y)), average, "{n} × {n} at {x}, {y} of {corners:?}");
                    partial += u32::from(average > 0.0 && average < 255.0);
                }
            }
            assert!(partial > 20 || n == 1, "hardly an edge");
        }
    }
}

#[test]
fn s115_sample_positions() {
    assert_eq!(Antialias::None.sample_positions(), [(0.5, 0.5)]);
    assert_eq!(Antialias::Supersample(1).sample_positions(), [(0.5, 0.5)]);
    assert_eq!(Antialias::Supersample(2).sample_positions(), [(0.25, 0.25), (0.75, 0.25), (0.25, 0.75), (0.75, 0.75)]);
    assert_eq!(Antialias::Supersample(0).sample_positions().len(), 1);
    assert_eq!(Antialias::Supersample(255).sample_positions().len(), 256);
    assert!(Antialias::Analytic.sample_positions().is_empty() && Antialias::Exact.sample_positions().is_empty());
    // The table against the pixels: pixel (x, y) gets a square of 1/256 at (x, y) / 256 inside itself, and shows it
    // where a sample lies in the square.
    let modes = [Antialias::None].into_iter().chain((1..=16).map(Antialias::Supersample));
    for antialias in modes {
        let picture = drawn(256, 256, antialias, |canvas, paint| {
            for y in 0..256_i64 {
                for x in 0..256_i64 {
                    let (left, top) = (x * 257, y * 257);
                    let square = [(left, top), (left + 1, top), (left + 1, top + 1), (left, top + 1)];
                    canvas.fill_polygon(&square.map(to_point), FillRule::NonZero, paint);
                }
            }
        });
        let cell = |(x, y): (f32, f32)| ((x * 256.0).floor() as u32, (y * 256.0).floor() as u32);
        let mut expected: Vec<_> = antialias.sample_positions().into_iter().map(cell).collect();
        let one = (255.0 / expected.len() as f32).round() as u8;
        let mut found = Vec::new();
        for (x, y) in (0..256).flat_map(|y| (0..256).map(move |x| (x, y))) {
            let alpha = alpha(&picture, x, y);
            assert!(alpha == 0 || alpha == one, "{antialias:?}: {alpha} at {x}, {y}");
            if alpha > 0 {
                found.push((x, y));
            }
        }
        expected.sort_unstable_by_key(|(x, y)| (*y, *x));
        assert_eq!(found, expected, "{antialias:?}");
    }
}

#[test]
fn s121_coverage_alpha_of_lines_and_edges() {
    let sum = |picture: &Pixmap| picture.data().as_chunks::<4>().0.iter().map(|p| f64::from(p[3])).sum::<f64>() / 255.0;
    let (near, far) = ((14.3_f32, 12.6_f32), 30.0_f32);
    for antialias in [Antialias::Analytic, Antialias::Exact] {
        for step in 0..24_u8 {
            let angle = f32::from(step) * 0.27;
            let end = (40.0 + far * angle.cos(), 40.0 + far * angle.sin());
            let from = (40.0 - near.0 * angle.cos(), 40.0 - near.1 * angle.sin());
            let length = ((end.0 - from.0).powi(2) + (end.1 - from.1).powi(2)).sqrt();
            for width in [0.7, 1.0, 3.3] {
                let picture = drawn(80, 80, antialias, |canvas, paint| {
                    canvas.draw_line(from, end, &Stroke::new(width), paint);
                });
                let truth = f64::from(length * width);
                assert!((sum(&picture) / truth - 1.0).abs() < 0.02, "{antialias:?} {step} {width}: {}", sum(&picture));
            }
            // An edge: half of a square that turns.
            let corner = |turn: f32| {
                let angle = angle + turn;
                (40.0 + far * angle.cos(), 40.0 + far * angle.sin())
            };
            let corners = [corner(0.0), corner(1.7), corner(3.0)];
            let picture = drawn(80, 80, antialias, |canvas, paint| {
                canvas.fill_polygon(&corners.map(Point::from), FillRule::NonZero, paint);
            });
            let truth = area(&corners.map(|(x, y)| (f64::from(x), f64::from(y)))).abs();
            assert!((sum(&picture) / truth - 1.0).abs() < 0.02, "{antialias:?} {step}: {}, not {truth}", sum(&picture));
            // The fragment's alpha is what blends: over white, black leaves the rest.
            let mut over = Canvas::new(80, 80).unwrap();
            over.clear(Color::WHITE);
            let paint = Paint::new(Color::BLACK).with_antialias(antialias);
            over.fill_polygon(&corners.map(Point::from), FillRule::NonZero, paint);
            let over = over.into_pixmap();
            for (on_nothing, on_white) in picture.data().as_chunks::<4>().0.iter().zip(over.data().as_chunks::<4>().0) {
                let rest = 255 - on_nothing[3];
                assert_eq!(*on_white, [rest, rest, rest, 255]);
            }
        }
    }
}

#[test]
fn s122_box_filter() {
    // Half of a pixel is half of 255, whichever half it is.
    let halves: [[(f32, f32); 4]; 4] = [
        [(1.0, 1.0), (1.5, 1.0), (1.5, 2.0), (1.0, 2.0)],
        [(1.0, 1.5), (2.0, 1.5), (2.0, 2.0), (1.0, 2.0)],
        [(1.0, 1.0), (2.0, 2.0), (1.0, 2.0), (1.0, 1.0)],
        [(1.25, 1.0), (1.75, 1.0), (1.75, 2.0), (1.25, 2.0)],
    ];
    for antialias in [Antialias::Analytic, Antialias::Exact] {
        for half in halves {
            let picture = drawn(3, 3, antialias, |canvas, paint| {
                canvas.fill_polygon(&half.map(Point::from), FillRule::NonZero, paint);
            });
            assert_eq!(alpha(&picture, 1, 1), 128, "{half:?}");
            assert_eq!(picture.data().iter().filter(|v| **v != 0).count(), 1, "{half:?}");
        }
        // The analytic area of every pixel, to a step of the 255.
        let mut random = Random::new(122);
        let mut largest = 0.0_f64;
        for _ in 0..300 {
            let (points, places) = triangle(&mut random, 20);
            let picture =
                drawn(20, 20, antialias, |canvas, paint| canvas.fill_polygon(&points, FillRule::NonZero, paint));
            for y in 0..20 {
                for x in 0..20 {
                    let error = f64::from(alpha(&picture, x, y)) - coverage(&places, x, y) * 255.0;
                    largest = largest.max(error.abs());
                }
            }
        }
        println!("{antialias:?}: largest error {largest:.3} / 255");
        // Half a step is the rounding of the value itself.
        assert!(largest <= 1.5, "{antialias:?}: {largest} / 255");
    }
}

/// Upright stripes of half a period each, `period` pixels apart, 220 pixels wide and one high.
fn stripes(period: f32, antialias: Antialias) -> Vec<f64> {
    let picture = drawn(220, 1, antialias, |canvas, paint| {
        let mut path = Path::new();
        for i in 0..(220.0 / period) as u32 + 1 {
            path.rect(rastrum::Rect::from_xywh(i as f32 * period, 0.0, period / 2.0, 1.0));
        }
        canvas.fill_path(&path, FillRule::NonZero, paint);
    });
    (0..220).map(|x| f64::from(alpha(&picture, x, 0)) / 255.0).collect()
}

/// The energy of a signal besides its mean.
fn energy(signal: &[f64]) -> f64 {
    spectrum(signal).iter().skip(1).map(|v| v.0 * v.0 + v.1 * v.1).sum::<f64>() / (signal.len() as f64).powi(2)
}

/// A box of `size` samples around the first, of a signal that goes around.
fn box_kernel(size: usize, length: usize) -> Vec<f64> {
    let mut kernel = vec![0.0; length];
    for i in 0..size {
        kernel[(length + i - size / 2) % length] = 1.0 / size as f64;
    }
    kernel
}

#[test]
fn s123_filter_before_sampling() {
    // Stripes finer than pixels can show: whatever varies in the picture is an alias. The filter before is a box of one
    // pixel, the one after a box of three, and still it comes too late.
    for period in [1.1, 1.25, 0.95, 0.9, 0.8] {
        let filtered_first = energy(&stripes(period, Antialias::Analytic));
        let samples = stripes(period, Antialias::None);
        let sampled_first = energy(&convolve(&samples, &box_kernel(3, samples.len())));
        println!("period {period}: {filtered_first:.5} filtered first, {sampled_first:.5} sampled first");
        assert!(sampled_first > 0.005, "no alias to begin with: {sampled_first}");
        assert!(filtered_first < sampled_first / 2.0, "{period}: {filtered_first}, {sampled_first}");
    }
}

#[test]
fn s124_convolution_is_multiplication_of_spectra() {
    let multiply = |a: &[f64], b: &[f64]| {
        signal(&spectrum(a).into_iter().zip(spectrum(b)).map(|(a, b)| product(a, b)).collect::<Vec<_>>())
    };
    let close = |a: &[f64], b: &[f64], tolerance: f64| {
        for (a, b) in a.iter().zip(b) {
            assert!((a - b).abs() <= tolerance, "{a}, not {b}");
        }
    };
    let mut random = Random::new(124);
    for length in [1, 2, 7, 64, 220] {
        let mut noise = || (0..length).map(|_| random.within(-1000..1000) as f64 / 1000.0).collect::<Vec<_>>();
        let (a, b) = (noise(), noise());
        close(&signal(&spectrum(&a)), &a, 1e-9);
        close(&multiply(&a, &b), &convolve(&a, &b), 1e-5);
    }
    let picture = stripes(9.7, Antialias::Analytic);
    for size in [1, 3, 8] {
        let kernel = box_kernel(size, picture.len());
        close(&multiply(&picture, &kernel), &convolve(&picture, &kernel), 1e-5);
    }
    // The library's own convolution, a shadow's blur, multiplies the spectrum by that of a Gaussian: to the rounding of
    // its bytes, once along each axis.
    let (length, deviation) = (96, 1.5);
    let blurred = drawn(length, 33, Antialias::Analytic, |canvas, paint| {
        canvas.set_shadow(Shadow { offset_x: 0.0, offset_y: 33.0, deviation, color: Color::BLACK });
        // Above the canvas, high enough that the row in the middle knows of no end.
        canvas.fill_rect(rastrum::Rect::from_ltrb(30.25, -33.0, 47.5, 0.0), paint);
    });
    let shape = drawn(length, 1, Antialias::Analytic, |canvas, paint| {
        canvas.fill_rect(rastrum::Rect::from_ltrb(30.25, 0.0, 47.5, 1.0), paint);
    });
    let row = |picture: &Pixmap, y| (0..length).map(|x| f64::from(alpha(picture, x, y))).collect::<Vec<_>>();
    let weight = |at: u32| {
        let at = f64::from(at.min(length - at));
        (-at * at / (2.0 * f64::from(deviation).powi(2))).exp()
    };
    let total: f64 = (0..length).map(weight).sum();
    let kernel: Vec<f64> = (0..length).map(|at| weight(at) / total).collect();
    close(&row(&blurred, 16), &multiply(&row(&shape, 0), &kernel), 2.0);
}

#[test]
fn s125_the_error_falls_as_the_samples_grow() {
    let error = |antialias: Antialias| {
        let mut random = Random::new(125);
        let (mut sum, mut count) = (0.0, 0.0);
        for _ in 0..60 {
            let (points, places) = triangle(&mut random, 24);
            let picture =
                drawn(24, 24, antialias, |canvas, paint| canvas.fill_polygon(&points, FillRule::NonZero, paint));
            for (x, y) in (0..24).flat_map(|y| (0..24).map(move |x| (x, y))) {
                let truth = coverage(&places, x, y);
                if truth > 0.0 && truth < 1.0 {
                    sum += (f64::from(alpha(&picture, x, y)) / 255.0 - truth).abs();
                    count += 1.0;
                }
            }
        }
        sum / count
    };
    let errors: Vec<f64> = [1, 2, 4, 8, 16].map(|n| error(Antialias::Supersample(n))).to_vec();
    println!("mean errors: {errors:.4?}, analytic {:.4}", error(Antialias::Analytic));
    for pair in errors.windows(2) {
        assert!(pair[1] < pair[0] * 0.75, "{errors:?}");
    }
    // The limit of ever more samples is the area.
    assert!(error(Antialias::Analytic) < errors[4], "{errors:?}");
}

/// A wheel of eight spokes that turns by 0.9 of the angle between two of them each frame seems to turn backwards by 0.1;
/// the mean of pictures taken all through the frame's time does not.
#[test]
fn s126_temporal_supersampling_removes_the_wagon_wheels_backward_motion() {
    const SPOKES: f64 = 8.0;
    const TURN: f64 = 0.9;
    let wheel = |time: f64| -> Pixmap {
        let mut canvas = Canvas::new(96, 96).unwrap();
        for spoke in 0..8 {
            let angle = (f64::from(spoke) + TURN * time) / SPOKES * std::f64::consts::TAU;
            let tip = (48.0 + 44.0 * libm::cos(angle) as f32, 48.0 + 44.0 * libm::sin(angle) as f32);
            canvas.draw_line((48.0, 48.0), tip, &Stroke::new(6.0), Color::BLACK);
        }
        canvas.into_pixmap()
    };
    // How strong the pattern of eight spokes is around the hub, and where in its period it stands: 0 ..= 1.
    let pattern = |picture: &Pixmap| -> (f64, f64) {
        let (mut re, mut im) = (0.0, 0.0);
        for (index, pixel) in picture.data().as_chunks::<4>().0.iter().enumerate() {
            let (x, y) = ((index % 96) as f64 - 47.5, (index / 96) as f64 - 47.5);
            if (20.0..40.0).contains(&(x * x + y * y).sqrt()) {
                let angle = SPOKES * libm::atan2(y, x);
                re += f64::from(pixel[3]) * libm::cos(angle);
                im += f64::from(pixel[3]) * libm::sin(angle);
            }
        }
        ((re * re + im * im).sqrt(), libm::atan2(im, re) / std::f64::consts::TAU)
    };
    let motion = |from: f64, to: f64| (to - from + 1.5).rem_euclid(1.0) - 0.5;
    let (strength, start) = pattern(&wheel(0.0));
    let (_, next) = pattern(&wheel(1.0));
    assert!((motion(start, next) + 0.1).abs() < 0.01, "backwards by {}", motion(start, next));
    // At twice the rate it goes forwards: it was the sampling in time that turned it round.
    let (_, half) = pattern(&wheel(0.5));
    assert!((motion(start, half) - 0.45).abs() < 0.01, "{}", motion(start, half));
    let mut frame = Accumulation::new(96, 96).unwrap();
    for step in 0..32 {
        frame.add(&wheel((f64::from(step) + 0.5) / 32.0), 1).unwrap();
    }
    let (blurred, _) = pattern(&frame.average().unwrap());
    // Of a box over 0.9 of a period, sin(0.9 π) / 0.9 π = 0.109 of the pattern is left.
    assert!((blurred / strength - 0.109).abs() < 0.02, "{}", blurred / strength);
    // A shutter that is open for a whole period leaves nothing that could seem to turn.
    frame.clear();
    for step in 0..36 {
        frame.add(&wheel((f64::from(step) + 0.5) / 36.0 / TURN), 1).unwrap();
    }
    let (rest, _) = pattern(&frame.average().unwrap());
    assert!(rest < 0.01 * strength, "{}", rest / strength);
}
