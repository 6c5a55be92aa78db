//! The points that a pen leaves along a calm curve, eight at a time.
//!
//! How far apart points may be changes along a curve with its bend and its speed: that is looked up at sixteen places, and the curve cut where the
//! steps allowed add up to equal shares. What a step's ends then say of its error is checked; where it is too large, or the pen
//! turns too far in one step, or the curve is tighter than the pen, the curve is not calm, and is walked step by step
//! ([`outline`](super::outline)).

use fearless_simd::f32x8;
use fearless_simd::prelude::*;

use crate::geom::Point;

/// A curve of more steps is walked. One less than a multiple of eight: the last step ends at the curve's end.
const MOST_STEPS: usize = 63;
/// Places at which it is asked how far apart points may be.
const SAMPLES: usize = 16;
/// Room for the curve's start, for all steps, and for eights that are read beyond them.
const ROOM: usize = MOST_STEPS + 17;

/// A cubic as a polynomial, relative to its first point.
#[derive(Clone, Copy)]
pub(super) struct Coefficients {
    a: Point,
    b: Point,
    c: Point,
}

impl Coefficients {
    pub(super) fn new(e1: Point, e2: Point, e3: Point) -> Self {
        Self { a: e3 - e2 * 3.0 + e1 * 3.0, b: e2 * 3.0 - e1 * 6.0, c: e1 * 3.0 }
    }

    #[inline(always)]
    pub(super) fn position(&self, t: f32) -> Point {
        ((self.a * t + self.b) * t + self.c) * t
    }

    #[inline(always)]
    pub(super) fn velocity(&self, t: f32) -> Point {
        (self.a * (3.0 * t) + self.b * 2.0) * t + self.c
    }

    #[inline(always)]
    pub(super) fn acceleration(&self, t: f32) -> Point {
        self.a * (6.0 * t) + self.b * 2.0
    }

    /// The greatest |C″|: it is linear in t, so at an end.
    pub(super) fn greatest_bend(&self) -> f32 {
        let (start, end) = (self.acceleration(0.0).length(), self.acceleration(1.0).length());
        if start > end { start } else { end }
    }
}

/// What of the pen matters to a curve.
#[derive(Clone, Copy)]
pub(super) struct Nib {
    pub(super) radius: f32,
    pub(super) tolerance: f32,
    /// The radius in the error estimate.
    pub(super) turn_radius: f32,
    /// Largest 1 − cos of the angle that a curve may turn by in one step.
    pub(super) turn: f32,
    /// No step in t may be longer.
    pub(super) longest_step: f32,
}

/// A curve, and the directions in which it starts and ends.
#[derive(Clone, Copy)]
pub(super) struct Curve {
    pub(super) origin: Point,
    pub(super) end: Point,
    pub(super) coefficients: Coefficients,
    pub(super) start_direction: Point,
    pub(super) end_direction: Point,
}

/// A row of places along a curve: from its start on, one for each step. Arrays have a lane for each place.
#[derive(Debug)]
pub(super) struct Steps {
    t: [f32; ROOM],
    x: [f32; ROOM],
    y: [f32; ROOM],
    direction_x: [f32; ROOM],
    direction_y: [f32; ROOM],
    density: [f32; ROOM],
    left: [[f32; ROOM]; 2],
    right: [[f32; ROOM]; 2],
    /// How many steps there are.
    count: usize,
}

impl Default for Steps {
    fn default() -> Self {
        let none = [0.0; ROOM];
        Self {
            t: none,
            x: none,
            y: none,
            direction_x: none,
            direction_y: none,
            density: none,
            left: [none; 2],
            right: [none; 2],
            count: 0,
        }
    }
}

impl Steps {
    /// How many steps the curve has.
    pub(super) fn count(&self) -> usize {
        self.count
    }

    /// Where the curve is after so many steps.
    #[inline(always)]
    pub(super) fn position(&self, step: usize) -> Point {
        Point::new(self.x[step % ROOM], self.y[step % ROOM])
    }

    /// The points that the pen leaves to its left and to its right after so many steps.
    #[inline(always)]
    pub(super) fn points(&self, step: usize) -> (Point, Point) {
        let at = |[x, y]: &[[f32; ROOM]; 2]| Point::new(x[step % ROOM], y[step % ROOM]);
        (at(&self.left), at(&self.right))
    }

    /// Finds the steps of a curve; false if it is not calm.
    #[inline(always)]
    pub(super) fn find<S: Simd>(&mut self, simd: S, curve: &Curve, nib: &Nib) -> bool {
        let coefficients = Wide::new(simd, &curve.coefficients);
        self.share(simd, &coefficients, nib) && {
            self.place(simd, &coefficients, curve, nib);
            self.offset(simd, &coefficients, nib)
        }
    }

    /// Cuts the curve where the steps allowed add up to equal shares; false if there are too many.
    #[inline(always)]
    fn share<S: Simd>(&mut self, simd: S, coefficients: &Wide<S>, nib: &Nib) -> bool {
        const WIDTH: f32 = 1.0 / SAMPLES as f32;
        let middles = f32x8::simd_from(simd, [0.5, 1.5, 2.5, 3.5, 4.5, 5.5, 6.5, 7.5]) * WIDTH;
        // Steps a part of the curve: its length in t by that of a step.
        let least = f32x8::splat(simd, WIDTH / nib.longest_step);
        let mut steps = [[0.0; 8]; SAMPLES / 8];
        for (half, steps) in steps.iter_mut().enumerate() {
            let place = coefficients.at(simd, middles + 0.5 * half as f32);
            let allowed = (place.density(simd, nib) * (1.0 / (8.0 * nib.tolerance))).sqrt() * WIDTH;
            // Not a number where the curve stands still: as few as possible then, which is found to be too few.
            *steps = allowed.simd_gt(least).select(allowed, least).to_array();
        }
        let steps = steps.as_flattened();
        let total: f32 = steps.iter().sum();
        if !(total <= MOST_STEPS as f32) {
            return false;
        }
        // A hair more than a whole number is no further step.
        let count = ((total - 1e-3).ceil() as usize).max(1);
        let share = total / count as f32;
        let (mut step, mut next, mut before) = (1, share, 0.0);
        for (part, steps) in steps.iter().enumerate() {
            let inverse = WIDTH / steps;
            while next <= before + steps && step < count {
                if let Some(t) = self.t.get_mut(step) {
                    *t = part as f32 * WIDTH + (next - before) * inverse;
                }
                step += 1;
                next = share * step as f32;
            }
            before += steps;
        }
        // Rounding may leave the last but the end.
        let end = self.t.get_mut(step..).unwrap_or(&mut []);
        end.iter_mut().for_each(|t| *t = 1.0);
        self.count = step;
        true
    }

    /// Finds where the curve is after each step, and where it goes.
    #[inline(always)]
    fn place<S: Simd>(&mut self, simd: S, coefficients: &Wide<S>, curve: &Curve, nib: &Nib) {
        let (origin_x, origin_y) = (f32x8::splat(simd, curve.origin.x), f32x8::splat(simd, curve.origin.y));
        self.t[0] = 0.0;
        for first in (0..=self.count).step_by(8) {
            let t = load(simd, &self.t, first);
            let place = coefficients.at(simd, t);
            let (x, y) = coefficients.position(t);
            store(x + origin_x, &mut self.x, first);
            store(y + origin_y, &mut self.y, first);
            store(place.velocity_x * place.inverse_speed, &mut self.direction_x, first);
            store(place.velocity_y * place.inverse_speed, &mut self.direction_y, first);
            store(place.density(simd, nib), &mut self.density, first);
        }
        let mut set = |step: usize, p: Point, direction: Point| {
            (self.x[step], self.y[step]) = (p.x, p.y);
            (self.direction_x[step], self.direction_y[step]) = (direction.x, direction.y);
        };
        set(0, curve.origin, curve.start_direction);
        set(self.count.min(MOST_STEPS), curve.end, curve.end_direction);
    }

    /// Finds the points beside the curve; false if a step is too long for that.
    #[inline(always)]
    fn offset<S: Simd>(&mut self, simd: S, coefficients: &Wide<S>, nib: &Nib) -> bool {
        let radius = f32x8::splat(simd, nib.radius);
        let limit = f32x8::splat(simd, 24.0 * nib.tolerance);
        let turn = f32x8::splat(simd, nib.turn);
        let mut calm = true;
        for first in (1..=self.count).step_by(8) {
            let before = |lanes: &[f32; ROOM]| load(simd, lanes, first - 1);
            let here = |lanes: &[f32; ROOM]| load(simd, lanes, first);
            let (t, even) = (here(&self.t), here(&self.t) - before(&self.t));
            let (x, y) = (here(&self.x), here(&self.y));
            let (dx, dy) = (here(&self.direction_x), here(&self.direction_y));
            let (old_dx, old_dy) = (before(&self.direction_x), before(&self.direction_y));
            let turned = dx * old_dx + dy * old_dy;
            let squared = even * even;
            let (chord_x, chord_y) = (x - before(&self.x), y - before(&self.y));
            // What the outer contour gains by the turn, the inner one loses.
            let gain = (chord_y * (dx - old_dx) - chord_x * (dy - old_dy)) * radius;
            let fine = (f32x8::splat(simd, 1.0) - turned).simd_le(turn)
                & (squared * (before(&self.density) + here(&self.density))).simd_le(limit)
                & gain.abs().simd_le(chord_x * chord_x + chord_y * chord_y);
            let lanes = self.count + 1 - first;
            calm &= fine.to_bitmask() as u32 | u32::MAX << lanes.min(8) == u32::MAX;

            // As where a curve is walked: chords lie to the inside, by so much on average.
            let (acceleration_x, acceleration_y) = coefficients.acceleration(t);
            let (normal_x, normal_y) = (-dy, dx);
            let outwards = (normal_x * acceleration_x + normal_y * acceleration_y) * (squared * (1.0 / 12.0));
            let (middle_x, middle_y) = (x - normal_x * outwards, y - normal_y * outwards);
            let reach = radius + radius * ((f32x8::splat(simd, 1.0) - turned) * (1.0 / 6.0));
            let (right_x, right_y) = (normal_x * reach, normal_y * reach);
            store(middle_x - right_x, &mut self.left[0], first);
            store(middle_y - right_y, &mut self.left[1], first);
            store(middle_x + right_x, &mut self.right[0], first);
            store(middle_y + right_y, &mut self.right[1], first);
        }
        calm
    }
}

/// Eight lanes from `first` on.
#[inline(always)]
fn load<S: Simd>(simd: S, lanes: &[f32; ROOM], first: usize) -> f32x8<S> {
    let eight = lanes.get(first..).and_then(|rest| rest.first_chunk::<8>());
    eight.map_or(f32x8::splat(simd, 0.0), |eight| f32x8::load_array_ref(simd, eight))
}

#[inline(always)]
fn store<S: Simd>(values: f32x8<S>, lanes: &mut [f32; ROOM], first: usize) {
    if let Some(eight) = lanes.get_mut(first..).and_then(|rest| rest.first_chunk_mut::<8>()) {
        values.store_array(eight);
    }
}

/// [`Coefficients`] in all lanes.
struct Wide<S: Simd> {
    a: [f32x8<S>; 2],
    b: [f32x8<S>; 2],
    c: [f32x8<S>; 2],
}

/// How a curve goes at eight places.
struct Place<S: Simd> {
    velocity_x: f32x8<S>,
    velocity_y: f32x8<S>,
    inverse_speed: f32x8<S>,
    /// |velocity × acceleration|.
    cross: f32x8<S>,
}

impl<S: Simd> Wide<S> {
    #[inline(always)]
    fn new(simd: S, &Coefficients { a, b, c }: &Coefficients) -> Self {
        let splat = |v: f32| f32x8::splat(simd, v);
        Self { a: [splat(a.x), splat(a.y)], b: [splat(b.x), splat(b.y)], c: [splat(c.x), splat(c.y)] }
    }

    #[inline(always)]
    fn position(&self, t: f32x8<S>) -> (f32x8<S>, f32x8<S>) {
        let Self { a, b, c } = self;
        (((a[0] * t + b[0]) * t + c[0]) * t, ((a[1] * t + b[1]) * t + c[1]) * t)
    }

    #[inline(always)]
    fn acceleration(&self, t: f32x8<S>) -> (f32x8<S>, f32x8<S>) {
        let Self { a, b, .. } = self;
        let t = t * 6.0;
        (a[0] * t + b[0] * 2.0, a[1] * t + b[1] * 2.0)
    }

    #[inline(always)]
    fn at(&self, simd: S, t: f32x8<S>) -> Place<S> {
        let one = f32x8::splat(simd, 1.0);
        let Self { a, b, c } = self;
        let third = t * 3.0;
        let velocity_x = (a[0] * third + b[0] * 2.0) * t + c[0];
        let velocity_y = (a[1] * third + b[1] * 2.0) * t + c[1];
        let (acceleration_x, acceleration_y) = self.acceleration(t);
        let speed = (velocity_x * velocity_x + velocity_y * velocity_y).sqrt();
        let cross = (velocity_x * acceleration_y - velocity_y * acceleration_x).abs();
        Place { velocity_x, velocity_y, inverse_speed: one / speed, cross }
    }
}

impl<S: Simd> Place<S> {
    /// The distance between the outer contour and its chord, over the step's square and times 8: at speed s and angular speed ω it is s·ω for
    /// the curve and r·ω² for the pen.
    #[inline(always)]
    fn density(&self, simd: S, nib: &Nib) -> f32x8<S> {
        let along = self.cross * self.inverse_speed;
        let angular = along * self.inverse_speed;
        along + f32x8::splat(simd, nib.turn_radius) * angular * angular
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::level::{SimdLevel, dispatch};

    fn curve(points: [(f32, f32); 4]) -> Curve {
        let [origin, c1, c2, end] = points.map(Point::from);
        let direction = |v: Point| v * (1.0 / v.length());
        Curve {
            origin,
            end,
            coefficients: Coefficients::new(c1 - origin, c2 - origin, end - origin),
            start_direction: direction(c1 - origin),
            end_direction: direction(end - c2),
        }
    }

    fn nib(curve: &Curve, radius: f32) -> Nib {
        let tolerance = 0.05;
        let longest_step = (16.0 * tolerance / curve.coefficients.greatest_bend()).sqrt().min(1.0);
        Nib { radius, tolerance, turn_radius: radius, turn: 0.1, longest_step }
    }

    /// How far a point is from the curve moved by `offset` to its right, by many places along it.
    fn distance(curve: &Curve, offset: f32, p: Point) -> f32 {
        let places = (0..=20_000_u16).map(|i| {
            let t = f32::from(i) / 20_000.0;
            let v = curve.coefficients.velocity(t);
            let normal = Point::new(-v.y, v.x) * (1.0 / v.length());
            (curve.origin + curve.coefficients.position(t) + normal * offset - p).length()
        });
        places.reduce(f32::min).unwrap()
    }

    #[test]
    fn contours_stay_beside_the_curve_at_every_level() {
        let mut seed = 9_u32;
        let mut random = |low: f32, high: f32| {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            low + (high - low) * (seed >> 8) as f32 / 16_777_216.0
        };
        let mut calm = 0;
        for case in 0..60 {
            let size = [30.0, 200.0, 500.0][case % 3];
            let points = [(); 4].map(|()| (random(0.0, size), random(0.0, size)));
            let (curve, mut steps) = (curve(points), Steps::default());
            let nib = nib(&curve, random(0.5, 6.0));
            let found = dispatch!(SimdLevel::Scalar, simd => steps.find(simd, &curve, &nib));
            for level in SimdLevel::available() {
                let mut others = Steps::default();
                assert_eq!(dispatch!(level, simd => others.find(simd, &curve, &nib)), found, "{points:?} at {level:?}");
                if found {
                    assert_eq!(others.count(), steps.count());
                    for step in 1..steps.count() {
                        assert_eq!(others.points(step), steps.points(step), "{points:?} at {level:?}");
                    }
                }
            }
            if !found {
                continue;
            }
            calm += 1;
            let mut before = None;
            for step in 1..steps.count() {
                let (left, right) = steps.points(step);
                for (offset, p) in [(-nib.radius, left), (nib.radius, right)] {
                    let far = distance(&curve, offset, p);
                    assert!(far < 2.0 * nib.tolerance, "{points:?}: step {step} of {} is {far} off", steps.count());
                }
                // Chords, where they are farthest from the arc.
                if let Some((old_left, old_right)) = before.replace((left, right)) {
                    for (offset, a, b) in [(-nib.radius, left, old_left), (nib.radius, right, old_right)] {
                        let far = distance(&curve, offset, a.lerp(b, 0.5));
                        assert!(far < 2.0 * nib.tolerance, "{points:?}: before step {step} a chord is {far} off");
                    }
                }
            }
        }
        assert!(calm >= 20, "{calm}");
    }

    #[test]
    fn cusps_and_curves_tighter_than_the_pen_are_not_calm() {
        let mut steps = Steps::default();
        // A cusp in the middle, and a hairpin.
        for points in [
            [(0.0, 0.0), (100.0, 100.0), (0.0, 100.0), (100.0, 0.0)],
            [(0.0, 0.0), (200.0, 1.0), (200.0, 2.0), (0.0, 3.0)],
        ] {
            let curve = curve(points);
            for level in SimdLevel::available() {
                let nib = nib(&curve, 10.0);
                assert!(!dispatch!(level, simd => steps.find(simd, &curve, &nib)), "{points:?}");
            }
        }
    }
}
