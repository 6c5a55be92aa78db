//! Affine maps of the plane.

use super::{Point, Rect};
use crate::num::trig;

/// An affine transform: x' = sx·x + kx·y + tx, y' = ky·x + sy·y + ty.
///
/// The default is the identity. Angles are in degrees, clockwise on the canvas (y points down).
/// Products are formed in `f64` and rounded once.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Transform {
    /// Horizontal scale.
    pub sx: f32,
    /// Vertical skew: what x adds to y'.
    pub ky: f32,
    /// Horizontal skew: what y adds to x'.
    pub kx: f32,
    /// Vertical scale.
    pub sy: f32,
    /// Horizontal translation.
    pub tx: f32,
    /// Vertical translation.
    pub ty: f32,
}

impl Default for Transform {
    fn default() -> Self {
        Self::IDENTITY
    }
}

impl Transform {
    /// The transform that changes nothing.
    pub const IDENTITY: Self = Self::from_row(1.0, 0.0, 0.0, 1.0, 0.0, 0.0);

    /// The transform with the given coefficients, in the order of SVG's `matrix(a b c d e f)`.
    pub const fn from_row(sx: f32, ky: f32, kx: f32, sy: f32, tx: f32, ty: f32) -> Self {
        Self { sx, ky, kx, sy, tx, ty }
    }

    /// A move by (tx, ty).
    pub const fn from_translate(tx: f32, ty: f32) -> Self {
        Self::from_row(1.0, 0.0, 0.0, 1.0, tx, ty)
    }

    /// A scale about the origin.
    pub const fn from_scale(sx: f32, sy: f32) -> Self {
        Self::from_row(sx, 0.0, 0.0, sy, 0.0, 0.0)
    }

    /// A rotation about the origin by `degrees`; multiples of 90° are exact.
    pub fn from_rotate(degrees: f32) -> Self {
        let turns = f64::from(degrees) / 90.0;
        let (sin, cos) = if turns == turns.floor() && turns.abs() < 1e9 {
            [(0.0, 1.0), (1.0, 0.0), (0.0, -1.0), (-1.0, 0.0)][(turns as i64).rem_euclid(4) as usize]
        } else {
            trig::sin_cos(f64::from(degrees).to_radians())
        };
        Self::from_row(cos as f32, sin as f32, -sin as f32, cos as f32, 0.0, 0.0)
    }

    /// A rotation about `center` by `degrees`.
    pub fn from_rotate_at(degrees: f32, center: impl Into<Point>) -> Self {
        let c = center.into();
        Self::from_translate(c.x, c.y)
            .pre_concat(Self::from_rotate(degrees))
            .pre_concat(Self::from_translate(-c.x, -c.y))
    }

    /// A skew by the given angles.
    pub fn from_skew(x_degrees: f32, y_degrees: f32) -> Self {
        let tan = |degrees: f32| trig::tan(f64::from(degrees).to_radians()) as f32;
        Self::from_row(1.0, tan(y_degrees), tan(x_degrees), 1.0, 0.0, 0.0)
    }

    /// The transform that applies `first`, then `self`.
    #[must_use]
    pub fn pre_concat(self, first: Self) -> Self {
        let [a, b, c, d, e, f] = self.to_f64();
        let [a1, b1, c1, d1, e1, f1] = first.to_f64();
        Self::from_f64([
            a * a1 + c * b1,
            b * a1 + d * b1,
            a * c1 + c * d1,
            b * c1 + d * d1,
            a * e1 + c * f1 + e,
            b * e1 + d * f1 + f,
        ])
    }

    /// The transform that applies `self`, then `after`.
    #[must_use]
    pub fn post_concat(self, after: Self) -> Self {
        after.pre_concat(self)
    }

    /// The inverse, or `None` where there is none or it is not finite.
    pub fn invert(self) -> Option<Self> {
        let [a, b, c, d, e, f] = self.to_f64();
        let determinant = a * d - b * c;
        let inverse = Self::from_f64([
            d / determinant,
            -b / determinant,
            -c / determinant,
            a / determinant,
            (c * f - d * e) / determinant,
            (b * e - a * f) / determinant,
        ]);
        (determinant != 0.0 && inverse.is_finite()).then_some(inverse)
    }

    /// The point's image.
    pub fn map(self, p: Point) -> Point {
        Point::new(self.sx * p.x + self.kx * p.y + self.tx, self.ky * p.x + self.sy * p.y + self.ty)
    }

    /// The vector's image: the point's without the translation.
    pub fn map_vector(self, v: Point) -> Point {
        Point::new(self.sx * v.x + self.kx * v.y, self.ky * v.x + self.sy * v.y)
    }

    /// The bounding box of the rectangle's image; `None` if it is not finite.
    pub fn map_rect(self, rect: Rect) -> Option<Rect> {
        if self.kx == 0.0 && self.ky == 0.0 {
            // Two corners say it all.
            let (a, b) = (self.map(Point::new(rect.left, rect.top)), self.map(Point::new(rect.right, rect.bottom)));
            let mapped = Rect::from_ltrb(a.x, a.y, b.x, b.y);
            return mapped.is_finite().then(|| mapped.normalized());
        }
        Rect::from_points(&rect.corners().map(|p| self.map(p)))
    }

    /// Whether every coefficient is finite.
    pub fn is_finite(self) -> bool {
        self.to_f64().iter().all(|v| v.is_finite())
    }

    /// Whether it flattens the plane to a line or a point: it has no inverse.
    pub(crate) fn is_singular(self) -> bool {
        let [a, b, c, d, ..] = self.to_f64();
        // Products of two `f32` are exact in `f64`.
        a * d == b * c
    }

    /// Whether rectangles stay rectangles: it scales and moves, and may turn by right angles.
    pub(crate) fn is_axis_aligned(self) -> bool {
        (self.kx == 0.0 && self.ky == 0.0) || (self.sx == 0.0 && self.sy == 0.0)
    }

    /// Whether it changes nothing.
    pub fn is_identity(self) -> bool {
        self == Self::IDENTITY
    }

    /// Whether it moves and does nothing else.
    pub fn is_translate(self) -> bool {
        self.sx == 1.0 && self.sy == 1.0 && self.kx == 0.0 && self.ky == 0.0
    }

    /// Whether it maps axis-aligned rectangles to axis-aligned rectangles without turning them by 90°.
    pub fn is_scale_translate(self) -> bool {
        self.kx == 0.0 && self.ky == 0.0
    }

    /// The largest and the smallest factor by which it stretches a vector (its singular values).
    pub fn scale_range(self) -> (f32, f32) {
        let [a, b, c, d, ..] = self.to_f64();
        let (p, q) = (a + d, b - c);
        let (r, s) = (a - d, b + c);
        let sum = (p * p + q * q).sqrt();
        let difference = (r * r + s * s).sqrt();
        (((sum + difference) * 0.5) as f32, ((sum - difference).abs() * 0.5) as f32)
    }

    fn to_f64(self) -> [f64; 6] {
        [self.sx, self.ky, self.kx, self.sy, self.tx, self.ty].map(f64::from)
    }

    fn from_f64(v: [f64; 6]) -> Self {
        let [sx, ky, kx, sy, tx, ty] = v.map(|v| v as f32);
        Self { sx, ky, kx, sy, tx, ty }
    }
}

impl From<glam::Affine2> for Transform {
    fn from(m: glam::Affine2) -> Self {
        Self::from_row(
            m.matrix2.x_axis.x,
            m.matrix2.x_axis.y,
            m.matrix2.y_axis.x,
            m.matrix2.y_axis.y,
            m.translation.x,
            m.translation.y,
        )
    }
}

impl From<Transform> for glam::Affine2 {
    fn from(t: Transform) -> Self {
        Self::from_cols_array(&[t.sx, t.ky, t.kx, t.sy, t.tx, t.ty])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quarter_turns_are_exact() {
        assert_eq!(Transform::from_rotate(90.0).map(Point::new(3.0, 0.0)), Point::new(0.0, 3.0));
        assert_eq!(Transform::from_rotate(-90.0).map(Point::new(3.0, 0.0)), Point::new(0.0, -3.0));
        assert_eq!(Transform::from_rotate(720.0), Transform::IDENTITY);
    }

    #[test]
    fn pre_concat_applies_its_argument_first() {
        let t = Transform::from_translate(10.0, 0.0).pre_concat(Transform::from_scale(2.0, 3.0));
        assert_eq!(t.map(Point::new(1.0, 1.0)), Point::new(12.0, 3.0));
    }

    #[test]
    fn inverse_undoes_and_singular_has_none() {
        let t = Transform::from_row(2.0, 1.0, -1.0, 3.0, 5.0, -7.0);
        let p = t.invert().unwrap().map(t.map(Point::new(4.0, 9.0)));
        assert!((p.x - 4.0).abs() < 1e-5 && (p.y - 9.0).abs() < 1e-5);
        assert_eq!(Transform::from_scale(1.0, 0.0).invert(), None);
        assert_eq!(Transform::from_scale(f32::NAN, 1.0).invert(), None);
    }

    #[test]
    fn scale_range_of_a_rotated_stretch() {
        let t = Transform::from_rotate(30.0).pre_concat(Transform::from_scale(3.0, 0.5));
        let (largest, smallest) = t.scale_range();
        assert!((largest - 3.0).abs() < 1e-6 && (smallest - 0.5).abs() < 1e-6);
    }
}
