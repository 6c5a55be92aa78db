//! Gradients: the position of every pixel along a line, between two circles or around a point.

use fearless_simd::prelude::*;
use fearless_simd::{f32x8, mask32x8, u8x32, u32x8};

use super::plane::{Affine, Plane};
use super::ramp::Ramp;
use super::shader::{LinearGradient, RadialGradient, SweepGradient};
use crate::geom::Point;
use crate::num::lanes::{max_f32, min_f32};
use crate::surface::block::PixelBlock;

/// A gradient ready to be fetched.
#[derive(Debug)]
pub(crate) struct Gradient {
    plane: Plane,
    geometry: Geometry,
    ramp: Ramp,
}

/// How a point (x, y) of the plane becomes a position.
#[derive(Clone, Copy, Debug)]
pub(super) enum Geometry {
    /// x.
    Linear,
    /// ±√(x² + y²) + bias.
    Concentric { sign: f32, bias: f32 },
    /// Between two circles whose centres are 1 apart along x; see [`TwoPoint`].
    TwoPoint(TwoPoint),
    /// The angle in turns, taken into the gradient's range where a whole turn can, times `scale`.
    Sweep { start: f32, scale: f32 },
}

/// The circles around (t, 0) with radius r0 + s·t.
///
/// The circle through (x, y) solves a·t² − 2·b·t + c = 0 with a = 1 − s², b = x + r0·s, c = x² + y² − r0².
/// Where |s| < 1, its two solutions have radii of the same sign, and the larger one is wanted; where
/// |s| > 1, one of each sign, and the one of positive radius is wanted. The equation is multiplied by
/// −1 where need be so that the wanted solution is always (b + √(b² − a·c)) / a.
#[derive(Clone, Copy, Debug)]
pub(super) struct TwoPoint {
    /// r0.
    radius: f32,
    /// s.
    growth: f32,
    /// 1 − s², not negated.
    curvature: f32,
    /// The sign by which a, b and c are multiplied.
    sign: f32,
    /// a, with the sign.
    a: f32,
    /// What x is added to in b, with the sign.
    b: f32,
    /// From which b on the solution is q / a rather than c / q: 0, or ∞ where a is 0.
    far_root_from: f32,
    /// Whether some points lie on no circle.
    holes: bool,
}

impl Geometry {
    /// Whether some points have no position.
    pub(super) fn has_holes(&self) -> bool {
        matches!(self, Self::TwoPoint(circles) if circles.holes)
    }
}

/// A gradient's geometry and the map to the plane in which it is stated.
pub(super) struct Placement {
    pub(super) plane: Plane,
    pub(super) geometry: Geometry,
}

/// What becomes of a gradient's geometry.
pub(super) enum Placed {
    /// It paints nothing.
    Nothing,
    /// It has no extent and shows its last colour.
    LastColor,
    /// It can be drawn.
    At(Placement),
}

/// Positions that change by more than this from pixel to pixel mean a gradient without extent.
const STEEPEST: f64 = 1e18;

fn wide(point: Point) -> [f64; 2] {
    [f64::from(point.x), f64::from(point.y)]
}

/// Where a linear gradient lies; `to_device` maps its own space to device space.
pub(super) fn place_linear(gradient: &LinearGradient, to_device: Affine) -> Placed {
    let (start, end) = (wide(gradient.start), wide(gradient.end));
    let Some(inverse) = to_device.invert() else { return Placed::Nothing };
    let (dx, dy) = (end[0] - start[0], end[1] - start[1]);
    let length_squared = dx * dx + dy * dy;
    if !length_squared.is_finite() {
        return Placed::Nothing;
    }
    let to_unit = Affine {
        a: dx / length_squared,
        b: 0.0,
        c: dy / length_squared,
        d: 0.0,
        e: -(start[0] * dx + start[1] * dy) / length_squared,
        f: 0.0,
    };
    let to_plane = inverse.then(to_unit);
    let steepness = to_plane.a.abs() + to_plane.c.abs();
    if steepness.is_nan() || steepness >= STEEPEST {
        return Placed::LastColor;
    }
    let middle = [start[0] + dx * 0.5, start[1] + dy * 0.5];
    Placed::At(Placement { plane: Plane::new(to_plane, to_device.map(middle)), geometry: Geometry::Linear })
}

/// Where a radial gradient lies.
pub(super) fn place_radial(gradient: &RadialGradient, to_device: Affine) -> Placed {
    let (start, end) = (wide(gradient.start_center), wide(gradient.end_center));
    let (r0, r1) = (f64::from(gradient.start_radius), f64::from(gradient.end_radius));
    let Some(inverse) = to_device.invert() else { return Placed::Nothing };
    let finite = [start[0], start[1], end[0], end[1], r0, r1].iter().all(|v| v.is_finite());
    if !finite || r0 < 0.0 || r1 < 0.0 || (r0 == 0.0 && r1 == 0.0) {
        return Placed::Nothing;
    }
    let (dx, dy) = (end[0] - start[0], end[1] - start[1]);
    let distance = (dx * dx + dy * dy).sqrt();
    let growth = r1 - r0;
    let move_start = Affine { a: 1.0, b: 0.0, c: 0.0, d: 1.0, e: -start[0], f: -start[1] };
    // Centres this close for their growth move no position by more than the bound.
    let (to_unit, geometry) = if distance <= 1e-5 * growth.abs() {
        let scale = 1.0 / growth.abs();
        let shrink = Affine { a: scale, b: 0.0, c: 0.0, d: scale, e: 0.0, f: 0.0 };
        let sign = if growth > 0.0 { 1.0 } else { -1.0 };
        (move_start.then(shrink), Geometry::Concentric { sign, bias: (-r0 / growth) as f32 })
    } else if distance > 0.0 {
        let (cos, sin) = (dx / distance / distance, dy / distance / distance);
        let turn = Affine { a: cos, b: -sin, c: sin, d: cos, e: 0.0, f: 0.0 };
        (move_start.then(turn), Geometry::TwoPoint(TwoPoint::new(r0 / distance, growth / distance)))
    } else {
        return Placed::Nothing;
    };
    let to_plane = inverse.then(to_unit);
    let steepness = [to_plane.a, to_plane.b, to_plane.c, to_plane.d].iter().fold(0.0, |sum, v| sum + v.abs());
    if steepness.is_nan() || steepness >= STEEPEST {
        return Placed::Nothing;
    }
    Placed::At(Placement { plane: Plane::new(to_plane, to_device.map(start)), geometry })
}

/// Where a sweep gradient lies.
pub(super) fn place_sweep(gradient: &SweepGradient, to_device: Affine) -> Placed {
    let center = wide(gradient.center);
    let (start, end) = (f64::from(gradient.start_angle), f64::from(gradient.end_angle));
    let Some(inverse) = to_device.invert() else { return Placed::Nothing };
    let finite = [center[0], center[1], start, end].iter().all(|v| v.is_finite());
    if !finite || end <= start {
        return Placed::Nothing;
    }
    // Whole turns of the start are of no consequence; the first one is kept, since −90° .. 90° and
    // 270° .. 450° differ in what they show outside.
    let whole = (start / 360.0).trunc() * 360.0;
    let geometry = Geometry::Sweep { start: ((start - whole) / 360.0) as f32, scale: (360.0 / (end - start)) as f32 };
    let move_center = Affine { a: 1.0, b: 0.0, c: 0.0, d: 1.0, e: -center[0], f: -center[1] };
    Placed::At(Placement { plane: Plane::new(inverse.then(move_center), to_device.map(center)), geometry })
}

impl TwoPoint {
    fn new(radius: f64, growth: f64) -> Self {
        // A start point on the end circle is seldom on it to the last bit of an `f32`.
        let on_circle = (growth.abs() - 1.0).abs() < 1e-5;
        let growth = if on_circle { growth.signum() } else { growth };
        let curvature = 1.0 - growth * growth;
        let sign = if curvature < 0.0 && growth > 0.0 { -1.0 } else { 1.0 };
        Self {
            radius: radius as f32,
            growth: growth as f32,
            curvature: curvature as f32,
            sign: sign as f32,
            a: (sign * curvature) as f32,
            b: (sign * radius * growth) as f32,
            far_root_from: if on_circle { f32::INFINITY } else { 0.0 },
            holes: curvature >= 0.0,
        }
    }

    /// The positions of the points, and which of them lie on a circle at all.
    #[inline(always)]
    fn positions<S: Simd>(&self, simd: S, x: f32x8<S>, y: f32x8<S>) -> (f32x8<S>, mask32x8<S>) {
        let zero = f32x8::splat(simd, 0.0);
        let b = x * self.sign + self.b;
        let c = (x * x + y * y - self.radius * self.radius) * self.sign;
        // b² − a·c rearranged: where the circles grow slowly it is a difference of two squares rather
        // than of four, and where they grow fast a sum.
        let along = x * self.growth + self.radius;
        let discriminant = along * along - y * y * self.curvature;
        let root = max_f32(discriminant, zero).sqrt();
        let forward = b.simd_ge(zero);
        let q = forward.select(b + root, b - root);
        let far = b.simd_ge(self.far_root_from);
        let t = far.select(q, c) / far.select(f32x8::splat(simd, self.a), q);
        let on_circle = discriminant.simd_ge(zero) & (t * self.growth + self.radius).simd_ge(zero);
        (t, on_circle)
    }
}

impl Gradient {
    pub(super) fn new(placement: Placement, ramp: Ramp) -> Self {
        Self { plane: placement.plane, geometry: placement.geometry, ramp }
    }

    /// Whether every pixel it gives is opaque.
    pub(super) fn is_opaque(&self) -> bool {
        self.ramp.is_opaque() && !self.geometry.has_holes()
    }

    /// The pixels of the block at (x, y).
    #[inline(always)]
    pub(super) fn fetch<S: Simd>(&self, simd: S, x: i32, y: i32, out: &mut PixelBlock) {
        let groups = out.as_flattened_mut().as_chunks_mut::<32>().0;
        // Positions first, then their colours: two loops, and one copy of the second for all geometries.
        let mut positions = [[0.0; 8]; 16];
        let mut masks = None;
        // A linear gradient that is the same along rows or columns needs 8 or 16 positions only.
        let mut count = 16;
        match self.geometry {
            Geometry::Linear => count = self.linear_positions(simd, x, y, &mut positions),
            Geometry::Concentric { sign, bias } => {
                for (position, point) in positions.iter_mut().zip(&self.points(simd, x, y)) {
                    let (x, y) = point.load(simd);
                    *position = ((x * x + y * y).sqrt() * sign + bias).to_array();
                }
            }
            Geometry::TwoPoint(circles) => {
                let points = self.points(simd, x, y);
                let masks = masks.insert([[0; 8]; 16]);
                for ((position, mask), point) in positions.iter_mut().zip(masks).zip(&points) {
                    let (x, y) = point.load(simd);
                    let (t, on_circle) = circles.positions(simd, x, y);
                    *position = t.to_array();
                    *mask = on_circle.select(u32x8::splat(simd, u32::MAX), u32x8::splat(simd, 0)).to_array();
                }
            }
            Geometry::Sweep { start, scale } => {
                for (position, point) in positions.iter_mut().zip(&self.points(simd, x, y)) {
                    let (x, y) = point.load(simd);
                    *position = sweep_position(simd, turns(simd, y, x), start, scale).to_array();
                }
            }
        }
        let (positions, _) = positions.split_at_mut(count);
        self.ramp.shade(simd, positions, groups);
        match count {
            1 => {
                let colors = groups.first().copied().unwrap_or([0; 32]);
                for (pair, color) in groups.chunks_exact_mut(2).zip(colors.as_chunks::<4>().0) {
                    pair.as_flattened_mut().as_chunks_mut::<4>().0.fill(*color);
                }
            }
            2 => {
                let (row, others) = groups.split_at_mut(2);
                for pair in others.chunks_exact_mut(2) {
                    pair.copy_from_slice(row);
                }
            }
            _ => {}
        }
        if let Some(masks) = &masks {
            for (group, mask) in groups.iter_mut().zip(masks) {
                let pixels = u32x8::from_bytes(u8x32::simd_from(simd, *group));
                *group = (pixels & u32x8::simd_from(simd, *mask)).to_bytes().to_array();
            }
        }
    }

    /// The positions of the block's groups of eight pixels: all 16, or the first 2 where every row is the
    /// same, or 1 with a lane for each row where every row is of one colour. Answers how many.
    #[inline(always)]
    fn linear_positions<S: Simd>(&self, simd: S, x: i32, y: i32, positions: &mut [[f32; 8]; 16]) -> usize {
        let rows = self.plane.rows(0, y);
        if self.plane.is_constant_along_rows() {
            positions[0] = rows;
            return 1;
        }
        let columns = self.plane.columns(simd, 0, x);
        for (pair, row) in positions.as_chunks_mut::<2>().0.iter_mut().zip(rows) {
            *pair = [(columns[0] + row).to_array(), (columns[1] + row).to_array()];
        }
        if self.plane.is_constant_along_columns() { 2 } else { 16 }
    }

    /// The block's pixel centres in the plane, in the order of its groups of eight pixels.
    #[inline(always)]
    fn points<S: Simd>(&self, simd: S, x: i32, y: i32) -> [PointGroup; 16] {
        let (columns_x, columns_y) = (self.plane.columns(simd, 0, x), self.plane.columns(simd, 1, x));
        let (rows_x, rows_y) = (self.plane.rows(0, y), self.plane.rows(1, y));
        let mut points = [PointGroup { x: [0.0; 8], y: [0.0; 8] }; 16];
        for ((pair, row_x), row_y) in points.as_chunks_mut::<2>().0.iter_mut().zip(rows_x).zip(rows_y) {
            for half in 0..2 {
                pair[half].x = (columns_x[half] + row_x).to_array();
                pair[half].y = (columns_y[half] + row_y).to_array();
            }
        }
        points
    }
}

/// Eight points of the plane.
#[derive(Clone, Copy)]
struct PointGroup {
    x: [f32; 8],
    y: [f32; 8],
}

impl PointGroup {
    #[inline(always)]
    fn load<S: Simd>(&self, simd: S) -> (f32x8<S>, f32x8<S>) {
        (f32x8::simd_from(simd, self.x), f32x8::simd_from(simd, self.y))
    }
}

/// The position of an angle in 0 ..= 1 turns on a sweep from `start`, of 1 / `scale` turns.
#[inline(always)]
fn sweep_position<S: Simd>(simd: S, turn: f32x8<S>, start: f32, scale: f32) -> f32x8<S> {
    let (zero, one) = (f32x8::splat(simd, 0.0), f32x8::splat(simd, 1.0));
    let t = (turn - start) * scale;
    // A turn more or less, where that falls inside the range.
    let later = (turn - start + 1.0) * scale;
    let earlier = (turn - start - 1.0) * scale;
    let t = (t.simd_lt(zero) & later.simd_le(one)).select(later, t);
    (t.simd_gt(one) & earlier.simd_ge(zero)).select(earlier, t)
}

/// atan2(y, x) in turns, 0 ..= 1; 0 at the origin.
///
/// In the first half octant atan(m) / 2π is an odd polynomial of degree 13, fitted for the least maximal
/// error (Remez exchange): 4·10⁻⁸ of a turn, less than the rounding of its evaluation.
#[inline(always)]
fn turns<S: Simd>(simd: S, y: f32x8<S>, x: f32x8<S>) -> f32x8<S> {
    let zero = f32x8::splat(simd, 0.0);
    let (width, height) = (x.abs(), y.abs());
    let steep = height.simd_gt(width);
    let (small, large) = (min_f32(width, height), max_f32(width, height));
    let m = small / large.simd_gt(zero).select(large, f32x8::splat(simd, 1.0));
    let m2 = m * m;
    let mut sum = m2 * 1.084_131e-3 + -5.348_279e-3;
    sum = sum * m2 + 1.267_250_2e-2;
    sum = sum * m2 + -2.106_152e-2;
    sum = sum * m2 + 3.152_511_8e-2;
    sum = sum * m2 + -5.302_623_8e-2;
    sum = sum * m2 + 1.591_543_2e-1;
    let octant = sum * m;
    let quadrant = steep.select(f32x8::splat(simd, 0.25) - octant, octant);
    let half = x.simd_lt(zero).select(f32x8::splat(simd, 0.5) - quadrant, quadrant);
    y.simd_lt(zero).select(f32x8::splat(simd, 1.0) - half, half)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::level::{SimdLevel, dispatch};

    #[test]
    fn turns_are_within_a_millionth() {
        for level in SimdLevel::available() {
            dispatch!(level, simd => {
                for k in 0..20_000 {
                    let angle = f64::from(k) / 20_000.0 * std::f64::consts::TAU;
                    let (x, y) = ((libm::cos(angle) * 37.0) as f32, (libm::sin(angle) * 37.0) as f32);
                    let truth = libm::atan2(f64::from(y), f64::from(x)) / std::f64::consts::TAU;
                    let truth = if truth < 0.0 { truth + 1.0 } else { truth };
                    let found = turns(simd, f32x8::splat(simd, y), f32x8::splat(simd, x)).to_array()[3];
                    assert!((f64::from(found) - truth).abs() < 2e-7, "{found}, not {truth} at {level:?}");
                }
                let axes = [(0.0, 0.0, 0.0), (0.0, 1.0, 0.0), (1.0, 0.0, 0.25), (0.0, -1.0, 0.5), (-1.0, 0.0, 0.75)];
                for (y, x, turn) in axes {
                    assert_eq!(turns(simd, f32x8::splat(simd, y), f32x8::splat(simd, x)).to_array()[0], turn);
                }
            });
        }
    }
}
