//! From device pixels to the plane that a paint is defined in.

use fearless_simd::prelude::*;
use fearless_simd::{f32x8, i32x8};

use crate::geom::Transform;

/// An affine map in `f64`, used at set-up: x' = a·x + c·y + e, y' = b·x + d·y + f.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Affine {
    pub(super) a: f64,
    pub(super) b: f64,
    pub(super) c: f64,
    pub(super) d: f64,
    pub(super) e: f64,
    pub(super) f: f64,
}

impl Affine {
    /// The map that applies `self`, then `after`.
    pub(super) fn then(self, after: Self) -> Self {
        Self {
            a: after.a * self.a + after.c * self.b,
            b: after.b * self.a + after.d * self.b,
            c: after.a * self.c + after.c * self.d,
            d: after.b * self.c + after.d * self.d,
            e: after.a * self.e + after.c * self.f + after.e,
            f: after.b * self.e + after.d * self.f + after.f,
        }
    }

    /// The inverse, or `None` where there is none or a coefficient of it exceeds an `f32`.
    pub(super) fn invert(self) -> Option<Self> {
        let Self { a, b, c, d, e, f } = self;
        let determinant = a * d - b * c;
        let inverse = Self {
            a: d / determinant,
            b: -b / determinant,
            c: -c / determinant,
            d: a / determinant,
            e: (c * f - d * e) / determinant,
            f: (b * e - a * f) / determinant,
        };
        let fits = [inverse.a, inverse.b, inverse.c, inverse.d, inverse.e, inverse.f]
            .iter()
            .all(|v| v.abs() <= f64::from(f32::MAX));
        (determinant != 0.0 && fits).then_some(inverse)
    }

    /// The point's image.
    pub(super) fn map(self, [x, y]: [f64; 2]) -> [f64; 2] {
        [self.a * x + self.c * y + self.e, self.b * x + self.d * y + self.f]
    }
}

impl From<Transform> for Affine {
    fn from(t: Transform) -> Self {
        let [a, b, c, d, e, f] = [t.sx, t.ky, t.kx, t.sy, t.tx, t.ty].map(f64::from);
        Self { a, b, c, d, e, f }
    }
}

/// An affine map from the centres of device pixels to a paint's plane, evaluated in `f32`.
///
/// Pixels are counted from an origin near the place where the paint happens, so that a small gradient
/// far down a large canvas loses no bits. Each coordinate is fl(x_step · column) + fl(row), a function
/// of the pixel alone: the column counted in `f32`, the row's part rounded once from `f64`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Plane {
    x_step: [f32; 2],
    y_step: [f64; 2],
    base: [f64; 2],
    origin: [i32; 2],
}

impl Plane {
    /// The map `to_plane` (device to plane), most exact near the device point `focus`.
    pub(super) fn new(to_plane: Affine, focus: [f64; 2]) -> Self {
        // A conversion that saturates, with NaN as 0; the bound keeps column numbers exact in `f32`.
        let origin = focus.map(|v| (v.floor() as i32).clamp(-(1 << 22), 1 << 22));
        Self {
            x_step: [to_plane.a as f32, to_plane.b as f32],
            y_step: [to_plane.c, to_plane.d],
            base: to_plane.map(origin.map(f64::from)),
            origin,
        }
    }

    /// Whether the first coordinate is the same all along each row.
    pub(super) fn is_constant_along_rows(&self) -> bool {
        self.x_step[0] == 0.0
    }

    /// Whether the first coordinate is the same all along each column.
    pub(super) fn is_constant_along_columns(&self) -> bool {
        self.y_step[0] == 0.0
    }

    /// Whether columns decide the first coordinate and rows the second.
    pub(super) fn is_axis_aligned(&self) -> bool {
        self.x_step[1] == 0.0 && self.y_step[0] == 0.0
    }

    /// What the 16 columns from `x` on add to coordinate `axis`.
    #[inline(always)]
    pub(super) fn columns<S: Simd>(&self, simd: S, axis: usize, x: i32) -> [f32x8<S>; 2] {
        let first = i32x8::simd_from(simd, [0, 1, 2, 3, 4, 5, 6, 7]) + x.wrapping_sub(self.origin[0]);
        let center = |column: i32x8<S>| (column.to_float::<f32x8<S>>() + 0.5) * self.x_step[axis & 1];
        [center(first), center(first + 8)]
    }

    /// What the 8 rows from `y` on contribute to coordinate `axis`.
    #[inline(always)]
    pub(super) fn rows(&self, axis: usize, y: i32) -> [f32; 8] {
        let mut rows = [0.0; 8];
        for (k, row) in rows.iter_mut().enumerate() {
            let center = f64::from(y.wrapping_add(k as i32).wrapping_sub(self.origin[1])) + 0.5;
            *row = (self.y_step[axis & 1] * center + self.base[axis & 1]) as f32;
        }
        rows
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::level::{SimdLevel, dispatch};

    #[test]
    fn inverse_undoes() {
        let t = Affine { a: 2.0, b: 1.0, c: -1.0, d: 3.0, e: 5.0, f: -7.0 };
        let [x, y] = t.invert().unwrap().map(t.map([4.0, 9.0]));
        assert!((x - 4.0).abs() < 1e-12 && (y - 9.0).abs() < 1e-12);
        assert_eq!(Affine { a: 1.0, b: 2.0, c: 2.0, d: 4.0, e: 0.0, f: 0.0 }.invert(), None);
        assert_eq!(Affine { a: 1e-39, b: 0.0, c: 0.0, d: 1.0, e: 0.0, f: 0.0 }.invert(), None);
        assert_eq!(Affine { a: f64::NAN, b: 0.0, c: 0.0, d: 1.0, e: 0.0, f: 0.0 }.invert(), None);
    }

    #[test]
    fn coordinates_follow_the_affine_map_and_not_the_block() {
        let to_plane = Affine { a: 0.31, b: -0.02, c: 0.7, d: 1.9, e: -9000.0, f: 400.5 };
        let plane = Plane::new(to_plane, [29_000.0, 12.0]);
        dispatch!(SimdLevel::Scalar, simd => {
            for axis in 0..2 {
                let at = |x: i32, y: i32, bx: i32, by: i32| {
                    let columns = plane.columns(simd, axis, bx).map(|v| v.to_array());
                    columns.as_flattened()[(x - bx) as usize] + plane.rows(axis, by)[(y - by) as usize]
                };
                for (x, y) in [(29_000, 12), (28_990, 40), (29_100, -3)] {
                    let truth = to_plane.map([f64::from(x) + 0.5, f64::from(y) + 0.5])[axis];
                    assert!((f64::from(at(x, y, x, y)) - truth).abs() < 1e-4, "{x} {y}");
                    assert_eq!(at(x, y, x, y), at(x, y, x - 9, y - 5));
                }
            }
        });
    }
}
