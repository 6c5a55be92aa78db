//! Shapes made thinner or fatter: the least or greatest component in a window around each pixel.

use super::image::{Image, Work, grown};
use super::lines::{COLUMNS, Columns, Lanes};
use super::source::bands;
use crate::error::Result;
use crate::geom::IntRect;
use crate::num::level::dispatch_up_to_avx2;

/// Whether shapes shrink or grow.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MorphologyOperator {
    /// The least of each premultiplied component: shapes become thinner.
    Erode,
    /// The greatest: shapes become fatter.
    Dilate,
}

/// The result in `area`, with windows of `radius` pixels to each side, cut off at the region's sides.
pub(super) fn morphology(
    image: &Image,
    area: IntRect,
    region: IntRect,
    operator: MorphologyOperator,
    radius: (i32, i32),
    work: Work,
) -> Result<Image> {
    let bounds = image.bounds();
    let area = match operator {
        MorphologyOperator::Dilate => grown(bounds, radius, radius).intersect(area),
        // Where the window takes in transparent pixels, nothing is left; it does not look beyond the region.
        MorphologyOperator::Erode => {
            let inset = |inside: bool, radius: i32| if inside { radius } else { 0 };
            let left = bounds.left.saturating_add(inset(bounds.left > region.left, radius.0));
            let top = bounds.top.saturating_add(inset(bounds.top > region.top, radius.1));
            let right = bounds.right.saturating_sub(inset(bounds.right < region.right, radius.0));
            let bottom = bounds.bottom.saturating_sub(inset(bounds.bottom < region.bottom, radius.1));
            IntRect::from_ltrb(left, top, right, bottom).intersect(area)
        }
    };
    if area.is_empty() || bounds.is_empty() {
        return Ok(Image::empty());
    }
    let line = |source: &[Lanes], offset: isize, target: &mut [Lanes], radius: i32| {
        let radius = (radius.max(0) as usize).min(source.len() + target.len());
        match operator {
            MorphologyOperator::Erode => dispatch_up_to_avx2!(work.level, simd => {
                let _ = simd;
                extremes(source, offset, target, radius, 255, #[inline(always)] |a, b| if a < b { a } else { b });
            }),
            MorphologyOperator::Dilate => dispatch_up_to_avx2!(work.level, simd => {
                let _ = simd;
                extremes(source, offset, target, radius, 0, #[inline(always)] |a, b| if a > b { a } else { b });
            }),
        }
    };
    let from = grown(area, radius, radius).intersect(bounds);
    let mut out = Image::new(area)?;
    for band in bands(area, COLUMNS / Columns::bytes_of_a_row(from.width()).max(1)) {
        let read = grown(IntRect { left: from.left, right: from.right, ..band }, (0, radius.1), (0, radius.1));
        let mut columns = Columns::new(IntRect { left: from.left, right: from.right, ..band })?;
        columns.fill(image, read.intersect(from), work, |source, offset, target| {
            line(source, offset, target, radius.1);
        });
        columns.write(&mut out, work, |source, offset, target| line(source, offset, target, radius.0));
    }
    Ok(out)
}

/// The extreme in a window around each position, by the method of van Herk and of Gil and Werman: extremes from the left and
/// from the right within blocks as long as the window. Every window is the end of one block and the start of the next,
/// so that its cost does not depend on its size. Beyond the source lies `neutral`.
#[inline(always)]
fn extremes(
    source: &[Lanes],
    offset: isize,
    target: &mut [Lanes],
    radius: usize,
    neutral: u8,
    extreme: impl Fn(u8, u8) -> u8,
) {
    let window = 2 * radius + 1;
    let length = target.len() + 2 * radius;
    // Position 0 of these is as far before the target's first as the window reaches.
    let start = offset - radius as isize;
    let value = |index: usize| {
        usize::try_from(start + index as isize)
            .ok()
            .and_then(|index| source.get(index))
            .copied()
            .unwrap_or([neutral; 64])
    };
    let mut from_right = vec![[neutral; 64]; length];
    let mut running = [neutral; 64];
    for (index, out) in from_right.iter_mut().enumerate().rev() {
        if index % window == window - 1 {
            running = [neutral; 64];
        }
        for (running, value) in running.iter_mut().zip(value(index)) {
            *running = extreme(*running, value);
        }
        *out = running;
    }
    for index in 0..length {
        if index % window == 0 {
            running = [neutral; 64];
        }
        for (running, value) in running.iter_mut().zip(value(index)) {
            *running = extreme(*running, value);
        }
        if let Some(first) = index.checked_sub(window - 1)
            && let (Some(out), Some(right)) = (target.get_mut(first), from_right.get(first))
        {
            for ((out, right), left) in out.iter_mut().zip(right).zip(running) {
                *out = extreme(*right, left);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::image::tests::{WORK, image, noise};
    use super::*;
    use crate::num::level::SimdLevel;

    /// Each window looked through.
    fn slow(image: &Image, area: IntRect, region: IntRect, operator: MorphologyOperator, radius: (i32, i32)) -> Image {
        let mut out = Image::new(area).unwrap();
        let width = area.width() as i32;
        for (index, pixel) in (0..).zip(out.pixels_mut()) {
            let (x, y) = (area.left + index % width, area.top + index / width);
            let window = IntRect::from_ltrb(x - radius.0, y - radius.1, x + radius.0 + 1, y + radius.1 + 1);
            let window = window.intersect(region);
            let all = image.crop(window).unwrap();
            *pixel = std::array::from_fn(|c| {
                let values = all.pixels().iter().map(|pixel| pixel[c]);
                match operator {
                    MorphologyOperator::Erode => values.min().unwrap(),
                    MorphologyOperator::Dilate => values.max().unwrap(),
                }
            });
        }
        out
    }

    #[test]
    fn windows_are_what_they_hold_at_every_level() {
        let region = IntRect::from_ltrb(-5, 0, 40, 33);
        for bounds in [region, IntRect::from_ltrb(3, 0, 31, 30), IntRect::from_ltrb(10, 10, 15, 12)] {
            let source = noise(bounds, 7);
            for operator in [MorphologyOperator::Erode, MorphologyOperator::Dilate] {
                for radius in [(1, 1), (0, 3), (2, 0), (5, 7), (50, 4), (1000, 1000)] {
                    for area in [region, IntRect::from_ltrb(0, 5, 13, 20)] {
                        let expected = slow(&source, area, region, operator, radius);
                        for level in SimdLevel::available() {
                            let work = Work { level, ..WORK };
                            let found = morphology(&source, area, region, operator, radius, work).unwrap();
                            assert!(area.contains(found.bounds()));
                            assert_eq!(
                                found.crop(area).unwrap(),
                                expected,
                                "{bounds:?} {operator:?} {radius:?} {area:?} {level:?}"
                            );
                        }
                    }
                }
            }
        }
    }

    #[test]
    fn a_dot_grows_to_the_window_and_shrinks_back() {
        let region = IntRect::from_ltrb(0, 0, 7, 5);
        let dot = image(3, 2, &["#"]);
        let grown = morphology(&dot, region, region, MorphologyOperator::Dilate, (2, 1), WORK).unwrap();
        assert_eq!(grown.crop(region).unwrap(), image(0, 0, &[".......", ".#####.", ".#####.", ".#####.", "......."]));
        let back = morphology(&grown, region, region, MorphologyOperator::Erode, (2, 1), WORK).unwrap();
        assert_eq!(back.crop(region).unwrap(), dot.crop(region).unwrap());
    }
}
