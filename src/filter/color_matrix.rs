//! Each pixel's straight components, multiplied by a matrix.

use super::image::{Image, Work};
use crate::color::unit;
use crate::error::Result;
use crate::geom::IntRect;
use crate::num::trig;

/// A matrix for straight components: R', G', B' and A' in rows, and what R, G, B, A and 1 add to them in columns. Components
/// are in 0 ..= 1, and clamped to that.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ColorMatrix(pub [f32; 20]);

impl ColorMatrix {
    /// The matrix that changes nothing.
    pub const IDENTITY: Self = Self([
        1.0, 0.0, 0.0, 0.0, 0.0, //
        0.0, 1.0, 0.0, 0.0, 0.0, //
        0.0, 0.0, 1.0, 0.0, 0.0, //
        0.0, 0.0, 0.0, 1.0, 0.0,
    ]);

    /// The share of red, green and blue in luminance, as the specification rounds it for the two matrices below.
    const LUMINANCE: [f32; 3] = [0.213, 0.715, 0.072];

    /// Grey at 0, unchanged at 1, more colourful above; SVG's `saturate`. Below 0 counts as 0.
    pub fn saturate(amount: f32) -> Self {
        let amount = if amount > 0.0 { amount } else { 0.0 };
        Self::from_colors(|row, column| {
            let luminance = Self::LUMINANCE[column];
            let own = if row == column { 1.0 } else { 0.0 };
            luminance + (own - luminance) * amount
        })
    }

    /// Colours turned about the grey axis by `degrees`; SVG's `hueRotate`.
    pub fn hue_rotate(degrees: f32) -> Self {
        // From the specification: what the sine of the angle adds.
        const TURN: [[f32; 3]; 3] = [[-0.213, -0.715, 0.928], [0.143, 0.140, -0.283], [-0.787, 0.715, 0.072]];
        let (sin, cos) = trig::sin_cos(f64::from(degrees).to_radians());
        let (sin, cos) = (sin as f32, cos as f32);
        Self::from_colors(|row, column| {
            let luminance = Self::LUMINANCE[column];
            let own = if row == column { 1.0 } else { 0.0 };
            luminance + (own - luminance) * cos + TURN[row][column] * sin
        })
    }

    /// Black whose alpha is the luminance; SVG's `luminanceToAlpha`.
    pub fn luminance_to_alpha() -> Self {
        let mut matrix = [0.0; 20];
        (matrix[15], matrix[16], matrix[17]) = (0.2125, 0.7154, 0.0721);
        Self(matrix)
    }

    fn from_colors(entry: impl Fn(usize, usize) -> f32) -> Self {
        let mut matrix = Self::IDENTITY;
        for row in 0..3 {
            for column in 0..3 {
                matrix.0[row * 5 + column] = entry(row, column);
            }
        }
        matrix
    }

    pub(super) fn is_finite(&self) -> bool {
        self.0.iter().all(|v| v.is_finite())
    }

    /// Whether it makes something of nothing.
    fn fills(&self) -> bool {
        self.0[19] > 0.0
    }

    fn apply(&self, pixel: [u8; 4]) -> [u8; 4] {
        let [r, g, b, a] = pixel.map(|v| f32::from(v) / 255.0);
        let m = &self.0;
        let row = |i: usize| unit(r * m[i] + g * m[i + 1] + b * m[i + 2] + a * m[i + 3] + m[i + 4]);
        [row(0), row(5), row(10), row(15)].map(|v| (v * 255.0 + 0.5) as u8)
    }
}

/// The matrix applied to a picture, in `area`.
pub(super) fn color_matrix(image: Image, area: IntRect, matrix: &ColorMatrix, work: Work) -> Result<Image> {
    let mut image = if matrix.fills() { image.with_bounds(area)? } else { image.within(area) };
    image.map_straight(work, |pixel| matrix.apply(pixel));
    Ok(image)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn named_matrices_have_the_values_of_the_specification() {
        assert_eq!(ColorMatrix::saturate(1.0).apply([10, 200, 30, 77]), [10, 200, 30, 77]);
        // 0.213 · 100 + 0.715 · 200 + 0.072 · 50 = 167.9.
        assert_eq!(ColorMatrix::saturate(0.0).apply([100, 200, 50, 255]), [168, 168, 168, 255]);
        assert_eq!(ColorMatrix::hue_rotate(360.0).apply([1, 2, 3, 4]), [1, 2, 3, 4]);
        // Row by row for 90°: 255 · (0.213 − 0.213), 255 · (0.213 + 0.143), 255 · (0.213 − 0.787).
        assert_eq!(ColorMatrix::hue_rotate(90.0).apply([255, 0, 0, 255]), [0, 91, 0, 255]);
        assert_eq!(ColorMatrix::luminance_to_alpha().apply([0, 255, 0, 9]), [0, 0, 0, 182]);
    }

    #[test]
    fn a_constant_alpha_fills_what_was_empty() {
        use super::super::image::tests::{WORK, alpha, image};
        let mut matrix = ColorMatrix::IDENTITY;
        matrix.0[19] = 0.5;
        let area = IntRect::from_ltrb(0, 0, 3, 1);
        let out = color_matrix(image(1, 0, &["1"]), area, &matrix, WORK).unwrap();
        // 25 + 127.5, rounded.
        assert_eq!([alpha(&out, 0, 0), alpha(&out, 1, 0), alpha(&out, 2, 0)], [128, 153, 128]);
    }
}
