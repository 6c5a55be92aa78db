//! Sixteen rows or columns at a time: what works along one direction is written once, and sees neither.
//!
//! A line's position holds the RGBA of sixteen neighbours, 64 bytes, so that the work along it goes in vectors.
//! [`down`] takes columns out of a picture, [`across`] takes rows out of what that gives.

use crate::error::Result;
use crate::geom::IntRect;
use crate::pool;
use crate::surface::allocate;

use super::image::{Image, Work};

/// Pixels side by side in a position.
const NEIGHBOURS: usize = 16;
const BYTES: usize = NEIGHBOURS * 4;
/// One position of sixteen lines.
pub(super) type Lanes = [u8; BYTES];

/// A picture in blocks of sixteen columns, rows top down in each; the last block is filled up with transparency.
pub(super) struct Columns {
    bounds: IntRect,
    data: Vec<u8>,
}

/// Works along the columns of `image`: `f(source, offset, target)` is called for each sixteen of them, with the pixels of the
/// image and those asked for, rows `top..bottom`; `target[i]` lies where `source[i + offset]` does.
pub(super) fn down(
    image: &Image,
    top: i32,
    bottom: i32,
    work: Work,
    f: impl Fn(&[Lanes], isize, &mut [Lanes]) + Sync,
) -> Result<Columns> {
    let from = image.bounds();
    let bounds = IntRect::from_ltrb(from.left, top, from.right, bottom);
    if bounds.is_empty() || from.is_empty() {
        return Ok(Columns { bounds: IntRect::EMPTY, data: Vec::new() });
    }
    let blocks = (from.width() as usize).div_ceil(NEIGHBOURS);
    let rows = bounds.height() as usize;
    let mut data = allocate(blocks * rows * BYTES)?;
    let jobs: Vec<_> = data.chunks_mut(rows * BYTES).enumerate().collect();
    pool::for_each(work.threads, jobs, |(block, target)| {
        let left = from.left + (block * NEIGHBOURS) as i32;
        let source: Vec<Lanes> = (from.top..from.bottom)
            .map(|y| {
                let (_, pixels) = image.part(y, left, left + NEIGHBOURS as i32);
                let mut lanes = [0; BYTES];
                if let Some(whole) = pixels.as_flattened().first_chunk() {
                    lanes = *whole;
                } else {
                    for (lane, byte) in lanes.iter_mut().zip(pixels.as_flattened()) {
                        *lane = *byte;
                    }
                }
                lanes
            })
            .collect();
        f(&source, top as isize - from.top as isize, target.as_chunks_mut().0);
    });
    Ok(Columns { bounds, data })
}

/// Works along rows as [`down`] does along columns; the answer has the columns `left..right`.
pub(super) fn across(
    columns: &Columns,
    left: i32,
    right: i32,
    work: Work,
    f: impl Fn(&[Lanes], isize, &mut [Lanes]) + Sync,
) -> Result<Image> {
    let from = columns.bounds;
    let mut image = Image::new(IntRect::from_ltrb(left, from.top, right, from.bottom))?;
    let width = image.bounds().width() as usize;
    if width == 0 {
        return Ok(image);
    }
    let rows = from.height() as usize;
    let positions: &[Lanes] = columns.data.as_chunks().0;
    let jobs: Vec<_> = image.pixels_mut().chunks_mut(width * NEIGHBOURS).enumerate().collect();
    pool::for_each(work.threads, jobs, |(group, pixels)| {
        let first = group * NEIGHBOURS;
        let count = pixels.len() / width;
        let mut source = vec![[0; BYTES]; from.width() as usize];
        for (block, source) in source.chunks_mut(NEIGHBOURS).enumerate() {
            let start = block * rows + first;
            for (row, lanes) in positions.get(start..start + count).unwrap_or(&[]).iter().enumerate() {
                for (position, pixel) in source.iter_mut().zip(lanes.as_chunks::<4>().0) {
                    if let Some(place) = position.as_chunks_mut::<4>().0.get_mut(row) {
                        *place = *pixel;
                    }
                }
            }
        }
        let mut target = vec![[0; BYTES]; width];
        f(&source, left as isize - from.left as isize, &mut target);
        for (row, pixels) in pixels.chunks_mut(width).enumerate() {
            for (pixel, position) in pixels.iter_mut().zip(&target) {
                if let Some(value) = position.as_chunks::<4>().0.get(row) {
                    *pixel = *value;
                }
            }
        }
    });
    Ok(image)
}

/// The positions of `source` that lie where the target's do; for a direction in which nothing happens.
pub(super) fn copy(source: &[Lanes], offset: isize, target: &mut [Lanes]) {
    for (index, target) in (offset..).zip(target) {
        *target = usize::try_from(index).ok().and_then(|index| source.get(index)).copied().unwrap_or([0; BYTES]);
    }
}

#[cfg(test)]
mod tests {
    use super::super::image::tests::{WORK, noise};
    use super::*;

    #[test]
    fn there_and_back_is_a_crop() {
        let source = noise(IntRect::from_xywh(-3, 5, 37, 21), 1);
        for area in [
            IntRect::from_xywh(-3, 5, 37, 21),
            IntRect::from_ltrb(0, 0, 50, 10),
            IntRect::from_ltrb(-40, 8, 12, 60),
            IntRect::from_ltrb(100, 100, 102, 103),
        ] {
            let columns = down(&source, area.top, area.bottom, WORK, copy).unwrap();
            let out = across(&columns, area.left, area.right, WORK, copy).unwrap();
            assert_eq!(out, source.crop(area).unwrap(), "{area:?}");
        }
    }
}
