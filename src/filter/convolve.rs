//! Weighted sums of a pixel's neighbourhood.

use super::image::{Image, Work, grown};
use super::source::bands_of_parts;
use crate::color::{demultiply_u8, unit};
use crate::error::{Error, Result};
use crate::geom::IntRect;
use crate::num::level::dispatch_up_to_avx2;

/// What lies beyond the filter's region, for [`ConvolveMatrix`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum EdgeMode {
    /// The pixel at the region's side.
    #[default]
    Duplicate,
    /// The region again, from its other side on.
    Wrap,
    /// Nothing.
    None,
}

/// The weights of [`Kind::ConvolveMatrix`](super::Kind::ConvolveMatrix), for the pixels of the device.
#[derive(Clone, Debug, PartialEq)]
pub struct ConvolveMatrix {
    /// Weights a row.
    pub columns: u32,
    /// Rows.
    pub rows: u32,
    /// The weights, rows top down. As SVG has it they are applied turned by 180°: the last one belongs to the
    /// window's top left pixel. As many as columns × rows; with any other number the result is transparent.
    pub weights: Vec<f32>,
    /// The column of the window that lies on the pixel itself, from 0.
    pub target_x: u32,
    /// The row of the window that lies on the pixel itself, from 0.
    pub target_y: u32,
    /// What sums are divided by; not 0.
    pub divisor: f32,
    /// What is added to them, in 0 ..= 1; to colours times the alpha.
    pub bias: f32,
    /// What lies beyond the region.
    pub edge_mode: EdgeMode,
    /// Whether alpha stays as it is; straight components are summed then, else premultiplied ones.
    pub preserve_alpha: bool,
}

/// The most products that one convolution forms: a few seconds' worth. Beyond it there is an error, and the filter
/// is left out.
const MOST_PRODUCTS: u64 = 1 << 34;

impl ConvolveMatrix {
    fn is_valid(&self) -> bool {
        let count = u64::from(self.columns) * u64::from(self.rows);
        let finite = self.weights.iter().all(|weight| weight.is_finite()) && self.bias.is_finite();
        count == self.weights.len() as u64
            && self.target_x < self.columns
            && self.target_y < self.rows
            && self.divisor.is_finite()
            && self.divisor != 0.0
            && finite
    }

    /// How far the window reaches before the pixel, across and down, and after it.
    pub(super) fn reach(&self) -> ((i32, i32), (i32, i32)) {
        let reach = |v: u32| i32::try_from(v).unwrap_or(i32::MAX);
        (
            (reach(self.target_x), reach(self.target_y)),
            (reach(self.columns.saturating_sub(self.target_x + 1)), reach(self.rows.saturating_sub(self.target_y + 1))),
        )
    }
}

/// Sums of sixteen bits a lane would do for small matrices; floats hold them all.
type Sums = Vec<f32>;

/// The sums in `area`, by what lies within `region`.
pub(super) fn convolve(
    image: &Image,
    area: IntRect,
    region: IntRect,
    matrix: &ConvolveMatrix,
    work: Work,
) -> Result<Image> {
    if !matrix.is_valid() {
        return Ok(Image::empty());
    }
    let pixels = u64::from(area.width()) * u64::from(area.height());
    if pixels.saturating_mul(matrix.weights.len() as u64) > MOST_PRODUCTS {
        return Err(Error::Limit(format!(
            "{pixels} pixels times {} weights of a convolution are more than the limit of {MOST_PRODUCTS}",
            matrix.weights.len()
        )));
    }
    let (before, after) = matrix.reach();
    let mut out = Image::new(area)?;
    let width = area.width() as usize;
    // All that windows reach is a picture too, made up where it is beyond the region: of some rows at a time.
    for band in bands_of_parts(area, grown(area, before, after).width()) {
        let mut source = around(image, grown(band, before, after), region, matrix.edge_mode)?;
        if matrix.preserve_alpha {
            source.for_pixels(work, |pixels| {
                for pixel in pixels {
                    *pixel = demultiply_u8(*pixel);
                }
            });
        }
        out.for_rows_of(band, work, |y, row| {
            let mut sums: Sums = vec![0.0; width * 4];
            dispatch_up_to_avx2!(work.level, simd => {
                let _ = simd;
                sum_row(matrix, &source, y - before.1, &mut sums);
            });
            let (_, own) = image.part(y, area.left, area.right);
            let first = image.bounds().left.clamp(area.left, area.right).abs_diff(area.left) as usize;
            for (x, (pixel, sums)) in row.iter_mut().zip(sums.as_chunks::<4>().0).enumerate() {
                let alpha = x.checked_sub(first).and_then(|x| own.get(x)).map_or(0, |pixel| pixel[3]);
                *pixel = finish(matrix, *sums, alpha);
            }
        });
    }
    Ok(out)
}

/// The picture in `window`, beyond the region made up by the edge mode.
fn around(image: &Image, window: IntRect, region: IntRect, mode: EdgeMode) -> Result<Image> {
    let mut source = image.crop(window)?;
    if mode == EdgeMode::None || region.contains(window) || region.is_empty() {
        return Ok(source);
    }
    let from = |v: i32, low: i32, high: i32| match mode {
        EdgeMode::Wrap => low + (v - low).rem_euclid(high - low),
        _ => v.clamp(low, high - 1),
    };
    let width = window.width() as usize;
    for (y, row) in (window.top..).zip(source.pixels_mut().chunks_mut(width)) {
        let (first, pixels) = image.part(from(y, region.top, region.bottom), region.left, region.right);
        for (x, pixel) in (window.left..).zip(row) {
            let x = from(x, region.left, region.right);
            *pixel = usize::try_from(x - first).ok().and_then(|x| pixels.get(x)).copied().unwrap_or([0; 4]);
        }
    }
    Ok(source)
}

/// The weighted sums of one row, whose windows start at row `top`.
#[inline(always)]
fn sum_row(matrix: &ConvolveMatrix, source: &Image, top: i32, sums: &mut [f32]) {
    let columns = matrix.columns as usize;
    for (y, weights) in (top..).zip(matrix.weights.rchunks(columns)) {
        let row = source.row(y).as_flattened();
        for (x, weight) in weights.iter().rev().enumerate() {
            if *weight == 0.0 {
                continue;
            }
            for (sum, value) in sums.iter_mut().zip(row.get(x * 4..).unwrap_or(&[])) {
                *sum += f32::from(*value) * weight;
            }
        }
    }
}

fn finish(matrix: &ConvolveMatrix, sums: [f32; 4], alpha: u8) -> [u8; 4] {
    let value = |sum: f32| sum / 255.0 / matrix.divisor;
    let a = if matrix.preserve_alpha { f32::from(alpha) / 255.0 } else { value(sums[3]) + matrix.bias };
    let visible = unit(a);
    let color = |sum: f32| {
        let v = value(sum) + matrix.bias * a;
        let v = if matrix.preserve_alpha {
            unit(v) * visible
        } else if v < visible {
            unit(v)
        } else {
            visible
        };
        (v * 255.0 + 0.5) as u8
    };
    [color(sums[0]), color(sums[1]), color(sums[2]), (visible * 255.0 + 0.5) as u8]
}

#[cfg(test)]
mod tests {
    use super::super::image::tests::{WORK, alpha, image, noise};
    use super::*;
    use crate::num::level::SimdLevel;

    fn matrix(columns: u32, weights: &[f32], edge_mode: EdgeMode) -> ConvolveMatrix {
        let rows = weights.len() as u32 / columns;
        ConvolveMatrix {
            columns,
            rows,
            weights: weights.to_vec(),
            target_x: columns / 2,
            target_y: rows / 2,
            divisor: 1.0,
            bias: 0.0,
            edge_mode,
            preserve_alpha: false,
        }
    }

    #[test]
    fn weights_are_turned_by_half_a_turn() {
        let area = IntRect::from_ltrb(0, 0, 3, 3);
        // The last weight takes the pixel to the upper left, so that the dot moves to the lower right.
        let weights = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0];
        let out = convolve(&image(1, 1, &["#"]), area, area, &matrix(3, &weights, EdgeMode::None), WORK).unwrap();
        assert_eq!(out, image(0, 0, &["...", "...", "..#"]));
    }

    #[test]
    fn edges_are_made_up() {
        let region = IntRect::from_ltrb(0, 0, 4, 1);
        let source = image(0, 0, &["#..5"]);
        // Half of the left and half of the right neighbour.
        let weights = [0.5, 0.0, 0.5];
        for (mode, expected) in [
            (EdgeMode::None, [0, 128, 64, 0]),
            // 255 / 2 from itself; 127 / 2 from itself.
            (EdgeMode::Duplicate, [128, 128, 64, 64]),
            // (127 + 0) / 2; (0 + 255) / 2.
            (EdgeMode::Wrap, [64, 128, 64, 128]),
        ] {
            let out = convolve(&source, region, region, &matrix(3, &weights, mode), WORK).unwrap();
            assert_eq!([0, 1, 2, 3].map(|x| alpha(&out, x, 0)), expected, "{mode:?}");
        }
    }

    #[test]
    fn alpha_is_preserved_where_asked_for() {
        let mut source = image(0, 0, &["#5"]);
        source.pixels_mut()[1] = [100, 0, 0, 200];
        let area = IntRect::from_ltrb(0, 0, 2, 1);
        let matrix = ConvolveMatrix { preserve_alpha: true, bias: 0.25, ..matrix(1, &[0.5], EdgeMode::None) };
        let out = convolve(&source, area, area, &matrix, WORK).unwrap();
        // Straight 255 and 128 (of 127.5), halved: 0.5 + 0.25 and (0.251 + 0.25 · 0.784) · 0.784.
        assert_eq!(out.pixels()[0], [191, 191, 191, 255]);
        assert_eq!(out.pixels()[1], [89, 39, 39, 200]);
    }

    #[test]
    fn parts_and_levels_agree() {
        let region = IntRect::from_ltrb(-4, 0, 40, 20);
        let source = noise(IntRect::from_ltrb(0, 2, 33, 17), 4);
        let weights: Vec<f32> = (0..35).map(|i| (i % 6) as f32 - 1.7).collect();
        for mode in [EdgeMode::None, EdgeMode::Duplicate, EdgeMode::Wrap] {
            let matrix = ConvolveMatrix { divisor: 20.0, target_x: 1, ..matrix(7, &weights, mode) };
            let whole = convolve(&source, region, region, &matrix, WORK).unwrap();
            for level in SimdLevel::available() {
                let area = IntRect::from_ltrb(2, 0, 21, 13);
                let part = convolve(&source, area, region, &matrix, Work { threads: 3, level }).unwrap();
                assert_eq!(part, whole.crop(area).unwrap(), "{mode:?} {level:?}");
            }
        }
    }

    #[test]
    fn what_is_no_matrix_gives_nothing() {
        let area = IntRect::from_ltrb(0, 0, 2, 1);
        let good = matrix(1, &[1.0], EdgeMode::None);
        for bad in [
            ConvolveMatrix { columns: 2, ..good.clone() },
            ConvolveMatrix { target_y: 1, ..good.clone() },
            ConvolveMatrix { divisor: 0.0, ..good.clone() },
            ConvolveMatrix { bias: f32::NAN, ..good.clone() },
            ConvolveMatrix { columns: u32::MAX, rows: u32::MAX, ..good },
        ] {
            assert_eq!(convolve(&image(0, 0, &["##"]), area, area, &bad, WORK).unwrap(), Image::empty());
        }
    }
}
