//! Coverage of self-crossing polygons against 64 × 64 samples a pixel.
//!
//! Polygons of twenty random corners in 200 px, even-odd, black on white: pixels on edges count, in 1/255 of coverage.

use crate::engines::Kind;
use crate::random::Random;
use crate::scene::{Point, Rule, Scene};
use crate::workloads::polygon;

const SIDE: usize = 208;

/// Samples a pixel and axis.
const GRID: usize = 64;

/// Errors of the edge pixels of all polygons, in 1/255.
#[derive(Clone, Copy, Debug, Default)]
pub struct Accuracy {
    sum: f64,
    count: f64,
    above16: f64,
    pub max: f64,
}

impl Accuracy {
    pub fn mean(self) -> f64 {
        self.sum / self.count
    }

    /// Per cent of the edge pixels that are more than 16 off.
    pub fn above16(self) -> f64 {
        self.above16 / self.count * 100.0
    }
}

/// The engines' accuracy on so many polygons.
pub fn measure(kinds: &[Kind], polygons: usize) -> Vec<(Kind, Accuracy)> {
    let mut results: Vec<(Kind, Accuracy)> = kinds.iter().map(|kind| (*kind, Accuracy::default())).collect();
    let mut random = Random::new(64);
    for _ in 0..polygons {
        let corners: Vec<Point> = (0..20).map(|_| [random.within(4.0, 204.0), random.within(4.0, 204.0)]).collect();
        let truth = samples(&corners);
        let mut scene = Scene::new("polygon", "", SIDE as u32);
        scene.fill(polygon(&corners), Rule::EvenOdd, [0, 0, 0, 255]);
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

/// How many of each pixel's samples lie inside by the even-odd rule.
fn samples(corners: &[Point]) -> Vec<u32> {
    let mut covered = vec![0; SIDE * SIDE];
    let mut crossings: Vec<f64> = Vec::new();
    for row in 0..SIDE * GRID {
        let y = (row as f64 + 0.5) / GRID as f64;
        crossings.clear();
        for (index, a) in corners.iter().enumerate() {
            let b = corners[(index + 1) % corners.len()];
            let [ax, ay, bx, by] = [a[0], a[1], b[0], b[1]].map(f64::from);
            if (ay <= y) != (by <= y) {
                crossings.push(ax + (bx - ax) * (y - ay) / (by - ay));
            }
        }
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
    use super::{GRID, SIDE, samples};

    #[test]
    fn samples_of_a_rectangle_between_pixels() {
        let covered = samples(&[[10.25, 20.5], [12.5, 20.5], [12.5, 22.0], [10.25, 22.0]]);
        let share = |x: usize, y: usize| f64::from(covered[y * SIDE + x]) / (GRID * GRID) as f64;
        assert_eq!(
            [share(9, 21), share(10, 21), share(11, 21), share(12, 21), share(13, 21)],
            [0.0, 0.75, 1.0, 0.5, 0.0]
        );
        assert_eq!([share(11, 19), share(11, 20), share(11, 22)], [0.0, 0.5, 0.0]);
    }
}
