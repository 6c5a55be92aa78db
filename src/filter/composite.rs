//! Two pictures into one: blend modes, Porter–Duff operators, arithmetic.

use std::sync::Arc;

use super::image::{Image, Work, union};
use crate::blend::{BlendMode, composite_block};
use crate::error::Result;
use crate::geom::IntRect;
use crate::num::level::dispatch_up_to_avx2;
use crate::pool;
use crate::surface::block::{BLOCK_HEIGHT, BLOCK_WIDTH, MaskBlock, PixelBlock};

/// How [`Kind::Composite`](super::Kind::Composite) combines two pictures.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CompositeOperator {
    /// The upper picture over the lower one.
    Over,
    /// The upper picture where the lower one is.
    In,
    /// The upper picture where the lower one is not.
    Out,
    /// The upper picture over the lower one, inside the lower one.
    Atop,
    /// Either, where the other is not.
    Xor,
    /// The sum.
    Lighter,
    /// k1 · t · b + k2 · t + k3 · b + k4 of the premultiplied components t of the upper and b of the lower picture, in
    /// 0 ..= 1; colours are clamped to the alpha.
    Arithmetic {
        /// The factor of the product.
        k1: f32,
        /// The factor of the upper picture.
        k2: f32,
        /// The factor of the lower picture.
        k3: f32,
        /// The constant.
        k4: f32,
    },
}

/// Two pictures combined, in `area`.
pub(super) fn composite(
    top: &Image,
    bottom: Image,
    area: IntRect,
    operator: CompositeOperator,
    work: Work,
) -> Result<Image> {
    let mode = match operator {
        CompositeOperator::Over => BlendMode::SourceOver,
        CompositeOperator::In => BlendMode::SourceIn,
        CompositeOperator::Out => BlendMode::SourceOut,
        CompositeOperator::Atop => BlendMode::SourceAtop,
        CompositeOperator::Xor => BlendMode::Xor,
        CompositeOperator::Lighter => BlendMode::Plus,
        CompositeOperator::Arithmetic { k1, k2, k3, k4 } => {
            return arithmetic(top, bottom, area, [k1, k2, k3, k4], work);
        }
    };
    blend(top, bottom, area, mode, work)
}

const FULL: MaskBlock = [[255; BLOCK_WIDTH]; BLOCK_HEIGHT];
const NO_PIXELS: PixelBlock = [[0; BLOCK_WIDTH * 4]; BLOCK_HEIGHT];

/// One picture over another by a blend mode, in `area`.
pub(super) fn blend(top: &Image, bottom: Image, area: IntRect, mode: BlendMode, work: Work) -> Result<Image> {
    let area = union(top.bounds(), bottom.bounds()).intersect(area);
    let mut out = bottom.with_bounds(area)?;
    // Outside of the upper picture, what is below stays, or goes with it.
    let touched = match mode {
        BlendMode::SourceIn
        | BlendMode::SourceOut
        | BlendMode::Source
        | BlendMode::Clear
        | BlendMode::DestinationIn => area,
        BlendMode::DestinationAtop | BlendMode::Modulate => area,
        _ => top.bounds().intersect(area),
    };
    blend_onto(&mut out, top, touched, mode, work);
    Ok(out)
}

/// Blends one picture onto another, where that one's pixels lie in `touched`.
pub(super) fn blend_onto(out: &mut Image, top: &Image, touched: IntRect, mode: BlendMode, work: Work) {
    let area = out.bounds();
    let touched = touched.intersect(area);
    if touched.is_empty() {
        return;
    }
    let width = area.width() as usize;
    let first = touched.left.abs_diff(area.left) as usize;
    let last = touched.right.abs_diff(area.left) as usize;
    let jobs: Vec<_> = out.pixels_mut().chunks_mut(width * BLOCK_HEIGHT).enumerate().collect();
    pool::for_each(work.threads, jobs, |(job, pixels)| {
        let y = area.top + (job * BLOCK_HEIGHT) as i32;
        if y >= touched.bottom || y + BLOCK_HEIGHT as i32 <= touched.top {
            return;
        }
        dispatch_up_to_avx2!(work.level, simd => {
            for start in (first..last).step_by(BLOCK_WIDTH) {
                let end = (start + BLOCK_WIDTH).min(last);
                let x = area.left + start as i32;
                let (mut under, mut over) = (NO_PIXELS, NO_PIXELS);
                let rows = pixels.chunks(width).zip(under.iter_mut().zip(&mut over));
                for (y, (row, (under, over))) in (y..).zip(rows) {
                    fill(under, 0, row.get(start..end).unwrap_or(&[]));
                    let (left, part) = top.part(y, x, x + (end - start) as i32);
                    fill(over, left.abs_diff(x) as usize, part);
                }
                composite_block(simd, mode, &mut under, &over, &FULL);
                for (row, under) in pixels.chunks_mut(width).zip(&under) {
                    if let Some(row) = row.get_mut(start..end) {
                        for (pixel, under) in row.iter_mut().zip(under.as_chunks::<4>().0) {
                            *pixel = *under;
                        }
                    }
                }
            }
        });
    });
}

/// Copies pixels into a block's row.
#[inline(always)]
fn fill(row: &mut [u8; BLOCK_WIDTH * 4], start: usize, pixels: &[[u8; 4]]) {
    for (target, pixel) in row.as_chunks_mut::<4>().0.iter_mut().skip(start).zip(pixels) {
        *target = *pixel;
    }
}

/// Pictures over each other, the lowest first, in `area`.
pub(super) fn merge(mut inputs: impl Iterator<Item = Result<Arc<Image>>>, area: IntRect, work: Work) -> Result<Image> {
    let Some(lowest) = inputs.next() else { return Ok(Image::empty()) };
    let mut out = Arc::unwrap_or_clone(lowest?).within(area);
    for input in inputs {
        out = blend(&*input?, out, area, BlendMode::SourceOver, work)?;
    }
    Ok(out)
}

fn arithmetic(top: &Image, bottom: Image, area: IntRect, k: [f32; 4], work: Work) -> Result<Image> {
    let [k1, k2, k3, k4] = k;
    if !k.iter().all(|k| k.is_finite()) {
        return Ok(Image::empty());
    }
    let area = if k4 > 0.0 { area } else { union(top.bounds(), bottom.bounds()).intersect(area) };
    let mut out = bottom.with_bounds(area)?;
    out.for_rows(work, |y, row| {
        let (left, part) = top.part(y, area.left, area.right);
        let before = left.abs_diff(area.left) as usize;
        let tops = std::iter::repeat_n(&[0; 4], before).chain(part).chain(std::iter::repeat(&[0; 4]));
        for (pixel, top) in row.iter_mut().zip(tops) {
            let component = |c: usize, most: f32| {
                let (t, b) = (f32::from(top[c]) / 255.0, f32::from(pixel[c]) / 255.0);
                let value = k1 * t * b + k2 * t + k3 * b + k4;
                // Not a number, where infinite products meet, is 0.
                if value > 0.0 { if value < most { value } else { most } } else { 0.0 }
            };
            let a = component(3, 1.0);
            // Rounded down, as others have it, but not below a whole number that was only just missed.
            *pixel = [component(0, a), component(1, a), component(2, a), a].map(|v| (v * 255.0 + 1e-3) as u8);
        }
    });
    Ok(out)
}

#[cfg(test)]
mod tests {
    use super::super::image::tests::{WORK, image, noise};
    use super::*;
    use crate::num::level::SimdLevel;

    #[test]
    fn operators_keep_what_their_names_say() {
        let (top, bottom) = (image(0, 0, &["##.."]), image(0, 0, &[".##."]));
        let area = IntRect::from_ltrb(0, 0, 4, 1);
        for (operator, expected) in [
            (CompositeOperator::Over, "###."),
            (CompositeOperator::In, ".#.."),
            (CompositeOperator::Out, "#..."),
            (CompositeOperator::Atop, ".##."),
            (CompositeOperator::Xor, "#.#."),
            (CompositeOperator::Lighter, "###."),
        ] {
            let out = composite(&top, bottom.clone(), area, operator, WORK).unwrap();
            assert_eq!(out.crop(area).unwrap(), image(0, 0, &[expected]), "{operator:?}");
        }
    }

    #[test]
    fn arithmetic_is_the_formula() {
        let (top, bottom) = (image(0, 0, &["4#."]), image(0, 0, &["55."]));
        let area = IntRect::from_ltrb(0, 0, 3, 1);
        let operator = CompositeOperator::Arithmetic { k1: 0.5, k2: 0.2, k3: 0.1, k4: 0.3 };
        let out = composite(&top, bottom, area, operator, WORK).unwrap();
        // 0.4 is 102, 0.5 is 127: 0.5 · 0.4 · 0.498 + 0.2 · 0.4 + 0.1 · 0.498 + 0.3 = 0.5294 = 135 / 255; likewise
        // 0.7988 · 255 = 203.7 and 0.3 · 255 = 76.5, rounded down.
        let alphas: Vec<u8> = out.row(0).iter().map(|pixel| pixel[3]).collect();
        assert_eq!(alphas, [135, 203, 76]);
    }

    #[test]
    fn every_mode_is_the_same_picture_at_every_level_and_in_every_part() {
        let top = noise(IntRect::from_ltrb(3, 2, 50, 30), 1);
        let bottom = noise(IntRect::from_ltrb(-7, 9, 33, 41), 2);
        let all = IntRect::from_ltrb(-10, -10, 60, 60);
        for mode in BlendMode::ALL {
            let whole = blend(&top, bottom.clone(), all, mode, Work { threads: 1, level: SimdLevel::Scalar }).unwrap();
            // Block by block over everything, as the canvas would.
            let (mut under, over) = (bottom.crop(all).unwrap(), top.crop(all).unwrap());
            for (under, over) in under.pixels_mut().iter_mut().zip(over.pixels()) {
                let (mut d, mut s) = (NO_PIXELS, NO_PIXELS);
                d[0][..4].copy_from_slice(under);
                s[0][..4].copy_from_slice(over);
                dispatch_up_to_avx2!(SimdLevel::Scalar, simd => composite_block(simd, mode, &mut d, &s, &FULL));
                under.copy_from_slice(&d[0][..4]);
            }
            assert_eq!(whole.crop(all).unwrap(), under, "{mode}");
            for level in SimdLevel::available() {
                let part = IntRect::from_ltrb(1, 11, 30, 29);
                let found = blend(&top, bottom.clone(), part, mode, Work { threads: 3, level }).unwrap();
                assert_eq!(found.crop(part).unwrap(), whole.crop(part).unwrap(), "{mode} {level:?}");
            }
        }
    }
}
