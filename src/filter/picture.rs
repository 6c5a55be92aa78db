//! A picture from elsewhere.

use std::sync::Arc;

use super::image::{Image, Work};
use crate::error::Result;
use crate::geom::{IntRect, Rect, Transform};
use crate::num::level::dispatch_up_to_avx2;
use crate::paint::{FilterQuality, Pattern, PreparedPaint, SpreadMode, fetch_block};
use crate::pool;
use crate::surface::Pixmap;
use crate::surface::block::{BLOCK_HEIGHT, BLOCK_WIDTH};

/// The picture stretched to `destination` (in pixels), in `area`.
pub(super) fn picture(image: &Arc<Pixmap>, area: IntRect, destination: Rect, work: Work) -> Result<Image> {
    let destination = destination.normalized();
    let (width, height) = (image.width() as f32, image.height() as f32);
    let scale = (destination.width() / width, destination.height() / height);
    if !(destination.is_finite() && scale.0 > 0.0 && scale.1 > 0.0) {
        return Ok(Image::empty());
    }
    // Pixel on pixel but for rounding.
    let near = |a: f32, b: f32| (a - b).abs() < 1.0 / 64.0;
    let (left, top) = (destination.left.round(), destination.top.round());
    let on_pixels = near(left, destination.left) && near(top, destination.top);
    let place = if on_pixels && near(destination.width(), width) && near(destination.height(), height) {
        Transform::from_translate(left, top)
    } else {
        Transform::from_row(scale.0, 0.0, 0.0, scale.1, destination.left, destination.top)
    };
    let covered = Rect::from_ltrb(
        destination.left.round(),
        destination.top.round(),
        destination.right.round(),
        destination.bottom.round(),
    );
    let mut out = Image::new(covered.round_out().intersect(area))?;
    let bounds = out.bounds();
    let columns = bounds.width() as usize;
    if columns == 0 {
        return Ok(out);
    }
    let mut pattern = Pattern::new(Arc::clone(image));
    pattern.quality = FilterQuality::Bilinear;
    (pattern.spread_x, pattern.spread_y) = (SpreadMode::Pad, SpreadMode::Pad);
    let paint = PreparedPaint::new(&pattern.into(), place, 1.0);
    let jobs: Vec<_> = out.pixels_mut().chunks_mut(columns * BLOCK_HEIGHT).enumerate().collect();
    pool::for_each(work.threads, jobs, |(job, pixels)| {
        let y = bounds.top + (job * BLOCK_HEIGHT) as i32;
        for start in (0..columns).step_by(BLOCK_WIDTH) {
            let mut block = [[0; BLOCK_WIDTH * 4]; BLOCK_HEIGHT];
            dispatch_up_to_avx2!(work.level, simd => fetch_block(simd, &paint, bounds.left + start as i32, y, &mut block));
            for (row, block) in pixels.chunks_mut(columns).zip(&block) {
                for (pixel, value) in row.iter_mut().skip(start).zip(block.as_chunks::<4>().0) {
                    *pixel = *value;
                }
            }
        }
    });
    Ok(out)
}

#[cfg(test)]
mod tests {
    use super::super::image::tests::{WORK, alpha, image};
    use super::*;

    #[test]
    fn pixel_on_pixel_is_a_copy_and_stretching_is_smooth() {
        let source = image(0, 0, &["19", "5#"]);
        let pixmap = Arc::new(source.clone().into_pixmap().unwrap());
        let area = IntRect::from_ltrb(0, 0, 20, 20);
        let out = picture(&pixmap, area, Rect::from_xywh(3.0, 4.001, 2.0, 2.0), WORK).unwrap();
        let mut expected = Image::new(IntRect::from_xywh(3, 4, 2, 2)).unwrap();
        expected.copy_from(&source, 3, 4);
        assert_eq!(out, expected);
        let out = picture(&pixmap, area, Rect::from_xywh(0.0, 0.0, 8.0, 2.0), WORK).unwrap();
        // Pixel centres of the source lie at 2 and 6; halfway between them is the mean of 25 and 229.
        let row: Vec<u8> = (0..9).map(|x| alpha(&out, x, 0)).collect();
        assert_eq!((row[0], row[7], row[8]), (25, 229, 0));
        assert!(row[3].abs_diff(102) <= 1 && row[4].abs_diff(152) <= 1, "{row:?}");
    }
}
