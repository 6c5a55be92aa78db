//! Sixteen rows or columns at a time: what works along one direction is written once, and sees neither.
//!
//! A line's position holds the RGBA of sixteen neighbours, 64 bytes, so that the work along it goes in vectors.
//! [`Columns::fill`] takes columns out of a picture, [`Columns::write`] takes rows out of what that gives.

use crate::error::Result;
use crate::geom::IntRect;
use crate::pool;
use crate::surface::allocate;

use super::image::{Image, Work};

/// Pixels side by side in a position.
pub(super) const NEIGHBOURS: usize = 16;
const BYTES: usize = NEIGHBOURS * 4;
/// One position of sixteen lines.
pub(super) type Lanes = [u8; BYTES];

/// Bytes of what is worked on downwards only: 2,000 rows of 3,000 columns fit. Of more, the rows are worked on in bands.
pub(super) const COLUMNS: usize = 24 << 20;

/// A picture in blocks of sixteen columns, rows top down in each; the last block is filled up with transparency.
pub(super) struct Columns {
    bounds: IntRect,
    data: Vec<u8>,
}

impl Columns {
    /// Transparent columns with memory for `bounds`.
    pub(super) fn new(bounds: IntRect) -> Result<Self> {
        if bounds.is_empty() {
            return Ok(Self { bounds: IntRect::EMPTY, data: Vec::new() });
        }
        Ok(Self { bounds, data: allocate(Self::bytes_of_a_row(bounds.width()) * bounds.height() as usize)? })
    }

    /// How many bytes a row of so many pixels takes.
    pub(super) fn bytes_of_a_row(width: u32) -> usize {
        (width as usize).div_ceil(NEIGHBOURS) * BYTES
    }

    /// Works along the columns `from.left..from.right`, whole blocks of these: `f(source, offset, target)` is called for each
    /// sixteen of them, with the pixels that `image` has in `from` and those asked for, all rows; `target[i]` lies where
    /// `source[i + offset]` does.
    pub(super) fn fill(
        &mut self,
        image: &Image,
        from: IntRect,
        work: Work,
        f: impl Fn(&[Lanes], isize, &mut [Lanes]) + Sync,
    ) {
        let bounds = self.bounds;
        if bounds.is_empty() || from.is_empty() {
            return;
        }
        let rows = bounds.height() as usize;
        let first = from.left.abs_diff(bounds.left) as usize / NEIGHBOURS;
        let blocks = (from.width() as usize).div_ceil(NEIGHBOURS);
        let jobs: Vec<_> = self.data.chunks_mut(rows * BYTES).skip(first).take(blocks).enumerate().collect();
        pool::for_each(work.threads, jobs, |(block, target)| {
            let left = from.left + (block * NEIGHBOURS) as i32;
            let right = from.right.min(left + NEIGHBOURS as i32);
            let source: Vec<Lanes> = (from.top..from.bottom)
                .map(|y| {
                    let (_, pixels) = image.part(y, left, right);
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
            f(&source, bounds.top as isize - from.top as isize, target.as_chunks_mut().0);
        });
    }

    /// Works along the rows as [`fill`](Self::fill) does along columns, and writes what comes of it to the picture, which has
    /// these rows.
    pub(super) fn write(&self, image: &mut Image, work: Work, f: impl Fn(&[Lanes], isize, &mut [Lanes]) + Sync) {
        let (from, to) = (self.bounds, image.bounds());
        let width = to.width() as usize;
        if width == 0 || from.is_empty() {
            return;
        }
        let rows = from.height() as usize;
        let positions: &[Lanes] = self.data.as_chunks().0;
        let first_pixel = from.top.abs_diff(to.top) as usize * width;
        let pixels = image.pixels_mut().get_mut(first_pixel..first_pixel + rows * width).unwrap_or(&mut []);
        let jobs: Vec<_> = pixels.chunks_mut(width * NEIGHBOURS).enumerate().collect();
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
            f(&source, to.left as isize - from.left as isize, &mut target);
            for (row, pixels) in pixels.chunks_mut(width).enumerate() {
                for (pixel, position) in pixels.iter_mut().zip(&target) {
                    if let Some(value) = position.as_chunks::<4>().0.get(row) {
                        *pixel = *value;
                    }
                }
            }
        });
    }
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
            let mut columns = Columns::new(IntRect { top: area.top, bottom: area.bottom, ..source.bounds() }).unwrap();
            columns.fill(&source, source.bounds(), WORK, copy);
            let mut out = Image::new(area).unwrap();
            columns.write(&mut out, WORK, copy);
            assert_eq!(out, source.crop(area).unwrap(), "{area:?}");
        }
    }
}
