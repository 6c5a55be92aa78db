//! How cost grows: with shapes, vertices, pixels and layers.

use crate::engines::{Engine, Kind};
use crate::measure::{Times, time};
use crate::scene::Scene;
use crate::workloads::growing;

/// A series ends with the first picture that takes longer.
const LONGEST: f64 = 5_000.0;

/// Each size is drawn until so much time has passed, in milliseconds, and at least three times.
const ENOUGH: f64 = 300.0;

const SHAPES: [usize; 5] = [100, 1_000, 10_000, 100_000, 1_000_000];
const VERTICES: [usize; 5] = [1_000, 10_000, 100_000, 1_000_000, 10_000_000];
const SIDES: [usize; 7] = [256, 512, 1_024, 2_048, 4_096, 8_192, 16_384];
const LAYERS: [usize; 7] = [1, 2, 5, 10, 20, 50, 100];

pub struct Series {
    pub name: &'static str,
    /// What the sizes count.
    pub unit: &'static str,
    pub engines: Vec<Growth>,
}

/// One engine's times.
pub struct Growth {
    pub kind: Kind,
    /// Size and milliseconds: the least of several, since small pictures suffer most from what else runs.
    pub points: Vec<(f64, f64)>,
}

impl Growth {
    /// The slope of the line through all points in log–log, by least squares: 1 is linear.
    pub fn exponent(&self) -> f64 {
        exponent(&self.points)
    }

    /// The slope between the two largest sizes, where fixed costs no longer show.
    pub fn last_step(&self) -> f64 {
        exponent(&self.points[self.points.len().saturating_sub(2)..])
    }
}

fn exponent(points: &[(f64, f64)]) -> f64 {
    let logs: Vec<(f64, f64)> = points.iter().map(|(size, time)| (libm::log(*size), libm::log(*time))).collect();
    let count = logs.len() as f64;
    let (mean_x, mean_y) =
        (logs.iter().map(|p| p.0).sum::<f64>() / count, logs.iter().map(|p| p.1).sum::<f64>() / count);
    let above: f64 = logs.iter().map(|(x, y)| (x - mean_x) * (y - mean_y)).sum();
    let below: f64 = logs.iter().map(|(x, _)| (x - mean_x) * (x - mean_x)).sum();
    above / below
}

struct Plan {
    name: &'static str,
    unit: &'static str,
    sizes: &'static [usize],
    scene: fn(usize) -> Scene,
    /// What the fit is over.
    count: fn(usize) -> usize,
}

/// All series, each engine at each size. `report` hears of each point as it is measured.
pub fn measure(kinds: &[Kind], mut report: impl FnMut(&str, Kind, f64, f64)) -> Vec<Series> {
    let plans = [
        Plan { name: "shapes", unit: "circles of radius 4", sizes: &SHAPES, scene: growing::shapes, count: |n| n },
        Plan { name: "vertices", unit: "of one filled path", sizes: &VERTICES, scene: growing::vertices, count: |n| n },
        Plan { name: "canvas", unit: "pixels", sizes: &SIDES, scene: growing::canvas, count: |side| side * side },
        Plan { name: "overdraw", unit: "layers", sizes: &LAYERS, scene: growing::overdraw, count: |n| n },
    ];
    let mut series = Vec::new();
    for Plan { name, unit, sizes, scene, count } in plans {
        let mut engines: Vec<Growth> = kinds.iter().map(|kind| Growth { kind: *kind, points: Vec::new() }).collect();
        for size in sizes {
            let scene = scene(*size);
            for growth in &mut engines {
                if growth.points.last().is_some_and(|(_, time)| *time > LONGEST) {
                    continue;
                }
                let Some(mut engine) = growth.kind.prepare(&scene, None) else { continue };
                let time = least_time(&mut *engine);
                growth.points.push((count(*size) as f64, time));
                report(name, growth.kind, count(*size) as f64, time);
            }
        }
        series.push(Series { name, unit, engines });
    }
    series
}

fn least_time(engine: &mut dyn Engine) -> f64 {
    // The first picture finds cold memory; it counts only where there is no time for another.
    let first = time(engine, 1);
    if first > LONGEST {
        return first;
    }
    let mut times = Vec::new();
    while times.len() < 3 || (times.iter().sum::<f64>() < ENOUGH && times.len() < 200) {
        times.push(time(engine, 1));
    }
    Times::new(times).minimum()
}

#[cfg(test)]
mod tests {
    use super::exponent;

    #[test]
    fn powers_are_found() {
        let line: Vec<(f64, f64)> = (1..6).map(|n| (f64::from(n), f64::from(3 * n))).collect();
        let square: Vec<(f64, f64)> = (1..6).map(|n| (f64::from(n), f64::from(n * n))).collect();
        assert!((exponent(&line) - 1.0).abs() < 1e-12 && (exponent(&square) - 2.0).abs() < 1e-12);
    }
}
