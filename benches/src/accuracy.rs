//! Coverage of random shapes against 64 × 64 samples a pixel.
//!
//! Black on white, even-odd, on 208 × 208 pixels: polygons of twenty random corners, pages of glyphs as W11 has them, and pages
//! of larger outlines of cubics. Pixels on edges count, in 1/255 of coverage.

use crate::engines::Kind;
use crate::random::Random;
use crate::scene::{Point, Rule, Scene, Segment, Shape, segments};
use crate::workloads::{blob, polygon};

const SIDE: usize = 208;

/// Samples a pixel and axis.
const GRID: usize = 64;

/// How many chords stand for a curve in the truth: of the curves below they lie less than 0.005 px off.
const CHORDS: usize = 128;

/// Errors of edge pixels, in 1/255.
#[derive(Clone, Copy, Debug, Default)]
pub struct Errors {
    sum: f64,
    count: f64,
    above16: f64,
    pub max: f64,
}

impl Errors {
    pub fn mean(self) -> f64 {
        self.sum / self.count
    }

    /// Per cent of the edge pixels that are more than 16 off.
    pub fn above16(self) -> f64 {
        self.above16 / self.count * 100.0
    }
}

/// The errors of each engine on one kind of shape.
pub struct Accuracy {
    /// What is drawn, for the table, and its key in JSON.
    pub title: &'static str,
    pub key: &'static str,
    pub engines: Vec<(Kind, Errors)>,
}

/// The engines' accuracy on so many pictures of each kind of shape.
pub fn measure(kinds: &[Kind], pictures: usize) -> Vec<Accuracy> {
    let shapes: [(_, _, fn(&mut Random) -> Shape); 3] = [
        ("self-crossing polygons of 20 corners", "accuracy", corners),
        ("glyphs of 10-14 px", "accuracy_of_glyphs", glyphs),
        ("outlines of cubics, 40-80 px", "accuracy_of_cubics", cubics),
    ];
    shapes.map(|(title, key, shape)| Accuracy { title, key, engines: errors(kinds, pictures, shape) }).into()
}

fn errors(kinds: &[Kind], pictures: usize, shape: fn(&mut Random) -> Shape) -> Vec<(Kind, Errors)> {
    let mut results: Vec<(Kind, Errors)> = kinds.iter().map(|kind| (*kind, Errors::default())).collect();
    let mut random = Random::new(64);
    for _ in 0..pictures {
        let shape = shape(&mut random);
        let truth = samples(&contours(&segments(&shape)));
        let mut scene = Scene::new("shape", "", SIDE as u32);
        scene.fill(shape, Rule::EvenOdd, [0, 0, 0, 255]);
        for (kind, errors) in &mut results {
            let Some(mut engine) = kind.prepare(&scene, None) else { continue };
            engine.draw();
            for (pixel, truth) in engine.picture().as_chunks::<4>().0.iter().zip(&truth) {
                if (1..(GRID * GRID) as u32).contains(truth) {
                    let covered = f64::from(*truth) * 255.0 / (GRID * GRID) as f64;
                    let error = (255.0 - f64::from(pixel[0]) - covered).abs();
                    errors.sum += error;
                    errors.count += 1.0;
                    errors.above16 += f64::from(u8::from(error > 16.0));
                    errors.max = errors.max.max(error);
                }
            }
        }
    }
    results
}

fn corners(random: &mut Random) -> Shape {
    let corners: Vec<Point> = (0..20).map(|_| [random.within(4.0, 204.0), random.within(4.0, 204.0)]).collect();
    polygon(&corners)
}

/// A page of 13 × 13 glyphs.
fn glyphs(random: &mut Random) -> Shape {
    let mut path = Vec::new();
    for place in 0..169 {
        let (column, row) = ((place % 13) as f32, (place / 13) as f32);
        let height = random.within(10.0, 14.0);
        let width = height * random.within(0.45, 0.8);
        let center = [column * 16.0 + random.within(7.5, 8.5), row * 16.0 + random.within(7.5, 8.5)];
        blob(random, &mut path, 12, center, [width / 2.0, height / 2.0]);
        blob(random, &mut path, -8, center, [width / 5.0, height / 4.5]);
    }
    Shape::Path(path)
}

/// Four outlines of five cubics each: their ends lie 20 to 35 px from the middle, their control points 15 to 48.
fn cubics(random: &mut Random) -> Shape {
    let mut path = Vec::new();
    for place in 0..4 {
        let center = [(place % 2) as f32 * 104.0 + 52.0, (place / 2) as f32 * 104.0 + 52.0];
        let mut at = |step: usize, low: f32, high: f32| {
            let (angle, radius) = (step as f32 / 15.0 * std::f32::consts::TAU, random.within(low, high));
            [center[0] + radius * libm::cosf(angle), center[1] + radius * libm::sinf(angle)]
        };
        let start = at(0, 20.0, 35.0);
        path.push(Segment::Move(start));
        for curve in 0..5 {
            let (first, second) = (at(3 * curve + 1, 15.0, 48.0), at(3 * curve + 2, 15.0, 48.0));
            let end = if curve == 4 { start } else { at(3 * curve + 3, 20.0, 35.0) };
            path.push(Segment::Cubic(first, second, end));
        }
        path.push(Segment::Close);
    }
    Shape::Path(path)
}

/// Each subpath as a polygon, in `f64`.
fn contours(segments: &[Segment]) -> Vec<Vec<[f64; 2]>> {
    let wide = |p: Point| p.map(f64::from);
    let mut contours: Vec<Vec<[f64; 2]>> = Vec::new();
    for segment in segments {
        if let Segment::Move(p) = segment {
            contours.push(vec![wide(*p)]);
        }
        let Some(contour) = contours.last_mut() else { continue };
        let from = contour.last().copied().unwrap_or_default();
        let mut along = |weights: fn(f64) -> [f64; 4], points: [[f64; 2]; 4]| {
            for chord in 1..=CHORDS {
                let weights = weights(chord as f64 / CHORDS as f64);
                contour.push([0, 1].map(|axis| (0..4).map(|k| weights[k] * points[k][axis]).sum()));
            }
        };
        match *segment {
            Segment::Move(_) | Segment::Close => {}
            Segment::Line(p) => contour.push(wide(p)),
            Segment::Quad(c, p) => {
                along(|t| [(1.0 - t) * (1.0 - t), 2.0 * t * (1.0 - t), t * t, 0.0], [from, wide(c), wide(p), [0.0; 2]]);
            }
            Segment::Cubic(c, d, p) => {
                let weights = |t: f64| {
                    let u = 1.0 - t;
                    [u * u * u, 3.0 * u * u * t, 3.0 * u * t * t, t * t * t]
                };
                along(weights, [from, wide(c), wide(d), wide(p)]);
            }
        }
    }
    contours
}

/// How many of each pixel's samples lie inside by the even-odd rule.
fn samples(contours: &[Vec<[f64; 2]>]) -> Vec<u32> {
    let mut covered = vec![0; SIDE * SIDE];
    let mut rows: Vec<Vec<f64>> = vec![Vec::new(); SIDE * GRID];
    for contour in contours {
        for (index, [ax, ay]) in contour.iter().copied().enumerate() {
            let [bx, by] = contour[(index + 1) % contour.len()];
            // The rows of samples between the ends: their ys are above the upper end's, or are it.
            let row = |y: f64| (y * GRID as f64 - 0.5).ceil() as usize;
            for row in row(ay.min(by))..row(ay.max(by)) {
                let y = (row as f64 + 0.5) / GRID as f64;
                rows[row].push(ax + (bx - ax) * (y - ay) / (by - ay));
            }
        }
    }
    for (row, crossings) in rows.iter_mut().enumerate() {
        crossings.sort_by(f64::total_cmp);
        let pixels = &mut covered[row / GRID * SIDE..][..SIDE];
        for [from, to] in crossings.as_chunks::<2>().0 {
            // The samples from one crossing to the next, pixel by pixel.
            let sample = |x: f64| (x * GRID as f64 - 0.5).ceil() as usize;
            let (from, to) = (sample(*from), sample(*to));
            let first = from / GRID;
            for (pixel, covered) in pixels[first..to.div_ceil(GRID).max(first)].iter_mut().enumerate() {
                let left = (first + pixel) * GRID;
                *covered += (to.min(left + GRID) - from.max(left).min(to)) as u32;
            }
        }
    }
    covered
}

#[cfg(test)]
mod tests {
    use super::{GRID, SIDE, contours, samples};
    use crate::scene::Segment;

    #[test]
    fn samples_of_a_rectangle_between_pixels() {
        let covered = samples(&[vec![[10.25, 20.5], [12.5, 20.5], [12.5, 22.0], [10.25, 22.0]]]);
        let share = |x: usize, y: usize| f64::from(covered[y * SIDE + x]) / (GRID * GRID) as f64;
        assert_eq!(
            [share(9, 21), share(10, 21), share(11, 21), share(12, 21), share(13, 21)],
            [0.0, 0.75, 1.0, 0.5, 0.0]
        );
        assert_eq!([share(11, 19), share(11, 20), share(11, 22)], [0.0, 0.5, 0.0]);
    }

    #[test]
    fn a_parabola_covers_two_thirds_of_its_triangle() {
        let path = [Segment::Move([10.0, 50.0]), Segment::Quad([40.0, 170.0], [70.0, 50.0]), Segment::Close];
        let covered: u32 = samples(&contours(&path)).iter().sum();
        let area = f64::from(covered) / (GRID * GRID) as f64;
        assert!((area - 2.0 / 3.0 * 60.0 * 120.0 / 2.0).abs() < 0.2, "{area}");
        // The same, raised to a cubic.
        let third = |a: f32, c: f32| a + (c - a) * 2.0 / 3.0;
        let raised = Segment::Cubic(
            [third(10.0, 40.0), third(50.0, 170.0)],
            [third(70.0, 40.0), third(50.0, 170.0)],
            [70.0, 50.0],
        );
        let other: u32 = samples(&contours(&[path[0], raised, Segment::Close])).iter().sum();
        assert!(covered.abs_diff(other) < 400, "{covered} {other}");
    }
}
