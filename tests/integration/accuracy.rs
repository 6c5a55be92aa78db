//! Coverage against 64 × 64 samples a pixel, on self-crossing polygons.

use rastrum::{Antialias, Canvas, Color, FillRule, Paint, Path, Point, Rect};

const SIZE: usize = 208;

/// Sixteen polygons of twenty random corners within 200 pixels.
fn polygons(seed: u32) -> Vec<Vec<Point>> {
    random_polygons(seed, 16, 20)
}

fn random_polygons(mut seed: u32, count: usize, corners: usize) -> Vec<Vec<Point>> {
    let mut random = || {
        seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        4.0 + (seed >> 8) as f32 / 16_777_216.0 * 200.0
    };
    (0..count).map(|_| (0..corners).map(|_| Point::new(random(), random())).collect()).collect()
}

/// How many of each pixel's 64 × 64 samples lie inside by the even-odd rule.
fn samples(points: &[Point]) -> Vec<u32> {
    let mut covered = vec![0; SIZE * SIZE];
    for sample_row in 0..SIZE * 64 {
        let y = (sample_row as f64 + 0.5) / 64.0;
        let mut crossings: Vec<f64> = Vec::new();
        for (i, a) in points.iter().enumerate() {
            let b = points[(i + 1) % points.len()];
            let (ay, by) = (f64::from(a.y), f64::from(b.y));
            if (ay <= y) != (by <= y) {
                crossings.push(f64::from(a.x) + (f64::from(b.x) - f64::from(a.x)) * (y - ay) / (by - ay));
            }
        }
        crossings.sort_by(f64::total_cmp);
        for pair in crossings.as_chunks::<2>().0 {
            let sample = |x: f64| (x * 64.0 - 0.5).ceil() as usize;
            for column in sample(pair[0])..sample(pair[1]) {
                covered[sample_row / 64 * SIZE + column / 64] += 1;
            }
        }
    }
    covered
}

/// Signed areas in f64, folded by the even-odd rule: what summing areas gives without any rounding.
fn summed_areas(points: &[Point]) -> Vec<f64> {
    let mut sums = vec![0.0; SIZE * SIZE];
    for (i, a) in points.iter().enumerate() {
        let b = points[(i + 1) % points.len()];
        let (ax, ay, bx, by) = (f64::from(a.x), f64::from(a.y), f64::from(b.x), f64::from(b.y));
        let (x0, y0, x1, y1, sign) = if ay < by { (ax, ay, bx, by, 1.0) } else { (bx, by, ax, ay, -1.0) };
        let at = |y: f64| x0 + (x1 - x0) * (y - y0) / (y1 - y0);
        for row in y0.floor() as usize..y1.ceil() as usize {
            let (top, bottom) = (y0.max(row as f64), y1.min(row as f64 + 1.0));
            let (left, right) = (at(top).min(at(bottom)), at(top).max(at(bottom)));
            for column in 0..SIZE {
                // The mean over the piece's height of how much of the pixel lies right of it.
                let edge = column as f64 + 1.0;
                let covered = |x: f64| (edge - x).clamp(0.0, 1.0);
                let mean = if right - left < 1e-9 {
                    covered(left)
                } else {
                    // The integral of covered() is quadratic in pieces.
                    let integral = |x: f64| {
                        if x <= edge - 1.0 {
                            x
                        } else if x <= edge {
                            edge - 1.0 + (1.0 - (edge - x) * (edge - x)) / 2.0
                        } else {
                            edge - 0.5
                        }
                    };
                    (integral(right) - integral(left)) / (right - left)
                };
                sums[row * SIZE + column] += sign * mean * (bottom - top);
            }
        }
    }
    sums.iter().map(|sum| (sum.rem_euclid(2.0) - 1.0).abs()).map(|outside| 1.0 - outside).collect()
}

fn render(points: &[Point], antialias: Antialias) -> Vec<f64> {
    let mut canvas = Canvas::new(SIZE as u32, SIZE as u32).unwrap();
    canvas.clear(Color::WHITE);
    canvas.fill_polygon(points, FillRule::EvenOdd, Paint::new(Color::BLACK).with_antialias(antialias));
    canvas.into_pixmap().data().as_chunks::<4>().0.iter().map(|pixel| (255.0 - f64::from(pixel[0])) / 255.0).collect()
}

/// Errors of the edge pixels in 1/255.
#[derive(Default)]
struct Errors {
    sum: f64,
    count: f64,
    above16: f64,
    largest: f64,
}

impl Errors {
    fn add(&mut self, coverage: &[f64], truth: &[u32]) {
        for (coverage, truth) in coverage.iter().zip(truth) {
            if *truth > 0 && *truth < 4096 {
                let error = (coverage * 255.0 - f64::from(*truth) * 255.0 / 4096.0).abs();
                self.sum += error;
                self.count += 1.0;
                self.above16 += f64::from(u8::from(error > 16.0));
                self.largest = self.largest.max(error);
            }
        }
    }

    fn mean(&self) -> f64 {
        self.sum / self.count
    }

    fn print(&self, name: &str) {
        let share = self.above16 / self.count * 100.0;
        println!("{name}: mean {:.3}, above 16 {share:.3} %, largest {:.0}", self.mean(), self.largest);
    }
}

/// Five sets of polygons, since sets differ: no rasterizer that sums areas can do better on them than the sums in
/// f64 do, rounded to bytes, and those lie between 1.06 and 1.34.
#[test]
fn coverage_of_self_crossing_polygons() {
    let [mut areas, mut analytic, mut exact, mut sampled] = [(); 4].map(|()| Errors::default());
    for points in (1..=5).flat_map(polygons) {
        let truth = samples(&points);
        let rounded: Vec<f64> = summed_areas(&points).iter().map(|area| (area * 255.0).round() / 255.0).collect();
        areas.add(&rounded, &truth);
        analytic.add(&render(&points, Antialias::Analytic), &truth);
        exact.add(&render(&points, Antialias::Exact), &truth);
        sampled.add(&render(&points, Antialias::Supersample(4)), &truth);
    }
    areas.print("areas in f64, rounded to bytes");
    analytic.print("Analytic");
    exact.print("Exact");
    sampled.print("Supersample(4)");
    assert!(analytic.mean() <= 1.3 && analytic.mean() <= areas.mean() + 0.06);
    assert!(exact.mean() <= 0.4 && exact.above16 == 0.0 && exact.largest <= 4.0);
    assert!(analytic.mean() < sampled.mean());
}

/// Discs of 2 to 90 pixels of radius: what flattening and 24.8 positions leave of them, against 64 × 64 samples of the
/// disc itself.
#[test]
fn coverage_of_discs() {
    let (mut ours, mut theirs) = (Errors::default(), Errors::default());
    for step in 0..40 {
        let radius = 2.0 + 2.2 * step as f32;
        let (x, y) = (104.0 + 0.37 * step as f32 % 1.0, 104.0 + 0.73 * step as f32 % 1.0);
        let mut truth = vec![0; SIZE * SIZE];
        for row in 0..SIZE * 64 {
            let dy = (row as f64 + 0.5) / 64.0 - f64::from(y);
            let half = (f64::from(radius) * f64::from(radius) - dy * dy).sqrt();
            if half > 0.0 {
                let sample = |x: f64| (x * 64.0 - 0.5).ceil() as usize;
                for column in sample(f64::from(x) - half)..sample(f64::from(x) + half) {
                    truth[row / 64 * SIZE + column / 64] += 1;
                }
            }
        }
        let mut canvas = Canvas::new(SIZE as u32, SIZE as u32).unwrap();
        canvas.fill_circle((x, y), radius, Color::BLACK);
        let coverage = |pixels: &[u8]| -> Vec<f64> {
            pixels.as_chunks::<4>().0.iter().map(|pixel| f64::from(pixel[3]) / 255.0).collect()
        };
        ours.add(&coverage(canvas.into_pixmap().data()), &truth);
        let mut pixmap = tiny_skia::Pixmap::new(SIZE as u32, SIZE as u32).unwrap();
        let circle = tiny_skia::PathBuilder::from_circle(x, y, radius).unwrap();
        let paint = tiny_skia::Paint { anti_alias: true, ..tiny_skia::Paint::default() };
        pixmap.fill_path(&circle, &paint, tiny_skia::FillRule::Winding, tiny_skia::Transform::identity(), None);
        theirs.add(&coverage(pixmap.data()), &truth);
    }
    ours.print("discs");
    theirs.print("discs by tiny-skia");
    // A cubic leaves the circle by 1/3,700 of its radius, and chords leave the cubic by 1/20 pixel at most.
    assert!(ours.mean() <= 3.0 && ours.largest <= 14.0 && ours.mean() * 4.0 < theirs.mean());
}

/// Coverage of one pixel by two rectangles of one path, whose corners lie elsewhere: no edge passes through it
/// but horizontal ones.
#[test]
fn exact_coverage_resolves_edges_along_a_row() {
    let mut path = Path::new();
    path.rect(Rect::from_ltrb(1.0, 5.25, 40.0, 9.0));
    path.rect(Rect::from_ltrb(3.0, 5.55, 38.0, 9.0));
    // In row 5 they cover 0.75 and 0.45: both together 0.75, one alone 0.3.
    for (rule, expected) in [(FillRule::EvenOdd, 77), (FillRule::NonZero, 191)] {
        let mut canvas = Canvas::new(48, 16).unwrap();
        canvas.fill_path(&path, rule, Paint::new(Color::BLACK).with_antialias(Antialias::Exact));
        let alpha = canvas.into_pixmap().pixel(20, 5).unwrap()[3];
        assert!(alpha.abs_diff(expected) <= 1, "{rule:?}: {alpha}, not {expected}");
    }
}

/// So many edges in a row that it is cut less finely: the error grows, but nothing leaks.
#[test]
fn exact_coverage_of_crowded_rows() {
    for corners in [150, 600] {
        let mut errors = Errors::default();
        for points in random_polygons(9, 1, corners) {
            errors.add(&render(&points, Antialias::Exact), &samples(&points));
        }
        errors.print(&format!("{corners} corners"));
        assert!(errors.mean() < 1.0 && errors.largest < 32.0, "{corners} corners");
    }
}

#[test]
fn shapes_that_leave_the_canvas_are_sampled_up_to_its_border() {
    for width in [5, 16, 17, 64] {
        for antialias in [Antialias::None, Antialias::Supersample(4), Antialias::Analytic] {
            let mut canvas = Canvas::new(width, 4).unwrap();
            let points = [(2.0, -3.0), (900.0, -3.0), (900.0, 9.0), (2.0, 9.0)].map(Point::from);
            canvas.fill_polygon(&points, FillRule::NonZero, Paint::new(Color::RED).with_antialias(antialias));
            let pixmap = canvas.into_pixmap();
            for (index, pixel) in pixmap.data().as_chunks::<4>().0.iter().enumerate() {
                let expected = if index % width as usize >= 2 { [255, 0, 0, 255] } else { [0; 4] };
                assert_eq!(*pixel, expected, "pixel {index} of {width} a row, {antialias:?}");
            }
        }
    }
}
